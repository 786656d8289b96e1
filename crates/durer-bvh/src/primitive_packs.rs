//! Planes, spheres, discs, rectangles, and boxes, which are tested eight at a time without a tree.
//!
//! They are used for scenes with only a few primitives, where a tree would cost more than it saves,
//! and for planes, which have no bounding box. Each lane computes what a test of one primitive
//! would compute, in double precision and in the same order, so the hits have the same bits.

use super::TraversalCounter;
use super::lanes::{AvailableLevel, Kernel, Lanes, WIDTH, as_floats};
use crate::math::{Doubles, Ray, Triple, Vec3};
use glam::DVec3;

/// A list of planes, spheres, discs, rectangles, and boxes that answers ray queries without a tree,
/// packed for SIMD. The caller numbers the primitives.
#[derive(Clone, Debug)]
pub struct PrimitivePacks {
    planes: Vec<Pack<PLANE>>,
    spheres: Vec<Pack<SPHERE>>,
    discs: Vec<Pack<DISC>>,
    rectangles: Vec<Pack<RECTANGLE>>,
    boxes: Vec<Pack<BOX>>,
    /// Total number of primitives of all kinds.
    count: usize,
    level: AvailableLevel,
}

/// Closest intersection of a ray with a primitive of [`PrimitivePacks`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PackHit {
    /// Position along the ray.
    pub t: f32,
    /// Number of the primitive.
    pub number: u32,
}

/// Up to eight primitives of one kind, one per SIMD lane, each described by `N` numbers. In unused
/// lanes these numbers are NaN, so no ray hits them.
#[derive(Clone, Copy, Debug)]
struct Pack<const N: usize> {
    parameters: [[f64; WIDTH]; N],
    numbers: [u32; WIDTH],
}

impl<const N: usize> Pack<N> {
    /// Returns the range of the lanes in use.
    #[inline(always)]
    fn indices(&self) -> std::ops::Range<usize> {
        let mut end = WIDTH;
        while end > 0 && self.numbers[end - 1] == u32::MAX {
            end -= 1;
        }
        0..end
    }

    /// Loads a different primitive into each lane.
    #[inline(always)]
    fn eight<L: Lanes>(&self, lanes: L) -> [L::Doubles; N] {
        let mut parameters = [lanes.splat_double(0.0); N];
        for (to, from) in parameters.iter_mut().zip(&self.parameters) {
            *to = lanes.load_doubles(from);
        }
        parameters
    }

    /// Loads one primitive into all lanes.
    #[inline(always)]
    fn one<L: Lanes>(&self, lanes: L, primitive: usize) -> [L::Doubles; N] {
        let mut parameters = [lanes.splat_double(0.0); N];
        for (to, from) in parameters.iter_mut().zip(&self.parameters) {
            *to = lanes.splat_double(from[primitive]);
        }
        parameters
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
            level: AvailableLevel::chosen(),
        }
    }
}

impl PrimitivePacks {
    /// Iterates over the numbers of all primitives, kind by kind.
    pub fn numbers(&self) -> impl Iterator<Item = u32> {
        fn of<const N: usize>(packs: &[Pack<N>]) -> impl Iterator<Item = u32> {
            packs.iter().flat_map(|pack| pack.indices().map(|i| pack.numbers[i]))
        }
        let round = of(&self.planes).chain(of(&self.spheres)).chain(of(&self.discs));
        round.chain(of(&self.rectangles)).chain(of(&self.boxes))
    }

    /// Adds the plane with the equation normal · p = offset.
    pub fn push_plane(&mut self, number: u32, normal: Vec3, offset: f32) {
        let n = normal.as_dvec3();
        push(&mut self.planes, number, [n.x, n.y, n.z, f64::from(offset)]);
        self.count += 1;
    }

    /// Adds the sphere with the equation |p - center| = radius.
    pub fn push_sphere(&mut self, number: u32, center: Vec3, radius: f32) {
        let c = center.as_dvec3();
        push(&mut self.spheres, number, [c.x, c.y, c.z, f64::from(radius) * f64::from(radius)]);
        self.count += 1;
    }

