//! Checks for a camera that shows only the ground on which all other objects stand.

use super::finding::{Finding, counted, vector};
use super::scene_probe::SceneProbe;
use super::view::with_field_edit;
use super::visibility::{Visibility, has_eye};
use durer_diag::Diagnostic;
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
