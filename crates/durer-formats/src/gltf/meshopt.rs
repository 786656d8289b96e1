//! Decodes buffer views that meshoptimizer compressed. The views contain attributes, triangles or
//! indices, and attributes can have a filter.
//!
//! Source: *EXT_meshopt_compression*, Khronos Group, appendices A (bitstream) and B (filters). The
//! names in this file are those of the appendices.

use super::Model;
use super::buffers::SharedBytes;
use super::json::JsonRef;

/// Compression mode of a meshopt buffer view, which says what kind of data the view contains.
#[derive(Clone, Copy, PartialEq)]
enum Mode {
    Attributes,
    Triangles,
    Indices,
}

/// Filter that is applied to attributes after meshopt decompression.
#[derive(Clone, Copy, PartialEq)]
enum Filter {
    None,
    Octahedral,
    Quaternion,
    Exponential,
}

impl Model<'_> {
    /// Decodes a compressed buffer view of `length` bytes.
    pub(super) fn decompress_view(&self, at: &JsonRef, length: usize) -> Option<SharedBytes> {
        at.object()?;
        let buffer = at.required("buffer").and_then(|buffer| buffer.index(self.buffers.len()))?;
        let offset = at.get("byteOffset").map_or(Some(0), |offset| offset.integer(..))? as usize;
        let size = at.required("byteLength").and_then(|length| length.integer(1..))? as usize;
        let stride = at.required("byteStride").and_then(|stride| stride.integer(1..=256))? as usize;
        let count = at.required("count").and_then(|count| count.integer(1..=u64::from(u32::MAX)))? as usize;
        let modes = [("ATTRIBUTES", Mode::Attributes), ("TRIANGLES", Mode::Triangles), ("INDICES", Mode::Indices)];
        let mode = at.required("mode").and_then(|mode| mode.word(&modes))?;
        let filters = [
            ("NONE", Filter::None),
            ("OCTAHEDRAL", Filter::Octahedral),
            ("QUATERNION", Filter::Quaternion),
            ("EXPONENTIAL", Filter::Exponential),
        ];
        let filter = at.get("filter").map_or(Some(Filter::None), |filter| filter.word(&filters))?;
        let strides_fit = match (mode, filter) {
            (Mode::Attributes, Filter::None | Filter::Exponential) => stride.is_multiple_of(4),
            (Mode::Attributes, Filter::Octahedral) => stride == 4 || stride == 8,
            (Mode::Attributes, Filter::Quaternion) => stride == 8,
            (_, filter) => (stride == 2 || stride == 4) && filter == Filter::None,
        };
        if !strides_fit || (mode == Mode::Triangles && !count.is_multiple_of(3)) {
            at.error(
                "VALUE_NOT_IN_RANGE",
                format!("{count} elements of {stride} bytes do not match the mode and the filter"),
            );
            return None;
        }
        if count * stride != length {
            let message = format!("{count} elements of {stride} bytes do not fill a buffer view of {length} bytes");
            at.error("BUFFER_VIEW_TOO_LONG", message);
            return None;
        }
        let buffer = self.buffers[buffer].as_ref()?;
        let end = offset.checked_add(size)?;
        let Some(packed) = buffer.slice.as_ref()?.part(offset..end) else {
            at.error("BUFFER_VIEW_TOO_LONG", format!("{size} bytes from byte {offset} on do not fit into the buffer"));
            return None;
        };
        // One byte encodes at most four groups of 16 equal bytes, or one triangle.
        if size.saturating_mul(64) < length {
            at.error("compressed-data", format!("{size} compressed bytes are too few for {length} decompressed bytes"));
            return None;
        }
        self.charge(length, 1, at)?;
        let decoded = match mode {
            Mode::Attributes => attributes(packed.bytes(), count, stride),
            Mode::Triangles => triangles(packed.bytes(), count).map(|indices| bytes(&indices, stride)),
            Mode::Indices => indices(packed.bytes(), count).map(|indices| bytes(&indices, stride)),
        };
        let Some(mut decoded) = decoded else {
            at.error("compressed-data", "the compressed data are too short, too long, or of another mode");
            return None;
        };
        match filter {
            Filter::None => {}
            Filter::Octahedral if stride == 4 => decoded.as_chunks_mut::<4>().0.iter_mut().for_each(|row| {
                let [x, y, one, _] = row.map(|byte| f32::from(byte as i8));
                octahedral([x, y, one], 127.0).into_iter().zip(row).for_each(|(n, byte)| *byte = n as i8 as u8);
            }),
            Filter::Octahedral => decoded.as_chunks_mut::<8>().0.iter_mut().for_each(|row| {
                let [x, y, one, w] = shorts(row);
                let [x, y, z] = octahedral([x, y, one].map(f32::from), 32767.0);
                put(row, [x as i16, y as i16, z as i16, w]);
            }),
            Filter::Quaternion => decoded.as_chunks_mut::<8>().0.iter_mut().for_each(|row| {
                let turned = quaternion(shorts(row));
                put(row, turned);
            }),
            Filter::Exponential => decoded.as_chunks_mut::<4>().0.iter_mut().for_each(|word| {
                let n = i32::from_le_bytes(*word);
                // The exponent is between -128 and 127, so the power of two is a normal
                // floating-point number.
                let power = f32::from_bits(((n >> 24) + 127).clamp(0, 254) as u32 * (1 << 23));
                *word = (power * ((n << 8) >> 8) as f32).to_le_bytes();
            }),
        }
        Some(SharedBytes::whole(decoded.into()))
    }
}

