//! Converts Disney's material, which Mitsuba calls `principled`.
//!
//! Source: Burley, *Physically-Based Shading at Disney*, SIGGRAPH 2012, and *Extending the Disney
//! BRDF to a BSDF*, 2015, with the parameters of *Mitsuba 3 documentation*.

use super::plugin::Plugin;
use super::state::Reader;
use durer_scene::material::PrincipledMaterial;
use durer_scene::material::principled::{Facets, Layering, Surroundings, Switch, Walls};
use durer_scene::math::{LUMINANCE, Vec3};

impl Reader<'_> {
    /// Converts `principled` and `principledthin`.
    pub fn principled(&mut self, plugin: &Plugin) -> PrincipledMaterial {
        let thin = plugin.kind == "principledthin";
        let (base_color, base_color_texture) = self.color_or_texture(plugin, "base_color", 0.5);
        let whole = |x: f32| x.clamp(0.0, 1.0);
        let (roughness, roughness_texture) = self.number_or_texture(plugin, "roughness", 0.5, whole);
        let (metalness, metalness_texture) = self.number_or_texture(plugin, "metallic", 0.0, whole);
        let share = |name, default: f32| self.value(plugin, name, default).clamp(0.0, 1.0);
        // Disney's alpha is the square of the roughness, and the aspect ratio stretches it along
        // one direction.
        let aspect = (1.0 - 0.9 * share("anisotropic", 0.0)).sqrt();
        let [u, v] = [roughness * roughness / aspect, roughness * roughness * aspect];
        let luminance = base_color.dot(LUMINANCE);
        let hue = if luminance > 0.0 { base_color / luminance } else { Vec3::ONE };
        let clear = share("spec_trans", 0.0);
        let ior = match plugin.get("eta") {
            Some(_) => self.value(plugin, "eta", 1.5).max(1e-3),
            None if thin => 1.5,
            // The reflectance at normal incidence is 0.08 times `specular`. Glass needs some.
            None => {
                let least = if clear > 0.0 { 1e-3 } else { 0.0 };
                let root = (0.08 * share("specular", 0.5).max(least)).sqrt();
                (1.0 + root) / (1.0 - root)
            }
        };
        let sheen_tint = share("sheen_tint", 0.0);
        if sheen_tint > 0.0 && base_color_texture.is_some() {
            self.report.unsupported_once(
                plugin.span("sheen_tint"),
                "`sheen_tint` with a picture for `base_color` has no counterpart: the sheen is white",
            );
        }
        // With a value of 0, all diffuse light leaves on the side from which it came. With a value
        // of 2, all of it leaves on the other side.
        let through = if thin { self.value(plugin, "diff_trans", 0.0).clamp(0.0, 2.0) } else { 0.0 };
        let m = PrincipledMaterial {
            layering: Layering::Disney,
            base_color,
            base_color_texture,
            base_flatness: share("flatness", 0.0),
            subsurface_weight: through.min(1.0),
            subsurface_color: base_color,
            subsurface_scatter_anisotropy: (through - 1.0).max(0.0),
            base_metalness: if thin { 0.0 } else { metalness },
            base_metalness_texture: metalness_texture.filter(|_| !thin),
            specular_weight: if thin { 0.0 } else { 1.0 },
            specular_ior: ior,
            specular_tint: share("spec_tint", 0.0),
            specular_roughness: (0.5 * (u * u + v * v)).sqrt().clamp(1e-3, 1.0).sqrt(),
            specular_roughness_texture: roughness_texture,
            specular_anisotropy: 1.0 - v / u.max(1e-12),
            energy_compensation: Switch::Off,
            specular_facets: Facets::GgxSeparable,
            surroundings: Surroundings::Ignored,
            transmission_weight: clear,
            // Light crosses two surfaces of Disney's glass, and each multiplies it by the square
            // root of the colour.
            transmission_color: if thin { base_color } else { base_color.map(f32::sqrt) }.clamp(Vec3::ZERO, Vec3::ONE),
            coat_weight: if thin { 0.0 } else { share("clearcoat", 0.0) },
            coat_ior: 1.5,
            coat_darkening: 0.0,
            coat_roughness: (0.1 + share("clearcoat_gloss", 0.0) * (0.001 - 0.1)).sqrt(),
            fuzz_weight: share("sheen", 0.0),
            fuzz_color: Vec3::ONE.lerp(hue, sheen_tint),
            walls: if thin { Walls::Thin } else { Walls::Solid },
            ..PrincipledMaterial::default()
        };
        plugin.mark_known(&[
            "diffuse_reflectance_sampling_rate",
            "main_specular_sampling_rate",
            "clearcoat_sampling_rate",
        ]);
        m
    }
}
