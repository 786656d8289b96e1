//! Mapping from pixels to the square that a camera covers.

use super::CameraRules;
use crate::math::Vec2;

/// Pixel grid of a picture, and its position in the camera's square from (-1, -1) to (1, 1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Raster {
    /// Width, in pixels.
    pub width: u32,
    /// Height, in pixels.
    pub height: u32,
    border_pixels: bool,
    stretch: bool,
    /// Half the sides of the camera's natural picture in the square; `None` for any aspect ratio.
    natural: Option<Vec2>,
}

impl Raster {
    /// Creates the raster of a picture. Its larger side spans the square, unless the rules specify
    /// otherwise.
    ///
    /// If the camera has natural proportions, its picture fits inside, undistorted.
    pub fn new(width: u32, height: u32, proportions: Option<Vec2>, rules: CameraRules) -> Self {
        Raster {
            width,
            height,
            border_pixels: rules.border_pixels,
            stretch: rules.stretch,
            natural: proportions.map(|sides| sides / sides.max_element()),
        }
    }

    /// Default size of a picture: `plain`, or about as many pixels in the camera's proportions. If
    /// possible, one unit of the proportions is a whole number of pixels, so that faces and walls
    /// end between pixels.
    pub fn natural_size(proportions: Option<Vec2>, plain: (u32, u32)) -> (u32, u32) {
        let Some(sides) = proportions else { return plain };
        let scale = (plain.0 as f32 * plain.1 as f32 / (sides.x * sides.y)).sqrt();
        let scale = if scale >= 1.0 { scale.round() } else { scale };
        // Round the smaller side first; the larger side then follows as closely as possible.
        let small = (sides.min_element() * scale).round().max(1.0);
        let side = |length: f32| (small * (length / sides.min_element())).round() as u32;
        (side(sides.x), side(sides.y))
    }

    /// Number of columns and rows that are empty because the picture does not have the camera's
    /// proportions.
    pub fn empty(&self) -> (u32, u32) {
        let Some(half) = self.natural else { return (0, 0) };
        let size = Vec2::new(self.width as f32, self.height as f32);
        // A difference of less than a pixel is due to rounding of the size.
        let empty = (size - half * (size / half).min_element()).floor();
        (empty.x as u32, empty.y as u32)
    }

    /// Area of a pixel in the square.
    pub fn pixel_area(&self) -> f32 {
        let side = |to: Vec2| (self.point(to) - self.point(Vec2::ZERO)).length();
        side(Vec2::X) * side(Vec2::Y)
    }

    /// Returns the point of the square for a position in pixels from the picture's upper left
    /// corner.
    ///
    /// Pixel (i, j) has its centre at (i + 0.5, j + 0.5), j counted downwards.
    pub fn point(&self, position: Vec2) -> Vec2 {
        let [[x], [y]] = self.points([[position.x], [position.y]]);
        Vec2::new(x, y)
    }

    /// Returns the points of several positions: all x, then all y. See [`Raster::point`].
    #[inline(always)]
    pub fn points<const N: usize>(&self, places: [[f32; N]; 2]) -> [[f32; N]; 2] {
        // With pixel centres on the border, the side runs from the first centre to the last, not
        // from edge to edge.
        let inset = if self.border_pixels { 1.0 } else { 0.0 };
        let size = Vec2::new(self.width as f32, self.height as f32) - inset;
        // A single pixel lies at the centre.
        let span = match self.natural {
            Some(half) => Vec2::splat((size / half).min_element()),
            None if self.stretch => size,
            None => Vec2::splat(size.max_element()),
        };
        let span = span.max(Vec2::ONE);
        // Fractions of the square's side, from its lower left corner.
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
