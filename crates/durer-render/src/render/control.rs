//! Execution options of a render.

use std::sync::atomic::{AtomicBool, AtomicU64};
use std::time::Duration;

/// Execution options and progress. They do not change a finished picture.
#[derive(Debug, Default)]
pub struct Control {
    /// Number of threads; `None`: one per processor.
    pub threads: Option<usize>,
    /// Side length of a tile in pixels, rounded up to a multiple of 8; each thread works on one
    /// tile at a time. `None`: automatic.
    pub tile: Option<u32>,
    /// Time limit after which no more samples are taken, once every pixel has one.
    pub time: Option<Duration>,
    /// Number of tiles after which the render stops as if cancelled, for tests of resuming.
    pub most_tiles: Option<u64>,
    /// Interval at which the callback is asked to save.
    pub save_every: Option<Duration>,
    /// Memory limit in bytes; `None`: unlimited.
    pub memory: Option<u64>,
    /// Set by the caller to cancel.
    pub cancel: AtomicBool,
    /// Total number of samples and data rays; see [`super::PartialRender::work`].
    pub all: AtomicU64,
    /// Number of finished samples and data rays.
    pub done: AtomicU64,
    /// Number of rays traced so far.
    pub rays: AtomicU64,
    /// True if `all` covers several renders, which all count in `done`.
    pub goes_on: bool,
}

/// End of a run.
#[derive(Clone, Copy, Debug)]
pub(super) enum RunLimit {
    /// Until everything is done.
    End,
    /// Until all passes with at most this many samples per pixel are done.
    Samples(u32),
    /// After the single pass that ends with this many samples per pixel.
    Pass(u32),
}
