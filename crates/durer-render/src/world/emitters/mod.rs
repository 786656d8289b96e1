//! Light sampling of emissive surfaces, of the scene's lights and of the environment.

pub mod emission;
pub mod tree;

use super::material::Emission;
use super::object::Geometry;
use super::{Hit, Object, World};
use durer_bvh::internal::{prefetch, vec_on_large_pages};
use durer_scene::bsdf::{Frame, warp};
use durer_scene::light::{EmitterShape, EmitterTransform, Illuminate as _};
use durer_scene::math::{Aabb, Color, Vec2, Vec3, fp, gamma};
use durer_scene::shape::Shape as _;
use glam::DVec3;
use serde::Serialize;
use std::f32::consts::PI;
use tree::{LightBounds, LightTree};

/// Maximum number of objects for which the program tests which objects contain others.
const MAX_OBJECTS_TESTED: usize = 10_000;

/// Emissive part of an object, such as a triangle or a sphere, that light sampling can choose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AreaLight {
    /// Shape of the part in world space.
    pub form: EmitterShape,
    /// Unit normal; zero for curved shapes.
    pub normal: Vec3,
    /// Index of the object.
    pub object: u32,
    /// Index of the part within its object.
    pub part: u32,
    /// True if both sides are sampled, false if only the side to which the normal points is
    /// sampled.
    pub two_sided: bool,
    /// Upper bound on the distance between the sampled and the traced surface that rounding can
    /// cause.
    pub error: f32,
    /// Emitted radiance multiplied by the opacity.
    pub radiance: Color,
}

/// Emitter in the light tree, which is an emissive surface or a light with a position.
#[derive(Clone, Copy, Debug, PartialEq)]
enum LightEntry {
    /// An emissive surface.
    Area(AreaLight),
    /// A light with a position, by its index.
    Light(u32),
}

/// Light sampler of a world, with all emitters and the light tree that chooses between them.
#[derive(Clone, Debug, Default)]
pub struct LightSampler {
    /// Emitters, in the order of the tree.
    sources: Vec<LightEntry>,
    /// Index in `parts` of the first part of each object. It is `u32::MAX` for objects that do not
    /// emit light.
    first: Vec<u32>,
    /// Index of each part in `sources`.
    parts: Vec<u32>,
    /// Lights that are not in the tree.
    outside_tree: Vec<InfiniteLight>,
    /// Lights in `outside_tree` that have an angular extent.
    suns: Vec<Sun>,
    tree: LightTree,
}

/// Light that is not in the light tree because it is at infinity or its attenuation differs from
/// the inverse square law.
#[derive(Clone, Copy, Debug)]
struct InfiniteLight {
    light: u32,
    /// Direction to the light; zero if the light is not at infinity.
    way: Vec3,
    /// Approximate irradiance of a surface that faces the light.
    irradiance: f32,
}

impl InfiniteLight {
    fn of(world: &World, light: u32) -> InfiniteLight {
        let (light_sample, color) = (of_light(world, light, DVec3::ZERO, 1.0), world.lights()[light as usize].color());
        let direction = if light_sample.reach.is_infinite() { light_sample.wi } else { Vec3::ZERO };
        InfiniteLight { light, way: direction, irradiance: PI * color.max_element().max(0.0) }
    }

    /// Returns the estimated irradiance of a surface with normal `n`. If the normal is zero, the
    /// surface can have any orientation.
    fn estimated_irradiance(&self, n: Vec3) -> f32 {
        if n == Vec3::ZERO || self.way == Vec3::ZERO {
            self.irradiance
        } else {
            self.irradiance * self.way.dot(n).max(0.0)
        }
    }
}

/// Estimated irradiances at a point, used to choose between the lights outside the light tree, the
/// environment, and the tree as a whole.
struct LightWeights {
    /// Number of options to choose from.
    choices: f32,
    /// Sum of all estimates; NaN if the estimates are not valid.
    total: f32,
    sky: f32,
    tree: f32,
}

