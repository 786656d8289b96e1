//! Traces rays through each structure of `durer-bvh`, renders pictures with each integrator, and
//! hashes the results, to compare targets: see `.ci/wasm`.
//!
//! Inputs are computed with integers, sums, products, quotients and square roots only, which have
//! the same result on every machine, unlike `sin` and other functions.

#[path = "pictures.rs"]
mod pictures;

use durer_bvh::glam::{DAffine3, DMat3, DVec3};
use durer_bvh::math::random::Random;
use durer_bvh::math::{Aabb, Affine, Ray, Vec3};
use durer_bvh::watertight::WatertightRay;
use durer_bvh::{BuildQuality, InstanceHit, SimdLevel, TriangleBvh, TriangleHit};
use durer_bvh::{Bvh, Facing, Grid, HeightGrid, Instance, InstanceBvh, PackHit, PrimitivePacks};
use std::sync::{Arc, OnceLock};

/// Number of rays per part.
const RAYS: usize = 10_000;

/// Name of a part, and a function that returns the hash of its results.
type Part = (&'static str, fn() -> u64);

/// The parts.
pub const PARTS: [Part; 14] = [
    ("trees", trees),
    ("single", single),
    ("packets", packets),
    ("streams", streams),
    ("nearest", nearest),
    ("refit", refit),
    ("triangles", triangles),
    ("instances", instances),
    ("heights", heights),
    ("boxes", boxes),
    ("packs", packs),
    ("whitted", pictures::whitted),
    ("path", pictures::path),
    ("photons", pictures::photons),
];

/// Number of parts.
#[unsafe(no_mangle)]
pub extern "C" fn part_count() -> usize {
    PARTS.len()
}

/// Address of a part's name.
#[unsafe(no_mangle)]
pub extern "C" fn name(part: usize) -> *const u8 {
    PARTS[part].0.as_ptr()
}

/// Length of a part's name in bytes.
#[unsafe(no_mangle)]
pub extern "C" fn name_length(part: usize) -> usize {
    PARTS[part].0.len()
}

/// Hash of a part.
#[unsafe(no_mangle)]
pub extern "C" fn hash(part: usize) -> u64 {
    PARTS[part].1()
}

/// Returns 1 if traversal uses `simd128`, else 0.
#[unsafe(no_mangle)]
pub extern "C" fn simd128() -> u32 {
    (SimdLevel::chosen() == SimdLevel::Simd128).into()
}

/// A mesh of 101,568 triangles, and the rays to time.
static TIMED: OnceLock<(TriangleBvh, Vec<Ray>)> = OnceLock::new();

/// Prepares [`shoot`] with this number of rays.
#[unsafe(no_mangle)]
pub extern "C" fn prepare(rays: usize) {
    TIMED.get_or_init(|| {
        let mesh = planet(92);
        let mut random = Random(1);
        (mesh.tree(BuildQuality::Best), (0..rays).map(|_| through(&mut random)).collect())
    });
}

/// Traces the rays of [`prepare`] one by one and returns the number of hits.
#[unsafe(no_mangle)]
pub extern "C" fn shoot() -> usize {
    let (tree, rays) = TIMED.get().expect("call `prepare` first");
    rays.iter().filter(|ray| tree.closest(ray).is_some()).count()
}

/// A 64-bit hash.
struct Hash(u64);

impl Hash {
    fn new() -> Self {
        Hash(0x243f_6a88_85a3_08d3)
    }

    fn add(&mut self, word: u64) {
        self.0 = (self.0 ^ word).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29);
    }

    fn floats(&mut self, floats: impl IntoIterator<Item = f32>) {
        floats.into_iter().for_each(|x| self.add(x.to_bits().into()));
    }

    /// Adds a hit. Returns 1 for a hit and 0 for a miss.
    fn hit(&mut self, hit: Option<TriangleHit>) -> usize {
        let Some(TriangleHit { t, uv, triangle }) = hit else {
            self.add(u64::MAX);
            return 0;
        };
        self.add(triangle.into());
        self.floats([t, uv.x, uv.y]);
        1
    }

    fn instance_hit(&mut self, hit: Option<InstanceHit>) -> usize {
        let Some(InstanceHit { t, uv, instance, triangle }) = hit else { return self.hit(None) };
        self.add(instance.into());
        self.hit(Some(TriangleHit { t, uv, triangle }))
    }

    fn pack_hit(&mut self, hit: Option<PackHit>) -> usize {
        self.add(hit.map_or(u64::MAX, |hit| u64::from(hit.number) << 32 | u64::from(hit.t.to_bits())));
        hit.is_some().into()
    }

    /// Returns the hash. Panics if too few or all rays hit, since such a part would test little.
    fn of(self, hits: usize, rays: usize) -> u64 {
        assert!(hits > rays / 4 && hits < rays, "{hits} of {rays}");
        self.0
    }
}

