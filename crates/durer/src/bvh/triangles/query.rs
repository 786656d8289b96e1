//! What a ray asks of a tree of triangles.

use super::leaf::{Flat, Span, t, uv};
use super::{TriangleBvh, TriangleHit, number};
use crate::bvh::Tally;
use crate::bvh::lanes::{Kernel, Lanes, WIDTH, column};
use crate::bvh::traverse::{RayBox, TAME, Visitor, walk};
use crate::math::{Ray, Vec2, Vec3};
use crate::shape::watertight::Sheared;
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
    sheared: Sheared,
    t_min: f32,
    t_max: f32,
}

/// An answer in the making.
pub trait Found: Default {
    type Answer: Default;

    /// Whether it is enough to know that something is hit.
    const ANY: bool;

    /// Of triangles that are hit for sure, those whose hits are wanted, none of them after `t_max`.
    fn wanted<L: Lanes>(lanes: L, met: u32, span: &Span<L>, t_max: f32) -> u32;

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

/// The lesser of two numbers.
#[inline(always)]
fn lesser(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

impl Found for Nearest {
    type Answer = Option<TriangleHit>;

    const ANY: bool = false;

    /// Nearly always bounds leave one.
    #[inline(always)]
    fn wanted<L: Lanes>(lanes: L, met: u32, span: &Span<L>, t_max: f32) -> u32 {
        met & lanes.le(span.near, lanes.splat(lesser(lanes.least(span.far, met), t_max)))
    }

    #[inline(always)]
    fn met(&mut self, hit: TriangleHit, t_max: f32) -> f32 {
        if (hit.t, hit.triangle) < (self.best.t, self.best.triangle) {
            self.best = hit;
        }
        lesser(hit.t, t_max)
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
    fn wanted<L: Lanes>(_: L, _: u32, _: &Span<L>, _: f32) -> u32 {
        0
    }

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

    #[inline(always)]
    fn wanted<L: Lanes>(_: L, met: u32, _: &Span<L>, _: f32) -> u32 {
        met
    }

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
    fn triangle(&self, leaf: u32, lane: usize) -> ([Vec3; 3], u32) {
        let (rows, count) = self.bvh.rows(leaf);
        let [a, b, c] = column(rows, count, self.sheared.axes(), lane);
        ([a.into(), b.into(), c.into()], number(rows, count, lane))
    }

    #[inline(always)]
    fn is_wanted(&self, t: f32, t_max: f32) -> bool {
        // Refuses also NaN.
        t > self.t_min && t < self.t_max && t <= t_max
    }
}

impl<T: Tally, F: Found> Kernel for Query<'_, T, F> {
    type Output = F::Answer;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> F::Answer {
        let Query { bvh, ray, tally, .. } = self;
        let Some(boxes) = RayBox::new(ray, bvh.reach) else { return F::Answer::default() };
        let mut leaves = Leaves::<_, F>::new(bvh, ray, &boxes, tally);
        let t_max = match boxes.tame {
            true => walk::<L, _, true>(lanes, &bvh.nodes, &boxes, ray.t_max, &mut leaves),
            false => walk::<L, _, false>(lanes, &bvh.nodes, &boxes, ray.t_max, &mut leaves),
        };
        leaves.answer(t_max)
    }
}

/// A ray among the triangles of leaves.
pub struct Leaves<'a, T, F> {
    asked: Asked<'a>,
    tally: T,
    found: F,
    /// Whether signs found side by side are within the range of numbers.
    side_by_side: bool,
    /// Whether all numbers of the ray are.
    tame: bool,
}

impl<'a, T, F: Found> Leaves<'a, T, F> {
    #[inline(always)]
    pub fn new(bvh: &'a TriangleBvh, ray: &Ray, boxes: &RayBox, tally: T) -> Self {
        let sheared = Sheared::finite(ray).least_volume(bvh.least_volume);
        Leaves {
            asked: Asked { bvh, sheared, t_min: ray.t_min, t_max: ray.t_max },
            tally,
            found: F::default(),
            side_by_side: boxes.moderate,
            tame: boxes.tame,
        }
    }

