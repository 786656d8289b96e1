//! Tests the computed normals of meshes, and interpolation over a triangle.

use super::*;
use crate::dialect::MeshNormals;
use crate::shape::mesh::NO_INDEX;

fn normal_at(mesh: &Mesh, part: u32, uv: Vec2) -> Vec3 {
    mesh.surface(part, &ShapeHit { t: 1.0, uv }).n_shade
}

/// Barycentric coordinates of the three corners.
const CORNERS: [Vec2; 3] = [Vec2::ZERO, Vec2::X, Vec2::Y];

fn cube() -> MeshData {
    let positions =
        (0..8).map(|i| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) * 2.0 - 1.0).collect();
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    MeshData { positions, triangles, ..MeshData::default() }
}

/// Returns a sphere made of rings, with every vertex on the unit sphere.
fn ball(rings: u32) -> MeshData {
    let mut data = MeshData::default();
    let around = 2 * rings;
    for j in 0..=rings {
        for i in 0..around {
            let (t, d) = crate::math::fp::sin_cos_degrees(180.0 * f64::from(j) / f64::from(rings));
            let (s, c) = crate::math::fp::sin_cos_degrees(360.0 * f64::from(i) / f64::from(around));
            data.positions.push(DVec3::new(t * c, d, t * s).as_vec3());
        }
    }
    for j in 0..rings {
        for i in 0..around {
            let at = |i: u32, j: u32| j * around + i % around;
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            // Degenerate triangles at the poles are omitted.
            data.triangles.extend((j > 0).then_some([a, b, c]));
            data.triangles.extend((j + 1 < rings).then_some([a, c, d]));
        }
    }
    data
}

#[test]
fn flat_meshes_have_one_normal_per_triangle() {
    let mesh = Mesh::new(ball(8), MeshNormals::Flat, true);
    for part in 0..mesh.len() as u32 {
        for uv in CORNERS {
            let surface = mesh.surface(part, &ShapeHit { t: 1.0, uv });
            assert_eq!(surface.n_shade, surface.n_geo);
        }
    }
}

/// Returns three faces around the origin. A large one faces up, and two small ones face -x and -z.
fn corner_of_three() -> MeshData {
    MeshData {
        positions: vec![Vec3::ZERO, Vec3::X * 4.0, Vec3::Z * 4.0, Vec3::NEG_Y],
        triangles: vec![[0, 2, 1], [0, 3, 2], [0, 1, 3]],
        ..MeshData::default()
    }
}

#[test]
fn faces_around_a_vertex_are_weighted_by_area_or_equally() {
    // The faces have the areas 8, 2 and 2, and the unit normals +y, -x and -z.
    let by_area = Mesh::new(corner_of_three(), MeshNormals::SmoothByArea, true);
    let by_face = Mesh::new(corner_of_three(), MeshNormals::SmoothByFace, true);
    let close = |a: Vec3, b: Vec3| assert!((a - b).length() < 1e-6, "{a} {b}");
    for part in 0..3 {
        close(normal_at(&by_area, part, CORNERS[0]), Vec3::new(-2.0, 8.0, -2.0).normalize());
        close(normal_at(&by_face, part, CORNERS[0]), Vec3::new(-1.0, 1.0, -1.0).normalize());
    }
    // The far corner on the x axis belongs only to the faces with the normals +y and -z.
    close(normal_at(&by_area, 2, CORNERS[1]), Vec3::new(0.0, 8.0, -2.0).normalize());
}

#[test]
fn meshes_with_many_vertices_are_smooth() {
    let count = ball(8).positions.len();
    let smooth = |limit: usize| {
        let mesh = Mesh::new(ball(8), MeshNormals::SmoothAbove(limit), true);
        let surface = mesh.surface(0, &ShapeHit { t: 1.0, uv: CORNERS[2] });
        surface.n_shade != surface.n_geo
    };
    assert!(smooth(count - 1) && !smooth(count) && !smooth(count + 1));
}

#[test]
fn crease_angle_keeps_a_cube_flat_and_a_sphere_smooth() {
    let rule = MeshNormals::Crease(40.0);
    let mesh = Mesh::new(cube(), rule, true);
    for part in 0..12 {
        for uv in CORNERS {
            let surface = mesh.surface(part, &ShapeHit { t: 1.0, uv });
            assert!((surface.n_shade - surface.n_geo).length() < 1e-6, "{surface:?}");
        }
    }
    let mesh = Mesh::new(ball(16), rule, true);
    for part in 0..mesh.len() as u32 {
        for uv in CORNERS {
            let surface = mesh.surface(part, &ShapeHit { t: 1.0, uv });
            let off = (surface.n_shade - surface.position).length();
            // At the poles, each triangle has its own vertex. Elsewhere, four or more faces are
            // averaged. The planes of these faces are tilted by up to half a ring, or 5.6 degrees,
            // and the faces are not quite evenly distributed.
            let pole = surface.position.y.abs() > 0.999;
            assert!(pole || off < 0.02, "{surface:?} {off}");
        }
    }
}

