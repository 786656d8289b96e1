//! Camera rays for the samples of a render job.

use super::error::center;
use super::sub_pixels::SubPixels;
use super::{Job, Sampling, camera_ray, raster};
use crate::film::FilterSampler;
use crate::world::World;
use durer_bvh::internal::{PlainKernel, run_plain};
use durer_scene::camera::{CameraSample, CameraSamples, Projection, Raster};
use durer_scene::math::{Ray, Vec2};
use durer_scene::sampler::{LENS_DIMENSION, PIXEL_DIMENSION, SampleId, Sampler, Sequence};
use std::array::from_fn;

/// Position, weight and camera ray of one sample of a pixel.
pub(super) struct PixelSample {
    /// Position in the picture, in pixels from the upper left corner.
    pub(super) film_position: Vec2,
    /// Position on the lens in [0,1)^2.
    pub(super) lens: Vec2,
    /// Weight of the sample in the pixel.
    pub(super) weight: f32,
    /// Camera ray, or `None` if the camera has no ray there, for example outside the circle of a
    /// fisheye lens, or if the ray hits nothing and the job replaces the background.
    pub(super) ray: Option<Ray>,
}

/// Position and random sequence of a pixel. All samples of the pixel share both.
#[derive(Clone, Copy)]
pub(super) struct Pixel {
    pub(super) x: u32,
    pub(super) y: u32,
    /// Source of random numbers for the pixel's samples.
    pub(super) id: SampleId,
    /// Centre of the pixel, measured in pixels from the upper left corner of the picture.
    center: Vec2,
    /// Centre of the pixel in the coordinates of the camera.
    point: Vec2,
    /// Sobol sequence of the positions in the pixel.
    positions: Sequence,
}

/// Number of samples whose camera rays are generated together with SIMD.
pub(super) const BATCH: usize = 8;

/// A group of samples whose camera rays are generated together.
pub(super) trait SampleGroup {
    /// Returns the number of samples, which is at most [`BATCH`].
    fn len(&self) -> usize;

    /// Returns the pixel of a sample. For an unused slot, any pixel may be returned.
    fn pixel(&self, i: usize) -> &Pixel;

    /// Returns the index of a sample within its pixel.
    fn number(&self, i: usize) -> u32;
}

/// A group of up to [`BATCH`] samples of one or several pixels.
pub(super) struct Batch {
    of: [(Pixel, u32); BATCH],
    len: usize,
}

impl Batch {
    /// Creates an empty batch. The pixel `some` is used for unused slots.
    pub(super) fn new(some: Pixel) -> Self {
        Batch { of: [(some, 0); BATCH], len: 0 }
    }

    /// Adds a sample. Returns true if the batch is full afterwards.
    pub(super) fn push(&mut self, pixel: &Pixel, sample: u32) -> bool {
        self.of[self.len] = (*pixel, sample);
        self.len += 1;
        self.len == BATCH
    }

    pub(super) fn clear(&mut self) {
        self.len = 0;
    }
}

impl SampleGroup for Batch {
    #[inline(always)]
    fn len(&self) -> usize {
        self.len
    }

    #[inline(always)]
    fn pixel(&self, i: usize) -> &Pixel {
        &self.of[i].0
    }

    #[inline(always)]
    fn number(&self, i: usize) -> u32 {
        self.of[i].1
    }
}

/// A group of [`BATCH`] consecutive samples of one pixel.
pub(super) struct PixelRun<'a> {
    pub(super) pixel: &'a Pixel,
    pub(super) first: u32,
}

impl SampleGroup for PixelRun<'_> {
    #[inline(always)]
    fn len(&self) -> usize {
        BATCH
    }

    #[inline(always)]
    fn pixel(&self, _: usize) -> &Pixel {
        self.pixel
    }

    #[inline(always)]
    fn number(&self, i: usize) -> u32 {
        self.first + i as u32
    }
}

