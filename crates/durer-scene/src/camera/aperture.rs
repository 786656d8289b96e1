//! Aperture of a lens: a disc, or a regular polygon if the lens has straight blades.
//!
//! Shirley and Chiu's concentric map maps the unit square to the disc and preserves relative areas
//! and neighbourhoods (*A Low Distortion Map Between Disk and Square*, Journal of Graphics Tools
//! 2(3), 1997). A sector of the disc then maps to the triangle of a blade: the fraction of the
//! angle becomes the position along the blade, and the radius scales the triangle.

use crate::math::{Vec2, fp};
use glam::DVec2;
use std::f64::consts::{FRAC_PI_4, TAU};

/// Maximum number of blades of a lens.
pub const MAX_BLADES: u32 = 64;

/// Samples an aperture of radius 1 around 0 uniformly by area: a disc for 0 blades, otherwise a
/// regular polygon with its first corner on the right, turned counter-clockwise by `turn` degrees.
/// (0.5, 0.5) maps to the centre.
pub fn sample(lens: Vec2, blades: u32, turn: f32) -> DVec2 {
    let square = 2.0 * lens.as_dvec2() - 1.0;
    if square == DVec2::ZERO {
        return DVec2::ZERO;
    }
    // Polar coordinates of the point on its circle.
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
    // A negative radius is a positive radius in the opposite direction.
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
/// A message for 1, 2 and more than [`MAX_BLADES`].
pub fn validate(blades: u32) -> Result<(), String> {
    let wrong = (1..=2).contains(&blades) || blades > MAX_BLADES;
    match wrong {
        true => Err(format!("`blades` must be 0, for a round opening, or 3 to {MAX_BLADES}")),
        false => Ok(()),
    }
}
