//! Errors that occur during rendering.

use durer_diag::{format_bytes_down, format_bytes_up};
use durer_image::ImageError;
use durer_scene::math::Vec2;

/// Maximum number of samples that are stored at the same time for a diagram.
pub(super) const MAX_STORED: u64 = 1 << 27;

/// Error while rendering a picture or a part of it.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// The caller set [`super::Control::cancel`].
    #[error("cancelled")]
    Cancelled,
    /// The picture is too large, or the crop rectangle is outside the picture.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// A value of the job is out of range.
    #[error("{0}")]
    Job(String),
    /// The crop rectangle is outside the picture.
    #[error("the crop must be inside the picture of {0} x {1} pixels")]
    CropOutside(u32, u32),
    /// A diagram of samples would have to store too many samples.
    #[error("a diagram can show at most {MAX_STORED} samples, not {0}")]
    TooManySamples(u64),
    /// The diagram cannot be drawn for the given reason.
    #[error("{0}")]
    Diagram(String),
    /// The render cannot be divided in this way.
    #[error("{0}")]
    Shard(String),
    /// The job cannot be sampled adaptively.
    #[error("{0}")]
    Adaptive(String),
    /// The picture does not fit into memory and cannot be rendered in bands.
    #[error("cannot render a picture of this size in bands of rows: {0}")]
    Bands(String),
    /// The render needs more memory than the limit allows.
    #[error("rendering needs about {} of memory, but the limit is {}", format_bytes_up(*.needed), format_bytes_down(*.allowed))]
    Memory {
        /// Bytes needed.
        needed: u64,
        /// Bytes allowed.
        allowed: u64,
    },
    /// The system does not have enough memory for the render.
    #[error("rendering needs about {} of memory, but the system has less", format_bytes_up(*.0))]
    NoMemory(u64),
    /// A graphics device failed, or the part belongs to another device.
    #[error("{0}")]
    Device(String),
    /// The saved part belongs to another scene.
    #[error("this part belongs to a different scene")]
    OtherScene,
    /// A thread panicked, which is a bug in Dürer.
    #[error(transparent)]
    Panic(#[from] Panicked),
}

/// Error that reports a panic and the sample that caused it. A panic is a bug in Dürer. The work on
/// other samples is kept.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("internal error in pixel {x},{y}{}: {message}", sample.map(|s| format!(", sample {s}")).unwrap_or_default())]
pub struct Panicked {
    /// Column of the pixel.
    pub x: u32,
    /// Row of the pixel.
    pub y: u32,
    /// Index of the sample. It is `None` for the ray through the pixel's centre and for pixels that
    /// share samples.
    pub sample: Option<u32>,
    /// Message of the panic that occurred.
    pub message: String,
}

/// Returns the centre of a pixel.
pub(super) fn center(x: u32, y: u32) -> Vec2 {
    Vec2::new(x as f32 + 0.5, y as f32 + 0.5)
}
