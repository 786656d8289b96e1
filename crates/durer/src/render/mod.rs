//! From a world and a job to pictures.

mod job;
mod run;

pub use job::{Control, Crop, Job, Sampling};
pub use run::{RenderError, Rendered, camera_ray, render, sample_diagram};
