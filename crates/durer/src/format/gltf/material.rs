//! Materials: metallic-roughness and the KHR extensions, in the words of OpenPBR.
//!
//! Sources: *glTF 2.0 Specification*, chapter 3.9 and appendix B; the KHR_materials extensions; how they meet OpenPBR:
//! *OpenPBR Surface specification* 1.1, section on translation of other models.

use super::Model;
use super::json::At;
use crate::material::PrincipledMaterial;
use crate::material::principled::Walls;
use crate::math::Vec3;
use std::f32::consts::TAU;

/// What of KHR materials has no counterpart, and what is seen instead.
const WITHOUT_COUNTERPART: [(&str, &str); 4] = [
    ("KHR_materials_iridescence", "iridescence is left out"),
    ("KHR_materials_dispersion", "dispersion is left out: all colours bend alike"),
    ("KHR_materials_diffuse_transmission", "diffuse transmission is left out: the surface lets no light through"),
    ("KHR_materials_subsurface", "scattering below the surface is left out"),
];

/// Textures of extensions that are not read, by extension.
const TEXTURES: [(&str, &[&str]); 6] = [
    ("KHR_materials_specular", &["specularTexture", "specularColorTexture"]),
    ("KHR_materials_transmission", &["transmissionTexture"]),
    ("KHR_materials_volume", &["thicknessTexture"]),
    ("KHR_materials_clearcoat", &["clearcoatTexture", "clearcoatRoughnessTexture", "clearcoatNormalTexture"]),
    ("KHR_materials_sheen", &["sheenColorTexture", "sheenRoughnessTexture"]),
    ("KHR_materials_anisotropy", &["anisotropyTexture"]),
];

/// How alpha is meant.
#[derive(Clone, Copy, PartialEq)]
enum Alpha {
    Opaque,
    Mask,
    Blend,
}

