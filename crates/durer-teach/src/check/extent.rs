//! Checks sizes: objects that are too small or too large to be visible, and unsuitable fields of
//! view.

use super::finding::{Finding, MAX_FINDINGS, number};
use super::scene_probe::SceneProbe;
use super::shapes::is_ball;
use super::verdict::LightVerdict;
use super::visibility::{Visibility, pixels};
use durer_diag::{Diagnostic, Severity, Span};
use durer_scene::camera::{Camera, Projection};
use durer_scene::light::{Illuminate as _, Light};
use durer_scene::math::{Aabb, Vec3, fp};
use durer_scene::scene::{MatrixOp, Object, ObjectKind};

/// Minimum size, in pixels, of a recognisable object.
const MIN_PIXELS: f32 = 6.0;
/// Minimum fraction of the picture's larger side that all objects together are meant to span.
const MIN_SHARE: f32 = 0.04;
/// Minimum fraction that the objects span if the picture shows nothing else.
const MIN_SHARE_ALONE: f32 = 0.065;
/// Ratios to the typical size above which an object is out of scale, one for harmless objects and
/// one for objects that spoil the picture.
const OUT_OF_SCALE: f32 = 3e3;
const HARMFUL: f32 = 100.0;
/// Size ratio above which an object that contains the camera is out of scale, and ratio for a ball
/// in whose inside hardly anything is lit.
const MAX_ENCLOSING_RATIO: f32 = 20.0;
const MAX_DARK_RATIO: f32 = 8.0;
/// Size in pixels below which an object next to a far larger one is only a speck.
const SPECK: f32 = 2.5;
/// Maximum number of objects in a scene in which one of them is blamed for its size.
const FEW_OBJECTS: usize = 8;

/// Field of view, in degrees, below which a part of one object is probably not meant to fill the
/// picture.
const VERY_NARROW: f32 = 2.0;

/// Range of sizes that single precision can represent next to other objects.
const REPRESENTABLE_SIZES: std::ops::Range<f32> = 1e-9..1e9;

/// Reports scenes whose bounded objects together cover only a few pixels.
pub(super) fn too_small(scene_probe: &SceneProbe) -> Vec<Finding> {
    let bounds = scene_probe.world().bounds();
    // `degenerate-mesh` reports meshes that are a single point.
    let Some(size) =
        Some(bounds).filter(|b| !b.is_empty() && b.size() != Vec3::ZERO).and_then(|bounds| pixels(scene_probe, bounds))
    else {
        return Vec::new();
    };
    let empty = scene_probe.hits().next().is_none();
    // A very wide field of view is meant to show a large area, not a few small objects in the
    // centre.
    let share: f32 = match scene_probe.world().camera() {
        Camera::Perspective(camera) if camera.angle > 120.0 => 0.12,
        Camera::Perspective(camera) if camera.angle > 90.0 => 0.08,
        Camera::Orthographic(_) => 0.12,
        _ => 0.0,
    };
    let least = (share.max(MIN_SHARE) * scene_probe.larger_side()).max(MIN_PIXELS);
    // Without a plane, nothing else is in the picture.
    let alone = scene_probe.world().objects().iter().all(|object| object.bounds().is_some());
    let fewest = if alone { least.max(MIN_SHARE_ALONE * scene_probe.larger_side()) } else { least };
    let severity = if size < least { Severity::Warning } else { Severity::Note };
    if size >= fewest || !empty && !scene_probe.visibilities().contains(&Visibility::Visible) {
        return Vec::new();
    }
    let (span, larger) = (scene_probe.input.scene.camera_span, scene_probe.larger_side());
    let wanted = 0.6 * larger / size.max(1e-6);
    let message = format!("all objects together are {} pixels wide in a picture of {larger} pixels", number(size));
    let diagnostic = Diagnostic { severity, ..Diagnostic::warning(message) }.effect(match empty && size < MIN_PIXELS {
        true => "at most a few rays hit the objects, so the picture shows little but the background",
        false => "the objects are hardly visible",
    });
    let (diagnostic, field) = match scene_probe.world().camera() {
        Camera::Perspective(camera) if camera.angle > 90.0 => {
            (diagnostic.help("use a smaller field of view, such as 40 degrees, or move closer"), "angle")
        }
        Camera::Orthographic(camera) => {
            let help = format!("use a smaller picture size, such as `size {}`", number(camera.size / wanted));
            let diagnostic = diagnostic.fix_at(scene_probe.field_span(span, &["size"]), number(camera.size / wanted));
            (diagnostic.help(help), "size")
        }
        _ => {
            let help = format!("move about {} times closer, or scale the objects up by that factor", number(wanted));
            (diagnostic.help(help), "center")
        }
    };
    let diagnostic = scene_probe.at_value(diagnostic, span, &[field, if field == "angle" { "fov" } else { field }]);
    vec![Finding::from(diagnostic).affecting_whole_picture(severity == Severity::Warning)]
}

