//! Computes vertex tangents for normal maps. The tangents are compatible with MikkTSpace, for which
//! most normal maps are baked.
//!
//! Source: Morten Mikkelsen, *Simulation of Wrinkled Surfaces Revisited*, University of Copenhagen,
//! 2008, and his program. Triangle corners share one tangent if they have the same position, normal
//! and texture coordinates, are connected by edges, and their texture coordinates have the same
//! orientation. The shared tangent is the mean of the tangents of the triangles, weighted by their
//! angles.

use super::MeshData;
use super::mesh::NO_INDEX;
use crate::math::{Vec2, Vec3, fp};
use rayon::prelude::*;
use std::collections::HashMap;

impl MeshData {
    /// Computes tangents for vertices that have normals and texture coordinates. A vertex whose
    /// corners have different tangents is split. Returns the index of the original vertex for each
    /// vertex that is appended at the end. Does nothing if a corner lacks a normal or texture
    /// coordinates.
    pub fn make_tangents(&mut self) -> Vec<u32> {
        let complete = |list: &[[u32; 3]]| {
            list.len() == self.triangles.len() && list.iter().flatten().all(|&index| index != NO_INDEX)
        };
        if !complete(&self.triangle_normals) || !complete(&self.triangle_uvs) {
            return Vec::new();
        }
        let tangents = Corners::new(self).tangents();
        self.split(&tangents)
    }

    /// Assigns to each vertex the tangent of its corners. If the corners have several tangents, a
    /// copy of the vertex is appended for each additional one.
    fn split(&mut self, tangents: &[[f32; 4]]) -> Vec<u32> {
        self.tangents = vec![[0.0; 4]; self.positions.len()];
        let mut taken = vec![false; self.positions.len()];
        let (mut copies, mut originals) = (HashMap::new(), Vec::new());
        for (vertex, tangent) in self.triangles.iter_mut().flatten().zip(tangents) {
            let i = *vertex as usize;
            if !std::mem::replace(&mut taken[i], true) {
                self.tangents[i] = *tangent;
            }
            if self.tangents[i] == *tangent {
                continue;
            }
            *vertex = *copies.entry((*vertex, tangent.map(f32::to_bits))).or_insert_with(|| {
                originals.push(i as u32);
                self.positions.push(self.positions[i]);
                self.tangents.push(*tangent);
                if let Some(color) = self.colors.get(i) {
                    self.colors.push(*color);
                }
                if let Some(uv) = self.second_uvs.get(i) {
                    self.second_uvs.push(*uv);
                }
                self.positions.len() as u32 - 1
            });
        }
        originals
    }
}

/// Corners of all triangles of a mesh, for computing tangents. Corner 3 t + k is the k-th corner of
/// triangle t.
struct Corners {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    /// Direction of length 1 or 0 in which u increases on each triangle. The flag is true if the
    /// texture coordinates have the same orientation as the triangle.
    triangles: Vec<(Vec3, bool)>,
    /// Numbers that are equal for corners with the same values of all attributes.
    vertices: Vec<u32>,
}

impl Corners {
    fn new(data: &MeshData) -> Self {
        let of = |list: &[[u32; 3]]| -> Vec<usize> { list.iter().flatten().map(|&index| index as usize).collect() };
        let positions: Vec<Vec3> = of(&data.triangles).into_iter().map(|i| data.positions[i]).collect();
        let normals: Vec<Vec3> = of(&data.triangle_normals).into_iter().map(|i| data.normals[i]).collect();
        let uvs: Vec<Vec2> = of(&data.triangle_uvs).into_iter().map(|i| data.uvs[i]).collect();
        // Treat positive and negative zero as equal.
        let bits = |x: f32| (x + 0.0).to_bits();
        let key = |&corner: &u32| {
            let (p, n, uv) = (positions[corner as usize], normals[corner as usize], uvs[corner as usize]);
            ([p.x, p.y, p.z].map(bits), [n.x, n.y, n.z].map(bits), [uv.x, uv.y].map(bits))
        };
        let mut order: Vec<u32> = (0..positions.len() as u32).collect();
        order.par_sort_unstable_by_key(|corner| (key(corner), *corner));
        let mut vertices = vec![0; positions.len()];
        for pair in order.chunk_by(|a, b| key(a) == key(b)) {
            pair.iter().for_each(|&corner| vertices[corner as usize] = pair[0]);
        }
        let triangles = positions.as_chunks().0.iter().zip(uvs.as_chunks().0).map(|(p, uv)| growth(p, uv)).collect();
        Corners { positions, normals, triangles, vertices }
    }

