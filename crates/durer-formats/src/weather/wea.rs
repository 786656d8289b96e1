//! Reader of Radiance's `.wea` files, which contain a header and rows with the month, the day, the
//! hour, and the direct normal and diffuse horizontal irradiance.

use super::{Field, Line, Lines, MAX_ROWS, ParseError, is_day};
use durer_scene::weather::{Place, Weather, WeatherRow};

/// Year for the position of the sun, because the rows have no year. It is not a leap year.
const YEAR: i32 = 2001;

/// Reads a file whose next line is `place`.
pub(super) fn parse(lines: &mut Lines) -> Result<Weather, ParseError> {
    let mut place = Place::default();
    let Some(first) = lines.next() else { return Err(lines.end_error("the file is empty")) };
    place.name = first.text.split_once([' ', '\t']).map_or("", |(_, name)| name.trim()).into();
    let mut header = |name: &str| -> Result<Field, ParseError> {
        let line = lines.next().ok_or_else(|| lines.end_error(format!("the file ends before the line `{name}`")))?;
        match words(&line)[..] {
            [word, value] if word.text.eq_ignore_ascii_case(name) => Ok(value),
            _ => Err(line.error(format!("expected the line `{name}` with a number"))),
        }
    };
    place.latitude = header("latitude")?.number("latitude", -90.0..=90.0)?;
    // Radiance counts longitudes and the meridian of the time zone from Greenwich to the west.
    place.longitude = 0.0 - header("longitude")?.number("longitude", -180.0..=180.0)?;
    place.time_zone = 0.0 - header("time_zone")?.number("time zone in degrees", -210.0..=210.0)? / 15.0;
    header("site_elevation")?.number("elevation in metres", -1000.0..=10_000.0)?;
    let units = header("weather_data_file_units")?;
    if units.text != "1" {
        return Err(units.error("only irradiance is supported: `weather_data_file_units` must be 1"));
    }
    let mut rows = Vec::<WeatherRow>::new();
    for line in lines.by_ref() {
        let fields = words(&line);
        let [month, day, hour, direct, diffuse, ..] = fields[..] else {
            return Err(line.error("a row must have a month, a day, an hour, and two irradiances"));
        };
        if rows.len() == MAX_ROWS {
            return Err(line.error(format!("a weather file can have at most {MAX_ROWS} rows")));
        }
        let (month_number, day_number) = (month.number("month", 1.0..=12.0)?, day.number("day", 1.0..=31.0)?);
        let date = [YEAR, month_number as i32, day_number as i32];
        if month_number.fract() != 0.0 || day_number.fract() != 0.0 || !is_day(date[1], date[2]) {
            return Err(day.error(format!("the date {month_number}/{day_number} does not exist")));
        }
        let hours = hour.number("hour", 0.0..=24.0)?;
        let key = |date: [i32; 3], hours: f64| (date[1], date[2], hours);
        if rows.last().is_some_and(|row| key(row.date, row.hours) >= key(date, hours)) {
            return Err(month.error("the rows must be in the order of time, and within one year"));
        }
        rows.push(WeatherRow {
            date,
            hours,
            duration: 1.0,
            weekday: None,
            direct_normal: direct.irradiance("direct normal irradiance")?,
            diffuse_horizontal: diffuse.irradiance("diffuse horizontal irradiance")?,
            dew_point: None,
        });
    }
    if rows.is_empty() {
        return Err(lines.end_error("the file has no rows after its header"));
    }
    let duration = shortest_step(&rows);
    rows.iter_mut().for_each(|row| row.duration = duration);
    Ok(Weather { place, rows })
}

/// Returns the shortest time between two rows of a day, at most one hour.
fn shortest_step(rows: &[WeatherRow]) -> f64 {
    let pairs = rows.windows(2).filter(|pair| pair[0].date == pair[1].date);
    pairs.map(|pair| pair[1].hours - pair[0].hours).fold(1.0, f64::min)
}

/// Returns the words of a line, which are separated by spaces.
fn words<'a>(line: &Line<'a>) -> Vec<Field<'a>> {
    line.fields(|c| c.is_ascii_whitespace()).into_iter().filter(|field| !field.text.is_empty()).collect()
}
