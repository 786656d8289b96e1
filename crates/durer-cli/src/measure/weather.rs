//! Weather files and the options that use them.

use crate::failure::{Failure, invalid_input};
use crate::file_registry::FileRegistry;
use crate::report;
use clap::Args;
use clap::builder::PossibleValuesParser;
use clap::builder::TypedValueParser as _;
use durer::daylight::{Schedule, SkyAxes, SkyYear, Thresholds};
use durer::diag::{Diagnostics, Files};
use durer::format::folder::FolderSource;
use durer::format::weather;
use durer::math::fp;
use durer::scene::Axis;
use durer::texture::sky::{Perez, SkyPatches};
use durer::weather::{Daylight, Weather, WeatherRow};
use std::path::{Path, PathBuf};

/// Maximum size of a weather file, in bytes.
const MAX_BYTES: u64 = 256 << 20;

/// Options for daylight from a weather file.
#[derive(Args)]
pub struct WeatherArgs {
    /// Compute the daylight of a year from a weather file (.epw, .wea), instead of all other light
    #[arg(long, value_name = "FILE", conflicts_with_all = ["observers", "error"])]
    pub weather: Option<PathBuf>,
    /// Measure the light of one hour of the weather file, for example 3-21T12:30
    #[arg(long, value_name = "M-DTH:M", value_parser = moment, requires = "weather")]
    pub sky_hour: Option<Instant>,
    /// Number of patches of the sky: 145, 577 or 2305 [default: 577]
    #[arg(
        long,
        value_name = "N",
        requires = "weather",
        conflicts_with = "sky_hour",
        hide_possible_values = true,
        value_parser = PossibleValuesParser::new(["145", "577", "2305"]).map(|word| word.parse::<usize>().unwrap_or(577))
    )]
    pub patches: Option<usize>,
    /// Direction of north, in degrees from -z (y if z is up) towards x [default: 0]
    #[arg(long, value_name = "DEGREES", requires = "weather", allow_hyphen_values = true)]
    pub north: Option<f64>,
    /// Share of its light that the ground below the horizon reflects [default: 0.2]
    #[arg(long, value_name = "SHARE", requires = "weather", value_parser = reflectance)]
    pub ground: Option<f32>,
    /// Hours of use, in the standard time of the weather file [default: 8-18]
    #[arg(long, value_name = "FROM-TO", value_parser = hours_of_use, requires = "weather", conflicts_with = "sky_hour")]
    pub occupied: Option<[f64; 2]>,
    /// Count only Monday to Friday
    #[arg(long, requires = "weather", conflicts_with = "sky_hour")]
    pub weekdays: bool,
    /// Target of the daylight autonomy [default: 300]
    #[arg(long, value_name = "LUX", value_parser = lux, requires = "weather", conflicts_with = "sky_hour")]
    pub target_lux: Option<f64>,
    /// Limits of useful daylight: too little, supplementary, autonomous, too much [default:
    /// 100,300,3000]
    #[arg(long, value_name = "A,B,C", value_parser = limits, requires = "weather", conflicts_with = "sky_hour")]
    pub useful: Option<[f64; 3]>,
    /// Write the illuminance of each point in each row of the weather file, as CSV
    #[arg(long, value_name = "FILE.csv", requires = "weather", conflicts_with = "sky_hour")]
    pub hours: Option<PathBuf>,
    /// Quantity that --plan shows: autonomy, continuous, useful, mean or sun [default: autonomy]
    #[arg(
        long,
        value_name = "QUANTITY",
        requires_all = ["weather", "plan"],
        conflicts_with = "sky_hour",
        hide_possible_values = true,
        value_parser = PossibleValuesParser::new(["autonomy", "continuous", "useful", "mean", "sun"])
    )]
    pub plan_shows: Option<String>,
}

/// Month, day and time of day in hours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instant {
    month: i32,
    day: i32,
    hours: f64,
}

