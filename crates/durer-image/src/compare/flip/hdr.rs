//! HDR-FLIP, which is the maximum FLIP error over all relevant exposures.

use super::flip_of;
use crate::LUMINANCE;
use durer_bvh::math::{Vec3, fp};

/// Coefficients of the tone curve (a x^2 + b x) / (c x^2 + d x + e), which is Narkowicz's fit of
/// ACES with its exposure of 0.6.
const CURVE: [f32; 5] = [0.36 * 2.51, 0.6 * 0.03, 0.36 * 2.43, 0.6 * 0.59, 0.14];

/// Display value that the first exposure gives to the brightest light, and the last exposure to the
/// median (paper of 2021, section 3.2).
const TARGET: f32 = 0.85;

/// Computes the error of each pixel, from 0 to 1, between two pictures of linear light.
pub fn hdr_flip(width: usize, height: usize, reference: &[Vec3], test: &[Vec3]) -> Vec<f32> {
    let mut worst = vec![0.0f32; width * height];
    for exposure in exposures(reference) {
        let show = |light: Vec3| tone_map(light * exposure);
        let map = flip_of((width, height), |index| show(reference[index]), |index| show(test[index]));
        worst.iter_mut().zip(map).for_each(|(worst, error)| *worst = worst.max(error));
    }
    worst
}

fn tone_map(light: Vec3) -> Vec3 {
    let [a, b, c, d, e] = CURVE;
    // Clamping to 1e15 keeps the squares finite and does not change the result, which is 1 for such
    // values.
    light.map(|x| {
        let x = x.clamp(0.0, 1e15);
        ((a * x * x + b * x) / (c * x * x + d * x + e)).clamp(0.0, 1.0)
    })
}

/// Exposure factors, about one stop apart, from the one for the brightest light to the one for the
/// median (paper of 2021, section 3.2).
pub fn exposures(reference: &[Vec3]) -> Vec<f32> {
    let mut light: Vec<f32> = reference.iter().map(|pixel| pixel.max(Vec3::ZERO).dot(LUMINANCE)).collect();
    let brightest = light.iter().copied().fold(0.0, f32::max);
    // If the number of pixels is even, this is the upper median, as in the program of the paper's
    // authors.
    let middle = light.len() / 2;
    let median = *light.select_nth_unstable_by(middle, f32::total_cmp).1;
    // The light that the curve maps to the target value is the positive root of a quadratic
    // equation.
    let [a, b, c, d, e] = CURVE;
    let (p, q) = ((b - d * TARGET) / (a - c * TARGET), -e * TARGET / (a - c * TARGET));
    let shown = -0.5 * p + (0.25 * p * p - q).sqrt();
    let stops = |light: f32| fp::ln(shown / light.max(f32::EPSILON)) / std::f32::consts::LN_2;
    let (start, stop) = (stops(brightest), stops(median));
    let count = ((stop - start).ceil()).max(2.0);
    let step = (stop - start) / (count - 1.0);
    (0..count as usize).map(|i| fp::exp((start + i as f32 * step) * std::f32::consts::LN_2)).collect()
}
