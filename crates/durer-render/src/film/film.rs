//! A film with exact sums. Samples are added as integers, so the result does not depend on the
//! order in which samples are added and films are merged.

use super::bytes::{ByteReader, write_signed, write_unsigned};
use durer_scene::math::{Color, LUMINANCE_F64, Vec3};

#[cfg(test)]
mod tests;

/// Accumulator of weighted samples for a rectangle of a picture. Each pixel has its own sums.
///
/// Each weight is rounded to a multiple of 2^-24, and each product of colour and weight to a
/// multiple of 2^-48 (ties to even). All further arithmetic is addition of integers. Colours are
/// clamped to ±2^44, and weights are at most 2^10. A pixel can hold 2^25 samples of maximum colour
/// and weight, or 2^35 samples of maximum colour and weight 1.
///
/// To compute the variance of the mean, the film also sums luminances and their squares. Luminances
/// are rounded to multiples of 2^-28 and clamped to ±2^14. These sums are exact for up to 2^21
/// samples.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Film {
    left: u32,
    top: u32,
    width: u32,
    height: u32,
    pub(super) pixels: Vec<Pixel>,
    rejected: u64,
    first_rejected: Vec<Rejected>,
}

/// Integer sums of one pixel of a [`Film`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Pixel {
    /// Sum of weighted colours, in units of 2^-48.
    pub(super) color: [i128; 3],
    /// Sum of squared unweighted luminances, in units of 2^-56.
    pub(super) squares: i128,
    /// Sum of unweighted luminances, in units of 2^-28.
    pub(super) luminance: i64,
    /// Sum of weights, in units of 2^-24.
    pub(super) weight: i64,
    /// Sum of the products of weight and coverage of the samples, in units of 2^-24.
    pub(super) covered: i64,
    pub(super) samples: u64,
}

impl Pixel {
    /// Adds a sample that covers a share of the pixel. Returns `false` if the sample is not finite.
    #[inline]
    pub(super) fn add_any(&mut self, color: Color, share: f32, weight: f32) -> bool {
        // This is the fast path, because almost all samples are small.
        if share == 1.0 && SmallSums::fits(color, weight) {
            let mut small = SmallSums::default();
            small.add(color, weight);
            self.add_small(&small);
            return true;
        }
        self.add(color.to_array().map(f64::from), weight.into(), share.into())
    }

    /// Adds a sample and clamps its colour if it is too bright. Returns `false` if the sample is
    /// not finite.
    fn add(&mut self, rgb: [f64; 3], weight: f64, share: f64) -> bool {
        let weight = weight * WEIGHT_SCALE;
        if !(weight.abs() <= GREATEST_WEIGHT * WEIGHT_SCALE && rgb.iter().all(|c| c.is_finite())) {
            return false;
        }
        let rgb = rgb.map(|c| c.clamp(-GREATEST_COLOR, GREATEST_COLOR));
        // The weight has at most 24 significant bits, so each product below is exact before it is
        // rounded.
        let weight = weight.round_ties_even();
        let scale = weight * (COLOR_SCALE / WEIGHT_SCALE);
        let luminance = luminance(rgb).clamp(-GREATEST_LUMINANCE, GREATEST_LUMINANCE) * LUMINANCE_SCALE;
        self.sum(rgb.map(|c| (c * scale).round_ties_even() as i128), weight as i64, luminance.round_ties_even() as i64);
        self.covered = self.covered.wrapping_add((weight * share).round_ties_even() as i64);
        true
    }

    /// Returns true if `most_samples` samples could produce these sums, which come from a file.
    fn is_possible(&self, most_samples: u32) -> bool {
        let (n, most) = (i128::from(self.samples), |greatest: f64, scale: f64| greatest as i128 * scale as i128);
        let within =
            |sum: i128, greatest: i128| sum.unsigned_abs() <= n.unsigned_abs().saturating_mul(greatest as u128);
        let luminance = most(GREATEST_LUMINANCE, LUMINANCE_SCALE);
        self.samples <= u64::from(most_samples)
            && within(self.weight.into(), most(GREATEST_WEIGHT, WEIGHT_SCALE))
            && within(self.covered.into(), most(GREATEST_WEIGHT, WEIGHT_SCALE))
            && self.color.iter().all(|&sum| within(sum, most(GREATEST_COLOR * GREATEST_WEIGHT, COLOR_SCALE)))
            && within(self.luminance.into(), luminance)
            && self.squares >= 0
            && within(self.squares, luminance * luminance)
    }

