//! Film of Fall 2004, assignment 7: stored samples, weighted by their offset from the centre of the
//! target pixel, also from neighbouring pixels.
//!
//! Each pixel is summed in a fixed order, so it does not depend on which part of the picture is
//! rendered.

use durer_scene::math::{Color, Vec2, fp};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::convert::Infallible;

#[cfg(test)]
mod tests;

/// Sample of the 2004 film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StoredSample {
    /// Position in its pixel, in [0,1)^2, right and down.
    pub position: Vec2,
    /// Colour of the sample.
    pub color: Color,
}

/// Samples of a picture, with an equal number in each pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct StoredSamples {
    width: u32,
    height: u32,
    per_pixel: u32,
    /// Samples of each row, pixel by pixel.
    rows: Vec<Vec<StoredSample>>,
}

impl StoredSamples {
    /// Takes every sample by `sample(x, y, number)`, rows from the top. Takes at least one per
    /// pixel.
    pub fn take(width: u32, height: u32, per_pixel: u32, sample: impl Fn(u32, u32, u32) -> StoredSample) -> Self {
        let sample = |x, y, number| Ok::<_, Infallible>(sample(x, y, number));
        let Ok(all) = StoredSamples::try_take(width, height, per_pixel, sample);
        all
    }

    /// Takes samples until one fails. See [`StoredSamples::take`].
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

    /// Returns the numbers of columns and rows.
    pub fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// Returns the samples of a pixel. Panics outside the picture.
    pub fn pixel(&self, x: u32, y: u32) -> &[StoredSample] {
        assert!(x < self.width && y < self.height, "the pixel must be in the picture");
        let n = self.per_pixel as usize;
        &self.rows[y as usize][x as usize * n..][..n]
    }

    /// Returns the picture, row 0 at the top: each pixel is the weighted mean of the samples of all
    /// pixels within the filter's support, inside the picture.
    ///
    /// If all weights are zero (a filter narrower than the gaps between samples), a pixel is the
    /// mean of the samples within it.
    pub fn reconstruct(&self, filter: CourseFilter) -> Vec<Color> {
        let Ok(pixels) = self.try_reconstruct(filter, (0, 0), self.size(), || Ok::<_, Infallible>(()));
        pixels
    }

    /// Returns a part of the picture from a column and row on; regularly checks with `go_on` if it
    /// should continue.
    ///
    /// The part equals that of the whole picture if the samples extend around it by the filter's
    /// support, or to the picture's edge.
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

    fn mean(&self, x: u32, y: u32) -> Color {
        let sum: DVec3 = self.pixel(x, y).iter().map(|s| s.color.as_dvec3()).sum();
        (sum / f64::from(self.per_pixel)).as_vec3()
    }

    /// Returns the weighted mean around a pixel; `None` if no sample has a weight.
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

/// Filter of the 2004 course. Lengths are in pixels; weights are not normalised, their maximum is
/// 1.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum CourseFilter {
    /// 1 if both distances are at most the radius.
    Box {
        /// Half the width.
        radius: f32,
    },
    /// A cone: 1 at the centre, 0 at the radius.
    Tent {
        /// Radius of the cone's base.
        radius: f32,
    },
    /// exp(-d^2 / (2 sigma^2)), limited by the pixels of the support instead of cut at 2 sigma.
    Gaussian {
        /// Standard deviation.
        sigma: f32,
    },
}

impl CourseFilter {
    /// Returns the weight of a sample at an offset from the centre of the pixel.
    pub fn weight(self, offset: Vec2) -> f32 {
        match self {
            CourseFilter::Box { radius } => f32::from(offset.abs().max_element() <= radius),
            // A radius of 0 keeps only samples at the centre.
            CourseFilter::Tent { radius } => (1.0 - offset.length() / radius.max(f32::MIN_POSITIVE)).max(0.0),
            CourseFilter::Gaussian { sigma } => {
                fp::exp(-offset.length_squared() / (2.0 * sigma * sigma).max(f32::MIN_POSITIVE))
            }
        }
    }

    /// Returns the weight in pixel (x, y) of a sample at a position in another pixel.
    pub fn weight_between(self, (column, row): (u32, u32), position: Vec2, (x, y): (u32, u32)) -> f32 {
        // From the centre of the pixel to the corner of the other.
        let corner = Vec2::new(column as f32 - x as f32, row as f32 - y as f32) - 0.5;
        self.weight(corner + position)
    }

    /// Returns the number of pixels of the support on each side of the pixel.
    pub fn support(self) -> u32 {
        let reach = match self {
            CourseFilter::Box { radius } | CourseFilter::Tent { radius } => radius,
            CourseFilter::Gaussian { sigma } => 2.0 * sigma,
        };
        // Negative numbers become 0.
        (reach - 0.5).ceil() as u32
    }
}
