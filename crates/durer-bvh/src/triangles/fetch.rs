//! Bringing nodes and leaves near before a ray comes to them.

use super::tree::TriangleBvh;
use crate::lanes::{Lanes, ROWS};
use crate::node;

/// So many lines of memory are a child: a node has four and a leaf up to six.
pub const ITSELF: usize = 6;
/// What lies behind it is its siblings, which are likely to be visited too where nothing else is on
/// its way. How many lines pay was found by measurement.
pub const AND_SIBLINGS: usize = 12;

/// Where nodes and leaves are in memory.
#[derive(Clone, Copy)]
pub(super) struct Places {
    nodes_and_leaves: [*const u8; 2],
}

impl Places {
    #[inline(always)]
    pub fn new(bvh: &TriangleBvh) -> Self {
        Places { nodes_and_leaves: [bvh.nodes.as_ptr().cast(), bvh.leaves.as_ptr().cast()] }
    }

    /// Has so many lines of a child brought near.
    #[inline(always)]
    pub fn fetch<L: Lanes, const LINES: usize>(&self, lanes: L, child: u32) {
        const SIZES: [usize; 2] = [node::UNIT, ROWS * size_of::<f32>()];
        // A node's address has more digits. Behind the first 2 GiB of nodes what is fetched is of
        // no use, and does no harm.
        let (kind, at) = ((child >> 31) as usize, node::items(child).0);
        let from = self.nodes_and_leaves[kind].wrapping_add(SIZES[kind].wrapping_mul(at));
        for line in 0..LINES {
            lanes.prefetch(from.wrapping_add(64 * line));
        }
    }
}
