//! Rays that go nearly the same way, through one tree together.
//!
//! Up to 64 rays whose directions have the same signs and the same longest axis are a packet. A node is tested once for all of them, by
//! interval arithmetic; what is left of its children is tested against the rays side by side when it is visited, and so is each
//! triangle of a leaf. All tests of triangles are those of single rays, with the same roundings, so answers are the same.
//!
//! Sources: Wald, Slusallek, Benthin, Wagner, *Interactive Rendering with Coherent Ray Tracing*, Eurographics 2001; Boulos, Wald,
//! Shirley, *Geometric and Arithmetic Culling Methods for Entire Ray Packets*, University of Utah 2006.

mod leaf;
mod rays;

use super::stream::prefetch;
use super::{TriangleBvh, TriangleHit};
use crate::bvh::lanes::{Kernel, Lanes, WIDE, WIDTH, Wide};
use crate::bvh::node::{LEAF, Node};
use crate::math::{Ray, Vec2};
use rays::Rays;

/// How many rays may be in a packet.
const RAYS: usize = 64;
/// So few are better off alone.
const LEAST: usize = 16;
/// As far apart directions of a packet may be across the longest axis, for one unit along it.
const WIDEST_ANGLE: f32 = 0.5;
/// As far apart origins may be, where the longest side of the tree's bounds is 1.
const WIDEST_START: f32 = 0.25;

impl TriangleBvh {
    /// Answers for rays that go together, and gives the numbers of the others. Where `ANY`, any hit will do, and only whether there
    /// is one means anything.
    pub(super) fn packets<const ANY: bool>(
        &self,
        rays: &[Ray],
        answer: impl FnMut(usize, Option<TriangleHit>),
    ) -> Vec<u32> {
        if self.nodes.is_empty() || self.least_volume != 0.0 {
            return (0..rays.len() as u32).collect();
        }
        self.level.run(Packets::<_, ANY> { bvh: self, rays, answer })
    }
}

/// What the rays of a packet have in common.
#[derive(Clone, Copy)]
struct Axes {
    /// As those of [`Sheared`].
    turned: [usize; 3],
    /// By axis: 1 where directions are negative, else 0.
    negative: [usize; 3],
    /// A bit for each axis along which they are positive.
    positive: u32,
}

impl Axes {
    /// How many keys there are: a longest axis, and signs.
    const KEYS: usize = 24;

    fn of_key(key: usize) -> Self {
        let negative = [key & 1, key >> 1 & 1, key >> 2 & 1];
        let z = key >> 3;
        let (mut x, mut y) = ((z + 1) % 3, (z + 2) % 3);
        if negative[z] == 1 {
            std::mem::swap(&mut x, &mut y);
        }
        Axes { turned: [x, y, z], negative, positive: 7 ^ (key as u32 & 7) }
    }

    /// Whether directions are negative along their longest axis.
    #[inline(always)]
    fn is_down(&self) -> bool {
        self.negative[self.turned[2]] == 1
    }
}

struct Packets<'a, A, const ANY: bool> {
    bvh: &'a TriangleBvh,
    rays: &'a [Ray],
    answer: A,
}

impl<A: FnMut(usize, Option<TriangleHit>), const ANY: bool> Kernel for Packets<'_, A, ANY> {
    type Output = Vec<u32>;

    #[inline(always)]
    fn run<L: Lanes>(mut self, lanes: L) -> Vec<u32> {
        let mut rest = Vec::new();
        let mut packet = Packet {
            bvh: self.bvh,
            axes: Axes::of_key(0),
            numbers: [0; RAYS],
            sixteens: [Rays::EMPTY; RAYS / WIDE],
            groups: 0,
            alive: 0,
            limit: 0.0,
            meetings: Vec::with_capacity(256),
        };
        let mut stack = Vec::with_capacity(256);
        for (window, rays) in self.rays.chunks(RAYS).enumerate() {
            let first = (window * RAYS) as u32;
            let all = u64::MAX >> (RAYS - rays.len());
            for (i, number) in packet.numbers.iter_mut().enumerate() {
                *number = first + i.min(rays.len() - 1) as u32;
            }
            packet.load(lanes, self.rays, rays.len());
            let signs = packet.signs(lanes);
            for key in 0..Axes::KEYS {
                let mut members = with_key(signs, key) & all;
                if members == 0 {
                    continue;
                }
                let count = members.count_ones() as usize;
                if members != all {
                    for number in &mut packet.numbers[..count] {
                        *number = first + members.trailing_zeros();
                        members &= members - 1;
                    }
                    if count >= LEAST {
                        packet.load(lanes, self.rays, count);
                    }
                }
                if count < LEAST || !packet.prepare(lanes, key, count) {
                    rest.extend_from_slice(&packet.numbers[..count]);
                    continue;
                }
                let all = packet.alive;
                packet.walk::<L, ANY>(lanes, &mut stack);
                packet.answer::<L, ANY>(lanes, all, &mut self.answer);
            }
        }
        rest
    }
}

