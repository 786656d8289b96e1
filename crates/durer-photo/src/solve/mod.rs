//! Incremental structure from motion, which computes cameras and points from tracks.
//!
//! The reconstruction starts with two photographs (`initial`). The following steps are then
//! repeated: the photograph that observes the most known points is added (`register`), its new
//! points are triangulated (`structure`), and bundle adjustment refines everything. Outliers are
//! dropped along the way.
//!
//! Source: Snavely, Seitz, Szeliski, *Photo Tourism: Exploring Photo Collections in 3D*, SIGGRAPH
//! 2006, section 4.2.

mod initial;
mod register;
mod structure;

pub use register::{estimate_pose, refine_pose};

use crate::adjust::{self, Loss, adjust};
use crate::geometry::align::Similarity;
use crate::matching::{GUESS, Matches};
use crate::{Error, Lens, Observation, Point, Reconstruction, View};
use nalgebra::{Matrix3, Vector2, Vector3};

/// Scale of the Cauchy loss in standard deviations. At this scale, the loss is 95 % efficient for
/// normally distributed errors (Holland, Welsch, *Robust Regression Using Iteratively Reweighted
/// Least-Squares*, 1977). Errors of keypoints have much heavier tails. Half of the coordinates are
/// off by a tenth of a pixel or less, and some by two pixels.
const CAUCHY: f64 = 2.385;
/// Minimum standard deviation in pixels of a keypoint's position.
const MIN_NOISE: f64 = 0.02;

/// Options of incremental reconstruction by [`solve`].
#[derive(Debug, Clone)]
pub struct Options {
    /// True if focal lengths are kept fixed.
    pub fixed_focal: bool,
    /// True if k1 and k2 are kept at 0.
    pub no_distortion: bool,
    /// True if each photograph has a separate lens.
    pub own_lenses: bool,
    /// Maximum residual of an observation in pixels, for photographs of up to 1600 pixels. It
    /// increases in proportion to the size of larger photographs.
    pub threshold: f64,
    /// Minimum angle in degrees between two rays to a point.
    pub min_angle: f64,
    /// Minimum number of known points that a photograph must observe to be registered.
    pub min_points: usize,
    /// Seed of the random numbers.
    pub seed: u64,
}

impl Default for Options {
    fn default() -> Self {
        let (fixed_focal, no_distortion, own_lenses) = (false, false, false);
        Options { fixed_focal, no_distortion, own_lenses, threshold: 2.5, min_angle: 1.5, min_points: 15, seed: 0 }
    }
}

/// Track during reconstruction, with its observations, and with its position once it is
/// triangulated.
struct CandidateTrack {
    color: [u8; 3],
    observations: Vec<Observation>,
    /// For each observation, true if the residual is within the threshold.
    fits: Vec<bool>,
    position: Option<Vector3<f64>>,
}

/// State of an incremental reconstruction, with photographs, lenses, and tracks.
struct Solver<'o> {
    options: &'o Options,
    views: Vec<View>,
    lenses: Vec<Lens>,
    /// Initial lenses, which replace any lenses that diverge.
    initial_lenses: Vec<Lens>,
    tracks: Vec<CandidateTrack>,
    /// Tracks that each photograph observes, with the index of its observation in each track.
    tracks_of_view: Vec<Vec<(usize, usize)>>,
}

/// Result of [`solve`], which contains the reconstruction and notes for the user.
pub struct Solution {
    /// Reconstructed cameras and points.
    pub reconstruction: Reconstruction,
    /// Notes for the user. They list photographs that were left out, with the reason, and focal
    /// lengths that differ much from EXIF.
    pub notes: Vec<String>,
}

/// Reconstructs cameras and points from matches. The function `progress` receives the number of
/// registered photographs.
///
/// If the initial focal length is wrong, few photographs fit, or the focal length changes
/// considerably. This happens, for example, if the photographs were scaled down without updating
/// the EXIF data. In that case, the function solves again, starting from the resulting focal length
/// or from a typical one, and returns the better result.
///
/// # Errors
///
/// Returns an error if no two photographs are suitable to start with.
pub fn solve(matches: &Matches, options: &Options, progress: &dyn Fn(usize)) -> Result<Solution, Error> {
    let first = solve_once(matches, matches, options, progress);
    let usual = |size: [u32; 2]| 1.2 * f64::from(size[0].max(size[1]));
    let mut again = matches.clone();
    for (i, picture) in again.pictures.iter_mut().enumerate() {
        picture.focal = match &first {
            Ok(solved) if focal_changed(solved.focal(i) / picture.focal) => solved.focal(i),
            _ if focal_changed(usual(picture.size) / picture.focal) => usual(picture.size),
            _ => picture.focal,
        };
    }
    let whole = first.as_ref().is_ok_and(|solved| {
        let near =
            |(i, picture): (usize, &crate::matching::MatchedPhoto)| !focal_changed(solved.focal(i) / picture.focal);
        solved.reconstruction.registered_count() == solved.reconstruction.views.len()
            && matches.pictures.iter().enumerate().all(near)
    });
    if whole || options.fixed_focal || again == *matches {
        return first;
    }
    let second = solve_once(&again, matches, options, progress);
    let worth = |solved: &Solution| {
        (solved.reconstruction.registered_count(), solved.reconstruction.reprojection_error().observations)
    };
    match (first, second) {
        (Ok(one), Ok(two)) => Ok(if worth(&two) > worth(&one) { two } else { one }),
        (one, two) => one.or(two),
    }
}

