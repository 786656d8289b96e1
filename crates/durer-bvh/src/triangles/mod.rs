//! A tree over the triangles of a mesh, which also stores the triangles.

mod build;
mod fetch;
mod height_grid;
mod heights;
mod leaf;
mod nearest;
mod packet;
mod query;
mod rows;
mod serialize;
mod stream;
mod tree;

use super::lanes::{AvailableLevel, SimdLevel};
use super::node;
use super::tree_boxes::{self, TreeBox};
use super::{TraversalCounter, TraversalStats};
use crate::math::{self, Aabb, Ray, Vec3};
use crate::watertight::WatertightRay;
pub use height_grid::HeightGrid;
pub use nearest::NearestPoint;
use query::{AllHits, AnyHit, ClosestHit, Filter, Filtered, HitCollector, Query};
use rows::number;
use std::cell::Cell;
use std::mem::MaybeUninit;
pub use tree::{Facing, TriangleBvh, TriangleHit};

/// Runs a query with or without counters, as the counter requires.
#[inline(always)]
fn counting<T: TraversalCounter, A>(
    counter: &mut T,
    plain: impl FnOnce() -> A,
    counted: impl FnOnce(&mut TraversalStats) -> A,
) -> A {
    if !T::COUNTS_WORK {
        return plain();
    }
    let mut counts = TraversalStats::default();
    let answer = counted(&mut counts);
    counter.count_work(counts.nodes, counts.primitive_tests);
    answer
}

/// Sorts hits by `t` and then by triangle number, and removes duplicates. They arise because a
/// split triangle is found in several leaves.
fn in_order(mut all: Vec<TriangleHit>) -> Vec<TriangleHit> {
    all.sort_unstable_by(|a, b| a.t.total_cmp(&b.t).then(a.triangle.cmp(&b.triangle)));
    all.dedup_by_key(|hit| hit.triangle);
    all
}

impl TriangleBvh {
    /// Sets the SIMD level, or the scalar level if the processor does not support it.
    pub fn at_level(self, level: SimdLevel) -> Self {
        TriangleBvh { level: AvailableLevel::or_scalar(level), ..self }
    }

    /// Sets the smallest |(b - a) x (c - a) · d| of a triangle that rays with direction d can hit,
    /// so that slivers and edge-on triangles are culled. If it is 0, all triangles can be hit.
    pub fn min_volume(self, min_volume: f64) -> Self {
        TriangleBvh { min_volume, culls_slivers: min_volume != 0.0, ..self }
    }

    /// Prepares a ray for tests of single triangles, with the minimum volume of the tree.
    #[inline]
    pub fn watertight_ray(&self, ray: &Ray) -> WatertightRay {
        WatertightRay::new(ray).min_volume(self.min_volume)
    }

    /// Returns the closest hit in the ray's open interval (`t_min`, `t_max`).
    pub fn closest(&self, ray: &Ray) -> Option<TriangleHit> {
        self.query::<_, ClosestHit>(ray, ())
    }

    /// Finds the [closest](TriangleBvh::closest) hit and counts nodes and tests.
    #[inline]
    pub fn closest_counting<T: TraversalCounter>(&self, ray: &Ray, counter: &mut T) -> Option<TriangleHit> {
        counting(counter, || self.closest(ray), |counts| self.closest_counted(ray, counts))
    }

    /// Returns true if the ray hits anything in its open interval.
    pub fn occluded(&self, ray: &Ray) -> bool {
        self.query::<_, AnyHit>(ray, ())
    }

    /// Tests [occlusion](TriangleBvh::occluded) and counts nodes and tests.
    #[inline]
    pub fn occluded_counting<T: TraversalCounter>(&self, ray: &Ray, counter: &mut T) -> bool {
        counting(counter, || self.occluded(ray), |counts| self.occluded_counted(ray, counts))
    }

    /// Finds the closest hit that passes `filter`. Filters are useful for textures with holes,
    /// culled sides, or excluded triangles.
    ///
    /// The filter may be called several times for a triangle, in any order, and for hits that are
    /// not the closest. Its result should depend only on its arguments.
    ///
    /// ```
    /// use durer_bvh::math::{Ray, Vec3};
    /// use durer_bvh::{BuildQuality, Facing, TriangleBvh};
    ///
    /// let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
    /// let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    /// let bvh = TriangleBvh::build(&vertices, &triangles, BuildQuality::default());
    /// let ray = Ray::new(Vec3::new(0.2, 0.2, -1.0), Vec3::Z);
    /// // Where the ray leaves the tetrahedron, since front faces are culled.
    /// let hit = bvh.closest_where(&ray, |_, facing| facing == Facing::Back).unwrap();
    /// assert_eq!(hit.triangle, 3);
    /// ```
    pub fn closest_where(
        &self,
        ray: &Ray,
        mut filter: impl FnMut(&TriangleHit, Facing) -> bool,
    ) -> Option<TriangleHit> {
        self.closest_filtered(ray, &mut filter)
    }

