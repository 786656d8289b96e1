//! Rings around the y axis: the first material weighs (sin(frequency r + amplitude N) + 1) / 2,
//! with r the distance from the axis.
//!
//! The course left the profile of the rings free; the official program's is steeper, and not known.

use super::{MAX_OCTAVES, Pattern};
use crate::describe::{Rule, described};
use crate::dialect::set;
use crate::math::{Vec3, noise};

described! {
    /// Two materials in rings around the y axis.
    Wood ["Wood" in set::OLD | set::DURER] {
        /// The material where the sine is 1.
        material1: u32 = 0, required, Rule::Any, ["materialIndex" in set::ALL];
        /// The material where the sine is -1.
        material2: u32 = 0, required, Rule::Any, ["materialIndex" in set::ALL];
        /// How many frequencies of noise are summed, each twice the one before.
        octaves: u32 = 0, required, Rule::AtMost(MAX_OCTAVES), ["octaves" in set::ALL];
        /// Rings per 2 pi along the radius.
        frequency: f32 = 1.0, required, Rule::Any, ["frequency" in set::ALL];
        /// How much noise bends the rings.
        amplitude: f32 = 1.0, required, Rule::Any, ["amplitude" in set::ALL];
    }
}

impl Pattern for Wood {
    fn weight(&self, q: Vec3) -> f32 {
        let radius = (q.x * q.x + q.z * q.z).sqrt();
        noise::veins(q, radius, self.frequency, self.amplitude, self.octaves)
    }

    fn materials(&self) -> [u32; 2] {
        [self.material1, self.material2]
    }
}
