//! Rough reflection by microfacets, with the reflectance of a metal, a dielectric, a thin sheet or
//! a film.

use super::{LobeKind, LobeSample, NO_SCATTERING, Scatter};
use crate::bsdf::film::Film;
use crate::bsdf::fresnel::{self, DisneyFresnel, MetalCurve, Sheet};
use crate::bsdf::microfacet::Ggx;
use crate::math::{Vec2, Vec3};
use crate::spectrum::Spectrum;

/// Reflectance model of the microfacets of a [`RoughReflection`] lobe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Facet {
    /// Metal.
    Metal(MetalCurve),
    /// Dielectric boundary, with the index behind it relative to the index in front of it.
    Dielectric(f32),
    /// Reflection by a thin dielectric sheet.
    Sheet(Sheet),
    /// Transmission through a thin dielectric sheet.
    SheetTransmission(Sheet),
    /// Base that is covered by a thin film.
    Film(Film),
    /// Disney's mixture of metal and dielectric.
    Disney(DisneyFresnel),
    /// Transmission through a boundary with the given relative index.
    Passing(f32),
}

impl Facet {
    /// Returns the reflectance at a cosine, or the transmittance for a sheet that transmits.
    pub fn at(&self, cosine: f32) -> Spectrum {
        match *self {
            Facet::Metal(curve) => curve.at(cosine),
            Facet::Dielectric(eta) => Spectrum::splat(fresnel::dielectric(cosine, eta)),
            Facet::Sheet(sheet) => sheet.at(cosine).0,
            Facet::Film(film) => film.reflected(cosine),
            Facet::SheetTransmission(sheet) => sheet.at(cosine).1,
            Facet::Disney(fresnel) => fresnel.at(cosine),
            Facet::Passing(eta) => Spectrum::splat(1.0 - fresnel::dielectric(cosine, eta)),
        }
    }
}

/// Lobe for reflection by a rough surface, or for transmission through a thin rough sheet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoughReflection {
    /// Distribution of the facet normals.
    pub ggx: Ggx,
    /// Reflectance model of the facets.
    pub facet: Facet,
    /// True if light leaves on the other side, as the mirror image of the reflection. The flag is
    /// set for transmission through a thin sheet of rough glass.
    pub transmits: bool,
}

impl RoughReflection {
    /// Mirrors a direction behind the surface to the front if the lobe transmits.
    fn above(&self, wi: Vec3) -> Vec3 {
        if self.transmits { Vec3::new(wi.x, wi.y, -wi.z) } else { wi }
    }
}

impl Scatter for RoughReflection {
    #[inline]
    fn kind(&self) -> LobeKind {
        if self.transmits { LobeKind::GLOSSY.transmitting() } else { LobeKind::GLOSSY }
    }

    fn eval(&self, wo: Vec3, wi: Vec3) -> (Spectrum, f32) {
        let wi = self.above(wi);
        let Some(h) = (wo + wi).try_normalize().filter(|_| wi.z > 0.0) else { return NO_SCATTERING };
        let density = self.ggx.density(h) / (4.0 * wo.z);
        let (hidden_o, hidden_i) = (self.ggx.lambda(wo), self.ggx.lambda(wi));
        let value = density / self.ggx.hiding(hidden_o, hidden_i) * self.facet.at(wo.dot(h).clamp(0.0, 1.0));
        // The pdf is that of the visible normals, divided by 4 wo·h. The factor wo·h cancels.
        (value, density / self.ggx.sampling_divisor(wo, h, hidden_o))
    }

    fn sample(&self, wo: Vec3, _: f32, u: Vec2) -> Option<LobeSample> {
        let h = self.ggx.sample_visible(wo, u);
        let wi = 2.0 * wo.dot(h) * h - wo;
        (wi.z > 0.0).then(|| LobeSample { wi: self.above(wi), value: Spectrum::ONE })
    }
}
