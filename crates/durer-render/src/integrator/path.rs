//! Path tracing: light that was scattered any number of times.
//!
//! At each point a light is chosen and connected with, and a direction is chosen and followed;
//! where both can find the same light, they are weighed by how well they find it (Veach, *Robust
//! Monte Carlo Methods for Light Transport Simulation*, 1997, chapter 9: the power heuristic). Long
//! paths end at random, in proportion to what they are worth.

use super::media::{Media, Passage};
use super::trace::{Bounce, HitRecord, NodeId, RayKind, TermKind, TermValue, TraceListener};
use super::{Integrate, Settings, one_by_one};
use crate::world::{Hit, Interaction, Shading, TOGETHER, World};
use durer_scene::bsdf::lobe::diffuse::Diffuse;
use durer_scene::bsdf::{Bsdf, Frame};
use durer_scene::camera::RayCone;
use durer_scene::math::{Color, Ray, Ray64, Vec3, gamma};
use durer_scene::medium::{Flight, HenyeyGreenstein, Way};
use durer_scene::sampler::SampleId;
use durer_scene::shape::Surface;
use durer_scene::spectrum::{Lanes, Spectrum};
use glam::DVec3;
pub use parameters::{Direct, PhotonParameters, Transport};
pub use photons::{Gathered, PhotonMap, Photons};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use vertex::{Chosen, DIRECTIONS, Place, Scattered, TRIES, Vertex};

/// The integrator over one world.
#[derive(Clone, Debug)]
pub struct Path<'w> {
    /// What is seen.
    pub world: &'w World,
    /// How often light may be scattered after the first time, and whether it is blocked.
    pub settings: Settings,
    /// How light is carried.
    pub transport: Transport,
    /// What brings the light of lamps that mirrors and glass throw on things; without, paths find
    /// it by chance.
    pub photons: Option<Arc<Photons>>,
    /// How wide what a sample stands for is, if some picture asks.
    pub cone: Option<RayCone>,
    /// Once set, no more rays are traced, and what comes out means nothing.
    pub cancel: Option<&'w AtomicBool>,
}

/// Random numbers of one bounce, by what they are for: pairs of a sample's dimensions.
#[derive(Clone, Copy)]
enum Use {
    /// The lobe, and the light.
    Choices,
    Direction,
    PlaceOnLight,
    /// Whether the path goes on, and which of several directions that were tried is taken.
    Survival,
}

/// Pairs that a bounce takes.
const USES: usize = 4;

/// What is the same all along a path.
struct Sample {
    /// Its random numbers.
    id: SampleId,
    /// What its light is made of.
    lanes: Lanes,
    /// What mirrors and glass throw on things.
    photons: Option<Arc<PhotonMap>>,
}

impl Sample {
    /// The random numbers of a bounce.
    fn bounce(&self, depth: u32) -> SampleId {
        self.id.at(depth * USES as u32)
    }

    /// Light, as a witness is told of it.
    fn told(&self, light: Spectrum) -> TermValue {
        TermValue::of(&self.lanes, light)
    }

    /// Of several directions from a point one: its numbers lie evenly among those of all samples.
    fn branch(&self, number: u32, of: u32) -> Sample {
        let id = self.id.of_sample(self.id.sample.wrapping_mul(of).wrapping_add(number));
        Sample { id, lanes: self.lanes, photons: self.photons.clone() }
    }
}

/// What a ray carries from bounce to bounce.
struct State {
    /// What the ray runs in.
    media: Media,
    /// How much it counts for in the pixel, by lane; of several directions from a point, what each
    /// would alone: that they share must not end them sooner.
    throughput: Spectrum,
    /// How often it was scattered.
    depth: u32,
    /// Where it was scattered last, if lights can be found there in another way.
    from: Option<Scattered>,
    /// Whether mirrors or glass come after a point that scatters into many directions: light that
    /// is seen over them there is what photons bring.
    behind_mirrors: bool,
    /// Whether the thing that it was last scattered by is one that photons are sent to.
    by_target: bool,
    /// Whether it was scattered into many directions, and nothing but single directions came after.
    broad: bool,
    /// Whether only the first lane still counts, since others would go other ways.
    alone: bool,
    /// How long the way from the camera is, if it went straight or over mirrors and through glass.
    from_camera: Option<f32>,
    /// Node of the trace that its terms belong to.
    node: NodeId,
}

