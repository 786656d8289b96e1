//! Row-by-row writing of pictures of any size.

#[cfg(feature = "codecs")]
use super::ChannelBits;
use super::{Display, Format, Image, ImageError, Layer, WriteOptions};
use durer_bvh::math::Vec3;
use rayon::prelude::*;
use std::io::{self, Write};

/// Number of rows that are encoded in parallel before they are written.
const AT_ONCE: usize = 32;

/// Functions of a [`Format`] that write pictures row by row.
#[derive(Debug)]
pub struct RowFormat {
    /// True if the bottom row comes first.
    pub bottom_up: bool,
    /// Creates the header of the file.
    pub(super) head: fn(&RowLayout) -> Result<Vec<u8>, ImageError>,
    /// Appends the bytes of the row that has the given number in the file.
    pub(super) row: fn(&RowLayout, u32, &[Vec3], &[f32], &mut Vec<u8>),
    /// True if channels can have 16 bits.
    pub(super) sixteen_bits: bool,
    /// True if the rows form a PNG file, whose encoder also writes the header.
    #[cfg_attr(not(feature = "codecs"), allow(dead_code))]
    pub(super) png: bool,
}

/// Size, alpha, and display conversion of a picture that is written row by row.
#[derive(Clone, Copy, Debug)]
pub struct RowLayout {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// True if alpha is stored in formats that support it.
    pub alpha: bool,
    /// Conversion of linear colours to integer values.
    pub display: Display,
}

impl RowLayout {
    /// Creates the properties needed to write a layer with these options.
    pub(super) fn of(layer: &Layer, options: &WriteOptions) -> Self {
        let alpha = layer.coverage.is_some();
        let Image { width, height, .. } = *layer.image;
        RowLayout { width, height, alpha, display: super::display(layer, options) }
    }

    /// Calls `offer` with the 8-bit red, green, blue, and opacity values of each pixel in a row. If
    /// there is alpha, the colours are not premultiplied (straight alpha).
    #[cfg(feature = "codecs")]
    pub(super) fn eight_bit(&self, pixels: &[Vec3], coverage: &[f32], mut offer: impl FnMut([u8; 4])) {
        self.straight(pixels, coverage).for_each(|(color, opacity)| {
            let [r, g, b] = self.display.encode_pixel(color);
            offer([r, g, b, crate::Transfer::Linear.encode(opacity)]);
        });
    }

    /// Appends the first `channels` of the red, green, blue, and opacity values of each pixel in a
    /// row. Values of 16 bits are stored with the most significant byte first.
    #[cfg(feature = "codecs")]
    pub(super) fn append(&self, pixels: &[Vec3], coverage: &[f32], channels: usize, out: &mut Vec<u8>) {
        match self.display.bits {
            ChannelBits::Eight => self.eight_bit(pixels, coverage, |rgba| out.extend(&rgba[..channels])),
            ChannelBits::Sixteen => self.straight(pixels, coverage).for_each(|(color, opacity)| {
                let [r, g, b] = self.display.encode_pixel16(color);
                let rgba = [r, g, b, crate::Transfer::Linear.encode16(opacity)];
                out.extend(rgba[..channels].iter().flat_map(|value| value.to_be_bytes()));
            }),
        }
    }

    /// Iterates over the colours of a row that are not premultiplied, and their opacities.
    #[cfg(feature = "codecs")]
    fn straight(&self, pixels: &[Vec3], coverage: &[f32]) -> impl Iterator<Item = (Vec3, f32)> {
        pixels.iter().enumerate().map(|(i, &pixel)| match coverage.get(i).filter(|_| self.alpha) {
            Some(&share) if share > 0.0 => (pixel / share, share),
            Some(_) => (Vec3::ZERO, 0.0),
            None => (pixel, 1.0),
        })
    }
}

/// Writer that takes the rows of a picture from the closure passed to [`Format::write_rows`].
pub struct RowWriter<'w> {
    format: &'static RowFormat,
    strip: RowLayout,
    /// Number of the next row.
    next: u32,
    out: &'w mut dyn Write,
}

impl Format {
    /// Writes a picture row by row. `rows` passes the rows to a [`RowWriter`], starting with the
    /// bottom row if [`RowFormat::bottom_up`] is set.
    ///
    /// # Errors
    /// Returns the errors of `rows` and `out`, and [`ImageError::Unsupported`] if the format cannot
    /// be written row by row or cannot hold a picture of this size.
    pub fn write_rows<T, E: From<ImageError> + From<io::Error>>(
        &self,
        strip: RowLayout,
        out: &mut dyn Write,
        rows: impl FnOnce(&mut RowWriter) -> Result<T, E>,
    ) -> Result<T, E> {
        let format =
            self.rows.ok_or_else(|| ImageError::unsupported(self.name, "writing row by row is not supported"))?;
        out.write_all(&(format.head)(&strip)?)?;
        write_compressed(format, strip, out, rows)
    }
}

/// Writes rows, which are compressed if the format requires it.
fn write_compressed<T, E: From<io::Error>>(
    format: &'static RowFormat,
    strip: RowLayout,
    out: &mut dyn Write,
    rows: impl FnOnce(&mut RowWriter) -> Result<T, E>,
) -> Result<T, E> {
    #[cfg(feature = "codecs")]
    if format.png {
        return super::png::write_compressed(format, strip, out, rows);
    }
    rows(&mut RowWriter::new(format, strip, out))
}

impl<'w> RowWriter<'w> {
    /// Creates a writer that starts at the first row.
    pub(super) fn new(format: &'static RowFormat, strip: RowLayout, out: &'w mut dyn Write) -> Self {
        RowWriter { format, strip, next: 0, out }
    }

    /// Writes the next rows. `pixels` are ordered from top to bottom, whatever the order in the
    /// file is. `coverage` contains the coverage of each pixel; it is empty if all pixels are fully
    /// covered.
    ///
    /// # Errors
    /// Returns the errors of the file.
    pub fn rows(&mut self, pixels: &[Vec3], coverage: &[f32]) -> io::Result<()> {
        let (format, strip, width) = (self.format, &self.strip, self.strip.width as usize);
        let count = (pixels.len() / width) as u32;
        // The rows are in the order in which the file stores them.
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

/// Encodes a picture that is in memory row by row.
pub(super) fn encode(
    format: &'static RowFormat,
    layers: &[Layer],
    options: &WriteOptions,
    out: &mut Vec<u8>,
) -> Result<(), ImageError> {
    for layer in layers {
        let strip = RowLayout::of(layer, options);
        out.extend((format.head)(&strip)?);
        let coverage = layer.coverage.as_deref().unwrap_or_default();
        let written = write_compressed(format, strip, out, |rows| rows.rows(&layer.image.pixels, coverage));
        // Writing to memory never fails.
        debug_assert!(written.is_ok());
    }
    Ok(())
}
