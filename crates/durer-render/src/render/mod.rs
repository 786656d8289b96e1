//! Rendering of a world into the pictures that a job describes.

mod adaptive;
mod aim;
mod allocation;
#[cfg(test)]
mod backdrop_tests;
mod bands;
mod blocks;
mod camera_rays;
mod center_rays;
mod confidence;
mod control;
mod course;
mod crop;
mod denoised;
mod error;
pub mod explain;
mod grid;
#[cfg(test)]
mod invalid_tests;
mod job;
mod merge;
mod part;
pub mod passes;
mod pictures;
mod profile;
mod progressive;
mod replay;
mod run;
mod samples;
mod saved;
mod stale;
mod sub_pixels;
#[cfg(test)]
mod tests;
pub mod verify;

pub use allocation::MIN_ADAPTIVE_SAMPLES;
pub use bands::{BandedRender, BandsError};
pub use blocks::{BLOCK, Blocks, Shard, ShardBy};
pub use camera_rays::{camera_ray, center_ray, raster};
pub use confidence::{CONFIDENCE, ErrorBound};
pub use control::Control;
pub use course::sample_diagram;
pub use crop::PixelRect;
pub use denoised::NoisyPicture;
pub use error::{Panicked, RenderError};
pub use grid::grid_picture;
pub use job::{Backdrop, Job, Sampling};
pub use merge::{MergeError, merge};
pub use part::{PartialRender, Statistics};
pub use pictures::Rendered;
pub use profile::{Profile, profile};
pub use progressive::{Progress, ProgressiveRender};
pub use replay::replay;
pub use run::{CameraRay, RayDevice, RenderEvent, RenderOutcome, TracedRay, render};
pub use samples::sample_places;
pub use saved::PartError;