    /// Adds the sums in a [`SmallSums`].
    fn add_small(&mut self, small: &SmallSums) {
        self.color.iter_mut().zip(small.color).for_each(|(sum, c)| *sum = sum.wrapping_add(c.into()));
        self.luminance = self.luminance.wrapping_add(small.luminance);
        self.squares = self.squares.wrapping_add(small.squares);
        self.weight = self.weight.wrapping_add(small.weight);
        self.covered = self.covered.wrapping_add(small.weight);
        self.samples += small.samples;
    }

    /// Returns the sums for a single sample with weight 1 and full coverage.
    pub(super) fn of_single(color: Color) -> Self {
        let mut pixel = Pixel::default();
        pixel.add_any(color, 1.0, 1.0);
        pixel
    }

    /// Returns the colour if the sums are those of [`Pixel::of_single`]. A single-precision number
    /// is exact after rounding to a multiple of 2^-48, so the colour can be recovered.
    #[inline]
    pub(super) fn single(&self) -> Option<Color> {
        if self.samples != 1 || self.weight != WEIGHT_SCALE as i64 || self.covered != self.weight {
            return None;
        }
        let mut color = [0.0_f32; 3];
        for (channel, &sum) in color.iter_mut().zip(&self.color) {
            *channel = (rounded(sum) / COLOR_SCALE) as f32;
        }
        let rgb = color.map(f64::from);
        if rgb.iter().map(|c| c.abs()).sum::<f64>() >= f64::from(SMALL_COLOR) {
            let color = Color::from(color);
            return (Pixel::of_single(color) == *self).then_some(color);
        }
        // This must be the same arithmetic as in `SmallSums::add`.
        let is_same = rgb.iter().zip(&self.color).all(|(c, &sum)| i128::from((c * COLOR_SCALE) as i64) == sum)
            && whole_number(luminance(rgb) * LUMINANCE_SCALE) == self.luminance
            && i128::from(self.luminance) * i128::from(self.luminance) == self.squares;
        is_same.then(|| Color::from(color))
    }

    /// Returns the weighted mean colour; see [`Film::resolve`].
    #[inline]
    pub(super) fn mean(&self) -> Color {
        if self.weight == 0 {
            return Vec3::ZERO;
        }
        // Round each sum to double precision, divide, and round to single precision.
        let weight = self.weight as f64 / WEIGHT_SCALE;
        Vec3::from(self.color.map(|sum| (rounded(sum) / COLOR_SCALE / weight) as f32))
    }

    /// Returns the coverage; see [`Film::coverage`].
    #[inline]
    pub(super) fn coverage(&self) -> f32 {
        // This is also true if both sums are zero. The pixel then counts as fully covered.
        if self.covered == self.weight {
            return 1.0;
        }
        // Negative filter weights can give values outside this range, and infinity if the sum of
        // the weights is 0.
        (self.covered as f64 / self.weight as f64).clamp(0.0, 1.0) as f32
    }

    #[inline]
    fn sum(&mut self, color: [i128; 3], weight: i64, luminance: i64) {
        self.color.iter_mut().zip(color).for_each(|(sum, c)| *sum = sum.wrapping_add(c));
        self.luminance = self.luminance.wrapping_add(luminance);
        self.squares = self.squares.wrapping_add(i128::from(luminance) * i128::from(luminance));
        self.weight = self.weight.wrapping_add(weight);
        self.samples += 1;
    }
}

/// Sums in 64 bits of up to [`MOST_SMALL`] samples of one pixel. The samples must have full
/// coverage, colours below [`SMALL_COLOR`] and weights of at most 1. Faster than [`Pixel::add`],
/// with identical results.
#[derive(Default)]
struct SmallSums {
    color: [i64; 3],
    squares: i128,
    luminance: i64,
    weight: i64,
    samples: u64,
}

impl SmallSums {
    /// Returns true if a sample is small enough for exact sums in 64 bits.
    #[inline(always)]
    fn fits(color: Color, weight: f32) -> bool {
        color.x.abs() + color.y.abs() + color.z.abs() < SMALL_COLOR && weight.abs() <= 1.0
    }