/// Cursor over the bytes of a meshopt bitstream.
struct Reader<'a>(&'a [u8]);

impl<'a> Reader<'a> {
    fn byte(&mut self) -> Option<u8> {
        let (&byte, rest) = self.0.split_first()?;
        self.0 = rest;
        Some(byte)
    }

    fn some(&mut self, count: usize) -> Option<&'a [u8]> {
        let (some, rest) = self.0.split_at_checked(count)?;
        self.0 = rest;
        Some(some)
    }

    /// Reads a variable-length integer, which has seven bits in each byte and begins with the least
    /// significant ones.
    fn varint(&mut self) -> Option<u32> {
        let mut value = 0;
        for shift in [0, 7, 14, 21, 28] {
            let byte = self.byte()?;
            value |= u32::from(byte & 127) << shift;
            if byte < 128 {
                return Some(value);
            }
        }
        None
    }
}

fn zigzag(v: u32) -> u32 {
    if v & 1 != 0 { !(v >> 1) } else { v >> 1 }
}

/// Decodes mode 0 (attributes), in which blocks of elements are split into planes of bytes. Each
/// byte is stored as its difference from the same byte of the previous element.
fn attributes(packed: &[u8], count: usize, stride: usize) -> Option<Vec<u8>> {
    let tail = stride.max(32);
    let data = packed.strip_prefix(&[0xa0])?;
    let (data, tail) = data.split_at_checked(data.len().checked_sub(tail)?)?;
    let mut last = tail[tail.len() - stride..].to_vec();
    let mut reader = Reader(data);
    let mut all = vec![0; count * stride];
    let most = ((8192 / stride) & !15).min(256);
    for block in all.chunks_mut(most * stride) {
        let elements = block.len() / stride;
        let groups = elements.div_ceil(16);
        for (k, last) in last.iter_mut().enumerate() {
            let heads = reader.some(groups.div_ceil(4))?;
            for group in 0..groups {
                let deltas = deltas(&mut reader, (heads[group / 4] >> (2 * (group % 4))) & 3)?;
                for (i, delta) in (16 * group..elements).zip(deltas) {
                    *last = last.wrapping_add(if delta & 1 != 0 { !(delta >> 1) } else { delta >> 1 });
                    block[i * stride + k] = *last;
                }
            }
        }
    }
    reader.0.is_empty().then_some(all)
}

/// Decodes sixteen differences. The differences are all zero, have eight bits each, or have two or
/// four bits each with the larger values appended.
fn deltas(reader: &mut Reader, mode: u8) -> Option<[u8; 16]> {
    let bits = match mode {
        0 => return Some([0; 16]),
        3 => return reader.some(16)?.try_into().ok(),
        mode => 2 * usize::from(mode),
    };
    let packed = reader.some(2 * bits)?;
    let most = (1u8 << bits) - 1;
    let mut all = [0; 16];
    for (i, delta) in all.iter_mut().enumerate() {
        let at = i * bits;
        *delta = (packed[at / 8] >> (8 - bits - at % 8)) & most;
        if *delta == most {
            *delta = reader.byte()?;
        }
    }
    Some(all)
}

/// Ring buffer of the last sixteen edges or vertices, to which meshopt codes refer.
#[derive(Default)]
struct RecentValues<T> {
    all: [T; 16],
    next: usize,
}

