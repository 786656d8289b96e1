//! Error bounds for pixels, which include noise and bias.
//!
//! The mean of n samples has a standard error. Photon mapping also has a bias, because it averages
//! over a neighbourhood. The bias is estimated from the same photons with a second-order kernel
//! (see [`crate::integrator::PhotonTracer::corrected`]). Let M be the mean, C the corrected mean
//! and s the standard error of C. At a given confidence level, the true value differs from C by at
//! most t s, where t is Student's quantile with n - 1 degrees of freedom. It therefore differs from
//! M by at most |M - C| + t s.
//!
//! Source: Hachisuka, Jarosz and Jensen, *A Progressive Error Estimation Framework for Photon
//! Density Estimation*, 2010. The paper computes the bias from derivatives of a smooth kernel,
//! whereas this module uses two kernels over the same photons. All pixels have equal radii (Knaus
//! and Zwicker 2011), so the bias is an ordinary mean over samples. As in the paper, the light is
//! assumed to be smooth within the radius. At the sharp edge of a caustic, the method finds only
//! about six tenths of the bias.

use super::part::PartialRender;
use super::run::render_all;
use super::{Control, Job, RenderError};
use crate::film::aov::{PixelStatistics, heat};
use crate::integrator::{IntegratorKind, PhotonParameters};
use crate::world::World;
use durer_image::{Image, Layer};
use durer_scene::math::Vec3;
use serde::Serialize;

/// Confidence level of the error bounds.
pub const CONFIDENCE: f64 = 0.9;

/// Bound on the error of a pixel's luminance. It includes noise and the bias of photon mapping.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ErrorBound {
    /// Estimated luminance.
    pub luminance: f64,
    /// Estimated bias of the luminance, which can be negative. It is 0 without photons.
    pub bias: f64,
    /// Standard error of the luminance after the bias has been subtracted.
    pub standard_error: f64,
    /// Bound on the absolute error of the luminance with confidence [`CONFIDENCE`]. It is infinite
    /// for one sample.
    pub bound: f64,
}

impl ErrorBound {
    /// Computes the bound from the samples of a pixel and from its bias-corrected samples.
    pub(super) fn new(own: &PixelStatistics, corrected: &PixelStatistics) -> Self {
        let (luminance, without) = (own.luminance(), corrected.luminance());
        let standard_error = corrected.variance().sqrt();
        let bias = luminance - without;
        let freedom = corrected.samples().saturating_sub(1) as f64;
        ErrorBound { luminance, bias, standard_error, bound: bias.abs() + student(freedom) * standard_error }
    }

    /// Returns the interval that contains the true luminance with confidence [`CONFIDENCE`].
    pub fn interval(&self) -> (f64, f64) {
        let (middle, half) = (self.luminance - self.bias, self.bound - self.bias.abs());
        (middle - half, middle + half)
    }
}

/// Returns the quantile of Student's distribution with upper tail probability (1 - [`CONFIDENCE`])
/// / 2. The quantile is infinite for less than one degree of freedom.
///
/// Source: Abramowitz and Stegun, *Handbook of Mathematical Functions*, 26.7.5. The approximation
/// is 5 % too small for one degree of freedom and accurate to 0.3 % for two or more.
fn student(freedom: f64) -> f64 {
    if freedom < 1.0 {
        return f64::INFINITY;
    }
    // The 0.95 quantile of the normal distribution.
    let z = 1.644_853_626_951_472_7_f64;
    let (square, mut power) = (z * z, z);
    // The odd powers of z up to the ninth power.
    let powers = [1.0, square, square, square, square].map(|factor| {
        power *= factor;
        power
    });
    let term = |factors: [f64; 5], divisor: f64| -> f64 {
        factors.iter().zip(powers).map(|(factor, power)| factor * power).sum::<f64>() / divisor
    };
    let terms = [
        z,
        term([1.0, 1.0, 0.0, 0.0, 0.0], 4.0),
        term([3.0, 16.0, 5.0, 0.0, 0.0], 96.0),
        term([-15.0, 17.0, 19.0, 3.0, 0.0], 384.0),
        term([-945.0, -1920.0, 1482.0, 776.0, 79.0], 92160.0),
    ];
    terms.iter().rev().fold(0.0, |sum, term| sum / freedom + term)
}

/// Returns the bias-corrected variant of an integrator, or `None` if the integrator is unbiased.
pub(super) fn bias_corrected(method: IntegratorKind) -> Option<IntegratorKind> {
    match method {
        IntegratorKind::Photons(photons) => {
            Some(IntegratorKind::Photons(PhotonParameters { corrected: true, ..photons }))
        }
        _ => None,
    }
}

impl PartialRender {
    /// Computes the error bound of each pixel's luminance with confidence [`CONFIDENCE`]. Returns
    /// one layer with the values and another with a heat map of the values up to 0.1. Photons are
    /// traced a second time. The sums and the hash of this part do not change.
    ///
    /// # Errors
    /// Returns the same [`RenderError`] as for the picture itself, and [`RenderError::Diagram`] for
    /// photons with a noise threshold or a time limit.
    pub fn error(&self, world: &World, threads: Option<usize>) -> Result<[Layer; 2], RenderError> {
        let made = |job: &Job| render_all(world, job, &Control { threads, ..Control::default() });
        let job = Job { color: true, aovs: Vec::new(), ..self.job.clone() };
        let own = if self.job.wants_samples() { None } else { Some(made(&job)?) };
        let own = own.as_ref().unwrap_or(self);
        let all = u64::from(job.sampling.samples()) * job.window().pixels();
        let other = match bias_corrected(job.method) {
            Some(_) if job.noise.is_some() || job.sampling.is_local() && own.statistics().samples != all => {
                let message = "the photon error needs a fixed number of samples: set --samples, without \
                               --noise-threshold and --time-limit";
                return Err(RenderError::Diagram(message.into()));
            }
            Some(method) => Some(made(&Job { method, ..job })?),
            None => None,
        };
        let window = self.job.window();
        let bounds = own.error_bounds(other.as_ref());
        let image = |of: fn(f32) -> Vec3| {
            Image::from_pixels(window.width, window.height, bounds.iter().map(|bound| of(*bound)).collect())
        };
        let (values, shown) = (image(Vec3::splat)?, image(|bound| heat(10.0 * bound))?);
        Ok([Layer::data("error", values), Layer::data("error", shown)])
    }

    /// Returns the error bound of each pixel. `other` contains the same samples with bias
    /// correction. The bound is infinite for pixels without samples.
    fn error_bounds(&self, other: Option<&PartialRender>) -> Vec<f32> {
        let (window, gain) = (self.job.window(), self.gain());
        let (state, other) = (self.state(), other.map(PartialRender::state));
        let mut bounds = vec![f32::INFINITY; window.pixels() as usize];
        for (index, block) in state.samples.iter().enumerate() {
            let rect = self.blocks.rect(index);
            let Some(film) = block.film(rect) else { continue };
            let twin = other.as_ref().and_then(|other| other.samples[index].film(rect));
            for (x, y) in rect.pixel_positions() {
                let sums = |film| PixelStatistics { pixel: Some((film, x, y)), gain, lumens: None };
                let bound = ErrorBound::new(&sums(&film), &sums(twin.as_ref().unwrap_or(&film))).bound;
                bounds[window.index(x, y)] = bound as f32;
            }
        }
        bounds
    }
}

#[cfg(test)]
mod tests;
