//! Pictures on surfaces and around the scene.

pub mod cube_map;
pub mod environment;
pub mod sky;

use crate::math::{Color, Vec2};
pub use cube_map::CubeMap;
pub use environment::Environment;
pub use sky::Sky;
use std::sync::Arc;

/// A decoded picture, looked up as the course does.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    width: u32,
    height: u32,
    /// Eight bits a channel, row 0 on top.
    texels: Arc<[[u8; 3]]>,
    /// What each of the 256 values means.
    values: Box<[f32; 256]>,
}

impl Texture {
    /// From texels, row 0 on top. `None` unless there are width times height of them, and at least one.
    pub fn new(width: u32, height: u32, texels: Vec<[u8; 3]>) -> Option<Self> {
        let count = (width as usize).checked_mul(height as usize)?;
        let values = Box::new(std::array::from_fn(|i| i as f32 / 255.0));
        (count > 0 && texels.len() == count).then_some(Texture { width, height, texels: texels.into(), values })
    }

    /// The same texels, with other meanings of the 256 values.
    pub fn decoded(self, decode: impl Fn(u8) -> f32) -> Self {
        Texture { values: Box::new(std::array::from_fn(|i| decode(i as u8))), ..self }
    }

    /// Bytes in memory.
    pub fn bytes(&self) -> usize {
        self.texels.len() * 3
    }

    /// The colour at (u, v), with v upwards: bilinear, with no half-texel shift, clamped at the border.
    pub fn at(&self, uv: Vec2) -> Color {
        let (width, height) = (self.width as f32, self.height as f32);
        // `max` before `min`: NaN becomes 0.
        let x = (uv.x * width).max(0.0).min(width);
        let y = ((1.0 - uv.y) * height).max(0.0).min(height);
        let (left, top) = (x.trunc(), y.trunc());
        let (a, b) = (x - left, y - top);
        let texel = |dx: f32, dy: f32| {
            let i = ((left + dx) as u32).min(self.width - 1);
            let j = ((top + dy) as u32).min(self.height - 1);
            Color::from(self.texels[j as usize * self.width as usize + i as usize].map(|c| self.values[usize::from(c)]))
        };
        (1.0 - b) * ((1.0 - a) * texel(0.0, 0.0) + a * texel(1.0, 0.0))
            + b * ((1.0 - a) * texel(0.0, 1.0) + a * texel(1.0, 1.0))
    }
}

#[cfg(test)]
mod tests;
