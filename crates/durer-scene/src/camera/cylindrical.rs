//! A cylindrical panorama, which is a picture on a cylinder around the eye. Vertical lines remain
//! straight and vertical.
//!
//! The direction of a ray is sin λ right + cos λ forward + h up, where x is the longitude λ and y
//! is the height h on a cylinder of radius 1. The solid angle of dλ dh is dλ dh / (1 + h²)^(3/2).
//! For one eye of a stereo pair, the ray starts on the viewing circle (`eyes.rs`).
//!
//! Source: Chen, *QuickTime VR: An Image-Based Approach to Virtual Environment Navigation*,
//! SIGGRAPH 1995.

use super::eyes::EyeCircle;
use super::perspective::half_width;
use super::sheet::PictureSheet;
use super::{CameraBasis, CameraSample, Eyes, Pose, Projection};
use crate::describe::{Constraint, described};
use crate::dialect::set;
use crate::math::{Ray, Vec2, Vec3};
use glam::{DVec2, DVec3};

described! {
    /// A camera that renders a cylindrical panorama, for one eye or a pair.
    CylindricalCamera ["CylindricalCamera" in set::DURER] {
        /// Position of the eye, or centre of the circle around which both eyes rotate.
        center: Vec3 = Vec3::ZERO, required, Constraint::Any, ["center" in set::DURER];
        /// Direction to the centre of the picture; of any length.
        direction: Vec3 = Vec3::NEG_Z, required, Constraint::NonZero, ["direction" in set::DURER];
        /// Axis of the cylinder; need not be perpendicular to `direction`.
        up: Vec3 = Vec3::Y, required, Constraint::NonZero, ["up" in set::DURER];
        /// Field of view from left to right, in degrees.
        angle: f32 = 360.0, optional, Constraint::UpTo(360.0), ["angle" in set::DURER];
        /// Field of view from bottom to top, in degrees.
        vertical_angle: f32 = 90.0, optional, Constraint::Between(0.0, 180.0), ["verticalAngle" in set::DURER];
        /// Eye to render, or layout of both eyes.
        eyes: Eyes = Eyes::Middle, optional, Constraint::Any, ["eyes" in set::DURER];
        /// Distance between the eyes, in world units.
        separation: f32 = 0.065, optional, Constraint::NonNegative, ["separation" in set::DURER];
    }
}

impl CylindricalCamera {
    /// Size of the sheet for one eye, which is the unrolled cylinder of radius 1.
    fn eye_size(&self) -> DVec2 {
        DVec2::new(f64::from(self.angle).to_radians(), 2.0 * half_width(self.vertical_angle))
    }

    fn circle(&self, side: f64) -> EyeCircle {
        EyeCircle { radius: 0.5 * side * f64::from(self.separation) }
    }
}

impl Projection for CylindricalCamera {
    fn pose(&self) -> Pose {
        Pose { center: self.center, direction: self.direction, up: self.up }
    }

    fn proportions(&self) -> Option<Vec2> {
        self.eyes.sheet(self.eye_size()).proportions()
    }

    fn ray(&self, frame: &CameraBasis, sample: &CameraSample) -> Option<Ray> {
        let (view, position) = self.eyes.view(self.eye_size(), sample.point.as_dvec2(), sample.pixel.as_dvec2())?;
        let position = position - 0.5 * self.eye_size();
        let (eye, level) = self.circle(view.side).tangent(position.x);
        Some(frame.ray(eye, level + position.y * DVec3::Y))
    }

    fn project(&self, frame: &CameraBasis, world: Vec3, _: Vec2, emit: &mut dyn FnMut(Vec2)) {
        let (eye_size, p) = (self.eye_size(), frame.camera_from_world(world));
        for view in self.eyes.views(eye_size) {
            let Some((heading, distance)) = self.circle(view.side).heading(p) else { continue };
            let position = DVec2::new(heading, p.y / distance) + 0.5 * eye_size;
            if PictureSheet(eye_size).contains(position) {
                emit(self.eyes.point(eye_size, view, position).as_vec2());
            }
        }
    }

    fn footprint(&self, _: &CameraBasis, sample: &CameraSample, t: f32) -> f32 {
        let (eye_size, pixel) = (self.eye_size(), sample.pixel.as_dvec2());
        let Some((_, position)) = self.eyes.view(eye_size, sample.point.as_dvec2(), pixel) else { return 0.0 };
        let height = position.y - 0.5 * eye_size.y;
        let (square, unit) = (1.0 + height * height, self.eyes.sheet(eye_size).unit());
        (f64::from(t * t) * unit * unit / (square * square.sqrt())) as f32
    }
}
