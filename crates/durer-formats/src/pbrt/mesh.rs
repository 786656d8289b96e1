//! Reads meshes whose vertices are in the scene file.

use super::params::Params;
use durer_scene::math::{Vec2, Vec3};
use durer_scene::shape::MeshData;
use durer_scene::shape::tessellate::net::{self, Patches};
use durer_scene::shape::tessellate::revolution;
use durer_scene::shape::tessellate::subdivision::loop_surface;

/// Maximum number of triangles of a subdivision surface. Tests use a low limit so that they can
/// reach it quickly.
const MAX_TRIANGLES: usize = if cfg!(test) { 1 << 14 } else { 1 << 20 };

/// Vertices and faces of a mesh as listed in a pbrt file. All faces have the same number of
/// corners.
struct MeshArrays {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    uvs: Vec<Vec2>,
    faces: Vec<Vec<u32>>,
}

/// Reads the vertices, and the faces with `size` corners each. If `indices` is missing, there is a
/// single face whose corners are `default`.
fn read_arrays(params: &Params, size: usize, default: &[u32]) -> Option<MeshArrays> {
    let report = params.report;
    let Some(positions) = params.triples("P") else {
        report.error(params.at, "a mesh needs points, `\"point3 P\"`");
        return None;
    };
    let count = positions.len();
    let mut sound = true;
    let mut check = |name: &'static str, found: usize| {
        if found != count {
            report.error(params.span(name), format!("`{name}` has {found} values for {count} points"));
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
    params.mark_known(&["S", "faceIndices"]);
    let indices = match params.integers("indices") {
        Some(indices) => indices,
        None if count == default.len() => default.iter().map(|&i| i64::from(i)).collect(),
        None => {
            report.error(params.at, "a mesh of several faces needs `\"integer indices\"`");
            return None;
        }
    };
    let place = params.get("indices").map_or(params.at, |param| param.values_at);
    if indices.len() % size != 0 {
        report.error(place, format!("`indices` has {} numbers, which is not a multiple of {size}", indices.len()));
        sound = false;
    }
    if let Some(wrong) = indices.iter().find(|&&i| i < 0 || i >= count as i64) {
        report.error(
            place,
            format!("`indices` contains {wrong}, but the points are numbered from 0 to {}", count as i64 - 1),
        );
        sound = false;
    }
    let faces = indices.chunks_exact(size).map(|face| face.iter().map(|&i| i as u32).collect()).collect();
    sound.then_some(MeshArrays { positions, normals, uvs, faces })
}

/// Reads a `trianglemesh`.
pub(super) fn triangles(params: &Params, reversed: bool) -> Option<MeshData> {
    let MeshArrays { positions, normals, uvs, faces } = read_arrays(params, 3, &[0, 1, 2])?;
    let triangles: Vec<[u32; 3]> = faces.iter().map(|face| [face[0], face[1], face[2]]).collect();
    let of = |there: bool| if there { triangles.clone() } else { Vec::new() };
    let (triangle_uvs, triangle_normals) = (of(!uvs.is_empty()), of(!normals.is_empty()));
    let data = MeshData { positions, uvs, normals, triangles, triangle_uvs, triangle_normals, ..MeshData::default() };
    Some(data.oriented(reversed))
}

/// Reads a `bilinearmesh`, whose patches have corners at (u, v) = (0, 0), (1, 0), (0, 1) and (1,
/// 1).
pub(super) fn bilinear(params: &Params, reversed: bool) -> Option<MeshData> {
    params.warn_unsupported(&["emissionfilename"], "the patch emits evenly");
    let MeshArrays { positions, normals, uvs, faces } = read_arrays(params, 4, &[0, 1, 2, 3])?;
    let faces = faces.iter().map(|face| [face[0], face[1], face[2], face[3]]).collect();
    Some(net::bilinear(&Patches { positions, normals, uvs, faces }).oriented(reversed))
}

/// Returns the number of patches of a bilinear mesh.
pub(super) fn patch_count(params: &Params) -> usize {
    let [corners, points] = ["indices", "P"].map(|name| params.get(name).map(|param| param.numbers().len()));
    corners.map(|count| count / 4).or(points.map(|count| count / 12)).unwrap_or(1).max(1)
}

/// Reads a `loopsubdiv` and subdivides it into at most `left` triangles.
pub(super) fn subdivided(params: &Params, reversed: bool, left: usize) -> Option<MeshData> {
    params.mark_known(&["scheme"]);
    let levels = params.integer("levels").or_else(|| params.integer("nlevels")).unwrap_or(3);
    if !(0..=16).contains(&levels) {
        params.report.error(params.span("levels"), "`levels` must be from 0 to 16");
        return None;
    }
    let control = triangles(params, false)?;
    let most = left.min(MAX_TRIANGLES);
    let (data, done) = loop_surface(&control, levels as u32, most);
    if i64::from(done) < levels {
        let what = format!("the surface is subdivided only {done} times, to limit the number of triangles to {most}");
        params.report.unsupported_once(params.span("levels"), what);
    }
    Some(data.oriented(reversed))
}

/// Reads a cylinder as flat strips that have the normals of the round surface. The cylinder has no
/// caps.
pub(super) fn cylinder(params: &Params, reversed: bool) -> Option<MeshData> {
    let radius = params.positive("radius").unwrap_or(1.0);
    let (low, high) = (params.float("zmin").unwrap_or(-1.0), params.float("zmax").unwrap_or(1.0));
    let degrees = params.float("phimax").unwrap_or(360.0).clamp(1e-3, 360.0);
    Some(revolution::cylinder(radius, [low.min(high), low.max(high)], degrees).oriented(reversed))
}
