//! Compiled materials, after the dialect's rules have been applied.

use durer_scene::bsdf::Tables;
use durer_scene::bsdf::lobe::hair::Fibre;
use durer_scene::bsdf::microfacet::Ggx;
use durer_scene::material::principled::Walls;
use durer_scene::material::{ColorNoise, Parameters, PatternMaterial, PrincipledMaterial};
use durer_scene::math::Color;
use durer_scene::medium::Medium;
use durer_scene::spectrum::Curve;
use durer_scene::texture::Channel;
use smallvec::SmallVec;
use std::sync::Arc;

/// Compiled material of a world: parameters for shading, or a pattern that mixes two materials.
#[derive(Clone, Debug, PartialEq)]
pub enum Material {
    /// A material with parameters; [`Phong::principled`] extends it for path tracing.
    Phong(Phong),
    /// A mix of two other materials. The matrix transforms world space to pattern space. The
    /// optional texture, by its index, multiplies the share of the first material.
    Mix(PatternMaterial, glam::DAffine3, Option<u32>),
}

/// Formula of a Phong material's highlight: Blinn's or Phong's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HighlightModel {
    /// max(0, N·H)^exponent where N·L > 0.
    Blinn,
    /// max(0, R·L)^exponent.
    Phong {
        /// True if surfaces that face away from the light have highlights too.
        behind: bool,
    },
}

/// Textures of a principled material, by their indices in [`super::World::textures`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MaterialTextures {
    /// Base colour. Its alpha multiplies the opacity.
    pub base_color: Option<u32>,
    /// Multiplies the emission colour.
    pub emission: Option<u32>,
    /// Multiplies the opacity.
    pub opacity: Option<u32>,
    /// Normal map in tangent space.
    pub normal: Option<u32>,
    /// Bump map.
    pub bump: Option<u32>,
    /// Height difference between bump values 1 and 0, in world units.
    pub bump_height: f32,
    /// Textures of other parameters.
    pub parameters: Vec<ParameterTexture>,
}

/// Texture of one parameter of a principled material, such as its roughness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParameterTexture {
    /// Row in [`TEXTURE_FIELDS`](durer_scene::material::parameters::TEXTURE_FIELDS), which tells
    /// the parameter.
    pub row: usize,
    /// Index of the texture.
    pub texture: u32,
    /// Channel to use for a number; `None` for that of the texture's mapping, or else red.
    pub channel: Option<Channel>,
}

/// Principled material for path tracing, with its textures, spectra and tables loaded.
#[derive(Clone, Debug, PartialEq)]
pub struct Principled {
    /// Material as written in the scene.
    pub definition: PrincipledMaterial,
    /// Textures.
    pub maps: MaterialTextures,
    /// Parameters before textures are applied.
    pub parameters: Parameters,
    /// Precomputed reflectances of the material's interfaces.
    pub tables: Tables,
    /// Spectrum of the light that the material emits, if it was given.
    pub illuminant: Option<Arc<Curve>>,
    /// Interior medium, if it absorbs or scatters.
    pub medium: Option<Medium>,
    /// True if the surface has no effect when the indices of refraction on both sides are equal, as
    /// for smoke.
    pub interface: bool,
}

impl Principled {
    /// Returns true if some layer reflects or refracts light in a single direction. Ignores
    /// roughness textures.
    pub fn has_delta_lobes(&self) -> bool {
        let m = &self.definition;
        let smooth = |roughness: f32| Ggx::new(roughness, 0.0).is_smooth();
        let skin = self.parameters.specular_roughness <= 0.0 || smooth(self.parameters.specular_roughness);
        skin && !self.interface || m.coat_weight > 0.0 && smooth(m.coat_roughness)
    }
}

/// Light that the surfaces of a principled material emit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Emission {
    /// Radiance before a texture is applied.
    pub radiance: Color,
    /// True if a texture or vertex colours multiply the radiance.
    pub textured: bool,
    /// True if both sides emit, false if only the side of the normal does.
    pub two_sided: bool,
}

/// Phong material after the dialect's rules were applied; for principled materials and hair, an
/// approximation for the Whitted integrator.
#[derive(Clone, Debug, PartialEq)]
pub struct Phong {
    /// Diffuse reflectance before texture and noise.
    pub diffuse: Color,
    /// Index of the texture that replaces the diffuse colour, or multiplies it if `tinted`.
    pub texture: Option<u32>,
    /// True if texture and vertex colours multiply the diffuse colour, as in principled materials.
    pub tinted: bool,
    /// Noise that replaces the diffuse colour.
    pub noise: Option<ColorNoise>,
    /// Ambient reflectance; `None` if it equals the diffuse colour, texture or noise.
    pub ambient: Option<Color>,
    /// Colour, exponent and formula of the highlight, if there is one.
    pub highlight: Option<(Color, f32, HighlightModel)>,
    /// Weight of the reflected ray.
    pub reflective: Color,
    /// Weight of the transmitted ray.
    pub transparent: Color,
    /// Index of refraction.
    pub ior: f32,
    /// True if Fresnel's equations split the light between the two rays.
    pub fresnel: bool,
    /// Principled material, which path tracing uses instead of this one.
    pub principled: Option<Arc<Principled>>,
    /// Hair fibre, which path tracing uses instead of this material.
    pub fibre: Option<Arc<Fibre>>,
    /// Emission, which only path tracing renders.
    pub emission: Option<Emission>,
}

impl Phong {
    /// Returns true if paths can enter objects of this material.
    pub fn is_entered(&self) -> bool {
        match &self.principled {
            Some(own) => {
                let m = &own.definition;
                m.walls == Walls::Solid && (m.transmission_weight > 0.0 || m.subsurface_weight > 0.0)
            }
            None => self.transparent != Color::ZERO,
        }
    }
}

/// One of the materials at a surface point, with its share of the point.
#[derive(Clone, Copy, Debug)]
pub struct WeightedMaterial<'w> {
    /// The material.
    pub phong: &'w Phong,
    /// Share of the material; the shares at a point sum to 1.
    pub share: f32,
}

/// Materials at a surface point, usually a single one.
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
