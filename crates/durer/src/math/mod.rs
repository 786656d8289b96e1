//! The kernel's vectors, rays, boxes and transforms, and what else every room is built from.

pub mod noise;
pub mod roots;

#[cfg(test)]
pub use durer_bvh::internal::random;
pub use durer_bvh::math::{Aabb, Affine, Line, Ray, Ray64, Side, UNIT_ROUNDOFF, Vec2, Vec3, fp, gamma};

/// A colour: linear Rec.709 red, green and blue. Unbounded above.
pub type Color = Vec3;

/// How much red, green and blue count for in the luminance of a colour: Rec.709.
pub const LUMINANCE: Vec3 = Vec3::new(0.2126, 0.7152, 0.0722);

/// The mirror image of `direction` on a surface with unit normal `normal`.
pub fn reflect(direction: Vec3, normal: Vec3) -> Vec3 {
    direction - 2.0 * direction.dot(normal) * normal
}
