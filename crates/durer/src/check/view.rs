//! Where the camera stands and looks.

use super::finding::{Finding, number, percent, vector};
use super::lights::{Verdict, all_fail};
use super::scout::Scout;
use super::sight::{Sight, corner};
use super::solid::around;
use crate::camera::{Camera, Lens};
use crate::diag::{Diagnostic, Severity, Span};
use crate::math::{Aabb, Color, Ray, Vec2, Vec3, fp};
use crate::scene::{Group, Node};
use crate::shape::Primitive;
use crate::world::{Geometry, Material, Object};

/// Whether the camera's rays all start at its place and go one way: those that run both ways see
/// what is behind as well.
pub(super) fn has_eye(scout: &Scout) -> bool {
    !matches!(scout.world().camera(), Camera::Orthographic(_) | Camera::PushBroom(_) | Camera::MultipleCenter(_))
}

/// A scene in which nothing is.
pub(super) fn no_objects(scout: &Scout) -> Vec<Finding> {
    // Solids of which nothing is left are told of as that.
    let solid = |object: &Node| matches!(object, Node::Solid(..));
    let empty = |root: &&Group| scout.world().objects().is_empty() && !root.objects.iter().any(|o| solid(&o.node));
    let Some(_) = scout.subject.scene.root.as_ref().filter(empty) else { return Vec::new() };
    let diagnostic = Diagnostic::warning("the scene has no objects: its group is empty")
        .effect("every ray misses; the whole picture is background")
        .help("write some into the `Group`");
    vec![Finding::from(diagnostic).whole(true)]
}

/// Objects that are no room for others, but around the eye.
pub(super) fn inside(scout: &Scout) -> Vec<Finding> {
    if !has_eye(scout) {
        return Vec::new();
    }
    let pose = scout.world().camera().pose();
    let (rays, physical) = (scout.probes.len(), super::physical::is_physical(scout));
    let mut found = Vec::new();
    for object in around(scout.world(), pose.center) {
        let own = scout.seen().filter(|(_, seen)| seen.object == object).count();
        // A room has things in it, and light.
        let dark = !physical && all_fail(scout) && scout.verdicts().contains(&Verdict::Blocked(object));
        // Walls that are seen from behind where backs are not shaded are no room's.
        let backs = scout.seen().filter(|(_, seen)| seen.object == object && seen.from_behind).count();
        let walls = !physical && !scout.subject.job.settings.shade_back && backs * 50 > rays;
        if own * 100 < rays * 99 && !dark && !walls {
            continue;
        }
        let Some(bounds) = scout.world().objects()[object as usize].bounds() else { continue };
        let name = scout.object(object);
        let outside = leave(bounds, pose.center, -pose.direction);
        let diagnostic = Diagnostic::warning(format!("the camera is inside the {name}"))
            .label("this place is inside it")
            .related(scout.object_span(object), "around the camera")
            .effect(match dark {
                _ if walls && own * 100 < rays * 99 => "its walls are seen from behind: no light falls on that side",
                true => "it keeps the light out; all that is seen is in its shadow",
                false => "all that is seen is the inside of it",
            })
            .help(match super::extent::times_larger(scout, object) {
                Some(times) => format!(
                    "it is {} times larger than what else there is: make it smaller, or move the camera out, to `center {}`",
                    number(times),
                    vector(outside)
                ),
                None => format!(
                    "move the camera out of it: against its direction it is outside at `center {}`",
                    vector(outside)
                ),
            });
        let diagnostic = scout.at_value(diagnostic, scout.subject.scene.camera_span, &["center"]);
        found.push(Finding::from(diagnostic).whole(true));
    }
    found
}

/// The first place beyond a box on the way from a point inside it, with a little room.
fn leave(bounds: Aabb, from: Vec3, direction: Vec3) -> Vec3 {
    let direction = direction.normalize_or(Vec3::Z);
    let way = bounds.clip(from, direction).map_or(0.0, |(_, leave)| leave);
    from + 1.5 * way * direction
}

