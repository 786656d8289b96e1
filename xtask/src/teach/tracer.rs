//! The judge's tracer, which is independent of the library and can make common mistakes by name.

mod camera;
mod colors;

use super::scene::{Light, Material, Object, Scene, Shape, Transform, Year, uv};
use super::vector::{Matrix, Vec3};

/// A picture with eight bits per channel, starting with the top row.
pub type Picture = Vec<[u8; 3]>;

/// Ray tracer for the judge's scenes, which makes the mistakes that are listed by name.
pub struct Tracer<'s> {
    scene: &'s Scene,
    mistakes: &'s [&'static str],
    /// For each object, the object-to-world matrix and its inverse.
    places: Vec<(Matrix, Matrix)>,
}

/// Hit of a ray in the judge's tracer.
struct Hit {
    t: f64,
    /// Shading normal in world space.
    n: Vec3,
    geo: Vec3,
    uv: Option<(f64, f64)>,
    object: usize,
}

/// Root of a ray with an object in object space: t, shading and geometric normal, and texture
/// coordinates.
type Root = (f64, Vec3, Vec3, Option<(f64, f64)>);

impl<'s> Tracer<'s> {
    /// Creates a tracer for a scene with some mistakes.
    pub fn new(scene: &'s Scene, mistakes: &'s [&'static str]) -> Self {
        let mut tracer = Tracer { scene, mistakes, places: Vec::new() };
        tracer.places = scene.objects.iter().map(|object| tracer.matrices(object)).collect();
        tracer
    }

    fn is(&self, name: &str) -> bool {
        self.mistakes.contains(&name)
    }

    fn matrices(&self, object: &Object) -> (Matrix, Matrix) {
        let degrees = |angle: f64| match () {
            () if self.is("rotation-radians") => angle,
            () if self.is("rotation-negated") => -angle.to_radians(),
            () => angle.to_radians(),
        };
        let mut m = Matrix::ONE;
        for op in &object.ops {
            let one = match *op {
                Transform::Translate(by) if self.is("translation-negated") => Transform::Translate(-by),
                Transform::Scale(Vec3(x, y, z)) if self.is("scale-inverted") => {
                    Transform::Scale(Vec3(1.0 / x, 1.0 / y, 1.0 / z))
                }
                Transform::X(angle) if self.is("rotation-axis") => Transform::Y(angle),
                Transform::Y(angle) if self.is("rotation-axis") => Transform::X(angle),
                ref other => other.clone(),
            };
            let one = one.matrix(degrees);
            m = if self.is("matrices-reversed") { one.times(&m) } else { m.times(&one) };
        }
        if self.is("transforms-ignored") {
            m = Matrix::ONE;
        }
        (m, m.inverse())
    }

    /// Returns all roots of a ray with an object in object space, each with its geometric and
    /// shading normal.
    fn roots(&self, object: &Object, o: Vec3, d: Vec3) -> Vec<Root> {
        let triangle = |p: [Vec3; 3]| {
            let n = (p[1] - p[0]).cross(p[2] - p[0]);
            let t = (p[0] - o).dot(n) / d.dot(n);
            let q = o + d * t;
            let area = |a: Vec3, b: Vec3| (b - a).cross(q - a).dot(n) / n.dot(n);
            let w = [area(p[1], p[2]), area(p[2], p[0]), area(p[0], p[1])];
            let n = if self.is("triangles-turned") { -n } else { n };
            let tested = |(i, w): (usize, &f64)| *w >= 0.0 || self.is("triangle-test") && i == 1;
            (w.iter().enumerate().all(tested) && t.is_finite()).then_some((t, n.unit(), w))
        };
        match &object.shape {
            Shape::Sphere(c, r) => {
                let (whole, r) = (*r, if self.is("radius-not-squared") { r.sqrt() } else { *r });
                let c = if self.is("center-ignored") { Vec3::ZERO } else { *c };
                let (a, b, k) = (d.dot(d), d.dot(o - c), (o - c).dot(o - c) - r * r);
                let (root, a) = match self.is("sphere-roots") {
                    true => (b * b - 4.0 * a * k, 2.0 * a),
                    false => (b * b - a * k, a),
                };
                if root < 0.0 {
                    return Vec::new();
                }
                let one = |t: f64| {
                    let p = o + d * t;
                    let n = match () {
                        () if self.is("sphere-normals") => p.unit(),
                        () if self.is("sphere-normals-long") => p - c,
                        () if self.is("radius-not-squared") => (p - c) * (1.0 / whole),
                        () => (p - c).unit(),
                    };
                    let Vec3(x, y, z) = (p - c).unit();
                    let uv = (x.atan2(-z) / std::f64::consts::TAU + 0.5, y.asin() / std::f64::consts::PI + 0.5);
                    (t, n, (p - c).unit(), Some(uv))
                };
                vec![one((-b - root.sqrt()) / a), one((-b + root.sqrt()) / a)]
            }
            Shape::Plane(n, offset) => {
                let offset = if self.is("plane-negated") { -offset } else { *offset };
                let t = (offset - n.dot(o)) / n.dot(d);
                if t.is_finite() { vec![(t, n.unit(), n.unit(), None)] } else { Vec::new() }
            }
            Shape::Triangle(p) => triangle(*p).map(|(t, n, _)| (t, n, n, None)).into_iter().collect(),
            Shape::Mesh(_, corners, faces) => {
                let smooth =
                    matches!(self.scene.year, Year::F12a4) && !self.is("normals-flat") || self.is("normals-smooth");
                let mut found = Vec::new();
                for face in faces {
                    let Some((t, n, w)) = triangle(face.map(|i| corners[i])) else { continue };
                    let mixed = if smooth {
                        // Weight vertex normals by area: they are sums of cross products.
                        let at = |corner: usize| {
                            let around = faces.iter().filter(|f| f.contains(&corner));
                            around
                                .map(|f| (corners[f[1]] - corners[f[0]]).cross(corners[f[2]] - corners[f[0]]))
                                .fold(Vec3::ZERO, |a, b| a + b)
                                .unit()
                        };
                        let n = at(face[0]) * w[0] + at(face[1]) * w[1] + at(face[2]) * w[2];
                        if self.is("normals-mixed-long") { n } else { n.unit() }
                    } else {
                        n
                    };
                    let all = face.map(|i| uv(corners[i]));
                    let w = if self.is("texture-vertices") { [w[1], w[2], w[0]] } else { w };
                    let sum = |of: fn((f64, f64)) -> f64| (0..3).map(|i| w[i] * of(all[i])).sum::<f64>();
                    found.push((t, mixed, n, Some((sum(|p| p.0), sum(|p| p.1)))));
                }
                found
            }
        }
    }

    fn hit(&self, o: Vec3, d: Vec3, least: f64, most: f64) -> Option<Hit> {
        self.hit_among(self.scene.objects.len(), o, d, least, most)
    }

    /// Returns the hit on the first `count` objects.
    fn hit_among(&self, count: usize, o: Vec3, d: Vec3, least: f64, most: f64) -> Option<Hit> {
        let mut best: Option<Hit> = None;
        for (number, object) in self.scene.objects[..count].iter().enumerate() {
            let (to_world, back) = &self.places[number];
            let (lo, mut ld) = (back.point(o), back.vector(d));
            if self.is("direction-moved") {
                ld = back.point(d);
            }
            if self.is("local-direction-unit") {
                ld = ld.unit();
            }
            let mut own: Option<Root> = None;
            for (t, n, geo, uv) in self.roots(object, lo, ld) {
                let least = if self.is("hits-behind") { f64::NEG_INFINITY } else { least };
                let mesh = matches!(object.shape, Shape::Mesh(..));
                let better = own.as_ref().is_none_or(|b| match () {
                    () if self.is("last-hit") => t > b.0,
                    () if self.is("mesh-first") && mesh => false,
                    () => t < b.0,
                });
                let flat = matches!(object.shape, Shape::Mesh(..) | Shape::Triangle(_));
                if self.is("backs-culled") && flat && geo.dot(ld) > 0.0 {
                    continue;
                }
                if t > least && t < most && better {
                    own = Some((t, n, geo, uv));
                }
            }
            let Some((t, n, geo, uv)) = own else { continue };
            let normal = |n: Vec3| match () {
                () if self.is("normals-local") => n,
                () if self.is("normals-moved") => to_world.vector(n).unit(),
                () if self.is("normals-moved-long") => to_world.vector(n),
                () if self.is("normals-inverse") => back.vector(n).unit(),
                () if self.is("normals-transposed") => to_world.transposed().vector(n).unit(),
                () if self.is("normals-long") => back.transposed().vector(n),
                () if object.ops.is_empty() => n,
                () if self.is("normals-mixed-long") => back.transposed().vector(n).unit() * n.length(),
                () => back.transposed().vector(n).unit(),
            };
            let better = best.as_ref().is_none_or(|b| match () {
                () if self.is("farthest-object") || self.is("last-hit") => t > b.t,
                () if self.is("last-written") => true,
                () if self.is("first-written") => false,
                () => t < b.t,
            });
            if better {
                best = Some(Hit { t, n: normal(n), geo: back.transposed().vector(geo).unit(), uv, object: number });
            }
        }
        best
    }

    fn epsilon(&self, shadow: bool) -> f64 {
        let right = match self.scene.year {
            Year::F04 => 1e-4,
            Year::F12a5 => 1e-3,
            Year::F16 => 1e-2,
            Year::F12a4 | Year::Durer => 1e-5,
        };
        match () {
            () if self.is("epsilon-0") => 0.0,
            () if self.is("shadows-epsilon") && shadow => 0.4,
            () if self.is("epsilon-large") => 0.3,
            () => right,
        }
    }

    fn blocked(&self, p: Vec3, l: Vec3, distance: f64) -> bool {
        if !self.scene.shadows && !self.is("shadows-added") || self.is("no-shadows") {
            return false;
        }
        let most = match () {
            () if self.is("shadows-endless") => f64::INFINITY,
            () if self.is("shadows-reach") && distance.is_finite() => 1.0,
            () => distance,
        };
        let p = if self.is("shadows-from-eye") { self.scene.eye } else { p };
        // Student programs use single precision, which is what causes acne.
        let single = |v: Vec3| v.map(|x| f64::from(x as f32));
        let p = if self.is("epsilon-0") { single(p) } else { p };
        let count = if self.is("shadows-of-one-object") { 1 } else { self.scene.objects.len() };
        match self.hit_among(count, p, l, self.epsilon(true), most) {
            // The second program of 2012 considers only front faces of the nearest object.
            Some(hit) if self.scene.year == Year::F12a5 && !self.is("shadow-fronts") => hit.n.dot(l) <= 0.0,
            hit => hit.is_some(),
        }
    }

    fn shade(&self, o: Vec3, d: Vec3, hit: &Hit, bounces: u32, index: f64) -> Vec3 {
        let scene = self.scene;
        let mut material: Material = scene.materials[scene.objects[hit.object].material];
        if self.is("x-kd-squared") {
            material.kd = material.kd * material.kd;
        }
        if self.is("x-materials-swapped") {
            material = scene.materials[(scene.objects[hit.object].material + 1) % scene.materials.len()];
        }
        let p = o + d * hit.t;
        material = self.colored(material, p, self.places[hit.object].1.point(p), hit.uv);
        let one = self.is("normals-inverse") || self.is("normals-transposed") || self.is("normals-moved");
        let side = if matches!(scene.year, Year::Durer) && !one { hit.geo } else { hit.n };
        let back = d.dot(side) > 0.0;
        let mut n = hit.n;
        let faced = scene.year == Year::Durer && !self.is("backs-not-shaded") || self.is("normals-faced");
        if back && faced {
            n = -n;
        }
        let mut color = Vec3::ZERO;
        let ambient = match () {
            () if self.is("no-ambient") => Vec3::ZERO,
            () if self.is("ambient-bare") => scene.ambient,
            () if self.is("x-ambient-brighter") => scene.ambient * material.kd * 1.6,
            () if self.is("ambient-each-light") => scene.ambient * material.kd * scene.lights.len() as f64,
            () => scene.ambient * material.kd,
        };
        if !(scene.year == Year::F04 && back && !faced) {
            color = ambient;
            let mut free = scene.lights.is_empty();
            let mut greatest = Vec3::ZERO;
            for (number, emitter) in scene.lights.iter().enumerate() {
                if self.is("light-missing") && number == 0 {
                    continue;
                }
                let (mut l, distance, mut light) = match *emitter {
                    Light::Directional(along, c) => {
                        let l = if self.is("light-negated") { along } else { -along };
                        (if self.is("light-long") { l } else { l.unit() }, f64::INFINITY, c)
                    }
                    Light::Point(at, c, a) => {
                        let at = if self.is("x-light-turned") { Vec3(at.0, at.2, at.1) } else { at };
                        let distance = (at - p).length();
                        let p = if self.is("point-light-from-eye") { scene.eye } else { p };
                        let faded_by = match () {
                            () if self.is("falloff-of-ray") => hit.t,
                            () if self.is("falloff-of-eye") => (at - scene.eye).length(),
                            () => distance,
                        };
                        (at - p, distance, c * self.fading(a, faded_by))
                    }
                };
                let toward = l.unit();
                if matches!(emitter, Light::Point(..)) && !self.is("point-light-long") {
                    l = toward;
                }
                if self.is("white-lights") {
                    light = match *emitter {
                        Light::Directional(..) => Vec3::ONE,
                        Light::Point(_, _, a) => Vec3::ONE * self.fading(a, distance),
                    };
                }
                if self.blocked(p, toward, distance) && !(self.is("x-second-light-unshadowed") && number == 1) {
                    if self.is("shadows-diffuse") {
                        color = color + material.kd * n.dot(l).max(0.0) * light;
                    }
                    continue;
                }
                free = true;
                let mut direct = self.direct(&material, n, d, l) * light;
                if let (true, Light::Point(_, c, _)) = (self.is("falloff-of-highlights"), *emitter) {
                    // Only highlights fade.
                    let bare = Material { ks: Vec3::ZERO, ..material };
                    direct = direct + self.direct(&bare, n, d, l) * (c - light);
                }
                if self.is("greatest-light") {
                    greatest = Vec3(greatest.0.max(direct.0), greatest.1.max(direct.1), greatest.2.max(direct.2));
                    continue;
                }
                color = if self.is("last-light-only") { ambient + direct } else { color + direct };
                if self.is("clamped-each-light") {
                    color = color.map(|c| c.clamp(0.0, 1.0));
                }
            }
            color = color + greatest;
            if self.is("shadows-ambient") && !free {
                color = color - ambient;
            }
        }
        if self.is("clamped-before-bounces") {
            color = color.map(|c| c.clamp(0.0, 1.0));
        }
        if bounces > 0 && self.is("glass-mixed") {
            color = color * (Vec3::ONE - material.kt);
        }
        if bounces > 0 {
            color = color + self.secondary(p, d, hit, back, &material, bounces, index);
        }
        color
    }

    fn fading(&self, a: Vec3, d: f64) -> f64 {
        let a = match self.scene.year {
            Year::F12a4 => Vec3(1.0, 0.0, 0.0),
            Year::F12a5 => Vec3(1.0, 0.0, a.2),
            Year::F16 => Vec3(0.0, 0.0, a.2),
            Year::F04 | Year::Durer => a,
        };
        let whole = a.0 + a.1 * d + a.2 * d * d;
        match () {
            () if self.is("no-falloff") => 1.0,
            () if self.is("falloff-1-over-d") => 1.0 / d,
            () if self.is("falloff-1-over-d2") => 1.0 / (d * d),
            () if self.is("falloff-multiplied") => whole,
            () if self.is("falloff-linear") => 1.0 / (a.0 + (a.1 + a.2) * d),
            () if self.is("falloff-with-one") => 1.0 / (1.0 + whole),
            () => 1.0 / whole,
        }
    }

    fn direct(&self, material: &Material, n: Vec3, d: Vec3, l: Vec3) -> Vec3 {
        let cosine = n.dot(l);
        let d = if self.is("highlight-along-axis") { self.scene.look.unit() } else { d };
        let diffuse = match () {
            () if self.is("no-diffuse") => 0.0,
            () if self.is("no-cosine") => 1.0,
            () if self.is("two-sided") => cosine.abs(),
            () if self.is("not-clamped-below") => cosine,
            () if self.is("cosine-of-view") => n.dot(-d).max(0.0),
            () => cosine.max(0.0),
        };
        let kd = if self.is("diffuse-twice") { material.kd * material.kd } else { material.kd };
        let mut color = kd * diffuse;
        let none = self.scene.year == Year::F12a5 && !self.is("highlights-added") || self.is("no-highlights");
        if none {
            return color;
        }
        let exponent = material.shininess
            * match () {
                () if self.is("exponent-doubled") => 2.0,
                () if self.is("exponent-halved") => 0.5,
                () if self.is("exponent-3") => 3.0,
                () => 1.0,
            };
        let exponent = match () {
            () if self.is("exponent-one") => 1.0,
            () if self.is("exponent-plus-one") => exponent + 1.0,
            () => exponent,
        };
        let exponent = if self.is("exponent-4") { 4.0 * material.shininess } else { exponent };
        let blinn = matches!(self.scene.year, Year::F04 | Year::Durer) != self.is("other-model");
        let base = if blinn {
            let h = l - d;
            let h = match () {
                () if self.is("half-sum") => h,
                () if self.is("half-mean") => h * 0.5,
                () => h.unit(),
            };
            if cosine > 0.0 { n.dot(h) } else { return color }
        } else {
            if cosine <= 0.0 && self.scene.year == Year::F04 {
                return color;
            }
            let r = d - n * (if self.is("highlight-mirror") { 1.0 } else { 2.0 } * d.dot(n));
            r.dot(l)
        };
        let mut strength = base.max(0.0).powf(exponent);
        if self.is("highlight-cosine") {
            strength *= cosine.max(0.0);
        }
        let ks = match () {
            () if self.is("highlight-diffuse") => material.ks * material.kd,
            () if self.is("highlight-bare") => Vec3::ONE,
            () => material.ks,
        };
        color = color + ks * strength;
        color
    }

    #[allow(clippy::too_many_arguments, reason = "the judge's tracer is one function a step")]
    fn secondary(
        &self,
        p: Vec3,
        d: Vec3,
        hit: &Hit,
        back: bool,
        material: &Material,
        bounces: u32,
        index: f64,
    ) -> Vec3 {
        let n = if back { -hit.n } else { hit.n };
        let glassy = material.index > 0.0 && matches!(self.scene.year, Year::F12a5);
        let (mut kr, mut kt) = match self.scene.year {
            Year::F04 | Year::Durer => (material.kr, material.kt),
            Year::F12a4 => return Vec3::ZERO,
            Year::F12a5 if glassy => (material.ks, material.ks),
            Year::F12a5 | Year::F16 => (material.ks, Vec3::ZERO),
        };
        let (here, there) = match (back, glassy) {
            (true, true) => (index, 1.0),
            (true, false) => (material.index, 1.0),
            (false, true) => (index, material.index),
            (false, false) => (1.0, material.index),
        };
        let eta = match () {
            () if self.is("index-inverted") => there / here,
            () if self.is("exit-not-swapped") => 1.0 / material.index,
            () => here / there,
        };
        let mirror = match () {
            () if self.is("mirror-negated") => n * (2.0 * d.dot(n)) - d,
            () if self.is("mirror-along") => d - n * d.dot(n),
            () if self.is("mirror-normal") => n,
            () if self.is("mirror-along-unit") => (d - n * d.dot(n)).unit(),
            () if self.is("sphere-normals-long") || self.is("radius-not-squared") => (d - n * (2.0 * d.dot(n))).unit(),
            () => d - n * (2.0 * d.dot(n)),
        };
        let c = d.dot(n);
        let root = 1.0 - eta * eta * (1.0 - c * c);
        let through = match () {
            () if self.is("not-bent") => Some(d),
            () if self.is("refraction-formula") => {
                let root = 1.0 - eta * (1.0 - c * c);
                (root >= 0.0).then(|| (d - n * c) * eta - n * root.sqrt())
            }
            () if root < 0.0 && self.is("total-clamped") => Some((d - n * c) * eta),
            () if root < 0.0 && self.is("total-mirrored") => Some(mirror),
            () if root < 0.0 && self.is("total-straight") => Some(d),
            () if root < 0.0 && kt.max_component() > 0.0 && self.is("total-black") => {
                return Vec3(f64::NAN, f64::NAN, f64::NAN);
            }
            () if self.is("root-added") => (root >= 0.0).then(|| (d - n * c) * eta + n * root.sqrt()),
            () => (root >= 0.0).then(|| (d - n * c) * eta - n * root.sqrt()),
        };
        if glassy && !self.is("no-fresnel") {
            let r0 = ((there - here) / (there + here)).powi(2);
            let cosine = if here <= there { c.abs() } else { through.map_or(0.0, |t| t.dot(n).abs()) };
            let total = if self.is("total-lost") { r0 + (1.0 - r0) * (1.0 - c.abs()).powi(5) } else { 1.0 };
            let r = through.map_or(total, |_| match self.is("fresnel-constant") {
                true => r0,
                false => r0 + (1.0 - r0) * (1.0 - cosine).powi(5),
            });
            let r = if self.is("fresnel-exchanged") { 1.0 - r } else { r };
            (kr, kt) = (kr * r, kt * (1.0 - r));
        }
        let mut color = Vec3::ZERO;
        let times = if self.is("secondary-each-light") { self.scene.lights.len() } else { 1 };
        for _ in 0..times {
            if kr.max_component() > 0.0 && !self.is("no-reflection") {
                let weight = if self.is("mirror-in-full") { Vec3::ONE } else { kr };
                let p = if self.is("mirror-start") { p + n * 0.3 } else { p };
                color = color + weight * self.trace(p, mirror, bounces - 1, index, false);
            }
            if let (Some(t), true) = (through, kt.max_component() > 0.0 && !self.is("no-refraction")) {
                let weight = if self.is("glass-in-full") { Vec3::ONE } else { kt };
                let (p, there) = if self.is("glass-in-front") { (p + n * 0.003, here) } else { (p, there) };
                color = color + weight * self.trace(p, t, bounces - 1, there, false);
            }
        }
        color
    }

    fn trace(&self, o: Vec3, d: Vec3, bounces: u32, index: f64, first: bool) -> Vec3 {
        let least = match first {
            true if self.scene.angle < 0.0 => f64::NEG_INFINITY,
            true => 0.0,
            false => self.epsilon(false),
        };
        match self.hit(o, d, least, f64::INFINITY) {
            Some(hit) => self.shade(o, d, &hit, bounces, index),
            None if !first && self.is("secondary-black-sky") => Vec3::ZERO,
            None if self.is("ambient-sky") => self.background(d) + self.scene.ambient,
            None => self.background(d),
        }
    }
}
