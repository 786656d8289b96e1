//! Portable Network Graphics: eight bits a channel, lossless.

use super::{Depth, Format, ImageError, Layer, WriteOptions, codec, eight_bit};
use ::image::{ImageFormat, codecs::png::PngEncoder};

const NAME: &str = "PNG";

pub const FORMAT: Format = Format {
    name: NAME,
    extensions: &["png"],
    depth: Depth::EightBit,
    layers: false,
    begins: |bytes| bytes.starts_with(b"\x89PNG\r\n\x1a\n"),
    decode: |bytes| codec::decode(NAME, ImageFormat::Png, bytes),
    encode,
};

fn encode(layers: &[Layer], options: &WriteOptions, out: &mut Vec<u8>) -> Result<(), ImageError> {
    layers.iter().try_for_each(|layer| {
        let size = (layer.image.width, layer.image.height);
        codec::encode(NAME, PngEncoder::new(&mut *out), &eight_bit(layer, options), size)
    })
}