    /// Adds the disc around a centre that is perpendicular to a unit normal and extends from an
    /// inner to an outer radius.
    pub fn push_disc(&mut self, number: u32, center: Vec3, normal: DVec3, [inner, outer]: [f32; 2]) {
        let (c, n) = (center.as_dvec3(), normal);
        push(&mut self.discs, number, [n.x, n.y, n.z, c.x, c.y, c.z, f64::from(inner), f64::from(outer)]);
        self.count += 1;
    }

    /// Adds the parallelogram that two edges span at a corner.
    pub fn push_rectangle(&mut self, number: u32, corner: Vec3, edges: [Vec3; 2]) {
        let (c, [e, f]) = (corner.as_dvec3(), edges.map(|edge| edge.as_dvec3()));
        let n = e.cross(f);
        let parameters = [c.x, c.y, c.z, e.x, e.y, e.z, f.x, f.y, f.z, n.x, n.y, n.z, n.length_squared()];
        push(&mut self.rectangles, number, parameters);
        self.count += 1;
    }

    /// Adds the axis-aligned box between two opposite corners.
    pub fn push_box(&mut self, number: u32, min: Vec3, max: Vec3) {
        let (min, max) = (min.as_dvec3(), max.as_dvec3());
        push(&mut self.boxes, number, [min.x, min.y, min.z, max.x, max.y, max.z]);
        self.count += 1;
    }

    /// Returns the number of primitives.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Returns true if there are no primitives.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Returns the closest hit in the ray's interval. If several hits have the same `t`, the one
    /// with the lowest number is returned. The ray must be finite and its direction nonzero.
    #[inline]
    pub fn closest<T: TraversalCounter>(&self, ray: &Ray, counter: &mut T) -> Option<PackHit> {
        if self.is_empty() {
            return None;
        }
        counter.count_work(0, self.count as u64);
        let hit = self.level.run(Query::<false> { packs: self, ray });
        (hit.number != u32::MAX).then_some(hit)
    }

    /// Returns the closest hits of eight rays. They equal the results of
    /// [`PrimitivePacks::closest`]. The rays are tested side by side against one primitive after
    /// the other, which is faster if there are few primitives. Rays that are not finite or have a
    /// zero direction hit nothing.
    pub fn closest_of_eight(&self, rays: [&Ray; WIDTH]) -> [Option<PackHit>; WIDTH] {
        let hits = self.level.run(BatchQuery { packs: self, rays });
        hits.map(|hit| (hit.number != u32::MAX).then_some(hit))
    }

    /// Returns true if the ray hits anything in its interval. The ray must be finite and its
    /// direction nonzero.
    #[inline]
    pub fn occluded<T: TraversalCounter>(&self, ray: &Ray, counter: &mut T) -> bool {
        if self.is_empty() {
            return false;
        }
        counter.count_work(0, self.count as u64);
        self.level.run(Query::<true> { packs: self, ray }).number != u32::MAX
    }
}

/// Adds a primitive in the first free lane of the last pack, or in a new pack.
fn push<const N: usize>(packs: &mut Vec<Pack<N>>, number: u32, parameters: [f64; N]) {
    let nothing = Pack { parameters: [[f64::NAN; WIDTH]; N], numbers: [u32::MAX; WIDTH] };
    let mut pack = packs.pop_if(|pack| pack.indices().end < WIDTH).unwrap_or(nothing);
    let lane = pack.indices().end;
    pack.numbers[lane] = number;
    (0..N).for_each(|i| pack.parameters[i][lane] = parameters[i]);
    packs.push(pack);
}

/// Origins, directions, and intervals of eight rays, one per lane.
struct Rays<L: Lanes> {
    origin: [L::Doubles; 3],
    dir: [L::Doubles; 3],
    t_min: L::Floats,
    t_max: L::Floats,
}

impl<L: Lanes> Rays<L> {
    /// Returns a mask of the lanes in which `t` lies in the interval.
    #[inline(always)]
    fn contain(&self, lanes: L, t: L::Floats) -> u32 {
        lanes.lt(self.t_min, t) & lanes.lt(t, self.t_max)
    }

