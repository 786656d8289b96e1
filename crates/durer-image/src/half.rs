//! Numbers of half precision.

/// Converts a half-precision number, which has a sign bit, five exponent bits, and ten mantissa
/// bits.
pub fn f32_from_half(bits: u16) -> f32 {
    let (sign, exponent, mantissa) = (u32::from(bits >> 15) << 31, u32::from(bits >> 10 & 31), u32::from(bits & 1023));
    let size = match exponent {
        // Subnormal numbers are multiples of 2^-24.
        0 => mantissa as f32 * f32::from_bits((127 - 24) << 23),
        31 => f32::from_bits(0xff << 23 | mantissa << 13),
        _ => f32::from_bits((exponent + 112) << 23 | mantissa << 13),
    };
    f32::from_bits(size.to_bits() | sign)
}

#[cfg(test)]
mod tests {
    use super::f32_from_half;

    #[test]
    fn normal_subnormal_and_infinite_numbers_are_converted() {
        /// 2^-24.
        const LEAST: f32 = 1.0 / 16_777_216.0;
        let numbers = [0x3c00, 0xc000, 0x0001, 0x03ff, 0x7bff, 0x7c00, 0x8000].map(f32_from_half);
        assert_eq!(numbers[..6], [1.0, -2.0, LEAST, 1023.0 * LEAST, 65504.0, f32::INFINITY]);
        assert!(numbers[6] == 0.0 && numbers[6].is_sign_negative());
        assert!(f32_from_half(0x7e00).is_nan());
    }
}
