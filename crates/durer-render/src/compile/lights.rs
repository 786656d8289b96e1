//! Compiles the lights of a scene.

use super::rules::{self, is_nodes};
use durer_diag::{Diagnostic, Diagnostics};
use durer_scene::describe::{DescribedKind as _, Value};
use durer_scene::dialect::{AmbientWithoutLights, DialectRules, Quirk};
use durer_scene::light::{Illuminate as _, Light, PHOTOMETRIC_FIELDS};
use durer_scene::math::{Color, Vec3};
use durer_scene::scene::{Material, Scene};

/// Returns the field that sets the strength of a light in photometric units, if it is 0.
fn zero_strength(light: &Light) -> Option<&'static str> {
    let fields = light.fields().iter().enumerate();
    let mut fields = fields.filter(|(_, field)| PHOTOMETRIC_FIELDS.contains(&field.name));
    fields.find(|(i, _)| light.get(*i) == Some(Value::Float(0.0))).map(|(_, field)| field.name)
}

/// Returns true if no material has a highlight or reflects anything.
fn has_plain_colors(scene: &Scene) -> bool {
    scene.materials.iter().all(|material| match &material.value {
        Material::Phong(phong, _) => phong.specular_color == Vec3::ZERO && phong.reflective_color == Vec3::ZERO,
        Material::Principled(..) | Material::Hair(..) => false,
        Material::Solid(..) => true,
    })
}

/// Returns the lights and the ambient light as the dialect interprets them.
pub(super) fn lights(scene: &Scene, rules: &DialectRules, diagnostics: &mut Diagnostics) -> (Vec<Light>, Color) {
    let written = scene.lights.as_deref().unwrap_or_default();
    // This scene is lit by emissive surfaces or by the environment.
    if written.is_empty() && scene.is_physical() {
        return (Vec::new(), scene.background.ambient_light);
    }
    if written.is_empty() {
        let own = scene.background.ambient_light;
        let ambient = match rules.ambient_without_lights {
            AmbientWithoutLights::Own => own,
            AmbientWithoutLights::WhiteIfBlack if own != Color::ZERO => own,
            AmbientWithoutLights::WhiteIfBlack | AmbientWithoutLights::White => Color::ONE,
        };
        let message = match ambient == own {
            true => "the scene has no lights: only its ambient light is visible, so colours are flat",
            false => "the scene has no lights: it is shown with an ambient light of 1 1 1, so colours are flat",
        };
        // Scenes of the first assignments have no lights. Their ambient light is 1 1 1, or their
        // materials are plain colours.
        let intended = own == Color::ONE || own == Color::ZERO && scene.lights.is_none() && has_plain_colors(scene);
        let finding = if intended { Diagnostic::note(message) } else { Diagnostic::warning(message) };
        diagnostics.push(finding.code("no-light"));
        return (Vec::new(), ambient);
    }
    for light in written {
        let value = match zero_strength(&light.value) {
            _ if light.value.color() == Color::ZERO => "`color` is 0 0 0".to_string(),
            Some(field) => format!("`{field}` is 0"),
            None => continue,
        };
        let message = format!("this light has no effect: its {value}");
        diagnostics.push(Diagnostic::warning(message).code("black-light").at(light.span));
    }
    let compiled: Vec<Light> = written.iter().map(|light| rules::light(&light.value, rules)).collect();
    for (light, written) in compiled.iter().zip(written) {
        let Light::Point(emitter) = light else { continue };
        if emitter.attenuation == Some(Vec3::ZERO) && rules.has(Quirk::MissingFalloff) {
            let word = if is_nodes(rules) { "attenuation" } else { "falloff" };
            let message = match &written.value {
                Light::Point(emitter) if emitter.falloff.is_some() => format!("the `{word}` of this light is 0"),
                _ => format!("this light has no `{word}`"),
            };
            let message = format!("{message}, so its light is divided by zero, as in the official program");
            let warning = Diagnostic::warning(message).code("no-falloff").at(written.span);
            diagnostics.push(warning.help(format!("write, for example, `{word} 1`; otherwise, the picture is black")));
        }
    }
    (compiled, scene.background.ambient_light)
}
