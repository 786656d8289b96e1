//! Meshes: in the text, or in files of PLY.

use super::params::Params;
use crate::model::Input;
use crate::read_mesh;
use crate::said::Said;
use durer_diag::{Diagnostic, Diagnostics, Span};
use durer_scene::math::{Vec2, Vec3, fp};
use durer_scene::shape::MeshData;
use durer_scene::shape::mesh::NO_INDEX;
use std::sync::Arc;

/// Sides of a cylinder, and of a patch that is not flat.
const SIDES: u32 = 128;
const PATCH: u32 = 8;

/// Makes all triangles face the side of their normals, or without such the side to which they go
/// round; the other side where the surface is reversed.
pub(crate) fn oriented(mut data: MeshData, reversed: bool) -> MeshData {
    if reversed {
        data.normals.iter_mut().for_each(|n| *n = -*n);
    }
    for i in 0..data.triangles.len() {
        let [a, b, c] = data.triangles[i].map(|i| data.positions[i as usize].as_dvec3());
        let face = (b - a).cross(c - a);
        let normals = data.triangle_normals.get(i).filter(|normals| !normals.contains(&NO_INDEX));
        let turned = match normals {
            Some(normals) => {
                normals.map(|n| data.normals[n as usize].as_dvec3()).iter().map(|n| face.dot(*n)).sum::<f64>() < 0.0
            }
            None => reversed,
        };
        if turned {
            let lists = [&mut data.triangles, &mut data.triangle_uvs, &mut data.triangle_normals];
            lists.into_iter().filter_map(|list| list.get_mut(i)).for_each(|corners| corners.swap(1, 2));
        }
    }
    data.flat = true;
    data
}

/// What the corners of a mesh in the text have, and lists of them by `size`.
struct Written {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    uvs: Vec<Vec2>,
    faces: Vec<Vec<u32>>,
}

/// Reads corners and faces of so many corners; `usual` are the corners of a mesh of one face.
fn written(params: &Params, size: usize, usual: &[u32]) -> Option<Written> {
    let said = params.said;
    let Some(positions) = params.triples("P") else {
        said.bad(params.at, "a mesh needs points, `\"point3 P\"`");
        return None;
    };
    let count = positions.len();
    let mut sound = true;
    let mut check = |name: &'static str, found: usize| {
        if found != count {
            said.bad(params.place(name), format!("`{name}` has {found} values for {count} points"));
            sound = false;
        }
    };
    let normals = params.triples("N").unwrap_or_default();
    let uvs = params.pairs("uv").or_else(|| params.pairs("st")).unwrap_or_default();
    if !normals.is_empty() {
        check("N", normals.len());
    }
    if !uvs.is_empty() {
        check("uv", uvs.len());
    }
    params.known(&["S", "faceIndices"]);
    let indices = match params.wholes("indices") {
        Some(indices) => indices,
        None if count == usual.len() => usual.iter().map(|&i| i64::from(i)).collect(),
        None => {
            said.bad(params.at, "a mesh of several faces needs `\"integer indices\"`");
            return None;
        }
    };
    let place = params.get("indices").map_or(params.at, |param| param.values_at);
    if indices.len() % size != 0 {
        said.bad(place, format!("`indices` has {} numbers: a multiple of {size} is needed", indices.len()));
        sound = false;
    }
    if let Some(wrong) = indices.iter().find(|&&i| i < 0 || i >= count as i64) {
        said.bad(place, format!("`indices` has {wrong}, and there are points 0 to {}", count as i64 - 1));
        sound = false;
    }
    let faces = indices.chunks_exact(size).map(|face| face.iter().map(|&i| i as u32).collect()).collect();
    sound.then_some(Written { positions, normals, uvs, faces })
}

/// A `trianglemesh`.
pub(super) fn triangles(params: &Params, reversed: bool) -> Option<MeshData> {
    let Written { positions, normals, uvs, faces } = written(params, 3, &[0, 1, 2])?;
    let triangles: Vec<[u32; 3]> = faces.iter().map(|face| [face[0], face[1], face[2]]).collect();
    let of = |there: bool| if there { triangles.clone() } else { Vec::new() };
    let (triangle_uvs, triangle_normals) = (of(!uvs.is_empty()), of(!normals.is_empty()));
    let data = MeshData { positions, uvs, normals, triangles, triangle_uvs, triangle_normals, ..MeshData::default() };
    Some(oriented(data, reversed))
}

