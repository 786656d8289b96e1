//! Describes where objects outside the picture are.

use super::finding::number;
use super::scene_probe::SceneProbe;
use super::visibility::has_eye;
use durer_scene::camera::Projection as _;
use durer_scene::math::Vec3;

/// Says where an object outside the picture is, seen from the camera.
pub(super) fn beside_picture(scene_probe: &SceneProbe, object: u32) -> String {
    let world = scene_probe.world();
    let Some(bounds) = world.objects()[object as usize].bounds().filter(|bounds| !bounds.is_empty()) else {
        return "elsewhere".into();
    };
    let (eye, frame) = (world.camera().pose().center, world.camera_frame());
    let to = bounds.center() - eye;
    let away = number(to.length());
    let is_behind = |corner: &Vec3| (*corner - eye).dot(frame.forward) < 0.0;
    if has_eye(scene_probe) && bounds.corners().iter().all(is_behind) {
        return format!("{away} away, behind the camera");
    }
    let (right, up) = (to.dot(frame.right), to.dot(frame.up));
    let side = match (right.abs() > up.abs(), right > 0.0, up > 0.0) {
        (true, true, _) => "to the right of the view",
        (true, false, _) => "to the left of the view",
        (false, _, true) => "above the view",
        (false, _, false) => "below the view",
    };
    format!("{away} away, {side}")
}