/// Reports pictures that show only a tiny part of the objects, for example because an angle is in
/// radians.
pub(super) fn too_narrow(scene_probe: &SceneProbe) -> Vec<Finding> {
    let (bounds, span, larger) =
        (scene_probe.world().bounds(), scene_probe.input.scene.camera_span, scene_probe.larger_side());
    // If an object is entirely visible, the camera is not too close.
    let hit = scene_probe
        .world()
        .objects()
        .iter()
        .zip(scene_probe.visibilities())
        .filter(|(_, sight)| **sight == Visibility::Visible);
    let sizes: Vec<f32> = hit.filter_map(|(object, _)| pixels(scene_probe, object.bounds()?)).collect();
    if bounds.is_empty() {
        return Vec::new();
    }
    if let Some(finding) = part_of_one_object(scene_probe, &sizes).or_else(|| angle_in_radians(scene_probe, &sizes)) {
        return vec![finding];
    }
    if sizes.iter().any(|size| *size < 3.0 * larger) {
        return filled_by_one_object(scene_probe, &sizes).into_iter().collect();
    }
    let radians = |angle: f32| angle <= std::f32::consts::PI;
    match scene_probe.world().camera() {
        camera if field_of_view(camera).is_some_and(|angle| angle < 5.0) => {
            let angle = field_of_view(camera).unwrap_or_default();
            // A telescope is meant to show distant objects.
            let Some(size) = pixels(scene_probe, bounds).filter(|size| *size > 8.0 * larger) else { return Vec::new() };
            let degrees = angle.to_degrees();
            let mut diagnostic = narrow(angle)
                .effect(format!("less than 1/{} of the scene's width is visible", number((size / larger).floor())))
                .help("use a larger angle: angles are in degrees, and 30 to 60 degrees are usual");
            if let Some(place) = scene_probe.field_span(span, &["angle", "fov"]).filter(|_| radians(angle)) {
                let whole = degrees.round().clamp(20.0, 100.0);
                diagnostic = diagnostic.fix(place, number(whole)).help(format!(
                    "angles are in degrees; if this value is in radians, it is {} degrees: try `{whole}`",
                    number(degrees)
                ));
            }
            vec![at_angle(scene_probe, diagnostic)]
        }
        Camera::Orthographic(camera) => {
            // A picture that the surface of a single object fills shows nothing useful.
            let mut hit: Vec<u32> = scene_probe.hits().map(|(_, hit)| hit.object).collect();
            hit.sort_unstable();
            hit.dedup();
            let most = if hit.len() == 1 { 8.0 } else { 30.0 };
            let Some(size) = pixels(scene_probe, bounds).filter(|size| *size > most * larger) else {
                return Vec::new();
            };
            let wanted = number(1.2 * camera.size * size / larger);
            let diagnostic = Diagnostic::warning(format!("the picture is only {} wide", number(camera.size)))
                .effect(format!("less than 1/{} of the scene's width is visible", number((size / larger).floor())))
                .help(format!("write `size {wanted}` to show the full scene"));
            let diagnostic = diagnostic.fix_at(scene_probe.field_span(span, &["size"]), wanted);
            vec![Finding::from(scene_probe.at_value(diagnostic, span, &["size"])).affecting_whole_picture(true)]
        }
        _ => Vec::new(),
    }
}

