//! What a ray asks of a tree of triangles.

use super::leaf::{Flat, Span, t};
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
    pub tally: &'a mut T,
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

    /// Whether it is not enough to know that a triangle is met.
    const PLACE: bool;

    /// Takes note of triangles of a leaf that are met for sure, not after `t_max`; gives the new one, and minus infinity to end the
    /// search.
    fn met<L: Lanes>(&mut self, lanes: L, asked: &Asked, leaf: u32, met: u32, span: &Span<L>, t_max: f32) -> f32;

    /// Takes note of a hit; gives the new `t_max`.
    fn met_at(&mut self, hit: TriangleHit, t_max: f32) -> f32;

    /// When the search has ended.
    fn answer(&mut self) -> Self::Answer;
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

    const PLACE: bool = true;

    #[inline(always)]
    fn met<L: Lanes>(&mut self, lanes: L, asked: &Asked, leaf: u32, met: u32, span: &Span<L>, t_max: f32) -> f32 {
        // Nearly always bounds leave one of them.
        let left = met & lanes.le(span.near, lanes.splat(lesser(lanes.least(span.far, met), t_max)));
        asked.each(lanes, leaf, left, t_max, |hit, t_max| self.met_at(hit, t_max))
    }

    #[inline(always)]
    fn met_at(&mut self, hit: TriangleHit, t_max: f32) -> f32 {
        if (hit.t, hit.triangle) < (self.best.t, self.best.triangle) {
            self.best = hit;
        }
        lesser(hit.t, t_max)
    }

    #[inline(always)]
    fn answer(&mut self) -> Option<TriangleHit> {
        (self.best.triangle != NONE).then_some(self.best)
    }
}

/// Whether there is a hit.
#[derive(Default)]
pub struct Any(bool);

impl Found for Any {
    type Answer = bool;

    const PLACE: bool = false;

    #[inline(always)]
    fn met<L: Lanes>(&mut self, _: L, _: &Asked, _: u32, _: u32, _: &Span<L>, _: f32) -> f32 {
        self.0 = true;
        f32::NEG_INFINITY
    }

    #[inline(always)]
    fn met_at(&mut self, _: TriangleHit, _: f32) -> f32 {
        self.0 = true;
        f32::NEG_INFINITY
    }

    #[inline(always)]
    fn answer(&mut self) -> bool {
        self.0
    }
}

/// Every hit, some of them several times.
#[derive(Default)]
pub struct All(Vec<TriangleHit>);

impl Found for All {
    type Answer = Vec<TriangleHit>;

    const PLACE: bool = true;

    fn met<L: Lanes>(&mut self, lanes: L, asked: &Asked, leaf: u32, met: u32, _: &Span<L>, t_max: f32) -> f32 {
        asked.each(lanes, leaf, met, t_max, |hit, t_max| self.met_at(hit, t_max))
    }

    fn met_at(&mut self, hit: TriangleHit, t_max: f32) -> f32 {
        self.0.push(hit);
        t_max
    }

    fn answer(&mut self) -> Vec<TriangleHit> {
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

    /// Where triangles of a leaf are met, that the line of the ray crosses; gives the last of the new `t_max`.
    #[inline(always)]
    fn each<L: Lanes>(
        &self,
        lanes: L,
        leaf: u32,
        mut crossed: u32,
        mut t_max: f32,
        mut met: impl FnMut(TriangleHit, f32) -> f32,
    ) -> f32 {
        while crossed != 0 {
            let lane = crossed.trailing_zeros() as usize;
            crossed &= crossed - 1;
            let (corners, triangle) = self.triangle(leaf, lane);
            if let Some(t) = t(lanes, &self.sheared, corners).filter(|t| self.is_wanted(*t, t_max)) {
                t_max = met(TriangleHit { t, uv: self.sheared.uv(corners), triangle }, t_max);
            }
        }
        t_max
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
        match boxes.tame {
            true => walk::<L, _, true>(lanes, &bvh.nodes, &boxes, ray.t_max, &mut leaves),
            false => walk::<L, _, false>(lanes, &bvh.nodes, &boxes, ray.t_max, &mut leaves),
        };
        leaves.answer()
    }
}

/// A ray among the triangles of leaves.
pub struct Leaves<'a, T, F> {
    asked: Asked<'a>,
    tally: T,
    found: F,
    inverse_z: f32,
    /// Whether signs found side by side are within the range of numbers.
    side_by_side: bool,
    /// Whether bounds of t are, and decide.
    bounded: bool,
}

impl<'a, T, F: Found> Leaves<'a, T, F> {
    #[inline(always)]
    pub fn new(bvh: &'a TriangleBvh, ray: &Ray, boxes: &RayBox, tally: T) -> Self {
        let sheared = Sheared::finite(ray).least_volume(bvh.least_volume);
        let dz = sheared.ray().1.z;
        Leaves {
            asked: Asked { bvh, sheared, t_min: ray.t_min, t_max: ray.t_max },
            tally,
            found: F::default(),
            inverse_z: 1.0 / dz,
            side_by_side: boxes.moderate,
            bounded: (boxes.tame || TAME.contains(&dz.abs())) && bvh.least_volume == 0.0,
        }
    }

    /// What was found, when the search has ended.
    #[inline(always)]
    pub fn answer(&mut self) -> F::Answer {
        self.found.answer()
    }
}

impl<T: Tally, F: Found> Visitor for Leaves<'_, T, F> {
    type Tally = T;

    const ALONG: bool = !F::PLACE;

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
        let crossed = flat.crossed(lanes) & there;
        if F::PLACE && crossed.is_power_of_two() {
            // A single one need not wait for bounds.
            unsure ^= crossed;
            t_max = self.asked.each(lanes, leaf, crossed, t_max, |hit, t_max| self.found.met_at(hit, t_max));
        } else if self.bounded {
            let span = flat.span(lanes, self.inverse_z);
            let (start, end) = (lanes.splat(*t_min), lanes.splat(*end));
            // So asked, what is no number is unsure.
            let left_out = lanes.lt(lanes.splat(t_max), span.near) | lanes.le(span.far, start);
            let met = crossed & !left_out & lanes.lt(start, span.near) & lanes.lt(span.far, end);
            unsure &= !(met | crossed & left_out);
            if met != 0 {
                t_max = self.found.met(lanes, &self.asked, leaf, met, &span, t_max);
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
                t_max = self.found.met_at(TriangleHit { t, uv: sheared.uv(corners), triangle }, t_max);
            }
        }
        t_max
    }
}
