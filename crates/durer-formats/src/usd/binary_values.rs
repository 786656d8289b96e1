//! Values in USD binary files.
//!
//! A value is described by 64 bits: whether it is an array (bit 63), stored in the description
//! itself (bit 62), or compressed (bit 61); its type (bits 48 to 55); and the value or its offset
//! (bits 0 to 47).

use super::codec::{BROKEN, MIN_COMPRESSED, integers, long_integers};
use super::layer::{ListEdit, Reference, Value};
use super::time::SampleTime;
use crate::growth::ResourceLimits;
use durer_image::f32_from_half;
use std::collections::BTreeMap;

/// Maximum nesting depth of dictionaries.
const MAX_DEPTH: u32 = 32;

/// Tables of a binary file.
pub(super) struct Tables<'a> {
    pub bytes: &'a [u8],
    pub version: u8,
    pub tokens: Vec<String>,
    /// Token of each string.
    pub strings: Vec<u32>,
    pub paths: Vec<String>,
    /// Limit on the memory of decoded values.
    pub limits: &'a ResourceLimits,
}

/// Position in a file from which numbers are read.
#[derive(Clone, Copy)]
pub(super) struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
}

/// Decoded value, or an edit of a list.
pub(super) enum Decoded {
    Value(Value),
    Texts(ListEdit<String>),
    References(ListEdit<Reference>),
    /// Value of a type that no reader of fields uses.
    Other,
}

/// Type of the numbers in a value, with its size in bytes.
#[derive(Clone, Copy, PartialEq)]
enum Scalar {
    U8,
    I32,
    U32,
    I64,
    U64,
    F16,
    F32,
    F64,
}

impl<'a> Cursor<'a> {
    /// Creates a cursor at an offset from the start of the file.
    pub fn new(bytes: &'a [u8], at: usize) -> Self {
        Cursor { bytes, at }
    }

    /// Takes the next `length` bytes.
    pub fn take(&mut self, length: usize) -> Result<&'a [u8], String> {
        let end = self.at.checked_add(length).filter(|end| *end <= self.bytes.len());
        let end = end.ok_or("the file ends too early")?;
        let taken = &self.bytes[self.at..end];
        self.at = end;
        Ok(taken)
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], String> {
        let mut array = [0; N];
        array.copy_from_slice(self.take(N)?);
        Ok(array)
    }

    pub fn u32(&mut self) -> Result<u32, String> {
        self.array().map(u32::from_le_bytes)
    }

    pub fn u64(&mut self) -> Result<u64, String> {
        self.array().map(u64::from_le_bytes)
    }

    fn f64(&mut self) -> Result<f64, String> {
        self.array().map(f64::from_le_bytes)
    }

    /// Reads a number of elements of which each takes at least `size` bytes of the file. If the
    /// elements are compressed, `size` is 0.
    pub fn count(&mut self, size: usize) -> Result<usize, String> {
        let count = usize::try_from(self.u64()?).unwrap_or(usize::MAX);
        let left = self.bytes.len().saturating_sub(self.at);
        // Compressed elements take at least two bits before LZ4, which shrinks data to 1/255.
        let most = left.checked_div(size).unwrap_or(left.saturating_mul(4 * 255));
        if count <= most { Ok(count) } else { Err("it announces more elements than the file can hold".into()) }
    }

    /// Takes the bytes that follow their length.
    pub fn sized(&mut self) -> Result<&'a [u8], String> {
        let length = usize::try_from(self.u64()?).unwrap_or(usize::MAX);
        self.take(length)
    }

    /// Reads compressed integers, which follow their length in bytes.
    pub fn compressed_integers(&mut self, count: usize) -> Result<Vec<i32>, String> {
        let data = self.sized()?;
        integers(data, count)
    }

    /// Moves to the offset, relative to here, that is stored here.
    fn follow(&mut self) -> Result<(), String> {
        let start = self.at;
        let offset = self.u64()? as i64;
        let target = i64::try_from(start).ok().and_then(|start| start.checked_add(offset));
        self.at = target.and_then(|target| usize::try_from(target).ok()).ok_or("an offset is invalid")?;
        Ok(())
    }
}

