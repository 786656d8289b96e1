//! How a picture lies on a surface, as glTF has it: wrapping, filtering, a transform of the
//! coordinates.

use crate::describe::{FieldType, Value};
use crate::described_words;
use crate::math::{Vec2, fp};
use serde::{Deserialize, Serialize};

described_words! {
    /// What is beyond a picture's border: the picture again, it and its mirror image in turn, or
    /// the border's texels without end.
    Wrap { Repeat = "repeat", Mirror = "mirror", Clamp = "clamp" }
}

described_words! {
    /// What of a picture's texel is a number; the angle, in turns, is that of the direction whose
    /// parts are red and green, 1/2 being 0.
    Channel { Red = "r", Green = "g", Blue = "b", Alpha = "a", Angle = "angle" }
}

impl Channel {
    /// By the letter or word that stands for it after the colon of `file.png:g`.
    pub fn from_word(word: &str) -> Option<Self> {
        Self::from_value(Value::Word(word.into()))
    }

    /// The number.
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

/// How a picture lies on a surface.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Mapping {
    /// Beyond the left and right border, and beyond the upper and lower.
    pub wrap: [Wrap; 2],
    /// Whether the nearest texel counts alone; else the four around a point are mixed.
    pub nearest: bool,
    /// Whether smaller versions of the picture are shown where many of its texels are seen at once.
    pub mipmaps: bool,
    /// Whether the second set of texture coordinates counts.
    pub second: bool,
    /// From the surface's coordinates to the picture's, both with v downwards from the upper
    /// border: two rows of a matrix.
    pub transform: [[f32; 3]; 2],
    /// Opacity is 1 where the picture's alpha is at least this, and else 0; `None`: as the alpha
    /// says.
    pub cutoff: Option<f32>,
    /// How far the normals of a normal map lean, times; 1 as written.
    pub strength: f32,
    /// What counts where a number is wanted; `None`: red, or of opacity what there is.
    pub channel: Option<Channel>,
    /// What a texel's 0 and 1 stand for, where the picture changes a parameter.
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
    /// The place in the picture, in its widths from the left and heights from the top, of surface
    /// coordinates with v upwards.
    pub fn place(&self, uv: Vec2) -> Vec2 {
        let (u, v) = (uv.x, 1.0 - uv.y);
        let [x, y] = self.transform.map(|[a, b, c]| a * u + b * v + c);
        Vec2::new(x, y)
    }

    /// What a number of a texel stands for.
    pub fn ranged(&self, x: f32) -> f32 {
        let [low, high] = self.range;
        if [low, high] == [0.0, 1.0] { x } else { low + x * (high - low) }
    }

    /// Colour and opacity with the opacity made 0 or 1 where there is a cutoff.
    pub(super) fn cut(&self, [r, g, b, alpha]: [f32; 4]) -> [f32; 4] {
        let alpha = match self.cutoff {
            Some(least) if alpha >= least => 1.0,
            Some(_) => 0.0,
            None => alpha,
        };
        [r, g, b, alpha]
    }

    /// The directions in which a picture's own coordinates grow, from those in which the surface's
    /// do, v upwards in both.
    pub fn directions<V>(&self, [u, v]: [V; 2]) -> [V; 2]
    where
        V: Copy + std::ops::Mul<f32, Output = V> + std::ops::Add<Output = V>,
    {
        // The rows of the inverse transpose, but for a common factor that keeps the sides.
        let [[a, b, _], [c, d, _]] = self.transform;
        let side = if a * d - b * c < 0.0 { -1.0 } else { 1.0 };
        [u * (side * d) + v * (side * c), u * (side * b) + v * (side * a)]
    }
}

impl Wrap {
    /// The texel of a row of `count` that stands for the i-th.
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
