//! Reader of Wavefront `.obj` files, which supports polygons, lines, and points but not curves and
//! surfaces. `scene.rs` adds the materials from `.mtl` files.
//!
//! The file is read in two passes: the first reads positions, texture coordinates, and normals, and
//! the second reads faces, which can refer to vertices that appear later in the file. With two
//! passes, only the mesh itself needs to be kept in memory. Both passes process parts of the file
//! in parallel.

mod faces;
mod materials;
mod mtl;
pub mod quirks;
pub(super) mod scene;
mod wires;
mod words;
mod write;

use super::MeshFormat;
use super::number::{NumberError, parse_f32, report_number};
use super::report::{Report, count_text, quoted};
use durer_diag::{Diagnostics, did_you_mean};
use durer_scene::math::{Vec2, Vec3};
use durer_scene::scene::Axis;
use durer_scene::shape::mesh::MeshData;
use rayon::prelude::*;
use std::ops::Range;
use words::Words;
use write::write;

/// Kind of a Wavefront statement, which its first word determines.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Statement {
    Position,
    Uv,
    Normal,
    Face,
    /// Lines and points have no surface. Mesh readers ignore lines and points; scene readers make
    /// them visible.
    Line,
    Point,
    /// Sets the material for the statements that follow.
    Material,
    /// Names one or more material files.
    Library,
    /// Sets the smoothing group for the faces that follow. Faces in a smoothing group that lack
    /// normals are smoothed.
    Smoothing,
    /// Known statement that has no effect on the mesh.
    Ignored,
}

/// Supported statements, each with its first word.
const STATEMENTS: &[(&str, Statement)] = &[
    ("v", Statement::Position),
    ("vt", Statement::Uv),
    ("vn", Statement::Normal),
    ("f", Statement::Face),
    // Versions of the format before 2.11 use `fo` instead of `f`.
    ("fo", Statement::Face),
    ("o", Statement::Ignored),
    ("g", Statement::Ignored),
    ("s", Statement::Smoothing),
    ("mg", Statement::Ignored),
    ("usemtl", Statement::Material),
    ("mtllib", Statement::Library),
    ("usemap", Statement::Ignored),
    ("maplib", Statement::Ignored),
    ("l", Statement::Line),
    ("p", Statement::Point),
    ("vp", Statement::Ignored),
    ("lod", Statement::Ignored),
    ("bevel", Statement::Ignored),
    ("c_interp", Statement::Ignored),
    ("d_interp", Statement::Ignored),
    ("shadow_obj", Statement::Ignored),
    ("trace_obj", Statement::Ignored),
];

fn statement(word: &[u8]) -> Option<Statement> {
    // Fast path: nearly all statements in a file are of these two kinds.
    match word {
        b"v" => Some(Statement::Position),
        b"f" => Some(Statement::Face),
        _ => STATEMENTS.iter().find(|(name, _)| name.as_bytes() == word).map(|&(_, statement)| statement),
    }
}

/// Entry for Wavefront files in the list of mesh formats.
pub(super) const FORMAT: MeshFormat = MeshFormat {
    name: "Wavefront OBJ",
    extensions: &["obj"],
    recognise,
    read,
    apply_quirks: quirks::apply_quirks,
    write,
    up: Axis::Y,
};

/// Returns true if the first word is a keyword of this format.
fn recognise(bytes: &[u8]) -> bool {
    let head = &bytes[..bytes.len().min(1 << 16)];
    Words::new(head).next_statement().is_some_and(|word| statement(&head[word]).is_some())
}

/// Returns true if a file that has another extension is certainly a Wavefront file: text whose
/// first statement other than comments is a vertex with three coordinates or more.
pub(super) fn is_certain(bytes: &[u8]) -> bool {
    let head = &bytes[..bytes.len().min(1 << 12)];
    let is_comment = |line: &[u8]| matches!(line.first(), None | Some(b'#' | b'o' | b'g' | b'm'));
    let lines = head.split(|byte| *byte == b'\n').map(|line| line.trim_ascii());
    let first = lines.clone().find(|line| !is_comment(line)).and_then(|line| line.strip_prefix(b"v "));
    let is_number = |word: &[u8]| super::number::parse_f32(word).is_ok();
    let words = |line: &[u8]| line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).count();
    let numbers = |line: &[u8]| line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).all(is_number);
    !head.contains(&0) && first.is_some_and(|rest| words(rest) >= 3 && numbers(rest))
}

