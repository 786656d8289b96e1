//! Computes normals at the corners of triangles, for meshes that have no normals.

use super::height_field::Terrain;
use super::mesh_data::{MeshData, NO_INDEX, Triangles};
use crate::dialect::MeshNormals;
use crate::math::{Vec3, fp};
use glam::DVec3;
use rayon::prelude::*;
use std::borrow::Cow;
use std::ops::Range;

/// Maximum number of faces at a vertex that are compared with each other.
const MANY: usize = 64;
/// Minimum number of vertices for each thread.
const AT_ONCE: usize = 256;
/// Number of vertices that are processed in parallel. Processing all of them at once would need too
/// much memory.
const PER_TASK: usize = 64 * AT_ONCE;

/// Computed normals of a mesh, with one normal at each corner of its triangles.
#[derive(Clone, Debug, Default)]
pub(super) struct Normals {
    /// Normals, not necessarily of unit length; may be empty.
    pub values: Vec<Vec3>,
    /// Mapping from corners to normals.
    pub corners: CornerMap,
}

/// Mapping from the corners of a mesh's triangles to normals.
#[derive(Clone, Debug)]
pub(super) enum CornerMap {
    /// Three indices for each triangle, or [`NO_INDEX`]. The list is empty if no triangle has
    /// normals.
    Listed(Vec<[u32; 3]>),
    /// Index of the first normal of each vertex, and the offset of each corner from that index.
    /// This representation needs a third of the memory of the list, but it is slower.
    ByVertex(Vec<u32>, Vec<[u8; 3]>),
}

impl Default for CornerMap {
    fn default() -> Self {
        CornerMap::Listed(Vec::new())
    }
}

impl Normals {
    /// Size in memory, in bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.values)
            + match &self.corners {
                CornerMap::Listed(triangles) => size_of_val(&**triangles),
                CornerMap::ByVertex(firsts, offsets) => size_of_val(&**firsts) + size_of_val(&**offsets),
            }
    }

    /// Returns three normal indices for each triangle of the mesh.
    pub fn listed(&self, mesh: &impl Triangles) -> Cow<'_, [[u32; 3]]> {
        match &self.corners {
            CornerMap::Listed(triangles) => Cow::Borrowed(triangles),
            CornerMap::ByVertex(..) => (0..mesh.len()).map(|i| self.at_corners(mesh, i)).collect(),
        }
    }

    /// Returns the three normal indices of a triangle, or [`NO_INDEX`] if no indices are listed for
    /// it.
    #[inline]
    fn at_corners(&self, mesh: &impl Triangles, triangle: usize) -> [u32; 3] {
        match &self.corners {
            CornerMap::Listed(triangles) => triangles.get(triangle).copied().unwrap_or([NO_INDEX; 3]),
            CornerMap::ByVertex(firsts, offsets) => {
                let ([a, b, c], [i, j, k]) = (mesh.triangle(triangle), offsets[triangle].map(u32::from));
                [firsts[a as usize] + i, firsts[b as usize] + j, firsts[c as usize] + k]
            }
        }
    }

    /// Returns the normals at the corners of a triangle, if it has normals.
    #[inline]
    pub fn of_triangle(&self, mesh: &impl Triangles, triangle: usize) -> Option<[Vec3; 3]> {
        let [a, b, c] = self.at_corners(mesh, triangle);
        Some([*self.values.get(a as usize)?, *self.values.get(b as usize)?, *self.values.get(c as usize)?])
    }
}

/// Computes normals for all triangles, or only for triangles without normals if `file_normals` is
/// set. Returns the normals of all triangles, or `None` if the mesh needs only the normals that it
/// already has.
pub(super) fn computed(data: &MeshData, rule: MeshNormals, file_normals: bool) -> Option<Normals> {
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
    let Some(mut computed_normals) = by_rule(data, &data.vertices, rule, false) else { return as_they_are() };
    if !own.0.is_empty() {
        let base = own.0.len() as u32;
        computed_normals.values.splice(..0, own.0.iter().copied());
        let CornerMap::Listed(triangles) = &mut computed_normals.corners else { unreachable!("rules list") };
        for (i, triangle) in triangles.iter_mut().enumerate() {
            *triangle = if missing(i) { triangle.map(|n| n + base) } else { own.1[i] };
        }
    }
    Some(computed_normals)
}

/// Computes the normals of a terrain. Each vertex has few normals, because either few triangles
/// meet there or all of them lie in one plane.
pub(super) fn of_terrain(terrain: &Terrain, rule: MeshNormals) -> Option<Normals> {
    by_rule(terrain, &[], rule, true)
}

