//! Formats that are written row by row, so that no picture is too large for them.

use super::{Display, Format, Image, ImageError, Layer, WriteOptions};
use durer_bvh::math::Vec3;
use rayon::prelude::*;
use std::io::{self, Write};

/// Rows that are made side by side, and then written.
const AT_ONCE: usize = 32;

/// How a format writes rows.
#[derive(Debug)]
pub struct RowFormat {
    /// Whether the lowest row comes first.
    pub bottom_up: bool,
    /// What stands before the rows.
    pub(super) head: fn(&Strip) -> Result<Vec<u8>, ImageError>,
    /// Appends the bytes of a row, whose number in the file is given.
    pub(super) row: fn(&Strip, u32, &[Vec3], &[f32], &mut Vec<u8>),
    /// Whether all that is packed by PNG's own rules, its head with it.
    #[cfg_attr(not(feature = "codecs"), allow(dead_code))]
    pub(super) png: bool,
}

/// What all rows of a picture have in common.
#[derive(Clone, Copy, Debug)]
pub struct Strip {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Whether what the camera does not see is told beside the colours, in formats that can.
    pub alpha: bool,
    /// What makes eight bits of a colour.
    pub display: Display,
}

impl Strip {
    /// Of a layer, as a format shows it.
    pub(super) fn of(layer: &Layer, options: &WriteOptions) -> Self {
        let alpha = layer.coverage.is_some();
        let Image { width, height, .. } = *layer.image;
        Strip { width, height, alpha, display: super::display(layer, options) }
    }

    /// Offers the eight-bit numbers of each pixel of a row: red, green, blue and opacity. Where
    /// there is one, colours are those of what is seen alone, without the share of it (straight
    /// alpha).
    #[cfg(feature = "codecs")]
    pub(super) fn eight_bit(&self, pixels: &[Vec3], coverage: &[f32], mut offer: impl FnMut([u8; 4])) {
        for (i, &pixel) in pixels.iter().enumerate() {
            let (alone, opacity) = match coverage.get(i).filter(|_| self.alpha) {
                Some(&share) if share > 0.0 => (pixel / share, crate::Transfer::Linear.encode(share)),
                Some(_) => (Vec3::ZERO, 0),
                None => (pixel, 255),
            };
            let [r, g, b] = self.display.encode_pixel(alone);
            offer([r, g, b, opacity]);
        }
    }
}

/// A picture that is being written row by row.
pub struct RowWriter<'w> {
    format: &'static RowFormat,
    strip: Strip,
    /// The number of the next row.
    next: u32,
    out: &'w mut dyn Write,
}

impl Format {
    /// Writes a picture whose rows come one after the other, the lowest first where
    /// [`RowFormat::bottom_up`] says so.
    ///
    /// # Errors
    /// Those of `rows` and of the file, and [`ImageError::Unsupported`] for formats that are not
    /// written so, and for sizes that they cannot hold.
    pub fn write_rows<T, E: From<ImageError> + From<io::Error>>(
        &self,
        strip: Strip,
        out: &mut dyn Write,
        rows: impl FnOnce(&mut RowWriter) -> Result<T, E>,
    ) -> Result<T, E> {
        let format = self.rows.ok_or_else(|| ImageError::unsupported(self.name, "writing row by row"))?;
        out.write_all(&(format.head)(&strip)?)?;
        packed(format, strip, out, rows)
    }
}

/// Writes rows, packed where that is the format's way.
fn packed<T, E: From<io::Error>>(
    format: &'static RowFormat,
    strip: Strip,
    out: &mut dyn Write,
    rows: impl FnOnce(&mut RowWriter) -> Result<T, E>,
) -> Result<T, E> {
    #[cfg(feature = "codecs")]
    if format.png {
        return super::png::packed(format, strip, out, rows);
    }
    rows(&mut RowWriter::new(format, strip, out))
}

impl<'w> RowWriter<'w> {
    /// Writes the rows of `strip` to `out`, from the first.
    pub(super) fn new(format: &'static RowFormat, strip: Strip, out: &'w mut dyn Write) -> Self {
        RowWriter { format, strip, next: 0, out }
    }

    /// The next rows, from top to bottom whatever comes first in the file. `coverage` is the share
    /// of each pixel that is seen; empty where all is.
    ///
    /// # Errors
    /// Those of the file.
    pub fn rows(&mut self, pixels: &[Vec3], coverage: &[f32]) -> io::Result<()> {
        let (format, strip, width) = (self.format, &self.strip, self.strip.width as usize);
        let count = (pixels.len() / width) as u32;
        // In the order of the file.
        let row = |i: u32| {
            let y = if format.bottom_up { count - 1 - i } else { i } as usize;
            let range = y * width..(y + 1) * width;
            let mut bytes = Vec::new();
            let coverage = coverage.get(range.clone()).unwrap_or_default();
            (format.row)(strip, self.next + i, &pixels[range], coverage, &mut bytes);
            bytes
        };
        for first in (0..count).step_by(AT_ONCE) {
            let made: Vec<Vec<u8>> = (first..count.min(first + AT_ONCE as u32)).into_par_iter().map(row).collect();
            made.iter().try_for_each(|bytes| self.out.write_all(bytes))?;
        }
        self.next += count;
        Ok(())
    }
}

/// A picture in memory, by its rows.
pub(super) fn encode(
    format: &'static RowFormat,
    layers: &[Layer],
    options: &WriteOptions,
    out: &mut Vec<u8>,
) -> Result<(), ImageError> {
    for layer in layers {
        let strip = Strip::of(layer, options);
        out.extend((format.head)(&strip)?);
        let coverage = layer.coverage.as_deref().unwrap_or_default();
        let written = packed(format, strip, out, |rows| rows.rows(&layer.image.pixels, coverage));
        // Memory takes whatever is written.
        debug_assert!(written.is_ok());
    }
    Ok(())
}
