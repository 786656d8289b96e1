//! The eight-wide node.

use crate::math::Aabb;

/// So many children has a node, and so many lanes a vector.
pub const WIDTH: usize = 8;

/// No leaf of a tree lies deeper than this: it bounds the stack of a walk.
pub(super) const MAX_DEPTH: usize = 160;

/// Boxes of up to eight children, side by side. Those that are not there have empty boxes, which no
/// ray meets.
///
/// Children lie in order along one axis, so that for a ray they are roughly from near to far, or
/// from far to near.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct WideNode {
    /// By axis: lower sides, upper sides.
    pub planes: [[[f32; WIDTH]; 2]; 3],
    /// An inner child's [`node_offset`]; or [`LEAF`], the count less one shifted by
    /// [`COUNT_SHIFT`], and the first item.
    pub children: [u32; WIDTH],
    /// For each octant of directions, numbered by
    /// [`TraversalRay::negative`](super::traverse::TraversalRay::negative), a bit: whether rays
    /// take the children from the last to the first. First for those that want the nearest, then
    /// for those to which any hit will do.
    pub from_last: [u32; 2],
    /// The address of the first inner child, if there is one; the others lie behind it, in any
    /// order.
    pub first: u32,
    /// What a ray must know of the child that is next: its place in the bits of [`PLACE`], and
    /// [`IS_LEAF`] or, in the bits of [`BEHIND`], how far behind the first inner child it begins.
    /// So few bits that they take the place of the last ones of a distance.
    pub child_tags: [u8; WIDTH],
}

/// As many bytes as lie between the orders in the walk's table, in which they are then found
/// without arithmetic.
pub(super) const FROM_LAST: u32 = size_of::<[[u8; WIDTH]; 1 << WIDTH]>() as u32;

/// Of a [tag](WideNode::child_tags) the child's place.
pub(super) const PLACE: u32 = WIDTH as u32 - 1;
/// Of a code whether the child is a leaf.
pub(super) const IS_LEAF: u32 = 8;
/// Of a code how far behind the first inner child another one's address is.
pub(super) const BEHIND: u32 = PLACE * UNITS as u32;
const _: () = assert!(BEHIND & (PLACE | IS_LEAF) == 0 && BEHIND < 256);

pub(super) const LEAF: u32 = 1 << 31;
const COUNT_SHIFT: u32 = 28;
const FIRST_MASK: u32 = (1 << COUNT_SHIFT) - 1;
/// A tree holds at most so many items: so many are counted in the bits of a first one.
pub(super) const MAX_ITEMS: usize = FIRST_MASK as usize;
/// A leaf holds at most so many.
pub(super) const LEAF_SIZE: usize = 8;

impl WideNode {
    pub const EMPTY: WideNode = WideNode {
        planes: [[[f32::INFINITY; WIDTH], [f32::NEG_INFINITY; WIDTH]]; 3],
        children: [LEAF; WIDTH],
        from_last: [0; 2],
        first: 0,
        child_tags: [0; WIDTH],
    };

    /// Sets a child; where it is an inner one, the [`first`](WideNode::first) must be known.
    pub fn set(&mut self, place: usize, bounds: Aabb, child: u32) {
        for axis in 0..3 {
            self.planes[axis][0][place] = bounds.min[axis];
            self.planes[axis][1][place] = bounds.max[axis];
        }
        self.children[place] = child;
        let rest = if child & LEAF == 0 { child - self.first } else { IS_LEAF };
        assert!(rest == IS_LEAF || rest & !BEHIND == 0, "inner children lie side by side");
        self.child_tags[place] = (place as u32 | rest) as u8;
    }

    /// The box of a child; empty where there is none.
    pub fn bounds(&self, place: usize) -> Aabb {
        let side = |side: usize| std::array::from_fn::<f32, 3, _>(|axis| self.planes[axis][side][place]).into();
        Aabb { min: side(0), max: side(1) }
    }

    /// [`FROM_LAST`] if rays of an octant take the children from the last to the first, else 0:
    /// those to which `any` hit will do, or the others.
    #[inline(always)]
    pub fn order(&self, any: bool, octant: u32) -> u32 {
        self.from_last[usize::from(any)] << (FROM_LAST.trailing_zeros() - (octant & 7)) & FROM_LAST
    }

    /// The children that are there: place, box, and child.
    pub fn children(&self) -> impl Iterator<Item = (usize, Aabb, u32)> {
        let all = (0..WIDTH).map(|place| (place, self.bounds(place), self.children[place]));
        all.filter(|(_, bounds, _)| bounds.min.x <= bounds.max.x)
    }
}

/// Addresses of nodes are in units of so many bytes: the most that the processor multiplies an
/// index by.
pub(super) const UNIT: usize = 8;
/// So many units are a node.
pub(super) const UNITS: usize = size_of::<WideNode>() / UNIT;
/// A tree has at most so many nodes.
pub(super) const MAX_NODES: usize = LEAF as usize / UNITS;
const _: () = assert!(UNITS.is_power_of_two() && MAX_NODES <= 1 << (32 - UNITS.trailing_zeros()));

/// How far behind the first a node begins, in units of [`UNIT`] bytes. Memory is then found without
/// arithmetic, for which every ray would wait at every node.
pub(super) fn node_offset(number: usize) -> u32 {
    assert!(number < MAX_NODES, "a tree has at most 2^26 nodes");
    (number * UNITS) as u32
}

/// The number of the node at an address.
#[inline(always)]
pub(super) fn number(address: u32) -> usize {
    address as usize / UNITS
}

pub(super) fn leaf(first: usize, count: usize) -> u32 {
    debug_assert!((1..=LEAF_SIZE).contains(&count) && first < MAX_ITEMS);
    LEAF | ((count - 1) as u32) << COUNT_SHIFT | first as u32
}

/// First item and count of a leaf.
#[inline(always)]
pub(super) fn items(leaf: u32) -> (usize, usize) {
    ((leaf & FIRST_MASK) as usize, ((leaf & !LEAF) >> COUNT_SHIFT) as usize + 1)
}

/// Makes boxes fit things that have moved, by the box around the things of a leaf.
pub(super) fn refit(nodes: &mut [WideNode], leaf_bounds: impl Fn(u32) -> Aabb) {
    // Children come after their parents, so boxes are right from the end.
    for parent in (0..nodes.len()).rev() {
        let children: Vec<(usize, Aabb, u32)> = nodes[parent].children().collect();
        for (place, _, child) in children {
            let bounds = match child & LEAF {
                0 => nodes[number(child)].children().fold(Aabb::EMPTY, |b, (_, c, _)| b.union(c)),
                _ => leaf_bounds(child),
            };
            // Where nothing can be hit for now, the old box keeps the place.
            if !bounds.is_empty() {
                nodes[parent].set(place, bounds, child);
            }
        }
    }
}

/// The box around everything.
pub(super) fn bounds(nodes: &[WideNode]) -> Aabb {
    nodes.first().map_or(Aabb::EMPTY, |root| root.children().fold(Aabb::EMPTY, |b, c| b.union(c.1)))
}

/// Cost of a random ray through the bounds by the surface area heuristic, in tests of a node, where
/// a leaf costs as much.
pub(super) fn cost(nodes: &[WideNode], bounds: Aabb) -> f64 {
    let root = f64::from(bounds.half_area());
    let children = nodes.iter().flat_map(|node| node.children());
    1.0 + children.map(|(_, bounds, _)| f64::from(bounds.half_area()) / root).sum::<f64>()
}
