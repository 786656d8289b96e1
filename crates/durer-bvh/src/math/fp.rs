//! Pinned transcendental functions.
//!
//! The platform's libm rounds differently from system to system. All functions here are computed by
//! the pure-Rust `libm`, so that a picture has the same bits everywhere. `clippy.toml` forbids the
//! others.

/// Sine of an angle in radians.
#[inline]
pub fn sin(x: f32) -> f32 {
    libm::sinf(x)
}

/// Cosine of an angle in radians.
#[inline]
pub fn cos(x: f32) -> f32 {
    libm::cosf(x)
}

/// Sine and cosine of an angle in degrees, in double precision; exact at multiples of 90 degrees.
#[inline]
pub fn sin_cos_degrees(degrees: f64) -> (f64, f64) {
    match degrees % 360.0 {
        0.0 => (0.0, 1.0),
        90.0 | -270.0 => (1.0, 0.0),
        180.0 | -180.0 => (0.0, -1.0),
        270.0 | -90.0 => (-1.0, 0.0),
        rest => {
            let radians = rest.to_radians();
            (libm::sin(radians), libm::cos(radians))
        }
    }
}

/// Tangent of an angle in radians, in double precision.
#[inline]
pub fn tan_f64(x: f64) -> f64 {
    libm::tan(x)
}

/// Sine and cosine of an angle in radians, in double precision.
#[inline]
pub fn sin_cos_f64(x: f64) -> (f64, f64) {
    (libm::sin(x), libm::cos(x))
}

/// Arc sine in radians, in double precision.
#[inline]
pub fn asin_f64(x: f64) -> f64 {
    libm::asin(x)
}

/// Arc tangent in radians, in double precision.
#[inline]
pub fn atan_f64(x: f64) -> f64 {
    libm::atan(x)
}

/// Arc tangent of `y / x` with the quadrant of the point (x, y), in radians, in double precision.
#[inline]
pub fn atan2_f64(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}

/// Arc sine, in radians.
#[inline]
pub fn asin(x: f32) -> f32 {
    libm::asinf(x)
}

/// Arc tangent of `y / x` with the quadrant of the point (x, y), in radians.
#[inline]
pub fn atan2(y: f32, x: f32) -> f32 {
    libm::atan2f(y, x)
}

/// `base` to the power of `exponent`.
#[inline]
pub fn pow(base: f32, exponent: f32) -> f32 {
    libm::powf(base, exponent)
}

/// e to the power of `x`.
#[inline]
pub fn exp(x: f32) -> f32 {
    libm::expf(x)
}

/// Natural logarithm.
#[inline]
pub fn ln(x: f32) -> f32 {
    libm::logf(x)
}
