//! Simple shapes, of which eight are tested at once.
//!
//! For scenes of a few things, where a tree would cost more than it saves, and for planes, which
//! have no box. What is computed is what a test of one thing alone computes, in double precision
//! and in the same order, so hits have the same bits.

use super::TraversalCounter;
use super::lanes::{Available, Kernel, Lanes, WIDTH, numbers_of};
use crate::math::{Doubles, Ray, Triple, Vec3};
use glam::DVec3;

/// Planes, spheres, discs, rectangles and boxes under the caller's numbers.
#[derive(Clone, Debug)]
pub struct PrimitivePacks {
    planes: Vec<Pack<PLANE>>,
    spheres: Vec<Pack<SPHERE>>,
    discs: Vec<Pack<DISC>>,
    rectangles: Vec<Pack<RECTANGLE>>,
    boxes: Vec<Pack<BOX>>,
    /// How many there are of all.
    count: usize,
    level: Available,
}

/// Where a ray meets one of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PackHit {
    /// Position along the ray.
    pub t: f32,
    /// Its number.
    pub number: u32,
}

/// Eight things of a kind, each of which is given by so many numbers. Those of a lane without a
/// thing are no numbers, so that nothing is met there.
#[derive(Clone, Copy, Debug)]
struct Pack<const N: usize> {
    of: [[f64; WIDTH]; N],
    numbers: [u32; WIDTH],
}

impl<const N: usize> Pack<N> {
    /// The lanes that have a thing.
    #[inline(always)]
    fn things(&self) -> std::ops::Range<usize> {
        let mut end = WIDTH;
        while end > 0 && self.numbers[end - 1] == u32::MAX {
            end -= 1;
        }
        0..end
    }

    /// A thing in each lane.
    #[inline(always)]
    fn eight<L: Lanes>(&self, lanes: L) -> [L::Doubles; N] {
        let mut of = [lanes.splat_double(0.0); N];
        for (to, from) in of.iter_mut().zip(&self.of) {
            *to = lanes.load_doubles(from);
        }
        of
    }

    /// One thing in all lanes.
    #[inline(always)]
    fn one<L: Lanes>(&self, lanes: L, thing: usize) -> [L::Doubles; N] {
        let mut of = [lanes.splat_double(0.0); N];
        for (to, from) in of.iter_mut().zip(&self.of) {
            *to = lanes.splat_double(from[thing]);
        }
        of
    }
}

impl Default for PrimitivePacks {
    fn default() -> Self {
        PrimitivePacks {
            planes: Vec::new(),
            spheres: Vec::new(),
            discs: Vec::new(),
            rectangles: Vec::new(),
            boxes: Vec::new(),
            count: 0,
            level: Available::chosen(),
        }
    }
}

impl PrimitivePacks {
    /// Adds the plane normal · p = offset.
    pub fn push_plane(&mut self, number: u32, normal: Vec3, offset: f32) {
        let n = normal.as_dvec3();
        push(&mut self.planes, number, [n.x, n.y, n.z, f64::from(offset)]);
        self.count += 1;
    }

    /// Adds the sphere |p - center| = radius.
    pub fn push_sphere(&mut self, number: u32, center: Vec3, radius: f32) {
        let c = center.as_dvec3();
        push(&mut self.spheres, number, [c.x, c.y, c.z, f64::from(radius) * f64::from(radius)]);
        self.count += 1;
    }

    /// Adds the disc around a centre, across a unit normal, from an inner radius to an outer one.
    pub fn push_disc(&mut self, number: u32, center: Vec3, normal: DVec3, [inner, outer]: [f32; 2]) {
        let (c, n) = (center.as_dvec3(), normal);
        push(&mut self.discs, number, [n.x, n.y, n.z, c.x, c.y, c.z, f64::from(inner), f64::from(outer)]);
        self.count += 1;
    }

