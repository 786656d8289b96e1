//! What a ray asks of a tree of triangles.

use super::fetch::{AND_SIBLINGS, Places};
use super::leaf::Flat;
use super::{TriangleBvh, TriangleHit, number};
use crate::Tally;
use crate::lanes::{Columns, Kernel, Lanes, WIDTH};
use crate::math::{Ray, Vec2};
use crate::traverse::{ORDINARY, RayBox, Visitor, walk};
use crate::watertight::{Exact, Plane, Sheared, turn};
use glam::Vec3A;
use std::marker::PhantomData;

/// A question, whose answer is an `F`.
pub struct Query<'a, T, F> {
    pub bvh: &'a TriangleBvh,
    pub ray: &'a Ray,
    pub tally: T,
    pub found: PhantomData<F>,
}

/// A ray among triangles.
pub struct Asked<'a> {
    bvh: &'a TriangleBvh,
    ray: &'a Ray,
    sheared: Sheared,
}

/// An answer in the making.
pub trait Found: Default {
    type Answer: Default;

    /// Whether it is enough to know that something is hit.
    const ANY: bool;

    /// Takes note of a hit, not after `t_max`; gives the new one.
    fn met(&mut self, hit: TriangleHit, t_max: f32) -> f32;

    /// When the search has ended, and whether it was enough that something was hit.
    fn answer(&mut self, any: bool) -> Self::Answer;
}

/// The first hit.
pub struct Nearest {
    /// One of the number [`NONE`] before there is any.
    best: TriangleHit,
}

const NONE: u32 = u32::MAX;

impl Default for Nearest {
    #[inline(always)]
    fn default() -> Self {
        Nearest { best: TriangleHit { t: f32::INFINITY, uv: Vec2::ZERO, triangle: NONE } }
    }
}

impl Found for Nearest {
    type Answer = Option<TriangleHit>;

    const ANY: bool = false;

    #[inline(always)]
    fn met(&mut self, hit: TriangleHit, t_max: f32) -> f32 {
        // What is the best before there is any has the greatest number.
        if hit.t < t_max || hit.triangle < self.best.triangle {
            self.best = hit;
        }
        hit.t
    }

    #[inline(always)]
    fn answer(&mut self, _: bool) -> Option<TriangleHit> {
        (self.best.triangle != NONE).then_some(self.best)
    }
}

/// Whether there is a hit.
#[derive(Default)]
pub struct Any;

impl Found for Any {
    type Answer = bool;

    const ANY: bool = true;

    #[inline(always)]
    fn met(&mut self, _: TriangleHit, _: f32) -> f32 {
        f32::NEG_INFINITY
    }

    #[inline(always)]
    fn answer(&mut self, any: bool) -> bool {
        any
    }
}

/// Every hit, some of them several times.
#[derive(Default)]
pub struct All(Vec<TriangleHit>);

impl Found for All {
    type Answer = Vec<TriangleHit>;

    const ANY: bool = false;

    fn met(&mut self, hit: TriangleHit, t_max: f32) -> f32 {
        self.0.push(hit);
        t_max
    }

    fn answer(&mut self, _: bool) -> Vec<TriangleHit> {
        std::mem::take(&mut self.0)
    }
}

impl Asked<'_> {
    /// The corners of a triangle, turned as the ray is, and its number.
    #[inline(always)]
    fn triangle(&self, leaf: u32, lane: usize) -> ([Vec3A; 3], u32) {
        let (rows, count) = self.bvh.rows(leaf);
        (Columns::new(self.sheared.axes(), count).triangle(rows, lane), number(rows, count, lane))
    }

    #[inline(always)]
    fn is_wanted(&self, t: f32, t_max: f32) -> bool {
        self.ray.contains(t) && t <= t_max
    }
}

impl<T: Tally, F: Found> Kernel for Query<'_, T, F> {
    type Output = F::Answer;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> F::Answer {
        if let Some(boxes) = RayBox::new(self.ray, self.bvh.reach) {
            self.search::<L, true>(lanes, &boxes)
        } else if let Some(boxes) = RayBox::wild(self.ray, self.bvh.reach) {
            self.search::<L, false>(lanes, &boxes)
        } else {
            F::Answer::default()
        }
    }
}

impl<T: Tally, F: Found> Query<'_, T, F> {
    #[inline(always)]
    fn search<L: Lanes, const TAME: bool>(self, lanes: L, boxes: &RayBox) -> F::Answer {
        let Query { bvh, ray, tally, .. } = self;
        let mut leaves = Leaves::<_, F>::new(lanes, bvh, ray, boxes, tally);
        let t_max = walk::<L, _, TAME>(lanes, &bvh.nodes, boxes, ray.t_max, &mut leaves);
        leaves.answer(t_max)
    }
}

/// A ray among the triangles of leaves.
pub struct Leaves<'a, T, F> {
    asked: Asked<'a>,
    places: Places,
    tally: T,
    found: F,
    /// Whether signs found side by side are within the range of numbers.
    side_by_side: bool,
}

