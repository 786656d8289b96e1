//! Checks of lights that contribute nothing, or less than intended, to the visible points.

use super::finding::{Finding, percent, vector};
use super::probes::LightContribution;
use super::scene_probe::SceneProbe;
use super::shapes::point;
use super::verdict::{GRAZING, MAX_JUDGED, VISIBLE, Verdict, most_common};
use super::within::around;
use durer_diag::{Diagnostic, Severity, Span};
use durer_formats::course::place::{block, section};
use durer_render::world::Material;
use durer_scene::camera::Projection;
use durer_scene::light::{Illuminate as _, Light};
use durer_scene::math::Vec3;
use durer_scene::scene::Spanned;

/// Returns the scene file's description of a light.
pub(super) fn written<'s>(scout: &SceneProbe<'s>, light: usize) -> Option<&'s Spanned<Light>> {
    scout.subject.scene.lights.as_ref()?.get(light)
}

/// Returns the span of a light in the scene file.
pub(super) fn place(scout: &SceneProbe, light: usize) -> Option<Span> {
    Some(written(scout, light)?.span)
}

/// Returns true if no light contributes to the visible points.
pub(super) fn all_fail(scout: &SceneProbe) -> bool {
    let verdicts = scout.verdicts();
    !verdicts.is_empty() && verdicts.iter().all(|verdict| *verdict != Verdict::Works)
}

/// Returns a warning that a light contributes nothing, and the light's span.
pub(super) fn useless(scout: &SceneProbe, light: usize, message: String) -> Option<(Diagnostic, Span)> {
    let span = place(scout, light)?;
    let effect = match (all_fail(scout), scout.world().ambient().max_element() > VISIBLE) {
        (true, false) => "no light reaches the visible surfaces: all are black",
        (true, true) => "no light reaches the visible surfaces: they show only ambient light, flat and dark",
        (false, _) => "it contributes nothing to the picture",
    };
    Some((Diagnostic::warning(message).at(span).effect(effect), span))
}

/// Collects the findings that `find` returns for each light's index and verdict.
pub(super) fn each(scout: &SceneProbe, find: impl Fn(usize, Verdict) -> Option<Diagnostic>) -> Vec<Finding> {
    let whole = all_fail(scout);
    let verdicts = scout.verdicts().iter().enumerate();
    verdicts.filter_map(|(light, verdict)| Some(Finding::from(find(light, *verdict)?).whole(whole))).collect()
}

/// Reports lights inside an object that contribute only because shadows are off.
fn enclosed(scout: &SceneProbe) -> Vec<Finding> {
    let shadows = scout.subject.job.settings.shadows;
    let lights = scout.world().lights().iter().enumerate().filter(|_| !shadows).take(MAX_JUDGED);
    let say = |(light, emitter): (usize, &Light)| {
        let point = point(emitter)?;
        if scout.verdicts()[light] != Verdict::Works {
            return None;
        }
        let object = *around(scout.world(), point.position).first()?;
        let span = place(scout, light)?;
        let note = Diagnostic::note(format!("this light is inside the {}", scout.object(object)))
            .effect("it does not light that object, and with shadows it lights nothing else")
            .related(scout.object_span(object), "around the light")
            .help("move one of them, unless the object represents the light");
        Some(Finding::from(scout.at_value(note, span, &["position"])))
    };
    lights.filter_map(say).collect()
}

/// Reports lights inside an object.
pub(super) fn inside(scout: &SceneProbe) -> Vec<Finding> {
    let mut found = enclosed(scout);
    found.extend(each(scout, |light, verdict| {
        let Verdict::Inside(object) = verdict else { return None };
        // Photons can leave a glass object by refraction.
        if scout.subject.job.method.prepares() && transmits(scout, object) {
            return None;
        }
        let name = scout.object(object);
        let (diagnostic, span) = useless(scout, light, format!("this light is inside the {name}"))?;
        let bounds = scout.world().objects()[object as usize].bounds()?;
        let above = Vec3::new(bounds.center().x, bounds.max.y + bounds.size().max_element(), bounds.center().z);
        let diagnostic =
            scout.at_value(diagnostic, span, &["position"]).related(scout.object_span(object), "around the light");
        Some(diagnostic.help(format!("move it out: `position {}`, for example, is above the object", vector(above))))
    }));
    found
}

