//! How triangles hang together: edges, sides, volume.

use durer_scene::math::{Aabb, Vec3};
use durer_scene::shape::mesh::place_key;
use glam::DVec3;
use std::collections::HashMap;

/// What is found out about some triangles. Corners at the same place are one.
#[derive(Debug, Default)]
pub(in crate::check) struct Topology {
    /// Triangles without area.
    pub degenerate: Vec<u32>,
    /// Edges of one triangle only, and of more than two.
    pub open: usize,
    pub crowded: usize,
    /// One of those edges.
    pub some_edge: Option<[Vec3; 2]>,
    /// Triangles that go round the other way than most of those that they hang together with.
    pub turned: Vec<u32>,
    /// How many edges there are, and the volume of the box around them.
    pub edges: usize,
    pub box_volume: f64,
    /// The length of the sum of all directed areas, as a share of the sum of their lengths.
    pub opening: f64,
    /// Six times the volume that is enclosed, seen from its middle where it is not closed; negative
    /// where triangles go round clockwise, seen from outside.
    pub volume: f64,
}

/// An edge of a triangle: its two corners, the lesser first; whether the triangle runs along it so;
/// the triangle.
type Edge = (u64, bool, u32);

impl Topology {
    /// Looks at triangles.
    pub fn of(positions: &[Vec3], triangles: &[[u32; 3]]) -> Self {
        let mut topology = Topology::default();
        let place = same_places(positions);
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
            // Corners on one line, but for rounding.
            let normal = (b - a).cross(c - a);
            (sum, area) = (sum + normal, area + normal.length());
            if normal.length() <= 1e-9 * longest {
                topology.degenerate.push(i as u32);
                continue;
            }
            let [a, b, c] = triangle.map(|corner| place[corner as usize]);
            for (p, q) in [(a, b), (b, c), (c, a)].into_iter().filter(|(p, q)| p != q) {
                edges.push((u64::from(p.min(q)) << 32 | u64::from(p.max(q)), p < q, i as u32));
            }
        }
        topology.opening = sum.length() / area.max(f64::MIN_POSITIVE);
        edges.sort_unstable();
        for same in edges.chunk_by(|a, b| a.0 == b.0) {
            topology.edges += 1;
            topology.open += usize::from(same.len() == 1);
            topology.crowded += usize::from(same.len() > 2);
            if same.len() != 2 && topology.some_edge.is_none() {
                topology.some_edge =
                    Some([(same[0].0 >> 32) as usize, same[0].0 as u32 as usize].map(|i| positions[i]));
            }
        }
        topology.turned = turned(&edges, triangles.len());
        topology
    }

    /// Whether it is closed but for a hole, as at the top of a vase: the directed areas of a closed
    /// surface sum to 0, its rims are short, and the volume in it is no accident.
    pub fn is_nearly_closed(&self) -> bool {
        let short = self.crowded == 0 && self.open * 10 < self.edges;
        self.is_closed() || short && self.opening < 0.25 && self.volume.abs() > 0.1 * self.box_volume
    }

    /// Whether every edge has two triangles.
    pub fn is_closed(&self) -> bool {
        self.open == 0 && self.crowded == 0
    }
}

/// For each corner, the first one at the same place.
fn same_places(positions: &[Vec3]) -> Vec<u32> {
    let mut first: HashMap<[u32; 3], u32> = HashMap::with_capacity(positions.len());
    positions.iter().enumerate().map(|(i, p)| *first.entry(place_key(*p)).or_insert(i as u32)).collect()
}

/// Goes from triangle to triangle across edges of two: neighbours that run along their edge alike
/// go round differently. Of each piece that hangs together, the fewer are turned.
fn turned(edges: &[Edge], count: usize) -> Vec<u32> {
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
