//! Blinn and Phong highlights, as in the course.

use super::{LobeKind, LobeSample, NO_SCATTERING, Scatter};
use crate::bsdf::warp;
use crate::math::{Vec2, Vec3, fp, reflect};
use crate::spectrum::Spectrum;
use std::f32::consts::FRAC_1_PI;

/// Blinn or Phong highlight with the value color · base^exponent / pi, where the base is N·H
/// (Blinn) or R·L (Phong).
///
/// The formula in the course has no cosine factor, so it would reflect more light than arrives.
/// This lobe adds the factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blinn {
    /// Strength of the highlight in each lane.
    pub color: Spectrum,
    /// Exponent of the highlight. A higher value gives a smaller and sharper highlight.
    pub exponent: f32,
    /// True if the base is R·L (Phong), false if it is N·H (Blinn).
    pub phong: bool,
}

impl Blinn {
    /// Returns an upper bound of the albedo of a highlight of strength 1, for all directions.
    pub fn bound(exponent: f32) -> f32 {
        (8.0 / (exponent + 1.0)).min(1.0)
    }
}

impl Scatter for Blinn {
    #[inline]
    fn kind(&self) -> LobeKind {
        LobeKind::GLOSSY
    }

    fn eval(&self, wo: Vec3, wi: Vec3) -> (Spectrum, f32) {
        let half = (wo + wi).normalize_or_zero();
        // `base` is the base of the power, and `spread` is the Jacobian from the sampled vector to
        // `wi`.
        let (base, spread) = match self.phong {
            true => (reflect(-wo, Vec3::Z).dot(wi), 1.0),
            false => (half.z, 4.0 * wo.dot(half)),
        };
        if wi.z <= 0.0 || base <= 0.0 {
            return NO_SCATTERING;
        }
        let power = FRAC_1_PI * fp::pow(base, self.exponent);
        let density = if spread > 0.0 { 0.5 * (self.exponent + 1.0) * power / spread } else { 0.0 };
        (self.color * (wi.z * power), density)
    }

    fn sample(&self, wo: Vec3, _: f32, u: Vec2) -> Option<LobeSample> {
        let about = warp::polar(fp::pow(u.x, 1.0 / (self.exponent + 1.0)), u.y);
        let wi = match self.phong {
            true => crate::bsdf::Frame::around(reflect(-wo, Vec3::Z)).to_world(about),
            false => 2.0 * wo.dot(about) * about - wo,
        };
        (wi.z > 0.0).then_some(LobeSample { wi, value: Spectrum::ONE })
    }
}
