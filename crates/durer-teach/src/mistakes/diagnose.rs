//! Finds the mistakes that explain a picture by rendering with each mistake in the table, both
//! alone and in pairs.

use super::bugs::PixelOrder;
use super::fit::{Fit, difference, differing, fit, sampled};
use super::input::{Diagnosis, DiagnosisInput, Explanation, MAX_DIFFERENCE, prepare, values};
use super::pictures::{View, brightest};
use super::speckles;
use super::table::{Formulas, MISTAKES, Mistake, Values};
use super::variant::SceneVariant;
use durer_image::compare::Scale;
use durer_render::world::{Material, Phong};
use durer_scene::math::{Color, Vec3};
use rayon::prelude::*;
use std::collections::BTreeSet;

/// Number of pixels per trial. `FEW_PIXELS` is used for all mistakes, and `COARSE_PIXELS` and then
/// `FULL_PIXELS` are used for the best ones.
const FEW_PIXELS: usize = 400;
const COARSE_PIXELS: usize = 1600;
const FULL_PIXELS: usize = 16_000;
/// Number of pixels in the first round of pairs, and number of pairs that are kept after each
/// round.
const PAIR_PIXELS: usize = 72;
const PAIRS_PER_ROUND: [usize; 3] = [200, 30, 8];
/// Maximum number of mistakes that are tried at `COARSE_PIXELS`.
const MAX_SINGLES: usize = 60;
/// Number of pixels above which the brightest value is not computed and acne is not checked.
const MAX_FULL_PIXELS: usize = 160_000;
/// Number of best trials whose values are refined and that are paired with all other mistakes.
const MAX_BEST: usize = 12;
/// Only the `CLOSEST` best trials, and those that explain more than `CLOSE`, are tried at
/// `FULL_PIXELS`.
const CLOSE: f64 = 0.8;
const CLOSEST: usize = 5;
/// Half a step of an eight-bit value, and minimum number of pixels that must show a different
/// rounding.
const HALF_STEP: f32 = 0.5 / 255.0;
const MIN_ROUNDED: usize = 30;
/// Remark about pictures that differ only in pixels that are not steady.
const OF_ROUNDING: &str = "the pictures differ only in pixels at edges, where rounding decides what a ray hits";
/// Maximum number of pairs that are tried.
const MAX_PAIRS: usize = 3000;

/// Mistakes that are tried together, the pixels that they produce, and how well those pixels match
/// the test picture.
#[derive(Clone, Debug)]
struct Trial {
    mistakes: Vec<(&'static Mistake, f32)>,
    rendered: Vec<Vec3>,
    fit: Fit,
}

/// Selected pixels of three pictures: the reference, the test picture, and the scene rendered
/// without mistakes.
struct Pixels {
    places: Vec<(u32, u32)>,
    reference: Vec<Vec3>,
    test: Vec<Vec3>,
    base: Vec<Vec3>,
}

impl Trial {
    fn explanation(&self) -> Explanation {
        let Fit { explained, matched } = self.fit;
        Explanation { mistakes: self.mistakes.clone(), explained, matched }
    }
}

impl Explanation {
    fn fit(&self) -> Fit {
        Fit { explained: self.explained, matched: self.matched }
    }
}

impl Pixels {
    /// Keeps only the marked pixels.
    fn keep(&mut self, keep_flags: &[bool]) {
        fn of<T>(list: &mut Vec<T>, keep_flags: &[bool]) {
            let mut keep = keep_flags.iter();
            list.retain(|_| *keep.next().unwrap_or(&true));
        }
        of(&mut self.places, keep_flags);
        [&mut self.reference, &mut self.test, &mut self.base].into_iter().for_each(|list| of(list, keep_flags));
    }
}

/// State of a search for mistakes, with the pictures, the view, and the scene without mistakes.
struct Search<'a> {
    question: &'a DiagnosisInput<'a>,
    view: View<'a>,
    base: SceneVariant<'a>,
}

/// Tries all mistakes of Whitted's method. `progress` receives values from 0 to 1.
pub fn diagnose(input: &DiagnosisInput, progress: &(dyn Fn(f64) + Sync)) -> Diagnosis {
    Diagnosis { formulas: Formulas::of(input.scene, input.world.rules()), ..all_tried(input, progress) }
}

