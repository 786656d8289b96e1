//! Measures how well pictures match, and selects the pixels to compare.

use durer_scene::math::Vec3;

/// Maximum difference of a channel that is attributed to rounding.
pub(super) const ROUNDING: f32 = 1.2 / 255.0;
/// Difference of a channel above which it counts as visible.
pub(super) const VISIBLE: f32 = 2.5 / 255.0;

/// Maximum number of outliers that are ignored, and minimum number of other pixels that must match.
const MAX_OUTLIERS: usize = 4;
const MIN_PIXELS: usize = 30;

/// Quality of the match between a rendered picture and the test picture, measured where either
/// differs from the reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fit {
    /// Fraction of the squared difference that is explained, from minus infinity to 1.
    pub explained: f64,
    /// Fraction of matching pixels among the pixels where either picture differs from the
    /// reference.
    pub matched: f64,
}

/// Returns the squared difference of two values beyond rounding.
fn excess(a: Vec3, b: Vec3) -> f64 {
    let rest = ((a - b).abs() - ROUNDING).max(Vec3::ZERO);
    f64::from(rest.length_squared())
}

fn differs_visibly(a: Vec3, b: Vec3) -> bool {
    (a - b).abs().max_element() > VISIBLE
}

/// Returns the squared difference of two pictures beyond rounding.
pub(super) fn difference(a: &[Vec3], b: &[Vec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| excess(*a, *b)).sum()
}

/// Counts pixels that differ visibly.
pub(super) fn differing(a: &[Vec3], b: &[Vec3]) -> usize {
    a.iter().zip(b).filter(|(a, b)| differs_visibly(**a, **b)).count()
}

/// Measures how well a rendered picture matches the test picture.
pub(super) fn fit(reference: &[Vec3], test: &[Vec3], rendered: &[Vec3]) -> Fit {
    let (total, rest) = (difference(reference, test), difference(rendered, test));
    let (mut either, mut agree) = (0_usize, 0_usize);
    for ((r, t), m) in reference.iter().zip(test).zip(rendered) {
        if differs_visibly(*r, *t) || differs_visibly(*r, *m) {
            either += 1;
            agree += usize::from(!differs_visibly(*t, *m));
        }
    }
    let explained = if total > 0.0 { 1.0 - rest / total } else { 0.0 };
    let strays = either - agree;
    // If only a few pixels differ, an outlier at an edge would dominate, so outliers are ignored.
    if strays > 0 && strays <= MAX_OUTLIERS.max(reference.len() / 2000) && agree >= MIN_PIXELS.max(8 * strays) {
        let unchanged = |test: &Vec3, rendered: &Vec3| !differs_visibly(*test, *rendered);
        let part = |of: &[Vec3]| -> f64 {
            let all = of.iter().zip(test).zip(rendered).filter(|((_, t), m)| unchanged(t, m));
            all.map(|((a, t), _)| excess(*a, *t)).sum()
        };
        let (total, rest) = (part(reference), part(rendered));
        if total > 0.0 {
            return Fit { explained: explained.max(1.0 - rest / total), matched: agree as f64 / either as f64 };
        }
    }
    Fit { explained, matched: agree as f64 / either.max(1) as f64 }
}

/// Selects at most `most` pixels. Half of them are evenly spread, and half are where the pictures
/// differ, or around these pixels if they are few.
pub(super) fn sampled(width: u32, reference: &[Vec3], test: &[Vec3], most: usize) -> Vec<usize> {
    let all = reference.len();
    if all <= most {
        return (0..all).collect();
    }
    let spread = |list: usize, count: usize| {
        // The selection is stratified by the golden ratio, with one index in each of `count` equal
        // parts.
        (0..count).map(move |i| {
            let part = (i as f64 * 0.618_033_988_749_895).fract();
            (((i as f64 + part) * list as f64 / count as f64) as usize).min(list - 1)
        })
    };
    let mut differ: Vec<usize> = (0..all).filter(|&i| differs_visibly(reference[i], test[i])).collect();
    // Sort by tiles of 8x8 pixels so that subsampling covers all regions.
    differ.sort_by_key(|i| (i / width as usize / 8, i % width as usize / 8));
    let mut chosen: Vec<usize> = spread(all, most / 2).collect();
    match differ.len() {
        few if few <= most / 2 => {
            chosen.extend(around(width as usize, all, &differ, most / 2 - few));
            chosen.extend(differ);
        }
        many => chosen.extend(spread(many, most / 2).map(|i| differ[i])),
    }
    chosen.sort_unstable();
    chosen.dedup();
    chosen
}

/// Returns at most `count` pixels around others, starting with the nearest. There, too large a
/// value of a mistake shows.
fn around(width: usize, all: usize, pixels: &[usize], count: usize) -> Vec<usize> {
    let mut known = vec![false; all];
    pixels.iter().for_each(|&i| known[i] = true);
    let mut found = pixels.to_vec();
    let mut next = 0;
    while next < found.len() && found.len() < pixels.len() + count {
        let i = found[next];
        let beside = [(!i.is_multiple_of(width)).then(|| i - 1), (i % width + 1 < width).then_some(i + 1)];
        for j in beside.into_iter().flatten().chain(i.checked_sub(width)).chain(Some(i + width)) {
            if j < all && !known[j] {
                known[j] = true;
                found.push(j);
            }
        }
        next += 1;
    }
    found.truncate(pixels.len() + count);
    found.split_off(pixels.len())
}
