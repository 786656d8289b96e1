//! The films of the course's assignments: their sample positions, filters and quirks, kept as they are.
//!
//! Fall 2004, assignment 7: stored samples, weighted by their offset from the centre of the pixel they are for, also from
//! neighbouring pixels. Fall 2012, assignment 5: three by three jittered sub-pixels, blurred, averaged.
//! Rows are made in parallel; each pixel is summed in one fixed order, so threads change no bit.

use crate::math::{Color, Vec2, Vec3, fp};
use crate::sampler::random_2d;
use glam::DVec3;
use rayon::prelude::*;

/// One sample of the 2004 film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StoredSample {
    /// Position in its pixel, in [0,1)^2, right and down.
    pub position: Vec2,
    /// What was seen there.
    pub color: Color,
}

/// All samples of a picture, the same number in each pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct StoredSamples {
    width: u32,
    height: u32,
    per_pixel: u32,
    samples: Vec<StoredSample>,
}

impl StoredSamples {
    /// Takes every sample: `sample(x, y, number)`, in parallel by rows. At least one a pixel.
    pub fn take(
        width: u32,
        height: u32,
        per_pixel: u32,
        sample: impl Fn(u32, u32, u32) -> StoredSample + Sync,
    ) -> Self {
        let per_pixel = per_pixel.max(1);
        let row_length = width as usize * per_pixel as usize;
        let numbers = 0..row_length * height as usize;
        let make = |i: usize| {
            let (pixel, number) = (i / per_pixel as usize, i % per_pixel as usize);
            sample((pixel % width as usize) as u32, (pixel / width as usize) as u32, number as u32)
        };
        let samples = numbers.into_par_iter().with_min_len(row_length.max(1)).map(make).collect();
        StoredSamples { width, height, per_pixel, samples }
    }

    /// Columns and rows.
    pub fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// The samples of a pixel. Panics outside the picture.
    pub fn pixel(&self, x: u32, y: u32) -> &[StoredSample] {
        assert!(x < self.width && y < self.height, "the pixel lies in the picture");
        let n = self.per_pixel as usize;
        let start = (y as usize * self.width as usize + x as usize) * n;
        &self.samples[start..start + n]
    }

    /// The picture, row 0 at the top. Without a filter a pixel is the mean of its own samples.
    ///
    /// With one it is the weighted mean of the samples of all pixels within the filter's support, inside the picture.
    /// Where all weights are zero (a filter narrower than the gaps between samples) it is the mean of its own samples too.
    pub fn reconstruct(&self, filter: Option<CourseFilter>) -> Vec<Color> {
        let width = self.width as usize;
        let mut pixels = vec![Vec3::ZERO; width * self.height as usize];
        pixels.par_chunks_mut(width.max(1)).zip(0..self.height).for_each(|(row, y)| {
            for (pixel, x) in row.iter_mut().zip(0..self.width) {
                let filtered = filter.and_then(|filter| self.filtered(filter, x, y));
                *pixel = filtered.unwrap_or_else(|| self.mean(x, y));
            }
        });
        pixels
    }

    fn mean(&self, x: u32, y: u32) -> Color {
        let sum: DVec3 = self.pixel(x, y).iter().map(|s| s.color.as_dvec3()).sum();
        (sum / f64::from(self.per_pixel)).as_vec3()
    }

    /// Weighted mean around a pixel, or nothing where no sample counts.
    fn filtered(&self, filter: CourseFilter, x: u32, y: u32) -> Option<Color> {
        let support = filter.support();
        let (mut sum, mut total) = (DVec3::ZERO, 0.0);
        for row in y.saturating_sub(support)..=y.saturating_add(support).min(self.height - 1) {
            for column in x.saturating_sub(support)..=x.saturating_add(support).min(self.width - 1) {
                // From the centre of the pixel to the corner of the neighbour.
                let corner = Vec2::new(column as f32 - x as f32, row as f32 - y as f32) - 0.5;
                for sample in self.pixel(column, row) {
                    let weight = f64::from(filter.weight(corner + sample.position));
                    sum += weight * sample.color.as_dvec3();
                    total += weight;
                }
            }
        }
        (total > 0.0).then(|| (sum / total).as_vec3())
    }
}

