//! A BVH over bounding boxes. The caller stores and intersects the primitives.

use super::build::{self, BuildSettings};
use super::lanes::{AvailableLevel, Kernel, Lanes};
use super::node::{self, LEAF, WideNode};
use super::traverse::{NodeHits, TraversalRay, Visitor, traverse};
use super::tree_boxes::{self, TreeBox};
use super::{TraversalCounter, TraversalStats};
use crate::math::{Aabb, Ray};
use std::collections::BTreeMap;
use std::ops::Range;

/// A bounding volume hierarchy with eight children per node, over the boxes of the caller's
/// primitives.
#[derive(Clone, Debug)]
pub struct Bvh {
    pub(super) nodes: Vec<WideNode>,
    /// Primitive numbers, in the order in which the leaves refer to them.
    order: Vec<u32>,
    bounds: Aabb,
    level: AvailableLevel,
}

impl Bvh {
    /// Builds a tree over primitives 0, 1, 2, ..., given by their boxes. Primitives with empty
    /// boxes are left out. There must be fewer than 2^28 primitives, and the tree may have at most
    /// 2^26 nodes.
    ///
    /// The tree depends only on the boxes and not on the number of threads.
    pub fn build(boxes: &[Aabb]) -> Self {
        let tree = build::build(build::references(boxes), &BuildSettings::PRIMITIVES);
        Bvh { nodes: tree.nodes, order: tree.order, bounds: tree.bounds, level: AvailableLevel::chosen() }
    }

    /// Fits the tree to changed boxes of the same primitives. Refitting is much faster than
    /// building, but rays become slower the more the boxes change. A box that has become empty
    /// keeps its old bounds if its leaf contains nothing else. Primitives whose boxes were empty
    /// when the tree was built stay left out.
    ///
    /// # Panics
    ///
    /// Panics if `boxes` has no entry for a primitive of the tree.
    pub fn refit(&mut self, boxes: &[Aabb]) {
        node::refit(&mut self.nodes, |leaf| {
            let (first, count) = node::items(leaf);
            let primitives = self.order[first..first + count].iter();
            primitives.fold(Aabb::EMPTY, |all, primitive| all.union(boxes[*primitive as usize]))
        });
        self.bounds = node::bounds(&self.nodes);
    }

    /// Returns the bounding box of all primitives.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Returns true if the tree has no primitives.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Returns the primitive numbers in leaf order. [`Bvh::traverse`] passes positions in this
    /// list.
    #[inline]
    pub fn primitive_indices(&self) -> &[u32] {
        &self.order
    }

    /// Returns the size of the nodes and primitive numbers in bytes.
    pub fn memory_usage(&self) -> usize {
        size_of_val(&*self.nodes) + size_of_val(&*self.order)
    }

    /// Returns the expected cost of a ray; see
    /// [`TriangleBvh::sah_cost`](super::TriangleBvh::sah_cost).
    pub fn sah_cost(&self) -> f64 {
        node::cost(&self.nodes, self.bounds)
    }

    /// Calls `test` for every primitive that the ray may hit before `t_max`, in approximately
    /// front-to-back order.
    ///
    /// `test` takes the position of the primitive in [`Bvh::primitive_indices`] and the current
    /// `t_max`, and returns the new `t_max`, which must not exceed the old one. A primitive whose
    /// box begins exactly at `t_max` is still tested. If `test` returns minus infinity, the
    /// traversal ends.
    #[inline]
    pub fn traverse<T: TraversalCounter>(
        &self,
        ray: &Ray,
        counter: &mut T,
        mut test: impl FnMut(usize, f32, &mut T) -> f32,
    ) {
        let mut leaf = |primitives: Range<usize>, t_max| {
            primitives.fold(t_max, |t_max, primitive| test(primitive, t_max, counter))
        };
        match T::COUNTS_WORK {
            true => {
                let nodes = self.traverse_counting(ray, &mut leaf);
                counter.count_work(nodes, 0);
            }
            false => self.traverse_leaves(ray, &mut leaf),
        }
    }

    /// Calls `leaf` for each leaf that the ray may hit; see [`Bvh::traverse`]. `leaf` is a trait
    /// object so that the traversal is compiled only once and not once per caller.
    fn traverse_leaves(&self, ray: &Ray, leaf: Leaf) {
        self.level.run(TraversalKernel {
            bvh: self,
            ray,
            visitor: LeafVisitor { nodes: &self.nodes, counter: (), leaf },
        });
    }

