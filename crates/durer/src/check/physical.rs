//! Under a path tracer: scenes in which nothing shines, lamps that shine on nothing that is seen or are enclosed in glass, and
//! words of media without effect.

use super::finding::Finding;
use super::scout::Scout;
use crate::diag::Diagnostic;
use crate::integrator::Method;
use crate::light::Emitter as _;
use crate::math::{Color, Vec3};
use crate::scene::Material;
use crate::world::emitters::Form;

/// What is found of local light says nothing of paths.
pub(super) const OF_LOCAL_LIGHT: &[&str] = &[
    "light-divides",
    "light-inside",
    "light-blocked",
    "light-behind",
    "light-faint",
    "full-ambient",
    "pow-zero",
    "no-exponent",
    "black-material",
    "light-cancelled",
    "no-bounces",
    "dull-glass",
    "same-color",
    "seen-from-behind",
    "too-bright",
    "too-dark",
    "one-color",
];

/// Whether a scene's light is a path tracer's.
pub(super) fn is_physical(scout: &Scout) -> bool {
    scout.subject.job.method.transport().is_some()
}

pub(super) fn no_emitter(scout: &Scout) -> Vec<Finding> {
    let world = scout.world();
    let dark_sky = world.environment.is_none() && world.cube_map.is_none() && world.background == Color::ZERO;
    let shines = (0..world.materials.len() as u32).any(|material| world.may_shine(material));
    if !is_physical(scout)
        || !dark_sky
        || shines
        || world.lights.iter().any(|light| super::lights::color(light) != Color::ZERO)
    {
        return Vec::new();
    }
    let diagnostic = Diagnostic::warning("nothing shines in this scene: no light, no material with `emissionLuminance`, and the background is black")
        .effect("the picture is black")
        .help("give a material `emissionLuminance 10`, add a light, or write `Background { color 1 1 1 }`: what is all around is light too");
    vec![Finding::from(diagnostic).whole(true)]
}

pub(super) fn lamp_turned(scout: &Scout) -> Vec<Finding> {
    let world = scout.world();
    let mut found = Vec::new();
    if !is_physical(scout) {
        return found;
    }
    let places: Vec<Vec3> = scout.seen().map(|(probe, seen)| probe.ray.at(seen.t)).collect();
    for (number, object) in world.objects.iter().enumerate().filter(|(_, object)| object.parts() == 1) {
        let Some(false) = world.shines_to_both_sides(object.material) else { continue };
        let Some((form, normal)) = Form::of(object, 0).filter(|(_, normal)| *normal != Vec3::ZERO) else { continue };
        let middle = form.bounds().center();
        let reach = form.bounds().size().length();
        let own = |p: &&Vec3| (**p - middle).dot(normal).abs() > 1e-4 * reach;
        let (lit, all) = places
            .iter()
            .filter(own)
            .fold((0, 0), |(lit, all), p| (lit + usize::from((*p - middle).dot(normal) > 0.0), all + 1));
        if all == 0 || lit > 0 {
            continue;
        }
        let number = number as u32;
        let message = format!("the {} shines away from all that is seen", scout.object(number));
        let turn = match form {
            Form::Triangle(_) => "exchange two of its corners",
            Form::Parallelogram(_) => "exchange `edge0` and `edge1`",
            _ => "turn its `normal`",
        };
        let diagnostic = Diagnostic::warning(message)
            .at(scout.object_span(number))
            .effect("it lights nothing, and is seen black from behind")
            .help(format!("a surface shines to the side of its normal: {turn}, or give its material `walls thin`, with which both sides shine"));
        found.push(Finding::from(diagnostic));
    }
    found
}

/// Lamps without extent inside of glass: no path finds their light outside.
pub(super) fn lamp_in_glass(scout: &Scout) -> Vec<Finding> {
    let world = scout.world();
    if !matches!(scout.subject.job.method, Method::Path(_)) {
        return Vec::new();
    }
    let lights = world.lights.iter().enumerate().filter_map(|(number, light)| Some((number, light.place()?.0)));
    let enclosed = lights.filter_map(|(number, place)| {
        let glass = world.glass_around(place).find(|&(_, ior)| ior != 1.0)?.0;
        let message =
            format!("light {number} is inside the {}: its light comes out by refraction alone", scout.object(glass));
        let diagnostic = Diagnostic::warning(message)
            .at(scout.object_span(glass))
            .effect("paths do not find it: outside it is as if it were not there")
            .help(
                "take `--integrator photons`, or a material with `emissionLuminance` on a sphere instead of the light",
            );
        Some(Finding::from(diagnostic))
    });
    enclosed.collect()
}

/// Words of scattering inside of a body that change nothing.
pub(super) fn without_effect(scout: &Scout) -> Vec<Finding> {
    if !is_physical(scout) {
        return Vec::new();
    }
    let mut found = Vec::new();
    for material in &scout.subject.scene.materials {
        let Material::Principled(m) = &material.value else { continue };
        let word = if m.transmission_scatter != Vec3::ZERO && m.transmission_depth == 0.0 {
            Some((
                "transmissionScatter",
                "nothing is scattered inside: `transmissionDepth` is 0",
                "write `transmissionDepth 1`, say: how deep light goes until it has `transmissionColor`",
            ))
        } else if m.transmission_scatter != Vec3::ZERO && m.transmission_weight == 0.0 {
            Some((
                "transmissionScatter",
                "no light comes inside: `transmissionWeight` is 0",
                "write `transmissionWeight 1`, or `subsurfaceWeight 1` for what is not clear",
            ))
        } else if m.subsurface_weight > 0.0 && m.transmission_weight == 1.0 {
            Some(("subsurfaceWeight", "all light is refracted: `transmissionWeight` is 1", "leave one of them out"))
        } else {
            None
        };
        if let Some((word, effect, help)) = word {
            let message = format!("`{word}` has no effect in this material");
            let diagnostic = Diagnostic::warning(message).at(material.span).effect(effect).help(help);
            found.push(Finding::from(diagnostic));
        }
    }
    found
}
