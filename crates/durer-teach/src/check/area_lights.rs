//! Checks for path tracing that find area lights whose light does not reach the visible surfaces.

use super::facing::{flip_text, flipped};
use super::finding::{Finding, MAX_FINDINGS, vector};
use super::probes::{Probe, ProbeHit};
use super::scene_probe::SceneProbe;
use super::shapes::{plane, shape};
use super::verdict::most_common;
use durer_diag::{Diagnostic, Severity, Span};
use durer_render::integrator::IntegratorKind;
use durer_render::world::emitters::emitter_of;
use durer_render::world::{Geometry, Material, Object};
use durer_scene::math::{Ray, Vec2, Vec3};
use durer_scene::scene::Material as ParsedMaterial;
use durer_scene::shape::{Flip, Shape};

/// Maximum number of visible points at which the contribution of an area light is measured.
const MAX_POINTS: usize = 200;
/// Sample points on an area light.
const ON_LIGHT: [Vec2; 4] = [Vec2::new(0.3, 0.2), Vec2::new(0.7, 0.3), Vec2::new(0.2, 0.7), Vec2::new(0.8, 0.8)];
/// Positions on the unit square at which an area light is sampled.
const MIN_CONTRIBUTION: f32 = 0.1;
const MIN_VISIBLE_SHARE: f32 = 0.03;
/// Number of rays to a light below which its occlusion is not judged.
const MIN_RAYS: usize = 40;
/// Maximum number of triangles of a mesh that is examined as an area light.
const MAX_PARTS: u32 = 4096;
/// Cosine between normals above which the triangles of a mesh form a flat area light.
const MIN_FLAT_COSINE: f32 = 0.999;

/// Light from one area light that arrives at the visible points, with and without occlusion. Both
/// are sums of cosines at the light.
#[derive(Clone, Copy, Debug, Default)]
struct AreaLightSums {
    /// Sum over the points that are in front of the light and not occluded.
    front: f32,
    back: f32,
    /// Sum over the same points if nothing occluded the light.
    front_free: f32,
    /// Sum over the points behind the light if nothing occluded it.
    back_free: f32,
    /// Number of rays that pass through glass only.
    glass: usize,
    rays: usize,
    /// The object that occludes most of the points in front of the light.
    blocker: Option<u32>,
    /// The object that occludes most of the points behind the light.
    back_blocker: Option<u32>,
}

/// Returns the objects that emit light and can be sampled, each with a flag that is true if it
/// emits on both sides.
pub(super) fn emissive_objects(scene_probe: &SceneProbe) -> Vec<(u32, bool)> {
    let world = scene_probe.world();
    let emits = |(number, object): (usize, &Object)| {
        let Some(Material::Phong(phong)) = world.materials().get(object.material as usize) else { return None };
        let emission = phong.emission.as_ref()?;
        let is_bright = scene_probe.radiance(object.material as usize).max_element() > 0.0;
        is_bright.then_some((number as u32, emission.two_sided))
    };
    world.objects().iter().enumerate().filter_map(emits).take(MAX_FINDINGS).collect()
}

/// Returns the highest `emissionLuminance` of the area lights, and its span in the scene file.
pub(super) fn brightest(scene_probe: &SceneProbe) -> Option<(Span, f32)> {
    let materials = &scene_probe.input.scene.materials;
    let lights = emissive_objects(scene_probe).into_iter().filter_map(|(number, _)| {
        let material = materials.get(scene_probe.world().objects()[number as usize].material as usize)?;
        let ParsedMaterial::Principled(layers) = &material.value else { return None };
        Some((scene_probe.field_span(material.span, &["emissionLuminance"])?, layers.emission_luminance))
    });
    lights.max_by(|a, b| a.1.total_cmp(&b.1))
}

/// Returns true if light can pass through an object because it is transparent, an interface, or not
/// opaque.
pub(super) fn transmits_light(scene_probe: &SceneProbe, object: u32) -> bool {
    match scene_probe.world().materials().get(scene_probe.world().objects()[object as usize].material as usize) {
        Some(Material::Phong(phong)) => {
            phong.transparent.max_element() > 0.0
                || phong
                    .principled
                    .as_ref()
                    .is_some_and(|own| own.interface || own.definition.opacity < 1.0 || own.maps.opacity.is_some())
        }
        _ => false,
    }
}

