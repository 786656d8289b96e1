//! Computes the orientations and descriptors of features (Lowe, sections 5 and 6).

use super::detect::{Extremum, Octave};
use super::{DESCRIPTOR_LENGTH, Feature, GrayImage};
use std::f32::consts::{PI, TAU};

/// Number of bins of the orientation histogram.
const HISTOGRAM_BINS: usize = 36;
/// Number of cells of a descriptor along each axis.
const CELLS: usize = 4;
/// Number of orientation bins per cell.
const ORIENTATION_BINS: usize = 8;
/// Width of a cell, as a multiple of the feature's scale.
const CELL_WIDTH: f32 = 3.0;

/// Returns one feature for each orientation of an extremum, with positions in image pixels.
pub fn describe(octaves: &[Octave], point: &Extremum, doubled: bool) -> Vec<(Feature, [u8; DESCRIPTOR_LENGTH])> {
    let gray = &octaves[point.octave].blurs[point.level];
    // Number of image pixels per pixel of the octave. Halving keeps the centre of the first pixel
    // in place.
    let of_base = (1 << point.octave) as f32;
    let base = if doubled { 0.5 } else { 1.0 };
    let feature = |angle: f32| Feature {
        x: (point.x * of_base + 0.5) * base,
        y: (point.y * of_base + 0.5) * base,
        scale: point.scale * of_base * base,
        angle,
        strength: point.strength,
    };
    orientations(gray, point).into_iter().map(|angle| (feature(angle), descriptor(gray, point, angle))).collect()
}

/// Returns the length and the direction of the gradient at a pixel.
fn gradient(gray: &GrayImage, x: usize, y: usize) -> (f32, f32) {
    let (dx, dy) = (gray.at(x + 1, y) - gray.at(x - 1, y), gray.at(x, y + 1) - gray.at(x, y - 1));
    ((dx * dx + dy * dy).sqrt(), libm::atan2f(dy, dx))
}

/// Calls `each` for every pixel within a radius of a point, except for pixels at the border.
fn for_each_pixel_around(
    gray: &GrayImage,
    point: &Extremum,
    radius: f32,
    mut each: impl FnMut(usize, usize, f32, f32),
) {
    let range = |middle: f32, end: usize| {
        let low = (middle - radius).ceil().max(1.0) as usize;
        low..=((middle + radius).floor().min(end as f32 - 2.0)) as usize
    };
    for y in range(point.y, gray.height) {
        for x in range(point.x, gray.width) {
            each(x, y, x as f32 - point.x, y as f32 - point.y);
        }
    }
}

/// Returns at most two orientations. These are the peaks of the gradient histogram that reach at
/// least four fifths of the highest peak.
fn orientations(gray: &GrayImage, point: &Extremum) -> Vec<f32> {
    let sigma = 1.5 * point.scale;
    let mut bins = [0.0_f32; HISTOGRAM_BINS];
    for_each_pixel_around(gray, point, 3.0 * sigma, |x, y, dx, dy| {
        let distance = dx * dx + dy * dy;
        if distance > 9.0 * sigma * sigma {
            return;
        }
        let (length, angle) = gradient(gray, x, y);
        let bin = ((angle + PI) / TAU * HISTOGRAM_BINS as f32) as usize;
        bins[bin % HISTOGRAM_BINS] += length * libm::expf(-distance / (2.0 * sigma * sigma));
    });
    for _ in 0..6 {
        let old = bins;
        (0..HISTOGRAM_BINS).for_each(|i| {
            bins[i] = (old[(i + HISTOGRAM_BINS - 1) % HISTOGRAM_BINS] + old[i] + old[(i + 1) % HISTOGRAM_BINS]) / 3.0
        });
    }
    let largest = bins.iter().fold(0.0_f32, |m, b| m.max(*b));
    let mut peaks = Vec::new();
    for i in 0..HISTOGRAM_BINS {
        let (left, here, right) =
            (bins[(i + HISTOGRAM_BINS - 1) % HISTOGRAM_BINS], bins[i], bins[(i + 1) % HISTOGRAM_BINS]);
        if here > left && here > right && here >= 0.8 * largest {
            // Find the vertex of the parabola through three bins.
            let shift = 0.5 * (left - right) / (left - 2.0 * here + right);
            peaks.push((here, (i as f32 + 0.5 + shift) / HISTOGRAM_BINS as f32 * TAU - PI));
        }
    }
    peaks.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.total_cmp(&b.1)));
    peaks.truncate(2);
    peaks.into_iter().map(|peak| peak.1).collect()
}

/// Computes the SIFT descriptor, which consists of the gradient histograms of all cells. Each
/// gradient is distributed over the neighbouring cells and bins by linear interpolation.
fn descriptor(gray: &GrayImage, point: &Extremum, angle: f32) -> [u8; DESCRIPTOR_LENGTH] {
    let width = CELL_WIDTH * point.scale;
    let (sin, cos) = (libm::sinf(angle), libm::cosf(angle));
    let half = CELLS as f32 / 2.0;
    let mut bins = [0.0_f32; DESCRIPTOR_LENGTH];
    for_each_pixel_around(gray, point, width * (half + 0.5) * std::f32::consts::SQRT_2, |x, y, dx, dy| {
        let (u, v) = ((cos * dx + sin * dy) / width, (cos * dy - sin * dx) / width);
        // Compute coordinates relative to the centre of the first cell.
        let (column, row) = (u + half - 0.5, v + half - 0.5);
        if column <= -1.0 || row <= -1.0 || column >= CELLS as f32 || row >= CELLS as f32 {
            return;
        }
        let (length, direction) = gradient(gray, x, y);
        let weight = length * libm::expf(-(u * u + v * v) / (2.0 * half * half));
        let turn = (direction - angle).rem_euclid(TAU) / TAU * ORIENTATION_BINS as f32;
        let (c, r, t) = (column.floor(), row.floor(), turn.floor());
        let (fc, fr, ft) = (column - c, row - r, turn - t);
        for (dr, wr) in [(0.0, 1.0 - fr), (1.0, fr)] {
            for (dc, wc) in [(0.0, 1.0 - fc), (1.0, fc)] {
                let (r, c) = (r + dr, c + dc);
                if r < 0.0 || c < 0.0 || r >= CELLS as f32 || c >= CELLS as f32 {
                    continue;
                }
                let cell = (r as usize * CELLS + c as usize) * ORIENTATION_BINS;
                let share = weight * wr * wc;
                bins[cell + t as usize % ORIENTATION_BINS] += share * (1.0 - ft);
                bins[cell + (t as usize + 1) % ORIENTATION_BINS] += share * ft;
            }
        }
    });
    // Clamp large gradients caused by lighting to a fifth of the length of the descriptor.
    let length = bins.iter().map(|b| b * b).sum::<f32>().sqrt().max(1e-12);
    bins.iter_mut().for_each(|b| *b = (*b / length).min(0.2));
    let sum = bins.iter().sum::<f32>().max(1e-12);
    bins.map(|b| (512.0 * (b / sum).sqrt()).round().min(255.0) as u8)
}