/// Returns true if a focal length has changed considerably.
fn focal_changed(ratio: f64) -> bool {
    !(0.75..=1.33).contains(&ratio)
}

impl Solution {
    /// Returns the focal length of a photograph's lens in pixels.
    fn focal(&self, view: usize) -> f64 {
        self.reconstruction.lenses[self.reconstruction.views[view].lens].focal
    }
}

/// Solves once, starting from the focal lengths in `matches`. The notes compare the result with the
/// focal lengths in `written`.
fn solve_once(
    matches: &Matches,
    written: &Matches,
    options: &Options,
    progress: &dyn Fn(usize),
) -> Result<Solution, Error> {
    let mut solver = Solver::new(matches, options);
    let mut notes = Vec::new();
    let first = solver.initial(matches)?.map(|i| &matches.pictures[i].name);
    notes.push(format!("the reconstruction started with {} and {}", first[0], first[1]));
    let mut refused = vec![false; solver.views.len()];
    let mut last_adjusted = 2;
    while let Some(view) = solver.next(&refused) {
        if !solver.register(view) {
            refused[view] = true;
            continue;
        }
        // Photographs that were refused earlier can fit now.
        refused.fill(false);
        solver.triangulate_tracks();
        let known = solver.registered();
        progress(known);
        // Run the adjustment only after the number of photographs has grown by a tenth.
        if known > last_adjusted + last_adjusted / 10 {
            solver.adjust(false);
            solver.drop_outliers();
            last_adjusted = known;
        }
    }
    solver.adjust_and_filter(6);
    for (i, view) in solver.views.iter().enumerate().filter(|(_, view)| view.pose.is_none()) {
        let why = match matches.links.iter().any(|link| link.pictures.contains(&i)) {
            false => "it shows no point that another photograph shows",
            true => "too few known points agree on its pose",
        };
        notes.push(format!("{} is left out: {why}", view.name));
    }
    let mut reported = Vec::new();
    for (view, picture) in solver.views.iter().zip(&written.pictures).filter(|(view, _)| view.pose.is_some()) {
        let focal = solver.lenses[view.lens].focal;
        if focal_changed(focal / picture.focal)
            && !picture.focal_source.starts_with(GUESS)
            && !reported.contains(&view.lens)
        {
            reported.push(view.lens);
            let (name, wrong) = (&picture.name, picture.focal);
            notes.push(format!("{name} has a focal length of {focal:.0} pixels, but EXIF wrongly says {wrong:.0}"));
        }
    }
    let mut reconstruction = solver.reconstruction(true).0;
    normalize_world(&mut reconstruction);
    Ok(Solution { reconstruction, notes })
}

impl<'o> Solver<'o> {
    fn new(matches: &Matches, options: &'o Options) -> Self {
        let mut lenses = matches.lenses();
        let lens = |i: usize| if options.own_lenses { i } else { matches.pictures[i].lens };
        if options.own_lenses {
            lenses = matches.pictures.iter().map(|picture| Lens::new(picture.size, picture.focal)).collect();
        }
        let view = |(i, name): (usize, String)| View { name, lens: lens(i), pose: None };
        let views: Vec<View> = matches.pictures.iter().map(|p| p.name.clone()).enumerate().map(view).collect();
        let mut tracks_of_view = vec![Vec::new(); views.len()];
        let mut tracks = Vec::new();
        for (t, track) in matches.tracks.iter().enumerate() {
            let observations: Vec<Observation> = track
                .observations
                .iter()
                .map(|s| Observation { view: s.0, feature: s.1, pixel: Vector2::new(s.2, s.3) })
                .collect();
            observations.iter().enumerate().for_each(|(k, observation)| tracks_of_view[observation.view].push((t, k)));
            tracks.push(CandidateTrack {
                color: track.color,
                fits: vec![true; observations.len()],
                observations,
                position: None,
            });
        }
        Solver { options, views, initial_lenses: lenses.clone(), lenses, tracks, tracks_of_view }
    }

    fn registered(&self) -> usize {
        self.views.iter().filter(|view| view.pose.is_some()).count()
    }

    /// Returns the maximum residual of an inlier in a photograph, in pixels.
    fn threshold(&self, view: usize) -> f64 {
        self.options.threshold * (self.lenses[self.views[view].lens].longer_side() / 1600.0).max(1.0)
    }

