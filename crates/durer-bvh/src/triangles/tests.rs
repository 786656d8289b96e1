//! Tests triangle trees against brute force, at every SIMD level and build quality.

use super::*;
use crate::BuildQuality;
use crate::math::random::{Random, rounds};
use crate::math::{Vec2, Vec3};
use crate::tests::codes_are_right;
use crate::traverse::is_valid;

mod heights;
mod queries;
mod reference;

/// A test mesh: its vertices, and the vertex indices of its triangles.
pub type Mesh = (Vec<Vec3>, Vec<[u32; 3]>);

/// Returns a torus in which neighbouring triangles share corners with the same bits.
pub fn torus(columns: u32, rows: u32) -> Mesh {
    let turn = |i: u32, count: u32| crate::math::fp::sin_cos_degrees(360.0 * f64::from(i) / f64::from(count));
    let mut mesh: Mesh = Default::default();
    for i in 0..columns {
        for j in 0..rows {
            let ((s, c), (t, d)) = (turn(i, columns), turn(j, rows));
            let r = 0.7 + 0.3 * d;
            mesh.0.push(Vec3::new((r * c) as f32, (0.3 * t) as f32, (r * s) as f32));
            let at = |i: u32, j: u32| i % columns * rows + j % rows;
            mesh.1.extend([[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]);
        }
    }
    mesh
}

/// Returns a cube with `cuts`^2 squares on each face. Axis-parallel rays can lie in its faces and
/// edges.
fn cube(cuts: u32) -> Mesh {
    let mut mesh: Mesh = Default::default();
    for face in 0..6 {
        let first = mesh.0.len() as u32;
        for i in 0..=cuts {
            for j in 0..=cuts {
                let [u, v] = [i, j].map(|k| 2.0 * k as f32 / cuts as f32 - 1.0);
                let corner =
                    [[1.0, u, v], [-1.0, v, u], [v, 1.0, u], [u, -1.0, v], [u, v, 1.0], [v, u, -1.0]][face as usize];
                mesh.0.push(corner.into());
                if i < cuts && j < cuts {
                    let at = |i: u32, j: u32| first + i * (cuts + 1) + j;
                    let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                    mesh.1.extend([[a, b, c], [a, c, d]]);
                }
            }
        }
    }
    mesh
}

/// Unrelated random triangles.
pub fn soup(random: &mut Random, count: u32, size: f32) -> Mesh {
    let corners = |_| {
        let place = random.point();
        [(); 3].map(|()| place + size * random.point())
    };
    let vertices = (0..count).flat_map(corners).collect();
    (vertices, (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect())
}

/// Small triangles, and long ones that pass through all of them. The build splits some of the long
/// ones.
pub fn bars(random: &mut Random, small: u32, long: usize) -> Mesh {
    let (mut vertices, mut triangles) = soup(random, small, 0.05);
    for i in 0..long {
        let (first, middle) = (vertices.len() as u32, random.point());
        let along = if i % 2 == 0 { random.direction() } else { Vec3::AXES[i / 2 % 3] };
        vertices.extend([middle - along, middle + along, middle + 0.05 * random.point()]);
        triangles.push([first, first + 1, first + 2]);
    }
    (vertices, triangles)
}

/// Meshes that are difficult for a tree, each with a name.
fn hard() -> Vec<(&'static str, Mesh)> {
    let mut random = Random(7);
    let grow = |i: u32| libm::pow(1.3, f64::from(i % 400) - 200.0) as f32;
    let series = (0..400).flat_map(|i| [Vec3::ZERO, grow(i) * Vec3::X, grow(i) * Vec3::new(0.3, 1.0, 0.2)]);
    let slivers = (0..2000).flat_map(|_| {
        let (p, along) = (random.point(), random.direction());
        [p, p + along, p + 0.5 * along + 1e-6 * random.point()]
    });
    let apart = |count: u32| (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect::<Vec<_>>();
    let slivers: Vec<Vec3> = slivers.collect();
    let points: Vec<Vec3> = (0..300).map(|_| random.point()).collect();
    let bad = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::splat(f32::NAN), Vec3::splat(f32::INFINITY)];
    vec![
        ("identical", (vec![Vec3::NEG_ONE, Vec3::X, Vec3::Y], vec![[0, 1, 2]; 20_000])),
        ("series of sizes", (series.collect(), apart(400))),
        ("slivers", (slivers, apart(2000))),
        ("without area", (points, (0..300).map(|i| [i, (7 * i) % 300, i]).collect())),
        ("not finite", (bad, vec![[0, 1, 2], [0, 1, 3], [0, 4, 2]])),
        ("one", (vec![Vec3::NEG_ONE, Vec3::X, Vec3::Y], vec![[0, 1, 2]])),
        ("none", Default::default()),
        ("soup", soup(&mut random, 3_000, 0.2)),
        ("large soup", soup(&mut random, 300, 3.0)),
        ("bars", bars(&mut random, 400, 100)),
        ("many bars", bars(&mut random, 6_000, 300)),
        ("torus", torus(40, 20)),
        ("cube", cube(5)),
    ]
}

fn scaled((vertices, triangles): &Mesh, scale: f32, offset: Vec3) -> Mesh {
    (vertices.iter().map(|v| scale * *v + offset).collect(), triangles.clone())
}

/// Rays of all kinds around a mesh: aimed at vertices, edges, and faces, parallel to axes, short,
/// long, and with special numbers.
pub fn ray((vertices, triangles): &Mesh, random: &mut Random, scale: f32, offset: Vec3) -> Ray {
    let mut goal = offset + scale * random.point();
    if !triangles.is_empty() {
        let [a, b, c] = triangles[random.below(triangles.len())].map(|i| vertices[i as usize]);
        goal = [a, 0.5 * (a + b), a + random.unit() * (b - a), (a + b + c) / 3.0, goal][random.below(5)];
    }
    let from = offset + scale * [0.5, 2.0, 100.0][random.below(3)] * random.point();
    let mut ray = Ray::new(from, random.between(0.1, 8.0) * (goal - from));
    if random.below(3) == 0 {
        ray.dir = scale * random.between(-2.0, 2.0) * Vec3::AXES[random.below(3)];
        ray.origin = goal - ray.dir * random.between(-1.0, 3.0);
    }
    match random.below(12) {
        0 => ray.dir[random.below(3)] = [0.0, -0.0, 1e-42, f32::MIN_POSITIVE][random.below(4)],
        1 => ray.t_min = f32::NEG_INFINITY,
        2 => (ray.t_min, ray.t_max) = (random.between(-0.2, 0.3), random.between(0.0, 1.0)),
        _ => {}
    }
    ray
}

/// Finds every hit without a tree.
pub fn brute_force((vertices, triangles): &Mesh, ray: &Ray) -> Vec<TriangleHit> {
    if !is_valid(ray) {
        return Vec::new();
    }
    let sheared = WatertightRay::new(ray);
    let hit = |(i, t): (usize, &[u32; 3])| {
        let corners = t.map(|i| vertices[i as usize]);
        let crossing =
            sheared.intersect(corners, ray.t_min, ray.t_max).filter(|_| corners.iter().all(|c| c.is_finite()))?;
        Some(TriangleHit { t: crossing.t, uv: crossing.uv, triangle: i as u32 })
    };
    let mut hits: Vec<TriangleHit> = triangles.iter().enumerate().filter_map(hit).collect();
    hits.sort_by(|a, b| a.t.total_cmp(&b.t).then(a.triangle.cmp(&b.triangle)));
    hits
}

pub fn bits(hit: &TriangleHit) -> (u32, [u32; 2], u32) {
    (hit.t.to_bits(), hit.uv.to_array().map(f32::to_bits), hit.triangle)
}

#[test]
fn every_tree_at_every_level_finds_what_brute_force_finds() {
    let mut random = Random(1);
    let mut found = 0;
    for (name, mesh) in hard() {
        for (scale, offset) in
            [(1.0, Vec3::ZERO), (1.0, Vec3::new(1e4, -3e3, 7e4)), (1e-30, Vec3::ZERO), (1e30, Vec3::ZERO)]
        {
            let mesh = scaled(&mesh, scale, offset);
            let trees: Vec<(String, TriangleBvh)> = BuildQuality::NAMES
                .into_iter()
                .flat_map(|(word, quality)| {
                    let tree = TriangleBvh::build(&mesh.0, &mesh.1, quality);
                    SimdLevel::available().map(move |level| (format!("{word} {level:?}"), tree.clone().at_level(level)))
                })
                .collect();
            let rays = if mesh.1.len() > 5_000 { 20 } else { 120 };
            for _ in 0..rays {
                let ray = ray(&mesh, &mut random, scale, offset);
                let expected = brute_force(&mesh, &ray);
                found += expected.len().min(1);
                for (kind, tree) in &trees {
                    let context = || format!("{name} {scale} {offset} {kind} {ray:?}");
                    assert_eq!(tree.closest(&ray).as_ref().map(bits), expected.first().map(bits), "{}", context());
                    assert_eq!(tree.occluded(&ray), !expected.is_empty(), "{}", context());
                    let all: Vec<_> = tree.all_hits(&ray).iter().map(bits).collect();
                    assert_eq!(all, expected.iter().map(bits).collect::<Vec<_>>(), "{}", context());
                }
            }
        }
    }
    assert!(found > 1_000, "{found}");
}

#[test]
fn closed_mesh_has_even_crossings_from_outside_and_odd_from_inside() {
    let (mut random, mut counted) = (Random(2), 0);
    let shapes = [(torus(60, 30), Vec3::new(0.7, 0.0, 0.0)), (cube(8), Vec3::ZERO)];
    for distance in [0.0, 1e3, 1e6] {
        for (mesh, inside) in &shapes {
            // The mesh stays closed because shared corners are rounded in the same way.
            let offset = (distance * random.direction()).round();
            let scale = if distance > 1e5 { 64.0 } else { 1.0 };
            let mesh = scaled(mesh, scale, offset);
            let tree = TriangleBvh::build(&mesh.0, &mesh.1, BuildQuality::Best);
            for round in 0..rounds(2_000) {
                let [a, b, c] = mesh.1[random.below(mesh.1.len())].map(|i| mesh.0[i as usize]);
                let goal = [a, 0.5 * (a + b), a + random.unit() * (b - a), (a + b + c) / 3.0][round % 4];
                let outside = offset + scale * [3.0, 1e3][round / 4 % 2] * random.direction();
                assert!(tree.hit_count(&Ray::new(outside, goal - outside)).is_multiple_of(2), "{outside} {goal}");
                let start = scale * *inside + offset;
                for dir in [goal - start, Vec3::AXES[round % 3], -Vec3::AXES[round % 3]] {
                    assert!(tree.hit_count(&Ray::new(start, dir)) % 2 == 1, "{start} {dir}");
                }
                counted += 4;
            }
        }
    }
    println!("{counted} rays at vertices, edges and centroids: no ray is lost and all counts are right");
}

#[test]
fn refitted_tree_finds_what_brute_force_finds() {
    let mut random = Random(3);
    let mesh = torus(30, 15);
    for quality in [BuildQuality::Fast, BuildQuality::Best] {
        let mut tree = TriangleBvh::build(&mesh.0, &mesh.1, quality);
        for round in 1..6 {
            let bent = |v: &Vec3| *v + 0.1 * round as f32 * Vec3::new(v.y, v.z * v.x, -v.x) + Vec3::Y * round as f32;
            let mut moved: Mesh = (mesh.0.iter().map(bent).collect(), mesh.1.clone());
            // In some rounds, some vertices have non-finite coordinates. Later they become finite
            // again.
            match round {
                2 => moved.0[50..250].fill(Vec3::NAN),
                4 => moved.0[..100].fill(Vec3::new(0.0, f32::INFINITY, 1.0)),
                _ => {}
            }
            tree.refit(&moved.0, &moved.1);
            assert!(tree.nodes.iter().all(codes_are_right));
            for _ in 0..200 {
                let ray = ray(&moved, &mut random, 1.0, Vec3::Y * round as f32);
                let expected = brute_force(&moved, &ray);
                assert_eq!(tree.closest(&ray).as_ref().map(bits), expected.first().map(bits));
                assert_eq!(tree.occluded(&ray), !expected.is_empty());
            }
        }
    }
}

/// Even if sums of coordinates overflow, hits have valid triangle numbers.
#[test]
fn largest_offsets_lead_to_triangles() {
    let mut random = Random(5);
    let mesh = torus(12, 6);
    let huge: Mesh = (mesh.0.iter().map(|v| *v / 1.5 * 3e38).collect(), mesh.1.clone());
    for level in SimdLevel::available() {
        let tree = TriangleBvh::build(&huge.0, &huge.1, BuildQuality::Balanced).at_level(level);
        for _ in 0..2_000 {
            let ray = Ray { t_max: f32::INFINITY, ..Ray::new(3e38 * random.point(), random.point()) };
            let all = tree.all_hits(&ray);
            assert!(all.iter().all(|hit| (hit.triangle as usize) < huge.1.len()), "{ray:?} {all:?}");
        }
    }
}

/// Returns a bundle of neighbouring rays, either parallel or through one point, aimed at corners,
/// edges, and faces. It often spans several octants, and some rays have special values.
fn bundle(mesh: &Mesh, random: &mut Random, scale: f32, offset: Vec3) -> Vec<Ray> {
    let middle = ray(mesh, random, scale, offset);
    let count = 1 + random.below(150);
    let width = [0.0, 1e-6, 0.02, 0.3, 2.0][random.below(5)];
    let (parallel, odd) = (random.below(3) == 0, random.below(3) == 0);
    let neighbour = |_| {
        let across = width * middle.dir.length() * random.point();
        let mut next = match parallel {
            true => Ray { origin: middle.origin + across, ..middle },
            false => Ray { dir: middle.dir + across, ..middle },
        };
        if !mesh.1.is_empty() && random.below(4) == 0 {
            let [a, b, _] = mesh.1[random.below(mesh.1.len())].map(|i| mesh.0[i as usize]);
            next.dir = [a, 0.5 * (a + b)][random.below(2)] - next.origin;
        }
        if odd && random.below(30) == 0 {
            match random.below(5) {
                0 => next.dir[random.below(3)] = f32::NAN,
                1 => next.t_max = next.t_min,
                2 => next.origin.x = [f32::INFINITY, f32::NAN, 1e30][random.below(3)],
                3 => next.dir = Vec3::ZERO,
                _ => next.dir[random.below(3)] = 0.0,
            }
        }
        next
    };
    (0..count).map(neighbour).collect()
}

#[test]
fn batches_answer_like_single_rays() {
    let (mut random, mut hit_mask) = (Random(4), 0);
    for (name, mesh) in hard() {
        for (scale, offset) in [(1.0, Vec3::ZERO), (1.0, Vec3::new(1e4, -3e3, 7e4)), (1e-30, Vec3::ZERO)] {
            let mesh = scaled(&mesh, scale, offset);
            let tree = TriangleBvh::build(&mesh.0, &mesh.1, BuildQuality::Best);
            let size = f64::from(scale);
            let culls_slivers = tree.clone().min_volume(0.01 * size * size * size);
            let trees: Vec<_> =
                SimdLevel::available().map(|level| tree.clone().at_level(level)).chain([culls_slivers]).collect();
            for round in 0..rounds(4) {
                let mut rays: Vec<Ray> = (0..3).flat_map(|_| bundle(&mesh, &mut random, scale, offset)).collect();
                // A few rays are enough for large meshes.
                rays.truncate(if mesh.1.len() > 5_000 { 40 } else { rays.len() });
                if round == 0 && mesh.1.len() < 5_000 {
                    rays = (0..100).map(|_| ray(&mesh, &mut random, scale, offset)).collect();
                }
                let (mut hits, mut occluded) = (vec![None; rays.len()], vec![false; rays.len()]);
                for tree in &trees {
                    // Also pass the rays in parts, because after incoherent rays some rays skip the
                    // coherence test.
                    let part = [64, usize::MAX][round % 2];
                    rays.chunks(part).zip(hits.chunks_mut(part)).for_each(|(rays, to)| tree.closest_batch(rays, to));
                    rays.chunks(part)
                        .zip(occluded.chunks_mut(part))
                        .for_each(|(rays, to)| tree.occluded_batch(rays, to));
                    // Also trace the rays as a stream, which large trees do.
                    let (numbers, mut streamed) = ((0..rays.len() as u32).collect::<Vec<_>>(), hits.clone());
                    tree.stream::<ClosestHit>(&rays, &numbers, |i, hit| streamed[i] = hit);
                    tree.stream::<AnyHit>(&rays, &numbers, |i, any| assert_eq!(any, occluded[i], "{name}"));
                    assert_eq!(format!("{streamed:?}"), format!("{hits:?}"), "{name}");
                    for (i, ray) in rays.iter().enumerate() {
                        let (hit, context) = (tree.closest(ray), || format!("{name} {scale} {offset} {i} {ray:?}"));
                        assert_eq!(hits[i].as_ref().map(bits), hit.as_ref().map(bits), "{}", context());
                        assert_eq!(occluded[i], tree.occluded(ray), "{}", context());
                        hit_mask += usize::from(occluded[i]);
                    }
                }
            }
        }
    }
    assert!(hit_mask > 13_000, "{hit_mask}");
}

#[test]
fn axis_parallel_rays_go_together_and_hit_correctly() {
    let mesh = torus(40, 20);
    let tree = TriangleBvh::build(&mesh.0, &mesh.1, BuildQuality::Best);
    let trees: Vec<_> = SimdLevel::available().map(|level| tree.clone().at_level(level)).collect();
    let mut hit_mask = 0;
    for (k, corner) in mesh.0.iter().enumerate().step_by(11) {
        let (axis, small) = (k % 3, [0.0, -0.0, 1e-42][k / 3 % 3]);
        let (length, away) = ([1e-6, -1.0, 1.0, -1e14][k % 4], [4.0, 1e4][k / 2 % 2]);
        let mut dir = Vec3::splat(small);
        dir[axis] = length;
        // One ray goes through a vertex and another just past it.
        let beside = |i: usize| {
            let mut at = *corner - away * length.signum() * Vec3::AXES[axis];
            at[(axis + 1) % 3] += 0.01 * (i % 8) as f32;
            at[(axis + 2) % 3] += 0.01 * (i / 8) as f32;
            at
        };
        let rays: Vec<Ray> = (0..64).map(|i| Ray::new(beside(i), dir)).collect();
        let expected: Vec<_> = rays.iter().map(|ray| brute_force(&mesh, ray)).collect();
        for tree in &trees {
            let (mut hits, mut occluded) = (vec![None; rays.len()], vec![false; rays.len()]);
            tree.packets::<false>(&rays, |i, hit| hits[i] = hit, |rest| assert!(rest.is_empty(), "{dir}"));
            let blocked = |i, hit: Option<TriangleHit>| occluded[i] = hit.is_some();
            tree.packets::<true>(&rays, blocked, |rest| assert!(rest.is_empty(), "{dir}"));
            for (i, (ray, expected)) in rays.iter().zip(&expected).enumerate() {
                let first = expected.first().map(bits);
                assert_eq!(hits[i].as_ref().map(bits), first, "{ray:?}");
                assert_eq!(tree.closest(ray).as_ref().map(bits), first, "{ray:?}");
                assert_eq!((occluded[i], tree.occluded(ray)), (first.is_some(), first.is_some()), "{ray:?}");
                assert_eq!((tree.hit_count(ray), expected.len() % 2), (expected.len(), 0), "{ray:?}");
                hit_mask += usize::from(first.is_some());
            }
        }
    }
    assert!(hit_mask > 5_000, "{hit_mask}");
}

#[test]
fn zeros_of_either_sign_are_the_same_ray_origin() {
    // The mesh is around the origin, so that corners also have zeros of either sign and rays run
    // through edges and vertices.
    let mut mesh = cube(8);
    for (i, at) in mesh.0.iter_mut().flat_map(|at| at.as_mut()).enumerate() {
        *at = if *at == 0.0 && i % 2 == 0 { -0.0 } else { *at };
    }
    let tree = TriangleBvh::build(&mesh.0, &mesh.1, BuildQuality::Best);
    for octant in 0..24 {
        let signs = Vec3::from_array([0, 1, 2].map(|axis| [1.0, -1.0][octant >> axis & 1]));
        let rays: Vec<Ray> = (0..64)
            .map(|i: usize| {
                let mut dir = Vec3::new(1.0, (i % 8) as f32 / 16.0, (i / 8) as f32 / 16.0);
                (0..octant / 8).for_each(|_| dir = Vec3::new(dir.z, dir.x, dir.y));
                let origin = Vec3::from_array([0, 1, 2].map(|axis| [0.0, -0.0][i >> axis & 1]));
                Ray::new(origin, dir * signs)
            })
            .collect();
        for tree in SimdLevel::available().map(|level| tree.clone().at_level(level)) {
            let (mut hits, mut occluded) = (vec![None; rays.len()], vec![false; rays.len()]);
            let mut alone = Vec::new();
            tree.packets::<false>(&rays, |i, hit| hits[i] = hit, |rest| alone.extend_from_slice(rest));
            let blocked = |i, hit: Option<TriangleHit>| occluded[i] = hit.is_some();
            tree.packets::<true>(&rays, blocked, |rest| assert_eq!(rest, alone));
            assert!(alone.len() < rays.len() && (octant % 8 != 0 || alone.is_empty()), "{octant}");
            for (i, ray) in rays.iter().enumerate().filter(|(i, _)| !alone.contains(&(*i as u32))) {
                let expected = brute_force(&mesh, ray);
                assert_eq!(hits[i].as_ref().map(bits), expected.first().map(bits), "{ray:?}");
                assert_eq!((expected.len(), occluded[i]), (1, true), "{ray:?}");
            }
        }
    }
}

#[test]
#[cfg_attr(target_family = "wasm", ignore = "no threads there")]
fn a_tree_is_a_function_of_its_triangles() {
    // The mesh is large enough for every step to run in parallel.
    let (soup, bars) = (soup(&mut Random(5), 40_000, 0.05), bars(&mut Random(5), 20_000, 1_000));
    for (mesh, (name, quality)) in
        [&soup, &bars].into_iter().flat_map(|mesh| BuildQuality::NAMES.map(|named| (mesh, named)))
    {
        let build = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let tree = pool.install(|| TriangleBvh::build(&mesh.0, &mesh.1, quality));
            format!("{:?}{:?}", tree.nodes, tree.leaves)
        };
        assert!(build(1) == build(2), "{name}");
    }
    assert!(TriangleBvh::build(&bars.0, &bars.1, BuildQuality::Best).items() > bars.1.len(), "no triangle was split");
}

/// The panic reaches the caller, whichever thread found the error, and the next tree can be built.
#[test]
#[cfg_attr(target_family = "wasm", ignore = "a panic ends the program there")]
fn out_of_range_index_panics() {
    let (vertices, mut triangles) = soup(&mut Random(3), 20_000, 0.1);
    for quality in BuildQuality::NAMES.map(|(_, quality)| quality) {
        for place in [0, 10_000, 19_999] {
            let right = std::mem::replace(&mut triangles[place], [0, 1, 1 << 20]);
            let build = || TriangleBvh::build(&vertices, &triangles, quality);
            assert!(std::panic::catch_unwind(build).is_err(), "{quality:?} {place}");
            triangles[place] = right;
        }
        assert_eq!(TriangleBvh::build(&vertices, &triangles, quality).items(), triangles.len());
    }
}
