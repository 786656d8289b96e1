//! Means of a path-traced picture over blocks of pixels, with their variances due to noise.

use super::walker::BuggyPathTracer;
use crate::mistakes::path_bugs::PixelMean;
use crate::mistakes::pictures::View;
use crate::mistakes::variant::SceneVariant;
use durer_render::render::sample_places;
use durer_scene::math::{Color, Vec2, Vec3};
use durer_scene::spectrum::Spectrum;
use rayon::prelude::*;

/// Number of blocks along the larger side, and maximum number of camera paths per picture.
const BLOCKS: u32 = 20;
const MAX_PATHS: u32 = 150_000;
/// Maximum number of samples per pixel.
const MAX_SAMPLES: u32 = 64;
/// Variance caused by rounding to eight bits.
const ROUNDING: f64 = 1.0 / (12.0 * 255.0 * 255.0);

/// Grid of square blocks over a picture. It stores the pixels in each block that are rendered and
/// compared.
pub struct Blocks {
    /// Selected pixels of each block.
    pub pixels: Vec<Vec<(u32, u32)>>,
}

/// Mean colour of each block of a picture, and the noise variance of that mean.
#[derive(Clone, Debug)]
pub struct BlockMeans {
    pub mean: Vec<Vec3>,
    pub variance: Vec<f64>,
}

impl Blocks {
    /// Divides a picture into blocks and selects pixels so that the number of paths is limited.
    pub fn new(width: u32, height: u32, samples: u32) -> Self {
        let side = (width.max(height)).div_ceil(BLOCKS).max(2);
        let (columns, rows) = (width.div_ceil(side), height.div_ceil(side));
        let most = (MAX_PATHS / (columns * rows) / samples.clamp(1, MAX_SAMPLES)).max(1) as usize;
        let block = |i: u32| {
            let (x, y) = (i % columns * side, i / columns * side);
            let all: Vec<(u32, u32)> =
                (y..(y + side).min(height)).flat_map(|y| (x..(x + side).min(width)).map(move |x| (x, y))).collect();
            // An odd step spreads the pixels over the block.
            let step = (all.len().div_ceil(most)) | 1;
            all.into_iter().step_by(step).collect()
        };
        Blocks { pixels: (0..columns * rows).map(block).collect() }
    }

    /// Returns one pixel of every other block. A quick render of these pixels shows if a mistake
    /// has any effect.
    pub fn probe(&self) -> Self {
        Blocks { pixels: self.pixels.iter().step_by(2).map(|block| vec![block[block.len() / 2]]).collect() }
    }

    /// Returns the block means of a finished picture. Their variance includes only rounding.
    pub fn of_picture(&self, width: u32, values: &[Vec3]) -> BlockMeans {
        let mean = |block: &Vec<(u32, u32)>| {
            let sum: Vec3 = block.iter().map(|&(x, y)| values[(y * width + x) as usize]).sum();
            sum / block.len() as f32
        };
        let variance = self.pixels.iter().map(|block| ROUNDING / block.len() as f64).collect();
        BlockMeans { mean: self.pixels.iter().map(mean).collect(), variance }
    }

    /// Renders a variant of the scene and returns the means of its blocks.
    pub fn render(&self, view: &View, variant: &SceneVariant, seed: u64) -> BlockMeans {
        let (walker, raster) = (BuggyPathTracer::new(variant), variant.raster(view.job.width, view.job.height));
        let places = sample_places(&variant.world, view.job);
        let exposed = |light: Color| view.values(variant.output, &[light])[0];
        // Returns the value of a pixel and the variance of that value.
        let pixel = |&(x, y): &(u32, u32)| {
            let (mut all, mut weights, mut throughput) = (Vec::new(), 0.0, Spectrum::ONE);
            let mut add = |place: Vec2, lens: Vec2, weight: f32| {
                if all.len() < MAX_SAMPLES as usize {
                    let light = variant.ray(&raster, (x, y), place, lens).map_or(Color::ZERO, |ray| {
                        walker.radiance(&ray, seed, (x, y), all.len() as u32, &mut throughput)
                    });
                    let light = match variant.paths.pixel_mean {
                        PixelMean::Light => light,
                        PixelMean::Clamped => light.clamp(Color::ZERO, Color::ONE),
                        PixelMean::Shown => exposed(light),
                    };
                    all.push(weight * light);
                    weights += weight;
                }
            };
            places(x, y, &mut add);
            let count = all.len().max(1) as f32;
            let mean = all.iter().sum::<Color>() / weights.max(1e-6);
            let value = if variant.paths.pixel_mean == PixelMean::Shown { mean } else { exposed(mean) };
            // The standard error of the mean is converted to display values by means of a finite
            // difference.
            let spread = all.iter().map(|light| (*light * count / weights.max(1e-6) - mean).length_squared());
            let error = (spread.sum::<f32>() / (count * (count - 1.0).max(1.0))).sqrt();
            let step = Color::splat(error / 3.0_f32.sqrt());
            let moved = if variant.paths.pixel_mean == PixelMean::Shown { mean + step } else { exposed(mean + step) };
            (value, f64::from((moved - value).length_squared()).max(3.0 * ROUNDING))
        };
        let block = |block: &Vec<(u32, u32)>| {
            let all: Vec<(Vec3, f64)> = block.iter().map(pixel).collect();
            let count = all.len() as f32;
            let mean = all.iter().map(|one| one.0).sum::<Vec3>() / count;
            (mean, all.iter().map(|one| one.1).sum::<f64>() / f64::from(count * count))
        };
        let (mean, variance) = self.pixels.par_iter().map(block).unzip();
        BlockMeans { mean, variance }
    }
}

impl BlockMeans {
    /// Returns `other`, with its variance increased by `ratio` times the variance of `self`.
    pub fn with_noise_of(&self, mut other: BlockMeans, ratio: f64) -> BlockMeans {
        for (own, other) in self.variance.iter().zip(&mut other.variance) {
            *other += ratio * own;
        }
        other
    }

    /// Returns, for each block, the squared difference beyond noise, and true if it is significant.
    /// `noise` is the variance of the difference for each block.
    pub fn excess_difference(&self, other: &BlockMeans, noise: &[f64]) -> Vec<(f64, bool)> {
        let pairs = self.mean.iter().zip(&other.mean).zip(noise);
        pairs
            .map(|((a, b), noise)| {
                let squared = f64::from((*a - *b).length_squared());
                ((squared - noise).max(0.0), squared > MIN_SIGNIFICANCE * noise + INVISIBLE)
            })
            .collect()
    }
}

/// Ratio of the squared difference to the noise variance above which a difference is significant.
/// It corresponds to about 3.5 standard errors.
const MIN_SIGNIFICANCE: f64 = 12.0;
/// Squared difference that is invisible even if there is no noise.
const INVISIBLE: f64 = 3.0 * (1.0 / 255.0) * (1.0 / 255.0);
