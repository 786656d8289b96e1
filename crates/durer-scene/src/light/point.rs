//! A light at a point. What arrives at distance d is color / (a0 + a1 d + a2 d^2).

use super::{Emitter, Illumination, TWO_UNITS, as_bright};
use crate::describe::{FileName, Rule, described};
use crate::dialect::set;
use crate::math::{Color, Vec3};
use glam::DVec3;
use std::f32::consts::PI;

described! {
    /// Light that comes from one point.
    PointLight ["PointLight" in set::CLASSIC, "point" in set::F23] {
        /// Where it is.
        position: Vec3 = Vec3::ZERO, required, Rule::Any, ["position" in set::CLASSIC];
        /// Its colour and strength.
        color: Vec3 = Vec3::ONE, required, Rule::Any, ["color" in set::ALL];
        /// How it fades: the divisor's constant, its factor of distance and its factor of distance
        /// squared.
        attenuation: Option<Vec3> = None, optional, Rule::Any, ["attenuation" in set::OLD | set::DURER];
        /// How it fades: the divisor's factor of distance squared; what is added to it depends on
        /// the dialect.
        falloff: Option<f32> = None, optional, Rule::NonNegative,
            ["falloff" in set::F12A5 | set::F16 | set::DURER, "attenuation" in set::F23];
        /// Luminous intensity in candela: how strong it is, of which `color` is the hue; it fades with
        /// the square of the distance.
        candela: Option<f32> = None, optional, Rule::NonNegative, ["candela" in set::DURER];
        /// The same by its luminous flux in lumen.
        lumens: Option<f32> = None, optional, Rule::NonNegative, ["lumens" in set::DURER];
        /// Its measured spectrum, which `color` multiplies: a file (`lamp.csv`, `lamps.csv:column`)
        /// or the name of an illuminant (A, D65, F2, 2700K). Under `--color spectral` it is carried
        /// as such, else as its colour.
        spectrum: Option<FileName> = None, optional, Rule::Any, ["spectrum" in set::DURER];
    }
}

impl Emitter for PointLight {
    #[inline]
    fn illuminate(&self, point: DVec3) -> Illumination {
        let offset = (self.position.as_dvec3() - point).as_vec3();
        let distance = offset.length();
        let color = match self.attenuation {
            Some(a) => self.color / (a.x + a.y * distance + a.z * distance * distance),
            None => self.color,
        };
        let to_light = offset.normalize_or(Vec3::Y);
        Illumination { to_light, distance, color }
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

    fn in_units(&self) -> Self {
        let Some(candela) = self.candela.or(self.lumens.map(|lumens| lumens / (4.0 * PI))) else { return self.clone() };
        // What arrives is what a white matte surface shows: illuminance over pi.
        let color = as_bright(self.color, candela / PI);
        PointLight { color, attenuation: Some(Vec3::Z), falloff: None, candela: None, lumens: None, ..self.clone() }
    }

    fn validate(&self) -> Result<(), String> {
        let unit = self.candela.or(self.lumens).is_some();
        match () {
            () if self.candela.is_some() && self.lumens.is_some() => Err(TWO_UNITS.into()),
            () if unit && (self.attenuation.is_some() || self.falloff.is_some()) => Err(
                "what shines in candela or lumen fades with the square of the distance: `attenuation` and `falloff` \
                     have no place beside that"
                    .into(),
            ),
            () => Ok(()),
        }
    }

    fn place(&self) -> Option<(Vec3, Color)> {
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

    fn spread(&self) -> f32 {
        0.0
    }

    fn profile(&self) -> Option<&FileName> {
        None
    }

    fn in_profile(&self, dir: Vec3) -> Vec3 {
        dir
    }
}
