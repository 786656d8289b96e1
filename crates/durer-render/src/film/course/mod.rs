//! Films, filters and diagrams of the course's assignments, kept as they are.
//!
//! They are plain functions of samples and pixels. A job names them, and asks no dialect.

pub mod diagram;
mod jitter;
mod stored;

pub use jitter::{average_3x3, blur, blur_and_average, jittered_position};
pub use stored::{CourseFilter, StoredSample, StoredSamples};
