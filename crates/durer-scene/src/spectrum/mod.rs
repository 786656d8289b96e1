//! Spectra in light transport, represented by four lanes.
//!
//! Along a path, the lanes hold either red, green, blue and green again, where the fourth lane adds
//! no new value, or the radiance at four wavelengths. [`Lanes::reflectance`] and [`Lanes::light`]
//! convert colours to lanes, and [`Lanes::color`] converts lanes back to colours.
//!
//! Tracing four wavelengths on one path is described by Wilkie and others, *Hero Wavelength
//! Spectral Sampling*, EGSR 2014.

pub mod black_body;
pub mod curve;
pub mod illuminants;
mod interference;
mod source;
pub mod space;
mod tables;
#[cfg(test)]
mod tests;
mod upsample;

use crate::describe::{FieldKind, FieldType, Value};
use crate::math::{Color, fp};
pub use curve::Curve;
pub use interference::interference;
use serde::{Deserialize, Serialize};
pub use source::{SpectrumSource, radiance, under_daylight, xyz_sum};
use space::SRGB_FROM_XYZ;
use std::sync::LazyLock;
use tables::{FIRST, LAST, OBSERVER_AND_DAYLIGHT, STEP};

/// Radiance in four lanes, or a factor that scales it.
pub type Spectrum = glam::Vec4;

/// Sum of the lanes. `Vec4::element_sum` would add them in an order that depends on the processor.
pub fn lane_sum(light: Spectrum) -> f32 {
    let [a, b, c, d] = light.to_array();
    (a + b) + (c + d)
}

/// Sum of the products of the lanes, in the same order on every processor.
fn lane_dot(light: Spectrum, other: Spectrum) -> f32 {
    let [a, b, c, d] = (light * other).to_array();
    (a + c) + (b + d)
}

/// Representation of colour in light transport, RGB or spectral, selected by `--color`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ColorMode {
    /// Red, green and blue.
    #[default]
    Rgb,
    /// Four wavelengths on each path.
    Spectral,
}

impl ColorMode {
    /// Names of the colour modes on the command line.
    pub const NAMES: [&'static str; 2] = ["rgb", "spectral"];

    /// Returns the mode with this name, or `None` if the name is unknown.
    pub fn from_name(name: &str) -> Option<Self> {
        [ColorMode::Rgb, ColorMode::Spectral].into_iter().find(|mode| mode.name() == name)
    }

    /// Name of the mode.
    pub fn name(self) -> &'static str {
        Self::NAMES[self as usize]
    }
}

impl FieldType for ColorMode {
    const KIND: FieldKind = FieldKind::Word(&ColorMode::NAMES);

    fn value(&self) -> Option<Value> {
        Some(Value::Word(self.name().into()))
    }

    fn from_value(value: Value) -> Option<Self> {
        let Value::Word(word) = value else { return None };
        ColorMode::from_name(&word)
    }
}

/// Meaning of the four lanes of a [`Spectrum`] along a path: either RGB or four wavelengths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Lanes {
    /// Red, green, blue, and green again.
    #[default]
    Rgb,
    /// Light at four wavelengths.
    Wavelengths(Wavelengths),
}

/// Four wavelengths of a path, with the tabulated spectra at these wavelengths.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Wavelengths {
    /// Wavelengths in nanometres. The first of them is the hero wavelength.
    pub nm: Spectrum,
    /// Spectrum of D65, which is the light with the colour 1 1 1.
    #[serde(skip)]
    white: Spectrum,
    /// Weights of red, green and blue at each wavelength, divided by 4 times its sampling pdf.
    observer: [Spectrum; 3],
}

impl Lanes {
    /// Creates the lanes of a path from a uniform random number in [0, 1).
    pub fn new(mode: ColorMode, u: f32) -> Self {
        match mode {
            ColorMode::Rgb => Lanes::Rgb,
            ColorMode::Spectral => Lanes::Wavelengths(Wavelengths::new(u)),
        }
    }

    /// Reflectance spectrum of a colour.
    pub fn reflectance(&self, color: Color) -> Spectrum {
        match self {
            Lanes::Rgb => color.extend(color.y),
            Lanes::Wavelengths(_) if color.x == color.y && color.y == color.z => Spectrum::splat(color.x),
            Lanes::Wavelengths(waves) => {
                let most = color.max_element().max(1.0);
                most * upsample::reflectance(color / most, waves.nm)
            }
        }
    }

    /// Emission spectrum of a colour of any strength. It is a smooth spectrum multiplied by
    /// daylight.
    pub fn light(&self, color: Color) -> Spectrum {
        match self {
            Lanes::Rgb => color.extend(color.y),
            Lanes::Wavelengths(waves) if color.x == color.y && color.y == color.z => color.x * waves.white,
            Lanes::Wavelengths(waves) => {
                // Spectra are smoother at half the maximum reflectance.
                let most = 2.0 * color.max_element();
                most * waves.white * upsample::reflectance(color / most, waves.nm)
            }
        }
    }

