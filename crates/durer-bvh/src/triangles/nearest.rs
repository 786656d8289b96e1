//! Closest-point queries on a mesh.

use super::rows::number;
use super::tree::TriangleBvh;
use crate::lanes::{ROWS, Rows, WIDTH};
use crate::math::Vec3;
use crate::node::{self, LEAF, WideNode};
use glam::DVec3;
use std::mem::MaybeUninit;

/// Point on a mesh that is nearest to a query point, as returned by [`TriangleBvh::nearest_point`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearestPoint {
    /// Distance from the query point.
    pub distance: f64,
    /// Position of the point.
    pub point: DVec3,
    /// Second and third barycentric coordinates: the point is (1 - u - v) a + u b + v c.
    pub uv: [f64; 2],
    /// Number of the triangle.
    pub triangle: u32,
}

/// Factor by which distances to boxes are multiplied. It reduces the distances by much more than
/// their rounding error, so that the result does not depend on the boxes of the tree.
const SLACK: f64 = 1.0 - 1e-12;

impl TriangleBvh {
    /// Finds the point on the triangles that is nearest to `point` if its distance is at most
    /// `within`. If several triangles are at the same distance, the one with the lowest number is
    /// chosen. The computation is in double precision, and the result has the same bits for all
    /// build qualities.
    ///
    /// ```
    /// use durer_bvh::{BuildQuality, TriangleBvh};
    /// use durer_bvh::math::Vec3;
    ///
    /// let corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
    /// let tree = TriangleBvh::build(&corners, &[[0, 1, 2]], BuildQuality::Best);
    /// let near = tree.nearest_point(Vec3::new(0.25, 0.5, 3.0), f64::INFINITY).unwrap();
    /// assert_eq!((near.distance, near.uv), (3.0, [0.25, 0.5]));
    /// assert_eq!(tree.nearest_point(Vec3::splat(9.0), 1.0), None);
    /// ```
    pub fn nearest_point(&self, point: Vec3, within: f64) -> Option<NearestPoint> {
        let mut best = NearestSoFar { squared: within * within, found: None };
        if self.nodes.is_empty() || !point.is_finite() || within.is_nan() || within < 0.0 {
            return None;
        }
        let point = point.as_dvec3();
        let mut stack: Vec<(f64, u32)> = Vec::with_capacity(64);
        stack.push((0.0, 0));
        while let Some((squared, child)) = stack.pop() {
            if squared > best.squared {
                continue;
            }
            if child & LEAF == 0 {
                let node = &self.nodes[node::node_index(child)];
                let (squares, first) = (squares(node, point), stack.len());
                let near = (0..WIDTH).filter(|&i| squares[i] <= best.squared && squares[i] < f64::INFINITY);
                stack.extend(near.map(|i| (squares[i], node.children[i])));
                // The nearest child is visited next.
                stack[first..].sort_unstable_by(|a, b| b.0.total_cmp(&a.0));
            } else {
                let mut room = MaybeUninit::uninit();
                let (rows, count) = self.rows(child, &mut room);
                (0..count).for_each(|lane| best.offer(point, corners(rows, count, lane), number(rows, count, lane)));
            }
        }
        best.found.map(|(point, uv, triangle)| NearestPoint { distance: best.squared.sqrt(), point, uv, triangle })
    }
}

/// Returns the squared distances from `point` to the boxes of a node, slightly reduced. They are
/// infinite for unused slots.
fn squares(node: &WideNode, point: DVec3) -> [f64; WIDTH] {
    let mut squares = [0.0; WIDTH];
    for (axis, [lower, upper]) in node.planes.iter().enumerate() {
        for (square, (low, high)) in squares.iter_mut().zip(lower.iter().zip(upper)) {
            let beside = (f64::from(*low) - point[axis]).max(point[axis] - f64::from(*high)).max(0.0);
            *square += beside * beside;
        }
    }
    squares.map(|square| square * SLACK)
}

fn corners(rows: &Rows, count: usize, lane: usize) -> [DVec3; 3] {
    debug_assert!(lane < count && count * ROWS <= rows.len());
    let at = |row: usize| f64::from(rows[row * count + lane]);
    [0, 3, 6].map(|row| DVec3::new(at(row), at(row + 1), at(row + 2)))
}

/// Nearest point that a closest-point query has found so far, and its squared distance.
struct NearestSoFar {
    squared: f64,
    found: Option<(DVec3, [f64; 2], u32)>,
}

impl NearestSoFar {
    fn offer(&mut self, point: DVec3, corners: [DVec3; 3], triangle: u32) {
        let (squared, nearest, uv) = nearest_of(point, corners);
        // Corners with NaN give a NaN distance, and comparing it as less returns false.
        let is_first = self.found.is_none_or(|(.., known)| triangle < known);
        if squared < self.squared || squared == self.squared && is_first {
            *self = NearestSoFar { squared, found: Some((nearest, uv, triangle)) };
        }
    }
}

