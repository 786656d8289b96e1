//! Films, samplings and diagrams of the course's assignments, kept as they are.
//!
//! They stand in this crate because a [`Job`](super::Job) is plain data that a saved part names:
//! whoever reads a part must know its [`Sampling`](super::Sampling). No dialect is asked here: which
//! of them apply is a value of the job or of the world's rules.

pub mod diagram;
pub(super) mod explain;
mod film;
mod jitter;
pub(super) mod sampling;
pub(super) mod stale;
mod sub_pixels;

pub use film::{CourseFilter, StoredSample, StoredSamples};
pub use jitter::{average_3x3, blur, blur_and_average, jittered_position};
pub use sampling::sample_diagram;
pub use sub_pixels::SubPixels;
