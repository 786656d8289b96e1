//! Secondary rays, which are offset so that they do not hit the surface from which they start.
//!
//! A ray never starts behind an adjacent wall. The position of a surface point is known in double
//! precision in world space, and to within a few rounding errors in object space, where coordinates
//! are as large as the object ([`Shape::centered`] removes larger offsets). The points on each
//! shape are kept away from the shape's own edges by more than that error. A point moved along the
//! normal by twice the error is therefore still in front of the adjacent face.
//!
//! [`Shape::centered`]: durer_scene::shape::Shape::centered

use crate::world::Epsilon;
use durer_scene::math::{Ray, Ray64, StartSide, Vec3, gamma};
use durer_scene::shape::SurfacePoint;
use glam::DVec3;

/// Creates a secondary ray that starts at a surface.
///
/// If there is an `epsilon`, as in the course, the ray starts on the surface and ignores hits
/// closer than `epsilon`. If there is none, the origin is offset from the surface by a bound on the
/// point's rounding error, and all hits count.
#[inline(always)]
pub fn spawn_ray(surface: &SurfacePoint, dir: Vec3, t_max: f32, epsilon: Option<Epsilon>) -> Ray64 {
    match epsilon {
        Some(Epsilon::MinT(t_min)) => return Ray64::new(surface.point(), dir, t_min, t_max),
        Some(Epsilon::OffsetOrigin(way)) => {
            return Ray { t_max, ..Ray::new(surface.position + way * dir, dir) }.into();
        }
        None => {}
    }
    offset_ray(surface, Vec3::ZERO, dir, t_max, dir.dot(surface.n_geo) < 0.0)
}

/// Creates a shadow ray to a light at a given distance; see [`spawn_ray`]. Without an `epsilon`,
/// the ray starts on the curved surface that a triangle with vertex normals approximates, on the
/// side that faces the light. If the triangle itself faces away from the light, it blocks the ray,
/// so no light leaks through along the terminator.
#[inline(always)]
pub fn to_light(surface: &SurfacePoint, dir: Vec3, distance: f32, epsilon: Option<Epsilon>) -> Ray64 {
    match epsilon {
        Some(_) => spawn_ray(surface, dir, distance, epsilon),
        None => from_curved_surface(surface, dir, distance, dir.dot(surface.n_shade) < 0.0),
    }
}

/// Creates a shadow ray to a point on an area light, starting on the side of the geometric normal
/// that faces the light. If the ray starts on a curved surface, it is aimed at the point again. A
/// ray parallel to the original direction would miss the point and could end behind an inclined
/// light.
pub fn to_point(surface: &SurfacePoint, dir: Vec3, distance: f32) -> Ray64 {
    let ray = from_curved_surface(surface, dir, distance, dir.dot(surface.n_geo) < 0.0);
    if surface.shadow_offsets == [Vec3::ZERO; 2] || !distance.is_finite() {
        return ray;
    }
    let offset = surface.point() + f64::from(distance) * dir.as_dvec3() - ray.origin();
    let length = offset.length();
    Ray64::new(ray.origin(), (offset / length).as_vec3(), 0.0, length as f32 * (1.0 - gamma(4))).on_side(ray.side)
}

/// Creates a ray that starts on the curved surface, on the side of the surface's normals or, if
/// `behind`, on the other side.
#[inline(always)]
fn from_curved_surface(surface: &SurfacePoint, dir: Vec3, distance: f32, behind: bool) -> Ray64 {
    let [front, back] = surface.shadow_offsets;
    let lift = if behind { back } else { front };
    offset_ray(surface, lift, dir, distance - lift.dot(dir), behind)
}

/// Creates a ray from a point lifted off the surface, on the side of the geometric normal or, if
/// `behind`, on the other side.
#[inline(always)]
fn offset_ray(surface: &SurfacePoint, lift: Vec3, dir: Vec3, t_max: f32, behind: bool) -> Ray64 {
    let side = if behind { -surface.n_geo } else { surface.n_geo };
    let ray = Ray64::new(offset_ray_origin(surface, lift, side), dir, 0.0, t_max);
    surface.solid.map_or(ray, |solid| ray.on_side(StartSide::of(solid, behind)))
}

/// Returns a surface point after lifting it and then moving it along a unit normal by more than its
/// rounding error.
///
/// Source: *Physically Based Rendering*, 4th edition, section 6.8.6.
#[inline(always)]
fn offset_ray_origin(surface: &SurfacePoint, lift: Vec3, side: Vec3) -> DVec3 {
    // Use twice the error bound, because the next intersection also rounds.
    let offset = 2.0 * side.abs().dot(surface.error + gamma(1) * lift.abs()) * side;
    surface.point() + lift.as_dvec3() + offset.as_dvec3()
}

/// Returns an upper bound on the distance between a flat surface and the origin of a ray that
/// starts there.
pub fn offset_bound(surface: &SurfacePoint) -> f32 {
    2.0 * surface.error.element_sum()
}

#[cfg(test)]
mod tests;
