//! Caustics: light of lamps that mirrors and glass throw on other things, by photons.
//!
//! Paths from the eye find such light by chance, or not at all. So photons are sent from the lamps
//! to all that mirrors or refracts, followed over single directions, and kept on the first thing
//! that scatters broadly, or where they are scattered in the air. There the light is estimated from
//! the photons nearby. Each sample of a pixel has photons of its own, and looks less far than the
//! one before, so that the mean over samples comes to the truth.
//!
//! Sources: Hachisuka and Jensen, *Stochastic Progressive Photon Mapping*, 2009; the radius without
//! statistics of pixels: Knaus and Zwicker, *Progressive Photon Mapping: A Probabilistic Approach*,
//! 2011; in media: Jensen and Christensen, *Efficient Simulation of Light Transport in Scenes with
//! Participating Media using Photon Maps*, 1998.

use super::{End, Path, Place, State};
use super::{Sample, USES};
use crate::integrator::media::Passage;
use crate::world::emitters::LightId;
use crate::world::emitters::emission::Beams;
use crate::world::{Interaction, Shading, World};
use durer_scene::math::{Color, Vec3};
use durer_scene::medium::HenyeyGreenstein;
use durer_scene::sampler::SampleId;
use durer_scene::shape::Surface;
use durer_scene::spectrum::{Lanes, Spectrum};
use glam::DVec3;
use rayon::prelude::*;
use std::collections::VecDeque;
use std::f32::consts::PI;
use std::sync::{Arc, Mutex, PoisonError};

/// How the squares of radii shrink: the share of new photons that is kept. Source: Kaplanyan and
/// Dachsbacher, *Adaptive Progressive Photon Mapping*, 2013: the error falls fastest at 2/3.
const ALPHA: f64 = 2.0 / 3.0;

/// Maps that are kept for when they are wanted again.
const MAX_KEPT: usize = 32;

/// All photons of a picture: a map for each sample of its pixels, made when it is wanted.
#[derive(Debug)]
pub struct Photons {
    beams: Beams,
    seed: u64,
    count: u32,
    /// The first radius.
    radius: f32,
    /// Whether the bias of looking at photons nearby is taken out, to second order.
    corrected: bool,
    kept: Mutex<Kept>,
}

/// Maps and the samples that they are of, the oldest first.
type Kept = VecDeque<(u32, Arc<PhotonMap>)>;

/// A photon where it came to rest.
#[derive(Clone, Copy, Debug)]
struct Photon {
    position: Vec3,
    /// Whence it came: a unit vector.
    wi: Vec3,
    /// Its power; in a medium over how much that scatters.
    power: Spectrum,
    /// How often it was mirrored or refracted.
    bounces: u32,
    rest: Rest,
}

/// In what it came to rest.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Rest {
    Surface,
    /// The medium of an object, by number; `None`: the air's.
    Medium(Option<u32>),
}

/// The photons of one sample.
#[derive(Debug)]
pub struct PhotonMap {
    lanes: Lanes,
    on_surfaces: Cells,
    in_media: Cells,
}

/// What photons nearby tell of the light at a point.
#[derive(Clone, Copy, Debug)]
pub struct Gathered {
    /// The light that is scattered there.
    pub light: Spectrum,
    /// How many photons it is made of.
    pub photons: usize,
    /// How far away they may be.
    pub radius: f32,
}

/// In media, where photons are sparser, a sample looks so many times as far as on surfaces.
const FARTHER: f32 = 3.0;

/// Photons, sorted by the cell that they are in.
#[derive(Debug)]
struct Cells {
    /// How far is looked.
    radius: f32,
    corrected: bool,
    /// Of each photon its cell; in order.
    cells: Vec<u64>,
    photons: Vec<Photon>,
}

impl Photons {
    /// For a world: some photons for each sample. `radius` is how far the first sample looks, in
    /// units of the world; without, it is a share of the smallest thing that throws light.
    pub fn new(world: &World, seed: u64, count: u32, radius: Option<f32>) -> Self {
        let beams = Beams::new(world);
        let usual = 0.05 * beams.finest();
        let radius = radius.unwrap_or(if usual.is_finite() { usual } else { 1.0 });
        Photons { beams, seed, count, radius, corrected: false, kept: Mutex::default() }
    }

