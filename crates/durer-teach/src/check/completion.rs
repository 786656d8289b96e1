//! Adds effects and edits that depend on the whole scene to the diagnostics of the reader and the
//! compiler.

use super::finding::{Finding, vector};
use super::scene_probe::SceneProbe;
use durer_diag::{Severity, Span};
use durer_formats::course::place;
use durer_scene::camera::Projection;
use durer_scene::dialect::Dialect;
use durer_scene::light::Illuminate as _;
use durer_scene::math::Vec3;
use durer_scene::scene::Background;

/// Adds an effect, help or edits to a finding, based on the compiled scene.
pub(super) fn complete(scene_probe: &SceneProbe, finding: &mut Finding) {
    match finding.diagnostic.code {
        "no-light" => no_light(scene_probe, finding),
        "black-light" => {
            finding.affects_whole_picture = super::lights::none_contributes(scene_probe);
            finding.diagnostic.effect = Some(match finding.affects_whole_picture {
                true => "no light reaches the visible surfaces".into(),
                false => "this light contributes nothing to the picture".into(),
            });
            if is_only_light(scene_probe) {
                (finding.diagnostic.severity, finding.affects_whole_picture) = (Severity::Warning, true);
                finding.diagnostic.effect = Some("nothing else emits light, so the picture is black".into());
            }
            let strength = finding.diagnostic.span.and_then(|span| super::attenuation::strength(scene_probe, span));
            let value = strength.filter(|(field, _)| finding.diagnostic.message.contains(&format!("`{field}`")));
            if let Some((field, value)) = value {
                finding.diagnostic.span = Some(value);
                finding.diagnostic.help.get_or_insert(format!("write a `{field}` above 0"));
            } else if let Some(value) =
                finding.diagnostic.span.and_then(|span| scene_probe.field_span(span, &["color"]))
            {
                finding.diagnostic.span = Some(value);
                finding.diagnostic.help.get_or_insert("for white light, write `color 1 1 1`".into());
            }
        }
        "sun-below" => {
            finding.affects_whole_picture = is_only_light(scene_probe);
            if let Some(help) =
                sun_help(&scene_probe.input.scene.background).filter(|_| scene_probe.model_format().is_none())
            {
                finding.diagnostic.help = Some(help);
            }
            let fields = ["sun", "timeZone", "time", "sunAltitude"];
            if let Some(value) = finding.diagnostic.span.and_then(|span| scene_probe.field_span(span, &fields)) {
                finding.diagnostic.span = Some(value);
            }
        }
        // The reader of environments reports a black one.
        "bad-file" if finding.diagnostic.message.ends_with("is black: it emits no light") => {
            finding.diagnostic.code = "black-sky";
            finding.affects_whole_picture = is_only_light(scene_probe);
            finding.diagnostic.effect = Some(match finding.affects_whole_picture {
                true => "nothing else emits light, so the picture is black".into(),
                false => "the environment emits no light and is invisible".into(),
            });
        }
        // The second section replaces all that the first one contains.
        "repeated" if finding.diagnostic.message.starts_with("the scene has more than") => {
            finding.affects_whole_picture = true;
            finding.diagnostic.effect.get_or_insert("everything in the first one is ignored".into());
            finding.diagnostic.help.get_or_insert("write one section that contains everything".into());
        }
        "no-falloff" | "bad-place" => finding.affects_whole_picture = true,
        "no-objects" => {
            finding.affects_whole_picture = true;
            finding.diagnostic.effect = Some("every ray misses, so the picture shows only the background".into());
        }
        "empty-solid" => {
            finding.diagnostic.effect.get_or_insert("the solid is invisible".into());
            finding.diagnostic.help.get_or_insert(
                "move the parts of the solid until they overlap: an intersection is what all parts have in common"
                    .into(),
            );
        }
        "foreign-word" => foreign_in_nodes(scene_probe, finding),
        "up-parallel" => up_parallel(scene_probe, finding),
        "material-index" => material_index(scene_probe, finding),
        "no-material" => no_material(scene_probe, finding),
        "mesh-file" | "comment" => finding.diagnostic.severity = Severity::Note,
        _ => {}
    }
}