/// Parses a month, a day and a time of day, such as 3-21T12:30, 03-21 12:30 or 3-21T12.
fn moment(text: &str) -> Result<Instant, String> {
    let parsed = || {
        let (date, time) = text.split_once(['T', ' '])?;
        let (month, day) = date.split_once('-')?;
        let (hours, minutes) = time.split_once(':').unwrap_or((time, "0"));
        let number = |word: &str, most: u32| word.parse::<u32>().ok().filter(|number| *number <= most);
        let (month, day) = (number(month, 12).filter(|n| *n > 0)?, number(day, 31).filter(|n| *n > 0)?);
        let hours = f64::from(number(hours, 24)?) + f64::from(number(minutes, 59)?) / 60.0;
        (hours <= 24.0).then_some(Instant { month: month as i32, day: day as i32, hours })
    };
    parsed().ok_or_else(|| "expected a month, a day and a time, for example 3-21T12:30".into())
}

/// Parses hours of use, such as 8-18 or 8.5-17.
fn hours_of_use(text: &str) -> Result<[f64; 2], String> {
    let hour = |word: &str| word.parse().ok().filter(|hour| (0.0..=24.0).contains(hour));
    let hours = text.split_once('-').and_then(|(from, to)| Some([hour(from)?, hour(to)?]));
    let hours = hours.filter(|[from, to]| from != to);
    hours.ok_or_else(|| "expected two different hours from 0 to 24, for example 8-18".into())
}

fn reflectance(text: &str) -> Result<f32, String> {
    text.parse().ok().filter(|share| (0.0..=1.0).contains(share)).ok_or_else(|| "expected a share from 0 to 1".into())
}

fn lux(text: &str) -> Result<f64, String> {
    let found = text.parse().ok().filter(|lux| *lux > 0.0 && *lux < 1e9);
    found.ok_or_else(|| "expected an illuminance in lux, more than 0".into())
}

/// Parses three illuminances in ascending order.
fn limits(text: &str) -> Result<[f64; 3], String> {
    let wanted = || "expected three illuminances in ascending order, for example 100,300,3000".to_string();
    let numbers: Vec<f64> = text.split(',').map(lux).collect::<Result<_, _>>().map_err(|_| wanted())?;
    <[f64; 3]>::try_from(numbers).ok().filter(|[a, b, c]| a < b && b < c).ok_or_else(wanted)
}

/// Reads a weather file.
pub fn read(path: &Path, registry: &mut FileRegistry) -> Result<Weather, Failure> {
    registry.register_input(path)?;
    let name = path.display().to_string();
    let bytes = FolderSource::new(".").budget(MAX_BYTES).read_path(path, &name).map_err(report::unreadable)?;
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let file = files.add(name, bytes.clone());
    let weather = weather::read(&bytes, file, &mut diagnostics);
    report::print(&files, &diagnostics, false);
    weather.ok_or(Failure::Input(None))
}

impl WeatherArgs {
    /// Returns the directions of the sky for a scene with the given up axis.
    pub fn axes(&self, up: Axis) -> Result<SkyAxes, Failure> {
        let turn = self.north.unwrap_or(0.0);
        if !(-360.0..=360.0).contains(&turn) {
            return Err(invalid_input("--north must be from -360 to 360 degrees"));
        }
        Ok(SkyAxes::new(up, turn))
    }

    /// Fraction of its light that the ground reflects.
    pub fn ground(&self) -> f32 {
        self.ground.unwrap_or(durer::texture::sky::REFLECTANCE)
    }

    /// Returns the sky of the year.
    pub fn year(&self, weather: &Weather, up: Axis) -> Result<SkyYear, Failure> {
        if self.weekdays && weather.rows.iter().all(|row| row.weekday.is_none()) {
            return Err(invalid_input("--weekdays needs the day of the week, which this weather file does not state"));
        }
        let patches = SkyPatches::new(self.patches.unwrap_or(SkyPatches::COUNTS[1]));
        let patches = patches.ok_or_else(|| invalid_input("--patches must be 145, 577 or 2305"))?;
        let year = SkyYear::new(weather, self.axes(up)?, patches, self.ground());
        match year.is_dark() {
            true => Err(invalid_input("the sky is dark in every row of the weather file")),
            false => Ok(year),
        }
    }

