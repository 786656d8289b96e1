//! Microfacet distributions: GGX, and Beckmann's.
//!
//! Sources: Walter and others, *Microfacet Models for Refraction through Rough Surfaces*, EGSR
//! 2007; Heitz, *Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs*, JCGT
//! 3(2), 2014; Dupuy and Benyoub, *Sampling Visible GGX Normals with Spherical Caps*, HPG 2023.

use super::warp;
use crate::material::principled::Facets;
use crate::math::{Vec2, Vec3, fp};
use std::f32::consts::PI;

/// Smallest alpha of a rough surface. If both alphas are smaller, the surface is treated as smooth.
pub const SMOOTH: f32 = 1e-3;

/// Distribution of the microfacet normals of a rough surface, which is GGX unless
/// [`Facets::Beckmann`] is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ggx {
    /// Roughness parameters alpha along the local x and y axes.
    pub alpha: Vec2,
    /// Distribution, and how the facets hide each other.
    pub facets: Facets,
}

impl Ggx {
    /// Creates a distribution from a roughness and an anisotropy, both in [0, 1], as in OpenPBR.
    /// Alpha is the square of the roughness.
    pub fn new(roughness: f32, anisotropy: f32) -> Self {
        let square = roughness * roughness;
        let rest = 1.0 - anisotropy;
        // Anisotropy does not change the mean square, so (ax^2 + ay^2) / 2 = r^4.
        let ax = square * (2.0 / (1.0 + rest * rest)).sqrt();
        Ggx::of(Vec2::new(ax.min(1.0), rest * ax))
    }

    /// Creates a GGX distribution with given alphas along the local x and y axes.
    pub fn of(alpha: Vec2) -> Self {
        Ggx { alpha, facets: Facets::Ggx }
    }

    /// Returns the distribution of the same alphas with other facets.
    pub fn with(self, facets: Facets) -> Self {
        Ggx { facets, ..self }
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
        Ggx { alpha: self.alpha.max(Vec2::splat(SMOOTH)), ..self }
    }

