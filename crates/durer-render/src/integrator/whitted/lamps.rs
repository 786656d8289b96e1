//! What lamps bring to hits that are asked about together: worked out for several at once, by the
//! formulas that hold for one.

use super::direct::{blinn, scattered, sum};
use super::{Facing, Side, Whitted};
use crate::integrator::trace::{NodeId, TraceListener};
use crate::world::{HighlightModel, Met, Numbers, PLACES, Phong, Surfaces, TOGETHER, Vectors};
use durer_bvh::internal::{PlainKernel, run_plain};
use durer_scene::light::{Emitter as _, Illumination, Light};
use durer_scene::math::{self, Color, Ray, Ray64, Vec3, fp, reflect};

/// Hits that wait for the light of lamps, and what is worked out for one lamp.
pub(super) struct LampHits {
    hits: Vec<Met>,
    /// Whether some have highlights.
    shines: bool,
    sides: Box<Sides>,
    seen: Box<Seen>,
    /// The light that hits scatter of a lamp if nothing is in the way, with the rays that ask.
    lights: [(u32, Color); TOGETHER],
    shadows: [Ray64; TOGETHER],
}

impl Default for LampHits {
    fn default() -> Self {
        LampHits {
            hits: Vec::new(),
            shines: false,
            sides: Box::default(),
            seen: Box::default(),
            lights: [(0, Color::ZERO); TOGETHER],
            shadows: [Ray64::from(Ray::new(Vec3::ZERO, Vec3::X)); TOGETHER],
        }
    }
}

/// The sides of surfaces that are shaded, and how they scatter light.
struct Sides {
    /// The normal that light is reckoned with.
    n: Vectors,
    /// 1 where it is, else 0.
    from_behind: Numbers,
    black: Numbers,
    diffuse: Vectors,
    specular: Vectors,
    exponent: Numbers,
    /// [`DULL`], [`BLINN`], [`PHONG`] or [`PHONG_BEHIND`].
    highlight: Numbers,
}

const DULL: f32 = 0.0;
const BLINN: f32 = 1.0;
// These are worked out one by one.
const PHONG: f32 = 2.0;
const PHONG_BEHIND: f32 = 3.0;

/// A lamp as it is seen from hits.
struct Seen {
    to_light: Vectors,
    distance: Numbers,
    color: Vectors,
    cosine: Numbers,
    /// Of Blinn's highlight.
    strength: Numbers,
    /// What is scattered of it, if nothing is in the way; 1 where that is known, else 0.
    light: Vectors,
    is_known: Numbers,
    /// The rays that ask what is in the way.
    origin: Vectors,
    rest: Vectors,
    t_min: Numbers,
    t_max: Numbers,
}

impl Default for Sides {
    fn default() -> Self {
        let none = [0.0; PLACES];
        Sides {
            n: Vectors::ZERO,
            from_behind: none,
            black: none,
            diffuse: Vectors::ZERO,
            specular: Vectors::ZERO,
            exponent: none,
            highlight: none,
        }
    }
}

impl Default for Seen {
    fn default() -> Self {
        let none = [0.0; PLACES];
        Seen {
            to_light: Vectors::ZERO,
            distance: none,
            color: Vectors::ZERO,
            cosine: none,
            strength: none,
            light: Vectors::ZERO,
            is_known: none,
            origin: Vectors::ZERO,
            rest: Vectors::ZERO,
            t_min: none,
            t_max: none,
        }
    }
}

impl Seen {
    #[inline(always)]
    fn set(&mut self, i: usize, seen: Illumination) {
        self.to_light.set(i, seen.to_light);
        self.distance[i] = seen.distance;
        self.color.set(i, seen.color);
    }

    #[inline(always)]
    fn get(&self, i: usize) -> Illumination {
        Illumination { to_light: self.to_light.get(i), distance: self.distance[i], color: self.color.get(i) }
    }
}

