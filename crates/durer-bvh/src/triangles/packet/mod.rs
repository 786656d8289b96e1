//! Traverses the tree with packets of coherent rays.
//!
//! A packet holds up to 64 rays whose directions have the same signs and the same longest axis.
//! Interval arithmetic tests the children of a node once for all rays of the packet. When a child
//! is visited, its box is tested again with one ray per lane, and the triangles of a leaf are
//! tested in the same way. Triangle tests have the same rounding as for single rays, so the hits
//! are the same.
//!
//! Sources: Wald, Slusallek, Benthin, Wagner, *Interactive Rendering with Coherent Ray Tracing*,
//! Eurographics 2001; Boulos, Wald, Shirley, *Geometric and Arithmetic Culling Methods for Entire
//! Ray Packets*, University of Utah 2006.

/// Returns the minimum or maximum of a value over all rays of a packet. (A closure might not be
/// inlined, and it would then be compiled without the instructions of the SIMD level.)
macro_rules! end {
    ($packet:expr, $wide:expr, $end:ident, $across:ident, $($of:tt)*) => {{
        let mut all = $wide.load(&$packet.sixteens[0].$($of)*);
        for group in 1..$packet.groups {
            all = $wide.$end($wide.load(&$packet.sixteens[group].$($of)*), all);
        }
        $wide.$across(all)
    }};
}

mod bundle;
mod leaf;
mod rays;
mod shared;
mod traverse;

use super::tree::{TriangleBvh, TriangleHit};
use crate::lanes::{FloatLanes, Kernel, Lanes, WIDE, WIDTH, WideLanes, as_floats};
use crate::math::{Ray, Vec2};
use bundle::{Packet, RAYS, RayGroups};
use glam::Vec3A;
use shared::{HitTriangle, PacketAxes};
use std::cell::RefCell;
use traverse::StackEntry;

/// Minimum number of rays in a packet. With fewer rays, tracing them one by one is faster.
const MIN_SIZE: usize = 16;
/// Maximum number of windows that are skipped after a window of incoherent rays.
const MAX_SKIPPED_WINDOWS: u32 = 15;
/// Maximum spread of the directions of a packet perpendicular to the longest axis, per unit along
/// that axis.
const MAX_DIRECTION_SPREAD: f32 = 0.5;
/// Maximum spread of the origins, relative to the longest side of the tree's bounds.
const MAX_ORIGIN_SPREAD: f32 = 0.25;

impl TriangleBvh {
    /// Traces coherent rays in packets, and then passes the numbers of the other rays to `others`.
    /// If `ANY` is true, the answer only says whether there is any hit.
    pub(super) fn packets<const ANY: bool>(
        &self,
        rays: &[Ray],
        answer: impl FnMut(usize, Option<TriangleHit>),
        others: impl FnOnce(&[u32]),
    ) {
        SCRATCH.with_borrow_mut(|scratch| {
            scratch.rest.clear();
            if self.nodes.is_empty() || self.min_volume != 0.0 {
                scratch.rest.extend(0..rays.len() as u32);
            } else {
                self.level.run(Packets::<_, ANY> { bvh: self, rays, answer, scratch });
            }
            others(&scratch.rest);
        });
    }
}

/// Buffers for packets. All batches of a thread reuse them because batches can be small.
#[derive(Default)]
struct Scratch {
    /// Numbers of the rays that are not traced in packets.
    rest: Vec<u32>,
    packet_hits: Vec<HitTriangle>,
    stack: Vec<StackEntry>,
    sixteens: Box<RayGroups>,
}

thread_local! {
    static SCRATCH: RefCell<Scratch> = RefCell::default();
}

/// Kernel that traces the coherent rays of a batch in packets.
struct Packets<'a, A, const ANY: bool> {
    bvh: &'a TriangleBvh,
    rays: &'a [Ray],
    answer: A,
    scratch: &'a mut Scratch,
}

