//! Lights. One file each; the list is [`Light`].

pub mod directional;
pub mod point;
pub mod spot;

use crate::described_list;
use crate::dialect::Rules;
use crate::math::{Color, Vec3};
pub use directional::DirectionalLight;
use glam::DVec3;
pub use point::PointLight;
pub use spot::SpotLight;

described_list! {
    /// A light.
    Light {
        Directional(directional::DirectionalLight),
        Point(point::PointLight),
        Spot(spot::SpotLight),
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

    /// Its colour, as written.
    fn color(&self) -> Color;

    /// Where it is, and what arrives at distance 1 in the direction in which it is strongest; `None` for lights without a
    /// place, and for those that fade otherwise than with the square of the distance.
    fn place(&self) -> Option<(Vec3, Color)> {
        None
    }
}

macro_rules! delegate {
    ($($variant:ident),+) => {
        impl Emitter for Light {
            fn illuminate(&self, point: DVec3) -> Illumination {
                match self { $(Light::$variant(l) => l.illuminate(point),)+ }
            }
            fn resolved(&self, rules: &Rules) -> Self {
                match self { $(Light::$variant(l) => l.resolved(rules).into(),)+ }
            }
            fn color(&self) -> Color {
                match self { $(Light::$variant(l) => l.color,)+ }
            }
            fn place(&self) -> Option<(Vec3, Color)> {
                match self { $(Light::$variant(l) => l.place(),)+ }
            }
        }
    };
}
delegate!(Directional, Point, Spot);

#[cfg(test)]
mod tests;
