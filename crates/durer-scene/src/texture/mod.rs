//! Textures on surfaces and in the environment.

pub mod almanac;
pub mod cie_sky;
pub mod cube_map;
pub mod environment;
pub mod mapping;
mod mipmap;
pub mod sky;
mod taps;

use crate::math::{Color, Vec2, fp};
pub use cie_sky::CieSky;
pub use cube_map::CubeMap;
pub use environment::Environment;
pub use mapping::{Channel, Mapping, Wrap};
pub use sky::{Sky, SkyModel};
use std::sync::Arc;
pub use taps::Tap;

/// Decoded image that is mapped onto surfaces, either by the rules of the course or by a
/// [`Mapping`].
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    width: u32,
    height: u32,
    texels: Texels,
    /// Opacity of each texel; `None` if all are opaque.
    alpha: Option<Opacity>,
    mapping: Option<Mapping>,
    /// Mipmap levels; empty if there are none.
    levels: Arc<[Texture]>,
}

/// Texels of a texture in red, green and blue, starting with the top row.
#[derive(Clone, Debug, PartialEq)]
enum Texels {
    /// Texels with 8 bits per channel, and the decoded value of each of the 256 codes.
    Eight(Arc<[[u8; 3]]>, Box<[f32; 256]>),
    /// Linear values.
    Float(Arc<[Color]>),
}

/// Opacity of each texel of a texture, starting with the top row.
#[derive(Clone, Debug, PartialEq)]
enum Opacity {
    /// Opacity in units of 1/255.
    Eight(Arc<[u8]>),
    /// Opacity from 0 to 1.
    Float(Arc<[f32]>),
}

impl Texture {
    /// Creates a texture from 8-bit texels, starting with the top row. Returns `None` unless the
    /// number of texels equals width times height and is at least one.
    pub fn new(width: u32, height: u32, texels: Vec<[u8; 3]>) -> Option<Self> {
        let values = Box::new(std::array::from_fn(|i| i as f32 / 255.0));
        Texture::of(width, height, texels.len(), || Texels::Eight(texels.into(), values))
    }

    /// Creates a texture from linear `f32` texels, starting with the top row.
    pub fn from_floats(width: u32, height: u32, texels: Vec<Color>) -> Option<Self> {
        Texture::of(width, height, texels.len(), || Texels::Float(texels.into()))
    }

    fn of(width: u32, height: u32, count: usize, texels: impl FnOnce() -> Texels) -> Option<Self> {
        let fits = (width as usize).checked_mul(height as usize).is_some_and(|wanted| wanted == count && count > 0);
        fits.then(|| Texture { width, height, texels: texels(), alpha: None, mapping: None, levels: Arc::default() })
    }

    /// Replaces the decoded values of 8-bit codes. This has no effect on `f32` texels.
    pub fn with_decoding(self, decode: impl Fn(u8) -> f32) -> Self {
        let texels = match self.texels {
            Texels::Eight(texels, _) => Texels::Eight(texels, Box::new(std::array::from_fn(|i| decode(i as u8)))),
            floats => floats,
        };
        Texture { texels, ..self }
    }

