//! Truevision Targa format, as the programs of the course write it: uncompressed 24-bit true colour
//! with the bottom row first. Layers with coverage have 32 bits per pixel, including alpha.

use super::{Depth, Format, ImageError, ImageHeader, RowFormat, codec, rows};
use ::image::ImageFormat;

const NAME: &str = "TGA";

pub const FORMAT: Format = Format {
    name: NAME,
    extensions: &["tga"],
    depth: Depth::EightBit,
    supports_layers: false,
    has_alpha: true,
    max_side: 65535,
    // The format has no signature, so it is recognised only by its extension.
    has_signature: |_| false,
    head: |bytes| {
        let head = codec::head(&codec::decoder(NAME, ImageFormat::Tga, bytes)?);
        // For palettes and 16-bit pixels, the decoder needs memory for a copy of the pixels.
        Ok(ImageHeader { bytes_per_pixel: head.bytes_per_pixel + 2, ..head })
    },
    decode: |bytes| codec::raster(NAME, codec::decoder(NAME, ImageFormat::Tga, bytes)?),
    encode: |layers, options, out| rows::encode(&ROWS, layers, options, out),
    rows: Some(&ROWS),
};

/// The image type is uncompressed true colour.
const TRUE_COLOR: u8 = 2;

static ROWS: RowFormat = RowFormat {
    bottom_up: true,
    head: |strip| {
        let side = |side: u32| {
            u16::try_from(side).map_err(|_| {
                ImageError::unsupported(
                    NAME,
                    "sides of more than \
                                                                                              65535 pixels are not \
                                                                                              supported",
                )
            })
        };
        let ([w0, w1], [h0, h1]) = (side(strip.width)?.to_le_bytes(), side(strip.height)?.to_le_bytes());
        let (bits, alpha_bits) = if strip.alpha { (32, 8) } else { (24, 0) };
        // There is no image ID and no palette, and the origin is at the lower left.
        Ok(vec![0, 0, TRUE_COLOR, 0, 0, 0, 0, 0, 0, 0, 0, 0, w0, w1, h0, h1, bits, alpha_bits])
    },
    row: |strip, _, pixels, coverage, out| {
        let channels = if strip.alpha { 4 } else { 3 };
        strip.eight_bit(pixels, coverage, |[r, g, b, a]| out.extend(&[b, g, r, a][..channels]));
    },
    sixteen_bits: false,
    png: false,
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Image;
    use crate::{Layer, WriteOptions};
    use durer_bvh::math::Vec3;

    #[test]
    fn bytes_of_a_file() {
        let image = Image::from_pixels(1, 2, vec![Vec3::X, Vec3::Z]).unwrap();
        let mut out = Vec::new();
        FORMAT.write(&[Layer::color("", image)], &WriteOptions::default(), &mut out).unwrap();
        assert_eq!(out, [0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 2, 0, 24, 0, 255, 0, 0, 0, 0, 255]);
    }

    #[test]
    fn bytes_of_a_file_with_alpha() {
        let image = Image::from_pixels(1, 2, vec![Vec3::ZERO, Vec3::X * 0.5]).unwrap();
        let mut out = Vec::new();
        let layer = Layer::color("", image).with_coverage(vec![0.0, 0.5]);
        FORMAT.write(&[layer], &WriteOptions::default(), &mut out).unwrap();
        assert_eq!(out[..18], [0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 2, 0, 32, 8]);
        // Alpha is straight, so the colour of the pixel that is half covered is full red.
        assert_eq!(out[18..], [0, 0, 255, 128, 0, 0, 0, 0]);
    }

    #[test]
    fn a_side_is_at_most_65535() {
        let image = Image::new(65536, 1, Vec3::ZERO).unwrap();
        assert!(FORMAT.write(&[Layer::color("", image)], &WriteOptions::default(), &mut Vec::new()).is_err());
    }
}
