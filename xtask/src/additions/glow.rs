//! A point light without attenuation.

use super::{Emitter, Illumination};
use crate::describe::{FileName, Rule, described};
use crate::dialect::set;
use crate::math::{Color, Vec3};
use glam::DVec3;

described! {
    /// Point light without attenuation.
    GlowLight ["GlowLight" in set::DURER] {
        /// Position in world space.
        position: Vec3 = Vec3::ZERO, required, Rule::Any, ["position" in set::DURER];
        /// Colour times strength, linear RGB.
        color: Vec3 = Vec3::ONE, required, Rule::Any, ["color" in set::DURER];
        /// File with a measured spectrum, which `color` multiplies.
        spectrum: Option<FileName> = None, optional, Rule::Any, ["spectrum" in set::DURER];
    }
}

impl Emitter for GlowLight {
    fn illuminate(&self, point: DVec3) -> Illumination {
        let offset = (self.position.as_dvec3() - point).as_vec3();
        Illumination { to_light: offset.normalize_or(Vec3::Y), distance: offset.length(), color: self.color }
    }

    fn color(&self) -> Color {
        self.color
    }
}
