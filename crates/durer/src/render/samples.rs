//! How the samples of a block are taken, for each way of sampling.

use super::error::{MAX_KEPT, center};
use super::sub_pixels::SubPixels;
use super::{Control, Crop, Job, RenderError, Sampling, camera_ray, center_ray, raster};
use crate::bvh::RayCount;
use crate::camera::{CameraSample, Projection, Raster};
use crate::dialect::Compat;
use crate::film::course::{CourseFilter, StoredSample, StoredSamples};
use crate::film::{Film, FilterSampler};
use crate::integrator::{Integrate, Integrator, Whitted};
use crate::math::{Color, Ray, Vec2, Vec3};
use crate::sampler::{LENS_DIMENSION, PIXEL_DIMENSION, SampleId, Sampler, Sequence};
use crate::threads;
use crate::world::{Material, World};
use std::cell::Cell;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// The work was stopped before it was finished.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Stopped;

/// Column, row and number of the sample that a thread is at.
pub(super) type At = Cell<(u32, u32, Option<u32>)>;

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

/// Where a sample goes.
pub(super) struct PixelSample {
    /// In the picture, in pixels from the upper left corner.
    pub(super) place: Vec2,
    /// In the lens, from 0 to 1.
    pub(super) lens: Vec2,
    /// How much it counts for in the pixel.
    pub(super) weight: f32,
    /// Its ray; `None` where the camera sees nothing.
    pub(super) ray: Option<Ray>,
}

/// What the samples of a pixel have in common.
struct Pixel {
    x: u32,
    y: u32,
    /// Its middle, in pixels from the upper left corner, and on the square that the camera covers.
    center: Vec2,
    point: Vec2,
    /// Where in the pixel Sobol's samples lie, and where in the lens, if that has an extent.
    positions: Sequence,
    lenses: Option<Sequence>,
}

/// Takes the samples of a job.
pub(super) struct Samples<'a> {
    world: &'a World,
    job: &'a Job,
    raster: Raster,
    pub(super) whitted: Whitted<'a>,
    pub(super) integrator: Integrator<'a>,
    warp: Option<FilterSampler>,
    has_aperture: bool,
    /// What [`Compat::StaleTexels`] adds to each pixel of the whole picture.
    stale: Vec<Color>,
    stop: &'a AtomicBool,
}

impl<'a> Samples<'a> {
    pub(super) fn new(world: &'a World, job: &'a Job, stop: &'a AtomicBool) -> Self {
        let mut samples = Self::without_habits(world, job, stop);
        if job.sampling == Sampling::Center && world.rules().has(Compat::StaleTexels) {
            samples.stale = samples.stale_texels();
        }
        samples
    }

    /// The same without what [`Compat::StaleTexels`] adds, which takes a look at the whole picture.
    pub(super) fn without_habits(world: &'a World, job: &'a Job, stop: &'a AtomicBool) -> Self {
        let warp = match job.sampling {
            Sampling::Filtered { filter, .. } => Some(filter.sampler()),
            _ => None,
        };
        let whitted = Whitted { world, settings: job.settings, cancel: Some(stop) };
        let integrator = job.integrator(world, Some(stop));
        let raster = raster(world, job.width, job.height);
        let has_aperture = world.camera().has_aperture();
        Samples { world, job, raster, whitted, integrator, warp, has_aperture, stale: Vec::new(), stop }
    }

    /// The size of a sample's weight.
    pub(super) fn gain(&self) -> f32 {
        self.warp.as_ref().map_or(1.0, FilterSampler::gain)
    }

    pub(super) fn check(&self) -> Result<(), Stopped> {
        if self.stop.load(Relaxed) { Err(Stopped) } else { Ok(()) }
    }

    /// Adds samples of every pixel of a film's part.
    pub(super) fn add(
        &self,
        film: &mut Film,
        part: Crop,
        range: Range<u32>,
        at: &At,
        rays: &mut RayCount,
    ) -> Result<(), Stopped> {
        for (x, y) in part.places() {
            let pixel = self.pixel(x, y);
            for sample in range.clone() {
                self.check()?;
                at.set((x, y, Some(sample)));
                let (color, weight) = self.sample_of(&pixel, sample, rays);
                film.add_if_seen(x, y, sample, color, weight);
            }
        }
        // What was made after a cancel means nothing.
        self.check()
    }

    /// One sample of a pixel: its colour, if the camera sees anything there, and its weight.
    pub(super) fn sample(&self, x: u32, y: u32, sample: u32, rays: &mut RayCount) -> (Option<Color>, f32) {
        self.sample_of(&self.pixel(x, y), sample, rays)
    }

    fn sample_of(&self, pixel: &Pixel, sample: u32, rays: &mut RayCount) -> (Option<Color>, f32) {
        let PixelSample { ray, weight, .. } = self.aim_in(pixel, sample);
        let Pixel { x, y, .. } = *pixel;
        let id = SampleId::new(self.job.seed, (x, y), sample);
        let color = ray.map(|ray| self.integrator.radiance(&ray, id, rays));
        match self.stale.get(y as usize * self.job.width as usize + x as usize) {
            Some(&stale) => (color.map(|color| color + stale), weight),
            None => (color, weight),
        }
    }

