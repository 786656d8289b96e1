//! Checks the camera's position and direction.

use super::containment::containing_objects;
use super::finding::{Finding, number, vector};
use super::hidden::{plane_before, world_plane};
use super::lights::none_contributes;
use super::scene_probe::SceneProbe;
use super::shapes::plane;
use super::verdict::LightVerdict;
use super::visibility::{Visibility, has_eye, is_in_view, pixels};
use durer_diag::{Diagnostic, Severity};
use durer_formats::course::place::section;
use durer_render::world::{Material, Object};
use durer_scene::camera::{Camera, Projection};
use durer_scene::math::{Aabb, Color, Vec3, fp};
use durer_scene::scene::{Group, ObjectKind};

/// Reports a scene without objects.
pub(super) fn no_objects(scene_probe: &SceneProbe) -> Vec<Finding> {
    // `empty-solid` reports solids that are empty.
    let solid = |object: &ObjectKind| matches!(object, ObjectKind::Solid(..));
    let empty =
        |root: &&Group| scene_probe.world().objects().is_empty() && !root.objects.iter().any(|o| solid(&o.node));
    let Some(root) = scene_probe.input.scene.root.as_ref().filter(empty) else { return Vec::new() };
    // Models and JSON scenes do not have a `Group` keyword.
    let file = scene_probe.input.scene.camera_span.file;
    let group = scene_probe.input.files.bytes(file).is_some_and(|bytes| section(bytes, file, "Group").is_some());
    let diagnostic = match group && root.objects.is_empty() {
        true => Diagnostic::warning("the scene has no objects: its group is empty").help("add objects to the `Group`"),
        false => Diagnostic::warning("the scene has no surfaces"),
    };
    vec![
        Finding::from(diagnostic.effect("every ray misses, so the picture shows only the background"))
            .affecting_whole_picture(true),
    ]
}

/// Reports objects that contain the camera, except rooms.
pub(super) fn inside(scene_probe: &SceneProbe) -> Vec<Finding> {
    if !has_eye(scene_probe) {
        return Vec::new();
    }
    let pose = scene_probe.world().camera().pose();
    let (rays, physical) = (scene_probe.probes.len(), scene_probe.is_physical());
    let mut findings = Vec::new();
    for object in containing_objects(scene_probe.world(), pose.center) {
        let own = scene_probe.hits().filter(|(_, hit)| hit.object == object).count();
        // A room contains lights and other objects.
        let dark = !physical
            && none_contributes(scene_probe)
            && scene_probe.verdicts().contains(&LightVerdict::Blocked(object));
        // If back faces are not shaded, walls seen from behind are not those of a room.
        let backs = scene_probe.hits().filter(|(_, hit)| hit.object == object && hit.from_behind).count();
        let walls = !physical && !scene_probe.input.job.settings.shade_back && backs * 50 > rays;
        let wrong = super::extent::encloses_camera_wrongly(scene_probe, object);
        // The scene is visible through clear glass, and objects under water get no direct light.
        let is_clear = scene_probe.is_glass(object) && scene_probe.input.job.settings.bounces > 0;
        if is_clear && !walls && !wrong && (!dark || contains_objects(scene_probe, object)) {
            findings.push(inside_glass(scene_probe, object));
            continue;
        }
        let times = super::extent::times_larger(scene_probe, object);
        if own == 0 && super::visibility::hides_backs_of(scene_probe, object) {
            findings.push(match times {
                Some(times) => {
                    let effect = "the object is invisible: its surface is hidden from behind";
                    inside_giant(scene_probe, object, times, effect)
                }
                None => inside_hidden_backs(scene_probe, object),
            });
            continue;
        }
        let swallowed = wrong || is_alone(scene_probe, object);
        let sealed = is_sealed(scene_probe, object, own);
        if own * 100 < rays * 99 && !dark && !walls && !swallowed && !sealed {
            continue;
        }
        let Some(bounds) = scene_probe.world().objects()[object as usize].bounds() else { continue };
        if let Some(times) = times {
            let effect = match dark || scene_probe.is_dark() {
                true => "the object blocks the light from outside, so everything visible is in its shadow",
                false => "the object surrounds the camera, so its inside is visible",
            };
            findings.push(inside_giant(scene_probe, object, times, effect).affecting_whole_picture(true));
            continue;
        }
        let name = scene_probe.object(object);
        let outside = point_outside(bounds, pose.center, -pose.direction);
        let diagnostic = Diagnostic::warning(format!("the camera is inside the {name}"))
            .label("this point is inside the object")
            .effect(match dark {
                _ if swallowed && own * 100 < rays * 99 => "the object surrounds the camera, so its inside is visible",
                _ if walls && own * 100 < rays * 99 => {
                    "the walls are visible from behind, and their backs get no \
                     light"
                }
                true => "the object blocks the light, so everything visible is in its shadow",
                false if shines_outwards(scene_probe, object) => {
                    "only the inside of the object is visible, and the object shines outwards only"
                }
                false => "only the inside of the object is visible",
            })
            .help(match swapped_pose(scene_probe) {
                Some((place, to)) => format!(
                    "if `center` and `direction` are swapped, write `center {}` and the direction from there to the \
                     objects, `direction {}`",
                    vector(place),
                    vector(to)
                ),
                None => {
                    let shine = match shines_outwards(scene_probe, object) {
                        true => ", or let the object shine inwards as well with `walls thin` in its material",
                        false => "",
                    };
                    let place = vector(outside);
                    format!("move the camera backwards out of the object, for example to `center {place}`{shine}")
                }
            });
        findings.push(around_camera(scene_probe, object, diagnostic).affecting_whole_picture(true));
    }
    findings
}

