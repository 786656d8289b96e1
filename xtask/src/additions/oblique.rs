//! Example of a camera: parallel rays that are not perpendicular to the picture, as in a cabinet
//! projection.

use super::{CameraSample, CameraBasis, Projection, Pose};
use crate::describe::{Constraint, described};
use crate::dialect::set;
use crate::math::{Ray, Vec2, Vec3};
use glam::DVec2;

described! {
    /// Camera with parallel rays that are oblique to the picture.
    ObliqueCamera ["ObliqueCamera" in set::DURER] {
        /// Centre of the picture.
        center: Vec3 = Vec3::ZERO, required, Constraint::Any, ["center" in set::DURER];
        /// View direction, of any length.
        direction: Vec3 = Vec3::NEG_Z, required, Constraint::NonZero, ["direction" in set::DURER];
        /// Up direction of the picture.
        up: Vec3 = Vec3::Y, required, Constraint::NonZero, ["up" in set::DURER];
        /// Length of the picture's larger side.
        size: f32 = 2.0, required, Constraint::Positive, ["size" in set::DURER];
        /// Offset of rays to the left and down per unit of depth.
        slant: f32 = 0.5, optional, Constraint::Any, ["slant" in set::DURER];
    }
}

impl Projection for ObliqueCamera {
    fn pose(&self) -> Pose {
        Pose { center: self.center, direction: self.direction, up: self.up }
    }

    fn ray(&self, frame: &CameraBasis, sample: &CameraSample) -> Option<Ray> {
        let half = 0.5 * self.size;
        let origin = frame.eye + sample.point.x * half * frame.right + sample.point.y * half * frame.up;
        let dir = frame.forward - self.slant * (frame.right + frame.up);
        Some(Ray::new(origin, dir.normalize()))
    }

    fn project(&self, frame: &CameraBasis, world: Vec3, _: Vec2, emit: &mut dyn FnMut(Vec2)) {
        let p = frame.camera_from_world(world);
        let moved = DVec2::new(p.x, p.y) + f64::from(self.slant) * p.z.abs();
        emit((moved / (0.5 * f64::from(self.size))).as_vec2());
    }

    fn footprint(&self, frame: &CameraBasis, _: &CameraSample, _: f32) -> f32 {
        let half = 0.5 * f64::from(self.size);
        let slant = f64::from(self.slant);
        (half * half * frame.volume() / (1.0 + 2.0 * slant * slant).sqrt()) as f32
    }
}
