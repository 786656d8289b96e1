//! Point light. The light that arrives at distance d is color / (a0 + a1 d + a2 d^2).

use super::{Illuminate, LightLiSample, TWO_UNITS, with_luminance};
use crate::describe::{Constraint, FileName, described};
use crate::dialect::set;
use crate::math::{Color, Vec3};
use glam::DVec3;
use std::f32::consts::PI;

described! {
    /// Light that is emitted from one point in all directions.
    PointLight ["PointLight" in set::CLASSIC, "point" in set::F23] {
        /// Position.
        position: Vec3 = Vec3::ZERO, required, Constraint::Any, ["position" in set::CLASSIC];
        /// Colour and strength.
        color: Vec3 = Vec3::ONE, optional, Constraint::Any, ["color" in set::ALL];
        /// Coefficients of the distance polynomial that the light is divided by: constant, linear
        /// and quadratic.
        attenuation: Option<Vec3> = None, optional, Constraint::Any, ["attenuation" in set::OLD | set::DURER];
        /// Quadratic coefficient of the distance polynomial; the other coefficients depend on the
        /// dialect.
        falloff: Option<f32> = None, optional, Constraint::NonNegative,
            ["falloff" in set::F12A5 | set::F16 | set::DURER, "attenuation" in set::F23];
        /// Luminous intensity in candela, with falloff by the squared distance; `color` then sets
        /// only the hue.
        candela: Option<f32> = None, optional, Constraint::NonNegative, ["candela" in set::DURER];
        /// Luminous flux in lumens, with falloff by the squared distance; `color` then sets only
        /// the hue.
        lumens: Option<f32> = None, optional, Constraint::NonNegative, ["lumens" in set::DURER];
        /// Measured spectrum, multiplied by `color`: a file (`lamp.csv`, `lamps.csv:column`) or an
        /// illuminant (A, D65, F2, 2700K). `--color spectral` uses the spectrum; otherwise its RGB
        /// colour is used.
        spectrum: Option<FileName> = None, optional, Constraint::Any, ["spectrum" in set::DURER];
    }
}

impl Illuminate for PointLight {
    #[inline]
    fn illuminate(&self, point: DVec3) -> LightLiSample {
        let offset = (self.position.as_dvec3() - point).as_vec3();
        let distance = offset.length();
        let color = match self.attenuation {
            Some(a) => self.color / (a.x + a.y * distance + a.z * distance * distance),
            None => self.color,
        };
        let to_light = offset.normalize_or(Vec3::Y);
        LightLiSample { to_light, distance, color }
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
        let Some(candela) = self.candela.or(self.lumens.map(|lumens| lumens / (4.0 * PI))) else { return self.clone() };
        // The colour of a light is the radiance of a white diffuse surface, which is the
        // illuminance divided by pi.
        let color = with_luminance(self.color, candela / PI);
        PointLight { color, attenuation: Some(Vec3::Z), falloff: None, candela: None, lumens: None, ..self.clone() }
    }

    fn validate(&self) -> Result<(), String> {
        let unit = self.candela.or(self.lumens).is_some();
        match () {
            () if self.candela.is_some() && self.lumens.is_some() => Err(TWO_UNITS.into()),
            () if unit && (self.attenuation.is_some() || self.falloff.is_some()) => {
                Err("a light in `candela` or `lumens` falls off with the squared distance: remove `attenuation` and \
                     `falloff`"
                    .into())
            }
            () => Ok(()),
        }
    }

    fn inverse_square(&self) -> Option<(Vec3, Color)> {
        let squared = |a: &Vec3| a.y == 0.0 && a.z > 0.0;
        self.attenuation.filter(squared).map(|a| (self.position, self.color / a.z))
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
