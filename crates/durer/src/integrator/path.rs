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

/// What a ray carries from bounce to bounce.
struct State {
    /// What the ray runs in.
    media: Media,
    /// How much it counts for in the pixel, by colour.
    throughput: Color,
    /// How often it was scattered.
    depth: u32,
    /// Where it was scattered last, if lights can be found there in another way.
    from: Option<Scattered>,
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
        let state = State { media: Media::default(), throughput: Color::ONE, depth: 0, from: None };
        tally.begin(|| What::Ray { from: RayKind::Camera, ray: ray.into(), weight: 1.0, hit: None, bounce: None });
        let (sum, scale) = self.trace(&ray.into(), state, id, tally);
        let color = sum * scale;
        tally.end(Color::ONE, scale, color);
        color
    }

    /// The irradiance at a point on the side of a unit normal, by the random numbers of a sample: pi times what a white matte
    /// surface shows there.
    pub fn irradiance<T: Witness>(&self, point: DVec3, normal: Vec3, id: SampleId, tally: &mut T) -> Color {
        let surface = Surface::around(point, normal);
        let mut bsdf = Bsdf::default();
        bsdf.push(Diffuse { color: Color::ONE, roughness: 0.0 }, Color::ONE, 1.0);
        let shading = Shading { frame: Frame::around(normal), n_geo: normal, wo: Vec3::Z, bsdf };
        let state = State { media: Media::default(), throughput: Color::ONE, depth: 0, from: None };
        let vertex = Vertex { surface: &surface, shading: &shading, state: &state };
        let id = id.at(0);
        std::f32::consts::PI * (self.direct(&vertex, id, tally) + self.indirect(&vertex, None, id, tally))
    }

    /// The light along a ray: a sum, and what the way to it leaves of it.
    fn trace<T: Witness>(&self, ray: &Ray64, mut state: State, id: SampleId, tally: &mut T) -> (Color, Color) {
        let mut rest = *ray;
        let mut scale = Color::ONE;
        let (mut walked, mut layers) = (0.0, 0);
        while let Some(hit) = self.world.closest(&rest, tally) {
            let surface = self.world.surface(ray, &hit);
            let length = hit.t * ray.dir().length();
            scale *= self.left_of_light(&state.media, length - walked);
            walked = length;
            if self.world.has_cutouts {
                let opacity = self.world.opacity(&hit, &surface);
                layers += 1;
                // What is not there at all does not count as a bounce.
                if opacity < 1.0 && id.layer(state.depth, layers) >= opacity {
                    rest.rounded.t_min = hit.t;
                    continue;
                }
            }
            match self.passage(ray, &hit, &surface, &state.media) {
                Some(Passage { hidden: true, behind, .. }) => (state.media, rest.rounded.t_min) = (behind, hit.t),
                passage => return (self.scattered(ray, &hit, &surface, passage, state, id, tally), scale),
            }
        }
        let sky = self.world.sky(ray.dir());
        let weight =
            state.from.map_or(1.0, |from| power(from.pdf, self.world.emitters.pdf_of_sky(self.world, ray.dir())));
        tally.begin(|| What::Sky);
        tally.end(Color::splat(weight), Color::ONE, sky);
        (weight * sky, scale)
    }

    /// What a way through the body that a ray is in leaves of its light.
    ///
    /// Source: Beer's law.
    fn left_of_light(&self, media: &Media, length: f32) -> Color {
        let Some(object) = media.object() else { return Color::ONE };
        match self.world.absorption(object) {
            Color::ZERO => Color::ONE,
            absorption => (-absorption * length).map(fp::exp),
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
        id: SampleId,
        tally: &mut T,
    ) -> Color {
        let inside = ray.dir().dot(surface.n_geo) > 0.0;
        let eta = passage.as_ref().map_or(1.0, |passage| passage.there / passage.here);
        let shading = self.world.shading(ray.dir(), hit, surface, inside, eta);
        tally.hit(|| struck(self.world, ray, hit, surface, shading.frame.normal, inside, false));
        let mut sum = Color::ZERO;
        let emitted = self.world.emission(hit, surface, inside);
        if emitted != Color::ZERO {
            let weight = self.weight_of_hit(ray, hit, &state);
            tally.begin(|| What::Emission { mis: weight });
            tally.end(Color::splat(weight), Color::ONE, emitted);
            sum += weight * emitted;
        }
        let cancelled = self.cancel.is_some_and(|cancel| cancel.load(Relaxed));
        if state.depth > self.settings.bounces || cancelled || shading.bsdf.is_black() {
            return sum;
        }
        let id = id.at(state.depth * USES);
        let vertex = Vertex { surface, shading: &shading, state: &state };
        if shading.bsdf.is_broad() {
            sum += self.direct(&vertex, id, tally);
        }
        sum + self.indirect(&vertex, passage, id, tally)
    }

    /// How much a light counts that a ray met by its direction, where it could have been connected with too.
    fn weight_of_hit(&self, ray: &Ray64, hit: &Hit, state: &State) -> f32 {
        let Some(from) = state.from else { return 1.0 };
        let length = ray.dir().length();
        let (wi, distance) = (ray.dir() / length, hit.t * length);
        power(from.pdf, self.world.emitters.pdf_of_hit(self.world, hit, from.point, from.n, wi, distance))
    }

    /// The light of one light that is chosen.
    fn direct<T: Witness>(&self, vertex: &Vertex, id: SampleId, tally: &mut T) -> Color {
        let (world, surface, shading) = (self.world, vertex.surface, vertex.shading);
        let (choice, place) = (id.pair(Use::Light as u32).x, id.pair(Use::PlaceOnLight as u32));
        let sample = world.emitters.sample(world, surface.point(), shading.frame.normal, choice, place);
        let Some(light) = sample else { return Color::ZERO };
        let value = shading.eval(light.wi);
        if value == Color::ZERO || light.radiance == Color::ZERO {
            return Color::ZERO;
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
            bsdf: value,
            mis: weight,
            shadow: self.settings.shadows.then(|| self.shadow(surface, &light, visible)),
        });
        tally.end(factor, Color::ONE, light.radiance);
        factor * light.radiance
    }

    /// The light from a direction that is chosen.
    fn indirect<T: Witness>(&self, vertex: &Vertex, passage: Option<Passage>, id: SampleId, tally: &mut T) -> Color {
        let Vertex { surface, shading, state } = *vertex;
        let (numbers, u) = (id.pair(Use::Lobe as u32), id.pair(Use::Direction as u32));
        let Some(sample) = shading.bsdf.sample(shading.wo, numbers.x, u) else { return Color::ZERO };
        let wi = shading.frame.to_world(sample.wi);
        let passes = sample.wi.z < 0.0;
        if passes != (wi.dot(shading.n_geo) < 0.0) {
            return Color::ZERO;
        }
        let throughput = state.throughput * sample.weight;
        // Paths go on with a probability that keeps those that go on equally bright.
        let survival = match state.depth {
            0..3 => 1.0,
            _ => throughput.max_element().min(0.95),
        };
        if survival <= 0.0 || numbers.y >= survival {
            return Color::ZERO;
        }
        let weight = sample.weight / survival;
        let media = match passage {
            Some(passage) if passes => passage.behind,
            _ => state.media.clone(),
        };
        let delta = sample.pdf == 0.0;
        let below = State {
            media,
            throughput: throughput / survival,
            depth: state.depth + 1,
            // Nothing can be connected with over a single direction.
            from: (!delta).then(|| Scattered { point: surface.point(), n: shading.frame.normal, pdf: sample.pdf }),
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
            bounce: Some(bounce(shading, &sample, survival)),
        });
        let indirect = state.depth > 0;
        let (sum, scale) = self.trace(&ray, below, id, tally);
        let scale = scale * self.clamped(sum * scale * weight * state.throughput, indirect);
        let color = sum * scale;
        tally.end(weight, scale, color);
        weight * color
    }

    /// What is left of light that is too bright.
    fn clamped(&self, arriving: Color, indirect: bool) -> f32 {
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
