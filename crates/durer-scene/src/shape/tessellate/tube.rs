//! Creates tubes and ribbons from curves that have a width.

use crate::math::{Vec2, fp};
use crate::shape::MeshData;
use glam::{DVec3, DVec4};
use std::f64::consts::PI;

/// Number of sides of a tube, for a few tubes and for many tubes. The mean width of a tube with
/// this many sides is that of a round tube.
const SIDES: [u32; 2] = [24, 6];

/// Number of segments of a hemisphere from its rim to its pole.
const CAP: u32 = 4;

/// Minimum and maximum number of steps in a segment, and maximum number of steps in all segments
/// together.
const STEPS: [f64; 2] = [2.0, 64.0];
const MAX_STEPS: usize = 1 << 15;

/// Cubic Bézier segment of a curve, given by four control points. The w component is the width of
/// the curve.
pub type Piece = [DVec4; 4];

/// Point sampled on a curve, with the data for sweeping a cross-section along the curve.
pub struct CurvePoint {
    /// The point.
    pub point: DVec3,
    /// Unit tangent.
    pub along: DVec3,
    /// Width of the curve at the point.
    pub width: f64,
    /// Sine of the angle between the cross-section and the surface normals.
    pub lean: f64,
    /// Position along the curve, from 0 at its start to 1 at its end.
    pub u: f64,
    /// Index of the segment that contains the point.
    pub segment: usize,
    /// Position within the segment, from 0 to 1.
    pub t: f64,
}

/// Converts four control points of a uniform cubic B-spline to a Bézier segment.
pub fn from_b_spline(p: &[DVec4; 4]) -> Piece {
    [
        (p[0] + 4.0 * p[1] + p[2]) / 6.0,
        (2.0 * p[1] + p[2]) / 3.0,
        (p[1] + 2.0 * p[2]) / 3.0,
        (p[1] + 4.0 * p[2] + p[3]) / 6.0,
    ]
}

/// Creates a straight segment.
pub fn straight([a, b]: [DVec4; 2]) -> Piece {
    [a, a.lerp(b, 1.0 / 3.0), a.lerp(b, 2.0 / 3.0), b]
}

/// Samples a curve so that the chords deviate from it by at most a fiftieth of its width. The steps
/// are coarser if `all_pieces`, the number of segments in all curves together, is very large.
pub fn sample_curve(pieces: &[Piece], all_pieces: usize) -> Vec<CurvePoint> {
    let mut all: Vec<CurvePoint> = Vec::new();
    let width = pieces.iter().flatten().map(|p| p.w).fold(0.0, f64::max);
    let most = ((MAX_STEPS / all_pieces.max(1)) as f64).clamp(STEPS[0], STEPS[1]);
    for (i, piece) in pieces.iter().enumerate() {
        let p = piece.map(|p| p.truncate());
        let bend = [0, 1].map(|k| (p[k] - 2.0 * p[k + 1] + p[k + 2]).length());
        let steps = (6.0 * bend[0].max(bend[1]) / (8.0 * 0.02 * width.max(1e-9))).sqrt().ceil();
        let steps = if steps.is_finite() { steps.clamp(STEPS[0], most) as u32 } else { most as u32 };
        let first = if i == 0 { 0 } else { 1 };
        for k in first..=steps {
            let t = f64::from(k) / f64::from(steps);
            let [ab, bc, cd] = [0, 1, 2].map(|k| piece[k].lerp(piece[k + 1], t));
            let (abc, bcd) = (ab.lerp(bc, t), bc.lerp(cd, t));
            let (point, chord) = (abc.lerp(bcd, t), (p[3] - p[0]).normalize_or(DVec3::X));
            let along = (bcd - abc).truncate().normalize_or(chord);
            let u = (i as f64 + t) / pieces.len() as f64;
            // The radius grows by this much per unit of length.
            let slope = 0.5 * (bcd - abc).w / (bcd - abc).truncate().length();
            let lean = if slope.is_finite() { -slope / (1.0 + slope * slope).sqrt() } else { 0.0 };
            all.push(CurvePoint { point: point.truncate(), along, width: point.w, lean, u, segment: i, t });
        }
    }
    all
}

/// Adds a hemisphere at each end of the curve.
pub fn with_round_caps(mut places: Vec<CurvePoint>) -> Vec<CurvePoint> {
    let cap = |end: &CurvePoint, side: f64, step: u32| {
        let (sin, cos) = fp::sin_cos_degrees(f64::from(90 * step) / f64::from(CAP));
        let lean = side * sin;
        CurvePoint { point: end.point + 0.5 * lean * end.width * end.along, width: cos * end.width, lean, ..*end }
    };
    let (Some(first), Some(last)) = (places.first(), places.last()) else { return places };
    let before: Vec<CurvePoint> = (1..=CAP).rev().map(|step| cap(first, -1.0, step)).collect();
    let after: Vec<CurvePoint> = (1..=CAP).map(|step| cap(last, 1.0, step)).collect();
    places.splice(0..0, before);
    places.extend(after);
    places
}

