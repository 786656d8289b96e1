//! Matrices of a transform, as they are written in a scene.

use crate::math::{Vec3, fp};
use glam::{DAffine3, DMat3, DMat4, DVec3};
use serde::{Deserialize, Serialize};

/// Matrix of a transform, which is one operation in a scene file. Rotations are right-handed, and
/// their angles are in degrees.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum MatrixOp {
    /// Translation.
    Translate(Vec3),
    /// Scaling along the axes.
    Scale(Vec3),
    /// Uniform scaling.
    UniformScale(f32),
    /// Rotation about the x axis.
    XRotate(f32),
    /// Rotation about the y axis.
    YRotate(f32),
    /// Rotation about the z axis.
    ZRotate(f32),
    /// Rotation about an axis of any length.
    Rotate(Vec3, f32),
    /// Affine matrix, row by row.
    Matrix([f32; 16]),
}

/// Rules by which a dialect multiplies the matrices of a transform. The defaults are Dürer's own
/// rules.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MatrixRules {
    /// True if a `Matrix` is multiplied from the left onto the product of all preceding matrices.
    pub matrix_on_left: bool,
    /// True if shear is removed from the product of the matrices of one transform. The product is
    /// then decomposed into translation, rotation and scale.
    pub drop_shear: bool,
    /// True if a transform whose determinant is almost 0 is ignored.
    pub ignore_tiny: bool,
}

impl MatrixOp {
    /// One operation of each kind, with its keyword.
    pub const KINDS: [(&'static str, MatrixOp); 8] = [
        ("Translate", MatrixOp::Translate(Vec3::ZERO)),
        ("Scale", MatrixOp::Scale(Vec3::ONE)),
        ("UniformScale", MatrixOp::UniformScale(1.0)),
        ("XRotate", MatrixOp::XRotate(0.0)),
        ("YRotate", MatrixOp::YRotate(0.0)),
        ("ZRotate", MatrixOp::ZRotate(0.0)),
        ("Rotate", MatrixOp::Rotate(Vec3::Y, 0.0)),
        ("Matrix", MatrixOp::Matrix([1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1.])),
    ];

    /// Keywords of all operations.
    pub fn words() -> [&'static str; 8] {
        MatrixOp::KINDS.map(|row| row.0)
    }

    /// Returns the matrix.
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

    /// Multiplies the matrices of one transform.
    pub fn product(ops: &[MatrixOp], rules: MatrixRules) -> DAffine3 {
        let product = ops.iter().fold(DAffine3::IDENTITY, |product, op| match op {
            MatrixOp::Matrix(_) if rules.matrix_on_left => op.matrix() * product,
            _ => product * op.matrix(),
        });
        match () {
            () if rules.ignore_tiny && is_tiny(product) => DAffine3::IDENTITY,
            () if rules.drop_shear => without_shear(product),
            () => product,
        }
    }

    /// True if the product of the matrices of one transform is treated as singular. A product is
    /// singular if its determinant is at most the rounding error of 1 in single precision.
    pub fn is_tiny(ops: &[MatrixOp], rules: MatrixRules) -> bool {
        is_tiny(MatrixOp::product(ops, MatrixRules { drop_shear: false, ignore_tiny: false, ..rules }))
    }
}

fn is_tiny(map: DAffine3) -> bool {
    map.matrix3.determinant().abs() < f64::from(f32::EPSILON)
}

/// Makes the axes of a map perpendicular, one after the other, so that only translation, rotation
/// and scale remain.
///
/// Source: Thomas, *Decomposing a Matrix into Simple Transformations*, Graphics Gems II (1991),
/// VII.1.
fn without_shear(map: DAffine3) -> DAffine3 {
    let DMat3 { x_axis: x, y_axis, z_axis } = map.matrix3;
    // An axis of length 0 has no direction that could be removed.
    let along = |v: DVec3, axis: DVec3| v.project_onto_normalized(axis.normalize_or_zero());
    let y = y_axis - along(y_axis, x);
    let z = z_axis - along(z_axis, x) - along(z_axis, y);
    DAffine3 { matrix3: DMat3::from_cols(x, y, z), ..map }
}

/// Returns the rotation about a unit axis by Rodrigues' formula.
fn rotation(axis: DVec3, degrees: f32) -> DAffine3 {
    let (sin, cos) = fp::sin_cos_degrees(f64::from(degrees));
    let column = |v: DVec3| v * cos + axis.cross(v) * sin + axis * (axis.dot(v) * (1.0 - cos));
    DAffine3::from_mat3(DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z)))
}

#[cfg(test)]
mod tests;
