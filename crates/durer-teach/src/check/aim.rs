//! Checks where the beams of lights point.

use super::probes::{Probe, ProbeGrid, ProbeHit};
use durer_render::world::World;
use durer_scene::light::{Illuminate as _, Light};
use durer_scene::math::{Ray, Vec3};

/// If a beam covers at most this fraction of the visible points, it misses the scene.
const MIN_COVERAGE: f32 = 0.005;
/// The limit used instead of [`MIN_COVERAGE`] if the beam is so narrow that its angle may have been
/// given in radians.
const MIN_COVERAGE_NARROW: f32 = 0.03;
/// A point is in the beam if it receives more than this fraction of the light's peak intensity.
const IN_BEAM: f32 = 0.02;
/// Cone angle, in degrees, at or below which the angle may have been given in radians by mistake.
const NARROW_ANGLE: f32 = 3.2;

/// The way in which the beam of a spotlight or photometric light misses everything that the camera
/// sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum BeamMiss {
    /// The beam points away from everything visible.
    Away,
    /// The beam points at the scene but covers almost none of the visible points.
    Narrow,
}

/// Returns the light that arrives at a point, as a fraction of the light's peak intensity at that
/// distance. Ignores occlusion.
pub(super) fn relative_intensity(world: &World, light: usize, point: Vec3) -> f32 {
    let emitter = &world.lights()[light];
    let Some((place, strongest)) = emitter.inverse_square() else { return 1.0 };
    let most = world.profiles().get(light).and_then(Option::as_ref).map_or(1.0, |profile| profile.max_candela());
    // The light of a photometric light with a focal length fades as if it came from farther away.
    let behind = if let Light::Photometric(own) = emitter { own.focal_length } else { 0.0 };
    let distance = (point - place).length() + behind;
    let full = most * strongest.max_element() / (distance * distance).max(f32::MIN_POSITIVE);
    world.illuminate(light, point.as_dvec3()).color.max_element() / full.max(f32::MIN_POSITIVE)
}

/// Returns the world-space positions of the probes' hits.
pub(super) fn hit_points(grid: &ProbeGrid) -> Vec<Vec3> {
    grid.hits().map(|(probe, hit): (&Probe, &ProbeHit)| probe.ray.at(hit.t)).collect()
}

/// Returns the fraction of `points` that lie in the beam of a light.
pub(super) fn beam_coverage(grid: &ProbeGrid, light: usize, points: &[Vec3]) -> f32 {
    let held = points.iter().filter(|point| relative_intensity(grid.world(), light, **point) > IN_BEAM).count();
    held as f32 / points.len().max(1) as f32
}

/// Returns the way in which the beam of a light misses the visible points, or `None` if it covers
/// some of them or the light has no cone.
pub(super) fn beam_miss(grid: &ProbeGrid, light: usize) -> Option<BeamMiss> {
    let angle = grid.world().lights()[light].cone()?;
    let points = hit_points(grid);
    let held = beam_coverage(grid, light, &points);
    if points.is_empty() || held > if angle <= NARROW_ANGLE { MIN_COVERAGE_NARROW } else { MIN_COVERAGE } {
        return None;
    }
    Some(if angle <= NARROW_ANGLE && axis_hits_scene(grid, light) { BeamMiss::Narrow } else { BeamMiss::Away })
}

/// Returns true if the axis of a beam hits the scene.
fn axis_hits_scene(grid: &ProbeGrid, light: usize) -> bool {
    let light = &grid.world().lights()[light];
    let (Some(position), Some(direction)) = (light.position(), light.direction()) else { return false };
    let ray = Ray::new(position, direction.normalize_or(Vec3::NEG_Y));
    grid.world().closest(&ray, &mut ()).is_some()
}
