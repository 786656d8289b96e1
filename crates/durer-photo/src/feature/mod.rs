//! Salient points and what they look like: SIFT.
//!
//! Points are extremes of the difference of two Gaussian blurs, over place and scale; each gets one
//! or two orientations, and a descriptor of the gradients around it, in its own scale and
//! orientation.
//!
//! Sources: Lowe, *Distinctive Image Features from Scale-Invariant Keypoints*, IJCV 60(2), 2004;
//! for the square roots in the descriptor: Arandjelović, Zisserman, *Three Things Everyone Should
//! Know to Improve Object Retrieval*, CVPR 2012.

mod describe;
mod detect;
mod gray;

pub use gray::Gray;

use rayon::prelude::*;

/// Bytes of a descriptor.
pub const LENGTH: usize = 128;

/// A salient point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Feature {
    /// Pixels from the upper left corner.
    pub x: f32,
    /// Pixels from the upper left corner, downwards.
    pub y: f32,
    /// The standard deviation of the blur at which it is salient, in pixels.
    pub scale: f32,
    /// Its orientation in radians, from right to down.
    pub angle: f32,
    /// How strong it is: the difference of the blurs.
    pub strength: f32,
}

/// The strongest features of a picture, with their descriptors, in the order of strength.
pub fn features(gray: &Gray, most: usize) -> Vec<(Feature, [u8; LENGTH])> {
    // Small pictures have more to tell when they are doubled; of large ones there is enough.
    let doubled = gray.width.max(gray.height) <= 1000;
    let octaves = detect::octaves(gray, doubled);
    let mut points = detect::points(&octaves);
    // Strength falls; ties go by place, so that nothing depends on who found what first.
    points.sort_by(|a, b| {
        let keys = |p: &detect::Point| (p.octave, p.level, p.row, p.column);
        b.strength.abs().total_cmp(&a.strength.abs()).then_with(|| keys(a).cmp(&keys(b)))
    });
    points.truncate(most);
    let all: Vec<Vec<_>> = points.par_iter().map(|point| describe::describe(&octaves, point, doubled)).collect();
    let mut all: Vec<_> = all.into_iter().flatten().collect();
    all.truncate(most);
    all
}