    #[inline(always)]
    fn add(&mut self, color: Color, weight: f32) {
        let rgb = color.to_array().map(f64::from);
        let weight = whole_number(f64::from(weight) * WEIGHT_SCALE);
        let scale = weight as f64 * (COLOR_SCALE / WEIGHT_SCALE);
        (0..3).for_each(|i| self.color[i] += whole_number(rgb[i] * scale));
        let luminance = whole_number(luminance(rgb) * LUMINANCE_SCALE);
        self.luminance += luminance;
        // The product is less than 2^62.
        self.squares += i128::from(luminance * luminance);
        self.weight += weight;
        self.samples += 1;
    }
}

/// Upper bound of |red| + |green| + |blue| for samples in [`SmallSums`]. With weights up to 1, the
/// products of colour and weight are less than 2^51 units.
const SMALL_COLOR: f32 = 8.0;

/// Maximum number of samples in [`SmallSums`] for which the sums of the products fit in 64 bits.
const MOST_SMALL: usize = 1 << 11;

const COLOR_SCALE: f64 = (1_u64 << 48) as f64;
const WEIGHT_SCALE: f64 = (1_u64 << 24) as f64;
/// Weight 1 in film units.
pub(super) const WEIGHT_ONE: i64 = WEIGHT_SCALE as i64;
const GREATEST_COLOR: f64 = (1_u64 << 44) as f64;
const GREATEST_WEIGHT: f64 = (1_u64 << 10) as f64;
const LUMINANCE_SCALE: f64 = (1_u64 << 28) as f64;
const GREATEST_LUMINANCE: f64 = (1_u64 << 14) as f64;

/// Position of a sample that was rejected because it is infinite or NaN. Positions are ordered by
/// row, then by column, then by sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Rejected {
    /// Row of the pixel, counted from the top.
    pub y: u32,
    /// Column of the pixel, counted from the left.
    pub x: u32,
    /// Index of the sample within its pixel.
    pub sample: u32,
}

/// Maximum number of rejected samples whose positions are stored.
const MAX_LISTED_REJECTED: usize = 16;

/// Error of a merge if the merged film is not inside the window of the target film.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("cannot merge a film of pixels outside this film's window")]
pub struct WrongWindow;

impl Film {
    /// Creates a black film for a full picture.
    pub fn new(width: u32, height: u32) -> Self {
        Film::window(0, 0, width, height)
    }

    /// Creates a black film for a rectangle of a picture. Pixel coordinates are relative to the
    /// full picture.
    pub fn window(left: u32, top: u32, width: u32, height: u32) -> Self {
        let pixels = vec![Pixel::default(); width as usize * height as usize];
        Film { left, top, width, height, pixels, rejected: 0, first_rejected: Vec::new() }
    }

    /// Returns the width and height of the window in pixels.
    pub fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// Adds a sample with a weight (magnitude up to 2^10) to a pixel. Panics if the pixel is
    /// outside the window.
    pub fn add(&mut self, x: u32, y: u32, sample: u32, color: Color, weight: f32) {
        self.add_optional(x, y, sample, Some(color), weight);
    }

    /// Adds a sample. If `color` is `None`, the sample is transparent and lowers the coverage of
    /// the pixel.
    pub fn add_optional(&mut self, x: u32, y: u32, sample: u32, color: Option<Color>, weight: f32) {
        self.add_with_coverage(x, y, sample, color.map_or((Color::ZERO, 0.0), |color| (color, 1.0)), weight);
    }

    /// Adds consecutive samples of one pixel with full coverage. `weights` contains one weight per
    /// colour.
    pub fn add_samples(&mut self, x: u32, y: u32, first: u32, colors: &[Color], weights: &[f32]) {
        let holds = |&(color, weight): &(&Color, &f32)| SmallSums::fits(*color, *weight);
        let small = colors.iter().zip(weights).take(MOST_SMALL).take_while(holds).count();
        // This loop calls no functions, so that the sums stay in registers.
        let mut sums = SmallSums::default();
        for (&color, &weight) in colors[..small].iter().zip(&weights[..small]) {
            sums.add(color, weight);
        }
        self.pixel_mut(x, y).add_small(&sums);
        // Usually, no samples are left for this loop.
        for i in small..colors.len() {
            self.add(x, y, first + i as u32, colors[i], weights[i]);
        }
    }

    /// Adds a sample that covers a share of the pixel, from 0 to 1.
    pub fn add_with_coverage(&mut self, x: u32, y: u32, sample: u32, (color, share): (Color, f32), weight: f32) {
        if !self.pixel_mut(x, y).add_any(color, share, weight) {
            self.reject(Rejected { y, x, sample });
        }
    }