impl LampHits {
    /// Whether a surface is seen from behind.
    #[inline(always)]
    pub(super) fn sees_back(&self, place: usize) -> bool {
        self.sides.from_behind[place] > 0.0
    }
}

impl Whitted<'_> {
    /// Finds which sides of surfaces are shaded, none of which waits for lamps yet.
    pub(super) fn find_sides(&self, surfaces: &Surfaces, lit: &mut LampHits) {
        lit.hits.clear();
        lit.shines = false;
        run_plain(SideKernel { facing: self.facing(), surfaces, sides: &mut lit.sides });
    }

    /// Ambient light at a hit, which is added to those that wait for lamps.
    #[inline(always)]
    pub(super) fn unlit(&self, met: Met, diffuse: Color, phong: &Phong, lit: &mut LampHits) -> Color {
        let (place, LampHits { hits, shines, sides, .. }) = (met.place(), lit);
        if sides.black[place] > 0.0 {
            return Color::ZERO;
        }
        sides.diffuse.set(place, diffuse);
        sides.highlight[place] = DULL;
        if let Some((specular, exponent, model)) = phong.highlight {
            sides.specular.set(place, specular);
            sides.exponent[place] = exponent;
            sides.highlight[place] = match model {
                HighlightModel::Blinn => BLINN,
                HighlightModel::Phong { behind: false } => PHONG,
                HighlightModel::Phong { behind: true } => PHONG_BEHIND,
            };
            *shines = true;
        }
        hits.push(met);
        self.world.ambient() * phong.ambient.unwrap_or(diffuse)
    }

    /// Adds to the light along rays what arrives of a lamp at all hits that wait.
    pub(super) fn add_lamp<T: TraceListener>(
        &self,
        lamp: usize,
        surfaces: &Surfaces,
        lit: &mut LampHits,
        colors: &mut [Color],
        tally: &mut T,
    ) {
        let LampHits { hits, shines, sides, seen, lights, shadows } = lit;
        run_plain(LampKernel { whitted: self, lamp, surfaces, sides, seen, shines: *shines });
        let mut asked = 0;
        for &met in hits.iter() {
            let place = met.place();
            let light = match seen.is_known[place] > 0.0 {
                true => seen.light.get(place),
                false => self.scattered_at(place, surfaces, sides, seen, tally),
            };
            if light == Color::ZERO {
                continue;
            }
            tally.ray();
            lights[asked] = (met.ray() as u32, light);
            let shadow = &mut shadows[asked];
            asked += 1;
            // Each is written to its place at once: what goes round by another would be waited for.
            if let solid @ Some(_) = surfaces.solid(place) {
                *shadow = self.shadow_ray(&surfaces.get(place, solid), &seen.get(place));
                continue;
            }
            let (t_min, t_max) = (seen.t_min[place], seen.t_max[place]);
            let rounded = Ray { origin: seen.origin.get(place), dir: seen.to_light.get(place), t_min, t_max };
            *shadow = Ray64 { rounded, rest: seen.rest.get(place), side: math::Side::ANY };
        }
        let (lights, shadows) = (&lights[..asked], &shadows[..asked]);
        if self.settings.transparent_shadows {
            let mut found = [None; TOGETHER];
            self.world.closest_together(shadows, &mut found[..asked]);
            for ((&(ray, light), shadow), hit) in lights.iter().zip(shadows).zip(found) {
                let share = hit.map_or(Color::ONE, |_| self.let_through(*shadow, hit, shadow.dir(), tally));
                colors[ray as usize] += if share == Color::ZERO { Color::ZERO } else { share * light };
            }
        } else {
            let mut blocked = [false; TOGETHER];
            self.world.occluded_together(shadows, &mut blocked[..asked]);
            for (&(ray, light), blocked) in lights.iter().zip(blocked) {
                colors[ray as usize] += if blocked { Color::ZERO } else { light };
            }
        }
    }

    /// What a hit scatters of a lamp, worked out alone.
    fn scattered_at<T: TraceListener>(
        &self,
        place: usize,
        surfaces: &Surfaces,
        sides: &Sides,
        seen: &Seen,
        tally: &mut T,
    ) -> Color {
        let (n, view, to_light) = (sides.n.get(place), surfaces.view.get(place), seen.to_light.get(place));
        let model = match sides.highlight[place] {
            DULL | BLINN => HighlightModel::Blinn,
            kind => HighlightModel::Phong { behind: kind == PHONG_BEHIND },
        };
        let shines = sides.highlight[place] != DULL;
        let highlight = shines.then(|| (sides.specular.get(place), sides.exponent[place], model));
        let base = |model| match model {
            HighlightModel::Blinn => blinn(n, view, to_light),
            HighlightModel::Phong { .. } => reflect(view, n).dot(to_light),
        };
        scattered(highlight, sides.diffuse.get(place), seen.cosine[place], base, NodeId::NONE, tally)
            * seen.color.get(place)
    }
}

