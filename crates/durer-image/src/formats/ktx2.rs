//! Khronos texture containers (KTX 2.0), which may be uncompressed or compressed with zlib. The
//! format can be read but not written, and only the largest mip level is read.
//!
//! Source: *KTX File Format Specification*, version 2.0, Khronos Group.

use super::{Depth, Format, Image, Image8, ImageError, ImageHeader, Raster};
use crate::f32_from_half;
use durer_bvh::math::Vec3;
use std::io::Read;

const NAME: &str = "KTX2";
const MARK: &[u8] = b"\xabKTX 20\xbb\r\n\x1a\n";

pub const FORMAT: Format = Format {
    name: NAME,
    extensions: &["ktx2"],
    depth: Depth::Float,
    supports_layers: false,
    has_alpha: false,
    max_side: u32::MAX,
    has_signature: |bytes| bytes.starts_with(MARK),
    head,
    decode,
    encode: |_, _, _| Err(ImageError::unsupported(NAME, "writing is not supported; choose PNG or OpenEXR")),
    rows: None,
};

/// Number type of the channels in a KTX2 texture.
#[derive(Clone, Copy, PartialEq)]
enum ChannelType {
    /// Unsigned 8-bit integer, from 0 to 255.
    Eight,
    /// Unsigned 16-bit integer, from 0 to 65535.
    Sixteen,
    /// Half-precision floating-point number.
    Half,
    /// Single-precision floating-point number.
    Single,
}

impl ChannelType {
    fn size(self) -> usize {
        match self {
            ChannelType::Eight => 1,
            ChannelType::Sixteen | ChannelType::Half => 2,
            ChannelType::Single => 4,
        }
    }
}

/// Supported Vulkan formats, each with its number, its number of channels, the type of its
/// channels, and a flag that is true if blue comes first.
const KINDS: [(u32, usize, ChannelType, bool); 22] = [
    (9, 1, ChannelType::Eight, false),
    (15, 1, ChannelType::Eight, false),
    (16, 2, ChannelType::Eight, false),
    (22, 2, ChannelType::Eight, false),
    (23, 3, ChannelType::Eight, false),
    (29, 3, ChannelType::Eight, false),
    (30, 3, ChannelType::Eight, true),
    (36, 3, ChannelType::Eight, true),
    (37, 4, ChannelType::Eight, false),
    (43, 4, ChannelType::Eight, false),
    (44, 4, ChannelType::Eight, true),
    (50, 4, ChannelType::Eight, true),
    (70, 1, ChannelType::Sixteen, false),
    (77, 2, ChannelType::Sixteen, false),
    (84, 3, ChannelType::Sixteen, false),
    (91, 4, ChannelType::Sixteen, false),
    (76, 1, ChannelType::Half, false),
    (83, 2, ChannelType::Half, false),
    (90, 3, ChannelType::Half, false),
    (97, 4, ChannelType::Half, false),
    (106, 3, ChannelType::Single, false),
    (109, 4, ChannelType::Single, false),
];

/// A KTX2 texture with its header and the data of its largest mip level.
struct Texture<'a> {
    width: u64,
    height: u64,
    channels: usize,
    number: ChannelType,
    blue_first: bool,
    /// Data of the largest mip level. `packed` is true if the data is compressed with zlib.
    level: &'a [u8],
    packed: bool,
    /// Source of red, green, blue, and opacity, each of which is `r`, `g`, `b`, `a`, `0`, or `1`.
    swizzle: [u8; 4],
    /// True if the bottom row comes first.
    bottom_up: bool,
}

impl Texture<'_> {
    fn pixel_size(&self) -> usize {
        self.channels * self.number.size()
    }
}

fn malformed(reason: &str) -> ImageError {
    ImageError::malformed(NAME, reason)
}

fn word(bytes: &[u8], at: usize) -> Result<u64, ImageError> {
    let four = bytes.get(at..at + 4).ok_or_else(|| malformed("its header is truncated"))?;
    Ok(four.iter().rev().fold(0, |word, &byte| word << 8 | u64::from(byte)))
}

