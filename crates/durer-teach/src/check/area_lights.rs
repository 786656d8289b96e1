//! Checks for path tracing of area lights whose light does not reach the visible surfaces.

use super::facing::{flip_text, flipped};
use super::finding::{Finding, MAX_SOUGHT};
use super::scene_probe::SceneProbe;
use super::shapes::{plane, shape};
use durer_diag::{Diagnostic, Severity, Span};
use durer_render::integrator::IntegratorKind;
use durer_render::world::emitters::emitter_of;
use durer_render::world::{Material, Object};
use durer_scene::math::{Ray, Vec2, Vec3};
use durer_scene::scene::Material as Written;
use durer_scene::shape::{Flip, Shape};

/// Maximum number of visible points at which the contribution of an area light is measured.
const MAX_PLACES: usize = 200;
/// Sample points on an area light.
const ON_LIGHT: [Vec2; 4] = [Vec2::new(0.3, 0.2), Vec2::new(0.7, 0.3), Vec2::new(0.2, 0.7), Vec2::new(0.8, 0.8)];
/// Positions on the unit square at which an area light is sampled.
const NOTHING: f32 = 0.1;
const HARDLY: f32 = 0.03;

/// Light from one area light at the visible points, with and without occlusion; each sum is of
/// cosines at the light.
#[derive(Clone, Copy, Debug, Default)]
struct AreaLightShare {
    /// Sum over the points in front of the light that nothing occludes.
    front: f32,
    back: f32,
    /// Sum as if nothing occluded the light.
    front_free: f32,
    /// Number of rays that pass only through glass.
    glass: usize,
    rays: usize,
    /// The last object found to occlude a point in front of the light.
    blocker: Option<u32>,
}

/// Returns the objects that emit light and can be sampled, each with true if it emits on both
/// sides.
pub(super) fn emissive_objects(scout: &SceneProbe) -> Vec<(u32, bool)> {
    let world = scout.world();
    let emits = |(number, object): (usize, &Object)| {
        let Some(Material::Phong(phong)) = world.materials().get(object.material as usize) else { return None };
        let emission = phong.emission.as_ref().filter(|emission| emission.radiance.max_element() > 0.0)?;
        Some((number as u32, emission.two_sided))
    };
    world.objects().iter().enumerate().filter_map(emits).take(MAX_SOUGHT).collect()
}

/// Returns the highest `emissionLuminance` of the area lights, and its span in the scene file.
pub(super) fn brightest(scout: &SceneProbe) -> Option<(Span, f32)> {
    let materials = &scout.subject.scene.materials;
    let lights = emissive_objects(scout).into_iter().filter_map(|(number, _)| {
        let written = materials.get(scout.world().objects()[number as usize].material as usize)?;
        let Written::Principled(layers) = &written.value else { return None };
        Some((scout.value(written.span, &["emissionLuminance"])?, layers.emission_luminance))
    });
    lights.max_by(|a, b| a.1.total_cmp(&b.1))
}

/// Returns true if light can pass through an object: it is transparent, an interface, or not
/// opaque.
fn is_clear(scout: &SceneProbe, object: u32) -> bool {
    match scout.world().materials().get(scout.world().objects()[object as usize].material as usize) {
        Some(Material::Phong(phong)) => {
            phong.transparent.max_element() > 0.0
                || phong.principled.as_ref().is_some_and(|own| own.interface || own.definition.opacity < 1.0)
        }
        _ => false,
    }
}

/// Returns the first opaque object between two points, and true if the ray passed through glass
/// before it.
fn between(scout: &SceneProbe, light: u32, from: Vec3, to: Vec3) -> (Option<u32>, bool) {
    let ray = Ray { t_min: 1e-3, t_max: 1.0 - 1e-3, ..Ray::new(from, to - from) };
    let mut glass = false;
    for hit in scout.world().all_hits(&ray).take(16).filter(|hit| hit.object != light) {
        if !is_clear(scout, hit.object) {
            return (Some(hit.object), glass);
        }
        glass = true;
    }
    (None, glass)
}

/// Measures the light from an area light at the visible points, and returns true if the light is
/// flat. `None` if the light consists of several parts or cannot be sampled.
fn contribution(scout: &SceneProbe, light: u32) -> Option<(AreaLightShare, bool)> {
    let object = &scout.world().objects()[light as usize];
    let all: Vec<Vec3> =
        scout.seen().filter(|(_, seen)| seen.object != light).map(|(probe, seen)| probe.ray.at(seen.t)).collect();
    let places = all.iter().step_by(all.len().div_ceil(MAX_PLACES).max(1));
    let mut contribution = AreaLightShare::default();
    let mut flat = true;
    for place in places {
        for u in ON_LIGHT {
            let (point, normal) = if let Some(plane) = plane(object) {
                let n = object.to_world.as_ref().map_or(plane.normal, |m| m.normal(plane.normal)).normalize_or(Vec3::Y);
                let on = object.world_point(plane.normal * (plane.offset / plane.normal.length_squared().max(1e-12)));
                (*place - (*place - on).dot(n) * n, n)
            } else if object.parts() == 1 {
                let (form, normal) = emitter_of(object, 0)?;
                flat &= normal != Vec3::ZERO;
                let (point, n, _) = form.point(normal, u)?;
                (point.as_vec3(), n)
            } else {
                return None;
            };
            let way = *place - point;
            let cosine = way.normalize_or_zero().dot(normal);
            let (blocker, glass) = between(scout, light, point, *place);
            contribution.rays += 1;
            contribution.glass += usize::from(glass && blocker.is_none());
            if cosine > 0.0 {
                contribution.front_free += cosine;
                contribution.blocker = blocker.or(contribution.blocker);
            }
            if blocker.is_none() {
                contribution.front += cosine.max(0.0);
                contribution.back -= cosine.min(0.0);
            }
        }
    }
    (contribution.rays > 0).then_some((contribution, flat))
}

