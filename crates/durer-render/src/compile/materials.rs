//! Compilation of materials. The dialect determines the meaning of material parameters.

use super::files::Loader;
use super::media;
use super::rules::matrix_rules;
use crate::world::{Emission, HighlightModel, Material, Phong, Principled};
use durer_diag::Diagnostics;
use durer_scene::bsdf::Tables;
use durer_scene::bsdf::lobe::hair::Fibre;
use durer_scene::dialect::{DialectRules, Highlight, Quirk, SecondaryRays};
use durer_scene::material::principled::{Switch, Walls};
use durer_scene::material::{ColorNoise, Parameters, PatternMaterial, PhongMaterial, PrincipledMaterial};
use durer_scene::math::Color;
use durer_scene::scene::{self, MatrixOp, Scene};
use std::sync::Arc;

/// Compiles the materials of a scene and loads their textures and spectra.
pub(super) fn compile(
    scene: &Scene,
    rules: &DialectRules,
    loader: &mut Loader,
    diagnostics: &mut Diagnostics,
) -> Vec<Material> {
    loader.decode_ahead(scene.materials.iter().filter_map(|material| match &material.value {
        scene::Material::Principled(layers) => Some(&**layers),
        _ => None,
    }));
    // Materials with the same index of refraction share their lookup tables.
    let mut tables = Vec::new();
    let mut one = |material: &scene::Spanned<scene::Material>| match &material.value {
        scene::Material::Solid(solid, ops) => {
            let to_pattern = MatrixOp::product(ops, matrix_rules(rules));
            let picture = match solid {
                PatternMaterial::Mix(mix) => {
                    mix.share_texture.as_ref().and_then(|name| loader.number_map(name, diagnostics))
                }
                _ => None,
            };
            Material::Mix(solid.clone(), to_pattern, picture)
        }
        scene::Material::Principled(layers) => {
            let maps = loader.maps(layers, diagnostics);
            let measured = layers.base_spectrum.as_ref().and_then(|name| loader.reflectance(name, diagnostics));
            let illuminant = layers.emission_spectrum.as_ref().and_then(|name| loader.illuminant(name, diagnostics));
            let base_color = measured.as_ref().map_or(layers.base_color, |curve| curve.color());
            let layers = &PrincipledMaterial { base_color, ..(**layers).clone() };
            let shown = illuminant.as_ref().map_or(Color::ONE, |curve| curve.color());
            let radiance = layers.emission_luminance * layers.emission_color * shown;
            let textured = maps.emission.is_some() || layers.emission_vertex_colors == Switch::On;
            let medium = media::inside(layers, loader, diagnostics);
            let tables = Tables::new(layers, measured, &mut tables);
            tables.prepare(layers);
            let emission = Emission { radiance, textured, two_sided: layers.walls == Walls::Thin };
            Material::Phong(Phong {
                texture: maps.base_color,
                tinted: true,
                emission: (radiance.max_element() > 0.0).then_some(emission),
                principled: Some(Arc::new(Principled {
                    definition: layers.clone(),
                    maps,
                    parameters: Parameters::of(layers),
                    tables,
                    illuminant,
                    medium,
                    interface: media::is_interface(layers),
                })),
                ..plain(layers)
            })
        }
        scene::Material::Hair(hair) => {
            let fibre = Fibre::new(hair);
            // Approximate highlight for the Whitted integrator.
            let highlight = Some((Color::splat(0.2), 20.0, HighlightModel::Blinn));
            let diffuse = fibre.color();
            Material::Phong(Phong { diffuse, highlight, fibre: Some(Arc::new(fibre)), ..Phong::default() })
        }
        scene::Material::Phong(phong, noise) => {
            let texture = phong.texture.as_ref().and_then(|name| loader.texture(name, diagnostics));
            Material::Phong(phong_of(phong, noise.clone(), texture, rules))
        }
    };
    scene.materials.iter().map(&mut one).collect()
}

/// Compiles a Phong material, whose parameters are interpreted according to the dialect.
fn phong_of(m: &PhongMaterial, noise: Option<ColorNoise>, texture: Option<u32>, rules: &DialectRules) -> Phong {
    let (reflective, transparent, ior) = secondary(m, rules);
    let diffuse = m.diffuse_color.unwrap_or(Color::ONE);
    let ambient = match m.diffuse_color {
        None if rules.has(Quirk::WrittenAmbient) => Some(Color::ZERO),
        _ => (!rules.ambient_textured).then_some(diffuse),
    };
    Phong {
        diffuse,
        texture,
        tinted: false,
        noise,
        ambient,
        // With a normal longer than 1, the highlight can become infinite, and infinity times 0 is
        // NaN.
        highlight: highlight(m, rules).filter(|(color, ..)| rules.has(Quirk::RawNormals) || *color != Color::ZERO),
        reflective,
        transparent,
        ior: ior.unwrap_or(1.0),
        fresnel: ior.is_some() && glass(m, rules).is_some(),
        principled: None,
        fibre: None,
        emission: None,
    }
}

