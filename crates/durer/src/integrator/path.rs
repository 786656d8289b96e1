//! Path tracing: light that was scattered any number of times.
//!
//! At each point a light is chosen and connected with, and a direction is chosen and followed; where both can find the same
//! light, they are weighed by how well they find it (Veach, *Robust Monte Carlo Methods for Light Transport Simulation*, 1997,
//! chapter 9: the power heuristic). Long paths end at random, in proportion to what they are worth.

use super::Settings;
use super::account::{Bounce, RayKind, Shadow, What, Witness};
use super::media::{Media, Passage};
use super::spawn::{from_surface, to_light};
use super::whitted::struck;
use crate::bsdf::lobe::diffuse::Diffuse;
use crate::bsdf::{Bsdf, BsdfSample, Frame};
use crate::math::{Color, Ray, Ray64, Vec3, fp, gamma};
use crate::sampler::SampleId;
use crate::shape::Surface;
use crate::spectrum::{ColorMode, Lanes, Spectrum};
use crate::world::emitters::LightSample;
use crate::world::{Hit, Shading, World};
use glam::DVec3;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// The integrator over one world.
#[derive(Clone, Copy, Debug)]
pub struct Path<'w> {
    /// What is seen.
    pub world: &'w World,
    /// How often light may be scattered after the first time, and whether it is blocked.
    pub settings: Settings,
    /// Light that was scattered more than once is not brighter than this. It removes bright specks, and light with them.
    pub clamp: Option<f32>,
    /// What colours are on the way.
    pub color: ColorMode,
    /// Once set, no more rays are traced, and what comes out means nothing.
    pub cancel: Option<&'w AtomicBool>,
}

/// Random numbers of one bounce, by what they are for: pairs of a sample's dimensions.
#[derive(Clone, Copy)]
enum Use {
    /// The lobe, and whether the path goes on.
    Lobe,
    Direction,
    Light,
    PlaceOnLight,
}

/// Pairs that a bounce takes.
const USES: u32 = 4;

/// What is the same all along a path.
#[derive(Clone, Copy)]
struct Sample {
    /// Its random numbers.
    id: SampleId,
    /// What its light is made of.
    lanes: Lanes,
}

impl Sample {
    /// The random numbers of a bounce.
    fn bounce(&self, depth: u32) -> SampleId {
        self.id.at(depth * USES)
    }
}

/// What a ray carries from bounce to bounce.
struct State {
    /// What the ray runs in.
    media: Media,
    /// How much it counts for in the pixel, by lane.
    throughput: Spectrum,
    /// How often it was scattered.
    depth: u32,
    /// Where it was scattered last, if lights can be found there in another way.
    from: Option<Scattered>,
}

impl Default for State {
    fn default() -> Self {
        State { media: Media::default(), throughput: Spectrum::ONE, depth: 0, from: None }
    }
}

/// A point from which lights were connected with.
#[derive(Clone, Copy)]
struct Scattered {
    point: DVec3,
    n: Vec3,
    /// The density with which the direction was chosen.
    pdf: f32,
}

/// A point on the way of a path.
struct Vertex<'a> {
    surface: &'a Surface,
    shading: &'a Shading,
    state: &'a State,
}

