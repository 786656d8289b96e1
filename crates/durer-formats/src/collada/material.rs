//! Materials of the common profile.

use super::document::Element;
use super::parts::Part;
use super::reader::Reader;
use super::shader::{Effect, Value, linear};
use durer_diag::Span;
use durer_scene::material::PrincipledMaterial;
use durer_scene::math::Vec3;
use durer_scene::scene::{Material, Spanned};
use durer_scene::texture::Channel;
use std::collections::HashMap;

/// Weights of red, green and blue in `transparent`, as the specification states them.
const LUMINANCE: Vec3 = Vec3::new(0.212_671, 0.715_160, 0.072_169);

impl<'r> Reader<'r> {
    /// Returns the number of the material that an instance binds to a part of its mesh.
    pub fn bound_material(&mut self, instance: &'r Element<'r>, part: &Part) -> Option<u32> {
        let common = instance.child("bind_material").and_then(|bind| bind.child("technique_common"));
        let bound = part
            .symbol
            .as_deref()
            .and_then(|symbol| common?.all("instance_material").find(|bound| bound.get("symbol") == Some(symbol)));
        let material = match bound {
            Some(bound) => self.referred(bound, "target", "material")?,
            // Some programs name the material itself.
            None => {
                let own = self.ids.get(part.symbol.as_deref()?).copied();
                own.filter(|material| material.name == "material")?
            }
        };
        let mut sets = HashMap::new();
        for input in bound.into_iter().flat_map(|bound| bound.all("bind_vertex_input")) {
            let set = input.get("input_set").unwrap_or("0").trim().parse::<u32>().unwrap_or(0);
            sets.entry(input.get("semantic").unwrap_or_default()).or_insert(set);
        }
        let mut names: Vec<String> = sets.iter().map(|(name, set)| format!("{name}={set}")).collect();
        names.sort();
        let key = format!("{}@{}@{:?}", material.get("id").unwrap_or_default(), names.join(","), part.sets);
        if let Some(known) = self.materials.get(&key) {
            return Some(*known);
        }
        // A name that is not bound stands for the first set.
        let position = |name: &str| match sets.get(name) {
            Some(set) => part.sets.iter().position(|own| own == set),
            None => Some(0),
        };
        let value = self.convert_material(material, &position)?;
        self.scene.materials.push(Spanned { value: Material::Principled(Box::new(value)), span: material.at });
        let number = self.scene.materials.len() as u32 - 1;
        self.materials.insert(key, number);
        Some(number)
    }

    fn convert_material(
        &mut self,
        material: &'r Element<'r>,
        set: &dyn Fn(&str) -> Option<usize>,
    ) -> Option<PrincipledMaterial> {
        let Some(instance) = material.child("instance_effect") else {
            self.report.error(material.at, "a `material` needs an `instance_effect`");
            return None;
        };
        let effect = self.referred(instance, "url", "effect")?;
        let Some(profile) = effect.child("profile_COMMON") else {
            let message = "effects without `profile_COMMON` have no counterpart: grey is used";
            self.report.unsupported_once(effect.at, message);
            return None;
        };
        let technique = profile.child("technique").unwrap_or(profile);
        let models = ["constant", "lambert", "phong", "blinn"];
        let Some(shader) = technique.children.iter().find(|child| models.contains(&child.name)) else {
            let message =
                "a technique other than `constant`, `lambert`, `phong` and `blinn` has no counterpart: grey is used";
            self.report.unsupported_once(technique.at, message);
            return None;
        };
        let effect = Effect { effect, profile, technique };
        let mut m = PrincipledMaterial { specular_weight: 0.0, specular_roughness: 1.0, ..Default::default() };
        self.diffuse(effect, shader, set, &mut m);
        self.specular(effect, shader, set, &mut m);
        self.reflection(effect, shader, &mut m);
        match self.value(effect, shader, "emission") {
            Some(Value::Color(color, _)) => {
                let color = linear(color, self.is_linear);
                if color != Vec3::ZERO {
                    m.emission_luminance = color.max_element();
                    m.emission_color = color / color.max_element();
                }
            }
            Some(Value::Texture(texture)) => {
                m.emission_texture = self.picture(effect, texture, set, |_| {});
                m.emission_luminance = if m.emission_texture.is_some() { 1.0 } else { 0.0 };
            }
            None => {}
        }
        self.transparency(effect, shader, set, &mut m);
        self.warn_about_bumps([technique, profile, effect.effect]);
        Some(m)
    }

    fn diffuse(
        &mut self,
        effect: Effect<'r>,
        shader: &'r Element<'r>,
        set: &dyn Fn(&str) -> Option<usize>,
        m: &mut PrincipledMaterial,
    ) {
        match self.value(effect, shader, "diffuse").filter(|_| shader.name != "constant") {
            Some(Value::Color(color, _)) => m.base_color = linear(color, self.is_linear).min(Vec3::ONE),
            Some(Value::Texture(texture)) => {
                // The alpha of the picture counts only in `transparent`.
                m.base_color_texture = self.picture(effect, texture, set, |mapping| mapping.cutoff = Some(0.0));
                m.base_color = if m.base_color_texture.is_some() { Vec3::ONE } else { Vec3::splat(0.8) };
            }
            None => {
                let others = ["emission", "specular", "reflective"];
                let is_plain = others.iter().all(|name| shader.child(name).is_none());
                m.base_color = if is_plain && shader.name != "constant" { Vec3::splat(0.8) } else { Vec3::ZERO };
            }
        }
    }

