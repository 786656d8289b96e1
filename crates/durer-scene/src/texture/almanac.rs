//! Position of the sun at a place and time.
//!
//! Source: *The Astronomical Almanac*, section C, *Low precision formulas for the Sun*, accurate to
//! 0.01 degrees from 1950 to 2050; sidereal time and horizontal coordinates as in Michalsky, *The
//! Astronomical Almanac's algorithm for approximate solar position*, Solar Energy 40, 1988.
//! Atmospheric refraction, up to half a degree at the horizon, is ignored.

use crate::math::{Vec3, fp};

/// Date and time in the Gregorian calendar, in local time, for which the sun's position is
/// computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Year, month and day.
    pub date: [i32; 3],
    /// Number of hours since midnight.
    pub hours: f64,
    /// Offset of the clock from UTC in hours, positive if the clock is ahead of UTC.
    pub zone: f64,
}

impl Moment {
    /// True if the date exists in the calendar.
    pub fn exists(&self) -> bool {
        let [year, month, day] = self.date;
        (1..=12).contains(&month) && (1..=days_of(year, month)).contains(&day)
    }

    /// Number of days since noon of 1 January 2000, in UTC.
    fn days(&self) -> f64 {
        let [year, month, day] = self.date;
        // Start the year in March, so that the leap day is the last day of the year.
        let (y, m) = if month > 2 { (year, month - 3) } else { (year - 1, month + 9) };
        let before = 365 * y + y.div_euclid(4) - y.div_euclid(100) + y.div_euclid(400) + (153 * m + 2) / 5 + day;
        // The day number of 1 January 2000 is 730426.
        f64::from(before - 730_426) - 0.5 + (self.hours - self.zone) / 24.0
    }
}

fn days_of(year: i32, month: i32) -> i32 {
    match month {
        2 if year % 4 == 0 && (year % 100 != 0 || year % 400 == 0) => 29,
        2 => 28,
        4 | 6 | 9 | 11 => 30,
        _ => 31,
    }
}

/// Returns the number of a day in its year, from 1 to 366. The date must exist, except that 29
/// February is accepted in any year.
pub fn day_of_year([year, month, day]: [i32; 3]) -> u32 {
    let before: i32 = (1..month.clamp(1, 12)).map(|month| days_of(year, month)).sum();
    (before + day).clamp(1, 366) as u32
}

/// Returns the sun's altitude above the horizon, and its azimuth from north through east, both in
/// degrees. The place is given in degrees north and degrees east.
pub fn sun([latitude, longitude]: [f64; 2], moment: &Moment) -> [f64; 2] {
    let n = moment.days();
    let sin = |degrees: f64| fp::sin_cos_degrees(degrees).0;
    let mean = (280.460 + 0.985_647_4 * n).rem_euclid(360.0);
    let anomaly = (357.528 + 0.985_600_3 * n).rem_euclid(360.0);
    // Compute the ecliptic longitude and the obliquity of the ecliptic.
    let (along_sin, along_cos) = fp::sin_cos_degrees(mean + 1.915 * sin(anomaly) + 0.020 * sin(2.0 * anomaly));
    let (lean_sin, lean_cos) = fp::sin_cos_degrees(23.439 - 0.000_000_4 * n);
    // Unit vector in equatorial coordinates, with x towards the vernal equinox and z north.
    let (x, y, z) = (along_cos, lean_cos * along_sin, lean_sin * along_sin);
    let sidereal = 15.0 * (6.697_375 + 0.065_709_824_2 * n + (moment.hours - moment.zone)).rem_euclid(24.0) + longitude;
    let (turn_sin, turn_cos) = fp::sin_cos_degrees(sidereal.rem_euclid(360.0));
    let (south, east) = (x * turn_cos + y * turn_sin, y * turn_cos - x * turn_sin);
    let (lat_sin, lat_cos) = fp::sin_cos_degrees(latitude);
    let (up, north) = (lat_sin * z + lat_cos * south, lat_cos * z - lat_sin * south);
    let degrees = |y: f64, x: f64| fp::atan2_f64(y, x).to_degrees();
    [degrees(up, (north * north + east * east).sqrt()), degrees(east, north).rem_euclid(360.0)]
}

/// Unit vector for an altitude and an azimuth in degrees, where y is up, -z is north and x is east.
pub fn direction([altitude, azimuth]: [f64; 2]) -> Vec3 {
    let ((sin, cos), (s, c)) = (fp::sin_cos_degrees(altitude), fp::sin_cos_degrees(azimuth));
    Vec3::new((cos * s) as f32, sin as f32, (-cos * c) as f32)
}