/// A `bilinearmesh`: patches of four corners, (0, 0), (1, 0), (0, 1) and (1, 1). What is not flat
/// becomes a grid.
pub(super) fn bilinear(params: &Params, reversed: bool) -> Option<MeshData> {
    params.left_out(&["emissionfilename"], "the patch shines evenly");
    let Written { positions, normals, uvs, faces } = written(params, 4, &[0, 1, 2, 3])?;
    let mut data = MeshData::default();
    for face in &faces {
        let at = |i: usize| positions[face[i] as usize];
        let edges = [at(1) - at(0), at(2) - at(0), at(3) - at(0)].map(|edge| edge.as_dvec3());
        let volume = edges[0].cross(edges[1]).dot(edges[2]).abs();
        let size = edges.iter().map(|edge| edge.length()).fold(0.0, f64::max);
        let steps = if volume <= 1e-5 * size * size * size { 1 } else { PATCH };
        let base = data.positions.len() as u32;
        let corner = |k: usize| Vec2::new((k % 2) as f32, (k / 2) as f32);
        for (j, i) in (0..=steps).flat_map(|j| (0..=steps).map(move |i| (j, i))) {
            let (u, v) = (i as f32 / steps as f32, j as f32 / steps as f32);
            let weights = [(1.0 - u) * (1.0 - v), u * (1.0 - v), (1.0 - u) * v, u * v];
            let mix = |list: &[Vec3]| (0..4).map(|k| weights[k] * list[face[k] as usize]).sum::<Vec3>();
            data.positions.push(mix(&positions));
            let own = (0..4).map(|k| weights[k] * uvs.get(face[k] as usize).copied().unwrap_or(corner(k)));
            data.uvs.push(own.sum());
            data.normals.push(match normals.is_empty() {
                false => mix(&normals),
                true => {
                    let along = (at(1) - at(0)) * (1.0 - v) + (at(3) - at(2)) * v;
                    let across = (at(2) - at(0)) * (1.0 - u) + (at(3) - at(1)) * u;
                    along.cross(across)
                }
            });
        }
        for (j, i) in (0..steps).flat_map(|j| (0..steps).map(move |i| (j, i))) {
            let p = |di: u32, dj: u32| base + (j + dj) * (steps + 1) + i + di;
            data.triangles.extend([[p(0, 0), p(1, 0), p(1, 1)], [p(0, 0), p(1, 1), p(0, 1)]]);
        }
    }
    (data.triangle_uvs, data.triangle_normals) = (data.triangles.clone(), data.triangles.clone());
    Some(oriented(data, reversed))
}

/// An open tube, as flat strips with the normals of a round one.
pub(super) fn cylinder(params: &Params, reversed: bool) -> Option<MeshData> {
    let radius = params.positive("radius").unwrap_or(1.0);
    let (low, high) = (params.float("zmin").unwrap_or(-1.0), params.float("zmax").unwrap_or(1.0));
    let degrees = params.float("phimax").unwrap_or(360.0).clamp(1e-3, 360.0);
    Some(oriented(tube(radius, [low.min(high), low.max(high)], degrees), reversed))
}

/// A tube about z, or a part of one.
pub(crate) fn tube(radius: f32, [low, high]: [f32; 2], degrees: f32) -> MeshData {
    let mut data = MeshData::default();
    for i in 0..=SIDES {
        let share = i as f32 / SIDES as f32;
        let (sin, cos) = fp::sin_cos_degrees(f64::from(degrees * share));
        let normal = Vec3::new(cos as f32, sin as f32, 0.0);
        for (z, v) in [(low, 0.0), (high, 1.0)] {
            data.positions.push(radius * normal + z * Vec3::Z);
            data.normals.push(normal);
            data.uvs.push(Vec2::new(share, v));
        }
        if i < SIDES {
            let p = 2 * i;
            data.triangles.extend([[p, p + 2, p + 3], [p, p + 3, p + 1]]);
        }
    }
    (data.triangle_uvs, data.triangle_normals) = (data.triangles.clone(), data.triangles.clone());
    data
}

/// A mesh in a file of PLY, packed or not.
pub(super) fn file(input: &Input, said: &Said, name: &str, at: Span, reversed: bool) -> Option<MeshData> {
    written_in_file(input, said, name, at).map(|data| oriented(data, reversed))
}

/// The bytes of a file that is named, and its number; says it of `what` where they cannot be had.
pub(crate) fn named_bytes(input: &Input, said: &Said, what: &str, name: &str, at: Span) -> Option<(Arc<[u8]>, u32)> {
    match input.source.read_unpacked(name) {
        Ok(bytes) => {
            let file = input.files.borrow_mut().add(name, bytes.clone());
            Some((bytes, file))
        }
        Err(error) => {
            let help = error.help();
            let missing = Diagnostic::error(format!("{what} cannot be had: {error}")).code("missing-file").at(at);
            said.push(Diagnostic { help, ..missing });
            None
        }
    }
}

/// A mesh as it is in a file of any format, packed or not.
pub(crate) fn written_in_file(input: &Input, said: &Said, name: &str, at: Span) -> Option<MeshData> {
    let (bytes, file) = named_bytes(input, said, "the mesh", name, at)?;
    let plain = name.strip_suffix(".gz").unwrap_or(name);
    let mut own = Diagnostics::default();
    let data = read_mesh(&bytes, file, plain, &mut own);
    if own.has_errors() {
        let message = format!("the mesh `{name}` cannot be used");
        said.push(Diagnostic::error(message).code("bad-file").at(at).label("asked for here"));
    }
    said.extend(own);
    data
}
