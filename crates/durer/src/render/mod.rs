//! From a world and a job to pictures.

pub mod explain;
mod grid;
mod job;
mod run;

pub use grid::grid_picture;
pub use job::{Control, Crop, Job, Sampling};
pub use run::{RenderError, Rendered, camera_ray, center_ray, raster, render, sample_diagram};
