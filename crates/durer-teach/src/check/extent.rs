//! Checks of size: objects too small or too large to be visible, and unsuitable fields of view.

use super::finding::{Finding, MAX_SOUGHT, number};
use super::scene_probe::SceneProbe;
use super::shapes::is_ball;
use super::verdict::Verdict;
use super::visibility::{Visibility, pixels};
use durer_diag::{Diagnostic, Span};
use durer_scene::camera::{Camera, Projection};
use durer_scene::light::{Illuminate as _, Light};
use durer_scene::math::{Aabb, Vec3, fp};
use durer_scene::scene::{MatrixOp, Object, ObjectKind};

/// Minimum size in pixels of a recognisable object.
const FEWEST_PIXELS: f32 = 6.0;
/// Ratios to the typical size above which an object is out of scale: for harmless objects, and for
/// objects that spoil the picture.
const OUT_OF_SCALE: f32 = 3e3;
const HARMFUL: f32 = 100.0;
/// Size ratio above which an object that contains the camera is out of scale.
const SWALLOWING: f32 = 20.0;

/// Range of sizes that single precision can represent next to other objects.
const ABSURD: std::ops::Range<f32> = 1e-9..1e9;

/// Reports scenes whose bounded objects together cover only a few pixels.
pub(super) fn too_small(scout: &SceneProbe) -> Vec<Finding> {
    let bounds = scout.world().bounds();
    let Some(size) = Some(bounds).filter(|b| !b.is_empty()).and_then(|bounds| pixels(scout, bounds)) else {
        return Vec::new();
    };
    let empty = scout.seen().next().is_none();
    // A very wide field of view is meant to show a lot, not a few small objects in the centre.
    let share = match scout.world().camera() {
        Camera::Perspective(camera) if camera.angle > 120.0 => 0.12,
        Camera::Perspective(camera) if camera.angle > 90.0 => 0.08,
        Camera::Orthographic(_) => 0.12,
        _ => 0.0,
    };
    let fewest = (share * scout.larger()).max(FEWEST_PIXELS);
    if size >= fewest || !empty && !scout.visibilities().contains(&Visibility::Seen) {
        return Vec::new();
    }
    let (span, larger) = (scout.subject.scene.camera_span, scout.larger());
    let wanted = 0.6 * larger / size.max(1e-6);
    let diagnostic = Diagnostic::warning(format!(
        "all objects together are {} pixels wide in a picture of {larger} pixels",
        number(size)
    ))
    .effect(if empty && size < FEWEST_PIXELS {
        "every ray misses them, so the picture shows only the background"
    } else {
        "they are hardly visible"
    });
    let (diagnostic, field) = match scout.world().camera() {
        Camera::Perspective(camera) if camera.angle > 90.0 => {
            (diagnostic.help("use a smaller field of view, such as 40 degrees, or move closer"), "angle")
        }
        Camera::Orthographic(camera) => {
            let help = format!("use a smaller picture size, such as `size {}`", number(camera.size / wanted));
            let diagnostic = diagnostic.fix_at(scout.value(span, &["size"]), number(camera.size / wanted));
            (diagnostic.help(help), "size")
        }
        _ => {
            let help = format!("move about {} times closer, or scale the objects up by that factor", number(wanted));
            (diagnostic.help(help), "center")
        }
    };
    let diagnostic = scout.at_value(diagnostic, span, &[field, if field == "angle" { "fov" } else { field }]);
    vec![Finding::from(diagnostic).whole(true)]
}

