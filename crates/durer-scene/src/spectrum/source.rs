//! Spectra from files, and their colours: of surfaces under daylight (D65), of lights, of
//! coefficients.

use super::black_body::planck_ratio;
use super::observer_and_daylight;
use super::space::SRGB_FROM_XYZ;
use crate::math::{Color, Vec3};
use glam::DVec3;

/// A colour or a spectrum.
#[derive(Clone, Debug, PartialEq)]
pub enum SpectrumSource {
    /// Red, green and blue of linear sRGB.
    Rgb(Color),
    /// Wavelengths in nanometres, rising, and values.
    Curve(Vec<[f32; 2]>),
    /// A black body, by its temperature in kelvin.
    Blackbody(f32),
    /// A light of luminance 1.
    Illuminant(Color),
}

impl SpectrumSource {
    /// The colour of a reflectance under daylight, each channel from 0 to 1.
    pub fn albedo(&self) -> Color {
        match self {
            SpectrumSource::Rgb(color) => color.clamp(Vec3::ZERO, Vec3::ONE),
            _ => under_daylight(|nm| self.at(nm)).clamp(Vec3::ZERO, Vec3::ONE),
        }
    }

    /// Red, green and blue of a value without an upper bound, such as a coefficient of a medium.
    pub fn coefficient(&self) -> Color {
        match self {
            SpectrumSource::Rgb(color) => color.max(Vec3::ZERO),
            _ => under_daylight(|nm| self.at(nm)).max(Vec3::ZERO),
        }
    }

    /// The colour of a light. Spectra are scaled to luminance 1, as pbrt-v4 does; colours are
    /// returned unchanged.
    pub fn light(&self) -> Color {
        match self {
            SpectrumSource::Rgb(color) | SpectrumSource::Illuminant(color) => *color,
            _ => {
                let sum = xyz_sum(|nm| f64::from(self.at(nm)));
                let color = SRGB_FROM_XYZ * (sum / sum.y);
                if color.is_finite() { color.as_vec3().max(Vec3::ZERO) } else { Vec3::ZERO }
            }
        }
    }

    /// Red, green and blue as pbrt-v3 computes them for lights, reflectances and indices alike: a
    /// spectrum of 1 has luminance 1. A curve keeps its end values beyond its ends, and a black body
    /// is 1 at its peak.
    pub fn plain(&self) -> Color {
        match self {
            SpectrumSource::Rgb(color) | SpectrumSource::Illuminant(color) => *color,
            SpectrumSource::Blackbody(kelvin) => {
                // Source: Wien's law.
                let strongest = self.at(2.897_772e6 / kelvin);
                radiance(|nm| self.at(nm) / strongest)
            }
            SpectrumSource::Curve(curve) => {
                let (Some(first), Some(last)) = (curve.first(), curve.last()) else { return Vec3::ZERO };
                radiance(|nm| self.at(nm.clamp(first[0], last[0])))
            }
        }
    }

    /// The value at a wavelength in nanometres. A colour is blue below 490 nm, red from 580 nm.
    pub fn at(&self, nm: f32) -> f32 {
        match self {
            SpectrumSource::Rgb(c) | SpectrumSource::Illuminant(c) => match nm {
                ..490.0 => c.z,
                490.0..580.0 => c.y,
                _ => c.x,
            },
            SpectrumSource::Blackbody(kelvin) => planck_ratio(nm, *kelvin),
            SpectrumSource::Curve(curve) => {
                let above = curve.partition_point(|row| row[0] < nm);
                match (above.checked_sub(1).map(|i| curve[i]), curve.get(above)) {
                    (Some([a, low]), Some(&[b, high])) => low + (high - low) * (nm - a) / (b - a),
                    (None, Some(&[b, high])) if b == nm => high,
                    // 0 beyond its ends, as in pbrt.
                    _ => 0.0,
                }
            }
        }
    }

    /// One index of refraction: the value at helium's yellow line, 587.6 nm.
    pub fn index(&self) -> f32 {
        self.at(587.6)
    }
}

/// Wavelength of the first row, and from row to row, in nanometres.
const FIRST: f32 = 380.0;
const STEP: f32 = 10.0;

/// The number of rows.
const ROWS: u16 = 41;

/// X, Y and Z of a spectrum, at an arbitrary scale.
pub fn xyz_sum(light: impl Fn(f32) -> f64) -> DVec3 {
    let row = |i| {
        let nm = FIRST + STEP * f32::from(i);
        let [x, y, z, _] = observer_and_daylight(nm);
        Vec3::new(x, y, z).as_dvec3() * light(nm)
    };
    (0..ROWS).map(row).sum()
}

/// D65 at a wavelength of a row, at an arbitrary scale.
fn daylight(nm: f32) -> f32 {
    observer_and_daylight(nm)[3]
}

/// The colour of a reflectance under daylight; 1 at all wavelengths is 1 1 1.
pub fn under_daylight(share: impl Fn(f32) -> f32) -> Color {
    let lit = |share: &dyn Fn(f32) -> f32| SRGB_FROM_XYZ * xyz_sum(|nm| f64::from(share(nm) * daylight(nm)));
    (lit(&share) / lit(&|_| 1.0)).as_vec3()
}

/// The colour of a light from its radiance at each wavelength in nanometres; 1 at all wavelengths
/// has luminance 1.
pub fn radiance(light: impl Fn(f32) -> f32) -> Color {
    let color = SRGB_FROM_XYZ * xyz_sum(|nm| f64::from(light(nm))) / xyz_sum(|_| 1.0).y;
    if color.is_finite() { color.as_vec3().max(Vec3::ZERO) } else { Vec3::ZERO }
}