impl<A: FnMut(usize, Option<TriangleHit>), const ANY: bool> Kernel for Packets<'_, A, ANY> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self, lanes: L) {
        let Scratch { rest, packet_hits, stack, sixteens } = self.scratch;
        let mut packet = Packet {
            bvh: self.bvh,
            axes: PacketAxes::of_key(0),
            numbers: [0; RAYS],
            sixteens,
            groups: 0,
            has_common_origin: false,
            alive: 0,
            hit_mask: 0,
            limit: 0.0,
            packet_hits,
        };
        // If the rays of a window are incoherent, or if none of them is fast, the following rays
        // are probably similar. Packets are therefore tried less and less often.
        let (mut left_out, mut leave_out) = (0, 0);
        for (window, rays) in self.rays.chunks(RAYS).enumerate() {
            let first = (window * RAYS) as u32;
            if leave_out > 0 {
                leave_out -= 1;
                rest.extend(first..first + rays.len() as u32);
                continue;
            }
            let before = rest.len();
            let all = u64::MAX >> (RAYS - rays.len());
            for (i, number) in packet.numbers.iter_mut().enumerate() {
                *number = first + i as u32;
            }
            packet.load(lanes, self.rays, rays.len(), rays);
            // Prefetch the next window while these rays are traced.
            if self.rays.len() > first as usize + RAYS {
                for line in 0..RAYS / 2 {
                    lanes.prefetch(rays.as_ptr().wrapping_add(RAYS + 2 * line));
                }
            }
            let signs = packet.signs(lanes);
            // Usually all rays have the same key and have already been loaded. Otherwise, collect
            // the rays of each key.
            let mut left = all;
            while left != 0 {
                let key = key_of(signs, left.trailing_zeros());
                let mut members = with_key(signs, key) & all;
                left &= !members;
                let count = members.count_ones() as usize;
                if members != all {
                    for number in &mut packet.numbers[..count] {
                        *number = first + members.trailing_zeros();
                        members &= members - 1;
                    }
                    if count >= MIN_SIZE {
                        packet.load(lanes, self.rays, count, &[]);
                    }
                }
                if count < MIN_SIZE || !packet.prepare(lanes, key, count) {
                    rest.extend_from_slice(&packet.numbers[..count]);
                    continue;
                }
                packet.packet_hits.clear();
                packet.packet_hits.push(HitTriangle::new([Vec3A::ZERO; 3], u32::MAX));
                packet.traverse::<L, ANY>(lanes, stack);
                packet.answer::<L, ANY>(lanes, count, &mut self.answer);
            }
            left_out = if rest.len() < before + rays.len() { 0 } else { MAX_SKIPPED_WINDOWS.min(2 * left_out + 1) };
            leave_out = left_out;
        }
    }
}

/// Returns the key of a ray, given the masks of [`PacketRays::signs`].
#[inline(always)]
fn key_of([x, y, z, first, second]: [u64; 5], ray: u32) -> usize {
    let of = |set: u64| (set >> ray & 1) as usize;
    let longest = if of(first) == 1 { 0 } else { 2 - of(second) };
    of(x) | of(y) << 1 | of(z) << 2 | longest << 3
}

/// Returns a mask of the rays with a key.
#[inline(always)]
fn with_key([x, y, z, first, second]: [u64; 5], key: usize) -> u64 {
    let of = |set: u64, bit: usize| if key >> bit & 1 == 1 { set } else { !set };
    let longest = [first, second, !(first | second)][key >> 3];
    of(x, 0) & of(y, 1) & of(z, 2) & longest
}

