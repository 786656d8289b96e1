//! Spectra as colours: of what reflects under daylight (D65), of lights, of metals.

use durer_scene::math::{Color, Vec3, fp};
use durer_scene::spectrum::observer_and_daylight;
use glam::{DMat3, DVec3};

/// A colour or a spectrum.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Spectrum {
    /// Red, green and blue of linear sRGB; what is white is 1 in any space of colours.
    Rgb(Color),
    /// Wavelengths in nanometres, rising, and values.
    Curve(Vec<[f32; 2]>),
    /// A black body of so many kelvin.
    Blackbody(f32),
    /// A light of luminance 1.
    Illuminant(Color),
}

/// What red, green and blue are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Space {
    to_srgb: DMat3,
}

impl Default for Space {
    fn default() -> Self {
        Space { to_srgb: DMat3::IDENTITY }
    }
}

/// The names of spaces, with the chromaticities of red, green, blue and white.
const SPACES: [(&str, [[f64; 2]; 4]); 4] = [
    ("srgb", [[0.64, 0.33], [0.3, 0.6], [0.15, 0.06], [0.3127, 0.329]]),
    ("dci-p3", [[0.68, 0.32], [0.265, 0.69], [0.15, 0.06], [0.3127, 0.329]]),
    ("rec2020", [[0.708, 0.292], [0.17, 0.797], [0.131, 0.046], [0.3127, 0.329]]),
    ("aces2065-1", [[0.7347, 0.2653], [0.0, 1.0], [0.0001, -0.077], [0.32168, 0.33767]]),
];

/// From X, Y and Z to linear sRGB. Source: IEC 61966-2-1.
const SRGB: DMat3 = DMat3::from_cols_array(&[
    3.2404542, -0.969266, 0.0556434, -1.5371385, 1.8760108, -0.2040259, -0.4985314, 0.041556, 1.0572252,
]);

/// X, Y and Z of luminance 1.
fn xyz([x, y]: [f64; 2]) -> DVec3 {
    DVec3::new(x / y, 1.0, (1.0 - x - y) / y)
}

/// The colour of X, Y and Z.
pub(super) fn of_xyz(xyz: DVec3) -> Color {
    (SRGB * xyz).as_vec3()
}

/// The colour of luminance 1 of a chromaticity.
pub(super) fn of_chromaticity(xy: [f64; 2]) -> Color {
    of_xyz(xyz(xy)).max(Vec3::ZERO)
}

impl Space {
    /// The space of a name; `None` for unknown names.
    pub fn named(name: &str) -> Option<Space> {
        let (name, [r, g, b, white]) = SPACES.iter().find(|row| row.0 == name)?;
        if *name == "srgb" {
            return Some(Space::default());
        }
        let columns = DMat3::from_cols(xyz(*r), xyz(*g), xyz(*b));
        let strengths = columns.inverse() * xyz(*white);
        Some(Space { to_srgb: SRGB * (columns * DMat3::from_diagonal(strengths)) })
    }

    pub fn names() -> impl Iterator<Item = &'static str> {
        SPACES.iter().map(|row| row.0)
    }

    /// A colour of this space, whose white stays white.
    pub fn color(&self, rgb: Vec3) -> Color {
        if *self == Space::default() {
            return rgb;
        }
        let white = self.to_srgb * DVec3::ONE;
        ((self.to_srgb * rgb.as_dvec3()) / white).as_vec3()
    }
}

impl Spectrum {
    /// The share of daylight that something reflects.
    pub fn albedo(&self) -> Color {
        match self {
            Spectrum::Rgb(color) => color.clamp(Vec3::ZERO, Vec3::ONE),
            _ => under_daylight(|nm| self.at(nm)).clamp(Vec3::ZERO, Vec3::ONE),
        }
    }

    /// What has no bounds, as a coefficient of a medium: red, green and blue of it.
    pub fn coefficient(&self) -> Color {
        match self {
            Spectrum::Rgb(color) => color.max(Vec3::ZERO),
            _ => under_daylight(|nm| self.at(nm)).max(Vec3::ZERO),
        }
    }

    /// The colour of a light. A spectrum has luminance 1, whatever its numbers, as pbrt has it; a
    /// colour is itself.
    pub fn light(&self) -> Color {
        match self {
            Spectrum::Rgb(color) | Spectrum::Illuminant(color) => *color,
            _ => {
                let sum = sum(|nm| f64::from(self.at(nm)));
                let color = SRGB * (sum / sum.y);
                if color.is_finite() { color.as_vec3().max(Vec3::ZERO) } else { Vec3::ZERO }
            }
        }
    }

