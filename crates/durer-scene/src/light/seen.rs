//! Placement of lamps, and points on them as they are seen.

use crate::math::{Affine, Vec3};
use glam::DVec3;

/// Placement of an object in the world; `None` is the identity.
#[derive(Clone, Copy, Debug)]
pub struct Placement<'a>(pub Option<&'a Affine>);

impl Placement<'_> {
    /// A point in world space.
    pub fn point(&self, p: Vec3) -> DVec3 {
        self.0.map_or(p.as_dvec3(), |to_world| to_world.point64(p))
    }

    /// A vector in world space.
    pub fn vector(&self, v: Vec3) -> Vec3 {
        self.0.map_or(v, |to_world| to_world.vector(v))
    }

    /// A unit normal in world space, by the inverse transpose.
    pub fn normal(&self, n: Vec3) -> Vec3 {
        self.0.map_or(n, |to_world| to_world.normal(n))
    }
}

/// Point sampled on an emitter, as seen from a receiver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EmitterPoint {
    /// Unit vector to it.
    pub wi: Vec3,
    /// How far it is.
    pub distance: f32,
    /// The cosine of the emitter's normal there to the way back; less than 0 behind it.
    pub cosine: f32,
    /// Density per solid angle with which it was chosen.
    pub pdf: f32,
}

/// Points within this share of a ball's radius of its surface lie on it.
pub(super) const ON_SURFACE: f32 = 1e-5;

/// 1 - cos of the angle whose sine's square is given, without cancellation.
pub(super) fn one_minus_cosine(sine2: f32) -> f32 {
    sine2 / (1.0 + (1.0 - sine2).max(0.0).sqrt())
}
