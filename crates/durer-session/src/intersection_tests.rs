//! Intersection tests between a ray and each object, with the reason why an object is not the
//! closest hit.

use crate::document::NamedScene;
use crate::protocol::{CastHit, CastResult, FormulaRow, ObjectTest, Verdict};
use crate::rows::{factor, number, row, vector, vector_row};
use durer::math::{Line, Ray, Ray64, Vec2, Vec3};
use durer::shape::{Plane, Primitive, Shape, Sphere};
use durer::world::{Geometry, Hit, Object};
use glam::DVec3;

/// Maximum number of objects that are listed.
pub(crate) const MAX_TESTS: usize = 200;

/// Intersects a ray in world space with every object and reports the result for each object.
pub(crate) fn cast(scene: NamedScene, ray: &Ray) -> CastResult {
    let world = scene.world();
    let ray64 = Ray64::from(*ray);
    let first = world.closest(&ray64, &mut ());
    let objects = world.objects();
    let mut tests: Vec<ObjectTest> = objects
        .iter()
        .enumerate()
        .take(MAX_TESTS)
        .map(|(i, object)| test(scene, i as u32, object, &ray64, first.as_ref()))
        .collect();
    if let Some(hit) = first.filter(|hit| hit.object as usize >= MAX_TESTS) {
        tests.push(test(scene, hit.object, &objects[hit.object as usize], &ray64, first.as_ref()));
    }
    let hit = first.map(|hit| {
        let at = world.interaction(&ray64, hit);
        CastHit {
            object: hit.object,
            part: world.triangle(&hit),
            t: hit.t,
            point: at.surface.position.into(),
            normal: at.surface.n_geo.into(),
            shading_normal: at.surface.n_shade.into(),
            uv: at.surface.uv.get().map(Into::into),
            barycentric: at.surface.barycentric.into(),
        }
    });
    let left_out = objects.len().saturating_sub(tests.len()) as u32;
    CastResult { origin: ray.origin.into(), direction: ray.dir.into(), tests, left_out, hit }
}

fn test(scene: NamedScene, number: u32, object: &Object, ray: &Ray64, first: Option<&Hit>) -> ObjectTest {
    let world = scene.world();
    let own = world.hit_of(number, ray);
    let whole = Ray64 { rounded: Ray { t_min: f32::NEG_INFINITY, t_max: f32::INFINITY, ..ray.rounded }, ..*ray };
    let anywhere = own.or_else(|| world.hit_of(number, &whole));
    let (verdict, why) = match (&own, anywhere, first) {
        (Some(hit), _, Some(first)) if hit.object == first.object => {
            (Verdict::Closest, format!("it is hit first, at t = {}", self::number(hit.t.into())))
        }
        (Some(hit), _, Some(first)) => {
            (Verdict::Farther, format!("it is hit at t = {}, behind the first hit at {}", text(hit.t), text(first.t)))
        }
        (Some(hit), ..) => (Verdict::Closest, format!("it is hit at t = {}", text(hit.t))),
        (None, Some(hit), _) if hit.t <= ray.rounded.t_min => {
            (Verdict::Behind, format!("the line meets it at t = {}, before the start of the ray", text(hit.t)))
        }
        (None, Some(hit), _) => {
            (Verdict::Beyond, format!("the line meets it at t = {}, beyond the end of the ray", text(hit.t)))
        }
        (None, None, _) => (Verdict::Missed, "the line misses it".into()),
    };
    let mut account = ObjectTest {
        object: number,
        name: scene.0.short_object(number),
        place: scene.place(object.span),
        verdict,
        why,
        t: anywhere.map(|hit| hit.t),
        rows: Vec::new(),
    };
    if let Some(local) = object.own_ray(ray) {
        account.rows.push(vector_row("o", "M⁻¹ o", vector(ray.rounded.origin), local.origin));
        account.rows.push(vector_row(
            "d",
            "M⁻¹ d, not normalised, so t is unchanged",
            vector(ray.rounded.dir),
            local.dir,
        ));
        account.rows.extend(formulas(object, &local, anywhere.as_ref()));
    } else {
        account.rows.extend(formulas(object, &ray.rounded, anywhere.as_ref()));
    }
    if account.verdict == Verdict::Missed
        && let Some(reason) = account.rows.last().filter(|row| row.name == "so")
    {
        account.why.clone_from(&reason.result);
    }
    account
}

