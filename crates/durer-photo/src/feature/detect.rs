//! Finds the extrema of the difference of Gaussians (Lowe, sections 3 and 4).

use super::GrayImage;
use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;

/// Number of scales per octave that are searched for extrema.
pub const SCALES_PER_OCTAVE: usize = 3;
/// Standard deviation in pixels of the blur of an octave's first image.
pub const BASE_BLUR: f32 = 1.6;
/// Assumed standard deviation in pixels of the blur of a photograph.
const CAMERA_BLUR: f32 = 0.5;
/// Minimum difference of Gaussians at an extremum, for pixel values from 0 to 1.
const MIN_CONTRAST: f32 = 0.02 / SCALES_PER_OCTAVE as f32;
/// Maximum ratio of the two curvatures at an extremum. Extrema on edges have a larger ratio.
const MAX_EDGE_RATIO: f32 = 10.0;
/// Width in pixels of the border that is not searched.
const BORDER: usize = 5;

/// Level of the scale-space pyramid, which contains images of one size with increasing blur, and
/// their differences.
pub struct Octave {
    pub blurs: Vec<GrayImage>,
    differences: Vec<GrayImage>,
}

/// Extremum of the difference of Gaussians in scale space, which is a candidate for a SIFT feature.
#[derive(Debug, Clone, Copy)]
pub struct Extremum {
    pub octave: usize,
    pub level: usize,
    pub row: usize,
    pub column: usize,
    /// Position relative to pixel centres, and scale, both in pixels of the octave.
    pub x: f32,
    pub y: f32,
    pub scale: f32,
    pub strength: f32,
}

/// Computes 2^(levels / LEVELS), where `levels` is a part of an octave.
fn power(levels: f32) -> f32 {
    libm::exp2f(levels / SCALES_PER_OCTAVE as f32)
}

/// Builds the scale-space pyramid down to the smallest useful image size.
pub fn octaves(gray: &GrayImage, doubled: bool) -> Vec<Octave> {
    let (start, own) = if doubled { (gray.doubled(), 2.0 * CAMERA_BLUR) } else { (gray.clone(), CAMERA_BLUR) };
    let mut first = start.blurred((BASE_BLUR * BASE_BLUR - own * own).sqrt());
    let mut all = Vec::new();
    while first.width.min(first.height) > 4 * BORDER && all.len() < 8 {
        let mut blurs = vec![first];
        for level in 1..SCALES_PER_OCTAVE + 3 {
            // The variances of successive blurs add up.
            let (before, after) = (BASE_BLUR * power(level as f32 - 1.0), BASE_BLUR * power(level as f32));
            blurs.push(blurs[level - 1].blurred((after * after - before * before).sqrt()));
        }
        first = blurs[SCALES_PER_OCTAVE].halved();
        let differences = blurs.windows(2).map(|pair| pair[1].difference(&pair[0])).collect();
        all.push(Octave { blurs, differences });
    }
    all
}

/// Finds the extrema in all octaves.
pub fn points(octaves: &[Octave]) -> Vec<Extremum> {
    let in_octave = |(number, octave): (usize, &Octave)| -> Vec<Extremum> {
        let height = octave.differences[0].height;
        let rows = (1..=SCALES_PER_OCTAVE).flat_map(|level| (BORDER..height - BORDER).map(move |row| (level, row)));
        let rows: Vec<_> = rows.collect();
        let extrema: Vec<Vec<Extremum>> =
            rows.into_par_iter().map(|(level, row)| in_row(&octave.differences, number, level, row)).collect();
        extrema.into_iter().flatten().collect()
    };
    octaves.iter().enumerate().flat_map(in_octave).collect()
}

fn in_row(d: &[GrayImage], octave: usize, level: usize, row: usize) -> Vec<Extremum> {
    let width = d[0].width;
    let extreme = |column: &usize| {
        let value = d[level].at(*column, row);
        if value.abs() < 0.8 * MIN_CONTRAST {
            return false;
        }
        let mut others = (0..27).filter(|i| *i != 13).map(|i| {
            let (dx, dy, dl) = (i % 3, i / 3 % 3, i / 9);
            d[level + dl - 1].at(column + dx - 1, row + dy - 1)
        });
        if value > 0.0 { others.all(|other| value > other) } else { others.all(|other| value < other) }
    };
    (BORDER..width - BORDER).filter(extreme).filter_map(|column| refined(d, octave, level, row, column)).collect()
}

/// Refines an extremum by fitting a quadratic function to its neighbours. Returns `None` if the fit
/// moves away, or if the extremum is weak or on an edge.
fn refined(d: &[GrayImage], octave: usize, mut level: usize, mut row: usize, mut column: usize) -> Option<Extremum> {
    for _ in 0..5 {
        let at = |dx: isize, dy: isize, dl: isize| {
            let place = |base: usize, by: isize| base.wrapping_add_signed(by);
            d[place(level, dl)].at(place(column, dx), place(row, dy))
        };
        let here = at(0, 0, 0);
        let slope = |a: f32, b: f32| (b - a) / 2.0;
        let bend = |a: f32, b: f32| a + b - 2.0 * here;
        let gradient = Vector3::new(
            slope(at(-1, 0, 0), at(1, 0, 0)),
            slope(at(0, -1, 0), at(0, 1, 0)),
            slope(at(0, 0, -1), at(0, 0, 1)),
        );
        let (xx, yy) = (bend(at(-1, 0, 0), at(1, 0, 0)), bend(at(0, -1, 0), at(0, 1, 0)));
        let ll = bend(at(0, 0, -1), at(0, 0, 1));
        let xy = (at(1, 1, 0) + at(-1, -1, 0) - at(-1, 1, 0) - at(1, -1, 0)) / 4.0;
        let xl = (at(1, 0, 1) + at(-1, 0, -1) - at(-1, 0, 1) - at(1, 0, -1)) / 4.0;
        let yl = (at(0, 1, 1) + at(0, -1, -1) - at(0, -1, 1) - at(0, 1, -1)) / 4.0;
        let hessian = Matrix3::new(xx, xy, xl, xy, yy, yl, xl, yl, ll);
        let offset = -(hessian.try_inverse()? * gradient);
        if offset.iter().all(|o| o.abs() <= 0.6) {
            let strength = here + 0.5 * gradient.dot(&offset);
            let (trace, determinant) = (xx + yy, xx * yy - xy * xy);
            let edge = determinant <= 0.0
                || trace * trace * MAX_EDGE_RATIO >= (MAX_EDGE_RATIO + 1.0) * (MAX_EDGE_RATIO + 1.0) * determinant;
            let scale = BASE_BLUR * power(level as f32 + offset.z);
            let (x, y) = (column as f32 + offset.x, row as f32 + offset.y);
            let strong = strength.abs() >= MIN_CONTRAST && !edge;
            return strong.then_some(Extremum { octave, level, row, column, x, y, scale, strength });
        }
        let moved = |base: usize, by: f32| base.wrapping_add_signed(by.clamp(-1.0, 1.0).round() as isize);
        (column, row, level) = (moved(column, offset.x), moved(row, offset.y), moved(level, offset.z));
        let inside = |i: usize, end: usize| (BORDER..end - BORDER).contains(&i);
        if !(1..=SCALES_PER_OCTAVE).contains(&level) || !inside(column, d[0].width) || !inside(row, d[0].height) {
            return None;
        }
    }
    None
}
