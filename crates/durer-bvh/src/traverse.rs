//! Walking a ray through the tree, nearest boxes first, or, where any hit will do, in the order
//! that is likely to find one soon.
//!
//! Of the children that the ray meets the one that is entered first is next, or, where any hit will
//! do, the first in the order of the node; the others are pushed in the order of the node, by one
//! store whatever their number, so that no branch depends on how many children are met. What lies
//! beyond a hit is dropped when it is popped: that is guessed rightly more often than not, and the
//! walk goes on before it is known where the hit is.
//!
//! Source: Fuetterer, Lojewski, Pfreundt, Ebert, *Efficient Ray Tracing Kernels for Modern CPU
//! Architectures*, JCGT 4(4), 2015.

use super::TraversalCounter;
use super::lanes::{Lanes, Sides, Stack, StackStorage, WIDTH};
use super::node::{BEHIND, FROM_LAST, IS_LEAF, LEAF, PLACE, WideNode};
use crate::math::{Ray, Vec3};
use glam::{Vec3A, Vec3Swizzles, Vec4};
use std::ops::Range;

/// A ray prepared for boxes: conservative, so that rounding never loses a box that the exact ray
/// meets.
///
/// The near and far side of each slab are chosen by the sign of the direction. Each side is moved
/// outwards by several roundings of the largest distance that occurs, which also covers the
/// rounding of the triangle test.
#[derive(Clone, Copy)]
pub(super) struct TraversalRay {
    planes: Planes,
    /// A bit for each axis along which the direction is negative.
    pub negative: u32,
    t_min: f32,
    /// Distances of boxes are in these units; 1 where the ray is fast.
    scale: f32,
    /// Whether coordinates are so small that no test of a triangle overflows.
    pub moderate: bool,
}

/// By axis, what distances of planes are computed from.
#[derive(Clone, Copy)]
struct Planes {
    inverse: [f32; 3],
    near_origin: [f32; 3],
    far_origin: [f32; 3],
}

/// How far the sides of boxes are moved outwards, where numbers are no greater than 1.
///
/// Of that, rounding takes less than 2.5 epsilon on either side: half of one each for the padded
/// origin, the inverse, their product, and the distance, and less for what follows from these. So
/// computed distances of a box that a ray meets lie before and behind the true ones by more than 5:
/// a box begins before it ends, though it is flat, and before anything in it.
pub(super) const PADDING: f32 = 8.0 * f32::EPSILON;

/// In this range squares neither overflow nor vanish.
pub(super) const FAST_RANGE: Range<f32> = 1e-15..1e15;

/// If a component of a direction is at least so long, others may be as small as they like: boxes
/// see none that is less than what is [`FAST_RANGE`], so products of inverses and coordinates do
/// not overflow. Within a tree that moves a ray by at most 10^-9 of its reach, a thousandth of the
/// padding.
pub(super) const MIN_MAIN_COMPONENT: f32 = 1e-6;

impl TraversalRay {
    /// Prepares a fast ray for a tree with no coordinates greater than `most`: one for which
    /// nothing leaves the range of `f32` (zeros beside a [`MIN_MAIN_COMPONENT`] component do not),
    /// and that begins no earlier than at its origin. So tests of boxes may be in a short form.
    #[inline(always)]
    pub fn new(ray: &Ray, most: f32) -> Option<Self> {
        let (origin, dir) = (Vec3A::from(ray.origin), Vec3A::from(ray.dir));
        // Coordinates themselves count too: a ray that was moved into object space is off by their
        // rounding. As a sum, in each lane, it is also no number where any of them is none.
        let from = origin.abs();
        let reach = (from + from.yzx()) + (from.zxy() + most);
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
        // Not the zero with a sign, for ends of intervals are compared as integers.
        let t_min = ray.t_min + 0.0;
        Some(TraversalRay { planes, negative: dir.is_negative_bitmask(), t_min, scale: 1.0, moderate: true })
    }

