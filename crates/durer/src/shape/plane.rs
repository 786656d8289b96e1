//! The plane normal · p = offset, without end.

use super::{Crossing, Shape, Surface};
use crate::describe::Rule;
use crate::described;
use crate::dialect::set;
use crate::math::{Aabb, Ray, Vec2, Vec3, gamma};

described! {
    /// A plane without end: all points p with normal · p = offset.
    Plane ["Plane" in set::CLASSIC, "plane" in set::F23] {
        /// Points to its front; of any length.
        normal: Vec3 = Vec3::Y, required, Rule::NonZero, ["normal" in set::ALL];
        /// Distance from the origin along the normal, where that has length 1.
        offset: f32 = 0.0, required, Rule::Any, ["offset" in set::ALL];
    }
}

impl Shape for Plane {
    fn bounds(&self) -> Option<Aabb> {
        None
    }

    fn intersect(&self, ray: &Ray) -> Option<Crossing> {
        let n = self.normal.as_dvec3();
        let slope = n.dot(ray.dir.as_dvec3());
        // A parallel ray divides by zero, and an infinite one by infinity: neither hits.
        let t = ((f64::from(self.offset) - n.dot(ray.origin.as_dvec3())) / slope) as f32;
        (slope.is_finite() && t.is_finite() && ray.contains(t)).then_some(Crossing { t, uv: Vec2::ZERO })
    }

    fn surface(&self, ray: &Ray, crossing: &Crossing) -> Surface {
        let n = self.normal.as_dvec3();
        let p = ray.origin.as_dvec3() + f64::from(crossing.t) * ray.dir.as_dvec3();
        // Placed back onto the plane: what is left is the rounding of the coordinates.
        let on = p - n * ((n.dot(p) - f64::from(self.offset)) / n.dot(n));
        let position = on.as_vec3();
        let normal = n.normalize_or(glam::DVec3::Y).as_vec3();
        let (tangent, bitangent) = normal.any_orthonormal_pair();
        Surface {
            position,
            error: gamma(2) * position.abs(),
            curvature: 0.0,
            n_geo: normal,
            n_shade: normal,
            uv: Some(Vec2::new(tangent.dot(position), bitangent.dot(position))),
            barycentric: Vec3::ZERO,
            lifts: [Vec3::ZERO; 2],
        }
    }
}