fn all_tried(input: &DiagnosisInput, progress: &(dyn Fn(f64) + Sync)) -> Diagnosis {
    let (width, height) = (input.job.width, input.job.height);
    let (reference, view, base) = prepare(input);
    let test = values(input.test, view.scale, input.transfer);
    // Any mistake that erases the picture could explain a picture of a single colour.
    if test.iter().all(|pixel| *pixel == test[0]) {
        return Diagnosis { reference_difference: reference_difference(input), ..Diagnosis::default() };
    }
    let mut search = Search { question: input, view, base };

    let pixels = |search: &Search, most: usize| -> Pixels {
        let chosen = sampled(width, &reference, &test, most);
        let places: Vec<(u32, u32)> = chosen.iter().map(|&i| (i as u32 % width, i as u32 / width)).collect();
        let base = search.view.picture(&search.base, &places);
        let of = |pixels: &[Vec3]| chosen.iter().map(|&i| pixels[i]).collect();
        Pixels { places, reference: of(&reference), test: of(&test), base }
    };
    let all: Vec<(u32, u32)> = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).collect();
    let light = match all.len() <= MAX_FULL_PIXELS {
        true => search.view.light(&search.base, &all),
        false => Vec::new(),
    };
    search.view.max_value = brightest(&light);
    let mut full = pixels(&search, FULL_PIXELS);
    let steady = search.steady(&full);
    let differs_at_first = differing(&full.reference, &full.test) > 0;
    full.keep(&steady);
    let off = differing(&full.base, &full.reference) as f64 / full.base.len().max(1) as f64;
    progress(0.1);
    if off > MAX_DIFFERENCE {
        return Diagnosis { reference_difference: off, ..Diagnosis::default() };
    }
    if difference(&full.reference, &full.test) == 0.0 {
        return Diagnosis {
            reference_difference: off,
            explanations: search.rounding(&full).into_iter().collect(),
            remark: differs_at_first.then(|| OF_ROUNDING.into()),
            ..Diagnosis::default()
        };
    }
    let few = |most: usize| {
        let mut pixels = pixels(&search, most);
        let steady = search.steady(&pixels);
        pixels.keep(&steady);
        pixels
    };
    let (some, coarse) = (few(FEW_PIXELS), few(COARSE_PIXELS));
    let mut singles = search.trials(search.singles(), &some);
    // Drop mistakes that have no effect in this scene.
    singles.retain(|trial| differing(&trial.rendered, &some.base) > 0);
    progress(0.2);
    let mut better = search.trials(best(&mut singles, MAX_SINGLES), &coarse);
    sort(&mut better);
    progress(0.3);
    let refined = better.iter().take(MAX_BEST).map(|trial| search.refined(trial, &some, &coarse));
    let close = refined.chain(best_matched(&better).map(|trial| trial.mistakes.clone())).collect();
    let mut close = search.trials(close, &coarse);
    sort(&mut close);
    close.dedup_by(|a, b| same(&a.mistakes, &b.mistakes));
    let close = close.into_iter().enumerate().filter(|(i, trial)| *i < CLOSEST || trial.fit.explained > CLOSE);
    let trials = search.trials(close.map(|(_, trial)| trial.mistakes).collect(), &full);
    progress(0.5);
    let tried = tried(&trials);
    let single = accepted_explanations(trials, &full, &Thresholds::NEARLY);
    if single.first().is_some_and(|explanations| Thresholds::CLEAR.passes(&explanations.fit())) {
        return Diagnosis {
            reference_difference: off,
            explanations: single,
            closest_trials: tried,
            ..Diagnosis::default()
        };
    }
    if let Some(share) = search.acne(&all, &reference, &test) {
        return Diagnosis {
            reference_difference: off,
            explanations: vec![share],
            closest_trials: tried,
            ..Diagnosis::default()
        };
    }
    progress(0.6);
    let (pairs, tried_pairs) = search.pairs(&better, &singles, [&few(PAIR_PIXELS), &some, &coarse, &full]);
    progress(1.0);
    // Two mistakes always explain more than one does, so a pair must explain much more.
    let rest =
        |explanations: &[Explanation]| explanations.first().map_or(1.0, |explanations| 1.0 - explanations.explained);
    let explanations = if rest(&pairs) < 0.35 * rest(&single) { pairs } else { single };
    let tried = [tried, tried_pairs].concat();
    match explanations.first().is_none_or(|explanations| Thresholds::SINGLE.passes(&explanations.fit())) {
        true => Diagnosis { reference_difference: off, explanations, closest_trials: tried, ..Diagnosis::default() },
        false => Diagnosis {
            reference_difference: off,
            nearly: explanations.into_iter().next(),
            closest_trials: tried,
            ..Diagnosis::default()
        },
    }
}

