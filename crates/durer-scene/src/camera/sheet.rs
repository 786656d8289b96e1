//! Pictures with proportions of their own, as sheets of paper measured in the camera's own unit.

use crate::math::Vec2;
use glam::DVec2;

/// A picture's natural width and height. Places on it are counted from its lower left corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sheet(pub DVec2);

impl Sheet {
    /// How many units of the sheet a unit of the square is.
    pub fn unit(self) -> f64 {
        0.5 * self.0.max_element()
    }

    /// The place of a point of the square.
    pub fn place(self, point: DVec2) -> DVec2 {
        0.5 * self.0 + self.unit() * point
    }

    /// The point of the square for a place.
    pub fn point(self, place: DVec2) -> DVec2 {
        (place - 0.5 * self.0) / self.unit()
    }

    /// Whether a place lies on it, its edges included.
    pub fn contains(self, place: DVec2) -> bool {
        place.cmpge(DVec2::ZERO).all() && place.cmple(self.0).all()
    }

    /// Its sides, as [`super::Projection::proportions`] has them.
    pub fn proportions(self) -> Option<Vec2> {
        Some(self.0.as_vec2())
    }
}
