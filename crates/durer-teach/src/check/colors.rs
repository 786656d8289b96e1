//! Checks colours for invisible or black materials and for values out of range.

use super::finding::{Finding, MAX_FINDINGS, counted, percent, vector};
use super::scene_probe::SceneProbe;
use durer_diag::{Diagnostic, Severity, Span};
use durer_render::world::{Geometry, Material, Phong};
use durer_scene::dialect::{Dialect, Quirk, SecondaryRays};
use durer_scene::light::{Illuminate as _, Light};
use durer_scene::material::Pattern;
use durer_scene::math::Color;
use durer_scene::scene::{Material as ParsedMaterial, ObjectKind, Spanned};

/// Materials that reflect less than this look black.
const BLACK: f32 = 0.01;
/// Colours that differ by less than this look the same.
const SAME_COLOR: f32 = 2.0 / 255.0;

/// Minimum number of rays that must hit an object before it can count as indistinguishable from the
/// background.
const MIN_LOST_RAYS: usize = 6;

/// Iterates over the Phong materials. Each item has the index, the description in the scene file,
/// and the compiled material.
fn phongs<'s>(scene_probe: &'s SceneProbe) -> impl Iterator<Item = (u32, &'s Spanned<ParsedMaterial>, &'s Phong)> {
    let compiled = scene_probe.world().materials().iter();
    let both = scene_probe.input.scene.materials.iter().zip(compiled).enumerate();
    both.filter_map(|(i, (material, compiled))| match compiled {
        Material::Phong(phong) => Some((i as u32, material, phong)),
        Material::Mix(..) => None,
    })
}

/// Returns the number of rays that hit a material, either directly or as part of a mix.
fn rays(scene_probe: &SceneProbe, material: u32) -> usize {
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
        Finding::from(diagnostic).affecting_whole_picture(whole)
    };
    black.iter().take(MAX_FINDINGS).map(say).collect()
}

/// Reports mirrors and glass in a picture that is rendered without secondary rays.
pub(super) fn no_bounces(scene_probe: &SceneProbe) -> Vec<Finding> {
    if scene_probe.is_physical() {
        return super::optics::short_paths(scene_probe);
    }
    let settings = &scene_probe.input.job.settings;
    let old = scene_probe.world().rules().is_bit_compatible();
    let counts = |color: Color| if old { color.length() } else { color.max_element() };
    // A colour below the minimum throughput is never traced, not even at the first bounce.
    let cut = |phong: &Phong| counts(phong.reflective).max(counts(phong.transparent)) < settings.min_weight;
    let none = settings.bounces == 0;
    let bounces = |phong: &Phong| phong.reflective != Color::ZERO || phong.transparent != Color::ZERO;
    // If highlights and mirrors share one colour, it is meant as a mirror only if the material
    // would be black without reflection.
    let shared =
        matches!(scene_probe.world().rules().secondary, SecondaryRays::Specular | SecondaryRays::SpecularFresnel);
    let intended = |phong: &Phong| phong.fresnel || !shared || phong.diffuse.max_element() < 0.15;
    let all: Vec<_> = phongs(scene_probe)
        .filter(|(i, _, phong)| bounces(phong) && intended(phong) && rays(scene_probe, *i) > 0)
        .collect();
    let Some((i, material, phong)) = all.iter().find(|(.., phong)| none || cut(phong)) else {
        return switched_off(scene_probe, &all);
    };
    let diffuse = phong.diffuse.max_element();
    let what = if phong.transparent == Color::ZERO { "reflects light" } else { "transmits light" };
    let (message, help) = match none {
        true => (
            format!("material {i} {what}, but the maximum depth of secondary rays is 0"),
            "set `--bounces 4` (in the course's programs `-bounces 4`)".to_string(),
        ),
        false => (
            format!(
                "material {i} {what}, but its rays have a throughput of {}, and rays below {} are not traced",
                super::finding::number(counts(phong.reflective).max(counts(phong.transparent))),
                super::finding::number(settings.min_weight)
            ),
            "set a lower limit, such as `--min-throughput 0.01` (in the course's programs `-weight 0.01`)".to_string(),
        ),
    };
    let diagnostic = Diagnostic::warning(message)
        .at(material.span)
        .effect(if diffuse < 0.15 {
            "the material is black, or nearly black"
        } else {
            "only the diffuse colour is visible"
        })
        .help(help);
    // If the dialect's program traces no secondary rays by default, their absence is intentional.
    let hit: usize = all.iter().map(|(i, ..)| rays(scene_probe, *i)).sum();
    let black: usize =
        all.iter().filter(|(.., phong)| phong.diffuse.max_element() < 0.1).map(|(i, ..)| rays(scene_probe, *i)).sum();
    let usual = none && scene_probe.world().rules().bounces == 0 && black * 10 < scene_probe.hits().count();
    let whole = !usual && hit * 2 > scene_probe.hits().count();
    let finding = Finding::from(if usual { Diagnostic { severity: Severity::Note, ..diagnostic } } else { diagnostic });
    vec![finding.affecting_whole_picture(whole)]
}

