//! Example of a picture format: farbfeld has a signature of eight bytes, width and height, and 16
//! bits per channel. Source: farbfeld(5), suckless.org.

use super::{Depth, Format, ImageHeader, Raster};
use crate::{Image, ImageError};
use durer_bvh::math::Vec3;

const NAME: &str = "farbfeld";

fn sizes(bytes: &[u8]) -> Result<[u32; 2], ImageError> {
    let side = |at: usize| bytes.get(at..at + 4).and_then(|four| four.try_into().ok()).map(u32::from_be_bytes);
    side(8).zip(side(12)).map(|(width, height)| [width, height]).ok_or_else(|| ImageError::malformed(NAME, "the file is too short"))
}

/// Picture format of farbfeld files.
pub const FORMAT: Format = Format {
    name: NAME,
    extensions: &["ff"],
    depth: Depth::Float,
    supports_layers: false,
    has_alpha: false,
    max_side: u32::MAX,
    has_signature: |bytes| bytes.starts_with(b"farbfeld"),
    head: |bytes| {
        let [width, height] = sizes(bytes)?.map(u64::from);
        Ok(ImageHeader { width, height, is_eight_bit: false, bytes_per_pixel: 12, extra_bytes: 0 })
    },
    decode: |bytes| {
        let [width, height] = sizes(bytes)?;
        let channel = |pixel: &[u8], i: usize| f32::from(u16::from_be_bytes([pixel[2 * i], pixel[2 * i + 1]])) / 65535.0;
        let pixels = bytes[16..].chunks_exact(8).map(|pixel| Vec3::new(channel(pixel, 0), channel(pixel, 1), channel(pixel, 2)));
        Ok(Raster::Float(Image::from_pixels(width, height, pixels.collect())?, Vec::new()))
    },
    encode: |layers, _, out| {
        let image = &layers[0].image;
        out.extend(b"farbfeld");
        out.extend(image.width.to_be_bytes());
        out.extend(image.height.to_be_bytes());
        for pixel in &image.pixels {
            for channel in pixel.extend(1.0).to_array() {
                out.extend(((65535.0 * channel.clamp(0.0, 1.0)).round() as u16).to_be_bytes());
            }
        }
        Ok(())
    },
    rows: None,
};