/// Difference in hours between a time zone and the mean solar time of a place above which the time
/// zone is wrong.
const MAX_ZONE_DIFFERENCE: f32 = 4.0;

/// Returns the help about a sun below the horizon if the time zone is missing or wrong, or if the
/// direction may be that in which the light travels.
fn sun_help(background: &Background) -> Option<String> {
    if let Some(sun) = background.sun {
        return Some(format!("`sun` is the direction to the sun: write `sun {}`", vector(-sun)));
    }
    let longitude = background.longitude.filter(|_| background.time.is_some())?;
    let zone = (longitude / 15.0).round();
    let local = Background { time_zone: Some(zone), ..background.clone() };
    local.sun().filter(|way| way.y > 0.0)?;
    // West is negative.
    let mirror = Background { longitude: Some(-longitude), ..background.clone() };
    let mirrored = match mirror.sun().filter(|way| way.y > 0.0) {
        Some(_) => format!(", or `longitude {}` if the place is on the other side of Greenwich", -longitude),
        None => String::new(),
    };
    match background.time_zone {
        None => Some(format!(
            "the `time` is taken as UTC because there is no `timeZone`: if it is local time, write `timeZone {zone}`, \
             which fits the longitude"
        )),
        Some(written) => (written - zone)
            .abs()
            .gt(&MAX_ZONE_DIFFERENCE)
            .then(|| format!("`timeZone {written}` does not fit the longitude: try `timeZone {zone}`{mirrored}")),
    }
}

/// Returns true if the scene has neither lights nor emissive surfaces nor a background, so that
/// only its sky could emit light.
fn is_only_light(scene_probe: &SceneProbe) -> bool {
    let world = scene_probe.world();
    world.lights().iter().all(|light| light.color() == Vec3::ZERO)
        && super::area_lights::emissive_objects(scene_probe).is_empty()
        && (world.background() == Vec3::ZERO || world.is_dark())
}

/// Adds help about placing objects. In the node grammar, the surrounding node places an object. In
/// other dialects, the object's own fields do.
fn foreign_in_nodes(scene_probe: &SceneProbe, finding: &mut Finding) {
    // Values that are ignored because of their number change the light.
    if finding.diagnostic.message.ends_with("no effect") {
        finding.affects_whole_picture = true;
        return;
    }
    finding.diagnostic.severity = Severity::Note;
    let word = finding.diagnostic.span.map(|span| scene_probe.text(span)).unwrap_or_default();
    if scene_probe.input.dialect == Dialect::F23
        && finding.diagnostic.help.is_none()
        && ["center", "position"].contains(&word.as_str())
    {
        finding.diagnostic.help = Some(
            "move the object with the `Node` that encloses it: `Node { Transform { translate 1 2 3 } ... }`".into(),
        );
    }
}

/// Completes the finding about missing lights.
fn no_light(scene_probe: &SceneProbe, finding: &mut Finding) {
    finding.affects_whole_picture = true;
    finding.diagnostic.effect = Some("every surface has one flat colour, without shading or shadows".into());
    finding.diagnostic.help = Some(
        match scene_probe.input.dialect {
            Dialect::F23 => {
                "add a node, such as `Node { Component<Light> { type directional direction -1 -2 -1 color 0.9 0.9 0.9 } }`"
            }
            _ => "add lights: `Lights { numLights 1 DirectionalLight { direction -1 -2 -1 color 0.9 0.9 0.9 } }`",
        }
        .into(),
    );
}

