//! How the samples of a block are taken, for each way of sampling.

use super::aim::{Aim, BATCH, Batch, Pixel, PixelSample, Row, Several};
use super::error::{MAX_KEPT, center};
use super::sub_pixels::SubPixels;
use super::{Control, Crop, Job, RenderError, Sampling, center_ray};
use crate::film::Film;
use crate::film::course::{CourseFilter, StoredSample, StoredSamples};
use crate::integrator::{Integrate, Integrator, Whitted};
use crate::threads;
use crate::world::{Material, TOGETHER, World};
use durer_bvh::RayCount;
use durer_scene::camera::Projection;
use durer_scene::math::{Color, Ray, Ray64, Vec2, Vec3};
use durer_scene::sampler::{SampleId, Sampler};
use std::cell::{Cell, RefCell};
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// The work was stopped before it was finished.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Stopped;

/// Column, row and number of the sample that a thread is at.
pub(super) type SampleCursor = Cell<(u32, u32, Option<u32>)>;

/// Where the samples of a job lie, with their colours: for its diagram.
///
/// # Errors
/// [`RenderError`], among them [`RenderError::TooManySamples`].
pub fn sample_diagram(world: &World, job: &Job, control: &Control) -> Result<StoredSamples, RenderError> {
    let (sampler, samples) = match job.sampling {
        Sampling::Course2004 { sampler, samples, .. } => (sampler, samples),
        Sampling::Filtered { samples, .. } => (Sampler::Sobol, samples),
        Sampling::Center | Sampling::Course2012 { .. } => (Sampler::Uniform, 1),
    };
    let samples = sampler.round_up(samples);
    let count = job.whole().pixels().saturating_mul(samples.into());
    if count > MAX_KEPT {
        return Err(RenderError::TooManySamples(count));
    }
    let work = || {
        let (at, mut rays) = (Cell::new((0, 0, None)), RayCount::default());
        let source = Samples::new(world, job, &control.cancel);
        source.stored(&Show::default(), job.whole(), (sampler, samples), &at, |_, _| true, &mut rays)
    };
    threads::install(control.threads, work).map_err(|Stopped| RenderError::Cancelled)
}

/// Offers where the samples of a pixel go: in the picture, in the lens, and how much each counts.
/// Of samples that count for other pixels too only the pixel's own are offered.
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

/// Bytes of the samples that are kept at once for a tile, where samples count for other pixels too.
pub(super) fn kept_bytes(job: &Job, side: u32) -> u64 {
    match job.sampling {
        Sampling::Course2004 { sampler, samples, filter: Some(filter) } => {
            let across = u64::from(side) + 2 * u64::from(filter.support());
            across * across * u64::from(sampler.round_up(samples)) * size_of::<StoredSample>() as u64
        }
        // The picture, what is blurred of it along rows, and then along columns.
        Sampling::Course2012 { .. } => 3 * 9 * 12 * u64::from(side + 2) * u64::from(side + 2),
        _ => 0,
    }
}

/// What the course's ways of sampling are made to show. They know colours only: where the camera
/// sees nothing somewhere, it is shown a second time, white where the camera sees and black
/// elsewhere.
#[derive(Default)]
struct Show {
    mask: bool,
    /// Whether the camera saw nothing at some sample.
    blind: Cell<bool>,
}

/// The share of a pixel that is seen, of what is shown white where the camera sees. Sums of a
/// filter's weights are a little off: what is nearly all is all.
pub(super) fn share(white: Color) -> f32 {
    if white.x > 1.0 - 1e-6 { 1.0 } else { white.x.max(0.0) }
}

/// Samples of a pixel that were aimed, one after the other.
struct Run {
    x: u32,
    y: u32,
    /// The pixel's first sample.
    id: SampleId,
    /// The number of the first that was aimed, and where its weight is.
    first: u32,
    start: usize,
}

/// At most so many samples are aimed before their light is asked for.
const ROOM: usize = TOGETHER + BATCH;

