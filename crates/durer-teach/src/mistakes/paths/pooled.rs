//! Statistics of a whole picture, which show differences that are too small to be visible in any
//! single block.

use super::blocks::BlockMeans;
use durer_scene::math::{LUMINANCE, Vec3};

/// Number of regions along the larger side, in each of which means are compared.
const REGIONS: u32 = 6;
/// Number of standard errors beyond which means differ, and minimum relative difference.
const MIN_ERRORS: f64 = 7.0;
const MIN_RELATIVE: f64 = 0.004;
/// Squared standard score beyond which the misfit of a block grows only linearly, because a single
/// bright sample must not decide.
const OUTLIER: f64 = 9.0;
/// Fraction of the median variance that the variance of a block is at least.
const MIN_VARIANCE: f64 = 0.2;

/// Difference between the means of two pictures that is larger than noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeanDifference {
    /// Mean luminance of the picture divided by that of the reference, for the whole picture or for
    /// the region that differs most.
    pub ratio: f64,
    /// True if the mean of the whole picture differs.
    pub whole: bool,
}

/// Compares the means of two noisy pictures of equal size, both as a whole and in regions. Returns
/// `None` if no difference can be measured.
///
/// The variance is that of the pixels' differences, which include the noise of both pictures. If
/// the difference depends on the place, the variance is overestimated, but never underestimated.
pub fn mean_difference(reference: &[Vec3], test: &[Vec3], width: u32, height: u32) -> Option<MeanDifference> {
    let side = width.max(height).div_ceil(REGIONS).max(4);
    let (columns, rows) = (width.div_ceil(side), height.div_ceil(side));
    let mut regions = vec![Sums::default(); (columns * rows) as usize];
    for (i, (a, b)) in (0..).zip(reference.iter().zip(test)) {
        let (x, y) = (i % width, i / width);
        regions[(y / side * columns + x / side) as usize].add(f64::from(a.dot(LUMINANCE)), f64::from(b.dot(LUMINANCE)));
    }
    let mut total = Sums::default();
    let mut variance = 0.0;
    for region in &regions {
        total.count += region.count;
        (total.reference, total.difference) =
            (total.reference + region.reference, total.difference + region.difference);
        variance += region.count * region.variance();
    }
    let ratio = |sums: &Sums| 1.0 + sums.difference / sums.reference.max(1e-9);
    let errors = total.difference.abs() / variance.sqrt().max(1e-12);
    if errors > MIN_ERRORS && (ratio(&total) - 1.0).abs() > MIN_RELATIVE {
        return Some(MeanDifference { ratio: ratio(&total), whole: true });
    }
    let differs = |region: &&Sums| {
        region.count >= 12.0
            && region.errors() > MIN_ERRORS
            && (ratio(region) - 1.0).abs() > 5.0 * MIN_RELATIVE
            && region.difference.abs() > MIN_RELATIVE * total.reference * region.count / total.count
    };
    let most = regions.iter().filter(differs).max_by(|a, b| a.errors().total_cmp(&b.errors()))?;
    Some(MeanDifference { ratio: ratio(most), whole: false })
}

/// Sums over the pixels of a region.
#[derive(Clone, Copy, Default)]
struct Sums {
    count: f64,
    reference: f64,
    difference: f64,
    squares: f64,
}

impl Sums {
    fn add(&mut self, reference: f64, test: f64) {
        self.count += 1.0;
        self.reference += reference;
        self.difference += test - reference;
        self.squares += (test - reference) * (test - reference);
    }

    /// Returns the variance of a pixel's difference.
    fn variance(&self) -> f64 {
        let mean = self.difference / self.count.max(1.0);
        (self.squares - self.count * mean * mean).max(0.0) / (self.count - 1.0).max(1.0)
    }

    /// Returns the number of standard errors by which the mean differs.
    fn errors(&self) -> f64 {
        self.difference.abs() / (self.count * self.variance()).sqrt().max(1e-12)
    }
}

impl BlockMeans {
    /// Returns the misfit of two pictures: the mean, over all blocks, of the squared difference
    /// divided by its variance. If the pictures differ only in their noise, the misfit is about 1.
    /// `noise` is the variance of the difference for each block.
    pub fn misfit(&self, other: &BlockMeans, noise: &[f64]) -> f64 {
        let mut sorted = noise.to_vec();
        sorted.sort_by(f64::total_cmp);
        let least = MIN_VARIANCE * sorted.get(sorted.len() / 2).copied().unwrap_or(0.0);
        let score = |((a, b), noise): ((&Vec3, &Vec3), &f64)| {
            let squared = f64::from((*a - *b).length_squared()) / noise.max(least).max(1e-12);
            if squared < OUTLIER { squared } else { 2.0 * (OUTLIER * squared).sqrt() - OUTLIER }
        };
        self.mean.iter().zip(&other.mean).zip(noise).map(score).sum::<f64>() / self.mean.len().max(1) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Noisy picture whose pixels have a mean of 0.5 times `factor`, which depends on the column.
    fn noisy(seed: u32, factor: impl Fn(u32) -> f32) -> Vec<Vec3> {
        let random = |i: u32| {
            let mixed = (i ^ seed).wrapping_mul(0x9e37_79b9).rotate_left(13).wrapping_mul(0x85eb_ca6b);
            ((mixed ^ mixed >> 15).wrapping_mul(0xc2b2_ae35) >> 8) as f32 / (1 << 24) as f32
        };
        (0..60 * 60).map(|i| Vec3::splat(factor(i % 60) * (0.25 + 0.5 * random(i)))).collect()
    }

    #[test]
    fn small_differences_of_the_mean_are_measured_and_noise_is_not() {
        let reference = noisy(1, |_| 1.0);
        let equal = mean_difference(&reference, &noisy(77_777, |_| 1.0), 60, 60);
        assert_eq!(equal, None);
        let darker = mean_difference(&reference, &noisy(77_777, |_| 0.9), 60, 60).unwrap();
        assert!(darker.whole && (darker.ratio - 0.9).abs() < 0.04, "{darker:?}");
        let partly = mean_difference(&reference, &noisy(77_777, |x| if x < 10 { 0.4 } else { 1.0 }), 60, 60).unwrap();
        assert!(partly.ratio < 1.0, "{partly:?}");
    }
}