    /// Whether bounds of t found side by side are within the range of numbers, and decide.
    #[inline(always)]
    fn is_bounded(&self) -> bool {
        let Asked { bvh, sheared, .. } = &self.asked;
        (self.tame || TAME.contains(&sheared.ray().1.z.abs())) && bvh.least_volume == 0.0
    }

    /// What was found, when the search has ended.
    #[inline(always)]
    pub fn answer(&mut self, t_max: f32) -> F::Answer {
        self.found.answer(t_max == f32::NEG_INFINITY)
    }
}

impl<T: Tally, F: Found> Visitor for Leaves<'_, T, F> {
    type Tally = T;

    const UNORDERED: bool = F::ANY;

    #[inline(always)]
    fn tally(&mut self) -> &mut T {
        &mut self.tally
    }

    #[inline(always)]
    fn fetch<L: Lanes>(&self, lanes: L, child: u32) {
        super::stream::prefetch(lanes, self.asked.bvh, child);
    }

    #[inline(always)]
    fn leaf<L: Lanes>(&mut self, lanes: L, leaf: u32, mut t_max: f32) -> f32 {
        let (rows, count) = self.asked.bvh.rows(leaf);
        (0..count).for_each(|_| self.tally.test());
        if !self.side_by_side {
            return self.one_by_one(leaf, (1 << count) - 1, t_max);
        }
        let Asked { sheared, t_min, t_max: end, .. } = &self.asked;
        let (origin, shear) = (lanes.splat3(sheared.ray().0.to_array()), sheared.shear());
        let corners = lanes.rows(rows, count, sheared.axes());
        let flat = Flat::new(lanes, corners, origin, [lanes.splat(shear.x), lanes.splat(shear.y)]);
        let there = (1 << count) - 1;
        let mut unsure = !flat.missed(lanes) & there;
        if unsure == 0 {
            return t_max;
        }
        let mut wanted = flat.crossed(lanes) & there;
        if !F::ANY && wanted.is_power_of_two() {
            // A single one need not wait for bounds.
            unsure ^= wanted;
        } else if self.is_bounded() {
            let (crossed, span) = (wanted, flat.span(lanes, 1.0 / sheared.ray().1.z));
            let (start, end) = (lanes.splat(*t_min), lanes.splat(*end));
            // So asked, what is no number is unsure.
            let left_out = lanes.lt(lanes.splat(t_max), span.near) | lanes.le(span.far, start);
            let met = crossed & !left_out & lanes.lt(start, span.near) & lanes.lt(span.far, end);
            if F::ANY && met != 0 {
                return f32::NEG_INFINITY;
            }
            unsure &= !(met | crossed & left_out);
            wanted = if met == 0 { 0 } else { F::wanted(lanes, met, &span, t_max) };
        } else {
            wanted = 0;
        }
        while wanted != 0 {
            let lane = wanted.trailing_zeros() as usize;
            wanted &= wanted - 1;
            let (corners, triangle) = self.asked.triangle(leaf, lane);
            if let Some(t) = t(lanes, sheared, corners).filter(|t| self.asked.is_wanted(*t, t_max)) {
                t_max = self.found.met(TriangleHit { t, uv: uv(lanes, sheared, corners), triangle }, t_max);
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
        for lane in (0..WIDTH).filter(|lane| which >> lane & 1 == 1) {
            let (corners, triangle) = self.asked.triangle(leaf, lane);
            let sheared = &self.asked.sheared;
            if sheared.crosses(corners)
                && let Some(t) = sheared.t(corners).filter(|t| self.asked.is_wanted(*t, t_max))
            {
                t_max = self.found.met(TriangleHit { t, uv: sheared.uv(corners), triangle }, t_max);
            }
        }
        t_max
    }
}
