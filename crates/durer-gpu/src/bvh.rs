//! Builder of the binary trees that the device traverses.
//!
//! The trees of `durer-bvh` have eight children per node and orders for SIMD, which a shader cannot
//! use. This builder splits by the surface area heuristic over bins (Wald, *On fast Construction of
//! SAH-based Bounding Volume Hierarchies*, RT 2007).

use crate::layout::{MAX_DEPTH, NONE, Node};
use durer_scene::math::{Aabb, Vec3};

const BINS: usize = 16;

/// Depth beyond which nodes are split in half, so that no tree is deeper than [`MAX_DEPTH`].
const MAX_SAH_DEPTH: u32 = MAX_DEPTH / 2;

/// Appends the tree over some boxes to `nodes`. Returns its root, or [`NONE`] without boxes, and
/// the numbers of the boxes in the order of the leaves. A leaf refers to at most `leaf` consecutive
/// places of that order, counted from `base`.
pub fn build(boxes: &[Aabb], base: u32, leaf: usize, nodes: &mut Vec<Node>) -> (u32, Vec<u32>) {
    let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
    if boxes.is_empty() {
        return (NONE, order);
    }
    let root = nodes.len() as u32;
    nodes.push(Node::default());
    let mut open = vec![(root, 0, boxes.len(), 0)];
    while let Some((at, start, end, depth)) = open.pop() {
        let items = &mut order[start..end];
        let bounds = items.iter().fold(Aabb::EMPTY, |all, &item| all.union(boxes[item as usize]));
        let node = |first, count| Node { min: bounds.min.into(), first, max: bounds.max.into(), count };
        if items.len() <= leaf {
            nodes[at as usize] = node(base + start as u32, items.len() as u32);
            continue;
        }
        let middle = start + split(boxes, items, depth >= MAX_SAH_DEPTH);
        let first = nodes.len() as u32;
        nodes[at as usize] = node(first, 0);
        nodes.extend([Node::default(); 2]);
        open.push((first, start, middle, depth + 1));
        open.push((first + 1, middle, end, depth + 1));
    }
    (root, order)
}

/// Partitions at least two items and returns the number of items in the first part, which is
/// neither 0 nor all. With `in_half`, both parts have the same size.
fn split(boxes: &[Aabb], items: &mut [u32], in_half: bool) -> usize {
    let middle = |item: &u32| boxes[*item as usize].center();
    let centers = Aabb::around(items.iter().map(middle));
    let size = centers.size();
    let axis = (0..3).fold(0, |best, axis| if size[axis] > size[best] { axis } else { best });
    let half = items.len() / 2;
    let best = if in_half { None } else { best_plane(boxes, items, &centers) };
    let Some((axis, bin)) = best else {
        items.select_nth_unstable_by(half, |a, b| middle(a)[axis].total_cmp(&middle(b)[axis]).then(a.cmp(b)));
        return half;
    };
    let (low, high): (Vec<u32>, Vec<u32>) =
        items.iter().partition(|item| bin_of(middle(item)[axis], &centers, axis) <= bin);
    items[..low.len()].copy_from_slice(&low);
    items[low.len()..].copy_from_slice(&high);
    low.len()
}

/// Returns the bin of a coordinate between the smallest and the largest centre.
fn bin_of(x: f32, centers: &Aabb, axis: usize) -> usize {
    let share = (x - centers.min[axis]) / (centers.max[axis] - centers.min[axis]);
    ((share * BINS as f32) as usize).min(BINS - 1)
}

