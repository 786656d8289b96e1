//! Vectors and matrices of the judge's tracer, in double precision and independent of the library.

use std::ops::{Add, Mul, Neg, Sub};

/// Vector of three numbers, also used for points and colours.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vec3(pub f64, pub f64, pub f64);

impl Add for Vec3 {
    type Output = Vec3;
    fn add(self, o: Vec3) -> Vec3 {
        Vec3(self.0 + o.0, self.1 + o.1, self.2 + o.2)
    }
}

impl Sub for Vec3 {
    type Output = Vec3;
    fn sub(self, o: Vec3) -> Vec3 {
        Vec3(self.0 - o.0, self.1 - o.1, self.2 - o.2)
    }
}

impl Neg for Vec3 {
    type Output = Vec3;
    fn neg(self) -> Vec3 {
        self * -1.0
    }
}

impl Mul<f64> for Vec3 {
    type Output = Vec3;
    fn mul(self, f: f64) -> Vec3 {
        Vec3(self.0 * f, self.1 * f, self.2 * f)
    }
}

/// Multiplies component by component.
impl Mul for Vec3 {
    type Output = Vec3;
    fn mul(self, o: Vec3) -> Vec3 {
        Vec3(self.0 * o.0, self.1 * o.1, self.2 * o.2)
    }
}

impl Vec3 {
    /// Vector of zeros.
    pub const ZERO: Vec3 = Vec3(0.0, 0.0, 0.0);
    /// Vector of ones.
    pub const ONE: Vec3 = Vec3(1.0, 1.0, 1.0);

    /// Returns the dot product.
    pub fn dot(self, o: Vec3) -> f64 {
        self.0 * o.0 + self.1 * o.1 + self.2 * o.2
    }

    /// Returns the cross product.
    pub fn cross(self, o: Vec3) -> Vec3 {
        Vec3(self.1 * o.2 - self.2 * o.1, self.2 * o.0 - self.0 * o.2, self.0 * o.1 - self.1 * o.0)
    }

    /// Returns the length.
    pub fn length(self) -> f64 {
        self.dot(self).sqrt()
    }

    /// Returns the vector scaled to length 1.
    pub fn unit(self) -> Vec3 {
        self * (1.0 / self.length())
    }

    /// Applies a function to each component.
    pub fn map(self, f: impl Fn(f64) -> f64) -> Vec3 {
        Vec3(f(self.0), f(self.1), f(self.2))
    }

    /// Returns the largest component.
    pub fn max_component(self) -> f64 {
        self.0.max(self.1).max(self.2)
    }
}

/// Affine transform: a 3 x 3 matrix by rows, and a translation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Matrix {
    pub rows: [Vec3; 3],
    pub by: Vec3,
}

impl Matrix {
    /// Identity.
    pub const ONE: Matrix =
        Matrix { rows: [Vec3(1.0, 0.0, 0.0), Vec3(0.0, 1.0, 0.0), Vec3(0.0, 0.0, 1.0)], by: Vec3::ZERO };

    /// Transforms a vector, without the translation.
    pub fn vector(&self, v: Vec3) -> Vec3 {
        Vec3(self.rows[0].dot(v), self.rows[1].dot(v), self.rows[2].dot(v))
    }

    /// Transforms a point.
    pub fn point(&self, p: Vec3) -> Vec3 {
        self.vector(p) + self.by
    }

    /// Returns the transposed 3 x 3 matrix, without the translation.
    pub fn transposed(&self) -> Matrix {
        let [a, b, c] = self.rows;
        Matrix { rows: [Vec3(a.0, b.0, c.0), Vec3(a.1, b.1, c.1), Vec3(a.2, b.2, c.2)], by: Vec3::ZERO }
    }

    /// Returns the product, which applies `o` first and then `self`.
    pub fn times(&self, o: &Matrix) -> Matrix {
        let columns = o.transposed().rows;
        let row = |r: Vec3| Vec3(r.dot(columns[0]), r.dot(columns[1]), r.dot(columns[2]));
        Matrix { rows: self.rows.map(row), by: self.point(o.by) }
    }

    /// Returns the inverse.
    pub fn inverse(&self) -> Matrix {
        let [a, b, c] = self.transposed().rows;
        let det = a.dot(b.cross(c));
        let rows = [b.cross(c) * (1.0 / det), c.cross(a) * (1.0 / det), a.cross(b) * (1.0 / det)];
        let linear = Matrix { rows, by: Vec3::ZERO };
        Matrix { by: -linear.vector(self.by), ..linear }
    }
}
