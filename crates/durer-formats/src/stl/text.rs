//! Reader of text STL files, which begin with `solid`. Each triangle consists of `facet normal x y
//! z`, `outer loop`, three lines `vertex x y z`, `endloop`, and `endfacet`.

use super::Builder;
use crate::number::{parse_f32, report_number};
use crate::report::{Report, quoted};
use durer_scene::math::Vec3;
use std::ops::Range;

/// Reads the facets of a text STL file. Only the vertices are used, but the other words are checked
/// for mistakes.
pub fn read(bytes: &[u8], mesh: &mut Builder, report: &mut Report) {
    let mut corners: Vec<Vec3> = Vec::with_capacity(3);
    let mut facet: Option<Range<usize>> = None;
    let mut open = OpenBlocks::default();
    for line in lines(bytes) {
        let mut words = words(bytes, line.clone());
        let Some(first) = words.next() else { continue };
        let word = bytes[first.clone()].to_ascii_lowercase();
        match word.as_slice() {
            // The rest of the line is a name and is skipped.
            b"solid" | b"\xef\xbb\xbfsolid" => open.solid = Some(first),
            b"endsolid" => open = OpenBlocks::default(),
            b"outer" => {}
            b"facet" => {
                unfinished(&mut corners, facet.take(), report);
                open.facet = Some(first.clone());
                facet = Some(first);
            }
            b"vertex" => corners.extend(vertex(bytes, first, words, report)),
            b"endloop" | b"endfacet" => {
                if let [a, b, c] = corners[..] {
                    mesh.facet([a, b, c]);
                    corners.clear();
                    facet = None;
                }
                if word == b"endfacet" {
                    open.facet = None;
                    unfinished(&mut corners, facet.take(), report);
                }
            }
            _ => {
                let message = format!(
                    "expected `facet`, `vertex` or another STL keyword, found {}",
                    quoted(&bytes[first.clone()])
                );
                report.error(first, message);
            }
        }
        if report.is_full() {
            return;
        }
    }
    // A facet with all of its vertices is missing only its end.
    if corners.len() != 3 {
        unfinished(&mut corners, facet, report);
    }
    open.report(report);
}

/// Keywords of the blocks that have not been closed.
#[derive(Default)]
struct OpenBlocks {
    solid: Option<Range<usize>>,
    facet: Option<Range<usize>>,
}

impl OpenBlocks {
    /// Reports that the file ends inside a block, unless there are other errors.
    fn report(self, report: &mut Report) {
        if report.has_errors() {
            return;
        }
        if let Some(facet) = self.facet {
            report.error(facet, "the file ends inside this facet, because `endfacet` is missing").help =
                Some("export or copy the mesh again: the file is incomplete".into());
        } else if let Some(solid) = self.solid {
            report.warning(solid, "the file ends without `endsolid`, so facets may be missing");
        }
    }
}

/// Reports a facet that does not have exactly three vertices.
fn unfinished(corners: &mut Vec<Vec3>, facet: Option<Range<usize>>, report: &mut Report) {
    // An invalid number has already been reported.
    if let Some(at) = facet.filter(|_| !report.has_errors()) {
        report.error(at, format!("a facet needs 3 vertices, found {}", corners.len()));
    }
    corners.clear();
}

fn vertex(
    bytes: &[u8],
    keyword: Range<usize>,
    words: impl Iterator<Item = Range<usize>>,
    report: &mut Report,
) -> Option<Vec3> {
    let (mut values, mut count, mut end) = ([0.0; 3], 0, keyword.end);
    for word in words {
        end = word.end;
        match parse_f32(&bytes[word.clone()]) {
            Ok(value) if count < 3 => values[count] = value,
            Ok(_) => {}
            Err(error) => {
                report_number(report, error, word.clone(), &bytes[word]);
                return None;
            }
        }
        count += 1;
    }
    if count != 3 {
        report.error(keyword.start..end, format!("`vertex` needs 3 numbers, found {count}"));
        return None;
    }
    Some(values.into())
}

fn lines(bytes: &[u8]) -> impl Iterator<Item = Range<usize>> {
    let mut at = 0;
    bytes.split(|&byte| byte == b'\n' || byte == b'\r').map(move |line| {
        let range = at..at + line.len();
        at = range.end + 1;
        range
    })
}

fn words(bytes: &[u8], line: Range<usize>) -> impl Iterator<Item = Range<usize>> {
    let mut at = line.start;
    bytes[line].split(|byte| byte.is_ascii_whitespace()).filter_map(move |word| {
        let range = at..at + word.len();
        at = range.end + 1;
        (!range.is_empty()).then_some(range)
    })
}