/// Reports mirrors and glass objects whose secondary rays are disabled by the options or are ended
/// by the depth limit inside the object.
fn switched_off(scene_probe: &SceneProbe, all: &[(u32, &Spanned<ParsedMaterial>, &Phong)]) -> Vec<Finding> {
    let settings = &scene_probe.input.job.settings;
    let dark = |phong: &Phong| phong.diffuse.max_element() < 0.15;
    let is_glass = |phong: &Phong| phong.transparent != Color::ZERO;
    let say = |(i, material, phong): &(u32, &Spanned<ParsedMaterial>, &Phong)| {
        let (message, help) = match is_glass(phong) {
            false if !settings.reflection => {
                (format!("material {i} reflects light, but reflected rays are disabled"), "remove `--no-reflection`")
            }
            true if !settings.refraction => {
                (format!("material {i} transmits light, but refracted rays are disabled"), "remove `--no-refraction`")
            }
            // Light needs one bounce to enter an object and one to leave it.
            true if settings.bounces == 1 && phong.ior != 1.0 && dark(phong) => (
                format!(
                    "material {i} is glass, but the maximum depth of secondary rays is 1, so light cannot leave the \
                     glass"
                ),
                "set `--bounces 4` (in the course's programs `-bounces 4`)",
            ),
            _ => return None,
        };
        let effect =
            if dark(phong) { "the material is black, or nearly black" } else { "only the diffuse colour is visible" };
        Some(Finding::from(Diagnostic::warning(message).at(material.span).effect(effect).help(help)))
    };
    all.iter().filter_map(say).take(1).collect()
}

