//! Builds a binary tree over references from the top down, guided by the surface area heuristic.

use super::builder::{Bin, Builder, half_area};
use super::object_split::HALVING_DEPTH;
use super::reference::{Reference, area_scale, decode_lane, encode_lane};
use super::settings::BuildSettings;
use super::spatial_split::{MIN_REFERENCES, SearchHistory};
use crate::lanes::parallel_vec;
use crate::math::{Aabb, Vec3};
use crate::parallel;
use glam::Vec4;

/// Number of references above which subtrees are built in parallel.
const PARALLEL: u32 = 4096;

/// Node of a binary BVH during construction, before it is collapsed into nodes with eight children.
/// Nodes are stored in depth-first order: the left child follows its parent, and the right child
/// follows the left subtree. There may be unused nodes between subtrees that were built in
/// parallel.
#[derive(Clone, Copy, Debug)]
pub struct BinaryNode {
    /// Minimum corner. The fourth lane holds the number of references, with a tag that
    /// distinguishes leaves from inner nodes.
    pub min: Vec4,
    /// Maximum corner. In a leaf, the fourth lane holds the position of the first reference. In an
    /// inner node, it holds half the distance to the right child.
    pub max: Vec4,
}

const INNER: u32 = 2;
const LEAF: u32 = 3;

impl BinaryNode {
    /// An unused entry in the list of nodes.
    pub const NONE: BinaryNode = BinaryNode { min: Vec4::ZERO, max: Vec4::ZERO };

    pub fn leaf(mut min: Vec4, mut max: Vec4, count: u32, first: u32) -> Self {
        (min.w, max.w) = (encode_lane(LEAF, count), encode_lane(LEAF, first));
        BinaryNode { min, max }
    }

    pub fn inner(mut min: Vec4, mut max: Vec4, count: u32, right: usize) -> Self {
        debug_assert!(right.is_multiple_of(2));
        (min.w, max.w) = (encode_lane(INNER, count), encode_lane(INNER, (right / 2) as u32));
        BinaryNode { min, max }
    }

    /// Returns true unless this is [`BinaryNode::NONE`].
    #[inline]
    pub fn is_there(&self) -> bool {
        self.count() > 0
    }

    #[inline]
    pub fn is_leaf(&self) -> bool {
        self.min.w.to_bits() >> 28 == LEAF
    }

    /// Returns the number of references in the subtree.
    #[inline]
    pub fn count(&self) -> usize {
        decode_lane(self.min.w) as usize
    }

    /// Returns the position of the first reference of a leaf.
    #[inline]
    pub fn first(&self) -> usize {
        decode_lane(self.max.w) as usize
    }

    /// Returns the distance from the node to its right child, in nodes.
    #[inline]
    pub fn right(&self) -> usize {
        2 * decode_lane(self.max.w) as usize
    }

    pub fn bounds(&self) -> Aabb {
        Aabb { min: self.min.truncate(), max: self.max.truncate() }
    }
}

/// A binary BVH during construction. `scale` is the factor by which sizes are multiplied before
/// areas are compared.
pub struct BinaryTree {
    pub nodes: Vec<BinaryNode>,
    pub scale: f32,
    /// True if some primitive is in several leaves.
    pub has_splits: bool,
}

/// Section of the list of references from which a subtree is built.
struct BuildRange<'a> {
    /// References in the subtree, followed by free space for references that splits add.
    references: &'a mut [Reference],
    /// Position of the first reference in the list of all references.
    first: usize,
    searches: SearchHistory,
}

/// Result of building a subtree: the number of references in it, and the number of nodes reserved
/// for it.
struct SubtreeSize {
    references: u32,
    nodes: usize,
}