    /// Returns the hours during which the building is in use.
    pub fn schedule(&self) -> Schedule {
        let Schedule { from, to, .. } = Schedule::default();
        let [from, to] = self.occupied.unwrap_or([from, to]);
        Schedule { from, to, weekdays_only: self.weekdays }
    }

    /// Returns the illuminances that the figures use.
    pub fn thresholds(&self) -> Thresholds {
        let usual = Thresholds::default();
        Thresholds {
            target: self.target_lux.unwrap_or(usual.target),
            useful: self.useful.unwrap_or(usual.useful),
            ..usual
        }
    }
}

/// Returns the sky of a row of the weather, and a line that describes the row.
pub fn sky_at(weather: &Weather, instant: &Instant) -> Result<(Perez, String), Failure> {
    let Instant { month, day, hours } = *instant;
    let contains = |row: &&WeatherRow| {
        let [_, row_month, row_day] = row.date;
        // The last interval of a day includes midnight.
        let end = row.hours + 0.5 * row.duration + if hours == 24.0 { 1e-6 } else { -1e-9 };
        (row_month, row_day) == (month, day) && (row.hours - 0.5 * row.duration - 1e-9..end).contains(&hours)
    };
    let name = format!("{month}-{day} {:02}:{:02.0}", hours.trunc(), 60.0 * hours.fract());
    let row = weather.rows.iter().find(contains);
    let row = row.ok_or_else(|| invalid_input(format!("the weather file has no row for {name}")))?;
    match row.daylight(&weather.place) {
        Daylight::Missing => Err(invalid_input(format!("the weather file has no irradiance for {name}"))),
        Daylight::Dark => Err(invalid_input(format!("the sky is dark at {name}"))),
        Daylight::Sky(sky) => {
            let to_sun = row.to_sun(&weather.place);
            let altitude = fp::asin(to_sun.y).to_degrees();
            let azimuth = 360.0 * fp::atan2_turn(to_sun.x, -to_sun.z).rem_euclid(1.0);
            let [direct, diffuse] = [row.direct_normal, row.diffuse_horizontal].map(Option::unwrap_or_default);
            Ok((
                sky,
                format!(
                    "the sun is at altitude {altitude:.2}, azimuth {azimuth:.2}, with {direct} W/m^2 direct normal ({:.0} lux) \
                     and {diffuse} W/m^2 diffuse horizontal ({:.0} lux)",
                    sky.sun_illuminance(),
                    sky.sky_illuminance()
                ),
            ))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_are_parsed() {
        assert_eq!(moment("3-21T12:30"), Ok(Instant { month: 3, day: 21, hours: 12.5 }));
        assert_eq!(moment("03-01 9"), Ok(Instant { month: 3, day: 1, hours: 9.0 }));
        assert_eq!(moment("12-31T24:00").map(|instant| instant.hours), Ok(24.0));
        for wrong in ["", "3-21", "0-1T1", "13-1T1", "1-32T1", "1-1T25", "1-1T1:60", "1-1T24:30", "x-1T1", "1-1T-1"] {
            assert!(moment(wrong).is_err(), "{wrong}");
        }
        assert_eq!((hours_of_use("8-18"), hours_of_use("22-6.5")), (Ok([8.0, 18.0]), Ok([22.0, 6.5])));
        for wrong in ["", "8", "8-8", "8-25", "-1-8", "nan-8", "a-b"] {
            assert!(hours_of_use(wrong).is_err(), "{wrong}");
        }
        assert_eq!(limits("100,300,3000"), Ok([100.0, 300.0, 3000.0]));
        for wrong in ["", "100,300", "300,100,3000", "1,2,3,4", "0,1,2", "1,2,inf", "1,2,nan"] {
            assert!(limits(wrong).is_err(), "{wrong}");
        }
        assert!(reflectance("1.1").is_err() && reflectance("nan").is_err() && reflectance("0") == Ok(0.0));
    }
}