impl<T: Copy> RecentValues<T> {
    fn push(&mut self, value: T) {
        self.all[self.next % 16] = value;
        self.next += 1;
    }

    /// Returns the value that was pushed `back` steps before the last one.
    fn get(&self, back: usize) -> T {
        self.all[(self.next + 15 - back) % 16]
    }
}

/// Decodes mode 1 (triangles). A triangle that shares an edge with a recent triangle takes one
/// byte, and all others take more.
fn triangles(packed: &[u8], count: usize) -> Option<Vec<u32>> {
    let data = packed.strip_prefix(&[0xe1])?;
    let (data, table) = data.split_at_checked(data.len().checked_sub(16)?)?;
    let (codes, data) = data.split_at_checked(count / 3)?;
    let mut reader = Reader(data);
    let (mut next, mut last) = (0u32, 0u32);
    let (mut edges, mut vertices) = (RecentValues::<[u32; 2]>::default(), RecentValues::<u32>::default());
    let mut all = Vec::with_capacity(count);
    for &code in codes {
        let (x, y) = (usize::from(code >> 4), usize::from(code & 15));
        let mut explicit = |reader: &mut Reader| {
            last = last.wrapping_add(zigzag(reader.varint()?));
            Some(last)
        };
        let mut fresh = || {
            next = next.wrapping_add(1);
            next.wrapping_sub(1)
        };
        if x < 15 {
            let [a, b] = edges.get(x);
            let (c, is_new) = match y {
                0 => (fresh(), true),
                1..=12 => (vertices.get(y), false),
                15 => (explicit(&mut reader)?, true),
                _ => {
                    last = if y == 13 { last.wrapping_sub(1) } else { last.wrapping_add(1) };
                    (last, true)
                }
            };
            edges.push([c, b]);
            edges.push([a, c]);
            if is_new {
                vertices.push(c);
            }
            all.extend([a, b, c]);
            continue;
        }
        let pair = if y < 14 { table[y] } else { reader.byte()? };
        if y >= 14 && pair == 0 {
            next = 0;
        }
        let mut fresh = || {
            next = next.wrapping_add(1);
            next.wrapping_sub(1)
        };
        let a = if y == 15 { explicit(&mut reader)? } else { fresh() };
        let mut corner = |code: u8| match code {
            0 => Some((fresh(), true)),
            15 if y >= 14 => Some((explicit(&mut reader)?, true)),
            15 => None,
            back => Some((vertices.get(usize::from(back) - 1), false)),
        };
        let ((b, is_new_b), (c, is_new_c)) = (corner(pair >> 4)?, corner(pair & 15)?);
        for edge in [[b, a], [c, b], [a, c]] {
            edges.push(edge);
        }
        for (vertex, is_new) in [(a, true), (b, is_new_b), (c, is_new_c)] {
            if is_new {
                vertices.push(vertex);
            }
        }
        all.extend([a, b, c]);
    }
    reader.0.is_empty().then_some(all)
}

/// Decodes mode 2 (indices), in which each index is stored as its difference from the last value of
/// one of two sequences.
fn indices(packed: &[u8], count: usize) -> Option<Vec<u32>> {
    let data = packed.strip_prefix(&[0xd1])?;
    let mut reader = Reader(data.get(..data.len().checked_sub(4)?)?);
    let mut last = [0u32; 2];
    // Each index takes at least one byte.
    let mut all = Vec::with_capacity(count.min(data.len()));
    for _ in 0..count {
        let v = reader.varint()?;
        let last = &mut last[(v & 1) as usize];
        *last = last.wrapping_add(zigzag(v >> 1));
        all.push(*last);
    }
    reader.0.is_empty().then_some(all)
}

fn bytes(indices: &[u32], stride: usize) -> Vec<u8> {
    indices.iter().flat_map(|i| i.to_le_bytes().into_iter().take(stride)).collect()
}

fn shorts(row: &[u8; 8]) -> [i16; 4] {
    std::array::from_fn(|i| i16::from_le_bytes([row[2 * i], row[2 * i + 1]]))
}

fn put(row: &mut [u8; 8], values: [i16; 4]) {
    row.as_chunks_mut::<2>().0.iter_mut().zip(values).for_each(|(bytes, value)| *bytes = value.to_le_bytes());
}