    /// Emission spectrum of a colour, based on its measured spectrum if there is one. `measured` is
    /// called in spectral mode only.
    pub fn light_of<'c>(&self, color: Color, measured: impl FnOnce() -> Option<&'c Curve>) -> Spectrum {
        match self {
            Lanes::Rgb => self.light(color),
            Lanes::Wavelengths(_) => measured().map_or_else(|| self.light(color), |curve| self.measured(color, curve)),
        }
    }

    /// Spectrum of an unbounded value such as an absorption coefficient. The spectrum is smooth,
    /// and constant for grey.
    pub fn coefficient(&self, color: Color) -> Spectrum {
        match self {
            Lanes::Rgb => color.extend(color.y),
            Lanes::Wavelengths(_) => {
                let most = 2.0 * color.max_element();
                if most > 0.0 { most * self.reflectance(color / most) } else { Spectrum::ZERO }
            }
        }
    }

    /// Colour that the light at the end of a path adds to the pixel.
    pub fn color(&self, light: Spectrum) -> Color {
        match self {
            Lanes::Rgb => light.truncate(),
            Lanes::Wavelengths(waves) => Color::from_array(waves.observer.map(|observer| lane_dot(observer, light))),
        }
    }

    /// True if the lanes are red, green and blue.
    pub fn is_rgb(&self) -> bool {
        matches!(self, Lanes::Rgb)
    }

    /// Wavelength of the first lane in nanometres; `None` for RGB lanes.
    pub fn hero(&self) -> Option<f32> {
        match self {
            Lanes::Rgb => None,
            Lanes::Wavelengths(waves) => Some(waves.nm.x),
        }
    }
}

impl Wavelengths {
    /// Weights of red, green and blue at each wavelength.
    pub fn observer(&self) -> &[Spectrum; 3] {
        &self.observer
    }

    /// Samples four wavelengths in proportion to the eye's sensitivity, using four equidistant
    /// random numbers.
    fn new(u: f32) -> Self {
        let nm = Spectrum::from_array([0.0, 0.25, 0.5, 0.75].map(|step| sample_wavelength((u + step).fract())));
        let at = |column: usize| nm.map(|nm| observer_and_daylight(nm)[column]);
        let [x, y, z] = [at(0), at(1), at(2)];
        let weight = 0.25 / nm.map(wavelength_pdf);
        let observer = OBSERVER.to_rgb.map(|[a, b, c]| (a * x + b * y + c * z) * weight);
        Wavelengths { nm, white: OBSERVER.daylight * at(3), observer }
    }
}

/// Maps a random number in [0, 1) to a wavelength in nanometres.
///
/// Source: *Physically Based Rendering*, 4th edition, section 4.5.4, which also describes
/// [`wavelength_pdf`].
fn sample_wavelength(u: f32) -> f32 {
    let x = 0.856_910_6 - 1.827_502 * u;
    // Compute the inverse hyperbolic tangent.
    let atanh = 0.5 * fp::ln((1.0 + x) / (1.0 - x));
    (538.0 - 138.888_89 * atanh).clamp(FIRST, LAST)
}

/// Pdf with which a wavelength is sampled, per nanometre.
fn wavelength_pdf(nm: f32) -> f32 {
    let x = fp::exp(0.0072 * (nm - 538.0));
    let cosh = 0.5 * (x + 1.0 / x);
    0.003_939_804 / (cosh * cosh)
}

/// Values of the CIE 1931 standard observer (x, y, z) and of illuminant D65, at a wavelength in
/// nanometres.
pub fn observer_and_daylight(nm: f32) -> [f32; 4] {
    let place = ((nm - FIRST) / STEP).clamp(0.0, (OBSERVER_AND_DAYLIGHT.len() - 1) as f32);
    let i = (place as usize).min(OBSERVER_AND_DAYLIGHT.len() - 2);
    let [a, b] = [OBSERVER_AND_DAYLIGHT[i], OBSERVER_AND_DAYLIGHT[i + 1]];
    std::array::from_fn(|c| a[c] + (b[c] - a[c]) * (place - i as f32))
}

/// Conversion from XYZ of the CIE standard observer to linear sRGB, scaled so that daylight is
/// white.
struct Observer {
    /// Matrix from x, y, z to red, green and blue.
    to_rgb: [[f32; 3]; 3],
    /// Factor that scales the tabulated daylight.
    daylight: f32,
}

static OBSERVER: LazyLock<Observer> = LazyLock::new(Observer::new);

/// Integrates a function over wavelengths, using Simpson's rule between table rows. The function
/// receives a wavelength in nanometres and the observer's values there. The result is exact for
/// products of two tabulated values.
fn integral(value: impl Fn(f32, [f64; 4]) -> f64) -> f64 {
    let at = |nm: f32| value(nm, observer_and_daylight(nm).map(f64::from));
    let starts = (0..OBSERVER_AND_DAYLIGHT.len() - 1).map(|i| FIRST + STEP * i as f32);
    let simpson = |a: f32| at(a) + 4.0 * at(a + 0.5 * STEP) + at(a + STEP);
    starts.map(simpson).sum::<f64>() * f64::from(STEP) / 6.0
}

impl Observer {
    fn new() -> Self {
        let daylight = 1.0 / integral(|_, [_, y, _, light]| y * light);
        let to_rgb = SRGB_FROM_XYZ.transpose().to_cols_array_2d().map(|[a, b, c]| {
            let white = integral(|_, [x, y, z, light]| (a * x + b * y + c * z) * light) * daylight;
            [a, b, c].map(|entry| (entry / white) as f32)
        });
        Observer { to_rgb, daylight: daylight as f32 }
    }
}
