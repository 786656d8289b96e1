//! Mapping from pixels to the square that a camera covers.

use super::CameraRules;
use crate::math::Vec2;

/// Pixel grid of a picture, and its position in the square of the camera from (-1, -1) to (1, 1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Raster {
    /// Width, in pixels.
    pub width: u32,
    /// Height, in pixels.
    pub height: u32,
    border_pixels: bool,
    stretch: bool,
    /// Half the width and height of the camera's natural picture in the square, or `None` if the
    /// picture can have any aspect ratio.
    natural: Option<Vec2>,
}

impl Raster {
    /// Creates the raster of a picture. The larger side of the picture spans the square, unless the
    /// rules specify otherwise.
    ///
    /// If the camera has natural proportions, its picture fits inside the raster without
    /// distortion.
    pub fn new(width: u32, height: u32, proportions: Option<Vec2>, rules: CameraRules) -> Self {
        Raster {
            width,
            height,
            border_pixels: rules.border_pixels,
            stretch: rules.stretch,
            natural: proportions.map(|sides| sides / sides.max_element()),
        }
    }

    /// Returns the default size of a picture. The size is `plain`, or a size with about as many
    /// pixels in the proportions of the camera. If possible, one unit of the proportions is a whole
    /// number of pixels, so that faces and walls end between pixels.
    pub fn natural_size(proportions: Option<Vec2>, plain: (u32, u32)) -> (u32, u32) {
        let Some(sides) = proportions else { return plain };
        let scale = (plain.0 as f32 * plain.1 as f32 / (sides.x * sides.y)).sqrt();
        let scale = if scale >= 1.0 { scale.round() } else { scale };
        // Round the smaller side first, so that the larger side can then follow as closely as
        // possible.
        let small = (sides.min_element() * scale).round().max(1.0);
        let side = |length: f32| (small * (length / sides.min_element())).round() as u32;
        (side(sides.x), side(sides.y))
    }

    /// Returns the number of columns and the number of rows that are empty because the picture does
    /// not have the proportions of the camera.
    pub fn empty(&self) -> (u32, u32) {
        let Some(half) = self.natural else { return (0, 0) };
        let size = Vec2::new(self.width as f32, self.height as f32);
        // A difference of less than a pixel is caused by rounding of the size.
        let empty = (size - half * (size / half).min_element()).floor();
        (empty.x as u32, empty.y as u32)
    }

    /// Returns the area of a pixel, measured in the square.
    pub fn pixel_area(&self) -> f32 {
        let side = |to: Vec2| (self.point(to) - self.point(Vec2::ZERO)).length();
        side(Vec2::X) * side(Vec2::Y)
    }

    /// Returns the point in the square for a position in pixels, measured from the upper left
    /// corner of the picture.
    ///
    /// Pixel (i, j) has its centre at (i + 0.5, j + 0.5), where j is counted downwards.
    pub fn point(&self, position: Vec2) -> Vec2 {
        let [[x], [y]] = self.points([[position.x], [position.y]]);
        Vec2::new(x, y)
    }

    /// Returns the points for several positions, with all x values first, followed by all y values.
    /// See [`Raster::point`].
    #[inline(always)]
    pub fn points<const N: usize>(&self, places: [[f32; N]; 2]) -> [[f32; N]; 2] {
        // If pixel centres are on the border, the side runs from the first centre to the last one,
        // instead of from edge to edge.
        let inset = if self.border_pixels { 1.0 } else { 0.0 };
        let size = Vec2::new(self.width as f32, self.height as f32) - inset;
        // A single pixel lies at the centre.
        let span = match self.natural {
            Some(half) => Vec2::splat((size / half).min_element()),
            None if self.stretch => size,
            None => Vec2::splat(size.max_element()),
        };
        let span = span.max(Vec2::ONE);
        // Compute the position relative to the lower left corner of the square, as a fraction of
        // its side.
        let (mut upwards, mut points) = (places, [[0.0; N]; 2]);
        for i in 0..N {
            upwards[1][i] = self.height as f32 - places[1][i];
        }
        for axis in 0..2 {
            for i in 0..N {
                let position = upwards[axis][i] - 0.5 * inset + 0.5 * (span - size)[axis];
                points[axis][i] = 2.0 * (position / span[axis]) - 1.0;
            }
        }
        points
    }
}
