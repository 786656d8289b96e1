//! Daylight of hours and years from weather files, by daylight coefficients.
//!
//! The daylight coefficients of a sensor are its illuminances from the patches of the sky, each
//! with a luminance of 1 cd/m^2. One Monte-Carlo pass per sensor computes the coefficients of all
//! patches: paths are traced under a sky that is white in every direction, and each contribution is
//! added to the patch from which its light comes. The illuminance of an hour is then a sum over the
//! patches. Direct sunlight is not blurred over patches: shadow rays to the position of the sun in
//! each hour compute it. Sunlight that the scene reflects comes from the same pass, interpolated
//! between the patches around the sun.
//!
//! Sources: Tregenza and Waters, *Daylight coefficients*, Lighting Research and Technology 15,
//! 1983; Bourgeois, Reinhart and Ward, *Standard daylight coefficient model for dynamic daylighting
//! simulations*, Building Research and Information 36, 2008, for the separate treatment of direct
//! sunlight.
//!
//! ```
//! use durer_render::daylight::{AnnualOptions, SkyAxes, SkyYear, annual};
//! use durer_render::integrator::{Path, PathOptions, RenderSettings};
//! use durer_render::measure::Sensor;
//! use durer_render::world::World;
//! use durer_scene::scene::Axis;
//! use durer_scene::texture::sky::SkyPatches;
//! use durer_scene::weather::Weather;
//!
//! /// Returns the share of the occupied hours in which a sensor has 300 lux of daylight.
//! fn autonomy(world: World, weather: &Weather, sensor: Sensor, settings: RenderSettings) -> f64 {
//!     let patches = SkyPatches::new(577).unwrap();
//!     let year = SkyYear::new(weather, SkyAxes::new(Axis::Y, 0.0), patches, 0.2);
//!     let world = year.light(world);
//!     let path = Path::new(&world, settings, PathOptions::default());
//!     let found = annual(&path, &year, &[sensor], &AnnualOptions::default(), &|_| {});
//!     found.sensors[0].figures.autonomy
//! }
//! ```

mod batches;
mod coefficients;
mod figures;
mod sky_year;

use crate::integrator::Path;
use crate::measure::Sensor;
use batches::{BATCHES, jackknife_error};
pub use coefficients::AnnualIlluminance;
use coefficients::Coefficients;
use figures::Occupied;
pub use figures::{AnnualFigures, Schedule, Thresholds, daylit_share};
use rayon::prelude::*;
pub use sky_year::{SkyAxes, SkyYear, light_of_hour};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// Options of [`annual`].
#[derive(Clone, Debug, PartialEq)]
pub struct AnnualOptions {
    /// Samples per sensor, rounded up to a multiple of 16; at least 32.
    pub samples: u32,
    /// Seed of the random number generator.
    pub seed: u64,
    /// Hours during which the building is in use.
    pub schedule: Schedule,
    /// Illuminances that the figures use.
    pub thresholds: Thresholds,
    /// True to keep the illuminances of all rows in [`SensorYear::hours`].
    pub keeps_hours: bool,
}

impl Default for AnnualOptions {
    fn default() -> Self {
        AnnualOptions {
            samples: 1 << 14,
            seed: 0,
            schedule: Schedule::default(),
            thresholds: Thresholds::default(),
            keeps_hours: false,
        }
    }
}

/// Daylight of a year at one sensor.
#[derive(Clone, Debug, PartialEq)]
pub struct SensorYear {
    /// Figures over the occupied hours.
    pub figures: AnnualFigures,
    /// Standard errors of the figures, from the noise of the paths. They do not include the errors
    /// of the sky's model or of its division into patches.
    pub errors: AnnualFigures,
    /// Illuminance of each row of the weather, in its order; empty unless it was requested.
    pub hours: Vec<AnnualIlluminance>,
    /// Daylight autonomy without each of the batches of samples, for the error of
    /// [`Annual::spatial_autonomy`].
    partial: [f64; BATCHES],
}

/// Result of [`annual`].
#[derive(Clone, Debug, PartialEq)]
pub struct Annual {
    /// Daylight at each sensor.
    pub sensors: Vec<SensorYear>,
    /// Occupied hours of the year that count.
    pub occupied_hours: f64,
    /// Occupied hours that are left out, because the sun is up but the weather file has no values.
    pub missing_hours: f64,
}

/// Computes the daylight of a year. The world of `path` must be [lit by the year](SkyYear::light).
/// The result does not depend on the number of threads. `progress` receives the finished share of
/// the work, from 0 to 1.
pub fn annual(
    path: &Path,
    year: &SkyYear,
    sensors: &[Sensor],
    options: &AnnualOptions,
    progress: &(dyn Fn(f64) + Sync),
) -> Annual {
    let per_batch = options.samples.div_ceil(BATCHES as u32).max(2);
    let occupied = Occupied::new(year, &options.schedule);
    let finished = AtomicUsize::new(0);
    let advance = || {
        let all = sensors.len() * (BATCHES + 1);
        progress((finished.fetch_add(1, Relaxed) + 1) as f64 / all as f64);
    };
    let of_sensor = |(number, sensor): (usize, &Sensor)| {
        let batch = |batch: usize| {
            let first = batch as u32 * per_batch;
            let found =
                Coefficients::trace(path, year, sensor, (options.seed, number as u32), first..first + per_batch);
            advance();
            found
        };
        let batches: Vec<Coefficients> = (0..BATCHES).into_par_iter().map(batch).collect();
        let sun = coefficients::direct_sun(path, year, sensor, (options.seed, number as u32));
        let hours = coefficients::illuminances(year, &batches, &sun);
        advance();
        let (figures, errors, partial) = figures::of_year(year, &occupied, &hours, &sun, &options.thresholds);
        let hours = if options.keeps_hours { coefficients::by_row(year, &hours) } else { Vec::new() };
        SensorYear { figures, errors, hours, partial }
    };
    let sensors = sensors.par_iter().enumerate().map(of_sensor).collect();
    Annual { sensors, occupied_hours: occupied.hours, missing_hours: occupied.missing }
}

impl Annual {
    /// Returns the share of the given sensors that have the target illuminance during at least the
    /// share `enough` of the occupied hours (spatial daylight autonomy), and its standard error.
    /// Source: IES LM-83, with a share of 0.5 and 300 lux.
    pub fn spatial_autonomy(&self, sensors: &[usize], enough: f64) -> [f64; 2] {
        let share = |autonomy: &dyn Fn(&SensorYear) -> f64| {
            daylit_share(sensors.iter().map(|&sensor| autonomy(&self.sensors[sensor])), enough)
        };
        let without: Vec<f64> = (0..BATCHES).map(|batch| share(&|sensor| sensor.partial[batch])).collect();
        [share(&|sensor| sensor.figures.autonomy), jackknife_error(&without)]
    }

    /// Returns the share of the given sensors with direct sunlight during more than `hours` hours
    /// (annual sunlight exposure). Source: IES LM-83, with 1000 lux and 250 hours.
    pub fn sun_exposure(&self, sensors: &[usize], hours: f64) -> f64 {
        let exposed = sensors.iter().filter(|&&sensor| self.sensors[sensor].figures.sun_hours > hours);
        exposed.count() as f64 / sensors.len() as f64
    }
}

#[cfg(test)]
mod tests;