/// What the camera should see: the box around all that has an end, else the nearest place of a
/// plane.
pub(super) fn target(scout: &Scout) -> Option<Aabb> {
    let (world, eye) = (scout.world(), scout.world().camera().pose().center);
    let bounds = world.bounds();
    if !bounds.is_empty() {
        return Some(bounds);
    }
    let foot = |object: &Object| match &object.geometry {
        Geometry::Primitive(Primitive::Plane(plane)) => {
            let n = plane.normal.normalize_or(Vec3::Y);
            let on = n * (plane.offset / plane.normal.length().max(f32::MIN_POSITIVE));
            let (on, n) = (object.world_point(on), object.to_world.as_ref().map_or(n, |to_world| to_world.normal(n)));
            Some(eye + (on - eye).dot(n) * n)
        }
        _ => None,
    };
    world.objects().iter().find_map(foot).map(|place| Aabb::around([place]))
}

/// Whether there are things with an end and none of them is in the picture, or nothing is at all.
fn all_outside(scout: &Scout) -> bool {
    let world = scout.world();
    let bounded = || {
        world.objects().iter().zip(scout.sights()).filter(|(object, _)| object.bounds().is_some_and(|b| !b.is_empty()))
    };
    let none = scout.seen().next().is_none();
    match bounded().next() {
        Some(_) => bounded().all(|(_, sight)| *sight == Sight::Outside),
        None => none && !world.objects().is_empty(),
    }
}

/// The plane between the camera and an object, if there is one: no camera that turns sees the
/// object.
fn plane_before(scout: &Scout, object: &Object) -> Option<u32> {
    let world = scout.world();
    let (eye, place) = (world.camera().pose().center, object.bounds().filter(|b| !b.is_empty())?.center());
    let way = Ray { t_max: 1.0, ..Ray::new(eye, place - eye) };
    world.hits_of_each(&way).map(|hit| hit.object).find(|&other| world.objects()[other as usize].bounds().is_none())
}

/// The camera looks past everything, and the middle of things is not in the picture.
pub(super) fn away(scout: &Scout) -> Vec<Finding> {
    let Some(bounds) = target(scout).filter(|_| all_outside(scout)) else { return Vec::new() };
    let (world, span) = (scout.world(), scout.subject.scene.camera_span);
    let (pose, center) = (world.camera().pose(), bounds.center());
    let mut ended = world.objects().iter().filter(|object| object.bounds().is_some()).peekable();
    let behind = has_eye(scout) && ended.peek().is_some() && ended.all(|object| plane_before(scout, object).is_some());
    if aims(scout, center) || behind {
        return Vec::new();
    }
    // A picture that is far too small looks past things too.
    if aims_widely(scout, center) && !super::extent::too_narrow(scout).is_empty() {
        return Vec::new();
    }
    if let Some(diagnostic) = super::lens::shifted(scout, center) {
        return vec![Finding::from(diagnostic).whole(true)];
    }
    let hits = scout.seen().count();
    let effect = match hits {
        0 => "every ray misses; the whole picture is background".to_string(),
        _ => format!("only {} is seen", only_seen(scout)),
    };
    let mut diagnostic = Diagnostic::warning("the camera looks past everything").effect(effect);
    if !has_eye(scout) {
        let off = center - pose.center;
        let forward = world.camera_frame().forward;
        let across = off - off.dot(forward) * forward;
        let place = pose.center + across;
        diagnostic.message += &format!(": the middle of the scene lies {} beside its axis", number(across.length()));
        diagnostic = diagnostic.help(format!("{}move it there: `center {}`", nearest(scout), vector(place)));
        let diagnostic = mended(scout, diagnostic, "center", place);
        return vec![Finding::from(diagnostic).whole(true)];
    }
    let to = center - pose.center;
    let angle = degrees(pose.direction, to);
    // With an `up` that says nothing the picture may be turned any way; far from its middle that does
    // not matter.
    let turned = pose.up.normalize_or_zero().cross(pose.direction.normalize_or_zero()).length() < 1e-3;
    if turned && angle < 60.0 {
        return Vec::new();
    }
    diagnostic.message += &format!(": the middle of the scene lies {angle:.0} degrees off its direction");
    let moved = super::places::moved(scout);
    let first = moved.as_ref().map_or_else(|| nearest(scout), |(_, words)| words.clone() + "; or ");
    let mut help = format!("{first}turn it: `direction {}`", vector(to));
    let as_point = pose.direction - pose.center;
    if degrees(as_point, to) < 20.0 && angle > 20.0 {
        help += "; `direction` is a direction, not the point to look at";
    }
    let diagnostic = match (moved, scout.value(span, &["direction"])) {
        // Which of the two is wrong nobody knows.
        (Some((place, _)), _) => diagnostic.help(help).at(place).related(span, "the camera"),
        (None, Some(_)) => mended(scout, diagnostic.help(help), "direction", to),
        (None, None) => diagnostic.help(help).at(span),
    };
    vec![Finding::from(diagnostic).whole(true)]
}

