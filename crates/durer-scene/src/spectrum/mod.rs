//! What light is while it is transported: four numbers at once.
//!
//! Along one path they are red, green, blue (and green again, so that the fourth lane adds nothing
//! of its own), or the light at four wavelengths. Colours enter through [`Lanes::reflectance`] and
//! [`Lanes::light`], and leave through [`Lanes::color`].
//!
//! Source of four wavelengths on one path: Wilkie and others, *Hero Wavelength Spectral Sampling*,
//! EGSR 2014.

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

use crate::describe::{FieldType, Kind, Value};
use crate::math::{Color, fp};
pub use curve::Curve;
pub use interference::interference;
use serde::{Deserialize, Serialize};
pub use source::{SpectrumSource, radiance, under_daylight, xyz_sum};
use space::SRGB_FROM_XYZ;
use std::sync::LazyLock;
use tables::{FIRST, LAST, OBSERVER_AND_DAYLIGHT, STEP};

/// Light, or what scatters it, in four lanes.
pub type Spectrum = glam::Vec4;

/// What colours are while light is transported.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ColorMode {
    /// Red, green and blue.
    #[default]
    Rgb,
    /// Wavelengths, four on each path.
    Spectral,
}

impl ColorMode {
    /// Names on the command line.
    pub const NAMES: [&'static str; 2] = ["rgb", "spectral"];

    /// The mode of a name.
    pub fn from_name(name: &str) -> Option<Self> {
        [ColorMode::Rgb, ColorMode::Spectral].into_iter().find(|mode| mode.name() == name)
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        Self::NAMES[self as usize]
    }
}

impl FieldType for ColorMode {
    const KIND: Kind = Kind::Word(&ColorMode::NAMES);

    fn value(&self) -> Option<Value> {
        Some(Value::Word(self.name().into()))
    }

    fn from_value(value: Value) -> Option<Self> {
        let Value::Word(word) = value else { return None };
        ColorMode::from_name(&word)
    }
}

/// What the four lanes of one path mean.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Lanes {
    /// Red, green, blue, green.
    #[default]
    Rgb,
    /// Light at four wavelengths.
    Waves(Waves),
}

/// Four wavelengths, and what is known there.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Waves {
    /// The wavelengths in nanometres; the first is the hero.
    pub nm: Spectrum,
    /// The light whose colour is white, 1 1 1: D65.
    #[serde(skip)]
    white: Spectrum,
    /// What red, green and blue take of each wavelength, over 4 times its density.
    observer: [Spectrum; 3],
}

impl Lanes {
    /// For one path, by a number from 0 to 1.
    pub fn new(mode: ColorMode, u: f32) -> Self {
        match mode {
            ColorMode::Rgb => Lanes::Rgb,
            ColorMode::Spectral => Lanes::Waves(Waves::new(u)),
        }
    }

    /// The share of light that a thing of a colour gives back.
    pub fn reflectance(&self, color: Color) -> Spectrum {
        match self {
            Lanes::Rgb => color.extend(color.y),
            Lanes::Waves(_) if color.x == color.y && color.y == color.z => Spectrum::splat(color.x),
            Lanes::Waves(waves) => {
                let most = color.max_element().max(1.0);
                most * upsample::share(color / most, waves.nm)
            }
        }
    }

    /// Light of a colour, of any strength: a smooth spectrum times daylight's.
    pub fn light(&self, color: Color) -> Spectrum {
        match self {
            Lanes::Rgb => color.extend(color.y),
            Lanes::Waves(waves) if color.x == color.y && color.y == color.z => color.x * waves.white,
            Lanes::Waves(waves) => {
                // At half of what can be reflected, spectra are smoother.
                let most = 2.0 * color.max_element();
                most * waves.white * upsample::share(color / most, waves.nm)
            }
        }
    }

