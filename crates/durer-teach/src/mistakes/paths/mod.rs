//! Mistakes of path tracers. The module contains a simple path tracer that makes them and a search
//! for the mistake that explains a picture.
//!
//! Path-traced pictures are noisy, so their pixels are not compared directly. The search compares
//! means over blocks because their variance is known.

mod blocks;
mod pooled;
mod search;
mod table;
#[cfg(test)]
mod tests;
mod walker;

pub use search::{diagnose, off};
