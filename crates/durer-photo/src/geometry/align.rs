//! Alignment of points, cameras, and reconstructions by similarity transforms.
//!
//! Source: Umeyama, *Least-Squares Estimation of Transformation Parameters Between Two Point
//! Patterns*, PAMI 13(4), 1991.

use crate::model::nearest_rotation;
use crate::{Pose, Reconstruction};
use nalgebra::{Matrix3, Vector3};

/// Similarity transform of world space, X' = scale · rotation · X + shift, which aligns two
/// reconstructions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Similarity {
    /// Scale factor.
    pub scale: f64,
    /// Rotation matrix.
    pub rotation: Matrix3<f64>,
    /// Translation.
    pub translation: Vector3<f64>,
}

impl Similarity {
    /// Transforms a point.
    pub fn apply(&self, point: &Vector3<f64>) -> Vector3<f64> {
        self.scale * (self.rotation * point) + self.translation
    }

    /// Transforms cameras and points together, which does not change the projections.
    pub fn apply_to(&self, reconstruction: &mut Reconstruction) {
        for view in &mut reconstruction.views {
            if let Some(pose) = &mut view.pose {
                *pose = Pose::at(&self.apply(&pose.center()), pose.rotation * self.rotation.transpose());
            }
        }
        reconstruction.points.iter_mut().for_each(|point| point.position = self.apply(&point.position));
    }
}

/// Returns the means of both point sets, the rotation computed from the singular vectors of their
/// covariance, and the sum of the singular values. Returns `None` if the points are on a line.
fn fit_rotation(from: &[Vector3<f64>], to: &[Vector3<f64>]) -> Option<([Vector3<f64>; 2], Matrix3<f64>, f64)> {
    let count = from.len().min(to.len()) as f64;
    let mean = |points: &[Vector3<f64>]| points.iter().sum::<Vector3<f64>>() / count;
    let means = [mean(from), mean(to)];
    let product = |(a, b): (&Vector3<f64>, &Vector3<f64>)| (b - means[1]) * (a - means[0]).transpose();
    let covariance = from.iter().zip(to).map(product).sum::<Matrix3<f64>>() / count;
    let svd = covariance.svd(true, true);
    let (u, v, d) = (svd.u?, svd.v_t?, svd.singular_values);
    if d[1] <= 1e-12 * d[0] || !d[0].is_finite() || d[0] == 0.0 {
        return None;
    }
    let sign = if (u * v).determinant() < 0.0 { -1.0 } else { 1.0 };
    Some((means, u * Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, sign)) * v, d[0] + d[1] + sign * d[2]))
}

/// Computes the similarity that best maps the points `from` to the points `to`. Returns `None` for
/// fewer than three points, or for points on a line.
pub fn align_points(from: &[Vector3<f64>], to: &[Vector3<f64>]) -> Option<Similarity> {
    if from.len() < 3 || from.len() != to.len() {
        return None;
    }
    let (means, rotation, trace) = fit_rotation(from, to)?;
    let variance = from.iter().map(|point| (point - means[0]).norm_squared()).sum::<f64>() / from.len() as f64;
    let scale = trace / variance;
    Some(Similarity { scale, rotation, translation: means[1] - scale * (rotation * means[0]) })
}

/// Computes the similarity that best maps the cameras `from` to the cameras `to`. It consists of
/// the mean of the relative rotations, and the scale and translation that align the centres.
/// Rotations are used because camera centres near a line would leave the rotation about that line
/// uncertain.
pub fn align_cameras(from: &[Pose], to: &[Pose]) -> Option<Similarity> {
    let count = from.len() as f64;
    if from.len() < 2 || from.len() != to.len() {
        return None;
    }
    let turned = from.iter().zip(to).map(|(a, b)| b.rotation.transpose() * a.rotation).sum::<Matrix3<f64>>();
    let rotation = nearest_rotation(&turned);
    let mean = |poses: &[Pose]| poses.iter().map(Pose::center).sum::<Vector3<f64>>() / count;
    let means = [rotation * mean(from), mean(to)];
    let (mut along, mut square) = (0.0, 0.0);
    for (a, b) in from.iter().zip(to) {
        let (a, b) = (rotation * a.center() - means[0], b.center() - means[1]);
        along += a.dot(&b);
        square += a.norm_squared();
    }
    let scale = along / square;
    (scale.is_finite() && scale > 0.0).then(|| Similarity { scale, rotation, translation: means[1] - scale * means[0] })
}

/// Computes the pose that best maps world points to points in the camera frame.
pub fn rigid(world: &[Vector3<f64>], camera: &[Vector3<f64>]) -> Option<Pose> {
    let (means, rotation, _) = fit_rotation(world, camera)?;
    Some(Pose { rotation, translation: means[1] - rotation * means[0] })
}

/// Computes the similarity that maps triangulated control points to their known positions, and the
/// remaining distance of each point.
///
/// # Errors
///
/// Returns an error if fewer than three control points are observed by two photographs with a known
/// pose, or if these points lie on a line.
pub fn align_to_control_points(
    reconstruction: &Reconstruction,
    control: &[crate::known::ControlPoint],
) -> Result<(Similarity, Vec<f64>), crate::Error> {
    let ray = |observation: &crate::Observation| {
        let view = &reconstruction.views[observation.view];
        let (pose, direction) = (view.pose.as_ref()?, reconstruction.lenses[view.lens].unproject(&observation.pixel)?);
        Some((pose.center(), pose.direction_to_world(&direction).normalize()))
    };
    let (mut from, mut to) = (Vec::new(), Vec::new());
    for (position, observations) in control {
        let rays: Vec<_> = observations.iter().filter_map(ray).collect();
        if let Some(point) = super::triangulate::nearest_to_rays(&rays).filter(|_| rays.len() > 1) {
            from.push(point);
            to.push(*position);
        }
    }
    let count = from.len();
    if count < 3 {
        return Err(crate::Error::new(format!(
            "at least three control points are needed, each observed by two photographs with a known pose, but the \
             file has {count}"
        )));
    }
    let similarity = align_points(&from, &to).ok_or_else(|| {
        crate::Error::new("the control points lie on a line, so the rotation about this line is undetermined")
    })?;
    let left = from.iter().zip(&to).map(|(a, b)| (similarity.apply(a) - b).norm()).collect();
    Ok((similarity, left))
}
