//! Determines what each light contributes at the visible points, and why some lights contribute
//! nothing.

use super::aim::BeamMiss;
use super::containment::containing_objects;
use super::probes::{LightContribution, Probe, ProbeGrid, ProbeHit};
use super::shapes::point;
use durer_render::world::Material;
use durer_scene::camera::Projection;
use durer_scene::light::{Illuminate as _, Light};
use durer_scene::math::{Color, Ray, Vec3};

/// Half a step of an eight-bit value. Smaller contributions are invisible.
pub(super) const VISIBLE: f32 = 1.0 / 512.0;
/// Maximum number of lights that are examined. Additional lights count as working.
pub(super) const MAX_LIGHTS: usize = 500;
/// Fraction of the visible points below which a light counts as contributing nothing.
const MIN_LIT_SHARE: f32 = 0.002;
/// Fraction of shadowed points above which a light is blocked. Only points that face the light
/// count.
const MAX_BLOCKED: f32 = 0.95;
/// Minimum fraction of the points facing a light that a roof over all objects must put in shadow.
const MIN_ROOF_SHADOW: f32 = 0.6;
/// Total light below which the lights are practically invisible.
const MIN_TOTAL_LIGHT: f32 = 0.06;
/// Cosine below which light hits a surface at a grazing angle.
pub(super) const GRAZING: f32 = 0.08;

/// Result of examining a light: whether it contributes at the visible points and, if not, why not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum LightVerdict {
    /// The light contributes to the picture, or no visible point could receive its light.
    Works,
    /// The light's colour is black.
    Black,
    /// The attenuation divides by zero or by a negative number.
    Divides,
    /// The light is inside this object.
    Inside(u32),
    /// This object blocks the light at more points than any other object.
    Blocked(u32),
    /// The visible surfaces face away from the light.
    Behind,
    /// The beam misses the visible surfaces.
    Missing,
    /// The light is too weak, since at most this much of it arrives.
    Faint(f32),
    /// The surfaces completely absorb the light's colour.
    Cancelled,
}

/// Examines each light of the world and returns the verdicts by index.
pub(super) fn verdicts(grid: &ProbeGrid, aims: &[Option<BeamMiss>]) -> Vec<LightVerdict> {
    let judged = |light| if light < MAX_LIGHTS { verdict(grid, light, aims) } else { LightVerdict::Works };
    let mut verdicts: Vec<LightVerdict> = (0..grid.world().lights().len()).map(judged).collect();
    if let Some(most) = weak_together(grid, &verdicts) {
        verdicts.iter_mut().for_each(|verdict| *verdict = LightVerdict::Faint(most));
    }
    if cancelled_together(grid, &verdicts) {
        verdicts.iter_mut().for_each(|verdict| *verdict = LightVerdict::Cancelled);
    }
    verdicts
}

/// Returns the amount of light that arrives if there are at most three lights and all of them
/// together are almost invisible.
fn weak_together(grid: &ProbeGrid, verdicts: &[LightVerdict]) -> Option<f32> {
    if verdicts.is_empty() || verdicts.len() > 3 || verdicts.iter().any(|verdict| *verdict != LightVerdict::Works) {
        return None;
    }
    let most = |of: fn(&LightContribution) -> Color| {
        let sums = grid.hits().map(|(_, hit)| hit.lights.iter().map(of).sum::<Color>().max_element());
        sums.fold(0.0, f32::max)
    };
    let (arrives, adds) = (most(|lit| lit.unoccluded), most(|lit| lit.contribution));
    (arrives > 0.0 && arrives < MIN_TOTAL_LIGHT && adds < MIN_TOTAL_LIGHT).then_some(arrives)
}

/// Returns true if almost all surfaces that the lights reach absorb the colour of the lights.
fn cancelled_together(grid: &ProbeGrid, verdicts: &[LightVerdict]) -> bool {
    let materials = grid.world().materials();
    if !verdicts.contains(&LightVerdict::Works)
        || verdicts.iter().any(|v| !matches!(v, LightVerdict::Works | LightVerdict::Cancelled))
    {
        return false;
    }
    let (mut reached, mut lost) = (0, 0);
    for (_, hit) in grid.hits() {
        let Some(Material::Phong(phong)) = materials.get(hit.material as usize) else { return false };
        let lit = hit.lights.iter().filter(|lit| lit.cosine > 0.05 && lit.blocker.is_none());
        let arrives: Color = lit.map(|lit| lit.unoccluded).sum();
        if arrives.max_element() < 0.1 || phong.diffuse.max_element() < 0.1 || phong.texture.is_some() {
            continue;
        }
        reached += 1;
        lost += usize::from((arrives * phong.diffuse).max_element() < VISIBLE);
    }
    reached > 20 && lost * 10 > reached * 8
}

