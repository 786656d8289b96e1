//! RGB colour spaces and their conversion to linear sRGB.

use crate::math::{Color, Vec3};
use glam::{DMat3, DVec3};

/// Column-major matrix that converts XYZ to linear sRGB. Source: IEC 61966-2-1.
pub const SRGB_FROM_XYZ: DMat3 = DMat3::from_cols_array(&[
    3.240_454_2,
    -0.969_266,
    0.055_643_4,
    -1.537_138_5,
    1.876_010_8,
    -0.204_025_9,
    -0.498_531_4,
    0.041_556,
    1.057_225_2,
]);

/// RGB colour space of a scene file, with its conversion to linear sRGB.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RgbSpace {
    to_srgb: DMat3,
}

impl Default for RgbSpace {
    fn default() -> Self {
        RgbSpace { to_srgb: DMat3::IDENTITY }
    }
}

/// Names of the colour spaces, with the chromaticities of their red, green, blue and white.
const SPACES: [(&str, [[f64; 2]; 4]); 4] = [
    ("srgb", [[0.64, 0.33], [0.3, 0.6], [0.15, 0.06], [0.3127, 0.329]]),
    ("dci-p3", [[0.68, 0.32], [0.265, 0.69], [0.15, 0.06], [0.3127, 0.329]]),
    ("rec2020", [[0.708, 0.292], [0.17, 0.797], [0.131, 0.046], [0.3127, 0.329]]),
    ("aces2065-1", [[0.7347, 0.2653], [0.0, 1.0], [0.0001, -0.077], [0.32168, 0.33767]]),
];

/// XYZ value of a chromaticity at luminance 1.
fn xyz([x, y]: [f64; 2]) -> DVec3 {
    DVec3::new(x / y, 1.0, (1.0 - x - y) / y)
}

/// Linear sRGB colour of an XYZ value.
pub fn color_of_xyz(xyz: DVec3) -> Color {
    (SRGB_FROM_XYZ * xyz).as_vec3()
}

/// Linear sRGB colour of a chromaticity at luminance 1, with negative values clamped to 0.
pub fn color_of_chromaticity(xy: [f64; 2]) -> Color {
    color_of_xyz(xyz(xy)).max(Vec3::ZERO)
}

impl RgbSpace {
    /// Returns the colour space with this name, or `None` if the name is unknown.
    pub fn named(name: &str) -> Option<RgbSpace> {
        let (name, [r, g, b, white]) = SPACES.iter().find(|row| row.0 == name)?;
        if *name == "srgb" {
            return Some(RgbSpace::default());
        }
        let columns = DMat3::from_cols(xyz(*r), xyz(*g), xyz(*b));
        let strengths = columns.inverse() * xyz(*white);
        Some(RgbSpace { to_srgb: SRGB_FROM_XYZ * (columns * DMat3::from_diagonal(strengths)) })
    }

    /// Names of all colour spaces.
    pub fn names() -> impl Iterator<Item = &'static str> {
        SPACES.iter().map(|row| row.0)
    }

    /// Converts a colour in this space to linear sRGB. White stays white.
    pub fn color(&self, rgb: Vec3) -> Color {
        if *self == RgbSpace::default() {
            return rgb;
        }
        let white = self.to_srgb * DVec3::ONE;
        ((self.to_srgb * rgb.as_dvec3()) / white).as_vec3()
    }
}
