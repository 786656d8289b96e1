//! Table of all picture file formats.
//!
//! To add a format, add a file to this folder and a row to [`FORMATS`].

#[cfg(feature = "codecs")]
mod bmp;
#[cfg(any(feature = "codecs", feature = "jpeg", feature = "webp"))]
mod codec;
#[cfg(feature = "exr")]
mod exr;
#[cfg(feature = "codecs")]
mod hdr;
#[cfg(feature = "jpeg")]
mod jpeg;
#[cfg(feature = "ktx2")]
mod ktx2;
mod pfm;
#[cfg(feature = "codecs")]
mod png;
#[cfg(feature = "codecs")]
mod ppm;
mod rows;
#[cfg(feature = "codecs")]
mod tga;
#[cfg(feature = "webp")]
mod webp;

pub use rows::{RowFormat, RowLayout, RowWriter};

#[cfg(feature = "codecs")]
use super::ChannelBits;
use super::limits;
use super::{Display, Image, Image8, ImageError, Layer, LayerKind, Transfer};
use crate::panics::catch_panic;
use durer_diag as diag;
#[cfg(any(feature = "codecs", feature = "jpeg", feature = "webp"))]
use rayon::prelude::*;
use std::path::Path;

/// Formats that can be read and written, in the order in which their signatures are checked.
pub static FORMATS: &[Format] = &[
    #[cfg(feature = "codecs")]
    png::FORMAT,
    #[cfg(feature = "codecs")]
    tga::FORMAT,
    #[cfg(feature = "codecs")]
    bmp::FORMAT,
    #[cfg(feature = "codecs")]
    ppm::FORMAT,
    pfm::FORMAT,
    #[cfg(feature = "exr")]
    exr::FORMAT,
    #[cfg(feature = "codecs")]
    hdr::FORMAT,
    #[cfg(feature = "jpeg")]
    jpeg::FORMAT,
    #[cfg(feature = "webp")]
    webp::FORMAT,
];

/// Formats that can be read but not written.
static READ_ONLY: &[Format] = &[
    #[cfg(feature = "ktx2")]
    ktx2::FORMAT,
];

/// Kind of values that a file format stores for each channel, which are 8-bit integers or
/// floating-point numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Depth {
    /// Integer values from 0 to 255, or to 65535 with [`ChannelBits::Sixteen`](crate::ChannelBits),
    /// to which the [`Transfer`] function has been applied.
    EightBit,
    /// Floating-point values, which can be greater than 1.
    Float,
}

/// Options for encoding a picture with [`Format::write`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WriteOptions<'a> {
    /// Conversion of linear colours to integer values. Floating-point formats ignore it.
    pub display: Display,
    /// Metadata as pairs of a name and a text, stored only by formats that support it.
    pub attributes: &'a [(&'static str, String)],
}

/// Size of a picture and the memory needed to decode it, taken from the header of its file.
pub(super) struct ImageHeader {
    /// Width and height as stated in the header; they may be invalid.
    pub width: u64,
    pub height: u64,
    /// True if each channel has eight bits.
    pub is_eight_bit: bool,
    /// Memory that decoding needs, including the decoded picture: a number of bytes per pixel, plus
    /// `extra_bytes`.
    pub bytes_per_pixel: u64,
    pub extra_bytes: u64,
}

/// Decoded pixels of a picture file, with the number of bits per channel that they have in the
/// file.
pub enum Raster {
    /// Values with 8 bits per channel.
    Eight(Image8),
    /// Values with 16 bits per channel, scaled to the range from 0 to 1 without applying a transfer
    /// function. The list contains the opacity of each pixel; it is empty if the file stores none.
    Sixteen(Image, Vec<f32>),
    /// Floating-point values as they are stored in the file. The list contains the opacity of each
    /// pixel; it is empty if the file stores none.
    Float(Image, Vec<f32>),
}

/// Encoder of a [`Format`], which appends a file with these layers. Their number and sizes have
/// already been checked.
type Encode = fn(&[Layer], &WriteOptions, &mut Vec<u8>) -> Result<(), ImageError>;