/// Computes normals for all triangles by the given rule. Returns `None` if the triangles stay flat.
/// If `vertices` is not empty, triangles that refer to the same entries are smooth along their
/// common edges. If `by_vertex` is set, the normals of creased meshes are stored by vertex.
fn by_rule(mesh: &impl Triangles, vertices: &[[u32; 3]], rule: MeshNormals, by_vertex: bool) -> Option<Normals> {
    match rule {
        MeshNormals::SmoothAbove(count) if mesh.vertices() <= count => None,
        MeshNormals::SmoothByArea | MeshNormals::SmoothAbove(_) => Some(smooth(mesh, vertices, |cross| cross)),
        MeshNormals::SmoothByFace => Some(smooth(mesh, vertices, DVec3::normalize_or_zero)),
        MeshNormals::SpoiledByFace => Some(smooth_or_nan(mesh, vertices)),
        // Triangles without shared vertices have no neighbours to smooth with.
        MeshNormals::Crease(_) if !shares_vertices(mesh) => None,
        MeshNormals::Crease(degrees) => Some(creased(mesh, degrees, by_vertex)),
        MeshNormals::Flat => None,
    }
}

/// Returns the normal of a triangle times twice its area, in double precision because tiny areas
/// underflow in single precision.
fn cross(mesh: &impl Triangles, triangle: usize) -> DVec3 {
    let [a, b, c] = mesh.corners(triangle).map(|p| p.as_dvec3());
    (b - a).cross(c - a)
}

/// Computes one normal for each vertex. The normal is the sum over the faces of the vertex, each
/// weighted by a function of its cross product.
fn smooth(mesh: &impl Triangles, vertices: &[[u32; 3]], weigh: impl Fn(DVec3) -> DVec3) -> Normals {
    let triangles = match vertices.is_empty() {
        true => (0..mesh.len()).map(|i| mesh.triangle(i)).collect(),
        false => vertices.to_vec(),
    };
    let count = triangles.iter().flatten().max().map_or(0, |&last| last as usize + 1);
    let mut sums = vec![DVec3::ZERO; count];
    for (i, vertices) in triangles.iter().enumerate() {
        let normal = weigh(cross(mesh, i));
        for &i in vertices {
            sums[i as usize] += normal;
        }
    }
    let values = sums.into_iter().map(|sum| sum.normalize_or_zero().as_vec3()).collect();
    Normals { values, corners: CornerMap::Listed(triangles) }
}

/// Computes normals from faces with equal weights. The normals at the vertices of a degenerate face
/// are NaN.
fn smooth_or_nan(mesh: &impl Triangles, vertices: &[[u32; 3]]) -> Normals {
    let mut normals = smooth(mesh, vertices, DVec3::normalize_or_zero);
    let CornerMap::Listed(triangles) = &normals.corners else { unreachable!("rules list") };
    for (i, triangle) in triangles.iter().enumerate() {
        if cross(mesh, i).normalize_or_zero() == DVec3::ZERO {
            triangle.iter().for_each(|&vertex| normals.values[vertex as usize] = Vec3::NAN);
        }
    }
    normals
}

/// True if any vertex belongs to more than one triangle.
fn shares_vertices(mesh: &impl Triangles) -> bool {
    let mut visited = vec![false; mesh.vertices()];
    let mut is_second = |vertex: u32| std::mem::replace(&mut visited[vertex as usize], true);
    (0..mesh.len()).any(|i| mesh.triangle(i).into_iter().any(&mut is_second))
}

