//! Whether a finished picture looks wrong.

use crate::image::Image;
use crate::math::Color;
use crate::render::Statistics;

/// Where so large a share of the pixels is cut at 1 in all channels, the picture is mostly white.
const MAX_WHITE: f32 = 0.5;
/// Where so large a share of the samples is left out, more is wrong than a speck.
const MAX_REJECTED: f64 = 0.001;

/// What is wrong with a picture as it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Oddity {
    /// All of it is black.
    Black,
    /// All of it has one colour.
    OneColor,
    /// Most of it is brighter than white.
    White,
    /// Many samples were no finite numbers.
    NotFinite,
}

impl Oddity {
    /// In words, after `the picture`.
    pub fn words(self) -> &'static str {
        match self {
            Oddity::Black => "is wholly black",
            Oddity::OneColor => "is of one colour",
            Oddity::White => "is mostly white",
            Oddity::NotFinite => "lacks samples that were no finite numbers",
        }
    }
}

/// What is wrong with a picture of colours, if anything, seen through an exposure: the factor by
/// which its light is multiplied. It looks no further than it must: a sound picture takes a few
/// pixels.
pub fn oddity(picture: &Image, exposure: f32, statistics: &Statistics) -> Option<Oddity> {
    let shown = |color: &Color| (exposure * *color).clamp(Color::ZERO, Color::ONE);
    let first = shown(picture.pixels.first()?);
    let differs = |pixel: &&Color| (shown(pixel) - first).abs().max_element() > 0.5 / 255.0;
    if picture.pixels.len() > 1 && picture.pixels.iter().find(differs).is_none() {
        return Some(if first.max_element() < 0.5 / 255.0 { Oddity::Black } else { Oddity::OneColor });
    }
    if statistics.rejected as f64 > MAX_REJECTED * (statistics.samples + statistics.rejected) as f64 {
        return Some(Oddity::NotFinite);
    }
    let cut = picture.pixels.iter().filter(|pixel| exposure * pixel.min_element() > 1.001).count();
    (cut as f32 > MAX_WHITE * picture.pixels.len() as f32).then_some(Oddity::White)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(pixels: &[f32]) -> Image {
        Image { width: pixels.len() as u32, height: 1, pixels: pixels.iter().map(|&v| Color::splat(v)).collect() }
    }

    #[test]
    fn odd_pictures_are_told_from_sound_ones() {
        let judged = |pixels: &[f32]| oddity(&picture(pixels), 1.0, &Statistics::default());
        assert_eq!(judged(&[0.0; 9]), Some(Oddity::Black));
        assert_eq!(judged(&[0.3; 9]), Some(Oddity::OneColor));
        assert_eq!(judged(&[1.5, 2.0, 9.0]), Some(Oddity::OneColor));
        assert_eq!(judged(&[1.5, 2.0, 0.1]), Some(Oddity::White));
        assert_eq!(judged(&[0.0, 0.5, 1.0]), None);
        // Light that just reaches white is not cut.
        assert_eq!(judged(&[1.0, 1.0, 0.1]), None);
        // Daylight in cd/m^2 is white as it is, and sound through an exposure.
        let day = picture(&[900.0, 2000.0, 7000.0]);
        assert_eq!(oddity(&day, 1.0, &Statistics::default()), Some(Oddity::OneColor));
        assert_eq!(oddity(&day, 1e-4, &Statistics::default()), None);
        let lost = Statistics { samples: 90, rejected: 10, ..Statistics::default() };
        assert_eq!(oddity(&picture(&[0.0, 0.5]), 1.0, &lost), Some(Oddity::NotFinite));
    }
}
