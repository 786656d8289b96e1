//! Finds the path tracer mistake that explains a picture.

use super::blocks::{BlockMeans, Blocks};
use super::pooled::{MeanDifference, mean_difference};
use super::table::MISTAKES;
use crate::mistakes::input::{Diagnosis, DiagnosisInput, Explanation, prepare, values};
use crate::mistakes::pictures::View;
use crate::mistakes::table::{Formulas, Mistake};
use crate::mistakes::variant::SceneVariant;
use durer_scene::math::Vec3;

/// Maximum fraction of blocks in which the reference may differ significantly from the rendered
/// scene. If the fraction is larger, no mistakes are tried.
const MAX_DIFFERENCE: f64 = 0.15;
/// Minimum fraction of differing blocks. If fewer blocks differ, the difference is attributed to
/// noise.
const MIN_DIFFERENCE: f64 = 0.02;
/// Minimum quality of an explanation, as a fraction of the squared difference and as a fraction of
/// the differing blocks.
const MIN_EXPLAINED: f64 = 0.95;
const MIN_MATCHED: f64 = 0.9;
/// An explanation is a rival if its residual is at most this many times the residual of the best
/// one.
const RIVAL_RATIO: f64 = 3.0;
/// Maximum misfit beyond 1 of an explanation: a constant, and a fraction of the misfit without
/// mistakes.
const MAX_MISFIT: f64 = 0.6;
const MAX_MISFIT_SHARE: f64 = 0.02;
/// Minimum amount by which an explanation must reduce the misfit of all blocks together, and its
/// minimum lead over other explanations, also as a fraction of that amount.
const MIN_GAIN: f64 = 60.0;
const MIN_LEAD: f64 = 20.0;
const MIN_LEAD_SHARE: f64 = 0.05;
/// Ratio of variances above which one picture counts as noisier than the other.
const NOISE_RATIO: f64 = 1.5;

/// One mistake with its value, and the block means rendered with it.
#[derive(Clone)]
pub(super) struct Candidate {
    mistake: (&'static Mistake, f32),
    rendered: BlockMeans,
}

/// How well a candidate reproduces the test picture.
struct Trial<'c> {
    candidate: &'c Candidate,
    explained: f64,
    matched: f64,
    /// See [`BlockMeans::misfit`].
    misfit: f64,
    /// The misfit if the picture is as noisy as the candidate. It decides only if a candidate fits,
    /// since it would favour noisy candidates.
    least_misfit: f64,
}

impl Trial<'_> {
    fn explanation(&self) -> Explanation {
        Explanation { mistakes: vec![self.candidate.mistake], explained: self.explained, matched: self.matched }
    }
}

/// Returns the fraction of the blocks in which a render of the scene differs from the reference by
/// more than noise.
pub fn off(input: &DiagnosisInput) -> f64 {
    let search = Search::new(input);
    share_off(&search.own, &search.reference_means())
}

/// Returns, for each block, the variance of the difference between two pictures.
fn noise(a: &BlockMeans, b: &BlockMeans) -> Vec<f64> {
    a.variance.iter().zip(&b.variance).map(|(a, b)| a + b).collect()
}

fn share_off(base: &BlockMeans, reference: &BlockMeans) -> f64 {
    let beyond = base.excess_difference(reference, &noise(base, reference));
    beyond.iter().filter(|block| block.1).count() as f64 / beyond.len().max(1) as f64
}

/// Tries all mistakes of path tracers. `progress` receives values from 0 to 1.
pub fn diagnose(input: &DiagnosisInput, progress: &(dyn Fn(f64) + Sync)) -> Diagnosis {
    let search = Search::new(input);
    progress(0.1);
    let test = values(input.test, search.view.scale, input.transfer);
    search.diagnose(&test, || search.candidates(progress))
}

/// The correct scene and the reference picture, with which wrong pictures are compared.
pub(super) struct Search<'a> {
    input: DiagnosisInput<'a>,
    reference: Vec<Vec3>,
    view: View<'a>,
    base: SceneVariant<'a>,
    blocks: Blocks,
    /// Block means of a render without mistakes.
    own: BlockMeans,
    /// A few pixels, and a render of them without mistakes.
    probe: (Blocks, BlockMeans),
}

impl<'a> Search<'a> {
    /// Renders the scene without mistakes.
    pub(super) fn new(input: &DiagnosisInput<'a>) -> Self {
        let (reference, view, base) = prepare(input);
        let blocks = Blocks::new(input.job.width, input.job.height, input.job.sampling.samples());
        let own = blocks.render(&view, &base, input.job.seed);
        let probe = blocks.probe();
        let probed = probe.render(&view, &base, input.job.seed);
        Search { input: *input, reference, view, base, blocks, own, probe: (probe, probed) }
    }

    /// Returns the block means of the reference, with the noise of a render.
    fn reference_means(&self) -> BlockMeans {
        self.own.with_noise_of(self.blocks.of_picture(self.input.job.width, &self.reference), 1.0)
    }

