//! Acne: rays that hit the surface which they leave, at places that rounding decides.

use super::search::SEEN;
use crate::math::Vec3;

/// How many of the speckles must be of the kind.
const MOST: f64 = 0.97;
/// Of neighbours where there are speckles, so many must be without, at least; and as many more as there are at the border of
/// some regions of so many pixels: 2.3 / √count for one disc.
const BROKEN: f64 = 0.06;
const BORDERS: f64 = 4.0;

/// Whether a picture shows what a reference shows, but for pixels that are as dark as in the full shadow of some lights; not
/// whole regions of them, but speckles. `shadowed` are the pictures in which one or more lights are off, `size` the picture's.
///
/// Gives the share of the pixels that differ which are of this kind.
pub(super) fn explained(reference: &[Vec3], test: &[Vec3], shadowed: &[Vec<Vec3>], width: usize) -> Option<f64> {
    let differs = |i: usize| (reference[i] - test[i]).abs().max_element() > SEEN;
    let all: Vec<bool> = (0..reference.len()).map(differs).collect();
    let count = all.iter().filter(|differs| **differs).count();
    let alike = |i: &usize| shadowed.iter().any(|dark| (dark[*i] - test[*i]).abs().max_element() <= SEEN);
    let of_kind = (0..reference.len()).filter(|i| all[*i]).filter(alike).count();
    // A region has a border; speckles are nothing but borders.
    let (mut pairs, mut broken) = (0_usize, 0_usize);
    for i in 0..reference.len() {
        let right = (i + 1) % width != 0 && i + 1 < all.len();
        for j in right.then_some(i + 1).into_iter().chain((i + width < all.len()).then_some(i + width)) {
            let smooth = (reference[i] - reference[j]).abs().max_element() < 0.1;
            if (all[i] || all[j]) && smooth {
                pairs += 1;
                broken += usize::from(all[i] != all[j]);
            }
        }
    }
    let share = of_kind as f64 / count.max(1) as f64;
    let speckled = broken as f64 > (BROKEN + BORDERS / (count.max(1) as f64).sqrt()) * pairs as f64;
    (count * 500 > reference.len() && share >= MOST && speckled).then_some(share)
}
