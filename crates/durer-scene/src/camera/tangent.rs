//! Computes the tangent in single precision, as the official programs of 2016 and 2020 do.
//!
//! For one angle in thirty, for example 60 degrees, the result is off by one unit in the last
//! place. An error in this tangent changes all camera rays.
//!
//! Source: fdlibm, Sun Microsystems 1993, in the single-precision version of glibc before 2.40.

#![expect(clippy::excessive_precision, reason = "as the source writes them")]

/// Coefficients of x^3, x^5 and so on.
const SERIES: [f32; 13] = [
    3.3333334327e-01,
    1.3333334029e-01,
    5.3968254477e-02,
    2.1869488060e-02,
    8.8632395491e-03,
    3.5920790397e-03,
    1.4562094584e-03,
    5.8804126456e-04,
    2.4646313977e-04,
    7.8179444245e-05,
    7.1407252108e-05,
    -1.8558637748e-05,
    2.5907305826e-05,
];

/// Pi/4 as a sum of two numbers.
const QUARTER: [f32; 2] = [7.8539812565e-01, 3.7748947079e-08];
/// Pi/2 as the sum of its first 17 bits and the remainder. The last two entries are the next 17
/// bits of pi/2 and the remainder after those bits.
const HALF: [f32; 4] = [1.5707855225e+00, 1.0804334124e-05, 1.0804273188e-05, 6.0770999344e-11];
/// Limit above which the series is evaluated at pi/4 minus the angle.
const LARGE: f32 = f32::from_bits(0x3f2c_a140);

/// Limit below which the linear approximation of the tangent is accurate enough.
const TINY: f32 = 1.0 / 8192.0;

/// Returns the tangent of an angle in radians, from 0 to pi/2.
pub(super) fn tangent(x: f32) -> f32 {
    if x <= QUARTER[0] {
        return series([x, 0.0], false);
    }
    let mut rest = x - HALF[0];
    let mut part = HALF[1];
    if x.to_bits() & !0xf == 0x3fc9_0fd0 {
        (rest, part) = (rest - HALF[2], HALF[3]);
    }
    let over = rest - part;
    series([over, (rest - over) - part], true)
}

/// Returns the tangent of the sum of an angle and its low-order part, or the negative reciprocal of
/// the tangent if `turned` is set.
fn series([mut x, mut rest]: [f32; 2], turned: bool) -> f32 {
    let sign = if turned { -1.0 } else { 1.0 };
    let (is_negative, is_large) = (x < 0.0, x.abs() >= LARGE);
    if is_large {
        if is_negative {
            (x, rest) = (-x, -rest);
        }
        (x, rest) = ((QUARTER[0] - x) + (QUARTER[1] - rest), 0.0);
        if x.abs() < TINY {
            let near = sign * (1.0 - 2.0 * sign * x);
            return if is_negative { -near } else { near };
        }
    }
    let square = x * x;
    let fourth = square * square;
    // Use every second coefficient, from the last to the first.
    let sum = |first: usize| SERIES.iter().skip(first).step_by(2).rev().copied().reduce(|sum, c| c + fourth * sum);
    let (odd, even) = (sum(1).unwrap_or(0.0), square * sum(2).unwrap_or(0.0));
    let cube = square * x;
    let r = rest + square * (cube * (odd + even) + rest) + SERIES[0] * cube;
    let whole = x + r;
    if is_large {
        let large = sign - 2.0 * (x - (whole * whole / (whole + sign) - r));
        return if is_negative { -large } else { large };
    }
    if !turned {
        return whole;
    }
    // Compute the reciprocal in two parts.
    let high = |x: f32| f32::from_bits(x.to_bits() & 0xffff_f000);
    let (first, inverse) = (high(whole), -1.0 / whole);
    let second = r - (first - x);
    let near = high(inverse);
    near + inverse * ((1.0 + near * first) + near * second)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::fp;

    #[test]
    fn tangents_are_those_of_the_library() {
        // These values are from glibc 2.36.
        for (degrees, bits) in TANGENTS {
            let radians = (std::f64::consts::PI * f64::from(degrees) / 180.0) as f32;
            assert_eq!(tangent(radians / 2.0).to_bits(), bits, "{degrees}");
        }
    }

    #[test]
    fn tangents_are_off_by_a_unit_in_the_last_place_at_most() {
        for i in 1..15_700 {
            let x = i as f32 * 1e-4;
            let exact = fp::tan_f64(f64::from(x)) as f32;
            assert!(tangent(x).to_bits().abs_diff(exact.to_bits()) <= 1, "{x}");
        }
    }

    const TANGENTS: [(f32, u32); 20] = [
        (1.0, 0x3c0e_fb23),
        (5.0, 0x3d32_d5d1),
        (20.0, 0x3e34_8f0f),
        (25.0, 0x3e63_03ed),
        (30.0, 0x3e89_30a3),
        (35.0, 0x3ea1_6ed8),
        (40.0, 0x3eba_5a4e),
        (45.0, 0x3ed4_13cd),
        (60.0, 0x3f13_cd3b),
        (70.0, 0x3f33_40cd),
        (77.0, 0x3f4b_a1b0),
        (89.9, 0x3f7f_8db8),
        (90.0, 0x3f80_0000),
        (90.1, 0x3f80_393d),
        (100.0, 0x3f98_8b62),
        (120.0, 0x3fdd_b3d8),
        (150.0, 0x406e_d9ea),
        (175.0, 0x41b7_3af8),
        (179.0, 0x42e5_2d37),
        (179.9, 0x448f_3c54),
    ];
}