impl Model<'_> {
    pub(super) fn materials(&self, root: &At) -> Vec<PrincipledMaterial> {
        let Some(materials) = root.get("materials") else { return Vec::new() };
        materials.items().map(|material| self.material(&material)).collect()
    }

    fn material(&self, at: &At) -> PrincipledMaterial {
        // glTF's own default: white, wholly metal and wholly rough, of ior 1.5.
        let mut m = PrincipledMaterial {
            base_color: Vec3::ONE,
            base_metalness: 1.0,
            specular_roughness: 1.0,
            ..PrincipledMaterial::default()
        };
        if at.object().is_none() {
            return m;
        }
        let words = [("OPAQUE", Alpha::Opaque), ("MASK", Alpha::Mask), ("BLEND", Alpha::Blend)];
        let alpha = at.get("alphaMode").and_then(|mode| mode.word(&words)).unwrap_or(Alpha::Opaque);
        let cutoff = at.get("alphaCutoff").and_then(|cutoff| cutoff.within(0.0..)).unwrap_or(0.5);
        let extensions = at.get("extensions");
        let extension = |name| extensions.as_ref().and_then(|extensions| extensions.get(name));
        let glossiness = extension("KHR_materials_pbrSpecularGlossiness");
        match (&glossiness, at.get("pbrMetallicRoughness")) {
            (Some(old), _) => self.glossy(&mut m, old, alpha, cutoff),
            (None, Some(pbr)) => self.metallic(&mut m, &pbr, alpha, cutoff),
            (None, None) => {}
        }
        if alpha == Alpha::Opaque {
            m.opacity = 1.0;
        }
        m.normal_texture = at.get("normalTexture").and_then(|texture| {
            let strength = texture.get("scale").and_then(|scale| scale.number()).unwrap_or(1.0);
            self.texture(&texture, |mapping| mapping.strength = strength)
        });
        let strength = extension("KHR_materials_emissive_strength");
        let strength = strength.and_then(|e| e.get("emissiveStrength")?.within(0.0..)).unwrap_or(1.0);
        let emissive = at.get("emissiveFactor").and_then(|factor| color(&factor)).unwrap_or(Vec3::ZERO);
        if emissive != Vec3::ZERO {
            (m.emission_luminance, m.emission_color) = (strength, emissive);
            m.emission_texture = at.get("emissiveTexture").and_then(|texture| self.texture(&texture, |_| ()));
        }
        if let Some(extensions) = &extensions {
            self.extended(&mut m, extensions);
        }
        m
    }

    fn metallic(&self, m: &mut PrincipledMaterial, pbr: &At, alpha: Alpha, cutoff: f32) {
        let factor = pbr.get("baseColorFactor").and_then(|factor| factor.numbers::<4>()).unwrap_or([1.0; 4]);
        m.base_color = Vec3::new(factor[0], factor[1], factor[2]);
        self.base(m, pbr.get("baseColorTexture"), factor[3], alpha, cutoff);
        m.base_metalness = share(pbr, "metallicFactor", 1.0);
        m.specular_roughness = share(pbr, "roughnessFactor", 1.0);
        m.metallic_roughness_texture =
            pbr.get("metallicRoughnessTexture").and_then(|texture| self.texture(&texture, |_| ()));
    }

    /// The base colour's texture, and what its alpha and that of the factor make of opacity.
    fn base(&self, m: &mut PrincipledMaterial, texture: Option<At>, factor: f32, alpha: Alpha, cutoff: f32) {
        // The texture's alpha times the factor is compared with the cutoff.
        let least = match alpha {
            Alpha::Opaque => Some(0.0),
            Alpha::Mask if factor > 0.0 => Some(cutoff / factor),
            Alpha::Mask => Some(if cutoff > 0.0 { 2.0 } else { 0.0 }),
            Alpha::Blend => None,
        };
        m.base_color_texture = texture.and_then(|texture| self.texture(&texture, |mapping| mapping.cutoff = least));
        m.opacity = match alpha {
            Alpha::Opaque => 1.0,
            Alpha::Mask if m.base_color_texture.is_some() || factor >= cutoff => 1.0,
            Alpha::Mask => 0.0,
            Alpha::Blend => factor.clamp(0.0, 1.0),
        };
    }

    /// KHR_materials_pbrSpecularGlossiness: what reflects at right angles is a colour of its own.
    fn glossy(&self, m: &mut PrincipledMaterial, old: &At, alpha: Alpha, cutoff: f32) {
        let factor = old.get("diffuseFactor").and_then(|factor| factor.numbers::<4>()).unwrap_or([1.0; 4]);
        let specular = old.get("specularFactor").and_then(|factor| color(&factor)).unwrap_or(Vec3::ONE);
        m.base_color = Vec3::new(factor[0], factor[1], factor[2]);
        m.base_metalness = 0.0;
        m.specular_roughness = 1.0 - share(old, "glossinessFactor", 1.0);
        let most = specular.max_element();
        // Ior 1.5 reflects 0.04 at right angles.
        m.specular_weight = most / 0.04;
        m.specular_color = if most > 0.0 { specular / most } else { Vec3::ONE };
        if most > 0.5 && m.base_color.max_element() < 0.2 {
            (m.base_color, m.base_metalness, m.specular_weight, m.specular_color) = (specular, 1.0, 1.0, Vec3::ONE);
        }
        self.base(m, old.get("diffuseTexture"), factor[3], alpha, cutoff);
        if let Some(texture) = old.get("specularGlossinessTexture") {
            texture.warning("NO_COUNTERPART", "this texture has no counterpart: only the factors count");
        }
    }

    fn extended(&self, m: &mut PrincipledMaterial, extensions: &At) {
        for (name, textures) in TEXTURES {
            let Some(extension) = extensions.get(name) else { continue };
            for texture in textures.iter().filter_map(|key| extension.get(key)) {
                texture
                    .warning("NO_COUNTERPART", format!("this texture of {name} is left out: only its factor counts"));
            }
        }
        for (name, message) in WITHOUT_COUNTERPART {
            if extensions.get(name).is_some() {
                self.once(name, message);
            }
        }
        if let Some(e) = extensions.get("KHR_materials_ior") {
            // 0 stands for an index without bound, which reflects everything.
            m.specular_ior = match e.get("ior") {
                Some(ior) if ior.value.as_f64() == Some(0.0) => 1e4,
                ior => ior.and_then(|ior| ior.within(1.0..)).unwrap_or(1.5),
            };
        }
        if let Some(e) = extensions.get("KHR_materials_specular") {
            m.specular_weight = share(&e, "specularFactor", 1.0);
            m.specular_color = e.get("specularColorFactor").and_then(|factor| color(&factor)).unwrap_or(Vec3::ONE);
        }
        if let Some(e) = extensions.get("KHR_materials_transmission") {
            m.transmission_weight = share(&e, "transmissionFactor", 0.0);
            // Light that passes takes on the base colour.
            m.transmission_color = m.base_color;
            m.walls = Walls::Thin;
        }
        if let Some(e) = extensions.get("KHR_materials_volume") {
            let thickness = e.get("thicknessFactor").and_then(|thickness| thickness.within(0.0..)).unwrap_or(0.0);
            let depth = e.get("attenuationDistance").and_then(|distance| distance.within(f32::MIN_POSITIVE..));
            let tint = e.get("attenuationColor").and_then(|factor| color(&factor)).unwrap_or(Vec3::ONE);
            if thickness > 0.0 {
                m.walls = Walls::Solid;
                if let Some(depth) = depth {
                    (m.transmission_depth, m.transmission_color) = (depth, tint);
                }
            }
        }
        if let Some(e) = extensions.get("KHR_materials_clearcoat") {
            m.coat_weight = share(&e, "clearcoatFactor", 0.0);
            m.coat_roughness = share(&e, "clearcoatRoughnessFactor", 0.0);
            (m.coat_ior, m.coat_darkening) = (1.5, 0.0);
        }
        if let Some(e) = extensions.get("KHR_materials_sheen") {
            let tint = e.get("sheenColorFactor").and_then(|factor| color(&factor)).unwrap_or(Vec3::ZERO);
            let most = tint.max_element();
            m.fuzz_weight = most.clamp(0.0, 1.0);
            m.fuzz_color = if most > 0.0 { tint / most } else { Vec3::ONE };
            m.fuzz_roughness = share(&e, "sheenRoughnessFactor", 0.0);
        }
        if let Some(e) = extensions.get("KHR_materials_anisotropy") {
            m.specular_anisotropy = share(&e, "anisotropyStrength", 0.0);
            let turn = e.get("anisotropyRotation").and_then(|turn| turn.number()).unwrap_or(0.0);
            m.specular_rotation = turn / TAU;
        }
        if extensions.get("KHR_materials_unlit").is_some() {
            // What is not lit shines by itself.
            m.emission_color = m.base_color;
            m.emission_texture = m.base_color_texture.clone();
            (m.emission_luminance, m.base_weight, m.specular_weight, m.base_metalness) = (1.0, 0.0, 0.0, 0.0);
        }
    }
}

/// A factor from 0 to 1.
fn share(at: &At, key: &str, or: f32) -> f32 {
    at.get(key).and_then(|factor| factor.within(0.0..=1.0)).unwrap_or(or)
}

/// A colour without negative parts.
fn color(at: &At) -> Option<Vec3> {
    at.numbers::<3>().map(|rgb| Vec3::from_array(rgb).max(Vec3::ZERO))
}