impl Scalar {
    fn size(self) -> usize {
        match self {
            Scalar::U8 => 1,
            Scalar::F16 => 2,
            Scalar::I32 | Scalar::U32 | Scalar::F32 => 4,
            Scalar::I64 | Scalar::U64 | Scalar::F64 => 8,
        }
    }

    fn read(self, at: &mut Cursor) -> Result<f64, String> {
        Ok(match self {
            Scalar::U8 => f64::from(at.array::<1>()?[0]),
            Scalar::I32 => f64::from(at.u32()? as i32),
            Scalar::U32 => f64::from(at.u32()?),
            Scalar::I64 => at.u64()? as i64 as f64,
            Scalar::U64 => at.u64()? as f64,
            Scalar::F16 => f64::from(f32_from_half(u16::from_le_bytes(at.array()?))),
            Scalar::F32 => f64::from(f32::from_bits(at.u32()?)),
            Scalar::F64 => at.f64()?,
        })
    }
}

/// Returns the scalar and the number of components of a numeric type.
fn numeric(kind: u8) -> Option<(Scalar, usize)> {
    Some(match kind {
        1 | 2 => (Scalar::U8, 1),
        3 => (Scalar::I32, 1),
        4 => (Scalar::U32, 1),
        5 => (Scalar::I64, 1),
        6 => (Scalar::U64, 1),
        7 => (Scalar::F16, 1),
        8 => (Scalar::F32, 1),
        9 | 56 => (Scalar::F64, 1),
        13 => (Scalar::F64, 4),
        14 => (Scalar::F64, 9),
        15 => (Scalar::F64, 16),
        16 | 27 => (Scalar::F64, 4),
        17 | 28 => (Scalar::F32, 4),
        18 | 29 => (Scalar::F16, 4),
        19 => (Scalar::F64, 2),
        20 => (Scalar::F32, 2),
        21 => (Scalar::F16, 2),
        22 => (Scalar::I32, 2),
        23 => (Scalar::F64, 3),
        24 => (Scalar::F32, 3),
        25 => (Scalar::F16, 3),
        26 => (Scalar::I32, 3),
        30 => (Scalar::I32, 4),
        _ => return None,
    })
}

/// True for quaternions, whose real part is stored last.
fn is_quaternion(kind: u8) -> bool {
    (16..=18).contains(&kind)
}

/// Moves the real part of each quaternion to the front.
fn real_first(values: &mut [f64]) {
    values.as_chunks_mut::<4>().0.iter_mut().for_each(|quaternion| quaternion.rotate_right(1));
}

impl<'a> Tables<'a> {
    /// Decodes the value that 64 bits describe.
    pub fn decode(&self, description: u64) -> Result<Decoded, String> {
        self.decode_nested(description, 0)
    }

