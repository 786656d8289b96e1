//! Clear sky and sun of Preetham.
//!
//! Source: Preetham, Shirley and Smits, *A Practical Analytic Model for Daylight*, SIGGRAPH 1999.
//! Luminances are in cd/m^2.

use super::perez::shape;
use super::{angle, raised};
use crate::math::{Color, Vec3, fp};
use crate::spectrum::space::SRGB_FROM_XYZ;
use std::f32::consts::PI;
use std::ops::RangeInclusive;

/// Illuminance of the sun outside the atmosphere, in lux.
const SUN_OUTSIDE: f32 = 128_000.0;

/// Turbidities for which the formulas are used. Others are moved into this range.
pub const TURBIDITIES: RangeInclusive<f32> = 1.7..=10.0;

/// Clear sky and sun for a given position of the sun and a given turbidity of the air.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Preetham {
    /// Unit vector to the sun.
    sun: Vec3,
    /// Turbidity of the air, from 2 (clear) to 10 (hazy).
    turbidity: f32,
    /// Luminance and chromaticity (x, y) at the zenith.
    zenith: Vec3,
    /// Perez's five coefficients for luminance, x and y.
    perez: [[f32; 5]; 3],
    /// Value of Perez's function at the zenith.
    perez_zenith: Vec3,
}

impl Preetham {
    /// Creates a sky. `sun` points to the sun, where y is up. A sun below the horizon is moved to
    /// the horizon.
    pub fn new(sun: Vec3, turbidity: f32) -> Self {
        let sun = raised(sun);
        let t = turbidity.clamp(*TURBIDITIES.start(), *TURBIDITIES.end());
        let theta = angle(sun.y);
        let chi = (4.0 / 9.0 - t / 120.0) * (PI - 2.0 * theta);
        let tan_chi = fp::sin(chi) / fp::cos(chi);
        let bright = 1_000.0 * ((4.0453 * t - 4.9710) * tan_chi - 0.2155 * t + 2.4192);
        let powers = [theta * theta * theta, theta * theta, theta, 1.0];
        let chroma = |rows: [[f32; 4]; 3]| {
            let row = |row: [f32; 4]| row.iter().zip(powers).map(|(a, b)| a * b).sum::<f32>();
            t * t * row(rows[0]) + t * row(rows[1]) + row(rows[2])
        };
        let x = chroma([
            [0.00166, -0.00375, 0.00209, 0.0],
            [-0.02903, 0.06377, -0.03202, 0.00394],
            [0.11693, -0.21196, 0.06052, 0.25886],
        ]);
        let y = chroma([
            [0.00275, -0.00610, 0.00317, 0.0],
            [-0.04214, 0.08970, -0.04153, 0.00516],
            [0.15346, -0.26756, 0.06670, 0.26688],
        ]);
        let line = |rows: [(f32, f32); 5]| rows.map(|(slope, start)| slope * t + start);
        let perez = [
            line([(0.1787, -1.4630), (-0.3554, 0.4275), (-0.0227, 5.3251), (0.1206, -2.5771), (-0.0670, 0.3703)]),
            line([(-0.0193, -0.2592), (-0.0665, 0.0008), (-0.0004, 0.2125), (-0.0641, -0.8989), (-0.0033, 0.0452)]),
            line([(-0.0167, -0.2608), (-0.0950, 0.0092), (-0.0079, 0.2102), (-0.0441, -1.6537), (-0.0109, 0.0529)]),
        ];
        let perez_zenith = Vec3::from(perez.map(|p| shape(&p, 1.0, theta, sun.y)));
        let zenith = Vec3::new(bright.max(0.0), x, y);
        Preetham { sun, turbidity: t, zenith, perez, perez_zenith }
    }

    /// Luminance at the zenith.
    pub fn zenith_luminance(&self) -> f32 {
        self.zenith.x
    }

