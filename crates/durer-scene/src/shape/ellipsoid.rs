//! An ellipsoid whose axes are parallel to the coordinate axes.

use super::{Flip, MeshData, Plane, Shape, ShapeHit, SurfacePoint, angle_fraction, padded_box, tessellate};
use crate::describe::{Constraint, described};
use crate::dialect::set;
use crate::light::{ClosedBody, EmitterShape, EmitterTransform};
use crate::math::{Aabb, Line, Vec2, Vec3, fp, gamma, roots};
use glam::DVec3;

described! {
    /// A sphere stretched along the coordinate axes.
    Ellipsoid ["Ellipsoid" in set::DURER] {
        /// Centre of the ellipsoid.
        center: Vec3 = Vec3::ZERO, required, Constraint::Any, ["center" in set::DURER];
        /// Semi-axes along x, y and z.
        radii: Vec3 = Vec3::ONE, required, Constraint::Any, ["radii" in set::DURER];
    }
}

impl Shape for Ellipsoid {
    fn bounds(&self) -> Option<Aabb> {
        let (center, radii) = (self.center.as_dvec3(), self.radii.as_dvec3());
        Some(padded_box(center - radii, center + radii))
    }

    /// Solves |(p - center) / radii|^2 = 1. Ray parameters are measured from the point of the line
    /// that is nearest to the centre of the unit sphere.
    fn crossings(&self, line: &Line, emit: &mut impl FnMut(f64, Vec2)) {
        let radii = self.radii.as_dvec3();
        let unit = Line { origin: (line.origin - self.center.as_dvec3()) / radii, dir: line.dir / radii };
        let shift = unit.nearest(DVec3::ZERO);
        let (o, d) = (unit.at(shift), unit.dir);
        if let Some((first, second)) = roots::quadratic(d.length_squared(), o.dot(d), o.length_squared() - 1.0) {
            emit(first + shift, Vec2::ZERO);
            emit(second + shift, Vec2::ZERO);
        }
    }

    fn centered(&self) -> Option<(Self, Vec3)> {
        Some((Ellipsoid { center: Vec3::ZERO, ..self.clone() }, self.center))
    }

    fn surface(&self, point: DVec3, _crossing: &ShapeHit) -> SurfacePoint {
        let (center, radii) = (self.center.as_dvec3(), self.radii.as_dvec3());
        let unit = ((point - center) / radii).normalize_or(DVec3::Z);
        // Use longitude and latitude as texture coordinates, as on a sphere.
        let v = fp::asin((unit.y as f32).clamp(-1.0, 1.0)) / std::f32::consts::PI + 0.5;
        let uv = Vec2::new(angle_fraction(-unit.z, unit.x), v);
        let (least, largest) = (radii.min_element(), radii.max_element());
        let floor = gamma(2) * largest as f32;
        SurfacePoint::new(center + radii * unit, unit / radii, floor, uv).curved(largest / (least * least))
    }

    fn inside(&self, point: DVec3) -> Option<bool> {
        Some(((point - self.center.as_dvec3()) / self.radii.as_dvec3()).length_squared() < 1.0)
    }

    fn validate(&self) -> Result<(), String> {
        let thick = self.radii.min_element() > 0.0;
        match thick {
            true => Ok(()),
            false => Err("all `radii` of an `Ellipsoid` must be more than 0".into()),
        }
    }

    fn starts_inside(&self, _: &Line) -> bool {
        false
    }

    fn flip(&self) -> Option<Flip> {
        None
    }

    fn plane(&self) -> Option<&Plane> {
        None
    }

    fn polygons(&self) -> Vec<Vec<Vec3>> {
        Vec::new()
    }

    fn emitter(&self, transform: &EmitterTransform) -> Option<(EmitterShape, Vec3)> {
        let axes = [self.radii.x * Vec3::X, self.radii.y * Vec3::Y, self.radii.z * Vec3::Z];
        EmitterShape::body(transform, ClosedBody::Ball, self.center, axes)
    }

    fn tangent(&self, point: Vec3) -> Option<Vec3> {
        Some(Vec3::Y.cross(point - self.center))
    }

    fn to_mesh(&self) -> Option<MeshData> {
        Some(tessellate::ellipsoid(self.center, self.radii))
    }

    fn outline(&self, _: &Aabb) -> Option<Vec<Vec<Vec3>>> {
        None
    }
}
