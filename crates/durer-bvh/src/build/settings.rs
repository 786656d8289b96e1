//! Build quality, and the build settings for each quality.

use crate::node::{LEAF_SIZE, MAX_ITEMS};

/// Maximum number of bins.
pub const BINS: usize = 16;

/// Trade-off between the time to build a BVH and the time to trace rays through it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BuildQuality {
    /// For geometry that is rebuilt often.
    Fast,
    /// For most uses.
    #[default]
    Balanced,
    /// For many rays: triangles are split where that helps, and more time is spent on optimisation.
    Best,
}

impl BuildQuality {
    /// Pairs of name and quality, for every quality.
    pub const NAMES: [(&'static str, BuildQuality); 3] =
        [("fast", BuildQuality::Fast), ("balanced", BuildQuality::Balanced), ("best", BuildQuality::Best)];
}

/// Share of the total area that a reinsertion pass must save for another pass to follow.
pub const MIN_GAIN: f64 = 0.002;

/// Cost model and limits for building a BVH, derived from the [`BuildQuality`] and the kind of
/// primitive.
#[derive(Clone, Debug)]
pub struct BuildSettings {
    /// Cost of a leaf by its number of primitives, in units of a node test.
    pub leaf_cost: fn(usize) -> f32,
    /// Cost of memory, in node tests per ray, for a tree with as many nodes as primitives. It
    /// accounts for cache misses. A higher cost makes nodes fuller where this hardly adds any
    /// tests.
    pub memory_cost: f32,
    /// Maximum number of references that are put into one leaf of the binary tree if they are close
    /// to each other.
    pub compact_leaf_size: usize,
    /// Maximum number of bins for a number of references.
    pub bins: fn(usize) -> usize,
    /// Maximum number of primitives in a leaf.
    pub leaf_size: usize,
    /// Maximum number of reinsertion passes.
    pub reinsertions: usize,
    /// Number of references that splits may add, as a share of the number of triangles.
    pub max_added_share: f32,
}

impl BuildSettings {
    /// Settings for primitives whose test costs as much as several nodes.
    pub const PRIMITIVES: BuildSettings = BuildSettings {
        leaf_cost: |count| 2.0 * count as f32,
        // For 100,000 small primitives, this takes 0.64 of the memory, 1.01 of the tests, and 0.8
        // of the time.
        memory_cost: 2.0,
        compact_leaf_size: 1,
        bins: |_| BINS,
        leaf_size: 4,
        reinsertions: 2,
        max_added_share: 0.0,
    };

    /// Number of references that splits may add to `count`.
    pub fn max_added_references(&self, count: usize) -> usize {
        ((count as f32 * self.max_added_share) as usize).min(MAX_ITEMS - count)
    }

    /// Settings for blocks of triangles, each of which is a leaf.
    pub fn blocks(quality: BuildQuality) -> BuildSettings {
        let of_triangles = BuildSettings { max_added_share: 0.0, ..BuildSettings::triangles(quality) };
        BuildSettings { compact_leaf_size: 1, leaf_size: 1, ..of_triangles }
    }

    /// Settings for meshes whose leaves hold up to eight triangles, which are tested at once.
    pub fn triangles(quality: BuildQuality) -> BuildSettings {
        // All triangles of a leaf are tested at once.
        let leaf_cost = |count| 1.2 + 0.05 * count as f32;
        let most = LEAF_SIZE;
        let settings = BuildSettings {
            leaf_cost,
            memory_cost: 0.0,
            compact_leaf_size: most,
            leaf_size: most,
            ..BuildSettings::PRIMITIVES
        };
        match quality {
            BuildQuality::Fast => BuildSettings { bins: |count| 4 + count / 16, reinsertions: 0, ..settings },
            BuildQuality::Balanced => settings,
            BuildQuality::Best => {
                BuildSettings { compact_leaf_size: 3, reinsertions: 4, max_added_share: 0.5, ..settings }
            }
        }
    }
}
