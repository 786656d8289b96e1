//! Disney's material, which Mitsuba calls `principled`.
//!
//! Source: Burley, *Physically-Based Shading at Disney*, SIGGRAPH 2012, and *Extending the Disney
//! BRDF to a BSDF*, 2015, as *Mitsuba 3 documentation* has their parameters.

use super::plugin::Plugin;
use super::state::Reader;
use crate::material::PrincipledMaterial;
use crate::material::principled::Walls;
use crate::math::{LUMINANCE, Vec3};

impl Reader<'_> {
    /// The layers of `principled` and `principledthin`.
    pub fn principled(&mut self, plugin: &Plugin) -> PrincipledMaterial {
        let thin = plugin.kind == "principledthin";
        let (base_color, base_color_texture) = self.colored(plugin, "base_color", 0.5);
        let whole = |x: f32| x.clamp(0.0, 1.0);
        let (roughness, roughness_texture) = self.pictured(plugin, "roughness", 0.5, whole);
        let (metalness, metalness_texture) = self.pictured(plugin, "metallic", 0.0, whole);
        let share = |name, usual: f32| self.value(plugin, name, usual).clamp(0.0, 1.0);
        // Disney's alpha is the square of the roughness, stretched by the aspect.
        let aspect = (1.0 - 0.9 * share("anisotropic", 0.0)).sqrt();
        let [u, v] = [roughness * roughness / aspect, roughness * roughness * aspect];
        let sheen = share("sheen", 0.0);
        let luminance = base_color.dot(LUMINANCE).max(1e-6);
        let tinted = |tint: f32| Vec3::ONE.lerp(base_color / luminance, tint).clamp(Vec3::ZERO, Vec3::ONE);
        let ior = match plugin.get("eta") {
            Some(_) => self.value(plugin, "eta", 1.5),
            // The reflectance at right angles is 0.08 times `specular`.
            None => {
                let root = (0.08 * share("specular", 0.5)).sqrt();
                (1.0 + root) / (1.0 - root)
            }
        };
        let clear = share("spec_trans", 0.0);
        let m = PrincipledMaterial {
            base_color,
            base_color_texture,
            base_metalness: if thin { 0.0 } else { metalness },
            base_metalness_texture: metalness_texture.filter(|_| !thin),
            base_diffuse_roughness: roughness,
            base_diffuse_roughness_texture: roughness_texture.clone(),
            specular_ior: ior.max(1e-3),
            specular_color: tinted(share("spec_tint", 0.0)),
            specular_roughness: (0.5 * (u * u + v * v)).sqrt().min(1.0).sqrt(),
            specular_roughness_texture: roughness_texture,
            specular_anisotropy: 1.0 - v / u.max(1e-12),
            transmission_weight: clear,
            // Disney's glass takes the root of the colour at each of two surfaces.
            transmission_color: if thin { base_color } else { base_color.map(f32::sqrt) }.clamp(Vec3::ZERO, Vec3::ONE),
            // The coat has a quarter of the weight, and an index of 1.5.
            coat_weight: if thin { 0.0 } else { 0.25 * share("clearcoat", 0.0) },
            coat_ior: 1.5,
            coat_darkening: 0.0,
            coat_roughness: (0.1 + share("clearcoat_gloss", 0.0) * (0.001 - 0.1)).sqrt(),
            fuzz_weight: sheen,
            fuzz_color: tinted(share("sheen_tint", 0.0)),
            walls: if thin { Walls::Thin } else { Walls::Solid },
            ..PrincipledMaterial::default()
        };
        let none = "the surface is Lambert's below its boundary";
        plugin.left_out(self.said, &["flatness"], none);
        plugin.left_out(self.said, &["diff_trans"], "matte light stays on its side");
        plugin.known(&["diffuse_reflectance_sampling_rate", "main_specular_sampling_rate", "clearcoat_sampling_rate"]);
        m
    }
}
