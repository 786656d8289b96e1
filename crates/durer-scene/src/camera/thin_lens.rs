//! A thin lens, for which the picture is sharp at one distance and blurred elsewhere.
//!
//! All light from a point in the focus plane that passes through the lens meets in one point of the
//! picture. The ray through a point l of the lens therefore goes to the point where the ray through
//! the centre of the lens meets the plane at the focus distance F: direction = (F tan(angle / 2)
//! (x + s, y + r) - l, F). A point at distance z is blurred to the shape of the aperture. In a
//! picture of width 2, the diameter of this shape is aperture |F - z| / (F z tan(angle / 2)).
//!
//! The shift (s, r) moves the film in its plane, as in view cameras. The camera stays level but
//! sees more above than below, and vertical lines stay parallel.
//!
//! Source: Cook, Porter, Carpenter, *Distributed Ray Tracing*, SIGGRAPH 1984; for the circle of
//! confusion, Potmesil, Chakravarty, *A Lens and Aperture Camera Model for Synthetic Image
//! Generation*, SIGGRAPH 1981.

use super::perspective::half_width;
use super::{CameraBasis, CameraSample, Handedness, Pose, Projection, aperture};
use crate::describe::{Constraint, described};
use crate::dialect::set;
use crate::math::{Ray, Vec2, Vec3};
use glam::{DVec2, DVec3};

described! {
    /// A camera with a lens, which has depth of field and a film that can be shifted.
    ThinLensCamera ["ThinLensCamera" in set::DURER] {
        /// Centre of the lens.
        center: Vec3 = Vec3::ZERO, required, Constraint::Any, ["center" in set::DURER];
        /// View direction along the lens axis; of any length.
        direction: Vec3 = Vec3::NEG_Z, required, Constraint::NonZero, ["direction" in set::DURER];
        /// Up direction of the picture; need not be perpendicular to `direction`.
        up: Vec3 = Vec3::Y, required, Constraint::NonZero, ["up" in set::DURER];
        /// Field of view across the picture's larger side, in degrees, for an unshifted film.
        angle: f32 = 30.0, required, Constraint::Between(0.0, 180.0), ["angle" in set::DURER];
        /// Diameter of the aperture: the focal length divided by the f-number. 0 makes everything
        /// sharp.
        aperture: f32 = 0.0, optional, Constraint::NonNegative, ["aperture" in set::DURER];
        /// Distance of the focus plane along the axis, in world units.
        focus_distance: f32 = 1.0, optional, Constraint::Positive, ["focusDistance" in set::DURER];
        /// Number of straight blades of the aperture; 0 makes it round.
        blades: u32 = 0, optional, Constraint::AtMost(aperture::MAX_BLADES), ["blades" in set::DURER];
        /// Rotation of the aperture about the axis, in degrees.
        blade_angle: f32 = 0.0, optional, Constraint::Any, ["bladeAngle" in set::DURER];
        /// Shift of the view to the right, relative to half the larger side.
        shift_right: f32 = 0.0, optional, Constraint::Any, ["shiftRight" in set::DURER];
        /// Shift of the view upwards, relative to half the larger side.
        shift_up: f32 = 0.0, optional, Constraint::Any, ["shiftUp" in set::DURER];
        /// Distance to the near clipping plane along the axis.
        near: f32 = 0.0, optional, Constraint::NonNegative, ["near" in set::DURER];
        /// Distance to the far clipping plane along the axis; unlimited by default.
        far: Option<f32> = None, optional, Constraint::Positive, ["far" in set::DURER];
        /// Handedness of the coordinate system; `left` mirrors the picture horizontally.
        handedness: Handedness = Handedness::Right, optional, Constraint::Any, ["handedness" in set::DURER];
    }
}

impl ThinLensCamera {
    fn shift(&self) -> DVec2 {
        DVec2::new(f64::from(self.shift_right), f64::from(self.shift_up))
    }

    /// Returns the point on the lens, the focus distance, and half the width of the view at that
    /// distance.
    fn parts(&self, frame: &CameraBasis, lens: Vec2) -> (DVec2, f64, f64) {
        let focus = f64::from(self.focus_distance);
        let opening = aperture::sample(lens, self.blades, self.blade_angle);
        (0.5 * f64::from(self.aperture) * opening, focus, focus * frame.half_width)
    }

    /// Returns the origin and the direction of the ray in camera space.
    fn line(&self, frame: &CameraBasis, sample: &CameraSample) -> (DVec3, DVec3) {
        let (lens, focus, width) = self.parts(frame, sample.lens);
        let target = width * (sample.point.as_dvec2() + self.shift());
        (lens.extend(0.0), (target - lens).extend(focus))
    }
}

impl Projection for ThinLensCamera {
    fn pose(&self) -> Pose {
        Pose { center: self.center, direction: self.direction, up: self.up }
    }

    fn half_width(&self) -> f64 {
        half_width(self.angle)
    }

    fn has_aperture(&self) -> bool {
        self.aperture > 0.0
    }

    fn validate(&self) -> Result<(), String> {
        aperture::validate(self.blades)
    }

    fn ray(&self, frame: &CameraBasis, sample: &CameraSample) -> Option<Ray> {
        let (origin, dir) = self.line(frame, sample);
        let ray = frame.ray(self.handedness.convert(origin), self.handedness.convert(dir));
        // Convert distances along the axis to distances along the ray.
        let along = ray.dir.dot(frame.forward);
        let t_max = self.far.map_or(ray.t_max, |far| far / along);
        Some(Ray { t_min: ray.t_min.max(self.near / along), t_max, ..ray })
    }

    fn project(&self, frame: &CameraBasis, world: Vec3, lens: Vec2, emit: &mut dyn FnMut(Vec2)) {
        let (lens, focus, width) = self.parts(frame, lens);
        let p = self.handedness.convert(frame.camera_from_world(world));
        if p.z > 0.0 {
            let target = lens + (p.truncate() - lens) * (focus / p.z);
            emit((target / width - self.shift()).as_vec2());
        }
    }

    fn footprint(&self, frame: &CameraBasis, sample: &CameraSample, t: f32) -> f32 {
        let (_, focus, width) = self.parts(frame, sample.lens);
        let (_, dir) = self.line(frame, sample);
        (f64::from(t * t) * focus * width * width / (dir.length_squared() * dir.length())) as f32
    }
}