/// Fraction of choices that are made uniformly, without the estimates, because estimates can be
/// wrong.
const UNIFORM_FRACTION: f32 = 0.1;

impl LightWeights {
    /// Returns the probability of choosing a light whose estimated irradiance is `brings`.
    fn of(&self, brings: f32) -> f32 {
        if self.choices == 1.0 {
            return 1.0;
        }
        let share = brings / self.total;
        let even = 1.0 / self.choices;
        if share.is_finite() { (1.0 - UNIFORM_FRACTION) * share + UNIFORM_FRACTION * even } else { even }
    }
}

/// Light at infinity with an angular extent, such as the sun.
#[derive(Clone, Debug)]
struct Sun {
    light: u32,
    direction: Vec3,
    /// Square of the chord of half the angle. (The cosine of a small angle is too imprecise.)
    chord2: f32,
    radiance: Color,
}

/// Identity of an emitter, which is a light, a part of an emissive object, or the environment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum LightId {
    /// A light, by its index in the scene.
    Light(u32),
    /// A part of an emissive object, given by the indices of the object and of the part.
    Surface(u32, u32),
    /// The environment.
    Environment,
}

impl LightId {
    /// Returns the index of the object if the emitter is an emissive surface.
    pub fn object(self) -> Option<u32> {
        match self {
            LightId::Surface(object, _) => Some(object),
            LightId::Light(_) | LightId::Environment => None,
        }
    }
}

/// Point for which light sampling chooses a light, together with the normal at the point.
#[derive(Clone, Copy, Debug)]
pub struct Receiver {
    /// World-space position.
    pub point: DVec3,
    /// Normal on the lit side; zero if light from all directions is taken into account.
    pub n: Vec3,
    /// True if the camera sees the point, either directly or through delta lobes. Many other points
    /// are averaged in each pixel, so faster and noisier samples are worthwhile there.
    pub is_seen: bool,
}

impl Receiver {
    /// Returns the threshold for choosing uniformly within a distant group of similar emitters,
    /// which all contribute about equally. It is the maximum ratio of the group's radius to its
    /// distance, divided by the cosines at the group and at the point.
    fn uniform_threshold(&self) -> f32 {
        if self.is_seen { 0.1 } else { 0.3 }
    }

    /// Returns the ratio of a rectangle's longest edge to its distance below which the rectangle is
    /// sampled uniformly by area.
    fn area_limit(&self) -> f32 {
        if self.is_seen { 0.1 } else { 0.5 }
    }
}

/// Light chosen for a point, with the probability of the choice.
pub struct LightChoice {
    of: ChosenLight,
    probability: f32,
}

impl LightChoice {
    /// Returns true if the environment was chosen.
    pub fn is_sky(&self) -> bool {
        matches!(self.of, ChosenLight::Sky)
    }

    /// Returns the probability with which this light was chosen.
    pub fn probability(&self) -> f32 {
        self.probability
    }
}

/// Kind and index of a light in a [`LightChoice`].
enum ChosenLight {
    /// A light outside the light tree, by its index in the scene.
    Apart(u32),
    /// The environment.
    Sky,
    /// An emitter in the light tree, by its index in the tree.
    Source(u32),
}

/// Direction sampled from a point towards a light, with the light's radiance and the sampling
/// densities.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSample {
    /// Light that was sampled.
    pub light: LightId,
    /// Unit direction to the sampled point.
    pub wi: Vec3,
    /// Distance to the sampled point; infinite for lights at infinity.
    pub reach: f32,
    /// Upper bound on the distance between the sampled and the traced surface that rounding can
    /// cause.
    pub error: f32,
    /// Absolute value of the cosine between the light's normal and the direction, greater than
    /// zero. The cosine is 1 if there is no normal.
    pub cosine: f32,
    /// Radiance. For a light without extent, the irradiance of a surface that faces the light.
    pub radiance: Color,
    /// Probability with which this light was chosen.
    pub choice: f32,
    /// Density of the direction per steradian; 0 for a light without extent.
    pub pdf: f32,
}

