//! Handedness of a camera's coordinate system.

use crate::describe::described_words;
use glam::DVec3;

described_words! {
    /// Handedness of a camera: the right side of the picture is `direction` x `up` in right-handed
    /// coordinates, and the opposite (a mirror image) in left-handed ones such as RenderMan's and
    /// pbrt's.
    Handedness { Right = "right", Left = "left" }
}

impl Handedness {
    /// Returns 1 for a right-handed picture, or -1 for a mirror image.
    pub(super) fn sign(self) -> f64 {
        if self == Handedness::Left { -1.0 } else { 1.0 }
    }

    /// Converts a vector between camera space and right-handed space. The conversion is its own
    /// inverse.
    pub(super) fn convert(self, v: DVec3) -> DVec3 {
        DVec3 { x: self.sign() * v.x, ..v }
    }
}
