//! Checks lights with a beam, which are spotlights and photometric lights, for beams that miss the
//! visible scene.

use super::aim::{BeamMiss, beam_coverage, hit_points};
use super::finding::{Finding, MAX_FINDINGS, number, percent, vector};
use super::lights::{description, no_contribution, none_contributes};
use super::scene_probe::SceneProbe;
use super::shapes::{point, spot, spread_direction};
use durer_diag::Diagnostic;
use durer_scene::light::{Illuminate as _, Light, PhotometricLight};
use durer_scene::math::{Ray, Vec3, fp};
use durer_scene::scene::Spanned;

/// Reports lights whose beam misses everything visible.
pub(super) fn away(scene_probe: &SceneProbe) -> Vec<Finding> {
    missing(scene_probe, BeamMiss::Away, |diagnostic, light| {
        let point = light.value.inverse_square().map_or(Vec3::ZERO, |(point, _)| point);
        // The visible part of a plane extends to the horizon, so only bounded objects are suitable
        // targets.
        let objects =
            scene_probe.hits().filter(|(_, hit)| scene_probe.world().objects()[hit.object as usize].bounds().is_some());
        let objects: Vec<Vec3> = objects.map(|(probe, hit)| probe.ray.at(hit.t)).collect();
        let all = if objects.is_empty() { hit_points(scene_probe) } else { objects };
        let middle = all.iter().sum::<Vec3>() / all.len().max(1) as f32;
        let (Some(direction), Some(_)) = (light.value.direction(), light.value.cone()) else { return diagnostic };
        let word = if light.value.profile().is_some() { "this photometric light" } else { "this spotlight" };
        // The opposite direction is usually the intended one.
        let turned = -direction.normalize_or(Vec3::NEG_Y);
        let to = (middle - point).normalize_or(Vec3::NEG_Y);
        // The beam must reach the objects after that.
        let (_, edge) = fp::sin_cos_degrees(f64::from(light.value.cone().unwrap_or(90.0).clamp(5.0, 45.0)));
        let negated = f64::from(turned.dot(to)) > edge;
        // An axis is a direction rather than a point if its negation is right.
        let is_axis = direction.abs().max_element() == 1.0 && direction.length() == 1.0;
        let is_target = (direction - middle).length() < 0.3 * (middle - point).length()
            && direction != middle - point
            && !(negated && is_axis);
        let text = vector(if negated && !is_target { -direction } else { middle - point });
        let model = scene_probe.model_format().is_some();
        let help = match negated {
            _ if model => "turn the light towards the visible objects".to_string(),
            _ if is_target => format!(
                "`direction` is a direction, not the point to aim at: write the point minus the position, `direction \
                 {}`",
                vector(middle - point)
            ),
            true => format!(
                "negate the direction: write `direction {text}`; `direction` is the direction in which the light travels"
            ),
            false => format!(
                "write `direction {text}` to aim at the center of the visible objects; `direction` is the direction \
                 in which the light travels"
            ),
        };
        let diagnostic = Diagnostic { message: format!("{word} misses every visible surface"), ..diagnostic };
        if let Some(wall) = wall_before(scene_probe, point, middle) {
            let name = scene_probe.object(wall);
            let help = format!("the {name} is between the light and the visible objects: move the light to their side");
            return diagnostic.related(scene_probe.object_span(wall), "this object is in between").help(help);
        }
        if !reaches(scene_probe, light, to, to) {
            return turned_over(scene_probe, diagnostic, light, to);
        }
        match scene_probe.field_span(light.span, &["direction"]) {
            Some(value) => diagnostic.at(value).help(help).fix(value, text),
            // The default direction is straight down.
            None => diagnostic.help(help),
        }
    })
}

/// Returns the large object that blocks the way from a light to the visible objects, for example a
/// floor above the light.
fn wall_before(scene_probe: &SceneProbe, from: Vec3, to: Vec3) -> Option<u32> {
    let world = scene_probe.world();
    let ray = Ray { t_max: 0.9, ..Ray::new(from, to - from) };
    let hit = world.closest(&ray, &mut ())?;
    let others: Vec<Vec3> = (scene_probe.hits().filter(|(_, other)| other.object != hit.object))
        .map(|(probe, other)| probe.ray.at(other.t))
        .collect();
    let is_behind = |point: &&Vec3| {
        let ray = Ray { t_max: 0.999, ..Ray::new(from, **point - from) };
        world.hit_of(hit.object, &ray.into()).is_some()
    };
    if others.iter().filter(is_behind).count() * 2 <= others.len() {
        return None;
    }
    let size = |bounds: durer_scene::math::Aabb| bounds.size().max_element();
    let is_large =
        world.objects()[hit.object as usize].bounds().is_none_or(|own| size(own) > 0.5 * size(world.bounds()));
    (is_large && !scene_probe.is_glass(hit.object)).then_some(hit.object)
}

