//! Reader of EnergyPlus weather files.

use super::{Field, Line, Lines, MAX_ROWS, ParseError, is_day};
use durer_scene::texture::almanac::day_of_year;
use durer_scene::weather::{Place, Weather, WeatherRow};

/// Number of lines of the header.
const HEADER_LINES: usize = 8;
/// Number of fields of a row that are needed.
const FIELDS: usize = 16;
/// Dew point from which a value is missing, in degrees Celsius.
const MISSING_DEW_POINT: f64 = 99.9;
/// Days of the week as in the header, starting with that of number 0.
const WEEKDAYS: [&str; 7] = ["monday", "tuesday", "wednesday", "thursday", "friday", "saturday", "sunday"];

/// Time at which a row ends, without the year: the month, the day and the hour, from 1 to 24.
type Clock = [i32; 3];

/// Contents of the line `DATA PERIODS`.
struct Period {
    rows_per_hour: usize,
    /// First day of the week, from 0 for Monday.
    weekday: Option<u8>,
}

/// Reads a file whose next line is `LOCATION`.
pub(super) fn parse(lines: &mut Lines) -> Result<Weather, ParseError> {
    let comma = |c| c == ',';
    let Some(first) = lines.next() else { return Err(lines.end_error("the file is empty")) };
    let place = place(&first, &first.fields(comma))?;
    let mut period = None;
    for _ in 1..HEADER_LINES {
        let end = "the file ends within its header, which has eight lines from `LOCATION` to `DATA PERIODS`";
        let line = lines.next().ok_or_else(|| lines.end_error(end))?;
        let fields = line.fields(comma);
        if fields[0].text.eq_ignore_ascii_case("data periods") {
            period = Some(data_period(&line, &fields)?);
            break;
        }
        if fields[0].text.parse::<f64>().is_ok() {
            return Err(line.error("the header has no line `DATA PERIODS`, which gives the number of rows per hour"));
        }
    }
    let Period { rows_per_hour, weekday } = period.ok_or_else(|| {
        lines.end_error("the header has no line `DATA PERIODS`, which gives the number of rows per hour")
    })?;
    let (mut rows, mut first_day, mut within) = (Vec::<WeatherRow>::new(), None, (None::<Clock>, 0));
    let mut has_leap_day = false;
    for line in lines.by_ref() {
        let fields = line.fields(comma);
        if fields.len() < FIELDS {
            let message = format!("a row must have at least {FIELDS} fields, but this one has {}", fields.len());
            return Err(line.error(message));
        }
        if rows.len() == MAX_ROWS {
            return Err(line.error(format!("a weather file can have at most {MAX_ROWS} rows")));
        }
        let (year, clock) = time(&fields)?;
        let number = if within.0 == Some(clock) { within.1 + 1 } else { 0 };
        if number == 0 && rows.len() % rows_per_hour != 0 || number >= rows_per_hour {
            let message =
                format!("`DATA PERIODS` states {rows_per_hour} rows per hour, but this hour has another number");
            return Err(fields[3].error(message));
        }
        if number == 0 && within.0.is_some_and(|before| clock <= before) {
            return Err(fields[1].error("the rows must be in the order of time, and within one year"));
        }
        within = (Some(clock), number);
        let [month, day, hour] = clock;
        let date = [year, month, day];
        // Typical years consist of months of several years, so only the rows show a leap day.
        has_leap_day |= (month, day) == (2, 29);
        let today = day_of_year([if has_leap_day { 2000 } else { 2001 }, month, day]);
        let first = *first_day.get_or_insert(today);
        let duration = 1.0 / rows_per_hour as f64;
        rows.push(WeatherRow {
            date,
            hours: f64::from(hour - 1) + (number as f64 + 0.5) * duration,
            duration,
            weekday: weekday.map(|start| ((u32::from(start) + today - first) % 7) as u8),
            direct_normal: fields[14].irradiance("direct normal irradiance")?,
            diffuse_horizontal: fields[15].irradiance("diffuse horizontal irradiance")?,
            dew_point: dew_point(&fields[7])?,
        });
    }
    if rows.is_empty() {
        return Err(lines.end_error("the file has no rows after its header"));
    }
    if rows.len() % rows_per_hour != 0 {
        return Err(lines.end_error(format!("the last hour has fewer than {rows_per_hour} rows")));
    }
    Ok(Weather { place, rows })
}

/// Reads the line `LOCATION`: the city, the state, the country, the source, the number of the
/// station, the latitude, the longitude, the time zone and the elevation.
fn place(line: &Line, fields: &[Field]) -> Result<Place, ParseError> {
    let [_, city, _, _, _, _, latitude, longitude, zone, ..] = fields else {
        return Err(line.error("`LOCATION` must have at least nine fields, with the latitude as the seventh"));
    };
    Ok(Place {
        name: city.text.into(),
        latitude: latitude.number("latitude", -90.0..=90.0)?,
        longitude: longitude.number("longitude", -180.0..=180.0)?,
        time_zone: zone.number("time zone", -14.0..=14.0)?,
    })
}

/// Reads the line `DATA PERIODS`: the number of periods, the number of rows per hour, and for each
/// period its name, the day of the week on which it starts, and its first and last date.
fn data_period(line: &Line, fields: &[Field]) -> Result<Period, ParseError> {
    let [_, periods, per_hour, ..] = fields else {
        return Err(line.error("`DATA PERIODS` must have at least three fields"));
    };
    if periods.text != "1" {
        return Err(periods.error("only files with one data period are supported"));
    }
    let rows = per_hour.number("number of rows per hour", 1.0..=60.0)?;
    if rows.fract() != 0.0 || 60 % rows as u32 != 0 {
        return Err(per_hour.error("the number of rows per hour must divide 60"));
    }
    let weekday = fields.get(4).and_then(|field| {
        WEEKDAYS.iter().position(|name| field.text.eq_ignore_ascii_case(name)).map(|number| number as u8)
    });
    Ok(Period { rows_per_hour: rows as usize, weekday })
}

/// Reads the year and the time of a row. The minute is ignored, because many files with a row per
/// hour contain 0 and others 60.
fn time(fields: &[Field]) -> Result<(i32, Clock), ParseError> {
    let whole = |field: &Field, name: &str, range: std::ops::RangeInclusive<f64>| {
        let number = field.number(name, range)?;
        if number.fract() == 0.0 { Ok(number as i32) } else { Err(field.error(format!("a {name} must be an integer"))) }
    };
    let year = whole(&fields[0], "year", 0.0..=9999.0)?;
    let month = whole(&fields[1], "month", 1.0..=12.0)?;
    let day = whole(&fields[2], "day", 1.0..=31.0)?;
    if !is_day(month, day) {
        return Err(fields[2].error(format!("month {month} has no day {day}")));
    }
    let hour = whole(&fields[3], "hour", 1.0..=24.0)?;
    Ok((year, [month, day, hour]))
}

fn dew_point(field: &Field) -> Result<Option<f32>, ParseError> {
    let value = field.number("dew point", -100.0..=1000.0)?;
    Ok((-90.0..MISSING_DEW_POINT.min(60.0)).contains(&value).then_some(value as f32))
}