/// Returns the nearest point of a triangle: its squared distance, its position, and its second and
/// third barycentric coordinates.
///
/// The nearest point is the foot of the perpendicular if that is in the triangle. Otherwise, it is
/// the nearest point on an edge. Triangles without area do not need a special case.
fn nearest_of(point: DVec3, [a, b, c]: [DVec3; 3]) -> (f64, DVec3, [f64; 2]) {
    let (ab, ac, from) = (b - a, c - a, point - a);
    let at = |[u, v]: [f64; 2]| {
        let nearest = a + u * ab + v * ac;
        ((point - nearest).length_squared(), nearest, [u, v])
    };
    let normal = ab.cross(ac);
    let area = normal.length_squared();
    let [u, v] = [from.cross(ac).dot(normal), ab.cross(from).dot(normal)];
    if area > 0.0 && u >= 0.0 && v >= 0.0 && u + v <= area {
        return at([u / area, v / area]);
    }
    // Returns the parameter of the nearest point on an edge, in [0, 1].
    let along = |from: DVec3, edge: DVec3| match edge.length_squared() {
        0.0 => 0.0,
        square => (from.dot(edge) / square).clamp(0.0, 1.0),
    };
    let (s, t, r) = (along(from, ab), along(point - b, c - b), along(from, ac));
    let edges = [at([s, 0.0]), at([1.0 - t, t]), at([0.0, r])];
    let nearer = |x: (f64, _, _), y: (f64, _, _)| if y.0 < x.0 { y } else { x };
    nearer(nearer(edges[0], edges[1]), edges[2])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::BuildQuality;
    use crate::math::random::Random;
    use crate::triangles::tests::{Mesh, bars, soup, torus};

    fn brute_force((vertices, triangles): &Mesh, point: Vec3, within: f64) -> Option<NearestPoint> {
        let mut best = NearestSoFar { squared: within * within, found: None };
        for (i, triangle) in triangles.iter().enumerate() {
            best.offer(point.as_dvec3(), triangle.map(|i| vertices[i as usize].as_dvec3()), i as u32);
        }
        best.found.map(|(point, uv, triangle)| NearestPoint { distance: best.squared.sqrt(), point, uv, triangle })
    }

    #[test]
    fn trees_find_what_brute_force_finds() {
        let mut random = Random(31);
        let flat: Vec<Vec3> = (0..90).map(|_| random.point()).collect();
        let flat: Mesh = (flat, (0..90).map(|i| [i, (7 * i) % 90, i]).collect());
        for mesh in [soup(&mut random, 800, 0.2), bars(&mut random, 300, 40), torus(30, 12), flat] {
            for quality in BuildQuality::NAMES {
                let tree = TriangleBvh::build(&mesh.0, &mesh.1, quality.1);
                for i in 0..300 {
                    let corner = mesh.0[random.below(mesh.0.len())];
                    let point = [corner, corner + 1e-3 * random.point(), 3.0 * random.point()][i % 3];
                    let within = if i % 2 == 0 { f64::INFINITY } else { 0.2 };
                    let (found, wanted) = (tree.nearest_point(point, within), brute_force(&mesh, point, within));
                    assert_eq!(found, wanted, "{point} within {within}");
                }
            }
        }
    }

    #[test]
    fn distances_to_a_torus_match_its_formula() {
        let (vertices, triangles) = torus(200, 100);
        let tree = TriangleBvh::build(&vertices, &triangles, BuildQuality::default());
        let mut random = Random(32);
        for _ in 0..500 {
            let p = (1.5 * random.point()).as_dvec3();
            let around = DVec3::new(p.x, p.z, 0.0).length() - 0.7;
            let exact = (DVec3::new(around, p.y, 0.0).length() - 0.3).abs();
            let near = tree.nearest_point(p.as_vec3(), f64::INFINITY).unwrap();
            // The mesh lies inside the torus. Its distance from the torus is at most the sagittas
            // of its edges: 0.3 (1 - cos(pi / 100)) and 1 - cos(pi / 200).
            assert!((near.distance - exact).abs() < 3e-4, "{p}: {} {exact}", near.distance);
            assert!((near.point.distance(p) - near.distance).abs() < 1e-6);
        }
    }

    #[test]
    fn nan_points_have_no_nearest_point() {
        let tree = TriangleBvh::build(&[Vec3::ZERO, Vec3::X, Vec3::Y], &[[0, 1, 2]], BuildQuality::Fast);
        for point in [Vec3::NAN, Vec3::INFINITY] {
            assert_eq!(tree.nearest_point(point, f64::INFINITY), None);
        }
        assert_eq!(tree.nearest_point(Vec3::ZERO, f64::NAN), None);
        assert_eq!(tree.nearest_point(Vec3::ZERO, 0.0).map(|near| near.distance), Some(0.0));
        let holes = [Vec3::NAN, Vec3::X, Vec3::Y];
        assert_eq!(TriangleBvh::build(&holes, &[[0, 1, 2]], BuildQuality::Fast).nearest_point(Vec3::ZERO, 9.0), None);
        assert_eq!(TriangleBvh::build(&[], &[], BuildQuality::Fast).nearest_point(Vec3::ZERO, 9.0), None);
    }
}
