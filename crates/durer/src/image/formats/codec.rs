//! Decoders and encoders of the `image` crate, with our limits and errors.

use super::limits::{declared_count, pixel_limit};
use super::{Image, Image8, ImageError, Raster};
use crate::math::Vec3;
use ::image::{DynamicImage, ExtendedColorType, ImageDecoder, ImageEncoder, ImageFormat, ImageReader, Limits};
use std::io::Cursor;

/// Decodes a file of a format that the crate reads.
pub fn decode(name: &'static str, format: ImageFormat, bytes: &[u8]) -> Result<Raster, ImageError> {
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    reader.limits(memory_limits(bytes.len()));
    let decoder = reader.into_decoder().map_err(|error| ImageError::malformed(name, error))?;
    Ok(raster(picture(name, decoder, bytes.len())?))
}

/// Decodes the pixels, once the declared size is found to be possible.
pub fn picture(name: &'static str, decoder: impl ImageDecoder, bytes: usize) -> Result<DynamicImage, ImageError> {
    let (width, height) = decoder.dimensions();
    declared_count(width.into(), height.into(), bytes)?;
    DynamicImage::from_decoder(decoder).map_err(|error| ImageError::malformed(name, error))
}

/// At most 16 bytes a pixel, the most that a decoded pixel takes, and some for what a file says besides.
fn memory_limits(bytes: usize) -> Limits {
    let mut limits = Limits::default();
    (limits.max_image_width, limits.max_image_height) = (None, None);
    limits.max_alloc = Some(pixel_limit(bytes) * 16 + (1 << 20));
    limits
}

/// Grey becomes three equal channels, alpha is dropped.
pub fn raster(picture: DynamicImage) -> Raster {
    use DynamicImage::{ImageLuma8, ImageLumaA8, ImageRgb8, ImageRgba8};
    let (width, height) = (picture.width(), picture.height());
    match picture {
        ImageLuma8(_) | ImageLumaA8(_) | ImageRgb8(_) | ImageRgba8(_) => {
            let pixels = picture.into_rgb8().into_raw().as_chunks::<3>().0.to_vec();
            Raster::Eight(Image8 { width, height, pixels })
        }
        _ => {
            let channels = picture.into_rgb32f().into_raw();
            let pixels = channels.as_chunks::<3>().0.iter().map(|&pixel| Vec3::from(pixel)).collect();
            Raster::Float(Image { width, height, pixels })
        }
    }
}

/// Encodes eight-bit red, green and blue, or those and alpha.
pub fn encode(
    name: &'static str,
    encoder: impl ImageEncoder,
    bytes: &[u8],
    color: ExtendedColorType,
    (width, height): (u32, u32),
) -> Result<(), ImageError> {
    encoder.write_image(bytes, width, height, color).map_err(|error| ImageError::unsupported(name, error))
}