/// Builds a binary tree over at least one reference. Also returns the references that the leaves
/// refer to. List entries that belong to no leaf are meaningless. If `corners` is not empty,
/// triangles may be split.
pub fn build(
    mut references: Vec<Reference>,
    settings: &BuildSettings,
    corners: &[[Vec3; 3]],
) -> (BinaryTree, Vec<Reference>) {
    let all = Bin::of(&references);
    let scale = area_scale(all.bounds());
    let area = half_area(all.min, all.max, scale);
    let builder = Builder { scale, area, whole: settings.compact_leaf_size, bins: settings.bins, corners };
    let (first, spare) = (references[0], settings.max_added_references(references.len()));
    parallel::extend(&mut references, spare, 1, |_| first);
    let mut nodes = parallel_vec(2 * references.len() - 1, 0, |_| BinaryNode::NONE);
    let space = BuildRange { references: &mut references, first: 0, searches: SearchHistory::default() };
    let counts = builder.subtree(space, &mut nodes, &all, 0);
    nodes.truncate(counts.nodes);
    // Most of the space was reserved for leaves with a single reference.
    nodes.shrink_to_fit();
    (BinaryTree { nodes, scale, has_splits: counts.references > all.count }, references)
}

impl BuildRange<'_> {
    /// Returns the start of the right child's range, given the number of references in each child.
    ///
    /// Space for splits is shared in proportion to the number of references. A child with too few
    /// references to be split gets none.
    fn middle(&self, left: usize, right: usize) -> usize {
        let spare = self.references.len() - left - right;
        let for_left = match [left, right].map(|count| count > MIN_REFERENCES) {
            [true, true] => (spare as u64 * left as u64 / (left + right) as u64) as usize,
            [true, false] => spare,
            [false, _] => 0,
        };
        left + for_left
    }
}

