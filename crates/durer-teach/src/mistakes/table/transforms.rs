//! Mistakes in the matrices of transforms.

use super::{Mistake, Values, row};
use crate::mistakes::bugs::Normals;
use durer_scene::math::Vec3;
use durer_scene::scene::{MatrixOp, MatrixRules};
use glam::DAffine3;

/// Common mistakes in the matrices of transforms.
pub(super) const MISTAKES: &[Mistake] = &[
    row(
        "matrices-reversed",
        "transforms",
        "the matrices of a transform are multiplied in the wrong order",
        "M = M1 * M2 * M3",
        "M = M3 * M2 * M1",
        |v, _| {
            v.set_transforms(&|ops, rules| {
                let reversed: Vec<MatrixOp> = ops.iter().rev().copied().collect();
                MatrixOp::product(&reversed, rules)
            });
        },
    ),
    row(
        "rotation-radians",
        "transforms",
        "angles of rotations are interpreted as radians",
        "angle * pi / 180",
        "angle",
        |v, _| v.set_transforms(&|ops, rules| turned(ops, rules, f32::to_degrees)),
    ),
    row(
        "rotation-negated",
        "transforms",
        "rotations have the wrong sign",
        "rotation by angle",
        "rotation by -angle, or the transposed matrix",
        |v, _| v.set_transforms(&|ops, rules| turned(ops, rules, |angle| -angle)),
    ),
    row(
        "rotation-axis",
        "transforms",
        "{|||XRotate, YRotate and ZRotate: |XRotate, YRotate and ZRotate: |XRotate, YRotate and ZRotate: ||}rotations turn \
         about another axis: {x and y are exchanged|y and z are exchanged|x and z are exchanged|x and y are exchanged|y and \
         z are exchanged|x and z are exchanged|y for x, z for y and x for z|z for x, x for y and y for z}",
        "XRotate about (1, 0, 0), YRotate about (0, 1, 0), ZRotate about (0, 0, 1)",
        "{two of them exchanged|two of them exchanged|two of them exchanged|two of them exchanged|two of them exchanged|two \
         of them exchanged|XRotate about (0, 1, 0), YRotate about (0, 0, 1), ZRotate about (1, 0, 0)|XRotate about (0, 0, \
         1), YRotate about (1, 0, 0), ZRotate about (0, 1, 0)}",
        |v, which| {
            let axes: fn(&MatrixOp) -> MatrixOp = match which as u32 {
                0 => |op| exchanged(op, 0, 1),
                1 => |op| exchanged(op, 1, 2),
                2 => |op| exchanged(op, 0, 2),
                3 => |op| renamed(op, [1, 0, 2]),
                4 => |op| renamed(op, [0, 2, 1]),
                5 => |op| renamed(op, [2, 1, 0]),
                6 => |op| renamed(op, [1, 2, 0]),
                _ => |op| renamed(op, [2, 0, 1]),
            };
            v.set_transforms(&|ops, rules| changed(ops, rules, axes));
        },
    )
    .with(Values::Only(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0])),
    row(
        "translation-negated",
        "transforms",
        "translations have the wrong sign",
        "translation by (x, y, z)",
        "translation by (-x, -y, -z)",
        |v, _| {
            let back = |op: &MatrixOp| if let MatrixOp::Translate(by) = *op { MatrixOp::Translate(-by) } else { *op };
            v.set_transforms(&|ops, rules| changed(ops, rules, back));
        },
    ),
    row(
        "scale-inverted",
        "transforms",
        "scales are inverted: objects shrink instead of growing",
        "scale by s",
        "scale by 1 / s",
        |v, _| {
            let inverse = |op: &MatrixOp| match *op {
                MatrixOp::Scale(by) => MatrixOp::Scale(by.recip()),
                MatrixOp::UniformScale(by) => MatrixOp::UniformScale(by.recip()),
                other => other,
            };
            v.set_transforms(&|ops, rules| changed(ops, rules, inverse));
        },
    ),
    row("transforms-ignored", "transforms", "transforms have no effect", "M = M1 * M2 * M3", "M = identity", |v, _| {
        v.set_transforms(&|_, _| DAffine3::IDENTITY)
    }),
    row(
        "transforms-inverted",
        "transforms",
        "{rays are transformed to object space by M instead of its inverse|objects are transformed by the inverse of M}",
        "ray to object space by M^-1",
        "ray to object space by M{|, and normals by M^T}",
        |v, normals| {
            v.set_transforms(&|ops, rules| MatrixOp::product(ops, rules).inverse());
            if normals == 0.0 {
                v.bugs.normals = Normals::Transposed;
            }
        },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row("translations-ignored", "transforms", "translations have no effect", "M = T * R * S", "M without T", |v, _| {
        v.set_transforms(&|ops, rules| without(ops, rules, |op| matches!(op, MatrixOp::Translate(_))))
    }),
    row("scales-ignored", "transforms", "scales have no effect", "M = T * R * S", "M without S", |v, _| {
        v.set_transforms(&|ops, rules| without(ops, rules, |op| matches!(op, MatrixOp::Scale(_) | MatrixOp::UniformScale(_))));
    }),
    row("rotations-ignored", "transforms", "rotations have no effect", "M = T * R * S", "M without R", |v, _| {
        v.set_transforms(&|ops, rules| {
            without(ops, rules, |op| {
                matches!(op, MatrixOp::XRotate(_) | MatrixOp::YRotate(_) | MatrixOp::ZRotate(_) | MatrixOp::Rotate(..))
            })
        });
    }),
    row(
        "scale-factors",
        "transforms",
        "scales {use the x factor for all axes|ignore the y factor|ignore the y factor of Scale, but not of UniformScale}",
        "Scale by (x, y, z)",
        "Scale by {(x, x, x)|(x, 1, z)|(x, 1, z)}",
        |v, how| {
            let change: fn(&MatrixOp) -> MatrixOp = match how as u32 {
                0 => |op| if let MatrixOp::Scale(by) = *op { MatrixOp::Scale(Vec3::splat(by.x)) } else { *op },
                1 => |op| match *op {
                    MatrixOp::Scale(by) => MatrixOp::Scale(by.with_y(1.0)),
                    MatrixOp::UniformScale(by) => MatrixOp::Scale(Vec3::new(by, 1.0, by)),
                    other => other,
                },
                _ => |op| if let MatrixOp::Scale(by) = *op { MatrixOp::Scale(by.with_y(1.0)) } else { *op },
            };
            v.set_transforms(&|ops, rules| changed(ops, rules, change));
        },
    )
    .with(Values::Only(&[0.0, 1.0, 2.0])),
];

