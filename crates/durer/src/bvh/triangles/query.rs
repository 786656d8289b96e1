//! What a ray asks of a tree of triangles.

use super::leaf::{Quick, quick};
use super::{TriangleBvh, TriangleHit};
use crate::bvh::Tally;
use crate::bvh::lanes::{Kernel, Lanes, WIDTH, column};
use crate::bvh::node;
use crate::bvh::traverse::{RayBox, Visitor, walk};
use crate::math::{Ray, Vec3};
use crate::shape::watertight::Sheared;
use std::marker::PhantomData;

/// A question, whose answer is an `F`.
pub struct Query<'a, T, F> {
    pub bvh: &'a TriangleBvh,
    pub ray: &'a Ray,
    pub tally: &'a mut T,
    pub found: PhantomData<F>,
}

/// A triangle in its leaf.
#[derive(Clone, Copy)]
pub struct Place {
    first: usize,
    count: usize,
    lane: usize,
}

/// An answer in the making.
pub trait Found: Default {
    /// Whether any hit will do.
    const ANY: bool;

    /// A hit not after `t_max`; gives the new one, and minus infinity to end the search.
    fn offer(&mut self, t: f32, triangle: u32, place: Place, t_max: f32) -> f32;

    /// When the search has ended.
    fn finish(&mut self, _: &TriangleBvh, _: &Sheared) {}
}

/// The first hit.
pub struct Nearest {
    t: f32,
    triangle: u32,
    place: Option<Place>,
    hit: Option<TriangleHit>,
}

impl Default for Nearest {
    #[inline(always)]
    fn default() -> Self {
        Nearest { t: f32::INFINITY, triangle: u32::MAX, place: None, hit: None }
    }
}

impl Nearest {
    #[inline(always)]
    pub fn hit(self) -> Option<TriangleHit> {
        self.hit
    }
}

impl Found for Nearest {
    const ANY: bool = false;

    #[inline(always)]
    fn offer(&mut self, t: f32, triangle: u32, place: Place, t_max: f32) -> f32 {
        if (t, triangle) < (self.t, self.triangle) {
            (self.t, self.triangle, self.place) = (t, triangle, Some(place));
        }
        t_max.min(t)
    }

    #[inline(always)]
    fn finish(&mut self, bvh: &TriangleBvh, sheared: &Sheared) {
        if let Some(place) = self.place {
            let uv = sheared.uv(bvh.corners_at(place, sheared));
            self.hit = Some(TriangleHit { t: self.t, uv, triangle: self.triangle });
        }
    }
}

/// Whether there is a hit.
#[derive(Default)]
pub struct Any(pub bool);

impl Found for Any {
    const ANY: bool = true;

    #[inline(always)]
    fn offer(&mut self, _: f32, _: u32, _: Place, _: f32) -> f32 {
        self.0 = true;
        f32::NEG_INFINITY
    }
}

/// Every hit, some of them several times.
#[derive(Default)]
pub struct All(pub Vec<TriangleHit>, Vec<Place>);

impl Found for All {
    const ANY: bool = false;

    fn offer(&mut self, t: f32, triangle: u32, place: Place, t_max: f32) -> f32 {
        self.0.push(TriangleHit { t, uv: Default::default(), triangle });
        self.1.push(place);
        t_max
    }

    fn finish(&mut self, bvh: &TriangleBvh, sheared: &Sheared) {
        for (hit, place) in self.0.iter_mut().zip(&self.1) {
            hit.uv = sheared.uv(bvh.corners_at(*place, sheared));
        }
    }
}

impl TriangleBvh {
    /// The corners of a triangle, turned as the ray is.
    #[inline(always)]
    fn corners_at(&self, Place { first, count, lane }: Place, sheared: &Sheared) -> [Vec3; 3] {
        let leaf = &self.corners[9 * first..9 * (first + count)];
        column(leaf, count, sheared.axes(), lane).map(Vec3::from)
    }
}

