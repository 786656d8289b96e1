//! Explanation of a pixel's colour. It lists all samples with the tree of terms that each sample
//! consists of.

pub mod check;
mod course;
mod derivations;
mod firefly;
mod numbers;
mod text;

use super::aim::PixelSample;
use super::allocation::pilot;
use super::confidence::{ErrorBound, bias_corrected};
use super::control::RunLimit;
use super::samples::SampleSource;
use super::stale;
pub use super::sub_pixels::SubPixels;
use super::{Blocks, Control, Job, PartialRender, PixelRect, RenderError, Sampling, Shard, raster, render};
use crate::film::Film;
use crate::film::aov::{Aov, PixelStatistics};
use crate::integrator::{Integrate, Integrator, TraceRecorder, Tree};
use crate::world::World;
use durer_scene::math::{Color, Ray, Vec2, Vec3};
use durer_scene::sampler::SampleId;
pub use numbers::{number, vector};
use serde::Serialize;
use std::sync::atomic::AtomicBool;
pub use text::{ExplainOptions, SceneNames, TextLine, ray_text};

/// Explanation of the colour of a pixel for `durer explain`. It contains the pixel's samples and
/// everything that contributed to them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Explanation {
    /// Column of the pixel, counted from the left.
    pub x: u32,
    /// Row of the pixel, counted from the top.
    pub y: u32,
    /// Colour of the pixel as stored in a floating-point file.
    pub color: Color,
    /// Coverage.
    pub coverage: f32,
    /// The way in which the samples are combined. See [`Explanation::sum`].
    pub mean: SampleCombination,
    /// Samples of the pixel in the order in which they are added.
    pub samples: Vec<ExplainedSample>,
    /// Colour that is added by the quirk `stale-texels` of an official program.
    pub stale_texels: Option<Color>,
    /// Bound on the error of the pixel. It exists for path tracing with more than one sample.
    pub error: Option<ErrorBound>,
}

/// The way in which the samples of an explained pixel are combined into its colour.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case", tag = "kind")]
pub enum SampleCombination {
    /// Weighted mean of the pixel's own samples, computed with the exact sums of the film.
    Own,
    /// Combination of the Fall 2004 course. The pixel is the weighted mean of its own samples and
    /// the samples of its neighbours, summed in double precision.
    #[serde(rename = "around")]
    Neighbors,
    /// Combination of the Fall 2012 course. The sub-pixels are blurred along rows, then blurred
    /// along columns, and then averaged. The weights of the samples include all three steps.
    SubPixels(SubPixels),
}

/// A sample of an explained pixel with the trace of its light.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ExplainedSample {
    /// Column and row of the pixel that the sample belongs to. This is usually the explained pixel.
    pub of: (u32, u32),
    /// Index of the sample within that pixel.
    pub sample: u32,
    /// Position in the picture, in pixels from the upper left corner.
    pub place: Vec2,
    /// Position on the lens in [0,1)^2.
    pub lens: Vec2,
    /// Weight of the sample in the explained pixel. The weights are not normalized.
    pub weight: f32,
    /// Trace of the sample's light. It is `null` in JSON if the camera has no ray there, or if the
    /// ray hits nothing and the job replaces the background.
    pub light: Option<Tree>,
    /// Colour of the sample if the job replaces the background by a colour and `light` is `null`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub backdrop: Option<Color>,
}

impl ExplainedSample {
    /// Returns the colour of the sample, or `None` if it is transparent.
    fn color(&self) -> Option<Color> {
        self.light.as_ref().map(Tree::sum).or(self.backdrop)
    }
}

impl Explanation {
    /// Computes the colour and coverage of the pixel from the traces, with the same arithmetic as a
    /// render.
    pub fn sum(&self) -> (Color, f32) {
        let mut film = Film::window(self.x, self.y, 1, 1);
        let light = |s: &ExplainedSample| match (&s.light, self.stale_texels) {
            (Some(light), Some(stale)) => Some(light.sum() + stale),
            _ => s.color(),
        };
        if self.mean == SampleCombination::Own {
            for s in &self.samples {
                film.add_optional(self.x, self.y, s.sample, light(s), s.weight);
            }
        } else {
            let finished = course::finished(&self.mean, &self.samples, light);
            film.add_with_coverage(self.x, self.y, 0, finished, 1.0);
        }
        (film.resolve(self.x, self.y), film.coverage(self.x, self.y))
    }

    /// Returns the index of the first sample with the greatest weight.
    pub fn max_weight_index(&self) -> usize {
        (1..self.samples.len())
            .fold(0, |best, i| if self.samples[i].weight > self.samples[best].weight { i } else { best })
    }
}

/// Returns the trace of a ray whose direction has unit length, like that of a camera ray. `id`
/// selects the random numbers.
pub fn explain_ray(world: &World, job: &Job, ray: &Ray, id: SampleId) -> Option<Tree> {
    trace_tree(&job.integrator(world, None), ray, id)
}

/// Traces a camera ray and returns the tree of terms that make up its light.
fn trace_tree(integrator: &Integrator, ray: &Ray, id: SampleId) -> Option<Tree> {
    let mut account = TraceRecorder::default();
    integrator.radiance(ray, id, &mut account);
    account.into_tree()
}

