//! Separable image filters, which are applied to bands of rows in parallel.

use rayon::prelude::*;

/// Number of rows that one parallel task filters. Rows near the ends of a band are filtered twice,
/// so small bands would waste work.
const BAND: usize = 64;

/// Weights of a symmetric or antisymmetric filter along one axis, used to compare pictures.
#[derive(Clone, Debug)]
pub(super) struct Kernel {
    /// Weights, ordered from the centre outwards.
    half: Vec<f32>,
    /// 1 if the filter is symmetric, or -1 if it is antisymmetric.
    sign: f32,
}

impl Kernel {
    /// Creates a symmetric filter from its weights at the distances 0, 1, ..., `radius`.
    pub fn even(radius: usize, weight: impl Fn(f64) -> f64) -> Kernel {
        Kernel { half: (0..=radius).map(|at| weight(at as f64) as f32).collect(), sign: 1.0 }
    }

    /// Creates an antisymmetric filter from its weights at the distances 0, 1, ..., `radius`.
    pub fn odd(radius: usize, weight: impl Fn(f64) -> f64) -> Kernel {
        Kernel { sign: -1.0, ..Kernel::even(radius, weight) }
    }

    /// Creates a Gaussian filter whose weights sum to 1.
    pub fn gaussian(radius: usize, deviation: f64) -> Kernel {
        let weight = |x: f64| f64::from(durer_bvh::math::fp::exp((-0.5 * x * x / (deviation * deviation)) as f32));
        let sum: f64 = weight(0.0) + 2.0 * (1..=radius).map(|x| weight(x as f64)).sum::<f64>();
        Kernel::even(radius, |x| weight(x) / sum)
    }

    pub fn radius(&self) -> usize {
        self.half.len() - 1
    }

    /// Filters a row that has `margin` extra values at each end.
    fn along(&self, padded: &[f32], margin: usize, out: &mut [f32]) {
        let width = out.len();
        let from = |shift: usize| &padded[shift..shift + width];
        self.sum(out, from(margin), |k| (from(margin - k), from(margin + k)));
    }

    /// Filters across rows; `row(k)` is the row that lies `k` rows below the central one.
    fn across<'r>(&self, row: impl Fn(isize) -> &'r [f32], out: &mut [f32]) {
        self.sum(out, row(0), |k| (row(-(k as isize)), row(k as isize)));
    }

    fn sum<'r>(&self, out: &mut [f32], middle: &[f32], sides: impl Fn(usize) -> (&'r [f32], &'r [f32])) {
        for (sum, value) in out.iter_mut().zip(middle) {
            *sum = self.half[0] * value;
        }
        for (k, &weight) in self.half.iter().enumerate().skip(1) {
            let (before, after) = sides(k);
            for ((sum, a), b) in out.iter_mut().zip(after).zip(before) {
                *sum += weight * (a + self.sign * b);
            }
        }
    }
}

/// A separable filter for [`filter_rows`]: the index of the plane to be filtered, and the kernels
/// along and across the rows.
pub(super) type Filter<'k> = (usize, &'k Kernel, &'k Kernel);

/// Filters the planes of a picture and passes each row of results to `finish`, which computes a row
/// of output values.
///
/// `planes(y, rows)` writes row `y` of each plane into `rows`. Outside the picture, the values of
/// its edge pixels are repeated.
pub(super) fn filter_rows(
    (width, height): (usize, usize),
    plane_count: usize,
    filters: &[Filter],
    planes: impl Fn(usize, &mut [Vec<f32>]) + Sync,
    finish: impl Fn(usize, &[Vec<f32>], &mut [f32]) + Sync,
) -> Vec<f32> {
    let radius = filters.iter().map(|(_, along, across)| along.radius().max(across.radius())).max().unwrap_or(0);
    let mut out = vec![0.0; width * height];
    out.par_chunks_mut(width * BAND).enumerate().for_each(|(band, out)| {
        let first = band * BAND;
        let (low, high) = (first.saturating_sub(radius), (first + out.len() / width + radius).min(height));
        // Rows of the plane that each filter uses, already filtered along the row.
        let mut rows = vec![vec![0.0; width * (high - low)]; filters.len()];
        let mut source = vec![vec![0.0; width]; plane_count];
        let mut padded = vec![vec![0.0; width + 2 * radius]; plane_count];
        for y in low..high {
            planes(y, &mut source);
            for (padded, row) in padded.iter_mut().zip(&source) {
                padded[..radius].fill(row[0]);
                padded[radius..radius + width].copy_from_slice(row);
                padded[radius + width..].fill(row[width - 1]);
            }
            let at = (y - low) * width;
            for ((plane, along, _), rows) in filters.iter().zip(&mut rows) {
                along.along(&padded[*plane], radius, &mut rows[at..at + width]);
            }
        }
        let mut results = vec![vec![0.0; width]; filters.len()];
        for (i, out) in out.chunks_mut(width).enumerate() {
            for (((_, _, across), rows), result) in filters.iter().zip(&rows).zip(&mut results) {
                let row = |k: isize| {
                    let y = (first + i).saturating_add_signed(k).min(height - 1) - low;
                    &rows[y * width..(y + 1) * width]
                };
                across.across(row, result);
            }
            finish(first + i, &results, out);
        }
    });
    out
}

/// Mean of many numbers. The order of summation does not depend on the number of threads.
pub(super) fn mean(values: &[f32]) -> f64 {
    values.iter().map(|&value| f64::from(value)).sum::<f64>() / values.len().max(1) as f64
}
