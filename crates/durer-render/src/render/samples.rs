//! Sampling of pixel blocks with any of the sampling methods.

use super::aim::{BATCH, Batch, CameraRays, Pixel, PixelRun, PixelSample, SampleGroup};
use super::error::center;
use super::stale;
use super::{Job, PixelRect, Sampling};
use crate::film::Film;
use crate::integrator::{Integrate, Integrator, Whitted};
use crate::world::{MAX_BATCH, World};
use durer_bvh::RayCount;
use durer_scene::camera::Projection;
use durer_scene::math::{Color, Ray, Ray64, Vec2, Vec3};
use durer_scene::sampler::{SampleId, Sampler};
use std::cell::{Cell, RefCell};
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// Error of a function that stopped because the render had been cancelled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Cancelled;

/// Column, row and index of the sample that a thread is working on. Panic messages use them.
pub(super) type SampleCursor = Cell<(u32, u32, Option<u32>)>;

/// Returns a function that visits the samples of a pixel. It passes their position in the picture,
/// their position on the lens, and their weight. If samples affect several pixels, it visits only
/// the samples of the pixel itself.
pub fn sample_places(world: &World, job: &Job) -> impl Fn(u32, u32, &mut dyn FnMut(Vec2, Vec2, f32)) + Sync {
    let (aperture, seed, sampling) = (world.camera().has_aperture(), job.seed, job.sampling);
    let warp = match sampling {
        Sampling::Filtered { filter, .. } => Some(filter.sampler()),
        _ => None,
    };
    let lens = move |sampler: Sampler, x, y, sample| match aperture {
        true => sampler.lens_position(seed, x, y, sample),
        false => Vec2::splat(0.5),
    };
    move |x, y, offer| match (sampling, &warp) {
        (Sampling::Filtered { samples, .. }, Some(warp)) => (0..samples).for_each(|sample| {
            let (offset, weight) = warp.sample(Sampler::Sobol.pixel_position(seed, x, y, sample, samples));
            offer(center(x, y) + offset, lens(Sampler::Sobol, x, y, sample), weight);
        }),
        (Sampling::Course2004 { sampler, samples, .. }, _) => {
            let samples = sampler.round_up(samples);
            (0..samples).for_each(|sample| {
                let position = sampler.pixel_position(seed, x, y, sample, samples);
                offer(Vec2::new(x as f32, y as f32) + position, lens(sampler, x, y, sample), 1.0);
            });
        }
        (Sampling::Course2012 { jitter: true, .. }, _) => (0..9_u8).for_each(|i| {
            let part = Vec2::new(f32::from(i % 3), f32::from(i / 3));
            offer(center(x, y) + (part - 1.0) / 3.0, Vec2::splat(0.5), 1.0);
        }),
        _ => offer(center(x, y), Vec2::splat(0.5), 1.0),
    }
}

/// Consecutive samples of one pixel whose camera rays have been generated.
struct Run {
    x: u32,
    y: u32,
    /// Id of the first sample of the pixel.
    id: SampleId,
    /// Index of the first sample of the run within its pixel.
    first: u32,
    /// Index of the weight of the first sample in [`SampleRays::weights`].
    start: usize,
}

/// Maximum number of samples that are generated before they are traced.
const CAPACITY: usize = MAX_BATCH + BATCH;

/// Buffer of generated samples with their camera rays, which are traced together.
struct SampleRays {
    runs: Vec<Run>,
    /// Number of samples in the buffer.
    count: usize,
    /// Weight of each sample.
    weights: [f32; CAPACITY],
    /// Number of samples that have a camera ray.
    ray_count: usize,
    /// Camera ray of each sample that has one.
    rays: [Ray64; CAPACITY],
    /// Index of the run and index within the pixel for each sample that has a camera ray.
    of: [(u32, u32); CAPACITY],
    colors: [Color; CAPACITY],
}

impl Default for SampleRays {
    fn default() -> Self {
        let ray = Ray64::from(Ray::new(Vec3::ZERO, Vec3::X));
        SampleRays {
            runs: Vec::new(),
            count: 0,
            weights: [0.0; CAPACITY],
            ray_count: 0,
            rays: [ray; CAPACITY],
            of: [(0, 0); CAPACITY],
            colors: [Color::ZERO; CAPACITY],
        }
    }
}

