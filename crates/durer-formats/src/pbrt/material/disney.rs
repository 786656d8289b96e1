//! Converts the `disney` material of pbrt-v3.
//!
//! Source: Burley, *Extending the Disney BRDF to a BSDF with Integrated Subsurface Scattering*,
//! SIGGRAPH courses, 2015, and *Physically Based Rendering*, 3rd edition.

use super::super::defs::MaterialDef;
use super::super::params::Params;
use super::super::state::Reader;
use super::rough::Roughness;
use crate::disney::DiffuseConverter;
use durer_diag::Span;
use durer_scene::bsdf::fresnel::schlick_82;
use durer_scene::material::PrincipledMaterial;
use durer_scene::material::principled::Walls;
use durer_scene::math::{Color, LUMINANCE, Vec3};

/// Mean albedo of Disney's sheen lobe with strength 1, divided by the mean albedo of the fuzz lobe.
/// The two mean albedos are averages over all directions.
const SHEEN: f32 = 0.1;

impl Reader<'_> {
    /// Converts `disney` to a base material, a metal, or a mix of both.
    pub(super) fn disney(&mut self, params: &Params, at: Span) -> MaterialDef {
        let (color, picture) = self.color_or_texture(params, "color", 0.5);
        let share = |reader: &Self, name, default| reader.value(params, name, default).clamp(0.0, 1.0);
        let roughness = share(self, "roughness", 0.5);
        let (anisotropic, metallic) = (share(self, "anisotropic", 0.0), share(self, "metallic", 0.0));
        let (sheen, tint) = (share(self, "sheen", 0.0), share(self, "sheentint", 0.5));
        let through = share(self, "spectrans", 0.0);
        let aspect = (1.0 - 0.9 * anisotropic).sqrt();
        let alpha = roughness * roughness;
        let alphas = [alpha / aspect, alpha * aspect].map(|alpha| alpha.clamp(1e-3, 1.0));
        let mut m = PrincipledMaterial {
            base_color: color,
            base_color_texture: picture.clone(),
            // Multiply each specular reflection by the colour a second time.
            specular_color: color,
            specular_color_texture: picture,
            specular_ior: self.index_parameter(params, 1.5),
            transmission_weight: through,
            transmission_color: color.map(|c| c.max(0.0).sqrt()),
            ..PrincipledMaterial::default()
        };
        Roughness::new(alphas).apply(&mut m);
        if sheen > 0.0 {
            let hue = color / color.dot(LUMINANCE).max(1e-6);
            let fuzz = Vec3::ONE.lerp(hue, tint);
            let most = fuzz.max_element().max(1e-6);
            (m.fuzz_weight, m.fuzz_color) = ((SHEEN * sheen * most).min(1.0), fuzz / most);
        }
        let clearcoat = share(self, "clearcoat", 0.0);
        if clearcoat > 0.0 {
            let gloss = share(self, "clearcoatgloss", 1.0);
            // The clearcoat reflects a quarter as much as a dielectric boundary, and it does not
            // attenuate the base.
            (m.coat_weight, m.coat_ior, m.coat_darkening) = (0.25 * clearcoat, 1.5, 0.0);
            m.coat_roughness = (0.1 + gloss * (0.001 - 0.1)).sqrt();
        }
        params.mark_known(&["speculartint", "clearcoatgloss"]);
        if share(self, "flatness", 0.0) > 0.0 {
            let what = "`flatness` has no counterpart: the base stays diffuse";
            self.report.unsupported_once(params.span("flatness"), what);
        }
        let distance = params.spectrum("scatterdistance").map_or(Color::ZERO, |spectrum| spectrum.pbrt_v3_color());
        let onwards = self.value(params, "difftrans", 1.0).clamp(0.0, 2.0);
        let thin = params.boolean("thin") == Some(true);
        if !thin && distance == Color::ZERO {
            m.base_color = DiffuseConverter::new(m.specular_ior, roughness).base(color);
        }
        if thin {
            m.walls = Walls::Thin;
            (m.subsurface_weight, m.subsurface_color) = (1.0, color);
            m.subsurface_color_texture.clone_from(&m.base_color_texture);
            m.subsurface_scatter_anisotropy = (onwards - 1.0).clamp(-0.999, 0.999);
        } else if distance.max_element() > 0.0 {
            m.subsurface_weight = 1.0;
            (m.subsurface_color, m.subsurface_color_texture) = (color.min(Vec3::ONE), m.base_color_texture.clone());
            (m.subsurface_radius, m.subsurface_radius_scale) = (1.0, distance.max(Vec3::splat(1e-6)));
        }
        self.surface(&mut m, params, "bumpmap");
        if metallic == 0.0 {
            return MaterialDef::Principled(Box::new(m), at);
        }
        // The other part is a metal. The reflectance of the metal is the colour times Schlick's
        // approximation for that colour.
        let mut metal = m.clone();
        let tinted = if metal.base_color_texture.is_some() { Vec3::ONE } else { color };
        metal.base_metalness = 1.0;
        metal.base_color = color * tinted;
        metal.specular_color = tinted * schlick_82(color) / schlick_82(metal.base_color).max(Vec3::splat(1e-6));
        (metal.specular_color_texture, metal.fuzz_weight) = (None, 0.0);
        (metal.transmission_weight, metal.subsurface_weight) = (0.0, 0.0);
        if metallic == 1.0 {
            return MaterialDef::Principled(Box::new(metal), at);
        }
        let numbers = [metal, m].map(|layers| {
            self.materials.push(MaterialDef::Principled(Box::new(layers), at));
            self.materials.len() - 1
        });
        self.mix(numbers, metallic, at)
    }
}