/// Returns true if a photometric light with a given direction would reach the objects, which are in
/// the direction `to`.
fn reaches(scene_probe: &SceneProbe, light: &Spanned<Light>, direction: Vec3, to: Vec3) -> bool {
    let Light::Photometric(own) = &light.value else { return true };
    let number = scene_probe.input.scene.lights.iter().flatten().position(|other| std::ptr::eq(other, light));
    let Some(Some(profile)) = number.and_then(|number| scene_probe.world().profiles().get(number)) else { return true };
    let turned = PhotometricLight { direction, ..own.clone() };
    profile.at(turned.to_profile(to)) > 0.02 * profile.max_candela()
}

/// Places a finding about a photometric light whose profile has no light along its axis, so that
/// pointing the axis at the objects, which are in the direction `to`, would not help.
fn turned_over(scene_probe: &SceneProbe, diagnostic: Diagnostic, light: &Spanned<Light>, to: Vec3) -> Diagnostic {
    let why = "the luminaire emits no light along its axis";
    let value = scene_probe.field_span(light.span, &["direction"]);
    let diagnostic = Diagnostic { span: value.or(diagnostic.span), ..diagnostic };
    if scene_probe.model_format().is_some() {
        return diagnostic.help(format!("turn the light over, or use another luminaire: {why}"));
    }
    let opposite = light.value.direction().map(|direction| -direction);
    let mut others = opposite.into_iter().chain([-to]);
    match others.find(|direction| reaches(scene_probe, light, *direction, to)) {
        Some(direction) => {
            let text = vector(direction);
            let help = format!("write `direction {text}`, which turns the light over: {why}, but on its other side");
            diagnostic.help(help).fix_at(value, text)
        }
        None => diagnostic.help(format!("use another file, or move the light: {why}")),
    }
}

/// Reports cones that cover almost none of the visible points.
pub(super) fn narrow(scene_probe: &SceneProbe) -> Vec<Finding> {
    missing(scene_probe, BeamMiss::Narrow, |diagnostic, light| {
        let Some(spot) = spot(&light.value) else { return diagnostic };
        let degrees = number(spot.angle.to_degrees().round().clamp(1.0, 180.0));
        let message = format!("the half angle of this spotlight's cone is only {} degrees", number(spot.angle));
        let diagnostic = Diagnostic { message, ..diagnostic };
        let help = format!("`angle` is in degrees, from the axis to the edge: try `angle {degrees}`");
        let Some(value) = scene_probe.field_span(light.span, &["angle"]) else { return diagnostic.help(help) };
        let mut diagnostic = diagnostic.at(value).help(help).fix(value, degrees);
        if let Some(inner) =
            scene_probe.field_span(light.span, &["innerAngle"]).filter(|_| spot.inner_angle <= spot.angle)
        {
            diagnostic = diagnostic.fix(inner, number(spot.inner_angle.to_degrees().round()));
        }
        diagnostic
    })
}

fn missing(
    scene_probe: &SceneProbe,
    wanted: BeamMiss,
    say: impl Fn(Diagnostic, &Spanned<Light>) -> Diagnostic,
) -> Vec<Finding> {
    let lights = scene_probe.world().lights().len().min(MAX_FINDINGS);
    let mut findings = Vec::new();
    // A luminaire whose intensities are all 0 lights nothing, wherever it points.
    let is_dark = |light: &usize| {
        let profile = scene_probe.world().profiles().get(*light).and_then(Option::as_ref);
        profile.is_some_and(|profile| profile.max_candela() == 0.0)
    };
    for number in (0..lights).filter(|&light| scene_probe.aims()[light] == Some(wanted)).filter(|light| !is_dark(light))
    {
        let (Some(light), Some((diagnostic, span))) =
            (description(scene_probe, number), no_contribution(scene_probe, number, String::new()))
        else {
            continue;
        };
        let held = percent((1e4 * beam_coverage(scene_probe, number, &hit_points(scene_probe))) as usize, 10_000);
        let mut diagnostic = say(diagnostic.at(span), light);
        if wanted == BeamMiss::Narrow {
            diagnostic = diagnostic.label(format!("{held} of the visible points are in the cone"));
        }
        findings.push(Finding::from(diagnostic).affecting_whole_picture(none_contributes(scene_probe)));
    }
    findings
}

