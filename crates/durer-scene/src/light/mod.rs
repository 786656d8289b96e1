//! Lights. One file each; the list is [`Light`].

pub mod area;
pub mod directional;
pub mod photometric;
pub mod point;
pub mod spot;

use crate::describe::{FileName, described_list};
use crate::math::{Color, LUMINANCE, Vec3};
pub use area::{EmitterPoint, EmitterShape, Placement};
pub use directional::DirectionalLight;
use glam::DVec3;
pub use photometric::{PhotometricLight, Profile};
pub use point::PointLight;
pub use spot::{Fade, SpotLight};

macro_rules! delegate {
    ($($variant:ident),+) => {
        impl Emitter for Light {
            #[inline]
            fn illuminate(&self, point: DVec3) -> Illumination {
                match self { $(Light::$variant(l) => l.illuminate(point),)+ }
            }
            fn color(&self) -> Color {
                match self { $(Light::$variant(l) => l.color,)+ }
            }
            fn in_units(&self) -> Self {
                match self { $(Light::$variant(l) => l.in_units().into(),)+ }
            }
            fn validate(&self) -> Result<(), String> {
                match self { $(Light::$variant(l) => l.validate(),)+ }
            }
            fn spread(&self) -> f32 {
                match self { $(Light::$variant(l) => l.spread(),)+ }
            }
            fn profile(&self) -> Option<&FileName> {
                match self { $(Light::$variant(l) => l.profile(),)+ }
            }
            fn in_profile(&self, dir: Vec3) -> Vec3 {
                match self { $(Light::$variant(l) => l.in_profile(dir),)+ }
            }
            fn place(&self) -> Option<(Vec3, Color)> {
                match self { $(Light::$variant(l) => l.place(),)+ }
            }
        }

        impl Light {
            /// Changes its colour.
            pub fn recolor(&mut self, change: impl Fn(Color) -> Color) {
                match self { $(Light::$variant(l) => l.color = change(l.color),)+ }
            }

            /// Its spectrum, if that was measured.
            pub fn spectrum(&self) -> Option<&FileName> {
                match self { $(Light::$variant(l) => l.spectrum.as_ref(),)+ }
            }
        }
    };
}

described_list! {
    /// A light.
    Light => delegate {
        Directional(directional::DirectionalLight),
        Point(point::PointLight),
        Spot(spot::SpotLight),
        Photometric(photometric::PhotometricLight),
    }
}

/// A colour that is as bright as white times a number. What is black stays black.
fn as_bright(color: Color, white: f32) -> Color {
    let luminance = color.dot(LUMINANCE);
    if luminance > 0.0 { color * (white / luminance) } else { Color::ZERO }
}

const TWO_UNITS: &str = "`candela` and `lumens` both say how strong this light is: write one of them";

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

    /// Its colour, as written.
    fn color(&self) -> Color;

    /// The same with its strength in its colour, where that is written in candela, lumen or lux.
    fn in_units(&self) -> Self;

    /// Checks its fields together. Each by itself has its rule in the statement.
    ///
    /// # Errors
    ///
    /// A sentence that names the fields which contradict each other.
    fn validate(&self) -> Result<(), String> {
        Ok(())
    }

    /// Where it is, and what arrives at distance 1 in the direction in which it is strongest;
    /// `None` for lights without a place, and for those that fade otherwise than with the
    /// square of the distance.
    fn place(&self) -> Option<(Vec3, Color)> {
        None
    }

    /// Half the angle in which it is seen from everywhere, in degrees.
    fn spread(&self) -> f32 {
        0.0
    }

    /// The file that says how strong it shines in each direction.
    fn profile(&self) -> Option<&FileName> {
        None
    }

    /// A direction from the light as that file means it: x is its horizontal angle 0, z its lower
    /// side.
    fn in_profile(&self, dir: Vec3) -> Vec3 {
        dir
    }
}

#[cfg(test)]
mod tests;
