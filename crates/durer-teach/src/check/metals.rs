//! Checks for glTF materials that are metals only because the file does not say otherwise.

use super::finding::{Finding, MAX_FINDINGS};
use super::layers::layers;
use super::scene_probe::SceneProbe;
use durer_diag::{Diagnostic, Severity};
use durer_scene::math::Color;

/// Brightness below which the surface of a metal looks black, and fraction of such samples above
/// which a metal is reported.
const DARK: f32 = 0.03;
const MIN_DARK: f32 = 0.6;
/// Ratio of the smallest to the largest channel of a colour below which it is that of a paint.
const MAX_METAL_CHANNEL: f32 = 0.2;
/// Minimum number of samples for a conclusion.
const MIN_SAMPLES: usize = 6;

/// Factor on the radiance of the surroundings below which a surface shows hardly anything else.
const MAX_REFLECTED: f32 = 1.1;

/// Reports metals of a glTF file without `metallicFactor` that are dull because they have nothing
/// to reflect but black or grey surroundings.
pub(super) fn metal_by_default(scene_probe: &SceneProbe) -> Vec<Finding> {
    let world = scene_probe.world();
    let is_gltf = scene_probe.model_format().is_some_and(|format| format.name == "glTF");
    let surroundings = if world.is_dark() { Color::ZERO } else { world.background() };
    // The lights of the studio light metals well.
    let has_studio = scene_probe.input.scene.has_studio();
    if !is_gltf || !scene_probe.is_physical() || world.environment().is_some() || has_studio {
        return Vec::new();
    }
    let dark = DARK.max(MAX_REFLECTED * surroundings.max_element());
    let mut findings = Vec::new();
    for (number, material, m) in layers(scene_probe) {
        let plain = m.base_metalness_texture.is_none() && m.metallic_roughness_texture.is_none();
        if m.base_metalness < 1.0 || !plain || states_metalness(scene_probe, number) || findings.len() == MAX_FINDINGS {
            continue;
        }
        let own = scene_probe
            .lit_probes()
            .filter(|(probe, _)| probe.hit.as_ref().is_some_and(|hit| hit.material as usize == number));
        let (all, below) =
            own.fold((0, 0), |(all, below), (_, color)| (all + 1, below + usize::from(color.max_element() < dark)));
        let is_dark = below as f32 >= MIN_DARK * all as f32;
        // No metal has a colour as pure as that of paint, but anodised metal can have it.
        let is_paint = m.base_color.min_element() < MAX_METAL_CHANNEL * m.base_color.max_element();
        if all < MIN_SAMPLES || !is_dark && !is_paint {
            continue;
        }
        let message = format!("material {number} is a metal, because its file states no `metallicFactor`");
        let severity = if is_dark { Severity::Warning } else { Severity::Note };
        let diagnostic = Diagnostic { severity, ..Diagnostic::warning(message) }
            .at(material.span)
            .effect(match is_dark {
                true => "a metal shows only its surroundings, which are plain here, so the objects are dark and dull",
                false => "a metal shows only its surroundings, most of which are plain here, so the objects are dark",
            })
            .help("for another material, write `\"metallicFactor\": 0`: the factor is 1 by default");
        findings.push(Finding::from(diagnostic));
    }
    findings
}

/// Returns true if the JSON of a material contains the factor. The number of the material is that
/// in the file.
fn states_metalness(scene_probe: &SceneProbe, number: usize) -> bool {
    let Some(material) = scene_probe.input.scene.materials.get(number) else { return true };
    let bytes = scene_probe.input.files.bytes(material.span.file).unwrap_or_default();
    let text = bytes.get(material.span.start as usize..).unwrap_or_default();
    let mut depth = 0usize;
    let end = text.iter().position(|byte| {
        depth = match byte {
            b'{' => depth + 1,
            b'}' => depth.saturating_sub(1),
            _ => depth,
        };
        *byte == b'}' && depth == 0
    });
    let own = &text[..end.unwrap_or(text.len())];
    let has = |word: &[u8]| own.windows(word.len()).any(|part| part == word);
    // Materials without a block, or in old files, have other parameters.
    !has(b"pbrMetallicRoughness") || has(b"metallicFactor")
}
