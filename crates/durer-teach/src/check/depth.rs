//! Checks the maximum depth of paths.

use super::brightness::exposed_colors_with;
use super::finding::{Finding, percent};
use super::scene_probe::SceneProbe;
use durer_diag::{Diagnostic, Span};
use durer_render::integrator::RenderSettings;

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

/// Reports paths that are too short for the scene: those that end at the first surface, and those
/// without indirect light in a scene that has hardly any direct light.
pub(super) fn limited(scene_probe: &SceneProbe) -> Vec<Finding> {
    if !scene_probe.is_physical() {
        return Vec::new();
    }
    if let Some((depth, span)) = scene_probe.input.scene.render_defaults.no_scattering {
        let pbrt = scene_probe.model_format().is_some_and(|format| format.name == "pbrt");
        let word = if pbrt { "maxdepth" } else { "max_depth" };
        let diagnostic =
            Diagnostic::warning(format!("paths end at the first surface because the maximum depth is {depth}"))
                .at(span)
                .effect("surfaces reflect no light, so only light sources and the background are visible")
                .help(format!("increase `{word}`, for example to 8"));
        return vec![Finding::from(diagnostic).affecting_whole_picture(true)];
    }
    no_indirect_light(scene_probe).into_iter().collect()
}

/// Returns the word that limits the depth of paths in a model, and its span, if the limit of the
/// model applies.
pub(super) fn limit_of_file(scene_probe: &SceneProbe) -> Option<(&'static str, Span)> {
    let word = match scene_probe.model_format()?.name {
        "pbrt" => "maxdepth",
        "Mitsuba" => "max_depth",
        _ => return None,
    };
    let written = scene_probe.input.scene.render_defaults.bounces;
    let bytes = scene_probe.input.files.bytes(0).filter(|_| written == Some(scene_probe.input.job.settings.bounces))?;
    let start = bytes.windows(word.len()).position(|part| part == word.as_bytes())?;
    Some((word, Span { file: 0, start: start as u32, end: (start + word.len()) as u32 }))
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
    let diagnostic = match limit_of_file(scene_probe) {
        Some((word, place)) => diagnostic.at(place).help(format!("increase `{word}`, or set `--bounces 16`")),
        None => diagnostic,
    };
    Some(Finding::from(diagnostic).affecting_whole_picture(true))
}
