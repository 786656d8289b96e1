//! Types that make up a reconstruction: lenses, poses, photographs, and points.

use nalgebra::{Matrix3, Rotation3, Vector2, Vector3};

/// Intrinsic camera parameters (focal length, principal point, distortion), which map points in the
/// camera frame to pixels; see the [conventions](crate) of this crate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lens {
    /// Width and height of the photographs in pixels; 0 if unknown.
    pub size: [u32; 2],
    /// Focal length in pixels.
    pub focal: f64,
    /// Ratio of the vertical to the horizontal focal length, which is 1 for square pixels.
    pub aspect: f64,
    /// Principal point in pixels from the upper left corner.
    pub principal_point: [f64; 2],
    /// Coefficients of |p|² and |p|⁴ in the radial distortion.
    pub distortion: [f64; 2],
}

impl Lens {
    /// Creates a lens without distortion whose principal point is the image centre.
    pub fn new(size: [u32; 2], focal: f64) -> Self {
        Lens { size, focal, aspect: 1.0, principal_point: size.map(|side| f64::from(side) / 2.0), distortion: [0.0; 2] }
    }

    /// Returns the length of the longer side in pixels, or twice the focal length if the size is
    /// unknown.
    pub fn longer_side(&self) -> f64 {
        match self.size[0].max(self.size[1]) {
            0 => 2.0 * self.focal,
            side => f64::from(side),
        }
    }

    /// Projects a point in the camera frame to a pixel. The formula also applies to points behind
    /// the camera; see [`Pose::depth`].
    pub fn project(&self, p: &Vector3<f64>) -> Vector2<f64> {
        let (x, y) = (p.x / p.z, p.y / p.z);
        let factor = self.focal * self.distortion_factor(x * x + y * y);
        Vector2::new(self.principal_point[0] + factor * x, self.principal_point[1] + factor * self.aspect * y)
    }

    /// Returns the distortion factor 1 + k1 s + k2 s² for the squared radius s.
    pub fn distortion_factor(&self, s: f64) -> f64 {
        1.0 + s * (self.distortion[0] + s * self.distortion[1])
    }

    /// Computes the point (x, y, 1) that projects to a pixel, by Newton's method. Returns `None` if
    /// the distortion is not invertible there.
    pub fn unproject(&self, pixel: &Vector2<f64>) -> Option<Vector3<f64>> {
        let x = (pixel.x - self.principal_point[0]) / self.focal;
        let y = (pixel.y - self.principal_point[1]) / (self.focal * self.aspect);
        let wanted = (x * x + y * y).sqrt();
        let mut radius = wanted;
        for _ in 0..30 {
            let s = radius * radius;
            // Compute the derivative of r (1 + k1 r² + k2 r⁴) with respect to r.
            let slope = 1.0 + s * (3.0 * self.distortion[0] + 5.0 * s * self.distortion[1]);
            if slope <= 1e-6 {
                return None;
            }
            let step = (wanted - radius * self.distortion_factor(s)) / slope;
            radius += step;
            if step.abs() <= 1e-15 * (1.0 + radius.abs()) {
                break;
            }
        }
        let exact = (radius * self.distortion_factor(radius * radius) - wanted).abs() <= 1e-9 * (1.0 + wanted);
        let scale = if wanted > 0.0 { radius / wanted } else { 1.0 };
        exact.then(|| Vector3::new(x * scale, y * scale, 1.0))
    }
}

/// Position and orientation of a camera, which define the mapping P = R X + t.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Rotation R. Its rows are the camera's right, down, and forward directions in world space.
    pub rotation: Matrix3<f64>,
    /// Translation t.
    pub translation: Vector3<f64>,
}

impl Pose {
    /// Returns the pose of a camera at the origin that looks along +z.
    pub fn identity() -> Self {
        Pose { rotation: Matrix3::identity(), translation: Vector3::zeros() }
    }

    /// Creates the pose of a camera from its position and its rotation.
    pub fn at(center: &Vector3<f64>, rotation: Matrix3<f64>) -> Self {
        Pose { rotation, translation: -rotation * center }
    }

    /// Creates the pose of a camera at `center` that looks at `target`. The direction `up` points
    /// upwards in its image.
    pub fn look_at(center: &Vector3<f64>, target: &Vector3<f64>, up: &Vector3<f64>) -> Self {
        let forward = (target - center).normalize();
        let right = forward.cross(up).normalize();
        let down = forward.cross(&right);
        Pose::at(center, Matrix3::from_rows(&[right.transpose(), down.transpose(), forward.transpose()]))
    }