fn up_parallel(scene_probe: &SceneProbe, finding: &mut Finding) {
    finding.diagnostic.effect = Some("the picture has an arbitrary rotation".into());
    let direction = scene_probe.world().camera().pose().direction.normalize_or_zero();
    let up = if direction.y.abs() < 0.9 { Vec3::Y } else { Vec3::Z };
    if let Some(value) = scene_probe.field_span(scene_probe.input.scene.camera_span, &["up"]) {
        finding.diagnostic.span = Some(value);
        finding.diagnostic.help = Some(format!("choose another `up`, such as `{}`", vector(up)));
        finding.diagnostic = finding.diagnostic.clone().fix(value, vector(up));
    }
}

/// Suggests a material index. If an index is too large by one, or if there is only one material,
/// the correction is certain.
fn material_index(scene_probe: &SceneProbe, finding: &mut Finding) {
    finding.diagnostic.effect = finding.diagnostic.help.take();
    let count = scene_probe.input.scene.materials.len();
    let Some(span) = finding.diagnostic.span else { return };
    let text = scene_probe.text(span);
    let Some((word, index)) = text.rsplit_once(char::is_whitespace) else { return };
    if count == 0 {
        finding.diagnostic.help = Some("add a `Materials` section".into());
        return;
    }
    if from_one(scene_probe, finding, count) {
        return;
    }
    let suggestion = index.parse::<usize>().map_or(0, |index| if index == count { count - 1 } else { 0 });
    let unused = super::names::unused_materials(scene_probe);
    finding.diagnostic.help = Some(match (count, &unused[..]) {
        (1, _) => "material indices start at 0: write 0".into(),
        (_, [one]) => format!("material indices start at 0: use 0 to {}; only material {one} is not used", count - 1),
        _ => format!("material indices start at 0: use 0 to {}", count - 1),
    });
    let only = count == 1 || index.parse() == Ok(count);
    if only {
        finding.diagnostic = finding.diagnostic.clone().fix(span, format!("{} {suggestion}", word.trim_end()));
    }
}

/// Corrects all indices if no object and no pattern uses material 0, all other materials are used,
/// and some object uses the index after the last one. This means that the indices start at 1.
fn from_one(scene_probe: &SceneProbe, finding: &mut Finding, count: usize) -> bool {
    let span = finding.diagnostic.span.unwrap_or_default();
    let uses = scene_probe.input.files.bytes(span.file).map(|bytes| place::values(bytes, span.file, "MaterialIndex"));
    let uses: Vec<(Span, usize)> =
        uses.into_iter().flatten().filter_map(|value| Some((value, scene_probe.text(value).parse().ok()?))).collect();
    let parts = scene_probe.input.files.bytes(span.file).map(|bytes| place::values(bytes, span.file, "materialIndex"));
    let has_patterns = parts.is_some_and(|parts| !parts.is_empty());
    let is_used = |index: usize| uses.iter().any(|(_, used)| *used == index);
    let is_shifted = !is_used(0) && (1..=count).all(is_used) && uses.iter().all(|(_, index)| *index <= count);
    if count < 2 || has_patterns || !is_shifted {
        return false;
    }
    finding.diagnostic.help = Some(
        "material indices start at 0, but the indices in this file start at 1: subtract 1 from each `MaterialIndex`"
            .into(),
    );
    for (value, index) in uses {
        finding.diagnostic = finding.diagnostic.clone().fix(value, (index - 1).to_string());
    }
    true
}

fn no_material(scene_probe: &SceneProbe, finding: &mut Finding) {
    finding.diagnostic.effect = Some("the object does not have the intended colour".into());
    let scene = scene_probe.input.scene;
    let first = scene.root.iter().flat_map(|root| &root.objects).next();
    let nodes = scene_probe.input.dialect == durer_scene::dialect::Dialect::F23;
    // At the top of the group, it applies to all objects that do not have an index of their own.
    if let Some(first) = first.filter(|first| first.material.is_none() && !scene.materials.is_empty() && !nodes) {
        let place = Span { end: first.span.start, ..first.span };
        finding.diagnostic = finding.diagnostic.clone().fix(place, "MaterialIndex 0 ");
    }
}
