//! Height of the hit point.

use super::{Aov, Value};
use durer_scene::math::Vec3;

pub(super) const AOV: Aov = Aov {
    name: "heights",
    doc: "the height of the point, y",
    value: Value::Ray(|seen| seen.hit.as_ref().map_or(Vec3::ZERO, |at| Vec3::splat(at.surface.position.y))),
    picture: |value, _, _| value,
    relative: false,
    unit: None,
};