/// Generator of the camera rays for the samples of a job.
pub(super) struct CameraRays<'a> {
    world: &'a World,
    job: &'a Job,
    pub(super) raster: Raster,
    filter_sampler: Option<FilterSampler>,
    has_aperture: bool,
}

impl<'a> CameraRays<'a> {
    pub(super) fn new(world: &'a World, job: &'a Job) -> Self {
        let filter_sampler = match job.sampling {
            Sampling::Filtered { filter, .. } => Some(filter.sampler()),
            _ => None,
        };
        let raster = raster(world, job.width, job.height);
        CameraRays { world, job, raster, filter_sampler, has_aperture: world.camera().has_aperture() }
    }

    /// Returns the magnitude of the sample weights.
    pub(super) fn gain(&self) -> f32 {
        self.filter_sampler.as_ref().map_or(1.0, FilterSampler::gain)
    }

    /// Returns the position and random sequence of a pixel.
    pub(super) fn pixel(&self, x: u32, y: u32) -> Pixel {
        let (id, center) = (SampleId::new(self.job.seed, (x, y), 0), center(x, y));
        Pixel { x, y, id, center, point: self.raster.point(center), positions: id.sequence(PIXEL_DIMENSION) }
    }

    /// Generates a sample. This works only for sampling methods in which a sample affects a single
    /// pixel.
    pub(super) fn sample(&self, pixel: &Pixel, sample: u32) -> PixelSample {
        let middle = Vec2::splat(0.5);
        let (film_position, lens, weight) = match (self.job.sampling, &self.filter_sampler) {
            (Sampling::Filtered { .. }, Some(filter_sampler)) => {
                let (offset, weight) = filter_sampler.sample(pixel.positions.point(sample));
                let lens = if self.has_aperture { pixel.id.sequence(LENS_DIMENSION).point(sample) } else { middle };
                (pixel.center + offset, lens, weight)
            }
            (Sampling::Course2004 { sampler, samples, .. }, _) => {
                return self.spread_sample((sampler, sampler.round_up(samples)), pixel.x, pixel.y, sample).0;
            }
            // Generate a single ray through the centre of the pixel and the centre of the lens.
            _ => (pixel.center, middle, 1.0),
        };
        let at = CameraSample { point: self.raster.point(film_position), pixel: pixel.point, lens };
        let ray = self.world.camera().ray(self.world.camera_frame(), &at);
        PixelSample { film_position, lens, weight, ray: self.without_misses(ray, pixel.id, sample) }
    }

    /// Removes the ray of a sample that hits nothing if the job replaces the background.
    fn without_misses(&self, ray: Option<Ray>, id: SampleId, sample: u32) -> Option<Ray> {
        ray.filter(|ray| self.job.backdrop.is_none() || self.sees_surface(ray, id, sample))
    }

    /// Returns true if the camera sees a surface on the ray of a sample.
    fn sees_surface(&self, ray: &Ray, id: SampleId, sample: u32) -> bool {
        match self.world.is_seen_through() && self.job.method.path_options().is_some() {
            true => self.world.first_seen(ray, Some(&id.with_sample(sample)), &mut ()).is_some(),
            false => self.world.occluded(ray, &mut ()),
        }
    }

    /// Generates the rays and weights of a group of samples. The results are the same as those of
    /// [`CameraRays::sample`].
    pub(super) fn sample_group(&self, of: &impl SampleGroup, mut take: impl FnMut(usize, Option<Ray>, f32)) {
        let mut take = |i: usize, ray, weight| {
            if i < of.len() {
                take(i, self.without_misses(ray, of.pixel(i).id, of.number(i)), weight);
            }
        };
        match (&self.filter_sampler, self.job.sampling) {
            (Some(filter_sampler), _) => run_plain(AimKernel { aim: self, filter_sampler, of, take }),
            (None, Sampling::Center) => {
                let points = [0, 1].map(|axis| from_fn(|i| of.pixel(i).point[axis]));
                self.rays(of, points, [[0.5; BATCH]; 2], |i, ray| take(i, ray, 1.0));
            }
            _ => {
                for i in 0..of.len() {
                    let PixelSample { ray, weight, .. } = self.sample(of.pixel(i), of.number(i));
                    take(i, ray, weight);
                }
            }
        }
    }

