//! The sixteen CIE standard skies, for daylight calculations in architecture.
//!
//! Source: CIE S 011/E:2003 (ISO 15469:2004), *Spatial distribution of daylight: CIE standard
//! general sky*.

use crate::math::{Color, Vec3, fp};
use std::f32::consts::PI;

/// Coefficients of the sky types 1 to 15: a, b (gradation from horizon to zenith) and c, d, e
/// (indicatrix around the sun).
const TYPES: [[f32; 5]; 15] = [
    [4.0, -0.70, 0.0, -1.0, 0.0],
    [4.0, -0.70, 2.0, -1.5, 0.15],
    [1.1, -0.8, 0.0, -1.0, 0.0],
    [1.1, -0.8, 2.0, -1.5, 0.15],
    [0.0, -1.0, 0.0, -1.0, 0.0],
    [0.0, -1.0, 2.0, -1.5, 0.15],
    [0.0, -1.0, 5.0, -2.5, 0.30],
    [0.0, -1.0, 10.0, -3.0, 0.45],
    [-1.0, -0.55, 2.0, -1.5, 0.15],
    [-1.0, -0.55, 5.0, -2.5, 0.30],
    [-1.0, -0.55, 10.0, -3.0, 0.45],
    [-1.0, -0.32, 10.0, -3.0, 0.45],
    [-1.0, -0.32, 16.0, -3.0, 0.30],
    [-1.0, -0.15, 16.0, -3.0, 0.30],
    [-1.0, -0.15, 24.0, -2.8, 0.15],
];

/// Type number of the traditional overcast sky, which is three times as bright at the zenith as at
/// the horizon.
pub const OVERCAST: u32 = 16;

/// CIE standard sky, which gives the luminance of an overcast, partly cloudy or clear sky in each
/// direction. Its colour is white.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CieSky {
    /// Coefficients of a sky of type 1 to 15; `None` for type 16.
    coefficients: Option<[f32; 5]>,
    /// Unit vector to the sun. The direct light of the sun is not included.
    sun: Vec3,
    /// Factor that converts relative luminance to cd/m^2.
    scale: f32,
    /// Luminance of the directions below the horizon, in cd/m^2.
    ground: f32,
}

impl CieSky {
    /// Creates a sky of type `number`, from 1 to 16. `sun` points to the sun, with y up. `zenith`
    /// is the luminance at the zenith in cd/m^2. The ground reflects the fraction
    /// `ground_reflectance` of its illuminance.
    pub fn new(number: u32, sun: Vec3, zenith: f32, ground_reflectance: f32) -> Self {
        let coefficients = TYPES.get((number as usize).wrapping_sub(1)).copied();
        let sun = Vec3::new(sun.x, sun.y.max(0.0), sun.z).normalize_or(Vec3::Y);
        let unit = CieSky { coefficients, sun, scale: 1.0, ground: 0.0 };
        let sky = CieSky { scale: zenith / unit.relative_luminance(Vec3::Y), ..unit };
        CieSky { ground: ground_reflectance * sky.illuminance() / PI, ..sky }
    }

    /// True if skies of this type depend on the position of the sun.
    pub fn depends_on_sun(number: u32) -> bool {
        TYPES.get((number as usize).wrapping_sub(1)).is_some_and(|numbers| numbers[2] != 0.0)
    }

    fn relative_luminance(&self, dir: Vec3) -> f32 {
        let height = dir.y.clamp(0.0, 1.0);
        let Some([a, b, c, d, e]) = self.coefficients else { return (1.0 + 2.0 * height) / 3.0 };
        let zenith = 1.0 + a * fp::exp(b / height.max(1e-3));
        let cosine = dir.dot(self.sun).clamp(-1.0, 1.0);
        let to_sun = fp::atan2((1.0 - cosine * cosine).sqrt(), cosine);
        zenith * (1.0 + c * (fp::exp(d * to_sun) - fp::exp(d * 0.5 * PI)) + e * cosine * cosine)
    }

    /// Luminance that arrives from a unit direction, in cd/m^2.
    pub fn luminance(&self, dir: Vec3) -> f32 {
        if dir.y < 0.0 { self.ground } else { self.scale * self.relative_luminance(dir) }
    }

    /// Radiance that arrives from a unit direction.
    pub fn at(&self, dir: Vec3) -> Color {
        Vec3::splat(self.luminance(dir))
    }

    /// Illuminance on unobstructed ground, in lux.
    pub fn illuminance(&self) -> f32 {
        const STEPS: u32 = 256;
        let cell = |i: u32| {
            // Each ring of the projected hemisphere is divided into cells of equal area.
            let radius = ((i / STEPS) as f32 + 0.5) / STEPS as f32;
            let (sin, cos) = fp::sin_cos_degrees(360.0 * (f64::from(i % STEPS) + 0.5) / f64::from(STEPS));
            let dir = Vec3::new(radius * cos as f32, (1.0 - radius * radius).sqrt(), radius * sin as f32);
            f64::from(radius * self.luminance(dir))
        };
        let mean = (0..STEPS * STEPS).map(cell).sum::<f64>() / f64::from(STEPS * STEPS);
        2.0 * PI * mean as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn illuminance_agrees_with_formulas() {
        // An overcast sky with the zenith luminance L has an illuminance of 7 pi L / 9 (Moon and
        // Spencer, 1942). A uniform sky has an illuminance of pi L.
        let overcast = CieSky::new(OVERCAST, Vec3::Y, 9_000.0, 0.0);
        assert!((overcast.illuminance() / (7_000.0 * PI) - 1.0).abs() < 1e-4, "{}", overcast.illuminance());
        let even = CieSky::new(5, Vec3::Y, 9_000.0, 0.2);
        assert!((even.illuminance() / (9_000.0 * PI) - 1.0).abs() < 1e-4);
        // Under a uniform sky, the ground looks like a diffuse surface with the given reflectance.
        assert!((even.luminance(Vec3::NEG_Y) - 1_800.0).abs() < 1.0);
    }

    #[test]
    fn zenith_has_its_luminance_and_the_side_of_the_sun_is_brightest() {
        let sun = Vec3::new(1.0, 1.0, 0.0).normalize();
        for number in 1..=16 {
            let sky = CieSky::new(number, sun, 5_000.0, 0.2);
            assert!((sky.luminance(Vec3::Y) - 5_000.0).abs() < 1.0, "{number}");
            let (there, away) = (sky.luminance(sun), sky.luminance(Vec3::new(-sun.x, sun.y, 0.0)));
            assert_eq!(there > away, CieSky::depends_on_sun(number), "{number}: {there} {away}");
        }
        // The expected value is computed by hand from the formula for type 12, the standard clear
        // sky, at the horizon below the sun.
        let sky = CieSky::new(12, sun, 1.0, 0.0);
        // The difference exp(-3 pi / 4) - exp(-3 pi / 2) is 0.09478 - 0.00898. At the zenith, the
        // angle to the sun is also 45 degrees.
        let (ring, zenith) = (1.0 + 10.0 * (0.09478 - 0.00898) + 0.45 * 0.5, 1.0 - 0.72615);
        let at_horizon = ring / (ring * zenith);
        assert!((sky.luminance(Vec3::X) / at_horizon - 1.0).abs() < 1e-3, "{} {at_horizon}", sky.luminance(Vec3::X));
    }
}
