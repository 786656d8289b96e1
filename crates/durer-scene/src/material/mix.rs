//! Two materials in one proportion, or as a picture says.

use super::Pattern;
use crate::describe::{FileName, Rule, described};
use crate::dialect::set;
use crate::math::Vec3;

described! {
    /// Two materials in the same proportion everywhere, or as a picture says: each scatters its
    /// share of the light.
    Mix ["Mix" in set::DURER] {
        /// The first material.
        material1: u32 = 0, required, Rule::Any, ["materialIndex" in set::ALL];
        /// The other.
        material2: u32 = 0, required, Rule::Any, ["materialIndex" in set::ALL];
        /// The share of the first, from 0 to 1.
        share: f32 = 0.5, optional, Rule::Share, ["share" in set::DURER];
        /// A picture that multiplies `share`.
        share_texture: Option<FileName> = None, optional, Rule::Any, ["shareTexture" in set::DURER];
    }
}

impl Pattern for Mix {
    fn weight(&self, _: Vec3) -> f32 {
        self.share
    }

    fn materials(&self) -> [u32; 2] {
        [self.material1, self.material2]
    }
}
