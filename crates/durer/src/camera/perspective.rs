//! The pinhole camera: all rays start at the eye.
//!
//! direction = D forward + x right + y up, with D = 1 / tan(angle / 2).

use super::{CameraSample, Frame, Lens, Pose, unit_or};
use crate::describe::Rule;
use crate::described;
use crate::dialect::set;
use crate::math::{Ray, Vec3, fp};

described! {
    /// A camera that sees in perspective.
    PerspectiveCamera ["PerspectiveCamera" in set::CLASSIC, "Camera" in set::F23] {
        /// The eye.
        center: Vec3 = Vec3::ZERO, required, Rule::Any, ["center" in set::ALL];
        /// Where it looks; of any length.
        direction: Vec3 = Vec3::NEG_Z, required, Rule::NonZero, ["direction" in set::ALL];
        /// What is up in the picture; need not be perpendicular.
        up: Vec3 = Vec3::Y, required, Rule::NonZero, ["up" in set::ALL];
        /// Field of view across the picture's larger side, in degrees.
        angle: f32 = 30.0, required, Rule::Between(0.0, 180.0), ["angle" in set::CLASSIC, "fov" in set::F23];
    }
}

impl Lens for PerspectiveCamera {
    fn pose(&self) -> Pose {
        Pose { center: self.center, direction: self.direction, up: self.up }
    }

    fn ray(&self, frame: &Frame, sample: &CameraSample) -> Option<Ray> {
        let point = sample.point;
        let half = fp::tan_f64(f64::from(self.angle).to_radians() / 2.0) as f32;
        let dir = match frame.screen_point {
            false => frame.forward / half + point.x * frame.right + point.y * frame.up,
            true => {
                let corner = frame.eye + frame.forward - half * frame.right - half * frame.up;
                let along = 0.5 * (point + 1.0);
                let (across, upwards) = (2.0 * half * frame.right, 2.0 * half * frame.up);
                (corner + along.x * across + along.y * upwards) - frame.eye
            }
        };
        Some(Ray::new(frame.eye, unit_or(dir, frame.forward)))
    }
}
