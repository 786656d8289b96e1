//! Reader and writer of Object File Format (`.off`) meshes in text, with polygons and colours.
//!
//! Source: *Geomview Manual*, "OFF Files", The Geometry Center. The first word consists of optional
//! prefixes (`ST` texture coordinates, `C` colours, `N` normals) and `OFF`.

use super::face_colors::color_faces;
use super::number::{NumberError, parse_f32};
use super::polygon::Triangulator;
use super::report::{Report, quoted};
use super::{MeshFormat, without_quirks};
use durer_diag::Diagnostics;
use durer_scene::math::{Vec2, Vec3};
use durer_scene::scene::Axis;
use durer_scene::shape::mesh::MeshData;
use std::ops::Range;

/// Entry for OFF in the list of mesh formats.
pub(super) const FORMAT: MeshFormat =
    MeshFormat { name: "OFF", extensions: &["off"], recognise, read, apply_quirks: without_quirks, write, up: Axis::Y };

/// First words of files that are read.
const HEADERS: [&[u8]; 8] = [b"OFF", b"COFF", b"NOFF", b"CNOFF", b"STOFF", b"STCOFF", b"STNOFF", b"STCNOFF"];

/// Returns true if the first word of a file is one of [`HEADERS`].
fn recognise(bytes: &[u8]) -> bool {
    let first = bytes.split(|byte| byte.is_ascii_whitespace()).next().unwrap_or_default();
    HEADERS.contains(&first)
}

/// Words of the text with their positions. Comments begin with `#`.
struct Words<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Words<'a> {
    /// Returns the position of the next word, or `None` at the end of the file. If `same_line` is
    /// set, also returns `None` at the end of the line.
    fn next(&mut self, same_line: bool) -> Option<Range<usize>> {
        loop {
            match *self.bytes.get(self.at)? {
                b'\n' | b'#' if same_line => return None,
                b'#' => self.at += self.bytes[self.at..].iter().take_while(|byte| **byte != b'\n').count(),
                byte if byte.is_ascii_whitespace() => self.at += 1,
                _ => break,
            }
        }
        let length =
            self.bytes[self.at..].iter().take_while(|byte| !byte.is_ascii_whitespace() && **byte != b'#').count();
        let word = self.at..self.at + length;
        self.at = word.end;
        Some(word)
    }

    /// Reads a number, and reports an error if there is none.
    fn number(&mut self, report: &mut Report, what: &str) -> Option<f32> {
        let Some(at) = self.next(false) else {
            let end = self.bytes.len();
            report.error(end..end, format!("the file ends before {what}"));
            return None;
        };
        match parse_f32(&self.bytes[at.clone()]) {
            Ok(number) => Some(number),
            Err(error) => {
                let word = quoted(&self.bytes[at.clone()]);
                let message = match error {
                    NumberError::NotFinite => format!("{what} must be a finite number, found {word}"),
                    _ => format!("{what} must be a number, found {word}"),
                };
                report.error(at, message);
                None
            }
        }
    }

    /// Reads a whole number of 0 or more.
    fn count(&mut self, report: &mut Report, what: &str) -> Option<(usize, Range<usize>)> {
        let Some(at) = self.next(false) else {
            let end = self.bytes.len();
            report.error(end..end, format!("the file ends before {what}"));
            return None;
        };
        let number = std::str::from_utf8(&self.bytes[at.clone()]).ok().and_then(|word| word.parse().ok());
        if number.is_none() {
            report
                .error(at.clone(), format!("{what} must be a whole number, found {}", quoted(&self.bytes[at.clone()])));
        }
        Some((number?, at))
    }

    /// Reads the numbers up to the end of the line.
    fn rest_of_line(&mut self) -> Vec<f32> {
        let mut numbers = Vec::new();
        while let Some(at) = self.next(true) {
            match parse_f32(&self.bytes[at]) {
                Ok(number) if numbers.len() < 4 => numbers.push(number),
                _ => break,
            }
        }
        numbers
    }
}

/// Reads an OFF file; see [`read_mesh`](super::read_mesh).
fn read(bytes: &[u8], file: u32, diagnostics: &mut Diagnostics) -> Option<MeshData> {
    let mut report = Report::new(file, diagnostics);
    let before = report.count();
    let data = parse(bytes, &mut report);
    // A file with swapped counts can be readable, but its first faces then count as vertices.
    if !report_swapped_counts(bytes, &mut report, before) && data.is_none() {
        report_short_face(bytes, &mut report, before);
    }
    let data = data.unwrap_or_default();
    if data.triangles.is_empty() && !report.has_errors() {
        report.warning(0..0, "the mesh has no triangles");
    }
    report.finish(diagnostics, data)
}

