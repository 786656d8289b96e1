//! Computes the measures that a comparison reports.

use super::filter::mean;
use super::flip::{flip, hdr_flip};
use super::picture::{Pair, Scale, linear_to_srgb};
use super::ssim::ssim;
use durer_bvh::math::{Vec3, fp};

/// Measures of the difference between a picture and its reference, such as RMSE, PSNR, SSIM, and
/// FLIP.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measures {
    /// Root mean square of the difference over all channels, in the unit of the compared values.
    pub rmse: f64,
    /// Ratio of the peak value 1 to `rmse`, in decibels; infinite if the pictures are equal.
    pub psnr: f64,
    /// Mean structural similarity of the luma of the displayed pictures, at most 1; `None` if the
    /// pictures are smaller than the window of 11 pixels.
    pub ssim: Option<f64>,
    /// Mean FLIP error of the displayed pictures, from 0 to 1.
    pub flip: f64,
    /// Mean HDR-FLIP error, from 0 to 1; present only for linear light.
    pub hdr_flip: Option<f64>,
    /// Pixel with the largest difference in any channel; `None` if all finite values are equal.
    pub largest: Option<Largest>,
    /// Number of pixels in which any channel differs by more than the tolerance.
    pub over_tolerance: usize,
    /// Number of pixels with a value that is not finite, in the reference and in the other picture.
    pub not_finite: [usize; 2],
    /// Column and row of the first pixel at which one picture is not finite and the other one has
    /// different values.
    pub first_not_finite: Option<(u32, u32)>,
}

/// Pixel in which a channel differs most between a picture and its reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Largest {
    /// Absolute difference in that channel.
    pub difference: f32,
    /// Column of the pixel.
    pub x: u32,
    /// Row of the pixel.
    pub y: u32,
    /// Colour of the pixel in the reference.
    pub reference: Vec3,
    /// Colour of the pixel in the other picture.
    pub test: Vec3,
}

/// Margin for rounding errors, which ensures that a tolerance of 2/255 includes differences of two
/// 8-bit steps.
const SLACK: f32 = 1e-6;

/// Returns true if two pixels differ by more than a tolerance.
pub(super) fn over(reference: Vec3, test: Vec3, tolerance: f32) -> bool {
    (reference - test).abs().max_element() > tolerance + SLACK
}

/// Computes the measures and the map of FLIP errors (HDR-FLIP errors for linear light).
pub(super) fn measure(pair: &Pair, tolerance: f32) -> (Measures, Vec<f32>) {
    let mut sum = 0.0;
    let mut over_tolerance = pair.finite_differs.len();
    let mut largest = (0.0, 0);
    for (index, (&a, &b)) in pair.reference.iter().zip(&pair.test).enumerate() {
        if a == b {
            continue;
        }
        let difference = (a - b).as_dvec3();
        sum += difference.length_squared();
        over_tolerance += usize::from(over(a, b, tolerance));
        let most = (a - b).abs().max_element();
        if most > largest.0 {
            largest = (most, index);
        }
    }
    let place = |index: usize| ((index % pair.width) as u32, (index / pair.width) as u32);
    let rmse = (sum / (3.0 * pair.reference.len() as f64)).sqrt();
    let equal = sum == 0.0;
    let (ssim, flip_map) = if equal {
        // Equal pictures do not need to be filtered.
        let large = pair.width.min(pair.height) >= 11;
        (large.then_some(1.0), vec![0.0; pair.reference.len()])
    } else {
        let [a, b] = pair.displayed_light();
        let similarity = || match pair.scale {
            Scale::Display => ssim(pair.width, pair.height, &pair.reference, &pair.test),
            Scale::Linear => {
                let encode = |light: &[Vec3]| light.iter().map(|light| light.map(linear_to_srgb)).collect::<Vec<_>>();
                ssim(pair.width, pair.height, &encode(&a), &encode(&b))
            }
        };
        rayon::join(similarity, || flip(pair.width, pair.height, &a, &b))
    };
    let flip = mean(&flip_map);
    let flip_map = match pair.scale {
        Scale::Linear if !equal => hdr_flip(pair.width, pair.height, &pair.reference, &pair.test),
        _ => flip_map,
    };
    let measures = Measures {
        rmse,
        psnr: if equal { f64::INFINITY } else { -20.0 * f64::from(fp::ln(rmse as f32)) / std::f64::consts::LN_10 },
        ssim,
        flip,
        hdr_flip: (pair.scale == Scale::Linear).then(|| mean(&flip_map)),
        largest: (largest.0 > 0.0).then(|| {
            let ((x, y), index) = (place(largest.1), largest.1);
            Largest { difference: largest.0, x, y, reference: pair.reference[index], test: pair.test[index] }
        }),
        over_tolerance,
        not_finite: [pair.not_finite[0].len(), pair.not_finite[1].len()],
        first_not_finite: pair.finite_differs.first().map(|&index| place(index)),
    };
    (measures, flip_map)
}
