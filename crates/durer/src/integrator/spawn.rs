//! Secondary rays that do not hit the surface they start from.

use crate::math::{Ray, Vec3, gamma};
use crate::shape::Surface;

/// A ray from a surface.
///
/// With an `epsilon`, as the course has it: the ray starts on the surface, and hits count from there on.
/// Without: it starts beside the surface, as far away as the point may be off, and every hit counts.
pub fn from_surface(surface: &Surface, dir: Vec3, t_max: f32, epsilon: Option<f32>) -> Ray {
    if let Some(epsilon) = epsilon {
        return Ray { origin: surface.position, dir, t_min: epsilon, t_max };
    }
    let side = if dir.dot(surface.n_geo) < 0.0 { -surface.n_geo } else { surface.n_geo };
    Ray { origin: beside(surface, surface.position, side), dir, t_min: 0.0, t_max }
}

/// A ray from a surface to a light at some distance, as [`from_surface`]; without an `epsilon` it starts on the bent
/// surface that a triangle with normals at its corners stands for.
pub fn to_light(surface: &Surface, dir: Vec3, distance: f32, epsilon: Option<f32>) -> Ray {
    let behind = dir.dot(surface.n_shade) < 0.0;
    let lift = surface.lifts[usize::from(behind)];
    if epsilon.is_some() || lift == Vec3::ZERO {
        return from_surface(surface, dir, distance, epsilon);
    }
    // The bent surface faces the light; so the ray leaves on that side, whatever the triangle's own slope.
    let side = if behind { -surface.n_geo } else { surface.n_geo };
    let origin = beside(surface, surface.position + lift, side);
    Ray { origin, dir, t_min: 0.0, t_max: distance - lift.dot(dir) }
}

/// A point beside a surface, on the side to which a unit normal points, farther off than the point's error.
///
/// Source: *Physically Based Rendering*, 4th edition, section 6.8.6.
fn beside(surface: &Surface, point: Vec3, side: Vec3) -> Vec3 {
    // Twice the bound: the next intersection rounds as well.
    let offset = 2.0 * side.abs().dot(surface.error + gamma(1) * (point - surface.position).abs()) * side;
    let moved = point + offset;
    // The sum is rounded away from the surface.
    let away = |p: f32, o: f32| {
        if o > 0.0 {
            p.next_up()
        } else if o < 0.0 {
            p.next_down()
        } else {
            p
        }
    };
    Vec3::new(away(moved.x, offset.x), away(moved.y, offset.y), away(moved.z, offset.z))
}