/// Reports pictures that show only a tiny part of the objects, for example because an angle is in
/// radians.
pub(super) fn too_narrow(scout: &SceneProbe) -> Vec<Finding> {
    let (bounds, span, larger) = (scout.world().bounds(), scout.subject.scene.camera_span, scout.larger());
    // If an object is entirely visible, the camera is not too close.
    let seen =
        scout.world().objects().iter().zip(scout.visibilities()).filter(|(_, sight)| **sight == Visibility::Seen);
    let sizes: Vec<f32> = seen.filter_map(|(object, _)| pixels(scout, object.bounds()?)).collect();
    if bounds.is_empty() {
        return Vec::new();
    }
    if sizes.iter().any(|size| *size < 3.0 * larger) {
        return one_fills(scout, &sizes).into_iter().collect();
    }
    let radians = |angle: f32| angle <= std::f32::consts::PI;
    match scout.world().camera() {
        Camera::Perspective(camera) if camera.angle < 5.0 => {
            // A telescope is meant to show distant objects.
            let Some(size) = pixels(scout, bounds).filter(|size| *size > 8.0 * larger) else { return Vec::new() };
            let degrees = camera.angle.to_degrees();
            let mut diagnostic =
                Diagnostic::warning(format!("the field of view is only {} degrees", number(camera.angle)))
                    .effect(format!(
                        "less than a {}th of the scene's width is visible",
                        number((size / larger).floor())
                    ))
                    .help("angles are in degrees; 30 to 60 is usual");
            if let Some(place) = scout.value(span, &["angle", "fov"]).filter(|_| radians(camera.angle)) {
                let whole = degrees.round().clamp(20.0, 100.0);
                diagnostic = diagnostic.fix(place, number(whole)).help(format!(
                    "angles are in degrees; if this value is in radians, it is {} degrees: try `{whole}`",
                    number(degrees)
                ));
            }
            vec![Finding::from(scout.at_value(diagnostic, span, &["angle", "fov"])).whole(true)]
        }
        Camera::Orthographic(camera) => {
            // A picture filled by the surface of a single object shows nothing useful.
            let mut seen: Vec<u32> = scout.seen().map(|(_, seen)| seen.object).collect();
            seen.sort_unstable();
            seen.dedup();
            let most = if seen.len() == 1 { 8.0 } else { 30.0 };
            let Some(size) = pixels(scout, bounds).filter(|size| *size > most * larger) else { return Vec::new() };
            let wanted = number(1.2 * camera.size * size / larger);
            let diagnostic = Diagnostic::warning(format!("the picture is only {} wide", number(camera.size)))
                .effect(format!("less than a {}th of the scene's width is visible", number((size / larger).floor())))
                .help(format!("`size {wanted}` shows the full scene"));
            let diagnostic = diagnostic.fix_at(scout.value(span, &["size"]), wanted);
            vec![Finding::from(scout.at_value(diagnostic, span, &["size"])).whole(true)]
        }
        _ => Vec::new(),
    }
}

/// Reports a narrow field of view filled by one object, with most others outside it.
fn one_fills(scout: &SceneProbe, sizes: &[f32]) -> Option<Finding> {
    let Camera::Perspective(camera) = scout.world().camera() else { return None };
    let visibilities = scout.visibilities().iter().zip(scout.world().objects());
    let out =
        visibilities.filter(|(sight, object)| **sight == Visibility::Outside && object.bounds().is_some()).count();
    let filled = sizes.iter().all(|size| *size > 0.9 * scout.larger());
    if camera.angle > 12.0 || sizes.is_empty() || !filled || out < 2 || out < sizes.len() {
        return None;
    }
    let diagnostic = Diagnostic::warning(format!("the field of view is only {} degrees", number(camera.angle)))
        .effect(match sizes.len() {
            1 => format!("one object fills the picture, and {out} are outside it"),
            n => format!("{n} objects fill the picture, and {out} are outside it"),
        })
        .help("30 to 60 degrees is usual: is a digit missing?");
    let span = scout.subject.scene.camera_span;
    Some(Finding::from(scout.at_value(diagnostic, span, &["angle", "fov"])).whole(true))
}

/// Returns the ratio of an object's size to that of the largest other object, if above
/// `SWALLOWING`.
pub(super) fn times_larger(scout: &SceneProbe, object: u32) -> Option<f32> {
    let size = |i: usize| Some(scout.world().objects()[i].bounds()?.size().max_element());
    let others = (0..scout.world().objects().len()).filter(|&i| i != object as usize).filter_map(size);
    let times = size(object as usize)? / others.fold(0.0, f32::max);
    (times > SWALLOWING && times.is_finite()).then_some(times)
}

