//! An equirectangular picture, in which x is proportional to the longitude and y to the latitude.
//!
//! The direction of a ray is cos φ (sin λ right + cos λ forward) + sin φ up. A picture of the whole
//! sphere is twice as wide as it is high. The solid angle of dλ dφ is cos φ dλ dφ. For one eye of a
//! stereo pair, the ray starts on the viewing circle (`eyes.rs`) and is tangent to it, which does
//! not change the area across the ray.
//!
//! Source: Snyder, *Map Projections: A Working Manual*, USGS Professional Paper 1395, 1987, chapter
//! 12.

use super::eyes::EyeCircle;
use super::sheet::PictureSheet;
use super::{CameraBasis, CameraSample, Eyes, Handedness, Pose, Projection};
use crate::describe::{Constraint, described};
use crate::dialect::set;
use crate::math::{Ray, Vec2, Vec3, fp};
use glam::{DVec2, DVec3};

described! {
    /// A camera that sees all directions and maps longitude and latitude to a rectangle, for one
    /// eye or a pair.
    EquirectangularCamera ["EquirectangularCamera" in set::DURER] {
        /// Position of the eye, or centre of the circle around which both eyes rotate.
        center: Vec3 = Vec3::ZERO, required, Constraint::Any, ["center" in set::DURER];
        /// Direction to the centre of the picture; of any length.
        direction: Vec3 = Vec3::NEG_Z, required, Constraint::NonZero, ["direction" in set::DURER];
        /// Direction to the north pole; need not be perpendicular to `direction`.
        up: Vec3 = Vec3::Y, required, Constraint::NonZero, ["up" in set::DURER];
        /// Field of view from left to right, in degrees.
        angle: f32 = 360.0, optional, Constraint::UpTo(360.0), ["angle" in set::DURER];
        /// Field of view from bottom to top, in degrees.
        vertical_angle: f32 = 180.0, optional, Constraint::UpTo(180.0), ["verticalAngle" in set::DURER];
        /// Eye to render, or layout of both eyes.
        eyes: Eyes = Eyes::Middle, optional, Constraint::Any, ["eyes" in set::DURER];
        /// Distance between the eyes, in world units.
        separation: f32 = 0.065, optional, Constraint::NonNegative, ["separation" in set::DURER];
        /// Handedness of the coordinate system; `left` mirrors the picture horizontally.
        handedness: Handedness = Handedness::Right, optional, Constraint::Any, ["handedness" in set::DURER];
    }
}

impl EquirectangularCamera {
    /// Size of the sheet for one eye, in radians of longitude and latitude.
    fn eye_size(&self) -> DVec2 {
        DVec2::new(f64::from(self.angle), f64::from(self.vertical_angle)) * 1f64.to_radians()
    }

    fn circle(&self, side: f64) -> EyeCircle {
        EyeCircle { radius: 0.5 * side * f64::from(self.separation) }
    }
}

impl Projection for EquirectangularCamera {
    fn pose(&self) -> Pose {
        Pose { center: self.center, direction: self.direction, up: self.up }
    }

    fn proportions(&self) -> Option<Vec2> {
        // The proportions are in degrees, so that common pictures have integer sizes.
        Some(self.eyes.sheet(DVec2::new(f64::from(self.angle), f64::from(self.vertical_angle))).0.as_vec2())
    }

    fn ray(&self, frame: &CameraBasis, sample: &CameraSample) -> Option<Ray> {
        let (view, position) = self.eyes.view(self.eye_size(), sample.point.as_dvec2(), sample.pixel.as_dvec2())?;
        let angles = position - 0.5 * self.eye_size();
        let (eye, level) = self.circle(view.side).tangent(angles.x);
        let (sin, cos) = fp::sin_cos_f64(angles.y);
        let turned = |v: DVec3| self.handedness.convert(v);
        Some(frame.ray(turned(eye), turned(cos * level + sin * DVec3::Y)))
    }

    fn project(&self, frame: &CameraBasis, world: Vec3, _: Vec2, emit: &mut dyn FnMut(Vec2)) {
        let (eye_size, p) = (self.eye_size(), self.handedness.convert(frame.camera_from_world(world)));
        for view in self.eyes.views(eye_size) {
            let Some((heading, distance)) = self.circle(view.side).heading(p) else { continue };
            let position = DVec2::new(heading, fp::atan2_f64(p.y, distance)) + 0.5 * eye_size;
            if PictureSheet(eye_size).contains(position) {
                emit(self.eyes.point(eye_size, view, position).as_vec2());
            }
        }
    }

    fn footprint(&self, _: &CameraBasis, sample: &CameraSample, t: f32) -> f32 {
        let (eye_size, pixel) = (self.eye_size(), sample.pixel.as_dvec2());
        let Some((_, position)) = self.eyes.view(eye_size, sample.point.as_dvec2(), pixel) else { return 0.0 };
        let cos = fp::sin_cos_f64(position.y - 0.5 * eye_size.y).1.abs();
        let unit = self.eyes.sheet(eye_size).unit();
        (f64::from(t * t) * cos * unit * unit) as f32
    }
}
