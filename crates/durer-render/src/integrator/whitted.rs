//! Whitted ray tracing, with direct light and one reflected and one transmitted ray per hit.
//!
//! Rays pass through the stages of `Whitted::trace` in batches, even if a batch has only one ray.
//! Secondary rays wait in a `Queue`, so there is no recursion. The terms of each sum are added in a
//! fixed order that does not depend on the batches.
//!
//! Source: Turner Whitted, *An Improved Illumination Model for Shaded Display*, CACM 23(6), 1980,
//! with the terms used in the assignments of the course.

use super::media::MediumTransition;
use super::trace::{HitRecord, NodeId, RayKind, TermKind, TraceListener};
use super::{Integrate, IntegratorContext, IntegratorOptions};
use crate::world::{MAX_BATCH, Material, PassedSurfaces, SurfaceInteraction, WeightedMaterial, World};
use direct::{LightTerms, compute_powers};
use durer_scene::describe::described;
use durer_scene::dialect::set;
use durer_scene::light::LightLiSample;
use durer_scene::math::{Color, Ray, Ray64, Vec3};
use durer_scene::sampler::SampleId;
use queue::Queue;
pub use secondary::refract;
use serde::{Deserialize, Serialize};
use smallvec::SmallVec;
use std::cell::RefCell;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// Light transport settings of a render, such as depth, shadows and secondary rays, which all
/// integrators use.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RenderSettings {
    /// Maximum depth of secondary rays; 0 means direct light only.
    pub bounces: u32,
    /// True if objects cast shadows.
    pub shadows: bool,
    /// True if surfaces seen from behind are shaded with a flipped normal.
    pub shade_back: bool,
    /// True if transparent objects cast coloured shadows.
    pub transparent_shadows: bool,
    /// True if reflected rays are traced.
    pub reflection: bool,
    /// True if transmitted rays are traced.
    pub refraction: bool,
    /// Minimum weight with which a ray must contribute to the pixel in order to be traced. The
    /// weight is the largest component of the throughput or, in the course's programs, its length.
    #[serde(rename = "least_weight")]
    pub min_weight: f32,
}

impl RenderSettings {
    /// Largest value allowed for the maximum depth of a render job.
    pub const MAX_BOUNCES: u32 = 256;
}

described! {
    /// direct lighting, mirrors, glass
    WhittedParameters ["whitted" in set::DURER] {}
}

impl Copy for WhittedParameters {}

impl IntegratorOptions for WhittedParameters {
    type Integrator<'w> = Whitted<'w>;

    const IS_STOCHASTIC: bool = false;

    fn create(self, IntegratorContext { world, settings, cancel, .. }: IntegratorContext<'_>) -> Whitted<'_> {
        Whitted { world, settings, cancel }
    }
}

/// Whitted ray tracing integrator for one world.
#[derive(Clone, Copy, Debug)]
pub struct Whitted<'w> {
    /// World to render.
    pub world: &'w World,
    /// Settings for depth, shadows and secondary rays.
    pub settings: RenderSettings,
    /// Cancellation flag. Once the flag is set, no more rays are traced, and results are
    /// meaningless. The flag is needed because a single pixel that shows many mirrors can take a
    /// long time.
    pub cancel: Option<&'w AtomicBool>,
}

/// One of the materials at a point that the Whitted integrator shades, with its lighting terms.
struct ShadedMaterial<'w> {
    part: WeightedMaterial<'w>,
    /// Diffuse colour, computed once for all lights.
    diffuse: Color,
    /// Lighting terms of the light that is currently being added.
    direct: LightTerms,
}

/// Surface point that the Whitted integrator shades, one for each hit in a batch.
struct ShadingPoint {
    /// Index of the segment whose ray hit the point.
    segment: u32,
    at: SurfaceInteraction,
    /// Transition of refracted rays through the surface.
    transition: MediumTransition,
    /// Normal used for lighting.
    n: Vec3,
    /// True if the official program leaves the point black.
    black: bool,
    /// Index of the point's first material in the batch's list.
    first_part: usize,
    /// Number of the point's materials.
    parts: usize,
    /// Radiance emitted or scattered towards the ray's origin.
    color: Color,
}

