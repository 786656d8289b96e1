//! Curves with a width, which become tubes.
//!
//! Source: *OpenUSD documentation*, `UsdGeomBasisCurves`.

use super::reader::{Inherited, Reader};
use super::stage::Prim;
use durer_scene::scene::Object;
use durer_scene::shape::MeshData;
use durer_scene::shape::tessellate::tube::{Piece, add_tube, from_b_spline, sample_curve, straight, with_round_caps};
use glam::{DVec3, DVec4};
use std::sync::Arc;

/// Number of curves above which tubes have fewer sides.
const MANY: usize = 1000;

impl Reader<'_, '_> {
    /// Adds the curves of a `BasisCurves`.
    pub fn curves(&mut self, prim: &Prim, here: &Inherited, objects: &mut Vec<Object>) {
        let (files, at) = (self.stage.files, prim.span());
        let get = |name: &str| prim.get(self.stage, name);
        let Some(points) = get("points") else { return };
        let counts = get("curveVertexCounts");
        let counts = counts.as_ref().map_or(&[][..], |counts| counts.value.numbers());
        let widths = get("widths").or_else(|| get("primvars:widths"));
        let widths = widths.as_ref().map_or(&[][..], |widths| widths.value.numbers());
        let points: Vec<DVec3> =
            points.value.numbers().as_chunks::<3>().0.iter().map(|p| DVec3::from_array(*p)).collect();
        let is_linear = self.text(prim, "type").as_deref() == Some("linear");
        let basis = self.text(prim, "basis").unwrap_or_else(|| "bezier".into());
        let wrap = self.text(prim, "wrap").unwrap_or_default();
        let mut data = MeshData::default();
        // A point of a curve becomes at most 64 rings of 13 vertices.
        if !files.limits.count_bytes_or_report(points.len(), 4096, files.report, at) {
            return;
        }
        let mut first = 0_usize;
        for (i, count) in counts.iter().enumerate() {
            let count = (*count).max(0.0) as usize;
            let Some(own) = points.get(first..first.saturating_add(count)) else {
                let message = "`curveVertexCounts` needs more points than there are: the rest is left out";
                files.report.unsupported_once(at, message);
                break;
            };
            let width = |k: usize| {
                let of = match widths.len() {
                    n if n == points.len() => first + k,
                    n if n == counts.len() => i,
                    _ => 0,
                };
                widths.get(of).copied().filter(|width| *width >= 0.0).unwrap_or(1.0)
            };
            let mut p: Vec<DVec4> = own.iter().enumerate().map(|(k, p)| p.extend(width(k))).collect();
            first += count;
            if wrap == "periodic" {
                let again = if is_linear || basis == "bezier" { 1 } else { 3 };
                p.extend_from_within(..again.min(p.len()));
            }
            if wrap == "pinned" && p.len() > 1 && basis != "bezier" && !is_linear {
                p.insert(0, 2.0 * p[0] - p[1]);
                p.push(2.0 * p[p.len() - 1] - p[p.len() - 2]);
            }
            let pieces = pieces(&p, is_linear, &basis);
            let places = with_round_caps(sample_curve(&pieces, points.len()));
            if places.len() > 1 && places.iter().all(|place| place.point.is_finite()) {
                add_tube(&mut data, &places, counts.len() > MANY);
            }
        }
        if data.triangles.is_empty() {
            return;
        }
        let material = self.material_of(prim, here, at);
        let node = self.scene.add_mesh(&prim.path, Arc::new(data), at);
        self.add(node, material, here.to_world, at, objects);
    }
}

/// Splits a curve into cubic Bézier segments.
fn pieces(p: &[DVec4], is_linear: bool, basis: &str) -> Vec<Piece> {
    match (is_linear, basis) {
        (true, _) => p.windows(2).map(|pair| straight([pair[0], pair[1]])).collect(),
        (_, "bspline") => p.windows(4).map(|p| from_b_spline(&[p[0], p[1], p[2], p[3]])).collect(),
        (_, "catmullRom") => {
            let piece = |p: &[DVec4]| [p[1], p[1] + (p[2] - p[0]) / 6.0, p[2] - (p[3] - p[1]) / 6.0, p[2]];
            p.windows(4).map(piece).collect()
        }
        _ => p.windows(4).step_by(3).map(|p| [p[0], p[1], p[2], p[3]]).collect(),
    }
}
