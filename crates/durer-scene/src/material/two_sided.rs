//! Two-sided material, with one material on the front and another on the back.

use super::Pattern;
use crate::describe::{Constraint, described};
use crate::dialect::set;
use crate::math::Vec3;

described! {
    /// Surface with one material on its front, where the normal points, and another on its back.
    TwoSided ["TwoSided" in set::DURER] {
        /// Material of the front.
        material1: u32 = 0, required, Constraint::Any, ["materialIndex" in set::ALL];
        /// Material of the back.
        material2: u32 = 0, required, Constraint::Any, ["materialIndex" in set::ALL];
    }
}

impl Pattern for TwoSided {
    fn weight(&self, _: Vec3) -> f32 {
        1.0
    }

    fn materials(&self) -> [u32; 2] {
        [self.material1, self.material2]
    }
}
