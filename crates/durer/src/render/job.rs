//! What decides a picture, and what only decides when it is made.

use crate::film::Filter;
use crate::film::aov::Aov;
use crate::film::course::CourseFilter;
use crate::integrator::Settings;
use crate::sampler::Sampler;
use std::sync::atomic::{AtomicBool, AtomicU64};

/// Part of a picture, in pixels from its upper left corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crop {
    /// First column.
    pub left: u32,
    /// First row.
    pub top: u32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

/// Where in a pixel rays go, and how they become a colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sampling {
    /// One ray through each pixel's centre.
    Center,
    /// Sobol points, spread by the filter: no sample counts for another pixel.
    Filtered {
        /// Samples a pixel.
        samples: u32,
        /// Reconstruction filter.
        filter: Filter,
    },
    /// Fall 2004: samples are kept, and weighted by their offset from the pixel's centre.
    Course2004 {
        /// Where samples lie.
        sampler: Sampler,
        /// Samples a pixel.
        samples: u32,
        /// How they are weighted; without, a pixel is the mean of its own.
        filter: Option<CourseFilter>,
    },
    /// Fall 2012: three by three sub-pixels, moved at random, blurred by five taps.
    Course2012 {
        /// Whether there are sub-pixels.
        jitter: bool,
        /// Whether the picture is blurred.
        blur: bool,
    },
}

/// What the picture is. Plain data: nothing in here depends on the machine.
#[derive(Clone, Debug)]
pub struct Job {
    /// Columns of the whole picture.
    pub width: u32,
    /// Rows of the whole picture.
    pub height: u32,
    /// The part that is made; `None`: all.
    pub crop: Option<Crop>,
    /// Decides the random numbers.
    pub seed: u64,
    /// Rays of the colour picture.
    pub sampling: Sampling,
    /// What light does.
    pub settings: Settings,
    /// Whether colour is wanted.
    pub color: bool,
    /// Which other pictures are wanted.
    pub aovs: Vec<&'static Aov>,
    /// Depths shown as black and white; `None`: least and greatest of the picture.
    pub depth_range: Option<(f32, f32)>,
}

impl Job {
    /// The part that is made.
    pub fn window(&self) -> Crop {
        self.crop.unwrap_or(Crop { left: 0, top: 0, width: self.width, height: self.height })
    }

    /// Pixels that will be counted in [`Control::done`].
    pub fn work(&self) -> u64 {
        let window = self.window();
        let pixels = u64::from(window.width) * u64::from(window.height);
        let whole = u64::from(self.width) * u64::from(self.height);
        let color = match self.sampling {
            Sampling::Center | Sampling::Filtered { .. } => pixels,
            Sampling::Course2004 { .. } => whole,
            Sampling::Course2012 { jitter, .. } => whole * if jitter { 9 } else { 1 },
        };
        (if self.color { color } else { 0 }) + if self.aovs.is_empty() { 0 } else { pixels }
    }
}

/// How a picture is made: nothing in here changes a bit of it.
#[derive(Debug, Default)]
pub struct Control {
    /// Threads; `None`: as many as the machine has.
    pub threads: Option<usize>,
    /// Set by the caller to stop.
    pub cancel: AtomicBool,
    /// Pixels done so far; see [`Job::work`].
    pub done: AtomicU64,
    /// Rays traced so far.
    pub rays: AtomicU64,
}
