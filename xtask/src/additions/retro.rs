//! Example of a lobe: retroreflection, for example by a cat's eye.

use super::{LobeKind, Scatter, LobeSample};
use crate::math::{Vec2, Vec3};
use crate::spectrum::Spectrum;

/// Lobe of a perfect retroreflector, which reflects light to where it comes from. Its weight is the
/// reflectance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Retro;

impl Scatter for Retro {
    fn eval(&self, _: Vec3, _: Vec3) -> (Spectrum, f32) {
        (Spectrum::ZERO, 0.0)
    }

    fn sample(&self, wo: Vec3, _: f32, _: Vec2) -> Option<LobeSample> {
        Some(LobeSample { wi: wo, value: Spectrum::ONE })
    }

    fn kind(&self) -> LobeKind {
        LobeKind::MIRROR
    }
}
