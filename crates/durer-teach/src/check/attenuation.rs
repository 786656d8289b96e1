//! Checks lights with attenuation: how much light arrives, and whether the divisor is positive.

use super::finding::{Finding, number, vector};
use super::lights::{description, for_each_verdict, no_contribution, none_contributes, span};
use super::scene_probe::SceneProbe;
use super::shapes::point;
use super::verdict::{LightVerdict, attenuation};
use durer_diag::{Diagnostic, Span};
use durer_scene::dialect::Dialect;
use durer_scene::light::{Illuminate as _, PHOTOMETRIC_FIELDS};
use durer_scene::math::Vec3;

/// Reports lights whose light is too weak when it arrives at the visible surfaces.
pub(super) fn faint(scene_probe: &SceneProbe) -> Vec<Finding> {
    if scene_probe.is_physical() && !scene_probe.is_dark() {
        return super::overwhelmed::faint(scene_probe);
    }
    for_each_verdict(scene_probe, |light, verdict| {
        let LightVerdict::Faint(most) = verdict else { return None };
        let message = match description(scene_probe, light)?.value.position() {
            None => format!("this light contributes at most {}", number(most)),
            Some(_) => format!("this light fades to {} before it arrives", number(most)),
        };
        let (diagnostic, span) = no_contribution(scene_probe, light, message)?;
        let diagnostic = match none_contributes(scene_probe) {
            true => diagnostic.effect("hardly any light reaches the visible surfaces: they are dark"),
            false => diagnostic.effect("this light contributes hardly anything to the picture"),
        };
        let factor = 0.8 / most.max(1e-30);
        if let Some(diagnostic) = super::overwhelmed::too_far(scene_probe, light, &diagnostic) {
            return Some(diagnostic);
        }
        if let Some((field, value)) = strength(scene_probe, span)
            && let Ok(written) = scene_probe.text(value).parse::<f32>()
        {
            let try_it = format!("try `{field} {}`", number(written * factor));
            let help = match factor > 1000.0 && field != "lux" {
                true => format!(
                    "distances are in the units of the scene, and light in `{field}` fades with their square: scale \
                     the scene if its unit is a millimetre, or {try_it}"
                ),
                false => format!("the light is about {} times too weak: {try_it}", number(factor)),
            };
            return Some(diagnostic.at(value).help(help));
        }
        let material = &description(scene_probe, light)?.value;
        let Some(point) = point(material) else {
            let color = material.color() * factor;
            let help = format!("the light is {} times too weak: try `color {}`", number(factor), vector(color));
            return Some(scene_probe.at_value(diagnostic, span, &["color"]).help(help));
        };
        // If the light's colour is plausible, the error is in the attenuation.
        let value =
            scene_probe.field_span(span, &["attenuation", "falloff"]).filter(|_| point.color.max_element() > 0.2);
        if let (Some(value), Some(a)) = (value, point.attenuation.filter(|_| point.falloff.is_none())) {
            let reversed = Vec3::new(a.z, a.y, a.x);
            if let Some(text) = is_usual_brightness(scene_probe, light, reversed).then(|| vector(reversed)) {
                let help = format!("the three coefficients are those of 1, d and d²: try `attenuation {text}`");
                return Some(diagnostic.at(value).fix(value, text).help(help));
            }
        }
        let (value, text, field) = match (value, point.falloff, point.attenuation) {
            (Some(value), Some(falloff), _) => {
                (value, number(falloff / factor), scene_probe.text(previous_word(scene_probe, value)))
            }
            (Some(value), None, Some(a)) => {
                // The constant coefficient limits the brightness near the light, so it is raised to
                // its usual value at most.
                let scaled = a / factor;
                (value, vector(Vec3::new(scaled.x.max(a.x.min(1.0)), scaled.y, scaled.z)), "attenuation".into())
            }
            // The default attenuation of the dialect applies unless the scene file sets another
            // one.
            _ if scene_probe.field_span(span, &["color"]).is_none() => {
                let help = format!("the light is about {} times too weak: increase its intensity", number(factor));
                return Some(diagnostic.help(help));
            }
            _ => match (scene_probe.field_span(span, &["color"])?, attenuation(&scene_probe.world().lights()[light])) {
                (color, Some(a)) if scene_probe.input.dialect == Dialect::F23 => {
                    let after = Span { start: color.end, ..color };
                    let text = format!(" attenuation {}", number(a.z / factor));
                    let help = format!("the default `attenuation` is {} here: try `{}`", number(a.z), text.trim());
                    return Some(diagnostic.at(color).fix(after, text).help(help));
                }
                (color, _) => (color, vector(point.color * factor), "color".into()),
            },
        };
        let help = format!("the light is about {} times too weak: try `{field} {text}`", number(factor));
        Some(diagnostic.at(value).fix(value, text).help(help))
    })
}

