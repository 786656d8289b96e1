//! Tests daylight from weather files on the command line.

use crate::common::TestFolder;
use std::fmt::Write as _;

/// Open field with a small object far below it.
const FIELD: &str = "PerspectiveCamera { center 0 2 6 direction 0 -0.3 -1 up 0 1 0 angle 40 }
Lights { PointLight { position 0 2 0 color 9 9 9 } }
Materials { PrincipledMaterial { baseColor 0.5 0.5 0.5 specularWeight 0 emissionLuminance 500 } }
Group { MaterialIndex 0 Sphere { center 0 -500 0 radius 0.001 } }
";

/// Weather of a summer day in Zurich with 400 W/m^2 from the sun and 100 W/m^2 from the sky, from 6
/// to 18 o'clock.
fn day() -> String {
    let mut text = "LOCATION,Zurich,-,CHE,Formula,0,47.5,8.5,1.0,400\nDESIGN CONDITIONS,0\nTYPICAL/EXTREME PERIODS,0\n\
        GROUND TEMPERATURES,0\nHOLIDAYS/DAYLIGHT SAVINGS,No,0,0,0\nCOMMENTS 1,\nCOMMENTS 2,\n\
        DATA PERIODS,1,1,Data,Sunday, 6/21, 6/21\n"
        .to_string();
    for hour in 1..=24 {
        let (direct, diffuse) = if (7..=18).contains(&hour) { (400, 100) } else { (0, 0) };
        writeln!(text, "2001,6,21,{hour},60,?,15,11,50,96000,0,0,300,0,{direct},{diffuse},0,0").unwrap();
    }
    text
}

fn field() -> TestFolder {
    let folder = TestFolder::new();
    folder.write("field.txt", FIELD);
    folder.write("day.epw", day());
    folder
}

const MEASURE: &str = "measure field.txt --weather day.epw --samples 256";

#[test]
fn figures_of_a_year_are_printed_as_csv_and_json() {
    let folder = field();
    let output = folder.expect_exit(0, &format!("{MEASURE} --at 0,0,0 --at 0,0,0 --normal 0,1,0"));
    let rows: Vec<&str> = output.out.lines().collect();
    assert!(rows[0].starts_with("x,y,z,nx,ny,nz,autonomy,autonomy_error,continuous,useful_below_100,useful_100_300,"));
    assert!(rows[1].starts_with("0,0,0,0,1,0,1.00000,0.00000,1.00000,0.00000,0.00000,0.00000,1.00000,"), "{}", rows[1]);
    assert!(rows[1].ends_with(",10"), "{}", rows[1]);
    assert!(output.err.contains("note: 10 occupied hours"), "{}", output.err);
    let output = folder.expect_exit(0, &format!("{MEASURE} --grid -1,0,-1:2,0,0:0,0,2:2x2 --occupied 0-24 --json"));
    let json: serde_json::Value = serde_json::from_str(&output.out).unwrap();
    assert_eq!((&json["occupied_hours"], &json["grids"][0]["autonomy"]), (&24.0.into(), &0.5.into()));
    assert_eq!(json["grids"][0]["spatial_autonomy"], 1.0);
    assert_eq!((&json["points"][3]["sun_hours"], &json["place"]["name"]), (&12.0.into(), &"Zurich".into()));
}

#[test]
fn sunlight_without_diffuse_light_is_that_of_a_clear_sky() {
    let folder = field();
    let mean = |diffuse: &str| {
        folder.write("day.epw", day().replace(",400,100,", &format!(",900,{diffuse},")));
        let json = folder.expect_exit(0, &format!("{MEASURE} --at 0,0,0 --json")).out;
        let json: serde_json::Value = serde_json::from_str(&json).unwrap();
        json["points"][0]["mean"].as_f64().unwrap()
    };
    let (none, little) = (mean("0"), mean("1"));
    assert!(none > 30_000.0 && (none / little - 1.0).abs() < 0.01, "{none} {little}");
}

#[test]
fn hours_and_plans_are_written() {
    let folder = field();
    let grid = format!("{MEASURE} --grid -1,0,-1:2,0,0:0,0,2:3x2");
    let output = folder.expect_exit(0, &format!("{grid} --hours hours.csv --plan plan.svg --plan-shows mean"));
    assert!(output.err.contains("wrote plan.svg") && output.err.contains("wrote hours.csv"), "{}", output.err);
    let table = std::fs::read_to_string(folder.path("hours.csv")).unwrap();
    let rows: Vec<&str> = table.lines().collect();
    assert!(rows.len() == 25 && rows[0].starts_with("year,month,day,hour,lux_0,error_0,"), "{}", rows[0]);
    assert!(rows[1].starts_with("2001,6,21,0.5,0.00,0.00,"), "{}", rows[1]);
    let plan = std::fs::read_to_string(folder.path("plan.svg")).unwrap();
    assert!(plan.contains("mean illuminance, 10 occupied hours") && plan.contains(">lux<"));
    folder.expect_exit(0, &format!("{grid} --plan autonomy.svg"));
    assert!(std::fs::read_to_string(folder.path("autonomy.svg")).unwrap().contains("daylight autonomy, 300 lux"));
}

