//! Texels that contribute to a texture lookup, used for explanations.

use super::{Texels, Texture};
use crate::math::{Color, Vec2};

/// Texel that contributes to a texture lookup, with its weight. It is used for explanations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tap {
    /// Column and row of the texel, counted from the upper left corner.
    pub texel: (u32, u32),
    /// Weight of the texel in the lookup.
    pub weight: f32,
    /// Three bytes as stored in the file, if it has 8 bits per channel.
    pub bytes: Option<[u8; 3]>,
    /// Colour.
    pub color: Color,
}

impl Texture {
    /// Returns the texels that [`Texture::at`] uses, with their weights. Texels of weight 0 are
    /// omitted. The weighted sum of the texels is the value of the lookup before the factors of the
    /// mapping are applied.
    pub fn taps(&self, uv: Vec2) -> Vec<Tap> {
        let (width, height) = (f64::from(self.width), f64::from(self.height));
        // Position in the texture in texels, and whether the nearest texel is used.
        let (x, y, nearest) = match &self.mapping {
            Some(mapping) => {
                let texel = mapping.texture_position(uv);
                (f64::from(texel.x) * width, f64::from(texel.y) * height, mapping.nearest)
            }
            None => {
                let clamped = |v: f64, most: f64| v.max(0.0).min(most);
                let (u, v) = (f64::from(uv.x), 1.0 - f64::from(uv.y));
                (clamped(u * width, width) + 0.5, clamped(v * height, height) + 0.5, false)
            }
        };
        let index = |axis: usize, i: i64, size: u32| match &self.mapping {
            Some(mapping) => mapping.wrap[axis].index(i, size),
            None => i.clamp(0, i64::from(size) - 1) as u32,
        };
        let tap = |i: i64, j: i64, weight: f64| {
            let texel = (index(0, i, self.width), index(1, j, self.height));
            let at = texel.1 as usize * self.width as usize + texel.0 as usize;
            let bytes = match &self.texels {
                Texels::Eight(texels, _) => Some(texels[at]),
                Texels::Float(_) => None,
            };
            Tap { texel, weight: weight as f32, bytes, color: self.color(at).into() }
        };
        if nearest {
            return vec![tap(x.floor() as i64, y.floor() as i64, 1.0)];
        }
        let (left, top) = ((x - 0.5).floor(), (y - 0.5).floor());
        let (a, b) = (x - 0.5 - left, y - 0.5 - top);
        let (i, j) = (left as i64, top as i64);
        let mut taps: Vec<Tap> = Vec::new();
        for (i, j, weight) in
            [(i, j, (1.0 - a) * (1.0 - b)), (i + 1, j, a * (1.0 - b)), (i, j + 1, (1.0 - a) * b), (i + 1, j + 1, a * b)]
        {
            let next = tap(i, j, weight);
            match taps.iter_mut().find(|known| known.texel == next.texel) {
                Some(known) => known.weight += next.weight,
                None if next.weight > 0.0 => taps.push(next),
                None => {}
            }
        }
        taps
    }

    /// Width and height in texels.
    pub fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }
}
