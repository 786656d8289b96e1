//! Reads `.serialized` files, each of which can contain several meshes.
//!
//! All values are little-endian. Each mesh begins with the number 0x041C and the version (3 or 4),
//! each of which has 16 bits. A zlib stream follows. The stream contains flags, a zero-terminated
//! name (only in version 4), the numbers of vertices and triangles, and then the lists of
//! positions, normals, texture coordinates, colours and vertex indices. The file ends with the
//! offsets of all meshes, followed by the number of meshes. Source: *Mitsuba 3 documentation*,
//! `serialized`.

use crate::files::read_named;
use crate::model::ReadInput;
use crate::report::range_text;
use crate::shared_report::SharedReport;
use durer_diag::{Diagnostic, Span};
use durer_scene::math::{Vec2, Vec3};
use durer_scene::shape::MeshData;
use flate2::bufread::ZlibDecoder;
use std::io::{ErrorKind, Read};

const MARK: u16 = 0x041c;
/// Size in bytes of the header of a mesh, which consists of the number 0x041C and the version.
const HEAD: usize = 4;

/// Flags of a mesh, which say which lists are present and whether numbers have 64 bits.
const NORMALS: u32 = 0x0001;
const UVS: u32 = 0x0002;
const COLORS: u32 = 0x0008;
const DOUBLE: u32 = 0x2000;

const MAX_NAME_LENGTH: usize = 1 << 12;
/// Maximum ratio of the number of decompressed bytes to the file size, and the number of
/// decompressed bytes that is allowed even for the smallest file. Compression rarely makes a mesh
/// smaller than a tenth of its size.
const MAX_RATIO: u64 = 200;
const FREE_BYTES: u64 = 1 << 24;

/// Byte offset at which an error occurred, and the error message.
type ParseError = (usize, String);

/// Reads the mesh that has the given index in a file.
pub(super) fn mesh(
    input: &ReadInput,
    report: &SharedReport,
    (path, at): (&str, Span),
    number: u32,
) -> Option<MeshData> {
    let (bytes, file) = read_named(input, report, "the mesh", path, at)?;
    let report_error = |(place, message): ParseError| {
        let place = place.min(bytes.len()) as u32;
        let error = Diagnostic::error(message).code("bad-file").at(Span { file, start: place, end: place });
        report.push(error.related(at, "used here"));
    };
    let data = parse(&bytes, number, input.memory).map_err(report_error).ok()?;
    if data.triangles.is_empty() {
        report.push(Diagnostic::warning("the mesh has no triangles").at(at));
    }
    Some(data)
}

