//! Checks for lights that contribute nothing, or less than intended, at the visible points.

use super::containment::containing_objects;
use super::finding::{Finding, percent, vector};
use super::probes::{LightContribution, ProbeHit};
use super::scene_probe::SceneProbe;
use super::shapes::point;
use super::verdict::{GRAZING, LightVerdict, MAX_LIGHTS, VISIBLE, most_common};
use durer_diag::{Diagnostic, Severity, Span};
use durer_formats::course::place::{block, section};
use durer_render::world::Material;
use durer_scene::camera::Projection as _;
use durer_scene::dialect::Dialect;
use durer_scene::light::{Illuminate as _, Light};
use durer_scene::math::Vec3;
use durer_scene::scene::Spanned;

/// Returns the description of a light in the scene file.
pub(super) fn description<'s>(scene_probe: &SceneProbe<'s>, light: usize) -> Option<&'s Spanned<Light>> {
    scene_probe.input.scene.lights.as_ref()?.get(light)
}

/// Returns the span of a light in the scene file.
pub(super) fn span(scene_probe: &SceneProbe, light: usize) -> Option<Span> {
    Some(description(scene_probe, light)?.span)
}

/// Returns true if no light contributes at the visible points.
pub(super) fn none_contributes(scene_probe: &SceneProbe) -> bool {
    let verdicts = scene_probe.verdicts();
    !verdicts.is_empty() && verdicts.iter().all(|verdict| *verdict != LightVerdict::Works)
}

/// Cosine between the direction of a light and the camera's `up` above which the light shines
/// upwards.
const MIN_UPWARDS: f32 = 0.2;

/// Effect of a light that does not contribute.
const NO_CONTRIBUTION: &str = "this light contributes nothing to the picture";

/// Returns a warning that a light contributes nothing, and the span of the light.
pub(super) fn no_contribution(scene_probe: &SceneProbe, light: usize, message: String) -> Option<(Diagnostic, Span)> {
    let span = span(scene_probe, light)?;
    let effect = match (none_contributes(scene_probe), scene_probe.world().ambient().max_element() > VISIBLE) {
        // Paths also find the light of the background.
        (true, false) if scene_probe.is_physical() && !scene_probe.is_dark() => NO_CONTRIBUTION,
        (true, false) => "no light reaches the visible surfaces: all are black",
        (true, true) => "no light reaches the visible surfaces: they show only ambient light, flat and dark",
        (false, _) => NO_CONTRIBUTION,
    };
    Some((Diagnostic::warning(message).at(span).effect(effect), span))
}

/// Collects the findings that `find` returns for each light, given its index and verdict.
pub(super) fn for_each_verdict(
    scene_probe: &SceneProbe,
    find: impl Fn(usize, LightVerdict) -> Option<Diagnostic>,
) -> Vec<Finding> {
    let whole = none_contributes(scene_probe);
    let verdicts = scene_probe.verdicts().iter().enumerate();
    verdicts
        .filter_map(|(light, verdict)| Some(Finding::from(find(light, *verdict)?).affecting_whole_picture(whole)))
        .collect()
}

/// Reports lights inside an object that contribute only because shadows are disabled.
fn enclosed(scene_probe: &SceneProbe) -> Vec<Finding> {
    let shadows = scene_probe.input.job.settings.shadows;
    let lights = scene_probe.world().lights().iter().enumerate().filter(|_| !shadows).take(MAX_LIGHTS);
    let say = |(light, emitter): (usize, &Light)| {
        let point = point(emitter)?;
        if scene_probe.verdicts()[light] != LightVerdict::Works {
            return None;
        }
        let object = *containing_objects(scene_probe.world(), point.position).first()?;
        let span = span(scene_probe, light)?;
        let note = Diagnostic::note(format!("this light is inside the {}", scene_probe.object(object)))
            .effect("the light does not illuminate that object, and with shadows it would illuminate nothing else")
            .related(scene_probe.object_span(object), "the object around the light")
            .help("move the light or the object, unless the object represents the light");
        Some(Finding::from(scene_probe.at_value(note, span, &["position"])))
    };
    lights.filter_map(say).collect()
}

