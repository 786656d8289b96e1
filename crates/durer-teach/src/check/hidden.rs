//! Checks for a single object, often a plane, that hides all or most of the others.

use super::finding::{Finding, counted, number, percent, vector};
use super::scene_probe::SceneProbe;
use super::shapes::plane;
use super::visibility::{Visibility, has_eye, past_hidden_backs, points, rays_to};
use durer_diag::{Diagnostic, Span};
use durer_render::world::Object;
use durer_scene::camera::{Camera, Projection};
use durer_scene::math::{Ray, Vec3};

/// If a scene has more objects than this, a single object is not blamed.
const FEW_OBJECTS: usize = 8;

/// Reports one object that hides all, or almost all, of the others.
pub(super) fn hidden_behind(scene_probe: &SceneProbe) -> Vec<Finding> {
    let findings = hidden(scene_probe);
    if findings.is_empty() { obstructing_object(scene_probe) } else { findings }
}

/// Reports one object that hides all of the others.
pub(super) fn hidden(scene_probe: &SceneProbe) -> Vec<Finding> {
    let mut hits = scene_probe.hits().map(|(_, hit)| hit.object);
    let Some(front) = hits.next().filter(|front| hits.all(|other| other == *front)) else { return Vec::new() };
    let (mut hidden, mut others, mut behind_camera) = (0, 0, 0);
    let empty = super::objects::without_surface(scene_probe);
    let there = |(i, _): &(usize, &Visibility)| *i as u32 != front && !empty.contains(&(*i as u32));
    for (number, sight) in scene_probe.visibilities().iter().enumerate().filter(there) {
        match sight {
            Visibility::Hidden(_) => hidden += 1,
            Visibility::Unknown if scene_probe.world().objects()[number].bounds().is_none() => {}
            Visibility::Outside if is_behind_camera(scene_probe, number) => behind_camera += 1,
            _ => others += 1,
        }
    }
    let covered = scene_probe.hits().count();
    let is_plane = scene_probe.world().objects()[front as usize].bounds().is_none();
    // An object can be hidden on purpose, but nothing behind an infinite plane is ever visible.
    let few = !is_plane && covered * 2 < scene_probe.probes.len();
    if hidden == 0 || others > 0 || few || scene_probe.is_glass(front) {
        return Vec::new();
    }
    let name = scene_probe.object(front);
    let behind = scene_probe.hits().all(|(_, hit)| hit.from_behind);
    // The rays of some cameras are infinite lines, so they also hit objects behind the camera.
    let backwards = !has_eye(scene_probe) && scene_probe.hits().all(|(_, hit)| hit.t < 0.0);
    // If the visible side is the back, the camera is probably on the wrong side instead.
    let turned = (is_plane && !behind).then(|| negated_offset(scene_probe, front)).flatten();
    let help = match (is_plane, behind) {
        _ if backwards => {
            "move the object away, or negate its `offset`: the object is behind the camera's `center`, but this \
             camera's rays are infinite lines, which hit objects behind the camera first"
        }
        _ if is_plane && turned.is_none() && !behind => {
            "the camera and the hidden objects are on different sides of the plane: move one of them"
        }
        (true, true) => {
            "the camera is behind the plane, which is at p · normal = offset: move the camera, or check `offset` \
             and the direction of `normal`"
        }
        (true, false) => "check the sign of `offset`: the plane is at p · normal = offset",
        _ => "move the object, make it smaller, or move the camera",
    };
    let place = if behind_camera > 0 { " in front of the camera" } else { "" };
    let diagnostic = Diagnostic::warning(format!("the {name} hides everything else{place}"))
        .at(scene_probe.object_span(front))
        .label(format!("covers {} of the picture", percent(covered, scene_probe.probes.len())))
        .effect(counted(hidden, "object is hidden behind it", "objects are hidden behind it"))
        .help(help);
    let moved = moved_behind(scene_probe, front).filter(|_| !backwards && !behind);
    let diagnostic = match (moved, turned) {
        (Some((place, words)), _) => {
            diagnostic.at(place).label("").related(scene_probe.object_span(front), "the plane").help(words)
        }
        (None, Some((place, text))) => diagnostic.fix(place, text),
        (None, None) => diagnostic,
    };
    vec![Finding::from(diagnostic).affecting_whole_picture(true)]
}

