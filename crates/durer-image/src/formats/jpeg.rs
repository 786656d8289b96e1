//! JPEG: eight bits a channel, as photographs and textures are; read only, for it loses what a
//! renderer knows.

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
        // A progressive picture is kept as coefficients of 16 bits for three channels until its
        // last scan.
        Ok(Head { bytes_per_pixel: head.bytes_per_pixel + 6, spare: bytes.len() as u64, ..head })
    },
    decode: |bytes| codec::raster(NAME, codec::decoder(NAME, ImageFormat::Jpeg, bytes)?),
    encode: |_, _, _| Err(ImageError::unsupported(NAME, "writing: choose PNG")),
    rows: None,
};