/// Returns true if a large object spoils the picture: it is not visible despite its size, or it
/// hides other objects or blocks light.
fn is_harm(scout: &SceneProbe, object: u32) -> bool {
    let visibilities = scout.visibilities();
    let hides = visibilities.contains(&Visibility::Hidden(object));
    let keeps_light = scout.verdicts().contains(&Verdict::Blocked(object));
    let ball = is_ball(&scout.world().objects()[object as usize]);
    // An object around the camera that blocks the light or the view is not a sky.
    if swallows(scout, object) {
        return true;
    }
    match visibilities[object as usize] {
        // Other checks report a ball that only hides objects or only blocks light.
        Visibility::Seen => hides && keeps_light || (hides || keeps_light) && !ball,
        _ => true,
    }
}

/// Returns true if the camera is inside an object that blocks light or hides others.
fn swallows(scout: &SceneProbe, object: u32) -> bool {
    let eye = scout.world().camera().pose().center;
    let keeps_light = [Verdict::Blocked(object), Verdict::Inside(object)].iter().any(|v| scout.verdicts().contains(v));
    let harms = keeps_light || scout.visibilities().contains(&Visibility::Hidden(object));
    harms && super::within::around(scout.world(), eye).contains(&object)
}

/// Returns true if the camera is inside an object that can be neither a sky nor a room: a ground
/// ball that reaches too high, or a dark shell.
pub(super) fn swallows_wrongly(scout: &SceneProbe, object: u32) -> bool {
    is_ground(scout, object) || is_dark_shell(scout, object)
}

/// Returns true if an object around the camera is a ball meant as the ground: it is far larger than
/// everything else, and the camera is near its top, far from its centre.
fn is_ground(scout: &SceneProbe, object: u32) -> bool {
    let own = &scout.world().objects()[object as usize];
    let Some(bounds) = own.bounds().filter(|_| is_ball(own)) else { return false };
    let pose = scout.world().camera().pose();
    let off = pose.center - bounds.center();
    let radius = 0.5 * bounds.size().max_element();
    let high = off.dot(pose.up.normalize_or(Vec3::Y)) > 0.7 * off.length();
    times_larger(scout, object).is_some() && off.length() > 0.8 * radius && high
}

/// Returns true if an object around the camera is far larger than everything else, and too dark for
/// a sky or a room.
fn is_dark_shell(scout: &SceneProbe, object: u32) -> bool {
    let own = &scout.world().objects()[object as usize];
    if !scout.is_physical()
        || times_larger(scout, object).is_none()
        || scout.world().may_emit(own.material)
        || scout.is_glass(object)
    {
        return false;
    }
    let shown = scout.lit_probes().filter(|(probe, _)| probe.seen.as_ref().is_some_and(|seen| seen.object == object));
    let (all, dark) =
        shown.fold((0, 0), |(all, dark), (_, color)| (all + 1, dark + usize::from(color.max_element() < 0.02)));
    dark * 10 >= all * 9
}

/// Returns true if an object is a sky: a large ball around the camera that blocks lights outside
/// it, and only those.
fn is_sky_before_lights(scout: &SceneProbe, object: u32) -> bool {
    let own = &scout.world().objects()[object as usize];
    let Some(bounds) = own.bounds().filter(|_| is_ball(own)) else { return false };
    let eye = scout.world().camera().pose().center;
    let outside = |light: &Light| light.position().is_none_or(|place| !own.contains(place));
    let mut blocked = (scout.verdicts().iter().zip(scout.world().lights()))
        .filter(|(verdict, _)| **verdict == Verdict::Blocked(object))
        .peekable();
    blocked.peek().is_some()
        && blocked.all(|(_, light)| outside(light))
        && (eye - bounds.center()).length() < 0.25 * bounds.size().max_element()
}

