//! Defines the working colour space.

use durer_bvh::math::Vec3;

/// A colour in the working colour space, linear Rec. 709, with red, green, and blue components. The
/// components have no upper limit.
pub type Color = Vec3;

/// Weights of red, green, and blue in the luminance of a [`Color`] (Rec. 709).
pub const LUMINANCE: Vec3 = Vec3::new(LUMINANCE_F64[0] as f32, LUMINANCE_F64[1] as f32, LUMINANCE_F64[2] as f32);

/// The values of [`LUMINANCE`] in double precision. Source: ITU-R BT.709.
pub const LUMINANCE_F64: [f64; 3] = [0.2126, 0.7152, 0.0722];