/// Altitude and azimuth in degrees of a direction, of any length. The inverse of [`direction`]; the
/// azimuth is in [0, 360).
pub fn angles(direction: Vec3) -> [f64; 2] {
    let v = direction.as_dvec3();
    let azimuth = fp::atan2_f64(v.x, -v.z).to_degrees();
    let altitude = fp::atan2_f64(v.y, (v.x * v.x + v.z * v.z).sqrt()).to_degrees();
    [altitude, if azimuth < 0.0 { azimuth + 360.0 } else { azimuth }]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(place: [f64; 2], date: [i32; 3], [h, m, s]: [f64; 3], zone: f64) -> [f64; 2] {
        let moment = Moment { date, hours: h + m / 60.0 + s / 3600.0, zone };
        assert!(moment.exists());
        sun(place, &moment)
    }

    #[test]
    fn sun_position_agrees_with_published_values() {
        // Reda and Andreas, *Solar position algorithm*, NREL, 2003, table A5.1, gives a zenith
        // angle of 50.111 with refraction and 50.128 without, and an azimuth of 194.340.
        let [altitude, azimuth] = at([39.742476, -105.1786], [2003, 10, 17], [12.0, 30.0, 30.0], -7.0);
        assert!((altitude - 39.872).abs() < 0.01 && (azimuth - 194.340).abs() < 0.01, "{altitude} {azimuth}");
        // Meeus, *Astronomical Algorithms*, example 25.a, gives a declination of -7.78507 on 1992
        // October 13. It equals the altitude seen from the pole.
        let [altitude, _] = at([90.0, 0.0], [1992, 10, 13], [0.0; 3], 0.0);
        assert!((altitude + 7.785).abs() < 0.01, "{altitude}");
        // The almanac lists the solstice of 21 June 2026 at 8:25, and the equinox of 20 March 2026
        // at 14:46.
        let [altitude, _] = at([90.0, 0.0], [2026, 6, 21], [8.0, 25.0, 0.0], 0.0);
        assert!((altitude - 23.436).abs() < 0.01, "{altitude}");
        let [altitude, _] = at([90.0, 0.0], [2026, 3, 20], [14.0, 46.0, 0.0], 0.0);
        assert!(altitude.abs() < 0.01, "{altitude}");
    }

    #[test]
    fn sun_position_agrees_across_time_zones() {
        // Compare one moment in three time zones. In one of them, the next day has already begun.
        let [date, next] = [[2024, 2, 28], [2024, 2, 29]];
        let place = [-33.9, 151.2];
        let here = at(place, date, [20.0, 0.0, 0.0], 0.0);
        for other in [at(place, next, [7.0, 0.0, 0.0], 11.0), at(place, date, [15.0, 30.0, 0.0], -4.5)] {
            assert!((here[0] - other[0]).abs() < 1e-9 && (here[1] - other[1]).abs() < 1e-9, "{here:?} {other:?}");
        }
        // In the southern hemisphere the sun is in the north at noon and in the east in the
        // morning.
        let [noon, morning] = [[13.0, 0.0, 0.0], [7.0, 0.0, 0.0]].map(|time| at(place, next, time, 11.0));
        assert!(noon[1] < 20.0 || noon[1] > 340.0, "{noon:?}");
        assert!((morning[1] - 90.0).abs() < 20.0, "{morning:?}");
        let [x, y, z] = direction(morning).to_array();
        assert!(x > 0.9 && y > 0.0 && z.abs() < 0.4);
        assert!((direction([0.0, 0.0]) - Vec3::NEG_Z).length() < 1e-6);
        for [altitude, azimuth] in [[0.0, 0.0], [35.0, 90.0], [-60.0, 200.0], [1.0, 359.0]] {
            let found = angles(3.0 * direction([altitude, azimuth]));
            assert!((found[0] - altitude).abs() < 1e-5 && (found[1] - azimuth).abs() < 1e-5, "{found:?}");
        }
    }

    #[test]
    fn days_follow_the_calendar() {
        let day = |date| Moment { date, hours: 0.0, zone: 0.0 };
        for (date, exists) in [
            ([2024, 2, 29], true),
            ([2023, 2, 29], false),
            ([1900, 2, 29], false),
            ([2000, 2, 29], true),
            ([2024, 4, 31], false),
            ([2024, 13, 1], false),
            ([2024, 0, 1], false),
            ([2024, 12, 31], true),
        ] {
            assert_eq!(day(date).exists(), exists, "{date:?}");
        }
        // Each day number must be one more than that of the day before.
        let mut last = day([1999, 12, 31]).days();
        assert_eq!(last, -1.5);
        for year in 2000..2101 {
            for month in 1..=12 {
                for date in 1..=days_of(year, month) {
                    let days = day([year, month, date]).days();
                    assert_eq!(days, last + 1.0, "{year} {month} {date}");
                    last = days;
                }
            }
        }
    }
}