impl LightSample {
    /// Creates a sample of the environment in the direction `wi`.
    pub fn of_sky(choice: &LightChoice, wi: Vec3, radiance: Color, pdf: f32) -> Self {
        LightSample {
            light: LightId::Environment,
            wi,
            reach: f32::INFINITY,
            error: 0.0,
            cosine: 1.0,
            radiance,
            choice: choice.probability,
            pdf,
        }
    }

    /// Returns the length of a shadow ray from a point whose position has the given error bound.
    /// The ray ends early enough to allow for the errors of both ends. If the light is inclined,
    /// the margin grows with the reciprocal of the cosine.
    pub fn shadow_reach(&self, error: f32) -> f32 {
        (self.reach - 2.0 * (self.error + error) / self.cosine) * (1.0 - gamma(16))
    }
}

impl LightSampler {
    /// Collects all emitters of a world and builds the light tree.
    pub(crate) fn new(world: &World) -> Self {
        let mut emitters = LightSampler { first: vec![u32::MAX; world.objects().len()], ..LightSampler::default() };
        let mut bounds = Vec::new();
        for (number, object) in world.objects().iter().enumerate() {
            let Some(Emission { radiance, two_sided, .. }) = world.emission_of(object.material) else { continue };
            let two_sided = two_sided && !has_empty_inside(world, number);
            let (start, error) = (emitters.sources.len(), object.rounding_error());
            for part in 0..object.parts() {
                let Some((form, normal)) = emitter_of(object, part) else { break };
                let area = AreaLight { form, normal, object: number as u32, part, two_sided, error, radiance };
                bounds.push(area.bounds());
                emitters.sources.push(LightEntry::Area(area));
            }
            if emitters.sources.len() > start {
                emitters.first[number] = start as u32;
            }
        }
        for (number, light) in world.lights().iter().enumerate() {
            match light.inverse_square() {
                Some((position, intensity)) => {
                    let profile = world.profiles().get(number).and_then(Option::as_ref);
                    let most = profile.map_or(1.0, |profile| profile.max_candela());
                    let power = PI * most * intensity.max_element().max(0.0);
                    emitters.sources.push(LightEntry::Light(number as u32));
                    bounds.push(LightBounds {
                        bounds: Aabb { min: position, max: position },
                        power,
                        axis: Vec3::Z,
                        cos_normals: -1.0,
                        cos_emission: 0.0,
                        two_sided: false,
                        emitter_power: power,
                    });
                }
                None => {
                    emitters.outside_tree.push(InfiniteLight::of(world, number as u32));
                    emitters.suns.extend(Sun::of(world, number as u32));
                }
            }
        }
        let (tree, order) = LightTree::new(&bounds);
        emitters.arrange(&order);
        emitters.tree = tree;
        emitters
    }

    /// Sorts the emitters by their order in the tree. Emitters that are not in the tree come last.
    fn arrange(&mut self, order: &[u32]) {
        self.parts = vec![u32::MAX; self.sources.len()];
        let mut sources = vec_on_large_pages(self.sources.len());
        let rest = 0..self.sources.len() as u32;
        for from in order.iter().copied().chain(rest) {
            let part = &mut self.parts[from as usize];
            if *part == u32::MAX {
                *part = sources.len() as u32;
                sources.push(self.sources[from as usize]);
            }
        }
        self.sources = sources;
    }

    /// Iterates over the emissive surfaces that light sampling can choose, in scene order: by
    /// object, then by part. An object has either all its parts in the list or none.
    pub fn area_lights(&self) -> impl Iterator<Item = &AreaLight> {
        self.in_scene_order().filter_map(|entry| match entry {
            LightEntry::Area(area) => Some(area),
            LightEntry::Light(_) => None,
        })
    }

