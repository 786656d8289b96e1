//! Matches features between photographs, and joins the matches of each scene point into a track.

mod pairs;
mod tracks;

use crate::feature::{Feature, features};
use crate::photo::Photo;
use crate::{Error, Lens};
use nalgebra::Vector2;
pub(crate) use pairs::is_chance;
use pairs::{Descriptors, match_descriptors, verify_matches};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Options of feature detection and matching.
#[derive(Debug, Clone)]
pub struct Options {
    /// Maximum number of features in a photograph.
    pub features: usize,
    /// Maximum length in pixels of the longer side of a photograph. Larger photographs are reduced.
    pub max_side: u32,
    /// Maximum ratio of the distance to the nearest descriptor to the distance to the second
    /// nearest.
    pub ratio: f64,
    /// Maximum distance of a feature from its epipolar line, in pixels of the reduced photograph.
    pub threshold: f64,
    /// Minimum number of matches between two photographs that agree with one fundamental matrix.
    pub min_matches: usize,
    /// Horizontal field of view in degrees, used for photographs without EXIF data.
    pub field_of_view: f64,
    /// True if focal lengths in EXIF data are ignored.
    pub ignore_exif: bool,
    /// Seed of the random numbers.
    pub seed: u64,
}

impl Default for Options {
    fn default() -> Self {
        let (features, side, ratio, threshold) = (6000, 1600, 0.8, 2.0);
        Options {
            features,
            max_side: side,
            ratio,
            threshold,
            min_matches: 16,
            field_of_view: 45.0,
            ignore_exif: false,
            seed: 0,
        }
    }
}

/// Photograph in the output of matching, with its name, size, initial focal length, and number of
/// features.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MatchedPhoto {
    /// File name.
    pub name: String,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Initial focal length in pixels.
    pub focal: f64,
    /// Description of the source of the focal length.
    #[serde(rename = "focal_from")]
    pub focal_source: String,
    /// Index of the lens. Photographs with the same camera, size, and focal length share a lens.
    pub lens: usize,
    /// Number of features.
    pub features: usize,
}

/// Pair of photographs that show the same part of the scene, with statistics of their matches.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PhotoPair {
    /// Indices of the two photographs.
    pub pictures: [usize; 2],
    /// Number of pairs of features with similar descriptors.
    #[serde(rename = "alike")]
    pub candidates: usize,
    /// Number of these pairs that are consistent with one fundamental matrix.
    pub matches: usize,
    /// Fraction of the matches that a single homography explains.
    #[serde(rename = "planar")]
    pub planar_fraction: f64,
    /// Median distance in pixels between the positions of a feature in both photographs.
    #[serde(rename = "moved")]
    pub median_shift: f64,
}

/// Observation in a track: index of the photograph, index of the feature, and x and y in pixels
/// from the upper left corner.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct TrackObservation(pub usize, pub usize, pub f64, pub f64);

/// Features in several photographs that show the same scene point, whose position is not yet known.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Track {
    /// Mean colour of the features.
    pub color: [u8; 3],
    /// Observations.
    #[serde(rename = "seen")]
    pub observations: Vec<TrackObservation>,
}

/// Result of matching, which is the input of [`solve`](crate::solve). It contains photographs,
/// pairs of photographs that match, and tracks.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Matches {
    /// Identifier of the file format.
    pub format: String,
    /// Photographs.
    pub pictures: Vec<MatchedPhoto>,
    /// Pairs of photographs that match.
    pub links: Vec<PhotoPair>,
    /// Tracks of scene points.
    pub tracks: Vec<Track>,
}

/// Prefix of [`MatchedPhoto::focal_source`] that marks a guessed focal length.
pub const GUESS: &str = "a guess";

/// Value of [`Matches::format`].
pub const FORMAT: &str = "durer matches 1";

/// Features of one photograph with their descriptors and colours, computed by [`describe`] and
/// matched by [`match_all`].
pub struct ImageFeatures {
    picture: MatchedPhoto,
    camera: String,
    features: Vec<Feature>,
    colors: Vec<[u8; 3]>,
    descriptors: Descriptors,
    scale: f64,
}

