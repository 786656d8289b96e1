//! Aperture of a lens: a disc, or a regular polygon if the lens has straight blades.
//!
//! Shirley and Chiu's concentric mapping takes the unit square to the disc and preserves relative
//! areas and neighbourhoods (*A Low Distortion Map Between Disk and Square*, Journal of Graphics
//! Tools 2(3), 1997). For straight blades, a sector of the disc is then mapped to the triangle of a
//! blade. The fraction of the angle becomes the position along the blade, and the radius scales the
//! triangle.

use crate::math::{Vec2, fp};
use glam::DVec2;
use std::f64::consts::{FRAC_PI_4, TAU};

/// Maximum number of blades in a lens.
pub const MAX_BLADES: u32 = 64;

/// Samples an aperture of radius 1 around the origin uniformly by area. The aperture is a disc for
/// 0 blades, and otherwise a regular polygon. The first corner of the polygon is on the right
/// before the polygon is turned counter-clockwise by `turn` degrees. The point (0.5, 0.5) maps to
/// the centre.
pub fn sample(lens: Vec2, blades: u32, turn: f32) -> DVec2 {
    let square = 2.0 * lens.as_dvec2() - 1.0;
    if square == DVec2::ZERO {
        return DVec2::ZERO;
    }
    // Compute the polar coordinates of the point on its circle.
    let (radius, angle) = match square.x.abs() > square.y.abs() {
        true => (square.x, FRAC_PI_4 * (square.y / square.x)),
        false => (square.y, 2.0 * FRAC_PI_4 - FRAC_PI_4 * (square.x / square.y)),
    };
    let turn = f64::from(turn).to_radians();
    let direction = |angle: f64| {
        let (sin, cos) = fp::sin_cos_f64(angle + turn);
        DVec2::new(cos, sin)
    };
    if blades == 0 {
        return radius * direction(angle);
    }
    // A negative radius is equivalent to a positive radius in the opposite direction.
    let angle = if radius < 0.0 { angle + 0.5 * TAU } else { angle };
    let share = angle.rem_euclid(TAU) / TAU * f64::from(blades);
    let along = share - share.floor();
    let corner = |i: f64| direction(TAU * i / f64::from(blades));
    let (first, second) = (corner(share.floor()), corner(share.floor() + 1.0));
    radius.abs() * (first + along * (second - first))
}

/// Checks the number of blades.
///
/// # Errors
///
/// Fails for 1 blade, 2 blades and more than [`MAX_BLADES`] blades.
pub fn validate(blades: u32) -> Result<(), String> {
    let wrong = (1..=2).contains(&blades) || blades > MAX_BLADES;
    match wrong {
        true => Err(format!("`blades` must be 0 (a round opening) or from 3 to {MAX_BLADES}")),
        false => Ok(()),
    }
}
