//! Checks for path tracing: scenes without emitters, lights enclosed in glass, and medium
//! parameters that have no effect.

use super::finding::Finding;
use super::scene_probe::SceneProbe;
use durer_diag::Diagnostic;
use durer_render::integrator::IntegratorKind;
use durer_render::world::Material as Compiled;
use durer_scene::light::Illuminate as _;
use durer_scene::math::{Color, Vec3};
use durer_scene::scene::Material;

/// Codes of checks for local lighting, which do not apply to path tracing.
const LOCAL_LIGHT_CHECKS: &[&str] = &[
    "light-divides",
    "light-inside",
    "light-blocked",
    "light-behind",
    "light-faint",
    "full-ambient",
    "pow-zero",
    "no-exponent",
    "light-cancelled",
    "same-color",
    "no-light",
];

/// Codes of the local lighting checks that can explain a black path-traced picture.
const DARKNESS_CHECKS: &[&str] = &["light-inside", "light-blocked", "light-behind", "light-faint"];

/// Returns true if a check is for local lighting and does not apply to the scene.
pub(super) fn does_not_apply(scene_probe: &SceneProbe, code: &str) -> bool {
    let own = ["light-inside", "light-blocked", "light-behind", "light-faint"];
    let says_why = || DARKNESS_CHECKS.contains(&code) && scene_probe.is_dark() || own.contains(&code);
    scene_probe.is_physical() && LOCAL_LIGHT_CHECKS.contains(&code) && !says_why()
}

/// Returns true if the background emits light.
pub(super) fn has_sky(scene_probe: &SceneProbe) -> bool {
    let world = scene_probe.world();
    world.environment().is_some() || world.cube_map().is_some() || world.background() != Color::ZERO && !world.is_dark()
}

/// Returns true if all light comes from lights: nothing else emits light.
pub(super) fn has_only_lights(scene_probe: &SceneProbe) -> bool {
    !has_sky(scene_probe) && super::area_lights::emissive_objects(scene_probe).is_empty()
}

/// Reports a scene in which nothing emits light.
pub(super) fn no_emitter(scene_probe: &SceneProbe) -> Vec<Finding> {
    let world = scene_probe.world();
    let scaled = scene_probe.input.scene.background.environment_scale != Some(Vec3::ZERO);
    let dark_sky = (world.environment().is_none() || !scaled)
        && world.cube_map().is_none()
        && (world.background() == Color::ZERO || world.is_dark());
    let of = |material: u32| scene_probe.radiance(material as usize);
    let emits = world.objects().iter().any(|object| of(object.material) != Color::ZERO)
        || world
            .objects()
            .iter()
            .any(|object| matches!(world.materials().get(object.material as usize), Some(Compiled::Mix(..))))
            && (0..world.materials().len() as u32).any(|material| of(material) != Color::ZERO);
    if !scene_probe.is_physical()
        || !dark_sky
        || emits
        || world.lights().iter().any(|light| light.color() != Color::ZERO)
    {
        return Vec::new();
    }
    // If a material was meant to emit light, that material is reported.
    let emitter = scene_probe.input.scene.materials.iter().enumerate().find(|(_, material)| match &material.value {
        Material::Principled(layers) => layers.emission_luminance > 0.0,
        _ => false,
    });
    let format = scene_probe.model_format();
    if let Some((number, material)) = emitter {
        let black = of(number as u32) == Color::ZERO;
        let compiled = world.materials().get(number).and_then(|material| match material {
            Compiled::Phong(phong) => phong.emission.as_ref(),
            Compiled::Mix(..) => None,
        });
        if compiled.is_some_and(|emission| emission.radiance != Color::ZERO) && black {
            let message = format!("nothing emits light: the `emissionTexture` of material {number} is black");
            let diagnostic = Diagnostic::warning(message)
                .effect("the picture is black")
                .help("use a picture that is bright where light is emitted");
            let diagnostic = scene_probe.at_value(diagnostic, material.span, &["emissionTexture"]);
            return vec![Finding::from(diagnostic).affecting_whole_picture(true)];
        }
        let message = match black {
            true => format!("nothing emits light: the `emissionColor` of material {number} is black"),
            false => format!("nothing emits light: no object uses the emissive material {number}"),
        };
        let diagnostic = Diagnostic::warning(message).effect("the picture is black").help(match black {
            true if format.is_some() => "increase the emission of the material",
            false if format.is_some() => "give a shape the emissive material",
            true => {
                "change `emissionColor`, which multiplies `emissionLuminance`; for example, `emissionColor 1 1 1` \
                 is white light"
            }
            false => "check each `MaterialIndex`: indices start at 0",
        });
        let diagnostic = scene_probe.at_value(diagnostic, material.span, &["emissionColor", "emissionLuminance"]);
        return vec![Finding::from(diagnostic).affecting_whole_picture(true)];
    }
    // A material with the colour of an emission, but without its luminance, emits nothing.
    let colored = scene_probe.input.scene.materials.iter().enumerate().find_map(|(number, material)| {
        let is_layered = matches!(&material.value, Material::Principled(_)) && format.is_none();
        let fields = ["emissionColor", "emissionSpectrum", "emissionTexture"];
        is_layered.then(|| scene_probe.field_span(material.span, &fields)).flatten().map(|place| (number, place))
    });
    if let Some((number, place)) = colored {
        let message =
            format!("nothing emits light: material {number} has a colour of emission, but no `emissionLuminance`");
        let diagnostic = Diagnostic::warning(message).effect("the picture is black").at(place);
        let help = "add `emissionLuminance`, which is 0 by default, for example `emissionLuminance 10`";
        return vec![Finding::from(diagnostic.help(help)).affecting_whole_picture(true)];
    }
    let ambient = match world.ambient() == Color::ZERO {
        true => "",
        false => "; `ambientLight` has no effect on paths",
    };
    let (surface, help) = match format.and_then(|format| format.light_hint) {
        Some(words) => ("emissive surface", format!("{words}; lights that are reported as left out emit nothing")),
        None => (
            "material with `emissionLuminance`",
            format!(
                "give a material `emissionLuminance 10`, add a light, or write `Background {{ color 1 1 1 }}`: the background emits light too{ambient}"
            ),
        ),
    };
    let message =
        format!("nothing emits light in this scene: it has no light and no {surface}, and the background is black");
    let diagnostic = Diagnostic::warning(message).effect("the picture is black").help(help);
    vec![Finding::from(diagnostic).affecting_whole_picture(true)]
}

