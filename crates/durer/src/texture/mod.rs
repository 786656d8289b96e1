//! Pictures on surfaces and around the scene.

pub mod cie_sky;
pub mod cube_map;
pub mod environment;
pub mod mapping;
pub mod sky;

use crate::math::{Color, Vec2};
pub use cie_sky::CieSky;
pub use cube_map::CubeMap;
pub use environment::Environment;
pub use mapping::{Channel, Mapping, Wrap};
pub use sky::Sky;
use std::sync::Arc;

/// A decoded picture: looked up as the course does or, with a [`Mapping`], as that says.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    width: u32,
    height: u32,
    /// Eight bits a channel, row 0 on top.
    texels: Arc<[[u8; 3]]>,
    /// What each of the 256 values means.
    values: Box<[f32; 256]>,
    /// Opacity of each texel in 255ths, where not all are opaque.
    alpha: Option<Arc<[u8]>>,
    mapping: Option<Mapping>,
}

impl Texture {
    /// From texels, row 0 on top. `None` unless there are width times height of them, and at least one.
    pub fn new(width: u32, height: u32, texels: Vec<[u8; 3]>) -> Option<Self> {
        let count = (width as usize).checked_mul(height as usize)?;
        let values = Box::new(std::array::from_fn(|i| i as f32 / 255.0));
        (count > 0 && texels.len() == count).then_some(Texture {
            width,
            height,
            texels: texels.into(),
            values,
            alpha: None,
            mapping: None,
        })
    }

    /// The same texels, with other meanings of the 256 values.
    pub fn decoded(self, decode: impl Fn(u8) -> f32) -> Self {
        Texture { values: Box::new(std::array::from_fn(|i| decode(i as u8))), ..self }
    }

    /// Whether it is not opaque everywhere.
    pub fn has_alpha(&self) -> bool {
        self.alpha.is_some()
    }

    /// Bytes in memory.
    pub fn bytes(&self) -> usize {
        self.texels.len() * 3 + self.alpha.as_ref().map_or(0, |alpha| alpha.len())
    }

    /// The same with an opacity for each texel; opaque where there are not as many.
    pub fn with_alpha(self, alpha: Option<Vec<u8>>) -> Self {
        let alpha = alpha.filter(|alpha| alpha.len() == self.texels.len() && alpha.iter().any(|&a| a < 255));
        Texture { alpha: alpha.map(Into::into), ..self }
    }

    /// Whether all texels are the same.
    pub fn is_flat(&self) -> bool {
        self.texels.iter().all(|texel| *texel == self.texels[0])
    }

    /// The same texels, shared, lying otherwise on surfaces.
    pub fn mapped(&self, mapping: Mapping) -> Self {
        Texture { mapping: Some(mapping), ..self.clone() }
    }

    /// How it lies on surfaces, unless as the course has it.
    pub fn mapping(&self) -> Option<&Mapping> {
        self.mapping.as_ref()
    }

    /// Colour and opacity at (u, v), with v upwards, as its mapping says. Bilinear mixing is of linear values.
    pub fn texel(&self, mapping: &Mapping, uv: Vec2) -> [f32; 4] {
        self.texel_at(mapping, mapping.place(uv))
    }

    /// How the red of a place changes with u and v.
    pub fn slope(&self, mapping: &Mapping, uv: Vec2) -> Vec2 {
        let place = mapping.place(uv);
        // As far as a texel is wide: less would tell where texels lie, and no more of the picture.
        let step = Vec2::new(1.0 / self.width as f32, 1.0 / self.height as f32);
        let along = |way: Vec2| {
            let [after, before] = [place + 0.5 * way, place - 0.5 * way].map(|at| self.texel_at(mapping, at)[0]);
            after - before
        };
        let (x, y) = (along(Vec2::new(step.x, 0.0)) / step.x, along(Vec2::new(0.0, step.y)) / step.y);
        let [[a, b, _], [c, d, _]] = mapping.transform;
        // The surface's v goes up, the picture's down.
        Vec2::new(a * x + c * y, -(b * x + d * y))
    }

    /// The same at a place of the picture, in its widths from the left and heights from the top.
    fn texel_at(&self, mapping: &Mapping, place: Vec2) -> [f32; 4] {
        let (x, y) = (f64::from(place.x) * f64::from(self.width), f64::from(place.y) * f64::from(self.height));
        let texel = |i: i64, j: i64| {
            let (i, j) = (mapping.wrap[0].index(i, self.width), mapping.wrap[1].index(j, self.height));
            let at = j as usize * self.width as usize + i as usize;
            let [r, g, b] = self.texels[at].map(|c| self.values[usize::from(c)]);
            [r, g, b, self.alpha.as_ref().map_or(1.0, |alpha| f32::from(alpha[at]) / 255.0)]
        };
        if mapping.nearest {
            return mapping.cut(texel(x.floor() as i64, y.floor() as i64));
        }
        let (left, top) = ((x - 0.5).floor(), (y - 0.5).floor());
        let (a, b) = ((x - 0.5 - left) as f32, (y - 0.5 - top) as f32);
        let (i, j) = (left as i64, top as i64);
        let corners = [texel(i, j), texel(i.saturating_add(1), j), texel(i, j.saturating_add(1))];
        let last = texel(i.saturating_add(1), j.saturating_add(1));
        let mixed: [f32; 4] = std::array::from_fn(|c| {
            let upper = (1.0 - a) * corners[0][c] + a * corners[1][c];
            let lower = (1.0 - a) * corners[2][c] + a * last[c];
            (1.0 - b) * upper + b * lower
        });
        mapping.cut(mixed)
    }

    /// The colour at (u, v), with v upwards: bilinear, with no half-texel shift, clamped at the border; or as its mapping
    /// says.
    pub fn at(&self, uv: Vec2) -> Color {
        if let Some(mapping) = &self.mapping {
            let [r, g, b, _] = self.texel(mapping, uv);
            return Color::new(r, g, b);
        }
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