/// Returns the first opaque object between two points, and true if the ray passed through glass
/// before reaching it.
fn first_occluder(scene_probe: &SceneProbe, light: u32, from: Vec3, to: Vec3) -> (Option<u32>, bool) {
    let ray = Ray { t_min: 1e-3, t_max: 1.0 - 1e-3, ..Ray::new(from, to - from) };
    let mut glass = false;
    for hit in scene_probe.world().all_hits(&ray).take(16).filter(|hit| hit.object != light) {
        if !transmits_light(scene_probe, hit.object) {
            return (Some(hit.object), glass);
        }
        glass = true;
    }
    (None, glass)
}

/// Returns parts of an area light that represent all of them. Returns `None` for a mesh that is not
/// flat.
fn sampled_parts(object: &Object) -> Option<Vec<u32>> {
    let count = object.parts();
    if count == 1 {
        return Some(vec![0]);
    }
    let bounds = object.bounds().filter(|_| count <= MAX_PARTS)?;
    let (_, first) = (0..count).filter_map(|part| emitter_of(object, part)).find(|of| of.1 != Vec3::ZERO)?;
    // The heights of the parts above their common plane are compared with the size of the mesh.
    let height = |part: u32| {
        let (form, normal) = emitter_of(object, part).filter(|(_, normal)| *normal != Vec3::ZERO)?;
        let (point, ..) = form.point(normal, Vec2::splat(0.5))?;
        Some((normal.dot(first), point.dot(first.as_dvec3())))
    };
    let mut parts = Vec::new();
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for part in 0..count {
        // A part without area has no normal.
        let Some((cosine, place)) = height(part) else { continue };
        if cosine < MIN_FLAT_COSINE {
            return None;
        }
        (low, high) = (low.min(place), high.max(place));
        parts.push(part);
    }
    let flat = high - low <= 1e-3 * f64::from(bounds.size().length());
    let step = parts.len().div_ceil(ON_LIGHT.len()).max(1);
    let parts: Vec<u32> = parts.into_iter().step_by(step).collect();
    (flat && !parts.is_empty()).then_some(parts)
}

/// Measures the light from an area light that arrives at the visible points, and returns true if
/// the light is flat. Returns `None` if the light is a mesh that is not flat, or if it cannot be
/// sampled.
fn measure_area_light(scene_probe: &SceneProbe, light: u32) -> Option<(AreaLightSums, bool)> {
    let object = &scene_probe.world().objects()[light as usize];
    let all: Vec<(&Probe, &ProbeHit)> = scene_probe.hits().filter(|(_, hit)| hit.object != light).collect();
    let points = all.iter().step_by(all.len().div_ceil(MAX_POINTS).max(1));
    // Each point has the normal on the visible side of its surface if the surface is opaque.
    let points = points.map(|(probe, hit)| {
        let opaque = !transmits_light(scene_probe, hit.object);
        let at = opaque.then(|| scene_probe.world().intersect(&probe.ray, &mut ())).flatten();
        let normal = at.map(|at| if at.inside() { -at.surface.n_geo } else { at.surface.n_geo });
        (probe.ray.at(hit.t), hit.object, normal)
    });
    let mut contribution = AreaLightSums::default();
    let mut flat = true;
    let parts = sampled_parts(object)?;
    let (mut blockers, mut back_blockers) = (Vec::new(), Vec::new());
    for (place, surface, side) in points {
        for (u, part) in ON_LIGHT.into_iter().zip(parts.iter().cycle()) {
            let (point, normal) = if let Some(plane) = plane(object) {
                let n = object.to_world.as_ref().map_or(plane.normal, |m| m.normal(plane.normal)).normalize_or(Vec3::Y);
                let on = object.world_point(plane.normal * (plane.offset / plane.normal.length_squared().max(1e-12)));
                (place - (place - on).dot(n) * n, n)
            } else {
                let (form, normal) = emitter_of(object, *part)?;
                flat &= normal != Vec3::ZERO;
                let (point, n, _) = form.point(normal, u)?;
                (point.as_vec3(), n)
            };
            let direction = place - point;
            let cosine = direction.normalize_or_zero().dot(normal);
            let (blocker, glass) = first_occluder(scene_probe, light, point, place);
            // An opaque surface also occludes a light behind it.
            let behind = side.is_some_and(|side| side.dot(direction) > 0.0);
            let blocker = blocker.or(Some(surface).filter(|_| behind));
            contribution.rays += 1;
            contribution.glass += usize::from(glass && blocker.is_none());
            if cosine > 0.0 {
                contribution.front_free += cosine;
                blockers.extend(blocker);
            } else {
                contribution.back_free -= cosine;
                back_blockers.extend(blocker);
            }
            if blocker.is_none() {
                contribution.front += cosine.max(0.0);
                contribution.back -= cosine.min(0.0);
            }
        }
    }
    (contribution.blocker, contribution.back_blocker) = (most_common(&blockers), most_common(&back_blockers));
    (contribution.rays > 0).then_some((contribution, flat))
}