    #[inline(always)]
    fn at(&self, t: L::Doubles) -> [L::Doubles; 3] {
        self.origin.add([t; 3].mul(self.dir))
    }
}

/// Intersection test for one kind of primitive, which is described by `N` numbers. [`Planes`],
/// [`Spheres`], [`Discs`], [`Rectangles`], and [`Boxes`] implement it.
trait PackedShape<const N: usize> {
    /// Returns the first hits in the rays' intervals, as a mask of lanes and `t`.
    fn intersect<L: Lanes>(lanes: L, rays: &Rays<L>, parameters: &[L::Doubles; N]) -> (u32, L::Floats);
}

/// Ray test for planes, normal · p = offset.
struct Planes;
const PLANE: usize = 4;

impl PackedShape<PLANE> for Planes {
    #[inline(always)]
    fn intersect<L: Lanes>(lanes: L, rays: &Rays<L>, &[x, y, z, offset]: &[L::Doubles; PLANE]) -> (u32, L::Floats) {
        let normal = [x, y, z];
        // For a ray parallel to the plane, the division by zero results in no hit.
        let t = lanes.singles(offset.sub(normal.dot(rays.origin)).div(normal.dot(rays.dir)));
        (rays.contain(lanes, t), t)
    }
}

/// Ray test for spheres, |p - center|^2 = square.
struct Spheres;
const SPHERE: usize = 4;

