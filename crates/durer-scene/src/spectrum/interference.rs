//! Colour of interfering light, as a function of the path difference.

use super::tables::{FIRST, LAST};
use super::{OBSERVER, integral};
use crate::math::{Vec2, fp};
use std::f64::consts::TAU;
use std::sync::LazyLock;

/// Step between the entries of the table, in nanometres.
const STEP: f32 = 5.0;

/// Number of entries in the table. The colours vanish at path differences above 16 micrometres.
const ENTRIES: usize = 3_200;

/// Mean of exp(2 pi i s / wavelength) over daylight for a path difference `s` in nanometres,
/// computed for the standard observer's red, green and blue. It is 1 for no path difference, and
/// near 0 for large path differences.
///
/// Source: the sum over interference orders is taken from Belcour and Barla, *A Practical Extension
/// to Microfacet Theory for the Modeling of Varying Iridescence*, SIGGRAPH 2017. They fit Gaussians
/// to the observer, whereas this function uses a table.
pub fn interference(shift: f32) -> [Vec2; 3] {
    static TABLE: LazyLock<Vec<[Vec2; 3]>> = LazyLock::new(|| (0..ENTRIES).map(|i| mean(STEP * i as f32)).collect());
    let place = shift.max(0.0) / STEP;
    let i = place as usize;
    match TABLE.get(i..i + 2) {
        Some(pair) => std::array::from_fn(|c| pair[0][c].lerp(pair[1][c], place - i as f32)),
        None => [Vec2::ZERO; 3],
    }
}

fn mean(shift: f32) -> [Vec2; 3] {
    OBSERVER.to_rgb.map(|row| {
        let [a, b, c] = row.map(f64::from);
        let part = |wave: fn(f64) -> f64| {
            let here = |nm: f32, [x, y, z, light]: [f64; 4]| {
                (a * x + b * y + c * z) * light * wave(TAU * f64::from(shift) / f64::from(nm.clamp(FIRST, LAST)))
            };
            (integral(here) * f64::from(OBSERVER.daylight)) as f32
        };
        Vec2::new(part(|x| fp::sin_cos_f64(x).1), part(|x| fp::sin_cos_f64(x).0))
    })
}
