//! Planes and spheres, of which eight are tested at once.
//!
//! For scenes of a few things, where a tree would cost more than it saves, and for planes, which
//! have no box. What is computed is what a test of one thing alone computes, in double precision
//! and in the same order, so hits have the same bits.

use super::TraversalCounter;
use super::lanes::{Available, Kernel, Lanes, WIDTH, numbers_of};
use crate::math::{Doubles, Ray, Triple, Vec3};

/// Planes and spheres under the caller's numbers.
#[derive(Clone, Debug)]
pub struct PrimitivePacks {
    /// normal · p = size.
    planes: Vec<Pack>,
    /// |p - center|^2 = size.
    spheres: Vec<Pack>,
    /// How many there are of both.
    count: usize,
    level: Available,
}

/// Where a ray meets one of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PackHit {
    /// Position along the ray.
    pub t: f32,
    /// Number of the plane or sphere.
    pub number: u32,
}

/// Eight things of a kind: of each a normal or a centre, and a size. The size of a lane without a
/// thing is no number, so that nothing is met there.
#[derive(Clone, Copy, Debug)]
struct Pack {
    vectors: [[f64; WIDTH]; 3],
    sizes: [f64; WIDTH],
    numbers: [u32; WIDTH],
}

impl Pack {
    /// The lanes that have a thing.
    #[inline(always)]
    fn things(&self) -> std::ops::Range<usize> {
        let mut end = WIDTH;
        while end > 0 && self.numbers[end - 1] == u32::MAX {
            end -= 1;
        }
        0..end
    }
}

impl Default for PrimitivePacks {
    fn default() -> Self {
        PrimitivePacks { planes: Vec::new(), spheres: Vec::new(), count: 0, level: Available::chosen() }
    }
}

impl PrimitivePacks {
    /// Adds the plane normal · p = offset.
    pub fn push_plane(&mut self, number: u32, normal: Vec3, offset: f32) {
        push(&mut self.planes, number, normal, f64::from(offset));
        self.count += 1;
    }

    /// Adds the sphere |p - center| = radius.
    pub fn push_sphere(&mut self, number: u32, center: Vec3, radius: f32) {
        push(&mut self.spheres, number, center, f64::from(radius) * f64::from(radius));
        self.count += 1;
    }

    /// How many planes and spheres there are.
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
fn push(packs: &mut Vec<Pack>, number: u32, vector: Vec3, size: f64) {
    let free = |pack: &Pack| pack.sizes.iter().position(|size| size.is_nan());
    let mut pack = packs.pop_if(|pack| free(pack).is_some()).unwrap_or(Pack {
        vectors: [[0.0; WIDTH]; 3],
        sizes: [f64::NAN; WIDTH],
        numbers: [u32::MAX; WIDTH],
    });
    let lane = free(&pack).unwrap_or(0);
    (0..3).for_each(|axis| pack.vectors[axis][lane] = f64::from(vector[axis]));
    (pack.sizes[lane], pack.numbers[lane]) = (size, number);
    packs.push(pack);
}

/// One ray's way through all packs; `ANY`: the first thing found will do.
struct Query<'a, const ANY: bool> {
    packs: &'a PrimitivePacks,
    ray: &'a Ray,
}

impl<const ANY: bool> Kernel for Query<'_, ANY> {
    type Output = PackHit;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> PackHit {
        let Query { packs, ray } = self;
        let mut best = PackHit { t: ray.t_max, number: u32::MAX };
        let origin = lanes.doubles3(lanes.splat3(ray.origin.to_array()));
        let dir = lanes.doubles3(lanes.splat3(ray.dir.to_array()));
        let (t_min, t_max) = (lanes.splat(ray.t_min), lanes.splat(ray.t_max));
        for pack in &packs.planes {
            let t = plane(lanes, origin, dir, load3(lanes, &pack.vectors), lanes.load_doubles(&pack.sizes));
            let met = lanes.lt(t_min, t) & lanes.lt(t, t_max);
            if ANY && met != 0 {
                return PackHit { number: 0, ..best };
            }
            best = nearest(lanes.store(t), met, &pack.numbers, best);
        }
        for pack in &packs.spheres {
            let (center, square) = (load3(lanes, &pack.vectors), lanes.load_doubles(&pack.sizes));
            let Some([near, far]) = sphere(lanes, origin, dir, center, square) else { continue };
            let in_near = lanes.lt(t_min, near) & lanes.lt(near, t_max);
            let met = in_near | lanes.lt(t_min, far) & lanes.lt(far, t_max);
            if ANY && met != 0 {
                return PackHit { number: 0, ..best };
            }
            best = nearest(lanes.store(lanes.select(in_near, near, far)), met, &pack.numbers, best);
        }
        best
    }
}

