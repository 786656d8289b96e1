//! Checks for fog that is too dense or outside the picture.

use super::finding::{Finding, number, percent, vector};
use super::probes::{Probe, ProbeHit};
use super::scene_probe::SceneProbe;
use durer_diag::{Diagnostic, Span};
use durer_scene::camera::Projection as _;
use durer_scene::light::Illuminate as _;
use durer_scene::math::{Aabb, Color, fp};
use durer_scene::medium::Medium;

/// Fog that transmits less than this fraction of the light counts as opaque.
const OPAQUE: f32 = 0.01;

/// Reports a fog box that no camera ray crosses before it hits a surface.
pub(super) fn away(scene_probe: &SceneProbe) -> Vec<Finding> {
    let world = scene_probe.world();
    let (Some(fog), Some(written)) = (world.fog(), &scene_probe.input.scene.fog) else { return Vec::new() };
    let Some(place) = fog.region.as_ref().filter(|_| scene_probe.is_physical()) else { return Vec::new() };
    let goes_through = |probe: &Probe| {
        let end = probe.hit.as_ref().map_or(f32::INFINITY, |hit| (1.0 - 1e-4) * hit.t);
        place.bounds.clip(probe.ray.origin, probe.ray.dir).is_some_and(|(from, to)| to > 0.0 && from < end)
    };
    // Fog outside the picture can still dim visible objects.
    let around = world.bounds();
    let plane = plane_before(scene_probe, place.bounds);
    let apart = around.is_empty()
        || plane.is_some()
        || (0..3).any(|axis| place.bounds.min[axis] > around.max[axis] || place.bounds.max[axis] < around.min[axis]);
    if !apart || scene_probe.probes.iter().any(goes_through) {
        return Vec::new();
    }
    let (min, max) = (vector(around.min), vector(around.max));
    let diagnostic = Diagnostic::warning("this fog is outside the picture: no camera ray passes through its box")
        .effect("the fog is invisible")
        .help(match around.is_empty() {
            true => "move its `min` and `max` to where the camera looks".to_string(),
            false => format!("move the box to the objects, whose bounds are `min {min} max {max}`"),
        });
    let diagnostic = match plane {
        Some(plane) => diagnostic.related(scene_probe.object_span(plane), "the box is behind this plane"),
        None => diagnostic,
    };
    vec![Finding::from(scene_probe.at_value(diagnostic, written.span, &["min", "max"]))]
}

/// Returns the opaque plane behind which a box is, as seen by the camera.
fn plane_before(scene_probe: &SceneProbe, place: Aabb) -> Option<u32> {
    let eye = scene_probe.world().camera().pose().center;
    let is_before = |plane: &u32| {
        let Some((n, d)) = super::hidden::world_plane(scene_probe, *plane) else { return false };
        let side = (eye.dot(n) - d).signum();
        let near = 1e-5 * place.size().length();
        !scene_probe.is_glass(*plane) && place.corners().iter().all(|corner| (corner.dot(n) - d) * side <= near)
    };
    (0..scene_probe.world().objects().len() as u32).find(is_before)
}

/// Fraction of the light that is left at the visible surfaces, and brightness of the picture, below
/// which fog that only absorbs light is reported.
const MAX_LEFT: f32 = 0.3;
const DIM: f32 = 0.15;
/// Largest fraction of light that fog scatters if it hardly does more than absorb light.
const BLACK: f32 = 0.03;

/// Returns the distances in the fog between the camera and the visible surfaces, in ascending
/// order.
fn ways(scene_probe: &SceneProbe, fog: &Medium) -> Vec<f32> {
    let way = |(probe, hit): (&Probe, &ProbeHit)| {
        let (from, to) = match &fog.region {
            Some(place) => place.bounds.clip(probe.ray.origin, probe.ray.dir)?,
            None => (0.0, f32::INFINITY),
        };
        Some((to.min(hit.t) - from.max(0.0)).max(0.0) * probe.ray.dir.length())
    };
    let mut ways: Vec<f32> = scene_probe.hits().filter_map(way).filter(|way| way.is_finite()).collect();
    ways.sort_by(f32::total_cmp);
    ways
}

/// Reports fog that scatters no light, but only absorbs it, and leaves the picture dark.
pub(super) fn black_fog(scene_probe: &SceneProbe) -> Vec<Finding> {
    let (Some(fog), Some(written)) = (scene_probe.world().fog(), &scene_probe.input.scene.fog) else {
        return Vec::new();
    };
    let color = written.value.color;
    let beams = |scene_probe: &SceneProbe| match color == Color::ZERO {
        true => dark_beams(scene_probe, written.span).into_iter().collect(),
        false => Vec::new(),
    };
    if !scene_probe.is_physical() || color.max_element() > BLACK {
        return Vec::new();
    }
    if fog.region.as_ref().is_some_and(|place| place.density.is_some()) {
        return beams(scene_probe);
    }
    let ways = ways(scene_probe, fog);
    let Some(middle) = ways.get(ways.len() / 2) else { return Vec::new() };
    let left = fp::exp(-fog.extinction.max_element() * middle);
    let lit = |probe: &Probe| probe.hit.as_ref().is_some_and(|hit| !scene_probe.world().may_emit(hit.material));
    let mut shown: Vec<f32> =
        (scene_probe.lit_probes().filter(|(probe, _)| lit(probe))).map(|(_, color)| color.max_element()).collect();
    shown.sort_by(f32::total_cmp);
    let is_dim = shown.get(shown.len() / 2).is_some_and(|brightness| *brightness < DIM);
    if left > MAX_LEFT || !is_dim {
        return beams(scene_probe);
    }
    let scatters = if color == Color::ZERO { "no light" } else { "hardly any light" };
    let message = format!("this fog scatters {scatters}: its `color` is {}, so it only absorbs light", vector(color));
    let diagnostic = Diagnostic::warning(message)
        .effect(format!(
            "only {} % of the light of a surface is left after the middle distance in the fog, {}, and the picture is dark",
            number((1000.0 * left).round() / 10.0),
            number(*middle)
        ))
        .help("for white fog, write `color 1 1 1`, the fraction of light that the fog scatters");
    let value = scene_probe.field_span(written.span, &["color"]);
    let diagnostic = scene_probe.at_value(diagnostic.fix_at(value, "1 1 1"), written.span, &["color"]);
    vec![Finding::from(diagnostic).affecting_whole_picture(true)]
}

