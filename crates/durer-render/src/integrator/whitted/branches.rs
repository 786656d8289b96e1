//! Mirrored and transmitted rays of hits that are asked about together, worked out side by side.

use super::Whitted;
use super::secondary::{Blend, Parted};
use crate::integrator::spawn::spawn_ray;
use crate::world::{LANES, Met, Numbers, PLACES, Surfaces, Vectors};
use durer_bvh::internal::{PlainKernel, run_plain};
use durer_scene::math::{self, Color, Ray, Ray64};

/// Rays that go on from hits.
#[derive(Default)]
pub(super) struct Branches {
    pub(super) rays: Vec<Ray64>,
    pub(super) carried: Vec<Carried>,
    /// The colour that weighs the light of each, and once that is known, what it brings.
    pub(super) lights: Vec<Color>,
}

/// What a ray carries from bounce to bounce.
#[derive(Clone, Copy)]
pub(super) struct Carried {
    /// The number of the camera ray from which it comes.
    pub(super) camera: u32,
    /// What it runs in, by number among those that rays which are traced together run in.
    pub(super) media: u32,
    /// How much it counts for in the pixel.
    pub(super) weight: f32,
}

impl Branches {
    pub(super) fn clear(&mut self) {
        self.rays.clear();
        self.carried.clear();
        self.lights.clear();
    }
}

/// Hits from which light goes on, and how.
pub(super) struct Partings {
    /// The hits, with the number of what light runs in behind them.
    hits: Vec<(Met, u32)>,
    /// Whether light goes through some of them.
    transmits: bool,
    given: Given,
    mirrored: Way,
    transmitted: Way,
}

/// What is known of each before light is divided.
struct Given {
    reflective: Vectors,
    transparent: Vectors,
    /// 1 for Fresnel's law, else 0.
    fresnel: Numbers,
    here: Numbers,
    there: Numbers,
    /// 1 where light comes from behind, else 0.
    leaving: Numbers,
}

/// Rays side by side.
struct Way {
    /// The colour that weighs the light; black where there is no ray.
    color: Vectors,
    origin: Vectors,
    rest: Vectors,
    dir: Vectors,
}

impl Default for Partings {
    fn default() -> Self {
        let way = || Way { color: Vectors::ZERO, origin: Vectors::ZERO, rest: Vectors::ZERO, dir: Vectors::ZERO };
        Partings {
            hits: Vec::new(),
            transmits: false,
            given: Given {
                reflective: Vectors::ZERO,
                transparent: Vectors::ZERO,
                fresnel: [0.0; PLACES],
                here: [1.0; PLACES],
                there: [1.0; PLACES],
                leaving: [0.0; PLACES],
            },
            mirrored: way(),
            transmitted: way(),
        }
    }
}

impl Partings {
    pub(super) fn clear(&mut self) {
        self.hits.clear();
        self.transmits = false;
    }

    pub(super) fn is_empty(&self) -> bool {
        self.hits.is_empty()
    }

    /// Adds a hit, with the indices of refraction before and behind it and the number of what is
    /// there.
    #[inline(always)]
    pub(super) fn push(&mut self, met: Met, blend: Blend, leaving: bool, (here, there, behind): (f32, f32, u32)) {
        let (given, place) = (&mut self.given, met.place());
        given.reflective.set(place, blend.reflective);
        given.transparent.set(place, blend.transparent);
        given.fresnel[place] = f32::from(u8::from(blend.fresnel));
        (given.here[place], given.there[place]) = (here, there);
        given.leaving[place] = f32::from(u8::from(leaving));
        self.transmits |= blend.transparent != Color::ZERO;
        self.hits.push((met, behind));
    }
}

