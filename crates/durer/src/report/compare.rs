//! Conversion of picture comparisons to JSON.

use durer_image::compare::Comparison;
use serde_json::{Value, json};

/// Returns the entry of a pair of pictures in the output of `durer compare --json`. `there` lists
/// the objects of the scene in each region. Its entries are in the order of the regions, and it can
/// have fewer entries than there are regions.
pub fn comparison(comparison: &Comparison, there: &[Value]) -> Value {
    let m = &comparison.measures;
    json!({
        "verdict": comparison.verdict.name(),
        "width": comparison.width,
        "height": comparison.height,
        "scale": comparison.scale.name(),
        "rmse": m.rmse,
        "psnr": m.psnr.is_finite().then_some(m.psnr),
        "ssim": m.ssim,
        "flip": m.flip,
        "hdr_flip": m.hdr_flip,
        "largest": m.largest.map(|l| json!({
            "difference": l.difference, "x": l.x, "y": l.y,
            "reference": l.reference.to_array(), "picture": l.test.to_array(),
        })),
        "over_tolerance": { "pixels": m.over_tolerance,
            "share": m.over_tolerance as f64 / (f64::from(comparison.width) * f64::from(comparison.height)) },
        "not_finite": { "reference": m.not_finite[0], "picture": m.not_finite[1], "first": m.first_not_finite },
        "findings": comparison.findings.iter().map(|f| json!({ "kind": f.kind, "words": f.description, "explained": f.explained }))
            .collect::<Vec<_>>(),
        "regions": comparison.regions.iter().enumerate().map(|(i, r)| json!({
            "x": r.x, "y": r.y, "width": r.width, "height": r.height, "pixels": r.pixels,
            "mean_difference": r.mean_difference.to_array(), "share": r.share, "worst": r.worst,
            "there": there.get(i),
        })).collect::<Vec<_>>(),
    })
}
