//! Computes the transmittance of Mitsuba's rough boundaries, which lose the light that bounces
//! between microfacets.

use crate::disney::boundary_transmittance;
use durer_scene::bsdf::albedo::single_means;
use durer_scene::bsdf::fresnel;
use durer_scene::math::{Vec3, fp};

/// Dielectric boundary of a `plastic` or `roughplastic`. The boundary stores the mean transmittance
/// and reflectance in Mitsuba and in Dürer, which are needed to match the colour of the base.
pub(super) struct Boundary {
    index: f32,
    /// Mean transmittance of the boundary from outside and its mean reflectance from inside, in
    /// Mitsuba.
    through: f32,
    inside: f32,
    /// Mean transmittance in Dürer for light that enters the base and leaves it again, or `None`
    /// for a smooth boundary, where both programs agree.
    transmittance: Option<f32>,
}

impl Boundary {
    /// Computes the mean values. `roughness` is the square root of alpha.
    pub fn new(index: f32, roughness: f32, beckmann: bool) -> Boundary {
        if roughness == 0.0 {
            let [outside, inside] = [index, 1.0 / index].map(mean_reflectance);
            return Boundary { index, through: 1.0 - outside, inside, transmittance: None };
        }
        let theirs = |index: f32| means(index, roughness * roughness, beckmann);
        let ([reflected, all], [inside, _]) = (theirs(index), theirs(1.0 / index));
        // Mitsuba sums over 64 values of the cosine from 0 to 1, and gives both ends their full
        // weight.
        let straight = (index - 1.0) / (index + 1.0);
        let inside = (63.0 * inside + straight * straight) / 64.0;
        let transmittance = Some(boundary_transmittance(single_means(index, roughness)));
        Boundary { index, through: all - reflected, inside, transmittance }
    }

    /// Returns the colour of a base whose light is not tinted again by each reflection between the
    /// base and the boundary, and that looks like a base of the colour `color` whose light is
    /// (`nonlinear`). Both are Lambertian below the same boundary, so they agree in all directions.
    pub fn faded(&self, color: f32) -> f32 {
        color * (1.0 - self.inside) / (1.0 - color * self.inside)
    }

    /// Returns the colour in Mitsuba for which the base looks as a base of the colour `base` does
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

    /// Returns the mean radiance of a diffuse base seen through the boundary in Mitsuba, divided by
    /// its value in Dürer. In Mitsuba, light is lost each time that it crosses a rough boundary,
    /// both on the way in and on the way out.
    pub fn below(&self) -> f32 {
        let through = self.through / self.index;
        self.transmittance.map_or(1.0, |ours| through * through / (1.0 - self.inside) / ours)
    }
}

/// Returns the reflectance of a smooth boundary for light from all directions.
fn mean_reflectance(eta: f32) -> f32 {
    const STEPS: u32 = 1024;
    // The square of the cosine is uniform, as is the light that falls on a surface.
    let at = |i: u32| fresnel::dielectric(((i as f32 + 0.5) / STEPS as f32).sqrt(), eta);
    (0..STEPS).map(at).sum::<f32>() / STEPS as f32
}

/// Computes the mean albedos as [`single_means`] does, but with Mitsuba's separable masking, which
/// blocks more light than height-correlated masking.
///
/// Source: Walter, Marschner, Li and Torrance, *Microfacet Models for Refraction through Rough
/// Surfaces*, EGSR 2007, with their fit of Beckmann's masking.
fn means(eta: f32, alpha: f32, beckmann: bool) -> [f32; 2] {
    const STEPS: usize = 16;
    let step = |i: usize| (i as f32 + 0.5) / STEPS as f32;
    let seen = |w: Vec3| {
        let a = w.z.abs() / (alpha * (1.0 - w.z * w.z).max(1e-12).sqrt());
        if !beckmann {
            return 2.0 / (1.0 + (1.0 + 1.0 / (a * a)).sqrt());
        }
        if a >= 1.6 { 1.0 } else { (3.535 * a + 2.181 * a * a) / (1.0 + 2.276 * a + 2.577 * a * a) }
    };
    let mut sums = [0.0_f32; 2];
    for (i, j, k) in (0..STEPS.pow(3)).map(|n| (n % STEPS, n / STEPS % STEPS, n / (STEPS * STEPS))) {
        let z = step(i).sqrt();
        let wo = Vec3::new((1.0 - z * z).sqrt(), 0.0, z);
        // Sample microfacets according to their distribution. Half a turn is enough because the
        // integrand is symmetric.
        let u = step(j);
        let slope = alpha * alpha * if beckmann { -fp::ln(1.0 - u) } else { u / (1.0 - u) };
        let cosine = 1.0 / (1.0 + slope).sqrt();
        let (sin, cos) = fp::sin_cos_turn(0.5 * step(k));
        let across = (1.0 - cosine * cosine).max(0.0).sqrt();
        let h = Vec3::new(across * cos, across * sin, cosine);
        let facing = wo.dot(h);
        if facing <= 0.0 {
            continue;
        }
        let weight = seen(wo) * facing / (wo.z * cosine);
        let reflected = fresnel::dielectric(facing, eta);
        let up = 2.0 * facing * h - wo;
        if up.z > 0.0 {
            sums[0] += weight * seen(up) * reflected;
        }
        let behind = 1.0 - (1.0 - facing * facing) / (eta * eta);
        let down = (facing / eta - behind.max(0.0).sqrt()) * h - wo / eta;
        if behind > 0.0 && down.z < 0.0 {
            sums[1] += weight * seen(down) * (1.0 - reflected);
        }
    }
    let [reflected, through] = sums.map(|sum| sum / STEPS.pow(3) as f32);
    [reflected, reflected + through]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rough_boundaries_lose_more_with_roughness() {
        // A nearly smooth boundary does not lose any light.
        let [reflected, all] = means(1.5, 0.02, true);
        let [smooth, _] = single_means(1.5, 0.0);
        assert!((reflected - smooth).abs() < 0.01 && (all - 1.0).abs() < 0.01, "{reflected} {smooth} {all}");
        let below = |roughness: f32, beckmann: bool| Boundary::new(1.49, roughness, beckmann).below();
        assert!((below(0.1, false) - 1.0).abs() < 0.02);
        for beckmann in [false, true] {
            let of = |roughness: f32| below(roughness, beckmann);
            assert!(of(0.3) > of(0.5) && of(0.5) > of(0.8) && of(0.8) > 0.2, "{beckmann}");
        }
        // Beckmann's distribution has fewer steep microfacets.
        assert!(below(0.6, true) > below(0.6, false));
    }

    #[test]
    fn light_that_is_tinted_by_each_bounce_is_a_geometric_series() {
        // A share F of the light returns to the base at each bounce: c (1 - F) / (1 - c F).
        let smooth = Boundary::new(1.5, 0.0, false);
        let terms = std::iter::successors(Some(0.6_f32), |term| Some(term * 0.6 * smooth.inside));
        let sum: f32 = terms.take(200).sum();
        assert!((smooth.faded(0.6) - sum * (1.0 - smooth.inside)).abs() < 1e-5);
        // By conservation of étendue, 1 - inside = (1 - outside) / index^2, where `through` is
        // 1 - outside.
        assert!((1.0 - smooth.inside - smooth.through / 2.25).abs() < 1e-3, "{}", smooth.inside);
        assert_eq!((smooth.below(), smooth.faded(1.0)), (1.0, 1.0));
        assert!((smooth.color(0.6, true) - 0.6).abs() < 1e-5 && smooth.color(0.6, false) == 0.6);
    }
}