    /// Finds the mistake in a picture. Calls `candidates` only if the reference shows the scene and
    /// the picture differs from it.
    pub(super) fn diagnose(&self, picture: &[Vec3], candidates: impl FnOnce() -> Vec<Candidate>) -> Diagnosis {
        let (width, own) = (self.input.job.width, &self.own);
        let test = self.blocks.of_picture(width, picture);
        let ratio = noise_ratio(&self.reference, picture, width as usize);
        let test = own.with_noise_of(test, ratio.clamp(0.2, 200.0));
        let off = share_off(own, &self.reference_means());
        let diagnosis = Diagnosis {
            reference_difference: off,
            formulas: Formulas::of(self.input.scene, self.input.world.rules()),
            ..Diagnosis::default()
        };
        if off > MAX_DIFFERENCE {
            return diagnosis;
        }
        let total = own.excess_difference(&test, &noise(own, &test));
        let differing = total.iter().filter(|block| block.1).count();
        let is_small = (differing as f64) < MIN_DIFFERENCE * total.len() as f64;
        let mean = mean_difference(&self.reference, picture, self.input.job.width, self.input.job.height);
        if is_small && mean.is_none() {
            return Diagnosis { remark: Some(of_noise(ratio)), ..diagnosis };
        }
        let candidates = candidates();
        let before = own.misfit(&test, &noise(own, &test));
        let mut trials: Vec<Trial> = candidates.iter().map(|candidate| trial(candidate, &test, own)).collect();
        let mut explanations = if is_small { Vec::new() } else { decided(&mut trials, before, &test) };
        if explanations.is_empty() {
            explanations = decided_by_misfit(&mut trials, before, &test);
        }
        let closest_trials = trials.iter().take(8).map(Trial::explanation).collect();
        let remark = mean.filter(|_| explanations.is_empty()).map(of_mean);
        Diagnosis { explanations, closest_trials, remark, ..diagnosis }
    }

    /// Renders the scene with each mistake.
    pub(super) fn candidates(&self, progress: &(dyn Fn(f64) + Sync)) -> Vec<Candidate> {
        let lights = self.base.world.lights().len();
        let rows =
            MISTAKES.iter().flat_map(|row| row.values.numbers(lights).into_iter().map(move |value| (row, value)));
        let all: Vec<(&'static Mistake, f32)> = rows.collect();
        let count = all.len();
        let candidate = |(i, mistake): (usize, (&'static Mistake, f32))| {
            let mut variant = self.base.clone();
            (mistake.0.apply)(&mut variant, mistake.1);
            // The random numbers do not change, so a mistake without an effect changes no bit.
            let (probe, own) = &self.probe;
            let has_effect = probe.render(&self.view, &variant, self.input.job.seed).mean != own.mean;
            let rendered = has_effect.then(|| self.blocks.render(&self.view, &variant, self.input.job.seed));
            progress(0.1 + 0.9 * (i + 1) as f64 / count as f64);
            rendered.map(|rendered| Candidate { mistake, rendered })
        };
        all.into_iter().enumerate().filter_map(candidate).collect()
    }
}

/// Measures how much of the difference between the test picture and the scene a candidate explains.
fn trial<'c>(candidate: &'c Candidate, test: &BlockMeans, own: &BlockMeans) -> Trial<'c> {
    let noise = noise(&candidate.rendered, test);
    let (before, rest) = (own.excess_difference(test, &noise), candidate.rendered.excess_difference(test, &noise));
    let sum = |beyond: &[(f64, bool)]| beyond.iter().map(|block| block.0).sum::<f64>();
    let (either, agree) = before.iter().zip(&rest).fold((0, 0), |(either, agree), (before, rest)| {
        (either + usize::from(before.1 || rest.1), agree + usize::from(before.1 && !rest.1))
    });
    let explained = 1.0 - sum(&rest) / sum(&before).max(1e-12);
    let misfit = candidate.rendered.misfit(test, &noise);
    let most =
        noise.iter().zip(&candidate.rendered.variance).map(|(noise, own)| noise.max(2.0 * own)).collect::<Vec<_>>();
    let least_misfit = candidate.rendered.misfit(test, &most);
    Trial {
        candidate,
        explained,
        matched: f64::from(agree as u32) / f64::from((either as u32).max(1)),
        misfit,
        least_misfit,
    }
}

/// Returns true if the remaining misfit can be attributed to noise and small differences between
/// programs. `before` is the misfit without mistakes.
fn fits(trial: &Trial, before: f64) -> bool {
    trial.least_misfit - 1.0 < MAX_MISFIT + MAX_MISFIT_SHARE * (before - 1.0).max(0.0)
}

