//! Optimises a binary tree by reinsertion, which moves each subtree to the place where it enlarges
//! boxes least.
//!
//! Source: Meister, Bittner, *Parallel Reinsertion for Bounding Volume Hierarchy Optimization*,
//! Eurographics 2018.

use super::binary::{BinaryNode, BinaryTree};
use super::builder::half_area;
use super::settings::MIN_GAIN;
use crate::lanes::vec_on_large_pages;
use crate::node::MAX_DEPTH;
use crate::parallel;

/// Fraction of the nodes that a pass examines. If a lot can be saved, a small number of nodes gives
/// most of the savings.
const SHARE: f64 = 0.04;
/// Additional fraction of the nodes that a pass examines if the possible savings do not predict the
/// actual ones.
const EXTRA_SHARES: usize = 3;
/// Maximum number of nodes visited in a search for a better place.
const MAX_VISITS: usize = 1 << 8;

const NONE: u32 = u32::MAX;

/// A binary BVH with links to parents and children, so that reinsertion can move its subtrees.
pub struct LinkedTree {
    nodes: Vec<LinkedNode>,
    scale: f32,
    area: f64,
}

/// A node of [`LinkedTree`], with its scaled half area and the positions of its parent and
/// children.
#[derive(Clone, Copy)]
struct LinkedNode {
    node: BinaryNode,
    area: f32,
    parent: u32,
    /// Leaves have `NONE` here.
    children: [u32; 2],
}

/// A reinsertion to apply: the subtree to move, its new sibling, and the area that the move saves.
#[derive(Clone, Copy)]
struct Move {
    gain: f32,
    from: u32,
    to: u32,
}

/// A node that may be moved, preceded by the maximum area that moving it can save.
type Candidate = (f32, u32);