fn long(bytes: &[u8], at: usize) -> Result<u64, ImageError> {
    Ok(word(bytes, at + 4)? << 32 | word(bytes, at)?)
}

/// Returns a part of the file, or an error if the file is too short.
fn part(bytes: &[u8], start: u64, length: u64) -> Result<&[u8], ImageError> {
    let end = start.checked_add(length).filter(|&end| end <= bytes.len() as u64);
    let end = end.ok_or_else(|| malformed("it is truncated"))?;
    Ok(&bytes[start as usize..end as usize])
}

fn open(bytes: &[u8]) -> Result<Texture<'_>, ImageError> {
    if !bytes.starts_with(MARK) {
        return Err(malformed("its signature is missing"));
    }
    let [kind, width, height, depth] = [word(bytes, 12)?, word(bytes, 20)?, word(bytes, 24)?, word(bytes, 28)?];
    let [layers, faces, scheme] = [word(bytes, 32)?, word(bytes, 36)?, word(bytes, 44)?];
    let unsupported = |what: &str| Err(ImageError::unsupported(NAME, what));
    match scheme {
        1 => return unsupported("Basis Universal (BasisLZ) is not supported; convert the file with `ktx extract`"),
        2 => return unsupported("Zstandard compression is not supported; convert the file with `ktx extract`"),
        0 | 3 => {}
        _ => return Err(malformed("its compression scheme is unknown")),
    }
    if kind == 0 {
        return unsupported("Basis Universal (UASTC) is not supported; convert the file with `ktx extract`");
    }
    let Some(&(_, channels, number, blue_first)) = KINDS.iter().find(|row| u64::from(row.0) == kind) else {
        return Err(ImageError::unsupported(
            NAME,
            format!("the Vulkan format {kind} is not supported; convert the file with `ktx extract`"),
        ));
    };
    if height == 0 || depth > 1 || layers > 1 || faces != 1 {
        return unsupported("only a single 2D image is supported");
    }
    let level = part(bytes, long(bytes, 80)?, long(bytes, 88)?)?;
    let values = part(bytes, word(bytes, 56)?, word(bytes, 60)?)?;
    let swizzle = value(values, b"KTXswizzle").and_then(|said| said.first_chunk().copied());
    let default = std::array::from_fn(|i| match i {
        3 if channels < 4 => b'1',
        i if i < channels || i == 3 => b"rgba"[i],
        _ => b'0',
    });
    Ok(Texture {
        width,
        height,
        channels,
        number,
        blue_first,
        level,
        packed: scheme == 3,
        swizzle: swizzle.unwrap_or(default),
        bottom_up: value(values, b"KTXorientation").is_some_and(|said| said.get(1) == Some(&b'u')),
    })
}

/// Finds the value that belongs to a key. An entry consists of a length, the key, a zero byte, and
/// the value; it is padded to a multiple of four bytes.
fn value<'a>(mut entries: &'a [u8], key: &[u8]) -> Option<&'a [u8]> {
    loop {
        let length = word(entries, 0).ok()? as usize;
        let entry = entries.get(4..length.checked_add(4)?)?;
        if let Some(value) = entry.strip_prefix(key).and_then(|rest| rest.strip_prefix(b"\0")) {
            return Some(value);
        }
        entries = entries.get(length.next_multiple_of(4).checked_add(4)?..)?;
    }
}

fn head(bytes: &[u8]) -> Result<ImageHeader, ImageError> {
    let texture = open(bytes)?;
    let is_eight_bit = texture.number == ChannelType::Eight;
    let unpacked = if texture.packed { texture.pixel_size() as u64 } else { 0 };
    // Returns the picture and the opacity of its pixels.
    let bytes_per_pixel = unpacked + if is_eight_bit { 4 } else { 16 };
    Ok(ImageHeader { width: texture.width, height: texture.height, is_eight_bit, bytes_per_pixel, extra_bytes: 0 })
}

