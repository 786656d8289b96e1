//! Checks of lights with a beam: spotlights and photometric lights that miss the visible scene.

use super::aim::{Aim, places, within};
use super::finding::{Finding, MAX_SOUGHT, number, percent, vector};
use super::lights::{all_fail, useless, written};
use super::scene_probe::SceneProbe;
use super::shapes::{point, spot};
use durer_diag::Diagnostic;
use durer_scene::light::{Illuminate as _, Light};
use durer_scene::math::{Vec3, fp};
use durer_scene::scene::Spanned;

/// Reports lights whose beam misses everything visible.
pub(super) fn away(scout: &SceneProbe) -> Vec<Finding> {
    missing(scout, Aim::Away, |diagnostic, light| {
        let place = light.value.inverse_square().map_or(Vec3::ZERO, |(place, _)| place);
        // The visible part of a plane reaches the horizon, so aim at bounded objects only.
        let objects = scout.seen().filter(|(_, seen)| scout.world().objects()[seen.object as usize].bounds().is_some());
        let objects: Vec<Vec3> = objects.map(|(probe, seen)| probe.ray.at(seen.t)).collect();
        let all = if objects.is_empty() { places(scout) } else { objects };
        let middle = all.iter().sum::<Vec3>() / all.len().max(1) as f32;
        let (Some(direction), Some(_)) = (light.value.direction(), light.value.cone()) else { return diagnostic };
        let word = if light.value.profile().is_some() { "this photometric light" } else { "this spotlight" };
        // Usually the opposite direction is the intended one.
        let turned = -direction.normalize_or(Vec3::NEG_Y);
        let to = (middle - place).normalize_or(Vec3::NEG_Y);
        let aimed = if turned.dot(to) > 0.7 { -direction } else { middle - place };
        let text = vector(aimed);
        let help = format!(
            "`direction` is the direction in which the light travels: `direction {text}` points at the center of \
             the visible objects"
        );
        let diagnostic = Diagnostic { message: format!("{word} misses every visible surface"), ..diagnostic };
        match scout.value(light.span, &["direction"]) {
            Some(value) => diagnostic.at(value).help(help).fix(value, text),
            // The default direction is straight down.
            None => diagnostic.help(help),
        }
    })
}

/// Reports cones that cover almost none of the visible points.
pub(super) fn narrow(scout: &SceneProbe) -> Vec<Finding> {
    missing(scout, Aim::Narrow, |diagnostic, light| {
        let Some(spot) = spot(&light.value) else { return diagnostic };
        let degrees = number(spot.angle.to_degrees().round().clamp(1.0, 180.0));
        let message = format!("the cone of this spotlight is only {} degrees wide", number(spot.angle));
        let diagnostic = Diagnostic { message, ..diagnostic };
        let help = format!("`angle` is in degrees, from the axis to the edge: try `angle {degrees}`");
        let Some(value) = scout.value(light.span, &["angle"]) else { return diagnostic.help(help) };
        let mut diagnostic = diagnostic.at(value).help(help).fix(value, degrees);
        if let Some(inner) = scout.value(light.span, &["innerAngle"]).filter(|_| spot.inner_angle <= spot.angle) {
            diagnostic = diagnostic.fix(inner, number(spot.inner_angle.to_degrees().round()));
        }
        diagnostic
    })
}

fn missing(scout: &SceneProbe, wanted: Aim, say: impl Fn(Diagnostic, &Spanned<Light>) -> Diagnostic) -> Vec<Finding> {
    let lights = scout.world().lights().len().min(MAX_SOUGHT);
    let mut found = Vec::new();
    for number in (0..lights).filter(|&light| scout.aims()[light] == Some(wanted)) {
        let (Some(light), Some((diagnostic, span))) = (written(scout, number), useless(scout, number, String::new()))
        else {
            continue;
        };
        let held = percent((1e4 * within(scout, number, &places(scout))) as usize, 10_000);
        let mut diagnostic = say(diagnostic.at(span), light);
        if wanted == Aim::Narrow {
            diagnostic = diagnostic.label(format!("{held} of the visible points are in its cone"));
        }
        found.push(Finding::from(diagnostic).whole(all_fail(scout)));
    }
    found
}

