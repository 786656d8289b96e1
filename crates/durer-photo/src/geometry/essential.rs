//! Essential matrix of two photographs with known lenses, computed from five correspondences. There
//! are up to ten solutions.
//!
//! The equation q'ᵀ E q = 0 holds for the directions q and q' in which two cameras see a point.
//! Here, E = \[t\]× R, where (R, t) is the pose of the second camera in the frame of the first. E
//! lies in the null space of five equations, E = x X + y Y + z Z + W. The conditions 2 E Eᵀ E =
//! tr(E Eᵀ) E and det E = 0 are ten cubics in x, y, z. Elimination leaves a polynomial of degree
//! ten in z.
//!
//! Source: Nistér, *An Efficient Solution to the Five-Point Relative Pose Problem*, PAMI 26(6),
//! 2004.

use super::fundamental::{Correspondence, eight_point, sampson};
use super::polynomial::real_roots;
use super::ransac::RansacProblem;
use super::triangulate::two_views;
use crate::Pose;
use nalgebra::{Matrix3, SMatrix, Vector3};

/// Exponents of x, y, z in the monomials of a cubic, in Nistér's order. Elimination leaves only the
/// last ten monomials, and combinations of the form x zⁿ, y zⁿ, and zⁿ.
const MONOMIALS: [[usize; 3]; 20] = [
    [3, 0, 0],
    [0, 3, 0],
    [2, 1, 0],
    [1, 2, 0],
    [2, 0, 1],
    [2, 0, 0],
    [0, 2, 1],
    [0, 2, 0],
    [1, 1, 1],
    [1, 1, 0],
    [1, 0, 2],
    [1, 0, 1],
    [1, 0, 0],
    [0, 1, 2],
    [0, 1, 1],
    [0, 1, 0],
    [0, 0, 3],
    [0, 0, 2],
    [0, 0, 1],
    [0, 0, 0],
];

/// Coefficients of a polynomial in x, y, z of degree at most three.
type Cubic = [f64; 20];

/// Returns the index of a monomial in [`MONOMIALS`].
fn monomial_index(exponents: [usize; 3]) -> usize {
    MONOMIALS.iter().position(|m| *m == exponents).unwrap_or(usize::MAX)
}

/// Returns the index of the product of each pair of monomials, or [`usize::MAX`] if the degree of
/// the product exceeds three.
fn products() -> [[usize; 20]; 20] {
    let product = |a: usize, b: usize| monomial_index([0, 1, 2].map(|i| MONOMIALS[a][i] + MONOMIALS[b][i]));
    std::array::from_fn(|a| std::array::from_fn(|b| product(a, b)))
}

/// Multiplies cubic polynomials, based on a table of the products of monomials.
struct Algebra([[usize; 20]; 20]);

impl Algebra {
    fn multiply(&self, a: &Cubic, b: &Cubic) -> Cubic {
        let mut product = [0.0; 20];
        for (i, a) in a.iter().enumerate().filter(|(_, a)| **a != 0.0) {
            for (j, b) in b.iter().enumerate().filter(|(_, b)| **b != 0.0) {
                product[self.0[i][j]] += a * b;
            }
        }
        product
    }

    /// Returns the sum of three products of polynomials.
    fn dot(&self, pairs: [(&Cubic, &Cubic); 3]) -> Cubic {
        pairs.iter().fold([0.0; 20], |sum, (a, b)| plus(&sum, &self.multiply(a, b), 1.0))
    }
}

fn plus(a: &Cubic, b: &Cubic, factor: f64) -> Cubic {
    std::array::from_fn(|i| a[i] + factor * b[i])
}

/// Computes up to ten essential matrices from five pairs of directions of the form (x, y, 1).
pub fn five_point(pairs: &[Correspondence; 5]) -> Vec<Matrix3<f64>> {
    solutions(pairs).unwrap_or_default()
}

