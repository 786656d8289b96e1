//! Direct linear transform (DLT), which computes a camera from world points and their pixels. The
//! lens need not be known.
//!
//! The equation is x ~ P X with a 3x4 matrix P. Each point gives two equations that are linear in
//! P. In P = K [R | t], K is upper triangular.
//!
//! Source: Hartley, Zisserman, *Multiple View Geometry in Computer Vision*, 2nd edition, 2004,
//! sections 7.1 and 6.2.4.

use super::{normalization, null_vector};
use nalgebra::{DMatrix, Matrix3, Matrix3x4, Matrix4, Vector2, Vector3};

/// Result of the direct linear transform, with the 3x4 projection matrix and the singular values of
/// the equations.
pub struct DltSolution {
    /// Projection matrix P, up to scale.
    pub matrix: Matrix3x4<f64>,
    /// Singular values of the equations in Hartley's normalised coordinates, in decreasing order.
    /// The last singular value is the residual. If the second to last singular value is zero, the
    /// matrix is not unique.
    pub singular_values: Vec<f64>,
}

/// Returns the standard deviations of points along their principal axes, in decreasing order.
pub fn principal_deviations(points: &[Vector3<f64>]) -> [f64; 3] {
    let mean = points.iter().sum::<Vector3<f64>>() / points.len().max(1) as f64;
    let covariance = points.iter().map(|p| (p - mean) * (p - mean).transpose()).sum::<Matrix3<f64>>();
    let svd = (covariance / points.len().max(1) as f64).svd(false, false);
    let mut values: [f64; 3] = svd.singular_values.map(|v| v.max(0.0).sqrt()).into();
    values.sort_by(|a, b| b.total_cmp(a));
    values
}

/// Computes the least-squares projection matrix for six or more points.
pub fn solve_dlt(points: &[Vector3<f64>], pixels: &[Vector2<f64>]) -> Option<DltSolution> {
    if points.len() < 6 || points.len() != pixels.len() {
        return None;
    }
    let (s, m) = normalization(pixels.iter().copied());
    let mean = points.iter().sum::<Vector3<f64>>() / points.len() as f64;
    let size = points.iter().map(|p| (p - mean).norm()).sum::<f64>() / points.len() as f64;
    let scale = if size > 0.0 { 3f64.sqrt() / size } else { 1.0 };
    let rows = DMatrix::from_fn(2 * points.len(), 12, |row, column| {
        let p = (points[row / 2] - mean) * scale;
        let q = (pixels[row / 2] - m) * s;
        let p = [p.x, p.y, p.z, 1.0][column % 4];
        match (row % 2, column / 4) {
            (0, 0) | (1, 1) => p,
            (0, 2) => -q.x * p,
            (1, 2) => -q.y * p,
            _ => 0.0,
        }
    });
    let (v, singular_values) = null_vector(&rows);
    let back = Matrix3::new(1.0 / s, 0.0, m.x, 0.0, 1.0 / s, m.y, 0.0, 0.0, 1.0);
    let mut normal = Matrix4::identity() * scale;
    normal.fixed_view_mut::<3, 1>(0, 3).copy_from(&(-scale * mean));
    normal[(3, 3)] = 1.0;
    let matrix = back * Matrix3x4::from_row_slice(v.as_slice()) * normal;
    matrix.iter().all(|c| c.is_finite()).then_some(DltSolution { matrix, singular_values })
}

/// Decomposes P into K, R, and t. The last element of K is 1, and the signs are chosen so that
/// depths are positive.
pub fn decompose(p: &Matrix3x4<f64>) -> Option<(Matrix3<f64>, Matrix3<f64>, Vector3<f64>)> {
    let left = p.fixed_columns::<3>(0).into_owned();
    let p = if left.determinant() < 0.0 { -p } else { *p };
    let row = |i: usize| Vector3::new(p[(i, 0)], p[(i, 1)], p[(i, 2)]);
    // Apply Gram-Schmidt orthogonalisation to the rows, from the last to the first.
    let forward = row(2).try_normalize(1e-300)?;
    let down = (row(1) - row(1).dot(&forward) * forward).try_normalize(1e-300)?;
    let right = down.cross(&forward);
    let rotation = Matrix3::from_rows(&[right.transpose(), down.transpose(), forward.transpose()]);
    let k = p.fixed_columns::<3>(0) * rotation.transpose();
    let translation = k.try_inverse()? * p.column(3);
    Some((k / k[(2, 2)], rotation, translation))
}