/// Of rays those with a key, by what [`Rays::signs`] says of all.
#[inline(always)]
fn with_key([x, y, z, first, second]: [u64; 5], key: usize) -> u64 {
    let of = |set: u64, bit: usize| if key >> bit & 1 == 1 { set } else { !set };
    let longest = [first, second, !(first | second)][key >> 3];
    of(x, 0) & of(y, 1) & of(z, 2) & longest
}

/// A node or leaf that is still to be visited.
#[derive(Clone, Copy)]
struct Entry {
    /// The rays that met its parent.
    rays: u64,
    child: u32,
    /// Where its box is: the number of the node times eight, and the place.
    place: u32,
    near: f32,
}

/// A triangle that some ray met.
struct Meeting {
    /// Turned, as the rays are.
    corners: [[f32; 3]; 3],
    triangle: u32,
}

struct Packet<'a> {
    bvh: &'a TriangleBvh,
    axes: Axes,
    numbers: [u32; RAYS],
    sixteens: [Rays; RAYS / WIDE],
    /// How many of the sixteens hold rays.
    groups: usize,
    /// The rays that still search.
    alive: u64,
    /// None of them goes on beyond.
    limit: f32,
    /// The first stands for none.
    meetings: Vec<Meeting>,
}

/// Intervals around what nodes need of all rays.
struct Beam<L: Lanes> {
    inverse: [[L::Floats; 2]; 3],
    near_from: [L::Floats; 3],
    far_from: [L::Floats; 3],
    t_min: L::Floats,
    negative: [usize; 3],
}

impl<L: Lanes> Beam<L> {
    /// The children of a node that any ray may meet, a bit for each, and where the first enters them.
    ///
    /// Roundings are monotonic, so no bound is passed by what a single ray has.
    #[inline(always)]
    fn meet(&self, lanes: L, node: &Node, limit: L::Floats) -> (u32, L::Floats) {
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
}

/// The least or greatest of what all rays of a packet have. (No closure would do: what is not inlined into a level's entry is compiled
/// without its instructions.)
macro_rules! end {
    ($packet:expr, $wide:expr, $end:ident, $across:ident, $($of:tt)*) => {{
        let mut all = $wide.load(&$packet.sixteens[0].$($of)*);
        for group in 1..$packet.groups {
            all = $wide.$end($wide.load(&$packet.sixteens[group].$($of)*), all);
        }
        $wide.$across(all)
    }};
}

impl Packet<'_> {
    /// Takes the rays with the first numbers, and the last again where lanes are left.
    #[inline(always)]
    fn load<L: Lanes>(&mut self, lanes: L, rays: &[Ray], count: usize) {
        self.groups = count.div_ceil(WIDE);
        for k in (0..self.groups * WIDE).step_by(WIDTH) {
            let mut eight = [lanes.splat(0.0); WIDTH];
            for (i, row) in eight.iter_mut().enumerate() {
                let Ray { origin: o, dir: d, t_min, t_max } = rays[self.numbers[(k + i).min(count - 1)] as usize];
                *row = lanes.load(&[o.x, o.y, o.z, d.x, d.y, d.z, t_min, t_max]);
            }
            self.sixteens[k / WIDE].set(lanes, k % WIDE, eight);
        }
    }

    /// As [`Rays::signs`], for all.
    #[inline(always)]
    fn signs<L: Lanes>(&self, lanes: L) -> [u64; 5] {
        let mut signs = [0; 5];
        for group in 0..self.groups {
            for (all, some) in signs.iter_mut().zip(self.sixteens[group].signs(lanes)) {
                *all |= u64::from(some) << (group * WIDE);
            }
        }
        signs
    }

    /// Prepares the rays, which have a key in common; says whether they go together.
    #[inline(always)]
    fn prepare<L: Lanes>(&mut self, lanes: L, key: usize, count: usize) -> bool {
        self.axes = Axes::of_key(key);
        self.alive = 0;
        for group in 0..self.groups {
            let tame = self.sixteens[group].prepare(lanes, &self.axes, self.bvh.reach);
            self.alive |= u64::from(tame) << (group * WIDE);
        }
        let all = u64::MAX >> (RAYS - count);
        self.alive &= all;
        self.alive == all && self.is_narrow(lanes)
    }

    #[inline(always)]
    fn beam<L: Lanes>(&self, lanes: L) -> Beam<L> {
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
        let mut beam = Beam {
            inverse: [[nowhere; 2]; 3],
            near_from: [nowhere; 3],
            far_from: [nowhere; 3],
            t_min: least!(t_min),
            negative: self.axes.negative,
        };
        for axis in 0..3 {
            beam.inverse[axis] = [least!(inverse[axis]), greatest!(inverse[axis])];
            (beam.near_from[axis], beam.far_from[axis]) = match self.axes.negative[axis] {
                0 => (greatest!(near_from[axis]), least!(far_from[axis])),
                _ => (least!(near_from[axis]), greatest!(far_from[axis])),
            };
        }
        beam
    }

