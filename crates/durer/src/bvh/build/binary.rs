//! A binary tree with one reference in each leaf, from the top down by the surface area heuristic.
//!
//! Many references are put into bins along each axis; few are sorted, and every cut between them is tried.
//! Source: Wald, *On fast Construction of SAH-based Bounding Volume Hierarchies*, IEEE RT 2007.

use super::{Reference, lane_number, number_lane};
use crate::math::Aabb;
use glam::Vec4;

pub const BINS: usize = 16;
/// Below this depth things are halved by number, which bounds the depth of all trees: 28 levels halve 2^28 things.
pub const HALVING_DEPTH: usize = 60;
/// Subtrees of more references than this are built in parallel.
pub const PARALLEL: usize = 4096;
/// So few references are sorted rather than put into bins.
pub const FEW: usize = 8;

/// A node. Nodes lie in depth-first order: the left child follows its parent, the right child the left one's subtree,
/// which has twice the left child's count of nodes, less one.
#[derive(Clone, Copy, Debug)]
pub struct Node {
    pub min: Vec4,
    pub max: Vec4,
}

impl Node {
    /// How many references are below it.
    pub fn count(&self) -> u32 {
        lane_number(self.min.w)
    }

    /// A leaf's reference.
    pub fn item(&self) -> u32 {
        lane_number(self.max.w)
    }

    pub fn new(min: Vec4, max: Vec4, count: u32, item: u32) -> Self {
        let (mut min, mut max) = (min, max);
        (min.w, max.w) = (number_lane(count), number_lane(item));
        Node { min, max }
    }

    pub fn bounds(&self) -> Aabb {
        Aabb { min: self.min.truncate(), max: self.max.truncate() }
    }
}

/// The tree, and what sizes are multiplied by before areas are compared.
pub struct Tree {
    pub nodes: Vec<Node>,
    pub scale: f32,
}

/// Half the area of a box.
#[inline]
pub fn half_area(min: Vec4, max: Vec4, scale: f32) -> f32 {
    let d = ((max - min) * scale).max(Vec4::ZERO);
    d.x * d.y + d.y * d.z + d.z * d.x
}

pub fn build(references: &mut [Reference], scale: f32) -> Tree {
    let nothing = Node::new(Vec4::ZERO, Vec4::ZERO, 0, 0);
    let mut nodes = vec![nothing; 2 * references.len() - 1];
    Builder { scale }.subtree(references, 0, &mut nodes, 0);
    Tree { nodes, scale }
}

pub struct Builder {
    pub scale: f32,
}

/// A box that grows, and how many references are in it.
#[derive(Clone, Copy)]
pub struct Bin {
    pub min: Vec4,
    pub max: Vec4,
    pub count: u32,
}

impl Bin {
    pub const EMPTY: Bin = Bin { min: Vec4::INFINITY, max: Vec4::NEG_INFINITY, count: 0 };

    #[inline]
    pub fn with(self, r: &Reference) -> Bin {
        Bin { count: self.count + 1, ..self.around(r) }
    }

    /// Grown, but not counted.
    #[inline]
    pub fn around(self, r: &Reference) -> Bin {
        Bin { min: self.min.min(r.min), max: self.max.max(r.max), ..self }
    }

    #[inline]
    pub fn union(self, other: Bin) -> Bin {
        Bin { min: self.min.min(other.min), max: self.max.max(other.max), count: self.count + other.count }
    }

    pub fn cost(&self, scale: f32) -> f32 {
        half_area(self.min, self.max, scale) * self.count as f32
    }
}

impl Builder {
    /// Builds over some references, the first of which has number `first` among all.
    fn subtree(&self, references: &mut [Reference], first: u32, nodes: &mut [Node], depth: usize) {
        let count = references.len();
        let bounds = references.iter().fold(Bin::EMPTY, Bin::with);
        nodes[0] = Node::new(bounds.min, bounds.max, count as u32, first);
        if count == 1 {
            return;
        }
        let cut = self.cut(references, depth);
        let (left, right) = references.split_at_mut(cut);
        let (left_nodes, right_nodes) = nodes[1..].split_at_mut(2 * cut - 1);
        let middle = first + cut as u32;
        if count > PARALLEL {
            rayon::join(
                || self.subtree(left, first, left_nodes, depth + 1),
                || self.subtree(right, middle, right_nodes, depth + 1),
            );
        } else {
            self.subtree(left, first, left_nodes, depth + 1);
            self.subtree(right, middle, right_nodes, depth + 1);
        }
    }

    /// Sorts references into two sets; gives the number of the first.
    pub fn cut(&self, references: &mut [Reference], depth: usize) -> usize {
        if depth >= HALVING_DEPTH {
            halve(references)
        } else if references.len() <= FEW {
            self.sorted_cut(references)
        } else {
            self.binned_cut(references).unwrap_or_else(|| halve(references))
        }
    }