/// Detects the features of a photograph. The pixels are not needed afterwards.
pub fn describe(photo: &Photo, options: &Options) -> ImageFeatures {
    let (gray, scale) = photo.gray(options.max_side);
    let mut detected = features(&gray, options.features);
    for (feature, _) in &mut detected {
        (feature.x, feature.y) = (feature.x * scale[0] as f32, feature.y * scale[1] as f32);
    }
    let [width, height] = photo.size();
    let guess = f64::from(width) / (2.0 * libm::tan(options.field_of_view.to_radians() / 2.0));
    let guessed = || (guess, format!("{GUESS}: {} degrees across", options.field_of_view));
    let (focal, focal_source) = photo.exif.focal.clone().filter(|_| !options.ignore_exif).unwrap_or_else(guessed);
    let colors = detected.iter().map(|(f, _)| photo.color(f64::from(f.x), f64::from(f.y))).collect();
    let (name, size) = (photo.name.clone(), [width, height]);
    ImageFeatures {
        picture: MatchedPhoto { name, size, focal, focal_source, lens: 0, features: detected.len() },
        camera: photo.exif.camera.clone(),
        descriptors: Descriptors::new(detected.iter().map(|(_, descriptor)| descriptor)),
        features: detected.into_iter().map(|(feature, _)| feature).collect(),
        colors,
        scale: scale[0],
    }
}

/// Matches all pairs of photographs. The function `progress` receives the finished fraction of the
/// work, from 0 to 1.
///
/// # Errors
///
/// Returns an error if there are fewer than two photographs, or if no two of them show the same
/// scene from different positions.
pub fn match_all(
    mut photos: Vec<ImageFeatures>,
    options: &Options,
    progress: &(dyn Fn(f64) + Sync),
) -> Result<Matches, Error> {
    if photos.len() < 2 {
        return Err(Error::new("at least two photographs are needed: a single one determines no depth"));
    }
    let keys: Vec<_> =
        photos.iter().map(|photo| (photo.camera.clone(), photo.picture.size, photo.picture.focal.to_bits())).collect();
    let mut lens_keys = Vec::new();
    for (photo, key) in photos.iter_mut().zip(keys) {
        photo.picture.lens = lens_keys.iter().position(|other| *other == key).unwrap_or_else(|| {
            lens_keys.push(key);
            lens_keys.len() - 1
        });
    }
    let count = photos.len();
    let pair_count = count * (count - 1) / 2;
    let done = std::sync::atomic::AtomicUsize::new(0);
    let one = |i: usize, j: usize| {
        let (a, b) = (&photos[i], &photos[j]);
        let candidates = match_descriptors(&a.descriptors, &b.descriptors, options.ratio);
        let places: Vec<_> = candidates.iter().map(|(m, n)| (place(&a.features[*m]), place(&b.features[*n]))).collect();
        let threshold = options.threshold * a.scale.max(b.scale);
        let seed = options.seed ^ ((i as u64) << 32 | j as u64);
        let geometry = verify_matches(&places, threshold, options.min_matches, seed);
        let now = 1 + done.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        progress(now as f64 / pair_count as f64);
        let geometry = geometry?;
        let matches: Vec<_> = geometry.inliers.iter().map(|k| candidates[*k]).collect();
        let link = PhotoPair {
            pictures: [i, j],
            candidates: candidates.len(),
            matches: matches.len(),
            planar_fraction: geometry.planar_fraction,
            median_shift: geometry.median_shift,
        };
        Some((link, matches))
    };
    // Most pairs of a large collection have no matches, so no list of all pairs is kept.
    let of_photo = |i: usize| (i + 1..count).into_par_iter().filter_map(move |j| one(i, j));
    let matched: Vec<_> = (0..count).into_par_iter().flat_map(of_photo).collect();
    if matched.is_empty() {
        return Err(Error::new("no two photographs show the same objects: too few matches agree on one geometry"));
    }
    if matched.iter().all(|(link, _)| link.median_shift < 0.5) {
        return Err(Error::new("the photographs are the same picture: without parallax, depth is undetermined"));
    }
    let counts: Vec<usize> = photos.iter().map(|photo| photo.features.len()).collect();
    let connected = matched.iter().flat_map(|(link, matches)| {
        let [i, j] = link.pictures;
        matches.iter().map(move |(m, n)| ((i, *m), (j, *n)))
    });
    let track = |list: Vec<tracks::FeatureId>| {
        let mean = |channel: usize| {
            let sum: u32 = list.iter().map(|(i, m)| u32::from(photos[*i].colors[*m][channel])).sum();
            (sum / list.len() as u32) as u8
        };
        let color = [mean(0), mean(1), mean(2)];
        let sighting = |&(i, m): &tracks::FeatureId| {
            let p = place(&photos[i].features[m]);
            TrackObservation(i, m, p.x, p.y)
        };
        Track { color, observations: list.iter().map(sighting).collect() }
    };
    let tracks = tracks::build_tracks(&counts, connected).into_iter().map(track).collect();
    let links = matched.iter().map(|(link, _)| link.clone()).collect();
    let pictures = photos.into_iter().map(|photo| photo.picture).collect();
    Ok(Matches { format: FORMAT.into(), pictures, links, tracks })
}

