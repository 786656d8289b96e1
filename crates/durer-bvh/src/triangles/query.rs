//! Ray queries on a [`TriangleBvh`]. Closest-hit, any-hit, and all-hits rays share one traversal.

use super::fetch::{PrefetchAddresses, SIBLING_LINES};
use super::leaf::ProjectedTriangles;
use super::rows::number;
use super::tree::{Facing, TriangleBvh, TriangleHit};
use crate::TraversalCounter;
use crate::lanes::{CornerColumns, Kernel, Lanes, Rows, WIDTH};
use crate::math::{Ray, Vec2};
use crate::traverse::{FAST_RANGE, NodeHits, TraversalRay, Visitor, traverse};
use crate::watertight::{Plane, PreciseLine, WatertightRay, axis_order};
use glam::Vec3A;
use std::mem::MaybeUninit;

/// Kernel that runs a query of one ray on a [`TriangleBvh`]. The collector `F` determines which
/// hits are returned.
pub struct Query<'a, T, F> {
    pub bvh: &'a TriangleBvh,
    pub ray: &'a Ray,
    pub counter: T,
    pub collector: F,
}

/// A ray prepared for tests of the triangles of a [`TriangleBvh`].
pub struct RayInTree<'a> {
    bvh: &'a TriangleBvh,
    ray: &'a Ray,
    sheared: WatertightRay,
}

/// Collects the hits of a ray query, such as the closest hit or all hits.
pub trait HitCollector {
    type Answer: Default;

    /// True if it only matters whether there is a hit.
    const ANY: bool;

    /// Records a hit at or before `t_max`, and returns the new `t_max`. Calling `facing` computes
    /// the side of the triangle.
    fn on_hit(&mut self, hit: TriangleHit, t_max: f32, facing: impl FnOnce() -> Facing) -> f32;

    /// Returns the result at the end of the traversal. `any` is true if the traversal stopped at a
    /// hit.
    fn answer(&mut self, any: bool) -> Self::Answer;
}

/// [`HitCollector`] that keeps the closest hit.
pub struct ClosestHit {
    /// Closest hit so far. Before the first hit, its triangle number is [`NONE`].
    best: TriangleHit,
}

const NONE: u32 = u32::MAX;

impl Default for ClosestHit {
    #[inline(always)]
    fn default() -> Self {
        ClosestHit { best: TriangleHit { t: f32::INFINITY, uv: Vec2::ZERO, triangle: NONE } }
    }
}

impl HitCollector for ClosestHit {
    type Answer = Option<TriangleHit>;

    const ANY: bool = false;

    #[inline(always)]
    fn on_hit(&mut self, hit: TriangleHit, t_max: f32, _: impl FnOnce() -> Facing) -> f32 {
        // The initial value of the best hit has the greatest triangle number.
        if hit.t < t_max || hit.triangle < self.best.triangle {
            self.best = hit;
        }
        hit.t
    }

    #[inline(always)]
    fn answer(&mut self, _: bool) -> Option<TriangleHit> {
        (self.best.triangle != NONE).then_some(self.best)
    }
}

/// [`HitCollector`] that stops at the first hit, for occlusion queries.
#[derive(Default)]
pub struct AnyHit;

impl HitCollector for AnyHit {
    type Answer = bool;

    const ANY: bool = true;

    #[inline(always)]
    fn on_hit(&mut self, _: TriangleHit, _: f32, _: impl FnOnce() -> Facing) -> f32 {
        f32::NEG_INFINITY
    }

    #[inline(always)]
    fn answer(&mut self, any: bool) -> bool {
        any
    }
}

/// [`HitCollector`] that keeps all hits, including duplicates from split triangles.
#[derive(Default)]
pub struct AllHits(Vec<TriangleHit>);

impl HitCollector for AllHits {
    type Answer = Vec<TriangleHit>;

    const ANY: bool = false;

    fn on_hit(&mut self, hit: TriangleHit, t_max: f32, _: impl FnOnce() -> Facing) -> f32 {
        self.0.push(hit);
        t_max
    }

    fn answer(&mut self, _: bool) -> Vec<TriangleHit> {
        std::mem::take(&mut self.0)
    }
}

