//! Pictures with natural proportions, treated as sheets of paper that are measured in the camera's
//! own unit.

use crate::math::Vec2;
use glam::DVec2;

/// Natural width and height of a camera's picture, in the camera's own unit. Positions on the sheet
/// are relative to its lower left corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PictureSheet(pub DVec2);

impl PictureSheet {
    /// Returns the number of sheet units per unit of the square.
    pub fn unit(self) -> f64 {
        0.5 * self.0.max_element()
    }

    /// Returns the position on the sheet for a point of the square.
    pub fn position(self, point: DVec2) -> DVec2 {
        0.5 * self.0 + self.unit() * point
    }

    /// Returns the point of the square for a position on the sheet.
    pub fn point(self, position: DVec2) -> DVec2 {
        (position - 0.5 * self.0) / self.unit()
    }

    /// True if a position lies on the sheet or on its edges.
    pub fn contains(self, position: DVec2) -> bool {
        position.cmpge(DVec2::ZERO).all() && position.cmple(self.0).all()
    }

    /// Returns the width and height of the sheet. See [`super::Projection::proportions`].
    pub fn proportions(self) -> Option<Vec2> {
        Some(self.0.as_vec2())
    }
}
