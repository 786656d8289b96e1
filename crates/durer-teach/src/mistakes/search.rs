//! Agreement of pictures, and selection of pixels.

use durer_scene::math::Vec3;

/// Largest difference of a channel that counts as rounding.
pub(super) const ROUNDING: f32 = 1.2 / 255.0;
/// Difference of a channel above which it is visible.
pub(super) const SEEN: f32 = 2.5 / 255.0;

/// Number of outliers that are ignored, and minimum number of pixels that must agree then.
const STRAYS: usize = 4;
const FEWEST: usize = 30;

/// Agreement of a rendered picture with the test picture where that differs from the reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fit {
    /// Share of the squared difference that is explained, from minus infinity to 1.
    pub explained: f64,
    /// Share of the pixels differing in either picture that agree.
    pub matched: f64,
}

/// Returns the squared difference of two values beyond rounding.
fn beyond(a: Vec3, b: Vec3) -> f64 {
    let rest = ((a - b).abs() - ROUNDING).max(Vec3::ZERO);
    f64::from(rest.length_squared())
}

fn seen(a: Vec3, b: Vec3) -> bool {
    (a - b).abs().max_element() > SEEN
}

/// Returns the squared difference of two pictures.
pub(super) fn difference(a: &[Vec3], b: &[Vec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| beyond(*a, *b)).sum()
}

/// Counts pixels that differ visibly.
pub(super) fn differing(a: &[Vec3], b: &[Vec3]) -> usize {
    a.iter().zip(b).filter(|(a, b)| seen(**a, **b)).count()
}

/// Measures the agreement of a rendered picture with the test picture.
pub(super) fn fit(reference: &[Vec3], test: &[Vec3], made: &[Vec3]) -> Fit {
    let (total, rest) = (difference(reference, test), difference(made, test));
    let (mut either, mut agree) = (0_usize, 0_usize);
    for ((r, t), m) in reference.iter().zip(test).zip(made) {
        if seen(*r, *t) || seen(*r, *m) {
            either += 1;
            agree += usize::from(!seen(*t, *m));
        }
    }
    let explained = if total > 0.0 { 1.0 - rest / total } else { 0.0 };
    let strays = either - agree;
    // If few pixels differ, a single outlier at an edge would dominate.
    if strays > 0 && strays <= STRAYS.max(reference.len() / 2000) && agree >= FEWEST.max(8 * strays) {
        let kept = |test: &Vec3, made: &Vec3| !seen(*test, *made);
        let part = |of: &[Vec3]| -> f64 {
            let all = of.iter().zip(test).zip(made).filter(|((_, t), m)| kept(t, m));
            all.map(|((a, t), _)| beyond(*a, *t)).sum()
        };
        let (total, rest) = (part(reference), part(made));
        if total > 0.0 {
            return Fit { explained: explained.max(1.0 - rest / total), matched: agree as f64 / either as f64 };
        }
    }
    Fit { explained, matched: agree as f64 / either.max(1) as f64 }
}

/// Selects at most `most` pixels: half spread evenly, half where the pictures differ.
pub(super) fn sampled(width: u32, reference: &[Vec3], test: &[Vec3], most: usize) -> Vec<usize> {
    let all = reference.len();
    if all <= most {
        return (0..all).collect();
    }
    let spread = |list: usize, count: usize| {
        // Stratified by the golden ratio: one in each of `count` equal parts.
        (0..count).map(move |i| {
            let part = (i as f64 * 0.618_033_988_749_895).fract();
            (((i as f64 + part) * list as f64 / count as f64) as usize).min(list - 1)
        })
    };
    let mut differ: Vec<usize> = (0..all).filter(|&i| seen(reference[i], test[i])).collect();
    // Sort by tiles of 8x8 pixels, so that neighbours are adjacent and subsampled.
    differ.sort_by_key(|i| (i / width as usize / 8, i % width as usize / 8));
    let mut chosen: Vec<usize> = spread(all, most / 2).collect();
    match differ.len() {
        few if few <= most / 2 => chosen.extend(differ),
        many => chosen.extend(spread(many, most / 2).map(|i| differ[i])),
    }
    chosen.sort_unstable();
    chosen.dedup();
    chosen
}