/// Reports spotlights whose inner cone is wider than their outer cone.
pub(super) fn inner_angle(scene_probe: &SceneProbe) -> Vec<Finding> {
    let lights = scene_probe.input.scene.lights.iter().flatten();
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
        Some(Finding::from(
            match (scene_probe.field_span(light.span, &["angle"]), scene_probe.field_span(light.span, &["innerAngle"]))
            {
                (Some(a), Some(b)) => diagnostic.at(b).fix(b, angle).fix(a, inner),
                _ => diagnostic.at(light.span),
            },
        ))
    };
    lights.filter_map(say).take(MAX_FINDINGS).collect()
}

/// Returns the distance and the object if a light is so close to a surface that it illuminates only
/// a spot.
fn too_close(scene_probe: &SceneProbe, light: usize) -> Option<(f32, u32)> {
    let point = point(&scene_probe.world().lights()[light])?;
    let world = scene_probe.world();
    let steps = (0..26).map(|i| spread_direction(i, 26));
    let axes = [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z];
    let rays = axes.into_iter().chain(steps).map(|dir| Ray::new(point.position, dir));
    let hits = rays.filter_map(|ray| world.closest(&ray, &mut ()));
    hits.map(|hit| (hit.t, hit.object)).min_by(|a, b| a.0.total_cmp(&b.0))
}

/// Reports lights that are just above a surface.
pub(super) fn near(scene_probe: &SceneProbe) -> Vec<Finding> {
    let points = hit_points(scene_probe);
    let mut findings = Vec::new();
    for light in 0..scene_probe.world().lights().len().min(super::finding::MAX_PER_KIND) {
        let Some((near, object)) = too_close(scene_probe, light) else { continue };
        let Some((emitter, point)) =
            description(scene_probe, light).and_then(|emitter| Some((emitter, point(&emitter.value)?)))
        else {
            continue;
        };
        let mut away: Vec<f32> = points.iter().map(|place| (*place - point.position).length()).collect();
        away.sort_by(f32::total_cmp);
        let lit: Vec<f32> = scene_probe
            .hits()
            .filter_map(|(_, hit)| hit.contribution(light))
            .map(|lit| lit.contribution.max_element())
            .collect();
        let bright = lit.iter().filter(|adds| **adds > 0.04).count();
        // Only a large surface loses light at grazing angles. Lights in a fixture are close to a
        // small surface.
        let along: Vec<f32> = scene_probe
            .hits()
            .filter(|(_, hit)| hit.object == object)
            .filter_map(|(_, hit)| Some(hit.contribution(light)?.cosine))
            .collect();
        let grazing = along.iter().filter(|cosine| cosine.abs() < 0.15).count() * 10 > along.len() * 7;
        let large = along.len() * 4 > scene_probe.hits().count();
        // A light that is far from everything is too faint, not too near.
        let bounds = scene_probe.world().bounds();
        let off = (bounds.center() - point.position).length();
        let is_far = !bounds.is_empty() && off > 10.0 * bounds.size().max_element();
        if is_far {
            continue;
        }
        if away.is_empty() || !grazing || !large || near > 0.03 * away[away.len() / 2] || bright * 5 > lit.len() {
            continue;
        }
        let middle = away[away.len() / 2];
        let fades = point.attenuation.is_some_and(|a| a.z > 0.0 || a.y > 0.0);
        let diagnostic =
            Diagnostic::warning(format!("this light is {} from the {}", number(near), scene_probe.object(object)))
                .related(scene_probe.object_span(object), "this object")
                .effect(match fades {
                    true => "the light makes a bright spot on the object and illuminates hardly anything else",
                    false => "the light hits the object at grazing angles, so it illuminates hardly more than a spot",
                })
                .help(format!(
                    "the mean distance of the visible points is {}: move the light away from the object",
                    number(middle)
                ));
        let only = scene_probe.world().lights().len() == 1;
        findings.push(
            Finding::from(scene_probe.at_value(diagnostic, emitter.span, &["position"])).affecting_whole_picture(only),
        );
    }
    findings
}
