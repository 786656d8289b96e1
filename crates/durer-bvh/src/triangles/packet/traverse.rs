//! Traverses the tree with a packet.

use super::bundle::Packet;
use super::rays::PacketRays;
use crate::lanes::{FloatLanes, Lanes, WIDE, WideLanes};
use crate::node::{self, LEAF, SLOT_BITS, WideNode};
use crate::traverse::extreme_bit;
use crate::triangles::fetch::{PrefetchAddresses, SIBLING_LINES};

/// Stack entry of a packet traversal: a node or leaf to visit, and the rays to test against it.
#[derive(Clone, Copy)]
pub struct StackEntry {
    /// Mask of the rays that hit the parent.
    rays: u64,
    child: u32,
    /// Location of the child's box, which is the sum of the parent's offset and the slot.
    box_at: u32,
    near: f32,
}

/// Intervals that contain the values of all rays of a packet, for testing the children of a node
/// once for all rays.
struct IntervalRay<L: Lanes> {
    inverse: [[L::Floats; 2]; 3],
    near_from: [L::Floats; 3],
    far_from: [L::Floats; 3],
    t_min: L::Floats,
    negative: [usize; 3],
}

impl<L: Lanes> IntervalRay<L> {
    /// Returns a mask of the children that any ray may hit, and lower bounds of their entry
    /// distances.
    ///
    /// Rounding is monotonic, so the intervals contain the results of all individual rays.
    #[inline(always)]
    fn intersect_node(&self, lanes: L, node: &WideNode, limit: L::Floats) -> (u32, L::Floats) {
        macro_rules! slab {
            ($axis:literal, $side:expr, $from:ident, $end:ident) => {{
                let plane = lanes.sub(lanes.load(&node.planes[$axis][$side & 1]), self.$from[$axis]);
                let [low, high] = self.inverse[$axis];
                lanes.$end(lanes.mul(plane, low), lanes.mul(plane, high))
            }};
        }
        let [x, y, z] = self.negative;
        let enter = lanes.max(slab!(0, x, near_from, min), slab!(1, y, near_from, min));
        let enter = lanes.max(enter, lanes.max(slab!(2, z, near_from, min), self.t_min));
        let leave = lanes.min(slab!(0, !x, far_from, max), slab!(1, !y, far_from, max));
        let leave = lanes.min(leave, lanes.min(slab!(2, !z, far_from, max), limit));
        (lanes.le(enter, leave), enter)
    }

    /// Returns a lower bound of all entry distances. This is 0, or the smallest entry distance of
    /// the root's children if `t_min` is negative.
    #[inline(always)]
    fn start(&self, lanes: L, root: &WideNode, limit: f32) -> f32 {
        if lanes.store(self.t_min)[0] >= 0.0 {
            return 0.0;
        }
        let (hits, enter) = self.intersect_node(lanes, root, lanes.splat(limit));
        let nowhere = f32::INFINITY;
        lanes.store(lanes.select(hits, enter, lanes.splat(nowhere))).into_iter().fold(nowhere, f32::min)
    }
}

/// Returns the slot of the hit child with the smallest entry distance. No entry distance is below
/// `start`. (The order of the node is not used because it follows a single axis. Along other axes,
/// rays would visit far children before near ones.)
#[inline(always)]
fn nearest<L: Lanes>(lanes: L, node: &WideNode, hits: u32, enter: L::Floats, start: f32) -> u32 {
    let nothing = lanes.splat(0.0);
    let since = lanes.max_as_int(lanes.sub(enter, lanes.splat(start)), nothing);
    let which = lanes.select(hits, lanes.splat(f32::from_bits(u32::MAX)), nothing);
    lanes.nearest(since, which, &node.child_tags) & SLOT_BITS
}