fn parse(bytes: &[u8], report: &mut Report) -> Option<MeshData> {
    let mut words = Words { bytes, at: 0 };
    let mut header: &[u8] = b"OFF";
    let first = words.next(false).unwrap_or(0..0);
    match HEADERS.iter().find(|known| **known == &bytes[first.clone()]) {
        Some(known) => header = known,
        // Some files begin with the counts.
        None if bytes.get(first.start).is_some_and(u8::is_ascii_digit) => words.at = first.start,
        None => {
            report.error(first.clone(), format!("expected `OFF`, found {}", quoted(&bytes[first])));
            return None;
        }
    }
    let second = words.at;
    if words.next(false).is_some_and(|at| bytes[at.clone()].eq_ignore_ascii_case(b"BINARY")) {
        report.error(second..words.at, "binary OFF files are not supported").help =
            Some("save the file as text".into());
        return None;
    }
    words.at = second;
    let has = |letter: u8| header.contains(&letter) && header != b"OFF";
    let (has_uvs, has_colors, has_normals) =
        (has(b'S'), header.starts_with(b"C") || header.starts_with(b"STC"), has(b'N'));
    let (vertices, at) = words.count(report, "the number of vertices")?;
    let (faces, face_at) = words.count(report, "the number of faces")?;
    words.count(report, "the number of edges")?;
    // Each vertex takes at least six bytes of the file, and each face two.
    if vertices > bytes.len() / 6 + 1 {
        report.error(at, format!("the file is too short for {vertices} vertices"));
        return None;
    }
    if faces > bytes.len() / 2 + 1 {
        report.error(face_at, format!("the file is too short for {faces} faces"));
        return None;
    }
    let mut data = MeshData::default();
    for _ in 0..vertices {
        let mut triple = |what: &str| -> Option<Vec3> {
            Some(Vec3::new(words.number(report, what)?, words.number(report, what)?, words.number(report, what)?))
        };
        data.positions.push(triple("a coordinate of a vertex")?);
        if has_normals {
            data.normals.push(triple("a component of a normal")?);
        }
        let rest = words.rest_of_line();
        let (color, uv) =
            rest.split_at(if has_colors { rest.len().saturating_sub(if has_uvs { 2 } else { 0 }) } else { 0 });
        // Some files have colours although the header does not announce them.
        let color = if color.is_empty() && !has_uvs { uv } else { color };
        if let Some(color) = color_of(color) {
            data.colors.resize(data.positions.len() - 1, [1.0; 4]);
            data.colors.push(color);
        }
        if let (true, [.., u, v]) = (has_uvs, uv) {
            data.uvs.resize(data.positions.len() - 1, Vec2::ZERO);
            data.uvs.push(Vec2::new(*u, *v));
        }
    }
    let pad = data.positions.len();
    if !data.colors.is_empty() {
        data.colors.resize(pad, [1.0; 4]);
    }
    if !data.uvs.is_empty() {
        data.uvs.resize(pad, Vec2::ZERO);
    }
    let mut triangulator = Triangulator::new(bytes.len());
    let mut corners = Vec::new();
    let mut face_colors = Vec::new();
    for face in 0..faces {
        let Some((count, at)) = words.count(report, "the number of corners of a face") else {
            // The first word after the vertices is not a count, so it may begin another vertex.
            if let Some(error) = report.last().filter(|_| face == 0 && words.at < bytes.len()) {
                error.help = Some(format!(
                    "the header announces {pad} vertices: if this line is another vertex, the number in the header is too small"
                ));
            }
            return None;
        };
        corners.clear();
        if count > bytes.len() {
            report.error(at, format!("the file is too short for a face of {count} corners"));
            return None;
        }
        for _ in 0..count {
            let (index, at) = words.count(report, "an index of a vertex")?;
            if index >= pad {
                report.error(at, format!("index {index} is out of range, because there are {pad} vertices"));
                return None;
            }
            corners.push(index as u32);
        }
        let color = color_of(&words.rest_of_line());
        let before = data.triangles.len();
        let (positions, triangles) = (&data.positions, &mut data.triangles);
        let corner = |i: usize| positions[corners[i] as usize];
        if triangulator.triangulate(corners.len(), corner, |t| triangles.push(t.map(|i| corners[i]))).is_err() {
            report.error(at, "the polygons are too large and too irregular to be split into triangles");
            return None;
        }
        if color.is_some() || !face_colors.is_empty() {
            face_colors.resize(before, [1.0; 4]);
            face_colors.resize(data.triangles.len(), color.unwrap_or([1.0; 4]));
        }
    }
    if has_normals {
        data.triangle_normals.clone_from(&data.triangles);
    }
    if !data.uvs.is_empty() {
        data.triangle_uvs.clone_from(&data.triangles);
    }
    color_faces(&mut data, &face_colors);
    Some(data)
}

