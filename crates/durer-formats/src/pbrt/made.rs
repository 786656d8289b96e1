//! What directives become: materials, textures, media, what shines.

use durer_diag::Span;
use durer_scene::describe::FileName;
use durer_scene::material::{HairMaterial, PrincipledMaterial};
use durer_scene::math::Color;
use durer_scene::scene::Picture;
use glam::DAffine3;

/// A material as written.
pub(super) enum Made {
    Layers(Box<PrincipledMaterial>, Span),
    Hair(HairMaterial, Span),
    /// Two others, by number, and the share of the first.
    Mix {
        parts: [usize; 2],
        share: f32,
        /// A picture that multiplies the share.
        picture: Option<FileName>,
        depth: u32,
        pictured: bool,
        at: Span,
    },
    /// What is not there at all.
    Nothing,
}

/// How much of a shape is there: everywhere, or by a picture.
#[derive(Debug)]
pub(super) struct Opacity {
    pub share: f32,
    pub picture: Option<FileName>,
}

/// What a texture is here.
#[derive(Clone)]
pub(super) enum Texture {
    Even(Color),
    /// A picture, and what multiplies it.
    Picture(Picture, Color),
}

/// The light of a surface.
#[derive(Clone, Debug)]
pub(super) struct AreaLight {
    /// Its radiance where no power is given; else the colour of its power.
    pub radiance: Color,
    /// Flux of each shape or triangle.
    pub power: Option<f32>,
    pub two_sided: bool,
    /// The name of a picture that multiplies it.
    pub picture: Option<String>,
    pub at: Span,
}

/// How directions lie in a picture of all of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Map {
    /// In a square, all areas in proportion: pbrt-v4's.
    EqualArea,
    /// By longitude and latitude, z upwards: pbrt-v3's.
    Longitude,
}

/// A light that is infinitely far away.
pub(super) enum Infinite {
    /// The same from everywhere.
    Even(Color),
    Picture {
        name: String,
        at: Span,
        /// What multiplies it.
        scale: Color,
        map: Map,
        /// From the world's directions to the picture's.
        to_light: DAffine3,
        /// The illuminance that its upper half is to have.
        illuminance: Option<f32>,
    },
}
