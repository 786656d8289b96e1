//! Converts materials to OpenPBR, including the metallic-roughness model and the KHR extensions.
//!
//! Sources: *glTF 2.0 Specification*, chapter 3.9 and appendix B; the KHR_materials extensions. The
//! conversion follows *OpenPBR Surface specification* 1.1, section on translation of other models.

use super::Model;
use super::json::JsonRef;
use crate::shared_report::NO_COUNTERPART;
use durer_scene::bsdf::layers::opaque_ior;
use durer_scene::bsdf::microfacet::Ggx;
use durer_scene::describe::FileName;
use durer_scene::material::PrincipledMaterial;
use durer_scene::material::principled::{Backs, Switch, Walls};
use durer_scene::math::Vec3;
use durer_scene::texture::{Channel, Mapping};
use std::f32::consts::TAU;

/// Extensions that have no counterpart in Dürer, and what is done instead.
const WITHOUT_COUNTERPART: [(&str, &str); 1] = [("KHR_materials_subsurface", "subsurface scattering is left out")];

/// Textures of extensions that have no counterpart in Dürer. Each entry has the extension, the key,
/// and what is done instead.
const TEXTURES: [(&str, &str, &str); 3] = [
    ("KHR_materials_volume", "thicknessTexture", "the body's actual thickness is used"),
    ("KHR_materials_clearcoat", "clearcoatNormalTexture", "the coat uses the normals of its base"),
    ("KHR_materials_diffuse_transmission", "diffuseTransmissionTexture", "only the factor is used"),
];

/// Alpha mode of a glTF material.
#[derive(Clone, Copy, PartialEq)]
enum Alpha {
    Opaque,
    Mask,
    Blend,
}

/// Returns true if the appearance of a material depends on the direction of the tangent.
pub(super) fn needs_tangents(at: &JsonRef) -> bool {
    let anisotropic = |e: JsonRef| e.get("KHR_materials_anisotropy").is_some();
    at.get("normalTexture").is_some() || at.get("extensions").is_some_and(anisotropic)
}

/// Returns the cutoff of a material, or the material itself if it states none, and the alpha of the
/// material's base colour, which is the largest that it can have.
fn cut_away<'a>(at: &'a JsonRef<'a>) -> Option<(JsonRef<'a>, f32)> {
    let factor = at.value.pointer("/pbrMetallicRoughness/baseColorFactor/3")?.as_f64()?;
    Some((at.get("alphaCutoff").or_else(|| at.get("alphaMode"))?, factor as f32))
}

