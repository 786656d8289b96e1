//! Checks for fields of layered materials that another field makes ineffective.

use super::finding::{Finding, MAX_FINDINGS};
use super::layers::layers;
use super::scene_probe::SceneProbe;
use durer_diag::Diagnostic;
use durer_render::world::Geometry;
use durer_scene::material::PrincipledMaterial;
use durer_scene::material::principled::Walls;
use durer_scene::shape::Primitive;

/// Weight above which a field takes effect.
const VISIBLE: f32 = 0.05;

/// A field without effect, the reason, and help.
type Idle = (&'static str, &'static str, &'static str);

/// Reports layers that a material states, but that other fields remove.
pub(super) fn idle_layer(scene_probe: &SceneProbe) -> Vec<Finding> {
    // Readers of models report such fields themselves.
    if !scene_probe.is_physical() || scene_probe.model_format().is_some() {
        return Vec::new();
    }
    let mut findings = Vec::new();
    for (number, material, m) in layers(scene_probe) {
        let Some((field, reason, help)) = idle_field(m) else { continue };
        // A preset can bring fields that are not written.
        let Some(place) = scene_probe.field_span(material.span, &[field]) else { continue };
        let message = format!("`{field}` has no effect in material {number}: {reason}");
        let diagnostic = Diagnostic::warning(message).at(place).effect("this layer is invisible").help(help);
        findings.push(Finding::from(diagnostic));
    }
    findings.extend(hollow_glass(scene_probe));
    findings.truncate(MAX_FINDINGS);
    findings
}

fn idle_field(m: &PrincipledMaterial) -> Option<Idle> {
    let no_metal_map = m.base_metalness_texture.is_none() && m.metallic_roughness_texture.is_none();
    let is_metal = m.base_metalness >= 1.0 && no_metal_map;
    let film = m.thin_film_weight > VISIBLE && m.thin_film_weight_texture.is_none();
    match () {
        () if film && m.thin_film_thickness == 0.0 => Some((
            "thinFilmWeight",
            "`thinFilmThickness` is 0, so there is no film",
            "write, for example, `thinFilmThickness 0.4`, in micrometres",
        )),
        () if is_metal && m.transmission_weight > VISIBLE => Some((
            "transmissionWeight",
            "`baseMetalness` is 1, and metal lets no light through",
            "write `baseMetalness 0` for glass",
        )),
        () if is_metal && m.subsurface_weight > VISIBLE => Some((
            "subsurfaceWeight",
            "`baseMetalness` is 1, and no light enters metal",
            "write `baseMetalness 0` for a translucent body",
        )),
        () => None,
    }
}

/// Returns notes about glass with thin walls on a closed body that contains nothing.
fn hollow_glass(scene_probe: &SceneProbe) -> Vec<Finding> {
    let world = scene_probe.world();
    let say = |(number, material, m): super::layers::Layered| {
        let place = scene_probe.field_span(material.span, &["walls"])?;
        let is_glass = m.transmission_weight > 0.5 && m.base_metalness < 0.5 && m.opacity > 0.5;
        let is_clear = m.thin_film_weight == 0.0 && (m.specular_ior - 1.0).abs() > 0.1;
        if m.walls != Walls::Thin || !is_glass || !is_clear {
            return None;
        }
        let mut own = world.objects().iter().enumerate().filter(|(_, object)| object.material as usize == number);
        let is_closed = |geometry: &Geometry| {
            matches!(geometry, Geometry::Primitive(Primitive::Sphere(_) | Primitive::Cuboid(_)) | Geometry::Solid(_))
        };
        let is_empty = |index: usize| {
            let inside = |other: usize| {
                let middle = world.objects()[other].bounds().map(|bounds| bounds.center());
                middle.is_some_and(|middle| world.objects()[index].contains(middle))
            };
            !(0..world.objects().len().min(MAX_FINDINGS)).any(|other| other != index && inside(other))
        };
        if !own.all(|(index, object)| is_closed(&object.geometry) && is_empty(index)) {
            return None;
        }
        let message = format!("the walls of material {number} are thin, so its objects are hollow, like bubbles");
        let diagnostic = Diagnostic::note(message)
            .at(place)
            .effect("light passes through the objects without being refracted")
            .help("remove `walls thin` for solid glass");
        Some(Finding::from(diagnostic))
    };
    layers(scene_probe).into_iter().filter_map(say).collect()
}