/// Reports a very narrow field of view that a part of one object fills, while other objects are
/// outside it.
fn part_of_one_object(scene_probe: &SceneProbe, sizes: &[f32]) -> Option<Finding> {
    let angle = field_of_view(scene_probe.world().camera())?;
    let objects = scene_probe.world().objects();
    let first = scene_probe.hits().next()?.1.object;
    let whole = scene_probe.probes.iter().all(|probe| probe.hit.as_ref().is_some_and(|hit| hit.object == first));
    let outside = outside_count(scene_probe);
    let part = sizes.iter().all(|size| *size > 3.0 * scene_probe.larger_side());
    if angle >= VERY_NARROW || !whole || !part || outside == 0 || objects[first as usize].bounds().is_none() {
        return None;
    }
    let diagnostic = narrow(angle)
        .effect(format!(
            "a part of one object fills the picture, and {} outside the picture",
            super::finding::counted(outside, "object is", "objects are")
        ))
        .help(radians_help(scene_probe, angle));
    Some(at_angle(scene_probe, diagnostic))
}

/// Returns a warning about a narrow field of view.
fn narrow(angle: f32) -> Diagnostic {
    Diagnostic::warning(format!("the field of view is only {} degrees", number(angle)))
}

/// Returns the finding of a diagnostic about the camera's field of view, which spoils the whole
/// picture.
fn at_angle(scene_probe: &SceneProbe, diagnostic: Diagnostic) -> Finding {
    let span = scene_probe.input.scene.camera_span;
    Finding::from(scene_probe.at_value(diagnostic, span, &["angle", "fov"])).affecting_whole_picture(true)
}

/// Returns the number of bounded objects outside the picture.
fn outside_count(scene_probe: &SceneProbe) -> usize {
    let objects = scene_probe.visibilities().iter().zip(scene_probe.world().objects());
    objects.filter(|(sight, object)| **sight == Visibility::Outside && object.bounds().is_some()).count()
}

/// Returns the field of view across the larger side of the picture, in degrees, of a camera with a
/// single eye that shows straight lines as straight lines.
fn field_of_view(camera: &Camera) -> Option<f32> {
    match camera {
        Camera::Perspective(camera) => Some(camera.angle),
        Camera::ThinLens(camera) => Some(camera.angle),
        Camera::Pinhole(camera) => Some(camera.angle),
        _ => None,
    }
}

/// Returns help about a field of view that may be in radians, in the words of the scene's format.
fn radians_help(scene_probe: &SceneProbe, angle: f32) -> String {
    let degrees = number(angle.to_degrees());
    match scene_probe.model_format().map(|format| format.name) {
        Some("glTF") => "the yfov is in radians, and 0.5 to 1 is usual".into(),
        Some("OpenUSD") => "use a smaller focal length, or a larger aperture".into(),
        _ => format!(
            "angles are in degrees, and 30 to 60 degrees are usual; if this value is in radians, it is {degrees} degrees"
        ),
    }
}

/// Smallest and largest angle that can be a usual field of view in radians.
const RADIANS: std::ops::Range<f32> = 0.2..2.1;

/// Reports a field of view that is a usual angle in radians, and in degrees cuts off what is in
/// front of the camera.
fn angle_in_radians(scene_probe: &SceneProbe, sizes: &[f32]) -> Option<Finding> {
    let angle = field_of_view(scene_probe.world().camera())?;
    let outside = outside_count(scene_probe);
    let is_cut = sizes.iter().any(|size| *size > 1.5 * scene_probe.larger_side());
    if !RADIANS.contains(&angle) || angle.fract() == 0.0 || outside == 0 && !is_cut {
        return None;
    }
    let diagnostic = narrow(angle)
        .effect("the picture shows only a tiny part of what is in front of the camera")
        .help(radians_help(scene_probe, angle));
    let place = scene_probe.field_span(scene_probe.input.scene.camera_span, &["angle", "fov"]);
    Some(at_angle(scene_probe, diagnostic.fix_at(place, number(angle.to_degrees().round()))))
}

