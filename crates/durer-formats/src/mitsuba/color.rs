//! Reads the colours of reflectances and lights, and reads indices of refraction.
//!
//! Spectra are converted as in Mitsuba's RGB variants: a reflectance spectrum is converted under
//! daylight. An emission spectrum is converted without a white point, so a spectrum that is 1 at
//! all wavelengths becomes slightly red. An emission that is written as a number or as a colour is
//! used unchanged.

use super::plugin::{Plugin, Property, Value};
use super::state::Reader;
use durer_scene::math::{Color, Vec3};
use durer_scene::spectrum::black_body::planck;
use durer_scene::spectrum::space::SRGB_FROM_XYZ;
use durer_scene::spectrum::{SpectrumSource, observer_and_daylight, radiance};
use glam::DVec3;

/// Returns the colour of a light as [`radiance`] does, but from a sum over all nanometres, which is
/// exact also for spectra whose slope changes suddenly.
fn fine_radiance(light: impl Fn(f32) -> f32) -> Color {
    let sum = |light: &dyn Fn(f32) -> f32| -> DVec3 {
        let at = |nm: u16| {
            let [x, y, z, _] = observer_and_daylight(f32::from(nm)).map(f64::from);
            DVec3::new(x, y, z) * f64::from(light(f32::from(nm)))
        };
        (360..=830).map(at).sum()
    };
    // In units in which a constant radiance of 1 has the same colour in both sums.
    let coarse = radiance(|_| 1.0).as_dvec3();
    let color = SRGB_FROM_XYZ * sum(&light) / (SRGB_FROM_XYZ * sum(&|_| 1.0)) * coarse;
    if color.is_finite() { color.as_vec3().max(Vec3::ZERO) } else { Vec3::ZERO }
}

impl Reader<'_> {
    /// Returns the colour of a reflectance, transmittance or absorption, or `None` if the property
    /// is not a colour.
    pub fn reflectance(&self, property: &Property) -> Option<Color> {
        match &property.value {
            Value::Number(number) => Some(Vec3::splat(*number as f32)),
            Value::ConstantSpectrum(number) => Some(Vec3::splat(*number)),
            Value::Rgb(color) => Some(*color),
            Value::Spectrum(curve) => Some(SpectrumSource::Curve(curve.clone()).coefficient()),
            _ => self.spectrum_plugin(property, false),
        }
    }

    /// Returns the colour of a light, or `None` if the property is not a colour.
    pub fn emission(&self, property: &Property) -> Option<Color> {
        match &property.value {
            Value::Number(number) => Some(Vec3::splat(*number as f32)),
            Value::ConstantSpectrum(number) => Some(*number * radiance(|_| 1.0)),
            Value::Rgb(color) => Some(*color),
            Value::Spectrum(curve) => {
                let curve = SpectrumSource::Curve(curve.clone());
                Some(fine_radiance(|nm| curve.at(nm)))
            }
            _ => self.spectrum_plugin(property, true),
        }
    }

    /// Returns the colour that a spectrum plugin represents.
    fn spectrum_plugin(&self, property: &Property, emits: bool) -> Option<Color> {
        let plugin = self.child_plugin(property)?;
        let report = self.report;
        let color = match plugin.kind.as_str() {
            "uniform" => {
                let value = plugin.number(report, "value").unwrap_or(1.0);
                value * if emits { radiance(|_| 1.0) } else { Vec3::ONE }
            }
            "d65" => {
                let scale = plugin.number(report, "scale").unwrap_or(1.0);
                let color = plugin.get("color").and_then(|color| self.reflectance(color));
                scale * color.unwrap_or(Vec3::ONE)
            }
            "srgb" => plugin.get("color").and_then(|color| self.reflectance(color)).unwrap_or(Vec3::ONE),
            "blackbody" => {
                let kelvin = plugin.positive(report, "temperature").unwrap_or(5000.0);
                fine_radiance(|nm| planck(nm, kelvin)) * plugin.number(report, "scale").unwrap_or(1.0)
            }
            "regular" | "irregular" => {
                let curve = SpectrumSource::Curve(self.sampled_spectrum(&plugin)?);
                if emits { fine_radiance(|nm| curve.at(nm)) } else { curve.coefficient() }
            }
            _ => return None,
        };
        plugin.warn_unused(report);
        Some(color)
    }

    /// Returns the wavelengths and values of a `regular` or `irregular` spectrum plugin.
    fn sampled_spectrum(&self, plugin: &Plugin) -> Option<Vec<[f32; 2]>> {
        let report = self.report;
        let list = |name| {
            let text = plugin.text(report, name)?;
            super::load::numbers(&text)
        };
        let values = list("values")?;
        let at = |i: usize| -> Option<f64> {
            if plugin.kind == "irregular" {
                return list("wavelengths")?.get(i).copied();
            }
            let [low, high] = ["wavelength_min", "wavelength_max"].map(|name| plugin.number(report, name));
            let [low, high] = [f64::from(low?), f64::from(high?)];
            Some(low + (high - low) * i as f64 / (values.len() - 1).max(1) as f64)
        };
        let curve: Option<Vec<[f32; 2]>> =
            values.iter().enumerate().map(|(i, value)| Some([at(i)? as f32, *value as f32])).collect();
        let curve = curve.filter(|curve| curve.len() > 1 && curve.is_sorted_by(|a, b| a[0] < b[0]));
        if curve.is_none() {
            let message =
                format!("a `{}` spectrum needs increasing wavelengths and one value for each wavelength", plugin.kind);
            report.error(plugin.at, message);
        }
        curve
    }
}
