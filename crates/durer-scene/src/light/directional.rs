//! A light at infinity.

use super::{Emitter, Illumination, as_bright};
use crate::describe::{FileName, Rule, described};
use crate::dialect::set;
use crate::math::{Color, Vec3};
use glam::DVec3;
use std::f32::consts::PI;

described! {
    /// Light that comes from one direction everywhere.
    DirectionalLight ["DirectionalLight" in set::CLASSIC, "directional" in set::F23] {
        /// Where the light goes; of any length.
        direction: Vec3 = Vec3::NEG_Y, required, Rule::NonZero, ["direction" in set::ALL];
        /// Its colour and strength.
        color: Vec3 = Vec3::ONE, required, Rule::Any, ["color" in set::ALL];
        /// Half the angle in which it is seen, in degrees, for soft shadows under a path tracer,
        /// which sees its disc: 0.27 for the sun.
        spread: Option<f32> = None, optional, Rule::NonNegative, ["spread" in set::DURER];
        /// Illuminance in lux of what faces it: how strong it is, of which `color` is the hue.
        lux: Option<f32> = None, optional, Rule::NonNegative, ["lux" in set::DURER];
        /// Its measured spectrum, which `color` multiplies: a file (`lamp.csv`, `lamps.csv:column`)
        /// or the name of an illuminant (A, D65, F2, 2700K). Under `--color spectral` it is carried
        /// as such, else as its colour.
        spectrum: Option<FileName> = None, optional, Rule::Any, ["spectrum" in set::DURER];
    }
}

impl Emitter for DirectionalLight {
    fn illuminate(&self, _point: DVec3) -> Illumination {
        let to_light = (-self.direction).normalize_or(Vec3::Y);
        Illumination { to_light, distance: f32::INFINITY, color: self.color }
    }

    fn in_units(&self) -> Self {
        let Some(lux) = self.lux else { return self.clone() };
        DirectionalLight { color: as_bright(self.color, lux / PI), lux: None, ..self.clone() }
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

    fn spread(&self) -> f32 {
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

    fn place(&self) -> Option<(Vec3, Color)> {
        None
    }

    fn profile(&self) -> Option<&FileName> {
        None
    }

    fn in_profile(&self, dir: Vec3) -> Vec3 {
        dir
    }
}
