//! From samples to pixels: reconstruction filters and exact sums.
//!
//! Pixels are counted from the top left corner; a position in a pixel runs right and down.

pub mod aov;
pub mod bytes;
pub mod course;
pub mod false_color;
#[expect(clippy::module_inception, reason = "the film is what this room is about")]
mod film;
mod filter;
mod packed;

pub use film::{Film, Rejected, WrongWindow, luminance, luminance_of};
pub use filter::{Filter, FilterSampler};
pub use packed::Packed;
