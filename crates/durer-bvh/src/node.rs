//! Tree nodes with eight children, and their encoding.

use crate::math::Aabb;

/// Number of children of a node, and number of lanes of a vector.
pub const WIDTH: usize = 8;

/// Maximum depth of a leaf. It bounds the size of the traversal stack.
pub(super) const MAX_DEPTH: usize = 160;

/// Node of a BVH that holds the boxes of up to eight children. The boxes are stored plane by plane
/// for SIMD box tests. Unused slots have empty boxes, which no ray hits.
///
/// Children are sorted along one axis, so for any ray their order is approximately from near to far
/// or from far to near.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct WideNode {
    /// Lower and upper planes of the boxes, for each axis.
    pub planes: [[[f32; WIDTH]; 2]; 3],
    /// Codes of the children. The code of an inner node is its [`node_offset`]. The code of a leaf
    /// combines [`LEAF`], the item count minus one shifted by [`COUNT_SHIFT`], and the number of
    /// the first item.
    pub children: [u32; WIDTH],
    /// One bit for each octant of ray directions, numbered by
    /// [`TraversalRay::negative`](super::traverse::TraversalRay::negative). A bit is set if rays of
    /// that octant visit the children from last to first. The first entry is for closest-hit rays,
    /// and the second is for any-hit rays.
    pub reversed_octants: [u32; 2],
    /// Offset of the first inner child, if there is one. The other inner children follow it in any
    /// order.
    pub first: u32,
    /// Tags of the children. The bits of [`SLOT_BITS`] hold the child's slot. The bit [`IS_LEAF`]
    /// is set for leaves. For an inner node, the bits of [`OFFSET_BITS`] hold its distance from the
    /// first inner child. A tag has only eight bits, so it can replace the last bits of an entry
    /// distance.
    pub child_tags: [u8; WIDTH],
}

/// Number of bytes between the two orders in the traversal's lookup table. With this distance, a
/// lookup needs no arithmetic.
pub(super) const REVERSED: u32 = size_of::<[[u8; WIDTH]; 1 << WIDTH]>() as u32;

/// Bits of a [tag](WideNode::child_tags) that hold the child's slot.
pub(super) const SLOT_BITS: u32 = WIDTH as u32 - 1;
/// Bit of a tag that marks a leaf.
pub(super) const IS_LEAF: u32 = 8;
/// Bits of a tag that hold the child's distance from the first inner child.
pub(super) const OFFSET_BITS: u32 = SLOT_BITS * UNITS as u32;
const _: () = assert!(OFFSET_BITS & (SLOT_BITS | IS_LEAF) == 0 && OFFSET_BITS < 256);

pub(super) const LEAF: u32 = 1 << 31;
const COUNT_SHIFT: u32 = 28;
const FIRST_MASK: u32 = (1 << COUNT_SHIFT) - 1;
/// Maximum number of items in a tree. It is limited by the number of bits for the first item of a
/// leaf.
pub(super) const MAX_ITEMS: usize = FIRST_MASK as usize;
/// Maximum number of items in a leaf.
pub(super) const LEAF_SIZE: usize = 8;

impl WideNode {
    pub const EMPTY: WideNode = WideNode {
        planes: [[[f32::INFINITY; WIDTH], [f32::NEG_INFINITY; WIDTH]]; 3],
        children: [LEAF; WIDTH],
        reversed_octants: [0; 2],
        first: 0,
        child_tags: [0; WIDTH],
    };

    /// Sets a child. For an inner child, [`first`](WideNode::first) must already be set.
    pub fn set(&mut self, slot: usize, bounds: Aabb, child: u32) {
        for axis in 0..3 {
            self.planes[axis][0][slot] = bounds.min[axis];
            self.planes[axis][1][slot] = bounds.max[axis];
        }
        self.children[slot] = child;
        let rest = if child & LEAF == 0 { child - self.first } else { IS_LEAF };
        assert!(rest == IS_LEAF || rest & !OFFSET_BITS == 0, "inner children are consecutive");
        self.child_tags[slot] = (slot as u32 | rest) as u8;
    }

