//! Phase functions of media.

use crate::math::{Vec2, Vec3, fp};
use std::f32::consts::{PI, TAU};

/// Henyey-Greenstein phase function, which scatters light in participating media.
///
/// Source: Henyey and Greenstein, *Diffuse radiation in the Galaxy*, 1941.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HenyeyGreenstein {
    /// Mean cosine of the angle between the directions before and after scattering, from -1
    /// (backward) through 0 (isotropic) to 1 (forward).
    pub anisotropy: f32,
}

impl HenyeyGreenstein {
    /// Value of the phase function for two unit directions, per solid angle. It is also the pdf of
    /// [`HenyeyGreenstein::sample`].
    pub fn value(&self, before: Vec3, after: Vec3) -> f32 {
        let g = self.anisotropy;
        let below = 1.0 + g * g - 2.0 * g * before.dot(after);
        (1.0 - g * g) / (4.0 * PI * below * below.max(0.0).sqrt()).max(1e-12)
    }

    /// Samples the unit direction after scattering, using two random numbers in [0, 1].
    pub fn sample(&self, before: Vec3, u: Vec2) -> Vec3 {
        let g = self.anisotropy;
        let cosine = if g.abs() < 1e-3 {
            1.0 - 2.0 * u.x
        } else {
            let part = (1.0 - g * g) / (1.0 + g - 2.0 * g * u.x);
            (1.0 + g * g - part * part) / (2.0 * g)
        };
        let cosine = cosine.clamp(-1.0, 1.0);
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        let (a, b) = before.any_orthonormal_pair();
        let turn = TAU * u.y;
        (sine * fp::cos(turn) * a + sine * fp::sin(turn) * b + cosine * before).normalize_or(before)
    }
}
