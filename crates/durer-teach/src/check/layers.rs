//! Checks layered materials: black metals, glass that absorbs all light, and invisible surfaces.

use super::finding::{Finding, MAX_FINDINGS, number as number_word, vector};
use super::scene_probe::SceneProbe;
use durer_diag::Diagnostic;
use durer_render::world::Material;
use durer_scene::material::principled::{Layering, Walls};
use durer_scene::material::{PatternMaterial, PrincipledMaterial};
use durer_scene::math::fp;
use durer_scene::scene::{Material as ParsedMaterial, Spanned};
use durer_scene::texture::Channel;

/// Reflectances and transmittances below this value count as black.
const BLACK: f32 = 0.002;

/// A layered material that objects use, with its index, its description in the scene file, and its
/// parameters.
pub(super) type Layered<'s> = (usize, &'s Spanned<ParsedMaterial>, &'s PrincipledMaterial);

/// Returns the layered materials that objects use, each with its index, its description in the
/// scene file, and its parameters.
pub(super) fn layers<'s>(scene_probe: &SceneProbe<'s>) -> Vec<Layered<'s>> {
    let used = |number: usize| scene_probe.world().objects().iter().any(|object| object.material as usize == number);
    let all = scene_probe.input.scene.materials.iter().enumerate();
    let own = all.filter_map(|(number, material)| match &material.value {
        ParsedMaterial::Principled(layers) if used(number) => Some((number, material, &**layers)),
        _ => None,
    });
    own.take(MAX_FINDINGS).collect()
}

/// Returns the thickness of the thickest object that has a material. The thickness is the smallest
/// side of the object's bounds.
pub(super) fn thickness(scene_probe: &SceneProbe, material: usize) -> Option<f32> {
    let users = scene_probe.world().objects().iter().filter(|object| object.material as usize == material);
    let sides = users.filter_map(|object| Some(object.bounds()?.size().min_element()));
    sides.max_by(f32::total_cmp).filter(|side| *side > 0.0)
}