/// Which sides of surfaces are shaded.
struct SideKernel<'a> {
    facing: Facing,
    surfaces: &'a Surfaces,
    sides: &'a mut Sides,
}

impl PlainKernel for SideKernel<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let SideKernel { facing, surfaces, sides } = self;
        for i in 0..surfaces.end() {
            let normals = [surfaces.n_shade.get(i), surfaces.n_geo.get(i)];
            let Side { n, from_behind, black } = facing.side(surfaces.view.get(i), normals);
            sides.n.set(i, n);
            sides.from_behind[i] = f32::from(u8::from(from_behind));
            sides.black[i] = f32::from(u8::from(black));
        }
    }
}

/// How hits see a lamp, with the rays that ask what is in the way.
struct LampKernel<'a> {
    whitted: &'a Whitted<'a>,
    lamp: usize,
    surfaces: &'a Surfaces,
    sides: &'a Sides,
    seen: &'a mut Seen,
    /// Whether some hit has a highlight.
    shines: bool,
}

impl PlainKernel for LampKernel<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let LampKernel { whitted, lamp, surfaces, sides, seen, shines } = self;
        let world = whitted.world;
        // Between hits of different kinds there are others that were there before.
        let places = 0..surfaces.end();
        match &world.lights()[lamp] {
            Light::Point(point) if matches!(world.profiles().get(lamp), None | Some(None)) => {
                places.clone().for_each(|i| seen.set(i, point.illuminate(surfaces.get(i, None).point())));
            }
            _ => places.clone().for_each(|i| seen.set(i, world.illuminate(lamp, surfaces.get(i, None).point()))),
        }
        for i in places.clone() {
            let from_here = seen.get(i);
            seen.cosine[i] = sides.n.get(i).dot(from_here.to_light);
            let shadow = whitted.shadow_ray(&surfaces.get(i, None), &from_here);
            seen.origin.set(i, shadow.rounded.origin);
            seen.rest.set(i, shadow.rest);
            (seen.t_min[i], seen.t_max[i]) = (shadow.rounded.t_min, shadow.rounded.t_max);
        }
        if shines {
            for i in places.clone() {
                let base = blinn(sides.n.get(i), surfaces.view.get(i), seen.to_light.get(i));
                seen.strength[i] = fp::usual_pow(base.max(0.0), sides.exponent[i]);
            }
        }
        for i in places {
            let (cosine, strength) = (seen.cosine[i], seen.strength[i]);
            let shines = sides.highlight[i] == BLINN && cosine > 0.0;
            let light = sum(cosine, sides.diffuse.get(i), shines, strength, sides.specular.get(i));
            seen.light.set(i, light * seen.color.get(i));
            let unknown = sides.highlight[i] >= PHONG || shines && strength.is_nan();
            seen.is_known[i] = if unknown { 0.0 } else { 1.0 };
        }
    }
}