    /// The same photons, and light of them without the bias that looking at a whole neighbourhood
    /// has, to second order in the radius; it has more noise. What is without and what is with
    /// it differ by an estimate of the bias.
    pub fn corrected(self) -> Self {
        Photons { corrected: true, ..self }
    }

    /// Whether photons are sent to an object.
    pub(super) fn reaches(&self, object: u32) -> bool {
        self.beams.reaches(object)
    }

    /// How far a sample looks: r_(i+1)^2 = r_i^2 (i + alpha) / (i + 1).
    fn radius(&self, sample: u32) -> f32 {
        let square = (1..=sample).map(f64::from).fold(1.0, |square, i| square * (i + ALPHA) / (i + 1.0));
        self.radius * square.sqrt() as f32
    }

    /// The photons of a sample.
    pub(super) fn map(&self, path: &Path, sample: u32) -> Arc<PhotonMap> {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        // Whoever waits for the lock must not be given work that waits for it too: one thread makes
        // it.
        Self::found(&kept, sample).unwrap_or_else(|| Self::keep(&mut kept, sample, self.make(path, sample, false)))
    }

    /// Makes the photons of a sample in advance, by all threads.
    pub fn prepare(&self, path: &Path, sample: u32) {
        let lock = || self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        if Self::found(&lock(), sample).is_none() {
            let map = self.make(path, sample, true);
            Self::keep(&mut lock(), sample, map);
        }
    }

    fn found(kept: &Kept, sample: u32) -> Option<Arc<PhotonMap>> {
        kept.iter().find(|(number, _)| *number == sample).map(|(_, map)| map.clone())
    }

    fn keep(kept: &mut Kept, sample: u32, map: PhotonMap) -> Arc<PhotonMap> {
        let map = Arc::new(map);
        kept.push_back((sample, map.clone()));
        if kept.len() > MAX_KEPT {
            kept.pop_front();
        }
        map
    }

    fn make(&self, path: &Path, sample: u32, parallel: bool) -> PhotonMap {
        // All photons of a sample have the same wavelengths, and those of its paths.
        let lanes = Lanes::new(path.transport.color, SampleId::new(self.seed, (0, 0), sample).wavelength());
        let one = |number: u32| self.trace(path, sample, number, lanes);
        let found: Vec<Photon> = match parallel {
            true => (0..self.count).into_par_iter().flat_map_iter(one).collect(),
            false => (0..self.count).flat_map(one).collect(),
        };
        let (surfaces, media): (Vec<_>, Vec<_>) = found.into_iter().partition(|photon| photon.rest == Rest::Surface);
        let radius = self.radius(sample);
        PhotonMap {
            lanes,
            on_surfaces: Cells::new(&surfaces, radius, self.corrected),
            in_media: Cells::new(&media, FARTHER * radius, self.corrected),
        }
    }