    /// Returns the density of the facet normals at a unit vector.
    pub fn density(&self, h: Vec3) -> f32 {
        if self.facets == Facets::Beckmann {
            let (slope, z2) = ((Vec2::new(h.x, h.y) / self.alpha).length_squared(), h.z * h.z);
            let density = fp::exp(-slope / z2) / (PI * self.alpha.x * self.alpha.y * z2 * z2);
            return if density.is_finite() { density } else { 0.0 };
        }
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
        if self.facets == Facets::Beckmann {
            // The fit by Walter and others, which Mitsuba uses too.
            let a = (z2 / slope).sqrt();
            return match a < 1.6 {
                true => (1.0 - 1.259 * a + 0.396 * a * a) / (3.535 * a + 2.181 * a * a),
                false => 0.0,
            };
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

    /// Returns the share of the facets that are visible from both directions (G2).
    pub fn masking_shadowing(&self, wo: Vec3, wi: Vec3) -> f32 {
        1.0 / self.hiding(self.lambda(wo), self.lambda(wi))
    }

    /// Returns the reciprocal of G2 for two values of [`Ggx::lambda`].
    pub fn hiding(&self, hidden_o: f32, hidden_i: f32) -> f32 {
        match self.facets {
            Facets::Ggx => 1.0 + hidden_o + hidden_i,
            Facets::GgxSeparable | Facets::Beckmann => (1.0 + hidden_o) * (1.0 + hidden_i),
        }
    }

    /// Returns the share of the light that is not hidden on its way to `wi`, if it comes from `wo`
    /// over a facet with the normal `h` that [`Ggx::sample_visible`] returned.
    pub fn sampled_weight(&self, wo: Vec3, wi: Vec3, h: Vec3) -> f32 {
        match self.facets {
            Facets::Beckmann => self.masking_shadowing(wo, wi) * self.sampling_divisor(wo, h, 0.0).max(0.0),
            Facets::Ggx | Facets::GgxSeparable => self.masking_shadowing(wo, wi) / self.masking(wo),
        }
    }

    /// Returns density(h) · wo·h / wo.z divided by the pdf of the normals that
    /// [`Ggx::sample_visible`] returns. `hidden_o` is [`Ggx::lambda`] of `wo`.
    pub fn sampling_divisor(&self, wo: Vec3, h: Vec3, hidden_o: f32) -> f32 {
        match self.facets {
            Facets::Beckmann => wo.dot(h) / (wo.z * h.z),
            Facets::Ggx | Facets::GgxSeparable => 1.0 + hidden_o,
        }
    }

    /// Samples a normal that is visible from `wo`, which is above the surface. The pdf of the
    /// normal is masking(wo) · density(h) · wo·h / wo.z. For Beckmann's distribution, the normal
    /// may be hidden, and its pdf is density(h) · h.z.
    pub fn sample_visible(&self, wo: Vec3, u: Vec2) -> Vec3 {
        if self.facets == Facets::Beckmann {
            // Walter and others, equations 28 and 29, stretched along both axes.
            let (sin, cos) = fp::sin_cos_turn(u.x);
            let slope = (-fp::ln((1.0 - u.y).max(f32::MIN_POSITIVE))).sqrt();
            return Vec3::new(slope * cos * self.alpha.x, slope * sin * self.alpha.y, 1.0).normalize();
        }
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

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Facets; 3] = [Facets::Ggx, Facets::GgxSeparable, Facets::Beckmann];

    /// Unit vectors on a grid over the upper hemisphere, with the solid angle of each.
    fn directions() -> impl Iterator<Item = (Vec3, f32)> {
        const STEPS: usize = 400;
        (0..STEPS * STEPS).map(|n| {
            let (z, turn) = ((n / STEPS) as f32 + 0.5, (n % STEPS) as f32 + 0.5);
            (warp::polar(z / STEPS as f32, turn / STEPS as f32), 2.0 * PI / (STEPS * STEPS) as f32)
        })
    }

    #[test]
    fn projected_area_of_the_facets_is_that_of_the_surface() {
        // The integral of density(h) h.z is 1 for any distribution.
        for (facets, alpha) in ALL.into_iter().flat_map(|f| [Vec2::new(0.3, 0.3), Vec2::new(0.2, 0.8)].map(|a| (f, a)))
        {
            let surface = Ggx::of(alpha).with(facets);
            let area: f32 = directions().map(|(h, solid)| surface.density(h) * h.z * solid).sum();
            assert!((area - 1.0).abs() < 0.01, "{facets:?} {alpha}: {area}");
        }
    }

    #[test]
    fn sampled_normals_have_the_density_that_is_divided_by() {
        // The mean of f(h) over samples is the integral of f(h) times the pdf.
        let wo = Vec3::new(0.6, 0.0, 0.8);
        for facets in ALL {
            let surface = Ggx::of(Vec2::new(0.3, 0.6)).with(facets);
            let hidden = surface.lambda(wo);
            let value = |h: Vec3| if wo.dot(h) > 0.0 { h.x * h.x + 0.5 * h.y + h.z } else { 0.0 };
            let pdf = |h: Vec3| {
                let visible = surface.density(h) * wo.dot(h) / wo.z;
                if wo.dot(h) > 0.0 { visible / surface.sampling_divisor(wo, h, hidden) } else { 0.0 }
            };
            let wanted: f32 = directions().map(|(h, solid)| value(h) * pdf(h) * solid).sum();
            let steps = 300;
            let place = |i: usize| (i as f32 + 0.5) / steps as f32;
            let sampled = |n: usize| value(surface.sample_visible(wo, Vec2::new(place(n % steps), place(n / steps))));
            let found = (0..steps * steps).map(sampled).sum::<f32>() / (steps * steps) as f32;
            assert!((found - wanted).abs() < 0.01, "{facets:?}: {found} and not {wanted}");
        }
    }

    #[test]
    fn beckmann_has_the_values_of_mitsuba() {
        // `MicrofacetDistribution(Beckmann, 0.3, 0.5)` of Mitsuba 3.9.1.
        let surface = Ggx::of(Vec2::new(0.3, 0.5)).with(Facets::Beckmann);
        let (h, w) = (Vec3::new(0.2, 0.3, 0.932_737_9), Vec3::new(0.9, -0.3, 0.316_227_77));
        for (found, wanted) in [(surface.density(h), 1.112_117), (surface.masking(w), 0.979_093_25)] {
            assert!((found - wanted).abs() < 1e-4 * wanted, "{found} and not {wanted}");
        }
    }
}
