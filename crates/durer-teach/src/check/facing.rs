//! Checks orientation: surfaces seen from behind, and triangles whose winding is reversed in the
//! scene file.

use super::finding::{Finding, MAX_FINDINGS, counted};
use super::mesh_files::topology::Topology;
use super::scene_probe::SceneProbe;
use super::shapes::{plane, shape, triangle};
use durer_diag::{Diagnostic, Severity};
use durer_render::world::{Material, Object};
use durer_scene::describe::{DescribedKind as _, Value};
use durer_scene::material::principled::Backs;
use durer_scene::math::{Affine, Vec3};
use durer_scene::shape::{Flip, Shape as _};

/// Describes the edit that makes a flat shape face the opposite way.
pub(super) fn flip_text(flip: Flip) -> String {
    match flip {
        Flip::Corners([a, b]) | Flip::Edges([a, b]) => format!("swap `{a}` and `{b}`"),
        Flip::Negate([normal]) => format!("negate `{normal}`"),
        Flip::Negate(fields) => {
            let [normal, rest] = [&fields[..1], &fields[1..]].map(|fields| fields.join("` and `"));
            format!("negate `{normal}` and `{rest}`")
        }
    }
}

/// Adds the edit that flips a flat shape. Returns `None` if the shape is not flat or if the scene
/// file does not set the field to change.
pub(super) fn flipped(scene_probe: &SceneProbe, diagnostic: &Diagnostic, object: u32) -> Option<Diagnostic> {
    let shape = shape(&scene_probe.world().objects()[object as usize])?;
    let value = |field: &str| scene_probe.field_span(scene_probe.object_span(object), &[field]);
    let mut diagnostic = diagnostic.clone();
    match shape.flip()? {
        Flip::Corners([a, b]) | Flip::Edges([a, b]) => {
            let (a, b) = (value(a)?, value(b)?);
            diagnostic = diagnostic.fix(a, scene_probe.text(b)).fix(b, scene_probe.text(a));
        }
        Flip::Negate(fields) => {
            for &name in fields {
                let text = match shape.get(shape.fields().iter().position(|field| field.name == name)?)? {
                    Value::Vec3(v) => super::finding::vector(-v),
                    Value::Float(x) => super::finding::number(-x),
                    Value::Int(_) | Value::Path(_) | Value::Word(_) | Value::Rows(_) => return None,
                };
                diagnostic = diagnostic.fix(value(name)?, text);
            }
        }
    }
    Some(diagnostic)
}

/// Returns how to flip a flat shape that the course's programs support.
fn course_flip(object: &Object) -> Option<Flip> {
    shape(object).filter(|shape| !shape.is_durer_only())?.flip()
}

/// Adds the edit that flips a flat shape that the course's programs support.
fn with_flip(scene_probe: &SceneProbe, diagnostic: Diagnostic, object: u32) -> Diagnostic {
    match course_flip(&scene_probe.world().objects()[object as usize]) {
        Some(flip) => match flipped(scene_probe, &diagnostic, object) {
            Some(flipped) => flipped.help(flip_text(flip)),
            None => diagnostic,
        },
        None => diagnostic,
    }
}

/// Reports objects that are seen only from behind. This is a warning if back faces are not shaded.
/// Otherwise, it is a note for flat shapes, whose front was probably meant to be visible.
pub(super) fn from_behind(scene_probe: &SceneProbe) -> Vec<Finding> {
    if scene_probe.is_physical() {
        return black_backs(scene_probe);
    }
    let shaded = scene_probe.input.job.settings.shade_back;
    let is_flat = |i: usize| course_flip(&scene_probe.world().objects()[i]).is_some();
    let count = scene_probe.world().objects().len();
    let (mut seen, mut backs, mut black) = (vec![0; count], vec![0; count], false);
    for (_, surface) in scene_probe.hits() {
        seen[surface.object as usize] += 1;
        backs[surface.object as usize] += usize::from(surface.from_behind);
        black |= surface.unshaded_back;
    }
    let all: usize = seen.iter().sum();
    // If `hidden-behind` reports something, this finding is skipped because the cause is the same.
    if !super::hidden::hidden(scene_probe).is_empty() {
        return Vec::new();
    }
    let turned_away = (0..count).filter(|&i| {
        seen[i] > 0
            && backs[i] == seen[i]
            && (!shaded || is_flat(i))
            && !super::mesh::is_inside_out_object(scene_probe, i as u32)
    });
    let turned_away: Vec<usize> = turned_away.collect();
    let whole = turned_away.iter().map(|&i| backs[i]).sum::<usize>() * 10 > all * 9;
    let say = |i: usize| {
        let message = format!("the {} is visible from behind", scene_probe.object(i as u32));
        if shaded {
            let note = Diagnostic::note(message).at(scene_probe.object_span(i as u32)).effect(
                "a ray tracer that does not shade back faces, such as the course's without `-shade_back`, \
                 leaves the object black",
            );
            // If the normal and offset of a plane are negated, the plane stays the same. It also
            // looks the same if back faces are shaded.
            return Finding::from(if plane(&scene_probe.world().objects()[i]).is_some() {
                note
            } else {
                with_flip(scene_probe, note, i as u32)
            });
        }
        let diagnostic = Diagnostic::warning(message)
            .at(scene_probe.object_span(i as u32))
            .effect(if black {
                "the back of the object stays black"
            } else {
                "the normal points away, so the visible side gets no light"
            })
            .help("set `--shade-back` (in the course's programs `-shade_back`)");
        Finding::from(with_flip(scene_probe, diagnostic, i as u32)).affecting_whole_picture(whole)
    };
    turned_away.into_iter().take(MAX_FINDINGS).map(say).collect()
}