/// Reports a narrow field of view that one object fills while most other objects are outside it.
fn filled_by_one_object(scene_probe: &SceneProbe, sizes: &[f32]) -> Option<Finding> {
    let angle = field_of_view(scene_probe.world().camera())?;
    let out = outside_count(scene_probe);
    let filled = sizes.iter().all(|size| *size > 0.9 * scene_probe.larger_side());
    if angle > 12.0 || sizes.is_empty() || !filled || out < 2 || out < sizes.len() {
        return None;
    }
    let diagnostic = narrow(angle)
        .effect(match sizes.len() {
            1 => format!("one object fills the picture, and {out} are outside it"),
            n => format!("{n} objects fill the picture, and {out} are outside it"),
        })
        .help("check whether a digit is missing: 30 to 60 degrees are usual");
    Some(at_angle(scene_probe, diagnostic))
}

/// Returns the ratio of an object's size to that of the largest other object if it is so large that
/// an object around the camera is out of scale.
pub(super) fn times_larger(scene_probe: &SceneProbe, object: u32) -> Option<f32> {
    let size = |i: usize| Some(scene_probe.world().objects()[i].bounds()?.size().max_element());
    let others = (0..scene_probe.world().objects().len()).filter(|&i| i != object as usize).filter_map(size);
    let times = size(object as usize)? / others.fold(0.0, f32::max);
    let is_dark_ball = || is_ball(&scene_probe.world().objects()[object as usize]) && scene_probe.is_dark();
    let is_large = times > MAX_ENCLOSING_RATIO || times > MAX_DARK_RATIO && is_dark_ball();
    (is_large && times.is_finite()).then_some(times)
}

/// Returns true if a large object spoils the picture. Either it is not visible despite its size, or
/// it hides other objects or blocks light.
fn spoils_picture(scene_probe: &SceneProbe, object: u32) -> bool {
    let visibilities = scene_probe.visibilities();
    let hides = visibilities.contains(&Visibility::Hidden(object));
    let keeps_light = scene_probe.verdicts().contains(&LightVerdict::Blocked(object));
    let ball = is_ball(&scene_probe.world().objects()[object as usize]);
    // An object around the camera that blocks the light or the view is not a sky.
    if encloses_camera(scene_probe, object) {
        return true;
    }
    match visibilities[object as usize] {
        // Other checks report a ball that only hides objects or only blocks light.
        Visibility::Visible => hides && keeps_light || (hides || keeps_light) && !ball,
        _ => true,
    }
}

/// Returns true if the camera is inside an object that blocks light or hides others.
fn encloses_camera(scene_probe: &SceneProbe, object: u32) -> bool {
    let eye = scene_probe.world().camera().pose().center;
    let keeps_light = [LightVerdict::Blocked(object), LightVerdict::Inside(object)]
        .iter()
        .any(|v| scene_probe.verdicts().contains(v));
    let harms = keeps_light || scene_probe.visibilities().contains(&Visibility::Hidden(object));
    harms && super::containment::containing_objects(scene_probe.world(), eye).contains(&object)
}

/// Returns true if the camera is inside an object that can be neither a sky nor a room. This is a
/// ground ball that reaches too high, or a dark shell.
pub(super) fn encloses_camera_wrongly(scene_probe: &SceneProbe, object: u32) -> bool {
    is_ground(scene_probe, object) || is_dark_shell(scene_probe, object)
}

/// Returns true if an object around the camera is a ball that represents the ground. It is far
/// larger than everything else, and the camera is near its top and far from its centre.
pub(super) fn is_ground(scene_probe: &SceneProbe, object: u32) -> bool {
    let own = &scene_probe.world().objects()[object as usize];
    let Some(bounds) = own.bounds().filter(|_| is_ball(own)) else { return false };
    let pose = scene_probe.world().camera().pose();
    let off = pose.center - bounds.center();
    let radius = 0.5 * bounds.size().max_element();
    let high = off.dot(pose.up.normalize_or(Vec3::Y)) > 0.7 * off.length();
    times_larger(scene_probe, object).is_some() && off.length() > 0.8 * radius && high
}

