//! Checks mirrors and glass under Whitted's method: secondary rays that are missing, impossible
//! indices of refraction, and glass that transmits no light.

use super::colors::{phongs, rays};
use super::finding::{Finding, MAX_FINDINGS};
use super::scene_probe::SceneProbe;
use durer_diag::{Diagnostic, Severity};
use durer_render::world::Phong;
use durer_scene::dialect::SecondaryRays;
use durer_scene::math::Color;
use durer_scene::scene::{Material as ParsedMaterial, Spanned};

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