    fn pixel_mut(&mut self, x: u32, y: u32) -> &mut Pixel {
        let index = self.index(x, y).expect("the pixel must be in the film's window");
        &mut self.pixels[index]
    }

    /// Counts a rejected sample and stores its position if it is one of the first in reading order.
    fn reject(&mut self, what: Rejected) {
        self.rejected += 1;
        let place = self.first_rejected.partition_point(|old| *old <= what);
        if place < MAX_LISTED_REJECTED {
            self.first_rejected.insert(place, what);
            self.first_rejected.truncate(MAX_LISTED_REJECTED);
        }
    }

    /// Adds the sums of a film whose window is inside the window of this film.
    pub fn merge(&mut self, other: &Film) -> Result<(), WrongWindow> {
        if other.pixels.is_empty() {
            return Ok(());
        }
        // The window is a rectangle, so checking two corners is sufficient.
        let (right, bottom) = (other.width - 1, other.height - 1);
        let far = other.left.checked_add(right).zip(other.top.checked_add(bottom));
        let far = far.and_then(|(x, y)| self.index(x, y));
        let first = self.index(other.left, other.top).zip(far).ok_or(WrongWindow)?.0;
        for (row, source) in other.pixels.chunks_exact(other.width as usize).enumerate() {
            let start = first + row * self.width as usize;
            for (to, from) in self.pixels[start..].iter_mut().zip(source) {
                // Sums from a file may overflow. Wrapping addition is still independent of the
                // order.
                to.color.iter_mut().zip(from.color).for_each(|(sum, c)| *sum = sum.wrapping_add(c));
                to.squares = to.squares.wrapping_add(from.squares);
                to.luminance = to.luminance.wrapping_add(from.luminance);
                to.weight = to.weight.wrapping_add(from.weight);
                to.covered = to.covered.wrapping_add(from.covered);
                to.samples = to.samples.wrapping_add(from.samples);
            }
        }
        // The film `other` stores its first sixteen rejected samples. Any that it did not store
        // come after these and are therefore not among the first sixteen of the union either.
        other.first_rejected.iter().for_each(|&r| self.reject(r));
        self.rejected = self.rejected.wrapping_add(other.rejected - other.first_rejected.len() as u64);
        Ok(())
    }

    /// Appends the sums and the rejected samples to `out`, but not the window. Equal films produce
    /// equal bytes.
    pub fn write(&self, out: &mut Vec<u8>) {
        for pixel in &self.pixels {
            write_unsigned(out, pixel.samples.into());
            write_signed(out, pixel.weight.into());
            // The difference is usually zero, which is stored in one byte.
            write_signed(out, i128::from(pixel.weight) - i128::from(pixel.covered));
            pixel.color.iter().for_each(|&sum| write_signed(out, sum));
            write_signed(out, pixel.luminance.into());
            write_signed(out, pixel.squares);
        }
        write_unsigned(out, self.rejected.into());
        write_unsigned(out, self.first_rejected.len() as u128);
        for Rejected { y, x, sample } in &self.first_rejected {
            [y, x, sample].into_iter().for_each(|&number| write_unsigned(out, number.into()));
        }
    }

    /// Reads bytes that [`Film::write`] wrote into an empty film with the same window. Returns
    /// `None` if the bytes are invalid or if `most_samples` samples per pixel could not produce
    /// these sums.
    pub fn read(mut self, bytes: &mut ByteReader, most_samples: u32) -> Option<Self> {
        for pixel in &mut self.pixels {
            pixel.samples = bytes.read_unsigned()?;
            pixel.weight = bytes.signed()?;
            pixel.covered = pixel.weight.checked_sub(bytes.signed()?)?;
            for sum in &mut pixel.color {
                *sum = bytes.signed()?;
            }
            pixel.luminance = bytes.signed()?;
            pixel.squares = bytes.signed()?;
            if !pixel.is_possible(most_samples) {
                return None;
            }
        }
        self.rejected = bytes.read_unsigned()?;
        let remembered: usize = bytes.read_unsigned()?;
        if remembered as u64 > self.rejected || remembered > MAX_LISTED_REJECTED {
            return None;
        }
        for _ in 0..remembered {
            let (y, x, sample) = (bytes.read_unsigned()?, bytes.read_unsigned()?, bytes.read_unsigned()?);
            self.first_rejected.push(Rejected { y, x, sample });
        }
        self.first_rejected.is_sorted().then_some(self)
    }

