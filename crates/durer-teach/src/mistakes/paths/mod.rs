//! Mistakes of path tracers: a plain tracer that makes them, and a search for the mistake that
//! explains a picture.
//!
//! Path-traced pictures have noise, so pixels are not compared: means over blocks are compared with
//! their own variance.

mod blocks;
mod search;
mod table;
mod walker;

pub use search::{diagnose, off};