    fn decode_nested(&self, description: u64, depth: u32) -> Result<Decoded, String> {
        if depth > MAX_DEPTH {
            return Err("dictionaries are nested too deep".into());
        }
        let [is_array, is_inline, is_compressed] = [63, 62, 61].map(|bit| description >> bit & 1 == 1);
        let (kind, payload) = ((description >> 48) as u8, description & 0xffff_ffff_ffff);
        let at = Cursor::new(self.bytes, payload as usize);
        if let Some((scalar, width)) = numeric(kind) {
            let value = match (is_array, is_inline) {
                (true, _) => self.number_array(at, payload, (kind, scalar, width), is_compressed)?,
                (false, true) => inline(payload as u32, kind, scalar, width),
                (false, false) => numbers(at, kind, scalar, width)?,
            };
            return Ok(Decoded::Value(value));
        }
        let text = |index: u32| match kind {
            10 => self.string(index),
            _ => self.token(index as i32),
        };
        let value = match kind {
            10..=12 if is_array => {
                let (count, mut at) = self.array_start(at, payload, 4)?;
                let texts = (0..count).map(|_| Ok(text(at.u32()?)?.to_string())).collect::<Result<_, String>>()?;
                Value::Texts(texts)
            }
            12 => Value::Asset(self.token(payload as i32)?.to_string()),
            10 | 11 => Value::Text(text(payload as u32)?.to_string()),
            31 => self.dictionary(at, payload, depth)?,
            32 => return Ok(Decoded::Texts(list_edit(at, |at| Ok(self.token(at.u32()? as i32)?.to_string()))?)),
            33 => return Ok(Decoded::Texts(list_edit(at, |at| Ok(self.string(at.u32()?)?.to_string()))?)),
            34 => return Ok(Decoded::Texts(list_edit(at, |at| Ok(self.path(at.u32()?)?.to_string()))?)),
            35 => return Ok(Decoded::References(list_edit(at, |at| self.reference(at, depth))?)),
            55 => return Ok(Decoded::References(list_edit(at, |at| self.payload(at))?)),
            47 => {
                let mut at = at;
                return Ok(Decoded::References(ListEdit::replacing(vec![self.payload(&mut at)?])));
            }
            41 => Value::Texts(texts(at, |at| Ok(self.token(at.u32()? as i32)?.to_string()))?),
            50 => Value::Texts(texts(at, |at| Ok(self.string(at.u32()?)?.to_string()))?),
            42..=44 => Value::Number(payload as u32 as f64),
            45 => {
                let mut at = at;
                let count = at.count(8)?;
                let pair = |at: &mut Cursor| {
                    let set = self.string(at.u32()?)?.to_string();
                    Ok((set, Value::Text(self.string(at.u32()?)?.to_string())))
                };
                Value::Dictionary((0..count).map(|_| pair(&mut at)).collect::<Result<_, String>>()?)
            }
            48 => {
                let mut at = at;
                let count = at.count(8)?;
                Value::Numbers { width: 1, values: (0..count).map(|_| at.f64()).collect::<Result<_, _>>()? }
            }
            51 => Value::Blocked,
            _ => return Ok(Decoded::Other),
        };
        self.charge(value.bytes())?;
        Ok(Decoded::Value(value))
    }

    /// Decodes the samples of an attribute that are needed for a time.
    pub fn samples(&self, description: u64, time: SampleTime) -> Result<Vec<(f64, Value)>, String> {
        const TIME_SAMPLES: u8 = 46;
        if (description >> 48) as u8 != TIME_SAMPLES {
            return Ok(Vec::new());
        }
        let mut at = Cursor::new(self.bytes, (description & 0xffff_ffff_ffff) as usize);
        at.follow()?;
        let Decoded::Value(times) = self.decode(at.u64()?)? else { return Ok(Vec::new()) };
        at.follow()?;
        let count = at.count(8)?;
        let times = times.numbers();
        if times.is_empty() || times.len() != count {
            return Ok(Vec::new());
        }
        let (before, after, _) = time.between(times);
        let mut samples = Vec::new();
        for (index, time) in times.iter().enumerate().take(after + 1).skip(before) {
            let mut at = Cursor::new(self.bytes, at.at + 8 * index);
            if let Decoded::Value(value) = self.decode(at.u64()?)? {
                samples.push((*time, value));
            }
        }
        Ok(samples)
    }

    /// Counts decoded bytes towards the memory limit.
    fn charge(&self, bytes: usize) -> Result<(), String> {
        self.limits.bytes(bytes, 1).map_err(|limit| limit.message)
    }

    /// Reads the length of an array, and moves to its elements of at least `size` bytes.
    fn array_start(&self, mut at: Cursor<'a>, payload: u64, size: usize) -> Result<(usize, Cursor<'a>), String> {
        if payload == 0 {
            return Ok((0, at));
        }
        if self.version < 5 {
            // Older files store the number of dimensions, which is always 1.
            at.u32()?;
        }
        let count = match self.version < 7 {
            true => at.u32()? as usize,
            false => at.count(size)?,
        };
        Ok((count, at))
    }