    /// Iterates over the emitters in scene order.
    fn in_scene_order(&self) -> impl Iterator<Item = &LightEntry> {
        self.parts.iter().map(|&source| &self.sources[source as usize])
    }

    /// Estimates the irradiances at a point. Returns `None` if there are no lights.
    fn chances(&self, world: &World, to: &Receiver) -> Option<LightWeights> {
        let (environment, has_tree) = (world.environment(), !self.tree.is_empty());
        let choices = self.outside_tree.len() + usize::from(environment.is_some()) + usize::from(has_tree);
        let mut weights = LightWeights { choices: choices as f32, total: 0.0, sky: 0.0, tree: 0.0 };
        if choices > 1 {
            weights.sky = environment.map_or(0.0, |sky| PI * sky.mean_above().max_element());
            weights.tree = self.tree.importance(to);
            let apart: f32 = self.outside_tree.iter().map(|apart| apart.estimated_irradiance(to.n)).sum();
            let total = apart + weights.sky + weights.tree;
            // If the estimates are not valid, the sum is NaN, which makes the choice uniform.
            weights.total = if total.is_finite() { total } else { f32::NAN };
        }
        (choices > 0).then_some(weights)
    }

    /// Chooses a light for a point. `u` in [0, 1) is a random number. The data needed to sample the
    /// chosen light is prefetched.
    pub fn choose(&self, world: &World, to: &Receiver, u: f32) -> Option<LightChoice> {
        let weights = self.chances(world, to)?;
        let (has_sky, has_tree) = (world.environment().is_some(), !self.tree.is_empty());
        let mut rest = u;
        for (i, apart) in self.outside_tree.iter().enumerate() {
            let chance = weights.of(apart.estimated_irradiance(to.n));
            let is_last = i + 1 == self.outside_tree.len() && !has_sky && !has_tree;
            if rest < chance || is_last {
                return Some(LightChoice { of: ChosenLight::Apart(apart.light), probability: chance });
            }
            rest -= chance;
        }
        if has_sky {
            let chance = weights.of(weights.sky);
            if rest < chance || !has_tree {
                return Some(LightChoice { of: ChosenLight::Sky, probability: chance });
            }
            rest -= chance;
        }
        let chance = weights.of(weights.tree);
        let rest = (rest / chance).clamp(0.0, 1.0 - f32::EPSILON * 0.5);
        let (source, probability) = self.tree.sample(to, rest)?;
        if let Some(source) = self.sources.get(source as usize) {
            prefetch(source);
        }
        Some(LightChoice { of: ChosenLight::Source(source), probability: chance * probability })
    }

    /// Samples a direction from a point to the chosen light. The components of `u` in [0, 1)^2 are
    /// random numbers.
    pub fn sample(&self, world: &World, choice: &LightChoice, to: &Receiver, u: Vec2) -> Option<LightSample> {
        let (probability, point) = (choice.probability, to.point);
        match choice.of {
            ChosenLight::Apart(light) => Some(spread(world, light, of_light(world, light, point, probability), u)),
            ChosenLight::Sky => {
                let (wi, radiance, pdf) = world.environment()?.sample(u)?;
                Some(LightSample::of_sky(choice, wi, radiance, pdf))
            }
            ChosenLight::Source(source) => match &self.sources[source as usize] {
                LightEntry::Light(light) => Some(of_light(world, *light, point, probability)),
                LightEntry::Area(area) => area.sample(to, probability, u),
            },
        }
    }

    /// Returns the random numbers for which [`LightSampler::sample`] samples the centre of an
    /// emissive surface as seen from the point. On a triangle or cylinder, they select some fixed
    /// point. Returns `None` if the emitter is not a surface.
    pub fn center_sample(&self, light: LightId) -> Option<Vec2> {
        let source = *self.parts.get(self.first[light.object()? as usize] as usize)? as usize;
        match self.sources.get(source)? {
            LightEntry::Area(area) if area.form.is_ball() => Some(Vec2::ZERO),
            _ => Some(Vec2::splat(0.5)),
        }
    }

