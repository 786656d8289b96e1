//! Portable Network Graphics format, with 8 or 16 bits per channel, lossless compression, and
//! alpha for layers with coverage.

use super::{
    ChannelBits, Depth, Format, ImageError, ImageHeader, Raster, RowFormat, RowLayout, RowWriter, codec, rows,
};
use ::image::ImageFormat;
use ::png::{BitDepth, ColorType, Compression, Encoder, Filter};
use std::borrow::Cow;
use std::io::{self, Write};

const NAME: &str = "PNG";
const MARK: &[u8] = b"\x89PNG\r\n\x1a\n";

pub const FORMAT: Format = Format {
    name: NAME,
    extensions: &["png"],
    depth: Depth::EightBit,
    supports_layers: false,
    has_alpha: true,
    max_side: u32::MAX,
    has_signature: |bytes| bytes.starts_with(MARK),
    head,
    decode,
    encode: |layers, options, out| rows::encode(&ROWS, layers, options, out),
    rows: Some(&ROWS),
};

/// Writes a PNG file row by row and compresses the rows as they arrive.
pub(super) fn write_compressed<T, E: From<io::Error>>(
    format: &'static RowFormat,
    strip: RowLayout,
    out: &mut dyn Write,
    rows: impl FnOnce(&mut RowWriter) -> Result<T, E>,
) -> Result<T, E> {
    let mut encoder = Encoder::new(out, strip.width, strip.height);
    encoder.set_color(if strip.alpha { ColorType::Rgba } else { ColorType::Rgb });
    encoder.set_depth(match strip.display.bits {
        ChannelBits::Eight => BitDepth::Eight,
        ChannelBits::Sixteen => BitDepth::Sixteen,
    });
    encoder.set_compression(Compression::Fast);
    encoder.set_filter(Filter::Adaptive);
    let mut file = encoder.write_header().map_err(io::Error::from)?;
    let mut compressed = file.stream_writer().map_err(io::Error::from)?;
    let made = rows(&mut RowWriter::new(format, strip, &mut compressed))?;
    compressed.finish().map_err(io::Error::from)?;
    file.finish().map_err(io::Error::from)?;
    Ok(made)
}

/// Reads the size and the pixel type from the first chunk. Errors in the other chunks are found by
/// the decoder.
fn head(bytes: &[u8]) -> Result<ImageHeader, ImageError> {
    let first = chunks(bytes).next().filter(|chunk| chunk[4..8] == *b"IHDR").and_then(|chunk| chunk.get(8..18));
    let Some([w @ .., depth, color]) = first else { return Err(ImageError::malformed(NAME, "its header is missing")) };
    let side = |four: &[u8]| four.iter().fold(0, |side, &byte| side << 8 | u64::from(byte));
    let (width, height) = (side(&w[..4]), side(&w[4..]));
    // Number of channels for grey, true colour, palette, grey with alpha, and colour with alpha.
    let channels = [1, 3, 3, 3, 2, 3, 4][usize::from(*color).min(6)];
    let transparent = chunks(bytes).any(|chunk| chunk[4..8] == *b"tRNS");
    let (stored, is_eight_bit) = (channels + u64::from(transparent), *depth != 16);
    let bytes_per_pixel = match (is_eight_bit, stored) {
        (true, 3) => 3,
        (true, 2 | 4) => stored + 4,
        (true, _) => stored + 3,
        // The decoder needs memory for the pixels and their opacity, with four bytes per value.
        (false, _) => 2 * stored + 16,
    };
    Ok(ImageHeader { width, height, is_eight_bit, bytes_per_pixel, extra_bytes: bytes.len() as u64 })
}

fn decode(bytes: &[u8]) -> Result<Raster, ImageError> {
    codec::raster(NAME, codec::decoder(NAME, ImageFormat::Png, &without_ancillary_chunks(bytes))?)
}

/// Iterates over the chunks of a file. A chunk consists of the length of its content, four letters,
/// the content, and a checksum of four bytes.
fn chunks(bytes: &[u8]) -> impl Iterator<Item = &[u8]> {
    let mut rest = bytes.get(MARK.len()..).unwrap_or_default();
    std::iter::from_fn(move || {
        let length = rest.first_chunk().filter(|_| rest.len() >= 8).copied().map(u32::from_be_bytes)?;
        let (chunk, after) = rest.split_at((length as usize).saturating_add(12).min(rest.len()));
        rest = after;
        Some(chunk)
    })
}

/// Removes the chunks that do not affect the pixels, such as animations, dates, profiles, and
/// texts. Otherwise, a few bytes of profiles or texts could be decompressed to gigabytes. The names
/// of critical chunks begin with an upper-case letter. Source: PNG specification, third edition,
/// sections 5.3 and 5.4.
fn without_ancillary_chunks(bytes: &[u8]) -> Cow<'_, [u8]> {
    let needed = |chunk: &&[u8]| chunk[4].is_ascii_uppercase() || chunk[4..8] == *b"tRNS";
    match chunks(bytes).all(|chunk| needed(&chunk)) {
        true => Cow::Borrowed(bytes),
        false => Cow::Owned(std::iter::once(MARK).chain(chunks(bytes).filter(needed)).flatten().copied().collect()),
    }
}

static ROWS: RowFormat = RowFormat {
    bottom_up: false,
    head: |_| Ok(Vec::new()),
    row: |strip, _, pixels, coverage, out| strip.append(pixels, coverage, if strip.alpha { 4 } else { 3 }, out),
    sixteen_bits: true,
    png: true,
};
