//! The layers of a principled material as lobes: fuzz on a coat on metal, glass or matte.
//!
//! Light that a layer gives back does not reach the one below: layers are weighed by what is left of it in the direction from
//! which they are seen. OpenPBR calls that albedo scaling. It keeps energy, but the whole is not reciprocal.

use super::albedo::{self, Dielectric};
use super::lobe::diffuse::Diffuse;
use super::lobe::fuzz::Fuzz;
use super::lobe::glass::{Mirror, Refraction, Through};
use super::lobe::rough::{Facet, Rough};
use super::lobe::rough_glass::RoughGlass;
use super::microfacet::Ggx;
use super::{Bsdf, fresnel};
use crate::material::PrincipledMaterial;
use crate::material::principled::Walls;
use crate::math::{Color, Vec3, fp};
use std::sync::Arc;

/// What of a principled material may differ from point to point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layers {
    /// The colour of the base.
    pub base_color: Color,
    /// From 0 (glass or matte) to 1 (metal).
    pub metalness: f32,
    /// From 0 (a mirror) to 1.
    pub roughness: f32,
}

impl Layers {
    /// The same everywhere.
    pub fn of(material: &PrincipledMaterial) -> Self {
        Layers {
            base_color: material.base_weight * material.base_color,
            metalness: material.base_metalness,
            roughness: material.specular_roughness,
        }
    }
}

/// What is worked out once for each material.
#[derive(Clone, Debug, PartialEq)]
pub struct Tables {
    /// The boundary of an opaque base.
    opaque: Arc<Dielectric>,
    /// The boundary of glass.
    glass: Arc<Dielectric>,
    /// The coat's boundary.
    coat: Arc<Dielectric>,
}

impl Tables {
    /// For a material. `known` has what was worked out before.
    pub fn new(material: &PrincipledMaterial, known: &mut Vec<Arc<Dielectric>>) -> Self {
        let mut of = |ior: f32| {
            let found = known.iter().find(|tables| tables.ior == ior).cloned();
            found.unwrap_or_else(|| {
                known.push(Arc::new(Dielectric::new(ior)));
                known[known.len() - 1].clone()
            })
        };
        Tables {
            opaque: of(opaque_ior(material)),
            glass: of(material.specular_ior),
            coat: of(if material.coat_weight > 0.0 { material.coat_ior } else { material.specular_ior }),
        }
    }
}

/// The index of an opaque base: `specularWeight` scales what reflects at right angles.
fn opaque_ior(material: &PrincipledMaterial) -> f32 {
    if material.specular_weight == 1.0 {
        return material.specular_ior;
    }
    let ratio = (material.specular_ior - 1.0) / (material.specular_ior + 1.0);
    fresnel::ior_of_reflectance(material.specular_weight * ratio * ratio)
}

fn power(base: Color, exponent: f32) -> Color {
    base.max(Vec3::ZERO).map(|x| fp::pow(x, exponent))
}

fn mix(a: f32, b: f32, share: f32) -> f32 {
    a + share * (b - a)
}

/// The lobes of what is there of a material, as they are seen from a local direction: from `inside` it or from outside. `eta` is the index behind
/// the boundary over that before it.
pub fn scattering(
    material: &PrincipledMaterial,
    layers: &Layers,
    tables: &Tables,
    wo: Vec3,
    inside: bool,
    eta: f32,
) -> Bsdf {
    let mut bsdf = Bsdf::default();
    let mu = wo.z;
    let mut below = Color::ONE;
    if material.fuzz_weight > 0.0 && !inside {
        let roughness = material.fuzz_roughness;
        let given = albedo::fuzz(mu, roughness);
        // Fibres at grazing angles would give back more than they get.
        let scale = material.fuzz_weight * (1.0 / given).min(1.0);
        bsdf.push(Fuzz { roughness }, below * scale * material.fuzz_color, scale * given);
        below *= 1.0 - scale * given;
    }
    let mut roughness = layers.roughness;
    if material.coat_weight > 0.0 && !inside {
        let weight = material.coat_weight;
        let given = boundary(&mut bsdf, &tables.coat, material.coat_roughness, wo, weight * below);
        below *= 1.0 - weight * given;
        below *= Vec3::ONE.lerp(coat(material, layers, mu), weight);
        let fourth = |r: f32| r * r * r * r;
        let both = (fourth(roughness) + 2.0 * fourth(material.coat_roughness)).min(1.0);
        roughness = mix(roughness, both.sqrt().sqrt(), weight);
    }
    metal(&mut bsdf, material, layers, roughness, wo, below * layers.metalness);
    let dielectric = below * (1.0 - layers.metalness);
    let through = dielectric * material.transmission_weight;
    if through.max_element() > 0.0 {
        match material.walls {
            Walls::Solid => glass(&mut bsdf, material, tables, roughness, wo, (inside, eta), through),
            Walls::Thin => sheet(&mut bsdf, material, roughness, wo, through),
        }
    }
    let opaque = dielectric * (1.0 - material.transmission_weight);
    if opaque.max_element() > 0.0 {
        let given = boundary(&mut bsdf, &tables.opaque, roughness, wo, opaque * material.specular_color);
        let diffuse = Diffuse { color: layers.base_color, roughness: material.base_diffuse_roughness };
        let weight = opaque * (1.0 - given);
        bsdf.push(diffuse, weight, (weight * layers.base_color).max_element());
    }
    bsdf
}

