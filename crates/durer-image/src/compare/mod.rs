//! Comparison of two pictures.
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

/// Tolerances and conversion settings for comparing two pictures with [`compare()`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Maximum difference in a channel that is ignored, in the unit of the compared values. The
    /// tolerance must be at least 0.
    pub tolerance: f32,
    /// Share of the pixels, from 0 to 1, that may exceed the tolerance.
    pub allowed_share: f64,
    /// Transfer function that is applied to a floating-point picture when it is compared with an
    /// 8-bit one.
    pub transfer: Transfer,
}

impl Default for Options {
    /// A tolerance of 1/255 for every pixel, which allows for rounding.
    fn default() -> Self {
        Options { tolerance: 1.0 / 255.0, allowed_share: 0.0, transfer: Transfer::Srgb }
    }
}

/// Result of comparing two pictures, which are identical, the same within the tolerance, or
/// different.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// All values are equal.
    Identical,
    /// The share of pixels that exceed the tolerance is within the allowed limit.
    Same,
    /// More pixels exceed the tolerance than are allowed to.
    Different,
}

impl Verdict {
    /// Name of the result in reports.
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
    /// Width of the pictures in pixels.
    pub width: u32,
    /// Height of the pictures in pixels.
    pub height: u32,
    /// Scale of the compared values, which are display values or linear light.
    pub scale: Scale,
    /// Measures of the difference between the pictures.
    pub measures: Measures,
    /// True if the pictures are the same, within the tolerance.
    pub verdict: Verdict,
    /// Mistakes that explain the difference between the pictures. Each mistake explains most of the
    /// difference that the previous ones leave. The list is empty if the pictures are the same, or
    /// if no mistake explains the difference.
    pub findings: Vec<Finding>,
    /// Regions that differ by more than the tolerance, starting with the worst; at most
    /// [`Region::LIMIT`].
    pub regions: Vec<Region>,
    /// FLIP error of each pixel, from 0 to 1, or HDR-FLIP error for linear light.
    pub flip_map: Vec<f32>,
}

impl Comparison {
    /// Returns true if the findings name the cause of the difference, and not only where it is.
    pub fn has_cause(&self) -> bool {
        self.findings.first().is_some_and(|finding| !finding.kind.ends_with("-parts"))
    }
}

/// Error that prevents two pictures from being compared: they have different sizes, or one of them
/// is invalid.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CompareError {
    /// The pictures have different sizes.
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
    /// One of the pictures is invalid.
    #[error(transparent)]
    Image(#[from] ImageError),
}

fn exchanged(a: (u32, u32), b: (u32, u32)) -> &'static str {
    if a == (b.1, b.0) { " (width and height are swapped)" } else { "" }
}

/// Number of bytes of memory needed to decode and compare two pictures.
///
/// # Errors
/// Returns [`CompareError::Sizes`] if the sizes differ, before the pictures are decoded.
pub fn memory_needed(reference: &Encoded, test: &Encoded) -> Result<u64, CompareError> {
    // The result includes memory for both pictures, for the versions of them that are displayed,
    // and for the buffers of the measures. According to measurements, comparing takes 91 bytes per
    // pixel.
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
/// If only one of the pictures is linear, both are compared as they would be displayed. A pixel
/// with a value that is not finite is excluded from the measures. A pixel of this kind exceeds any
/// tolerance, unless both pictures have the same values there.
///
/// # Errors
/// Returns [`CompareError::Sizes`] if the sizes differ, and [`CompareError::Image`] if the number
/// of pixels in a picture does not match its size.
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