/// Returns true if an object emits light to the outside only.
fn shines_outwards(scene_probe: &SceneProbe, object: u32) -> bool {
    let world = scene_probe.world();
    let material = world.materials().get(world.objects()[object as usize].material as usize);
    matches!(material, Some(Material::Phong(phong)) if phong.emission.is_some_and(|emission| !emission.two_sided))
}

/// Returns a note about a camera inside a transparent object, which may be intentional.
fn inside_glass(scene_probe: &SceneProbe, object: u32) -> Finding {
    let name = scene_probe.object(object);
    let diagnostic = Diagnostic::note(format!("the camera is inside the {name}, which is transparent"))
        .effect("everything is seen through its surface from inside, so the object itself is hardly visible")
        .help("if the camera should not be inside, make the object smaller or move the camera out of it");
    around_camera(scene_probe, object, diagnostic)
}

/// Returns a warning about a camera inside an object whose backs are hidden.
fn inside_hidden_backs(scene_probe: &SceneProbe, object: u32) -> Finding {
    let name = scene_probe.object(object);
    let diagnostic = Diagnostic::warning(format!("the camera is inside the {name}"))
        .effect("the object is invisible: its surface is hidden from behind")
        .help("move the camera out of the object, or make the material double-sided");
    around_camera(scene_probe, object, diagnostic)
}

/// Returns the camera's `direction` as a position and the direction from there to the objects, if
/// the length of `direction` is that of a distance at which a camera sees all objects.
fn swapped_pose(scene_probe: &SceneProbe) -> Option<(Vec3, Vec3)> {
    let (pose, bounds) = (scene_probe.world().camera().pose(), scene_probe.world().bounds());
    let size = bounds.size().length();
    let is_far = (1.2 * size..6.0 * size).contains(&(pose.direction - bounds.center()).length());
    let written = scene_probe.field_span(scene_probe.input.scene.camera_span, &["direction"]);
    let is_written = written.is_some() && scene_probe.model_format().is_none() && bounds.contains(pose.center);
    (is_far && is_written).then(|| (pose.direction, bounds.center() - pose.direction))
}