/// Predicate of the caller that accepts or rejects hits. It may be called several times for a hit,
/// and for hits that are not the closest.
pub type Filter<'a> = &'a mut dyn FnMut(&TriangleHit, Facing) -> bool;

/// [`HitCollector`] that passes the hits that a filter accepts to another collector.
pub struct Filtered<'a, F> {
    pub inner: F,
    pub filter: Filter<'a>,
}

impl<F: HitCollector> HitCollector for Filtered<'_, F> {
    type Answer = F::Answer;

    // Even any-hit queries must pass each hit to the filter.
    const ANY: bool = false;

    fn on_hit(&mut self, hit: TriangleHit, t_max: f32, facing: impl FnOnce() -> Facing) -> f32 {
        let facing = facing();
        match (self.filter)(&hit, facing) {
            true => self.inner.on_hit(hit, t_max, || facing),
            false => t_max,
        }
    }

    fn answer(&mut self, any: bool) -> F::Answer {
        self.inner.answer(any)
    }
}

impl RayInTree<'_> {
    /// Returns the corners of a triangle with permuted axes, and the number of the triangle.
    #[inline(always)]
    fn triangle(&self, (rows, count): (&Rows, usize), lane: usize) -> ([Vec3A; 3], u32) {
        (CornerColumns::new(self.sheared.axes(), count).triangle(rows, lane), number(rows, count, lane))
    }

    #[inline(always)]
    fn is_wanted(&self, t: f32, t_max: f32) -> bool {
        self.ray.contains(t) && t <= t_max
    }
}

impl<T: TraversalCounter, F: HitCollector> Kernel for Query<'_, T, F> {
    type Output = F::Answer;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> F::Answer {
        if let Some(boxes) = TraversalRay::new(self.ray, self.bvh.reach) {
            self.search::<L, true>(lanes, &boxes)
        } else if let Some(boxes) = TraversalRay::robust(self.ray, self.bvh.reach) {
            self.search::<L, false>(lanes, &boxes)
        } else {
            F::Answer::default()
        }
    }
}

impl<T: TraversalCounter, F: HitCollector> Query<'_, T, F> {
    #[inline(always)]
    fn search<L: Lanes, const FAST: bool>(self, lanes: L, boxes: &TraversalRay) -> F::Answer {
        let Query { bvh, ray, counter, collector } = self;
        let mut leaves = LeafTester::new(lanes, bvh, ray, boxes, counter, collector);
        let t_max = traverse::<L, _, FAST>(lanes, &bvh.nodes, boxes, ray.t_max, &mut leaves);
        leaves.answer(t_max)
    }
}

/// Traversal visitor that tests a ray against the triangles of leaves and passes the hits to a
/// collector.
pub struct LeafTester<'a, T, F> {
    ray_in_tree: RayInTree<'a>,
    places: PrefetchAddresses,
    counter: T,
    collector: F,
    /// True if the products of edge functions cannot overflow, so that vector arithmetic can be
    /// used.
    can_use_vectors: bool,
}

impl<'a, T, F: HitCollector> LeafTester<'a, T, F> {
    #[inline(always)]
    pub fn new<L: Lanes>(
        lanes: L,
        bvh: &'a TriangleBvh,
        ray: &'a Ray,
        boxes: &TraversalRay,
        counter: T,
        collector: F,
    ) -> Self {
        let (origin, dir) = (Vec3A::from(ray.origin), Vec3A::from(ray.dir));
        let axes = axis_order(dir);
        let sheared = WatertightRay::permuted(axes, lanes.permute(origin, axes), lanes.permute(dir, axes));
        LeafTester {
            ray_in_tree: RayInTree { bvh, ray, sheared },
            places: PrefetchAddresses::new(bvh),
            counter,
            collector,
            can_use_vectors: boxes.is_in_range,
        }
    }

    /// Returns the result at the end of the traversal.
    #[inline(always)]
    pub fn answer(&mut self, t_max: f32) -> F::Answer {
        self.collector.answer(t_max == f32::NEG_INFINITY)
    }
}