/// A picture file format, such as PNG or OpenEXR, with the functions that read and write it.
#[derive(Debug)]
pub struct Format {
    /// Name of the format for display.
    pub name: &'static str,
    /// File name extensions in lower case, without the leading dot; the usual one comes first.
    pub extensions: &'static [&'static str],
    /// Kind of values that each channel has.
    pub depth: Depth,
    /// True if a file can contain several layers.
    pub supports_layers: bool,
    /// True if files that are written store the coverage of pixels. Other formats store pixels
    /// without coverage as black.
    pub has_alpha: bool,
    /// Maximum width and height in pixels.
    pub max_side: u32,
    /// Returns true if the bytes begin with the format's signature.
    has_signature: fn(&[u8]) -> bool,
    /// Reads only the header of a file.
    head: fn(&[u8]) -> Result<ImageHeader, ImageError>,
    /// Decodes a picture whose size has already been checked.
    decode: fn(&[u8]) -> Result<Raster, ImageError>,
    encode: Encode,
    /// Functions for writing row by row, if the format supports it.
    pub rows: Option<&'static RowFormat>,
}

impl Format {
    /// Checks that a picture of this size can be written in this format, for example before a long
    /// render.
    ///
    /// # Errors
    /// Returns [`ImageError::InvalidSize`] or [`ImageError::Unsupported`] if the picture cannot be
    /// written.
    pub fn check_size(&self, width: u32, height: u32) -> Result<(), ImageError> {
        limits::checked_count(width, height)?;
        self.check_sides(width, height)
    }

    /// Checks the size of a picture that is written row by row and may therefore be too large for
    /// memory.
    ///
    /// # Errors
    /// [`ImageError::Unsupported`].
    pub fn check_sides(&self, width: u32, height: u32) -> Result<(), ImageError> {
        match width.max(height) <= self.max_side {
            true => Ok(()),
            false => Err(ImageError::unsupported(
                self.name,
                format!("sides of more than {} pixels are not supported", self.max_side),
            )),
        }
    }

    /// Appends a file with these layers to `out`.
    ///
    /// # Errors
    /// Returns [`ImageError::NoLayer`] if there is no layer, [`ImageError::SeveralLayers`] if the
    /// format can hold only one, [`ImageError::LayerSizes`] if the sizes differ,
    /// [`ImageError::InvalidSize`] if a size is invalid, and [`ImageError::Unsupported`] if the
    /// format cannot hold a size or name.
    pub fn write(&self, layers: &[Layer], options: &WriteOptions, out: &mut Vec<u8>) -> Result<(), ImageError> {
        let first = layers.first().ok_or(ImageError::NoLayer)?;
        if layers.len() > 1 && !self.supports_layers {
            return Err(ImageError::SeveralLayers { format: self.name, count: layers.len() });
        }
        for layer in layers {
            layer.image.check()?;
            if layer.coverage.as_ref().is_some_and(|coverage| coverage.len() != layer.image.pixels.len()) {
                return Err(ImageError::InvalidSize { width: layer.image.width, height: layer.image.height });
            }
            if (layer.image.width, layer.image.height) != (first.image.width, first.image.height) {
                return Err(ImageError::LayerSizes { name: layer.name.clone() });
            }
        }
        (self.encode)(layers, options, out)
    }

    /// Returns true if the format can be written with 16 bits per channel.
    pub fn supports_sixteen_bits(&self) -> bool {
        self.rows.is_some_and(|rows| rows.sixteen_bits)
    }

    pub(super) fn head(&self, bytes: &[u8]) -> Result<ImageHeader, ImageError> {
        self.catch(|| (self.head)(bytes))
    }

    pub(super) fn decode(&self, bytes: &[u8]) -> Result<Raster, ImageError> {
        self.catch(|| (self.decode)(bytes))
    }

    /// Runs a decoder and treats a panic as a malformed file, because most decoders are third-party
    /// code.
    fn catch<T>(&self, work: impl FnOnce() -> Result<T, ImageError>) -> Result<T, ImageError> {
        catch_panic(work).unwrap_or_else(|| Err(ImageError::malformed(self.name, "its decoder failed")))
    }

    fn has_extension(&self, path: &str) -> bool {
        extension(path).is_some_and(|ending| self.extensions.contains(&ending.as_str()))
    }
}

