//! Checks for a camera outside the closed room that the lights illuminate.

use super::containment::containing_objects;
use super::finding::Finding;
use super::scene_probe::SceneProbe;
use super::shapes::spread_direction;
use super::verdict::MAX_LIGHTS;
use super::visibility::{Visibility, has_eye};
use durer_diag::Diagnostic;
use durer_render::world::emitters::emitter_of;
use durer_scene::camera::Projection;
use durer_scene::light::Illuminate as _;
use durer_scene::math::{Aabb, Ray, Vec2, Vec3};

/// Number of directions in which a room must have walls.
const DIRECTIONS: u32 = 64;
/// Minimum size of a room, as a fraction of the size of the scene.
const MIN_ROOM: f32 = 0.5;

/// Reports walls that hide the lit room from the camera, or one object that hides all, or almost
/// all, of the others.
pub(super) fn hidden_behind(scene_probe: &SceneProbe) -> Vec<Finding> {
    match camera_outside(scene_probe) {
        Some(finding) => vec![finding],
        None => super::hidden::hidden_behind(scene_probe),
    }
}

/// Reports a dark picture whose camera is outside the closed room in which the lights are.
fn camera_outside(scene_probe: &SceneProbe) -> Option<Finding> {
    let dark = match scene_probe.is_physical() {
        true => scene_probe.is_dark(),
        false => super::lights::none_contributes(scene_probe),
    };
    let eye = scene_probe.world().camera().pose().center;
    // The check `camera-inside` reports a camera inside a wall.
    if !dark || !has_eye(scene_probe) || !containing_objects(scene_probe.world(), eye).is_empty() {
        return None;
    }
    let (light, front) =
        lights(scene_probe).into_iter().find_map(|(name, place)| Some((name, wall(scene_probe, place)?)))?;
    let message = format!(
        "the camera is outside the closed room that the {light} illuminates: the {} is in front of the camera",
        scene_probe.object(front)
    );
    let diagnostic = Diagnostic::warning(message)
        .related(scene_probe.object_span(front), "the wall in front of the camera")
        .effect(match scene_probe.is_physical() {
            true => "the picture is nearly black: it shows only the outside of the room, which no light reaches",
            false => "only the outside of the room is visible, and no light reaches it",
        })
        .help("move the camera into the room, or remove the wall");
    let diagnostic = scene_probe.at_value(diagnostic, scene_probe.input.scene.camera_span, &["center"]);
    Some(Finding::from(diagnostic).affecting_whole_picture(true))
}

/// Returns the names of the lights, each with a point from which its light spreads.
fn lights(scene_probe: &SceneProbe) -> Vec<(String, Vec3)> {
    let (world, size) = (scene_probe.world(), scene_probe.world().bounds().size().max_element());
    let surfaces = super::area_lights::emissive_objects(scene_probe).into_iter().filter_map(|(number, _)| {
        let object = &world.objects()[number as usize];
        let (form, normal) = emitter_of(object, 0)?;
        let (point, normal, _) = form.point(normal, Vec2::splat(0.5))?;
        Some((scene_probe.object(number), point.as_vec3() + 1e-4 * size * normal))
    });
    let points = scene_probe.input.scene.lights.iter().flatten().take(MAX_LIGHTS).filter_map(|light| {
        let (line, _) = scene_probe.input.files.position(light.span)?;
        Some((format!("`{}` of line {line}", scene_probe.text(light.span)), light.value.position()?))
    });
    surfaces.chain(points).collect()
}

/// Returns the wall between the camera and a light if the light is in a closed room with something
/// that the camera does not see.
fn wall(scene_probe: &SceneProbe, light: Vec3) -> Option<u32> {
    let (world, eye) = (scene_probe.world(), scene_probe.world().camera().pose().center);
    let mut around: Vec<Vec3> = Vec::new();
    let mut others = Vec::new();
    for i in 0..DIRECTIONS {
        let ray = Ray::new(light, spread_direction(i, DIRECTIONS));
        let hit = world.closest(&ray, &mut ())?;
        world.objects()[hit.object as usize].bounds()?;
        around.push(ray.at(hit.t));
        others.push(hit.object);
    }
    let to_light = Ray { t_max: 1.0 - 1e-3, ..Ray::new(eye, light - eye) };
    let front = world.closest(&to_light, &mut ())?.object;
    let is_unseen = |object: &u32| {
        let object = *object as usize;
        matches!(scene_probe.visibilities()[object], Visibility::Hidden(_))
            && !world.may_emit(world.objects()[object].material)
    };
    let room = Aabb::around(around).size().max_element();
    let large = room > MIN_ROOM * world.bounds().size().max_element();
    (large && !scene_probe.is_glass(front) && others.iter().any(is_unseen)).then_some(front)
}
