//! Generates the output of `gensky`: the sun and a CIE sky. The sun and the sky follow from the
//! location, date and time, or from the angles of the sun.
//!
//! Sources: the manual page of gensky; Cooper, *The absorption of radiation in solar stills*, Solar
//! Energy 12, 1969, for the declination; IES, *Recommended Practice for the Calculation of Daylight
//! Availability*, 1984, for the equation of time and the sun's brightness; Krochmann and Seidl,
//! *Quantitative data on daylight for illuminating engineering*, 1974, for the zenith brightness.
//! The tests compare the output with that of the program in Radiance 6.0.

use super::words::Word;
use crate::shared_report::SharedReport;
use durer_diag::Diagnostic;
use durer_scene::math::fp;
use durer_scene::texture::almanac::{self, Moment};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

/// Luminous efficacy of light from the sky and from the sun, in lumens per watt.
const SKY_EFFICACY: f64 = 203.0;
const SUN_EFFICACY: f64 = 208.0;
/// Solid angle of the sun in steradians. The angular diameter of the sun is half a degree.
const SUN_SOLID_ANGLE: f64 = 5.98e-5;

/// Type of sky that `gensky` generates.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Clear,
    Intermediate,
    Overcast,
    Uniform,
}

/// Arguments of a `gensky` command after parsing. Angles are in degrees, and radiances are in W/(sr
/// m²).
struct SkyArgs {
    kind: Kind,
    sunny: bool,
    latitude: f64,
    /// Longitude in degrees west of Greenwich. The standard meridian of the clock time, `meridian`,
    /// has the same unit.
    longitude: f64,
    meridian: f64,
    year: Option<i32>,
    turbidity: f64,
    ground: f64,
    zenith: Option<f64>,
    horizontal: Option<f64>,
    sun: Option<f64>,
    sun_horizontal: Option<f64>,
}

/// Standard meridians of time zones, in degrees west of Greenwich.
const ZONES: [(&str, f64); 28] = [
    ("YST", 135.0),
    ("YDT", 120.0),
    ("PST", 120.0),
    ("PDT", 105.0),
    ("MST", 105.0),
    ("MDT", 90.0),
    ("CST", 90.0),
    ("CDT", 75.0),
    ("EST", 75.0),
    ("EDT", 60.0),
    ("AST", 60.0),
    ("ADT", 45.0),
    ("NST", 52.5),
    ("NDT", 37.5),
    ("GMT", 0.0),
    ("BST", -15.0),
    ("CET", -15.0),
    ("CEST", -30.0),
    ("EET", -30.0),
    ("EEST", -45.0),
    ("GST", -60.0),
    ("GDT", -75.0),
    ("IST", -82.5),
    ("IDT", -97.5),
    ("JST", -135.0),
    ("NZST", -180.0),
    ("NZDT", -195.0),
    ("UTC", 0.0),
];

/// Returns the text that `gensky` would print. Returns `None` after reporting an error.
pub(super) fn text(report: &SharedReport, name: &Word, args: &[Word]) -> Option<String> {
    let by_angles = args.first().is_some_and(|word| word.text == "-ang");
    let fixed = 3;
    if args.len() < fixed {
        report.error(name.at, "`gensky` needs month, day and hour, or `-ang` with altitude and azimuth");
        return None;
    }
    let mut sky = SkyArgs {
        kind: Kind::Clear,
        sunny: true,
        latitude: 37.815_214,
        longitude: 122.040_01,
        meridian: 120.0,
        year: None,
        turbidity: 2.45,
        ground: 0.2,
        zenith: None,
        horizontal: None,
        sun: None,
        sun_horizontal: None,
    };
    sky.options(report, &args[fixed..])?;
    let [altitude, azimuth] = match by_angles {
        true => [args[1].number(report)?, args[2].number(report)?],
        false => sky.sun_by_clock(report, &args[..fixed])?,
    };
    if altitude < 0.0 && sky.zenith_radiance(altitude) <= 0.0 {
        let message = format!("the sun is {:.1} degrees below the horizon", -altitude);
        let warning = Diagnostic::warning(message).code("sun-below").at(args[fixed - 1].at);
        let help = "use a time between sunrise and sunset; for night, add lights";
        report.push(warning.effect("the sun and its sky emit no light").help(help));
    }
    Some(sky.print(altitude, azimuth))
}

