//! A fisheye camera, whose picture is a disc that shows a cone of directions, up to the full
//! sphere.
//!
//! A direction at the angle θ from the axis is shown at the radius r = f(θ) / f(angle / 2) of the
//! disc, where f depends on the projection.
//!
//! `equidistant` uses f = θ, which maps equal angles to equal lengths along the radius.
//! `equisolid` uses f = 2 sin(θ/2), which maps equal solid angles to equal areas. `stereographic`
//! uses f = 2 tan(θ/2), which maps small circles to circles. `orthographic` uses f = sin θ, which
//! is a parallel projection of the hemisphere. Under a uniform sky, equal areas of an orthographic
//! picture illuminate a horizontal surface equally.
//!
//! The solid angle per unit area is sin θ F² / (f f'), with F = f(angle / 2).
//!
//! Source: Miyamoto, *Fish Eye Lens*, Journal of the Optical Society of America 54(8), 1964;
//! Kannala, Brandt, *A Generic Camera Model and Calibration Method*, PAMI 28(8), 2006, equations 1
//! to 5.

use super::Pose;
use super::central::SingleViewpoint;
use crate::describe::{Constraint, described, described_words};
use crate::dialect::set;
use crate::math::{Vec2, Vec3, fp};
use glam::{DVec2, DVec3};

described_words! {
    /// Fisheye mapping from the angle off the axis to the radius in the picture.
    FisheyeProjection {
        Equidistant = "equidistant", Equisolid = "equisolid", Stereographic = "stereographic", Orthographic = "orthographic"
    }
}

described! {
    /// A camera that maps a cone of directions to a disc; the corners of the picture are empty.
    FisheyeCamera ["FisheyeCamera" in set::DURER] {
        /// Position of the eye.
        center: Vec3 = Vec3::ZERO, required, Constraint::Any, ["center" in set::DURER];
        /// View direction, of any length.
        direction: Vec3 = Vec3::NEG_Z, required, Constraint::NonZero, ["direction" in set::DURER];
        /// Up direction of the picture; need not be perpendicular to `direction`.
        up: Vec3 = Vec3::Y, required, Constraint::NonZero, ["up" in set::DURER];
        /// Field of view across the disc, in degrees: at most 180 for `orthographic`, less than 360
        /// for `stereographic`.
        angle: f32 = 180.0, optional, Constraint::UpTo(360.0), ["angle" in set::DURER];
        /// Mapping from the angle off the axis to the radius in the picture.
        projection: FisheyeProjection = FisheyeProjection::Equidistant, optional, Constraint::Any, ["projection" in set::DURER];
    }
}

impl FisheyeProjection {
    /// Returns the radius for an angle from the axis, and the derivative of the radius.
    pub fn radius(self, theta: f64) -> (f64, f64) {
        let (sin, cos) = fp::sin_cos_f64(theta);
        let (half_sin, half_cos) = fp::sin_cos_f64(0.5 * theta);
        match self {
            FisheyeProjection::Equidistant => (theta, 1.0),
            FisheyeProjection::Equisolid => (2.0 * half_sin, half_cos),
            FisheyeProjection::Stereographic => (2.0 * half_sin / half_cos, 1.0 / (half_cos * half_cos)),
            FisheyeProjection::Orthographic => (sin, cos),
        }
    }

    /// Returns the angle from the axis at a radius.
    pub fn theta(self, radius: f64) -> f64 {
        match self {
            FisheyeProjection::Equidistant => radius,
            FisheyeProjection::Equisolid => 2.0 * fp::asin_f64((0.5 * radius).min(1.0)),
            FisheyeProjection::Stereographic => 2.0 * fp::atan_f64(0.5 * radius),
            FisheyeProjection::Orthographic => fp::asin_f64(radius.min(1.0)),
        }
    }

    /// Returns the direction that is seen at a point of the unit disc, whose rim is at the angle
    /// `limit` from the axis.
    pub fn direction(self, point: DVec2, limit: f64) -> Option<DVec3> {
        let radius = point.length();
        if radius > 1.0 {
            return None;
        }
        let (sin, cos) = fp::sin_cos_f64(self.theta(radius * self.radius(limit).0));
        let around = if radius > 0.0 { point / radius } else { DVec2::ZERO };
        Some((sin * around).extend(cos))
    }

    /// Returns the point of the unit disc at which a unit direction is seen.
    pub fn point(self, direction: DVec3, limit: f64) -> Option<DVec2> {
        let across = direction.truncate();
        let (sin, theta) = (across.length(), fp::atan2_f64(across.length(), direction.z));
        let radius = self.radius(theta).0 / self.radius(limit).0;
        // Every point of the rim sees the direction straight backwards.
        let around = if sin > 0.0 { across / sin } else { DVec2::X };
        (theta <= limit).then(|| radius * around)
    }

    /// Solid angle per unit area of the unit disc, in steradians.
    pub fn solid_angle(self, point: DVec2, limit: f64) -> f64 {
        let rim = self.radius(limit).0;
        let theta = self.theta(point.length() * rim);
        let (radius, growth) = self.radius(theta);
        // Both sin θ / f and f' tend to 1 at the centre.
        let share = if radius > 0.0 { fp::sin_cos_f64(theta).0 / radius } else { 1.0 };
        share * rim * rim / growth
    }
}

impl FisheyeCamera {
    fn limit(&self) -> f64 {
        0.5 * f64::from(self.angle).to_radians()
    }
}

impl SingleViewpoint for FisheyeCamera {
    fn camera_pose(&self) -> Pose {
        Pose { center: self.center, direction: self.direction, up: self.up }
    }

    fn picture_proportions(&self) -> Option<Vec2> {
        Some(Vec2::ONE)
    }

    fn validate(&self) -> Result<(), String> {
        match self.projection {
            FisheyeProjection::Orthographic if self.angle > 180.0 => {
                Err("an orthographic fisheye sees at most 180 degrees".into())
            }
            FisheyeProjection::Stereographic if self.angle > 359.0 => {
                Err("a stereographic fisheye sees at most 359 degrees: at 360 the radius is infinite".into())
            }
            _ => Ok(()),
        }
    }

    fn direction(&self, point: DVec2, _: DVec2) -> Option<DVec3> {
        self.projection.direction(point, self.limit())
    }

    fn project_direction(&self, direction: DVec3, emit: &mut dyn FnMut(DVec2)) {
        self.projection.point(direction, self.limit()).into_iter().for_each(emit);
    }

    fn solid_angle(&self, point: DVec2, _: DVec2) -> f64 {
        self.projection.solid_angle(point, self.limit())
    }
}