/// Reports point lights inside glass, which paths from outside cannot reach.
pub(super) fn light_in_glass(scene_probe: &SceneProbe) -> Vec<Finding> {
    let world = scene_probe.world();
    if !matches!(scene_probe.input.job.method, IntegratorKind::Path(_)) {
        return Vec::new();
    }
    let lights =
        world.lights().iter().enumerate().filter_map(|(number, light)| Some((number, light.inverse_square()?.0)));
    let enclosed = lights.filter_map(|(number, place)| {
        let glass = world.glass_around(place).find(|&(_, ior)| ior != 1.0)?.0;
        let message = format!(
            "light {number} is inside the {}: its light can only leave by refraction",
            scene_probe.object(glass)
        );
        let diagnostic = Diagnostic::warning(message)
            .at(scene_probe.object_span(glass))
            .effect("paths cannot find the light, so it illuminates nothing outside the glass")
            .help("use `--integrator photons`, or replace the light by a sphere with `emissionLuminance`");
        Some(Finding::from(diagnostic))
    });
    enclosed.collect()
}

/// Reports scattering parameters of layered materials that have no effect.
pub(super) fn without_effect(scene_probe: &SceneProbe) -> Vec<Finding> {
    if !scene_probe.is_physical() {
        return Vec::new();
    }
    let mut findings = Vec::new();
    for material in &scene_probe.input.scene.materials {
        let Material::Principled(m) = &material.value else { continue };
        let word = if m.transmission_scatter != Vec3::ZERO && m.transmission_depth == 0.0 {
            Some((
                "transmissionScatter",
                "no light is scattered inside the object: `transmissionDepth` is 0",
                "try `transmissionDepth 1`, the distance after which light has `transmissionColor`",
            ))
        } else if m.transmission_scatter != Vec3::ZERO && m.transmission_weight == 0.0 {
            Some((
                "transmissionScatter",
                "no light enters the object: `transmissionWeight` is 0",
                "write `transmissionWeight 1`, or `subsurfaceWeight 1` for a translucent body",
            ))
        } else if m.subsurface_weight > 0.0 && m.transmission_weight == 1.0 {
            Some((
                "subsurfaceWeight",
                "all light is refracted: `transmissionWeight` is 1",
                "remove `subsurfaceWeight` or `transmissionWeight`",
            ))
        } else {
            None
        };
        if let Some((word, effect, help)) = word {
            let message = format!("`{word}` has no effect in this material");
            let diagnostic = Diagnostic::warning(message).at(material.span).effect(effect).help(help);
            findings.push(Finding::from(diagnostic));
        }
    }
    findings
}
