//! Prefetches nodes and leaves.

use super::tree::TriangleBvh;
use crate::lanes::{Lanes, ROWS};
use crate::node;

/// Number of cache lines to prefetch for a single child. A node has four, and a leaf has up to six.
pub const CHILD_LINES: usize = 6;
/// Number of cache lines to prefetch if siblings, which follow the child in memory, will probably
/// be visited as well. The value was tuned by measurement.
pub const SIBLING_LINES: usize = 12;

/// Addresses of the nodes and leaves of a [`TriangleBvh`], for prefetching.
#[derive(Clone, Copy)]
pub(super) struct PrefetchAddresses {
    nodes_and_leaves: [*const u8; 2],
}

impl PrefetchAddresses {
    #[inline(always)]
    pub fn new(bvh: &TriangleBvh) -> Self {
        PrefetchAddresses { nodes_and_leaves: [bvh.nodes.as_ptr().cast(), bvh.leaves.as_ptr().cast()] }
    }

    /// Prefetches `LINES` cache lines of a child.
    #[inline(always)]
    pub fn fetch<L: Lanes, const LINES: usize>(&self, lanes: L, child: u32) {
        const SIZES: [usize; 2] = [node::UNIT, ROWS * size_of::<f32>()];
        // `items` drops the highest bits of a node's offset. For nodes beyond the first 2 GiB, a
        // wrong address is therefore prefetched, which is harmless.
        let (kind, at) = ((child >> 31) as usize, node::items(child).0);
        let from = self.nodes_and_leaves[kind].wrapping_add(SIZES[kind].wrapping_mul(at));
        for line in 0..LINES {
            lanes.prefetch(from.wrapping_add(64 * line));
        }
    }
}
