//! Mapping of a texture onto a surface, as in glTF, with wrapping, filtering and a coordinate
//! transform.

use crate::describe::{FieldType, Value};
use crate::described_words;
use crate::math::{Vec2, fp};
use serde::{Deserialize, Serialize};

described_words! {
    /// Wrap mode of a texture beyond its border: repeated, repeated with every other copy mirrored,
    /// or clamped to the border texels.
    Wrap { Repeat = "repeat", Mirror = "mirror", Clamp = "clamp" }
}

described_words! {
    /// Channel of a texel that is read as a number; `angle` is the direction of the vector in red
    /// and green (where 1/2 is 0), in turns.
    Channel { Red = "r", Green = "g", Blue = "b", Alpha = "a", Angle = "angle" }
}

impl Channel {
    /// Parses the letter or word after the colon in a name such as `file.png:g`.
    pub fn from_word(word: &str) -> Option<Self> {
        Self::from_value(Value::Word(word.into()))
    }

    /// Value of this channel in a texel.
    pub fn of(self, [r, g, b, a]: [f32; 4]) -> f32 {
        match self {
            Channel::Red => r,
            Channel::Green => g,
            Channel::Blue => b,
            Channel::Alpha => a,
            Channel::Angle => fp::atan2(2.0 * g - 1.0, 2.0 * r - 1.0) / std::f32::consts::TAU,
        }
    }
}

/// Mapping of a texture onto a surface: wrap modes, filters, coordinate transform and value range.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Mapping {
    /// Wrap modes in the horizontal and vertical directions.
    pub wrap: [Wrap; 2],
    /// True to use the nearest texel, false to filter bilinearly.
    pub nearest: bool,
    /// True to use mipmaps for samples that cover many texels.
    pub mipmaps: bool,
    /// True to use the second set of texture coordinates.
    pub second: bool,
    /// Transform from surface coordinates to texture coordinates, stored as two rows of a matrix.
    /// In both, v is measured downwards from the upper border.
    pub transform: [[f32; 3]; 2],
    /// Alpha cutoff. Opacity is 1 if alpha is at or above it, and 0 below. With `None`, opacity
    /// equals alpha.
    pub cutoff: Option<f32>,
    /// Factor that scales the slopes in a normal map. A factor of 1 keeps the stored slopes.
    pub strength: f32,
    /// Channel that is read as a number; `None` for red, or for alpha in opacity textures that have
    /// alpha.
    pub channel: Option<Channel>,
    /// Parameter values that correspond to 0 and 1 in the texture.
    pub range: [f32; 2],
}

impl Default for Mapping {
    fn default() -> Self {
        Mapping {
            wrap: [Wrap::Repeat; 2],
            nearest: false,
            mipmaps: false,
            second: false,
            transform: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            cutoff: None,
            strength: 1.0,
            channel: None,
            range: [0.0, 1.0],
        }
    }
}

impl Mapping {
    /// Position in the texture for surface coordinates with v up. It is measured in texture widths
    /// from the left and texture heights from the top.
    pub fn texture_position(&self, uv: Vec2) -> Vec2 {
        let (u, v) = (uv.x, 1.0 - uv.y);
        let [x, y] = self.transform.map(|[a, b, c]| a * u + b * v + c);
        Vec2::new(x, y)
    }

    /// Gradient with respect to u and v, from the gradient with respect to the position in the
    /// texture; see [`Mapping::texture_position`].
    pub(super) fn gradient(&self, of_position: Vec2) -> Vec2 {
        let [[a, b, _], [c, d, _]] = self.transform;
        let Vec2 { x, y } = of_position;
        // The coordinate v points up on the surface, but down in the texture.
        Vec2::new(a * x + c * y, -(b * x + d * y))
    }

    /// Maps a channel value from [0, 1] to the range of parameter values.
    pub fn map_to_range(&self, x: f32) -> f32 {
        let [low, high] = self.range;
        if [low, high] == [0.0, 1.0] { x } else { low + x * (high - low) }
    }

    /// Applies the alpha cutoff, if there is one.
    pub(super) fn apply_cutoff(&self, [r, g, b, alpha]: [f32; 4]) -> [f32; 4] {
        let alpha = match self.cutoff {
            Some(least) if alpha >= least => 1.0,
            Some(_) => 0.0,
            None => alpha,
        };
        [r, g, b, alpha]
    }

    /// Converts the directions in which the surface coordinates increase to the directions in which
    /// the texture coordinates increase, with v up in both.
    pub fn directions<V>(&self, [u, v]: [V; 2]) -> [V; 2]
    where
        V: Copy + std::ops::Mul<f32, Output = V> + std::ops::Add<Output = V>,
    {
        // Use the rows of the inverse transpose, up to a positive common factor.
        let [[a, b, _], [c, d, _]] = self.transform;
        let side = if a * d - b * c < 0.0 { -1.0 } else { 1.0 };
        [u * (side * d) + v * (side * c), u * (side * b) + v * (side * a)]
    }
}

impl Wrap {
    /// Index of the texel that is used for index `i` in a row of `count` texels. `i` can be outside
    /// the row.
    pub fn index(self, i: i64, count: u32) -> u32 {
        let count = i64::from(count);
        let folded = match self {
            Wrap::Repeat => i.rem_euclid(count),
            Wrap::Mirror => {
                let i = i.rem_euclid(2 * count);
                if i < count { i } else { 2 * count - 1 - i }
            }
            Wrap::Clamp => i.clamp(0, count - 1),
        };
        folded as u32
    }
}
