//! Represents the lobes of pbrt-v3's materials as OpenPBR parameters, and adds lobes.
//!
//! A sum becomes a mix in which each part is multiplied by the inverse of its share.

use super::super::defs::MaterialDef;
use super::super::state::Reader;
use super::matte;
use super::rough::Roughness;
use durer_diag::Span;
use durer_scene::bsdf::fresnel::schlick_82;
use durer_scene::describe::FileName;
use durer_scene::material::PrincipledMaterial;
use durer_scene::material::principled::Surroundings;
use durer_scene::math::{Color, Vec3};

/// One summand of a pbrt-v3 material: one or more lobes as an OpenPBR material.
pub(super) struct Lobe {
    pub layers: PrincipledMaterial,
    /// Maximum reflectance of the part, which determines its share of the mix.
    pub max_reflectance: f32,
}

/// Returns a rough specular boundary over a black base.
pub(super) fn glossy((color, picture): (Color, Option<FileName>), ior: f32, rough: &Roughness) -> PrincipledMaterial {
    let mut m = matte(Vec3::ZERO);
    (m.specular_weight, m.specular_ior) = (1.0, ior);
    (m.specular_color, m.specular_color_texture) = (color, picture);
    rough.apply(&mut m);
    m
}

/// Returns the colour and roughness of an energy-preserving rough diffuse lobe that has the same
/// mean albedo as the Oren–Nayar model.
///
/// Source: Oren and Nayar, *Generalization of Lambert's Reflectance Model*, SIGGRAPH 1994.
pub(super) fn oren_nayar(color: Color, degrees: f32) -> (Color, f32) {
    // Cosine-weighted mean of max(0, cos) sin tan over both directions, which is 2/3 - 64 / (45
    // pi).
    const LEANING: f32 = 0.213_954;
    let sigma = degrees.to_radians();
    let variance = sigma * sigma;
    let (a, b) = (1.0 - 0.5 * variance / (variance + 0.33), 0.45 * variance / (variance + 0.09));
    let roughness = (b / a).clamp(0.0, 1.0);
    // Mean albedo of single scattering and of multiple scattering, as in `bsdf::lobe::diffuse`.
    let mean = (1.0 + 0.072_488 * roughness) / (1.0 + 0.287_793 * roughness);
    let whole = |c: f32| c * mean + c * c * mean * (1.0 - mean) / (1.0 - c * (1.0 - mean));
    let solved = color.map(|wanted| {
        let wanted = wanted.min(1.0) * (a + LEANING * b);
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..24 {
            let middle = 0.5 * (low + high);
            if whole(middle) < wanted { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    });
    (solved, roughness)
}

/// Returns a metal with the given reflectances at normal incidence and at 82 degrees.
pub(super) fn metallic(f0: Color, f82: Color, rough: &Roughness) -> PrincipledMaterial {
    let mut m = PrincipledMaterial {
        base_metalness: 1.0,
        base_color: f0,
        specular_color: f82 / schlick_82(f0).max(Vec3::splat(1e-6)),
        ..PrincipledMaterial::default()
    };
    rough.apply(&mut m);
    m
}

/// Returns solid glass, which is smooth if `rough` is `None`.
pub(super) fn glass(
    (reflected, reflected_picture): (Color, Option<FileName>),
    (through, through_picture): (Color, Option<FileName>),
    index: f32,
    rough: Option<&Roughness>,
) -> PrincipledMaterial {
    let mut m = PrincipledMaterial {
        transmission_weight: 1.0,
        transmission_color: through,
        transmission_color_texture: through_picture,
        specular_color: reflected,
        specular_color_texture: reflected_picture,
        specular_ior: index,
        surroundings: Surroundings::Ignored,
        specular_roughness: 0.0,
        ..PrincipledMaterial::default()
    };
    rough.into_iter().for_each(|rough| rough.apply(&mut m));
    m
}

impl Reader<'_> {
    /// Returns a material that scatters light like the sum of the given parts.
    pub(super) fn sum(&mut self, parts: Vec<Lobe>, at: Span) -> MaterialDef {
        // Keep the opacity, because even a black material can be partly transparent.
        let opacity =
            parts.first().map_or((1.0, None), |part| (part.layers.opacity, part.layers.opacity_texture.clone()));
        let black = PrincipledMaterial { opacity: opacity.0, opacity_texture: opacity.1, ..matte(Vec3::ZERO) };
        let mut parts: Vec<Lobe> = parts.into_iter().filter(|part| part.max_reflectance > 0.0).collect();
        let whole: f32 = parts.iter().map(|part| part.max_reflectance).sum();
        let Some(last) = parts.pop() else { return MaterialDef::Principled(Box::new(black), at) };
        if parts.is_empty() {
            return MaterialDef::Principled(Box::new(last.layers), at);
        }
        let layers = |part: Lobe| {
            let (mut m, factor) = (part.layers, whole / part.max_reflectance);
            for color in [&mut m.base_color, &mut m.specular_color, &mut m.transmission_color, &mut m.subsurface_color]
            {
                *color *= factor;
            }
            MaterialDef::Principled(Box::new(m), at)
        };
        let mut rest = last.max_reflectance;
        let mut material = layers(last);
        while let Some(part) = parts.pop() {
            let share = part.max_reflectance / (part.max_reflectance + rest);
            rest += part.max_reflectance;
            let numbers = [layers(part), material].map(|material| {
                self.materials.push(material);
                self.materials.len() - 1
            });
            material = self.mix(numbers, share, at);
        }
        material
    }
}
