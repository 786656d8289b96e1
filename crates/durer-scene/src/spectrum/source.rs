//! Spectra from scene files, and their colours when used as reflectances under daylight (D65), as
//! lights, or as coefficients.

use super::black_body::planck_ratio;
use super::observer_and_daylight;
use super::space::SRGB_FROM_XYZ;
use crate::math::{Color, Vec3};
use glam::DVec3;

/// Colour or spectrum that a scene file gives for a material or a light.
#[derive(Clone, Debug, PartialEq)]
pub enum SpectrumSource {
    /// Linear sRGB colour.
    Rgb(Color),
    /// Values at ascending wavelengths in nanometres.
    Curve(Vec<[f32; 2]>),
    /// Black body, given by its temperature in kelvin.
    Blackbody(f32),
    /// Colour of a light with luminance 1.
    Illuminant(Color),
}

impl SpectrumSource {
    /// Colour of a reflectance under daylight, each channel from 0 to 1.
    pub fn albedo(&self) -> Color {
        match self {
            SpectrumSource::Rgb(color) => color.clamp(Vec3::ZERO, Vec3::ONE),
            _ => under_daylight(|nm| self.at(nm)).clamp(Vec3::ZERO, Vec3::ONE),
        }
    }

    /// Linear sRGB colour of an unbounded value, such as a coefficient of a medium.
    pub fn coefficient(&self) -> Color {
        match self {
            SpectrumSource::Rgb(color) => color.max(Vec3::ZERO),
            _ => under_daylight(|nm| self.at(nm)).max(Vec3::ZERO),
        }
    }

    /// Colour of a light. Spectra are scaled to luminance 1, as in pbrt-v4. RGB colours are
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

    /// Linear sRGB colour as pbrt-v3 computes it for lights, reflectances and indices. A spectrum
    /// that is 1 everywhere has luminance 1. A curve is constant beyond its ends. A black body has
    /// the value 1 at its peak.
    pub fn pbrt_v3_color(&self) -> Color {
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

    /// Value at a wavelength in nanometres. For an RGB colour, this is the blue channel below 490
    /// nm, the green channel up to 580 nm, and the red channel above.
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
                    // The curve is 0 beyond its ends, as in pbrt.
                    _ => 0.0,
                }
            }
        }
    }

    /// Index of refraction, which is the value at the yellow helium line, 587.6 nm.
    pub fn index(&self) -> f32 {
        self.at(587.6)
    }
}

/// First wavelength in nanometres, and the step between wavelengths, which must be small enough for
/// narrow bands.
const FIRST: f32 = 380.0;
const STEP: f32 = 1.0;

/// Number of wavelengths.
const ROWS: u16 = 401;

/// XYZ value of a spectrum, on an arbitrary scale.
pub fn xyz_sum(light: impl Fn(f32) -> f64) -> DVec3 {
    let row = |i| {
        let nm = FIRST + STEP * f32::from(i);
        let [x, y, z, _] = observer_and_daylight(nm);
        Vec3::new(x, y, z).as_dvec3() * light(nm)
    };
    (0..ROWS).map(row).sum()
}

/// Value of illuminant D65 at a wavelength, on an arbitrary scale.
fn daylight(nm: f32) -> f32 {
    observer_and_daylight(nm)[3]
}

/// Colour of a reflectance under daylight. A reflectance of 1 has the colour 1 1 1.
pub fn under_daylight(share: impl Fn(f32) -> f32) -> Color {
    let lit = |share: &dyn Fn(f32) -> f32| SRGB_FROM_XYZ * xyz_sum(|nm| f64::from(share(nm) * daylight(nm)));
    (lit(&share) / lit(&|_| 1.0)).as_vec3()
}

/// Colour of a light, given its radiance at each wavelength in nanometres. A constant radiance of 1
/// has luminance 1.
pub fn radiance(light: impl Fn(f32) -> f32) -> Color {
    let color = SRGB_FROM_XYZ * xyz_sum(|nm| f64::from(light(nm))) / xyz_sum(|_| 1.0).y;
    if color.is_finite() { color.as_vec3().max(Vec3::ZERO) } else { Vec3::ZERO }
}