/// Reports lights inside an object.
pub(super) fn inside(scene_probe: &SceneProbe) -> Vec<Finding> {
    let mut findings = enclosed(scene_probe);
    findings.extend(for_each_verdict(scene_probe, |light, verdict| {
        let LightVerdict::Inside(object) = verdict else { return None };
        // Photons can leave a glass object by refraction, and paths can find a light in a room.
        let passes = match scene_probe.is_physical() && !scene_probe.is_dark() {
            true => lets_paths_pass(scene_probe, object),
            false => scene_probe.input.job.method.prepares() && transmits(scene_probe, object),
        };
        if passes {
            return None;
        }
        let name = scene_probe.object(object);
        let (diagnostic, span) = no_contribution(scene_probe, light, format!("this light is inside the {name}"))?;
        let bounds = scene_probe.world().objects()[object as usize].bounds()?;
        let above = Vec3::new(bounds.center().x, bounds.max.y + bounds.size().max_element(), bounds.center().z);
        let diagnostic = scene_probe
            .at_value(diagnostic, span, &["position"])
            .related(scene_probe.object_span(object), "the object around the light");
        Some(
            diagnostic.help(format!(
                "move the light out of the object, for example {}",
                written_position(scene_probe, above)
            )),
        )
    }));
    findings
}

/// Returns a position as the scene file writes it: in the node grammar, the transform of the node
/// that contains the light.
fn written_position(scene_probe: &SceneProbe, place: Vec3) -> String {
    let place = vector(place);
    match scene_probe.input.dialect {
        Dialect::F23 => format!("with `Transform {{ translate {place} }}` in its `Node`"),
        _ => format!("to `position {place}`"),
    }
}

/// Returns true if paths can connect a light inside an object with the camera: the object is not
/// opaque, or it contains the camera.
fn lets_paths_pass(scene_probe: &SceneProbe, object: u32) -> bool {
    let eye = scene_probe.world().camera().pose().center;
    super::area_lights::transmits_light(scene_probe, object)
        || containing_objects(scene_probe.world(), eye).contains(&object)
}

/// Returns true if light can pass through the surface of an object.
fn transmits(scene_probe: &SceneProbe, object: u32) -> bool {
    let material = scene_probe.world().objects()[object as usize].material as usize;
    match scene_probe.world().materials().get(material) {
        Some(Material::Phong(phong)) => phong.transparent.max_element() > 0.0,
        _ => false,
    }
}

/// Returns true if a direction points upwards, as seen by the camera.
pub(super) fn is_upwards(scene_probe: &SceneProbe, direction: Vec3) -> bool {
    let up = scene_probe.world().camera().pose().up.normalize_or(Vec3::Y);
    direction.normalize_or_zero().dot(up) > MIN_UPWARDS
}

/// Returns true if a light that an object blocks from the visible surfaces also fails to light them
/// after reflections. In a scene with other lights, only an infinite plane is to blame.
fn is_lost(scene_probe: &SceneProbe, light: usize, object: u32) -> bool {
    if !scene_probe.is_physical() || scene_probe.is_dark() {
        return true;
    }
    let is_plane = scene_probe.world().objects()[object as usize].bounds().is_none();
    let is_opaque = !super::area_lights::transmits_light(scene_probe, object);
    // Light can enter a room through a narrow slot.
    let is_alone = || super::verdict::blocks_alone(scene_probe, light, object);
    let is_unlit = || !super::scene_probe::Reach::of(scene_probe).is_lit_by(scene_probe, light);
    is_opaque && (is_plane || none_contributes(scene_probe)) && is_alone() && is_unlit()
}

/// Reports objects that block lights, or the light of the sky, from all visible surfaces.
pub(super) fn blocked(scene_probe: &SceneProbe) -> Vec<Finding> {
    let mut findings = blocked_lights(scene_probe);
    if findings.is_empty() {
        findings.extend(super::reach::sky_blocked(scene_probe));
    }
    findings
}