    /// Transforms a world point to the camera frame.
    pub fn apply(&self, point: &Vector3<f64>) -> Vector3<f64> {
        self.rotation * point + self.translation
    }

    /// Returns the position of the camera, which is -Rᵀ t.
    pub fn center(&self) -> Vector3<f64> {
        -self.rotation.transpose() * self.translation
    }

    /// Returns the depth of a point, which is its distance along the view direction. It is negative
    /// behind the camera.
    pub fn depth(&self, point: &Vector3<f64>) -> f64 {
        self.apply(point).z
    }

    /// Transforms a direction from the camera frame to the world.
    pub fn direction_to_world(&self, direction: &Vector3<f64>) -> Vector3<f64> {
        self.rotation.transpose() * direction
    }
}

/// Returns the rotation about a vector by an angle equal to the vector's length in radians
/// (Rodrigues' formula).
pub fn rotation_of(axis_angle: &Vector3<f64>) -> Matrix3<f64> {
    let angle = axis_angle.norm();
    let cross = axis_angle.cross_matrix();
    // Compute sin(a) / a and (1 - cos(a)) / a². Near zero, use a series to avoid a division by
    // zero.
    let (a, b) = if angle < 1e-4 {
        let s = angle * angle;
        (1.0 - s / 6.0, 0.5 - s / 24.0)
    } else {
        let half = libm::sin(angle / 2.0);
        (libm::sin(angle) / angle, 2.0 * half * half / (angle * angle))
    };
    Matrix3::identity() + a * cross + b * cross * cross
}

/// Returns the axis of a rotation times its angle in radians, which is at most π. This is the
/// inverse of [`rotation_of`].
pub fn axis_angle_of(rotation: &Matrix3<f64>) -> Vector3<f64> {
    let [w, x, y, z] = quaternion_of(rotation);
    let axis = Vector3::new(x, y, z);
    let length = axis.norm();
    if length < 1e-300 { Vector3::zeros() } else { axis * (2.0 * libm::atan2(length, w) / length) }
}

/// Returns the unit quaternion (w, x, y, z) of a rotation, with w >= 0. It is computed starting
/// from its largest component, as proposed by Shepperd.
pub fn quaternion_of(r: &Matrix3<f64>) -> [f64; 4] {
    let (a, b, c) = (r[(0, 0)], r[(1, 1)], r[(2, 2)]);
    let squares = [1.0 + a + b + c, 1.0 + a - b - c, 1.0 - a + b - c, 1.0 - a - b + c];
    let largest = (1..4).fold(0, |best, i| if squares[i] > squares[best] { i } else { best });
    let [yx, zx, zy] = [r[(1, 0)] - r[(0, 1)], r[(0, 2)] - r[(2, 0)], r[(2, 1)] - r[(1, 2)]];
    let [xy, xz, yz] = [r[(1, 0)] + r[(0, 1)], r[(0, 2)] + r[(2, 0)], r[(2, 1)] + r[(1, 2)]];
    let twice = squares[largest].sqrt();
    let d = 0.5 / twice;
    let h = twice / 2.0;
    let q = match largest {
        0 => [h, zy * d, zx * d, yx * d],
        1 => [zy * d, h, xy * d, xz * d],
        2 => [zx * d, xy * d, h, yz * d],
        _ => [yx * d, xz * d, yz * d, h],
    };
    let norm = q.iter().map(|c| c * c).sum::<f64>().sqrt() * if q[0] < 0.0 { -1.0 } else { 1.0 };
    q.map(|c| c / norm)
}

/// Returns the rotation of a quaternion (w, x, y, z), which need not have length 1.
pub fn rotation_of_quaternion([w, x, y, z]: [f64; 4]) -> Matrix3<f64> {
    let q = nalgebra::Quaternion::new(w, x, y, z);
    *Rotation3::from(nalgebra::UnitQuaternion::from_quaternion(q)).matrix()
}

/// Returns the rotation that is nearest to a matrix in the Frobenius norm, computed by singular
/// value decomposition.
pub fn nearest_rotation(matrix: &Matrix3<f64>) -> Matrix3<f64> {
    let svd = matrix.svd(true, true);
    let (Some(u), Some(v)) = (svd.u, svd.v_t) else { return Matrix3::identity() };
    let sign = if (u * v).determinant() < 0.0 { -1.0 } else { 1.0 };
    u * Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, sign)) * v
}