impl Model<'_> {
    /// Converts all materials.
    pub(super) fn materials(&self, root: &JsonRef) -> Vec<PrincipledMaterial> {
        let Some(materials) = root.get("materials") else { return Vec::new() };
        materials.items().enumerate().map(|(i, material)| self.material(i, &material)).collect()
    }

    /// Returns a flag for each material, which is true if any of the vertices that use it have
    /// colours.
    pub(super) fn colored(root: &JsonRef) -> Vec<bool> {
        let mut colored = vec![false; root.get("materials").map_or(0, |materials| materials.items().count())];
        let meshes = root.value.get("meshes").and_then(|meshes| meshes.as_array()).into_iter().flatten();
        let primitives = meshes.filter_map(|mesh| mesh.get("primitives")?.as_array()).flatten();
        for primitive in primitives.filter(|primitive| primitive.pointer("/attributes/COLOR_0").is_some()) {
            let number = primitive.get("material").and_then(|material| material.as_u64());
            number.and_then(|number| colored.get_mut(number as usize)).into_iter().for_each(|one| *one = true);
        }
        colored
    }

    fn material(&self, number: usize, at: &JsonRef) -> PrincipledMaterial {
        // Default material of glTF, which is white, fully metallic and fully rough, with an index
        // of refraction of 1.5.
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
        let cutoff = at.get("alphaCutoff").and_then(|cutoff| cutoff.number_in(0.0..)).unwrap_or(0.5);
        if let Some(value) = at.get("alphaCutoff").filter(|_| cutoff > 1.0) {
            let message = "opacity goes from 0 to 1, so nothing of this material is visible with a cutoff above 1";
            value.warning("ALPHA_CUTOFF", message);
        }
        if let Some((value, factor)) = cut_away(at).filter(|_| alpha == Alpha::Mask && cutoff <= 1.0)
            && factor < cutoff
        {
            let message = format!(
                "the cutoff {cutoff} is above {factor}, the largest alpha of this material, so nothing of it is visible"
            );
            value.warning("ALPHA_CUTOFF", message);
        }
        let extensions = at.get("extensions");
        let extension = |name| extensions.as_ref().and_then(|extensions| extensions.get(name));
        let glossiness = extension("KHR_materials_pbrSpecularGlossiness");
        match (&glossiness, at.get("pbrMetallicRoughness")) {
            (Some(old), _) => self.specular_glossiness(&mut m, old, alpha, cutoff),
            (None, Some(pbr)) => self.metallic(&mut m, &pbr, alpha, cutoff),
            (None, None) => {}
        }
        if alpha == Alpha::Opaque {
            m.opacity = 1.0;
        }
        let is_colored = self.colored.get(number) == Some(&true);
        if alpha == Alpha::Mask && is_colored {
            // The product includes the alpha of the vertices before the cutoff is applied.
            self.set_mask(&mut m, at, cutoff);
        }
        m.normal_texture = at.get("normalTexture").and_then(|texture| {
            let strength = texture.get("scale").and_then(|scale| scale.number()).unwrap_or(1.0);
            self.texture(&texture, |mapping| mapping.strength = strength)
        });
        let strength = extension("KHR_materials_emissive_strength");
        let strength = strength.and_then(|e| e.get("emissiveStrength")?.number_in(0.0..)).unwrap_or(1.0);
        let emissive = at.get("emissiveFactor").and_then(|factor| color(&factor)).unwrap_or(Vec3::ZERO);
        if emissive != Vec3::ZERO {
            (m.emission_luminance, m.emission_color) = (strength, emissive);
            m.emission_texture = at.get("emissiveTexture").and_then(|texture| self.texture(&texture, |_| ()));
        } else if let (Some(texture), None) = (at.get("emissiveTexture"), at.get("emissiveFactor")) {
            texture.warning(
                "EMISSIVE_TEXTURE",
                "this texture has no effect, because `emissiveFactor` is 0 unless it is set",
            );
        }
        if let Some(extensions) = &extensions {
            self.extended(&mut m, extensions);
            if extensions.get("KHR_materials_unlit").is_some() && is_colored {
                m.emission_vertex_colors = Switch::On;
            }
        }
        // Transmissive surfaces are visible from both sides anyway.
        let both = at.get("doubleSided").and_then(|both| both.boolean()).unwrap_or(false);
        if m.transmission_weight == 0.0 {
            match both {
                false => m.backs = Backs::Hidden,
                // Thin walls emit light on both sides.
                true if m.emission_luminance > 0.0 => m.walls = Walls::Thin,
                true => {}
            }
        }
        m
    }

    fn metallic(&self, m: &mut PrincipledMaterial, pbr: &JsonRef, alpha: Alpha, cutoff: f32) {
        let factor = pbr.get("baseColorFactor").and_then(|factor| factor.numbers::<4>()).unwrap_or([1.0; 4]);
        m.base_color = Vec3::new(factor[0], factor[1], factor[2]);
        self.base(m, pbr.get("baseColorTexture"), factor[3], alpha, cutoff);
        m.base_metalness = unit_factor(pbr, "metallicFactor", 1.0);
        m.specular_roughness = unit_factor(pbr, "roughnessFactor", 1.0);
        m.metallic_roughness_texture =
            pbr.get("metallicRoughnessTexture").and_then(|texture| self.texture(&texture, |_| ()));
    }

    /// Sets up an alpha mask. The cutoff is applied to the product of the alpha values of the
    /// factor, the texture and the vertices.
    fn set_mask(&self, m: &mut PrincipledMaterial, at: &JsonRef, cutoff: f32) {
        let extensions = at.get("extensions");
        let old = extensions.as_ref().and_then(|extensions| extensions.get("KHR_materials_pbrSpecularGlossiness"));
        let (base, [factor, texture]) = match old {
            Some(old) => (Some(old), ["diffuseFactor", "diffuseTexture"]),
            None => (at.get("pbrMetallicRoughness"), ["baseColorFactor", "baseColorTexture"]),
        };
        (m.opacity, m.opacity_cutoff) = (1.0, Some(cutoff));
        let Some(base) = base else { return };
        if let Some(factor) = base.get(factor).and_then(|factor| factor.numbers::<4>()) {
            m.opacity = factor[3].clamp(0.0, 1.0);
        }
        if let Some(texture) = base.get(texture) {
            m.base_color_texture = self.texture_as(&texture, ":whole", |mapping| mapping.cutoff = None);
        }
    }

    /// Reads the base colour texture, and sets the opacity from the alpha values of the texture and
    /// of the factor.
    fn base(&self, m: &mut PrincipledMaterial, texture: Option<JsonRef>, factor: f32, alpha: Alpha, cutoff: f32) {
        // The cutoff applies to the alpha of the texture multiplied by that of the factor.
        let least = match alpha {
            Alpha::Opaque => Some(0.0),
            Alpha::Mask if factor > 0.0 => Some(cutoff / factor),
            Alpha::Mask => Some(if cutoff > 0.0 { 2.0 } else { 0.0 }),
            Alpha::Blend => None,
        };
        m.base_color_texture = texture.and_then(|texture| self.texture(&texture, |mapping| mapping.cutoff = least));
        m.opacity = match alpha {
            Alpha::Opaque => 1.0,
            // The alpha of a texture is at most 1.
            Alpha::Mask if factor.min(1.0) < cutoff => 0.0,
            Alpha::Mask => 1.0,
            Alpha::Blend => factor.clamp(0.0, 1.0),
        };
    }

    /// Reads KHR_materials_pbrSpecularGlossiness, which defines the reflectance at normal incidence
    /// as a colour.
    fn specular_glossiness(&self, m: &mut PrincipledMaterial, old: &JsonRef, alpha: Alpha, cutoff: f32) {
        let factor = old.get("diffuseFactor").and_then(|factor| factor.numbers::<4>()).unwrap_or([1.0; 4]);
        let specular = old.get("specularFactor").and_then(|factor| color(&factor)).unwrap_or(Vec3::ONE);
        m.base_color = Vec3::new(factor[0], factor[1], factor[2]);
        m.base_metalness = 0.0;
        m.specular_roughness = 1.0 - unit_factor(old, "glossinessFactor", 1.0);
        let most = specular.max_element();
        // An index of refraction of 1.5 gives a reflectance of 0.04 at normal incidence.
        m.specular_weight = most / 0.04;
        m.specular_color = if most > 0.0 { specular / most } else { Vec3::ONE };
        if most > 0.5 && m.base_color.max_element() < 0.2 {
            (m.base_color, m.base_metalness, m.specular_weight, m.specular_color) = (specular, 1.0, 1.0, Vec3::ONE);
        }
        self.base(m, old.get("diffuseTexture"), factor[3], alpha, cutoff);
        let Some(texture) = old.get("specularGlossinessTexture") else { return };
        let color = self.texture_as(&texture, ":color", |_| ());
        match m.base_metalness > 0.0 {
            true => m.base_color_texture = color,
            false => m.specular_color_texture = color,
        }
        // The roughness is 1 minus the product of glossiness and alpha, so the texture is applied
        // to a roughness of 1.
        let glossiness = 1.0 - m.specular_roughness;
        m.specular_roughness = 1.0;
        m.specular_roughness_texture = self.number(&texture, Channel::Alpha, [1.0, 1.0 - glossiness]);
    }

    fn extended(&self, m: &mut PrincipledMaterial, extensions: &JsonRef) {
        for (name, key, instead) in TEXTURES {
            let Some(extension) = extensions.get(name) else { continue };
            if let Some(texture) = extension.get(key) {
                texture.warning(NO_COUNTERPART, format!("this texture of {name} is left out; {instead}"));
            }
        }
        let number = |at: &JsonRef, key, channel| self.number(&at.get(key)?, channel, [0.0, 1.0]);
        let picture = |at: &JsonRef, key| self.texture(&at.get(key)?, |_| ());
        for (name, message) in WITHOUT_COUNTERPART {
            if extensions.get(name).is_some() {
                self.once(name, message);
            }
        }
        if let Some(e) = extensions.get("KHR_materials_ior") {
            // An index of refraction of 0 stands for an infinite index, with which all light is
            // reflected.
            m.specular_ior = match e.get("ior") {
                Some(ior) if ior.value.as_f64() == Some(0.0) => 1e4,
                ior => ior.and_then(|ior| ior.number_in(1.0..)).unwrap_or(1.5),
            };
        }
        if let Some(e) = extensions.get("KHR_materials_specular") {
            m.specular_weight = unit_factor(&e, "specularFactor", 1.0);
            m.specular_color = e.get("specularColorFactor").and_then(|factor| color(&factor)).unwrap_or(Vec3::ONE);
            m.specular_weight_texture = number(&e, "specularTexture", Channel::Alpha);
            m.specular_color_texture = picture(&e, "specularColorTexture");
            let clear = extensions.get("KHR_materials_transmission").is_some();
            normalize_specular_color(m, clear);
            without_specular_on_metals(m, clear);
        }
        if let Some(e) = extensions.get("KHR_materials_transmission") {
            m.transmission_weight = unit_factor(&e, "transmissionFactor", 0.0);
            if m.transmission_weight > 0.0 && m.base_metalness == 1.0 && m.metallic_roughness_texture.is_none() {
                let message = "this material is a metal, so `transmissionFactor` has no effect: `metallicFactor` is 1 \
                               unless it is set to 0";
                e.warning("metal-transmission", message);
            }
            // The base colour tints transmitted light.
            m.transmission_color = m.base_color;
            m.transmission_color_texture = m.base_color_texture.clone();
            m.transmission_weight_texture = number(&e, "transmissionTexture", Channel::Red);
            m.walls = Walls::Thin;
        }
        if let Some(e) = extensions.get("KHR_materials_volume") {
            let thickness = e.get("thicknessFactor").and_then(|thickness| thickness.number_in(0.0..)).unwrap_or(0.0);
            let depth = e.get("attenuationDistance").and_then(|distance| distance.number_in(f32::MIN_POSITIVE..));
            let tint = e.get("attenuationColor").and_then(|factor| color(&factor)).unwrap_or(Vec3::ONE);
            if thickness > 0.0 {
                m.walls = Walls::Solid;
                if let Some(depth) = depth {
                    (m.transmission_depth, m.transmission_color) = (depth, tint);
                }
            }
        }
        if let Some(e) = extensions.get("KHR_materials_clearcoat") {
            m.coat_weight = unit_factor(&e, "clearcoatFactor", 0.0);
            m.coat_roughness = unit_factor(&e, "clearcoatRoughnessFactor", 0.0);
            (m.coat_ior, m.coat_darkening) = (1.5, 0.0);
            m.coat_weight_texture = number(&e, "clearcoatTexture", Channel::Red);
            m.coat_roughness_texture = number(&e, "clearcoatRoughnessTexture", Channel::Green);
        }
        if let Some(e) = extensions.get("KHR_materials_sheen") {
            let tint = e.get("sheenColorFactor").and_then(|factor| color(&factor)).unwrap_or(Vec3::ZERO);
            let most = tint.max_element();
            m.fuzz_weight = most.clamp(0.0, 1.0);
            m.fuzz_color = if most > 0.0 { tint / most } else { Vec3::ONE };
            m.fuzz_roughness = unit_factor(&e, "sheenRoughnessFactor", 0.0);
            m.fuzz_color_texture = picture(&e, "sheenColorTexture");
            m.fuzz_roughness_texture = number(&e, "sheenRoughnessTexture", Channel::Alpha);
        }
        if let Some(e) = extensions.get("KHR_materials_anisotropy") {
            m.specular_anisotropy = unit_factor(&e, "anisotropyStrength", 0.0);
            let turn = e.get("anisotropyRotation").and_then(|turn| turn.number()).unwrap_or(0.0);
            m.specular_rotation = turn / TAU;
            let pictured = m.metallic_roughness_texture.is_some() || e.get("anisotropyTexture").is_some();
            if m.specular_anisotropy > 0.0 && !pictured {
                // Along the highlight, alpha increases towards 1 with the square of the strength.
                // Across the highlight, alpha is the square of the roughness. If there are
                // textures, this conversion is only approximate.
                let alpha = (m.specular_roughness * m.specular_roughness).max(1e-3);
                let along = alpha + (1.0 - alpha) * m.specular_anisotropy * m.specular_anisotropy;
                [m.specular_roughness, m.specular_anisotropy, _] = Ggx::parameters([along, alpha]);
            }
            m.specular_anisotropy_texture = number(&e, "anisotropyTexture", Channel::Blue);
            m.specular_rotation_texture = number(&e, "anisotropyTexture", Channel::Angle);
        }
        if let Some(e) = extensions.get("KHR_materials_iridescence") {
            let at_least = |key, or, least: f32| e.get(key).and_then(|x| x.number_in(least..)).unwrap_or(or);
            m.thin_film_weight = unit_factor(&e, "iridescenceFactor", 0.0);
            m.thin_film_weight_texture = number(&e, "iridescenceTexture", Channel::Red);
            m.thin_film_ior = at_least("iridescenceIor", 1.3, 1.0);
            // glTF uses nanometres, but a Dürer scene uses micrometres. Without a texture, the
            // thickness is the maximum thickness.
            let [thin, thick] = [("iridescenceThicknessMinimum", 100.0), ("iridescenceThicknessMaximum", 400.0)]
                .map(|(key, or)| at_least(key, or, 0.0));
            m.thin_film_thickness = 1e-3 * thick;
            let texture = e.get("iridescenceThicknessTexture").filter(|_| thick > 0.0);
            m.thin_film_thickness_texture =
                texture.and_then(|texture| self.number(&texture, Channel::Green, [thin / thick, 1.0]));
        }
        if let Some(e) = extensions.get("KHR_materials_dispersion") {
            // In glTF, dispersion is 20 divided by the Abbe number. A Dürer scene has the Abbe
            // number and a scale that divides it.
            let dispersion = e.get("dispersion").and_then(|x| x.number_in(0.0..)).unwrap_or(0.0);
            m.transmission_dispersion_scale = dispersion.min(1.0);
            m.transmission_dispersion_abbe_number = 20.0 / dispersion.max(1.0);
        }
        if let Some(e) = extensions.get("KHR_materials_diffuse_transmission") {
            self.diffuse_transmission(m, &e);
        }
        if extensions.get("KHR_materials_unlit").is_some() {
            // Unlit materials emit their base colour as light.
            m.emission_color = m.base_color;
            m.emission_texture = m.base_color_texture.clone();
            (m.emission_luminance, m.base_weight, m.specular_weight, m.base_metalness) = (1.0, 0.0, 0.0, 0.0);
        }
    }
}