/// Tests triangles that share no vertex, and a triangle that touches another at one corner.
#[test]
fn triangles_without_shared_vertices_have_no_vertex_normals() {
    let apart = |count: u32| {
        let cube = cube();
        let corners: Vec<u32> = cube.triangles[..count as usize].iter().flatten().copied().collect();
        let positions = corners.iter().map(|&i| cube.positions[i as usize]).collect();
        let triangles = (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        MeshData { positions, triangles, ..MeshData::default() }
    };
    let rule = MeshNormals::Crease(40.0);
    let mesh = Mesh::new(apart(12), rule, true);
    assert!(mesh.is_flat() && (0..12).all(|part| mesh.corner_normals(part).is_none()));
    for (part, uv) in (0..12).flat_map(|part| CORNERS.map(|uv| (part, uv))) {
        let surface = mesh.surface(part, &ShapeHit { t: 1.0, uv });
        assert_eq!((surface.n_shade, surface.shadow_offsets), (surface.n_geo, [Vec3::ZERO; 2]));
    }
    let mut touching = apart(2);
    touching.triangles[1][0] = touching.triangles[0][0];
    assert!(!Mesh::new(touching, rule, true).is_flat());
}

#[test]
fn tiny_meshes_are_as_smooth_as_others() {
    for rule in [MeshNormals::SmoothByArea, MeshNormals::SmoothByFace, MeshNormals::Crease(40.0)] {
        let mesh = Mesh::new(ball(8), rule, true);
        for scale in [1e-15, 1e15] {
            let mut data = ball(8);
            data.positions.iter_mut().for_each(|p| *p *= scale);
            let scaled = Mesh::new(data, rule, true);
            for part in 0..mesh.len() as u32 {
                let [a, b] = [&mesh, &scaled].map(|mesh| normal_at(mesh, part, CORNERS[1]));
                assert!((a - b).length() < 1e-5, "{rule:?} {scale} {a} {b}");
            }
        }
    }
}

/// Triangles that were separated are still smooth along the edges where they were joined.
#[test]
fn loosened_triangles_share_their_vertices() {
    let mut apart = ball(8);
    apart.separate_and_enlarge();
    for rule in [MeshNormals::SmoothByArea, MeshNormals::SmoothByFace] {
        let whole = Mesh::new(ball(8), rule, true);
        let flat = Mesh::new(apart.clone(), MeshNormals::Flat, true);
        assert!(flat.is_flat() && !whole.is_flat());
        let smooth = flat.with_normals(rule);
        for part in 0..whole.len() as u32 {
            for uv in CORNERS {
                assert!((normal_at(&smooth, part, uv) - normal_at(&whole, part, uv)).length() < 1e-3);
            }
        }
    }
}

#[test]
fn normals_and_coordinates_of_files_are_interpolated() {
    let mut data = MeshData {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
        uvs: vec![Vec2::ZERO, Vec2::new(2.0, 0.0), Vec2::new(0.0, 3.0)],
        normals: vec![Vec3::Z * 2.0, Vec3::X, Vec3::Y * 5.0],
        triangles: vec![[0, 1, 2]],
        triangle_uvs: vec![[0, 1, 2]],
        triangle_normals: vec![[0, 1, 2]],
        ..MeshData::default()
    };
    let surface = |data: &MeshData, rule, file_normals| {
        let crossing = ShapeHit { t: 1.0, uv: Vec2::new(0.25, 0.5) };
        Mesh::new(data.clone(), rule, file_normals).surface(0, &crossing)
    };
    let point = surface(&data, MeshNormals::Flat, true);
    assert_eq!(point.barycentric, Vec3::new(0.25, 0.25, 0.5));
    assert_eq!(point.position, Vec3::new(0.25, 0.5, 0.0));
    assert_eq!(point.uv.get(), Some(Vec2::new(0.5, 1.5)));
    assert!((point.n_shade - Vec3::new(0.25, 2.5, 0.5).normalize()).length() < 1e-6);
    assert_eq!(surface(&data, MeshNormals::Flat, false).n_shade, Vec3::Z);
    // A triangle that lacks some of its normals gets computed ones, and it has no texture
    // coordinates.
    data.triangle_normals[0][1] = NO_INDEX;
    data.triangle_uvs[0][1] = NO_INDEX;
    let point = surface(&data, MeshNormals::SmoothByArea, true);
    assert_eq!((point.n_shade, point.uv.get()), (Vec3::Z, None));
    assert_eq!(surface(&data, MeshNormals::Flat, true).n_shade, Vec3::Z);
}

#[test]
fn degenerate_triangle_has_a_unit_normal_and_is_never_hit() {
    let data = MeshData {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::X * 2.0],
        triangles: vec![[0, 1, 2], [0, 0, 1]],
        ..MeshData::default()
    };
    for rule in [MeshNormals::Flat, MeshNormals::SmoothByArea, MeshNormals::SmoothByFace, MeshNormals::Crease(40.0)] {
        let mesh = Mesh::new(data.clone(), rule, true);
        for part in 0..2 {
            let surface = mesh.surface(part, &ShapeHit { t: 1.0, uv: Vec2::splat(0.3) });
            assert!(surface.n_geo.is_normalized() && surface.n_shade.is_normalized(), "{rule:?} {surface:?}");
            let ray = Ray::new(Vec3::new(0.5, 1.0, 0.0), Vec3::NEG_Y);
            let sheared = super::super::watertight::WatertightRay::new(&ray);
            assert_eq!(sheared.intersect(mesh.corners(part), 0.0, f32::INFINITY), None);
        }
    }
}
