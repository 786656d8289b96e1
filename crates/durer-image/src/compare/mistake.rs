//! Detection of common mistakes in rendered pictures. Each mistake is applied to the reference, and
//! the one that makes the reference most similar to the picture is taken as the explanation.

mod flow;
mod parts;
mod rule;
mod sample;
mod shift;
mod tone;
mod words;

#[cfg(test)]
mod tests;

use super::picture::{Pair, Scale};
use durer_bvh::math::Vec3;
use rayon::prelude::*;
use rule::{ORIENTATIONS, Rule};
use sample::{Sample, View};

/// A common mistake, such as mirroring, that explains a difference between two pictures.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// Keyword of the mistake, such as `mirrored`, `shifted`, or `factor`.
    pub kind: &'static str,
    /// Description of the mistake, without a full stop, such as "the picture is mirrored left to
    /// right".
    pub description: String,
    /// Share of the squared difference, from 0 to 1, that is explained by this finding and the ones
    /// before it.
    ///
    /// The share is measured on all pixels of small pictures, and on 100 000 pixels of larger ones.
    pub explained: f64,
}

/// Minimum share of the difference that a mistake in a part of the picture must explain.
const MIN_EXPLAINED_PART: f64 = 0.9;
/// Unexplained share of the difference above which findings are dropped, because a wrong
/// explanation is worse than none.
const MAX_LEFT: f64 = 0.05;
/// Unexplained share above which findings with fitted parameters are dropped.
const MAX_LEFT_FITTED: f64 = 0.02;
/// Minimum number of differing pixels that are needed to recognise a pattern.
const MIN_DIFFERING_PIXELS: usize = 12;
/// Minimum share of the remaining difference that a finding must explain.
const MAX_REST: f64 = 0.5;
/// Maximum number of mistakes that are combined in one explanation.
const MAX_MISTAKES: usize = 3;

/// Maximum difference that may remain, relative to the variance of the picture. Without this limit,
/// a nearly uniform picture could be explained from any reference that is shifted and darkened.
const MAX_CONTRAST: f64 = 0.1;
/// Minimum share of the pixels that the rules must reproduce; below it, the finding adds "something
/// more is different".
const MIN_MATCHED: f64 = 0.97;
/// Smallest difference that counts as visible, for values from 0 to 1.
const VISIBLE: f32 = 2.5 / 255.0;
/// Half of one step of 8-bit values.
const HALF_STEP: f32 = 0.5 / 255.0;

/// Finds the mistakes that explain the difference between two pictures best. The list is empty if
/// no mistake explains half of the difference. If a single mistake explains nearly all of it but
/// other pixels also differ, the description of the mistake says so.
pub(super) fn explain(pair: &Pair) -> Vec<Finding> {
    let test = View::of(pair, &pair.test);
    let reference = View::of(pair, &pair.reference);
    if let Some(finding) = parts::blank(&reference, &test) {
        return vec![finding];
    }
    let samples = sample::samples(&reference, &test);
    let (rules, mut findings) = chain(pair, &test, difference(&samples));
    let fit = Fit::of(pair, &rules, &test, &samples);
    let fitted = rules.iter().any(Rule::is_fitted);
    let most = if fitted { MAX_LEFT_FITTED } else { MAX_LEFT };
    let close = !rules.is_empty() && fit.remaining <= most && fit.contrast <= MAX_CONTRAST;
    if close && fit.matched >= MIN_MATCHED {
        return findings;
    }
    let edges = edges_beside_gamma(pair, &rules, &reference, &test);
    if let Some(edges) = edges.filter(|edges| fit.remaining * (1.0 - edges.explained) <= MAX_LEFT_FITTED) {
        findings.push(Finding { explained: 1.0 - fit.remaining * (1.0 - edges.explained), ..edges });
        return findings;
    }
    let differing = samples.iter().filter(|s| (s.test - s.reference).abs().max_element() > 1.5 / 255.0).count();
    let part = (differing >= MIN_DIFFERING_PIXELS).then(|| parts::finding(&reference, &test, &samples)).flatten();
    match part {
        Some(finding) if finding.explained > MIN_EXPLAINED_PART => vec![finding],
        _ if close && findings.len() == 1 => {
            findings[0].description = format!("nearly: {}, but something more is different", findings[0].description);
            findings
        }
        _ => Vec::new(),
    }
}

/// Returns the finding that the rest of the difference is at edges if the only rule is a wrong
/// gamma. The gamma is removed from the picture, because edges are averaged before it is applied.
fn edges_beside_gamma(pair: &Pair, rules: &[Rule], reference: &View, test: &View) -> Option<Finding> {
    let undo = match rules {
        [Rule::GammaTwice] => Rule::GammaMissing,
        [Rule::GammaMissing] => Rule::GammaTwice,
        _ => return None,
    };
    let pixels = undo.apply(test);
    let view = View::of(pair, &pixels);
    parts::remaining_edges(reference, &view, &sample::samples(reference, &view))
}

