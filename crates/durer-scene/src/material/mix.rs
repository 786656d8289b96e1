//! Mix of two materials in a constant or textured proportion.

use super::Pattern;
use crate::describe::{Constraint, FileName, described};
use crate::dialect::set;
use crate::math::Vec3;

described! {
    /// Mix of two materials in a proportion that is constant or set by a texture.
    Mix ["Mix" in set::DURER] {
        /// First material.
        material1: u32 = 0, required, Constraint::Any, ["materialIndex" in set::ALL];
        /// Second material.
        material2: u32 = 0, required, Constraint::Any, ["materialIndex" in set::ALL];
        /// Share of the first material, from 0 to 1.
        share: f32 = 0.5, optional, Constraint::UnitInterval, ["share" in set::DURER];
        /// Texture that multiplies `share`.
        share_texture: Option<FileName> = None, optional, Constraint::Any, ["shareTexture" in set::DURER];
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
