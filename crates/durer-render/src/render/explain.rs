//! Why a pixel has its colour: every sample, and the tree of terms that it is the sum of.

pub mod check;
mod course;
mod firefly;
mod text;

use super::aim::PixelSample;
use super::allocation::pilot;
use super::confidence::{ErrorBound, corrected};
use super::control::Until;
use super::samples::Samples;
use super::stale;
pub use super::sub_pixels::SubPixels;
use super::{Blocks, Control, Crop, Job, PartialRender, RenderError, Sampling, Shard, raster, render};
use crate::film::Film;
use crate::film::aov::{Aov, Sums};
use crate::integrator::{Integrate, Integrator, TraceRecorder, Tree};
use crate::world::World;
use durer_scene::math::{Color, Ray, Vec2, Vec3};
use durer_scene::sampler::SampleId;
use serde::Serialize;
use std::sync::atomic::AtomicBool;
pub use text::{Names, Telling, TextLine, number, ray_text};

/// A pixel and all that made it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Explanation {
    /// Column from the left.
    pub x: u32,
    /// Row from the top.
    pub y: u32,
    /// The pixel's colour, as a file of floating point has it.
    pub color: Color,
    /// The share of it that the camera sees at all.
    pub coverage: f32,
    /// How its samples become its colour; see [`Explanation::sum`].
    pub mean: Mean,
    /// Its samples, in the order in which they are summed.
    pub samples: Vec<SampleAccount>,
    /// What an old program's quirk `stale-texels` adds to the colour.
    pub stale_texels: Option<Color>,
    /// How far it may be from the truth, where paths make it of more samples than one.
    pub error: Option<ErrorBound>,
}

/// How samples become a pixel.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case", tag = "kind")]
pub enum Mean {
    /// All are its own; it is their mean by weight, in the film's exact sums.
    Own,
    /// 2004: samples of the pixels around count too; it is the mean by weight, summed in double
    /// precision.
    Around,
    /// 2012: sub-pixels are blurred along rows, then along columns, then averaged. Weights are
    /// those of all this together.
    SubPixels(SubPixels),
}

/// One sample of a pixel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SampleAccount {
    /// Column and row of the pixel that it was taken for: mostly the one that is explained.
    pub of: (u32, u32),
    /// Its number in that pixel.
    pub sample: u32,
    /// Where in the picture it lies, in pixels from the upper left corner.
    pub place: Vec2,
    /// Where in the lens, from 0 to 1.
    pub lens: Vec2,
    /// Its weight in the pixel, not divided by the sum of all.
    pub weight: f32,
    /// The tree of its light; `null` in JSON where the camera sees nothing.
    pub light: Option<Tree>,
}

impl Explanation {
    /// The pixel's colour and coverage, computed anew from the trees by the picture's own
    /// arithmetic.
    pub fn sum(&self) -> (Color, f32) {
        let mut film = Film::window(self.x, self.y, 1, 1);
        let light =
            |s: &SampleAccount| s.light.as_ref().map(|light| light.sum() + self.stale_texels.unwrap_or_default());
        if self.mean == Mean::Own {
            for s in &self.samples {
                film.add_if_seen(self.x, self.y, s.sample, light(s), s.weight);
            }
        } else {
            let finished = course::finished(&self.mean, &self.samples, light);
            film.add_covering(self.x, self.y, 0, finished, 1.0);
        }
        (film.resolve(self.x, self.y), film.coverage(self.x, self.y))
    }

    /// The index of the sample that counts most: the first of those.
    pub fn heaviest(&self) -> usize {
        (1..self.samples.len())
            .fold(0, |best, i| if self.samples[i].weight > self.samples[best].weight { i } else { best })
    }
}

/// The tree of the light along any ray, by the random numbers of a sample.
pub fn explain_ray(world: &World, job: &Job, ray: &Ray, id: SampleId) -> Option<Tree> {
    told(&job.integrator(world, None), ray, id)
}

fn told(integrator: &Integrator, ray: &Ray, id: SampleId) -> Option<Tree> {
    let mut account = TraceRecorder::default();
    integrator.radiance(ray, id, &mut account);
    account.into_tree()
}

/// Why a pixel of the job's colour picture is as it is.
///
/// # Errors
///
/// The pixel does not lie in the picture; [`RenderError`] where how many samples it has is decided
/// by noise.
pub fn explain(world: &World, job: &Job, x: u32, y: u32) -> Result<Explanation, RenderError> {
    explain_of(world, job, (x, y), None)
}

