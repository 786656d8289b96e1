//! Walking a ray through the tree, nearest boxes first, or, where any hit will do, in the order that is likely to find one soon.
//!
//! Of the children that the ray meets the one that is entered first is next, or, where any hit will do, the first in the order of the node;
//! the others are pushed in the order of the node, by one store whatever their number, so that no branch depends on how many children are
//! met. What lies beyond a hit is dropped when it is popped: that is guessed rightly more often than not, and the walk goes on before it
//! is known where the hit is.
//!
//! Source: Fuetterer, Lojewski, Pfreundt, Ebert, *Efficient Ray Tracing Kernels for Modern CPU Architectures*, JCGT
//! 4(4), 2015.

use super::Tally;
use super::lanes::{Lanes, Room, Sides, Stack, WIDTH};
use super::node::{LEAF, Node};
use crate::math::{Ray, Vec3};
use glam::{Vec3A, Vec3Swizzles, Vec4};
use std::ops::Range;

/// A ray prepared for boxes: conservative, so that rounding never loses a box that the exact ray meets.
///
/// The near and far side of each slab are chosen by the sign of the direction. Each side is moved outwards by
/// several roundings of the largest distance that occurs, which also covers the rounding of the triangle test.
#[derive(Clone, Copy)]
pub(super) struct RayBox {
    planes: Planes,
    /// A bit for each axis along which the direction is negative.
    pub negative: u32,
    t_min: f32,
    /// Distances of boxes are in these units; 1 where the ray is tame.
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
pub(super) const PADDING: f32 = 8.0 * f32::EPSILON;

/// In this range squares neither overflow nor vanish.
pub(super) const ORDINARY: Range<f32> = 1e-15..1e15;

/// If a component of a direction is at least so long, others may be as small as they like: boxes see none that is less than what is
/// [`ORDINARY`], so products of inverses and coordinates do not overflow. Within a tree that moves a ray by at most 10^-9 of its reach, a
/// thousandth of the padding.
pub(super) const LONG: f32 = 1e-6;

impl RayBox {
    /// Prepares a tame ray for a tree with no coordinates greater than `most`: one for which nothing leaves the range of `f32` (zeros beside
    /// a [`LONG`] component do not), and that begins no earlier than at its origin. So tests of boxes may be in a short form.
    #[inline(always)]
    pub fn new(ray: &Ray, most: f32) -> Option<Self> {
        let (origin, dir) = (Vec3A::from(ray.origin), Vec3A::from(ray.dir));
        // Coordinates themselves count too: a ray that was moved into object space is off by their rounding.
        // As a sum, in each lane, it is also no number where any of them is none.
        let from = origin.abs();
        let reach = (from + from.yzx()) + (from.zxy() + most);
        let size = dir.abs();
        let sizes = size.extend(reach.x);
        let (above, below) = (sizes.cmpgt(Vec4::splat(ORDINARY.start)), sizes.cmplt(Vec4::splat(ORDINARY.end)));
        let is_tame = below.all() && (above.all() || above.test(3) && size.max_element() >= LONG);
        if !is_tame || !(0.0..ray.t_max).contains(&ray.t_min) {
            return None;
        }
        let inverse = 1.0 / size.max(Vec3A::splat(ORDINARY.start)).copysign(dir);
        let outward = (PADDING * reach).copysign(dir);
        let planes = Planes {
            inverse: inverse.to_array(),
            near_origin: ((origin + outward) * -inverse).to_array(),
            far_origin: ((origin - outward) * -inverse).to_array(),
        };
        // Not the zero with a sign, for ends of intervals are compared as integers.
        let t_min = ray.t_min + 0.0;
        Some(RayBox { planes, negative: dir.is_negative_bitmask(), t_min, scale: 1.0, moderate: true })
    }

    /// Prepares any ray; `None` where it cannot hit anything.
    #[cold]
    pub fn wild(ray: &Ray, most: f32) -> Option<Self> {
        if !is_sound(ray) {
            return None;
        }
        let reach = (ray.origin.abs().max_element() + most).min(f32::MAX);
        let length = ray.dir.abs();
        // A direction with a power of two taken out, so that distances within the bounds are no extreme numbers.
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
        Some(RayBox { planes, negative, t_min, scale, moderate: reach < ORDINARY.end })
    }

    /// A distance along the ray, not too small, as boxes have it.
    #[inline(always)]
    fn limit<const TAME: bool>(&self, t: f32) -> f32 {
        if TAME { t } else { (t * self.scale).next_up() }
    }
}

/// What is done with the items of a tree.
pub(super) trait Visitor {
    type Tally: Tally;

    /// Whether any hit will do, so that children come in the order that is for that.
    const ANY: bool;

    fn tally(&mut self) -> &mut Self::Tally;

    /// Has a child that is likely to be visited brought near.
    fn fetch<L: Lanes>(&self, _: L, _: u32) {}

