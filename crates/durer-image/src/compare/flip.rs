//! FLIP, a measure of the difference that people perceive when alternating between two pictures.
//!
//! Sources: Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström and Fairchild, *FLIP: A
//! Difference Evaluator for Alternating Images*, HPG 2020; for HDR pictures, Andersson, Nilsson,
//! Shirley and Akenine-Möller, *Visualizing Errors in Rendered High Dynamic Range Images*,
//! Eurographics 2021.

mod color;
mod hdr;

use super::filter::{Filter, Kernel, filter_rows};
use color::{WHITE, hunt_lab, hyab, rgb_from_xyz, xyz_from_rgb};
use durer_bvh::math::{Vec3, fp};
use std::f64::consts::PI;

pub(super) use hdr::hdr_flip;

/// Number of pixels per degree of the visual field, for a screen that is 0.7 m wide, has 3840
/// pixels, and is viewed from 0.7 m away.
const PIXELS_PER_DEGREE: f64 = 3840.0 * PI / 180.0;

/// Parameters of the contrast sensitivity functions, which are the weights and scales of Gaussians
/// (paper of 2020, table 1).
const ACHROMATIC: f64 = 0.0047;
const RED_GREEN: f64 = 0.0053;
const BLUE_YELLOW: [(f64, f64); 2] = [(34.1, 0.04), (13.5, 0.025)];

/// Distance between the two peaks of the edge filter, in degrees (paper of 2020, section 4.2).
const EDGE_WIDTH: f64 = 0.082;

/// Exponent that is applied to colour differences, and the knee of the curve that maps them to
/// errors (paper of 2020, sections 4.1 to 4.3).
const COLOR_EXPONENT: f32 = 0.7;
const ERROR_KNEE: (f32, f32) = (0.4, 0.95);

/// Filters and constants of FLIP, which depend only on the viewing distance.
struct Filters {
    achromatic: Kernel,
    red_green: Kernel,
    /// Gaussians and their weights. The sum of the Gaussians is not separable, but each of them is.
    blue_yellow: [(f32, Kernel); 2],
    smooth: Kernel,
    edge: Kernel,
    point: Kernel,
    largest: f32,
}

impl Filters {
    fn new() -> Filters {
        // The spatial filters are the contrast sensitivity functions, transformed from the
        // frequency domain to the spatial domain.
        let radius = (3.0 * (BLUE_YELLOW[0].1 / (2.0 * PI * PI)).sqrt() * PIXELS_PER_DEGREE).ceil() as usize;
        let deviation = |b: f64| (b / (2.0 * PI * PI)).sqrt() * PIXELS_PER_DEGREE;
        let csf = |b: f64| Kernel::gaussian(radius, deviation(b));
        // The weight of each Gaussian in the sum of both follows from its sum over the square of
        // pixels.
        let part = |(a, b): (f64, f64)| {
            let sigma = deviation(b);
            let row: f64 = (-(radius as i32)..=radius as i32).map(|x| gauss(f64::from(x), sigma)).sum();
            a * (PI / b).sqrt() * row * row
        };
        let total: f64 = BLUE_YELLOW.iter().map(|&row| part(row)).sum();
        let blue_yellow = BLUE_YELLOW.map(|row| ((part(row) / total) as f32, csf(row.1)));

        // The feature filters are the first and second derivatives of a Gaussian. Their positive
        // weights sum to 1, and their negative weights to -1.
        let sigma = 0.5 * EDGE_WIDTH * PIXELS_PER_DEGREE;
        let radius = (3.0 * sigma).ceil() as usize;
        let first = |x: f64| x * gauss(x, sigma);
        let second = |x: f64| (x * x / (sigma * sigma) - 1.0) * gauss(x, sigma);
        let first_sum: f64 = (1..=radius).map(|x| first(x as f64)).sum();
        let both = -(radius as i32)..=radius as i32;
        let (mut positive, mut negative) = (0.0, 0.0);
        for weight in both.map(|x| second(f64::from(x))) {
            if weight > 0.0 { positive += weight } else { negative -= weight }
        }
        let scale = |weight: f64| if weight > 0.0 { weight / positive } else { weight / negative };

        let green = hunt_lab(xyz_from_rgb(Vec3::Y) / WHITE);
        let blue = hunt_lab(xyz_from_rgb(Vec3::Z) / WHITE);
        Filters {
            achromatic: csf(ACHROMATIC),
            red_green: csf(RED_GREEN),
            blue_yellow,
            smooth: Kernel::gaussian(radius, sigma),
            edge: Kernel::odd(radius, |x| first(x) / first_sum),
            point: Kernel::even(radius, |x| scale(second(x))),
            largest: fp::pow(hyab(green, blue), COLOR_EXPONENT),
        }
    }
}

fn gauss(x: f64, deviation: f64) -> f64 {
    f64::from(fp::exp((-0.5 * x * x / (deviation * deviation)) as f32))
}