/// Returns a warning about an object around the camera that is so much larger than all others that
/// its size or its place is wrong, and not that of the camera.
fn inside_giant(scene_probe: &SceneProbe, object: u32, times: f32, effect: &str) -> Finding {
    let objects = scene_probe.world().objects();
    let others = objects.iter().enumerate().filter(|(number, _)| *number as u32 != object);
    let mut boxes = others.filter_map(|(_, object)| object.bounds().filter(|bounds| !bounds.is_empty())).peekable();
    let (what, are) =
        match boxes.clone().all(|own| objects[object as usize].contains(own.center())) && boxes.peek().is_some() {
            true => ("the camera and all other objects", "are"),
            false => ("the camera", "is"),
        };
    let message = format!(
        "{what} {are} inside the {}, which is {} times larger than all other objects",
        scene_probe.object(object),
        number(times)
    );
    let own = objects[object as usize].bounds().unwrap_or(Aabb::EMPTY);
    let size = number(own.size().max_element());
    let diagnostic =
        Diagnostic::warning(message).effect(effect).related(scene_probe.input.scene.camera_span, "the camera");
    let up = scene_probe.world().camera().pose().up.normalize_or(Vec3::Y);
    let height = |bounds: &Aabb| bounds.corners().map(|corner| corner.dot(up));
    let top = height(&own).into_iter().fold(f32::NEG_INFINITY, f32::max);
    let lowest = boxes.flat_map(|bounds| height(&bounds)).fold(f32::INFINITY, f32::min);
    let span = scene_probe.object_span(object);
    Finding::from(match super::extent::is_ground(scene_probe, object) && lowest < top {
        true => {
            let lowered = own.center() - (top - lowest) * up;
            let help = format!(
                "if it is the ground, lower it by {}, to the bottom of the other objects: its center would be at {}",
                number(top - lowest),
                vector(lowered)
            );
            scene_probe.at_value(diagnostic.help(help), span, &["center"])
        }
        false => {
            let sky = match super::physical::has_sky(scene_probe) {
                true => ", or remove it if it is a sky: the background surrounds the scene without an object",
                false => "",
            };
            let help = format!(
                "its largest side is {size}: check its size and its unit, and the transforms that enclose it{sky}"
            );
            scene_probe.at_value(diagnostic.help(help), span, &["radius"])
        }
    })
}

/// Completes a finding about an object around the camera with the positions of both.
fn around_camera(scene_probe: &SceneProbe, object: u32, diagnostic: Diagnostic) -> Finding {
    let diagnostic = diagnostic.related(scene_probe.object_span(object), "the object around the camera");
    Finding::from(scene_probe.at_value(diagnostic, scene_probe.input.scene.camera_span, &["center"]))
}

/// Returns true if the centre of another bounded object is inside an object.
fn contains_objects(scene_probe: &SceneProbe, outer: u32) -> bool {
    let objects = scene_probe.world().objects();
    let others = objects.iter().enumerate().filter(|(number, _)| *number as u32 != outer);
    let mut centers = others.filter_map(|(_, object)| Some(object.bounds()?.center()));
    centers.any(|center| objects[outer as usize].contains(center))
}

/// Returns true if the picture of paths is dark and shows no bounded object except an opaque object
/// around the camera.
fn is_sealed(scene_probe: &SceneProbe, object: u32, own: usize) -> bool {
    let objects = scene_probe.world().objects();
    let alone =
        scene_probe.hits().all(|(_, hit)| hit.object == object || objects[hit.object as usize].bounds().is_none());
    scene_probe.is_dark() && alone && own * 2 > scene_probe.probes.len() && !scene_probe.is_glass(object)
}

/// Returns true if an object that contains the camera is the only bounded object, is seen only from
/// behind, and fills much of the picture.
fn is_alone(scene_probe: &SceneProbe, object: u32) -> bool {
    let world = scene_probe.world();
    let ended = world.objects().iter().filter(|object| object.bounds().is_some()).count();
    let textured = match world.materials().get(world.objects()[object as usize].material as usize) {
        Some(Material::Phong(phong)) => phong.texture.is_some() || phong.emission.is_some(),
        _ => true,
    };
    let own = scene_probe.hits().filter(|(_, hit)| hit.object == object);
    let (all, backs) = own.fold((0, 0), |(all, backs), (_, hit)| (all + 1, backs + usize::from(hit.from_behind)));
    ended == 1 && !scene_probe.is_physical() && !textured && all == backs && all * 4 > scene_probe.probes.len()
}

/// Returns a point outside a box, on a ray that starts inside the box, beyond the point where the
/// ray leaves it.
fn point_outside(bounds: Aabb, from: Vec3, direction: Vec3) -> Vec3 {
    let direction = direction.normalize_or(Vec3::Z);
    let distance = bounds.clip(from, direction).map_or(0.0, |(_, leave)| leave);
    from + 1.5 * distance * direction
}

/// Returns the region that the camera should look at. This is the bounding box of all bounded
/// objects or, if there are none, the nearest point of a plane.
pub(super) fn target(scene_probe: &SceneProbe) -> Option<Aabb> {
    let (world, eye) = (scene_probe.world(), scene_probe.world().camera().pose().center);
    let bounds = world.bounds();
    if !bounds.is_empty() {
        return Some(bounds);
    }
    let foot = |object: &Object| {
        let plane = plane(object)?;
        let n = plane.normal.normalize_or(Vec3::Y);
        let on = n * (plane.offset / plane.normal.length().max(f32::MIN_POSITIVE));
        let (on, n) = (object.world_point(on), object.to_world.as_ref().map_or(n, |to_world| to_world.normal(n)));
        Some(eye + (on - eye).dot(n) * n)
    };
    world.objects().iter().find_map(foot).map(|place| Aabb::around([place]))
}

