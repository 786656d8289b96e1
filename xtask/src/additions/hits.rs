//! Example of an integrator: white for hits within a distance, black elsewhere.

use super::{Integrate, IntegratorContext, IntegratorOptions, TraceListener};
use durer_scene::describe::{Constraint, described};
use durer_scene::dialect::set;
use durer_scene::math::{Color, Ray, Ray64};
use durer_scene::sampler::SampleId;
use crate::world::World;

described! {
    /// white for hits within a distance, black elsewhere
    HitsParameters ["hits" in set::DURER] {
        /// Maximum distance of hits, in world units [default: unlimited]
        depth: Option<f32> = None, optional, Constraint::Positive, ["hits-depth" in set::DURER];
    }
}

impl Copy for HitsParameters {}

impl IntegratorOptions for HitsParameters {
    type Integrator<'w> = Hits<'w>;

    const IS_STOCHASTIC: bool = false;

    fn create(self, context: IntegratorContext<'_>) -> Hits<'_> {
        Hits { world: context.world, depth: self.depth.unwrap_or(f32::INFINITY) }
    }
}

/// Integrator that returns white if a ray hits something within a distance, otherwise black.
#[derive(Clone, Copy, Debug)]
pub struct Hits<'w> {
    world: &'w World,
    depth: f32,
}

impl Integrate for Hits<'_> {
    fn radiance<T: TraceListener>(&self, ray: &Ray, _: SampleId, listener: &mut T) -> Color {
        let hit = self.world.closest(&Ray64::from(ray), listener);
        if hit.is_some_and(|hit| hit.t * ray.dir.length() < self.depth) { Color::ONE } else { Color::ZERO }
    }
}
