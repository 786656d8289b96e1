//! Exact sums: samples are added as integers, so the order of adding and merging changes nothing.

use crate::math::{Color, Vec3};

#[cfg(test)]
mod tests;

/// A window of a picture that adds up weighted samples, each pixel for itself.
///
/// A weight is rounded once to a multiple of 2^-24, the product of colour and weight once to a multiple of 2^-48 (ties to even).
/// From then on everything is integer addition. Colours up to 2^44 and weights up to 2^10 are kept: there is room in a pixel
/// for 2^25 samples of the greatest colour and weight, and for 2^35 of the greatest colour at weight 1.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Film {
    left: u32,
    top: u32,
    width: u32,
    height: u32,
    pixels: Vec<Pixel>,
    rejected: u64,
    first_rejected: Vec<Rejected>,
}

/// Sums of one pixel: 80 bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Pixel {
    /// Weighted colour, in units of 2^-48.
    color: [i128; 3],
    /// Weight, in units of 2^-24.
    weight: i64,
    /// The part of that weight whose samples saw something, in the same units.
    covered: i64,
    samples: u64,
}

const COLOR_SCALE: f64 = (1_u64 << 48) as f64;
const WEIGHT_SCALE: f64 = (1_u64 << 24) as f64;
const GREATEST_COLOR: f64 = (1_u64 << 44) as f64;
const GREATEST_WEIGHT: f64 = (1_u64 << 10) as f64;

/// A sample that was left out because it is infinite, not a number or beyond the film's range. Ordered by row, column, sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Rejected {
    /// Row from the top.
    pub y: u32,
    /// Column from the left.
    pub x: u32,
    /// Number of the sample in its pixel.
    pub sample: u32,
}

/// How many rejected samples are remembered.
const REMEMBERED: usize = 16;

/// The window of the film to merge does not lie in that of the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a film of other pixels cannot be merged into this one")]
pub struct WrongWindow;

impl Film {
    /// A black film of a whole picture.
    pub fn new(width: u32, height: u32) -> Self {
        Film::window(0, 0, width, height)
    }

    /// A black film of a part of a picture. Pixels keep their places in the whole.
    pub fn window(left: u32, top: u32, width: u32, height: u32) -> Self {
        let pixels = vec![Pixel::default(); width as usize * height as usize];
        Film { left, top, width, height, pixels, rejected: 0, first_rejected: Vec::new() }
    }

    /// Columns and rows.
    pub fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// Adds a sample of some weight (up to 2^10 in size) to a pixel. Panics outside the window.
    pub fn add(&mut self, x: u32, y: u32, sample: u32, color: Color, weight: f32) {
        self.add_if_seen(x, y, sample, Some(color), weight);
    }

    /// The same for a sample at which the camera may see nothing: it leaves the pixel transparent by its weight.
    pub fn add_if_seen(&mut self, x: u32, y: u32, sample: u32, color: Option<Color>, weight: f32) {
        let index = self.index(x, y).expect("the pixel lies in the film's window");
        let weight = f64::from(weight) * WEIGHT_SCALE;
        // At most 24 significant bits are left of the weight, so each product below is exact before its rounding.
        let (whole, rgb) = (weight.round_ties_even(), color.unwrap_or(Vec3::ZERO).to_array().map(f64::from));
        if !(whole.abs() <= GREATEST_WEIGHT * WEIGHT_SCALE && rgb.iter().all(|c| c.abs() <= GREATEST_COLOR)) {
            return self.reject(Rejected { y, x, sample });
        }
        let pixel = &mut self.pixels[index];
        for (sum, c) in pixel.color.iter_mut().zip(rgb) {
            *sum += (c * (whole / WEIGHT_SCALE) * COLOR_SCALE).round_ties_even() as i128;
        }
        pixel.weight += whole as i64;
        pixel.covered += if color.is_some() { whole as i64 } else { 0 };
        pixel.samples += 1;
    }

    /// Counts a sample as left out; the first few in reading order are remembered.
    fn reject(&mut self, what: Rejected) {
        self.rejected += 1;
        let place = self.first_rejected.partition_point(|old| *old <= what);
        if place < REMEMBERED {
            self.first_rejected.insert(place, what);
            self.first_rejected.truncate(REMEMBERED);
        }
    }

    /// Adds everything that a film of the same pixels or some of them holds.
    pub fn merge(&mut self, other: &Film) -> Result<(), WrongWindow> {
        if other.pixels.is_empty() {
            return Ok(());
        }
        // Where both corners lie inside, all between does.
        let (right, bottom) = (other.width - 1, other.height - 1);
        let far = other.left.checked_add(right).zip(other.top.checked_add(bottom));
        let far = far.and_then(|(x, y)| self.index(x, y));
        let first = self.index(other.left, other.top).zip(far).ok_or(WrongWindow)?.0;
        for (row, source) in other.pixels.chunks_exact(other.width as usize).enumerate() {
            let start = first + row * self.width as usize;
            for (to, from) in self.pixels[start..].iter_mut().zip(source) {
                to.color.iter_mut().zip(from.color).for_each(|(sum, c)| *sum += c);
                to.weight += from.weight;
                to.covered += from.covered;
                to.samples += from.samples;
            }
        }
        // Those not remembered come after sixteen others, and so they do in the union.
        other.first_rejected.iter().for_each(|&r| self.reject(r));
        self.rejected += other.rejected - other.first_rejected.len() as u64;
        Ok(())
    }

    /// Weighted mean of a pixel's samples, those that saw nothing taken for black; black where the weights sum to nothing.
    /// Panics outside the window.
    pub fn resolve(&self, x: u32, y: u32) -> Color {
        let pixel = self.pixel(x, y);
        if pixel.weight == 0 {
            return Vec3::ZERO;
        }
        // Each sum is rounded to double precision, then divided: two roundings, and one to single.
        let weight = pixel.weight as f64 / WEIGHT_SCALE;
        Vec3::from(pixel.color.map(|sum| (sum as f64 / COLOR_SCALE / weight) as f32))
    }

    /// The share of a pixel's samples that saw something, by weight, from 0 to 1. Panics outside the window.
    pub fn coverage(&self, x: u32, y: u32) -> f32 {
        let pixel = self.pixel(x, y);
        // Also where the weights sum to nothing: there all is seen that was looked for.
        if pixel.covered == pixel.weight {
            return 1.0;
        }
        // Filters with negative weights may leave the range; where the weights sum to 0 the quotient is infinite.
        (pixel.covered as f64 / pixel.weight as f64).clamp(0.0, 1.0) as f32
    }

    /// How many samples a pixel holds, without those left out. Panics outside the window.
    pub fn samples(&self, x: u32, y: u32) -> u64 {
        self.pixel(x, y).samples
    }

    /// How many samples were left out.
    pub fn rejected(&self) -> u64 {
        self.rejected
    }

    /// The first sixteen of the samples left out, whatever the order they came in.
    pub fn first_rejected(&self) -> &[Rejected] {
        &self.first_rejected
    }

    fn pixel(&self, x: u32, y: u32) -> &Pixel {
        &self.pixels[self.index(x, y).expect("the pixel lies in the film's window")]
    }

    fn index(&self, x: u32, y: u32) -> Option<usize> {
        let (column, row) = (x.checked_sub(self.left)?, y.checked_sub(self.top)?);
        (column < self.width && row < self.height).then(|| row as usize * self.width as usize + column as usize)
    }
}
