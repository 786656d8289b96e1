//! A tree over boxes of things that only the caller knows.

use super::build::{self, Settings};
use super::lanes::{Available, Kernel, Lanes};
use super::node::{self, Node};
use super::traverse::{RayBox, Visitor, walk};
use super::{Counts, Tally};
use crate::math::{Aabb, Ray};
use std::ops::Range;

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
    pub fn walk<T: Tally>(&self, ray: &Ray, tally: &mut T, mut test: impl FnMut(usize, f32, &mut T) -> f32) {
        let mut leaf = |things: Range<usize>, t_max| things.fold(t_max, |t_max, thing| test(thing, t_max, tally));
        match T::COUNTS_WORK {
            true => {
                let nodes = self.walk_counting(ray, &mut leaf);
                tally.work(nodes, 0);
            }
            false => self.walk_leaves(ray, &mut leaf),
        }
    }

    /// As [`Bvh::walk`], leaf by leaf. Behind a pointer, so that it is compiled here, once, and not for each caller.
    fn walk_leaves(&self, ray: &Ray, leaf: Leaf) {
        self.level.run(Walk { bvh: self, ray, things: Things { tally: (), leaf } });
    }

    /// As [`Bvh::walk_leaves`]; gives the number of nodes that were visited.
    fn walk_counting(&self, ray: &Ray, leaf: Leaf) -> u64 {
        let mut counts = Counts::default();
        self.level.run(Walk { bvh: self, ray, things: Things { tally: &mut counts, leaf } });
        counts.nodes
    }
}

/// Gets the places of a leaf's things and `t_max`; gives the new one.
type Leaf<'a> = &'a mut dyn FnMut(Range<usize>, f32) -> f32;

struct Walk<'a, T> {
    bvh: &'a Bvh,
    ray: &'a Ray,
    things: Things<'a, T>,
}

impl<T: Tally> Kernel for Walk<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self, lanes: L) {
        if self.bvh.nodes.is_empty() {
            return;
        }
        let (nodes, reach, t_max) = (&self.bvh.nodes, self.bvh.bounds.reach(), self.ray.t_max);
        if let Some(boxes) = RayBox::new(self.ray, reach) {
            walk::<L, _, true>(lanes, nodes, &boxes, t_max, &mut self.things);
        } else if let Some(boxes) = RayBox::wild(self.ray, reach) {
            walk::<L, _, false>(lanes, nodes, &boxes, t_max, &mut self.things);
        }
    }
}

struct Things<'a, T> {
    tally: T,
    leaf: Leaf<'a>,
}

impl<T: Tally> Visitor for Things<'_, T> {
    type Tally = T;

    const ANY: bool = false;

    #[inline(always)]
    fn tally(&mut self) -> &mut T {
        &mut self.tally
    }

    #[inline(always)]
    fn leaf<L: Lanes, const TAME: bool>(&mut self, _: L, leaf: u32, t_max: f32) -> f32 {
        let (first, count) = node::items(leaf);
        (self.leaf)(first..first + count, t_max)
    }
}
