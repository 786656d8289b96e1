//! A binary tree over references, from the top down by the surface area heuristic.

use super::cut::{Bin, HALVING_DEPTH};
use super::spatial::Budget;
use super::{Reference, Settings, lane, lane_number};
use crate::math::{Aabb, Vec3};
use glam::Vec4;

/// Subtrees of more references than this are built in parallel.
const PARALLEL: usize = 4096;

/// A node. Nodes lie in depth-first order: the left child follows its parent, the right child what is below the left one.
#[derive(Clone, Copy, Debug)]
pub struct Node {
    /// With the number of references in the fourth lane, and whether it is a leaf.
    pub min: Vec4,
    /// With a leaf's first item, or the number of leaves below the left child.
    pub max: Vec4,
}

const INNER: u32 = 2;
const LEAF: u32 = 3;

impl Node {
    pub fn leaf(mut min: Vec4, mut max: Vec4, count: u32, first: u32) -> Self {
        (min.w, max.w) = (lane(LEAF, count), lane(LEAF, first));
        Node { min, max }
    }

    pub fn inner(mut min: Vec4, mut max: Vec4, count: u32, left_leaves: u32) -> Self {
        (min.w, max.w) = (lane(INNER, count), lane(INNER, left_leaves));
        Node { min, max }
    }

    pub fn is_leaf(&self) -> bool {
        self.min.w.to_bits() >> 28 == LEAF
    }

    /// How many references are below it.
    pub fn count(&self) -> usize {
        lane_number(self.min.w) as usize
    }

    /// Where a leaf's items begin.
    pub fn first(&self) -> usize {
        lane_number(self.max.w) as usize
    }

    /// How far behind its parent the right child is: below the left child are as many nodes as leaves, but for one.
    pub fn right(&self) -> usize {
        2 * lane_number(self.max.w) as usize
    }

    pub fn bounds(&self) -> Aabb {
        Aabb { min: self.min.truncate(), max: self.max.truncate() }
    }
}

/// The tree, the things of its leaves, and what sizes are multiplied by before areas are compared.
pub struct Tree {
    pub nodes: Vec<Node>,
    pub items: Vec<u32>,
    pub scale: f32,
    /// Whether things are in several leaves.
    pub is_cut: bool,
}

/// Half the area of a box.
#[inline]
pub fn half_area(min: Vec4, max: Vec4, scale: f32) -> f32 {
    let d = ((max - min) * scale).max(Vec4::ZERO);
    d.x * d.y + d.y * d.z + d.z * d.x
}

pub struct Builder<'a> {
    pub scale: f32,
    /// Half the area of everything.
    pub area: f32,
    /// So many references may stay together.
    whole: usize,
    /// How many bins so many references are put into, at most.
    pub bins: fn(usize) -> usize,
    /// Where things are triangles that may be cut, their corners; else nothing.
    pub corners: &'a [[Vec3; 3]],
}

/// Nodes and the items of their leaves, in depth-first order.
struct Piece {
    nodes: Vec<Node>,
    items: Vec<u32>,
}

/// How many references and leaves are below a node.
struct Counts {
    references: u32,
    leaves: u32,
}

/// Builds a tree; triangles whose corners are known may be cut.
pub fn build(references: &mut [Reference], all: &Bin, scale: f32, settings: &Settings, corners: &[[Vec3; 3]]) -> Tree {
    let area = half_area(all.min, all.max, scale);
    let builder = Builder { scale, area, whole: settings.whole, bins: settings.bins, corners };
    let share = if corners.is_empty() { 0.0 } else { settings.splits };
    let budget = Budget::new((references.len() as f32 * share) as usize);
    let mut pieces = vec![Piece::new(references.len())];
    builder.subtree(references, all, budget, 0, &mut pieces);
    let (mut nodes, mut items) = (Vec::new(), Vec::new());
    nodes.reserve_exact(pieces.iter().map(|piece| piece.nodes.len()).sum());
    items.reserve_exact(pieces.iter().map(|piece| piece.items.len()).sum());
    for piece in pieces {
        let before = items.len();
        nodes.extend(piece.nodes.iter().map(|node| match node.is_leaf() {
            true => Node::leaf(node.min, node.max, node.count() as u32, (before + node.first()) as u32),
            false => *node,
        }));
        items.extend_from_slice(&piece.items);
    }
    let is_cut = items.len() > references.len();
    Tree { nodes, items, scale, is_cut }
}

impl Piece {
    fn new(count: usize) -> Self {
        Piece { nodes: Vec::with_capacity(count), items: Vec::with_capacity(count) }
    }
}

impl Builder<'_> {
    /// Builds over some references.
    fn subtree(
        &self,
        references: &mut [Reference],
        all: &Bin,
        mut budget: Budget,
        depth: usize,
        pieces: &mut Vec<Piece>,
    ) -> Counts {
        let number = pieces.len() - 1;
        let piece = &mut pieces[number];
        let (place, Bin { min, max, count }) = (piece.nodes.len(), *all);
        piece.nodes.push(Node::leaf(min, max, count, piece.items.len() as u32));
        if references.len() == 1 || references.len() <= self.whole && self.is_whole(references, all) {
            piece.items.extend(references.iter().map(Reference::number));
            return Counts { references: count, leaves: 1 };
        }
        let cut = self.cut(references, all, depth);
        let parts = match depth < HALVING_DEPTH {
            true => self.parts(references, all, &cut, &mut budget),
            false => None,
        };
        let [left, right] = match parts {
            Some([mut left, mut right]) => {
                let boxes = [Bin::of(&left), Bin::of(&right)];
                self.both([&mut left, &mut right], boxes, budget, depth, pieces)
            }
            None => {
                let (boxes, middle) = self.divide(references, &cut);
                self.both(references.split_at_mut(middle).into(), boxes, budget, depth, pieces)
            }
        };
        let counts = Counts { references: left.references + right.references, leaves: left.leaves + right.leaves };
        pieces[number].nodes[place] = Node::inner(min, max, counts.references, left.leaves);
        counts
    }

    /// Whether a few references are so near each other that boxes of their own would spare few tests.
    fn is_whole(&self, references: &[Reference], all: &Bin) -> bool {
        let areas = references.iter().map(|r| half_area(r.min, r.max, self.scale));
        half_area(all.min, all.max, self.scale) <= 4.0 * areas.fold(f32::INFINITY, f32::min)
    }

    /// Builds over the references of both children.
    fn both(
        &self,
        [left, right]: [&mut [Reference]; 2],
        [left_all, right_all]: [Bin; 2],
        budget: Budget,
        depth: usize,
        pieces: &mut Vec<Piece>,
    ) -> [Counts; 2] {
        let [for_left, for_right] = budget.shared(left.len(), right.len());
        let build = |references: &mut [Reference], all, budget, pieces: &mut Vec<Piece>| {
            self.subtree(references, all, budget, depth + 1, pieces)
        };
        if left.len() + right.len() <= PARALLEL {
            return [build(left, &left_all, for_left, pieces), build(right, &right_all, for_right, pieces)];
        }
        let mut others = [vec![Piece::new(left.len())], vec![Piece::new(right.len())]];
        let [a, b] = &mut others;
        let (left, right) =
            rayon::join(|| build(left, &left_all, for_left, a), || build(right, &right_all, for_right, b));
        others.iter_mut().for_each(|other| pieces.append(other));
        [left, right]
    }
}
