//! A tree over boxes of things that only the caller knows.

use super::Tally;
use super::build::{self, Settings};
use super::lanes::{Available, Kernel, Lanes};
use super::node::{self, Node};
use super::traverse::{RayBox, Visitor, walk};
use crate::math::{Aabb, Ray};

/// A bounding volume hierarchy of eight-wide nodes over numbered things.
#[derive(Clone, Debug)]
pub struct Bvh {
    pub(super) nodes: Vec<Node>,
    /// Numbers of the things, in the order of the leaves.
    order: Vec<u32>,
    bounds: Aabb,
    level: Available,
}

impl Bvh {
    /// Builds over the boxes of things 0, 1, 2, ...; empty boxes are left out. Less than 2^28 things, in at most 2^26 nodes.
    ///
    /// The result is a function of the boxes alone: the same for any number of threads.
    pub fn build(boxes: &[Aabb]) -> Self {
        let tree = build::build(build::references(boxes), &Settings::THINGS);
        Bvh { nodes: tree.nodes, order: tree.order, bounds: tree.bounds, level: Available::chosen() }
    }

    /// The box around everything.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Numbers of the things in the order in which [`Bvh::walk`] knows them.
    pub fn order(&self) -> &[u32] {
        &self.order
    }

    /// Bytes in memory.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.nodes) + size_of_val(&*self.order)
    }

    /// As [`TriangleBvh::cost`](super::TriangleBvh::cost).
    pub fn cost(&self) -> f64 {
        node::cost(&self.nodes, self.bounds)
    }

    /// Offers every thing that the ray may meet before `t_max` to `test`, roughly from near to far.
    ///
    /// `test` gets the place of a thing in [`Bvh::order`] and the present `t_max`, and gives the new one: at
    /// most the old. Things whose boxes begin exactly at `t_max` are still offered. Minus infinity ends the walk.
    #[inline]
    pub fn walk<T: Tally>(&self, ray: &Ray, tally: &mut T, test: impl FnMut(usize, f32, &mut T) -> f32) {
        if self.nodes.is_empty() {
            return;
        }
        self.level.run(Walk { bvh: self, ray, things: Things { tally, test } });
    }
}

struct Walk<'a, T, F> {
    bvh: &'a Bvh,
    ray: &'a Ray,
    things: Things<'a, T, F>,
}

impl<T: Tally, F: FnMut(usize, f32, &mut T) -> f32> Kernel for Walk<'_, T, F> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self, lanes: L) {
        let (nodes, reach, t_max) = (&self.bvh.nodes, self.bvh.bounds.reach(), self.ray.t_max);
        if let Some(boxes) = RayBox::new(self.ray, reach) {
            walk::<L, _, true>(lanes, nodes, &boxes, t_max, &mut self.things);
        } else if let Some(boxes) = RayBox::wild(self.ray, reach) {
            walk::<L, _, false>(lanes, nodes, &boxes, t_max, &mut self.things);
        }
    }
}

struct Things<'a, T, F> {
    tally: &'a mut T,
    test: F,
}

impl<T: Tally, F: FnMut(usize, f32, &mut T) -> f32> Visitor for Things<'_, T, F> {
    type Tally = T;

    const ANY: bool = false;

    #[inline(always)]
    fn tally(&mut self) -> &mut T {
        self.tally
    }

    #[inline(always)]
    fn leaf<L: Lanes, const TAME: bool>(&mut self, _: L, leaf: u32, t_max: f32) -> f32 {
        let (first, count) = node::items(leaf);
        (first..first + count).fold(t_max, |t_max, item| (self.test)(item, t_max, self.tally))
    }
}
