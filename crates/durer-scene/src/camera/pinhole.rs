//! A camera obscura, which has a hole of finite size in front of a film.
//!
//! The film lies at distance f behind the hole, and its image is upside down. A point (x, y) of the
//! picture is the point -w (x, y) of the film, with w = f tan(angle / 2). Light reaches this point
//! along straight lines through all points h of the hole: direction = (h + w (x, y), f). A far
//! point is blurred to a disc as large as the hole, and a near point to a larger disc. A small hole
//! therefore gives an almost sharp picture. Diffraction is ignored.
//!
//! Source for the geometry: Renner, *Pinhole Photography*, 4th edition, 2008, chapter 5.

use super::perspective::half_width;
use super::{CameraBasis, CameraSample, Pose, Projection, aperture};
use crate::describe::{Constraint, described};
use crate::dialect::set;
use crate::math::{Ray, Vec2, Vec3};
use glam::{DVec2, DVec3};

described! {
    /// A pinhole camera with a hole of finite size instead of a lens.
    PinholeCamera ["PinholeCamera" in set::DURER] {
        /// Centre of the hole.
        center: Vec3 = Vec3::ZERO, required, Constraint::Any, ["center" in set::DURER];
        /// View direction, of any length.
        direction: Vec3 = Vec3::NEG_Z, required, Constraint::NonZero, ["direction" in set::DURER];
        /// Up direction of the picture; need not be perpendicular to `direction`.
        up: Vec3 = Vec3::Y, required, Constraint::NonZero, ["up" in set::DURER];
        /// Field of view across the picture's larger side, in degrees.
        angle: f32 = 30.0, required, Constraint::Between(0.0, 180.0), ["angle" in set::DURER];
        /// Diameter of the hole, in world units.
        hole: f32 = 0.01, required, Constraint::NonNegative, ["hole" in set::DURER];
        /// Distance from the hole to the film, in world units.
        film_distance: f32 = 1.0, optional, Constraint::Positive, ["filmDistance" in set::DURER];
    }
}

impl PinholeCamera {
    /// Returns the point in the hole, the distance of the film, and half the width of the film, in
    /// camera space.
    fn parts(&self, frame: &CameraBasis, lens: Vec2) -> (DVec2, f64, f64) {
        let film = f64::from(self.film_distance);
        (0.5 * f64::from(self.hole) * aperture::sample(lens, 0, 0.0), film, film * frame.half_width)
    }
}

impl Projection for PinholeCamera {
    fn pose(&self) -> Pose {
        Pose { center: self.center, direction: self.direction, up: self.up }
    }

    fn half_width(&self) -> f64 {
        half_width(self.angle)
    }

    fn has_aperture(&self) -> bool {
        self.hole > 0.0
    }

    fn ray(&self, frame: &CameraBasis, sample: &CameraSample) -> Option<Ray> {
        let (hole, film, width) = self.parts(frame, sample.lens);
        Some(frame.ray(hole.extend(0.0), (hole + width * sample.point.as_dvec2()).extend(film)))
    }

    fn project(&self, frame: &CameraBasis, world: Vec3, lens: Vec2, emit: &mut dyn FnMut(Vec2)) {
        let (hole, film, width) = self.parts(frame, lens);
        let p = frame.camera_from_world(world);
        if p.z > 0.0 {
            emit((((p.truncate() - hole) * (film / p.z) - hole) / width).as_vec2());
        }
    }

    fn footprint(&self, frame: &CameraBasis, sample: &CameraSample, t: f32) -> f32 {
        let (hole, film, width) = self.parts(frame, sample.lens);
        let dir: DVec3 = (hole + width * sample.point.as_dvec2()).extend(film);
        (f64::from(t * t) * film * width * width / (dir.length_squared() * dir.length())) as f32
    }
}
