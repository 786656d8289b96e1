//! Portable float map (PFM): red, green, and blue as little-endian 32-bit floating-point numbers,
//! with the bottom row first.

use super::limits::try_vec;
use super::{Depth, Format, Image, ImageError, ImageHeader, Raster, RowFormat, rows};
use durer_bvh::math::Vec3;

const NAME: &str = "PFM";

pub const FORMAT: Format = Format {
    name: NAME,
    extensions: &["pfm"],
    depth: Depth::Float,
    supports_layers: false,
    has_alpha: false,
    max_side: u32::MAX,
    has_signature: |bytes| matches!(bytes, [b'P', b'F' | b'f', space, ..] if space.is_ascii_whitespace()),
    head,
    decode,
    encode: |layers, options, out| rows::encode(&ROWS, layers, options, out),
    rows: Some(&ROWS),
};

static ROWS: RowFormat = RowFormat {
    bottom_up: true,
    head: |strip| Ok(format!("PF\n{} {}\n-1.0\n", strip.width, strip.height).into_bytes()),
    row: |_, _, pixels, _, out| out.extend(pixels.iter().flat_map(Vec3::to_array).flat_map(f32::to_le_bytes)),
    sixteen_bits: false,
    png: false,
};

/// A PFM file, with its header parsed and the bytes of its samples.
struct PfmFile<'a> {
    width: u32,
    height: u32,
    channels: usize,
    little_endian: bool,
    samples: &'a [u8],
}

fn open(bytes: &[u8]) -> Result<PfmFile<'_>, ImageError> {
    let mut rest = bytes;
    let mut number = |what: &str| {
        let word = next_word(&mut rest).and_then(|word| std::str::from_utf8(word).ok());
        word.ok_or_else(|| ImageError::malformed(NAME, format!("the {what} is missing")))
    };
    let invalid = |what: &str| ImageError::malformed(NAME, format!("the {what} is not a number"));
    let channels = if number("mark")? == "PF" { 3 } else { 1 };
    let width = number("width")?.parse().map_err(|_| invalid("width"))?;
    let height = number("height")?.parse().map_err(|_| invalid("height"))?;
    let scale: f32 = number("scale")?.parse().map_err(|_| invalid("scale"))?;
    Ok(PfmFile { width, height, channels, little_endian: scale < 0.0, samples: rest })
}

fn head(bytes: &[u8]) -> Result<ImageHeader, ImageError> {
    let PfmFile { width, height, .. } = open(bytes)?;
    let bytes_per_pixel = size_of::<Vec3>() as u64;
    Ok(ImageHeader { width: width.into(), height: height.into(), is_eight_bit: false, bytes_per_pixel, extra_bytes: 0 })
}

fn decode(bytes: &[u8]) -> Result<Raster, ImageError> {
    let PfmFile { width, height, channels, little_endian, samples } = open(bytes)?;
    // The size in the header is accepted only if the file contains all the samples.
    let count = width as usize * height as usize;
    let (samples, _) = samples.as_chunks::<4>();
    let samples =
        samples.get(..count * channels).ok_or_else(|| ImageError::malformed(NAME, "it ends before its last pixel"))?;
    let sample = |bytes: [u8; 4]| if little_endian { f32::from_le_bytes(bytes) } else { f32::from_be_bytes(bytes) };
    let color = |pixel: &[[u8; 4]]| match *pixel {
        [r, g, b] => Vec3::new(sample(r), sample(g), sample(b)),
        [grey, ..] => Vec3::splat(sample(grey)),
        [] => Vec3::ZERO,
    };
    let mut pixels = try_vec(count, Vec3::ZERO)?;
    let rows = samples.chunks_exact(width as usize * channels).rev();
    pixels.iter_mut().zip(rows.flat_map(|row| row.chunks_exact(channels))).for_each(|(to, pixel)| *to = color(pixel));
    Ok(Raster::Float(Image { width, height, pixels }, Vec::new()))
}

/// Reads the next word of the header and skips exactly one whitespace character after it, because
/// the samples may start there.
fn next_word<'a>(rest: &mut &'a [u8]) -> Option<&'a [u8]> {
    let text = rest.trim_ascii_start();
    let end = text.iter().position(u8::is_ascii_whitespace)?;
    *rest = &text[end + 1..];
    Some(&text[..end])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::read;
    use crate::{Layer, WriteOptions};

    #[test]
    fn the_bottom_row_comes_first() {
        let image = Image::from_pixels(1, 2, vec![Vec3::X, Vec3::new(f32::NAN, -2.0, 1e30)]).unwrap();
        let mut out = Vec::new();
        FORMAT.write(&[Layer::color("", image)], &WriteOptions::default(), &mut out).unwrap();
        let mut expected = b"PF\n1 2\n-1.0\n".to_vec();
        for value in [f32::NAN, -2.0, 1e30, 1.0, 0.0, 0.0] {
            expected.extend(value.to_le_bytes());
        }
        assert_eq!(out, expected);
        assert_eq!(read(&out, "").unwrap().pixels[0], Vec3::X);
    }

    #[test]
    fn big_endian_grey_is_read() {
        // The first byte of the samples looks like whitespace but is part of a sample.
        let mut bytes = b"Pf 2 1 1.0\n".to_vec();
        let first = f32::from_be_bytes([0x0a, 0x20, 0, 0]);
        bytes.extend(first.to_be_bytes());
        bytes.extend(2.5f32.to_be_bytes());
        assert_eq!(read(&bytes, "x").unwrap().pixels, [Vec3::splat(first), Vec3::splat(2.5)]);
    }

    #[test]
    fn a_declared_size_is_not_believed() {
        assert!(matches!(read(b"PF 2000 2000 -1\n", ""), Err(ImageError::Malformed { .. })));
        assert!(matches!(read(b"PF 99999 99999 -1\n", ""), Err(ImageError::TooLarge { .. })));
        assert!(matches!(read(b"PF 0 5 -1\n", ""), Err(ImageError::InvalidSize { .. })));
        assert!(read(b"PF -1 5 -1\n", "").is_err());
    }
}