    /// Traverses the tree as [`Bvh::walk_leaves`] does and returns the number of visited nodes.
    fn traverse_counting(&self, ray: &Ray, leaf: Leaf) -> u64 {
        let mut counts = TraversalStats::default();
        self.level.run(TraversalKernel {
            bvh: self,
            ray,
            visitor: LeafVisitor { nodes: &self.nodes, counter: &mut counts, leaf },
        });
        counts.nodes
    }

    /// Iterates over the boxes of the tree level by level.
    pub fn boxes(&self) -> impl Iterator<Item = TreeBox> {
        tree_boxes::boxes(&self.nodes).map(|(_, bounds)| bounds)
    }

    /// Traverses the tree as [`Bvh::traverse`] does, and returns the boxes of the visited nodes and
    /// leaves in visiting order. This method is meant for drawing. It is slow because it first
    /// lists all boxes of the tree.
    pub fn visits(&self, ray: &Ray, mut test: impl FnMut(usize, f32) -> f32) -> Vec<TreeBox> {
        let boxes: BTreeMap<u32, TreeBox> = tree_boxes::boxes(&self.nodes).collect();
        let mut codes = Vec::new();
        let leaf: Leaf = &mut |primitives, t_max| primitives.fold(t_max, |t_max, primitive| test(primitive, t_max));
        self.level.run(TraversalKernel {
            bvh: self,
            ray,
            visitor: VisitRecorder { codes: &mut codes, counter: (), leaf },
        });
        codes.iter().filter_map(|code| boxes.get(code).cloned()).collect()
    }
}

/// Leaf callback. It takes the positions of the leaf's primitives and `t_max`, and returns the new
/// `t_max`.
type Leaf<'a> = &'a mut dyn FnMut(Range<usize>, f32) -> f32;

/// Kernel that traverses a [`Bvh`] with one ray at the chosen SIMD level.
struct TraversalKernel<'a, V> {
    bvh: &'a Bvh,
    ray: &'a Ray,
    visitor: V,
}

impl<V: Visitor> Kernel for TraversalKernel<'_, V> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self, lanes: L) {
        if self.bvh.nodes.is_empty() {
            return;
        }
        let (nodes, reach, t_max) = (&self.bvh.nodes, self.bvh.bounds.max_abs_coordinate(), self.ray.t_max);
        if let Some(boxes) = TraversalRay::new(self.ray, reach) {
            traverse::<L, _, true>(lanes, nodes, &boxes, t_max, &mut self.visitor);
        } else if let Some(boxes) = TraversalRay::robust(self.ray, reach) {
            traverse::<L, _, false>(lanes, nodes, &boxes, t_max, &mut self.visitor);
        }
    }
}

/// Visitor that passes each leaf to a callback and counts the visited nodes.
struct LeafVisitor<'a, T> {
    nodes: &'a [WideNode],
    counter: T,
    leaf: Leaf<'a>,
}

impl<T: TraversalCounter> Visitor for LeafVisitor<'_, T> {
    type TraversalCounter = T;

    const ANY: bool = false;

    #[inline(always)]
    fn counter(&mut self) -> &mut T {
        &mut self.counter
    }

    #[inline(always)]
    fn fetch<L: Lanes>(&self, lanes: L, hits: &NodeHits<L>, _: u32) {
        let mut rest = hits.mask;
        while rest != 0 {
            // The code of a leaf does not contain the address of a node, but prefetching that
            // address is harmless. The product may wrap around on 32-bit targets.
            let child = hits.child(rest.trailing_zeros());
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

/// Visitor that records the codes of visited nodes and leaves, for [`Bvh::visits`].
struct VisitRecorder<'a> {
    codes: &'a mut Vec<u32>,
    counter: (),
    leaf: Leaf<'a>,
}

impl Visitor for VisitRecorder<'_> {
    type TraversalCounter = ();

    const ANY: bool = false;

    fn counter(&mut self) -> &mut () {
        &mut self.counter
    }

    #[inline(always)]
    fn enter(&mut self, offset: usize) {
        self.codes.push(offset as u32);
    }

    #[inline(always)]
    fn leaf<L: Lanes, const FAST: bool>(&mut self, _: L, leaf: u32, t_max: f32) -> f32 {
        self.codes.push(leaf);
        let (first, count) = node::items(leaf);
        (self.leaf)(first..first + count, t_max)
    }
}
