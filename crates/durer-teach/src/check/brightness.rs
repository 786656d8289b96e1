//! How bright the picture is.

use super::probes::{Probe, ProbeGrid};
use durer_render::integrator::{Integrate, Path};
use durer_scene::math::Color;
use durer_scene::sampler::SampleId;
use rayon::prelude::*;

/// Of a path tracer's picture, so many pixels are looked at, by so many samples each.
const MAX_PIXELS: usize = 300;
const SAMPLES: u32 = 16;

/// The colours of the picture, exposed: of all rays, or under a path tracer of a part of them, each
/// the mean of a few samples.
pub(super) fn light(grid: &ProbeGrid) -> Vec<Color> {
    let exposure = grid.subject.exposure;
    let Some(transport) = grid.subject.job.method.transport() else {
        return grid.probes.iter().map(|probe| exposure * probe.color).collect();
    };
    let job = grid.subject.job;
    let path = Path::new(grid.world(), job.settings, transport);
    let step = grid.probes.len().div_ceil(MAX_PIXELS).max(1);
    // Not one in each row: that would be the same column each time.
    let chosen: Vec<&Probe> =
        grid.probes.iter().step_by(if step.is_multiple_of(2) { step + 1 } else { step }).collect();
    let mean = |probe: &&Probe| {
        let sample = |i: u32| path.radiance(&probe.ray, SampleId::new(job.seed, probe.pixel, i), &mut ());
        let all = (0..SAMPLES).map(sample).filter(|color| color.is_finite());
        exposure * all.sum::<Color>() / SAMPLES as f32
    };
    chosen.par_iter().map(mean).collect()
}

/// The brightest that is seen, but for one bright speck.
pub(super) fn brightest(light: &[Color]) -> f32 {
    let mut values: Vec<f32> = light.iter().map(|color| color.max_element()).collect();
    values.sort_by(f32::total_cmp);
    values.len().checked_sub(2).map_or(0.0, |at| values[at])
}
