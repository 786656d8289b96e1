//! Secondary rays that do not hit the surface they start from.
//!
//! Why none starts behind the wall beside: a point on a surface is known in double precision in
//! world space, and to a few roundings in the space of its object, whose coordinates are of the
//! object's own size ([`Shape::centered`] takes off what is more). And a shape keeps its points off
//! its own edges by more than that error, so moving one along the normal by twice the error leaves
//! it in front of the neighbouring face as well.
//!
//! [`Shape::centered`]: durer_scene::shape::Shape::centered

use crate::world::Epsilon;
use durer_scene::math::{Ray, Ray64, Side, Vec3, gamma};
use durer_scene::shape::Surface;
use glam::DVec3;

/// A ray from a surface.
///
/// With an `epsilon`, as the course has it: the ray starts on the surface and hits count from
/// there on, or it starts a little along. Without: it starts beside the surface, as far away as the point may be off, and every
/// hit counts.
#[inline(always)]
pub fn spawn_ray(surface: &Surface, dir: Vec3, t_max: f32, epsilon: Option<Epsilon>) -> Ray64 {
    match epsilon {
        Some(Epsilon::Least(t_min)) => return Ray64::new(surface.point(), dir, t_min, t_max),
        Some(Epsilon::Along(way)) => {
            return Ray { t_max, ..Ray::new(surface.position + way * dir, dir) }.into();
        }
        None => {}
    }
    from(surface, Vec3::ZERO, dir, t_max, dir.dot(surface.n_geo) < 0.0)
}

/// A ray from a surface to a light at some distance, as [`spawn_ray`]; without an `epsilon` it
/// starts on the bent surface that a triangle with normals at its corners stands for, on the side
/// on which that faces the light. Where the triangle's own slope does not face it, it is in its own
/// way: light from outside does not come in along the border of light.
#[inline(always)]
pub fn to_light(surface: &Surface, dir: Vec3, distance: f32, epsilon: Option<Epsilon>) -> Ray64 {
    match epsilon {
        Some(_) => spawn_ray(surface, dir, distance, epsilon),
        None => from_bent_surface(surface, dir, distance, dir.dot(surface.n_shade) < 0.0),
    }
}

/// A ray from a surface to a point of a light that has an extent, on the side of the true surface
/// on which the light is. From a bent surface it is aimed anew: a parallel one would end beside
/// that point, and behind the light where that is inclined.
pub fn to_point(surface: &Surface, dir: Vec3, distance: f32) -> Ray64 {
    let ray = from_bent_surface(surface, dir, distance, dir.dot(surface.n_geo) < 0.0);
    if surface.shadow_offsets == [Vec3::ZERO; 2] || !distance.is_finite() {
        return ray;
    }
    let way = surface.point() + f64::from(distance) * dir.as_dvec3() - ray.origin();
    let length = way.length();
    Ray64::new(ray.origin(), (way / length).as_vec3(), 0.0, length as f32 * (1.0 - gamma(4))).on_side(ray.side)
}

/// A ray from the bent surface, on the side of the normals or `behind`.
#[inline(always)]
fn from_bent_surface(surface: &Surface, dir: Vec3, distance: f32, behind: bool) -> Ray64 {
    let [front, back] = surface.shadow_offsets;
    let lift = if behind { back } else { front };
    from(surface, lift, dir, distance - lift.dot(dir), behind)
}

/// A ray from beside the lifted point, on the side of the true normal or `behind`.
#[inline(always)]
fn from(surface: &Surface, lift: Vec3, dir: Vec3, t_max: f32, behind: bool) -> Ray64 {
    let side = if behind { -surface.n_geo } else { surface.n_geo };
    let ray = Ray64::new(offset_ray_origin(surface, lift, side), dir, 0.0, t_max);
    surface.solid.map_or(ray, |solid| ray.on_side(Side::of(solid, behind)))
}

/// The surface's point, lifted, and beside it on the side to which a unit normal points, farther
/// off than its error.
///
/// Source: *Physically Based Rendering*, 4th edition, section 6.8.6.
#[inline(always)]
fn offset_ray_origin(surface: &Surface, lift: Vec3, side: Vec3) -> DVec3 {
    // Twice the bound: the next intersection rounds as well.
    let offset = 2.0 * side.abs().dot(surface.error + gamma(1) * lift.abs()) * side;
    surface.point() + lift.as_dvec3() + offset.as_dvec3()
}

/// As far beside a surface's point as a ray from a flat surface starts at most.
pub fn offset_bound(surface: &Surface) -> f32 {
    2.0 * surface.error.element_sum()
}

#[cfg(test)]
mod tests;