    /// Returns the weighted mean of a pixel's samples, counting transparent samples as black. The
    /// result is black if the sum of the weights is zero. Panics if the pixel is outside the
    /// window.
    pub fn resolve(&self, x: u32, y: u32) -> Color {
        self.pixel(x, y).mean()
    }

    /// Returns the coverage of a pixel from 0 to 1, which is the weighted share of its samples that
    /// are not transparent. Panics if the pixel is outside the window.
    pub fn coverage(&self, x: u32, y: u32) -> f32 {
        self.pixel(x, y).coverage()
    }

    /// Returns the estimated variance of a pixel's mean luminance, which is its expected squared
    /// error. The variance is infinite for fewer than two samples. Panics if the pixel is outside
    /// the window.
    ///
    /// For n samples y with mean m, the variance is sum (y - m)^2 / (n (n - 1)). It is multiplied
    /// by the square of `gain`, the magnitude of the sample weights when their mean is 1 (see
    /// [`super::FilterSampler::gain`]).
    pub fn variance(&self, x: u32, y: u32, gain: f32) -> f64 {
        let pixel = self.pixel(x, y);
        let n = pixel.samples as f64;
        if pixel.samples < 2 {
            return f64::INFINITY;
        }
        // Clamp the mean in the same way as the samples.
        let mean = luminance(self.resolve(x, y).to_array().map(f64::from));
        let mean = mean.clamp(-GREATEST_LUMINANCE, GREATEST_LUMINANCE);
        let sum = pixel.luminance as f64 / LUMINANCE_SCALE;
        let squares = pixel.squares as f64 / (LUMINANCE_SCALE * LUMINANCE_SCALE);
        // If all samples are equal, rounding can leave a small negative number here.
        let deviation = (squares - 2.0 * mean * sum + mean * mean * n).max(0.0);
        deviation / (n * (n - 1.0)) * f64::from(gain) * f64::from(gain)
    }

    /// Returns the number of samples of a pixel, not counting rejected samples. Panics if the pixel
    /// is outside the window.
    pub fn samples(&self, x: u32, y: u32) -> u64 {
        self.pixel(x, y).samples
    }

    /// Returns the number of samples that were rejected because they are infinite or NaN.
    pub fn rejected(&self) -> u64 {
        self.rejected
    }

    /// Returns the first sixteen rejected samples in reading order.
    pub fn first_rejected(&self) -> &[Rejected] {
        &self.first_rejected
    }

    fn pixel(&self, x: u32, y: u32) -> &Pixel {
        &self.pixels[self.index(x, y).expect("the pixel must be in the film's window")]
    }

    fn index(&self, x: u32, y: u32) -> Option<usize> {
        let (column, row) = (x.checked_sub(self.left)?, y.checked_sub(self.top)?);
        (column < self.width && row < self.height).then(|| row as usize * self.width as usize + column as usize)
    }
}

/// Rounds a sum to double precision. Almost all sums fit in 64 bits, which can be converted faster.
fn rounded(sum: i128) -> f64 {
    i64::try_from(sum).map_or_else(|_| sum as f64, |small| small as f64)
}

/// Returns the luminance of a double-precision linear RGB colour.
pub fn luminance([r, g, b]: [f64; 3]) -> f64 {
    LUMINANCE_F64[0] * r + LUMINANCE_F64[1] * g + LUMINANCE_F64[2] * b
}

/// Returns the luminance of a single-precision linear RGB colour.
pub fn luminance_of(color: Color) -> f64 {
    luminance(color.to_array().map(f64::from))
}

/// Rounds a number with a magnitude below 2^51 to the nearest integer, with ties to even.
///
/// Adding 3 * 2^51 rounds the number, because the sum has no bits below 1. Subtracting the bit
/// pattern of 3 * 2^51 then gives the integer. The baseline instruction sets have no instruction
/// for rounding.
fn whole_number(x: f64) -> i64 {
    const MAGIC: f64 = 3.0 * (1_u64 << 51) as f64;
    debug_assert!(x.abs() < (1_u64 << 51) as f64);
    ((x + MAGIC).to_bits() as i64).wrapping_sub(MAGIC.to_bits() as i64)
}
