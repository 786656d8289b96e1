//! WebP format, lossy and lossless, which can be read but not written.

use super::{Depth, Format, ImageError, ImageHeader, codec};
use ::image::ImageFormat;

const NAME: &str = "WebP";

pub const FORMAT: Format = Format {
    name: NAME,
    extensions: &["webp"],
    depth: Depth::EightBit,
    supports_layers: false,
    max_side: 16384,
    has_signature: |bytes| bytes.starts_with(b"RIFF") && bytes.get(8..12) == Some(b"WEBP"),
    head: |bytes| {
        let head = codec::head(&codec::decoder(NAME, ImageFormat::WebP, bytes)?);
        // The decoder also needs memory for frames, and for separate planes of luma, chroma, and
        // alpha.
        Ok(ImageHeader { bytes_per_pixel: head.bytes_per_pixel + 8, extra_bytes: bytes.len() as u64, ..head })
    },
    decode: |bytes| codec::raster(NAME, codec::decoder(NAME, ImageFormat::WebP, bytes)?),
    encode: |_, _, _| Err(ImageError::unsupported(NAME, "writing is not supported; choose PNG")),
    rows: None,
};