/// Removes the effect of KHR_materials_specular on metals. The extension applies only to
/// dielectrics, but OpenPBR's specular parameters apply to metals as well.
fn without_specular_on_metals(m: &mut PrincipledMaterial, clear: bool) {
    let is_metal = m.base_metalness == 1.0 && m.metallic_roughness_texture.is_none();
    if is_metal {
        (m.specular_weight, m.specular_color) = (1.0, Vec3::ONE);
        (m.specular_weight_texture, m.specular_color_texture) = (None, None);
    } else if m.base_metalness > 0.0 && m.specular_weight < 1.0 && !clear {
        // For an opaque dielectric, a smaller index of refraction has the same effect as a smaller
        // weight.
        (m.specular_ior, m.specular_weight) = (opaque_ior(m), 1.0);
    }
}

/// Moves the brightness of the specular colour into the weight. The colour applies only at normal
/// incidence, whereas the weight also applies at grazing angles. Transmissive materials ignore the
/// weight, so their colour is clamped.
fn normalize_specular_color(m: &mut PrincipledMaterial, clear: bool) {
    let most = m.specular_color.max_element();
    if clear {
        m.specular_color = m.specular_color.min(Vec3::ONE);
    } else if most > 0.0 {
        m.specular_weight *= most;
        m.specular_color /= most;
    } else {
        (m.specular_weight, m.specular_color) = (0.0, Vec3::ONE);
    }
}

