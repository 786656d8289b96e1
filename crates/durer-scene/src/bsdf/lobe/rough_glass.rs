//! Rough glass, in which each facet reflects and refracts light according to Fresnel's equations.
//!
//! Source: Walter and others, *Microfacet Models for Refraction through Rough Surfaces*, EGSR 2007.

use super::glass::refracted;
use super::{LobeKind, LobeSample, NO_SCATTERING, Scatter};
use crate::bsdf::fresnel;
use crate::bsdf::microfacet::Ggx;
use crate::math::{Vec2, Vec3};
use crate::spectrum::Spectrum;

/// Lobe for reflection and refraction by a rough boundary between two dielectrics.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoughGlass {
    /// Distribution of the facet normals.
    pub ggx: Ggx,
    /// Index of refraction behind the boundary, relative to the index in front of it.
    pub eta: f32,
    /// Tint of reflected light.
    pub reflected: Spectrum,
    /// Tint of transmitted light.
    pub transmitted: Spectrum,
}

/// Returns the normal of the facets that scatter `wo` to `wi`, and the Jacobian of the solid angle.
/// Returns `None` if no facet does so.
fn facet(wo: Vec3, wi: Vec3, eta: f32) -> Option<(Vec3, f32)> {
    let passes = wi.z < 0.0;
    let eta = if passes { eta } else { 1.0 };
    let h = (wi * eta + wo).try_normalize()?;
    let h = if h.z < 0.0 { -h } else { h };
    let (to_o, to_i) = (wo.dot(h), wi.dot(h));
    // Facets are visible only from the front.
    if to_o <= 0.0 || (to_i < 0.0) != passes {
        return None;
    }
    let spread = match passes {
        true => {
            let sum = to_i + to_o / eta;
            to_i.abs() / (sum * sum)
        }
        false => 1.0 / (4.0 * to_o),
    };
    Some((h, spread))
}

impl RoughGlass {
    /// Returns the reflectance or transmittance of a facet.
    fn share(&self, passes: bool, cosine: f32) -> f32 {
        let reflected = fresnel::dielectric(cosine, self.eta);
        if passes { 1.0 - reflected } else { reflected }
    }
}

impl Scatter for RoughGlass {
    #[inline]
    fn kind(&self) -> LobeKind {
        LobeKind::GLOSSY.refracting(self.eta)
    }

    fn eval(&self, wo: Vec3, wi: Vec3) -> (Spectrum, f32) {
        let passes = wi.z < 0.0;
        let Some((h, spread)) = facet(wo, wi, self.eta) else { return NO_SCATTERING };
        let (hidden_o, hidden_i) = (self.ggx.lambda(wo), self.ggx.lambda(wi));
        let facets = self.share(passes, wo.dot(h)) * self.ggx.density(h) * wo.dot(h) / wo.z * spread;
        let value = facets / self.ggx.hiding(hidden_o, hidden_i);
        let value = match passes {
            true => self.transmitted * (value / (self.eta * self.eta)),
            false => self.reflected * value,
        };
        (value, facets / self.ggx.sampling_divisor(wo, h, hidden_o))
    }

    fn sample(&self, wo: Vec3, choice: f32, u: Vec2) -> Option<LobeSample> {
        let h = self.ggx.sample_visible(wo, u);
        let wi = match choice < fresnel::dielectric(wo.dot(h).max(0.0), self.eta) {
            true => Some(2.0 * wo.dot(h) * h - wo).filter(|wi| wi.z > 0.0),
            false => refracted(wo, h, self.eta).filter(|wi| wi.z < 0.0),
        }?;
        Some(LobeSample { wi, value: Spectrum::ONE })
    }
}
