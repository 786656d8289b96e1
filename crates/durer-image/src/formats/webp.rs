//! WebP format. Lossy and lossless files can be read, and lossless files are written.

use super::{Depth, Format, ImageError, ImageHeader, Layer, RowLayout, WriteOptions, codec};
use ::image::codecs::webp::WebPEncoder;
use ::image::{ExtendedColorType, ImageFormat};

const NAME: &str = "WebP";

pub const FORMAT: Format = Format {
    name: NAME,
    extensions: &["webp"],
    depth: Depth::EightBit,
    supports_layers: false,
    has_alpha: true,
    max_side: 16384,
    has_signature: |bytes| bytes.starts_with(b"RIFF") && bytes.get(8..12) == Some(b"WEBP"),
    head: |bytes| {
        let head = codec::head(&codec::decoder(NAME, ImageFormat::WebP, bytes)?);
        // The decoder also needs memory for frames, and for separate planes of luma, chroma, and
        // alpha.
        Ok(ImageHeader { bytes_per_pixel: head.bytes_per_pixel + 8, extra_bytes: bytes.len() as u64, ..head })
    },
    decode: |bytes| codec::raster(NAME, codec::decoder(NAME, ImageFormat::WebP, bytes)?),
    encode,
    rows: None,
};

fn encode(layers: &[Layer], options: &WriteOptions, out: &mut Vec<u8>) -> Result<(), ImageError> {
    layers.iter().try_for_each(|layer| {
        let (size, encoder) = ((layer.image.width, layer.image.height), WebPEncoder::new_lossless(&mut *out));
        let Some(coverage) = &layer.coverage else { return codec::encode_rgb(NAME, encoder, layer, options) };
        let mut bytes = Vec::with_capacity(4 * layer.image.pixels.len());
        RowLayout::of(layer, options).eight_bit(&layer.image.pixels, coverage, |rgba| bytes.extend(rgba));
        codec::encode(NAME, encoder, &bytes, ExtendedColorType::Rgba8, size)
    })
}