/// A mesh.
struct Mesh {
    vertices: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
}

impl Mesh {
    fn of(corners: Vec<[Vec3; 3]>) -> Self {
        let triangles = (0..corners.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        Mesh { vertices: corners.into_flattened(), triangles }
    }

    fn tree(&self, quality: BuildQuality) -> TriangleBvh {
        TriangleBvh::build(&self.vertices, &self.triangles, quality)
    }

    fn corners(&self, triangle: usize) -> [Vec3; 3] {
        self.triangles[triangle].map(|i| self.vertices[i as usize])
    }
}

/// Returns a bumpy ball around the origin: a closed mesh of 12 `cells`² triangles with radii from 1
/// to 1.1.
fn planet(cells: u32) -> Mesh {
    let vertex = |at: [u32; 3]| {
        let bump = Random(at.iter().fold(7, |seed, &i| seed << 16 | u64::from(i))).unit();
        let cube = Vec3::from(at.map(|i| 2.0 * i as f32 / cells as f32 - 1.0));
        (1.0 + 0.1 * bump) * cube.normalize()
    };
    let mut corners = Vec::new();
    for side in 0..6 {
        let (axis, upper) = (side % 3, side / 3);
        for (i, j) in (0..cells).flat_map(|i| (0..cells).map(move |j| (i, j))) {
            let at = |i: u32, j: u32| {
                let mut at = [upper * cells; 3];
                (at[(axis as usize + 1) % 3], at[(axis as usize + 2) % 3]) = (i, j);
                vertex(at)
            };
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            corners.extend(if upper == 1 { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] });
        }
    }
    Mesh::of(corners)
}

/// Returns random triangles, some of them long, which [`BuildQuality::Best`] splits.
fn soup(random: &mut Random, count: usize) -> Mesh {
    let mut triangle = |i: usize| {
        let (a, size) = (random.point(), if i.is_multiple_of(20) { 1.0 } else { 0.1 });
        [a, a + size * random.point(), a + 0.1 * random.point()]
    };
    Mesh::of((0..count).map(&mut triangle).collect())
}

/// Returns a ray from a sphere of radius 2 to a point in the cube from -1 to 1.
fn through(random: &mut Random) -> Ray {
    let origin = 2.0 * random.direction();
    Ray::new(origin, random.point() - origin)
}

/// Returns a random ray. Some rays go through vertices or edges, along axes, have limits, or
/// contain very small numbers, very large numbers or NaN.
fn ray(mesh: &Mesh, random: &mut Random) -> Ray {
    let [a, b, c] = mesh.corners(random.below(mesh.triangles.len()));
    let ray = through(random);
    let to = |target: Vec3| Ray::new(ray.origin, target - ray.origin);
    match random.below(16) {
        0 => to(a),
        1 => to(0.5 * (a + b)),
        2 => to(b + random.unit() * (c - b)),
        3 => {
            let mut dir = Vec3::ZERO;
            dir[random.below(3)] = if random.below(2) == 0 { 1.0 } else { -1.0 };
            Ray::new(a - 3.0 * dir, dir)
        }
        4 => Ray { t_min: random.unit(), t_max: 0.5 + random.unit(), ..ray },
        5 => Ray { t_min: f32::NEG_INFINITY, ..Ray::new(random.point(), random.direction()) },
        6 => Ray::new(ray.origin, [1e-30, 1e-42, 1e30][random.below(3)] * ray.dir),
        7 => Ray::new(ray.origin.with_x([f32::NAN, 1e30, 1e-40][random.below(3)]), ray.dir),
        _ => ray,
    }
}

