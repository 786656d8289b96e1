//! Implements `--stats`, which prints the times and ray counts of a render or writes them as JSON.

use crate::failure::{Failure, from_render_error};
use crate::info;
use crate::terminal::print_error_line;
use durer::render::{PartialRender, Profile, profile};
use durer::world::World;
use std::time::{Duration, Instant};

/// Number of samples that are rendered again for the measurement.
const SAMPLES: u64 = 4096;

/// Stopwatch for the stages of a render, such as reading and rendering.
pub struct StageTimer {
    last: Instant,
    done: Vec<(&'static str, Duration)>,
}

impl StageTimer {
    /// Starts the first stage.
    pub fn start() -> Self {
        StageTimer { last: Instant::now(), done: Vec::new() }
    }

    /// Ends the current stage, gives it this name, and starts the next stage.
    pub fn end_stage(&mut self, name: &'static str) {
        self.done.push((name, self.last.elapsed()));
        self.last = Instant::now();
    }

    /// Returns the time of the stage "rendering" in seconds.
    fn rendering(&self) -> f64 {
        self.done.iter().find(|(name, _)| *name == "rendering").map_or(0.0, |(_, time)| time.as_secs_f64())
    }

    /// Returns the times of the stages and the ray counts of a finished part as JSON. Times are in
    /// seconds.
    pub fn json(&self, world: &World, part: &PartialRender) -> Result<Vec<u8>, Failure> {
        let statistics = part.statistics();
        let seconds: serde_json::Map<_, _> =
            self.done.iter().map(|(name, time)| (name.to_string(), time.as_secs_f64().into())).collect();
        let measured = profile(world, part.job(), SAMPLES).map_err(from_render_error)?.map(|profile| {
            let rays: serde_json::Map<_, _> =
                profile.rays.iter().map(|(name, count)| (name.to_string(), (*count).into())).collect();
            serde_json::json!({
                "samples": profile.samples,
                "rays": rays,
                "seconds": profile.time.as_secs_f64(),
                "traversal_seconds": profile.intersection_time.as_secs_f64(),
            })
        });
        let value = serde_json::json!({
            "seconds": seconds,
            "rays": statistics.rays,
            "samples": statistics.samples,
            "rays_per_second": statistics.rays as f64 / self.rendering().max(1e-9),
            "one_thread": measured,
        });
        Ok((serde_json::to_string_pretty(&value)? + "\n").into_bytes())
    }

    /// Prints the times of the stages and the ray counts of a finished part.
    pub fn report(&self, world: &World, part: &PartialRender) -> Result<(), Failure> {
        print_error_line("time");
        for (name, time) in &self.done {
            print_error_line(&format!("  {:>9.1} ms  {name}", time.as_secs_f64() * 1e3));
        }
        let statistics = part.statistics();
        let rendering = self.rendering();
        print_error_line("rays");
        print_error_line(&format!("  {:>12}  in total, for {} samples", statistics.rays, statistics.samples));
        print_error_line(&format!(
            "  {:>12.2}  million per second",
            statistics.rays as f64 / rendering.max(1e-9) / 1e6
        ));
        let camera_rays = info::rays(world);
        if camera_rays.rays > 0 {
            let per_ray = |count: u64| count as f64 / camera_rays.rays as f64;
            let (nodes, tests) = (per_ray(camera_rays.nodes), per_ray(camera_rays.primitive_tests));
            print_error_line(&format!(
                "  {tests:>12.1}  tests and {nodes:.1} nodes for each of {} camera rays",
                camera_rays.rays
            ));
        }
        if let Some(Profile { samples, rays, time, intersection_time }) =
            profile(world, part.job(), SAMPLES).map_err(from_render_error)?
        {
            print_error_line(&format!("{samples} samples rendered again on one thread"));
            for (name, count) in rays.iter().filter(|(_, count)| *count > 0) {
                print_error_line(&format!("  {count:>12}  {name} rays"));
            }
            let per_sample = time.as_secs_f64() * 1e9 / samples.max(1) as f64;
            print_error_line(&format!("  {per_sample:>12.0}  ns per sample"));
            // The two times are of separate runs.
            let share = (100.0 * intersection_time.as_secs_f64() / time.as_secs_f64().max(1e-9)).min(100.0);
            print_error_line(&format!("  {share:>12.0}  % of the time in ray traversal"));
        }
        Ok(())
    }
}
