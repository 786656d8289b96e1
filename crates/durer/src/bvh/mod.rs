//! Acceleration structures: which things a ray may meet, found without asking them all.
//!
//! They know boxes and numbers of things only; what a thing is, the caller's closure knows. A structure may
//! offer a thing that the ray misses, never withhold one that it meets; so all of them find the same hit.

mod build;
mod grid;
mod traverse;

pub use grid::Grid;
pub(crate) use traverse::is_sound;

use crate::math::Aabb;
use glam::Vec4;

/// Counts the work of rays. `()` counts nothing, at no cost.
pub trait Tally {
    /// A ray was traced.
    fn ray(&mut self);
    /// A node or cell was looked into.
    fn node(&mut self);
    /// A thing was tested against the ray.
    fn test(&mut self);
}

impl Tally for () {
    fn ray(&mut self) {}
    fn node(&mut self) {}
    fn test(&mut self) {}
}

/// Counts rays alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rays(pub u64);

impl Tally for Rays {
    fn ray(&mut self) {
        self.0 += 1;
    }
    fn node(&mut self) {}
    fn test(&mut self) {}
}

/// Numbers of rays traced, nodes visited and things tested.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Rays traced.
    pub rays: u64,
    /// Nodes or cells looked into.
    pub nodes: u64,
    /// Things tested against the ray.
    pub tests: u64,
}

impl Tally for Counts {
    fn ray(&mut self) {
        self.rays += 1;
    }
    fn node(&mut self) {
        self.nodes += 1;
    }
    fn test(&mut self) {
        self.tests += 1;
    }
}

/// How wide a node is.
const WIDTH: usize = 4;
/// Leaves hold at most this many things.
const LEAF_SIZE: usize = 4;

/// Boxes of up to four children, side by side.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
struct Node {
    min: [Vec4; 3],
    max: [Vec4; 3],
    /// An inner child's node number; a leaf's first item and, shifted above bit 28, item count; or [`EMPTY`].
    children: [u32; WIDTH],
}

const LEAF_BIT: u32 = 1 << 31;
const COUNT_SHIFT: u32 = 28;
const FIRST_MASK: u32 = (1 << COUNT_SHIFT) - 1;
const EMPTY: u32 = u32::MAX;

/// A bounding volume hierarchy of four-wide nodes over numbered things.
#[derive(Clone, Debug)]
pub struct Bvh {
    nodes: Vec<Node>,
    /// Numbers of the things, in the order of the leaves.
    order: Vec<u32>,
    bounds: Aabb,
}

impl Bvh {
    /// Builds over the boxes of things 0, 1, 2, ...; empty boxes are left out. At most 2^28 things.
    ///
    /// The result is a function of the boxes alone: the same for any number of threads.
    pub fn build(boxes: &[Aabb]) -> Self {
        build::build(boxes)
    }

    /// The box around everything.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Numbers of the things in the order in which [`Bvh::walk`] knows them.
    pub fn order(&self) -> &[u32] {
        &self.order
    }

    /// Bytes in memory.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.nodes) + size_of_val(&*self.order)
    }
}

#[cfg(test)]
mod tests;