/// Photograph in a [`Reconstruction`], with its name, lens, and pose.
#[derive(Debug, Clone, PartialEq)]
pub struct View {
    /// File name of the photograph, or a number if the format has no names.
    pub name: String,
    /// Index of the lens. Several photographs can share a lens.
    pub lens: usize,
    /// Pose of the camera; `None` if it is unknown.
    pub pose: Option<Pose>,
}

/// Observation of a scene point, with the photograph, the feature, and its pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Observation {
    /// Index of the photograph.
    pub view: usize,
    /// Index of the feature in its photograph.
    pub feature: usize,
    /// Position in pixels from the upper left corner.
    pub pixel: Vector2<f64>,
}

/// Scene point in a [`Reconstruction`], with its position, colour, and observations.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// Position in the world.
    pub position: Vector3<f64>,
    /// Red, green, and blue values from 0 to 255.
    pub color: [u8; 3],
    /// Observations of the point, in the order of the photographs.
    pub track: Vec<Observation>,
}

/// Cameras and points reconstructed from photographs.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Reconstruction {
    /// Lenses of the cameras. Several photographs can share a lens.
    pub lenses: Vec<Lens>,
    /// Photographs of the scene, including those with an unknown pose.
    pub views: Vec<View>,
    /// Points of the scene.
    pub points: Vec<Point>,
}

/// Reprojection error of a [`Reconstruction`].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ReprojectionError {
    /// Number of observations by photographs with a known pose.
    pub observations: usize,
    /// Cost in square pixels, which is half the sum of the squared residuals.
    pub cost: f64,
    /// Root mean square length of the residuals, in pixels.
    pub rms: f64,
    /// Length of the longest residual, in pixels.
    pub max: f64,
}

impl Reconstruction {
    /// Returns the projection of a point minus its observed pixel, or `None` if the pose of the
    /// photograph is unknown.
    pub fn residual(&self, position: &Vector3<f64>, observation: &Observation) -> Option<Vector2<f64>> {
        let view = &self.views[observation.view];
        let pose = view.pose.as_ref()?;
        Some(self.lenses[view.lens].project(&pose.apply(position)) - observation.pixel)
    }

    /// Returns the residuals of all observations in photographs with a known pose.
    pub fn residuals(&self) -> impl Iterator<Item = Vector2<f64>> {
        self.points
            .iter()
            .flat_map(|point| point.track.iter().filter_map(|observation| self.residual(&point.position, observation)))
    }

    /// Computes the reprojection error of the reconstruction.
    pub fn reprojection_error(&self) -> ReprojectionError {
        let mut fit = ReprojectionError::default();
        for square in self.residuals().map(|residual| residual.norm_squared()) {
            fit.observations += 1;
            fit.cost += square / 2.0;
            fit.max = fit.max.max(square.sqrt());
        }
        fit.rms = (2.0 * fit.cost / fit.observations.max(1) as f64).sqrt();
        fit
    }

    /// Estimates the standard deviation in pixels of a residual's components. It is based on the
    /// median residual, which is robust to outliers. The median length of normally distributed
    /// errors is √(2 ln 2) times their standard deviation.
    pub fn noise(&self) -> f64 {
        let mut lengths: Vec<f64> = self.residuals().map(|residual| residual.norm()).collect();
        lengths.sort_by(f64::total_cmp);
        lengths.get(lengths.len() / 2).map_or(0.0, |median| median / 1.1774)
    }

    /// Returns the number of photographs with a known pose.
    pub fn registered_count(&self) -> usize {
        self.views.iter().filter(|view| view.pose.is_some()).count()
    }

    /// Returns the mean number of observations of a point.
    pub fn track_length(&self) -> f64 {
        self.points.iter().map(|point| point.track.len()).sum::<usize>() as f64 / self.points.len().max(1) as f64
    }

    /// Returns the largest angle in radians between two rays to a point.
    pub fn max_ray_angle(&self, point: &Point) -> f64 {
        let toward = |observation: &Observation| {
            let center = self.views[observation.view].pose.as_ref()?.center();
            Some((point.position - center).normalize())
        };
        let rays: Vec<Vector3<f64>> = point.track.iter().filter_map(toward).collect();
        let pairs = rays.iter().enumerate().flat_map(|(i, a)| rays[i + 1..].iter().map(move |b| (a, b)));
        // Compute the angle from the chord, which is precise for small angles, unlike the cosine.
        pairs.map(|(a, b)| 2.0 * libm::asin(((a - b).norm() / 2.0).min(1.0))).fold(0.0, f64::max)
    }
}
