//! Ambient occlusion integrator: renders the unoccluded fraction of the hemisphere above a surface.
//!
//! Directions are sampled in proportion to their cosine with the normal. Source: Zhukov, Iones and
//! Kronin, *An Ambient Light Illumination Model*, EGWR 1998.

use super::spawn::spawn_ray;
use super::trace::{HitRecord, NodeId, RayKind, TermKind, TraceListener};
use super::{Integrate, IntegratorContext, IntegratorOptions};
use crate::world::World;
use durer_scene::bsdf::{Frame, warp};
use durer_scene::describe::{Constraint, described};
use durer_scene::dialect::set;
use durer_scene::math::{Color, Ray, Ray64};
use durer_scene::sampler::SampleId;

described! {
    /// ambient occlusion
    AoParameters ["ao" in set::DURER] {
        /// Maximum distance of occluders, in world units [default: unlimited]
        radius: Option<f32> = None, optional, Constraint::Positive, ["ao-radius" in set::DURER];
    }
}

impl Copy for AoParameters {}

impl IntegratorOptions for AoParameters {
    type Integrator<'w> = AmbientOcclusion<'w>;

    fn create(self, context: IntegratorContext<'_>) -> AmbientOcclusion<'_> {
        AmbientOcclusion { world: context.world, radius: self.radius.unwrap_or(f32::INFINITY) }
    }
}

/// Ambient occlusion integrator for one world, created from [`AoParameters`].
#[derive(Clone, Copy, Debug)]
pub struct AmbientOcclusion<'w> {
    /// World to render.
    pub world: &'w World,
    /// Maximum distance of occluders, in world units; infinite if there is no limit.
    pub radius: f32,
}

impl Integrate for AmbientOcclusion<'_> {
    /// Traces a ray in one random direction from the point hit by the camera ray. Returns 0 if that
    /// ray is occluded, and 1 if it is not or if the camera ray hits nothing.
    fn radiance<T: TraceListener>(&self, ray: &Ray, id: SampleId, listener: &mut T) -> Color {
        let node = listener.begin(NodeId::ROOT, || TermKind::Ray {
            from: RayKind::Camera,
            ray: ray.into(),
            weight: 1.0,
            hit: None,
            bounce: None,
        });
        let color = self.trace(&ray.into(), id, node, listener);
        listener.end(node, Color::ONE, Color::ONE, color);
        color
    }
}

impl AmbientOcclusion<'_> {
    fn trace<T: TraceListener>(&self, ray: &Ray64, id: SampleId, node: NodeId, listener: &mut T) -> Color {
        let mut color = Color::ONE;
        if let Some(at) = self.world.intersect(ray, listener) {
            let (surface, inside) = (&at.surface, at.inside());
            let n = if inside { -surface.n_geo } else { surface.n_geo };
            listener.hit(node, || HitRecord::new(self.world, &at, n, inside, false));
            let dir = Frame::around(n).to_world(warp::cosine_hemisphere(id.pair(0)));
            if self.world.occluded(spawn_ray(surface, dir, self.radius, None), listener) {
                color = Color::ZERO;
            }
        }
        let sky = listener.begin(node, || TermKind::Sky);
        listener.end(sky, Color::ONE, Color::ONE, color);
        color
    }
}