    /// Sends one photon out, and says where it came to rest.
    fn trace(&self, path: &Path, pass: u32, number: u32, lanes: Lanes) -> Option<Photon> {
        // The photons of a pass fill the lamps and directions evenly.
        let id = SampleId::new(self.seed ^ OTHER_SEED, (pass, 0), number);
        let [choices, place, direction] = [0, 1, 2].map(|dimension| id.pair(dimension));
        let emitted = self.beams.emit(path.world, choices, place, direction)?;
        let power = emitted.power / self.count as f32;
        let sample = Sample { id: id.at(3), lanes, photons: None };
        let mut ray = emitted.ray;
        let mut state = path.start(ray.origin());
        let mut met = Interaction::NOWHERE;
        let mut first = true;
        loop {
            let hit = path.world.closest_along(&mut ray, &mut ());
            let (end, _) = path.fly((&ray, hit), &mut met, &mut state, &sample, &mut ());
            // What fog scatters before anything throws it on, paths look for.
            if let End::Medium(point, dir, _) = end
                && !first
            {
                let object = state.media.object();
                let scattering = path.world.medium(object)?.scattering(point, &lanes);
                let power =
                    Spectrum::select(scattering.cmpgt(Spectrum::ZERO), state.throughput / scattering, Spectrum::ZERO);
                return Photon::new(point.as_vec3(), -dir, power, state.depth, Rest::Medium(object));
            }
            let End::Surface(passage) = end else { return None };
            if first {
                // What photons meet on their way to something else, paths look for.
                if !self.beams.reaches(met.hit.object) {
                    return None;
                }
                // A light with a place is as strong as it is where the photon arrives.
                let color = match emitted.light {
                    Some(light) => {
                        let seen = path.world.illuminate(light as usize, met.surface.point());
                        PI * seen.color * seen.distance * seen.distance
                    }
                    None => Color::ONE,
                };
                let of_light = || emitted.light.and_then(|light| path.world.illuminant(LightId::Light(light)));
                let of_material = || emitted.material.and_then(|material| path.world.own_illuminant(material));
                state.throughput *= lanes.light_of(power * color, || of_light().or_else(of_material));
            }
            let eta = passage.as_ref().map_or(1.0, Passage::eta);
            let shading = path.world.shading(&met, eta, &lanes);
            path.kept(&met, &mut state, &sample);
            // What arrives on black is not seen, but measured.
            if !first && (shading.bsdf.is_broad() || shading.bsdf.is_black()) {
                let wi = -ray.dir().normalize();
                return Photon::new(met.surface.position, wi, state.throughput, state.depth, Rest::Surface);
            }
            let surface = &met.surface;
            let at = Place::Surface(surface, &shading, passage.as_ref());
            let numbers = id.at(3 + state.depth * USES as u32);
            let chosen = at.sample(numbers.pair(0).x, numbers.pair(1))?;
            if chosen.pdf != 0.0 || state.depth > path.settings.bounces {
                return None;
            }
            // Power is not denser where the index is higher, as radiance is.
            let weight = chosen.weight * if at.bends(chosen.lobe) { eta * eta } else { 1.0 };
            let survival = (state.throughput * weight).max_element() / state.throughput.max_element();
            let survival = survival.clamp(0.0, 1.0);
            if numbers.pair(2).x >= survival || survival.is_nan() {
                return None;
            }
            state = State {
                media: at.media(&state, chosen.wi).clone(),
                throughput: state.throughput * weight / survival,
                depth: state.depth + 1,
                alone: state.alone,
                ..State::default()
            };
            ray = at.spawn(chosen.wi);
            first = false;
        }
    }
}

/// Tells photons' random numbers from those of paths.
const OTHER_SEED: u64 = 0x7068_6f74_6f6e_7321;

/// The number of a cell: 21 bits along each axis.
fn cell_of(place: glam::I64Vec3) -> u64 {
    let part = |x: i64| (x as u64) & 0x1f_ffff;
    part(place.x) | part(place.y) << 21 | part(place.z) << 42
}

impl Photon {
    /// `None` if its power is no number.
    fn new(position: Vec3, wi: Vec3, power: Spectrum, bounces: u32, rest: Rest) -> Option<Self> {
        power.is_finite().then_some(Photon { position, wi, power, bounces, rest })
    }
}

impl Cells {
    fn new(photons: &[Photon], radius: f32, corrected: bool) -> Self {
        // Photons of a cell stay in the order in which they were sent, so that sums have the same
        // bits.
        let cell = |photon: &Photon| cell_of(place(photon.position, radius, 0.0));
        let mut order: Vec<(u64, u32)> = (0..).zip(photons).map(|(i, photon)| (cell(photon), i)).collect();
        order.sort_unstable();
        let photons = order.iter().map(|&(_, i)| photons[i as usize]).collect();
        Cells { radius, corrected, cells: order.into_iter().map(|(cell, _)| cell).collect(), photons }
    }

