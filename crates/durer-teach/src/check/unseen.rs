//! Checks for invisible objects: outside the picture, hidden, far away, too small, or flat.

use super::finding::{Finding, MAX_SOUGHT, counted, number, vector};
use super::scene_probe::SceneProbe;
use super::shapes::{plane, triangle};
use super::visibility::{Visibility, pixels};
use durer_diag::{Diagnostic, Severity, Span};
use durer_render::world::{Geometry, Object};
use durer_scene::camera::Projection;
use durer_scene::math::{Aabb, Vec3};
use durer_scene::scene::ObjectKind;

/// In scenes with more objects than this, some objects can be out of sight on purpose.
const FEW_OBJECTS: usize = 8;

/// Reports objects that are not visible in the picture.
pub(super) fn unseen(scout: &SceneProbe) -> Vec<Finding> {
    let visibilities = scout.visibilities();
    let nothing: Vec<u32> = super::objects::nothing_of(scout);
    // In a large scene, some objects are always hidden or outside the picture.
    let mut found = far_away(scout);
    let missing =
        visibilities.iter().filter(|sight| matches!(sight, Visibility::Outside | Visibility::Hidden(_))).count();
    if visibilities.len() > FEW_OBJECTS && missing * 3 < visibilities.len() {
        return found;
    }
    let all = (0..visibilities.len() as u32).filter(|i| !nothing.contains(i));
    let out: Vec<u32> = all.clone().filter(|&i| visibilities[i as usize] == Visibility::Outside).collect();
    let hidden: Vec<(u32, u32)> = all
        .filter_map(|i| match visibilities[i as usize] {
            // Objects behind glass, or seen in a mirror, are visible.
            Visibility::Hidden(by) if !scout.is_glass(by) && found.is_empty() => Some((i, by)),
            _ => None,
        })
        // A triangle behind another is the far side of a body.
        .filter(|&(i, by)| ![i, by].iter().all(|&object| is_triangle(scout, object)))
        // `same-place` reports duplicates.
        .filter(|&(i, by)| {
            !super::objects::same(&scout.world().objects()[i as usize], &scout.world().objects()[by as usize])
        })
        .collect();
    // Warn if most of a small scene is missing, which is probably a mistake.
    let bounded = scout.world().objects().iter().filter(|object| object.bounds().is_some()).count();
    let most = |lost: usize| lost >= 2 && lost * 2 >= bounded && visibilities.len() <= FEW_OBJECTS;
    let severity = |lost: usize| if most(lost) { Severity::Warning } else { Severity::Note };
    if let Some(&first) = out.first().filter(|_| found.is_empty()) {
        let message = match out.len() {
            1 => format!("the {} is not in the picture", scout.object(first)),
            n => format!(
                "{} are not in the picture; the first is the {}",
                counted(n, "object", "objects"),
                scout.object(first)
            ),
        };
        // An object outside the picture can be there for its shadow or its light, unless almost
        // nothing else is visible.
        let own = |(_, seen): &(_, &crate::check::probes::ProbeHit)| {
            scout.world().objects()[seen.object as usize].bounds().is_some()
        };
        let left = scout.seen().filter(own).count() * 50;
        let severity = if left < scout.probes.len() { severity(out.len()) } else { Severity::Note };
        let diagnostic = Diagnostic { severity, ..Diagnostic::note(message) }
            .at(scout.object_span(first))
            .effect("the camera looks elsewhere")
            .help("check its position and the transforms around it");
        found.push(Finding::from(diagnostic));
    }
    if let Some(&(first, by)) = hidden.first() {
        let more =
            if hidden.len() == 1 { String::new() } else { format!("; {} more are hidden too", hidden.len() - 1) };
        let inside = holds(scout, by, first);
        let (a, b) = (scout.object(first), scout.object(by));
        let message = match inside {
            true => format!("the {a} is inside the {b}{more}"),
            false => format!("the {a} is hidden by the {b}{more}"),
        };
        let plane = plane(&scout.world().objects()[by as usize]).is_some();
        let help = match (plane, inside) {
            (true, _) => "it is behind the plane, which is at p · normal = offset: is the sign of `offset` correct?",
            (false, true) => "move it outside, or move or shrink the other object",
            (false, false) => "is it on the wrong side of the other object, or is that object in the way?",
        };
        // An object can be hidden by another on purpose.
        let one = hidden.iter().all(|(_, other)| *other == by);
        let severity = match below(scout, by, first) {
            // An object behind an infinite plane is never visible.
            true => Severity::Warning,
            false if plane || inside || one => severity(hidden.len()),
            false => Severity::Note,
        };
        let diagnostic = Diagnostic { severity, ..Diagnostic::note(message) }
            .at(scout.object_span(first))
            .related(scout.object_span(by), if inside { "around it" } else { "in front of it" })
            .effect("it is invisible")
            .help(help);
        let diagnostic = match mirrored(scout, first) {
            Some((place, text)) => diagnostic
                .at(place)
                .help(format!("a negative scale, `{text}`, mirrors it through its origin: remove the sign"))
                .fix(place, text.replace('-', "")),
            None => diagnostic,
        };
        found.push(Finding::from(diagnostic));
    }
    found
}