    /// What the samples of a pixel have in common.
    fn pixel(&self, x: u32, y: u32) -> Pixel {
        let (seed, center) = (self.job.seed, center(x, y));
        Pixel {
            x,
            y,
            center,
            point: self.raster.point(center),
            positions: Sequence::new(seed, x, y, PIXEL_DIMENSION),
            lenses: self.has_aperture.then(|| Sequence::new(seed, x, y, LENS_DIMENSION)),
        }
    }

    /// Where a sample of a pixel goes, for samplings whose samples count for their own pixel alone.
    pub(super) fn aim(&self, x: u32, y: u32, sample: u32) -> PixelSample {
        self.aim_in(&self.pixel(x, y), sample)
    }

    fn aim_in(&self, pixel: &Pixel, sample: u32) -> PixelSample {
        let middle = Vec2::splat(0.5);
        let (place, lens, weight) = match (self.job.sampling, &self.warp) {
            (Sampling::Filtered { .. }, Some(warp)) => {
                let (offset, weight) = warp.sample(pixel.positions.point(sample));
                let lens = pixel.lenses.map_or(middle, |lenses| lenses.point(sample));
                (pixel.center + offset, lens, weight)
            }
            (Sampling::Course2004 { sampler, samples, .. }, _) => {
                return self.aim_kept((sampler, sampler.round_up(samples)), pixel.x, pixel.y, sample).0;
            }
            // One ray through the middles of pixel and lens.
            _ => (pixel.center, middle, 1.0),
        };
        let at = CameraSample { point: self.raster.point(place), pixel: pixel.point, lens };
        PixelSample { place, lens, weight, ray: self.world.camera().ray(self.world.camera_frame(), &at) }
    }

    /// Where a sample goes that keeps its place in its pixel, which comes with it. It counts for
    /// more pixels than one, as a filter says.
    pub(super) fn aim_kept(
        &self,
        (sampler, samples): (Sampler, u32),
        x: u32,
        y: u32,
        sample: u32,
    ) -> (PixelSample, Vec2) {
        let position = sampler.pixel_position(self.job.seed, x, y, sample, samples);
        let (place, lens) = (Vec2::new(x as f32, y as f32) + position, self.lens(sampler, x, y, sample));
        let ray = camera_ray(self.world, &self.raster, (x, y), place, lens);
        (PixelSample { place, lens, weight: 1.0, ray }, position)
    }

    /// Where the sample of a sub-pixel goes.
    pub(super) fn aim_sub_pixel(&self, grid: &SubPixels, raster: &Raster, (x, y): (u32, u32)) -> PixelSample {
        let (place, lens) = (grid.place(self.job.seed, (x, y)), self.lens(Sampler::Random, x, y, 0));
        let ray = camera_ray(self.world, raster, (x, y), place, lens);
        PixelSample { place: place / grid.scale() as f32, lens, weight: 1.0, ray }
    }

    /// Where in the lens a sample lies. A lens without extent needs no numbers.
    fn lens(&self, sampler: Sampler, x: u32, y: u32, sample: u32) -> Vec2 {
        match self.has_aperture {
            true => sampler.lens_position(self.job.seed, x, y, sample),
            false => Vec2::splat(0.5),
        }
    }

    /// The finished pixels of a part with their coverage, for samplings whose samples count for
    /// other pixels too. Samples around the part that are needed for it are taken for it alone.
    pub(super) fn finished(&self, part: Crop, at: &At, rays: &mut RayCount) -> Result<Vec<(Color, f32)>, Stopped> {
        let show = Show::default();
        let colors = self.shown(&show, part, at, rays)?;
        if !show.blind.get() {
            return Ok(colors.into_iter().map(|color| (color, 1.0)).collect());
        }
        let mask = self.shown(&Show { mask: true, ..Show::default() }, part, at, &mut RayCount::default())?;
        Ok(colors.into_iter().zip(mask).map(|(color, white)| (color, share(white))).collect())
    }

    fn shown(&self, show: &Show, part: Crop, at: &At, rays: &mut RayCount) -> Result<Vec<Color>, Stopped> {
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
        at: &At,
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
        at: &At,
        counted: impl Fn(u32, u32) -> bool,
        rays: &mut RayCount,
    ) -> Result<StoredSamples, Stopped> {
        StoredSamples::try_take(part.width, part.height, sampling.1, |column, row, sample| {
            self.check()?;
            let (x, y) = (part.left + column, part.top + row);
            at.set((x, y, Some(sample)));
            let (aim, position) = self.aim_kept(sampling, x, y, sample);
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
        at: &At,
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
            pixels.push(self.kept(show, &self.aim_sub_pixel(&grid, &raster, (x, y)), id, &mut own));
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
            let Some(ray) = center_ray(world, &self.raster, (x, y)) else { continue };
            let Some(at) = world.intersect(&ray, &mut ()) else { continue };
            let Material::Phong(phong) = &world.materials()[at.material as usize] else { continue };
            let texel = world.diffuse_color(phong, &at.surface);
            let before = last[at.material as usize].replace(texel).unwrap_or(phong.diffuse);
            differences[y as usize * job.width as usize + x as usize] = world.ambient() * (before - texel);
        }
        differences
    }
}
