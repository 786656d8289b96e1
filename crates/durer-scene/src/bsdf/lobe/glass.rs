//! Delta lobes: mirror, smooth refraction and straight transmission.

use super::{LobeKind, LobeSample, NO_SCATTERING, Scatter};
use crate::math::{Vec2, Vec3};
use crate::spectrum::Spectrum;

/// Perfect mirror lobe. The weight of the lobe is its reflectance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mirror;

/// Lobe for refraction by a smooth boundary. The weight of the lobe is its transmittance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refraction {
    /// Index of refraction behind the boundary, relative to the index in front of it.
    pub eta: f32,
}

/// Lobe for transmission that keeps the direction of the light, as if there were no surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StraightTransmission;

/// Returns the refracted direction of `w` at a boundary with normal `h`, or `None` for total
/// internal reflection. Both `w` and `h` point to the same side of the boundary. `eta` is the index
/// behind the boundary, relative to the index in front of it.
pub fn refracted(w: Vec3, h: Vec3, eta: f32) -> Option<Vec3> {
    let cosine = w.dot(h);
    let sine2 = (1.0 - cosine * cosine).max(0.0) / (eta * eta);
    (sine2 < 1.0).then(|| (cosine / eta - (1.0 - sine2).sqrt()) * h - w / eta)
}

macro_rules! single_direction {
    ($type:ty, |$own:ident| $kind:expr, |$lobe:ident, $wo:ident| $scattered:expr) => {
        impl Scatter for $type {
            fn eval(&self, _: Vec3, _: Vec3) -> (Spectrum, f32) {
                NO_SCATTERING
            }
            fn sample(&self, $wo: Vec3, _: f32, _: Vec2) -> Option<LobeSample> {
                let $lobe = self;
                $scattered
            }
            #[inline]
            fn kind(&self) -> LobeKind {
                let $own = self;
                $kind
            }
        }
    };
}

single_direction!(Mirror, |_lobe| LobeKind::MIRROR, |_lobe, wo| Some(LobeSample {
    wi: Vec3::new(-wo.x, -wo.y, wo.z),
    value: Spectrum::ONE
}));
single_direction!(
    StraightTransmission,
    |_lobe| LobeKind { is_straight: true, ..LobeKind::MIRROR.transmitting() },
    |_lobe, wo| Some(LobeSample { wi: -wo, value: Spectrum::ONE })
);
// Radiance L scales with the square of the index n, since L / n^2 is invariant. Source: Veach's
// thesis, section 5.2.
single_direction!(Refraction, |lobe| LobeKind::MIRROR.refracting(lobe.eta), |lobe, wo| refracted(
    wo,
    Vec3::Z,
    lobe.eta
)
.map(|wi| LobeSample { wi, value: Spectrum::splat(1.0 / (lobe.eta * lobe.eta)) }));
