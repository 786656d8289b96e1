//! Pictures to be compared, and their conversion to a common scale.

use super::CompareError;
use crate::{Depth, Encoded, Image, ImageError, Transfer, decode_linear, decode_srgb};
use durer_bvh::math::{Vec3, fp};

/// Meaning of the values in a picture to be compared: encoded for display, or linear light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Display values from 0 to 1, as stored in integer formats (multiples of 1/255 for 8 bits).
    Display,
    /// Linear light of any magnitude, as stored in floating-point formats.
    Linear,
}

impl Scale {
    /// Name of the scale in reports.
    pub fn name(self) -> &'static str {
        match self {
            Scale::Display => "display",
            Scale::Linear => "linear",
        }
    }

    /// Converts a value on this scale to linear light.
    pub(super) fn decode(self, value: Vec3) -> Vec3 {
        match self {
            Scale::Linear => value,
            Scale::Display => value.map(srgb_to_linear),
        }
    }

    /// Converts linear light to a value on this scale; this is the inverse of [`Scale::decode`].
    pub(super) fn encode(self, light: Vec3) -> Vec3 {
        match self {
            Scale::Linear => light,
            Scale::Display => light.map(linear_to_srgb),
        }
    }

    /// Returns the smallest visible difference at a value, where `step` is the smallest visible
    /// difference between display values. For linear light, the smallest visible difference is
    /// proportional to the value.
    pub(super) fn visible(self, value: Vec3, step: f32) -> f32 {
        match self {
            Scale::Linear => step * value.abs().max_element().max(0.05),
            Scale::Display => step,
        }
    }

    /// Clamps a value to the range of the scale.
    pub(super) fn clamp(self, value: Vec3) -> Vec3 {
        match self {
            Scale::Linear => value,
            Scale::Display => value.clamp(Vec3::ZERO, Vec3::ONE),
        }
    }
}

/// Converts linear light in the range from 0 to 1 to an sRGB value (IEC 61966-2-1).
pub fn linear_to_srgb(light: f32) -> f32 {
    if light <= 0.0031308 { 12.92 * light } else { 1.055 * fp::pow(light, 1.0 / 2.4) - 0.055 }
}

/// Converts an sRGB value in the range from 0 to 1 to linear light (IEC 61966-2-1).
pub fn srgb_to_linear(value: f32) -> f32 {
    if value <= 0.04045 { value / 12.92 } else { fp::pow((value + 0.055) / 1.055, 2.4) }
}

/// A picture to be compared, with its values as they are stored in its file.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Stored values, to which no transfer function has been applied.
    pub image: Image,
    /// Meaning of the stored values.
    pub scale: Scale,
}

impl Picture {
    /// Returns false if the picture seems to show distances or normals instead of colours: if all
    /// pixels are grey, or if nearly all of them encode unit vectors or are background.
    pub fn shows_color(&self) -> bool {
        let pixels = &self.image.pixels;
        let Some(background) = pixels.first() else { return true };
        let objects: Vec<&Vec3> = pixels.iter().filter(|pixel| *pixel != background && **pixel != Vec3::ZERO).collect();
        let is_unit = |pixel: Vec3| (pixel.length() - 1.0).abs() < 0.02;
        let share = |is: &dyn Fn(Vec3) -> bool| objects.iter().filter(|pixel| is(***pixel)).count() * 100;
        let enough = 95 * objects.len();
        let is_grey = pixels.iter().all(|pixel| pixel.max_element() - pixel.min_element() < 1e-4);
        !(is_grey || share(&is_unit) >= enough || share(&|pixel| is_unit(2.0 * pixel - 1.0)) >= enough)
    }

    /// Decodes a picture. The format is determined by the content or, if the content does not
    /// identify it, by the extension of `name`. Alpha is discarded.
    ///
    /// # Errors
    /// Returns the errors of [`read`](crate::read).
    pub fn read(bytes: &[u8], name: &str) -> Result<Picture, ImageError> {
        Picture::decode(&Encoded::open(bytes, name)?, u64::MAX)
    }

