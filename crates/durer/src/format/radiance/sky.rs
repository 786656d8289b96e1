//! Skies that `gensky` writes.
//!
//! Source: *Standardization of Luminance Distribution on Clear Skies*, CIE publication 22, 1973;
//! Nakamura, Oki and Hayashi, *Luminance distribution of intermediate sky*, 1985; the manual page
//! of gensky for the order of the numbers.

use super::args::Thing;
use crate::format::said::Said;
use crate::math::fp;
use glam::DVec3;

/// A sky over a ground.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Sky {
    kind: Cover,
    zenith: f32,
    ground: f32,
    factor: f32,
    sun: DVec3,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Cover {
    Clear,
    Overcast,
    Uniform,
    Intermediate,
}

impl Sky {
    /// By its numbers: kind, zenith, ground, factor, way to the sun.
    pub fn of(thing: &Thing, said: &Said) -> Option<Sky> {
        let number = |i: usize| thing.number(i).unwrap_or(0.0);
        let kind = match number(0).round() as i32 {
            1 => Cover::Clear,
            2 => Cover::Overcast,
            3 => Cover::Uniform,
            4 => Cover::Intermediate,
            _ => {
                said.bad(
                    thing.at(),
                    "the first number of a sky is 1 (clear), 2 (overcast), 3 (uniform) or 4 (intermediate)",
                );
                return None;
            }
        };
        if !thing.has(&[3, 4, 7], said) {
            return None;
        }
        let sun = thing.point(4).normalize_or_zero();
        if matches!(kind, Cover::Clear | Cover::Intermediate) && (sun == DVec3::ZERO || number(3) <= 0.0) {
            said.bad(thing.at(), "a sky with a sun needs a factor above 0 and the way to the sun");
            return None;
        }
        let factor = if number(3) > 0.0 { number(3) } else { 1.0 };
        Some(Sky { kind, zenith: number(1).max(0.0), ground: number(2).max(0.0), factor, sun })
    }

    /// How bright it is in a unit direction, z upwards.
    pub fn at(&self, dir: DVec3) -> f32 {
        let height = (dir.z as f32).clamp(-1.0, 1.0);
        // From the sky to the ground within half a degree of the horizon.
        let above = fp::pow(height + 1.01, 10.0);
        let below = 1.0 / above;
        let sky = if height > -0.05 { self.bare(dir, height.max(0.0)) } else { 0.0 };
        ((sky * above + self.ground * below) / (above + below)).max(0.0)
    }

    fn bare(&self, dir: DVec3, height: f32) -> f32 {
        let cosine = (dir.dot(self.sun) as f32).clamp(-1.0, 1.0);
        let angle = fp::atan2((1.0 - cosine * cosine).sqrt(), cosine);
        match self.kind {
            Cover::Uniform => self.zenith,
            Cover::Overcast => self.zenith * (1.0 + 2.0 * height) / 3.0,
            Cover::Clear => {
                let haze = if height > 0.01 { 1.0 - fp::exp(-0.32 / height) } else { 1.0 };
                self.zenith / self.factor * (0.91 + 10.0 * fp::exp(-3.0 * angle) + 0.45 * cosine * cosine) * haze
            }
            Cover::Intermediate => {
                let eta = fp::asin(height);
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