impl Builder<'_> {
    /// Builds a subtree over the first `all.count` references of `space`. `nodes` must have space
    /// for twice as many nodes as `space` has references, minus one.
    fn subtree(&self, mut space: BuildRange, nodes: &mut [BinaryNode], all: &Bin, depth: usize) -> SubtreeSize {
        let (Bin { min, max, .. }, count) = (*all, all.count as usize);
        let spare = space.references.len() - count;
        let references = &mut space.references[..count];
        if count == 1 || count <= self.whole && self.is_compact(references, all) {
            nodes[0] = BinaryNode::leaf(min, max, all.count, space.first as u32);
            return SubtreeSize { references: all.count, nodes: 1 };
        }
        let cut = self.object_split(references, all, depth);
        let parts = match depth < HALVING_DEPTH {
            true => self.spatial_split(references, spare, all, &cut, &mut space.searches),
            false => None,
        };
        let (boxes, middle) = match parts {
            Some([left, right]) => {
                let middle = space.middle(left.len(), right.len());
                space.references[..left.len()].copy_from_slice(&left);
                space.references[middle..][..right.len()].copy_from_slice(&right);
                ([Bin::of(&left), Bin::of(&right)], middle)
            }
            None => {
                let (boxes, left) = self.divide(references, &cut);
                let middle = space.middle(left, count - left);
                if left < middle {
                    space.references.copy_within(left..count, middle);
                }
                (boxes, middle)
            }
        };
        let (here, below) = nodes.split_first_mut().expect("the list has space for a node");
        let (left, right) = space.references.split_at_mut(middle);
        let [left_all, right_all] = &boxes;
        let left = BuildRange { references: left, ..space };
        let right = BuildRange { references: right, first: space.first + middle, ..space };
        let build = |space, nodes: &mut _, all| self.subtree(space, nodes, all, depth + 1);
        let [left, right] = if left_all.count + right_all.count > PARALLEL {
            let nodes = 2 * middle - 1;
            let (left_nodes, right_nodes) = below.split_at_mut(nodes);
            let (left, right) =
                parallel::join(|| build(left, left_nodes, left_all), || build(right, right_nodes, right_all));
            [SubtreeSize { nodes, ..left }, right]
        } else {
            let left = build(left, below, left_all);
            let right = build(right, &mut below[left.nodes..], right_all);
            [left, right]
        };
        let references = left.references + right.references;
        *here = BinaryNode::inner(min, max, references, 1 + left.nodes);
        SubtreeSize { references, nodes: 1 + left.nodes + right.nodes }
    }

    /// Returns true if the references are so close together that separate boxes would save few
    /// tests.
    fn is_compact(&self, references: &[Reference], all: &Bin) -> bool {
        let areas = references.iter().map(|r| half_area(r.min, r.max, self.scale));
        half_area(all.min, all.max, self.scale) <= 4.0 * areas.fold(f32::INFINITY, f32::min)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{BuildQuality, triangle_references};
    use super::*;
    use crate::math::random::Random;
    use crate::node::MAX_ITEMS;
    use crate::triangles::tests::bars;

    /// Checks a tree over `triangles` triangles that was built with space for `space` references.
    /// Returns the number of unused nodes.
    fn check(tree: &BinaryTree, references: &[Reference], triangles: usize, space: usize) -> usize {
        let (mut is_node, mut is_taken) = (vec![false; tree.nodes.len()], vec![false; space]);
        let (mut is_visited, mut stack) = (vec![false; triangles], vec![0]);
        while let Some(i) = stack.pop() {
            let node = tree.nodes[i];
            assert!(node.is_there() && !std::mem::replace(&mut is_node[i], true));
            if !node.is_leaf() {
                let children = [i + 1, i + node.right()];
                let [left, right] = children.map(|child| tree.nodes[child]);
                let both = left.bounds().union(right.bounds());
                assert_eq!(both.union(node.bounds()), node.bounds());
                assert_eq!(node.count(), left.count() + right.count());
                stack.extend(children);
                continue;
            }
            let mut bounds = Aabb::EMPTY;
            let range = node.first()..node.first() + node.count();
            for (is_taken, r) in is_taken[range.clone()].iter_mut().zip(&references[range]) {
                assert!(!std::mem::replace(is_taken, true));
                is_visited[r.number() as usize] = true;
                bounds = bounds.union(r.bounds());
            }
            assert_eq!(bounds, node.bounds());
        }
        assert!(is_visited.iter().all(|hits| *hits));
        let taken = is_taken.iter().filter(|taken| **taken).count();
        assert_eq!(taken, tree.nodes[0].count());
        assert_eq!(tree.has_splits, taken > triangles);
        let nothing = tree.nodes.iter().zip(&is_node).filter(|(_, is_node)| !**is_node);
        nothing.inspect(|(node, _)| assert!(!node.is_there())).count()
    }

    /// Every triangle is in a leaf, leaves do not share references, nodes are at the positions
    /// their parents refer to, and all other nodes are unused. This holds when splits are limited
    /// by their benefit or by space, and for parallel builds.
    #[test]
    fn leaves_are_disjoint_and_complete() {
        let mut random = Random(11);
        let (mut cut, mut with_gaps, mut limited) = (0, 0, 0);
        for count in [1, 2, 5, 700, 4_096, 4_097, 20_000] {
            let (vertices, triangles) = bars(&mut random, (count - count / 10) as u32, count / 10);
            let corners: Vec<[Vec3; 3]> = triangles.iter().map(|t| t.map(|i| vertices[i as usize])).collect();
            let taken = [0.0, 0.1, 2.0].map(|max_added_share| {
                let settings = BuildSettings { max_added_share, ..BuildSettings::triangles(BuildQuality::Best) };
                let references = triangle_references(count, &settings, &|i| corners[i as usize]);
                let (tree, references) = build(references, &settings, &corners);
                with_gaps +=
                    usize::from(check(&tree, &references, count, count + settings.max_added_references(count)) > 0);
                tree.nodes[0].count()
            });
            cut += usize::from(taken[2] > count);
            limited += usize::from(taken[0] < taken[1] && taken[1] < taken[2]);
        }
        assert!(cut >= 4 && with_gaps >= 6 && limited >= 3, "{cut} {with_gaps} {limited}");
    }

    #[test]
    fn node_stores_the_largest_numbers() {
        for number in [1, MAX_ITEMS] {
            let leaf = BinaryNode::leaf(Vec4::ZERO, Vec4::ONE, number as u32, number as u32);
            assert_eq!((leaf.is_leaf(), leaf.count(), leaf.first()), (true, number, number));
            let inner = BinaryNode::inner(Vec4::ZERO, Vec4::ONE, number as u32, 2 * number);
            assert_eq!((inner.is_leaf(), inner.count(), inner.right()), (false, number, 2 * number));
        }
    }
}
