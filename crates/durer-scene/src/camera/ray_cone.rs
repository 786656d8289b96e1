//! Width of a ray cone, for texture filtering.

use super::{Camera, CameraBasis, CameraSample, Projection};
use crate::math::Vec2;

/// Cone around a camera ray that covers an area of the picture. The width of the cone selects the
/// texture detail.
///
/// A single cone, computed at the centre of the picture, is used for the full picture. Source:
/// Amanatides, *Ray Tracing with Cones*, SIGGRAPH 1984.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayCone {
    /// Width at the camera, in world units.
    width: f32,
    /// Increase of the width per unit of distance.
    spread: f32,
}

impl RayCone {
    /// Creates the cone for an area of a camera's picture. Returns `None` if nothing is seen at the
    /// centre of the picture.
    pub fn new(camera: &Camera, basis: &CameraBasis, area: f32) -> Option<Self> {
        let middle = CameraSample::at(Vec2::ZERO);
        camera.ray(basis, &middle)?;
        let [width, next] = [0.0, 1.0].map(|t| (area * camera.footprint(basis, &middle, t)).sqrt());
        let cone = RayCone { width, spread: next - width };
        (cone.width.is_finite() && cone.spread.is_finite()).then_some(cone)
    }

    /// Returns the width of the cone at a distance, in world units.
    pub fn width_at(&self, distance: f32) -> f32 {
        self.width + distance * self.spread
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{CameraRules, OrthographicCamera, PerspectiveCamera};

    #[test]
    fn ray_cones_widen_only_in_perspective() {
        let cone = |camera: Camera, side: f32| {
            let basis = CameraBasis::of(&camera, CameraRules::default());
            RayCone::new(&camera, &basis, side * side).unwrap()
        };
        let perspective = PerspectiveCamera { angle: 90.0, ..Default::default() };
        let cone_of_pixel = cone(Camera::Perspective(perspective), 0.01);
        assert!((cone_of_pixel.width_at(0.0)).abs() < 1e-6);
        // At distance 2, the square is 4 wide.
        assert!((cone_of_pixel.width_at(2.0) - 0.02).abs() < 1e-6);
        let orthographic = OrthographicCamera { size: 6.0, ..Default::default() };
        let cone_of_pixel = cone(Camera::Orthographic(orthographic), 0.01);
        assert!((cone_of_pixel.width_at(7.0) - 0.03).abs() < 1e-6);
        assert!((cone_of_pixel.width_at(0.0) - 0.03).abs() < 1e-6);
    }
}
