//! Checks for objects that are invisible because they are outside the picture, hidden, far away,
//! too small, or flat.

use super::finding::{Finding, MAX_FINDINGS, counted, number, vector};
use super::scene_probe::SceneProbe;
use super::shapes::{is_ball, plane, shape, triangle};
use super::visibility::{Visibility, past_hidden_backs, pixels, points, rays_to};
use durer_diag::{Diagnostic, Severity, Span};
use durer_render::world::{Geometry, Object};
use durer_scene::camera::Projection;
use durer_scene::math::{Aabb, Vec3};
use durer_scene::scene::ObjectKind;
use durer_scene::shape::Shape as _;

/// If a scene has more objects than this, some of them may be out of sight on purpose.
const FEW_OBJECTS: usize = 8;

/// Reports objects that are not visible in the picture.
pub(super) fn invisible(scene_probe: &SceneProbe) -> Vec<Finding> {
    let visibilities = scene_probe.visibilities();
    let nothing: Vec<u32> = super::objects::without_surface(scene_probe);
    // In a large scene, some objects are always hidden or outside the picture.
    let mut findings = far_away(scene_probe);
    findings.extend(turned_away(scene_probe));
    findings.extend(around_everything(scene_probe));
    let missing =
        visibilities.iter().filter(|sight| matches!(sight, Visibility::Outside | Visibility::Hidden(_))).count();
    if visibilities.len() > FEW_OBJECTS && missing * 3 < visibilities.len() {
        return findings;
    }
    let all = (0..visibilities.len() as u32).filter(|i| !nothing.contains(i));
    // A light outside the picture is normal.
    let is_lamp = |i: u32| scene_probe.world().may_emit(scene_probe.world().objects()[i as usize].material);
    // An object beside or behind the camera can be seen in a mirror.
    let is_mirrored = |i: u32| scene_probe.probes.iter().any(|probe| probe.indirect.contains(&i));
    let outside = |i: &u32| visibilities[*i as usize] == Visibility::Outside && !is_lamp(*i) && !is_mirrored(*i);
    let out: Vec<u32> = all.clone().filter(outside).collect();
    let hidden: Vec<(u32, u32)> = all
        .filter_map(|i| match visibilities[i as usize] {
            // Objects behind glass and objects seen in a mirror count as visible.
            Visibility::Hidden(by) if !scene_probe.is_glass(by) && findings.is_empty() && !is_lamp(i) => Some((i, by)),
            _ => None,
        })
        // If a triangle is behind another one, or a flat shape behind one of the same material, it
        // is the far side of a body.
        .filter(|&(i, by)| {
            let material = |object: u32| scene_probe.world().objects()[object as usize].material;
            let is_side = |object: u32| {
                is_triangle(scene_probe, object) || material(i) == material(by) && is_flat(scene_probe, object)
            };
            ![i, by].into_iter().all(is_side)
        })
        // The check `same-place` reports duplicates.
        .filter(|&(i, by)| {
            !super::objects::same(
                &scene_probe.world().objects()[i as usize],
                &scene_probe.world().objects()[by as usize],
            )
        })
        .collect();
    // A warning is given if most of a small scene is missing, which is probably a mistake.
    let bounded = scene_probe.world().objects().iter().filter(|object| object.bounds().is_some()).count();
    let most = |lost: usize| lost >= 2 && lost * 2 >= bounded && visibilities.len() <= FEW_OBJECTS;
    let severity = |lost: usize| if most(lost) { Severity::Warning } else { Severity::Note };
    if let Some(&first) = out.first().filter(|_| findings.is_empty()) {
        let place = super::placement::beside_picture(scene_probe, first);
        let message = match out.len() {
            1 => format!("the {} is not in the picture: it is {place}", scene_probe.object(first)),
            n => format!(
                "{} are not in the picture; the first, the {}, is {place}",
                counted(n, "object", "objects"),
                scene_probe.object(first)
            ),
        };
        // An object outside the picture may be there for its shadow or its light, unless almost
        // nothing else is visible.
        let own = |(_, hit): &(_, &crate::check::probes::ProbeHit)| {
            scene_probe.world().objects()[hit.object as usize].bounds().is_some()
        };
        let left = scene_probe.hits().filter(own).count() * 50;
        let severity = if left < scene_probe.probes.len() { severity(out.len()) } else { Severity::Note };
        let diagnostic = Diagnostic { severity, ..Diagnostic::note(message) }
            .at(scene_probe.object_span(first))
            .effect("the object is invisible");
        let diagnostic = match super::transforms::why_moved(scene_probe, first) {
            Some((span, words)) => diagnostic.related(span, "the transforms of the object").help(words),
            None => diagnostic.help("check the position of the object and the transforms that enclose it"),
        };
        findings.push(Finding::from(diagnostic));
    }
    if let Some(&(first, by)) = hidden.first() {
        let more = match hidden.len() - 1 {
            0 => String::new(),
            1 => "; 1 other object is hidden too".into(),
            n => format!("; {n} other objects are hidden too"),
        };
        let inside = contains_center(scene_probe, by, first);
        let (a, b) = (scene_probe.object(first), scene_probe.object(by));
        let message = match inside {
            true => format!("the {a} is inside the {b}{more}"),
            false => format!("the {a} is hidden by the {b}{more}"),
        };
        let offset = plane(&scene_probe.world().objects()[by as usize]).map(|plane| plane.offset);
        let plane = offset.is_some();
        let help = match (plane, inside) {
            (true, _) if offset == Some(0.0) => {
                "the object is behind the plane, which passes through the origin: move the object or the plane"
            }
            (true, _) => "check the sign of `offset`: the object is behind the plane, which is at p · normal = offset",
            (false, true) => "move the object outside, or move or shrink the other object",
            (false, false) => "move the object to the other side, or move the object that hides it",
        };
        // One object may hide another on purpose.
        let one = hidden.iter().all(|(_, other)| *other == by);
        let severity = match separated_by_plane(scene_probe, by, first) {
            // An object behind an infinite plane is never visible.
            true => Severity::Warning,
            false if plane || inside || one => severity(hidden.len()),
            false => Severity::Note,
        };
        let diagnostic = Diagnostic { severity, ..Diagnostic::note(message) }
            .at(scene_probe.object_span(first))
            .related(scene_probe.object_span(by), if inside { "the enclosing object" } else { "the object in front" })
            .effect("the object is invisible")
            .help(help);
        let diagnostic = match negative_scale(scene_probe, first) {
            Some((place, text)) => diagnostic
                .at(place)
                .help(format!(
                    "remove the minus sign: the negative scale `{text}` mirrors the object through its origin"
                ))
                .fix(place, text.replace('-', "")),
            None => diagnostic,
        };
        findings.push(Finding::from(diagnostic));
    }
    findings
}

