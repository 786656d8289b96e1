//! Reads a Wavefront file as a scene that has one mesh for each material in the file.

use super::faces::rest_of;
use super::materials::{self, Library};
use super::wires::{LinesAndPoints, WireReader};
use super::words::Words;
use super::{StateChange, StateChanges, Statement, read_with, statement};
use crate::model::{ReadInput, SceneFormat};
use crate::report::{Report, quoted};
use crate::smooth::smoothed;
use crate::{sticks, too_large};
use durer_diag::{Diagnostic, Diagnostics, Span, did_you_mean};
use durer_scene::math::Aabb;
use durer_scene::scene::{Group, Material, Object, Scene, Spanned};
use durer_scene::shape::MeshData;
use durer_scene::shape::mesh::NO_INDEX;
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

/// Entry for Wavefront files in the list of scene formats.
pub(crate) const FORMAT: SceneFormat = SceneFormat {
    name: super::FORMAT.name,
    extensions: super::FORMAT.extensions,
    // The first word of a file is not distinctive, so the format is recognised only by its
    // extension.
    recognise: |_| false,
    read,
    write: None,
    up: super::FORMAT.up,
    is_complete_scene: false,
    light_hint: None,
};

/// Reads a Wavefront file; see [`read_model`](crate::scene::read_model).
fn read(input: &ReadInput, diagnostics: &mut Diagnostics) -> Option<Scene> {
    if let Some(error) = too_large(input.bytes.len() as u64, input.name) {
        diagnostics.push(error);
        return None;
    }
    let mut switches = StateChanges::default();
    let mut data = read_with(input.bytes, input.file, &mut switches, diagnostics)?;
    smooth(&mut data, &switches.groups);
    let span = |at: &Range<usize>| Span { file: input.file, start: at.start as u32, end: at.end as u32 };
    let mut library = Library::default();
    let mut report = Report::new(input.file, diagnostics);
    let mut wires = WireReader::new(input.bytes, data.positions.len());
    let mut words = Words::new(input.bytes);
    while let Some(keyword) = words.next_statement() {
        match statement(&input.bytes[keyword.clone()]) {
            Some(Statement::Library) => {
                let names = rest_of(&mut words, keyword.end);
                materials::read_files(input, &names, span(&names), &mut library, diagnostics);
            }
            Some(Statement::Position) => wires.vertices[1] += 1,
            Some(Statement::Material) => wires.material = rest_of(&mut words, keyword.end),
            Some(kind @ (Statement::Line | Statement::Point)) => wires.read(kind, &mut words, &mut report),
            _ => {}
        }
        words.skip();
    }
    wires.groups.retain(|wires| !wires.lines.is_empty() || !wires.points.is_empty());
    let alone = data.triangles.is_empty() && wires.groups.is_empty() && !data.positions.is_empty();
    if alone && !report.has_errors() {
        // A file that contains only vertices is a point cloud.
        let points = (0..data.positions.len() as u32).collect();
        wires.groups.push(LinesAndPoints { points, ..LinesAndPoints::default() });
    }
    if let [first, ..] = wires.groups.as_slice() {
        let lines = wires.groups.iter().map(|wires| wires.lines.len()).sum();
        let points = wires.groups.iter().map(|wires| wires.points.len()).sum();
        report.note(first.material.clone(), sticks::message(lines, points)).code = "points-and-lines";
    }
    let wires = wires.groups;
    report.finish(diagnostics, ())?;
    let size = Aabb::around(data.positions.iter().copied()).size().length();
    let all = library.materials.values_mut().map(|(material, _)| material);
    for material in all.filter(|material| material.bump_texture.is_some()) {
        material.bump_height *= size;
    }
    let mut scene = Scene::default();
    scene.assets.pictures = std::mem::take(&mut library.pictures);
    let mut objects = Vec::new();
    let mut numbers: BTreeMap<&str, u32> = BTreeMap::new();
    let mut shown_parts =
        if data.triangles.is_empty() { Vec::new() } else { parts(&data, input.bytes, &switches.materials) };
    let vertices = MeshData { positions: data.positions, colors: data.colors, ..MeshData::default() };
    let thick =
        |wires: LinesAndPoints| (sticks::sticks_and_balls(&vertices, &wires.lines, &wires.points), wires.material);
    shown_parts.extend(wires.into_iter().map(thick));
    for (part, at) in shown_parts {
        let name = String::from_utf8_lossy(&input.bytes[at.clone()]).into_owned();
        let material = library.materials.get_key_value(name.as_str()).map(|(name, (material, at))| {
            *numbers.entry(name).or_insert_with(|| {
                let value = Material::Principled(Box::new(material.clone()));
                scene.materials.push(Spanned { value, span: *at });
                scene.materials.len() as u32 - 1
            })
        });
        if material.is_none() && !name.is_empty() {
            let known = library.materials.keys().map(String::as_str);
            let suggestion = did_you_mean(&name, known).map(|suggestion| format!("did you mean `{suggestion}`?"));
            let message = format!(
                "no material file defines the material {}: a neutral material is used",
                quoted(name.as_bytes())
            );
            diagnostics.push(Diagnostic {
                help: suggestion,
                ..Diagnostic::warning(message).code("no-material").at(span(&at))
            });
        }
        let asset = if name.is_empty() { input.name.to_string() } else { format!("{}#{name}", input.name) };
        let node = scene.add_mesh(&asset, Arc::new(part), span(&at));
        objects.push(Object { node, material, span: span(&at) });
    }
    scene.root = Some(Group { objects });
    Some(scene)
}

