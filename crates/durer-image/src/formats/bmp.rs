//! Windows bitmap format, with 24 bits per pixel and the bottom row first.

use super::{Depth, Format, ImageError, Layer, WriteOptions, codec};
use ::image::{ImageFormat, codecs::bmp::BmpEncoder};

const NAME: &str = "BMP";

pub const FORMAT: Format = Format {
    name: NAME,
    extensions: &["bmp"],
    depth: Depth::EightBit,
    supports_layers: false,
    has_alpha: false,
    max_side: u32::MAX,
    has_signature: |bytes| bytes.starts_with(b"BM"),
    head: |bytes| Ok(codec::head(&codec::decoder(NAME, ImageFormat::Bmp, bytes)?)),
    decode: |bytes| codec::raster(NAME, codec::decoder(NAME, ImageFormat::Bmp, bytes)?),
    encode,
    rows: None,
};

fn encode(layers: &[Layer], options: &WriteOptions, out: &mut Vec<u8>) -> Result<(), ImageError> {
    // The encoder fails for rows of 2^31 / 3 or more pixels because it cannot pad them.
    layers.iter().try_for_each(|layer| codec::encode_rgb(NAME, BmpEncoder::new(&mut *out), layer, options))
}
