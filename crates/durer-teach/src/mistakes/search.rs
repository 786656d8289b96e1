//! How well pictures agree, and which pixels are looked at.

use durer_scene::math::Vec3;

/// Differences of a channel up to this are rounding.
pub(super) const ROUNDING: f32 = 1.2 / 255.0;
/// Differences of a channel beyond this are seen.
pub(super) const SEEN: f32 = 2.5 / 255.0;

/// So many pixels may be strays, and so many more must agree.
const STRAYS: usize = 4;
const FEWEST: usize = 30;

/// How well a picture agrees with a test picture, where that differs from the reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fit {
    /// The share of the squared difference that is explained, from minus infinity to 1.
    pub explained: f64,
    /// Of the pixels that differ in either, the share that agrees.
    pub matched: f64,
}

/// The difference of two values, without what rounding may do.
fn beyond(a: Vec3, b: Vec3) -> f64 {
    let rest = ((a - b).abs() - ROUNDING).max(Vec3::ZERO);
    f64::from(rest.length_squared())
}

fn seen(a: Vec3, b: Vec3) -> bool {
    (a - b).abs().max_element() > SEEN
}

/// The squared difference of two pictures.
pub(super) fn difference(a: &[Vec3], b: &[Vec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| beyond(*a, *b)).sum()
}

/// How many pixels differ visibly.
pub(super) fn differing(a: &[Vec3], b: &[Vec3]) -> usize {
    a.iter().zip(b).filter(|(a, b)| seen(**a, **b)).count()
}

/// How well a made picture agrees with the test picture.
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
    // Where few pixels differ, a stray one at an edge weighs as much as all of them.
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

/// Pixels of a picture, at most so many: half of them spread evenly, half where the pictures
/// differ.
pub(super) fn sampled(width: u32, reference: &[Vec3], test: &[Vec3], most: usize) -> Vec<usize> {
    let all = reference.len();
    if all <= most {
        return (0..all).collect();
    }
    let spread = |list: usize, count: usize| {
        // One of each of `count` equal parts, at the place that multiples of the golden ratio give.
        (0..count).map(move |i| {
            let part = (i as f64 * 0.618_033_988_749_895).fract();
            (((i as f64 + part) * list as f64 / count as f64) as usize).min(list - 1)
        })
    };
    let mut differ: Vec<usize> = (0..all).filter(|&i| seen(reference[i], test[i])).collect();
    // By squares of the picture, so that neighbours stay together and are not all taken.
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
