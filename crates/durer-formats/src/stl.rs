//! Reader and writer of stereolithography `.stl` meshes, which consist only of triangles, as text
//! or binary.
//!
//! Source: *StereoLithography Interface Specification*, 3D Systems, 1989. The order of a facet's
//! corners determines its normal, so the stored normals are ignored. Some programs store colours in
//! the last two bytes of a facet, which are ignored too.

mod text;
mod write;

use super::report::{Report, count_text};
use super::{MeshFormat, without_quirks};
use durer_diag::Diagnostics;
use durer_scene::math::Vec3;
use durer_scene::scene::Axis;
use durer_scene::shape::mesh::{MeshData, position_key};
use std::collections::HashMap;
use write::write;

/// Size in bytes of the header of a binary file, which contains free text and the number of facets.
const HEAD: usize = 84;
/// Size in bytes of a facet: a normal, three corners, and two unspecified bytes.
const FACET: usize = 50;

/// Entry for STL in the list of mesh formats.
pub(super) const FORMAT: MeshFormat =
    MeshFormat { name: "STL", extensions: &["stl"], recognise, read, apply_quirks: without_quirks, write, up: Axis::Z };

/// Returns true if a file begins like an STL file, or if its size agrees with the number of facets
/// in a binary header.
fn recognise(bytes: &[u8]) -> bool {
    is_text(bytes) || promised(bytes).is_some_and(|count| count > 0 && size_of_facets(count) == bytes.len() as u64)
}

/// Returns true if a file is a text file. Binary files can also begin with the word `solid`.
pub(super) fn is_text(bytes: &[u8]) -> bool {
    let head =
        bytes[..bytes.len().min(1 << 12)].strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes[..bytes.len().min(1 << 12)]);
    let head = head.trim_ascii_start();
    let begins = head.get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    let has = |word: &[u8]| head.windows(word.len()).any(|part| part.eq_ignore_ascii_case(word));
    let exact = promised(bytes).is_some_and(|count| size_of_facets(count) == bytes.len() as u64);
    begins && !exact && !head.contains(&0) && (has(b"facet") || has(b"endsolid") || head.len() < HEAD)
}

/// Returns the number of facets that the header of a binary file states.
fn promised(bytes: &[u8]) -> Option<u32> {
    Some(u32::from_le_bytes(*bytes.get(80..)?.first_chunk()?))
}

fn size_of_facets(count: u32) -> u64 {
    HEAD as u64 + FACET as u64 * u64::from(count)
}

/// Reads an STL file; see [`read_mesh`](super::read_mesh).
fn read(bytes: &[u8], file: u32, diagnostics: &mut Diagnostics) -> Option<MeshData> {
    let mut report = Report::new(file, diagnostics);
    let mut mesh = Builder::default();
    match is_text(bytes) {
        true => text::read(bytes, &mut mesh, &mut report),
        false => read_binary(bytes, &mut mesh, &mut report),
    }
    if mesh.data.triangles.is_empty() && !report.has_errors() {
        report.warning(0..0, "the mesh has no triangles");
    }
    report.finish(diagnostics, mesh.data)
}

fn read_binary(bytes: &[u8], mesh: &mut Builder, report: &mut Report) {
    let Some(count) = promised(bytes) else {
        let message = format!("a binary STL file has at least {HEAD} bytes, but this file has {} bytes", bytes.len());
        report.error(0..bytes.len().min(HEAD), message).help = Some("begin a text file with the word `solid`".into());
        return;
    };
    let (facets, rest) = bytes[HEAD..].as_chunks::<FACET>();
    let facets = match (facets.len() as u64).cmp(&u64::from(count)) {
        std::cmp::Ordering::Less => {
            let there = count_text(facets.len(), "facet", "facets");
            report.error(80..84, format!("the header declares {count} facets, but the file ends after {there}"));
            return;
        }
        order => {
            if order.is_gt() || !rest.is_empty() {
                let extra = bytes.len() as u64 - size_of_facets(count);
                let at = size_of_facets(count) as usize;
                report.warning(at..at + 1, format!("ignored {extra} bytes after the last facet"));
            }
            &facets[..count as usize]
        }
    };
    mesh.data.triangles.reserve_exact(facets.len());
    for (number, facet) in facets.iter().enumerate() {
        let float = |i: usize| f32::from_le_bytes([facet[i], facet[i + 1], facet[i + 2], facet[i + 3]]);
        let corner = |i: usize| Vec3::new(float(12 + 12 * i), float(16 + 12 * i), float(20 + 12 * i));
        let corners = [corner(0), corner(1), corner(2)];
        if corners.iter().all(|p| p.is_finite()) {
            mesh.facet(corners);
            continue;
        }
        let at = HEAD + FACET * number;
        report.error(at..at + FACET, format!("facet {} has a vertex with an infinite coordinate or NaN", number + 1));
        if report.is_full() {
            return;
        }
    }
}

/// Builder that creates a mesh from STL facets. The builder merges corners at equal positions,
/// because facets in STL do not share vertices.
#[derive(Default)]
struct Builder {
    data: MeshData,
    numbers: HashMap<[u32; 3], u32>,
}

impl Builder {
    fn facet(&mut self, corners: [Vec3; 3]) {
        let numbers = corners.map(|corner| {
            *self.numbers.entry(position_key(corner)).or_insert_with(|| {
                self.data.positions.push(corner);
                (self.data.positions.len() - 1) as u32
            })
        });
        self.data.triangles.push(numbers);
    }
}

#[cfg(test)]
mod tests;