    fn number_array(
        &self,
        at: Cursor<'a>,
        payload: u64,
        (kind, scalar, width): (u8, Scalar, usize),
        is_compressed: bool,
    ) -> Result<Value, String> {
        let size = if is_compressed { 0 } else { width * scalar.size() };
        let (count, mut at) = self.array_start(at, payload, size)?;
        let total = count.checked_mul(width).ok_or(BROKEN)?;
        self.charge(total.saturating_mul(8))?;
        if is_compressed && count >= MIN_COMPRESSED {
            let values = self.compressed(&mut at, count, scalar)?;
            return Ok(Value::Numbers { width: 1, values });
        }
        let mut data = Cursor::new(at.take(total * scalar.size())?, 0);
        let mut values = (0..total).map(|_| scalar.read(&mut data)).collect::<Result<Vec<_>, _>>()?;
        if is_quaternion(kind) {
            real_first(&mut values);
        }
        Ok(Value::Numbers { width, values })
    }

    /// Reads a compressed array of integers or floating-point numbers.
    fn compressed(&self, at: &mut Cursor<'a>, count: usize, scalar: Scalar) -> Result<Vec<f64>, String> {
        let whole = |all: Vec<i32>| all.into_iter().map(f64::from).collect();
        match scalar {
            Scalar::I32 => Ok(whole(integers(at.sized()?, count)?)),
            Scalar::U32 => Ok(integers(at.sized()?, count)?.into_iter().map(|x| f64::from(x as u32)).collect()),
            Scalar::I64 | Scalar::U64 => Ok(long_integers(at.sized()?, count)?.into_iter().map(|x| x as f64).collect()),
            Scalar::F16 | Scalar::F32 | Scalar::F64 => match at.array::<1>()?[0] {
                b'i' => Ok(whole(integers(at.sized()?, count)?)),
                b't' => {
                    let size = at.u32()? as usize;
                    let mut table = Cursor::new(at.take(size.checked_mul(scalar.size()).ok_or(BROKEN)?)?, 0);
                    let table = (0..size).map(|_| scalar.read(&mut table)).collect::<Result<Vec<_>, _>>()?;
                    let indices = integers(at.sized()?, count)?;
                    indices.into_iter().map(|i| table.get(i as usize).copied().ok_or_else(|| BROKEN.into())).collect()
                }
                _ => Err(BROKEN.into()),
            },
            Scalar::U8 => Err(BROKEN.into()),
        }
    }

    /// Reads a dictionary. Each value follows its key at a relative offset.
    fn dictionary(&self, mut at: Cursor<'a>, payload: u64, depth: u32) -> Result<Value, String> {
        let mut entries = BTreeMap::new();
        let count = if payload == 0 { 0 } else { at.count(12)? };
        for _ in 0..count {
            let key = self.string(at.u32()?)?.to_string();
            at.follow()?;
            if let Decoded::Value(value) = self.decode_nested(at.u64()?, depth + 1)? {
                self.charge(key.len())?;
                entries.insert(key, value);
            }
        }
        Ok(Value::Dictionary(entries))
    }

    fn reference(&self, at: &mut Cursor<'a>, depth: u32) -> Result<Reference, String> {
        let mut reference = self.target(at)?;
        reference.is_retimed = retimed(at)?;
        let count = at.count(12)?;
        for _ in 0..count {
            at.u32()?;
            at.follow()?;
            self.decode_nested(at.u64()?, depth + 1)?;
        }
        Ok(reference)
    }

    fn payload(&self, at: &mut Cursor<'a>) -> Result<Reference, String> {
        let mut reference = self.target(at)?;
        reference.is_retimed = self.version >= 8 && retimed(at)?;
        Ok(reference)
    }

    fn target(&self, at: &mut Cursor<'a>) -> Result<Reference, String> {
        let asset = self.string(at.u32()?)?.to_string();
        let path = at.u32()?;
        let prim = self.path(path).unwrap_or_default().to_string();
        Ok(Reference { asset, prim: if prim == "/" { String::new() } else { prim }, is_retimed: false })
    }
}

