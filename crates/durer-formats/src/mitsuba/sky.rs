//! Reads daylight emitters: `sunsky`, and `sky` and `sun` of Mitsuba 0.6.
//!
//! Mitsuba uses the sky of Hosek and Wilkie, *An Analytic Model for Full Spectral Sky-Dome
//! Radiance*, SIGGRAPH 2012. Dürer uses Preetham's sun, and Preetham's sky scaled to the same
//! illuminance.

use super::defs::InfiniteLight;
use super::plugin::Plugin;
use super::state::Reader;
use durer_scene::light::DirectionalLight;
use durer_scene::math::{LUMINANCE, Vec3, fp};
use durer_scene::scene::Spanned;
use durer_scene::texture::Sky;
use durer_scene::texture::almanac::{self, Moment};
use durer_scene::texture::sky::SUN_RADIUS;
use glam::{DAffine3, DMat3, DVec3};
use std::f32::consts::PI;

/// Luminous efficacy of a constant spectrum in lumens per watt. Mitsuba's unit is the mean number
/// of watts per nanometre, so the value is 683 lm/W times the integral of the CIE function y over
/// all wavelengths.
const LUMENS: f32 = 683.0 * 106.856_9;

/// Illuminance in lux of level ground under the Hosek-Wilkie sky, for a ground albedo of 0.2. Each
/// row is for one turbidity, and each column is for one elevation of the sun in degrees. Each value
/// is a sum over 1,152 directions of `sunsky` in Mitsuba 3.9.1, multiplied by [`LUMENS`].
const TURBIDITIES: [f32; 4] = [2.0, 3.0, 5.0, 8.0];
const HEIGHTS: [f32; 5] = [5.0, 20.0, 40.0, 60.0, 85.0];
const LEVEL: [[f32; 5]; 4] = [
    [6175.0, 11238.0, 14080.0, 15241.0, 16662.0],
    [6596.0, 12653.0, 16295.0, 17668.0, 19031.0],
    [7638.0, 16822.0, 23228.0, 25665.0, 27006.0],
    [8416.0, 21362.0, 34504.0, 40648.0, 38652.0],
];

/// Interpolates bilinearly in the table.
fn illuminance(turbidity: f32, height: f32) -> f32 {
    let ((i, a), (j, b)) = (interval(&TURBIDITIES, turbidity), interval(&HEIGHTS, height));
    let row = |i: usize| LEVEL[i][j] + b * (LEVEL[i][j + 1] - LEVEL[i][j]);
    row(i) + a * (row(i + 1) - row(i))
}

/// Finds the interval of an ascending list that contains `x`. Returns the index of the interval and
/// the relative position of `x` within it.
fn interval(steps: &[f32], x: f32) -> (usize, f32) {
    let x = x.clamp(steps[0], steps[steps.len() - 1]);
    let i = steps[1..steps.len() - 1].iter().take_while(|step| **step < x).count();
    (i, (x - steps[i]) / (steps[i + 1] - steps[i]))
}

impl Reader<'_> {
    /// Adds a clear sky, the sun, or both.
    pub(super) fn daylight(&mut self, plugin: &Plugin, to_world: DAffine3) {
        let report = self.report;
        let number = |name, default: f32| plugin.number(report, name).unwrap_or(default);
        let turbidity = number("turbidity", 3.0);
        let all = number("scale", 1.0);
        let [sky_scale, sun_scale] = ["sky_scale", "sun_scale"].map(|name| (all * number(name, 1.0)).max(0.0));
        // Rotation to axes in which x is east, y is up and z is south. In Mitsuba 3, x is south, y
        // is west and z is up.
        let up = match self.loader.is_old {
            true => DMat3::IDENTITY,
            false => DMat3::from_cols(DVec3::Z, DVec3::NEG_X, DVec3::Y),
        };
        let way = match plugin.vector(report, "sun_direction") {
            Some(way) => up * to_world.matrix3.inverse() * way,
            None => self.sun_direction_by_time(plugin).as_dvec3(),
        };
        plugin.mark_known(&[
            "sun_aperture",
            "sun_radius_scale",
            "resolution",
            "stretch",
            "sampling_weight",
            "complex_sun",
        ]);
        plugin.warn_unsupported(report, &["albedo"], "a ground albedo of 0.2 is used");
        plugin.warn_unused(report);
        report.unsupported_once(
            plugin.at,
            "the sky of Hosek and Wilkie has no counterpart: Preetham's sky with the same illuminance is used",
        );
        let Some(way) = way.try_normalize().filter(|way| way.y > 0.0) else {
            return report.unsupported_once(plugin.at, "the sun is below the horizon: this light is left out");
        };
        let sky = Sky::new(way.as_vec3(), turbidity);
        let to_world = to_world * DAffine3::from_mat3(up.transpose());
        if plugin.kind != "sun" && sky_scale > 0.0 {
            let measured = PI * sky.mean_on_horizontal().dot(LUMINANCE);
            let height = fp::asin_f64(way.y).to_degrees() as f32;
            let scale = sky_scale * illuminance(turbidity, height) / measured.max(1.0) / LUMENS;
            self.set_infinite_light(InfiniteLight::Sky { sky, at: plugin.at, scale, to_world });
        }
        if plugin.kind != "sky" && sun_scale > 0.0 {
            let direction = -to_world.transform_vector3(way).normalize_or(DVec3::Y).as_vec3();
            // The colour of a light is its illuminance divided by pi.
            let color = sky.sun() * (sun_scale / LUMENS / PI);
            let sun = DirectionalLight { direction, color, spread: Some(SUN_RADIUS), ..DirectionalLight::default() };
            self.scene.lights.get_or_insert_default().push(Spanned { value: sun.into(), span: plugin.at });
        }
    }

    /// Returns the direction to the sun for a location, date and time.
    fn sun_direction_by_time(&self, plugin: &Plugin) -> Vec3 {
        let number = |name, default: f32| f64::from(plugin.number(self.report, name).unwrap_or(default));
        let date = [number("year", 2010.0), number("month", 7.0), number("day", 10.0)].map(|x| x as i32);
        let hours = number("hour", 15.0) + number("minute", 0.0) / 60.0 + number("second", 0.0) / 3600.0;
        let moment = Moment { date, hours, zone: number("timezone", 9.0) };
        if !(moment.exists() && (-9999..=9999).contains(&date[0])) {
            self.report.error(plugin.at, "this date does not exist");
            return Vec3::Y;
        }
        almanac::direction(almanac::sun([number("latitude", 35.689), number("longitude", 139.6917)], &moment))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn illuminance_is_linear_between_table_entries() {
        assert_eq!(
            (illuminance(3.0, 20.0), illuminance(1.0, 0.0), illuminance(10.0, 90.0)),
            (12653.0, 6175.0, 38652.0)
        );
        assert_eq!(illuminance(4.0, 40.0), 0.5 * (16295.0 + 23228.0));
        assert_eq!(illuminance(2.0, 50.0), 0.5 * (14080.0 + 15241.0));
    }
}