/// Reports layered materials that reflect no light.
pub(super) fn black(scene_probe: &SceneProbe) -> Vec<Finding> {
    // The reader of a model without scattering makes all materials black.
    if scene_probe.input.scene.render_defaults.no_scattering.is_some() {
        return Vec::new();
    }
    let say = |(number, material, m): Layered| {
        // The reader reports a black light of Radiance.
        let is_light = {
            let text = scene_probe.text(material.span);
            let word = text.split_whitespace().next().unwrap_or_default();
            ["light", "glow", "illum", "spotlight"].contains(&word)
        };
        if scene_probe.material_rays()[number] == 0 || is_light {
            return None;
        }
        let base = m.base_weight * m.base_color.max_element();
        // The texture is multiplied by the colour.
        let is_factor = m.base_color.max_element() > BLACK;
        let textured = m.base_color_texture.is_some() && is_factor || m.base_spectrum.is_some();
        let reflection = m.specular_weight * m.specular_color.max_element();
        let skin = reflection > BLACK || m.coat_weight > 0.0 || m.fuzz_weight > 0.0;
        if m.base_color_texture.is_some() && !is_factor && m.base_metalness < 0.1 && m.transmission_weight < 0.5 {
            let message = format!("the texture of material {number} is multiplied by `baseColor` 0 0 0: it is black");
            let diagnostic = Diagnostic::warning(message)
                .effect("objects with this material are black, except for highlights")
                .help("write `baseColor 1 1 1` to show the texture unchanged");
            let value = scene_probe.field_span(material.span, &["baseColor"]);
            let diagnostic = diagnostic.fix_at(value, "1 1 1");
            return Some(Finding::from(scene_probe.at_value(diagnostic, material.span, &["baseColor"])));
        }
        if let Some((words, message, help)) = absorbing_layer(m) {
            let diagnostic = Diagnostic::warning(format!("{message}, so material {number} is black"))
                .effect("objects with this material are black under any light, except for highlights")
                .help(help);
            return Some(Finding::from(scene_probe.at_value(diagnostic, material.span, words)));
        }
        let word = if m.emission_luminance > 0.0 || m.thin_film_weight > 0.0 {
            return None;
        } else if m.base_metalness > 0.9 {
            (base <= BLACK && !textured && m.coat_weight == 0.0).then_some("baseColor")?
        } else if m.transmission_weight > 0.5 {
            return None;
        } else if m.has_subsurface() && m.subsurface_weight > 0.9 {
            (m.subsurface_color.max_element() <= BLACK).then_some("subsurfaceColor")?
        } else {
            (base <= BLACK && !textured && !skin).then_some("baseColor")?
        };
        let is_bright = m.base_color.max_element() > BLACK;
        let word = if word == "baseColor" && m.base_weight <= BLACK && is_bright { "baseWeight" } else { word };
        if word == "baseWeight" {
            let diagnostic = Diagnostic::warning(format!("material {number} is black: it reflects no light"))
                .effect("objects with this material are black under any light")
                .help("increase `baseWeight`, the factor by which `baseColor` is multiplied; it is 1 by default");
            let value = scene_probe.field_span(material.span, &[word]);
            return Some(Finding::from(scene_probe.at_value(diagnostic.fix_at(value, "1"), material.span, &[word])));
        }
        let what = match word {
            "subsurfaceColor" => "the visible colour of the object",
            _ if m.base_metalness > 0.9 => "the reflectance of the metal",
            _ => "the fraction of light that the material reflects",
        };
        let diagnostic = Diagnostic::warning(format!("material {number} is black: it reflects no light"))
            .effect("objects with this material are black under any light")
            .help(format!(
                "increase `{word}`, which sets {what}; for example, `{word} 0.8 0.8 0.8` gives a light grey"
            ));
        let words = [word, "baseWeight"];
        Some(Finding::from(scene_probe.at_value(diagnostic, material.span, &words)))
    };
    layers(scene_probe).into_iter().filter_map(say).chain(black_side(scene_probe)).collect()
}

/// Returns the fields of a layer that lets no light pass or reflects none, a clause about it, and
/// help.
fn absorbing_layer(m: &PrincipledMaterial) -> Option<(&'static [&'static str], &'static str, &'static str)> {
    let is_lit = m.emission_luminance > 0.0 || m.opacity < 0.5;
    let coat = m.coat_weight > 0.99 && m.coat_color.max_element() <= BLACK && m.coat_color_texture.is_none();
    let plain = m.specular_weight_texture.is_none() && m.specular_color_texture.is_none() && m.metal_ior.is_none();
    let metal = m.base_metalness > 0.99 && m.base_metalness_texture.is_none() && m.layering == Layering::OpenPbr;
    let dull = metal && m.coat_weight == 0.0 && m.fuzz_weight == 0.0 && plain;
    match () {
        () if is_lit => None,
        () if coat => Some((
            &["coatColor"],
            "the coat lets no light through",
            "write `coatColor 1 1 1` for a clear coat; `coatColor` is the fraction of light that passes through it",
        )),
        () if dull && m.specular_weight <= BLACK => Some((
            &["specularWeight"],
            "`specularWeight` 0 removes the reflection of the metal",
            "write `specularWeight 1`: a metal only has its reflection",
        )),
        () => None,
    }
}