impl PackedShape<SPHERE> for Spheres {
    #[inline(always)]
    fn intersect<L: Lanes>(lanes: L, rays: &Rays<L>, &[x, y, z, square]: &[L::Doubles; SPHERE]) -> (u32, L::Floats) {
        // The discriminant is computed at the point of the ray nearest to the centre, which keeps
        // the test accurate for small, distant spheres. Source: Haines, Günther, Akenine-Möller,
        // *Ray Tracing Gems* (2019), chapter 7.
        let o = rays.origin.sub([x, y, z]);
        let (dd, b) = (rays.dir.dot(rays.dir), o.dot(rays.dir).mul(lanes.splat_double(-1.0)));
        let along = b.div(dd);
        let near = o.add([along; 3].mul(rays.dir));
        let discriminant = square.sub(near.dot(near));
        // If the ray misses a sphere, the discriminant is negative or NaN, and the roots are NaN.
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

/// Ray test for discs, normal · (p - center) = 0 with |p - center| between the radii.
struct Discs;
const DISC: usize = 8;

impl PackedShape<DISC> for Discs {
    #[inline(always)]
    fn intersect<L: Lanes>(lanes: L, rays: &Rays<L>, parameters: &[L::Doubles; DISC]) -> (u32, L::Floats) {
        let &[nx, ny, nz, x, y, z, inner, outer] = parameters;
        let (normal, center) = ([nx, ny, nz], [x, y, z]);
        let t = normal.dot(center.sub(rays.origin)).div(normal.dot(rays.dir));
        let (offset, hit_t) = (rays.at(t).sub(center), lanes.singles(t));
        let distance = offset.dot(offset).sqrt();
        let on = lanes.le_doubles(inner, distance) & lanes.le_doubles(distance, outer);
        (rays.contain(lanes, hit_t) & on, hit_t)
    }
}

/// Ray test for parallelograms, corner + u e + v f with u and v in [0, 1].
struct Rectangles;
const RECTANGLE: usize = 13;

impl PackedShape<RECTANGLE> for Rectangles {
    #[inline(always)]
    fn intersect<L: Lanes>(lanes: L, rays: &Rays<L>, parameters: &[L::Doubles; RECTANGLE]) -> (u32, L::Floats) {
        let &[x, y, z, ex, ey, ez, fx, fy, fz, nx, ny, nz, square] = parameters;
        let (corner, e, f, n) = ([x, y, z], [ex, ey, ez], [fx, fy, fz], [nx, ny, nz]);
        let t = n.dot(corner.sub(rays.origin)).div(n.dot(rays.dir));
        let hit_t = lanes.singles(t);
        let hits = rays.contain(lanes, hit_t);
        // Most rays do not hit the plane within their interval.
        if hits == 0 {
            return (0, hit_t);
        }
        // Cramer's rule.
        let q = rays.at(t).sub(corner);
        let (u, v) = (q.cross(f).dot(n).div(square), e.cross(q).dot(n).div(square));
        let (zero, one) = (lanes.splat_double(0.0), lanes.splat_double(1.0));
        let on = lanes.le_doubles(zero, u) & lanes.le_doubles(u, one);
        (hits & on & lanes.le_doubles(zero, v) & lanes.le_doubles(v, one), hit_t)
    }
}

/// Ray test for boxes between two corners, as the intersection of three slabs. Source: Kay and
/// Kajiya, *Ray Tracing Complex Scenes*, SIGGRAPH 1986.
struct Boxes;
const BOX: usize = 6;

impl PackedShape<BOX> for Boxes {
    #[inline(always)]
    fn intersect<L: Lanes>(lanes: L, rays: &Rays<L>, parameters: &[L::Doubles; BOX]) -> (u32, L::Floats) {
        let infinity = lanes.splat_double(f64::INFINITY);
        let (mut enter, mut leave) = (lanes.splat_double(f64::NEG_INFINITY), infinity);
        for axis in 0..3 {
            // If the ray is parallel to the slab, both ends are infinite. They have different signs
            // if the ray is inside the slab and equal signs if it is outside. If the ray lies on a
            // face, one end is NaN. Adding 0 avoids a zero with a negative sign.
            let (o, d) = (rays.origin[axis], rays.dir[axis].add(lanes.splat_double(0.0)));
            let (a, b) = (parameters[axis].sub(o).div(d), parameters[axis + 3].sub(o).div(d));
            // min and max drop a NaN operand, so only the other plane bounds the interval.
            enter = b.min(a).max(enter);
            leave = a.max(b).min(leave);
        }
        let inside = !lanes.le_doubles(leave, enter);
        let (hits, t) = first(lanes, rays, [enter, leave]);
        (hits & inside, t)
    }
}

/// Returns a mask of the lanes in which `near` or `far` lies in the ray's interval, and the first
/// of the two that does.
#[inline(always)]
fn first<L: Lanes>(lanes: L, rays: &Rays<L>, [near, far]: [L::Doubles; 2]) -> (u32, L::Floats) {
    let (near, far) = (lanes.singles(near), lanes.singles(far));
    let in_near = rays.contain(lanes, near);
    (in_near | rays.contain(lanes, far), lanes.select(in_near, near, far))
}

/// Query that tests one ray against all packs, eight primitives at a time. If `ANY` is true, the
/// query stops at any hit. Otherwise, it finds the closest hit.
struct Query<'a, const ANY: bool> {
    packs: &'a PrimitivePacks,
    ray: &'a Ray,
}

impl<const ANY: bool> Query<'_, ANY> {
    /// Tests the packs of one kind. Returns true if the query is finished.
    #[inline(always)]
    fn test_packs<L: Lanes, F: PackedShape<N>, const N: usize>(
        lanes: L,
        ray: &Rays<L>,
        packs: &[Pack<N>],
        best: &mut PackHit,
    ) -> bool {
        for pack in packs {
            let (hits, t) = F::intersect(lanes, ray, &pack.eight(lanes));
            if ANY && hits != 0 {
                best.number = 0;
                return true;
            }
            *best = nearest(lanes.store(t), hits, &pack.numbers, *best);
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
        let _found = Self::test_packs::<_, Planes, _>(lanes, &rays, &packs.planes, &mut best)
            || Self::test_packs::<_, Rectangles, _>(lanes, &rays, &packs.rectangles, &mut best)
            || Self::test_packs::<_, Discs, _>(lanes, &rays, &packs.discs, &mut best)
            || Self::test_packs::<_, Boxes, _>(lanes, &rays, &packs.boxes, &mut best)
            || Self::test_packs::<_, Spheres, _>(lanes, &rays, &packs.spheres, &mut best);
        best
    }
}

/// Query that tests eight rays at a time against all packs, one primitive at a time.
struct BatchQuery<'a> {
    packs: &'a PrimitivePacks,
    rays: [&'a Ray; WIDTH],
}

impl BatchQuery<'_> {
    /// Tests the packs of one kind.
    #[inline(always)]
    fn test_packs<L: Lanes, F: PackedShape<N>, const N: usize>(
        (lanes, rays, finite): (L, &Rays<L>, u32),
        packs: &[Pack<N>],
        best: &mut [PackHit; WIDTH],
    ) {
        for pack in packs {
            for primitive in pack.indices() {
                let (hits, t) = F::intersect(lanes, rays, &pack.one(lanes, primitive));
                if hits & finite != 0 {
                    update_closest(lanes.store(t), hits & finite, pack.numbers[primitive], best);
                }
            }
        }
    }
}

