//! Emissive surfaces that are far too bright or too dim for the picture.

use super::brightness::brightest;
use super::finding::vector;
use super::lines::lines;
use super::scene_probe::SceneProbe;
use super::visibility::Visibility;
use durer_diag::{Diagnostic, Span};
use durer_scene::math::Color;

/// Brightness below which surfaces count as black, and below which lights are dim.
const DARK: f32 = 0.02;
const DIM: f32 = 0.3;
/// Emission that is brighter than the background by this factor determines the exposure.
const MIN_RATIO: f32 = 8.0;

/// Returns the brightness of the surfaces that do not emit light if it is nearly black, and the
/// lights in the picture are dim as well.
pub(super) fn dim_surfaces(scene_probe: &SceneProbe) -> Option<f32> {
    if !scene_probe.is_physical() || scene_probe.lacks_photons() {
        return None;
    }
    let emits = |hit: &super::probes::ProbeHit| scene_probe.world().may_emit(hit.material);
    let (lamps, others): (Vec<_>, Vec<_>) =
        scene_probe.lit_probes().partition(|(probe, _)| probe.hit.as_ref().is_some_and(emits));
    let [lamps, others] = [lamps, others].map(|part| part.into_iter().map(|(_, color)| color).collect::<Vec<Color>>());
    let most = brightest(&others);
    (!lamps.is_empty() && others.len() > lamps.len() && most < DARK && brightest(&lamps) < DIM).then_some(most)
}

/// Returns true if an object that emits light is visible as more than a dim surface. Such objects
/// can be too small for the samples that measure the brightness of the picture, like stars.
pub(super) fn shows_bright_lamp(scene_probe: &SceneProbe) -> bool {
    let world = scene_probe.world();
    let is_bright = |(number, _): (u32, bool)| {
        let radiance = scene_probe.radiance(world.objects()[number as usize].material as usize);
        let is_visible = scene_probe.visibilities()[number as usize] == Visibility::Visible;
        is_visible && scene_probe.input.exposure * radiance.max_element() > DIM
    };
    super::area_lights::emissive_objects(scene_probe).into_iter().any(is_bright)
}

/// Returns the object with the strongest emission and its radiance.
pub(super) fn strongest_object(scene_probe: &SceneProbe) -> Option<(u32, Color)> {
    let radiance = |(number, _): (u32, bool)| {
        (number, scene_probe.radiance(scene_probe.world().objects()[number as usize].material as usize))
    };
    let all = super::area_lights::emissive_objects(scene_probe).into_iter().map(radiance);
    all.max_by(|a, b| a.1.max_element().total_cmp(&b.1.max_element()))
}

/// Returns the material with the strongest emission and its radiance, if it is far brighter than
/// the background.
pub(super) fn strongest(scene_probe: &SceneProbe) -> Option<(usize, Color)> {
    let world = scene_probe.world();
    let (object, radiance) = strongest_object(scene_probe)?;
    let most = (world.objects()[object as usize].material as usize, radiance);
    let background = world.environment().is_none() && world.cube_map().is_none();
    (background && most.1.max_element() > MIN_RATIO * world.background().max_element()).then_some(most)
}

/// Places a finding at the material with the strongest emission.
pub(super) fn blamed(
    scene_probe: &SceneProbe,
    diagnostic: Diagnostic,
    strongest: Option<(usize, Color)>,
) -> Diagnostic {
    let Some((number, radiance)) = strongest else { return diagnostic };
    let Some(material) = scene_probe.input.scene.materials.get(number) else { return diagnostic };
    let label = format!("material {number} emits {}", vector(radiance));
    let Some((place, values)) = statement(scene_probe, material.span, "Ke") else {
        return diagnostic.at(material.span).label(label);
    };
    let diagnostic = diagnostic.at(place).label(label);
    match values.iter().all(|value| value.fract() == 0.0 && *value <= 255.0)
        && values.iter().any(|value| *value > 100.0)
    {
        true => {
            let values: Vec<String> = values.iter().map(|value| super::finding::number(value / 255.0)).collect();
            diagnostic.help(format!("if these values are bytes, divide them by 255: `Ke {}`", values.join(" ")))
        }
        false => diagnostic,
    }
}

/// Returns the span and the numbers of a statement of a material in an `.mtl` file.
fn statement(scene_probe: &SceneProbe, material: Span, word: &str) -> Option<(Span, Vec<f32>)> {
    let files = scene_probe.input.files;
    let bytes =
        files.bytes(material.file).filter(|_| files.name(material.file).is_some_and(|n| n.ends_with(".mtl")))?;
    for (span, line) in lines(bytes, material.file).skip_while(|(span, _)| span.start < material.start) {
        let text = String::from_utf8_lossy(line);
        let mut words = text.split_ascii_whitespace();
        match words.next() {
            Some("newmtl") => return None,
            Some(first) if first == word => {
                return Some((span, words.map_while(|word| word.parse().ok()).collect()));
            }
            _ => {}
        }
    }
    None
}
