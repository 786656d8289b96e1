//! Checks that the integrator supports the scene's light sources and that their light reaches the
//! surfaces.

use super::area_lights::emissive_objects;
use super::colors::background_span;
use super::finding::{Finding, percent};
use super::probes::{Probe, ProbeHit};
use super::scene_probe::SceneProbe;
use durer_diag::Diagnostic;
use durer_render::integrator::IntegratorKind;
use durer_render::world::Material;
use durer_scene::light::{Illuminate as _, Light};
use durer_scene::math::{Color, Ray, Vec3};
use durer_scene::scene::Material as ParsedMaterial;

/// Radiance below which a surface is black in an eight-bit picture.
const BLACK: f32 = 0.001;
/// Minimum number of tenths of the surface samples that must be black for the picture to count as
/// black. The second number applies to models without an environment that have a single light.
const MIN_BLACK_TENTHS: [usize; 2] = [9, 6];
/// Minimum number of surface samples needed for a conclusion.
const MIN_SAMPLES: usize = 20;

/// Reports a scene whose lights are all of a kind that Whitted's method does not support.
pub(super) fn wrong_integrator(scene_probe: &SceneProbe) -> Vec<Finding> {
    let world = scene_probe.world();
    if !matches!(scene_probe.input.job.method, IntegratorKind::Whitted(_)) || !world.lights().is_empty() {
        return Vec::new();
    }
    let light = emissive_objects(scene_probe).into_iter().next();
    let (what, span) = match (light, world.environment()) {
        (Some((object, _)), _) => ("emissive surfaces", Some(scene_probe.object_span(object))),
        (None, Some(_)) => ("its environment", background_span(scene_probe)),
        (None, None) => return Vec::new(),
    };
    let diagnostic = Diagnostic::warning(format!(
        "the only light in this scene comes from {what}, which Whitted's method does not support"
    ))
    .effect("nothing is lit: surfaces are black or have a flat colour")
    .help("use `--integrator path`, or omit `--integrator`");
    vec![Finding::from(Diagnostic { span, ..diagnostic }).affecting_whole_picture(true)]
}

/// Reports an environment that is multiplied by 0.
pub(super) fn black_sky(scene_probe: &SceneProbe) -> Vec<Finding> {
    let background = &scene_probe.input.scene.background;
    if scene_probe.world().environment().is_none() || background.environment_scale != Some(Vec3::ZERO) {
        return black_model_sky(scene_probe).into_iter().collect();
    }
    let alone = scene_probe.world().lights().is_empty() && emissive_objects(scene_probe).is_empty();
    let diagnostic = Diagnostic::warning("the environment is multiplied by 0")
        .effect(if alone {
            "nothing else emits light, so the picture is black"
        } else {
            "the environment emits no light and is invisible"
        })
        .help("write `environmentScale 1 1 1`, which leaves the environment unchanged");
    let value = background_span(scene_probe).and_then(|block| scene_probe.field_span(block, &["environmentScale"]));
    let diagnostic = Diagnostic { span: value.or(background_span(scene_probe)), ..diagnostic.fix_at(value, "1 1 1") };
    vec![Finding::from(diagnostic).affecting_whole_picture(alone)]
}

/// Reports an environment light of a pbrt or Mitsuba file whose colour or scale is 0.
fn black_model_sky(scene_probe: &SceneProbe) -> Option<Finding> {
    let (world, place) = (scene_probe.world(), background_span(scene_probe)?);
    scene_probe.model_format()?;
    let lit = world.environment().is_some()
        || world.background() != Color::ZERO
        || world.lights().iter().any(|light| light.color() != Color::ZERO)
        || !emissive_objects(scene_probe).is_empty();
    if lit {
        return None;
    }
    let diagnostic = Diagnostic::warning("the environment light is black: its colour times its scale is 0")
        .at(place)
        .effect("nothing else emits light, so the picture is black")
        .help("give the environment a scale and a colour above 0");
    Some(Finding::from(diagnostic).affecting_whole_picture(true))
}

