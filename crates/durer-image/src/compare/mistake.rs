//! The usual mistakes, recognised by making them: each is made in the reference, and whichever
//! makes it most like the picture explains the difference.

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
    /// Which one, as a keyword: `mirrored`, `shifted`, `factor` and so on, one for each kind of
    /// [`Finding::words`].
    pub kind: &'static str,
    /// What it is, in words about the picture, without a full stop: "it is mirrored left to right".
    pub words: String,
    /// The share of the squared difference, from 0 to 1, that it explains together with the
    /// findings before it.
    ///
    /// Measured on all pixels of small pictures and on 100 000 of others.
    pub explained: f64,
}

/// Explained well enough to look no further.
const WELL: f64 = 0.9;
/// What more of the difference is left than this nobody is told a theory of: a wrong one costs more
/// than none.
const MAX_LEFT: f64 = 0.05;
/// And this, of rules with numbers that were fitted.
const MAX_LEFT_FITTED: f64 = 0.02;
/// So few pixels that differ are no pattern.
const FEWEST: usize = 12;
/// Explained well enough to be said.
const ENOUGH: f64 = 0.5;
/// At most so many mistakes are sought behind each other.
const STEPS: usize = 3;

/// The mistakes that explain the difference of two pictures best; none where none explains half of
/// it.
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
        // What explains less than half of what is left is a guess.
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
    // A shift leaves what came in over the edge.
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

/// The squared difference of samples.
fn difference(samples: &[Sample]) -> f64 {
    samples.iter().map(|s| f64::from((s.test - s.reference).length_squared())).sum()
}

/// The rule that leaves the least of the difference, and what it leaves: of nearly equal ones the
/// simplest.
fn best_rule(reference: &View, test: &View, samples: &[Sample]) -> Option<(Rule, f64)> {
    let rules = candidates(reference, test, samples);
    let left =
        |rule: &Rule| -> f64 { samples.iter().map(|s| f64::from(rule.rest(reference, s).length_squared())).sum() };
    let rests: Vec<f64> = rules.par_iter().map(left).collect();
    let least = rests.iter().copied().fold(f64::INFINITY, f64::min);
    // Candidates come in the order of their freedom to fit anything.
    let near = 1.25 * least + 0.01 * difference(samples);
    rules.into_iter().zip(rests).find(|(_, rest)| *rest <= near)
}

/// All rules that could be meant, with their numbers fitted; those with fewer numbers first.
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

/// What a colour is in 255ths, to say it.
fn bytes(color: Vec3) -> [i32; 3] {
    color.to_array().map(|value| (value * 255.0).round() as i32)
}
