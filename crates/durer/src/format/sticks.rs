//! What has no surface as something that is seen: lines as sticks, points as balls.

use crate::math::Vec3;
use crate::scene::Node;
use crate::shape::{Cone, Cylinder, Sphere};

/// A stick from a point to another with a radius at each; `None` where they are the same.
pub(super) fn stick(from: Vec3, to: Vec3, [first, last]: [f32; 2]) -> Option<Node> {
    let shape = match first == last {
        true => Cylinder { base: from, top: to, radius: first }.into(),
        false => Cone { base: from, top: to, base_radius: first, top_radius: last }.into(),
    };
    (from != to).then_some(Node::Primitive(shape))
}

/// A ball about a point.
pub(super) fn ball(center: Vec3, radius: f32) -> Node {
    Node::Primitive(Sphere { center, radius }.into())
}
