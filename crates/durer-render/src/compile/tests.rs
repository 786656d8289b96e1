//! Tests of compilation errors and their messages.

use super::testing::try_read;
use super::*;
use durer_scene::dialect::Dialect;
use durer_scene::math::Ray;
use std::path::Path;

const CAMERA: &str = "PerspectiveCamera { center 0 0 9 direction 0 0 -1 up 0 1 0 angle 40 }\n";

fn errors(text: &str, accel: AccelKind) -> Vec<String> {
    let (world, findings) = try_read(&format!("{CAMERA}{text}"), Dialect::Durer.rules(), accel, Path::new("."));
    assert_eq!(world.is_none(), findings.has_errors());
    let errors = findings.iter().filter(|d| d.severity == durer_diag::Severity::Error);
    errors.map(|d| d.message.clone()).collect()
}

#[test]
fn singular_transforms_are_rejected() {
    let ball = "Sphere { center 0 0 0 radius 1 }";
    let flat = "are singular, or their numbers overflow";
    for ops in [
        "Matrix { 1 2 3 0  2 4 6 0  0 0 1 0  0 0 0 1 }",
        "Matrix { 0 0 0 0  0 0 0 0  0 0 0 0  0 0 0 1 }",
        "UniformScale 1e30 UniformScale 1e30",
        "UniformScale 1e-30 UniformScale 1e-30",
    ] {
        let found = errors(&format!("Group {{ Transform {{ {ops} {ball} }} }}"), AccelKind::Bvh);
        assert!(found.len() == 1 && found[0].contains(flat), "{ops}: {found:?}");
    }
    assert_eq!(errors(&format!("Group {{ Transform {{ UniformScale 1e-20 {ball} }} }}"), AccelKind::Bvh), [""; 0]);
    assert_eq!(errors("Group { Transform { Scale 1 0 1 Sphere { center 0 0 0 radius 1 } } }", AccelKind::Bvh).len(), 1);
}

#[test]
fn materials_with_too_many_parts_or_levels_are_rejected() {
    let chain = |count: usize, solid: &dyn Fn(usize) -> String| {
        let solids: String = (0..count).map(solid).collect();
        errors(&format!("Materials {{ Material {{ }} {solids} }} Group {{ }}"), AccelKind::Bvh)
    };
    let doubled = |i: usize| format!("Noise {{ materialIndex {i} materialIndex {i} octaves 1 }} ");
    let nested = |i: usize| format!("Checkerboard {{ materialIndex {i} materialIndex 0 }} ");
    assert_eq!(chain(12, &doubled), [""; 0]);
    assert_eq!(chain(60, &doubled), ["this material is nested 13 levels deep and has 8192 parts"]);
    assert_eq!(chain(64, &nested), [""; 0]);
    assert_eq!(chain(100_000, &nested), ["this material is nested 65 levels deep and has 66 parts"]);
}

#[test]
fn solids_reject_parts_without_an_inside() {
    let ball = "Sphere { center 0 0 0 radius 1 }";
    let open = "a surface without an inside cannot be part of a solid";
    for flat in [
        "Disc { center 0 0 0 normal 0 1 0 radius 1 }",
        "Rectangle { corner 0 0 0 edge0 1 0 0 edge1 0 1 0 }",
        "Triangle { vertex0 0 0 0 vertex1 1 0 0 vertex2 0 1 0 }",
    ] {
        for text in [
            format!("Group {{ Difference {{ {ball} {flat} }} }}"),
            format!("Group {{ Union {{ Transform {{ Scale 1 2 1 Group {{ {ball} {flat} }} }} }} }}"),
            format!("Group {{ Xor {{ {ball} Merge {{ {flat} }} }} }}"),
        ] {
            assert_eq!(errors(&text, AccelKind::Bvh), [open], "{text}");
        }
    }
    for name in ["Union", "Merge", "Intersection", "Difference", "Xor"] {
        assert_eq!(
            errors(&format!("Group {{ {name} {{ }} }}"), AccelKind::Bvh),
            [format!("this `{name}` has no parts")]
        );
        assert_eq!(errors(&format!("Group {{ {name} {{ {ball} }} }}"), AccelKind::Bvh), [""; 0]);
    }
    let empty = format!("Group {{ Merge {{ {ball} Group {{ }} }} }}");
    assert_eq!(errors(&empty, AccelKind::Bvh), ["an empty `Group` cannot be part of a solid"]);
    // Unbounded shapes are allowed, even if they make the solid unbounded.
    let endless = format!("Group {{ Merge {{ {ball} Plane {{ normal 0 1 0 offset 0 }} }} }}");
    for accel in [AccelKind::Bvh, AccelKind::Grid(None), AccelKind::None] {
        assert_eq!(errors(&endless, accel), [""; 0]);
    }
}

