//! Light that comes straight from lamps and surroundings: it is found by choosing points of lights,
//! and by the directions in which a surface scatters; what both can find is weighed.
//!
//! Source: Veach, *Robust Monte Carlo Methods for Light Transport Simulation*, 1997, chapter 9.

use super::vertex::TRIES;
use super::{Path, Place, Sample, Scattered, State, Use, Vertex};
use crate::integrator::Direct;
use crate::integrator::media::Media;
use crate::integrator::spawn::spawn_ray;
use crate::integrator::trace::{Shadow, TermKind, TermValue, TraceListener};
use crate::world::Interaction;
use crate::world::emitters::{Choice, LightSample};
use durer_scene::math::{Color, Ray64, Vec2};
use durer_scene::medium::Way;
use durer_scene::spectrum::Spectrum;

/// A point of a light, and what is known of it where it was chosen for.
struct Drawn {
    light: LightSample,
    /// The surface's value times the cosine.
    value: Spectrum,
    /// The density with which directions there come upon it.
    pdf: f32,
    /// The density with which it is taken; of a light without extent the probability.
    density: f32,
    /// The density with which it is found, taken or not.
    found: f32,
}

/// How far apart the numbers are by which several points of a light are tried: so they lie evenly.
///
/// Source: Martin Roberts, *The Unreasonable Effectiveness of Quasirandom Sequences*, 2018.
const APART: Vec2 = Vec2::new(0.754_877_7, 0.569_840_3);