/// Materials of all points of a batch, ordered by point.
type ShadedMaterials<'w> = SmallVec<[ShadedMaterial<'w>; MAX_BATCH]>;

/// Thread-local buffers that are reused for each batch of camera rays.
struct Scratch {
    queue: Queue,
    /// Buffer of [`MAX_BATCH`] shading points.
    points: Vec<ShadingPoint>,
    rays: [Ray64; MAX_BATCH],
}

impl Default for Scratch {
    fn default() -> Self {
        let point = || ShadingPoint {
            segment: 0,
            at: SurfaceInteraction::NOWHERE,
            transition: MediumTransition::default(),
            n: Vec3::ZERO,
            black: false,
            first_part: 0,
            parts: 0,
            color: Color::ZERO,
        };
        Scratch {
            queue: Queue::default(),
            points: std::iter::repeat_with(point).take(MAX_BATCH).collect(),
            rays: [Ray64::from(Ray::new(Vec3::ZERO, Vec3::X)); MAX_BATCH],
        }
    }
}

thread_local! {
    static SCRATCH: RefCell<Scratch> = RefCell::default();
}

/// Side of a surface that is shaded, with its normal.
struct Side {
    /// Normal used for lighting.
    n: Vec3,
    from_behind: bool,
    /// True if the official program leaves this side black.
    black: bool,
}

impl Integrate for Whitted<'_> {
    fn radiance<T: TraceListener>(&self, ray: &Ray, _: SampleId, listener: &mut T) -> Color {
        self.radiance(ray, listener)
    }

    fn radiances<T: TraceListener>(
        &self,
        rays: &[Ray64],
        begin: impl Fn(usize) -> SampleId,
        listener: &mut T,
        colors: &mut [Color],
    ) {
        let begin = |ray| {
            begin(ray);
        };
        self.trace(rays, begin, listener, colors);
    }
}

impl<'w> Whitted<'w> {
    /// Returns the radiance along a camera ray.
    pub fn radiance<T: TraceListener>(&self, ray: &Ray, listener: &mut T) -> Color {
        let mut color = [Color::ZERO];
        self.trace(&[ray.into()], |_| {}, listener, &mut color);
        color[0]
    }

    /// Traces camera rays and their secondary rays in batches. For each batch, the function finds
    /// the first hits, lights them and spawns secondary rays. `begin` is called with the index of
    /// the camera ray that is being processed.
    fn trace<T: TraceListener>(&self, rays: &[Ray64], begin: impl Fn(usize), listener: &mut T, colors: &mut [Color]) {
        SCRATCH.with_borrow_mut(|Scratch { queue, points, rays: batch_rays }| {
            queue.clear();
            for (camera, ray) in rays.iter().enumerate() {
                let node = listener.begin(NodeId::ROOT, || TermKind::Ray {
                    from: RayKind::Camera,
                    ray: ray.into(),
                    weight: 1.0,
                    hit: None,
                    bounce: None,
                });
                queue.push_camera(ray, camera as u32, self.settings.bounces, node);
            }
            let (mut batch, size) = ([0; MAX_BATCH], self.world.batch_size());
            loop {
                let count = queue.take(&mut batch[..size]);
                if count == 0 || self.is_cancelled() {
                    return;
                }
                let mut parts = SmallVec::new();
                let batch = &batch[..count];
                let count = self.hit(batch, batch_rays, (queue, points, &mut parts), &begin, colors, listener);
                let points = &mut points[..count];
                self.shade(points, batch_rays, &mut parts, queue, listener);
                for point in points {
                    begin(queue.segment(point.segment).camera as usize);
                    let parts = &parts[point.first_part..][..point.parts];
                    self.secondary(point, parts, queue, colors, listener);
                }
            }
        });
    }

