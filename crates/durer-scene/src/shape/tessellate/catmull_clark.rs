//! Catmull-Clark subdivision surfaces with creases.
//!
//! Sources: Catmull and Clark, *Recursively Generated B-Spline Surfaces on Arbitrary Topological
//! Meshes*, 1978; DeRose, Kass and Truong, *Subdivision Surfaces in Character Animation*, SIGGRAPH
//! 1998 (creases that are sharp for some levels).

use glam::DVec3;
use std::collections::HashMap;

/// Edge that stays sharp for some levels of subdivision.
#[derive(Clone, Copy, Debug)]
pub struct Crease {
    /// Points at the ends of the edge.
    pub ends: [u32; 2],
    /// Number of levels for which the edge is sharp; may be fractional or infinite.
    pub sharpness: f64,
}

/// Mesh of polygons at one level of subdivision.
#[derive(Clone, Debug, Default)]
pub struct PolygonMesh {
    /// Points of the mesh.
    pub points: Vec<DVec3>,
    /// Point of each corner, and the index of the first corner of each face.
    corners: Vec<u32>,
    starts: Vec<u32>,
    /// Texture coordinates of each corner.
    uvs: Vec<[f64; 2]>,
    /// Face of the original mesh to which each face belongs.
    origins: Vec<u32>,
    /// Sharpness of edges; the smaller point is first.
    edges: HashMap<[u32; 2], f64>,
    /// Sharpness of points.
    sharp_points: HashMap<u32, f64>,
}

/// Edge of a mesh, with its neighbourhood.
struct Edge {
    ends: [u32; 2],
    /// Sum of the centres of the faces at the edge, and their number.
    centers: DVec3,
    faces: u32,
    sharpness: f64,
}

