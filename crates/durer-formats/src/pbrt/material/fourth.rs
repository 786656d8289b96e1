//! Converts the materials of pbrt-v4.
//!
//! Source: *Physically Based Rendering*, 4th edition, chapters 9, 10 and 14. A coat over a matte
//! base becomes an OpenPBR coat with darkening. A metal is represented by its reflectance at normal
//! incidence and at 82 degrees. GGX's alpha is the square of Dürer's roughness.

use super::super::defs::{MaterialDef, Texture};
use super::super::medium::medium_of;
use super::super::named;
use super::super::params::{Kind, Params, Values};
use super::super::state::Reader;
use super::{matte, set_subsurface};
use crate::export::metal::indices_of_refraction;
use crate::shared_report::suggest;
use durer_diag::Span;
use durer_scene::bsdf::fresnel::{self, conductor_colors};
use durer_scene::bsdf::microfacet::Ggx;
use durer_scene::describe::FileName;
use durer_scene::material::PrincipledMaterial;
use durer_scene::material::principled::{Surroundings, Switch, Walls};
use durer_scene::math::{Vec3, fp};
use durer_scene::spectrum::SpectrumSource;

const MATERIALS: [&str; 12] = [
    "diffuse",
    "coateddiffuse",
    "conductor",
    "coatedconductor",
    "dielectric",
    "thindielectric",
    "diffusetransmission",
    "mix",
    "interface",
    "subsurface",
    "measured",
    "hair",
];

/// Materials that exist only in pbrt-v3, each with the most similar material of pbrt-v4.
const V3_MATERIALS: [(&str, &str); 8] = [
    ("matte", "diffuse"),
    ("plastic", "coateddiffuse"),
    ("metal", "conductor"),
    ("glass", "dielectric"),
    ("mirror", "conductor"),
    ("substrate", "coateddiffuse"),
    ("uber", "coateddiffuse"),
    ("translucent", "diffusetransmission"),
];

/// Returns the transmittance of a coat for light that crosses it on the way down and on the way up.
/// Each crossing multiplies the light by exp(-thickness / cosine). The result includes light that
/// is reflected between the boundary and a matte base.
///
/// Source: `LayeredBxDF` in *Physically Based Rendering*, 4th edition, section 14.3.2.
fn coat_transmittance(thickness: f32, ior: f32, base: f32) -> f32 {
    const STEPS: u16 = 64;
    let at = |i: u16| (f32::from(i) + 0.5) / f32::from(STEPS);
    // Cosine-weighted mean of the transmittance for diffuse light.
    let even = (0..STEPS).map(|i| 2.0 * at(i) * fp::exp(-thickness / at(i))).sum::<f32>() / f32::from(STEPS);
    let back = base.clamp(0.0, 1.0) * fresnel::diffuse(1.0 / ior);
    fp::exp(-2.0 * thickness) * (1.0 - back) / (1.0 - back * even * even)
}

