//! The sub-pixels of Fall 2012, assignment 5: 3 x 3 jittered sub-pixels, blurred and averaged.

use super::{Crop, Job, raster};
use crate::film::course::{average_3x3, blur, jittered_position};
use crate::world::World;
use durer_scene::camera::Raster;
use durer_scene::math::{Color, Vec2};
use serde::Serialize;

/// The sub-pixels of a part of a picture.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SubPixels {
    /// True for 3 x 3 sub-pixels a pixel, false for one.
    pub jitter: bool,
    /// True if they are blurred.
    pub blurred: bool,
    /// Sub-pixels inside the part.
    pub inner: Crop,
    /// Sub-pixels that affect it.
    pub around: Crop,
    /// Sub-pixels of the whole picture.
    pub whole: Crop,
}

impl SubPixels {
    pub(super) fn new(job: &Job, part: Crop, jitter: bool, blurred: bool) -> Self {
        let scale = if jitter { 3 } else { 1 };
        let scaled = |crop: Crop| Crop {
            left: crop.left * scale,
            top: crop.top * scale,
            width: crop.width * scale,
            height: crop.height * scale,
        };
        let (inner, whole) = (scaled(part), scaled(job.whole()));
        let around = inner.grown(if blurred { 2 } else { 0 }, whole);
        SubPixels { jitter, blurred, inner, around, whole }
    }

    /// Returns the raster of the sub-pixels in the camera's square.
    pub(super) fn raster(&self, world: &World) -> Raster {
        raster(world, self.whole.width, self.whole.height)
    }

    /// Returns the number of sub-pixels across a pixel.
    pub(super) fn scale(&self) -> u32 {
        if self.jitter { 3 } else { 1 }
    }

    /// Returns the pixel of a sub-pixel.
    pub(super) fn pixel(&self, (x, y): (u32, u32)) -> (u32, u32) {
        (x / self.scale(), y / self.scale())
    }

    /// Returns the index of a sub-pixel in its pixel.
    pub(super) fn number(&self, (x, y): (u32, u32)) -> u32 {
        y % self.scale() * self.scale() + x % self.scale()
    }

    /// Returns the position of a sub-pixel's ray, in sub-pixels from the upper left corner of the
    /// picture.
    pub(super) fn place(&self, seed: u64, (x, y): (u32, u32)) -> Vec2 {
        let corner = if self.jitter { jittered_position(seed, x, y) } else { Vec2::new(x as f32, y as f32) };
        corner + 0.5
    }

    /// Returns the pixels of the part in reading order, from the colours of all sub-pixels that
    /// affect it.
    pub(super) fn develop(&self, mut colors: Vec<Color>) -> Vec<Color> {
        let (inner, around) = (self.inner, self.around);
        if self.blurred {
            colors = blur(&colors, around.width, around.height);
        }
        let index = |(x, y)| ((y - around.top) * around.width + (x - around.left)) as usize;
        let colors: Vec<Color> = inner.places().map(|place| colors[index(place)]).collect();
        if self.jitter { average_3x3(&colors, inner.width, inner.height) } else { colors }
    }
}