/// Reports objects that paths show only from behind, if their material is black there.
fn black_backs(scene_probe: &SceneProbe) -> Vec<Finding> {
    let world = scene_probe.world();
    let is_one_sided = |object: &Object| match world.materials().get(object.material as usize) {
        Some(Material::Phong(phong)) => {
            let own = phong.principled.as_ref().map(|principled| &principled.definition);
            phong.emission.is_none() && own.is_some_and(|m| m.backs == Backs::Black && m.transmission_weight == 0.0)
        }
        _ => false,
    };
    let mut counts = vec![(0_usize, 0_usize); world.objects().len()];
    for (_, hit) in scene_probe.hits() {
        let (seen, backs) = &mut counts[hit.object as usize];
        (*seen, *backs) = (*seen + 1, *backs + usize::from(hit.from_behind));
    }
    let all = scene_probe.hits().count();
    let turned = world.objects().iter().zip(counts).enumerate();
    let turned = turned.filter(|(_, (object, (seen, backs)))| *backs > 4 && backs == seen && is_one_sided(object));
    let say = |(number, (_, (_, backs))): (usize, (&Object, (usize, usize)))| {
        let number = number as u32;
        let diagnostic = Diagnostic::warning(format!("the {} is visible from behind", scene_probe.object(number)))
            .at(scene_probe.object_span(number))
            .effect("the material of the object reflects light only on its front, so the visible side is black")
            .help("turn the object over, or give the object a two-sided material");
        Finding::from(diagnostic).affecting_whole_picture(backs * 2 > all)
    };
    turned.take(MAX_FINDINGS).map(say).collect()
}

/// Reports connected triangles in the scene file whose winding is opposite to that of most others.
pub(super) fn turned_triangles(scene_probe: &SceneProbe) -> Vec<Finding> {
    let mut soups: Vec<(Option<Affine>, Vec<u32>)> = Vec::new();
    for (i, object) in scene_probe.world().objects().iter().enumerate() {
        if triangle(object).is_some() {
            match soups.iter_mut().rev().take(8).find(|soup| soup.0 == object.to_world) {
                Some(soup) => soup.1.push(i as u32),
                None => soups.push((object.to_world, vec![i as u32])),
            }
        }
    }
    soups.iter().filter(|soup| soup.1.len() > 3).flat_map(|soup| turned_of(scene_probe, &soup.1)).collect()
}

fn turned_of(scene_probe: &SceneProbe, soup: &[u32]) -> Vec<Finding> {
    let corners = |&i: &u32| triangle(&scene_probe.world().objects()[i as usize]).unwrap_or([Vec3::ZERO; 3]);
    let positions: Vec<Vec3> = soup.iter().flat_map(corners).collect();
    let triangles: Vec<[u32; 3]> = (0..soup.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let topology = Topology::of(&positions, &triangles);
    let inside_out = topology.is_closed() && topology.reversed.is_empty() && topology.volume < 0.0;
    if inside_out {
        let diagnostic = Diagnostic::warning(format!(
            "{} of a closed surface face inwards",
            counted(soup.len(), "triangle", "triangles")
        ))
        .at(scene_probe.object_span(soup[0]))
        .label("the first of them")
        .effect("a ray tracer that does not flip normals shades these triangles as back faces, in black");
        let diagnostic = soup.iter().fold(diagnostic, |diagnostic, &i| with_flip(scene_probe, diagnostic, i));
        return vec![Finding::from(
            diagnostic.help("order the vertices of the triangles counter-clockwise, as seen from outside"),
        )];
    }
    let Some(&first) = topology.reversed.first() else { return Vec::new() };
    let count = topology.reversed.len();
    let mut diagnostic = Diagnostic::warning(match count {
        1 => "this triangle faces the opposite way from its neighbours".to_string(),
        n => format!("{n} triangles face the opposite way from their neighbours"),
    })
    .at(scene_probe.object_span(soup[first as usize]))
    .effect(
        "triangles whose normals point inwards are black or wrongly lit in a ray tracer that does not flip normals",
    );
    if count > 1 {
        diagnostic = diagnostic.label("the first of them");
    }
    for &i in &topology.reversed {
        diagnostic = with_flip(scene_probe, diagnostic, soup[i as usize]);
    }
    if !topology.is_closed() && count * 3 > soup.len() {
        // Sheets that only touch do not share an edge, so this is only a note.
        diagnostic.severity = Severity::Note;
    }
    vec![Finding::from(diagnostic)]
}