/// Computes one normal for each corner. A normal is the sum of the normals of the faces around the
/// vertex, weighted by angle and without the faces beyond a crease. Most corners that share a
/// vertex have equal normals, which are stored only once.
///
/// Source of the weights: Thürmer and Wüthrich, *Computing Vertex Normals from Polygonal Facets*,
/// JGT 3(1), 1998.
fn creased(mesh: &impl Triangles, degrees: f32, by_vertex: bool) -> Normals {
    let least_cosine = fp::sin_cos_degrees(f64::from(degrees)).1 as f32;
    let around = VertexCorners::new(mesh);
    let face = |corner: u32| cross(mesh, corner as usize / 3).normalize_or_zero().as_vec3();
    let angle = |corner: u32| {
        let (corners, k) = (mesh.corners(corner as usize / 3), corner as usize);
        let at = |k: usize| corners[k % 3].as_dvec3();
        let edge = |to: usize| (at(to) - at(k)).normalize_or_zero().as_vec3();
        let (e, f) = (edge(k + 1), edge(k + 2));
        fp::atan2(e.cross(f).length(), e.dot(f))
    };
    // Normals of some of the vertices, the index of the first normal of each vertex, and the offset
    // of each corner.
    let some = |vertices: Range<usize>| {
        let (mut values, mut firsts, mut numbers): (Vec<Vec3>, Vec<u32>, Vec<[u32; 2]>) = Default::default();
        let (mut corners, mut faces): (Vec<u32>, Vec<(Vec3, f32)>) = Default::default();
        for vertex in vertices {
            corners.clear();
            around.for_each_corner(mesh, vertex as u32, |corner| corners.push(corner));
            faces.clear();
            // A vertex with very many faces stays faceted, because smoothing it would take
            // quadratic time.
            let is_faceted = corners.len() > MANY;
            if !is_faceted {
                faces.extend(corners.iter().map(|&corner| (face(corner), angle(corner))));
            }
            let first = values.len();
            firsts.push(first as u32);
            for (i, &corner) in corners.iter().enumerate() {
                let own = if is_faceted { face(corner) } else { faces[i].0 };
                let near = faces.iter().filter(|(face, _)| face.dot(own) >= least_cosine);
                let sum: Vec3 = if is_faceted { own } else { near.map(|(face, angle)| angle * face).sum() };
                let normal = sum.normalize_or(own);
                let same = |v: &Vec3| v.to_array().map(f32::to_bits) == normal.to_array().map(f32::to_bits);
                let known = values[first..].iter().take(MANY).position(same);
                numbers.push([corner, (first + known.unwrap_or(values.len() - first)) as u32]);
                if known.is_none() {
                    values.push(normal);
                }
            }
        }
        (values, firsts, numbers)
    };
    let count = mesh.vertices();
    let mut values = Vec::with_capacity(count);
    let mut of_corners = match by_vertex {
        true => CornerMap::ByVertex(Vec::with_capacity(count), vec![[0; 3]; mesh.len()]),
        false => CornerMap::Listed(vec![[0; 3]; mesh.len()]),
    };
    for first in (0..count).step_by(PER_TASK) {
        let starts = (first..count.min(first + PER_TASK)).into_par_iter().step_by(AT_ONCE);
        let computed_normals: Vec<_> = starts.map(|start| some(start..count.min(start + AT_ONCE))).collect();
        for (own, of_vertices, numbers) in computed_normals {
            let base = values.len() as u32;
            if let CornerMap::ByVertex(firsts, _) = &mut of_corners {
                firsts.extend(of_vertices.iter().map(|first| base + first));
            }
            for [corner, number] in numbers {
                let (i, k) = (corner as usize / 3, corner as usize % 3);
                match &mut of_corners {
                    CornerMap::Listed(triangles) => triangles[i][k] = base + number,
                    CornerMap::ByVertex(firsts, offsets) => {
                        offsets[i][k] = (base + number - firsts[mesh.triangle(i)[k] as usize]) as u8;
                    }
                }
            }
            values.extend(own);
        }
    }
    values.shrink_to_fit();
    Normals { values, corners: of_corners }
}

/// List of the corners at each vertex of a mesh, for computing normals. Corner k of triangle i has
/// the number 3 i + k. The list omits the triangles that [`Triangles::ordered_count`] covers.
struct VertexCorners {
    /// Index of the first corner of each vertex, followed by the end of the last vertex.
    starts: Vec<u32>,
    corners: Vec<u32>,
}

impl VertexCorners {
    fn new(mesh: &impl Triangles) -> Self {
        let listed = mesh.ordered_count()..mesh.len();
        let mut starts = vec![0; mesh.vertices() + 1];
        for vertex in listed.clone().flat_map(|i| mesh.triangle(i)) {
            starts[vertex as usize + 1] += 1;
        }
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut corners = vec![0; 3 * listed.len()];
        for i in listed {
            for (k, vertex) in mesh.triangle(i).into_iter().enumerate() {
                let next = &mut starts[vertex as usize];
                corners[*next as usize] = (3 * i + k) as u32;
                *next += 1;
            }
        }
        // Each start has now advanced to the start of the next vertex.
        starts.rotate_right(1);
        starts[0] = 0;
        VertexCorners { starts, corners }
    }

    /// Calls `emit` for each corner at a vertex, in the order of the triangles.
    fn for_each_corner(&self, mesh: &impl Triangles, vertex: u32, mut emit: impl FnMut(u32)) {
        mesh.ordered_around(vertex, &mut emit);
        let [start, end] = [0, 1].map(|next| self.starts[vertex as usize + next] as usize);
        self.corners[start..end].iter().for_each(|&corner| emit(corner));
    }
}
