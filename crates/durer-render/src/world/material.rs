//! Compiled materials, after the dialect's rules have been applied.

use durer_scene::bsdf::Tables;
use durer_scene::bsdf::lobe::hair::Fibre;
use durer_scene::bsdf::microfacet::Ggx;
use durer_scene::material::principled::{BumpGradient, NormalGreen, Walls};
use durer_scene::material::{ColorNoise, Parameters, PatternMaterial, PrincipledMaterial};
use durer_scene::math::Color;
use durer_scene::medium::Medium;
use durer_scene::spectrum::Curve;
use durer_scene::texture::Channel;
use smallvec::SmallVec;
use std::sync::Arc;

/// Compiled material of a world, which is either a set of shading parameters or a pattern that
/// mixes two materials.
#[derive(Clone, Debug, PartialEq)]
pub enum Material {
    /// A material given by parameters; [`Phong::principled`] adds those for path tracing.
    Phong(Phong),
    /// A mix of two other materials. The matrix transforms points from world space to pattern
    /// space. The texture, if there is one, is given by its index and multiplies the share of the
    /// first material.
    Mix(PatternMaterial, glam::DAffine3, Option<u32>),
}

/// Formula of a Phong material's highlight, due to Blinn or to Phong.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HighlightModel {
    /// Highlight of max(0, N·H)^exponent where N·L > 0.
    Blinn,
    /// max(0, R·L)^exponent.
    Phong {
        /// True if surfaces that face away from the light also have highlights.
        behind: bool,
    },
}

/// Textures of a principled material, by their indices in [`super::World::textures`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MaterialTextures {
    /// Base colour texture. Its alpha channel multiplies the opacity.
    pub base_color: Option<u32>,
    /// Texture that multiplies the emission colour.
    pub emission: Option<u32>,
    /// Texture that multiplies the opacity.
    pub opacity: Option<u32>,
    /// Normal map, in tangent space.
    pub normal: Option<u32>,
    /// Direction of the green channel of the normal map.
    pub green: NormalGreen,
    /// Bump map.
    pub bump: Option<u32>,
    /// Difference in height between bump values 1 and 0, in world units.
    pub bump_height: f32,
    /// Gradient of the bump map.
    pub bump_gradient: BumpGradient,
    /// Textures of all other parameters.
    pub parameters: Vec<ParameterTexture>,
}

/// Texture of a single parameter of a principled material, such as its roughness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParameterTexture {
    /// Row in [`TEXTURE_FIELDS`](durer_scene::material::parameters::TEXTURE_FIELDS) that identifies
    /// the parameter.
    pub row: usize,
    /// Index of the texture.
    pub texture: u32,
    /// Channel to use for a number; if `None`, the channel of the texture's mapping is used, or red
    /// if that has none.
    pub channel: Option<Channel>,
}

/// Principled material for path tracing, with all textures, spectra and tables loaded.
#[derive(Clone, Debug, PartialEq)]
pub struct Principled {
    /// Material as written in the scene.
    pub definition: PrincipledMaterial,
    /// Textures.
    pub maps: MaterialTextures,
    /// Parameters before any textures are applied.
    pub parameters: Parameters,
    /// Precomputed reflectances of the material's interfaces.
    pub tables: Tables,
    /// Spectrum of the light that the material emits, if the scene specifies one.
    pub illuminant: Option<Arc<Curve>>,
    /// Interior medium, if it absorbs or scatters.
    pub medium: Option<Medium>,
    /// True if the surface has no effect when the indices of refraction on both sides are equal, as
    /// is the case for smoke.
    pub interface: bool,
}

impl Principled {
    /// Returns true if some layer of the material reflects or refracts light into a single
    /// direction. Roughness textures are ignored.
    pub fn has_delta_lobes(&self) -> bool {
        let m = &self.definition;
        let smooth = |roughness: f32| Ggx::new(roughness, 0.0).is_smooth();
        let skin = self.parameters.specular_roughness <= 0.0 || smooth(self.parameters.specular_roughness);
        skin && !self.interface || m.coat_weight > 0.0 && smooth(m.coat_roughness)
    }
}

/// Light emitted by the surfaces of a principled material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Emission {
    /// Radiance before any texture is applied.
    pub radiance: Color,
    /// True if the radiance is multiplied by a texture or by vertex colours.
    pub textured: bool,
    /// True if both sides emit light, false if only the side to which the normal points does.
    pub two_sided: bool,
}

/// Phong material after the dialect's rules were applied; for principled materials and hair, it is
/// an approximation for the Whitted integrator.
#[derive(Clone, Debug, PartialEq)]
pub struct Phong {
    /// Diffuse reflectance before texture and noise are applied.
    pub diffuse: Color,
    /// Index of the texture that replaces the diffuse colour, or multiplies it if `tinted`.
    pub texture: Option<u32>,
    /// True if textures and vertex colours multiply the diffuse colour, as in principled materials.
    pub tinted: bool,
    /// Noise that replaces the diffuse colour.
    pub noise: Option<ColorNoise>,
    /// Ambient reflectance; `None` if it equals the diffuse reflectance, including texture and
    /// noise.
    pub ambient: Option<Color>,
    /// Colour, exponent and formula of the highlight, if there is one.
    pub highlight: Option<(Color, f32, HighlightModel)>,
    /// Weight of the reflected ray.
    pub reflective: Color,
    /// Weight of the transmitted ray.
    pub transparent: Color,
    /// Index of refraction.
    pub ior: f32,
    /// True if the light is split between the two rays according to Fresnel's equations.
    pub fresnel: bool,
    /// Principled material, which path tracing uses instead of this one.
    pub principled: Option<Arc<Principled>>,
    /// Hair fibre, which path tracing uses instead of this material.
    pub fibre: Option<Arc<Fibre>>,
    /// Emission, which is rendered only by path tracing.
    pub emission: Option<Emission>,
}

impl Phong {
    /// Returns true if paths can enter objects made of this material.
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

/// One of the materials at a surface point, with its share in the mixture.
#[derive(Clone, Copy, Debug)]
pub struct WeightedMaterial<'w> {
    /// The material.
    pub phong: &'w Phong,
    /// Share of the material; the shares of all materials at a point sum to 1.
    pub share: f32,
}

/// Materials at a surface point, usually only one, with their shares.
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