impl SampleRays {
    fn clear(&mut self) {
        self.runs.clear();
        (self.count, self.ray_count) = (0, 0);
    }

    /// Returns the index of the run for a sample whose weight will be stored at the index `place`.
    /// Starts a new run unless the sample continues the last run.
    fn run_of(&mut self, pixel: &Pixel, number: u32, place: usize) -> u32 {
        let goes_on = |run: &Run| (run.x, run.y, run.first + (place - run.start) as u32) == (pixel.x, pixel.y, number);
        if !self.runs.last().is_some_and(goes_on) {
            let &Pixel { x, y, id, .. } = pixel;
            self.runs.push(Run { x, y, id, first: number, start: place });
        }
        self.runs.len() as u32 - 1
    }
}

thread_local! {
    static SAMPLE_RAYS: RefCell<Option<Box<SampleRays>>> = RefCell::default();
}

/// Source of the samples of a job. It generates their camera rays, traces the rays and adds the
/// samples to a film.
pub(super) struct SampleSource<'a> {
    pub(super) world: &'a World,
    pub(super) job: &'a Job,
    pub(super) aim: CameraRays<'a>,
    pub(super) whitted: Whitted<'a>,
    pub(super) integrator: Integrator<'a>,
    /// Contribution of the quirk in [`stale`] to each pixel of the full picture. The list is empty
    /// if the quirk does not apply.
    stale: Vec<Color>,
    stop: &'a AtomicBool,
}

impl<'a> SampleSource<'a> {
    pub(super) fn new(world: &'a World, job: &'a Job, stop: &'a AtomicBool) -> Self {
        let mut samples = Self::without_quirks(world, job, stop);
        if stale::applies(world, job) {
            samples.stale = stale::differences(world, job, &samples.aim.raster, || samples.check().is_err());
        }
        samples
    }

    /// Creates the source without the quirk in [`stale`], which needs a pass over the full picture.
    pub(super) fn without_quirks(world: &'a World, job: &'a Job, stop: &'a AtomicBool) -> Self {
        let whitted = Whitted { world, settings: job.settings, cancel: Some(stop) };
        let integrator = job.integrator(world, Some(stop));
        SampleSource { world, job, aim: CameraRays::new(world, job), whitted, integrator, stale: Vec::new(), stop }
    }

    /// Returns the magnitude of the sample weights.
    pub(super) fn gain(&self) -> f32 {
        self.aim.gain()
    }

    /// Returns an error if the render has been cancelled.
    pub(super) fn check(&self) -> Result<(), Cancelled> {
        if self.stop.load(Relaxed) { Err(Cancelled) } else { Ok(()) }
    }

    /// Adds samples to the pixels in the rectangle of a film. `ranges` returns the range of samples
    /// for each pixel. Pixels are numbered in reading order.
    pub(super) fn add(
        &self,
        film: &mut Film,
        part: PixelRect,
        ranges: impl Fn(usize) -> Range<u32>,
        at: &SampleCursor,
        rays: &mut RayCount,
    ) -> Result<(), Cancelled> {
        let mut batch = Batch::new(self.aim.pixel(part.left, part.top));
        let mut buffer = SAMPLE_RAYS.take().unwrap_or_default();
        for (index, (x, y)) in part.pixel_positions().enumerate() {
            let pixel = self.aim.pixel(x, y);
            let mut numbers = ranges(index);
            while !numbers.is_empty() {
                let first = numbers.start;
                at.set((x, y, Some(first)));
                if batch.len() == 0 && numbers.len() >= BATCH {
                    // This is the fast path. Consecutive samples of one pixel share their data.
                    self.aim_several(&PixelRun { pixel: &pixel, first }, &mut buffer);
                    numbers.start += BATCH as u32;
                } else {
                    numbers.start += 1;
                    if !batch.push(&pixel, first) {
                        continue;
                    }
                    self.aim_several(&batch, &mut buffer);
                    batch.clear();
                }
                if buffer.count >= MAX_BATCH {
                    self.add_aimed(film, &mut buffer, at, rays)?;
                }
            }
        }
        self.aim_several(&batch, &mut buffer);
        self.add_aimed(film, &mut buffer, at, rays)?;
        SAMPLE_RAYS.set(Some(buffer));
        // The results are meaningless after cancellation.
        self.check()
    }

