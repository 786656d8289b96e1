//! Checkerboard pattern of unit cubes with two alternating materials.

use super::Pattern;
use crate::describe::{Constraint, described};
use crate::dialect::set;
use crate::math::Vec3;

described! {
    /// A 3D checkerboard: unit cubes that alternate between two materials.
    Checkerboard ["Checkerboard" in set::OLD | set::DURER] {
        /// Material of the cubes whose integer coordinates have an even sum.
        material1: u32 = 0, required, Constraint::Any, ["materialIndex" in set::ALL];
        /// Material of the other cubes.
        material2: u32 = 0, required, Constraint::Any, ["materialIndex" in set::ALL];
    }
}

impl Pattern for Checkerboard {
    fn weight(&self, q: Vec3) -> f32 {
        let floor = q.floor();
        // Sums and remainders of integers in `f32` are exact as long as the coordinates are small
        // enough to distinguish cells.
        let even = floor.rem_euclid(Vec3::splat(2.0)).element_sum().rem_euclid(2.0) == 0.0;
        if even { 1.0 } else { 0.0 }
    }

    fn materials(&self) -> [u32; 2] {
        [self.material1, self.material2]
    }
}
