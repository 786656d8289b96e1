//! Illuminance and irradiance at points of a scene, with standard errors.

use crate::integrator::{Integrate as _, Path};
use durer_scene::bsdf::Frame;
use durer_scene::math::{Color, Vec3, fp};
use durer_scene::sampler::SampleId;
use rayon::prelude::*;

/// Samples per point in the first pass with an error target. Later passes double the number.
const FIRST_PASS: u32 = 256;
/// Samples between two checks for cancellation.
const CANCEL_INTERVAL: u32 = 64;

/// Point at which light is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensor {
    /// Position in world space.
    pub point: Vec3,
    /// Unit normal on the side from which light is measured.
    pub normal: Vec3,
}

/// Quantity that is measured at a sensor. Source: EN 12665.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum IlluminanceKind {
    /// Illuminance of a plane with the sensor's normal.
    #[default]
    Planar,
    /// Illuminance of the lateral surface of a small cylinder whose axis is the sensor's normal. It
    /// is the mean illuminance of all planes through the axis.
    Cylindrical,
    /// Illuminance of a small sphere, which is the mean illuminance of planes of all orientations.
    Spherical,
}

impl IlluminanceKind {
    /// All kinds.
    pub const ALL: [IlluminanceKind; 3] = [Self::Planar, Self::Cylindrical, Self::Spherical];

    /// Returns the name of the kind, in lower case.
    pub fn name(self) -> &'static str {
        match self {
            Self::Planar => "planar",
            Self::Cylindrical => "cylindrical",
            Self::Spherical => "spherical",
        }
    }

    /// Returns the kind with the given name.
    pub fn from_name(name: &str) -> Option<IlluminanceKind> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }

    /// Returns the unit normal of the plane that receives the light of a sample. The normals of all
    /// samples follow an additive sequence, which is independent of the Sobol numbers of the paths.
    ///
    /// Source: Martin Roberts, *The Unreasonable Effectiveness of Quasirandom Sequences*, 2018.
    fn plane(self, axis: Vec3, sample: u32) -> Vec3 {
        let share = |step: f64| (f64::from(sample) * step).fract() as f32;
        let (azimuth, z) = match self {
            Self::Planar => return axis,
            Self::Cylindrical => (share(0.618_033_988_749_894_9), 0.0),
            Self::Spherical => (share(0.754_877_666_246_692_7), 1.0 - 2.0 * share(0.569_840_290_998_053_3)),
        };
        let (sin, cos) = fp::sin_cos_turn(azimuth);
        let radius = (1.0 - z * z).max(0.0).sqrt();
        Frame::around(axis).to_world(Vec3::new(radius * cos, radius * sin, z)).normalize()
    }
}

/// Options of [`measure`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasureOptions {
    /// Quantity to measure.
    pub kind: IlluminanceKind,
    /// Samples per point; the maximum number with `error`.
    pub samples: u32,
    /// Relative standard error of the illuminance at which a point needs no more samples, for
    /// example 0.01. Points without any light found take all samples.
    pub error: Option<f64>,
    /// Seed of the random number generator.
    pub seed: u64,
    /// Luminous efficacy of each channel: the illuminance is the dot product with the irradiance.
    pub lumens: Color,
}

impl MeasureOptions {
    /// Returns the usual number of samples, which depends on the error target.
    pub fn default_samples(error: Option<f64>) -> u32 {
        if error.is_some() { 1 << 20 } else { 4096 }
    }
}

/// Light that arrives at a [`Sensor`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// Irradiance per channel.
    pub irradiance: [f64; 3],
    /// Illuminance.
    pub illuminance: f64,
    /// Standard error of the illuminance, if the samples were independent. It includes the effect
    /// of one more sample of a light that only BSDF sampling can find.
    pub error: f64,
    /// Number of samples that were taken.
    pub samples: u32,
}

/// Result of [`measure`].
#[derive(Clone, Debug, PartialEq)]
pub struct Measurement {
    /// Light at each sensor.
    pub points: Vec<Measured>,
    /// True if lights that only BSDF sampling can find dominate the error of a point.
    pub has_rare_light: bool,
}

/// Minimum, average and uniformity of several illuminances. Source: EN 12464-1, section 3.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Uniformity {
    /// Minimum illuminance.
    pub min: f64,
    /// Average illuminance.
    pub average: f64,
    /// Maximum illuminance.
    pub max: f64,
}

impl Uniformity {
    /// Computes the figures, or returns `None` without points.
    pub fn of(points: &[Measured]) -> Option<Uniformity> {
        let values = || points.iter().map(|point| point.illuminance);
        let average = values().sum::<f64>() / points.len() as f64;
        let (min, max) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
        (!points.is_empty()).then_some(Uniformity { min, average, max })
    }

