//! Curves with a width: round ones as tubes, ribbons as strips, both of triangles.
//!
//! Source of meanings: *Physically Based Rendering*, 4th edition, section 6.7, and 3rd edition,
//! section 3.7.

use super::params::Params;
use crate::format::said::meant;
use crate::math::{Vec2, fp};
use crate::shape::MeshData;
use glam::DVec3;
use std::f64::consts::PI;

/// Sides of a tube, whose mean width is that of a round one, and of one of very many.
const SIDES: [u32; 2] = [12, 6];

/// Steps of a piece at least and at most, of all pieces together, and points of one curve.
const STEPS: [f64; 2] = [2.0, 64.0];
const MAX_STEPS: usize = 1 << 15;
const MAX_POINTS: usize = 1 << 14;

/// A piece of a curve: four control points of Bézier's.
type Piece = [DVec3; 4];

/// A place on a curve.
struct Place {
    point: DVec3,
    along: DVec3,
    /// From 0 at its beginning to 1 at its end.
    share: f64,
    piece: usize,
    /// From 0 to 1 in its piece.
    part: f64,
}

/// A curve, which may be one of very many.
pub(super) fn mesh(params: &Params, reversed: bool, many: bool) -> Option<MeshData> {
    let said = params.said;
    params.known(&["splitdepth"]);
    let kind = params.text("type").unwrap_or("flat");
    if !["flat", "cylinder", "ribbon"].contains(&kind) {
        let help = meant(kind, ["flat", "cylinder", "ribbon"]);
        said.bad_with(params.place("type"), format!("there is no curve of type `{kind}`"), help);
        return None;
    }
    let pieces = pieces(params)?;
    let width = params.float("width").unwrap_or(1.0);
    let widths = [params.float("width0").unwrap_or(width), params.float("width1").unwrap_or(width)].map(f64::from);
    if widths.iter().any(|width| *width < 0.0) {
        said.bad(params.at, "the width of a curve must not be less than 0");
        return None;
    }
    let normals = params.triples("N").unwrap_or_default();
    if kind == "ribbon" && normals.len() != pieces.len() + 1 {
        let message = format!(
            "a ribbon of {} pieces needs {} normals `N`, found {}",
            pieces.len(),
            pieces.len() + 1,
            normals.len()
        );
        said.bad(params.place("N"), message);
        return None;
    }
    if kind == "flat" {
        said.once(params.at, "flat curves turn to where they are seen from; here they are round");
    }
    let places = places(&pieces, widths[0].max(widths[1]));
    if places.len() < 2 {
        return None;
    }
    let width = |place: &Place| widths[0] + place.share * (widths[1] - widths[0]);
    let mut data = MeshData::default();
    if kind == "ribbon" {
        let normals: Vec<DVec3> = normals.iter().map(|n| n.as_dvec3().normalize_or(DVec3::Z)).collect();
        for place in &places {
            let normal = turned_between([normals[place.piece], normals[place.piece + 1]], place.part);
            let across = normal.cross(place.along).normalize_or(place.along.any_orthonormal_vector());
            let faced = place.along.cross(across).as_vec3();
            for (side, v) in [(-0.5, 0.0), (0.5, 1.0)] {
                data.positions.push((place.point + side * width(place) * across).as_vec3());
                data.normals.push(faced);
                data.uvs.push(Vec2::new(place.share as f32, v));
            }
        }
        strip(&mut data, places.len(), 2);
    } else {
        let sides = SIDES[usize::from(many)];
        // A polygon around the circle and one in it: half way between both.
        let corner = (PI / f64::from(sides)) / fp::sin_cos_f64(PI / f64::from(sides)).0;
        let mut across = places[0].along.any_orthonormal_vector();
        for place in &places {
            // Carried along the curve without turning about it.
            across = (across - place.along * across.dot(place.along))
                .try_normalize()
                .unwrap_or(place.along.any_orthonormal_vector());
            let other = place.along.cross(across);
            for k in 0..=sides {
                let share = f64::from(k) / f64::from(sides);
                let (sin, cos) = fp::sin_cos_degrees(360.0 * share);
                let normal = across * cos + other * sin;
                data.positions.push((place.point + 0.5 * corner * width(place) * normal).as_vec3());
                data.normals.push(normal.as_vec3());
                data.uvs.push(Vec2::new(place.share as f32, share as f32));
            }
        }
        strip(&mut data, places.len(), sides + 1);
    }
    (data.triangle_uvs, data.triangle_normals) = (data.triangles.clone(), data.triangles.clone());
    Some(super::mesh::oriented(data, reversed))
}

