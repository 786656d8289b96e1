//! Checks of colours: invisible or black materials, and values out of range.

use super::finding::{Finding, MAX_SOUGHT, counted, percent, vector};
use super::scene_probe::SceneProbe;
use durer_diag::{Diagnostic, Severity, Span};
use durer_render::world::{Geometry, Material, Phong};
use durer_scene::dialect::{Dialect, Quirk, SecondaryRays};
use durer_scene::light::{Illuminate as _, Light};
use durer_scene::material::Pattern;
use durer_scene::math::Color;
use durer_scene::scene::{Material as Written, Spanned};

/// Materials that reflect less than this look black.
const BLACK: f32 = 0.01;
/// Colours that differ by less than this look the same.
const ALIKE: f32 = 2.0 / 255.0;

/// Minimum number of rays that must hit an object before it can count as lost in the background.
const FEWEST_LOST: usize = 6;

/// Iterates over the Phong materials: index, description in the scene file, and compiled material.
fn phongs<'s>(scout: &'s SceneProbe) -> impl Iterator<Item = (u32, &'s Spanned<Written>, &'s Phong)> {
    let compiled = scout.world().materials().iter();
    let both = scout.subject.scene.materials.iter().zip(compiled).enumerate();
    both.filter_map(|(i, (written, compiled))| match compiled {
        Material::Phong(phong) => Some((i as u32, written, phong)),
        Material::Mix(..) => None,
    })
}

/// Returns the number of rays that hit a material, directly or as part of a mix.
fn rays(scout: &SceneProbe, material: u32) -> usize {
    scout.material_rays()[material as usize]
}

/// Returns true if no visible material reflects any light.
pub(super) fn all_black(scout: &SceneProbe) -> bool {
    let shows = |(i, _, phong): (u32, &Spanned<Written>, &Phong)| !is_black(phong) && rays(scout, i) > 0;
    scout.seen().next().is_some() && !phongs(scout).any(shows)
}

fn is_black(phong: &Phong) -> bool {
    let shown = phong.reflective + phong.transparent + phong.highlight.map_or(Color::ZERO, |h| h.0);
    phong.diffuse.max_element() < BLACK
        && phong.texture.is_none()
        && phong.noise.is_none()
        && shown.max_element() < BLACK
}

/// Reports materials that reflect no light.
pub(super) fn black(scout: &SceneProbe) -> Vec<Finding> {
    if scout.is_physical() {
        return super::layers::black(scout);
    }
    let all = scout.seen().count();
    let whole = all_black(scout);
    // Part of a pattern may be black, but not all of it.
    let shown = |i: u32| if whole { rays(scout, i) > 0 } else { scout.seen().any(|(_, seen)| seen.material == i) };
    let black: Vec<_> = phongs(scout).filter(|(i, _, phong)| is_black(phong) && shown(*i)).collect();
    let say = |(i, written, _): &(u32, &Spanned<Written>, &Phong)| {
        let diagnostic = Diagnostic::warning(format!("material {i} is black: it reflects no light"))
            .label(format!("on {} of the visible surfaces", percent(rays(scout, *i), all)))
            .effect("its objects are black under any light")
            .help(
                "`diffuseColor` is the fraction of light that the material reflects; for example, `0.8 0.8 0.8` \
                   is a light grey",
            );
        let diagnostic = scout.at_value(diagnostic, written.span, &["diffuseColor", "diffuse"]);
        Finding::from(diagnostic).whole(whole)
    };
    black.iter().take(MAX_SOUGHT).map(say).collect()
}