impl<T: Tally, F: Found> Kernel for Query<'_, T, F> {
    type Output = F;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> F {
        let Query { bvh, ray, tally, .. } = self;
        let boxes = RayBox::new(ray, bvh.bounds);
        let mut leaves = Leaves::new(bvh, ray, &boxes, tally);
        // The interval is open, and what the walk goes by is the last t inside.
        let t_last = ray.t_max.next_down();
        match boxes.tame {
            true => walk::<L, _, true>(lanes, &bvh.nodes, &boxes, t_last, &mut leaves),
            false => walk::<L, _, false>(lanes, &bvh.nodes, &boxes, t_last, &mut leaves),
        }
        leaves.answer()
    }
}

/// A ray among the triangles of leaves.
pub struct Leaves<'a, T, F> {
    bvh: &'a TriangleBvh,
    sheared: Sheared,
    ray: Ray,
    tally: T,
    found: F,
    /// Whether tests side by side are within the range of numbers.
    side_by_side: bool,
}

impl<'a, T, F: Found> Leaves<'a, T, F> {
    #[inline(always)]
    pub fn new(bvh: &'a TriangleBvh, ray: &Ray, boxes: &RayBox, tally: T) -> Self {
        let (sheared, found) = (bvh.sheared(ray), F::default());
        Leaves { bvh, sheared, ray: *ray, tally, found, side_by_side: boxes.moderate }
    }

    /// What was found, when the search has ended.
    #[inline(always)]
    pub fn answer(&mut self) -> F {
        self.found.finish(self.bvh, &self.sheared);
        std::mem::take(&mut self.found)
    }
}

impl<T: Tally, F: Found> Visitor for Leaves<'_, T, F> {
    type Tally = T;

    #[inline(always)]
    fn tally(&mut self) -> &mut T {
        &mut self.tally
    }

    #[inline(always)]
    fn leaf<L: Lanes>(&mut self, lanes: L, leaf: u32, mut t_max: f32) -> f32 {
        let (first, count) = node::items(leaf);
        (0..count).for_each(|_| self.tally.test());
        if !self.side_by_side {
            return (0..count).fold(t_max, |t_max, lane| self.one_by_one(first, count, lane, t_max));
        }
        let corners = &self.bvh.corners[9 * first..9 * (first + count) + WIDTH];
        let range = (self.ray.t_min, t_max);
        let Quick { mut candidates, crossed, inside } = quick(lanes, &self.sheared, corners, count, range);
        // Where any hit will do, it need not be known where it is.
        let sure = candidates & crossed & inside;
        if F::ANY && sure != 0 && self.bvh.least_volume == 0.0 {
            return self.offer(t_max, first, count, sure.trailing_zeros() as usize, t_max);
        }
        while candidates != 0 {
            let lane = candidates.trailing_zeros() as usize;
            candidates &= candidates - 1;
            t_max = match crossed >> lane & 1 {
                1 => self.crossed(first, count, lane, t_max),
                _ => self.one_by_one(first, count, lane, t_max),
            };
            if F::ANY && t_max == f32::NEG_INFINITY {
                break;
            }
        }
        t_max
    }
}

impl<T: Tally, F: Found> Leaves<'_, T, F> {
    #[inline(always)]
    fn offer(&mut self, t: f32, first: usize, count: usize, lane: usize, t_max: f32) -> f32 {
        self.found.offer(t, self.bvh.order[first + lane], Place { first, count, lane }, t_max)
    }

    /// A single triangle in full.
    #[cold]
    fn one_by_one(&mut self, first: usize, count: usize, lane: usize, t_max: f32) -> f32 {
        match self.sheared.crosses(self.bvh.corners_at(Place { first, count, lane }, &self.sheared)) {
            true => self.crossed(first, count, lane, t_max),
            false => t_max,
        }
    }

    /// A triangle that the line of the ray crosses.
    #[inline(always)]
    fn crossed(&mut self, first: usize, count: usize, lane: usize, t_max: f32) -> f32 {
        let corners = self.bvh.corners_at(Place { first, count, lane }, &self.sheared);
        match self.sheared.distance(corners, self.ray.t_min, t_max) {
            Some(t) => self.offer(t, first, count, lane, t_max),
            None => t_max,
        }
    }
}