/// Samples that were aimed.
struct Aimed {
    runs: Vec<Run>,
    /// How many there are, and their weights.
    count: usize,
    weights: [f32; ROOM],
    /// How many of them the camera sees anything at: their rays, and of each the number of its run
    /// and that of its sample.
    seen: usize,
    rays: [Ray64; ROOM],
    of: [(u32, u32); ROOM],
    colors: [Color; ROOM],
}

impl Default for Aimed {
    fn default() -> Self {
        let ray = Ray64::from(Ray::new(Vec3::ZERO, Vec3::X));
        Aimed {
            runs: Vec::new(),
            count: 0,
            weights: [0.0; ROOM],
            seen: 0,
            rays: [ray; ROOM],
            of: [(0, 0); ROOM],
            colors: [Color::ZERO; ROOM],
        }
    }
}

impl Aimed {
    fn clear(&mut self) {
        self.runs.clear();
        (self.count, self.seen) = (0, 0);
    }

    /// The run that a sample belongs to, whose weight will be at a place.
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
    static AIMED: RefCell<Option<Box<Aimed>>> = RefCell::default();
}

/// Takes the samples of a job.
pub(super) struct Samples<'a> {
    world: &'a World,
    job: &'a Job,
    pub(super) aim: Aim<'a>,
    pub(super) whitted: Whitted<'a>,
    pub(super) integrator: Integrator<'a>,
    /// What [`ShadingRules::stale_texels`] adds to each pixel of the whole picture.
    stale: Vec<Color>,
    stop: &'a AtomicBool,
}

impl<'a> Samples<'a> {
    pub(super) fn new(world: &'a World, job: &'a Job, stop: &'a AtomicBool) -> Self {
        let mut samples = Self::without_habits(world, job, stop);
        if job.sampling == Sampling::Center && world.shading_rules().stale_texels {
            samples.stale = samples.stale_texels();
        }
        samples
    }

    /// The same without what [`ShadingRules::stale_texels`] adds, which takes a look at the whole picture.
    pub(super) fn without_habits(world: &'a World, job: &'a Job, stop: &'a AtomicBool) -> Self {
        let whitted = Whitted { world, settings: job.settings, cancel: Some(stop) };
        let integrator = job.integrator(world, Some(stop));
        Samples { world, job, aim: Aim::new(world, job), whitted, integrator, stale: Vec::new(), stop }
    }

    /// The size of a sample's weight.
    pub(super) fn gain(&self) -> f32 {
        self.aim.gain()
    }

    pub(super) fn check(&self) -> Result<(), Stopped> {
        if self.stop.load(Relaxed) { Err(Stopped) } else { Ok(()) }
    }

    /// Adds samples of every pixel of a film's part, whose pixels are numbered row by row.
    pub(super) fn add(
        &self,
        film: &mut Film,
        part: Crop,
        ranges: impl Fn(usize) -> Range<u32>,
        at: &SampleCursor,
        rays: &mut RayCount,
    ) -> Result<(), Stopped> {
        let mut batch = Batch::new(self.aim.pixel(part.left, part.top));
        let mut aimed = AIMED.take().unwrap_or_default();
        for (index, (x, y)) in part.places().enumerate() {
            let pixel = self.aim.pixel(x, y);
            let mut numbers = ranges(index);
            while !numbers.is_empty() {
                let first = numbers.start;
                at.set((x, y, Some(first)));
                if batch.len() == 0 && numbers.len() >= BATCH {
                    // What samples of one pixel have in common is worked with once.
                    self.aim_several(&Row { pixel: &pixel, first }, &mut aimed);
                    numbers.start += BATCH as u32;
                } else {
                    numbers.start += 1;
                    if !batch.push(&pixel, first) {
                        continue;
                    }
                    self.aim_several(&batch, &mut aimed);
                    batch.clear();
                }
                if aimed.count >= TOGETHER {
                    self.add_aimed(film, &mut aimed, at, rays)?;
                }
            }
        }
        self.aim_several(&batch, &mut aimed);
        self.add_aimed(film, &mut aimed, at, rays)?;
        AIMED.set(Some(aimed));
        // What was made after a cancel means nothing.
        self.check()
    }