/// Explains a pixel of a job's colour picture.
///
/// # Errors
///
/// Returns a [`RenderError`] if the pixel is outside the picture, or if the rendering that
/// determines the adaptive number of samples fails.
pub fn explain(world: &World, job: &Job, x: u32, y: u32) -> Result<Explanation, RenderError> {
    explain_samples(world, job, (x, y), None)
}

/// Explains a pixel whose number of samples may already be known. If it is unknown, a noise
/// threshold requires rendering the block of the pixel, and adaptive sampling requires rendering a
/// quarter of all samples of the picture.
///
/// # Errors
/// See [`explain`].
pub fn explain_samples(
    world: &World,
    job: &Job,
    (x, y): (u32, u32),
    samples: Option<u32>,
) -> Result<Explanation, RenderError> {
    job.validate()?;
    job.check_world(world)?;
    if x >= job.width || y >= job.height {
        return Err(RenderError::CropOutside(job.width, job.height));
    }
    let (stop, mut stale_texels) = (AtomicBool::new(false), None);
    let source = SampleSource::without_quirks(world, job, &stop);
    let integrator = job.integrator(world, None);
    let account = |of, sample, aim: PixelSample| {
        let id = SampleId::new(job.seed, of, sample);
        let light = aim.ray.and_then(|ray| trace_tree(&integrator, &ray, id));
        let backdrop = if light.is_none() { job.missed_color() } else { None };
        ExplainedSample { of, sample, place: aim.film_position, lens: aim.lens, weight: aim.weight, light, backdrop }
    };
    let (mean, samples) = match job.sampling {
        Sampling::Course2004 { sampler, samples, filter: Some(filter) } => {
            course::around(&source, job, (x, y), (sampler, samples, filter), account)
        }
        Sampling::Course2012 { jitter, blur } => {
            let grid = SubPixels::new(job, PixelRect::pixel((x, y)), jitter, blur);
            course::sub_pixels(&source, world, grid, account)
        }
        _ => {
            let count = samples.map_or_else(|| count(world, job, (x, y)), Ok)?;
            let own = (0..count).map(|sample| account((x, y), sample, source.aim(x, y, sample)));
            (SampleCombination::Own, own.collect())
        }
    };
    if stale::applies(world, job) {
        stale_texels = stale::difference(world, job, &raster(world, job.width, job.height), (x, y));
    }
    let mut explanation =
        Explanation { x, y, color: Vec3::ZERO, coverage: 1.0, mean, samples, stale_texels, error: None };
    (explanation.color, explanation.coverage) = explanation.sum();
    if explanation.mean == SampleCombination::Own
        && explanation.samples.len() > 1
        && job.method.path_options().is_some()
    {
        explanation.error = Some(error(world, job, &source, &explanation));
    }
    Ok(explanation)
}

/// Returns the error bound of a pixel. It is computed from the samples of the pixel and, for photon
/// mapping, from their bias-corrected versions.
fn error(world: &World, job: &Job, source: &SampleSource, explanation: &Explanation) -> ErrorBound {
    let Explanation { x, y, ref samples, .. } = *explanation;
    let film = |color: &dyn Fn(&ExplainedSample) -> Option<Color>| {
        let mut film = Film::window(x, y, 1, 1);
        samples.iter().for_each(|s| film.add_optional(x, y, s.sample, color(s), s.weight));
        film
    };
    let own = film(&ExplainedSample::color);
    let twin = bias_corrected(job.method).map(|method| {
        let integrator = Job { method, ..job.clone() }.integrator(world, None);
        film(&|s| match source.aim(x, y, s.sample).ray {
            Some(ray) => Some(integrator.radiance(&ray, SampleId::new(job.seed, (x, y), s.sample), &mut ())),
            None => s.backdrop,
        })
    });
    let sums = |film| PixelStatistics { pixel: Some((film, x, y)), gain: source.gain(), lumens: None };
    ErrorBound::new(&sums(&own), &sums(twin.as_ref().unwrap_or(&own)))
}

/// Returns the number of samples of a pixel. To determine it, renders the block of the pixel if
/// there is a noise threshold, and the pilot samples of the full picture for adaptive sampling.
fn count(world: &World, job: &Job, (x, y): (u32, u32)) -> Result<u32, RenderError> {
    let samples = job.sampling.samples();
    let window = if job.window().contains(x, y) { job.window() } else { job.whole() };
    if job.adaptive {
        let part = PartialRender::new(world, &Job { crop: Some(window), ..job.clone() }, Shard::WHOLE)?;
        part.render_to(world, &Control::default(), &mut |_, _| {}, RunLimit::Samples(pilot(samples)))?;
        part.allocate();
        return Ok(part.sample_target(x, y).unwrap_or(samples));
    }
    if job.noise.is_none() {
        return Ok(samples);
    }
    let blocks = Blocks::new(window);
    let block = blocks.rect(blocks.index_at(x, y));
    let aovs = Aov::from_name("sample-count").into_iter().collect();
    let counted = render(world, &Job { crop: Some(block), color: false, aovs, ..job.clone() }, &Control::default())?;
    Ok(counted.layers[0].image.get(x - block.left, y - block.top).map_or(0, |count| count.x as u32))
}

#[cfg(test)]
mod tests;
