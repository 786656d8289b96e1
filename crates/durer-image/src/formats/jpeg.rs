//! JPEG: 8 bits per channel, for photographs and textures. Read only, since it is lossy.

use super::{Depth, Format, Head, ImageError, codec};
use ::image::ImageFormat;

const NAME: &str = "JPEG";

pub const FORMAT: Format = Format {
    name: NAME,
    extensions: &["jpg", "jpeg"],
    depth: Depth::EightBit,
    layers: false,
    most_side: 65535,
    begins: |bytes| bytes.starts_with(b"\xff\xd8\xff"),
    head: |bytes| {
        let head = codec::head(&codec::decoder(NAME, ImageFormat::Jpeg, bytes)?);
        // The decoder of a progressive picture keeps 16-bit coefficients of three channels until
        // the last scan.
        Ok(Head { bytes_per_pixel: head.bytes_per_pixel + 6, spare: bytes.len() as u64, ..head })
    },
    decode: |bytes| codec::raster(NAME, codec::decoder(NAME, ImageFormat::Jpeg, bytes)?),
    encode: |_, _, _| Err(ImageError::unsupported(NAME, "writing is not supported: choose PNG")),
    rows: None,
};
