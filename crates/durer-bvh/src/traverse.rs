//! Traverses a tree with a ray. Closest-hit rays visit the nearest boxes first. Any-hit rays visit
//! children in an order that is likely to find a hit soon.
//!
//! The next child is the one that the ray enters first. For any-hit rays, it is the first in the
//! order of the node. The other children are pushed in the order of the node with a single store,
//! so no branch depends on how many there are. A child beyond the nearest hit is dropped when it is
//! popped from the stack. The branch that decides this is usually predicted, so the traversal
//! continues before the hit distance is known.
//!
//! Source: Fuetterer, Lojewski, Pfreundt, Ebert, *Efficient Ray Tracing Kernels for Modern CPU
//! Architectures*, JCGT 4(4), 2015.

use super::TraversalCounter;
use super::lanes::{Lanes, NodePlanes, Stack, StackStorage, WIDTH};
use super::node::{IS_LEAF, LEAF, OFFSET_BITS, REVERSED, SLOT_BITS, WideNode};
use crate::math::{Ray, Vec3};
use glam::{Vec3A, Vec3Swizzles, Vec4};
use std::ops::Range;

/// A ray prepared for the box tests of a tree traversal. The tests are conservative: despite
/// rounding, no box that the exact ray hits is missed.
///
/// The sign of the direction determines the near and far plane of each slab. Each plane is moved
/// outwards by several rounding errors of the largest coordinate, which also covers the rounding
/// errors of the triangle test.
#[derive(Clone, Copy)]
pub(super) struct TraversalRay {
    planes: Planes,
    /// One bit for each axis, set if the direction is negative along it.
    pub negative: u32,
    t_min: f32,
    /// Unit of box distances along the ray. It is 1 if the ray is fast.
    scale: f32,
    /// True if coordinates are so small that no triangle test can overflow.
    pub is_in_range: bool,
}

/// Coefficients of a ray for computing the distances to the planes of boxes, for each axis.
#[derive(Clone, Copy)]
struct Planes {
    inverse: [f32; 3],
    near_origin: [f32; 3],
    far_origin: [f32; 3],
}

/// Distance by which box planes are moved outwards, relative to the largest coordinate.
///
/// Rounding errors use up less than 2.5 epsilon of this distance on either side: half an epsilon
/// each for the padded origin, the inverse, their product, and the distance, and less for the
/// remaining steps. Therefore, if the ray hits a box, the computed interval extends beyond the
/// exact one by more than 5 epsilon on either side. The interval is not empty even if the box is
/// flat, and it begins before any hit in the box.
pub(super) const PADDING: f32 = 8.0 * f32::EPSILON;

/// Range of absolute values whose squares neither overflow nor underflow.
pub(super) const FAST_RANGE: Range<f32> = 1e-15..1e15;

/// Minimum absolute value of the largest direction component of a fast ray. The other components
/// may be arbitrarily small. Box tests clamp them to the start of [`FAST_RANGE`], so that products
/// of inverses and coordinates do not overflow. Within a tree, clamping moves a ray by at most
/// 10^-9 of the reach, which is a thousandth of the padding.
pub(super) const MIN_MAIN_COMPONENT: f32 = 1e-6;

impl TraversalRay {
    /// Prepares a fast ray for a tree whose coordinates are at most `max_coordinate`. Returns
    /// `None` if the ray is not fast. Box tests of a fast ray never leave the range of `f32`, and
    /// the interval of the ray begins at its origin or later. The tests are therefore shorter.
    /// Components of the direction may be zero if another component is at least
    /// [`MIN_MAIN_COMPONENT`].
    #[inline(always)]
    pub fn new(ray: &Ray, max_coordinate: f32) -> Option<Self> {
        let (origin, dir) = (Vec3A::from(ray.origin), Vec3A::from(ray.dir));
        // The padding also depends on the coordinates of the origin because a ray that was
        // transformed into object space has their rounding error. Each lane holds the sum of all
        // coordinates, so a NaN in any of them reaches every lane.
        let from = origin.abs();
        let reach = (from + from.yzx()) + (from.zxy() + max_coordinate);
        let size = dir.abs();
        let sizes = size.extend(reach.x);
        let (above, below) = (sizes.cmpgt(Vec4::splat(FAST_RANGE.start)), sizes.cmplt(Vec4::splat(FAST_RANGE.end)));
        let is_fast = below.all() && (above.all() || above.test(3) && size.max_element() >= MIN_MAIN_COMPONENT);
        if !is_fast || !(0.0..ray.t_max).contains(&ray.t_min) {
            return None;
        }
        let inverse = 1.0 / size.max(Vec3A::splat(FAST_RANGE.start)).copysign(dir);
        let outward = (PADDING * reach).copysign(dir);
        let planes = Planes {
            inverse: inverse.to_array(),
            near_origin: ((origin + outward) * -inverse).to_array(),
            far_origin: ((origin - outward) * -inverse).to_array(),
        };
        // This turns -0 into 0 because ends of intervals are compared as integers.
        let t_min = ray.t_min + 0.0;
        Some(TraversalRay { planes, negative: dir.is_negative_bitmask(), t_min, scale: 1.0, is_in_range: true })
    }

