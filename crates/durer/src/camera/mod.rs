//! Cameras: from a place in the picture to a ray. One file each; the list is [`Camera`].

pub mod orthographic;
pub mod perspective;
pub mod raster;

use crate::described_list;
use crate::dialect::{Compat, Rules};
use crate::math::{Ray, Vec2, Vec3};
pub use orthographic::OrthographicCamera;
pub use perspective::PerspectiveCamera;
pub use raster::Raster;

described_list! {
    /// A camera.
    Camera {
        Perspective(perspective::PerspectiveCamera),
        Orthographic(orthographic::OrthographicCamera),
    }
}

/// Where a camera stands and how it is turned, as written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Its position.
    pub center: Vec3,
    /// Where it looks; of any length.
    pub direction: Vec3,
    /// What it holds upwards; of any length.
    pub up: Vec3,
}

/// A camera's axes: where it looks, and the picture's right and up. Of unit length and perpendicular,
/// but for the compatibilities that say otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Position of the eye.
    pub eye: Vec3,
    /// Where it looks.
    pub forward: Vec3,
    /// To the right in the picture.
    pub right: Vec3,
    /// Upwards in the picture.
    pub up: Vec3,
    /// Whether rays are aimed at rounded points of the world, as [`Compat::ScreenPoint`] says.
    pub screen_point: bool,
}

/// A vector's direction, each component divided by the length (glam multiplies by its reciprocal, which rounds once more).
fn unit_or(v: Vec3, fallback: Vec3) -> Vec3 {
    let unit = v / v.length();
    if unit.is_finite() && unit != Vec3::ZERO { unit } else { v.normalize_or(fallback) }
}

impl Frame {
    /// The axes of a pose: right = norm(direction x up), up = right x direction.
    pub fn new(pose: Pose, rules: &Rules) -> Self {
        let forward = unit_or(pose.direction, Vec3::NEG_Z);
        let right = unit_or(forward.cross(pose.up), forward.any_orthonormal_vector());
        let up = if rules.has(Compat::RawUp) {
            pose.up
        } else if rules.has(Compat::SkewUp) {
            pose.up.normalize_or(Vec3::Y)
        } else {
            right.cross(forward)
        };
        Frame { eye: pose.center, forward, right, up, screen_point: rules.has(Compat::ScreenPoint) }
    }
}

/// Where in the picture and in the lens a ray is wanted.
///
/// (-1, -1) is the lower left corner of the square that the camera covers, (1, 1) the upper right.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraSample {
    /// The point of the picture.
    pub point: Vec2,
    /// The centre of the pixel that the sample is for. A filter may reach beyond the pixel, and beyond the part of the
    /// picture (a face of a cube, a wall, an eye) that the pixel belongs to: what it finds there continues that part.
    pub pixel: Vec2,
    /// The point of the lens, in [0,1)^2; (0.5, 0.5) is its middle.
    pub lens: Vec2,
}

impl CameraSample {
    /// A point of the picture that is its own pixel's centre, through the middle of the lens.
    pub fn at(point: Vec2) -> Self {
        CameraSample { point, pixel: point, lens: Vec2::splat(0.5) }
    }
}

/// What every camera can do.
pub trait Lens {
    /// Where it stands.
    fn pose(&self) -> Pose;

    /// The natural width and height of its picture, in any unit; `None` where any shape will do, and the larger side
    /// spans the square. A natural picture lies in the middle of the square, which its larger side spans.
    fn proportions(&self) -> Option<Vec2> {
        None
    }

    /// Whether rays through one point of the picture differ by the point of the lens.
    fn has_aperture(&self) -> bool {
        false
    }

    /// The ray of a sample; `None` where the camera sees nothing. The direction has length 1, so that `t` is a distance.
    fn ray(&self, frame: &Frame, sample: &CameraSample) -> Option<Ray>;
}

/// Calls a method of whichever camera it is.
macro_rules! each_camera {
    ($self:ident, $c:ident => $call:expr) => {
        match $self {
            Camera::Perspective($c) => $call,
            Camera::Orthographic($c) => $call,
        }
    };
}

impl Lens for Camera {
    fn pose(&self) -> Pose {
        each_camera!(self, c => c.pose())
    }

    fn proportions(&self) -> Option<Vec2> {
        each_camera!(self, c => c.proportions())
    }

    fn has_aperture(&self) -> bool {
        each_camera!(self, c => c.has_aperture())
    }

    fn ray(&self, frame: &Frame, sample: &CameraSample) -> Option<Ray> {
        each_camera!(self, c => c.ray(frame, sample))
    }
}

#[cfg(test)]
mod tests;
