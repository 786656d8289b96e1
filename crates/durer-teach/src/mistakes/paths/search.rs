//! Finds the path tracer mistake that explains a picture.

use super::blocks::{BlockMeans, Blocks};
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
/// Ratio of variances above which one picture counts as noisier than the other.
const NOISE_RATIO: f64 = 1.5;

/// One mistake with its value, the block means rendered with it, and how well those match the test
/// picture.
struct Trial {
    mistake: (&'static Mistake, f32),
    rendered: BlockMeans,
    explained: f64,
    matched: f64,
}

/// Returns the fraction of the blocks in which a render of the scene differs from the reference by
/// more than noise.
pub fn off(input: &DiagnosisInput) -> f64 {
    let (reference, view, base) = prepare(input);
    let blocks = blocks(input);
    let reference = blocks.of_picture(input.job.width, &reference);
    let base = blocks.render(&view, &base, input.job.seed);
    share_off(&base, &base.with_noise_of(reference, 1.0))
}

fn blocks(input: &DiagnosisInput) -> Blocks {
    Blocks::new(input.job.width, input.job.height, input.job.sampling.samples())
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
    let (reference_pixels, view, base) = prepare(input);
    let test_pixels = values(input.test, view.scale, input.transfer);
    let (width, seed) = (input.job.width, input.job.seed);
    let blocks = blocks(input);
    let [reference, test] = [&reference_pixels, &test_pixels].map(|pixels| blocks.of_picture(width, pixels));
    let own = blocks.render(&view, &base, seed);
    let reference = own.with_noise_of(reference, 1.0);
    let test = own.with_noise_of(test, noise_ratio(&reference_pixels, &test_pixels, width as usize).clamp(0.2, 200.0));
    progress(0.1);
    let off = share_off(&own, &reference);
    let diagnosis = Diagnosis {
        reference_difference: off,
        formulas: Formulas::of(input.scene, input.world.rules()),
        ..Diagnosis::default()
    };
    if off > MAX_DIFFERENCE {
        return diagnosis;
    }
    let total = own.excess_difference(&test, &noise(&own, &test));
    let differing = total.iter().filter(|block| block.1).count();
    if (differing as f64) < MIN_DIFFERENCE * total.len() as f64 {
        return Diagnosis { remark: Some(of_noise(&reference_pixels, &test_pixels, width as usize)), ..diagnosis };
    }
    let trials = trials(&view, &base, &blocks, &test, &own, seed, progress);
    let explanation = decided(trials, &test);
    Diagnosis { explanations: explanation, ..diagnosis }
}

/// Renders the scene with each mistake and measures how much of the difference it explains.
fn trials(
    view: &View,
    base: &SceneVariant,
    blocks: &Blocks,
    test: &BlockMeans,
    own: &BlockMeans,
    seed: u64,
    progress: &(dyn Fn(f64) + Sync),
) -> Vec<Trial> {
    let lights = base.world.lights().len();
    let rows = MISTAKES.iter().flat_map(|row| row.values.numbers(lights).into_iter().map(move |value| (row, value)));
    let all: Vec<(&'static Mistake, f32)> = rows.collect();
    let count = all.len();
    let trial = |(i, mistake): (usize, (&'static Mistake, f32))| {
        let mut variant = base.clone();
        (mistake.0.apply)(&mut variant, mistake.1);
        let rendered = blocks.render(view, &variant, seed);
        progress(0.1 + 0.9 * (i + 1) as f64 / count as f64);
        let noise = noise(&rendered, test);
        let (before, rest) = (own.excess_difference(test, &noise), rendered.excess_difference(test, &noise));
        let sum = |beyond: &[(f64, bool)]| beyond.iter().map(|block| block.0).sum::<f64>();
        let (either, agree) = before.iter().zip(&rest).fold((0, 0), |(either, agree), (before, rest)| {
            (either + usize::from(before.1 || rest.1), agree + usize::from(before.1 && !rest.1))
        });
        let explained = 1.0 - sum(&rest) / sum(&before).max(1e-12);
        Trial { mistake, rendered, explained, matched: f64::from(agree as u32) / f64::from((either as u32).max(1)) }
    };
    all.into_iter().enumerate().map(trial).collect()
}

/// Returns the mistakes that explain the picture. There are none if no mistake fits or if the
/// choice is ambiguous.
fn decided(mut trials: Vec<Trial>, test: &BlockMeans) -> Vec<Explanation> {
    trials.sort_by(|a, b| b.explained.total_cmp(&a.explained));
    let passes = |trial: &&Trial| trial.explained >= MIN_EXPLAINED && trial.matched >= MIN_MATCHED;
    let Some(best) = trials.iter().find(passes) else { return Vec::new() };
    let rest = |trial: &Trial| 1.0 - trial.explained;
    let rivals: Vec<&Trial> =
        trials.iter().filter(passes).filter(|trial| rest(trial) <= RIVAL_RATIO * rest(best) + 0.005).collect();
    // If rivals produce different pictures, naming one of them would be a guess.
    let alike = |other: &Trial| {
        let noise: Vec<f64> = noise(&best.rendered, test);
        best.rendered.excess_difference(&other.rendered, &noise).iter().filter(|block| block.1).count() * 20
            <= test.mean.len()
    };
    if rivals.len() > 3 || !rivals.iter().all(|rival| alike(rival)) {
        return Vec::new();
    }
    let explanation = |trial: &&Trial| Explanation {
        mistakes: vec![trial.mistake],
        explained: trial.explained,
        matched: trial.matched,
    };
    rivals.iter().map(explanation).collect()
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

/// Describes how the noise of two pictures with the same mean differs.
fn of_noise(reference: &[Vec3], test: &[Vec3], width: usize) -> String {
    let ratio = noise_ratio(reference, test, width);
    let times = |ratio: f64| if ratio > 20.0 { "far more than ten".to_string() } else { format!("about {ratio:.1}") };
    if ratio > NOISE_RATIO {
        format!(
            "the mean is correct, but the noise has {} times the variance of the reference (fewer samples, or lights \
             that paths hit only by chance)",
            times(ratio)
        )
    } else if 1.0 / ratio > NOISE_RATIO {
        format!(
            "the mean is correct, but the noise of the reference has {} times the variance (the reference has fewer \
             samples)",
            times(1.0 / ratio)
        )
    } else {
        "the difference is noise from different random numbers; no other difference can be measured".to_string()
    }
}
