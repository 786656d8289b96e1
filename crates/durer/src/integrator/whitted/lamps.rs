//! What lamps bring to hits that are asked about together: worked out for eight of them at once, by
//! the formulas that hold for one.

use super::direct::{blinn, scattered};
use super::{Side, Whitted};
use crate::bvh::internal::{PlainKernel, run_plain};
use crate::integrator::trace::TraceListener;
use crate::light::{Emitter as _, Illumination, Light};
use crate::math::{self, Color, Ray, Ray64, Vec3, reflect};
use crate::shape::Surface;
use crate::world::{HighlightModel, Interaction, Phong, TOGETHER};

/// Vectors side by side: x of all, then y, then z.
type Vectors = [[f32; TOGETHER]; 3];

/// Hits that wait for the light of lamps, and what is worked out for one lamp.
#[derive(Default)]
pub(super) struct LampHits {
    hits: Vec<Hit>,
    places: Box<Places>,
    seen: Box<Seen>,
    /// The light that hits scatter of a lamp if nothing is in the way, with the rays that ask.
    lights: Vec<(usize, Color)>,
    shadows: Vec<Ray64>,
}

/// What is not computed with side by side.
struct Hit {
    /// The number of the ray that hit.
    ray: usize,
    solid: Option<u32>,
    diffuse: Color,
    highlight: Option<(Color, f32, HighlightModel)>,
}

/// Where hits are, and how they are seen.
struct Places {
    position: Vectors,
    rest: Vectors,
    error: Vectors,
    n_geo: Vectors,
    n_shade: Vectors,
    shadow_offsets: [Vectors; 2],
    /// The normal that light is reckoned with.
    n: Vectors,
    view: Vectors,
}

/// A lamp as it is seen from hits.
struct Seen {
    to_light: Vectors,
    distance: [f32; TOGETHER],
    color: Vectors,
    cosine: [f32; TOGETHER],
    /// See [`blinn`].
    blinn: [f32; TOGETHER],
    /// The rays that ask what is in the way.
    origin: Vectors,
    rest: Vectors,
    t_min: [f32; TOGETHER],
    t_max: [f32; TOGETHER],
}

const NONE: Vectors = [[0.0; TOGETHER]; 3];

impl Default for Places {
    fn default() -> Self {
        Places {
            position: NONE,
            rest: NONE,
            error: NONE,
            n_geo: NONE,
            n_shade: NONE,
            shadow_offsets: [NONE; 2],
            n: NONE,
            view: NONE,
        }
    }
}

impl Default for Seen {
    fn default() -> Self {
        let none = [0.0; TOGETHER];
        Seen {
            to_light: NONE,
            distance: none,
            color: NONE,
            cosine: none,
            blinn: none,
            origin: NONE,
            rest: NONE,
            t_min: none,
            t_max: none,
        }
    }
}

#[inline(always)]
fn get([x, y, z]: &Vectors, i: usize) -> Vec3 {
    Vec3::new(x[i], y[i], z[i])
}

#[inline(always)]
fn set([x, y, z]: &mut Vectors, i: usize, v: Vec3) {
    (x[i], y[i], z[i]) = (v.x, v.y, v.z);
}

impl Places {
    /// The surface at a hit, as far as shadow rays ask.
    #[inline(always)]
    fn surface(&self, i: usize, solid: Option<u32>) -> Surface {
        Surface {
            position: get(&self.position, i),
            rest: get(&self.rest, i),
            error: get(&self.error, i),
            n_geo: get(&self.n_geo, i),
            n_shade: get(&self.n_shade, i),
            shadow_offsets: [get(&self.shadow_offsets[0], i), get(&self.shadow_offsets[1], i)],
            solid,
            ..Surface::NOWHERE
        }
    }
}

impl Seen {
    #[inline(always)]
    fn set(&mut self, i: usize, seen: Illumination) {
        set(&mut self.to_light, i, seen.to_light);
        self.distance[i] = seen.distance;
        set(&mut self.color, i, seen.color);
    }

    #[inline(always)]
    fn get(&self, i: usize) -> Illumination {
        Illumination { to_light: get(&self.to_light, i), distance: self.distance[i], color: get(&self.color, i) }
    }
}

impl LampHits {
    pub(super) fn clear(&mut self) {
        self.hits.clear();
    }
}

