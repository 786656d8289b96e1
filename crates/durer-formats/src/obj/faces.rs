//! Reads the faces of a Wavefront file after all vertices have been read.

use super::{Counts, StateChanges, Statement, counts, statement, words::Words};
use crate::number::parse_integer;
use crate::polygon::Triangulator;
use crate::report::{Report, count_text, quoted};
use durer_scene::math::Vec3;
use durer_scene::shape::mesh::{MeshData, NO_INDEX};
use rayon::prelude::*;
use std::ops::Range;

/// Indices of a corner of a face: its position, texture coordinate, and normal.
type Corner = [u32; 3];

/// Names of the items that the indices of a corner refer to: singular, plural, and keyword.
const KINDS: [(&str, &str, &str); 3] =
    [("vertex", "vertices", "v"), ("texture coordinate", "texture coordinates", "vt"), ("normal", "normals", "vn")];

/// Triangles that were read from one part of a Wavefront file, with the state changes and
/// diagnostics of that part.
struct Faces {
    mesh: MeshData,
    switches: StateChanges,
    /// Byte range of the first face that uses a vertex twice, and the number of such faces.
    degenerate: Option<(Range<usize>, usize)>,
    report: Report,
}

/// Reads the faces in parallel and splits them into triangles. Repeated corners do no harm, so they
/// are kept. `before` contains the number of vertices of each kind that come before each part.
pub(super) fn read_faces(
    bytes: &[u8],
    parts: &[Range<usize>],
    before: &[Counts],
    mesh: &mut MeshData,
    switches: &mut StateChanges,
    report: &mut Report,
) {
    let read = |(part, so_far): (&Range<usize>, &Counts)| faces(bytes, part.clone(), *so_far, mesh, report.part());
    let read: Vec<Faces> = parts.par_iter().zip(before).map(read).collect();
    mesh.triangles.reserve_exact(read.iter().map(|part| part.mesh.triangles.len()).sum());
    let mut degenerate: Option<(Range<usize>, usize)> = None;
    for part in read {
        let first = mesh.triangles.len();
        mesh.triangles.extend(part.mesh.triangles);
        // If any triangle has texture coordinates or normals, every triangle needs an entry, so
        // entries are added for the triangles before the first one that has them.
        for (all, own) in
            [(&mut mesh.triangle_uvs, part.mesh.triangle_uvs), (&mut mesh.triangle_normals, part.mesh.triangle_normals)]
        {
            if !own.is_empty() {
                all.resize(first, [NO_INDEX; 3]);
                all.extend(own);
            }
        }
        let StateChanges { materials, groups } = part.switches;
        switches.materials.extend(materials.into_iter().map(|(triangle, at)| (first + triangle, at)));
        switches.groups.extend(groups.into_iter().map(|(triangle, group)| (first + triangle, group)));
        report.join(part.report);
        if let Some((first, count)) = part.degenerate {
            degenerate.get_or_insert((first, 0)).1 += count;
        }
        if report.is_full() {
            return;
        }
    }
    for list in [&mut mesh.triangle_uvs, &mut mesh.triangle_normals] {
        if !list.is_empty() {
            list.resize(mesh.triangles.len(), [NO_INDEX; 3]);
        }
    }
    if let Some((first, count)) = degenerate {
        let verb = if count == 1 { "uses" } else { "use" };
        report.note(
            first,
            format!("{} {verb} a vertex twice; the first such face is here", count_text(count, "face", "faces")),
        );
    }
}

/// Reads the faces of one part of the file.
fn faces(bytes: &[u8], part: Range<usize>, before: Counts, whole: &MeshData, report: Report) -> Faces {
    let mut reader = FaceReader {
        bytes,
        total: counts(whole),
        before,
        positions: &whole.positions,
        corners: Vec::new(),
        triangulator: Triangulator::new(part.len()),
        faces: Faces { mesh: MeshData::default(), switches: StateChanges::default(), degenerate: None, report },
    };
    let mut words = Words::within(bytes, part);
    while let Some(keyword) = words.next_statement() {
        match statement(&bytes[keyword.clone()]) {
            Some(Statement::Position) => reader.before[0] += 1,
            Some(Statement::Uv) => reader.before[1] += 1,
            Some(Statement::Normal) => reader.before[2] += 1,
            Some(Statement::Face) => reader.face(keyword, &mut words),
            Some(Statement::Material) => {
                let name = rest_of(&mut words, keyword.end);
                reader.faces.switches.materials.push((reader.faces.mesh.triangles.len(), name));
            }
            Some(Statement::Smoothing) => {
                // `off` does not parse as a number, and so it means group 0.
                let word = words.next_word().map_or(&[][..], |word| &bytes[word]);
                let group = std::str::from_utf8(word).ok().and_then(|word| word.parse().ok()).unwrap_or(0);
                reader.faces.switches.groups.push((reader.faces.mesh.triangles.len(), group));
            }
            Some(Statement::Line | Statement::Point | Statement::Library | Statement::Ignored) | None => {}
        }
        words.skip();
        if reader.faces.report.is_full() {
            break;
        }
    }
    reader.faces
}

/// Returns the rest of a statement as one range, because names may contain spaces.
pub(super) fn rest_of(words: &mut Words, end: usize) -> Range<usize> {
    match words.next_word() {
        Some(first) => first.start..words.skip_rest().unwrap_or(first.end),
        None => end..end,
    }
}