fn rays(mesh: &Mesh, seed: u64) -> Vec<Ray> {
    let mut random = Random(seed);
    (0..RAYS).map(|_| ray(mesh, &mut random)).collect()
}

fn meshes() -> [Mesh; 2] {
    [planet(20), soup(&mut Random(2), 5_000)]
}

const QUALITIES: [BuildQuality; 3] = [BuildQuality::Fast, BuildQuality::Balanced, BuildQuality::Best];

/// Serializes trees and reads them back.
fn trees() -> u64 {
    let mut hash = Hash::new();
    for mesh in meshes() {
        for quality in QUALITIES {
            let bytes = mesh.tree(quality).to_bytes();
            bytes.iter().for_each(|&byte| hash.add(byte.into()));
            let loaded = TriangleBvh::from_bytes(&bytes).expect("saved by `to_bytes`");
            assert!(loaded.to_bytes() == bytes);
        }
    }
    hash.0
}

/// Single rays: closest hit, any hit, all hits, and filtered hits.
fn single() -> u64 {
    let (mut hash, mut hits) = (Hash::new(), 0);
    for mesh in meshes() {
        let (tree, rays) = (mesh.tree(BuildQuality::Best), rays(&mesh, 3));
        for ray in &rays {
            let hit = tree.closest(ray);
            hits += hash.hit(hit);
            hash.floats(hit.map_or(Vec3::ZERO, |hit| tree.normal(&hit)).to_array());
            hash.add(tree.occluded(ray).into());
            tree.all_hits(ray).into_iter().for_each(|hit| _ = hash.hit(Some(hit)));
            let filter = |hit: &TriangleHit, facing| facing == Facing::Back && !hit.triangle.is_multiple_of(3);
            hash.hit(tree.closest_where(ray, filter));
            hash.add(tree.occluded_where(ray, filter).into());
        }
    }
    // Rays from inside leave a closed mesh exactly once, also through vertices and edges.
    let mesh = planet(20);
    let tree = mesh.tree(BuildQuality::Fast);
    for [a, b, c] in (0..mesh.triangles.len()).map(|i| mesh.corners(i)) {
        for target in [a, 0.5 * (a + b), (a + b + c) / 3.0] {
            assert_eq!(tree.hit_count(&Ray::new(Vec3::ZERO, target)), 1, "{target}");
        }
    }
    hash.of(hits, 2 * RAYS)
}

/// Hashes the results of a batch, also for rays with limits.
fn batch(hash: &mut Hash, tree: &TriangleBvh, rays: &[Ray]) -> usize {
    let (mut hits, mut occluded) = (vec![None; rays.len()], vec![false; rays.len()]);
    tree.closest_batch(rays, &mut hits);
    tree.occluded_batch(rays, &mut occluded);
    occluded.into_iter().for_each(|occluded| hash.add(occluded.into()));
    hits.into_iter().map(|hit| hash.hit(hit)).sum()
}

/// Camera rays in tiles of 8 × 8, which traverse the tree as packets.
fn packets() -> u64 {
    let (mut hash, mut hits) = (Hash::new(), 0);
    let mut rays = Vec::new();
    for (row, column) in (0..12).flat_map(|row| (0..13).map(move |column| (row, column))) {
        for (y, x) in (0..8).flat_map(|y| (0..8).map(move |x| (y, x))) {
            let [x, y] = [8 * column + x - 52, 8 * row + y - 48].map(|i| i as f32 / 100.0);
            rays.push(Ray::new(Vec3::new(0.2, 0.3, 2.5), Vec3::new(x - 0.08, y - 0.12, -1.0)));
        }
    }
    for mesh in meshes() {
        hits += batch(&mut hash, &mesh.tree(BuildQuality::Balanced), &rays);
    }
    hash.of(hits, 2 * rays.len())
}

/// Incoherent rays in a tree large enough for the stream traversal.
fn streams() -> u64 {
    let mut hash = Hash::new();
    let mesh = planet(130);
    let tree = mesh.tree(BuildQuality::Fast);
    assert!(tree.memory_usage() > 8 << 20, "{}", tree.memory_usage());
    let hits = batch(&mut hash, &tree, &rays(&mesh, 4));
    hash.of(hits, RAYS)
}

