//! Writes cameras in Dürer's scene language.

use crate::{Lens, Pose};
use nalgebra::Matrix3;
use std::fmt::Write;

/// Returns a `ProjectiveCamera` block with the matrix P = K [R | t], where the centre of the upper
/// left pixel is at (0, 0).
pub fn projective_camera(lens: &Lens, pose: &Pose) -> String {
    let [cx, cy] = lens.principal_point;
    let k = Matrix3::new(lens.focal, 0.0, cx - 0.5, 0.0, lens.focal * lens.aspect, cy - 0.5, 0.0, 0.0, 1.0);
    let (left, right) = (k * pose.rotation, k * pose.translation);
    let mut text = String::from("ProjectiveCamera {\n    matrix {");
    for i in 0..3 {
        let _ = write!(text, "\n        {} {} {} {}", left[(i, 0)], left[(i, 1)], left[(i, 2)], right[i]);
    }
    let ([width, height], [k1, k2]) = (lens.size, lens.distortion);
    let _ = write!(text, "\n    }}\n    width {width}\n    height {height}\n    k1 {k1}\n    k2 {k2}\n}}\n");
    text
}
