//! Daylight coefficients of a sensor, and the illuminances that follow from them.

use super::batches::{BATCHES, Batches, mean_and_error};
use super::sky_year::{BrightHour, SkyYear, SunOfHour};
use crate::integrator::Path;
use crate::integrator::trace::{SkyLight, TraceListener};
use crate::measure::Sensor;
use durer_bvh::TraversalCounter;
use durer_scene::bsdf::{Frame, warp};
use durer_scene::math::{Color, LUMINANCE, fp};
use durer_scene::sampler::{SampleId, sample_2d};
use durer_scene::texture::sky::SUN_RADIUS;
use std::f64::consts::PI;
use std::ops::Range;

/// Shadow rays to the disc of the sun per sensor and interval.
const SUN_RAYS: u32 = 4;

/// Illuminance of one row of the weather.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AnnualIlluminance {
    /// Illuminance in lux; NaN if the weather file has no values although the sun is up.
    pub illuminance: f32,
    /// Standard error in lux.
    pub error: f32,
}

/// Daylight coefficients of a sensor, from one batch of samples.
pub(super) struct Coefficients {
    /// Illuminance from each patch and from the ground for a luminance of 1, in steradians.
    all: Vec<f64>,
    /// Part of it that surfaces of the scene reflect or scatter.
    reflected: Vec<f64>,
}

/// Listener that adds up the light from each patch.
struct Collector<'a> {
    year: &'a SkyYear,
    /// Weights of the colour channels in a luminance, with a sum of 1.
    weights: Color,
    sums: Coefficients,
}

impl TraversalCounter for Collector<'_> {
    const COUNTS_WORK: bool = false;
}

impl TraceListener for Collector<'_> {
    fn sky(&mut self, light: impl FnOnce() -> SkyLight) {
        let SkyLight { dir, is_direct, throughput } = light();
        let (patch, value) = (self.year.patch(dir), PI * f64::from(throughput.dot(self.weights)));
        self.sums.all[patch] += value;
        if !is_direct {
            self.sums.reflected[patch] += value;
        }
    }
}

/// Returns the weights of the colour channels in a luminance, with a sum of 1.
fn weights(path: &Path) -> Color {
    path.world.lumens().map_or(LUMINANCE, |lumens| lumens / lumens.element_sum())
}

impl Coefficients {
    /// Traces a batch of paths from a sensor. `seed` is the seed of the random numbers and the
    /// number of the sensor.
    pub fn trace(path: &Path, year: &SkyYear, sensor: &Sensor, seed: (u64, u32), samples: Range<u32>) -> Self {
        let zero = vec![0.0; year.patches.count() + 1];
        let sums = Coefficients { all: zero.clone(), reflected: zero };
        let mut collector = Collector { year, weights: weights(path), sums };
        let count = f64::from(samples.end - samples.start);
        for sample in samples {
            let id = SampleId::new(seed.0, (seed.1, 0), sample);
            path.irradiance(sensor.point.as_dvec3(), sensor.normal, id, &mut collector);
        }
        let Coefficients { mut all, mut reflected } = collector.sums;
        all.iter_mut().chain(&mut reflected).for_each(|sum| *sum /= count);
        Coefficients { all, reflected }
    }
}

/// Returns the illuminance of a sensor by direct sunlight in each bright interval, in lux. Shadow
/// rays go to points of the sun's disc.
pub(super) fn direct_sun(path: &Path, year: &SkyYear, sensor: &Sensor, seed: (u64, u32)) -> Vec<f32> {
    let cosine = fp::sin_cos_degrees(f64::from(SUN_RADIUS)).1 as f32;
    let weights = weights(path);
    let of_hour = |hour: &BrightHour| {
        let Some(SunOfHour { dir, illuminance, .. }) = &hour.sun else { return 0.0 };
        // No point of the disc is in front of the sensor.
        if dir.dot(sensor.normal) <= -0.005 {
            return 0.0;
        }
        let frame = Frame::around(*dir);
        let visible = |ray: u32| {
            let u = sample_2d(seed.0, seed.1, 1, SUN_RAYS * hour.row as u32 + ray, 0);
            let to_sun = frame.to_world(warp::polar(1.0 - u.x * (1.0 - cosine), u.y));
            let id = SampleId::new(seed.0, (seed.1, 1), SUN_RAYS * hour.row as u32 + ray);
            let facing = to_sun.dot(sensor.normal);
            if facing <= 0.0 {
                return 0.0;
            }
            facing * path.visibility_of_direction(sensor.point.as_dvec3(), sensor.normal, to_sun, id).dot(weights)
        };
        illuminance * (0..SUN_RAYS).map(visible).sum::<f32>() / SUN_RAYS as f32
    };
    year.bright.iter().map(of_hour).collect()
}

/// Returns the illuminances of a sensor in all bright intervals, for each batch of samples. `sun`
/// is the direct sunlight.
pub(super) fn illuminances(year: &SkyYear, batches: &[Coefficients], sun: &[f32]) -> Vec<Batches> {
    let by_patch = |values: fn(&Coefficients) -> &[f64]| -> Vec<Batches> {
        let patch = |patch| std::array::from_fn(|batch| values(&batches[batch])[patch] as f32);
        (0..year.patches.count() + 1).map(patch).collect()
    };
    let (all, reflected) = (by_patch(|one| &one.all), by_patch(|one| &one.reflected));
    let add = |sums: &mut Batches, factor: f32, values: &Batches| {
        sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += factor * value);
    };
    let of_hour = |(hour, direct): (&BrightHour, &f32)| {
        let mut sums = [*direct; BATCHES];
        hour.luminances.iter().zip(&all).for_each(|(luminance, values)| add(&mut sums, *luminance, values));
        if let Some(SunOfHour { illuminance, around, .. }) = &hour.sun {
            around.iter().for_each(|(patch, weight)| {
                add(&mut sums, illuminance * weight, &reflected[*patch as usize]);
            });
        }
        sums
    };
    year.bright.iter().zip(sun).map(of_hour).collect()
}

/// Sorts the illuminances of the bright intervals into the rows of the weather.
pub(super) fn by_row(year: &SkyYear, hours: &[Batches]) -> Vec<AnnualIlluminance> {
    let dark = |missing: &bool| match missing {
        true => AnnualIlluminance { illuminance: f32::NAN, error: f32::NAN },
        false => AnnualIlluminance { illuminance: 0.0, error: 0.0 },
    };
    let mut rows: Vec<AnnualIlluminance> = year.missing.iter().map(dark).collect();
    for (BrightHour { row, .. }, batches) in year.bright.iter().zip(hours) {
        let [mean, error] = mean_and_error(batches);
        rows[*row] = AnnualIlluminance { illuminance: mean as f32, error: error as f32 };
    }
    rows
}

#[cfg(test)]
impl Coefficients {
    /// Sum over all patches and the ground.
    pub fn sum(&self) -> f64 {
        self.all.iter().sum()
    }

    /// Coefficient of the ground.
    pub fn ground(&self) -> f64 {
        self.all[self.all.len() - 1]
    }
}
