//! Comparison of pictures.
//!
//! [`compare()`] computes the usual measures (RMSE, PSNR, SSIM, FLIP), the regions that differ
//! most, and the common mistake that explains the difference ([`Finding`]).

mod filter;
mod flip;
mod heat;
mod measure;
mod mistake;
mod picture;
mod regions;
mod ssim;

#[cfg(test)]
mod tests;

use super::{Encoded, ImageError, Transfer};
use picture::Pair;

pub use heat::heat_map;
pub use measure::{Largest, Measures};
pub use mistake::Finding;
pub use picture::{Picture, Scale};
pub use picture::{linear_to_srgb, srgb_to_linear};
pub use regions::Region;

/// Tolerances and conversion for comparing two pictures with [`compare()`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Maximum difference of a channel that is ignored, in the unit of the compared values. At
    /// least 0.
    pub tolerance: f32,
    /// Share of pixels, from 0 to 1, that may exceed the tolerance.
    pub allowed_share: f64,
    /// Transfer function for a floating-point picture that is compared with an 8-bit one.
    pub transfer: Transfer,
}

impl Default for Options {
    /// A tolerance of 1/255 in every pixel, which covers rounding.
    fn default() -> Self {
        Options { tolerance: 1.0 / 255.0, allowed_share: 0.0, transfer: Transfer::Srgb }
    }
}

/// Result of comparing two pictures: identical, same within the tolerance, or different.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The values are equal everywhere.
    Identical,
    /// At most the allowed share of pixels exceeds the tolerance.
    Same,
    /// Too many pixels exceed the tolerance.
    Different,
}

impl Verdict {
    /// Name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Verdict::Identical => "identical",
            Verdict::Same => "same",
            Verdict::Different => "different",
        }
    }
}

/// Result of comparing a picture with a reference: measures, verdict, likely mistakes, and regions
/// that differ.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Scale of the compared values: display values or linear light.
    pub scale: Scale,
    /// Measures of the difference.
    pub measures: Measures,
    /// True if the pictures are the same, within the tolerance.
    pub verdict: Verdict,
    /// Mistakes that explain the difference. Each explains most of the difference that the previous
    /// ones leave. Empty if the pictures are the same, or if no mistake explains the difference.
    pub findings: Vec<Finding>,
    /// Regions that differ by more than the tolerance, worst first; at most [`Region::LIMIT`].
    pub regions: Vec<Region>,
    /// FLIP error of each pixel, from 0 to 1; HDR-FLIP for linear light.
    pub flip_map: Vec<f32>,
}

/// Error from comparing two pictures: they have different sizes, or one is invalid.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CompareError {
    /// The sizes differ.
    #[error(
        "the pictures have different sizes: {} x {} and {} x {}{}", reference.0, reference.1, test.0, test.1,
        exchanged(*reference, *test)
    )]
    Sizes {
        /// Width and height of the reference.
        reference: (u32, u32),
        /// Width and height of the other picture.
        test: (u32, u32),
    },
    /// A picture is invalid.
    #[error(transparent)]
    Image(#[from] ImageError),
}

fn exchanged(a: (u32, u32), b: (u32, u32)) -> &'static str {
    if a == (b.1, b.0) { " (width and height are swapped)" } else { "" }
}

/// Memory in bytes that decoding and comparing two pictures takes.
///
/// # Errors
/// [`CompareError::Sizes`], before the pictures are decoded.
pub fn memory_needed(reference: &Encoded, test: &Encoded) -> Result<u64, CompareError> {
    // Memory for both pictures, their displayed versions, and the buffers of the measures. By
    // measurement, it is 91 bytes per pixel.
    const BYTES_PER_PIXEL: u64 = 100;
    let [a, b] = [reference, test].map(|picture| picture.size());
    if a != b {
        let size = |(width, height)| (width as u32, height as u32);
        return Err(CompareError::Sizes { reference: size(a), test: size(b) });
    }
    let compared = (a.0 as u64 * a.1 as u64).saturating_mul(BYTES_PER_PIXEL);
    Ok(compared.max(reference.memory_needed().saturating_add(test.memory_needed())))
}

/// Compares a picture with a reference.
///
/// If only one of the pictures is linear, both are compared as displayed. A pixel with a value that
/// is not finite is excluded from the measures. It exceeds any tolerance, unless both pictures have
/// the same values at that pixel.
///
/// # Errors
/// [`CompareError::Sizes`], and [`CompareError::Image`] for a picture whose pixels do not match its
/// size.
pub fn compare(reference: &Picture, test: &Picture, options: &Options) -> Result<Comparison, CompareError> {
    let pair = Pair::new(reference, test, options.transfer)?;
    let equal = pair.reference == pair.test;
    // Search for mistakes and regions in parallel with the measures, although they are reported
    // only if the pictures differ.
    let causes = || match equal {
        true => (Vec::new(), Vec::new()),
        false => (mistake::explain(&pair), regions::worst(&pair, options.tolerance)),
    };
    let ((measures, flip_map), (findings, regions)) =
        rayon::join(|| measure::measure(&pair, options.tolerance), causes);
    let pixels = (pair.width * pair.height) as f64;
    let verdict = if measures.largest.is_none() && pair.finite_differs.is_empty() {
        Verdict::Identical
    } else if measures.over_tolerance as f64 <= options.allowed_share * pixels {
        Verdict::Same
    } else {
        Verdict::Different
    };
    let different = verdict == Verdict::Different;
    Ok(Comparison {
        width: reference.image.width,
        height: reference.image.height,
        scale: pair.scale,
        findings: if different { findings } else { Vec::new() },
        regions: if different { regions } else { Vec::new() },
        measures,
        verdict,
        flip_map,
    })
}
