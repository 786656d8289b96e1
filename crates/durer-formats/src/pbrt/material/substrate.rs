//! Converts the `substrate` material of pbrt-v3, which is a matte base below a glossy coat.
//!
//! Source: Ashikhmin and Shirley, *An Anisotropic Phong BRDF Model*, Journal of Graphics Tools
//! 5(2), 2000, with the microfacets of *Physically Based Rendering*, 3rd edition, section 8.5.

use super::super::params::Params;
use super::super::state::Reader;
use super::matte;
use super::parts::{Lobe, glossy};
use durer_scene::bsdf::{albedo, fresnel};
use durer_scene::material::PrincipledMaterial;
use durer_scene::math::{Vec3, fp};
use std::f32::consts::TAU;

/// Index of refraction and roughness of the boundary above the base. The light crosses the boundary
/// twice. Within 2 %, the base then reflects (1 - (1 - cos / 2)^5) times its value at normal
/// incidence.
const INDEX: f32 = 0.8;
const ROUGHNESS: f32 = 0.894_427;

/// Mean reflectance of that boundary, and mean factor by which it multiplies the colour of the
/// base.
const REFLECTED: f32 = 0.1514;
const MEAN: f32 = 23.0 / 28.0;

impl Reader<'_> {
    /// Converts `substrate` to a base and a coat, whose reflections are added.
    pub(super) fn substrate(&mut self, params: &Params) -> Vec<Lobe> {
        let rough = self.isotropic_roughness(params, None, true, 0.1);
        let (color, picture) = self.color_or_texture(params, "Kd", 0.5);
        let (specular, specular_picture) = self.color_or_texture(params, "Ks", 0.5);
        let most = specular.max_element();
        let passing = Vec3::ONE - specular.min(Vec3::ONE);
        let base = PrincipledMaterial {
            base_color_texture: picture,
            specular_weight: 1.0,
            specular_color: Vec3::ZERO,
            specular_ior: INDEX,
            specular_roughness: ROUGHNESS,
            ..matte(color * passing * (MEAN / (1.0 - REFLECTED)))
        };
        let base = Lobe { max_reflectance: color.max_element(), layers: base };
        if most <= 0.0 {
            return vec![base];
        }
        let (f0, hue) = (most.min(0.98), specular / most);
        let strength = coat_scale(rough.alphas[0], f0);
        let layers = glossy((strength * hue, specular_picture), fresnel::ior_of_reflectance(f0), &rough);
        // Use the mean reflectance over all directions instead of the reflectance at normal
        // incidence.
        vec![base, Lobe { max_reflectance: f0 + (1.0 - f0) / 21.0, layers }]
    }
}

/// Returns the mean albedo of the coat, divided by the mean albedo of a dielectric microfacet
/// surface with reflectance `f0` at normal incidence.
pub(super) fn coat_scale(alpha: f32, f0: f32) -> f32 {
    const POINTS: u16 = 4096;
    // Source: Roberts, *The Unreasonable Effectiveness of Quasirandom Sequences*, 2018.
    const STEPS: Vec3 = Vec3::new(0.819_172_5, 0.671_043_6, 0.549_700_5);
    let mut blend = 0.0;
    for i in 0..POINTS {
        let u = (Vec3::splat(0.5) + f32::from(i) * STEPS).fract();
        let mu = u.x.max(1e-4).sqrt();
        let wo = Vec3::new((1.0 - mu * mu).max(0.0).sqrt(), 0.0, mu);
        // Sample a microfacet normal with a probability proportional to its density times its
        // cosine.
        let tangent2 = alpha * alpha * u.y / (1.0 - u.y);
        let up = 1.0 / (1.0 + tangent2).sqrt();
        let (sin, cos) = (fp::sin(TAU * u.z), fp::cos(TAU * u.z));
        let across = (1.0 - up * up).max(0.0).sqrt();
        let h = Vec3::new(across * cos, across * sin, up);
        let cosine = wo.dot(h);
        let wi = 2.0 * cosine * h - wo;
        if cosine > 0.0 && wi.z > 0.0 {
            let schlick = f0 + (1.0 - f0) * fp::pow(1.0 - cosine.min(1.0), 5.0);
            blend += schlick * wi.z / (up * wi.z.max(wo.z));
        }
    }
    let eta = fresnel::ior_of_reflectance(f0);
    let reflected = albedo::single_means(eta, alpha.clamp(0.0, 1.0).sqrt())[0];
    // Both albedos exclude light that is blocked by other microfacets.
    if reflected > 0.0 { blend / f32::from(POINTS) / reflected } else { 1.0 }
}
