//! Pictures from memory.

use super::formats::{Format, Head, Raster, recognise};
use super::limits::declared_count;
use super::{Depth, Image, Image8, ImageError, decode_linear, decode_srgb};
use durer_bvh::math::Vec3;

/// A picture in a file of which nothing was read but the head: what is too large is refused before
/// it takes memory.
pub struct Encoded<'a> {
    format: &'static Format,
    bytes: &'a [u8],
    head: Head,
    count: usize,
}

impl<'a> Encoded<'a> {
    /// Finds out the format by the content, or failing that by the extension of `name_hint`, and
    /// reads the head.
    ///
    /// # Errors
    /// [`ImageError::Unrecognised`], [`ImageError::Malformed`], [`ImageError::Unsupported`],
    /// [`ImageError::TooLarge`] for more than [`pixel_limit`](super::pixel_limit) pixels, and
    /// [`ImageError::Size`] for a picture without pixels.
    pub fn open(bytes: &'a [u8], name_hint: &str) -> Result<Self, ImageError> {
        let format = recognise(bytes, name_hint)?;
        let head = format.head(bytes)?;
        let count = declared_count(head.width, head.height, bytes.len())?;
        Ok(Encoded { format, bytes, head, count })
    }

    /// Pixels in a row, and rows.
    pub fn size(&self) -> (usize, usize) {
        (self.head.width as usize, self.head.height as usize)
    }

    /// What a channel of its format is.
    pub fn depth(&self) -> Depth {
        self.format.depth
    }

    /// Bytes of memory that reading it as it is takes; those of its file are not among them.
    pub fn needed8(&self) -> u64 {
        (self.count as u64).saturating_mul(self.head.bytes_per_pixel).saturating_add(self.head.spare)
    }

    /// Bytes of memory that reading it as floating-point numbers takes.
    pub fn needed(&self) -> u64 {
        let floats = if self.head.eight { self.count * size_of::<Vec3>() } else { 0 };
        self.needed8().saturating_add(floats as u64)
    }

    /// Bytes of memory that it takes from its file to where its values stay: they are copied there
    /// once.
    pub fn needed_raster(&self) -> u64 {
        let texel = if self.head.eight { size_of::<[u8; 4]>() } else { size_of::<[f32; 4]>() };
        self.needed8().max((2 * self.count * texel) as u64)
    }

    /// Its values as they stand in an eight-bit file.
    ///
    /// # Errors
    /// [`ImageError::NotEightBit`], [`ImageError::Memory`] where it needs more bytes than allowed,
    /// and those of [`Encoded::open`].
    pub fn read8(&self, memory: u64) -> Result<Image8, ImageError> {
        if !self.head.eight {
            return Err(ImageError::NotEightBit);
        }
        match self.decode(self.needed8(), memory)? {
            Raster::Eight(image) => Ok(image),
            Raster::Sixteen(..) | Raster::Float(..) => Err(ImageError::NotEightBit),
        }
    }

    /// Its values as they stand in the file.
    ///
    /// # Errors
    /// [`ImageError::Memory`] where it needs more bytes than allowed, and those of
    /// [`Encoded::open`].
    pub fn read_raster(&self, memory: u64) -> Result<Raster, ImageError> {
        self.decode(self.needed_raster(), memory)
    }

    /// Its pixels, with a meaning for each of the values of eight bits. Numbers of floating-point
    /// formats come as they are.
    ///
    /// # Errors
    /// Those of [`Encoded::read8`].
    pub fn read(&self, memory: u64, decode: fn(u8) -> f32) -> Result<Image, ImageError> {
        self.read_for(0, memory, decode)
    }

    /// The same where what is made of the pixels takes so many bytes more for each of them.
    ///
    /// # Errors
    /// Those of [`Encoded::read`].
    pub fn read_for(&self, more: usize, memory: u64, decode: fn(u8) -> f32) -> Result<Image, ImageError> {
        let later = (self.count as u64).saturating_mul((size_of::<Vec3>() + more) as u64);
        Ok(match self.decode(self.needed().max(later), memory)? {
            Raster::Sixteen(image, _) | Raster::Float(image, _) => image,
            Raster::Eight(Image8 { width, height, pixels, .. }) => {
                let table: [f32; 256] = std::array::from_fn(|value| decode(value as u8));
                let mut all = Vec::new();
                all.try_reserve_exact(pixels.len())
                    .map_err(|_| ImageError::no_room(pixels.len(), size_of::<Vec3>()))?;
                all.extend(pixels.into_iter().map(|pixel| Vec3::from(pixel.map(|value| table[usize::from(value)]))));
                Image { width, height, pixels: all }
            }
        })
    }

    fn decode(&self, needed: u64, allowed: u64) -> Result<Raster, ImageError> {
        match needed <= allowed {
            true => self.format.decode(self.bytes),
            false => Err(ImageError::Memory { width: self.head.width, height: self.head.height, needed, allowed }),
        }
    }
}

/// Reads a picture: by its content, or failing that by the extension of `name_hint`.
///
/// Eight-bit values become 255ths without a curve, as the course takes its textures; see
/// [`read_srgb`]. Numbers of floating-point formats come as they are, NaN and infinities too. Alpha
/// is dropped. At most [`pixel_limit`](super::pixel_limit) pixels are read; [`Encoded`] sets other
/// limits.
///
/// # Errors
/// Those of [`Encoded::open`].
pub fn read(bytes: &[u8], name_hint: &str) -> Result<Image, ImageError> {
    Encoded::open(bytes, name_hint)?.read(u64::MAX, decode_linear)
}

/// As [`read`], but eight-bit values are taken for sRGB and made linear.
///
/// # Errors
/// Those of [`read`].
pub fn read_srgb(bytes: &[u8], name_hint: &str) -> Result<Image, ImageError> {
    Encoded::open(bytes, name_hint)?.read(u64::MAX, decode_srgb)
}

/// Reads the values of an eight-bit picture, for exact comparison.
///
/// # Errors
/// Those of [`read`], and [`ImageError::NotEightBit`].
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
