//! Daylight of a year at the measuring points: `--weather`.

use super::grid::Grid;
use super::plan::{self, Legend};
use super::printed::{left_out, vector};
use super::{MeasureArgs, enclosed, print_written_to_error};
use crate::failure::Failure;
use crate::progress::show_progress;
use crate::report;
use crate::terminal::{print_error_line, print_line};
use durer::daylight::{Annual, AnnualFigures, AnnualOptions, SensorYear, SkyYear, annual};
use durer::diag::Diagnostic;
use durer::image::{Destination, save_all};
use durer::integrator::Path;
use durer::math::Vec3;
use durer::measure::Sensor;
use durer::weather::Weather;
use serde_json::{Value, json};
use std::fmt::Write as _;

/// Default number of samples per point.
const SAMPLES: u32 = 1 << 14;
/// Share of the occupied hours in which a point must reach the target to count as daylit. Source:
/// IES LM-83.
const ENOUGH: f64 = 0.5;
/// Hours of direct sunlight above which a point is overexposed. Source: IES LM-83.
const SUN_HOURS: f64 = 250.0;

/// Files that are written in addition to the figures.
pub struct Outputs {
    /// Plan of the grid.
    pub plan: Option<Destination>,
    /// Illuminances of all rows.
    pub hours: Option<Destination>,
}

/// Points with their daylight, of which the last ones belong to grids.
struct Points<'a> {
    sensors: &'a [Sensor],
    found: Annual,
    /// For each point, true if it is inside an object and therefore not part of any figures.
    inside: Vec<bool>,
    /// Number of single points.
    alone: usize,
    grids: &'a [Grid],
}

/// Grid with the numbers of its points.
struct GridPoints<'a> {
    grid: &'a Grid,
    /// All points.
    all: Vec<usize>,
    /// Points outside objects.
    outside: Vec<usize>,
}

/// Computes and prints the daylight of a year.
pub fn run(
    args: &MeasureArgs,
    path: &Path,
    (weather, year): (&Weather, &SkyYear),
    (sensors, alone): (&[Sensor], usize),
    up: Vec3,
    outputs: &Outputs,
) -> Result<(), Failure> {
    let options = AnnualOptions {
        samples: args.samples.unwrap_or(SAMPLES),
        seed: args.seed,
        schedule: args.weather.schedule(),
        thresholds: args.weather.thresholds(),
        keeps_hours: outputs.hours.is_some(),
    };
    let found = show_progress("tracing daylight", |progress| annual(path, year, sensors, &options, progress));
    let is_used = found.occupied_hours > 0.0;
    let is_dark: Vec<bool> = found.sensors.iter().map(|one| is_used && one.figures.mean == 0.0).collect();
    let inside = enclosed::find(path.world, sensors, &is_dark);
    let points = Points { sensors, found, inside, alone, grids: &args.grid };
    match args.json {
        true => print_line(&serde_json::to_string_pretty(&points.as_json(&options, weather))?),
        false => points.print_rows(&options),
    }
    if !args.quiet {
        points.warn();
        if !args.json {
            points.print_summaries(&options);
        }
    }
    let mut files = Vec::new();
    if let (Some(file), Some(grid)) = (&outputs.plan, points.grids().next()) {
        files.push((file, points.plan(&grid, args, &options, up).into_bytes()));
    }
    if let Some(file) = &outputs.hours {
        files.push((file, points.hours(weather).into_bytes()));
    }
    save_all(&files)?;
    files.iter().for_each(|(file, _)| print_written_to_error(file, args.quiet));
    Ok(())
}

