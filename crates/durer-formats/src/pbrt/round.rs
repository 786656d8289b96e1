//! Parts of round shapes, as triangles with smooth normals: what a line makes that turns about z.
//!
//! Source of meanings: *Physically Based Rendering*, 3rd edition, chapter 3. u goes with the turn, v
//! along the line, and the outside is du x dv.

use super::mesh::oriented;
use super::params::Params;
use durer_scene::math::{Vec2, fp};
use durer_scene::shape::MeshData;
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI};

/// Steps of a whole turn, and along a bent line.
const SIDES: f64 = 128.0;
const ROWS: u32 = 64;

/// A point of the line and the direction in which it goes on.
type Place = (DVec3, DVec3);

/// What turns about z, by so many degrees.
fn turned(degrees: f64, rows: u32, line: impl Fn(f64) -> Place) -> MeshData {
    let mut data = MeshData::default();
    let columns = (SIDES * degrees / 360.0).ceil().max(4.0) as u32;
    for i in 0..=columns {
        let u = f64::from(i) / f64::from(columns);
        let (sin, cos) = fp::sin_cos_degrees(degrees * u);
        let turn = |p: DVec3| DVec3::new(p.x * cos - p.y * sin, p.x * sin + p.y * cos, p.z);
        for j in 0..=rows {
            let v = f64::from(j) / f64::from(rows);
            let (place, onwards) = line(v);
            // On the axis the turn goes nowhere, but for what comes beside it.
            let around = DVec3::new(-place.y, place.x, 0.0).try_normalize().unwrap_or(DVec3::Y);
            data.positions.push(turn(place).as_vec3());
            data.normals.push(turn(around.cross(onwards)).normalize_or(DVec3::Z).as_vec3());
            data.uvs.push(Vec2::new(u as f32, v as f32));
        }
    }
    for (i, j) in (0..columns).flat_map(|i| (0..rows).map(move |j| (i, j))) {
        let p = |di: u32, dj: u32| (i + di) * (rows + 1) + j + dj;
        let corners = |triangle: &[u32; 3]| triangle.map(|k| data.positions[k as usize]);
        for triangle in [[p(0, 0), p(1, 0), p(1, 1)], [p(0, 0), p(1, 1), p(0, 1)]] {
            // At a pole one of the two has no area.
            let [a, b, c] = corners(&triangle);
            if a != b && b != c && c != a {
                data.triangles.push(triangle);
            }
        }
    }
    (data.triangle_uvs, data.triangle_normals) = (data.triangles.clone(), data.triangles.clone());
    data
}

/// How far around a shape goes.
pub(super) fn turn(params: &Params) -> f32 {
    let degrees = params.float("phimax").unwrap_or(360.0);
    if degrees <= 0.0 {
        params.said.bad(params.place("phimax"), "`phimax` must be more than 0 degrees");
    }
    degrees.clamp(1e-3, 360.0)
}

/// Where a shape begins and ends along z, of what is there at most.
pub(super) fn ends(params: &Params, [low, high]: [f32; 2]) -> [f32; 2] {
    let given = [params.float("zmin").unwrap_or(low), params.float("zmax").unwrap_or(high)];
    [given[0].min(given[1]), given[0].max(given[1])]
}

/// The part of a sphere between two heights.
pub(super) fn sphere(params: &Params, radius: f32, [low, high]: [f32; 2], flipped: bool) -> Option<MeshData> {
    let (low, high, radius) = (low.max(-radius), high.min(radius), f64::from(radius));
    if low >= high {
        params.said.bad(params.place("zmin"), "nothing of this sphere is between `zmin` and `zmax`");
        return None;
    }
    // Angles from the equator.
    let angle = |z: f32| {
        let sine = (f64::from(z) / radius).clamp(-1.0, 1.0);
        if sine.abs() == 1.0 { FRAC_PI_2 * sine } else { fp::atan_f64(sine / (1.0 - sine * sine).sqrt()) }
    };
    let (from, to) = (angle(low), angle(high));
    let rows = (f64::from(ROWS) * (to - from) / PI).ceil().max(2.0) as u32;
    let line = |v: f64| {
        let (sin, cos) = fp::sin_cos_degrees((from + v * (to - from)).to_degrees());
        // A pole lies on the axis, to the bit.
        let cos = if cos.abs() < 1e-12 { 0.0 } else { cos };
        (radius * DVec3::new(cos, 0.0, sin), DVec3::new(-sin, 0.0, cos))
    };
    Some(oriented(turned(f64::from(turn(params)), rows, line), flipped))
}

/// A part of a disc, or of a ring; v grows inwards.
pub(super) fn disk(params: &Params, [inner, outer]: [f32; 2], height: f32, flipped: bool) -> MeshData {
    let [inner, outer, height] = [inner, outer, height].map(f64::from);
    let line = |v: f64| (DVec3::new(outer + v * (inner - outer), 0.0, height), DVec3::NEG_X);
    oriented(turned(f64::from(turn(params)), 1, line), flipped)
}

/// A cone without its base, which is at z = 0.
pub(super) fn cone(params: &Params, flipped: bool) -> MeshData {
    let radius = f64::from(params.positive("radius").unwrap_or(1.0));
    let height = f64::from(params.positive("height").unwrap_or(1.0));
    let line = |v: f64| {
        (DVec3::new((1.0 - v) * radius, 0.0, v * height), DVec3::new(-radius, 0.0, height).normalize_or(DVec3::Z))
    };
    oriented(turned(f64::from(turn(params)), 1, line), flipped)
}

/// A bowl, as wide as its radius at the upper end.
pub(super) fn paraboloid(params: &Params, flipped: bool) -> Option<MeshData> {
    let radius = f64::from(params.positive("radius").unwrap_or(1.0));
    let [low, high] = ends(params, [0.0, 1.0]).map(f64::from);
    if low < 0.0 || low >= high {
        params.said.bad(params.at, "a paraboloid goes from `zmin`, which is not less than 0, to `zmax`");
        return None;
    }
    // Rows as far from each other along the radius, not along z: they are where it bends.
    let across = |z: f64| radius * (z / high).sqrt();
    let (from, to) = (across(low), across(high));
    let point = |r: f64| {
        let z = high * r * r / (radius * radius);
        (DVec3::new(r, 0.0, z), DVec3::new(1.0, 0.0, 2.0 * high * r / (radius * radius)).normalize_or(DVec3::X))
    };
    let mut data = turned(f64::from(turn(params)), ROWS, |share| point(from + share * (to - from)));
    for (uv, place) in data.uvs.iter_mut().zip(&data.positions) {
        uv.y = ((f64::from(place.z) - low) / (high - low)).clamp(0.0, 1.0) as f32;
    }
    Some(oriented(data, flipped))
}

/// What a straight line between two points makes.
pub(super) fn hyperboloid(params: &Params, flipped: bool) -> Option<MeshData> {
    let end = |name: &'static str, usual: DVec3| params.triple(name).map_or(usual, |p| p.as_dvec3());
    let (from, to) = (end("p1", DVec3::ZERO), end("p2", DVec3::ONE));
    if from.x * from.x + from.y * from.y + to.x * to.x + to.y * to.y == 0.0 || from == to {
        params.said.bad(params.at, "a hyperboloid needs two points, `p1` and `p2`, that are not both on z");
        return None;
    }
    let line = |v: f64| (from.lerp(to, v), (to - from).normalize_or(DVec3::Z));
    Some(oriented(turned(f64::from(turn(params)), ROWS, line), flipped))
}
