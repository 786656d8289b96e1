//! Converts OpenPBR parameters to metallic-roughness materials and KHR extensions. The conversion
//! is the inverse of that in the reader.

use super::Writer;
use crate::export::layers::principled_of_phong;
use durer_scene::bsdf::lobe::hair::Fibre;
use durer_scene::bsdf::microfacet::Ggx;
use durer_scene::describe::FileName;
use durer_scene::material::parameters::TEXTURE_FIELDS;
use durer_scene::material::principled::{Backs, Layering, Switch, Walls};
use durer_scene::material::{Pattern, PrincipledMaterial};
use durer_scene::math::{Vec2, Vec3};
use durer_scene::scene::{Material, TextureImage};
use durer_scene::texture::{Channel, Mapping};
use serde_json::{Map, Value, json};
use std::f32::consts::TAU;

impl Writer<'_> {
    /// Returns the index of the glTF material for a scene material, which is written when it is
    /// used for the first time. `has_alpha` is true if any of the vertex colours is not opaque.
    pub(super) fn material(&mut self, number: u32, has_alpha: bool) -> Option<usize> {
        if let Some(cached) = self.materials.get(&number) {
            return *cached;
        }
        let scene = self.scene;
        let index = match &scene.materials.get(number as usize)?.value {
            Material::Principled(layers) if layers.layering == Layering::Disney => {
                Some(self.layers(&crate::disney::as_layers(layers), has_alpha))
            }
            Material::Principled(layers) => Some(self.layers(layers, has_alpha)),
            Material::Phong(phong, noise) => {
                if noise.is_some() {
                    self.warn_lost("glTF has no noise: the material's own colour is written");
                }
                Some(self.layers(&principled_of_phong(phong), has_alpha))
            }
            Material::Hair(hair) => {
                self.warn_lost("glTF has no hair: a matte colour is written");
                let base_color = Fibre::new(hair).color();
                let matte = PrincipledMaterial { base_color, specular_roughness: 1.0, ..PrincipledMaterial::default() };
                Some(self.layers(&matte, has_alpha))
            }
            Material::Solid(solid, _) => {
                self.warn_lost("glTF has no patterns of two materials: the first material is written");
                let first = solid.materials()[0];
                // A pattern can refer only to earlier materials, so the recursion ends.
                if first < number { self.material(first, has_alpha) } else { None }
                    .and_then(|at| self.lists.get("materials")?.get(at).cloned())
            }
        };
        let index = index.map(|material| self.add("materials", material));
        self.materials.insert(number, index);
        index
    }

    fn layers(&mut self, m: &PrincipledMaterial, has_alpha: bool) -> Value {
        let solid = m.walls == Walls::Solid;
        let clear = m.transmission_weight > 0.0;
        // In glTF, both sides of a surface emit light unless the back side is culled.
        let dark_backs = solid && !clear && m.emission_luminance > 0.0;
        let mut material = json!({ "doubleSided": m.backs == Backs::Shown && !dark_backs });
        let mut extensions = Map::new();
        let unlit = m.emission_luminance == 1.0 && m.base_weight == 0.0 && m.specular_weight == 0.0;
        // In glTF, the base colour tints transmitted light.
        let tinted = clear && m.transmission_depth == 0.0;
        let base = match (unlit, tinted) {
            (true, _) => m.emission_color,
            (false, true) if m.transmission_weight >= 0.5 => m.transmission_color,
            _ => m.base_weight * m.base_color,
        };
        // The metals of glTF have neither a specular weight nor a tint.
        let textured = m.metallic_roughness_texture.is_some() || m.base_metalness_texture.is_some();
        let is_metal = m.base_metalness == 1.0 && !textured;
        let base = if is_metal { m.specular_weight.min(1.0) * base } else { base };
        let [r, g, b] = base.clamp(Vec3::ZERO, Vec3::ONE).to_array();
        let (roughness, strength) = gltf_roughness(m);
        let mut pbr = json!({
            "baseColorFactor": [r, g, b, m.opacity], "metallicFactor": m.base_metalness, "roughnessFactor": roughness,
        });
        let mut blended = has_alpha || m.opacity < 1.0;
        if let Some((info, mapping)) = self.texture(m.base_color_texture.as_ref()) {
            pbr["baseColorTexture"] = info;
            match mapping.cutoff {
                None => blended = true,
                Some(cutoff) if cutoff > 0.0 => {
                    material["alphaMode"] = "MASK".into();
                    material["alphaCutoff"] = cutoff.into();
                }
                Some(_) => {}
            }
        }
        if blended && material.get("alphaMode").is_none() {
            material["alphaMode"] = "BLEND".into();
        }
        if let Some((info, _)) = self.texture(m.metallic_roughness_texture.as_ref()) {
            pbr["metallicRoughnessTexture"] = info;
        }
        material["pbrMetallicRoughness"] = pbr;
        if let Some((mut info, mapping)) = self.texture(m.normal_texture.as_ref()) {
            info["scale"] = mapping.strength.into();
            material["normalTexture"] = info;
        }
        let mut extend = |name: &'static str, value: Value| extensions.insert(name.into(), value);
        if unlit {
            extend("KHR_materials_unlit", json!({}));
        } else if m.emission_luminance > 0.0 {
            let most = m.emission_color.max_element().max(1.0);
            let strength = m.emission_luminance * most;
            material["emissiveFactor"] = json!((m.emission_color / most).max(Vec3::ZERO).to_array());
            if strength != 1.0 {
                extend("KHR_materials_emissive_strength", json!({ "emissiveStrength": strength }));
            }
        }
        if m.specular_ior != 1.5 {
            extend("KHR_materials_ior", json!({ "ior": m.specular_ior.max(1.0) }));
        }
        let pictured = m.specular_weight_texture.is_some() || m.specular_color_texture.is_some();
        if !is_metal && (m.specular_weight != 1.0 || m.specular_color != Vec3::ONE || pictured) {
            // A weight above 1 is multiplied into the colour, which has no upper limit.
            let weight = m.specular_weight.min(1.0);
            let color = m.specular_color * (m.specular_weight / weight.max(1e-6)).max(1.0);
            let value = json!({ "specularFactor": weight, "specularColorFactor": color.to_array() });
            extend("KHR_materials_specular", value);
        }
        if clear {
            extend("KHR_materials_transmission", json!({ "transmissionFactor": m.transmission_weight }));
            if solid {
                let mut volume = json!({ "thicknessFactor": 1.0 });
                if m.transmission_depth > 0.0 {
                    volume["attenuationDistance"] = m.transmission_depth.into();
                    volume["attenuationColor"] = json!(m.transmission_color.to_array());
                }
                extend("KHR_materials_volume", volume);
            }
        }
        if m.disperses() {
            // Source: KHR_materials_dispersion, which defines dispersion as 20 divided by the Abbe
            // number.
            let dispersion = 20.0 * m.transmission_dispersion_scale / m.transmission_dispersion_abbe_number;
            extend("KHR_materials_dispersion", json!({ "dispersion": dispersion }));
        }
        if m.coat_weight > 0.0 {
            let coat = json!({ "clearcoatFactor": m.coat_weight, "clearcoatRoughnessFactor": m.coat_roughness });
            extend("KHR_materials_clearcoat", coat);
        }
        if m.fuzz_weight > 0.0 {
            let color = (m.fuzz_weight * m.fuzz_color).clamp(Vec3::ZERO, Vec3::ONE);
            let fuzz = json!({ "sheenColorFactor": color.to_array(), "sheenRoughnessFactor": m.fuzz_roughness });
            extend("KHR_materials_sheen", fuzz);
        }
        if m.specular_anisotropy > 0.0 {
            let turn = m.specular_rotation * TAU;
            let value = json!({ "anisotropyStrength": strength, "anisotropyRotation": turn });
            extend("KHR_materials_anisotropy", value);
        }
        if m.thin_film_weight > 0.0 {
            // Convert micrometres to nanometres.
            let thickness = 1000.0 * m.thin_film_thickness;
            let film = json!({
                "iridescenceFactor": m.thin_film_weight, "iridescenceIor": m.thin_film_ior,
                "iridescenceThicknessMinimum": thickness, "iridescenceThicknessMaximum": thickness,
            });
            extend("KHR_materials_iridescence", film);
        }
        let sheet = !solid && m.subsurface_scatter_anisotropy > 0.999;
        if m.subsurface_weight > 0.0 && sheet {
            let value = json!({
                "diffuseTransmissionFactor": m.subsurface_weight,
                "diffuseTransmissionColorFactor": m.subsurface_color.to_array(),
            });
            extend("KHR_materials_diffuse_transmission", value);
        }
        for row in TEXTURE_FIELDS.iter().filter(|row| row.field != "base_color_texture") {
            let Some(name) = (row.texture_file)(m) else { continue };
            if !self.add_picture(m, row.field, name, &mut extensions) {
                self.warn_lost(format!("glTF has no texture for `{}`: it is left out", row.field));
            }
        }
        if dark_backs && m.backs == Backs::Shown {
            self.warn_lost("glTF has no one-sided emitters: the back side is left out");
        }
        if is_metal && m.specular_color != Vec3::ONE {
            self.warn_lost("glTF metals have no tint at grazing angles: it is left out");
        }
        if m.seen_by_camera == Switch::Off {
            self.warn_lost("glTF has no surfaces that the camera does not see: they are visible");
        }
        if m.bump_texture.is_some() || m.opacity_texture.is_some() {
            self.warn_lost("glTF has no bump or opacity textures: they are left out");
        }
        if (m.subsurface_weight > 0.0 && !sheet) || (clear && m.transmission_scatter != Vec3::ZERO) {
            self.warn_lost("glTF has no subsurface scattering: it is left out");
        }
        if !unlit
            && m.emission_luminance > 0.0
            && let Some((info, _)) = self.texture(m.emission_texture.as_ref())
        {
            material["emissiveTexture"] = info;
        }
        if !extensions.is_empty() {
            self.extensions.extend(EXTENSIONS.iter().filter(|name| extensions.contains_key(**name)));
            material["extensions"] = extensions.into();
        }
        material
    }

    /// Adds the texture of a parameter to its extension. Returns false if no extension has an
    /// equivalent texture.
    fn add_picture(
        &mut self,
        m: &PrincipledMaterial,
        field: &str,
        name: &FileName,
        extensions: &mut Map<String, Value>,
    ) -> bool {
        match field {
            // In glTF, the base colour texture has this role, and it has already been written.
            "transmission_color_texture" => return m.base_color_texture.as_ref() == Some(name),
            // In glTF, the texture of the anisotropy strength also contains the rotation.
            "specular_rotation_texture" if m.specular_anisotropy_texture.is_some() => return true,
            _ => {}
        }
        let Some((_, extension, key, channel)) = PICTURES.into_iter().find(|row| row.0 == field) else { return false };
        let Some(value) = extensions.get_mut(extension) else { return false };
        let TextureImage { bytes, mapping } = self.export.picture(name);
        let fits = match field {
            // The rotation must be in the same texture as the anisotropy strength.
            "specular_anisotropy_texture" => {
                let turned = TextureImage { bytes, mapping: Mapping { channel: Some(Channel::Angle), ..mapping } };
                m.specular_rotation_texture.as_ref().is_some_and(|turns| self.export.picture(turns) == turned)
            }
            "thin_film_thickness_texture" => mapping.range[1] == 1.0,
            _ => mapping.range == [0.0, 1.0],
        };
        if !fits || channel != channel.map(|_| mapping.channel.unwrap_or(Channel::Red)) {
            return false;
        }
        let Some((info, _)) = self.texture(Some(name)) else { return false };
        value[key] = info;
        if field == "thin_film_thickness_texture" {
            value["iridescenceThicknessMinimum"] = (1000.0 * mapping.range[0] * m.thin_film_thickness).into();
        }
        true
    }
}

