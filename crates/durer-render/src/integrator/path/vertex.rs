//! Vertices of a path, on surfaces and in media.

use super::Path;
use super::state::{DIMENSIONS, Dimension, PathState};
use crate::integrator::media::{MediumStack, MediumTransition};
use crate::integrator::spawn::{offset_bound, spawn_ray, to_point};
use crate::world::Shading;
use crate::world::emitters::{LightSample, Receiver};
use durer_scene::bsdf::{Lobe, Scatter};
use durer_scene::math::{Ray64, Vec2, Vec3};
use durer_scene::medium::HenyeyGreenstein;
use durer_scene::shape::SurfacePoint;
use durer_scene::spectrum::Spectrum;
use glam::DVec3;

/// Number of candidate directions to the environment for a glossy BSDF; one of them is used. For
/// other BSDFs, a single candidate is just as good. Rendering takes 1.2 times as long with four
/// candidates as with one.)
pub(super) const CANDIDATES: u32 = 4;

/// Number of directions that are followed from a glossy first vertex if there is an environment.
/// Most of the paths end soon, so they share the cost of the first vertex.
///
/// Source: Arvo and Kirk, *Particle Transport and Image Synthesis*, SIGGRAPH 1990 (splitting).
pub(super) const SPLIT_DIRECTIONS: u32 = 2;

/// Path vertex with all data needed to sample lights and directions from it.
#[derive(Clone, Copy)]
pub(super) struct Vertex<'a, 'w> {
    /// Surface or medium that scatters the light.
    pub(super) kind: VertexKind<'a, 'w>,
    /// Random numbers in [0, 1)^2, indexed by [`Dimension`].
    pub(super) random: [Vec2; DIMENSIONS],
    /// Number of candidate directions to the environment; at least 1.
    pub(super) candidates: f32,
    /// Number of directions to follow; at least 1.
    pub(super) directions: u32,
    /// Point and normal for which lights are sampled.
    pub(super) receiver: Receiver,
}

/// Scatterer at a path vertex, which is a surface with its BSDF or a medium with its phase
/// function.
#[derive(Clone, Copy)]
pub(super) enum VertexKind<'a, 'w> {
    /// A surface. If there is a transition, light can pass through the surface into another medium.
    Surface(&'a SurfacePoint, &'a Shading<'w>, Option<&'a MediumTransition>),
    /// A point in a medium, and the unit direction in which the ray arrives.
    Medium(DVec3, Vec3, HenyeyGreenstein),
}

/// Direction sampled at a path vertex from a BSDF or a phase function, with its weight and density.
pub(super) struct BsdfSample {
    /// Unit direction away from the vertex, in world space.
    pub(super) wi: Vec3,
    /// Weight of the direction, which is BSDF · cosine / pdf.
    pub(super) weight: Spectrum,
    /// Density per steradian, summed over all lobes; 0 for a delta lobe.
    pub(super) pdf: f32,
    /// True if the direction leads behind the surface.
    pub(super) transmits: bool,
    /// Index of the sampled lobe.
    pub(super) lobe: usize,
}

impl<'w> Path<'w> {
    /// Creates the vertex at the end of the ray of a path state.
    pub(super) fn vertex<'a>(&self, kind: VertexKind<'a, 'w>, state: &PathState) -> Vertex<'a, 'w> {
        let is_narrow = self.world.environment().is_some() && kind.is_glossy();
        let (tries, directions) = match (is_narrow, state.depth) {
            (true, 0) => (CANDIDATES, SPLIT_DIRECTIONS),
            (true, _) => (CANDIDATES, 1),
            (false, _) => (1, 1),
        };
        let is_seen = state.depth == 0 || state.camera_distance.is_some();
        Vertex {
            kind,
            random: state.vertex_sample().pairs(),
            candidates: tries as f32,
            directions,
            receiver: Receiver { point: kind.point(), n: kind.normal(), is_seen },
        }
    }
}

impl Vertex<'_, '_> {
    pub(super) fn random(&self, dimension: Dimension) -> Vec2 {
        self.random[dimension as usize]
    }

    /// Samples a direction in which the path continues.
    pub(super) fn sample_bsdf(&self) -> Option<BsdfSample> {
        self.kind.sample(self.random(Dimension::Choices).x, self.random(Dimension::Direction))
    }

    /// Returns BSDF · cosine for a direction, and the direction's density per steradian multiplied
    /// by the number of directions followed.
    pub(super) fn eval(&self, wi: Vec3) -> (Spectrum, f32) {
        let (value, pdf) = self.kind.eval(wi);
        (value, self.directions as f32 * pdf)
    }
}

impl VertexKind<'_, '_> {
    fn point(&self) -> DVec3 {
        match self {
            VertexKind::Surface(surface, ..) => surface.point(),
            VertexKind::Medium(point, ..) => *point,
        }
    }

