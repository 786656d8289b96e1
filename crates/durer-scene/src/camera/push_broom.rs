//! A push-broom camera, in which a line of pixels moves along a straight path while it records, as
//! in satellites and scanners.
//!
//! The column at the fraction u of the path is a fan of rays from e(u) = start + u (end - start).
//! Their directions are forward + h up, with |h| <= tan(angle / 2). The picture has perspective
//! across the path, but not along it. The area across a ray grows linearly with distance. The area
//! is t |m·right| / |direction|² per du dh, where m = end - start.
//!
//! Source: Gupta, Hartley, *Linear Pushbroom Cameras*, PAMI 19(9), 1997.

use super::perspective::half_width;
use super::sheet::PictureSheet;
use super::{CameraBasis, CameraRules, CameraSample, Pose, Projection};
use crate::describe::{Constraint, described};
use crate::dialect::set;
use crate::math::{Ray, Vec2, Vec3};
use glam::{DVec2, DVec3};

described! {
    /// A camera that moves along a line and renders each column of the picture from the next point.
    PushBroomCamera ["PushBroomCamera" in set::DURER] {
        /// Eye position for the first column, at the left of the picture.
        start: Vec3 = Vec3::NEG_X, required, Constraint::Any, ["start" in set::DURER];
        /// Eye position for the last column, at the right of the picture.
        end: Vec3 = Vec3::X, required, Constraint::Any, ["end" in set::DURER];
        /// View direction of all columns; of any length.
        direction: Vec3 = Vec3::NEG_Z, required, Constraint::NonZero, ["direction" in set::DURER];
        /// Up direction of the picture; need not be perpendicular to `direction`.
        up: Vec3 = Vec3::Y, required, Constraint::NonZero, ["up" in set::DURER];
        /// Field of view from bottom to top, in degrees.
        angle: f32 = 60.0, required, Constraint::Between(0.0, 180.0), ["angle" in set::DURER];
        /// Ratio of the picture's width to its height.
        aspect: f32 = 2.0, optional, Constraint::Positive, ["aspect" in set::DURER];
    }
}

impl PushBroomCamera {
    fn sheet(&self) -> PictureSheet {
        PictureSheet(DVec2::new(f64::from(self.aspect), 1.0))
    }

    fn path_vector(&self) -> DVec3 {
        self.end.as_dvec3() - self.start.as_dvec3()
    }

    /// Returns the fraction of the path, and the height in the fan, for a sample.
    fn column(&self, sample: &CameraSample) -> Option<(f64, f64)> {
        let sheet = self.sheet();
        let position = sheet.position(sample.point.as_dvec2());
        let within = sheet.contains(sheet.position(sample.pixel.as_dvec2()));
        within.then(|| (position.x / sheet.0.x, (2.0 * position.y - 1.0) * half_width(self.angle)))
    }
}

impl Projection for PushBroomCamera {
    /// Returns the pose halfway along the path.
    fn pose(&self) -> Pose {
        let center = self.start.as_dvec3() + 0.5 * self.path_vector();
        Pose { center: center.as_vec3(), direction: self.direction, up: self.up }
    }

    fn proportions(&self) -> Option<Vec2> {
        self.sheet().proportions()
    }

    fn validate(&self) -> Result<(), String> {
        let frame = CameraBasis::new(self.pose(), CameraRules::default());
        let sideways = self.path_vector().dot(frame.right.as_dvec3()).abs();
        // The test is also false for a path of length 0.
        let moves = sideways > 1e-6 * self.path_vector().length();
        match moves {
            true => Ok(()),
            false => {
                Err("from `start` to `end` the camera must move sideways, not only along `direction` or `up`".into())
            }
        }
    }

    fn ray(&self, frame: &CameraBasis, sample: &CameraSample) -> Option<Ray> {
        let (u, height) = self.column(sample)?;
        let ray = frame.ray(DVec3::ZERO, DVec3::new(0.0, height, 1.0));
        Some(Ray { origin: (self.start.as_dvec3() + u * self.path_vector()).as_vec3(), ..ray })
    }

    fn project(&self, frame: &CameraBasis, world: Vec3, _: Vec2, emit: &mut dyn FnMut(Vec2)) {
        let (from_start, path) = (
            frame.vector_from_world(world.as_dvec3() - self.start.as_dvec3()),
            frame.vector_from_world(self.path_vector()),
        );
        // Find the column whose plane contains the point.
        let u = from_start.x / path.x;
        let to_point = from_start - u * path;
        let height = to_point.y / to_point.z / half_width(self.angle);
        let sheet = self.sheet();
        let position = DVec2::new(u * sheet.0.x, 0.5 * (height + 1.0));
        if to_point.z > 0.0 && sheet.contains(position) {
            emit(sheet.point(position).as_vec2());
        }
    }

    fn footprint(&self, frame: &CameraBasis, sample: &CameraSample, t: f32) -> f32 {
        let Some((_, height)) = self.column(sample) else { return 0.0 };
        let sheet = self.sheet();
        let unit = sheet.unit();
        let per_place = 2.0 * half_width(self.angle) / sheet.0.x;
        let sideways = self.path_vector().dot(frame.right.as_dvec3()).abs();
        (f64::from(t) * sideways / (1.0 + height * height) * per_place * unit * unit) as f32
    }
}
