//! Building: binned surface area heuristic, then four-wide nodes.
//!
//! Source: Wald, *On fast Construction of SAH-based Bounding Volume Hierarchies*, IEEE RT 2007.

use super::{Bvh, COUNT_SHIFT, EMPTY, LEAF_BIT, LEAF_SIZE, Node, WIDTH};
use crate::math::{Aabb, Vec3};
use glam::Vec4;

const BINS: usize = 16;
/// Below this depth things are halved by number, which bounds the depth of all trees.
const HALVING_DEPTH: usize = 40;
/// Cost of looking into a node, in tests of a thing.
const NODE_COST: f32 = 0.5;
/// Subtrees of more things than this are built in parallel.
const PARALLEL: usize = 4096;

#[derive(Clone, Copy)]
struct Item {
    bounds: Aabb,
    center: Vec3,
    index: u32,
}

/// A node of the binary tree that is built first.
enum Binary {
    Leaf(Vec<u32>),
    Inner(Box<[(Aabb, Binary); 2]>),
}

pub(super) fn build(boxes: &[Aabb]) -> Bvh {
    let mut items: Vec<Item> = boxes
        .iter()
        .enumerate()
        .filter(|(_, b)| !b.is_empty())
        .map(|(i, b)| Item { bounds: *b, center: b.center(), index: i as u32 })
        .collect();
    assert!(items.len() <= 1 << COUNT_SHIFT, "a tree holds at most 2^28 things");
    let bounds = around(&items);
    let mut bvh = Bvh { nodes: Vec::new(), order: Vec::with_capacity(items.len()), bounds };
    if !items.is_empty() {
        let root = split(&mut items, 0);
        // A tree of one leaf still needs a node to hold it.
        let children = match root {
            Binary::Inner(children) => Vec::from(*children),
            leaf => vec![(bounds, leaf)],
        };
        flatten(&mut bvh, children);
    }
    bvh
}

fn around(items: &[Item]) -> Aabb {
    items.iter().fold(Aabb::EMPTY, |b, item| b.union(item.bounds))
}

/// Splits things until they fit into leaves.
fn split(items: &mut [Item], depth: usize) -> Binary {
    if items.len() <= LEAF_SIZE && (items.len() == 1 || !worth_splitting(items)) {
        // Things in a leaf are in the order of their numbers, whatever the way to it.
        let mut leaf: Vec<u32> = items.iter().map(|item| item.index).collect();
        leaf.sort_unstable();
        return Binary::Leaf(leaf);
    }
    let cut = if depth < HALVING_DEPTH { sah_cut(items) } else { None };
    let cut = cut.unwrap_or_else(|| halve(items));
    let parallel = items.len() > PARALLEL;
    let (left, right) = items.split_at_mut(cut);
    let bounds = (around(left), around(right));
    let (left, right) = match parallel {
        true => rayon::join(|| split(left, depth + 1), || split(right, depth + 1)),
        false => (split(left, depth + 1), split(right, depth + 1)),
    };
    Binary::Inner(Box::new([(bounds.0, left), (bounds.1, right)]))
}

/// Whether a leaf's worth of things is better split once more.
fn worth_splitting(items: &[Item]) -> bool {
    best_bin(items).is_some_and(|best| {
        best.cost + NODE_COST * around(items).half_area() < items.len() as f32 * around(items).half_area()
    })
}

struct Best {
    axis: usize,
    bin: usize,
    cost: f32,
    low: f32,
    scale: f32,
}

fn bin_of(best: &Best, item: &Item) -> usize {
    // The cast saturates: NaN and all below give 0.
    (((item.center[best.axis] - best.low) * best.scale) as usize).min(BINS - 1)
}

