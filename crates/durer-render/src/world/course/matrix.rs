//! Single-precision 4 x 4 matrices whose products, inverses and decompositions use the arithmetic
//! of the course's programs.

use super::VectorLibrary;
use durer_scene::math::{Vec3, fp};
use durer_scene::scene::{MatrixOp, MatrixRules};
use glam::DAffine3;

/// Single-precision 4 x 4 transformation matrix, as used by the course's programs, stored by
/// columns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Matrix([[f32; 4]; 4]);

impl Matrix {
    /// Identity matrix.
    pub const IDENTITY: Matrix =
        Matrix([[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]]);

    /// Returns the product of all matrices in a transform.
    pub fn of(ops: &[MatrixOp], rules: MatrixRules, vectors: VectorLibrary) -> Self {
        let product = ops.iter().fold(Matrix::IDENTITY, |product, op| {
            let own = Matrix::from(op);
            match op {
                MatrixOp::Matrix(_) if rules.matrix_on_left => own.times(&product, vectors),
                _ => product.times(&own, vectors),
            }
        });
        match () {
            () if rules.ignore_tiny && MatrixOp::is_tiny(ops, rules) => Matrix::IDENTITY,
            () if rules.drop_shear => product.without_shear(),
            () => product,
        }
    }

    /// Returns the product `self` · `other`, which applies `other` first.
    pub fn times(&self, other: &Matrix, vectors: VectorLibrary) -> Matrix {
        let entry = |row: usize, column: usize| {
            let [a, b, c, d] = [0, 1, 2, 3].map(|i| self.0[i][row] * other.0[column][i]);
            vectors.sum_from(a) + b + c + d
        };
        Matrix([0, 1, 2, 3].map(|column| [0, 1, 2, 3].map(|row| entry(row, column))))
    }

    /// Transforms a point, with the arithmetic of the given vector library.
    pub fn point(&self, p: Vec3, vectors: VectorLibrary) -> Vec3 {
        let row = |row: usize| {
            let [x, y, z, w] = self.0.map(|column| column[row]);
            match vectors {
                VectorLibrary::Vecmath => vectors.sum_from(x * p.x) + y * p.y + z * p.z + w,
                VectorLibrary::Glm => (x * p.x + y * p.y) + (z * p.z + w),
            }
        };
        Vec3::new(row(0), row(1), row(2))
    }

    /// Transforms a vector, with the arithmetic of the course's own library.
    pub fn vector(&self, v: Vec3) -> Vec3 {
        let row = |row: usize| {
            let [x, y, z] = [0, 1, 2].map(|column| self.0[column][row] * v[column]);
            VectorLibrary::Vecmath.sum_from(x) + y + z
        };
        Vec3::new(row(0), row(1), row(2))
    }

    /// Multiplies a normal by the transposed matrix.
    pub fn across(&self, n: Vec3, vectors: VectorLibrary) -> Vec3 {
        let [x, y, z] = [0, 1, 2].map(|column| {
            let [a, b, c] = [0, 1, 2].map(|row| self.0[column][row] * n[row]);
            vectors.sum_from(a) + b + c
        });
        Vec3::new(x, y, z)
    }

    /// Returns true if all entries of the matrix and its inverse are finite.
    pub fn is_regular(&self) -> bool {
        let inverse = self.inverse(VectorLibrary::Vecmath);
        [self, &inverse].iter().all(|matrix| matrix.0.iter().flatten().all(|x| x.is_finite()))
    }

    /// Returns the inverse, computed as cofactors times the reciprocal of the determinant. If the
    /// matrix is singular, the entries of the result are infinite or NaN.
    pub fn inverse(&self, vectors: VectorLibrary) -> Matrix {
        match vectors {
            VectorLibrary::Vecmath => self.inverse_by_minors(),
            VectorLibrary::Glm => self.inverse_by_factors(),
        }
    }

