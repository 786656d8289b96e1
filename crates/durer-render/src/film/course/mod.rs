//! Films, filters and diagrams of the course's assignments, unchanged.
//!
//! They are plain functions of samples and pixels. A job selects them, and they do not depend on
//! the dialect.

pub mod diagram;
mod jitter;
mod stored;

pub use jitter::{average_3x3, blur, blur_and_average, jittered_position};
pub use stored::{CourseFilter, StoredSample, StoredSamples};
