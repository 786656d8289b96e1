//! Two materials mixed by noise. The share of the first material is N + 1/2, clamped to [0, 1].

use super::{MAX_OCTAVES, Pattern};
use crate::describe::{Constraint, described};
use crate::dialect::set;
use crate::math::{Vec3, noise};

described! {
    /// A mix of two materials by a noise function.
    SolidNoise ["Noise" in set::OLD | set::DURER] {
        /// Material where the noise is high.
        material1: u32 = 0, required, Constraint::Any, ["materialIndex" in set::ALL];
        /// Material where the noise is low.
        material2: u32 = 0, required, Constraint::Any, ["materialIndex" in set::ALL];
        /// Number of noise octaves, each with twice the frequency of the previous one.
        octaves: u32 = 0, required, Constraint::AtMost(MAX_OCTAVES), ["octaves" in set::ALL];
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
