//! Results of directives: materials, textures, media and lights.

use durer_diag::Span;
use durer_scene::describe::FileName;
use durer_scene::material::{HairMaterial, PrincipledMaterial};
use durer_scene::math::Color;
use durer_scene::scene::Picture;
use glam::DAffine3;

/// Material as declared.
pub(super) enum MaterialDef {
    Layers(Box<PrincipledMaterial>, Span),
    Hair(HairMaterial, Span),
    /// Mix of two materials by index, with the share of the first.
    Mix {
        parts: [usize; 2],
        share: f32,
        /// Picture that multiplies the share.
        picture: Option<FileName>,
        depth: u32,
        pictured: bool,
        at: Span,
    },
    /// Material of a surface that is not rendered.
    Nothing,
}

/// Opacity of a shape: a constant share, and a picture that multiplies it.
#[derive(Debug)]
pub(super) struct Opacity {
    pub share: f32,
    pub picture: Option<FileName>,
}

/// Texture: a constant or a picture.
#[derive(Clone)]
pub(super) enum Texture {
    Even(Color),
    /// Picture and its factor.
    Picture(Picture, Color),
}

/// Area light.
#[derive(Clone, Debug)]
pub(super) struct AreaLight {
    /// Radiance; the colour of the power if `power` is given.
    pub radiance: Color,
    /// Flux of each shape or triangle, in lumens.
    pub power: Option<f32>,
    pub two_sided: bool,
    /// Name of a picture that multiplies the radiance.
    pub picture: Option<String>,
    pub at: Span,
}

/// Mapping of directions to a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Map {
    /// Equal-area square of pbrt-v4.
    EqualArea,
    /// Longitude and latitude of pbrt-v3, z up.
    Longitude,
}

/// Infinite light.
pub(super) enum InfiniteLight {
    /// Constant radiance.
    Even(Color),
    Picture {
        name: String,
        at: Span,
        /// Factor on the picture's values.
        scale: Color,
        map: Map,
        /// Map from world space to the picture's space.
        to_light: DAffine3,
        /// Illuminance that the upper half is scaled to.
        illuminance: Option<f32>,
    },
}