fn parse(bytes: &[u8], number: u32, memory: u64) -> Result<MeshData, ParseError> {
    let (start, version) = find_mesh(bytes, number)?;
    let packed = &bytes[start + HEAD..];
    let budget = memory.min(FREE_BYTES + MAX_RATIO * packed.len() as u64);
    let mut unpacked = ZlibReader { inner: ZlibDecoder::new(packed), start: start + HEAD };
    let [flags] = unpacked.words::<1>("flags")?;
    if version == 4 {
        unpacked.pass_name()?;
    }
    let [low, high, triangles_low, triangles_high] = unpacked.words::<4>("numbers of vertices and triangles")?;
    let wide = |low: u32, high: u32| u64::from(high) << 32 | u64::from(low);
    let (vertices, triangles) = (wide(low, high), wide(triangles_low, triangles_high));
    let has = |flag: u32| flags & flag != 0;
    let size = if has(DOUBLE) { 8 } else { 4 };
    let lists = [(true, 3), (has(NORMALS), 3), (has(UVS), 2), (has(COLORS), 3)];
    let row = lists.iter().filter(|(there, _)| *there).map(|(_, width)| size * width).sum::<u64>();
    // Indices have 64 bits only if the mesh has more vertices than this.
    if vertices > u64::from(u32::MAX) {
        return Err((unpacked.position(), format!("32-bit indices do not allow {vertices} vertices")));
    }
    let wanted = triangles.saturating_mul(12).saturating_add(vertices * row);
    if wanted > budget {
        let message = format!("a file of this size cannot contain {vertices} vertices and {triangles} triangles");
        return Err((unpacked.position(), message));
    }
    let mut list = |what: &str, there: bool, width: u64| match there {
        true => unpacked.numbers(what, vertices * width, has(DOUBLE)),
        false => Ok(Vec::new()),
    };
    let positions = list("positions", true, 3)?;
    let normals = list("normals", has(NORMALS), 3)?;
    let uvs = list("texture coordinates", has(UVS), 2)?;
    // Mitsuba 3 ignores these vertex colours.
    list("colours", has(COLORS), 3)?;
    let corners = unpacked.bytes("vertex indices", triangles * 12)?;
    let corners: Vec<u32> = corners.as_chunks().0.iter().map(|four| u32::from_le_bytes(*four)).collect();
    if let Some(i) = corners.iter().position(|corner| u64::from(*corner) >= vertices) {
        let has = range_text(vertices as usize, "vertex", "vertices");
        let message = format!("triangle {} uses vertex {}, but the mesh has {has}", i / 3, corners[i]);
        return Err((unpacked.position(), message));
    }
    let triangles = corners.as_chunks().0.to_vec();
    let of = |there: bool| if there { triangles.clone() } else { Vec::new() };
    let triples = |all: Vec<f32>| all.as_chunks().0.iter().map(|xyz| Vec3::from_array(*xyz)).collect();
    Ok(MeshData {
        positions: triples(positions),
        normals: triples(normals),
        uvs: uvs.as_chunks().0.iter().map(|uv| Vec2::from_array(*uv)).collect(),
        triangle_uvs: of(has(UVS)),
        triangle_normals: of(has(NORMALS)),
        triangles,
        ..MeshData::default()
    })
}

/// Finds a mesh by its index. Returns the offset of the mesh and the version of the file.
fn find_mesh(bytes: &[u8], number: u32) -> Result<(usize, u16), ParseError> {
    let begins = |at: usize| {
        let found =
            at.checked_add(HEAD).and_then(|end| bytes.get(at..end)).filter(|head| head[..2] == MARK.to_le_bytes());
        let found = found.map(|head| u16::from_le_bytes([head[2], head[3]]));
        found.ok_or((at, "expected a Mitsuba mesh, which begins with the bytes 1C 04".to_string()))
    };
    let version = begins(0)?;
    if !matches!(version, 3 | 4) {
        return Err((2, format!("version {version} of `.serialized` files is not supported, only versions 3 and 4")));
    }
    if number == 0 {
        return Ok((0, version));
    }
    let count_at = bytes.len() - 4;
    let last = |at: usize| bytes.get(at..).and_then(|rest| rest.first_chunk());
    let count = last(count_at).map_or(0, |four| u32::from_le_bytes(*four));
    if number >= count {
        let message = format!("the file has no mesh {number}: it has {}", range_text(count as usize, "mesh", "meshes"));
        return Err((count_at, message));
    }
    let size = if version == 4 { 8 } else { 4 };
    let entry = count_at.checked_sub((count - number) as usize * size);
    let place = entry.and_then(|at| Some((at, bytes.get(at..at + size)?)));
    let Some((entry, place)) = place else {
        return Err((count_at, format!("the file is too short for the offsets of {count} meshes")));
    };
    let place = place.iter().rev().fold(0u64, |all, byte| all << 8 | u64::from(*byte));
    match usize::try_from(place).map(begins) {
        Ok(Ok(_)) => Ok((place as usize, version)),
        _ => Err((entry, format!("mesh {number} should begin at byte {place}, but no mesh begins there"))),
    }
}

/// Zlib stream of one mesh in a `.serialized` file, which is decompressed while its values are
/// read.
struct ZlibReader<'a> {
    inner: ZlibDecoder<&'a [u8]>,
    /// Offset of the compressed data in the file.
    start: usize,
}