impl Default for State {
    fn default() -> Self {
        State {
            by_target: false,
            media: Media::default(),
            throughput: Spectrum::ONE,
            depth: 0,
            from: None,
            behind_mirrors: false,
            broad: false,
            alone: false,
            from_camera: Some(0.0),
            node: NodeId::NONE,
        }
    }
}

/// Where a ray's way ends.
enum End {
    /// Nowhere: what would come of it counts for too little.
    Lost,
    /// In the surroundings, in a direction.
    Sky(Vec3),
    /// In a medium in which lamps can be seen, along a unit direction.
    Medium(DVec3, Vec3, HenyeyGreenstein),
    /// On a surface, and how light goes through it if it does.
    Surface(Option<Passage>),
}

/// How often light is scattered in a body at most until it gets out.
const MAX_WALK: u32 = 10_000;

impl Integrate for Path<'_> {
    fn radiance<T: TraceListener>(&self, ray: &Ray, id: SampleId, tally: &mut T) -> Color {
        let sample = self.sample(id);
        tally.lanes(&sample.lanes);
        let node = tally.begin(NodeId::ROOT, || TermKind::Ray {
            from: RayKind::Camera,
            ray: ray.into(),
            weight: 1.0,
            hit: None,
            bounce: None,
        });
        let mut ray = Ray64::from(ray);
        let hit = self.world.closest_along(&mut ray, tally);
        let (sum, scale) = self.trace(&ray, hit, &mut State { node, ..self.start(ray.origin()) }, &sample, tally);
        let light = sum * scale;
        tally.end(node, sample.told(Spectrum::ONE), sample.told(scale), sample.told(light));
        sample.lanes.color(light)
    }

    /// What camera rays hit is asked for together.
    fn radiances<T: TraceListener>(
        &self,
        rays: &[Ray64],
        begin: impl Fn(usize) -> SampleId,
        tally: &mut T,
        colors: &mut [Color],
    ) {
        if T::LISTENS || T::COUNTS_WORK {
            return one_by_one(self, rays, begin, tally, colors);
        }
        let mut found = [None; TOGETHER];
        for (part, (rays, colors)) in rays.chunks(TOGETHER).zip(colors.chunks_mut(TOGETHER)).enumerate() {
            self.world.closest_together(rays, &mut found[..rays.len()]);
            for (i, (ray, color)) in rays.iter().zip(colors).enumerate() {
                tally.ray();
                let sample = self.sample(begin(part * TOGETHER + i));
                let (sum, scale) = self.trace(ray, found[i], &mut self.start(ray.origin()), &sample, tally);
                *color = sample.lanes.color(sum * scale);
            }
        }
    }

    fn prepare(&self, sample: u32) {
        if let Some(photons) = &self.photons {
            photons.prepare(self, sample);
        }
    }
}

impl<'w> Path<'w> {
    /// Without photons, and never cancelled.
    pub fn new(world: &'w World, settings: Settings, transport: Transport) -> Self {
        Path { world, settings, transport, photons: None, cone: None, cancel: None }
    }

    fn sample(&self, id: SampleId) -> Sample {
        match &self.photons {
            Some(photons) => {
                let map = photons.map(self, id.sample);
                Sample { id, lanes: *map.lanes(), photons: Some(map) }
            }
            None => Sample { id, lanes: Lanes::new(self.transport.color, id.wavelength()), photons: None },
        }
    }

