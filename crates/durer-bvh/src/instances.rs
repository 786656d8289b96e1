//! Instances of triangle trees, and a tree over them.

use super::{Bvh, Facing, TraversalCounter, TriangleBvh, TriangleHit};
use crate::math::{Aabb, Affine, Ray, Ray64, Vec2, Vec3, triangle_normal};
use std::sync::Arc;

/// A mesh, stored as a triangle tree and placed in world space by an affine map. It is part of an
/// [`InstanceBvh`].
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Instance {
    /// Tree over the triangles in object space.
    pub bvh: Arc<TriangleBvh>,
    /// Map from object space to world space. Any invertible map is allowed, including shear and
    /// reflection.
    pub to_world: Affine,
    /// Visibility mask. A query with a mask finds only instances whose masks share a set bit with
    /// it.
    pub mask: u32,
}

impl Instance {
    /// Creates an instance that is visible to rays with any mask other than 0.
    pub fn new(bvh: Arc<TriangleBvh>, to_world: Affine) -> Self {
        Instance { bvh, to_world, mask: u32::MAX }
    }

    /// Replaces the visibility mask.
    pub fn with_mask(self, mask: u32) -> Self {
        Instance { mask, ..self }
    }

    fn bounds(&self) -> Aabb {
        match self.bvh.bounds() {
            empty if empty.is_empty() => Aabb::EMPTY,
            bounds => self.to_world.bounds(bounds),
        }
    }
}

/// Intersection of a ray with a triangle of an instance, as returned by the queries of
/// [`InstanceBvh`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InstanceHit {
    /// Position along the ray, in units of the length of its direction.
    pub t: f32,
    /// Second and third barycentric coordinates.
    pub uv: Vec2,
    /// Number of the instance.
    pub instance: u32,
    /// Number of the triangle within its tree.
    pub triangle: u32,
}

impl InstanceHit {
    fn new(instance: u32, TriangleHit { t, uv, triangle }: TriangleHit) -> Self {
        InstanceHit { t, uv, instance, triangle }
    }

    /// Returns the key by which hits along a ray are sorted.
    fn key(&self) -> (f32, u32, u32) {
        (self.t, self.instance, self.triangle)
    }
}

/// A two-level BVH over instances of meshes that can move. Instances share triangle trees, so each
/// tree is in memory only once.
///
/// Rays are transformed into object space in double precision and rounded once. The origin of a ray
/// can also be in double precision ([`Ray64`]). In object space, rays are traced as in a
/// [`TriangleBvh`], so a ray that meets a shared edge crosses exactly one of the two triangles. If
/// several hits have the same `t`, the hit with the lowest instance number counts as the closest.
/// If these are also equal, the lowest triangle number decides.
///
/// ```
/// use durer_bvh::glam::{DAffine3, DVec3};
/// use durer_bvh::math::{Affine, Ray, Vec3};
/// use durer_bvh::{BuildQuality, Instance, InstanceBvh, TriangleBvh};
/// use std::sync::Arc;
///
/// let corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
/// let bvh = Arc::new(TriangleBvh::build(&corners, &[[0, 1, 2]], BuildQuality::default()));
/// let at = |z| Affine::new(DAffine3::from_translation(DVec3::new(0.0, 0.0, z))).unwrap();
/// let instances = [2.0, 5.0].map(|z| Instance::new(bvh.clone(), at(z)));
/// let mut scene = InstanceBvh::new(instances.into());
/// let ray = Ray::new(Vec3::new(0.2, 0.2, 0.0), Vec3::Z);
/// let hit = scene.closest(&ray).unwrap();
/// assert_eq!((hit.t, hit.instance, hit.triangle), (2.0, 0, 0));
/// assert_eq!(scene.hit_count(&ray), 2);
///
/// // The first moves behind the second.
/// scene.update([(0, at(9.0))]);
/// assert_eq!(scene.closest(&ray).unwrap().t, 5.0);
/// ```
#[derive(Clone, Debug)]
pub struct InstanceBvh {
    instances: Vec<Instance>,
    bvh: Bvh,
}

