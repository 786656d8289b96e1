//! Whether a finished picture looks wrong.

use durer_render::render::Statistics;
use durer_scene::math::Color;

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

/// What of a picture of colours can look wrong, seen through an exposure: the factor by which its
/// light is multiplied. Its pixels may come in any number of pieces.
#[derive(Clone, Debug)]
pub struct Looks {
    exposure: f32,
    first: Option<Color>,
    /// Whether some pixel has another colour than the first.
    differs: bool,
    pixels: usize,
    /// Pixels that are brighter than white.
    cut: usize,
}

impl Looks {
    /// Of nothing yet.
    pub fn new(exposure: f32) -> Self {
        Looks { exposure, first: None, differs: false, pixels: 0, cut: 0 }
    }

    /// Looks at some pixels.
    pub fn add(&mut self, pixels: &[Color]) {
        let exposure = self.exposure;
        let shown = |color: &Color| (exposure * *color).clamp(Color::ZERO, Color::ONE);
        let Some(first) = self.first.or(pixels.first().map(shown)) else { return };
        self.first = Some(first);
        let differs = |pixel: &Color| (shown(pixel) - first).abs().max_element() > 0.5 / 255.0;
        self.differs = self.differs || pixels.iter().any(differs);
        self.pixels += pixels.len();
        self.cut += pixels.iter().filter(|pixel| exposure * pixel.min_element() > 1.001).count();
    }

    /// What is wrong, if anything.
    pub fn oddity(&self, statistics: &Statistics) -> Option<Oddity> {
        if self.pixels > 1 && !self.differs {
            let first = self.first.unwrap_or(Color::ZERO);
            return Some(if first.max_element() < 0.5 / 255.0 { Oddity::Black } else { Oddity::OneColor });
        }
        if statistics.rejected as f64 > MAX_REJECTED * (statistics.samples + statistics.rejected) as f64 {
            return Some(Oddity::NotFinite);
        }
        (self.cut as f32 > MAX_WHITE * self.pixels as f32).then_some(Oddity::White)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The pixels in pieces of two.
    fn oddity(pixels: &[f32], exposure: f32, statistics: &Statistics) -> Option<Oddity> {
        let mut looks = Looks::new(exposure);
        let colors: Vec<Color> = pixels.iter().map(|&v| Color::splat(v)).collect();
        colors.chunks(2).for_each(|piece| looks.add(piece));
        looks.oddity(statistics)
    }

    #[test]
    fn odd_pictures_are_told_from_sound_ones() {
        let judged = |pixels: &[f32]| oddity(pixels, 1.0, &Statistics::default());
        assert_eq!(judged(&[0.0; 9]), Some(Oddity::Black));
        assert_eq!(judged(&[0.3; 9]), Some(Oddity::OneColor));
        assert_eq!(judged(&[1.5, 2.0, 9.0]), Some(Oddity::OneColor));
        assert_eq!(judged(&[1.5, 2.0, 0.1]), Some(Oddity::White));
        assert_eq!(judged(&[0.0, 0.5, 1.0]), None);
        // Light that just reaches white is not cut.
        assert_eq!(judged(&[1.0, 1.0, 0.1]), None);
        // Daylight in cd/m^2 is white as it is, and sound through an exposure.
        let day = [900.0, 2000.0, 7000.0];
        assert_eq!(oddity(&day, 1.0, &Statistics::default()), Some(Oddity::OneColor));
        assert_eq!(oddity(&day, 1e-4, &Statistics::default()), None);
        let lost = Statistics { samples: 90, rejected: 10, ..Statistics::default() };
        assert_eq!(oddity(&[0.0, 0.5], 1.0, &lost), Some(Oddity::NotFinite));
    }
}