impl Packet<'_> {
    #[inline(always)]
    fn interval_ray<L: Lanes>(&self, lanes: L) -> IntervalRay<L> {
        let nowhere = lanes.splat(0.0);
        let wide = lanes.wide();
        macro_rules! least {
            ($($of:tt)*) => {
                lanes.splat(end!(self, wide, min, least, $($of)*))
            };
        }
        macro_rules! greatest {
            ($($of:tt)*) => {
                lanes.splat(end!(self, wide, max, greatest, $($of)*))
            };
        }
        let mut intervals = IntervalRay {
            inverse: [[nowhere; 2]; 3],
            near_from: [nowhere; 3],
            far_from: [nowhere; 3],
            t_min: least!(t_min),
            negative: self.axes.negative,
        };
        for axis in 0..3 {
            intervals.inverse[axis] = [least!(inverse[axis]), greatest!(inverse[axis])];
            if self.has_common_origin {
                let PacketRays { near_from, far_from, .. } = &self.sixteens[0];
                (intervals.near_from[axis], intervals.far_from[axis]) =
                    (lanes.splat(near_from[axis][0]), lanes.splat(far_from[axis][0]));
                continue;
            }
            (intervals.near_from[axis], intervals.far_from[axis]) = match self.axes.negative[axis] {
                0 => (greatest!(near_from[axis]), least!(far_from[axis])),
                _ => (least!(near_from[axis]), greatest!(far_from[axis])),
            };
        }
        intervals
    }

    /// Returns the maximum `t` of all rays.
    #[inline(always)]
    pub(super) fn last<L: Lanes>(&self, lanes: L) -> f32 {
        let wide = lanes.wide();
        end!(self, wide, max, greatest, t_last)
    }

    /// Tests the rays against the triangles of all leaves that they may hit, in approximately
    /// front-to-back order. The nearest child of each node comes first, followed by the other
    /// children in node order. If `ANY` is true, children are visited in the order for any-hit
    /// rays.
    #[inline(always)]
    pub(super) fn traverse<L: Lanes, const ANY: bool>(&mut self, lanes: L, stack: &mut Vec<StackEntry>) {
        let bvh = self.bvh;
        let (intervals, places) = (self.interval_ray(lanes), PrefetchAddresses::new(bvh));
        let [x, y, z] = self.axes.negative;
        let octant = (x | y << 1 | z << 2) as u32;
        self.limit = self.last(lanes);
        stack.clear();
        let start = intervals.start(lanes, &bvh.nodes[0], self.limit);
        let (mut child, mut rays) = (0, self.alive);
        loop {
            if child & LEAF == 0 {
                let node = &bvh.nodes[node::node_index(child)];
                let (hits, enter) = intervals.intersect_node(lanes, node, lanes.splat(self.limit));
                if hits != 0 {
                    let box_at = child;
                    let from_last = node.order(ANY, octant) != 0;
                    let next = match ANY {
                        true => extreme_bit(hits, from_last),
                        false => nearest(lanes, node, hits, enter, start),
                    };
                    // The child that is visited last is pushed first.
                    let (mut others, enter) = (hits ^ 1 << next, lanes.store(enter));
                    while others != 0 {
                        let place = extreme_bit(others, !from_last);
                        others ^= 1 << place;
                        let (child, near) = (node.children[place as usize], enter[place as usize]);
                        places.fetch::<L, SIBLING_LINES>(lanes, child);
                        stack.push(StackEntry { rays, child, box_at: box_at + place, near });
                    }
                    let inside = self.inside(lanes, node, next as usize & 7, rays);
                    if inside != 0 {
                        rays = inside;
                        child = node.children[next as usize & 7];
                        continue;
                    }
                }
            } else {
                self.leaf::<L, ANY>(lanes, child, rays);
                if ANY && self.alive == 0 {
                    return;
                }
            }
            loop {
                let Some(entry) = stack.pop() else { return };
                if entry.near > self.limit {
                    continue;
                }
                rays = if ANY { entry.rays & self.alive } else { entry.rays };
                rays = self.inside(lanes, &bvh.nodes[node::node_index(entry.box_at)], entry.box_at as usize & 7, rays);
                if rays != 0 {
                    child = entry.child;
                    break;
                }
            }
        }
    }

    /// Returns a mask of the rays that hit the box of a child.
    #[inline(always)]
    fn inside<L: Lanes>(&self, lanes: L, node: &WideNode, place: usize, rays: u64) -> u64 {
        let wide = lanes.wide();
        let [x, y, z] = self.axes.negative;
        macro_rules! plane {
            ($axis:literal, $side:expr) => {
                wide.splat(node.planes[$axis][$side & 1][place])
            };
        }
        let (near_x, near_y, near_z) = (plane!(0, x), plane!(1, y), plane!(2, z));
        let (far_x, far_y, far_z) = (plane!(0, !x), plane!(1, !y), plane!(2, !z));
        let mut inside = 0;
        for (group, e) in self.sixteens.iter().enumerate() {
            if rays >> (group * WIDE) & 0xffff == 0 {
                continue;
            }
            macro_rules! slab {
                ($axis:literal, $plane:ident, $origin:ident) => {
                    wide.mul_add($plane, wide.load(&e.inverse[$axis]), wide.load(&e.$origin[$axis]))
                };
            }
            let enter = wide.max(slab!(0, near_x, near_origin), slab!(1, near_y, near_origin));
            let enter = wide.max(enter, wide.max(slab!(2, near_z, near_origin), wide.load(&e.t_min)));
            let leave = wide.min(slab!(0, far_x, far_origin), slab!(1, far_y, far_origin));
            let leave = wide.min(leave, wide.min(slab!(2, far_z, far_origin), wide.load(&e.t_last)));
            inside |= u64::from(wide.le(enter, leave)) << (group * WIDE);
        }
        inside & rays
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::{AvailableLevel, Kernel, SimdLevel, WIDTH};
    use crate::math::{Aabb, Vec3};

    /// Kernel that calls [`nearest`] for a node, given the entry distances of its children, a mask
    /// of the hit children, and a lower bound of the distances.
    struct Nearest<'a>(&'a WideNode, [f32; WIDTH], u32, f32);

    impl Kernel for Nearest<'_> {
        type Output = u32;

        #[inline(always)]
        fn run<L: Lanes>(self, lanes: L) -> u32 {
            nearest(lanes, self.0, self.2, lanes.load(&self.1), self.3)
        }
    }

    #[test]
    fn first_entered_child_is_next_also_behind_the_origin() {
        let mut node = WideNode::EMPTY;
        for place in 0..WIDTH {
            node.set(place, Aabb::around([Vec3::ZERO]), node::leaf(place, 1));
        }
        let enter = [-1.0, -3.0, 0.5, -0.0, -8.0, 2.0, 1e30, -2.0];
        let cases = [
            (0b1111_1111, -8.0, 4),
            (0b1110_1111, -8.0, 1),
            (0b0110_1000, 0.0, 3),
            (0b0110_0100, 0.0, 2),
            (0b0100_0000, 0.0, 6),
        ];
        for (level, (hits, start, expected)) in SimdLevel::available().flat_map(|level| cases.map(|case| (level, case)))
        {
            let place = AvailableLevel::or_scalar(level).run(Nearest(&node, enter, hits, start));
            assert_eq!(place, expected, "{level:?} {hits:b}");
        }
    }
}