impl InstanceBvh {
    /// Builds a tree over fewer than 2^28 instances. Each instance is numbered by its position in
    /// the list.
    pub fn new(instances: Vec<Instance>) -> Self {
        let bvh = Self::build(&instances);
        InstanceBvh { instances, bvh }
    }

    fn build(instances: &[Instance]) -> Bvh {
        Bvh::build(&instances.iter().map(Instance::bounds).collect::<Vec<_>>())
    }

    /// Moves some instances, given by number, and rebuilds the tree over instances. This takes much
    /// less time than building the triangle trees. The result is the same as that of
    /// [`InstanceBvh::new`].
    ///
    /// # Panics
    ///
    /// Panics if a number is out of range.
    pub fn update(&mut self, moved: impl IntoIterator<Item = (u32, Affine)>) {
        for (number, to_world) in moved {
            self.instances[number as usize].to_world = to_world;
        }
        self.bvh = Self::build(&self.instances);
    }

    /// Returns the instances in the order of their numbers.
    pub fn instances(&self) -> &[Instance] {
        &self.instances
    }

    /// Returns the bounding box of all instances.
    pub fn bounds(&self) -> Aabb {
        self.bvh.bounds()
    }

    /// Returns the closest hit in the ray's open interval (`t_min`, `t_max`).
    pub fn closest(&self, ray: impl Into<Ray64>) -> Option<InstanceHit> {
        self.closest_counting(ray, &mut ())
    }

    /// Finds the [closest](InstanceBvh::closest) hit and counts nodes and tests in both levels.
    pub fn closest_counting<T: TraversalCounter>(&self, ray: impl Into<Ray64>, counter: &mut T) -> Option<InstanceHit> {
        self.closest_with(&ray.into(), u32::MAX, counter, |bvh, ray, _, counter| bvh.closest_counting(ray, counter))
    }

    /// Finds the [closest](InstanceBvh::closest) hit on instances whose masks share a set bit with
    /// `mask`.
    pub fn closest_masked(&self, ray: impl Into<Ray64>, mask: u32) -> Option<InstanceHit> {
        self.closest_with(&ray.into(), mask, &mut (), |bvh, ray, _, _| bvh.closest(ray))
    }

    /// Finds the closest hit that passes `filter`, on instances whose masks share a set bit with
    /// `mask`; see [`TriangleBvh::closest_where`]. The front side of a triangle is determined in
    /// world space, after any reflection.
    pub fn closest_where(
        &self,
        ray: impl Into<Ray64>,
        mask: u32,
        mut filter: impl FnMut(&InstanceHit, Facing) -> bool,
    ) -> Option<InstanceHit> {
        self.closest_with(&ray.into(), mask, &mut (), |bvh, local, number, _| {
            let mirrors = self.instances[number as usize].to_world.flips_handedness();
            bvh.closest_filtered(local, &mut |hit, facing| {
                filter(&InstanceHit::new(number, *hit), facing.turned_if(mirrors))
            })
        })
    }

    /// Calls `closest` for each instance that the ray may hit, and returns the closest of these
    /// hits.
    #[inline]
    fn closest_with<T: TraversalCounter>(
        &self,
        ray: &Ray64,
        mask: u32,
        counter: &mut T,
        mut closest: impl FnMut(&TriangleBvh, &Ray, u32, &mut T) -> Option<TriangleHit>,
    ) -> Option<InstanceHit> {
        let (mut best, mut t_max): (Option<InstanceHit>, f32) = (None, ray.rounded.t_max);
        self.traverse(ray, mask, counter, |number, bvh, local, counter| {
            if let Some(hit) = closest(bvh, &Ray { t_max, ..local }, number, counter) {
                let hit = InstanceHit::new(number, hit);
                if best.is_none_or(|best| hit.key() < best.key()) {
                    best = Some(hit);
                    // An instance with a lower number may have a hit at the same `t`.
                    t_max = hit.t.next_up();
                }
            }
            t_max
        });
        best
    }

