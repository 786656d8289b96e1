//! Tessellates curves that have a width into tubes and ribbons.
//!
//! Source: *Physically Based Rendering*, 4th edition, section 6.7, and 3rd edition, section 3.7.

use super::params::Params;
use crate::shared_report::suggest;
use durer_scene::shape::MeshData;
use durer_scene::shape::tessellate::tube::{
    add_tube, elevate_degree, from_b_spline, ribbon, sample_curve, with_widths,
};
use glam::{DVec3, DVec4};

/// Maximum number of control points of a curve.
const MAX_POINTS: usize = 1 << 14;

/// Tessellates a curve. Uses fewer sides if the scene already has `many` triangles.
pub(super) fn mesh(params: &Params, reversed: bool, many: bool) -> Option<MeshData> {
    let report = params.report;
    params.mark_known(&["splitdepth"]);
    let kind = params.text("type").unwrap_or("flat");
    if !["flat", "cylinder", "ribbon"].contains(&kind) {
        let help = suggest(kind, ["flat", "cylinder", "ribbon"]);
        report.error_with_help(params.span("type"), format!("unknown type of curve `{kind}`"), help);
        return None;
    }
    let pieces = pieces(params)?;
    let width = params.float("width").unwrap_or(1.0);
    let widths = [params.float("width0").unwrap_or(width), params.float("width1").unwrap_or(width)].map(f64::from);
    if widths.iter().any(|width| *width < 0.0) {
        report.error(params.at, "the width of a curve must be 0 or more");
        return None;
    }
    let normals = params.triples("N").unwrap_or_default();
    if kind == "ribbon" && normals.len() != pieces.len() + 1 {
        let message = format!(
            "a ribbon of {} segments needs {} normals `N`, found {}",
            pieces.len(),
            pieces.len() + 1,
            normals.len()
        );
        report.error(params.span("N"), message);
        return None;
    }
    if kind == "flat" {
        report.unsupported_once(params.at, "curves of type `flat` have no counterpart: round tubes are used");
    }
    let places = sample_curve(&with_widths(&pieces, widths), pieces.len());
    if places.len() < 2 {
        return None;
    }
    let data = if kind == "ribbon" {
        let normals: Vec<DVec3> = normals.iter().map(|n| n.as_dvec3().normalize_or(DVec3::Z)).collect();
        ribbon(&places, &normals)
    } else {
        let mut data = MeshData::default();
        add_tube(&mut data, &places, many);
        data
    };
    Some(data.oriented(reversed))
}

/// Splits a curve into cubic Bézier segments.
fn pieces(params: &Params) -> Option<Vec<[DVec3; 4]>> {
    let report = params.report;
    let Some(points) = params.triples("P") else {
        report.error(params.at, "a curve needs points, `\"point3 P\"`");
        return None;
    };
    let (basis, degree) = (params.text("basis").unwrap_or("bezier"), params.integer("degree").unwrap_or(3));
    if !(degree == 2 || degree == 3) {
        report.error(params.span("degree"), "`degree` must be 2 or 3");
        return None;
    }
    let degree = degree as usize;
    let step = match basis {
        "bezier" => degree,
        "bspline" => 1,
        other => {
            let help = suggest(other, ["bezier", "bspline"]);
            report.error_with_help(params.span("basis"), format!("unknown basis `{other}`"), help);
            return None;
        }
    };
    if points.len() <= degree || !(points.len() - 1 - degree).is_multiple_of(step) {
        let message = match basis {
            "bezier" => {
                format!(
                    "a Bézier curve of degree {degree} cannot have {} points: the number minus 1 must be a multiple of \
                     {degree}",
                    points.len()
                )
            }
            _ => format!(
                "a curve of degree {degree} cannot have {} points: it needs more than {degree} points",
                points.len()
            ),
        };
        report.error(params.span("P"), message);
        return None;
    }
    if points.len() > MAX_POINTS {
        report.error(params.span("P"), format!("a curve can have at most {MAX_POINTS} points"));
        return None;
    }
    let points: Vec<DVec3> = points.iter().map(|p| p.as_dvec3()).collect();
    let piece = |p: &[DVec3]| match (basis, degree) {
        ("bezier", 3) => [p[0], p[1], p[2], p[3]],
        ("bezier", _) => elevate_degree([p[0], p[1], p[2]]),
        (_, 2) => elevate_degree([0.5 * (p[0] + p[1]), p[1], 0.5 * (p[1] + p[2])]),
        _ => from_b_spline(&[p[0], p[1], p[2], p[3]].map(|p| p.extend(0.0))).map(DVec4::truncate),
    };
    Some(points.windows(degree + 1).step_by(step).map(piece).collect())
}
