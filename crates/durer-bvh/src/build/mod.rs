//! Building a tree: references to things, a binary tree over them, and eight-wide nodes from that.

mod binary;
mod cut;
mod reinsert;
mod spatial;
mod wide;

use super::lanes::listed;
use super::node::{MAX_ITEMS, WideNode};
use crate::math::{Aabb, Vec3};
use crate::parallel;
use glam::Vec4;
use reinsert::Linked;
use wide::CollapsePlan;

/// How much work goes into a tree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BuildQuality {
    /// For things that are built anew often.
    Fast,
    /// For most uses.
    #[default]
    Balanced,
    /// For many rays: triangles are cut where that helps, and the tree is improved for longer.
    Best,
}

impl BuildQuality {
    /// Every quality, with its name.
    pub const NAMES: [(&'static str, BuildQuality); 3] =
        [("fast", BuildQuality::Fast), ("balanced", BuildQuality::Balanced), ("best", BuildQuality::Best)];
}

/// No more subtrees are moved after a pass that spares less than this share of all boxes' areas.
const MIN_GAIN: f64 = 0.002;

/// What is better for two children may be worse for eight, most of all where things were cut. After
/// so many passes this can be told.
const TRUSTED_PASSES: usize = 2;

/// What a tree is to be good for.
#[derive(Clone, Debug)]
pub(super) struct BuildSettings {
    /// Cost of a leaf of so many things, in tests of a node.
    pub leaf_cost: fn(usize) -> f32,
    /// So few things stay together where they are near each other.
    pub whole: usize,
    /// How many bins so many things are put into, at most.
    pub bins: fn(usize) -> usize,
    /// Leaves hold at most so many things.
    pub leaf_size: usize,
    /// At most so many passes move subtrees to better places.
    pub reinsertions: usize,
    /// How many references may be added by cutting triangles, as a share of them.
    pub splits: f32,
}

impl BuildSettings {
    /// For things whose tests cost as much as several nodes.
    pub const THINGS: BuildSettings = BuildSettings {
        leaf_cost: |count| 2.0 * count as f32,
        whole: 1,
        bins: |_| cut::BINS,
        leaf_size: 4,
        reinsertions: 2,
        splits: 0.0,
    };

    /// How many references cuts may add to so many.
    fn spare(&self, count: usize) -> usize {
        ((count as f32 * self.splits) as usize).min(MAX_ITEMS - count)
    }

    pub fn triangles(quality: BuildQuality) -> BuildSettings {
        // A leaf is tested at once, whatever it holds.
        let leaf_cost = |count| 1.2 + 0.05 * count as f32;
        let most = super::node::LEAF_SIZE;
        let settings = BuildSettings { leaf_cost, whole: most, leaf_size: most, ..BuildSettings::THINGS };
        match quality {
            BuildQuality::Fast => BuildSettings { bins: |count| 4 + count / 16, reinsertions: 0, ..settings },
            BuildQuality::Balanced => settings,
            BuildQuality::Best => BuildSettings { whole: 3, reinsertions: 4, splits: 0.5, ..settings },
        }
    }
}

/// A box of a thing or of a part of it, and the thing's number.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reference {
    min: Vec4,
    max: Vec4,
}

impl Reference {
    fn new(bounds: Aabb, number: u32) -> Self {
        Reference { min: bounds.min.extend(lane(3, number)), max: bounds.max.extend(0.0) }
    }

    fn number(&self) -> u32 {
        lane_number(self.min.w)
    }

    fn bounds(&self) -> Aabb {
        Aabb { min: self.min.truncate(), max: self.max.truncate() }
    }

