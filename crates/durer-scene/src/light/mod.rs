//! Lights. One file each; the list is [`Light`].

pub mod area;
mod closed;
pub mod directional;
pub mod photometric;
pub mod point;
mod seen;
pub mod spot;

use crate::describe::{FileName, described_list};
use crate::math::{Color, LUMINANCE, Vec3};
pub use area::EmitterShape;
pub use closed::{Body, Closed};
pub use directional::DirectionalLight;
use glam::DVec3;
pub use photometric::{PhotometricLight, Profile};
pub use point::PointLight;
pub use seen::{EmitterPoint, Placement};
pub use spot::{Fade, SpotLight};

macro_rules! delegate {
    ($($variant:ident),+) => {
        impl Emitter for Light {
            #[inline]
            fn illuminate(&self, point: DVec3) -> Illumination {
                match self { $(Light::$variant(l) => l.illuminate(point),)+ }
            }
            fn color(&self) -> Color {
                match self { $(Light::$variant(l) => l.color(),)+ }
            }
            fn color_mut(&mut self) -> &mut Color {
                match self { $(Light::$variant(l) => l.color_mut(),)+ }
            }
            fn spectrum(&self) -> Option<&FileName> {
                match self { $(Light::$variant(l) => Emitter::spectrum(l),)+ }
            }
            fn in_units(&self) -> Self {
                match self { $(Light::$variant(l) => l.in_units().into(),)+ }
            }
            fn validate(&self) -> Result<(), String> {
                match self { $(Light::$variant(l) => l.validate(),)+ }
            }
            fn position(&self) -> Option<Vec3> {
                match self { $(Light::$variant(l) => l.position(),)+ }
            }
            fn direction(&self) -> Option<Vec3> {
                match self { $(Light::$variant(l) => l.direction(),)+ }
            }
            fn cone(&self) -> Option<f32> {
                match self { $(Light::$variant(l) => l.cone(),)+ }
            }
            fn place(&self) -> Option<(Vec3, Color)> {
                match self { $(Light::$variant(l) => l.place(),)+ }
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
        }
    };
}

described_list! {
    /// A light.
    Light: Emitter => delegate {
        Directional(directional::DirectionalLight),
        Point(point::PointLight),
        Spot(spot::SpotLight),
        Photometric(photometric::PhotometricLight),
    }
}

impl Light {
    /// Changes its colour.
    pub fn recolor(&mut self, change: impl Fn(Color) -> Color) {
        *self.color_mut() = change(self.color());
    }

    /// File or name of its measured spectrum.
    pub fn spectrum(&self) -> Option<&FileName> {
        Emitter::spectrum(self)
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

/// What every light can do. No method has a default: the compiler names what a new light lacks.
pub trait Emitter {
    /// The light that arrives at a point, if nothing is in the way.
    fn illuminate(&self, point: DVec3) -> Illumination;

    /// Its colour, as written.
    fn color(&self) -> Color;

    /// Its colour, to be changed.
    fn color_mut(&mut self) -> &mut Color;

    /// File or name of its measured spectrum.
    fn spectrum(&self) -> Option<&FileName>;

    /// The light with its strength in its colour, if that is written in candela, lumen or lux.
    fn in_units(&self) -> Self;

    /// Checks its fields together. Each by itself has its rule in the statement.
    ///
    /// # Errors
    ///
    /// A sentence that names the fields which contradict each other.
    fn validate(&self) -> Result<(), String>;

    /// Its position, as written; `None` for a light at infinity.
    fn position(&self) -> Option<Vec3>;

    /// Direction in which its light goes, or the middle of its beam, as written, of any length;
    /// `None` for a light that is equally strong in all directions.
    fn direction(&self) -> Option<Vec3>;

    /// Degrees from [`Emitter::direction`] to the edge of its beam; `None` for a light without one.
    fn cone(&self) -> Option<f32>;

    /// Its position, and what arrives at distance 1 in the direction in which it is strongest;
    /// `None` for a light at infinity, and for one that fades otherwise than with the square of
    /// the distance.
    fn place(&self) -> Option<(Vec3, Color)>;

    /// Half the angle in which it is seen from everywhere, in degrees.
    fn spread(&self) -> f32;

    /// The file that says how strong it is in each direction.
    fn profile(&self) -> Option<&FileName>;

    /// A direction from the light in the coordinates of that file: x is its horizontal angle 0, z
    /// its lower side. Of no use without a file.
    fn in_profile(&self, dir: Vec3) -> Vec3;
}

#[cfg(test)]
mod tests;
