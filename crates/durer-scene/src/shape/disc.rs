//! A disc, optionally with a hole.

use super::{Flip, MeshData, Plane, Shape, ShapeHit, SurfacePoint, Uv, disc_reach, padded_box, tessellate};
use crate::bsdf::Frame;
use crate::describe::{Constraint, described};
use crate::dialect::set;
use crate::light::{EmitterShape, EmitterTransform};
use crate::math::{Aabb, Line, Vec2, Vec3};
use glam::{DVec2, DVec3};

described! {
    /// A flat disc, optionally with a hole.
    Disc ["Disc" in set::DURER] {
        /// Centre of the disc.
        center: Vec3 = Vec3::ZERO, required, Constraint::Any, ["center" in set::DURER];
        /// Normal on the front side; of any length.
        normal: Vec3 = Vec3::Y, required, Constraint::NonZero, ["normal" in set::DURER];
        /// Radius, in world units.
        radius: f32 = 1.0, required, Constraint::Positive, ["radius" in set::DURER];
        /// Radius of the hole at the centre.
        inner_radius: f32 = 0.0, optional, Constraint::NonNegative, ["innerRadius" in set::DURER];
    }
}

impl Disc {
    /// Returns the unit normal in object space.
    pub fn unit_normal(&self) -> DVec3 {
        self.normal.as_dvec3().normalize_or(DVec3::Y)
    }
}

impl Shape for Disc {
    fn bounds(&self) -> Option<Aabb> {
        let (center, reach) = (self.center.as_dvec3(), f64::from(self.radius) * disc_reach(self.unit_normal()));
        Some(padded_box(center - reach, center + reach))
    }

    fn crossings(&self, line: &Line, emit: &mut impl FnMut(f64, Vec2)) {
        let (n, center) = (self.unit_normal(), self.center.as_dvec3());
        let t = n.dot(center - line.origin) / n.dot(line.dir);
        let distance = (line.at(t) - center).length();
        // For a line parallel to the disc, t is infinite or NaN, and the comparison fails.
        if distance <= f64::from(self.radius) && distance >= f64::from(self.inner_radius) {
            emit(t, Vec2::ZERO);
        }
    }

    fn centered(&self) -> Option<(Self, Vec3)> {
        Some((Disc { center: Vec3::ZERO, ..self.clone() }, self.center))
    }

    fn surface(&self, point: DVec3, _crossing: &ShapeHit) -> SurfacePoint {
        let (n, center, radius) = (self.unit_normal(), self.center.as_dvec3(), f64::from(self.radius));
        let q = point - center;
        let q = (q - n.dot(q) * n).clamp_length_max(radius);
        let (x, z) = n.any_orthonormal_pair();
        let floor = 1e-14 * (center.abs().max_element() + radius);
        let uv = Uv::Angle(DVec2::new(q.dot(x), q.dot(z)).as_vec2(), (q.length() / radius) as f32);
        SurfacePoint::new(center + q, n, floor as f32, uv)
    }

    fn validate(&self) -> Result<(), String> {
        let there = self.inner_radius < self.radius;
        match there {
            true => Ok(()),
            false => Err("`innerRadius` of a `Disc` must be less than its `radius`".into()),
        }
    }

    fn inside(&self, _: DVec3) -> Option<bool> {
        None
    }

    fn starts_inside(&self, _: &Line) -> bool {
        false
    }

    fn flip(&self) -> Option<Flip> {
        Some(Flip::Negate(&["normal"]))
    }

    fn plane(&self) -> Option<&Plane> {
        None
    }

    fn polygons(&self) -> Vec<Vec<Vec3>> {
        Vec::new()
    }

    fn emitter(&self, transform: &EmitterTransform) -> Option<(EmitterShape, Vec3)> {
        let n = self.normal.normalize_or(Vec3::Y);
        let frame = Frame::around(n);
        let axes = [frame.tangent, frame.bitangent].map(|axis| transform.vector(self.radius * axis));
        let ellipse = EmitterShape::Ellipse(transform.point(self.center), axes, self.inner_radius / self.radius);
        Some((ellipse, transform.normal(n)))
    }

    fn tangent(&self, point: Vec3) -> Option<Vec3> {
        Some(self.normal.cross(point - self.center))
    }

    fn to_mesh(&self) -> Option<MeshData> {
        Some(tessellate::ring(self.center, self.normal, [self.inner_radius, self.radius]))
    }

    fn outline(&self, _: &Aabb) -> Option<Vec<Vec<Vec3>>> {
        None
    }
}