#[test]
fn solids_reject_open_meshes_and_accept_closed_ones() {
    let folder = tempfile::tempdir().unwrap();
    let corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
    let sides = ["f 1 3 2\n", "f 1 2 4\n", "f 2 3 4\n", "f 1 4 3\n"];
    let write = |name: &str, text: String| std::fs::write(folder.path().join(name), text).unwrap();
    write("closed.obj", format!("{corners}{}", sides.concat()));
    write("open.obj", format!("{corners}{}", sides[..3].concat()));
    // Each triangle has its own vertices, although their positions coincide.
    write("loose.obj", format!("{corners}{corners}{}f 5 8 7\n", sides[..3].concat()));
    for (name, closed) in [("closed", true), ("open", false), ("loose", true)] {
        let text = format!(
            "{CAMERA}Group {{ Difference {{ TriangleMesh {{ obj_file {name}.obj }} \
            Sphere {{ center 0 0 0 radius 0.5 }} }} }}"
        );
        let (world, findings) = try_read(&text, Dialect::Durer.rules(), AccelKind::Bvh, folder.path());
        assert_eq!(world.is_some(), closed, "{name} {findings:?}");
        let error = findings.iter().find(|d| d.severity == durer_diag::Severity::Error);
        if let Some(error) = error {
            assert_eq!(error.message, "the mesh `open.obj` is not closed and cannot be part of a solid");
            assert!(error.span.is_some() && error.help.as_ref().unwrap().contains("the edge from 0 0 "), "{error:?}");
        }
    }
}

#[test]
fn shapes_with_inconsistent_fields_are_rejected() {
    for (shape, message) in [
        ("Box { min 0 0 0 max 1 0 1 }", "`min` of a `Box` must be less than its `max` in x, y and z"),
        ("Cylinder { base 1 1 1 top 1 1 1 radius 1 }", "`base` and `top` of a `Cylinder` must not be the same point"),
        ("Cone { base 0 0 0 top 0 1 0 baseRadius 0 }", "one of the radii of a `Cone` must be more than 0"),
        (
            "Torus { center 0 0 0 majorRadius 1 minorRadius 1 }",
            "`minorRadius` of a `Torus` must be less than its `majorRadius`",
        ),
        ("Ellipsoid { center 0 0 0 radii 1 0 1 }", "all `radii` of an `Ellipsoid` must be more than 0"),
        (
            "Quadric { squares 0 0 0 constant 1 }",
            "a `Quadric` needs at least one coefficient, besides `constant`, that is not 0",
        ),
        (
            "Disc { center 0 0 0 normal 0 1 0 radius 1 innerRadius 1 }",
            "`innerRadius` of a `Disc` must be less than its `radius`",
        ),
        ("Rectangle { corner 0 0 0 edge0 1 2 3 edge1 2 4 6 }", "the edges of a `Rectangle` must not be parallel"),
    ] {
        assert_eq!(errors(&format!("Group {{ {shape} }}"), AccelKind::Bvh), [message]);
        let solid = format!("Group {{ Merge {{ {shape} }} }}");
        assert!(errors(&solid, AccelKind::Bvh).contains(&message.to_string()), "{solid}");
    }
}