    /// Returns the bounding box of a child. It is empty for an unused slot.
    pub fn bounds(&self, slot: usize) -> Aabb {
        let side = |side: usize| std::array::from_fn::<f32, 3, _>(|axis| self.planes[axis][side][slot]).into();
        Aabb { min: side(0), max: side(1) }
    }

    /// Returns [`REVERSED`] if rays of an octant visit the children from last to first, and 0
    /// otherwise. `any` selects the order for any-hit rays.
    #[inline(always)]
    pub fn order(&self, any: bool, octant: u32) -> u32 {
        self.reversed_octants[usize::from(any)] << (REVERSED.trailing_zeros() - (octant & 7)) & REVERSED
    }

    /// Iterates over the slot, box, and code of each child in use.
    pub fn children(&self) -> impl Iterator<Item = (usize, Aabb, u32)> {
        let all = (0..WIDTH).map(|slot| (slot, self.bounds(slot), self.children[slot]));
        all.filter(|(_, bounds, _)| bounds.min.x <= bounds.max.x)
    }
}

/// Unit of node offsets in bytes, which is the largest factor by which the processor can scale an
/// index.
pub(super) const UNIT: usize = 8;
/// Size of a node in units.
pub(super) const UNITS: usize = size_of::<WideNode>() / UNIT;
/// Maximum number of nodes in a tree.
pub(super) const MAX_NODES: usize = LEAF as usize / UNITS;
const _: () = assert!(UNITS.is_power_of_two() && MAX_NODES <= 1 << (32 - UNITS.trailing_zeros()));

/// Returns the offset of a node from the first node, in units of [`UNIT`] bytes. The address of the
/// node then needs no arithmetic, which would delay every ray at every node.
pub(super) fn node_offset(number: usize) -> u32 {
    assert!(number < MAX_NODES, "a tree has at most 2^26 nodes");
    (number * UNITS) as u32
}

/// Returns the number of the node at an offset.
#[inline(always)]
pub(super) fn node_index(address: u32) -> usize {
    address as usize / UNITS
}

/// Returns the code of a leaf with `count` items, starting at item `first`; see
/// [`WideNode::children`].
pub(super) fn leaf(first: usize, count: usize) -> u32 {
    debug_assert!((1..=LEAF_SIZE).contains(&count) && first < MAX_ITEMS);
    LEAF | ((count - 1) as u32) << COUNT_SHIFT | first as u32
}

/// Returns the first item and the item count of a leaf.
#[inline(always)]
pub(super) fn items(leaf: u32) -> (usize, usize) {
    ((leaf & FIRST_MASK) as usize, ((leaf & !LEAF) >> COUNT_SHIFT) as usize + 1)
}

/// Refits all boxes of a tree after primitives have moved. `leaf_bounds` returns the box of a
/// leaf's primitives.
pub(super) fn refit(nodes: &mut [WideNode], leaf_bounds: impl Fn(u32) -> Aabb) {
    // Children come after their parents, so the boxes below a node are final by the time the loop
    // reaches it.
    for parent in (0..nodes.len()).rev() {
        let children: Vec<(usize, Aabb, u32)> = nodes[parent].children().collect();
        for (slot, _, child) in children {
            let bounds = match child & LEAF {
                0 => nodes[node_index(child)].children().fold(Aabb::EMPTY, |b, (_, c, _)| b.union(c)),
                _ => leaf_bounds(child),
            };
            // A child with an empty box keeps its old bounds.
            if !bounds.is_empty() {
                nodes[parent].set(slot, bounds, child);
            }
        }
    }
}

/// Returns the bounding box of the tree.
pub(super) fn bounds(nodes: &[WideNode]) -> Aabb {
    nodes.first().map_or(Aabb::EMPTY, |root| root.children().fold(Aabb::EMPTY, |b, c| b.union(c.1)))
}

/// Returns the expected cost, in node tests, of a random ray through the bounds, by the surface
/// area heuristic. A leaf is assumed to cost as much as a node.
pub(super) fn cost(nodes: &[WideNode], bounds: Aabb) -> f64 {
    let root = f64::from(bounds.half_area());
    let children = nodes.iter().flat_map(|node| node.children());
    1.0 + children.map(|(_, bounds, _)| f64::from(bounds.half_area()) / root).sum::<f64>()
}
