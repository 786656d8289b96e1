//! Mistakes of path tracers: a plain tracer that makes them, and the search for the one that made a
//! picture.
//!
//! Pictures of paths have noise, so nothing is compared pixel by pixel: means over blocks are
//! judged against their own variance.

mod blocks;
mod search;
mod table;
mod walker;

pub use search::{diagnose, off};
