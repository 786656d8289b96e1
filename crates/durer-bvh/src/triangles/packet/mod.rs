//! Rays that go nearly the same way, through one tree together.
//!
//! Up to 64 rays whose directions have the same signs and the same longest axis are a packet. A
//! node is tested once for all of them, by interval arithmetic; what is left of its children is
//! tested against the rays side by side when it is visited, and so is each triangle of a leaf. All
//! tests of triangles are those of single rays, with the same roundings, so answers are the same.
//!
//! Sources: Wald, Slusallek, Benthin, Wagner, *Interactive Rendering with Coherent Ray Tracing*,
//! Eurographics 2001; Boulos, Wald, Shirley, *Geometric and Arithmetic Culling Methods for Entire
//! Ray Packets*, University of Utah 2006.

/// The least or greatest of what all rays of a packet have. (No closure would do: what is not
/// inlined into a level's entry is compiled without its instructions.)
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
mod walk;

use super::tree::{TriangleBvh, TriangleHit};
use crate::lanes::{Kernel, Lanes, Numbers, WIDE, WIDTH, Wide, numbers_of};
use crate::math::{Ray, Vec2};
use bundle::{Packet, RAYS, Sixteens};
use glam::Vec3A;
use shared::{Axes, Meeting};
use std::cell::RefCell;
use walk::Entry;

/// So few are better off alone.
const MIN_SIZE: usize = 16;
/// After rays that do not go together so many windows of rays are left out at most, before it is
/// tried again.
const MAX_SKIPPED_WINDOWS: u32 = 15;
/// As far apart directions of a packet may be across the longest axis, for one unit along it.
const MAX_ANGLE: f32 = 0.5;
/// As far apart origins may be, where the longest side of the tree's bounds is 1.
const MAX_START: f32 = 0.25;

impl TriangleBvh {
    /// Answers for rays that go together, and then tells the numbers of the others. Where `ANY`, any
    /// hit will do, and only whether there is one means anything.
    pub(super) fn packets<const ANY: bool>(
        &self,
        rays: &[Ray],
        answer: impl FnMut(usize, Option<TriangleHit>),
        others: impl FnOnce(&[u32]),
    ) {
        SCRATCH.with_borrow_mut(|scratch| {
            scratch.rest.clear();
            if self.nodes.is_empty() || self.least_volume != 0.0 {
                scratch.rest.extend(0..rays.len() as u32);
            } else {
                self.level.run(Packets::<_, ANY> { bvh: self, rays, answer, scratch });
            }
            others(&scratch.rest);
        });
    }
}

/// What is used anew for each batch, one a thread: batches may be small.
#[derive(Default)]
struct Scratch {
    /// Numbers of rays that do not go together.
    rest: Vec<u32>,
    meetings: Vec<Meeting>,
    stack: Vec<Entry>,
    sixteens: Box<Sixteens>,
}

thread_local! {
    static SCRATCH: RefCell<Scratch> = RefCell::default();
}

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
        let Scratch { rest, meetings, stack, sixteens } = self.scratch;
        let mut packet = Packet {
            bvh: self.bvh,
            axes: Axes::of_key(0),
            numbers: [0; RAYS],
            sixteens,
            groups: 0,
            is_point: false,
            alive: 0,
            met: 0,
            limit: 0.0,
            meetings,
        };
        // Where no rays go together, or none are fast, the next are likely to be alike: it is tried
        // ever less often.
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
            // What is next comes near while these rays are on their way.
            if self.rays.len() > first as usize + RAYS {
                for line in 0..RAYS / 2 {
                    lanes.prefetch(rays.as_ptr().wrapping_add(RAYS + 2 * line));
                }
            }
            let signs = packet.signs(lanes);
            // Usually all have the same key, and are where they should be; else those of each key
            // are put together.
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
                packet.meetings.clear();
                packet.meetings.push(Meeting::new([Vec3A::ZERO; 3], u32::MAX));
                packet.traverse::<L, ANY>(lanes, stack);
                packet.answer::<L, ANY>(lanes, count, &mut self.answer);
            }
            left_out = if rest.len() < before + rays.len() { 0 } else { MAX_SKIPPED_WINDOWS.min(2 * left_out + 1) };
            leave_out = left_out;
        }
    }
}

/// The key of a ray, by what [`PacketRays::signs`] says of all.
#[inline(always)]
fn key_of([x, y, z, first, second]: [u64; 5], ray: u32) -> usize {
    let of = |set: u64| (set >> ray & 1) as usize;
    let longest = if of(first) == 1 { 0 } else { 2 - of(second) };
    of(x) | of(y) << 1 | of(z) << 2 | longest << 3
}

