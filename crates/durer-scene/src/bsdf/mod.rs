//! BSDFs, which describe how a surface point scatters light, as weighted lobes for one view
//! direction.
//!
//! Directions are in the local [`Frame`] of the surface point, and they are directed away from the
//! surface. The viewer is above the surface (z > 0).

pub mod albedo;
mod disney;
pub mod film;
mod frame;
pub mod fresnel;
pub mod layers;
pub mod lobe;
pub mod microfacet;
#[cfg(test)]
mod tests;
pub mod validation;
pub mod view;
pub mod warp;

use crate::math::{Vec2, Vec3};
use crate::spectrum::Spectrum;
pub use frame::Frame;
pub use layers::Tables;
pub use lobe::{Lobe, LobeKind, Scatter, Spread};
use smallvec::SmallVec;

/// Lobe of a BSDF with its weight and its sampling probability.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WeightedLobe<'a> {
    /// Scattering lobe.
    pub lobe: Lobe<'a>,
    /// Factor that scales the value of the lobe.
    pub weight: Spectrum,
    /// Probability of sampling this lobe.
    pub probability: f32,
}

/// BSDF of a surface point for one view direction, represented as a weighted sum of lobes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bsdf<'a> {
    lobes: SmallVec<[WeightedLobe<'a>; 4]>,
    /// Sum of the shares passed to [`Bsdf::push`].
    total: f32,
}

/// Incident direction sampled from a BSDF, with its throughput factor and pdf.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfSample {
    /// Local direction to the incident light.
    pub wi: Vec3,
    /// Throughput factor, which is value · |cos| / pdf.
    pub weight: Spectrum,
    /// Pdf with respect to solid angle, or 0 if a delta lobe was sampled.
    pub pdf: f32,
    /// Index of the lobe from which the direction was sampled.
    pub lobe: usize,
}

impl<'a> Bsdf<'a> {
    /// Adds a lobe. Lobes are sampled in proportion to `share`, which is their approximate albedo.
    pub fn push(&mut self, lobe: impl Into<Lobe<'a>>, weight: Spectrum, share: f32) {
        if weight.max_element() > 0.0 && share > 0.0 {
            self.lobes.push(WeightedLobe { lobe: lobe.into(), weight, probability: share });
            self.total += share;
        }
    }

    /// Returns the lobes with normalised sampling probabilities.
    pub fn lobes(&self) -> impl Iterator<Item = WeightedLobe<'a>> {
        self.lobes.iter().map(|entry| WeightedLobe { probability: entry.probability / self.total, ..*entry })
    }

    /// True if some lobe is not a delta lobe, in which case sampling lights is useful.
    pub fn has_non_delta(&self) -> bool {
        self.lobes.iter().any(|entry| !entry.lobe.is_delta())
    }

    /// True if glossy lobes have at least half of the total sampling probability.
    pub fn is_glossy(&self) -> bool {
        let glossy = self.lobes.iter().filter(|entry| entry.lobe.kind().spread == Spread::Glossy);
        glossy.map(|entry| entry.probability).sum::<f32>() >= 0.5 * self.total
    }

    /// True if some lobe is a hair fibre, which scatters light in all directions.
    pub fn is_fibre(&self) -> bool {
        self.lobes.iter().any(|entry| entry.lobe.kind().is_fibre)
    }

    /// True if no light is scattered.
    pub fn is_black(&self) -> bool {
        self.lobes.is_empty()
    }

    /// True if a lobe that is not a delta lobe scatters light from behind the surface.
    pub fn passes_light(&self) -> bool {
        self.lobes.iter().any(|entry| entry.lobe.kind().transmits && !entry.lobe.is_delta())
    }

    /// Returns the share of light that passes straight through, as if there were no surface.
    pub fn straight_transmittance(&self) -> Spectrum {
        let through = self.lobes.iter().filter(|entry| entry.lobe.kind().is_straight);
        through.map(|entry| entry.weight).sum()
    }

    /// Returns the value times |cos| of `wi`, and the pdf per solid angle with which
    /// [`Bsdf::sample`] chooses `wi`. Delta lobes are excluded.
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> (Spectrum, f32) {
        let (mut value, mut density) = (Spectrum::ZERO, 0.0);
        for entry in &self.lobes {
            let (lobe_value, lobe_pdf) = entry.lobe.eval(wo, wi);
            value += entry.weight * lobe_value;
            density += entry.probability * lobe_pdf;
        }
        if density > 0.0 { (value, density / self.total) } else { (value, 0.0) }
    }

    /// Samples a direction from three numbers that are uniform in [0, 1]. Returns `None` if the
    /// path ends.
    pub fn sample(&self, wo: Vec3, choice: f32, u: Vec2) -> Option<BsdfSample> {
        let mut rest = choice * self.total;
        let last = self.lobes.len().checked_sub(1)?;
        let mut chosen = last;
        for (i, entry) in self.lobes.iter().enumerate() {
            if rest < entry.probability || i == last {
                chosen = i;
                break;
            }
            rest -= entry.probability;
        }
        let entry = &self.lobes[chosen];
        // Reuse the remainder of `choice`, which is again uniformly distributed.
        let again = (rest / entry.probability).clamp(0.0, 1.0 - f32::EPSILON * 0.5);
        let scattered = entry.lobe.sample(wo, again, u)?;
        if entry.lobe.is_delta() {
            let weight = entry.weight * scattered.value * (self.total / entry.probability);
            return Some(BsdfSample { wi: scattered.wi, weight, pdf: 0.0, lobe: chosen });
        }
        let (value, pdf) = self.eval(wo, scattered.wi);
        let weight = value / pdf;
        let sound = pdf > 0.0 && pdf.is_finite() && weight.is_finite();
        sound.then_some(BsdfSample { wi: scattered.wi, weight, pdf, lobe: chosen })
    }
}
