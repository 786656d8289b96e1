//! Disney's material as a sum of lobes, which neither conserves energy nor weights the base by the
//! light that the layers above let through.
//!
//! Source: Burley, *Physically-Based Shading at Disney*, SIGGRAPH 2012, and *Extending the Disney
//! BRDF to a BSDF with Integrated Subsurface Scattering*, 2015, with the choices of *Mitsuba 3
//! documentation*, "BSDFs".

use super::Bsdf;
use super::fresnel::{DisneyFresnel, ratio_squared};
use super::lobe::diffuse::DiffuseTransmission;
use super::lobe::disney::{DisneyCoat, DisneyDiffuse};
use super::lobe::rough::{Facet, RoughReflection};
use super::lobe::rough_glass::RoughGlass;
use super::microfacet::Ggx;
use super::view::View;
use crate::material::Parameters;
use crate::material::principled::{Facets, Walls};
use crate::math::{LUMINANCE, Vec3};
use crate::spectrum::Spectrum;

/// Layers of Disney's material at one surface point.
pub(super) struct DisneyStack<'a> {
    /// Parameters at the point.
    pub parameters: &'a Parameters,
    /// View for which the lobes are built.
    pub view: View<'a>,
    /// Base colour.
    pub base: Spectrum,
    /// Weight of all lobes.
    pub factor: f32,
}

