//! Mipmaps, which are smaller versions of a texture for samples that cover many texels.
//!
//! Source: Williams, *Pyramidal Parametrics*, SIGGRAPH 1983.

use super::{Opacity, Texels, Texture};
use rayon::prelude::*;
use std::iter::successors;
use std::sync::Arc;

impl Texture {
    /// Adds mipmap levels down to one texel. Each level is half as wide and half as high as the
    /// previous one.
    pub fn with_levels(self) -> Self {
        let first = Texture { mapping: None, levels: Arc::default(), ..self.clone() };
        let levels = successors(Some(first), |level| (level.count() > 1).then(|| level.halved())).skip(1).collect();
        Texture { levels, ..self }
    }

    /// True if the texture has mipmap levels.
    pub fn has_levels(&self) -> bool {
        !self.levels.is_empty()
    }

    /// Returns the texture at half the width and height. Each texel is the mean of the linear
    /// values of the texels that it covers. 8-bit colours are rounded to 8 bits again.
    fn halved(&self) -> Texture {
        let (width, height) = ((self.width / 2).max(1), (self.height / 2).max(1));
        let mean = |i: u32, j: u32| {
            let mut sum = [0.0; 4];
            for (y, down) in covered(j, height, self.height) {
                for (x, across) in covered(i, width, self.width) {
                    let at = y * self.width as usize + x;
                    let [r, g, b] = self.color(at);
                    for (sum, part) in sum.iter_mut().zip([r, g, b, self.opacity(at)]) {
                        *sum += across * down * part;
                    }
                }
            }
            sum
        };
        let row = |j: u32| (0..width).map(move |i| mean(i, j));
        let means: Vec<[f32; 4]> = (0..height).into_par_iter().flat_map_iter(row).collect();
        let texels = match &self.texels {
            Texels::Eight(_, values) => {
                let nearest = |x: f32| {
                    let above = values.partition_point(|value| *value < x).clamp(1, 255);
                    if x - values[above - 1] < values[above] - x { above as u8 - 1 } else { above as u8 }
                };
                Texels::Eight(means.iter().map(|[r, g, b, _]| [*r, *g, *b].map(nearest)).collect(), values.clone())
            }
            Texels::Float(_) => Texels::Float(means.iter().map(|[r, g, b, _]| [*r, *g, *b].into()).collect()),
        };
        let opacities = means.iter().map(|texel| texel[3]);
        let alpha = self.alpha.as_ref().map(|alpha| match alpha {
            Opacity::Eight(_) => Opacity::Eight(opacities.map(|a| (a * 255.0).round() as u8).collect()),
            Opacity::Float(_) => Opacity::Float(opacities.collect()),
        });
        Texture { width, height, texels, alpha, mapping: None, levels: Arc::default() }
    }
}

/// Returns the two or three texels in a row of `large` texels that texel `i` in a row of `small`
/// texels covers. Each is returned with the fraction that it contributes.
fn covered(i: u32, small: u32, large: u32) -> impl Iterator<Item = (usize, f32)> {
    let size = f64::from(large) / f64::from(small);
    let (from, to) = (f64::from(i) * size, (f64::from(i + 1) * size).min(f64::from(large)));
    let share = move |x: usize| ((x as f64 + 1.0).min(to) - (x as f64).max(from)) / size;
    (from as usize..to.ceil() as usize).map(move |x| (x, share(x) as f32))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Color, Vec2};
    use crate::texture::Mapping;

    fn stripes(width: u32, height: u32) -> Texture {
        let texels = (0..width * height).map(|i| Color::splat((i % width % 2) as f32)).collect();
        Texture::from_floats(width, height, texels).unwrap()
    }

    #[test]
    fn levels_keep_the_mean() {
        for (width, height) in [(1, 1), (2, 1), (7, 5), (16, 16), (33, 2), (100, 3)] {
            let texels: Vec<Color> = (0..width * height).map(|i| Color::splat((i * i % 17) as f32)).collect();
            let mean = texels.iter().map(|c| c.x).sum::<f32>() / texels.len() as f32;
            let texture = Texture::from_floats(width, height, texels).unwrap().with_levels();
            for level in texture.levels.iter() {
                let sum: f32 = (0..level.count()).map(|at| level.color(at)[0]).sum();
                assert!((sum / level.count() as f32 - mean).abs() < 1e-4 * mean.max(1.0), "{width} x {height}");
            }
            let sizes: Vec<u32> = texture.levels.iter().map(|level| level.width).collect();
            assert!(texture.levels.last().is_none_or(|last| last.count() == 1), "{sizes:?}");
        }
    }

    #[test]
    fn levels_average_linear_values_and_round_to_eight_bits() {
        let texture = Texture::new(2, 1, vec![[0, 10, 255], [255, 12, 255]]).unwrap();
        let square = texture.with_decoding(|x| (f32::from(x) / 255.0) * (f32::from(x) / 255.0)).with_levels();
        // The mean of the decoded codes 10 and 12 is nearly the decoded code 11, which is (11 /
        // 255)^2.
        let [r, g, b] = square.levels[0].color(0);
        assert!((r - 0.5).abs() < 0.004 && (g - 0.00186).abs() < 1e-4 && b == 1.0, "{r} {g} {b}");
        let clear = Texture::new(2, 1, vec![[9; 3]; 2]).unwrap().with_alpha(Some(vec![0, 255])).with_levels();
        assert!((clear.levels[0].opacity(0) - 0.5).abs() < 0.003);
    }

    #[test]
    fn levels_are_selected_by_width_and_interpolated() {
        let texture = stripes(64, 64).with_levels();
        let mapping = Mapping { nearest: true, ..Mapping::default() };
        let at = |width: f32| texture.texel(&mapping, Vec2::new(0.5 / 64.0, 0.5), width)[0];
        assert_eq!(at(0.0), 0.0);
        assert_eq!(at(1.0), 0.0);
        assert_eq!(at(2.0), 0.5);
        // This width is halfway between two levels on a logarithmic scale.
        assert!((at(2.0_f32.sqrt()) - 0.25).abs() < 1e-6, "{}", at(2.0_f32.sqrt()));
        assert_eq!(at(1e30), 0.5);
        assert_eq!(at(f32::NAN), 0.0);
        assert_eq!(at(f32::INFINITY), 0.5);
    }
}
