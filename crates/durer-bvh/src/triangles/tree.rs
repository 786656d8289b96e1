//! What a tree of triangles is, and what it answers with.

use super::height_grid::HeightGrid;
use crate::lanes::{Available, ROOM_OF_ROWS, ROWS, Rows};
use crate::math::{Aabb, Vec2};
use crate::node::{self, WideNode};
use crate::watertight::WatertightRay;
use glam::Vec3A;
use std::mem::MaybeUninit;
use std::sync::{Arc, OnceLock};

/// Where a ray meets a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleHit {
    /// Position along the ray, in units of the length of its direction.
    pub t: f32,
    /// The second and third barycentric coordinate: the point is (1 - u - v) a + u b + v c.
    pub uv: Vec2,
    /// Number of the triangle.
    pub triangle: u32,
}

/// A bounding volume hierarchy over triangles, for use without any scene.
///
/// A ray counts as moved by an infinitesimal across itself, so that it crosses exactly one of the
/// triangles around an edge or a vertex: no ray slips through a closed mesh, and
/// [`TriangleBvh::hit_count`] is exact. Triangles are met from both sides. Of hits at the same `t`
/// the one of least number is the closest. All answers are the same, bit for bit, for all
/// qualities, SIMD levels, and numbers of threads.
///
/// A ray that is NaN or infinite, or without direction, hits nothing; directions need not be of
/// length 1.
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
    /// For each leaf [`ROWS`] rows, each of as many numbers as it has triangles: their corners by
    /// axis, and their numbers, as bits. A leaf's room behind the last.
    pub(super) leaves: Vec<f32>,
    pub(super) bounds: Aabb,
    /// The greatest coordinate, without signs.
    pub(super) reach: f32,
    pub(super) level: Available,
    pub(super) least_volume: f64,
    /// Whether that is more than nothing.
    pub(super) culls_slivers: bool,
    /// How many triangles it was built over.
    pub(super) count: usize,
    /// For each triangle a leaf that holds it, once that was asked for.
    pub(super) leaf_of: OnceLock<Vec<u32>>,
    /// What leaves are made of whose rows are not in memory.
    pub(super) heights: Option<Arc<HeightGrid>>,
}

/// The side of a triangle that a ray meets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Facing {
    /// The side from which its corners go counter-clockwise: (b - a) x (c - a) points towards the
    /// ray's origin.
    Front,
    /// The other.
    Back,
}

impl Facing {
    /// Of a triangle that is crossed, by the exact signs that say that it is: so along a ray the
    /// sides of a closed mesh alternate.
    #[inline]
    pub(super) fn of(ray: &WatertightRay, corners: [Vec3A; 3]) -> Self {
        if ray.is_front(corners) { Facing::Front } else { Facing::Back }
    }

    /// The other side, if something is so.
    pub(crate) fn turned_if(self, turned: bool) -> Self {
        match (self, turned) {
            (side, false) => side,
            (Facing::Front, true) => Facing::Back,
            (Facing::Back, true) => Facing::Front,
        }
    }
}

impl TriangleBvh {
    /// Of nodes and leaves over so many triangles.
    pub(super) fn of(nodes: Vec<WideNode>, leaves: Vec<f32>, bounds: Aabb, count: usize) -> Self {
        TriangleBvh {
            nodes,
            leaves,
            bounds,
            reach: bounds.reach(),
            level: Available::chosen(),
            least_volume: 0.0,
            culls_slivers: false,
            count,
            leaf_of: OnceLock::new(),
            heights: None,
        }
    }

    /// The rows of a leaf, and the count of its triangles. Rows that are not in memory are written
    /// into the room.
    #[inline(always)]
    pub(super) fn rows<'a>(&'a self, leaf: u32, room: &'a mut MaybeUninit<Rows>) -> (&'a Rows, usize) {
        let (first, count) = node::items(leaf);
        // Leaves have a leaf's room behind them, and blocks of heights have greater numbers.
        let rows = match self.leaves.get(ROWS * first..) {
            Some(rest) => rest.first_chunk(),
            None => None,
        };
        match rows {
            Some(rows) => (rows, count),
            None => (self.block(first, room), count),
        }
    }

    /// The rows of a block of heights.
    #[inline(never)]
    fn block<'a>(&self, first: usize, room: &'a mut MaybeUninit<Rows>) -> &'a Rows {
        let Some(heights) = &self.heights else { unreachable!("all leaves have rows") };
        let rows = room.write([0.0; ROOM_OF_ROWS]);
        heights.write_rows(first - self.first_block(), rows);
        rows
    }
}
