//! Tests trees over height grids against trees over the same triangles and against brute force.

use super::*;
use crate::BuildError;
use std::sync::Arc;

/// Returns a height grid, and a mesh with the same triangles plus one triangle below each pair of
/// neighbouring border points.
fn landscape(random: &mut Random, [columns, rows]: [usize; 2], scale: f32, offset: Vec3) -> (Arc<HeightGrid>, Mesh) {
    let line = |axis: usize, i: usize, count: usize| offset[axis] + scale * (2.0 * i as f32 / (count - 1) as f32 - 1.0);
    let heights = (0..columns * rows).map(|_| offset.y + scale * random.between(-0.3, 0.3)).collect();
    let [xs, zs] = [(0, columns), (2, rows)].map(|(axis, count)| (0..count).map(|i| line(axis, i, count)).collect());
    let grid = HeightGrid::new(xs, zs, heights).unwrap();
    let mut mesh: Mesh = Default::default();
    mesh.0.extend((0..columns * rows).map(|i| grid.point(i)));
    mesh.1.extend((0..grid.triangle_count()).map(|i| grid.triangle(i)));
    mesh.0.push(offset + scale * Vec3::new(0.0, -0.8, 0.0));
    mesh.1.extend((1..columns as u32).map(|i| [(columns * rows) as u32, i, i - 1]));
    mesh.1.extend((1..rows).map(|row| [row, row - 1, rows].map(|row| (row * columns) as u32)));
    (Arc::new(grid), mesh)
}

fn over((grid, mesh): &(Arc<HeightGrid>, Mesh), quality: BuildQuality) -> TriangleBvh {
    let others = &mesh.1[grid.triangle_count()..];
    let others: Vec<[Vec3; 3]> = others.iter().map(|t| t.map(|i| mesh.0[i as usize])).collect();
    TriangleBvh::over_heights(grid.clone(), &others, quality).unwrap()
}

#[test]
fn height_field_is_hit_like_its_triangles() {
    let (mut random, mut found) = (Random(5), 0);
    for size in [[2, 2], [3, 2], [2, 5], [3, 3], [6, 9], [40, 33]] {
        for (scale, offset) in
            [(1.0, Vec3::ZERO), (1.0, Vec3::new(1e4, -3e3, 7e4)), (1e-30, Vec3::ZERO), (1e30, Vec3::ZERO)]
        {
            let both = landscape(&mut random, size, scale, offset);
            let mesh = &both.1;
            let trees: Vec<(String, TriangleBvh)> = BuildQuality::NAMES
                .into_iter()
                .flat_map(|(word, quality)| {
                    let tree = over(&both, quality);
                    let all = SimdLevel::available().map(|level| (format!("{level:?}"), tree.clone().at_level(level)));
                    let stored = ("stored".into(), TriangleBvh::from_bytes(&tree.to_bytes()).unwrap());
                    all.chain([stored, ("blind".into(), tree.clone().min_volume(1e-38))])
                        .map(move |(kind, tree)| (format!("{word} {kind}"), tree))
                        .collect::<Vec<_>>()
                })
                .collect();
            let rays: Vec<Ray> = (0..rounds(120)).map(|_| ray(mesh, &mut random, scale, offset)).collect();
            for ray in &rays {
                let expected: Vec<_> = brute_force(mesh, ray).iter().map(bits).collect();
                found += expected.len().min(1);
                for (kind, tree) in trees.iter().filter(|(kind, _)| !kind.contains("blind")) {
                    let context = || format!("{size:?} {scale} {offset} {kind} {ray:?}");
                    assert_eq!(tree.closest(ray).as_ref().map(bits), expected.first().copied(), "{}", context());
                    assert_eq!(tree.occluded(ray), !expected.is_empty(), "{}", context());
                    let all: Vec<_> = tree.all_hits(ray).iter().map(bits).collect();
                    assert_eq!(all, expected, "{}", context());
                }
            }
            let (mut closest, mut occluded) = (vec![None; rays.len()], vec![false; rays.len()]);
            for (kind, tree) in &trees {
                tree.closest_batch(&rays, &mut closest);
                tree.occluded_batch(&rays, &mut occluded);
                for (i, ray) in rays.iter().enumerate() {
                    let one = tree.closest(ray);
                    assert_eq!(closest[i].as_ref().map(bits), one.as_ref().map(bits), "{size:?} {kind} {ray:?}");
                    assert_eq!(occluded[i], one.is_some(), "{size:?} {kind} {ray:?}");
                }
                let numbers: Vec<u32> = (0..rays.len() as u32).collect();
                tree.stream::<ClosestHit>(&rays, &numbers, |i, hit| closest[i] = hit);
                assert!(rays.iter().zip(&closest).all(|(ray, hit)| tree.closest(ray) == *hit), "{size:?} {kind}");
            }
        }
    }
    assert!(found > 1_000, "{found}");
}