    /// Intersects a batch of rays, collects the points to shade, and returns their number. Rays
    /// that hit nothing are finished, and rays that hit an ignored surface are queued again.
    fn hit<T: TraceListener>(
        &self,
        batch: &[u32],
        rays: &mut [Ray64; MAX_BATCH],
        (queue, points, parts): (&mut Queue, &mut [ShadingPoint], &mut ShadedMaterials<'w>),
        begin: &impl Fn(usize),
        colors: &mut [Color],
        listener: &mut T,
    ) -> usize {
        let (rays, mut found) = (&mut rays[..batch.len()], [None; MAX_BATCH]);
        for (ray, &number) in rays.iter_mut().zip(batch) {
            let segment = queue.segment(number);
            *ray = segment.ray;
            ray.rounded.t_min = segment.t_min;
        }
        self.world.first_hits(rays, &mut found[..batch.len()], listener);
        let mut count = 0;
        for (&number, found) in batch.iter().zip(found) {
            let segment = queue.segment(number);
            begin(segment.camera as usize);
            let Some(mut hit) = found else {
                let sky = self.world.background_radiance(segment.ray.dir());
                let node = listener.begin(segment.node, || TermKind::Sky);
                listener.end(node, Color::ONE, Color::ONE, sky);
                queue.finish(number, sky, colors, listener);
                continue;
            };
            let point = &mut points[count];
            let mut passed = PassedSurfaces::default();
            let transition = loop {
                hit = self.world.intersect_touching(&segment.ray, hit, &mut point.at);
                match self.transition(&point.at, &segment.media) {
                    Some(MediumTransition { displaced: true, behind, .. }) => {
                        segment.media = behind;
                        passed.pass(&hit);
                        match passed.coincident(self.world, &segment.ray) {
                            Some(next) => hit = next,
                            None => break None,
                        }
                    }
                    transition => break Some(transition.unwrap_or_default()),
                }
            };
            let Some(transition) = transition else {
                segment.t_min = hit.t;
                queue.push_again(number);
                continue;
            };
            point.transition = transition;
            let Side { n, from_behind, black } = self.side(&point.at);
            listener.hit(segment.node, || HitRecord::new(self.world, &point.at, n, from_behind, black));
            (point.segment, point.n, point.black) = (number, n, black);
            point.first_part = parts.len();
            let lit = |part: WeightedMaterial<'w>| {
                let diffuse = self.world.diffuse_color(part.phong, &point.at.surface);
                ShadedMaterial { part, diffuse, direct: LightTerms::default() }
            };
            match &self.world.materials()[point.at.material as usize] {
                // Fast path: most points have a single material.
                Material::Phong(phong) => parts.push(lit(WeightedMaterial { phong, share: 1.0 })),
                Material::Mix(..) => parts.extend(self.world.materials_at(&point.at).into_iter().map(lit)),
            }
            point.parts = parts.len() - point.first_part;
            count += 1;
        }
        count
    }

    /// Computes the direct light that points scatter towards the rays' origins, starting with the
    /// ambient light and then adding the lights one by one.
    fn shade<T: TraceListener>(
        &self,
        points: &mut [ShadingPoint],
        shadows: &mut [Ray64; MAX_BATCH],
        parts: &mut [ShadedMaterial],
        queue: &mut Queue,
        listener: &mut T,
    ) {
        for point in &mut *points {
            point.color = Color::ZERO;
            if point.black {
                continue;
            }
            let node = queue.segment(point.segment).node;
            for ShadedMaterial { part, diffuse, .. } in &parts[point.first_part..][..point.parts] {
                let reflectance = part.phong.ambient.unwrap_or(*diffuse);
                let ambient = part.share * self.world.ambient();
                let node = listener.begin(node, || TermKind::Ambient { share: part.share });
                listener.end(node, ambient, Color::ONE, reflectance);
                point.color += ambient * reflectance;
            }
        }
        // List the points that the light may reach, by index, together with the light as seen from
        // each point.
        let mut lit = [(0, LightLiSample { to_light: Vec3::ZERO, distance: 0.0, color: Color::ZERO }); MAX_BATCH];
        for number in 0..self.world.lights().len() {
            let mut count = 0;
            for (i, point) in points.iter_mut().enumerate().filter(|(_, point)| !point.black) {
                let SurfaceInteraction { ray, surface, .. } = &point.at;
                let light_sample = self.world.illuminate(number, surface.point());
                let mut dark = true;
                for ShadedMaterial { part, diffuse, direct } in &mut parts[point.first_part..][..point.parts] {
                    *direct = LightTerms::of(part.phong, *diffuse, point.n, ray.dir(), &light_sample);
                    dark &= direct.is_dark(part.phong);
                }
                // If a light adds nothing, only listeners need its visibility. The exception is a
                // light of infinite intensity, which gives NaN when multiplied by 0, as in the
                // official programs.
                let adds_nothing = dark && light_sample.color.is_finite() || light_sample.color == Color::ZERO;
                if adds_nothing && !T::LISTENS {
                    continue;
                }
                shadows[count] = self.shadow_ray(surface, number, &light_sample);
                lit[count] = (i, light_sample);
                count += 1;
            }
            let lit = &lit[..count];
            let mut shares = [Color::ONE; MAX_BATCH];
            if self.settings.shadows {
                self.visible(&mut shadows[..count], &mut shares[..count], listener);
            }
            let arriving = lit.iter().zip(shares).filter(|(_, share)| *share != Color::ZERO);
            compute_powers(points, parts, arriving.map(|(&(i, _), _)| i));
            for (&(i, ref seen), share) in lit.iter().zip(shares) {
                let point = &mut points[i];
                let parts = &parts[point.first_part..][..point.parts];
                self.add_light(point, parts, (number, seen, share), queue, listener);
            }
        }
    }

