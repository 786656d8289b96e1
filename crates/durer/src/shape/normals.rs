//! Normals at the corners of a mesh that brings none.

use super::mesh_data::{MeshData, NO_INDEX};
use crate::dialect::MeshNormals;
use crate::math::{Vec3, fp};
use glam::DVec3;
use rayon::prelude::*;

/// Normals of the corners of triangles.
#[derive(Clone, Debug, Default)]
pub(super) struct Normals {
    /// Normals, not necessarily of length 1; may be empty.
    pub values: Vec<Vec3>,
    /// Three of them a triangle, or [`NO_INDEX`]; empty where no triangle has any.
    pub triangles: Vec<[u32; 3]>,
}

/// The normals of all triangles, with those that a rule makes for such as have none, or for all
/// unless `file_normals`; `None` where the mesh's own are all that there is.
pub(super) fn made(data: &MeshData, rule: MeshNormals, file_normals: bool) -> Option<Normals> {
    let own: (&[Vec3], &[[u32; 3]]) = match file_normals {
        true => (&data.normals, &data.triangle_normals),
        false => (&[], &[]),
    };
    let missing = |i: usize| own.1.get(i).is_none_or(|n| n.contains(&NO_INDEX));
    let has_any = !data.normals.is_empty() || !data.triangle_normals.is_empty();
    let as_they_are = || (has_any && !file_normals).then(Normals::default);
    if data.flat || (0..data.triangles.len()).all(|i| !missing(i)) {
        return as_they_are();
    }
    let rule = match rule {
        MeshNormals::SmoothAbove(count) if data.positions.len() > count => MeshNormals::SmoothByArea,
        MeshNormals::SmoothAbove(_) => MeshNormals::Flat,
        other => other,
    };
    let mut made = match rule {
        MeshNormals::SmoothByArea => smooth(data, |cross| cross),
        MeshNormals::SmoothByFace => smooth(data, DVec3::normalize_or_zero),
        MeshNormals::Crease(degrees) => creased(data, degrees),
        MeshNormals::Flat | MeshNormals::SmoothAbove(_) => return as_they_are(),
    };
    if !own.0.is_empty() {
        let base = own.0.len() as u32;
        made.values.splice(..0, own.0.iter().copied());
        for (i, triangle) in made.triangles.iter_mut().enumerate() {
            *triangle = if missing(i) { triangle.map(|n| n + base) } else { own.1[i] };
        }
    }
    Some(made)
}

/// Twice the area of a triangle times its normal. Tiny areas are beyond single precision.
fn cross(data: &MeshData, triangle: [u32; 3]) -> DVec3 {
    let [a, b, c] = triangle.map(|i| data.positions[i as usize].as_dvec3());
    (b - a).cross(c - a)
}

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
    let values = sums.into_iter().map(|sum| sum.normalize_or_zero().as_vec3()).collect();
    Normals { values, triangles: vertices.clone() }
}

/// One normal a corner: the sum, by angle, over the faces around its vertex that are not beyond a
/// crease.
///
/// Source of the weights: Thürmer and Wüthrich, *Computing Vertex Normals from Polygonal Facets*,
/// JGT 3(1), 1998.
fn creased(data: &MeshData, degrees: f32) -> Normals {
    let least_cosine = fp::sin_cos_degrees(f64::from(degrees)).1 as f32;
    let face = |&triangle: &[u32; 3]| cross(data, triangle).normalize_or_zero().as_vec3();
    let faces: Vec<Vec3> = data.triangles.par_iter().map(face).collect();
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
    let angles: Vec<f32> = (0..corners.len() as u32).into_par_iter().map(angle).collect();
    let normal = |i: usize, vertex: u32| {
        let around = &corners[starts[vertex as usize] as usize..starts[vertex as usize + 1] as usize];
        let sum: Vec3 = if around.len() > MANY {
            faces[i]
        } else {
            let near = around.iter().filter(|&&c| faces[c as usize / 3].dot(faces[i]) >= least_cosine);
            near.map(|&c| angles[c as usize] * faces[c as usize / 3]).sum()
        };
        sum.normalize_or(faces[i])
    };
    let of_triangle = |(i, triangle): (usize, &[u32; 3])| triangle.map(|vertex| normal(i, vertex));
    let own: Vec<[Vec3; 3]> = data.triangles.par_iter().enumerate().map(of_triangle).collect();
    // Corners of one vertex mostly have one normal, which is kept once.
    let (mut values, mut triangles): (Vec<Vec3>, _) = (Vec::new(), vec![[0; 3]; own.len()]);
    for ends in starts.windows(2) {
        let first = values.len();
        for &corner in &corners[ends[0] as usize..ends[1] as usize] {
            let [triangle, k] = [corner as usize / 3, corner as usize % 3];
            let normal = own[triangle][k];
            let known = values[first..]
                .iter()
                .take(MANY)
                .position(|v| v.to_array().map(f32::to_bits) == normal.to_array().map(f32::to_bits));
            triangles[triangle][k] = (first + known.unwrap_or(values.len() - first)) as u32;
            if known.is_none() {
                values.push(normal);
            }
        }
    }
    values.shrink_to_fit();
    Normals { values, triangles }
}