fn text(t: f32) -> String {
    number(t.into())
}

/// Returns the formulas of an intersection with their numbers in object space.
fn formulas(object: &Object, ray: &Ray, hit: Option<&Hit>) -> Vec<FormulaRow> {
    let line = Line { origin: ray.origin.as_dvec3(), dir: ray.dir.as_dvec3() };
    let back = object.center;
    match &object.geometry {
        Geometry::Primitive(Primitive::Sphere(ball)) => {
            sphere(&Sphere { center: ball.center + back, radius: ball.radius }, &line)
        }
        Geometry::Primitive(Primitive::Plane(it)) => {
            let offset = it.offset + it.normal.dot(back);
            plane(&Plane { normal: it.normal, offset }, &line)
        }
        Geometry::Primitive(Primitive::Triangle(it)) => triangle(it.corners().map(|corner| corner + back), &line),
        Geometry::Primitive(shape) => crossings(shape, back, &line),
        Geometry::Mesh(tree) => match hit {
            Some(hit) => {
                let mut rows = vec![row("triangles", "in the mesh", "", tree.mesh.len() as f64)];
                rows.push(row("triangle", "index of the hit triangle", "", f64::from(hit.part)));
                rows.extend(triangle(tree.mesh.corners(hit.part).map(|corner| corner + back), &line));
                rows
            }
            None => vec![
                row("triangles", "in the mesh", "", tree.mesh.len() as f64),
                conclusion("the line misses every triangle of the mesh"),
            ],
        },
        Geometry::Solid(_) => Vec::new(),
    }
}

/// Returns a row that states a conclusion.
fn conclusion(words: &str) -> FormulaRow {
    FormulaRow { name: "so".into(), formula: String::new(), numbers: String::new(), result: words.into(), value: None }
}

fn sphere(ball: &Sphere, line: &Line) -> Vec<FormulaRow> {
    let (o, d, r) = (line.origin - ball.center.as_dvec3(), line.dir, f64::from(ball.radius));
    let (a, b, c) = (d.dot(d), 2.0 * o.dot(d), o.dot(o) - r * r);
    let discriminant = b * b - 4.0 * a * c;
    let mut rows = vec![
        row("a", "d · d", format!("{0} · {0}", vector(d)), a),
        row("b", "2 (o − c) · d", format!("2 {} · {}", vector(o), vector(d)), b),
        row("c", "(o − c) · (o − c) − r²", format!("{} − {}²", number(o.dot(o)), number(r)), c),
        row("Δ", "b² − 4 a c", format!("{}² − 4 · {} · {}", factor(b), number(a), factor(c)), discriminant),
    ];
    if discriminant < 0.0 {
        rows.push(conclusion("Δ < 0: the line misses the sphere"));
        return rows;
    }
    let root = discriminant.sqrt();
    for (name, formula, sign, t) in
        [("t₁", "(−b − √Δ) / 2a", "−", (-b - root) / (2.0 * a)), ("t₂", "(−b + √Δ) / 2a", "+", (-b + root) / (2.0 * a))]
    {
        rows.push(row(name, formula, format!("({} {sign} {}) / {}", number(-b), number(root), number(2.0 * a)), t));
    }
    rows
}

fn plane(it: &Plane, line: &Line) -> Vec<FormulaRow> {
    let (n, offset) = (it.normal.as_dvec3(), f64::from(it.offset));
    let (no, nd) = (n.dot(line.origin), n.dot(line.dir));
    let mut rows = vec![
        row("n · o", "", format!("{} · {}", vector(n), vector(line.origin)), no),
        row("n · d", "", format!("{} · {}", vector(n), vector(line.dir)), nd),
    ];
    match nd == 0.0 {
        true => rows.push(conclusion("n · d = 0: the line is parallel to the plane")),
        false => rows.push(row(
            "t",
            "(offset − n · o) / (n · d)",
            format!("({} − {}) / {}", number(offset), factor(no), factor(nd)),
            (offset - no) / nd,
        )),
    }
    rows
}