/// Finds a sequence of rules, each of which explains most of the difference that the previous rules
/// leave.
fn chain(pair: &Pair, test: &View, total: f64) -> (Vec<Rule>, Vec<Finding>) {
    let (mut rules, mut findings) = (Vec::new(), Vec::new());
    let mut reference = pair.reference.clone();
    for _ in 0..MAX_MISTAKES {
        let view = View::of(pair, &reference);
        let samples = sample::samples(&view, test);
        let Some((rule, rest)) = best_rule(&view, test, &samples) else { break };
        // A rule that explains less than half of the remaining difference would be a mere guess.
        if rest > MAX_REST * difference(&samples) {
            break;
        }
        let remaining = rest / total;
        findings.push(Finding { kind: rule.kind(), description: words::of(&rule), explained: 1.0 - remaining });
        rules.push(rule);
        if remaining < 0.02 {
            break;
        }
        reference = rule.apply(&view);
    }
    (rules, findings)
}

/// Measures of how well a sequence of rules, applied to the reference, reproduces a picture. Pixels
/// that a shift moves into the picture from outside are ignored.
struct Fit {
    /// Share of the squared difference that remains.
    remaining: f64,
    /// Squared difference that remains, relative to the variance of the picture.
    contrast: f64,
    /// Share of pixels that the rules reproduce correctly (except for rounding), among those pixels
    /// of the picture that visibly differ from the reproduction or from the reference.
    matched: f64,
}

impl Fit {
    fn of(pair: &Pair, rules: &[Rule], test: &View, samples: &[Sample]) -> Fit {
        // Rounding may have changed the values of the reference by up to half a step.
        let with_offset = |offset: f32| {
            let start: Vec<Vec3> = pair.reference.iter().map(|value| pair.scale.clamp(*value + offset)).collect();
            rules.iter().fold(start, |pixels, rule| rule.apply(&View::of(pair, &pixels)))
        };
        let step = if pair.scale == Scale::Display { HALF_STEP } else { 0.0 };
        let [low, exact, high] = [-step, 0.0, step].map(with_offset);
        let known: Vec<&Sample> =
            samples.iter().filter(|s| rules.iter().all(|rule| rule.determines(test, s.x, s.y))).collect();
        let count = known.len().max(1) as f64;
        let mean = known.iter().map(|s| s.test).sum::<Vec3>() / count as f32;
        let (mut total, mut rest, mut spread, mut either, mut agree) = (0.0, 0.0, 0.0, 0_usize, 0_usize);
        for s in known {
            let at = s.y as usize * test.width + s.x as usize;
            total += f64::from((s.test - s.reference).length_squared());
            rest += f64::from((s.test - exact[at]).length_squared());
            spread += f64::from((s.test - mean).length_squared());
            let is_visible = |a: Vec3, b: Vec3| (a - b).abs().max_element() > pair.scale.visible(b, VISIBLE);
            if is_visible(s.reference, s.test) || is_visible(exact[at], s.test) {
                let slack = Vec3::splat(pair.scale.visible(s.test, VISIBLE));
                let (least, most) = (low[at].min(high[at]).min(exact[at]), low[at].max(high[at]).max(exact[at]));
                either += 1;
                agree += usize::from(s.test.cmpge(least - slack).all() && s.test.cmple(most + slack).all());
            }
        }
        let share = |part: f64, of: f64| if of > 0.0 { part / of } else { 1.0 };
        Fit {
            remaining: share(rest, total),
            contrast: share(rest, spread),
            matched: share(agree as f64, either as f64),
        }
    }
}

/// Returns the sum of squared differences over all samples.
fn difference(samples: &[Sample]) -> f64 {
    samples.iter().map(|s| f64::from((s.test - s.reference).length_squared())).sum()
}

/// Finds the rule that leaves the smallest difference, and returns it with that difference. If
/// several rules are nearly equally good, the simplest of them is chosen.
fn best_rule(reference: &View, test: &View, samples: &[Sample]) -> Option<(Rule, f64)> {
    let rules = candidates(reference, test, samples);
    let residual =
        |rule: &Rule| -> f64 { samples.iter().map(|s| f64::from(rule.residual(reference, s).length_squared())).sum() };
    let rests: Vec<f64> = rules.par_iter().map(residual).collect();
    let least = rests.iter().copied().fold(f64::INFINITY, f64::min);
    // The candidates are sorted by their number of parameters, in ascending order.
    let near = 1.25 * least + 0.01 * difference(samples);
    rules.into_iter().zip(rests).find(|(_, rest)| *rest <= near)
}

/// Returns candidate rules with fitted parameters, sorted by their number of parameters in
/// ascending order.
fn candidates(reference: &View, test: &View, samples: &[Sample]) -> Vec<Rule> {
    let square = reference.width == reference.height;
    let mut rules: Vec<Rule> =
        ORIENTATIONS.iter().filter(|t| square || !t.exchanges()).map(|&t| Rule::Reoriented(t)).collect();
    rules.extend([[2, 1, 0], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1]].map(Rule::Channels));
    rules.extend([
        Rule::Grey,
        Rule::Inverted([true; 3]),
        Rule::InvertedExceptBlack,
        Rule::GammaTwice,
        Rule::GammaMissing,
    ]);
    rules.extend((1..7).map(|bits| Rule::Inverted(std::array::from_fn(|c| bits >> c & 1 == 1))));
    rules.extend(shift::shift(reference, test).map(|(dx, dy)| Rule::Shifted(dx, dy)));
    rules.push(Rule::Blurred);
    rules.extend(tone::fitted(reference.scale, samples));
    rules
}

/// Rounds a colour to multiples of 1/255 for use in messages.
fn bytes(color: Vec3) -> [i32; 3] {
    color.to_array().map(|value| (value * 255.0).round() as i32)
}