    /// Looks into a leaf, with a ray that is `TAME` or not; gives the new `t_max`, at most the old. Minus infinity ends the walk.
    fn leaf<L: Lanes, const TAME: bool>(&mut self, lanes: L, leaf: u32, t_max: f32) -> f32;
}

/// Shows every leaf that the ray may meet before `t_max` to the visitor, roughly from near to far if not [`ANY`](Visitor::ANY) hit will do.
///
/// Gives `t_max` as it is in the end. Leaves whose boxes begin exactly at `t_max` are still shown. `TAME` says whether `boxes`
/// are of [`RayBox::new`].
#[inline(always)]
pub(super) fn walk<L: Lanes, V: Visitor, const TAME: bool>(
    lanes: L,
    nodes: &[Node],
    boxes: &RayBox,
    mut t_max: f32,
    visitor: &mut V,
) -> f32 {
    let slabs = Slabs::new(lanes, nodes, boxes);
    let mut far = boxes.limit::<TAME>(t_max);
    let mut limit = lanes.splat(far);
    let mut room = Room::new();
    let mut stack = Stack::new(&mut room);
    let mut child = 0;
    loop {
        if child & LEAF == 0 {
            visitor.tally().node();
            let (node, met, interval) = meet::<L, TAME>(lanes, &slabs, child, limit);
            if met != 0 {
                // One child is next without a way through the stack.
                let likely;
                (child, likely) = next::<L, TAME>(lanes, V::ANY, &mut stack, node, met, interval, boxes.negative);
                visitor.fetch(lanes, likely);
                continue;
            }
        } else {
            let t = visitor.leaf::<L, TAME>(lanes, child, t_max);
            if t < t_max {
                t_max = t;
                if t == f32::NEG_INFINITY {
                    return t_max;
                }
                far = boxes.limit::<TAME>(t);
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

/// The child that is next, of those that are met; pushes the others. Also gives the one that is likely to be next: the first by
/// [`Node::from_last`].
///
/// The next is the one that is entered first; but the likely one if `any` hit will do, which is known sooner, and of rays that are not
/// tame, whose distances cannot be compared as integers. The others are pushed in the order of the node, the first last.
#[inline(always)]
pub(super) fn next<L: Lanes, const TAME: bool>(
    lanes: L,
    any: bool,
    stack: &mut Stack,
    node: &Node,
    met: u32,
    [enter, leave]: [L::Floats; 2],
    negative: u32,
) -> (u32, u32) {
    let from_last = node.is_from_last(any, negative);
    let orders = &PUSHED[usize::from(from_last)];
    // Of those that are met, so that neither the stack nor what is fetched waits for the nearest.
    let count = met.count_ones() - u32::from(met != 0);
    let lane = end_of(met, from_last);
    let likely = node.children[lane as usize & 7];
    let (lane, next) = match TAME && !any {
        true => lanes.nearest(enter, leave, &node.children),
        false => (lane, likely),
    };
    let others = met & !(1 << (lane & 7));
    lanes.push(stack, &node.children, enter, &orders[others as usize & 255], count);
    (next, likely)
}

/// The first of some lanes, a bit for each, or the `last`. (Of 31 less the leading zeros the compiler makes an instruction that is slow on
/// Zen 4.)
#[inline(always)]
pub(super) fn end_of(lanes: u32, last: bool) -> u32 {
    if last { !(lanes << (32 - WIDTH)).leading_zeros() & 7 } else { lanes.trailing_zeros() & 7 }
}

/// For each set of lanes the lanes in the order in which they are pushed, where the first are visited first and where the last are.
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
    pub fn new(lanes: L, nodes: &'a [Node], boxes: &RayBox) -> Self {
        Slabs {
            inverse: lanes.splat3(boxes.planes.inverse),
            near_origin: lanes.splat3(boxes.planes.near_origin),
            far_origin: lanes.splat3(boxes.planes.far_origin),
            t_min: lanes.splat(boxes.t_min),
            sides: Sides::new(nodes, boxes.negative),
        }
    }
}

/// The node at an address, those of its children that a ray meets before `limit`, a bit for each, and where it enters and leaves them.
#[inline(always)]
pub(super) fn meet<'a, L: Lanes, const TAME: bool>(
    lanes: L,
    slabs: &Slabs<'a, L>,
    address: u32,
    limit: L::Floats,
) -> (&'a Node, u32, [L::Floats; 2]) {
    let Slabs { inverse, near_origin, far_origin, t_min, sides } = slabs;
    let at = sides.at(address);
    macro_rules! slab {
        ($axis:literal, $side:ident, $origin:ident) => {{
            let plane = lanes.load(at.$side($axis));
            match TAME {
                true => lanes.mul_add(plane, inverse[$axis], $origin[$axis]),
                false => lanes.mul(lanes.sub(plane, $origin[$axis]), inverse[$axis]),
            }
        }};
    }
    // With a tame ray nothing is NaN, and no start is negative, so of ends as integers the right one is found, or one that is
    // negative where nothing is met. With others zero times infinity is NaN, where a ray runs in a side of a box: such a side is left
    // out, being the first argument here, or the second there where the first is NaN.
    macro_rules! end {
        ($sooner:ident, $least:ident, $a:expr, $b:expr) => {
            if TAME { lanes.$sooner($a, $b) } else { lanes.$least($a, $b) }
        };
    }
    let enter = end!(later, max, slab!(0, near, near_origin), slab!(1, near, near_origin));
    let leave = end!(sooner, min, slab!(0, far, far_origin), slab!(1, far, far_origin));
    let enter_z = end!(later, max, slab!(2, near, near_origin), *t_min);
    let leave_z = end!(sooner, min, slab!(2, far, far_origin), limit);
    let (enter, leave) = (end!(later, max, enter, enter_z), end!(sooner, min, leave, leave_z));
    (at.node, end!(not_later, le, enter, leave), [enter, leave])
}

/// Whether a ray can hit anything: NaN and infinite ones, and those without direction, cannot.
#[inline]
pub(crate) fn is_sound(ray: &Ray) -> bool {
    ray.origin.is_finite() && ray.dir.is_finite() && ray.dir != Vec3::ZERO && ray.t_min < ray.t_max
}
