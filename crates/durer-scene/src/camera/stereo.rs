//! A stereo pair, made of two perspective cameras side by side.
//!
//! `offAxis` shears both views so that they share one window at the convergence distance. Objects
//! at the convergence distance appear on the screen, and nearer objects appear in front of it,
//! without vertical parallax. `toeIn` turns both cameras towards a point at the convergence
//! distance, as a rig of toed-in cameras does. The two pictures then differ vertically towards the
//! corners. `parallel` neither turns nor shears the views, so all objects appear in front of the
//! screen.
//!
//! Source: Hodges, McAllister, *Stereo and Alternating-Pair Techniques for Display of
//! Computer-Generated Images*, IEEE CG&A 5(9), 1985; Bourke, *Calculating Stereo Pairs*, 1999.

use super::perspective::half_width;
use super::sheet::PictureSheet;
use super::{CameraBasis, CameraSample, Eyes, Pose, Projection};
use crate::describe::{Constraint, described, described_words};
use crate::dialect::set;
use crate::math::{Ray, Vec2, Vec3};
use glam::{DMat3, DVec2, DVec3};

described_words! {
    /// Method by which the two views of a stereo camera converge.
    StereoMethod { OffAxis = "offAxis", ToeIn = "toeIn", Parallel = "parallel" }
}

described! {
    /// A stereo camera: perspective views for both eyes, or for one of them.
    StereoCamera ["StereoCamera" in set::DURER] {
        /// Midpoint between the eyes.
        center: Vec3 = Vec3::ZERO, required, Constraint::Any, ["center" in set::DURER];
        /// View direction, of any length.
        direction: Vec3 = Vec3::NEG_Z, required, Constraint::NonZero, ["direction" in set::DURER];
        /// Up direction of the picture; need not be perpendicular to `direction`.
        up: Vec3 = Vec3::Y, required, Constraint::NonZero, ["up" in set::DURER];
        /// Field of view across the larger side of one eye's picture, in degrees.
        angle: f32 = 30.0, required, Constraint::Between(0.0, 180.0), ["angle" in set::DURER];
        /// Distance between the eyes, in world units.
        separation: f32 = 0.065, required, Constraint::NonNegative, ["separation" in set::DURER];
        /// Distance at which an object appears at the same position for both eyes; ignored by the
        /// method `parallel`.
        convergence: f32 = 1.0, optional, Constraint::Positive, ["convergence" in set::DURER];
        /// Method by which the two views converge.
        method: StereoMethod = StereoMethod::OffAxis, optional, Constraint::Any, ["method" in set::DURER];
        /// Eye to render, or layout of both eyes.
        eyes: Eyes = Eyes::SideBySide, optional, Constraint::Any, ["eyes" in set::DURER];
        /// Ratio of the width to the height of one eye's picture.
        aspect: f32 = 1.0, optional, Constraint::Positive, ["aspect" in set::DURER];
    }
}

/// Eye of a stereo camera relative to the midpoint of both eyes, with its position, its axes (as
/// columns), and the shift of its window.
struct Eye {
    at: DVec3,
    axes: DMat3,
    shear: DVec2,
}

impl StereoCamera {
    fn eye_size(&self) -> DVec2 {
        DVec2::new(f64::from(self.aspect), 1.0)
    }

    fn eye(&self, side: f64) -> Eye {
        let (x, convergence) = (0.5 * side * f64::from(self.separation), f64::from(self.convergence));
        let eye = Eye { at: DVec3::new(x, 0.0, 0.0), axes: DMat3::IDENTITY, shear: DVec2::ZERO };
        match self.method {
            StereoMethod::Parallel => eye,
            // At the convergence distance, both eyes share the window of the midpoint.
            StereoMethod::OffAxis => Eye { shear: DVec2::new(-x / convergence, 0.0), ..eye },
            StereoMethod::ToeIn => {
                let forward = DVec3::new(-x, 0.0, convergence).normalize();
                let right = DVec3::new(forward.z, 0.0, -forward.x);
                Eye { axes: DMat3::from_cols(right, DVec3::Y, forward), ..eye }
            }
        }
    }

    /// Returns the size at distance 1 of one unit on the sheet for one eye.
    fn scale(&self, frame: &CameraBasis) -> f64 {
        frame.half_width / (0.5 * self.eye_size().max_element())
    }

    /// Returns the eye of a sample, and the direction from this eye in its own axes.
    fn eye_ray(&self, frame: &CameraBasis, sample: &CameraSample) -> Option<(Eye, DVec3)> {
        let (view, position) = self.eyes.view(self.eye_size(), sample.point.as_dvec2(), sample.pixel.as_dvec2())?;
        let eye = self.eye(view.side);
        let dir = ((position - 0.5 * self.eye_size()) * self.scale(frame) + eye.shear).extend(1.0);
        Some((eye, dir))
    }
}

impl Projection for StereoCamera {
    fn pose(&self) -> Pose {
        Pose { center: self.center, direction: self.direction, up: self.up }
    }

    fn half_width(&self) -> f64 {
        half_width(self.angle)
    }

    fn proportions(&self) -> Option<Vec2> {
        self.eyes.sheet(self.eye_size()).proportions()
    }

    fn ray(&self, frame: &CameraBasis, sample: &CameraSample) -> Option<Ray> {
        let (eye, dir) = self.eye_ray(frame, sample)?;
        Some(frame.ray(eye.at, eye.axes * dir))
    }

    fn project(&self, frame: &CameraBasis, world: Vec3, _: Vec2, emit: &mut dyn FnMut(Vec2)) {
        let (eye_size, p) = (self.eye_size(), frame.camera_from_world(world));
        for view in self.eyes.views(eye_size) {
            let eye = self.eye(view.side);
            let p = eye.axes.transpose() * (p - eye.at);
            let position = (p.truncate() / p.z - eye.shear) / self.scale(frame) + 0.5 * eye_size;
            if p.z > 0.0 && PictureSheet(eye_size).contains(position) {
                emit(self.eyes.point(eye_size, view, position).as_vec2());
            }
        }
    }

    fn footprint(&self, frame: &CameraBasis, sample: &CameraSample, t: f32) -> f32 {
        let Some((_, dir)) = self.eye_ray(frame, sample) else { return 0.0 };
        let unit = self.scale(frame) * self.eyes.sheet(self.eye_size()).unit();
        (f64::from(t * t) * unit * unit / (dir.length_squared() * dir.length())) as f32
    }
}
