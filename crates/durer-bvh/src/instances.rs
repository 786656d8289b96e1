//! Trees of triangles, placed in space as often as wanted.

use super::{Bvh, TraversalCounter, TriangleBvh};
use crate::math::{Aabb, Affine, Ray, Vec2};
use std::sync::Arc;

/// A tree of triangles, and where it is placed.
#[derive(Clone, Debug)]
pub struct Instance {
    /// The triangles, in object space.
    pub tree: Arc<TriangleBvh>,
    /// The map from object space to world space: any that can be inverted, with shear and reflection too.
    pub to_world: Affine,
}

/// Where a ray meets an instance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InstanceHit {
    /// Position along the ray, in units of the length of its direction.
    pub t: f32,
    /// The second and third barycentric coordinate.
    pub uv: Vec2,
    /// Number of the instance.
    pub instance: u32,
    /// Number of the triangle in its tree.
    pub triangle: u32,
}

impl InstanceHit {
    /// Hits are in this order.
    fn key(&self) -> (f32, u32, u32) {
        (self.t, self.instance, self.triangle)
    }
}

/// A tree over instances: each tree of triangles is in memory once, however often it is placed.
///
/// A ray is moved into the space of an instance, in double precision, and rounded once; there it is asked as by
/// [`TriangleBvh`], and so crosses exactly one of the triangles around an edge. Of hits at the same `t` the one of the least
/// instance, and then of the least triangle, is the closest.
///
/// ```
/// use durer_bvh::{Instance, InstanceBvh, BuildQuality, TriangleBvh};
/// use durer_bvh::math::{Affine, Ray, Vec3};
/// use glam::DAffine3;
/// use std::sync::Arc;
///
/// let corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
/// let tree = Arc::new(TriangleBvh::build(&corners, &[[0, 1, 2]], BuildQuality::default()));
/// let placed = [2.0, 5.0].map(|z| Instance {
///     tree: tree.clone(),
///     to_world: Affine::new(DAffine3::from_translation(glam::DVec3::new(0.0, 0.0, z))).unwrap(),
/// });
/// let scene = InstanceBvh::new(placed.into());
/// let ray = Ray::new(Vec3::new(0.2, 0.2, 0.0), Vec3::Z);
/// let hit = scene.closest(&ray).unwrap();
/// assert_eq!((hit.t, hit.instance, hit.triangle), (2.0, 0, 0));
/// assert_eq!(scene.hit_count(&ray), 2);
/// ```
#[derive(Clone, Debug)]
pub struct InstanceBvh {
    placed: Vec<Instance>,
    bvh: Bvh,
}

impl InstanceBvh {
    /// Builds over instances 0, 1, 2, ...; less than 2^28.
    pub fn new(placed: Vec<Instance>) -> Self {
        let bounds = |instance: &Instance| match instance.tree.bounds() {
            empty if empty.is_empty() => Aabb::EMPTY,
            bounds => instance.to_world.bounds(bounds),
        };
        let boxes: Vec<Aabb> = placed.iter().map(bounds).collect();
        InstanceBvh { placed, bvh: Bvh::build(&boxes) }
    }

    /// The instances, by number.
    pub fn placed(&self) -> &[Instance] {
        &self.placed
    }

    /// The box around everything.
    pub fn bounds(&self) -> Aabb {
        self.bvh.bounds()
    }

    /// The first hit in the ray's open interval (`t_min`, `t_max`).
    pub fn closest(&self, ray: &Ray) -> Option<InstanceHit> {
        self.closest_counting(ray, &mut ())
    }

    /// As [`InstanceBvh::closest`], counting nodes and tests in both levels.
    pub fn closest_counting<T: TraversalCounter>(&self, ray: &Ray, counter: &mut T) -> Option<InstanceHit> {
        let (mut best, mut t_max): (Option<InstanceHit>, f32) = (None, ray.t_max);
        self.traverse(ray, counter, |instance, tree, local, counter| {
            if let Some(hit) = tree.closest_counting(&Ray { t_max, ..local }, counter) {
                let hit = InstanceHit { t: hit.t, uv: hit.uv, instance, triangle: hit.triangle };
                if best.is_none_or(|best| hit.key() < best.key()) {
                    best = Some(hit);
                    // One of a lesser number may still be met at the same place.
                    t_max = hit.t.next_up();
                }
            }
            t_max
        });
        best
    }

    /// Whether anything is hit in the ray's open interval.
    pub fn occluded(&self, ray: &Ray) -> bool {
        self.occluded_counting(ray, &mut ())
    }

    /// As [`InstanceBvh::occluded`], counting nodes and tests in both levels.
    pub fn occluded_counting<T: TraversalCounter>(&self, ray: &Ray, counter: &mut T) -> bool {
        let mut occluded = false;
        self.traverse(ray, counter, |_, tree, local, counter| {
            occluded |= tree.occluded_counting(&local, counter);
            if occluded { f32::NEG_INFINITY } else { ray.t_max }
        });
        occluded
    }