impl ZlibReader<'_> {
    /// Returns the offset in the file up to which data has been read.
    fn position(&self) -> usize {
        self.start + self.inner.total_in() as usize
    }

    /// Reads `count` bytes. Memory is allocated only for bytes that exist.
    fn bytes(&mut self, what: &str, count: u64) -> Result<Vec<u8>, ParseError> {
        let mut bytes = Vec::new();
        let read = (&mut self.inner).take(count).read_to_end(&mut bytes);
        match read {
            Ok(_) if bytes.len() as u64 == count => Ok(bytes),
            Err(error) if error.kind() != ErrorKind::UnexpectedEof => {
                Err((self.position(), format!("the mesh cannot be decompressed: {error}")))
            }
            _ => Err((self.position(), format!("the mesh ends within its {what}"))),
        }
    }

    fn words<const N: usize>(&mut self, what: &str) -> Result<[u32; N], ParseError> {
        let bytes = self.bytes(what, 4 * N as u64)?;
        Ok(std::array::from_fn(|i| u32::from_le_bytes(bytes.as_chunks().0[i])))
    }

    fn pass_name(&mut self) -> Result<(), ParseError> {
        for _ in 0..MAX_NAME_LENGTH {
            if self.bytes("name", 1)? == [0] {
                return Ok(());
            }
        }
        Err((self.position(), format!("the name of the mesh is too long: more than {MAX_NAME_LENGTH} bytes")))
    }

    /// Reads `count` finite numbers that have 32 or 64 bits each.
    fn numbers(&mut self, what: &str, count: u64, double: bool) -> Result<Vec<f32>, ParseError> {
        let bytes = self.bytes(what, count * if double { 8 } else { 4 })?;
        let numbers: Vec<f32> = match double {
            true => bytes.as_chunks().0.iter().map(|eight| f64::from_le_bytes(*eight) as f32).collect(),
            false => bytes.as_chunks().0.iter().map(|four| f32::from_le_bytes(*four)).collect(),
        };
        match numbers.iter().position(|number| !number.is_finite()) {
            Some(i) => Err((self.position(), format!("number {i} of the {what} must be finite"))),
            None => Ok(numbers),
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use durer_scene::math::random::Random;
    use flate2::Compression;
    use flate2::write::ZlibEncoder;
    use std::io::Write;

    /// Returns an uncompressed mesh of two triangles with the lists that `flags` selects.
    pub fn stream(version: u16, flags: u32) -> Vec<u8> {
        let mut bytes = flags.to_le_bytes().to_vec();
        if version == 4 {
            bytes.extend(b"folded\0");
        }
        [4_u64, 2].iter().for_each(|count| bytes.extend(count.to_le_bytes()));
        let mut list = |numbers: &[f32]| match flags & DOUBLE {
            0 => numbers.iter().for_each(|x| bytes.extend(x.to_le_bytes())),
            _ => numbers.iter().for_each(|x| bytes.extend(f64::from(*x).to_le_bytes())),
        };
        list(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 1.0]);
        if flags & NORMALS != 0 {
            list(&[0.0, 0.0, 1.0, 0.0, 0.6, 0.8, 0.6, 0.0, 0.8, 0.0, 0.0, 1.0]);
        }
        if flags & UVS != 0 {
            list(&[0.0, 0.125, 1.0, 0.125, 1.0, 0.875, 0.0, 0.875]);
        }
        if flags & COLORS != 0 {
            list(&[0.5; 12]);
        }
        [0_u32, 1, 2, 0, 2, 3].iter().for_each(|corner| bytes.extend(corner.to_le_bytes()));
        bytes
    }

    /// Returns a file that contains several meshes.
    pub fn file(version: u16, streams: &[Vec<u8>]) -> Vec<u8> {
        let (mut bytes, mut places) = (Vec::new(), Vec::new());
        for stream in streams {
            places.push(bytes.len());
            bytes.extend(MARK.to_le_bytes());
            bytes.extend(version.to_le_bytes());
            let mut packed = ZlibEncoder::new(bytes, Compression::default());
            packed.write_all(stream).unwrap();
            bytes = packed.finish().unwrap();
        }
        for place in &places {
            match version {
                4 => bytes.extend((*place as u64).to_le_bytes()),
                _ => bytes.extend((*place as u32).to_le_bytes()),
            }
        }
        bytes.extend((places.len() as u32).to_le_bytes());
        bytes
    }

    #[test]
    fn error_has_byte_offset() {
        const MEMORY: u64 = 1 << 20;
        let good = file(4, &[stream(4, 0x1000), stream(4, 0x1003)]);
        assert!(parse(&good, 0, MEMORY).unwrap().uvs.is_empty() && parse(&good, 1, MEMORY).unwrap().uvs.len() == 4);
        let refused = |bytes: &[u8], number: u32, memory: u64, message: &str| {
            let (at, messages) = parse(bytes, number, memory).unwrap_err();
            assert!(at <= bytes.len() && messages.contains(message), "{at} {messages}"); // prose: keep
            at
        };
        assert_eq!(refused(b"ply\n", 0, MEMORY, "expected a Mitsuba mesh"), 0);
        assert_eq!(refused(b"\x1c\x04\x05\x00", 0, MEMORY, "version 5 of `.serialized` files is not supported"), 2);
        assert_eq!(refused(&good, 2, MEMORY, "the file has no mesh 2: it has only the meshes 0 to 1"), good.len() - 4);
        refused(b"\x1c\x04\x04\x00\x09\x00\x00\x00", 5, MEMORY, "too short for the offsets of 9");
        refused(&good, 1, 100, "a file of this size cannot contain");
        // Tests with counts that are too large, indices out of range, and numbers that are not
        // finite.
        let changed = |at: usize, byte: u8, message: &str| {
            let mut inner = stream(3, 0x1000);
            inner[at] = byte;
            refused(&file(3, &[inner]), 0, u64::MAX, message);
        };
        changed(8, 1, "32-bit indices do not allow 4294967300 vertices");
        changed(19, 1, "a file of this size cannot contain");
        changed(7, 128, "a file of this size cannot contain");
        changed(4, 5, "the mesh ends within its vertex indices");
        changed(68, 9, "triangle 0 uses vertex 9, but the mesh has only the vertices 0 to 3");
        let mut inner = stream(3, 0x1000);
        inner[24..28].copy_from_slice(&f32::NAN.to_le_bytes());
        refused(&file(3, &[inner]), 0, MEMORY, "number 1 of the positions must be finite");
    }

    #[test]
    fn changed_bytes_never_panic() {
        let mut random = Random(31);
        let (mut read, mut refused) = (0, 0);
        for round in 0..6_000 {
            let version = 3 + (round % 2) as u16;
            let mut inner = stream(version, if round % 3 == 0 { 0x200b } else { 0x1003 });
            let mut change = |bytes: &mut Vec<u8>| {
                for _ in 0..1 + random.below(3) {
                    let (at, from) = (random.below(bytes.len()), random.below(bytes.len()));
                    match random.below(3) {
                        0 => bytes[at] = bytes[from],
                        1 => bytes[at] = random.below(256) as u8,
                        _ if round % 8 == 0 => bytes.truncate(at.max(1)),
                        _ => bytes[at] ^= 1 << random.below(8),
                    }
                }
            };
            // Half of the meshes are damaged before they are compressed.
            if round % 4 < 2 {
                change(&mut inner);
            }
            let mut bytes = file(version, &[stream(version, 0x1000), inner]);
            if round % 4 >= 2 {
                change(&mut bytes);
            }
            match parse(&bytes, 1, 1 << 24) {
                Err((at, message)) => {
                    assert!(at <= bytes.len() && !message.is_empty());
                    refused += 1;
                }
                Ok(data) => {
                    let count = data.positions.len() as u32;
                    assert!(data.positions.iter().all(|p| p.is_finite()));
                    assert!(data.triangles.as_flattened().iter().all(|corner| *corner < count));
                    read += 1;
                }
            }
        }
        assert!(read > 1_000 && refused > 1_000, "{read} {refused}");
    }
}
