//! Vectors, rays, boxes and transforms from `durer-bvh`, and further mathematics that all modules
//! use.

pub mod noise;
pub mod roots;

#[doc(hidden)]
pub use durer_bvh::internal::random;
pub use durer_bvh::math::{Aabb, Affine, Line, Ray, Ray64, StartSide, UNIT_ROUNDOFF, Vec2, Vec3, fp, gamma};
pub use durer_image::{Color, LUMINANCE, LUMINANCE_F64};

/// Reflects `direction` about the unit vector `normal`.
pub fn reflect(direction: Vec3, normal: Vec3) -> Vec3 {
    direction - 2.0 * direction.dot(normal) * normal
}
