//! Compiled materials, with the rules of their dialect applied.

use durer_scene::bsdf::Tables;
use durer_scene::bsdf::lobe::hair::Fibre;
use durer_scene::bsdf::microfacet::Ggx;
use durer_scene::material::principled::Walls;
use durer_scene::material::{ColorNoise, Parameters, PrincipledMaterial, Solid};
use durer_scene::math::Color;
use durer_scene::medium::Medium;
use durer_scene::spectrum::Curve;
use durer_scene::texture::Channel;
use smallvec::SmallVec;
use std::sync::Arc;

/// A compiled material.
#[derive(Clone, Debug, PartialEq)]
pub enum Material {
    /// A material of parameters.
    Phong(Phong),
    /// A mix of two materials; the matrix maps from world to pattern space, and a texture (by
    /// index) multiplies the share of the first.
    Solid(Solid, glam::DAffine3, Option<u32>),
}

/// Model of a highlight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HighlightModel {
    /// max(0, N·H)^exponent where N·L > 0.
    Blinn,
    /// max(0, R·L)^exponent; `behind`: also where N·L <= 0.
    Phong {
        /// True if surfaces that face away have highlights too.
        behind: bool,
    },
}

/// Textures of a layered material, by index in [`super::World::textures`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Maps {
    /// Base colour; its alpha multiplies the opacity.
    pub base_color: Option<u32>,
    /// Factor of the emission's colour.
    pub emission: Option<u32>,
    /// Factor of the opacity.
    pub opacity: Option<u32>,
    /// Normals in tangent space.
    pub normal: Option<u32>,
    /// Bump map.
    pub bump: Option<u32>,
    /// Height of bump value 1 over 0, in units of the world.
    pub bump_height: f32,
    /// Textures of parameters.
    pub parameters: Vec<Map>,
}

/// A texture of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Map {
    /// Row in [`TEXTURED`](durer_scene::material::parameters::TEXTURED), which defines the
    /// parameter.
    pub row: usize,
    /// Index of the texture.
    pub texture: u32,
    /// Channel for numbers; `None`: as in its mapping, or red.
    pub channel: Option<Channel>,
}

/// A principled material with its files and tables loaded.
#[derive(Clone, Debug, PartialEq)]
pub struct Principled {
    /// Description.
    pub written: PrincipledMaterial,
    /// Textures.
    pub maps: Maps,
    /// Parameters without textures.
    pub parameters: Parameters,
    /// Reflectance tables of its boundaries.
    pub tables: Tables,
    /// Spectrum of its emission.
    pub illuminant: Option<Arc<Curve>>,
    /// Interior medium, if it absorbs or scatters.
    pub medium: Option<Medium>,
    /// True if the surface has no effect between equal indices of refraction, as for smoke.
    pub interface: bool,
}

impl Principled {
    /// Returns true if some layer reflects or refracts into a single direction. Ignores roughness
    /// textures.
    pub fn has_single_directions(&self) -> bool {
        let m = &self.written;
        let smooth = |roughness: f32| Ggx::new(roughness, 0.0).is_smooth();
        let skin = self.parameters.specular_roughness <= 0.0 || smooth(self.parameters.specular_roughness);
        skin && !self.interface || m.coat_weight > 0.0 && smooth(m.coat_roughness)
    }
}

/// Emission of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Emission {
    /// Radiance, without texture.
    pub radiance: Color,
    /// True if a texture multiplies it.
    pub textured: bool,
    /// True if both sides emit, false for the side of the normal only.
    pub two_sided: bool,
}

/// A Phong material with the rules of its dialect applied.
#[derive(Clone, Debug, PartialEq)]
pub struct Phong {
    /// Diffuse reflectance without texture and noise.
    pub diffuse: Color,
    /// Index of a texture that replaces the diffuse colour.
    pub texture: Option<u32>,
    /// True if texture and vertex colours multiply the diffuse colour, as in layered materials.
    pub tinted: bool,
    /// Noise that replaces the diffuse colour.
    pub noise: Option<ColorNoise>,
    /// Ambient reflectance; `None`: the diffuse colour, texture or noise.
    pub ambient: Option<Color>,
    /// Strength, exponent and model of the highlight, if there is one.
    pub highlight: Option<(Color, f32, HighlightModel)>,
    /// Weight of the reflected ray.
    pub reflective: Color,
    /// Weight of the transmitted ray.
    pub transparent: Color,
    /// Index of refraction.
    pub ior: f32,
    /// True if Fresnel's law splits the light between the two rays.
    pub fresnel: bool,
    /// Layered material, which path tracers use instead.
    pub principled: Option<Arc<Principled>>,
    /// Hair fibre, which path tracers use instead.
    pub fibre: Option<Arc<Fibre>>,
    /// Emission, which only path tracers see.
    pub emission: Option<Emission>,
}

impl Phong {
    /// Returns true if paths enter objects of this material.
    pub fn is_entered(&self) -> bool {
        match &self.principled {
            Some(own) => {
                let m = &own.written;
                m.walls == Walls::Solid && (m.transmission_weight > 0.0 || m.subsurface_weight > 0.0)
            }
            None => self.transparent != Color::ZERO,
        }
    }
}

/// One of the materials of a surface point.
#[derive(Clone, Copy, Debug)]
pub struct WeightedMaterial<'w> {
    /// The material.
    pub phong: &'w Phong,
    /// Weight; the weights of a point sum to 1.
    pub share: f32,
}

/// The materials of a surface point, usually one.
pub type MaterialMix<'w> = SmallVec<[WeightedMaterial<'w>; 2]>;

impl Default for Phong {
    fn default() -> Self {
        Phong {
            diffuse: Color::splat(0.8),
            texture: None,
            tinted: false,
            noise: None,
            ambient: None,
            highlight: None,
            reflective: Color::ZERO,
            transparent: Color::ZERO,
            ior: 1.0,
            fresnel: false,
            principled: None,
            fibre: None,
            emission: None,
        }
    }
}