/// Whether a camera of usual width would see a place.
fn aims_widely(scout: &Scout, place: Vec3) -> bool {
    let world = scout.world();
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

/// A vector of the camera is to be another.
fn mended(scout: &Scout, diagnostic: Diagnostic, field: &str, value: Vec3) -> Diagnostic {
    let span = scout.subject.scene.camera_span;
    match scout.value(span, &[field]).filter(|_| value != Vec3::ZERO || field == "center") {
        Some(place) => diagnostic.at(place).fix(place, vector(value)),
        None => diagnostic.at(span),
    }
}

/// Whether the camera sees a place, if nothing is in front of it.
pub(super) fn aims(scout: &Scout, place: Vec3) -> bool {
    !super::sight::rays_to(scout, place).is_empty()
}

fn degrees(a: Vec3, b: Vec3) -> f32 {
    let (a, b) = (a.normalize_or_zero(), b.normalize_or_zero());
    fp::atan2(a.cross(b).length(), a.dot(b)).to_degrees()
}

/// The names of what is seen instead.
fn only_seen(scout: &Scout) -> String {
    let mut objects: Vec<u32> = scout.seen().map(|(_, seen)| seen.object).collect();
    objects.sort_unstable();
    objects.dedup();
    match &objects[..] {
        [one] => format!("the {}", scout.object(*one)),
        all => format!("{} objects without an end", all.len()),
    }
}

/// By how much the ray that comes nearest misses the ball around an object.
fn nearest(scout: &Scout) -> String {
    let world = scout.world();
    let balls = world.objects().iter().enumerate().filter_map(|(i, object)| {
        let bounds = object.bounds().filter(|bounds| !bounds.is_empty())?;
        Some((i as u32, bounds.center(), 0.5 * bounds.size().length()))
    });
    let misses = balls.take(500).flat_map(|(i, center, radius)| {
        scout.probes.iter().map(move |probe| {
            let to = center - probe.ray.origin;
            let along = to.dot(probe.ray.dir).max(probe.ray.t_min);
            (i, (to - along * probe.ray.dir).length() - radius)
        })
    });
    match misses.min_by(|a, b| a.1.total_cmp(&b.1)) {
        Some((object, by)) if by > 0.0 => {
            format!("the nearest ray passes {} beside the {}; ", number(by), scout.object(object))
        }
        _ => String::new(),
    }
}

/// The picture is empty although the camera looks at things: they are too small, or there is
/// nothing of them.
pub(super) fn missed(scout: &Scout) -> Vec<Finding> {
    let world = scout.world();
    if scout.seen().next().is_some() || world.objects().is_empty() {
        return Vec::new();
    }
    // What is too small for the grid of rays is no hole.
    let hit = scout.sights().contains(&Sight::Seen);
    let Some(bounds) = target(scout).filter(|bounds| !hit && aims(scout, bounds.center())) else { return Vec::new() };
    let mut diagnostic = Diagnostic::warning("every ray misses, though the camera looks at the middle of the scene")
        .effect("the whole picture is background")
        .at(scout.subject.scene.camera_span);
    let size = pixels(scout, bounds);
    diagnostic.help = Some(match size {
        Some(size) if size < 12.0 => return Vec::new(),
        _ => format!("{}is there a hole in the middle, or is it seen from its edge?", nearest(scout)),
    });
    vec![Finding::from(diagnostic).last()]
}

/// How many pixels of the picture a box spans.
pub(super) fn pixels(scout: &Scout, bounds: Aabb) -> Option<f32> {
    let (world, job) = (scout.world(), scout.subject.job);
    let mut around: Option<(Vec2, Vec2)> = None;
    let mut unseen = 0;
    for point in bounds.corners() {
        let mut places = Vec::new();
        world.camera().project(world.camera_frame(), point, Vec2::splat(0.5), &mut |place| places.push(place));
        unseen += usize::from(places.len() != 1);
        for place in places {
            let (min, max) = around.unwrap_or((place, place));
            around = Some((min.min(place), max.max(place)));
        }
    }
    let (min, max) = around.filter(|_| unseen == 0)?;
    // The larger side of the picture spans 2.
    Some((max - min).max_element() / (2.0 * corner(scout).max_element()) * job.width.max(job.height) as f32)
}

/// One thing is in front of all others, or of nearly all.
pub(super) fn hidden_behind(scout: &Scout) -> Vec<Finding> {
    let found = hidden(scout);
    if found.is_empty() { super::unseen::in_the_way(scout) } else { found }
}

/// One thing is in front of all others.
pub(super) fn hidden(scout: &Scout) -> Vec<Finding> {
    let mut hits = scout.seen().map(|(_, seen)| seen.object);
    let Some(front) = hits.next().filter(|front| hits.all(|other| other == *front)) else { return Vec::new() };
    let (mut hidden, mut others) = (0, 0);
    let empty = super::objects::empty_solids(scout);
    let there = |(i, _): &(usize, &Sight)| *i as u32 != front && !empty.contains(&(*i as u32));
    for (number, sight) in scout.sights().iter().enumerate().filter(there) {
        match sight {
            Sight::Hidden(_) => hidden += 1,
            Sight::Unknown if scout.world().objects()[number].bounds().is_none() => {}
            _ => others += 1,
        }
    }
    let covered = scout.seen().count();
    let is_plane = scout.world().objects()[front as usize].bounds().is_none();
    // A thing may well stand behind another; behind a plane without end, nothing is ever seen.
    let few = !is_plane && covered * 2 < scout.probes.len();
    if hidden == 0 || others > 0 || few || super::unseen::is_glass(scout, front) {
        return Vec::new();
    }
    let name = scout.object(front);
    let behind = scout.seen().all(|(_, seen)| seen.from_behind);
    // Rays without a beginning see what is behind the camera too.
    let backwards = !has_eye(scout) && scout.seen().all(|(_, seen)| seen.t < 0.0);
    // Whoever looks at its back may be on the wrong side of it himself.
    let turned = (is_plane && !behind).then(|| offset_turned(scout, front)).flatten();
    let help = match (is_plane, behind) {
        _ if backwards => {
            "it is behind the camera's `center`, but this camera's rays have no beginning and see what is behind it first: move \
             it away, or turn its `offset`"
        }
        _ if is_plane && turned.is_none() && !behind => {
            "the camera and the things behind the plane are on different sides of it: move one of them"
        }
        (true, true) => {
            "the camera is behind the plane, which stands where p · normal = offset: move the camera, or look at `offset` \
             and at the direction of `normal`"
        }
        (true, false) => "the plane stands where p · normal = offset: is the sign of `offset` right?",
        _ => "move it, make it smaller, or move the camera",
    };
    let diagnostic = Diagnostic::warning(format!("the {name} hides everything else"))
        .at(scout.object_span(front))
        .label(format!("covers {} of the picture", percent(covered, scout.probes.len())))
        .effect(format!("{} behind it cannot be seen", super::finding::counted(hidden, "object", "objects")))
        .help(help);
    let diagnostic = match turned {
        Some((place, text)) => diagnostic.fix(place, text),
        None => diagnostic,
    };
    vec![Finding::from(diagnostic).whole(true)]
}

/// A plane between the camera and all things that have an end, though something else, the sky say,
/// is seen beside it.
pub(super) fn below_plane(scout: &Scout) -> Vec<Finding> {
    let objects = scout.world().objects();
    let mut front = None;
    let empty = super::objects::empty_solids(scout);
    let there =
        |(i, (object, _)): &(usize, (&Object, &Sight))| object.bounds().is_some() && !empty.contains(&(*i as u32));
    for (_, (object, sight)) in objects.iter().zip(scout.sights()).enumerate().filter(there) {
        let by = match sight {
            Sight::Hidden(by) => {
                Some(*by).filter(|by| objects[*by as usize].bounds().is_none() && !super::unseen::is_glass(scout, *by))
            }
            Sight::Outside if has_eye(scout) => plane_before(scout, object),
            _ => None,
        };
        if by.is_none() || front.is_some_and(|known| Some(known) != by) {
            front = None;
            break;
        }
        front = by;
    }
    let front = match front {
        Some(front) => Some(front).filter(|_| hidden(scout).is_empty()),
        None => ceiling(scout),
    };
    let Some(front) = front else { return Vec::new() };
    let lid = ceiling(scout) == Some(front);
    let what =
        if lid { "everything, the camera too, is below the" } else { "all other things are on the far side of the" };
    if let Some(raised) = raised(scout, front).filter(|_| !lid) {
        let pose = scout.world().camera().pose();
        let diagnostic = Diagnostic::warning(format!("the camera is below the {}", scout.object(front)))
            .related(scout.object_span(front), "the other things stand on it")
            .effect("nothing but the plane and the background is seen")
            .help(format!("move it to the side of the things: `center {}`, say", vector(raised)));
        let span = scout.subject.scene.camera_span;
        let value = scout.value(span, &["center"]).filter(|_| raised != pose.center);
        let diagnostic = scout.at_value(diagnostic.fix_at(value, vector(raised)), span, &["center"]);
        return vec![Finding::from(diagnostic).whole(true)];
    }
    let diagnostic = Diagnostic::warning(format!("{what} {}", scout.object(front)))
        .at(scout.object_span(front))
        .effect(match lid {
            true => "it is a ceiling that is seen from its back, and keeps off the light from above",
            false => "nothing but the plane and the background is seen",
        })
        .help("a plane stands where p · normal = offset: look at its `offset`, or at the height of the things");
    let diagnostic = match offset_turned(scout, front) {
        Some((place, text)) => diagnostic.fix(place, text),
        None => diagnostic,
    };
    vec![Finding::from(diagnostic).whole(true)]
}

/// Where the camera would be as far above a plane as it is below, if all things stand on it.
fn raised(scout: &Scout, object: u32) -> Option<Vec3> {
    let (n, d) = ground(scout, object)?;
    let eye = scout.world().camera().pose().center;
    let height = |p: Vec3| p.dot(n) - d;
    let things: Vec<[Vec3; 8]> = scout.world().objects().iter().filter_map(|o| Some(o.bounds()?.corners())).collect();
    let size = scout.world().bounds().size().max_element();
    let lowest = things.iter().flatten().map(|p| height(*p)).fold(f32::INFINITY, f32::min);
    (lowest > -0.05 * size && lowest < 0.05 * size && height(eye) < 0.0).then(|| eye - 2.0 * height(eye) * n)
}

/// The normal and offset of a plane in the world.
fn ground(scout: &Scout, object: u32) -> Option<(Vec3, f32)> {
    let object = &scout.world().objects()[object as usize];
    let Geometry::Primitive(Primitive::Plane(plane)) = &object.geometry else { return None };
    let on = object.world_point(plane.normal * (plane.offset / plane.normal.length_squared().max(f32::MIN_POSITIVE)));
    let n = object.to_world.as_ref().map_or(plane.normal, |m| m.normal(plane.normal)).normalize_or(Vec3::Y);
    Some((n, on.dot(n)))
}

/// Planes that pass through the middle of most things: a floor with another axis for its normal,
/// say.
pub(super) fn plane_through(scout: &Scout) -> Vec<Finding> {
    let world = scout.world();
    let boxes: Vec<[Vec3; 8]> =
        world.objects().iter().filter_map(|o| Some(o.bounds()?.corners())).take(super::MOST_SOUGHT).collect();
    let through = |&number: &u32| {
        let Some((n, d)) = ground(scout, number) else { return false };
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
        // Things may well be sunk into a floor.
        let floor = ground(scout, number).is_some_and(|(n, _)| n.dot(world.camera_frame().up).abs() > 0.8);
        let severity = if floor { Severity::Note } else { Severity::Warning };
        let message = format!("the {} passes through the middle of most things", scout.object(number));
        let diagnostic = Diagnostic { severity, ..Diagnostic::warning(message) }
            .at(scout.object_span(number))
            .effect("only what is before it is seen of them")
            .help("a floor lies below things: which axis is up? Look at its `normal` and `offset`, and what turns it");
        Finding::from(diagnostic)
    };
    (0..world.objects().len() as u32).filter(through).take(2).map(say).collect()
}

/// A camera whose `up` points into the ground on which all things stand.
pub(super) fn upside_down(scout: &Scout) -> Vec<Finding> {
    let world = scout.world();
    let (eye, things) = (world.camera().pose().center, world.bounds());
    let mut planes = (0..world.objects().len() as u32).filter_map(|i| Some((i, ground(scout, i)?)));
    let (Some((number, (n, d))), None) = (planes.next(), planes.next()) else { return Vec::new() };
    let (n, d) = if eye.dot(n) < d { (-n, -d) } else { (n, d) };
    let height = |p: &Vec3| p.dot(n) - d;
    let size = things.size().max_element();
    let stand = !things.is_empty() && things.corners().iter().all(|p| height(p) > -0.1 * size);
    let pose = world.camera().pose();
    let seen = scout.seen().any(|(_, seen)| seen.object == number);
    // A ceiling from which things hang is as good as a ground; that things stand on it tells which it
    // is.
    let lowest = things.corners().iter().map(height).fold(f32::INFINITY, f32::min);
    if !stand || !seen || lowest > 0.3 * size || world.camera_frame().up.dot(n) > -0.3 || pose.up.dot(n) > 0.1 {
        return Vec::new();
    }
    let turned = vector(if pose.up.dot(n) < -0.5 { -pose.up } else { n });
    let span = scout.subject.scene.camera_span;
    let diagnostic = Diagnostic::warning("the picture is upside down: the camera's `up` points into the ground")
        .related(scout.object_span(number), "the ground")
        .effect("things hang from it")
        .help(format!("`up` is where the upper edge of the picture is: `up {turned}`"))
        .fix_at(scout.value(span, &["up"]), turned);
    vec![Finding::from(scout.at_value(diagnostic, span, &["up"]))]
}

/// The only plane, if it faces up and all things and the camera are below it.
fn ceiling(scout: &Scout) -> Option<u32> {
    let world = scout.world();
    let planes = world.objects().iter().enumerate().filter(|(_, object)| object.bounds().is_none());
    let mut planes = planes.filter_map(|(i, object)| match &object.geometry {
        Geometry::Primitive(Primitive::Plane(plane)) if object.to_world.is_none() => Some((i as u32, plane)),
        _ => None,
    });
    let (number, plane) = planes.next().filter(|_| planes.next().is_none())?;
    let pose = world.camera().pose();
    let below = |p: Vec3| p.dot(plane.normal) < plane.offset;
    let faces_up = plane.normal.normalize_or_zero().dot(pose.up.normalize_or_zero()) > 0.7;
    let things = world.bounds();
    let all = !things.is_empty() && things.corners().iter().all(|corner| below(*corner)) && below(pose.center);
    let seen = scout.seen().any(|(_, seen)| seen.object == number);
    (faces_up && all && seen && !matches!(world.camera(), Camera::Orthographic(_))).then_some(number)
}

/// The other sign of a plane's offset and where it is written, if the camera and the things are on
/// one side of it then.
fn offset_turned(scout: &Scout, object: u32) -> Option<(Span, String)> {
    let plane_object = &scout.world().objects()[object as usize];
    let Geometry::Primitive(Primitive::Plane(plane)) = &plane_object.geometry else { return None };
    if plane_object.to_world.is_some() || plane.offset == 0.0 {
        return None;
    }
    let place = scout.value(scout.object_span(object), &["offset"])?;
    let above = |p: Vec3| p.dot(plane.normal) > -plane.offset;
    let things = scout.world().bounds();
    (above(things.center()) == above(scout.world().camera().pose().center)).then(|| (place, number(-plane.offset)))
}
