//! A light at a point that shines into a cone.

use super::{Emitter, Illumination};
use crate::describe::Rule;
use crate::described;
use crate::dialect::{Rules, set};
use crate::math::{Color, Vec3, fp};
use glam::DVec3;

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
    }
}

impl Emitter for SpotLight {
    fn illuminate(&self, point: DVec3) -> Illumination {
        let offset = (self.position.as_dvec3() - point).as_vec3();
        let distance = offset.length();
        let to_light = offset.normalize_or(Vec3::Y);
        let cosine = |degrees: f32| fp::sin_cos_degrees(f64::from(degrees)).1 as f32;
        let (outer, inner) = (cosine(self.angle), cosine(self.inner_angle.min(self.angle)));
        let seen = -to_light.dot(self.direction.normalize_or(Vec3::NEG_Y));
        // As glTF has it: KHR_lights_punctual. A cone without a soft edge ends at once.
        let share = match inner > outer {
            true => ((seen - outer) / (inner - outer)).clamp(0.0, 1.0),
            false => f32::from(seen >= outer),
        };
        Illumination { to_light, distance, color: self.color * (share * share / (distance * distance)) }
    }

    fn resolved(&self, _rules: &Rules) -> Self {
        self.clone()
    }

    fn color(&self) -> Color {
        self.color
    }

    fn place(&self) -> Option<(Vec3, Color)> {
        Some((self.position, self.color))
    }
}
