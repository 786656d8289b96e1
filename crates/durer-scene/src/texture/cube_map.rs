//! Cube maps, which consist of six images around the scene.

use super::Texture;
use crate::math::{Color, Vec2, Vec3};

/// Environment at infinity, given by images on the six faces of a cube.
#[derive(Clone, Debug, PartialEq)]
pub struct CubeMap {
    /// Images in the order of [`CubeMap::FACES`].
    pub faces: [Texture; 6],
    /// True if the quirk [`crate::dialect::Quirk::MirroredBack`] applies.
    pub mirrored_back: bool,
}

impl CubeMap {
    /// File names of the faces without extension, in the order -x, +x, +y, -y, +z, -z.
    pub const FACES: [&'static str; 6] = ["left", "right", "up", "down", "front", "back"];

    /// Face that a direction in world space hits, and the coordinates on it. The component with the
    /// largest absolute value selects the face. If components are equal, x takes precedence over y,
    /// and y over z.
    ///
    /// Seen from inside, every face is upright and not mirrored. The upward direction of the image
    /// is y on the four sides, z on `up` and -z on `down`, so that all six faces meet without a
    /// seam.
    pub fn face(&self, direction: Vec3) -> (usize, Vec2) {
        let Vec3 { x, y, z } = direction;
        let d = direction.abs();
        let h = |q: f32| 0.5 * (q + 1.0);
        let (face, u, v) = if d.x >= d.y && d.x >= d.z {
            if x > 0.0 { (1, h(z / x), h(y / x)) } else { (0, h(z / x), 1.0 - h(y / x)) }
        } else if d.y >= d.z {
            if y > 0.0 { (2, h(x / y), h(z / y)) } else { (3, 1.0 - h(x / y), h(z / y)) }
        } else if z > 0.0 {
            (4, 1.0 - h(x / z), h(y / z))
        } else {
            (5, 1.0 - h(x / z), 1.0 - h(y / z))
        };
        let (u, v) = match face {
            3 if self.mirrored_back => (u, 1.0 - v),
            5 if self.mirrored_back => (1.0 - u, v),
            _ => (u, v),
        };
        (face, Vec2::new(u, v))
    }

    /// Colour in a direction in world space.
    pub fn at(&self, direction: Vec3) -> Color {
        let (face, uv) = self.face(direction);
        self.faces[face].at(uv)
    }
}
