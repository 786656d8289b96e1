//! Tests of annual daylight against closed forms.

use super::*;
use crate::compile::testing::read;
use crate::integrator::{PathOptions, RenderSettings};
use crate::render::Job;
use crate::world::World;
use durer_scene::math::Vec3;
use durer_scene::scene::Axis;
use durer_scene::texture::sky::SkyPatches;
use durer_scene::weather::{Daylight, Place, Weather, WeatherRow};

/// Weather of a summer day in Helsinki with the given irradiances from 4 to 22 o'clock.
fn day(direct: f32, diffuse: f32) -> Weather {
    let place = Place { name: String::new(), latitude: 60.17, longitude: 24.94, time_zone: 2.0 };
    let row = |hour: u32| WeatherRow {
        date: [2026, 6, 21],
        hours: f64::from(hour) + 0.5,
        duration: 1.0,
        weekday: Some(6),
        direct_normal: Some(if (4..22).contains(&hour) { direct } else { 0.0 }),
        diffuse_horizontal: Some(if (4..22).contains(&hour) { diffuse } else { 0.0 }),
        dew_point: None,
    };
    Weather { place, rows: (0..24).map(row).collect() }
}

fn scene(materials: &str, group: &str) -> World {
    read(&format!(
        "PerspectiveCamera {{ center 0 0 5 direction 0 0 -1 up 0 1 0 angle 30 }}\nBackground {{ color 0 0 0 }}\n\
         Materials {{ {materials} }}\nGroup {{ {group} }}"
    ))
}

const MATTE: &str = "PrincipledMaterial { baseColor 0.5 0.5 0.5 specularWeight 0 }";
/// Small object far below the ground of the sensor.
const NOTHING: &str = "MaterialIndex 0 Sphere { center 0 -500 0 radius 0.001 }";

fn settings() -> RenderSettings {
    RenderSettings { bounces: 8, ..Job::default().settings }
}

fn upward(point: Vec3) -> Sensor {
    Sensor { point, normal: Vec3::Y }
}

fn run(world: World, weather: &Weather, patches: usize, sensors: &[Sensor], options: &AnnualOptions) -> Annual {
    let year = SkyYear::new(weather, SkyAxes::new(Axis::Y, 0.0), SkyPatches::new(patches).unwrap(), 0.2);
    let world = year.light(world);
    annual(&Path::new(&world, settings(), PathOptions::default()), &year, sensors, options, &|_| {})
}

fn all_hours() -> AnnualOptions {
    AnnualOptions { samples: 1 << 13, keeps_hours: true, ..AnnualOptions::default() }
}

#[test]
fn unobstructed_sensor_sees_the_sun_and_the_sky() {
    for (direct, diffuse) in [(0.0, 150.0), (700.0, 0.0), (700.0, 120.0)] {
        let weather = day(direct, diffuse);
        for patches in [145, 577] {
            let found = run(scene(MATTE, NOTHING), &weather, patches, &[upward(Vec3::ZERO)], &all_hours());
            let hours = &found.sensors[0].hours;
            assert_eq!(hours.len(), 24);
            for (row, hour) in weather.rows.iter().zip(hours) {
                let (expected, sun) = match row.daylight(&weather.place) {
                    Daylight::Sky(sky) => {
                        (sky.sky_illuminance() + sky.sun_illuminance() * sky.sun().y, sky.sun_illuminance())
                    }
                    _ => (0.0, 0.0),
                };
                // Each patch has one luminance, which matters most where the sun is low. Four rays
                // to the sun find its altitude to 0.06 degrees.
                let share = if patches == 145 { 0.01 } else { 0.004 };
                let tolerance = share * expected + 0.001 * sun + 3.0 * hour.error;
                assert!((hour.illuminance - expected).abs() <= tolerance, "{}: {hour:?}, {expected}", row.hours);
            }
        }
    }
}

#[test]
fn coefficients_of_a_white_sky_add_up_to_pi() {
    let year = SkyYear::new(&day(0.0, 100.0), SkyAxes::new(Axis::Y, 0.0), SkyPatches::new(145).unwrap(), 0.2);
    let world = year.light(scene(MATTE, NOTHING));
    let path = Path::new(&world, settings(), PathOptions::default());
    for normal in [Vec3::Y, Vec3::NEG_Z, Vec3::NEG_Y] {
        let sensor = Sensor { point: Vec3::ZERO, normal };
        let found = Coefficients::trace(&path, &year, &sensor, (0, 0), 0..1 << 14);
        let (all, ground) = (found.sum(), found.ground());
        assert!((all / std::f64::consts::PI - 1.0).abs() < 0.01, "{normal}: {all}");
        // The ground covers half of the view of a wall.
        let share = 0.5 - 0.5 * f64::from(normal.y);
        assert!((ground / std::f64::consts::PI - share).abs() < 0.01, "{normal}: {ground}");
    }
}

