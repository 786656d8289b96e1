//! Checks the exposure. They find pictures that are too bright, too dark or of a single colour, and
//! depth ranges that show only black or white.

use super::brightness::brightest;
use super::finding::{Finding, number, percent, vector};
use super::lights::span;
use super::probes::{Probe, ProbeHit};
use super::scene_probe::SceneProbe;
use super::verdict::VISIBLE;
use durer_diag::{Diagnostic, Severity};
use durer_scene::light::{Illuminate as _, PHOTOMETRIC_FIELDS};
use durer_scene::math::{Color, fp};

/// Values above `MAX_UNCLIPPED` are clipped to white. Above `FAR_ABOVE_WHITE`, most of the shading
/// is lost.
const MAX_UNCLIPPED: f32 = 1.0 + VISIBLE;
const FAR_ABOVE_WHITE: f32 = 1.25;
/// Maximum fractions of visible points that may be clipped or far too bright. Above these
/// fractions, more than the highlights is affected.
const MAX_CUT: f32 = 0.4;
const MAX_FAR: f32 = 0.2;

/// Maximum fraction of white pixels in a usable picture.
const MAX_WHITE: f32 = 0.5;
/// Maximum fraction of white points on lit surfaces, regardless of the background.
const MAX_WHITE_SURFACES: f32 = 0.8;

/// Factor of the exposure below which the exposure can be the cause of a dark picture, and value
/// before exposure above which there is ample light.
const MAX_LOW_EXPOSURE: f32 = 0.25;
const MIN_AMPLE: f32 = 0.1;

/// Brightness of the background above which dark objects in front of it may be silhouettes.
const MIN_BRIGHT_BACKGROUND: f32 = 0.5;

/// Converts a ratio of luminances to stops.
fn stops_of(factor: f32) -> f32 {
    fp::ln(factor) / std::f32::consts::LN_2
}

/// Reports a picture in physical units (path tracing, or a sky in cd/m^2) that is clipped to white.
fn white(scene_probe: &SceneProbe) -> Vec<Finding> {
    // Emitters may be white, and an unlit background does not count.
    let lit = |probe: &Probe| probe.hit.as_ref().is_some_and(|hit| !scene_probe.world().may_emit(hit.material));
    let all = scene_probe.exposed_colors();
    let objects: Vec<Color> =
        (scene_probe.lit_probes().filter(|(probe, color)| lit(probe) && color.max_element() > VISIBLE))
            .map(|(_, color)| color)
            .collect();
    let is_white = |color: &&Color| color.min_element() > 1.1;
    let over =
        |clamped: &[Color], share: f32| clamped.iter().filter(is_white).count() as f32 > share * clamped.len() as f32;
    let (clamped, what) = if over(all, MAX_WHITE) {
        (all, "the picture")
    } else if objects.len() * 20 > all.len() && over(&objects, MAX_WHITE_SURFACES) {
        (&objects[..], "the lit surface area")
    } else {
        return Vec::new();
    };
    let white = clamped.iter().filter(is_white).count();
    let mut values: Vec<f32> = clamped.iter().map(|color| color.max_element()).collect();
    values.sort_by(f32::total_cmp);
    let middle = values[values.len() / 2];
    let stops = stops_of(0.5 / middle).round();
    let factor = number(0.5 / middle);
    let diagnostic =
        Diagnostic::warning(format!("there is too much light: half of {what} is brighter than {}", number(middle)))
            .effect(format!("{} of {what} is white", percent(white, clamped.len())));
    let background = &scene_probe.input.scene.background;
    let sky = background.sun().is_some() || background.cie_sky.is_some();
    let exposure = number(stops + stops_of(scene_probe.input.exposure));
    if let Some(diagnostic) = glowing_surfaces(scene_probe, &diagnostic) {
        return vec![Finding::from(diagnostic).affecting_whole_picture(true)];
    }
    if let Some(diagnostic) = bright_light(scene_probe, &diagnostic, middle, &exposure).filter(|_| !sky) {
        return vec![Finding::from(diagnostic).affecting_whole_picture(true)];
    }
    let light = super::area_lights::brightest(scene_probe).filter(|_| !sky);
    let help = match sky {
        true => format!("this sky has outdoor brightness, in cd/m^2: set `--exposure {exposure}`"),
        false if super::area_lights::emissive_objects(scene_probe).is_empty() => {
            format!("set `--exposure {exposure}`, or multiply the lights and the background by {factor}")
        }
        false => format!("set `--exposure {exposure}`, or multiply the emission by {factor}"),
    };
    let diagnostic = diagnostic.help(help);
    let emitter = super::emission::strongest(scene_probe).filter(|_| light.is_none() && !sky);
    let diagnostic = match light {
        Some((place, value)) => diagnostic.at(place).fix(place, number(value * 0.5 / middle)),
        None if emitter.is_some() => super::emission::blamed(scene_probe, diagnostic, emitter),
        None => Diagnostic { span: super::colors::background_span(scene_probe), ..diagnostic },
    };
    vec![Finding::from(diagnostic).affecting_whole_picture(true)]
}