fn blocked_lights(scene_probe: &SceneProbe) -> Vec<Finding> {
    for_each_verdict(scene_probe, |light, verdict| {
        let LightVerdict::Blocked(object) = verdict else { return None };
        if !is_lost(scene_probe, light, object) {
            return None;
        }
        let name = scene_probe.object(object);
        let message = format!("the {name} blocks this light from all visible surfaces");
        let (diagnostic, _) = no_contribution(scene_probe, light, message)?;
        let has_position = scene_probe.world().lights()[light].position().is_some();
        let help = match (scene_probe.world().objects()[object as usize].bounds(), has_position) {
            (None, false) => {
                "the light comes from behind the plane: negate its `direction`, the direction in which \
                              the light travels"
            }
            (None, true) => "the light is behind the plane: move it to the other side",
            (Some(_), false)
                if scene_probe.world().lights()[light].direction().is_some_and(|way| is_upwards(scene_probe, way)) =>
            {
                "turn the light over: it shines upwards, from below the occluder"
            }
            (Some(_), false) => "turn the light, or move the occluder",
            (Some(_), true) => "move the light or the occluder",
        };
        let diagnostic = diagnostic.related(scene_probe.object_span(object), "the occluder").help(help);
        // A camera in water or glass shows it on purpose, although its surface casts a shadow.
        let eye = scene_probe.world().camera().pose().center;
        let is_water = scene_probe.is_glass(object) && containing_objects(scene_probe.world(), eye).contains(&object);
        Some(if is_water { Diagnostic { severity: Severity::Note, ..diagnostic } } else { diagnostic })
    })
}

/// Fraction of the visible points that all lights together must reach. Below this fraction, most of
/// the picture is dark.
const MOSTLY_DARK: f32 = 0.33;
/// A light is a fill light if it is weaker than this fraction of the strongest light.
const FILL_LIGHT_RATIO: f32 = 0.15;

/// Fraction of lit points below which almost everything is dark.
const NEARLY_ALL_DARK: f32 = 0.25;

/// Returns the lights that contribute, except those that are much weaker than the strongest one.
fn main_lights(scene_probe: &SceneProbe) -> Vec<usize> {
    let strength = |light: usize| {
        let arrives = scene_probe.hits().filter_map(|(_, hit)| Some(hit.contribution(light)?.unoccluded.max_element()));
        arrives.filter(|light| light.is_finite()).fold(0.0, f32::max)
    };
    let working =
        (0..scene_probe.verdicts().len()).filter(|&light| scene_probe.verdicts()[light] == LightVerdict::Works);
    let all: Vec<(usize, f32)> = working.take(MAX_LIGHTS).map(|light| (light, strength(light))).collect();
    let most = all.iter().map(|(_, strength)| *strength).fold(0.0, f32::max);
    all.into_iter().filter(|(_, strength)| *strength >= FILL_LIGHT_RATIO * most).map(|(light, _)| light).collect()
}

/// Reports lights that reach few visible surfaces because most of the surfaces face away.
fn mostly_dark(scene_probe: &SceneProbe) -> Vec<Finding> {
    let working = main_lights(scene_probe);
    let (mut all, mut reached, mut away, mut turned, mut grazed) = (0, 0, 0, 0, 0);
    let is_main = |lit: &&LightContribution| working.contains(&lit.light);
    let bright = |lit: &LightContribution| {
        is_main(&lit) && lit.cosine > GRAZING && lit.contribution.abs().max_element() > VISIBLE
    };
    // If back faces are not shaded, the light is not to blame for a dark back face.
    let shaded = scene_probe.input.job.settings.shade_back;
    // Glass shows what is behind it.
    let shows = |hit: &ProbeHit| (shaded || !hit.from_behind) && !scene_probe.is_glass(hit.object);
    for (_, hit) in scene_probe.hits().filter(|(_, hit)| shows(hit)) {
        all += 1;
        reached += usize::from(hit.lights.iter().any(&bright));
        let faces_away = hit.lights.iter().filter(is_main).all(|lit| lit.cosine <= GRAZING);
        away += usize::from(faces_away);
        turned += usize::from(hit.lights.iter().filter(is_main).all(|lit| lit.cosine <= 0.0));
        grazed += usize::from(faces_away && hit.lights.iter().filter(is_main).any(is_grazing));
    }
    // If surfaces are black or in shadow, the direction of the lights is not the cause.
    let reaches = reached as f32 > MOSTLY_DARK * all as f32;
    if all == 0 || working.is_empty() || reaches || away * 2 < all - reached || super::colors::all_black(scene_probe) {
        return Vec::new();
    }
    let Some(span) = span(scene_probe, working[0]) else { return Vec::new() };
    if grazed * 2 > away {
        return grazing(scene_probe, &working)
            .into_iter()
            .map(|diagnostic| Finding::from(diagnostic).affecting_whole_picture(true))
            .collect();
    }
    let which = if working.len() == 1 { "this light" } else { "the lights" };
    let low = turned * 2 < away;
    let message = match low {
        true => format!(
            "{} of the visible surfaces get light from {which} only at grazing angles",
            percent(away - turned, all)
        ),
        false => format!("{} of the visible surfaces face away from {which}", percent(turned, all)),
    };
    let mut diagnostic = Diagnostic::warning(message)
        .effect(match scene_probe.world().ambient().max_element() > VISIBLE {
            true => "most of the visible surface area shows only ambient light, flat and dark",
            false => "most of the visible surface area is black",
        })
        .help(match low {
            true => "change the `direction` in which the light travels, or its `position`: N · L is nearly 0 there",
            false => {
                "change the `direction` in which the light travels, or its `position`: the light is behind the visible \
                 surfaces"
            }
        });
    diagnostic = scene_probe.at_value(diagnostic, span, &["direction", "position"]);
    // If all lights are behind the surfaces, each `direction` probably points towards the light
    // source.
    for &light in &working {
        let Some(light) = description(scene_probe, light) else { continue };
        if let (None, Some(direction), false) = (light.value.position(), light.value.direction(), low) {
            diagnostic = diagnostic.fix_at(scene_probe.field_span(light.span, &["direction"]), vector(-direction));
        }
    }
    // A crescent on a round object may be intentional, but a floor without any light is not.
    let flat = |object: u32| scene_probe.world().objects()[object as usize].bounds().is_none();
    let floor = scene_probe.hits().any(|(_, hit)| flat(hit.object));
    let lit_floor = scene_probe.hits().any(|(_, hit)| flat(hit.object) && hit.lights.iter().any(bright));
    if (!floor || lit_floor) && reached as f32 > 0.02 * all as f32 {
        // A crescent may be intentional, so no edit is offered.
        diagnostic.severity = Severity::Note;
        diagnostic.fix.clear();
        return vec![Finding::from(diagnostic)];
    }
    vec![Finding::from(diagnostic).affecting_whole_picture((reached as f32) < NEARLY_ALL_DARK * all as f32)]
}