/// The same where it may be known how many samples the pixel has: if noise decides that, it takes
/// some rendering to find out, and of an adaptive picture a quarter of all of it.
///
/// # Errors
/// Those of [`explain`].
pub fn explain_of(
    world: &World,
    job: &Job,
    (x, y): (u32, u32),
    samples: Option<u32>,
) -> Result<Explanation, RenderError> {
    job.validate()?;
    if x >= job.width || y >= job.height {
        return Err(RenderError::CropOutside(job.width, job.height));
    }
    let (stop, mut stale_texels) = (AtomicBool::new(false), None);
    let source = Samples::without_quirks(world, job, &stop);
    let integrator = job.integrator(world, None);
    let account = |of, sample, aim: PixelSample| {
        let id = SampleId::new(job.seed, of, sample);
        let light = aim.ray.and_then(|ray| told(&integrator, &ray, id));
        SampleAccount { of, sample, place: aim.place, lens: aim.lens, weight: aim.weight, light }
    };
    let (mean, samples) = match job.sampling {
        Sampling::Course2004 { sampler, samples, filter: Some(filter) } => {
            course::around(&source, job, (x, y), (sampler, samples, filter), account)
        }
        Sampling::Course2012 { jitter, blur } => {
            let grid = SubPixels::new(job, Crop::pixel((x, y)), jitter, blur);
            course::sub_pixels(&source, world, grid, account)
        }
        _ => {
            let count = samples.map_or_else(|| count(world, job, (x, y)), Ok)?;
            let own = (0..count).map(|sample| account((x, y), sample, source.aim(x, y, sample)));
            (Mean::Own, own.collect())
        }
    };
    if stale::applies(world, job) {
        stale_texels = stale::difference(world, job, &raster(world, job.width, job.height), (x, y));
    }
    let mut explanation =
        Explanation { x, y, color: Vec3::ZERO, coverage: 1.0, mean, samples, stale_texels, error: None };
    (explanation.color, explanation.coverage) = explanation.sum();
    if explanation.mean == Mean::Own && explanation.samples.len() > 1 && job.method.transport().is_some() {
        explanation.error = Some(error(world, job, &source, &explanation));
    }
    Ok(explanation)
}

/// How far a pixel may be from the truth: from its samples, and for photons from the same samples
/// without their bias.
fn error(world: &World, job: &Job, source: &Samples, explanation: &Explanation) -> ErrorBound {
    let Explanation { x, y, ref samples, .. } = *explanation;
    let film = |color: &dyn Fn(&SampleAccount) -> Option<Color>| {
        let mut film = Film::window(x, y, 1, 1);
        samples.iter().for_each(|s| film.add_if_seen(x, y, s.sample, color(s), s.weight));
        film
    };
    let own = film(&|s| s.light.as_ref().map(Tree::sum));
    let twin = corrected(job.method).map(|method| {
        let integrator = Job { method, ..job.clone() }.integrator(world, None);
        film(&|s| {
            let ray = source.aim(x, y, s.sample).ray?;
            Some(integrator.radiance(&ray, SampleId::new(job.seed, (x, y), s.sample), &mut ()))
        })
    });
    let sums = |film| Sums { pixel: Some((film, x, y)), gain: source.gain(), lumens: None };
    ErrorBound::new(&sums(&own), &sums(twin.as_ref().unwrap_or(&own)))
}

/// How many samples a pixel has: where noise decides, as many as its block needs, or as it gets by
/// the pilot's samples of all of the picture.
fn count(world: &World, job: &Job, (x, y): (u32, u32)) -> Result<u32, RenderError> {
    let samples = job.sampling.samples();
    let window = if job.window().holds(x, y) { job.window() } else { job.whole() };
    if job.adaptive {
        let part = PartialRender::new(world, &Job { crop: Some(window), ..job.clone() }, Shard::WHOLE)?;
        part.render_to(world, &Control::default(), &mut |_, _| {}, Until::Samples(pilot(samples)))?;
        part.allocate();
        return Ok(part.target(x, y).unwrap_or(samples));
    }
    if job.noise.is_none() {
        return Ok(samples);
    }
    let blocks = Blocks::new(window);
    let block = blocks.rect(blocks.at(x, y));
    let aovs = Aov::from_name("sample-count").into_iter().collect();
    let counted = render(world, &Job { crop: Some(block), color: false, aovs, ..job.clone() }, &Control::default())?;
    Ok(counted.layers[0].image.get(x - block.left, y - block.top).map_or(0, |count| count.x as u32))
}

#[cfg(test)]
mod tests;