/// Returns true if light passes through the surface of an object.
fn transmits(scout: &SceneProbe, object: u32) -> bool {
    let material = scout.world().objects()[object as usize].material as usize;
    match scout.world().materials().get(material) {
        Some(Material::Phong(phong)) => phong.transparent.max_element() > 0.0,
        _ => false,
    }
}

/// Reports lights that an object blocks from all visible surfaces.
pub(super) fn blocked(scout: &SceneProbe) -> Vec<Finding> {
    each(scout, |light, verdict| {
        let Verdict::Blocked(object) = verdict else { return None };
        let name = scout.object(object);
        let message = format!("the {name} blocks this light from all visible surfaces");
        let (diagnostic, _) = useless(scout, light, message)?;
        let has_position = scout.world().lights()[light].position().is_some();
        let help = match (scout.world().objects()[object as usize].bounds(), has_position) {
            (None, false) => {
                "the light comes from behind the plane: negate its `direction`, the direction in which \
                              the light travels"
            }
            (None, true) => "the light is behind the plane: move it to the other side",
            (Some(_), false) => "turn the light, or move the occluder",
            (Some(_), true) => "move the light or the occluder",
        };
        Some(diagnostic.related(scout.object_span(object), "the occluder").help(help))
    })
}

/// Share of the visible points that the lights must reach together. Below it, most of the picture
/// is dark.
const MOSTLY_DARK: f32 = 0.33;
/// A light weaker than this share of the strongest one is a fill light.
const WEAK: f32 = 0.15;

/// Share of lit points below which only a rim of the objects is lit.
const RIM: f32 = 0.2;
/// Share of lit points below which almost everything is dark.
const NEARLY_ALL_DARK: f32 = 0.25;

/// Returns the lights that contribute, except those much weaker than the strongest.
fn main_lights(scout: &SceneProbe) -> Vec<usize> {
    let strength = |light: usize| {
        let arrives = scout.seen().filter_map(|(_, seen)| Some(seen.by(light)?.arrives.max_element()));
        arrives.filter(|light| light.is_finite()).fold(0.0, f32::max)
    };
    let working = (0..scout.verdicts().len()).filter(|&light| scout.verdicts()[light] == Verdict::Works);
    let all: Vec<(usize, f32)> = working.take(MAX_JUDGED).map(|light| (light, strength(light))).collect();
    let most = all.iter().map(|(_, strength)| *strength).fold(0.0, f32::max);
    all.into_iter().filter(|(_, strength)| *strength >= WEAK * most).map(|(light, _)| light).collect()
}

/// Reports lights that reach few visible surfaces because most of them face away.
fn mostly_dark(scout: &SceneProbe) -> Vec<Finding> {
    let working = main_lights(scout);
    let (mut all, mut reached, mut away, mut grazed) = (0, 0, 0, 0);
    let is_main = |lit: &&LightContribution| working.contains(&lit.light);
    let bright =
        |lit: &LightContribution| is_main(&lit) && lit.cosine > GRAZING && lit.adds.abs().max_element() > VISIBLE;
    // If backs are not shaded, a dark back is not the light's fault.
    let shaded = scout.subject.job.settings.shade_back;
    for (_, seen) in scout.seen().filter(|(_, seen)| shaded || !seen.from_behind) {
        all += 1;
        reached += usize::from(seen.lit.iter().any(&bright));
        let faces_away = seen.lit.iter().filter(is_main).all(|lit| lit.cosine <= GRAZING);
        away += usize::from(faces_away);
        grazed += usize::from(faces_away && seen.lit.iter().filter(is_main).any(is_grazing));
    }
    // If surfaces are black or in shadow, the direction of the lights is not the cause.
    let reaches = reached as f32 > MOSTLY_DARK * all as f32;
    if all == 0 || working.is_empty() || reaches || away * 2 < all - reached || super::colors::all_black(scout) {
        return Vec::new();
    }
    let Some(span) = place(scout, working[0]) else { return Vec::new() };
    if grazed * 2 > away {
        return grazing(scout, &working).into_iter().map(|diagnostic| Finding::from(diagnostic).whole(true)).collect();
    }
    let which = if working.len() == 1 { "this light" } else { "the lights" };
    let message = format!("{} of the visible surfaces face away from {which}", percent(away, all));
    let mut diagnostic = Diagnostic::warning(message)
        .effect(match scout.world().ambient().max_element() > VISIBLE {
            true => "most of the picture shows only ambient light, flat and dark",
            false => "most of the picture is black",
        })
        .help(
            "the light is behind the visible surfaces: `direction` is the direction in which the light travels, \
               `position` its place",
        );
    diagnostic = scout.at_value(diagnostic, span, &["direction", "position"]);
    // If all lights are behind the surfaces, each `direction` probably points towards its source.
    for &light in &working {
        let Some(light) = written(scout, light) else { continue };
        if let (None, Some(direction)) = (light.value.position(), light.value.direction()) {
            diagnostic = diagnostic.fix_at(scout.value(light.span, &["direction"]), vector(-direction));
        }
    }
    // A crescent on a round object may be intended; a floor without any light is not.
    let flat = |object: u32| scout.world().objects()[object as usize].bounds().is_none();
    let floor = scout.seen().any(|(_, seen)| flat(seen.object));
    let lit_floor = scout.seen().any(|(_, seen)| flat(seen.object) && seen.lit.iter().any(bright));
    if (!floor || lit_floor) && reached as f32 > 0.02 * all as f32 {
        diagnostic.severity = Severity::Note;
        // Offer no edit for a half-lit object. A thin lit rim is more likely due to a wrong sign.
        if reached as f32 > RIM * all as f32 {
            diagnostic.fix.clear();
        }
        return vec![Finding::from(diagnostic)];
    }
    vec![Finding::from(diagnostic).whole((reached as f32) < NEARLY_ALL_DARK * all as f32)]
}