/// Returns true if an object is a flat shape with an end.
fn is_flat(scene_probe: &SceneProbe, object: u32) -> bool {
    let object = &scene_probe.world().objects()[object as usize];
    object.bounds().is_some() && shape(object).is_some_and(|shape| shape.flip().is_some())
}

/// Reports an invisible ball around the camera and all other objects, which hide it.
fn around_everything(scene_probe: &SceneProbe) -> Option<Finding> {
    let world = scene_probe.world();
    let eye = world.camera().pose().center;
    let around = super::containment::containing_objects(world, eye).into_iter().find(|&number| {
        let ball = &world.objects()[number as usize];
        let others = world.objects().iter().enumerate().filter(|(other, _)| *other as u32 != number);
        let mut centers = others.filter_map(|(_, other)| Some(other.bounds()?.center()));
        is_ball(ball)
            && scene_probe.visibilities()[number as usize] != Visibility::Visible
            && !scene_probe.probes.iter().any(|probe| probe.indirect.contains(&number))
            && !world.may_emit(ball.material)
            && !super::area_lights::transmits_light(scene_probe, number)
            && world.objects().len() > 2
            && centers.all(|center| ball.contains(center))
    })?;
    let size = world.objects()[around as usize].bounds()?.size().max_element();
    let message = format!("the camera and all other objects are inside the {}", scene_probe.object(around));
    let diagnostic = Diagnostic::warning(message)
        .effect("the object is invisible, because the others hide its inside")
        .help(format!("make it smaller, or remove it: its radius is {}", number(0.5 * size)));
    Some(Finding::from(scene_probe.at_value(diagnostic, scene_probe.object_span(around), &["radius"])))
}