fn verdict(grid: &ProbeGrid, number: usize, aims: &[Option<BeamMiss>]) -> LightVerdict {
    let light = &grid.world().lights()[number];
    // Clear glass shows what is behind it and not the light that reaches it.
    let clear = |hit: &ProbeHit| match &grid.world().materials()[hit.material as usize] {
        Material::Phong(phong) => phong.transparent.min_element() > 0.5 && phong.diffuse.max_element() < 0.1,
        Material::Mix(..) => false,
    };
    let lit = grid.hits().filter(|(_, hit)| !clear(hit));
    let all: Vec<&LightContribution> = lit.filter_map(|(_, hit)| hit.contribution(number)).collect();
    if light.color() == Color::ZERO {
        return LightVerdict::Black;
    }
    let odd = |lit: &&LightContribution| {
        !lit.unoccluded.is_finite() || lit.unoccluded.min_element() < 0.0 && light.color().min_element() >= 0.0
    };
    if attenuation(light) == Some(Vec3::ZERO) || all.iter().any(odd) {
        return LightVerdict::Divides;
    }
    if aims[number].is_some() {
        return LightVerdict::Missing;
    }
    let visible = all.iter().filter(|lit| lit.contribution.abs().max_element() > VISIBLE).count();
    // If there are only a few lights, each of them is probably meant to have a visible effect.
    let most = all.iter().map(|lit| lit.contribution.abs().max_element()).fold(0.0, f32::max);
    let arrives = all.iter().map(|lit| lit.unoccluded.abs().max_element()).fold(0.0, f32::max);
    if grid.world().lights().len() <= 3 && most > VISIBLE && most < 6.0 * VISIBLE && arrives < 12.0 * VISIBLE {
        return LightVerdict::Faint(arrives);
    }
    let is_blocked = nearly_blocked(&all) || is_under_roof(grid, number);
    if all.is_empty() || visible as f32 > MIN_LIT_SHARE * all.len() as f32 && !is_blocked {
        return LightVerdict::Works;
    }
    if let Some(position) = light.position()
        && let Some(&object) =
            containing_objects(grid.world(), position).iter().find(|&&object| encloses_light(grid, object, &all))
    {
        return LightVerdict::Inside(object);
    }
    let facing: Vec<&&LightContribution> = all.iter().filter(|lit| lit.cosine > 1e-3).collect();
    let blocked: Vec<u32> = facing.iter().filter_map(|lit| lit.blocker).collect();
    if facing.len() - blocked.len() > all.len() / 50 && !is_blocked {
        let most = facing.iter().map(|lit| lit.unoccluded.abs().max_element()).fold(0.0, f32::max);
        // At grazing angles, a surface is dark regardless of its colour.
        let colored = |hit: &ProbeHit| match &grid.world().materials()[hit.material as usize] {
            // Mirrors and other surfaces without diffuse reflection do not absorb a light's colour.
            Material::Phong(phong) => phong.diffuse.max_element() >= 0.05,
            Material::Mix(..) => true,
        };
        let lit = grid.hits().filter(|(_, hit)| !clear(hit) && colored(hit));
        let lit = lit.filter_map(|(_, hit)| hit.contribution(number));
        let lit = lit.filter(|lit| lit.blocker.is_none() && lit.cosine > GRAZING);
        let (full, lost) =
            lit.filter(|lit| lit.unoccluded.abs().max_element() > 4.0 * VISIBLE).fold((0, 0), |(n, lost), lit| {
                (n + 1, lost + usize::from(lit.contribution.abs().max_element() <= VISIBLE))
            });
        let dull = facing.iter().filter(|lit| lit.blocker.is_none() && lit.cosine > GRAZING).count() > 4 && full == 0;
        return match most < 4.0 * VISIBLE {
            true => LightVerdict::Faint(most),
            false if full > 4 && lost * 10 > full * 9 => LightVerdict::Cancelled,
            false if full > 0 || dull => LightVerdict::Works,
            false => LightVerdict::Behind,
        };
    }
    match main_blocker(grid, number, &blocked)
        .filter(|_| blocked.len() * 5 > all.len())
        .or_else(|| behind_plane(grid, light))
    {
        Some(object) => LightVerdict::Blocked(object),
        None => LightVerdict::Behind,
    }
}

/// Returns true if almost all points that face a light are in its shadow. A few lit pixels at the
/// horizon do not matter.
fn nearly_blocked(all: &[&LightContribution]) -> bool {
    let facing: Vec<&&LightContribution> = all.iter().filter(|lit| lit.cosine > 1e-3).collect();
    let blocked = facing.iter().filter(|lit| lit.blocker.is_some()).count();
    blocked as f32 > MAX_BLOCKED * facing.len() as f32 && facing.len() * 5 > all.len()
}

