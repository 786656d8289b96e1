//! What rough boundaries let through in Mitsuba, which does not give back what goes from facet to
//! facet.

use crate::bsdf::albedo::single_means;
use crate::bsdf::fresnel;
use crate::format::disney::passing;
use crate::math::{Vec3, fp};

/// What a matte base shows through a rough boundary in Mitsuba, over what it does here, on the mean
/// over all directions: theirs loses on the way in and on the way out. `kept`, where light that goes
/// to and fro below changes its colour, is the share that is left each time.
pub(super) fn below_rough(index: f32, roughness: f32, beckmann: bool, kept: Option<f32>) -> f32 {
    let means = |index: f32, roughness: f32| match beckmann && roughness > 0.0 {
        true => beckmann_means(index, roughness * roughness),
        false => single_means(index, roughness),
    };
    let theirs = |roughness: f32| {
        let ([reflected, all], [inside, _]) = (means(index, roughness), means(1.0 / index, roughness));
        let through = (all - reflected) / index;
        through * through / (1.0 - inside * kept.unwrap_or(1.0))
    };
    match kept {
        // A coat's darkening is as theirs where it is smooth.
        Some(_) => theirs(roughness) / theirs(0.0),
        None => theirs(roughness) / passing(index, roughness),
    }
}

/// What [`single_means`] is of GGX, of Beckmann's distribution.
///
/// Source: Walter, Marschner, Li and Torrance, *Microfacet Models for Refraction through Rough
/// Surfaces*, EGSR 2007, with their fit of the masking.
fn beckmann_means(eta: f32, alpha: f32) -> [f32; 2] {
    const STEPS: usize = 16;
    let step = |i: usize| (i as f32 + 0.5) / STEPS as f32;
    let seen = |w: Vec3| {
        let a = w.z.abs() / (alpha * (1.0 - w.z * w.z).max(1e-12).sqrt());
        if a >= 1.6 { 1.0 } else { (3.535 * a + 2.181 * a * a) / (1.0 + 2.276 * a + 2.577 * a * a) }
    };
    let mut sums = [0.0_f32; 2];
    for (i, j, k) in (0..STEPS.pow(3)).map(|n| (n % STEPS, n / STEPS % STEPS, n / (STEPS * STEPS))) {
        let z = step(i).sqrt();
        let wo = Vec3::new((1.0 - z * z).sqrt(), 0.0, z);
        // Facets by their number; half a turn is like the other.
        let slope = -alpha * alpha * fp::ln(1.0 - step(j));
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
    fn rough_boundaries_lose_more_the_rougher_they_are() {
        // Nearly smooth, all is there.
        let [reflected, all] = beckmann_means(1.5, 0.02);
        let [smooth, _] = single_means(1.5, 0.0);
        assert!((reflected - smooth).abs() < 0.01 && (all - 1.0).abs() < 0.01, "{reflected} {smooth} {all}");
        assert!((below_rough(1.49, 0.1, false, None) - 1.0).abs() < 0.02);
        for kept in [None, Some(0.5)] {
            for beckmann in [false, true] {
                let of = |roughness: f32| below_rough(1.49, roughness, beckmann, kept);
                assert!(of(0.3) > of(0.5) && of(0.5) > of(0.8) && of(0.8) > 0.2, "{beckmann} {kept:?}");
            }
            // Beckmann's facets lean less far.
            assert!(below_rough(1.49, 0.6, true, kept) > below_rough(1.49, 0.6, false, kept));
        }
    }
}
