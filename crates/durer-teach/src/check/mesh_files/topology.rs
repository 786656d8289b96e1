//! Connectivity of triangles: edges, orientation, and volume.

use durer_scene::math::{Aabb, Vec3};
use durer_scene::shape::mesh::position_key;
use glam::DVec3;
use std::collections::HashMap;

/// Connectivity of a mesh for the checks: open edges, reversed triangles and enclosed volume.
/// Vertices at the same position count as one vertex.
#[derive(Debug, Default)]
pub(in crate::check) struct Topology {
    /// Triangles with zero area.
    pub degenerate: Vec<u32>,
    /// Number of edges that belong to one triangle (`open`), and number of edges that belong to
    /// more than two (`non_manifold`).
    pub open: usize,
    pub non_manifold: usize,
    /// One of these edges.
    pub some_edge: Option<[Vec3; 2]>,
    /// Triangles whose winding is opposite to that of most triangles in the same connected piece.
    pub reversed: Vec<u32>,
    /// Number of edges, and volume of the bounding box.
    pub edges: usize,
    pub box_volume: f64,
    /// Length of the sum of all area vectors, divided by the sum of their lengths. It is 0 for a
    /// closed surface.
    pub area_vector_sum: f64,
    /// Six times the signed enclosed volume, relative to the centre of the bounds if the mesh is
    /// open. It is negative if triangles are clockwise when seen from outside.
    pub volume: f64,
}

/// An edge of a triangle: the key of its two vertices with the smaller index first, true if the
/// triangle runs along it in that order, and the index of the triangle.
type Edge = (u64, bool, u32);

impl Topology {
    /// Computes the topology of a list of triangles.
    pub fn of(positions: &[Vec3], triangles: &[[u32; 3]]) -> Self {
        let mut topology = Topology::default();
        let vertex = merged_vertices(positions);
        let used = triangles.iter().flatten().map(|&corner| positions[corner as usize]);
        let bounds = Aabb::around(used);
        let anchor = if bounds.is_empty() { DVec3::ZERO } else { bounds.center().as_dvec3() };
        topology.box_volume = bounds.size().as_dvec3().element_product();
        let (mut sum, mut area) = (DVec3::ZERO, 0.0);
        let mut edges: Vec<Edge> = Vec::with_capacity(3 * triangles.len());
        for (i, triangle) in triangles.iter().enumerate() {
            let [a, b, c] = triangle.map(|corner| positions[corner as usize].as_dvec3() - anchor);
            topology.volume += a.dot(b.cross(c));
            let longest = (b - a).length_squared().max((c - a).length_squared()).max((c - b).length_squared());
            // The vertices are collinear up to rounding errors.
            let normal = (b - a).cross(c - a);
            (sum, area) = (sum + normal, area + normal.length());
            if normal.length() <= 1e-9 * longest {
                topology.degenerate.push(i as u32);
                continue;
            }
            let [a, b, c] = triangle.map(|corner| vertex[corner as usize]);
            for (p, q) in [(a, b), (b, c), (c, a)].into_iter().filter(|(p, q)| p != q) {
                edges.push((u64::from(p.min(q)) << 32 | u64::from(p.max(q)), p < q, i as u32));
            }
        }
        topology.area_vector_sum = sum.length() / area.max(f64::MIN_POSITIVE);
        edges.sort_unstable();
        for same in edges.chunk_by(|a, b| a.0 == b.0) {
            topology.edges += 1;
            topology.open += usize::from(same.len() == 1);
            topology.non_manifold += usize::from(same.len() > 2);
            if same.len() != 2 && topology.some_edge.is_none() {
                topology.some_edge =
                    Some([(same[0].0 >> 32) as usize, same[0].0 as u32 as usize].map(|i| positions[i]));
            }
        }
        topology.reversed = reversed_triangles(&edges, triangles.len());
        topology
    }

    /// Returns true if the surface is closed except for a small hole, for example the top of a
    /// vase. Then its rims are short, its area vectors nearly sum to 0, and its volume is a large
    /// enough fraction of its bounds.
    pub fn is_nearly_closed(&self) -> bool {
        let short = self.non_manifold == 0 && self.open * 10 < self.edges;
        self.is_closed() || short && self.area_vector_sum < 0.25 && self.volume.abs() > 0.1 * self.box_volume
    }

    /// Returns true if every edge belongs to exactly two triangles.
    pub fn is_closed(&self) -> bool {
        self.open == 0 && self.non_manifold == 0
    }
}

/// Returns, for each vertex, the index of the first vertex at the same position.
fn merged_vertices(positions: &[Vec3]) -> Vec<u32> {
    let mut first: HashMap<[u32; 3], u32> = HashMap::with_capacity(positions.len());
    positions.iter().enumerate().map(|(i, p)| *first.entry(position_key(*p)).or_insert(i as u32)).collect()
}

/// Returns the reversed triangles. The search flood-fills across edges that belong to two
/// triangles. If both triangles run along their common edge in the same direction, their windings
/// differ. In each connected piece, the minority counts as reversed.
fn reversed_triangles(edges: &[Edge], count: usize) -> Vec<u32> {
    let pairs = || edges.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() == 2);
    if pairs().all(|same| same[0].1 != same[1].1) {
        return Vec::new();
    }
    let mut neighbours: Vec<Vec<(u32, bool)>> = vec![Vec::new(); count];
    for same in pairs() {
        let differs = same[0].1 == same[1].1;
        neighbours[same[0].2 as usize].push((same[1].2, differs));
        neighbours[same[1].2 as usize].push((same[0].2, differs));
    }
    let mut side: Vec<Option<bool>> = vec![None; count];
    let mut turned = Vec::new();
    for start in 0..count {
        if side[start].is_some() {
            continue;
        }
        side[start] = Some(false);
        let (mut piece, mut at) = (vec![start as u32], 0);
        while let Some(&here) = piece.get(at) {
            at += 1;
            let own = side[here as usize] == Some(true);
            for &(next, differs) in &neighbours[here as usize] {
                if side[next as usize].is_none() {
                    side[next as usize] = Some(own != differs);
                    piece.push(next);
                }
            }
        }
        let others = piece.iter().filter(|&&i| side[i as usize] == Some(true)).count();
        let fewer = others * 2 <= piece.len();
        turned.extend(piece.into_iter().filter(|&i| (side[i as usize] == Some(true)) == fewer && others > 0));
    }
    turned.sort_unstable();
    turned
}
