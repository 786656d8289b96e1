//! An orthographic camera, whose rays are all parallel.
//!
//! The origin of a ray is center + x size/2 right + y size/2 up.

use super::{CameraBasis, CameraSample, Handedness, Pose, Projection};
use crate::describe::{Constraint, described};
use crate::dialect::set;
use crate::math::{Ray, Vec2, Vec3};
use glam::DVec2;

described! {
    /// An orthographic camera.
    OrthographicCamera ["OrthographicCamera" in set::OLD | set::DURER] {
        /// Centre of the picture.
        center: Vec3 = Vec3::ZERO, required, Constraint::Any, ["center" in set::ALL];
        /// View direction, of any length.
        direction: Vec3 = Vec3::NEG_Z, required, Constraint::NonZero, ["direction" in set::ALL];
        /// Up direction of the picture; need not be perpendicular to `direction`.
        up: Vec3 = Vec3::Y, required, Constraint::NonZero, ["up" in set::ALL];
        /// Length of the picture's larger side, in world units.
        size: f32 = 2.0, required, Constraint::Positive, ["size" in set::ALL];
        /// Distance from `center` to the near plane, for plans and sections. Without it, objects
        /// behind `center` are visible.
        near: Option<f32> = None, optional, Constraint::Any, ["near" in set::DURER];
        /// Distance from `center` to the far plane; unlimited by default.
        far: Option<f32> = None, optional, Constraint::Any, ["far" in set::DURER];
        /// Handedness of the coordinate system; `left` mirrors the picture horizontally.
        handedness: Handedness = Handedness::Right, optional, Constraint::Any, ["handedness" in set::DURER];
    }
}

impl Projection for OrthographicCamera {
    fn pose(&self) -> Pose {
        Pose { center: self.center, direction: self.direction, up: self.up }
    }

    /// Without `near`, the ray extends in both directions, and objects behind `center` are seen at
    /// negative `t`.
    fn ray(&self, frame: &CameraBasis, sample: &CameraSample) -> Option<Ray> {
        let (point, half) = (sample.point, 0.5 * self.size);
        let x = self.handedness.sign() as f32 * point.x;
        let origin = frame.eye + x * half * frame.right + point.y * half * frame.up;
        let t_min = self.near.unwrap_or(f32::NEG_INFINITY);
        let ray = Ray::new(origin, frame.forward);
        Some(Ray { t_min, t_max: self.far.unwrap_or(ray.t_max), ..ray })
    }

    fn project(&self, frame: &CameraBasis, world: Vec3, _: Vec2, emit: &mut dyn FnMut(Vec2)) {
        let depth = (world - frame.eye).dot(frame.forward);
        if self.near.is_some_and(|near| depth < near) || self.far.is_some_and(|far| depth > far) {
            return;
        }
        let p = self.handedness.convert(frame.camera_from_world(world));
        emit((DVec2::new(p.x, p.y) / (0.5 * f64::from(self.size))).as_vec2());
    }

    /// The area is the same at all distances.
    fn footprint(&self, frame: &CameraBasis, _: &CameraSample, _: f32) -> f32 {
        let half = 0.5 * f64::from(self.size);
        (half * half * frame.volume()) as f32
    }
}
