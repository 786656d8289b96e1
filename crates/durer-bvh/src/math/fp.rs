//! Transcendental functions that return the same bits on every platform.
//!
//! The functions of `std` use the platform's math library, whose rounding differs between systems.
//! These functions use the pure-Rust `libm` or plain arithmetic, so images have the same bits
//! everywhere. `clippy.toml` forbids the functions of `std`.

use std::hint::select_unpredictable;

/// Returns the sine of an angle in radians.
#[inline]
pub fn sin(x: f32) -> f32 {
    libm::sinf(x)
}

/// Returns the cosine of an angle in radians.
#[inline]
pub fn cos(x: f32) -> f32 {
    libm::cosf(x)
}

/// Returns the sine and cosine of an angle in degrees, in double precision. They are exact at
/// multiples of 90 degrees.
#[inline]
pub fn sin_cos_degrees(degrees: f64) -> (f64, f64) {
    match degrees % 360.0 {
        0.0 => (0.0, 1.0),
        90.0 | -270.0 => (1.0, 0.0),
        180.0 | -180.0 => (0.0, -1.0),
        270.0 | -90.0 => (-1.0, 0.0),
        rest => {
            let radians = rest.to_radians();
            libm::sincos(radians)
        }
    }
}

/// Returns the sine and cosine of an angle in turns, for angles below 2^20. The error is about one
/// rounding. The results are exact at multiples of a quarter turn.
///
/// The nearest multiple of a quarter turn is subtracted. The remaining angle is at most an eighth
/// of a turn, where short series are accurate enough.
#[inline]
pub fn sin_cos_turn(turn: f32) -> (f32, f32) {
    const SINE: [f64; 5] = [1.0, -1.0 / 6.0, 1.0 / 120.0, -1.0 / 5_040.0, 1.0 / 362_880.0];
    const COSINE: [f64; 6] = [1.0, -0.5, 1.0 / 24.0, -1.0 / 720.0, 1.0 / 40_320.0, -1.0 / 3_628_800.0];
    // Adding this number removes the fraction. The last two bits of the sum count the quarter
    // turns.
    const WHOLE: f32 = 1.5 * (1_u32 << 23) as f32;
    let quarters = 4.0 * turn + WHOLE;
    let x = std::f64::consts::TAU * (f64::from(turn) - 0.25 * f64::from(quarters - WHOLE));
    let x2 = x * x;
    let (sin, cos) = ((x * polynomial(x2, &SINE)) as f32, polynomial(x2, &COSINE) as f32);
    // This code has no branches because all quarters are equally likely. Each quarter has its own
    // signs, and odd quarters swap sine and cosine.
    let quarter = quarters.to_bits();
    let signed = |x: f32, minus: u32| f32::from_bits(x.to_bits() ^ (minus & 2) << 30);
    let odd = quarter & 1 != 0;
    let (first, second) = (select_unpredictable(odd, cos, sin), select_unpredictable(odd, sin, cos));
    (signed(first, quarter), signed(second, quarter.wrapping_add(1)))
}

/// Returns the angle of the point (x, y) in turns, from -1/2 to 1/2. It is 0 for the origin. Both
/// coordinates must be finite.
#[inline]
pub fn atan2_turn(y: f32, x: f32) -> f32 {
    atan2_turn_f64(y.into(), x.into()) as f32
}

/// Computes [`atan2_turn`] in double precision, with a relative error of at most 2e-8 and an
/// absolute error of at most 2e-9 turns.
#[inline]
pub fn atan2_turn_f64(y: f64, x: f64) -> f64 {
    /// Coefficients of atan(t) / (2 pi t) as a polynomial in t^2 on [0, 1], interpolated at
    /// Chebyshev nodes. The error is at most 2e-9 turns.
    const ARC: [f64; 9] = [
        0.159154940584033,
        -0.05305122346559173,
        0.03181902586200661,
        -0.02260409301542911,
        0.016928919931624768,
        -0.011929371929892778,
        0.006778028242903209,
        -0.0025472797193034787,
        0.00045105534233732115,
    ];
    let (across, along) = (y.abs(), x.abs());
    let steep = across > along;
    let (low, high) = if steep { (along, across) } else { (across, along) };
    let t = if high > 0.0 { low / high } else { 0.0 };
    let eighth = t * polynomial(t * t, &ARC);
    let quarter = if steep { 0.25 - eighth } else { eighth };
    (if x < 0.0 { 0.5 - quarter } else { quarter }).copysign(y)
}

