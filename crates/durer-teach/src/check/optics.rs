//! Checks layered materials under path tracing: thin films, scattering bodies, dispersion, and
//! paths that are too short for glass.

use super::finding::{Finding, MAX_FINDINGS, number, percent};
use super::layers::{Layered, layers, thickness};
use super::scene_probe::SceneProbe;
use durer_diag::Diagnostic;
use durer_scene::material::principled::Walls;
use durer_scene::spectrum::ColorMode;

/// Thickness in micrometres above which a thin film shows no interference colours.
const THICKEST_FILM: f32 = 10.0;
/// Mean free path, as a multiple of a body's thickness, above which the body hardly scatters light.
const MAX_MEAN_FREE_PATH: f32 = 30.0;
/// Limit for the mean free path of the colour channel that is scattered most, as a multiple of the
/// thickness.
const MAX_LEAST_MEAN_FREE_PATH: f32 = 3.0;
/// Minimum deviation of the index of refraction from 1 for which light is visibly bent.
const MIN_IOR_DIFFERENCE: f32 = 1e-3;

/// Reports thin films that are too thick to show colours, usually because a value was written in
/// nanometres instead of micrometres.
pub(super) fn thick_film(scene_probe: &SceneProbe) -> Vec<Finding> {
    let say = |(index, material, m): Layered| {
        if m.thin_film_weight <= 0.0 || m.thin_film_thickness <= THICKEST_FILM {
            return None;
        }
        let thin = number(m.thin_film_thickness / 1000.0);
        let thick = number(m.thin_film_thickness);
        let diagnostic = Diagnostic::warning(format!("the thin film on material {index} is {thick} micrometres thick"))
            .effect("the film shows no colours: only a film about as thick as a wavelength of light does")
            .help(format!("`thinFilmThickness` is in micrometres; for {thick} nm, write `thinFilmThickness {thin}`"))
            .fix_at(scene_probe.field_span(material.span, &["thinFilmThickness"]), thin);
        Some(Finding::from(scene_probe.at_value(diagnostic, material.span, &["thinFilmThickness"])))
    };
    layers(scene_probe).into_iter().filter_map(say).collect()
}

/// Reports scattering bodies that are much thinner than their mean free path.
pub(super) fn wide_scatter(scene_probe: &SceneProbe) -> Vec<Finding> {
    let say = |(index, material, m): Layered| {
        let thick = thickness(scene_probe, index)?;
        let way = m.subsurface_radius * m.subsurface_radius_scale.max_element();
        let least = m.subsurface_radius * m.subsurface_radius_scale.min_element();
        let is_wide = way > MAX_MEAN_FREE_PATH * thick || least > MAX_LEAST_MEAN_FREE_PATH * thick;
        if m.subsurface_weight <= 0.0 || m.transmission_weight >= 1.0 || m.walls == Walls::Thin || !is_wide {
            return None;
        }
        let (radius, less) = (number(m.subsurface_radius), number(0.1 * thick));
        let message = format!("light travels {radius} in material {index} before it is scattered");
        let diagnostic = Diagnostic::warning(message)
            .effect(format!(
                "objects with this material are only {} thick, so most light passes straight through and the colour is hardly \
                 visible",
                number(thick)
            ))
            .help(format!("`subsurfaceRadius` is in scene units: try `subsurfaceRadius {less}`"))
            .fix_at(scene_probe.field_span(material.span, &["subsurfaceRadius"]), less);
        Some(Finding::from(scene_probe.at_value(diagnostic, material.span, &["subsurfaceRadius"])))
    };
    if scene_probe.is_physical() { layers(scene_probe).into_iter().filter_map(say).collect() } else { Vec::new() }
}

/// Reports dispersive glass in a picture that is not rendered spectrally.
pub(super) fn no_spectrum(scene_probe: &SceneProbe) -> Vec<Finding> {
    let transport = scene_probe.input.job.method.path_options();
    if transport.is_none_or(|transport| transport.color == ColorMode::Spectral) {
        return Vec::new();
    }
    let say = |(index, material, m): Layered| {
        if m.transmission_dispersion_scale <= 0.0 || m.transmission_weight < 0.5 || m.walls == Walls::Thin {
            return None;
        }
        // Ignore dispersion that comes from a preset or a model because it may not be meant to be
        // visible.
        let value = scene_probe.field_span(material.span, &["transmissionDispersionScale"])?;
        let diagnostic =
            Diagnostic::note(format!("material {index} has dispersion, but the picture is not rendered spectrally"))
                .at(value)
                .effect("red, green and blue light is refracted with the same index, so no dispersion is visible")
                .help("use `--color spectral`");
        Some(Finding::from(diagnostic))
    };
    layers(scene_probe).into_iter().filter_map(say).take(MAX_FINDINGS).collect()
}

/// Reports glass and mirrors that need more bounces than the paths have.
pub(super) fn short_paths(scene_probe: &SceneProbe) -> Vec<Finding> {
    let limited = super::depth::limited(scene_probe);
    if !limited.is_empty() {
        return limited;
    }
    let bounces = scene_probe.input.job.settings.bounces;
    let say = |(index, material, m): Layered| {
        let rays = scene_probe.material_rays()[index];
        let bends = m.walls != Walls::Thin && (m.specular_ior - 1.0).abs() > MIN_IOR_DIFFERENCE;
        let glass = m.transmission_weight > 0.5 && m.base_metalness < 0.5 && m.opacity > 0.5;
        let mirror = m.base_metalness > 0.9 && m.specular_roughness < 0.2;
        let (least, what) = match (glass, mirror) {
            // Light needs one bounce to enter an object and one to leave it.
            (true, _) if bends => (2, "glass"),
            (true, _) => (1, "glass"),
            (_, true) => (1, "a mirror"),
            _ => return None,
        };
        if rays == 0 || bounces >= least {
            return None;
        }
        let level = if bounces == 1 { "1 bounce" } else { "no bounces" };
        let message = format!("material {index} is {what}, but paths have {level}");
        let diagnostic = Diagnostic::warning(message)
            .at(material.span)
            .label(format!("on {} of the visible surfaces", percent(rays, scene_probe.hits().count())))
            .effect(match glass {
                true => "light cannot leave the glass, so it is black or nearly black",
                false => "the reflections are black",
            })
            .help("set `--bounces 16`, or omit `--bounces`");
        Some(Finding::from(match super::depth::limit_of_file(scene_probe) {
            Some((word, place)) => diagnostic
                .at(place)
                .label("")
                .related(material.span, "the material")
                .help(format!("increase `{word}`, or set `--bounces 16`")),
            None => diagnostic,
        }))
    };
    layers(scene_probe).into_iter().filter_map(say).take(1).collect()
}