/// Reports two-sided materials that show the camera only a black side.
fn black_side(scene_probe: &SceneProbe) -> Vec<Finding> {
    let world = scene_probe.world();
    let is_black = |number: u32| match scene_probe.input.scene.materials.get(number as usize).map(|own| &own.value) {
        Some(ParsedMaterial::Principled(m)) => {
            let skin = m.specular_weight * m.specular_color.max_element() > BLACK;
            let plain = m.base_color_texture.is_none() && m.base_spectrum.is_none() && m.emission_luminance == 0.0;
            let base = m.base_weight * m.base_color.max_element();
            base <= BLACK && plain && !skin && m.coat_weight == 0.0 && m.transmission_weight == 0.0
        }
        _ => false,
    };
    let say = |(number, material): (usize, &Spanned<ParsedMaterial>)| {
        let ParsedMaterial::Solid(PatternMaterial::TwoSided(sides), _) = &material.value else { return None };
        let hits = scene_probe.hits().filter(|(_, hit)| hit.material as usize == number);
        let (all, backs) = hits.fold((0, 0), |(all, backs), (_, hit)| (all + 1, backs + usize::from(hit.from_behind)));
        let (shown, other, side) = match () {
            () if all == 0 => return None,
            () if backs == 0 => (sides.material1, sides.material2, "front"),
            () if backs == all => (sides.material2, sides.material1, "back"),
            () => return None,
        };
        if !is_black(shown) || is_black(other) || world.materials().len() <= other as usize {
            return None;
        }
        let message =
            format!("the {side} of material {number}, which the camera sees, is black: it is material {shown}");
        let diagnostic = Diagnostic::warning(message)
            .at(material.span)
            .effect("the objects are black under any light")
            .help("swap the two `materialIndex`: the first one is the material of the front");
        Some(Finding::from(diagnostic))
    };
    let all = scene_probe.input.scene.materials.iter().enumerate();
    if scene_probe.is_physical() { all.filter_map(say).take(MAX_FINDINGS).collect() } else { Vec::new() }
}

/// Reports glass that transmits no light.
pub(super) fn opaque_glass(scene_probe: &SceneProbe) -> Vec<Finding> {
    let say = |(number, material, m): Layered| {
        let color = m.transmission_color.max_element();
        if m.transmission_weight < 0.5 || m.transmission_scatter.max_element() > 0.0 || color >= 1.0 {
            return None;
        }
        let message = format!("material {number} is glass that transmits no light");
        let diagnostic = Diagnostic::warning(message);
        let (diagnostic, word) = if m.transmission_depth == 0.0 || m.walls == Walls::Thin || color <= BLACK {
            (color <= BLACK).then(|| {
                let help =
                    "increase `transmissionColor`, the fraction of light that the glass transmits; `1 1 1` is clear";
                (
                    diagnostic.effect("the colour of the glass absorbs all light, so the glass is black").help(help),
                    "transmissionColor",
                )
            })?
        } else {
            // The thickness serves as the length of a path through a round body.
            let thick = thickness(scene_probe, number)?;
            let left = fp::exp(fp::ln(color.max(1e-6)) * 0.6 * thick / m.transmission_depth);
            (left < BLACK).then(|| {
                let depth = number_word(thick);
                let effect = format!(
                    "light has the `transmissionColor` {} after a distance of only {}, but objects with this material \
                     are {} thick, so they look black",
                    vector(m.transmission_color),
                    number_word(m.transmission_depth),
                    number_word(thick)
                );
                let help = format!("`transmissionDepth` is in units of the scene: try `transmissionDepth {depth}`");
                (
                    diagnostic
                        .effect(effect)
                        .help(help)
                        .fix_at(scene_probe.field_span(material.span, &["transmissionDepth"]), depth),
                    "transmissionDepth",
                )
            })?
        };
        Some(Finding::from(scene_probe.at_value(diagnostic, material.span, &[word])))
    };
    layers(scene_probe).into_iter().filter_map(say).collect()
}

