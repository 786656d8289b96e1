//! Fundamental matrix of two photographs, computed from seven correspondences (one to three
//! solutions) or from eight or more (one solution).
//!
//! The equation x'ᵀ F x = 0 holds for pixels x and x' of the same point in the first and the second
//! photograph.
//!
//! Source: Hartley, Zisserman, *Multiple View Geometry in Computer Vision*, 2nd edition, 2004,
//! sections 11.1 to 11.4.

use super::polynomial::real_roots;
use super::ransac::RansacProblem;
use super::{normalization, null_vector};
use nalgebra::{DMatrix, DVector, Matrix3, Vector2, Vector3};

/// Correspondence, which consists of the positions of a scene point in two photographs.
pub type Correspondence = (Vector2<f64>, Vector2<f64>);

fn homogeneous(p: &Vector2<f64>) -> Vector3<f64> {
    Vector3::new(p.x, p.y, 1.0)
}

/// Returns the squared Sampson distance. To first order, it is the squared distance by which the
/// two positions must move to satisfy the epipolar equation.
pub fn sampson(f: &Matrix3<f64>, (a, b): &Correspondence) -> f64 {
    let (a, b) = (homogeneous(a), homogeneous(b));
    let (fa, fb) = (f * a, f.transpose() * b);
    let product = b.dot(&fa);
    product * product / (fa.xy().norm_squared() + fb.xy().norm_squared())
}

/// Returns the linear equations for F, with one row per pair. Positions are normalised by the
/// `(scale, mean)` of each photograph.
fn equations(pairs: &[Correspondence], [one, two]: [(f64, Vector2<f64>); 2]) -> DMatrix<f64> {
    DMatrix::from_fn(pairs.len(), 9, |row, column| {
        let (a, b) = pairs[row];
        let (a, b) = (homogeneous(&((a - one.1) * one.0)), homogeneous(&((b - two.1) * two.0)));
        b[column / 3] * a[column % 3]
    })
}

fn normalizations(pairs: &[Correspondence]) -> [(f64, Vector2<f64>); 2] {
    [normalization(pairs.iter().map(|pair| pair.0)), normalization(pairs.iter().map(|pair| pair.1))]
}

fn matrix_of(v: &DVector<f64>) -> Matrix3<f64> {
    Matrix3::from_row_slice(v.as_slice())
}

/// Converts F from normalised coordinates to pixels.
fn denormalized(f: Matrix3<f64>, [one, two]: [(f64, Vector2<f64>); 2]) -> Matrix3<f64> {
    let matrix = |(s, m): (f64, Vector2<f64>)| Matrix3::new(s, 0.0, -s * m.x, 0.0, s, -s * m.y, 0.0, 0.0, 1.0);
    let f = matrix(two).transpose() * f * matrix(one);
    f / f.norm()
}

/// Estimates F from eight or more pairs with Hartley's normalised eight-point algorithm.
pub fn eight_point(pairs: &[Correspondence]) -> Option<Matrix3<f64>> {
    if pairs.len() < 8 {
        return None;
    }
    let normal = normalizations(pairs);
    let (v, _) = null_vector(&equations(pairs, normal));
    let svd = matrix_of(&v).svd(true, true);
    let mut values = svd.singular_values;
    let least = values.imin();
    values[least] = 0.0;
    let f = svd.u? * Matrix3::from_diagonal(&values) * svd.v_t?;
    Some(denormalized(f, normal)).filter(|f| f.iter().all(|c| c.is_finite()))
}

/// Computes the one to three fundamental matrices that fit seven pairs.
pub fn seven_point(pairs: &[Correspondence; 7]) -> Vec<Matrix3<f64>> {
    let normal = normalizations(pairs);
    let svd = super::padded(&equations(pairs, normal)).svd(false, true);
    let Some(v) = svd.v_t else { return Vec::new() };
    let row = |i: usize| matrix_of(&v.row(i).transpose());
    // The singular values are in decreasing order, so the last two rows span the null space.
    let (a, b) = (row(7), row(8));
    // The determinant det(a + x b) is a cubic, so four values determine its coefficients.
    let at = |x: f64| (a + x * b).determinant();
    let (c0, c3, plus, minus) = (at(0.0), b.determinant(), at(1.0), at(-1.0));
    let c2 = (plus + minus) / 2.0 - c0;
    let c1 = (plus - minus) / 2.0 - c3;
    real_roots(&[c0, c1, c2, c3]).into_iter().map(|x| denormalized(a + x * b, normal)).collect()
}

/// RANSAC problem of finding the fundamental matrix from corresponding pixels in two photographs,
/// which include outliers.
pub struct FundamentalProblem<'p>(pub &'p [Correspondence]);

impl RansacProblem<7> for FundamentalProblem<'_> {
    type Model = Matrix3<f64>;

    fn count(&self) -> usize {
        self.0.len()
    }

    fn solve_minimal(&self, sample: &[usize; 7]) -> Vec<Matrix3<f64>> {
        seven_point(&sample.map(|i| self.0[i]))
    }

    fn refine(&self, inliers: &[usize], _: &Matrix3<f64>) -> Option<Matrix3<f64>> {
        eight_point(&inliers.iter().map(|i| self.0[*i]).collect::<Vec<_>>())
    }

    fn error(&self, model: &Matrix3<f64>, datum: usize) -> f64 {
        sampson(model, &self.0[datum])
    }
}
