//! One pixel or sample alone: to look into an error in this program, or a sample that was left out.

use super::allocation::most;
use super::error::RenderError;
use super::samples::{SampleCursor, Samples};
use super::{Control, Crop, Job, PartialRender, Shard, rays};
use crate::threads;
use crate::world::World;
use durer_bvh::RayCount;
use durer_scene::math::Color;
use std::cell::Cell;
use std::sync::atomic::AtomicBool;

/// The colour of one sample of a job, by itself, if the camera sees anything there. `None`: what a
/// pixel has beside samples of its own, or instead of them.
///
/// A panic comes through.
///
/// # Errors
/// [`RenderError`], among them [`RenderError::Shard`] where there is no such pixel or sample.
pub fn replay(
    world: &World,
    job: &Job,
    control: &Control,
    (x, y): (u32, u32),
    sample: Option<u32>,
) -> Result<Option<Color>, RenderError> {
    // Refuses impossible jobs.
    PartialRender::new(world, job, Shard::WHOLE)?;
    if !job.window().holds(x, y) {
        return Err(RenderError::Shard(format!("the pixel {x},{y} is not in the picture")));
    }
    let samples = job.sampling.samples();
    let samples = if job.adaptive { most(samples) } else { samples };
    if sample.is_some_and(|sample| sample >= samples && job.sampling.is_local()) {
        return Err(RenderError::Shard(format!("a pixel has samples from 0 to {}", samples - 1)));
    }
    let work = || {
        let (stop, at): (_, SampleCursor) = (AtomicBool::new(false), Cell::new((x, y, sample)));
        let samples = Samples::new(world, job, &stop);
        let (pixel, mut count) = (Crop::pixel((x, y)), RayCount::default());
        match sample {
            Some(sample) if job.sampling.is_local() => samples.sample(x, y, sample, &mut count).0,
            _ => {
                let _ = rays::trace(world, job, &samples, pixel, &at);
                match job.sampling.is_local() {
                    true => samples.sample(x, y, 0, &mut count).0,
                    false => samples.finished(pixel, &at, &mut count).ok().map(|pixels| pixels[0].0),
                }
            }
        }
    };
    Ok(threads::install(control.threads, work))
}
