//! What rough boundaries let through in Mitsuba, which does not give back what goes from facet to
//! facet.

use crate::bsdf::albedo::single_means;
use crate::bsdf::fresnel;
use crate::format::disney::passing;
use crate::math::{Vec3, fp};

/// A rough boundary.
#[derive(Clone, Copy)]
pub(super) struct Boundary {
    pub index: f32,
    /// The root of alpha, which is not 0.
    pub roughness: f32,
    pub beckmann: bool,
}

impl Boundary {
    /// What reflects once, and with that what goes through: on the mean over all directions.
    fn means(&self, index: f32, roughness: f32) -> [f32; 2] {
        if roughness > 0.0 { means(index, roughness * roughness, self.beckmann) } else { single_means(index, 0.0) }
    }

    /// The colour of a matte base that shows below it what one does in Mitsuba. `fades`: light that
    /// goes to and fro below takes on more of the colour each time.
    pub fn base(&self, color: f32, fades: bool) -> f32 {
        let below = color * self.below(fades.then_some(color));
        if fades {
            return below;
        }
        // What theirs loses between facets, ours mirrors.
        let [reflected, all] = single_means(self.index, self.roughness);
        let more = reflected / all.max(1e-6) - self.means(self.index, self.roughness)[0];
        (below - more / passing(self.index, self.roughness)).max(0.0)
    }

    /// What a matte base shows through it in Mitsuba, over what it does here, on the mean over all
    /// directions: theirs loses on the way in and on the way out. `kept`, where light that goes to and
    /// fro below changes its colour, is the share that is left each time.
    pub fn below(&self, kept: Option<f32>) -> f32 {
        let Boundary { index, roughness, .. } = *self;
        let theirs = |roughness: f32| {
            let [reflected, all] = self.means(index, roughness);
            let [inside, _] = self.means(1.0 / index, roughness);
            // Mitsuba sums it over 64 cosines from 0 to 1, both ends as much as the others.
            let straight = (index - 1.0) / (index + 1.0);
            let inside = if roughness > 0.0 { (63.0 * inside + straight * straight) / 64.0 } else { inside };
            let through = (all - reflected) / index;
            through * through / (1.0 - inside * kept.unwrap_or(1.0))
        };
        match kept {
            // A coat's darkening is as theirs where it is smooth.
            Some(_) => theirs(roughness) / theirs(0.0),
            None => theirs(roughness) / passing(index, roughness),
        }
    }
}

/// What [`single_means`] is of ours, with Mitsuba's masking: of each direction by itself, so that it
/// hides more than both together do.
///
/// Source: Walter, Marschner, Li and Torrance, *Microfacet Models for Refraction through Rough
/// Surfaces*, EGSR 2007, with their fit of the masking by Beckmann's facets.
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
        // Facets by their number; half a turn is like the other.
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
    fn rough_boundaries_lose_more_the_rougher_they_are() {
        // Nearly smooth, all is there.
        let [reflected, all] = means(1.5, 0.02, true);
        let [smooth, _] = single_means(1.5, 0.0);
        assert!((reflected - smooth).abs() < 0.01 && (all - 1.0).abs() < 0.01, "{reflected} {smooth} {all}");
        let below = |roughness: f32, beckmann: bool, kept| Boundary { index: 1.49, roughness, beckmann }.below(kept);
        assert!((below(0.1, false, None) - 1.0).abs() < 0.02);
        for kept in [None, Some(0.5)] {
            for beckmann in [false, true] {
                let of = |roughness: f32| below(roughness, beckmann, kept);
                assert!(of(0.3) > of(0.5) && of(0.5) > of(0.8) && of(0.8) > 0.2, "{beckmann} {kept:?}");
            }
            // Beckmann's facets lean less far.
            assert!(below(0.6, true, kept) > below(0.6, false, kept));
        }
    }
}