    /// Generates the camera rays for positions on the film and on the lens.
    #[inline(always)]
    fn rays(
        &self,
        of: &impl SampleGroup,
        points: [[f32; BATCH]; 2],
        lenses: [[f32; BATCH]; 2],
        take: impl FnMut(usize, Option<Ray>),
    ) {
        let samples = CameraSamples { points, pixels: from_fn(|i| of.pixel(i).point), lenses };
        self.world.camera().rays(self.world.camera_frame(), &samples, take);
    }

    /// Generates a sample that a filter spreads over several pixels. Also returns the position of
    /// the sample within its pixel.
    pub(super) fn spread_sample(
        &self,
        (sampler, samples): (Sampler, u32),
        x: u32,
        y: u32,
        sample: u32,
    ) -> (PixelSample, Vec2) {
        let position = sampler.pixel_position(self.job.seed, x, y, sample, samples);
        let (film_position, lens) = (Vec2::new(x as f32, y as f32) + position, self.lens(sampler, x, y, sample));
        let ray = camera_ray(self.world, &self.raster, (x, y), film_position, lens);
        let ray = self.without_misses(ray, SampleId::new(self.job.seed, (x, y), 0), sample);
        (PixelSample { film_position, lens, weight: 1.0, ray }, position)
    }

    /// Generates the sample of a sub-pixel for the 2012 course.
    pub(super) fn sub_pixel(&self, grid: &SubPixels, raster: &Raster, (x, y): (u32, u32)) -> PixelSample {
        let (place, lens) = (grid.place(self.job.seed, (x, y)), self.lens(Sampler::Random, x, y, 0));
        let ray = camera_ray(self.world, raster, (x, y), place, lens);
        let ray = self.without_misses(ray, SampleId::new(self.job.seed, (x, y), 0), 0);
        PixelSample { film_position: place / grid.scale() as f32, lens, weight: 1.0, ray }
    }

    /// Returns the position of a sample on the lens. For a pinhole camera, this is the centre of
    /// the lens.
    fn lens(&self, sampler: Sampler, x: u32, y: u32, sample: u32) -> Vec2 {
        match self.has_aperture {
            true => sampler.lens_position(self.job.seed, x, y, sample),
            false => Vec2::splat(0.5),
        }
    }
}

/// SIMD kernel that generates the samples of a group when a reconstruction filter is used.
struct AimKernel<'a, S, F> {
    aim: &'a CameraRays<'a>,
    filter_sampler: &'a FilterSampler,
    of: &'a S,
    take: F,
}

impl<S: SampleGroup, F: FnMut(usize, Option<Ray>, f32)> PlainKernel for AimKernel<'_, S, F> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let AimKernel { aim, filter_sampler, of, mut take } = self;
        let (mut numbers, mut sequences) = ([0; BATCH], [of.pixel(0).positions; BATCH]);
        for i in 0..BATCH {
            (numbers[i], sequences[i]) = (of.number(i), of.pixel(i).positions);
        }
        let (offsets, weights) = filter_sampler.samples(&Sequence::points(&sequences, &numbers));
        let mut places = [[0.0; BATCH]; 2];
        for axis in 0..2 {
            for i in 0..BATCH {
                places[axis][i] = of.pixel(i).center[axis] + offsets[axis][i];
            }
        }
        let mut lenses = [[0.5; BATCH]; 2];
        if aim.has_aperture {
            for (i, sequence) in sequences.iter_mut().enumerate() {
                *sequence = of.pixel(i).id.sequence(LENS_DIMENSION);
            }
            lenses = Sequence::points(&sequences, &numbers);
        }
        aim.rays(of, aim.raster.points(places), lenses, |i, ray| take(i, ray, weights[i]));
    }
}
