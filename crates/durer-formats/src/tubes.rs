//! Tubes around curves, of triangles: hair and the like.

use durer_scene::math::{Vec2, fp};
use durer_scene::shape::MeshData;
use glam::{DVec3, DVec4};
use std::f64::consts::PI;

/// Sides of a tube, whose mean width is that of a round one, and of one of very many.
const SIDES: [u32; 2] = [12, 6];

/// Steps of a half of a ball from its rim to its middle.
const CAP: u32 = 4;

/// Steps of a piece at least and at most, and of all pieces together.
const STEPS: [f64; 2] = [2.0, 64.0];
const MAX_STEPS: usize = 1 << 15;

/// A piece of a curve: four control points of Bézier's, with the curve's width.
pub(super) type Piece = [DVec4; 4];

/// A place on a curve.
pub(super) struct Place {
    pub point: DVec3,
    pub along: DVec3,
    pub width: f64,
    /// The sine of the angle by which normals lean along it.
    pub lean: f64,
    /// From 0 at its beginning to 1 at its end.
    pub share: f64,
    pub piece: usize,
    /// From 0 to 1 in its piece.
    pub part: f64,
}

/// A cubic piece of a uniform B-spline.
pub(super) fn of_spline(p: &[DVec4; 4]) -> Piece {
    [
        (p[0] + 4.0 * p[1] + p[2]) / 6.0,
        (2.0 * p[1] + p[2]) / 3.0,
        (p[1] + 2.0 * p[2]) / 3.0,
        (p[1] + 4.0 * p[2] + p[3]) / 6.0,
    ]
}

/// A straight piece.
pub(super) fn straight([a, b]: [DVec4; 2]) -> Piece {
    [a, a.lerp(b, 1.0 / 3.0), a.lerp(b, 2.0 / 3.0), b]
}

/// Places of a curve so near each other that straight lines between them lie within a share of the
/// width; of very many pieces in all fewer.
pub(super) fn places(pieces: &[Piece], all_pieces: usize) -> Vec<Place> {
    let mut all: Vec<Place> = Vec::new();
    let width = pieces.iter().flatten().map(|p| p.w).fold(0.0, f64::max);
    let most = ((MAX_STEPS / all_pieces.max(1)) as f64).clamp(STEPS[0], STEPS[1]);
    for (i, piece) in pieces.iter().enumerate() {
        let p = piece.map(|p| p.truncate());
        let bend = [0, 1].map(|k| (p[k] - 2.0 * p[k + 1] + p[k + 2]).length());
        let steps = (6.0 * bend[0].max(bend[1]) / (8.0 * 0.02 * width.max(1e-9))).sqrt().ceil();
        let steps = if steps.is_finite() { steps.clamp(STEPS[0], most) as u32 } else { most as u32 };
        let first = if i == 0 { 0 } else { 1 };
        for k in first..=steps {
            let part = f64::from(k) / f64::from(steps);
            let [ab, bc, cd] = [0, 1, 2].map(|k| piece[k].lerp(piece[k + 1], part));
            let (abc, bcd) = (ab.lerp(bc, part), bc.lerp(cd, part));
            let (point, chord) = (abc.lerp(bcd, part), (p[3] - p[0]).normalize_or(DVec3::X));
            let along = (bcd - abc).truncate().normalize_or(chord);
            let share = (i as f64 + part) / pieces.len() as f64;
            all.push(Place { point: point.truncate(), along, width: point.w, lean: 0.0, share, piece: i, part });
        }
    }
    all
}

/// The same with a half of a ball on either end.
pub(super) fn rounded(mut places: Vec<Place>) -> Vec<Place> {
    let cap = |end: &Place, side: f64, step: u32| {
        let (sin, cos) = fp::sin_cos_degrees(f64::from(90 * step) / f64::from(CAP));
        let lean = side * sin;
        Place { point: end.point + 0.5 * lean * end.width * end.along, width: cos * end.width, lean, ..*end }
    };
    let (Some(first), Some(last)) = (places.first(), places.last()) else { return places };
    let before: Vec<Place> = (1..=CAP).rev().map(|step| cap(first, -1.0, step)).collect();
    let after: Vec<Place> = (1..=CAP).map(|step| cap(last, 1.0, step)).collect();
    places.splice(0..0, before);
    places.extend(after);
    places
}

/// Adds a tube through places, which may be one of very many: u grows along it, v around it.
pub(super) fn add_tube(data: &mut MeshData, places: &[Place], many: bool) {
    let Some(first) = places.first() else { return };
    let sides = SIDES[usize::from(many)];
    // A polygon around the circle and one in it: half way between both.
    let corner = (PI / f64::from(sides)) / fp::sin_cos_f64(PI / f64::from(sides)).0;
    // Shares of a turn, their sines and cosines.
    let circle: Vec<(f64, (f64, f64))> = (0..=sides)
        .map(|k| f64::from(k) / f64::from(sides))
        .map(|share| (share, fp::sin_cos_degrees(360.0 * share)))
        .collect();
    let mut across = first.along.any_orthonormal_vector();
    let begin = data.positions.len() as u32;
    for place in places {
        // Carried along the curve without turning about it.
        across = (across - place.along * across.dot(place.along))
            .try_normalize()
            .unwrap_or(place.along.any_orthonormal_vector());
        let other = place.along.cross(across);
        for &(share, (sin, cos)) in &circle {
            let around = across * cos + other * sin;
            let upright = (1.0 - place.lean * place.lean).max(0.0).sqrt();
            data.positions.push((place.point + 0.5 * corner * place.width * around).as_vec3());
            data.normals.push((upright * around + place.lean * place.along).as_vec3());
            data.uvs.push(Vec2::new(place.share as f32, share as f32));
        }
    }
    add_strip(data, begin, places.len(), sides + 1);
}

/// Adds triangles between rows of so many points each.
pub(super) fn add_strip(data: &mut MeshData, begin: u32, rows: usize, count: u32) {
    let first = data.triangles.len();
    for (i, j) in (1..rows as u32).flat_map(|i| (0..count - 1).map(move |j| (i - 1, j))) {
        let p = |di: u32, dj: u32| begin + (i + di) * count + j + dj;
        data.triangles.extend([[p(0, 0), p(0, 1), p(1, 1)], [p(0, 0), p(1, 1), p(1, 0)]]);
    }
    let MeshData { triangles, triangle_uvs, triangle_normals, .. } = data;
    triangle_uvs.extend(&triangles[first..]);
    triangle_normals.extend(&triangles[first..]);
}