    /// Its numbers as red, green and blue, as pbrt-v3 has them for lights, for what reflects and for
    /// indices alike: a spectrum of 1 has luminance 1. Beyond its ends it stays what it is there,
    /// and a black body has 1 where it is strongest.
    pub fn plain(&self) -> Color {
        match self {
            Spectrum::Rgb(color) | Spectrum::Illuminant(color) => *color,
            Spectrum::Blackbody(kelvin) => {
                // Source: Wien's law.
                let strongest = self.at(2.897_772e6 / kelvin);
                radiance(|nm| self.at(nm) / strongest)
            }
            Spectrum::Curve(curve) => {
                let (Some(first), Some(last)) = (curve.first(), curve.last()) else { return Vec3::ZERO };
                radiance(|nm| self.at(nm.clamp(first[0], last[0])))
            }
        }
    }

    /// The value at a wavelength in nanometres. A colour counts by thirds.
    pub fn at(&self, nm: f32) -> f32 {
        match self {
            Spectrum::Rgb(c) | Spectrum::Illuminant(c) => match nm {
                ..490.0 => c.z,
                490.0..580.0 => c.y,
                _ => c.x,
            },
            // Source: Planck's law, in relation to 560 nm.
            Spectrum::Blackbody(kelvin) => {
                let planck =
                    |nm: f32| 1.0 / (nm * nm * nm * nm * nm * 1e-13 * (fp::exp(1.438_777e7 / (nm * kelvin)) - 1.0));
                let ratio = planck(nm) / planck(560.0);
                if ratio.is_finite() { ratio } else { 0.0 }
            }
            Spectrum::Curve(curve) => {
                let above = curve.partition_point(|row| row[0] < nm);
                match (above.checked_sub(1).map(|i| curve[i]), curve.get(above)) {
                    (Some([a, low]), Some(&[b, high])) => low + (high - low) * (nm - a) / (b - a),
                    (None, Some(&[b, high])) if b == nm => high,
                    // Beyond its ends pbrt's spectrum is 0.
                    _ => 0.0,
                }
            }
        }
    }

    /// The value for one index of refraction: at the yellow line of helium.
    pub fn index(&self) -> f32 {
        self.at(587.6)
    }
}

/// Wavelength of the first row, and from row to row, in nanometres.
const FIRST: f32 = 380.0;
const STEP: f32 = 10.0;

/// How many there are.
const ROWS: u16 = 41;

/// X, Y and Z of light, at any scale.
pub(super) fn sum(light: impl Fn(f32) -> f64) -> DVec3 {
    let row = |i| {
        let nm = FIRST + STEP * f32::from(i);
        let [x, y, z, _] = observer_and_daylight(nm);
        Vec3::new(x, y, z).as_dvec3() * light(nm)
    };
    (0..ROWS).map(row).sum()
}

/// Daylight, at any scale, at a wavelength of a row.
fn daylight(nm: f32) -> f32 {
    observer_and_daylight(nm)[3]
}

/// The colour under daylight of what reflects a share of each wavelength; where all is reflected,
/// it is 1 1 1.
fn under_daylight(share: impl Fn(f32) -> f32) -> Color {
    let lit = |share: &dyn Fn(f32) -> f32| SRGB * sum(|nm| f64::from(share(nm) * daylight(nm)));
    (lit(&share) / lit(&|_| 1.0)).as_vec3()
}

/// The colour of a light by its radiance at each wavelength in nanometres; 1 everywhere has
/// luminance 1.
pub(crate) fn radiance(light: impl Fn(f32) -> f32) -> Color {
    let color = SRGB * sum(|nm| f64::from(light(nm))) / sum(|_| 1.0).y;
    if color.is_finite() { color.as_vec3().max(Vec3::ZERO) } else { Vec3::ZERO }
}

/// What a metal reflects at right angles and at cosine 1/7, seen from within something of an index.
pub(crate) fn metal(eta: &Spectrum, k: &Spectrum, outside: f32) -> [Color; 2] {
    [1.0, 1.0 / 7.0].map(|cosine| match (eta, k) {
        (Spectrum::Rgb(n), Spectrum::Rgb(k)) => {
            Vec3::from_array(std::array::from_fn(|i| conductor(cosine, n[i] / outside, k[i] / outside)))
        }
        _ => under_daylight(|nm| conductor(cosine, eta.at(nm) / outside, k.at(nm) / outside)),
    })
}

/// The share of unpolarised light that a metal of index n + i k reflects.
///
/// Source: Fresnel's equations, as in *Physically Based Rendering*, 4th edition, section 9.3.6.
pub(super) fn conductor(cosine: f32, n: f32, k: f32) -> f32 {
    let (c, n, k) = (f64::from(cosine), f64::from(n), f64::from(k));
    let sine2 = 1.0 - c * c;
    let t = n * n - k * k - sine2;
    let both = (t * t + 4.0 * n * n * k * k).sqrt();
    let a = (0.5 * (both + t)).max(0.0).sqrt();
    let across = (both + c * c - 2.0 * c * a) / (both + c * c + 2.0 * c * a);
    let (sum, twice) = (c * c * both + sine2 * sine2, 2.0 * c * a * sine2);
    let share = 0.5 * across * (1.0 + (sum - twice) / (sum + twice));
    if share.is_finite() { share as f32 } else { 1.0 }
}