    /// Adds the parallelogram of a corner and two edges.
    pub fn push_rectangle(&mut self, number: u32, corner: Vec3, edges: [Vec3; 2]) {
        let (c, [e, f]) = (corner.as_dvec3(), edges.map(|edge| edge.as_dvec3()));
        let n = e.cross(f);
        let of = [c.x, c.y, c.z, e.x, e.y, e.z, f.x, f.y, f.z, n.x, n.y, n.z, n.length_squared()];
        push(&mut self.rectangles, number, of);
        self.count += 1;
    }

    /// Adds the box between two corners.
    pub fn push_box(&mut self, number: u32, min: Vec3, max: Vec3) {
        let (min, max) = (min.as_dvec3(), max.as_dvec3());
        push(&mut self.boxes, number, [min.x, min.y, min.z, max.x, max.y, max.z]);
        self.count += 1;
    }

    /// How many things there are.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// The first hit in the ray's interval; of several at the same `t` that of the least number.
    /// The ray must be finite, and have a direction.
    #[inline]
    pub fn closest<T: TraversalCounter>(&self, ray: &Ray, counter: &mut T) -> Option<PackHit> {
        if self.is_empty() {
            return None;
        }
        counter.work(0, self.count as u64);
        let found = self.level.run(Query::<false> { packs: self, ray });
        (found.number != u32::MAX).then_some(found)
    }

    /// The first hits of eight rays, as [`PrimitivePacks::closest`] has them one by one: the rays
    /// are side by side, and things are tested one after the other. So it pays where there are few.
    /// Rays that are not finite, or have no direction, meet nothing.
    pub fn closest_of_eight(&self, rays: [&Ray; WIDTH]) -> [Option<PackHit>; WIDTH] {
        let found = self.level.run(Together { packs: self, rays });
        found.map(|hit| (hit.number != u32::MAX).then_some(hit))
    }

    /// Whether there is a hit in the ray's interval. The ray must be finite, and have a direction.
    #[inline]
    pub fn occluded<T: TraversalCounter>(&self, ray: &Ray, counter: &mut T) -> bool {
        if self.is_empty() {
            return false;
        }
        counter.work(0, self.count as u64);
        self.level.run(Query::<true> { packs: self, ray }).number != u32::MAX
    }
}

/// Adds a thing in the first lane that is free.
fn push<const N: usize>(packs: &mut Vec<Pack<N>>, number: u32, of: [f64; N]) {
    let nothing = Pack { of: [[f64::NAN; WIDTH]; N], numbers: [u32::MAX; WIDTH] };
    let mut pack = packs.pop_if(|pack| pack.things().end < WIDTH).unwrap_or(nothing);
    let lane = pack.things().end;
    pack.numbers[lane] = number;
    (0..N).for_each(|i| pack.of[i][lane] = of[i]);
    packs.push(pack);
}

/// Rays side by side.
struct Rays<L: Lanes> {
    origin: [L::Doubles; 3],
    dir: [L::Doubles; 3],
    t_min: L::Floats,
    t_max: L::Floats,
}

impl<L: Lanes> Rays<L> {
    /// The lanes in which a place lies in the interval.
    #[inline(always)]
    fn contain(&self, lanes: L, t: L::Floats) -> u32 {
        lanes.lt(self.t_min, t) & lanes.lt(t, self.t_max)
    }

    #[inline(always)]
    fn at(&self, t: L::Doubles) -> [L::Doubles; 3] {
        self.origin.add([t; 3].mul(self.dir))
    }
}

/// Things of a kind that are given by `N` numbers.
trait Form<const N: usize> {
    /// Where rays first meet things in their interval: a bit for each lane, and the place.
    fn meet<L: Lanes>(lanes: L, rays: &Rays<L>, of: &[L::Doubles; N]) -> (u32, L::Floats);
}

/// normal · p = offset.
struct Planes;
const PLANE: usize = 4;

