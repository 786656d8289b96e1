//! Tests of the readers of weather files.

use super::read;
use durer_diag::{Diagnostics, Files};
use durer_scene::weather::Weather;
use std::fmt::Write as _;

const HEADER: &str = "LOCATION,Testville,-,NOWHERE,Formula,0,47.5,-8.25,-1.0,400.0\n\
    DESIGN CONDITIONS,0\nTYPICAL/EXTREME PERIODS,0\nGROUND TEMPERATURES,0\n\
    HOLIDAYS/DAYLIGHT SAVINGS,No,0,0,0\nCOMMENTS 1,made for a test\nCOMMENTS 2,\n\
    DATA PERIODS,1,1,Data,Sunday, 1/ 1,12/31\n";

/// Row with a date, an hour, a dew point and two irradiances.
fn row([year, month, day, hour]: [i32; 4], dew: &str, direct: &str, diffuse: &str) -> String {
    format!("{year},{month},{day},{hour},60,?9?9,10,{dew},60,95000,0,0,300,0,{direct},{diffuse},0,0\n")
}

fn parse(text: &str) -> Result<Weather, String> {
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let file = files.add("city.epw", text.as_bytes().into());
    let weather = read(text.as_bytes(), file, &mut diagnostics);
    weather.ok_or_else(|| {
        let error = diagnostics.iter().next().unwrap();
        let (line, column) = files.position(error.span.unwrap()).unwrap();
        format!("{line}:{column}: {}", error.message)
    })
}

#[test]
fn rows_and_place_of_an_epw_file() {
    let text = HEADER.to_string()
        + &row([1999, 1, 1, 1], "5.5", "0", "9999")
        + &row([1999, 1, 1, 12], "99.9", "640", "120.5")
        + &row([2003, 2, 1, 24], "-3", "0", "0");
    for text in [text.clone(), text.replace('\n', "\r\n"), format!("\u{feff}{text}"), text.replace('\n', "\n\n")] {
        let Weather { place, rows } = parse(&text).unwrap();
        assert_eq!((&*place.name, place.latitude, place.longitude, place.time_zone), ("Testville", 47.5, -8.25, -1.0));
        assert_eq!(rows.len(), 3);
        assert_eq!((rows[0].date, rows[0].hours, rows[0].duration), ([1999, 1, 1], 0.5, 1.0));
        assert_eq!((rows[0].direct_normal, rows[0].diffuse_horizontal), (Some(0.0), None));
        assert_eq!((rows[0].dew_point, rows[1].dew_point, rows[2].dew_point), (Some(5.5), None, Some(-3.0)));
        assert_eq!((rows[1].direct_normal, rows[1].diffuse_horizontal), (Some(640.0), Some(120.5)));
        // The file starts on a Sunday, and 31 days later it is a Wednesday.
        assert_eq!((rows[0].weekday, rows[2].weekday, rows[2].hours), (Some(6), Some(2), 23.5));
    }
}

/// File with a row for each part of each hour of a year.
fn year(is_leap: bool, per_hour: u32) -> String {
    let days = [31, if is_leap { 29 } else { 28 }, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];
    let mut text = HEADER.replace("DATA PERIODS,1,1", &format!("DATA PERIODS,1,{per_hour}"));
    for (month, days) in (1..).zip(days) {
        for (day, hour) in (1..=days).flat_map(|day| (1..=24).map(move |hour| (day, hour))) {
            for _ in 0..per_hour {
                write!(text, "{}", row([2000, month, day, hour], "0", "1", "2")).unwrap();
            }
        }
    }
    text
}

#[test]
fn years_can_have_leap_days_and_several_rows_per_hour() {
    for (is_leap, per_hour, count) in [(false, 1, 8760), (true, 1, 8784), (false, 4, 35_040)] {
        let rows = parse(&year(is_leap, per_hour)).unwrap().rows;
        assert_eq!(rows.len(), count);
        let all: f64 = rows.iter().map(|row| row.duration).sum();
        assert!((all - if is_leap { 8784.0 } else { 8760.0 }).abs() < 1e-6);
        // The last day of a year that starts on a Sunday is a Sunday, or with a leap day a Monday.
        assert_eq!(rows[count - 1].weekday, Some(if is_leap { 0 } else { 6 }));
    }
    let rows = parse(&year(false, 4)).unwrap().rows;
    assert_eq!([0, 1, 3, 4].map(|i| rows[i].hours), [0.125, 0.375, 0.875, 1.125]);
}

