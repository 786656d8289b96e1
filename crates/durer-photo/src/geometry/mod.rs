//! Multiple-view geometry, with minimal and least-squares solvers for camera matrices and poses,
//! and RANSAC.

pub mod align;
pub mod camera;
pub mod essential;
pub mod fundamental;
pub mod homography;
pub mod p3p;
pub mod polynomial;
pub mod ransac;
pub mod triangulate;

use nalgebra::{DMatrix, DVector, Vector2};

/// Returns the unit vector v that minimises |A v|, and the singular values of A in decreasing
/// order.
pub fn null_vector(matrix: &DMatrix<f64>) -> (DVector<f64>, Vec<f64>) {
    // A QR decomposition reduces the size of the matrix. The eigenvectors of AᵀA would lose half of
    // the digits.
    let square = if matrix.nrows() > matrix.ncols() { matrix.clone().qr().r() } else { padded(matrix) };
    let svd = square.svd(false, true);
    let mut order: Vec<usize> = (0..svd.singular_values.len()).collect();
    order.sort_by(|a, b| svd.singular_values[*b].total_cmp(&svd.singular_values[*a]));
    let last = order[order.len() - 1];
    let vector = svd.v_t.map(|v| v.row(last).transpose()).unwrap_or_else(|| DVector::zeros(matrix.ncols()));
    (vector, order.into_iter().map(|i| svd.singular_values[i]).collect())
}

/// Appends rows of zeros to a matrix until it is square.
fn padded(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let side = matrix.ncols().max(matrix.nrows());
    matrix.clone().resize(side, matrix.ncols(), 0.0)
}

/// Returns the scale and the mean of Hartley's normalisation, which moves the mean of the points to
/// 0 and gives them a mean distance of √2 from it. Source: Hartley, *In Defense of the Eight-Point
/// Algorithm*, PAMI 19(6), 1997.
pub fn normalization(points: impl Iterator<Item = Vector2<f64>> + Clone) -> (f64, Vector2<f64>) {
    let count = points.clone().count().max(1) as f64;
    let mean = points.clone().sum::<Vector2<f64>>() / count;
    let spread = points.map(|point| (point - mean).norm()).sum::<f64>() / count;
    (if spread > 0.0 { std::f64::consts::SQRT_2 / spread } else { 1.0 }, mean)
}
