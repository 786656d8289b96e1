//! Rays that go nearly the same way, through one tree together.
//!
//! Up to 64 rays whose directions have the same signs and the same longest axis are a packet. A node is tested once for all of them, by
//! interval arithmetic; what is left of its children is tested against the rays side by side when it is visited, and so is each
//! triangle of a leaf. All tests of triangles are those of single rays, with the same roundings, so answers are the same.
//!
//! Sources: Wald, Slusallek, Benthin, Wagner, *Interactive Rendering with Coherent Ray Tracing*, Eurographics 2001; Boulos, Wald,
//! Shirley, *Geometric and Arithmetic Culling Methods for Entire Ray Packets*, University of Utah 2006.

mod eight;

use super::leaf::{edge, flat};
use super::{TriangleBvh, TriangleHit};
use crate::bvh::lanes::{Kernel, Lanes, WIDTH, column};
use crate::bvh::node::{self, LEAF, Node};
use crate::bvh::traverse::{RANKS, splat3};
use crate::math::{Ray, Vec2, Vec3};
use crate::shape::watertight::Sheared;
use eight::Eight;

/// How many rays may be in a packet.
const RAYS: usize = 64;
/// So few are better off alone.
const LEAST: usize = 16;

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
    flip: u32,
}

impl Axes {
    /// How many keys there are.
    const COUNT: usize = 24;

    /// A number for the signs and the longest axis of a direction.
    #[inline(always)]
    fn key(dir: Vec3) -> usize {
        let d = dir.abs();
        let longest = if d.x > d.y && d.x > d.z {
            0
        } else if d.y > d.z {
            1
        } else {
            2
        };
        let sign = |x: f32| (x.to_bits() >> 31) as usize;
        longest << 3 | sign(dir.z) << 2 | sign(dir.y) << 1 | sign(dir.x)
    }

    fn of_key(key: usize) -> Self {
        let negative = [key & 1, key >> 1 & 1, key >> 2 & 1];
        let z = key >> 3;
        let (mut x, mut y) = ((z + 1) % 3, (z + 2) % 3);
        if negative[z] == 1 {
            std::mem::swap(&mut x, &mut y);
        }
        Axes { turned: [x, y, z], negative, flip: 7 ^ (key as u32 & 7) }
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
            eights: [Eight::EMPTY; RAYS / WIDTH],
            groups: 0,
            alive: 0,
            limit: 0.0,
        };
        let mut stack = Vec::with_capacity(256);
        for (window, rays) in self.rays.chunks(RAYS).enumerate() {
            let first = (window * RAYS) as u32;
            let mut keys = [0; RAYS];
            let mut counts = [0; 32];
            for (key, ray) in keys.iter_mut().zip(rays) {
                *key = Axes::key(ray.dir) as u8;
                counts[usize::from(*key & 31)] += 1;
            }
            for key in (0..Axes::COUNT).filter(|&key| counts[key] > 0) {
                let mut count = 0;
                for (i, _) in keys[..rays.len()].iter().enumerate().filter(|(_, k)| usize::from(**k) == key) {
                    packet.numbers[count] = first + i as u32;
                    count += 1;
                }
                if count < LEAST || !packet.form(lanes, self.rays, key, count) {
                    rest.extend_from_slice(&packet.numbers[..count]);
                    continue;
                }
                let all = packet.alive;
                packet.walk::<L, ANY>(lanes, &mut stack);
                packet.answer::<ANY>(all, &mut self.answer);
            }
        }
        rest
    }
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

struct Packet<'a> {
    bvh: &'a TriangleBvh,
    axes: Axes,
    numbers: [u32; RAYS],
    eights: [Eight; RAYS / WIDTH],
    /// How many of the eights hold rays.
    groups: usize,
    /// The rays that still search.
    alive: u64,
    /// None of them goes on beyond.
    limit: f32,
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
    #[inline(always)]
    fn meet(&self, lanes: L, node: &Node, limit: L::Floats) -> (usize, L::Floats) {
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
        (lanes.le(enter, leave) as usize & 255, enter)
    }
}

/// The least or greatest of all lanes.
macro_rules! across {
    ($end:ident, $lanes:expr) => {{
        let lanes = $lanes;
        let mut all = lanes[0];
        for lane in &lanes[1..] {
            all = all.$end(*lane);
        }
        all
    }};
}

