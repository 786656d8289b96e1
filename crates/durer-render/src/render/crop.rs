//! Rectangles of pixels.

use serde::{Deserialize, Serialize};

/// A rectangle of pixels in a picture, such as a block or the part to render. Coordinates are
/// measured from the upper left corner of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PixelRect {
    /// First column.
    pub left: u32,
    /// First row.
    pub top: u32,
    /// Width.
    pub width: u32,
    /// Height.
    pub height: u32,
}

impl PixelRect {
    /// Returns the rectangle that contains a single pixel.
    pub fn pixel((left, top): (u32, u32)) -> PixelRect {
        PixelRect { left, top, width: 1, height: 1 }
    }

    /// Returns the number of pixels.
    pub fn pixels(self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    /// Returns the smallest rectangle that contains both rectangles.
    pub fn union(self, other: PixelRect) -> PixelRect {
        let (left, top) = (self.left.min(other.left), self.top.min(other.top));
        let right = (self.left + self.width).max(other.left + other.width);
        let bottom = (self.top + self.height).max(other.top + other.height);
        PixelRect { left, top, width: right - left, height: bottom - top }
    }

    /// Returns the rectangle enlarged by a number of pixels on each side and clipped to the picture
    /// `within`.
    pub fn grown(self, by: u32, within: PixelRect) -> PixelRect {
        let (left, top) = (self.left.saturating_sub(by), self.top.saturating_sub(by));
        let right = self.left.saturating_add(self.width).saturating_add(by).min(within.width);
        let bottom = self.top.saturating_add(self.height).saturating_add(by).min(within.height);
        PixelRect { left, top, width: right - left, height: bottom - top }
    }

    /// Returns true if the rectangle contains a pixel.
    pub fn contains(self, x: u32, y: u32) -> bool {
        x.wrapping_sub(self.left) < self.width && y.wrapping_sub(self.top) < self.height
    }

    /// Returns the index of a pixel within the rectangle, in reading order.
    pub(super) fn index(self, x: u32, y: u32) -> usize {
        (y - self.top) as usize * self.width as usize + (x - self.left) as usize
    }

    /// Iterates over the pixels in reading order.
    pub fn pixel_positions(self) -> impl Iterator<Item = (u32, u32)> {
        (self.top..self.top + self.height).flat_map(move |y| (self.left..self.left + self.width).map(move |x| (x, y)))
    }
}