/// Returns the field that sets the strength of a light in photometric units, and the span of its
/// value.
pub(super) fn strength(scene_probe: &SceneProbe, light: Span) -> Option<(&'static str, Span)> {
    PHOTOMETRIC_FIELDS.into_iter().find_map(|field| Some((field, scene_probe.field_span(light, &[field])?)))
}

/// Returns true if different attenuation coefficients would give the light a usual brightness at
/// the visible surfaces.
fn is_usual_brightness(scene_probe: &SceneProbe, light: usize, factors: Vec3) -> bool {
    let Some(point) = point(&scene_probe.world().lights()[light]) else { return false };
    let faces = scene_probe.hits().filter(|(_, hit)| hit.contribution(light).is_some_and(|lit| lit.cosine > 0.1));
    let left = faces.map(|(probe, hit)| {
        let d = (probe.ray.at(hit.t) - point.position).length();
        point.color.max_element() / (factors.x + factors.y * d + factors.z * d * d)
    });
    (0.2..4.0).contains(&left.fold(0.0, f32::max))
}

/// Returns the span of the word that precedes a value.
fn previous_word(scene_probe: &SceneProbe, value: Span) -> Span {
    let bytes = scene_probe.input.files.bytes(value.file).unwrap_or_default();
    let head = &bytes[..value.start as usize];
    let end = head.iter().rposition(|b| !b.is_ascii_whitespace()).map_or(0, |at| at + 1);
    let start = head[..end].iter().rposition(u8::is_ascii_whitespace).map_or(0, |at| at + 1);
    Span { file: value.file, start: start as u32, end: end as u32 }
}

/// Reports lights whose attenuation divides by zero or by a negative number.
pub(super) fn invalid_divisor(scene_probe: &SceneProbe) -> Vec<Finding> {
    let findings = scene_probe.verdicts().iter().enumerate().filter(|(_, verdict)| **verdict == LightVerdict::Divides);
    findings
        .filter_map(|(light, _)| {
            let span = span(scene_probe, light)?;
            let divisor = attenuation(&scene_probe.world().lights()[light]).unwrap_or_default();
            let zero = divisor == Vec3::ZERO;
            let message = match zero {
                true => match scene_probe.field_span(span, &["attenuation", "falloff"]) {
                    Some(value) => {
                        format!(
                            "this light is divided by zero: its {} is {}",
                            scene_probe.text(previous_word(scene_probe, value)),
                            scene_probe.text(value)
                        )
                    }
                    None => "this light is divided by zero: it has no attenuation".to_string(),
                },
                false => format!("this light is divided by numbers that are not positive: {}", vector(divisor)),
            };
            let value = scene_probe.field_span(span, &["attenuation", "falloff"]);
            let diagnostic = Diagnostic::warning(message)
                .effect(match zero {
                    true => "the light is NaN or infinite and is left out, so surfaces are black or have specks",
                    false => "the light is negative or NaN, so surfaces are black",
                })
                .help(match scene_probe.field_span(span, &["falloff"]) {
                    Some(_) => "write a `falloff` above 0, such as `falloff 0.05`",
                    None if scene_probe.input.dialect == Dialect::F23 => {
                        "write an `attenuation` above 0, such as `attenuation 0.05`"
                    }
                    None if scene_probe.input.dialect == Dialect::F16 => "write a `falloff`, such as `falloff 0.05`",
                    None => "use `attenuation 1 0 0` for a light that does not fade",
                });
            let triple = description(scene_probe, light).is_some_and(|l| {
                point(&l.value).is_some_and(|point| point.attenuation.is_some() && point.falloff.is_none())
            });
            let diagnostic = match value {
                Some(value) if triple => diagnostic.fix(value, "1 0 0").at(value),
                _ => diagnostic.at(value.unwrap_or(span)),
            };
            Some(Finding::from(diagnostic).affecting_whole_picture(true))
        })
        .collect()
}
