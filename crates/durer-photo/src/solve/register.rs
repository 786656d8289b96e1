//! Registration, which computes the pose of a photograph that observes known points.

use super::Solver;
use crate::adjust::{Loss, Options, adjust};
use crate::geometry::p3p::p3p;
use crate::geometry::ransac::{RansacOptions, RansacProblem, ransac};
use crate::{Lens, Observation, Point, Pose, Reconstruction, View};
use nalgebra::{Vector2, Vector3};

/// RANSAC problem of finding a camera's pose with a known lens, from world points and their pixels,
/// which include outliers.
struct PoseProblem<'k> {
    lens: &'k Lens,
    pairs: &'k [(Vector3<f64>, Vector2<f64>)],
    directions: Vec<Option<Vector3<f64>>>,
}

impl RansacProblem<4> for PoseProblem<'_> {
    type Model = Pose;

    fn count(&self) -> usize {
        self.pairs.len()
    }

    /// Computes up to four poses from three points, and uses the fourth point to select one of
    /// them.
    fn solve_minimal(&self, sample: &[usize; 4]) -> Vec<Pose> {
        let [Some(a), Some(b), Some(c), _] = sample.map(|i| self.directions[i]) else { return Vec::new() };
        let points = [0, 1, 2].map(|k| self.pairs[sample[k]].0);
        let poses = p3p(&points, &[a, b, c]).into_iter().map(|pose| (self.error(&pose, sample[3]), pose));
        poses.reduce(|best, next| if next.0 < best.0 { next } else { best }).map(|best| best.1).into_iter().collect()
    }

    fn refine(&self, inliers: &[usize], model: &Pose) -> Option<Pose> {
        let pairs: Vec<_> = inliers.iter().map(|i| self.pairs[*i]).collect();
        let options = Options { focal: false, radial: false, iterations: 5, ..Options::default() };
        refine_pose(&pairs, self.lens, model, &options).map(|refined| refined.0)
    }

    fn error(&self, model: &Pose, datum: usize) -> f64 {
        let (point, pixel) = &self.pairs[datum];
        let p = model.apply(point);
        if p.z > 0.0 { (self.lens.project(&p) - pixel).norm_squared() } else { f64::INFINITY }
    }
}

/// Adjusts the pose and the lens of a single camera.
pub fn refine_pose(
    pairs: &[(Vector3<f64>, Vector2<f64>)],
    lens: &Lens,
    pose: &Pose,
    options: &Options,
) -> Option<(Pose, Lens)> {
    let point = |(i, (position, pixel)): (usize, &(Vector3<f64>, Vector2<f64>))| {
        let track = vec![Observation { view: 0, feature: i, pixel: *pixel }];
        Point { position: *position, color: [0; 3], track }
    };
    let mut one = Reconstruction {
        lenses: vec![*lens],
        views: vec![View { name: String::new(), lens: 0, pose: Some(*pose) }],
        points: pairs.iter().enumerate().map(point).collect(),
    };
    adjust(&mut one, &Options { points: false, ..*options });
    Some((one.views[0].pose?, one.lenses[0]))
}

/// Estimates the pose of a camera with a known lens. Also returns the indices of the inliers.
/// Returns `None` if there are at most four inliers.
pub fn estimate_pose(
    pairs: &[(Vector3<f64>, Vector2<f64>)],
    lens: &Lens,
    threshold: f64,
    seed: u64,
) -> Option<(Pose, Vec<usize>)> {
    let directions = pairs.iter().map(|pair| lens.unproject(&pair.1)).collect();
    ransac(&PoseProblem { lens, pairs, directions }, &RansacOptions { threshold, samples: 3000, seed })
}

impl Solver<'_> {
    /// Estimates the pose of a photograph and adds it to the reconstruction. Returns true on
    /// success.
    pub(super) fn register(&mut self, view: usize) -> bool {
        let known = self.tracks_of_view[view].iter().filter_map(|(t, k)| Some((*t, *k, self.tracks[*t].position?)));
        let known: Vec<(usize, usize, Vector3<f64>)> = known.collect();
        let pairs: Vec<_> =
            known.iter().map(|(t, k, position)| (*position, self.tracks[*t].observations[*k].pixel)).collect();
        let number = self.views[view].lens;
        // The focal length may still be wrong if no registered photograph has the same lens.
        let alone = !self.views.iter().any(|other| other.lens == number && other.pose.is_some());
        let free = alone && !self.options.fixed_focal;
        let factors: &[f64] = if free { &[1.0, 0.8, 1.25, 0.6, 1.6] } else { &[1.0] };
        let threshold = 2.0 * self.threshold(view);
        let mut best: Option<(Pose, Vec<usize>, Lens)> = None;
        for factor in factors {
            let lens = Lens { focal: factor * self.lenses[number].focal, ..self.lenses[number] };
            let Some((pose, inliers)) = estimate_pose(&pairs, &lens, threshold, self.options.seed ^ view as u64) else {
                continue;
            };
            let enough = inliers.len() * 10 >= pairs.len() * 9;
            if best.as_ref().is_none_or(|best| inliers.len() > best.1.len()) {
                best = Some((pose, inliers, lens));
            }
            if enough {
                break;
            }
        }
        let Some((pose, inliers, lens)) = best else { return false };
        if inliers.len() < self.options.min_points || inliers.len() * 4 < pairs.len() {
            return false;
        }
        let good: Vec<_> = inliers.iter().map(|i| pairs[*i]).collect();
        let options =
            Options { loss: Loss::Huber(1.0), focal: free, radial: false, iterations: 20, ..Options::default() };
        let Some((pose, lens)) = refine_pose(&good, &lens, &pose, &options) else { return false };
        self.views[view].pose = Some(pose);
        self.lenses[number] = lens;
        let mut fits = vec![false; known.len()];
        inliers.into_iter().for_each(|i| fits[i] = true);
        known.iter().zip(fits).for_each(|((t, k, _), fits)| self.tracks[*t].fits[*k] = fits);
        true
    }
}
