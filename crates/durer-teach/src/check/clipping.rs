//! Checks the clip distances of the camera.

use super::finding::{Finding, number};
use super::scene_probe::SceneProbe;
use super::visibility::Visibility;
use durer_diag::Diagnostic;
use durer_scene::camera::Camera;
use durer_scene::math::Ray;

/// Minimum fraction of the rays that must hit something without the clip distances.
const MIN_FREE_SHARE: f32 = 0.01;

/// Returns the clip distances of the camera, near and far, if it has any.
fn clip_distances(camera: &Camera) -> Option<(Option<f32>, Option<f32>)> {
    let (near, far) = match camera {
        Camera::Orthographic(camera) => (camera.near, camera.far),
        Camera::ThinLens(camera) => (Some(camera.near).filter(|near| *near > 0.0), camera.far),
        _ => (None, None),
    };
    (near.is_some() || far.is_some()).then_some((near, far))
}

/// Reports clip distances that cut away everything in the picture.
pub(super) fn clipped(scene_probe: &SceneProbe) -> Vec<Finding> {
    let world = scene_probe.world();
    let Some((near, far)) = clip_distances(world.camera()) else { return Vec::new() };
    // A plane can extend beyond the clip distances, so only bounded objects count.
    let mut seen = world.objects().iter().zip(scene_probe.visibilities());
    if seen.any(|(object, visibility)| object.bounds().is_some() && *visibility == Visibility::Visible) {
        return far.and_then(|far| partly_clipped(scene_probe, far)).into_iter().collect();
    }
    let orthographic = matches!(world.camera(), Camera::Orthographic(_));
    let forward = world.camera_frame().forward;
    let start = if orthographic { f32::NEG_INFINITY } else { 0.0 };
    let free = scene_probe.probes.iter().filter_map(|probe| {
        let hit = world.closest(&Ray { t_min: start, t_max: f32::INFINITY, ..probe.ray }, &mut ())?;
        let bounded = world.objects()[hit.object as usize].bounds().is_some();
        Some((hit.t * probe.ray.dir.dot(forward), bounded))
    });
    let free: Vec<(f32, bool)> = free.collect();
    if free.is_empty() || (free.len() as f32) < MIN_FREE_SHARE * scene_probe.probes.len() as f32 {
        return Vec::new();
    }
    // The distances of a plane reach to the horizon, so bounded objects are preferred.
    let any_bounded = free.iter().any(|(_, bounded)| *bounded);
    let is_empty = scene_probe.hits().next().is_none();
    if !is_empty && !any_bounded {
        return Vec::new();
    }
    let all = if is_empty { "everything in the picture" } else { "all objects except planes" };
    let depths = || free.iter().filter(|(_, bounded)| *bounded || !any_bounded).map(|(depth, _)| *depth);
    let (least, most) = (depths().fold(f32::INFINITY, f32::min), depths().fold(f32::NEG_INFINITY, f32::max));
    let low = if least > 0.0 { 0.9 * least } else { least - 0.1 * (most - least).max(least.abs()) };
    let words = |field: &'static str| words(scene_probe, field);
    let span = scene_probe.input.scene.camera_span;
    let place = |field: &str| scene_probe.field_span(span, &[field]);
    let (message, help, field, edits) = match (near, far) {
        (Some(near), Some(far)) if near > far => {
            let message = format!(
                "the `near` distance {} is greater than the `far` distance {}, so they cut away {all}",
                number(near),
                number(far)
            );
            let fits = far < most && near > least;
            let (low, high) = if fits { (far, near) } else { (low, 1.1 * most) };
            let help = format!("write `{} {}` and `{} {}`", words("near"), number(low), words("far"), number(high));
            (message, help, "near", vec![("near", number(low)), ("far", number(high))])
        }
        (_, Some(far)) if far < least => {
            let message = format!("the `far` distance {} cuts away {all}", number(far));
            let word = words("far");
            let help = format!("write `{word} {}`, or remove `{word}`", number(1.1 * most));
            (message, help, "far", vec![("far", number(1.1 * most))])
        }
        (Some(near), _) if near > most => {
            let message = format!("the `near` distance {} cuts away {all}", number(near));
            let word = words("near");
            let help = format!("write `{word} {}`, or remove `{word}`", number(low));
            (message, help, "near", vec![("near", number(low))])
        }
        _ => {
            let message = format!("the clip distances of the camera cut away {all}");
            (message, format!("remove `{}` and `{}`", words("near"), words("far")), "near", Vec::new())
        }
    };
    let objects = match least == most {
        true => format!("the visible objects would be at a distance of {}", number(least)),
        false => format!("the visible objects would be at distances from {} to {}", number(least), number(most)),
    };
    let diagnostic = Diagnostic::warning(message)
        .effect(format!("without the clip distances, {objects} along the camera's axis"))
        .help(help);
    let diagnostic =
        edits.into_iter().fold(diagnostic, |diagnostic, (field, text)| diagnostic.fix_at(place(field), text));
    vec![Finding::from(at_distance(scene_probe, diagnostic, field)).affecting_whole_picture(true)]
}