    /// Prepares a ray that is not fast. Returns `None` if it cannot hit anything.
    #[cold]
    pub fn robust(ray: &Ray, max_coordinate: f32) -> Option<Self> {
        if !is_valid(ray) {
            return None;
        }
        let reach = (ray.origin.abs().max_element() + max_coordinate).min(f32::MAX);
        let length = ray.dir.abs();
        // Divide the direction by a power of two so that distances within the bounds neither
        // overflow nor underflow.
        let scale = f32::from_bits(length.max_element().to_bits() & 0x7f80_0000).max(f32::MIN_POSITIVE);
        let dir = ray.dir / scale;
        // Treat a component as zero if its inverse overflows or if it moves the ray by much less
        // than the padding.
        let is_negligible = dir.abs().cmplt(Vec3::splat(1e-30));
        // Add the smallest normal number because the padding underflows if the reach is tiny.
        let outward = Vec3::splat(PADDING * reach + f32::MIN_POSITIVE).copysign(dir);
        let planes = Planes {
            inverse: Vec3::select(is_negligible, Vec3::INFINITY.copysign(dir), 1.0 / dir).to_array(),
            near_origin: (ray.origin + outward).to_array(),
            far_origin: (ray.origin - outward).to_array(),
        };
        let negative = dir.is_negative_bitmask();
        let t_min = (ray.t_min * scale).next_down();
        Some(TraversalRay { planes, negative, t_min, scale, is_in_range: reach < FAST_RANGE.end })
    }

    /// Converts a distance along the ray to the unit of box distances and rounds it up.
    #[inline(always)]
    fn limit<const FAST: bool>(&self, t: f32) -> f32 {
        if FAST { t } else { (t * self.scale).next_up() }
    }
}

/// Callbacks that [`traverse`] calls at the nodes and leaves that a ray visits.
pub(super) trait Visitor {
    type TraversalCounter: TraversalCounter;

    /// True if any hit is enough. In this case, children are visited in the order for any-hit rays.
    const ANY: bool;

    fn counter(&mut self) -> &mut Self::TraversalCounter;

    /// Handles a visited node, given the node's offset.
    #[inline(always)]
    fn enter(&mut self, _: usize) {}

    /// Prefetches the children that were hit. The third argument is the child that is likely to be
    /// visited next.
    fn fetch<L: Lanes>(&self, _: L, _: &NodeHits<L>, _: u32) {}

    /// Tests the items of a leaf. `FAST` is true if the ray is fast. Returns the new `t_max`, which
    /// must not exceed the old one. Minus infinity ends the traversal.
    fn leaf<L: Lanes, const FAST: bool>(&mut self, lanes: L, leaf: u32, t_max: f32) -> f32;
}