/// Fraction of the visible surfaces above which surfaces that emit light are no lights, but walls
/// with the wrong material.
const MAX_GLOWING: f32 = 0.4;

/// Explains a bright picture in which most surfaces emit light, while another material is unused.
fn glowing_surfaces(scene_probe: &SceneProbe, diagnostic: &Diagnostic) -> Option<Diagnostic> {
    let world = scene_probe.world();
    let glows = |hit: &ProbeHit| scene_probe.radiance(hit.material as usize) != Color::ZERO;
    let glowing: Vec<u32> = scene_probe.hits().filter(|(_, hit)| glows(hit)).map(|(_, hit)| hit.object).collect();
    let all = scene_probe.hits().count();
    let unused = super::names::unused_materials(scene_probe);
    let object = super::verdict::most_common(&glowing)?;
    let is_wall = glowing.len() as f32 > MAX_GLOWING * all as f32;
    let first = unused.first().filter(|_| is_wall && scene_probe.model_format().is_none())?;
    let number = world.objects()[object as usize].material as usize;
    let unused = super::names::material_name(scene_probe, *first).unwrap_or_else(|| format!("material {first}"));
    let message =
        format!("{} of the visible surfaces have material {number}, which emits light", percent(glowing.len(), all));
    let cause = Diagnostic::warning(message)
        .at(scene_probe.object_span(object))
        .help(format!("check the `MaterialIndex` before these objects: no object uses {unused}"));
    let material = scene_probe.input.scene.materials.get(number)?;
    Some(Diagnostic { effect: diagnostic.effect.clone(), ..cause.related(material.span, "this material emits light") })
}

/// Explains a bright path-traced picture whose light comes mostly from one light source.
fn bright_light(scene_probe: &SceneProbe, diagnostic: &Diagnostic, middle: f32, exposure: &str) -> Option<Diagnostic> {
    let exposed = scene_probe.input.exposure;
    let median = |light: usize| {
        let lit = scene_probe.hits().filter_map(|(_, hit)| hit.contribution(light));
        let mut all: Vec<f32> = lit.map(|lit| exposed * lit.contribution.max_element()).collect();
        all.sort_by(f32::total_cmp);
        all.get(all.len() / 2).copied().unwrap_or(0.0)
    };
    let lights = 0..scene_probe.world().lights().len().min(super::finding::MAX_FINDINGS);
    let (light, most) = lights.map(|light| (light, median(light))).max_by(|a, b| a.1.total_cmp(&b.1))?;
    let span = span(scene_probe, light).filter(|_| most > 0.3 * middle && most > 1.0)?;
    let factor = 0.5 / middle;
    let unit = PHOTOMETRIC_FIELDS.into_iter().find_map(|field| Some((field, scene_probe.field_span(span, &[field])?)));
    let strength = unit.and_then(|(field, place)| Some((field, scene_probe.text(place).parse::<f32>().ok()?)));
    let less = match strength {
        Some((field, value)) => format!("write `{field} {}`", number(value * factor)),
        None => {
            let color = scene_probe.world().lights()[light].color() * factor;
            format!("multiply its colour by {}: `color {}`", number(factor), vector(color))
        }
    };
    let what = match strength {
        Some(("lux", value)) if value >= 1e4 => format!("`lux {}` is sunlight: ", number(value)),
        Some((field, value)) => format!("with `{field} {}`, radiance is in cd/m^2: ", number(value)),
        None => String::new(),
    };
    let place = unit.map(|(_, place)| place).or_else(|| scene_probe.field_span(span, &["color"]));
    let diagnostic = diagnostic.clone().at(place.unwrap_or(span));
    Some(diagnostic.help(match scene_probe.model_format() {
        Some(_) => format!("set `--exposure {exposure}`, or multiply the strength of this light by {}", number(factor)),
        None => format!("{what}set `--exposure {exposure}`, or {less}"),
    }))
}

