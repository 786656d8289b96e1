//! Reads and writes pictures, and saves files safely.
//!
//! Pictures in memory contain linear floating-point values, which [`Transfer`] converts to 8-bit
//! values. The table [`FORMATS`] lists the file formats. [`read()`] decodes the bytes of a file,
//! and [`save()`] writes bytes to a file.

mod color;
pub mod compare;
mod content;
pub mod denoise;
mod display;
mod error;
mod exposure;
mod formats;
mod half;
mod limits;
pub mod panics;
mod read;
#[cfg(feature = "fs")]
mod save;
#[cfg(feature = "fs")]
mod temporary;
mod transfer;

#[cfg(test)]
mod conformance;

pub use color::{Color, LUMINANCE, LUMINANCE_F64};
pub use content::Content;
pub use display::{ChannelBits, Display, Tone};
pub use error::ImageError;
pub use exposure::automatic_exposure;
pub use formats::{
    Depth, FORMATS, Format, Raster, RowFormat, RowLayout, RowWriter, WriteOptions, extension_of, format_for,
};
pub use half::f32_from_half;
pub use limits::{can_allocate, checked_count, pixel_limit};
pub use read::{Encoded, read, read_srgb, read8};
#[cfg(feature = "fs")]
pub use save::{Destination, SaveError, save, save_all};
pub use transfer::{Transfer, decode_hexadecimal, decode_linear, decode_srgb, linear_from_srgb};

use durer_bvh::math::Vec3;
use std::sync::Arc;

/// Maximum number of pixels in a picture, which is 2^28, for example 16384 x 16384.
pub const MAX_PIXELS: u64 = 1 << 28;

/// A picture in memory with three floating-point values per pixel, which are usually linear light.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Pixels, stored row by row from the top, with each row from left to right; there are `width *
    /// height` of them.
    pub pixels: Vec<Vec3>,
}

/// A picture in memory with 8 bits per channel, as they are stored in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image8 {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Red, green, and blue values, stored row by row from the top, with each row from left to
    /// right.
    pub pixels: Vec<[u8; 3]>,
    /// Opacity of each pixel, from 0 to 255; empty if the file stores none.
    pub alpha: Vec<u8>,
}

/// Meaning of the values in a [`Layer`], which determines whether tone mapping and the transfer
/// function are applied.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LayerKind {
    /// Light, as a render produces it. In 8-bit formats, tone mapping and the transfer function are
    /// applied to it.
    Color,
    /// Data such as normals, depths, and masks. Such data is written without tone mapping and
    /// without the sRGB curve.
    Data,
}

/// A named picture to be written to a file, which is one of the outputs of a render, such as its
/// light, normals, or depth.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// Name of the layer, which is used for the channels of formats that can hold several layers.
    pub name: String,
    /// Pixels of the layer, which several layers may share.
    pub image: Arc<Image>,
    /// Meaning of the values in the layer.
    pub kind: LayerKind,
    /// Coverage of each pixel, from 0 to 1; `None` if all pixels are fully covered. Colours are
    /// premultiplied (associated alpha), so a pixel that is half covered has half the light.
    pub coverage: Option<Vec<f32>>,
}

impl Image {
    /// Creates a picture that has a single colour.
    ///
    /// # Errors
    /// Returns [`ImageError::InvalidSize`] if a side is 0 or there are more than [`MAX_PIXELS`]
    /// pixels.
    pub fn new(width: u32, height: u32, color: Color) -> Result<Image, ImageError> {
        let count = limits::checked_count(width, height)?;
        Ok(Image { width, height, pixels: vec![color; count] })
    }

    /// Creates a picture from its pixels, starting with the top row.
    ///
    /// # Errors
    /// Returns [`ImageError::InvalidSize`] if a side is 0, there are too many pixels, or the number
    /// of pixels is not `width * height`.
    pub fn from_pixels(width: u32, height: u32, pixels: Vec<Vec3>) -> Result<Image, ImageError> {
        let image = Image { width, height, pixels };
        image.check()?;
        Ok(image)
    }

    /// Checks that the number of pixels matches the width and the height.
    ///
    /// # Errors
    /// Returns [`ImageError::InvalidSize`] if the number does not match.
    pub fn check(&self) -> Result<(), ImageError> {
        match limits::checked_count(self.width, self.height)? == self.pixels.len() {
            true => Ok(()),
            false => Err(ImageError::InvalidSize { width: self.width, height: self.height }),
        }
    }

    /// Returns the pixel in column `x` and row `y`, counted from the top left, or `None` if this is
    /// outside the picture.
    pub fn get(&self, x: u32, y: u32) -> Option<Vec3> {
        let index = y as usize * self.width as usize + x as usize;
        if x < self.width && y < self.height { self.pixels.get(index).copied() } else { None }
    }

    /// Returns the column and row of the first pixel that has a value that is not finite.
    pub fn first_non_finite(&self) -> Option<(u32, u32)> {
        let index = self.pixels.iter().position(|pixel| !pixel.is_finite())?;
        let width = (self.width as usize).max(1);
        Some(((index % width) as u32, (index / width) as u32))
    }
}

impl Layer {
    /// Creates a layer of light with full coverage of all pixels.
    pub fn color(name: impl Into<String>, image: Image) -> Layer {
        Layer { name: name.into(), image: Arc::new(image), kind: LayerKind::Color, coverage: None }
    }

    /// Creates a layer of data with full coverage of all pixels.
    pub fn data(name: impl Into<String>, image: Image) -> Layer {
        Layer { name: name.into(), image: Arc::new(image), kind: LayerKind::Data, coverage: None }
    }

    /// Sets the coverage of each pixel, or removes the coverage if all pixels are fully covered.
    pub fn with_coverage(self, coverage: Vec<f32>) -> Layer {
        // Pictures that are fully opaque are written without alpha.
        let opaque = coverage.iter().all(|&share| share == 1.0);
        Layer { coverage: if opaque { None } else { Some(coverage) }, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_checked() {
        assert!(Image::new(0, 3, Vec3::ZERO).is_err());
        assert!(Image::new(u32::MAX, u32::MAX, Vec3::ZERO).is_err());
        assert!(Image::from_pixels(2, 2, vec![Vec3::ZERO; 3]).is_err());
        assert!(Image::from_pixels(2, 2, vec![Vec3::ZERO; 4]).is_ok());
    }

    #[test]
    fn pixels_are_indexed_from_the_top_left() {
        let mut image = Image::new(3, 2, Vec3::ZERO).unwrap();
        image.pixels[5] = Vec3::new(1.0, f32::NAN, 0.0);
        assert_eq!(image.get(1, 1), Some(Vec3::ZERO));
        assert_eq!((image.get(3, 0), image.get(0, 2)), (None, None));
        assert_eq!(image.first_non_finite(), Some((2, 1)));
    }
}