    /// Aims some samples.
    fn aim_several(&self, of: &impl Several, aimed: &mut Aimed) {
        let (start, mut runs) = (aimed.count, [0; BATCH]);
        for (i, run) in runs[..of.len()].iter_mut().enumerate() {
            *run = aimed.run_of(of.pixel(i), of.number(i), start + i);
        }
        self.aim.several(of, |i, ray, weight| {
            if let Some(ray) = ray {
                aimed.rays[aimed.seen] = Ray64::from(ray);
                aimed.of[aimed.seen] = (runs[i], of.number(i));
                aimed.seen += 1;
            }
            aimed.weights[start + i] = weight;
        });
        aimed.count += of.len();
    }

    /// Adds samples that were aimed, of which there are none left then.
    fn add_aimed(
        &self,
        film: &mut Film,
        aimed: &mut Aimed,
        at: &SampleCursor,
        rays: &mut RayCount,
    ) -> Result<(), Stopped> {
        self.check()?;
        let Aimed { runs, count, weights, seen, rays: aims, of, colors } = &mut *aimed;
        let (of, colors) = (&of[..*seen], &mut colors[..*seen]);
        let begin = |ray: usize| {
            let (run, sample) = of[ray];
            let Run { x, y, id, .. } = runs[run as usize];
            at.set((x, y, Some(sample)));
            id.of_sample(sample)
        };
        self.integrator.radiances(&aims[..*seen], begin, rays, colors);
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
                film.add_seen(run.x, run.y, run.first, colors, weights);
                continue;
            }
            let mut seen = of.iter().zip(&*colors).peekable();
            for (sample, &weight) in (run.first..).zip(weights) {
                let color = seen.next_if(|((_, seen), _)| *seen == sample).map(|(_, &color)| color);
                film.add_if_seen(run.x, run.y, sample, color, weight);
            }
        }
        aimed.clear();
        Ok(())
    }

    /// One sample of a pixel: its colour, if the camera sees anything there, and its weight.
    pub(super) fn sample(&self, x: u32, y: u32, sample: u32, rays: &mut RayCount) -> (Option<Color>, f32) {
        let pixel = self.aim.pixel(x, y);
        let PixelSample { ray, weight, .. } = self.aim.sample(&pixel, sample);
        let color = ray.map(|ray| self.integrator.radiance(&ray, pixel.id.of_sample(sample), rays));
        (color.map(|color| self.with_stale((x, y), color)), weight)
    }

    fn with_stale(&self, (x, y): (u32, u32), color: Color) -> Color {
        let stale = self.stale.get(y as usize * self.job.width as usize + x as usize);
        stale.map_or(color, |&stale| color + stale)
    }

    /// Where a sample of a pixel goes, for samplings whose samples count for their own pixel alone.
    pub(super) fn aim(&self, x: u32, y: u32, sample: u32) -> PixelSample {
        self.aim.sample(&self.aim.pixel(x, y), sample)
    }

    /// The finished pixels of a part with their coverage, for samplings whose samples count for
    /// other pixels too. Samples around the part that are needed for it are taken for it alone.
    pub(super) fn finished(
        &self,
        part: Crop,
        at: &SampleCursor,
        rays: &mut RayCount,
    ) -> Result<Vec<(Color, f32)>, Stopped> {
        let show = Show::default();
        let colors = self.shown(&show, part, at, rays)?;
        if !show.blind.get() {
            return Ok(colors.into_iter().map(|color| (color, 1.0)).collect());
        }
        let mask = self.shown(&Show { mask: true, ..Show::default() }, part, at, &mut RayCount::default())?;
        Ok(colors.into_iter().zip(mask).map(|(color, white)| (color, share(white))).collect())
    }

    fn shown(&self, show: &Show, part: Crop, at: &SampleCursor, rays: &mut RayCount) -> Result<Vec<Color>, Stopped> {
        match self.job.sampling {
            Sampling::Course2004 { sampler, samples, filter: Some(filter) } => {
                self.course_2004(show, part, (sampler, sampler.round_up(samples)), filter, at, rays)
            }
            Sampling::Course2012 { jitter, blur } => self.course_2012(show, part, (jitter, blur), at, rays),
            _ => unreachable!("other samplings add their samples to a film"),
        }
    }

    /// The colour of a sample that is kept.
    fn kept(&self, show: &Show, aim: &PixelSample, id: SampleId, rays: &mut RayCount) -> Color {
        show.blind.set(show.blind.get() || aim.ray.is_none());
        let light = |ray| if show.mask { Vec3::ONE } else { self.integrator.radiance(&ray, id, rays) };
        aim.ray.map_or(Vec3::ZERO, light)
    }

    fn course_2004(
        &self,
        show: &Show,
        part: Crop,
        sampling: (Sampler, u32),
        filter: CourseFilter,
        at: &SampleCursor,
        rays: &mut RayCount,
    ) -> Result<Vec<Color>, Stopped> {
        let around = part.grown(filter.support(), self.job.whole());
        let stored = self.stored(show, around, sampling, at, |x, y| part.holds(x, y), rays)?;
        let from = (part.left - around.left, part.top - around.top);
        stored.try_reconstruct(filter, from, (part.width, part.height), || self.check())
    }

    /// All samples of a part of the picture; only rays of the wanted pixels are counted.
    fn stored(
        &self,
        show: &Show,
        part: Crop,
        sampling: (Sampler, u32),
        at: &SampleCursor,
        counted: impl Fn(u32, u32) -> bool,
        rays: &mut RayCount,
    ) -> Result<StoredSamples, Stopped> {
        StoredSamples::try_take(part.width, part.height, sampling.1, |column, row, sample| {
            self.check()?;
            let (x, y) = (part.left + column, part.top + row);
            at.set((x, y, Some(sample)));
            let (aim, position) = self.aim.kept(sampling, x, y, sample);
            let mut own = RayCount::default();
            let color = self.kept(show, &aim, SampleId::new(self.job.seed, (x, y), sample), &mut own);
            rays.0 += if counted(x, y) { own.0 } else { 0 };
            Ok(StoredSample { position, color })
        })
    }

    /// `-jitter` and `-filter` of 2012. Blur without jitter works on the picture as it is.
    fn course_2012(
        &self,
        show: &Show,
        part: Crop,
        (jitter, blurred): (bool, bool),
        at: &SampleCursor,
        rays: &mut RayCount,
    ) -> Result<Vec<Color>, Stopped> {
        let grid = SubPixels::new(self.job, part, jitter, blurred);
        let raster = grid.raster(self.world);
        let mut pixels = Vec::with_capacity(grid.around.pixels() as usize);
        for (x, y) in grid.around.places() {
            self.check()?;
            let pixel = grid.pixel((x, y));
            at.set((pixel.0, pixel.1, None));
            let mut own = RayCount::default();
            let id = SampleId::new(self.job.seed, pixel, grid.number((x, y)));
            pixels.push(self.kept(show, &self.aim.sub_pixel(&grid, &raster, (x, y)), id, &mut own));
            rays.0 += if grid.inner.holds(x, y) { own.0 } else { 0 };
        }
        let pixels = grid.develop(pixels);
        self.check()?;
        Ok(pixels)
    }

    /// The difference, at each pixel of the whole picture, between the ambient light on its texture
    /// and that of the pixel shaded before with the same material.
    fn stale_texels(&self) -> Vec<Color> {
        let (world, job) = (self.world, self.job);
        let mut last: Vec<Option<Color>> = vec![None; world.materials().len()];
        let mut differences = vec![Color::ZERO; job.whole().pixels() as usize];
        for (y, x) in (0..job.height).rev().flat_map(|y| (0..job.width).map(move |x| (y, x))) {
            if self.check().is_err() {
                break;
            }
            let Some(ray) = center_ray(world, &self.aim.raster, (x, y)) else { continue };
            let Some(at) = world.intersect(&ray, &mut ()) else { continue };
            let Material::Phong(phong) = &world.materials()[at.material as usize] else { continue };
            let texel = world.diffuse_color(phong, &at.surface);
            let before = last[at.material as usize].replace(texel).unwrap_or(phong.diffuse);
            differences[y as usize * job.width as usize + x as usize] = world.ambient() * (before - texel);
        }
        differences
    }
}

#[cfg(test)]
mod tests;
