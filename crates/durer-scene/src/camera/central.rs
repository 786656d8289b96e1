//! Cameras whose rays all pass through one eye, defined by mappings between picture points and
//! directions.

use super::{CameraBasis, CameraSample, Pose, Projection};
use crate::math::{Ray, Vec2, Vec3};
use glam::{DVec2, DVec3};

/// Camera whose rays all pass through one eye, so that it only has to map picture points to
/// directions and back. Directions are in camera space: x points to the right, y upwards and z
/// forwards.
pub trait SingleViewpoint {
    /// See [`Projection::pose`].
    fn camera_pose(&self) -> Pose;

    /// See [`Projection::proportions`].
    fn picture_proportions(&self) -> Option<Vec2> {
        None
    }

    /// See [`Projection::validate`].
    fn validate(&self) -> Result<(), String> {
        Ok(())
    }

    /// Returns the direction, of any length, that is seen at `point` of the picture. `pixel` is the
    /// centre of the pixel to which the sample belongs.
    fn direction(&self, point: DVec2, pixel: DVec2) -> Option<DVec3>;

    /// Calls `emit` with every point of the picture at which the unit vector `direction` is seen.
    fn project_direction(&self, direction: DVec3, emit: &mut dyn FnMut(DVec2));

    /// Solid angle per unit area of the picture, in steradians.
    fn solid_angle(&self, point: DVec2, pixel: DVec2) -> f64;
}

impl<T: SingleViewpoint> Projection for T {
    fn pose(&self) -> Pose {
        self.camera_pose()
    }

    fn proportions(&self) -> Option<Vec2> {
        self.picture_proportions()
    }

    fn validate(&self) -> Result<(), String> {
        SingleViewpoint::validate(self)
    }

    fn ray(&self, frame: &CameraBasis, sample: &CameraSample) -> Option<Ray> {
        let direction = self.direction(sample.point.as_dvec2(), sample.pixel.as_dvec2())?;
        Some(frame.ray(DVec3::ZERO, direction))
    }

    fn project(&self, frame: &CameraBasis, world: Vec3, _: Vec2, emit: &mut dyn FnMut(Vec2)) {
        if let Some(direction) = frame.camera_from_world(world).try_normalize() {
            self.project_direction(direction, &mut |point| emit(point.as_vec2()));
        }
    }

    fn footprint(&self, _: &CameraBasis, sample: &CameraSample, t: f32) -> f32 {
        let solid_angle = self.solid_angle(sample.point.as_dvec2(), sample.pixel.as_dvec2());
        (solid_angle * f64::from(t) * f64::from(t)) as f32
    }
}
