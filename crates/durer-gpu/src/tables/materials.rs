//! Materials in the layout that shaders read.

use super::rows;
use crate::layout::{self, ALBEDO_ROWS, AlbedoRow, MAX_LOBES, MAX_PARTS, Material};
use bytemuck::Zeroable as _;
use durer_render::world::{self, HighlightModel, Phong, Principled};
use durer_scene::bsdf::albedo;
use durer_scene::bsdf::microfacet::Ggx;
use durer_scene::material::principled::Switch;
use durer_scene::material::{Pattern as _, PatternMaterial};
use durer_scene::math::Color;

/// Largest number of lobes of a material: metal, the two of glass, and the two of an opaque base.
const LOBES_PER_PART: u32 = 5;
const _: () = assert!(MAX_PARTS * LOBES_PER_PART <= MAX_LOBES);

/// Converts a material. A principled material adds its table of albedos to `albedos`.
pub(super) fn material(material: &world::Material, albedos: &mut Vec<AlbedoRow>) -> Material {
    match material {
        world::Material::Phong(phong) => match &phong.principled {
            Some(principled) => with_principled(phong_material(phong), principled, albedos),
            None => phong_material(phong),
        },
        world::Material::Mix(pattern, to_pattern, _) => {
            let [pattern_x, pattern_y, pattern_z] = rows(*to_pattern);
            let [first, second] = pattern.materials();
            let (kind, share, octaves, [frequency, amplitude]) = match pattern {
                PatternMaterial::Checkerboard(_) => (layout::CHECKERBOARD, 0.0, 0, [0.0; 2]),
                PatternMaterial::TwoSided(_) => (layout::TWO_SIDED, 0.0, 0, [0.0; 2]),
                PatternMaterial::Mix(mix) => (layout::MIX, mix.share, 0, [0.0; 2]),
                PatternMaterial::Noise(noise) => (layout::SOLID_NOISE, 0.0, noise.octaves, [0.0; 2]),
                PatternMaterial::Marble(m) => (layout::MARBLE, 0.0, m.octaves, [m.frequency, m.amplitude]),
                PatternMaterial::Wood(m) => (layout::WOOD, 0.0, m.octaves, [m.frequency, m.amplitude]),
            };
            let pattern = Material { kind, share, first, second, octaves, frequency, amplitude, ..Material::zeroed() };
            Material { pattern_x, pattern_y, pattern_z, ..pattern }
        }
    }
}

fn phong_material(phong: &Phong) -> Material {
    let mut flags = 0;
    let mut set = |flag: u32, on: bool| flags |= if on { flag } else { 0 };
    set(layout::OWN_AMBIENT, phong.ambient.is_some());
    set(layout::HIGHLIGHT, phong.highlight.is_some());
    set(layout::FRESNEL, phong.fresnel);
    let (specular, exponent, model) = phong.highlight.unwrap_or((Color::ZERO, 1.0, HighlightModel::Blinn));
    set(layout::PHONG_HIGHLIGHT, matches!(model, HighlightModel::Phong { .. }));
    set(layout::HIGHLIGHT_BEHIND, matches!(model, HighlightModel::Phong { behind: true }));
    set(layout::EMITS, phong.emission.is_some());
    set(layout::EMITS_BOTH, phong.emission.is_some_and(|emission| emission.two_sided));
    let noise = phong.noise.as_ref();
    set(layout::NOISE, noise.is_some());
    Material {
        kind: layout::PHONG,
        flags,
        octaves: noise.map_or(0, |noise| noise.octaves),
        frequency: noise.map_or(0.0, |noise| noise.frequency),
        amplitude: noise.map_or(0.0, |noise| noise.amplitude),
        second_diffuse: noise.map_or(Color::ZERO, |noise| noise.color2).into(),
        diffuse: noise.map_or(phong.diffuse, |noise| noise.color1).into(),
        ambient: phong.ambient.unwrap_or(Color::ZERO).into(),
        exponent,
        specular: specular.into(),
        ior: phong.ior,
        reflective: phong.reflective.into(),
        transparent: phong.transparent.into(),
        emission: phong.emission.map_or(Color::ZERO, |emission| emission.radiance).into(),
        ..Material::zeroed()
    }
}

/// Returns the material with the parameters that path tracing uses.
fn with_principled(material: Material, principled: &Principled, albedos: &mut Vec<AlbedoRow>) -> Material {
    let (m, boundary) = (&principled.parameters, principled.tables.opaque_boundary());
    let roughness = m.specular_roughness;
    let ggx = Ggx::new(roughness, 0.0);
    let first_albedo = albedos.len() as u32;
    // A mirror needs no table.
    if !ggx.is_smooth() {
        let row = |i: u32| {
            let root = i as f32 / (ALBEDO_ROWS - 1) as f32;
            let cosine = root * root;
            let (reflected, kept) = match boundary.ior == 1.0 {
                true => (0.0, 1.0),
                false => (boundary.reflectance(cosine, roughness), 1.0 / boundary.gain(false, cosine, roughness)),
            };
            let metal = if m.base_metalness > 0.0 { albedo::ggx(cosine, roughness) } else { 1.0 };
            AlbedoRow { values: [reflected, kept, metal, 0.0] }
        };
        albedos.extend((0..ALBEDO_ROWS).map(row));
    }
    let compensates = m.energy_compensation == Switch::On;
    Material {
        flags: material.flags | layout::PRINCIPLED | if compensates { layout::COMPENSATES } else { 0 },
        roughness: m.base_diffuse_roughness,
        base: m.base_color.into(),
        metalness: m.base_metalness,
        tint: m.specular_color.into(),
        facet_alpha: ggx.alpha.x,
        transmission: m.transmission_color.into(),
        transmission_weight: m.transmission_weight,
        boundary_ior: boundary.ior,
        boundary_mean: if boundary.ior == 1.0 { 0.0 } else { boundary.mean(roughness) },
        specular_weight: m.specular_weight,
        first_albedo,
        ..material
    }
}
