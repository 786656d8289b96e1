//! The material of physically based pictures: layers with the names and meanings of OpenPBR Surface 1.1.
//!
//! Source: *OpenPBR Surface specification*, version 1.1, Academy Software Foundation, 2024.

use crate::describe::{FileName, Rule};
use crate::dialect::set;
use crate::math::Vec3;
use crate::{described, described_words};

described_words! {
    /// Whether a surface is a thin sheet or bounds a body.
    Walls { Solid = "solid", Thin = "thin" }
}

described! {
    /// A material of layers: fuzz on a coat on metal, glass or matte. Names and meanings are those of OpenPBR Surface.
    PrincipledMaterial ["PrincipledMaterial" in set::DURER] {
        /// Strength of the base, from 0 to 1: of the matte colour and of the metal's.
        base_weight: f32 = 1.0, optional, Rule::Share, ["baseWeight" in set::DURER];
        /// Share of light that the matte base scatters, and what a metal reflects at right angles; from 0 to 1.
        base_color: Vec3 = Vec3::splat(0.8), optional, Rule::Any, ["baseColor" in set::DURER];
        /// A picture that multiplies `baseColor`; its values are read as sRGB, and its alpha multiplies `opacity`.
        base_color_texture: Option<FileName> = None, optional, Rule::Any, ["baseColorTexture" in set::DURER];
        /// How rough the matte base is, from 0 (Lambert) to 1.
        base_diffuse_roughness: f32 = 0.0, optional, Rule::Share, ["baseDiffuseRoughness" in set::DURER];
        /// From 0 (glass or matte) to 1 (metal).
        base_metalness: f32 = 0.0, optional, Rule::Share, ["baseMetalness" in set::DURER];
        /// Strength of the reflection, from 0 to 1 or more: it scales what reflects at right angles.
        specular_weight: f32 = 1.0, optional, Rule::NonNegative, ["specularWeight" in set::DURER];
        /// Tint of the reflection; on metal the colour near grazing angles.
        specular_color: Vec3 = Vec3::ONE, optional, Rule::Any, ["specularColor" in set::DURER];
        /// How rough the surface is, from 0 (a mirror) to 1; its square is GGX's alpha.
        specular_roughness: f32 = 0.3, optional, Rule::Share, ["specularRoughness" in set::DURER];
        /// A picture whose green multiplies `specularRoughness` and whose blue multiplies `baseMetalness`.
        metallic_roughness_texture: Option<FileName> = None, optional, Rule::Any,
            ["metallicRoughnessTexture" in set::DURER];
        /// How much longer than wide the highlight is, from 0 (round) to 1.
        specular_anisotropy: f32 = 0.0, optional, Rule::Share, ["specularAnisotropy" in set::DURER];
        /// Turns the highlight about the normal, in whole turns, from the direction in which u grows.
        specular_rotation: f32 = 0.0, optional, Rule::Any, ["specularRotation" in set::DURER];
        /// Index of refraction inside.
        specular_ior: f32 = 1.5, optional, Rule::Positive, ["specularIor" in set::DURER];
        /// From 0 (matte) to 1 (glass).
        transmission_weight: f32 = 0.0, optional, Rule::Share, ["transmissionWeight" in set::DURER];
        /// Colour of light that went `transmissionDepth` deep; where that is 0, of all that passes the surface.
        transmission_color: Vec3 = Vec3::ONE, optional, Rule::Any, ["transmissionColor" in set::DURER];
        /// How deep light goes until it has `transmissionColor`, in units of the world; 0: the surface tints it.
        transmission_depth: f32 = 0.0, optional, Rule::NonNegative, ["transmissionDepth" in set::DURER];
        /// Strength of the clear coat, from 0 to 1.
        coat_weight: f32 = 0.0, optional, Rule::Share, ["coatWeight" in set::DURER];
        /// Colour of what passes the coat down and up again at right angles.
        coat_color: Vec3 = Vec3::ONE, optional, Rule::Any, ["coatColor" in set::DURER];
        /// How rough the coat is, from 0 to 1.
        coat_roughness: f32 = 0.0, optional, Rule::Share, ["coatRoughness" in set::DURER];
        /// Index of refraction of the coat.
        coat_ior: f32 = 1.6, optional, Rule::Positive, ["coatIor" in set::DURER];
        /// How much a coat darkens what it covers by reflecting light back down, from 0 to 1 (as physics has it).
        coat_darkening: f32 = 1.0, optional, Rule::Share, ["coatDarkening" in set::DURER];
        /// Strength of the fuzz on top, as of velvet or dust, from 0 to 1.
        fuzz_weight: f32 = 0.0, optional, Rule::Share, ["fuzzWeight" in set::DURER];
        /// Colour of the fuzz.
        fuzz_color: Vec3 = Vec3::ONE, optional, Rule::Any, ["fuzzColor" in set::DURER];
        /// How rough the fuzz is, from 0 to 1.
        fuzz_roughness: f32 = 0.5, optional, Rule::Share, ["fuzzRoughness" in set::DURER];
        /// How bright the surface shines, in cd/m^2; a pixel of value 1 shows 1 cd/m^2.
        emission_luminance: f32 = 0.0, optional, Rule::NonNegative, ["emissionLuminance" in set::DURER];
        /// Colour of its own light, which multiplies `emissionLuminance`.
        emission_color: Vec3 = Vec3::ONE, optional, Rule::Any, ["emissionColor" in set::DURER];
        /// A picture that multiplies `emissionColor`; its values are read as sRGB.
        emission_texture: Option<FileName> = None, optional, Rule::Any, ["emissionTexture" in set::DURER];
        /// A picture of normals in tangent space, as glTF has it: red and green point along u and v, blue outwards.
        normal_texture: Option<FileName> = None, optional, Rule::Any, ["normalTexture" in set::DURER];
        /// Share of the surface that is there, from 0 to 1: the rest lets light through as if nothing were there.
        opacity: f32 = 1.0, optional, Rule::Share, ["opacity" in set::DURER];
        /// `thin`: a sheet without inside, through which light goes straight; `solid`: the skin of a body.
        walls: Walls = Walls::Solid, optional, Rule::Any, ["walls" in set::DURER];
    }
}