/// Returns up to eight explanations, with the best one first.
fn tried(trials: &[Trial]) -> Vec<Explanation> {
    let mut all: Vec<Explanation> = trials.iter().map(Trial::explanation).collect();
    all.sort_by(|a, b| b.explained.total_cmp(&a.explained));
    all.truncate(8);
    all
}

/// Returns the fraction of the pixels, estimated from a sample, in which a render of the scene
/// differs from the reference.
pub fn reference_difference(input: &DiagnosisInput) -> f64 {
    let (reference, view, base) = prepare(input);
    let pixels = sampled(input.job.width, &reference, &reference, 2 * FEW_PIXELS);
    let width = input.job.width;
    let chosen: Vec<(u32, u32)> = pixels.iter().map(|&i| (i as u32 % width, i as u32 / width)).collect();
    let of: Vec<Vec3> = pixels.iter().map(|&i| reference[i]).collect();
    differing(&view.picture(&base, &chosen), &of) as f64 / of.len().max(1) as f64
}

impl<'a> Search<'a> {
    /// Returns every mistake separately, with each of its values.
    fn singles(&self) -> Vec<Vec<(&'static Mistake, f32)>> {
        let lights = self.base.world.lights().len();
        let rows = MISTAKES.iter().copied().flatten().filter(|row| self.applies(row));
        rows.flat_map(|row| row.values.numbers(lights).into_iter().map(move |value| vec![(row, value)])).collect()
    }

    /// Returns false if a mistake concerns something that the scene lacks, so that it need not be
    /// tried.
    fn applies(&self, row: &Mistake) -> bool {
        let any = |has: fn(&Phong) -> bool| {
            self.base.world.materials().iter().any(|material| matches!(material, Material::Phong(phong) if has(phong)))
        };
        match row.step {
            "transforms" => self.base.has_transforms(),
            "refraction" | "fresnel" => any(|phong| phong.transparent != Color::ZERO),
            "reflection" => {
                any(|phong| phong.reflective.max(phong.transparent) != Color::ZERO) || row.name.starts_with("clamped")
            }
            _ => true,
        }
    }

    /// Marks the pixels that do not depend on rounding. They stay the same if samples are slightly
    /// offset or epsilon changes.
    fn steady(&self, pixels: &Pixels) -> Vec<bool> {
        let aside = |by: f32| {
            let mut variant = self.base.clone();
            variant.camera_bugs.sample_position += by;
            variant
        };
        let mut other = self.base.clone();
        other.change_rules(|rules| rules.epsilon = Some(rules.epsilon.map_or(1e-4, |epsilon| 8.0 * epsilon)));
        let mut steady = vec![true; pixels.places.len()];
        for variant in [aside(0.004), aside(-0.004), other] {
            let rendered = self.view.picture(&variant, &pixels.places);
            for ((steady, rendered), base) in steady.iter_mut().zip(&rendered).zip(&pixels.base) {
                *steady &= differing(&[*rendered], &[*base]) == 0;
            }
        }
        // If most pixels are at edges, use all pixels.
        if steady.iter().filter(|s| **s).count() * 2 < steady.len() { vec![true; steady.len()] } else { steady }
    }