/// Passes every leaf that the ray may hit before `t_max` to the visitor. The order is approximately
/// from near to far, unless [`ANY`](Visitor::ANY) hit is enough.
///
/// Returns the final `t_max`. A leaf whose box begins exactly at `t_max` is still visited. `FAST`
/// requires that [`TraversalRay::new`] created `boxes`.
#[inline(always)]
pub(super) fn traverse<L: Lanes, V: Visitor, const FAST: bool>(
    lanes: L,
    nodes: &[WideNode],
    boxes: &TraversalRay,
    mut t_max: f32,
    visitor: &mut V,
) -> f32 {
    let slabs = Slabs::new(lanes, nodes, boxes);
    let mut far = boxes.limit::<FAST>(t_max);
    let mut limit = lanes.splat(far);
    let mut room = StackStorage::new();
    let mut stack = Stack::new(&mut room);
    let mut child = 0;
    loop {
        'visit: {
            let leaf = if child & LEAF == 0 {
                let mut address = child as usize;
                loop {
                    visitor.counter().count_work(1, 0);
                    visitor.enter(address);
                    let hits = intersect_node::<L, FAST>(lanes, &slabs, address, limit);
                    if hits.mask == 0 {
                        break 'visit;
                    }
                    // The next child is not pushed onto the stack.
                    let order = hits.node.order(V::ANY, boxes.negative);
                    let likely = extreme_bit(hits.mask, order != 0);
                    let next = hits.next::<FAST>(lanes, V::ANY, likely);
                    visitor.fetch(lanes, &hits, likely);
                    hits.push(lanes, &mut stack, next, order);
                    match hits.next_child::<FAST>(V::ANY, next) {
                        NextChild::Node(next) => address = next,
                        NextChild::Leaf(leaf) => break leaf,
                    }
                }
            } else {
                child
            };
            let t = visitor.leaf::<L, FAST>(lanes, leaf, t_max);
            if t < t_max {
                t_max = t;
                if t == f32::NEG_INFINITY {
                    return t_max;
                }
                far = boxes.limit::<FAST>(t);
                limit = lanes.splat(far);
            }
        }
        loop {
            match stack.pop_near() {
                Some((next, near)) => {
                    if near <= far {
                        child = next;
                        break;
                    }
                }
                None => return t_max,
            }
        }
    }
}

/// Result of testing a ray against the children of a node: a mask of the hit children, and their
/// entry distances.
pub(super) struct NodeHits<'a, L: Lanes> {
    pub node: &'a WideNode,
    child_tags: &'a [u8; WIDTH],
    /// One bit for each hit child.
    pub mask: u32,
    /// Lane mask with all bits set for hit children if the ray is fast. Otherwise, it is
    /// meaningless.
    which: L::Floats,
    /// Entry distances of the children.
    enter: L::Floats,
}

/// The child that a traversal visits next.
enum NextChild {
    /// Offset of a node.
    Node(usize),
    Leaf(u32),
}

impl<L: Lanes> NodeHits<'_, L> {
    /// Returns the next child, with its slot in the bits of [`PLACE`]. For fast closest-hit rays,
    /// the last eight bits of the result are the full [tag](WideNode::child_tags).
    ///
    /// The next child is the one that the ray enters first. Any-hit rays visit the `likely` child
    /// instead, because it is known sooner. Rays that are not fast also do this because their
    /// distances cannot be compared as integers.
    #[inline(always)]
    pub fn next<const FAST: bool>(&self, lanes: L, any: bool, likely: u32) -> u32 {
        if FAST && !any { lanes.nearest(self.enter, self.which, self.child_tags) } else { likely }
    }

    /// Finds the next child from the result of [`NodeHits::next`]. An inner node is found by its
    /// tag. This is the fastest way, which matters because the ray waits for the node's address. A
    /// leaf is found by its slot.
    #[inline(always)]
    fn next_child<const FAST: bool>(&self, any: bool, next: u32) -> NextChild {
        if FAST && !any {
            if next & IS_LEAF == 0 {
                return NextChild::Node(self.node.first as usize + (next & OFFSET_BITS) as usize);
            }
            return NextChild::Leaf(self.child(next & SLOT_BITS));
        }
        match self.child(next) {
            child if child & LEAF == 0 => NextChild::Node(child as usize),
            leaf => NextChild::Leaf(leaf),
        }
    }

    /// Returns the code of the child in a slot; see [`WideNode::children`].
    #[inline(always)]
    pub fn child(&self, place: u32) -> u32 {
        self.node.children[place as usize]
    }

    /// Pushes the other children in the [order](WideNode::order) of the node, so that the first
    /// child of that order is popped first.
    #[inline(always)]
    pub fn push(&self, lanes: L, stack: &mut Stack, next: u32, order: u32) {
        let orders = &PUSH_ORDERS[(order / REVERSED) as usize];
        // The order is computed from the hit mask, so the stack does not have to wait for the
        // nearest child.
        let count = self.mask.count_ones() - u32::from(self.mask != 0);
        let others = self.mask & !(1 << (next & SLOT_BITS));
        lanes.push(stack, &self.node.children, self.enter, &orders[others as usize & 255], count);
    }
}