#[test]
fn reflected_sunlight_agrees_with_the_closed_form() {
    // A wall of reflectance 0.5 in the north, infinite upwards, lights a sensor that faces it.
    let wall = "MaterialIndex 0 Plane { normal 0 0 1 offset -1 }";
    let weather = day(800.0, 0.0);
    let sensor = Sensor { point: Vec3::ZERO, normal: Vec3::NEG_Z };
    let options = AnnualOptions { samples: 1 << 14, ..all_hours() };
    let found = run(scene(MATTE, wall), &weather, 577, &[sensor], &options);
    for (row, hour) in weather.rows.iter().zip(&found.sensors[0].hours) {
        let Daylight::Sky(sky) = row.daylight(&weather.place) else { continue };
        let facing = sky.sun().z;
        // The sensor sees only the wall. The wall's illuminance is that of the sun plus half that
        // of the ground.
        if facing < 0.3 {
            continue;
        }
        let ground = 0.2 * sky.sun_illuminance() * sky.sun().y;
        let expected = 0.5 * (sky.sun_illuminance() * facing + 0.5 * ground);
        let tolerance = 0.03 * expected + 3.0 * hour.error;
        assert!((hour.illuminance - expected).abs() <= tolerance, "{}: {hour:?}, {expected}", row.hours);
    }
}

#[test]
fn pane_dims_the_sun_once() {
    // A clear pane above the sensor. Its sunlight must be neither lost nor counted twice.
    let glass =
        "PrincipledMaterial { specularWeight 1 specularRoughness 0 transmissionWeight 1 specularIor 1.5 walls thin }";
    let weather = day(700.0, 0.0);
    let pane = "MaterialIndex 0 Rectangle { corner -500 1 -500 edge0 0 0 1000 edge1 1000 0 0 }";
    let options = AnnualOptions { samples: 1 << 12, ..all_hours() };
    let open = run(scene(glass, NOTHING), &weather, 145, &[upward(Vec3::ZERO)], &options);
    let behind = run(scene(glass, pane), &weather, 145, &[upward(Vec3::ZERO)], &options);
    let noon = |found: &Annual| found.sensors[0].hours[12].illuminance;
    // A pane of index 1.5 transmits 91.7 % at the 37 degrees of the sun, and mirrors the lit
    // ground: a fifth of the sunlight times the mean reflectance of the pane, 0.15.
    let share = noon(&behind) / noon(&open);
    assert!((0.937..0.957).contains(&share), "{share}");
}

#[test]
fn result_does_not_depend_on_threads() {
    let (floor, weather) = ("MaterialIndex 0 Plane { normal 0 1 0 offset 0 }", day(500.0, 100.0));
    let sensors = [upward(Vec3::Y), Sensor { point: Vec3::Y, normal: Vec3::NEG_Y }];
    let options = AnnualOptions { samples: 256, ..all_hours() };
    let with = |threads: usize| {
        crate::threads::install(Some(threads), || run(scene(MATTE, floor), &weather, 145, &sensors, &options))
    };
    let one = with(1);
    assert_eq!(one, with(3));
    assert!(one.sensors[1].figures.mean > 0.0);
}

#[test]
fn directions_of_the_sky_follow_the_up_axis_and_the_turn() {
    let close = |a: Vec3, b: Vec3| (a - b).length() < 1e-6;
    let [y, z] = [Axis::Y, Axis::Z].map(|axis| SkyAxes::new(axis, 0.0));
    assert!(close(y.to_world(Vec3::NEG_Z), Vec3::NEG_Z) && close(y.to_world(Vec3::X), Vec3::X));
    assert!(close(z.to_world(Vec3::NEG_Z), Vec3::Y) && close(z.to_world(Vec3::X), Vec3::X));
    assert!(close(z.to_world(Vec3::Y), Vec3::Z));
    // A quarter turn towards east moves north to the scene's x.
    let turned = SkyAxes::new(Axis::Y, 90.0);
    assert!(close(turned.to_world(Vec3::NEG_Z), Vec3::X) && close(turned.to_world(Vec3::X), Vec3::Z));
    let dir = Vec3::new(0.2, 0.5, -0.7);
    assert!(close(turned.to_sky(turned.to_world(dir)), dir));
}

