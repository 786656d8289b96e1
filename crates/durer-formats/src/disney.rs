//! Mean reflectance of Disney's material over all directions, for scene formats that use this
//! material.
//!
//! Disney's diffuse base ignores the Fresnel loss at the boundary and reflects more light when it
//! is rougher. Layers of `openPbr` conserve energy, so readers choose colours that give the same
//! mean reflectance.
//!
//! Source: Burley, *Physically-Based Shading at Disney*, SIGGRAPH 2012, and *Extending the Disney
//! BRDF to a BSDF*, 2015.

use durer_scene::bsdf::albedo::single_means;
use durer_scene::bsdf::fresnel::{ior_of_reflectance, ratio_squared};
use durer_scene::bsdf::lobe::disney;
use durer_scene::material::PrincipledMaterial;
use durer_scene::material::principled::{Layering, Walls};
use durer_scene::math::{Color, LUMINANCE, Vec3, fp};

/// Number of integration steps for each cosine, and for the azimuth between the two directions.
const STEPS: usize = 16;

/// Incident and outgoing directions above a surface, reduced to the cosines that Disney's lobes
/// need.
struct DirectionPair {
    /// Cosines of the angles between the directions and the normal.
    cosines: [f32; 2],
    /// Cosine of half the angle between the two directions.
    half: f32,
}

/// Returns the mean of `value` over all pairs of directions, weighted by their cosines.
fn means(value: impl Fn(&DirectionPair) -> f32) -> f32 {
    let step = |i: usize| (i as f32 + 0.5) / STEPS as f32;
    let mut sum = 0.0;
    for (i, j, k) in (0..STEPS.pow(3)).map(|n| (n % STEPS, n / STEPS % STEPS, n / (STEPS * STEPS))) {
        let cosines @ [a, b] = [step(i), step(j)];
        let [s, t] = cosines.map(|cosine| (1.0 - cosine * cosine).sqrt());
        let between = a * b + s * t * fp::sin_cos_turn(0.5 * step(k)).1;
        // Weight each direction by its cosine, which has a mean of 1/2.
        sum += 4.0 * a * b * value(&DirectionPair { cosines, half: (0.5 + 0.5 * between).max(0.0).sqrt() });
    }
    sum / STEPS.pow(3) as f32
}

/// Returns the reflectance of a white diffuse base of Disney's material.
pub(super) fn diffuse_albedo(roughness: f32) -> f32 {
    means(|pair| disney::diffuse(pair.cosines, pair.half, roughness))
}

/// Returns the fraction of light that crosses Dürer's boundary to a diffuse base and comes back
/// out; it is always greater than 0. The arguments are the same as those of
/// [`boundary_reflectance`].
pub(super) fn boundary_transmittance([reflected, all]: [f32; 2]) -> f32 {
    (1.0 - boundary_reflectance([reflected, all])).max(1e-3)
}

/// Returns the reflectance of Dürer's boundary, computed from [`single_means`]. The result is the
/// single-scattering reflectance divided by the sum of the single-scattering reflectance and
/// transmittance, which is less than 1 for rough boundaries.
pub(super) fn boundary_reflectance([reflected, all]: [f32; 2]) -> f32 {
    // With unphysical indices of refraction, `all` can be 0.
    reflected / all.max(1e-6)
}

/// Converts the base colour of Disney's material to the base colour that Dürer needs below a
/// dielectric boundary.
pub(super) struct DiffuseConverter {
    diffuse_albedo: f32,
    transmittance: f32,
}

impl DiffuseConverter {
    /// Creates a converter for a boundary with the given index of refraction and roughness.
    pub fn new(ior: f32, roughness: f32) -> DiffuseConverter {
        let means = single_means(ior, roughness);
        DiffuseConverter { diffuse_albedo: diffuse_albedo(roughness), transmittance: boundary_transmittance(means) }
    }

    /// Returns the base colour in Dürer that corresponds to a base colour in Disney's material.
    pub fn base(&self, color: Color) -> Color {
        self.diffuse_albedo * color / self.transmittance
    }
}

/// Returns a material whose layers conserve energy and whose mean reflectance is near that of
/// Disney's material `m`, for formats that lack Disney's material. Sheen and flatness are lost.
pub(super) fn as_layers(m: &PrincipledMaterial) -> PrincipledMaterial {
    let mut layers = PrincipledMaterial { layering: Layering::OpenPbr, fuzz_weight: 0.0, ..m.clone() };
    let luminance = m.base_color.dot(LUMINANCE).max(1e-6);
    let tint = Vec3::ONE.lerp(m.base_color / luminance, m.specular_tint);
    layers.specular_color = tint.clamp(Vec3::ZERO, Vec3::ONE);
    // Disney's coat has a quarter of the weight.
    layers.coat_weight = 0.25 * m.coat_weight;
    if m.walls == Walls::Thin {
        layers.base_color = diffuse_albedo(m.specular_roughness) * m.base_color;
        layers.subsurface_color = layers.base_color;
        // Disney's sheet has a single surface.
        let r = ratio_squared(m.specular_ior);
        layers.specular_ior = ior_of_reflectance(r / (2.0 - r));
    } else if m.base_metalness_texture.is_none() {
        let base = DiffuseConverter::new(m.specular_ior, m.specular_roughness).base(m.base_color);
        layers.base_color = m.base_color.lerp(base, 1.0 - m.base_metalness);
    }
    layers
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn matte_base_matches_reference_means() {
        // The cosine-weighted mean of (1 - cos)^5 is 1/21, and the two directions are independent.
        let expected = (1.0_f32 - 0.5 / 21.0) * (1.0 - 0.5 / 21.0);
        assert!((diffuse_albedo(0.0) - expected).abs() < 1e-3, "{}", diffuse_albedo(0.0));
        // Mitsuba 3.9.1 yields 0.7456 for a base of 0.7 at roughness 1, measured with 200,000 pairs
        // of directions.
        assert!((diffuse_albedo(1.0) - 0.7456 / 0.7).abs() < 5e-3, "{}", diffuse_albedo(1.0));
    }

    #[test]
    fn pane_reflects_like_one_surface() {
        let pane = PrincipledMaterial { walls: Walls::Thin, ..PrincipledMaterial::default() };
        let index = as_layers(&pane).specular_ior;
        let root = (index - 1.0) / (index + 1.0);
        let r = root * root;
        assert!((2.0 * r / (1.0 + r) - 0.04).abs() < 1e-5, "{r}");
    }
}