/// Eight rays' ways through all packs.
struct Together<'a> {
    packs: &'a PrimitivePacks,
    rays: [&'a Ray; WIDTH],
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
        let (origin, dir) = (lanes.doubles3([x, y, z]), lanes.doubles3([dx, dy, dz]));
        for pack in &packs.planes {
            for thing in pack.things() {
                let t = plane(lanes, origin, dir, splat3(lanes, pack, thing), lanes.splat_double(pack.sizes[thing]));
                let met = sound & lanes.lt(t_min, t) & lanes.lt(t, t_max);
                nearer(lanes.store(t), met, pack.numbers[thing], &mut best);
            }
        }
        for pack in &packs.spheres {
            for thing in pack.things() {
                let (center, square) = (splat3(lanes, pack, thing), lanes.splat_double(pack.sizes[thing]));
                let Some([near, far]) = sphere(lanes, origin, dir, center, square) else { continue };
                let in_near = lanes.lt(t_min, near) & lanes.lt(near, t_max);
                let met = sound & (in_near | lanes.lt(t_min, far) & lanes.lt(far, t_max));
                nearer(lanes.store(lanes.select(in_near, near, far)), met, pack.numbers[thing], &mut best);
            }
        }
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

/// Where rays meet planes.
#[inline(always)]
fn plane<L: Lanes>(
    lanes: L,
    origin: [L::Doubles; 3],
    dir: [L::Doubles; 3],
    normal: [L::Doubles; 3],
    offset: L::Doubles,
) -> L::Floats {
    // A parallel ray divides by zero, and hits nothing.
    lanes.singles(offset.sub(normal.dot(origin)).div(normal.dot(dir)))
}

/// Where rays enter and leave spheres; `None` where all are missed.
#[inline(always)]
fn sphere<L: Lanes>(
    lanes: L,
    origin: [L::Doubles; 3],
    dir: [L::Doubles; 3],
    center: [L::Doubles; 3],
    square: L::Doubles,
) -> Option<[L::Floats; 2]> {
    // The discriminant is taken from the point of the ray nearest to the centre, which keeps small,
    // far spheres exact. Source: Haines, Günther, Akenine-Möller, *Ray Tracing Gems* (2019),
    // chapter 7.
    let o = origin.sub(center);
    let (dd, b) = (dir.dot(dir), o.dot(dir).mul(lanes.splat_double(-1.0)));
    let along = b.div(dd);
    let near = o.add([along; 3].mul(dir));
    let discriminant = square.sub(near.dot(near));
    // Where a sphere is missed, it is negative or no number, and so are the roots.
    if lanes.le(lanes.splat(0.0), lanes.singles(discriminant)) == 0 {
        return None;
    }
    // q has the sign of b, so that neither root loses digits to cancellation.
    let c = o.dot(o).sub(square);
    let q = b.add(dd.mul(discriminant).sqrt().copysign(b));
    let (t0, t1) = (c.div(q), q.div(dd));
    Some([lanes.singles(t0.min(t1)), lanes.singles(t1.max(t0))])
}

#[inline(always)]
fn load3<L: Lanes>(lanes: L, [x, y, z]: &[[f64; WIDTH]; 3]) -> [L::Doubles; 3] {
    [lanes.load_doubles(x), lanes.load_doubles(y), lanes.load_doubles(z)]
}

/// The vector of one thing of a pack in each lane.
#[inline(always)]
fn splat3<L: Lanes>(lanes: L, pack: &Pack, thing: usize) -> [L::Doubles; 3] {
    let [x, y, z] = &pack.vectors;
    [lanes.splat_double(x[thing]), lanes.splat_double(y[thing]), lanes.splat_double(z[thing])]
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