/// Pairs each state change with the range of triangles that it applies to; the last range ends at
/// `count`.
fn runs<T>(switches: &[StateChange<T>], count: usize) -> impl Iterator<Item = (Range<usize>, &T)> {
    let ends = switches.iter().skip(1).map(|switch| switch.0).chain([count]);
    switches.iter().zip(ends).map(|((start, what), end)| (*start..end, what))
}

/// Computes normals for the triangles in smoothing groups that have no normals in the file.
fn smooth(data: &mut MeshData, switches: &[StateChange<u32>]) {
    if switches.iter().all(|&(_, group)| group == 0) {
        return;
    }
    let mut groups = vec![0; data.triangles.len()];
    runs(switches, groups.len()).for_each(|(run, &group)| groups[run].fill(group));
    smoothed(data, |triangle, _| (groups[triangle] > 0).then(|| groups[triangle]));
}

/// Splits a mesh by the names of its materials, in the order in which they are first used. Each
/// part comes with a byte range where the name of its material occurs.
fn parts(data: &MeshData, bytes: &[u8], switches: &[StateChange<Range<usize>>]) -> Vec<(MeshData, Range<usize>)> {
    let runs = runs(switches, data.triangles.len()).map(|(run, at)| (run, at.clone()));
    let before = 0..switches.first().map_or(data.triangles.len(), |switch| switch.0);
    let mut order: Vec<(Vec<Range<usize>>, Range<usize>)> = Vec::new();
    let mut known: BTreeMap<&[u8], usize> = BTreeMap::new();
    for (run, at) in [(before, 0..0)].into_iter().chain(runs).filter(|(run, _)| !run.is_empty()) {
        let number = *known.entry(&bytes[at.clone()]).or_insert_with(|| {
            order.push((Vec::new(), at));
            order.len() - 1
        });
        order[number].0.push(run);
    }
    match order.as_slice() {
        // There is only one material, so nothing needs to be split.
        [] => vec![(data.clone(), 0..0)],
        [(_, at)] => vec![(data.clone(), at.clone())],
        _ => order.into_iter().map(|(runs, at)| (part(data, &runs), at)).collect(),
    }
}

/// Copies some of the triangles, together with the vertices that they use.
fn part(data: &MeshData, runs: &[Range<usize>]) -> MeshData {
    let mut part = MeshData::default();
    let pick = |list: &[[u32; 3]]| -> Vec<[u32; 3]> {
        if list.is_empty() {
            Vec::new()
        } else {
            runs.iter().flat_map(|run| list[run.clone()].iter().copied()).collect()
        }
    };
    (part.triangles, part.triangle_uvs) = (pick(&data.triangles), pick(&data.triangle_uvs));
    part.triangle_normals = pick(&data.triangle_normals);
    let places = renumber(&mut part.triangles);
    part.positions = places.iter().map(|&i| data.positions[i as usize]).collect();
    if !data.colors.is_empty() {
        part.colors = places.iter().map(|&i| data.colors[i as usize]).collect();
    }
    part.uvs = renumber(&mut part.triangle_uvs).iter().map(|&i| data.uvs[i as usize]).collect();
    part.normals = renumber(&mut part.triangle_normals).iter().map(|&i| data.normals[i as usize]).collect();
    for list in [&mut part.triangle_uvs, &mut part.triangle_normals] {
        if list.iter().flatten().all(|&i| i == NO_INDEX) {
            list.clear();
        }
    }
    part
}

/// Renumbers the indices in use, starting from 0, and returns the old index for each new one.
fn renumber(list: &mut [[u32; 3]]) -> Vec<u32> {
    let mut used: Vec<u32> = list.iter().flatten().copied().filter(|&i| i != NO_INDEX).collect();
    used.sort_unstable();
    used.dedup();
    for i in list.iter_mut().flatten().filter(|i| **i != NO_INDEX) {
        *i = used.partition_point(|&old| old < *i) as u32;
    }
    used
}