#[test]
fn schedules_include_rows_by_their_middle() {
    let rows = day(0.0, 0.0).rows;
    let hours = |from: f64, to: f64| {
        let schedule = Schedule { from, to, weekdays_only: false };
        rows.iter().filter(|row| schedule.includes(row)).count()
    };
    assert_eq!([hours(8.0, 18.0), hours(0.0, 24.0), hours(22.0, 6.0), hours(8.5, 9.5)], [10, 24, 8, 1]);
    // The day is a Sunday.
    assert!(!Schedule { weekdays_only: true, ..Schedule::default() }.includes(&rows[12]));
    assert!(
        Schedule { weekdays_only: true, ..Schedule::default() }.includes(&WeatherRow { weekday: None, ..rows[12] })
    );
}

#[test]
fn figures_count_dark_and_bright_hours() {
    // Under an open overcast sky of 5 W/m^2, about 600 lux, every hour of the day is bright enough.
    let sensors = [upward(Vec3::ZERO), Sensor { point: Vec3::ZERO, normal: Vec3::NEG_Y }];
    let options = AnnualOptions { schedule: Schedule { from: 0.0, to: 24.0, weekdays_only: false }, ..all_hours() };
    let found = run(scene(MATTE, NOTHING), &day(0.0, 5.0), 145, &sensors, &options);
    let figures = found.sensors[0].figures;
    assert_eq!((found.occupied_hours, found.missing_hours), (24.0, 0.0));
    assert_eq!((figures.autonomy, figures.continuous_autonomy), (0.75, 0.75));
    assert_eq!((figures.useful, figures.useful_share()), ([0.25, 0.0, 0.75, 0.0], 0.75));
    assert_eq!(figures.sun_hours, 0.0);
    // The other sensor sees only the ground, which has a fifth of the light.
    let below = found.sensors[1].figures;
    assert_eq!(below.useful, [0.25, 0.75, 0.0, 0.0]);
    assert!((below.mean / figures.mean - 0.2).abs() < 0.01, "{}", below.mean / figures.mean);
    assert_eq!(found.spatial_autonomy(&[0, 1], 0.5), [0.5, 0.0]);
    // In full sunlight, the first sensor has 18 hours of sun minus those with a low sun.
    let sunny = run(scene(MATTE, NOTHING), &day(800.0, 100.0), 145, &sensors, &options);
    assert!((14.0..=18.0).contains(&sunny.sensors[0].figures.sun_hours));
    assert_eq!((sunny.sun_exposure(&[0, 1], 10.0), sunny.sun_exposure(&[0, 1], 20.0)), (0.5, 0.0));
}

#[test]
fn missing_hours_are_left_out() {
    let mut weather = day(0.0, 5.0);
    weather.rows[12].diffuse_horizontal = None;
    let found = run(scene(MATTE, NOTHING), &weather, 145, &[upward(Vec3::ZERO)], &all_hours());
    assert_eq!((found.occupied_hours, found.missing_hours), (9.0, 1.0));
    assert!(found.sensors[0].hours[12].illuminance.is_nan());
    assert_eq!(found.sensors[0].figures.autonomy, 1.0);
    let none = AnnualOptions { schedule: Schedule { from: 0.1, to: 0.2, weekdays_only: false }, ..all_hours() };
    let empty = run(scene(MATTE, NOTHING), &weather, 145, &[upward(Vec3::ZERO)], &none);
    assert_eq!((empty.occupied_hours, empty.sensors[0].figures), (0.0, AnnualFigures::default()));
}

#[test]
fn errors_of_a_room_agree_with_repeated_runs() {
    let room = "MaterialIndex 0 Plane { normal 0 1 0 offset 0 } \
                Rectangle { corner -2 2.5 -2 edge0 0 0 4 edge1 4 0 0 } Rectangle { corner -2 0 -2 edge0 4 0 0 edge1 0 2.5 0 }";
    let weather = day(400.0, 150.0);
    let mean = |seed: u64| {
        let options = AnnualOptions { samples: 1 << 10, seed, ..AnnualOptions::default() };
        let found = run(scene(MATTE, room), &weather, 145, &[upward(Vec3::new(0.0, 0.8, 0.0))], &options);
        (found.sensors[0].figures.mean, found.sensors[0].errors.mean)
    };
    let runs: Vec<(f64, f64)> = (0..16).map(mean).collect();
    let average = runs.iter().map(|run| run.0).sum::<f64>() / 16.0;
    let spread = (runs.iter().map(|run| (run.0 - average) * (run.0 - average)).sum::<f64>() / 15.0).sqrt();
    let stated = runs.iter().map(|run| run.1).sum::<f64>() / 16.0;
    // The samples are stratified, so the spread may be smaller than stated.
    assert!(spread < 1.6 * stated && spread > 0.1 * stated, "{spread}, stated {stated}");
}