/// Returns true if an object around the camera is far larger than everything else and too dark for
/// a sky or a room.
fn is_dark_shell(scene_probe: &SceneProbe, object: u32) -> bool {
    let own = &scene_probe.world().objects()[object as usize];
    if !scene_probe.is_physical()
        || times_larger(scene_probe, object).is_none()
        || scene_probe.world().may_emit(own.material)
        || scene_probe.is_glass(object)
    {
        return false;
    }
    let shown =
        scene_probe.lit_probes().filter(|(probe, _)| probe.hit.as_ref().is_some_and(|hit| hit.object == object));
    let (all, dark) =
        shown.fold((0, 0), |(all, dark), (_, color)| (all + 1, dark + usize::from(color.max_element() < 0.02)));
    dark * 10 >= all * 9
}

/// Returns true if an object is a sky. A sky is a large ball around the camera that blocks lights
/// outside it and nothing else.
fn is_sky_before_lights(scene_probe: &SceneProbe, object: u32) -> bool {
    let own = &scene_probe.world().objects()[object as usize];
    let Some(bounds) = own.bounds().filter(|_| is_ball(own)) else { return false };
    let eye = scene_probe.world().camera().pose().center;
    let outside = |light: &Light| light.position().is_none_or(|place| !own.contains(place));
    let mut blocked = (scene_probe.verdicts().iter().zip(scene_probe.world().lights()))
        .filter(|(verdict, _)| **verdict == LightVerdict::Blocked(object))
        .peekable();
    blocked.peek().is_some()
        && blocked.all(|(_, light)| outside(light))
        && (eye - bounds.center()).length() < 0.25 * bounds.size().max_element()
}

/// Returns the largest object and the size of the next one if it is so much larger that a picture
/// that shows it leaves the others as specks, or inside it.
fn dwarfing(scene_probe: &SceneProbe, sizes: &[(u32, f32)]) -> Option<(u32, f32)> {
    let [rest @ .., (_, next), (giant, size)] = sizes else { return None };
    let visibilities = scene_probe.visibilities();
    let speck = |object: u32| {
        let bounds = scene_probe.world().objects()[object as usize].bounds()?;
        pixels(scene_probe, bounds).filter(|pixels| *pixels < SPECK)
    };
    let others = || sizes.iter().map(|(object, _)| *object).filter(|object| object != giant);
    let is_hidden = |object: u32| visibilities[object as usize] == Visibility::Hidden(*giant);
    let dwarfs = others().all(|object| speck(object).is_some() || is_hidden(object))
        && others().any(|object| speck(object).is_some());
    // A camera in the file shows which of the sizes is meant.
    let is_few = rest.len() + 2 <= FEW_OBJECTS && !scene_probe.input.scene.camera_span.has_position();
    let is_shown = visibilities[*giant as usize] == Visibility::Visible;
    (*size > MAX_ENCLOSING_RATIO * next && is_few && is_shown && dwarfs).then_some((*giant, *next))
}

