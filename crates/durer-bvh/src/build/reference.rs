//! References to primitives: numbered boxes from which trees are built.

use super::settings::BuildSettings;
use crate::lanes::parallel_vec;
use crate::math::{Aabb, Vec3};
use crate::node::MAX_ITEMS;
use crate::parallel;
use glam::Vec4;

/// Bounding box of a primitive, or of part of a split triangle, with the number of the primitive.
/// Trees are built from these.
#[derive(Clone, Copy, Debug)]
pub struct Reference {
    pub min: Vec4,
    pub max: Vec4,
}

impl Reference {
    pub fn new(bounds: Aabb, number: u32) -> Self {
        Reference { min: bounds.min.extend(encode_lane(3, number)), max: bounds.max.extend(0.0) }
    }

    pub fn number(&self) -> u32 {
        decode_lane(self.min.w)
    }

    pub fn bounds(&self) -> Aabb {
        Aabb { min: self.min.truncate(), max: self.max.truncate() }
    }

    /// Returns twice the centre of the box.
    #[inline]
    pub fn double_center(&self) -> Vec4 {
        self.min + self.max
    }
}

/// Encodes a number below 2^28 and a tag of 2 or 3 as a normal `f32`, to be stored in the fourth
/// lane of a vector. Unlike denormal numbers, normal numbers do not slow down arithmetic on the
/// lane.
pub fn encode_lane(tag: u32, number: u32) -> f32 {
    f32::from_bits(number | tag << 28)
}

/// Decodes the number from a value that [`encode_lane`] returned.
pub fn decode_lane(lane: f32) -> u32 {
    lane.to_bits() & !(3 << 28)
}

/// Creates references to boxes 0, 1, 2, ..., leaving out empty boxes.
pub fn references(boxes: &[Aabb]) -> Vec<Reference> {
    assert!(boxes.len() <= MAX_ITEMS, "a tree holds fewer than 2^28 primitives");
    let full = boxes.iter().enumerate().filter(|(_, b)| !b.is_empty());
    full.map(|(i, b)| Reference::new(*b, i as u32)).collect()
}

/// Returns true if all corners are finite, so that rays can hit the triangle.
pub fn is_finite(corners: &[Vec3; 3]) -> bool {
    corners.iter().all(|p| p.is_finite())
}

/// Creates references to triangles 0, 1, 2, ..., with capacity for the references that splits add.
/// Triangles that have a non-finite corner are left out.
pub fn triangle_references(
    count: usize,
    settings: &BuildSettings,
    corners_of: &(impl Fn(u32) -> [Vec3; 3] + Sync),
) -> Vec<Reference> {
    let mut references = parallel_vec(count, settings.max_added_references(count), |i| {
        let corners = corners_of(i as u32);
        Reference::new(if is_finite(&corners) { Aabb::around(corners) } else { Aabb::EMPTY }, i as u32)
    });
    if parallel::any(&references, 4096, |r| r.min.x > r.max.x) {
        references.retain(|r| r.min.x <= r.max.x);
    }
    references
}

/// Returns the power of two that scales sizes to about 1, so that areas neither overflow nor
/// underflow.
pub fn area_scale(bounds: Aabb) -> f32 {
    let size = (bounds.max * 0.5 - bounds.min * 0.5).max_element();
    let exponent = size.to_bits() >> 23 & 0xff;
    // The result is 2^-e for a size of about 2^e, clamped to the range of `f32`.
    f32::from_bits((254 - exponent.clamp(1, 253)) << 23)
}
