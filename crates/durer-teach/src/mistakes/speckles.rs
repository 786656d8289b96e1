//! Detects acne, which consists of specks where rays hit the surface that they start from. It
//! depends on rounding.

use super::fit::VISIBLE;
use durer_scene::math::Vec3;

/// Minimum fraction of the specks that must be as dark as they would be in shadow.
const MIN_MATCHING: f64 = 0.94;
/// Minimum fraction of neighbouring pairs in which only one pixel is a speck. It consists of a
/// constant and a term for the borders of a few regions with the same number of pixels. For a
/// single disc, the fraction is 2.3 / √count.
const MIN_ISOLATED: f64 = 0.06;
const BORDER_TERM: f64 = 4.0;

/// Returns the indices of the differing pixels if the pixels are isolated specks rather than
/// regions.
pub(super) fn isolated_pixels(reference: &[Vec3], test: &[Vec3], width: usize) -> Option<Vec<usize>> {
    let differs = |i: usize| (reference[i] - test[i]).abs().max_element() > VISIBLE;
    let all: Vec<bool> = (0..reference.len()).map(differs).collect();
    let differ: Vec<usize> = (0..all.len()).filter(|i| all[*i]).collect();
    // Regions have an interior, whereas specks consist mostly of borders.
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
    let speckled = broken as f64 > (MIN_ISOLATED + BORDER_TERM / (differ.len().max(1) as f64).sqrt()) * pairs as f64;
    (differ.len() * 500 > reference.len() && speckled).then_some(differ)
}

/// Returns the differing pixels that are not as dark as in the shadow of some lights. `shadowed`
/// contains the values of all these pixels in pictures with one or more lights blocked.
pub(super) fn unlike(test: &[Vec3], differ: &[usize], shadowed: &[Vec<Vec3>]) -> Vec<usize> {
    let alike =
        |(at, &i): (usize, &usize)| shadowed.iter().any(|dark| (dark[at] - test[i]).abs().max_element() <= VISIBLE);
    differ.iter().enumerate().filter(|of| !alike(*of)).map(|(_, &i)| i).collect()
}

/// Returns the fraction of the differing pixels that are as dark as in shadow, if it is at least
/// `MIN_MATCHING`. `unlike` contains the others.
pub(super) fn share(differ: &[usize], unlike: &[usize]) -> Option<f64> {
    let share = (differ.len() - unlike.len()) as f64 / differ.len().max(1) as f64;
    (share >= MIN_MATCHING).then_some(share)
}
