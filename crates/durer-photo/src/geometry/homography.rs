//! Homography between two photographs, which maps pixels from one to the other if the scene is
//! planar or the camera only rotated.
//!
//! Source: Hartley, Zisserman, *Multiple View Geometry in Computer Vision*, 2nd edition, 2004,
//! section 4.1.

use super::fundamental::Correspondence;
use super::ransac::RansacProblem;
use super::{normalization, null_vector};
use nalgebra::{DMatrix, Matrix3, Vector2, Vector3};

/// Maps a pixel with a homography.
pub fn map_pixel(h: &Matrix3<f64>, p: &Vector2<f64>) -> Vector2<f64> {
    let q = h * Vector3::new(p.x, p.y, 1.0);
    Vector2::new(q.x / q.z, q.y / q.z)
}

/// Estimates the homography from four or more pairs with the direct linear transform.
pub fn homography(pairs: &[Correspondence]) -> Option<Matrix3<f64>> {
    if pairs.len() < 4 {
        return None;
    }
    let one = normalization(pairs.iter().map(|pair| pair.0));
    let two = normalization(pairs.iter().map(|pair| pair.1));
    let rows = DMatrix::from_fn(2 * pairs.len(), 9, |row, column| {
        let a = (pairs[row / 2].0 - one.1) * one.0;
        let b = (pairs[row / 2].1 - two.1) * two.0;
        let a = [a.x, a.y, 1.0][column % 3];
        match (row % 2, column / 3) {
            (0, 0) | (1, 1) => a,
            (0, 2) => -b.x * a,
            (1, 2) => -b.y * a,
            _ => 0.0,
        }
    });
    let (v, _) = null_vector(&rows);
    let normal = |(s, m): (f64, Vector2<f64>)| Matrix3::new(s, 0.0, -s * m.x, 0.0, s, -s * m.y, 0.0, 0.0, 1.0);
    let h = normal(two).try_inverse()? * Matrix3::from_row_slice(v.as_slice()) * normal(one);
    h.iter().all(|c| c.is_finite()).then_some(h)
}

/// RANSAC problem of finding a homography from corresponding pixels in two photographs, which
/// include outliers from other planes.
pub struct HomographyProblem<'p>(pub &'p [Correspondence]);

impl RansacProblem<4> for HomographyProblem<'_> {
    type Model = Matrix3<f64>;

    fn count(&self) -> usize {
        self.0.len()
    }

    fn solve_minimal(&self, sample: &[usize; 4]) -> Vec<Matrix3<f64>> {
        homography(&sample.map(|i| self.0[i])).into_iter().collect()
    }

    fn refine(&self, inliers: &[usize], _: &Matrix3<f64>) -> Option<Matrix3<f64>> {
        homography(&inliers.iter().map(|i| self.0[*i]).collect::<Vec<_>>())
    }

    fn error(&self, model: &Matrix3<f64>, datum: usize) -> f64 {
        let (a, b) = &self.0[datum];
        (map_pixel(model, a) - b).norm_squared()
    }
}