    fn count(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// Returns the colour of the texel at an index.
    fn color(&self, at: usize) -> [f32; 3] {
        match &self.texels {
            Texels::Eight(texels, values) => texels[at].map(|c| values[usize::from(c)]),
            Texels::Float(texels) => texels[at].to_array(),
        }
    }

    /// Returns the opacity of the texel at an index.
    fn opacity(&self, at: usize) -> f32 {
        match &self.alpha {
            None => 1.0,
            Some(Opacity::Eight(alpha)) => f32::from(alpha[at]) / 255.0,
            Some(Opacity::Float(alpha)) => alpha[at],
        }
    }

    /// True if at least one texel is not opaque.
    pub fn has_alpha(&self) -> bool {
        self.alpha.is_some()
    }

    /// Size in memory in bytes.
    pub fn bytes(&self) -> usize {
        let texel = match &self.texels {
            Texels::Eight(..) => size_of::<[u8; 3]>(),
            Texels::Float(_) => size_of::<Color>(),
        };
        let opacity = match &self.alpha {
            None => 0,
            Some(Opacity::Eight(_)) => size_of::<u8>(),
            Some(Opacity::Float(_)) => size_of::<f32>(),
        };
        self.count() * (texel + opacity) + self.levels.iter().map(Texture::bytes).sum::<usize>()
    }

    /// Sets the opacity of each texel. The texture is opaque if the number of values differs from
    /// the number of texels.
    pub fn with_alpha(self, alpha: Option<Vec<u8>>) -> Self {
        let alpha = alpha.filter(|alpha| alpha.len() == self.count() && alpha.iter().any(|&a| a < 255));
        Texture { alpha: alpha.map(|alpha| Opacity::Eight(alpha.into())), ..self }
    }

    /// Sets the opacity of each texel, from 0 to 1. See [`Texture::with_alpha`].
    pub fn with_opacity(self, alpha: Vec<f32>) -> Self {
        let is_given = alpha.len() == self.count() && alpha.iter().any(|&a| a < 1.0);
        Texture { alpha: is_given.then(|| Opacity::Float(alpha.into())), ..self }
    }

    /// True if all texels have the same colour and the same opacity.
    pub fn is_flat(&self) -> bool {
        self.has_one_color() && self.all_opacities(|opacity| opacity == self.opacity(0))
    }

    fn has_one_color(&self) -> bool {
        match &self.texels {
            Texels::Eight(texels, _) => texels.iter().all(|texel| *texel == texels[0]),
            Texels::Float(texels) => texels.iter().all(|texel| *texel == texels[0]),
        }
    }

    /// True if all texels, in linear red, green and blue, satisfy a condition.
    pub fn all_texels(&self, condition: impl Fn([f32; 3]) -> bool) -> bool {
        (0..self.count()).all(|at| condition(self.color(at)))
    }

    /// True if the opacities of all texels, from 0 to 1, satisfy a condition.
    pub fn all_opacities(&self, condition: impl Fn(f32) -> bool) -> bool {
        (0..self.count()).all(|at| condition(self.opacity(at)))
    }

    /// Returns a texture that shares the texels but has another mapping.
    pub fn with_mapping(&self, mapping: Mapping) -> Self {
        Texture { mapping: Some(mapping), ..self.clone() }
    }

    /// Mapping onto surfaces; `None` if the rules of the course apply.
    pub fn mapping(&self) -> Option<&Mapping> {
        self.mapping.as_ref()
    }

    /// Colour and opacity at the coordinates (u, v), with v up, according to a mapping. Bilinear
    /// filtering uses linear values. `width` is the width of the sample, in texels of the full-size
    /// image. If the texture has mipmap levels, the result is interpolated between the two levels
    /// whose texels are about that wide.
    pub fn texel(&self, mapping: &Mapping, uv: Vec2, width: f32) -> [f32; 4] {
        let place = mapping.texture_position(uv);
        if width <= 1.0 || width.is_nan() || self.levels.is_empty() {
            return mapping.apply_cutoff(self.texel_at(mapping, place));
        }
        let level = (fp::ln(width) * std::f32::consts::LOG2_E).min(self.levels.len() as f32);
        let (larger, part) = (level as usize, level.fract());
        let of = |level: usize| match level.checked_sub(1) {
            None => self.texel_at(mapping, place),
            Some(i) => {
                self.levels[i.min(self.levels.len() - 1)].texel_at(&Mapping { nearest: false, ..*mapping }, place)
            }
        };
        let (larger, smaller) = (of(larger), of(larger + 1));
        mapping.apply_cutoff(std::array::from_fn(|c| larger[c] + part * (smaller[c] - larger[c])))
    }

    /// Converts a length in texture coordinates to a number of texels.
    pub fn texels_in(&self, mapping: &Mapping, length: f32) -> f32 {
        let [[a, b, _], [c, d, _]] = mapping.transform;
        let area = (a * d - b * c).abs() * self.width as f32 * self.height as f32;
        length * area.sqrt()
    }

    /// Gradient of the red channel with respect to u and v.
    pub fn slope(&self, mapping: &Mapping, uv: Vec2) -> Vec2 {
        let place = mapping.texture_position(uv);
        // Use a step of one texel. A smaller step would only reveal the texel grid.
        let step = Vec2::new(1.0 / self.width as f32, 1.0 / self.height as f32);
        let along = |way: Vec2| {
            let [after, before] = [place + 0.5 * way, place - 0.5 * way].map(|at| self.texel_at(mapping, at)[0]);
            after - before
        };
        let (x, y) = (along(Vec2::new(step.x, 0.0)) / step.x, along(Vec2::new(0.0, step.y)) / step.y);
        mapping.gradient(Vec2::new(x, y))
    }

    /// Version of [`Texture::slope`] that returns the derivative of the interpolated values. It is
    /// zero if they are not interpolated.
    pub fn exact_slope(&self, mapping: &Mapping, uv: Vec2) -> Vec2 {
        if mapping.nearest {
            return Vec2::ZERO;
        }
        let size = Vec2::new(self.width as f32, self.height as f32);
        let place = mapping.texture_position(uv) * size - 0.5;
        let cell = place.floor();
        let Vec2 { x: a, y: b } = place - cell;
        // The centres of texels are at integer positions of the cell.
        let [p, q, r, s] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]]
            .map(|[i, j]| self.texel_at(mapping, (cell + Vec2::new(i, j) + 0.5) / size)[0]);
        let x = size.x * ((1.0 - b) * (q - p) + b * (s - r));
        let y = size.y * ((1.0 - a) * (r - p) + a * (s - q));
        mapping.gradient(Vec2::new(x, y))
    }

    /// Colour and opacity at a position in the texture, before the alpha cutoff. The position is
    /// measured in texture widths from the left and texture heights from the top.
    fn texel_at(&self, mapping: &Mapping, place: Vec2) -> [f32; 4] {
        let (x, y) = (f64::from(place.x) * f64::from(self.width), f64::from(place.y) * f64::from(self.height));
        let texel = |i: i64, j: i64| {
            let (i, j) = (mapping.wrap[0].index(i, self.width), mapping.wrap[1].index(j, self.height));
            let at = j as usize * self.width as usize + i as usize;
            let [r, g, b] = self.color(at);
            [r, g, b, self.opacity(at)]
        };
        if mapping.nearest {
            return texel(x.floor() as i64, y.floor() as i64);
        }
        let (left, top) = ((x - 0.5).floor(), (y - 0.5).floor());
        let (a, b) = ((x - 0.5 - left) as f32, (y - 0.5 - top) as f32);
        let (i, j) = (left as i64, top as i64);
        let corners = [texel(i, j), texel(i.saturating_add(1), j), texel(i, j.saturating_add(1))];
        let last = texel(i.saturating_add(1), j.saturating_add(1));
        std::array::from_fn(|c| {
            let upper = (1.0 - a) * corners[0][c] + a * corners[1][c];
            let lower = (1.0 - a) * corners[2][c] + a * last[c];
            (1.0 - b) * upper + b * lower
        })
    }

    /// Colour at the coordinates (u, v), with v up. The mapping is used if there is one. Otherwise,
    /// the colour is interpolated bilinearly without a half-texel shift, and clamped at the border.
    pub fn at(&self, uv: Vec2) -> Color {
        if let Some(mapping) = &self.mapping {
            let [r, g, b, _] = self.texel(mapping, uv, 0.0);
            return Color::new(r, g, b);
        }
        let (width, height) = (self.width as f32, self.height as f32);
        // Applying `max` before `min` maps NaN to 0.
        let x = (uv.x * width).max(0.0).min(width);
        let y = ((1.0 - uv.y) * height).max(0.0).min(height);
        let (left, top) = (x.trunc(), y.trunc());
        let (a, b) = (x - left, y - top);
        let texel = |dx: f32, dy: f32| {
            let i = ((left + dx) as u32).min(self.width - 1);
            let j = ((top + dy) as u32).min(self.height - 1);
            Color::from(self.color(j as usize * self.width as usize + i as usize))
        };
        (1.0 - b) * ((1.0 - a) * texel(0.0, 0.0) + a * texel(1.0, 0.0))
            + b * ((1.0 - a) * texel(0.0, 1.0) + a * texel(1.0, 1.0))
    }
}

#[cfg(test)]
mod tests;