/// Reports an index of refraction that no glass has.
pub(super) fn odd_index(scene_probe: &SceneProbe) -> Vec<Finding> {
    let mut findings = super::layers::odd_index(scene_probe);
    let fields = ["indexOfRefraction", "refractionIndex"];
    for (i, material, phong) in phongs(scene_probe).filter(|(i, ..)| rays(scene_probe, *i) > 0).take(MAX_FINDINGS) {
        let ParsedMaterial::Phong(own, _) = &material.value else { continue };
        let dark = phong.diffuse.max_element() < 0.3 && phong.texture.is_none();
        if own.refraction_index == Some(0.0)
            && dark
            && scene_probe.field_span(material.span, &["refractionIndex"]).is_some()
        {
            let diagnostic = Diagnostic::warning(format!("material {i} has an index of refraction of 0"))
                .effect(
                    "this year's program does not treat the material as glass, so it transmits no light and reflects \
                     by its `specularColor`",
                )
                .help("write 1.5 for glass or 1.33 for water; for a mirror, remove `refractionIndex`");
            findings.push(Finding::from(scene_probe.at_value(diagnostic, material.span, &fields)));
        }
        if phong.transparent.max_element() <= 0.0 {
            continue;
        }
        let ior = own.index_of_refraction.or(own.refraction_index);
        let index = super::finding::number(ior.unwrap_or(phong.ior));
        let seen_itself = phong.diffuse + phong.reflective;
        let diagnostic = Diagnostic::warning(format!("material {i} has an index of refraction of {index}"));
        let diagnostic = match ior {
            _ if phong.ior > 4.0 || phong.ior < 0.5 => diagnostic
                .effect("no real material has such an index, and this material transmits hardly any light")
                .help(
                    "write 1.33 for water, 1.5 for glass or 2.4 for diamond; the value is the index inside, with 1 \
                     outside",
                ),
            Some(_) if phong.ior < 0.95 => {
                diagnostic.effect("light is refracted the wrong way, as in an air bubble in glass").help(format!(
                    "the value is the index inside, with 1 outside: 1 / {index} is {}; water has 1.33, glass 1.5",
                    super::finding::number(1.0 / phong.ior)
                ))
            }
            Some(_) if (phong.ior - 1.0).abs() < 1e-3 => {
                let unseen = phong.fresnel || seen_itself.max_element() < 0.1 && phong.transparent.min_element() > 0.9;
                let severity = if unseen { Severity::Warning } else { Severity::Note };
                Diagnostic { severity, ..diagnostic }
                    .effect(match unseen {
                        true => "light passes straight through without reflection, so the object is hardly visible",
                        false => "light passes straight through without refraction",
                    })
                    .help("write 1.33 for water, 1.5 for glass or 2.4 for diamond")
            }
            // An index of 1 without Fresnel reflection is correct for coloured foil.
            None if phong.ior == 1.0 && !phong.fresnel => Diagnostic::note(format!(
                "material {i} transmits light but has no `{}`",
                if scene_probe.world().rules().secondary == SecondaryRays::Colors { fields[0] } else { fields[1] }
            ))
            .effect("light passes straight through without refraction, as through foil")
            .help("write 1.5 for glass or 1.33 for water"),
            _ => continue,
        };
        findings.push(Finding::from(scene_probe.at_value(diagnostic, material.span, &fields)));
    }
    findings
}

/// A colour of a light, material or background, and the place where the scene file sets it.
struct ColorField {
    color: Color,
    block: Span,
    fields: [&'static str; 2],
    /// Largest plausible value of a colour channel.
    most: f32,
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
        let (fades, candela) = match light {
            Light::Directional(_) => (false, false),
            Light::Point(point) => (point.attenuation.is_some(), false),
            Light::Spot(_) | Light::Photometric(_) => (true, true),
        };
        let arrives =
            scene_probe.hits().filter_map(|(_, hit)| hit.contribution(number)).map(|lit| lit.unoccluded.max_element());
        let too_much = arrives.fold(0.0, f32::max) > 20.0;
        // Path tracing has no fixed unit of light because the exposure scales it.
        let free = candela || fades && !too_much || scene_probe.is_physical();
        let most = if free { f32::INFINITY } else { 20.0 };
        colors.push(ColorField { color: light.color(), block: material.span, fields: ["color", "color"], most });
    }
    colors
}