#[test]
fn height_fields_are_closed_meshes() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("hills.ppm"), b"P6 3 2 255\n\0\0\0\xff\xff\xff\0\0\0\0\0\0\0\0\0\0\0\0").unwrap();
    std::fs::write(folder.path().join("dot.ppm"), b"P6 1 1 255\n\0\0\0").unwrap();
    let read = |body: &str| {
        let text = format!("{CAMERA}Group {{ {body} }}");
        try_read(&text, Dialect::Durer.rules(), AccelKind::Bvh, folder.path())
    };
    let field = "HeightField { picture hills.ppm min 0 0 0 max 2 1 1 depth 0.5 }";
    let world = read(field).0.unwrap();
    let Geometry::Mesh(tree) = &world.objects()[0].geometry else { panic!() };
    assert!(tree.mesh.open_edges().is_empty());
    assert_eq!((tree.mesh.len(), world.bounds().min, world.bounds().max.y), (4 + 18, [0.0, -0.5, 0.0].into(), 1.0));
    // The white pixel is in the middle of the top row, where z is smallest.
    let down = |x: f32, z: f32| {
        let ray = durer_scene::math::Ray::new([x, 5.0, z].into(), [0.0, -1.0, 0.0].into());
        world.closest(&ray, &mut ()).map(|hit| 5.0 - hit.t)
    };
    assert_eq!((down(1.0, 1e-6).unwrap() * 1e4).round(), 1e4);
    assert_eq!((down(0.5, 1e-6).unwrap() * 1e4).round(), 5e3);
    assert!(down(0.5, 1.0 - 1e-6).unwrap().abs() < 1e-5 && down(2.1, 0.5).is_none());
    assert!(read(&format!("Difference {{ {field} Sphere {{ center 1 1 0 radius 0.3 }} }}")).0.is_some());
    let refused = |body: &str, what: &str| {
        let (world, findings) = read(body);
        assert!(world.is_none() && findings.iter().any(|d| d.message.contains(what)), "{findings:?}");
    };
    refused("HeightField { picture dot.ppm min 0 0 0 max 1 1 1 }", "in all, not 1 x 1");
    refused("HeightField { picture none.ppm min 0 0 0 max 1 1 1 }", "the height image cannot be read");
    refused("HeightField { picture hills.ppm min 0 0 0 max 1 0 1 }", "`min` of a `HeightField` must be less");
}

#[test]
fn a_picture_multiplies_the_share_of_a_mix() {
    use durer_scene::math::{Ray, Vec3};
    let folder = tempfile::tempdir().unwrap();
    let mut picture = b"PF\n2 1\n-1\n".to_vec();
    [1.0_f32, 1.0, 1.0, 0.25, 0.25, 0.25].iter().for_each(|value| picture.extend(value.to_le_bytes()));
    std::fs::write(folder.path().join("share.pfm"), picture).unwrap();
    let text = |picture: &str| {
        format!(
            "{CAMERA}Materials {{ PhongMaterial {{ diffuseColor 1 0 0 }} PhongMaterial {{ diffuseColor 0 0 1 }}\n\
             Mix {{ materialIndex 0 materialIndex 1 share 0.8 shareTexture {picture} }} }}\n\
             Group {{ MaterialIndex 2 Rectangle {{ corner 0 0 0 edge0 4 0 0 edge1 0 1 0 }}\n\
             Sphere {{ center 9 0 0 radius 1 }} }}"
        )
    };
    let (world, found) = try_read(&text("share.pfm"), Dialect::Durer.rules(), AccelKind::Bvh, folder.path());
    let world = world.unwrap_or_else(|| panic!("{found:?}"));
    for (x, share) in [(1.0, 0.8), (3.0, 0.2)] {
        let at = world.intersect(&Ray::new(Vec3::new(x, 0.5, 5.0), Vec3::NEG_Z), &mut ()).unwrap();
        let parts = world.materials_at(&at);
        let shares: Vec<f32> = parts.iter().map(|part| part.share).collect();
        assert!((shares[0] - share).abs() < 1e-6 && (shares[1] - 1.0 + share).abs() < 1e-6, "{shares:?}");
        assert_eq!(parts[0].phong.diffuse, Vec3::X);
    }
    let (world, found) = try_read(&text("none.png"), Dialect::Durer.rules(), AccelKind::Bvh, folder.path());
    assert!(world.is_none() && found.has_errors());
}

#[test]
fn cell_grid_needs_a_volume() {
    let grid = |max: &str| {
        errors(
            &format!(
                "Group {{ Grid {{ min 0 0 0 max {max} numCells 2 2 2 rasterizeSphere {{ center 0 0 0 radius 1 }} }} }}"
            ),
            AccelKind::Bvh,
        )
    };
    assert_eq!(grid("1 1 1"), [""; 0]);
    for max in ["1 0 1", "1 1 -1"] {
        assert_eq!(
            grid(max),
            ["each coordinate of the grid's `max` must be greater than the same coordinate of `min`"]
        );
    }
}