    /// Returns true if any hit passes `filter`; see [`TriangleBvh::closest_where`].
    pub fn occluded_where(&self, ray: &Ray, mut filter: impl FnMut(&TriangleHit, Facing) -> bool) -> bool {
        self.occluded_filtered(ray, &mut filter)
    }

    /// Returns the hits in the ray's open interval, sorted by `t` and then by triangle number.
    pub fn all_hits(&self, ray: &Ray) -> Vec<TriangleHit> {
        in_order(self.query::<_, AllHits>(ray, ()))
    }

    /// Finds all [hits](TriangleBvh::all_hits) and counts nodes and tests.
    #[inline]
    pub fn all_hits_counting<T: TraversalCounter>(&self, ray: &Ray, counter: &mut T) -> Vec<TriangleHit> {
        counting(counter, || self.all_hits(ray), |counts| self.all_hits_counted(ray, counts))
    }

    // These functions are not generic so that they are compiled only once and not once per caller.

    pub(crate) fn closest_filtered(&self, ray: &Ray, filter: Filter) -> Option<TriangleHit> {
        self.query_with(ray, (), Filtered { inner: ClosestHit::default(), filter })
    }

    pub(crate) fn occluded_filtered(&self, ray: &Ray, filter: Filter) -> bool {
        self.query_with(ray, (), Filtered { inner: AnyHit, filter })
    }

    fn closest_counted(&self, ray: &Ray, counts: &mut TraversalStats) -> Option<TriangleHit> {
        self.query::<_, ClosestHit>(ray, counts)
    }

    fn occluded_counted(&self, ray: &Ray, counts: &mut TraversalStats) -> bool {
        self.query::<_, AnyHit>(ray, counts)
    }

    fn all_hits_counted(&self, ray: &Ray, counts: &mut TraversalStats) -> Vec<TriangleHit> {
        in_order(self.query::<_, AllHits>(ray, counts))
    }

    /// Returns the number of triangles that the ray crosses in its open interval. For a closed
    /// mesh, it is odd if the ray starts inside and even if it starts outside.
    pub fn hit_count(&self, ray: &Ray) -> usize {
        self.all_hits(ray).len()
    }

    /// Finds the closest hit of each ray, in order. The hits equal those of
    /// [`TriangleBvh::closest`], bit for bit, but a batch is faster. Within each group of 64
    /// consecutive rays, rays with similar origins and directions are traced as packets. Rays that
    /// are close in space, such as those of the pixels of a tile, should therefore be close in the
    /// list. After a group of incoherent rays, up to 960 rays are not tested for coherence. In a
    /// large tree, several of the remaining rays are traced in turn, so that one ray can proceed
    /// while another waits for memory.
    ///
    /// # Panics
    ///
    /// Panics if `rays` and `hits` have different lengths.
    pub fn closest_batch(&self, rays: &[Ray], hits: &mut [Option<TriangleHit>]) {
        assert_eq!(rays.len(), hits.len(), "`rays` and `hits` must have the same length");
        let hits = Cell::from_mut(hits).as_slice_of_cells();
        self.packets::<false>(
            rays,
            |i, hit| hits[i].set(hit),
            |rest| self.trace_each::<ClosestHit>(rays, rest, |i, hit| hits[i].set(hit)),
        );
    }

    /// Tests occlusion of each ray, in order. Rays are grouped as in
    /// [`TriangleBvh::closest_batch`].
    ///
    /// # Panics
    ///
    /// Panics if `rays` and `answers` have different lengths.
    pub fn occluded_batch(&self, rays: &[Ray], answers: &mut [bool]) {
        assert_eq!(rays.len(), answers.len(), "`rays` and `answers` must have the same length");
        let answers = Cell::from_mut(answers).as_slice_of_cells();
        self.packets::<true>(
            rays,
            |i, hit| answers[i].set(hit.is_some()),
            |rest| self.trace_each::<AnyHit>(rays, rest, |i, answer| answers[i].set(answer)),
        );
    }

    /// Counts the triangles that each ray crosses, in order; see [`TriangleBvh::hit_count`].
    ///
    /// # Panics
    ///
    /// Panics if `rays` and `counts` have different lengths.
    pub fn hit_count_batch(&self, rays: &[Ray], counts: &mut [u32]) {
        assert_eq!(rays.len(), counts.len(), "`rays` and `counts` must have the same length");
        rays.iter().zip(counts).for_each(|(ray, count)| *count = self.hit_count(ray) as u32);
    }