impl Packet<'_> {
    /// Prepares the rays with the first numbers; says whether they go together.
    #[inline(always)]
    fn form<L: Lanes>(&mut self, lanes: L, rays: &[Ray], key: usize, count: usize) -> bool {
        self.axes = Axes::of_key(key);
        self.alive = 0;
        for k in 0..count.next_multiple_of(WIDTH) {
            let ray = &rays[self.numbers[if k < count { k } else { 0 }] as usize];
            self.eights[k / WIDTH].set(k % WIDTH, ray);
        }
        self.groups = count.div_ceil(WIDTH);
        for group in 0..self.groups {
            let tame = self.eights[group].prepare(lanes, &self.axes, self.bvh.bounds);
            self.alive |= u64::from(tame) << (group * WIDTH);
        }
        let all = u64::MAX >> (64 - count);
        self.alive &= all;
        self.alive == all
    }

    #[inline(always)]
    fn beam<L: Lanes>(&self, lanes: L) -> Beam<L> {
        // No closures: what is not inlined into the level's entry is compiled without its instructions.
        macro_rules! end {
            ($end:ident, $($of:tt)*) => {{
                let mut all = lanes.load(&self.eights[0].$($of)*);
                for group in 1..self.groups {
                    all = lanes.$end(lanes.load(&self.eights[group].$($of)*), all);
                }
                lanes.splat(across!($end, lanes.store(all)))
            }};
        }
        let nowhere = lanes.splat(0.0);
        let mut beam = Beam {
            inverse: [[nowhere; 2]; 3],
            near_from: [nowhere; 3],
            far_from: [nowhere; 3],
            t_min: end!(min, t_min),
            negative: self.axes.negative,
        };
        for axis in 0..3 {
            beam.inverse[axis] = [end!(min, inverse[axis]), end!(max, inverse[axis])];
            (beam.near_from[axis], beam.far_from[axis]) = match self.axes.negative[axis] {
                0 => (end!(max, near_from[axis]), end!(min, far_from[axis])),
                _ => (end!(min, near_from[axis]), end!(max, far_from[axis])),
            };
        }
        beam
    }

    /// The last t of any ray.
    #[inline(always)]
    fn last<L: Lanes>(&self, lanes: L) -> f32 {
        let mut all = lanes.load(&self.eights[0].t_last);
        for group in 1..self.groups {
            all = lanes.max(lanes.load(&self.eights[group].t_last), all);
        }
        across!(max, lanes.store(all))
    }

    #[inline(always)]
    fn walk<L: Lanes, const ANY: bool>(&mut self, lanes: L, stack: &mut Vec<Entry>) {
        let bvh = self.bvh;
        let beam = self.beam(lanes);
        self.limit = self.last(lanes);
        let flip = self.axes.flip;
        stack.clear();
        let (mut child, mut rays) = (0, self.alive);
        loop {
            if child & LEAF == 0 {
                let node = &bvh.nodes[child as usize];
                let (met, enter) = beam.meet(lanes, node, lanes.splat(self.limit));
                if met != 0 {
                    let [nearest, others] = RANKS[flip as usize & 7][met];
                    let enter = lanes.store(enter);
                    let mut others = others;
                    while others != 0 {
                        let place = (others.trailing_zeros() ^ flip) & 7;
                        others &= others - 1;
                        let next = node.children[place as usize];
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
                rays = entry.rays;
                if ANY {
                    rays &= self.alive;
                }
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
        let [x, y, z] = self.axes.negative;
        let near = [node.planes[0][x & 1], node.planes[1][y & 1], node.planes[2][z & 1]].map(|p| p[place]);
        let far = [node.planes[0][!x & 1], node.planes[1][!y & 1], node.planes[2][!z & 1]].map(|p| p[place]);
        let ([near_x, near_y, near_z], [far_x, far_y, far_z]) = (splat3(lanes, near), splat3(lanes, far));
        let mut inside = 0;
        for (group, e) in self.eights.iter().enumerate() {
            if rays >> (group * WIDTH) & 255 == 0 {
                continue;
            }
            macro_rules! slab {
                ($axis:literal, $plane:ident, $origin:ident) => {
                    lanes.mul_add($plane, lanes.load(&e.inverse[$axis]), lanes.load(&e.$origin[$axis]))
                };
            }
            let enter = lanes.max(slab!(0, near_x, near_origin), slab!(1, near_y, near_origin));
            let enter = lanes.max(enter, lanes.max(slab!(2, near_z, near_origin), lanes.load(&e.t_min)));
            let leave = lanes.min(slab!(0, far_x, far_origin), slab!(1, far_y, far_origin));
            let leave = lanes.min(leave, lanes.min(slab!(2, far_z, far_origin), lanes.load(&e.t_last)));
            inside |= u64::from(lanes.le(enter, leave) & 255) << (group * WIDTH);
        }
        inside & rays
    }

    /// Some rays among the triangles of a leaf.
    #[inline(always)]
    fn leaf<L: Lanes, const ANY: bool>(&mut self, lanes: L, leaf: u32, mut rays: u64) {
        let (first, count) = node::items(leaf);
        let [x, y, z] = self.axes.turned;
        let zero = lanes.splat(0.0);
        let mut changed = false;
        for place in 0..count {
            let corners = column(&self.bvh.corners[9 * first..9 * (first + count)], count, self.axes.turned, place);
            let rows = [splat3(lanes, corners[0]), splat3(lanes, corners[1]), splat3(lanes, corners[2])];
            for group in 0..RAYS / WIDTH {
                let active = (rays >> (group * WIDTH)) as u32 & 255;
                if active == 0 {
                    continue;
                }
                let e = &self.eights[group];
                let origin = [lanes.load(&e.origin[x]), lanes.load(&e.origin[y]), lanes.load(&e.origin[z])];
                let shear = [lanes.load(&e.shear[0]), lanes.load(&e.shear[1])];
                let a = flat(lanes, rows[0], origin, shear);
                let b = flat(lanes, rows[1], origin, shear);
                let c = flat(lanes, rows[2], origin, shear);
                let (u, v, w) = (edge(lanes, b, c), edge(lanes, c, a), edge(lanes, a, b));
                let (least, greatest) = (lanes.min(u, lanes.min(v, w)), lanes.max(u, lanes.max(v, w)));
                let missed = lanes.lt(least, zero) & lanes.lt(zero, greatest);
                let lowest = lanes.min(a[2], lanes.min(b[2], c[2]));
                let highest = lanes.max(a[2], lanes.max(b[2], c[2]));
                let beside =
                    lanes.lt(lanes.load(&e.heights[1]), lowest) | lanes.lt(highest, lanes.load(&e.heights[0]));
                let candidates = !(missed | beside) & active;
                if candidates == 0 {
                    continue;
                }
                let mut crossed = candidates & (lanes.lt(zero, least) | lanes.lt(greatest, zero));
                let corners = corners.map(Vec3::from);
                let mut unsure = candidates & !crossed;
                while unsure != 0 {
                    let lane = unsure.trailing_zeros();
                    unsure &= unsure - 1;
                    crossed |= u32::from(crosses(e, lane as usize, corners)) << lane;
                }
                let triangle = self.bvh.order[first + place];
                let e = &mut self.eights[group];
                let hit = e.meet(&self.axes, corners, crossed, triangle, leaf, place as u32);
                if hit != 0 {
                    changed = true;
                    if ANY {
                        rays &= !(u64::from(hit) << (group * WIDTH));
                        self.alive &= !(u64::from(hit) << (group * WIDTH));
                    } else {
                        e.bound(lanes, &self.axes);
                    }
                }
            }
        }
        if changed && !ANY {
            self.limit = self.last(lanes);
        }
    }

    /// Tells what was found.
    #[inline(always)]
    fn answer<const ANY: bool>(&self, all: u64, tell: &mut impl FnMut(usize, Option<TriangleHit>)) {
        for (group, e) in self.eights.iter().enumerate() {
            let rays = (all >> (group * WIDTH)) as u32 & 255;
            if rays == 0 {
                continue;
            }
            let mut corners = [[[0.0; WIDTH]; 3]; 3];
            if !ANY {
                for i in 0..WIDTH {
                    if e.met.triangle[i] != u32::MAX {
                        let (first, count) = node::items(e.met.leaf[i]);
                        let rows = &self.bvh.corners[9 * first..9 * (first + count)];
                        let c = column(rows, count, self.axes.turned, e.met.lane[i] as usize);
                        for corner in 0..3 {
                            for axis in 0..3 {
                                corners[corner][axis][i] = c[corner][axis];
                            }
                        }
                    }
                }
            }
            let [u, v] = if ANY { [[0.0; WIDTH]; 2] } else { e.uv(&self.axes, &corners) };
            for i in (0..WIDTH).filter(|i| rays >> i & 1 == 1) {
                let (t, triangle) = (e.t_last[i], e.met.triangle[i]);
                let hit = TriangleHit { t, uv: Vec2::new(u[i], v[i]), triangle };
                tell(self.numbers[group * WIDTH + i] as usize, (triangle != u32::MAX).then_some(hit));
            }
        }
    }
}

/// Whether one of the rays crosses a triangle, exactly.
#[cold]
fn crosses(e: &Eight, lane: usize, corners: [Vec3; 3]) -> bool {
    Sheared::new(&e.ray(lane)).crosses(corners)
}