impl DisneyStack<'_> {
    /// Adds the lobes.
    pub fn push_lobes(&self, bsdf: &mut Bsdf) {
        match self.parameters.walls {
            Walls::Solid => self.solid(bsdf),
            Walls::Thin => self.thin(bsdf),
        }
    }

    /// Returns the facets of the specular reflection, scaled in roughness.
    fn facets(&self, scale: f32) -> Ggx {
        let m = self.parameters;
        let roughness = (scale * m.specular_roughness).min(1.0);
        Ggx::new(roughness, m.specular_anisotropy).with(Facets::GgxSeparable).clamped()
    }

    /// Returns the base colour divided by its luminance.
    fn tint(&self) -> Spectrum {
        let color = self.parameters.base_color;
        let luminance = color.dot(LUMINANCE);
        let tint = if luminance > 0.0 { color / luminance } else { Vec3::ONE };
        self.view.lanes.reflectance(tint)
    }

    /// Returns the reflectance of the facets, in which `metal` is the share of metal.
    fn fresnel(&self, eta: f32, metal: f32) -> DisneyFresnel {
        let tinted = (1.0 - metal) * self.parameters.specular_tint;
        let at_normal = if tinted > 0.0 { tinted * ratio_squared(eta) * self.tint() } else { Spectrum::ZERO };
        DisneyFresnel { eta, plain: 1.0 - metal - tinted, schlick: metal + tinted, f0: metal * self.base + at_normal }
    }

    /// Adds the diffuse base and the sheen, in which `share` is the share of the base.
    fn diffuse(&self, bsdf: &mut Bsdf, share: f32, sheen: f32) {
        let m = self.parameters;
        if share <= 0.0 {
            return;
        }
        let alpha = self.facets(1.0).alpha;
        let strength = sheen * m.fuzz_weight;
        let sheen = if strength > 0.0 { strength * self.view.lanes.reflectance(m.fuzz_color) } else { Spectrum::ZERO };
        let roughness = (alpha.x * alpha.y).sqrt().sqrt();
        let lobe = DisneyDiffuse { color: share * self.base, sheen, roughness, flatness: m.base_flatness };
        let albedo = (lobe.color + 0.1 * sheen).max_element();
        bsdf.push(lobe, Spectrum::splat(self.factor), self.factor * albedo);
    }

    fn solid(&self, bsdf: &mut Bsdf) {
        let (m, view, factor) = (self.parameters, self.view, self.factor);
        let eta = if view.inside { 1.0 / m.specular_ior } else { m.specular_ior };
        let metal = m.base_metalness;
        let through = (1.0 - metal) * m.transmission_weight;
        if through > 0.0 {
            let tint = self.base.max(Spectrum::ZERO).map(f32::sqrt);
            // From outside, a lobe of its own reflects the light.
            let reflected = if view.inside { Spectrum::ONE } else { Spectrum::ZERO };
            let glass = RoughGlass { ggx: self.facets(1.0), eta, reflected, transmitted: tint };
            bsdf.push(glass, Spectrum::splat(factor * through), factor * through);
        }
        if view.inside {
            return;
        }
        let fresnel = self.fresnel(eta, metal);
        let rough = RoughReflection { ggx: self.facets(1.0), facet: Facet::Disney(fresnel), transmits: false };
        bsdf.push(rough, Spectrum::splat(factor), factor * fresnel.at(view.wo.z).max_element());
        let coat = 0.25 * m.coat_weight;
        if coat > 0.0 {
            let alpha = (m.coat_roughness * m.coat_roughness).clamp(1e-3, 0.999);
            bsdf.push(DisneyCoat { alpha, eta }, Spectrum::splat(factor * coat), 0.1 * factor * coat);
        }
        self.diffuse(bsdf, (1.0 - metal) * (1.0 - m.transmission_weight), 1.0 - metal);
    }

    fn thin(&self, bsdf: &mut Bsdf) {
        let (m, factor, eta) = (self.parameters, self.factor, self.parameters.specular_ior);
        let clear = m.transmission_weight;
        if clear > 0.0 {
            let weight = Spectrum::splat(factor * clear);
            let fresnel = self.fresnel(eta, 0.0);
            let rough = RoughReflection { ggx: self.facets(1.0), facet: Facet::Disney(fresnel), transmits: false };
            bsdf.push(rough, weight, factor * clear * fresnel.at(self.view.wo.z).max_element());
            // Burley 2015: a thin slab blurs less than its surface.
            let ggx = self.facets((0.65 * eta - 0.35).max(0.0));
            let rough = RoughReflection { ggx, facet: Facet::Passing(eta), transmits: true };
            bsdf.push(rough, weight * self.base, (weight * self.base).max_element());
        }
        let onwards = 0.5 * m.subsurface_weight * (1.0 + m.subsurface_scatter_anisotropy);
        let behind = (1.0 - clear) * onwards;
        if behind > 0.0 {
            let weight = Spectrum::splat(factor * behind);
            bsdf.push(DiffuseTransmission { color: self.base }, weight, (weight * self.base).max_element());
        }
        let share = (1.0 - clear) * (1.0 - onwards);
        self.diffuse(bsdf, share, share);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bsdf::Tables;
    use crate::bsdf::layers;
    use crate::material::PrincipledMaterial;
    use crate::material::principled::Layering;
    use crate::spectrum::Lanes;

    /// Returns BSDF · cosine of a material for two directions, which need not be normalised.
    fn value(material: &PrincipledMaterial, wo: Vec3, wi: Vec3, inside: bool) -> Vec3 {
        let tables = Tables::new(material, None, &mut Vec::new());
        let eta = if inside { 1.0 / material.specular_ior } else { material.specular_ior };
        let wo = wo.normalize();
        let view = View { lanes: &Lanes::Rgb, wo, normal: Vec3::Z, inside, eta };
        let mut bsdf = Bsdf::default();
        layers::push_lobes(&mut bsdf, 1.0, &Parameters::of(material), &tables, view);
        bsdf.eval(wo, wi.normalize()).0.truncate()
    }

    #[test]
    fn values_are_those_of_mitsuba() {
        let m = || PrincipledMaterial {
            layering: Layering::Disney,
            base_color: Vec3::new(0.7, 0.35, 0.2),
            specular_roughness: 0.5,
            ..PrincipledMaterial::default()
        };
        let anisotropic = |roughness: f32, anisotropy: f32| {
            let aspect = (1.0 - 0.9 * anisotropy).sqrt();
            Ggx::parameters([roughness * roughness / aspect, roughness * roughness * aspect])
        };
        let [long, stretched, _] = anisotropic(0.6, 0.4);
        let hue = Vec3::new(0.7, 0.35, 0.2) / Vec3::new(0.7, 0.35, 0.2).dot(LUMINANCE);
        let clear = || PrincipledMaterial { transmission_weight: 0.5, ..m() };
        let sheet = || PrincipledMaterial { walls: Walls::Thin, ..m() };
        let (wo, wi) = (Vec3::new(0.6, 0.1, 0.7), Vec3::new(-0.3, 0.5, 0.6));
        let below = Vec3::new(-0.3, 0.5, -0.6);
        // Values of `principled` and `principledthin` of Mitsuba 3.9.1 for the same directions.
        for (material, wo, wi, inside, wanted) in [
            (m(), wo, wi, false, [0.163903, 0.083968, 0.04971]),
            (
                PrincipledMaterial { base_flatness: 0.7, specular_roughness: 0.6, ..m() },
                wo,
                wi,
                false,
                [0.14855, 0.077087, 0.04646],
            ),
            (
                PrincipledMaterial {
                    fuzz_weight: 1.0,
                    fuzz_color: Vec3::ONE.lerp(hue, 0.5),
                    specular_roughness: 0.8,
                    ..m()
                },
                wo,
                wi,
                false,
                [0.165719, 0.08565, 0.051335],
            ),
            (
                PrincipledMaterial { base_metalness: 0.6, specular_tint: 0.4, ..m() },
                wo,
                wi,
                false,
                [0.105617, 0.053298, 0.030875],
            ),
            (
                PrincipledMaterial { coat_weight: 1.0, coat_roughness: 0.1_f32.sqrt(), ..m() },
                wo,
                wi,
                false,
                [0.166091, 0.086156, 0.051898],
            ),
            (
                PrincipledMaterial {
                    base_metalness: 1.0,
                    specular_roughness: long,
                    specular_anisotropy: stretched,
                    ..m()
                },
                wo,
                wi,
                false,
                [0.054935, 0.027473, 0.015704],
            ),
            (clear(), wo, wi, false, [0.083968, 0.044, 0.026871]),
            (clear(), wo, Vec3::new(-0.3, 0.2, -0.6), false, [0.021404, 0.015135, 0.011441]),
            // From inside, up is where the light comes from.
            (clear(), Vec3::new(0.3, 0.2, 0.8), Vec3::new(-0.2, 0.1, 0.6), true, [0.01091; 3]),
            (
                PrincipledMaterial { subsurface_weight: 0.6, fuzz_weight: 1.0, base_flatness: 0.3, ..sheet() },
                wo,
                wi,
                false,
                [0.106893, 0.053483, 0.030594],
            ),
            (
                PrincipledMaterial { subsurface_weight: 0.6, ..sheet() },
                wo,
                below,
                false,
                [0.047937, 0.023969, 0.013696],
            ),
            (
                PrincipledMaterial { transmission_weight: 0.8, specular_tint: 0.5, ..sheet() },
                wo,
                wi,
                false,
                [0.03615, 0.018884, 0.011485],
            ),
            (PrincipledMaterial { transmission_weight: 0.8, ..sheet() }, wo, below, true, [0.0112, 0.0056, 0.0032]),
        ] {
            let (found, wanted) = (value(&material, wo, wi, inside), Vec3::from(wanted));
            assert!((found - wanted).abs().max_element() < 2e-5, "{material:?}: {found} and not {wanted}");
        }
    }
}
