//! Checks for a camera that shows only the ground on which all other objects stand.

use super::finding::{Finding, counted, vector};
use super::scene_probe::SceneProbe;
use super::view::with_field_edit;
use super::visibility::{Visibility, has_eye};
use durer_diag::{Diagnostic, Severity};
use durer_scene::camera::Projection;
use durer_scene::math::{Aabb, Vec3};

/// Height of the ground as a fraction of its width.
const MAX_HEIGHT: f32 = 0.02;
/// Minimum number of objects outside the picture.
const MIN_OBJECTS: usize = 2;

/// Reports a camera outside of whose picture are all objects except the ground below it. Lights
/// do not count.
pub(super) fn shows_only_ground(scene_probe: &SceneProbe) -> Option<Finding> {
    let world = scene_probe.world();
    let eye = world.camera().pose().center;
    let (mut others, mut count, mut shows_ground) = (Aabb::EMPTY, 0, false);
    for (object, sight) in world.objects().iter().zip(scene_probe.visibilities()) {
        let Some(bounds) = object.bounds().filter(|bounds| !bounds.is_empty() && !world.may_emit(object.material))
        else {
            continue;
        };
        match sight {
            Visibility::Outside => (others, count) = (others.union(bounds), count + 1),
            Visibility::Visible if is_below(bounds, eye, world.camera_frame().up) => shows_ground = true,
            _ => return None,
        }
    }
    if count < MIN_OBJECTS || !shows_ground || !has_eye(scene_probe) {
        return None;
    }
    let to = others.center() - eye;
    let message = format!("the camera looks past {} and shows only the ground", counted(count, "object", "objects"));
    let diagnostic = Diagnostic::warning(message).effect("only the ground and the background are visible");
    let span = scene_probe.input.scene.camera_span;
    let is_between = others.contains(eye) || to.dot(world.camera_frame().forward) < 0.0;
    let diagnostic = match scene_probe.model_format().map(|format| format.name) {
        Some("pbrt" | "Mitsuba") if is_between => diagnostic
            .help("turn or move the camera: the objects are around or behind it, as if its eye and target were swapped")
            .at(span),
        Some(_) => diagnostic.help("turn the camera towards the scene, or move the camera").at(span),
        None if others.contains(eye) => diagnostic.help("move the camera away from the objects around it").at(span),
        None => {
            let help = format!("turn the camera: `direction {}`", vector(to));
            with_field_edit(scene_probe, diagnostic.help(help), "direction", to)
        }
    };
    Some(Finding::from(diagnostic).affecting_whole_picture(true))
}

/// Returns true if bounds are flat, and a point is above them.
fn is_below(bounds: Aabb, point: Vec3, up: Vec3) -> bool {
    let (axis, size) = (up.abs().max_position(), bounds.size());
    let is_within = (0..3).all(|i| i == axis || (bounds.min[i]..=bounds.max[i]).contains(&point[i]));
    let height = (point - bounds.center())[axis] * up[axis].signum();
    size[axis] <= MAX_HEIGHT * size.max_element() && is_within && height > 0.0
}

/// Returns the flat, bounded object on which all others stand, and its height. It is horizontal,
/// with y up, is larger than the others together, and the camera is above it.
pub(super) fn floor(scene_probe: &SceneProbe) -> Option<(u32, f32)> {
    let world = scene_probe.world();
    let eye = world.camera().pose().center;
    let is_flat = |bounds: &Aabb| bounds.size().y <= 1e-3 * bounds.size().max_element();
    let area = |bounds: &Aabb| bounds.size().x * bounds.size().z;
    let boxes = || {
        let all = world.objects().iter().enumerate().take(super::finding::MAX_FINDINGS * 4);
        all.filter_map(|(i, object)| Some((i as u32, object.bounds().filter(|bounds| !bounds.is_empty())?)))
    };
    let flat = boxes().filter(|(_, bounds)| is_flat(bounds) && area(bounds) > 0.0);
    let (floor, own) = flat.max_by(|a, b| area(&a.1).total_cmp(&area(&b.1)))?;
    let others = boxes().filter(|(object, _)| *object != floor).fold(Aabb::EMPTY, |all, (_, bounds)| all.union(bounds));
    let height = own.center().y;
    let size = others.size().max_element();
    let stand = !others.is_empty() && others.min.y > height - 0.1 * size && others.min.y < height + 0.3 * size;
    let is_wide = own.size().x > others.size().x && own.size().z > others.size().z;
    (stand && is_wide && eye.y > height).then_some((floor, height))
}

/// Reports a camera that is upside down above the flat object on which all others stand.
pub(super) fn upside_down_above_floor(scene_probe: &SceneProbe) -> Option<Finding> {
    let world = scene_probe.world();
    let (floor, _) = floor(scene_probe).filter(|_| world.camera_frame().up.y < -0.3)?;
    let is_seen = scene_probe.hits().any(|(_, hit)| hit.object == floor);
    let pose = world.camera().pose();
    let turned = vector(if pose.up.y < -0.5 { -pose.up } else { Vec3::Y });
    let span = scene_probe.input.scene.camera_span;
    let diagnostic = Diagnostic::warning("the picture is upside down: the camera's `up` points into the ground")
        .related(scene_probe.object_span(floor), "the ground")
        .effect("the objects hang from the ground");
    let help = match scene_probe.model_format().map(|format| format.name) {
        Some("glTF") => "turn the camera the right way up; the four numbers of its `rotation` are x, y, z and w".into(),
        Some(_) => "turn the camera the right way up".into(),
        None => format!("write `up {turned}`: `up` points to the upper edge of the picture"),
    };
    let diagnostic = diagnostic.help(help).fix_at(scene_probe.field_span(span, &["up"]), turned);
    is_seen.then(|| Finding::from(scene_probe.at_value(diagnostic, span, &["up"])))
}

/// Returns a note about a camera whose `up` lies in the ground, so that the picture lies on its
/// side. Pictures that are higher than wide may be turned on purpose.
pub(super) fn on_its_side(scene_probe: &SceneProbe, normal: Vec3, ground: u32) -> Option<Finding> {
    let world = scene_probe.world();
    let pose = world.camera().pose();
    let level = |v: Vec3| v.normalize_or_zero().dot(normal).abs();
    let is_level = level(pose.up) < 1e-4 && level(pose.direction) < 0.7 && level(world.camera_frame().up) < 0.3;
    let is_seen = scene_probe.hits().any(|(_, hit)| hit.object == ground);
    if !is_level || !is_seen || scene_probe.input.job.height > scene_probe.input.job.width || !has_eye(scene_probe) {
        return None;
    }
    let (span, up) = (scene_probe.input.scene.camera_span, vector(normal));
    let diagnostic = Diagnostic::warning("the picture lies on its side: the camera's `up` is parallel to the ground")
        .related(scene_probe.object_span(ground), "the ground")
        .effect("the ground is at the left or right edge of the picture")
        .help(format!("write `up {up}`: `up` points to the upper edge of the picture"));
    let diagnostic = Diagnostic { severity: Severity::Note, ..diagnostic };
    Some(Finding::from(scene_probe.at_value(diagnostic, span, &["up"])))
}
