use super::*;
use durer_scene::math::random::Random;

fn random_ops(random: &mut Random) -> Vec<MatrixOp> {
    let mut vector = |low: f32, high: f32| Vec3::from_array([0, 1, 2].map(|_| random.between(low, high)));
    vec![
        MatrixOp::Translate(vector(-5.0, 5.0)),
        MatrixOp::XRotate(vector(-180.0, 180.0).x),
        MatrixOp::Scale(vector(0.2, 3.0) * Vec3::new(1.0, -1.0, 1.0)),
        MatrixOp::Rotate(vector(0.1, 1.0), vector(-180.0, 180.0).y),
        MatrixOp::ZRotate(vector(-180.0, 180.0).z),
        MatrixOp::UniformScale(vector(0.5, 2.0).x),
    ]
}

fn close(a: &Matrix, b: &Matrix, most: f32) {
    for (p, q) in a.0.iter().flatten().zip(b.0.iter().flatten()) {
        assert!((p - q).abs() <= most, "{a:?} differs from {b:?}");
    }
}

#[test]
fn products_and_shear_removal_match_double_precision() {
    let mut random = Random(59);
    for _ in 0..500 {
        let ops = random_ops(&mut random);
        for drop_shear in [false, true] {
            let rules = MatrixRules { drop_shear, ..MatrixRules::default() };
            close(&Matrix::of(&ops, rules, VectorLibrary::Glm), &Matrix::from(MatrixOp::product(&ops, rules)), 2e-4);
        }
    }
}

#[test]
fn inverse_of_both_libraries_undoes_the_matrix() {
    let mut random = Random(60);
    for _ in 0..500 {
        let matrix = Matrix::of(&random_ops(&mut random), MatrixRules::default(), VectorLibrary::Vecmath);
        for vectors in [VectorLibrary::Vecmath, VectorLibrary::Glm] {
            close(&matrix.times(&matrix.inverse(vectors), vectors), &Matrix::IDENTITY, 1e-3);
            let point = Vec3::from_array([0, 1, 2].map(|_| random.between(-2.0, 2.0)));
            let back = matrix.inverse(vectors).point(matrix.point(point, vectors), vectors);
            assert!((back - point).abs().max_element() < 1e-3, "{point} {back}");
        }
    }
    for vectors in [VectorLibrary::Vecmath, VectorLibrary::Glm] {
        assert_eq!(Matrix::IDENTITY.inverse(vectors), Matrix::IDENTITY);
    }
}

#[test]
fn singular_matrix_is_detected_and_tiny_one_is_skipped() {
    let flat = [MatrixOp::Scale(Vec3::new(1.0, 0.0, 1.0))];
    assert!(!Matrix::of(&flat, MatrixRules::default(), VectorLibrary::Vecmath).is_regular());
    let tiny = MatrixRules { ignore_tiny: true, ..MatrixRules::default() };
    assert_eq!(Matrix::of(&flat, tiny, VectorLibrary::Glm), Matrix::IDENTITY);
    // 0.004^3 is smaller than the rounding error of 1, whereas 0.006^3 is larger.
    let scale = |s: f32| [MatrixOp::Translate(Vec3::X), MatrixOp::UniformScale(s)];
    assert_eq!(Matrix::of(&scale(0.004), tiny, VectorLibrary::Glm), Matrix::IDENTITY);
    assert_ne!(Matrix::of(&scale(0.006), tiny, VectorLibrary::Glm), Matrix::IDENTITY);
    assert!(MatrixOp::product(&scale(0.004), tiny) == DAffine3::IDENTITY);
}

#[test]
fn sign_of_zero_matches_each_library() {
    let moved = Matrix::of(&[MatrixOp::Translate(Vec3::ONE)], MatrixRules::default(), VectorLibrary::Vecmath);
    let inverse = moved.inverse(VectorLibrary::Vecmath);
    assert!(inverse.vector(Vec3::new(-0.5, 0.9, -0.0)).z.is_sign_positive());
    assert!((0.0_f32 - 0.0).is_sign_positive() && VectorLibrary::Glm.sum_from(-0.0).is_sign_negative());
}