    /// Returns the emitter hit by a ray, if light sampling can choose the side that was hit.
    fn emitter_at(&self, hit: &Hit, dir: Vec3) -> Option<(u32, &AreaLight)> {
        let source = *self.parts.get(self.first[hit.object as usize].checked_add(hit.part)? as usize)?;
        match self.sources.get(source as usize)? {
            LightEntry::Area(area) if area.two_sided || area.normal.dot(dir) <= 0.0 => Some((source, area)),
            _ => None,
        }
    }

    /// Returns true if light sampling can choose the emissive surface hit by a ray.
    pub fn can_choose(&self, hit: &Hit, dir: Vec3) -> bool {
        self.emitter_at(hit, dir).is_some()
    }

    /// Returns the density per steradian with which light sampling finds an emissive surface hit by
    /// a ray. The density is 0 if light sampling never finds it.
    pub fn pdf_of_hit(&self, world: &World, hit: &Hit, to: &Receiver, wi: Vec3, distance: f32) -> f32 {
        let Some((source, area)) = self.emitter_at(hit, wi) else { return 0.0 };
        let Some(weights) = self.chances(world, to) else { return 0.0 };
        let choice = weights.of(weights.tree) * self.tree.probability(to, source);
        let pdf = area.form.pdf(area.normal, to.point, wi, distance, to.area_limit());
        if pdf.is_finite() { choice * pdf } else { 0.0 }
    }

    /// Iterates over the lights at infinity that are visible in a direction, with their radiances.
    pub fn suns(&self, dir: Vec3) -> impl Iterator<Item = (LightId, Color)> {
        let dir = if self.suns.is_empty() { dir } else { dir.normalize_or_zero() };
        let visible_suns = self.suns.iter().filter(move |sun| sun.direction.distance_squared(dir) <= sun.chord2);
        visible_suns.map(|sun| (LightId::Light(sun.light), sun.radiance))
    }

    /// Returns the background radiance in a direction and, if there is an environment, the density
    /// with which light sampling chooses that direction.
    pub fn sky(&self, world: &World, wi: Vec3) -> (Color, f32) {
        match world.environment() {
            Some(environment) => environment.at_with_pdf(wi),
            None if world.is_dark() => (Color::ZERO, 0.0),
            None => (world.background_radiance(wi), 0.0),
        }
    }

    /// Returns the probability with which the environment is chosen for a point.
    pub fn chance_of_sky(&self, world: &World, to: &Receiver) -> f32 {
        self.chances(world, to).map_or(0.0, |weights| weights.of(weights.sky))
    }
}

/// Returns the surface of one part of an object, for light sampling, and its unit normal in world
/// space. Returns `None` if the part's light is found only by rays that hit the part.
pub fn emitter_of(object: &Object, part: u32) -> Option<(EmitterShape, Vec3)> {
    let place = EmitterTransform(object.to_world.as_ref());
    match &object.geometry {
        Geometry::Mesh(tree) => Some(EmitterShape::triangle(tree.mesh.corners(part), &place)),
        Geometry::Primitive(shape) => shape.emitter(&place),
        Geometry::Solid(_) => None,
    }
}

/// Returns true if the object is a closed mesh with outward normals that contains no other object.
/// Sampling the inside of such a mesh would have no effect, and rays that hit the inside still find
/// its emission.
fn has_empty_inside(world: &World, number: usize) -> bool {
    let objects = world.objects();
    let object = &objects[number];
    let (Geometry::Mesh(_), Some(bounds)) = (&object.geometry, object.bounds()) else { return false };
    let center = bounds.center().as_dvec3();
    // Returns six times the signed volume of the tetrahedron formed by the centre and a triangle.
    let cone = |part| match emitter_of(object, part) {
        Some((EmitterShape::Triangle(p, [e, f]), normal)) => {
            e.as_dvec3().cross(f.as_dvec3()).length() * (p - center).dot(normal.as_dvec3())
        }
        _ => 0.0,
    };
    let within =
        |other: &Object| other.bounds().is_some_and(|other| bounds.contains(other.min) && bounds.contains(other.max));
    let others = || objects.iter().enumerate().filter(|(i, _)| *i != number).map(|(_, other)| other);
    objects.len() <= MAX_OBJECTS_TESTED
        && object.half_area().is_some()
        && (0..object.parts()).map(cone).sum::<f64>() > 0.0
        && !others().any(within)
}