/// Maximum distance at which an edit places a light, as a multiple of the scene's size.
const FARTHEST: f32 = 20.0;

fn is_grazing(lit: &LightContribution) -> bool {
    lit.cosine.abs() <= 1e-3
}

/// Reports the first light that only grazes the visible surfaces.
fn grazing(scout: &SceneProbe, lights: &[usize]) -> Option<Diagnostic> {
    let light = *lights.iter().find(|light| {
        let all = scout.seen().filter_map(|(_, seen)| seen.by(**light));
        let (grazed, count) =
            all.fold((0, 0), |(grazed, count), lit| (grazed + usize::from(is_grazing(lit)), count + 1));
        grazed * 4 > count
    })?;
    let (diagnostic, span) =
        useless(scout, light, "this light only grazes the visible surfaces: N · L is 0 there".into())?;
    let objects: Vec<u32> =
        scout.seen().filter(|(_, seen)| seen.by(light).is_some_and(is_grazing)).map(|(_, seen)| seen.object).collect();
    let surface = most_common(&objects)?;
    let diagnostic = diagnostic.related(scout.object_span(surface), "it is parallel to this");
    let (probe, _) = scout.seen().find(|(_, seen)| seen.object == surface && seen.by(light).is_some_and(is_grazing))?;
    let at = scout.world().intersect(&probe.ray, &mut ())?;
    let n = if at.inside() { -at.surface.n_geo } else { at.surface.n_geo };
    let emitter = &written(scout, light)?.value;
    match emitter.position() {
        None => {
            let direction = emitter.direction()?;
            let tilted = vector(direction - 0.7 * direction.length() * n);
            let value = scout.value(span, &["direction"]);
            let help = format!(
                "`direction` is the direction in which the light travels: `direction {tilted}` \
                                reaches the surface"
            );
            Some(scout.at_value(diagnostic.fix_at(value, tilted), span, &["direction"]).help(help))
        }
        Some(from) => {
            let eye = scout.world().camera().pose().center;
            let place = from + 0.5 * (eye - from).length().max(1e-3) * n;
            let raised = vector(place);
            let bounds = scout.world().bounds();
            let wide = if bounds.is_empty() {
                f32::INFINITY
            } else {
                bounds.size().length() + (eye - bounds.center()).length()
            };
            // If the light is far outside the scene, that is a separate mistake.
            if (place - eye).length() > FARTHEST * wide {
                let help = "the light lies in the plane of that surface, and far from everything: move it nearer";
                return Some(scout.at_value(diagnostic, span, &["position"]).help(help));
            }
            let value = scout.value(span, &["position"]);
            let help =
                format!("the light is in the plane of that surface: raise it, for example to `position {raised}`");
            Some(scout.at_value(diagnostic.fix_at(value, raised), span, &["position"]).help(help))
        }
    }
}