impl Form<PLANE> for Planes {
    #[inline(always)]
    fn meet<L: Lanes>(lanes: L, rays: &Rays<L>, &[x, y, z, offset]: &[L::Doubles; PLANE]) -> (u32, L::Floats) {
        let normal = [x, y, z];
        // A parallel ray divides by zero, and hits nothing.
        let t = lanes.singles(offset.sub(normal.dot(rays.origin)).div(normal.dot(rays.dir)));
        (rays.contain(lanes, t), t)
    }
}

/// |p - center|^2 = square.
struct Spheres;
const SPHERE: usize = 4;

impl Form<SPHERE> for Spheres {
    #[inline(always)]
    fn meet<L: Lanes>(lanes: L, rays: &Rays<L>, &[x, y, z, square]: &[L::Doubles; SPHERE]) -> (u32, L::Floats) {
        // The discriminant is taken from the point of the ray nearest to the centre, which keeps
        // small, far spheres exact. Source: Haines, Günther, Akenine-Möller, *Ray Tracing Gems*
        // (2019), chapter 7.
        let o = rays.origin.sub([x, y, z]);
        let (dd, b) = (rays.dir.dot(rays.dir), o.dot(rays.dir).mul(lanes.splat_double(-1.0)));
        let along = b.div(dd);
        let near = o.add([along; 3].mul(rays.dir));
        let discriminant = square.sub(near.dot(near));
        // Where a sphere is missed, it is negative or no number, and so are the roots.
        if lanes.le(lanes.splat(0.0), lanes.singles(discriminant)) == 0 {
            return (0, lanes.splat(0.0));
        }
        // q has the sign of b, so that neither root loses digits to cancellation.
        let c = o.dot(o).sub(square);
        let q = b.add(dd.mul(discriminant).sqrt().copysign(b));
        let (t0, t1) = (c.div(q), q.div(dd));
        first(lanes, rays, [t0.min(t1), t1.max(t0)])
    }
}

/// normal · (p - center) = 0, as far from the centre as the radii say.
struct Discs;
const DISC: usize = 8;

impl Form<DISC> for Discs {
    #[inline(always)]
    fn meet<L: Lanes>(lanes: L, rays: &Rays<L>, of: &[L::Doubles; DISC]) -> (u32, L::Floats) {
        let &[nx, ny, nz, x, y, z, inner, outer] = of;
        let (normal, center) = ([nx, ny, nz], [x, y, z]);
        let t = normal.dot(center.sub(rays.origin)).div(normal.dot(rays.dir));
        let (way, found) = (rays.at(t).sub(center), lanes.singles(t));
        let distance = way.dot(way).sqrt();
        let on = lanes.le_doubles(inner, distance) & lanes.le_doubles(distance, outer);
        (rays.contain(lanes, found) & on, found)
    }
}

/// corner + u e + v f, u and v from 0 to 1.
struct Rectangles;
const RECTANGLE: usize = 13;

impl Form<RECTANGLE> for Rectangles {
    #[inline(always)]
    fn meet<L: Lanes>(lanes: L, rays: &Rays<L>, of: &[L::Doubles; RECTANGLE]) -> (u32, L::Floats) {
        let &[x, y, z, ex, ey, ez, fx, fy, fz, nx, ny, nz, square] = of;
        let (corner, e, f, n) = ([x, y, z], [ex, ey, ez], [fx, fy, fz], [nx, ny, nz]);
        let t = n.dot(corner.sub(rays.origin)).div(n.dot(rays.dir));
        let found = lanes.singles(t);
        let met = rays.contain(lanes, found);
        // Most rays do not meet the plane in their interval.
        if met == 0 {
            return (0, found);
        }
        // Cramer's rule.
        let q = rays.at(t).sub(corner);
        let (u, v) = (q.cross(f).dot(n).div(square), e.cross(q).dot(n).div(square));
        let (zero, one) = (lanes.splat_double(0.0), lanes.splat_double(1.0));
        let on = lanes.le_doubles(zero, u) & lanes.le_doubles(u, one);
        (met & on & lanes.le_doubles(zero, v) & lanes.le_doubles(v, one), found)
    }
}