    /// Light of a colour: with the spectrum that was measured, or a smooth one. The former is asked
    /// for only by what has wavelengths.
    pub fn light_of<'c>(&self, color: Color, measured: impl FnOnce() -> Option<&'c Curve>) -> Spectrum {
        match self {
            Lanes::Rgb => self.light(color),
            Lanes::Waves(_) => measured().map_or_else(|| self.light(color), |curve| self.measured(color, curve)),
        }
    }

    /// What something without bounds is, such as how much a medium absorbs: smooth, and grey where
    /// the colour is.
    pub fn coefficient(&self, color: Color) -> Spectrum {
        match self {
            Lanes::Rgb => color.extend(color.y),
            Lanes::Waves(_) => {
                let most = 2.0 * color.max_element();
                if most > 0.0 { most * self.reflectance(color / most) } else { Spectrum::ZERO }
            }
        }
    }

    /// The colour of light: what the path adds to the pixel.
    pub fn color(&self, light: Spectrum) -> Color {
        match self {
            Lanes::Rgb => light.truncate(),
            Lanes::Waves(waves) => Color::from_array(waves.observer.map(|observer| observer.dot(light))),
        }
    }

    /// Whether they are colours.
    pub fn is_rgb(&self) -> bool {
        matches!(self, Lanes::Rgb)
    }

    /// The wavelength of the first lane in nanometres; `None` for colours.
    pub fn hero(&self) -> Option<f32> {
        match self {
            Lanes::Rgb => None,
            Lanes::Waves(waves) => Some(waves.nm.x),
        }
    }
}

impl Waves {
    /// What red, green and blue take of each wavelength.
    pub fn observer(&self) -> &[Spectrum; 3] {
        &self.observer
    }

    /// Wavelengths chosen about as often as the eye needs them, at equal steps of the number they
    /// are chosen by.
    fn new(u: f32) -> Self {
        let nm = Spectrum::from_array([0.0, 0.25, 0.5, 0.75].map(|step| wavelength((u + step).fract())));
        let at = |column: usize| nm.map(|nm| observer_and_daylight(nm)[column]);
        let [x, y, z] = [at(0), at(1), at(2)];
        let weight = 0.25 / nm.map(density);
        let observer = OBSERVER.to_rgb.map(|[a, b, c]| (a * x + b * y + c * z) * weight);
        Waves { nm, white: OBSERVER.daylight * at(3), observer }
    }
}

/// A wavelength by a number from 0 to 1.
///
/// Source: *Physically Based Rendering*, 4th edition, section 4.5.4, as for the density.
fn wavelength(u: f32) -> f32 {
    let x = 0.856_910_6 - 1.827_502 * u;
    // The inverse hyperbolic tangent.
    let atanh = 0.5 * fp::ln((1.0 + x) / (1.0 - x));
    (538.0 - 138.888_89 * atanh).clamp(FIRST, LAST)
}

/// The density with which wavelengths are chosen, per nanometre.
fn density(nm: f32) -> f32 {
    let x = fp::exp(0.0072 * (nm - 538.0));
    let cosh = 0.5 * (x + 1.0 / x);
    0.003_939_804 / (cosh * cosh)
}

/// What the CIE's standard observer of 1931 sees at a wavelength in nanometres, x, y and z, and the
/// illuminant D65 there.
pub fn observer_and_daylight(nm: f32) -> [f32; 4] {
    let place = ((nm - FIRST) / STEP).clamp(0.0, (OBSERVER_AND_DAYLIGHT.len() - 1) as f32);
    let i = (place as usize).min(OBSERVER_AND_DAYLIGHT.len() - 2);
    let [a, b] = [OBSERVER_AND_DAYLIGHT[i], OBSERVER_AND_DAYLIGHT[i + 1]];
    std::array::from_fn(|c| a[c] + (b[c] - a[c]) * (place - i as f32))
}

/// How an observer's numbers become colours, such that daylight is white.
struct Observer {
    /// From x, y, z to red, green and blue.
    to_rgb: [[f32; 3]; 3],
    /// What daylight's numbers are multiplied by.
    daylight: f32,
}

static OBSERVER: LazyLock<Observer> = LazyLock::new(Observer::new);

/// The integral over wavelengths of a function of nanometres and of the observer's row, by
/// Simpson's rule between rows: exact for products of two of its numbers.
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
