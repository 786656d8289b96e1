//! Directional light, at infinity.

use super::{Illuminate, LightLiSample, with_luminance};
use crate::describe::{Constraint, FileName, described};
use crate::dialect::set;
use crate::math::{Color, Vec3};
use glam::DVec3;
use std::f32::consts::PI;

described! {
    /// Light that arrives from the same direction everywhere, like sunlight.
    DirectionalLight ["DirectionalLight" in set::CLASSIC, "directional" in set::F23] {
        /// Direction in which the light travels, of any length.
        direction: Vec3 = Vec3::NEG_Y, required, Constraint::NonZero, ["direction" in set::ALL];
        /// Colour and strength.
        color: Vec3 = Vec3::ONE, optional, Constraint::Any, ["color" in set::ALL];
        /// Angular radius in degrees, for soft shadows and a visible disc in path tracing; 0.27 for
        /// the sun.
        spread: Option<f32> = None, optional, Constraint::NonNegative, ["spread" in set::DURER];
        /// Illuminance in lux on a surface that faces the light; `color` then sets only the hue.
        lux: Option<f32> = None, optional, Constraint::NonNegative, ["lux" in set::DURER];
        /// Measured spectrum, multiplied by `color`: a file (`lamp.csv`, `lamps.csv:column`) or an
        /// illuminant (A, D65, F2, 2700K). `--color spectral` uses the spectrum; otherwise its RGB
        /// colour is used.
        spectrum: Option<FileName> = None, optional, Constraint::Any, ["spectrum" in set::DURER];
    }
}

impl Illuminate for DirectionalLight {
    fn illuminate(&self, _point: DVec3) -> LightLiSample {
        let to_light = (-self.direction).normalize_or(Vec3::Y);
        LightLiSample { to_light, distance: f32::INFINITY, color: self.color }
    }

    fn with_unit_color(&self) -> Self {
        let Some(lux) = self.lux else { return self.clone() };
        DirectionalLight { color: with_luminance(self.color, lux / PI), lux: None, ..self.clone() }
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

    fn angular_radius(&self) -> f32 {
        self.spread.unwrap_or(0.0)
    }

    fn validate(&self) -> Result<(), String> {
        Ok(())
    }

    fn position(&self) -> Option<Vec3> {
        None
    }

    fn direction(&self) -> Option<Vec3> {
        Some(self.direction)
    }

    fn cone(&self) -> Option<f32> {
        None
    }

    fn inverse_square(&self) -> Option<(Vec3, Color)> {
        None
    }

    fn profile(&self) -> Option<&FileName> {
        None
    }

    fn to_profile(&self, dir: Vec3) -> Vec3 {
        dir
    }
}