/// Reports objects far larger or smaller than most.
pub(super) fn out_of_scale(scout: &SceneProbe) -> Vec<Finding> {
    let world = scout.world();
    let sized = |(i, object): (usize, &durer_render::world::Object)| {
        let bounds: Aabb = object.bounds().filter(|bounds| !bounds.is_empty())?;
        Some((i as u32, bounds.size().max_element())).filter(|(_, size)| *size > 0.0)
    };
    let mut sizes: Vec<(u32, f32)> = world.objects().iter().enumerate().filter_map(sized).collect();
    sizes.sort_by(|a, b| a.1.total_cmp(&b.1));
    let absurd = sizes.iter().filter(|(_, size)| !ABSURD.contains(size));
    let lost: Vec<Finding> = absurd
        .take(MAX_SOUGHT)
        .map(|&(object, size)| {
            let diagnostic = Diagnostic::warning(format!("the {} is {} wide", scout.object(object), number(size)))
                .at(scout.object_span(object))
                .effect("numbers of this size lack precision: the object is invisible, or contains everything")
                .help("check its size and the `Scale` around it");
            Finding::from(diagnostic).whole(size > 1.0)
        })
        .collect();
    if sizes.len() < 2 || !lost.is_empty() {
        return lost;
    }
    // Of two objects, trust the one whose size fits its distance from the camera.
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
    let mut found = Vec::new();
    let around = super::within::around(world, eye);
    let holds_eye = |object: u32| around.contains(&object) && swallows_wrongly(scout, object);
    for &(object, size) in &sizes {
        let ratio = if size > middle { size / middle } else { middle / size };
        // Either of the two objects may be wrong: the small one is invisible, or the large one
        // hides others.
        let spoils = size > middle && is_harm(scout, object);
        if found.len() >= MAX_SOUGHT
            || ratio
                < if !spoils {
                    OUT_OF_SCALE
                } else if swallows(scout, object) {
                    SWALLOWING
                } else {
                    HARMFUL
                }
        {
            continue;
        }
        // A huge ball can be the ground or the sky. Other checks report objects around the camera
        // and lights outside a sky.
        if size > middle && (!spoils || holds_eye(object) || is_sky_before_lights(scout, object)) {
            continue;
        }
        let word = if size > middle { "larger" } else { "smaller" };
        let diagnostic = Diagnostic::warning(format!(
            "the {} is {} times {word} than most objects in this scene",
            scout.object(object),
            number(ratio)
        ))
        .at(scout.object_span(object))
        .effect(match scout.visibilities()[object as usize] {
            Visibility::Seen if size > middle => "it hides or contains the others",
            Visibility::Seen => "it covers hardly a pixel",
            _ if size > middle => "it spans the entire scene, but its surface is outside the picture",
            _ => "it is invisible",
        })
        .help(format!(
            "its largest side is {}, but that of most objects is {}: is it in another unit, such as millimetres? \
             Check its size and the `{}` around it",
            number(size),
            number(middle),
            scout.word("Scale", "scale")
        ));
        let shown = scout.seen().filter(|(_, seen)| seen.object == object).count();
        found.push(Finding::from(diagnostic).whole(shown * 2 > scout.probes.len()));
    }
    found
}

/// Reports rotations by simple fractions of pi, which are probably in radians.
pub(super) fn radians(scout: &SceneProbe) -> Vec<Finding> {
    let mut angles = Vec::new();
    if let Some(root) = &scout.subject.scene.root {
        root.objects.iter().for_each(|object| rotations(object, &mut angles));
    }
    let fraction = |angle: f32| {
        let parts = angle.abs() / std::f32::consts::PI * 12.0;
        angle.abs() > 0.1 && angle.abs() < 6.5 && angle.fract() != 0.0 && (parts - parts.round()).abs() < 0.01
    };
    let Some((span, words, angle)) = angles.into_iter().find(|(.., angle)| fraction(*angle)) else { return Vec::new() };
    let degrees = number(angle.to_degrees().round());
    let diagnostic = Diagnostic::warning(format!("the rotation by {angle} degrees may be in radians"))
        .effect("the object is hardly rotated")
        .help(format!("angles are in degrees: {degrees}"));
    let value = scout.value(span, &words).filter(|value| scout.text(*value).parse() == Ok(angle));
    vec![Finding::from(match value {
        Some(value) => diagnostic.at(value).fix(value, degrees),
        None => diagnostic.at(span),
    })]
}

/// A rotation in the scene file: span of its transform, its possible keywords, and its angle in
/// degrees.
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
