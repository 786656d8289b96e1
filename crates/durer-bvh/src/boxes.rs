//! A tree over boxes of things that only the caller knows.

use super::build::{self, BuildSettings};
use super::lanes::{Available, Kernel, Lanes};
use super::node::{self, LEAF, WideNode};
use super::traverse::{NodeHits, TraversalRay, Visitor, traverse};
use super::{TraversalCounter, TraversalStats};
use crate::math::{Aabb, Ray};
use std::ops::Range;

/// A bounding volume hierarchy of eight-wide nodes over numbered things.
#[derive(Clone, Debug)]
pub struct Bvh {
    pub(super) nodes: Vec<WideNode>,
    /// Numbers of the things, in the order of the leaves.
    order: Vec<u32>,
    bounds: Aabb,
    level: Available,
}

impl Bvh {
    /// Builds over the boxes of things 0, 1, 2, ...; empty boxes are left out. Less than 2^28
    /// things, in at most 2^26 nodes.
    ///
    /// The result is a function of the boxes alone: the same for any number of threads.
    pub fn build(boxes: &[Aabb]) -> Self {
        let tree = build::build(build::references(boxes), &BuildSettings::THINGS);
        Bvh { nodes: tree.nodes, order: tree.order, bounds: tree.bounds, level: Available::chosen() }
    }

    /// Makes the tree fit the same things with boxes that have changed. Much faster than building;
    /// but the more they change, the slower rays become. A box that is empty keeps its old place
    /// if nothing else is in its leaf; things whose boxes were empty when it was built stay out.
    ///
    /// # Panics
    ///
    /// If a thing of the tree has no box here.
    pub fn refit(&mut self, boxes: &[Aabb]) {
        node::refit(&mut self.nodes, |leaf| {
            let (first, count) = node::items(leaf);
            let things = self.order[first..first + count].iter();
            things.fold(Aabb::EMPTY, |all, thing| all.union(boxes[*thing as usize]))
        });
        self.bounds = node::bounds(&self.nodes);
    }

    /// The box around everything.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Whether there is nothing in it.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Numbers of the things in the order in which [`Bvh::traverse`] knows them.
    #[inline]
    pub fn primitive_indices(&self) -> &[u32] {
        &self.order
    }

    /// Bytes in memory.
    pub fn memory_usage(&self) -> usize {
        size_of_val(&*self.nodes) + size_of_val(&*self.order)
    }

    /// As [`TriangleBvh::sah_cost`](super::TriangleBvh::sah_cost).
    pub fn sah_cost(&self) -> f64 {
        node::cost(&self.nodes, self.bounds)
    }

    /// Offers every thing that the ray may meet before `t_max` to `test`, roughly from near to far.
    ///
    /// `test` gets the place of a thing in [`Bvh::primitive_indices`] and the present `t_max`, and
    /// gives the new one: at most the old. Things whose boxes begin exactly at `t_max` are still
    /// offered. Minus infinity ends the walk.
    #[inline]
    pub fn traverse<T: TraversalCounter>(
        &self,
        ray: &Ray,
        counter: &mut T,
        mut test: impl FnMut(usize, f32, &mut T) -> f32,
    ) {
        let mut leaf = |things: Range<usize>, t_max| things.fold(t_max, |t_max, thing| test(thing, t_max, counter));
        match T::COUNTS_WORK {
            true => {
                let nodes = self.walk_counting(ray, &mut leaf);
                counter.work(nodes, 0);
            }
            false => self.walk_leaves(ray, &mut leaf),
        }
    }

    /// As [`Bvh::traverse`], leaf by leaf. Behind a pointer, so that it is compiled here, once, and
    /// not for each caller.
    fn walk_leaves(&self, ray: &Ray, leaf: Leaf) {
        self.level.run(Walk { bvh: self, ray, things: Things { nodes: &self.nodes, counter: (), leaf } });
    }

    /// As [`Bvh::walk_leaves`]; gives the number of nodes that were visited.
    fn walk_counting(&self, ray: &Ray, leaf: Leaf) -> u64 {
        let mut counts = TraversalStats::default();
        self.level.run(Walk { bvh: self, ray, things: Things { nodes: &self.nodes, counter: &mut counts, leaf } });
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

impl<T: TraversalCounter> Kernel for Walk<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self, lanes: L) {
        if self.bvh.nodes.is_empty() {
            return;
        }
        let (nodes, reach, t_max) = (&self.bvh.nodes, self.bvh.bounds.reach(), self.ray.t_max);
        if let Some(boxes) = TraversalRay::new(self.ray, reach) {
            traverse::<L, _, true>(lanes, nodes, &boxes, t_max, &mut self.things);
        } else if let Some(boxes) = TraversalRay::robust(self.ray, reach) {
            traverse::<L, _, false>(lanes, nodes, &boxes, t_max, &mut self.things);
        }
    }
}

struct Things<'a, T> {
    nodes: &'a [WideNode],
    counter: T,
    leaf: Leaf<'a>,
}

impl<T: TraversalCounter> Visitor for Things<'_, T> {
    type TraversalCounter = T;

    const ANY: bool = false;

    #[inline(always)]
    fn counter(&mut self) -> &mut T {
        &mut self.counter
    }

    #[inline(always)]
    fn fetch<L: Lanes>(&self, lanes: L, met: &NodeHits<L>, _: u32) {
        let mut rest = met.mask;
        while rest != 0 {
            // For a leaf this is no address of a node: fetching there is of no use and does no harm.
            // Where addresses have 32 bits the product may wrap around.
            let child = met.child(rest.trailing_zeros());
            rest &= rest - 1;
            let offset = ((child & !LEAF) as usize).wrapping_mul(node::UNIT);
            let from = self.nodes.as_ptr().cast::<u8>().wrapping_add(offset);
            (0..size_of::<WideNode>() / 64).for_each(|line| lanes.prefetch(from.wrapping_add(64 * line)));
        }
    }

    #[inline(always)]
    fn leaf<L: Lanes, const FAST: bool>(&mut self, _: L, leaf: u32, t_max: f32) -> f32 {
        let (first, count) = node::items(leaf);
        (self.leaf)(first..first + count, t_max)
    }
}