impl Packet<'_> {
    /// Loads the first `count` rays whose numbers are given, and repeats the last one in unused
    /// lanes. If the rays are consecutive, `in_order` holds them too.
    #[inline(always)]
    fn load<L: Lanes>(&mut self, lanes: L, rays: &[Ray], count: usize, in_order: &[Ray]) {
        self.groups = count.div_ceil(WIDE);
        for k in (0..self.groups * WIDE).step_by(WIDTH) {
            let mut eight = [lanes.splat(0.0); WIDTH];
            match in_order.get(k..k + WIDTH) {
                Some(rays) => {
                    for (row, ray) in eight.iter_mut().zip(rays) {
                        *row = lanes.load(as_floats(ray));
                    }
                }
                None => {
                    for (i, row) in eight.iter_mut().enumerate() {
                        *row = lanes.load(as_floats(&rays[self.numbers[(k + i).min(count - 1)] as usize]));
                    }
                }
            }
            self.sixteens[k / WIDE].set(lanes, k % WIDE, eight);
        }
    }

    /// Computes [`PacketRays::signs`] for all groups.
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

    /// Prepares rays that have the same key. Returns true if they are coherent.
    #[inline(always)]
    fn prepare<L: Lanes>(&mut self, lanes: L, key: usize, count: usize) -> bool {
        self.axes = PacketAxes::of_key(key);
        (self.alive, self.hit_mask) = (0, 0);
        for group in 0..self.groups {
            let fast = self.sixteens[group].prepare(lanes, &self.axes, self.bvh.reach);
            self.alive |= u64::from(fast) << (group * WIDE);
        }
        let all = u64::MAX >> (RAYS - count);
        self.alive &= all;
        self.has_common_origin = self.is_point(lanes);
        self.alive == all && self.is_narrow(lanes)
    }

    /// Returns true if the rays are so close together that they mostly hit the same boxes.
    #[inline(always)]
    fn is_narrow<L: Lanes>(&self, lanes: L) -> bool {
        let wide = lanes.wide();
        macro_rules! extent {
            ($($of:tt)*) => {
                end!(self, wide, max, greatest, $($of)*) - end!(self, wide, min, least, $($of)*)
            };
        }
        let apart = MAX_ORIGIN_SPREAD * self.bvh.bounds.size().max_element();
        extent!(shear[0]).max(extent!(shear[1])) <= MAX_DIRECTION_SPREAD
            && (self.has_common_origin || extent!(origin[0]).max(extent!(origin[1])).max(extent!(origin[2])) <= apart)
    }

    /// Returns true if all rays have the same origin.
    #[inline(always)]
    fn is_point<L: Lanes>(&self, lanes: L) -> bool {
        let wide = lanes.wide();
        let mut same = u32::MAX;
        for axis in 0..3 {
            let [first, .., last] = self.sixteens[0].origin[axis];
            if first != last {
                return false;
            }
            let first = wide.splat(first);
            for group in 0..self.groups {
                let origin = wide.load(&self.sixteens[group].origin[axis]);
                same &= wide.le(first, origin) & wide.le(origin, first);
            }
        }
        same & 0xffff == 0xffff
    }

    /// Passes the hits of the first `count` rays to `report`.
    #[inline(always)]
    fn answer<L: Lanes, const ANY: bool>(
        &self,
        lanes: L,
        count: usize,
        report: &mut impl FnMut(usize, Option<TriangleHit>),
    ) {
        for (k, numbers) in self.numbers[..count].chunks(WIDTH).enumerate() {
            let (e, half, mut hits) = (&self.sixteens[k / 2], k % 2, self.hit_mask >> (k * WIDTH) & 255);
            let [u, v] = match !ANY && hits != 0 {
                true => e.uv(lanes, &self.axes, half, self.corners(lanes, e.packet_hits(half))),
                false => [[0.0; WIDTH]; 2],
            };
            for (i, &number) in numbers.iter().enumerate() {
                let is_hit = hits & 1 == 1;
                hits >>= 1;
                let hit = if ANY {
                    is_hit.then_some(TriangleHit { t: 0.0, uv: Vec2::ZERO, triangle: 0 })
                } else if is_hit {
                    let triangle = self.packet_hits[e.packet_hits(half)[i].to_bits() as usize].triangle;
                    Some(TriangleHit { t: e.t_last[half * WIDTH + i], uv: Vec2::new(u[i], v[i]), triangle })
                } else {
                    None
                };
                report(number as usize, hit);
            }
        }
    }

    /// Returns the corners of the triangles that eight rays have hit, by corner and axis. `numbers`
    /// holds the indices in the list of hits as bit patterns.
    #[inline(always)]
    fn corners<L: Lanes>(&self, lanes: L, numbers: &[f32; WIDTH]) -> [[L::Floats; 3]; 3] {
        let [first, ..] = *numbers;
        // Often all of these triangles are the same. Indices are compared as integers because they
        // would be subnormal as floats.
        let (all, one) = (lanes.load(numbers), lanes.splat(first));
        if lanes.signs(lanes.lt_as_int(all, one)) | lanes.signs(lanes.lt_as_int(one, all)) == 0 {
            let [a, b, c] = self.packet_hits[first.to_bits() as usize].corners;
            return [lanes.splat3(a), lanes.splat3(b), lanes.splat3(c)];
        }
        // For each triangle, load eight of the nine coordinates at once and then the last one.
        let (mut rows, mut lasts) = ([lanes.splat(0.0); WIDTH], [0.0; WIDTH]);
        for ((row, last), number) in rows.iter_mut().zip(&mut lasts).zip(numbers) {
            let [[a, b, c], [d, e, f], [g, h, i]] = self.packet_hits[number.to_bits() as usize].corners;
            (*row, *last) = (lanes.load(&[a, b, c, d, e, f, g, h]), i);
        }
        let [a, b, c, d, e, f, g, h] = lanes.transpose(rows);
        [[a, b, c], [d, e, f], [g, h, lanes.load(&lasts)]]
    }
}
