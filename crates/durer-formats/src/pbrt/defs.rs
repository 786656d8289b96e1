//! Materials, textures and lights that result from executing directives.

use durer_diag::Span;
use durer_scene::describe::FileName;
use durer_scene::material::{HairMaterial, PrincipledMaterial};
use durer_scene::math::Color;
use durer_scene::scene::TextureImage;
use glam::DAffine3;

/// Material that a pbrt file defines, before a shape uses it and it gets an index in the scene.
pub(super) enum MaterialDef {
    Principled(Box<PrincipledMaterial>, Span),
    Hair(HairMaterial, Span),
    /// Mix of two materials, given by their indices in the reader's list. `share` is the fraction
    /// of the first material.
    Mix {
        parts: [usize; 2],
        share: f32,
        /// Picture whose values multiply the share.
        picture: Option<FileName>,
        depth: u32,
        has_picture: bool,
        at: Span,
    },
    /// Material of a surface that is not rendered (`interface`).
    Interface,
}

/// Opacity of a shape, from its `alpha` parameter: a constant, and a picture that the constant
/// multiplies.
#[derive(Debug)]
pub(super) struct Opacity {
    pub share: f32,
    pub picture: Option<FileName>,
}

/// Value of a pbrt texture: a constant colour or a picture.
#[derive(Clone)]
pub(super) enum Texture {
    Constant(Color),
    /// Picture, and the factor that multiplies its values.
    Picture(TextureImage, Color),
}

/// Area light of pbrt, which applies to all shapes that follow it.
#[derive(Clone, Debug)]
pub(super) struct AreaLight {
    /// Radiance of the light. If `power` is given, only the light's colour is used.
    pub radiance: Color,
    /// Luminous flux of each shape or triangle in lumens.
    pub power: Option<f32>,
    pub two_sided: bool,
    /// Name of a picture that multiplies the radiance.
    pub picture: Option<String>,
    pub at: Span,
    /// True if the light ends with an `AttributeEnd` or another end of a scope.
    pub is_enclosed: bool,
}

/// Mapping from directions to positions in an environment map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum EnvironmentMapping {
    /// Equal-area square mapping, as in pbrt-v4.
    EqualArea,
    /// Equirectangular mapping (longitude and latitude) with z up, as in pbrt-v3.
    Equirectangular,
}

/// Infinite light of pbrt: a constant colour or an environment map.
pub(super) enum InfiniteLight {
    /// Constant radiance.
    Constant(Color),
    Picture {
        name: String,
        at: Span,
        /// Factor that multiplies the values of the environment map.
        scale: Color,
        map: EnvironmentMapping,
        /// Transform from world space to the coordinate system of the environment map.
        to_light: DAffine3,
        /// Illuminance to which the upper half of the map is scaled.
        illuminance: Option<f32>,
    },
}