    /// All hits in the ray's open interval, by `t`, then by number of the instance, then of the triangle.
    pub fn all_hits(&self, ray: &Ray) -> Vec<InstanceHit> {
        let mut all = Vec::new();
        self.traverse(ray, &mut (), |instance, tree, local, _| {
            let hits = tree.all_hits(&local).into_iter();
            all.extend(hits.map(|hit| InstanceHit { t: hit.t, uv: hit.uv, instance, triangle: hit.triangle }));
            ray.t_max
        });
        all.sort_by(|a, b| a.t.total_cmp(&b.t).then((a.instance, a.triangle).cmp(&(b.instance, b.triangle))));
        all
    }

    /// How many triangles the ray crosses in its open interval.
    pub fn hit_count(&self, ray: &Ray) -> usize {
        self.all_hits(ray).len()
    }

    /// Offers instances with the ray in their space, roughly from near to far; `ask` gives the new `t_max`.
    #[inline]
    fn traverse<T: TraversalCounter>(
        &self,
        ray: &Ray,
        counter: &mut T,
        mut ask: impl FnMut(u32, &TriangleBvh, Ray, &mut T) -> f32,
    ) {
        self.bvh.traverse(ray, counter, |item, _, counter| {
            let number = self.bvh.primitive_indices()[item];
            let Instance { tree, to_world } = &self.placed[number as usize];
            ask(number, tree, to_world.inverse_ray(ray), counter)
        });
    }

    /// Bytes in memory; trees that are placed several times count once.
    pub fn memory_usage(&self) -> usize {
        let mut trees: Vec<&Arc<TriangleBvh>> = self.placed.iter().map(|instance| &instance.tree).collect();
        trees.sort_by_key(|tree| Arc::as_ptr(tree));
        trees.dedup_by_key(|tree| Arc::as_ptr(tree));
        let shared: usize = trees.iter().map(|tree| tree.memory_usage()).sum();
        shared + self.bvh.memory_usage() + size_of_val(&*self.placed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::BuildQuality;
    use crate::math::Vec3;
    use crate::math::random::Random;
    use crate::triangles::tests::{bits, brute_force, ray, soup, torus};
    use glam::{DAffine3, DMat3};

    /// A map that turns, shears, stretches and mirrors.
    fn map(random: &mut Random) -> Affine {
        loop {
            let mut axis = || random.point().as_dvec3();
            let matrix = DMat3::from_cols(axis(), axis(), axis());
            let forward = DAffine3 { matrix3: matrix, translation: 2.0 * axis() };
            // Nearly flat ones lose digits.
            if let Some(map) = Affine::new(forward).filter(|_| matrix.determinant().abs() > 0.05) {
                return map;
            }
        }
    }

    #[test]
    fn instances_are_met_as_their_triangles_are() {
        let mut random = Random(8);
        let meshes = [torus(16, 8), soup(&mut random, 200, 0.3)];
        let trees = meshes.clone().map(|(v, t)| Arc::new(TriangleBvh::build(&v, &t, BuildQuality::Balanced)));
        let mut placed: Vec<Instance> =
            (0..30).map(|i| Instance { tree: trees[i % 2].clone(), to_world: map(&mut random) }).collect();
        // The same thing at the same place: the first is the closest.
        placed.extend_from_within(..4);
        let scene = InstanceBvh::new(placed);
        let mut met = 0;
        for _ in 0..2_000 {
            let ray = ray(&meshes[0], &mut random, 1.0, Vec3::ZERO);
            let mut expected: Vec<(u32, _)> = (0..scene.placed.len())
                .flat_map(|i| {
                    let local = scene.placed[i].to_world.inverse_ray(&ray);
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
            met += usize::from(!expected.is_empty());
        }
        assert!(met > 500, "{met}");
        assert!(scene.memory_usage() < 2 * (trees[0].memory_usage() + trees[1].memory_usage()));
    }

    #[test]
    fn nothing_is_met_where_nothing_is() {
        let empty = Arc::new(TriangleBvh::build(&[], &[], BuildQuality::Fast));
        let ray = Ray::new(Vec3::ZERO, Vec3::X);
        for count in [0, 3] {
            let placed = vec![Instance { tree: empty.clone(), to_world: Affine::IDENTITY }; count];
            let scene = InstanceBvh::new(placed);
            assert_eq!((scene.closest(&ray), scene.occluded(&ray), scene.hit_count(&ray)), (None, false, 0));
            assert!(scene.bounds().is_empty());
        }
        let triangle = TriangleBvh::build(&[Vec3::NEG_ONE, Vec3::X, Vec3::Y], &[[0, 1, 2]], BuildQuality::Fast);
        let scene = InstanceBvh::new(vec![Instance { tree: Arc::new(triangle), to_world: Affine::IDENTITY }]);
        for dir in [Vec3::NAN, Vec3::ZERO, Vec3::INFINITY] {
            assert_eq!(scene.closest(&Ray::new(Vec3::Z, dir)), None);
        }
    }
}