/// Returns true if all of a bounded object is behind the camera.
fn is_behind_camera(scene_probe: &SceneProbe, object: usize) -> bool {
    let (camera, frame) = (scene_probe.world().camera(), scene_probe.world().camera_frame());
    let is_behind = |corner: &Vec3| (*corner - camera.pose().center).dot(frame.forward) <= 0.0;
    let bounds = scene_probe.world().objects()[object].bounds().filter(|_| has_eye(scene_probe));
    bounds.is_some_and(|bounds| bounds.corners().iter().all(is_behind))
}

/// Reports one object close to the camera that covers most of the picture and of the other objects.
fn obstructing_object(scene_probe: &SceneProbe) -> Vec<Finding> {
    let objects = scene_probe.world().objects();
    let mut counts = vec![0; objects.len()];
    let mut nearest = vec![f32::INFINITY; objects.len()];
    for (probe, seen) in scene_probe.hits() {
        counts[seen.object as usize] += 1;
        nearest[seen.object as usize] = nearest[seen.object as usize].min(seen.t * probe.ray.dir.length());
    }
    let Some(front) = (0..objects.len()).max_by_key(|&i| counts[i]) else { return Vec::new() };
    if counts[front] * 10 < scene_probe.probes.len() * 5
        || scene_probe.is_glass(front as u32)
        || !hidden(scene_probe).is_empty()
    {
        return Vec::new();
    }
    let Some(bounds) = objects[front].bounds() else { return Vec::new() };
    // A room or a table contains the other objects. An obstacle is far in front of the other
    // objects and hides almost all of them.
    let eye = scene_probe.world().camera().pose().center;
    let others: Vec<usize> = (0..objects.len()).filter(|&i| i != front && objects[i].bounds().is_some()).collect();
    let away = |i: &usize| objects[*i].bounds().map_or(f32::INFINITY, |own| (own.center() - eye).length());
    let nearest_other = others.iter().map(away).fold(f32::INFINITY, f32::min);
    if others.is_empty() || objects.len() > FEW_OBJECTS || nearest[front] > 0.4 * nearest_other {
        return Vec::new();
    }
    let (mut looked, mut covered) = (0, 0);
    for &other in &others {
        let rays = points(&objects[other]).into_iter().flat_map(|point| rays_to(scene_probe, point));
        let seen = rays.map(|ray| past_hidden_backs(&scene_probe.input, ray));
        for hit in seen.filter_map(|ray| scene_probe.world().closest(&ray, &mut ())) {
            looked += usize::from(hit.object as usize == other || hit.object as usize == front);
            covered += usize::from(hit.object as usize == front);
        }
    }
    if looked == 0 || covered * 10 < looked * 7 || bounds.contains(eye) {
        return Vec::new();
    }
    let diagnostic = Diagnostic::note(format!("the {} covers most of the picture", scene_probe.object(front as u32)))
        .at(scene_probe.object_span(front as u32))
        .label(format!("{} of the picture", percent(counts[front], scene_probe.probes.len())))
        .effect(format!(
            "the other objects are hardly visible, because this object covers {} of them",
            percent(covered, looked)
        ))
        .help(match nearest[front] < 0.0 {
            true => "this camera also sees what is behind its `center`: write `near 0`, or move the object".to_string(),
            false => format!(
                "the object is {} in front of the camera: move it away, make it smaller, or move the camera back",
                number(nearest[front])
            ),
        });
    vec![Finding::from(diagnostic).affecting_whole_picture(true)]
}

