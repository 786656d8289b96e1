//! Converts the materials of pbrt-v3. Most of these materials are sums of a Lambertian lobe and a
//! rough specular lobe, whereas pbrt-v4 uses layers. Such a sum becomes a mix, in which each part
//! is multiplied by the inverse of its share.
//!
//! Source: *Physically Based Rendering*, 3rd edition, chapters 8 and 9, and *Input File Format*,
//! pbrt.org/fileformat-v3.

use super::super::defs::{MaterialDef, Texture};
use super::super::language::NEW_MATERIALS;
use super::super::medium::medium_of;
use super::super::params::{Kind, Params};
use super::super::state::Reader;
use super::parts::{Lobe, glass, glossy, metallic, oren_nayar};
use super::rough::Roughness;
use super::{matte, set_subsurface};
use crate::shared_report::suggest;
use durer_diag::Span;
use durer_scene::bsdf::fresnel::conductor_colors;
use durer_scene::material::PrincipledMaterial;
use durer_scene::material::principled::Walls;
use durer_scene::math::{Color, Vec3};
use durer_scene::spectrum::SpectrumSource;

const MATERIALS: [&str; 15] = [
    "disney",
    "fourier",
    "glass",
    "hair",
    "kdsubsurface",
    "matte",
    "metal",
    "mirror",
    "mix",
    "none",
    "plastic",
    "substrate",
    "subsurface",
    "translucent",
    "uber",
];

/// Complex index of refraction of copper (eta and k) for red, green and blue, from pbrt-v3's
/// spectra converted to RGB.
///
/// Source of the spectra: Palik, *Handbook of Optical Constants of Solids*, 1985, as distributed
/// with pbrt-v3.
const COPPER: [Vec3; 2] = [Vec3::new(0.200438, 0.924033, 1.102212), Vec3::new(3.912949, 2.452848, 2.142188)];

