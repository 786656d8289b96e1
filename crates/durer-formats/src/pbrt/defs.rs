//! Results of executing directives: materials, textures and lights.

use durer_diag::Span;
use durer_scene::describe::FileName;
use durer_scene::material::{HairMaterial, PrincipledMaterial};
use durer_scene::math::Color;
use durer_scene::scene::TextureImage;
use glam::DAffine3;

/// Material defined in a pbrt file, before a shape uses it and it gets an index in the scene.
pub(super) enum MaterialDef {
    Principled(Box<PrincipledMaterial>, Span),
    Hair(HairMaterial, Span),
    /// Mix of two materials, which are indices into the reader's list; `share` is that of the
    /// first.
    Mix {
        parts: [usize; 2],
        share: f32,
        /// Picture that multiplies the share.
        picture: Option<FileName>,
        depth: u32,
        has_picture: bool,
        at: Span,
    },
    /// Material of a surface that is not rendered (`interface`).
    Interface,
}

/// Opacity of a shape, from its `alpha` parameter: a constant, and a picture that multiplies it.
#[derive(Debug)]
pub(super) struct Opacity {
    pub share: f32,
    pub picture: Option<FileName>,
}

/// Value of a pbrt texture: a constant colour or a picture.
#[derive(Clone)]
pub(super) enum Texture {
    Constant(Color),
    /// Picture, and the factor on its values.
    Picture(TextureImage, Color),
}

/// Area light of pbrt that applies to the shapes after it.
#[derive(Clone, Debug)]
pub(super) struct AreaLight {
    /// Radiance; only the colour of the light if `power` is given.
    pub radiance: Color,
    /// Luminous flux of each shape or triangle in lumens.
    pub power: Option<f32>,
    pub two_sided: bool,
    /// Name of a picture that multiplies the radiance.
    pub picture: Option<String>,
    pub at: Span,
}

/// Mapping between directions and positions in an environment map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum EnvironmentMapping {
    /// Equal-area square mapping of pbrt-v4.
    EqualArea,
    /// Longitude and latitude (equirectangular) mapping of pbrt-v3, with z up.
    Equirectangular,
}

/// Infinite light of pbrt: constant, or an environment map.
pub(super) enum InfiniteLight {
    /// Constant radiance.
    Constant(Color),
    Picture {
        name: String,
        at: Span,
        /// Factor on the values of the environment map.
        scale: Color,
        map: EnvironmentMapping,
        /// Transform from world space to the axes of the environment map.
        to_light: DAffine3,
        /// Illuminance to which the upper half of the map is scaled.
        illuminance: Option<f32>,
    },
}