/// Reports objects that are far larger or smaller than most others.
pub(super) fn out_of_scale(scene_probe: &SceneProbe) -> Vec<Finding> {
    let world = scene_probe.world();
    let sized = |(i, object): (usize, &durer_render::world::Object)| {
        let bounds: Aabb = object.bounds().filter(|bounds| !bounds.is_empty())?;
        Some((i as u32, bounds.size().max_element())).filter(|(_, size)| *size > 0.0)
    };
    let mut sizes: Vec<(u32, f32)> = world.objects().iter().enumerate().filter_map(sized).collect();
    sizes.sort_by(|a, b| a.1.total_cmp(&b.1));
    let absurd = sizes.iter().filter(|(_, size)| !REPRESENTABLE_SIZES.contains(size));
    let lost: Vec<Finding> = absurd
        .take(MAX_FINDINGS)
        .map(|&(object, size)| {
            let diagnostic =
                Diagnostic::warning(format!("the {} is {} wide", scene_probe.object(object), number(size)))
                    .at(scene_probe.object_span(object))
                    .effect("numbers of this size lack precision: the object is invisible, or contains everything")
                    .help("check the size of the object and the `Scale` that encloses it");
            Finding::from(diagnostic).affecting_whole_picture(size > 1.0)
        })
        .collect();
    if sizes.len() < 2 || !lost.is_empty() {
        return lost;
    }
    // Of two objects, the one whose size fits its distance from the camera is more credible.
    let eye = world.camera().pose().center;
    let away = |object: u32| world.objects()[object as usize].bounds().map_or(1.0, |b| (b.center() - eye).length());
    let odd = |(object, size): (u32, f32)| fp::ln(size / away(object).clamp(1e-6, 1e6)).abs();
    let middle = match sizes[..] {
        [small, large] => {
            if odd(small) < odd(large) {
                small.1
            } else {
                large.1
            }
        }
        _ => sizes[sizes.len() / 2].1,
    };
    let dwarfing = dwarfing(scene_probe, &sizes);
    let middle = dwarfing.map_or(middle, |(_, next)| next);
    let mut findings = Vec::new();
    let around = super::containment::containing_objects(world, eye);
    let holds_eye = |object: u32| around.contains(&object) && encloses_camera_wrongly(scene_probe, object);
    for &(object, size) in &sizes {
        let ratio = if size > middle { size / middle } else { middle / size };
        // Either of the two objects may be wrong. The small one may be invisible, or the large one
        // may hide others.
        let dwarfs = dwarfing.is_some_and(|(giant, _)| giant == object);
        let spoils = dwarfs || size > middle && spoils_picture(scene_probe, object);
        if findings.len() >= MAX_FINDINGS
            || ratio
                < if dwarfs {
                    MAX_ENCLOSING_RATIO
                } else if !spoils {
                    OUT_OF_SCALE
                } else if encloses_camera(scene_probe, object) {
                    MAX_ENCLOSING_RATIO
                } else {
                    HARMFUL
                }
        {
            continue;
        }
        // Water or glass around the camera is large on purpose.
        if size > middle && around.contains(&object) && scene_probe.is_glass(object) {
            continue;
        }
        // A huge ball can represent the ground or the sky. Other checks report objects around the
        // camera and lights outside a sky.
        if size > middle && (!spoils || holds_eye(object) || is_sky_before_lights(scene_probe, object)) {
            continue;
        }
        let word = if size > middle { "larger" } else { "smaller" };
        let diagnostic = Diagnostic::warning(format!(
            "the {} is {} times {word} than {}",
            scene_probe.object(object),
            number(ratio),
            match sizes[..] {
                [(a, _), (b, _)] => format!("the {}", scene_probe.object(if a == object { b } else { a })),
                _ => "most objects in this scene".into(),
            }
        ))
        .at(scene_probe.object_span(object))
        .effect(match scene_probe.visibilities()[object as usize] {
            Visibility::Visible if dwarfs => "the other objects are hidden by it, or only specks next to it",
            Visibility::Visible if size > middle => "the object hides or contains the others",
            Visibility::Visible => "the object covers hardly a pixel",
            _ if size > middle => "the object spans the entire scene, but its surface is outside the picture",
            _ => "the object is invisible",
        })
        .help(format!(
            "the object's largest side is {}, but that of {} is {}: check the size and its unit (such as \
             millimetres), and the {} that {} the object",
            number(size),
            if sizes.len() == 2 { "the other" } else { "most objects" },
            number(middle),
            match scene_probe.model_format() {
                Some(_) => "transforms".to_string(),
                None => format!("`{}`", scene_probe.keyword_of_grammar("Scale", "scale")),
            },
            if scene_probe.model_format().is_some() { "enclose" } else { "encloses" }
        ));
        let shown = scene_probe.hits().filter(|(_, hit)| hit.object == object).count();
        findings.push(Finding::from(diagnostic).affecting_whole_picture(shown * 2 > scene_probe.probes.len()));
    }
    findings
}

