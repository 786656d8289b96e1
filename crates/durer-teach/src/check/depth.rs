//! Checks the maximum depth of paths.

use super::brightness::exposed_colors_with;
use super::finding::{Finding, number, percent};
use super::scene_probe::SceneProbe;
use durer_diag::{Diagnostic, Span};
use durer_render::integrator::RenderSettings;
use durer_scene::math::Vec3;
use durer_scene::scene::Material;

/// Number of bounces of the comparison with indirect light.
const MANY_BOUNCES: u32 = 8;
/// A surface is black below `BLACK` and visible above `VISIBLE`.
const BLACK: f32 = 0.001;
const VISIBLE: f32 = 0.005;
/// Fraction of the surface samples that must be black without indirect light, and fraction that
/// must become visible with indirect light. The few samples of a path-traced pixel can miss its
/// light.
const MIN_DARK: f32 = 0.6;
const MIN_GAINED: f32 = 0.2;

/// Returns the depth limit of a pbrt or Mitsuba file that allows no scattering, with its keyword
/// and its place. The readers make all materials of such a file black.
pub(super) fn emitters_only(scene_probe: &SceneProbe) -> Option<(&'static str, f32, Span)> {
    let scene = scene_probe.input.scene;
    if scene.render_defaults.bounces != Some(0) {
        return None;
    }
    let (word, skipped, least) = match scene_probe.model_format()?.name {
        "pbrt" => ("maxdepth", "", 1.0),
        "Mitsuba" => ("max_depth", "value=", 2.0),
        _ => return None,
    };
    let black = scene.materials.iter().all(|material| match &material.value {
        Material::Principled(m) => m.base_color == Vec3::ZERO && m.specular_weight == 0.0,
        Material::Solid(..) => true,
        _ => false,
    });
    let place = super::model_text::find(scene_probe, word)?;
    let (value, span) = super::model_text::number_after(scene_probe, place, skipped)?;
    (black && value < least).then_some((word, value, span))
}

/// Reports paths that are too short for the scene: those that end at the first surface, and those
/// without indirect light in a scene that has hardly any direct light.
pub(super) fn limited(scene_probe: &SceneProbe) -> Vec<Finding> {
    if !scene_probe.is_physical() {
        return Vec::new();
    }
    if let Some((word, depth, span)) = emitters_only(scene_probe) {
        let depth = number(depth);
        let diagnostic =
            Diagnostic::warning(format!("paths end at the first surface because the maximum depth is {depth}"))
                .at(span)
                .effect("surfaces reflect no light, so only light sources and the background are visible")
                .help(format!("increase `{word}`, for example to 8"));
        return vec![Finding::from(diagnostic).affecting_whole_picture(true)];
    }
    no_indirect_light(scene_probe).into_iter().collect()
}

/// Reports a picture without indirect light whose surfaces are black, although indirect light would
/// reach them.
fn no_indirect_light(scene_probe: &SceneProbe) -> Option<Finding> {
    let settings = scene_probe.input.job.settings;
    let black = scene_probe.lit_probes().filter(|(probe, _)| probe.hit.is_some());
    let (all, black) =
        black.fold((0, 0), |(all, black), (_, color)| (all + 1, black + usize::from(color.max_element() < BLACK)));
    let exceeds = |count: usize, share: f32| count as f32 > share * all as f32;
    if settings.bounces > 0 || scene_probe.lacks_photons() || all == 0 || !exceeds(black, MIN_DARK) {
        return None;
    }
    let (probes, colors) = exposed_colors_with(scene_probe, RenderSettings { bounces: MANY_BOUNCES, ..settings });
    let before = scene_probe.lit_probes().map(|(_, color)| color.max_element());
    let gained = probes.iter().zip(&colors).zip(before).filter(|((probe, color), before)| {
        scene_probe.probes[**probe].hit.is_some() && *before < BLACK && color.max_element() > VISIBLE
    });
    let gained = gained.count();
    if !exceeds(gained, MIN_GAINED) {
        return None;
    }
    let diagnostic = Diagnostic::warning(format!(
        "at least {} of the visible surface area gets only indirect light, but paths have no bounces",
        percent(gained, all)
    ))
    .effect("surfaces that no light reaches directly are black")
    .help("set `--bounces 16`, or omit `--bounces`");
    Some(Finding::from(diagnostic).affecting_whole_picture(true))
}
