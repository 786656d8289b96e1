//! How many samples each pixel gets, where more are taken where the picture is noisier.
//!
//! Of a given number of samples the mean square error is least if each pixel's is proportional to
//! the standard deviation of its samples (Neyman 1934; Cochran, *Sampling Techniques*, 1977,
//! section 5.5). So first all pixels get the same, the pilot: a quarter. Then it is decided, once,
//! how many each has in the end, from exact sums and in a fixed order.
//!
//! What is asked for is the deviation that is left as more samples are taken. Where they lie as
//! Sobol's do, that is far less than they differ at the edges of things: so it is told by how much
//! the second half of the pilot moves a pixel's mean, and not by the variance of its samples.
//!
//! A pixel's own samples have no say in it. If they had, those that found much light by chance
//! would bring more samples beside them and count less, and the picture would be too dark (Kirk and
//! Arvo, *Unbiased Sampling Techniques for Image Synthesis*, 1991). So pixels are coloured as a
//! chessboard is. Each colour has its share of all samples, and how they are divided is decided by
//! the pixels of the other colour: their samples are independent, and near ones have about the same
//! variance. Nothing that a pixel's number follows from hangs on its samples, so there is no bias.

#[cfg(test)]
mod tests;

use super::job::Job;
use super::{Crop, Sampling};
use crate::film::{Film, luminance_of};
use durer_scene::sampler::Sampler;
use std::sync::Arc;

/// The fewest samples a pixel, on average, that can be divided.
pub const LEAST_ADAPTIVE: u32 = 16;

/// The fewest samples of half a pilot.
const LEAST_HALF: u32 = 4;

/// No pixel gets more than so many times the average.
const MOST_TIMES: u32 = 64;

/// No pixel gets more samples than this, which a film can hold of any light.
const MOST: u32 = 1 << 20;

/// Weights of the pixels up to six away, down and across: binomial coefficients. The product of
/// both is about a normal distribution of standard deviation 1.7.
const WEIGHTS: [f32; 13] = [1.0, 12.0, 66.0, 220.0, 495.0, 792.0, 924.0, 792.0, 495.0, 220.0, 66.0, 12.0, 1.0];

/// Half of the samples that every pixel gets before it is decided who gets more, of so many on
/// average.
pub(super) fn half(samples: u32) -> u32 {
    (samples / 8).max(LEAST_HALF)
}

/// All of those.
pub(super) fn pilot(samples: u32) -> u32 {
    2 * half(samples)
}

/// The most samples that a pixel gets, of so many on average.
pub(super) fn most(samples: u32) -> u32 {
    samples.saturating_mul(MOST_TIMES).min(MOST.max(samples))
}

/// How many samples a pixel has when there are `end` a pixel on average, of `samples` in all: the
/// pilot's, and then its part of what it will have.
pub(super) fn count(samples: u32, target: u32, end: u32) -> u32 {
    let pilot = pilot(samples);
    if end <= pilot {
        return end;
    }
    let [more, gone, all] = [target - pilot, end - pilot, samples - pilot].map(u64::from);
    pilot + (more * gone / all) as u32
}

/// Why the samples of a job cannot be divided, if they cannot.
pub(super) fn refusal(job: &Job, is_whole: bool) -> Option<String> {
    let is_spread = match job.sampling {
        // A pixel's centre is too few, which is told as that.
        Sampling::Center | Sampling::Filtered { .. } => true,
        Sampling::Course2004 { sampler, filter: None, .. } => matches!(sampler, Sampler::Sobol | Sampler::Random),
        _ => false,
    };
    let samples = job.sampling.samples();
    let why = if !is_spread {
        "samples that count for several pixels, or are spread over the pixel only when all are there, are as many for \
         all pixels"
            .into()
    } else if samples < LEAST_ADAPTIVE {
        format!("what is divided by noise are at least {LEAST_ADAPTIVE} samples a pixel, and these are {samples}")
    } else if job.method.prepares() {
        "photons are sent for one sample of all pixels at a time, so all pixels have as many".into()
    } else if job.noise.is_some() {
        "either a number of samples is divided by noise, or noise says how many there are".into()
    } else if !is_whole {
        "how samples are divided is decided by all of the picture: such a picture is not split".into()
    } else {
        return None;
    };
    Some(why)
}

/// The variance of the mean luminance of each of a block's pixels, from half a pilot and all of it:
/// of two independent halves it is the square of half their difference, on average.
pub(super) fn variances(half: &Film, all: &Film, rect: Crop) -> Arc<[f32]> {
    let luminance = |film: &Film, (x, y)| luminance_of(film.resolve(x, y));
    let square = |place| {
        let moved = luminance(all, place) - luminance(half, place);
        (moved * moved) as f32
    };
    rect.places().map(square).map(|square| if square.is_finite() { square } else { 0.0 }).collect()
}

/// The variance of each pixel's mean as those of the other colour around it tell.
pub(super) fn around(variances: &[f32], width: usize) -> Vec<f32> {
    let (height, reach) = (variances.len() / width, WEIGHTS.len() / 2);
    let mut row = vec![(0.0_f32, 0.0_f32); width];
    let mut found = Vec::with_capacity(variances.len());
    for y in 0..height {
        row.fill((0.0, 0.0));
        for from in y.saturating_sub(reach)..height.min(y + reach + 1) {
            let (source, down) = (&variances[from * width..][..width], from + reach - y);
            for across in (0..WEIGHTS.len()).filter(|across| (down + across) % 2 == 1) {
                let weight = WEIGHTS[down] * WEIGHTS[across];
                // Column x takes from x + across - reach.
                let (to, from) = (reach.saturating_sub(across), across.saturating_sub(reach));
                for ((sum, weights), variance) in row.iter_mut().skip(to).zip(source.iter().skip(from)) {
                    *sum += weight * variance;
                    *weights += weight;
                }
            }
        }
        found.extend(row.iter().map(|&(sum, weights)| if weights > 0.0 { sum / weights } else { 0.0 }));
    }
    found
}

/// Divides as many samples a pixel by the pixels' standard deviations: none gets fewer than the
/// pilot's. What nobody needs is left over.
pub(super) fn divided(deviations: &[f32], samples: u32) -> Vec<u32> {
    let (least, most) = (f64::from(pilot(samples)), f64::from(most(samples)));
    let wanted = |factor: f64, deviation: f32| (factor * f64::from(deviation)).clamp(least, most);
    let all = deviations.len() as f64 * f64::from(samples);
    // The greatest factor that does not take too many. The bits of positive numbers are in their
    // order.
    let (mut low, mut high) = (0, f64::MAX.to_bits());
    while low < high {
        let middle = high - (high - low) / 2;
        let spent: f64 = deviations.iter().map(|&deviation| wanted(f64::from_bits(middle), deviation)).sum();
        if spent <= all { low = middle } else { high = middle - 1 }
    }
    // What rounding takes from one the next one gets, so the sum is as it should be.
    let (mut sum, mut given) = (0.0, 0.0);
    let rounded = |&deviation: &f32| {
        sum += wanted(f64::from_bits(low), deviation);
        let own = f64::max((sum - given).round(), least);
        given += own;
        own as u32
    };
    deviations.iter().map(rounded).collect()
}
