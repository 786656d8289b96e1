//! Cubes of two materials in turn.

use super::Pattern;
use crate::describe::{Rule, described};
use crate::dialect::set;
use crate::math::Vec3;

described! {
    /// Unit cubes of two materials in turn.
    Checkerboard ["Checkerboard" in set::OLD | set::DURER] {
        /// The material where the sum of the rounded-down coordinates is even.
        material1: u32 = 0, required, Rule::Any, ["materialIndex" in set::ALL];
        /// The other.
        material2: u32 = 0, required, Rule::Any, ["materialIndex" in set::ALL];
    }
}

impl Pattern for Checkerboard {
    fn weight(&self, q: Vec3) -> f32 {
        let floor = q.floor();
        // Sums and remainders of whole f32 numbers are exact as long as the cells can be told
        // apart.
        let even = floor.rem_euclid(Vec3::splat(2.0)).element_sum().rem_euclid(2.0) == 0.0;
        if even { 1.0 } else { 0.0 }
    }

    fn materials(&self) -> [u32; 2] {
        [self.material1, self.material2]
    }
}