    /// Inverts the matrix by means of its cofactors, which are 3 x 3 determinants. The rows and
    /// columns of each cofactor start after its own row and column and wrap around at the edge of
    /// the matrix.
    fn inverse_by_minors(&self) -> Matrix {
        let m = |row: usize, column: usize| self.0[column][row];
        let cofactor = |row: usize, column: usize| {
            let [rows, columns] = [row, column].map(|at| [1, 2, 3].map(|i| (at + i) % 4));
            let n = |i: usize, j: usize| m(rows[i], columns[j]);
            let minor = n(0, 0) * (n(1, 1) * n(2, 2) - n(1, 2) * n(2, 1))
                - n(0, 1) * (n(1, 0) * n(2, 2) - n(1, 2) * n(2, 0))
                + n(0, 2) * (n(1, 0) * n(2, 1) - n(1, 1) * n(2, 0));
            if (row + column).is_multiple_of(2) { minor } else { -minor }
        };
        let [a, b, c, d] = [0, 1, 2, 3].map(|column| m(0, column) * cofactor(0, column));
        let reciprocal = 1.0 / (a + b + c + d);
        // The inverse is the transposed matrix of cofactors divided by the determinant.
        Matrix([0, 1, 2, 3].map(|column| [0, 1, 2, 3].map(|row| cofactor(column, row) * reciprocal)))
    }

    /// Inverts the matrix as glm does, using 2 x 2 determinants that several cofactors share.
    fn inverse_by_factors(&self) -> Matrix {
        let m = &self.0;
        // Returns the 2 x 2 determinant of columns i and j and rows p and q.
        let pair = |i: usize, j: usize, p: usize, q: usize| m[i][p] * m[j][q] - m[j][p] * m[i][q];
        let columns = [(2, 3), (1, 3), (1, 2)];
        let factor = |p: usize, q: usize| {
            let [a, b, c] = columns.map(|(i, j)| pair(i, j, p, q));
            [a, a, b, c]
        };
        let factors = [factor(2, 3), factor(1, 3), factor(1, 2), factor(0, 3), factor(0, 2), factor(0, 1)];
        let rows = [0, 1, 2, 3].map(|row| [m[1][row], m[0][row], m[0][row], m[0][row]]);
        let column = |terms: [(usize, usize); 3], odd: usize| {
            [0, 1, 2, 3].map(|i| {
                let [a, b, c] = terms.map(|(row, factor)| rows[row][i] * factors[factor][i]);
                let sum = a - b + c;
                if i % 2 == odd { sum } else { -sum }
            })
        };
        let cofactors = [
            column([(1, 0), (2, 1), (3, 2)], 0),
            column([(0, 0), (2, 3), (3, 4)], 1),
            column([(0, 1), (1, 3), (3, 5)], 0),
            column([(0, 2), (1, 4), (2, 5)], 1),
        ];
        let [a, b, c, d] = [0, 1, 2, 3].map(|i| m[0][i] * cofactors[i][0]);
        let reciprocal = 1.0 / ((a + b) + (c + d));
        Matrix(cofactors.map(|column| column.map(|x| x * reciprocal)))
    }

    /// Removes the shear, as happens when glm's `decompose` splits a matrix into translation,
    /// rotation and scale and these are multiplied again.
    ///
    /// Source: Spencer W. Thomas, *Decomposing a Matrix into Simple Transformations*, Graphics Gems
    /// II (1991), VII.1.
    fn without_shear(&self) -> Matrix {
        let [x, y, z, translation] = self.0.map(|[x, y, z, _]| Vec3::new(x, y, z));
        let unit = |v: Vec3| v * 1.0 / v.length();
        let mut axes = [x, y, z];
        let mut scale = Vec3::ZERO;
        scale.x = axes[0].length();
        axes[0] = unit(axes[0]);
        axes[1] -= axes[0].dot(axes[1]) * axes[0];
        scale.y = axes[1].length();
        axes[1] = unit(axes[1]);
        axes[2] -= axes[0].dot(axes[2]) * axes[0];
        axes[2] -= axes[1].dot(axes[2]) * axes[1];
        scale.z = axes[2].length();
        axes[2] = unit(axes[2]);
        if axes[0].dot(axes[1].cross(axes[2])) < 0.0 {
            scale = -scale;
            axes = axes.map(|axis| -axis);
        }
        let [x, y, z, w] = quaternion(axes);
        let rotation = [
            Vec3::new(1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)),
            Vec3::new(2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x)),
            Vec3::new(2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)),
        ];
        let column = |v: Vec3, w: f32| [v.x, v.y, v.z, w];
        Matrix([
            column(rotation[0] * scale.x, 0.0),
            column(rotation[1] * scale.y, 0.0),
            column(rotation[2] * scale.z, 0.0),
            column(translation, 1.0),
        ])
    }
}