impl Path<'_> {
    /// The light that comes along a camera ray, by the random numbers of a sample.
    pub fn radiance<T: Witness>(&self, ray: &Ray, id: SampleId, tally: &mut T) -> Color {
        let sample = Sample { id, lanes: Lanes::new(self.color, id.wavelength()) };
        tally.begin(|| What::Ray { from: RayKind::Camera, ray: ray.into(), weight: 1.0, hit: None, bounce: None });
        let (sum, scale) = self.trace(&ray.into(), State::default(), &sample, tally);
        let light = sum * scale;
        tally.end(Color::ONE, scale.truncate(), light.truncate());
        sample.lanes.color(light)
    }

    /// The irradiance at a point on the side of a unit normal, by the random numbers of a sample: pi times what a white matte
    /// surface shows there.
    pub fn irradiance<T: Witness>(&self, point: DVec3, normal: Vec3, id: SampleId, tally: &mut T) -> Color {
        let surface = Surface::around(point, normal);
        let mut bsdf = Bsdf::default();
        bsdf.push(Diffuse { color: Spectrum::ONE, roughness: 0.0 }, Spectrum::ONE, 1.0);
        let shading = Shading { frame: Frame::around(normal), n_geo: normal, wo: Vec3::Z, bsdf };
        let sample = Sample { id, lanes: Lanes::new(self.color, id.wavelength()) };
        let vertex = Vertex { surface: &surface, shading: &shading, state: &State::default() };
        let light = self.direct(&vertex, &sample, tally) + self.indirect(&vertex, None, &sample, tally);
        std::f32::consts::PI * sample.lanes.color(light)
    }

    /// The light along a ray: a sum, and what the way to it leaves of it.
    fn trace<T: Witness>(&self, ray: &Ray64, mut state: State, sample: &Sample, tally: &mut T) -> (Spectrum, Spectrum) {
        let mut rest = *ray;
        let mut scale = Spectrum::ONE;
        let (mut walked, mut layers) = (0.0, 0);
        while let Some(hit) = self.world.closest(&rest, tally) {
            let surface = self.world.surface(ray, &hit);
            let length = hit.t * ray.dir().length();
            scale *= self.left_of_light(&state.media, length - walked, &sample.lanes);
            walked = length;
            if self.world.has_cutouts {
                let opacity = self.world.opacity(&hit, &surface);
                layers += 1;
                // What is not there at all does not count as a bounce.
                if opacity < 1.0 && sample.id.layer(state.depth, layers) >= opacity {
                    rest.rounded.t_min = hit.t;
                    continue;
                }
            }
            match self.passage(ray, &hit, &surface, &state.media) {
                Some(Passage { hidden: true, behind, .. }) => (state.media, rest.rounded.t_min) = (behind, hit.t),
                passage => return (self.scattered(ray, &hit, &surface, passage, state, sample, tally), scale),
            }
        }
        let sky = self.world.sky(ray.dir());
        let weight =
            state.from.map_or(1.0, |from| power(from.pdf, self.world.emitters.pdf_of_sky(self.world, ray.dir())));
        let sky = sample.lanes.light(sky);
        tally.begin(|| What::Sky);
        tally.end(Color::splat(weight), Color::ONE, sky.truncate());
        (weight * sky, scale)
    }

    /// What a way through the body that a ray is in leaves of its light.
    ///
    /// Source: Beer's law.
    fn left_of_light(&self, media: &Media, length: f32, lanes: &Lanes) -> Spectrum {
        let Some(object) = media.object() else { return Spectrum::ONE };
        match self.world.absorption(object) {
            Color::ZERO => Spectrum::ONE,
            absorption => (-lanes.coefficient(absorption) * length).map(fp::exp),
        }
    }

    /// How light goes through a hit of a body that lets it through.
    fn passage(&self, ray: &Ray64, hit: &Hit, surface: &Surface, media: &Media) -> Option<Passage> {
        if !self.world.may_transmit(hit) {
            return None;
        }
        let ior = self.world.refracts(hit, surface)?;
        let leaving = ray.dir().dot(surface.n_geo) > 0.0;
        Some(media.nested_passage(self.world, ray, (hit.object, ior), leaving))
    }

    /// The light that leaves a hit against the ray.
    #[expect(clippy::too_many_arguments)]
    fn scattered<T: Witness>(
        &self,
        ray: &Ray64,
        hit: &Hit,
        surface: &Surface,
        passage: Option<Passage>,
        state: State,
        sample: &Sample,
        tally: &mut T,
    ) -> Spectrum {
        let inside = ray.dir().dot(surface.n_geo) > 0.0;
        let eta = passage.as_ref().map_or(1.0, |passage| passage.there / passage.here);
        let shading = self.world.shading(ray.dir(), hit, surface, (inside, eta), &sample.lanes);
        tally.hit(|| struck(self.world, ray, hit, surface, shading.frame.normal, inside, false));
        let mut sum = Spectrum::ZERO;
        let emitted = self.world.emission(hit, surface, inside);
        if emitted != Color::ZERO {
            let emitted = sample.lanes.light(emitted);
            let weight = self.weight_of_hit(ray, hit, &state);
            tally.begin(|| What::Emission { mis: weight });
            tally.end(Color::splat(weight), Color::ONE, emitted.truncate());
            sum += weight * emitted;
        }
        let cancelled = self.cancel.is_some_and(|cancel| cancel.load(Relaxed));
        if state.depth > self.settings.bounces || cancelled || shading.bsdf.is_black() {
            return sum;
        }
        let vertex = Vertex { surface, shading: &shading, state: &state };
        if shading.bsdf.is_broad() {
            sum += self.direct(&vertex, sample, tally);
        }
        sum + self.indirect(&vertex, passage, sample, tally)
    }

    /// How much a light counts that a ray met by its direction, where it could have been connected with too.
    fn weight_of_hit(&self, ray: &Ray64, hit: &Hit, state: &State) -> f32 {
        let Some(from) = state.from else { return 1.0 };
        let length = ray.dir().length();
        let (wi, distance) = (ray.dir() / length, hit.t * length);
        power(from.pdf, self.world.emitters.pdf_of_hit(self.world, hit, from.point, from.n, wi, distance))
    }

    /// The light of one light that is chosen.
    fn direct<T: Witness>(&self, vertex: &Vertex, sample: &Sample, tally: &mut T) -> Spectrum {
        let (world, surface, shading) = (self.world, vertex.surface, vertex.shading);
        let id = sample.bounce(vertex.state.depth);
        let (choice, place) = (id.pair(Use::Light as u32).x, id.pair(Use::PlaceOnLight as u32));
        let chosen = world.emitters.sample(world, surface.point(), shading.frame.normal, choice, place);
        let Some(light) = chosen else { return Spectrum::ZERO };
        let value = shading.eval(light.wi);
        if value == Spectrum::ZERO || light.radiance == Color::ZERO {
            return Spectrum::ZERO;
        }
        let (weight, density) = match light.pdf > 0.0 {
            true => (power(light.choice * light.pdf, shading.pdf(light.wi)), light.choice * light.pdf),
            // Directions never meet a light without extent.
            false => (1.0, light.choice),
        };
        let visible = self.visible(surface, &light, tally);
        let factor = value * (weight / density) * visible;
        tally.begin(|| What::Direct {
            light: light.light,
            to_light: light.wi,
            distance: light.reach,
            choice: light.choice,
            pdf: light.pdf,
            bsdf: value.truncate(),
            mis: weight,
            shadow: self.settings.shadows.then(|| self.shadow(surface, &light, visible)),
        });
        let radiance = sample.lanes.light(light.radiance);
        tally.end(factor.truncate(), Color::ONE, radiance.truncate());
        factor * radiance
    }

    /// The light from a direction that is chosen.
    fn indirect<T: Witness>(
        &self,
        vertex: &Vertex,
        passage: Option<Passage>,
        sample: &Sample,
        tally: &mut T,
    ) -> Spectrum {
        let Vertex { surface, shading, state } = *vertex;
        let id = sample.bounce(state.depth);
        let (numbers, u) = (id.pair(Use::Lobe as u32), id.pair(Use::Direction as u32));
        let Some(chosen) = shading.bsdf.sample(shading.wo, numbers.x, u) else { return Spectrum::ZERO };
        let wi = shading.frame.to_world(chosen.wi);
        let passes = chosen.wi.z < 0.0;
        if passes != (wi.dot(shading.n_geo) < 0.0) {
            return Spectrum::ZERO;
        }
        let throughput = state.throughput * chosen.weight;
        // Paths go on with a probability that keeps those that go on equally bright.
        let survival = match state.depth {
            0..3 => 1.0,
            _ => throughput.max_element().min(0.95),
        };
        if survival <= 0.0 || numbers.y >= survival {
            return Spectrum::ZERO;
        }
        let weight = chosen.weight / survival;
        let media = match passage {
            Some(passage) if passes => passage.behind,
            _ => state.media.clone(),
        };
        let delta = chosen.pdf == 0.0;
        let below = State {
            media,
            throughput: throughput / survival,
            depth: state.depth + 1,
            // Nothing can be connected with over a single direction.
            from: (!delta).then(|| Scattered { point: surface.point(), n: shading.frame.normal, pdf: chosen.pdf }),
        };
        let ray = from_surface(surface, wi, f32::INFINITY, None);
        tally.begin(|| What::Ray {
            from: match (delta, passes) {
                (true, false) => RayKind::Reflected,
                (true, true) => RayKind::Transmitted,
                (false, _) => RayKind::Scattered,
            },
            ray: (&ray).into(),
            weight: below.throughput.max_element(),
            hit: None,
            bounce: Some(bounce(shading, &chosen, survival)),
        });
        let indirect = state.depth > 0;
        let (sum, scale) = self.trace(&ray, below, sample, tally);
        let scale = scale * self.clamped(sum * scale * weight * state.throughput, indirect);
        let light = sum * scale;
        tally.end(weight.truncate(), scale.truncate(), light.truncate());
        weight * light
    }

    /// What is left of light that is too bright.
    fn clamped(&self, arriving: Spectrum, indirect: bool) -> f32 {
        match self.clamp {
            Some(most) if indirect && arriving.max_element() > most => most / arriving.max_element(),
            _ => 1.0,
        }
    }

    /// The share of a light that arrives.
    fn visible<T: Witness>(&self, surface: &Surface, light: &LightSample, tally: &mut T) -> f32 {
        if !self.settings.shadows {
            return 1.0;
        }
        let mut ray = shadow_ray(surface, light);
        if !self.world.has_cutouts {
            return if self.world.occluded(&ray, tally) { 0.0 } else { 1.0 };
        }
        let mut share = 1.0;
        // A thing with many layers is followed only so far.
        for _ in 0..64 {
            let Some(hit) = self.world.closest(&ray, tally) else { return share };
            let blocker = self.world.surface(&ray, &hit);
            share *= 1.0 - self.world.opacity(&hit, &blocker);
            if share <= 0.0 {
                break;
            }
            ray = from_surface(&blocker, light.wi, ray.rounded.t_max - hit.t, None);
        }
        0.0
    }

    /// What a witness is told of a shadow ray.
    fn shadow(&self, surface: &Surface, light: &LightSample, share: f32) -> Shadow {
        let ray = shadow_ray(surface, light);
        let blocker = self.world.closest(&ray, &mut ()).map(|hit| (hit.object, hit.t));
        Shadow { ray: (&ray).into(), blocker, share: Color::splat(share) }
    }
}

fn shadow_ray(surface: &Surface, light: &LightSample) -> Ray64 {
    // What stands exactly at the light does not block it.
    to_light(surface, light.wi, light.reach * (1.0 - gamma(16)), None)
}

/// The power heuristic: the weight of a way of sampling with density `a`, where another one has density `b`.
fn power(a: f32, b: f32) -> f32 {
    if b == 0.0 {
        return 1.0;
    }
    let ratio = b / a;
    1.0 / (1.0 + ratio * ratio)
}

/// What a witness is told of a choice of direction.
fn bounce(shading: &Shading, sample: &BsdfSample, survival: f32) -> Bounce {
    let lobe = shading.bsdf.lobes().nth(sample.lobe);
    Bounce {
        lobe: lobe.map_or("", |part| part.lobe.name()),
        probability: lobe.map_or(1.0, |part| part.probability),
        pdf: sample.pdf,
        survival,
    }
}

#[cfg(test)]
mod tests;
