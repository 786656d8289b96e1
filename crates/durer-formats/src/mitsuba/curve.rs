//! Reads curve files, in which each line gives a point and its radius, and an empty line ends a
//! curve.

use crate::files::read_named;
use crate::model::ReadInput;
use crate::number::parse_f32;
use crate::shared_report::SharedReport;
use durer_diag::{Diagnostic, Span};
use durer_scene::shape::MeshData;
use durer_scene::shape::tessellate::tube::{Piece, add_tube, from_b_spline, sample_curve, straight, with_round_caps};
use glam::{DAffine3, DVec4};
use std::ops::Range;

/// Maximum total number of segments of all curves, and the number of segments above which tubes
/// have fewer sides. Tests use a low maximum so that they can reach it quickly.
const MAX_PIECES: usize = if cfg!(test) { 1 << 12 } else { 1 << 19 };
const MANY: usize = 1 << 12;

/// Builds tubes around the curves in a file, which are B-splines or polylines. `to_world` moves
/// their points, but leaves their radii.
pub(super) fn tubes(
    input: &ReadInput,
    report: &SharedReport,
    (path, at): (&str, Span),
    is_spline: bool,
    to_world: DAffine3,
) -> Option<MeshData> {
    let (bytes, file) = read_named(input, report, "the curves", path, at)?;
    let wrong = |(at, message): ParseError| {
        let span = Span { file, start: at.start as u32, end: at.end as u32 };
        report.push(Diagnostic::error(message).code("bad-file").at(span));
    };
    let mut curves = parse(&bytes, is_spline).map_err(wrong).ok()?;
    let count = curves.iter().map(Vec::len).sum();
    if count > MAX_PIECES {
        report.unsupported_once(at, format!("these curves are left out: they have more than {MAX_PIECES} segments"));
        return None;
    }
    for point in curves.iter_mut().flatten().flatten() {
        *point = to_world.transform_point3(point.truncate()).extend(point.w);
    }
    let mut data = MeshData::default();
    let is_round = !is_spline && count <= MANY;
    for pieces in &curves {
        for run in runs(pieces, is_round) {
            let mut tube = sample_curve(&pieces[run.clone()], count);
            for place in &mut tube {
                place.u = (run.start as f64 + place.u * run.len() as f64) / pieces.len() as f64;
            }
            add_tube(&mut data, &if is_round { with_round_caps(tube) } else { tube }, count > MANY);
        }
    }
    Some(data)
}

/// Splits the segments of a curve into ranges, each of which becomes one tube. Where joints are
/// rounded, a new tube starts at each sharp bend.
fn runs(pieces: &[Piece], is_round: bool) -> Vec<Range<usize>> {
    let along = |i: usize| (pieces[i][3] - pieces[i][0]).truncate().normalize_or_zero();
    let ends =
        (1..pieces.len()).filter(|&i| is_round && along(i - 1).dot(along(i)) < MIN_BEND_COSINE).chain([pieces.len()]);
    let mut start = 0;
    ends.map(|end| std::mem::replace(&mut start, end)..end).collect()
}

/// Cosine of the smallest bend angle at which a new tube starts.
const MIN_BEND_COSINE: f64 = 0.99;

/// Byte range in which an error occurred, and the error message.
type ParseError = (Range<usize>, String);

/// Parses a curve file and returns the segments of each curve.
fn parse(bytes: &[u8], is_spline: bool) -> Result<Vec<Vec<Piece>>, ParseError> {
    let (mut curves, mut points, mut start) = (Vec::new(), Vec::<DVec4>::new(), 0);
    for line in bytes.split_inclusive(|byte| *byte == b'\n').chain([&b""[..]]) {
        let place = start..start + line.trim_ascii_end().len();
        start += line.len();
        let words: Vec<&[u8]> = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).collect();
        if !words.is_empty() {
            let numbers: Vec<f32> = words.iter().map_while(|word| parse_f32(word).ok()).collect();
            match (&numbers[..], words.len()) {
                (&[x, y, z, radius], 4) if radius >= 0.0 => {
                    points.push(DVec4::from([x, y, z, 2.0 * radius].map(f64::from)));
                    continue;
                }
                _ => {
                    let message = "a point of a curve must be three numbers and a radius of 0 or more";
                    return Err((place, message.into()));
                }
            }
        }
        let pieces: Vec<Piece> = match is_spline {
            true => points.windows(4).map(|p| from_b_spline(&[p[0], p[1], p[2], p[3]])).collect(),
            false => points.windows(2).map(|p| straight([p[0], p[1]])).collect(),
        };
        if pieces.is_empty() && !points.is_empty() {
            let least = if is_spline { 4 } else { 2 };
            return Err((
                place,
                format!("the curve that ends here has {} points, but needs at least {least} points", points.len()),
            ));
        }
        curves.push(pieces);
        points.clear();
    }
    Ok(curves)
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_scene::math::random::Random;

    #[test]
    fn changed_bytes_never_panic() {
        let text = b"0 0 0 .1\n1 0 0 .1\n2 0 1e0 0.1\n3 -1 0 .1\r\n\n\n0 1 0 0\n1 1 0 .2\n2 2 2 .2\n3 1 0 2e-1";
        for is_spline in [true, false] {
            assert_eq!(parse(text, is_spline).unwrap().iter().filter(|curve| !curve.is_empty()).count(), 2);
        }
        let mut random = Random(31);
        let (mut read, mut refused) = (0, 0);
        for _ in 0..4_000 {
            let mut changed = text.to_vec();
            for _ in 0..1 + random.below(3) {
                let (at, from) = (random.below(changed.len()), random.below(changed.len()));
                match random.below(3) {
                    0 => changed[at] = changed[from],
                    1 => changed[at] = random.below(256) as u8,
                    _ => changed.truncate(at.max(1)),
                }
            }
            match parse(&changed, random.below(2) == 0) {
                Err((place, _)) => {
                    assert!(place.end <= changed.len());
                    refused += 1;
                }
                Ok(curves) => {
                    assert!(curves.iter().flatten().flatten().all(|p| p.is_finite() && p.w >= 0.0));
                    read += 1;
                }
            }
        }
        assert!(read > 200 && refused > 2_000, "{read} {refused}");
    }
}
