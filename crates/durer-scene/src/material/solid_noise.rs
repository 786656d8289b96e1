//! Two materials mixed by noise: the first weighs N + 1/2, kept between 0 and 1.

use super::{MAX_OCTAVES, Pattern};
use crate::describe::{Rule, described};
use crate::dialect::set;
use crate::math::{Vec3, noise};

described! {
    /// Two materials mixed by noise.
    SolidNoise ["Noise" in set::OLD | set::DURER] {
        /// The material where noise is high.
        material1: u32 = 0, required, Rule::Any, ["materialIndex" in set::ALL];
        /// The material where noise is low.
        material2: u32 = 0, required, Rule::Any, ["materialIndex" in set::ALL];
        /// How many frequencies are summed, each twice the one before.
        octaves: u32 = 0, required, Rule::AtMost(MAX_OCTAVES), ["octaves" in set::ALL];
    }
}

impl Pattern for SolidNoise {
    fn weight(&self, q: Vec3) -> f32 {
        (noise::turbulence(q, self.octaves) + 0.5).clamp(0.0, 1.0)
    }

    fn materials(&self) -> [u32; 2] {
        [self.material1, self.material2]
    }
}
