//! Variable-length encoding of integers in checkpoint files.
//!
//! An integer is written in groups of seven bits, lowest group first. The eighth bit of each byte
//! is set if more bytes follow (LEB128). Signed integers are first mapped to unsigned integers in
//! the order 0, -1, 1, -2, ... (zigzag), so that small magnitudes take few bytes.

/// Appends an unsigned integer to `out`.
pub fn write_unsigned(out: &mut Vec<u8>, mut number: u128) {
    while number > 0x7f {
        out.push(number as u8 | 0x80);
        number >>= 7;
    }
    out.push(number as u8);
}

/// Appends a signed integer to `out`.
pub fn write_signed(out: &mut Vec<u8>, number: i128) {
    write_unsigned(out, ((number << 1) ^ (number >> 127)) as u128);
}

/// Reader for encoded integers and floats in untrusted data. Its methods return `None` for
/// truncated or invalid data and never panic.
#[derive(Clone, Copy, Debug)]
pub struct ByteReader<'a>(pub &'a [u8]);

impl<'a> ByteReader<'a> {
    /// Reads the next `count` bytes.
    pub fn take(&mut self, count: usize) -> Option<&'a [u8]> {
        let (bytes, rest) = self.0.split_at_checked(count)?;
        self.0 = rest;
        Some(bytes)
    }

    /// Reads an unsigned integer. Returns `None` if it does not fit into `T`.
    pub fn read_unsigned<T: TryFrom<u128>>(&mut self) -> Option<T> {
        let mut number = 0_u128;
        for shift in (0..128).step_by(7) {
            let byte = self.take(1)?[0];
            let bits = u128::from(byte & 0x7f);
            number |= bits << shift;
            if byte < 0x80 {
                // Reject integers that lost high bits in the shift.
                return if number >> shift == bits { number.try_into().ok() } else { None };
            }
        }
        None
    }

    /// Reads a signed integer. Returns `None` if it does not fit into `T`.
    pub fn signed<T: TryFrom<i128>>(&mut self) -> Option<T> {
        let number: u128 = self.read_unsigned()?;
        ((number >> 1) as i128 ^ -((number & 1) as i128)).try_into().ok()
    }

    /// Reads a little-endian float. Any bit pattern is valid.
    pub fn float(&mut self) -> Option<f32> {
        Some(f32::from_le_bytes(self.take(4)?.try_into().ok()?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn numbers_survive_encoding(numbers in prop::collection::vec((any::<u128>(), any::<i128>(), 0_u32..128), 1..20)) {
            let numbers: Vec<_> = numbers.into_iter().map(|(u, i, s)| (u >> s, i >> s)).collect();
            let mut out = Vec::new();
            for &(whole, signed) in &numbers {
                write_unsigned(&mut out, whole);
                write_signed(&mut out, signed);
            }
            let mut bytes = ByteReader(&out);
            for &(whole, signed) in &numbers {
                prop_assert_eq!((bytes.read_unsigned(), bytes.signed()), (Some(whole), Some(signed)));
            }
            prop_assert!(bytes.0.is_empty() && bytes.read_unsigned::<u8>().is_none());
        }

        #[test]
        fn arbitrary_bytes_are_read_or_rejected(junk in prop::collection::vec(any::<u8>(), 0..60)) {
            let mut bytes = ByteReader(&junk);
            while bytes.signed::<i64>().is_some() {}
            let _ = (bytes.float(), bytes.take(usize::MAX));
        }
    }
}