/// Maximum distance at which an edit places a light, as a multiple of the scene's size.
const MAX_DISTANCE: f32 = 20.0;

fn is_grazing(lit: &LightContribution) -> bool {
    lit.cosine.abs() <= 1e-3
}

/// Reports the first light that meets the visible surfaces only at grazing angles.
fn grazing(scene_probe: &SceneProbe, lights: &[usize]) -> Option<Diagnostic> {
    let light = *lights.iter().find(|light| {
        let all = scene_probe.hits().filter_map(|(_, hit)| hit.contribution(**light));
        let (grazed, count) =
            all.fold((0, 0), |(grazed, count), lit| (grazed + usize::from(is_grazing(lit)), count + 1));
        grazed * 4 > count
    })?;
    let (diagnostic, span) =
        no_contribution(scene_probe, light, "this light only grazes the visible surfaces: N · L is 0 there".into())?;
    let objects: Vec<u32> = scene_probe
        .hits()
        .filter(|(_, hit)| hit.contribution(light).is_some_and(is_grazing))
        .map(|(_, hit)| hit.object)
        .collect();
    let surface = most_common(&objects)?;
    let diagnostic = diagnostic.related(scene_probe.object_span(surface), "the surface that the light grazes");
    let (probe, _) =
        scene_probe.hits().find(|(_, hit)| hit.object == surface && hit.contribution(light).is_some_and(is_grazing))?;
    let at = scene_probe.world().intersect(&probe.ray, &mut ())?;
    let n = if at.inside() { -at.surface.n_geo } else { at.surface.n_geo };
    let emitter = &description(scene_probe, light)?.value;
    match emitter.position() {
        None => {
            let direction = emitter.direction()?;
            let tilted = vector(direction - 0.7 * direction.length() * n);
            let value = scene_probe.field_span(span, &["direction"]);
            let help = format!(
                "write `direction {tilted}` to reach the surface; `direction` is the direction in which the light \
                 travels"
            );
            Some(scene_probe.at_value(diagnostic.fix_at(value, tilted), span, &["direction"]).help(help))
        }
        Some(from) => {
            let eye = scene_probe.world().camera().pose().center;
            let place = from + 0.5 * (eye - from).length().max(1e-3) * n;
            let raised = vector(place);
            let bounds = scene_probe.world().bounds();
            let wide = if bounds.is_empty() {
                f32::INFINITY
            } else {
                bounds.size().length() + (eye - bounds.center()).length()
            };
            // If the light is far outside the scene, that is a separate mistake.
            if (place - eye).length() > MAX_DISTANCE * wide {
                let help = "move the light nearer and out of the plane of the surface: it is far from everything";
                return Some(scene_probe.at_value(diagnostic, span, &["position"]).help(help));
            }
            let value = scene_probe.field_span(span, &["position"]);
            let written = written_position(scene_probe, place);
            let help = format!("raise the light out of the plane of the surface, for example {written}");
            Some(scene_probe.at_value(diagnostic.fix_at(value, raised), span, &["position"]).help(help))
        }
    }
}

