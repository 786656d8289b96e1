//! Measured spectra, stored as values at given wavelengths.

use super::{Lanes, OBSERVER, Spectrum, integral};
use crate::math::Color;

/// Measured spectrum as a function of wavelength: the reflectance of a surface or the emission of a
/// light.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Pairs of a wavelength in nanometres and a value, in ascending order of wavelength.
    rows: Vec<[f32; 2]>,
    /// Colour of the curve in linear sRGB, without negative values.
    color: Color,
}

impl Curve {
    /// Creates a reflectance from rows in ascending order of wavelength. Its colour is computed
    /// under daylight. Returns `None` if there are no rows.
    pub fn reflectance(rows: Vec<[f32; 2]>) -> Option<Self> {
        rows.first()?;
        let color = observed_color(&rows, |[_, _, _, light]| f64::from(OBSERVER.daylight) * light);
        Some(Curve { rows, color })
    }

    /// Creates the emission spectrum of a light from values on any scale, and scales it to
    /// luminance 1. Returns `None` if there is no visible light, or if the visible part is so small
    /// that scaling overflows `f32`.
    pub fn light(mut rows: Vec<[f32; 2]>) -> Option<Self> {
        let bright = integral(|nm, [_, y, _, _]| y * f64::from(at(&rows, nm))) as f32;
        rows.iter_mut().for_each(|row| row[1] /= bright);
        let color = observed_color(&rows, |_| 1.0);
        let in_range = color.is_finite() && rows.iter().all(|row| row[1].is_finite());
        (bright > 0.0 && bright.is_finite() && in_range).then_some(Curve { rows, color })
    }

    /// Colour of the curve. For a reflectance, it is the colour under daylight. For an emission, it
    /// is the colour at luminance 1.
    pub fn color(&self) -> Color {
        self.color
    }

    /// Value at a wavelength in nanometres. It is constant before the first row and after the last
    /// row.
    pub fn at(&self, nm: f32) -> f32 {
        at(&self.rows, nm)
    }
}

impl Lanes {
    /// Spectrum with the colour `color` and the shape of a measured reflectance or emission. It is
    /// the curve multiplied by the ratio of `color` to the curve's own colour.
    pub fn measured(&self, color: Color, curve: &Curve) -> Spectrum {
        let Lanes::Wavelengths(waves) = self else { return color.extend(color.y) };
        let known = curve.color.cmpgt(Color::splat(1e-6));
        let ratio = Color::select(known, color / curve.color, Color::ZERO);
        // For a channel that the curve lacks, use the largest factor of the other channels.
        let ratio = Color::select(known, ratio, Color::splat(ratio.max_element()));
        // Prevent rounding errors from tinting grey.
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

/// Colour that the standard observer sees for a curve multiplied by a light.
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