#[test]
fn hour_of_the_weather_agrees_with_the_year() {
    let folder = field();
    let measure = MEASURE.replace("256", "4096");
    folder.expect_exit(0, &format!("{measure} --at 0,0,0 --hours hours.csv"));
    let table = std::fs::read_to_string(folder.path("hours.csv")).unwrap();
    let of_year: f64 = table.lines().nth(13).unwrap().split(',').nth(4).unwrap().parse().unwrap();
    let hour = |when: &str| folder.expect_exit(0, &format!("{measure} --at 0,0,0 --sky-hour {when}"));
    let output = hour("6-21T12:30");
    let measured: f64 = output.out.lines().nth(1).unwrap().split(',').nth(6).unwrap().parse().unwrap();
    assert!((measured / of_year - 1.0).abs() < 0.01, "{measured} {of_year}");
    assert!(
        output.err.contains("note: the sun is at altitude 65.") && output.err.contains("400 W/m^2"),
        "{}",
        output.err
    );
    // A scene can contain this sky.
    let angles = output.err.split("altitude ").nth(1).unwrap().split(", ").collect::<Vec<_>>();
    let (altitude, azimuth) = (angles[0], angles[1].trim_start_matches("azimuth "));
    let sky = format!("skyModel perez directNormal 400 diffuseHorizontal 100 sunAltitude {altitude}");
    let background = format!("Background {{ {sky} sunAzimuth {azimuth} }}");
    let scene = FIELD.replace("Lights { PointLight { position 0 2 0 color 9 9 9 } }", &background);
    folder.write("sky.txt", scene);
    let output = folder.expect_exit(0, "measure sky.txt --at 0,0,0 --samples 4096");
    let own: f64 = output.out.lines().nth(1).unwrap().split(',').nth(6).unwrap().parse().unwrap();
    // The scene does not know the distance to the sun in June, which changes the brightness by 3 %.
    assert!((own / measured - 1.0).abs() < 0.02, "{own} {measured}");
}

#[test]
fn wrong_weather_and_options_are_reported() {
    let folder = field();
    folder.write("bad.epw", day().replace("2001,6,21,12,", "2001,6,31,12,"));
    let output = folder.expect_exit(2, "measure field.txt --at 0,0,0 --weather bad.epw");
    assert!(output.err.contains("bad.epw:20:8") && output.err.contains("month 6 has no day 31"), "{}", output.err);
    folder.write("dark.epw", day().replace(",400,100,", ",0,0,"));
    folder.write("gap.epw", day().replace(",400,100,", ",9999,9999,"));
    folder.write("year.wea", "place X\nlatitude 47\nlongitude -8\ntime_zone -15\nsite_elevation 4\nweather_data_file_units 1\n6 21 12.5 400 100\n");
    for (options, message) in [
        ("--weather none.epw", "none.epw"),
        ("--weather field.txt", "a weather file must begin with"),
        ("--weather dark.epw", "the sky is dark in every row"),
        ("--weather day.epw --sky-hour 6-22T12", "no row for 6-22 12:00"),
        ("--weather day.epw --sky-hour 6-21T1", "the sky is dark at 6-21 01:00"),
        ("--weather gap.epw --sky-hour 6-21T12", "no irradiance for 6-21 12:00"),
        ("--weather year.wea --weekdays", "needs the day of the week"),
        ("--weather day.epw --north 400", "--north must be from -360 to 360"),
        ("--weather day.epw --integrator photons", "needs --integrator path"),
        ("--weather day.epw --occupied 8", "two different hours"),
        ("--weather day.epw --patches 100", "100"),
        ("--occupied 8-18", "--weather"),
        ("--weather day.epw --error 1%", "--error"),
        ("--weather day.epw --hours table.txt", "must end in .csv"),
    ] {
        let output = folder.expect_exit(2, &format!("measure field.txt --at 0,0,0 {options}"));
        assert!(output.err.contains(message), "{options}: {}", output.err);
    }
    // Hours without values are left out, and said so.
    folder.write("part.epw", day().replacen(",400,100,", ",9999,100,", 8));
    let output = folder.expect_exit(0, "measure field.txt --at 0,0,0 --weather part.epw --samples 32");
    assert!(output.err.contains("6 occupied hours without irradiance"), "{}", output.err);
    let output = folder.expect_exit(0, &format!("{MEASURE} --at 0,0,0 --weekdays"));
    assert!(output.err.contains("no row of the weather file is within the hours of use"), "{}", output.err);
}
