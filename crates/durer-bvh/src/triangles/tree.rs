//! [`TriangleBvh`], and the hits that its queries return.

use super::height_grid::HeightGrid;
use crate::lanes::{AvailableLevel, ROWS, ROWS_LEN, Rows};
use crate::math::{Aabb, Vec2};
use crate::node::{self, WideNode};
use crate::watertight::WatertightRay;
use glam::Vec3A;
use std::mem::MaybeUninit;
use std::sync::{Arc, OnceLock};

/// Intersection of a ray with a triangle of a mesh, as returned by the queries of [`TriangleBvh`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleHit {
    /// Position along the ray, in units of the length of its direction.
    pub t: f32,
    /// Second and third barycentric coordinates: the point is (1 - u - v) a + u b + v c.
    pub uv: Vec2,
    /// Number of the triangle.
    pub triangle: u32,
}

/// A bounding volume hierarchy that stores the triangles of a mesh. It can be used without a scene.
///
/// A ray through an edge or a vertex crosses exactly one of the triangles that meet there, as if it
/// were shifted sideways by an infinitesimal distance. No ray passes through a gap in a closed
/// mesh, and [`TriangleBvh::hit_count`] is exact. Triangles are hit from both sides. If several
/// hits have the same `t`, the one with the lowest triangle number counts as the closest. All
/// results have the same bits for all build qualities, SIMD levels, and numbers of threads.
///
/// A ray that contains NaN or infinity, or that has no direction, hits nothing. Directions do not
/// have to have length 1.
///
/// ```
/// use durer_bvh::{BuildQuality, TriangleBvh};
/// use durer_bvh::math::{Ray, Vec3};
///
/// let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
/// let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// let tree = TriangleBvh::build(&vertices, &triangles, BuildQuality::default());
/// let ray = Ray::new(Vec3::new(0.2, 0.2, -1.0), Vec3::Z);
/// let hit = tree.closest(&ray).unwrap();
/// assert_eq!((hit.t, hit.triangle), (1.0, 0));
/// assert!(tree.occluded(&ray));
/// assert_eq!(tree.hit_count(&ray), 2);
/// ```
#[derive(Clone, Debug)]
pub struct TriangleBvh {
    pub(super) nodes: Vec<WideNode>,
    /// Triangles in the leaves. A leaf has [`ROWS`] rows, each as long as its number of triangles.
    /// They hold the coordinates of the corners, and then the triangle numbers as bit patterns. The
    /// list has padding as long as a leaf at its end.
    pub(super) leaves: Vec<f32>,
    pub(super) bounds: Aabb,
    /// Largest absolute value of any coordinate.
    pub(super) reach: f32,
    pub(super) level: AvailableLevel,
    pub(super) min_volume: f64,
    /// True if `min_volume` is not zero.
    pub(super) culls_slivers: bool,
    /// Number of triangles when the tree was built.
    pub(super) count: usize,
    /// For each triangle number, a leaf that contains the triangle. The list is computed on first
    /// use.
    pub(super) leaf_of: OnceLock<Vec<u32>>,
    /// Grid that provides the leaves whose rows are not in memory.
    pub(super) heights: Option<Arc<HeightGrid>>,
}

/// Side of a triangle that a ray hits, passed to filters of ray queries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Facing {
    /// Side from which the corners appear in counter-clockwise order, so that (b - a) x (c - a)
    /// points towards the origin of the ray.
    Front,
    /// Opposite side.
    Back,
}

impl Facing {
    /// Returns the side of a triangle that the ray crosses. This method uses the exact signs of the
    /// crossing test, so the sides of a closed mesh alternate along a ray.
    #[inline]
    pub(super) fn of(ray: &WatertightRay, corners: [Vec3A; 3]) -> Self {
        if ray.is_front(corners) { Facing::Front } else { Facing::Back }
    }

    /// Flips the side if `turned` is true.
    pub(crate) fn turned_if(self, turned: bool) -> Self {
        match (self, turned) {
            (side, false) => side,
            (Facing::Front, true) => Facing::Back,
            (Facing::Back, true) => Facing::Front,
        }
    }
}

impl TriangleBvh {
    /// Creates a tree from nodes and leaves over `count` triangles.
    pub(super) fn of(nodes: Vec<WideNode>, leaves: Vec<f32>, bounds: Aabb, count: usize) -> Self {
        TriangleBvh {
            nodes,
            leaves,
            bounds,
            reach: bounds.max_abs_coordinate(),
            level: AvailableLevel::chosen(),
            min_volume: 0.0,
            culls_slivers: false,
            count,
            leaf_of: OnceLock::new(),
            heights: None,
        }
    }

    /// Returns the rows of a leaf and its number of triangles. Rows that are not in memory are
    /// written to `room`.
    #[inline(always)]
    pub(super) fn rows<'a>(&'a self, leaf: u32, room: &'a mut MaybeUninit<Rows>) -> (&'a Rows, usize) {
        let (first, count) = node::items(leaf);
        // The padding makes the slice long enough for any leaf in memory. Blocks of heights have
        // higher item numbers.
        let rows = match self.leaves.get(ROWS * first..) {
            Some(rest) => rest.first_chunk(),
            None => None,
        };
        match rows {
            Some(rows) => (rows, count),
            None => (self.block(first, room), count),
        }
    }

    /// Writes the rows of a block of heights.
    #[inline(never)]
    fn block<'a>(&self, first: usize, room: &'a mut MaybeUninit<Rows>) -> &'a Rows {
        let Some(heights) = &self.heights else { unreachable!("all leaves have rows") };
        let rows = room.write([0.0; ROWS_LEN]);
        heights.write_rows(first - self.first_block(), rows);
        rows
    }
}
