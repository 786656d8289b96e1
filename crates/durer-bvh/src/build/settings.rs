//! Build quality, and the build settings for each quality.

use crate::node::{LEAF_SIZE, MAX_ITEMS};

/// Largest allowed number of bins.
pub const BINS: usize = 16;

/// Trade-off between the time to build a BVH and the time to trace rays through it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BuildQuality {
    /// Suitable for geometry that is rebuilt often.
    Fast,
    /// Suitable for most uses.
    #[default]
    Balanced,
    /// Suitable for tracing many rays: triangles are split where that helps, and optimisation takes
    /// more time.
    Best,
}

impl BuildQuality {
    /// Names and values of all qualities.
    pub const NAMES: [(&'static str, BuildQuality); 3] =
        [("fast", BuildQuality::Fast), ("balanced", BuildQuality::Balanced), ("best", BuildQuality::Best)];
}

/// Fraction of the total area that a reinsertion pass must save in order for another pass to
/// follow.
pub const MIN_GAIN: f64 = 0.002;

/// Cost model and limits for building a BVH, derived from the [`BuildQuality`] and the kind of
/// primitive.
#[derive(Clone, Debug)]
pub struct BuildSettings {
    /// Cost of a leaf, indexed by its number of primitives, in units of a node test.
    pub leaf_cost: fn(usize) -> f32,
    /// Cost of memory, in node tests per ray, for a tree that has as many nodes as primitives. It
    /// accounts for cache misses. A higher cost makes nodes fuller where this adds hardly any
    /// tests.
    pub memory_cost: f32,
    /// Maximum number of references that may be in one leaf of the binary tree if they are close to
    /// each other.
    pub compact_leaf_size: usize,
    /// Returns the maximum number of bins for a number of references.
    pub bins: fn(usize) -> usize,
    /// Maximum number of primitives in a leaf.
    pub leaf_size: usize,
    /// Maximum number of reinsertion passes.
    pub reinsertions: usize,
    /// Maximum number of references that splits may add, as a fraction of the number of triangles.
    pub max_added_share: f32,
}

impl BuildSettings {
    /// Settings for primitives whose test costs as much as the tests of several nodes.
    pub const PRIMITIVES: BuildSettings = BuildSettings {
        leaf_cost: |count| 2.0 * count as f32,
        // For 100,000 small primitives, these settings need 0.64 times the memory, 1.01 times the
        // tests, and 0.8 times the time.
        memory_cost: 2.0,
        compact_leaf_size: 1,
        bins: |_| BINS,
        leaf_size: 4,
        reinsertions: 2,
        max_added_share: 0.0,
    };

    /// Returns the number of references that splits may add to `count` references.
    pub fn max_added_references(&self, count: usize) -> usize {
        ((count as f32 * self.max_added_share) as usize).min(MAX_ITEMS - count)
    }

    /// Returns settings for blocks of triangles, each of which is a leaf.
    pub fn blocks(quality: BuildQuality) -> BuildSettings {
        let of_triangles = BuildSettings { max_added_share: 0.0, ..BuildSettings::triangles(quality) };
        BuildSettings { compact_leaf_size: 1, leaf_size: 1, ..of_triangles }
    }

    /// Returns settings for meshes whose leaves hold up to eight triangles, which are tested at
    /// once.
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