impl Path<'_> {
    /// How much a light counts that a ray met by its direction, where it could have been found in
    /// another way too. `carried`: photons are sent from it.
    pub(super) fn weight(&self, state: &State, carried: bool, pdf: impl Fn(&Scattered) -> f32) -> f32 {
        match &state.from {
            Some(from) => self.transport.direct.of_direction(from.pdf, pdf(from)),
            None if carried && state.behind_mirrors && state.by_target => 0.0,
            None => 1.0,
        }
    }

    /// The density with which a light that a ray met would have been chosen.
    pub(super) fn pdf_of_hit(&self, at: &Interaction, from: &Scattered) -> f32 {
        let Interaction { ray, hit, .. } = at;
        let way = ray.origin() + f64::from(hit.t) * ray.dir().as_dvec3() - from.at.point;
        let (wi, distance) = (ray.dir().normalize(), way.length() as f32);
        self.world.emitters().pdf_of_hit(self.world, hit, &from.at, wi, distance)
    }

    /// Chooses a light to be connected with.
    pub(super) fn choose(&self, vertex: &Vertex) -> Option<Choice> {
        self.world.emitters().choose(self.world, &vertex.receiver(), vertex.numbers(Use::Choices).y)
    }

    /// The light of one light that was chosen.
    pub(super) fn direct<T: TraceListener>(
        &self,
        choice: &Choice,
        vertex: &Vertex,
        sample: &Sample,
        tally: &mut T,
    ) -> Spectrum {
        let (world, place) = (self.world, &vertex.place);
        let Some(Drawn { light, value, pdf, density, found }) = self.draw(choice, vertex) else {
            return Spectrum::ZERO;
        };
        if value == Spectrum::ZERO || light.radiance == Color::ZERO {
            return Spectrum::ZERO;
        }
        // Directions never meet a light without extent.
        let pdf = if light.pdf > 0.0 { pdf } else { 0.0 };
        let weight_of = |pdf| self.transport.direct.of_light(found, pdf);
        if weight_of(pdf) == 0.0 && !self.world.has_sheets() {
            return Spectrum::ZERO;
        }
        let (visible, sheets) = self.visible(vertex, &light, sample, tally);
        // Each sheet is a bounce of a path, and those that end before the last one meet nothing.
        let weight = weight_of(if vertex.state.depth + sheets > self.settings.bounces { 0.0 } else { pdf });
        let factor = value * (weight / density) * visible;
        let node = tally.begin(vertex.state.node, || TermKind::Direct {
            light: light.light,
            to_light: light.wi,
            distance: light.reach,
            choice: light.choice,
            pdf: light.pdf,
            bsdf: sample.told(value),
            mis: weight,
            shadow: self.settings.shadows.then(|| self.shadow(place, &light, sample.told(visible))),
        });
        let radiance = sample.lanes.light_of(light.radiance, || world.illuminant(light.light));
        tally.end(node, sample.told(factor), sample.told(Spectrum::ONE), sample.told(radiance));
        factor * radiance
    }

    /// Chooses a point of a light.
    fn draw(&self, choice: &Choice, vertex: &Vertex) -> Option<Drawn> {
        let (emitters, place, u) = (self.world.emitters(), &vertex.place, vertex.numbers(Use::PlaceOnLight));
        if choice.is_sky() && vertex.tries > 1.0 {
            return self.best_of_sky(choice, vertex);
        }
        let at = |u| emitters.sample(self.world, choice, place.point(), u);
        let light = match (at(u)?, self.transport.direct) {
            (any, Direct::Middle) => at(emitters.middle(any.light).unwrap_or(u))?,
            (any, _) => any,
        };
        let (value, pdf) = vertex.eval(light.wi);
        let density = if light.pdf > 0.0 { light.choice * light.pdf } else { light.choice };
        Some(Drawn { light, value, pdf, density, found: density })
    }

    /// Of some directions to the surroundings the one to be taken: by what each would bring if
    /// nothing were in the way.
    ///
    /// Source: Talbot, Cline and Egbert, *Importance Resampling for Global Illumination*, EGSR
    /// 2005.
    fn best_of_sky(&self, choice: &Choice, vertex: &Vertex) -> Option<Drawn> {
        let (sky, tries, mut u) = (self.world.environment()?, vertex.tries, vertex.numbers(Use::PlaceOnLight));
        let (mut best, mut sum, mut rest) = (None, 0.0, vertex.numbers(Use::Survival).y);
        for _ in 0..TRIES {
            let direction = sky.direction(u);
            u = (u + APART).map(|x| if x < 1.0 { x } else { x - 1.0 });
            let Some((wi, place, density)) = direction else { continue };
            let (value, pdf) = vertex.eval(wi);
            if value == Spectrum::ZERO {
                continue;
            }
            let (density, radiance) = (choice.probability() * density, sky.light(&place));
            let found = tries * density;
            let brings = self.transport.direct.of_light(found, pdf) * value.max_element() * radiance.max_element();
            let share = brings / density;
            if !(share > 0.0 && share.is_finite()) {
                continue;
            }
            sum += share;
            let chance = share / sum;
            if rest < chance {
                (rest, best) = (rest / chance, Some((wi, radiance, value, pdf, found, brings)));
            } else {
                rest = (rest - chance) / (1.0 - chance);
            }
        }
        let (wi, radiance, value, pdf, found, brings) = best?;
        let density = brings * tries / sum;
        let light = LightSample::of_sky(choice, wi, radiance, density / choice.probability());
        Some(Drawn { light, value, pdf, density, found })
    }

    /// The share of a light that arrives, and through how many sheets.
    fn visible<T: TraceListener>(
        &self,
        vertex: &Vertex,
        light: &LightSample,
        sample: &Sample,
        tally: &mut T,
    ) -> (Spectrum, u32) {
        if !self.settings.shadows {
            return (Spectrum::ONE, 0);
        }
        let Vertex { place, state, .. } = vertex;
        let media = place.media(state, light.wi);
        let mut ray = place.shadow_ray(light);
        let (mut share, mut sheets) = (Spectrum::ONE, 0);
        let mut numbers = sample.id.stream(state.depth, 1);
        let mut pass = |media: &Media, ray: &Ray64, to: f32| match self.world.medium(media.object()) {
            Some(medium) => {
                let way = Way { origin: ray.origin(), dir: light.wi, from: 0.0, to };
                medium.transmittance(&way, &sample.lanes, &mut || numbers.number())
            }
            None => Spectrum::ONE,
        };
        // Light that directions find as well must agree with them, and they meet both sides.
        let hides_backs = self.world.hides_backs() && light.pdf == 0.0;
        if !self.world.has_cutouts() && !self.world.has_interfaces() && !self.world.has_sheets() {
            match self.world.occluded(&ray, tally) {
                true if hides_backs => {}
                true => return (Spectrum::ZERO, 0),
                false => return (pass(media, &ray, ray.rounded.t_max), 0),
            }
        }
        let mut media = media.clone();
        // A thing with many layers is followed only so far.
        for _ in 0..64 {
            let Some(hit) = self.world.closest(&ray, tally) else {
                return (share * pass(&media, &ray, ray.rounded.t_max), sheets);
            };
            share *= pass(&media, &ray, hit.t);
            let blocker = self.world.interaction(ray, hit);
            match self.passage(&blocker, &media, &sample.lanes) {
                Some(passage) if self.is_nothing(&blocker, &passage) => media = passage.behind,
                _ if hides_backs && self.world.is_hidden(-ray.dir(), &blocker) => {}
                None if self.world.has_sheets() => {
                    share *= self.straight(&blocker, sample);
                    sheets += 1;
                }
                _ => share *= 1.0 - self.world.opacity(&blocker),
            }
            if share == Spectrum::ZERO {
                break;
            }
            ray = spawn_ray(&blocker.surface, ray.dir(), ray.rounded.t_max - hit.t, None);
        }
        (Spectrum::ZERO, 0)
    }

    /// The share of light that goes straight through a surface that is no body's: such as a pane.
    /// Where photons come, they bring it.
    fn straight(&self, at: &Interaction, sample: &Sample) -> Spectrum {
        let opacity = self.world.opacity(at);
        let around = Spectrum::splat(1.0 - opacity);
        if !self.world.may_enter(at) || self.is_target(at) {
            return around;
        }
        around + opacity * self.world.shading(at, 1.0, &sample.lanes).bsdf.straight()
    }

    /// Whether a lobe, by number, lets light through as [`Path::straight`] has it, so that what is
    /// behind was found from before too.
    pub(super) fn is_seen_through(&self, vertex: &Vertex, lobe: usize) -> bool {
        self.world.has_sheets() && !vertex.state.by_target && vertex.place.goes_straight(lobe)
    }

    /// Whether photons are sent to what was hit.
    pub(super) fn is_target(&self, at: &Interaction) -> bool {
        self.photons.as_ref().is_some_and(|photons| photons.reaches(at.hit.object))
    }

    /// What a witness is told of a shadow ray.
    fn shadow(&self, place: &Place, light: &LightSample, share: TermValue) -> Shadow {
        let ray = place.shadow_ray(light);
        let blocker = self.world.closest(&ray, &mut ()).map(|hit| (hit.object, hit.t));
        Shadow { ray: (&ray).into(), blocker, share }
    }
}

impl Direct {
    /// The weight of a light that was chosen with density `light`, where its direction has density
    /// `direction`.
    fn of_light(self, light: f32, direction: f32) -> f32 {
        match self {
            Direct::Both => power(light, direction),
            Direct::Lights | Direct::Middle => 1.0,
            // What no direction meets is left to points.
            Direct::Bsdf => f32::from(u8::from(direction == 0.0)),
        }
    }

    /// The weight of a light that was met by a direction of density `direction`, where it is chosen
    /// with density `light`.
    fn of_direction(self, direction: f32, light: f32) -> f32 {
        match self {
            Direct::Both => power(direction, light),
            Direct::Lights | Direct::Middle => f32::from(u8::from(light == 0.0)),
            Direct::Bsdf => 1.0,
        }
    }
}

/// The power heuristic: the weight of a way of sampling with density `a`, where another one has
/// density `b`.
fn power(a: f32, b: f32) -> f32 {
    if b == 0.0 {
        return 1.0;
    }
    let ratio = b / a;
    1.0 / (1.0 + ratio * ratio)
}