/// Returns the distance from an area light to the first hit along its normal, as a fraction of the
/// scene's size, or `None` if there is no hit.
fn distance_along_normal(scene_probe: &SceneProbe, object: &Object) -> Option<f32> {
    let (form, normal) = emitter_of(object, 0)?;
    let (point, n, _) = form.point(normal, Vec2::splat(0.5))?;
    let ray = Ray { t_min: 1e-5, ..Ray::new(point.as_vec3(), n) };
    let hit = scene_probe.world().closest(&ray, &mut ())?;
    Some(hit.t / scene_probe.world().bounds().size().length().max(1e-6))
}

/// Reports area lights that face away from the visible points.
pub(super) fn facing_away(scene_probe: &SceneProbe) -> Vec<Finding> {
    let one_sided = emissive_objects(scene_probe).into_iter().filter(|(_, both)| !both && scene_probe.is_physical());
    let say = |(number, _): (u32, bool)| {
        let object = &scene_probe.world().objects()[number as usize];
        let (contribution, flat) = measure_area_light(scene_probe, number)?;
        // A light that illuminates the ceiling may be intentional.
        let indirect =
            distance_along_normal(scene_probe, object).is_some_and(|far| far > 0.03) && !scene_probe.is_dark();
        // A body also emits away from everything that is inside it.
        let is_around = contribution.front_free == 0.0;
        if !(flat || is_around)
            || contribution.back <= 0.0
            || contribution.front > MIN_CONTRIBUTION * contribution.back
            || indirect
        {
            return None;
        }
        let flip = shape(object).and_then(Shape::flip);
        let help = match flip {
            _ if scene_probe.model_format().is_some() => model_help(scene_probe, number),
            None if plane(object).is_none() && shape(object).is_some() => {
                "a surface emits light on the side of its normal, here outwards: set `walls thin` in the material so \
                 that both sides emit light"
                    .into()
            }
            _ => {
                let turn = match flip {
                    Some(Flip::Corners(_)) => "swap two vertices of the triangle".into(),
                    Some(flip) => flip_text(flip),
                    None if plane(object).is_some() => "negate `normal`".into(),
                    None => "reverse the order of the vertices of the faces".into(),
                };
                format!(
                    "{turn}, because a surface emits light on the side of its normal; or set `walls thin` in the \
                     material so that both sides emit light"
                )
            }
        };
        let message = format!("the {} emits light away from everything visible", scene_probe.object(number));
        let diagnostic = Diagnostic::warning(message)
            .at(scene_probe.object_span(number))
            .effect("the light illuminates nothing visible, and its back is black")
            .help(help);
        let whole = scene_probe.is_dark() || scene_probe.world().lights().is_empty();
        Some(Finding::from(with_flip(scene_probe, diagnostic, number)).affecting_whole_picture(whole))
    };
    one_sided.filter_map(say).collect()
}

