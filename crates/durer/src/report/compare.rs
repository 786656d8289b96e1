//! Comparisons of pictures as JSON.

use durer_image::compare::Comparison;
use serde_json::{Value, json};

/// Creates the entry of a pair of pictures in the output of `durer compare --json`. `there` lists
/// the objects of the scene at each region, in the order of the regions, and can be shorter.
pub fn comparison(found: &Comparison, there: &[Value]) -> Value {
    let m = &found.measures;
    json!({
        "verdict": found.verdict.name(),
        "width": found.width,
        "height": found.height,
        "scale": found.scale.name(),
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
            "share": m.over_tolerance as f64 / (f64::from(found.width) * f64::from(found.height)) },
        "not_finite": { "reference": m.not_finite[0], "picture": m.not_finite[1], "first": m.first_not_finite },
        "findings": found.findings.iter().map(|f| json!({ "kind": f.kind, "words": f.words, "explained": f.explained }))
            .collect::<Vec<_>>(),
        "regions": found.regions.iter().enumerate().map(|(i, r)| json!({
            "x": r.x, "y": r.y, "width": r.width, "height": r.height, "pixels": r.pixels,
            "mean_difference": r.mean_difference.to_array(), "share": r.share, "worst": r.worst,
            "there": there.get(i),
        })).collect::<Vec<_>>(),
    })
}