impl<'a> Points<'a> {
    fn grids(&self) -> impl Iterator<Item = GridPoints<'a>> {
        let mut first = self.alone;
        self.grids.iter().map(move |grid| {
            let all: Vec<usize> = (first..first + grid.len()).collect();
            first += grid.len();
            let outside = all.iter().copied().filter(|&point| !self.inside[point]).collect();
            GridPoints { grid, all, outside }
        })
    }

    /// Prints a row per point.
    fn print_rows(&self, options: &AnnualOptions) {
        let [low, some, most] = options.thresholds.useful;
        print_line(&format!(
            "x,y,z,nx,ny,nz,autonomy,autonomy_error,continuous,useful_below_{low},useful_{low}_{some},useful_{some}_{most},\
             useful_above_{most},useful_error,mean,mean_error,sun_hours"
        ));
        for (sensor, SensorYear { figures, errors, .. }) in self.sensors.iter().zip(&self.found.sensors) {
            let [p, n] = [sensor.point, sensor.normal].map(vector);
            let useful = figures.useful.map(|share| format!("{share:.5}")).join(",");
            let useful_error = errors.useful.into_iter().fold(0.0, f64::max);
            print_line(&format!(
                "{p},{n},{:.5},{:.5},{:.5},{useful},{useful_error:.5},{:.2},{:.2},{}",
                figures.autonomy,
                errors.autonomy,
                figures.continuous_autonomy,
                figures.mean,
                errors.mean,
                figures.sun_hours
            ));
        }
    }

    /// Returns the mean over points of a figure.
    fn mean(&self, points: &[usize], figure: fn(&AnnualFigures) -> f64) -> f64 {
        points.iter().map(|&point| figure(&self.found.sensors[point].figures)).sum::<f64>() / points.len() as f64
    }

    /// Prints the figures of each grid to standard error.
    fn print_summaries(&self, options: &AnnualOptions) {
        let target = options.thresholds.target;
        print_error_line(&format!("note: {} occupied hours", self.found.occupied_hours));
        for (number, GridPoints { all, outside, .. }) in self.grids().enumerate() {
            if outside.is_empty() {
                continue;
            }
            let [spatial, error] = self.found.spatial_autonomy(&outside, ENOUGH);
            let left_out = left_out(outside.len(), all.len());
            print_error_line(&format!(
                "note: grid {}: daylight autonomy ({target} lux) {:.1} % on average, sDA {target}/50% {:.1} % (error {:.1}), \
                 useful daylight {:.1} %, ASE 1000,250h {:.1} %{left_out}",
                number + 1,
                100.0 * self.mean(&outside, |figures| figures.autonomy),
                100.0 * spatial,
                100.0 * error,
                100.0 * self.mean(&outside, AnnualFigures::useful_share),
                100.0 * self.found.sun_exposure(&outside, SUN_HOURS)
            ));
        }
    }

    /// Warns about what the figures leave out.
    fn warn(&self) {
        let Annual { occupied_hours, missing_hours, .. } = self.found;
        if occupied_hours == 0.0 {
            report::note(
                &Diagnostic::warning("no row of the weather file is within the hours of use").code("no-hours"),
            );
        }
        if missing_hours > 0.0 {
            let message = format!("{missing_hours} occupied hours without irradiance in the weather file are left out");
            report::note(&Diagnostic::warning(message).code("missing-hours"));
        }
        enclosed::warn(self.sensors, &self.inside);
    }

    fn as_json(&self, options: &AnnualOptions, weather: &Weather) -> Value {
        let figures = |figures: &AnnualFigures| {
            json!({
                "autonomy": figures.autonomy,
                "continuous_autonomy": figures.continuous_autonomy,
                "useful": figures.useful,
                "mean": figures.mean,
            })
        };
        let point = |((sensor, found), inside): ((&Sensor, &SensorYear), &bool)| {
            let mut value = figures(&found.figures);
            value["point"] = json!(sensor.point.to_array());
            value["normal"] = json!(sensor.normal.to_array());
            value["sun_hours"] = json!(found.figures.sun_hours);
            value["errors"] = figures(&found.errors);
            value["inside"] = json!(inside);
            value
        };
        let grid = |GridPoints { grid, all, outside }: GridPoints| {
            let [spatial, error] = self.found.spatial_autonomy(&outside, ENOUGH);
            let counts = grid.counts;
            (!outside.is_empty()).then(|| {
                json!({
                    "counts": counts,
                    "autonomy": self.mean(&outside, |figures| figures.autonomy),
                    "useful": self.mean(&outside, AnnualFigures::useful_share),
                    "spatial_autonomy": spatial,
                    "spatial_autonomy_error": error,
                    "sun_exposure": self.found.sun_exposure(&outside, SUN_HOURS),
                    "inside": all.len() - outside.len(),
                })
            })
        };
        let place = &weather.place;
        json!({
            "units": { "mean": "lux", "sun_hours": "h", "others": "share of the occupied hours or of the points" },
            "place": {
                "name": place.name,
                "latitude": place.latitude,
                "longitude": place.longitude,
                "time_zone": place.time_zone,
            },
            "occupied_hours": self.found.occupied_hours,
            "missing_hours": self.found.missing_hours,
            "target": options.thresholds.target,
            "useful_limits": options.thresholds.useful,
            "points": self.sensors.iter().zip(&self.found.sensors).zip(&self.inside).map(point).collect::<Vec<_>>(),
            "grids": self.grids().filter_map(grid).collect::<Vec<_>>(),
        })
    }

    /// Draws a plan of the figure that `--plan-shows` selects.
    fn plan(&self, grid: &GridPoints, args: &MeasureArgs, options: &AnnualOptions, up: Vec3) -> String {
        let shown = args.weather.plan_shows.as_deref().unwrap_or("autonomy");
        let target = options.thresholds.target;
        let (figure, unit, name): (fn(&AnnualFigures) -> f64, _, _) = match shown {
            "continuous" => {
                (|one| 100.0 * one.continuous_autonomy, "%", format!("continuous daylight autonomy, {target} lux"))
            }
            "useful" => {
                let [low, _, most] = options.thresholds.useful;
                (|one| 100.0 * one.useful_share(), "%", format!("useful daylight, {low} to {most} lux"))
            }
            "mean" => (|one| one.mean, "lux", "mean illuminance".into()),
            "sun" => (|one| one.sun_hours, "h", format!("direct sunlight above {} lux", options.thresholds.sun)),
            _ => (|one| 100.0 * one.autonomy, "%", format!("daylight autonomy, {target} lux")),
        };
        let value = |&point: &usize| match self.inside[point] {
            true => f64::NAN,
            false => figure(&self.found.sensors[point].figures),
        };
        let values: Vec<f64> = grid.all.iter().map(value).collect();
        let mean = self.mean(&grid.outside, figure);
        let caption = format!("{name}, {} occupied hours: average {mean:.1} {unit}", self.found.occupied_hours);
        plan::draw(grid.grid, &values, up, &Legend { unit, caption, levels: &args.levels })
    }

    /// Returns a table with a row per row of the weather, and two columns per point.
    fn hours(&self, weather: &Weather) -> String {
        let columns = (0..self.sensors.len()).map(|point| format!(",lux_{point},error_{point}"));
        let mut text = format!("year,month,day,hour{}\n", columns.collect::<String>());
        for (row, interval) in weather.rows.iter().enumerate() {
            let [year, month, day] = interval.date;
            // Writing to a string never fails.
            let _ = write!(text, "{year},{month},{day},{}", interval.hours);
            for found in self.found.sensors.iter().map(|found| found.hours[row]) {
                let _ = match found.illuminance.is_nan() {
                    true => write!(text, ",,"),
                    false => write!(text, ",{:.2},{:.2}", found.illuminance, found.error),
                };
            }
            text.push('\n');
        }
        text
    }
}