/// Returns the rows that solve o + t d = a + β (b − a) + γ (c − a) with Cramer's rule.
fn triangle(corners: [Vec3; 3], line: &Line) -> Vec<FormulaRow> {
    let [a, b, c] = corners.map(|corner| corner.as_dvec3());
    let (e1, e2, s, d) = (b - a, c - a, line.origin - a, line.dir);
    let det = |x: DVec3, y: DVec3, z: DVec3| x.dot(y.cross(z));
    let whole = det(-d, e1, e2);
    let mut rows = vec![row("D", "|−d, b − a, c − a|", "", whole)];
    if whole == 0.0 {
        rows.push(conclusion("D = 0: the line is parallel to the triangle"));
        return rows;
    }
    let parts = [det(-d, s, e2), det(-d, e1, s), det(s, e1, e2)];
    let [beta, gamma, t] = parts.map(|part| part / whole);
    let numbers = |part: f64| format!("{} / {}", number(part), number(whole));
    rows.push(row("β", "|−d, o − a, c − a| / D", numbers(parts[0]), beta));
    rows.push(row("γ", "|−d, b − a, o − a| / D", numbers(parts[1]), gamma));
    rows.push(row("α", "1 − β − γ", format!("1 − {} − {}", factor(beta), factor(gamma)), 1.0 - beta - gamma));
    rows.push(row("t", "|o − a, b − a, c − a| / D", numbers(parts[2]), t));
    let negative: Vec<&str> = [("α", 1.0 - beta - gamma), ("β", beta), ("γ", gamma)]
        .into_iter()
        .filter(|(_, weight)| *weight < 0.0)
        .map(|(name, _)| name)
        .collect();
    if !negative.is_empty() {
        rows.push(conclusion(&format!("{} < 0: the line meets the plane outside the triangle", negative.join(", "))));
    }
    rows
}

/// Returns the values of t at which a line crosses a shape of any other kind, without formulas.
fn crossings(shape: &Primitive, back: Vec3, line: &Line) -> Vec<FormulaRow> {
    let moved = Line { origin: line.origin - back.as_dvec3(), dir: line.dir };
    let mut found: Vec<f64> = Vec::new();
    shape.crossings(&moved, &mut |t, _: Vec2| found.push(t));
    found.sort_by(f64::total_cmp);
    if found.is_empty() {
        return vec![conclusion("the line misses it")];
    }
    let one = |(i, t): (usize, &f64)| row(&format!("t{}", subscript(i + 1)), "where the line meets it", "", *t);
    found.iter().enumerate().map(one).collect()
}

fn subscript(n: usize) -> String {
    let digit = |digit: char| char::from_u32(0x2080 + digit.to_digit(10).unwrap_or(0)).unwrap_or(digit);
    n.to_string().chars().map(digit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(rows: &[FormulaRow], name: &str) -> f64 {
        rows.iter().find(|row| row.name == name).and_then(|row| row.value).unwrap()
    }

    #[test]
    fn formulas_agree_with_the_shapes() {
        let line = Line { origin: DVec3::new(0.2, 0.1, 5.0), dir: DVec3::new(0.05, -0.02, -0.9) };
        let ball = Sphere { center: Vec3::new(0.3, 0.0, -1.0), radius: 1.5 };
        let mut found = Vec::new();
        ball.crossings(&line, &mut |t, _| found.push(t));
        let rows = sphere(&ball, &line);
        for (name, t) in ["t₁", "t₂"].iter().zip(&found) {
            assert!((value(&rows, name) - t).abs() < 1e-12, "{name}");
        }
        let corners = [Vec3::new(-2.0, -1.0, 0.0), Vec3::new(2.0, -1.0, 0.5), Vec3::new(0.0, 2.0, -0.5)];
        let rows = triangle(corners, &line);
        let weights = ["α", "β", "γ"].map(|name| value(&rows, name));
        let met = line.at(value(&rows, "t"));
        let mixed: DVec3 = corners.iter().zip(weights).map(|(corner, weight)| weight * corner.as_dvec3()).sum();
        assert!((met - mixed).length() < 1e-12, "{met} {mixed}");
        let [vertex0, vertex1, vertex2] = corners;
        let ray = Ray::new(line.origin.as_vec3(), line.dir.as_vec3());
        let hit = durer::shape::Triangle { vertex0, vertex1, vertex2 }.intersect(&ray).unwrap();
        assert!((f64::from(hit.t) - value(&rows, "t")).abs() < 1e-5);
    }

    #[test]
    fn numbers_are_short_and_signs_are_true_minus_signs() {
        assert_eq!([0.0, 1.0, -2.5, 1.0 / 3.0, 1e-9].map(number), ["0", "1", "−2.5", "0.33333", "1e−9"]);
        assert_eq!(subscript(12), "₁₂");
    }
}
