//! Mappings from the unit square to directions and points.

use crate::math::{Vec2, Vec3, fp};
use std::hint::select_unpredictable;

/// Maps the unit square uniformly to the unit disc.
///
/// Source: Shirley and Chiu, *A Low Distortion Map Between Disk and Square*, Journal of Graphics
/// Tools 2(3), 1997.
pub fn disc(u: Vec2) -> Vec2 {
    let p = 2.0 * u - 1.0;
    if p == Vec2::ZERO {
        return Vec2::ZERO;
    }
    // Compute the angle in eighths of a turn.
    let flat = p.x.abs() > p.y.abs();
    let (radius, other) = (select_unpredictable(flat, p.x, p.y), select_unpredictable(flat, p.y, p.x));
    let ratio = other / radius;
    let eighths = select_unpredictable(flat, ratio, 2.0 - ratio);
    let (sin, cos) = fp::sin_cos_turn(0.125 * eighths);
    radius * Vec2::new(cos, sin)
}

/// Returns a direction in the upper hemisphere, with the pdf cos / pi.
pub fn cosine_hemisphere(u: Vec2) -> Vec3 {
    let p = disc(u);
    p.extend((1.0 - p.length_squared()).max(0.0).sqrt())
}

/// Returns the direction with the given polar coordinates, which are the cosine of the angle to z
/// and the azimuth in turns.
pub fn polar(cosine: f32, turn: f32) -> Vec3 {
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    let (sin, cos) = fp::sin_cos_turn(turn);
    Vec3::new(sine * cos, sine * sin, cosine)
}

/// Returns a uniformly distributed direction on the sphere, with the pdf 1 / (4 pi).
pub fn sphere(u: Vec2) -> Vec3 {
    polar(1.0 - 2.0 * u.x, u.y)
}

/// Returns the barycentric coordinates of a uniformly distributed point in a triangle.
///
/// Source: Heitz, *A Low-Distortion Map Between Triangle and Square*, 2019.
pub fn triangle(u: Vec2) -> Vec3 {
    let (b0, b1) = if u.x < u.y {
        let b0 = 0.5 * u.x;
        (b0, u.y - b0)
    } else {
        let b1 = 0.5 * u.y;
        (u.x - b1, b1)
    };
    Vec3::new(b0, b1, (1.0 - b0 - b1).max(0.0))
}