/// Returns true if a plane separates an object from the camera.
fn below(scout: &SceneProbe, plane: u32, object: u32) -> bool {
    let Some((n, d)) = super::hidden::ground(scout, plane) else { return false };
    let eye = scout.world().camera().pose().center.dot(n) - d;
    let bounds = scout.world().objects()[object as usize].bounds().filter(|bounds| !bounds.is_empty());
    bounds.is_some_and(|bounds| bounds.corners().iter().all(|corner| (corner.dot(n) - d) * eye < 0.0))
}

/// Returns the span and the text of the negative scale that mirrors an object.
fn mirrored(scout: &SceneProbe, number: u32) -> Option<(Span, String)> {
    let object = &scout.world().objects()[number as usize];
    object.to_world.as_ref().filter(|to_world| {
        to_world.vector(Vec3::X).cross(to_world.vector(Vec3::Y)).dot(to_world.vector(Vec3::Z)) < 0.0
    })?;
    let mut all: Vec<(&durer_scene::scene::Object, Option<Span>)> =
        scout.subject.scene.root.iter().flat_map(|root| &root.objects).map(|object| (object, None)).collect();
    while let Some((inner, around)) = all.pop() {
        if inner.span.start == object.span.start && inner.span.file == object.span.file {
            let value = scout.value(around?, &["UniformScale", "Scale", "scale"])?;
            return Some((value, scout.text(value)));
        }
        match &inner.node {
            ObjectKind::Group(group) => all.extend(group.objects.iter().map(|object| (object, around))),
            ObjectKind::Transform(_, within) => all.push((within, Some(inner.span))),
            _ => {}
        }
    }
    None
}

/// Returns true if the centre of one object is inside another.
fn holds(scout: &SceneProbe, outer: u32, inner: u32) -> bool {
    let middle = scout.world().objects()[inner as usize].bounds().map(|bounds| bounds.center());
    middle.is_some_and(|middle| super::within::around(scout.world(), middle).contains(&outer))
}

/// Reports objects smaller than a pixel.
pub(super) fn tiny(scout: &SceneProbe) -> Vec<Finding> {
    let objects = scout.world().objects();
    let small = |(index, object): (usize, &Object)| {
        let bounds = object.bounds().filter(|bounds| !bounds.is_empty())?;
        // A mesh with many triangles is not meant to be a dot.
        let least = if matches!(&object.geometry, Geometry::Mesh(tree) if tree.mesh.len() > 50) { 6.0 } else { 1.5 };
        let size = pixels(scout, bounds).filter(|size| *size < least)?;
        let looked = super::visibility::rays_to(scout, bounds.center());
        (!looked.is_empty() && scout.visibilities()[index] != Visibility::Outside).then_some((
            index as u32,
            size,
            bounds,
        ))
    };
    let all: Vec<_> = objects.iter().enumerate().take(MAX_SOUGHT).filter_map(small).collect();
    // A swarm of tiny objects is probably intended, and `too-small` reports a scene that is tiny as
    // a whole.
    let bounded = objects.iter().filter(|object| object.bounds().is_some()).count();
    if objects.len() > FEW_OBJECTS || all.len() == bounded || scout.seen().next().is_none() {
        return Vec::new();
    }
    let say = |(index, size, bounds): (u32, f32, Aabb)| {
        let diagnostic = Diagnostic::warning(format!("the {} is {} pixels wide", scout.object(index), number(size)))
            .at(scout.object_span(index))
            .effect("it is invisible, or a speck")
            .help(format!(
                "its largest side is {}: check its size and the `{}` around it",
                number(bounds.size().max_element()),
                scout.word("Scale", "scale")
            ));
        Finding::from(diagnostic)
    };
    all.into_iter().map(say).collect()
}

