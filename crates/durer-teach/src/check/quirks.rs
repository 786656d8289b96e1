//! Checks for scenes that the program of a course year renders differently than intended because of
//! its quirks.

use super::finding::{Finding, MAX_FINDINGS, number, percent, vector};
use super::scene_probe::SceneProbe;
use durer_diag::Diagnostic;
use durer_scene::camera::Projection;
use durer_scene::dialect::{Highlight, Quirk};
use durer_scene::light::Illuminate as _;
use durer_scene::material::PhongMaterial;
use durer_scene::math::Color;
use durer_scene::scene::{Material as ParsedMaterial, Spanned};

/// Range of lengths of a camera's `up` for which the effect is invisible.
const UNIT_LENGTHS: std::ops::RangeInclusive<f32> = 0.9..=1.1;
/// Cosine between `up` and `direction` above which the skew is visible.
const SKEW: f32 = 0.6;
/// Aspect ratio below which a picture looks square.
const SQUARE: f32 = 1.05;

/// Iterates over the visible Phong materials with their descriptions in the scene file.
fn visible_materials<'s>(
    scene_probe: &SceneProbe<'s>,
) -> impl Iterator<Item = (usize, &'s Spanned<ParsedMaterial>, &'s PhongMaterial)> {
    let rays = scene_probe.material_rays().to_vec();
    let all = scene_probe.input.scene.materials.iter().enumerate();
    all.filter_map(move |(i, material)| match &material.value {
        ParsedMaterial::Phong(phong, _) if rays[i] > 0 => Some((i, material, &**phong)),
        _ => None,
    })
}

/// Reports highlights with exponent 0 in a dialect in which 0 to the power of 0 is 1.
pub(super) fn pow_zero(scene_probe: &SceneProbe) -> Vec<Finding> {
    let rules = scene_probe.world().rules();
    if rules.highlight != Highlight::Phong || !rules.has(Quirk::PowZero) {
        return wide_highlight(scene_probe);
    }
    let all = scene_probe.hits().count();
    let chalk = |phong: &PhongMaterial| {
        phong.specular_color.max_element() > 0.02 && phong.shininess.or(phong.exponent).unwrap_or(0.0) == 0.0
    };
    let say = |(i, material, phong): (usize, &Spanned<ParsedMaterial>, &PhongMaterial)| {
        let missing = phong.shininess.is_none();
        let count = scene_probe.material_rays()[i];
        let message = match missing {
            true => format!("material {i} has a `specularColor` but no `shininess`, so its shininess is 0"),
            false => format!("the `shininess` of material {i} is 0"),
        };
        let message = message.replace("specularColor", scene_probe.keyword_of_grammar("specularColor", "specular"));
        let diagnostic = Diagnostic::warning(message)
            .label(format!("on {} of the visible surfaces", percent(count, all)))
            .effect("the highlight covers everything and looks like chalk, because 0 to the power of 0 is 1")
            .help("write a higher `shininess`, such as 20; higher values make the highlight sharper");
        let value = scene_probe.field_span(material.span, &["shininess"]);
        let diagnostic = match value {
            Some(value) => diagnostic.at(value).fix(value, "20"),
            None => scene_probe.at_value(diagnostic, material.span, &["specularColor", "specular"]),
        };
        Finding::from(diagnostic).affecting_whole_picture(count * 2 > all)
    };
    let findings: Vec<Finding> =
        visible_materials(scene_probe).filter(|(.., phong)| chalk(phong)).map(say).take(MAX_FINDINGS).collect();
    if findings.is_empty() { wide_highlight(scene_probe) } else { findings }
}

/// Returns the exponent of a material's highlight and the field that sets it.
fn sharpness(phong: &PhongMaterial) -> Option<(&'static str, f32)> {
    match (phong.exponent, phong.shininess) {
        (Some(exponent), _) => Some(("exponent", exponent)),
        (None, shininess) => Some(("shininess", shininess?)),
    }
}