impl Kernel for BatchQuery<'_> {
    type Output = [PackHit; WIDTH];

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> [PackHit; WIDTH] {
        let BatchQuery { packs, rays } = self;
        let mut best = [PackHit { t: 0.0, number: u32::MAX }; WIDTH];
        let mut rows = [lanes.splat(0.0); WIDTH];
        for lane in 0..WIDTH {
            best[lane].t = rays[lane].t_max;
            rows[lane] = lanes.load(as_floats(rays[lane]));
        }
        let [x, y, z, dx, dy, dz, t_min, t_max] = lanes.transpose(rows);
        let finite = finite_rays(lanes, [x, y, z, dx, dy, dz]);
        let rays = &Rays { origin: lanes.doubles3([x, y, z]), dir: lanes.doubles3([dx, dy, dz]), t_min, t_max };
        Self::test_packs::<_, Planes, _>((lanes, rays, finite), &packs.planes, &mut best);
        Self::test_packs::<_, Rectangles, _>((lanes, rays, finite), &packs.rectangles, &mut best);
        Self::test_packs::<_, Discs, _>((lanes, rays, finite), &packs.discs, &mut best);
        Self::test_packs::<_, Boxes, _>((lanes, rays, finite), &packs.boxes, &mut best);
        Self::test_packs::<_, Spheres, _>((lanes, rays, finite), &packs.spheres, &mut best);
        best
    }
}

/// Returns a mask of the rays that are finite and have a nonzero direction. `numbers` holds the
/// origins and directions.
#[inline(always)]
fn finite_rays<L: Lanes>(lanes: L, numbers: [L::Floats; 6]) -> u32 {
    let (zero, infinity) = (lanes.splat(0.0), lanes.splat(f32::INFINITY));
    // Closures would not be inlined here.
    let [x, y, z, dx, dy, dz] = numbers;
    let (dx, dy, dz) = (lanes.abs(dx), lanes.abs(dy), lanes.abs(dz));
    let finite = [lanes.abs(x), lanes.abs(y), lanes.abs(z), dx, dy, dz];
    let mut all = lanes.lt(zero, dx) | lanes.lt(zero, dy) | lanes.lt(zero, dz);
    for size in finite {
        all &= lanes.lt(size, infinity);
    }
    all
}

/// Updates the best hits of the rays in the mask `hits` with a hit of primitive `number` at `t`.
#[inline(always)]
fn update_closest(t: [f32; WIDTH], mut hits: u32, number: u32, best: &mut [PackHit; WIDTH]) {
    while hits != 0 {
        let lane = hits.trailing_zeros() as usize % WIDTH;
        if (t[lane], number) < (best[lane].t, best[lane].number) {
            best[lane] = PackHit { t: t[lane], number };
        }
        hits &= hits - 1;
    }
}

/// Returns the closest hit among the hit `best` and the hits of the lanes in the mask `hits`.
#[inline(always)]
fn nearest(t: [f32; WIDTH], mut hits: u32, numbers: &[u32; WIDTH], mut best: PackHit) -> PackHit {
    while hits != 0 {
        let lane = hits.trailing_zeros() as usize % WIDTH;
        let hit = PackHit { t: t[lane], number: numbers[lane] };
        if (hit.t, hit.number) < (best.t, best.number) {
            best = hit;
        }
        hits &= hits - 1;
    }
    best
}