/// Reads the `f` statements of one part of a Wavefront file.
struct FaceReader<'a> {
    bytes: &'a [u8],
    /// Number of vertices, texture coordinates, and normals in the whole file.
    total: Counts,
    /// Number of vertices, texture coordinates, and normals before the current statement.
    before: Counts,
    positions: &'a [Vec3],
    corners: Vec<Corner>,
    triangulator: Triangulator,
    faces: Faces,
}

impl FaceReader<'_> {
    fn face(&mut self, keyword: Range<usize>, words: &mut Words) {
        self.corners.clear();
        let mut all_good = true;
        let mut count = 0;
        let mut place = keyword;
        while let Some(word) = words.next_word() {
            place.end = word.end;
            count += 1;
            match self.corner(word) {
                Some(corner) => self.corners.push(corner),
                None if self.faces.report.is_full() => return,
                None => all_good = false,
            }
        }
        if count < 3 {
            let message = format!("a face needs at least 3 vertices, found {count}");
            self.faces.report.error(place, message).help =
                (count == 2).then(|| "write a line as an `l` statement".into());
        } else if all_good {
            self.note_degenerate(&place);
            self.cut(place);
        }
    }

    /// Parses a corner in the form `a`, `a/t`, `a//n`, or `a/t/n`.
    fn corner(&mut self, word: Range<usize>) -> Option<Corner> {
        let mut corner = [NO_INDEX; 3];
        let mut start = word.start;
        for (part, slot) in corner.iter_mut().enumerate() {
            let rest = &self.bytes[start..word.end];
            let end = start + rest.iter().position(|&byte| byte == b'/').unwrap_or(rest.len());
            // Every index except that of the position may be empty.
            if end > start || part == 0 {
                let counts = [self.total[part], self.before[part]];
                *slot = index(self.bytes, start..end, part, counts, &mut self.faces.report)?;
            }
            if end == word.end {
                return Some(corner);
            }
            start = end + 1;
        }
        let message =
            format!("a vertex reference can have at most 3 indices, found {}", quoted(&self.bytes[word.clone()]));
        self.faces.report.error(word, message).help =
            Some("write `vertex`, `vertex/texture`, `vertex//normal` or `vertex/texture/normal`".into());
        None
    }

    fn note_degenerate(&mut self, place: &Range<usize>) {
        // Compare only neighbouring corners, because outlines with holes visit a vertex twice on
        // purpose.
        let last = self.corners.len() - 1;
        let repeats = |i: usize| self.corners[i][0] == self.corners[if i == last { 0 } else { i + 1 }][0];
        if (0..=last).any(repeats) {
            self.faces.degenerate.get_or_insert((place.clone(), 0)).1 += 1;
        }
    }

    fn cut(&mut self, place: Range<usize>) {
        let MeshData { triangles, triangle_uvs, triangle_normals, .. } = &mut self.faces.mesh;
        let (positions, corners) = (self.positions, &self.corners);
        let position = |i: usize| positions[corners[i][0] as usize];
        let cut = self.triangulator.triangulate(corners.len(), position, |triangle| {
            let indices = |part: usize| triangle.map(|i| corners[i][part]);
            let before = triangles.len();
            triangles.push(indices(0));
            push_optional(triangle_uvs, before, indices(1));
            push_optional(triangle_normals, before, indices(2));
        });
        if cut.is_err() {
            self.faces
                .report
                .error(place, format!("this face is too complex to triangulate ({} vertices)", corners.len()))
                .help = Some("triangulate the face in a modelling program".into());
        }
    }
}

/// Reads an index. Positive indices count from 1, and negative ones count backwards from the last
/// statement of their kind. `total` and `so_far` are the numbers of such statements in the whole
/// file and before the current statement.
pub(super) fn index(
    bytes: &[u8],
    at: Range<usize>,
    kind: usize,
    [total, so_far]: [usize; 2],
    report: &mut Report,
) -> Option<u32> {
    let (one, many, keyword) = KINDS[kind];
    let text = &bytes[at.clone()];
    let Some(index) = parse_integer(text) else {
        let actual = if text.is_empty() { "nothing".into() } else { quoted(text) };
        report.error(at, format!("expected the number of a {one}, found {actual}"));
        return None;
    };
    if index > 0 && index <= total as i64 {
        return Some((index - 1) as u32);
    }
    if index < 0 && index >= -(so_far as i64) {
        return Some((so_far as i64 + index) as u32);
    }
    if index == 0 {
        report.error(at, format!("{one} 0 does not exist: the first index is 1"));
    } else if index > 0 {
        let message = format!("{one} {} does not exist: the file has {}", quoted(text), count_text(total, one, many));
        report.error(at, message).help = (total == 0).then(|| format!("add `{keyword}` statements for {many}"));
    } else {
        let before = count_text(so_far, one, many);
        report.error(
            at,
            format!("index {} reaches back too far: the file has {before} before this statement", quoted(text)),
        );
    }
    None
}

/// Appends the indices of a triangle. The list stays empty until a triangle has indices; at that
/// point, entries are added for all earlier triangles.
fn push_optional(list: &mut Vec<[u32; 3]>, before: usize, indices: [u32; 3]) {
    if !list.is_empty() || indices != [NO_INDEX; 3] {
        list.resize(before, [NO_INDEX; 3]);
        list.push(indices);
    }
}