/// The cheapest plane between bins over all axes, or `None` where centres cannot be told apart.
fn best_bin(items: &[Item]) -> Option<Best> {
    let centers = Aabb::around(items.iter().map(|item| item.center));
    let mut best: Option<Best> = None;
    for axis in 0..3 {
        let scale = BINS as f32 * (1.0 - 1e-6) / centers.size()[axis];
        if !scale.is_finite() || scale <= 0.0 {
            continue;
        }
        let mut candidate = Best { axis, bin: 0, cost: f32::INFINITY, low: centers.min[axis], scale };
        let mut bins = [(Aabb::EMPTY, 0usize); BINS];
        for item in items {
            let bin = &mut bins[bin_of(&candidate, item)];
            *bin = (bin.0.union(item.bounds), bin.1 + 1);
        }
        // Costs of everything right of each plane, then the sum from the left.
        let mut right_cost = [0.0; BINS];
        let mut right = (Aabb::EMPTY, 0);
        for i in (1..BINS).rev() {
            right = (right.0.union(bins[i].0), right.1 + bins[i].1);
            right_cost[i] = right.0.half_area() * right.1 as f32;
        }
        let mut left = (Aabb::EMPTY, 0);
        for i in 1..BINS {
            left = (left.0.union(bins[i - 1].0), left.1 + bins[i - 1].1);
            if left.1 == 0 || left.1 == items.len() {
                continue;
            }
            let cost = left.0.half_area() * left.1 as f32 + right_cost[i];
            if cost < candidate.cost {
                (candidate.cost, candidate.bin) = (cost, i);
            }
        }
        if candidate.bin > 0 && best.as_ref().is_none_or(|best| candidate.cost < best.cost) {
            best = Some(candidate);
        }
    }
    best
}

/// Sorts things to the two sides of the cheapest plane; gives the number on the left.
fn sah_cut(items: &mut [Item]) -> Option<usize> {
    let best = best_bin(items)?;
    // A stable partition: what is built does not depend on how things were shuffled before.
    let (left, right): (Vec<Item>, Vec<Item>) = items.iter().partition(|item| bin_of(&best, item) < best.bin);
    items[..left.len()].copy_from_slice(&left);
    items[left.len()..].copy_from_slice(&right);
    (!left.is_empty() && !right.is_empty()).then_some(left.len())
}

/// Sorts along the longest axis and cuts in the middle.
fn halve(items: &mut [Item]) -> usize {
    let size = Aabb::around(items.iter().map(|item| item.center)).size();
    let axis = if size.x >= size.y && size.x >= size.z {
        0
    } else if size.y >= size.z {
        1
    } else {
        2
    };
    items.sort_by(|a, b| a.center[axis].total_cmp(&b.center[axis]).then(a.index.cmp(&b.index)));
    items.len() / 2
}

/// Writes a node with these children, opening the largest inner ones until four are there; gives its number.
fn flatten(bvh: &mut Bvh, mut children: Vec<(Aabb, Binary)>) -> u32 {
    while children.len() < WIDTH {
        let inner = |(_, child): &&(Aabb, Binary)| matches!(child, Binary::Inner(_));
        let largest = children.iter().filter(inner).map(|(b, _)| b.half_area()).fold(f32::NEG_INFINITY, f32::max);
        let Some(i) = children.iter().position(|c| inner(&c) && c.0.half_area() >= largest) else { break };
        let (_, Binary::Inner(pair)) = children.remove(i) else { break };
        let [a, b] = *pair;
        children.insert(i, b);
        children.insert(i, a);
    }
    let number = bvh.nodes.len();
    let mut node = Node { min: [Vec4::INFINITY; 3], max: [Vec4::NEG_INFINITY; 3], children: [EMPTY; WIDTH] };
    for (i, (b, _)) in children.iter().enumerate() {
        for axis in 0..3 {
            node.min[axis][i] = b.min[axis];
            node.max[axis][i] = b.max[axis];
        }
    }
    bvh.nodes.push(node);
    for (i, (_, child)) in children.into_iter().enumerate() {
        bvh.nodes[number].children[i] = match child {
            Binary::Inner(pair) => flatten(bvh, Vec::from(*pair)),
            Binary::Leaf(items) => {
                let leaf = LEAF_BIT | ((items.len() - 1) as u32) << COUNT_SHIFT | bvh.order.len() as u32;
                bvh.order.extend(items);
                leaf
            }
        };
    }
    number as u32
}