/// Samples a light of the scene at its centre. The colour of such a light is the radiance of a
/// white matte surface that faces it, which is the irradiance divided by pi.
fn of_light(world: &World, light: u32, point: DVec3, choice: f32) -> LightSample {
    let light_sample = world.illuminate(light as usize, point);
    LightSample {
        light: LightId::Light(light),
        wi: light_sample.to_light,
        reach: light_sample.distance,
        error: 0.0,
        cosine: 1.0,
        radiance: PI * light_sample.color,
        choice,
        pdf: 0.0,
    }
}

impl Sun {
    /// Creates a sun from a light, if the light has an angular extent.
    fn of(world: &World, light: u32) -> Option<Sun> {
        let degrees = world.lights()[light as usize].angular_radius();
        let light_sample = of_light(world, light, DVec3::ZERO, 1.0);
        let (half, _) = fp::sin_cos_degrees(0.5 * f64::from(degrees.min(90.0)));
        // The solid angle 2 pi (1 - cos) equals pi times `chord2`.
        let chord2 = (4.0 * half * half) as f32;
        (degrees > 0.0).then(|| Sun {
            light,
            direction: light_sample.wi,
            chord2,
            radiance: light_sample.radiance / (PI * chord2),
        })
    }
}

/// Moves a sample to a random direction within the angular extent of its light.
fn spread(world: &World, light: u32, sample: LightSample, u: Vec2) -> LightSample {
    let degrees = world.lights()[light as usize].angular_radius();
    if degrees == 0.0 {
        return sample;
    }
    let cosine = fp::sin_cos_degrees(f64::from(degrees.min(90.0))).1 as f32;
    let around = warp::polar(1.0 - u.x * (1.0 - cosine), u.y);
    LightSample { wi: Frame::around(sample.wi).to_world(around), ..sample }
}

impl AreaLight {
    /// Returns the emitter's bounds for the light tree.
    fn bounds(&self) -> LightBounds {
        let round = self.form.is_round();
        // On average, a quarter of a convex surface's area is visible.
        let area = self.form.area() * if round { 0.25 } else { 1.0 };
        let power = area * self.radiance.max_element();
        let power = if power.is_finite() { power.max(0.0) } else { 0.0 };
        LightBounds {
            bounds: self.form.bounds(),
            power,
            axis: if round { Vec3::Z } else { self.normal },
            cos_normals: if round { -1.0 } else { 1.0 },
            cos_emission: 0.0,
            two_sided: self.two_sided,
            emitter_power: power,
        }
    }

    /// Samples a point on the surface as seen from a receiver.
    fn sample(&self, to: &Receiver, choice: f32, u: Vec2) -> Option<LightSample> {
        if !self.two_sided && self.form.is_behind(self.normal, to.point) {
            return None;
        }
        let place = self.form.sample(self.normal, to.point, u, to.area_limit())?;
        if place.cosine <= 0.0 && !self.two_sided {
            return None;
        }
        let light = LightId::Surface(self.object, self.part);
        Some(LightSample {
            light,
            wi: place.wi,
            reach: place.distance,
            error: self.error + gamma(8) * place.distance,
            cosine: place.cosine.abs().max(1e-3),
            radiance: self.radiance,
            choice,
            pdf: place.pdf,
        })
    }
}

#[cfg(test)]
mod tests;