/// Returns true if no bounded object is in the picture.
fn all_outside(scene_probe: &SceneProbe) -> bool {
    let world = scene_probe.world();
    let bounded = || {
        world
            .objects()
            .iter()
            .zip(scene_probe.visibilities())
            .filter(|(object, _)| object.bounds().is_some_and(|b| !b.is_empty()))
    };
    let none = scene_probe.hits().next().is_none();
    match bounded().next() {
        Some(_) => bounded().all(|(_, sight)| *sight == Visibility::Outside),
        None => none && !world.objects().is_empty(),
    }
}

/// Reports a camera whose picture shows no bounded object because the camera points elsewhere.
pub(super) fn looks_elsewhere(scene_probe: &SceneProbe) -> Vec<Finding> {
    let Some(bounds) = target(scene_probe).filter(|_| all_outside(scene_probe)) else {
        return super::ground::shows_only_ground(scene_probe).into_iter().collect();
    };
    let (world, span) = (scene_probe.world(), scene_probe.input.scene.camera_span);
    let (pose, center) = (world.camera().pose(), bounds.center());
    let mut ended = world.objects().iter().filter(|object| object.bounds().is_some()).peekable();
    let behind = has_eye(scene_probe)
        && ended.peek().is_some()
        && ended.all(|object| plane_before(scene_probe, object).is_some());
    if is_in_view(scene_probe, center) || behind {
        return Vec::new();
    }
    // A field of view that is far too narrow can also miss the objects.
    if aims_widely(scene_probe, center) && !super::extent::too_narrow(scene_probe).is_empty() {
        return Vec::new();
    }
    if let Some(diagnostic) = super::lens::film_shift(scene_probe, center) {
        return vec![Finding::from(diagnostic).affecting_whole_picture(true)];
    }
    let hits = scene_probe.hits().count();
    let effect = match hits {
        0 => "every ray misses, so the picture shows only the background".to_string(),
        _ => format!("only {} is visible", visible_objects(scene_probe)),
    };
    let mut diagnostic = Diagnostic::warning("the camera looks past everything").effect(effect);
    if !has_eye(scene_probe) {
        let off = center - pose.center;
        let forward = world.camera_frame().forward;
        let across = off - off.dot(forward) * forward;
        let place = pose.center + across;
        diagnostic.message +=
            &format!(": the center of the scene is {} away from the camera's axis", number(across.length()));
        diagnostic = diagnostic.help(format!("{}move the camera to `center {}`", nearest(scene_probe), vector(place)));
        let diagnostic = with_field_edit(scene_probe, diagnostic, "center", place);
        return vec![Finding::from(diagnostic).affecting_whole_picture(true)];
    }
    let to = center - pose.center;
    let angle = degrees(pose.direction, to);
    // A degenerate `up` vector can rotate the picture. The direction is reported only if it is far
    // off.
    let turned = pose.up.normalize_or_zero().cross(pose.direction.normalize_or_zero()).length() < 1e-3;
    if turned && angle < 60.0 {
        return Vec::new();
    }
    if let Camera::Projective(camera) = world.camera() {
        let axis = camera.principal_point();
        let is_off = axis.min_element() < 0.0 || axis.x > camera.width || axis.y > camera.height;
        let help = match is_off {
            _ if angle > 90.0 => "the matrix looks away from the scene: check the signs of its rows".to_string(),
            true => format!(
                "the matrix maps the camera's axis to the pixel {} {}, outside the picture: check the signs of its rows",
                number(axis.x),
                number(axis.y)
            ),
            false => "check the matrix of the camera".to_string(),
        };
        return vec![Finding::from(diagnostic.help(help).at(span)).affecting_whole_picture(true)];
    }
    diagnostic.message += &format!(": the center of the scene is {angle:.0} degrees off the viewing direction");
    let moved = super::transforms::moved_out_of_view(scene_probe, &|_| true);
    let first = moved.as_ref().map_or_else(|| nearest(scene_probe), |(_, words)| words.clone() + "; or ");
    let mut help = format!("{first}turn the camera: `direction {}`", vector(to));
    let as_point = pose.direction - pose.center;
    if degrees(as_point, to) < 20.0 && angle > 20.0 {
        help += "; `direction` is a direction, not the point to look at";
    }
    let diagnostic = match (moved, scene_probe.field_span(span, &["direction"])) {
        // Either the transform or the camera may be wrong.
        (Some((place, _)), _) => diagnostic.help(help).at(place).related(span, "the camera"),
        (None, Some(_)) => with_field_edit(scene_probe, diagnostic.help(help), "direction", to),
        (None, None) => diagnostic.help(help).at(span),
    };
    vec![Finding::from(diagnostic).affecting_whole_picture(true)]
}

