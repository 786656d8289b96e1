//! Diffuse base with sheen, and clear coat, of Disney's material.
//!
//! Source: Burley, *Physically-Based Shading at Disney*, SIGGRAPH 2012, and *Extending the Disney
//! BRDF to a BSDF with Integrated Subsurface Scattering*, 2015.

use super::{LobeKind, LobeSample, NO_SCATTERING, Scatter};
use crate::bsdf::{fresnel, warp};
use crate::math::{Vec2, Vec3, fp};
use crate::spectrum::Spectrum;
use std::f32::consts::{FRAC_1_PI, PI};

/// Diffuse base, which is darker or brighter at grazing angles, depending on its roughness, and
/// sheen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DisneyDiffuse {
    /// Colour of the base, times its share.
    pub color: Spectrum,
    /// Colour of the sheen, times its strength.
    pub sheen: Spectrum,
    /// Roughness, from 0 to 1.
    pub roughness: f32,
    /// Share of the base that is replaced by an approximation of subsurface scattering.
    pub flatness: f32,
}

/// Returns the value of the diffuse base without subsurface scattering, relative to a Lambertian
/// surface, for the cosines of the two directions and of half the angle between them.
pub fn diffuse(cosines: [f32; 2], half: f32, roughness: f32) -> f32 {
    let [out, into] = cosines.map(fresnel::schlick_weight);
    let retro = 2.0 * roughness * half * half;
    (1.0 - 0.5 * out) * (1.0 - 0.5 * into) + retro * (out + into + out * into * (retro - 1.0))
}

impl DisneyDiffuse {
    /// Returns the value of the base relative to a Lambertian surface. The arguments are those of
    /// [`diffuse`].
    fn base(&self, cosines: [f32; 2], half: f32) -> f32 {
        let plain = diffuse(cosines, half, self.roughness);
        if self.flatness == 0.0 {
            return plain;
        }
        let [out, into] = cosines.map(fresnel::schlick_weight);
        let retro = 2.0 * self.roughness * half * half;
        let flat = |weight: f32| 1.0 + weight * (0.5 * retro - 1.0);
        let [a, b] = cosines;
        let subsurface = 1.25 * (flat(out) * flat(into) * (1.0 / (a + b).max(1e-6) - 0.5) + 0.5);
        plain + self.flatness * (subsurface - plain)
    }
}

impl Scatter for DisneyDiffuse {
    #[inline]
    fn kind(&self) -> LobeKind {
        LobeKind::DIFFUSE
    }

    fn eval(&self, wo: Vec3, wi: Vec3) -> (Spectrum, f32) {
        let Some(h) = (wo + wi).try_normalize().filter(|_| wi.z > 0.0) else { return NO_SCATTERING };
        let half = wi.dot(h);
        let base = self.color * (FRAC_1_PI * self.base([wo.z, wi.z], half));
        (wi.z * (base + self.sheen * fresnel::schlick_weight(half)), FRAC_1_PI * wi.z)
    }

    fn sample(&self, _: Vec3, _: f32, u: Vec2) -> Option<LobeSample> {
        Some(LobeSample { wi: warp::cosine_hemisphere(u), value: Spectrum::ONE })
    }
}

/// Clear coat with the facets of Berry (GTR with an exponent of 1) and the masking of GGX with an
/// alpha of 0.25.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DisneyCoat {
    /// Alpha of the facets, from 0.001 to 0.1.
    pub alpha: f32,
    /// Index of refraction of the base; below 1, the angle behind the surface counts.
    pub eta: f32,
}

impl DisneyCoat {
    /// Returns the density of the facet normals.
    fn density(&self, h: Vec3) -> f32 {
        let square = self.alpha * self.alpha;
        (square - 1.0) / (PI * fp::ln(square) * (1.0 + (square - 1.0) * h.z * h.z))
    }

    /// Returns the share of the facets that are visible from a direction.
    fn masking(w: Vec3) -> f32 {
        let tangent2 = (1.0 - w.z * w.z).max(0.0) / (w.z * w.z);
        2.0 / (1.0 + (1.0 + 0.0625 * tangent2).sqrt())
    }
}

impl Scatter for DisneyCoat {
    #[inline]
    fn kind(&self) -> LobeKind {
        LobeKind::GLOSSY
    }

    fn eval(&self, wo: Vec3, wi: Vec3) -> (Spectrum, f32) {
        let Some(h) = (wo + wi).try_normalize().filter(|_| wi.z > 0.0) else { return NO_SCATTERING };
        let (half, density) = (wo.dot(h).max(1e-6), self.density(h));
        let weight = fresnel::schlick_weight_at(half, self.eta);
        let reflected = 0.04 + 0.96 * weight;
        let value = wi.z * reflected * density * DisneyCoat::masking(wo) * DisneyCoat::masking(wi);
        (Spectrum::splat(value), density * h.z / (4.0 * half))
    }

    fn sample(&self, wo: Vec3, _: f32, u: Vec2) -> Option<LobeSample> {
        let square = self.alpha * self.alpha;
        let cosine2 = (1.0 - fp::pow(square, 1.0 - u.y)) / (1.0 - square);
        let h = warp::polar(cosine2.clamp(0.0, 1.0).sqrt(), u.x);
        let wi = 2.0 * wo.dot(h) * h - wo;
        (wi.z > 0.0 && wo.dot(h) > 0.0).then_some(LobeSample { wi, value: Spectrum::ONE })
    }
}
