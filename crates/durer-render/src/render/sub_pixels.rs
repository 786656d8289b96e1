//! Sub-pixels for assignment 5 of the Fall 2012 course. Each pixel has 3 x 3 sub-pixels, which are
//! jittered, blurred and averaged.

use super::{Job, PixelRect, raster};
use crate::film::course::{average_3x3, blur, jittered_position};
use crate::world::World;
use durer_scene::camera::Raster;
use durer_scene::math::{Color, Vec2};
use serde::Serialize;

/// Sub-pixels that are needed to render a rectangle of a picture, as in assignment 5 of Fall 2012.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SubPixels {
    /// True for 3 x 3 sub-pixels per pixel, false for one sub-pixel per pixel.
    pub jitter: bool,
    /// True if the sub-pixels are blurred.
    pub blurred: bool,
    /// Sub-pixels inside the rectangle.
    pub inner: PixelRect,
    /// Sub-pixels that affect the pixels of the rectangle.
    pub around: PixelRect,
    /// Sub-pixels of the full picture.
    pub whole: PixelRect,
}

impl SubPixels {
    pub(super) fn new(job: &Job, part: PixelRect, jitter: bool, blurred: bool) -> Self {
        let scale = if jitter { 3 } else { 1 };
        let scaled = |crop: PixelRect| PixelRect {
            left: crop.left * scale,
            top: crop.top * scale,
            width: crop.width * scale,
            height: crop.height * scale,
        };
        let (inner, whole) = (scaled(part), scaled(job.whole()));
        let around = inner.grown(if blurred { 2 } else { 0 }, whole);
        SubPixels { jitter, blurred, inner, around, whole }
    }

    /// Returns the mapping from sub-pixel positions to the camera's coordinates.
    pub(super) fn raster(&self, world: &World) -> Raster {
        raster(world, self.whole.width, self.whole.height)
    }

    /// Returns the number of sub-pixels along each side of a pixel, which is 1 or 3.
    pub(super) fn scale(&self) -> u32 {
        if self.jitter { 3 } else { 1 }
    }

    /// Returns the pixel that contains a sub-pixel.
    pub(super) fn pixel(&self, (x, y): (u32, u32)) -> (u32, u32) {
        (x / self.scale(), y / self.scale())
    }

    /// Returns the index of a sub-pixel within its pixel.
    pub(super) fn number(&self, (x, y): (u32, u32)) -> u32 {
        y % self.scale() * self.scale() + x % self.scale()
    }

    /// Returns the position of a sub-pixel's ray in the picture, in sub-pixels from the upper left
    /// corner.
    pub(super) fn place(&self, seed: u64, (x, y): (u32, u32)) -> Vec2 {
        let corner = if self.jitter { jittered_position(seed, x, y) } else { Vec2::new(x as f32, y as f32) };
        corner + 0.5
    }

    /// Blurs and averages the colours of all sub-pixels in `around`. Returns the pixels of the
    /// rectangle in reading order.
    pub(super) fn blurred_mean(&self, mut colors: Vec<Color>) -> Vec<Color> {
        let (inner, around) = (self.inner, self.around);
        if self.blurred {
            colors = blur(&colors, around.width, around.height);
        }
        let index = |(x, y)| ((y - around.top) * around.width + (x - around.left)) as usize;
        let colors: Vec<Color> = inner.pixel_positions().map(|place| colors[index(place)]).collect();
        if self.jitter { average_3x3(&colors, inner.width, inner.height) } else { colors }
    }
}
