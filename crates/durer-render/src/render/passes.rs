//! Passes of a render, which determine the order of samples, and the noise estimate that ends a
//! render.

use super::crop::PixelRect;
use crate::clock::{Duration, Instant};
use crate::film::{Film, luminance_of};
use std::iter::Peekable;

/// Minimum number of samples per pixel before the noise threshold can stop a block.
pub const MIN_SAMPLES: u32 = 16;

/// Returns the numbers of samples per pixel at the ends of the passes: 1, 2, 4, 8, 16, 24, 32, 48,
/// 64, 96 and so on, up to `samples`.
///
/// The passes depend only on the number of samples. Decisions at the end of a pass are therefore
/// independent of how the picture is rendered.
pub fn ends(samples: u32) -> impl Iterator<Item = u32> {
    let powers = (0..32).flat_map(|k| {
        let power = 1_u32 << k;
        // For large steps, a pass also ends halfway to the next power of two.
        [Some(power), (power >= MIN_SAMPLES).then(|| power.saturating_add(power / 2))]
    });
    powers.flatten().take_while(move |&end| end < samples).chain([samples])
}

/// Iterator over the passes of a render. Each item is the number of samples per pixel at the end of
/// a pass.
///
/// Each pass unpacks and packs every block. Passes that are too short to be visible are therefore
/// joined, unless this would change the result.
pub struct Passes<I: Iterator<Item = u32>> {
    ends: Peekable<I>,
    joins: bool,
    /// Ends of passes that must be kept.
    kept: [u32; 2],
    /// End and number of samples of the latest pass and the time when it started.
    last: (u32, u32, Instant),
}

/// Passes that are shorter than this are joined.
const MIN_DURATION: Duration = Duration::from_millis(100);

impl<I: Iterator<Item = u32>> Passes<I> {
    /// Creates passes that end at `ends` and start at sample `from`. If `joins` is true, passes can
    /// be joined, but not across the ends in `kept`.
    pub fn new(ends: I, from: u32, joins: bool, kept: [u32; 2]) -> Self {
        Passes { ends: ends.peekable(), joins, kept, last: (from, 0, Instant::now()) }
    }
}

impl<I: Iterator<Item = u32>> Iterator for Passes<I> {
    type Item = u32;

    fn next(&mut self) -> Option<u32> {
        let (done, samples, began) = self.last;
        let now = Instant::now();
        let mut end = self.ends.next()?;
        // Without a clock (on WebAssembly), the duration of a pass is unknown.
        if self.joins && samples > 0 && !cfg!(target_family = "wasm") {
            let each = now.duration_since(began) / samples;
            let is_soon = |next: &u32| each.saturating_mul(next - done) < MIN_DURATION;
            while !self.kept.contains(&end)
                && let Some(next) = self.ends.next_if(is_soon)
            {
                end = next;
            }
        }
        self.last = (end, end - done, now);
        Some(end)
    }
}

/// Estimates the visible error of a block as the standard error of sqrt(Y). The result is the root
/// mean square over the pixels of the block.
///
/// Y is the luminance of a pixel, but at least 1/256, where 1 is white. The square root
/// approximates human perception, and the error of sqrt(Y) is the error of Y divided by 2 sqrt(Y).
/// Source: Dammertz et al., *A Hierarchical Automatic Stopping Condition for Monte Carlo Global
/// Illumination*, WSCG 2010. The estimate is computed from exact sums in a fixed order.
pub fn error(film: &Film, rect: PixelRect, gain: f32) -> f64 {
    let square = |(x, y)| {
        let luminance = luminance_of(film.resolve(x, y)).max(1.0 / 256.0);
        film.variance(x, y, gain) / (4.0 * luminance)
    };
    (rect.pixel_positions().map(square).sum::<f64>() / rect.pixels() as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_scene::math::Vec3;
    use durer_scene::sampler::random_2d;

    #[test]
    fn passes_end_at_the_documented_counts() {
        let ends = |n| ends(n).collect::<Vec<_>>();
        assert_eq!(ends(1), [1]);
        assert_eq!(ends(5), [1, 2, 4, 5]);
        assert_eq!(ends(100), [1, 2, 4, 8, 16, 24, 32, 48, 64, 96, 100]);
        assert!(ends(u32::MAX).windows(2).all(|w| w[0] < w[1]));
    }

    #[test]
    fn short_passes_are_joined_unless_they_make_decisions() {
        let of = |joins| Passes::new(ends(100), 0, joins, [0; 2]).collect::<Vec<_>>();
        assert_eq!(of(false), ends(100).collect::<Vec<_>>());
        // These passes take no measurable time.
        assert_eq!(of(true), [1, 100]);
        assert_eq!(Passes::new(ends(100), 0, true, [8, 24]).collect::<Vec<_>>(), [1, 8, 24, 100]);
        let mut slow = Passes::new(ends(8), 0, true, [0; 2]);
        let mut next = || {
            std::thread::sleep(MIN_DURATION);
            slow.next()
        };
        assert_eq!([next(), next(), next(), next(), next()], [Some(1), Some(2), Some(4), Some(8), None]);
    }

    /// Compares the estimate with the true error. The mean of n uniform numbers has the variance 1
    /// / (12 n).
    #[test]
    fn error_estimate_matches_the_error_of_the_mean() {
        let rect = PixelRect { left: 0, top: 0, width: 8, height: 8 };
        let mut film = Film::new(8, 8);
        let n = 64;
        for (x, y) in rect.pixel_positions() {
            (0..n).for_each(|s| film.add(x, y, s, Vec3::splat(random_2d(1, x, y, s, 0).x), 1.0));
        }
        let (estimate, truth) = (error(&film, rect, 1.0), (1.0 / (12.0 * f64::from(n)) / (4.0 * 0.5)).sqrt());
        // There are 64 estimates with 63 degrees of freedom each, so the standard error is about 1
        // %.
        assert!((estimate / truth - 1.0).abs() < 0.05, "{estimate} {truth}");
        let mut flat = Film::new(8, 8);
        for (x, y) in rect.pixel_positions() {
            (0..9).for_each(|s| flat.add(x, y, s, Vec3::splat(0.3), 1.0));
        }
        assert!(error(&flat, rect, 1.0) < 1e-4);
        assert_eq!(error(&Film::new(8, 8), rect, 1.0), f64::INFINITY);
    }
}
