//! Checks for objects that are degenerate, squashed or duplicated.

use super::faces::overlapping;
use super::finding::{Finding, MAX_FINDINGS, number, vector};
use super::lines::is_same_span;
use super::scene_probe::SceneProbe;
use super::shapes::{plane, shape, triangle};
use super::visibility::Visibility;
use durer_diag::{Diagnostic, Span};
use durer_render::world::{Geometry, Object};
use durer_scene::math::{Ray, Vec3};
use durer_scene::scene::{CsgOperation, MatrixOp, Object as Written, ObjectKind};
use durer_scene::shape::{Plane, Shape};
use std::collections::HashMap;
use std::sync::Arc;

/// A box is squashed if its smallest side is less than this fraction of its other sides.
const SQUASHED_RATIO: f32 = 1e-4;

/// Reports triangles of the scene file that have zero area.
pub(super) fn degenerate(scene_probe: &SceneProbe) -> Vec<Finding> {
    let flat = |object: &&Object| {
        triangle(object).is_some_and(|corners| {
            let [a, b, c] = corners.map(|corner| corner.as_dvec3());
            (b - a).cross(c - a).length() <= 1e-9 * (b - a).length_squared().max((c - a).length_squared())
        })
    };
    let say = |object: &Object| {
        let diagnostic = Diagnostic::warning("this triangle has no area: its vertices are on one line")
            .at(object.span)
            .effect("the triangle is invisible")
            .help(match equal_vertices(object) {
                Some([a, b]) => format!("`vertex{a}` and `vertex{b}` are equal: change one of them"),
                None => "move one of the vertices away from the line".into(),
            });
        Finding::from(diagnostic).affecting_whole_picture(scene_probe.world().objects().len() == 1)
    };
    scene_probe.world().objects().iter().filter(flat).map(say).collect()
}

/// Returns the numbers of two equal vertices of a triangle.
fn equal_vertices(object: &Object) -> Option<[usize; 2]> {
    let corners = triangle(object)?;
    [[0, 1], [1, 2], [0, 2]].into_iter().find(|&[a, b]| corners[a] == corners[b])
}

/// Returns the solids that a few hundred test rays all miss.
pub(super) fn empty_solids(scene_probe: &SceneProbe) -> Vec<u32> {
    let world = scene_probe.world();
    let empty = |&(i, object): &(usize, &Object)| {
        let Geometry::Solid(_) = &object.geometry else { return false };
        let Some(bounds) = object.bounds().filter(|_| scene_probe.visibilities()[i] != Visibility::Visible) else {
            return false;
        };
        let size = bounds.size();
        let met = |axis: usize, a: u32, b: u32| {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let (mut origin, mut dir) = (bounds.min, Vec3::ZERO);
            origin[axis] -= size.max_element();
            origin[u] += size[u] * (a as f32 + 0.5) / 12.0;
            origin[v] += size[v] * (b as f32 + 0.5) / 12.0;
            dir[axis] = 1.0;
            world.hits_of_each(&Ray::new(origin, dir)).any(|hit| hit.object as usize == i)
        };
        !(0..3).any(|axis| (0..144).any(|cell| met(axis, cell % 12, cell / 12)))
    };
    let few = world.objects().len() <= 100;
    world.objects().iter().enumerate().filter(|_| few).filter(empty).map(|(i, _)| i as u32).take(MAX_FINDINGS).collect()
}

/// Returns the objects that have no surface. These are empty solids, and triangles and meshes with
/// zero area.
pub(super) fn without_surface(scene_probe: &SceneProbe) -> Vec<u32> {
    let mut nothing = empty_solids(scene_probe);
    let flat = |[a, b, c]: [Vec3; 3]| (b - a).cross(c - a).length_squared() == 0.0;
    let without = scene_probe.world().objects().iter().enumerate().filter(|(i, object)| {
        scene_probe.visibilities()[*i] != Visibility::Visible
            && match &object.geometry {
                Geometry::Primitive(_) => triangle(object).is_some_and(flat),
                Geometry::Mesh(tree) => (0..tree.mesh.len().min(1000)).all(|i| flat(tree.mesh.corners(i as u32))),
                Geometry::Solid(_) => false,
            }
    });
    nothing.extend(without.map(|(i, _)| i as u32));
    nothing.extend(super::quadrics::without_points(scene_probe));
    nothing
}