/// Returns true if a camera with a usual field of view would see a point.
fn aims_widely(scene_probe: &SceneProbe, place: Vec3) -> bool {
    let world = scene_probe.world();
    let to = place - world.camera().pose().center;
    match world.camera() {
        Camera::Perspective(_) => degrees(world.camera().pose().direction, to) < 20.0,
        Camera::Orthographic(_) => {
            let across = to - to.dot(world.camera_frame().forward) * world.camera_frame().forward;
            across.length() < 0.7 * world.bounds().size().max_element()
        }
        _ => false,
    }
}

/// Adds the edit that replaces a vector field of the camera.
pub(super) fn with_field_edit(
    scene_probe: &SceneProbe,
    diagnostic: Diagnostic,
    field: &str,
    value: Vec3,
) -> Diagnostic {
    let span = scene_probe.input.scene.camera_span;
    match scene_probe.field_span(span, &[field]).filter(|_| value != Vec3::ZERO || field == "center") {
        Some(place) => diagnostic.at(place).fix(place, vector(value)),
        None => diagnostic.at(span),
    }
}

fn degrees(a: Vec3, b: Vec3) -> f32 {
    let (a, b) = (a.normalize_or_zero(), b.normalize_or_zero());
    fp::atan2(a.cross(b).length(), a.dot(b)).to_degrees()
}

/// Names the objects that are visible instead.
fn visible_objects(scene_probe: &SceneProbe) -> String {
    let mut objects: Vec<u32> = scene_probe.hits().map(|(_, hit)| hit.object).collect();
    objects.sort_unstable();
    objects.dedup();
    match &objects[..] {
        [one] => format!("the {}", scene_probe.object(*one)),
        all => format!("{} unbounded objects", all.len()),
    }
}

/// Describes how far from an object's bounding sphere the closest ray passes.
fn nearest(scene_probe: &SceneProbe) -> String {
    let world = scene_probe.world();
    let balls = world.objects().iter().enumerate().filter_map(|(i, object)| {
        let bounds = object.bounds().filter(|bounds| !bounds.is_empty())?;
        Some((i as u32, bounds.center(), 0.5 * bounds.size().length()))
    });
    let misses = balls.take(500).flat_map(|(i, center, radius)| {
        scene_probe.probes.iter().map(move |probe| {
            let to = center - probe.ray.origin;
            let along = to.dot(probe.ray.dir).max(probe.ray.t_min);
            (i, (to - along * probe.ray.dir).length() - radius)
        })
    });
    match misses.min_by(|a, b| a.1.total_cmp(&b.1)) {
        Some((object, by)) if by > 0.0 => {
            format!("the nearest ray misses the {1} by {0}; ", number(by), scene_probe.object(object))
        }
        _ => String::new(),
    }
}

/// Reports an empty picture although the camera looks at the centre of the objects.
pub(super) fn empty_view(scene_probe: &SceneProbe) -> Vec<Finding> {
    let world = scene_probe.world();
    if scene_probe.hits().next().is_some() || world.objects().is_empty() {
        return Vec::new();
    }
    // Probes can miss objects that are visible.
    let hit = scene_probe.visibilities().contains(&Visibility::Visible);
    // The check `unseen` reports objects that show the camera only hidden backs.
    if scene_probe.visibilities().contains(&Visibility::TurnedAway) {
        return Vec::new();
    }
    let Some(bounds) = target(scene_probe).filter(|bounds| !hit && is_in_view(scene_probe, bounds.center())) else {
        return Vec::new();
    };
    let mut diagnostic = Diagnostic::warning("every ray misses, although the camera looks at the center of the scene")
        .effect("the picture shows only the background")
        .at(scene_probe.input.scene.camera_span);
    let size = pixels(scene_probe, bounds);
    diagnostic.help = Some(match size {
        Some(size) if size < 12.0 => return Vec::new(),
        _ => format!("{}check whether the objects have a hole in the middle or are seen edge-on", nearest(scene_probe)),
    });
    vec![Finding::from(diagnostic).only_describing()]
}