/// Reads a time offset and scale, and returns true if they change times.
fn retimed(at: &mut Cursor) -> Result<bool, String> {
    Ok([at.f64()?, at.f64()?] != [0.0, 1.0])
}

impl Tables<'_> {
    /// Returns a token by its index.
    pub fn token(&self, index: i32) -> Result<&str, String> {
        let token = usize::try_from(index).ok().and_then(|index| self.tokens.get(index));
        token.map(String::as_str).ok_or_else(|| "a token is invalid".into())
    }

    /// Returns a string by its index.
    pub fn string(&self, index: u32) -> Result<&str, String> {
        let token = self.strings.get(index as usize).ok_or("a string is invalid")?;
        self.token(*token as i32)
    }

    /// Returns a path by its index.
    pub fn path(&self, index: u32) -> Result<&str, String> {
        self.paths.get(index as usize).map(String::as_str).ok_or_else(|| "a path is invalid".into())
    }
}

/// Decodes a number, vector or matrix that is stored in its description: vectors and the diagonals
/// of matrices as bytes, and wide numbers as 32 bits.
fn inline(payload: u32, kind: u8, scalar: Scalar, width: usize) -> Value {
    let byte = |i: usize| f64::from((payload >> (8 * i)) as u8 as i8);
    let matrix = |size: usize| {
        let entry = |i: usize| if i / size == i % size { byte(i / size) } else { 0.0 };
        Value::Tuple((0..size * size).map(entry).collect())
    };
    match (kind, width) {
        (1, _) => Value::Bool(payload & 0xff != 0),
        (13..=15, _) => matrix([2, 3, 4][usize::from(kind - 13)]),
        (_, 1) => Value::Number(match scalar {
            Scalar::U8 => f64::from(payload as u8),
            Scalar::I32 | Scalar::I64 => f64::from(payload as i32),
            Scalar::U32 | Scalar::U64 => f64::from(payload),
            Scalar::F16 => f64::from(f32_from_half(payload as u16)),
            Scalar::F32 | Scalar::F64 => f64::from(f32::from_bits(payload)),
        }),
        _ => Value::Tuple((0..width).map(byte).collect()),
    }
}

/// Reads a number, vector, quaternion or matrix.
fn numbers(mut at: Cursor, kind: u8, scalar: Scalar, width: usize) -> Result<Value, String> {
    let mut values = (0..width).map(|_| scalar.read(&mut at)).collect::<Result<Vec<_>, _>>()?;
    if is_quaternion(kind) {
        real_first(&mut values);
    }
    Ok(match values[..] {
        [number] => Value::Number(number),
        _ => Value::Tuple(values),
    })
}

fn texts<'a>(
    mut at: Cursor<'a>,
    mut text: impl FnMut(&mut Cursor<'a>) -> Result<String, String>,
) -> Result<Vec<String>, String> {
    let count = at.count(4)?;
    (0..count).map(|_| text(&mut at)).collect()
}

/// Reads the edit of a list, whose first byte says which lists follow.
fn list_edit<'a, T: Clone + PartialEq>(
    mut at: Cursor<'a>,
    mut item: impl FnMut(&mut Cursor<'a>) -> Result<T, String>,
) -> Result<ListEdit<T>, String> {
    let header = at.array::<1>()?[0];
    let mut list = |bit: u8| {
        if header >> bit & 1 == 0 {
            return Ok::<_, String>(Vec::new());
        }
        let count = at.count(4)?;
        (0..count).map(|_| item(&mut at)).collect()
    };
    let (explicit, added, prepended) = (list(1)?, list(2)?, list(5)?);
    let (mut appended, deleted) = (list(6)?, list(3)?);
    list(4)?;
    appended.extend(added);
    Ok(ListEdit { explicit: (header & 1 == 1).then_some(explicit), prepended, appended, deleted })
}
