//! Example of a light: a point light without attenuation.

use super::{Illuminate, LightLiSample};
use crate::describe::{FileName, Constraint, described};
use crate::dialect::set;
use crate::math::{Color, Vec3};
use glam::DVec3;

described! {
    /// Point light without attenuation.
    GlowLight ["GlowLight" in set::DURER] {
        /// Position in world space.
        position: Vec3 = Vec3::ZERO, required, Constraint::Any, ["position" in set::DURER];
        /// Colour times strength, linear RGB.
        color: Vec3 = Vec3::ONE, required, Constraint::Any, ["color" in set::DURER];
        /// File with a measured spectrum, which `color` multiplies.
        spectrum: Option<FileName> = None, optional, Constraint::Any, ["spectrum" in set::DURER];
    }
}

impl Illuminate for GlowLight {
    fn illuminate(&self, point: DVec3) -> LightLiSample {
        let offset = (self.position.as_dvec3() - point).as_vec3();
        LightLiSample { to_light: offset.normalize_or(Vec3::Y), distance: offset.length(), color: self.color }
    }

    fn color(&self) -> Color {
        self.color
    }

    fn color_mut(&mut self) -> &mut Color {
        &mut self.color
    }

    fn spectrum(&self) -> Option<&FileName> {
        self.spectrum.as_ref()
    }

    fn with_unit_color(&self) -> Self {
        self.clone()
    }

    fn validate(&self) -> Result<(), String> {
        Ok(())
    }

    fn position(&self) -> Option<Vec3> {
        Some(self.position)
    }

    fn direction(&self) -> Option<Vec3> {
        None
    }

    fn cone(&self) -> Option<f32> {
        None
    }

    fn inverse_square(&self) -> Option<(Vec3, Color)> {
        None
    }

    fn angular_radius(&self) -> f32 {
        0.0
    }

    fn profile(&self) -> Option<&FileName> {
        None
    }

    fn to_profile(&self, dir: Vec3) -> Vec3 {
        dir
    }
}
