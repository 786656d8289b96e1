//! Adapters for the decoders and encoders of the `image` crate.

use super::limits::try_vec;
use super::{Image, Image8, ImageError, ImageHeader, Layer, Raster, WriteOptions, eight_bit};
use ::image::{ColorType, ExtendedColorType, ImageDecoder, ImageEncoder, ImageFormat, ImageReader};
use durer_bvh::math::Vec3;
use std::io::Cursor;

/// Creates a decoder for a format of the `image` crate. The decoder reads only the header, so no
/// limits are needed.
pub fn decoder<'a>(
    name: &'static str,
    format: ImageFormat,
    bytes: &'a [u8],
) -> Result<impl ImageDecoder + 'a, ImageError> {
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    reader.no_limits();
    reader.into_decoder().map_err(|error| ImageError::malformed(name, error))
}

/// Converts the header that a decoder has read.
pub fn head(decoder: &impl ImageDecoder) -> ImageHeader {
    let ((width, height), color) = (decoder.dimensions(), decoder.color_type());
    let stored: u64 = color.bytes_per_pixel().into();
    let is_eight_bit = color.bytes_per_pixel() == color.channel_count();
    ImageHeader {
        width: width.into(),
        height: height.into(),
        is_eight_bit,
        bytes_per_pixel: match (color, is_eight_bit) {
            (ColorType::Rgb8, _) => stored,
            (_, true) => stored + size_of::<[u8; 3]>() as u64 + u64::from(color.has_alpha()),
            (_, false) => stored + size_of::<[f32; 4]>() as u64,
        },
        extra_bytes: 0,
    }
}

/// Decodes the pixels of a picture. Grey becomes three equal channels, alpha is stored separately,
/// and 16-bit values are scaled to the range [0, 1].
pub fn raster(name: &'static str, decoder: impl ImageDecoder) -> Result<Raster, ImageError> {
    let ((width, height), color) = (decoder.dimensions(), decoder.color_type());
    let count = width as usize * height as usize;
    let malformed = |error| ImageError::malformed(name, error);
    if color == ColorType::Rgb8 {
        let mut pixels = try_vec(count, [0; 3])?;
        decoder.read_image(pixels.as_flattened_mut()).map_err(malformed)?;
        return Ok(Raster::Eight(Image8 { width, height, pixels, alpha: Vec::new() }));
    }
    let mut bytes = try_vec(count * usize::from(color.bytes_per_pixel()), 0)?;
    decoder.read_image(&mut bytes).map_err(malformed)?;
    let rgb = |pixel: &[u8]| if pixel.len() < 3 { [pixel[0]; 3] } else { [pixel[0], pixel[1], pixel[2]] };
    let sixteen = |bytes: &[u8]| f32::from(u16::from_ne_bytes([bytes[0], bytes[1]])) / 65535.0;
    let float = |bytes: &[u8]| f32::from_ne_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
    let pixels = bytes.chunks_exact(color.bytes_per_pixel().into());
    Ok(match color {
        ColorType::L8 | ColorType::La8 | ColorType::Rgba8 => {
            let alpha = match color.has_alpha() {
                true => filled(count, pixels.clone().map(|pixel| pixel[pixel.len() - 1]))?,
                false => Vec::new(),
            };
            Raster::Eight(Image8 { width, height, pixels: filled(count, pixels.map(rgb))?, alpha })
        }
        ColorType::L16 | ColorType::La16 | ColorType::Rgb16 | ColorType::Rgba16 => {
            let alpha = match color.has_alpha() {
                true => filled(count, pixels.clone().map(|pixel| sixteen(&pixel[pixel.len() - 2..])))?,
                false => Vec::new(),
            };
            let pixel = |p: &[u8]| match p.len() < 6 {
                true => Vec3::splat(sixteen(p)),
                false => Vec3::new(sixteen(p), sixteen(&p[2..]), sixteen(&p[4..])),
            };
            Raster::Sixteen(Image { width, height, pixels: filled(count, pixels.map(pixel))? }, alpha)
        }
        ColorType::Rgb32F | ColorType::Rgba32F => {
            let pixel = |p: &[u8]| Vec3::new(float(p), float(&p[4..]), float(&p[8..]));
            Raster::Float(Image { width, height, pixels: filled(count, pixels.map(pixel))? }, Vec::new())
        }
        _ => return Err(ImageError::unsupported(name, format!("pixels of the type {color:?} are not supported"))),
    })
}

fn filled<T>(count: usize, items: impl Iterator<Item = T>) -> Result<Vec<T>, ImageError> {
    let mut all = Vec::new();
    all.try_reserve_exact(count).map_err(|_| ImageError::out_of_memory(count, size_of::<T>()))?;
    all.extend(items.take(count));
    Ok(all)
}

/// Encodes the colours of a layer with 8 bits per channel.
pub fn encode_rgb(
    name: &'static str,
    encoder: impl ImageEncoder,
    layer: &Layer,
    options: &WriteOptions,
) -> Result<(), ImageError> {
    let size = (layer.image.width, layer.image.height);
    encode(name, encoder, &eight_bit(layer, options), ExtendedColorType::Rgb8, size)
}

/// Encodes 8-bit pixels as RGB or RGBA.
pub fn encode(
    name: &'static str,
    encoder: impl ImageEncoder,
    bytes: &[u8],
    color: ExtendedColorType,
    (width, height): (u32, u32),
) -> Result<(), ImageError> {
    encoder.write_image(bytes, width, height, color).map_err(|error| ImageError::unsupported(name, error))
}
