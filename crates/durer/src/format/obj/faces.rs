//! The faces of a Wavefront file, once all of its vertices are known.

use super::{Statement, Switch, statement, words::Words};
use crate::format::number::parse_integer;
use crate::format::polygon::Cutter;
use crate::format::report::{Report, counted, shown};
use crate::shape::mesh::{MeshData, NO_INDEX};
use std::ops::Range;

/// What a corner refers to: a position, a texture coordinate and a normal.
type Corner = [u32; 3];

/// The statements that corners refer to, in the order in which a corner does: singular, plural, keyword.
const KINDS: [(&str, &str, &str); 3] =
    [("vertex", "vertices", "v"), ("texture coordinate", "texture coordinates", "vt"), ("normal", "normals", "vn")];

/// Reads the faces and cuts them into triangles. Repeated corners are kept: they do no harm.
pub(super) fn read_faces(bytes: &[u8], mesh: &mut MeshData, switches: &mut Vec<Switch>, report: &mut Report) {
    let mut reader = FaceReader {
        bytes,
        total: [mesh.positions.len(), mesh.uvs.len(), mesh.normals.len()],
        so_far: [0; 3],
        corners: Vec::new(),
        cutter: Cutter::new(bytes.len()),
        degenerate: None,
    };
    let mut words = Words::new(bytes);
    while let Some(keyword) = words.next_statement() {
        match statement(&bytes[keyword.clone()]) {
            Some(Statement::Position) => reader.so_far[0] += 1,
            Some(Statement::Uv) => reader.so_far[1] += 1,
            Some(Statement::Normal) => reader.so_far[2] += 1,
            Some(Statement::Face) => reader.face(keyword, &mut words, mesh, report),
            Some(Statement::Material) => switches.push((mesh.triangles.len(), rest_of(&mut words, keyword.end))),
            Some(Statement::Library | Statement::Ignored) | None => {}
        }
        words.skip_rest();
        if report.is_full() {
            return;
        }
    }
    // From the first triangle that has texture coordinates or normals on, all have entries; so must those before.
    for list in [&mut mesh.triangle_uvs, &mut mesh.triangle_normals] {
        if !list.is_empty() {
            list.resize(mesh.triangles.len(), [NO_INDEX; 3]);
        }
    }
    if let Some((first, count)) = reader.degenerate {
        let verb = if count == 1 { "names" } else { "name" };
        report.note(first, format!("{} {verb} a vertex twice; the first is here", counted(count, "face", "faces")));
    }
}

/// The rest of a statement as one range, for names may have blanks.
pub(super) fn rest_of(words: &mut Words, end: usize) -> Range<usize> {
    match words.next_word() {
        Some(first) => first.start..words.skip_rest().unwrap_or(first.end),
        None => end..end,
    }
}

struct FaceReader<'a> {
    bytes: &'a [u8],
    /// How many vertices, texture coordinates and normals the file has.
    total: [usize; 3],
    /// How many of them come before this statement.
    so_far: [usize; 3],
    corners: Vec<Corner>,
    cutter: Cutter,
    /// The first face that names a vertex twice, and how many do.
    degenerate: Option<(Range<usize>, usize)>,
}

