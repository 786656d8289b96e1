//! Clear sky of Hosek and Wilkie, and their sun.
//!
//! Sources: Hosek and Wilkie, *An Analytic Model for Full Spectral Sky-Dome Radiance*, SIGGRAPH
//! 2012, with their RGB data; *Adding a Solar-Radiance Function to the Hosek-Wilkie Skylight
//! Model*, IEEE Computer Graphics and Applications 33 (3), 2013, with their spectral data.
//! `xtask/src/sky_data.py` writes the data, whose licence is in `hosek.LICENSE`.

use super::{SUN_RADIUS, angle, raised};
use crate::math::{Color, Vec3, fp};
use std::f32::consts::{FRAC_PI_2, PI};
use std::ops::RangeInclusive;

/// Turbidities for which there is data. Others are moved into this range.
pub const TURBIDITIES: RangeInclusive<f32> = 1.0..=10.0;

/// Luminous efficacy that converts the RGB data to cd/m^2, in lumens per watt. The authors
/// integrated the spectrum times the CIE functions.
const EFFICACY: f32 = 683.0;

/// Little-endian numbers in single precision: the sky, then the sun.
static DATA: &[u8] = include_bytes!("hosek.f32");

/// Number of parameters of the sky for each control point and channel, of which the last is the
/// mean radiance.
const PARAMETERS: usize = 10;

/// Number of control points over the elevation of the sun.
const CONTROL_POINTS: usize = 6;

/// Size of the data of the sky for one turbidity, which has two albedos, 0 and 1.
const SKY_SIZE: usize = 2 * CONTROL_POINTS * 3 * PARAMETERS;

/// Number of segments of the elevation, in each of which the radiance of the sun is a cubic
/// polynomial. The cube roots of their limits are equidistant.
const SEGMENTS: usize = 45;

/// Size of the data of the sun for one turbidity.
const SUN_SIZE: usize = SEGMENTS * 3 * 4;

/// Number of turbidities with data, from 1 to 10.
const STEPS: usize = 10;

fn number(i: usize) -> f32 {
    DATA.get(4 * i..4 * i + 4).map_or(0.0, |bytes| f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]))
}

/// Clear sky and sun for a given position of the sun, turbidity of the air and albedo of the
/// ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hosek {
    /// Unit vector to the sun.
    sun: Vec3,
    /// Parameters of the sky for red, green and blue: A to G, I and H of the paper, and the mean
    /// radiance.
    channels: [[f32; PARAMETERS]; 3],
    /// Mean luminance of the sun's disc.
    disc: Color,
}

impl Hosek {
    /// Creates a sky. `sun` points to the sun, where y is up. A sun below the horizon is moved to
    /// the horizon. `albedo` is the fraction of red, green and blue light that the ground reflects,
    /// from 0 to 1.
    pub fn new(sun: Vec3, turbidity: f32, albedo: Color) -> Self {
        let sun = raised(sun);
        let turbidity = turbidity.clamp(*TURBIDITIES.start(), *TURBIDITIES.end());
        let lower = (turbidity as usize).saturating_sub(1).min(STEPS - 2);
        let above = turbidity - (lower + 1) as f32;
        let between = |at: &dyn Fn(usize) -> f32| (1.0 - above) * at(lower) + above * at(lower + 1);
        let elevation = fp::atan2(sun.y, (sun.x * sun.x + sun.z * sun.z).sqrt());
        let x = fp::pow(elevation / FRAC_PI_2, 1.0 / 3.0).min(1.0);
        let weights = bernstein(x);
        let parameter = |channel: usize, i: usize| {
            between(&|step| {
                let curve = |albedo: usize| {
                    let start = step * SKY_SIZE + albedo * SKY_SIZE / 2 + channel * PARAMETERS + i;
                    (0..CONTROL_POINTS).map(|k| weights[k] * number(start + k * 3 * PARAMETERS)).sum::<f32>()
                };
                curve(0) + albedo.clamp(Vec3::ZERO, Vec3::ONE)[channel] * (curve(1) - curve(0))
            })
        };
        let segment = ((x * SEGMENTS as f32) as usize).min(SEGMENTS - 1);
        let limit = segment as f64 / SEGMENTS as f64;
        let distance = f64::from(elevation) - std::f64::consts::FRAC_PI_2 * limit * limit * limit;
        let disc = |channel: usize| {
            between(&|step| {
                let start = STEPS * SKY_SIZE + step * SUN_SIZE + (segment * 3 + channel) * 4;
                (0..4).rev().fold(0.0, |sum, k| sum * distance + f64::from(number(start + k))) as f32
            })
        };
        Hosek {
            sun,
            channels: [0, 1, 2].map(|channel| std::array::from_fn(|i| parameter(channel, i))),
            // A red sun at the horizon is outside the gamut.
            disc: Vec3::from([0, 1, 2].map(disc)).max(Vec3::ZERO),
        }
    }

    /// Radiance that arrives from a unit direction above the horizon.
    pub fn at(&self, dir: Vec3) -> Color {
        let up = dir.y.max(0.0);
        let cos_sun = dir.dot(self.sun).clamp(-1.0, 1.0);
        let to_sun = angle(cos_sun);
        let haze = 1.0 + cos_sun * cos_sun;
        let radiance = self.channels.map(|[a, b, c, d, e, f, g, i, h, mean]| {
            let square = 1.0 + h * h - 2.0 * h * cos_sun;
            let around = c
                + d * fp::exp(e * to_sun)
                + f * cos_sun * cos_sun
                + g * haze / (square * square.sqrt())
                + i * up.sqrt();
            // The paper adds 0.01 to the cosine so that the horizon is finite.
            (1.0 + a * fp::exp(b / (up + 0.01))) * around * mean
        });
        EFFICACY * Vec3::from(radiance).max(Vec3::ZERO)
    }

    /// Illuminance from the sun in lux, per colour channel, on a surface that faces the sun: the
    /// mean luminance of the disc times the solid angle of the sun.
    pub fn sun(&self) -> Color {
        let (_, cos) = fp::sin_cos_degrees(f64::from(SUN_RADIUS));
        2.0 * PI * (1.0 - cos) as f32 * self.disc
    }
}

/// Bernstein polynomials of degree 5, from 0 to 1.
fn bernstein(x: f32) -> [f32; CONTROL_POINTS] {
    let y = 1.0 - x;
    let (x2, y2) = (x * x, y * y);
    [y2 * y2 * y, 5.0 * x * y2 * y2, 10.0 * x2 * y2 * y, 10.0 * x2 * x * y2, 5.0 * x2 * x2 * y, x2 * x2 * x]
}
