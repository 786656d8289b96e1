//! Selects the two photographs with which the reconstruction starts.

use super::Solver;
use crate::geometry::essential::{EssentialProblem, pose_in_front};
use crate::geometry::ransac::{RansacOptions, ransac};
use crate::geometry::triangulate::two_views;
use crate::matching::{Matches, PhotoPair, is_chance};
use crate::{Error, Pose};
use nalgebra::Vector2;
use rayon::prelude::*;

/// Number of photograph pairs to try, in decreasing order of their number of matches.
const MAX_PAIRS: usize = 30;

impl Solver<'_> {
    /// Selects two photographs that share many points and were taken from clearly different
    /// positions. Sets their poses, and triangulates the points that they share.
    pub(super) fn initial(&mut self, matches: &Matches) -> Result<[usize; 2], Error> {
        let mut links: Vec<&PhotoPair> = matches.links.iter().collect();
        links.sort_by(|a, b| b.matches.cmp(&a.matches).then(a.pictures.cmp(&b.pictures)));
        let mut best: Option<(f64, [usize; 2], Pose)> = None;
        let mut turned = 0;
        links.truncate(MAX_PAIRS);
        let poses: Vec<_> = links.par_iter().map(|link| self.relative(link.pictures)).collect();
        for (link, result) in links.into_iter().zip(poses) {
            let Some((pose, count, angle)) = result else { continue };
            if angle < self.options.min_angle.to_radians() {
                turned += 1;
                continue;
            }
            // All angles of ten degrees or more are equally good. Planar scenes do not determine
            // the lens.
            let score = count as f64 * (angle.to_degrees() / 10.0).min(1.0) * (1.2 - link.planar_fraction);
            if best.as_ref().is_none_or(|best| score > best.0) {
                best = Some((score, link.pictures, pose));
            }
        }
        let why = if turned > 0 {
            "the photographs were taken from one position: the camera only rotated, so depth is undetermined"
        } else {
            "no two photographs share enough points that agree on one geometry"
        };
        let (_, [a, b], pose) = best.ok_or_else(|| Error::new(why))?;
        self.views[a].pose = Some(Pose::identity());
        self.views[b].pose = Some(pose);
        self.triangulate_tracks();
        self.adjust_and_filter(2);
        let count = self.tracks.iter().filter(|track| track.position.is_some()).count();
        if count < self.options.min_points {
            return Err(Error::new("no two photographs share enough points that agree on one geometry"));
        }
        Ok([a, b])
    }

    /// Returns the pose of the second photograph in the frame of the first. Also returns the number
    /// of points in front of both, and the median angle between the rays.
    fn relative(&self, [a, b]: [usize; 2]) -> Option<(Pose, usize, f64)> {
        let lenses = [a, b].map(|view| self.lenses[self.views[view].lens]);
        let mut pairs = Vec::new();
        for (t, k) in &self.tracks_of_view[a] {
            let track = &self.tracks[*t];
            let Some(other) = track.observations.iter().find(|observation| observation.view == b) else { continue };
            let direction = |lens: usize, pixel: &Vector2<f64>| Some(lenses[lens].unproject(pixel)?.xy());
            pairs.extend(direction(0, &track.observations[*k].pixel).zip(direction(1, &other.pixel)));
        }
        let threshold = (self.threshold(a) / lenses[0].focal).max(self.threshold(b) / lenses[1].focal);
        let seed = self.options.seed ^ 0x5eed ^ ((a as u64) << 32 | b as u64);
        let (e, inliers) = ransac(&EssentialProblem(&pairs), &RansacOptions { threshold, samples: 2000, seed })?;
        if is_chance(inliers.len(), pairs.len()) {
            return None;
        }
        let inliers: Vec<_> = inliers.into_iter().map(|i| pairs[i]).collect();
        let (pose, before) = pose_in_front(&e, &inliers)?;
        if before < self.options.min_points || before * 2 < inliers.len() {
            return None;
        }
        let center = pose.center();
        let angle = |pair: &(Vector2<f64>, Vector2<f64>)| {
            let point = two_views(&pose, pair);
            let (one, two) = (point.try_normalize(1e-12)?, (point - center).try_normalize(1e-12)?);
            Some(2.0 * libm::asin(((one - two).norm() / 2.0).min(1.0))).filter(|a| a.is_finite())
        };
        let mut angles: Vec<f64> = inliers.iter().filter_map(angle).collect();
        angles.sort_by(f64::total_cmp);
        Some((pose, before, *angles.get(angles.len() / 2)?))
    }
}