    /// Decodes a picture whose header has already been read, using at most `memory` bytes.
    ///
    /// # Errors
    /// Returns the errors of [`Encoded::read`].
    pub fn decode(encoded: &Encoded, memory: u64) -> Result<Picture, ImageError> {
        // PNG and PPM files with 16 bits per channel also contain display values.
        let scale = if encoded.depth() == Depth::Float { Scale::Linear } else { Scale::Display };
        Ok(Picture { image: encoded.read(memory, decode_linear)?, scale })
    }
}

/// A reference and a picture (`test`) to be compared, which have the same size and were converted
/// to the same scale.
pub(super) struct Pair {
    pub width: usize,
    pub height: usize,
    pub scale: Scale,
    pub reference: Vec<Vec3>,
    pub test: Vec<Vec3>,
    /// Pixels with a value that is not finite, in the reference and in the other picture. Both
    /// pictures are set to 0 at all of these pixels.
    pub not_finite: [Vec<usize>; 2],
    /// Pixels at which the pictures differ and at least one of them is not finite.
    pub finite_differs: Vec<usize>,
}

impl Pair {
    /// Converts two pictures to the same scale. If only one of them is linear, `transfer` encodes
    /// it with 8 bits.
    pub fn new(reference: &Picture, test: &Picture, transfer: Transfer) -> Result<Pair, CompareError> {
        let size = |picture: &Picture| (picture.image.width, picture.image.height);
        if size(reference) != size(test) {
            return Err(CompareError::Sizes { reference: size(reference), test: size(test) });
        }
        reference.image.check()?;
        test.image.check()?;
        let scale = if reference.scale == test.scale { reference.scale } else { Scale::Display };
        let values = |picture: &Picture| match (picture.scale, scale) {
            (Scale::Linear, Scale::Display) => picture
                .image
                .pixels
                .iter()
                .map(|&light| transfer.encode_pixel(light).map(decode_linear).into())
                .collect(),
            _ => picture.image.pixels.clone(),
        };
        let (width, height) = size(reference);
        let mut pair = Pair {
            width: width as usize,
            height: height as usize,
            scale,
            reference: values(reference),
            test: values(test),
            not_finite: [Vec::new(), Vec::new()],
            finite_differs: Vec::new(),
        };
        pair.clear_not_finite();
        Ok(pair)
    }

    fn clear_not_finite(&mut self) {
        for (index, (a, b)) in self.reference.iter_mut().zip(&mut self.test).enumerate() {
            if a.is_finite() && b.is_finite() {
                continue;
            }
            for (pixel, list) in [*a, *b].iter().zip(&mut self.not_finite) {
                if !pixel.is_finite() {
                    list.push(index);
                }
            }
            let same = |(x, y): (f32, f32)| x == y || x.is_nan() && y.is_nan();
            if !a.to_array().into_iter().zip(b.to_array()).all(same) {
                self.finite_differs.push(index);
            }
            (*a, *b) = (Vec3::ZERO, Vec3::ZERO);
        }
    }

    /// Returns the linear light of both pictures, from 0 to 1, as a screen would show it.
    pub fn displayed_light(&self) -> [Vec<Vec3>; 2] {
        let table: [f32; 256] = std::array::from_fn(|value| decode_srgb(value as u8));
        // Nearly all values are multiples of 1/255.
        let decode = |value: f32| {
            let level = value * 255.0;
            let near = level.round();
            if (level - near).abs() < 1e-3 { table[near as usize] } else { srgb_to_linear(value) }
        };
        let light = |pixels: &[Vec3]| match self.scale {
            Scale::Linear => pixels.iter().map(|pixel| pixel.clamp(Vec3::ZERO, Vec3::ONE)).collect(),
            Scale::Display => pixels.iter().map(|pixel| pixel.clamp(Vec3::ZERO, Vec3::ONE).map(decode)).collect(),
        };
        let (a, b) = rayon::join(|| light(&self.reference), || light(&self.test));
        [a, b]
    }
}
