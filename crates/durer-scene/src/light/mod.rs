//! Light sources. Each kind has its own file, and [`Light`] lists all of them.

mod affine_body;
pub mod area;
pub mod directional;
mod emitter_point;
pub mod photometric;
pub mod point;
pub mod spot;

use crate::describe::{FileName, described_list};
use crate::math::{Color, LUMINANCE, Vec3};
pub use affine_body::{AffineBody, ClosedBody};
pub use area::EmitterShape;
pub use directional::DirectionalLight;
pub use emitter_point::{EmitterPoint, EmitterTransform};
use glam::DVec3;
pub use photometric::{PhotometricLight, PhotometricProfile, PhotometricSummary, ProfileKind};
pub use point::PointLight;
pub use spot::{Fade, SpotLight};

/// Fields that set the strength of a light in photometric units. A light has at most one of them.
pub const PHOTOMETRIC_FIELDS: [&str; 3] = ["candela", "lumens", "lux"];

macro_rules! delegate {
    ($($variant:ident),+) => {
        impl Illuminate for Light {
            #[inline]
            fn illuminate(&self, point: DVec3) -> LightLiSample {
                match self { $(Light::$variant(l) => l.illuminate(point),)+ }
            }
            fn color(&self) -> Color {
                match self { $(Light::$variant(l) => l.color(),)+ }
            }
            fn color_mut(&mut self) -> &mut Color {
                match self { $(Light::$variant(l) => l.color_mut(),)+ }
            }
            fn spectrum(&self) -> Option<&FileName> {
                match self { $(Light::$variant(l) => Illuminate::spectrum(l),)+ }
            }
            fn with_unit_color(&self) -> Self {
                match self { $(Light::$variant(l) => l.with_unit_color().into(),)+ }
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
            fn inverse_square(&self) -> Option<(Vec3, Color)> {
                match self { $(Light::$variant(l) => l.inverse_square(),)+ }
            }
            fn angular_radius(&self) -> f32 {
                match self { $(Light::$variant(l) => l.angular_radius(),)+ }
            }
            fn profile(&self) -> Option<&FileName> {
                match self { $(Light::$variant(l) => l.profile(),)+ }
            }
            fn to_profile(&self, dir: Vec3) -> Vec3 {
                match self { $(Light::$variant(l) => l.to_profile(dir),)+ }
            }
        }
    };
}

described_list! {
    /// Light source of any kind, other than an emitting surface.
    Light: Illuminate => delegate {
        Directional(directional::DirectionalLight),
        Point(point::PointLight),
        Spot(spot::SpotLight),
        Photometric(photometric::PhotometricLight),
    }
}

impl Light {
    /// Replaces the colour of the light with the result of `change`.
    pub fn recolor(&mut self, change: impl Fn(Color) -> Color) {
        *self.color_mut() = change(self.color());
    }

    /// File or name of the measured spectrum.
    pub fn spectrum(&self) -> Option<&FileName> {
        Illuminate::spectrum(self)
    }
}

/// Scales a colour to the luminance of a grey whose channels all equal `white`. Black stays black.
fn with_luminance(color: Color, white: f32) -> Color {
    let luminance = color.dot(LUMINANCE);
    if luminance > 0.0 { color * (white / luminance) } else { Color::ZERO }
}

const TWO_UNITS: &str = "`candela` and `lumens` both set the strength of this light: use only one of them";

/// Light that arrives at a point from one light source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightLiSample {
    /// Unit vector to the light, in world space.
    pub to_light: Vec3,
    /// Distance to the light, which is infinite for directional lights.
    pub distance: f32,
    /// Arriving light, given as the radiance of a white diffuse surface that faces the light.
    pub color: Color,
}

/// Operations that every light source implements. No method has a default implementation, so the
/// compiler lists the methods that a new light source lacks.
pub trait Illuminate {
    /// Light that arrives at a point, ignoring occlusion.
    fn illuminate(&self, point: DVec3) -> LightLiSample;

    /// Colour as written in the scene.
    fn color(&self) -> Color;

    /// Returns a mutable reference to the colour.
    fn color_mut(&mut self) -> &mut Color;

    /// File or name of the measured spectrum.
    fn spectrum(&self) -> Option<&FileName>;

    /// Returns the light with its strength included in its colour, converted from candela, lumens
    /// or lux if it is given in one of these units.
    fn with_unit_color(&self) -> Self;

    /// Checks combinations of fields. Individual fields are checked separately by the constraints
    /// in the description.
    ///
    /// # Errors
    ///
    /// Returns a sentence that names the contradictory fields.
    fn validate(&self) -> Result<(), String>;

    /// Position as written in the scene; `None` for a light at infinity.
    fn position(&self) -> Option<Vec3>;

    /// Direction in which the light travels, or the axis of its beam. It is returned as written in
    /// the scene and can have any length. `None` for a light that is equally strong in all
    /// directions.
    fn direction(&self) -> Option<Vec3>;

    /// Angle in degrees from [`Illuminate::direction`] to the edge of the beam; `None` for a light
    /// without a beam.
    fn cone(&self) -> Option<f32>;

    /// Position of the light, and the light that arrives at distance 1 in the strongest direction.
    /// `None` for a light at infinity, or for a light whose falloff is not the inverse square.
    fn inverse_square(&self) -> Option<(Vec3, Color)>;

    /// Angular radius of the light, which is the same from every point; 0 for a light without
    /// extent.
    fn angular_radius(&self) -> f32;

    /// File that lists the intensity in each direction.
    fn profile(&self) -> Option<&FileName>;

    /// Converts a direction from the light to the coordinate system of its profile, in which x
    /// points to horizontal angle 0, and z points downwards from the light. It is only useful for a
    /// light with a profile.
    fn to_profile(&self, dir: Vec3) -> Vec3;
}

#[cfg(test)]
mod tests;
