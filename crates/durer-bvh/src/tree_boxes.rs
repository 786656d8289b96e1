//! Bounding boxes of all nodes and leaves of a tree, for drawing.

use super::node::{self, LEAF, WideNode};
use crate::math::Aabb;
use std::collections::VecDeque;
use std::ops::Range;

/// Bounding box of a node or leaf of a [`Bvh`](super::Bvh), with its depth. It is meant for
/// drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct TreeBox {
    /// Bounding box of its subtree.
    pub bounds: Aabb,
    /// Depth in the tree. The root's box has depth 0.
    pub level: u32,
    /// Positions of a leaf's primitives in leaf order. The range is empty for an inner node.
    pub items: Range<usize>,
}

/// Returns the boxes of a tree with the codes of their nodes and leaves, level by level.
pub(super) fn boxes(nodes: &[WideNode]) -> impl Iterator<Item = (u32, TreeBox)> {
    let root = TreeBox { bounds: node::bounds(nodes), level: 0, items: 0..0 };
    let mut waiting: VecDeque<(u32, TreeBox)> = (!nodes.is_empty()).then_some((0, root)).into_iter().collect();
    std::iter::from_fn(move || {
        let (code, found) = waiting.pop_front()?;
        let children = (code & LEAF == 0).then(|| nodes[node::node_index(code)].children()).into_iter().flatten();
        waiting.extend(children.map(|(_, bounds, child)| {
            let (first, count) = if child & LEAF == 0 { (0, 0) } else { node::items(child) };
            (child, TreeBox { bounds, level: found.level + 1, items: first..first + count })
        }));
        Some((code, found))
    })
}

#[cfg(test)]
mod tests {
    use crate::math::random::Random;
    use crate::math::{Aabb, Ray, Vec3};
    use crate::{Bvh, TraversalStats};

    fn scattered(count: usize) -> Vec<Aabb> {
        let mut random = Random(3);
        let mut place = || Vec3::from([(); 3].map(|()| 10.0 * random.unit() - 5.0));
        (0..count).map(|_| place()).map(|min| Aabb { min, max: min + 0.3 }).collect()
    }

    #[test]
    fn boxes_hold_all_primitives_and_lie_within_their_parents() {
        for count in [0, 1, 7, 300] {
            let boxes = scattered(count);
            let tree = Bvh::build(&boxes);
            let shown: Vec<_> = tree.boxes().collect();
            assert_eq!(shown.iter().map(|found| found.items.len()).sum::<usize>(), count);
            assert!(shown.windows(2).all(|pair| pair[0].level <= pair[1].level));
            for found in &shown {
                for item in found.items.clone() {
                    let inside = boxes[tree.primitive_indices()[item] as usize];
                    assert_eq!(found.bounds.union(inside), found.bounds);
                }
                assert_eq!(tree.bounds().union(found.bounds), tree.bounds());
            }
        }
    }

    #[test]
    fn visits_are_those_of_the_traversal() {
        let boxes = scattered(300);
        let tree = Bvh::build(&boxes);
        for turn in 0..20 {
            let ray = Ray::new(Vec3::new(-9.0, 0.1, 0.2), Vec3::new(1.0, 0.05 * turn as f32 - 0.5, 0.1));
            let (mut tested, mut seen, mut counts) = (Vec::new(), Vec::new(), TraversalStats::default());
            let enter = |item: usize| boxes[tree.primitive_indices()[item] as usize].clip(ray.origin, ray.dir);
            tree.traverse(&ray, &mut counts, |item, t_max, _| {
                tested.push(item);
                enter(item).map_or(t_max, |(t, _)| t.max(0.0).min(t_max))
            });
            let visits = tree.visits(&ray, |item, t_max| {
                seen.push(item);
                enter(item).map_or(t_max, |(t, _)| t.max(0.0).min(t_max))
            });
            assert_eq!(tested, seen);
            assert_eq!(visits.iter().flat_map(|visit| visit.items.clone()).collect::<Vec<_>>(), seen);
            assert_eq!(visits.iter().filter(|visit| visit.items.is_empty()).count() as u64, counts.nodes);
        }
    }
}
