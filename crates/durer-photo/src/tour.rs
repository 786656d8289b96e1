//! Data for the web page that shows the photographs and points of a reconstruction in 3D.

use crate::Reconstruction;
use crate::geometry::camera::principal_deviations;
use nalgebra::{Matrix3, Vector2, Vector3};
use serde::Serialize;

/// Photograph on the tour page, with its camera and the rectangle in space onto which it is
/// projected.
#[derive(Debug, Clone, Serialize)]
pub struct TourView {
    /// Index of the photograph in the reconstruction.
    pub view: usize,
    /// File name.
    pub name: String,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Focal length in pixels.
    pub focal: f64,
    /// Position of the camera.
    pub center: [f64; 3],
    /// Rotation matrix stored by rows, which are the camera's right, down, and forward directions
    /// in world space.
    pub rotation: [[f64; 3]; 3],
    /// Corners of the photograph in world space: upper left, upper right, lower right, and lower
    /// left.
    pub corners: [[f64; 3]; 4],
    /// Indices of the points that the photograph observes.
    pub points: Vec<usize>,
}

/// Returns the photographs with a known pose. Each photograph is projected onto the plane that fits
/// its points or, if that plane is too oblique, onto a plane perpendicular to the view direction.
pub fn tour_views(reconstruction: &Reconstruction) -> Vec<TourView> {
    let mut points_of_view = vec![Vec::new(); reconstruction.views.len()];
    for (i, point) in reconstruction.points.iter().enumerate() {
        point.track.iter().for_each(|observation| points_of_view[observation.view].push(i));
    }
    let mut list = Vec::new();
    for (view, points) in points_of_view.into_iter().enumerate() {
        let Some(pose) = reconstruction.views[view].pose else { continue };
        let lens = reconstruction.lenses[reconstruction.views[view].lens];
        let positions: Vec<Vector3<f64>> = points.iter().map(|i| reconstruction.points[*i].position).collect();
        let mut depths: Vec<f64> = positions.iter().map(|p| pose.depth(p)).filter(|d| *d > 0.0).collect();
        depths.sort_by(f64::total_cmp);
        let depth = depths.get(depths.len() / 2).copied().unwrap_or(1.0);
        let forward = pose.direction_to_world(&Vector3::z());
        let (center, across) = (pose.center(), pose.center() + depth * forward);
        let [width, height] = lens.size.map(f64::from);
        let ray = |x: f64, y: f64| {
            let p = Vector2::new(
                (x - lens.principal_point[0]) / lens.focal,
                (y - lens.principal_point[1]) / (lens.focal * lens.aspect),
            );
            pose.direction_to_world(&Vector3::new(p.x, p.y, 1.0))
        };
        let rays = [ray(0.0, 0.0), ray(width, 0.0), ray(width, height), ray(0.0, height)];
        let on = |(origin, normal): (Vector3<f64>, Vector3<f64>)| {
            let far = rays.map(|ray| (origin - center).dot(&normal) / ray.dot(&normal));
            // The rays have depth 1, so distances along them are depths.
            far.iter()
                .all(|t| (0.3 * depth..3.0 * depth).contains(t))
                .then(|| [0, 1, 2, 3].map(|i| center + far[i] * rays[i]))
        };
        let corners = plane(&positions).and_then(on).or_else(|| on((across, forward))).unwrap_or([across; 4]);
        let row = |i: usize| [pose.rotation[(i, 0)], pose.rotation[(i, 1)], pose.rotation[(i, 2)]];
        list.push(TourView {
            view,
            name: reconstruction.views[view].name.clone(),
            size: lens.size,
            focal: lens.focal,
            center: center.into(),
            rotation: [row(0), row(1), row(2)],
            corners: corners.map(Into::into),
            points,
        });
    }
    list
}

/// Returns the plane that fits points best, as a point and a normal. Returns `None` if the points
/// are not nearly in a plane.
fn plane(points: &[Vector3<f64>]) -> Option<(Vector3<f64>, Vector3<f64>)> {
    let [_, second, third] = principal_deviations(points);
    if points.len() < 8 || third > 0.7 * second {
        return None;
    }
    let mean = points.iter().sum::<Vector3<f64>>() / points.len() as f64;
    let covariance: Matrix3<f64> = points.iter().map(|p| (p - mean) * (p - mean).transpose()).sum();
    let eigen = covariance.symmetric_eigen();
    Some((mean, eigen.eigenvectors.column(eigen.eigenvalues.imin()).into_owned()))
}