    /// Returns true if the ray hits anything in its open interval.
    pub fn occluded(&self, ray: impl Into<Ray64>) -> bool {
        self.occluded_counting(ray, &mut ())
    }

    /// Tests [occlusion](InstanceBvh::occluded) and counts nodes and tests in both levels.
    pub fn occluded_counting<T: TraversalCounter>(&self, ray: impl Into<Ray64>, counter: &mut T) -> bool {
        self.any(&ray.into(), u32::MAX, counter, |bvh, ray, _, counter| bvh.occluded_counting(ray, counter))
    }

    /// Tests [occlusion](InstanceBvh::occluded) by instances whose masks share a set bit with
    /// `mask`.
    pub fn occluded_masked(&self, ray: impl Into<Ray64>, mask: u32) -> bool {
        self.any(&ray.into(), mask, &mut (), |bvh, ray, _, _| bvh.occluded(ray))
    }

    /// Returns true if any hit passes `filter`, on instances whose masks share a set bit with
    /// `mask`; see [`InstanceBvh::closest_where`].
    pub fn occluded_where(
        &self,
        ray: impl Into<Ray64>,
        mask: u32,
        mut filter: impl FnMut(&InstanceHit, Facing) -> bool,
    ) -> bool {
        self.any(&ray.into(), mask, &mut (), |bvh, local, number, _| {
            let mirrors = self.instances[number as usize].to_world.flips_handedness();
            bvh.occluded_filtered(local, &mut |hit, facing| {
                filter(&InstanceHit::new(number, *hit), facing.turned_if(mirrors))
            })
        })
    }

    #[inline]
    fn any<T: TraversalCounter>(
        &self,
        ray: &Ray64,
        mask: u32,
        counter: &mut T,
        mut occluded: impl FnMut(&TriangleBvh, &Ray, u32, &mut T) -> bool,
    ) -> bool {
        let mut is_occluded = false;
        self.traverse(ray, mask, counter, |number, bvh, local, counter| {
            is_occluded |= occluded(bvh, &local, number, counter);
            if is_occluded { f32::NEG_INFINITY } else { ray.rounded.t_max }
        });
        is_occluded
    }

    /// Returns the hits in the ray's open interval, sorted by `t`, then by instance number, then by
    /// triangle number.
    pub fn all_hits(&self, ray: impl Into<Ray64>) -> Vec<InstanceHit> {
        let (mut all, ray) = (Vec::new(), ray.into());
        self.traverse(&ray, u32::MAX, &mut (), |number, bvh, local, _| {
            all.extend(bvh.all_hits(&local).into_iter().map(|hit| InstanceHit::new(number, hit)));
            ray.rounded.t_max
        });
        all.sort_by(|a, b| a.t.total_cmp(&b.t).then((a.instance, a.triangle).cmp(&(b.instance, b.triangle))));
        all
    }

    /// Returns the number of triangles that the ray crosses in its open interval.
    pub fn hit_count(&self, ray: impl Into<Ray64>) -> usize {
        self.all_hits(ray).len()
    }

    /// Finds the closest hit of each ray, in order; see [`InstanceBvh::closest`].
    ///
    /// # Panics
    ///
    /// Panics if `rays` and `hits` have different lengths.
    pub fn closest_batch(&self, rays: &[Ray], hits: &mut [Option<InstanceHit>]) {
        assert_eq!(rays.len(), hits.len(), "`rays` and `hits` must have the same length");
        rays.iter().zip(hits).for_each(|(ray, hit)| *hit = self.closest(ray));
    }

    /// Tests occlusion of each ray, in order; see [`InstanceBvh::occluded`].
    ///
    /// # Panics
    ///
    /// Panics if `rays` and `answers` have different lengths.
    pub fn occluded_batch(&self, rays: &[Ray], answers: &mut [bool]) {
        assert_eq!(rays.len(), answers.len(), "`rays` and `answers` must have the same length");
        rays.iter().zip(answers).for_each(|(ray, answer)| *answer = self.occluded(ray));
    }