/// Returns the first set bit of a lane mask, or the last if `last` is true. If the mask is 0,
/// returns a value beyond all lanes.
#[inline(always)]
pub(super) fn extreme_bit(lanes: u32, last: bool) -> u32 {
    if last { lanes.leading_zeros() ^ 31 } else { lanes.trailing_zeros() }
}

/// Lanes of each mask, in the order in which they are pushed. The first table is for visits from
/// first to last, and the second is for visits from last to first.
static PUSH_ORDERS: [[[u8; WIDTH]; 256]; 2] = {
    let mut table = [[[0; WIDTH]; 256]; 2];
    let mut set = 0;
    while set < 256 {
        let count = (set as u32).count_ones() as usize;
        let (mut lane, mut place) = (0, 0);
        while lane < WIDTH {
            if set >> lane & 1 == 1 {
                table[1][set][place] = lane as u8;
                table[0][set][count - 1 - place] = lane as u8;
                place += 1;
            }
            lane += 1;
        }
        set += 1;
    }
    table
};
const _: () = assert!(size_of_val(&PUSH_ORDERS[0]) == REVERSED as usize);

/// A [`TraversalRay`] with each coefficient copied to all lanes, for testing the boxes of eight
/// children.
pub(super) struct Slabs<'a, L: Lanes> {
    inverse: [L::Floats; 3],
    near_origin: [L::Floats; 3],
    far_origin: [L::Floats; 3],
    t_min: L::Floats,
    sides: NodePlanes<'a>,
}

impl<'a, L: Lanes> Slabs<'a, L> {
    #[inline(always)]
    pub fn new(lanes: L, nodes: &'a [WideNode], boxes: &TraversalRay) -> Self {
        Slabs {
            inverse: lanes.splat3(boxes.planes.inverse),
            near_origin: lanes.splat3(boxes.planes.near_origin),
            far_origin: lanes.splat3(boxes.planes.far_origin),
            t_min: lanes.splat(boxes.t_min),
            sides: NodePlanes::new(nodes, boxes.negative),
        }
    }
}

/// Tests the children of the node at an offset against a ray that ends at `limit`.
#[inline(always)]
pub(super) fn intersect_node<'a, L: Lanes, const FAST: bool>(
    lanes: L,
    slabs: &Slabs<'a, L>,
    address: usize,
    limit: L::Floats,
) -> NodeHits<'a, L> {
    let Slabs { inverse, near_origin, far_origin, t_min, sides } = slabs;
    let at = sides.at(address);
    macro_rules! slab {
        ($axis:literal, $side:ident, $origin:ident) => {{
            let plane = lanes.load(at.$side($axis));
            match FAST {
                true => lanes.mul_add(plane, inverse[$axis], $origin[$axis]),
                false => lanes.mul(lanes.sub(plane, $origin[$axis]), inverse[$axis]),
            }
        }};
    }
    macro_rules! ends {
        ($axis:literal) => {
            [slab!($axis, near, near_origin), slab!($axis, far, far_origin)]
        };
    }
    let (x, y, z) = (ends!(0), ends!(1), ends!(2));
    let (node, child_tags) = (at.node, at.child_tags());
    if FAST {
        // No distance is NaN and no start is negative, so the ends can be compared as integers. The
        // result is the correct end, or a negative number if the ray misses the box. The padding
        // ensures that the interval of a box is not empty if the ray hits it.
        let [enter, leave] = lanes.interval([x, y, z], [*t_min, limit]);
        let which = lanes.lt_as_int(enter, leave);
        return NodeHits { node, child_tags, mask: lanes.signs(which), which, enter };
    }
    // If the ray lies in a plane of a box, zero times infinity results in NaN. NaN is ignored
    // because it is the first argument.
    let enter = lanes.max(z[0], lanes.max(y[0], lanes.max(x[0], *t_min)));
    let leave = lanes.min(z[1], lanes.min(y[1], lanes.min(x[1], limit)));
    NodeHits { node, child_tags, mask: lanes.le(enter, leave), which: enter, enter }
}

/// Returns true if the ray can hit anything. Rays that contain NaN or infinity, have no direction,
/// or have an empty interval cannot.
#[inline]
pub fn is_valid(ray: &Ray) -> bool {
    ray.origin.is_finite() && ray.dir.is_finite() && ray.dir != Vec3::ZERO && ray.t_min < ray.t_max
}
