//! Errors that occur when pictures are read and written.

use durer_diag::{format_bytes_down, format_bytes_up};

/// Error that occurs when a picture is decoded, encoded, or created.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ImageError {
    /// The file name has an unknown extension.
    #[error("`{path}` does not have the extension of a picture file; known extensions are {known}{}", suggestion(.path, .similar))]
    UnknownExtension {
        /// The file name with the unknown extension.
        path: String,
        /// Suggested extension, without the leading dot.
        similar: Option<&'static str>,
        /// List of the usual extensions of all formats.
        known: String,
    },
    /// Neither the content nor the name of the file indicates the format.
    #[error("`{name}` is not a picture of a known format")]
    Unrecognised {
        /// Name under which the picture was read.
        name: String,
    },
    /// The file is something else that was stored in its place, such as a web page.
    #[error("`{name}` is {what}; {help}")]
    StandIn {
        /// Name under which the picture was read.
        name: String,
        /// Kind of file.
        what: &'static str,
        /// Advice on how to get the picture.
        help: &'static str,
    },
    /// The content violates the rules of its format or ends too early.
    #[error("not a valid {format} picture: {reason}")]
    Malformed {
        /// Name of the picture format.
        format: &'static str,
        /// Description of the problem.
        reason: String,
    },
    /// The format is known, but this variant of it cannot be read or written.
    #[error("{format}: {reason}")]
    Unsupported {
        /// Name of the picture format.
        format: &'static str,
        /// Description of the unsupported feature.
        reason: String,
    },
    /// The size in the header is too large for a file of this length.
    #[error("a picture of {width} x {height} pixels is too large for a file of {bytes} bytes")]
    TooLarge {
        /// Width in pixels that the header declares.
        width: u64,
        /// Height in pixels that the header declares.
        height: u64,
        /// Length of the file in bytes.
        bytes: usize,
    },
    /// Decoding the picture would use more memory than is allowed.
    #[error(
        "{width} x {height} pixels need about {} of memory, but only {} is left",
        format_bytes_up(*.needed), format_bytes_down(*.allowed)
    )]
    MemoryLimit {
        /// Width in pixels.
        width: u64,
        /// Height in pixels.
        height: u64,
        /// Number of bytes of memory that decoding needs.
        needed: u64,
        /// Number of bytes of memory that decoding may use.
        allowed: u64,
    },
    /// An allocation of this many bytes failed.
    #[error("an allocation of {} of memory failed", format_bytes_up(*.0))]
    OutOfMemory(u64),
    /// 8-bit values were requested, but the picture has more than 8 bits per channel.
    #[error("the picture does not have eight bits per channel")]
    NotEightBit,
    /// The width or height is 0, there are too many pixels, or the number of pixels is not width
    /// times height.
    #[error("a picture cannot be {width} x {height} pixels large: it must have from 1 to {} pixels", super::MAX_PIXELS)]
    InvalidSize {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
    },
    /// The list of layers is empty.
    #[error("there is no layer to write")]
    NoLayer,
    /// Several layers were passed to a format that can hold only one. Write each layer to its own
    /// file instead.
    #[error("{format} can hold only one layer, not {count}")]
    SeveralLayers {
        /// Name of the picture format.
        format: &'static str,
        /// Number of layers.
        count: usize,
    },
    /// The layers of a file have different sizes.
    #[error("the layer `{name}` has a different size from the first layer")]
    LayerSizes {
        /// Name of the first layer whose size differs.
        name: String,
    },
}

fn suggestion(path: &str, similar: &Option<&'static str>) -> String {
    let extension = path.rsplit_once('.').map_or("", |(_, extension)| extension).to_lowercase();
    if ["gif", "mp4", "webm", "avi", "mov", "mkv", "apng"].contains(&&*extension) {
        return "; videos are made of numbered pictures such as frame.%04d.png, for example by ffmpeg".into();
    }
    similar.map(|similar| format!("; did you mean `.{similar}`?")).unwrap_or_default()
}

impl ImageError {
    /// Creates an error for content that violates the rules of its format.
    pub(super) fn malformed(format: &'static str, reason: impl ToString) -> ImageError {
        ImageError::Malformed { format, reason: reason.to_string() }
    }

    /// Creates an error for a failed allocation of `count` items of `size` bytes each.
    pub(super) fn out_of_memory(count: usize, size: usize) -> ImageError {
        ImageError::OutOfMemory(count as u64 * size as u64)
    }

    /// Creates an error for a variant of a format that is not supported.
    pub(super) fn unsupported(format: &'static str, reason: impl ToString) -> ImageError {
        ImageError::Unsupported { format, reason: reason.to_string() }
    }
}
