//! Walking a ray through the tree, nearest boxes first.
//!
//! Of the children that the ray meets the nearest is next; the others are pushed, farthest first, by one compressing
//! store whatever their number. When a hit shortens the ray, what lies beyond is removed from the stack at once. So no
//! branch depends on how many children are met, and none on a popped distance.
//!
//! Source: Fuetterer, Lojewski, Pfreundt, Ebert, *Efficient Ray Tracing Kernels for Modern CPU Architectures*, JCGT
//! 4(4), 2015.

use super::Tally;
use super::lanes::{Lanes, Room, Stack};
use super::node::{LEAF, Node};
use crate::math::{Aabb, Ray, Vec3};

/// A ray prepared for boxes: conservative, so that rounding never loses a box that the exact ray meets.
///
/// The near and far side of each slab are chosen by the sign of the direction. Each side is moved outwards by
/// several roundings of the largest distance that occurs, which also covers the rounding of the triangle test.
#[derive(Clone, Copy)]
pub(super) struct RayBox {
    inverse: [f32; 3],
    near_origin: [f32; 3],
    far_origin: [f32; 3],
    /// By axis: 1 where the direction is negative, else 0.
    negative: [usize; 3],
    /// Children's places in the order from far to near are 0, 1, 2, ... after an exclusive or with this.
    pub flip: u32,
    t_min: f32,
    /// Distances of boxes are in these units; 1 where the ray is tame.
    scale: f32,
    /// Whether nothing in tests of boxes leaves the range of `f32`, so that they may be in a short form.
    pub tame: bool,
    /// Whether coordinates are so small that no test of a triangle overflows.
    pub moderate: bool,
}

impl RayBox {
    /// Prepares a ray for a tree with these bounds.
    #[inline(always)]
    pub fn new(ray: &Ray, bounds: Aabb) -> Self {
        // In this range squares neither overflow nor vanish.
        const TAME: std::ops::Range<f32> = 1e-15..1e15;
        // Coordinates themselves count too: a ray that was moved into object space is off by their rounding.
        let reach = (ray.origin - bounds.min).abs().max((ray.origin - bounds.max).abs()).max(ray.origin.abs());
        let reach = reach.max_element();
        let pad = 8.0 * f32::EPSILON * reach + f32::MIN_POSITIVE;
        let length = ray.dir.abs();
        let moderate = reach < TAME.end;
        let tame =
            moderate && reach > TAME.start && length.min_element() > TAME.start && length.max_element() < TAME.end;
        let outward = Vec3::splat(pad).copysign(ray.dir);
        let (near_origin, far_origin) = (ray.origin + outward, ray.origin - outward);
        let negative = [0, 1, 2].map(|axis| usize::from(ray.dir[axis].is_sign_negative()));
        let inverse = 1.0 / ray.dir;
        let (scale, inverse, near_origin, far_origin) = match tame {
            true => (1.0, inverse, -near_origin * inverse, -far_origin * inverse),
            false => {
                // A direction with a power of two taken out, so that distances within the bounds are no extreme numbers.
                let scale = f32::from_bits(length.max_element().to_bits() & 0x7f80_0000).max(f32::MIN_POSITIVE);
                let dir = ray.dir / scale;
                // What moves the ray by much less than the padding counts as zero, and what has no inverse.
                let still = dir.abs().cmplt(Vec3::splat(1e-30));
                let inverse = Vec3::select(still, Vec3::INFINITY.copysign(dir), 1.0 / dir);
                (scale, inverse, near_origin, far_origin)
            }
        };
        let t_min = if tame { ray.t_min } else { (ray.t_min * scale).next_down() };
        let [inverse, near_origin, far_origin] = [inverse.to_array(), near_origin.to_array(), far_origin.to_array()];
        // The place 7 is farthest when all signs are positive.
        let flip = 7 ^ (negative[0] | negative[1] << 1 | negative[2] << 2) as u32;
        RayBox { inverse, near_origin, far_origin, negative, flip, t_min, scale, tame, moderate }
    }
}

impl RayBox {
    /// A distance along the ray, not too small, as boxes have it.
    #[inline(always)]
    fn limit<const TAME: bool>(&self, t: f32) -> f32 {
        if TAME { t } else { (t * self.scale).next_up() }
    }
}

/// What is done with the items of a tree.
pub(super) trait Visitor {
    type Tally: Tally;

    fn tally(&mut self) -> &mut Self::Tally;

    /// Looks into a leaf; gives the new `t_max`, at most the old. Minus infinity ends the walk.
    fn leaf<L: Lanes>(&mut self, lanes: L, leaf: u32, t_max: f32) -> f32;
}