/// Reports planes that cut most objects in the middle, for example a floor whose normal points
/// along the wrong axis.
pub(super) fn plane_through(scene_probe: &SceneProbe) -> Vec<Finding> {
    let world = scene_probe.world();
    let boxes: Vec<[Vec3; 8]> =
        world.objects().iter().filter_map(|o| Some(o.bounds()?.corners())).take(super::finding::MAX_FINDINGS).collect();
    let through = |&number: &u32| {
        let Some((n, d)) = world_plane(scene_probe, number) else { return false };
        let clear = match world.materials().get(world.objects()[number as usize].material as usize) {
            Some(Material::Phong(phong)) => phong.transparent != Color::ZERO,
            _ => false,
        };
        let is_cut = |corners: &&[Vec3; 8]| {
            let reach =
                corners.iter().map(|p| p.dot(n) - d).fold((f32::MAX, f32::MIN), |(a, b), x| (a.min(x), b.max(x)));
            reach.0 < -0.25 * (reach.1 - reach.0) && reach.1 > 0.25 * (reach.1 - reach.0)
        };
        let cut = boxes.iter().filter(is_cut).count();
        !clear && cut >= 2 && cut * 3 >= boxes.len() * 2
    };
    let say = |number: u32| {
        // Objects may be sunk into a floor on purpose.
        let floor = world_plane(scene_probe, number).is_some_and(|(n, _)| n.dot(world.camera_frame().up).abs() > 0.8);
        let severity = if floor { Severity::Note } else { Severity::Warning };
        let message = format!("the {} passes through the middle of most objects", scene_probe.object(number));
        let diagnostic = Diagnostic { severity, ..Diagnostic::warning(message) }
            .at(scene_probe.object_span(number))
            .effect("only the parts in front of the plane are visible")
            .help(
                "check the `normal` and the `offset` of the plane and the rotations that enclose it: a floor should \
                 be below the objects",
            );
        Finding::from(diagnostic)
    };
    (0..world.objects().len() as u32).filter(through).take(2).map(say).collect()
}

/// Reports a camera whose `up` points into the ground on which all objects stand.
pub(super) fn upside_down(scene_probe: &SceneProbe) -> Vec<Finding> {
    let world = scene_probe.world();
    let (eye, objects) = (world.camera().pose().center, world.bounds());
    let mut planes = (0..world.objects().len() as u32).filter_map(|i| Some((i, world_plane(scene_probe, i)?)));
    let (Some((number, (n, d))), None) = (planes.next(), planes.next()) else {
        let no_planes = world.objects().iter().all(|object| object.bounds().is_some());
        let above_floor = || super::ground::upside_down_above_floor(scene_probe);
        return if no_planes { above_floor().into_iter().collect() } else { Vec::new() };
    };
    let (n, d) = if eye.dot(n) < d { (-n, -d) } else { (n, d) };
    let height = |p: &Vec3| p.dot(n) - d;
    let size = objects.size().max_element();
    let stand = !objects.is_empty() && objects.corners().iter().all(|p| height(p) > -0.1 * size);
    let pose = world.camera().pose();
    let hit = scene_probe.hits().any(|(_, hit)| hit.object == number);
    // A ceiling with objects hanging from it would look the same. If objects touch the plane, it is
    // the ground.
    let lowest = objects.corners().iter().map(height).fold(f32::INFINITY, f32::min);
    if !stand || !hit || lowest > 0.3 * size {
        return Vec::new();
    }
    if world.camera_frame().up.dot(n) > -0.3 || pose.up.dot(n) > 0.1 {
        return super::ground::on_its_side(scene_probe, n, number).into_iter().collect();
    }
    let turned = vector(if pose.up.dot(n) < -0.5 { -pose.up } else { n });
    let span = scene_probe.input.scene.camera_span;
    let diagnostic = Diagnostic::warning("the picture is upside down: the camera's `up` points into the ground")
        .related(scene_probe.object_span(number), "the ground")
        .effect("the objects hang from the ground")
        .help(format!("write `up {turned}`: `up` points to the upper edge of the picture"))
        .fix_at(scene_probe.field_span(span, &["up"]), turned);
    vec![Finding::from(scene_probe.at_value(diagnostic, span, &["up"]))]
}
