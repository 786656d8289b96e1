//! Samples of two pictures, from which mistakes are detected.

use crate::compare::picture::{Pair, Scale};
use durer_bvh::math::Vec3;

/// Maximum number of pixels that are sampled.
const MOST: usize = 100_000;

/// Borrowed pixels of a picture with its size and scale, used to detect mistakes.
#[derive(Clone, Copy)]
pub struct View<'p> {
    pub width: usize,
    pub height: usize,
    pub scale: Scale,
    pub pixels: &'p [Vec3],
}

impl<'p> View<'p> {
    pub fn of(pair: &Pair, pixels: &'p [Vec3]) -> View<'p> {
        View { width: pair.width, height: pair.height, scale: pair.scale, pixels }
    }

    /// Returns the pixel at a position, which is clamped to the edges of the picture.
    pub fn at(&self, x: isize, y: isize) -> Vec3 {
        let (x, y) = (x.clamp(0, self.width as isize - 1), y.clamp(0, self.height as isize - 1));
        self.pixels[y as usize * self.width + x as usize]
    }

    /// Returns the mean of a pixel and its eight neighbours, with weights of 1, 2, and 1 along each
    /// axis.
    pub fn blurred(&self, x: isize, y: isize) -> Vec3 {
        let row = |y| self.at(x - 1, y) + 2.0 * self.at(x, y) + self.at(x + 1, y);
        (row(y - 1) + 2.0 * row(y) + row(y + 1)) / 16.0
    }
}

/// Position of a pixel, with its values in the reference and in the other picture.
#[derive(Clone, Copy)]
pub struct Sample {
    pub x: isize,
    pub y: isize,
    pub reference: Vec3,
    pub test: Vec3,
}

/// Samples all pixels or, in large pictures, an evenly distributed subset without a regular
/// pattern.
pub fn samples(reference: &View, test: &View) -> Vec<Sample> {
    let pixels = reference.pixels.len();
    let count = pixels.min(MOST);
    let place = |i: usize| {
        // Choose one pixel from each of `count` equal intervals; its offset comes from multiples of
        // the golden ratio.
        let part = if pixels > MOST { (i as f64 * 0.618_033_988_749_895).fract() } else { 0.0 };
        (((i as f64 + part) * pixels as f64 / count as f64) as usize).min(pixels - 1)
    };
    let sample = |index: usize| Sample {
        x: (index % reference.width) as isize,
        y: (index / reference.width) as isize,
        reference: reference.pixels[index],
        test: test.pixels[index],
    };
    (0..count).map(|i| sample(place(i))).collect()
}
