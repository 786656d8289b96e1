//! Sampling methods of the Fall 2004 and Fall 2012 courses, in which a sample can affect several
//! pixels.

use super::aim::PixelSample;
use super::error::MAX_STORED;
use super::samples::{Cancelled, SampleCursor, SampleSource};
use super::sub_pixels::SubPixels;
use super::{Control, Job, PixelRect, RenderError, Sampling};
use crate::film::course::{CourseFilter, StoredSample, StoredSamples};
use crate::integrator::Integrate;
use crate::threads;
use crate::world::World;
use durer_bvh::RayCount;
use durer_scene::math::{Color, Vec3};
use durer_scene::sampler::{SampleId, Sampler};
use std::cell::Cell;

/// Takes all samples of a job and returns their positions and colours for a diagram.
///
/// # Errors
/// Returns [`RenderError`], including [`RenderError::TooManySamples`].
pub fn sample_diagram(world: &World, job: &Job, control: &Control) -> Result<StoredSamples, RenderError> {
    let (sampler, samples) = match job.sampling {
        Sampling::Course2004 { sampler, samples, .. } => (sampler, samples),
        Sampling::Filtered { samples, .. } => (Sampler::Sobol, samples),
        Sampling::Center | Sampling::Course2012 { .. } => (Sampler::Uniform, 1),
    };
    let samples = sampler.round_up(samples);
    let count = job.whole().pixels().saturating_mul(samples.into());
    if count > MAX_STORED {
        return Err(RenderError::TooManySamples(count));
    }
    let work = || {
        let (at, mut rays) = (Cell::new((0, 0, None)), RayCount::default());
        let source = SampleSource::new(world, job, &control.cancel);
        source.stored(&SubPixelPicture::default(), job.whole(), (sampler, samples), &at, |_, _| true, &mut rays)
    };
    threads::install(control.threads, work).map_err(|Cancelled| RenderError::Cancelled)
}

/// Returns the memory in bytes for the samples of a tile if samples affect other pixels. Otherwise,
/// returns 0.
pub(super) fn stored_bytes(job: &Job, side: u32) -> u64 {
    match job.sampling {
        Sampling::Course2004 { sampler, samples, filter: Some(filter) } => {
            let across = u64::from(side) + 2 * u64::from(filter.support());
            across * across * u64::from(sampler.round_up(samples)) * size_of::<StoredSample>() as u64
        }
        // Space for the picture, the picture blurred along rows, and that picture blurred along
        // columns.
        Sampling::Course2012 { .. } => 3 * 9 * 12 * u64::from(side + 2) * u64::from(side + 2),
        _ => 0,
    }
}

/// Values that the samples of the course store: either colours or a mask for the coverage.
///
/// The films of the course have no coverage. If the camera has no ray for some sample, a second
/// picture is therefore rendered as a mask. The mask is white where the camera has a ray and black
/// elsewhere.
#[derive(Default)]
struct SubPixelPicture {
    mask: bool,
    /// True if the camera had no ray for some sample.
    misses_ray: Cell<bool>,
}

/// Returns the coverage of a pixel from its value in the mask. Sums of filter weights are inexact,
/// so almost full coverage counts as full coverage.
pub(super) fn coverage_of(white: Color) -> f32 {
    if white.x > 1.0 - 1e-6 { 1.0 } else { white.x.max(0.0) }
}

