//! Films, filters and diagrams that reproduce the course's assignments exactly.
//!
//! These modules are plain functions of samples and pixels. The render job selects them,
//! independently of the dialect.

pub mod diagram;
mod jitter;
mod stored;

pub use jitter::{average_3x3, blur, blur_and_average, jittered_position};
pub use stored::{CourseFilter, StoredSample, StoredSamples};
