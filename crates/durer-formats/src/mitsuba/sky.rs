//! Reads daylight emitters: `sunsky`, and `sky` and `sun` of Mitsuba 0.6.
//!
//! Mitsuba's sky is that of Hosek and Wilkie with their RGB data, and is black below the horizon.
//! The sun of Mitsuba 3 is their solar radiance of 2013, converted to RGB with 11 wavelengths,
//! which makes it 5 to 8 % brighter than the CIE observer does. The sun of Mitsuba 0.6 is
//! Preetham's.

use super::defs::InfiniteLight;
use super::plugin::Plugin;
use super::state::Reader;
use durer_scene::light::DirectionalLight;
use durer_scene::math::{Vec3, fp};
use durer_scene::scene::Spanned;
use durer_scene::texture::almanac::{self, Moment};
use durer_scene::texture::sky::{Hosek, Preetham, SUN_RADIUS, hosek};
use glam::{DAffine3, DMat3, DVec3};
use std::f32::consts::PI;

/// Luminous efficacy of a constant spectrum in lumens per watt. Mitsuba's unit is the mean number
/// of watts per nanometre, so the value is 683 lm/W times the integral of the CIE function y over
/// all wavelengths, for which Mitsuba uses this number.
const LUMENS: f32 = 683.0 * 106.750_26;

/// Irradiance of the sun of Mitsuba's RGB variants, in little-endian single precision. Mitsuba
/// interpolates linearly between these turbidities and elevations. `xtask/src/sky_data.py` measures
/// the values.
static SUN: &[u8] = include_bytes!("sun.f32");

/// Number of turbidities in the table, which are 1 to 10.
const TURBIDITIES: usize = 10;

/// Number of elevations in the table, which are 2 to 89 degrees.
const ELEVATIONS: usize = 30;

/// Irradiance of a surface that faces the sun, for a turbidity and an elevation in degrees.
fn sun_irradiance(turbidity: f32, elevation: f32) -> Vec3 {
    let entry = |turbidity: usize, elevation: usize| {
        let start = 12 * (turbidity * ELEVATIONS + elevation);
        Vec3::from([0, 4, 8].map(|at| {
            let bytes = SUN.get(start + at..start + at + 4).map_or([0; 4], |b| [b[0], b[1], b[2], b[3]]);
            f32::from_le_bytes(bytes)
        }))
    };
    let (i, a) = interval(turbidity - 1.0, TURBIDITIES);
    let (j, b) = interval((elevation - 2.0) / 3.0, ELEVATIONS);
    let row = |i: usize| entry(i, j).lerp(entry(i, j + 1), b);
    // A red sun at the horizon is outside the gamut.
    row(i).lerp(row(i + 1), a).max(Vec3::ZERO)
}

/// Finds the interval that contains a position in a list. Returns the index of the interval and the
/// position relative to it.
fn interval(position: f32, entries: usize) -> (usize, f32) {
    let position = position.clamp(0.0, (entries - 1) as f32);
    let i = (position as usize).min(entries - 2);
    (i, position - i as f32)
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
        let default_albedo = if self.loader.is_old { 0.2 } else { 0.3 };
        let albedo = plugin.get("albedo").map_or(Vec3::splat(default_albedo), |property| {
            self.reflectance(property).unwrap_or_else(|| self.color(plugin, "albedo", Vec3::splat(default_albedo)))
        });
        let (low, high) = hosek::TURBIDITIES.into_inner();
        if !(low..=high).contains(&turbidity) {
            report.error(plugin.span("turbidity"), format!("`turbidity` must be from {low} to {high}"));
        }
        if !(0.0..=1.0).contains(&albedo.min_element()) || albedo.max_element() > 1.0 {
            report.error(plugin.span("albedo"), "`albedo` must be from 0 to 1");
        }
        let radius = match self.loader.is_old {
            true => SUN_RADIUS * number("sun_radius_scale", 1.0).max(0.0),
            false => plugin.positive(report, "sun_aperture").unwrap_or(0.5358) / 2.0,
        };
        if radius >= 90.0 {
            report.error(plugin.span("sun_aperture"), "the sun must be less than 180 degrees wide");
        }
        plugin.mark_known(&["resolution", "stretch", "sampling_weight"]);
        if plugin.boolean(report, "complex_sun") == Some(true) {
            plugin.warn_unsupported(report, &["complex_sun"], "the sun is a uniform disc of the same irradiance");
        }
        plugin.warn_unused(report);
        let Some(way) = way.try_normalize().filter(|way| way.y > 0.0) else {
            return report.unsupported_once(plugin.at, "the sun is below the horizon: this light is left out");
        };
        let to_world = to_world * DAffine3::from_mat3(up.transpose());
        if plugin.kind != "sun" && sky_scale > 0.0 {
            let (sky, scale) = (Hosek::new(way.as_vec3(), turbidity, albedo), sky_scale / LUMENS);
            self.set_infinite_light(InfiniteLight::Sky { sky, at: plugin.at, scale, to_world });
        }
        if plugin.kind != "sky" && sun_scale > 0.0 {
            let direction = -to_world.transform_vector3(way).normalize_or(DVec3::Y).as_vec3();
            let irradiance = match self.loader.is_old {
                true => Preetham::new(way.as_vec3(), turbidity).sun() / LUMENS,
                false => sun_irradiance(turbidity, fp::asin_f64(way.y).to_degrees() as f32),
            };
            // The colour of a light is its irradiance divided by pi.
            let color = irradiance * (sun_scale / PI);
            let sun = DirectionalLight { direction, color, spread: Some(radius), ..DirectionalLight::default() };
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
