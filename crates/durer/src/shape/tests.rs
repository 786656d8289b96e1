//! What holds for every shape of the list: each against an independent statement of itself in
//! double precision.

mod inside;
mod leaving;
mod mesh_rules;
mod tangents;
mod terrain;

use super::*;
use crate::describe::DescribedList;
use crate::math::random::Random;

/// One of each, of about this size, about this far away. A new shape is added here, and in the
/// match below.
fn samples(random: &mut Random, size: f32, distance: f32) -> Vec<Primitive> {
    let center = distance * random.direction();
    let mut corner = || center + size * random.point();
    let triangle = Triangle { vertex0: corner(), vertex1: corner(), vertex2: corner() };
    let normal = random.between(0.1, 10.0) * random.direction();
    let mut length = |least| size * random.between(least, 1.0);
    let [radius, r0, r1, minor, inner] = [length(0.1), length(0.3), length(0.0), length(0.1), length(0.0)];
    let half = 0.5 * Vec3::new(length(0.2), length(0.2), length(0.2));
    let radii = Vec3::new(length(0.3), length(0.3), length(0.3));
    let height = length(0.3) * random.direction();
    let mut edge = || size * random.between(0.6, 1.0) * random.direction();
    let (e, f) = (edge(), edge());
    // A third of the cones have a tip, at either end.
    let [base_radius, top_radius] = [[r0, r1], [r0, 0.0], [0.0, r0]][random.below(3)];
    let shapes: Vec<Primitive> = vec![
        Sphere { center, radius }.into(),
        Plane { normal, offset: normal.dot(center) + size * random.between(-1.0, 1.0) }.into(),
        triangle.into(),
        Cuboid { min: center - half, max: center + half }.into(),
        Cylinder { base: center, top: center + height, radius: r0 }.into(),
        Cone { base: center, top: center + height, base_radius, top_radius }.into(),
        Torus { center, axis: normal, major_radius: size * 1.1, minor_radius: minor }.into(),
        Ellipsoid { center, radii }.into(),
        quadric(random, center, size).into(),
        Disc { center, normal, radius: size, inner_radius: 0.9 * inner }.into(),
        Rectangle { corner: center, edge0: e, edge1: f }.into(),
    ];
    assert_eq!(shapes.len(), Primitive::kinds().len(), "a shape of the list is not tested");
    shapes
}

/// An ellipsoid, hyperboloid, cone, cylinder or paraboloid.
fn quadric(random: &mut Random, center: Vec3, size: f32) -> Quadric {
    let size = f64::from(size);
    let turned = random.rotation();
    let curve = [[1.0, 1.0, 1.0], [1.0, 1.0, -1.0], [1.0, -1.0, -1.0], [1.0, 1.0, 0.0]][random.below(4)];
    let mut stretch = || f64::from(random.between(1.0, 3.0)) / (size * size);
    let diagonal = DVec3::from(curve) * DVec3::new(stretch(), stretch(), stretch());
    let m = turned * glam::DMat3::from_diagonal(diagonal) * turned.transpose();
    // The last kind is a cylinder, or a paraboloid along its axis.
    let along = if curve[2] == 0.0 && random.below(2) == 0 { turned.z_axis / size } else { DVec3::ZERO };
    let constant = [-1.0, -1.0, -0.5][random.below(3)];
    let c = center.as_dvec3();
    Quadric {
        squares: DVec3::new(m.x_axis.x, m.y_axis.y, m.z_axis.z).as_vec3(),
        products: (2.0 * DVec3::new(m.x_axis.y, m.x_axis.z, m.y_axis.z)).as_vec3(),
        linear: (along - 2.0 * (m * c)).as_vec3(),
        constant: (c.dot(m * c) - along.dot(c) + constant) as f32,
    }
}

