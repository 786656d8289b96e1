//! Rendering with a device that traces the camera rays of the colour samples, such as a graphics
//! processor.
//!
//! The CPU generates the camera rays and sums the samples, with the same code as in other renders.
//! Samples are added in the same order whatever the number of rays per call, and the sums are
//! integers. A device that computes the same colours for the same rays therefore always produces
//! the same film.

use super::{
    BlockSamples, Control, OpenBlock, PartialRender, RenderError, RenderEvent, RenderOutcome, RunLimit, TILE, Watcher,
    Work, pilot,
};
use crate::threads;
use crate::world::World;
use durer_scene::math::{Color, Ray};
use durer_scene::sampler::SampleId;
use rayon::ThreadPool;
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// Camera ray of a sample, with the sample's identity.
#[derive(Clone, Copy, Debug)]
pub struct CameraRay {
    /// The ray. Its direction has unit length, and `t_min` can be minus infinity.
    pub ray: Ray,
    /// Identity of the sample, which selects its random numbers.
    pub id: SampleId,
}

/// Result for one camera ray.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TracedRay {
    /// Radiance along the ray.
    pub color: Color,
    /// Number of rays that were traced, including secondary rays.
    pub rays: u32,
}

/// Device that computes the radiance along camera rays.
pub trait RayDevice {
    /// Returns the name that [`Job::device`](super::Job::device) must have.
    fn name(&self) -> &str;

    /// Returns the number of rays for which one call of [`RayDevice::trace`] is most efficient; at
    /// least 1.
    fn capacity(&self) -> usize;

    /// Computes the radiance along each ray. Both slices have the same length.
    ///
    /// # Errors
    /// Returns a sentence if the device failed. The results are then discarded.
    fn trace(&mut self, rays: &[CameraRay], results: &mut [TracedRay]) -> Result<(), String>;
}

/// Samples of one block, before they are traced.
struct BlockPlan {
    index: usize,
    block: BlockSamples,
    /// Column, row, number and weight of each sample, and true if it has a camera ray.
    samples: Vec<(u32, u32, u32, f32, bool)>,
    rays: Vec<CameraRay>,
}

impl PartialRender {
    /// Continues the work like [`PartialRender::render`], with the colour samples traced by a
    /// device. Centre rays for AOVs are traced by the CPU.
    ///
    /// # Errors
    /// Returns [`RenderError::Device`] if the device fails, if the job names another device, or if
    /// samples affect several pixels. Otherwise see [`PartialRender::render`].
    pub fn render_on(
        &self,
        world: &World,
        control: &Control,
        device: &mut dyn RayDevice,
        watch: &mut dyn FnMut(&PartialRender, RenderEvent),
    ) -> Result<RenderOutcome, RenderError> {
        self.check_scene(world)?;
        if self.job.device.as_deref() != Some(device.name()) {
            let by = self.job.device.as_deref().unwrap_or("the CPU");
            return Err(RenderError::Device(format!("this part was rendered on {by}, not on {}", device.name())));
        }
        if !self.job.sampling.is_local() {
            return Err(RenderError::Device("a device cannot render samples that affect several pixels".into()));
        }
        control.check_memory(PartialRender::bytes_needed(&self.job, self.shard))?;
        let stop = AtomicBool::new(control.cancel.load(Relaxed));
        let mut clock = Watcher::new(control, &stop, !self.job.wants_samples());
        let (all, done) = self.work();
        control.total_work.store(all, Relaxed);
        control.done_work.store(done, Relaxed);
        let work = Work::new(self, world, control, &stop, TILE);
        let pool = threads::pool(control.threads);
        installed(pool.as_ref(), || work.rays(None));
        for end in self.ends(RunLimit::End) {
            work.pass_on(end, device, pool.as_ref(), &mut || clock.poll(self, watch))?;
            if !stop.load(Relaxed) {
                clock.passed(self, watch);
            }
        }
        Ok(work.outcome(clock.out_of_time))
    }
}

