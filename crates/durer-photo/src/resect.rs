//! Computes the camera of a single photograph from known world points, or from lines that are
//! parallel in the world.

use crate::adjust::{Loss, Options};
use crate::geometry::camera::{decompose, principal_deviations, solve_dlt};
pub use crate::known::{Axis, PointPixelPair, VanishingLines};
use crate::solve::{estimate_pose, refine_pose};
use crate::{Error, Lens, Pose};
use nalgebra::{DMatrix, Matrix3, Vector2, Vector3};

/// Input of [`camera`] in addition to the points, with known properties of the lens and the
/// threshold for outliers.
#[derive(Debug, Clone)]
pub struct LensPriors {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Focal length in pixels, if known.
    pub focal: Option<f64>,
    /// True if k1 and k2 should be estimated.
    pub distortion: bool,
    /// Maximum residual of an inlier in pixels.
    pub threshold: f64,
}

/// Camera of a single photograph, estimated from known world points, with its inliers and accuracy.
#[derive(Debug, Clone)]
pub struct Resection {
    /// Estimated lens.
    pub lens: Lens,
    /// Estimated pose.
    pub pose: Pose,
    /// Indices of the points that are consistent with the camera.
    pub inliers: Vec<usize>,
    /// Root mean square residual of the inliers, in pixels.
    pub rms: f64,
    /// Ratio of the smallest to the largest singular value of the Jacobian, whose columns are
    /// scaled to the same length.
    pub conditioning: f64,
}

/// Minimum spread of the points along the third principal axis, relative to the first axis. Points
/// with a smaller spread are treated as lying in a plane.
const MIN_THICKNESS: f64 = 1e-3;
/// Minimum value of [`Resection::conditioning`] at which a camera counts as determined.
const MIN_CONDITIONING: f64 = 1e-6;

/// Estimates the camera from world points and their pixels. The principal point is assumed to be
/// the image centre, and pixels are assumed to be square.
///
/// # Errors
///
/// Returns an error if the points do not determine a camera. This happens if there are too few
/// points, if they lie on a line or, without a known focal length, in a plane, or if they are not
/// consistent with any camera.
pub fn camera(pairs: &[PointPixelPair], known: &LensPriors) -> Result<Resection, Error> {
    let points: Vec<Vector3<f64>> = pairs.iter().map(|pair| pair.0).collect();
    let least = if known.focal.is_some() { 4 } else { 6 };
    if pairs.len() < least {
        let count = pairs.len();
        let why = match known.focal {
            Some(_) => "three points fit up to four cameras; the fourth point selects one",
            None => "the direct linear transform has eleven unknowns, and a point gives two equations",
        };
        let what = if known.focal.is_some() { "known" } else { "unknown" };
        return Err(Error::new(format!(
            "at least {least} points are needed if the focal length is {what}, but there are {count}: {why}"
        )));
    }
    let [first, second, third] = principal_deviations(&points);
    if second <= MIN_THICKNESS * first {
        return Err(Error::new("the points lie on a line: the camera could be anywhere around that line"));
    }
    let flat = third <= MIN_THICKNESS * first;
    if flat && known.focal.is_none() {
        return Err(Error::new(
            "the points lie in a plane, so DLT has no unique solution: pass the focal length, or points outside the \
             plane",
        ));
    }
    let side = f64::from(known.size[0].max(known.size[1]));
    let candidates = match known.focal {
        Some(focal) => vec![focal],
        None => {
            let pixels: Vec<Vector2<f64>> = pairs.iter().map(|pair| pair.1).collect();
            let transform = solve_dlt(&points, &pixels).and_then(|solution| decompose(&solution.matrix));
            let focal = transform.map(|(k, ..)| (k[(0, 0)] + k[(1, 1)]) / 2.0);
            let usual = [0.5, 0.7, 1.0, 1.4, 2.0, 2.8, 4.0].map(|factor| factor * side);
            focal.filter(|f| (0.2..20.0).contains(&(f / side))).into_iter().chain(usual).collect()
        }
    };
    let mut best: Option<Resection> = None;
    for focal in candidates {
        let lens = Lens::new(known.size, focal);
        // A wrong initial focal length increases all residuals.
        let initial_threshold = if known.focal.is_some() { known.threshold } else { known.threshold.max(0.02 * side) };
        let Some(resection) = from_lens(pairs, lens, known, initial_threshold) else { continue };
        let better = |best: &Resection| (resection.inliers.len(), -resection.rms) > (best.inliers.len(), -best.rms);
        if best.as_ref().is_none_or(better) {
            best = Some(resection);
        }
    }
    // By chance, a few points always agree with some camera, so two thirds of the points must
    // agree.
    let enough = |best: &Resection| best.inliers.len() >= least.max((2 * pairs.len()).div_ceil(3));
    let best = best.filter(enough).ok_or_else(|| {
        let limit = known.threshold;
        Error::new(format!(
            "no camera sees the points at the given pixels: fewer than two thirds of the points agree within {limit} \
             pixels. X Y Z are right-handed; u is measured from the left, and v from the top"
        ))
    })?;
    if best.conditioning < MIN_CONDITIONING {
        return Err(Error::new(
            "the points do not determine the camera: another focal length and distance fit nearly as well",
        ));
    }
    Ok(best)
}

