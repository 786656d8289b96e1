//! Pictures from memory.

use super::formats::{Raster, recognise};
use super::{Image, Image8, ImageError, decode_linear, decode_srgb};

/// Reads a picture: by its content, or failing that by the extension of `name_hint`.
///
/// Eight-bit values become 255ths without a curve, as the course takes its textures; see [`read_srgb`]. Numbers of
/// floating-point formats come as they are, NaN and infinities too. Alpha is dropped. At most
/// [`pixel_limit`](super::pixel_limit) pixels are read.
///
/// # Errors
/// [`ImageError::Unrecognised`], [`ImageError::Malformed`], [`ImageError::Unsupported`], [`ImageError::TooLarge`],
/// and [`ImageError::Size`] for a picture without pixels.
pub fn read(bytes: &[u8], name_hint: &str) -> Result<Image, ImageError> {
    decoded(bytes, name_hint, decode_linear)
}

/// As [`read`], but eight-bit values are taken for sRGB and made linear.
///
/// # Errors
/// Those of [`read`].
pub fn read_srgb(bytes: &[u8], name_hint: &str) -> Result<Image, ImageError> {
    decoded(bytes, name_hint, decode_srgb)
}

/// Reads the values of an eight-bit picture, for exact comparison.
///
/// # Errors
/// Those of [`read`], and [`ImageError::NotEightBit`].
pub fn read8(bytes: &[u8], name_hint: &str) -> Result<Image8, ImageError> {
    match recognise(bytes, name_hint)?.read(bytes)? {
        Raster::Eight(image) => Ok(image),
        Raster::Float(_) => Err(ImageError::NotEightBit),
    }
}

fn decoded(bytes: &[u8], name: &str, decode: fn(u8) -> f32) -> Result<Image, ImageError> {
    Ok(match recognise(bytes, name)?.read(bytes)? {
        Raster::Float(image) => image,
        Raster::Eight(Image8 { width, height, pixels }) => {
            let table: [f32; 256] = std::array::from_fn(|value| decode(value as u8));
            let pixels = pixels.into_iter().map(|pixel| pixel.map(|value| table[value as usize]).into()).collect();
            Image { width, height, pixels }
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vec3;

    const GREY: &[u8] = b"P6 1 1 255\n\x00\x80\xff";

    #[test]
    fn eight_bits_with_and_without_curve() {
        assert_eq!(read(GREY, "").unwrap().pixels, [Vec3::new(0.0, 128.0 / 255.0, 1.0)]);
        assert_eq!(read_srgb(GREY, "").unwrap().pixels, [Vec3::new(0.0, decode_srgb(128), 1.0)]);
        assert_eq!(read8(GREY, "").unwrap().pixels, [[0, 128, 255]]);
    }

    #[test]
    fn content_counts_more_than_the_name() {
        assert!(read(GREY, "x.png").is_ok());
        assert!(matches!(read(b"hello", "x.png"), Err(ImageError::Malformed { format: "PNG", .. })));
        assert!(matches!(read(b"hello", "x.txt"), Err(ImageError::Unrecognised { .. })));
        assert!(read(b"", "").is_err());
    }
}
