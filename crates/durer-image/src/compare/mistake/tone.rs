//! Rules for brightness and colour, whose parameters are fitted to the samples by least squares.

use super::rule::{Rule, is_clamped, same_color};
use super::sample::Sample;
use crate::compare::picture::Scale;
use durer_bvh::math::{Vec3, fp};
use std::collections::BTreeMap;

/// Returns the values of one channel in both pictures, except those that are clamped in either
/// picture.
fn values(scale: Scale, samples: &[Sample], channel: usize) -> impl Iterator<Item = (f64, f64)> {
    samples
        .iter()
        .map(move |s| (s.reference[channel], s.test[channel]))
        .filter(move |&(a, b)| !is_clamped(scale, a) && !is_clamped(scale, b))
        .map(|(a, b)| (f64::from(a), f64::from(b)))
}

/// Sums over the values of the reference (a) and of the picture (b), for linear least squares.
#[derive(Clone, Copy, Default)]
struct Sums {
    count: f64,
    a: f64,
    b: f64,
    aa: f64,
    ab: f64,
}

impl Sums {
    fn of(values: impl Iterator<Item = (f64, f64)>) -> Sums {
        values.fold(Sums::default(), |s, (a, b)| Sums {
            count: s.count + 1.0,
            a: s.a + a,
            b: s.b + b,
            aa: s.aa + a * a,
            ab: s.ab + a * b,
        })
    }

    fn factor(&self) -> f32 {
        if self.aa > 0.0 { (self.ab / self.aa) as f32 } else { 1.0 }
    }

    fn added(&self) -> f32 {
        if self.count > 0.0 { ((self.b - self.a) / self.count) as f32 } else { 0.0 }
    }

    /// Returns the slope and the intercept of the fitted line.
    fn line(&self) -> Option<(f64, f64)> {
        let spread = self.count * self.aa - self.a * self.a;
        let slope = (self.count * self.ab - self.a * self.b) / spread;
        (spread > 1e-9 * self.count).then(|| (slope, (self.b - slope * self.a) / self.count))
    }
}

/// Returns rules with fitted parameters: first those with one parameter, then those with more.
pub fn fitted(scale: Scale, samples: &[Sample]) -> Vec<Rule> {
    let each: [Sums; 3] = std::array::from_fn(|channel| Sums::of(values(scale, samples, channel)));
    let all = Sums::of((0..3).flat_map(|channel| values(scale, samples, channel)));
    let mut rules = vec![Rule::Factor(all.factor()), Rule::Added(all.added())];
    if scale == Scale::Display {
        let light: Vec<Sample> = samples
            .iter()
            .filter(|s| [s.reference, s.test].iter().all(|v| !v.to_array().iter().any(|&v| is_clamped(scale, v))))
            .map(|s| Sample { reference: scale.decode(s.reference), test: scale.decode(s.test), ..*s })
            .collect();
        let sums = Sums::of((0..3).flat_map(|channel| values(scale, &light, channel)));
        rules.push(Rule::LightFactor(sums.factor()));
    }
    // In log-log space, an exponent is the slope of a line through the origin.
    let logarithms = (0..3).flat_map(|channel| values(scale, samples, channel));
    let ln = |value: f64| f64::from(fp::ln(value as f32));
    rules.push(Rule::Power(Sums::of(logarithms.map(|(a, b)| (ln(a), ln(b)))).factor()));
    rules.extend(recolored(samples));
    if let Some((slope, amount)) = all.line() {
        rules.push(Rule::Affine(slope as f32, amount as f32));
    }
    rules.push(Rule::Factors(Vec3::from(each.map(|sums| sums.factor()))));
    rules.push(Rule::AddedEach(Vec3::from(each.map(|sums| sums.added()))));
    rules
}

/// Finds the colour that differs most often, such as the background, and the colour that replaces
/// it most often.
fn recolored(samples: &[Sample]) -> Option<Rule> {
    let differing = || samples.iter().filter(|s| !same_color(s.reference, s.test));
    let from = most_frequent(differing().map(|s| s.reference))?;
    let to = most_frequent(differing().filter(|s| same_color(s.reference, from)).map(|s| s.test))?;
    // If the new colour occurs in the reference, the cause is different lighting rather than the
    // background.
    let known = samples.iter().filter(|s| same_color(s.reference, to)).count();
    (100 * known < samples.len()).then_some(Rule::Recolored(from, to))
}

fn most_frequent(colors: impl Iterator<Item = Vec3>) -> Option<Vec3> {
    let mut counts: BTreeMap<[u32; 3], u32> = BTreeMap::new();
    colors.for_each(|color| *counts.entry(color.to_array().map(f32::to_bits)).or_default() += 1);
    let most = counts.into_iter().max_by_key(|&(_, count)| count)?;
    Some(most.0.map(f32::from_bits).into())
}