    /// Minimum divided by the average (U0); 0 in the dark.
    pub fn u0(&self) -> f64 {
        if self.average > 0.0 { self.min / self.average } else { 0.0 }
    }

    /// Minimum divided by the maximum (U1); 0 in the dark.
    pub fn u1(&self) -> f64 {
        if self.max > 0.0 { self.min / self.max } else { 0.0 }
    }
}

/// Sums over the samples at one sensor.
#[derive(Clone, Default)]
struct Sums {
    light: [f64; 3],
    bright: f64,
    squares: f64,
    samples: u32,
}

impl Sums {
    fn add(&mut self, light: Color, lumens: Color) {
        let brightness = f64::from(light.dot(lumens));
        self.light = std::array::from_fn(|i| self.light[i] + f64::from(light[i]));
        self.bright += brightness;
        self.squares += brightness * brightness;
        self.samples += 1;
    }

    /// Returns the means and the standard error. `rare` is the largest value of a light that only
    /// BSDF sampling can find. One more sample of this kind would raise the mean by `rare` divided
    /// by the number of samples, so the error includes that amount.
    fn mean(&self, rare: f64) -> Measured {
        let n = f64::from(self.samples);
        let mean = self.bright / n;
        let variance = (self.squares / n - mean * mean).max(0.0) / n;
        Measured {
            irradiance: self.light.map(|sum| sum / n),
            illuminance: mean,
            error: (variance + (rare / n) * (rare / n)).sqrt(),
            samples: self.samples,
        }
    }
}

/// Measures the light at points. The result does not depend on the number of threads. `progress`
/// receives the finished share of the samples, from 0 to 1. If `path` is cancelled, the result is
/// incomplete and must be discarded.
pub fn measure(
    path: &Path,
    sensors: &[Sensor],
    options: &MeasureOptions,
    progress: &(dyn Fn(f64) + Sync),
) -> Measurement {
    let MeasureOptions { kind, samples, error, seed, lumens } = *options;
    let rare = f64::from(path.max_rare_contribution(|color| color.dot(lumens)));
    let mut sums = vec![Sums::default(); sensors.len()];
    let mut first = 0;
    while first < samples {
        // Photons are traced again for every sample.
        let step = match (&path.photons, error) {
            (Some(_), _) => 1,
            (None, Some(_)) => first.max(FIRST_PASS),
            (None, None) => samples.div_ceil(16).max(FIRST_PASS),
        };
        let end = samples.min(first.saturating_add(step));
        let is_checked = first >= FIRST_PASS && (path.photons.is_none() || first.is_power_of_two());
        let target = error.filter(|_| is_checked);
        path.prepare(first);
        sums.par_iter_mut().zip(sensors).enumerate().for_each(|(number, (sums, sensor))| {
            // A sensor that has once reached the target has fewer samples than the pass assumes.
            if path.is_cancelled()
                || sums.samples < first
                || target.is_some_and(|target| is_precise(sums, rare, target))
            {
                return;
            }
            for sample in first..end {
                if sample % CANCEL_INTERVAL == 0 && path.is_cancelled() {
                    return;
                }
                let id = SampleId::new(seed, (number as u32, 0), sample);
                let normal = kind.plane(sensor.normal, sample);
                sums.add(path.irradiance(sensor.point.as_dvec3(), normal, id, &mut ()), lumens);
            }
        });
        first = end;
        progress(f64::from(first) / f64::from(samples));
        if path.is_cancelled() {
            break;
        }
        if error.is_some() && sums.iter().all(|sums| sums.samples < first) {
            break;
        }
    }
    let points: Vec<Measured> = sums.iter().map(|sums| sums.mean(rare)).collect();
    let is_rare = |point: &Measured| rare / f64::from(point.samples) > 0.01 * point.illuminance.max(point.error);
    Measurement { has_rare_light: points.iter().any(is_rare), points }
}

/// Returns true if the relative standard error at a sensor has reached the target.
fn is_precise(sums: &Sums, rare: f64, target: f64) -> bool {
    let mean = sums.mean(rare);
    mean.illuminance > 0.0 && mean.error <= target * mean.illuminance
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uniformity_of_values() {
        let point = |illuminance| Measured { irradiance: [0.0; 3], illuminance, error: 0.0, samples: 1 };
        let figures = Uniformity::of(&[200.0, 500.0, 800.0].map(point)).unwrap();
        assert_eq!((figures.u0(), figures.u1(), figures.average), (0.4, 0.25, 500.0));
        let dark = Uniformity::of(&[point(0.0)]).unwrap();
        assert_eq!((dark.u0(), dark.u1()), (0.0, 0.0));
        assert_eq!(Uniformity::of(&[]), None);
    }
}