/// Reports height fields with the same height everywhere.
pub(super) fn flat_field(scout: &SceneProbe) -> Vec<Finding> {
    let mut found = Vec::new();
    let mut all: Vec<&durer_scene::scene::Object> =
        scout.subject.scene.root.iter().flat_map(|root| &root.objects).collect();
    while let Some(object) = all.pop().filter(|_| found.len() < MAX_SOUGHT) {
        match &object.node {
            ObjectKind::Group(group) => all.extend(&group.objects),
            ObjectKind::Transform(_, inner) => all.push(inner),
            ObjectKind::Solid(_, parts) => all.extend(parts),
            ObjectKind::HeightField(field) => {
                let size = field.max - field.min;
                let wide = size.x.max(size.z);
                if size.y > 0.002 * wide {
                    found.extend(even_field(scout, object, size));
                    continue;
                }
                let max = vector(Vec3::new(field.max.x, field.min.y + 0.2 * wide, field.max.z));
                let diagnostic = Diagnostic::warning(format!(
                    "this height field is {} wide and {} high",
                    number(wide),
                    number(size.y)
                ))
                .effect("it looks flat")
                .help(format!("heights range from `min` to `max` along y: try `max {max}`"));
                let diagnostic = diagnostic.fix_at(scout.value(object.span, &["max"]), max);
                found.push(Finding::from(scout.at_value(diagnostic, object.span, &["max"])));
            }
            _ => {}
        }
    }
    found
}

/// Returns a warning about a landscape whose height map has the same value everywhere.
fn even_field(scout: &SceneProbe, object: &durer_scene::scene::Object, size: Vec3) -> Option<Finding> {
    let is_it = |own: &&Object| own.span.file == object.span.file && own.span.start == object.span.start;
    let mesh = scout.world().objects().iter().find(is_it).and_then(|own| match &own.geometry {
        Geometry::Mesh(tree) => Some(&tree.mesh),
        Geometry::Primitive(_) | Geometry::Solid(_) => None,
    })?;
    let step = (mesh.len() / 2000).max(1);
    // Ignore the sides and the underside.
    let upper = |[a, b, c]: &[Vec3; 3]| {
        let n = (*b - *a).cross(*c - *a);
        n.y.abs() > 1e-3 * n.length() && n.y > 0.0
    };
    let faces = (0..mesh.len()).step_by(step).map(|part| mesh.corners(part as u32)).filter(upper);
    let corners = faces.flatten();
    let (low, high) = corners.fold((f32::MAX, f32::MIN), |(low, high), p| (low.min(p.y), high.max(p.y)));
    if high - low > 0.002 * size.y {
        return None;
    }
    let diagnostic = Diagnostic::warning("the height map of this landscape has the same value everywhere")
        .effect("the landscape is flat")
        .help("dark pixels are low and bright ones high: use an image with different values");
    Some(Finding::from(scout.at_value(diagnostic, object.span, &["picture"])))
}

fn is_triangle(scout: &SceneProbe, object: u32) -> bool {
    triangle(&scout.world().objects()[object as usize]).is_some()
}

/// Reports objects far from everything visible, for example moved away by a transform.
fn far_away(scout: &SceneProbe) -> Vec<Finding> {
    let both = || scout.world().objects().iter().zip(scout.visibilities()).enumerate();
    let seen =
        both().filter(|(_, (_, sight))| **sight == Visibility::Seen).filter_map(|(_, (object, _))| object.bounds());
    let core = seen.fold(Aabb::EMPTY, Aabb::union);
    let far = |bounds: Aabb| (bounds.center() - core.center()).length() > 10.0 * core.size().length();
    let out = |sight: &Visibility| matches!(sight, Visibility::Outside | Visibility::Hidden(_));
    let lost = both().find(|(_, (object, sight))| out(sight) && object.bounds().is_some_and(far));
    let Some((index, (object, _))) = lost.filter(|_| !core.is_empty()) else { return Vec::new() };
    let place = object.bounds().map_or_else(String::new, |bounds| vector(bounds.center()));
    let diagnostic =
        Diagnostic::warning(format!("the {} is far from everything else, at {place}", scout.object(index as u32)))
            .at(object.span)
            .effect("it is invisible")
            .help("check its position and the transforms around it");
    vec![Finding::from(diagnostic)]
}