/// Reports mirrors and glass in a picture without secondary rays.
pub(super) fn no_bounces(scout: &SceneProbe) -> Vec<Finding> {
    if scout.is_physical() {
        return super::optics::short_paths(scout);
    }
    let settings = &scout.subject.job.settings;
    let old = scout.world().rules().is_bit_compatible();
    let counts = |color: Color| if old { color.length() } else { color.max_element() };
    // A colour below the minimum throughput is never traced, not even at the first bounce.
    let cut = |phong: &Phong| counts(phong.reflective).max(counts(phong.transparent)) < settings.min_weight;
    let none = settings.bounces == 0;
    let bounces = |phong: &Phong| phong.reflective != Color::ZERO || phong.transparent != Color::ZERO;
    // If highlights and mirrors share one colour, it is meant as a mirror only if the material
    // would be black without reflection.
    let shared = matches!(scout.world().rules().secondary, SecondaryRays::Specular | SecondaryRays::SpecularFresnel);
    let intended = |phong: &Phong| phong.fresnel || !shared || phong.diffuse.max_element() < 0.15;
    let all: Vec<_> =
        phongs(scout).filter(|(i, _, phong)| bounces(phong) && intended(phong) && rays(scout, *i) > 0).collect();
    let Some((i, written, phong)) = all.iter().find(|(.., phong)| none || cut(phong)) else {
        return switched_off(scout, &all);
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
            "lower this limit: `--min-throughput 0.01` (in the course's programs `-weight 0.01`)".to_string(),
        ),
    };
    let diagnostic = Diagnostic::warning(message)
        .at(written.span)
        .effect(if diffuse < 0.15 { "it is black, or nearly black" } else { "only its diffuse colour is visible" })
        .help(help);
    // If the dialect's program traces no secondary rays by default, their absence is intentional.
    let seen: usize = all.iter().map(|(i, ..)| rays(scout, *i)).sum();
    let black: usize =
        all.iter().filter(|(.., phong)| phong.diffuse.max_element() < 0.1).map(|(i, ..)| rays(scout, *i)).sum();
    let usual = none && scout.world().rules().bounces == 0 && black * 10 < scout.seen().count();
    let whole = !usual && seen * 2 > scout.seen().count();
    let finding = Finding::from(if usual { Diagnostic { severity: Severity::Note, ..diagnostic } } else { diagnostic });
    vec![finding.whole(whole)]
}

/// Reports mirrors and glass objects whose secondary rays are disabled by the options, or
/// terminated inside the object by the depth limit.
fn switched_off(scout: &SceneProbe, all: &[(u32, &Spanned<Written>, &Phong)]) -> Vec<Finding> {
    let settings = &scout.subject.job.settings;
    let dark = |phong: &Phong| phong.diffuse.max_element() < 0.15;
    let is_glass = |phong: &Phong| phong.transparent != Color::ZERO;
    let say = |(i, written, phong): &(u32, &Spanned<Written>, &Phong)| {
        let (message, help) = match is_glass(phong) {
            false if !settings.reflection => {
                (format!("material {i} reflects light, but reflected rays are disabled"), "remove `--no-reflection`")
            }
            true if !settings.refraction => {
                (format!("material {i} transmits light, but refracted rays are disabled"), "remove `--no-refraction`")
            }
            // Light needs one bounce to enter and one to leave.
            true if settings.bounces == 1 && phong.ior != 1.0 && dark(phong) => (
                format!("material {i} is glass, but the maximum depth of secondary rays is 1: light cannot leave it"),
                "set `--bounces 4` (in the course's programs `-bounces 4`)",
            ),
            _ => return None,
        };
        let effect = if dark(phong) { "it is black, or nearly black" } else { "only its diffuse colour is visible" };
        Some(Finding::from(Diagnostic::warning(message).at(written.span).effect(effect).help(help)))
    };
    all.iter().filter_map(say).take(1).collect()
}

/// Reports an index of refraction that no glass has.
pub(super) fn odd_index(scout: &SceneProbe) -> Vec<Finding> {
    let mut found = super::layers::odd_index(scout);
    let fields = ["indexOfRefraction", "refractionIndex"];
    for (i, written, phong) in phongs(scout).filter(|(i, ..)| rays(scout, *i) > 0).take(MAX_SOUGHT) {
        let Written::Phong(own, _) = &written.value else { continue };
        let dark = phong.diffuse.max_element() < 0.3 && phong.texture.is_none();
        if own.refraction_index == Some(0.0) && dark && scout.value(written.span, &["refractionIndex"]).is_some() {
            let diagnostic = Diagnostic::warning(format!("material {i} has an index of refraction of 0"))
                .effect(
                    "this year's program does not treat it as glass: it transmits no light, and reflects by \
                         its `specularColor`",
                )
                .help("glass has 1.5, water 1.33; for a mirror remove `refractionIndex`");
            found.push(Finding::from(scout.at_value(diagnostic, written.span, &fields)));
        }
        if phong.transparent.max_element() <= 0.0 {
            continue;
        }
        let given = own.index_of_refraction.or(own.refraction_index);
        let index = super::finding::number(given.unwrap_or(phong.ior));
        let seen_itself = phong.diffuse + phong.reflective;
        let diagnostic = Diagnostic::warning(format!("material {i} has an index of refraction of {index}"));
        let diagnostic = match given {
            _ if phong.ior > 4.0 || phong.ior < 0.5 => diagnostic
                .effect("no real material refracts like this, and it transmits hardly any light")
                .help("water has 1.33, glass 1.5, diamond 2.4; the value is the index inside, with 1 outside"),
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
                    .help("water has 1.33, glass 1.5, diamond 2.4")
            }
            // An index of 1 without Fresnel reflection is correct for coloured foil.
            None if phong.ior == 1.0 && !phong.fresnel => Diagnostic::note(format!(
                "material {i} transmits light but has no `{}`",
                if scout.world().rules().secondary == SecondaryRays::Colors { fields[0] } else { fields[1] }
            ))
            .effect("light passes straight through without refraction, as through foil")
            .help("glass has 1.5, water 1.33"),
            _ => continue,
        };
        found.push(Finding::from(scout.at_value(diagnostic, written.span, &fields)));
    }
    found
}