/// Words of each line that is not blank, and the index of the line that has the counts.
fn rows_of(bytes: &[u8]) -> Option<(Vec<Vec<Range<usize>>>, usize)> {
    let mut rows = Vec::new();
    let mut words = Words { bytes, at: 0 };
    while let Some(first) = words.next(false) {
        let mut row = vec![first];
        while let Some(word) = words.next(true) {
            row.push(word);
        }
        rows.push(row);
    }
    let is_count = |word: &Range<usize>| bytes[word.clone()].iter().all(u8::is_ascii_digit);
    // The counts are in the first line, or in the second one after the word `OFF`.
    let is_header = |row: &Vec<Range<usize>>| row.len() == 3 && row.iter().all(is_count);
    let header = rows.iter().take(2).position(is_header)?;
    Some((rows, header))
}

/// Replaces the diagnostics of a file whose header states the number of faces before that of
/// vertices. Returns false if the header does not.
fn report_swapped_counts(bytes: &[u8], report: &mut Report, before: usize) -> bool {
    let Some((rows, header)) = rows_of(bytes) else { return false };
    let [vertices, faces] = [0, 1].map(|i| std::str::from_utf8(&bytes[rows[header][i].clone()]).unwrap_or_default());
    let mut body = rows[header + 1..].iter().map(Vec::len);
    // A vertex has three coordinates, and a face has at least three indices after their number.
    let triples = body.by_ref().take_while(|words| *words == 3).count();
    let others = rows.len() - header - 1 - triples;
    if vertices == faces || faces != triples.to_string() || vertices != others.to_string() {
        return false;
    }
    let at = rows[header][0].start..rows[header][1].end;
    report.truncate(before);
    let message = format!(
        "the header states {vertices} vertices and {faces} faces, but there are {triples} vertices and {others} faces"
    );
    let error = report.error(at, message);
    (error.code, error.help) =
        ("bad-file", Some(format!("the number of vertices comes first: write `{faces} {vertices}`")));
    true
}

/// Replaces the errors of a file that has one face per line by an error at the first face whose
/// line has fewer indices than the face announces.
fn report_short_face(bytes: &[u8], report: &mut Report, before: usize) {
    let Some((rows, header)) = rows_of(bytes) else { return };
    let text = |word: &Range<usize>| std::str::from_utf8(&bytes[word.clone()]).unwrap_or_default();
    let number = |word: &Range<usize>| text(word).parse::<usize>().ok();
    let [Some(vertices), Some(faces)] = [0, 1].map(|i| number(&rows[header][i])) else { return };
    let body = &rows[header + 1..];
    // Without one line for each vertex and face, a face can continue on the next line.
    if body.len() != vertices.saturating_add(faces) {
        return;
    }
    let is_short = |row: &&Vec<Range<usize>>| number(&row[0]).is_some_and(|count| row.len() - 1 < count);
    let Some(row) = body[vertices..].iter().find(is_short) else { return };
    let indices: Vec<&str> = row[1..].iter().map(text).collect();
    let message = format!("this face announces {} corners, but its line has {}", text(&row[0]), indices.len());
    let at = row[0].start..row[row.len() - 1].end;
    report.truncate(before);
    let error = report.error(at, message);
    let help = format!("add the missing index, or write `{} {}`", indices.len(), indices.join(" "));
    (error.code, error.help) = ("bad-file", Some(help));
}

/// Returns a colour of three or four numbers, which are from 0 to 1, or from 0 to 255.
fn color_of(numbers: &[f32]) -> Option<[f32; 4]> {
    let scale = if numbers.iter().any(|number| *number > 1.0) { 255.0 } else { 1.0 };
    match numbers {
        [r, g, b] => Some([r / scale, g / scale, b / scale, 1.0]),
        [r, g, b, a] => Some([r, g, b, a].map(|number| number / scale)),
        _ => None,
    }
}

