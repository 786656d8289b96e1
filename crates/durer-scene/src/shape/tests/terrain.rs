//! Tests that a terrain is equal to its mesh in the form of lists.

use super::*;
use crate::dialect::MeshNormals;
use crate::shape::mesh::{Mesh, Triangles};
use durer_bvh::BuildQuality;

fn field(min: Vec3, columns: usize, rows: usize, random: &mut Random) -> Terrain {
    let heights = (0..columns * rows).map(|_| random.unit()).collect();
    let field = HeightField { min, max: min + Vec3::new(2.0, 0.5, 3.0), depth: 0.25, ..HeightField::default() };
    field.terrain(columns, heights).unwrap()
}

#[test]
fn terrain_equals_its_mesh_as_lists() {
    let mut random = Random(3);
    let rules = [
        MeshNormals::Flat,
        MeshNormals::SmoothByArea,
        MeshNormals::SmoothByFace,
        MeshNormals::SmoothAbove(120),
        MeshNormals::Crease(40.0),
        MeshNormals::Crease(90.0),
    ];
    for (columns, rows) in [(2, 2), (3, 2), (2, 4), (9, 7), (40, 30)] {
        for min in [Vec3::ZERO, Vec3::new(4096.0, -8192.0, 65536.0)] {
            let terrain = field(min, columns, rows, &mut random);
            let data = terrain.to_data();
            for rule in rules {
                let mesh = Mesh::of_terrain(terrain.clone(), rule).centered();
                let listed = Mesh::new(data.clone(), rule, true).centered();
                assert_eq!((mesh.len(), mesh.center()), (listed.len(), listed.center()));
                assert_eq!((mesh.open_edges(), mesh.is_flat()), (listed.open_edges(), listed.is_flat()));
                assert_eq!(mesh.tree(BuildQuality::Fast).bounds(), listed.tree(BuildQuality::Fast).bounds());
                for part in 0..mesh.len() as u32 {
                    assert_eq!(mesh.corners(part), listed.corners(part), "{part}");
                    assert_eq!(mesh.corner_normals(part), listed.corner_normals(part), "{rule:?} {part}");
                    assert_eq!(mesh.derivatives(part, false), listed.derivatives(part, false));
                    let crossing = ShapeHit { t: 1.0, uv: Vec2::new(0.2, 0.7) };
                    let [ours, theirs] = [&mesh, &listed].map(|mesh| format!("{:?}", mesh.surface(part, &crossing)));
                    assert_eq!(ours, theirs);
                }
                let other = mesh.with_normals(MeshNormals::SmoothByFace);
                assert_eq!(other.normals(), listed.with_normals(MeshNormals::SmoothByFace).normals());
                assert_eq!(mesh.with_parallelograms().to_data(), listed.with_parallelograms().to_data());
            }
        }
    }
}

#[test]
fn corners_around_a_vertex_are_found_in_order() {
    let terrain = field(Vec3::ZERO, 5, 4, &mut Random(4));
    for vertex in 0..terrain.vertices() as u32 {
        let corners = (0..terrain.ordered_count()).flat_map(|i| terrain.triangle(i)).enumerate();
        let expected: Vec<u32> = corners.filter(|(_, other)| *other == vertex).map(|(i, _)| i as u32).collect();
        let mut found = Vec::new();
        terrain.ordered_around(vertex, |corner| found.push(corner));
        assert_eq!(found, expected, "{vertex}");
    }
}

#[test]
fn different_terrains_have_different_hashes() {
    let [mut random, mut again] = [Random(5), Random(5)];
    let terrain = field(Vec3::ZERO, 4, 3, &mut random);
    assert_eq!(terrain.digest(), field(Vec3::ZERO, 4, 3, &mut again).digest());
    assert_ne!(terrain.digest(), field(Vec3::ZERO, 4, 3, &mut random).digest());
    assert_ne!(terrain.digest(), terrain.translated(Vec3::Y).digest());
}

#[test]
fn overflowing_heights_are_rejected() {
    let field = HeightField { min: Vec3::ZERO, max: Vec3::splat(1e38), ..HeightField::default() };
    assert!(field.terrain(2, vec![1.0; 4]).is_some());
    assert!(field.terrain(2, vec![1e3; 4]).is_none());
}