/// Returns the help about an area light of a model that faces away. A light that lies in the
/// surface of another object is in the wrong place.
fn model_help(scene_probe: &SceneProbe, number: u32) -> String {
    let object = &scene_probe.world().objects()[number as usize];
    let center = object.bounds().map_or(Vec3::ZERO, |bounds| bounds.center());
    if let Some(other) = surface_at(scene_probe, number, center) {
        return format!(
            "check the transforms of the light and their order: its center is at {}, in the surface of the {}",
            vector(center),
            scene_probe.object(other)
        );
    }
    let turn = match object.geometry {
        Geometry::Mesh(_) => "turn the light towards the scene, or reverse the order of its vertices",
        Geometry::Primitive(_) | Geometry::Solid(_) => "turn the light towards the scene",
    };
    format!(
        "{turn}: a surface emits light on the side of its normal, and the center of this one is at {}",
        vector(center)
    )
}

/// Returns the object other than a light whose surface passes through the center of the light.
fn surface_at(scene_probe: &SceneProbe, light: u32, center: Vec3) -> Option<u32> {
    let (_, n) = emitter_of(&scene_probe.world().objects()[light as usize], 0)?;
    let step = 1e-3 * scene_probe.world().bounds().size().length() * n.normalize_or(Vec3::Y);
    let across = Ray { t_max: 1.0, ..Ray::new(center - step, 2.0 * step) };
    let hits = scene_probe.world().hits_of_each(&across).map(|hit| hit.object);
    hits.into_iter().find(|object| *object != light)
}

/// Adds the edit that flips a flat area light. A triangle gets no edit because any two of its
/// corners could be swapped.
fn with_flip(scene_probe: &SceneProbe, diagnostic: Diagnostic, number: u32) -> Diagnostic {
    match shape(&scene_probe.world().objects()[number as usize]).and_then(Shape::flip) {
        Some(Flip::Edges(_) | Flip::Negate(_)) => flipped(scene_probe, &diagnostic, number).unwrap_or(diagnostic),
        Some(Flip::Corners(_)) | None => diagnostic,
    }
}

/// Reports area lights that are occluded from all visible points.
pub(super) fn blocked(scene_probe: &SceneProbe) -> Vec<Finding> {
    if !scene_probe.is_physical() {
        return Vec::new();
    }
    let lights = emissive_objects(scene_probe);
    let say = |&(number, both): &(u32, bool)| {
        let (contribution, _) = measure_area_light(scene_probe, number)?;
        if let Some(finding) = enclosed_and_turned(scene_probe, number, &contribution) {
            return Some(finding);
        }
        let blocker = contribution.blocker?;
        let back = if both { contribution.back } else { 0.0 };
        if contribution.rays < MIN_RAYS
            || contribution.front_free < 1.0
            || contribution.front + back > MIN_VISIBLE_SHARE * contribution.front_free
        {
            return None;
        }
        let whole = scene_probe.is_dark() || lights.len() == 1 && scene_probe.world().lights().is_empty();
        let name = scene_probe.object(number);
        let diagnostic = Diagnostic::warning(format!(
            "the {name} emits light, but the {} occludes it from everything visible",
            scene_probe.object(blocker)
        ))
        .at(scene_probe.object_span(number))
        .related(scene_probe.object_span(blocker), "the occluder")
        .effect(if scene_probe.is_dark() {
            "the picture is black"
        } else {
            "none of this light reaches the visible surfaces directly"
        })
        .help("move the light out of the occluder, or to the side of the visible surfaces");
        // If the picture is not dark, the light arrives indirectly, or the light of the sky does.
        let is_lost = scene_probe.is_dark() || whole && !is_reached(scene_probe, number, both);
        let severity = if is_lost { Severity::Warning } else { Severity::Note };
        (is_lost || lights.len() > 1)
            .then(|| Finding::from(Diagnostic { severity, ..diagnostic }).affecting_whole_picture(whole))
    };
    lights.iter().filter_map(say).collect()
}