/// Approximates a principled material for the Whitted integrator. The result has a matte base and a
/// highlight as wide as that of GGX. Metals become mirrors, and transmissive materials become
/// glass.
fn plain(m: &PrincipledMaterial) -> Phong {
    let base = m.base_weight * m.base_color;
    let matte = (1.0 - m.base_metalness) * (1.0 - m.transmission_weight);
    // Exponent for which the Blinn highlight has the same width at its peak. Source: Walter and
    // others, *Microfacet Models for Refraction*, 2007.
    let alpha = (m.specular_roughness * m.specular_roughness).max(1e-3);
    let exponent = (2.0 / (alpha * alpha) - 2.0).max(1.0);
    let ratio = (m.specular_ior - 1.0) / (m.specular_ior + 1.0);
    let at_right_angles = m.specular_weight * ratio * ratio * m.specular_color;
    let reflects = at_right_angles.lerp(base, m.base_metalness);
    let smooth = 1.0 - m.specular_roughness;
    let glass = m.transmission_weight > 0.0;
    Phong {
        diffuse: matte * base,
        highlight: (reflects != Color::ZERO).then_some((reflects, exponent, HighlightModel::Blinn)),
        reflective: if glass { m.specular_color } else { smooth * m.base_metalness * base },
        transparent: m.transmission_weight * m.transmission_color,
        // A thin sheet does not refract light.
        ior: if m.walls == Walls::Thin { 1.0 } else { m.specular_ior },
        fresnel: glass && m.walls == Walls::Solid,
        ..Phong::default()
    }
}

/// Returns the colour, exponent and formula of the highlight, if the material has one in this
/// dialect.
fn highlight(m: &PhongMaterial, rules: &DialectRules) -> Option<(Color, f32, HighlightModel)> {
    let blinn = |exponent: f32| Some((m.specular_color, exponent, HighlightModel::Blinn));
    let phong = |shininess: f32| {
        let behind = rules.has(Quirk::HighlightBehind);
        Some((m.specular_color, shininess, HighlightModel::Phong { behind }))
    };
    match (rules.highlight, m.exponent, m.shininess) {
        (Highlight::None, ..) => None,
        (Highlight::Blinn, exponent, shininess) => blinn(exponent.or(shininess).unwrap_or(1.0)),
        (Highlight::Phong, exponent, shininess) => {
            let shininess = shininess.or(exponent).unwrap_or(0.0);
            // A shininess of 0 means that there is no highlight, except in programs that evaluate
            // `pow(0, 0)` as 1.
            if shininess > 0.0 || rules.has(Quirk::PowZero) { phong(shininess) } else { None }
        }
        (Highlight::ByKeyword, Some(exponent), _) => blinn(exponent),
        (Highlight::ByKeyword, None, Some(shininess)) => phong(shininess).filter(|_| shininess > 0.0),
        (Highlight::ByKeyword, None, None) => blinn(1.0),
    }
}

/// Returns the index of refraction if the dialect renders the material as glass with Fresnel
/// reflection. Otherwise, returns `None`.
fn glass(m: &PhongMaterial, rules: &DialectRules) -> Option<f32> {
    let divides = matches!(rules.secondary, SecondaryRays::SpecularFresnel | SecondaryRays::ByKeyword);
    m.refraction_index.filter(|index| divides && *index > 0.0)
}

/// Returns the weights of the reflected and the transmitted ray and the index of refraction.
fn secondary(m: &PhongMaterial, rules: &DialectRules) -> (Color, Color, Option<f32>) {
    let specular = m.specular_color;
    match (rules.secondary, glass(m, rules)) {
        (SecondaryRays::None, _) => (Color::ZERO, Color::ZERO, None),
        (SecondaryRays::Specular, _) | (SecondaryRays::SpecularFresnel, None) => (specular, Color::ZERO, None),
        (SecondaryRays::SpecularFresnel, index) => (specular, specular, index),
        (SecondaryRays::ByKeyword, Some(index)) => {
            let tint = if m.transparent_color == Color::ZERO { specular } else { m.transparent_color };
            (specular, tint, Some(index))
        }
        (SecondaryRays::Colors | SecondaryRays::ByKeyword, _) => {
            (m.reflective_color, m.transparent_color, m.index_of_refraction)
        }
    }
}
