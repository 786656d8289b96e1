//! The sub-pixels of Fall 2012, assignment 5: three by three to a pixel, moved at random, blurred,
//! averaged.

use super::{Crop, Job, raster};
use crate::film::course::{average_3x3, blur, jittered_position};
use crate::world::World;
use durer_scene::camera::Raster;
use durer_scene::math::{Color, Vec2};
use serde::Serialize;

/// The sub-pixels that a part of a picture is made of.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SubPixels {
    /// Whether there are three by three to a pixel; else a pixel is its own only one.
    pub jitter: bool,
    /// Whether they are blurred.
    pub blurred: bool,
    /// Those in the part itself.
    pub inner: Crop,
    /// Those that count for it.
    pub around: Crop,
    /// Those of the whole picture.
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

    /// The sub-pixels on the square that a world's camera covers.
    pub(super) fn raster(&self, world: &World) -> Raster {
        raster(world, self.whole.width, self.whole.height)
    }

    /// How many there are across a pixel.
    pub(super) fn scale(&self) -> u32 {
        if self.jitter { 3 } else { 1 }
    }

    /// The pixel of one of them.
    pub(super) fn pixel(&self, (x, y): (u32, u32)) -> (u32, u32) {
        (x / self.scale(), y / self.scale())
    }

    /// The number of a sub-pixel in its pixel.
    pub(super) fn number(&self, (x, y): (u32, u32)) -> u32 {
        y % self.scale() * self.scale() + x % self.scale()
    }

    /// Where the ray of one goes, in sub-pixels from the upper left corner of the picture.
    pub(super) fn place(&self, seed: u64, (x, y): (u32, u32)) -> Vec2 {
        let corner = if self.jitter { jittered_position(seed, x, y) } else { Vec2::new(x as f32, y as f32) };
        corner + 0.5
    }

    /// The pixels of the part, from the colours of all sub-pixels that count for it, in reading
    /// order.
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