    /// Prepares any ray; `None` where it cannot hit anything.
    #[cold]
    pub fn robust(ray: &Ray, most: f32) -> Option<Self> {
        if !is_sound(ray) {
            return None;
        }
        let reach = (ray.origin.abs().max_element() + most).min(f32::MAX);
        let length = ray.dir.abs();
        // A direction with a power of two taken out, so that distances within the bounds are no
        // extreme numbers.
        let scale = f32::from_bits(length.max_element().to_bits() & 0x7f80_0000).max(f32::MIN_POSITIVE);
        let dir = ray.dir / scale;
        // What moves the ray by much less than the padding counts as zero, and what has no inverse.
        let still = dir.abs().cmplt(Vec3::splat(1e-30));
        // The reach may be so small that its share vanishes.
        let outward = Vec3::splat(PADDING * reach + f32::MIN_POSITIVE).copysign(dir);
        let planes = Planes {
            inverse: Vec3::select(still, Vec3::INFINITY.copysign(dir), 1.0 / dir).to_array(),
            near_origin: (ray.origin + outward).to_array(),
            far_origin: (ray.origin - outward).to_array(),
        };
        let negative = dir.is_negative_bitmask();
        let t_min = (ray.t_min * scale).next_down();
        Some(TraversalRay { planes, negative, t_min, scale, moderate: reach < FAST_RANGE.end })
    }

    /// A distance along the ray, not too small, as boxes have it.
    #[inline(always)]
    fn limit<const FAST: bool>(&self, t: f32) -> f32 {
        if FAST { t } else { (t * self.scale).next_up() }
    }
}

/// What is done with the items of a tree.
pub(super) trait Visitor {
    type TraversalCounter: TraversalCounter;

    /// Whether any hit will do, so that children come in the order that is for that.
    const ANY: bool;

    fn counter(&mut self) -> &mut Self::TraversalCounter;

    /// Has children that are met brought near, of which one is likely to be next.
    fn fetch<L: Lanes>(&self, _: L, _: &NodeHits<L>, _: u32) {}

    /// Looks into a leaf, with a ray that is `FAST` or not; gives the new `t_max`, at most the old.
    /// Minus infinity ends the walk.
    fn leaf<L: Lanes, const FAST: bool>(&mut self, lanes: L, leaf: u32, t_max: f32) -> f32;
}

/// Shows every leaf that the ray may meet before `t_max` to the visitor, roughly from near to far
/// if not [`ANY`](Visitor::ANY) hit will do.
///
/// Gives `t_max` as it is in the end. Leaves whose boxes begin exactly at `t_max` are still shown.
/// `FAST` says whether `boxes` are of [`TraversalRay::new`].
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
                    visitor.counter().work(1, 0);
                    let met = intersect_node::<L, FAST>(lanes, &slabs, address, limit);
                    if met.mask == 0 {
                        break 'visit;
                    }
                    // One child is next without a way through the stack.
                    let order = met.node.order(V::ANY, boxes.negative);
                    let likely = end_of(met.mask, order != 0);
                    let next = met.next::<FAST>(lanes, V::ANY, likely);
                    visitor.fetch(lanes, &met, likely);
                    met.push(lanes, &mut stack, next, order);
                    match met.target::<FAST>(V::ANY, next) {
                        Target::Node(next) => address = next,
                        Target::Leaf(leaf) => break leaf,
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

/// The children of a node that a ray meets.
pub(super) struct NodeHits<'a, L: Lanes> {
    pub node: &'a WideNode,
    child_tags: &'a [u8; WIDTH],
    /// A bit for each.
    pub mask: u32,
    /// All bits in the lane of each, if the ray is fast; of no meaning if it is not.
    which: L::Floats,
    /// Where the ray enters them.
    enter: L::Floats,
}

/// Where a child is.
enum Target {
    /// At an address.
    Node(usize),
    Leaf(u32),
}

