//! The general projective camera of computer vision, which consists of a 3x4 matrix in homogeneous
//! coordinates and lens distortion.
//!
//! P = K [R | t] maps a point in world space to a pixel: (x, y, 1) ~ P (X, Y, Z, 1). Here, x
//! increases to the right and y downwards, and the centre of the upper left pixel is at (0, 0). The
//! scale of P is arbitrary. The left part M = K R of P is decomposed into an upper triangular
//! matrix K and a rotation R. The eye is at -M⁻¹ p4, where p4 is the last column of P. Between R
//! and K, the lens distorts the point (x, y) at depth 1 by the Brown-Conrady model in OpenCV's
//! form, where s = x² + y²:
//!
//! ```text
//! x' = x (1 + k1 s + k2 s² + k3 s³) + 2 p1 x y + p2 (s + 2 x²)
//! y' = y (1 + k1 s + k2 s² + k3 s³) + p1 (s + 2 y²) + 2 p2 x y
//! ```
//!
//! Rays need the inverse of this mapping, which is computed by Newton's method. The camera sees
//! nothing beyond the point where the distortion folds back on itself, since the model is
//! meaningless there.
//!
//! Source: Hartley, Zisserman, *Multiple View Geometry in Computer Vision*, 2nd edition, 2004,
//! sections 6.1, 6.2 and A4.1; Brown, *Decentering Distortion of Lenses*, Photogrammetric
//! Engineering 32(3), 1966.

use super::pose::world_ray;
use super::sheet::PictureSheet;
use super::{CameraBasis, CameraSample, Pose, Projection};
use crate::describe::{Constraint, described};
use crate::dialect::set;
use crate::math::{Ray, Vec2, Vec3};
use glam::{DMat2, DMat3, DVec2, DVec3};

described! {
    /// A camera recovered from a photograph: a projection matrix and lens distortion.
    ProjectiveCamera ["ProjectiveCamera" in set::DURER] {
        /// 3x4 projection matrix, row by row, from homogeneous world-space points to pixels, with y
        /// downwards; its scale is arbitrary.
        matrix: Vec<[f32; 4]> = plain_matrix(), required, Constraint::Rows(3, 3), ["matrix" in set::DURER];
        /// Width of the photograph in pixels.
        width: f32 = 512.0, required, Constraint::Positive, ["width" in set::DURER];
        /// Height of the photograph in pixels.
        height: f32 = 512.0, required, Constraint::Positive, ["height" in set::DURER];
        /// Radial distortion coefficient of r².
        k1: f32 = 0.0, optional, Constraint::Any, ["k1" in set::DURER];
        /// Radial distortion coefficient of r⁴.
        k2: f32 = 0.0, optional, Constraint::Any, ["k2" in set::DURER];
        /// Tangential distortion, vertical.
        p1: f32 = 0.0, optional, Constraint::Any, ["p1" in set::DURER];
        /// Tangential distortion, horizontal.
        p2: f32 = 0.0, optional, Constraint::Any, ["p2" in set::DURER];
        /// Radial distortion coefficient of r⁶.
        k3: f32 = 0.0, optional, Constraint::Any, ["k3" in set::DURER];
    }
}

/// Returns the matrix of a camera at the origin that looks along -z.
fn plain_matrix() -> Vec<[f32; 4]> {
    vec![[512.0, 0.0, -255.5, 0.0], [0.0, -512.0, -255.5, 0.0], [0.0, 0.0, -1.0, 0.0]]
}

/// Projection matrix of the camera, decomposed into the eye, the rotation and the intrinsic matrix.
struct Decomposition {
    eye: DVec3,
    /// The rows are the right, down and forward directions of the camera in world space.
    rotation: DMat3,
    /// Upper triangular intrinsic matrix, with 1 in the lower right corner.
    intrinsic: DMat3,
}

impl ProjectiveCamera {
    /// Returns the pixel to which the matrix maps the points on the camera's axis.
    pub fn principal_point(&self) -> Vec2 {
        self.parts().intrinsic.z_axis.truncate().as_vec2()
    }

