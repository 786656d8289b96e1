//! SIFT features, which consist of keypoints and their descriptors.
//!
//! Keypoints are the extrema, over position and scale, of the difference between two Gaussian
//! blurs. Each keypoint gets one or two orientations. It also gets a descriptor of the gradients
//! around it, which is relative to its scale and orientation.
//!
//! Sources: Lowe, *Distinctive Image Features from Scale-Invariant Keypoints*, IJCV 60(2), 2004;
//! for the square roots in the descriptor: Arandjelović, Zisserman, *Three Things Everyone Should
//! Know to Improve Object Retrieval*, CVPR 2012.

mod describe;
mod detect;
mod gray;

pub use gray::GrayImage;

use rayon::prelude::*;

/// Length of a descriptor in bytes.
pub const DESCRIPTOR_LENGTH: usize = 128;

/// Keypoint of a photograph found by SIFT, with its position, scale, and orientation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Feature {
    /// Horizontal position in pixels, measured from the left.
    pub x: f32,
    /// Vertical position in pixels, measured from the top.
    pub y: f32,
    /// Scale, which is the standard deviation in pixels of the blur at which the difference is
    /// extremal.
    pub scale: f32,
    /// Orientation in radians, measured from x (right) towards y (down).
    pub angle: f32,
    /// Strength of the feature, which is the difference between the two blurs at the extremum. It
    /// can be positive or negative.
    pub strength: f32,
}

/// Finds at most `most` features of an image and their descriptors, starting with the strongest.
pub fn features(gray: &GrayImage, most: usize) -> Vec<(Feature, [u8; DESCRIPTOR_LENGTH])> {
    // Small images yield more features when they are doubled. Large images have enough features.
    let doubled = gray.width.max(gray.height) <= 1000;
    let octaves = detect::octaves(gray, doubled);
    let mut points = detect::points(&octaves);
    // Sort by decreasing strength and then by position, so that the order does not depend on
    // threads.
    points.sort_by(|a, b| {
        let keys = |p: &detect::Extremum| (p.octave, p.level, p.row, p.column);
        b.strength.abs().total_cmp(&a.strength.abs()).then_with(|| keys(a).cmp(&keys(b)))
    });
    points.truncate(most);
    let all: Vec<Vec<_>> = points.par_iter().map(|point| describe::describe(&octaves, point, doubled)).collect();
    let mut all: Vec<_> = all.into_iter().flatten().collect();
    all.truncate(most);
    all
}