/// How far a point is from each face, or from its continuation, counted along the normal; all but
/// the greatest do not matter where that is zero.
fn faces(shape: &Primitive, p: DVec3) -> Vec<f64> {
    let flat = |n: DVec3, at: Vec3| vec![n.normalize().dot(p - at.as_dvec3())];
    // Height and distance from the line between two points, and the height of the other end.
    let round = |base: Vec3, top: Vec3| {
        let (base, along) = (base.as_dvec3(), top.as_dvec3() - base.as_dvec3());
        let y = (p - base).dot(along.normalize());
        (y, (p - base - y * along.normalize()).length(), along.length())
    };
    match shape {
        Primitive::Sphere(s) => vec![(p - s.center.as_dvec3()).length() - f64::from(s.radius)],
        Primitive::Plane(s) => {
            let n = s.normal.as_dvec3();
            vec![(n.dot(p) - f64::from(s.offset)) / n.length()]
        }
        Primitive::Triangle(s) => {
            let [a, b, c] = [s.vertex0, s.vertex1, s.vertex2].map(Vec3::as_dvec3);
            vec![(b - a).cross(c - a).normalize().dot(p - a)]
        }
        Primitive::Cuboid(s) => {
            let (below, above) = (s.min.as_dvec3() - p, p - s.max.as_dvec3());
            below.to_array().into_iter().chain(above.to_array()).collect()
        }
        Primitive::Cylinder(s) => {
            let (y, around, height) = round(s.base, s.top);
            vec![-y, y - height, around - f64::from(s.radius)]
        }
        Primitive::Cone(s) => {
            let (y, around, height) = round(s.base, s.top);
            let [low, high] = [f64::from(s.base_radius), f64::from(s.top_radius)];
            let slope = (high - low) / height;
            vec![-y, y - height, (around - low - slope * y) / (1.0 + slope * slope).sqrt()]
        }
        Primitive::Torus(s) => {
            let a = s.axis.as_dvec3().normalize();
            let q = p - s.center.as_dvec3();
            let (y, around) = (q.dot(a), (q - q.dot(a) * a).length());
            vec![libm::hypot(around - f64::from(s.major_radius), y) - f64::from(s.minor_radius)]
        }
        Primitive::Ellipsoid(s) => {
            let u = (p - s.center.as_dvec3()) / s.radii.as_dvec3();
            vec![0.5 * (u.length_squared() - 1.0) / (u / s.radii.as_dvec3()).length()]
        }
        Primitive::Quadric(s) => {
            let ([a, b, c], [d, e, f]) = (s.squares.as_dvec3().to_array(), s.products.as_dvec3().to_array());
            let [x, y, z] = p.to_array();
            let g = s.linear.as_dvec3();
            let value = a * x * x + b * y * y + c * z * z + d * x * y + e * x * z + f * y * z + g.dot(p);
            let slope =
                DVec3::new(2.0 * a * x + d * y + e * z, 2.0 * b * y + d * x + f * z, 2.0 * c * z + e * x + f * y);
            vec![(value + f64::from(s.constant)) / (slope + g).length()]
        }
        Primitive::Disc(s) => flat(s.normal.as_dvec3(), s.center),
        Primitive::Rectangle(s) => flat(s.edge0.as_dvec3().cross(s.edge1.as_dvec3()), s.corner),
    }
}

/// How far a point is from the surface, or from its continuation, counted along the normal.
fn distance(shape: &Primitive, p: DVec3) -> f64 {
    faces(shape, p).into_iter().fold(f64::NEG_INFINITY, f64::max)
}

/// Whether a point of a quadric is so far from the origin that its terms leave only rounding.
fn too_far(shape: &Primitive, p: DVec3, reach: f64) -> bool {
    matches!(shape, Primitive::Quadric(_)) && p.length() > 20.0 * reach
}

/// Whether another face is as near to a point as this.
fn near_edge(shape: &Primitive, p: DVec3, reach: f64) -> bool {
    let all = faces(shape, p);
    all.iter().filter(|f| f.abs() < reach).count() > 1
}

/// All places where a line meets the shape, or may meet it for all that single precision can tell
/// (`false`).
fn crossings(shape: &Primitive, o: DVec3, d: DVec3) -> Vec<(f64, bool)> {
    match shape {
        Primitive::Sphere(s) => {
            let (o, r) = (o - s.center.as_dvec3(), f64::from(s.radius));
            let middle = -o.dot(d) / d.dot(d);
            let beside = r * r - (o + middle * d).length_squared();
            if beside < -1e-9 * r * r {
                return Vec::new();
            }
            let half = beside.max(0.0).sqrt() / d.length();
            [middle - half, middle + half].map(|t| (t, beside > 1e-9 * r * r)).to_vec()
        }
        Primitive::Plane(s) => {
            let n = s.normal.as_dvec3();
            vec![((f64::from(s.offset) - n.dot(o)) / n.dot(d), true)]
        }
        Primitive::Triangle(s) => {
            let [a, b, c] = [s.vertex0, s.vertex1, s.vertex2].map(Vec3::as_dvec3);
            let n = (b - a).cross(c - a);
            let t = n.dot(a - o) / n.dot(d);
            let p = o + t * d;
            // Heights over the three edges. The ray is sheared in single precision: 8 roundings of
            // the distance, which count for more where the triangle is seen from its side.
            let heights = [(a, b), (b, c), (c, a)].map(|(e, f)| n.cross(f - e).normalize().dot(p - e));
            let least = heights.into_iter().fold(f64::INFINITY, f64::min);
            let reach = [a, b, c].map(|x| (x - o).length()).into_iter().fold(0.0, f64::max);
            let slack = 8.0 * f64::from(f32::EPSILON) * reach * n.length() * d.length() / n.dot(d).abs();
            if least < -slack { Vec::new() } else { vec![(t, least > slack)] }
        }
        // The others are tested against their insides, or are flat.
        _ => {
            let mut all = Vec::new();
            shape.crossings(&Line { origin: o, dir: d }, &mut |t, _| all.push((t, true)));
            all
        }
    }
}