impl Whitted<'_> {
    /// Lists the rays that go on from hits, and for each hit its ray and where those end.
    pub(super) fn branch(
        &self,
        surfaces: &Surfaces,
        partings: &mut Partings,
        carried: impl Fn(usize) -> Carried,
        branches: &mut Branches,
        mut ends: impl FnMut(usize, usize),
    ) {
        let transmits = partings.transmits;
        let places = || partings.hits.iter().map(|(met, _)| met.place());
        let (first, last) = (places().min().unwrap_or(0), places().max().unwrap_or(0));
        run_plain(PartingKernel { whitted: self, surfaces, partings, first: first / LANES * LANES, end: last + 1 });
        let epsilon = self.world.shading_rules().epsilon;
        let Partings { hits, mirrored, transmitted, .. } = &*partings;
        for &(met, behind) in hits {
            let (place, before) = (met.place(), carried(met.ray()));
            let ways = [(mirrored, before.media), (transmitted, behind)];
            for &(way, media) in &ways[..if transmits { 2 } else { 1 }] {
                let color = way.color.get(place);
                let weight = self.weight_after(before.weight, color);
                let counts = color.max_element() > 0.0 && weight >= self.settings.least_weight;
                if !counts {
                    continue;
                }
                branches.carried.push(Carried { media, weight, ..before });
                branches.lights.push(color);
                let dir = way.dir.get(place);
                // Each is written to its place at once: what goes round by another would be waited
                // for.
                if let solid @ Some(_) = surfaces.solid(place) {
                    branches.rays.push(spawn_ray(&surfaces.get(place, solid), dir, f32::INFINITY, epsilon));
                    continue;
                }
                let (origin, t_min) = (way.origin.get(place), epsilon.unwrap_or(0.0));
                let rounded = Ray { origin, dir, t_min, t_max: f32::INFINITY };
                branches.rays.push(Ray64 { rounded, rest: way.rest.get(place), side: math::Side::ANY });
            }
            ends(met.ray(), branches.rays.len());
        }
    }
}

/// Divides light at all places from the first to the end, whether it goes on there or not.
struct PartingKernel<'a> {
    whitted: &'a Whitted<'a>,
    surfaces: &'a Surfaces,
    partings: &'a mut Partings,
    first: usize,
    end: usize,
}

impl PlainKernel for PartingKernel<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        match self.partings.transmits {
            true => self.divide::<true>(),
            false => self.divide::<false>(),
        }
    }
}

impl PartingKernel<'_> {
    #[inline(always)]
    fn divide<const TRANSMITS: bool>(self) {
        let PartingKernel { whitted, surfaces, partings, first, end } = self;
        let Partings { given, mirrored, transmitted, .. } = partings;
        let (division, settings, epsilon) =
            (whitted.division(), whitted.settings, whitted.world.shading_rules().epsilon);
        for i in first..end.next_multiple_of(LANES).min(PLACES) {
            let surface = surfaces.get(i, None);
            let blend = Blend {
                reflective: given.reflective.get(i),
                transparent: given.transparent.get(i),
                ior: 1.0,
                fresnel: given.fresnel[i] > 0.0,
            };
            let (media, normals) = ((given.here[i], given.there[i]), [surface.n_shade, surface.n_geo]);
            let parted = division.part(surfaces.view.get(i), normals, given.leaving[i] > 0.0, blend, media);
            let Parted { mirrored: dir, reflective, .. } = parted;
            let reflective = if settings.reflection { reflective } else { Color::ZERO };
            mirrored.set(i, reflective, &spawn_ray(&surface, dir, f32::INFINITY, epsilon));
            if !TRANSMITS {
                continue;
            }
            let goes_on = parted.passes && settings.refraction;
            let transparent = if goes_on { parted.transparent } else { Color::ZERO };
            let dir = if goes_on { parted.transmitted } else { dir };
            transmitted.set(i, transparent, &spawn_ray(&surface, dir, f32::INFINITY, epsilon));
        }
    }
}

impl Way {
    #[inline(always)]
    fn set(&mut self, i: usize, color: Color, ray: &Ray64) {
        self.color.set(i, color);
        self.origin.set(i, ray.rounded.origin);
        self.rest.set(i, ray.rest);
        self.dir.set(i, ray.rounded.dir);
    }
}
