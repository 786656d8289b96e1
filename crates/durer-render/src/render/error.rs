//! Why there is no picture, or not all of it.

use durer_diag::{at_least, at_most};
use durer_image::ImageError;
use durer_scene::math::Vec2;

/// The most samples that are kept at once, for a diagram of them.
pub(super) const MAX_KEPT: u64 = 1 << 27;

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// The caller set [`super::Control::cancel`].
    #[error("cancelled")]
    Cancelled,
    /// The picture is too large, or the part lies outside of it.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// A value of the job that is out of range.
    #[error("{0}")]
    Job(String),
    /// The part to be made does not lie in the picture.
    #[error("the crop does not lie in the picture of {0} x {1} pixels")]
    CropOutside(u32, u32),
    /// A diagram of samples keeps them, and has not the memory for so many.
    #[error("a diagram keeps all samples, and {0} are too many: at most {MAX_KEPT}")]
    TooManySamples(u64),
    /// A diagram cannot be made as asked for.
    #[error("{0}")]
    Diagram(String),
    /// The work cannot be split so.
    #[error("{0}")]
    Shard(String),
    /// Its samples cannot be divided by noise.
    #[error("{0}")]
    Adaptive(String),
    /// It is too large to be made at once, and cannot be made in bands.
    #[error("a picture of this size is made in bands of rows, which this one cannot be: {0}")]
    Bands(String),
    /// It would take too much memory.
    #[error("rendering needs about {} of memory, and the limit is {}", at_least(*.needed), at_most(*.allowed))]
    Memory {
        /// Bytes that it would take.
        needed: u64,
        /// Bytes allowed.
        allowed: u64,
    },
    /// The part that was begun is one of another scene.
    #[error("this part is not of this scene")]
    OtherScene,
    /// An error in this program.
    #[error(transparent)]
    Panic(#[from] Panicked),
}

/// A sample that made a thread panic: an error in this program. All other work is kept.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("an error in Dürer: pixel {x},{y}{}: {message}", sample.map(|s| format!(", sample {s}")).unwrap_or_default())]
pub struct Panicked {
    /// Column.
    pub x: u32,
    /// Row.
    pub y: u32,
    /// Number of the sample; `None` for the ray through the pixel's centre, or where a pixel has no
    /// samples of its own.
    pub sample: Option<u32>,
    /// What the panic says.
    pub message: String,
}

/// The middle of a pixel.
pub(super) fn center(x: u32, y: u32) -> Vec2 {
    Vec2::new(x as f32 + 0.5, y as f32 + 0.5)
}