/// Reports highlights that are so wide that they cover everything, for example because of an
/// exponent of 0 or a reciprocal exponent.
fn wide_highlight(scene_probe: &SceneProbe) -> Vec<Finding> {
    if scene_probe.world().rules().highlight == Highlight::None || scene_probe.is_physical() {
        return Vec::new();
    }
    let say = |(i, material, phong): (usize, &Spanned<ParsedMaterial>, &PhongMaterial)| {
        let (word, exponent) = sharpness(phong)?;
        // The reader reports negative exponents.
        if !(0.0..MIN_EXPONENT).contains(&exponent)
            || phong.specular_color.max_element() < 0.02
            || phong.refraction_index.is_some()
        {
            return None;
        }
        let diagnostic = Diagnostic::warning(format!("the `{word}` of material {i} is {}", number(exponent)))
            .effect("the highlight covers nearly everything and looks like chalk")
            .help(format!("higher values make the highlight sharper, and plastic has about 20: try `{word} 20`"));
        let value = scene_probe.field_span(material.span, &[word]);
        Some(Finding::from(scene_probe.at_value(diagnostic.fix_at(value, "20"), material.span, &[word])))
    };
    visible_materials(scene_probe).filter_map(say).take(MAX_FINDINGS).collect()
}

/// Exponent above which a highlight is smaller than a pixel.
const MAX_EXPONENT: f32 = 2e4;
/// Exponent below which highlights are invisible.
const MIN_EXPONENT: f32 = 0.7;

/// Reports highlights that are smaller than a pixel.
pub(super) fn tiny_highlight(scene_probe: &SceneProbe) -> Vec<Finding> {
    if scene_probe.world().rules().highlight == Highlight::None || scene_probe.is_physical() {
        return Vec::new();
    }
    let say = |(i, material, phong): (usize, &Spanned<ParsedMaterial>, &PhongMaterial)| {
        let (word, exponent) = sharpness(phong)?;
        if exponent <= MAX_EXPONENT || phong.specular_color.max_element() < 0.02 {
            return None;
        }
        let diagnostic = Diagnostic::warning(format!("the `{word}` of material {i} is {}", number(exponent)))
            .effect("the highlight is smaller than a pixel and invisible")
            .help(format!("plastic has about 20, polished metal 200: try `{word} 100`"));
        let value = scene_probe.field_span(material.span, &[word]);
        Some(Finding::from(scene_probe.at_value(diagnostic.fix_at(value, "100"), material.span, &[word])))
    };
    visible_materials(scene_probe).filter_map(say).take(MAX_FINDINGS).collect()
}

/// Reports a highlight colour without an exponent. The default exponent is 1.
pub(super) fn no_exponent(scene_probe: &SceneProbe) -> Vec<Finding> {
    match scene_probe.world().rules().highlight {
        Highlight::None => return no_highlight(scene_probe).into_iter().collect(),
        Highlight::Phong => return Vec::new(),
        Highlight::Blinn | Highlight::ByKeyword => {}
    }
    let bare = |phong: &PhongMaterial| {
        phong.specular_color.max_element() > 0.02
            && phong.shininess.is_none()
            && phong.exponent.is_none()
            && phong.refraction_index.is_none()
    };
    let say = |(i, material, _): (usize, &Spanned<ParsedMaterial>, &PhongMaterial)| {
        let diagnostic =
            Diagnostic::warning(format!("material {i} has a `specularColor` but no `exponent`, so its exponent is 1"))
                .effect("the highlight covers everything and looks like chalk")
                .help("add an `exponent`, such as 20; higher values make the highlight sharper");
        Finding::from(scene_probe.at_value(diagnostic, material.span, &["specularColor"]))
    };
    visible_materials(scene_probe).filter(|(.., phong)| bare(phong)).map(say).take(MAX_FINDINGS).collect()
}

/// Reports, as a note, a highlight colour without an exponent in a dialect without highlights,
/// which uses the colour for a mirror.
fn no_highlight(scene_probe: &SceneProbe) -> Option<Finding> {
    let bare = |phong: &PhongMaterial| {
        phong.specular_color.max_element() > 0.02
            && phong.shininess.is_none()
            && phong.exponent.is_none()
            && phong.refraction_index.is_none()
            && phong.diffuse_color.is_none_or(|color| color.max_element() > 0.15)
    };
    let (i, material, _) = visible_materials(scene_probe).find(|(.., phong)| bare(phong))?;
    let diagnostic = Diagnostic::note(format!("material {i} has a `specularColor` and no `shininess`"))
        .effect("this year's program has no highlights and uses the colour for a mirror; in other dialects the highlight covers everything")
        .help("for a highlight, add a `shininess`, such as 20, and use a dialect with highlights, such as `--dialect f16`");
    Some(Finding::from(scene_probe.at_value(diagnostic, material.span, &["specularColor"])))
}

