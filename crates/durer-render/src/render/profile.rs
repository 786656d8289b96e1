//! Profiling, which measures the time for the samples of some pixels and for the intersections of
//! their rays alone.

use super::samples::SampleSource;
use super::{Job, RenderError};
use crate::clock::{Duration, Instant};
use crate::integrator::trace::{NodeId, RayKind, RayRecord, TermKind};
use crate::integrator::{Integrate, TraceListener};
use crate::world::World;
use durer_bvh::{RayCount, TraversalCounter};
use durer_scene::math::Ray;
use durer_scene::sampler::SampleId;
use std::hint::black_box;
use std::sync::atomic::AtomicBool;

/// Cost of some samples of a render: the number of rays and the time with and without shading.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Profile {
    /// Number of samples.
    pub samples: u64,
    /// Name and number of rays of each kind. The last kind is shadow rays.
    pub rays: [(&'static str, u64); 5],
    /// Time that one thread needs for the samples.
    pub time: Duration,
    /// Part of the time that is spent on intersecting the rays.
    pub intersection_time: Duration,
}

/// Listener that records all rays of an integrator, for profiling.
#[derive(Default)]
struct RayLog(Vec<(Option<RayKind>, RayRecord)>);

impl TraversalCounter for RayLog {
    const COUNTS_WORK: bool = false;
}

impl TraceListener for RayLog {
    fn begin(&mut self, _parent: NodeId, what: impl FnOnce() -> TermKind) -> NodeId {
        match what() {
            TermKind::Ray { from, ray, .. } => self.0.push((Some(from), ray)),
            TermKind::Light { shadow: Some(shadow), .. } | TermKind::Direct { shadow: Some(shadow), .. } => {
                self.0.push((None, shadow.ray));
            }
            _ => {}
        }
        NodeId::NONE
    }
}

/// Measures the first sample of up to `most` evenly spread pixels of a job. It measures the
/// complete samples and, separately, only the intersections of their rays. Returns `None` if
/// samples affect several pixels.
///
/// # Errors
/// Returns [`RenderError`] for invalid jobs.
pub fn profile(world: &World, job: &Job, most: u64) -> Result<Option<Profile>, RenderError> {
    super::PartialRender::new(world, job, super::Shard::WHOLE)?;
    if !job.sampling.is_local() || !job.color {
        return Ok(None);
    }
    let never = AtomicBool::new(false);
    let samples = SampleSource::without_quirks(world, job, &never);
    samples.integrator.prepare(0);
    // An odd step rarely has a common factor with the width, so the steps reach all columns.
    let step = (job.window().pixels() / most.max(1)).max(1) | 1;
    let pixels: Vec<(u32, u32)> = job.window().pixel_positions().step_by(step as usize).collect();
    let mut log = RayLog::default();
    for &(x, y) in &pixels {
        if let Some(ray) = samples.aim(x, y, 0).ray {
            samples.integrator.radiance(&ray, SampleId::new(job.seed, (x, y), 0), &mut log);
        }
    }
    let rays: Vec<(bool, Ray)> = log
        .0
        .iter()
        .map(|&(from, RayRecord { origin, dir, t_min, t_max })| (from.is_none(), Ray { origin, dir, t_min, t_max }))
        .collect();
    let whole = || {
        let mut count = RayCount::default();
        for &(x, y) in &pixels {
            black_box(samples.sample(x, y, 0, &mut count));
        }
    };
    let alone = || {
        for (any, ray) in &rays {
            if *any {
                black_box(world.occluded(ray, &mut ()));
            } else {
                black_box(world.closest(ray, &mut ()));
            }
        }
    };
    let count = |kind: Option<RayKind>| log.0.iter().filter(|(from, _)| *from == kind).count() as u64;
    Ok(Some(Profile {
        samples: pixels.len() as u64,
        rays: [
            ("camera", count(Some(RayKind::Camera))),
            ("mirrored", count(Some(RayKind::Reflected))),
            ("transmitted", count(Some(RayKind::Transmitted))),
            ("scattered", count(Some(RayKind::Scattered))),
            ("shadow", count(None)),
        ],
        time: fastest(whole),
        intersection_time: fastest(alone),
    }))
}

/// Returns the shortest time of three runs, because disturbances can only increase the time.
fn fastest(work: impl Fn()) -> Duration {
    let time = || {
        let start = Instant::now();
        work();
        start.elapsed()
    };
    (0..3).map(|_| time()).min().unwrap_or_default()
}