/// Reads a Wavefront file; see [`read_mesh`](super::read_mesh).
fn read(bytes: &[u8], file: u32, diagnostics: &mut Diagnostics) -> Option<MeshData> {
    read_with(bytes, file, &mut StateChanges::default(), diagnostics)
}

/// Change of state between faces: the index of the first triangle that it applies to, and the new
/// state.
type StateChange<T> = (usize, T);

/// Changes of material and smoothing group between the faces of a Wavefront file.
#[derive(Default)]
struct StateChanges {
    /// Byte range of the name of the material.
    materials: Vec<StateChange<Range<usize>>>,
    /// Number of the smoothing group, or 0 if there is none.
    groups: Vec<StateChange<u32>>,
}

/// Reads a mesh, and the state changes between its faces.
fn read_with(bytes: &[u8], file: u32, switches: &mut StateChanges, diagnostics: &mut Diagnostics) -> Option<MeshData> {
    let mut report = Report::new(file, diagnostics);
    let mut mesh = MeshData::default();
    let parts = words::parts(bytes);
    let counts = read_vertices(bytes, &parts, &mut mesh, &mut report);
    if !report.is_full() {
        faces::read_faces(bytes, &parts, &counts, &mut mesh, switches, &mut report);
    }
    if mesh.triangles.is_empty() && !report.has_errors() {
        report.warning(bytes.len()..bytes.len(), "the mesh has no triangles");
    }
    report.finish(diagnostics, mesh)
}

/// Vertices that were read from one part of a Wavefront file, with the diagnostics for that part.
struct Vertices {
    mesh: MeshData,
    /// Byte range of the first unsupported statement, and the number of unsupported statements.
    unknown: Option<(Range<usize>, usize)>,
    report: Report,
}

/// Number of positions, of texture coordinates, and of normals.
type Counts = [usize; 3];

fn counts(mesh: &MeshData) -> Counts {
    [mesh.positions.len(), mesh.uvs.len(), mesh.normals.len()]
}

/// Reads positions, texture coordinates, and normals, and checks the keywords of all other
/// statements. Returns the number of vertices of each kind before each part.
fn read_vertices(bytes: &[u8], parts: &[Range<usize>], mesh: &mut MeshData, report: &mut Report) -> Vec<Counts> {
    let read = |part: &Range<usize>| vertices(bytes, part.clone(), report.part());
    let read: Vec<Vertices> = parts.par_iter().map(read).collect();
    let total = |count: fn(&MeshData) -> usize| read.iter().map(|part| count(&part.mesh)).sum();
    mesh.positions.reserve_exact(total(|mesh| mesh.positions.len()));
    mesh.uvs.reserve_exact(total(|mesh| mesh.uvs.len()));
    mesh.normals.reserve_exact(total(|mesh| mesh.normals.len()));
    let mut before = Vec::with_capacity(parts.len());
    let mut unknown: Option<(Range<usize>, usize)> = None;
    for part in read {
        before.push(counts(mesh));
        if !part.mesh.colors.is_empty() {
            mesh.colors.resize(mesh.positions.len(), [1.0; 4]);
            mesh.colors.extend(part.mesh.colors);
        }
        mesh.positions.extend(part.mesh.positions);
        mesh.uvs.extend(part.mesh.uvs);
        mesh.normals.extend(part.mesh.normals);
        report.join(part.report);
        if let Some((first, count)) = part.unknown {
            unknown.get_or_insert((first, 0)).1 += count;
        }
    }
    if report.is_full() {
        return before;
    }
    if !mesh.colors.is_empty() {
        mesh.colors.resize(mesh.positions.len(), [1.0; 4]);
    }
    if let Some((first, count)) = unknown {
        let word = &bytes[first.clone()];
        let suggestion = did_you_mean(&quoted(word).replace('`', ""), STATEMENTS.iter().map(|&(name, _)| name));
        let statements = count_text(count, "statement", "statements");
        let message = format!("left out {statements} with an unknown keyword; the first is {}", quoted(word));
        report.warning(first, message).help = suggestion.map(|name| format!("did you mean `{name}`?"));
    }
    before
}