/// Reports a camera whose `up` does not have unit length, in a dialect that does not normalise it.
pub(super) fn long_up(scene_probe: &SceneProbe) -> Vec<Finding> {
    let up = scene_probe.world().camera().pose().up;
    let length = up.length();
    let rules = scene_probe.world().rules();
    if !rules.has(Quirk::RawUp) {
        return skew_up(scene_probe).filter(|_| rules.has(Quirk::SkewUp)).into_iter().collect();
    }
    if UNIT_LENGTHS.contains(&length) {
        return skew_up(scene_probe).into_iter().collect();
    }
    let (how, word) = if length > 1.0 { (length, "flattened") } else { (1.0 / length, "stretched upwards") };
    let unit = vector(up / length);
    let diagnostic =
        Diagnostic::warning(format!("the camera's `up` has a length of {} and is used as written", number(length)))
            .effect(format!("the picture is {word} by a factor of {}", number(how)))
            .help(format!("write the unit vector `up {unit}`"));
    let span = scene_probe.input.scene.camera_span;
    let diagnostic = match scene_probe.field_span(span, &["up"]) {
        Some(value) => diagnostic.at(value).fix(value, unit),
        None => diagnostic.at(span),
    };
    vec![Finding::from(diagnostic).affecting_whole_picture(true)]
}

/// Reports an `up` that is far from perpendicular to `direction`, in a dialect that does not
/// correct it.
fn skew_up(scene_probe: &SceneProbe) -> Option<Finding> {
    let pose = scene_probe.world().camera().pose();
    let (up, forward) = (pose.up.normalize_or_zero(), pose.direction.normalize_or_zero());
    let off = up.dot(forward);
    if off.abs() < SKEW || off.abs() > 0.999 {
        return None;
    }
    let right = (up - off * forward).normalize_or_zero();
    let text = vector(right);
    let diagnostic =
        Diagnostic::warning("the camera's `up` is not perpendicular to its `direction` and is used as written")
            .effect(format!("the picture is skewed, and {} times too flat", number(1.0 / (1.0 - off * off).sqrt())))
            .help(format!("write a perpendicular vector: `up {text}`"));
    let span = scene_probe.input.scene.camera_span;
    let value = scene_probe.field_span(span, &["up"]);
    Some(
        Finding::from(scene_probe.at_value(diagnostic.fix_at(value, text), span, &["up"]))
            .affecting_whole_picture(true),
    )
}

/// Reports a picture that is not square, in a dialect that stretches it.
pub(super) fn stretched(scene_probe: &SceneProbe) -> Vec<Finding> {
    let job = scene_probe.input.job;
    let (width, height) = (job.width as f32, job.height as f32);
    let ratio = width.max(height) / width.min(height);
    if !scene_probe.world().rules().has(Quirk::Stretch) || ratio < SQUARE {
        return Vec::new();
    }
    let way = if width > height { "wide" } else { "high" };
    let side = job.width.max(job.height);
    let diagnostic = Diagnostic::warning(format!("the picture of {} x {} pixels is not square", job.width, job.height))
        .at(scene_probe.input.scene.camera_span)
        .effect(format!("this year's program stretches the picture: everything is {} times too {way}", number(ratio)))
        .help(format!(
            "set a square size, such as `--size {side}x{side}` (in the course's programs `-size {side} {side}`)"
        ));
    vec![Finding::from(diagnostic).affecting_whole_picture(true)]
}

/// Reports faces with more than three vertices, of which the dialect's program reads only three.
pub(super) fn quads(scene_probe: &SceneProbe) -> Vec<Finding> {
    if !scene_probe.world().rules().is_bit_compatible() {
        return Vec::new();
    }
    let say = |(name, count, all, face): (&str, usize, usize, durer_diag::Span)| {
        let diagnostic =
            Diagnostic::warning(format!("{count} of the {all} faces of `{name}` have more than three vertices"))
                .at(face)
                .label("the first of them")
                .effect("this year's program reads only three vertices of each face, and shows holes or stops")
                .help("split such faces into triangles: `f 1 2 3 4` becomes `f 1 2 3` and `f 1 3 4`");
        Finding::from(diagnostic)
    };
    super::mesh::large_faces(scene_probe).into_iter().map(say).collect()
}