/// Returns the number of black samples of reflecting surfaces and the number of all such samples if
/// nearly all of them are black.
fn black_samples(scene_probe: &SceneProbe) -> Option<(usize, usize)> {
    if !scene_probe.is_physical() || scene_probe.world().fog().is_some() || scene_probe.lacks_photons() {
        return None;
    }
    let world = scene_probe.world();
    let reflects = |hit: &ProbeHit| {
        let written = scene_probe.input.scene.materials.get(hit.material as usize).map(|written| &written.value);
        let dark = match written {
            Some(ParsedMaterial::Principled(m)) => m.base_color.max_element() < 0.05 && m.base_color_texture.is_none(),
            _ => false,
        };
        !dark && !world.may_emit(hit.material) && !matches!(world.materials()[hit.material as usize], Material::Mix(..))
    };
    let own = scene_probe
        .lit_probes()
        .filter_map(|(probe, color): (&Probe, Color)| probe.hit.as_ref().filter(|hit| reflects(hit)).map(|_| color));
    let (all, black) =
        own.fold((0, 0), |(all, black), color| (all + 1, black + usize::from(color.max_element() < BLACK)));
    let lone = scene_probe.model_format().is_some()
        && world.lights().len() == 1
        && world.environment().is_none()
        && (world.background() == Color::ZERO || world.is_dark())
        && emissive_objects(scene_probe).is_empty();
    (all >= MIN_SAMPLES && black * 10 >= all * MIN_BLACK_TENTHS[usize::from(lone)]).then_some((black, all))
}

/// Reports directional lights without extent that reach the visible surfaces only through glass,
/// where paths cannot find them.
pub(super) fn behind_glass(scene_probe: &SceneProbe) -> Vec<Finding> {
    let world = scene_probe.world();
    let black = scene_probe.is_dark() || black_samples(scene_probe).is_some();
    if !matches!(scene_probe.input.job.method, IntegratorKind::Path(_)) || !black {
        return Vec::new();
    }
    let refracts = |object: u32| match &world.materials()[world.objects()[object as usize].material as usize] {
        Material::Phong(phong) => {
            let layers = phong.principled.as_ref().map(|principled| &principled.definition);
            phong.is_entered() && phong.ior != 1.0 && layers.is_none_or(|m| m.transmission_weight > 0.5)
        }
        Material::Mix(..) => false,
    };
    let mut findings = Vec::new();
    for (number, light) in world.lights().iter().enumerate().take(super::finding::MAX_PER_KIND) {
        let Light::Directional(own) = light else { continue };
        if own.spread.is_some_and(|spread| spread > 0.0) || light.color() == Color::ZERO {
            continue;
        }
        let (mut direct, mut through, mut panes) = (0, 0, Vec::new());
        for (probe, hit) in scene_probe.hits().filter(|(_, hit)| !refracts(hit.object)) {
            if hit.contribution(number).is_none_or(|lit| lit.cosine <= 0.0) {
                continue;
            }
            let point = probe.ray.at(hit.t);
            let to_light = light.illuminate(point.as_dvec3()).to_light;
            let ray = Ray { t_min: 1e-3, ..Ray::new(point, to_light) };
            let passed: Vec<u32> = world.all_hits(&ray).take(16).map(|hit| hit.object).collect();
            match passed[..] {
                [] => direct += 1,
                [first, ..] if passed.iter().all(|object| refracts(*object)) => {
                    through += 1;
                    panes.push(first);
                }
                _ => {}
            }
        }
        let Some(pane) = super::verdict::most_common(&panes).filter(|_| direct * 10 <= through) else { continue };
        let Some(span) = super::lights::span(scene_probe, number) else { continue };
        let help = match scene_probe.model_format() {
            Some(_) => "use `--integrator photons`, or give the light an angular size",
            None => {
                "use `--integrator photons`, set `walls thin` in the material of the glass, or give the light an \
                 angular radius with `spread`"
            }
        };
        let diagnostic = Diagnostic::warning(format!(
            "this light reaches the visible surfaces only through the {}, where paths cannot find the light",
            scene_probe.object(pane)
        ))
        .at(span)
        .related(scene_probe.object_span(pane), "this glass refracts the light")
        .effect("a light without extent cannot be hit by a refracted path, so the surfaces behind the glass are black")
        .help(help);
        findings.push(Finding::from(diagnostic).affecting_whole_picture(true));
    }
    findings
}