#[test]
fn malformed_epw_files_are_reported_with_line_and_column() {
    let good = || HEADER.to_string() + &row([1999, 1, 1, 1], "5", "0", "0");
    let with = |from: &str, to: &str| good().replace(from, to);
    for (text, error) in [
        (String::new(), "1:1: a weather file must begin with"),
        ("{}".into(), "1:1: a weather file must begin with"),
        (HEADER.into(), "9:1: the file has no rows"),
        (HEADER.lines().take(3).collect::<Vec<_>>().join("\n"), "3:26: the file ends within its header"),
        (with("47.5,", "97.5,"), "1:40: `97.5` is not a valid latitude: it must be from -90 to 90"),
        (with("47.5,", "north,"), "1:40: `north` is not a valid latitude"),
        (with(",-8.25,-1.0,400.0", ""), "1:1: `LOCATION` must have at least nine fields"),
        (with("DATA PERIODS,1,1", "DATA PERIODS,2,1"), "8:14: only files with one data period"),
        (with("DATA PERIODS,1,1", "DATA PERIODS,1,7"), "8:16: the number of rows per hour must divide 60"),
        (with("DATA PERIODS,1,1", "DATA PERIODS,1,0"), "8:16: `0` is not a valid number of rows per hour"),
        (with("DATA PERIODS,1,1", "DATA PERIODS,1,2"), "10:1: the last hour has fewer than 2 rows"),
        (with("DATA PERIODS", "PERIODS"), "10:1: the header has no line `DATA PERIODS`"),
        (with("1999,1,1,1,", "1999,13,1,1,"), "9:6: `13` is not a valid month"),
        (with("1999,1,1,1,", "1999,4,31,1,"), "9:8: month 4 has no day 31"),
        (with("1999,1,1,1,", "1999,1,1,25,"), "9:10: `25` is not a valid hour"),
        (with("1999,1,1,1,", "1999,1,1,0,"), "9:10: `0` is not a valid hour"),
        (with("1999,1,1,1,", "1999,1,1.5,1,"), "9:8: a day must be an integer"),
        (with("300,0,0,0", "300,0,nan,0"), "9:44: `nan` is not a valid direct normal irradiance"),
        (with("300,0,0,0", "300,0,0,x"), "9:46: `x` is not a valid diffuse horizontal irradiance"),
        (with("300,0,0,0", "300,0,5000,0"), "9:44: a direct normal irradiance of 5000 W/m^2 is more than"),
        (with(",95000,0,0,300,0,0,0,0,0", ""), "9:1: a row must have at least 16 fields, but this one has 9"),
        (good() + &row([1999, 1, 1, 1], "5", "0", "0"), "10:10: `DATA PERIODS` states 1 rows per hour"),
        (good() + &row([1998, 1, 1, 1], "5", "0", "0"), "10:10: `DATA PERIODS` states"),
    ] {
        let found = parse(&text).unwrap_err();
        assert!(found.starts_with(error), "{error:?}, found {found:?}");
    }
    let disordered = HEADER.to_string() + &row([1999, 2, 1, 1], "5", "0", "0") + &row([1999, 1, 1, 1], "5", "0", "0");
    assert_eq!(parse(&disordered).unwrap_err(), "10:6: the rows must be in the order of time, and within one year");
}

#[test]
fn cut_and_damaged_files_never_panic() {
    let text = HEADER.to_string() + &row([1999, 1, 1, 1], "5.5", "0", "9999");
    for end in 0..text.len() {
        let _ = parse(&text[..end]);
        for byte in [b',', b'\n', b'9', 0, 0xff] {
            let mut bytes = text.clone().into_bytes();
            bytes[end] = byte;
            let _ = read(&bytes, 0, &mut Diagnostics::default());
        }
    }
}

const WEA: &str = "place Testville_X\nlatitude 47.5\nlongitude 8.25\ntime_zone 15\nsite_elevation 400\n\
    weather_data_file_units 1\n";

#[test]
fn rows_and_place_of_a_wea_file() {
    let Weather { place, rows } =
        parse(&format!("{WEA}1 1 0.250 0 0\n1 1 0.750\t640  120.5\r\n2 29 1 -1 9999\n")).unwrap();
    assert_eq!((&*place.name, place.latitude, place.longitude, place.time_zone), ("Testville_X", 47.5, -8.25, -1.0));
    assert_eq!((rows[1].hours, rows[1].duration, rows[2].date), (0.75, 0.5, [2001, 2, 29]));
    assert_eq!((rows[1].direct_normal, rows[1].diffuse_horizontal), (Some(640.0), Some(120.5)));
    assert_eq!((rows[2].direct_normal, rows[2].diffuse_horizontal), (None, None));
    for (text, error) in [
        (WEA.to_string(), "7:1: the file has no rows"),
        (WEA.replace("units 1", "units 2"), "6:25: only irradiance is supported"),
        (WEA.replace("latitude 47.5\n", ""), "2:1: expected the line `latitude` with a number"),
        (WEA.replace("time_zone 15", "time_zone east"), "4:11: `east` is not a valid time zone in degrees"),
        (format!("{WEA}1 1 0.5 0\n"), "7:1: a row must have a month"),
        (format!("{WEA}2 30 0.5 0 0\n"), "7:3: the date 2/30 does not exist"),
        (format!("{WEA}1 1 24.5 0 0\n"), "7:5: `24.5` is not a valid hour"),
        (format!("{WEA}1 1 1.5 0 0\n1 1 0.5 0 0\n"), "8:1: the rows must be in the order of time"),
    ] {
        let found = parse(&text).unwrap_err();
        assert!(found.starts_with(error), "{error:?}, found {found:?}");
    }
}
