//! Normals at the corners of a mesh that brings none.

use super::mesh::{MeshData, NO_INDEX};
use crate::dialect::MeshNormals;
use crate::math::{Vec3, fp};
use glam::DVec3;

/// Gives every triangle without normals the ones that the rule makes.
pub(super) fn complete(data: &mut MeshData, rule: MeshNormals) {
    let missing = |data: &MeshData, i: usize| data.triangle_normals.get(i).is_none_or(|n| n.contains(&NO_INDEX));
    if data.flat || (0..data.triangles.len()).all(|i| !missing(data, i)) {
        return;
    }
    let rule = match rule {
        MeshNormals::SmoothAbove(count) if data.positions.len() > count => MeshNormals::SmoothByArea,
        MeshNormals::SmoothAbove(_) => MeshNormals::Flat,
        other => other,
    };
    let made = match rule {
        MeshNormals::SmoothByArea => smooth(data, |cross| cross),
        MeshNormals::SmoothByFace => smooth(data, DVec3::normalize_or_zero),
        MeshNormals::Crease(degrees) => creased(data, degrees),
        MeshNormals::Flat | MeshNormals::SmoothAbove(_) => return,
    };
    let base = data.normals.len() as u32;
    data.normals.extend(made.0);
    let complete = (0..data.triangles.len())
        .map(|i| match missing(data, i) {
            true => made.1[i].map(|n| n + base),
            false => data.triangle_normals[i],
        })
        .collect();
    data.triangle_normals = complete;
}

/// Twice the area of a triangle times its normal. Tiny areas are beyond single precision.
fn cross(data: &MeshData, triangle: [u32; 3]) -> DVec3 {
    let [a, b, c] = triangle.map(|i| data.positions[i as usize].as_dvec3());
    (b - a).cross(c - a)
}

type Normals = (Vec<Vec3>, Vec<[u32; 3]>);

/// One normal a vertex: the sum over its faces, each weighted by a function of its cross product.
fn smooth(data: &MeshData, weigh: impl Fn(DVec3) -> DVec3) -> Normals {
    let vertices = if data.vertices.is_empty() { &data.triangles } else { &data.vertices };
    let count = vertices.iter().flatten().max().map_or(0, |&last| last as usize + 1);
    let mut sums = vec![DVec3::ZERO; count];
    for (&triangle, vertices) in data.triangles.iter().zip(vertices) {
        let normal = weigh(cross(data, triangle));
        for &i in vertices {
            sums[i as usize] += normal;
        }
    }
    (sums.into_iter().map(|sum| sum.normalize_or_zero().as_vec3()).collect(), vertices.clone())
}

/// One normal a corner: the sum, by angle, over the faces around its vertex that are not beyond a
/// crease.
///
/// Source of the weights: Thürmer and Wüthrich, *Computing Vertex Normals from Polygonal Facets*,
/// JGT 3(1), 1998.
fn creased(data: &MeshData, degrees: f32) -> Normals {
    let least_cosine = fp::sin_cos_degrees(f64::from(degrees)).1 as f32;
    let faces: Vec<Vec3> = data.triangles.iter().map(|&t| cross(data, t).normalize_or_zero().as_vec3()).collect();
    // For each vertex the corners that meet there, as one flat list: corner 3i + k is corner k of
    // triangle i.
    let mut starts = vec![0u32; data.positions.len() + 1];
    for i in data.triangles.iter().flatten() {
        starts[*i as usize + 1] += 1;
    }
    for i in 1..starts.len() {
        starts[i] += starts[i - 1];
    }
    let mut next = starts.clone();
    let mut corners = vec![0u32; data.triangles.len() * 3];
    for (corner, i) in data.triangles.iter().flatten().enumerate() {
        corners[next[*i as usize] as usize] = corner as u32;
        next[*i as usize] += 1;
    }
    // A vertex with very many faces stays faceted, lest the time be quadratic.
    const MANY: usize = 64;
    let angle = |corner: u32| {
        let [triangle, k] = [corner as usize / 3, corner as usize % 3];
        let at = |k: usize| data.positions[data.triangles[triangle][k % 3] as usize].as_dvec3();
        let edge = |to: usize| (at(to) - at(k)).normalize_or_zero().as_vec3();
        let (e, f) = (edge(k + 1), edge(k + 2));
        fp::atan2(e.cross(f).length(), e.dot(f))
    };
    let angles: Vec<f32> = (0..corners.len() as u32).map(angle).collect();
    let mut normals = Vec::with_capacity(corners.len());
    let mut indices = Vec::with_capacity(data.triangles.len());
    for (i, triangle) in data.triangles.iter().enumerate() {
        indices.push([0, 1, 2].map(|k| (normals.len() + k) as u32));
        for vertex in triangle {
            let around = &corners[starts[*vertex as usize] as usize..starts[*vertex as usize + 1] as usize];
            let sum: Vec3 = if around.len() > MANY {
                faces[i]
            } else {
                let near = around.iter().filter(|&&c| faces[c as usize / 3].dot(faces[i]) >= least_cosine);
                near.map(|&c| angles[c as usize] * faces[c as usize / 3]).sum()
            };
            normals.push(sum.normalize_or(faces[i]));
        }
    }
    (normals, indices)
}