    fn trials(&self, all: Vec<Vec<(&'static Mistake, f32)>>, pixels: &Pixels) -> Vec<Trial> {
        all.into_par_iter().map(|mistakes| self.trial(mistakes, pixels)).collect()
    }

    /// Renders the scene with mistakes and measures how well the result matches the test picture.
    fn trial(&self, mistakes: Vec<(&'static Mistake, f32)>, pixels: &Pixels) -> Trial {
        let mut variant = self.base.clone();
        for (mistake, value) in &mistakes {
            (mistake.apply)(&mut variant, *value);
        }
        let mut rendered = self.view.picture(&variant, &pixels.places);
        // If the reference differs from the rendered scene at a pixel, the change caused by the
        // mistake is added to the reference.
        if variant.pixel_order == PixelOrder::default() {
            for ((rendered, base), reference) in rendered.iter_mut().zip(&pixels.base).zip(&pixels.reference) {
                if differing(&[*base], &[*reference]) > 0 {
                    *rendered = *reference + (*rendered - *base);
                }
            }
        }
        let fit = fit(&pixels.reference, &pixels.test, &rendered);
        Trial { mistakes, rendered, fit }
    }

    /// Returns a mistake with the value that fits best. Searches with a small number of pixels, and
    /// rounds the value if the rounded value fits equally well with more pixels.
    fn refined(&self, trial: &Trial, few: &Pixels, more: &Pixels) -> Vec<(&'static Mistake, f32)> {
        let [(mistake, value)] = trial.mistakes[..] else { return trial.mistakes.clone() };
        if !matches!(mistake.values, Values::Numbers(_)) || trial.fit.explained > 0.999 {
            return trial.mistakes.clone();
        }
        let fit = |value: f32, pixels: &Pixels| self.trial(vec![(mistake, value)], pixels).fit;
        let (mut best, mut at, mut step) = (fit(value, few), value, 1.5_f32);
        for _ in 0..7 {
            for tried in [at / step, at * step] {
                let fit = fit(tried, few);
                // Several values can explain everything except for ignored outliers.
                let matches = fit.explained == best.explained && fit.matched > best.matched;
                if fit.explained > best.explained || matches {
                    (best, at) = (fit, tried);
                }
            }
            step = step.sqrt();
        }
        // Prefer the roundest number that fits as well.
        let best = fit(at, more);
        let as_good = |fit: Fit| fit.explained >= best.explained - 0.002 && fit.matched >= best.matched - 0.01;
        let fits = |tried: &f32| *tried > 0.0 && (tried / at - 1.0).abs() < 0.05 && as_good(fit(*tried, more));
        vec![(mistake, round_numbers(at).into_iter().find(fits).unwrap_or(at))]
    }

    /// Tries pairs of the best mistakes with all others, and then the best pairs with increasing
    /// numbers of pixels.
    fn pairs(
        &self,
        best_of: &[Trial],
        singles: &[Trial],
        rounds: [&Pixels; 4],
    ) -> (Vec<Explanation>, Vec<Explanation>) {
        let mut first: Vec<&Trial> = best_of.iter().take(MAX_BEST).chain(best_matched(best_of)).collect();
        first.dedup_by_key(|trial| trial.mistakes[0].0.name);
        let mut known = BTreeSet::new();
        let mut pairs: Vec<Vec<(&'static Mistake, f32)>> = Vec::new();
        for a in first {
            for b in singles {
                let (a, b) = (a.mistakes[0], b.mistakes[0]);
                let key = |one: (&Mistake, f32)| (one.0.name, one.1.to_bits());
                let pair = (key(a).min(key(b)), key(a).max(key(b)));
                // Mistakes that depend on rounding fit any picture, so they explain nothing when
                // they are part of a pair.
                let shaky = a.0.step == "epsilon" || b.0.step == "epsilon";
                // The formulas of normals refer to the correct M, so they would be misleading if
                // M itself is inverted.
                let relative = |a: &Mistake, b: &Mistake| {
                    a.name == "transforms-inverted" && b.name.starts_with("normals-") && b.step == "transforms"
                };
                let misleading = relative(a.0, b.0) || relative(b.0, a.0);
                if a.0.name != b.0.name && !shaky && !misleading && known.insert(pair) {
                    pairs.push(vec![a, b]);
                }
            }
        }
        pairs.truncate(MAX_PAIRS);
        let full = rounds[3];
        for (pixels, keep_flags) in rounds.into_iter().zip(PAIRS_PER_ROUND) {
            pairs = best(&mut self.trials(pairs, pixels), keep_flags);
        }
        let alone = |mistakes: &[(&'static Mistake, f32)]| {
            let of = |one: &(&'static Mistake, f32)| self.trial(vec![*one], full).fit.explained;
            mistakes.iter().map(of).fold(f64::NEG_INFINITY, f64::max)
        };
        let trials = self.trials(pairs, full);
        let tried = tried(&trials);
        let mut explanations = accepted_explanations(trials, full, &Thresholds::PAIR);
        // Keep a pair only if both mistakes are needed.
        explanations
            .retain(|explanations| 1.0 - alone(&explanations.mistakes) > 2.0 * (1.0 - explanations.explained) + 0.002);
        (explanations, tried)
    }

    /// If values differ by only 1/255, checks whether they are rounded instead of truncated, or the
    /// reverse.
    fn rounding(&self, pixels: &Pixels) -> Option<Explanation> {
        let mistake = super::table::mistake_by_name("other-rounding")?;
        let rendered = self.trial(vec![(mistake, 0.0)], pixels).rendered;
        let differs = |a: &Vec3, b: &Vec3| (*a - *b).abs().max_element() > HALF_STEP;
        let (mut either, mut agree) = (0_usize, 0_usize);
        for ((r, t), m) in pixels.reference.iter().zip(&pixels.test).zip(&rendered) {
            if differs(r, t) || differs(r, m) {
                either += 1;
                agree += usize::from(!differs(t, m));
            }
        }
        let share = agree as f64 / either.max(1) as f64;
        let fits = self.view.scale == Scale::Display && agree >= MIN_ROUNDED && share > Thresholds::FITTED.matched;
        fits.then(|| Explanation { mistakes: vec![(mistake, 0.0)], explained: share, matched: share })
    }

    /// Checks whether the picture shows acne, which means that rays hit the surface that they start
    /// from.
    fn acne(&self, all: &[(u32, u32)], reference: &[Vec3], test: &[Vec3]) -> Option<Explanation> {
        let lights = self.base.world.lights().len();
        if all.len() > MAX_FULL_PIXELS || !(1..=4).contains(&lights) || !self.base.settings.shadows {
            return None;
        }
        let width = self.question.job.width as usize;
        let differ = speckles::isolated_pixels(reference, test, width)?;
        // If there is acne, reflected rays return nothing or hit their own surface again.
        let ways = if self.base.settings.bounces > 0 { 3 } else { 1 };
        let dark = |blocked_lights: [u32; 2], way: u32, differ: &[usize]| {
            let mut variant = self.base.clone();
            match way {
                0 => {}
                1 => variant.settings.bounces = 0,
                _ => variant.bugs.bounces.epsilon = Some(-1e-3),
            }
            variant.bugs.shadows.blocked_lights = blocked_lights;
            let pixels: Vec<(u32, u32)> = differ.iter().map(|&i| all[i]).collect();
            self.view.picture(&variant, &pixels)
        };
        let shadowed: Vec<Vec<Vec3>> = (1..ways << lights).map(|of| dark([of / ways; 2], of % ways, &differ)).collect();
        let mut unlike = speckles::unlike(test, &differ, &shadowed);
        let share = speckles::share(&differ, &unlike).or_else(|| {
            if ways == 1 || 2 * unlike.len() > differ.len() {
                return None;
            }
            // If only shadow rays are wrong, a mirror and what it shows have specks of their own.
            let sets = 0..1_u32 << lights;
            for first in sets.clone() {
                let others = sets.clone().filter(|other| *other != first);
                let shadowed: Vec<Vec<Vec3>> = others.map(|other| dark([first, other], 0, &unlike)).collect();
                unlike = speckles::unlike(test, &unlike, &shadowed);
            }
            speckles::share(&differ, &unlike)
        })?;
        let mistake = super::table::mistake_by_name("epsilon-0")?;
        Some(Explanation { mistakes: vec![(mistake, 0.0)], explained: share, matched: share })
    }
}

/// Returns the numbers near a value, starting with the roundest.
fn round_numbers(value: f32) -> [f32; 5] {
    let to = |steps: f32| (value * steps).round() / steps;
    [to(1.0), 1.0 / (1.0 / value).round(), to(2.0), to(10.0), to(20.0)]
}

fn sort(trials: &mut [Trial]) {
    trials.sort_by(|a, b| b.fit.explained.total_cmp(&a.fit.explained));
}

/// Returns the mistakes of the best trials. Three quarters of them are chosen by squared
/// difference, and the rest by number of matching pixels.
fn best(trials: &mut [Trial], count: usize) -> Vec<Vec<(&'static Mistake, f32)>> {
    sort(trials);
    let (first, others) = trials.split_at_mut(trials.len().min(count - count / 4));
    others.sort_by(|a, b| b.fit.matched.total_cmp(&a.fit.matched));
    first.iter().chain(others.iter().take(count / 4)).map(|trial| trial.mistakes.clone()).collect()
}

/// Returns the trials that match the most pixels, because a few outliers can dominate the squared
/// difference.
fn best_matched(trials: &[Trial]) -> impl Iterator<Item = &Trial> {
    let mut sorted: Vec<&Trial> = trials.iter().collect();
    sorted.sort_by(|a, b| b.fit.matched.total_cmp(&a.fit.matched));
    sorted.into_iter().take(4)
}

/// Minimum quality of fit for a trial to count as an explanation.
struct Thresholds {
    explained: f64,
    matched: f64,
}

impl Thresholds {
    /// For one mistake, if there is also another difference in the picture.
    const NEARLY: Thresholds = Thresholds { explained: 0.985, matched: 0.9 };
    // For one mistake on its own. It may leave only rounding differences at edges. A larger
    // difference means that there is another mistake.
    const SINGLE: Thresholds = Thresholds { explained: 0.99, matched: 0.95 };
    /// For a pair of mistakes, which fits more pictures by chance than a single mistake does.
    const PAIR: Thresholds = Thresholds { explained: 0.995, matched: 0.97 };
    /// For a mistake whose value was fitted.
    const FITTED: Thresholds = Thresholds { explained: 0.999, matched: 0.97 };
    /// Quality of fit at which the search ends.
    const CLEAR: Thresholds = Thresholds { explained: 0.995, matched: 0.98 };
    /// All pixels fit, except perhaps for some at edges.
    const EXACT: Thresholds = Thresholds { explained: 0.9995, matched: 0.9995 };
    /// The fit is practically perfect.
    const PERFECT: Thresholds = Thresholds { explained: 0.998, matched: 0.995 };

    fn passes(&self, fit: &Fit) -> bool {
        fit.explained >= self.explained && fit.matched >= self.matched
    }
}

/// Returns the explanations that pass the thresholds. There are none if no trial passes, or if
/// trials with different pictures fit almost equally well.
fn accepted_explanations(mut trials: Vec<Trial>, pixels: &Pixels, thresholds: &Thresholds) -> Vec<Explanation> {
    sort(&mut trials);
    trials.dedup_by(|a, b| a.mistakes.len() == b.mistakes.len() && same(&a.mistakes, &b.mistakes));
    let passes = |trial: &Trial| {
        let is_fitted = trial.mistakes.iter().any(|(mistake, value)| mistake.is_fitted(*value));
        if is_fitted { Thresholds::FITTED.passes(&trial.fit) } else { thresholds.passes(&trial.fit) }
    };
    let Some(best) = trials.iter().find(|trial| passes(trial)) else { return Vec::new() };
    let total = difference(&pixels.reference, &pixels.test);
    let equal = |other: &Trial| {
        differing(&best.rendered, &other.rendered) * 2000 <= pixels.places.len()
            && difference(&best.rendered, &other.rendered) <= 0.01 * total
    };
    let rest = |trial: &Trial| 1.0 - trial.fit.explained;
    // Only near-perfect fits rival a perfect fit.
    let (slack, off) = match &best.fit {
        fit if Thresholds::EXACT.passes(fit) => (0.001, 0.003),
        fit if Thresholds::PERFECT.passes(fit) => (0.001, 0.01),
        _ => (0.01, 0.1),
    };
    let rival = |other: &&Trial| {
        !equal(other)
            && rest(other) < 2.0 * rest(best) + slack
            && other.fit.matched > best.fit.matched - off
            // A different value of the same mistake is not a rival.
            && !one_kind(&other.mistakes, &best.mistakes)
    };
    let rivals: Vec<&Trial> = trials.iter().filter(rival).collect();
    if rivals.len() > 2 || rivals.iter().any(|rival| !passes(rival)) {
        return Vec::new();
    }
    let mut explanations: Vec<Explanation> = Vec::new();
    for trial in trials.iter().filter(|trial| equal(trial)).chain(rivals) {
        // Report a mistake only once, even if several of its values fit.
        if !explanations.iter().any(|explanations| one_kind(&explanations.mistakes, &trial.mistakes)) {
            explanations.push(trial.explanation());
        }
    }
    // Prefer mistakes whose values were not fitted.
    let plain =
        |explanations: &Explanation| !explanations.mistakes.iter().any(|(mistake, value)| mistake.is_fitted(*value));
    if explanations.iter().any(plain) {
        explanations.retain(plain);
    }
    explanations
}

/// Returns true if two explanations differ only in the values of their mistakes.
fn one_kind(a: &[(&Mistake, f32)], b: &[(&Mistake, f32)]) -> bool {
    // Mistakes of a light count as equal only if they affect one and the same light.
    let alike =
        |a: &(&Mistake, f32), b: &(&Mistake, f32)| a.0.name == b.0.name && (a.0.values != Values::Lights || a.1 == b.1);
    a.len() == b.len() && a.iter().all(|a| b.iter().any(|b| alike(a, b)))
}

fn same(a: &[(&Mistake, f32)], b: &[(&Mistake, f32)]) -> bool {
    a.iter().zip(b).all(|(a, b)| a.0.name == b.0.name && a.1 == b.1)
}
