//! A torus, which consists of all points at a fixed distance from a circle.

use super::{Flip, MeshData, Plane, Shape, ShapeHit, SurfacePoint, angle_fraction, disc_reach, padded_box, tessellate};
use crate::bsdf::Frame;
use crate::describe::{Constraint, described};
use crate::dialect::set;
use crate::light::{ClosedBody, EmitterShape, EmitterTransform};
use crate::math::{Aabb, Line, Vec2, Vec3, gamma, roots};
use glam::DVec3;

described! {
    /// A torus: all points within `minorRadius` of a circle.
    Torus ["Torus" in set::DURER] {
        /// Centre of the circle.
        center: Vec3 = Vec3::ZERO, required, Constraint::Any, ["center" in set::DURER];
        /// Normal of the circle's plane; of any length.
        axis: Vec3 = Vec3::Y, optional, Constraint::NonZero, ["axis" in set::DURER];
        /// Radius of the circle, in world units.
        major_radius: f32 = 1.0, required, Constraint::Positive, ["majorRadius" in set::DURER];
        /// Distance from the circle: half the ring's thickness.
        minor_radius: f32 = 0.25, required, Constraint::Positive, ["minorRadius" in set::DURER];
    }
}

impl Torus {
    fn axis(&self) -> DVec3 {
        self.axis.as_dvec3().normalize_or(DVec3::Y)
    }

    fn radii(&self) -> (f64, f64) {
        (f64::from(self.major_radius), f64::from(self.minor_radius))
    }

    /// Returns the nearest point on the circle, relative to the centre.
    fn nearest(&self, q: DVec3) -> DVec3 {
        let a = self.axis();
        self.radii().0 * (q - q.dot(a) * a).normalize_or(a.any_orthonormal_vector())
    }
}

impl Shape for Torus {
    fn bounds(&self) -> Option<Aabb> {
        let (major, minor) = self.radii();
        let reach = major * disc_reach(self.axis()) + minor;
        let center = self.center.as_dvec3();
        Some(padded_box(center - reach, center + reach))
    }

    /// Solves (|p|^2 + R^2 - r^2)^2 = 4 R^2 (|p|^2 - (p·a)^2), where p is relative to the centre
    /// and a is the axis.
    ///
    /// Lengths are in units of R, and they are measured along a unit direction from the point of
    /// the line that is nearest to the centre. All coefficients then have the same order of
    /// magnitude. Source of the equation: chapter 3 by Hanrahan in Glassner (ed.), *An Introduction
    /// to Ray Tracing* (1989).
    fn crossings(&self, line: &Line, emit: &mut impl FnMut(f64, Vec2)) {
        let ((major, minor), a) = (self.radii(), self.axis());
        let shift = line.nearest(self.center.as_dvec3());
        let scale = line.dir.length() / major;
        let (o, d) = ((line.at(shift) - self.center.as_dvec3()) / major, line.dir.normalize_or_zero());
        let ratio = minor / major;
        let oo = o.length_squared();
        // Slightly beyond the bounding sphere, both ends of the line are outside the torus.
        let reach = 1.001 * (1.0 + ratio);
        let beside = reach * reach - oo;
        let thickness = 1.001 * ratio;
        let (height, slope) = (o.dot(a), d.dot(a));
        if beside.is_nan() || beside <= 0.0 || slope == 0.0 && height.abs() > thickness {
            return;
        }
        let half = beside.sqrt();
        // Use |p|^2 = s^2 + 2 e s + oo, where e = o·d is zero up to rounding.
        let e = o.dot(d);
        let k = oo + 1.0 - ratio * ratio;
        let coefficients = [
            k * k - 4.0 * (oo - height * height),
            4.0 * k * e - 8.0 * (e - height * slope),
            2.0 * k + 4.0 * e * e - 4.0 * (1.0 - slope * slope),
            4.0 * e,
            1.0,
        ];
        let (found, count) = roots::quartic(coefficients, -half, half);
        found[..count].iter().for_each(|s| emit(s / scale + shift, Vec2::ZERO));
    }

    fn centered(&self) -> Option<(Self, Vec3)> {
        Some((Torus { center: Vec3::ZERO, ..self.clone() }, self.center))
    }

    fn surface(&self, point: DVec3, _crossing: &ShapeHit) -> SurfacePoint {
        let ((major, minor), a, center) = (self.radii(), self.axis(), self.center.as_dvec3());
        let q = point - center;
        let ring = self.nearest(q);
        let normal = (q - ring).normalize_or(a);
        let (x, z) = a.any_orthonormal_pair();
        let uv = Vec2::new(
            angle_fraction(ring.dot(x), ring.dot(z)),
            angle_fraction(normal.dot(ring) / major, normal.dot(a)),
        );
        let floor = gamma(2) * (self.major_radius + self.minor_radius);
        let curvature = (1.0 / minor).max(1.0 / (major - minor));
        SurfacePoint::new(center + ring + minor * normal, normal, floor, uv).curved(curvature)
    }

    fn inside(&self, point: DVec3) -> Option<bool> {
        let q = point - self.center.as_dvec3();
        Some((q - self.nearest(q)).length() < self.radii().1)
    }

    fn validate(&self) -> Result<(), String> {
        let hole = self.minor_radius < self.major_radius;
        match hole {
            true => Ok(()),
            false => Err("`minorRadius` of a `Torus` must be less than its `majorRadius`".into()),
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
        let axis = self.axis.normalize_or(Vec3::Y);
        let frame = Frame::around(axis);
        let axes = [frame.tangent, frame.bitangent, axis].map(|axis| self.major_radius * axis);
        EmitterShape::body(transform, ClosedBody::Ring(self.minor_radius / self.major_radius), self.center, axes)
    }

    fn tangent(&self, point: Vec3) -> Option<Vec3> {
        Some(self.axis.cross(point - self.center))
    }

    fn to_mesh(&self) -> Option<MeshData> {
        Some(tessellate::torus(self.center, self.axis, [self.major_radius, self.minor_radius]))
    }

    fn outline(&self, _: &Aabb) -> Option<Vec<Vec<Vec3>>> {
        None
    }
}