/// Triangles between rows of so many points each.
fn strip(data: &mut MeshData, rows: usize, count: u32) {
    for (i, j) in (1..rows as u32).flat_map(|i| (0..count - 1).map(move |j| (i - 1, j))) {
        let p = |di: u32, dj: u32| (i + di) * count + j + dj;
        data.triangles.extend([[p(0, 0), p(0, 1), p(1, 1)], [p(0, 0), p(1, 1), p(1, 0)]]);
    }
}

/// What lies between two directions, at an even pace.
fn turned_between([from, to]: [DVec3; 2], share: f64) -> DVec3 {
    let cosine = from.dot(to).clamp(-1.0, 1.0);
    let across = to - cosine * from;
    let Some(across) = across.try_normalize().filter(|_| cosine < 0.999_999) else {
        return from.lerp(to, share).normalize_or(from);
    };
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    let angle = if cosine == -1.0 { PI } else { 2.0 * fp::atan_f64(sine / (1.0 + cosine)) };
    let (sin, cos) = fp::sin_cos_f64(share * angle);
    from * cos + across * sin
}

/// The pieces of a curve, as cubic ones of Bézier's.
fn pieces(params: &Params) -> Option<Vec<Piece>> {
    let said = params.said;
    let Some(points) = params.triples("P") else {
        said.bad(params.at, "a curve needs points, `\"point3 P\"`");
        return None;
    };
    let (basis, degree) = (params.text("basis").unwrap_or("bezier"), params.whole("degree").unwrap_or(3));
    if !(degree == 2 || degree == 3) {
        said.bad(params.place("degree"), "`degree` must be 2 or 3");
        return None;
    }
    let degree = degree as usize;
    let step = match basis {
        "bezier" => degree,
        "bspline" => 1,
        other => {
            let help = meant(other, ["bezier", "bspline"]);
            said.bad_with(params.place("basis"), format!("there is no basis `{other}`"), help);
            return None;
        }
    };
    if points.len() <= degree || !(points.len() - 1 - degree).is_multiple_of(step) {
        let message = match basis {
            "bezier" => {
                format!("{} points make no curve of degree {degree}: 1 and a multiple of {degree} do", points.len())
            }
            _ => format!("{} points make no curve of degree {degree}: more than {degree} do", points.len()),
        };
        said.bad(params.place("P"), message);
        return None;
    }
    if points.len() > MAX_POINTS {
        said.bad(params.place("P"), format!("more than {MAX_POINTS} points of a curve are too many"));
        return None;
    }
    let points: Vec<DVec3> = points.iter().map(|p| p.as_dvec3()).collect();
    let piece = |p: &[DVec3]| match (basis, degree) {
        ("bezier", 3) => [p[0], p[1], p[2], p[3]],
        ("bezier", _) => raised([p[0], p[1], p[2]]),
        (_, 2) => raised([0.5 * (p[0] + p[1]), p[1], 0.5 * (p[1] + p[2])]),
        _ => [
            (p[0] + 4.0 * p[1] + p[2]) / 6.0,
            (2.0 * p[1] + p[2]) / 3.0,
            (p[1] + 2.0 * p[2]) / 3.0,
            (p[1] + 4.0 * p[2] + p[3]) / 6.0,
        ],
    };
    Some(points.windows(degree + 1).step_by(step).map(piece).collect())
}

/// A quadratic piece as a cubic one.
fn raised([a, b, c]: [DVec3; 3]) -> Piece {
    [a, a.lerp(b, 2.0 / 3.0), c.lerp(b, 2.0 / 3.0), c]
}

/// Places so near each other that straight lines between them lie within a share of the width.
fn places(pieces: &[Piece], width: f64) -> Vec<Place> {
    let mut all: Vec<Place> = Vec::new();
    let most = ((MAX_STEPS / pieces.len().max(1)) as f64).clamp(STEPS[0], STEPS[1]);
    for (i, piece) in pieces.iter().enumerate() {
        let bend = [0, 1].map(|k| (piece[k] - 2.0 * piece[k + 1] + piece[k + 2]).length());
        let steps = (6.0 * bend[0].max(bend[1]) / (8.0 * 0.02 * width.max(1e-9))).sqrt().ceil();
        let steps = if steps.is_finite() { steps.clamp(STEPS[0], most) as u32 } else { most as u32 };
        let first = if i == 0 { 0 } else { 1 };
        for k in first..=steps {
            let part = f64::from(k) / f64::from(steps);
            let [ab, bc, cd] = [0, 1, 2].map(|k| piece[k].lerp(piece[k + 1], part));
            let (abc, bcd) = (ab.lerp(bc, part), bc.lerp(cd, part));
            let chord = (piece[3] - piece[0]).normalize_or(DVec3::X);
            let along = (bcd - abc).normalize_or(chord);
            let share = (i as f64 + part) / pieces.len() as f64;
            all.push(Place { point: abc.lerp(bcd, part), along, share, piece: i, part });
        }
    }
    all
}
