//! Tests of two-sided emissive meshes. The light of a mesh must not depend on whether light
//! sampling samples its inside.

use super::*;
use crate::compile::AccelKind;
use crate::compile::testing::try_read;
use durer_scene::dialect::Dialect;
use std::path::Path as FilePath;
use tempfile::TempDir;

/// Returns a cube of half-width `half`. The cube's triangles are counter-clockwise as seen from
/// outside or, if `turned`, from inside.
fn cube(half: f32, turned: bool) -> String {
    let corner = |i: usize| [1, 2, 4].map(|bit| if i & bit > 0 { half } else { -half });
    let vertices: String = (0..8).map(corner).map(|[x, y, z]| format!("v {x} {y} {z}\n")).collect();
    let faces = [[1, 3, 4, 2], [5, 6, 8, 7], [1, 2, 6, 5], [3, 7, 8, 4], [1, 5, 7, 3], [2, 4, 8, 6]];
    let face =
        |[a, b, c, d]: [u32; 4]| if turned { format!("f {d} {c} {b} {a}\n") } else { format!("f {a} {b} {c} {d}\n") };
    vertices + &faces.into_iter().map(face).collect::<String>()
}

/// Writes a cube in both orientations to files in a folder.
fn cubes(half: f32) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, turned) in [("out.obj", false), ("in.obj", true)] {
        std::fs::write(folder.path().join(name), cube(half, turned)).unwrap();
    }
    folder
}

/// Builds a world with a matte, a two-sided emissive and a one-sided emissive material.
fn world(folder: &FilePath, group: &str) -> World {
    let text = format!(
        "PerspectiveCamera {{ center 0 0 5 direction 0 0 -1 up 0 1 0 angle 30 }} Background {{ color 0 0 0 }}
         Materials {{ {MATTE} PrincipledMaterial {{ baseColor 0 0 0 specularWeight 0 emissionLuminance 3 walls thin }}
         PrincipledMaterial {{ baseColor 0 0 0 specularWeight 0 emissionLuminance 3 }} }} Group {{ {group} }}"
    );
    let (world, list) = try_read(&text, Dialect::Durer.rules(), AccelKind::Bvh, folder);
    world.unwrap_or_else(|| panic!("{list:?}"))
}

#[test]
fn emissive_meshes_light_their_inside() {
    let folder = cubes(3.0);
    for name in ["out.obj", "in.obj"] {
        let world = world(
            folder.path(),
            &format!(
                "MaterialIndex 1 TriangleMesh {{ obj_file {name} }}
                 MaterialIndex 0 Rectangle {{ corner -1 0 1 edge0 2 0 0 edge1 0 0 -2 }}"
            ),
        );
        // The floor receives light of radiance 3 from all directions.
        let (mean, error) = light(&world, to_origin(), 0, 1 << 12);
        assert!((mean - 1.5).abs() < 3.0 * error + 0.0015, "{name}: {mean} ± {error}");
        // If only BSDF sampling were used, there would be no noise, so light sampling must be used
        // too.
        assert!(error > 1e-3, "{name}: {error}");
    }
}

#[test]
fn light_sampling_skips_insides_of_closed_emitters() {
    let folder = cubes(0.5);
    let lit = |name: &str, material: u32| {
        let emitter =
            format!("MaterialIndex {material} Transform {{ Translate 0 1.5 0 TriangleMesh {{ obj_file {name} }} }}");
        let world = world(folder.path(), &format!("MaterialIndex 0 Plane {{ normal 0 1 0 offset 0 }} {emitter}"));
        light(&world, to_origin(), 0, 1 << 14)
    };
    let ((one, e1), (both, e2), (turned, e3)) = (lit("out.obj", 2), lit("out.obj", 1), lit("in.obj", 1));
    assert_eq!((one, e1), (both, e2), "must equal a one-sided emitter");
    let together = (e1 * e1 + e3 * e3).sqrt();
    assert!((one - turned).abs() < 3.6 * together, "{one} ± {e1}, {turned} ± {e3}");
    assert!(e1 < 0.8 * e3, "inward-facing triangles must have more noise: {e1} {e3}");
}

#[test]
fn rays_inside_a_two_sided_emitter_see_its_emission() {
    let folder = cubes(0.5);
    let world = world(folder.path(), "MaterialIndex 1 TriangleMesh { obj_file out.obj }");
    let ray = Ray::new(Vec3::ZERO, Vec3::new(0.6, 0.0, 0.8));
    assert_light("inside", &world, ray, 0, 3.0);
}
