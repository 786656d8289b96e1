//! The file formats of pictures, as one table.
//!
//! To add a format: one file beside the others and one row in [`FORMATS`].

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

pub use rows::{RowFormat, RowWriter, Strip};

use super::limits;
use super::{Display, Image, Image8, ImageError, Layer, LayerKind, Transfer};
use crate::panics::caught;
use durer_diag as diag;
#[cfg(feature = "codecs")]
use rayon::prelude::*;
use std::path::Path;

/// Every format that is known, in the order in which content is tried.
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
];

/// Formats that are read and not written.
static READ_ONLY: &[Format] = &[
    #[cfg(feature = "jpeg")]
    jpeg::FORMAT,
    #[cfg(feature = "webp")]
    webp::FORMAT,
    #[cfg(feature = "ktx2")]
    ktx2::FORMAT,
];

/// What a file holds for each channel of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Depth {
    /// 0 to 255, after the [`Transfer`].
    EightBit,
    /// Floating point: light beyond white is kept.
    Float,
}

/// How pictures are written.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WriteOptions<'a> {
    /// What makes eight bits of a colour. Formats of floating point have no use for it.
    pub display: Display,
    /// Names and texts to be told beside the pictures, in formats that have a place for them.
    pub attributes: &'a [(&'static str, String)],
}

/// What a file's head tells of its picture.
pub(super) struct Head {
    /// Pixels in a row, and rows: as declared, whether possible or not.
    pub width: u64,
    pub height: u64,
    /// Whether a channel has eight bits.
    pub eight: bool,
    /// Memory that decoding takes, the decoded picture with it: for each pixel, and beside that.
    pub bytes_per_pixel: u64,
    pub spare: u64,
}

/// What a file holds.
pub enum Raster {
    /// Eight bits a channel.
    Eight(Image8),
    /// Sixteen bits a channel, from 0 to 1: a curve says what they mean. The opacity of each pixel,
    /// if the file has it.
    Sixteen(Image, Vec<f32>),
    /// Numbers as they are, with opacity.
    Float(Image, Vec<f32>),
}

/// Appends layers that were checked to fit the format.
type Encode = fn(&[Layer], &WriteOptions, &mut Vec<u8>) -> Result<(), ImageError>;

/// One format.
#[derive(Debug)]
pub struct Format {
    /// Its name for people.
    pub name: &'static str,
    /// Extensions of its files, lower case, without the dot; the usual one first.
    pub extensions: &'static [&'static str],
    /// What a channel is.
    pub depth: Depth,
    /// Whether several layers fit into one file.
    pub layers: bool,
    /// The greatest width or height that it can hold.
    pub most_side: u32,
    /// Whether bytes begin as files of this format do.
    begins: fn(&[u8]) -> bool,
    /// Reads the head alone.
    head: fn(&[u8]) -> Result<Head, ImageError>,
    /// Reads a picture whose size was found possible.
    decode: fn(&[u8]) -> Result<Raster, ImageError>,
    encode: Encode,
    /// How it is written row by row, if it can be.
    pub rows: Option<&'static RowFormat>,
}

impl Format {
    /// Whether a picture of this size fits, which is better known before it is made.
    ///
    /// # Errors
    /// [`ImageError::Size`] and [`ImageError::Unsupported`].
    pub fn check_size(&self, width: u32, height: u32) -> Result<(), ImageError> {
        limits::checked_count(width, height)?;
        self.check_sides(width, height)
    }

    /// The same for a picture that is written row by row, and so may be larger than any in memory.
    ///
    /// # Errors
    /// [`ImageError::Unsupported`].
    pub fn check_sides(&self, width: u32, height: u32) -> Result<(), ImageError> {
        match width.max(height) <= self.most_side {
            true => Ok(()),
            false => Err(ImageError::unsupported(self.name, format!("a side above {}", self.most_side))),
        }
    }