    /// The irradiance at a point on the side of a unit normal, by the random numbers of a sample:
    /// pi times what a white matte surface shows there.
    pub fn irradiance<T: TraceListener>(&self, point: DVec3, normal: Vec3, id: SampleId, tally: &mut T) -> Color {
        self.irradiance_on(&Surface::around(point, normal), normal, id, tally)
    }

    /// The same at a point of a surface, on the side of a normal for shading.
    pub fn irradiance_on<T: TraceListener>(
        &self,
        surface: &Surface,
        normal: Vec3,
        id: SampleId,
        tally: &mut T,
    ) -> Color {
        let mut bsdf = Bsdf::default();
        bsdf.push(Diffuse::lambert(Spectrum::ONE), Spectrum::ONE, 1.0);
        let n_geo = if surface.n_geo.dot(normal) < 0.0 { -surface.n_geo } else { surface.n_geo };
        let shading = Shading { frame: Frame::around(normal), n_geo, wo: Vec3::Z, bsdf };
        let sample = self.sample(id);
        let state = State { from_camera: None, ..self.start(surface.point()) };
        let vertex = self.vertex(Place::Surface(surface, &shading, None), &state, &sample);
        std::f32::consts::PI * sample.lanes.color(self.scattered(Spectrum::ZERO, &vertex, &sample, tally))
    }

    /// What a ray carries from a point where it is given no other.
    fn start(&self, point: DVec3) -> State {
        State { media: Media::around(self.world, point.as_vec3()), ..State::default() }
    }