/// Neighbouring rays form packets.
#[test]
fn packets_find_what_single_rays_find_in_a_height_field() {
    let both = landscape(&mut Random(6), [70, 50], 1.0, Vec3::ZERO);
    let tree = over(&both, BuildQuality::default());
    let ways = (0..64 * 64).map(|i| Vec3::new((i % 64) as f32 / 64.0 - 0.5, -0.6, (i / 64) as f32 / 64.0 - 0.5));
    let rays: Vec<Ray> = ways.map(|dir| Ray::new(Vec3::new(0.1, 1.0, -0.2), dir)).collect();
    let (mut hits, mut occluded) = (vec![None; rays.len()], vec![false; rays.len()]);
    for level in SimdLevel::available() {
        let tree = tree.clone().at_level(level);
        tree.closest_batch(&rays, &mut hits);
        tree.occluded_batch(&rays, &mut occluded);
        for (ray, (hit, occluded)) in rays.iter().zip(hits.iter().zip(&occluded)) {
            assert_eq!((*hit, *occluded), (tree.closest(ray), tree.occluded(ray)), "{level:?} {ray:?}");
        }
    }
    assert!(hits.iter().flatten().count() > 3_000);
}

#[test]
fn other_queries_of_a_height_field_match_its_triangles() {
    let mut random = Random(7);
    let both = landscape(&mut random, [9, 12], 1.0, Vec3::ZERO);
    let (grid, mesh) = &both;
    let (mut tree, mut other) =
        (over(&both, BuildQuality::Best), TriangleBvh::build(&mesh.0, &mesh.1, BuildQuality::Best));
    assert_eq!((tree.triangle_count(), tree.bounds()), (mesh.1.len(), other.bounds()));
    assert_eq!(grid.bounds(), Aabb::around(mesh.0[..grid.heights().len()].iter().copied()));
    let same = |tree: &TriangleBvh, other: &TriangleBvh, random: &mut Random| {
        for triangle in 0..=mesh.1.len() as u32 {
            assert_eq!(tree.corners(triangle), other.corners(triangle));
        }
        for _ in 0..rounds(200) {
            let point = 1.5 * random.point();
            assert_eq!(tree.nearest_point(point, f64::INFINITY), other.nearest_point(point, f64::INFINITY));
            let ray = ray(mesh, random, 1.0, Vec3::ZERO);
            assert_eq!(tree.hit_count(&ray), other.hit_count(&ray));
            let back = |_: &TriangleHit, facing| facing == Facing::Back;
            assert_eq!(tree.closest_where(&ray, back), other.closest_where(&ray, back));
        }
    };
    same(&tree, &other, &mut random);
    let moved: Vec<Vec3> = mesh.0.iter().map(|p| *p + 0.1 * random.point()).collect();
    tree.refit(&moved, &mesh.1);
    other.refit(&moved, &mesh.1);
    same(&tree, &other, &mut random);
}

#[test]
fn invalid_grid_is_refused() {
    let made =
        |columns: usize, rows: usize, heights: Vec<f32>| HeightGrid::new(vec![0.0; columns], vec![1.0; rows], heights);
    assert_eq!(made(1, 2, vec![0.0; 2]), Err(BuildError::InvalidGridSize { columns: 1, rows: 2, heights: 2 }));
    assert_eq!(made(3, 2, vec![0.0; 5]), Err(BuildError::InvalidGridSize { columns: 3, rows: 2, heights: 5 }));
    assert_eq!(made(2, 2, vec![0.0, 0.0, f32::NAN, 0.0]), Err(BuildError::NotFinite));
    assert!(made(2, 2, vec![0.0; 4]).is_ok());
}
