//! Vectors, rays, boxes and transforms: what every other room is built from.

mod aabb;
mod affine;
mod doubles;
pub mod fp;
pub mod noise;
#[cfg(test)]
pub mod random;
mod ray;
pub mod roots;

pub use aabb::Aabb;
pub use affine::Affine;
pub(crate) use doubles::{Doubles, Triple};
pub use glam::{Vec2, Vec3};
pub use ray::{Line, Ray, Ray64};

/// A colour: linear Rec.709 red, green and blue. Unbounded above.
pub type Color = Vec3;

/// Half the distance from 1 to the next `f32`: the relative error of one rounding.
pub const UNIT_ROUNDOFF: f32 = f32::EPSILON * 0.5;

/// Bound on the relative error of `n` rounded operations in sequence.
///
/// Source: Higham, *Accuracy and Stability of Numerical Algorithms*, section 3.1.
pub const fn gamma(n: u32) -> f32 {
    let nu = n as f32 * UNIT_ROUNDOFF;
    nu / (1.0 - nu)
}

/// The mirror image of `direction` on a surface with unit normal `normal`.
pub fn reflect(direction: Vec3, normal: Vec3) -> Vec3 {
    direction - 2.0 * direction.dot(normal) * normal
}
