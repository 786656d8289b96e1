//! Tests filters, sides, corners, and batches against brute force.

use super::*;
use crate::{BuildError, Facing};

/// Hits found without a tree, each with the side determined by the normal in double precision, or
/// `None` if the triangle is edge-on.
fn with_sides(mesh: &Mesh, ray: &Ray) -> Vec<(TriangleHit, Option<Facing>)> {
    let side = |hit: &TriangleHit| {
        let [a, b, c] = mesh.1[hit.triangle as usize].map(|i| mesh.0[i as usize].as_dvec3());
        let (normal, dir) = ((b - a).cross(c - a), ray.dir.as_dvec3());
        let cosine = normal.dot(dir) / (normal.length() * dir.length());
        // If the triangle is nearly edge-on, double precision is not enough to determine the side.
        (cosine.abs() > 1e-6).then_some(if cosine < 0.0 { Facing::Front } else { Facing::Back })
    };
    brute_force(mesh, ray).into_iter().map(|hit| (hit, side(&hit))).collect()
}

#[test]
fn sides_and_filters_match_brute_force() {
    let (mut random, mut hits) = (Random(21), 0);
    for mesh in [torus(30, 15), cube(4), soup(&mut random, 300, 0.4), bars(&mut random, 60, 12)] {
        let bvh = TriangleBvh::build(&mesh.0, &mesh.1, BuildQuality::Best);
        for level in SimdLevel::available() {
            let bvh = bvh.clone().at_level(level);
            for round in 0..400 {
                let ray = ray(&mesh, &mut random, 1.0, Vec3::ZERO);
                let expected = with_sides(&mesh, &ray);
                let sides = |hit: &TriangleHit| expected.iter().find(|(other, _)| other.triangle == hit.triangle);
                // The sides must agree with the normals.
                bvh.occluded_where(&ray, |hit, facing| {
                    let side = sides(hit).unwrap_or_else(|| panic!("{hit:?} {ray:?}")).1;
                    assert!(side.is_none_or(|side| side == facing), "{hit:?} {ray:?}");
                    false
                });
                // The filter accepts two of three triangles.
                let keep = |hit: &TriangleHit| !(hit.triangle as usize + round).is_multiple_of(3);
                let first = expected.iter().map(|(hit, _)| hit).find(|hit| keep(hit));
                let found = bvh.closest_where(&ray, |hit, _| keep(hit));
                assert_eq!(found.as_ref().map(bits), first.map(bits), "{ray:?}");
                assert_eq!(bvh.occluded_where(&ray, |hit, _| keep(hit)), first.is_some(), "{ray:?}");
                assert_eq!(bvh.closest_where(&ray, |_, _| true), bvh.closest(&ray));
                assert_eq!(bvh.closest_where(&ray, |_, _| false), None);
                hits += usize::from(first.is_some());
            }
        }
    }
    assert!(hits > 1_000, "{hits}");
}

/// A ray hits the front and back sides of a closed mesh alternately, even at edges and vertices.
#[test]
fn sides_of_a_closed_mesh_alternate() {
    let mut random = Random(22);
    for mesh in [torus(40, 20), cube(8)] {
        // The signed volume is negative if the front sides face inwards.
        let volume = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| mesh.0[i as usize]);
            a.dot(b.cross(c))
        };
        let sides_in = if mesh.1.iter().map(volume).sum::<f32>() > 0.0 { Facing::Front } else { Facing::Back };
        let bvh = TriangleBvh::build(&mesh.0, &mesh.1, BuildQuality::Best);
        for _ in 0..2_000 {
            let start = 4.0 * random.direction();
            let goal = mesh.0[random.below(mesh.0.len())];
            let ray = Ray::new(start, goal - start);
            let mut sides = Vec::new();
            bvh.occluded_where(&ray, |hit, facing| {
                sides.push((hit.t, hit.triangle, facing));
                false
            });
            sides.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            sides.dedup();
            // The ray alternately enters and leaves the mesh. If several crossings nearly coincide,
            // for example at an edge, their order is not determined.
            let mut depth = 0;
            for (i, side) in sides.iter().enumerate() {
                depth += if side.2 == sides_in { 1 } else { -1 };
                let is_apart = sides.get(i + 1).is_none_or(|next| next.0 - side.0 > 1e-5);
                assert!(!is_apart || (0..=1).contains(&depth), "{ray:?} {sides:?}");
            }
            assert_eq!(depth, 0, "{ray:?} {sides:?}");
        }
    }
}