/// Returns the mistakes that explain differences too small to be visible in single blocks. There
/// are none if no mistake fits, or if a mistake with a different picture fits nearly as well.
fn decided_by_misfit(trials: &mut [Trial<'_>], before: f64, test: &BlockMeans) -> Vec<Explanation> {
    trials.sort_by(|a, b| a.misfit.total_cmp(&b.misfit));
    let Some(best) = trials.first() else { return Vec::new() };
    let blocks = test.mean.len().max(1) as f64;
    let gain = (before - best.misfit) * blocks;
    if !fits(best, before) || gain < MIN_GAIN || best.misfit - 1.0 > 0.2 * (before - 1.0) {
        return Vec::new();
    }
    let rivals: Vec<&Trial> = trials
        .iter()
        .filter(|trial| (trial.misfit - best.misfit) * blocks < MIN_LEAD.max(MIN_LEAD_SHARE * gain))
        .collect();
    if rivals.len() > 4 || !rivals.iter().all(|rival| alike(best, rival, test)) {
        return Vec::new();
    }
    let explained = |trial: &Trial| ((before - trial.misfit) / (before - 1.0).max(1e-9)).clamp(0.0, 1.0);
    rivals.iter().map(|rival| Explanation { explained: explained(rival), ..rival.explanation() }).collect()
}

/// Returns true if the pictures of two candidates differ in at most a twentieth of the blocks, or
/// if they are values of one mistake.
fn alike(best: &Trial, other: &Trial, test: &BlockMeans) -> bool {
    if best.candidate.mistake.0.name == other.candidate.mistake.0.name {
        return true;
    }
    let noise = noise(&best.candidate.rendered, test);
    let beyond = best.candidate.rendered.excess_difference(&other.candidate.rendered, &noise);
    let is_equal = best.candidate.rendered.misfit(&other.candidate.rendered, &noise) < 0.05;
    is_equal && beyond.iter().filter(|block| block.1).count() * 20 <= test.mean.len()
}

/// Returns the mistakes that explain the picture. There are none if no mistake fits or if the
/// choice is ambiguous.
fn decided(trials: &mut [Trial<'_>], before: f64, test: &BlockMeans) -> Vec<Explanation> {
    trials.sort_by(|a, b| b.explained.total_cmp(&a.explained));
    let passes =
        |trial: &&Trial| trial.explained >= MIN_EXPLAINED && trial.matched >= MIN_MATCHED && fits(trial, before);
    let Some(best) = trials.iter().find(passes) else { return Vec::new() };
    let rest = |trial: &Trial| 1.0 - trial.explained;
    let rivals: Vec<&Trial> =
        trials.iter().filter(passes).filter(|trial| rest(trial) <= RIVAL_RATIO * rest(best) + 0.005).collect();
    // If rivals produce different pictures, naming one of them would be a guess.
    if rivals.len() > 4 || !rivals.iter().all(|rival| alike(best, rival, test)) {
        return Vec::new();
    }
    rivals.iter().map(|rival| rival.explanation()).collect()
}

/// Estimates the noise variance of a picture relative to that of the reference.
fn noise_ratio(reference: &[Vec3], test: &[Vec3], width: usize) -> f64 {
    // Second differences along rows are zero for smooth shading. Drop the largest quarter of the
    // values, which contains the edges.
    let energy = |pixels: &[Vec3]| {
        let mut all: Vec<f32> = pixels
            .chunks(width)
            .flat_map(|row| row.windows(3).map(|p| (p[0] - 2.0 * p[1] + p[2]).length_squared()))
            .collect();
        all.sort_by(f32::total_cmp);
        let kept = (all.len() * 3 / 4).max(1).min(all.len());
        all[..kept].iter().map(|e| f64::from(*e)).sum::<f64>().max(1e-9)
    };
    energy(test) / energy(reference)
}

/// Describes a difference of the mean that no mistake explains.
fn of_mean(mean: MeanDifference) -> String {
    let percent = 100.0 * (mean.ratio - 1.0);
    let how = if percent < 0.0 { "darker" } else { "brighter" };
    let what = if mean.whole { "the picture is" } else { "a part of the picture is" };
    format!(
        "cause unknown: {what} {:.1} % {how} on average, which is more than noise, but none of the known mistakes \
         explains it",
        percent.abs()
    )
}

/// Describes how the noise of two pictures differs if their means do not. `ratio` is the variance
/// of the test picture divided by that of the reference.
fn of_noise(ratio: f64) -> String {
    let times = |ratio: f64| if ratio > 20.0 { "far more than ten".to_string() } else { format!("about {ratio:.1}") };
    if ratio > NOISE_RATIO {
        format!(
            "no difference of the mean can be measured, but the noise has {} times the variance of the reference \
             (fewer samples, or lights that paths hit only by chance)",
            times(ratio)
        )
    } else if 1.0 / ratio > NOISE_RATIO {
        format!(
            "no difference of the mean can be measured, but the noise of the reference has {} times the variance \
             (the reference has fewer samples)",
            times(1.0 / ratio)
        )
    } else {
        "the difference is noise from different random numbers; no other difference can be measured".to_string()
    }
}
