//! Measures the brightness of the picture from a few samples.

use super::probes::{Probe, ProbeGrid};
use durer_render::integrator::{Integrate, Path, RenderSettings};
use durer_scene::math::Color;
use durer_scene::sampler::SampleId;
use rayon::prelude::*;

/// Maximum number of pixels that are path traced, and number of samples for each of them.
const MAX_PIXELS: usize = 300;
const SAMPLES: u32 = 16;

/// Returns exposed colours of the picture, each with the index of its probe. Whitted's method gives
/// one colour per probe. Path tracing gives the mean of `SAMPLES` samples for at most `MAX_PIXELS`
/// probes.
pub(super) fn exposed_colors(grid: &ProbeGrid) -> (Vec<usize>, Vec<Color>) {
    exposed_colors_with(grid, grid.input.job.settings)
}

/// Returns the exposed colours that the picture would have with other settings.
pub(super) fn exposed_colors_with(grid: &ProbeGrid, settings: RenderSettings) -> (Vec<usize>, Vec<Color>) {
    let exposure = grid.input.exposure;
    let Some(transport) = grid.input.job.method.path_options() else {
        return grid.probes.iter().enumerate().map(|(i, probe)| (i, exposure * probe.color)).unzip();
    };
    let job = grid.input.job;
    let path = Path::new(grid.world(), settings, transport);
    let step = grid.probes.len().div_ceil(MAX_PIXELS).max(1);
    // An odd step avoids sampling the same columns in each row.
    let step = if step.is_multiple_of(2) { step + 1 } else { step };
    let chosen: Vec<(usize, &Probe)> = grid.probes.iter().enumerate().step_by(step).collect();
    let mean = |&(number, probe): &(usize, &Probe)| {
        let sample = |i: u32| path.radiance(&probe.ray, SampleId::new(job.seed, probe.pixel, i), &mut ());
        let all = (0..SAMPLES).map(sample).filter(|color| color.is_finite());
        (number, exposure * all.sum::<Color>() / SAMPLES as f32)
    };
    chosen.par_iter().map(mean).unzip()
}

/// Returns the second largest value, so that a single bright pixel is ignored.
pub(super) fn brightest(light: &[Color]) -> f32 {
    let mut values: Vec<f32> = light.iter().map(|color| color.max_element()).collect();
    values.sort_by(f32::total_cmp);
    values.len().checked_sub(2).map_or(0.0, |at| values[at])
}
