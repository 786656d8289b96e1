//! A dome picture, which a fisheye projector projects onto a dome for a viewer who is not at the
//! projector.
//!
//! A point of the picture leaves the projector P in a direction d, as in an equidistant fisheye
//! along the pole of the dome. The ray meets the dome, which is part of a unit sphere, at D = P + s
//! d. The viewer V sees this point in the direction D - V. The picture therefore shows the scene in
//! that direction, and looks undistorted from V. The pole of the dome is the scene's `up`, tilted
//! forwards by `tilt`. The front is at the bottom of the picture, as in dome masters.
//!
//! The solid angle per unit area of the picture is that of the projector's fisheye times two
//! factors. The factor s² / (D·d) converts solid angle to area on the dome. The factor (D·e) / v²
//! converts this area to solid angle at the viewer, where e is the direction from the viewer to D
//! and v is the distance.
//!
//! Source: Max, *Computer Graphics Distortion for IMAX and OMNIMAX Projection*, Nicograph '83;
//! Greene, Heckbert, *Creating Raster Omnimax Images from Multiple Perspective Views Using the
//! Elliptical Weighted Average Filter*, CG&A 6(6), 1986.

use super::Pose;
use super::central::SingleViewpoint;
use super::fisheye::FisheyeProjection;
use crate::describe::{Constraint, described};
use crate::dialect::set;
use crate::math::{Vec2, Vec3, fp};
use glam::{DMat3, DVec2, DVec3};

described! {
    /// A camera for pictures projected onto a tilted dome, with an off-centre projector and viewer;
    /// the corners are black.
    OmnimaxCamera ["OmnimaxCamera" in set::DURER] {
        /// Position of the viewer in the scene.
        center: Vec3 = Vec3::ZERO, required, Constraint::Any, ["center" in set::DURER];
        /// Horizontal direction that the audience faces; of any length.
        direction: Vec3 = Vec3::NEG_Z, required, Constraint::NonZero, ["direction" in set::DURER];
        /// Up direction of the audience; need not be perpendicular to `direction`.
        up: Vec3 = Vec3::Y, required, Constraint::NonZero, ["up" in set::DURER];
        /// Forward tilt of the dome, in degrees: 0 puts its pole overhead, 90 puts it straight
        /// ahead.
        tilt: f32 = 30.0, optional, Constraint::Any, ["tilt" in set::DURER];
        /// Angle of the sphere that the dome covers, in degrees: 180 is a hemisphere.
        dome: f32 = 180.0, optional, Constraint::UpTo(360.0), ["dome" in set::DURER];
        /// Field of view of the projector, in degrees.
        angle: f32 = 180.0, optional, Constraint::UpTo(360.0), ["angle" in set::DURER];
        /// Offset of the projector from the dome's centre: right, up and forwards, in dome radii.
        projector: Vec3 = Vec3::ZERO, optional, Constraint::Any, ["projector" in set::DURER];
        /// Offset of the viewer from the dome's centre: right, up and forwards, in dome radii.
        viewer: Vec3 = Vec3::ZERO, optional, Constraint::Any, ["viewer" in set::DURER];
    }
}

/// Returns the distance to the unit sphere from a point inside it, along a unit direction.
fn to_sphere(point: DVec3, direction: DVec3) -> f64 {
    let along = point.dot(direction);
    (along * along + 1.0 - point.length_squared()).max(0.0).sqrt() - along
}

impl OmnimaxCamera {
    /// Returns the axes of the picture in the space of the audience, as columns. The axes are
    /// right, up (towards the back of the dome) and the pole of the dome.
    fn axes(&self) -> DMat3 {
        let (sin, cos) = fp::sin_cos_degrees(f64::from(self.tilt));
        DMat3::from_cols(DVec3::X, DVec3::new(0.0, sin, -cos), DVec3::new(0.0, cos, sin))
    }

    fn limit(&self) -> f64 {
        0.5 * f64::from(self.angle).to_radians()
    }

    /// True if a point on the sphere belongs to the dome.
    fn on_dome(&self, point: DVec3) -> bool {
        let pole = self.axes().z_axis;
        fp::atan2_f64(point.cross(pole).length(), point.dot(pole)) <= 0.5 * f64::from(self.dome).to_radians()
    }

    /// Returns the direction in which the projector shows a point of the picture, and the point
    /// where that ray meets the dome.
    fn project_to_dome(&self, point: DVec2) -> Option<(DVec3, DVec3)> {
        let direction = self.axes() * FisheyeProjection::Equidistant.direction(point, self.limit())?;
        let projector = self.projector.as_dvec3();
        let position = projector + to_sphere(projector, direction) * direction;
        self.on_dome(position).then_some((direction, position))
    }
}

impl SingleViewpoint for OmnimaxCamera {
    fn camera_pose(&self) -> Pose {
        Pose { center: self.center, direction: self.direction, up: self.up }
    }

    fn picture_proportions(&self) -> Option<Vec2> {
        Some(Vec2::ONE)
    }

    fn validate(&self) -> Result<(), String> {
        let outside = |position: Vec3| position.length() >= 0.99;
        match (outside(self.projector), outside(self.viewer)) {
            (false, false) => Ok(()),
            (true, _) => Err("the projector must be inside the dome, less than 0.99 dome radii from its centre".into()),
            _ => Err("the viewer must be inside the dome, less than 0.99 dome radii from its centre".into()),
        }
    }

    fn direction(&self, point: DVec2, _: DVec2) -> Option<DVec3> {
        Some(self.project_to_dome(point)?.1 - self.viewer.as_dvec3())
    }

    fn project_direction(&self, direction: DVec3, emit: &mut dyn FnMut(DVec2)) {
        let (viewer, projector) = (self.viewer.as_dvec3(), self.projector.as_dvec3());
        let position = viewer + to_sphere(viewer, direction) * direction;
        if !self.on_dome(position) {
            return;
        }
        let dome_direction = self.axes().transpose() * (position - projector).normalize();
        FisheyeProjection::Equidistant.point(dome_direction, self.limit()).into_iter().for_each(emit);
    }

    fn solid_angle(&self, point: DVec2, _: DVec2) -> f64 {
        let Some((dome_direction, position)) = self.project_to_dome(point) else { return 0.0 };
        let from_viewer = position - self.viewer.as_dvec3();
        let of_projector = (position - self.projector.as_dvec3()).length_squared() / position.dot(dome_direction);
        let of_viewer = position.dot(from_viewer) / (from_viewer.length_squared() * from_viewer.length());
        FisheyeProjection::Equidistant.solid_angle(point, self.limit()) * of_projector * of_viewer
    }
}
