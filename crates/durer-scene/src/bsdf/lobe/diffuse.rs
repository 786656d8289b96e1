//! Diffuse surfaces, described by the energy-preserving Oren-Nayar model.
//!
//! Source: Portsmouth, Kutz and Hill, *EON: A practical energy-preserving rough diffuse BRDF*, JCGT
//! 14(1), 2025. The model is Fujii's version of the Oren-Nayar model, with an additional term for
//! multiple scattering.

use super::{LobeKind, LobeSample, NO_SCATTERING, Scatter};
use crate::bsdf::albedo::DielectricAlbedo;
use crate::bsdf::{Frame, warp};
use crate::math::{Vec2, Vec3, fp};
use crate::spectrum::Spectrum;
use std::f32::consts::{FRAC_1_PI, PI};

/// Diffuse reflection lobe, optionally below a dielectric boundary. Without the effect of
/// `boundary`, the lobe is reciprocal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Diffuse<'a> {
    /// Albedo in each lane.
    pub color: Spectrum,
    /// Roughness, from 0 (Lambert) to 1.
    pub roughness: f32,
    /// Boundary that light crosses on its way in. The weight of the lobe accounts for the light
    /// that is lost on the way out.
    pub boundary: Option<Boundary<'a>>,
    /// Local shading normal of the lobe. This normal is z unless the normal of the frame was bent,
    /// which keeps mirrors from reflecting below the surface. Diffuse lobes do not need a bent
    /// normal.
    pub normal: Vec3,
}

/// Dielectric boundary above a diffuse base, such as the glossy surface of plastic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Boundary<'a> {
    /// Index of refraction and albedo tables.
    pub dielectric: &'a DielectricAlbedo,
    /// Roughness of the boundary.
    pub roughness: f32,
    /// Factor from 0 to 1 that scales the reflection of the boundary.
    pub reflection: f32,
}

impl Boundary<'_> {
    /// Returns the transmittance for light from one direction above, divided by the cosine-weighted
    /// mean of the transmittance over the hemisphere.
    ///
    /// Together with the weight 1 - E(wo) of the diffuse base, this factor scales the bare base by
    /// (1 - E(wo)) (1 - E(wi)) / (1 - E mean). The result is reciprocal. Together with the
    /// boundary's own E(wo), the result conserves energy.
    ///
    /// Source: Kelemen and Szirmay-Kalos, *A Microfacet Based Coupled Specular-Matte BRDF Model
    /// with Importance Sampling*, Eurographics 2001.
    fn entering(&self, cosine: f32) -> f32 {
        let passing = |reflected: f32| 1.0 - self.reflection * reflected;
        let (reflectance, mean) =
            (self.dielectric.reflectance(cosine, self.roughness), self.dielectric.mean(self.roughness));
        passing(reflectance) / passing(mean)
    }
}

const C1: f32 = 0.5 - 2.0 / (3.0 * PI);
const C2: f32 = 2.0 / 3.0 - 28.0 / (15.0 * PI);

impl<'a> Diffuse<'a> {
    /// Creates a Lambertian lobe with the given colour and without a boundary.
    pub fn lambert(color: Spectrum) -> Self {
        Diffuse { color, roughness: 0.0, boundary: None, normal: Vec3::Z }
    }

    /// Returns the directional albedo of single scattering for a white surface.
    fn single(&self, cosine: f32) -> f32 {
        let mu = cosine.clamp(1e-6, 1.0);
        let sine = (1.0 - mu * mu).max(0.0).sqrt();
        let angle = fp::atan2(sine, mu);
        let g = sine * (angle - sine * mu) + (2.0 / 3.0) * ((sine / mu) * (1.0 - sine * sine * sine) - sine);
        (1.0 + self.roughness * FRAC_1_PI * g) / (1.0 + C1 * self.roughness)
    }

    /// Returns the value of the lobe without the cosine factor. `between` is the cosine of the
    /// angle between the two directions, and `out` and `into` are the cosines of their angles to
    /// the normal.
    fn value(&self, between: f32, out: f32, into: f32) -> Spectrum {
        let Some(boundary) = &self.boundary else { return self.bare(between, out, into) };
        let entering = boundary.entering(into);
        if self.roughness == 0.0 {
            return self.color * (FRAC_1_PI * entering);
        }
        // For a rough base, apply the boundary only to the isotropic part of the value. If the
        // boundary were applied to the remainder, energy would be lost or created.
        let even = FRAC_1_PI * (1.0 - self.roughness) / (1.0 + C1 * self.roughness);
        self.bare(between, out, into) + self.color * (even * (entering - 1.0))
    }

    /// Version of [`Diffuse::value`] that ignores the boundary.
    fn bare(&self, between: f32, out: f32, into: f32) -> Spectrum {
        if self.roughness == 0.0 {
            return self.color * FRAC_1_PI;
        }
        let a = 1.0 / (1.0 + C1 * self.roughness);
        let s = between - out * into;
        let s_over_t = if s > 0.0 { s / out.max(into) } else { s };
        let single = self.color * (FRAC_1_PI * a * (1.0 + self.roughness * s_over_t));
        let mean = a * (1.0 + C2 * self.roughness);
        let lost = |cosine: f32| (1.0 - self.single(cosine)).max(1e-7);
        let again = self.color * self.color * mean / (Spectrum::ONE - self.color * (1.0 - mean).max(0.0));
        single + again * (FRAC_1_PI * lost(out) * lost(into) / (1.0 - mean).max(1e-7))
    }
}

impl Scatter for Diffuse<'_> {
    #[inline]
    fn kind(&self) -> LobeKind {
        LobeKind::DIFFUSE
    }

    fn eval(&self, wo: Vec3, wi: Vec3) -> (Spectrum, f32) {
        let into = wi.dot(self.normal);
        if into <= 0.0 || wi.z <= 0.0 {
            return NO_SCATTERING;
        }
        let out = wo.dot(self.normal).max(1e-6);
        (into * self.value(wo.dot(wi), out, into), FRAC_1_PI * into)
    }

    fn sample(&self, _: Vec3, _: f32, u: Vec2) -> Option<LobeSample> {
        let mut wi = warp::cosine_hemisphere(u);
        if self.normal != Vec3::Z {
            wi = Frame::around(self.normal).to_world(wi);
            // A direction below the surface carries no light.
            if wi.z <= 0.0 {
                return None;
            }
        }
        Some(LobeSample { wi, value: Spectrum::ONE })
    }
}

/// Diffuse transmission lobe, in which light leaves on the other side with equal radiance in all
/// directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiffuseTransmission {
    /// Share of light that is transmitted, in each lane.
    pub color: Spectrum,
}

impl Scatter for DiffuseTransmission {
    #[inline]
    fn kind(&self) -> LobeKind {
        LobeKind::DIFFUSE.transmitting()
    }

    fn eval(&self, _: Vec3, wi: Vec3) -> (Spectrum, f32) {
        let share = FRAC_1_PI * (-wi.z).max(0.0);
        (self.color * share, share)
    }

    fn sample(&self, _: Vec3, _: f32, u: Vec2) -> Option<LobeSample> {
        let above = warp::cosine_hemisphere(u);
        Some(LobeSample { wi: Vec3::new(above.x, above.y, -above.z), value: Spectrum::ONE })
    }
}
