//! Converts Disney's material, which Mitsuba calls `principled`.
//!
//! Source: Burley, *Physically-Based Shading at Disney*, SIGGRAPH 2012, and *Extending the Disney
//! BRDF to a BSDF*, 2015, with the parameters of *Mitsuba 3 documentation*.

use super::plugin::Plugin;
use super::state::Reader;
use crate::disney::{self, DiffuseConverter};
use durer_scene::bsdf::fresnel::ior_of_reflectance;
use durer_scene::material::PrincipledMaterial;
use durer_scene::material::principled::{Facets, Surroundings, Switch, Walls};
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
        let luminance = base_color.dot(LUMINANCE).max(1e-6);
        let tinted = |tint: f32| Vec3::ONE.lerp(base_color / luminance, tint).clamp(Vec3::ZERO, Vec3::ONE);
        let ior = match plugin.get("eta") {
            Some(_) => self.value(plugin, "eta", 1.5).max(1e-3),
            // The reflectance at normal incidence is 0.08 times `specular`.
            None => {
                let root = (0.08 * share("specular", 0.5)).sqrt();
                (1.0 + root) / (1.0 - root)
            }
        };
        let clear = share("spec_trans", 0.0);
        let metallic = if thin { 0.0 } else { metalness };
        // If the roughness is given by a picture, assume a medium roughness.
        let rough = if roughness_texture.is_some() { 0.5 } else { roughness };
        let matte = match (thin, &metalness_texture) {
            (true, _) => disney::diffuse_albedo(rough) * base_color,
            (false, Some(_)) => base_color,
            (false, None) => base_color.lerp(DiffuseConverter::new(ior, rough).base(base_color), 1.0 - metallic),
        };
        let sheen = share("sheen", 0.0);
        let fuzz_weight = if sheen > 0.0 { sheen * disney::fuzz_weight_of_sheen() } else { 0.0 };
        // With a value of 0, all diffuse light leaves on the side from which it came. With a value
        // of 2, all of it leaves on the other side.
        let through = if thin { self.value(plugin, "diff_trans", 0.0).clamp(0.0, 2.0) } else { 0.0 };
        let m = PrincipledMaterial {
            base_color: matte,
            base_color_texture: base_color_texture.clone(),
            subsurface_weight: through.min(1.0),
            subsurface_color: matte,
            subsurface_color_texture: base_color_texture.filter(|_| through > 0.0),
            subsurface_scatter_anisotropy: (through - 1.0).max(0.0),
            base_metalness: metallic,
            base_metalness_texture: metalness_texture.filter(|_| !thin),
            // A thin sheet reflects light specularly only if it has `spec_trans`.
            specular_weight: if thin { 0.0 } else { 1.0 },
            specular_ior: if thin { thin_pane_index(ior) } else { ior },
            specular_color: tinted(share("spec_tint", 0.0)),
            specular_roughness: (0.5 * (u * u + v * v)).sqrt().min(1.0).sqrt(),
            specular_roughness_texture: roughness_texture,
            specular_anisotropy: 1.0 - v / u.max(1e-12),
            energy_compensation: Switch::Off,
            specular_facets: Facets::GgxSeparable,
            surroundings: Surroundings::Ignored,
            transmission_weight: clear,
            // Light crosses two surfaces of Disney's glass, and each multiplies it by the square
            // root of the colour.
            transmission_color: if thin { base_color } else { base_color.map(f32::sqrt) }.clamp(Vec3::ZERO, Vec3::ONE),
            // The coat has a quarter of the weight and an index of refraction of 1.5.
            coat_weight: if thin { 0.0 } else { 0.25 * share("clearcoat", 0.0) },
            coat_ior: 1.5,
            coat_darkening: 0.0,
            coat_roughness: (0.1 + share("clearcoat_gloss", 0.0) * (0.001 - 0.1)).sqrt(),
            fuzz_weight,
            fuzz_roughness: disney::FUZZ_ROUGHNESS,
            fuzz_color: tinted(share("sheen_tint", 0.0)),
            walls: if thin { Walls::Thin } else { Walls::Solid },
            ..PrincipledMaterial::default()
        };
        let none = "the base stays diffuse";
        plugin.warn_unsupported(self.report, &["flatness"], none);
        plugin.mark_known(&[
            "diffuse_reflectance_sampling_rate",
            "main_specular_sampling_rate",
            "clearcoat_sampling_rate",
        ]);
        m
    }
}

/// Returns the index of refraction of a thin pane that reflects as much light at normal incidence
/// as a single surface with the index `ior`, because `principledthin` has no second surface.
fn thin_pane_index(ior: f32) -> f32 {
    let root = (ior - 1.0) / (ior + 1.0);
    let r0 = root * root;
    ior_of_reflectance(r0 / (2.0 - r0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_sided_pane_reflects_like_one_surface() {
        let root = (thin_pane_index(1.5) - 1.0) / (thin_pane_index(1.5) + 1.0);
        let r = root * root;
        assert!((2.0 * r / (1.0 + r) - 0.04).abs() < 1e-5, "{r}");
    }
}
