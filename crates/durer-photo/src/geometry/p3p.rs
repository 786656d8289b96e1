//! Pose of a camera computed from three world points and their directions (P3P). There are up to
//! four solutions.
//!
//! Let α, β, γ be the angles between the directions, and a, b, c the sides of the triangle. The
//! distances s₁, s₂ = u s₁, s₃ = v s₁ satisfy the law of cosines in three triangles. Eliminating u
//! leaves a quartic in v.
//!
//! Source: Grunert's solution as in Haralick, Lee, Ottenberg, Nölle, *Review and Analysis of
//! Solutions of the Three Point Perspective Pose Estimation Problem*, IJCV 13(3), 1994, section
//! 3.1.

use super::align::rigid;
use super::polynomial::real_roots;
use crate::Pose;
use nalgebra::Vector3;

/// Returns the poses from which three world points are seen in three directions. The directions
/// need not have length 1.
pub fn p3p(points: &[Vector3<f64>; 3], directions: &[Vector3<f64>; 3]) -> Vec<Pose> {
    let [j1, j2, j3] = directions.map(|direction| direction.normalize());
    let [p1, p2, p3] = points;
    let (a2, b2, c2) = ((p2 - p3).norm_squared(), (p1 - p3).norm_squared(), (p1 - p2).norm_squared());
    // Points on a line do not determine the pose.
    if (p2 - p1).cross(&(p3 - p1)).norm_squared() <= 1e-20 * b2 * c2 || a2 == 0.0 {
        return Vec::new();
    }
    let (ca, cb, cg) = (j2.dot(&j3), j1.dot(&j3), j1.dot(&j2));
    let (k1, k2) = ((a2 - c2) / b2, (a2 + c2) / b2);
    let (ab, cob) = (a2 / b2, c2 / b2);
    let coefficients = [
        (1.0 + k1) * (1.0 + k1) - 4.0 * ab * cg * cg,
        4.0 * (-k1 * (1.0 + k1) * cb + 2.0 * ab * cg * cg * cb - (1.0 - k2) * ca * cg),
        2.0 * (k1 * k1 - 1.0 + 2.0 * k1 * k1 * cb * cb + 2.0 * (1.0 - cob) * ca * ca - 4.0 * k2 * ca * cb * cg
            + 2.0 * (1.0 - ab) * cg * cg),
        4.0 * (k1 * (1.0 - k1) * cb - (1.0 - k2) * ca * cg + 2.0 * cob * ca * ca * cb),
        (k1 - 1.0) * (k1 - 1.0) - 4.0 * cob * ca * ca,
    ];
    let mut poses = Vec::new();
    for v in real_roots(&coefficients).into_iter().filter(|v| *v > 0.0) {
        let u = ((k1 - 1.0) * v * v - 2.0 * k1 * cb * v + 1.0 + k1) / (2.0 * (cg - v * ca));
        let s1 = (b2 / (1.0 + v * v - 2.0 * v * cb)).sqrt();
        if u > 0.0 && s1.is_finite() && u.is_finite() {
            let in_camera = [s1 * j1, u * s1 * j2, v * s1 * j3];
            poses.extend(rigid(points, &in_camera));
        }
    }
    poses
}