/// Reports a plane between the camera and all bounded objects, even if other objects, such as the
/// sky, are visible beside it.
pub(super) fn below_plane(scene_probe: &SceneProbe) -> Vec<Finding> {
    let objects = scene_probe.world().objects();
    let mut front = None;
    let empty = super::objects::without_surface(scene_probe);
    let there =
        |(i, (object, _)): &(usize, (&Object, &Visibility))| object.bounds().is_some() && !empty.contains(&(*i as u32));
    for (_, (object, sight)) in objects.iter().zip(scene_probe.visibilities()).enumerate().filter(there) {
        let by = match sight {
            Visibility::Hidden(by) => {
                Some(*by).filter(|by| objects[*by as usize].bounds().is_none() && !scene_probe.is_glass(*by))
            }
            Visibility::Outside if has_eye(scene_probe) => plane_before(scene_probe, object),
            _ => None,
        };
        if by.is_none() || front.is_some_and(|known| Some(known) != by) {
            front = None;
            break;
        }
        front = by;
    }
    let front = match front {
        Some(front) => Some(front).filter(|_| hidden(scene_probe).is_empty()),
        None => ceiling(scene_probe),
    };
    let Some(front) = front else { return Vec::new() };
    let lid = ceiling(scene_probe) == Some(front);
    let what =
        if lid { "all objects and the camera are below the" } else { "all other objects are on the far side of the" };
    if let Some(raised) = mirrored_eye(scene_probe, front).filter(|_| !lid) {
        let pose = scene_probe.world().camera().pose();
        let diagnostic = Diagnostic::warning(format!("the camera is below the {}", scene_probe.object(front)))
            .related(scene_probe.object_span(front), "the plane on which the other objects stand")
            .effect("only the plane and the background are visible")
            .help(format!("move the camera to the side of the objects: try `center {}`", vector(raised)));
        let span = scene_probe.input.scene.camera_span;
        let value = scene_probe.field_span(span, &["center"]).filter(|_| raised != pose.center);
        let diagnostic = scene_probe.at_value(diagnostic.fix_at(value, vector(raised)), span, &["center"]);
        return vec![Finding::from(diagnostic).affecting_whole_picture(true)];
    }
    let diagnostic = Diagnostic::warning(format!("{what} {}", scene_probe.object(front)))
        .at(scene_probe.object_span(front))
        .effect(match lid {
            true => "the plane acts as a ceiling: it is visible from its back and blocks the light from above",
            false => "only the plane and the background are visible",
        })
        .help("check the `offset` of the plane, which is at p · normal = offset, or the height of the objects");
    let diagnostic = match (moved_behind(scene_probe, front).filter(|_| !lid), negated_offset(scene_probe, front)) {
        (Some((place, words)), _) => {
            diagnostic.at(place).related(scene_probe.object_span(front), "the plane").help(words)
        }
        (None, Some((place, text))) => diagnostic.fix(place, text),
        (None, None) => diagnostic,
    };
    vec![Finding::from(diagnostic).affecting_whole_picture(true)]
}

/// Returns the span of a transform that moves an object to the far side of a plane, and a sentence
/// about the transform.
fn moved_behind(scene_probe: &SceneProbe, plane: u32) -> Option<(Span, String)> {
    let (n, d) = world_plane(scene_probe, plane)?;
    let eye = scene_probe.world().camera().pose().center.dot(n) - d;
    super::transforms::moved_out_of_view(scene_probe, &|place| (place.dot(n) - d) * eye > 0.0)
}

/// Returns the plane that separates the camera from an object. The plane hides the object, whatever
/// direction the camera has.
pub(super) fn plane_before(scene_probe: &SceneProbe, object: &Object) -> Option<u32> {
    let world = scene_probe.world();
    let (eye, place) = (world.camera().pose().center, object.bounds().filter(|b| !b.is_empty())?.center());
    let way = Ray { t_max: 1.0, ..Ray::new(eye, place - eye) };
    world.hits_of_each(&way).map(|hit| hit.object).find(|&other| world.objects()[other as usize].bounds().is_none())
}

