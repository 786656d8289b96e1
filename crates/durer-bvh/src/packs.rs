//! Planes and spheres, of which eight are tested at once.
//!
//! For scenes of a few things, where a tree would cost more than it saves, and for planes, which
//! have no box. What is computed is what a test of one thing alone computes, in double precision
//! and in the same order, so hits have the same bits.

use super::TraversalCounter;
use super::lanes::{Available, Kernel, Lanes, WIDTH};
use crate::math::{Doubles, Ray, Vec3};

/// Planes and spheres under the caller's numbers.
#[derive(Clone, Debug)]
pub struct PrimitivePacks {
    planes: Vec<PlanePack>,
    spheres: Vec<SpherePack>,
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

/// normal · p = offset, by lane; an offset of a lane without a plane is no number.
#[derive(Clone, Copy, Debug)]
struct PlanePack {
    normal: [[f64; WIDTH]; 3],
    offset: [f64; WIDTH],
    numbers: [u32; WIDTH],
}

/// |p - center|^2 = radius^2, by lane; the radius of a lane without a sphere is no number.
#[derive(Clone, Copy, Debug)]
struct SpherePack {
    center: [[f64; WIDTH]; 3],
    square: [f64; WIDTH],
    numbers: [u32; WIDTH],
}

impl Default for PrimitivePacks {
    fn default() -> Self {
        PrimitivePacks { planes: Vec::new(), spheres: Vec::new(), count: 0, level: Available::chosen() }
    }
}

impl PrimitivePacks {
    /// Adds the plane normal · p = offset.
    pub fn push_plane(&mut self, number: u32, normal: Vec3, offset: f32) {
        let lane = self.planes.last().map_or(WIDTH, |pack| lanes_used(&pack.offset));
        if lane == WIDTH {
            let none = PlanePack { normal: [[0.0; WIDTH]; 3], offset: [f64::NAN; WIDTH], numbers: [u32::MAX; WIDTH] };
            self.planes.push(none);
        }
        if let Some(pack) = self.planes.last_mut() {
            let lane = lane % WIDTH;
            (0..3).for_each(|axis| pack.normal[axis][lane] = f64::from(normal[axis]));
            (pack.offset[lane], pack.numbers[lane]) = (f64::from(offset), number);
        }
        self.count += 1;
    }

    /// Adds the sphere |p - center| = radius.
    pub fn push_sphere(&mut self, number: u32, center: Vec3, radius: f32) {
        let lane = self.spheres.last().map_or(WIDTH, |pack| lanes_used(&pack.square));
        if lane == WIDTH {
            let none = SpherePack { center: [[0.0; WIDTH]; 3], square: [f64::NAN; WIDTH], numbers: [u32::MAX; WIDTH] };
            self.spheres.push(none);
        }
        if let Some(pack) = self.spheres.last_mut() {
            let lane = lane % WIDTH;
            (0..3).for_each(|axis| pack.center[axis][lane] = f64::from(center[axis]));
            (pack.square[lane], pack.numbers[lane]) = (f64::from(radius) * f64::from(radius), number);
        }
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

/// How many lanes of a pack are taken.
fn lanes_used(numbers: &[f64; WIDTH]) -> usize {
    numbers.iter().filter(|x| !x.is_nan()).count()
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
        let (origin, dir) = (splat3(lanes, ray.origin), splat3(lanes, ray.dir));
        let (t_min, t_max) = (lanes.splat(ray.t_min), lanes.splat(ray.t_max));
        for pack in &packs.planes {
            let normal = load3(lanes, &pack.normal);
            let slope = dot(normal, dir);
            // A parallel ray divides by zero, and hits nothing.
            let t = lanes.singles(lanes.load_doubles(&pack.offset).sub(dot(normal, origin)).div(slope));
            let met = lanes.lt(t_min, t) & lanes.lt(t, t_max);
            if ANY && met != 0 {
                return PackHit { number: 0, ..best };
            }
            best = nearest(lanes.store(t), met, &pack.numbers, best);
        }
        for pack in &packs.spheres {
            // The discriminant is taken from the point of the ray nearest to the centre, which
            // keeps small, far spheres exact. Source: Haines, Günther, Akenine-Möller, *Ray Tracing
            // Gems* (2019), chapter 7.
            let o = origin.sub(load3(lanes, &pack.center));
            let (dd, b) = (dot(dir, dir), dot(o, dir).mul(lanes.splat_double(-1.0)));
            let along = b.div(dd);
            let near = o.add([along.mul(dir[0]), along.mul(dir[1]), along.mul(dir[2])]);
            let square = lanes.load_doubles(&pack.square);
            let discriminant = square.sub(dot(near, near));
            // Where a sphere is missed, it is negative or no number, and so are the roots.
            if lanes.le(lanes.splat(0.0), lanes.singles(discriminant)) == 0 {
                continue;
            }
            // q has the sign of b, so that neither root loses digits to cancellation.
            let c = dot(o, o).sub(square);
            let q = b.add(dd.mul(discriminant).sqrt().copysign(b));
            let (t0, t1) = (c.div(q), q.div(dd));
            let (near, far) = (lanes.singles(t0.min(t1)), lanes.singles(t1.max(t0)));
            let in_near = lanes.lt(t_min, near) & lanes.lt(near, t_max);
            let in_far = lanes.lt(t_min, far) & lanes.lt(far, t_max);
            let met = in_near | in_far;
            if ANY && met != 0 {
                return PackHit { number: 0, ..best };
            }
            best = nearest(lanes.store(lanes.select(in_near, near, far)), met, &pack.numbers, best);
        }
        best
    }
}

#[inline(always)]
fn splat3<L: Lanes>(lanes: L, v: Vec3) -> [L::Doubles; 3] {
    let [x, y, z] = v.to_array();
    [lanes.splat_double(x.into()), lanes.splat_double(y.into()), lanes.splat_double(z.into())]
}

#[inline(always)]
fn load3<L: Lanes>(lanes: L, [x, y, z]: &[[f64; WIDTH]; 3]) -> [L::Doubles; 3] {
    [lanes.load_doubles(x), lanes.load_doubles(y), lanes.load_doubles(z)]
}

/// x + y, and then z.
#[inline(always)]
fn dot<D: Doubles>(a: [D; 3], b: [D; 3]) -> D {
    a[0].mul(b[0]).add(a[1].mul(b[1])).add(a[2].mul(b[2]))
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