/// Finds the format that a file name indicates by its extension.
///
/// # Errors
/// [`ImageError::UnknownExtension`].
pub fn format_for(path: impl AsRef<Path>) -> Result<&'static Format, ImageError> {
    let path = path.as_ref().to_string_lossy();
    FORMATS.iter().find(|format| format.has_extension(&path)).ok_or_else(|| {
        let all = FORMATS.iter().flat_map(|format| format.extensions.iter().copied());
        let similar = extension(&path).and_then(|ending| diag::did_you_mean(&ending, all));
        ImageError::UnknownExtension { path: path.into(), similar, known: known_extensions() }
    })
}

/// Finds the format of a file by its content or, if the content does not identify it, by its name.
pub(super) fn recognise(bytes: &[u8], name: &str) -> Result<&'static Format, ImageError> {
    let all = || FORMATS.iter().chain(READ_ONLY);
    let by_content = all().find(|format| (format.has_signature)(bytes));
    if let (None, Some(diag::StandIn { what, help, .. })) = (by_content, diag::stand_in(bytes)) {
        return Err(ImageError::StandIn { name: name.into(), what, help });
    }
    let by_name = || all().find(|format| format.has_extension(name));
    by_content.or_else(by_name).ok_or_else(|| ImageError::Unrecognised { name: name.into() })
}

/// Returns the usual file name extension for a picture. Its format is determined by its content or,
/// if the content does not identify it, by its name. Returns `None` if the format is unknown.
pub fn extension_of(bytes: &[u8], name: &str) -> Option<&'static str> {
    recognise(bytes, name).ok().map(|format| format.extensions[0])
}

/// Lists the usual extensions of all formats, for use in a message.
fn known_extensions() -> String {
    let endings: Vec<String> = FORMATS.iter().map(|format| format!(".{}", format.extensions[0])).collect();
    endings.join(", ")
}

fn extension(path: &str) -> Option<String> {
    Some(Path::new(path).extension()?.to_str()?.to_lowercase())
}

/// Returns the conversion of a layer to integer values.
fn display(layer: &Layer, options: &WriteOptions) -> Display {
    if layer.kind != LayerKind::Data {
        return options.display;
    }
    // Applying a transfer function to data would falsify it. `Course`, which only truncates, is an
    // exception, because the course applied it to all pictures.
    let transfer = match options.display.transfer {
        Transfer::Srgb => Transfer::Linear,
        transfer => transfer,
    };
    Display { bits: options.display.bits, ..transfer.into() }
}

/// Returns the 8-bit red, green, and blue values of a picture, starting with the top row. The
/// values are computed in parallel.
#[cfg(any(feature = "codecs", feature = "jpeg", feature = "webp"))]
fn eight_bit(layer: &Layer, options: &WriteOptions) -> Vec<u8> {
    const STEP: usize = 1 << 14;
    let (strip, pixels) = (RowLayout { alpha: false, ..RowLayout::of(layer, options) }, &layer.image.pixels);
    let mut bytes = vec![0_u8; 3 * pixels.len()];
    bytes.as_chunks_mut::<3>().0.par_chunks_mut(STEP).enumerate().for_each(|(i, made)| {
        let mut made = made.iter_mut();
        strip.eight_bit(&pixels[i * STEP..i * STEP + made.len()], &[], |[r, g, b, _]| {
            if let Some(pixel) = made.next() {
                *pixel = [r, g, b];
            }
        });
    });
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extensions_tell_the_format() {
        assert_eq!(format_for("a/b.PNG").unwrap().name, "PNG");
        assert_eq!(format_for("x.tar.exr").unwrap().name, "OpenEXR");
        let message = format_for("out.pgn").unwrap_err().to_string();
        assert!(message.contains(".tga") && message.contains("did you mean `.png`?"), "{message}");
        assert!(format_for("png").is_err());
        assert!(format_for("").is_err());
    }

    #[test]
    fn no_two_formats_share_an_extension() {
        let mut all: Vec<_> = FORMATS.iter().flat_map(|format| format.extensions).collect();
        let count = all.len();
        all.sort();
        all.dedup();
        assert_eq!(all.len(), count);
    }
}