/// Returns the tangent of an angle in radians, in double precision.
#[inline]
pub fn tan_f64(x: f64) -> f64 {
    libm::tan(x)
}

/// Returns the sine and cosine of an angle in radians, in double precision.
#[inline]
pub fn sin_cos_f64(x: f64) -> (f64, f64) {
    libm::sincos(x)
}

/// Returns the arc sine in radians, in double precision.
#[inline]
pub fn asin_f64(x: f64) -> f64 {
    libm::asin(x)
}

/// Returns the arc tangent in radians, in double precision.
#[inline]
pub fn atan_f64(x: f64) -> f64 {
    libm::atan(x)
}

/// Returns the arc tangent of `y / x` in radians, in the quadrant of the point (x, y), in double
/// precision.
#[inline]
pub fn atan2_f64(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}

/// Returns the arc sine in radians.
#[inline]
pub fn asin(x: f32) -> f32 {
    libm::asinf(x)
}

/// Returns the arc tangent of `y / x` in radians, in the quadrant of the point (x, y).
#[inline]
pub fn atan2(y: f32, x: f32) -> f32 {
    libm::atan2f(y, x)
}

/// Raises `base` to the power of `exponent`.
///
/// For ordinary numbers, 2^(exponent log2 base) is computed in double precision. Its error is so
/// small that, after rounding to single precision, the result can differ from the exact one only if
/// there is nearly a tie. All other cases use `libm`.
#[inline]
pub fn pow(base: f32, exponent: f32) -> f32 {
    let usual = fast_pow(base, exponent);
    if usual.is_nan() { libm::powf(base, exponent) } else { usual }
}

/// Computes [`pow`] for ordinary numbers, and returns NaN for all others. The function has no
/// branches, so compilers can vectorise it.
#[inline(always)]
pub fn fast_pow(base: f32, exponent: f32) -> f32 {
    let power = f64::from(exponent) * log2(base);
    // The cast rounds results outside the range of single precision. NaN fails both tests.
    let is_usual = (base == base.clamp(f32::MIN_POSITIVE, f32::MAX)) & (power.abs() < 1000.0);
    if is_usual { exp2(power) as f32 } else { f32::NAN }
}

/// Returns the base-2 logarithm of a positive normal number, with an error of at most 2 roundings
/// in double precision.
///
/// The function uses the series of log2 m = 2 artanh(s) / ln 2 with s = (m - 1) / (m + 1). m lies
/// between the square roots of 1/2 and 2, so s^2 < 0.0295.
#[inline(always)]
fn log2(x: f32) -> f64 {
    /// 2 / (ln 2 (2 k + 1)).
    const SERIES: [f64; 10] = [
        2.8853900817779268,
        0.9617966939259756,
        0.5770780163555853,
        0.4121985831111324,
        0.3205988979753252,
        0.2623081892525388,
        0.22195308321368667,
        0.19235933878519512,
        0.16972882833987804,
        0.15186263588304877,
    ];
    let bits = x.to_bits();
    let exponent = bits.wrapping_sub(0x3f35_04f3) as i32 >> 23;
    let m = f64::from(f32::from_bits(bits.wrapping_sub((exponent << 23) as u32)));
    let s = (m - 1.0) / (m + 1.0);
    f64::from(exponent) + s * polynomial(s * s, &SERIES)
}

/// Computes 2^x for x between -1022 and 1022 with the series of e^(f ln 2) for |f| <= 1/2. The
/// error is at most 2 roundings in double precision.
#[inline(always)]
fn exp2(x: f64) -> f64 {
    /// (ln 2)^k / k!.
    const SERIES: [f64; 13] = [
        1.0,
        std::f64::consts::LN_2,
        0.24022650695910072,
        0.05550410866482158,
        0.009618129107628477,
        0.0013333558146428443,
        0.0001540353039338161,
        1.5252733804059841e-05,
        1.321548679014431e-06,
        1.01780860092397e-07,
        7.054911620801123e-09,
        4.4455382718708116e-10,
        2.5678435993488206e-11,
    ];
    // Adding this number removes the fraction.
    const WHOLE: f64 = 1.5 * (1_u64 << 52) as f64;
    let shifted = x + WHOLE;
    // The bits of the sum are the bits of `WHOLE` plus the integer part.
    let whole = shifted.to_bits().wrapping_sub(WHOLE.to_bits());
    f64::from_bits(whole.wrapping_add(1023) << 52) * polynomial(x - (shifted - WHOLE), &SERIES)
}