/// Reports lights that lie in a visible plane or run parallel to it, and so do not light it.
fn along_plane(scout: &SceneProbe) -> Vec<Finding> {
    let flat = |object: u32| scout.world().objects()[object as usize].bounds().is_none();
    let is_along = |light: &usize| {
        let all = scout.seen().filter(|(_, seen)| flat(seen.object)).filter_map(|(_, seen)| seen.by(*light));
        let (count, along) = all.fold((0, 0), |(n, along), lit| (n + 1, along + usize::from(is_grazing(lit))));
        count * 5 > scout.seen().count() && along * 10 > count * 9
    };
    main_lights(scout)
        .into_iter()
        .filter(is_along)
        .filter_map(|light| grazing(scout, &[light]))
        .map(Finding::from)
        .collect()
}

/// Reports lights behind the visible surfaces.
pub(super) fn behind(scout: &SceneProbe) -> Vec<Finding> {
    let mut found = mostly_dark(scout);
    if found.is_empty() {
        found = along_plane(scout);
    }
    found.extend(each(scout, |light, verdict| {
        if verdict != Verdict::Behind {
            return None;
        }
        let lit: Vec<&LightContribution> = scout.seen().filter_map(|(_, seen)| seen.by(light)).collect();
        let away = lit.iter().filter(|lit| lit.cosine <= 1e-3).count();
        let turned = lit.iter().filter(|lit| lit.cosine < -1e-3).count();
        if turned * 2 < away {
            return grazing(scout, &[light]);
        }
        let message =
            format!("this light is behind the visible surfaces: {} of them face away", percent(away, lit.len()));
        let (diagnostic, span) = useless(scout, light, message)?;
        let emitter = &written(scout, light)?.value;
        let diagnostic = match emitter.position() {
            None => {
                let turned = vector(-emitter.direction()?);
                let help = format!(
                    "`direction` is the direction in which the light travels, not the direction to it: `direction \
                     {turned}` lights the visible side"
                );
                let fixed = diagnostic.fix_at(scout.value(span, &["direction"]), turned);
                scout.at_value(fixed, span, &["direction"]).help(help)
            }
            Some(_) => {
                let eye = scout.world().camera().pose().center;
                let help = format!("move it to the camera's side: the camera is at {}", vector(eye));
                scout.at_value(diagnostic, span, &["position"]).help(help)
            }
        };
        // If other lights contribute, this one may be meant for the hidden side.
        Some(if all_fail(scout) { diagnostic } else { Diagnostic { severity: Severity::Note, ..diagnostic } })
    }));
    found
}

/// Reports lights whose colour the surfaces that they reach absorb completely.
pub(super) fn cancelled(scout: &SceneProbe) -> Vec<Finding> {
    each(scout, |light, verdict| {
        if verdict != Verdict::Cancelled || super::colors::all_black(scout) {
            return None;
        }
        let message = "the surfaces lit by this light reflect none of its colour".to_string();
        let (diagnostic, span) = useless(scout, light, message)?;
        let color = vector(scout.world().lights()[light].color());
        let help = format!("the colours of light and surface are multiplied per channel: this light is {color}");
        let material = scout.seen().next().map(|(_, seen)| seen.material)?;
        let diagnostic = match scout.subject.scene.materials.get(material as usize) {
            Some(material) => diagnostic.related(material.span, "a material that it reaches"),
            None => diagnostic,
        };
        Some(scout.at_value(diagnostic, span, &["color"]).help(help))
    })
}

/// Reports lights that are defined twice.
pub(super) fn twice(scout: &SceneProbe) -> Vec<Finding> {
    let lights = scout.subject.scene.lights.as_deref().unwrap_or_default();
    let pairs = lights.iter().enumerate().filter_map(|(i, light)| {
        let first = lights[..i].iter().find(|first| first.value == light.value)?;
        Some(Diagnostic::warning("this light is defined twice").at(light.span).related(first.span, "the first one"))
    });
    let say = |diagnostic: Diagnostic| {
        let diagnostic = diagnostic.effect("its light is added twice");
        Finding::from(without(scout, diagnostic.help("remove one of them")))
    };
    pairs.map(say).collect()
}

/// Adds the edits that remove a light from the file and reduce the light count.
fn without(scout: &SceneProbe, diagnostic: Diagnostic) -> Diagnostic {
    let Some(own) = diagnostic.span else { return diagnostic };
    let Some(bytes) = scout.subject.files.bytes(own.file) else { return diagnostic };
    let Some(whole) = block(bytes, own) else { return diagnostic };
    let count = section(bytes, own.file, "Lights").and_then(|lights| scout.value(lights, &["numLights"]));
    let left = scout.world().lights().len() - 1;
    match count {
        Some(count) => diagnostic.fix(whole, "").fix(count, left.to_string()),
        None => diagnostic.fix(whole, ""),
    }
}