/// The reflection of a boundary of dielectrics seen from outside; returns its albedo.
fn boundary(bsdf: &mut Bsdf, tables: &Dielectric, roughness: f32, wo: Vec3, weight: Color) -> f32 {
    let ggx = Ggx::new(roughness, 0.0);
    if ggx.is_smooth() {
        let given = fresnel::dielectric(wo.z, tables.ior);
        bsdf.push(Mirror, weight * given, weight.max_element() * given);
        return given;
    }
    let given = tables.reflected(false, wo.z, roughness);
    let rough = Rough { ggx: ggx.clamped(), facet: Facet::Dielectric(tables.ior), behind: false };
    bsdf.push(rough, weight * tables.gain(false, wo.z, roughness), weight.max_element() * given);
    given
}

/// What a coat takes of the light on its way down and up, and what it throws back down.
fn coat(material: &PrincipledMaterial, layers: &Layers, mu: f32) -> Color {
    let eta = material.coat_ior;
    let inside = (1.0 - (1.0 - mu * mu) / (eta * eta)).max(0.01).sqrt();
    // Down at right angles, on the mean; up as it is seen.
    let tint = power(material.coat_color, 0.5 + 0.5 / inside);
    let roughness = mix(1.0, layers.roughness, layers.metalness);
    let thrown_back = mix(fresnel::dielectric(mu, eta), fresnel::diffuse(1.0 / eta), roughness);
    let base = Vec3::lerp(layers.base_color, Vec3::ONE, (1.0 - layers.metalness) * material.transmission_weight);
    let darker = (1.0 - thrown_back) / (Vec3::ONE - base.clamp(Vec3::ZERO, Vec3::ONE) * thrown_back);
    tint * Vec3::ONE.lerp(darker, material.coat_darkening)
}

fn metal(bsdf: &mut Bsdf, m: &PrincipledMaterial, layers: &Layers, roughness: f32, wo: Vec3, weight: Color) {
    if weight.max_element() <= 0.0 {
        return;
    }
    let f82 = fresnel::F82::new(layers.base_color, m.specular_color);
    let ggx = Ggx::new(roughness, m.specular_anisotropy);
    let weight = weight * m.specular_weight.min(1.0);
    if ggx.is_smooth() {
        let reflected = weight * f82.at(wo.z);
        return bsdf.push(Mirror, reflected, reflected.max_element());
    }
    let given = albedo::ggx(wo.z, roughness);
    // What is reflected again is coloured again.
    let again = Vec3::ONE + layers.base_color * ((1.0 - given) / given);
    let rough = Rough { ggx: ggx.clamped(), facet: Facet::Metal(f82), behind: false };
    bsdf.push(rough, weight * again, (weight * f82.at(wo.z)).max_element());
}

fn glass(
    bsdf: &mut Bsdf,
    m: &PrincipledMaterial,
    tables: &Tables,
    roughness: f32,
    wo: Vec3,
    (inside, eta): (bool, f32),
    weight: Color,
) {
    // With a depth the body has the colour, and not its skin.
    let tint = if m.transmission_depth > 0.0 { Vec3::ONE } else { m.transmission_color };
    if eta == 1.0 {
        return bsdf.push(Through, weight * tint, weight.max_element());
    }
    let ggx = Ggx::new(roughness, m.specular_anisotropy);
    if ggx.is_smooth() {
        let reflected = fresnel::dielectric(wo.z, eta);
        bsdf.push(Mirror, weight * m.specular_color * reflected, weight.max_element() * reflected);
        bsdf.push(Refraction { eta }, weight * tint * (1.0 - reflected), weight.max_element() * (1.0 - reflected));
        return;
    }
    let rough = RoughGlass { ggx: ggx.clamped(), eta, reflected: m.specular_color, transmitted: tint };
    bsdf.push(rough, weight * tables.glass.gain(inside, wo.z, roughness), weight.max_element());
}

/// A thin sheet: light is reflected to and fro in it, and leaves it in the direction in which it came.
fn sheet(bsdf: &mut Bsdf, m: &PrincipledMaterial, roughness: f32, wo: Vec3, weight: Color) {
    let (eta, ggx) = (m.specular_ior, Ggx::new(roughness, m.specular_anisotropy));
    let reflected = fresnel::slab(wo.z, eta);
    let (up, down) = (weight * m.specular_color, weight * m.transmission_color);
    let shares = (weight.max_element() * reflected, weight.max_element() * (1.0 - reflected));
    if ggx.is_smooth() {
        bsdf.push(Mirror, up * reflected, shares.0);
        return bsdf.push(Through, down * (1.0 - reflected), shares.1);
    }
    let gain = 1.0 / albedo::ggx(wo.z, roughness);
    let rough = |facet, behind| Rough { ggx: ggx.clamped(), facet, behind };
    bsdf.push(rough(Facet::Slab(eta), false), up * gain, shares.0);
    bsdf.push(rough(Facet::BehindSlab(eta), true), down * gain, shares.1);
}
