//! Portable Network Graphics: eight bits a channel, lossless; with alpha where the camera does not see everything.

use super::{Depth, Format, ImageError, Layer, WriteOptions, codec, eight_bit, eight_bit_alpha};
use ::image::{ExtendedColorType, ImageFormat, codecs::png::PngEncoder};

const NAME: &str = "PNG";

pub const FORMAT: Format = Format {
    name: NAME,
    extensions: &["png"],
    depth: Depth::EightBit,
    layers: false,
    most_side: u32::MAX,
    begins: |bytes| bytes.starts_with(b"\x89PNG\r\n\x1a\n"),
    decode: |bytes| codec::decode(NAME, ImageFormat::Png, bytes),
    encode,
};

fn encode(layers: &[Layer], options: &WriteOptions, out: &mut Vec<u8>) -> Result<(), ImageError> {
    layers.iter().try_for_each(|layer| {
        let size = (layer.image.width, layer.image.height);
        let encoder = PngEncoder::new(&mut *out);
        match eight_bit_alpha(layer, options) {
            Some(rgba) => codec::encode(NAME, encoder, &rgba, ExtendedColorType::Rgba8, size),
            None => codec::encode(NAME, encoder, &eight_bit(layer, options), ExtendedColorType::Rgb8, size),
        }
    })
}