    /// Returns the normal for light sampling, which is zero if light from all directions is taken
    /// into account.
    fn normal(&self) -> Vec3 {
        match self {
            VertexKind::Surface(_, shading, _) if !shading.bsdf.passes_light() => shading.frame.normal,
            _ => Vec3::ZERO,
        }
    }

    /// Returns true if some lobe is not a delta lobe, so that light sampling is useful.
    pub(super) fn is_broad(&self) -> bool {
        match self {
            VertexKind::Surface(_, shading, _) => shading.bsdf.has_non_delta(),
            VertexKind::Medium(..) => true,
        }
    }

    /// Returns true if at least half of the scattered light stays within a narrow cone.
    fn is_glossy(&self) -> bool {
        matches!(self, VertexKind::Surface(_, shading, _) if shading.bsdf.is_glossy())
    }

    /// Returns BSDF · cosine for a direction, and the direction's density per steradian.
    fn eval(&self, wi: Vec3) -> (Spectrum, f32) {
        match self {
            VertexKind::Surface(_, shading, _) => shading.eval(wi),
            VertexKind::Medium(_, dir, phase) => {
                let value = phase.value(*dir, wi);
                (Spectrum::splat(value), value)
            }
        }
    }

    /// Samples a direction. `choice` in [0, 1) selects the lobe, and `u` selects the direction
    /// within the lobe.
    pub(super) fn sample(&self, choice: f32, u: Vec2) -> Option<BsdfSample> {
        match self {
            VertexKind::Surface(_, shading, _) => {
                let sample = shading.bsdf.sample(shading.wo, choice, u)?;
                let wi = shading.frame.to_world(sample.wi);
                let transmits = wi.dot(shading.n_geo) < 0.0;
                if transmits != (sample.wi.z < 0.0) && !shading.bsdf.is_fibre() {
                    return None;
                }
                let weight = sample.weight * shading.lit_share(wi);
                Some(BsdfSample { wi, weight, pdf: sample.pdf, transmits, lobe: sample.lobe })
            }
            VertexKind::Medium(_, dir, phase) => {
                let wi = phase.sample(*dir, u);
                let pdf = phase.value(*dir, wi);
                Some(BsdfSample { wi, weight: Spectrum::ONE, pdf, transmits: false, lobe: 0 })
            }
        }
    }

    /// Returns the name of a lobe, and the probability of sampling it.
    pub(super) fn lobe(&self, number: usize) -> (&'static str, f32) {
        match self {
            VertexKind::Surface(_, shading, _) => {
                let lobe = shading.bsdf.lobes().nth(number);
                lobe.map_or(("", 1.0), |part| (part.lobe.name(), part.probability))
            }
            VertexKind::Medium(..) => ("HenyeyGreenstein", 1.0),
        }
    }

    /// Returns the factor that takes the scaling of radiance by refraction out of the weight of a
    /// sample. It is the squared relative index of refraction, or 1 without refraction.
    pub(super) fn squared_eta(&self, sample: &BsdfSample) -> f32 {
        let lobe = if sample.transmits { self.nth_lobe(sample.lobe) } else { None };
        lobe.and_then(|lobe| lobe.kind().eta).map_or(1.0, |eta| eta * eta)
    }

    /// Returns true if a lobe transmits light straight through an open surface, such as a window
    /// pane.
    pub(super) fn transmits_straight(&self, lobe: usize) -> bool {
        let is_sheet = matches!(self, VertexKind::Surface(_, _, None));
        is_sheet && self.nth_lobe(lobe).is_some_and(|lobe| lobe.kind().is_straight)
    }

    fn nth_lobe(&self, number: usize) -> Option<Lobe<'_>> {
        match self {
            VertexKind::Surface(_, shading, _) => shading.bsdf.lobes().nth(number).map(|part| part.lobe),
            VertexKind::Medium(..) => None,
        }
    }

    /// Returns the ray that leaves the vertex in a given direction.
    pub(super) fn spawn(&self, wi: Vec3) -> Ray64 {
        match self {
            VertexKind::Surface(surface, ..) => spawn_ray(surface, wi, f32::INFINITY, None),
            VertexKind::Medium(point, ..) => Ray64::new(*point, wi, 0.0, f32::INFINITY),
        }
    }

    /// Returns the shadow ray to a point sampled on a light. The ray ends just before the light, so
    /// that surfaces at the light's position do not block it.
    pub(super) fn shadow_ray(&self, light: &LightSample) -> Ray64 {
        match self {
            VertexKind::Surface(surface, ..) => to_point(surface, light.wi, light.shadow_reach(offset_bound(surface))),
            VertexKind::Medium(point, ..) => Ray64::new(*point, light.wi, 0.0, light.shadow_reach(0.0)),
        }
    }

    /// Returns the media behind the surface if the direction leads there and light can pass through
    /// the surface.
    pub(super) fn media_behind(&self, wi: Vec3) -> Option<&MediumStack> {
        match self {
            VertexKind::Surface(_, shading, Some(transition)) if wi.dot(shading.n_geo) < 0.0 => {
                Some(&transition.behind)
            }
            _ => None,
        }
    }
}
