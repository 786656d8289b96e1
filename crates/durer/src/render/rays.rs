//! The values that come from one ray through each pixel's centre.

use super::part::{Found, Traced};
use super::samples::{At, Samples, Stopped};
use super::{Crop, Job, center_ray, raster};
use crate::bvh::{RayCount, TraversalStats};
use crate::film::aov::Seen;
use crate::math::Vec3;
use crate::world::World;

/// Traces the rays of a block.
pub(super) fn trace(world: &World, job: &Job, samples: &Samples, rect: Crop, at: &At) -> Result<Traced, Stopped> {
    let raster = raster(world, job.width, job.height);
    let cost_wanted = job.aovs.iter().any(|aov| aov.name == "cost");
    let mut rays = RayCount::default();
    let mut seen = Vec::with_capacity(rect.pixels() as usize);
    for (x, y) in rect.places() {
        samples.check()?;
        at.set((x, y, None));
        let Some(ray) = center_ray(world, &raster, (x, y)) else {
            seen.push(Seen::NOTHING);
            continue;
        };
        let hit = world.closest(&ray, &mut rays).map(|hit| (hit, world.surface(&ray, &hit)));
        let mut counts = TraversalStats::default();
        if cost_wanted {
            samples.whitted.radiance(&ray, &mut counts);
        }
        let material = hit.map_or(0, |(hit, _)| world.material(&hit));
        let albedo = hit.map_or(Vec3::ZERO, |(hit, surface)| samples.whitted.albedo(&hit, &surface));
        rays.0 += counts.rays;
        seen.push(Seen { covered: true, hit, material, albedo, counts });
    }
    samples.check()?;
    // What is no number is shown as nothing.
    let finite = |value: Vec3| if value.is_finite() { value } else { Vec3::ZERO };
    let values = job.ray_aovs().flat_map(|(_, value)| seen.iter().map(value).map(finite)).collect();
    let found = |seen: &Seen| match (seen.covered, seen.hit.is_some()) {
        (false, _) => Found::Blind,
        (true, false) => Found::Nothing,
        (true, true) => Found::Hit,
    };
    Ok(Traced { found: seen.iter().map(found).collect(), values, rays: rays.0 })
}
