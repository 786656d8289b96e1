//! Loop subdivision surfaces.
//!
//! Sources: Loop, *Smooth Subdivision Surfaces Based on Triangles*, 1987; Hoppe et al., *Piecewise
//! Smooth Surface Reconstruction*, SIGGRAPH 1994 (borders and limit positions); Warren, for the
//! weights of the vertices.

use crate::math::fp;
use crate::shape::MeshData;
use glam::DVec3;
use std::collections::BTreeMap;

/// Triangle mesh at one level of Loop subdivision.
struct LoopMesh {
    points: Vec<DVec3>,
    faces: Vec<[u32; 3]>,
}

/// Neighbours of a point of the mesh, in order around the point. `closed` is false if the point is
/// on a border.
struct Ring {
    around: Vec<u32>,
    closed: bool,
}

/// Subdivides the triangles of a control mesh `levels` times, or stops earlier if the next level
/// would have more than `most` triangles. Afterwards, the points are moved to their limit
/// positions. Returns the mesh and the number of levels that were applied.
pub fn loop_surface(control: &MeshData, levels: u32, most: usize) -> (MeshData, u32) {
    let points = control.positions.iter().map(|p| p.as_dvec3()).collect();
    // A triangle with a repeated corner has no area, and its edges cannot be traversed.
    let sound = |face: &&[u32; 3]| face[0] != face[1] && face[1] != face[2] && face[2] != face[0];
    let mut net = LoopMesh { points, faces: control.triangles.iter().filter(sound).copied().collect() };
    let mut done = 0;
    while done < levels && net.faces.len() <= most / 4 {
        net = net.subdivide();
        done += 1;
    }
    (net.limit_surface(), done)
}

/// Returns the weight of each neighbour of an inner point that has `count` neighbours.
fn beta(count: usize) -> f64 {
    if count == 3 { 3.0 / 16.0 } else { 3.0 / (8.0 * count as f64) }
}

impl LoopMesh {
    /// Returns the ring around each point, or `None` for points where more than two sheets meet.
    fn rings(&self) -> Vec<Option<Ring>> {
        let mut sides: Vec<Vec<[u32; 2]>> = vec![Vec::new(); self.points.len()];
        for &[a, b, c] in &self.faces {
            for [at, from, to] in [[a, b, c], [b, c, a], [c, a, b]] {
                sides[at as usize].push([from, to]);
            }
        }
        sides.iter().map(|sides| ring(sides)).collect()
    }