    /// Twice the centre.
    #[inline]
    fn middle(&self) -> Vec4 {
        self.min + self.max
    }
}

/// A number below 2^28 and a tag of 2 or 3 in the fourth lane of a vector: as a normal `f32`, which
/// no arithmetic on the lane slows down.
fn lane(tag: u32, number: u32) -> f32 {
    f32::from_bits(number | tag << 28)
}

fn lane_number(lane: f32) -> u32 {
    lane.to_bits() & !(3 << 28)
}

/// References to boxes 0, 1, 2, ... but for the empty ones.
pub(super) fn references(boxes: &[Aabb]) -> Vec<Reference> {
    assert!(boxes.len() <= MAX_ITEMS, "a tree holds less than 2^28 things");
    let full = boxes.iter().enumerate().filter(|(_, b)| !b.is_empty());
    full.map(|(i, b)| Reference::new(*b, i as u32)).collect()
}

/// Whether a triangle can be hit.
pub(super) fn is_finite(corners: &[Vec3; 3]) -> bool {
    corners.iter().all(|p| p.is_finite())
}

/// References to triangles 0, 1, 2, ..., with room for those that cuts add; those with corners that
/// are no finite points are left out.
fn triangle_references(
    count: usize,
    settings: &BuildSettings,
    corners_of: &(impl Fn(u32) -> [Vec3; 3] + Sync),
) -> Vec<Reference> {
    let mut references = listed(count, settings.spare(count), |i| {
        let corners = corners_of(i as u32);
        Reference::new(if is_finite(&corners) { Aabb::around(corners) } else { Aabb::EMPTY }, i as u32)
    });
    if parallel::any(&references, 4096, |r| r.min.x > r.max.x) {
        references.retain(|r| r.min.x <= r.max.x);
    }
    references
}

/// A finished tree.
pub(super) struct Tree {
    pub nodes: Vec<WideNode>,
    /// Numbers of things by place.
    pub order: Vec<u32>,
    pub bounds: Aabb,
}

/// Builds a tree over boxes: a function of the references and settings alone.
pub(super) fn build(references: Vec<Reference>, settings: &BuildSettings) -> Tree {
    build_of(references, settings, Vec::new())
}

/// Builds a tree over so many triangles, which may be cut.
pub(super) fn build_triangles(
    count: usize,
    corners_of: &(impl Fn(u32) -> [Vec3; 3] + Sync),
    settings: &BuildSettings,
) -> Tree {
    assert!(count <= MAX_ITEMS, "a tree holds less than 2^28 triangles");
    if settings.splits == 0.0 {
        return build_of(triangle_references(count, settings, corners_of), settings, Vec::new());
    }
    // Whoever looks for planes asks for the same corners at many levels.
    let corners = listed(count, 0, |i| corners_of(i as u32));
    build_of(triangle_references(count, settings, &|i| corners[i as usize]), settings, corners)
}

fn build_of(references: Vec<Reference>, settings: &BuildSettings, corners: Vec<[Vec3; 3]>) -> Tree {
    if references.is_empty() {
        return Tree { nodes: Vec::new(), order: Vec::new(), bounds: Aabb::EMPTY };
    }
    let mut tree = binary::build(references, settings, &corners);
    drop(corners);
    let bounds = tree.nodes[0].bounds();
    let plans = improved(&mut tree, settings);
    let (nodes, order) = wide::collapse(&tree, plans);
    Tree { nodes, order, bounds }
}

/// Has a tree's subtrees moved to better places, as long as that pays; gives what is then cheapest
/// for each node.
fn improved(tree: &mut binary::Tree, settings: &BuildSettings) -> CollapsePlan {
    let mut plans = CollapsePlan::new(&tree.nodes, tree.scale, settings);
    // With fewer nodes all are the root and its children, which stay.
    if settings.reinsertions == 0 || tree.nodes.len() < 5 {
        return plans;
    }
    let mut work = Linked::new(tree);
    for pass in 1..=settings.reinsertions {
        // Also where areas are no numbers nothing more is tried.
        let goes_on = work.pass() >= MIN_GAIN && pass < settings.reinsertions;
        if !goes_on || pass == TRUSTED_PASSES && tree.is_cut {
            let Some(nodes) = work.in_order() else { break };
            let others = CollapsePlan::new(&nodes, tree.scale, settings);
            // At equal cost fewer triangles are tested.
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

/// A power of two that brings sizes near 1, so that areas neither overflow nor vanish.
fn area_scale(bounds: Aabb) -> f32 {
    let size = (bounds.max * 0.5 - bounds.min * 0.5).max_element();
    let exponent = size.to_bits() >> 23 & 0xff;
    // 2^-e for a size of about 2^e, itself kept in range.
    f32::from_bits((254 - exponent.clamp(1, 253)) << 23)
}