/// Closest points of meshes to query points, some with a maximum distance.
fn nearest() -> u64 {
    let (mut hash, mut random, mut found) = (Hash::new(), Random(5), 0);
    for mesh in meshes() {
        let tree = mesh.tree(BuildQuality::Balanced);
        for i in 0..RAYS {
            let within = if i % 4 == 0 { 0.1 } else { f64::INFINITY };
            let Some(near) = tree.nearest_point(1.5 * random.point(), within) else { continue };
            hash.add(near.triangle.into());
            hash.add(near.distance.to_bits());
            near.uv.into_iter().chain(near.point.to_array().map(f64::from)).for_each(|x| hash.add(x.to_bits()));
            found += 1;
        }
    }
    hash.of(found, 2 * RAYS)
}

/// Rays in a tree after its vertices moved.
fn refit() -> u64 {
    let (mut hash, mut random) = (Hash::new(), Random(6));
    let mut mesh = soup(&mut random, 5_000);
    let mut tree = mesh.tree(BuildQuality::Best);
    mesh.vertices.iter_mut().for_each(|v| *v += 0.05 * random.point());
    tree.refit(&mesh.vertices, &mesh.triangles);
    let hits = rays(&mesh, 7).iter().map(|ray| hash.hit(tree.closest(ray))).sum();
    hash.of(hits, RAYS)
}

/// Single triangles and single rays.
fn triangles() -> u64 {
    let (mut hash, mut hits) = (Hash::new(), 0);
    let (mesh, mut random) = (soup(&mut Random(8), 100), Random(9));
    for _ in 0..RAYS {
        // Three of four rays go through the triangle.
        let (ray, corners) = (ray(&mesh, &mut random), mesh.corners(random.below(100)));
        let [a, b, c] = corners;
        let target = a + 0.5 * random.unit() * (b - a) + 0.5 * random.unit() * (c - a);
        let ray = if random.below(4) == 0 { ray } else { Ray::new(ray.origin, target - ray.origin) };
        if let Some(crossing) = WatertightRay::new(&ray).intersect(corners, ray.t_min, ray.t_max) {
            hash.floats([crossing.t, crossing.uv.x, crossing.uv.y]);
            hits += 1;
        } else {
            hash.add(0);
        }
    }
    hash.of(hits, RAYS)
}

/// Instances of meshes that are rotated, scaled, mirrored and translated.
fn instances() -> u64 {
    let (mut hash, mut random) = (Hash::new(), Random(10));
    let trees = [planet(8), soup(&mut random, 500)].map(|mesh| Arc::new(mesh.tree(BuildQuality::Best)));
    let placed = (0..50).map(|i| {
        let mut axis = || 0.2 * random.point().as_dvec3();
        let linear = DMat3::from_cols(axis() + 0.3 * DVec3::X, axis() + 0.3 * DVec3::Y, axis() - 0.3 * DVec3::Z);
        let map = DAffine3::from_mat3_translation(linear, random.point().as_dvec3());
        Instance::new(trees[i % 2].clone(), Affine::new(map).expect("no flat map")).with_mask(1 << (i % 3))
    });
    let all = InstanceBvh::new(placed.collect());
    let rays = rays(&planet(8), 11);
    let mut hits = 0;
    for ray in &rays {
        hits += hash.instance_hit(all.closest(ray));
        hash.instance_hit(all.closest_masked(ray, 0b101));
        hash.add(all.occluded(ray).into());
        all.all_hits(ray).into_iter().for_each(|hit| _ = hash.instance_hit(Some(hit)));
    }
    let mut batch = vec![None; RAYS];
    all.closest_batch(&rays, &mut batch);
    batch.into_iter().for_each(|hit| _ = hash.instance_hit(hit));
    hash.of(hits, RAYS)
}

/// A height field with a ball on it.
fn heights() -> u64 {
    let (mut hash, mut random) = (Hash::new(), Random(12));
    let lines = || (0..=60).map(|i| i as f32 / 30.0 - 1.0).collect::<Vec<_>>();
    let heights = (0..61 * 61).map(|_| 0.1 * random.unit()).collect();
    let grid = Arc::new(HeightGrid::new(lines(), lines(), heights).expect("61 by 61 heights"));
    let ball = planet(4);
    let others: Vec<[Vec3; 3]> =
        (0..ball.triangles.len()).map(|i| ball.corners(i).map(|corner| 0.4 * (corner + Vec3::Y))).collect();
    let tree = TriangleBvh::over_heights(grid, &others, BuildQuality::Balanced).expect("few triangles");
    let rays = rays(&Mesh::of(others), 13);
    let single = rays.iter().map(|ray| hash.hit(tree.closest(ray))).sum();
    let together = batch(&mut hash, &tree, &rays);
    assert_eq!(single, together);
    hash.of(single, RAYS)
}

