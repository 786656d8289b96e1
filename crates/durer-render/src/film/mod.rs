//! Accumulation of samples in pixels. This includes films with exact sums, reconstruction filters
//! and AOVs.
//!
//! Pixel coordinates start at the top left corner. x increases to the right, and y increases
//! downwards.

pub mod aov;
pub mod bytes;
pub mod course;
pub mod false_color;
#[expect(clippy::module_inception, reason = "the module is about the film")]
mod film;
mod filter;
mod packed;

pub use film::{Film, Rejected, WrongWindow, luminance, luminance_of};
pub use filter::{Filter, FilterSampler};
pub use packed::PackedFilm;
