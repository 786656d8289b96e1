//! Colour of the base below Mitsuba's smooth and rough boundaries.
//!
//! Source: *Mitsuba 3 documentation*, "BSDFs". A rough boundary loses the light that bounces
//! between facets, on the way in and on the way out.

use crate::disney::boundary_transmittance;
use durer_scene::bsdf::albedo::{single_means, single_share};
use durer_scene::bsdf::fresnel;
use durer_scene::bsdf::microfacet::Ggx;
use durer_scene::material::principled::Facets;

/// Dielectric boundary of a `plastic` or `roughplastic`. The boundary stores the mean transmittance
/// and reflectance in Mitsuba and in Dürer, which are needed to match the colour of the base.
pub(super) struct Boundary {
    index: f32,
    /// Mean transmittance from outside of the boundary with Mitsuba's facets.
    through: f32,
    /// Mean reflectance from inside, as Mitsuba approximates it.
    inside: f32,
    /// Mean transmittance from outside in Dürer.
    in_durer: f32,
}

impl Boundary {
    /// Computes the mean values. `roughness` is the square root of alpha. If the facets in Dürer
    /// are not Mitsuba's, the boundary in Dürer is assumed to lose no light.
    pub fn new(index: f32, roughness: f32, facets: Facets) -> Boundary {
        let is_lossless = facets == Facets::Ggx;
        let surface = Ggx::new(roughness, 0.0).with(if is_lossless { Facets::GgxSeparable } else { facets });
        if surface.is_smooth() {
            let through = 1.0 - mean_reflectance(index);
            return Boundary { index, through, inside: fitted_reflectance(1.0 / index), in_durer: through };
        }
        const STEPS: u32 = 64;
        // The square of the cosine is uniform, as is the light that falls on a surface.
        let at = |i: u32| {
            let cosine = ((i as f32 + 0.5) / STEPS as f32).sqrt();
            single_share(surface, cosine, index, true) - single_share(surface, cosine, index, false)
        };
        let through = (0..STEPS).map(at).sum::<f32>() / STEPS as f32;
        // Mitsuba sums over 64 values of the cosine from 0 to 1, and gives both ends their full
        // weight.
        let cosine = |i: u32| (i as f32 / 63.0).max(1e-6);
        let inside = (0..64).map(|i| 2.0 * cosine(i) * single_share(surface, cosine(i), 1.0 / index, false));
        let in_durer = if is_lossless { boundary_transmittance(single_means(index, roughness)) } else { through };
        Boundary { index, through, inside: inside.sum::<f32>() / 64.0, in_durer }
    }

    /// Returns the colour of a base whose light is not tinted again by each reflection between the
    /// base and the boundary, and that looks like a base of the colour `color` whose light is
    /// (`nonlinear`). Both are Lambertian below the same boundary, so they agree in all directions.
    pub fn faded(&self, color: f32) -> f32 {
        color * (1.0 - self.inside) / (1.0 - color * self.inside)
    }

    /// Returns the colour in Mitsuba for which the base is as bright as a base of the colour `base`
    /// in Dürer. If `fades` is true, the base tints the light at each reflection below the
    /// boundary, in both programs.
    pub fn color(&self, base: f32, fades: bool) -> f32 {
        if !fades {
            return base / self.below();
        }
        // The inverse of `faded`.
        let shown = self.faded(base) / self.below();
        shown / (1.0 - self.inside + shown * self.inside)
    }

    /// Returns the factor that converts the colour of a base from Mitsuba to Dürer.
    ///
    /// Mitsuba's base has the value c T(wo) T(wi) / (η² (1 − R)) / π, with the transmittance T of
    /// the boundary and its mean reflectance R from inside. In Dürer, its value is the product
    /// c T(wo) T(wi) / π, divided by the mean of T. If both have the same facets, both agree in all
    /// directions. For a smooth boundary, the factor is nearly 1.
    pub fn below(&self) -> f32 {
        let both_ways = self.through * self.through / self.in_durer;
        both_ways / (self.index * self.index * (1.0 - self.inside))
    }
}

/// Returns the reflectance of a smooth boundary for light from all directions.
fn mean_reflectance(eta: f32) -> f32 {
    const STEPS: u32 = 1024;
    // The square of the cosine is uniform, as is the light that falls on a surface.
    let at = |i: u32| fresnel::dielectric(((i as f32 + 0.5) / STEPS as f32).sqrt(), eta);
    (0..STEPS).map(at).sum::<f32>() / STEPS as f32
}

