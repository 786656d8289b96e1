//! Handedness of a picture.

use crate::describe::described_words;
use glam::DVec3;

described_words! {
    /// Right side of the picture: `direction` x `up` in right-handed coordinates, the opposite (a
    /// mirror image) in left-handed coordinates such as RenderMan's and pbrt's.
    Handedness { Right = "right", Left = "left" }
}

impl Handedness {
    /// Returns 1, or -1 for a mirror image.
    pub(super) fn sign(self) -> f64 {
        if self == Handedness::Left { -1.0 } else { 1.0 }
    }

    /// Converts a vector between camera space and right-handed space. The map is its own inverse.
    pub(super) fn turned(self, v: DVec3) -> DVec3 {
        DVec3 { x: self.sign() * v.x, ..v }
    }
}
