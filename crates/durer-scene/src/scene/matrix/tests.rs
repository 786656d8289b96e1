//! Tests that matrices map points to known images.

use super::*;

const LEFT: MatrixRules = MatrixRules { matrix_on_left: true, drop_shear: false, ignore_tiny: false };

fn image(ops: &[MatrixOp], p: [f64; 3]) -> [f64; 3] {
    let image = MatrixOp::product(ops, MatrixRules::default()).transform_point3(p.into());
    // Adding 0 turns negative zero into positive zero.
    image.to_array().map(|x| x + 0.0)
}

#[test]
fn rotations_are_right_handed_and_exact_by_quarters() {
    assert_eq!(image(&[MatrixOp::XRotate(90.0)], [0.0, 1.0, 0.0]), [0.0, 0.0, 1.0]);
    assert_eq!(image(&[MatrixOp::YRotate(90.0)], [0.0, 0.0, 1.0]), [1.0, 0.0, 0.0]);
    assert_eq!(image(&[MatrixOp::ZRotate(90.0)], [1.0, 0.0, 0.0]), [0.0, 1.0, 0.0]);
    assert_eq!(image(&[MatrixOp::ZRotate(-450.0)], [1.0, 0.0, 0.0]), [0.0, -1.0, 0.0]);
    assert_eq!(image(&[MatrixOp::XRotate(180.0)], [0.0, 1.0, 0.0]), [0.0, -1.0, 0.0]);
    let close = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12);
    let (sin, cos) = (libm::sin(0.5), libm::cos(0.5));
    let degrees = 0.5f64.to_degrees();
    let turned = image(&[MatrixOp::Rotate(Vec3::Z * 7.0, degrees as f32)], [1.0, 0.0, 5.0]);
    // The angle is rounded to single precision.
    assert!((turned[0] - cos).abs() < 1e-7 && (turned[1] - sin).abs() < 1e-7 && turned[2] == 5.0);
    // A third of a turn about the diagonal maps x to y, y to z, and z to x.
    assert!(close(image(&[MatrixOp::Rotate(Vec3::ONE, 120.0)], [1.0, 2.0, 3.0]), [3.0, 1.0, 2.0]));
}

#[test]
fn the_last_written_matrix_applies_first() {
    let (up, turn) = (MatrixOp::Translate(Vec3::Y), MatrixOp::ZRotate(90.0));
    assert_eq!(image(&[up, turn], [1.0, 0.0, 0.0]), [0.0, 2.0, 0.0]);
    assert_eq!(image(&[turn, up], [1.0, 0.0, 0.0]), [-1.0, 1.0, 0.0]);
    assert_eq!(
        image(&[MatrixOp::Scale(Vec3::new(1.0, 2.0, 3.0)), MatrixOp::UniformScale(2.0)], [1.0; 3]),
        [2.0, 4.0, 6.0]
    );
    assert_eq!(image(&[], [1.0, 2.0, 3.0]), [1.0, 2.0, 3.0]);
}

#[test]
fn matrix_is_given_by_rows_and_multiplied_on_the_left_if_the_rules_say_so() {
    #[rustfmt::skip]
    let shear = MatrixOp::Matrix([
        1.0, 2.0, 0.0, 5.0,
        0.0, 1.0, 0.0, 6.0,
        0.0, 0.0, 1.0, 7.0,
        0.0, 0.0, 0.0, 1.0,
    ]);
    assert_eq!(image(&[shear], [1.0, 1.0, 1.0]), [8.0, 7.0, 8.0]);
    let ops = [MatrixOp::Scale(Vec3::splat(10.0)), shear];
    let point = glam::DVec3::ONE;
    assert_eq!(MatrixOp::product(&ops, MatrixRules::default()).transform_point3(point).to_array(), [80.0, 70.0, 80.0]);
    assert_eq!(MatrixOp::product(&ops, LEFT).transform_point3(point).to_array(), [35.0, 16.0, 17.0]);
    // The quirk affects only `Matrix`.
    let ops = [MatrixOp::Scale(Vec3::splat(10.0)), MatrixOp::Translate(Vec3::X)];
    assert_eq!(MatrixOp::product(&ops, LEFT), MatrixOp::product(&ops, MatrixRules::default()));
}
