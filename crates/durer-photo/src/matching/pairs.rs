//! Matches the features of two photographs by their descriptors, and verifies the matches
//! geometrically.

use crate::feature::DESCRIPTOR_LENGTH;
use crate::geometry::fundamental::{Correspondence, FundamentalProblem};
use crate::geometry::homography::{HomographyProblem, map_pixel};
use crate::geometry::ransac::{RansacOptions, ransac};
use nalgebra::{Matrix3, Vector2};

/// SIFT descriptors of all features of one photograph. They are stored as 16-bit integers with
/// their squared lengths, so that distances can be computed quickly.
pub struct Descriptors {
    values: Vec<[i16; DESCRIPTOR_LENGTH]>,
    squares: Vec<i32>,
}

impl Descriptors {
    /// Converts the descriptors of all features of a photograph.
    pub fn new<'d>(all: impl Iterator<Item = &'d [u8; DESCRIPTOR_LENGTH]>) -> Self {
        let values: Vec<[i16; DESCRIPTOR_LENGTH]> = all.map(|descriptor| descriptor.map(i16::from)).collect();
        let squares = values.iter().map(|v| dot(v, v)).collect();
        Descriptors { values, squares }
    }
}

/// Returns the dot product of two descriptors. The sum of 128 products of bytes cannot overflow,
/// and wrapping arithmetic lets the compiler vectorise the loop. Integer arithmetic gives the same
/// result on all processors.
fn dot(a: &[i16; DESCRIPTOR_LENGTH], b: &[i16; DESCRIPTOR_LENGTH]) -> i32 {
    a.iter().zip(b).fold(0, |sum, (a, b)| sum.wrapping_add(i32::from(*a).wrapping_mul(i32::from(*b))))
}

/// Returns pairs of features that are each other's nearest neighbours. The distance of each pair is
/// less than `ratio` times the distance to the second nearest neighbour (Lowe, section 7.1).
pub fn match_descriptors(a: &Descriptors, b: &Descriptors, ratio: f64) -> Vec<(usize, usize)> {
    let mut back = vec![(i32::MAX, usize::MAX); b.values.len()];
    let mut forth = Vec::with_capacity(a.values.len());
    for (i, descriptor) in a.values.iter().enumerate() {
        let (mut best, mut second, mut at) = (i32::MAX, i32::MAX, usize::MAX);
        for (j, other) in b.values.iter().enumerate() {
            let distance = a.squares[i] + b.squares[j] - 2 * dot(descriptor, other);
            if distance < best {
                (second, best, at) = (best, distance, j);
            } else if distance < second {
                second = distance;
            }
            if distance < back[j].0 {
                back[j] = (distance, i);
            }
        }
        forth.push((best, second, at));
    }
    let clear = |(i, (best, second, at)): (usize, (i32, i32, usize))| {
        let nearer = f64::from(best) < ratio * ratio * f64::from(second);
        (nearer && back[at].1 == i).then_some((i, at))
    };
    forth.into_iter().enumerate().filter(|(_, row)| row.2 != usize::MAX).filter_map(clear).collect()
}

/// Result of verifying the matches of two photographs, with the inliers of a fundamental matrix and
/// statistics about them.
pub struct VerifiedMatches {
    /// Indices of the matches that agree with the fundamental matrix.
    pub inliers: Vec<usize>,
    /// Fraction of the inliers that a single homography explains. If it is near 1, the scene is
    /// flat or the camera only rotated.
    pub planar_fraction: f64,
    /// Median distance in pixels between the positions of a match in both photographs.
    pub median_shift: f64,
}

/// Returns true if `agree` out of `all` matches can be consistent with a geometry by chance. A few
/// percent of false matches always lie near their epipolar lines.
pub fn is_chance(agree: usize, all: usize) -> bool {
    agree * 5 < all
}

/// Finds the matches that are consistent with one fundamental matrix. Returns `None` if there are
/// fewer than `least`, or so few that they could be consistent by chance.
pub fn verify_matches(places: &[Correspondence], threshold: f64, least: usize, seed: u64) -> Option<VerifiedMatches> {
    let search = RansacOptions { threshold, samples: 5000, seed };
    let (_, inliers) = ransac(&FundamentalProblem(places), &search)?;
    if inliers.len() < least || is_chance(inliers.len(), places.len()) {
        return None;
    }
    let pairs: Vec<Correspondence> = inliers.iter().map(|i| places[*i]).collect();
    let plane = ransac(&HomographyProblem(&pairs), &RansacOptions { samples: 500, ..search });
    let near = |h: &Matrix3<f64>| pairs.iter().filter(|(a, b)| (map_pixel(h, a) - b).norm() < threshold).count();
    let planar_fraction = plane.map_or(0.0, |(h, _)| near(&h) as f64 / pairs.len() as f64);
    let mut distances: Vec<f64> = pairs.iter().map(|(a, b): &(Vector2<f64>, Vector2<f64>)| (a - b).norm()).collect();
    distances.sort_by(f64::total_cmp);
    let median_shift = distances[distances.len() / 2];
    Some(VerifiedMatches { inliers, planar_fraction, median_shift })
}