/// Shows every leaf that the ray may meet before `t_max` to the visitor, roughly from near to far.
///
/// Leaves whose boxes begin exactly at `t_max` are still shown. `TAME` must be that of `boxes`.
#[inline(always)]
pub(super) fn walk<L: Lanes, V: Visitor, const TAME: bool>(
    lanes: L,
    nodes: &[Node],
    boxes: &RayBox,
    mut t_max: f32,
    visitor: &mut V,
) {
    let slabs = Slabs::new(lanes, boxes);
    let (order, ranks) = (lanes.flipped(boxes.flip), &RANKS[boxes.flip as usize]);
    let mut limit = lanes.splat(boxes.limit::<TAME>(t_max));
    let mut room = Room::new();
    let mut stack = Stack::new(&mut room);
    let mut child = 0;
    loop {
        if child & LEAF == 0 {
            visitor.tally().node();
            let node = &nodes[child as usize];
            let (met, enter) = meet::<L, TAME>(lanes, node, &slabs, limit);
            if met != 0 {
                // The nearest child is next, without a way through the stack.
                let [nearest, others] = ranks[met];
                child = node.children[nearest as usize & 7];
                lanes.push(&mut stack, &node.children, enter, order, others.into());
                continue;
            }
        } else {
            let t = visitor.leaf(lanes, child, t_max);
            if t < t_max {
                if t == f32::NEG_INFINITY {
                    return;
                }
                t_max = t;
                let far = boxes.limit::<TAME>(t);
                limit = lanes.splat(far);
                lanes.drop_beyond(&mut stack, far);
            }
        }
        match stack.pop() {
            Some(next) => child = next,
            None => return,
        }
    }
}

/// For each set of lanes: the lane i of it whose i ^ flip is greatest, and the others, as a set with i ^ flip in place of i.
pub(super) static RANKS: [[[u8; 2]; 256]; 8] = {
    let mut table = [[[0; 2]; 256]; 8];
    let mut i = 0;
    while i < 8 * 256 {
        let (flip, set) = (i >> 8, i & 255);
        let (mut rank, mut others) = (0, 0);
        while rank < 8 {
            if set >> (rank ^ flip) & 1 == 1 {
                others |= 1 << rank;
                table[flip][set] = [(rank ^ flip) as u8, others ^ 1 << rank];
            }
            rank += 1;
        }
        i += 1;
    }
    table
};

/// A ray's numbers for boxes, in all lanes.
pub(super) struct Slabs<L: Lanes> {
    inverse: [L::Floats; 3],
    near_origin: [L::Floats; 3],
    far_origin: [L::Floats; 3],
    t_min: L::Floats,
    negative: [usize; 3],
}

impl<L: Lanes> Slabs<L> {
    #[inline(always)]
    pub fn new(lanes: L, boxes: &RayBox) -> Self {
        Slabs {
            inverse: splat3(lanes, boxes.inverse),
            near_origin: splat3(lanes, boxes.near_origin),
            far_origin: splat3(lanes, boxes.far_origin),
            t_min: lanes.splat(boxes.t_min),
            negative: boxes.negative,
        }
    }
}

/// The children of a node that a ray meets before `limit`, a bit for each, and where it enters them.
#[inline(always)]
pub(super) fn meet<L: Lanes, const TAME: bool>(
    lanes: L,
    node: &Node,
    slabs: &Slabs<L>,
    limit: L::Floats,
) -> (usize, L::Floats) {
    let Slabs { inverse, near_origin, far_origin, t_min, negative: [x, y, z] } = slabs;
    macro_rules! slab {
        ($axis:literal, $side:expr, $origin:ident) => {{
            let plane = lanes.load(&node.planes[$axis][$side & 1]);
            match TAME {
                true => lanes.mul_add(plane, inverse[$axis], $origin[$axis]),
                false => lanes.mul(lanes.sub(plane, $origin[$axis]), inverse[$axis]),
            }
        }};
    }
    // Zero times infinity is no number, where a ray runs in a side of a box: such a side is left out, being the
    // first argument here, or the second there where the first is no number.
    let enter_y = lanes.max(slab!(0, x, near_origin), slab!(1, y, near_origin));
    let leave_y = lanes.min(slab!(0, !x, far_origin), slab!(1, !y, far_origin));
    let enter = lanes.max(enter_y, lanes.max(slab!(2, z, near_origin), *t_min));
    let leave = lanes.min(leave_y, lanes.min(slab!(2, !z, far_origin), limit));
    (lanes.le(enter, leave) as usize & 255, enter)
}

#[inline(always)]
pub(super) fn splat3<L: Lanes>(lanes: L, v: [f32; 3]) -> [L::Floats; 3] {
    [lanes.splat(v[0]), lanes.splat(v[1]), lanes.splat(v[2])]
}

/// Whether a ray can hit anything: NaN and infinite ones, and those without direction, cannot.
#[inline]
pub(crate) fn is_sound(ray: &Ray) -> bool {
    ray.origin.is_finite() && ray.dir.is_finite() && ray.dir != Vec3::ZERO && ray.t_min < ray.t_max
}
