//! Triangulates points, and selects the observations that fit them.

use super::{CandidateTrack, Solver};
use crate::geometry::triangulate::nearest_to_rays;
use crate::{Observation, Pose};
use nalgebra::Vector3;

/// Maximum number of ray pairs from which a point is triangulated.
const MAX_RAY_PAIRS: usize = 12;

impl Solver<'_> {
    /// Returns the residual of an observation in pixels, which is infinite behind the camera.
    /// Returns `None` if the photograph is not registered.
    fn residual(&self, position: &Vector3<f64>, observation: &Observation) -> Option<f64> {
        let view = &self.views[observation.view];
        let p = view.pose.as_ref()?.apply(position);
        let length = (self.lenses[view.lens].project(&p) - observation.pixel).norm();
        Some(if p.z > 0.0 && length.is_finite() { length } else { f64::INFINITY })
    }

    fn fits(&self, position: &Vector3<f64>, observation: &Observation) -> bool {
        self.residual(position, observation).is_some_and(|length| length <= self.threshold(observation.view))
    }

    /// Triangulates tracks that have no point, and updates which observations fit. Returns the
    /// number of new points.
    pub(super) fn triangulate_tracks(&mut self) -> usize {
        let mut added = 0;
        for t in 0..self.tracks.len() {
            let track = &self.tracks[t];
            let position = match track.position {
                Some(position) => position,
                None => match self.triangulate(track) {
                    Some(position) => {
                        added += 1;
                        position
                    }
                    None => continue,
                },
            };
            let fits = track.observations.iter().map(|observation| self.fits(&position, observation)).collect();
            let track = &mut self.tracks[t];
            (track.position, track.fits) = (Some(position), fits);
        }
        added
    }

    /// Returns the rays from the registered photographs to the point of a track.
    fn rays(&self, track: &CandidateTrack) -> Vec<(Vector3<f64>, Vector3<f64>)> {
        let ray = |observation: &Observation| {
            let view = &self.views[observation.view];
            let pose: &Pose = view.pose.as_ref()?;
            let direction = self.lenses[view.lens].unproject(&observation.pixel)?;
            Some((pose.center(), pose.direction_to_world(&direction).normalize()))
        };
        track.observations.iter().filter_map(ray).collect()
    }

    /// Triangulates a track from the pair of rays whose point is consistent with the most
    /// observations. The angle between the rays must be large enough.
    fn triangulate(&self, track: &CandidateTrack) -> Option<Vector3<f64>> {
        let rays = self.rays(track);
        let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
        for i in 0..rays.len() {
            pairs.extend((0..i).map(|j| (rays[i].1.dot(&rays[j].1), j, i)));
        }
        // Try the widest angles first.
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        let widest = libm::cos(self.options.min_angle.to_radians());
        let mut best: Option<(usize, Vector3<f64>)> = None;
        for (_, i, j) in pairs.iter().take(MAX_RAY_PAIRS).filter(|pair| pair.0 < widest) {
            let Some(point) = nearest_to_rays(&[rays[*i], rays[*j]]) else { continue };
            let count = track.observations.iter().filter(|observation| self.fits(&point, observation)).count();
            if count >= 2 && best.is_none_or(|best| count > best.0) {
                best = Some((count, point));
            }
            if count == rays.len() {
                break;
            }
        }
        best.map(|best| best.1)
    }

    /// Drops observations with large residuals. Also drops points that have fewer than two
    /// observations or a small angle between their rays. Returns the number of dropped
    /// observations.
    pub(super) fn drop_outliers(&mut self) -> usize {
        let mut dropped = 0;
        let widest = libm::cos(self.options.min_angle.to_radians());
        for t in 0..self.tracks.len() {
            let track = &self.tracks[t];
            let Some(position) = track.position else { continue };
            let fits: Vec<bool> =
                track.observations.iter().map(|observation| self.fits(&position, observation)).collect();
            let known = |(seen, fits): (&Observation, &bool)| {
                let pose = self.views[seen.view].pose.as_ref().filter(|_| *fits)?;
                Some((position - pose.center()).normalize())
            };
            let rays: Vec<Vector3<f64>> = track.observations.iter().zip(&fits).filter_map(known).collect();
            let wide = rays.iter().enumerate().any(|(i, a)| rays[i + 1..].iter().any(|b| a.dot(b) < widest));
            let registered = |observation: &Observation| self.views[observation.view].pose.is_some();
            let gone = track
                .observations
                .iter()
                .zip(track.fits.iter().zip(&fits))
                .filter(|(s, (a, b))| registered(s) && **a && !**b);
            dropped += gone.count();
            let track = &mut self.tracks[t];
            track.fits = fits;
            if !wide {
                track.position = None;
            }
        }
        dropped
    }
}