/// Reports a path-traced picture in which nearly all surfaces are black although the scene contains
/// lights.
pub(super) fn mostly_black(scene_probe: &SceneProbe) -> Vec<Finding> {
    if scene_probe.is_dark() || !super::depth::limited(scene_probe).is_empty() || !behind_glass(scene_probe).is_empty()
    {
        return Vec::new();
    }
    let Some((black, all)) = black_samples(scene_probe) else { return Vec::new() };
    let model = scene_probe.model_format().is_some();
    let is_below = match scene_probe.world().lights() {
        [Light::Directional(light)] => super::lights::is_upwards(scene_probe, light.direction),
        _ => false,
    };
    let diagnostic = Diagnostic::warning(format!(
        "{} of the visible surface area is black: {}",
        percent(black, all),
        match scene_probe.world().lights().len() {
            1 if is_below => "the scene's only light shines upwards, from below",
            1 if model => "the scene's only light does not reach it, or is reflected past the camera",
            _ => "the scene's lights do not reach it",
        }
    ))
    .effect("hardly anything except the background is visible")
    .help(match model {
        true if is_below => "turn the light over, so that it shines downwards",
        true => "use `--studio sun`, which lights a model from outside and replaces its lights, or `--environment`",
        false if background_span(scene_probe).is_some() => {
            "move the light to the camera's side, add another light, or give the `Background` a brighter `color`"
        }
        false => "move the light to the camera's side, add another light, or write `Background { color 0.3 0.3 0.3 }`",
    });
    let span = scene_probe.input.scene.lights.iter().flatten().next().map(|light| light.span);
    vec![Finding::from(Diagnostic { span, ..diagnostic }).affecting_whole_picture(true)]
}

/// Roughness below which a metal reflects its surroundings and shows hardly any highlight.
const MIRROR_ROUGHNESS: f32 = 0.25;

/// Radiance below which smooth metal shows only the faint edge of a highlight.
const DIM: f32 = 0.01;

/// Reports smooth metal in black surroundings, with path tracing.
fn no_surroundings(scene_probe: &SceneProbe) -> Option<Finding> {
    let is_metal = |seen: &ProbeHit| match &scene_probe.world().materials()[seen.material as usize] {
        Material::Phong(phong) => phong.principled.as_ref().is_some_and(|own| {
            let layers = &own.definition;
            layers.base_metalness > 0.9
                && layers.specular_roughness < MIRROR_ROUGHNESS
                && layers.emission_luminance == 0.0
        }),
        Material::Mix(..) => false,
    };
    let (mut all, mut dark, mut first) = (0, 0, None);
    for (probe, color) in scene_probe.lit_probes() {
        let Some(hit) = probe.hit.as_ref() else {
            // Surroundings that are visible can also be reflected.
            if color.max_element() > BLACK {
                return None;
            }
            continue;
        };
        all += 1;
        if is_metal(hit) && color.max_element() < DIM {
            dark += 1;
            first = first.or(Some(hit.material));
        }
    }
    // The rest may show highlights of lights.
    if dark == 0 || dark * 4 < all * 3 {
        return None;
    }
    let diagnostic = Diagnostic::warning("only smooth metal is visible, and it has nothing to reflect")
        .effect("metal has no colour of its own: it shows its surroundings, which are black")
        .help(
            "add an environment, a bright object or an area light to reflect, or raise the roughness; a point light \
             cannot be seen in a mirror",
        );
    let span = scene_probe.input.scene.materials.get(first? as usize).map(|written| written.span);
    Some(Finding::from(Diagnostic { span, ..diagnostic }).affecting_whole_picture(true))
}

/// Reports mirrors that have nothing to reflect because only mirrors are visible and their
/// surroundings are black.
pub(super) fn nothing_mirrored(scene_probe: &SceneProbe) -> Vec<Finding> {
    if scene_probe.input.job.settings.bounces == 0 {
        return Vec::new();
    }
    if scene_probe.is_physical() {
        return no_surroundings(scene_probe).into_iter().collect();
    }
    let world = scene_probe.world();
    let mirror = |seen: &ProbeHit| match &world.materials()[seen.material as usize] {
        Material::Phong(phong) => {
            (phong.reflective + phong.transparent).max_element() > 0.1
                && phong.diffuse.max_element() < 0.01
                && phong.texture.is_none()
                && phong.noise.is_none()
        }
        Material::Mix(..) => false,
    };
    let black = |probe: &Probe| probe.color.max_element() < BLACK;
    let mut seen = scene_probe.hits().peekable();
    let Some((_, first)) = seen.peek().copied() else { return Vec::new() };
    let (all, dark) =
        seen.fold((0, 0), |(all, dark), (probe, hit)| (all + 1, dark + usize::from(mirror(hit) && black(probe))));
    if dark * 100 < all * 95 {
        return Vec::new();
    }
    let diagnostic = Diagnostic::warning("only mirrors are visible, and they have nothing to reflect")
        .effect("mirrors show their surroundings, which are black")
        .help("give the `Background` a `color`, add an object to reflect, or give the mirror a `diffuseColor`");
    let span = scene_probe.input.scene.materials.get(first.material as usize).map(|written| written.span);
    vec![Finding::from(Diagnostic { span, ..diagnostic }).affecting_whole_picture(true)]
}
