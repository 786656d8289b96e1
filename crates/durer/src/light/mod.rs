//! Lights. One file each; the list is [`Light`].

pub mod directional;
pub mod point;

use crate::described_list;
use crate::dialect::Rules;
use crate::math::{Color, Vec3};
pub use directional::DirectionalLight;
use glam::DVec3;
pub use point::PointLight;

described_list! {
    /// A light.
    Light {
        Directional(directional::DirectionalLight),
        Point(point::PointLight),
    }
}

/// A light as seen from a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Illumination {
    /// Unit vector to the light.
    pub to_light: Vec3,
    /// How far it is; infinite for directional lights.
    pub distance: f32,
    /// What arrives.
    pub color: Color,
}

/// What every light can do.
pub trait Emitter {
    /// The light that arrives at a point, if nothing is in the way.
    fn illuminate(&self, point: DVec3) -> Illumination;

    /// The same light with the rules of a dialect worked in.
    fn resolved(&self, rules: &Rules) -> Self;
}

impl Emitter for Light {
    fn illuminate(&self, point: DVec3) -> Illumination {
        match self {
            Light::Directional(l) => l.illuminate(point),
            Light::Point(l) => l.illuminate(point),
        }
    }

    fn resolved(&self, rules: &Rules) -> Self {
        match self {
            Light::Directional(l) => l.resolved(rules).into(),
            Light::Point(l) => l.resolved(rules).into(),
        }
    }
}

#[cfg(test)]
mod tests;