impl Model<'_> {
    /// Reads KHR_materials_diffuse_transmission, which describes a thin sheet that transmits a
    /// fraction of the diffuse light and gives it a colour.
    fn diffuse_transmission(&self, m: &mut PrincipledMaterial, e: &JsonRef) {
        let through = unit_factor(e, "diffuseTransmissionFactor", 0.0);
        if through == 0.0 || m.walls == Walls::Solid && m.transmission_weight > 0.0 {
            return;
        }
        // The subsurface lobe with full forward scattering represents the transmitted part, and the
        // diffuse base lobe represents the reflected part.
        m.walls = Walls::Thin;
        m.subsurface_weight = through;
        m.subsurface_scatter_anisotropy = 1.0 - f32::EPSILON;
        m.subsurface_color = e.get("diffuseTransmissionColorFactor").and_then(|x| color(&x)).unwrap_or(Vec3::ONE);
        let picture = e.get("diffuseTransmissionColorTexture");
        m.subsurface_color_texture = picture.and_then(|texture| self.texture(&texture, |_| ()));
    }

    /// Reads a texture in which one channel scales a parameter. Texel values from 0 to 1 are mapped
    /// to `range`.
    fn number(&self, texture: &JsonRef, channel: Channel, range: [f32; 2]) -> Option<FileName> {
        let change = |mapping: &mut Mapping| (mapping.channel, mapping.range) = (Some(channel), range);
        // One texture can scale several parameters.
        self.texture_as(texture, &format!(":{channel:?}"), change)
    }
}

/// Reads a factor between 0 and 1. The default is `or`.
fn unit_factor(at: &JsonRef, key: &str, or: f32) -> f32 {
    at.get(key).and_then(|factor| factor.number_in(0.0..=1.0)).unwrap_or(or)
}

/// Reads a colour, and replaces negative components with 0.
fn color(at: &JsonRef) -> Option<Vec3> {
    at.numbers::<3>().map(|rgb| Vec3::from_array(rgb).max(Vec3::ZERO))
}
