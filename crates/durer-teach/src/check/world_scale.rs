//! Explains findings about the camera of a pbrt file by a scale that only the objects have.

use super::finding::Finding;
use super::lines::lines;
use super::scene_probe::SceneProbe;
use durer_diag::{Severity, Span};

/// Codes of findings that such a scale can cause.
const CODES: [&str; 6] = ["camera-inside", "camera-away", "too-small", "too-narrow", "all-missed", "out-of-scale"];
/// Factor above which, or below whose inverse, a scale can be the cause.
const MIN_FACTOR: f32 = 8.0;

/// Places findings about the camera at a `Scale` after `WorldBegin` that scales all objects.
pub(super) fn blame_world_scale(scene_probe: &SceneProbe, findings: &mut [Finding]) {
    if scene_probe.model_format().is_none_or(|format| format.name != "pbrt") {
        return;
    }
    let Some((place, factor)) = world_scale(scene_probe) else { return };
    let is_effect = |finding: &&mut Finding| {
        let code = finding.diagnostic.code;
        CODES.contains(&code) && finding.diagnostic.severity > Severity::Note
    };
    for finding in findings.iter_mut().filter(is_effect) {
        let old = finding.diagnostic.span.replace(place);
        finding.diagnostic.label = "scales all objects, but not the camera".into();
        if let (Some(camera), None) = (old, &finding.diagnostic.related) {
            finding.diagnostic.related = Some((camera, "the camera".into()));
        }
        finding.diagnostic.help = Some(format!(
            "the objects are scaled by {}, but the camera before `WorldBegin` is not: move the camera too, or remove \
             the scale",
            super::finding::number(factor)
        ));
    }
}

/// Returns the span and the factor of the first `Scale` between `WorldBegin` and the first shape or
/// scope.
fn world_scale(scene_probe: &SceneProbe) -> Option<(Span, f32)> {
    let bytes = scene_probe.input.files.bytes(0)?;
    let mut in_world = false;
    for (span, line) in lines(bytes, 0) {
        let text = String::from_utf8_lossy(line);
        let mut words = text.split_ascii_whitespace();
        match words.next() {
            Some("WorldBegin") => in_world = true,
            Some("Scale") if in_world => {
                let factor = words.filter_map(|word| word.parse::<f32>().ok()).next()?;
                let is_large = factor.abs() > MIN_FACTOR || factor.abs() < 1.0 / MIN_FACTOR;
                return is_large.then_some((span, factor));
            }
            Some("AttributeBegin" | "Shape" | "ObjectBegin" | "TransformBegin") if in_world => return None,
            _ => {}
        }
    }
    None
}
