//! Findings about values of the camera that come from the command line and not from the scene file.

use super::finding::Finding;
use super::lines::is_same_span;
use super::scene_probe::SceneProbe;
use durer_diag::Span;
use durer_scene::camera::{Camera, Projection as _};
use durer_scene::math::Vec3;

/// Largest relative difference between a value and the number in the file that is due to rounding.
const ROUNDING: f32 = 1e-4;

/// A field of the camera whose value in the file is replaced by an option.
struct Replaced {
    place: Span,
    field: &'static str,
    option: &'static str,
}

/// Returns the fields of the camera whose values in the scene file are not those of the camera.
fn replaced(scene_probe: &SceneProbe) -> Vec<Replaced> {
    let (camera, block) = (scene_probe.world().camera(), scene_probe.input.scene.camera_span);
    if scene_probe.model_format().is_some() || !block.has_position() {
        return Vec::new();
    }
    let pose = camera.pose();
    let written = |field: &'static str| {
        let place = scene_probe.field_span(block, &[field])?;
        let text = scene_probe.text(place);
        let numbers: Option<Vec<f32>> = text.split_ascii_whitespace().map(|word| word.parse().ok()).collect();
        Some((place, numbers?))
    };
    let differs = |own: &[f32], actual: &[f32]| {
        let size = actual.iter().fold(1e-3, |most: f32, value| most.max(value.abs()));
        own.len() == actual.len() && own.iter().zip(actual).any(|(a, b)| (a - b).abs() > ROUNDING * size)
    };
    let turned = |own: &[f32]| {
        let [x, y, z] = own[..] else { return false };
        let (own, actual) = (Vec3::new(x, y, z).normalize_or_zero(), pose.direction.normalize_or_zero());
        own.dot(actual) < 1.0 - ROUNDING
    };
    let mut all = Vec::new();
    if let Some((place, own)) = written("center")
        && differs(&own, &pose.center.to_array())
    {
        all.push(Replaced { place, field: "center", option: "--eye" });
    }
    if let Some((place, own)) = written("direction")
        && turned(&own)
    {
        all.push(Replaced { place, field: "direction", option: "--target" });
    }
    if let (Camera::Perspective(camera), Some((place, own))) = (camera, written("angle").or_else(|| written("fov")))
        && differs(&own, &[camera.angle])
    {
        all.push(Replaced { place, field: "angle", option: "--fov" });
    }
    all
}

/// Corrects findings that would blame a value in the scene file that an option replaces.
pub(super) fn blame_options(scene_probe: &SceneProbe, findings: &mut [Finding]) {
    let all = replaced(scene_probe);
    for finding in findings {
        let diagnostic = &mut finding.diagnostic;
        for Replaced { place, field, option } in &all {
            let is_here = diagnostic.span.is_some_and(|span| is_same_span(span, *place));
            diagnostic.fix.retain(|edit| !is_same_span(edit.span, *place));
            let help = diagnostic.help.as_deref().unwrap_or_default();
            let rewritten = with_option(help, field, option);
            if !is_here && rewritten == help {
                continue;
            }
            if is_here {
                (diagnostic.span, diagnostic.label) = (None, String::new());
                diagnostic.help =
                    Some(format!("an option such as `{option}` sets this value, not the file: {rewritten}"));
            } else {
                diagnostic.help = Some(rewritten);
            }
        }
    }
}

/// Replaces a field and its value in backquotes by the option, as in `--eye 1,2,3`. The value of
/// `direction` is no point to look at, so that field keeps its word.
fn with_option(help: &str, field: &str, option: &str) -> String {
    let parts: Vec<String> = help
        .split('`')
        .map(|part| match part.strip_prefix(field).and_then(|rest| rest.strip_prefix(' ')) {
            Some(value) if field != "direction" => format!("{option} {}", value.replace(' ', ",")),
            _ => part.to_string(),
        })
        .collect();
    parts.join("`")
}

#[cfg(test)]
mod tests {
    use super::with_option;

    #[test]
    fn fields_become_options() {
        let help = "move the camera to `center 1 2 -3`, or scale it";
        assert_eq!(with_option(help, "center", "--eye"), "move the camera to `--eye 1,2,-3`, or scale it");
        assert_eq!(with_option("no center here", "center", "--eye"), "no center here");
    }
}
