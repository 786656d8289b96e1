//! Bounds on rounding errors in single precision.

/// Half the distance from 1 to the next `f32`, which is the relative error of one rounding.
pub const UNIT_ROUNDOFF: f32 = f32::EPSILON * 0.5;

/// Returns a bound on the relative error after `n` rounded operations in sequence.
///
/// Source: Higham, *Accuracy and Stability of Numerical Algorithms*, section 3.1.
pub const fn gamma(n: u32) -> f32 {
    let nu = n as f32 * UNIT_ROUNDOFF;
    nu / (1.0 - nu)
}