    fn vertex<'a>(&self, place: Place<'a, 'w>, state: &'a State, sample: &Sample) -> Vertex<'a, 'w> {
        let narrow = self.world.environment().is_some() && place.is_glossy();
        let (tries, directions) = match (narrow, state.depth) {
            (true, 0) => (TRIES, DIRECTIONS),
            (true, _) => (TRIES, 1),
            (false, _) => (1, 1),
        };
        Vertex { place, state, numbers: sample.bounce(state.depth).pairs(), tries: tries as f32, directions }
    }

    /// The light along a ray to its first hit: a sum, and what the way to it leaves of it.
    fn trace<T: TraceListener>(
        &self,
        ray: &Ray64,
        hit: Option<Hit>,
        state: &mut State,
        sample: &Sample,
        tally: &mut T,
    ) -> (Spectrum, Spectrum) {
        let mut at = Interaction::NOWHERE;
        let (end, scale) = self.fly((ray, hit), &mut at, state, sample, tally);
        let sum = match end {
            End::Lost => Spectrum::ZERO,
            End::Sky(dir) => {
                let (sky, pdf) = self.world.emitters().sky(self.world, dir);
                let mut sky = sample.lanes.light(sky);
                // Suns are seen from the camera, also in mirrors and through glass; elsewhere they are
                // connected with.
                if state.from_camera.is_some() {
                    let suns = self.world.emitters().suns(dir);
                    sky += suns
                        .map(|(light, color)| sample.lanes.light_of(color, || self.world.illuminant(light)))
                        .sum::<Spectrum>();
                }
                let chance = |from: &Scattered| from.tries * self.world.emitters().chance_of_sky(self.world, &from.at);
                let weight = self.weight(state, self.world.environment().is_some(), |from| pdf * chance(from));
                let node = tally.begin(state.node, || TermKind::Sky);
                tally.end(node, sample.told(Spectrum::splat(weight)), sample.told(Spectrum::ONE), sample.told(sky));
                weight * sky
            }
            End::Medium(point, dir, phase) => {
                let place = Place::Medium(point, dir, phase);
                self.scattered(Spectrum::ZERO, &self.vertex(place, state, sample), sample, tally)
            }
            End::Surface(passage) => self.met(&at, passage.as_ref(), state, sample, tally),
        };
        (sum, scale)
    }

    /// Follows a ray to where something happens to its light, and says what the way there leaves of
    /// it. What it meets is written where it stays: a copy of what was just written takes long.
    fn fly<T: TraceListener>(
        &self,
        (ray, mut hit): (&Ray64, Option<Hit>),
        at: &mut Interaction,
        state: &mut State,
        sample: &Sample,
        tally: &mut T,
    ) -> (End, Spectrum) {
        let mut ray = *ray;
        let mut rest = ray;
        let mut scale = Spectrum::ONE;
        let (mut walked, mut layers, mut scattered) = (0.0, 0, 0);
        let mut numbers = sample.id.stream(state.depth, 0);
        let whole = state.throughput;
        loop {
            'passed: {
                let stretch = ray.dir().length();
                let length = hit.map_or(f32::INFINITY, |hit| hit.t * stretch);
                if let Some(medium) = self.world.medium(state.media.object()) {
                    let way = Way { origin: ray.origin(), dir: ray.dir() / stretch, from: walked, to: length };
                    match medium.flight(&way, state.throughput, &sample.lanes, &mut || numbers.number()) {
                        Flight::Passed(left) => scale *= left,
                        Flight::Scattered(distance, left) => {
                            scale *= left;
                            state.throughput = whole * scale;
                            // Never beyond what bounds it.
                            let distance = distance.min(length * (1.0 - gamma(16)));
                            let point = way.origin + f64::from(distance) * way.dir.as_dvec3();
                            if self.world.is_open(state.media.object()) {
                                return (End::Medium(point, way.dir, medium.phase), scale);
                            }
                            // No lamp is seen from inside: the way is followed until it leads out.
                            scattered += 1;
                            let survival = match scattered {
                                0..16 => 1.0,
                                _ => state.throughput.max_element().min(1.0),
                            };
                            let cancelled = scattered % 256 == 0 && self.is_cancelled();
                            if scattered > MAX_WALK || cancelled || numbers.number() >= survival {
                                return (End::Lost, scale);
                            }
                            scale /= survival;
                            let dir = medium.phase.sample(way.dir, numbers.pair());
                            ray = Ray64::new(point, dir, 0.0, f32::INFINITY);
                            (rest, walked, state.from, state.from_camera) = (ray, 0.0, None, None);
                            state.throughput = whole * scale;
                            break 'passed;
                        }
                    }
                    state.throughput = whole * scale;
                }
                let Some(hit) = hit else { return (End::Sky(ray.dir()), scale) };
                walked = length;
                self.world.meet(&ray, hit, at);
                if let (Some(cone), Some(before)) = (&self.cone, state.from_camera) {
                    at.width = cone.width_at(before + length);
                }
                if self.world.hides_backs() && state.depth == 0 && self.world.is_hidden(ray.dir(), at) {
                    rest.rounded.t_min = hit.t;
                    break 'passed;
                }
                if self.world.has_cutouts() {
                    let opacity = self.world.opacity(at);
                    layers += 1;
                    // What is not there at all does not count as a bounce.
                    if opacity < 1.0 && sample.id.layer(state.depth, layers) >= opacity {
                        rest.rounded.t_min = hit.t;
                        break 'passed;
                    }
                }
                match self.passage(at, &state.media, &sample.lanes) {
                    Some(passage) if self.is_nothing(at, &passage) => {
                        (state.media, rest.rounded.t_min) = (passage.behind, hit.t);
                    }
                    passage => {
                        state.from_camera = state.from_camera.map(|before| before + length);
                        return (End::Surface(passage), scale);
                    }
                }
            }
            hit = self.world.closest_along(&mut rest, tally);
        }
    }

    fn is_cancelled(&self) -> bool {
        self.cancel.is_some_and(|cancel| cancel.load(Relaxed))
    }

    /// How light goes through a hit of a body that lets it in.
    fn passage(&self, at: &Interaction, media: &Media, lanes: &Lanes) -> Option<Passage> {
        let ior = self.world.refracts(at, lanes)?;
        Some(media.nested_passage(self.world, at, ior, at.inside()))
    }

    /// Whether a surface does nothing to light but to let it into another medium.
    fn is_nothing(&self, at: &Interaction, passage: &Passage) -> bool {
        passage.hidden || passage.here == passage.there && self.world.is_interface(at)
    }

    /// The light that leaves a hit against the ray.
    fn met<T: TraceListener>(
        &self,
        at: &Interaction,
        passage: Option<&Passage>,
        state: &mut State,
        sample: &Sample,
        tally: &mut T,
    ) -> Spectrum {
        let shading = self.world.shading(at, passage.map_or(1.0, Passage::eta), &sample.lanes);
        tally.hit(state.node, || HitRecord::new(self.world, at, shading.frame.normal, at.inside(), false));
        let mut sum = Spectrum::ZERO;
        let emitted = self.world.emission(at);
        if emitted != Color::ZERO {
            let emitted = sample.lanes.light_of(emitted, || self.world.own_illuminant(at.material));
            let carried = self.world.emitters().chooses(&at.hit, at.ray.dir());
            let weight = self.weight(state, carried, |from| self.pdf_of_hit(at, from));
            let node = tally.begin(state.node, || TermKind::Emission { mis: weight });
            tally.end(node, sample.told(Spectrum::splat(weight)), sample.told(Spectrum::ONE), sample.told(emitted));
            sum += weight * emitted;
        }
        if shading.bsdf.is_black() {
            return sum;
        }
        let kept = self.kept(at, state, sample);
        state.by_target = self.is_target(at);
        let place = Place::Surface(&at.surface, &shading, passage);
        let Some((nm, kept)) = kept else {
            return self.scattered(sum, &self.vertex(place, state, sample), sample, tally);
        };
        let node = tally.begin(state.node, || TermKind::OneWavelength { nm });
        state.node = node;
        let light = self.scattered(Spectrum::ZERO, &self.vertex(place, state, sample), sample, tally);
        tally.end(node, sample.told(kept), sample.told(Spectrum::ONE), sample.told(light));
        sum + kept * light
    }

    /// The wavelength that is left where colours are spread, and what is left of light: other
    /// wavelengths are bent otherwise, and the first stands for all.
    fn kept(&self, at: &Interaction, state: &mut State, sample: &Sample) -> Option<(f32, Spectrum)> {
        let nm = sample.lanes.hero().filter(|_| !state.alone && self.world.disperses(at))?;
        let kept = Spectrum::X * 4.0;
        (state.throughput, state.alone) = (state.throughput * kept, true);
        Some((nm, kept))
    }

    /// A sum and the light that a point scatters against the ray, added in the order in which a
    /// witness hears of it.
    fn scattered<T: TraceListener>(&self, sum: Spectrum, vertex: &Vertex, sample: &Sample, tally: &mut T) -> Spectrum {
        if vertex.state.depth > self.settings.bounces || self.is_cancelled() {
            return sum;
        }
        let mut sum = sum;
        let is_broad = vertex.place.is_broad();
        // A light is waited for, in many it lies far away in memory: meanwhile a direction is chosen.
        let light = if is_broad { self.choose(vertex) } else { None };
        let direction = if vertex.directions == 1 { vertex.direction() } else { None };
        if let Some(light) = light {
            sum += self.direct(&light, vertex, sample, tally);
        }
        if is_broad {
            sum += self.caustic(vertex, sample, tally);
        }
        if let Some(chosen) = direction {
            sum += self.indirect(&chosen, vertex, sample, tally);
        }
        if vertex.directions > 1 {
            for number in 0..vertex.directions {
                let sample = sample.branch(number, vertex.directions);
                let vertex = Vertex { numbers: sample.bounce(vertex.state.depth).pairs(), ..*vertex };
                if let Some(chosen) = vertex.direction() {
                    sum += self.indirect(&chosen, &vertex, &sample, tally);
                }
            }
        }
        sum
    }

    /// The light of lamps that mirrors and glass throw on a surface, or into a medium.
    fn caustic<T: TraceListener>(&self, vertex: &Vertex, sample: &Sample, tally: &mut T) -> Spectrum {
        let Some(map) = &sample.photons else { return Spectrum::ZERO };
        let most = self.settings.bounces - vertex.state.depth;
        let Gathered { light, photons, radius } = match &vertex.place {
            Place::Surface(surface, shading, _) => map.on_surface(surface, shading, most),
            Place::Medium(point, dir, phase) => {
                map.in_medium((point.as_vec3(), *dir), vertex.state.media.object(), phase, most)
            }
        };
        if photons > 0 {
            let node = tally.begin(vertex.state.node, || TermKind::Photons { radius, photons });
            tally.end(node, sample.told(Spectrum::ONE), sample.told(Spectrum::ONE), sample.told(light));
        }
        light
    }

    /// The light from a direction that is chosen.
    fn indirect<T: TraceListener>(&self, chosen: &Chosen, vertex: &Vertex, sample: &Sample, tally: &mut T) -> Spectrum {
        let Vertex { place, state, .. } = vertex;
        let directions = vertex.directions as f32;
        let throughput = state.throughput * chosen.weight;
        // Paths go on with a probability that keeps those that go on equally bright.
        let survival = match state.depth {
            0..3 => 1.0,
            _ => throughput.max_element().min(0.95),
        };
        if survival < 1.0 && vertex.numbers(Use::Survival).x >= survival {
            return Spectrum::ZERO;
        }
        let weight = chosen.weight / (survival * directions);
        let delta = chosen.pdf == 0.0;
        let mut below = State {
            media: place.media(state, chosen.wi).clone(),
            throughput: throughput / survival,
            depth: state.depth + 1,
            // Nothing can be connected with over a single direction, but straight on.
            from: match delta {
                false => Some(Scattered { at: vertex.receiver(), pdf: directions * chosen.pdf, tries: vertex.tries }),
                true => state.from.filter(|_| self.is_seen_through(vertex, chosen.lobe)),
            },
            behind_mirrors: delta && (state.broad || state.behind_mirrors),
            by_target: state.by_target,
            broad: !delta || state.broad,
            alone: state.alone,
            from_camera: state.from_camera.filter(|_| delta),
            node: NodeId::NONE,
        };
        let mut ray = place.spawn(chosen.wi);
        let node = tally.begin(state.node, || TermKind::Ray {
            from: match (delta, chosen.passes) {
                (true, false) => RayKind::Reflected,
                (true, true) => RayKind::Transmitted,
                (false, _) => RayKind::Scattered,
            },
            ray: (&ray).into(),
            weight: below.throughput.max_element(),
            hit: None,
            bounce: Some({
                let (lobe, probability) = place.lobe(chosen.lobe);
                Bounce { lobe, probability, pdf: chosen.pdf, survival, directions: vertex.directions }
            }),
        });
        below.node = node;
        let indirect = state.depth > 0;
        let hit = self.world.closest_along(&mut ray, tally);
        let (sum, scale) = self.trace(&ray, hit, &mut below, sample, tally);
        let scale = scale * self.clamped(sum * scale * weight * state.throughput, indirect);
        let light = sum * scale;
        tally.end(node, sample.told(weight), sample.told(scale), sample.told(light));
        weight * light
    }

    /// What is left of light that is too bright.
    fn clamped(&self, arriving: Spectrum, indirect: bool) -> f32 {
        match self.transport.clamp {
            Some(most) if indirect && arriving.max_element() > most => most / arriving.max_element(),
            _ => 1.0,
        }
    }
}

mod direct;
mod parameters;
mod photons;
#[cfg(test)]
mod tests;
mod vertex;
