//! Pictures on surfaces and around the scene.

pub mod cube_map;

use crate::math::{Color, Vec2};
pub use cube_map::CubeMap;

/// A decoded picture, looked up as the course does.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    width: u32,
    height: u32,
    /// Eight bits a channel, row 0 on top.
    texels: Vec<[u8; 3]>,
}

impl Texture {
    /// From texels, row 0 on top. `None` unless there are width times height of them, and at least one.
    pub fn new(width: u32, height: u32, texels: Vec<[u8; 3]>) -> Option<Self> {
        let count = (width as usize).checked_mul(height as usize)?;
        (count > 0 && texels.len() == count).then_some(Texture { width, height, texels })
    }

    /// Bytes in memory.
    pub fn bytes(&self) -> usize {
        self.texels.len() * 3
    }

    /// The colour at (u, v), with v upwards: bilinear, with no half-texel shift, clamped at the border.
    pub fn at(&self, uv: Vec2) -> Color {
        let x = uv.x * self.width as f32;
        let y = (1.0 - uv.y) * self.height as f32;
        let (left, top) = (x.trunc(), y.trunc());
        let (a, b) = ((x - left).clamp(0.0, 1.0), (y - top).clamp(0.0, 1.0));
        let texel = |dx: f32, dy: f32| {
            // A cast from float saturates, and NaN becomes 0.
            let i = ((left + dx).max(0.0) as u32).min(self.width - 1);
            let j = ((top + dy).max(0.0) as u32).min(self.height - 1);
            Color::from(self.texels[j as usize * self.width as usize + i as usize].map(|c| f32::from(c) / 255.0))
        };
        (1.0 - b) * ((1.0 - a) * texel(0.0, 0.0) + a * texel(1.0, 0.0))
            + b * ((1.0 - a) * texel(0.0, 1.0) + a * texel(1.0, 1.0))
    }
}