    /// Counts the triangles that each ray crosses, in order.
    ///
    /// # Panics
    ///
    /// Panics if `rays` and `counts` have different lengths.
    pub fn hit_count_batch(&self, rays: &[Ray], counts: &mut [u32]) {
        assert_eq!(rays.len(), counts.len(), "`rays` and `counts` must have the same length");
        rays.iter().zip(counts).for_each(|(ray, count)| *count = self.hit_count(ray) as u32);
    }

    /// Finds the hits of each ray, in order. `take` receives the index of the ray in the batch and
    /// its hits, sorted as in [`InstanceBvh::all_hits`].
    pub fn all_hits_batch(&self, rays: &[Ray], mut take: impl FnMut(usize, &[InstanceHit])) {
        rays.iter().enumerate().for_each(|(i, ray)| take(i, &self.all_hits(ray)));
    }

    /// Returns the corners of the hit triangle in world space, or `None` if there is no such
    /// instance or triangle.
    pub fn corners(&self, hit: &InstanceHit) -> Option<[Vec3; 3]> {
        let Instance { bvh, to_world, .. } = self.instances.get(hit.instance as usize)?;
        Some(bvh.corners(hit.triangle)?.map(|corner| to_world.point(corner)))
    }

    /// Returns the unit normal of the hit triangle in world space. This is (b - a) x (c - a),
    /// normalised, where a, b, and c are the corners in world space. The result is zero if the
    /// triangle has no area.
    pub fn normal(&self, hit: &InstanceHit) -> Vec3 {
        self.corners(hit).map_or(Vec3::ZERO, triangle_normal)
    }

    /// Calls `visit` for each instance that the ray may hit, in approximately front-to-back order.
    /// It passes the number and tree of the instance and the ray in object space. `visit` returns
    /// the new `t_max`.
    #[inline]
    fn traverse<T: TraversalCounter>(
        &self,
        ray: &Ray64,
        mask: u32,
        counter: &mut T,
        mut visit: impl FnMut(u32, &TriangleBvh, Ray, &mut T) -> f32,
    ) {
        self.bvh.traverse(&ray.rounded, counter, |item, t_max, counter| {
            let number = self.bvh.primitive_indices()[item];
            let instance = &self.instances[number as usize];
            match instance.mask & mask {
                0 => t_max,
                _ => visit(number, &instance.bvh, instance.to_world.inverse_ray(ray), counter),
            }
        });
    }

