//! Measured spectra: values by wavelength.

use super::{Lanes, OBSERVER, Spectrum, integral};
use crate::math::Color;

/// Measured spectrum, by wavelength: the reflectance of a surface or the emission of a light.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Ascending wavelengths in nanometres, and values.
    rows: Vec<[f32; 2]>,
    /// Colour of the curve in linear sRGB, without negative values.
    color: Color,
}

impl Curve {
    /// Creates a reflectance from rows of ascending wavelength. Its colour is that under daylight.
    /// `None` if there are no rows.
    pub fn reflectance(rows: Vec<[f32; 2]>) -> Option<Self> {
        rows.first()?;
        let color = observed_color(&rows, |[_, _, _, light]| f64::from(OBSERVER.daylight) * light);
        Some(Curve { rows, color })
    }

    /// Creates the emission of a light of any strength, scaled to luminance 1. `None` if there is
    /// no visible light, or if the visible part is so small that scaling overflows `f32`.
    pub fn light(mut rows: Vec<[f32; 2]>) -> Option<Self> {
        let bright = integral(|nm, [_, y, _, _]| y * f64::from(at(&rows, nm))) as f32;
        rows.iter_mut().for_each(|row| row[1] /= bright);
        let color = observed_color(&rows, |_| 1.0);
        let in_range = color.is_finite() && rows.iter().all(|row| row[1].is_finite());
        (bright > 0.0 && bright.is_finite() && in_range).then_some(Curve { rows, color })
    }

    /// Colour of the curve: for a reflectance under daylight, for an emission at luminance 1.
    pub fn color(&self) -> Color {
        self.color
    }

    /// Value at a wavelength in nanometres; constant beyond the first and last row.
    pub fn at(&self, nm: f32) -> f32 {
        at(&self.rows, nm)
    }
}

impl Lanes {
    /// Spectrum of a measured reflectance or emission that appears as `color`: the curve, times the
    /// factor from its own colour to `color`.
    pub fn measured(&self, color: Color, curve: &Curve) -> Spectrum {
        let Lanes::Wavelengths(waves) = self else { return color.extend(color.y) };
        let known = curve.color.cmpgt(Color::splat(1e-6));
        let ratio = Color::select(known, color / curve.color, Color::ZERO);
        // Use the largest factor of the others for a channel that the curve lacks.
        let ratio = Color::select(known, ratio, Color::splat(ratio.max_element()));
        // Keep rounding from tinting grey.
        let even = ratio.max_element() - ratio.min_element() <= 1e-5 * ratio.max_element();
        let tint = if even { Spectrum::splat(ratio.max_element()) } else { self.coefficient(ratio) };
        tint * waves.nm.map(|nm| curve.at(nm))
    }
}

fn at(rows: &[[f32; 2]], nm: f32) -> f32 {
    let next = rows.partition_point(|row| row[0] <= nm);
    match (next.checked_sub(1).map(|i| rows[i]), rows.get(next)) {
        (Some([a, low]), Some(&[b, high])) => low + (high - low) * ((nm - a) / (b - a)),
        (Some(row), None) => row[1],
        (None, Some(row)) => row[1],
        (None, None) => 0.0,
    }
}

/// Colour of a curve times a light, for the standard observer.
fn observed_color(rows: &[[f32; 2]], light: impl Fn([f64; 4]) -> f64) -> Color {
    let channel = |[a, b, c]: [f32; 3]| {
        let [a, b, c] = [a, b, c].map(f64::from);
        integral(|nm, here| {
            let [x, y, z, _] = here;
            (a * x + b * y + c * z) * f64::from(at(rows, nm)) * light(here)
        })
    };
    Color::from(OBSERVER.to_rgb.map(|row| channel(row) as f32)).max(Color::ZERO)
}