/// A point of the shape and its surface there, found by a ray from outside.
fn surface_point(shape: &Primitive, random: &mut Random, size: f32, distance: f32) -> Option<(Ray, ShapeHit)> {
    let middle = shape.bounds().map_or(distance * random.direction(), |b| b.center());
    let target = middle + size * random.point();
    let ray = Ray::new(target + 3.0 * size * random.direction(), Vec3::ZERO);
    let ray = Ray { dir: random.between(0.1, 10.0) * (target - ray.origin), ..ray };
    shape.intersect(&ray).map(|crossing| (ray, crossing))
}

#[test]
fn the_first_crossing_in_the_open_interval_is_found() {
    let mut random = Random(1);
    let mut found = [0; 11];
    for round in 0..40_000 {
        // Sizes from 1e-6 to 1e6, and far beyond what a scene has.
        let size = match round % 16 {
            14 => 1e-16,
            15 => 1e16,
            power => libm::powf(10.0, power as f32 * 12.0 / 13.0 - 6.0),
        };
        for (kind, shape) in samples(&mut random, size, 2.0 * size).iter().enumerate() {
            let origin = 4.0 * size * random.point();
            let target = shape.bounds().map_or(size * random.point(), |b| b.center() + 0.7 * size * random.point());
            let ray = Ray::new(origin, random.between(0.01, 100.0) * (target - origin));
            let all = crossings(shape, origin.as_dvec3(), ray.dir.as_dvec3());
            // Windows: a half line, a line, and pieces that begin or end between crossings.
            let middle = all.iter().map(|c| c.0).sum::<f64>() as f32 / all.len().max(1) as f32;
            let (t_min, t_max) = [
                (0.0, f32::INFINITY),
                (f32::NEG_INFINITY, f32::INFINITY),
                (middle, f32::INFINITY),
                (f32::NEG_INFINITY, middle),
                (-middle.abs(), 0.5 * middle.abs()),
            ][random.below(5)];
            let ray = Ray { t_min, t_max, ..ray };
            let crossing = shape.intersect(&ray);
            // Roots are known to a rounding of the largest of them; a bent shape's to its own size.
            let own = if kind == 0 || kind > 2 { f64::from(size) / ray.dir.as_dvec3().length() } else { 0.0 };
            let near = |a: f64, b: f64| (a - b).abs() <= 2e-7 * (a.abs() + own);
            if let Some(crossing) = crossing {
                let t = f64::from(crossing.t);
                assert!(ray.contains(crossing.t), "{shape:?} {ray:?} {crossing:?}");
                let grazing = kind == 2 && all.iter().any(|c| !c.1);
                assert!(grazing || all.iter().any(|c| near(c.0, t)), "{shape:?} {ray:?} {crossing:?} {all:?}");
                found[kind] += 1;
            }
            // What is surely there and surely in the window is not missed, nor passed over.
            for &(t, _) in all.iter().filter(|c| c.1) {
                let clear = |end: f32| !near(t, f64::from(end));
                if clear(t_min) && clear(t_max) && ray.contains(t as f32) {
                    let first = crossing.unwrap_or_else(|| panic!("missed {t}: {shape:?} {ray:?}")).t;
                    assert!(f64::from(first) <= t || near(f64::from(first), t), "{first} {t} {shape:?} {ray:?}");
                }
            }
        }
    }
    assert!(found.iter().all(|&n| n > 2_000), "{found:?}");
}

#[test]
fn a_crossing_at_either_end_of_the_interval_does_not_count() {
    let mut random = Random(2);
    for _ in 0..3_000 {
        for shape in samples(&mut random, 1.0, 2.0) {
            let Some((ray, crossing)) = surface_point(&shape, &mut random, 1.0, 2.0) else { continue };
            let t = crossing.t;
            assert_ne!(shape.intersect(&Ray { t_min: t, ..ray }).map(|c| c.t), Some(t));
            assert_eq!(shape.intersect(&Ray { t_max: t, ..ray }), None);
            let around = Ray { t_min: t.next_down(), t_max: t.next_up(), ..ray };
            assert_eq!(shape.intersect(&around), Some(crossing), "{shape:?}");
        }
    }
}

