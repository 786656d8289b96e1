//! Intersection of rays with spheres, planes and triangles in the arithmetic of the course's
//! programs.

use super::HitRules;
use durer_scene::math::{Ray, Vec2, Vec3};
use durer_scene::shape::{Plane, Sphere};

/// Intersection of a ray with a shape, in an official program's arithmetic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Crossing {
    /// Position along the ray.
    pub t: f32,
    /// Second and third barycentric coordinates on a triangle; 0 on other shapes.
    pub uv: Vec2,
}

/// Part of a ray in which hits count, for intersections in an official program's arithmetic.
#[derive(Clone, Copy, Debug)]
pub(super) struct HitInterval {
    /// Minimum `t`, excluded.
    pub t_min: f32,
    /// Maximum `t`.
    pub t_max: f32,
    /// Nearest hit so far.
    pub best: Option<f32>,
}

impl HitInterval {
    /// Returns true if a hit at `t` counts. With `ties`, a hit at the same distance as the best hit
    /// counts too. Returns false if `t` is NaN.
    pub fn takes(&self, t: f32, ties: bool) -> bool {
        t > self.t_min && self.is_nearer(t, ties)
    }

    /// Returns true if `t` is nearer than the best hit or, with `ties`, equally near.
    fn is_nearer(&self, t: f32, ties: bool) -> bool {
        // The official programs initialize the nearest hit to the end of the ray.
        let best = self.best.unwrap_or(self.t_max.min(f32::MAX));
        t < best || ties && t == best
    }
}

/// Intersects a sphere by solving |o + t d - c|^2 = r^2 with the quadratic formula, without
/// avoiding cancellation.
pub(super) fn sphere(sphere: &Sphere, ray: &Ray, limits: HitInterval, rules: HitRules) -> Option<Crossing> {
    let Ray { dir, t_min, .. } = *ray;
    let origin = ray.origin - sphere.center;
    let a = dir.dot(dir);
    let b = 2.0 * dir.dot(origin);
    let c = origin.dot(origin) - sphere.radius * sphere.radius;
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 {
        return None;
    }
    let root = discriminant.sqrt();
    let [near, later] = [(-b - root) / (2.0 * a), (-b + root) / (2.0 * a)];
    if later < t_min && near < t_min {
        return None;
    }
    let t = match () {
        () if rules.closed_spheres => {
            let t = if near < t_min { later } else { near };
            return limits.is_nearer(t, false).then_some(Crossing { t, uv: Vec2::ZERO });
        }
        () if near > t_min => near,
        () if later > t_min && near < t_min => later,
        // Either one hit is exactly at the start of the ray, or both hits are NaN.
        () => 10_000.0,
    };
    limits.takes(t, false).then_some(Crossing { t, uv: Vec2::ZERO })
}

/// Intersects a plane by solving n·(o + t d) = offset, with n as given in the scene file.
pub(super) fn plane(plane: &Plane, ray: &Ray, limits: HitInterval, closed: bool) -> Option<Crossing> {
    let n = plane.normal;
    let t = (plane.offset - n.dot(ray.origin)) / n.dot(ray.dir);
    let begins = t > limits.t_min || closed && t == limits.t_min;
    (begins && limits.is_nearer(t, false)).then_some(Crossing { t, uv: Vec2::ZERO })
}

/// Intersects a triangle, which can be hit from both sides.
pub(super) fn triangle(corners: [Vec3; 3], ray: &Ray, limits: HitInterval, rules: HitRules) -> Option<Crossing> {
    let (t, uv) = if rules.triangle_matrix { by_matrix(corners, ray)? } else { by_areas(corners, ray)? };
    limits.takes(t, rules.tied_triangles).then_some(Crossing { t, uv })
}

/// Solves a - o = beta (a - b) + gamma (a - c) + t d by inverting the matrix whose columns are a -
/// b, a - c and d.
fn by_matrix([a, b, c]: [Vec3; 3], ray: &Ray) -> Option<(f32, Vec2)> {
    let [x, y, z] = [a - b, a - c, ray.dir];
    let to = a - ray.origin;
    // The rows of the cofactor matrix are the rows of the inverse multiplied by the determinant.
    let minor = |p: f32, q: f32, r: f32, s: f32| p * s - q * r;
    let cofactors = [
        [minor(y.y, z.y, y.z, z.z), -minor(y.x, z.x, y.z, z.z), minor(y.x, z.x, y.y, z.y)],
        [-minor(x.y, z.y, x.z, z.z), minor(x.x, z.x, x.z, z.z), -minor(x.x, z.x, x.y, z.y)],
        [minor(x.y, y.y, x.z, y.z), -minor(x.x, y.x, x.z, y.z), minor(x.x, y.x, x.y, y.y)],
    ];
    let determinant = x.x * cofactors[0][0] + y.x * cofactors[1][0] + z.x * cofactors[2][0];
    let reciprocal = 1.0 / determinant;
    let [beta, gamma, t] =
        cofactors.map(|[p, q, r]| p * reciprocal * to.x + q * reciprocal * to.y + r * reciprocal * to.z);
    (beta >= 0.0 && gamma >= 0.0 && beta + gamma <= 1.0).then_some((t, Vec2::new(beta, gamma)))
}

/// Intersects the triangle's plane and computes barycentric coordinates from the areas of the three
/// triangles around the intersection point.
fn by_areas([a, b, c]: [Vec3; 3], ray: &Ray) -> Option<(f32, Vec2)> {
    let n = (b - a).cross(c - a);
    let t = n.dot(a - ray.origin) / n.dot(ray.dir);
    let p = ray.origin + t * ray.dir;
    let whole = n.dot(n);
    let alpha = (c - b).cross(p - b).dot(n) / whole;
    let beta = (a - c).cross(p - c).dot(n) / whole;
    let gamma = (b - a).cross(p - a).dot(n) / whole;
    (alpha >= 0.0 && beta >= 0.0 && gamma >= 0.0).then_some((t, Vec2::new(beta, gamma)))
}