/// Moves the `count` nodes with the greatest possible savings to the front of `nodes`.
fn greatest(nodes: &mut [Candidate], count: usize) -> (&[Candidate], &mut [Candidate]) {
    let count = count.min(nodes.len());
    if count < nodes.len() {
        nodes.select_nth_unstable_by(count, |a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    }
    let (greatest, others) = nodes.split_at_mut(count);
    (greatest, others)
}

impl LinkedTree {
    pub fn new(tree: &BinaryTree) -> Self {
        let scale = tree.scale;
        let mut nodes: Vec<LinkedNode> = vec_on_large_pages(tree.nodes.len());
        // Nodes are in depth-first order, so each node is a child of the last node that has fewer
        // than two children.
        let mut parents = Vec::new();
        for &node in tree.nodes.iter().filter(|node| node.is_there()) {
            let i = nodes.len() as u32;
            let parent = parents.pop().unwrap_or(NONE);
            if parent != NONE {
                let children = &mut nodes[parent as usize].children;
                children[usize::from(children[0] != NONE)] = i;
            }
            if !node.is_leaf() {
                parents.extend([i, i]);
            }
            nodes.push(LinkedNode { node, area: half_area(node.min, node.max, scale), parent, children: [NONE; 2] });
        }
        let area = nodes.iter().map(|link| f64::from(link.area)).sum();
        LinkedTree { nodes, scale, area }
    }

    fn at(&self, i: u32) -> &LinkedNode {
        &self.nodes[i as usize]
    }

    fn sibling(&self, i: u32) -> u32 {
        let [a, b] = self.at(self.at(i).parent).children;
        if a == i { b } else { a }
    }

    /// Searches for better places for the nodes with the greatest possible savings and applies the
    /// moves that do not conflict. Returns the fraction of the total area that the moves save.
    pub fn pass(&mut self) -> f64 {
        // Removing a subtree saves at least its parent's area, and inserting it costs at least its
        // own area. `max` also replaces the NaN that results from subtracting infinite areas.
        let savings = |i: u32| ((self.at(self.at(i).parent).area - self.at(i).area).max(0.0), i);
        // The root and its children are never moved.
        let movable = |&i: &u32| i != 0 && self.at(i).parent != 0;
        let mut candidates: Vec<Candidate> = (0..self.nodes.len() as u32).filter(movable).map(savings).collect();
        let count = ((self.nodes.len() as f64 * SHARE) as usize).clamp(16, 1 << 24);
        let (first, rest) = greatest(&mut candidates, count);
        let (next, rest) = greatest(rest, count / 4);
        let (mut moves, more) = (self.moves(first), self.moves(next));
        let gain = |moves: &[Move]| moves.iter().map(|m| f64::from(m.gain)).sum::<f64>();
        // If the actual savings hardly decrease as the possible savings decrease, the possible
        // savings do not show where to search. In this case, examine more nodes.
        let is_even = 4.0 * gain(&more) >= (0.25 * gain(&moves)).max(MIN_GAIN * self.area);
        moves.extend(more);
        if is_even {
            moves.extend(self.moves(greatest(rest, EXTRA_SHARES * count).0));
        }
        moves.sort_unstable_by(|a, b| b.gain.total_cmp(&a.gain).then(a.from.cmp(&b.from)));
        let mut touched = vec![false; self.nodes.len()];
        let before = self.area;
        for Move { from, to, .. } in moves {
            let parent = self.at(from).parent;
            let involved = [from, to, parent, self.sibling(from), self.at(to).parent, self.at(parent).parent];
            if involved.iter().any(|&i| touched[i as usize]) || self.is_below(to, from) {
                continue;
            }
            for i in involved {
                touched[i as usize] = true;
            }
            self.apply(from, to);
        }
        (before - self.area) / before
    }

    /// Finds better places for some of the nodes.
    fn moves(&self, candidates: &[Candidate]) -> Vec<Move> {
        parallel::filter_map(candidates, 64, |&(_, from)| self.find(from))
    }

    /// Returns true if a node is in a subtree, for example because an earlier move in the same pass
    /// put it there.
    fn is_below(&self, mut i: u32, subtree: u32) -> bool {
        while i != NONE && i != subtree {
            i = self.at(i).parent;
        }
        i == subtree
    }

    /// Finds the best place for a subtree. The search goes up from its current position, and from
    /// each level down into the siblings.
    fn find(&self, from: u32) -> Option<Move> {
        let LinkedNode { node, area, parent, .. } = *self.at(from);
        let merged =
            |other: &LinkedNode| half_area(node.min.min(other.node.min), node.max.max(other.node.max), self.scale);
        let mut best = Move { gain: 0.0, from, to: NONE };
        // Removing the subtree also removes its parent, and the boxes above shrink.
        let mut saved = self.at(parent).area;
        let mut pivot = parent;
        let mut sibling = self.sibling(from);
        let mut shrunk = (self.at(sibling).node.min, self.at(sibling).node.max);
        let mut stack: Vec<(f32, u32)> = Vec::with_capacity(64);
        let mut patience = MAX_VISITS;
        loop {
            stack.push((saved, sibling));
            while let Some((saved, to)) = stack.pop() {
                if saved - area <= best.gain || patience == 0 {
                    continue;
                }
                patience -= 1;
                let target = self.at(to);
                let gain = saved - merged(target);
                if gain > best.gain && to != self.sibling(from) {
                    best = Move { gain, to, ..best };
                }
                if target.children[0] != NONE {
                    let below = gain + target.area;
                    stack.extend(target.children.map(|child| (below, child)));
                }
            }
            if pivot != parent {
                let link = self.at(sibling);
                shrunk = (shrunk.0.min(link.node.min), shrunk.1.max(link.node.max));
                saved += self.at(pivot).area - half_area(shrunk.0, shrunk.1, self.scale);
            }
            if self.at(pivot).parent == NONE {
                break;
            }
            sibling = self.sibling(pivot);
            pivot = self.at(pivot).parent;
        }
        (best.to != NONE).then_some(best)
    }

    /// Removes a subtree and its parent, and inserts the parent between the node `to` and its
    /// parent.
    fn apply(&mut self, from: u32, to: u32) {
        let parent = self.at(from).parent;
        let (sibling, above) = (self.sibling(from), self.at(parent).parent);
        self.replace(above, parent, sibling);
        self.refit(above);
        let new_above = self.at(to).parent;
        self.replace(new_above, to, parent);
        self.nodes[parent as usize].children = [to, from];
        self.nodes[to as usize].parent = parent;
        self.fit(parent);
        self.refit(new_above);
    }

    fn replace(&mut self, parent: u32, old: u32, new: u32) {
        let children = &mut self.nodes[parent as usize].children;
        let which = usize::from(children[1] == old);
        children[which] = new;
        self.nodes[new as usize].parent = parent;
    }

    /// Refits boxes from a node upwards until a box does not change.
    fn refit(&mut self, mut i: u32) {
        while i != NONE && self.fit(i) {
            i = self.at(i).parent;
        }
    }

    /// Fits the box of a node to its children. Returns true if the box has changed.
    fn fit(&mut self, i: u32) -> bool {
        let [a, b] = self.at(i).children.map(|child| self.at(child).node);
        let node = BinaryNode::inner(a.min.min(b.min), a.max.max(b.max), 0, 0);
        let area = half_area(node.min, node.max, self.scale);
        let link = &mut self.nodes[i as usize];
        let is_other = node.bounds() != link.node.bounds();
        self.area += f64::from(area) - f64::from(link.area);
        (link.node, link.area) = (node, area);
        is_other
    }

    /// Returns the nodes in depth-first order with their counts, or `None` if the tree is too deep.
    pub fn in_order(&self) -> Option<Vec<BinaryNode>> {
        let mut nodes: Vec<BinaryNode> = vec_on_large_pages(self.nodes.len());
        let mut stack = vec![(0, 1)];
        while let Some((i, depth)) = stack.pop() {
            if depth > MAX_DEPTH {
                return None;
            }
            let link = self.at(i);
            nodes.push(link.node);
            let [left, right] = link.children;
            if left != NONE {
                stack.extend([(right, depth + 1), (left, depth + 1)]);
            }
        }
        // Children come after their parents, so counts are added up from the end of the list.
        let mut below = vec![1_u32; nodes.len()];
        for i in (0..nodes.len()).rev() {
            let node = nodes[i];
            if node.is_leaf() {
                continue;
            }
            let [left, right] = [i + 1, i + 1 + below[i + 1] as usize];
            let count = [left, right].map(|child| nodes[child].count() as u32);
            below[i] = 1 + below[left] + below[right];
            nodes[i] = BinaryNode::inner(node.min, node.max, count[0] + count[1], right - i);
        }
        Some(nodes)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{BuildSettings, binary, references};
    use super::*;
    use crate::math::Aabb;
    use crate::math::random::Random;

    /// After each pass, boxes and areas match the children, leaves hold the same primitives, and
    /// the saved area is the one that the pass returned.
    #[test]
    fn boxes_fit_after_each_pass() {
        let mut random = Random(3);
        for count in [5, 60, 3_000, 6_000] {
            // A few large boxes lie among many small ones, so the first tree is not optimal.
            let square = |x: f32| x * x;
            let boxes: Vec<Aabb> = (0..count)
                .map(|_| {
                    let (at, size) = (random.point(), 0.5 * square(square(square(random.unit()))));
                    Aabb { min: at - size, max: at + size }
                })
                .collect();
            // If leaves have few references, unused nodes remain between subtrees that were built
            // in parallel.
            let settings = BuildSettings { compact_leaf_size: 3, ..BuildSettings::PRIMITIVES };
            let (tree, _) = binary::build(references(&boxes), &settings, &[]);
            assert!((count > 4096) == tree.nodes.iter().any(|node| !node.is_there()));
            let leaves = |nodes: &[BinaryNode]| {
                let mut leaves: Vec<usize> =
                    nodes.iter().filter(|node| node.is_leaf()).map(BinaryNode::first).collect();
                leaves.sort_unstable();
                leaves
            };
            let area = |node: &BinaryNode| half_area(node.min, node.max, tree.scale);
            let sum = |nodes: &[BinaryNode]| nodes.iter().map(|node| f64::from(area(node))).sum::<f64>();
            let first = sum(&tree.nodes);
            let (mut work, mut before) = (LinkedTree::new(&tree), first);
            for _ in 0..4 {
                let savings = work.pass();
                assert!(work.nodes.iter().all(|link| link.area == area(&link.node)));
                let nodes = work.in_order().expect("a shallow tree");
                for (i, node) in nodes.iter().enumerate().filter(|(_, node)| !node.is_leaf()) {
                    let [left, right] = [i + 1, i + node.right()].map(|child| nodes[child]);
                    assert_eq!(node.bounds(), left.bounds().union(right.bounds()));
                    assert_eq!(node.count(), left.count() + right.count());
                }
                assert_eq!(leaves(&nodes), leaves(&tree.nodes));
                let now = sum(&nodes);
                assert!((savings - (before - now) / before).abs() < 1e-9, "{savings} of {before}, {now}");
                before = now;
            }
            assert!(count == 5 || before < 0.99 * first, "{count}: {first} to {before}");
        }
    }
}
