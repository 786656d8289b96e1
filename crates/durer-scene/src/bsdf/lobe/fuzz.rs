//! Fuzz, which consists of fibres that stand up from a surface, as on velvet.
//!
//! Source: Estevez and Kulla, *Production Friendly Microfacet Sheen BRDF*, 2017 (the distribution);
//! Neubelt and Pettineo, *Crafting a Next-Gen Material Pipeline for The Order: 1886*, 2013 (the
//! masking).

use super::{LobeKind, LobeSample, NO_SCATTERING, Scatter};
use crate::bsdf::microfacet::fuzz_value;
use crate::bsdf::warp;
use crate::math::{Vec2, Vec3};
use crate::spectrum::Spectrum;
use std::f32::consts::PI;

/// Lobe for a layer of white fibres that stand up from a surface. The directional albedo of the
/// lobe is [`crate::bsdf::albedo::fuzz`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fuzz {
    /// Roughness, from 0 (a thin bright rim) to 1.
    pub roughness: f32,
}

impl Scatter for Fuzz {
    #[inline]
    fn kind(&self) -> LobeKind {
        LobeKind::DIFFUSE
    }

    fn eval(&self, wo: Vec3, wi: Vec3) -> (Spectrum, f32) {
        match wi.z > 0.0 {
            true => (Spectrum::splat(wi.z * fuzz_value(self.roughness, wo, wi)), 1.0 / (2.0 * PI)),
            false => NO_SCATTERING,
        }
    }

    fn sample(&self, _: Vec3, _: f32, u: Vec2) -> Option<LobeSample> {
        Some(LobeSample { wi: warp::polar(u.x, u.y), value: Spectrum::ONE })
    }
}