/// Exchanges two axes of a rotation.
fn exchanged(op: &MatrixOp, a: usize, b: usize) -> MatrixOp {
    let (axis, angle) = match *op {
        MatrixOp::XRotate(angle) => (0, angle),
        MatrixOp::YRotate(angle) => (1, angle),
        MatrixOp::ZRotate(angle) => (2, angle),
        MatrixOp::Rotate(mut axis, angle) => {
            (axis[a], axis[b]) = (axis[b], axis[a]);
            return MatrixOp::Rotate(axis, angle);
        }
        other => return other,
    };
    let turned = if axis == a {
        b
    } else if axis == b {
        a
    } else {
        axis
    };
    [MatrixOp::XRotate(angle), MatrixOp::YRotate(angle), MatrixOp::ZRotate(angle)][turned]
}

/// Returns the product of a transform's matrices without the matrices that `left_out` selects.
fn without(ops: &[MatrixOp], rules: MatrixRules, left_out: fn(&MatrixOp) -> bool) -> DAffine3 {
    let kept: Vec<MatrixOp> = ops.iter().filter(|op| !left_out(op)).copied().collect();
    MatrixOp::product(&kept, rules)
}

/// Returns the product of a transform's matrices after `change` has been applied to the rotation
/// angles.
fn turned(ops: &[MatrixOp], rules: MatrixRules, change: fn(f32) -> f32) -> DAffine3 {
    let change = |op: &MatrixOp| match *op {
        MatrixOp::XRotate(angle) => MatrixOp::XRotate(change(angle)),
        MatrixOp::YRotate(angle) => MatrixOp::YRotate(change(angle)),
        MatrixOp::ZRotate(angle) => MatrixOp::ZRotate(change(angle)),
        MatrixOp::Rotate(axis, angle) => MatrixOp::Rotate(axis, change(angle)),
        other => other,
    };
    changed(ops, rules, change)
}

/// Returns the product of a transform's matrices after each of them was changed.
fn changed(ops: &[MatrixOp], rules: MatrixRules, change: impl Fn(&MatrixOp) -> MatrixOp) -> DAffine3 {
    MatrixOp::product(&ops.iter().map(change).collect::<Vec<_>>(), rules)
}

/// Gives the rotations about the x, y and z axes other axes, but not rotations about any axis.
fn renamed(op: &MatrixOp, axes: [usize; 3]) -> MatrixOp {
    let (axis, angle) = match *op {
        MatrixOp::XRotate(angle) => (0, angle),
        MatrixOp::YRotate(angle) => (1, angle),
        MatrixOp::ZRotate(angle) => (2, angle),
        other => return other,
    };
    [MatrixOp::XRotate(angle), MatrixOp::YRotate(angle), MatrixOp::ZRotate(angle)][axes[axis]]
}