/// Returns the camera's mirror image in a plane if the camera is below the plane and all objects
/// stand on it.
fn mirrored_eye(scene_probe: &SceneProbe, object: u32) -> Option<Vec3> {
    let (n, d) = world_plane(scene_probe, object)?;
    let eye = scene_probe.world().camera().pose().center;
    let height = |p: Vec3| p.dot(n) - d;
    let objects: Vec<[Vec3; 8]> =
        scene_probe.world().objects().iter().filter_map(|o| Some(o.bounds()?.corners())).collect();
    let size = scene_probe.world().bounds().size().max_element();
    let lowest = objects.iter().flatten().map(|p| height(*p)).fold(f32::INFINITY, f32::min);
    (lowest > -0.05 * size && lowest < 0.05 * size && height(eye) < 0.0).then(|| eye - 2.0 * height(eye) * n)
}

/// Returns the normal and offset of a plane in world space.
pub(super) fn world_plane(scene_probe: &SceneProbe, object: u32) -> Option<(Vec3, f32)> {
    let object = &scene_probe.world().objects()[object as usize];
    let plane = plane(object)?;
    let on = object.world_point(plane.normal * (plane.offset / plane.normal.length_squared().max(f32::MIN_POSITIVE)));
    let n = object.to_world.as_ref().map_or(plane.normal, |m| m.normal(plane.normal)).normalize_or(Vec3::Y);
    Some((n, on.dot(n)))
}

/// Returns the only plane of the scene if it faces up and the camera and all objects are below it.
fn ceiling(scene_probe: &SceneProbe) -> Option<u32> {
    let world = scene_probe.world();
    let planes = world.objects().iter().enumerate().filter(|(_, object)| object.bounds().is_none());
    let planes = planes.filter(|(_, object)| object.to_world.is_none());
    let mut planes = planes.filter_map(|(i, object)| Some((i as u32, plane(object)?)));
    let (number, plane) = planes.next().filter(|_| planes.next().is_none())?;
    let pose = world.camera().pose();
    let below = |p: Vec3| p.dot(plane.normal) < plane.offset;
    let faces_up = plane.normal.normalize_or_zero().dot(pose.up.normalize_or_zero()) > 0.7;
    let objects = world.bounds();
    let all = !objects.is_empty() && objects.corners().iter().all(|corner| below(*corner)) && below(pose.center);
    let hit = scene_probe.hits().any(|(_, hit)| hit.object == number);
    (faces_up && all && hit && !matches!(world.camera(), Camera::Orthographic(_))).then_some(number)
}

/// Returns the span of a plane's offset and the negated offset if negating it puts the camera and
/// the objects on the same side.
fn negated_offset(scene_probe: &SceneProbe, object: u32) -> Option<(Span, String)> {
    let plane_object = &scene_probe.world().objects()[object as usize];
    let plane = plane(plane_object)?;
    if plane_object.to_world.is_some() || plane.offset == 0.0 {
        return None;
    }
    let place = scene_probe.field_span(scene_probe.object_span(object), &["offset"])?;
    let above = |p: Vec3| p.dot(plane.normal) > -plane.offset;
    let objects = scene_probe.world().bounds();
    (above(objects.center()) == above(scene_probe.world().camera().pose().center))
        .then(|| (place, number(-plane.offset)))
}

/// Returns the span of a plane's offset and the negated offset if all objects stand on the plane
/// with the negated offset, and not on the plane as it is.
pub(super) fn offset_below_objects(scene_probe: &SceneProbe, object: u32) -> Option<(Span, String)> {
    let negated = negated_offset(scene_probe, object)?;
    let (n, d) = world_plane(scene_probe, object)?;
    let (objects, up) = (scene_probe.world().bounds(), scene_probe.world().camera_frame().up);
    let side = if n.dot(up) < 0.0 { -1.0 } else { 1.0 };
    let heights = || objects.corners().map(|corner| side * corner.dot(n));
    let lowest = heights().into_iter().fold(f32::INFINITY, f32::min);
    let slack = 0.05 * objects.size().max_element();
    let stands_on = |offset: f32| (lowest - side * offset).abs() <= slack;
    (!objects.is_empty() && stands_on(-d) && !stands_on(d)).then_some(negated)
}