impl Reader<'_> {
    /// Returns the GGX alpha along u and along v. The three parameter names are those for both
    /// directions, for u and for v.
    fn alphas(&self, params: &Params, [both, u, v]: [&'static str; 3], remapped: bool) -> [f32; 2] {
        let default = self.value(params, both, 0.0);
        // Source: pbrt-v4 uses the square root of the roughness if `remaproughness` is set.
        [u, v].map(|name| {
            let roughness = self.value(params, name, default).max(0.0);
            if remapped { roughness.sqrt() } else { roughness }
        })
    }

    /// Returns a roughness picture that is computed from a picture of GGX's alpha, and alpha values
    /// of 1 for that picture to multiply. Without a picture, returns only the alpha values that the
    /// parameters give.
    fn roughness(&mut self, params: &Params, names: [&'static str; 3], remapped: bool) -> (Option<FileName>, [f32; 2]) {
        let each = names[1..].iter().any(|name| params.get(name).is_some());
        let fourth = |x: f32| x.max(0.0).sqrt().sqrt();
        let picture = if each {
            None
        } else {
            self.mapped_picture(params, names[0], false, |x| if remapped { fourth(x) } else { x.max(0.0).sqrt() })
        };
        match picture {
            Some(picture) => (Some(picture), [1.0; 2]),
            None => (None, self.alphas(params, names, remapped)),
        }
    }

    /// Converts a pbrt-v4 material of type `kind`.
    pub(super) fn fourth(&mut self, kind: &str, params: &Params, at: Span) -> MaterialDef {
        let remapped = params.boolean("remaproughness").unwrap_or(true);
        let mut m = PrincipledMaterial::default();
        const ROUGHNESS: [&str; 3] = ["roughness", "uroughness", "vroughness"];
        match kind {
            "diffuse" => {
                let (color, picture) = self.color_or_texture(params, "reflectance", 0.5);
                m = PrincipledMaterial { base_color_texture: picture, ..matte(color) };
                params.warn_unsupported(&["sigma"], "the surface is Lambertian");
            }
            "coateddiffuse" => {
                let (color, picture) = self.color_or_texture(params, "reflectance", 0.5);
                m = PrincipledMaterial { base_color_texture: picture, ..matte(color) };
                let alphas;
                (m.coat_roughness_texture, alphas) = self.roughness(params, ROUGHNESS, remapped);
                m.coat_ior = self.index(params, "eta", 1.5);
                self.coat(&mut m, alphas, params);
            }
            "conductor" => {
                let alphas;
                (m.specular_roughness_texture, alphas) = self.roughness(params, ROUGHNESS, remapped);
                self.conductor(&mut m, params, ["eta", "k", "reflectance"], alphas, 1.0);
            }
            "coatedconductor" => {
                let interface = ["interface.roughness", "interface.uroughness", "interface.vroughness"];
                let conductor = ["conductor.roughness", "conductor.uroughness", "conductor.vroughness"];
                let (above, below);
                (m.coat_roughness_texture, above) = self.roughness(params, interface, remapped);
                (m.specular_roughness_texture, below) = self.roughness(params, conductor, remapped);
                m.coat_ior = self.index(params, "interface.eta", 1.5);
                let ior = m.coat_ior;
                self.conductor(&mut m, params, ["conductor.eta", "conductor.k", "reflectance"], below, ior);
                self.coat(&mut m, above, params);
            }
            "dielectric" | "thindielectric" => {
                m.transmission_weight = 1.0;
                m.specular_ior = self.index(params, "eta", 1.5);
                let mut alphas = [0.0; 2];
                if kind == "dielectric" {
                    (m.specular_roughness_texture, alphas) = self.roughness(params, ROUGHNESS, remapped);
                }
                [m.specular_roughness, m.specular_anisotropy, m.specular_rotation] = Ggx::parameters(alphas);
                m.walls = if kind == "thindielectric" { Walls::Thin } else { Walls::Solid };
            }
            "diffusetransmission" => {
                let scale = params.float("scale").unwrap_or(1.0);
                let [reflected, through] = ["reflectance", "transmittance"].map(|name| {
                    let (color, picture) = self.color_or_texture(params, name, 0.25);
                    if picture.is_some() {
                        let what =
                            "diffuse transmission with a picture has no counterpart: `scale` is used as the colour";
                        self.report.unsupported_once(params.span(name), what);
                    }
                    scale * color
                });
                m = PrincipledMaterial {
                    subsurface_weight: 1.0,
                    subsurface_color: reflected.clamp(Vec3::ZERO, Vec3::ONE),
                    subsurface_through: Some(through.clamp(Vec3::ZERO, Vec3::ONE)),
                    walls: Walls::Thin,
                    ..matte(Vec3::ZERO)
                };
            }
            "subsurface" => {
                let alphas;
                (m.specular_roughness_texture, alphas) = self.roughness(params, ROUGHNESS, remapped);
                [m.specular_roughness, m.specular_anisotropy, m.specular_rotation] = Ggx::parameters(alphas);
                m.specular_ior = self.index(params, "eta", 1.33);
                if params.get("reflectance").is_some() {
                    let color = self.color_or_texture(params, "reflectance", 1.0);
                    let path = params.spectrum("mfp").map_or(Vec3::ONE, |spectrum| spectrum.coefficient());
                    set_subsurface(&mut m, params, color, path);
                } else {
                    // The boundary refracts light, and the medium inside scatters it.
                    m.transmission_weight = 1.0;
                    medium_of(params, "name").fill(&mut m);
                }
            }
            "measured" => {
                params.mark_known(&["filename"]);
                m = matte(Vec3::splat(0.5));
                self.report.unsupported_once(at, "measured materials have no counterpart: diffuse grey is used");
            }
            "hair" => return self.hair(params, &["reflectance", "color"], at),
            "mix" => return self.mixed(params, at),
            "interface" | "" | "none" => return MaterialDef::Interface,
            other => {
                let old = V3_MATERIALS.iter().find(|row| row.0 == other);
                let help = match old {
                    Some((_, now)) => {
                        Some(format!("`{other}` is a pbrt-v3 material; the nearest material in pbrt-v4 is `{now}`"))
                    }
                    None => suggest(other, MATERIALS),
                };
                self.no_material(other, at, help, old.is_some());
                params.mark_all_used();
                return MaterialDef::Interface;
            }
        }
        m.energy_compensation = Switch::Off;
        // `eta` is the ratio of the indices on the two sides of the surface, regardless of the
        // surrounding medium.
        m.surroundings = Surroundings::Ignored;
        self.surface(&mut m, params, "displacement");
        MaterialDef::Principled(Box::new(m), at)
    }

    /// Reads an index of refraction, which may be a spectrum.
    fn index(&self, params: &Params, name: &'static str, default: f32) -> f32 {
        let index = match params.get(name).map(|param| param.kind) {
            Some(Kind::Spectrum | Kind::Rgb) => params.spectrum(name).map_or(default, |spectrum| spectrum.index()),
            _ => self.value(params, name, default),
        };
        if index <= 0.0 {
            self.report.error(params.span(name), "an index of refraction must be more than 0");
            return default;
        }
        index
    }

    fn coat(&self, m: &mut PrincipledMaterial, [u, v]: [f32; 2], params: &Params) {
        (m.coat_weight, m.coat_roughness) = (1.0, (u.min(1.0) * v.min(1.0)).sqrt().sqrt());
        if u != v {
            self.report
                .unsupported_once(params.at, "an anisotropic coat has no counterpart: its mean roughness is used");
        }
        if params.get("albedo").is_some_and(|param| param.numbers().iter().any(|x| *x != 0.0)) {
            self.report.unsupported_once(
                params.span("albedo"),
                "a medium inside a coat has no counterpart: the coat is clear",
            );
        }
        // The thickness of the coat attenuates the light that crosses it, even if the coat contains
        // no medium.
        let thickness = self.value(params, "thickness", 0.01).max(0.0);
        m.coat_color = m.base_color.map(|base| coat_transmittance(thickness, m.coat_ior, base));
        params.mark_known(&["g", "maxdepth", "nsamples", "twosided"]);
    }

    fn conductor(
        &mut self,
        m: &mut PrincipledMaterial,
        params: &Params,
        [eta, k, reflectance]: [&'static str; 3],
        alphas: [f32; 2],
        outside: f32,
    ) {
        let copper = |which: &str| named::spectrum(&format!("metal-Cu-{which}"));
        let [eta, k] = match params.get(reflectance) {
            Some(param) => {
                if params.get(eta).is_some() || params.get(k).is_some() {
                    self.report
                        .error(param.at, format!("a conductor takes either `{reflectance}`, or `{eta}` and `{k}`"));
                }
                let share = match self.texture_value(params, reflectance, true, Vec3::splat(0.5)) {
                    Texture::Constant(color) => color,
                    Texture::Picture(picture, scale) => {
                        // The picture gives the reflectance at normal incidence. Reflection at
                        // grazing angles is not tinted.
                        m.base_color_texture = Some(self.asset(picture, param.at));
                        (m.base_metalness, m.base_color) = (1.0, scale);
                        [m.specular_roughness, m.specular_anisotropy, m.specular_rotation] = Ggx::parameters(alphas);
                        return;
                    }
                };
                // With eta = 1, this k gives the desired reflectance at normal incidence.
                let k = share.clamp(Vec3::ZERO, Vec3::splat(0.9999)).map(|r| 2.0 * (r / (1.0 - r)).sqrt());
                [Vec3::splat(1.0 / outside), k / outside]
            }
            None => {
                let value = |name, which| params.spectrum(name).or_else(|| copper(which));
                let grey = SpectrumSource::Rgb(Vec3::ONE);
                let [eta, k] = [value(eta, "eta"), value(k, "k")].map(|value| value.unwrap_or(grey.clone()));
                match (&eta, &k) {
                    (SpectrumSource::Rgb(eta), SpectrumSource::Rgb(k)) => [*eta / outside, *k / outside],
                    // Reflectances average over the spectrum; indices of refraction do not.
                    _ => {
                        let [f0, f82] = conductor_colors(&eta, &k, outside);
                        indices_of_refraction(f0, f82)
                    }
                }
            }
        };
        (m.metal_ior, m.metal_extinction) = (Some(eta), k);
        let [f0, _] = conductor_colors(&SpectrumSource::Rgb(eta), &SpectrumSource::Rgb(k), 1.0);
        (m.base_metalness, m.base_color) = (1.0, f0);
        [m.specular_roughness, m.specular_anisotropy, m.specular_rotation] = Ggx::parameters(alphas);
    }

    fn mixed(&mut self, params: &Params, at: Span) -> MaterialDef {
        let share = self.number_or_texture(params, "amount", 0.5, |amount| 1.0 - amount.clamp(0.0, 1.0));
        let Some(param) = params.get("materials") else {
            self.report.error(at, "a mix needs two names, `\"string materials\" [ \"a\" \"b\" ]`");
            return MaterialDef::Interface;
        };
        let Values::Texts(names) = &param.values else { return MaterialDef::Interface };
        let [first, second] = names.as_slice() else {
            self.report.error(param.values_at, format!("a mix needs two materials, found {}", names.len()));
            return MaterialDef::Interface;
        };
        let (Some(a), Some(b)) =
            (self.known_material(first, param.values_at), self.known_material(second, param.values_at))
        else {
            return MaterialDef::Interface;
        };
        self.mix_by([a, b], share, at)
    }
}
