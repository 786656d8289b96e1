//! Netpbm formats, which are written as binary P6 and read in any of the variants P1 to P7.

use super::{ChannelBits, Depth, Format, RowFormat, RowLayout, codec, rows};
use ::image::ImageFormat;

const NAME: &str = "PPM";

pub const FORMAT: Format = Format {
    name: NAME,
    extensions: &["ppm", "pnm"],
    depth: Depth::EightBit,
    supports_layers: false,
    has_alpha: false,
    max_side: u32::MAX,
    has_signature: |bytes| matches!(bytes, [b'P', b'1'..=b'7', b' ' | b'\t'..=b'\r' | b'#', ..]),
    // The decoder scales samples so that the maximum value of the file becomes 255, or 65535 if
    // that maximum exceeds 255.
    head: |bytes| Ok(codec::head(&codec::decoder(NAME, ImageFormat::Pnm, bytes)?)),
    decode: |bytes| codec::raster(NAME, codec::decoder(NAME, ImageFormat::Pnm, bytes)?),
    encode: |layers, options, out| rows::encode(&ROWS, layers, options, out),
    rows: Some(&ROWS),
};

static ROWS: RowFormat = RowFormat {
    bottom_up: false,
    head: |strip| {
        let most = match strip.display.bits {
            ChannelBits::Eight => 255,
            ChannelBits::Sixteen => 65535,
        };
        Ok(format!("P6\n{} {}\n{most}\n", strip.width, strip.height).into_bytes())
    },
    row: |strip, _, pixels, coverage, out| {
        // The format does not support alpha.
        RowLayout { alpha: false, ..*strip }.append(pixels, coverage, 3, out);
    },
    sixteen_bits: true,
    png: false,
};

#[cfg(test)]
mod tests {
    use crate::{read, read8};
    use durer_bvh::math::Vec3;

    #[test]
    fn white_may_have_any_value() {
        let grey = |bytes: &[u8]| read(bytes, "").unwrap().pixels[0];
        assert_eq!(grey(b"P2 1 1 15 15\n"), Vec3::ONE);
        assert_eq!(grey(b"P5 1 1 255\n\x33"), Vec3::splat(0.2));
        assert_eq!(grey(b"P5 1 1 1000\n\x03\xe8"), Vec3::ONE);
        assert_eq!(grey(b"P1 1 1 0\n"), Vec3::ONE);
        assert_eq!(read8(b"P2 1 1 15 3\n", "").unwrap().pixels, [[51; 3]]);
        assert!(read8(b"P5 1 1 1000\n\x03\xe8", "").is_err());
    }
}