/// What lies between two corners: three slabs cut the ray. Source: Kay and Kajiya, *Ray Tracing
/// Complex Scenes*, SIGGRAPH 1986.
struct Boxes;
const BOX: usize = 6;

impl Form<BOX> for Boxes {
    #[inline(always)]
    fn meet<L: Lanes>(lanes: L, rays: &Rays<L>, of: &[L::Doubles; BOX]) -> (u32, L::Floats) {
        let infinity = lanes.splat_double(f64::INFINITY);
        let (mut enter, mut leave) = (lanes.splat_double(f64::NEG_INFINITY), infinity);
        for axis in 0..3 {
            // Of a ray along the slab both ends are infinite: on different sides inside, on the
            // same outside, and none on a face, for no zero here is negative.
            let (o, d) = (rays.origin[axis], rays.dir[axis].add(lanes.splat_double(0.0)));
            let (a, b) = (of[axis].sub(o).div(d), of[axis + 3].sub(o).div(d));
            // Of what is no number the other end is left, or none.
            enter = b.min(a).max(enter);
            leave = a.max(b).min(leave);
        }
        let inside = !lanes.le_doubles(leave, enter);
        let (met, t) = first(lanes, rays, [enter, leave]);
        (met & inside, t)
    }
}

/// The first of two places that lies in the interval.
#[inline(always)]
fn first<L: Lanes>(lanes: L, rays: &Rays<L>, [near, far]: [L::Doubles; 2]) -> (u32, L::Floats) {
    let (near, far) = (lanes.singles(near), lanes.singles(far));
    let in_near = rays.contain(lanes, near);
    (in_near | rays.contain(lanes, far), lanes.select(in_near, near, far))
}

/// One ray's way through all packs; `ANY`: the first thing found will do.
struct Query<'a, const ANY: bool> {
    packs: &'a PrimitivePacks,
    ray: &'a Ray,
}

impl<const ANY: bool> Query<'_, ANY> {
    /// Its way through packs of one kind; whether something was found that will do.
    #[inline(always)]
    fn among<L: Lanes, F: Form<N>, const N: usize>(
        lanes: L,
        ray: &Rays<L>,
        packs: &[Pack<N>],
        best: &mut PackHit,
    ) -> bool {
        for pack in packs {
            let (met, t) = F::meet(lanes, ray, &pack.eight(lanes));
            if ANY && met != 0 {
                best.number = 0;
                return true;
            }
            *best = nearest(lanes.store(t), met, &pack.numbers, *best);
        }
        false
    }
}

impl<const ANY: bool> Kernel for Query<'_, ANY> {
    type Output = PackHit;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> PackHit {
        let Query { packs, ray } = self;
        let mut best = PackHit { t: ray.t_max, number: u32::MAX };
        let rays = Rays {
            origin: lanes.doubles3(lanes.splat3(ray.origin.to_array())),
            dir: lanes.doubles3(lanes.splat3(ray.dir.to_array())),
            t_min: lanes.splat(ray.t_min),
            t_max: lanes.splat(ray.t_max),
        };
        let _found = Self::among::<_, Planes, _>(lanes, &rays, &packs.planes, &mut best)
            || Self::among::<_, Rectangles, _>(lanes, &rays, &packs.rectangles, &mut best)
            || Self::among::<_, Discs, _>(lanes, &rays, &packs.discs, &mut best)
            || Self::among::<_, Boxes, _>(lanes, &rays, &packs.boxes, &mut best)
            || Self::among::<_, Spheres, _>(lanes, &rays, &packs.spheres, &mut best);
        best
    }
}