    /// Returns the known points with the observations that fit, and the track index of each point.
    /// If `all` is false, points with fewer than two observations are included.
    fn reconstruction(&self, all: bool) -> (Reconstruction, Vec<usize>) {
        let mut points = Vec::new();
        let mut tracks = Vec::new();
        for (t, track) in self.tracks.iter().enumerate() {
            let Some(position) = track.position else { continue };
            let fits =
                |(seen, fits): (&Observation, &bool)| (*fits && self.views[seen.view].pose.is_some()).then_some(*seen);
            let list: Vec<Observation> = track.observations.iter().zip(&track.fits).filter_map(fits).collect();
            if !all || list.len() >= 2 {
                points.push(Point { position, color: track.color, track: list });
                tracks.push(t);
            }
        }
        (Reconstruction { lenses: self.lenses.clone(), views: self.views.clone(), points }, tracks)
    }

    /// Alternates between bundle adjustment and dropping outliers, at most `times` times.
    fn adjust_and_filter(&mut self, times: usize) {
        for _ in 0..times {
            self.adjust(false);
            let dropped = self.drop_outliers();
            let added = self.triangulate_tracks();
            if dropped + added == 0 {
                break;
            }
        }
        self.adjust(true);
        self.drop_outliers();
    }

    /// Runs bundle adjustment. If `thoroughly` is false, the adjustment stops once it is accurate
    /// enough to add another photograph.
    fn adjust(&mut self, thoroughly: bool) {
        let (mut all, tracks) = self.reconstruction(false);
        let known = self.registered();
        // Two photographs do not determine a lens.
        let free = known > 2;
        let options = adjust::Options {
            loss: if thoroughly { Loss::Cauchy(CAUCHY * all.noise().max(MIN_NOISE)) } else { Loss::Huber(1.0) },
            focal: free && !self.options.fixed_focal,
            radial: free && !self.options.no_distortion,
            iterations: if thoroughly { 50 } else { 10 },
            tolerance: if thoroughly { 1e-7 } else { 1e-3 },
            ..adjust::Options::default()
        };
        let before = self.lenses.clone();
        adjust(&mut all, &options);
        self.views = all.views;
        self.lenses = all.lenses;
        tracks.iter().zip(&all.points).for_each(|(t, point)| self.tracks[*t].position = Some(point.position));
        for ((lens, before), first) in self.lenses.iter_mut().zip(before).zip(&self.initial_lenses) {
            let sane = (0.2..20.0).contains(&(lens.focal / lens.longer_side())) && lens.distortion[0].abs() < 2.0;
            if !sane {
                *lens = Lens { focal: before.focal.min(20.0 * before.longer_side()), ..*first };
            }
        }
    }

    /// Finds the photograph that observes the most known points.
    fn next(&self, refused: &[bool]) -> Option<usize> {
        let count =
            |view: usize| self.tracks_of_view[view].iter().filter(|(t, _)| self.tracks[*t].position.is_some()).count();
        let open = (0..self.views.len()).filter(|i| self.views[*i].pose.is_none() && !refused[*i]);
        let best = open.map(|i| (i, count(i))).reduce(|a, b| if b.1 > a.1 { b } else { a });
        best.filter(|(_, count)| *count >= self.options.min_points).map(|best| best.0)
    }
}

/// Normalises the orientation, position, and scale of the world. The mean up direction of the
/// photographs becomes y, the median of the points becomes the origin, and the mean distance of the
/// cameras from it becomes 1.
fn normalize_world(reconstruction: &mut Reconstruction) {
    let poses: Vec<_> = reconstruction.views.iter().filter_map(|view| view.pose).collect();
    let up: Vector3<f64> = poses.iter().map(|pose| -pose.rotation.row(1).transpose()).sum();
    let Some(up) = up.try_normalize(1e-9) else { return };
    let forward: Vector3<f64> = poses.iter().map(|pose| pose.rotation.row(2).transpose()).sum();
    let Some(back) = (up * up.dot(&forward) - forward).try_normalize(1e-9) else { return };
    let rotation = Matrix3::from_rows(&[up.cross(&back).transpose(), up.transpose(), back.transpose()]);
    let mut middle = Vector3::zeros();
    for axis in 0..3 {
        let mut values: Vec<f64> = reconstruction.points.iter().map(|point| point.position[axis]).collect();
        values.sort_by(f64::total_cmp);
        middle[axis] = values.get(values.len() / 2).copied().unwrap_or(0.0);
    }
    let distance = poses.iter().map(|pose| (pose.center() - middle).norm()).sum::<f64>() / poses.len() as f64;
    let scale = if distance > 0.0 { 1.0 / distance } else { 1.0 };
    Similarity { scale, rotation, translation: -scale * (rotation * middle) }.apply_to(reconstruction);
}