/// Reports values above 1 in an eight-bit picture.
pub(super) fn too_bright(scene_probe: &SceneProbe) -> Vec<Finding> {
    if scene_probe.is_physical() || scene_probe.world().environment().is_some() {
        return white(scene_probe);
    }
    let exposed = scene_probe.input.exposure;
    let lit: Vec<Color> =
        scene_probe.hits().map(|(probe, _)| exposed * probe.color).filter(|color| color.is_finite()).collect();
    let far = lit.iter().filter(|color| color.max_element() > FAR_ABOVE_WHITE).count();
    let cut = lit.iter().filter(|color| color.max_element() > MAX_UNCLIPPED).count();
    let white = lit.iter().filter(|color| color.min_element() > MAX_UNCLIPPED).count();
    let over = |count: usize, share: f32| count as f32 > share * lit.len() as f32;
    if !over(cut, MAX_CUT) && !over(far, MAX_FAR) {
        return Vec::new();
    }
    let brightest = lit.iter().copied().max_by(|a, b| a.max_element().total_cmp(&b.max_element())).unwrap_or_default();
    // Keep the ambient light unless it is too strong on its own.
    let world = scene_probe.world();
    let (most, ambient) = (brightest.max_element(), world.ambient().max_element().min(0.5));
    let factor = (1.0 - ambient) / (most - ambient).max(1e-6);
    let effect = format!(
        "{} of the visible surface area is clipped at 1 and loses its shading; {} is white",
        percent(cut, lit.len()),
        percent(white, lit.len())
    );
    let mut diagnostic =
        Diagnostic::warning(format!("there is too much light: the brightest colour is {}", vector(brightest)))
            .effect(effect)
            .help(format!(
                "multiply the colours of the lights by {}, or write a format that can store bright colours (.exr, \
                 .hdr)",
                number(factor)
            ));
    // If the lights are too strong on their own, no material is blamed.
    let local =
        |hit: &ProbeHit| (hit.ambient + hit.lights.iter().map(|lit| lit.contribution).sum::<Color>()).max_element();
    let by_lights = scene_probe.hits().filter(|(_, hit)| local(hit) > FAR_ABOVE_WHITE).count();
    if let Some(cause) = super::colors::energy_gain(scene_probe).filter(|_| by_lights * 2 < far) {
        let severity = if over(far, MAX_FAR) { Severity::Warning } else { Severity::Note };
        let diagnostic = Diagnostic { severity, effect: diagnostic.effect, ..cause };
        return vec![Finding::from(diagnostic).affecting_whole_picture(cut * 2 > lit.len())];
    }
    for (i, light) in world.lights().iter().enumerate() {
        let Some(span) = span(scene_probe, i) else { continue };
        // A light that is almost without attenuation is not too bright itself.
        let faded = scene_probe.field_span(span, &["attenuation", "falloff"]).filter(|_| factor < 0.1 && most > 10.0);
        if let (Some(value), Some(a)) = (faded, super::verdict::attenuation(light)) {
            let single = scene_probe.text(value).split_whitespace().count() == 1;
            let text = if single { number(a.z / factor) } else { vector(a / factor) };
            let diagnostic = diagnostic
                .help(format!("the light fades too little: try `{text}` instead of `{}`", scene_probe.text(value)));
            let diagnostic = diagnostic.at(value).label("this light is too strong").fix(value, text);
            return vec![Finding::from(diagnostic).affecting_whole_picture(cut * 2 > lit.len())];
        }
        let unit = scene_probe.field_span(span, &PHOTOMETRIC_FIELDS);
        let value = unit.or_else(|| scene_probe.field_span(span, &["color"]));
        let strength = unit.and_then(|unit| scene_probe.text(unit).trim().parse::<f32>().ok());
        let less = strength.map_or_else(|| vector(light.color() * factor), |strength| number(strength * factor));
        diagnostic = diagnostic.fix_at(value, less);
        diagnostic.span = diagnostic.span.or(value).or(Some(span));
    }
    if !over(far, MAX_FAR) {
        diagnostic.severity = Severity::Note;
    }
    vec![Finding::from(diagnostic).affecting_whole_picture(cut * 2 > lit.len())]
}