/// Returns the quaternion (x, y, z, w) of the rotation that maps the coordinate axes to three given
/// axes.
fn quaternion(axes: [Vec3; 3]) -> [f32; 4] {
    let trace = axes[0].x + axes[1].y + axes[2].z;
    let mut q = [0.0; 4];
    if trace > 0.0 {
        let root = (trace + 1.0).sqrt();
        let factor = 0.5 / root;
        q[0] = factor * (axes[1].z - axes[2].y);
        q[1] = factor * (axes[2].x - axes[0].z);
        q[2] = factor * (axes[0].y - axes[1].x);
        q[3] = 0.5 * root;
        return q;
    }
    let mut i = usize::from(axes[1].y > axes[0].x);
    if axes[2].z > axes[i][i] {
        i = 2;
    }
    let (j, k) = ((i + 1) % 3, (i + 2) % 3);
    let root = (axes[i][i] - axes[j][j] - axes[k][k] + 1.0).sqrt();
    let factor = 0.5 / root;
    q[i] = 0.5 * root;
    q[j] = factor * (axes[i][j] + axes[j][i]);
    q[k] = factor * (axes[i][k] + axes[k][i]);
    q[3] = factor * (axes[j][k] - axes[k][j]);
    q
}

impl From<&MatrixOp> for Matrix {
    fn from(op: &MatrixOp) -> Self {
        let columns = |x: Vec3, y: Vec3, z: Vec3, w: Vec3| {
            Matrix([[x.x, x.y, x.z, 0.0], [y.x, y.y, y.z, 0.0], [z.x, z.y, z.z, 0.0], [w.x, w.y, w.z, 1.0]])
        };
        let scale = |v: Vec3| columns(v.x * Vec3::X, v.y * Vec3::Y, v.z * Vec3::Z, Vec3::ZERO);
        match *op {
            MatrixOp::Translate(v) => columns(Vec3::X, Vec3::Y, Vec3::Z, v),
            MatrixOp::Scale(v) => scale(v),
            MatrixOp::UniformScale(s) => scale(Vec3::splat(s)),
            MatrixOp::XRotate(degrees) => rotation(Vec3::X, degrees),
            MatrixOp::YRotate(degrees) => rotation(Vec3::Y, degrees),
            MatrixOp::ZRotate(degrees) => rotation(Vec3::Z, degrees),
            MatrixOp::Rotate(axis, degrees) => rotation(VectorLibrary::Vecmath.unit(axis), degrees),
            MatrixOp::Matrix(rows) => Matrix([0, 1, 2, 3].map(|i| [0, 1, 2, 3].map(|j| rows[4 * j + i]))),
        }
    }
}

impl From<DAffine3> for Matrix {
    /// Rounds each entry to single precision once.
    fn from(map: DAffine3) -> Self {
        let column = |v: glam::DVec3, w: f32| [v.x as f32, v.y as f32, v.z as f32, w];
        let m = map.matrix3;
        Matrix([column(m.x_axis, 0.0), column(m.y_axis, 0.0), column(m.z_axis, 0.0), column(map.translation, 1.0)])
    }
}

/// Returns the matrix of a rotation about a unit axis, computed with Rodrigues' formula.
fn rotation(Vec3 { x, y, z }: Vec3, degrees: f32) -> Matrix {
    let radians = (std::f64::consts::PI * f64::from(degrees) / 180.0) as f32;
    let (sin, cos) = fp::sin_cos_f64(f64::from(radians));
    let (s, c) = (sin as f32, cos as f32);
    let rest = 1.0 - c;
    Matrix([
        [x * x * rest + c, x * y * rest + z * s, x * z * rest - y * s, 0.0],
        [y * x * rest - z * s, y * y * rest + c, y * z * rest + x * s, 0.0],
        [z * x * rest + y * s, z * y * rest - x * s, z * z * rest + c, 0.0],
        [0.0, 0.0, 0.0, 1.0],
    ])
}

#[cfg(test)]
mod tests;
