//! Surfaces over nets of points: height fields and NURBS, which only pbrt-v3 has.
//!
//! Source of meanings: *Input File Format* of pbrt-v3; Piegl and Tiller, *The NURBS Book*, 2nd
//! edition, 1997.

use super::mesh::oriented;
use super::params::Params;
use durer_scene::math::{Vec2, Vec3};
use durer_scene::shape::MeshData;
use glam::{DVec3, DVec4};

/// Steps along each side of a surface of NURBS.
const STEPS: u32 = 48;

/// Points of a net at most, and the highest order.
const MAX_POINTS: i64 = 1 << 24;
const HIGHEST: i64 = 32;

fn grid(data: &mut MeshData, [columns, rows]: [u32; 2]) {
    for (j, i) in (1..rows).flat_map(|j| (1..columns).map(move |i| (j - 1, i - 1))) {
        let p = |di: u32, dj: u32| (j + dj) * columns + i + di;
        data.triangles.extend([[p(0, 0), p(1, 0), p(1, 1)], [p(0, 0), p(1, 1), p(0, 1)]]);
    }
    data.triangle_uvs.clone_from(&data.triangles);
}

/// Points along both sides, at least so many.
fn counts(params: &Params, least: i64) -> Option<[u32; 2]> {
    let counts = ["nu", "nv"].map(|name| params.whole(name).unwrap_or(0));
    if counts.iter().any(|count| *count < least) || counts[0].saturating_mul(counts[1]) > MAX_POINTS {
        let message = format!("`nu` and `nv` must be {least} or more, and their product at most {MAX_POINTS}");
        params.said.bad(params.at, message);
        return None;
    }
    Some(counts.map(|count| count as u32))
}

/// Heights over the unit square.
pub(super) fn heights(params: &Params, reversed: bool) -> Option<MeshData> {
    let [columns, rows] = counts(params, 2)?;
    let heights = params.floats("Pz").unwrap_or_default();
    if heights.len() != columns as usize * rows as usize {
        let message = format!("`Pz` has {} values for {columns} x {rows} points", heights.len());
        params.said.bad(params.place("Pz"), message);
        return None;
    }
    let mut data = MeshData::default();
    for (k, height) in (0_u32..).zip(heights) {
        let place = Vec2::new((k % columns) as f32 / (columns - 1) as f32, (k / columns) as f32 / (rows - 1) as f32);
        data.positions.push(place.extend(*height as f32));
        data.uvs.push(place);
    }
    grid(&mut data, [columns, rows]);
    Some(oriented(data, reversed))
}

/// The knots of one side, and what of them is shown.
struct Knots<'a> {
    all: &'a [f64],
    order: usize,
    from: f64,
    to: f64,
}

/// A surface of NURBS.
pub(super) fn nurbs(params: &Params, reversed: bool) -> Option<MeshData> {
    let counts = counts(params, 2)?;
    let sides = [
        knots(params, ["uorder", "uknots", "u0", "u1"], counts[0])?,
        knots(params, ["vorder", "vknots", "v0", "v1"], counts[1])?,
    ];
    let points: Vec<DVec4> = match (params.floats("Pw"), params.triples("P")) {
        (Some(all), _) => all.chunks_exact(4).map(|p| DVec4::new(p[0], p[1], p[2], p[3])).collect(),
        (None, all) => all.unwrap_or_default().iter().map(|p| p.as_dvec3().extend(1.0)).collect(),
    };
    let wanted = counts[0] as usize * counts[1] as usize;
    if points.len() != wanted || points.iter().any(|p| p.w <= 0.0) {
        let message = format!("a surface of NURBS needs {wanted} points, `P` or `Pw`, of weights above 0");
        params.said.bad(params.at, message);
        return None;
    }
    let side = STEPS + 1;
    let mut data = MeshData::default();
    for (j, i) in (0..side).flat_map(|j| (0..side).map(move |i| (j, i))) {
        let at = [i, j].map(|k| f64::from(k) / f64::from(STEPS));
        let (point, normal) = place(&points, counts, &sides, at);
        data.positions.push(point.as_vec3());
        data.normals.push(normal.try_normalize().map_or(Vec3::Z, |n| n.as_vec3()));
        data.uvs.push(Vec2::new(at[0] as f32, at[1] as f32));
    }
    grid(&mut data, [side; 2]);
    data.triangle_normals.clone_from(&data.triangles);
    Some(oriented(data, reversed))
}

fn knots<'a>(params: &'a Params, names: [&'static str; 4], count: u32) -> Option<Knots<'a>> {
    let order = params.whole(names[0]).unwrap_or(0);
    let all = params.floats(names[1]).unwrap_or_default();
    let rising = all.windows(2).all(|pair| pair[0] <= pair[1]);
    if !(2..=HIGHEST.min(i64::from(count))).contains(&order) || all.len() != count as usize + order as usize || !rising
    {
        let message = format!(
            "`{}` must be from 2 to the number of points, and `{}` as many rising numbers as both together",
            names[0], names[1]
        );
        params.said.bad(params.place(names[1]), message);
        return None;
    }
    let order = order as usize;
    let [first, last] = [all[order - 1], all[count as usize]];
    let end = |name, usual: f64| params.float(name).map_or(usual, f64::from).clamp(first, last);
    let (from, to) = (end(names[2], first), end(names[3], last));
    if from >= to {
        params.said.bad(params.at, "nothing of this surface of NURBS is shown: its knots do not rise");
        return None;
    }
    Some(Knots { all, order, from, to })
}

/// The weights of points and of their derivatives, from the first that counts.
fn weights(knots: &Knots, t: f64) -> (usize, Vec<f64>, Vec<f64>) {
    let (all, degree) = (knots.all, knots.order - 1);
    let last = all.len() - knots.order - 1;
    let span = (all.partition_point(|knot| *knot <= t).max(1) - 1).clamp(degree, last);
    let mut values = vec![1.0];
    let mut slopes = vec![0.0];
    for d in 1..=degree {
        let mut next = vec![0.0; d + 1];
        let mut inclines = vec![0.0; d + 1];
        for (r, value) in values.iter().enumerate() {
            let (low, high) = (all[span + 1 + r - d], all[span + 1 + r]);
            let width = high - low;
            if width > 0.0 {
                next[r] += value * (high - t) / width;
                next[r + 1] += value * (t - low) / width;
                inclines[r] -= d as f64 * value / width;
                inclines[r + 1] += d as f64 * value / width;
            }
        }
        (values, slopes) = (next, inclines);
    }
    (span - degree, values, slopes)
}

/// The point of a surface and the cross product of its tangents.
fn place(points: &[DVec4], [columns, _]: [u32; 2], sides: &[Knots; 2], at: [f64; 2]) -> (DVec3, DVec3) {
    let t = |side: usize| sides[side].from + at[side] * (sides[side].to - sides[side].from);
    let (first_u, us, us_slope) = weights(&sides[0], t(0));
    let (first_v, vs, vs_slope) = weights(&sides[1], t(1));
    let sum = |us: &[f64], vs: &[f64]| {
        let mut sum = DVec4::ZERO;
        for (j, v) in vs.iter().enumerate() {
            for (i, u) in us.iter().enumerate() {
                sum += u * v * points[(first_v + j) * columns as usize + first_u + i];
            }
        }
        sum
    };
    let (whole, du, dv) = (sum(&us, &vs), sum(&us_slope, &vs), sum(&us, &vs_slope));
    let point = whole.truncate() / whole.w;
    let slope = |d: DVec4| (d.truncate() - d.w * point) / whole.w;
    (point, slope(du).cross(slope(dv)))
}