/// Estimates the camera, starting from an initial focal length.
fn from_lens(pairs: &[PointPixelPair], lens: Lens, known: &LensPriors, initial_threshold: f64) -> Option<Resection> {
    let (pose, inliers) = estimate_pose(pairs, &lens, initial_threshold, 0).or_else(|| {
        // RANSAC needs more points than its sample contains, so exactly four points are handled
        // separately.
        let all: Vec<usize> = (0..pairs.len()).collect();
        let directions: Option<Vec<_>> = pairs[..3].iter().map(|pair| lens.unproject(&pair.1)).collect();
        let [a, b, c] = directions?.try_into().ok()?;
        let poses = crate::geometry::p3p::p3p(&[pairs[0].0, pairs[1].0, pairs[2].0], &[a, b, c]).into_iter();
        let sum = |pose: &Pose| pairs.iter().map(|pair| residual(&lens, pose, pair)).sum::<f64>();
        let best = poses.reduce(|a, b| if sum(&b) < sum(&a) { b } else { a })?;
        (pairs.len() == 4).then_some((best, all))
    })?;
    let options = Options {
        loss: Loss::Huber(known.threshold),
        focal: known.focal.is_none(),
        radial: false,
        tolerance: 1e-12,
        ..Options::default()
    };
    let (mut pose, mut lens, mut inliers) = (pose, lens, inliers);
    for round in 0..4 {
        let good: Vec<PointPixelPair> = inliers.iter().map(|i| pairs[*i]).collect();
        let radial = known.distortion && round > 0 && good.len() >= 8;
        (pose, lens) = refine_pose(&good, &lens, &pose, &Options { radial, ..options })?;
        inliers = (0..pairs.len()).filter(|i| residual(&lens, &pose, &pairs[*i]) <= known.threshold).collect();
        if inliers.len() < 4 {
            return None;
        }
    }
    let side = lens.longer_side();
    if !(0.05..100.0).contains(&(lens.focal / side)) {
        return None;
    }
    let square = inliers.iter().map(|i| residual(&lens, &pose, &pairs[*i])).map(|r| r * r).sum::<f64>();
    let rms = (square / inliers.len() as f64).sqrt();
    let conditioning = conditioning(&lens, &pose, pairs, &inliers, known.focal.is_none());
    Some(Resection { lens, pose, inliers, rms, conditioning })
}

fn residual(lens: &Lens, pose: &Pose, (point, pixel): &PointPixelPair) -> f64 {
    let p = pose.apply(point);
    if p.z > 0.0 { (lens.project(&p) - pixel).norm() } else { f64::INFINITY }
}