fn place(feature: &Feature) -> Vector2<f64> {
    Vector2::new(f64::from(feature.x), f64::from(feature.y))
}

impl Matches {
    /// Returns the initial lenses, based on the focal lengths of the photographs.
    pub fn lenses(&self) -> Vec<Lens> {
        let first = |lens: usize| self.pictures.iter().find(|picture| picture.lens == lens);
        (0..self.pictures.len()).map_while(first).map(|picture| Lens::new(picture.size, picture.focal)).collect()
    }

    /// Reads the output of [`Matches::to_json`].
    pub fn from_json(file: &str, json: &[u8]) -> Result<Self, Error> {
        let matches: Matches = serde_json::from_slice(json).map_err(|error| {
            Error::at(file, (error.line(), error.column()), format!("invalid file of `durer photo match`: {error}"))
        })?;
        let fail = |why: String| Err(Error::in_file(file, why));
        if matches.format != FORMAT {
            return fail(format!("the file's format is `{}`, not `{FORMAT}`", matches.format));
        }
        let count = matches.lenses().len();
        for (i, picture) in matches.pictures.iter().enumerate() {
            let fine = picture.focal.is_finite() && picture.focal > 0.0 && picture.size.iter().all(|side| *side > 0);
            if !fine || picture.lens >= count {
                return fail(format!("photograph {i} has no valid size, focal length or lens"));
            }
        }
        for (i, track) in matches.tracks.iter().enumerate() {
            let order = track.observations.windows(2).all(|pair| pair[0].0 < pair[1].0);
            let fine = |s: &TrackObservation| s.0 < matches.pictures.len() && s.2.is_finite() && s.3.is_finite();
            if !order || !track.observations.iter().all(fine) {
                return fail(format!("track {i} names photographs that do not exist, occur twice or are out of order"));
            }
        }
        if matches.links.iter().any(|link| link.pictures.iter().any(|i| *i >= matches.pictures.len())) {
            return fail("a link names photographs that do not exist".into());
        }
        Ok(matches)
    }

    /// Writes the matches as JSON, with one item per line.
    pub fn to_json(&self) -> String {
        let rows = |values: Vec<String>| values.join(",\n");
        let row = |value: Result<String, serde_json::Error>| value.unwrap_or_default();
        let pictures = self.pictures.iter().map(|picture| row(serde_json::to_string(picture))).collect();
        let links = self.links.iter().map(|link| row(serde_json::to_string(link))).collect();
        let tracks = self.tracks.iter().map(|track| row(serde_json::to_string(track))).collect();
        format!(
            "{{\"format\": \"{FORMAT}\",\n\"pictures\": [\n{}],\n\"links\": [\n{}],\n\"tracks\": [\n{}]}}\n",
            rows(pictures),
            rows(links),
            rows(tracks)
        )
    }
}