/// Writes a mesh as text, with the positions and triangles.
fn write(mesh: &MeshData) -> Vec<u8> {
    let mut text = format!("OFF\n{} {} 0\n", mesh.positions.len(), mesh.triangles.len());
    for p in &mesh.positions {
        text += &format!("{} {} {}\n", p.x, p.y, p.z);
    }
    for [a, b, c] in &mesh.triangles {
        text += &format!("3 {a} {b} {c}\n");
    }
    text.into_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_text(text: &str) -> (Option<MeshData>, Vec<String>) {
        let mut diagnostics = Diagnostics::default();
        let mesh = read(text.as_bytes(), 0, &mut diagnostics);
        let place = |found: &durer_diag::Diagnostic| found.span.map_or(0, |span| span.start);
        (mesh, diagnostics.iter().map(|found| format!("{} {}", place(found), found.message)).collect())
    }

    #[test]
    fn polygons_colours_and_comments_are_read() {
        let (mesh, messages) = read_text(
            "COFF # a square\n4 1 0\n0 0 0 255 0 0 255\n1 0 0 0 255 0 255\n# b\n1 1 0 0 0 255 255\n0 1 0 9 9 9 255\n4 0 1 2 3 0.5 0.5 0.5\n",
        );
        let mesh = mesh.unwrap();
        assert!(messages.is_empty(), "{messages:?}");
        assert_eq!((mesh.positions.len(), &mesh.triangles[..]), (4, &[[0, 1, 2], [0, 2, 3]][..]));
        assert_eq!(mesh.colors[1], [0.0, 1.0, 0.0, 1.0]);
    }

    #[test]
    fn colours_of_faces_become_colours_of_vertices() {
        let mesh = read_text("OFF\n4 3 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n4 0 1 2 3 255 0 0\n3 0 2 3 0 0 1 0.5\n")
            .0
            .unwrap();
        assert_eq!((mesh.positions.len(), mesh.triangles.len()), (12, 4));
        let colors: Vec<[f32; 4]> = mesh.triangles.iter().map(|corners| mesh.colors[corners[1] as usize]).collect();
        let red = [1.0, 0.0, 0.0, 1.0];
        assert_eq!(colors, [[1.0; 4], red, red, [0.0, 0.0, 1.0, 0.5]]);
        assert_eq!(mesh.positions[mesh.triangles[2][2] as usize], Vec3::Y);
    }

    #[test]
    fn normals_and_coordinates_follow_the_header() {
        let text = "STNOFF\n3 1 3\n0 0 0 0 0 1 0 0\n1 0 0 0 0 1 1 0\n0 1 0 0 0 1 0 1\n3 0 1 2\n";
        let mesh = read_text(text).0.unwrap();
        assert_eq!((mesh.normals.len(), mesh.uvs[1], mesh.triangle_normals[0]), (3, Vec2::X, [0, 1, 2]));
    }

    #[test]
    fn written_meshes_are_read_back() {
        let text = "OFF\n3 1 0\n0.1 0 -1e-20\n1 0 0\n0 1 3e20\n3 0 1 2\n";
        let mesh = read_text(text).0.unwrap();
        let again = read_text(std::str::from_utf8(&write(&mesh)).unwrap()).0.unwrap();
        assert_eq!(again, mesh);
    }

    #[test]
    fn errors_have_positions() {
        let message = |text: &str| read_text(text).1.join("; ");
        assert_eq!(message("OFF\n1 1 0\n0 0 x\n"), "14 a coordinate of a vertex must be a number, found `x`");
        assert_eq!(message("OFF\n1 1 0\n0 0 0\n3 0 0 7\n"), "22 index 7 is out of range, because there are 1 vertices");
        assert_eq!(message("OFF\n9999999 1 0\n0 0 0\n"), "4 the file is too short for 9999999 vertices");
        assert!(message("OFF BINARY\n").contains("save") || message("OFF BINARY\n").contains("binary OFF"));
        assert!(message("OFF\n3 1 0\n0 0 0\n").ends_with("the file ends before a coordinate of a vertex"));
        let swapped = "OFF\n1 3 0\n0 0 0\n1 0 0\n-1 1 0\n3 0 1 2\n";
        let counts = "4 the header states 1 vertices and 3 faces, but there are 3 vertices and 1 faces";
        assert_eq!(message(swapped), counts);
        // The first faces are readable as vertices with a colour, so no error precedes this one.
        let readable = "OFF\n4 2 0\n0 0 0\n1 0 0\n3 0 1 0\n3 1 0 1\n3 0 1 0\n3 0 0 1\n";
        assert!(message(readable).starts_with("4 the header states 4 vertices and 2 faces"), "{}", message(readable));
        let short = "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n4 0 1 2\n3 0 2 1\n";
        assert_eq!(message(short), "28 this face announces 4 corners, but its line has 3");
        // A face on two lines is complete.
        assert_eq!(message("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0\n1 2\n"), "");
        let too_few = "OFF\n2 1 0\n0 0 0\n1 0 0\n-1 1 0\n3 0 1 2\n";
        assert!(!message(too_few).contains("the header states"), "{}", message(too_few));
        assert!(message("junk").contains("expected `OFF`, found `junk`"));
    }
}