/// A filter of the 2004 course. Lengths in pixels; weights are not normalised, the greatest is 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CourseFilter {
    /// 1 where both distances are at most the radius.
    Box {
        /// Half the width.
        radius: f32,
    },
    /// A cone: 1 at the centre, 0 at the radius.
    Tent {
        /// Radius of the cone's foot.
        radius: f32,
    },
    /// exp(-d^2 / (2 sigma^2)), not cut at 2 sigma but with the pixels of the support.
    Gaussian {
        /// Standard deviation.
        sigma: f32,
    },
}

impl CourseFilter {
    /// The weight of a sample at an offset from the centre of the pixel.
    pub fn weight(self, offset: Vec2) -> f32 {
        match self {
            CourseFilter::Box { radius } => f32::from(offset.abs().max_element() <= radius),
            // A radius of 0 has no samples but those on the centre.
            CourseFilter::Tent { radius } => (1.0 - offset.length() / radius.max(f32::MIN_POSITIVE)).max(0.0),
            CourseFilter::Gaussian { sigma } => {
                fp::exp(-offset.length_squared() / (2.0 * sigma * sigma).max(f32::MIN_POSITIVE))
            }
        }
    }

    /// How many pixels to each side of the pixel are looked at.
    pub fn support(self) -> u32 {
        let reach = match self {
            CourseFilter::Box { radius } | CourseFilter::Tent { radius } => radius,
            CourseFilter::Gaussian { sigma } => 2.0 * sigma,
        };
        // Negative numbers give 0.
        (reach - 0.5).ceil() as u32
    }
}

/// Position of a sub-pixel's sample in the picture three times as wide and high that `-jitter` renders, in its sub-pixels:
/// a uniform number between -1/2 and 1/2 is added to each integer coordinate.
pub fn jittered_position(seed: u64, x: u32, y: u32) -> Vec2 {
    Vec2::new(x as f32, y as f32) + (random_2d(seed, x, y, 0, 0) - 0.5)
}

/// The five weights of `-filter`, from two left to two right. They sum to 1.0001, and so the official picture does.
const BLUR: [f32; 5] = [0.1201, 0.2339, 0.2931, 0.2339, 0.1201];

/// Blurs a picture with five taps along rows, then along columns. Beyond an edge its last pixel is repeated.
///
/// Panics where there are not `width * height` pixels.
pub fn blur(pixels: &[Color], width: u32, height: u32) -> Vec<Color> {
    let (w, h) = (width as usize, height as usize);
    assert_eq!(pixels.len(), w * h, "a picture has as many pixels as its size says");
    // `at` is the place of a tap before clamping, two pixels to the right of where it lies.
    let tap = |at: usize, length: usize| at.saturating_sub(2).min(length - 1);
    let along_rows = by_pixels(w, h, |x, y| (0..5).map(|k| BLUR[k] * pixels[y * w + tap(x + k, w)]).sum());
    by_pixels(w, h, |x, y| (0..5).map(|k| BLUR[k] * along_rows[tap(y + k, h) * w + x]).sum())
}

/// Averages three by three pixels into one. Size of the result: a third of `width` and `height`, rounded down.
pub fn average_3x3(pixels: &[Color], width: u32, height: u32) -> Vec<Color> {
    let w = width as usize;
    assert_eq!(pixels.len(), w * height as usize, "a picture has as many pixels as its size says");
    by_pixels(w / 3, height as usize / 3, |x, y| {
        (0..9).map(|i| pixels[(3 * y + i / 3) * w + 3 * x + i % 3]).sum::<Vec3>() / 9.0
    })
}

/// What `-jitter -filter` makes of the picture three times as wide and high.
pub fn blur_and_average(pixels: &[Color], width: u32, height: u32) -> Vec<Color> {
    average_3x3(&blur(pixels, width, height), width, height)
}

