//! Mistakes of path tracers: a simple path tracer that makes them, and a search for the mistake
//! that explains a picture.
//!
//! Path-traced pictures are noisy, so pixels are not compared directly. The search compares means
//! over blocks, whose variance is known.

mod blocks;
mod search;
mod table;
mod walker;

pub use search::{diagnose, off};