impl<'a, T, F: Found> Leaves<'a, T, F> {
    #[inline(always)]
    pub fn new<L: Lanes>(lanes: L, bvh: &'a TriangleBvh, ray: &'a Ray, boxes: &RayBox, tally: T) -> Self {
        let (origin, dir) = (Vec3A::from(ray.origin), Vec3A::from(ray.dir));
        let axes = turn(dir);
        let sheared = Sheared::turned(axes, lanes.turn(origin, axes), lanes.turn(dir, axes));
        Leaves {
            asked: Asked { bvh, ray, sheared },
            places: Places::new(bvh),
            tally,
            found: F::default(),
            side_by_side: boxes.moderate,
        }
    }

    /// What was found, when the search has ended.
    #[inline(always)]
    pub fn answer(&mut self, t_max: f32) -> F::Answer {
        self.found.answer(t_max == f32::NEG_INFINITY)
    }
}

impl<T: Tally, F: Found> Visitor for Leaves<'_, T, F> {
    type Tally = T;

    const ANY: bool = F::ANY;

    #[inline(always)]
    fn tally(&mut self) -> &mut T {
        &mut self.tally
    }

    #[inline(always)]
    fn fetch<L: Lanes>(&self, lanes: L, child: u32) {
        self.places.fetch::<L, AND_SIBLINGS>(lanes, child);
    }

    #[inline(always)]
    fn leaf<L: Lanes, const TAME: bool>(&mut self, lanes: L, leaf: u32, mut t_max: f32) -> f32 {
        let (rows, count) = self.asked.bvh.rows(leaf);
        self.tally.work(0, count as u64);
        if !TAME && !self.side_by_side {
            return self.one_by_one(leaf, (1 << count) - 1, t_max);
        }
        let Asked { bvh, sheared, .. } = &self.asked;
        let (origin, shear) = (lanes.splat3(sheared.ray().0.to_array()), sheared.shear());
        let columns = Columns::new(sheared.axes(), count);
        let corners = lanes.corners(rows, columns);
        let flat = Flat::new(lanes, corners, origin, [lanes.splat(shear.x), lanes.splat(shear.y)]);
        let there = (1 << count) - 1;
        let mut unsure = !flat.missed(lanes) & there;
        if unsure == 0 {
            return t_max;
        }
        let crossed = flat.crossed(lanes) & there;
        let is_bounded = TAME || ORDINARY.contains(&sheared.ray().1.z.abs());
        if crossed == 0 || bvh.blind || F::ANY && !is_bounded {
            return self.one_by_one(leaf, unsure, t_max);
        }
        unsure ^= crossed;
        if F::ANY {
            let (start, end) = (lanes.splat(self.asked.ray.t_min), lanes.splat(self.asked.ray.t_max));
            let span = flat.span(lanes, 1.0 / sheared.ray().1.z);
            // So asked, what is no number is unsure.
            if crossed & lanes.lt(start, span.near) & lanes.lt(span.far, end) != 0 {
                return f32::NEG_INFINITY;
            }
            unsure |= crossed & !(lanes.le(span.far, start) | lanes.le(end, span.near));
        } else {
            // Hidden, or the compiler would prepare this for every ray, before it is known whether it comes to a leaf.
            let sheared = std::hint::black_box(sheared);
            let (origin, dir) = sheared.ray();
            let line = Exact::new(lanes.triple(origin), lanes.triple(dir));
            let mut crossed = crossed;
            while crossed != 0 {
                let lane = crossed.trailing_zeros() as usize & 7;
                crossed &= crossed - 1;
                let [a, b, c] = columns.triangle(rows, lane);
                let t = line.t(&Plane::new([lanes.triple(a), lanes.triple(b), lanes.triple(c)]))[0] as f32;
                if self.asked.is_wanted(t, t_max) {
                    let uv = sheared.uv([a, b, c]);
                    let hit = TriangleHit { t, uv, triangle: number(rows, count, lane) };
                    t_max = self.found.met(hit, t_max);
                }
            }
        }
        match unsure {
            0 => t_max,
            _ => self.one_by_one(leaf, unsure, t_max),
        }
    }
}

impl<T: Tally, F: Found> Leaves<'_, T, F> {
    /// Triangles in full.
    #[cold]
    fn one_by_one(&mut self, leaf: u32, which: u32, mut t_max: f32) -> f32 {
        let sheared = self.asked.sheared.least_volume(self.asked.bvh.least_volume);
        for lane in (0..WIDTH).filter(|lane| which >> lane & 1 == 1) {
            let (corners, triangle) = self.asked.triangle(leaf, lane);
            if sheared.crosses(corners)
                && let Some(t) = sheared.t(corners).filter(|t| self.asked.is_wanted(*t, t_max))
            {
                t_max = self.found.met(TriangleHit { t, uv: sheared.uv(corners), triangle }, t_max);
            }
        }
        t_max
    }
}