/// Returns an approximation of [`mean_reflectance`], which Mitsuba uses. It is off by 0.004 at an
/// index of 1/2.4.
///
/// Sources: Egan and Hilgeman, *Optical Properties of Inhomogeneous Materials*, 1979, for indices
/// below 1; d'Eon and Irving, *A Quantized-Diffusion Model for Rendering Translucent Materials*,
/// SIGGRAPH 2011, for others.
fn fitted_reflectance(eta: f32) -> f32 {
    let inverse = 1.0 / eta;
    if eta < 1.0 {
        return -1.4399 * eta * eta + 0.7099 * eta + 0.6681 + 0.0636 * inverse;
    }
    let terms = [0.919_317, -3.4793, 6.75335, -7.80989, 4.98554, -1.36881];
    terms.iter().rev().fold(0.0, |sum, term| sum * inverse + term)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rough_boundaries_lose_more_with_roughness() {
        for facets in [Facets::Ggx, Facets::GgxSeparable, Facets::Beckmann] {
            let below = |roughness: f32| Boundary::new(1.49, roughness, facets).below();
            assert!(below(0.1) < 1.0 && below(0.1) > below(0.3), "{}", below(0.1));
            assert!(below(0.3) > below(0.5) && below(0.5) > below(0.8) && below(0.8) > 0.2, "{facets:?}");
        }
    }

    #[test]
    fn means_are_those_of_mitsuba() {
        // Square root of the mean over all pairs of directions of the values of `roughplastic` with
        // a white base and without specular reflection, in Mitsuba 3.9.1.
        for (facets, alpha, wanted) in [
            (Facets::GgxSeparable, 0.01, [0.94266, 0.90147]),
            (Facets::GgxSeparable, 0.05, [0.93270, 0.88745]),
            (Facets::GgxSeparable, 0.1, [0.90977, 0.85374]),
            (Facets::GgxSeparable, 0.3, [0.78951, 0.69499]),
            (Facets::GgxSeparable, 0.6, [0.64677, 0.53129]),
            (Facets::Beckmann, 0.1, [0.93810, 0.89563]),
            (Facets::Beckmann, 0.3, [0.89306, 0.83265]),
            (Facets::Beckmann, 0.6, [0.78832, 0.70072]),
        ] {
            for (index, wanted) in [1.5_f32, 1.9].into_iter().zip(wanted) {
                let boundary = Boundary::new(index, f32::sqrt(alpha), facets);
                let found = (boundary.through * boundary.below()).sqrt();
                assert!((found / wanted - 1.0).abs() < 1.5e-3, "{facets:?} {alpha} {index}: {found} and not {wanted}");
            }
        }
    }

    #[test]
    fn fitted_reflectance_is_near_the_integral() {
        for (eta, within) in [(1.0 / 1.5, 6e-4), (1.0 / 2.4, 4e-3), (1.3, 6e-4), (2.0, 6e-4)] {
            assert!((fitted_reflectance(eta) - mean_reflectance(eta)).abs() < within, "{eta}");
        }
        // `fresnel_diffuse_reflectance(1 / 1.49)` of Mitsuba 3.9.1.
        assert!((fitted_reflectance(1.0 / 1.49) - 0.590_732_5).abs() < 1e-5);
    }

    #[test]
    fn light_that_is_tinted_by_each_bounce_is_a_geometric_series() {
        // A share F of the light returns to the base at each bounce: c (1 - F) / (1 - c F).
        let smooth = Boundary::new(1.5, 0.0, Facets::Ggx);
        let terms = std::iter::successors(Some(0.6_f32), |term| Some(term * 0.6 * smooth.inside));
        let sum: f32 = terms.take(200).sum();
        assert!((smooth.faded(0.6) - sum * (1.0 - smooth.inside)).abs() < 1e-5);
        // By conservation of étendue, 1 - inside = (1 - outside) / index^2, where `through` is
        // 1 - outside. Mitsuba's fit is off by 0.1 %.
        assert!((1.0 - smooth.inside - smooth.through / 2.25).abs() < 1e-3, "{}", smooth.inside);
        assert!((smooth.below() - 1.0).abs() < 2e-3 && smooth.faded(1.0) == 1.0, "{}", smooth.below());
        let color = |fades: bool| smooth.color(0.6, fades) - 0.6;
        assert!(color(true).abs() < 2e-3 && color(false).abs() < 2e-3);
    }
}