impl<L: Lanes> NodeHits<'_, L> {
    /// The [place](PLACE) of the child that is next, with more of its [tag](WideNode::child_tags)
    /// if it was found by that.
    ///
    /// It is the one that is entered first; but the `likely` one if `any` hit will do, which is
    /// known sooner, and of rays that are not fast, whose distances cannot be compared as integers.
    #[inline(always)]
    pub fn next<const FAST: bool>(&self, lanes: L, any: bool, likely: u32) -> u32 {
        if FAST && !any { lanes.nearest(self.enter, self.which, self.child_tags) } else { likely }
    }

    /// Where that child is. A node next to be visited is found by its code, for which a ray waits
    /// at every node; leaves, that are as often guessed as waited for, by their places.
    #[inline(always)]
    fn target<const FAST: bool>(&self, any: bool, next: u32) -> Target {
        if FAST && !any {
            if next & IS_LEAF == 0 {
                return Target::Node(self.node.first as usize + (next & BEHIND) as usize);
            }
            return Target::Leaf(self.child(next & PLACE));
        }
        match self.child(next) {
            child if child & LEAF == 0 => Target::Node(child as usize),
            leaf => Target::Leaf(leaf),
        }
    }

    /// The child in a place, as [`WideNode::children`] have it.
    #[inline(always)]
    pub fn child(&self, place: u32) -> u32 {
        self.node.children[place as usize]
    }

    /// Pushes the others in the [order](WideNode::order) of the node, the first last.
    #[inline(always)]
    pub fn push(&self, lanes: L, stack: &mut Stack, next: u32, order: u32) {
        let orders = &PUSHED[(order / FROM_LAST) as usize];
        // Of those that are met, so that the stack does not wait for the nearest.
        let count = self.mask.count_ones() - u32::from(self.mask != 0);
        let others = self.mask & !(1 << (next & PLACE));
        lanes.push(stack, &self.node.children, self.enter, &orders[others as usize & 255], count);
    }
}

/// The first of some lanes, a bit for each, or the `last`; if there are none something beyond all
/// lanes.
#[inline(always)]
pub(super) fn end_of(lanes: u32, last: bool) -> u32 {
    if last { lanes.leading_zeros() ^ 31 } else { lanes.trailing_zeros() }
}

/// For each set of lanes the lanes in the order in which they are pushed, where the first are
/// visited first and where the last are.
static PUSHED: [[[u8; WIDTH]; 256]; 2] = {
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
const _: () = assert!(size_of_val(&PUSHED[0]) == FROM_LAST as usize);

/// A ray's numbers for boxes, in all lanes.
pub(super) struct Slabs<'a, L: Lanes> {
    inverse: [L::Floats; 3],
    near_origin: [L::Floats; 3],
    far_origin: [L::Floats; 3],
    t_min: L::Floats,
    sides: Sides<'a>,
}

impl<'a, L: Lanes> Slabs<'a, L> {
    #[inline(always)]
    pub fn new(lanes: L, nodes: &'a [WideNode], boxes: &TraversalRay) -> Self {
        Slabs {
            inverse: lanes.splat3(boxes.planes.inverse),
            near_origin: lanes.splat3(boxes.planes.near_origin),
            far_origin: lanes.splat3(boxes.planes.far_origin),
            t_min: lanes.splat(boxes.t_min),
            sides: Sides::new(nodes, boxes.negative),
        }
    }
}

/// The node at an address, and those of its children that a ray meets before `limit`.
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
        // Nothing is NaN, and no start is negative, so of ends as integers the right one is found,
        // or one that is negative where nothing is met. Boxes that are met end after they begin,
        // for they are padded.
        let [enter, leave] = lanes.interval([x, y, z], [*t_min, limit]);
        let which = lanes.before(enter, leave);
        return NodeHits { node, child_tags, mask: lanes.signs(which), which, enter };
    }
    // Zero times infinity is NaN, where a ray runs in a side of a box: such a side is left out,
    // being the first argument.
    let enter = lanes.max(z[0], lanes.max(y[0], lanes.max(x[0], *t_min)));
    let leave = lanes.min(z[1], lanes.min(y[1], lanes.min(x[1], limit)));
    NodeHits { node, child_tags, mask: lanes.le(enter, leave), which: enter, enter }
}

/// Whether a ray can hit anything: NaN and infinite ones, and those without direction, cannot.
#[inline]
pub fn is_sound(ray: &Ray) -> bool {
    ray.origin.is_finite() && ray.dir.is_finite() && ray.dir != Vec3::ZERO && ray.t_min < ray.t_max
}
