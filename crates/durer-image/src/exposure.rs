//! Automatic exposure of a picture.

use crate::{Color, LUMINANCE};
use durer_bvh::math::fp;

/// Luminance of middle grey, to which the mean luminance of a picture is mapped. Source: Reinhard
/// and others, *Photographic Tone Reproduction for Digital Images*, SIGGRAPH 2002, section 3.1.
const MIDDLE_GREY: f32 = 0.18;

/// Maximum fraction of the pixels with light whose luminance may exceed 1.
const MAX_CLIPPED: f32 = 0.1;

/// Returns the factor that maps the geometric mean of a picture's luminance to middle grey (0.18).
/// The factor is smaller if more than a tenth of the picture would be brighter than white. Black
/// pixels and pixels that are not finite are ignored; the factor is 1 if there are no others.
pub fn automatic_exposure(pixels: &[Color]) -> f32 {
    let luminance = pixels.iter().map(|pixel| pixel.dot(LUMINANCE));
    let mut lit: Vec<f32> = luminance.filter(|value| value.is_finite() && *value > f32::MIN_POSITIVE).collect();
    if lit.is_empty() {
        return 1.0;
    }
    let mean = lit.iter().map(|&value| f64::from(fp::ln(value))).sum::<f64>() / lit.len() as f64;
    let clipped = ((MAX_CLIPPED * lit.len() as f32) as usize).min(lit.len() - 1);
    let (_, bright, _) = lit.select_nth_unstable_by(clipped, |a, b| b.total_cmp(a));
    (MIDDLE_GREY / fp::exp(mean as f32)).min(1.0 / *bright)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_is_grey_and_few_pixels_are_clipped() {
        let picture = |values: &[f32]| -> Vec<Color> { values.iter().map(|&value| Color::splat(value)).collect() };
        let near = |a: f32, b: f32| (a / b - 1.0).abs() < 1e-5;
        // The geometric mean of 1, 10 and 100 is 10; 100 stays below white at a factor of 0.01.
        assert!(near(automatic_exposure(&picture(&[1.0, 10.0, 100.0])), 0.01));
        assert!(near(automatic_exposure(&picture(&[8.0, 10.0, 12.5])), 0.018));
        // Black, NaN and infinite pixels do not count.
        let odd = picture(&[0.0, f32::NAN, 10.0, f32::INFINITY, 0.0]);
        assert!(near(automatic_exposure(&odd), 0.018));
        assert_eq!(automatic_exposure(&picture(&[0.0, 0.0])), 1.0);
        // One bright light among many pixels may be clipped.
        let mut lamp = picture(&[1.0; 99]);
        lamp.push(Color::splat(1e6));
        let factor = automatic_exposure(&lamp);
        assert!(factor > 0.15 && factor < 0.18, "{factor}");
    }
}