/// Evaluates c0 + c1 x + c2 x^2 + ... in pairs (Estrin's scheme). This shortens the chain of
/// dependent products.
#[inline(always)]
fn polynomial<const N: usize>(x: f64, c: &[f64; N]) -> f64 {
    let x2 = x * x;
    let pair = |i: usize| c[i] + if i + 1 < N { c[i + 1] * x } else { 0.0 };
    let (mut sum, mut power) = (pair(0), x2);
    let x4 = x2 * x2;
    let mut i = 2;
    while i < N {
        let four = pair(i) + if i + 2 < N { pair(i + 2) * x2 } else { 0.0 };
        sum += four * power;
        power *= x4;
        i += 4;
    }
    sum
}

/// Computes e^x.
#[inline]
pub fn exp(x: f32) -> f32 {
    libm::expf(x)
}

/// Returns the natural logarithm of a number.
#[inline]
pub fn ln(x: f32) -> f32 {
    libm::logf(x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Random;

    #[test]
    fn angles_in_turns_match_libm_up_to_rounding() {
        use std::f64::consts::TAU;
        for quarter in -8..=8 {
            let (sin, cos) = sin_cos_turn(0.25 * quarter as f32);
            let exact = [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)][(quarter & 3) as usize];
            assert_eq!((sin, cos), exact, "{quarter}");
        }
        let mut random = Random(5);
        for _ in 0..300_000 {
            let turn = 4.0 * random.unit() - 2.0;
            let (sin, cos) = sin_cos_turn(turn);
            let angle = TAU * f64::from(turn);
            let off = (f64::from(sin) - libm::sin(angle)).abs().max((f64::from(cos) - libm::cos(angle)).abs());
            assert!(off < 3.3e-8, "{turn}: {off}");
            let [x, y] = [random.unit() - 0.5, random.unit() - 0.5].map(|x| x * x * x);
            let off = (f64::from(atan2_turn(y, x)) - libm::atan2(y.into(), x.into()) / TAU).abs();
            assert!(off < 1.7e-8, "{x} {y}: {off}");
        }
        let axes = [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0), (0.0, 0.0)];
        assert_eq!(axes.map(|(y, x)| atan2_turn(y, x)), [0.0, 0.25, 0.5, -0.25, 0.0]);
    }

    #[test]
    fn powers_equal_rounded_double_precision_results() {
        let (mut random, mut off) = (Random(3), 0);
        for _ in 0..300_000 {
            let base = f32::from_bits((random.unit() * 0x7f00_0000 as f32) as u32 + 0x0080_0000);
            for (base, exponent) in [
                (base, 8.0 * random.unit() - 4.0),
                (random.unit(), (1.0 + 400.0 * random.unit()).floor()),
                (1.0 - 0.01 * random.unit(), 2000.0 * random.unit()),
            ] {
                let wanted = libm::pow(base.into(), exponent.into());
                let actual = pow(base, exponent);
                let next = f32::from_bits((wanted as f32).to_bits() + 1) - wanted as f32;
                assert!(
                    (actual - wanted as f32).abs() <= next || actual == wanted as f32,
                    "{base}^{exponent}: {actual}"
                );
                off += u32::from(actual != wanted as f32);
            }
        }
        assert!(off < 5, "{off}");
    }

    #[test]
    fn powers_of_special_values_match_libm() {
        let numbers = [
            0.0,
            -0.0,
            1.0,
            -1.0,
            0.5,
            2.0,
            -2.0,
            3.0,
            1e-40,
            -1e-40,
            f32::MIN_POSITIVE,
            f32::MAX,
            f32::INFINITY,
            f32::NEG_INFINITY,
            f32::NAN,
            1.0 - f32::EPSILON,
            1.0 + f32::EPSILON,
            126.0,
            149.5,
            1e30,
        ];
        for base in numbers {
            for exponent in numbers {
                let (actual, wanted) = (pow(base, exponent), libm::powf(base, exponent));
                // In some places, `libm` itself has an error of one rounding.
                let near = (actual - wanted).abs() <= f32::EPSILON * wanted.abs();
                assert!(
                    actual == wanted || near || actual.is_nan() && wanted.is_nan(),
                    "{base}^{exponent}: {actual} {wanted}"
                );
            }
        }
    }
}
