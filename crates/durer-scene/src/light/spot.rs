//! Spot light: a point light with a cone.

use super::{Illuminate, LightLiSample, TWO_UNITS, with_luminance};
use crate::describe::{Constraint, FileName, described, described_words};
use crate::dialect::set;
use crate::math::{Color, Vec3, fp};
use glam::DVec3;
use std::f32::consts::PI;

described_words! {
    /// Fade of a spot light between `innerAngle` and `angle`, as a function of the fraction s
    /// between their cosines: s^2 as in glTF, s^2 (3 - 2 s) as in pbrt-v4, or s^4 as in pbrt-v3.
    Fade { Squared = "squared", Smooth = "smooth", Fourth = "fourth" }
}

described! {
    /// Light emitted from one point into a cone, with falloff by the squared distance.
    SpotLight ["SpotLight" in set::DURER] {
        /// Position.
        position: Vec3 = Vec3::ZERO, required, Constraint::Any, ["position" in set::DURER];
        /// Direction of the cone's axis, of any length.
        direction: Vec3 = Vec3::NEG_Y, required, Constraint::NonZero, ["direction" in set::DURER];
        /// Colour and strength, as received on the axis at distance 1.
        color: Vec3 = Vec3::ONE, optional, Constraint::Any, ["color" in set::DURER];
        /// Angle in degrees from the axis to the edge of the cone.
        angle: f32 = 45.0, optional, Constraint::UpTo(180.0), ["angle" in set::DURER];
        /// Angle in degrees from the axis at which the fade begins; at most `angle`.
        inner_angle: f32 = 0.0, optional, Constraint::NonNegative, ["innerAngle" in set::DURER];
        /// Fade between the two angles, as a function of the fraction s between their cosines:
        /// `squared` is s^2, `smooth` is s^2 (3 - 2 s), `fourth` is s^4.
        fade: Fade = Fade::Squared, optional, Constraint::Any, ["fade" in set::DURER];
        /// Luminous intensity in candela on the axis; `color` then sets only the hue.
        candela: Option<f32> = None, optional, Constraint::NonNegative, ["candela" in set::DURER];
        /// Luminous flux in lumens; `color` then sets only the hue.
        lumens: Option<f32> = None, optional, Constraint::NonNegative, ["lumens" in set::DURER];
        /// Measured spectrum, multiplied by `color`: a file (`lamp.csv`, `lamps.csv:column`) or an
        /// illuminant (A, D65, F2, 2700K). `--color spectral` uses the spectrum; otherwise its RGB
        /// colour is used.
        spectrum: Option<FileName> = None, optional, Constraint::Any, ["spectrum" in set::DURER];
    }
}

impl Fade {
    /// Fraction of the light at a fraction `s` between the cosines of the two angles.
    ///
    /// Sources: KHR_lights_punctual; *Physically Based Rendering*, 4th edition, section 12.2.1, and
    /// 3rd edition, section 12.3.1.
    pub fn at(self, s: f32) -> f32 {
        s * s
            * match self {
                Fade::Squared => 1.0,
                Fade::Smooth => 3.0 - 2.0 * s,
                Fade::Fourth => s * s,
            }
    }
}

impl SpotLight {
    /// Cosines of the angles at which the cone ends and the fade starts.
    fn cosines(&self) -> [f32; 2] {
        [self.angle, self.inner_angle.min(self.angle)].map(|degrees| fp::sin_cos_degrees(f64::from(degrees)).1 as f32)
    }

    /// Solid angle of a uniform cone with the same flux and the same intensity on its axis.
    fn effective_solid_angle(&self) -> f32 {
        let [outer, inner] = self.cosines();
        // Mean values of s^2, s^2 (3 - 2 s) and s^4 over the fade.
        let fading = match self.fade {
            Fade::Squared => 1.0 / 3.0,
            Fade::Smooth => 0.5,
            Fade::Fourth => 0.2,
        };
        2.0 * PI * (1.0 - inner + fading * (inner - outer)).max(1e-6)
    }
}

impl Illuminate for SpotLight {
    fn illuminate(&self, point: DVec3) -> LightLiSample {
        let offset = (self.position.as_dvec3() - point).as_vec3();
        let distance = offset.length();
        let to_light = offset.normalize_or(Vec3::Y);
        let [outer, inner] = self.cosines();
        let cosine = -to_light.dot(self.direction.normalize_or(Vec3::NEG_Y));
        // A cone without a soft edge ends abruptly.
        let share = match inner > outer {
            true => ((cosine - outer) / (inner - outer)).clamp(0.0, 1.0),
            false => f32::from(cosine >= outer),
        };
        let share = self.fade.at(share);
        LightLiSample { to_light, distance, color: self.color * (share / (distance * distance)) }
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
        let Some(candela) = self.candela.or(self.lumens.map(|lumens| lumens / self.effective_solid_angle())) else {
            return self.clone();
        };
        // The colour of a light is the radiance of a white diffuse surface, which is the
        // illuminance divided by pi.
        SpotLight { color: with_luminance(self.color, candela / PI), candela: None, lumens: None, ..self.clone() }
    }

    fn validate(&self) -> Result<(), String> {
        match self.candela.is_some() && self.lumens.is_some() {
            true => Err(TWO_UNITS.into()),
            false => Ok(()),
        }
    }

    fn inverse_square(&self) -> Option<(Vec3, Color)> {
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
