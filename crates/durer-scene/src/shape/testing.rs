//! Reference definitions of the shapes, for tests in this crate and in dependent crates. The
//! definitions provide samples of each shape, and distances from its surface in double precision.

use super::*;
use crate::describe::DescribedKind;
use crate::math::random::Random;

/// Returns one shape of each kind, with a size of about `size`, at a distance of about `distance`
/// from the origin. New shapes must be added here and in [`faces`].
pub fn samples(random: &mut Random, size: f32, distance: f32) -> Vec<Primitive> {
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
    // A third of the cones have a tip at the base, and a third have one at the top.
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
    assert_eq!(shapes.len(), Primitive::kinds().len(), "`samples` must have one of each shape of the list");
    shapes
}

/// Returns a random ellipsoid, hyperboloid, cone, cylinder or paraboloid.
fn quadric(random: &mut Random, center: Vec3, size: f32) -> Quadric {
    let size = f64::from(size);
    let turned = random.rotation();
    let curve = [[1.0, 1.0, 1.0], [1.0, 1.0, -1.0], [1.0, -1.0, -1.0], [1.0, 1.0, 0.0]][random.below(4)];
    let mut stretch = || f64::from(random.between(1.0, 3.0)) / (size * size);
    let diagonal = DVec3::from(curve) * DVec3::new(stretch(), stretch(), stretch());
    let m = turned * glam::DMat3::from_diagonal(diagonal) * turned.transpose();
    // The last kind is a cylinder, or a paraboloid along the axis of the cylinder.
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

/// Returns the signed distance of a point from each face or its continuation, measured along the
/// normal. Only the largest distance must be exact, and only where it is zero.
pub fn faces(shape: &Primitive, p: DVec3) -> Vec<f64> {
    let flat = |n: DVec3, at: Vec3| vec![n.normalize().dot(p - at.as_dvec3())];
    // Computes the height of the point along the axis between two points, its distance from that
    // axis, and the height of the other end.
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

/// Returns the signed distance of a point from the surface or its continuation, measured along the
/// normal.
pub fn distance(shape: &Primitive, p: DVec3) -> f64 {
    faces(shape, p).into_iter().fold(f64::NEG_INFINITY, f64::max)
}

/// True for a point on a quadric that is so far from the origin that rounding errors dominate the
/// terms of the polynomial.
pub fn too_far(shape: &Primitive, p: DVec3, reach: f64) -> bool {
    matches!(shape, Primitive::Quadric(_)) && p.length() > 20.0 * reach
}

/// True if more than one face is within the distance `reach` of a point.
pub fn near_edge(shape: &Primitive, p: DVec3, reach: f64) -> bool {
    let all = faces(shape, p);
    all.iter().filter(|f| f.abs() < reach).count() > 1
}

/// Returns a ray that starts outside the shape, and its hit on the shape.
pub fn surface_point(shape: &Primitive, random: &mut Random, size: f32, distance: f32) -> Option<(Ray, ShapeHit)> {
    let middle = shape.bounds().map_or(distance * random.direction(), |b| b.center());
    let target = middle + size * random.point();
    let ray = Ray::new(target + 3.0 * size * random.direction(), Vec3::ZERO);
    let ray = Ray { dir: random.between(0.1, 10.0) * (target - ray.origin), ..ray };
    shape.intersect(&ray).map(|crossing| (ray, crossing))
}
