//! Materials with the rules of their dialect worked in.

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
    /// Numbers only.
    Phong(Phong),
    /// Two materials mixed; the matrix leads from world to pattern space, and a picture by its
    /// number multiplies the share of the first.
    Solid(Solid, glam::DAffine3, Option<u32>),
}

/// How a material's highlight is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HighlightModel {
    /// max(0, N·H)^exponent where N·L > 0.
    Blinn,
    /// max(0, R·L)^exponent; `behind`: also where N·L <= 0.
    Phong {
        /// Whether surfaces that face away have highlights too.
        behind: bool,
    },
}

/// The pictures of a material in layers, by their numbers in [`super::World::textures`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Maps {
    /// Its alpha multiplies the opacity.
    pub base_color: Option<u32>,
    /// Multiplies the colour of emission.
    pub emission: Option<u32>,
    /// Multiplies the opacity.
    pub opacity: Option<u32>,
    /// Normals in tangent space.
    pub normal: Option<u32>,
    /// Heights.
    pub bump: Option<u32>,
    /// How far their 1 lies above their 0, in units of the world.
    pub bump_height: f32,
    /// What changes parameters.
    pub parameters: Vec<Map>,
}

/// A picture that changes a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Map {
    /// What it does: the number of a row of [`TEXTURED`](durer_scene::material::parameters::TEXTURED).
    pub row: usize,
    /// Its number.
    pub texture: u32,
    /// What counts of it where a number is wanted; `None`: what its mapping says, or red.
    pub channel: Option<Channel>,
}

/// A principled material with its files read and its tables worked out.
#[derive(Clone, Debug, PartialEq)]
pub struct Principled {
    /// As written.
    pub written: PrincipledMaterial,
    /// Its pictures.
    pub maps: Maps,
    /// The same everywhere, where no picture says otherwise.
    pub parameters: Parameters,
    /// What its boundaries give back.
    pub tables: Tables,
    /// The spectrum of its own light.
    pub illuminant: Option<Arc<Curve>>,
    /// What the body is filled with, if that absorbs or scatters light.
    pub medium: Option<Medium>,
    /// Whether the surface itself does nothing where what is around has the same index of
    /// refraction: a body of smoke.
    pub interface: bool,
}

impl Principled {
    /// Whether some of its layers mirror or refract into single directions. Roughness from pictures
    /// is not looked at.
    pub fn has_single_directions(&self) -> bool {
        let m = &self.written;
        let smooth = |roughness: f32| Ggx::new(roughness, 0.0).is_smooth();
        let skin = self.parameters.specular_roughness <= 0.0 || smooth(self.parameters.specular_roughness);
        skin && !self.interface || m.coat_weight > 0.0 && smooth(m.coat_roughness)
    }
}

/// The light of a surface's own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Emission {
    /// Its radiance, without texture.
    pub radiance: Color,
    /// Whether a picture multiplies it.
    pub textured: bool,
    /// Whether both sides shine, and not only that of the normal.
    pub two_sided: bool,
}

/// A Phong material with the rules of its dialect worked in.
#[derive(Clone, Debug, PartialEq)]
pub struct Phong {
    /// Share of light scattered evenly, where neither texture nor noise is.
    pub diffuse: Color,
    /// Number of a texture that replaces it.
    pub texture: Option<u32>,
    /// Whether the texture multiplies the diffuse colour, and the vertices' colours do too, as in
    /// materials of layers.
    pub tinted: bool,
    /// Noise that replaces it.
    pub noise: Option<ColorNoise>,
    /// What ambient light meets; `None`: the diffuse colour, texture or noise.
    pub ambient: Option<Color>,
    /// Strength and sharpness of the highlight, if there is one.
    pub highlight: Option<(Color, f32, HighlightModel)>,
    /// Weight of the mirrored ray.
    pub reflective: Color,
    /// Weight of the transmitted ray.
    pub transparent: Color,
    /// Index of refraction inside.
    pub ior: f32,
    /// Whether Fresnel's law divides light between the two rays.
    pub fresnel: bool,
    /// What a path tracer takes instead of all this.
    pub principled: Option<Arc<Principled>>,
    /// Or this.
    pub fibre: Option<Arc<Fibre>>,
    /// The light of its own, which path tracers see.
    pub emission: Option<Emission>,
}

impl Phong {
    /// Whether paths go into bodies of it.
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

/// One of the materials that make up a surface point.
#[derive(Clone, Copy, Debug)]
pub struct WeightedMaterial<'w> {
    /// Its numbers.
    pub phong: &'w Phong,
    /// Its share: those of all parts sum to 1.
    pub share: f32,
}

/// All of them: mostly one.
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