fn decode(bytes: &[u8]) -> Result<Raster, ImageError> {
    let texture = open(bytes)?;
    let (width, height) = (texture.width as usize, texture.height as usize);
    let (count, size) = (width * height, texture.pixel_size());
    let unpacked;
    let pixels = match texture.packed {
        false => texture.level,
        true => {
            let mut all = Vec::new();
            // Stop at the size of the picture, to protect against decompression bombs.
            let mut decoder = flate2::read::ZlibDecoder::new(texture.level).take((count * size) as u64);
            decoder.read_to_end(&mut all).map_err(|error| ImageError::malformed(NAME, error))?;
            unpacked = all;
            &unpacked
        }
    };
    if pixels.len() < count * size {
        return Err(malformed("it has fewer pixels than its header states"));
    }
    let at = |row: usize, column: usize| {
        let row = if texture.bottom_up { height - 1 - row } else { row };
        &pixels[(row * width + column) * size..][..size]
    };
    let places = (0..height).flat_map(|row| (0..width).map(move |column| (row, column)));
    let (width, height) = (texture.width as u32, texture.height as u32);
    if texture.number == ChannelType::Eight {
        let mut picture = Image8 { width, height, pixels: Vec::with_capacity(count), alpha: Vec::with_capacity(count) };
        for (row, column) in places {
            let [color @ .., alpha] = texture.swizzled(at(row, column), |channel| channel[0], 0, 255);
            picture.pixels.push(color);
            picture.alpha.push(alpha);
        }
        return Ok(Raster::Eight(picture));
    }
    let number = |channel: &[u8]| match (texture.number, channel) {
        (ChannelType::Sixteen, &[a, b]) => f32::from(u16::from_le_bytes([a, b])) / 65535.0,
        (ChannelType::Half, &[a, b]) => f32_from_half(u16::from_le_bytes([a, b])),
        (_, &[a, b, c, d]) => f32::from_le_bytes([a, b, c, d]),
        _ => 0.0,
    };
    let mut picture = Image { width, height, pixels: Vec::with_capacity(count) };
    let mut alphas = Vec::with_capacity(count);
    for (row, column) in places {
        let [r, g, b, alpha] = texture.swizzled(at(row, column), number, 0.0, 1.0);
        picture.pixels.push(Vec3::new(r, g, b));
        alphas.push(alpha);
    }
    Ok(match texture.number {
        ChannelType::Sixteen => Raster::Sixteen(picture, alphas),
        _ => Raster::Float(picture, alphas),
    })
}

