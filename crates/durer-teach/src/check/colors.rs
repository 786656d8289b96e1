//! Checks colours for invisible or black materials and for values out of range.

use super::finding::{Finding, MAX_FINDINGS, percent, vector};
use super::scene_probe::SceneProbe;
use durer_diag::{Diagnostic, Severity, Span};
use durer_render::world::{Material, Phong};
use durer_scene::light::{Illuminate as _, Light};
use durer_scene::math::Color;
use durer_scene::scene::{Material as ParsedMaterial, Spanned};

/// Materials that reflect less than this look black.
const BLACK: f32 = 0.01;
/// Colours that differ by less than this look the same.
const SAME_COLOR: f32 = 2.0 / 255.0;

/// Minimum number of rays that must hit an object before it can count as indistinguishable from the
/// background.
const MIN_LOST_RAYS: usize = 6;

/// Iterates over the Phong materials. Each item has the index, the description in the scene file,
/// and the compiled material.
pub(super) fn phongs<'s>(
    scene_probe: &'s SceneProbe,
) -> impl Iterator<Item = (u32, &'s Spanned<ParsedMaterial>, &'s Phong)> {
    let compiled = scene_probe.world().materials().iter();
    let both = scene_probe.input.scene.materials.iter().zip(compiled).enumerate();
    both.filter_map(|(i, (material, compiled))| match compiled {
        Material::Phong(phong) => Some((i as u32, material, phong)),
        Material::Mix(..) => None,
    })
}

/// Returns the number of rays that hit a material, either directly or as part of a mix.
pub(super) fn rays(scene_probe: &SceneProbe, material: u32) -> usize {
    scene_probe.material_rays()[material as usize]
}

/// Returns true if no visible material reflects any light.
pub(super) fn all_black(scene_probe: &SceneProbe) -> bool {
    let shows = |(i, _, phong): (u32, &Spanned<ParsedMaterial>, &Phong)| !is_black(phong) && rays(scene_probe, i) > 0;
    scene_probe.hits().next().is_some() && !phongs(scene_probe).any(shows)
}

fn is_black(phong: &Phong) -> bool {
    let shown = phong.reflective + phong.transparent + phong.highlight.map_or(Color::ZERO, |h| h.0);
    phong.diffuse.max_element() < BLACK
        && phong.texture.is_none()
        && phong.noise.is_none()
        && shown.max_element() < BLACK
}

/// Reports materials that reflect no light.
pub(super) fn black(scene_probe: &SceneProbe) -> Vec<Finding> {
    if scene_probe.is_physical() {
        return super::layers::black(scene_probe);
    }
    let all = scene_probe.hits().count();
    let whole = all_black(scene_probe);
    // Part of a pattern may be black, but not the whole pattern.
    let shown =
        |i: u32| if whole { rays(scene_probe, i) > 0 } else { scene_probe.hits().any(|(_, hit)| hit.material == i) };
    // Emissive surfaces are usually black.
    let emits = |phong: &Phong| phong.emission.as_ref().is_some_and(|own| own.radiance != Color::ZERO);
    let black: Vec<_> =
        phongs(scene_probe).filter(|(i, _, phong)| is_black(phong) && !emits(phong) && shown(*i)).collect();
    let say = |(i, material, _): &(u32, &Spanned<ParsedMaterial>, &Phong)| {
        let word = match &material.value {
            ParsedMaterial::Principled(_) => "baseColor",
            _ => "diffuseColor",
        };
        let diagnostic = Diagnostic::warning(format!("material {i} is black: it reflects no light"))
            .label(format!("on {} of the visible surfaces", percent(rays(scene_probe, *i), all)))
            .effect("objects with this material are black under any light")
            .help(format!(
                "increase `{word}`, the fraction of light that the material reflects; for example, `0.8 0.8 0.8` is \
                 a light grey"
            ));
        let diagnostic = scene_probe.at_value(diagnostic, material.span, &[word, "diffuse"]);
        // Silhouettes before a bright background may be intentional.
        let severity = if whole && super::exposure::has_bright_background(scene_probe) {
            Severity::Note
        } else {
            Severity::Warning
        };
        Finding::from(Diagnostic { severity, ..diagnostic }).affecting_whole_picture(whole)
    };
    black.iter().take(MAX_FINDINGS).map(say).collect()
}