    /// Finds the hits of each ray, in order. `take` receives the index of the ray in the batch and
    /// its hits, sorted as in [`TriangleBvh::all_hits`].
    pub fn all_hits_batch(&self, rays: &[Ray], mut take: impl FnMut(usize, &[TriangleHit])) {
        rays.iter().enumerate().for_each(|(i, ray)| take(i, &self.all_hits(ray)));
    }

    #[inline]
    fn query<T: TraversalCounter, F: HitCollector + Default>(&self, ray: &Ray, counter: T) -> F::Answer {
        self.query_with(ray, counter, F::default())
    }

    #[inline]
    fn query_with<T: TraversalCounter, F: HitCollector>(&self, ray: &Ray, counter: T, collector: F) -> F::Answer {
        match self.nodes.is_empty() {
            true => F::Answer::default(),
            false => self.level.run(Query { bvh: self, ray, counter, collector }),
        }
    }

    /// Returns the corners of a triangle, or `None` if the triangle does not exist or has a
    /// non-finite corner.
    ///
    /// The first call builds an index with four bytes per triangle.
    #[inline]
    pub fn corners(&self, triangle: u32) -> Option<[Vec3; 3]> {
        let grid = self.heights.as_ref().filter(|grid| (triangle as usize) < grid.triangle_count());
        if let Some(grid) = grid {
            return Some(grid.corners(triangle as usize));
        }
        let leaf_of = self.leaf_of.get_or_init(|| self.index_leaves());
        // 0 means that the triangle is in no leaf.
        let leaf = *leaf_of.get(triangle as usize).filter(|leaf| **leaf != 0)?;
        let mut room = MaybeUninit::uninit();
        let (rows, count) = self.rows(leaf, &mut room);
        let lane = (0..count).find(|lane| number(rows, count, *lane) == triangle)?;
        let at = |row: usize| rows[row * count + lane];
        let corners = [0, 3, 6].map(|row| Vec3::new(at(row), at(row + 1), at(row + 2)));
        corners.iter().all(|corner| corner.is_finite()).then_some(corners)
    }

    #[cold]
    fn index_leaves(&self) -> Vec<u32> {
        let mut leaf_of = vec![0; self.count];
        for (_, _, leaf) in self.nodes.iter().flat_map(|node| node.children()) {
            if leaf & node::LEAF != 0 {
                let mut room = MaybeUninit::uninit();
                let (rows, count) = self.rows(leaf, &mut room);
                (0..count).for_each(|lane| leaf_of[number(rows, count, lane) as usize] = leaf);
            }
        }
        leaf_of
    }

    /// Returns the unit normal (b - a) x (c - a) of the hit triangle, or zero if the triangle has
    /// no area.
    ///
    /// ```
    /// use durer_bvh::math::{Ray, Vec3};
    /// use durer_bvh::{BuildQuality, TriangleBvh};
    ///
    /// let corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
    /// let bvh = TriangleBvh::build(&corners, &[[0, 1, 2]], BuildQuality::Fast);
    /// let hit = bvh.closest(&Ray::new(Vec3::new(0.2, 0.2, 5.0), Vec3::NEG_Z)).unwrap();
    /// assert_eq!(bvh.normal(&hit), Vec3::Z);
    /// assert_eq!(bvh.corners(hit.triangle).unwrap()[1], Vec3::X);
    /// ```
    pub fn normal(&self, hit: &TriangleHit) -> Vec3 {
        self.corners(hit.triangle).map_or(Vec3::ZERO, math::triangle_normal)
    }

    /// Returns the size in bytes.
    pub fn memory_usage(&self) -> usize {
        let leaf_of = self.leaf_of.get().map_or(0, |leaf_of| size_of_val(&**leaf_of));
        let heights = self.heights.as_ref().map_or(0, |grid| grid.memory_usage());
        size_of_val(&*self.nodes) + size_of_val(&*self.leaves) + leaf_of + heights
    }

    /// Returns the expected cost, in node tests, of a random ray through the bounds, by the surface
    /// area heuristic. A leaf is assumed to cost as much as a node. The cost is NaN if the bounds
    /// have no area.
    pub fn sah_cost(&self) -> f64 {
        node::cost(&self.nodes, self.bounds)
    }

    /// Returns the bounding box of all triangles.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Iterates over the boxes of the tree level by level.
    pub fn boxes(&self) -> impl Iterator<Item = TreeBox> {
        tree_boxes::boxes(&self.nodes).map(|(_, bounds)| bounds)
    }
}

#[cfg(test)]
pub(super) mod tests;
