//! How much work goes into a tree, and what that means for each step.

use crate::node::{LEAF_SIZE, MAX_ITEMS};

/// References are put into so many bins, at most.
pub const BINS: usize = 16;

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
pub const MIN_GAIN: f64 = 0.002;

/// What a tree is to be good for.
#[derive(Clone, Debug)]
pub struct BuildSettings {
    /// Cost of a leaf of so many things, in tests of a node.
    pub leaf_cost: fn(usize) -> f32,
    /// What nodes cost as memory, which may be far away: of as many nodes as things, in tests of a
    /// node by each ray. So nodes are fuller where that takes hardly more tests.
    pub memory_cost: f32,
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
        // 100,000 small things: 0.64 of the memory, 1.01 of the tests, 0.8 of the time.
        memory_cost: 2.0,
        whole: 1,
        bins: |_| BINS,
        leaf_size: 4,
        reinsertions: 2,
        splits: 0.0,
    };

    /// How many references cuts may add to so many.
    pub fn spare(&self, count: usize) -> usize {
        ((count as f32 * self.splits) as usize).min(MAX_ITEMS - count)
    }

    /// For blocks of triangles, each of which is a leaf.
    pub fn blocks(quality: BuildQuality) -> BuildSettings {
        let of_triangles = BuildSettings { splits: 0.0, ..BuildSettings::triangles(quality) };
        BuildSettings { whole: 1, leaf_size: 1, ..of_triangles }
    }

    pub fn triangles(quality: BuildQuality) -> BuildSettings {
        // A leaf is tested at once, whatever it holds.
        let leaf_cost = |count| 1.2 + 0.05 * count as f32;
        let most = LEAF_SIZE;
        let settings =
            BuildSettings { leaf_cost, memory_cost: 0.0, whole: most, leaf_size: most, ..BuildSettings::THINGS };
        match quality {
            BuildQuality::Fast => BuildSettings { bins: |count| 4 + count / 16, reinsertions: 0, ..settings },
            BuildQuality::Balanced => settings,
            BuildQuality::Best => BuildSettings { whole: 3, reinsertions: 4, splits: 0.5, ..settings },
        }
    }
}