/// Reports spotlights whose inner cone is wider than the outer one.
pub(super) fn inner_angle(scout: &SceneProbe) -> Vec<Finding> {
    let lights = scout.subject.scene.lights.iter().flatten();
    let say = |light: &Spanned<Light>| {
        let spot = spot(&light.value)?;
        if spot.inner_angle <= spot.angle {
            return None;
        }
        let (angle, inner) = (number(spot.angle), number(spot.inner_angle));
        let diagnostic =
            Diagnostic::warning(format!("the `innerAngle` of {inner} is greater than the `angle` of {angle}"))
                .effect(format!("the cone ends abruptly at {angle} degrees"))
                .help(format!("light fades between the two angles: write `angle {inner} innerAngle {angle}`"));
        Some(Finding::from(match (scout.value(light.span, &["angle"]), scout.value(light.span, &["innerAngle"])) {
            (Some(a), Some(b)) => diagnostic.at(b).fix(a, inner).fix(b, angle),
            _ => diagnostic.at(light.span),
        }))
    };
    lights.filter_map(say).take(MAX_SOUGHT).collect()
}

/// Returns the distance and the object if a light is so close to a surface that it illuminates only
/// a spot.
fn touching(scout: &SceneProbe, light: usize) -> Option<(f32, u32)> {
    let point = point(&scout.world().lights()[light])?;
    point.attenuation.filter(|a| a.z > 0.0 || a.y > 0.0)?;
    let world = scout.world();
    let steps = (0..26).map(|i| {
        let (sin, cos) = fp::sin_cos_degrees(f64::from(i) * 137.508);
        let z = 1.0 - 2.0 * (f64::from(i) + 0.5) / 26.0;
        let r = (1.0 - z * z).sqrt();
        Vec3::new((r * cos) as f32, (r * sin) as f32, z as f32)
    });
    let axes = [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z];
    let rays = axes.into_iter().chain(steps).map(|dir| durer_scene::math::Ray::new(point.position, dir));
    let hits = rays.filter_map(|ray| world.closest(&ray, &mut ()));
    hits.map(|hit| (hit.t, hit.object)).min_by(|a, b| a.0.total_cmp(&b.0))
}

/// Reports lights with attenuation that are just above a surface.
pub(super) fn near(scout: &SceneProbe) -> Vec<Finding> {
    let places = places(scout);
    let mut found = Vec::new();
    for light in 0..scout.world().lights().len().min(super::finding::MAX_ALIKE) {
        let Some((near, object)) = touching(scout, light) else { continue };
        let Some((emitter, point)) = written(scout, light).and_then(|emitter| Some((emitter, point(&emitter.value)?)))
        else {
            continue;
        };
        let mut away: Vec<f32> = places.iter().map(|place| (*place - point.position).length()).collect();
        away.sort_by(f32::total_cmp);
        let lit: Vec<f32> =
            scout.seen().filter_map(|(_, seen)| seen.by(light)).map(|lit| lit.adds.max_element()).collect();
        let bright = lit.iter().filter(|adds| **adds > 0.04).count();
        // Only a large surface loses light at grazing angles; lights in a fixture are close to a
        // small one.
        let along: Vec<f32> = scout
            .seen()
            .filter(|(_, seen)| seen.object == object)
            .filter_map(|(_, seen)| Some(seen.by(light)?.cosine))
            .collect();
        let grazing = along.iter().filter(|cosine| cosine.abs() < 0.15).count() * 10 > along.len() * 7;
        let large = along.len() * 4 > scout.seen().count();
        if away.is_empty() || !grazing || !large || near > 0.03 * away[away.len() / 2] || bright * 5 > lit.len() {
            continue;
        }
        let middle = away[away.len() / 2];
        let diagnostic =
            Diagnostic::warning(format!("this light is {} from the {}", number(near), scout.object(object)))
                .related(scout.object_span(object), "this object")
                .effect("it makes a bright spot below it and lights hardly anything else")
                .help(format!(
                    "the mean distance of the visible points is {}: move the light away from the object",
                    number(middle)
                ));
        let only = scout.world().lights().len() == 1;
        found.push(Finding::from(scout.at_value(diagnostic, emitter.span, &["position"])).whole(only));
    }
    found
}