/// Returns the closest hit of a ray with a sphere between `t_min` and `t_max`.
fn sphere(ray: &Ray, center: Vec3, radius: f32) -> Option<f32> {
    let (o, d) = (ray.origin.as_dvec3() - center.as_dvec3(), ray.dir.as_dvec3());
    let (a, b, c) = (d.dot(d), o.dot(d), o.dot(o) - f64::from(radius) * f64::from(radius));
    let root = (b * b - a * c).sqrt();
    [-b - root, -b + root].into_iter().map(|x| (x / a) as f32).find(|t| ray.contains(*t))
}

fn spheres() -> Vec<(Vec3, f32)> {
    let mut random = Random(14);
    (0..2_000).map(|_| (random.point(), random.between(0.01, 0.05))).collect()
}

/// Custom primitives in a tree of boxes and in a grid. The offered boxes may differ between SIMD
/// levels; the closest sphere may not.
fn boxes() -> u64 {
    let (mut hash, mut hits) = (Hash::new(), 0);
    let objects = spheres();
    let boxes: Vec<Aabb> = objects.iter().map(|&(c, r)| Aabb { min: c - 1.001 * r, max: c + 1.001 * r }).collect();
    let tree = Bvh::build(&boxes);
    let grid = Grid::build(tree.bounds(), Grid::suggested_resolution(tree.bounds(), boxes.len()), &boxes, |_, _| true);
    let grid = grid.expect("few cells");
    for ray in rays(&planet(8), 15) {
        let mut found = [None; 2];
        let closer = |found: &mut Option<(f32, usize)>, item: usize, t_max: f32| {
            let (center, radius) = objects[item];
            let Some(t) = sphere(&ray, center, radius).filter(|t| *t <= t_max) else { return t_max };
            *found = Some(found.map_or((t, item), |old| if (t, item) < old { (t, item) } else { old }));
            t
        };
        let order = tree.primitive_indices();
        tree.traverse(&ray, &mut (), |i, t_max, _| closer(&mut found[0], order[i] as usize, t_max));
        grid.traverse(&ray, &mut (), |item, t_max, _| closer(&mut found[1], item, t_max));
        for found in found {
            let word = |(t, item): (f32, usize)| u64::from(t.to_bits()) << 32 | item as u64;
            hash.add(found.map_or(u64::MAX, word));
            hits += usize::from(found.is_some());
        }
    }
    hash.of(hits, 2 * RAYS)
}

/// Planes, spheres, discs, rectangles and boxes: eight per ray, and one per eight rays.
fn packs() -> u64 {
    let (mut hash, mut random, mut hits) = (Hash::new(), Random(16), 0);
    let mut packs = PrimitivePacks::default();
    packs.push_plane(0, random.direction(), -2.5);
    for number in (0..30).map(|i| 5 * i + 1) {
        packs.push_sphere(number, random.point(), 0.1 * random.unit());
        let normal = random.direction().as_dvec3().normalize();
        packs.push_disc(number + 1, random.point(), normal, [0.05 * random.unit(), 0.2 * random.unit()]);
        packs.push_rectangle(number + 2, random.point(), [0.2 * random.point(), 0.2 * random.point()]);
        let corner = random.point();
        packs.push_box(number + 3, corner, corner + 0.1 * random.point().abs());
    }
    let rays: Vec<Ray> = (0..RAYS).map(|_| through(&mut random)).collect();
    for eight in rays.as_chunks::<8>().0 {
        for ray in eight {
            hits += hash.pack_hit(packs.closest(ray, &mut ()));
            hash.add(packs.occluded(ray, &mut ()).into());
        }
        packs.closest_of_eight(eight.each_ref()).into_iter().for_each(|hit| _ = hash.pack_hit(hit));
    }
    hash.of(hits, RAYS)
}
