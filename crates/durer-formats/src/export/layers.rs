//! Materials of the course as principled materials, for formats whose materials have layers.

use durer_scene::material::{PhongMaterial, PrincipledMaterial};
use durer_scene::math::{Vec3, fp};

/// Approximates a Phong material with OpenPBR. A sharp highlight becomes a low roughness, a strong
/// mirror becomes a metal, and a transparent material becomes glass.
pub(crate) fn principled_of_phong(phong: &PhongMaterial) -> PrincipledMaterial {
    let diffuse = phong.diffuse_color.unwrap_or(Vec3::ONE);
    let sharp = phong.exponent.or(phong.shininess).filter(|_| phong.specular_color != Vec3::ZERO);
    // Source: Walter and others, *Microfacet Models for Refraction through Rough Surfaces*, 2007,
    // with alpha² = 2 / (n + 2).
    let roughness = sharp.map_or(1.0, |sharp| fp::pow(2.0 / (sharp + 2.0), 0.25));
    let mut m = PrincipledMaterial {
        base_color: diffuse,
        base_color_texture: phong.texture.clone(),
        specular_roughness: roughness,
        specular_weight: if sharp.is_some() || phong.reflective_color != Vec3::ZERO { 1.0 } else { 0.0 },
        ..PrincipledMaterial::default()
    };
    let mirror = phong.reflective_color.max_element();
    if mirror > 0.0 {
        m.specular_roughness = 0.0;
        if mirror > diffuse.max_element() {
            (m.base_metalness, m.base_color) = (1.0, phong.reflective_color);
        }
    }
    let glass = phong.refraction_index.filter(|index| *index > 0.0);
    if glass.is_some() || phong.transparent_color != Vec3::ZERO {
        m.specular_ior = glass.or(phong.index_of_refraction).unwrap_or(1.5);
        let through = if glass.is_some() { Vec3::ONE } else { phong.transparent_color };
        m.transmission_weight = through.max_element().min(1.0);
        (m.transmission_color, m.base_metalness, m.specular_roughness) = (through, 0.0, 0.0);
    }
    m
}