    /// The last t of any ray.
    #[inline(always)]
    fn last<L: Lanes>(&self, lanes: L) -> f32 {
        let wide = lanes.wide();
        end!(self, wide, max, greatest, t_last)
    }

    /// Whether rays are so near each other that they mostly meet the same boxes.
    #[inline(always)]
    fn is_narrow<L: Lanes>(&self, lanes: L) -> bool {
        let wide = lanes.wide();
        macro_rules! extent {
            ($($of:tt)*) => {
                end!(self, wide, max, greatest, $($of)*) - end!(self, wide, min, least, $($of)*)
            };
        }
        let apart = WIDEST_START * self.bvh.bounds.size().max_element();
        extent!(shear[0]).max(extent!(shear[1])) <= WIDEST_ANGLE
            && extent!(origin[0]).max(extent!(origin[1])).max(extent!(origin[2])) <= apart
    }

    #[inline(always)]
    fn walk<L: Lanes, const ANY: bool>(&mut self, lanes: L, stack: &mut Vec<Entry>) {
        let bvh = self.bvh;
        let beam = self.beam(lanes);
        self.limit = self.last(lanes);
        self.meetings.clear();
        self.meetings.push(Meeting { corners: [[0.0; 3]; 3], triangle: u32::MAX });
        stack.clear();
        let (mut child, mut rays) = (0, self.alive);
        loop {
            if child & LEAF == 0 {
                let node = &bvh.nodes[child as usize];
                let (met, enter) = beam.meet(lanes, node, lanes.splat(self.limit));
                if met != 0 {
                    // Along a rising axis the first place is nearest; the farthest is pushed first.
                    let rising = self.axes.positive & node.axis != 0;
                    let (first, last) = (met.trailing_zeros(), 31 - met.leading_zeros());
                    let nearest = if rising { first } else { last };
                    let (mut others, enter) = (met ^ 1 << nearest, lanes.store(enter));
                    while others != 0 {
                        let place = if rising { 31 - others.leading_zeros() } else { others.trailing_zeros() } & 7;
                        others ^= 1 << place;
                        let next = node.children[place as usize];
                        prefetch(lanes, bvh, next);
                        stack.push(Entry { rays, child: next, place: child * 8 + place, near: enter[place as usize] });
                    }
                    let inside = self.inside(lanes, node, nearest as usize & 7, rays);
                    if inside != 0 {
                        rays = inside;
                        child = node.children[nearest as usize & 7];
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
                rays = self.inside(lanes, &bvh.nodes[entry.place as usize / 8], entry.place as usize & 7, rays);
                if rays != 0 {
                    child = entry.child;
                    break;
                }
            }
        }
    }

    /// Of some rays those that meet the box of a child.
    #[inline(always)]
    fn inside<L: Lanes>(&self, lanes: L, node: &Node, place: usize, rays: u64) -> u64 {
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

    /// Tells what was found.
    #[inline(always)]
    fn answer<L: Lanes, const ANY: bool>(&self, lanes: L, all: u64, tell: &mut impl FnMut(usize, Option<TriangleHit>)) {
        for (group, e) in self.sixteens[..self.groups].iter().enumerate() {
            let rays = (all >> (group * WIDE)) as u32 & 0xffff;
            let mut corners = [[[0.0; WIDE]; 3]; 3];
            for first in [0, WIDTH].into_iter().filter(|_| !ANY) {
                // Eight of the nine numbers of each at once, then the last.
                let mut rows = [lanes.splat(0.0); WIDTH];
                for i in 0..WIDTH {
                    let [[a, b, c], [d, e, f], [g, h, last]] =
                        self.meetings[e.met[first + i].to_bits() as usize].corners;
                    rows[i] = lanes.load(&[a, b, c, d, e, f, g, h]);
                    corners[2][2][first + i] = last;
                }
                for (k, numbers) in lanes.transpose(rows).into_iter().enumerate() {
                    corners[k / 3][k % 3][first..first + WIDTH].copy_from_slice(&lanes.store(numbers));
                }
            }
            let [u, v] = if ANY { [[0.0; WIDE]; 2] } else { e.uv(&self.axes, &corners) };
            for i in (0..WIDE).filter(|i| rays >> i & 1 == 1) {
                let (number, met) = (self.numbers[group * WIDE + i] as usize, e.met[i].to_bits());
                if met == 0 {
                    tell(number, None);
                } else {
                    let triangle = if ANY { 0 } else { self.meetings[met as usize].triangle };
                    tell(number, Some(TriangleHit { t: e.t_last[i], uv: Vec2::new(u[i], v[i]), triangle }));
                }
            }
        }
    }
}
