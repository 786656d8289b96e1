//! How two pictures differ, in numbers, places and words.
//!
//! [`compare()`] gives the usual measures (RMSE, PSNR, SSIM, FLIP), the regions that differ most,
//! and which of the usual mistakes explains the difference ([`Finding`]).

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

/// What counts as the same.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// The largest difference of a channel that does not count: of values from 0 to 1, or of light.
    /// 0 or more.
    pub tolerance: f32,
    /// The share of pixels, from 0 to 1, that may differ by more.
    pub allowed: f64,
    /// What makes eight bits of a floating-point picture where the other picture has those.
    pub transfer: Transfer,
}

impl Default for Options {
    /// One 255th, which rounding may make, in every pixel.
    fn default() -> Self {
        Options { tolerance: 1.0 / 255.0, allowed: 0.0, transfer: Transfer::Srgb }
    }
}

/// Whether two pictures are the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Every value is equal.
    Identical,
    /// No more pixels than allowed differ by more than the tolerance.
    Same,
    /// More do.
    Different,
}

impl Verdict {
    /// Its name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Verdict::Identical => "identical",
            Verdict::Same => "same",
            Verdict::Different => "different",
        }
    }
}

/// How a picture differs from a reference.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// What was compared: values for a screen or light.
    pub scale: Scale,
    /// The numbers.
    pub measures: Measures,
    /// Whether they are the same.
    pub verdict: Verdict,
    /// The mistakes that explain the difference, in the order in which they were made out: each is
    /// what explains most of what those before it left. Empty where the pictures are the same,
    /// or nothing explains the difference.
    pub findings: Vec<Finding>,
    /// Where the pictures differ by more than the tolerance, the worst first; at most
    /// [`Region::LIMIT`].
    pub regions: Vec<Region>,
    /// The FLIP error of each pixel, from 0 to 1; of HDR-FLIP for light.
    pub flip_map: Vec<f32>,
}

/// Why two pictures cannot be compared.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
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
    /// A picture is not one.
    #[error(transparent)]
    Image(#[from] ImageError),
}

fn exchanged(a: (u32, u32), b: (u32, u32)) -> &'static str {
    if a == (b.1, b.0) { " (width and height are exchanged)" } else { "" }
}

/// Bytes of memory that reading and comparing two pictures takes.
///
/// # Errors
/// [`CompareError::Sizes`], which so is known before they are decoded.
pub fn memory_needed(reference: &Encoded, test: &Encoded) -> Result<u64, CompareError> {
    // Both as they are, as they are shown, and what the measures take: 91 bytes a pixel were
    // measured.
    const BYTES_PER_PIXEL: u64 = 100;
    let [a, b] = [reference, test].map(|picture| picture.size());
    if a != b {
        let size = |(width, height)| (width as u32, height as u32);
        return Err(CompareError::Sizes { reference: size(a), test: size(b) });
    }
    let compared = (a.0 as u64 * a.1 as u64).saturating_mul(BYTES_PER_PIXEL);
    Ok(compared.max(reference.needed().saturating_add(test.needed())))
}

/// Compares a picture with a reference.
///
/// Pictures of which one alone is for a screen are compared as a screen shows them. Pixels with
/// numbers that are not finite count as over any tolerance unless both have the same ones, and are
/// left out of the measures.
///
/// # Errors
/// [`CompareError::Sizes`], and [`CompareError::Image`] for a picture whose pixels do not fit its
/// size.
pub fn compare(reference: &Picture, test: &Picture, options: &Options) -> Result<Comparison, CompareError> {
    let pair = Pair::new(reference, test, options.transfer)?;
    let equal = pair.reference == pair.test;
    // Causes are sought while the measures are taken, for time: they are said only if the pictures
    // turn out to differ.
    let causes = || match equal {
        true => (Vec::new(), Vec::new()),
        false => (mistake::explain(&pair), regions::worst(&pair, options.tolerance)),
    };
    let ((measures, flip_map), (findings, regions)) =
        rayon::join(|| measure::measure(&pair, options.tolerance), causes);
    let pixels = (pair.width * pair.height) as f64;
    let verdict = if measures.largest.is_none() && pair.finite_differs.is_empty() {
        Verdict::Identical
    } else if measures.over_tolerance as f64 <= options.allowed * pixels {
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
