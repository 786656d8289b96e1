//! GGX microfacet distribution.
//!
//! Sources: Walter and others, *Microfacet Models for Refraction through Rough Surfaces*, EGSR
//! 2007; Heitz, *Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs*, JCGT
//! 3(2), 2014; Dupuy and Benyoub, *Sampling Visible GGX Normals with Spherical Caps*, HPG 2023.

use super::warp;
use crate::math::{Vec2, Vec3, fp};
use std::f32::consts::PI;

/// Smallest alpha of a rough surface. If both alphas are smaller, the surface is treated as smooth.
pub const SMOOTH: f32 = 1e-3;

/// GGX distribution of the microfacet normals of a rough surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ggx {
    /// Roughness parameters alpha along the local x and y axes.
    pub alpha: Vec2,
}

impl Ggx {
    /// Creates a distribution from a roughness and an anisotropy, both in [0, 1], as in OpenPBR.
    /// Alpha is the square of the roughness.
    pub fn new(roughness: f32, anisotropy: f32) -> Self {
        let square = roughness * roughness;
        let rest = 1.0 - anisotropy;
        // Anisotropy does not change the mean square, so (ax^2 + ay^2) / 2 = r^4.
        let ax = square * (2.0 / (1.0 + rest * rest)).sqrt();
        Ggx { alpha: Vec2::new(ax.min(1.0), rest * ax) }
    }

    /// Returns the roughness, anisotropy and rotation (in turns) for given alphas along u and v.
    pub fn parameters(alpha: [f32; 2]) -> [f32; 3] {
        let [u, v] = alpha.map(|alpha| alpha.clamp(0.0, 1.0));
        let mean = (0.5 * (u * u + v * v)).sqrt();
        let rest = if u == v { 1.0 } else { u.min(v) / u.max(v) };
        [mean.sqrt(), 1.0 - rest, if v > u { 0.25 } else { 0.0 }]
    }

    /// True if the surface is isotropic.
    pub fn is_isotropic(&self) -> bool {
        self.alpha.x == self.alpha.y
    }

    /// True if the surface is treated as a perfect mirror.
    pub fn is_smooth(&self) -> bool {
        self.alpha.max_element() < SMOOTH
    }

    /// Returns the distribution with its alphas raised to [`SMOOTH`], so that the density is
    /// finite.
    pub fn clamped(self) -> Self {
        Ggx { alpha: self.alpha.max(Vec2::splat(SMOOTH)) }
    }

    /// Returns the density of the facet normals at a unit vector.
    pub fn density(&self, h: Vec3) -> f32 {
        let s = Vec3::new(h.x / self.alpha.x, h.y / self.alpha.y, h.z).length_squared();
        1.0 / (PI * self.alpha.x * self.alpha.y * s * s)
    }

    /// Returns Smith's Lambda, which is the ratio of hidden area to visible area.
    pub fn lambda(&self, w: Vec3) -> f32 {
        let slope = (Vec2::new(w.x, w.y) * self.alpha).length_squared();
        let z2 = w.z * w.z;
        if slope == 0.0 {
            return 0.0;
        }
        // This is (sqrt(1 + s) - 1) / 2 without cancellation. For directions along the surface,
        // everything is hidden.
        let s = slope / z2;
        if s.is_finite() { 0.5 * s / ((1.0 + s).sqrt() + 1.0) } else { f32::INFINITY }
    }

    /// Returns the share of the facets that are visible from a direction (Smith's G1).
    pub fn masking(&self, w: Vec3) -> f32 {
        1.0 / (1.0 + self.lambda(w))
    }

    /// Returns the share of the facets that are visible from both directions (height-correlated
    /// G2).
    pub fn masking_shadowing(&self, wo: Vec3, wi: Vec3) -> f32 {
        1.0 / (1.0 + self.lambda(wo) + self.lambda(wi))
    }

    /// Samples a normal that is visible from `wo`, which is above the surface. The pdf of the
    /// normal is masking(wo) · density(h) · wo·h / wo.z.
    pub fn sample_visible(&self, wo: Vec3, u: Vec2) -> Vec3 {
        let stretched = Vec3::new(wo.x * self.alpha.x, wo.y * self.alpha.y, wo.z).normalize();
        let z = (1.0 - u.y) * (1.0 + stretched.z) - stretched.z;
        let h = warp::polar(z.clamp(-1.0, 1.0), u.x) + stretched;
        Vec3::new(h.x * self.alpha.x, h.y * self.alpha.y, h.z.max(0.0)).try_normalize().unwrap_or(Vec3::Z)
    }
}

/// Returns the BRDF value of a layer of white fibres, without the cosine.
///
/// For the source, see [`crate::bsdf::lobe::fuzz`].
pub fn fuzz_value(roughness: f32, wo: Vec3, wi: Vec3) -> f32 {
    let Some(h) = (wo + wi).try_normalize().filter(|_| wi.z > 0.0) else { return 0.0 };
    let sharpness = 1.0 / (roughness * roughness).max(0.01);
    let sine = (1.0 - h.z * h.z).max(0.0).sqrt();
    let density = (2.0 + sharpness) * fp::pow(sine, sharpness) / (2.0 * PI);
    density / (4.0 * (wo.z + wi.z - wo.z * wi.z).max(1e-6))
}