#[test]
fn invalid_grids_are_rejected() {
    let balls = "Sphere { center 0 0 0 radius 1 } ".repeat(1000);
    assert_eq!(errors(&format!("Group {{ {balls} }}"), AccelKind::Grid(Some([0, 1, 1]))).len(), 1);
    assert_eq!(errors(&format!("Group {{ {balls} }}"), AccelKind::Grid(Some([256, 256, 256]))).len(), 1);
    assert_eq!(errors(&format!("Group {{ {balls} }}"), AccelKind::Grid(None)), [""; 0]);
    // Without bounded objects, no grid is built.
    assert_eq!(errors("Group { Plane { normal 0 1 0 offset 0 } }", AccelKind::Grid(None)), [""; 0]);
}

#[test]
fn tables_of_a_material_are_computed_before_rays_are_traced() {
    use crate::world::Material;
    for (words, opaque_glass_coat) in [
        ("", [true, false, false]),
        ("specularRoughness 0", [false; 3]),
        ("baseMetalness 1", [false; 3]),
        ("baseMetalness 0.5", [true, false, false]),
        ("transmissionWeight 1 specularIor 1.4", [false, true, false]),
        ("transmissionWeight 1 walls thin", [false; 3]),
        ("specularRoughness 0 coatWeight 0.5 coatRoughness 0.2", [true, false, true]),
        ("baseMetalness 1 coatWeight 0.5 coatRoughness 0.2", [false, false, true]),
    ] {
        // An opaque base with half the specular weight has a different index of refraction than
        // glass.
        let text = format!("{CAMERA} Materials {{ PrincipledMaterial {{ specularWeight 0.5 {words} }} }} Group {{ }}");
        let world = super::testing::read(&text);
        let Material::Phong(phong) = &world.materials()[0] else { panic!("{words}") };
        let own = phong.principled.as_ref().unwrap();
        assert_eq!(own.tables.prepared(), opaque_glass_coat, "{words}");
        // Shading must not need any other tables.
        let lanes = durer_scene::spectrum::Lanes::Rgb;
        let wo = Vec3::new(0.6, 0.0, 0.8);
        for inside in [false, true] {
            let eta = if inside { 1.0 / own.definition.specular_ior } else { own.definition.specular_ior };
            let view = durer_scene::bsdf::view::View { lanes: &lanes, wo, normal: Vec3::Z, inside, eta };
            durer_scene::bsdf::layers::push_lobes(&mut Default::default(), 1.0, &own.parameters, &own.tables, view);
        }
        assert_eq!(own.tables.prepared(), opaque_glass_coat, "{words}");
    }
}

#[test]
fn outlying_objects_are_excluded_from_the_grid() {
    let balls: String = (0..500).map(|i| format!("Sphere {{ center {} {} 0 radius 0.4 }} ", i % 25, i / 25)).collect();
    for far in ["Cylinder { base 0 0 -3 top 0 0.1 -1.2e15 radius 1 }", "Sphere { center 0 1e12 -9 radius 7e11 }"] {
        let text = format!("{CAMERA}Group {{ {far} {balls} }}");
        let read = |accel| try_read(&text, Dialect::Durer.rules(), accel, Path::new(".")).0.unwrap();
        let world = read(AccelKind::Grid(None));
        let Accel::Grid { grid, wide, parts } = world.accel() else { panic!("a grid") };
        assert_eq!((wide.as_slice(), parts.len()), (&[(0, 0)][..], 500));
        assert!(grid.cell_size().max_element() < 5.0, "{}", grid.cell_size());
        let tree = read(AccelKind::Bvh);
        let mut random = durer_scene::math::random::Random(5);
        for _ in 0..500 {
            let ray = Ray::new(Vec3::new(12.0, 10.0, 20.0), 0.4 * random.point() - Vec3::Z);
            assert_eq!(world.closest(&ray, &mut ()), tree.closest(&ray, &mut ()), "{ray:?}");
            assert_eq!(world.occluded(&ray, &mut ()), tree.occluded(&ray, &mut ()), "{ray:?}");
        }
    }
    // The ground and the objects on it are stored in one grid.
    let text = format!("{CAMERA}Group {{ Sphere {{ center 0 -100 0 radius 99 }} {balls} }}");
    let (world, _) = try_read(&text, Dialect::Durer.rules(), AccelKind::Grid(None), Path::new("."));
    assert!(matches!(world.unwrap().accel(), Accel::Grid { wide, .. } if wide.is_empty()));
}