/// Decodes filter 1, which stores a direction in octahedral encoding. The integer `most` represents
/// 1.
fn octahedral([x, y, one]: [f32; 3], most: f32) -> [f32; 3] {
    // A length of 0 is not valid.
    let one = if one == 0.0 { 1.0 } else { one };
    let (x, y) = (x / one, y / one);
    let z = 1.0 - x.abs() - y.abs();
    let fold = z.min(0.0);
    let (x, y) = (x - fold.copysign(x), y - fold.copysign(y));
    let length = (x * x + y * y + z * z).sqrt();
    [x, y, z].map(|v| (v / length * most).round())
}

/// Decodes filter 2, which stores the three smaller components of a unit quaternion.
fn quaternion([x, y, z, word]: [i16; 4]) -> [i16; 4] {
    let scale = std::f32::consts::FRAC_1_SQRT_2 / f32::from(word | 3);
    let [x, y, z] = [x, y, z].map(|v| f32::from(v) * scale);
    let w = (1.0 - x * x - y * y - z * z).max(0.0).sqrt();
    let largest = (word & 3) as usize;
    let mut turned = [0; 4];
    for (i, v) in [w, x, y, z].into_iter().enumerate() {
        turned[(largest + i) % 4] = (v * 32767.0).round() as i16;
    }
    turned
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sixteen differences from the example in the specification, before zigzag decoding.
    #[test]
    fn deltas_match_the_specification() {
        let packed = [0x17, 0x5f, 0xf0, 0xbc, 0x77, 0xa9, 0x21, 0x00, 0x34, 0xb5];
        let expected = [-1, -4, -3, 26, -91, 0, -6, 6, -4, -4, 5, -5, 1, -1, 0, 0];
        let decoded = deltas(&mut Reader(&packed), 2).unwrap();
        let signed = decoded.map(|d| if d & 1 != 0 { !(d >> 1) as i8 } else { (d >> 1) as i8 });
        assert_eq!(signed, expected);
    }

    #[test]
    fn varints_have_seven_bits_per_byte() {
        for (packed, value) in [(&[0x7f][..], 0x7f), (&[0x81, 0x04], 0x201), (&[0xff, 0xa0, 0x05], 0x1507f)] {
            assert_eq!(Reader(packed).varint(), Some(value));
        }
        assert_eq!(Reader(&[0xff; 5]).varint(), None);
    }

    #[test]
    fn elements_follow_the_baseline() {
        // The data has two elements of four bytes. The first element is the baseline plus (1, 0, 0,
        // 0), and the second element is the first one plus (-1, 0, 0, 5).
        let mut packed = vec![0xa0];
        packed.extend([1, 0b1001_0000, 0, 0, 0]); // byte 0: two bits, 2 = +1 and 1 = -1
        packed.extend([0, 0]);
        packed.extend([3]);
        packed.extend([0, 10].into_iter().chain([0; 14]));
        packed.extend([0; 28].into_iter().chain([7, 8, 9, 10]));
        assert_eq!(attributes(&packed, 2, 4), Some(vec![8, 8, 9, 10, 7, 8, 9, 15]));
        for end in 0..packed.len() {
            assert_eq!(attributes(&packed[..end], 2, 4), None);
        }
    }

    #[test]
    fn triangles_share_edges() {
        // The first triangle has three new vertices and is encoded by the first pair of the table.
        // The second triangle shares the last edge.
        let mut packed = vec![0xe1, 0xf0, 0x00];
        packed.extend([0; 16]);
        assert_eq!(triangles(&packed, 6), Some(vec![0, 1, 2, 0, 2, 3]));
        assert_eq!(indices(&[0xd1, 0x04, 0x04, 0x05, 0x06, 0, 0, 0, 0], 4), Some(vec![1, 2, 1, 0]));
    }

    #[test]
    fn filters_give_unit_vectors() {
        assert_eq!(octahedral([127.0, 0.0, 127.0], 127.0), [127.0, 0.0, 0.0]);
        assert_eq!(octahedral([-42.0, -42.0, 126.0], 127.0), [-73.0, -73.0, 73.0]);
        assert_eq!(octahedral([-127.0, -127.0, 127.0], 127.0), [0.0, 0.0, -127.0]);
        assert_eq!(quaternion([0, 0, 0, 32767 & !3 | 2]), [0, 0, 32767, 0]);
        for i in 0..200i16 {
            let q = quaternion([i * 83 - 9000, 7000 - i * 31, i * 5, 32764 | (i & 3)]);
            let length = q.map(|x| f64::from(x) / 32767.0).iter().map(|x| x * x).sum::<f64>();
            assert!((length - 1.0).abs() < 2e-4, "{q:?}");
        }
    }
}
