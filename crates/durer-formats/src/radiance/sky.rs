//! Skies in the form that `gensky` and `gendaylit` write.
//!
//! Source: *Standardization of Luminance Distribution on Clear Skies*, CIE publication 22, 1973;
//! Nakamura, Oki and Hayashi, *Luminance distribution of intermediate sky*, 1985; Perez, Seals and
//! Michalsky, *All-weather model for sky luminance distribution*, Solar Energy 50, 1993. The order
//! of the arguments, which Radiance passes to its `skybright.cal` and `perezlum.cal`, is documented
//! in the manual pages of gensky and gendaylit.

use super::args::RadPrimitive;
use crate::shared_report::SharedReport;
use durer_scene::math::fp;
use durer_scene::texture::sky::perez::shape;
use glam::{DMat3, DVec3};
use std::f32::consts::FRAC_PI_2;

/// Sky above a ground. The radiance of the sky in each direction is given by a CIE or Perez
/// formula.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Sky {
    kind: SkyKind,
    zenith: f32,
    ground: f32,
    factor: f32,
    sun: DVec3,
    /// Rotation from world space to the axes of the sky.
    to_sky: DMat3,
}

/// Type of a sky, which determines the formula for its radiance.
#[derive(Clone, Copy, Debug, PartialEq)]
enum SkyKind {
    Clear,
    Overcast,
    Uniform,
    Intermediate,
    /// Perez sky with its five coefficients.
    Perez([f32; 5]),
}

impl Sky {
    /// Creates a CIE sky from its arguments, which are the type, the zenith, the ground, a factor,
    /// and the direction to the sun. `transform` is a similarity transform from the axes of the sky
    /// to world space.
    pub fn of(primitive: &RadPrimitive, transform: DMat3, report: &SharedReport) -> Option<Sky> {
        let number = |i: usize| primitive.number(i).unwrap_or(0.0);
        let kind = match number(0).round() as i32 {
            1 => SkyKind::Clear,
            2 => SkyKind::Overcast,
            3 => SkyKind::Uniform,
            4 => SkyKind::Intermediate,
            _ => {
                report.error(
                    primitive.at(),
                    "the first number of a sky must be 1 (clear), 2 (overcast), 3 (uniform) or 4 (intermediate)",
                );
                return None;
            }
        };
        if !primitive.has(&[3, 4, 7], report) {
            return None;
        }
        let sun = primitive.point(4).normalize_or_zero();
        if matches!(kind, SkyKind::Clear | SkyKind::Intermediate) && (sun == DVec3::ZERO || number(3) <= 0.0) {
            report.error(primitive.at(), "a sky with a sun needs a factor above 0 and the direction to the sun");
            return None;
        }
        let factor = if number(3) > 0.0 { number(3) } else { 1.0 };
        let to_sky = transform.inverse() * transform.x_axis.length();
        Some(Sky { kind, zenith: number(1).max(0.0), ground: number(2).max(0.0), factor, sun, to_sky })
    }

    /// Creates a Perez sky from its arguments, which are the brightness, the ground, five
    /// coefficients, and the direction to the sun. `transform` is a similarity transform from the
    /// axes of the sky to world space.
    pub fn perez(primitive: &RadPrimitive, transform: DMat3, report: &SharedReport) -> Option<Sky> {
        if !primitive.has(&[10], report) {
            return None;
        }
        let number = |i: usize| primitive.number(i).unwrap_or(0.0);
        let kind = SkyKind::Perez(std::array::from_fn(|i| number(2 + i)));
        let to_sky = transform.inverse() * transform.x_axis.length();
        let (zenith, ground) = (number(0).max(0.0), number(1).max(0.0));
        Some(Sky { kind, zenith, ground, factor: 1.0, sun: primitive.point(7).normalize_or_zero(), to_sky })
    }

    /// Returns true if neither the sky nor the ground emits light.
    pub fn is_black(&self) -> bool {
        self.zenith == 0.0 && self.ground == 0.0
    }

    /// Returns the radiance in a unit direction in world space.
    pub fn at(&self, dir: DVec3) -> f32 {
        let dir = self.to_sky * dir;
        let height = (dir.z as f32).clamp(-1.0, 1.0);
        // Blend the sky into the ground within about ten degrees of the horizon.
        let above = fp::pow(height + 1.01, 10.0);
        let below = 1.0 / above;
        ((self.without_ground(dir, height) * above + self.ground * below) / (above + below)).max(0.0)
    }

    /// Returns the radiance of the sky without the ground. The formulas are also defined below the
    /// horizon.
    fn without_ground(&self, dir: DVec3, height: f32) -> f32 {
        let cosine = (dir.dot(self.sun) as f32).clamp(-1.0, 1.0);
        let angle = fp::atan2((1.0 - cosine * cosine).sqrt(), cosine);
        match self.kind {
            SkyKind::Uniform => self.zenith,
            SkyKind::Overcast => self.zenith * (1.0 + 2.0 * height) / 3.0,
            SkyKind::Clear => {
                let haze = if height > 0.01 { 1.0 - fp::exp(-0.32 / height) } else { 1.0 };
                self.zenith / self.factor * (0.91 + 10.0 * fp::exp(-3.0 * angle) + 0.45 * cosine * cosine) * haze
            }
            SkyKind::Perez(coefficients) => self.zenith * shape(&coefficients, height.max(0.01), angle, cosine),
            SkyKind::Intermediate => {
                // Angle between the direction and the zenith.
                let eta = FRAC_PI_2 - fp::asin(height);
                let sun = (self.sun.z as f32).clamp(-1.0, 1.0);
                let zenith_angle = fp::atan2((1.0 - sun * sun).sqrt(), sun);
                let shape =
                    (1.35 * fp::sin(5.631 - 3.59 * eta) + 3.12) * fp::sin(4.396 - 2.6 * zenith_angle) + 6.37 - eta;
                let fall = fp::exp(angle * -0.563 * ((2.629 - eta) * (1.562 - zenith_angle) + 0.812));
                self.zenith / self.factor * shape / 2.326 * fall
            }
        }
    }
}