/// A colour of a light, material or background, and the place where the scene file sets it.
struct ColorField {
    color: Color,
    block: Span,
    fields: [&'static str; 2],
    /// Largest plausible value of a channel.
    most: f32,
}

fn all_colors(scout: &SceneProbe) -> Vec<ColorField> {
    let mut colors = Vec::new();
    for (i, written, used) in phongs(scout) {
        let Written::Phong(phong, _) = &written.value else { continue };
        // A surface reflects at most the light it receives, but a small bright object may represent
        // a light.
        let small = rays(scout, i) * 25 < scout.probes.len();
        let named = |color, fields, most: f32| {
            let most = if small { most.max(15.0) } else { most };
            ColorField { color, block: written.span, fields, most }
        };
        colors.extend(phong.diffuse_color.map(|color| named(color, ["diffuseColor", "diffuse"], 1.001)));
        let all = |color, fields, most: f32| ColorField { color, block: written.span, fields, most };
        // A highlight may be slightly brighter than white; a mirror reflects at most the light it
        // receives.
        let mirrors = used.reflective != Color::ZERO && phong.reflective_color == Color::ZERO;
        colors.push(all(phong.specular_color, ["specularColor", "specular"], if mirrors { 1.05 } else { 1.6 }));
        colors.push(all(phong.reflective_color, ["reflectiveColor", "reflectiveColor"], 1.001));
        colors.push(all(phong.transparent_color, ["transparentColor", "transparentColor"], 1.001));
    }
    for written in &scout.subject.scene.materials {
        let Written::Principled(m) = &written.value else { continue };
        let shares = [
            (m.base_color, "baseColor"),
            (m.transmission_color, "transmissionColor"),
            (m.subsurface_color, "subsurfaceColor"),
            (m.coat_color, "coatColor"),
            (m.fuzz_color, "fuzzColor"),
        ];
        // Presets of measured metals slightly exceed 1.
        colors.extend(shares.map(|(color, field)| ColorField {
            color,
            block: written.span,
            fields: [field, field],
            most: 1.1,
        }));
    }
    for (number, (written, light)) in
        scout.subject.scene.lights.iter().flatten().zip(scout.world().lights()).enumerate()
    {
        // A light with attenuation may be strong if not too much of its light arrives. Lights in
        // candela rarely have values near 1.
        let (fades, candela) = match light {
            Light::Directional(_) => (false, false),
            Light::Point(point) => (point.attenuation.is_some(), false),
            Light::Spot(_) | Light::Photometric(_) => (true, true),
        };
        let arrives = scout.seen().filter_map(|(_, seen)| seen.by(number)).map(|lit| lit.arrives.max_element());
        let too_much = arrives.fold(0.0, f32::max) > 20.0;
        // Path tracing has no fixed unit of light: the exposure scales it.
        let free = candela || fades && !too_much || scout.is_physical();
        let most = if free { f32::INFINITY } else { 20.0 };
        colors.push(ColorField { color: light.color(), block: written.span, fields: ["color", "color"], most });
    }
    colors
}

/// Reports colours from 0 to 255.
pub(super) fn too_large(scout: &SceneProbe) -> Vec<Finding> {
    let mut found = Vec::new();
    let mut say = |color: Color, place: Option<Span>, block: Option<Span>| {
        // Whole numbers, some of them large, are probably bytes.
        let whole = color.to_array().iter().all(|c| c.fract() == 0.0);
        let bytes = whole && (20.0..=255.0).contains(&color.max_element());
        // Multiples of 5 up to 100 may also be percent.
        let percent = bytes && color.max_element() <= 100.0 && color.to_array().iter().all(|c| c % 5.0 == 0.0);
        let mended = if bytes { color / 255.0 } else { color / color.max_element() };
        let far = color.max_element() > 2.0;
        let message = format!("the colour {} is {}above 1", vector(color), if far { "far " } else { "" });
        let diagnostic = Diagnostic::warning(message)
            .effect(match far {
                true => "it is white or a saturated colour under any light",
                false => "it reflects more light than it receives: bright parts are clipped and lose their shading",
            })
            .help(match bytes {
                true if percent => format!(
                    "colours range from 0 to 1: write `{}` if this is in percent, or `{}` if it is in bytes",
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
        found.push(Finding::from(diagnostic).whole(far));
    };
    let beyond = all_colors(scout).into_iter().filter(|named| named.color.max_element() > named.most);
    for ColorField { color, block, fields, .. } in beyond.take(MAX_SOUGHT) {
        say(color, scout.value(block, &fields), Some(block));
    }
    let background = &scout.subject.scene.background;
    for (color, fields) in
        [(background.color, ["color", "color"]), (background.ambient_light, ["ambientLight", "ambient_light"])]
    {
        if color.max_element() > 2.0 && !scout.is_physical() {
            let block = background_span(scout);
            say(color, block.and_then(|block| scout.value(block, &fields)), block);
        }
    }
    found
}

/// Returns a warning for the most visible material whose diffuse, reflective and transparent
/// colours add up to more than 1.
pub(super) fn gives_too_much(scout: &SceneProbe) -> Option<Diagnostic> {
    let bounces = scout.subject.job.settings.bounces > 0;
    let sum = |phong: &Phong| {
        let glass = if phong.fresnel { Color::ZERO } else { phong.transparent };
        (phong.diffuse + phong.reflective + glass).max_element()
    };
    let adds = |phong: &Phong| phong.reflective != Color::ZERO || phong.transparent != Color::ZERO;
    let too_much = phongs(scout).filter(|(_, _, phong)| bounces && adds(phong) && sum(phong) > 1.05);
    let (i, written, phong) = too_much.max_by_key(|(i, ..)| rays(scout, *i)).filter(|(i, ..)| rays(scout, *i) > 0)?;
    let message = format!(
        "material {i} reflects and transmits {} times the light that it receives: its diffuse, reflected and \
         transmitted shares add up to more than 1",
        super::finding::number(sum(phong))
    );
    let diagnostic = Diagnostic::warning(message).help("reduce them until their sum is at most 1");
    Some(scout.at_value(
        diagnostic,
        written.span,
        &["reflectiveColor", "transparentColor", "specularColor", "specular"],
    ))
}

/// Reports glass whose colour absorbs all light, in dialects where that colour scales reflection
/// and transmission.
pub(super) fn dull_glass(scout: &SceneProbe) -> Vec<Finding> {
    if scout.is_physical() {
        return super::layers::dull_glass(scout);
    }
    if scout.world().rules().secondary != SecondaryRays::SpecularFresnel {
        return dull_by_color(scout);
    }
    let dull = |(i, written, _): &(u32, &Spanned<Written>, &Phong)| match &written.value {
        Written::Phong(phong, _) => {
            phong.refraction_index.is_some_and(|index| index > 0.0)
                && phong.specular_color == Color::ZERO
                && rays(scout, *i) > 0
        }
        _ => false,
    };
    let say = |(i, written, _): (u32, &Spanned<Written>, &Phong)| {
        let diagnostic = Diagnostic::warning(format!("material {i} is glass that transmits no light"))
            .effect(
                "this year's program scales reflection and transmission of glass by `specularColor`, which is black",
            )
            .help("for clear glass, write `specularColor 1 1 1`");
        Finding::from(scout.at_value(diagnostic, written.span, &["specularColor", "refractionIndex"]))
    };
    phongs(scout).filter(dull).take(MAX_SOUGHT).map(say).collect()
}

/// Reports glass with an index of refraction but no transmission colour.
fn dull_by_color(scout: &SceneProbe) -> Vec<Finding> {
    let dull = |(i, written, phong): &(u32, &Spanned<Written>, &Phong)| match &written.value {
        Written::Phong(own, _) => {
            let index = own.index_of_refraction.or(own.refraction_index).unwrap_or(1.0);
            let opaque = own.transparent_color == Color::ZERO && !phong.fresnel;
            let dark = phong.diffuse.max_element() < 0.15 && phong.texture.is_none() && phong.noise.is_none();
            opaque
                && dark
                && !(0.999..=1.001).contains(&index)
                && own.refraction_index != Some(0.0)
                && rays(scout, *i) > 0
        }
        _ => false,
    };
    let say = |(i, written, _): (u32, &Spanned<Written>, &Phong)| {
        let diagnostic = Diagnostic::warning(format!(
            "material {i} has the index of refraction of glass, but \
                                                      transmits no light"
        ))
        .effect("its `transparentColor` is black: its objects are dark and opaque")
        .help(
            "`transparentColor` is the fraction of light that the material transmits; for example, `0.9 0.9 \
                   0.9` is clear",
        );
        Finding::from(scout.at_value(diagnostic, written.span, &["transparentColor", "indexOfRefraction"]))
    };
    phongs(scout).filter(dull).take(MAX_SOUGHT).map(say).collect()
}

/// Returns the span of the `Background` section, which the compiled scene does not store.
pub(super) fn background_span(scout: &SceneProbe) -> Option<Span> {
    let file = scout.subject.scene.camera_span.file;
    durer_formats::course::place::section(scout.subject.files.bytes(file)?, file, "Background")
}

/// Reports colours below zero.
pub(super) fn negative(scout: &SceneProbe) -> Vec<Finding> {
    let below = |named: &ColorField| named.color.min_element() < 0.0;
    let say = |ColorField { color, block, fields, .. }: ColorField| {
        let mended = color.abs();
        let diagnostic = Diagnostic::warning(format!("the colour {} is below zero", vector(color)))
            .effect("it subtracts light: surfaces become darker, or black")
            .help(format!("colours range from 0 to 1: write `{}`", vector(mended)));
        let diagnostic = match scout.value(block, &fields) {
            Some(place) => diagnostic.at(place).fix(place, vector(mended)),
            None => diagnostic.at(block),
        };
        Finding::from(diagnostic)
    };
    let background = &scout.subject.scene.background;
    let own = |color: Color, field: &'static str, nodes: &'static str| {
        Some(ColorField { color, block: background_span(scout)?, fields: [field, nodes], most: 1.0 })
    };
    let own = [own(background.color, "color", "color"), own(background.ambient_light, "ambientLight", "ambient_light")];
    let all = all_colors(scout).into_iter().chain(own.into_iter().flatten());
    all.filter(below).take(MAX_SOUGHT).map(say).collect()
}

/// Reports objects with the same colour as the background.
pub(super) fn camouflaged(scout: &SceneProbe) -> Vec<Finding> {
    let world = scout.world();
    if world.cube_map().is_some() {
        return Vec::new();
    }
    let shown = |color: Color| color.clamp(Color::ZERO, Color::ONE);
    let alike = |color: Color| (shown(color) - shown(world.background())).abs().max_element() < ALIKE;
    let mut seen = scout.seen().peekable();
    if seen.peek().is_none() || !seen.all(|(probe, _)| alike(probe.color)) {
        return lost_in_background(scout, &alike);
    }
    let black = shown(world.background()).max_element() < ALIKE;
    let diagnostic = Diagnostic::warning("everything visible has the colour of the background");
    let diagnostic = match background_span(scout) {
        Some(block) => scout.at_value(diagnostic, block, &["color"]),
        None => diagnostic,
    };
    let diagnostic = diagnostic.effect("no object stands out from the background").help(match black {
        true => "nothing is lit; another background colour would at least show the outlines",
        false => "choose another `color` for the background, or for the materials",
    });
    let finding = Finding::from(diagnostic);
    // If no light arrives, that is the cause, and this finding only follows from it.
    vec![if black { finding.last() } else { finding.whole(true) }]
}

/// Reports objects all of whose visible pixels have exactly the background's colour.
fn lost_in_background(scout: &SceneProbe, alike: &dyn Fn(Color) -> bool) -> Vec<Finding> {
    let world = scout.world();
    if world.background().max_element() < 0.02 || scout.is_physical() {
        return Vec::new();
    }
    let say = |(number, object): (usize, &durer_render::world::Object)| {
        let mut own = scout.seen().filter(|(_, seen)| seen.object as usize == number).peekable();
        // A mirror may show the background.
        let Material::Phong(phong) = world.materials().get(object.material as usize)? else { return None };
        let own_color = phong.reflective == Color::ZERO && phong.transparent == Color::ZERO && phong.texture.is_none();
        own.peek()?;
        let count = scout.seen().filter(|(_, seen)| seen.object as usize == number).count();
        if !own_color || count < FEWEST_LOST || !own.all(|(probe, _)| alike(probe.color)) {
            return None;
        }
        let written = scout.subject.scene.materials.get(object.material as usize)?;
        let diagnostic =
            Diagnostic::warning(format!("the {} has the colour of the background", scout.object(number as u32)))
                .at(scout.object_span(number as u32))
                .related(written.span, "its material")
                .effect("it does not stand out from the background")
                .help("choose another `color` for the background, or for the material");
        Some(Finding::from(diagnostic))
    };
    world.objects().iter().enumerate().filter_map(say).take(super::finding::MAX_ALIKE).collect()
}

/// Reports textured objects without texture coordinates.
pub(super) fn no_coordinates(scout: &SceneProbe) -> Vec<Finding> {
    let meshes_only = scout.world().rules().has(Quirk::MeshTextures);
    let textured = phongs(scout).filter(|(_, _, phong)| phong.texture.is_some());
    let mut found = Vec::new();
    for (i, written, _) in textured {
        let bare = scout.seen().find(|(_, seen)| seen.material == i && !seen.has_uv);
        if let Some((_, seen)) = bare {
            let name = scout.object(seen.object);
            let diagnostic =
                Diagnostic::warning(format!("material {i} has a texture, but the {name} has no texture coordinates"))
                    .related(scout.object_span(seen.object), "uses the material")
                    .effect("the texture is invisible; `diffuseColor` is used instead")
                    .help(match (&scout.world().objects()[seen.object as usize].geometry, meshes_only) {
                        (Geometry::Mesh(_), _) => "the mesh file needs `vt` lines, and faces such as `f 1/1 2/2 3/3`",
                        (_, true) => {
                            "this year's program shows textures on meshes only: use a `TriangleMesh` with `vt` lines"
                        }
                        (_, false) => "use a shape with texture coordinates, or a `TriangleMesh` with `vt` lines",
                    });
            found.push(Finding::from(scout.at_value(diagnostic, written.span, &["texture"])));
        }
    }
    found
}

/// Reports materials that no object uses.
pub(super) fn unused(scout: &SceneProbe) -> Vec<Finding> {
    let world = scout.world();
    let mut used = vec![false; world.materials().len()];
    for object in world.objects() {
        match &object.geometry {
            Geometry::Solid(solid) => solid.parts().for_each(|part| used[part.material as usize] = true),
            _ => used[object.material as usize] = true,
        }
    }
    // A mix refers only to earlier materials, so iterate backwards.
    for i in (0..world.materials().len()).rev() {
        if let (Material::Mix(solid, ..), true) = (&world.materials()[i], used[i]) {
            solid.materials().into_iter().for_each(|part| used[part as usize] = true);
        }
    }
    let written = &scout.subject.scene.materials;
    let unused: Vec<usize> = (0..written.len()).filter(|&i| !used[i]).collect();
    let Some(&first) = unused.first() else { return Vec::new() };
    let list: Vec<String> = unused.iter().take(8).map(ToString::to_string).collect();
    let message = match unused.len() {
        1 => format!("no object uses material {first}"),
        n => format!("no object uses {}: {}", counted(n, "material", "materials"), list.join(", ")),
    };
    let diagnostic = Diagnostic::note(message).at(written[first].span).effect("it has no effect on the picture").help(
        match scout.subject.dialect {
            Dialect::F23 => "is the `index` of a `Component<Material>` wrong? Indices start at 0",
            _ => "is a `MaterialIndex` wrong? Indices start at 0",
        },
    );
    vec![Finding::from(diagnostic)]
}
