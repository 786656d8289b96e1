//! Example of a primitive: the regular octahedron |x| + |y| + |z| <= radius around its centre.

use super::{Shape, ShapeHit, SurfacePoint, padded_box};
use crate::describe::{Constraint, described};
use crate::dialect::set;
use crate::math::{Aabb, Line, Vec2, Vec3};
use glam::DVec3;

described! {
    /// A regular octahedron.
    Octahedron ["Octahedron" in set::DURER] {
        /// Centre.
        center: Vec3 = Vec3::ZERO, required, Constraint::Any, ["center" in set::DURER];
        /// Distance from the centre to the vertices, which lie on the axes.
        radius: f32 = 1.0, required, Constraint::Positive, ["radius" in set::DURER];
    }
}

impl Shape for Octahedron {
    fn bounds(&self) -> Option<Aabb> {
        let (center, radius) = (self.center.as_dvec3(), f64::from(self.radius));
        Some(padded_box(center - radius, center + radius))
    }

    /// Returns the interval of a line inside the octahedron, by intersecting it with all pairs of
    /// opposite faces.
    fn crossings(&self, line: &Line, emit: &mut impl FnMut(f64, Vec2)) {
        let (mut enters, mut leaves) = (f64::NEG_INFINITY, f64::INFINITY);
        for normal in [DVec3::new(1.0, 1.0, 1.0), DVec3::new(-1.0, 1.0, 1.0), DVec3::new(1.0, -1.0, 1.0), DVec3::new(1.0, 1.0, -1.0)] {
            let (from, along) = (normal.dot(line.origin - self.center.as_dvec3()), normal.dot(line.dir));
            let ends = [-1.0, 1.0].map(|side| (side * f64::from(self.radius) - from) / along);
            (enters, leaves) = (enters.max(ends[0].min(ends[1])), leaves.min(ends[0].max(ends[1])));
        }
        if enters < leaves {
            emit(enters, Vec2::ZERO);
            emit(leaves, Vec2::ZERO);
        }
    }

    fn surface(&self, point: DVec3, _crossing: &ShapeHit) -> SurfacePoint {
        let (center, radius) = (self.center.as_dvec3(), f64::from(self.radius));
        let normal = (point - center).map(f64::signum);
        let on = point - normal * ((normal.dot(point - center) - radius) / 3.0);
        SurfacePoint::new(on, normal, 1e-14 * (center.abs().max_element() + radius) as f32, Vec2::ZERO)
    }

    fn inside(&self, point: DVec3) -> Option<bool> {
        Some((point - self.center.as_dvec3()).abs().element_sum() < f64::from(self.radius))
    }
}