    fn sheet(&self) -> PictureSheet {
        PictureSheet(DVec2::new(f64::from(self.width), f64::from(self.height)))
    }

    /// Returns the rows of the left three columns of the matrix, and the fourth column.
    fn rows(&self) -> ([DVec3; 3], DVec3) {
        let row = |i: usize| self.matrix[i].map(f64::from);
        let left = [0, 1, 2].map(|i| DVec3::from_slice(&row(i)[..3]));
        (left, DVec3::new(row(0)[3], row(1)[3], row(2)[3]))
    }

    /// Computes K, R and the eye by applying the Gram-Schmidt process to the rows of M, from the
    /// last to the first.
    fn parts(&self) -> Decomposition {
        let ([a, b, c], last) = self.rows();
        // Depth is positive in front of the camera if M preserves handedness.
        let sign = if a.dot(b.cross(c)) < 0.0 { -1.0 } else { 1.0 };
        let [a, b, c] = [a, b, c].map(|row| sign * row);
        let forward = c.normalize();
        let down = (b - b.dot(forward) * forward).normalize();
        let right = down.cross(forward);
        let scale = c.length();
        let intrinsic = DMat3::from_cols(
            DVec3::new(a.dot(right), 0.0, 0.0) / scale,
            DVec3::new(a.dot(down), b.dot(down), 0.0) / scale,
            DVec3::new(a.dot(forward), b.dot(forward), scale) / scale,
        );
        let eye = DMat3::from_cols(a, b, c).transpose().inverse() * (-sign * last);
        Decomposition { eye, rotation: DMat3::from_cols(right, down, forward).transpose(), intrinsic }
    }

    /// Returns the factor 1 + k1 s + k2 s² + k3 s³ and its derivative with respect to s.
    fn radial(&self, s: f64) -> (f64, f64) {
        let [k1, k2, k3] = [self.k1, self.k2, self.k3].map(f64::from);
        (1.0 + s * (k1 + s * (k2 + s * k3)), k1 + s * (2.0 * k2 + s * 3.0 * k3))
    }

    /// True if the distorted radius increases with the radius everywhere between the centre and a
    /// point.
    fn is_before_fold(&self, point: DVec2) -> bool {
        let end = point.length_squared();
        // This is d/dr of r (1 + k1 r² + ...), as a function of s = r². The extrema of this
        // function are at the roots of its derivative.
        let growth = |s: f64| {
            let (factor, slope) = self.radial(s);
            factor + 2.0 * s * slope
        };
        let [a, b, c] = [3.0 * self.k1, 10.0 * self.k2, 21.0 * self.k3].map(f64::from);
        let root = (b * b - 4.0 * a * c).max(0.0).sqrt();
        let extremes = [(-b + root) / (2.0 * c), (-b - root) / (2.0 * c), -a / b];
        extremes.into_iter().filter(|s| *s > 0.0 && *s < end).chain([end]).all(|s| growth(s) > 0.0)
    }

    /// Returns the distorted point and its Jacobian.
    fn distort(&self, point: DVec2) -> (DVec2, DMat2) {
        let (s, [p1, p2]) = (point.length_squared(), [self.p1, self.p2].map(f64::from));
        let ((factor, slope), DVec2 { x, y }) = (self.radial(s), point);
        let tangential =
            DVec2::new(2.0 * p1 * x * y + p2 * (s + 2.0 * x * x), p1 * (s + 2.0 * y * y) + 2.0 * p2 * x * y);
        let mixed = 2.0 * x * y * slope + 2.0 * p1 * x + 2.0 * p2 * y;
        let jacobian = DMat2::from_cols(
            DVec2::new(factor + 2.0 * x * x * slope + 2.0 * p1 * y + 6.0 * p2 * x, mixed),
            DVec2::new(mixed, factor + 2.0 * y * y * slope + 6.0 * p1 * y + 2.0 * p2 * x),
        );
        (factor * point + tangential, jacobian)
    }