/// Reports a picture that has a single colour.
pub(super) fn one_color(scene_probe: &SceneProbe) -> Vec<Finding> {
    let clamped = |color: Color| color.clamp(Color::ZERO, Color::ONE);
    let mut colors = scene_probe.exposed_colors().iter().map(|color| clamped(*color));
    let Some(first) = colors.next().filter(|_| scene_probe.exposed_colors().len() > 4) else { return Vec::new() };
    if !colors.all(|color| (color - first).abs().max_element() < VISIBLE) {
        return Vec::new();
    }
    let name = match (first.max_element() < VISIBLE, first.min_element() > 1.0 - VISIBLE) {
        (true, _) => "black".to_string(),
        (_, true) => "white".to_string(),
        _ => format!("uniformly {}", vector(first)),
    };
    let empty = scene_probe.hits().next().is_none();
    if !empty && scene_probe.lacks_photons() || super::emission::shows_bright_lamp(scene_probe) {
        return Vec::new();
    }
    // Probes can miss small visible objects.
    if empty && scene_probe.visibilities().contains(&super::visibility::Visibility::Visible) {
        return Vec::new();
    }
    let diagnostic = Diagnostic::warning(format!("the whole picture is {name}"));
    let diagnostic = match empty {
        true => diagnostic.effect("every ray misses; only the background is visible"),
        false => diagnostic.effect("no shading is visible"),
    };
    vec![
        Finding::from(diagnostic.help("run `durer explain SCENE --pixel X,Y`, which explains the colour of a pixel"))
            .only_describing(),
    ]
}

/// Returns true if the picture shows a bright background, before which objects can be silhouettes.
pub(super) fn has_bright_background(scene_probe: &SceneProbe) -> bool {
    let behind = scene_probe.probes.iter().filter(|probe| probe.hit.is_none());
    behind.map(|probe| probe.color.max_element()).fold(0.0, f32::max) > MIN_BRIGHT_BACKGROUND
}

/// Reports a picture that is almost black wherever it shows an object.
pub(super) fn too_dark(scene_probe: &SceneProbe) -> Vec<Finding> {
    if scene_probe.is_physical() {
        return dark_paths(scene_probe);
    }
    let most = scene_probe.hits().map(|(probe, _)| probe.color.max_element()).fold(0.0, f32::max);
    let lights = scene_probe.world().lights();
    if scene_probe.hits().next().is_none() || most > 0.06 || lights.is_empty() {
        return Vec::new();
    }
    // Silhouettes before a bright background may be intentional.
    let severity = if has_bright_background(scene_probe) { Severity::Note } else { Severity::Warning };
    let message = format!("the brightest visible surface has a value of only {}", number(most));
    let diagnostic = Diagnostic { severity, ..Diagnostic::warning(message) }
        .effect("all visible surfaces are black, or nearly black")
        .help(format!("use about {} times as much light", number(0.8 / most.max(1e-4))));
    let diagnostic = match span(scene_probe, 0) {
        Some(span) => scene_probe.at_value(diagnostic, span, &["color"]),
        None => diagnostic,
    };
    vec![Finding::from(diagnostic).only_describing()]
}