    /// Returns the mesh of the next level, in which each triangle is split into four.
    fn subdivide(&self) -> LoopMesh {
        let rings = self.rings();
        let even = |i: usize| {
            let point = self.points[i];
            match &rings[i] {
                Some(Ring { around, closed: true }) => self.blend(point, around, beta(around.len())),
                Some(Ring { around, closed: false }) => {
                    let [first, last] = [around[0], around[around.len() - 1]].map(|k| self.points[k as usize]);
                    0.75 * point + 0.125 * (first + last)
                }
                None => point,
            }
        };
        let mut points: Vec<DVec3> = (0..self.points.len()).map(even).collect();
        let mut opposite: BTreeMap<[u32; 2], Vec<u32>> = BTreeMap::new();
        for &[a, b, c] in &self.faces {
            for [from, to, across] in [[a, b, c], [b, c, a], [c, a, b]] {
                opposite.entry([from.min(to), from.max(to)]).or_default().push(across);
            }
        }
        let mut middles = BTreeMap::new();
        for (edge, across) in &opposite {
            let [a, b] = edge.map(|k| self.points[k as usize]);
            let point = match across[..] {
                [c, d] => 0.375 * (a + b) + 0.125 * (self.points[c as usize] + self.points[d as usize]),
                _ => 0.5 * (a + b),
            };
            middles.insert(*edge, points.len() as u32);
            points.push(point);
        }
        let middle = |a: u32, b: u32| middles[&[a.min(b), a.max(b)]];
        let quarters = |&[a, b, c]: &[u32; 3]| {
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        LoopMesh { points, faces: self.faces.iter().flat_map(quarters).collect() }
    }

    /// Returns the weighted sum of a point and its neighbours, in which all neighbours have the
    /// same weight.
    fn blend(&self, point: DVec3, around: &[u32], weight: f64) -> DVec3 {
        let sum: DVec3 = around.iter().map(|&k| self.points[k as usize]).sum();
        point * (1.0 - weight * around.len() as f64) + weight * sum
    }

    /// Moves the points to their limit positions and computes the normals there.
    fn limit_surface(mut self) -> MeshData {
        let rings = self.rings();
        let moved = |i: usize| {
            let point = self.points[i];
            match &rings[i] {
                Some(Ring { around, closed: true }) => {
                    let count = around.len();
                    self.blend(point, around, 1.0 / (count as f64 + 3.0 / (8.0 * beta(count))))
                }
                Some(Ring { around, closed: false }) => {
                    let [first, last] = [around[0], around[around.len() - 1]].map(|k| self.points[k as usize]);
                    0.6 * point + 0.2 * (first + last)
                }
                None => point,
            }
        };
        self.points = (0..self.points.len()).map(moved).collect();
        let mut faced = vec![DVec3::ZERO; self.points.len()];
        for face in &self.faces {
            let [a, b, c] = face.map(|k| self.points[k as usize]);
            face.iter().for_each(|&k| faced[k as usize] += (b - a).cross(c - a));
        }
        let normal = |i: usize| {
            let own = rings[i].as_ref().map_or(DVec3::ZERO, |ring| self.normal(self.points[i], ring));
            own.try_normalize().or(faced[i].try_normalize()).unwrap_or(DVec3::Z).as_vec3()
        };
        let normals = (0..self.points.len()).map(normal).collect();
        MeshData {
            positions: self.points.iter().map(|p| p.as_vec3()).collect(),
            normals,
            triangle_normals: self.faces.clone(),
            triangles: self.faces,
            ..MeshData::default()
        }
    }

    /// Returns the cross product of the two limit tangents at a point.
    fn normal(&self, point: DVec3, ring: &Ring) -> DVec3 {
        let around: Vec<DVec3> = ring.around.iter().map(|&k| self.points[k as usize]).collect();
        let count = around.len();
        let turn = |degrees: f64| fp::sin_cos_degrees(degrees);
        if ring.closed {
            let each = (0..).zip(&around).map(|(j, p): (u32, _)| (turn(360.0 * f64::from(j) / count as f64), p));
            let (s, t) = each.fold((DVec3::ZERO, DVec3::ZERO), |(s, t), ((sin, cos), p)| (s + cos * *p, t + sin * *p));
            return s.cross(t);
        }
        let along = around[count - 1] - around[0];
        let inwards = match count {
            2 => around[0] + around[1] - 2.0 * point,
            3 => around[1] - point,
            4 => -around[0] + 2.0 * around[1] + 2.0 * around[2] - around[3] - 2.0 * point,
            _ => {
                let step = 180.0 / (count - 1) as f64;
                let (sin, cos) = turn(step);
                let inner = (1..).zip(&around[1..count - 1]);
                let inner = inner.map(|(k, p): (u32, _)| (2.0 * cos - 2.0) * turn(step * f64::from(k)).0 * *p);
                -(sin * (around[0] + around[count - 1]) + inner.sum::<DVec3>())
            }
        };
        inwards.cross(along)
    }
}

/// Sorts the edges opposite a point, each of which leads from one neighbour to the next, into a
/// ring. If there is a border, the ring starts there.
fn ring(sides: &[[u32; 2]]) -> Option<Ring> {
    let next: BTreeMap<u32, u32> = sides.iter().map(|&[from, to]| (from, to)).collect();
    if next.len() != sides.len() || sides.is_empty() {
        return None;
    }
    let first = sides.iter().map(|side| side[0]).find(|from| !sides.iter().any(|side| side[1] == *from));
    let start = first.unwrap_or(sides[0][0]);
    let mut around = vec![start];
    let mut at = start;
    while let Some(&to) = next.get(&at) {
        if to == start || around.len() > sides.len() {
            break;
        }
        around.push(to);
        at = to;
    }
    let closed = first.is_none();
    let whole = if closed { sides.len() } else { sides.len() + 1 };
    (around.len() == whole).then_some(Ring { around, closed })
}