/// Reports patterns whose two parts are equal.
pub(super) fn same_parts(scene_probe: &SceneProbe) -> Vec<Finding> {
    use durer_scene::material::Pattern;
    let materials = &scene_probe.input.scene.materials;
    let say = |(i, material): (usize, &Spanned<ParsedMaterial>)| {
        if let ParsedMaterial::Phong(_, Some(noise)) = &material.value {
            return (noise.color1 == noise.color2 && scene_probe.material_rays()[i] > 0).then(|| {
                let diagnostic =
                    Diagnostic::warning(format!("both colours of this noise are {}", vector(noise.color1)))
                        .effect("the pattern is invisible because both colours are equal")
                        .help("give the two `color` fields of the noise different values");
                Finding::from(diagnostic.at(material.span))
            });
        }
        let ParsedMaterial::Solid(solid, _) = &material.value else { return None };
        let [first, second] = solid.materials();
        let of = |index: u32| materials.get(index as usize).map(|part| &part.value);
        if first != second && of(first) != of(second) || scene_probe.material_rays()[i] == 0 {
            return None;
        }
        let message = match first == second {
            true => format!("both parts of this pattern are material {first}"),
            false => format!("the two parts of this pattern, materials {first} and {second}, are equal"),
        };
        let diagnostic = Diagnostic::warning(message)
            .at(material.span)
            .effect("the pattern is invisible because both parts are equal")
            .help("give the two `materialIndex` fields of the pattern different materials that precede it");
        Some(Finding::from(diagnostic))
    };
    materials.iter().enumerate().filter_map(say).take(MAX_FINDINGS).collect()
}

/// Reports ambient light that is so bright that other lights are hardly visible.
pub(super) fn full_ambient(scene_probe: &SceneProbe) -> Vec<Finding> {
    let world = scene_probe.world();
    let ambient = world.ambient();
    let lights: Color = world.lights().iter().map(|light| light.color()).sum();
    if ambient.min_element() < 0.8 || ambient.max_element() > 2.0 || lights.max_element() <= 0.0 {
        return Vec::new();
    }
    let word = scene_probe.keyword_of_grammar("ambientLight", "ambient_light");
    let diagnostic =
        Diagnostic::warning(format!("the ambient light is {}, which leaves no range for other light", vector(ambient)))
            .effect("shadows and shading are washed out: surfaces have their full colour without any light")
            .help(format!("0.1 to 0.3 is usual: try `{word} 0.2 0.2 0.2`"));
    let diagnostic =
        match super::colors::background_span(scene_probe).and_then(|block| scene_probe.field_span(block, &[word])) {
            Some(value) => diagnostic.at(value).fix(value, "0.2 0.2 0.2"),
            None => diagnostic,
        };
    vec![Finding::from(diagnostic).affecting_whole_picture(true)]
}

/// Reports planes whose normal does not have unit length, in dialects in which this moves the
/// plane.
pub(super) fn plane_normal(scene_probe: &SceneProbe) -> Vec<Finding> {
    use durer_render::world::Object;
    let say = |object: &Object| {
        let plane = super::shapes::plane(object)?;
        let length = plane.normal.length();
        let rules = scene_probe.world().rules();
        let counts = rules.has(Quirk::RawNormals) && !rules.has(Quirk::UnitLight);
        if (0.98..=1.02).contains(&length) || plane.offset == 0.0 && !counts {
            return None;
        }
        let unit = vector(plane.normal / length);
        let diagnostic = Diagnostic::warning(format!("the normal of this plane has a length of {}", number(length)))
            .effect(match plane.offset == 0.0 {
                true => format!(
                    "this year's program uses the normal as written, so light is multiplied by {}",
                    number(length)
                ),
                false => format!(
                    "the plane is at p · normal = offset, which is {} from the origin, not {}",
                    number(plane.offset.abs() / length),
                    number(plane.offset.abs())
                ),
            })
            .help(match counts {
                true => {
                    format!(
                        "write the unit vector `normal {unit}`; otherwise, light is multiplied by {}",
                        number(length)
                    )
                }
                false => format!("write the unit vector `normal {unit}`"),
            });
        // Keep the plane where it is.
        let offset = number(plane.offset / length);
        let diagnostic = match (
            scene_probe.field_span(object.span, &["normal"]),
            scene_probe.field_span(object.span, &["offset"]),
        ) {
            (Some(value), Some(place)) => diagnostic.at(value).fix(value, unit).fix(place, offset),
            _ => diagnostic.at(object.span),
        };
        Some(Finding::from(diagnostic))
    };
    scene_probe.world().objects().iter().filter_map(say).take(MAX_FINDINGS).collect()
}