    /// Generates the camera rays of a group of samples.
    fn aim_several(&self, of: &impl SampleGroup, buffer: &mut SampleRays) {
        let (start, mut runs) = (buffer.count, [0; BATCH]);
        for (i, run) in runs[..of.len()].iter_mut().enumerate() {
            *run = buffer.run_of(of.pixel(i), of.number(i), start + i);
        }
        self.aim.sample_group(of, |i, ray, weight| {
            if let Some(ray) = ray {
                buffer.rays[buffer.ray_count] = Ray64::from(ray);
                buffer.of[buffer.ray_count] = (runs[i], of.number(i));
                buffer.ray_count += 1;
            }
            buffer.weights[start + i] = weight;
        });
        buffer.count += of.len();
    }

    /// Traces the generated samples, adds their colours to the film and clears the buffer.
    fn add_aimed(
        &self,
        film: &mut Film,
        buffer: &mut SampleRays,
        at: &SampleCursor,
        rays: &mut RayCount,
    ) -> Result<(), Cancelled> {
        self.check()?;
        let SampleRays { runs, count, weights, ray_count, rays: aims, of, colors } = &mut *buffer;
        let (of, colors) = (&of[..*ray_count], &mut colors[..*ray_count]);
        let begin = |ray: usize| {
            let (run, sample) = of[ray];
            let Run { x, y, id, .. } = runs[run as usize];
            at.set((x, y, Some(sample)));
            id.with_sample(sample)
        };
        self.integrator.radiances(&aims[..*ray_count], begin, rays, colors);
        let mut next = 0;
        for (number, run) in runs.iter().enumerate() {
            let end = runs.get(number + 1).map_or(*count, |next| next.start);
            let own = of[next..].iter().take_while(|(run, _)| *run == number as u32).count();
            let (of, colors) = (&of[next..next + own], &mut colors[next..next + own]);
            next += own;
            for color in &mut *colors {
                *color = self.with_stale((run.x, run.y), *color);
            }
            let weights = &weights[run.start..end];
            if own == weights.len() {
                film.add_samples(run.x, run.y, run.first, colors, weights);
                continue;
            }
            let mut traced = of.iter().zip(&*colors).peekable();
            for (sample, &weight) in (run.first..).zip(weights) {
                let color = traced.next_if(|((_, seen), _)| *seen == sample).map(|(_, &color)| color);
                film.add_optional(run.x, run.y, sample, color.or(self.job.missed_color()), weight);
            }
        }
        buffer.clear();
        Ok(())
    }

    /// Takes one sample of a pixel. Returns its weight and its colour. The colour is `None` if the
    /// camera has no ray there and the job has no colour for such samples.
    pub(super) fn sample(&self, x: u32, y: u32, sample: u32, rays: &mut RayCount) -> (Option<Color>, f32) {
        let pixel = self.aim.pixel(x, y);
        let PixelSample { ray, weight, .. } = self.aim.sample(&pixel, sample);
        let color = ray.map(|ray| self.integrator.radiance(&ray, pixel.id.with_sample(sample), rays));
        (color.map(|color| self.with_stale((x, y), color)).or(self.job.missed_color()), weight)
    }

    /// Adds the contribution of the quirk in [`stale`] to a colour.
    fn with_stale(&self, (x, y): (u32, u32), color: Color) -> Color {
        let stale = self.stale.get(y as usize * self.job.width as usize + x as usize);
        stale.map_or(color, |&stale| color + stale)
    }

    /// Generates a sample. This works only for sampling methods in which a sample affects a single
    /// pixel.
    pub(super) fn aim(&self, x: u32, y: u32, sample: u32) -> PixelSample {
        self.aim.sample(&self.aim.pixel(x, y), sample)
    }
}

#[cfg(test)]
mod tests;
