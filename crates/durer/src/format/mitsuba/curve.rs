//! Files of curves: each line is a point and the radius there, an empty one ends a curve.

use crate::diag::{Diagnostic, Span};
use crate::format::model::Input;
use crate::format::number::parse_f32;
use crate::format::pbrt::mesh::named_bytes;
use crate::format::said::Said;
use crate::format::tubes::{Piece, add_tube, of_spline, places, straight};
use crate::shape::MeshData;
use glam::DVec4;

/// Pieces of all curves at most, and from how many on they have fewer sides. Tests make them all.
const MAX_PIECES: usize = if cfg!(test) { 1 << 12 } else { 1 << 19 };
const MANY: usize = 1 << 12;

/// The tubes around all curves of a file, whose points are those of splines or corners.
pub(super) fn tubes(input: &Input, said: &Said, (path, at): (&str, Span), is_spline: bool) -> Option<MeshData> {
    let (bytes, file) = named_bytes(input, said, "the curves", path, at)?;
    let wrong = |start: usize, line: &[u8], message: String| {
        let span = Span { file, start: start as u32, end: (start + line.trim_ascii_end().len()) as u32 };
        said.push(Diagnostic::error(message).code("bad-file").at(span));
    };
    let (mut curves, mut points): (Vec<Vec<Piece>>, Vec<DVec4>) = (Vec::new(), Vec::new());
    let (mut start, mut count) = (0, 0);
    for line in bytes.split_inclusive(|byte| *byte == b'\n').chain([&b""[..]]) {
        let words: Vec<&[u8]> = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).collect();
        if words.is_empty() {
            let pieces: Vec<Piece> = match is_spline {
                true => points.windows(4).map(|p| of_spline(&[p[0], p[1], p[2], p[3]])).collect(),
                false => points.windows(2).map(|p| straight([p[0], p[1]])).collect(),
            };
            if pieces.is_empty() && !points.is_empty() {
                let least = if is_spline { 4 } else { 2 };
                wrong(start, line, format!("a curve of {} points: it needs {least}", points.len()));
                return None;
            }
            count += pieces.len();
            curves.push(pieces);
            points.clear();
        } else {
            let numbers: Vec<f32> = words.iter().map_while(|word| parse_f32(word).ok()).collect();
            let [x, y, z, radius] = numbers[..] else {
                wrong(start, line, "a point of a curve is four numbers: where it is, and the radius there".into());
                return None;
            };
            if words.len() > 4 || radius < 0.0 {
                wrong(start, line, "a point of a curve is three numbers, and a radius of 0 or more".into());
                return None;
            }
            points.push(DVec4::from([x, y, z, 2.0 * radius].map(f64::from)));
        }
        start += line.len();
    }
    if count > MAX_PIECES {
        said.once(at, format!("curves of more than {MAX_PIECES} pieces are left out"));
        return None;
    }
    let mut data = MeshData::default();
    curves.iter().for_each(|pieces| add_tube(&mut data, &places(pieces, count), count > MANY));
    Some(data)
}