impl<T: TraversalCounter, F: HitCollector> Visitor for LeafTester<'_, T, F> {
    type TraversalCounter = T;

    const ANY: bool = F::ANY;

    #[inline(always)]
    fn counter(&mut self) -> &mut T {
        &mut self.counter
    }

    #[inline(always)]
    fn fetch<L: Lanes>(&self, lanes: L, hits: &NodeHits<L>, likely: u32) {
        let child = hits.child(likely);
        self.places.fetch::<L, SIBLING_LINES>(lanes, child);
    }

    #[inline(always)]
    fn leaf<L: Lanes, const FAST: bool>(&mut self, lanes: L, leaf: u32, mut t_max: f32) -> f32 {
        let mut room = MaybeUninit::uninit();
        let (rows, count) = self.ray_in_tree.bvh.rows(leaf, &mut room);
        self.counter.count_work(0, count as u64);
        if !FAST && !self.can_use_vectors {
            return self.one_by_one(leaf, (1 << count) - 1, t_max);
        }
        let RayInTree { bvh, sheared, .. } = &self.ray_in_tree;
        let (origin, shear) = (lanes.splat3(sheared.ray().0.to_array()), sheared.shear());
        let columns = CornerColumns::new(sheared.axes(), count);
        let corners = lanes.corners(rows, columns);
        let flat = ProjectedTriangles::new(lanes, corners, origin, [lanes.splat(shear.x), lanes.splat(shear.y)]);
        let there = (1 << count) - 1;
        let mut unsure = !flat.missed(lanes) & there;
        if unsure == 0 {
            return t_max;
        }
        let crossed = flat.crossed(lanes) & there;
        let is_bounded = FAST || FAST_RANGE.contains(&sheared.ray().1.z.abs());
        if crossed == 0 || bvh.culls_slivers || F::ANY && !is_bounded {
            return self.one_by_one(leaf, unsure, t_max);
        }
        unsure ^= crossed;
        if F::ANY {
            let (start, end) = (lanes.splat(self.ray_in_tree.ray.t_min), lanes.splat(self.ray_in_tree.ray.t_max));
            let span = flat.span(lanes, 1.0 / sheared.ray().1.z);
            // The condition is written so that NaN counts as uncertain.
            if crossed & lanes.lt(start, span.near) & lanes.lt(span.far, end) != 0 {
                return f32::NEG_INFINITY;
            }
            unsure |= crossed & !(lanes.le(span.far, start) | lanes.le(end, span.near));
        } else {
            // Without `black_box`, the compiler would compute this for every ray, even for rays
            // that reach no leaf.
            let sheared = std::hint::black_box(sheared);
            let (origin, dir) = sheared.ray();
            let line = PreciseLine::new(lanes.triple(origin), lanes.triple(dir));
            let mut crossed = crossed;
            while crossed != 0 {
                let lane = crossed.trailing_zeros() as usize & 7;
                crossed &= crossed - 1;
                let [a, b, c] = columns.triangle(rows, lane);
                let t = line.t(&Plane::new([lanes.triple(a), lanes.triple(b), lanes.triple(c)]))[0] as f32;
                if self.ray_in_tree.is_wanted(t, t_max) {
                    let uv = sheared.uv([a, b, c]);
                    let hit = TriangleHit { t, uv, triangle: number(rows, count, lane) };
                    t_max = self.collector.on_hit(hit, t_max, || Facing::of(sheared, [a, b, c]));
                }
            }
        }
        match unsure {
            0 => t_max,
            _ => self.one_by_one(leaf, unsure, t_max),
        }
    }
}

impl<T: TraversalCounter, F: HitCollector> LeafTester<'_, T, F> {
    /// Tests triangles with the exact scalar test.
    #[cold]
    fn one_by_one(&mut self, leaf: u32, which: u32, mut t_max: f32) -> f32 {
        let sheared = self.ray_in_tree.sheared.min_volume(self.ray_in_tree.bvh.min_volume);
        let mut room = MaybeUninit::uninit();
        let rows = self.ray_in_tree.bvh.rows(leaf, &mut room);
        for lane in (0..WIDTH).filter(|lane| which >> lane & 1 == 1) {
            let (corners, triangle) = self.ray_in_tree.triangle(rows, lane);
            if sheared.crosses(corners)
                && let Some(t) = sheared.t(corners).filter(|t| self.ray_in_tree.is_wanted(*t, t_max))
            {
                let hit = TriangleHit { t, uv: sheared.uv(corners), triangle };
                t_max = self.collector.on_hit(hit, t_max, || Facing::of(&sheared, corners));
            }
        }
        t_max
    }
}
