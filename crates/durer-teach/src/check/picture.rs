//! Checks of a rendered picture.

use durer_render::render::Statistics;
use durer_scene::math::Color;

/// Fraction of pixels clipped in all channels above which a picture is mostly white.
const MAX_WHITE: f32 = 0.5;
/// Value below which a pixel is nearly black, and fraction of such pixels above which a picture is.
const NEARLY_BLACK: f32 = 0.05;
const MAX_DARK: f32 = 0.99;
/// Fraction of rejected samples above which more than a few pixels are affected.
const MAX_REJECTED: f64 = 0.001;

/// An obvious fault of a rendered picture, for example that it is black everywhere. After such a
/// fault, `durer render` suggests running `durer check`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureFault {
    /// The whole picture is black.
    Black,
    /// Nearly all pixels are so dark that hardly anything can be recognised.
    Dark,
    /// The whole picture has a single colour.
    OneColor,
    /// Most pixels are brighter than white.
    White,
    /// Many samples were NaN or infinite.
    NotFinite,
}

impl PictureFault {
    /// Returns the fault as a predicate of the subject `the picture`.
    pub fn description(self) -> &'static str {
        match self {
            PictureFault::Black => "is completely black",
            PictureFault::Dark => "is nearly black",
            PictureFault::OneColor => "has only one colour",
            PictureFault::White => "is mostly white",
            PictureFault::NotFinite => "lacks samples that were NaN or infinite",
        }
    }
}

/// Detects an obvious fault of a rendered picture from its pixels. The pixels are multiplied by the
/// exposure and can arrive in any number of pieces.
#[derive(Clone, Debug)]
pub struct PictureScan {
    exposure: f32,
    first: Option<Color>,
    /// True if at least one pixel differs in colour from the first pixel.
    differs: bool,
    pixels: usize,
    /// Number of pixels that are brighter than white.
    clipped: usize,
    /// Number of pixels that are nearly black.
    dark: usize,
}

impl PictureScan {
    /// Creates a scan that has no pixels yet. `exposure` is the factor by which pixel values are
    /// multiplied.
    pub fn new(exposure: f32) -> Self {
        PictureScan { exposure, first: None, differs: false, pixels: 0, clipped: 0, dark: 0 }
    }

    /// Adds pixels.
    pub fn add(&mut self, pixels: &[Color]) {
        let exposure = self.exposure;
        let clamped = |color: &Color| (exposure * *color).clamp(Color::ZERO, Color::ONE);
        let Some(first) = self.first.or(pixels.first().map(clamped)) else { return };
        self.first = Some(first);
        let differs = |pixel: &Color| (clamped(pixel) - first).abs().max_element() > 0.5 / 255.0;
        self.differs = self.differs || pixels.iter().any(differs);
        self.pixels += pixels.len();
        self.clipped += pixels.iter().filter(|pixel| exposure * pixel.min_element() > 1.001).count();
        self.dark += pixels.iter().filter(|pixel| exposure * pixel.max_element() < NEARLY_BLACK).count();
    }

    /// Returns the fault of the pixels added so far, if there is one.
    pub fn fault(&self, statistics: &Statistics) -> Option<PictureFault> {
        if self.pixels > 1 && !self.differs {
            let first = self.first.unwrap_or(Color::ZERO);
            return Some(if first.max_element() < 0.5 / 255.0 { PictureFault::Black } else { PictureFault::OneColor });
        }
        if statistics.rejected as f64 > MAX_REJECTED * (statistics.samples + statistics.rejected) as f64 {
            return Some(PictureFault::NotFinite);
        }
        let is_above = |count: usize, fraction: f32| count as f32 > fraction * self.pixels as f32;
        if is_above(self.dark, MAX_DARK) {
            return Some(PictureFault::Dark);
        }
        is_above(self.clipped, MAX_WHITE).then_some(PictureFault::White)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Adds the pixels in pieces of two.
    fn oddity(pixels: &[f32], exposure: f32, statistics: &Statistics) -> Option<PictureFault> {
        let mut looks = PictureScan::new(exposure);
        let colors: Vec<Color> = pixels.iter().map(|&v| Color::splat(v)).collect();
        colors.chunks(2).for_each(|piece| looks.add(piece));
        looks.fault(statistics)
    }

    #[test]
    fn faulty_pictures_are_recognized() {
        let judged = |pixels: &[f32]| oddity(pixels, 1.0, &Statistics::default());
        assert_eq!(judged(&[0.0; 9]), Some(PictureFault::Black));
        assert_eq!(judged(&[0.3; 9]), Some(PictureFault::OneColor));
        assert_eq!(judged(&[1.5, 2.0, 9.0]), Some(PictureFault::OneColor));
        assert_eq!(judged(&[1.5, 2.0, 0.1]), Some(PictureFault::White));
        assert_eq!(judged(&[0.0, 0.5, 1.0]), None);
        assert_eq!(judged(&[0.0, 0.02, 0.04]), Some(PictureFault::Dark));
        assert_eq!(judged(&[0.0, 0.02, 0.06]), None);
        // White itself does not count as clipped.
        assert_eq!(judged(&[1.0, 1.0, 0.1]), None);
        // Daylight in cd/m^2 is white without scaling, but it is fine with an exposure.
        let day = [900.0, 2000.0, 7000.0];
        assert_eq!(oddity(&day, 1.0, &Statistics::default()), Some(PictureFault::OneColor));
        assert_eq!(oddity(&day, 1e-4, &Statistics::default()), None);
        let lost = Statistics { samples: 90, rejected: 10, ..Statistics::default() };
        assert_eq!(oddity(&[0.0, 0.5], 1.0, &lost), Some(PictureFault::NotFinite));
    }
}
