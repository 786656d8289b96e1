//! Weather of a place over a year, as far as it determines daylight.

use crate::math::Vec3;
use crate::texture::almanac::{self, Moment};
use crate::texture::sky::perez::{self, Irradiance, Perez};

/// Place of a weather station.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Place {
    /// Name, which can be empty.
    pub name: String,
    /// Latitude in degrees north of the equator, from -90 to 90.
    pub latitude: f64,
    /// Longitude in degrees east of Greenwich, from -180 to 180.
    pub longitude: f64,
    /// Offset of the station's clock from UTC in hours, positive if the clock is ahead of UTC.
    pub time_zone: f64,
}

/// Measured light of one interval, usually an hour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WeatherRow {
    /// Year, month and day.
    pub date: [i32; 3],
    /// Middle of the interval, in hours since midnight in standard time.
    pub hours: f64,
    /// Length of the interval in hours.
    pub duration: f64,
    /// Day of the week, from 0 for Monday to 6 for Sunday, if known.
    pub weekday: Option<u8>,
    /// Irradiance from the sun on a surface that faces it, in W/m^2; `None` if it is missing.
    pub direct_normal: Option<f32>,
    /// Irradiance from the sky on a horizontal surface, in W/m^2; `None` if it is missing.
    pub diffuse_horizontal: Option<f32>,
    /// Dew point in degrees Celsius; `None` if it is missing.
    pub dew_point: Option<f32>,
}

/// Weather of a place, in the order of time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Weather {
    /// Place at which the light was measured.
    pub place: Place,
    /// Intervals, which usually cover a year.
    pub rows: Vec<WeatherRow>,
}

/// Sun and sky of one interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Daylight {
    /// The irradiance is missing, but the sun is above the horizon.
    Missing,
    /// Neither the sun nor the sky emits light.
    Dark,
    /// An all-weather sky. The sun emits light if [`Perez::sun_illuminance`] is above 0.
    Sky(Perez),
}

impl Place {
    /// Returns the direction to the sun at a date and a time of the station's clock in hours, as a
    /// unit vector where y is up, -z is north and x is east.
    pub fn to_sun(&self, date: [i32; 3], hours: f64) -> Vec3 {
        let moment = Moment { date, hours, zone: self.time_zone };
        almanac::direction(almanac::sun([self.latitude, self.longitude], &moment))
    }
}

/// Number of halvings that find the time of sunrise, to less than a second.
const HALVINGS: u32 = 13;

impl WeatherRow {
    /// Returns the direction to the sun in the middle of the interval. If the sun rises or sets
    /// during the interval, it is the middle of the part during which the sun is up.
    pub fn to_sun(&self, place: &Place) -> Vec3 {
        let [start, end] = [-0.5, 0.5].map(|part| self.hours + part * self.duration);
        let is_up = |hours: f64| place.to_sun(self.date, hours).y > 0.0;
        let (first, last) = (is_up(start), is_up(end));
        if first == last {
            return place.to_sun(self.date, self.hours);
        }
        let (mut low, mut high) = (start, end);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if is_up(middle) == first { low = middle } else { high = middle }
        }
        place.to_sun(self.date, 0.5 * (low + if first { start } else { end }))
    }

    /// Returns the sun and the sky of the interval. The sun emits light only if it is above the
    /// horizon; the light of a sky without a sun comes from the sky of a sun at the horizon.
    pub fn daylight(&self, place: &Place) -> Daylight {
        let sun = self.to_sun(place);
        let (Some(direct), Some(diffuse)) = (self.direct_normal, self.diffuse_horizontal) else {
            return if sun.y > 0.0 { Daylight::Missing } else { Daylight::Dark };
        };
        let direct_normal = if sun.y > 0.0 { direct } else { 0.0 };
        if direct_normal <= 0.0 && diffuse <= 0.0 {
            return Daylight::Dark;
        }
        let light = Irradiance {
            direct_normal,
            diffuse_horizontal: diffuse,
            dew_point: self.dew_point.unwrap_or(perez::DEW_POINT),
            eccentricity: perez::eccentricity(almanac::day_of_year(self.date)),
        };
        Daylight::Sky(Perez::new(sun, &light))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HELSINKI: fn() -> Place =
        || Place { name: "Helsinki".into(), latitude: 60.17, longitude: 24.94, time_zone: 2.0 };

    fn row(date: [i32; 3], hours: f64, direct: f32, diffuse: f32) -> WeatherRow {
        let (direct_normal, diffuse_horizontal) = (Some(direct), Some(diffuse));
        WeatherRow { date, hours, duration: 1.0, weekday: None, direct_normal, diffuse_horizontal, dew_point: None }
    }

    #[test]
    fn sun_of_an_hour_with_sunrise_is_up() {
        let place = HELSINKI();
        let noon = row([2026, 6, 21], 12.5, 800.0, 100.0);
        assert_eq!(noon.to_sun(&place), place.to_sun([2026, 6, 21], 12.5));
        let mut changes = 0;
        for hour in 0..24 {
            let row = row([2026, 3, 21], f64::from(hour) + 0.5, 100.0, 50.0);
            let [start, end] = [0.0, 1.0].map(|part| place.to_sun(row.date, f64::from(hour) + part).y);
            if start * end < 0.0 {
                changes += 1;
                let found = row.to_sun(&place).y;
                assert!(found > 0.0 && (found / (0.5 * start.max(end)) - 1.0).abs() < 0.01, "{hour}: {found}");
            }
        }
        assert_eq!(changes, 2);
    }

    #[test]
    fn missing_light_matters_only_during_the_day() {
        let place = HELSINKI();
        let lacks = |hours: f64| WeatherRow { diffuse_horizontal: None, ..row([2026, 3, 21], hours, 0.0, 0.0) };
        assert_eq!(lacks(12.5).daylight(&place), Daylight::Missing);
        assert_eq!(lacks(0.5).daylight(&place), Daylight::Dark);
        assert_eq!(row([2026, 3, 21], 12.5, 0.0, 0.0).daylight(&place), Daylight::Dark);
        // At dusk, the sky is bright although the sun is below the horizon.
        let Daylight::Sky(dusk) = row([2026, 3, 21], 0.5, 10.0, 10.0).daylight(&place) else { panic!() };
        assert_eq!((dusk.sun_illuminance(), dusk.sun().y), (0.0, 0.0));
        assert!(dusk.sky_illuminance() > 500.0);
    }
}
