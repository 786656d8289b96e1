//! How a surface point scatters light: some lobes with weights, made for the direction in which it
//! is seen.
//!
//! Directions are local to the point's [`Frame`] and point away from the surface. The side from
//! which it is seen is above.

pub mod albedo;
pub mod film;
mod frame;
pub mod fresnel;
pub mod layers;
pub mod lobe;
pub mod microfacet;
pub mod proof;
#[cfg(test)]
mod tests;
pub mod warp;

use crate::math::{Vec2, Vec3};
use crate::spectrum::Spectrum;
pub use frame::Frame;
pub use layers::Tables;
pub use lobe::{Lobe, LobeKind, Scatter, Spread};
use smallvec::SmallVec;

/// A lobe, how much it counts, and how often it is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weighted<'a> {
    /// The lobe.
    pub lobe: Lobe<'a>,
    /// What multiplies it.
    pub weight: Spectrum,
    /// The probability with which it is sampled.
    pub probability: f32,
}

/// The lobes of a point, seen from one direction.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bsdf<'a> {
    lobes: SmallVec<[Weighted<'a>; 4]>,
    /// The sum of the shares that were given.
    total: f32,
}

/// A direction that was chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfSample {
    /// Where the light comes from.
    pub wi: Vec3,
    /// What multiplies that light: value · |cos| / density.
    pub weight: Spectrum,
    /// Density per solid angle; 0 where it is a single direction.
    pub pdf: f32,
    /// The number of the lobe that chose it.
    pub lobe: usize,
}

impl<'a> Bsdf<'a> {
    /// Adds a lobe. Lobes are chosen in proportion to their `share`: about what they give back.
    pub fn push(&mut self, lobe: impl Into<Lobe<'a>>, weight: Spectrum, share: f32) {
        if weight.max_element() > 0.0 && share > 0.0 {
            self.lobes.push(Weighted { lobe: lobe.into(), weight, probability: share });
            self.total += share;
        }
    }

    /// The lobes, with the probabilities that they are chosen.
    pub fn lobes(&self) -> impl Iterator<Item = Weighted<'a>> {
        self.lobes.iter().map(|part| Weighted { probability: part.probability / self.total, ..*part })
    }

    /// Whether lights can be connected with: some lobe scatters into all directions.
    pub fn is_broad(&self) -> bool {
        self.lobes.iter().any(|part| !part.lobe.is_delta())
    }

    /// Whether half or more of what is scattered goes into a narrow part of all directions.
    pub fn is_glossy(&self) -> bool {
        let glossy = self.lobes.iter().filter(|part| part.lobe.kind().spread == Spread::Glossy);
        glossy.map(|part| part.probability).sum::<f32>() >= 0.5 * self.total
    }

    /// Whether some of it is a fibre, whose light may leave on any side.
    pub fn is_fibre(&self) -> bool {
        self.lobes.iter().any(|part| part.lobe.kind().is_fibre)
    }

    /// Whether nothing is scattered.
    pub fn is_black(&self) -> bool {
        self.lobes.is_empty()
    }

    /// Whether light from behind the surface is scattered too, and not only along single
    /// directions.
    pub fn passes_light(&self) -> bool {
        self.lobes.iter().any(|part| part.lobe.kind().transmits && !part.lobe.is_delta())
    }

    /// The share of light that goes on as if nothing were there.
    pub fn straight(&self) -> Spectrum {
        let through = self.lobes.iter().filter(|part| part.lobe.kind().is_straight);
        through.map(|part| part.weight).sum()
    }

    /// The value times |cos| of `wi`, and the density per solid angle with which [`Bsdf::sample`]
    /// chooses it; without lobes of single directions.
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> (Spectrum, f32) {
        let (mut value, mut density) = (Spectrum::ZERO, 0.0);
        for part in &self.lobes {
            let (own, often) = part.lobe.eval(wo, wi);
            value += part.weight * own;
            density += part.probability * often;
        }
        if density > 0.0 { (value, density / self.total) } else { (value, 0.0) }
    }

    /// Chooses a direction by three numbers, uniform from 0 to 1; `None` where light ends.
    pub fn sample(&self, wo: Vec3, choice: f32, u: Vec2) -> Option<BsdfSample> {
        let mut rest = choice * self.total;
        let last = self.lobes.len().checked_sub(1)?;
        let mut chosen = last;
        for (i, part) in self.lobes.iter().enumerate() {
            if rest < part.probability || i == last {
                chosen = i;
                break;
            }
            rest -= part.probability;
        }
        let part = &self.lobes[chosen];
        // What is left of the number is uniform again.
        let again = (rest / part.probability).clamp(0.0, 1.0 - f32::EPSILON * 0.5);
        let scattered = part.lobe.sample(wo, again, u)?;
        if part.lobe.is_delta() {
            let weight = part.weight * scattered.value * (self.total / part.probability);
            return Some(BsdfSample { wi: scattered.wi, weight, pdf: 0.0, lobe: chosen });
        }
        let (value, pdf) = self.eval(wo, scattered.wi);
        let weight = value / pdf;
        let sound = pdf > 0.0 && pdf.is_finite() && weight.is_finite();
        sound.then_some(BsdfSample { wi: scattered.wi, weight, pdf, lobe: chosen })
    }
}
