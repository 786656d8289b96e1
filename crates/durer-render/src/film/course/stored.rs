//! Film for assignment 7 of the Fall 2004 course. It stores all samples. Each pixel is the weighted
//! mean of its own samples and the samples of neighbouring pixels.
//!
//! The samples of a pixel are added in a fixed order. The result is therefore the same if only a
//! part of the picture is rendered.

use durer_scene::math::{Color, Vec2, fp};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::convert::Infallible;

#[cfg(test)]
mod tests;

/// Position and colour of one sample on the film of the 2004 course.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StoredSample {
    /// Position within the pixel, in [0,1)^2. The axes point right and down.
    pub position: Vec2,
    /// Colour of the sample.
    pub color: Color,
}

/// All samples of a picture on the film of the 2004 course. Each pixel has the same number of
/// samples.
#[derive(Clone, Debug, PartialEq)]
pub struct StoredSamples {
    width: u32,
    height: u32,
    per_pixel: u32,
    /// Samples of each row, ordered by pixel.
    rows: Vec<Vec<StoredSample>>,
}

impl StoredSamples {
    /// Takes all samples by calling `sample(x, y, number)`, row by row from the top. `per_pixel`
    /// must be at least 1.
    pub fn take(width: u32, height: u32, per_pixel: u32, sample: impl Fn(u32, u32, u32) -> StoredSample) -> Self {
        let sample = |x, y, number| Ok::<_, Infallible>(sample(x, y, number));
        let Ok(all) = StoredSamples::try_take(width, height, per_pixel, sample);
        all
    }

    /// Takes samples like [`StoredSamples::take`] but stops at the first sample that fails.
    pub fn try_take<E>(
        width: u32,
        height: u32,
        per_pixel: u32,
        mut sample: impl FnMut(u32, u32, u32) -> Result<StoredSample, E>,
    ) -> Result<Self, E> {
        let per_pixel = per_pixel.max(1);
        let numbers = |y| (0..width).flat_map(move |x| (0..per_pixel).map(move |number| (x, y, number)));
        let mut take_row = |y| numbers(y).map(|(x, y, number)| sample(x, y, number)).collect();
        let rows: Result<Vec<Vec<StoredSample>>, E> = (0..height).map(&mut take_row).collect();
        Ok(StoredSamples { width, height, per_pixel, rows: rows? })
    }

    /// Returns the width and height in pixels.
    pub fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// Returns the samples of a pixel. Panics if the pixel is outside the picture.
    pub fn pixel(&self, x: u32, y: u32) -> &[StoredSample] {
        assert!(x < self.width && y < self.height, "the pixel must be in the picture");
        let n = self.per_pixel as usize;
        &self.rows[y as usize][x as usize * n..][..n]
    }

    /// Reconstructs the picture with row 0 at the top. Each pixel is the weighted mean of the
    /// samples in all pixels within the support of the filter.
    ///
    /// All weights can be zero if the filter is narrower than the gaps between the samples. The
    /// pixel is then the mean of its own samples.
    pub fn reconstruct(&self, filter: CourseFilter) -> Vec<Color> {
        let Ok(pixels) = self.try_reconstruct(filter, (0, 0), self.size(), || Ok::<_, Infallible>(()));
        pixels
    }

    /// Reconstructs a rectangle of the picture. Calls `go_on` regularly and stops if it returns an
    /// error.
    ///
    /// The result equals the same part of the full picture, provided that there are samples around
    /// the rectangle as far as the support of the filter or the edge of the picture.
    pub fn try_reconstruct<E>(
        &self,
        filter: CourseFilter,
        (left, top): (u32, u32),
        (width, height): (u32, u32),
        go_on: impl Fn() -> Result<(), E>,
    ) -> Result<Vec<Color>, E> {
        let places = (top..top + height).flat_map(|y| (left..left + width).map(move |x| (x, y)));
        places
            .map(|(x, y)| {
                go_on()?;
                Ok(self.filtered(filter, x, y, &go_on)?.unwrap_or_else(|| self.mean(x, y)))
            })
            .collect()
    }

    /// Returns the mean of a pixel's own samples.
    fn mean(&self, x: u32, y: u32) -> Color {
        let sum: DVec3 = self.pixel(x, y).iter().map(|s| s.color.as_dvec3()).sum();
        (sum / f64::from(self.per_pixel)).as_vec3()
    }

    /// Returns the weighted mean of the samples around a pixel, or `None` if all weights are zero.
    fn filtered<E>(
        &self,
        filter: CourseFilter,
        x: u32,
        y: u32,
        go_on: impl Fn() -> Result<(), E>,
    ) -> Result<Option<Color>, E> {
        let support = filter.support();
        let (mut sum, mut total) = (DVec3::ZERO, 0.0);
        for row in y.saturating_sub(support)..=y.saturating_add(support).min(self.height - 1) {
            go_on()?;
            for column in x.saturating_sub(support)..=x.saturating_add(support).min(self.width - 1) {
                for sample in self.pixel(column, row) {
                    let weight = f64::from(filter.weight_between((column, row), sample.position, (x, y)));
                    sum += weight * sample.color.as_dvec3();
                    total += weight;
                }
            }
        }
        Ok((total > 0.0).then(|| (sum / total).as_vec3()))
    }
}

/// Reconstruction filter of the 2004 course. Lengths are in pixels. The maximum weight is 1, and
/// the weights are not normalized.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum CourseFilter {
    /// A weight of 1 if the offset along both axes is at most the radius, and 0 otherwise.
    Box {
        /// Half the width of the box.
        radius: f32,
    },
    /// A cone that falls from 1 at the centre to 0 at the radius.
    Tent {
        /// Radius of the cone's base.
        radius: f32,
    },
    /// The Gaussian exp(-d^2 / (2 sigma^2)), which is cut off at the border of the pixels in its
    /// support, not at 2 sigma.
    Gaussian {
        /// Standard deviation.
        sigma: f32,
    },
}

impl CourseFilter {
    /// Returns the weight of a sample at this offset from the pixel's centre.
    pub fn weight(self, offset: Vec2) -> f32 {
        match self {
            CourseFilter::Box { radius } => f32::from(offset.abs().max_element() <= radius),
            // With a radius of 0, only samples at the centre count.
            CourseFilter::Tent { radius } => (1.0 - offset.length() / radius.max(f32::MIN_POSITIVE)).max(0.0),
            CourseFilter::Gaussian { sigma } => {
                fp::exp(-offset.length_squared() / (2.0 * sigma * sigma).max(f32::MIN_POSITIVE))
            }
        }
    }

    /// Returns the weight in pixel (x, y) of a sample in pixel (column, row).
    pub fn weight_between(self, (column, row): (u32, u32), position: Vec2, (x, y): (u32, u32)) -> f32 {
        // Offset from the centre of the target pixel to the corner of the pixel that contains the
        // sample.
        let corner = Vec2::new(column as f32 - x as f32, row as f32 - y as f32) - 0.5;
        self.weight(corner + position)
    }

    /// Returns the number of pixels by which the support extends beyond the pixel on each side.
    pub fn support(self) -> u32 {
        let reach = match self {
            CourseFilter::Box { radius } | CourseFilter::Tent { radius } => radius,
            CourseFilter::Gaussian { sigma } => 2.0 * sigma,
        };
        // The cast converts negative numbers to 0.
        (reach - 0.5).ceil() as u32
    }
}