impl SampleSource<'_> {
    /// Returns the finished pixels of a rectangle with their coverage, for sampling methods whose
    /// samples affect other pixels. Also takes the necessary samples around the rectangle.
    pub(super) fn finished(
        &self,
        part: PixelRect,
        at: &SampleCursor,
        rays: &mut RayCount,
    ) -> Result<Vec<(Color, f32)>, Cancelled> {
        let show = SubPixelPicture::default();
        let colors = self.shown(&show, part, at, rays)?;
        if !show.misses_ray.get() {
            return Ok(colors.into_iter().map(|color| (color, 1.0)).collect());
        }
        let mask = self.shown(
            &SubPixelPicture { mask: true, ..SubPixelPicture::default() },
            part,
            at,
            &mut RayCount::default(),
        )?;
        Ok(colors.into_iter().zip(mask).map(|(color, white)| (color, coverage_of(white))).collect())
    }

    /// Renders the colours or the mask of a rectangle.
    fn shown(
        &self,
        show: &SubPixelPicture,
        part: PixelRect,
        at: &SampleCursor,
        rays: &mut RayCount,
    ) -> Result<Vec<Color>, Cancelled> {
        match self.job.sampling {
            Sampling::Course2004 { sampler, samples, filter: Some(filter) } => {
                self.course_2004(show, part, (sampler, sampler.round_up(samples)), filter, at, rays)
            }
            Sampling::Course2012 { jitter, blur } => self.course_2012(show, part, (jitter, blur), at, rays),
            _ => unreachable!("other sampling methods add their samples to a film"),
        }
    }

    /// Returns the colour of a stored sample, or its value in the mask.
    fn kept(&self, show: &SubPixelPicture, aim: &PixelSample, id: SampleId, rays: &mut RayCount) -> Color {
        show.misses_ray.set(show.misses_ray.get() || aim.ray.is_none());
        let light = |ray| if show.mask { Vec3::ONE } else { self.integrator.radiance(&ray, id, rays) };
        aim.ray.map_or(Vec3::ZERO, light)
    }

    /// Stores samples and reconstructs the picture as in the Fall 2004 course.
    fn course_2004(
        &self,
        show: &SubPixelPicture,
        part: PixelRect,
        sampling: (Sampler, u32),
        filter: CourseFilter,
        at: &SampleCursor,
        rays: &mut RayCount,
    ) -> Result<Vec<Color>, Cancelled> {
        let around = part.grown(filter.support(), self.job.whole());
        let stored = self.stored(show, around, sampling, at, |x, y| part.contains(x, y), rays)?;
        let from = (part.left - around.left, part.top - around.top);
        stored.try_reconstruct(filter, from, (part.width, part.height), || self.check())
    }

    /// Takes all samples of a rectangle. Rays are counted only for pixels for which `counted`
    /// returns true.
    fn stored(
        &self,
        show: &SubPixelPicture,
        part: PixelRect,
        sampling: (Sampler, u32),
        at: &SampleCursor,
        counted: impl Fn(u32, u32) -> bool,
        rays: &mut RayCount,
    ) -> Result<StoredSamples, Cancelled> {
        StoredSamples::try_take(part.width, part.height, sampling.1, |column, row, sample| {
            self.check()?;
            let (x, y) = (part.left + column, part.top + row);
            at.set((x, y, Some(sample)));
            let (aim, position) = self.aim.spread_sample(sampling, x, y, sample);
            let mut own = RayCount::default();
            let color = self.kept(show, &aim, SampleId::new(self.job.seed, (x, y), sample), &mut own);
            rays.0 += if counted(x, y) { own.0 } else { 0 };
            Ok(StoredSample { position, color })
        })
    }

    /// Applies `-jitter` and `-filter` of the Fall 2012 course. Without jitter, the picture is
    /// blurred at its own size.
    fn course_2012(
        &self,
        show: &SubPixelPicture,
        part: PixelRect,
        (jitter, blurred): (bool, bool),
        at: &SampleCursor,
        rays: &mut RayCount,
    ) -> Result<Vec<Color>, Cancelled> {
        let grid = SubPixels::new(self.job, part, jitter, blurred);
        let raster = grid.raster(self.world);
        let mut pixels = Vec::with_capacity(grid.around.pixels() as usize);
        for (x, y) in grid.around.pixel_positions() {
            self.check()?;
            let pixel = grid.pixel((x, y));
            at.set((pixel.0, pixel.1, None));
            let mut own = RayCount::default();
            let id = SampleId::new(self.job.seed, pixel, grid.number((x, y)));
            pixels.push(self.kept(show, &self.aim.sub_pixel(&grid, &raster, (x, y)), id, &mut own));
            rays.0 += if grid.inner.contains(x, y) { own.0 } else { 0 };
        }
        let pixels = grid.blurred_mean(pixels);
        self.check()?;
        Ok(pixels)
    }
}