/// Returns the distance from an area light to the first hit along its normal, as a fraction of the
/// scene's size; `None` if there is no hit.
fn reach(scout: &SceneProbe, object: &Object) -> Option<f32> {
    let (form, normal) = emitter_of(object, 0)?;
    let (point, n, _) = form.point(normal, Vec2::splat(0.5))?;
    let ray = Ray { t_min: 1e-5, ..Ray::new(point.as_vec3(), n) };
    let hit = scout.world().closest(&ray, &mut ())?;
    Some(hit.t / scout.world().bounds().size().length().max(1e-6))
}

/// Reports area lights that face away from the visible points.
pub(super) fn turned(scout: &SceneProbe) -> Vec<Finding> {
    let one_sided = emissive_objects(scout).into_iter().filter(|(_, both)| !both && scout.is_physical());
    let say = |(number, _): (u32, bool)| {
        let object = &scout.world().objects()[number as usize];
        let (contribution, flat) = contribution(scout, number)?;
        // A light that illuminates the ceiling may be intended.
        let indirect = reach(scout, object).is_some_and(|far| far > 0.03) && !scout.is_dark();
        if !flat || contribution.back <= 0.0 || contribution.front > NOTHING * contribution.back || indirect {
            return None;
        }
        let turn = match shape(object).and_then(Shape::flip) {
            Some(Flip::Corners(_)) => "swap two of its corners".into(),
            Some(flip) => flip_text(flip),
            None => "negate its `normal`".into(),
        };
        let message = format!("the {} emits light away from everything visible", scout.object(number));
        let diagnostic = Diagnostic::warning(message)
            .at(scout.object_span(number))
            .effect("it lights nothing visible, and its back is black")
            .help(format!(
                "a surface emits light on the side of its normal: {turn}, or set `walls thin` in its material so \
                 that both sides emit light"
            ));
        let whole = scout.is_dark() || scout.world().lights().is_empty();
        Some(Finding::from(turned_round(scout, diagnostic, number)).whole(whole))
    };
    one_sided.filter_map(say).collect()
}

/// Adds the edit that flips a flat area light. For a triangle there is no edit: any two of its
/// corners can be swapped.
fn turned_round(scout: &SceneProbe, diagnostic: Diagnostic, number: u32) -> Diagnostic {
    match shape(&scout.world().objects()[number as usize]).and_then(Shape::flip) {
        Some(Flip::Edges(_) | Flip::Negate(_)) => flipped(scout, &diagnostic, number).unwrap_or(diagnostic),
        Some(Flip::Corners(_)) | None => diagnostic,
    }
}

/// Reports area lights that are occluded from all visible points.
pub(super) fn blocked(scout: &SceneProbe) -> Vec<Finding> {
    if !scout.is_physical() {
        return Vec::new();
    }
    let lights = emissive_objects(scout);
    let say = |&(number, both): &(u32, bool)| {
        let (contribution, _) = contribution(scout, number)?;
        let blocker = contribution.blocker?;
        let back = if both { contribution.back } else { 0.0 };
        if contribution.front_free < 1.0 || contribution.front + back > HARDLY * contribution.front_free {
            return None;
        }
        let whole = scout.is_dark() || lights.len() == 1 && scout.world().lights().is_empty();
        let name = scout.object(number);
        let diagnostic = Diagnostic::warning(format!(
            "the {name} emits light, but the {} occludes it from everything visible",
            scout.object(blocker)
        ))
        .at(scout.object_span(number))
        .related(scout.object_span(blocker), "the occluder")
        .effect(if scout.is_dark() {
            "the picture is black"
        } else {
            "none of its light reaches the visible surfaces directly"
        })
        .help("is the light on the wrong side, or inside? Move it to the visible side");
        // If the picture is not dark, the light arrives indirectly.
        let dark = scout.is_dark();
        let severity = if dark { Severity::Warning } else { Severity::Note };
        (dark || lights.len() > 1).then(|| Finding::from(Diagnostic { severity, ..diagnostic }).whole(whole))
    };
    lights.iter().filter_map(say).collect()
}

/// Reports area lights inside glass: paths hit them only by chance, or never.
pub(super) fn in_glass(scout: &SceneProbe) -> Vec<Finding> {
    let world = scout.world();
    if !matches!(scout.subject.job.method, IntegratorKind::Path(_)) {
        return Vec::new();
    }
    let around = |place: Vec3, own: Option<u32>| {
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
                && world.objects()[number as usize].contains(place)
        })
    };
    let mut found = super::physical::lamp_in_glass(scout);
    for (number, _) in emissive_objects(scout) {
        let Some(middle) = world.objects()[number as usize].bounds().map(|bounds| bounds.center()) else { continue };
        let Some(glass) = around(middle, Some(number)) else { continue };
        if contribution(scout, number).is_some_and(|(contribution, _)| contribution.glass * 2 <= contribution.rays) {
            continue;
        }
        let message = format!("the {} emits light inside the {}", scout.object(number), scout.object(glass));
        let diagnostic = Diagnostic::warning(message)
            .at(scout.object_span(number))
            .related(scout.object_span(glass), "the glass around it")
            .effect("paths hit it only by chance, so the picture has little light and bright specks")
            .help("use `--integrator photons`, or remove the glass");
        found.push(Finding::from(diagnostic));
    }
    found
}