/// Returns true if an area light reaches the visible points, directly or after reflections.
fn is_reached(scene_probe: &SceneProbe, light: u32, both: bool) -> bool {
    let object = &scene_probe.world().objects()[light as usize];
    // A light that cannot be sampled counts as reached.
    let Some(parts) = sampled_parts(object) else { return true };
    ON_LIGHT.into_iter().zip(parts.iter().cycle()).any(|(u, part)| {
        let Some((form, normal)) = emitter_of(object, *part) else { return true };
        super::scene_probe::Reach::of(scene_probe).is_reached(scene_probe, |point| {
            let (place, n, _) = form.point(normal, u)?;
            let to_light = place.as_vec3() - point;
            (both || n.dot(to_light) < 0.0).then(|| (to_light.normalize_or_zero(), to_light.length()))
        })
    })
}

/// Reports a one-sided area light that faces away from everything visible, but is also occluded, so
/// that turning it would not help.
fn enclosed_and_turned(scene_probe: &SceneProbe, number: u32, sums: &AreaLightSums) -> Option<Finding> {
    let all = sums.front + sums.back;
    let is_hidden = sums.back_free >= 1.0 && sums.front_free < 1.0 && all <= MIN_VISIBLE_SHARE * sums.back_free;
    let blocker = sums.back_blocker.filter(|_| is_hidden && sums.rays >= MIN_RAYS && scene_probe.is_dark())?;
    let object = &scene_probe.world().objects()[number as usize];
    let center = vector(object.bounds()?.center());
    let name = scene_probe.object(number);
    let diagnostic = Diagnostic::warning(format!(
        "the {name} emits light, but it faces away from everything visible and is behind the {}",
        scene_probe.object(blocker)
    ))
    .at(scene_probe.object_span(number))
    .related(scene_probe.object_span(blocker), "the occluder")
    .effect("the picture is black")
    .help(match scene_probe.model_format() {
        Some(_) => format!("check the transforms of the light and their order: its center is at {center}"),
        None => format!("move the light to the side of the visible surfaces: its center is at {center}"),
    });
    Some(Finding::from(diagnostic).affecting_whole_picture(true))
}

/// Reports area lights inside glass, which paths hit only by chance or never.
pub(super) fn in_glass(scene_probe: &SceneProbe) -> Vec<Finding> {
    let world = scene_probe.world();
    if !matches!(scene_probe.input.job.method, IntegratorKind::Path(_)) {
        return Vec::new();
    }
    let around = |point: Vec3, own: Option<u32>| {
        let bodies = world.objects().iter().enumerate().map(|(number, _)| number as u32).filter(|n| Some(*n) != own);
        bodies.take(500).find(|&number| {
            let Some(Material::Phong(phong)) =
                world.materials().get(world.objects()[number as usize].material as usize)
            else {
                return false;
            };
            let skin = phong.principled.as_ref().is_none_or(|layers| !layers.interface);
            skin && phong.transparent.max_element() > 0.0
                && phong.ior != 1.0
                && world.objects()[number as usize].contains(point)
        })
    };
    let mut findings = super::physical::light_in_glass(scene_probe);
    findings.extend(super::integrator::behind_glass(scene_probe));
    for (number, _) in emissive_objects(scene_probe) {
        let Some(middle) = world.objects()[number as usize].bounds().map(|bounds| bounds.center()) else { continue };
        let Some(glass) = around(middle, Some(number)) else { continue };
        if measure_area_light(scene_probe, number)
            .is_some_and(|(contribution, _)| contribution.glass * 2 <= contribution.rays)
        {
            continue;
        }
        let message =
            format!("the {} emits light inside the {}", scene_probe.object(number), scene_probe.object(glass));
        let diagnostic = Diagnostic::warning(message)
            .at(scene_probe.object_span(number))
            .related(scene_probe.object_span(glass), "the glass around the light")
            .effect("paths hit the light only by chance, so the picture is dark and has bright specks")
            .help("use `--integrator photons`, or remove the glass");
        findings.push(Finding::from(diagnostic));
    }
    findings
}