impl Texture<'_> {
    /// Returns the red, green, blue, and opacity of a pixel.
    fn swizzled<N: Copy>(&self, pixel: &[u8], number: impl Fn(&[u8]) -> N, zero: N, one: N) -> [N; 4] {
        let channel = |i: usize| {
            let i = if self.blue_first && i < 3 { 2 - i } else { i };
            pixel.chunks_exact(self.number.size()).nth(i).map(&number)
        };
        self.swizzle.map(|letter| match letter {
            b'r' => channel(0).unwrap_or(zero),
            b'g' => channel(1).unwrap_or(zero),
            b'b' => channel(2).unwrap_or(zero),
            b'a' => channel(3).unwrap_or(one),
            b'1' => one,
            _ => zero,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Encoded, read, read8};
    use std::io::Write;

    /// Creates a file with one mip level and some key-value entries.
    fn file(kind: u32, size: [u32; 2], scheme: u32, entries: &[(&str, &str)], pixels: &[u8]) -> Vec<u8> {
        let mut values = Vec::new();
        for (key, value) in entries {
            let entry = [key.as_bytes(), b"\0", value.as_bytes(), b"\0"].concat();
            values.extend((entry.len() as u32).to_le_bytes());
            values.extend(entry);
            values.resize(values.len().next_multiple_of(4), 0);
        }
        let packed = match scheme {
            3 => {
                let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
                encoder.write_all(pixels).unwrap();
                encoder.finish().unwrap()
            }
            _ => pixels.to_vec(),
        };
        let words = [kind, 1, size[0], size[1], 0, 0, 1, 1, scheme, 0, 0, 104, values.len() as u32];
        let mut bytes = MARK.to_vec();
        bytes.extend(words.iter().flat_map(|word| word.to_le_bytes()));
        bytes.extend([0; 16]);
        let longs = [104 + values.len(), packed.len(), pixels.len()];
        bytes.extend(longs.iter().flat_map(|&long| (long as u64).to_le_bytes()));
        [bytes, values, packed].concat()
    }

    #[test]
    fn every_kind_of_pixel_is_read() {
        let white = 0x3c00u16.to_le_bytes();
        for &(kind, channels, number, blue_first) in &KINDS {
            // The test pixels have different values for red and blue. All channels after the third
            // are ignored.
            let one: Vec<u8> = match number {
                ChannelType::Eight => vec![255],
                ChannelType::Sixteen => vec![255, 255],
                ChannelType::Half => white.to_vec(),
                ChannelType::Single => 1f32.to_le_bytes().to_vec(),
            };
            let zero = vec![0; one.len()];
            let pixel: Vec<u8> = (0..channels).flat_map(|i| if i == 0 { one.clone() } else { zero.clone() }).collect();
            for scheme in [0, 3] {
                let bytes = file(kind, [2, 1], scheme, &[], &[pixel.clone(), pixel.clone()].concat());
                let wanted = if blue_first { Vec3::Z } else { Vec3::X };
                assert_eq!(read(&bytes, "").unwrap().pixels, [wanted; 2], "{kind} {scheme}");
                let encoded = Encoded::open(&bytes, "").unwrap();
                let alpha = if channels == 4 { 0.0 } else { 1.0 };
                match encoded.read_raster(u64::MAX).unwrap() {
                    Raster::Eight(picture) => assert_eq!(picture.alpha, [255 * alpha as u8; 2], "{kind}"),
                    Raster::Sixteen(_, alphas) | Raster::Float(_, alphas) => assert_eq!(alphas, [alpha; 2], "{kind}"),
                }
            }
        }
    }

    #[test]
    fn swizzles_and_orientation_are_heeded() {
        let grey = file(9, [1, 2], 0, &[("KTXorientation", "ru"), ("KTXswizzle", "rrr1")], &[10, 200]);
        assert_eq!(read8(&grey, "").unwrap().pixels, [[200; 3], [10; 3]]);
        assert_eq!(read8(&file(9, [1, 1], 0, &[], &[10]), "").unwrap().pixels, [[10, 0, 0]]);
    }

    #[test]
    fn what_is_not_read_is_named_and_bombs_are_not_unpacked() {
        let message = |bytes: &[u8]| read(bytes, "x.ktx2").unwrap_err().to_string();
        assert!(message(&file(0, [1, 1], 1, &[], &[])).contains("BasisLZ"));
        assert!(message(&file(0, [1, 1], 0, &[], &[])).contains("UASTC"));
        assert!(message(&file(37, [1, 1], 2, &[], &[])).contains("Zstandard"));
        assert!(message(&file(145, [4, 4], 0, &[], &[0; 16])).contains("format 145"));
        assert!(message(&file(37, [2, 2], 0, &[], &[0; 12])).contains("fewer pixels"));
        assert!(message(&file(37, [2, 2], 3, &[], &[0; 12])).contains("fewer pixels"));
        let bomb = file(9, [1, 1], 3, &[], &vec![0; 1 << 22]);
        assert_eq!(read8(&bomb, "").unwrap().pixels.len(), 1);
        assert!(Encoded::open(&file(37, [1 << 20, 1 << 20], 3, &[], &[]), "").is_err());
        let whole = file(109, [2, 2], 3, &[("KTXswizzle", "rgba")], &[7; 64]);
        for end in 0..whole.len() {
            let _ = read(&whole[..end], "x.ktx2");
        }
    }
}
