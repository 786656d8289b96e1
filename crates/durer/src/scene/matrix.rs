//! The matrices of a transform, as written.

use crate::math::{Vec3, fp};
use glam::{DAffine3, DMat3, DMat4, DVec3};
use serde::{Deserialize, Serialize};

/// One matrix of a transform. Rotations are right-handed, in degrees.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum MatrixOp {
    /// Moves.
    Translate(Vec3),
    /// Stretches along the axes.
    Scale(Vec3),
    /// Stretches evenly.
    UniformScale(f32),
    /// Turns about x.
    XRotate(f32),
    /// Turns about y.
    YRotate(f32),
    /// Turns about z.
    ZRotate(f32),
    /// Turns about an axis of any length.
    Rotate(Vec3, f32),
    /// Any affine matrix, row by row.
    Matrix([f32; 16]),
}

impl MatrixOp {
    /// The matrix.
    pub fn matrix(&self) -> DAffine3 {
        match *self {
            MatrixOp::Translate(v) => DAffine3::from_translation(v.as_dvec3()),
            MatrixOp::Scale(v) => DAffine3::from_scale(v.as_dvec3()),
            MatrixOp::UniformScale(s) => DAffine3::from_scale(DVec3::splat(f64::from(s))),
            MatrixOp::XRotate(degrees) => rotation(DVec3::X, degrees),
            MatrixOp::YRotate(degrees) => rotation(DVec3::Y, degrees),
            MatrixOp::ZRotate(degrees) => rotation(DVec3::Z, degrees),
            MatrixOp::Rotate(axis, degrees) => rotation(axis.as_dvec3().normalize_or(DVec3::Y), degrees),
            MatrixOp::Matrix(rows) => DAffine3::from_mat4(DMat4::from_cols_array(&rows.map(f64::from)).transpose()),
        }
    }

    /// The product of some matrices; with `matrix_on_left`, a `Matrix` is multiplied on the left of what is before it.
    pub fn product(ops: &[MatrixOp], matrix_on_left: bool) -> DAffine3 {
        ops.iter().fold(DAffine3::IDENTITY, |product, op| match op {
            MatrixOp::Matrix(_) if matrix_on_left => op.matrix() * product,
            _ => product * op.matrix(),
        })
    }
}

/// Rodrigues' rotation about a unit axis.
fn rotation(axis: DVec3, degrees: f32) -> DAffine3 {
    let (sin, cos) = fp::sin_cos_degrees(f64::from(degrees));
    let column = |v: DVec3| v * cos + axis.cross(v) * sin + axis * (axis.dot(v) * (1.0 - cos));
    DAffine3::from_mat3(DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z)))
}

#[cfg(test)]
mod tests;
