//! Vectors, rays, boxes and affine maps.

mod aabb;
mod affine;
mod doubles;
pub mod fp;
#[doc(hidden)]
pub mod random;
mod ray;

pub use aabb::Aabb;
pub use affine::Affine;
pub(crate) use doubles::{Doubles, Triple};
pub use glam::{Vec2, Vec3};
pub use ray::{Line, Ray, Ray64};

/// Half the distance from 1 to the next `f32`: the relative error of one rounding.
pub const UNIT_ROUNDOFF: f32 = f32::EPSILON * 0.5;

/// Bound on the relative error of `n` rounded operations in sequence.
///
/// Source: Higham, *Accuracy and Stability of Numerical Algorithms*, section 3.1.
pub const fn gamma(n: u32) -> f32 {
    let nu = n as f32 * UNIT_ROUNDOFF;
    nu / (1.0 - nu)
}

/// The unit normal (b - a) x (c - a) of a triangle; zero if it has no area.
pub fn triangle_normal([a, b, c]: [Vec3; 3]) -> Vec3 {
    // In double precision, where differences and products of single ones do not vanish.
    let [a, b, c] = [a, b, c].map(Vec3::as_dvec3);
    (b - a).cross(c - a).normalize_or_zero().as_vec3()
}
