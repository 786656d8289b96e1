//! Explanation of pixels that include the samples of neighbouring pixels, as in the course's
//! assignments.

use super::{ExplainedSample, SampleCombination};
use crate::film::course::CourseFilter;
use crate::render::aim::PixelSample;
use crate::render::course::coverage_of;
use crate::render::samples::SampleSource;
use crate::render::sub_pixels::SubPixels;
use crate::render::{Job, PixelRect};
use crate::world::World;
use durer_scene::math::{Color, Vec3};
use durer_scene::sampler::Sampler;
use glam::DVec3;

/// Returns the samples of a pixel in the Fall 2004 course. These are all samples within the support
/// of the filter, with their weights in this pixel.
pub(super) fn around(
    source: &SampleSource,
    job: &Job,
    here: (u32, u32),
    (sampler, samples, filter): (Sampler, u32, CourseFilter),
    account: impl Fn((u32, u32), u32, PixelSample) -> ExplainedSample,
) -> (SampleCombination, Vec<ExplainedSample>) {
    let samples = sampler.round_up(samples);
    let all = |crop: PixelRect| crop.pixel_positions().flat_map(move |of| (0..samples).map(move |sample| (of, sample)));
    let aim = |(of, sample): ((u32, u32), u32)| {
        let (aim, position) = source.aim.spread_sample((sampler, samples), of.0, of.1, sample);
        (of, sample, PixelSample { weight: filter.weight_between(of, position, here), ..aim })
    };
    let aims: Vec<_> = all(PixelRect::pixel(here).grown(filter.support(), job.whole())).map(aim).collect();
    // If all weights are zero, the pixel is the mean of its own samples.
    if aims.iter().all(|(.., aim)| aim.weight == 0.0) {
        let own = |(of, sample, aim)| account(of, sample, PixelSample { weight: 1.0, ..aim });
        return (SampleCombination::Neighbors, aims.into_iter().filter(|aim| aim.0 == here).map(own).collect());
    }
    (SampleCombination::Neighbors, aims.into_iter().map(|(of, sample, aim)| account(of, sample, aim)).collect())
}

/// Returns the sub-pixels that contribute to a pixel in the Fall 2012 course.
pub(super) fn sub_pixels(
    source: &SampleSource,
    world: &World,
    grid: SubPixels,
    account: impl Fn((u32, u32), u32, PixelSample) -> ExplainedSample,
) -> (SampleCombination, Vec<ExplainedSample>) {
    let (raster, count) = (grid.raster(world), grid.around.pixels() as usize);
    let one = |(i, place): (usize, (u32, u32))| {
        // Blurring and averaging are linear operations. The weight of a sub-pixel is therefore the
        // result when only this sub-pixel is white.
        let mut white = vec![Color::ZERO; count];
        white[i] = Color::ONE;
        let aim = source.aim.sub_pixel(&grid, &raster, place);
        account(grid.pixel(place), grid.number(place), PixelSample { weight: grid.blurred_mean(white)[0].x, ..aim })
    };
    let samples = grid.around.pixel_positions().enumerate().map(one).collect();
    (SampleCombination::SubPixels(grid), samples)
}

/// Returns the colour and coverage of the finished pixel.
pub(super) fn finished(
    mean: &SampleCombination,
    samples: &[ExplainedSample],
    light: impl Fn(&ExplainedSample) -> Option<Color>,
) -> (Color, f32) {
    let lights: Vec<Option<Color>> = samples.iter().map(light).collect();
    let colors = lights.iter().map(|light| light.unwrap_or(Vec3::ZERO)).collect();
    let color = combined(mean, samples, colors);
    if lights.iter().all(Option::is_some) {
        return (color, 1.0);
    }
    let mask = lights.iter().map(|light| if light.is_some() { Vec3::ONE } else { Vec3::ZERO }).collect();
    (color, coverage_of(combined(mean, samples, mask)))
}

/// Combines the colours of the samples into the colour of a pixel.
fn combined(mean: &SampleCombination, samples: &[ExplainedSample], colors: Vec<Color>) -> Color {
    if let SampleCombination::SubPixels(grid) = mean {
        return grid.blurred_mean(colors)[0];
    }
    let (mut sum, mut total) = (DVec3::ZERO, 0.0);
    for (sample, color) in samples.iter().zip(colors) {
        sum += f64::from(sample.weight) * color.as_dvec3();
        total += f64::from(sample.weight);
    }
    (sum / total).as_vec3()
}