/// Reports glass whose index of refraction is 1 or impossible.
pub(super) fn odd_index(scene_probe: &SceneProbe) -> Vec<Finding> {
    let say = |(number, material, m): Layered| {
        let clear = m.transmission_color.min_element() >= 0.99 && m.transmission_scatter.max_element() == 0.0;
        let plain =
            m.coat_weight == 0.0 && m.fuzz_weight == 0.0 && m.emission_luminance == 0.0 && m.thin_film_weight == 0.0;
        if m.transmission_weight < 0.5 || m.walls == Walls::Thin {
            return None;
        }
        let index = number_word(m.specular_ior);
        let message = format!("material {number} is glass with an index of refraction of {index}");
        let effect = match m.specular_ior {
            // A volume of smoke also has an index of 1, so only clear glass is reported.
            ior if (ior - 1.0).abs() < 1e-3 && clear && plain && m.transmission_weight > 0.99 => {
                "light passes straight through without reflection, so objects with this material are invisible"
            }
            ior if !(0.4..=4.5).contains(&ior) => "no real material has such an index",
            _ => return None,
        };
        let help = "write `specularIor 1.5` for glass; water has an index of 1.33, and diamond 2.4";
        let diagnostic = Diagnostic::warning(message).effect(effect).help(help);
        let diagnostic = diagnostic.fix_at(scene_probe.field_span(material.span, &["specularIor"]), "1.5");
        Some(Finding::from(scene_probe.at_value(diagnostic, material.span, &["specularIor"])))
    };
    layers(scene_probe).into_iter().filter_map(say).collect()
}

/// Returns true if the channel of the opacity texture that a material uses is 0 everywhere.
fn has_black_opacity(scene_probe: &SceneProbe, material: usize) -> bool {
    let world = scene_probe.world();
    let Some(Material::Phong(phong)) = world.materials().get(material) else { return false };
    let map = phong.principled.as_ref().and_then(|principled| principled.maps.opacity);
    let Some(texture) = map.and_then(|map| world.textures().get(map as usize)) else { return false };
    let mapping = texture.mapping().cloned().unwrap_or_default();
    let channel = match mapping.channel {
        None if texture.has_alpha() => return texture.all_opacities(|opacity| opacity == 0.0),
        Some(Channel::Alpha) => return texture.all_opacities(|opacity| opacity == 0.0),
        None | Some(Channel::Red) => 0,
        Some(Channel::Green) => 1,
        Some(Channel::Blue) => 2,
        Some(Channel::Angle) => return false,
    };
    texture.all_texels(|texel| texel[channel] == 0.0)
}

/// Reports surfaces whose opacity is zero, or whose opacity texture is black.
pub(super) fn zero_opacity(scene_probe: &SceneProbe) -> Vec<Finding> {
    let say = |(number, material, m): Layered| {
        if has_black_opacity(scene_probe, number) {
            let message =
                format!("the opacity texture of material {number} is 0 everywhere in the channel that is used");
            let diagnostic = Diagnostic::warning(message)
                .effect("objects with this material are invisible: light passes through unchanged")
                .help(
                    "use a picture that is opaque where the surface is present: its alpha is used or, without alpha, \
                     its red channel, or the channel after a colon, as in `picture.png:b`",
                );
            return Some(Finding::from(scene_probe.at_value(diagnostic, material.span, &["opacityTexture"])));
        }
        if let Some(cutoff) = m.opacity_cutoff.filter(|cutoff| *cutoff > 1.0) {
            let message =
                format!("material {number} has the `opacityCutoff` {}, above any opacity", number_word(cutoff));
            let diagnostic = Diagnostic::warning(message)
                .effect("objects with this material are invisible: light passes through unchanged")
                .help("opacity goes from 0 to 1, not to 255: write, for example, `opacityCutoff 0.5`");
            let value = scene_probe.field_span(material.span, &["opacityCutoff"]);
            let diagnostic = diagnostic.fix_at(value, "0.5");
            return Some(Finding::from(scene_probe.at_value(diagnostic, material.span, &["opacityCutoff"])));
        }
        if m.opacity > 0.01 {
            return None;
        }
        let diagnostic = Diagnostic::warning(format!("material {number} has the `opacity` {}", number_word(m.opacity)))
            .effect("objects with this material are invisible: light passes through unchanged")
            .help("increase `opacity`, the fraction of the surface that is present, from 0 to 1");
        let value = scene_probe.field_span(material.span, &["opacity"]);
        Some(Finding::from(scene_probe.at_value(diagnostic.fix_at(value, "1"), material.span, &["opacity"])))
    };
    layers(scene_probe).into_iter().filter_map(say).collect()
}
