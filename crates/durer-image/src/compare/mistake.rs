//! Detection of common mistakes: each is applied to the reference, and the one that makes it most
//! similar to the picture explains the difference.

mod flow;
mod parts;
mod rule;
mod sample;
mod shift;
mod tone;
mod words;

#[cfg(test)]
mod tests;

use super::picture::Pair;
use durer_bvh::math::Vec3;
use rayon::prelude::*;
use rule::{Rule, TURNS};
use sample::{Sample, View};

/// A mistake that explains a difference.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// Keyword of the mistake, such as `mirrored`, `shifted`, or `factor`; one for each kind of
    /// [`Finding::words`].
    pub kind: &'static str,
    /// Description of the mistake, without a full stop: "it is mirrored left to right".
    pub words: String,
    /// Share of the squared difference, from 0 to 1, explained by this finding and the ones before
    /// it.
    ///
    /// Measured on all pixels of small pictures, and on 100 000 pixels of larger ones.
    pub explained: f64,
}

/// Minimum share of the difference that a mistake in a part of the picture must explain.
const WELL: f64 = 0.9;
/// Unexplained share above which findings are dropped: a wrong explanation is worse than none.
const MAX_LEFT: f64 = 0.05;
/// Unexplained share above which findings are dropped if they have fitted parameters.
const MAX_LEFT_FITTED: f64 = 0.02;
/// Minimum number of differing pixels that may form a pattern.
const FEWEST: usize = 12;
/// Minimum share of the remaining difference that a finding must explain.
const ENOUGH: f64 = 0.5;
/// Maximum number of successive mistakes.
const STEPS: usize = 3;

/// Finds the mistakes that best explain the difference of two pictures; empty if none explains half
/// of it.
pub(super) fn explain(pair: &Pair) -> Vec<Finding> {
    let mut reference = pair.reference.clone();
    let test = View::of(pair, &pair.test);
    if let Some(finding) = parts::blank(&View::of(pair, &reference), &test) {
        return vec![finding];
    }
    let total = difference(&sample::samples(&View::of(pair, &reference), &test));
    let mut findings: Vec<Finding> = Vec::new();
    let (mut left, mut moved, mut fitted) = (1.0, false, false);
    for _ in 0..STEPS {
        let view = View::of(pair, &reference);
        let samples = sample::samples(&view, &test);
        let Some((rule, rest)) = best_rule(&view, &test, &samples) else { break };
        // A rule that explains less than half of the remaining difference is a guess.
        if rest > ENOUGH * difference(&samples) {
            break;
        }
        left = rest / total;
        findings.push(Finding { kind: rule.kind(), words: words::of(&rule), explained: 1.0 - left });
        moved |= rule.moves();
        fitted |= rule.is_fitted();
        if left < 0.02 {
            break;
        }
        reference = rule.made(&view);
    }
    // A shift cannot explain the pixels that enter at the edge.
    let most = if fitted { MAX_LEFT_FITTED } else { MAX_LEFT };
    if !findings.is_empty() && (left <= most || moved && left < 0.3) {
        return findings;
    }
    let view = View::of(pair, &pair.reference);
    let samples = sample::samples(&view, &test);
    if samples.iter().filter(|s| (s.test - s.reference).abs().max_element() > 1.5 / 255.0).count() < FEWEST {
        return Vec::new();
    }
    match parts::finding(&view, &test, &samples) {
        Some(finding) if finding.explained > WELL => vec![finding],
        _ => Vec::new(),
    }
}

/// Sum of squared differences over samples.
fn difference(samples: &[Sample]) -> f64 {
    samples.iter().map(|s| f64::from((s.test - s.reference).length_squared())).sum()
}

/// Finds the rule that leaves the smallest difference, and that difference. Of nearly equal rules,
/// the simplest one is chosen.
fn best_rule(reference: &View, test: &View, samples: &[Sample]) -> Option<(Rule, f64)> {
    let rules = candidates(reference, test, samples);
    let left =
        |rule: &Rule| -> f64 { samples.iter().map(|s| f64::from(rule.rest(reference, s).length_squared())).sum() };
    let rests: Vec<f64> = rules.par_iter().map(left).collect();
    let least = rests.iter().copied().fold(f64::INFINITY, f64::min);
    // Candidates are sorted by increasing freedom to fit any picture.
    let near = 1.25 * least + 0.01 * difference(samples);
    rules.into_iter().zip(rests).find(|(_, rest)| *rest <= near)
}

/// Candidate rules with fitted parameters, sorted by increasing number of parameters.
fn candidates(reference: &View, test: &View, samples: &[Sample]) -> Vec<Rule> {
    let square = reference.width == reference.height;
    let mut rules: Vec<Rule> = TURNS.iter().filter(|t| square || !t.exchanges()).map(|&t| Rule::Turned(t)).collect();
    rules.extend([[2, 1, 0], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1]].map(Rule::Channels));
    rules.extend([
        Rule::Grey,
        Rule::Inverted([true; 3]),
        Rule::ThingsInverted,
        Rule::CurveOnceMore,
        Rule::CurveOnceLess,
    ]);
    rules.extend((1..7).map(|bits| Rule::Inverted(std::array::from_fn(|c| bits >> c & 1 == 1))));
    rules.extend(shift::shift(reference, test).map(|(dx, dy)| Rule::Shifted(dx, dy)));
    rules.push(Rule::Blurred);
    rules.extend(tone::fitted(reference.scale, samples));
    rules
}

/// Rounds a colour to 255ths for messages.
fn bytes(color: Vec3) -> [i32; 3] {
    color.to_array().map(|value| (value * 255.0).round() as i32)
}