/// Reads the vertices of one part of the file.
fn vertices(bytes: &[u8], part: Range<usize>, mut report: Report) -> Vertices {
    let (mut mesh, mut unknown) = (MeshData::default(), None::<(Range<usize>, usize)>);
    let mut words = Words::within(bytes, part);
    while let Some(keyword) = words.next_statement() {
        match statement(&bytes[keyword.clone()]) {
            Some(Statement::Position) => {
                let ([x, y, z, r, g, b], count) = numbers(bytes, keyword, 3, 3, &mut words, &mut report);
                mesh.positions.push(Vec3::new(x, y, z));
                // A weight or a colour may follow the position.
                if count == 6 {
                    mesh.colors.resize(mesh.positions.len() - 1, [1.0; 4]);
                    let [r, g, b] = [r, g, b].map(decode);
                    mesh.colors.push([r, g, b, 1.0]);
                }
            }
            Some(Statement::Uv) => {
                let ([u, v], _) = numbers(bytes, keyword, 1, 2, &mut words, &mut report);
                mesh.uvs.push(Vec2::new(u, v));
            }
            Some(Statement::Normal) => {
                let ([x, y, z], _) = numbers(bytes, keyword, 3, 3, &mut words, &mut report);
                mesh.normals.push(Vec3::new(x, y, z));
            }
            Some(_) => words.skip(),
            None => {
                unknown.get_or_insert((keyword, 0)).1 += 1;
                words.skip();
            }
        }
        if report.is_full() {
            break;
        }
    }
    if !mesh.colors.is_empty() {
        mesh.colors.resize(mesh.positions.len(), [1.0; 4]);
    }
    Vertices { mesh, unknown, report }
}

/// Decodes an sRGB value in the range from 0 to 1. Returns 1 for any other value, including NaN.
fn decode(value: f32) -> f32 {
    if (0.0..=1.0).contains(&value) { durer_image::decode_srgb((value * 255.0 + 0.5) as u8) } else { 1.0 }
}

/// Reads the numbers of a statement and returns them with their count. The first `needed` numbers
/// must be present, and the first `sound` must be finite; missing or invalid ones become 0.
///
/// Additional numbers, such as weights and colours, are allowed. Any other words are errors, since
/// they suggest that two lines were joined by mistake.
fn numbers<const N: usize>(
    bytes: &[u8],
    keyword: Range<usize>,
    needed: usize,
    sound: usize,
    words: &mut Words,
    report: &mut Report,
) -> ([f32; N], usize) {
    let mut values = [0.0; N];
    let mut count = 0;
    let mut end = keyword.end;
    while let Some(word) = words.next_word() {
        end = word.end;
        match parse_f32(&bytes[word.clone()]) {
            Ok(value) if count < N => values[count] = value,
            Ok(_) => {}
            // The other numbers may be infinite: either they are unused, or they are colours, which
            // `decode` clamps.
            Err(NumberError::NotFinite) if count >= sound => _ = values.get_mut(count).map(|value| *value = f32::NAN),
            Err(error) => report_number(report, error, word.clone(), &bytes[word]),
        }
        count += 1;
        if report.is_full() {
            break;
        }
    }
    if count < needed && !report.is_full() {
        let name = quoted(&bytes[keyword.clone()]);
        let message = format!("{name} needs {}, found {count}", count_text(needed, "number", "numbers"));
        report.error(keyword.start..end, message);
    }
    (values, count)
}

#[cfg(test)]
mod tests;