#[test]
fn the_surface_is_on_the_shape_within_its_error_and_in_its_bounds() {
    let mut random = Random(3);
    for round in 0..30_000 {
        let size = libm::powf(10.0, (round % 13) as f32 - 6.0);
        let away = size * [0.0, 1.0, 100.0][round % 3];
        for shape in samples(&mut random, size, away) {
            let Some((ray, crossing)) = surface_point(&shape, &mut random, size, away) else { continue };
            let surface = shape.surface(ray.line().at(crossing.t.into()), &crossing);
            let p = surface.position.as_dvec3();
            let n = surface.n_geo.as_dvec3();
            if too_far(&shape, p, f64::from(size + away)) {
                continue;
            }
            let bound = n.abs().dot(surface.error.as_dvec3());
            let sag = 0.5 * f64::from(surface.curvature) * surface.error.as_dvec3().length_squared();
            let off = distance(&shape, p);
            assert!(off.abs() <= bound + sag + 1e-15 * p.length(), "{shape:?} {surface:?} {off}");
            // The error is one of rounding, not more.
            let reach = p.length() + f64::from(size + away);
            assert!(surface.error.as_dvec3().max_element() <= 1e-5 * reach, "{surface:?}");
            assert!((n.length() - 1.0).abs() < 2e-7 && (surface.n_shade.length() - 1.0).abs() < 2e-7);
            if let Some(b) = shape.bounds() {
                let inside =
                    (surface.position + surface.error).cmpge(b.min) & (surface.position - surface.error).cmple(b.max);
                assert!(inside.all(), "{shape:?} {surface:?} {b:?}");
            }
            // The normal is the gradient of the distance, by central differences.
            let step = 1e-5 * f64::from(size);
            if near_edge(&shape, p, 10.0 * step) {
                continue;
            }
            let difference =
                |v: DVec3| (distance(&shape, p + step * v) - distance(&shape, p - step * v)) / (2.0 * step);
            let gradient = DVec3::new(difference(DVec3::X), difference(DVec3::Y), difference(DVec3::Z));
            // Bending by 1e-5 of the size gives third-order terms of its square against the least
            // radius; the point itself is off by its rounding against that radius.
            let bend = f64::from(surface.curvature * size);
            let slack = 1e-6 + (1e-5 * bend) * (1e-5 * bend) + 2e-7 * (1.0 + bend) * f64::from(1.0 + away / size);
            assert!((gradient - n).length() < slack, "{shape:?} {surface:?} {gradient}");
            let uv = surface.uv.get().unwrap();
            // Only planes and triangles have coordinates of another range.
            let range = matches!(shape, Primitive::Plane(_)) || (uv.cmpge(Vec2::ZERO) & uv.cmple(Vec2::ONE)).all();
            assert!(uv.is_finite() && range, "{shape:?} {uv}");
        }
    }
}

#[test]
fn a_ray_that_is_no_ray_hits_nothing() {
    let mut random = Random(4);
    let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
    for _ in 0..300 {
        for shape in samples(&mut random, 1.0, 0.0) {
            let windows = [(0.0, f32::INFINITY), (f32::NEG_INFINITY, f32::INFINITY)];
            for (t_min, t_max) in windows {
                let ray = Ray { origin: random.point(), dir: -random.point(), t_min, t_max };
                assert_eq!(shape.intersect(&Ray { dir: Vec3::ZERO, ..ray }), None);
                assert_eq!(shape.intersect(&Ray { dir: -Vec3::ZERO, ..ray }), None);
                assert_eq!(shape.intersect(&Ray { t_min: f32::NAN, ..ray }), None);
                assert_eq!(shape.intersect(&Ray { t_max: f32::NAN, ..ray }), None);
                assert_eq!(shape.intersect(&Ray { t_min: 1.0, t_max: -1.0, ..ray }), None);
                for value in bad {
                    for axis in 0..3 {
                        let mut broken = ray;
                        broken.dir[axis] = value;
                        assert_eq!(shape.intersect(&broken), None, "{shape:?} {broken:?}");
                        // Also where the rest of the direction is nothing.
                        broken.dir = Vec3::AXES[axis] * value;
                        assert_eq!(shape.intersect(&broken), None, "{shape:?} {broken:?}");
                        broken = ray;
                        broken.origin[axis] = value;
                        assert_eq!(shape.intersect(&broken), None, "{shape:?} {broken:?}");
                    }
                }
            }
        }
    }
}
