//! Execution options and progress counters of a render.

use std::sync::atomic::{AtomicBool, AtomicU64};
use std::time::Duration;

/// Execution options, cancellation and progress of a render. They do not affect the finished
/// picture.
#[derive(Debug, Default)]
pub struct Control {
    /// Number of threads; `None` for one per processor.
    pub threads: Option<usize>,
    /// Width and height of a tile in pixels, rounded up to a multiple of 8. Each thread works on
    /// one tile at a time. `None` for automatic.
    pub tile_size: Option<u32>,
    /// Time after which no more samples are taken, provided that every pixel has one.
    pub time_limit: Option<Duration>,
    /// Number of tiles after which the render stops as if cancelled. For tests of resuming.
    pub max_tiles: Option<u64>,
    /// Interval at which the callback is asked to save a checkpoint.
    pub save_every: Option<Duration>,
    /// Memory limit in bytes; `None` for no limit.
    pub memory: Option<u64>,
    /// Set by the caller to cancel the render.
    pub cancel: AtomicBool,
    /// Total number of samples and data rays in the render; see [`super::PartialRender::work`].
    pub total_work: AtomicU64,
    /// Number of finished samples and data rays.
    pub done_work: AtomicU64,
    /// Number of rays traced so far.
    pub rays: AtomicU64,
    /// True if `total_work` is the total for several renders, whose work accumulates in
    /// `done_work`.
    pub accumulates: bool,
}

/// Point at which a call of [`super::PartialRender::render_to`] stops.
#[derive(Clone, Copy, Debug)]
pub(super) enum RunLimit {
    /// When everything is done.
    End,
    /// When all passes with at most this many samples per pixel are done.
    Samples(u32),
    /// After the single pass that ends with this many samples per pixel.
    Pass(u32),
}
