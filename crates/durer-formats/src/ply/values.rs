//! Sequential reading of values from a PLY file, as text or binary.

use super::header::NumberType;
use crate::number::{NumberError, parse_f32, parse_integer};
use std::ops::Range;

/// Reason why a value in a row of a PLY file cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ValueError {
    /// The file ends before the value.
    End,
    /// The value is not a valid number.
    Number(NumberError),
}

/// Cursor that reads the values of PLY rows one after another; it is implemented for text and for
/// binary files.
pub(super) trait ValueReader: Clone {
    /// `Some(true)` for big-endian values, `Some(false)` for little-endian values, and `None` for
    /// text.
    const BIG_ENDIAN: Option<bool>;
    /// Byte range of the last value that was read, or an empty range at the end of the file.
    fn last(&self) -> Range<usize>;
    /// Upper bound on the number of values of this type that can still follow in the file.
    fn most_left(&self, scalar: NumberType) -> usize;
    /// Reads a finite number.
    fn float(&mut self, scalar: NumberType) -> Result<f32, ValueError>;
    /// Reads an integer.
    fn integer(&mut self, scalar: NumberType) -> Result<i64, ValueError>;
    /// Skips `count` values of a type, which may be invalid numbers.
    fn skip(&mut self, scalar: NumberType, count: usize) -> Result<(), ValueError>;
    /// Byte range of the part that has not been read yet, without leading whitespace.
    fn remainder(&self) -> Range<usize>;
    /// Size in bytes of a value of this type, or `None` if the size varies.
    fn fixed_size(scalar: NumberType) -> Option<usize>;
}

/// Cursor that reads the values of a text PLY file, which are separated by whitespace.
#[derive(Clone)]
pub(super) struct AsciiValues<'a> {
    bytes: &'a [u8],
    start: usize,
    end: usize,
}

impl<'a> AsciiValues<'a> {
    pub fn new(bytes: &'a [u8], start: usize) -> Self {
        AsciiValues { bytes, start, end: start }
    }

    fn word(&mut self) -> Result<&'a [u8], ValueError> {
        let rest = &self.bytes[self.end..];
        let blanks = rest.iter().position(|byte| !byte.is_ascii_whitespace());
        self.start = blanks.map_or(self.bytes.len(), |blanks| self.end + blanks);
        let rest = &self.bytes[self.start..];
        self.end = self.start + rest.iter().position(|byte| byte.is_ascii_whitespace()).unwrap_or(rest.len());
        if self.start == self.end { Err(ValueError::End) } else { Ok(&self.bytes[self.start..self.end]) }
    }
}

impl ValueReader for AsciiValues<'_> {
    const BIG_ENDIAN: Option<bool> = None;

    fn last(&self) -> Range<usize> {
        self.start..self.end
    }

    fn most_left(&self, _: NumberType) -> usize {
        // A value takes at least one digit and one space.
        (self.bytes.len() - self.end).div_ceil(2)
    }

    fn float(&mut self, _: NumberType) -> Result<f32, ValueError> {
        parse_f32(self.word()?).map_err(ValueError::Number)
    }

    fn integer(&mut self, _: NumberType) -> Result<i64, ValueError> {
        parse_integer(self.word()?).ok_or(ValueError::Number(NumberError::NotWhole))
    }

    fn skip(&mut self, _: NumberType, count: usize) -> Result<(), ValueError> {
        (0..count).try_for_each(|_| self.word().map(|_| ()))
    }

    fn remainder(&self) -> Range<usize> {
        let mut rest = self.clone();
        // After the last word, the range is empty.
        _ = rest.word();
        rest.start..self.bytes.len()
    }

    fn fixed_size(_: NumberType) -> Option<usize> {
        None
    }
}

/// Cursor that reads the values of a binary PLY file.
#[derive(Clone)]
pub(super) struct BinaryValues<'a, const BIG_ENDIAN: bool> {
    bytes: &'a [u8],
    start: usize,
    end: usize,
}

impl<'a, const BIG_ENDIAN: bool> BinaryValues<'a, BIG_ENDIAN> {
    pub fn new(bytes: &'a [u8], start: usize) -> Self {
        BinaryValues { bytes, start, end: start }
    }

    fn take<const N: usize>(&mut self) -> Result<[u8; N], ValueError> {
        self.start = self.end;
        let Some(&taken) = self.bytes[self.end..].first_chunk::<N>() else {
            (self.start, self.end) = (self.bytes.len(), self.bytes.len());
            return Err(ValueError::End);
        };
        self.end += N;
        let mut taken = taken;
        if BIG_ENDIAN {
            taken.reverse();
        }
        Ok(taken)
    }

    fn real(&mut self, scalar: NumberType) -> Result<f64, ValueError> {
        match scalar {
            NumberType::F32 => Ok(f32::from_le_bytes(self.take()?) as f64),
            NumberType::F64 => Ok(f64::from_le_bytes(self.take()?)),
            integer => Ok(self.integer(integer)? as f64),
        }
    }
}

impl<const BIG_ENDIAN: bool> ValueReader for BinaryValues<'_, BIG_ENDIAN> {
    const BIG_ENDIAN: Option<bool> = Some(BIG_ENDIAN);

    fn last(&self) -> Range<usize> {
        self.start..self.end
    }

    fn most_left(&self, scalar: NumberType) -> usize {
        (self.bytes.len() - self.end) / scalar.size()
    }

    fn float(&mut self, scalar: NumberType) -> Result<f32, ValueError> {
        let value = self.real(scalar)? as f32;
        if value.is_finite() { Ok(value) } else { Err(ValueError::Number(NumberError::NotFinite)) }
    }

    fn integer(&mut self, scalar: NumberType) -> Result<i64, ValueError> {
        Ok(match scalar {
            NumberType::I8 => i8::from_le_bytes(self.take()?) as i64,
            NumberType::U8 => u8::from_le_bytes(self.take()?) as i64,
            NumberType::I16 => i16::from_le_bytes(self.take()?) as i64,
            NumberType::U16 => u16::from_le_bytes(self.take()?) as i64,
            NumberType::I32 => i32::from_le_bytes(self.take()?) as i64,
            NumberType::U32 => u32::from_le_bytes(self.take()?) as i64,
            NumberType::F32 | NumberType::F64 => {
                self.real(scalar)?;
                return Err(ValueError::Number(NumberError::NotWhole));
            }
        })
    }

    fn skip(&mut self, scalar: NumberType, count: usize) -> Result<(), ValueError> {
        self.start = self.end;
        if count > self.most_left(scalar) {
            (self.start, self.end) = (self.bytes.len(), self.bytes.len());
            return Err(ValueError::End);
        }
        self.end += count * scalar.size();
        Ok(())
    }

    fn remainder(&self) -> Range<usize> {
        self.end..self.bytes.len()
    }

    fn fixed_size(scalar: NumberType) -> Option<usize> {
        Some(scalar.size())
    }
}