/// Eight rays' ways through all packs.
struct Together<'a> {
    packs: &'a PrimitivePacks,
    rays: [&'a Ray; WIDTH],
}

impl Together<'_> {
    /// Their ways through packs of one kind.
    #[inline(always)]
    fn among<L: Lanes, F: Form<N>, const N: usize>(
        (lanes, rays, sound): (L, &Rays<L>, u32),
        packs: &[Pack<N>],
        best: &mut [PackHit; WIDTH],
    ) {
        for pack in packs {
            for thing in pack.things() {
                let (met, t) = F::meet(lanes, rays, &pack.one(lanes, thing));
                if met & sound != 0 {
                    nearer(lanes.store(t), met & sound, pack.numbers[thing], best);
                }
            }
        }
    }
}

impl Kernel for Together<'_> {
    type Output = [PackHit; WIDTH];

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> [PackHit; WIDTH] {
        let Together { packs, rays } = self;
        let mut best = [PackHit { t: 0.0, number: u32::MAX }; WIDTH];
        let mut rows = [lanes.splat(0.0); WIDTH];
        for lane in 0..WIDTH {
            best[lane].t = rays[lane].t_max;
            rows[lane] = lanes.load(numbers_of(rays[lane]));
        }
        let [x, y, z, dx, dy, dz, t_min, t_max] = lanes.transpose(rows);
        let sound = sound(lanes, [x, y, z, dx, dy, dz]);
        let rays = &Rays { origin: lanes.doubles3([x, y, z]), dir: lanes.doubles3([dx, dy, dz]), t_min, t_max };
        Self::among::<_, Planes, _>((lanes, rays, sound), &packs.planes, &mut best);
        Self::among::<_, Rectangles, _>((lanes, rays, sound), &packs.rectangles, &mut best);
        Self::among::<_, Discs, _>((lanes, rays, sound), &packs.discs, &mut best);
        Self::among::<_, Boxes, _>((lanes, rays, sound), &packs.boxes, &mut best);
        Self::among::<_, Spheres, _>((lanes, rays, sound), &packs.spheres, &mut best);
        best
    }
}

/// The rays, by origin and direction, that are finite and have a direction.
#[inline(always)]
fn sound<L: Lanes>(lanes: L, numbers: [L::Floats; 6]) -> u32 {
    let (zero, infinity) = (lanes.splat(0.0), lanes.splat(f32::INFINITY));
    // No closures, which would be called like any function.
    let [x, y, z, dx, dy, dz] = numbers;
    let (dx, dy, dz) = (lanes.abs(dx), lanes.abs(dy), lanes.abs(dz));
    let finite = [lanes.abs(x), lanes.abs(y), lanes.abs(z), dx, dy, dz];
    let mut all = lanes.lt(zero, dx) | lanes.lt(zero, dy) | lanes.lt(zero, dz);
    for size in finite {
        all &= lanes.lt(size, infinity);
    }
    all
}

/// Takes one thing for the hit of the rays that meet it and nothing better yet.
#[inline(always)]
fn nearer(t: [f32; WIDTH], mut met: u32, number: u32, best: &mut [PackHit; WIDTH]) {
    while met != 0 {
        let lane = met.trailing_zeros() as usize % WIDTH;
        if (t[lane], number) < (best[lane].t, best[lane].number) {
            best[lane] = PackHit { t: t[lane], number };
        }
        met &= met - 1;
    }
}

/// The better of a hit and those of the lanes that are met.
#[inline(always)]
fn nearest(t: [f32; WIDTH], mut met: u32, numbers: &[u32; WIDTH], mut best: PackHit) -> PackHit {
    while met != 0 {
        let lane = met.trailing_zeros() as usize % WIDTH;
        let hit = PackHit { t: t[lane], number: numbers[lane] };
        if (hit.t, hit.number) < (best.t, best.number) {
            best = hit;
        }
        met &= met - 1;
    }
    best
}
