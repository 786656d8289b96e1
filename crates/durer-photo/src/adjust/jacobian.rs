//! Projects points to pixels, and computes the derivatives of the projection.
//!
//! With P = R X + t, p = P.xy / P.z, s = |p|², g = 1 + k1 s + k2 s² and g' = k1 + 2 k2 s:
//!
//! ```text
//! d(f g p)/dp = f (g + 2 g' p pᵀ)      (the second row times the aspect)
//! dp/dP = (1, 0, -x; 0, 1, -y) / P.z
//! dP/dω = -[R X]×    dP/dt = 1    dP/dX = R      for R replaced by exp([ω]×) R
//! d/df = g p    d/dk1 = f s p    d/dk2 = f s² p
//! ```

use crate::{Lens, Pose};
use nalgebra::{Matrix2x3, SMatrix, Vector2, Vector3};

/// Derivatives of a pixel with respect to its camera: rotation, translation, focal length, k1, and
/// k2.
pub type CameraJacobian = SMatrix<f64, 2, 9>;

/// Projects a point to a pixel. Also returns the derivatives of the pixel with respect to the
/// camera and the point.
pub fn project(lens: &Lens, pose: &Pose, point: &Vector3<f64>) -> (Vector2<f64>, CameraJacobian, Matrix2x3<f64>) {
    let turned = pose.rotation * point;
    let p = turned + pose.translation;
    let (x, y, z) = (p.x / p.z, p.y / p.z, p.z);
    let s = x * x + y * y;
    let (g, slope) = (lens.distortion_factor(s), lens.distortion[0] + 2.0 * s * lens.distortion[1]);
    let (fx, fy) = (lens.focal, lens.focal * lens.aspect);
    let (ux, uy) = (fx * (g + 2.0 * x * x * slope), fx * 2.0 * x * y * slope);
    let (vx, vy) = (fy * 2.0 * x * y * slope, fy * (g + 2.0 * y * y * slope));
    let by_p = Matrix2x3::new(
        ux / z,
        uy / z,
        -(ux * x + uy * y) / z, //
        vx / z,
        vy / z,
        -(vx * x + vy * y) / z,
    );
    let mut by_camera = CameraJacobian::zeros();
    for row in 0..2 {
        let d = Vector3::new(by_p[(row, 0)], by_p[(row, 1)], by_p[(row, 2)]);
        let by_rotation = turned.cross(&d);
        let (first, scale) = if row == 0 { (x, fx) } else { (y, fy) };
        let by_lens = [scale / lens.focal * g * first, scale * s * first, scale * s * s * first];
        for i in 0..3 {
            by_camera[(row, i)] = by_rotation[i];
            by_camera[(row, 3 + i)] = d[i];
            by_camera[(row, 6 + i)] = by_lens[i];
        }
    }
    let pixel = Vector2::new(lens.principal_point[0] + fx * g * x, lens.principal_point[1] + fy * g * y);
    (pixel, by_camera, by_p * pose.rotation)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::rotation_of;

    #[test]
    fn derivatives_match_finite_differences() {
        let lens = Lens { aspect: 1.1, distortion: [-0.2, 0.07], ..Lens::new([640, 480], 500.0) };
        let pose =
            Pose { rotation: rotation_of(&Vector3::new(0.3, -0.2, 0.5)), translation: Vector3::new(0.1, 0.2, 4.0) };
        let point = Vector3::new(0.8, -0.7, 0.3);
        let (_, by_camera, by_point) = project(&lens, &pose, &point);
        let moved = |i: usize, by: f64| {
            let (mut lens, mut pose, mut point) = (lens, pose, point);
            match i {
                0..3 => pose.rotation = rotation_of(&(by * Vector3::ith(i, 1.0))) * pose.rotation,
                3..6 => pose.translation[i - 3] += by,
                6 => lens.focal += by,
                7..9 => lens.distortion[i - 7] += by,
                _ => point[i - 9] += by,
            }
            project(&lens, &pose, &point).0
        };
        for i in 0..12 {
            let difference = (moved(i, 1e-5) - moved(i, -1e-5)) / 2e-5;
            let exact = if i < 9 { by_camera.column(i).into_owned() } else { by_point.column(i - 9).into_owned() };
            assert!((difference - exact).norm() < 1e-6 * (1.0 + exact.norm()), "{i}: {difference} {exact}");
        }
    }
}