    /// Sets the highlight, which `phong` and `blinn` have.
    fn specular(
        &mut self,
        effect: Effect<'r>,
        shader: &'r Element<'r>,
        set: &dyn Fn(&str) -> Option<usize>,
        m: &mut PrincipledMaterial,
    ) {
        let ior = self.shader_number(effect, shader, "index_of_refraction");
        m.specular_ior = ior.filter(|ior| *ior > 1.0 && *ior < 10.0).unwrap_or(1.5);
        if !matches!(shader.name, "phong" | "blinn") {
            return;
        }
        match self.value(effect, shader, "specular") {
            Some(Value::Color(color, _)) => {
                let color = linear(color, self.is_linear);
                m.specular_weight = color.max_element().min(1.0);
                if color != Vec3::ZERO {
                    m.specular_color = color / color.max_element();
                }
            }
            Some(Value::Texture(texture)) => {
                m.specular_color_texture = self.picture(effect, texture, set, |_| {});
                m.specular_weight = 1.0;
            }
            None => return,
        }
        let shininess = self.shader_number(effect, shader, "shininess").unwrap_or(20.0).max(0.0);
        m.specular_roughness = match shader.name {
            // Maya's Blinn has an eccentricity in place of an exponent.
            "blinn" if shininess <= 1.0 => shininess,
            // A highlight as wide as that of Blinn's model with this exponent.
            _ => (2.0 / (shininess + 2.0)).sqrt().sqrt(),
        };
    }

    /// Makes metals and mirrors.
    fn reflection(&mut self, effect: Effect<'r>, shader: &'r Element<'r>, m: &mut PrincipledMaterial) {
        let reflectivity = self.shader_number(effect, shader, "reflectivity");
        if self.blender.is_some_and(|version| version >= 2.8) {
            // Blender writes how metallic a material is.
            m.base_metalness = reflectivity.unwrap_or(0.0).clamp(0.0, 1.0);
            if m.base_metalness > 0.0 && shader.name == "lambert" {
                (m.specular_weight, m.specular_roughness) = (1.0, 0.5);
            }
            return;
        }
        let share = reflectivity.unwrap_or(1.0).clamp(0.0, 1.0);
        let Some(color) = self.value(effect, shader, "reflective") else { return };
        let (color, is_texture) = match color {
            Value::Color(color, _) => (share * linear(color, self.is_linear), false),
            Value::Texture(_) => (Vec3::ZERO, true),
        };
        let is_black = m.base_color.max_element() < 0.05 && m.base_color_texture.is_none();
        if color.max_element() >= 0.05 && is_black {
            // A mirror without a colour of its own is a metal.
            (m.base_color, m.base_metalness) = (color.min(Vec3::ONE), 1.0);
            (m.specular_weight, m.specular_color) = (1.0, Vec3::ONE);
            m.specular_roughness = if m.specular_roughness == 1.0 { 0.0 } else { m.specular_roughness };
        } else if color != Vec3::ZERO || is_texture {
            let message = "`reflective` of coloured surfaces has no counterpart: they are no mirrors";
            self.report.unsupported_once(shader.at, message);
        }
    }

    /// Sets the opacity by `transparent` and `transparency`.
    fn transparency(
        &mut self,
        effect: Effect<'r>,
        shader: &'r Element<'r>,
        set: &dyn Fn(&str) -> Option<usize>,
        m: &mut PrincipledMaterial,
    ) {
        let amount = self.shader_number(effect, shader, "transparency");
        if amount.is_none() && shader.child("transparent").is_none() {
            return;
        }
        let amount = amount.unwrap_or(1.0).clamp(0.0, 1.0);
        let mode = shader.child("transparent").and_then(|transparent| transparent.get("opaque")).unwrap_or("A_ONE");
        let is_alpha = mode.starts_with('A');
        // In modes that end in `ZERO`, a value of 0 is opaque.
        let is_inverted = mode.ends_with("ZERO");
        match self.value(effect, shader, "transparent") {
            Some(Value::Texture(texture)) => {
                m.opacity_texture = self.picture(effect, texture, set, |mapping| {
                    mapping.channel = Some(if is_alpha { Channel::Alpha } else { Channel::Red });
                    mapping.range = if is_inverted { [1.0, 1.0 - amount] } else { [0.0, amount] };
                });
            }
            other => {
                let (color, alpha) = match other {
                    Some(Value::Color(color, alpha)) => (color, alpha),
                    _ => (Vec3::ONE, 1.0),
                };
                let luminance = color.dot(LUMINANCE);
                let share = amount * if is_alpha { alpha } else { luminance };
                m.opacity = if is_inverted { 1.0 - share } else { share }.clamp(0.0, 1.0);
                if m.opacity == 0.0 {
                    // Some programs swap 0 and 1.
                    let at: Span = shader.child("transparency").map_or(shader.at, |element| element.at);
                    let message = "a material that is fully transparent is shown as opaque";
                    self.report.warn_once("transparent", at, message);
                    m.opacity = 1.0;
                }
            }
        }
    }

    /// Warns about bump maps, which are extensions of programs.
    fn warn_about_bumps(&self, places: [&'r Element<'r>; 3]) {
        let techniques = places.iter().flat_map(|place| place.all("extra")).flat_map(|extra| extra.all("technique"));
        for technique in techniques {
            if let Some(bump) = technique.child("bump").or_else(|| technique.child("normalmap")) {
                self.report.unsupported_once(bump.at, "bump maps have no counterpart: surfaces are smooth");
            }
        }
    }
}