/// Returns true if one object casts a shadow on all other bounded objects that face a light, and on
/// most of the remaining points.
fn is_under_roof(grid: &ProbeGrid, light: usize) -> bool {
    let objects = grid.world().objects();
    let facing = || {
        let all = grid.hits().filter_map(|(_, hit)| Some((hit.object, hit.contribution(light)?)));
        all.filter(|(_, lit)| lit.cosine > GRAZING)
    };
    let blockers: Vec<u32> = facing().filter_map(|(_, lit)| lit.blocker).collect();
    let Some(roof) = most_common(&blockers) else { return false };
    let under = |(_, lit): &(u32, &LightContribution)| lit.blocker.is_some();
    let items = || facing().filter(|(object, _)| *object != roof && objects[*object as usize].bounds().is_some());
    let (count, covered) = (items().count(), items().filter(under).count());
    let (all, dark) = (facing().count(), facing().filter(|(_, lit)| lit.blocker == Some(roof)).count());
    count > 20 && covered as f32 > MAX_BLOCKED * count as f32 && dark as f32 > MIN_ROOF_SHADOW * all as f32
}

/// Returns the object that blocks a light at the largest number of points. Several objects can
/// block the same point.
fn main_blocker(grid: &ProbeGrid, light: usize, blocked: &[u32]) -> Option<u32> {
    let (common, emitter) = (most_common(blocked)?, &grid.world().lights()[light]);
    let places = grid.hits().filter(|(_, seen)| seen.contribution(light).is_some_and(|lit| lit.blocker.is_some()));
    let mut all = Vec::new();
    for (probe, seen) in places.step_by((blocked.len() / 60).max(1)) {
        let point = probe.ray.at(seen.t).as_dvec3();
        let seen = emitter.illuminate(point);
        let reach = if seen.distance.is_finite() { seen.distance } else { f32::INFINITY };
        let ray = Ray { t_min: 1e-3, t_max: 0.999 * reach, ..Ray::new(point.as_vec3(), seen.to_light) };
        let mut hit: Vec<u32> = grid.world().all_hits(&ray).take(16).map(|hit| hit.object).collect();
        hit.sort_unstable();
        hit.dedup();
        all.extend(hit);
    }
    let count = |object: u32| all.iter().filter(|other| **other == object).count();
    // The object that is most often hit first is reported, unless another one blocks the light at
    // more points.
    most_common(&all).filter(|other| count(*other) * 10 > count(common) * 11).or(Some(common))
}

/// Maximum number of points at which the shadow of one object is tested.
const MAX_POINTS: usize = 100;

/// Returns true if one object blocks a light at nearly all points that face it, even without the
/// other objects.
pub(super) fn blocks_alone(grid: &ProbeGrid, light: usize, object: u32) -> bool {
    let emitter = &grid.world().lights()[light];
    let faces = |hit: &ProbeHit| hit.contribution(light).is_some_and(|lit| lit.cosine > GRAZING);
    let facing: Vec<_> = grid.hits().filter(|(_, hit)| hit.object != object && faces(hit)).collect();
    let is_blocked = |(probe, hit): &&(&Probe, &ProbeHit)| {
        let point = probe.ray.at(hit.t);
        let seen = emitter.illuminate(point.as_dvec3());
        let ray = Ray { t_min: 1e-3, t_max: 0.999 * seen.distance, ..Ray::new(point, seen.to_light) };
        grid.world().hit_of(object, &ray.into()).is_some()
    };
    let points: Vec<_> = facing.iter().step_by(facing.len().div_ceil(MAX_POINTS).max(1)).collect();
    let blocked = points.iter().filter(|point| is_blocked(point)).count();
    blocked as f32 >= MAX_BLOCKED * points.len() as f32
}

/// Returns the plane that separates the camera from a light, if that plane is visible.
fn behind_plane(grid: &ProbeGrid, light: &Light) -> Option<u32> {
    let point = point(light)?;
    let world = grid.world();
    let way = world.camera().pose().center - point.position;
    let hit = world.closest(&Ray { t_max: 1.0, ..Ray::new(point.position, way) }, &mut ())?;
    let is_seen = grid.hits().any(|(_, seen)| seen.object == hit.object);
    (is_seen && world.objects()[hit.object as usize].bounds().is_none()).then_some(hit.object)
}

/// Returns true if an object around a light lets no light escape. This is the case if it blocks the
/// light, if shadows are disabled, or if no visible surface faces the light.
fn encloses_light(grid: &ProbeGrid, object: u32, all: &[&LightContribution]) -> bool {
    let shadows = grid.input.job.settings.shadows;
    let blocks = all.iter().any(|lit| lit.blocker == Some(object));
    blocks || !shadows || all.iter().all(|lit| lit.cosine <= 1e-3)
}

/// Returns the object that occurs most often.
pub(super) fn most_common(objects: &[u32]) -> Option<u32> {
    let mut sorted = objects.to_vec();
    sorted.sort_unstable();
    sorted.chunk_by(|a, b| a == b).max_by_key(|same| same.len()).map(|same| same[0])
}

/// Returns the three attenuation coefficients of a point light.
pub(super) fn attenuation(light: &Light) -> Option<Vec3> {
    point(light)?.attenuation
}