    /// Appends a file with these layers to `out`.
    ///
    /// # Errors
    /// [`ImageError::NoLayer`], [`ImageError::SeveralLayers`] where only one fits,
    /// [`ImageError::LayerSizes`], [`ImageError::Size`], and [`ImageError::Unsupported`] for a
    /// size or name that the format cannot hold.
    pub fn write(&self, layers: &[Layer], options: &WriteOptions, out: &mut Vec<u8>) -> Result<(), ImageError> {
        let first = layers.first().ok_or(ImageError::NoLayer)?;
        if layers.len() > 1 && !self.layers {
            return Err(ImageError::SeveralLayers { format: self.name, count: layers.len() });
        }
        for layer in layers {
            layer.image.check()?;
            if layer.coverage.as_ref().is_some_and(|coverage| coverage.len() != layer.image.pixels.len()) {
                return Err(ImageError::Size { width: layer.image.width, height: layer.image.height });
            }
            if (layer.image.width, layer.image.height) != (first.image.width, first.image.height) {
                return Err(ImageError::LayerSizes { name: layer.name.clone() });
            }
        }
        (self.encode)(layers, options, out)
    }

    pub(super) fn head(&self, bytes: &[u8]) -> Result<Head, ImageError> {
        self.caught(|| (self.head)(bytes))
    }

    pub(super) fn decode(&self, bytes: &[u8]) -> Result<Raster, ImageError> {
        self.caught(|| (self.decode)(bytes))
    }

    /// Most decoders are other people's code. Should one of them panic, this is one more malformed
    /// file.
    fn caught<T>(&self, work: impl FnOnce() -> Result<T, ImageError>) -> Result<T, ImageError> {
        caught(work).unwrap_or_else(|| Err(ImageError::malformed(self.name, "its decoder failed")))
    }

    fn has_extension(&self, path: &str) -> bool {
        extension(path).is_some_and(|ending| self.extensions.contains(&ending.as_str()))
    }
}

/// The format that a file name's extension tells.
///
/// # Errors
/// [`ImageError::UnknownExtension`].
pub fn format_for(path: impl AsRef<Path>) -> Result<&'static Format, ImageError> {
    let path = path.as_ref().to_string_lossy();
    FORMATS.iter().find(|format| format.has_extension(&path)).ok_or_else(|| {
        let all = FORMATS.iter().flat_map(|format| format.extensions.iter().copied());
        let meant = extension(&path).and_then(|ending| diag::did_you_mean(&ending, all));
        ImageError::UnknownExtension { path: path.into(), meant, known: known_extensions() }
    })
}

/// The format of a file's content, or failing that, of its name.
pub(super) fn recognise(bytes: &[u8], name: &str) -> Result<&'static Format, ImageError> {
    let all = || FORMATS.iter().chain(READ_ONLY);
    let by_content = all().find(|format| (format.begins)(bytes));
    let by_name = || all().find(|format| format.has_extension(name));
    by_content.or_else(by_name).ok_or_else(|| ImageError::Unrecognised { name: name.into() })
}

/// The usual extension of files of the format that bytes are in, if one is recognised; `name` tells
/// where bytes do not.
pub fn extension_of(bytes: &[u8], name: &str) -> Option<&'static str> {
    recognise(bytes, name).ok().map(|format| format.extensions[0])
}

/// The usual extension of each format, for a message.
fn known_extensions() -> String {
    let endings: Vec<String> = FORMATS.iter().map(|format| format!(".{}", format.extensions[0])).collect();
    endings.join(", ")
}

fn extension(path: &str) -> Option<String> {
    Some(Path::new(path).extension()?.to_str()?.to_lowercase())
}

/// What makes eight bits of a layer's numbers.
fn display(layer: &Layer, options: &WriteOptions) -> Display {
    match (layer.kind, options.display.transfer) {
        // A curve would falsify data; cutting off instead of rounding is what the course did to
        // everything.
        (LayerKind::Data, Transfer::Srgb) => Transfer::Linear.into(),
        (LayerKind::Data, transfer) => transfer.into(),
        _ => options.display,
    }
}

/// The bytes of an eight-bit picture: red, green and blue, the top row first. They are made by all
/// threads.
#[cfg(feature = "codecs")]
fn eight_bit(layer: &Layer, options: &WriteOptions) -> Vec<u8> {
    const STEP: usize = 1 << 14;
    let (strip, pixels) = (Strip { alpha: false, ..Strip::of(layer, options) }, &layer.image.pixels);
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
