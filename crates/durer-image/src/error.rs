//! What can be wrong with a picture.

use durer_diag::{at_least, at_most};

/// Why a picture cannot be read or written.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ImageError {
    /// No format has this file name's extension.
    #[error("`{path}` does not end like a picture file; known are {known}{}", suggestion(.meant))]
    UnknownExtension {
        /// The file name.
        path: String,
        /// The extension that may have been meant, without its dot.
        meant: Option<&'static str>,
        /// The usual extension of each format.
        known: String,
    },
    /// Neither the content nor the name tells the format.
    #[error("`{name}` is not a picture of a known format")]
    Unrecognised {
        /// The name it was read under.
        name: String,
    },
    /// The bytes break the format's rules, or end too early.
    #[error("not a valid {format} picture: {reason}")]
    Malformed {
        /// Name of the format.
        format: &'static str,
        /// What is wrong.
        reason: String,
    },
    /// The format is right, but this kind of it cannot be read or written.
    #[error("{format}: {reason}")]
    Unsupported {
        /// Name of the format.
        format: &'static str,
        /// What is not supported.
        reason: String,
    },
    /// The declared size is beyond what is read for a file of that many bytes.
    #[error("a picture of {width} x {height} pixels is too large for a file of {bytes} bytes")]
    TooLarge {
        /// Declared pixels in a row.
        width: u64,
        /// Declared rows.
        height: u64,
        /// Length of the file.
        bytes: usize,
    },
    /// It would take more memory than is allowed.
    #[error(
        "its {width} x {height} pixels need about {} of memory, and what is left for it is {}",
        at_least(*.needed), at_most(*.allowed)
    )]
    Memory {
        /// Pixels in a row.
        width: u64,
        /// Rows.
        height: u64,
        /// Bytes that reading it takes.
        needed: u64,
        /// Bytes that are allowed.
        allowed: u64,
    },
    /// The system has not so much memory.
    #[error("it needs {} of memory at once, which cannot be had", at_least(*.0))]
    NoRoom(u64),
    /// Eight-bit values were asked for, and the picture has others.
    #[error("the picture has not eight bits a channel")]
    NotEightBit,
    /// A side is 0, there are too many pixels, or their number does not fit the sides.
    #[error("{width} x {height} pixels are no possible picture: it has from 1 to {} of them", super::MAX_PIXELS)]
    Size {
        /// Pixels in a row.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// There is nothing to write.
    #[error("there is no layer to write")]
    NoLayer,
    /// Several layers for a format that holds one: they need a file each.
    #[error("{format} holds one layer, not {count}")]
    SeveralLayers {
        /// Name of the format.
        format: &'static str,
        /// How many were given.
        count: usize,
    },
    /// Layers of one file must have one size.
    #[error("the layer `{name}` has another size than the first")]
    LayerSizes {
        /// The first layer that differs.
        name: String,
    },
}

fn suggestion(meant: &Option<&'static str>) -> String {
    meant.map(|meant| format!("; did you mean `.{meant}`?")).unwrap_or_default()
}

impl ImageError {
    /// The bytes break the format's rules.
    pub(super) fn malformed(format: &'static str, reason: impl ToString) -> ImageError {
        ImageError::Malformed { format, reason: reason.to_string() }
    }

    /// There is no memory for so many things of a size.
    pub(super) fn no_room(count: usize, size: usize) -> ImageError {
        ImageError::NoRoom(count as u64 * size as u64)
    }

    /// This kind of the format cannot be read or written.
    pub(super) fn unsupported(format: &'static str, reason: impl ToString) -> ImageError {
        ImageError::Unsupported { format, reason: reason.to_string() }
    }
}