#[test]
fn corners_and_normals_match_the_mesh() {
    let mut random = Random(23);
    let mut mesh = bars(&mut random, 200, 40);
    mesh.0[5] = Vec3::NAN;
    let mut bvh = TriangleBvh::build(&mesh.0, &mesh.1, BuildQuality::Best);
    for _ in 0..2 {
        for (i, triangle) in mesh.1.iter().enumerate() {
            let corners = triangle.map(|i| mesh.0[i as usize]);
            let expected = corners.iter().all(|corner| corner.is_finite()).then_some(corners);
            assert_eq!(bvh.corners(i as u32), expected);
        }
        mesh.0.iter_mut().for_each(|v| *v += 0.01 * random.point());
        bvh.refit(&mesh.0, &mesh.1);
    }
    assert_eq!(bvh.corners(mesh.1.len() as u32), None);
    let no_area = TriangleBvh::build(&[Vec3::ZERO, Vec3::X], &[[0, 1, 0]], BuildQuality::Fast);
    let hit = TriangleHit { t: 1.0, uv: Vec2::ZERO, triangle: 0 };
    assert_eq!(no_area.normal(&hit), Vec3::ZERO);
}

#[test]
fn batches_of_all_hits_match_single_queries() {
    let (mut random, mesh) = (Random(24), torus(20, 10));
    let bvh = TriangleBvh::build(&mesh.0, &mesh.1, BuildQuality::Balanced);
    let rays: Vec<Ray> = (0..200).map(|_| ray(&mesh, &mut random, 1.0, Vec3::ZERO)).collect();
    let (mut counts, mut next) = (vec![0; rays.len()], 0);
    bvh.hit_count_batch(&rays, &mut counts);
    bvh.all_hits_batch(&rays, |i, hits| {
        assert_eq!((i, hits), (next, &*bvh.all_hits(&rays[i])));
        assert_eq!(counts[i] as usize, hits.len());
        next += 1;
    });
    assert_eq!(next, rays.len());
    assert!(counts.iter().any(|count| *count > 1));
}

#[test]
fn invalid_meshes_are_refused_with_a_reason() {
    let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let quality = BuildQuality::Fast;
    let error = TriangleBvh::try_build(&vertices, &[[0, 1, 2], [2, 7, 0]], quality).unwrap_err();
    assert_eq!(error, BuildError::MissingVertex { triangle: 1, index: 7, vertices: 3 });
    assert_eq!(
        error.to_string(),
        "triangle 1 has the vertex index 7, which must be less than the number of vertices, 3"
    );
    let error = TriangleBvh::from_flat(&[0.0; 10], &[0, 1, 2], quality).unwrap_err();
    assert_eq!(error, BuildError::NotMultipleOfThree { list: "positions", len: 10 });
    let error = TriangleBvh::from_flat(&[0.0; 9], &[0, 1], quality).unwrap_err();
    assert_eq!(error, BuildError::NotMultipleOfThree { list: "indices", len: 2 });
    let mut bvh = TriangleBvh::build(&vertices, &[[0, 1, 2]], quality);
    let error = bvh.try_refit(&vertices, &[]).unwrap_err();
    assert_eq!(error, BuildError::TriangleCountMismatch { built: 1, refitted: 0 });
    assert!(bvh.try_refit(&vertices[..2], &[[0, 1, 2]]).is_err());
    assert!(bvh.occluded(&Ray::new(Vec3::new(0.2, 0.2, 1.0), Vec3::NEG_Z)));
}