/// Reports rotations by simple fractions of pi, which are probably in radians.
pub(super) fn radians(scene_probe: &SceneProbe) -> Vec<Finding> {
    let mut angles = Vec::new();
    if let Some(root) = &scene_probe.input.scene.root {
        root.objects.iter().for_each(|object| rotations(object, &mut angles));
    }
    let fraction = |angle: f32| {
        let parts = angle.abs() / std::f32::consts::PI * 12.0;
        angle.abs() > 0.1 && angle.abs() < 6.5 && angle.fract() != 0.0 && (parts - parts.round()).abs() < 0.01
    };
    let Some((span, words, angle)) = angles.into_iter().find(|(.., angle)| fraction(*angle)) else {
        let found = sun_in_radians(scene_probe).or_else(|| pbrt_in_radians(scene_probe, fraction));
        return found.into_iter().collect();
    };
    let degrees = number(angle.to_degrees().round());
    let diagnostic = Diagnostic::warning(format!("the rotation by {angle} degrees may be in radians"))
        .effect("the object is hardly rotated")
        .help(format!("angles are in degrees: try {degrees}"));
    let value = scene_probe.field_span(span, &words).filter(|value| scene_probe.text(*value).parse() == Ok(angle));
    vec![Finding::from(match value {
        Some(value) => diagnostic.at(value).fix(value, degrees),
        None => diagnostic.at(span),
    })]
}

/// Returns a warning about a rotation in the text of a pbrt file whose angle is probably in
/// radians.
fn pbrt_in_radians(scene_probe: &SceneProbe, fraction: impl Fn(f32) -> bool) -> Option<Finding> {
    scene_probe.model_format().filter(|format| format.name == "pbrt")?;
    let angle = |line: &[u8]| {
        let word = str::from_utf8(line).ok()?.trim().strip_prefix("Rotate ")?.split_ascii_whitespace().next();
        word?.parse().ok().filter(|angle| fraction(*angle))
    };
    let all = super::lines::lines(scene_probe.input.files.bytes(0)?, 0);
    let (span, angle) = all.into_iter().find_map(|(span, line)| Some((span, angle(line)?)))?;
    let diagnostic = Diagnostic::warning(format!("the rotation by {angle} degrees may be in radians"))
        .at(span)
        .effect("the object is hardly rotated")
        .help(format!("angles are in degrees: try {}", number(angle.to_degrees().round())));
    Some(Finding::from(diagnostic))
}

/// Returns a note about a sun just above the horizon whose altitude may be in radians.
fn sun_in_radians(scene_probe: &SceneProbe) -> Option<Finding> {
    let altitude = scene_probe.input.scene.background.sun_altitude?;
    let is_radians = altitude > 0.2 && altitude <= std::f32::consts::FRAC_PI_2 && altitude.fract() != 0.0;
    let block = super::colors::background_span(scene_probe).filter(|_| is_radians)?;
    let degrees = number(altitude.to_degrees().round());
    let written = number(altitude);
    let diagnostic = Diagnostic::note(format!("the sun is only {written} degrees above the horizon"))
        .effect("the light is that of a sunset: dim and red")
        .help(format!("angles are in degrees: if {written} is in radians, write `sunAltitude {degrees}`"));
    Some(Finding::from(scene_probe.at_value(diagnostic, block, &["sunAltitude"])))
}

/// A rotation in the scene file, with the span of its transform, its possible keywords, and its
/// angle in degrees.
type Rotation = (Span, [&'static str; 2], f32);

fn rotations(object: &Object, angles: &mut Vec<Rotation>) {
    match &object.node {
        ObjectKind::Transform(ops, inner) => {
            angles.extend(ops.iter().filter_map(|op| match op {
                MatrixOp::XRotate(angle) => Some((object.span, ["XRotate", "x_rotate"], *angle)),
                MatrixOp::YRotate(angle) => Some((object.span, ["YRotate", "y_rotate"], *angle)),
                MatrixOp::ZRotate(angle) => Some((object.span, ["ZRotate", "z_rotate"], *angle)),
                MatrixOp::Rotate(_, angle) => Some((object.span, ["Rotate", "rotate"], *angle)),
                _ => None,
            }));
            rotations(inner, angles);
        }
        ObjectKind::Group(group) => group.objects.iter().for_each(|inner| rotations(inner, angles)),
        ObjectKind::Solid(_, parts) => parts.iter().for_each(|part| rotations(part, angles)),
        _ => {}
    }
}