/// Reports objects of which the camera sees only hidden backs.
fn turned_away(scene_probe: &SceneProbe) -> Vec<Finding> {
    let turned = scene_probe.visibilities().iter().enumerate().filter(|(_, sight)| **sight == Visibility::TurnedAway);
    let say = |(number, _): (usize, &Visibility)| {
        let (world, object) = (scene_probe.world(), &scene_probe.world().objects()[number]);
        // A wall that lets the camera look into a room hides its back on purpose.
        let rays = points(object).into_iter().flat_map(|point| rays_to(scene_probe, point));
        let seen = rays.filter_map(|ray| world.closest(&past_hidden_backs(&scene_probe.input, ray), &mut ()));
        if seen.into_iter().any(|hit| world.objects()[hit.object as usize].bounds().is_some()) {
            return None;
        }
        let number = number as u32;
        let is_simple = scene_probe.model_format().is_none() && world.objects().len() <= FEW_OBJECTS;
        let is_empty = scene_probe.hits().next().is_none();
        let severity = if is_simple || is_empty { Severity::Warning } else { Severity::Note };
        let message = format!("the {} shows the camera only its back", scene_probe.object(number));
        let diagnostic = Diagnostic { severity, ..Diagnostic::note(message) }
            .at(scene_probe.object_span(number))
            .effect("the object is invisible, because `backs hidden` hides the backs of its material")
            .help("exchange its edges or two of its vertices, negate its normal, or remove `backs hidden`");
        let diagnostic = match scene_probe.model_format() {
            None => diagnostic,
            Some(format) => diagnostic
                .effect("the object is invisible, because its material is not double-sided and hides the backs")
                .help(match format.name {
                    "glTF" => "reverse the order of the vertices of its triangles, or set `doubleSided` to true",
                    _ => "reverse the order of the vertices of its triangles, or give it a double-sided material",
                }),
        };
        Some(Finding::from(diagnostic).affecting_whole_picture(is_empty))
    };
    turned.filter_map(say).take(MAX_FINDINGS).collect()
}

/// Returns true if a plane separates an object from the camera.
fn separated_by_plane(scene_probe: &SceneProbe, plane: u32, object: u32) -> bool {
    let Some((n, d)) = super::hidden::world_plane(scene_probe, plane) else { return false };
    let eye = scene_probe.world().camera().pose().center.dot(n) - d;
    let bounds = scene_probe.world().objects()[object as usize].bounds().filter(|bounds| !bounds.is_empty());
    bounds.is_some_and(|bounds| bounds.corners().iter().all(|corner| (corner.dot(n) - d) * eye < 0.0))
}

/// Returns the span and the text of the negative scale that mirrors an object.
fn negative_scale(scene_probe: &SceneProbe, number: u32) -> Option<(Span, String)> {
    let object = &scene_probe.world().objects()[number as usize];
    object.to_world.as_ref().filter(|to_world| {
        to_world.vector(Vec3::X).cross(to_world.vector(Vec3::Y)).dot(to_world.vector(Vec3::Z)) < 0.0
    })?;
    let mut all: Vec<(&durer_scene::scene::Object, Option<Span>)> =
        scene_probe.input.scene.root.iter().flat_map(|root| &root.objects).map(|object| (object, None)).collect();
    while let Some((inner, around)) = all.pop() {
        if inner.span.start == object.span.start && inner.span.file == object.span.file {
            let value = scene_probe.field_span(around?, &["UniformScale", "Scale", "scale"])?;
            return Some((value, scene_probe.text(value)));
        }
        match &inner.node {
            ObjectKind::Group(group) => all.extend(group.objects.iter().map(|object| (object, around))),
            ObjectKind::Transform(_, within) => all.push((within, Some(inner.span))),
            _ => {}
        }
    }
    None
}

/// Maximum number of triangles of a mesh that is searched for open edges.
const MAX_TRIANGLES: usize = 20_000;

/// Returns true if the centre of one object is inside another.
fn contains_center(scene_probe: &SceneProbe, outer: u32, inner: u32) -> bool {
    let objects = scene_probe.world().objects();
    // An open mesh contains nothing.
    if matches!(&objects[outer as usize].geometry, Geometry::Mesh(tree) if tree.mesh.len() <= MAX_TRIANGLES && !tree.is_closed())
    {
        return false;
    }
    let middle = objects[inner as usize].bounds().map(|bounds| bounds.center());
    middle.is_some_and(|middle| super::containment::containing_objects(scene_probe.world(), middle).contains(&outer))
}

/// Reports objects that are smaller than a pixel.
pub(super) fn tiny(scene_probe: &SceneProbe) -> Vec<Finding> {
    let objects = scene_probe.world().objects();
    let small = |(index, object): (usize, &Object)| {
        let bounds = object.bounds().filter(|bounds| !bounds.is_empty())?;
        // A mesh with many triangles is not meant to be a dot.
        let least = if matches!(&object.geometry, Geometry::Mesh(tree) if tree.mesh.len() > 50) { 6.0 } else { 2.5 };
        let size = pixels(scene_probe, bounds).filter(|size| *size < least)?;
        let looked = super::visibility::rays_to(scene_probe, bounds.center());
        (!looked.is_empty() && scene_probe.visibilities()[index] != Visibility::Outside).then_some((
            index as u32,
            size,
            bounds,
        ))
    };
    let all: Vec<_> = objects.iter().enumerate().take(MAX_FINDINGS).filter_map(small).collect();
    // A swarm of tiny objects is probably intentional, and `too-small` reports a scene that is tiny
    // as a whole.
    let bounded = objects.iter().filter(|object| object.bounds().is_some()).count();
    if objects.len() > FEW_OBJECTS || all.len() == bounded || scene_probe.hits().next().is_none() {
        return Vec::new();
    }
    let say = |(index, size, bounds): (u32, f32, Aabb)| {
        let diagnostic =
            Diagnostic::warning(format!("the {} is {} pixels wide", scene_probe.object(index), number(size)))
                .at(scene_probe.object_span(index))
                .effect("the object is invisible, or only a speck")
                .help(format!(
                    "the largest side of the object is {}: check its size and the `{}` that encloses it",
                    number(bounds.size().max_element()),
                    scene_probe.keyword_of_grammar("Scale", "scale")
                ));
        Finding::from(diagnostic)
    };
    all.into_iter().map(say).collect()
}

