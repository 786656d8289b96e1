//! A rectangle or parallelogram.

use super::{Flip, MeshData, Plane, Shape, ShapeHit, SurfacePoint, inset, padded_box, tessellate};
use crate::describe::{Constraint, described};
use crate::dialect::set;
use crate::light::{EmitterShape, EmitterTransform};
use crate::math::{Aabb, Line, Ray, Vec2, Vec3, gamma};
use glam::DVec3;

described! {
    /// A rectangle, or a parallelogram if its edges are not perpendicular. Seen from the front,
    /// `edge1` is counter-clockwise from `edge0`.
    Rectangle ["Rectangle" in set::DURER] {
        /// Position of a corner.
        corner: Vec3 = Vec3::ZERO, required, Constraint::Any, ["corner" in set::DURER];
        /// Edge from the corner to the next one.
        edge0: Vec3 = Vec3::X, required, Constraint::NonZero, ["edge0" in set::DURER];
        /// Edge from the corner to the previous one.
        edge1: Vec3 = Vec3::Y, required, Constraint::NonZero, ["edge1" in set::DURER];
    }
}

impl Rectangle {
    fn edges(&self) -> [DVec3; 2] {
        [self.edge0.as_dvec3(), self.edge1.as_dvec3()]
    }

    /// Returns the ray parameter at which a line meets the plane. The parameter is infinite or NaN
    /// if the line is parallel to the plane.
    fn plane_at(&self, line: &Line) -> f64 {
        let [e, f] = self.edges();
        let n = e.cross(f);
        n.dot(self.corner.as_dvec3() - line.origin) / n.dot(line.dir)
    }

    /// Returns the edge coordinates of a point of the plane if the point is on the rectangle. The
    /// test fails if a coordinate is NaN.
    fn local_uv(&self, point: DVec3) -> Option<Vec2> {
        let [u, v] = self.shares(point);
        let inside = (0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v);
        inside.then(|| Vec2::new(u as f32, v as f32))
    }

    /// Returns the coordinates of a point of the plane along both edges, computed by Cramer's rule.
    fn shares(&self, point: DVec3) -> [f64; 2] {
        let [e, f] = self.edges();
        let (n, q) = (e.cross(f), point - self.corner.as_dvec3());
        let n2 = n.length_squared();
        [q.cross(f).dot(n) / n2, e.cross(q).dot(n) / n2]
    }
}

impl Shape for Rectangle {
    fn bounds(&self) -> Option<Aabb> {
        let ([e, f], corner) = (self.edges(), self.corner.as_dvec3());
        let zero = DVec3::ZERO;
        Some(padded_box(corner + e.min(zero) + f.min(zero), corner + e.max(zero) + f.max(zero)))
    }

    fn crossings(&self, line: &Line, emit: &mut impl FnMut(f64, Vec2)) {
        let t = self.plane_at(line);
        if let Some(uv) = self.local_uv(line.at(t)) {
            emit(t, uv);
        }
    }

    fn intersect(&self, ray: &Ray) -> Option<ShapeHit> {
        // For most rays, the plane is not hit within the interval, so compute the edge coordinates
        // only for the others.
        let line = ray.line();
        let t = self.plane_at(&line);
        let hit = ray.contains(t as f32) && line.is_valid();
        let uv = if hit { self.local_uv(line.at(t)) } else { None };
        uv.map(|uv| ShapeHit { t: t as f32, uv })
    }

    fn centered(&self) -> Option<(Self, Vec3)> {
        Some((Rectangle { corner: Vec3::ZERO, ..self.clone() }, self.corner))
    }

    fn surface(&self, point: DVec3, _crossing: &ShapeHit) -> SurfacePoint {
        let ([e, f], corner) = (self.edges(), self.corner.as_dvec3());
        let error = gamma(2) * (self.corner.abs() + self.edge0.abs() + self.edge1.abs()).max_element();
        let [u, v] = self.shares(point);
        let (u, v) = (inset(u, 1.0, error / e.length() as f32), inset(v, 1.0, error / f.length() as f32));
        let floor = 1e-14 * (corner.abs() + e.abs() + f.abs()).max_element();
        SurfacePoint::new(corner + u * e + v * f, e.cross(f), floor as f32, Vec2::new(u as f32, v as f32))
    }

    fn validate(&self) -> Result<(), String> {
        let [e, f] = self.edges().map(|e| e.normalize_or_zero());
        match e.cross(f).length() < 1e-6 {
            true => Err("the edges of a `Rectangle` must not be parallel".into()),
            false => Ok(()),
        }
    }

    fn inside(&self, _: DVec3) -> Option<bool> {
        None
    }

    fn starts_inside(&self, _: &Line) -> bool {
        false
    }

    fn flip(&self) -> Option<Flip> {
        Some(Flip::Edges(["edge0", "edge1"]))
    }

    fn plane(&self) -> Option<&Plane> {
        None
    }

    fn polygons(&self) -> Vec<Vec<Vec3>> {
        let (a, b) = (self.corner + self.edge0, self.corner + self.edge1);
        vec![vec![self.corner, a, a + self.edge1, b]]
    }

    fn emitter(&self, transform: &EmitterTransform) -> Option<(EmitterShape, Vec3)> {
        let n = self.edge0.as_dvec3().cross(self.edge1.as_dvec3()).normalize_or_zero().as_vec3();
        let edges = [transform.vector(self.edge0), transform.vector(self.edge1)];
        Some((EmitterShape::Parallelogram(transform.point(self.corner), edges), transform.normal(n)))
    }

    fn tangent(&self, _: Vec3) -> Option<Vec3> {
        Some(self.edge0)
    }

    fn to_mesh(&self) -> Option<MeshData> {
        Some(tessellate::parallelogram(self.corner, [self.edge0, self.edge1]))
    }

    fn outline(&self, _: &Aabb) -> Option<Vec<Vec<Vec3>>> {
        None
    }
}
