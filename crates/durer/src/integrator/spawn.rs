//! Secondary rays that do not hit the surface they start from.

use crate::math::{Ray, Vec3};
use crate::shape::Surface;

/// A ray from a surface.
///
/// With an `epsilon`, as the course has it: the ray starts on the surface, and hits count from there on.
/// Without: it starts beside the surface, as far away as the point may be off, and every hit counts.
/// Source: *Physically Based Rendering*, 4th edition, section 6.8.6.
pub fn from_surface(surface: &Surface, dir: Vec3, t_max: f32, epsilon: Option<f32>) -> Ray {
    if let Some(epsilon) = epsilon {
        return Ray { origin: surface.position, dir, t_min: epsilon, t_max };
    }
    let n = surface.n_geo;
    // Twice the bound: the next intersection rounds as well.
    let distance = 2.0 * n.abs().dot(surface.error);
    let offset = if dir.dot(n) < 0.0 { -distance * n } else { distance * n };
    let moved = surface.position + offset;
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
    let origin = Vec3::new(away(moved.x, offset.x), away(moved.y, offset.y), away(moved.z, offset.z));
    Ray { origin, dir, t_min: 0.0, t_max }
}