impl Reader<'_> {
    /// Reads the index of refraction from the parameter `eta` or `index`.
    pub(super) fn index_parameter(&self, params: &Params, default: f32) -> f32 {
        let name = if params.get("eta").is_some() { "eta" } else { "index" };
        let index = match params.get(name).map(|param| param.kind) {
            Some(Kind::Spectrum | Kind::Rgb) => {
                params.spectrum(name).map_or(default, |spectrum| spectrum.pbrt_v3_color().y)
            }
            _ => self.value(params, name, default),
        };
        if index <= 0.0 {
            self.report.error(params.span(name), "an index of refraction must be more than 0");
            return default;
        }
        index
    }

    /// Converts a pbrt-v3 material of type `kind`.
    pub(super) fn third(&mut self, kind: &str, params: &Params, at: Span) -> MaterialDef {
        let parts = match kind {
            "matte" => {
                let (color, picture) = self.color_or_texture(params, "Kd", 0.5);
                let degrees = self.value(params, "sigma", 0.0).clamp(0.0, 90.0);
                let (color, roughness) = if degrees > 0.0 { oren_nayar(color, degrees) } else { (color, 0.0) };
                let layers = PrincipledMaterial {
                    base_color_texture: picture,
                    base_diffuse_roughness: roughness,
                    ..matte(color)
                };
                vec![Lobe { layers, max_reflectance: 1.0 }]
            }
            "plastic" => {
                let rough = self.isotropic_roughness(params, Some("roughness"), false, 0.1);
                // pbrt uses an index of 1.5 outside and 1 inside, so the surface reflects light as
                // it would from inside.
                vec![self.lambert(params, "Kd", 0.25), self.gloss(params, "Ks", (0.25, 1.0 / 1.5), &rough)]
            }
            "uber" => self.uber(params),
            "translucent" => self.translucent(params),
            "substrate" => self.substrate(params),
            "metal" => {
                let rough = self.rough(params, Some("roughness"), true, 0.01);
                let [eta, k] = ["eta", "k"].map(|name| params.spectrum(name).map(|spectrum| spectrum.pbrt_v3_color()));
                let [eta, k] = [eta.unwrap_or(COPPER[0]), k.unwrap_or(COPPER[1])];
                let [f0, f82] = conductor_colors(&SpectrumSource::Rgb(eta), &SpectrumSource::Rgb(k), 1.0);
                vec![Lobe { layers: metallic(f0, f82, &rough), max_reflectance: 1.0 }]
            }
            "mirror" => {
                let (color, picture) = self.color_or_texture(params, "Kr", 0.9);
                let max_reflectance = color.max_element().clamp(1e-6, 1.0);
                // The reflectance is the same at every angle.
                let m = PrincipledMaterial {
                    base_metalness: 1.0,
                    base_color: color / max_reflectance,
                    base_color_texture: picture,
                    specular_weight: max_reflectance,
                    specular_roughness: 0.0,
                    ..PrincipledMaterial::default()
                };
                vec![Lobe { layers: m, max_reflectance: if color == Vec3::ZERO { 0.0 } else { 1.0 } }]
            }
            "glass" => {
                let index = self.index_parameter(params, 1.5);
                let (reflected, through) =
                    (self.color_or_texture(params, "Kr", 1.0), self.color_or_texture(params, "Kt", 1.0));
                let smooth = ["uroughness", "vroughness"].iter().all(|name| {
                    params.get(name).is_none_or(|param| param.kind != Kind::Texture && param.number() == 0.0)
                });
                let rough = if smooth { None } else { Some(self.rough(params, None, true, 0.0)) };
                vec![Lobe { layers: glass(reflected, through, index, rough.as_ref()), max_reflectance: 1.0 }]
            }
            "disney" => return self.disney(params, at),
            "subsurface" | "kdsubsurface" => vec![self.subsurface(kind, params)],
            "mix" => return self.mix_of_two(params, at),
            "hair" => return self.hair(params, &["color"], at),
            "" | "none" => return MaterialDef::Interface,
            "fourier" => {
                params.mark_known(&["bsdffile"]);
                self.report.unsupported_once(at, "measured materials have no counterpart: diffuse grey is used");
                vec![Lobe { layers: matte(Vec3::splat(0.5)), max_reflectance: 1.0 }]
            }
            other => {
                let is_new = NEW_MATERIALS.contains(&other);
                let help =
                    if is_new { Some(format!("`{other}` is a pbrt-v4 material")) } else { suggest(other, MATERIALS) };
                self.no_material(other, at, help, is_new);
                params.mark_all_used();
                return MaterialDef::Interface;
            }
        };
        let mut bent = Vec::with_capacity(parts.len());
        for Lobe { mut layers, max_reflectance } in parts {
            self.surface(&mut layers, params, "bumpmap");
            bent.push(Lobe { layers, max_reflectance });
        }
        self.sum(bent, at)
    }

    /// Returns the Lambertian lobe whose colour is the parameter `name`.
    fn lambert(&mut self, params: &Params, name: &'static str, default: f32) -> Lobe {
        let (color, picture) = self.color_or_texture(params, name, default);
        let layers = PrincipledMaterial { base_color_texture: picture, ..matte(color) };
        Lobe { layers, max_reflectance: color.max_element() }
    }

    /// Returns the microfacet lobe whose colour is the parameter `name`, with the given index of
    /// refraction.
    fn gloss(&mut self, params: &Params, name: &'static str, (default, ior): (f32, f32), rough: &Roughness) -> Lobe {
        let color = self.color_or_texture(params, name, default);
        Lobe { max_reflectance: color.0.max_element(), layers: glossy(color, ior, rough) }
    }

    fn uber(&mut self, params: &Params) -> Vec<Lobe> {
        let rough = self.isotropic_roughness(params, Some("roughness"), true, 0.1);
        let index = self.index_parameter(params, 1.5);
        let smooth = Roughness::new([0.0; 2]);
        let mut parts = vec![self.lambert(params, "Kd", 0.25), self.gloss(params, "Ks", (0.25, index), &rough)];
        let (reflected, through) = (self.color_or_texture(params, "Kr", 0.0), self.color_or_texture(params, "Kt", 0.0));
        parts.push(match through.0 == Vec3::ZERO {
            true => Lobe { max_reflectance: reflected.0.max_element(), layers: glossy(reflected, index, &smooth) },
            false => {
                let max_reflectance = reflected.0.max_element().max(through.0.max_element());
                Lobe { max_reflectance, layers: glass(reflected, through, index, None) }
            }
        });
        let (share, picture) = match self.texture_value(params, "opacity", true, Vec3::ONE) {
            Texture::Constant(color) => (self.grey(params, "opacity", color), None),
            Texture::Picture(..) => (1.0, self.mapped_picture(params, "opacity", true, |x| x)),
        };
        for part in &mut parts {
            (part.layers.opacity, part.layers.opacity_texture) = (share, picture.clone());
        }
        parts
    }

    /// Returns diffuse reflection and diffuse transmission, with glossy microfacets on both sides.
    fn translucent(&mut self, params: &Params) -> Vec<Lobe> {
        let rough = self.rough(params, Some("roughness"), false, 0.1);
        let even = |reader: &mut Self, name, default| {
            reader.texture_value(params, name, true, Vec3::splat(default)).constant()
        };
        let [up, down] = ["reflect", "transmit"].map(|name| even(self, name, 0.5).unwrap_or(Vec3::splat(0.5)));
        let (color, picture) = self.color_or_texture(params, "Kd", 0.25);
        let sum = |color: Color| color.element_sum().max(1e-6);
        let layers = PrincipledMaterial {
            subsurface_weight: 1.0,
            subsurface_color: color * (up + down),
            subsurface_color_texture: picture,
            // A thin sheet has the same scattering ratio for all colours.
            subsurface_scatter_anisotropy: ((sum(down) - sum(up)) / (sum(down) + sum(up))).clamp(-0.999, 0.999),
            walls: Walls::Thin,
            ..matte(Vec3::ZERO)
        };
        let matte = Lobe { max_reflectance: (color * (up + down)).max_element(), layers };
        let (specular, picture) = self.color_or_texture(params, "Ks", 0.25);
        let gloss = glossy((up * specular, picture.clone()), 1.5, &rough);
        let mut parts = vec![matte, Lobe { max_reflectance: (up * specular).max_element(), layers: gloss }];
        // The microfacets also transmit light. In Dürer, the microfacets of a thin sheet do not
        // refract it.
        if (down * specular).max_element() > 0.0 {
            let what =
                "refraction by the glossy transmission of `translucent` has no counterpart: the light is not refracted";
            self.report.unsupported_once(params.at, what);
            let mut through = super::matte(Vec3::ZERO);
            (through.specular_weight, through.specular_color) = (1.0, Vec3::ZERO);
            (through.transmission_weight, through.walls) = (1.0, Walls::Thin);
            (through.transmission_color, through.transmission_color_texture) = (down * specular, picture);
            rough.apply(&mut through);
            parts.push(Lobe { max_reflectance: (down * specular).max_element(), layers: through });
        }
        parts
    }

    /// Returns subsurface scattering below a refractive boundary.
    fn subsurface(&mut self, kind: &str, params: &Params) -> Lobe {
        let rough = self.rough(params, None, true, 0.0);
        let mut m = PrincipledMaterial::default();
        rough.apply(&mut m);
        m.specular_ior = self.index_parameter(params, 1.33);
        params.warn_unsupported(&["Kr", "Kt"], "the boundary is not tinted");
        if kind == "kdsubsurface" {
            let color = self.color_or_texture(params, "Kd", 0.5);
            let path = params.spectrum("mfp").map_or(Vec3::ONE, |spectrum| spectrum.pbrt_v3_color());
            set_subsurface(&mut m, params, color, path);
        } else {
            m.transmission_weight = 1.0;
            medium_of(params, "name").fill(&mut m);
        }
        Lobe { layers: m, max_reflectance: 1.0 }
    }

    /// Returns the mean of a colour's components, for a parameter that must be a single number in
    /// Dürer.
    fn grey(&self, params: &Params, name: &'static str, color: Color) -> f32 {
        if color.max_element() - color.min_element() > 1e-3 {
            let what = format!("a coloured `{name}` has no counterpart: its mean is used");
            self.report.unsupported_once(params.span(name), what);
        }
        color.element_sum() / 3.0
    }

    /// Returns a mix of two named materials, in which `amount` is the share of the first.
    fn mix_of_two(&mut self, params: &Params, at: Span) -> MaterialDef {
        let share = |amount: f32| amount.clamp(0.0, 1.0);
        let amount = match self.texture_value(params, "amount", true, Vec3::splat(0.5)) {
            Texture::Constant(color) => (share(self.grey(params, "amount", color)), None),
            Texture::Picture(..) => (1.0, self.mapped_picture(params, "amount", true, share)),
        };
        let names = ["namedmaterial1", "namedmaterial2"].map(|name| (name, params.text(name).map(str::to_string)));
        let mut numbers = [0; 2];
        for (number, (name, value)) in numbers.iter_mut().zip(names) {
            let Some(value) = value else {
                self.report.error(at, format!("a mix needs `\"string {name}\"`"));
                return MaterialDef::Interface;
            };
            let place = params.get(name).map_or(at, |param| param.values_at);
            match self.known_material(&value, place) {
                Some(index) => *number = index,
                None => return MaterialDef::Interface,
            }
        }
        self.mix_by(numbers, amount, at)
    }
}