    /// The light of the photons around a point that were mirrored no more often than `most`: each
    /// counts as `value` says, by the way to it and the square of that.
    fn gathered(&self, point: Vec3, most: u32, value: impl Fn(&Photon, Vec3, f32) -> Spectrum) -> Gathered {
        let mut gathered = Gathered { light: Spectrum::ZERO, photons: 0, radius: self.radius };
        // Cells are two radii wide: those half a cell around the point hold all that is within a
        // radius.
        let low = place(point, self.radius, -0.5);
        for corner in 0..8 {
            let cell = cell_of(low + glam::I64Vec3::new(corner & 1, corner >> 1 & 1, corner >> 2));
            let start = self.cells.partition_point(|&other| other < cell);
            for (photon, _) in self.photons[start..].iter().zip(&self.cells[start..]).take_while(|pair| *pair.1 == cell)
            {
                let way = photon.position - point;
                let distance = way.length_squared();
                if distance >= self.radius * self.radius || photon.bounces > most {
                    continue;
                }
                let value = value(photon, way, distance);
                if value != Spectrum::ZERO {
                    gathered.photons += 1;
                    gathered.light += value;
                }
            }
        }
        gathered
    }

    /// How much a photon counts, by the squares of its distance and of how far it lies beside the
    /// surface; nothing if it is on another one.
    ///
    /// The mean of light over a kernel of radius r is off by r^2 times something, to second order:
    /// half as much with a kernel of half the square. Twice that one less the whole one is
    /// corrected (Richardson's extrapolation).
    fn kernel(&self, distance: f32, beside: f32, kernel: fn(f32, f32) -> f32) -> f32 {
        let square = self.radius * self.radius;
        if beside > FLATNESS * square {
            return 0.0;
        }
        let (whole, half) = (kernel(square, distance), 0.5 * square);
        match self.corrected {
            false => whole,
            true if distance < half && beside <= FLATNESS * half => 2.0 * kernel(half, distance) - whole,
            true => -whole,
        }
    }
}

impl PhotonMap {
    /// What its light is made of.
    pub fn lanes(&self) -> &Lanes {
        &self.lanes
    }

    /// The light that a surface scatters of the photons nearby. Photons that were mirrored more
    /// often than `most` do not count.
    pub fn on_surface(&self, surface: &Surface, shading: &Shading, most: u32) -> Gathered {
        let cells = &self.on_surfaces;
        cells.gathered(surface.position, most, |photon, way, distance| {
            let beside = way.dot(surface.n_geo);
            let kernel = cells.kernel(distance, beside * beside, disc);
            let cosine = shading.frame.normal.dot(photon.wi).abs();
            if kernel == 0.0 || cosine <= 1e-4 {
                return Spectrum::ZERO;
            }
            let (value, _) = shading.eval(photon.wi);
            value * photon.power * (kernel / cosine)
        })
    }

    /// The same at a point of the medium of an object (`None`: of the air), along a unit direction.
    pub fn in_medium(
        &self,
        (point, dir): (Vec3, Vec3),
        object: Option<u32>,
        phase: &HenyeyGreenstein,
        most: u32,
    ) -> Gathered {
        let cells = &self.in_media;
        cells.gathered(point, most, |photon, _, distance| match photon.rest == Rest::Medium(object) {
            true => photon.power * (phase.value(dir, photon.wi) * cells.kernel(distance, 0.0, ball)),
            false => Spectrum::ZERO,
        })
    }
}

/// What lies further beside a surface than this share of the squared radius, squared, is on another
/// surface.
const FLATNESS: f32 = 0.1;

/// Epanechnikov's kernel in the plane, by the squares of radius and distance.
fn disc(square: f32, distance: f32) -> f32 {
    2.0 / (PI * square) * (1.0 - distance / square)
}

/// The same in space.
fn ball(square: f32, distance: f32) -> f32 {
    15.0 / (8.0 * PI * square * square.sqrt()) * (1.0 - distance / square)
}

fn place(point: Vec3, radius: f32, shift: f64) -> glam::I64Vec3 {
    (point.as_dvec3() / (2.0 * f64::from(radius)) + DVec3::splat(shift)).floor().as_i64vec3()
}
