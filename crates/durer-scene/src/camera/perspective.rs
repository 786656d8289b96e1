//! The pinhole camera of the lecture, whose rays all start at the eye e, with w = forward, u =
//! right, v = up.
//!
//! The direction of a ray is D w + x u + y v, where D = 1 / tan(angle / 2), and x and y run from -1
//! to 1 across the larger side. If the picture is not square, the other coordinate runs from -a to
//! a, where a < 1 is the ratio of the shorter side to the larger one.
//!
//! The solid angle of an area dx dy in the plane at distance D is D |u v w| dx dy / |direction|³.

use super::pose::{RayArithmetic, normalize_all_or, normalize_or};
use super::{CameraBasis, CameraSample, CameraSamples, Pose, Projection};
use crate::describe::{Constraint, described};
use crate::dialect::set;
use crate::math::{Ray, Vec2, Vec3, fp};
use glam::DVec2;

described! {
    /// A perspective camera.
    PerspectiveCamera ["PerspectiveCamera" in set::CLASSIC, "Camera" in set::F23] {
        /// Position of the eye.
        center: Vec3 = Vec3::ZERO, required, Constraint::Any, ["center" in set::ALL];
        /// View direction, of any length.
        direction: Vec3 = Vec3::NEG_Z, required, Constraint::NonZero, ["direction" in set::ALL];
        /// Up direction of the picture; need not be perpendicular to the view direction.
        up: Vec3 = Vec3::Y, required, Constraint::NonZero, ["up" in set::ALL];
        /// Field of view across the picture's larger side, in degrees.
        angle: f32 = 30.0, required, Constraint::Between(0.0, 180.0), ["angle" in set::CLASSIC, "fov" in set::F23];
    }
}

/// Returns half the width of the view at distance 1, for a field of view in degrees.
pub(super) fn half_width(angle: f32) -> f64 {
    fp::tan_f64(f64::from(angle).to_radians() / 2.0)
}

impl PerspectiveCamera {
    /// Creates a camera at `eye` that looks at `target`. The up direction is +y, or -z if the
    /// camera looks along y. `angle` is the field of view across the larger side of the picture, in
    /// degrees from 0 to 180.
    pub fn look_at(eye: Vec3, target: Vec3, angle: f32) -> Self {
        let direction = target - eye;
        let along = direction.normalize_or_zero().cross(Vec3::Y).length() < 1e-6;
        PerspectiveCamera { center: eye, direction, up: if along { Vec3::NEG_Z } else { Vec3::Y }, angle }
    }
}

impl Projection for PerspectiveCamera {
    fn pose(&self) -> Pose {
        Pose { center: self.center, direction: self.direction, up: self.up }
    }

    fn half_width(&self) -> f64 {
        half_width(self.angle)
    }

    fn ray(&self, frame: &CameraBasis, sample: &CameraSample) -> Option<Ray> {
        if frame.ray_arithmetic != RayArithmetic::ScreenPoint {
            let mut emit = None;
            self.rays::<1>(frame, &(*sample).into(), |_, ray| emit = ray);
            return emit;
        }
        let (along, half) = (0.5 * (sample.point + 1.0), frame.half_width as f32);
        let corner = frame.eye + frame.forward - half * frame.right - half * frame.up;
        let (across, upwards) = (2.0 * half * frame.right, 2.0 * half * frame.up);
        let dir = (corner + along.x * across + along.y * upwards) - frame.eye;
        Some(Ray::new(frame.eye, normalize_or(dir, frame.forward)))
    }

    #[inline(always)]
    fn rays<const N: usize>(
        &self,
        frame: &CameraBasis,
        samples: &CameraSamples<N>,
        mut take: impl FnMut(usize, Option<Ray>),
    ) {
        if frame.ray_arithmetic == RayArithmetic::ScreenPoint {
            return (0..N).for_each(|i| take(i, self.ray(frame, &samples.sample(i))));
        }
        if frame.ray_arithmetic.is_sum() {
            let distance = frame.ray_arithmetic.distance(self.angle);
            let [x, y] = &samples.points;
            return (0..N).for_each(|i| {
                let dir = distance * frame.forward + x[i] * frame.right + y[i] * frame.up;
                take(i, Some(Ray::new(frame.eye, frame.ray_arithmetic.normalize_or(dir, frame.forward))));
            });
        }
        let forward = frame.forward / frame.half_width as f32;
        let [x, y] = &samples.points;
        let mut dirs = [[0.0; N]; 3];
        for axis in 0..3 {
            for i in 0..N {
                dirs[axis][i] = forward[axis] + x[i] * frame.right[axis] + y[i] * frame.up[axis];
            }
        }
        let [x, y, z] = normalize_all_or(&dirs, frame.forward);
        (0..N).for_each(|i| take(i, Some(Ray::new(frame.eye, Vec3::new(x[i], y[i], z[i])))));
    }

    fn project(&self, frame: &CameraBasis, world: Vec3, _: Vec2, emit: &mut dyn FnMut(Vec2)) {
        let p = frame.camera_from_world(world);
        if p.z > 0.0 {
            emit((DVec2::new(p.x, p.y) / (p.z * frame.half_width)).as_vec2());
        }
    }

    fn footprint(&self, frame: &CameraBasis, sample: &CameraSample, t: f32) -> f32 {
        let distance = 1.0 / frame.half_width;
        let [u, v, w] = [frame.right, frame.up, frame.forward].map(|axis| axis.as_dvec3());
        let point = sample.point.as_dvec2();
        let length = (distance * w + point.x * u + point.y * v).length();
        (f64::from(t * t) * distance * frame.volume() / (length * length * length)) as f32
    }
}
