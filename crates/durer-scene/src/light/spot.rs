//! A light at a point that shines into a cone.

use super::{Emitter, Illumination, TWO_UNITS, as_bright};
use crate::describe::{FileName, Rule, described, described_words};
use crate::dialect::set;
use crate::math::{Color, Vec3, fp};
use glam::DVec3;
use std::f32::consts::PI;

described_words! {
    /// How a cone fades between `innerAngle` and `angle`, by the share s of the cosine's way: s^2,
    /// as glTF has it, s^2 (3 - 2 s), as pbrt-v4 has it, or s^4, as pbrt-v3 has it.
    Fade { Squared = "squared", Smooth = "smooth", Fourth = "fourth" }
}

described! {
    /// Light that comes from one point into a cone, and fades with the square of the distance.
    SpotLight ["SpotLight" in set::DURER] {
        /// Where it is.
        position: Vec3 = Vec3::ZERO, required, Rule::Any, ["position" in set::DURER];
        /// Where the middle of the cone points; of any length.
        direction: Vec3 = Vec3::NEG_Y, required, Rule::NonZero, ["direction" in set::DURER];
        /// What arrives in the middle at distance 1.
        color: Vec3 = Vec3::ONE, required, Rule::Any, ["color" in set::DURER];
        /// Degrees from the middle to where the cone ends.
        angle: f32 = 45.0, optional, Rule::UpTo(180.0), ["angle" in set::DURER];
        /// Degrees from the middle to where it begins to fade; not more than `angle`.
        inner_angle: f32 = 0.0, optional, Rule::NonNegative, ["innerAngle" in set::DURER];
        /// How it fades between the two, by the share s of the cosine's way: `squared` is s^2,
        /// `smooth` s^2 (3 - 2 s), `fourth` s^4.
        fade: Fade = Fade::Squared, optional, Rule::Any, ["fade" in set::DURER];
        /// Luminous intensity in candela in its middle: how strong it is, of which `color` is the
        /// hue.
        candela: Option<f32> = None, optional, Rule::NonNegative, ["candela" in set::DURER];
        /// The same by its luminous flux in lumen.
        lumens: Option<f32> = None, optional, Rule::NonNegative, ["lumens" in set::DURER];
        /// Its measured spectrum, which `color` multiplies: a file (`lamp.csv`, `lamps.csv:column`)
        /// or the name of an illuminant (A, D65, F2, 2700K). Under `--color spectral` it is carried
        /// as such, else as its colour.
        spectrum: Option<FileName> = None, optional, Rule::Any, ["spectrum" in set::DURER];
    }
}

impl SpotLight {
    /// The cosines of where the cone ends, and of where it begins to fade.
    fn cosines(&self) -> [f32; 2] {
        [self.angle, self.inner_angle.min(self.angle)].map(|degrees| fp::sin_cos_degrees(f64::from(degrees)).1 as f32)
    }

    /// The solid angle that has as much light when it is as strong all over as in the middle.
    fn fills(&self) -> f32 {
        let [outer, inner] = self.cosines();
        // The means of s², of s² (3 - 2 s) and of s⁴.
        let fading = match self.fade {
            Fade::Squared => 1.0 / 3.0,
            Fade::Smooth => 0.5,
            Fade::Fourth => 0.2,
        };
        2.0 * PI * (1.0 - inner + fading * (inner - outer)).max(1e-6)
    }
}

impl Emitter for SpotLight {
    fn illuminate(&self, point: DVec3) -> Illumination {
        let offset = (self.position.as_dvec3() - point).as_vec3();
        let distance = offset.length();
        let to_light = offset.normalize_or(Vec3::Y);
        let [outer, inner] = self.cosines();
        let seen = -to_light.dot(self.direction.normalize_or(Vec3::NEG_Y));
        // A cone without a soft edge ends at once.
        let share = match inner > outer {
            true => ((seen - outer) / (inner - outer)).clamp(0.0, 1.0),
            false => f32::from(seen >= outer),
        };
        // Sources: KHR_lights_punctual; *Physically Based Rendering*, 4th edition, section 12.2.1, and
        // 3rd edition, section 12.3.1.
        let share = share
            * share
            * match self.fade {
                Fade::Squared => 1.0,
                Fade::Smooth => 3.0 - 2.0 * share,
                Fade::Fourth => share * share,
            };
        Illumination { to_light, distance, color: self.color * (share / (distance * distance)) }
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
        let Some(candela) = self.candela.or(self.lumens.map(|lumens| lumens / self.fills())) else {
            return self.clone();
        };
        // What arrives is what a white matte surface shows: illuminance over pi.
        SpotLight { color: as_bright(self.color, candela / PI), candela: None, lumens: None, ..self.clone() }
    }

    fn validate(&self) -> Result<(), String> {
        match self.candela.is_some() && self.lumens.is_some() {
            true => Err(TWO_UNITS.into()),
            false => Ok(()),
        }
    }

    fn place(&self) -> Option<(Vec3, Color)> {
        Some((self.position, self.color))
    }

    fn position(&self) -> Option<Vec3> {
        Some(self.position)
    }

    fn direction(&self) -> Option<Vec3> {
        Some(self.direction)
    }

    fn cone(&self) -> Option<f32> {
        Some(self.angle)
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
