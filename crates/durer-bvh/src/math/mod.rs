//! Vectors, rays, boxes and affine maps.

mod aabb;
mod affine;
mod doubles;
pub mod fp;
#[doc(hidden)]
pub mod random;
mod ray;
mod rounding;

pub use aabb::Aabb;
pub use affine::Affine;
pub(crate) use doubles::{Doubles, Triple};
pub use glam::{Vec2, Vec3};
pub use ray::{Line, Ray, Ray64, StartSide};
pub use rounding::{UNIT_ROUNDOFF, gamma};

/// Returns the unit normal (b - a) x (c - a) of a triangle, or zero if the triangle has no area.
#[inline]
pub fn triangle_normal([a, b, c]: [Vec3; 3]) -> Vec3 {
    // In double precision, differences and products of single-precision numbers do not underflow to
    // zero.
    let [a, b, c] = [a, b, c].map(Vec3::as_dvec3);
    (b - a).cross(c - a).normalize_or_zero().as_vec3()
}