/// Reports lights that lie in a visible plane or shine parallel to it, and therefore do not
/// illuminate it.
fn along_plane(scene_probe: &SceneProbe) -> Vec<Finding> {
    let floor = super::ground::floor(scene_probe).map(|(object, _)| object);
    let flat = |object: u32| scene_probe.world().objects()[object as usize].bounds().is_none();
    let is_along = |light: &usize| {
        // Only light from infinity meets all of a bounded floor at the same angle.
        let is_far = scene_probe.world().lights()[*light].position().is_none();
        let flat = |object: u32| flat(object) || is_far && floor == Some(object);
        let all =
            scene_probe.hits().filter(|(_, hit)| flat(hit.object)).filter_map(|(_, hit)| hit.contribution(*light));
        let (count, along) = all.fold((0, 0), |(n, along), lit| (n + 1, along + usize::from(is_grazing(lit))));
        count * 5 > scene_probe.hits().count() && along * 10 > count * 9
    };
    main_lights(scene_probe)
        .into_iter()
        .filter(is_along)
        .filter_map(|light| grazing(scene_probe, &[light]))
        .map(|diagnostic| diagnostic.effect("the surface that the light grazes gets none of its light"))
        .map(|diagnostic| match scene_probe.model_format().map(|format| format.name) {
            Some("glTF") => diagnostic.help("turn the light downwards: without a rotation, it shines along -z"),
            _ => diagnostic,
        })
        .map(Finding::from)
        .collect()
}

/// Reports the only light of a path-traced scene if it shines upwards and most of the visible
/// surfaces face away from it.
fn from_below(scene_probe: &SceneProbe) -> Option<Finding> {
    let world = scene_probe.world();
    let [Light::Directional(own)] = world.lights() else { return None };
    // In the light of a sky or of lights, it can be a weak second light.
    let has_other_light = world.environment().is_some()
        || world.cube_map().is_some()
        || !super::area_lights::emissive_objects(scene_probe).is_empty();
    if has_other_light {
        return None;
    }
    let lit = scene_probe.hits().filter_map(|(_, hit)| hit.contribution(0));
    let (all, away) = lit.fold((0, 0), |(all, away), lit| (all + 1, away + usize::from(lit.cosine < -GRAZING)));
    let span = span(scene_probe, 0).filter(|_| is_upwards(scene_probe, own.direction) && away * 2 > all)?;
    let message = format!("this light shines upwards: {} of the visible surfaces face away", percent(away, all));
    let turned = vector(-own.direction);
    let diagnostic = Diagnostic::warning(message)
        .effect("the light is visible only on the undersides and sides of objects")
        .help(format!("write `direction {turned}`: `direction` is the direction in which the light travels"))
        .fix_at(scene_probe.field_span(span, &["direction"]), turned);
    Some(Finding::from(scene_probe.at_value(diagnostic, span, &["direction"])))
}