/// A picture from a function of column and row, rows in parallel.
fn by_pixels(width: usize, height: usize, color: impl Fn(usize, usize) -> Color + Sync) -> Vec<Color> {
    let at = |i: usize| color(i % width, i / width);
    (0..width * height).into_par_iter().with_min_len(width.max(1)).map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampler::Sampler;

    const FILTERS: [Option<CourseFilter>; 5] = [
        None,
        Some(CourseFilter::Box { radius: 0.5 }),
        Some(CourseFilter::Box { radius: 1e-3 }),
        Some(CourseFilter::Tent { radius: 1.5 }),
        Some(CourseFilter::Gaussian { sigma: 0.6 }),
    ];

    fn random_samples(n: u32, color: impl Fn(u32, u32, u32) -> Color + Sync) -> StoredSamples {
        StoredSamples::take(23, 17, n, |x, y, s| {
            let position = Sampler::Random.pixel_position(1, x, y, s, n);
            StoredSample { position, color: color(x, y, s) }
        })
    }

    #[test]
    fn threads_change_no_bit() {
        let make = || {
            let samples = random_samples(4, |x, y, s| random_2d(2, x, y, s, 1).extend(0.5) * 1e3);
            FILTERS.map(|filter| {
                samples.reconstruct(filter).iter().map(|c| c.to_array().map(f32::to_bits)).collect::<Vec<_>>()
            })
        };
        let with_threads = |n| rayon::ThreadPoolBuilder::new().num_threads(n).build().unwrap().install(make);
        assert_eq!(with_threads(1), with_threads(5));
    }

    #[test]
    fn one_colour_stays_that_colour() {
        let color = Vec3::new(0.1, 0.7, 12.3);
        let samples = random_samples(7, |_, _, _| color);
        for filter in FILTERS {
            assert!(samples.reconstruct(filter).iter().all(|&c| c == color), "{filter:?}");
        }
    }

    #[test]
    fn supports_are_the_courses() {
        let boxed = |radius| CourseFilter::Box { radius }.support();
        assert_eq!([0.5, 0.6, 1.5, 1.7, 2.3, -3.0, f32::NAN].map(boxed), [0, 1, 1, 2, 2, 0, 0]);
        let gaussian = |sigma| CourseFilter::Gaussian { sigma }.support();
        assert_eq!([0.25, 0.6, 1.0, 1.7, 2.3].map(gaussian), [0, 1, 2, 3, 5]);
        // Further than the picture is wide.
        let samples = random_samples(1, |x, _, _| Vec3::splat(x as f32));
        let picture = samples.reconstruct(Some(CourseFilter::Box { radius: f32::INFINITY }));
        assert!(picture.iter().all(|c| (c.x - 11.0).abs() < 1e-5));
    }

    #[test]
    fn the_blur_spreads_a_point_by_its_taps() {
        let (w, h) = (9, 12);
        let mut point = vec![Vec3::ZERO; (w * h) as usize];
        point[(4 * w + 4) as usize] = Vec3::ONE;
        let blurred = blur(&point, w, h);
        for (x, y) in (0..w * h).map(|i| (i % w, i / w)) {
            let tap = |at: u32| if (2..=6).contains(&at) { BLUR[at as usize - 2] } else { 0.0 };
            assert!((blurred[(y * w + x) as usize].x - tap(x) * tap(y)).abs() < 1e-7);
        }
        // In a corner the taps that fall outside count for the corner.
        point.fill(Vec3::ZERO);
        point[0] = Vec3::ONE;
        let edge = BLUR[0] + BLUR[1] + BLUR[2];
        assert!((blur(&point, w, h)[0].x - edge * edge).abs() < 1e-6);
        assert_eq!(blur(&[Vec3::ONE], 1, 1).len(), 1);
        assert!(blur_and_average(&[], 0, 0).is_empty());
    }

    #[test]
    fn nine_pixels_become_their_mean() {
        let pixels: Vec<Vec3> = (0..54).map(|i| Vec3::splat((i % 9) as f32)).collect();
        let small = average_3x3(&pixels, 9, 6);
        assert_eq!(small, [1.0, 4.0, 7.0, 1.0, 4.0, 7.0].map(Vec3::splat));
    }

    #[test]
    fn jitter_stays_within_half_a_sub_pixel() {
        let offsets = (0..1000).map(|x| jittered_position(1, x, 2 * x) - Vec2::new(x as f32, 2.0 * x as f32));
        assert!(offsets.clone().all(|d| d.abs().max_element() <= 0.5));
        assert!((offsets.sum::<Vec2>() / 1000.0).length() < 0.05);
    }
}