/// A colour of a light, material or background, and the place where the scene file sets it.
struct ColorField {
    color: Color,
    block: Span,
    fields: [&'static str; 2],
    /// Largest plausible value of a colour channel.
    most: f32,
}

/// Returns true if the strength of a light is in candela, lumens or lux.
fn has_unit(light: &Light) -> bool {
    light.with_unit_color().color() != light.color()
}

fn all_colors(scene_probe: &SceneProbe) -> Vec<ColorField> {
    let mut colors = Vec::new();
    for (i, material, used) in phongs(scene_probe) {
        let ParsedMaterial::Phong(phong, _) = &material.value else { continue };
        // A surface reflects at most the light that it receives, but a small bright object may
        // represent a light.
        let small = rays(scene_probe, i) * 25 < scene_probe.probes.len();
        let named = |color, fields, most: f32| {
            let most = if small { most.max(15.0) } else { most };
            ColorField { color, block: material.span, fields, most }
        };
        colors.extend(phong.diffuse_color.map(|color| named(color, ["diffuseColor", "diffuse"], 1.001)));
        let all = |color, fields, most: f32| ColorField { color, block: material.span, fields, most };
        // A highlight may be slightly brighter than white. A mirror reflects at most the light that
        // it receives.
        let mirrors = used.reflective != Color::ZERO && phong.reflective_color == Color::ZERO;
        colors.push(all(phong.specular_color, ["specularColor", "specular"], if mirrors { 1.05 } else { 1.6 }));
        colors.push(all(phong.reflective_color, ["reflectiveColor", "reflectiveColor"], 1.001));
        colors.push(all(phong.transparent_color, ["transparentColor", "transparentColor"], 1.001));
    }
    for material in &scene_probe.input.scene.materials {
        let ParsedMaterial::Principled(m) = &material.value else { continue };
        let shares = [
            (m.base_color, "baseColor"),
            (m.transmission_color, "transmissionColor"),
            (m.subsurface_color, "subsurfaceColor"),
            (m.coat_color, "coatColor"),
            (m.fuzz_color, "fuzzColor"),
        ];
        // Presets for measured metals slightly exceed 1.
        colors.extend(shares.map(|(color, field)| ColorField {
            color,
            block: material.span,
            fields: [field, field],
            most: 1.1,
        }));
    }
    for (number, (material, light)) in
        scene_probe.input.scene.lights.iter().flatten().zip(scene_probe.world().lights()).enumerate()
    {
        // A light with attenuation may be strong as long as not too much of its light arrives.
        // Lights in candela rarely have values near 1.
        let candela = light.cone().is_some() || light.profile().is_some();
        let fades = candela || super::shapes::point(light).is_some_and(|point| point.attenuation.is_some());
        let arrives =
            scene_probe.hits().filter_map(|(_, hit)| hit.contribution(number)).map(|lit| lit.unoccluded.max_element());
        let too_much = arrives.fold(0.0, f32::max) > 20.0;
        // Path tracing has no fixed unit of light because the exposure scales it.
        let free = candela || has_unit(&material.value) || fades && !too_much || scene_probe.is_physical();
        let most = if free { f32::INFINITY } else { 20.0 };
        colors.push(ColorField { color: light.color(), block: material.span, fields: ["color", "color"], most });
    }
    colors
}

/// Reports colours whose channels range from 0 to 255.
pub(super) fn too_large(scene_probe: &SceneProbe) -> Vec<Finding> {
    let mut findings = Vec::new();
    let describe = |color: Color, place: Option<Span>, block: Option<Span>, is_light: bool| {
        // Whole numbers are probably byte values if some of them are large.
        let whole = color.to_array().iter().all(|c| c.fract() == 0.0);
        let bytes = whole && (20.0..=255.0).contains(&color.max_element());
        // Multiples of 5 up to 100 may also be percentages.
        let percent = bytes && color.max_element() <= 100.0 && color.to_array().iter().all(|c| c % 5.0 == 0.0);
        // Light without attenuation can also be this strong on purpose.
        let is_light = is_light && color.max_element() < 128.0;
        let mended = if bytes { color / 255.0 } else { color / color.max_element() };
        let far = color.max_element() > 2.0;
        let message = format!("the colour {} is {}above 1", vector(color), if far { "far " } else { "" });
        let diagnostic = Diagnostic::warning(message)
            .effect(match far {
                true if is_light => "most of what it lights, or the background itself, is white or a saturated colour",
                true => "the result is white or a saturated colour under any light",
                false => {
                    "the surface reflects more light than it receives, so bright parts are clipped and lose their \
                     shading"
                }
            })
            .help(match bytes {
                true if percent => format!(
                    "colours range from 0 to 1: write `{}` if the colour is in percent, or `{}` if it is in bytes",
                    vector(color / 100.0),
                    vector(mended)
                ),
                true if is_light => format!(
                    "colours range from 0 to 1: write `{}` if the colour is in bytes, or add an attenuation if the \
                     light should be this strong",
                    vector(mended)
                ),
                true => format!("colours range from 0 to 1, not to 255: write `{}`", vector(mended)),
                false => format!("colours range from 0 to 1: try `{}`", vector(mended)),
            });
        let diagnostic = match place {
            // Only byte values have an obvious correction.
            Some(place) if bytes && !percent && !is_light => diagnostic.at(place).fix(place, vector(mended)),
            Some(place) => diagnostic.at(place),
            None => Diagnostic { span: block, ..diagnostic },
        };
        Finding::from(diagnostic).affecting_whole_picture(far)
    };
    let beyond = all_colors(scene_probe).into_iter().filter(|field| field.color.max_element() > field.most);
    for ColorField { color, block, fields, .. } in beyond.take(MAX_FINDINGS) {
        if let Some(finding) = without_fading(scene_probe, color, block) {
            findings.push(finding);
            continue;
        }
        let written =
            scene_probe.model_format().and_then(|_| super::written::place_of_color(scene_probe, block, color));
        let is_light = fields == ["color", "color"];
        findings.push(describe(
            color,
            written.or_else(|| scene_probe.field_span(block, &fields)),
            Some(block),
            is_light,
        ));
    }
    let background = &scene_probe.input.scene.background;
    for (color, fields) in
        [(background.color, ["color", "color"]), (background.ambient_light, ["ambientLight", "ambient_light"])]
    {
        // With an exposure, colours need not be in the range of the display.
        if color.max_element() * scene_probe.input.exposure > 2.0 && !scene_probe.is_physical() {
            let block = background_span(scene_probe);
            let place = block.and_then(|block| scene_probe.field_span(block, &fields));
            findings.push(describe(color, place, block, true));
        }
    }
    findings
}

/// Strength of light above which it is too strong, also if it fades.
const MAX_FADED: f32 = 3.0;

/// Reports a strong point light whose attenuation is constant, if the light would have the right
/// strength with the same coefficient for the square of the distance.
fn without_fading(scene_probe: &SceneProbe, color: Color, block: Span) -> Option<Finding> {
    let lights = scene_probe.input.scene.lights.iter().flatten();
    let (number, light) = lights.enumerate().find(|(_, light)| light.span == block)?;
    let constant = super::verdict::attenuation(&light.value).filter(|a| a.x > 0.0 && a.y == 0.0 && a.z == 0.0)?;
    let value = scene_probe.field_span(block, &["attenuation"])?;
    let place = light.value.position()?;
    let lit = scene_probe.hits().filter(|(_, hit)| hit.contribution(number).is_some_and(|lit| lit.cosine > 0.0));
    let least = lit.map(|(probe, hit)| (probe.ray.at(hit.t) - place).length_squared()).fold(f32::INFINITY, f32::min);
    let most = color.max_element() / (constant.x * least);
    if !(super::verdict::VISIBLE..=MAX_FADED).contains(&most) {
        return None;
    }
    let written = scene_probe.text(value);
    let square = vector(Color::new(0.0, 0.0, constant.x));
    let message =
        format!("the light of colour {} does not fade: its attenuation `{written}` is constant", vector(color));
    let diagnostic = Diagnostic::warning(message)
        .at(value)
        .effect("most of what it lights is white or a saturated colour")
        .help(format!(
            "the coefficients are those of 1, of the distance and of its square: write `attenuation {square}` to divide \
             by the square of the distance, or use a colour from 0 to 1"
        ));
    Some(Finding::from(diagnostic).affecting_whole_picture(true))
}

/// Returns a warning about the most visible material whose diffuse, reflective and transparent
/// colours add up to more than 1.
pub(super) fn energy_gain(scene_probe: &SceneProbe) -> Option<Diagnostic> {
    let bounces = scene_probe.input.job.settings.bounces > 0;
    let sum = |phong: &Phong| {
        let glass = if phong.fresnel { Color::ZERO } else { phong.transparent };
        (phong.diffuse + phong.reflective + glass).max_element()
    };
    let adds = |phong: &Phong| phong.reflective != Color::ZERO || phong.transparent != Color::ZERO;
    let too_much = phongs(scene_probe).filter(|(_, _, phong)| bounces && adds(phong) && sum(phong) > 1.05);
    let (i, material, phong) =
        too_much.max_by_key(|(i, ..)| rays(scene_probe, *i)).filter(|(i, ..)| rays(scene_probe, *i) > 0)?;
    let message = format!(
        "material {i} reflects and transmits {} times the light that it receives: its diffuse, reflected and \
         transmitted fractions add up to more than 1",
        super::finding::number(sum(phong))
    );
    let diagnostic = Diagnostic::warning(message).help("reduce the fractions until their sum is at most 1");
    Some(scene_probe.at_value(
        diagnostic,
        material.span,
        &["reflectiveColor", "transparentColor", "specularColor", "specular"],
    ))
}

/// Returns the span of the background in the scene file, or `None` if the file has none.
pub(super) fn background_span(scene_probe: &SceneProbe) -> Option<Span> {
    Some(scene_probe.input.scene.background_span).filter(|span| span.has_position())
}

/// Reports colours with negative channels.
pub(super) fn negative(scene_probe: &SceneProbe) -> Vec<Finding> {
    let below = |named: &ColorField| named.color.min_element() < 0.0;
    let say = |ColorField { color, block, fields, .. }: ColorField| {
        let mended = color.abs();
        let diagnostic = Diagnostic::warning(format!("the colour {} is below zero", vector(color)))
            .effect("a negative colour subtracts light, so surfaces become darker or black")
            .help(format!("colours range from 0 to 1: write `{}`", vector(mended)));
        let diagnostic = match scene_probe.field_span(block, &fields) {
            Some(place) => diagnostic.at(place).fix(place, vector(mended)),
            None => diagnostic.at(block),
        };
        Finding::from(diagnostic)
    };
    let background = &scene_probe.input.scene.background;
    let own = |color: Color, field: &'static str, nodes: &'static str| {
        Some(ColorField { color, block: background_span(scene_probe)?, fields: [field, nodes], most: 1.0 })
    };
    let own = [own(background.color, "color", "color"), own(background.ambient_light, "ambientLight", "ambient_light")];
    let all = all_colors(scene_probe).into_iter().chain(own.into_iter().flatten());
    all.filter(below).take(MAX_FINDINGS).map(say).collect()
}

/// Reports objects with the same colour as the background.
pub(super) fn background_colored(scene_probe: &SceneProbe) -> Vec<Finding> {
    let world = scene_probe.world();
    if world.cube_map().is_some() {
        return Vec::new();
    }
    let shown = |color: Color| color.clamp(Color::ZERO, Color::ONE);
    let alike = |color: Color| (shown(color) - shown(world.background())).abs().max_element() < SAME_COLOR;
    let mut hit = scene_probe.hits().peekable();
    if hit.peek().is_none() || !hit.all(|(probe, _)| alike(probe.color)) {
        return lost_in_background(scene_probe, &alike);
    }
    let black = shown(world.background()).max_element() < SAME_COLOR;
    let diagnostic = Diagnostic::warning("everything visible has the colour of the background");
    let diagnostic = match background_span(scene_probe) {
        Some(block) => scene_probe.at_value(diagnostic, block, &["color"]),
        None => diagnostic,
    };
    let diagnostic = diagnostic.effect("no object stands out from the background").help(match black {
        true => "light the objects, or choose another background colour to show at least the outlines",
        false => "choose another `color` for the background, or for the materials",
    });
    let finding = Finding::from(diagnostic);
    // If no light arrives, that is the cause, and this finding is only a consequence.
    vec![if black { finding.only_describing() } else { finding.affecting_whole_picture(true) }]
}

/// Reports objects if all of their visible pixels have exactly the background's colour.
fn lost_in_background(scene_probe: &SceneProbe, alike: &dyn Fn(Color) -> bool) -> Vec<Finding> {
    let world = scene_probe.world();
    if world.background().max_element() < 0.02 || scene_probe.is_physical() {
        return Vec::new();
    }
    let say = |(number, object): (usize, &durer_render::world::Object)| {
        let mut own = scene_probe.hits().filter(|(_, hit)| hit.object as usize == number).peekable();
        // A mirror may be showing the background.
        let Material::Phong(phong) = world.materials().get(object.material as usize)? else { return None };
        let own_color = phong.reflective == Color::ZERO && phong.transparent == Color::ZERO && phong.texture.is_none();
        own.peek()?;
        let count = scene_probe.hits().filter(|(_, hit)| hit.object as usize == number).count();
        if !own_color || count < MIN_LOST_RAYS || !own.all(|(probe, _)| alike(probe.color)) {
            return None;
        }
        let material = scene_probe.input.scene.materials.get(object.material as usize)?;
        let diagnostic =
            Diagnostic::warning(format!("the {} has the colour of the background", scene_probe.object(number as u32)))
                .at(scene_probe.object_span(number as u32))
                .related(material.span, "the material of the object")
                .effect("the object does not stand out from the background")
                .help("choose another `color` for the background, or for the material");
        Some(Finding::from(diagnostic))
    };
    world.objects().iter().enumerate().filter_map(say).take(super::finding::MAX_PER_KIND).collect()
}