/// Reports lights behind the visible surfaces.
pub(super) fn behind(scene_probe: &SceneProbe) -> Vec<Finding> {
    // Paths also find light that is reflected, and that of the background.
    let is_bright = scene_probe.is_physical() && !scene_probe.is_dark();
    let mut findings = if is_bright { Vec::new() } else { mostly_dark(scene_probe) };
    if findings.is_empty() && (!is_bright || super::physical::has_only_lights(scene_probe)) {
        findings = along_plane(scene_probe);
    }
    if is_bright && !none_contributes(scene_probe) {
        findings.extend(from_below(scene_probe));
        return findings;
    }
    findings.extend(for_each_verdict(scene_probe, |light, verdict| {
        if verdict != LightVerdict::Behind
            || is_bright && super::scene_probe::Reach::of(scene_probe).is_lit_by(scene_probe, light)
        {
            return None;
        }
        let lit: Vec<&LightContribution> = scene_probe.hits().filter_map(|(_, hit)| hit.contribution(light)).collect();
        let away = lit.iter().filter(|lit| lit.cosine <= 1e-3).count();
        let turned = lit.iter().filter(|lit| lit.cosine < -1e-3).count();
        if turned * 2 < away {
            return grazing(scene_probe, &[light]);
        }
        let emitter = &description(scene_probe, light)?.value;
        let from = match emitter.direction().filter(|_| emitter.position().is_none()) {
            Some(direction) if is_upwards(scene_probe, direction) => "shines upwards, from behind",
            _ => "is behind",
        };
        let message = format!("this light {from} the visible surfaces: {} of them face away", percent(away, lit.len()));
        let (diagnostic, span) = no_contribution(scene_probe, light, message)?;
        let diagnostic = match emitter.position() {
            None => {
                let turned = vector(-emitter.direction()?);
                let help = format!(
                    "write `direction {turned}` to light the visible side: `direction` is the direction in which the \
                     light travels, not the direction to the light"
                );
                let fixed = diagnostic.fix_at(scene_probe.field_span(span, &["direction"]), turned);
                scene_probe.at_value(fixed, span, &["direction"]).help(help)
            }
            Some(_) => {
                let eye = scene_probe.world().camera().pose().center;
                let help = format!("move the light to the camera's side: the camera is at {}", vector(eye));
                scene_probe.at_value(diagnostic, span, &["position"]).help(help)
            }
        };
        // If other lights contribute, this light may be meant for the hidden side.
        Some(if none_contributes(scene_probe) {
            diagnostic
        } else {
            Diagnostic { severity: Severity::Note, ..diagnostic }
        })
    }));
    findings
}

/// Reports lights whose colour is completely absorbed by the surfaces that they reach.
pub(super) fn cancelled(scene_probe: &SceneProbe) -> Vec<Finding> {
    for_each_verdict(scene_probe, |light, verdict| {
        if verdict != LightVerdict::Cancelled || super::colors::all_black(scene_probe) {
            return None;
        }
        let message = "the surfaces lit by this light reflect none of its colour".to_string();
        let (diagnostic, span) = no_contribution(scene_probe, light, message)?;
        let color = vector(scene_probe.world().lights()[light].color());
        let help = format!(
            "change the colour of the light, which is {color}, or of the surfaces: the colours are multiplied per \
             channel"
        );
        let material = scene_probe.hits().next().map(|(_, hit)| hit.material)?;
        let diagnostic = match scene_probe.input.scene.materials.get(material as usize) {
            Some(material) => diagnostic.related(material.span, "a material that the light reaches"),
            None => diagnostic,
        };
        Some(scene_probe.at_value(diagnostic, span, &["color"]).help(help))
    })
}

/// Reports lights that are defined twice.
pub(super) fn duplicates(scene_probe: &SceneProbe) -> Vec<Finding> {
    let lights = scene_probe.input.scene.lights.as_deref().unwrap_or_default();
    let pairs = lights.iter().enumerate().filter_map(|(i, light)| {
        let first = lights[..i].iter().find(|first| first.value == light.value)?;
        Some(Diagnostic::warning("this light is defined twice").at(light.span).related(first.span, "the first one"))
    });
    let say = |diagnostic: Diagnostic| {
        let diagnostic = diagnostic.effect("the light is added twice");
        Finding::from(with_removal(scene_probe, diagnostic.help("remove one of the two lights")))
    };
    pairs.map(say).collect()
}

/// Adds the edits that remove a light from the file and reduce the number of lights.
fn with_removal(scene_probe: &SceneProbe, diagnostic: Diagnostic) -> Diagnostic {
    let Some(own) = diagnostic.span else { return diagnostic };
    let Some(bytes) = scene_probe.input.files.bytes(own.file) else { return diagnostic };
    let Some(whole) = block(bytes, own) else { return diagnostic };
    let count = section(bytes, own.file, "Lights").and_then(|lights| scene_probe.field_span(lights, &["numLights"]));
    let left = scene_probe.world().lights().len() - 1;
    match count {
        Some(count) => diagnostic.fix(whole, "").fix(count, left.to_string()),
        None => diagnostic.fix(whole, ""),
    }
}