/// Returns the roughness and the anisotropy strength as glTF defines them.
fn gltf_roughness(m: &PrincipledMaterial) -> (f32, f32) {
    let pictured = m.metallic_roughness_texture.is_some()
        || m.specular_roughness_texture.is_some()
        || m.specular_anisotropy_texture.is_some();
    if m.specular_anisotropy == 0.0 || pictured {
        return (m.specular_roughness, m.specular_anisotropy);
    }
    // In glTF, the roughness determines alpha across the highlight. Alpha along the highlight
    // increases towards 1 with the anisotropy strength.
    let Vec2 { x: along, y: across } = Ggx::new(m.specular_roughness, m.specular_anisotropy).alpha;
    if across >= 1.0 {
        return (1.0, 0.0);
    }
    (across.sqrt(), ((along - across) / (1.0 - across)).max(0.0).sqrt())
}

/// Textures of parameters. Each entry has the field, the extension, the key in the extension, and
/// the channel.
const PICTURES: [(&str, &str, &str, Option<Channel>); 11] = [
    ("specular_weight_texture", "KHR_materials_specular", "specularTexture", Some(Channel::Alpha)),
    ("specular_color_texture", "KHR_materials_specular", "specularColorTexture", None),
    ("specular_anisotropy_texture", "KHR_materials_anisotropy", "anisotropyTexture", Some(Channel::Blue)),
    ("transmission_weight_texture", "KHR_materials_transmission", "transmissionTexture", Some(Channel::Red)),
    ("subsurface_color_texture", "KHR_materials_diffuse_transmission", "diffuseTransmissionColorTexture", None),
    ("coat_weight_texture", "KHR_materials_clearcoat", "clearcoatTexture", Some(Channel::Red)),
    ("coat_roughness_texture", "KHR_materials_clearcoat", "clearcoatRoughnessTexture", Some(Channel::Green)),
    ("fuzz_color_texture", "KHR_materials_sheen", "sheenColorTexture", None),
    ("fuzz_roughness_texture", "KHR_materials_sheen", "sheenRoughnessTexture", Some(Channel::Alpha)),
    ("thin_film_weight_texture", "KHR_materials_iridescence", "iridescenceTexture", Some(Channel::Red)),
    ("thin_film_thickness_texture", "KHR_materials_iridescence", "iridescenceThicknessTexture", Some(Channel::Green)),
];

/// Extensions that the writer can use for materials and lights.
const EXTENSIONS: [&str; 13] = [
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_volume",
    "KHR_lights_punctual",
];
