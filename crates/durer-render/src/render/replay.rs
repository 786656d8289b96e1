//! Repetition of a single pixel or sample, to debug a panic or a rejected sample.

use super::allocation::max_samples;
use super::error::RenderError;
use super::samples::{SampleCursor, SampleSource};
use super::{Control, Job, PartialRender, PixelRect, Shard, center_rays};
use crate::threads;
use crate::world::World;
use durer_bvh::RayCount;
use durer_scene::math::Color;
use std::cell::Cell;
use std::sync::atomic::AtomicBool;

/// Takes one sample of a job again and returns its colour, or `None` if the camera has no ray
/// there. If the argument `sample` is `None`, repeats the work for the pixel that is not part of
/// any sample.
///
/// This function panics if the repeated work panics.
///
/// # Errors
/// Returns [`RenderError`], which includes [`RenderError::Shard`] for pixels or samples that are
/// not in the job.
pub fn replay(
    world: &World,
    job: &Job,
    control: &Control,
    (x, y): (u32, u32),
    sample: Option<u32>,
) -> Result<Option<Color>, RenderError> {
    // This call validates the job.
    PartialRender::new(world, job, Shard::WHOLE)?;
    if !job.window().contains(x, y) {
        return Err(RenderError::Shard(format!("the pixel {x},{y} is not in the picture")));
    }
    let samples = job.sampling.samples();
    let samples = if job.adaptive { max_samples(samples) } else { samples };
    if sample.is_some_and(|sample| sample >= samples && job.sampling.is_local()) {
        return Err(RenderError::Shard(format!("the samples of a pixel are numbered from 0 to {}", samples - 1)));
    }
    let work = || {
        let (stop, at): (_, SampleCursor) = (AtomicBool::new(false), Cell::new((x, y, sample)));
        let samples = SampleSource::new(world, job, &stop);
        let (pixel, mut count) = (PixelRect::pixel((x, y)), RayCount::default());
        match sample {
            Some(sample) if job.sampling.is_local() => samples.sample(x, y, sample, &mut count).0,
            _ => {
                let _ = center_rays::trace(world, job, &samples, pixel, &at);
                match job.sampling.is_local() {
                    true => samples.sample(x, y, 0, &mut count).0,
                    false => samples.finished(pixel, &at, &mut count).ok().map(|pixels| pixels[0].0),
                }
            }
        }
    };
    Ok(threads::install(control.threads, work))
}
