//! Pictures: reading, writing, and saving them without harm to what was there.
//!
//! Everything in memory is linear floating point; what becomes of it in eight bits says
//! [`Transfer`]. The table [`FORMATS`] knows the file formats, [`read()`] reads them from memory,
//! [`save()`] puts bytes into a file.

mod color;
pub mod compare;
mod content;
pub mod denoise;
mod display;
mod error;
mod formats;
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
pub use display::{Display, Tone};
pub use error::ImageError;
pub use formats::{
    Depth, FORMATS, Format, Raster, RowFormat, RowWriter, Strip, WriteOptions, extension_of, format_for,
};
pub use limits::{checked_count, pixel_limit};
pub use read::{Encoded, read, read_srgb, read8};
#[cfg(feature = "fs")]
pub use save::{Destination, SaveError, save, save_all};
pub use transfer::{Transfer, decode_linear, decode_srgb, linear_from_srgb};

use durer_bvh::math::Vec3;
use std::sync::Arc;

/// The most pixels that a picture may have: 2^28, a square of 16384.
pub const MAX_PIXELS: u64 = 1 << 28;

/// A picture of linear floating-point pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Row by row from the top, each from left to right: `width * height` of them.
    pub pixels: Vec<Vec3>,
}

/// A picture of eight bits a channel, as it stands in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image8 {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Red, green and blue, row by row from the top, each from left to right.
    pub pixels: Vec<[u8; 3]>,
    /// Opacity of each, in 255ths; empty where the file has none.
    pub alpha: Vec<u8>,
}

/// What the numbers of a layer mean, and so whether a transfer curve may touch them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LayerKind {
    /// Light: the transfer curve applies in eight-bit formats.
    Color,
    /// Normals, depths, masks: written as they are.
    Data,
}

/// A picture with a name, one of those that a render makes.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// Name, used for the channels of formats that hold several layers.
    pub name: String,
    /// The pixels, which several layers may share.
    pub image: Arc<Image>,
    /// What they mean.
    pub kind: LayerKind,
    /// The share of each pixel, from 0 to 1, that the camera sees at all; `None`: all of each.
    /// Colours are those over black: a pixel that is half covered has half the light
    /// (associated alpha).
    pub coverage: Option<Vec<f32>>,
}

impl Image {
    /// A picture of one colour.
    ///
    /// # Errors
    /// [`ImageError::Size`] if a side is 0 or there are more than [`MAX_PIXELS`].
    pub fn new(width: u32, height: u32, color: Color) -> Result<Image, ImageError> {
        let count = limits::checked_count(width, height)?;
        Ok(Image { width, height, pixels: vec![color; count] })
    }

    /// A picture of given pixels, the top row first.
    ///
    /// # Errors
    /// [`ImageError::Size`] if a side is 0, there are too many pixels, or not `width * height` of
    /// them.
    pub fn from_pixels(width: u32, height: u32, pixels: Vec<Vec3>) -> Result<Image, ImageError> {
        let image = Image { width, height, pixels };
        image.check()?;
        Ok(image)
    }

    /// Whether the number of pixels fits the sides.
    ///
    /// # Errors
    /// [`ImageError::Size`] if it does not.
    pub fn check(&self) -> Result<(), ImageError> {
        match limits::checked_count(self.width, self.height)? == self.pixels.len() {
            true => Ok(()),
            false => Err(ImageError::Size { width: self.width, height: self.height }),
        }
    }

    /// The pixel in column `x` and row `y`, counted from the top left; `None` outside the picture.
    pub fn get(&self, x: u32, y: u32) -> Option<Vec3> {
        let index = y as usize * self.width as usize + x as usize;
        if x < self.width && y < self.height { self.pixels.get(index).copied() } else { None }
    }

    /// Column and row of the first pixel with a number that is not finite.
    pub fn first_non_finite(&self) -> Option<(u32, u32)> {
        let index = self.pixels.iter().position(|pixel| !pixel.is_finite())?;
        let width = (self.width as usize).max(1);
        Some(((index % width) as u32, (index / width) as u32))
    }
}

impl Layer {
    /// A layer of light.
    pub fn color(name: impl Into<String>, image: Image) -> Layer {
        Layer { name: name.into(), image: Arc::new(image), kind: LayerKind::Color, coverage: None }
    }

    /// A layer of other numbers.
    pub fn data(name: impl Into<String>, image: Image) -> Layer {
        Layer { name: name.into(), image: Arc::new(image), kind: LayerKind::Data, coverage: None }
    }

    /// The same layer with the share of each pixel that is seen; none where all is.
    pub fn with_coverage(self, coverage: Vec<f32>) -> Layer {
        // Opaque pictures are written without alpha.
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
    fn pixels_are_found_from_the_top_left() {
        let mut image = Image::new(3, 2, Vec3::ZERO).unwrap();
        image.pixels[5] = Vec3::new(1.0, f32::NAN, 0.0);
        assert_eq!(image.get(1, 1), Some(Vec3::ZERO));
        assert_eq!((image.get(3, 0), image.get(0, 2)), (None, None));
        assert_eq!(image.first_non_finite(), Some((2, 1)));
    }
}