impl SkyArgs {
    fn options(&mut self, report: &SharedReport, mut rest: &[Word]) -> Option<()> {
        while let Some((option, more)) = rest.split_first() {
            rest = more;
            match option.text.as_str() {
                "-s" | "+s" => (self.kind, self.sunny) = (Kind::Clear, option.text == "+s"),
                "-i" | "+i" => (self.kind, self.sunny) = (Kind::Intermediate, option.text == "+i"),
                "-c" => (self.kind, self.sunny) = (Kind::Overcast, false),
                "-u" => (self.kind, self.sunny) = (Kind::Uniform, false),
                "-y" | "-g" | "-t" | "-b" | "-B" | "-r" | "-R" | "-a" | "-o" | "-m" => {
                    let Some((value, more)) = more.split_first() else {
                        report.error(option.at, format!("{} needs a number", option.quoted()));
                        return None;
                    };
                    let number = value.number(report)?;
                    rest = more;
                    match option.text.as_str() {
                        "-y" => self.year = Some(number.clamp(1.0, 9999.0) as i32),
                        "-g" => self.ground = number,
                        "-t" => self.turbidity = number,
                        "-b" => (self.zenith, self.horizontal) = (Some(number), None),
                        "-B" => (self.zenith, self.horizontal) = (None, Some(number)),
                        "-r" => (self.sun, self.sun_horizontal) = (Some(number), None),
                        "-R" => (self.sun, self.sun_horizontal) = (None, Some(number)),
                        "-a" => self.latitude = number,
                        "-o" => self.longitude = number,
                        _ => self.meridian = number,
                    }
                }
                _ => {
                    report.error(option.at, format!("`gensky` has no option {}", option.quoted()));
                    return None;
                }
            }
        }
        Some(())
    }

    /// Returns the altitude and azimuth of the sun in degrees for a month, day and hour. The
    /// azimuth is measured from south and increases towards west.
    fn sun_by_clock(&mut self, report: &SharedReport, args: &[Word]) -> Option<[f64; 2]> {
        let whole = |word: &Word, most: f64, what: &str| {
            let number = word.number(report)?;
            if !(1.0..=most).contains(&number) {
                report.error(word.at, format!("the {what} must be from 1 to {most}"));
                return None;
            }
            Some(number as i32)
        };
        let month = whole(&args[0], 12.0, "month")?;
        let day = whole(&args[1], 31.0, "day")?;
        let (hours, is_solar) = self.hour(report, &args[2])?;
        // If no year is given, the formulas are for an average year.
        const BEFORE: [i32; 12] = [0, 31, 59, 90, 120, 151, 181, 212, 243, 273, 304, 334];
        let date = f64::from(BEFORE[month as usize - 1] + day);
        if let (Some(year), false) = (self.year, is_solar) {
            let moment = Moment { date: [year, month, day], hours, zone: -self.meridian / 15.0 };
            let [altitude, azimuth] = almanac::sun([self.latitude, -self.longitude], &moment);
            return Some([altitude, azimuth - 180.0]);
        }
        let sin = |turn: f64| fp::sin_cos_degrees(360.0 * turn).0;
        let late = 0.170 * sin(2.0 * (date - 80.0) / 373.0) - 0.129 * sin((date - 8.0) / 355.0);
        let solar = if is_solar { hours } else { hours + late + (self.meridian - self.longitude) / 15.0 };
        let (dec_sin, dec_cos) = fp::sin_cos_degrees(23.45 * sin((284.0 + date) / 365.0));
        let ((lat_sin, lat_cos), (turn_sin, turn_cos)) =
            (fp::sin_cos_degrees(self.latitude), fp::sin_cos_degrees(15.0 * solar));
        let up = lat_sin * dec_sin - lat_cos * dec_cos * turn_cos;
        let (west, south) = (-dec_cos * turn_sin, -lat_cos * dec_sin - lat_sin * dec_cos * turn_cos);
        Some([fp::asin_f64(up.clamp(-1.0, 1.0)).to_degrees(), fp::atan2_f64(west, south).to_degrees()])
    }

    /// Parses an hour, such as 14.5, 14:30 or 14:30EST. The flag is true for solar time, which is
    /// written with a plus sign (+14.5).
    fn hour(&mut self, report: &SharedReport, word: &Word) -> Option<(f64, bool)> {
        let wrong = || {
            let what = "the hour must be of the form 14.5, 14:30, 14:30EST or, in solar time, +14.5";
            report.error(word.at, what);
        };
        let (solar, text) = match word.text.strip_prefix('+') {
            Some(text) => (true, text),
            None => (false, word.text.as_str()),
        };
        let letters = text.find(|c: char| c.is_ascii_alphabetic()).unwrap_or(text.len());
        let (text, zone) = text.split_at(letters);
        if !zone.is_empty() {
            let Some((_, meridian)) = ZONES.iter().find(|(name, _)| *name == zone) else {
                let known = ZONES.map(|(name, _)| name).join(" ");
                report.error(word.at, format!("unknown time zone in {}: known zones are {known}", word.quoted()));
                return None;
            };
            self.meridian = *meridian;
        }
        let (hours, minutes) = text.split_once(':').unwrap_or((text, "0"));
        let (Ok(hours), Ok(minutes)) = (hours.parse::<f64>(), minutes.parse::<f64>()) else {
            wrong();
            return None;
        };
        if !(0.0..=24.0).contains(&hours) || !(0.0..60.0).contains(&minutes) {
            wrong();
            return None;
        }
        Some((hours + minutes / 60.0, solar))
    }

