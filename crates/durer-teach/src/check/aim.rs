//! Where the beams of lights go.

use super::probes::{Probe, ProbeGrid, ProbeHit};
use durer_render::world::World;
use durer_scene::light::Emitter as _;
use durer_scene::math::{Ray, Vec3};

/// A beam that holds a smaller share of what is seen holds nothing of it.
const NOTHING: f32 = 0.005;
/// And one that may be in radians may hold a little more.
const LITTLE: f32 = 0.03;
/// Beyond this share of its strongest light a point is in the beam.
const IN_BEAM: f32 = 0.02;
/// Narrower cones than this, in degrees, are a pencil's.
const PENCIL: f32 = 3.2;

/// Where a beam goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Aim {
    /// Past all that is seen.
    Away,
    /// At what is seen, but of that it holds next to nothing.
    Narrow,
}

/// What a light makes at a point of the most that it could make at that distance.
pub(super) fn share(world: &World, light: usize, point: Vec3) -> f32 {
    let lamp = &world.lights()[light];
    let Some((place, strongest)) = lamp.place() else { return 1.0 };
    let most = world.profiles().get(light).and_then(Option::as_ref).map_or(1.0, |profile| profile.most());
    let full = most * strongest.max_element() / (point - place).length_squared().max(f32::MIN_POSITIVE);
    world.illuminate(light, point.as_dvec3()).color.max_element() / full.max(f32::MIN_POSITIVE)
}

/// The places that are seen.
pub(super) fn places(grid: &ProbeGrid) -> Vec<Vec3> {
    grid.seen().map(|(probe, seen): (&Probe, &ProbeHit)| probe.ray.at(seen.t)).collect()
}

/// The share of them that is in the beam of a light.
pub(super) fn within(grid: &ProbeGrid, light: usize, places: &[Vec3]) -> f32 {
    let held = places.iter().filter(|place| share(grid.world(), light, **place) > IN_BEAM).count();
    held as f32 / places.len().max(1) as f32
}

/// Where the beam of a light goes, if it has one and misses what is seen.
pub(super) fn aim(grid: &ProbeGrid, light: usize) -> Option<Aim> {
    let angle = grid.world().lights()[light].cone()?;
    let places = places(grid);
    let held = within(grid, light, &places);
    if places.is_empty() || held > if angle <= PENCIL { LITTLE } else { NOTHING } {
        return None;
    }
    Some(if angle <= PENCIL && at_something(grid, light) { Aim::Narrow } else { Aim::Away })
}

/// Whether the middle of a beam meets the scene.
fn at_something(grid: &ProbeGrid, light: usize) -> bool {
    let light = &grid.world().lights()[light];
    let (Some(position), Some(direction)) = (light.position(), light.direction()) else { return false };
    let ray = Ray::new(position, direction.normalize_or(Vec3::NEG_Y));
    grid.world().closest(&ray, &mut ()).is_some()
}
