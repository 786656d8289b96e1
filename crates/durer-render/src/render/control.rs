//! Execution options and progress counters of a render.

use super::RenderError;
use std::sync::atomic::{AtomicBool, AtomicU64};
use std::time::Duration;

/// Options, cancellation and progress of a render. They do not affect the finished picture.
#[derive(Debug, Default)]
pub struct Control {
    /// Number of threads, or `None` for one thread per processor.
    pub threads: Option<usize>,
    /// Width and height of a tile in pixels, rounded up to a multiple of 8, or `None` to choose it
    /// automatically. Each thread works on one tile at a time.
    pub tile_size: Option<u32>,
    /// Time after which no more samples are taken, provided that every pixel has at least one.
    pub time_limit: Option<Duration>,
    /// Number of tiles after which the render stops as if it had been cancelled. This is used to
    /// test that a render can be resumed.
    pub max_tiles: Option<u64>,
    /// Time between two requests to the callback to save a checkpoint.
    pub save_every: Option<Duration>,
    /// Memory limit in bytes, or `None` for no limit.
    pub memory: Option<u64>,
    /// True once the caller has cancelled the render.
    pub cancel: AtomicBool,
    /// Total number of samples and centre rays in the render. See [`super::PartialRender::work`].
    pub total_work: AtomicU64,
    /// Number of samples and centre rays that are finished.
    pub done_work: AtomicU64,
    /// Number of rays traced so far.
    pub rays: AtomicU64,
    /// True if `total_work` is the total of several renders. The finished work of all these renders
    /// is then added up in `done_work`.
    pub accumulates: bool,
}

impl Control {
    /// Checks that a number of bytes is within the memory limit.
    ///
    /// # Errors
    /// Returns [`RenderError::Memory`] if it is not.
    pub fn check_memory(&self, needed: u64) -> Result<(), RenderError> {
        match self.memory {
            Some(allowed) if needed > allowed => Err(RenderError::Memory { needed, allowed }),
            _ => Ok(()),
        }
    }
}

/// Point at which a call of [`super::PartialRender::render_to`] stops.
#[derive(Clone, Copy, Debug)]
pub(super) enum RunLimit {
    /// Stops when all work is done.
    End,
    /// Stops when all passes with at most this many samples per pixel are done.
    Samples(u32),
    /// Stops after the single pass that ends with this many samples per pixel.
    Pass(u32),
}
