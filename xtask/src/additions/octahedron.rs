//! Example of a primitive: the regular octahedron |x| + |y| + |z| <= radius around its centre.

use super::{Flip, MeshData, Plane, Shape, ShapeHit, SurfacePoint, padded_box};
use crate::describe::{Constraint, described};
use crate::dialect::set;
use crate::light::{EmitterShape, EmitterTransform};
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

    fn starts_inside(&self, _: &Line) -> bool {
        false
    }

    fn centered(&self) -> Option<(Self, Vec3)> {
        Some((Octahedron { center: Vec3::ZERO, ..self.clone() }, self.center))
    }

    fn validate(&self) -> Result<(), String> {
        Ok(())
    }

    fn flip(&self) -> Option<Flip> {
        None
    }

    fn plane(&self) -> Option<&Plane> {
        None
    }

    /// Returns the eight triangles, one in each octant.
    fn polygons(&self) -> Vec<Vec<Vec3>> {
        let vertex = |axis: Vec3, i: u8| self.center + axis * if i == 0 { self.radius } else { -self.radius };
        let face = |octant: u8| {
            let [x, y, z] = [0, 1, 2].map(|bit| octant >> bit & 1);
            let mut corners = vec![vertex(Vec3::X, x), vertex(Vec3::Y, y), vertex(Vec3::Z, z)];
            if (x + y + z) % 2 == 1 {
                corners.swap(1, 2);
            }
            corners
        };
        (0..8).map(face).collect()
    }

    /// Returns `None`, so the light of a shining octahedron is found by chance.
    fn emitter(&self, _: &EmitterTransform) -> Option<(EmitterShape, Vec3)> {
        None
    }

    fn tangent(&self, _: Vec3) -> Option<Vec3> {
        None
    }

    fn to_mesh(&self) -> Option<MeshData> {
        let positions = self.polygons().concat();
        let triangles = (0..8).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        Some(MeshData { positions, triangles, ..MeshData::default() })
    }

    fn outline(&self, _: &Aabb) -> Option<Vec<Vec<Vec3>>> {
        Some(self.polygons())
    }
}