impl Whitted<'_> {
    /// Ambient light at a hit, which is added to those that wait for lamps.
    #[inline(always)]
    pub(super) fn unlit(&self, at: &Interaction, phong: &Phong, ray: usize, lit: &mut LampHits) -> Color {
        let Side { n, black, .. } = self.side(at);
        if black {
            return Color::ZERO;
        }
        let LampHits { hits, places, .. } = lit;
        assert!(hits.len() < TOGETHER);
        let (i, surface, diffuse) = (hits.len(), &at.surface, self.world.diffuse_color(phong, &at.surface));
        set(&mut places.position, i, surface.position);
        set(&mut places.rest, i, surface.rest);
        set(&mut places.error, i, surface.error);
        set(&mut places.n_geo, i, surface.n_geo);
        set(&mut places.n_shade, i, surface.n_shade);
        set(&mut places.shadow_offsets[0], i, surface.shadow_offsets[0]);
        set(&mut places.shadow_offsets[1], i, surface.shadow_offsets[1]);
        set(&mut places.n, i, n);
        set(&mut places.view, i, at.ray.dir());
        hits.push(Hit { ray, solid: surface.solid, diffuse, highlight: phong.highlight });
        self.world.ambient() * phong.ambient.unwrap_or(diffuse)
    }

    /// Adds to the light along rays what arrives of a lamp at all hits that wait.
    pub(super) fn add_lamp<T: TraceListener>(
        &self,
        lamp: usize,
        lit: &mut LampHits,
        colors: &mut [Color],
        tally: &mut T,
    ) {
        let LampHits { hits, places, seen, lights, shadows } = lit;
        run_plain(LampKernel { whitted: self, lamp, places, seen, count: hits.len() });
        lights.clear();
        shadows.clear();
        for (i, &Hit { ray, solid, diffuse, highlight }) in (0..TOGETHER).zip(hits.iter()) {
            let to_light = get(&seen.to_light, i);
            let base = |model| match model {
                HighlightModel::Blinn => seen.blinn[i],
                HighlightModel::Phong { .. } => reflect(get(&places.view, i), get(&places.n, i)).dot(to_light),
            };
            let light = scattered(highlight, diffuse, seen.cosine[i], base, tally) * get(&seen.color, i);
            if light == Color::ZERO {
                continue;
            }
            tally.ray();
            lights.push((ray, light));
            shadows.push(match solid {
                None => Ray64 {
                    rounded: Ray {
                        origin: get(&seen.origin, i),
                        dir: to_light,
                        t_min: seen.t_min[i],
                        t_max: seen.t_max[i],
                    },
                    rest: get(&seen.rest, i),
                    side: math::Side::ANY,
                },
                Some(_) => self.shadow_ray(&places.surface(i, solid), &seen.get(i)),
            });
        }
        if self.settings.transparent_shadows {
            let mut found = [None; TOGETHER];
            self.world.closest_together(shadows, &mut found[..shadows.len()]);
            for ((&(ray, light), shadow), hit) in lights.iter().zip(shadows).zip(found) {
                let share = hit.map_or(Color::ONE, |_| self.let_through(*shadow, hit, shadow.dir(), tally));
                colors[ray] += if share == Color::ZERO { Color::ZERO } else { share * light };
            }
        } else {
            let mut blocked = [false; TOGETHER];
            self.world.occluded_together(shadows, &mut blocked[..shadows.len()]);
            for (&(ray, light), blocked) in lights.iter().zip(blocked) {
                colors[ray] += if blocked { Color::ZERO } else { light };
            }
        }
    }
}

/// How hits see a lamp, with the rays that ask what is in the way.
struct LampKernel<'a> {
    whitted: &'a Whitted<'a>,
    lamp: usize,
    places: &'a Places,
    seen: &'a mut Seen,
    count: usize,
}

impl PlainKernel for LampKernel<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let LampKernel { whitted, lamp, places, seen, count } = self;
        let world = whitted.world;
        // Behind the last hit there are others that were there before.
        let count = count.next_multiple_of(8).min(TOGETHER);
        match &world.lights()[lamp] {
            Light::Point(point) if matches!(world.profiles().get(lamp), None | Some(None)) => {
                (0..count).for_each(|i| seen.set(i, point.illuminate(places.surface(i, None).point())));
            }
            _ => (0..count).for_each(|i| seen.set(i, world.illuminate(lamp, places.surface(i, None).point()))),
        }
        for i in 0..count {
            let (surface, n) = (places.surface(i, None), get(&places.n, i));
            let from_here = seen.get(i);
            seen.cosine[i] = n.dot(from_here.to_light);
            seen.blinn[i] = blinn(n, get(&places.view, i), from_here.to_light);
            let shadow = whitted.shadow_ray(&surface, &from_here);
            set(&mut seen.origin, i, shadow.rounded.origin);
            set(&mut seen.rest, i, shadow.rest);
            (seen.t_min[i], seen.t_max[i]) = (shadow.rounded.t_min, shadow.rounded.t_max);
        }
    }
}