/// Returns the axis and the last bin of the first part of the cheapest split, or `None` if all
/// centres are equal.
fn best_plane(boxes: &[Aabb], items: &[u32], centers: &Aabb) -> Option<(usize, usize)> {
    let mut best: Option<(f32, usize, usize)> = None;
    for axis in (0..3).filter(|&axis| centers.max[axis] > centers.min[axis]) {
        let mut bins = [(Aabb::EMPTY, 0_u32); BINS];
        for &item in items {
            let bounds = boxes[item as usize];
            let (all, count) = &mut bins[bin_of(bounds.center()[axis], centers, axis)];
            (*all, *count) = (all.union(bounds), *count + 1);
        }
        let cost = |(all, count): (Aabb, u32)| if count == 0 { 0.0 } else { all.half_area() * count as f32 };
        let mut above = [(Aabb::EMPTY, 0); BINS + 1];
        for bin in (0..BINS).rev() {
            above[bin] = (above[bin + 1].0.union(bins[bin].0), above[bin + 1].1 + bins[bin].1);
        }
        let mut below = (Aabb::EMPTY, 0);
        for bin in 0..BINS - 1 {
            below = (below.0.union(bins[bin].0), below.1 + bins[bin].1);
            let total = cost(below) + cost(above[bin + 1]);
            let is_split = below.1 > 0 && above[bin + 1].1 > 0;
            if is_split && total.is_finite() && best.is_none_or(|(least, ..)| total < least) {
                best = Some((total, axis, bin));
            }
        }
    }
    best.map(|(_, axis, bin)| (axis, bin))
}

/// Enlarges a box by `margin` and by a few rounding errors, so that no hit in single precision lies
/// outside it.
pub fn padded(bounds: Aabb, margin: f32) -> Aabb {
    let largest = bounds.min.abs().max(bounds.max.abs());
    let by = 4.0 * f32::EPSILON * largest + Vec3::splat(margin.max(f32::MIN_POSITIVE));
    Aabb { min: bounds.min - by, max: bounds.max + by }
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_scene::math::random::Random;

    /// Returns the depth below a node, after checking boxes and collecting the leaves.
    fn depth(nodes: &[Node], at: u32, within: Aabb, leaves: &mut Vec<u32>) -> u32 {
        let Node { min, first, max, count } = nodes[at as usize];
        let bounds = Aabb { min: min.into(), max: max.into() };
        assert!(within.contains(bounds.min) && within.contains(bounds.max));
        if count > 0 {
            leaves.extend(first..first + count);
            return 0;
        }
        1 + (0..2).map(|child| depth(nodes, first + child, bounds, leaves)).max().unwrap()
    }

    fn check(boxes: &[Aabb], leaf: usize) -> u32 {
        let mut nodes = vec![Node::default(); 3];
        let (root, order) = build(boxes, 100, leaf, &mut nodes);
        assert_eq!(root, 3);
        let all = boxes.iter().fold(Aabb::EMPTY, |all, b| all.union(*b));
        let mut leaves = Vec::new();
        let depth = depth(&nodes, root, all, &mut leaves);
        leaves.sort_unstable();
        assert_eq!(leaves, (100..100 + boxes.len() as u32).collect::<Vec<_>>());
        let mut sorted = order;
        sorted.sort_unstable();
        assert_eq!(sorted, (0..boxes.len() as u32).collect::<Vec<_>>());
        depth
    }

    #[test]
    fn every_box_is_in_one_leaf_of_a_shallow_tree() {
        let mut random = Random(3);
        let mut point = || Vec3::new(random.unit(), random.unit(), random.unit());
        for count in [1, 2, 3, 100, 5000] {
            let boxes: Vec<Aabb> = (0..count).map(|_| Aabb::around([point(), point()])).collect();
            assert!(check(&boxes, 1) < 40 && check(&boxes, 4) < 40);
        }
        // Equal boxes cannot be split by a plane, and distances that double defeat the heuristic.
        assert!(check(&vec![Aabb::around([Vec3::ZERO, Vec3::ONE]); 3000], 1) <= 12);
        let far = |i: i32| Vec3::splat(f32::from_bits(((127 + i - 60) as u32) << 23));
        let boxes: Vec<Aabb> = (0..120).map(|i| Aabb::around([far(i), far(i) * 1.5])).collect();
        assert!(check(&boxes, 1) < MAX_DEPTH);
        assert_eq!(build(&[], 0, 1, &mut Vec::new()), (NONE, Vec::new()));
    }
}
