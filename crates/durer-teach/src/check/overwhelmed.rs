//! Checks for lights that other light makes invisible, and for lights that are far from the scene.

use super::finding::{Finding, number, vector};
use super::lights::{description, span};
use super::scene_probe::SceneProbe;
use durer_diag::Diagnostic;
use durer_scene::light::{Illuminate as _, Light, PHOTOMETRIC_FIELDS};

/// Maximum number of lights of which each is meant to have a visible effect.
const FEW_LIGHTS: usize = 2;
/// Brightness of a white surface in a light below which the light is invisible, and fraction of the
/// picture's brightness that it must not reach.
const INVISIBLE: f32 = 0.06;
const MAX_SHARE: f32 = 0.15;
/// Exposure below which light is in cd/m^2, and the daylight outshines all lights.
const MIN_EXPOSURE: f32 = 0.1;
/// Distance of a light, as a multiple of the scene's size, above which its position is probably in
/// another unit.
const FAR: f32 = 50.0;
/// Focal length of a luminaire, as a multiple of the scene's size, above which it is probably in
/// millimetres.
const MAX_FOCAL_LENGTH: f32 = 10.0;

/// Reports lights with a position whose light is invisible beside that of the background.
pub(super) fn faint(scene_probe: &SceneProbe) -> Vec<Finding> {
    let (world, lights) = (scene_probe.world(), scene_probe.world().lights());
    let exposure = scene_probe.input.exposure;
    let is_plain = world.environment().is_none() && super::area_lights::emissive_objects(scene_probe).is_empty();
    if lights.len() > FEW_LIGHTS || scene_probe.lacks_photons() || !is_plain || exposure < MIN_EXPOSURE {
        return Vec::new();
    }
    let shown = scene_probe.lit_probes().filter(|(probe, _)| probe.hit.is_some());
    let mut shown: Vec<f32> = shown.map(|(_, color)| color.max_element()).collect();
    shown.sort_by(f32::total_cmp);
    let middle = shown.get(shown.len() / 2).copied().unwrap_or(0.0);
    let say = |(number_of_light, light): (usize, &Light)| {
        let lit = scene_probe.hits().filter_map(|(_, hit)| hit.contribution(number_of_light));
        let lit = lit.filter(|lit| lit.cosine > 0.0 && lit.blocker.is_none());
        let most = lit.map(|lit| exposure * lit.unoccluded.max_element() * lit.cosine).fold(0.0, f32::max);
        light.position()?;
        if most <= 0.0 || most > INVISIBLE || most > MAX_SHARE * middle {
            return None;
        }
        let span = span(scene_probe, number_of_light)?;
        let diagnostic = Diagnostic::warning(format!(
            "this light adds at most {} to the brightness of a white surface, which other light makes {} bright",
            number(most),
            number(middle)
        ))
        .effect("the light is hardly visible in the picture");
        if let Some(diagnostic) = too_far(scene_probe, number_of_light, &diagnostic) {
            return Some(Finding::from(diagnostic));
        }
        let factor = middle.max(0.3) / most;
        let fields: Vec<&str> = PHOTOMETRIC_FIELDS.into_iter().chain(["color"]).collect();
        let help = match super::attenuation::strength(scene_probe, span) {
            Some((field, place)) => {
                let value = scene_probe.text(place).parse::<f32>().unwrap_or(1.0) * factor;
                format!("its light fades with the square of the distance: try `{field} {}`", number(value))
            }
            None => format!(
                "its light fades with the square of the distance: try `color {}`",
                vector(light.color() * factor)
            ),
        };
        let help = match scene_probe.model_format() {
            Some(_) => format!("multiply the strength of the light by about {}", number(factor)),
            None => help,
        };
        Some(Finding::from(scene_probe.at_value(diagnostic.help(help), span, &fields)))
    };
    lights.iter().enumerate().filter_map(say).collect()
}

/// Completes a finding about a weak light that is far from the whole scene, because its position is
/// in another unit, or that fades as if it were.
pub(super) fn too_far(scene_probe: &SceneProbe, light: usize, diagnostic: &Diagnostic) -> Option<Diagnostic> {
    let own = description(scene_probe, light)?;
    let (bounds, place) = (scene_probe.world().bounds(), own.value.position()?);
    if bounds.is_empty() || scene_probe.model_format().is_some() {
        return None;
    }
    let (size, away) = (bounds.size().max_element(), (place - bounds.center()).length());
    if let Light::Photometric(lamp) = &own.value
        && lamp.focal_length > MAX_FOCAL_LENGTH * size.max(away)
    {
        let length = number(lamp.focal_length);
        let message =
            format!("`focalLength {length}` makes this light fade as if it were {length} behind its position");
        let help = format!(
            "the light is {} from the middle of the objects: `focalLength` is in units of the scene, not in millimetres",
            number(away)
        );
        let diagnostic = Diagnostic { message, ..diagnostic.clone() };
        return Some(scene_probe.at_value(diagnostic.help(help), own.span, &["focalLength"]));
    }
    // Without the inverse square, the distance may be intended.
    let fades = scene_probe.world().lights()[light].inverse_square().is_some();
    if away < FAR * size || !fades {
        return None;
    }
    let message = format!("this light is {} away from the objects, which are {} wide", number(away), number(size));
    let near = vector(place / 100.0);
    let help = format!(
        "check the unit of its position: if it is in centimetres and the scene in metres, write `position {near}`"
    );
    let diagnostic = Diagnostic { message, ..diagnostic.clone() };
    Some(scene_probe.at_value(diagnostic.help(help), own.span, &["position"]))
}