/// Returns a note about fog that only absorbs light if a light has a beam that it could show.
fn dark_beams(scene_probe: &SceneProbe, span: Span) -> Option<Finding> {
    scene_probe.world().lights().iter().find(|light| light.cone().is_some())?;
    let diagnostic = Diagnostic::note("this fog only absorbs light: its `color` is 0 0 0")
        .effect("the fog itself is black, and beams of light in it are invisible")
        .help("for white fog, write `color 1 1 1`, the fraction of light that the fog scatters");
    let value = scene_probe.field_span(span, &["color"]);
    Some(Finding::from(scene_probe.at_value(diagnostic.fix_at(value, "1 1 1"), span, &["color"])))
}

/// Returns the bounds of a box for fog around all objects, as the fields of the box.
fn box_around(scene_probe: &SceneProbe) -> String {
    let bounds = scene_probe.world().bounds();
    let size = bounds.size().max_element().max(1.0);
    let [min, max] = [bounds.min - size, bounds.max + size].map(|corner| vector(corner.round()));
    format!("min {min} max {max}")
}

/// Returns true if light from infinity is the only light of a scene, or if there is any such light
/// besides the background.
fn needs_infinity(scene_probe: &SceneProbe) -> (bool, bool) {
    let world = scene_probe.world();
    let sky = super::physical::has_sky(scene_probe);
    let suns = world.lights().iter().any(|light| light.position().is_none());
    let near = world.lights().iter().any(|light| light.position().is_some())
        || world.objects().iter().any(|object| world.may_emit(object.material));
    (sky && !near || suns, near)
}

/// Reports fog that blocks the light.
pub(super) fn thick_fog(scene_probe: &SceneProbe) -> Vec<Finding> {
    let world = scene_probe.world();
    let (Some(fog), Some(written)) = (world.fog(), &scene_probe.input.scene.fog) else { return Vec::new() };
    if !scene_probe.is_physical() {
        return Vec::new();
    }
    let span = written.span;
    let extinction = fog.extinction.max_element();
    let mut findings = Vec::new();
    let ways = ways(scene_probe, fog);
    let even = fog.region.as_ref().is_none_or(|place| place.density.is_none());
    let swallowed = ways.iter().filter(|way| fp::exp(-extinction * **way) < OPAQUE).count();
    if even && !ways.is_empty() && swallowed * 20 > scene_probe.hits().count() * 19 {
        let middle = ways[ways.len() / 2];
        let some = number(0.5 / middle);
        let diagnostic = Diagnostic::warning(format!("this fog is opaque: its extinction is {}", number(extinction)))
            .effect(format!(
                "a hundredth of the light remains after a distance of {}; the visible surfaces are {} away",
                number(4.6 / extinction),
                number(middle)
            ))
            .label(format!("hides {} of the visible surfaces", percent(swallowed, scene_probe.hits().count())))
            .help(format!("`extinction` is per unit of the scene: try `extinction {some}`"));
        let value = scene_probe.field_span(span, &["extinction"]);
        // Thinner fog without bounds would still absorb all light from infinity.
        let diagnostic = match fog.region.is_none() && needs_infinity(scene_probe).0 {
            true => {
                let text = format!("{some} {}", box_around(scene_probe));
                let help = format!(
                    "`extinction` is per unit of the scene, and light from the sun or sky does not pass through \
                     unbounded fog: try `extinction {text}`"
                );
                diagnostic.help(help).fix_at(value, text)
            }
            false => diagnostic.fix_at(value, some),
        };
        findings
            .push(Finding::from(scene_probe.at_value(diagnostic, span, &["extinction"])).affecting_whole_picture(true));
    } else if fog.region.is_none() {
        let (needed, near) = needs_infinity(scene_probe);
        if needed {
            let diagnostic =
                Diagnostic::warning("this fog is unbounded: no light from the sun or sky passes through it")
                    .effect(match near {
                        true => "lights at infinity and the background are black",
                        false => "the picture is black: light would have to cross unbounded fog",
                    })
                    .help(format!("add a box, such as `{}`", box_around(scene_probe)));
            findings.push(Finding::from(diagnostic.at(span)).affecting_whole_picture(!near));
        }
    }
    findings
}