/// Reports height fields that have the same height everywhere.
pub(super) fn flat_field(scene_probe: &SceneProbe) -> Vec<Finding> {
    let mut findings = Vec::new();
    let mut all: Vec<&durer_scene::scene::Object> =
        scene_probe.input.scene.root.iter().flat_map(|root| &root.objects).collect();
    while let Some(object) = all.pop().filter(|_| findings.len() < MAX_FINDINGS) {
        match &object.node {
            ObjectKind::Group(group) => all.extend(&group.objects),
            ObjectKind::Transform(_, inner) => all.push(inner),
            ObjectKind::Solid(_, parts) => all.extend(parts),
            ObjectKind::HeightField(field) => {
                let size = field.max - field.min;
                let wide = size.x.max(size.z);
                if size.y > 0.002 * wide {
                    findings.extend(uniform_height_map(scene_probe, object, size));
                    continue;
                }
                let max = vector(Vec3::new(field.max.x, field.min.y + 0.2 * wide, field.max.z));
                let diagnostic = Diagnostic::warning(format!(
                    "this height field is {} wide and {} high",
                    number(wide),
                    number(size.y)
                ))
                .effect("the height field looks flat")
                .help(format!("heights range from `min` to `max` along y: try `max {max}`"));
                let diagnostic = diagnostic.fix_at(scene_probe.field_span(object.span, &["max"]), max);
                findings.push(Finding::from(scene_probe.at_value(diagnostic, object.span, &["max"])));
            }
            _ => {}
        }
    }
    findings
}

/// Returns a warning about a landscape whose height map has the same value everywhere.
fn uniform_height_map(scene_probe: &SceneProbe, object: &durer_scene::scene::Object, size: Vec3) -> Option<Finding> {
    let is_it = |own: &&Object| own.span.file == object.span.file && own.span.start == object.span.start;
    let mesh = scene_probe.world().objects().iter().find(is_it).and_then(|own| match &own.geometry {
        Geometry::Mesh(tree) => Some(&tree.mesh),
        Geometry::Primitive(_) | Geometry::Solid(_) => None,
    })?;
    let step = (mesh.len() / 2000).max(1);
    // Ignore the sides and the underside of the landscape.
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
        .help("use an image with different values: dark pixels are low, and bright pixels are high");
    Some(Finding::from(scene_probe.at_value(diagnostic, object.span, &["picture"])))
}

fn is_triangle(scene_probe: &SceneProbe, object: u32) -> bool {
    triangle(&scene_probe.world().objects()[object as usize]).is_some()
}

/// Reports objects that are far from everything visible, for example because a transform moved them
/// away.
fn far_away(scene_probe: &SceneProbe) -> Vec<Finding> {
    let both = || scene_probe.world().objects().iter().zip(scene_probe.visibilities()).enumerate();
    let hit =
        both().filter(|(_, (_, sight))| **sight == Visibility::Visible).filter_map(|(_, (object, _))| object.bounds());
    let core = hit.fold(Aabb::EMPTY, Aabb::union);
    let far = |bounds: Aabb| (bounds.center() - core.center()).length() > 10.0 * core.size().length();
    let out = |sight: &Visibility| matches!(sight, Visibility::Outside | Visibility::Hidden(_));
    let lost = both().find(|(_, (object, sight))| out(sight) && object.bounds().is_some_and(far));
    let Some((index, (object, _))) = lost.filter(|_| !core.is_empty()) else { return Vec::new() };
    let place = object.bounds().map_or_else(String::new, |bounds| vector(bounds.center()));
    let diagnostic = Diagnostic::warning(format!(
        "the {} is far from everything else, at {place}",
        scene_probe.object(index as u32)
    ))
    .at(object.span)
    .effect("the object is invisible")
    .help("check the position of the object and the transforms that enclose it");
    vec![Finding::from(diagnostic)]
}
