//! An infinite plane with the equation normal · p = offset.

use super::{Flip, MeshData, Shape, ShapeHit, SurfacePoint, Uv};
use crate::describe::{Constraint, described};
use crate::dialect::set;
use crate::light::{EmitterShape, EmitterTransform};
use crate::math::{Aabb, Line, Ray, Vec2, Vec3, gamma};
use glam::DVec3;

described! {
    /// An infinite plane: all points p with normal · p = offset. As part of a solid, it is the half
    /// space behind the plane.
    Plane ["Plane" in set::CLASSIC, "plane" in set::F23] {
        /// Normal on the front side; of any length.
        normal: Vec3 = Vec3::Y, required, Constraint::NonZero, ["normal" in set::ALL];
        /// Distance from the origin along the normal, for a unit normal.
        offset: f32 = 0.0, required, Constraint::Any, ["offset" in set::ALL];
    }
}

impl Shape for Plane {
    fn bounds(&self) -> Option<Aabb> {
        None
    }

    fn intersect(&self, ray: &Ray) -> Option<ShapeHit> {
        let n = self.normal.as_dvec3();
        let slope = n.dot(ray.dir.as_dvec3());
        // For a ray parallel to the plane, the slope is zero. If the direction of the ray is
        // infinite, so is the slope. In both cases, the ray does not count as a hit.
        let t = ((f64::from(self.offset) - n.dot(ray.origin.as_dvec3())) / slope) as f32;
        (slope.is_finite() && t.is_finite() && ray.contains(t)).then_some(ShapeHit { t, uv: Vec2::ZERO })
    }

    fn crossings(&self, line: &Line, emit: &mut impl FnMut(f64, Vec2)) {
        let n = self.normal.as_dvec3();
        let slope = n.dot(line.dir);
        if slope != 0.0 {
            emit((f64::from(self.offset) - n.dot(line.origin)) / slope, Vec2::ZERO);
        }
    }

    fn inside(&self, point: DVec3) -> Option<bool> {
        Some(self.normal.as_dvec3().dot(point) < f64::from(self.offset))
    }

    fn starts_inside(&self, line: &Line) -> bool {
        let n = self.normal.as_dvec3();
        let slope = n.dot(line.dir);
        slope > 0.0 || slope == 0.0 && n.dot(line.origin) < f64::from(self.offset)
    }

    #[inline(always)]
    fn surface(&self, p: DVec3, _crossing: &ShapeHit) -> SurfacePoint {
        let n = self.normal.as_dvec3();
        // Project the point back onto the plane, so that its only error is the rounding of its
        // coordinates.
        let on = p - n * ((n.dot(p) - f64::from(self.offset)) / n.dot(n));
        let position = on.as_vec3();
        let normal = n.normalize_or(DVec3::Y).as_vec3();
        SurfacePoint {
            position,
            rounding_error: Vec3::ZERO,
            error: gamma(2) * position.abs(),
            curvature: 0.0,
            n_geo: normal,
            n_shade: normal,
            uv: Uv::Plane(normal, position),
            barycentric: Vec3::ZERO,
            shadow_offsets: [Vec3::ZERO; 2],
            color: [1.0; 4],
            solid: None,
        }
    }

    fn centered(&self) -> Option<(Self, Vec3)> {
        None
    }

    fn validate(&self) -> Result<(), String> {
        Ok(())
    }

    fn flip(&self) -> Option<Flip> {
        Some(Flip::Negate(&["normal", "offset"]))
    }

    fn plane(&self) -> Option<&Plane> {
        Some(self)
    }

    fn polygons(&self) -> Vec<Vec<Vec3>> {
        Vec::new()
    }

    fn emitter(&self, _: &EmitterTransform) -> Option<(EmitterShape, Vec3)> {
        None
    }

    fn tangent(&self, _: Vec3) -> Option<Vec3> {
        None
    }

    fn to_mesh(&self) -> Option<MeshData> {
        None
    }

    /// Draws a grid around the point of the plane that is closest to the centre of `around`.
    fn outline(&self, around: &Aabb) -> Option<Vec<Vec<Vec3>>> {
        let n = self.normal.normalize_or(Vec3::Y);
        let (u, v) = n.any_orthonormal_pair();
        let middle = around.center();
        let foot = middle - (middle.dot(n) - self.offset / self.normal.length()) * n;
        let half = 0.4 * around.size().length().max(1e-3);
        let across = |a: Vec3, b: Vec3| (-3..=3).map(move |i| foot + half * i as f32 / 3.0 * a + half * b);
        let lines = |a: Vec3, b: Vec3| across(a, -b).zip(across(a, b)).map(|(p, q)| vec![p, q]).collect::<Vec<_>>();
        Some([lines(u, v), lines(v, u)].concat())
    }
}