/// Reports colours whose channels range from 0 to 255.
pub(super) fn too_large(scene_probe: &SceneProbe) -> Vec<Finding> {
    let mut findings = Vec::new();
    let mut say = |color: Color, place: Option<Span>, block: Option<Span>| {
        // Whole numbers are probably byte values if some of them are large.
        let whole = color.to_array().iter().all(|c| c.fract() == 0.0);
        let bytes = whole && (20.0..=255.0).contains(&color.max_element());
        // Multiples of 5 up to 100 may also be percentages.
        let percent = bytes && color.max_element() <= 100.0 && color.to_array().iter().all(|c| c % 5.0 == 0.0);
        let mended = if bytes { color / 255.0 } else { color / color.max_element() };
        let far = color.max_element() > 2.0;
        let message = format!("the colour {} is {}above 1", vector(color), if far { "far " } else { "" });
        let diagnostic = Diagnostic::warning(message)
            .effect(match far {
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
                true => format!("colours range from 0 to 1, not to 255: write `{}`", vector(mended)),
                false => format!("colours range from 0 to 1: try `{}`", vector(mended)),
            });
        let diagnostic = match place {
            // Only byte values have an obvious correction.
            Some(place) if bytes && !percent => diagnostic.at(place).fix(place, vector(mended)),
            Some(place) => diagnostic.at(place),
            None => Diagnostic { span: block, ..diagnostic },
        };
        findings.push(Finding::from(diagnostic).affecting_whole_picture(far));
    };
    let beyond = all_colors(scene_probe).into_iter().filter(|field| field.color.max_element() > field.most);
    for ColorField { color, block, fields, .. } in beyond.take(MAX_FINDINGS) {
        let written =
            scene_probe.model_format().and_then(|_| super::written::place_of_color(scene_probe, block, color));
        say(color, written.or_else(|| scene_probe.field_span(block, &fields)), Some(block));
    }
    let background = &scene_probe.input.scene.background;
    for (color, fields) in
        [(background.color, ["color", "color"]), (background.ambient_light, ["ambientLight", "ambient_light"])]
    {
        if color.max_element() > 2.0 && !scene_probe.is_physical() {
            let block = background_span(scene_probe);
            say(color, block.and_then(|block| scene_probe.field_span(block, &fields)), block);
        }
    }
    findings
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

/// Reports glass whose colour absorbs all light, in dialects in which that colour scales reflection
/// and transmission.
pub(super) fn opaque_glass(scene_probe: &SceneProbe) -> Vec<Finding> {
    if scene_probe.is_physical() {
        return super::layers::opaque_glass(scene_probe);
    }
    if scene_probe.world().rules().secondary != SecondaryRays::SpecularFresnel {
        return dull_by_color(scene_probe);
    }
    let dull = |(i, material, _): &(u32, &Spanned<ParsedMaterial>, &Phong)| match &material.value {
        ParsedMaterial::Phong(phong, _) => {
            phong.refraction_index.is_some_and(|index| index > 0.0)
                && phong.specular_color == Color::ZERO
                && rays(scene_probe, *i) > 0
        }
        _ => false,
    };
    let say = |(i, material, _): (u32, &Spanned<ParsedMaterial>, &Phong)| {
        let diagnostic = Diagnostic::warning(format!("material {i} is glass that transmits no light"))
            .effect(
                "this year's program scales reflection and transmission of glass by `specularColor`, which is black",
            )
            .help("for clear glass, write `specularColor 1 1 1`");
        Finding::from(scene_probe.at_value(diagnostic, material.span, &["specularColor", "refractionIndex"]))
    };
    phongs(scene_probe).filter(dull).take(MAX_FINDINGS).map(say).collect()
}

/// Reports glass that has an index of refraction but no transmission colour.
fn dull_by_color(scene_probe: &SceneProbe) -> Vec<Finding> {
    let dull = |(i, material, phong): &(u32, &Spanned<ParsedMaterial>, &Phong)| match &material.value {
        ParsedMaterial::Phong(own, _) => {
            let index = own.index_of_refraction.or(own.refraction_index).unwrap_or(1.0);
            let opaque = own.transparent_color == Color::ZERO && !phong.fresnel;
            let dark = phong.diffuse.max_element() < 0.15 && phong.texture.is_none() && phong.noise.is_none();
            opaque
                && dark
                && !(0.999..=1.001).contains(&index)
                && own.refraction_index != Some(0.0)
                && rays(scene_probe, *i) > 0
        }
        _ => false,
    };
    let say = |(i, material, _): (u32, &Spanned<ParsedMaterial>, &Phong)| {
        let diagnostic = Diagnostic::warning(format!(
            "material {i} has the index of refraction of glass, but \
                                                      transmits no light"
        ))
        .effect("`transparentColor` is black, so objects with this material are dark and opaque")
        .help(
            "increase `transparentColor`, the fraction of light that the material transmits; for example, `0.9 0.9 \
             0.9` is clear",
        );
        Finding::from(scene_probe.at_value(diagnostic, material.span, &["transparentColor", "indexOfRefraction"]))
    };
    phongs(scene_probe).filter(dull).take(MAX_FINDINGS).map(say).collect()
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

/// Reports textured objects without texture coordinates.
pub(super) fn no_coordinates(scene_probe: &SceneProbe) -> Vec<Finding> {
    let meshes_only = scene_probe.world().rules().has(Quirk::MeshTextures);
    let textured = phongs(scene_probe).filter(|(_, _, phong)| phong.texture.is_some());
    let mut findings = Vec::new();
    for (i, material, phong) in textured {
        let bare = scene_probe.hits().find(|(_, hit)| hit.material == i && !hit.has_uv);
        if let Some((_, hit)) = bare {
            let name = scene_probe.object(hit.object);
            let diagnostic =
                Diagnostic::warning(format!("material {i} has a texture, but the {name} has no texture coordinates"))
                    .related(scene_probe.object_span(hit.object), "uses the material")
                    .effect(match phong.principled {
                        Some(_) => "the texture is invisible; `baseColor` is used instead",
                        None => "the texture is invisible; `diffuseColor` is used instead",
                    })
                    .help(match (&scene_probe.world().objects()[hit.object as usize].geometry, meshes_only) {
                        (Geometry::Mesh(_), _) => "add `vt` lines to the mesh file, and write faces as `f 1/1 2/2 3/3`",
                        (_, true) => {
                            "this year's program shows textures on meshes only: use a `TriangleMesh` with `vt` lines"
                        }
                        (_, false) => "use a shape with texture coordinates, or a `TriangleMesh` with `vt` lines",
                    });
            findings.push(Finding::from(scene_probe.at_value(diagnostic, material.span, &["texture"])));
        }
    }
    findings
}

/// Reports materials that no object uses.
pub(super) fn unused(scene_probe: &SceneProbe) -> Vec<Finding> {
    let world = scene_probe.world();
    let mut used = vec![false; world.materials().len()];
    for object in world.objects() {
        match &object.geometry {
            Geometry::Solid(solid) => solid.parts().for_each(|part| used[part.material as usize] = true),
            _ => used[object.material as usize] = true,
        }
    }
    // A mix refers only to materials that precede it, so the loop runs backwards.
    for i in (0..world.materials().len()).rev() {
        if let (Material::Mix(solid, ..), true) = (&world.materials()[i], used[i]) {
            solid.materials().into_iter().for_each(|part| used[part as usize] = true);
        }
    }
    // Empty solids have no compiled parts.
    for object in scene_probe.input.scene.objects() {
        let of_parts = matches!(object.node, ObjectKind::Group(_) | ObjectKind::Transform(..) | ObjectKind::Solid(..));
        if let Some(used) = object.material.filter(|_| !of_parts).and_then(|material| used.get_mut(material as usize)) {
            *used = true;
        }
    }
    let material = &scene_probe.input.scene.materials;
    let unused: Vec<usize> = (0..material.len()).filter(|&i| !used[i]).collect();
    let Some(&first) = unused.first() else { return Vec::new() };
    let list: Vec<String> = unused.iter().take(8).map(ToString::to_string).collect();
    let message = match unused.len() {
        1 => format!("no object uses material {first}"),
        n => format!("no object uses {}: {}", counted(n, "material", "materials"), list.join(", ")),
    };
    let diagnostic = Diagnostic::note(message)
        .at(material[first].span)
        .effect("unused materials have no effect on the picture")
        .help(match scene_probe.input.dialect {
            Dialect::F23 => "check the `index` of each `Component<Material>`: indices start at 0",
            _ => "check each `MaterialIndex`: indices start at 0",
        });
    vec![Finding::from(diagnostic)]
}