/// Reports a path-traced picture that is almost black.
fn dark_paths(scene_probe: &SceneProbe) -> Vec<Finding> {
    let is_dark = scene_probe.is_dark();
    let lit = super::emission::dim_surfaces(scene_probe).filter(|_| !is_dark);
    if !is_dark && lit.is_none() || is_dark && super::emission::shows_bright_lamp(scene_probe) {
        return Vec::new();
    }
    let most = lit.unwrap_or_else(|| brightest(scene_probe.exposed_colors()));
    let message = match most < 1e-6 {
        _ if lit.is_some() => format!("apart from lights, the brightest value in the picture is only {}", number(most)),
        true => "nearly the whole picture is black: hardly any light reaches the camera".to_string(),
        false => format!("the brightest value in the picture is only {}", number(most)),
    };
    let factor = 0.6 / most.max(1e-9);
    let exposure = scene_probe.input.exposure;
    if exposure < MAX_LOW_EXPOSURE && most > MIN_AMPLE * exposure {
        let diagnostic = Diagnostic::warning(format!(
            "the exposure is too low: it multiplies the light by {}, so the brightest value is only {}",
            number(exposure),
            number(most)
        ))
        .effect("everything visible is black, or nearly black")
        .help(format!(
            "raise the exposure by about {} stops, with a slower shutter, a smaller f-number, a higher ISO value or a \
             larger `--exposure`",
            number(stops_of(factor).round())
        ));
        return vec![Finding::from(diagnostic).affecting_whole_picture(true)];
    }
    let diagnostic = Diagnostic::warning(message).effect("everything visible is black, or nearly black");
    let light = super::area_lights::brightest(scene_probe).filter(|_| most > 1e-6);
    let diagnostic = match light {
        Some((place, value)) => {
            let stops = number(stops_of(factor).round() + stops_of(scene_probe.input.exposure));
            let text = number(value * factor);
            diagnostic.at(place).fix(place, text.clone()).help(format!(
                "the scene needs about {} times as much light: try `{text}`, or set `--exposure {stops}`",
                number(factor)
            ))
        }
        None if scene_probe.model_format().is_some() && most > 1e-6 => dim_model(scene_probe, diagnostic, factor),
        None => diagnostic
            .help("check whether a light is enclosed, turned away or too weak, and whether fog absorbs its light"),
    };
    vec![Finding::from(diagnostic).only_describing()]
}

/// Places a finding about a dark picture of a model at its strongest emission.
fn dim_model(scene_probe: &SceneProbe, diagnostic: Diagnostic, factor: f32) -> Diagnostic {
    let needed = format!("the scene needs about {} times as much light", number(factor));
    let Some((object, radiance)) = super::emission::strongest_object(scene_probe) else {
        return diagnostic.help(format!("{needed}: increase the intensity of the lights, or set `--exposure`"));
    };
    let span = scene_probe.object_span(object);
    let material = scene_probe.world().objects()[object as usize].material as usize;
    let block = scene_probe.input.scene.materials.get(material).map(|written| written.span);
    let places = [Some(span), block].into_iter().flatten();
    let written = places.map(|block| super::written::place_of_color(scene_probe, block, radiance));
    let place = written.into_iter().flatten().next().unwrap_or(span);
    diagnostic
        .at(place)
        .label(format!("the {} emits only {}", scene_probe.object(object), vector(radiance)))
        .help(format!("{needed}: increase this emission, or set `--exposure`"))
}

/// Reports a depth range that contains none of the picture's depths.
pub(super) fn depth_range(scene_probe: &SceneProbe) -> Vec<Finding> {
    let Some((min, max)) = scene_probe.input.job.depth_range else { return Vec::new() };
    let depths: Vec<f32> = scene_probe.hits().map(|(_, hit)| hit.t).collect();
    let least = depths.iter().copied().fold(f32::INFINITY, f32::min);
    let most = depths.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    let (low, high) = (min.min(max), min.max(max));
    if min > max {
        let turned = format!("{} {}", number(max), number(min));
        let message = format!("the depth range is reversed, from {} to {}", number(min), number(max));
        let help = format!(
            "put the nearer value first: `--depth-range {turned}` (in the course's programs `-depth {turned}`)"
        );
        let diagnostic = Diagnostic::warning(message).effect("near and far are swapped in the depth picture");
        return vec![Finding::from(diagnostic.help(help))];
    }
    let outside = depths.iter().filter(|t| **t <= low || **t >= high).count();
    // A range that is far too wide maps all depths to the same grey.
    let flat = (most - least) < 0.02 * (high - low) && most > least;
    if depths.is_empty() || outside * 20 < depths.len() * 19 && !flat {
        return Vec::new();
    }
    let words = format!("the picture has depths from {} to {}", number(least), number(most));
    let fitting = format!("{} {}", number(least), number(most));
    let diagnostic =
        Diagnostic::warning(format!("the depth range {} to {} does not fit: {words}", number(min), number(max)))
            .effect(if flat {
                "the depth picture is nearly uniform grey"
            } else {
                "the depth picture is all black or all white"
            })
            .help(format!("set `--depth-range {fitting}` (in the course's programs `-depth {fitting}`)"));
    vec![Finding::from(diagnostic).affecting_whole_picture(true)]
}