    /// True if both the triangle and its texture coordinates have a nonzero area.
    fn has_area(&self, triangle: usize) -> bool {
        self.triangles[triangle].0 != Vec3::ZERO
    }

    /// Finds pairs of corners that share a tangent at the common edges of triangles.
    fn pairs(&self) -> Vec<[u32; 2]> {
        let mut edges: Vec<([u32; 2], bool, [u32; 2])> = (0..self.positions.len())
            .filter(|corner| self.has_area(corner / 3))
            .map(|corner| {
                let next = corner - corner % 3 + (corner + 1) % 3;
                let (a, b) = (self.vertices[corner], self.vertices[next]);
                // Sort the corners in the order of their vertices, regardless of the direction of
                // the triangle.
                match a <= b {
                    true => ([a, b], true, [corner as u32, next as u32]),
                    false => ([b, a], false, [next as u32, corner as u32]),
                }
            })
            .collect();
        edges.par_sort_unstable();
        let mut pairs = Vec::new();
        for edge in edges.chunk_by(|a, b| a.0 == b.0) {
            // Neighbouring triangles traverse their common edge in opposite directions.
            let (back, forth) = edge.split_at(edge.partition_point(|e| !e.1));
            for (a, b) in back.iter().zip(forth) {
                if self.triangles[a.2[0] as usize / 3].1 == self.triangles[b.2[0] as usize / 3].1 {
                    pairs.extend([[a.2[0], b.2[0]], [a.2[1], b.2[1]]]);
                }
            }
        }
        pairs
    }

    /// Returns the contribution of a corner to its shared tangent.
    fn share(&self, corner: usize) -> Vec3 {
        let n = self.normals[corner];
        let flat = |v: Vec3| (v - n.dot(v) * n).normalize_or_zero();
        let first = corner - corner % 3;
        let to = |k: usize| flat(self.positions[first + (corner + k) % 3] - self.positions[corner]);
        let angle = fp::atan2(to(1).cross(to(2)).length(), to(1).dot(to(2)));
        angle * flat(self.triangles[corner / 3].0)
    }

    /// Returns the tangent of each corner, or zero if it is undefined, and 1 or -1 as the sign of
    /// the bitangent.
    fn tangents(&self) -> Vec<[f32; 4]> {
        let mut groups = UnionFind((0..self.positions.len() as u32).collect());
        self.pairs().into_iter().for_each(|[a, b]| groups.join(a, b));
        let mut sums = vec![Vec3::ZERO; self.positions.len()];
        for corner in (0..self.positions.len()).filter(|corner| self.has_area(corner / 3)) {
            sums[groups.of(corner as u32) as usize] += self.share(corner);
        }
        // Corners of degenerate triangles use the tangent of a neighbour at the same vertex.
        let mut any = vec![[0.0; 4]; self.positions.len()];
        let mut tangents: Vec<[f32; 4]> = Vec::with_capacity(self.positions.len());
        for corner in 0..self.positions.len() {
            let Vec3 { x, y, z } = sums[groups.of(corner as u32) as usize].normalize_or_zero();
            let tangent = [x, y, z, if self.triangles[corner / 3].1 { 1.0 } else { -1.0 }];
            if self.has_area(corner / 3) {
                any[self.vertices[corner] as usize] = tangent;
            }
            tangents.push(tangent);
        }
        for corner in (0..self.positions.len()).filter(|corner| !self.has_area(corner / 3)) {
            tangents[corner] = any[self.vertices[corner] as usize];
        }
        tangents
    }
}

/// Returns the unit direction in which u increases on a triangle, or zero if it is undefined. The
/// flag is true if u and v have the same orientation as the corners.
fn growth([p, q, r]: &[Vec3; 3], [a, b, c]: &[Vec2; 3]) -> (Vec3, bool) {
    let (along, across) = (*b - *a, *c - *a);
    let area = along.perp_dot(across);
    let u = ((*q - *p) * across.y - (*r - *p) * along.y) * area.signum();
    let solid = area != 0.0 && u.is_finite() && p != q && q != r && r != p;
    (if solid { u.normalize_or_zero() } else { Vec3::ZERO }, area > 0.0)
}

/// Union-find structure that groups the corners that share a tangent. Each corner refers to another
/// corner in its group, and the root refers to itself.
struct UnionFind(Vec<u32>);

impl UnionFind {
    fn of(&mut self, mut corner: u32) -> u32 {
        while self.0[corner as usize] != corner {
            // Path halving.
            let next = self.0[corner as usize];
            self.0[corner as usize] = self.0[next as usize];
            corner = next;
        }
        corner
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.of(a), self.of(b));
        // The lower index becomes the root, so that the order of joins has no effect.
        self.0[a.max(b) as usize] = a.min(b);
    }
}
