//! Example of a material: alternating stripes of two materials.

use super::Pattern;
use crate::describe::{Constraint, described};
use crate::dialect::set;
use crate::math::Vec3;

described! {
    /// Alternating layers of two materials, perpendicular to the y axis.
    Stripes ["Stripes" in set::DURER] {
        /// Index of the material of even layers.
        material1: u32 = 0, required, Constraint::Any, ["materialIndex" in set::DURER];
        /// Index of the material of odd layers.
        material2: u32 = 0, required, Constraint::Any, ["materialIndex" in set::DURER];
        /// Height of a layer, in object units.
        height: f32 = 1.0, optional, Constraint::Positive, ["height" in set::DURER];
    }
}

impl Pattern for Stripes {
    fn weight(&self, q: Vec3) -> f32 {
        if (q.y / self.height).floor().rem_euclid(2.0) == 0.0 { 1.0 } else { 0.0 }
    }

    fn materials(&self) -> [u32; 2] {
        [self.material1, self.material2]
    }
}