/// Of rays those with a key.
#[inline(always)]
fn with_key([x, y, z, first, second]: [u64; 5], key: usize) -> u64 {
    let of = |set: u64, bit: usize| if key >> bit & 1 == 1 { set } else { !set };
    let longest = [first, second, !(first | second)][key >> 3];
    of(x, 0) & of(y, 1) & of(z, 2) & longest
}

impl Packet<'_> {
    /// Takes the rays with the first numbers, and the last again where lanes are left. `in_order`
    /// are rays of which it is known that they are the first.
    #[inline(always)]
    fn load<L: Lanes>(&mut self, lanes: L, rays: &[Ray], count: usize, in_order: &[Ray]) {
        self.groups = count.div_ceil(WIDE);
        for k in (0..self.groups * WIDE).step_by(WIDTH) {
            let mut eight = [lanes.splat(0.0); WIDTH];
            match in_order.get(k..k + WIDTH) {
                Some(rays) => {
                    for (row, ray) in eight.iter_mut().zip(rays) {
                        *row = lanes.load(numbers_of(ray));
                    }
                }
                None => {
                    for (i, row) in eight.iter_mut().enumerate() {
                        *row = lanes.load(numbers_of(&rays[self.numbers[(k + i).min(count - 1)] as usize]));
                    }
                }
            }
            self.sixteens[k / WIDE].set(lanes, k % WIDE, eight);
        }
    }

    /// As [`PacketRays::signs`], for all.
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
        (self.alive, self.met) = (0, 0);
        for group in 0..self.groups {
            let fast = self.sixteens[group].prepare(lanes, &self.axes, self.bvh.reach);
            self.alive |= u64::from(fast) << (group * WIDE);
        }
        let all = u64::MAX >> (RAYS - count);
        self.alive &= all;
        self.is_point = self.is_point(lanes);
        self.alive == all && self.is_narrow(lanes)
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
        let apart = MAX_START * self.bvh.bounds.size().max_element();
        extent!(shear[0]).max(extent!(shear[1])) <= MAX_ANGLE
            && (self.is_point || extent!(origin[0]).max(extent!(origin[1])).max(extent!(origin[2])) <= apart)
    }

    /// Whether all rays begin at the same point.
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

    /// Tells what so many rays have found.
    #[inline(always)]
    fn answer<L: Lanes, const ANY: bool>(
        &self,
        lanes: L,
        count: usize,
        tell: &mut impl FnMut(usize, Option<TriangleHit>),
    ) {
        for (k, numbers) in self.numbers[..count].chunks(WIDTH).enumerate() {
            let (e, half, mut met) = (&self.sixteens[k / 2], k % 2, self.met >> (k * WIDTH) & 255);
            let [u, v] = match !ANY && met != 0 {
                true => e.uv(lanes, &self.axes, half, self.corners(lanes, e.meetings(half))),
                false => [[0.0; WIDTH]; 2],
            };
            for (i, &number) in numbers.iter().enumerate() {
                let is_met = met & 1 == 1;
                met >>= 1;
                let hit = if ANY {
                    is_met.then_some(TriangleHit { t: 0.0, uv: Vec2::ZERO, triangle: 0 })
                } else if is_met {
                    let triangle = self.meetings[e.meetings(half)[i].to_bits() as usize].triangle;
                    Some(TriangleHit { t: e.t_last[half * WIDTH + i], uv: Vec2::new(u[i], v[i]), triangle })
                } else {
                    None
                };
                tell(number as usize, hit);
            }
        }
    }

    /// By corner and coordinate, the triangles of eight meetings.
    #[inline(always)]
    fn corners<L: Lanes>(&self, lanes: L, numbers: &[f32; WIDTH]) -> [[L::Floats; 3]; 3] {
        let [first, ..] = *numbers;
        // Often they are the same; as integers, for as numbers they are next to nothing.
        let (all, one) = (lanes.load(numbers), lanes.splat(first));
        if lanes.signs(lanes.before(all, one)) | lanes.signs(lanes.before(one, all)) == 0 {
            let [a, b, c] = self.meetings[first.to_bits() as usize].corners;
            return [lanes.splat3(a), lanes.splat3(b), lanes.splat3(c)];
        }
        // Eight of the nine numbers of each at once, then the last.
        let (mut rows, mut lasts) = ([lanes.splat(0.0); WIDTH], [0.0; WIDTH]);
        for ((row, last), number) in rows.iter_mut().zip(&mut lasts).zip(numbers) {
            let [[a, b, c], [d, e, f], [g, h, i]] = self.meetings[number.to_bits() as usize].corners;
            (*row, *last) = (lanes.load(&[a, b, c, d, e, f, g, h]), i);
        }
        let [a, b, c, d, e, f, g, h] = lanes.transpose(rows);
        [[a, b, c], [d, e, f], [g, h, lanes.load(&lasts)]]
    }
}