/// Adds a tube through sample points, which has fewer sides if there are `many` tubes. u increases
/// along the tube, and v increases around it.
pub fn add_tube(data: &mut MeshData, places: &[CurvePoint], many: bool) {
    let Some(first) = places.first() else { return };
    let sides = SIDES[usize::from(many)];
    // A polygon is as wide on average over all directions as a circle of the same circumference.
    let corner = (PI / f64::from(sides)) / fp::sin_cos_f64(PI / f64::from(sides)).0;
    // Each entry of `circle` is a fraction of a turn, with its sine and cosine.
    let circle: Vec<(f64, (f64, f64))> = (0..=sides)
        .map(|k| f64::from(k) / f64::from(sides))
        .map(|share| (share, fp::sin_cos_degrees(360.0 * share)))
        .collect();
    let mut across = first.along.any_orthonormal_vector();
    let begin = data.positions.len() as u32;
    for place in places {
        // Transport the frame along the curve without twisting it.
        across = (across - place.along * across.dot(place.along))
            .try_normalize()
            .unwrap_or(place.along.any_orthonormal_vector());
        let other = place.along.cross(across);
        for &(share, (sin, cos)) in &circle {
            let around = across * cos + other * sin;
            let upright = (1.0 - place.lean * place.lean).max(0.0).sqrt();
            data.positions.push((place.point + 0.5 * corner * place.width * around).as_vec3());
            data.normals.push((upright * around + place.lean * place.along).as_vec3());
            data.uvs.push(Vec2::new(place.u as f32, share as f32));
        }
    }
    add_strip(data, begin, places.len(), sides + 1);
}

/// Adds triangles between neighbouring rows, each of which has `count` points.
fn add_strip(data: &mut MeshData, begin: u32, rows: usize, count: u32) {
    let first = data.triangles.len();
    for (i, j) in (1..rows as u32).flat_map(|i| (0..count - 1).map(move |j| (i - 1, j))) {
        let p = |di: u32, dj: u32| begin + (i + di) * count + j + dj;
        data.triangles.extend([[p(0, 0), p(0, 1), p(1, 1)], [p(0, 0), p(1, 1), p(1, 0)]]);
    }
    let MeshData { triangles, triangle_uvs, triangle_normals, .. } = data;
    triangle_uvs.extend(&triangles[first..]);
    triangle_normals.extend(&triangles[first..]);
}

/// Tessellates a ribbon through sample points. The ribbon turns from each normal to the next. There
/// is one more normal than there are segments. u increases along the ribbon, and v increases across
/// it.
pub fn ribbon(places: &[CurvePoint], normals: &[DVec3]) -> MeshData {
    let mut data = MeshData::default();
    for place in places {
        let normal = slerp([normals[place.segment], normals[place.segment + 1]], place.t);
        let across = normal.cross(place.along).normalize_or(place.along.any_orthonormal_vector());
        let faced = place.along.cross(across).as_vec3();
        for (side, v) in [(-0.5, 0.0), (0.5, 1.0)] {
            data.positions.push((place.point + side * place.width * across).as_vec3());
            data.normals.push(faced);
            data.uvs.push(Vec2::new(place.u as f32, v));
        }
    }
    add_strip(&mut data, 0, places.len(), 2);
    data
}

/// Interpolates unit vectors by spherical linear interpolation.
fn slerp([from, to]: [DVec3; 2], share: f64) -> DVec3 {
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

/// Raises the degree of a quadratic Bézier segment, which gives a cubic one.
pub fn elevate_degree([a, b, c]: [DVec3; 3]) -> [DVec3; 4] {
    [a, a.lerp(b, 2.0 / 3.0), c.lerp(b, 2.0 / 3.0), c]
}

/// Creates the segments of a curve whose width changes linearly from one end to the other.
pub fn with_widths(pieces: &[[DVec3; 4]], [first, last]: [f64; 2]) -> Vec<Piece> {
    let width = |i: usize, k: u32| first + (i as f64 + f64::from(k) / 3.0) / pieces.len() as f64 * (last - first);
    let wide = |(i, piece): (usize, &[DVec3; 4])| [0, 1, 2, 3].map(|k| piece[k as usize].extend(width(i, k)));
    pieces.iter().enumerate().map(wide).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Builds the tube of a straight fibre from z = 0 to z = 3, with a width at each end.
    fn fibre([from, to]: [f64; 2], many: bool) -> MeshData {
        let mut data = MeshData::default();
        let line = straight([DVec4::new(0.0, 0.0, 0.0, from), DVec4::new(0.0, 0.0, 3.0, to)]);
        add_tube(&mut data, &sample_curve(&[line], 1), many);
        data
    }

    #[test]
    fn a_fibre_covers_the_area_of_a_round_one() {
        // A fibre of length 3 and width 0.2 covers 0.6 seen from the side.
        for (many, worst) in [(false, 0.006), (true, 0.1)] {
            let data = fibre([0.2, 0.2], many);
            let widths: Vec<f64> = (0..720)
                .map(|k| {
                    let (sin, cos) = fp::sin_cos_degrees(0.5 * f64::from(k));
                    let side = |p: &glam::Vec3| cos * f64::from(p.x) + sin * f64::from(p.y);
                    let (low, high) = data
                        .positions
                        .iter()
                        .map(side)
                        .fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(x), high.max(x)));
                    high - low
                })
                .collect();
            let area = 3.0 * widths.iter().sum::<f64>() / widths.len() as f64;
            assert!((area - 0.6).abs() < 1e-4 * 0.6, "{area}");
            assert!(widths.iter().all(|width| (width / 0.2 - 1.0).abs() < worst), "{widths:?}");
        }
    }

    #[test]
    fn normals_of_a_tapered_fibre_are_those_of_a_cone() {
        // The radius falls from 0.4 to 0.1 over a length of 3.
        let length = (3.0_f64 * 3.0 + 0.3 * 0.3).sqrt();
        let data = fibre([0.8, 0.2], false);
        assert!(data.normals.iter().all(|n| (f64::from(n.z) - 0.3 / length).abs() < 1e-6));
        assert!(data.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-6));
    }
}
