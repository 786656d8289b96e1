//! Vertex normals for smooth meshes whose file contains no normals.

use durer_scene::math::{Vec3, fp};
use durer_scene::shape::MeshData;
use durer_scene::shape::mesh::NO_INDEX;
use std::array::from_fn;
use std::collections::HashMap;

/// Computes normals for the triangles that have none. The normal at a vertex is the mean of the
/// normals of adjacent faces, weighted by the angle of each face at the vertex.
///
/// `part(triangle, corner)` separates vertices at the same position: two corners share a normal
/// only if they are at the same position and belong to the same part. If it returns `None`, the
/// triangle is not changed.
///
/// Source: Thürmer and Wüthrich, *Computing Vertex Normals from Polygonal Facets*, Journal of
/// Graphics Tools 3(1), 1998.
pub(super) fn smoothed(data: &mut MeshData, part: impl Fn(usize, usize) -> Option<u32>) {
    let before = data.normals.len();
    data.triangle_normals.resize(data.triangles.len(), [NO_INDEX; 3]);
    let mut numbers = HashMap::new();
    for (i, corners) in data.triangles.iter().enumerate() {
        if data.triangle_normals[i] != [NO_INDEX; 3] || (0..3).any(|k| part(i, k).is_none()) {
            continue;
        }
        let at = corners.map(|corner| data.positions[corner as usize]);
        let face = (at[1] - at[0]).cross(at[2] - at[0]).normalize_or_zero();
        data.triangle_normals[i] = from_fn(|k| {
            let number = *numbers.entry((corners[k], part(i, k))).or_insert(data.normals.len() as u32);
            data.normals.resize(data.normals.len().max(number as usize + 1), Vec3::ZERO);
            let [to, other] = [1, 2].map(|step| (at[(k + step) % 3] - at[k]).normalize_or_zero());
            data.normals[number as usize] += fp::atan2(to.cross(other).length(), to.dot(other)) * face;
            number
        });
    }
    data.normals[before..].iter_mut().for_each(|n| *n = n.normalize_or(Vec3::Y));
    if data.triangle_normals.iter().all(|normals| *normals == [NO_INDEX; 3]) {
        data.triangle_normals.clear();
    }
}
