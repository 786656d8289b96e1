//! What Disney's material gives back on the mean over all directions, for formats that have it.
//!
//! Its matte base is seen as if no boundary took light from it, and gives back more the rougher it
//! is; its sheen is faint. Ours keep energy: colours and weights are chosen that have the same mean.
//!
//! Source: Burley, *Physically-Based Shading at Disney*, SIGGRAPH 2012, and *Extending the Disney
//! BRDF to a BSDF*, 2015.

use durer_scene::bsdf::albedo::{self, single_means};
use durer_scene::math::{Color, fp};
use std::f32::consts::PI;

/// How rough fuzz is that is brightest at grazing directions, as Disney's sheen is.
pub(super) const FUZZ_ROUGHNESS: f32 = 0.2;

/// Steps of each cosine and of the angle around.
const STEPS: usize = 16;

/// Two directions above a surface.
struct Pair {
    /// Their cosines to the normal.
    cosines: [f32; 2],
    /// The cosine of half the angle between them.
    half: f32,
}

impl Pair {
    /// The matte base, over Lambert's.
    fn matte(&self, roughness: f32) -> f32 {
        let [out, into] = self.cosines.map(schlick);
        let retro = 2.0 * roughness * self.half * self.half;
        (1.0 - 0.5 * out) * (1.0 - 0.5 * into) + retro * (out + into + out * into * (retro - 1.0))
    }

    /// White sheen, over Lambert's white.
    fn sheen(&self) -> f32 {
        PI * schlick(self.half)
    }
}

fn schlick(cosine: f32) -> f32 {
    let m = (1.0 - cosine).clamp(0.0, 1.0);
    m * m * m * m * m
}

/// The mean over all pairs of directions by their cosines.
fn means(value: impl Fn(&Pair) -> f32) -> f32 {
    let step = |i: usize| (i as f32 + 0.5) / STEPS as f32;
    let mut sum = 0.0;
    for (i, j, k) in (0..STEPS.pow(3)).map(|n| (n % STEPS, n / STEPS % STEPS, n / (STEPS * STEPS))) {
        let cosines @ [a, b] = [step(i), step(j)];
        let [s, t] = cosines.map(|cosine| (1.0 - cosine * cosine).sqrt());
        let between = a * b + s * t * fp::sin_cos_turn(0.5 * step(k)).1;
        // Each direction counts by its cosine, of which the mean is a half.
        sum += 4.0 * a * b * value(&Pair { cosines, half: (0.5 + 0.5 * between).max(0.0).sqrt() });
    }
    sum / STEPS.pow(3) as f32
}

/// What a white matte base gives back.
pub(super) fn matte_mean(roughness: f32) -> f32 {
    means(|pair| pair.matte(roughness))
}

/// The weight of our fuzz that gives back as much as sheen of strength 1.
pub(super) fn sheen_of_fuzz() -> f32 {
    let at = |i: usize| {
        let cosine = (i as f32 + 0.5) / STEPS as f32;
        2.0 * cosine * albedo::fuzz(cosine, FUZZ_ROUGHNESS)
    };
    means(Pair::sheen) / ((0..STEPS).map(at).sum::<f32>() / STEPS as f32)
}

/// What our boundary lets through to a matte base and out again; more than 0.
pub(super) fn passing([reflected, all]: [f32; 2]) -> f32 {
    (1.0 - kept([reflected, all])).max(1e-3)
}

/// What our boundary reflects, of [`single_means`]: all that one reflection does not lose.
pub(super) fn kept([reflected, all]: [f32; 2]) -> f32 {
    // Of indices that no glass has nothing may be left.
    reflected / all.max(1e-6)
}

/// What a matte base below a boundary gives back in Disney's material and in ours.
pub(super) struct Matte {
    given: f32,
    passing: f32,
}

impl Matte {
    pub fn new(ior: f32, roughness: f32) -> Matte {
        let means = single_means(ior, roughness);
        Matte { given: matte_mean(roughness), passing: passing(means) }
    }

    /// Our base for theirs.
    pub fn base(&self, color: Color) -> Color {
        self.given * color / self.passing
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_matte_base_has_its_mean() {
        // Of (1 - cos)^5 the mean by the cosine is 1/21, and directions are independent.
        let expected = (1.0_f32 - 0.5 / 21.0) * (1.0 - 0.5 / 21.0);
        assert!((matte_mean(0.0) - expected).abs() < 1e-3, "{}", matte_mean(0.0));
        // Mitsuba 3.9.1 gives 0.7456 of 0.7 at roughness 1, by 200,000 pairs of directions.
        assert!((matte_mean(1.0) - 0.7456 / 0.7).abs() < 5e-3, "{}", matte_mean(1.0));
        // And 0.01154 of white sheen alone.
        assert!((means(Pair::sheen) - 0.01154).abs() < 5e-4, "{}", means(Pair::sheen));
        assert!((0.0..1.0).contains(&sheen_of_fuzz()), "{}", sheen_of_fuzz());
    }
}
