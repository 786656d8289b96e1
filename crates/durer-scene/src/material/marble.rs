//! Marble pattern of veins, in which the share of the first material is (sin(frequency x +
//! amplitude N) + 1) / 2. N is noise.

use super::{MAX_OCTAVES, Pattern};
use crate::describe::{Constraint, described};
use crate::dialect::set;
use crate::math::{Vec3, noise};

described! {
    /// A marble pattern: two materials in veins across the x axis.
    Marble ["Marble" in set::OLD | set::DURER] {
        /// Material where the sine is 1.
        material1: u32 = 0, required, Constraint::Any, ["materialIndex" in set::ALL];
        /// Material where the sine is -1.
        material2: u32 = 0, required, Constraint::Any, ["materialIndex" in set::ALL];
        /// Number of noise octaves, each with twice the frequency of the previous one.
        octaves: u32 = 0, required, Constraint::AtMost(MAX_OCTAVES), ["octaves" in set::ALL];
        /// Number of veins per 2 pi along x.
        frequency: f32 = 1.0, required, Constraint::Any, ["frequency" in set::ALL];
        /// Strength of the noise that distorts the veins.
        amplitude: f32 = 1.0, required, Constraint::Any, ["amplitude" in set::ALL];
    }
}

impl Pattern for Marble {
    fn weight(&self, q: Vec3) -> f32 {
        noise::veins(q, q.x, self.frequency, self.amplitude, self.octaves)
    }

    fn materials(&self) -> [u32; 2] {
        [self.material1, self.material2]
    }
}