    /// Adds the visible fraction of a light to a point's colour.
    #[inline(always)]
    fn add_light<T: TraceListener>(
        &self,
        point: &mut ShadingPoint,
        parts: &[ShadedMaterial],
        (number, seen, visible): (usize, &LightLiSample, Color),
        queue: &mut Queue,
        listener: &mut T,
    ) {
        for ShadedMaterial { part, diffuse, direct } in parts {
            let share = part.share;
            // Skip the computation if the light is occluded.
            let dark = visible == Color::ZERO;
            let color = if dark { Color::ZERO } else { direct.color(part.phong, seen) };
            let parent = queue.segment(point.segment).node;
            let node = listener.begin(parent, || {
                let shadow = self.settings.shadows.then(|| self.shadow(&point.at.surface, number, seen, visible));
                let (to_light, distance) = (seen.to_light, seen.distance);
                TermKind::Light { light: number, to_light, distance, share, shadow }
            });
            if T::LISTENS && !dark {
                direct.report(part.phong, *diffuse, node, listener);
            }
            listener.end(node, share * visible, seen.color, color);
            point.color += share * visible * color;
        }
    }

    /// Returns true if secondary rays should still be traced.
    fn continues(&self, bounces: u32) -> bool {
        bounces > 0 && !self.is_cancelled()
    }

    /// Returns true if the render was cancelled. Its results are discarded.
    fn is_cancelled(&self) -> bool {
        self.cancel.is_some_and(|cancel| cancel.load(Relaxed))
    }

    /// Determines which side of a surface is shaded.
    #[inline]
    fn side(&self, at: &SurfaceInteraction) -> Side {
        let (rules, shade_back, n_shade) = (self.world.shading_rules(), self.settings.shade_back, at.surface.n_shade);
        let from_behind = self.sees_back(at);
        let n = if from_behind && shade_back { -n_shade } else { n_shade };
        let n = if rules.unit_light { n.normalize_or(n) } else { n };
        let spoiled = rules.spoiled_normals && n.is_nan();
        Side { n, from_behind, black: from_behind && rules.black_backs && !shade_back || spoiled }
    }

    /// Returns true if a ray hits the back of a surface.
    #[inline]
    pub fn sees_back(&self, at: &SurfaceInteraction) -> bool {
        let shaded = self.world.shading_rules().shaded_sides;
        at.ray.dir().dot(if shaded { at.surface.n_shade } else { at.surface.n_geo }) > 0.0
    }

    /// Returns the albedo, which is the diffuse colour at a hit, averaged over the materials
    /// according to their shares.
    pub fn albedo(&self, at: &SurfaceInteraction) -> Color {
        let parts = self.world.materials_at(at);
        parts.iter().map(|part| part.share * self.world.diffuse_color(part.phong, &at.surface)).sum()
    }
}

mod direct;
mod queue;
pub mod secondary;
#[cfg(test)]
mod tests;