    /// Radiance that arrives from a unit direction above the horizon.
    pub fn at(&self, dir: Vec3) -> Color {
        let cos_sun = dir.dot(self.sun).clamp(-1.0, 1.0);
        let here = Vec3::from(self.perez.map(|p| shape(&p, dir.y.max(0.01), angle(cos_sun), cos_sun)));
        let Vec3 { x: bright, y: x, z: y } = self.zenith * here / self.perez_zenith;
        rgb_from_yxy(bright.max(0.0), x, y)
    }

    /// Illuminance from the sun in lux, per colour channel, on a surface that faces the sun.
    ///
    /// The light is attenuated by Rayleigh scattering and aerosols, at the wavelengths of red,
    /// green and blue.
    pub fn sun(&self) -> Color {
        let degrees = angle(self.sun.y).to_degrees();
        // Compute the relative air mass after Kasten and Young, 1989.
        let mass = 1.0 / (self.sun.y + 0.50572 * fp::pow(96.07995 - degrees, -1.6364));
        let beta = 0.04608 * self.turbidity - 0.04586;
        let through = |wavelength: f32| {
            fp::exp(-0.008735 * mass * fp::pow(wavelength, -4.08)) * fp::exp(-beta * mass * fp::pow(wavelength, -1.3))
        };
        SUN_OUTSIDE * Vec3::new(through(0.61), through(0.55), through(0.465))
    }
}

/// Converts CIE Yxy to linear Rec.709.
fn rgb_from_yxy(bright: f32, x: f32, y: f32) -> Color {
    let xyz = Vec3::new(bright * x / y, bright, bright * (1.0 - x - y) / y);
    (SRGB_FROM_XYZ.as_mat3() * xyz).max(Vec3::ZERO)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::LUMINANCE;

    fn sky(height: f64, turbidity: f32) -> Preetham {
        let (sin, cos) = fp::sin_cos_degrees(height);
        Preetham::new(Vec3::new(cos as f32, sin as f32, 0.0), turbidity)
    }

    fn brightness(color: Color) -> f32 {
        color.dot(LUMINANCE)
    }

    #[test]
    fn zenith_has_the_published_luminance_and_is_blue() {
        // The values are computed by hand from the paper's formulas, at turbidity 3 with the sun at
        // 45 degrees: chi = (4/9 - 3/120) (pi - pi/2) = 0.6589, Yz = 7.1649 tan chi - 0.6465 +
        // 2.4192 = 7.319 kcd/m^2.
        let sky = sky(45.0, 3.0);
        assert!((brightness(sky.at(Vec3::Y)) / 7_319.0 - 1.0).abs() < 0.005, "{}", brightness(sky.at(Vec3::Y)));
        let zenith = sky.at(Vec3::Y);
        assert!(zenith.z > 1.5 * zenith.x, "blue: {zenith}");
    }

    #[test]
    fn daylight_illuminance_agrees_with_the_paper() {
        // The paper's formulas, integrated over the sky by an independent program, give 31.53 klx
        // on the ground. This is twice the IES value for a clear sky at this altitude h of the sun,
        // which is 0.8 + 15.5 sqrt(sin h). When the sun is high, the formulas give 60 to 110 klx.
        let sky = sky(60.0, 3.0);
        let n = 200;
        let mut horizontal = 0.0;
        for i in 0..n * n {
            let cosine = ((i / n) as f32 + 0.5) / n as f32;
            let (sin, cos) = fp::sin_cos_degrees(360.0 * (f64::from(i % n) + 0.5) / f64::from(n));
            let sine = (1.0 - cosine * cosine).sqrt();
            let dir = Vec3::new(sine * cos as f32, cosine, sine * sin as f32);
            horizontal += f64::from(brightness(sky.at(dir)) * cosine) * 2.0 * std::f64::consts::PI / f64::from(n * n);
        }
        assert!((horizontal / 31_530.0 - 1.0).abs() < 0.01, "{horizontal}");
        let sun = brightness(sky.sun());
        assert!((60_000.0..110_000.0).contains(&sun), "{sun}");
        // A low sun is dimmer and redder.
        let low = self::sky(3.0, 3.0).sun();
        assert!(brightness(low) < 0.3 * sun && low.x > 2.0 * low.z, "{low}");
    }
}