    /// Returns the size in bytes. A tree that several instances share counts only once.
    pub fn memory_usage(&self) -> usize {
        let mut trees: Vec<&Arc<TriangleBvh>> = self.instances.iter().map(|instance| &instance.bvh).collect();
        trees.sort_by_key(|tree| Arc::as_ptr(tree));
        trees.dedup_by_key(|tree| Arc::as_ptr(tree));
        let shared: usize = trees.iter().map(|tree| tree.memory_usage()).sum();
        shared + self.bvh.memory_usage() + size_of_val(&*self.instances)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::BuildQuality;
    use crate::math::Vec3;
    use crate::math::random::Random;
    use crate::triangles::tests::{bits, brute_force, ray, soup, torus};
    use glam::{DAffine3, DMat3, DVec3};

    /// Returns a random affine map that rotates, shears, stretches, and possibly mirrors.
    fn map(random: &mut Random) -> Affine {
        loop {
            let mut axis = || random.point().as_dvec3();
            let matrix = DMat3::from_cols(axis(), axis(), axis());
            let forward = DAffine3 { matrix3: matrix, translation: 2.0 * axis() };
            // Reject nearly singular maps because they lose digits.
            if let Some(map) = Affine::new(forward).filter(|_| matrix.determinant().abs() > 0.05) {
                return map;
            }
        }
    }

    #[test]
    fn instance_hits_equal_triangle_hits() {
        let mut random = Random(8);
        let meshes = [torus(16, 8), soup(&mut random, 200, 0.3)];
        let trees = meshes.clone().map(|(v, t)| Arc::new(TriangleBvh::build(&v, &t, BuildQuality::Balanced)));
        let mut placed: Vec<Instance> =
            (0..30).map(|i| Instance::new(trees[i % 2].clone(), map(&mut random))).collect();
        // If there are duplicates at the same place, the first is the closest.
        placed.extend_from_within(..4);
        let scene = InstanceBvh::new(placed);
        let mut hits = 0;
        for _ in 0..2_000 {
            let ray = ray(&meshes[0], &mut random, 1.0, Vec3::ZERO);
            let mut expected: Vec<(u32, _)> = (0..scene.instances.len())
                .flat_map(|i| {
                    let local = scene.instances[i].to_world.inverse_ray(&ray);
                    brute_force(&meshes[i % 30 % 2], &local).into_iter().map(move |hit| (i as u32, hit))
                })
                .collect();
            expected.sort_by(|(i, a), (j, b)| a.t.total_cmp(&b.t).then((i, a.triangle).cmp(&(j, b.triangle))));
            let plain = |hit: &InstanceHit| {
                (hit.instance, bits(&crate::TriangleHit { t: hit.t, uv: hit.uv, triangle: hit.triangle }))
            };
            let expected: Vec<_> = expected.iter().map(|(i, hit)| (*i, bits(hit))).collect();
            assert_eq!(scene.all_hits(&ray).iter().map(plain).collect::<Vec<_>>(), expected, "{ray:?}");
            assert_eq!(scene.closest(&ray).as_ref().map(plain), expected.first().copied(), "{ray:?}");
            assert_eq!(
                (scene.occluded(&ray), scene.hit_count(&ray)),
                (!expected.is_empty(), expected.len()),
                "{ray:?}"
            );
            hits += usize::from(!expected.is_empty());
        }
        assert!(hits > 500, "{hits}");
        assert!(scene.memory_usage() < 2 * (trees[0].memory_usage() + trees[1].memory_usage()));
    }

    #[test]
    fn origin_keeps_double_precision_in_instances() {
        let mut random = Random(10);
        let mesh = torus(16, 8);
        let bvh = Arc::new(TriangleBvh::build(&mesh.0, &mesh.1, BuildQuality::Balanced));
        // Coordinates are sums of a few powers of two, so translating a point and translating it
        // back restores it exactly.
        let far = DVec3::new(4_194_304.25, -262_144.5, 2_097_152.0);
        let to_world = Affine::new(DAffine3::from_translation(far)).unwrap();
        let scene = InstanceBvh::new(vec![Instance::new(bvh.clone(), to_world)]);
        let mut hits = 0;
        for _ in 0..2_000 {
            let near = ray(&mesh, &mut random, 1.0, Vec3::ZERO);
            let origin = (near.origin * 1024.0).round() / 1024.0;
            let near = Ray { origin, ..near };
            let from_there = Ray64::new(origin.as_dvec3() + far, near.dir, near.t_min, near.t_max);
            let hit = scene.closest(from_there);
            assert_eq!(hit.map(|hit| (hit.t, hit.triangle)), bvh.closest(&near).map(|hit| (hit.t, hit.triangle)));
            assert_eq!(scene.occluded(from_there), bvh.occluded(&near));
            assert_eq!(scene.hit_count(from_there), bvh.hit_count(&near));
            hits += usize::from(hit.is_some());
        }
        assert!(hits > 500, "{hits}");
    }

    #[test]
    fn empty_instances_are_never_hit() {
        let empty = Arc::new(TriangleBvh::build(&[], &[], BuildQuality::Fast));
        let ray = Ray::new(Vec3::ZERO, Vec3::X);
        for count in [0, 3] {
            let placed = vec![Instance::new(empty.clone(), Affine::IDENTITY); count];
            let scene = InstanceBvh::new(placed);
            assert_eq!((scene.closest(&ray), scene.occluded(&ray), scene.hit_count(&ray)), (None, false, 0));
            assert!(scene.bounds().is_empty());
        }
        let triangle = TriangleBvh::build(&[Vec3::NEG_ONE, Vec3::X, Vec3::Y], &[[0, 1, 2]], BuildQuality::Fast);
        let scene = InstanceBvh::new(vec![Instance::new(Arc::new(triangle), Affine::IDENTITY)]);
        for dir in [Vec3::NAN, Vec3::ZERO, Vec3::INFINITY] {
            assert_eq!(scene.closest(&Ray::new(Vec3::Z, dir)), None);
        }
    }

    /// Returns the scene as one mesh, with the instance number, triangle number, and corners of
    /// each triangle.
    fn flattened(scene: &InstanceBvh, meshes: &[crate::triangles::tests::Mesh]) -> Vec<(u32, u32, [Vec3; 3])> {
        let corners = |(i, instance): (usize, &Instance)| {
            let (vertices, triangles) = meshes[i % meshes.len()].clone();
            let to_world = instance.to_world;
            triangles
                .into_iter()
                .enumerate()
                .map(move |(k, t)| (i as u32, k as u32, t.map(|v| to_world.point(vertices[v as usize]))))
                .collect::<Vec<_>>()
        };
        scene.instances().iter().enumerate().flat_map(corners).collect()
    }

    #[test]
    fn masks_filters_sides_and_moves_apply() {
        let mut random = Random(9);
        let meshes = [torus(16, 8), soup(&mut random, 100, 0.3)];
        let trees = meshes.clone().map(|(v, t)| Arc::new(TriangleBvh::build(&v, &t, BuildQuality::Balanced)));
        let instances: Vec<Instance> =
            (0..12).map(|i| Instance::new(trees[i % 2].clone(), map(&mut random)).with_mask(1 << (i % 3))).collect();
        let mut scene = InstanceBvh::new(instances);
        let mut hit_mask = 0;
        for round in 0..400 {
            if round % 50 == 25 {
                let moved = map(&mut random);
                scene.update([(round / 50, moved)]);
                let rebuilt = InstanceBvh::new(scene.instances().to_vec());
                assert_eq!(format!("{:?}", scene.bvh), format!("{:?}", rebuilt.bvh));
            }
            let ray = ray(&meshes[0], &mut random, 1.0, Vec3::ZERO);
            let all = scene.all_hits(&ray);
            for mask in [0, 1, 6, u32::MAX] {
                let is_seen = |hit: &InstanceHit| scene.instances()[hit.instance as usize].mask & mask != 0;
                let first = all.iter().find(|hit| is_seen(hit)).copied();
                assert_eq!(scene.closest_masked(&ray, mask), first, "{ray:?}");
                assert_eq!(scene.occluded_masked(&ray, mask), first.is_some());
                let keep = |hit: &InstanceHit| !(hit.triangle + hit.instance).is_multiple_of(3);
                let first = all.iter().find(|hit| is_seen(hit) && keep(hit)).copied();
                assert_eq!(scene.closest_where(&ray, mask, |hit, _| keep(hit)), first, "{ray:?}");
                assert_eq!(scene.occluded_where(&ray, mask, |hit, _| keep(hit)), first.is_some());
                hit_mask += usize::from(first.is_some());
            }
            let flat = flattened(&scene, &meshes);
            scene.occluded_where(&ray, u32::MAX, |hit, facing| {
                let normal = scene.normal(hit);
                let corners = flat.iter().find(|f| (f.0, f.1) == (hit.instance, hit.triangle)).unwrap().2;
                assert_eq!(scene.corners(hit), Some(corners));
                let cosine = normal.dot(ray.dir.normalize());
                assert!(cosine.abs() < 1e-4 || (cosine < 0.0) == (facing == Facing::Front), "{hit:?} {ray:?}");
                false
            });
            let (mut hits, mut occluded, mut counts) = ([None; 1], [false; 1], [0; 1]);
            scene.closest_batch(&[ray], &mut hits);
            scene.occluded_batch(&[ray], &mut occluded);
            scene.hit_count_batch(&[ray], &mut counts);
            assert_eq!((hits[0], occluded[0], counts[0] as usize), (scene.closest(&ray), !all.is_empty(), all.len()));
            scene.all_hits_batch(&[ray], |_, hits| assert_eq!(hits, all));
        }
        assert!(hit_mask > 100, "{hit_mask}");
    }
}
