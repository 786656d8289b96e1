//! Decodes pictures from the bytes of a file.

use super::formats::{Format, ImageHeader, Raster, recognise};
use super::limits::declared_count;
use super::{Depth, Image, Image8, ImageError, decode_linear, decode_srgb};
use durer_bvh::math::Vec3;

/// A picture file of which only the header has been read, so that its size and the memory it needs
/// are known before it is decoded.
pub struct Encoded<'a> {
    format: &'static Format,
    bytes: &'a [u8],
    head: ImageHeader,
    count: usize,
}

impl<'a> Encoded<'a> {
    /// Reads the header of a file. The format is determined by the content or, if the content does
    /// not identify it, by the extension of `name_hint`.
    ///
    /// # Errors
    /// Returns [`ImageError::Unrecognised`], [`ImageError::Malformed`],
    /// [`ImageError::Unsupported`], [`ImageError::TooLarge`] if there are more than
    /// [`pixel_limit`](super::pixel_limit) pixels, or [`ImageError::InvalidSize`] for a picture
    /// without pixels.
    pub fn open(bytes: &'a [u8], name_hint: &str) -> Result<Self, ImageError> {
        let format = recognise(bytes, name_hint)?;
        let head = format.head(bytes)?;
        let count = declared_count(head.width, head.height, bytes.len())?;
        Ok(Encoded { format, bytes, head, count })
    }

    /// Width and height in pixels.
    pub fn size(&self) -> (usize, usize) {
        (self.head.width as usize, self.head.height as usize)
    }

    /// Kind of values that each channel has in the file format.
    pub fn depth(&self) -> Depth {
        self.format.depth
    }

    /// Number of bytes of memory that [`Encoded::read8`] needs in addition to the bytes of the
    /// file.
    pub fn memory_needed8(&self) -> u64 {
        (self.count as u64).saturating_mul(self.head.bytes_per_pixel).saturating_add(self.head.extra_bytes)
    }

    /// Number of bytes of memory that [`Encoded::read`] needs.
    pub fn memory_needed(&self) -> u64 {
        let floats = if self.head.is_eight_bit { self.count * size_of::<Vec3>() } else { 0 };
        self.memory_needed8().saturating_add(floats as u64)
    }

    /// Number of bytes of memory that [`Encoded::read_raster`] needs, including one copy of the
    /// values made by the caller.
    pub fn memory_needed_raster(&self) -> u64 {
        let texel = if self.head.is_eight_bit { size_of::<[u8; 4]>() } else { size_of::<[f32; 4]>() };
        self.memory_needed8().max((2 * self.count * texel) as u64)
    }

    /// Decodes the values of an 8-bit file.
    ///
    /// # Errors
    /// Returns [`ImageError::NotEightBit`], [`ImageError::MemoryLimit`] if decoding needs more than
    /// `memory` bytes, or the errors of [`Encoded::open`].
    pub fn read8(&self, memory: u64) -> Result<Image8, ImageError> {
        if !self.head.is_eight_bit {
            return Err(ImageError::NotEightBit);
        }
        match self.decode(self.memory_needed8(), memory)? {
            Raster::Eight(image) => Ok(image),
            Raster::Sixteen(..) | Raster::Float(..) => Err(ImageError::NotEightBit),
        }
    }

    /// Decodes the values as they are stored in the file.
    ///
    /// # Errors
    /// Returns [`ImageError::MemoryLimit`] if decoding needs more than `memory` bytes, or the
    /// errors of [`Encoded::open`].
    pub fn read_raster(&self, memory: u64) -> Result<Raster, ImageError> {
        self.decode(self.memory_needed_raster(), memory)
    }

    /// Decodes the pixels. 8-bit values are converted by `decode`, and other values are not
    /// changed.
    ///
    /// # Errors
    /// Returns the errors of [`Encoded::read8`].
    pub fn read(&self, memory: u64, decode: fn(u8) -> f32) -> Result<Image, ImageError> {
        self.read_for(0, memory, decode)
    }

    /// Decodes the pixels as [`Encoded::read`] does. The memory limit must also allow `more` bytes
    /// per pixel for later processing.
    ///
    /// # Errors
    /// Returns the errors of [`Encoded::read`].
    pub fn read_for(&self, more: usize, memory: u64, decode: fn(u8) -> f32) -> Result<Image, ImageError> {
        let later = (self.count as u64).saturating_mul((size_of::<Vec3>() + more) as u64);
        Ok(match self.decode(self.memory_needed().max(later), memory)? {
            Raster::Sixteen(image, _) | Raster::Float(image, _) => image,
            Raster::Eight(Image8 { width, height, pixels, .. }) => {
                let table: [f32; 256] = std::array::from_fn(|value| decode(value as u8));
                let mut all = Vec::new();
                all.try_reserve_exact(pixels.len())
                    .map_err(|_| ImageError::out_of_memory(pixels.len(), size_of::<Vec3>()))?;
                all.extend(pixels.into_iter().map(|pixel| Vec3::from(pixel.map(|value| table[usize::from(value)]))));
                Image { width, height, pixels: all }
            }
        })
    }

    fn decode(&self, needed: u64, allowed: u64) -> Result<Raster, ImageError> {
        match needed <= allowed {
            true => self.format.decode(self.bytes),
            false => Err(ImageError::MemoryLimit { width: self.head.width, height: self.head.height, needed, allowed }),
        }
    }
}

/// Decodes a picture. The format is determined by the content or, if the content does not identify
/// it, by the extension of `name_hint`.
///
/// 8-bit values are divided by 255 without applying a transfer function, as the course does for
/// textures; see also [`read_srgb`]. Values in floating-point formats are not changed, including
/// NaN and infinities. Alpha is discarded. At most [`pixel_limit`](super::pixel_limit) pixels are
/// read. Use [`Encoded`] to set other limits.
///
/// # Errors
/// Returns the errors of [`Encoded::open`].
pub fn read(bytes: &[u8], name_hint: &str) -> Result<Image, ImageError> {
    Encoded::open(bytes, name_hint)?.read(u64::MAX, decode_linear)
}

/// Decodes a picture as [`read`] does, but converts 8-bit values from sRGB to linear values.
///
/// # Errors
/// Returns the errors of [`read`].
pub fn read_srgb(bytes: &[u8], name_hint: &str) -> Result<Image, ImageError> {
    Encoded::open(bytes, name_hint)?.read(u64::MAX, decode_srgb)
}

/// Decodes the stored values of an 8-bit picture, for exact comparisons.
///
/// # Errors
/// Returns the errors of [`read`], and [`ImageError::NotEightBit`] if the picture has more than 8
/// bits per channel.
pub fn read8(bytes: &[u8], name_hint: &str) -> Result<Image8, ImageError> {
    Encoded::open(bytes, name_hint)?.read8(u64::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_bvh::math::Vec3;

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