    /// Returns the point that the lens distorts to `target`, if there is such a point before the
    /// fold.
    fn undistort(&self, target: DVec2) -> Option<DVec2> {
        // The first guess usually converges. Otherwise, follow the point outwards from the centre.
        let followed = || (1..=16).try_fold(DVec2::ZERO, |point, i| self.solve(point, target * (f64::from(i) / 16.0)));
        self.solve(target, target).or_else(followed)
    }

    /// Solves the equation by Newton's method, starting from a guess.
    fn solve(&self, mut point: DVec2, target: DVec2) -> Option<DVec2> {
        for _ in 0..20 {
            let (there, jacobian) = self.distort(point);
            let step = jacobian.inverse() * (target - there);
            point += step;
            if step.length() <= 1e-15 * (1.0 + point.length()) {
                break;
            }
        }
        let (there, jacobian) = self.distort(point);
        let solved = (there - target).length() <= 1e-9 * (1.0 + target.length());
        (solved && jacobian.determinant() > 0.0 && self.is_before_fold(point)).then_some(point)
    }

    /// Returns the point at depth 1 that is seen through a sample.
    fn point_of(&self, parts: &Decomposition, sample: &CameraSample) -> Option<DVec2> {
        let sheet = self.sheet();
        if !sheet.contains(sheet.position(sample.pixel.as_dvec2())) {
            return None;
        }
        let position = sheet.position(sample.point.as_dvec2());
        let pixel = DVec3::new(position.x - 0.5, sheet.0.y - position.y - 0.5, 1.0);
        self.undistort((parts.intrinsic.inverse() * pixel).truncate())
    }
}

impl Projection for ProjectiveCamera {
    fn pose(&self) -> Pose {
        let Decomposition { eye, rotation, .. } = self.parts();
        let rows = rotation.transpose();
        Pose { center: eye.as_vec3(), direction: rows.z_axis.as_vec3(), up: -rows.y_axis.as_vec3() }
    }

    fn proportions(&self) -> Option<Vec2> {
        self.sheet().proportions()
    }

    fn validate(&self) -> Result<(), String> {
        if self.matrix.len() != 3 {
            return Err("`matrix` must have 3 rows".into());
        }
        let ([a, b, c], _) = self.rows();
        let volume = a.dot(b.cross(c)).abs();
        // Compare the volume with that of orthogonal rows of the same lengths.
        let singular = volume <= 1e-9 * a.length() * b.length() * c.length() || !self.pose().center.is_finite();
        match singular {
            true => Err("the left three columns of `matrix` are singular, so the camera has no eye".into()),
            false => Ok(()),
        }
    }

    fn ray(&self, _: &CameraBasis, sample: &CameraSample) -> Option<Ray> {
        let parts = self.parts();
        let point = self.point_of(&parts, sample)?;
        Some(world_ray(parts.eye, parts.rotation.transpose() * point.extend(1.0)))
    }

    fn project(&self, _: &CameraBasis, world: Vec3, _: Vec2, emit: &mut dyn FnMut(Vec2)) {
        let (parts, sheet) = (self.parts(), self.sheet());
        let p = parts.rotation * (world.as_dvec3() - parts.eye);
        let point = p.truncate() / p.z;
        let (there, jacobian) = self.distort(point);
        if p.z <= 0.0 || jacobian.determinant() <= 0.0 || !self.is_before_fold(point) {
            return;
        }
        let pixel = parts.intrinsic * there.extend(1.0);
        let position = DVec2::new(pixel.x + 0.5, sheet.0.y - pixel.y - 0.5);
        if sheet.contains(position) {
            emit(sheet.point(position).as_vec2());
        }
    }

    fn footprint(&self, _: &CameraBasis, sample: &CameraSample, t: f32) -> f32 {
        let parts = self.parts();
        let Some(point) = self.point_of(&parts, sample) else { return 0.0 };
        let pixels = parts.intrinsic.determinant() * self.distort(point).1.determinant();
        let (dir, unit) = (point.extend(1.0), self.sheet().unit());
        (f64::from(t * t) * unit * unit / (pixels * dir.length_squared() * dir.length())) as f32
    }
}
