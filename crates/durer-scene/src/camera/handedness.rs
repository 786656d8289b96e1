//! Which side of a picture is right.

use crate::describe::described_words;
use glam::DVec3;

described_words! {
    /// What is to the right in the picture of somebody who looks along `direction` with `up`
    /// upwards: `direction` x `up` in coordinates of the right hand, its opposite (a mirror image)
    /// in those of the left hand, which RenderMan and pbrt have.
    Handedness { Right = "right", Left = "left" }
}

impl Handedness {
    /// 1, or -1 where the picture is a mirror image.
    pub(super) fn sign(self) -> f64 {
        if self == Handedness::Left { -1.0 } else { 1.0 }
    }

    /// A vector of the camera's space as it is in a space of the right hand, and the other way
    /// round.
    pub(super) fn turned(self, v: DVec3) -> DVec3 {
        DVec3 { x: self.sign() * v.x, ..v }
    }
}