/// Perceived colour and features of a pixel after the spatial filters of FLIP.
struct PixelFeatures {
    /// Colour in L*a*b* with the Hunt effect.
    color: Vec3,
    /// Strength of an edge, and strength of a point, at this pixel.
    edge: f32,
    point: f32,
}

/// Computes the error of each pixel, from 0 to 1, between two pictures of linear light from 0 to 1.
///
/// The result is the error map from the paper of 2020, at the usual viewing distance of 67 pixels
/// per degree.
pub(super) fn flip(width: usize, height: usize, a: &[Vec3], b: &[Vec3]) -> Vec<f32> {
    flip_of((width, height), |index| a[index], |index| b[index])
}

/// Computes [`flip`] for pictures whose pixels are computed on demand.
fn flip_of(
    (width, height): (usize, usize),
    a: impl Fn(usize) -> Vec3 + Sync,
    b: impl Fn(usize) -> Vec3 + Sync,
) -> Vec<f32> {
    let filters = Filters::new();
    let one = picture_filters(&filters);
    // The planes of the first picture come before those of the second.
    let both: Vec<Filter> = one.iter().copied().chain(one.iter().map(|&(p, x, y)| (p + 3, x, y))).collect();
    let planes = |y: usize, rows: &mut [Vec<f32>]| {
        let (first, second) = rows.split_at_mut(3);
        opponent_row(y * width, first, &a);
        opponent_row(y * width, second, &b);
    };
    let finish = |_: usize, rows: &[Vec<f32>], out: &mut [f32]| {
        let (first, second) = rows.split_at(8);
        for (x, out) in out.iter_mut().enumerate() {
            *out = error(&filters, &pixel_features(&filters, first, x), &pixel_features(&filters, second, x));
        }
    };
    filter_rows((width, height), 6, &both, planes, finish)
}

/// Computes the luminance and two colour differences of a row, as in the YCxCz colour space. Its
/// constant factors are left out, because they do not matter for linear filters.
fn opponent_row(start: usize, rows: &mut [Vec<f32>], light: impl Fn(usize) -> Vec3) {
    let [luminance, red_green, blue_yellow] = rows else { unreachable!("three planes") };
    for (x, ((l, rg), by)) in luminance.iter_mut().zip(red_green).zip(blue_yellow).enumerate() {
        let xyz = xyz_from_rgb(light(start + x)) / WHITE;
        (*l, *rg, *by) = (xyz.y, xyz.x - xyz.y, xyz.y - xyz.z);
    }
}

/// Filters of one picture: four for its colours, and two derivatives along each axis.
fn picture_filters(filters: &Filters) -> [Filter<'_>; 8] {
    let Filters { achromatic, red_green, blue_yellow: [(_, wide), (_, narrow)], smooth, edge, point, .. } = filters;
    [
        (0, achromatic, achromatic),
        (1, red_green, red_green),
        (2, wide, wide),
        (2, narrow, narrow),
        (0, edge, smooth),
        (0, smooth, edge),
        (0, point, smooth),
        (0, smooth, point),
    ]
}

#[inline(always)]
fn pixel_features(filters: &Filters, rows: &[Vec<f32>], x: usize) -> PixelFeatures {
    let [l, rg, wide, narrow, edge_x, edge_y, point_x, point_y] = std::array::from_fn(|filter| rows[filter][x]);
    let by = filters.blue_yellow[0].0 * wide + filters.blue_yellow[1].0 * narrow;
    // Clip colours that a screen cannot display.
    let rgb = rgb_from_xyz(Vec3::new(l + rg, l, l - by) * WHITE).clamp(Vec3::ZERO, Vec3::ONE);
    PixelFeatures {
        color: hunt_lab(xyz_from_rgb(rgb) / WHITE),
        edge: (edge_x * edge_x + edge_y * edge_y).sqrt(),
        point: (point_x * point_x + point_y * point_y).sqrt(),
    }
}

#[inline(always)]
fn error(filters: &Filters, a: &PixelFeatures, b: &PixelFeatures) -> f32 {
    let distance = hyab(a.color, b.color);
    if distance == 0.0 {
        return 0.0;
    }
    // Differences that occur in ordinary pictures are mapped to most of the error range. Larger
    // differences share the rest of the range.
    let (difference, knee) = (fp::pow(distance, COLOR_EXPONENT), ERROR_KNEE.0 * filters.largest);
    let color = if difference < knee {
        ERROR_KNEE.1 / knee * difference
    } else {
        ERROR_KNEE.1 + (difference - knee) / (filters.largest - knee) * (1.0 - ERROR_KNEE.1)
    };
    let feature = (a.edge - b.edge).abs().max((a.point - b.point).abs());
    let feature = (std::f32::consts::FRAC_1_SQRT_2 * feature).sqrt();
    fp::pow(color, 1.0 - feature)
}
