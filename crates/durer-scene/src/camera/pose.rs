//! Position and orientation of a camera.

use super::Projection;
use super::tangent::tangent;
use crate::math::{Ray, Vec3, fp};
use glam::{DMat3, DVec3};
use std::f32::consts::PI;
use std::f64::consts::PI as PI_F64;

/// Position and orientation of a camera, as written in the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Position of the eye, in world space.
    pub center: Vec3,
    /// View direction, of any length.
    pub direction: Vec3,
    /// Up direction, of any length.
    pub up: Vec3,
}

/// Rule by which a dialect derives the up direction of the picture from the `up` of a camera.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum UpRule {
    /// The up direction is perpendicular to the view direction and has unit length.
    #[default]
    Perpendicular,
    /// The up direction is used as written, with any length.
    Raw,
    /// The up direction has unit length, but it is not made perpendicular.
    Skew,
}

/// Arithmetic by which a dialect computes perspective rays, including all rounding.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum RayArithmetic {
    /// Dürer's own arithmetic.
    #[default]
    Own,
    /// Arithmetic of the program of 2004. Rays aim at points in world space on a screen at distance
    /// 1, and these points are rounded to `f32`.
    ScreenPoint,
    /// Arithmetic of the program of 2012. The direction d w + x u + y v is computed in single
    /// precision from `direction` and `up` of any length.
    Of2012,
    /// [`RayArithmetic::Of2012`] with the axes of the program of 2016, in which `up` is used as
    /// written.
    Of2016,
    /// [`RayArithmetic::Of2012`] with the axes of the program of 2020, all of which are multiplied
    /// by the reciprocal of their length.
    Of2020,
}

impl RayArithmetic {
    /// True if the direction of a ray is computed as a sum in single precision.
    pub(super) fn is_sum(self) -> bool {
        matches!(self, RayArithmetic::Of2012 | RayArithmetic::Of2016 | RayArithmetic::Of2020)
    }

    /// Returns the distance at which a screen from -1 to 1 spans an angle in degrees.
    pub(super) fn distance(self, angle: f32) -> f32 {
        let radians = (PI_F64 * f64::from(angle) / 180.0) as f32;
        match self {
            RayArithmetic::Of2020 => 1.0 / tangent(angle / 180.0 * PI / 2.0),
            RayArithmetic::Of2016 => 1.0 / tangent(radians / 2.0),
            _ => (1.0 / fp::tan_f64(f64::from(radians) / 2.0)) as f32,
        }
    }

    /// Normalizes a vector, or returns `fallback` if it has no direction.
    pub(super) fn normalize_or(self, v: Vec3, fallback: Vec3) -> Vec3 {
        if self != RayArithmetic::Of2020 {
            return normalize_or(v, fallback);
        }
        let unit = v * (1.0 / v.dot(v).sqrt());
        if unit.is_finite() && unit != Vec3::ZERO { unit } else { normalize_or(v, fallback) }
    }
}

/// Camera rules of the dialect of a scene, which are determined when the scene is compiled. The
/// defaults are Dürer's own rules.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CameraRules {
    /// Rule for the up direction of the picture.
    pub up: UpRule,
    /// Arithmetic by which perspective rays are computed.
    pub ray_arithmetic: RayArithmetic,
    /// True if the first and last columns and rows have their pixel centres on the border of the
    /// picture.
    pub border_pixels: bool,
    /// True if the square of the camera is stretched over a picture that is not square.
    pub stretch: bool,
}

/// Axes of a camera: the view direction, and the right and up directions of the picture. The axes
/// are orthonormal, unless the [`CameraRules`] specify otherwise.
///
/// Together, the axes span camera space, in which x points to the right, y upwards and z forwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraBasis {
    /// Position of the eye, in world space.
    pub eye: Vec3,
    /// View direction.
    pub forward: Vec3,
    /// Right direction of the picture.
    pub right: Vec3,
    /// Up direction of the picture.
    pub up: Vec3,
    /// See [`CameraRules::ray_arithmetic`].
    pub ray_arithmetic: RayArithmetic,
    /// [`Projection::half_width`] of the camera, which is computed only once.
    pub half_width: f64,
}

/// Normalizes a vector by dividing each component by the length. In contrast, glam multiplies by
/// the reciprocal, which rounds once more. Returns `fallback` if the vector is zero or not finite.
pub(super) fn normalize_or(v: Vec3, fallback: Vec3) -> Vec3 {
    let [[x], [y], [z]] = normalize_all_or(&[[v.x], [v.y], [v.z]], fallback);
    Vec3::new(x, y, z)
}

