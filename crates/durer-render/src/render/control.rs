//! What only decides when and with how much a picture is made.

use std::sync::atomic::{AtomicBool, AtomicU64};
use std::time::Duration;

/// How a picture is made: nothing in here changes a bit of a finished one.
#[derive(Debug, Default)]
pub struct Control {
    /// Threads; `None`: as many as the machine has.
    pub threads: Option<usize>,
    /// Pixels across and down a tile, the work that a thread takes at once; rounded up to a
    /// multiple of 8. `None`: a suitable number.
    pub tile: Option<u32>,
    /// After this time no more samples are taken, once every pixel has one.
    pub time: Option<Duration>,
    /// After so many tiles no more work is done, as if it were cancelled: for callers that do other work
    /// in between.
    pub most_tiles: Option<u64>,
    /// How often the watcher is told that it is time to save.
    pub save_every: Option<Duration>,
    /// Bytes that may be taken; `None`: any number.
    pub memory: Option<u64>,
    /// Set by the caller to stop.
    pub cancel: AtomicBool,
    /// All samples and rays for data that are to be done; see [`super::PartialRender::work`].
    pub all: AtomicU64,
    /// How many of them are done.
    pub done: AtomicU64,
    /// Rays traced so far.
    pub rays: AtomicU64,
    /// Whether `all` is that of several renders, which count on with `done`.
    pub goes_on: bool,
}

/// Until when work goes on.
#[derive(Clone, Copy, Debug)]
pub(super) enum Until {
    /// All is done.
    End,
    /// All passes are done that end with so many samples a pixel, or fewer.
    Samples(u32),
    /// A single pass is done that ends with so many samples a pixel.
    Pass(u32),
}
