//! Triangulates points from rays.
//!
//! Source: Hartley, Zisserman, *Multiple View Geometry in Computer Vision*, 2nd edition, 2004,
//! chapter 12.

use super::fundamental::Correspondence;
use crate::Pose;
use nalgebra::{Matrix3, Vector3};

/// Returns the point with the smallest sum of squared distances to rays, which are given by their
/// origins and unit directions. Returns `None` if the rays are parallel.
pub fn nearest_to_rays(rays: &[(Vector3<f64>, Vector3<f64>)]) -> Option<Vector3<f64>> {
    let (mut matrix, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for (origin, direction) in rays {
        let across = Matrix3::identity() - direction * direction.transpose();
        matrix += across;
        right += across * origin;
    }
    let point = matrix.try_inverse()? * right;
    point.iter().all(|c| c.is_finite()).then_some(point)
}

/// Returns the point that two cameras see in the directions (x, y, 1), where the first camera is at
/// the origin. The result is NaN if the rays are parallel.
pub fn two_views(second: &Pose, (a, b): &Correspondence) -> Vector3<f64> {
    let ray =
        |pose: &Pose, x: f64, y: f64| (pose.center(), pose.direction_to_world(&Vector3::new(x, y, 1.0)).normalize());
    let rays = [ray(&Pose::identity(), a.x, a.y), ray(second, b.x, b.y)];
    nearest_to_rays(&rays).unwrap_or_else(|| Vector3::repeat(f64::NAN))
}