/// Computes the value of [`Resection::conditioning`].
fn conditioning(lens: &Lens, pose: &Pose, pairs: &[PointPixelPair], inliers: &[usize], focal: bool) -> f64 {
    let columns = if focal { 7 } else { 6 };
    let mut rows = DMatrix::zeros(2 * inliers.len().max(4), columns);
    for (k, i) in inliers.iter().enumerate() {
        let by_camera = crate::adjust::camera_jacobian(lens, pose, &pairs[*i].0);
        rows.view_mut((2 * k, 0), (2, columns)).copy_from(&by_camera.columns(0, columns));
    }
    for mut column in rows.column_iter_mut() {
        let norm = column.norm();
        column /= if norm > 0.0 { norm } else { 1.0 };
    }
    let (_, values) = crate::geometry::null_vector(&rows);
    values[columns - 1] / values[0]
}

/// Returns the vanishing point of lines, which is the homogeneous point closest to all of them.
fn vanishing_point(lines: &[[Vector2<f64>; 2]], size: f64) -> Option<Vector3<f64>> {
    let homogeneous = |p: &Vector2<f64>| Vector3::new(p.x / size, p.y / size, 1.0);
    let line = |ends: &[Vector2<f64>; 2]| homogeneous(&ends[0]).cross(&homogeneous(&ends[1])).try_normalize(1e-12);
    let rows: Vec<Vector3<f64>> = lines.iter().map(line).collect::<Option<_>>()?;
    if rows.len() < 2 {
        return None;
    }
    let (v, values) = crate::geometry::null_vector(&DMatrix::from_fn(rows.len(), 3, |i, j| rows[i][j]));
    (values[1] > 1e-9 * values[0]).then(|| Vector3::new(v[0] * size, v[1] * size, v[2]))
}

/// Computes the camera from two vanishing points v and w. The focal length is given by f² = -(v -
/// c)·(w - c), where c is the principal point. The directions of the axes are (v - c, f) and (w -
/// c, f). A photograph does not determine the scale, so `distance` sets the distance from the
/// camera to the origin.
///
/// Source: Hartley, Zisserman, *Multiple View Geometry in Computer Vision*, 2nd edition, 2004,
/// section 8.6; Guillou and others, *Using Vanishing Points for Camera Calibration and Coarse 3D
/// Reconstruction from a Single Image*, The Visual Computer 16, 2000.
///
/// # Errors
///
/// Returns an error if the lines do not determine a camera.
pub fn from_vanishing_lines(known: &VanishingLines, distance: f64) -> Result<(Lens, Pose), Error> {
    let size = f64::from(known.size[0].max(known.size[1]));
    let [one, two] = known.axes;
    if one.index == two.index {
        return Err(Error::new(
            "both sets of lines have the same axis, but the two axes must be perpendicular in the world",
        ));
    }
    let mut points = Vec::new();
    for lines in &known.lines {
        let v = vanishing_point(lines, size).ok_or_else(|| {
            Error::new("a vanishing point needs at least two distinct lines, each through two different pixels")
        })?;
        if v.z.abs() * 1e4 * size < v.xy().norm() {
            return Err(Error::new(
                "lines that are parallel in the world are parallel in the picture too: their vanishing point is at \
                 infinity, so the focal length is undetermined",
            ));
        }
        points.push(v.xy() / v.z - known.center);
    }
    let square = -points[0].dot(&points[1]);
    if square <= 1e-6 * size * size {
        return Err(Error::new(
            "no camera has these vanishing points: the angle between the points, seen from the principal point, must \
             be more than 90 degrees",
        ));
    }
    let focal = square.sqrt();
    let lens = Lens { principal_point: known.center.into(), ..Lens::new(known.size, focal) };
    let direction = |p: &Vector2<f64>| Vector3::new(p.x, p.y, focal).normalize();
    let (d1, d2) = (direction(&points[0]), direction(&points[1]));
    let (e1, e2) = (one.direction(), two.direction());
    let camera = Matrix3::from_columns(&[d1, d2, d1.cross(&d2)]);
    let world = Matrix3::from_columns(&[e1, e2, e1.cross(&e2)]);
    let rotation = camera * world.transpose();
    let origin = known.origin - known.center;
    let translation = distance * Vector3::new(origin.x / focal, origin.y / focal, 1.0).normalize();
    Ok((lens, Pose { rotation, translation }))
}