impl Work<'_> {
    /// Takes samples on a device until every pixel has `end` samples, or fewer if it needs fewer.
    fn pass_on(
        &self,
        end: u32,
        device: &mut dyn RayDevice,
        pool: Option<&ThreadPool>,
        poll: &mut dyn FnMut(),
    ) -> Result<(), RenderError> {
        let part = self.part;
        if part.job.adaptive && end > pilot(part.job.sampling.samples()) && !part.allocate() {
            return Ok(());
        }
        let blocks = self.open_blocks(end, self.samples.gain());
        let mut open = &blocks[..];
        while !open.is_empty() {
            poll();
            if self.stop.load(Relaxed) {
                return Ok(());
            }
            let (group, rest) = open.split_at(self.group_size(open, end, device.capacity()));
            self.sample_on(group, end, device, pool)?;
            open = rest;
        }
        Ok(())
    }

    /// Returns the number of leading blocks that together need at most `capacity` samples, but at
    /// least 1.
    fn group_size(&self, blocks: &[usize], end: u32, capacity: usize) -> usize {
        let (part, state, mut sum) = (self.part, self.part.state(), 0);
        let mut fits = |&index: &usize| {
            let (block, pixels) = (&state.samples[index], part.blocks.rect(index).pixels());
            sum += block.total(&part.job, pixels, end) - block.total(&part.job, pixels, block.to);
            sum <= capacity as u64
        };
        blocks.iter().take_while(|index| fits(index)).count().max(1)
    }

    /// Adds samples to some blocks.
    fn sample_on(
        &self,
        indices: &[usize],
        end: u32,
        device: &mut dyn RayDevice,
        pool: Option<&ThreadPool>,
    ) -> Result<(), RenderError> {
        let blocks = self.block_copies(indices);
        let plan = |(&index, block)| self.plan(index, block, end);
        let plans: Vec<BlockPlan> = installed(pool, || indices.par_iter().zip(blocks).map(plan).collect());
        let rays: Vec<CameraRay> = plans.iter().flat_map(|plan| &plan.rays).copied().collect();
        let mut results = vec![TracedRay::default(); rays.len()];
        device.trace(&rays, &mut results).map_err(RenderError::Device)?;
        let mut starts = Vec::with_capacity(plans.len());
        let mut start = 0;
        for plan in &plans {
            starts.push(start);
            start += plan.rays.len();
        }
        let taken = plans.iter().map(|plan| plan.samples.len() as u64).sum();
        let traced = results.iter().map(|result| u64::from(result.rays)).sum();
        let add = |(plan, start): (BlockPlan, usize)| {
            let own = &results[start..start + plan.rays.len()];
            self.add_plan(plan, own, end)
        };
        let finished: Vec<BlockSamples> = installed(pool, || plans.into_par_iter().zip(starts).map(add).collect());
        self.store(indices, finished, taken, traced);
        Ok(())
    }

    /// Generates the camera rays of a block's samples up to `end`.
    fn plan(&self, index: usize, block: BlockSamples, end: u32) -> BlockPlan {
        let job = &self.part.job;
        let mut plan = BlockPlan { index, block, samples: Vec::new(), rays: Vec::new() };
        for (number, (x, y)) in self.part.blocks.rect(index).pixel_positions().enumerate() {
            let pixel = self.samples.aim.pixel(x, y);
            let range = plan.block.count(job, number, plan.block.to)..plan.block.count(job, number, end);
            for sample in range {
                let aimed = self.samples.aim.sample(&pixel, sample);
                plan.samples.push((x, y, sample, aimed.weight, aimed.ray.is_some()));
                plan.rays.extend(aimed.ray.map(|ray| CameraRay { ray, id: pixel.id.with_sample(sample) }));
            }
        }
        plan
    }

    /// Adds the results of a block's samples to its film.
    fn add_plan(&self, plan: BlockPlan, results: &[TracedRay], end: u32) -> BlockSamples {
        let mut open = OpenBlock::new(self.part, plan.index, plan.block, end);
        let mut colors = results.iter().map(|result| result.color);
        for (x, y, sample, weight, has_ray) in plan.samples {
            let color = if has_ray { colors.next() } else { self.part.job.missed_color() };
            open.film.add_optional(x, y, sample, color, weight);
        }
        open.finish(self.part, results.iter().map(|result| u64::from(result.rays)).sum())
    }
}

/// Runs the work in a pool or, if there is none, in the calling thread.
fn installed<R: Send>(pool: Option<&ThreadPool>, work: impl FnOnce() -> R + Send) -> R {
    match pool {
        Some(pool) => pool.install(work),
        None => work(),
    }
}

#[cfg(test)]
mod tests;
