//! Transforms of emitters, and points on emitters as seen from a receiver.

use crate::math::{Affine, Vec3};
use glam::DVec3;

/// Transform of an emitter from object space to world space; `None` is the identity.
#[derive(Clone, Copy, Debug)]
pub struct EmitterTransform<'a>(pub Option<&'a Affine>);

impl EmitterTransform<'_> {
    /// Converts a point to world space.
    pub fn point(&self, p: Vec3) -> DVec3 {
        self.0.map_or(p.as_dvec3(), |to_world| to_world.point64(p))
    }

    /// Converts a vector to world space.
    pub fn vector(&self, v: Vec3) -> Vec3 {
        self.0.map_or(v, |to_world| to_world.vector(v))
    }

    /// Converts a unit normal to world space with the inverse transpose.
    pub fn normal(&self, n: Vec3) -> Vec3 {
        self.0.map_or(n, |to_world| to_world.normal(n))
    }
}

/// Point sampled on an emitter, as seen from a receiver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EmitterPoint {
    /// Unit vector from the receiver to the point.
    pub wi: Vec3,
    /// Distance from the receiver.
    pub distance: f32,
    /// Cosine between the emitter's normal and the direction to the receiver, negative if the
    /// receiver is behind the emitter.
    pub cosine: f32,
    /// Pdf per solid angle with which the point was sampled.
    pub pdf: f32,
}

/// Distance from the surface of a ball, relative to its radius, within which a point counts as
/// lying on the surface.
pub(super) const ON_SURFACE: f32 = 1e-5;

/// Computes 1 - cos of an angle from the square of its sine, without cancellation.
pub(super) fn one_minus_cosine(sine2: f32) -> f32 {
    sine2 / (1.0 + (1.0 - sine2).max(0.0).sqrt())
}