fn solutions(pairs: &[Correspondence; 5]) -> Option<Vec<Matrix3<f64>>> {
    let rows = SMatrix::<f64, 9, 9>::from_fn(|row, column| {
        let Some((a, b)) = pairs.get(row) else { return 0.0 };
        [b.x, b.y, 1.0][column / 3] * [a.x, a.y, 1.0][column % 3]
    });
    let v = rows.svd(false, true).v_t?;
    let basis = [5, 6, 7, 8].map(|i| Matrix3::from_row_slice(v.row(i).transpose().as_slice()));
    let algebra = Algebra(products());
    let variables = [[1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 0]].map(monomial_index);
    let e: [[Cubic; 3]; 3] = std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let mut entry = [0.0; 20];
            (0..4).for_each(|k| entry[variables[k]] = basis[k][(i, j)]);
            entry
        })
    });
    let minor =
        |a: &Cubic, b: &Cubic, c: &Cubic, d: &Cubic| plus(&algebra.multiply(a, b), &algebra.multiply(c, d), -1.0);
    let determinant = algebra.dot([
        (&e[0][0], &minor(&e[1][1], &e[2][2], &e[1][2], &e[2][1])),
        (&e[0][1], &minor(&e[1][2], &e[2][0], &e[1][0], &e[2][2])),
        (&e[0][2], &minor(&e[1][0], &e[2][1], &e[1][1], &e[2][0])),
    ]);
    // Define L = E Eᵀ - tr(E Eᵀ) / 2, so that L E = 0.
    let mut l: [[Cubic; 3]; 3] =
        std::array::from_fn(|i| std::array::from_fn(|j| algebra.dot([0, 1, 2].map(|k| (&e[i][k], &e[j][k])))));
    let trace = plus(&plus(&l[0][0], &l[1][1], 1.0), &l[2][2], 1.0);
    (0..3).for_each(|i| l[i][i] = plus(&l[i][i], &trace, -0.5));
    let mut all = SMatrix::<f64, 10, 20>::zeros();
    let entry = |row: usize| match row {
        9 => determinant,
        row => algebra.dot([0, 1, 2].map(|k| (&l[row / 3][k], &e[k][row % 3]))),
    };
    (0..10).for_each(|row| all.row_mut(row).copy_from_slice(&entry(row)));
    let left = all.fixed_columns::<10>(0).into_owned();
    let right = left.lu().solve(&all.fixed_columns::<10>(10).into_owned())?;
    // The pairs of rows are (x²z, x²), (y²z, y²), (xyz, xy). The first row of a pair minus z times
    // the second contains only x, y, and powers of z.
    let polynomials = [4, 6, 8].map(|row| {
        let (a, b) = (right.row(row), right.row(row + 1));
        let part = |at: usize, degree: usize| {
            // Coefficients of zⁿ, starting with the constant term.
            let mut p = [0.0; 5];
            for n in 0..=degree {
                p[n] += a[at + degree - n];
                p[n + 1] -= b[at + degree - n];
            }
            p
        };
        [part(0, 2), part(3, 2), part(6, 3)]
    });
    let product = |a: &[f64], b: &[f64]| {
        let mut p = vec![0.0; a.len() + b.len() - 1];
        a.iter().enumerate().for_each(|(i, a)| b.iter().enumerate().for_each(|(j, b)| p[i + j] += a * b));
        p
    };
    let cross = |i: usize, j: usize, a: usize, b: usize| -> Vec<f64> {
        let one = product(&polynomials[i][a], &polynomials[j][b]);
        let two = product(&polynomials[i][b], &polynomials[j][a]);
        one.iter().zip(two).map(|(one, two)| one - two).collect()
    };
    let terms = [(0, cross(1, 2, 1, 2)), (1, cross(1, 2, 2, 0)), (2, cross(1, 2, 0, 1))]
        .map(|(column, minor)| product(&polynomials[0][column], &minor));
    let whole: Vec<f64> = (0..=10).map(|n| terms.iter().map(|term| term[n]).sum()).collect();
    let at = |p: &[f64; 5], z: f64| p.iter().rev().fold(0.0, |sum, c| sum * z + c);
    let mut solutions = Vec::new();
    for z in real_roots(&whole) {
        let m = Matrix3::from_fn(|i, j| at(&polynomials[i][j], z));
        // The vector (x, y, 1) is orthogonal to all rows. The largest cross product of two rows is
        // the most accurate.
        let crosses = [(0, 1), (0, 2), (1, 2)].map(|(i, j)| m.row(i).transpose().cross(&m.row(j).transpose()));
        let best = crosses.into_iter().fold(Vector3::zeros(), |a, b| if b.norm() > a.norm() { b } else { a });
        let (x, y) = (best.x / best.z, best.y / best.z);
        let e = basis[0] * x + basis[1] * y + basis[2] * z + basis[3];
        if e.iter().all(|c| c.is_finite()) {
            solutions.push(e / e.norm());
        }
    }
    Some(solutions)
}

/// Returns the four possible poses of the second camera, with a translation of length 1.
pub fn poses(e: &Matrix3<f64>) -> Option<[Pose; 4]> {
    let svd = e.svd(true, true);
    let (mut u, mut v) = (svd.u?, svd.v_t?);
    // The smallest singular value is the last one and is nearly 0. Both matrices must be rotations.
    if u.determinant() < 0.0 {
        u.column_mut(2).neg_mut();
    }
    if v.determinant() < 0.0 {
        v.row_mut(2).neg_mut();
    }
    let w = Matrix3::new(0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
    let (a, b, t) = (u * w * v, u * w.transpose() * v, u.column(2).into_owned());
    let pose = |rotation, translation| Pose { rotation, translation };
    Some([pose(a, t), pose(a, -t), pose(b, t), pose(b, -t)])
}

/// Returns the pose for which the most points are in front of both cameras, and the number of these
/// points.
pub fn pose_in_front(e: &Matrix3<f64>, pairs: &[Correspondence]) -> Option<(Pose, usize)> {
    let before = |pose: &Pose| {
        let in_front = |pair: &&Correspondence| {
            let point = two_views(pose, pair);
            point.z > 0.0 && pose.depth(&point) > 0.0
        };
        pairs.iter().filter(in_front).count()
    };
    let counted = poses(e)?.into_iter().map(|pose| (pose, before(&pose)));
    counted.reduce(|best, next| if next.1 > best.1 { next } else { best })
}

/// RANSAC problem of finding the essential matrix from corresponding directions (x, y, 1) in two
/// photographs, which include outliers.
pub struct EssentialProblem<'p>(pub &'p [Correspondence]);

impl RansacProblem<5> for EssentialProblem<'_> {
    type Model = Matrix3<f64>;

    fn count(&self) -> usize {
        self.0.len()
    }

    fn solve_minimal(&self, sample: &[usize; 5]) -> Vec<Matrix3<f64>> {
        five_point(&sample.map(|i| self.0[i]))
    }

    fn refine(&self, inliers: &[usize], _: &Matrix3<f64>) -> Option<Matrix3<f64>> {
        let e = eight_point(&inliers.iter().map(|i| self.0[*i]).collect::<Vec<_>>())?;
        let svd = e.svd(true, true);
        // Project onto the set of essential matrices, whose singular values are 1, 1, 0.
        let mut values = Vector3::new(1.0, 1.0, 1.0);
        values[svd.singular_values.imin()] = 0.0;
        Some(svd.u? * Matrix3::from_diagonal(&values) * svd.v_t?)
    }

    fn error(&self, model: &Matrix3<f64>, datum: usize) -> f64 {
        sampson(model, &self.0[datum])
    }
}