    /// Returns true if clouds hide the sun.
    fn is_covered(&self) -> bool {
        matches!(self.kind, Kind::Overcast | Kind::Uniform)
    }

    /// Limits the altitude of the sun to the range in which the formula for the zenith is valid.
    fn limited(&self, altitude: f64) -> f64 {
        if self.is_covered() { altitude } else { altitude.min(87.0) }
    }

    /// Returns the radiance of the sky at the zenith for an altitude of the sun in degrees.
    fn zenith_radiance(&self, altitude: f64) -> f64 {
        let altitude = self.limited(altitude);
        let (sin, a) = (fp::sin_cos_degrees(altitude).0, altitude.to_radians());
        let norm = self.normalization(a, sin).1;
        self.zenith.or(self.horizontal.map(|whole| whole / (PI * norm))).unwrap_or_else(|| {
            let overcast = 8.6 * sin + 0.123;
            let clear = || (1.376 * self.turbidity - 1.81) * fp::tan_f64(a) + 0.38;
            let kilo = match self.kind {
                Kind::Overcast | Kind::Uniform => overcast,
                Kind::Clear => clear(),
                Kind::Intermediate => 0.5 * (clear() + overcast),
            };
            1000.0 * kilo.max(0.0) / SKY_EFFICACY
        })
    }

    fn print(&self, altitude: f64, azimuth: f64) -> String {
        let covered = self.is_covered();
        let altitude = self.limited(altitude);
        let ((s, c), (sin, cos)) = (fp::sin_cos_degrees(azimuth), fp::sin_cos_degrees(altitude));
        let sun = [-s * cos, -c * cos, sin];
        let a = altitude.to_radians();
        let (given, norm) = self.normalization(a, sin);
        let zenith = self.zenith_radiance(altitude);
        let mut solar = match (self.sun, self.sun_horizontal) {
            (Some(radiance), _) => radiance,
            (None, Some(flux)) => flux / (SUN_SOLID_ANGLE * sin.max(1e-6)),
            (None, None) => {
                let whole = 1.5e9 / SUN_EFFICACY * (1.147 - 0.147 / sin.max(0.16));
                // An intermediate sky is half covered with clouds.
                if self.kind == Kind::Intermediate { 0.15 * whole } else { whole }
            }
        };
        if sin <= 0.0 {
            solar = 0.0;
        }
        let direct = if covered { 0.0 } else { 6e-5 / PI * solar * sin };
        let ground = self.ground * (zenith * norm + direct);
        let mut text = String::new();
        if self.sunny && solar > 0.0 {
            let [x, y, z] = sun;
            text +=
                &format!("void light solar 0 0 3 {solar} {solar} {solar}\nsolar source sun 0 0 4 {x} {y} {z} 0.5\n");
        }
        text += "void brightfunc skyfunc 2 skybr skybright.cal 0 ";
        let [x, y, z] = sun;
        text += &match self.kind {
            Kind::Clear => format!("7 1 {zenith} {ground} {given} {x} {y} {z}\n"),
            Kind::Overcast => format!("3 2 {zenith} {ground}\n"),
            Kind::Uniform => format!("3 3 {zenith} {ground}\n"),
            Kind::Intermediate => format!("7 4 {zenith} {ground} {given} {x} {y} {z}\n"),
        };
        text
    }

    /// Returns the value of the sky formula at the zenith. Also returns the radiance of a uniform
    /// sky that has the same horizontal irradiance as this sky, for a zenith radiance of 1. `a` is
    /// the altitude of the sun in radians, and `sin` is the sine of that angle.
    fn normalization(&self, a: f64, sin: f64) -> (f64, f64) {
        let from_zenith = (FRAC_PI_2 - a) as f32;
        let (given, row) = match self.kind {
            Kind::Overcast => return (1.0, 7.0 / 9.0),
            Kind::Uniform => return (1.0, 1.0),
            Kind::Clear => (
                0.274 * (0.91 + 10.0 * f64::from(fp::exp(-3.0 * from_zenith)) + 0.45 * sin * sin),
                [2.766_521, 0.547_665, -0.369_832, 0.009_237, 0.059_229],
            ),
            Kind::Intermediate => (
                (2.739 + 0.9891 * f64::from(fp::sin((0.3119 + 2.6 * a) as f32)))
                    * f64::from(fp::exp(-from_zenith * (0.4441 + 1.48 * a) as f32)),
                [3.5556, -2.7152, -1.3081, 1.0660, 0.60227],
            ),
        };
        let x = (a - FRAC_PI_4) / FRAC_PI_4;
        (given, row.iter().rev().fold(0.0, |sum, factor| sum * x + factor) / (given * PI))
    }
}
