//! Tracing of centre rays. Some AOV values of a pixel are computed from one ray through its centre.

use super::part::{BlockAovs, PrimaryHit};
use super::samples::{Cancelled, SampleCursor, SampleSource};
use super::{Job, PixelRect, center_ray, raster};
use crate::film::aov::{AovInput, brightness};
use crate::integrator::Path;
use crate::integrator::separate_terms::SeparateTerms;
use crate::world::World;
use durer_bvh::{RayCount, TraversalStats};
use durer_scene::math::Vec3;
use durer_scene::sampler::SampleId;

/// Traces the centre rays of a block and computes its AOVs.
pub(super) fn trace(
    world: &World,
    job: &Job,
    samples: &SampleSource,
    rect: PixelRect,
    at: &SampleCursor,
) -> Result<BlockAovs, Cancelled> {
    let raster = raster(world, job.width, job.height);
    let wanted = |name: &str| job.aovs.iter().any(|aov| aov.name == name);
    let (cost_wanted, illuminance_wanted) = (wanted("cost"), wanted("illuminance"));
    let terms_wanted = job.aovs.iter().any(|aov| aov.is_light);
    let path = Path::new(world, job.settings, job.method.path_options().unwrap_or_default());
    let sees_through = world.has_unseen() && job.method.path_options().is_some();
    let mut rays = RayCount::default();
    let mut inputs = Vec::with_capacity(rect.pixels() as usize);
    for (x, y) in rect.pixel_positions() {
        samples.check()?;
        at.set((x, y, None));
        let Some(ray) = center_ray(world, &raster, (x, y)) else {
            inputs.push(AovInput::NOTHING);
            continue;
        };
        let hit = match sees_through {
            true => world.first_seen(&ray, None, &mut rays),
            false => world.intersect(&ray, &mut rays),
        };
        let mut counts = TraversalStats::default();
        if cost_wanted {
            samples.whitted.radiance(&ray, &mut counts);
        }
        let albedo = hit.map_or(Vec3::ZERO, |at| samples.whitted.albedo(&at));
        let illuminance = match &hit {
            Some(at) if illuminance_wanted => {
                // Irradiance on the side of the surface that the ray hits.
                let side = if at.inside() { -at.surface.n_shade } else { at.surface.n_shade };
                let (mut sum, count) = (Vec3::ZERO, job.sampling.samples().max(1));
                for sample in 0..count {
                    samples.check()?;
                    sum += path.irradiance_on(&at.surface, side, SampleId::new(job.seed, (x, y), sample), &mut rays);
                }
                (brightness(sum, world.lumens()) / f64::from(count)) as f32
            }
            _ => 0.0,
        };
        let terms = if terms_wanted { SeparateTerms::trace(&samples.whitted, &ray) } else { SeparateTerms::default() };
        rays.0 += counts.rays;
        inputs.push(AovInput { covered: true, hit, albedo, counts, illuminance, terms });
    }
    samples.check()?;
    // Replace NaN and infinity with 0.
    let finite = |value: Vec3| if value.is_finite() { value } else { Vec3::ZERO };
    let values = job.ray_aovs().flat_map(|(_, value)| inputs.iter().map(value).map(finite)).collect();
    let hit = |input: &AovInput| match (input.covered, input.hit.is_some()) {
        (false, _) => PrimaryHit::NoRay,
        (true, false) => PrimaryHit::Nothing,
        (true, true) => PrimaryHit::Hit,
    };
    Ok(BlockAovs { hits: inputs.iter().map(hit).collect(), values, rays: rays.0 })
}