    /// Sorts references to the two sides of the cheapest plane between bins; gives the number on the left, or `None`
    /// where centres cannot be told apart.
    fn binned_cut(&self, references: &mut [Reference]) -> Option<usize> {
        let (low, high) = references.iter().fold((Vec4::INFINITY, Vec4::NEG_INFINITY), |(low, high), r| {
            let center = r.center();
            (low.min(center), high.max(center))
        });
        // Where a size is zero or leaves the range, all fall into the first bin.
        let scale = BINS as f32 * (1.0 - 1e-6) / (high - low);
        let scale = Vec4::select(scale.cmplt(Vec4::INFINITY), scale, Vec4::ZERO);
        let bin_of = |r: &Reference| {
            // The casts saturate: NaN and all below give 0.
            let at = (r.center() - low) * scale;
            [at.x, at.y, at.z].map(|x| (x as u32 as usize).min(BINS - 1))
        };
        let mut bins = [[Bin::EMPTY; BINS]; 3];
        for r in references.iter() {
            for (axis, at) in bin_of(r).into_iter().enumerate() {
                bins[axis][at] = bins[axis][at].with(r);
            }
        }
        let mut best = (f32::INFINITY, 0, 0);
        for (axis, bins) in bins.iter().enumerate() {
            let cut = |i, cost| (cost, axis, i);
            self.cheapest(bins, |i, cost| {
                if cost < best.0 {
                    best = cut(i, cost)
                }
            });
        }
        let (cost, axis, bin) = best;
        if cost == f32::INFINITY {
            return None;
        }
        let is_left = |r: &Reference| bin_of(r)[axis] < bin;
        Some(partition(references, is_left))
    }

    /// Offers the cost of every cut that leaves something on both sides.
    fn cheapest<const N: usize>(&self, bins: &[Bin; N], mut offer: impl FnMut(usize, f32)) {
        // Costs of everything right of each plane, then the sum from the left.
        let mut right_cost = [0.0; N];
        let mut right = Bin::EMPTY;
        for i in (1..N).rev() {
            right = right.union(bins[i]);
            right_cost[i] = right.cost(self.scale);
        }
        let all = right.count + bins[0].count;
        let mut left = Bin::EMPTY;
        for i in 1..N {
            left = left.union(bins[i - 1]);
            if left.count > 0 && left.count < all {
                offer(i, left.cost(self.scale) + right_cost[i]);
            }
        }
    }

    /// Sorts a few references along the axis of the cheapest cut; gives the number on its left.
    fn sorted_cut(&self, references: &mut [Reference]) -> usize {
        let count = references.len();
        if count == 2 {
            return 1;
        }
        let mut best = (f32::INFINITY, 0, count / 2);
        for axis in 0..3 {
            sort(references, axis);
            let mut bins = [Bin::EMPTY; FEW];
            for (bin, r) in bins.iter_mut().zip(references.iter()) {
                *bin = Bin::EMPTY.with(r);
            }
            self.cheapest(&bins, |i, cost| {
                if cost < best.0 {
                    best = (cost, axis, i)
                }
            });
        }
        if best.1 != 2 {
            sort(references, best.1);
        }
        best.2
    }
}

/// Moves the references that pass to the front; gives their number.
fn partition(references: &mut [Reference], is_left: impl Fn(&Reference) -> bool) -> usize {
    let (mut low, mut high) = (0, references.len());
    loop {
        while low < high && is_left(&references[low]) {
            low += 1;
        }
        while low < high && !is_left(&references[high - 1]) {
            high -= 1;
        }
        if low == high {
            return low;
        }
        references.swap(low, high - 1);
    }
}

/// A few references are sorted by insertion.
fn sort(references: &mut [Reference], axis: usize) {
    let key = |r: &Reference| (r.min[axis] * 0.5 + r.max[axis] * 0.5, r.number());
    for i in 1..references.len() {
        let mut at = i;
        while at > 0 && key(&references[at]) < key(&references[at - 1]) {
            references.swap(at, at - 1);
            at -= 1;
        }
    }
}

/// Sorts along the longest axis and cuts in the middle.
fn halve(references: &mut [Reference]) -> usize {
    let (low, high) = references.iter().fold((Vec4::INFINITY, Vec4::NEG_INFINITY), |(low, high), r| {
        let center = r.center();
        (low.min(center), high.max(center))
    });
    let size = high - low;
    let axis = if size.x >= size.y && size.x >= size.z {
        0
    } else if size.y >= size.z {
        1
    } else {
        2
    };
    references.sort_unstable_by(|a, b| {
        a.center()[axis]
            .total_cmp(&b.center()[axis])
            .then(a.number().cmp(&b.number()))
            .then(a.min[axis].total_cmp(&b.min[axis]))
    });
    references.len() / 2
}