fn key([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

impl PolygonMesh {
    /// Creates a mesh without faces.
    pub fn new(points: Vec<DVec3>) -> Self {
        PolygonMesh { points, ..PolygonMesh::default() }
    }

    /// Adds a face with at least three corners. Corners must be indices of points.
    pub fn add_face(&mut self, corners: &[u32], uvs: impl Iterator<Item = [f64; 2]>, origin: u32) {
        self.starts.push(self.corners.len() as u32);
        self.corners.extend(corners);
        self.uvs.extend(uvs);
        self.origins.push(origin);
    }

    /// Sets the sharpness of edges and points.
    pub fn set_creases(
        &mut self,
        edges: impl IntoIterator<Item = Crease>,
        points: impl IntoIterator<Item = (u32, f64)>,
    ) {
        self.edges = edges.into_iter().map(|crease| (key(crease.ends), crease.sharpness)).collect();
        self.sharp_points = points.into_iter().collect();
    }

    /// Returns the corners, texture coordinates and original face of each face of a subdivided
    /// mesh, all of whose faces have four corners.
    pub fn quads(&self) -> impl Iterator<Item = ([u32; 4], [[f64; 2]; 4], u32)> {
        let corners = self.corners.as_chunks::<4>().0.iter();
        corners.zip(self.uvs.as_chunks::<4>().0).zip(&self.origins).map(|((c, uv), origin)| (*c, *uv, *origin))
    }

    fn face(&self, face: usize) -> std::ops::Range<usize> {
        let end = self.starts.get(face + 1).copied().unwrap_or(self.corners.len() as u32);
        self.starts[face] as usize..end as usize
    }

    /// Returns the mesh of the next level, in which a face with n corners is split into n faces.
    pub fn subdivided(&self) -> PolygonMesh {
        let faces = self.starts.len();
        let centers: Vec<DVec3> = (0..faces)
            .map(|face| {
                let own = &self.corners[self.face(face)];
                own.iter().map(|point| self.points[*point as usize]).sum::<DVec3>() / own.len() as f64
            })
            .collect();
        let (edges, edge_of_corner) = self.edges(&centers);
        let first_center = self.points.len() as u32;
        let first_edge = first_center + faces as u32;
        let mut next = PolygonMesh { points: self.moved_points(&edges, &centers), ..PolygonMesh::default() };
        next.points.extend(&centers);
        next.points.extend(edges.iter().map(|edge| self.edge_point(edge)));
        for face in 0..faces {
            let range = self.face(face);
            let (start, count) = (range.start, range.len());
            let uvs = &self.uvs[range];
            let mean =
                |parts: &[[f64; 2]]| [0, 1].map(|k| parts.iter().map(|uv| uv[k]).sum::<f64>() / parts.len() as f64);
            let middle = mean(uvs);
            for i in 0..count {
                let (before, after) = ((i + count - 1) % count, (i + 1) % count);
                let corners = [
                    self.corners[start + i],
                    first_edge + edge_of_corner[start + i],
                    first_center + face as u32,
                    first_edge + edge_of_corner[start + before],
                ];
                let uvs = [uvs[i], mean(&[uvs[i], uvs[after]]), middle, mean(&[uvs[before], uvs[i]])];
                next.add_face(&corners, uvs.into_iter(), self.origins[face]);
            }
        }
        for (i, edge) in edges.iter().enumerate().filter(|(_, edge)| edge.faces == 2 && edge.sharpness > 1.0) {
            for end in edge.ends {
                next.edges.insert(key([end, first_edge + i as u32]), edge.sharpness - 1.0);
            }
        }
        let points = self.sharp_points.iter().filter(|(_, sharpness)| **sharpness > 1.0);
        next.sharp_points = points.map(|(point, sharpness)| (*point, sharpness - 1.0)).collect();
        next
    }

    /// Returns the edges, and the edge that begins at each corner.
    fn edges(&self, centers: &[DVec3]) -> (Vec<Edge>, Vec<u32>) {
        let mut numbers = HashMap::with_capacity(self.corners.len());
        let (mut edges, mut of_corner): (Vec<Edge>, _) = (Vec::new(), vec![0; self.corners.len()]);
        for (face, center) in centers.iter().enumerate() {
            let range = self.face(face);
            for corner in range.clone() {
                let after = if corner + 1 == range.end { range.start } else { corner + 1 };
                let ends = key([self.corners[corner], self.corners[after]]);
                let number = *numbers.entry(ends).or_insert_with(|| {
                    let sharpness = self.edges.get(&ends).copied().unwrap_or(0.0);
                    edges.push(Edge { ends, centers: DVec3::ZERO, faces: 0, sharpness });
                    edges.len() as u32 - 1
                });
                edges[number as usize].centers += *center;
                edges[number as usize].faces += 1;
                of_corner[corner] = number;
            }
        }
        // Borders, and edges between more than two faces, are sharp at all levels.
        edges.iter_mut().filter(|edge| edge.faces != 2).for_each(|edge| edge.sharpness = f64::INFINITY);
        (edges, of_corner)
    }

    fn edge_point(&self, edge: &Edge) -> DVec3 {
        let sum = edge.ends.map(|end| self.points[end as usize]).into_iter().sum::<DVec3>();
        let middle = 0.5 * sum;
        if edge.sharpness >= 1.0 {
            return middle;
        }
        let smooth = 0.25 * (sum + edge.centers);
        smooth.lerp(middle, edge.sharpness.max(0.0))
    }

    /// Returns the new positions of the points of this level.
    fn moved_points(&self, edges: &[Edge], centers: &[DVec3]) -> Vec<DVec3> {
        #[derive(Clone, Copy, Default)]
        struct Neighbours {
            /// Sums over the adjacent faces and edges, and their numbers.
            centers: DVec3,
            faces: f64,
            middles: DVec3,
            edges: f64,
            /// Sum of the other ends of sharp edges, their number, and the sum of their sharpness.
            sharp_ends: DVec3,
            sharp: u32,
            sharpness: f64,
        }
        let mut around = vec![Neighbours::default(); self.points.len()];
        for (face, center) in centers.iter().enumerate() {
            for point in &self.corners[self.face(face)] {
                let here = &mut around[*point as usize];
                here.centers += *center;
                here.faces += 1.0;
            }
        }
        for edge in edges {
            let ends = edge.ends.map(|end| self.points[end as usize]);
            for (i, end) in edge.ends.into_iter().enumerate() {
                let here = &mut around[end as usize];
                here.middles += 0.5 * (ends[0] + ends[1]);
                here.edges += 1.0;
                if edge.sharpness > 0.0 {
                    here.sharp_ends += ends[1 - i];
                    here.sharp += 1;
                    here.sharpness += edge.sharpness;
                }
            }
        }
        let moved = |(i, point): (usize, &DVec3)| {
            let here = &around[i];
            let own = self.sharp_points.get(&(i as u32)).copied().unwrap_or(0.0).clamp(0.0, 1.0);
            // A point of a single face is a corner of the border.
            if here.faces < 1.0 || here.sharp > 2 || own >= 1.0 || here.faces == 1.0 && here.sharp == 2 {
                return *point;
            }
            let n = here.edges;
            let smooth = (here.centers / here.faces + 2.0 * here.middles / n + (n - 3.0) * *point) / n;
            let creased = match here.sharp {
                2 => {
                    let crease = 0.75 * *point + 0.125 * here.sharp_ends;
                    smooth.lerp(crease, (0.5 * here.sharpness).min(1.0))
                }
                _ => smooth,
            };
            creased.lerp(*point, own)
        };
        self.points.iter().enumerate().map(moved).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube() -> PolygonMesh {
        let sign = |i: u32, bit: u32| if i >> bit & 1 == 1 { 1.0 } else { -1.0 };
        let mut mesh = PolygonMesh::new((0..8).map(|i| DVec3::new(sign(i, 0), sign(i, 1), sign(i, 2))).collect());
        for (i, face) in
            [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]].iter().enumerate()
        {
            mesh.add_face(face, [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].into_iter(), i as u32);
        }
        mesh
    }

    #[test]
    fn first_level_of_a_cube_has_the_published_points() {
        let next = cube().subdivided();
        assert_eq!((next.points.len(), next.quads().count()), (26, 24));
        // Vertex rule with n = 3: F / 3 + 2 R / 3, with F = 1/3 and R = 2/3 in each coordinate.
        assert!((next.points[7] - DVec3::splat(5.0 / 9.0)).length() < 1e-15, "{}", next.points[7]);
        // Edge rule: the mean of two ends and two centres, (1, 1, 0) * 3/4.
        let edge = DVec3::new(0.75, 0.75, 0.0);
        assert!(next.points.iter().any(|point| (*point - edge).length() < 1e-15));
        let uvs: Vec<_> = next.quads().take(1).map(|(_, uvs, _)| uvs).collect();
        assert_eq!(uvs[0], [[0.0, 0.0], [0.5, 0.0], [0.5, 0.5], [0.0, 0.5]]);
    }

    #[test]
    fn cube_with_sharp_edges_stays_a_cube() {
        let mut mesh = cube();
        let edges: Vec<[u32; 2]> = (0..8).flat_map(|i| [1, 2, 4].map(|bit| [i, i ^ bit])).collect();
        mesh.set_creases(edges.into_iter().map(|ends| Crease { ends, sharpness: f64::INFINITY }), []);
        for _ in 0..3 {
            mesh = mesh.subdivided();
        }
        assert!(mesh.points.iter().all(|point| point.abs().max_element() == 1.0));
    }

    #[test]
    fn border_is_a_b_spline_with_fixed_corners() {
        let mut mesh = PolygonMesh::new((0..4).map(|i| DVec3::new(f64::from(i % 2), f64::from(i / 2), 0.0)).collect());
        mesh.add_face(&[0, 1, 3, 2], [[0.0; 2]; 4].into_iter(), 7);
        let next = mesh.subdivided().subdivided();
        assert_eq!(next.points[..4], mesh.points[..]);
        assert!(next.quads().all(|(_, _, origin)| origin == 7));
        assert!(next.points.iter().all(|point| point.z == 0.0 && point.min_element() >= 0.0));
    }
}
