//! A binary tree over references, from the top down by the surface area heuristic.

use super::cut::{Bin, HALVING_DEPTH};
use super::spatial::{FEWEST, Searches};
use super::{Reference, Settings, lane, lane_number};
use crate::bvh::lanes::large_pages;
use crate::math::{Aabb, Vec3};
use glam::Vec4;
use rayon::prelude::*;

/// Subtrees of more references than this are built in parallel.
const PARALLEL: u32 = 4096;

/// A node. Nodes lie in depth-first order: the left child follows its parent, the right child what is below the left one, and behind
/// that, where subtrees were built in parallel, room that is left over.
#[derive(Clone, Copy, Debug)]
pub struct Node {
    /// With the number of references in the fourth lane, and whether it is a leaf.
    pub min: Vec4,
    /// With a leaf's first reference, or half of how far behind its parent the right child is.
    pub max: Vec4,
}

/// A node as it lies in memory: numbers, of which a list of zeros is given by the system as it is touched.
pub type Slot = [[f32; 4]; 2];

const INNER: u32 = 2;
const LEAF: u32 = 3;

impl Node {
    pub fn leaf(mut min: Vec4, mut max: Vec4, count: u32, first: u32) -> Self {
        (min.w, max.w) = (lane(LEAF, count), lane(LEAF, first));
        Node { min, max }
    }

    pub fn inner(mut min: Vec4, mut max: Vec4, count: u32, right: usize) -> Self {
        debug_assert!(right.is_multiple_of(2));
        (min.w, max.w) = (lane(INNER, count), lane(INNER, (right / 2) as u32));
        Node { min, max }
    }

    #[inline]
    pub fn of(&[min, max]: &Slot) -> Self {
        Node { min: min.into(), max: max.into() }
    }

    #[inline]
    pub fn slot(self) -> Slot {
        [self.min.into(), self.max.into()]
    }

    #[inline]
    pub fn is_leaf(&self) -> bool {
        self.min.w.to_bits() >> 28 == LEAF
    }

    /// How many references are below it.
    #[inline]
    pub fn count(&self) -> usize {
        lane_number(self.min.w) as usize
    }

    /// Where a leaf's references begin.
    #[inline]
    pub fn first(&self) -> usize {
        lane_number(self.max.w) as usize
    }

    /// How far behind its parent the right child is.
    #[inline]
    pub fn right(&self) -> usize {
        2 * lane_number(self.max.w) as usize
    }

    pub fn bounds(&self) -> Aabb {
        Aabb { min: self.min.truncate(), max: self.max.truncate() }
    }
}

/// The tree, the references of its leaves, and what sizes are multiplied by before areas are compared.
pub struct Tree {
    pub nodes: Vec<Slot>,
    pub references: Vec<Reference>,
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

/// Where a subtree is built.
struct Room<'a> {
    /// As many as there are, and room for those that cuts add.
    references: &'a mut [Reference],
    /// The place of the first among all.
    first: usize,
    /// Twice as many as there is room for references, less one: as many as a tree may need.
    nodes: &'a mut [Slot],
    searches: Searches,
}

/// How many references are below a node, and how many nodes from it on are taken.
struct Counts {
    references: u32,
    nodes: usize,
}

/// Builds a tree; triangles whose corners are known may be cut.
pub fn build(
    mut references: Vec<Reference>,
    all: &Bin,
    scale: f32,
    settings: &Settings,
    corners: &[[Vec3; 3]],
) -> Tree {
    let area = half_area(all.min, all.max, scale);
    let builder = Builder { scale, area, whole: settings.whole, bins: settings.bins, corners };
    references.par_extend(rayon::iter::repeat_n(references[0], settings.spare(references.len())));
    let mut nodes = vec![Slot::default(); 2 * references.len() - 1];
    large_pages(nodes.as_ptr(), nodes.len());
    let room = Room { references: &mut references, first: 0, nodes: &mut nodes, searches: Searches::default() };
    let counts = builder.subtree(room, all, 0);
    nodes.truncate(counts.nodes);
    Tree { nodes, references, scale, is_cut: counts.references > all.count }
}

impl Room<'_> {
    /// Where the room of the right one of two children begins, by how many references are in each.
    ///
    /// What there is to spare goes where more references are, but not to the left where there are too few to be cut.
    fn shared(&self, left: usize, right: usize) -> usize {
        let spare = self.references.len() - left - right;
        let for_left = match left > FEWEST {
            true => (spare as u64 * left as u64 / (left + right) as u64) as usize,
            false => 0,
        };
        left + for_left
    }
}

impl Builder<'_> {
    /// Builds over the references that a room begins with.
    fn subtree(&self, mut room: Room, all: &Bin, depth: usize) -> Counts {
        let (Bin { min, max, .. }, count) = (*all, all.count as usize);
        let spare = room.references.len() - count;
        let references = &mut room.references[..count];
        if count == 1 || count <= self.whole && self.is_whole(references, all) {
            room.nodes[0] = Node::leaf(min, max, all.count, room.first as u32).slot();
            return Counts { references: all.count, nodes: 1 };
        }
        let cut = self.cut(references, all, depth);
        let parts = match depth < HALVING_DEPTH {
            true => self.parts(references, spare, all, &cut, &mut room.searches),
            false => None,
        };
        let (boxes, middle) = match parts {
            Some([left, right]) => {
                let middle = room.shared(left.len(), right.len());
                room.references[..left.len()].copy_from_slice(&left);
                room.references[middle..][..right.len()].copy_from_slice(&right);
                ([Bin::of(&left), Bin::of(&right)], middle)
            }
            None => {
                let (boxes, left) = self.divide(references, &cut);
                let middle = room.shared(left, count - left);
                if left < middle {
                    room.references.copy_within(left..count, middle);
                }
                (boxes, middle)
            }
        };
        let (here, below) = room.nodes.split_first_mut().expect("there is room for a node");
        let (left, right) = room.references.split_at_mut(middle);
        let [left_all, right_all] = &boxes;
        let searches = room.searches;
        let left = Room { references: left, first: room.first, nodes: &mut [], searches };
        let right = Room { references: right, first: room.first + middle, nodes: &mut [], searches };
        let build = |room: Room, all| self.subtree(room, all, depth + 1);
        let [left, right] = if left_all.count + right_all.count > PARALLEL {
            let (left_nodes, right_nodes) = below.split_at_mut(2 * middle - 1);
            let nodes = left_nodes.len();
            let (left, right) = rayon::join(
                || build(Room { nodes: left_nodes, ..left }, left_all),
                || build(Room { nodes: right_nodes, ..right }, right_all),
            );
            [Counts { nodes, ..left }, right]
        } else {
            let left = build(Room { nodes: below, ..left }, left_all);
            let right = build(Room { nodes: &mut below[left.nodes..], ..right }, right_all);
            [left, right]
        };
        let references = left.references + right.references;
        *here = Node::inner(min, max, references, 1 + left.nodes).slot();
        Counts { references, nodes: 1 + left.nodes + right.nodes }
    }

    /// Whether a few references are so near each other that boxes of their own would spare few tests.
    fn is_whole(&self, references: &[Reference], all: &Bin) -> bool {
        let areas = references.iter().map(|r| half_area(r.min, r.max, self.scale));
        half_area(all.min, all.max, self.scale) <= 4.0 * areas.fold(f32::INFINITY, f32::min)
    }
}
