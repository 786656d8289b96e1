//! Builds trees: references to primitives, a binary tree over them, and eight-wide nodes made from
//! the binary tree.

mod binary;
mod builder;
mod object_split;
mod reference;
mod reinsert;
mod settings;
mod spatial_split;
mod wide;

use crate::lanes::parallel_vec;
use crate::math::{Aabb, Vec3};
use crate::node::{MAX_ITEMS, WideNode};
use reference::{Reference, triangle_references};
pub(crate) use reference::{is_finite, references};
use reinsert::LinkedTree;
pub use settings::BuildQuality;
pub(crate) use settings::BuildSettings;
use settings::MIN_GAIN;
use wide::CollapsePlan;

/// Number of reinsertion passes after which a tree with split triangles is compared with the best
/// tree so far. A better binary tree can still give a worse wide tree, especially after splits.
const UNCHECKED_PASSES: usize = 2;

/// A finished tree with eight children per node, from which [`Bvh`](super::Bvh) and
/// [`TriangleBvh`](super::TriangleBvh) are made.
pub(super) struct Tree {
    pub nodes: Vec<WideNode>,
    /// Primitive numbers, in the order in which the leaves refer to them.
    pub order: Vec<u32>,
    pub bounds: Aabb,
}

/// Builds a tree over boxes. The result depends only on the references and settings.
pub(super) fn build(references: Vec<Reference>, settings: &BuildSettings) -> Tree {
    build_of(references, settings, Vec::new())
}

/// Builds a tree over `count` triangles, which may be split.
pub(super) fn build_triangles(
    count: usize,
    corners_of: &(impl Fn(u32) -> [Vec3; 3] + Sync),
    settings: &BuildSettings,
) -> Tree {
    assert!(count <= MAX_ITEMS, "a tree holds fewer than 2^28 triangles");
    if settings.max_added_share == 0.0 {
        return build_of(triangle_references(count, settings, corners_of), settings, Vec::new());
    }
    // The search for split planes needs the same corners at many levels.
    let corners = parallel_vec(count, 0, |i| corners_of(i as u32));
    build_of(triangle_references(count, settings, &|i| corners[i as usize]), settings, corners)
}

fn build_of(references: Vec<Reference>, settings: &BuildSettings, corners: Vec<[Vec3; 3]>) -> Tree {
    if references.is_empty() {
        return Tree { nodes: Vec::new(), order: Vec::new(), bounds: Aabb::EMPTY };
    }
    let (mut tree, references) = binary::build(references, settings, &corners);
    drop(corners);
    let numbers = parallel_vec(references.len(), 0, |i| references[i].number());
    drop(references);
    let bounds = tree.nodes[0].bounds();
    let plans = improved(&mut tree, settings);
    let (nodes, order) = wide::collapse(&tree, &numbers, plans);
    Tree { nodes, order, bounds }
}

/// Improves a tree by reinsertion as long as the improvement is worth the time, and returns the
/// best collapse plan.
fn improved(tree: &mut binary::BinaryTree, settings: &BuildSettings) -> CollapsePlan {
    let mut plans = CollapsePlan::new(&tree.nodes, tree.scale, settings);
    // With fewer than five nodes, there are no nodes below the root's children to move.
    if settings.reinsertions == 0 || tree.nodes.len() < 5 {
        return plans;
    }
    let mut work = LinkedTree::new(tree);
    for pass in 1..=settings.reinsertions {
        // This condition also stops the loop if areas are NaN.
        let goes_on = work.pass() >= MIN_GAIN && pass < settings.reinsertions;
        if !goes_on || pass == UNCHECKED_PASSES && tree.has_splits {
            let Some(nodes) = work.in_order() else { break };
            let others = CollapsePlan::new(&nodes, tree.scale, settings);
            // If two trees have equal costs, fewer triangle tests are better.
            if others.cost <= 1.01 * plans.cost {
                (tree.nodes, plans) = (nodes, others);
            } else {
                break;
            }
        }
        if !goes_on {
            break;
        }
    }
    plans
}
