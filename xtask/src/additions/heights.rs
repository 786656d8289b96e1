//! Example of an AOV: the height of the hit point.

use super::{Aov, AovFunction};
use durer_scene::math::Vec3;

/// AOV with the y coordinate of the hit point.
pub(super) const AOV: Aov = Aov {
    name: "heights",
    doc: "y coordinate of the hit point, in world space",
    value: AovFunction::Ray(|input| input.hit.as_ref().map_or(Vec3::ZERO, |at| Vec3::splat(at.surface.position.y))),
    picture: |value, _, _| value,
    relative: false,
    unit: None,
    is_light: false,
};