/// Reports empty solids.
pub(super) fn empty_solid(scene_probe: &SceneProbe) -> Vec<Finding> {
    let say = |object: u32| {
        let diagnostic = Diagnostic::warning(format!("the {} is empty", scene_probe.object(object)))
            .at(scene_probe.object_span(object))
            .effect("the solid is invisible")
            .help(match operation(scene_probe, object) {
                Some(CsgOperation::Difference) => "check for a subtracted part that covers the first part",
                Some(CsgOperation::Intersection) => "move the parts until all of them overlap",
                Some(CsgOperation::Xor) => {
                    "move a part: only points inside an odd number of parts remain, so equal parts leave nothing"
                }
                Some(CsgOperation::Union | CsgOperation::Merge) => {
                    "check the parts of the solid: each of them is empty"
                }
                None => "check for a subtracted part that covers the first part, and for parts that do not overlap",
            });
        Finding::from(diagnostic).affecting_whole_picture(scene_probe.hits().next().is_none())
    };
    empty_solids(scene_probe).into_iter().map(say).chain(empty_grids(scene_probe)).collect()
}

/// Returns the operation of a solid.
fn operation(scene_probe: &SceneProbe, object: u32) -> Option<CsgOperation> {
    let span = scene_probe.object_span(object);
    let own = scene_probe.input.scene.objects().find(|own| is_same_span(own.span, span))?;
    if let ObjectKind::Solid(operation, _) = &own.node { Some(*operation) } else { None }
}

/// Reports grids whose spheres fill no cell.
fn empty_grids(scene_probe: &SceneProbe) -> Vec<Finding> {
    let world = scene_probe.world();
    let mut findings = Vec::new();
    for object in scene_probe.input.scene.objects() {
        let ObjectKind::Voxels(grid, balls) = &object.node else { continue };
        let is_it = |own: &&Object| own.span.file == object.span.file && own.span.start == object.span.start;
        let filled = |own: &Object| match &own.geometry {
            Geometry::Mesh(tree) => !tree.mesh.is_empty(),
            Geometry::Primitive(_) | Geometry::Solid(_) => true,
        };
        if balls.is_empty() || world.objects().iter().find(is_it).is_some_and(filled) {
            continue;
        }
        let diagnostic = Diagnostic::warning("no cell of this `Grid` is filled")
            .at(object.span)
            .effect("the grid is invisible")
            .help(format!(
                "move a `rasterizeSphere` into the box from {} to {}, or make the sphere larger: a sphere fills the \
                 cells whose centers are inside the sphere",
                vector(grid.min),
                vector(grid.max)
            ));
        findings.push(Finding::from(diagnostic).affecting_whole_picture(scene_probe.hits().next().is_none()));
        if findings.len() == MAX_FINDINGS {
            break;
        }
    }
    findings
}

/// Reports objects that a transform makes flat or nearly flat.
pub(super) fn squashed(scene_probe: &SceneProbe) -> Vec<Finding> {
    let mut findings = Vec::new();
    for object in scene_probe.world().objects() {
        let (Some(to_world), Some(bounds)) = (&object.to_world, object.bounds()) else { continue };
        let stretched = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| to_world.vector(axis).length());
        let (least, most) =
            (stretched.iter().copied().fold(f32::MAX, f32::min), stretched.iter().copied().fold(0.0, f32::max));
        let thin = least < SQUASHED_RATIO * most && !bounds.is_empty();
        if !thin && most > 1e-6 {
            continue;
        }
        let what =
            if thin { format!("{} times thinner than wide", number(most / least)) } else { "almost a point".into() };
        let diagnostic = Diagnostic::warning(format!("the transforms that enclose this object make it {what}"))
            .at(object.span)
            .effect("the object looks like a line, or is invisible")
            .help("check the `Scale` and `UniformScale` that enclose the object");
        findings.push(Finding::from(diagnostic));
    }
    findings.extend(
        scene_probe
            .input
            .scene
            .root
            .iter()
            .flat_map(|root| &root.objects)
            .flat_map(|object| squashed_parts(object, false)),
    );
    findings
}

/// Reports parts of solids that are almost flat because of their own scale.
fn squashed_parts(object: &Written, within: bool) -> Vec<Finding> {
    let least = |op: &MatrixOp| match op {
        MatrixOp::UniformScale(s) => s.abs(),
        MatrixOp::Scale(v) => v.abs().min_element(),
        _ => 1.0,
    };
    match &object.node {
        ObjectKind::Group(group) => group.objects.iter().flat_map(|inner| squashed_parts(inner, within)).collect(),
        ObjectKind::Solid(_, parts) => parts.iter().flat_map(|part| squashed_parts(part, true)).collect(),
        ObjectKind::Transform(ops, inner) => {
            let mut findings = squashed_parts(inner, within);
            if within && ops.iter().map(least).product::<f32>() < SQUASHED_RATIO {
                let diagnostic = Diagnostic::warning("a scale makes this part of a solid almost disappear")
                    .at(object.span)
                    .effect("the solid is invisible, or the part has no effect")
                    .help("check the `Scale` and `UniformScale` in the part");
                findings.push(Finding::from(diagnostic));
            }
            findings
        }
        _ => Vec::new(),
    }
}