/// Returns the word for a clip distance in the format of the scene.
fn words(scene_probe: &SceneProbe, field: &'static str) -> &'static str {
    match (scene_probe.model_format().map(|format| format.name), field) {
        (Some("Mitsuba"), "near") => "near_clip",
        (Some("Mitsuba"), _) => "far_clip",
        (Some("glTF"), "near") => "znear",
        (Some("glTF"), _) => "zfar",
        _ => field,
    }
}

/// Places a finding at a clip distance.
fn at_distance(scene_probe: &SceneProbe, diagnostic: Diagnostic, field: &'static str) -> Diagnostic {
    let word = words(scene_probe, field);
    match scene_probe.model_format().and_then(|_| super::written::place_of_word(scene_probe, word)) {
        Some(place) => diagnostic.at(place),
        None => scene_probe.at_value(diagnostic, scene_probe.input.scene.camera_span, &[field, "far"]),
    }
}

/// Reports a far distance that cuts away whole objects, while others are visible.
fn partly_clipped(scene_probe: &SceneProbe, far: f32) -> Option<Finding> {
    let world = scene_probe.world();
    let forward = world.camera_frame().forward;
    let mut cut: Vec<(u32, f32)> = Vec::new();
    for probe in &scene_probe.probes {
        let Some(hit) = world.closest(&Ray { t_max: f32::INFINITY, ..probe.ray }, &mut ()) else { continue };
        let is_bounded = world.objects()[hit.object as usize].bounds().is_some();
        if is_bounded && scene_probe.visibilities()[hit.object as usize] != Visibility::Visible {
            cut.push((hit.object, hit.t * probe.ray.dir.dot(forward)));
        }
    }
    let &(first, _) = cut.first()?;
    let most = cut.iter().map(|(_, depth)| *depth).fold(0.0, f32::max);
    let mut objects: Vec<u32> = cut.into_iter().map(|(object, _)| object).collect();
    objects.sort_unstable();
    objects.dedup();
    let (name, word) = (scene_probe.object(first), words(scene_probe, "far"));
    let message = match objects.len() {
        1 => format!("the `far` distance {} cuts away the {name}", number(far)),
        n => format!("the `far` distance {} cuts away {n} objects, such as the {name}", number(far)),
    };
    let diagnostic = Diagnostic::warning(message)
        .related(scene_probe.object_span(first), "this object is farther away")
        .effect("objects beyond the clip distances are invisible")
        .help(format!("write `{word} {}`, or remove `{word}`", number(1.1 * most)));
    let value = scene_probe.field_span(scene_probe.input.scene.camera_span, &["far"]);
    let diagnostic = diagnostic.fix_at(value, number(1.1 * most));
    Some(Finding::from(at_distance(scene_probe, diagnostic, "far")))
}
