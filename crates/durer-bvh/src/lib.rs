//! Ray queries on triangles and boxes, with bounding volume hierarchies and a uniform grid.
//!
//! [`Bvh`] and [`Grid`] store only the bounding boxes and numbers of primitives. The caller passes
//! a closure that intersects the primitives. The closure may be called for a primitive that the ray
//! misses, but no primitive that the ray hits is skipped, so both structures find the same hit.
//! [`TriangleBvh`] also stores the triangles.
#![doc = include_str!("../README.md")]

mod build;
mod bvh;
mod error;
mod grid;
mod instances;
mod lanes;
pub mod math;
mod node;
mod parallel;
mod primitive_packs;
mod traverse;
mod tree_boxes;
mod triangles;
pub mod watertight;

pub use build::BuildQuality;
pub use bvh::Bvh;
pub use error::{BuildError, LoadError};
pub use glam;
pub use grid::Grid;
pub use instances::{Instance, InstanceBvh, InstanceHit};
pub use lanes::{SimdLevel, UnsupportedSimdLevel};
pub use primitive_packs::{PackHit, PrimitivePacks};
pub use tree_boxes::TreeBox;
pub use triangles::{Facing, HeightGrid, NearestPoint, TriangleBvh, TriangleHit};

/// Counts rays, visited nodes, and primitive tests. A counter is passed to queries. `()` counts
/// nothing and costs nothing.
pub trait TraversalCounter {
    /// True if nodes and tests are counted. If false, the trees use code without counters.
    const COUNTS_WORK: bool;

    /// Counts one ray.
    fn ray(&mut self) {}

    /// Counts visited nodes or cells, and primitives that were tested against the ray.
    fn count_work(&mut self, _nodes: u64, _tests: u64) {}
}

impl TraversalCounter for () {
    const COUNTS_WORK: bool = false;
}

impl<T: TraversalCounter> TraversalCounter for &mut T {
    const COUNTS_WORK: bool = T::COUNTS_WORK;

    fn ray(&mut self) {
        (**self).ray();
    }
    fn count_work(&mut self, nodes: u64, tests: u64) {
        (**self).count_work(nodes, tests);
    }
}

/// A [`TraversalCounter`] that counts only rays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RayCount(pub u64);

impl TraversalCounter for RayCount {
    const COUNTS_WORK: bool = false;

    fn ray(&mut self) {
        self.0 += 1;
    }
}

/// A [`TraversalCounter`] that counts rays, visited nodes or cells, and primitive tests.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TraversalStats {
    /// Rays traced.
    pub rays: u64,
    /// Number of visited nodes or cells.
    pub nodes: u64,
    /// Number of primitives that were tested against a ray.
    pub primitive_tests: u64,
}

impl TraversalCounter for TraversalStats {
    const COUNTS_WORK: bool = true;

    fn ray(&mut self) {
        self.rays += 1;
    }
    fn count_work(&mut self, nodes: u64, tests: u64) {
        self.nodes += nodes;
        self.primitive_tests += tests;
    }
}

/// Items that the other crates of the workspace use. They may change in any version.
#[doc(hidden)]
pub mod internal {
    pub use crate::lanes::{PlainKernel, prefetch, run_plain, vec_on_large_pages};
    pub use crate::math::random;
    pub use crate::traverse::is_valid;
}

#[cfg(test)]
mod tests;