/// Returns true if two objects have the same surface.
pub(super) fn same(a: &Object, b: &Object) -> bool {
    if a.to_world != b.to_world {
        return false;
    }
    if let (Some(p), Some(q)) = (plane(a), plane(b)) {
        let unit = |plane: &Plane| {
            let length = plane.normal.length();
            (plane.normal / length, plane.offset / length)
        };
        let ((n, d), (m, e)) = (unit(p), unit(q));
        let near = |m: Vec3, e: f32| (n - m).length() < 1e-6 && (d - e).abs() <= 1e-6 * (1.0 + d.abs());
        return near(m, e) || near(-m, -e);
    }
    match (&a.geometry, &b.geometry) {
        (Geometry::Primitive(p), Geometry::Primitive(q)) => p == q,
        (Geometry::Mesh(p), Geometry::Mesh(q)) => Arc::ptr_eq(p, q),
        (Geometry::Primitive(_) | Geometry::Mesh(_) | Geometry::Solid(_), _) => false,
    }
}

/// Reports objects that coincide with another object.
pub(super) fn duplicates(scene_probe: &SceneProbe) -> Vec<Finding> {
    let objects = scene_probe.world().objects();
    let mut places: HashMap<[u32; 6], Vec<usize>> = HashMap::new();
    let mut findings = Vec::new();
    findings.extend(in_plane(scene_probe));
    // Identical surfaces are reported below. If the materials are equal, it does not matter which
    // face is visible.
    let differ =
        |&(a, b): &(usize, usize)| objects[a].material != objects[b].material && !same(&objects[a], &objects[b]);
    let faces = overlapping(scene_probe).into_iter().filter(differ).take(MAX_FINDINGS);
    findings.extend(faces.map(|(a, b)| coincidence(scene_probe, a, b)));
    for (i, object) in objects.iter().enumerate() {
        // All unbounded objects have the same key.
        let key = object.bounds().map_or([0; 6], |b| {
            let [x, y, z] = b.min.to_array().map(f32::to_bits);
            let [u, v, w] = b.max.to_array().map(f32::to_bits);
            [x, y, z, u, v, w]
        });
        let there = places.entry(key).or_default();
        // Compare with only the first 16, which is cheap even if many objects are at the same
        // place.
        if findings.len() >= MAX_FINDINGS {
            break;
        }
        if let Some(&first) = there.iter().take(16).find(|&&first| same(&objects[first], object)) {
            findings.push(coincidence(scene_probe, first, i));
        }
        there.push(i);
    }
    // All parts of two uses of one definition coincide.
    let mut messages: Vec<String> = Vec::new();
    findings.retain(|finding| {
        let message = &finding.diagnostic.message;
        let is_new = !messages.contains(message);
        messages.push(message.clone());
        is_new
    });
    findings
}

/// Reports flat objects that lie in a plane, where rounding determines which of the two is visible.
fn in_plane(scene_probe: &SceneProbe) -> Vec<Finding> {
    let objects = scene_probe.world().objects();
    let planes: Vec<(usize, &Plane)> = objects
        .iter()
        .enumerate()
        .filter(|(_, object)| object.to_world.is_none())
        .filter_map(|(i, object)| Some((i, plane(object)?)))
        .collect();
    let mut findings = Vec::new();
    for (i, object) in objects.iter().enumerate() {
        let polygons = shape(object).map_or(Vec::new(), Shape::polygons);
        let [corners] = &polygons[..] else { continue };
        let corners: Vec<Vec3> = corners.iter().map(|p| object.world_point(*p)).collect();
        let lies_in = |plane: &Plane| {
            let off = |p: Vec3| (p.dot(plane.normal) - plane.offset).abs() / plane.normal.length();
            corners.iter().all(|&p| off(p) <= 1e-5 * (1e-3 + p.abs().max_element()))
        };
        if findings.len() >= MAX_FINDINGS {
            break;
        }
        if let Some((plane, _)) = planes.iter().take(MAX_FINDINGS).find(|(_, plane)| lies_in(plane)) {
            findings.push(coincidence(scene_probe, *plane, i));
        }
    }
    findings
}

fn coincidence(scene_probe: &SceneProbe, first: usize, second: usize) -> Finding {
    let objects = scene_probe.world().objects();
    let [a, b]: [Span; 2] = [objects[first].span, objects[second].span];
    if let Some(diagnostic) = super::uses::at_the_same_place(scene_probe, first, second).filter(|_| is_same_span(a, b))
    {
        return Finding::from(diagnostic);
    }
    let alike = objects[first].material == objects[second].material;
    let diagnostic = Diagnostic::warning(format!(
        "the {} coincides with the {}",
        scene_probe.object(second as u32),
        scene_probe.object(first as u32)
    ))
    .at(b)
    .related(a, "the same surface")
    .effect(match alike {
        true => "the object contributes nothing; if it is glass, refraction through it is wrong",
        false => {
            "rounding decides which of the two surfaces is visible: there are specks, or only one material \
                  appears"
        }
    })
    .help("remove or move one of the two objects");
    Finding::from(diagnostic)
}
