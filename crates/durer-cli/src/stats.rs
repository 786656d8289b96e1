//! `--stats`: what the time of a picture went into.

use crate::failure::{Failure, failed};
use crate::terminal::complain;
use durer::render::{PartialRender, Profile, profile};
use durer::world::World;
use std::time::{Duration, Instant};

/// Samples that are taken again to see what they take.
const SAMPLES: u64 = 4096;

/// The stages of the work, one after the other.
pub struct Stages {
    last: Instant,
    done: Vec<(&'static str, Duration)>,
}

impl Stages {
    /// The first stage begins.
    pub fn begin() -> Self {
        Stages { last: Instant::now(), done: Vec::new() }
    }

    /// A stage ends, and the next begins.
    pub fn ends(&mut self, name: &'static str) {
        self.done.push((name, self.last.elapsed()));
        self.last = Instant::now();
    }

    /// Tells of all stages, and of the rays of a part.
    pub fn tell(&self, world: &World, part: &PartialRender) -> Result<(), Failure> {
        complain("time");
        for (name, time) in &self.done {
            complain(&format!("  {:>9.1} ms  {name}", time.as_secs_f64() * 1e3));
        }
        let statistics = part.statistics();
        let rendering =
            self.done.iter().find(|(name, _)| *name == "rendering").map_or(0.0, |(_, time)| time.as_secs_f64());
        complain("rays");
        complain(&format!("  {:>12}  in all, of {} samples", statistics.rays, statistics.samples));
        complain(&format!("  {:>12.2}  million a second", statistics.rays as f64 / rendering.max(1e-9) / 1e6));
        if let Some(Profile { samples, rays, time, kernel }) = profile(world, part.job(), SAMPLES).map_err(failed)? {
            complain(&format!("of {samples} samples taken again by one thread"));
            for (name, count) in rays.iter().filter(|(_, count)| *count > 0) {
                complain(&format!("  {count:>12}  {name} rays"));
            }
            let per_sample = time.as_secs_f64() * 1e9 / samples.max(1) as f64;
            complain(&format!("  {per_sample:>12.0}  ns a sample"));
            let share = 100.0 * kernel.as_secs_f64() / time.as_secs_f64().max(1e-9);
            complain(&format!("  {share:>12.0}  % of that in finding what rays hit"));
        }
        Ok(())
    }
}
