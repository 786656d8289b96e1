//! Reads height fields and NURBS surfaces of pbrt-v3.
//!
//! Source: *Input File Format*, pbrt.org/fileformat-v3.

use super::params::Params;
use durer_scene::shape::MeshData;
use durer_scene::shape::tessellate::net::{self, NurbsSide};
use glam::DVec4;

/// Maximum number of control points of a surface, and maximum order of a surface.
const MAX_POINTS: i64 = 1 << 24;
const HIGHEST: i64 = 32;

/// Reads the number of points along u and along v, each of which must be at least `least`.
fn counts(params: &Params, least: i64) -> Option<[u32; 2]> {
    let counts = ["nu", "nv"].map(|name| params.integer(name).unwrap_or(0));
    if counts.iter().any(|count| *count < least) || counts[0].saturating_mul(counts[1]) > MAX_POINTS {
        let message = format!("`nu` and `nv` must be {least} or more, and their product at most {MAX_POINTS}");
        params.report.error(params.at, message);
        return None;
    }
    Some(counts.map(|count| count as u32))
}

/// Reads a height field that covers the unit square.
pub(super) fn heights(params: &Params, reversed: bool) -> Option<MeshData> {
    let [columns, rows] = counts(params, 2)?;
    let heights = params.floats("Pz").unwrap_or_default();
    if heights.len() != columns as usize * rows as usize {
        let message = format!("`Pz` has {} values, but needs one for each of {columns} x {rows} points", heights.len());
        params.report.error(params.span("Pz"), message);
        return None;
    }
    Some(net::heights([columns, rows], heights.iter().map(|height| *height as f32)).oriented(reversed))
}

/// Reads a NURBS surface.
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
        let message =
            format!("a NURBS surface needs {wanted} points, given by `P` or `Pw`, with weights of more than 0");
        params.report.error(params.at, message);
        return None;
    }
    Some(net::nurbs(&points, counts[0], &sides).oriented(reversed))
}

fn knots<'a>(params: &'a Params, names: [&'static str; 4], count: u32) -> Option<NurbsSide<'a>> {
    let order = params.integer(names[0]).unwrap_or(0);
    let all = params.floats(names[1]).unwrap_or_default();
    let rising = all.windows(2).all(|pair| pair[0] <= pair[1]);
    if !(2..=HIGHEST.min(i64::from(count))).contains(&order) || all.len() != count as usize + order as usize || !rising
    {
        let message = format!(
            "`{}` must be from 2 to the number of points, and `{}` must have ascending numbers, as many as the order \
             plus the number of points",
            names[0], names[1]
        );
        params.report.error(params.span(names[1]), message);
        return None;
    }
    let order = order as usize;
    let [first, last] = [all[order - 1], all[count as usize]];
    let end = |name, default: f64| params.float(name).map_or(default, f64::from).clamp(first, last);
    let (from, to) = (end(names[2], first), end(names[3], last));
    if from >= to {
        params.report.error(params.at, "this NURBS surface is empty, because its parameter range has no length");
        return None;
    }
    Some(NurbsSide { knots: all, order, from, to })
}
