//! Improving a binary tree: subtrees are taken out and put where they enlarge boxes least.
//!
//! Source: Meister, Bittner, *Parallel Reinsertion for Bounding Volume Hierarchy Optimization*, Eurographics 2018.

use super::binary::{Node, Tree, half_area};
use crate::bvh::DEEPEST;
use glam::Vec4;
use rayon::prelude::*;

/// In each pass this share of nodes, those of greatest area, are looked at.
const SHARE: f64 = 0.08;
/// A search for a better place ends after so many nodes.
const PATIENCE: usize = 1 << 12;

/// The nodes of a tree after so many passes; `None` if there is nothing to improve, or the tree would become too deep.
pub fn improved(tree: &Tree, passes: usize) -> Option<Vec<Node>> {
    if tree.nodes.len() < 5 || passes == 0 {
        return None;
    }
    let mut work = Linked::new(tree);
    for _ in 0..passes {
        if work.pass() == 0 {
            break;
        }
    }
    work.in_order()
}

const NONE: u32 = u32::MAX;

/// The tree with explicit links.
struct Linked {
    nodes: Vec<Link>,
    scale: f32,
}

#[derive(Clone, Copy)]
struct Link {
    node: Node,
    area: f32,
    parent: u32,
    /// `NONE` in leaves.
    children: [u32; 2],
}

/// A subtree, where it should go, and how much area that saves.
#[derive(Clone, Copy)]
struct Move {
    gain: f32,
    from: u32,
    to: u32,
}

impl Linked {
    fn new(tree: &Tree) -> Self {
        let scale = tree.scale;
        let link = |node: &Node| Link {
            node: *node,
            area: half_area(node.min, node.max, scale),
            parent: NONE,
            children: [NONE; 2],
        };
        let mut nodes: Vec<Link> = tree.nodes.iter().map(link).collect();
        for i in 0..nodes.len() {
            if !nodes[i].node.is_leaf() {
                let children = [i as u32 + 1, (i + nodes[i].node.right()) as u32];
                nodes[i].children = children;
                for child in children {
                    nodes[child as usize].parent = i as u32;
                }
            }
        }
        Linked { nodes, scale }
    }

    fn at(&self, i: u32) -> &Link {
        &self.nodes[i as usize]
    }

    fn sibling(&self, i: u32) -> u32 {
        let [a, b] = self.at(self.at(i).parent).children;
        if a == i { b } else { a }
    }

    /// Looks for better places for the largest nodes, and takes those that do not meddle with each other; gives
    /// the number of moves.
    fn pass(&mut self) -> usize {
        // The root and its children stay.
        let movable = |&i: &u32| i != 0 && self.at(i).parent != 0;
        let mut candidates: Vec<u32> = (0..self.nodes.len() as u32).filter(movable).collect();
        let count = ((self.nodes.len() as f64 * SHARE) as usize).clamp(16, 1 << 24).min(candidates.len());
        let by_area = |a: &u32, b: &u32| self.at(*b).area.total_cmp(&self.at(*a).area).then(a.cmp(b));
        if count < candidates.len() {
            candidates.select_nth_unstable_by(count, by_area);
            candidates.truncate(count);
        }
        let mut moves: Vec<Move> = candidates.par_iter().with_min_len(64).filter_map(|&from| self.find(from)).collect();
        moves.sort_unstable_by(|a, b| b.gain.total_cmp(&a.gain).then(a.from.cmp(&b.from)));
        let mut touched = vec![false; self.nodes.len()];
        let mut made = 0;
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
            made += 1;
        }
        made
    }

    /// Whether a node lies in a subtree, as it may after an earlier move of the same pass.
    fn is_below(&self, mut i: u32, subtree: u32) -> bool {
        while i != NONE && i != subtree {
            i = self.at(i).parent;
        }
        i == subtree
    }

    /// The best place for a subtree, searched upwards from where it is, and from there down into the siblings.
    fn find(&self, from: u32) -> Option<Move> {
        let Link { node, area, parent, .. } = *self.at(from);
        let merged = |other: &Link| half_area(node.min.min(other.node.min), node.max.max(other.node.max), self.scale);
        let mut best = Move { gain: 0.0, from, to: NONE };
        // Without the subtree its parent goes, and the boxes above shrink.
        let mut saved = self.at(parent).area;
        let mut pivot = parent;
        let mut sibling = self.sibling(from);
        let mut shrunk = (self.at(sibling).node.min, self.at(sibling).node.max);
        let mut stack: Vec<(f32, u32)> = Vec::with_capacity(64);
        let mut patience = PATIENCE;
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

    /// Takes a subtree with its parent out, and puts the parent between a node and that node's parent.
    fn apply(&mut self, from: u32, to: u32) {
        let parent = self.at(from).parent;
        let (sibling, above) = (self.sibling(from), self.at(parent).parent);
        self.replace(above, parent, sibling);
        self.refit(above);
        let new_above = self.at(to).parent;
        self.replace(new_above, to, parent);
        self.nodes[parent as usize].children = [to, from];
        self.nodes[to as usize].parent = parent;
        self.refit(parent);
    }

    fn replace(&mut self, parent: u32, old: u32, new: u32) {
        let children = &mut self.nodes[parent as usize].children;
        let which = usize::from(children[1] == old);
        children[which] = new;
        self.nodes[new as usize].parent = parent;
    }

    /// Makes boxes fit again, from a node upwards.
    fn refit(&mut self, mut i: u32) {
        while i != NONE {
            let [a, b] = self.at(i).children.map(|child| self.at(child).node);
            let (min, max): (Vec4, Vec4) = (a.min.min(b.min), a.max.max(b.max));
            let area = half_area(min, max, self.scale);
            let link = &mut self.nodes[i as usize];
            link.node = Node::inner(min, max, 0, 0);
            link.area = area;
            i = link.parent;
        }
    }

    /// The nodes in depth-first order with their counts; `None` if the tree is too deep.
    fn in_order(&self) -> Option<Vec<Node>> {
        let mut nodes: Vec<Node> = Vec::with_capacity(self.nodes.len());
        let mut stack = vec![(0, 1)];
        while let Some((i, depth)) = stack.pop() {
            if depth > DEEPEST {
                return None;
            }
            let link = self.at(i);
            nodes.push(link.node);
            let [left, right] = link.children;
            if left != NONE {
                stack.extend([(right, depth + 1), (left, depth + 1)]);
            }
        }
        // Children come after their parents, so counts are added from the end.
        let mut leaves = vec![1; nodes.len()];
        for i in (0..nodes.len()).rev() {
            if nodes[i].is_leaf() {
                continue;
            }
            let [left, right] = [i + 1, i + 2 * leaves[i + 1] as usize];
            let count = (nodes[left].count() + nodes[right].count()) as u32;
            leaves[i] = leaves[left] + leaves[right];
            nodes[i] = Node::inner(nodes[i].min, nodes[i].max, count, leaves[left]);
        }
        Some(nodes)
    }
}
