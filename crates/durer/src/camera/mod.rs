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

/// What every camera can do.
pub trait Lens {
    /// Where it stands.
    fn pose(&self) -> Pose;

    /// The ray through a point of the picture; (-1, -1) is the lower left corner of the square that the
    /// camera covers, (1, 1) the upper right. The direction has length 1, so that `t` is a distance.
    fn ray(&self, frame: &Frame, point: Vec2) -> Ray;
}

impl Lens for Camera {
    fn pose(&self) -> Pose {
        match self {
            Camera::Perspective(c) => c.pose(),
            Camera::Orthographic(c) => c.pose(),
        }
    }

    fn ray(&self, frame: &Frame, point: Vec2) -> Ray {
        match self {
            Camera::Perspective(c) => c.ray(frame, point),
            Camera::Orthographic(c) => c.ray(frame, point),
        }
    }
}

#[cfg(test)]
mod tests;