/// Normalizes several vectors, which are given as arrays of their x, y and z components. See
/// [`normalize_or`].
#[inline(always)]
pub(super) fn normalize_all_or<const N: usize>([x, y, z]: &[[f32; N]; 3], fallback: Vec3) -> [[f32; N]; 3] {
    let (mut units, mut all_sound) = ([[0.0; N]; 3], true);
    for i in 0..N {
        let length = (x[i] * x[i] + y[i] * y[i] + z[i] * z[i]).sqrt();
        let unit = [x[i] / length, y[i] / length, z[i] / length];
        (units[0][i], units[1][i], units[2][i]) = unit.into();
        all_sound &= is_sound(unit);
    }
    if !all_sound {
        for i in 0..N {
            if !is_sound([units[0][i], units[1][i], units[2][i]]) {
                let unit = Vec3::new(x[i], y[i], z[i]).normalize_or(fallback);
                (units[0][i], units[1][i], units[2][i]) = unit.into();
            }
        }
    }
    units
}

/// True if a direction is finite and not zero. The test has no branches, so that it can be
/// vectorized.
#[inline(always)]
fn is_sound([x, y, z]: [f32; 3]) -> bool {
    (x.is_finite() & y.is_finite() & z.is_finite()) & ((x != 0.0) | (y != 0.0) | (z != 0.0))
}

/// Version of [`normalize_or`] for the program of 2004, which multiplies by the reciprocal of the
/// length.
fn normalize_by_reciprocal_or(v: Vec3, fallback: Vec3) -> Vec3 {
    let unit = v * (1.0 / (v.as_dvec3().length() as f32));
    if unit.is_finite() && unit != Vec3::ZERO { unit } else { normalize_or(v, fallback) }
}

impl CameraBasis {
    /// Computes the axes of a camera, and the half width that its rays need.
    pub fn of(camera: &impl Projection, rules: CameraRules) -> Self {
        CameraBasis { half_width: camera.half_width(), ..CameraBasis::new(camera.pose(), rules) }
    }

    /// Computes the axes for a pose: right = norm(direction x up), up = right x direction.
    pub(super) fn new(pose: Pose, CameraRules { up, ray_arithmetic, .. }: CameraRules) -> Self {
        let screen_point = ray_arithmetic == RayArithmetic::ScreenPoint;
        let unit = |v, fallback| {
            if screen_point {
                normalize_by_reciprocal_or(v, fallback)
            } else {
                ray_arithmetic.normalize_or(v, fallback)
            }
        };
        let forward = unit(pose.direction, Vec3::NEG_Z);
        // These are the operands of the cross product. The programs of some years use the direction
        // without normalising it.
        let (along, over) = match ray_arithmetic {
            RayArithmetic::Of2012 | RayArithmetic::Of2016 => (pose.direction, pose.up),
            RayArithmetic::Of2020 => (forward, ray_arithmetic.normalize_or(pose.up, Vec3::Y)),
            RayArithmetic::Own | RayArithmetic::ScreenPoint => (forward, pose.up),
        };
        let right = unit(along.cross(over), forward.any_orthonormal_vector());
        let up = match up {
            UpRule::Raw => pose.up,
            UpRule::Skew if ray_arithmetic == RayArithmetic::Of2020 => over,
            UpRule::Skew => pose.up.normalize_or(Vec3::Y),
            UpRule::Perpendicular => match (right.cross(along), ray_arithmetic) {
                (up, RayArithmetic::Own) => up,
                (up, _) => unit(up, right.cross(forward)),
            },
        };
        CameraBasis { eye: pose.center, forward, right, up, ray_arithmetic, half_width: 1.0 }
    }

    /// Returns the axes as the columns of a matrix in double precision, which maps camera space to
    /// world space.
    fn axes(&self) -> DMat3 {
        DMat3::from_cols(self.right.as_dvec3(), self.up.as_dvec3(), self.forward.as_dvec3())
    }

    /// Transforms a point from world space to camera space.
    pub(super) fn camera_from_world(&self, point: Vec3) -> DVec3 {
        self.vector_from_world(point.as_dvec3() - self.eye.as_dvec3())
    }

    /// Transforms a vector from world space to camera space.
    pub(super) fn vector_from_world(&self, vector: DVec3) -> DVec3 {
        self.axes().inverse() * vector
    }

    /// Returns the ray from a point along a direction of any length, both in camera space.
    pub(super) fn ray(&self, origin: DVec3, dir: DVec3) -> Ray {
        let origin = self.eye.as_dvec3() + self.axes() * origin;
        world_ray(origin, self.axes() * dir)
    }

    /// Returns the volume of the unit cube of camera space, which is 1 if the axes are orthonormal
    /// and may differ if they are skew.
    pub(super) fn volume(&self) -> f64 {
        self.axes().determinant().abs()
    }
}

/// Returns the ray from a point in world space along a direction of any length. Only the final
/// result is rounded.
pub(super) fn world_ray(origin: DVec3, dir: DVec3) -> Ray {
    Ray::new(origin.as_vec3(), dir.normalize_or(DVec3::NEG_Z).as_vec3())
}