impl FaceReader<'_> {
    fn face(&mut self, keyword: Range<usize>, words: &mut Words, mesh: &mut MeshData, report: &mut Report) {
        self.corners.clear();
        let mut all_good = true;
        let mut written = 0;
        let mut place = keyword;
        while let Some(word) = words.next_word() {
            place.end = word.end;
            written += 1;
            match self.corner(word, report) {
                Some(corner) => self.corners.push(corner),
                None if report.is_full() => return,
                None => all_good = false,
            }
        }
        if written < 3 {
            let message = format!("a face needs at least 3 corners, found {written}");
            report.error(place, message).help = (written == 2).then(|| "a line is an `l` statement".into());
        } else if all_good {
            self.note_degenerate(&place);
            self.cut(place, mesh, report);
        }
    }

    /// Reads `a`, `a/t`, `a//n` or `a/t/n`.
    fn corner(&self, word: Range<usize>, report: &mut Report) -> Option<Corner> {
        let mut corner = [NO_INDEX; 3];
        let mut start = word.start;
        for (part, slot) in corner.iter_mut().enumerate() {
            let rest = &self.bytes[start..word.end];
            let end = start + rest.iter().position(|&byte| byte == b'/').unwrap_or(rest.len());
            // All but the position may be left empty.
            if end > start || part == 0 {
                *slot = self.index(start..end, part, report)?;
            }
            if end == word.end {
                return Some(corner);
            }
            start = end + 1;
        }
        let message = format!("a corner has at most 3 indices, found {}", shown(&self.bytes[word.clone()]));
        report.error(word, message).help =
            Some("a corner is `vertex`, `vertex/texture`, `vertex//normal` or `vertex/texture/normal`".into());
        None
    }

    /// Reads an index, counted from 1 or, negative, back from the last statement of its kind.
    fn index(&self, at: Range<usize>, part: usize, report: &mut Report) -> Option<u32> {
        let (one, many, keyword) = KINDS[part];
        let total = self.total[part];
        let text = &self.bytes[at.clone()];
        let Some(index) = parse_integer(text) else {
            let found = if text.is_empty() { "nothing".into() } else { shown(text) };
            report.error(at, format!("expected the number of a {one}, found {found}"));
            return None;
        };
        let so_far = self.so_far[part] as i64;
        if index > 0 && index <= total as i64 {
            return Some((index - 1) as u32);
        }
        if index < 0 && index >= -so_far {
            return Some((so_far + index) as u32);
        }
        if index == 0 {
            let message = format!("there is no {one} 0: they are counted from 1");
            report.error(at, message);
        } else if index > 0 {
            let message = format!("there is no {one} {}: the file has {}", shown(text), counted(total, one, many));
            report.error(at, message).help =
                (total == 0).then(|| format!("{many} are made by `{keyword}` statements, and there are none"));
        } else {
            let before = counted(so_far as usize, one, many);
            report.error(at, format!("{} reaches back too far: {before} so far", shown(text)));
        }
        None
    }

    fn note_degenerate(&mut self, place: &Range<usize>) {
        // Neighbours only: outlines with holes pass a vertex twice for good reason.
        let last = self.corners.len() - 1;
        let repeats = |i: usize| self.corners[i][0] == self.corners[if i == last { 0 } else { i + 1 }][0];
        if (0..=last).any(repeats) {
            self.degenerate.get_or_insert((place.clone(), 0)).1 += 1;
        }
    }

    fn cut(&mut self, place: Range<usize>, mesh: &mut MeshData, report: &mut Report) {
        let MeshData { positions, triangles, triangle_uvs, triangle_normals, .. } = mesh;
        let corners = &self.corners;
        let position = |i: usize| positions[corners[i][0] as usize];
        let cut = self.cutter.cut(corners.len(), position, |triangle| {
            let indices = |part: usize| triangle.map(|i| corners[i][part]);
            let before = triangles.len();
            triangles.push(indices(0));
            push_optional(triangle_uvs, before, indices(1));
            push_optional(triangle_normals, before, indices(2));
        });
        if cut.is_err() {
            report.error(place, format!("this face of {} corners is too crooked to be cut", corners.len())).help =
                Some("cut it into triangles in a modelling program".into());
        }
    }
}

/// Adds indices to a list that begins, filled up, where the first triangle has some.
fn push_optional(list: &mut Vec<[u32; 3]>, before: usize, indices: [u32; 3]) {
    if !list.is_empty() || indices != [NO_INDEX; 3] {
        list.resize(before, [NO_INDEX; 3]);
        list.push(indices);
    }
}
