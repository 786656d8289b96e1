//! Tests that rays and hits are computed in the same way as in the course's programs since 2012.
//! Without the quirks, the results must be correct.

#![allow(clippy::disallowed_methods, reason = "the official programs call the platform's tangent")]

use durer::camera::{CameraSample, Projection};
use durer::diag::{Diagnostics, Files};
use durer::dialect::{Dialect, Quirk};
use durer::integrator::{RenderSettings, Whitted};
use durer::math::{Color, Ray, Ray64, Vec2, Vec3};
use durer::world::{Hit, World};
use durer::{LoadOptions, load_text};
use std::path::Path;

/// Compiles a world in a dialect with its quirks, except the quirks in `off`. Files are read from
/// `folder`.
fn world_in(folder: &Path, text: &str, dialect: Dialect, off: &[Quirk]) -> (World, Diagnostics) {
    let compat = off.iter().map(|&compat| (compat, false)).collect();
    let options = LoadOptions { dialect: Some(dialect), compat, course: true, ..LoadOptions::default() };
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let path = folder.join("scene.txt");
    let loaded = load_text(&path, text.as_bytes().into(), &options, &mut files, &mut diagnostics);
    let world = loaded.and_then(|loaded| loaded.compile(&options, &mut files, &mut diagnostics));
    (world.unwrap_or_else(|| panic!("{diagnostics:?}")), diagnostics)
}

fn world(text: &str, dialect: Dialect) -> World {
    world_in(Path::new("."), text, dialect, &[]).0
}

fn ray(origin: [f32; 3], dir: [f32; 3]) -> Ray64 {
    Ray::new(origin.into(), dir.into()).into()
}

fn hit(world: &World, origin: [f32; 3], dir: [f32; 3]) -> Option<Hit> {
    world.closest(ray(origin, dir), &mut ())
}

fn traced_color(world: &World, origin: [f32; 3], dir: [f32; 3]) -> Color {
    let settings = RenderSettings {
        bounces: 2,
        shadows: true,
        shade_back: false,
        transparent_shadows: false,
        reflection: true,
        refraction: true,
        min_weight: 0.0,
    };
    let ray = Ray::new(origin.into(), Vec3::from(dir).normalize());
    Whitted { world, settings, cancel: None }.radiance(&ray, &mut ())
}

/// Returns a scene in the language used before 2020, with a camera, lights, and objects that share
/// one white material.
fn classic(lights: &str, objects: &[&str]) -> String {
    let count = lights.matches("Light {").count();
    format!(
        "PerspectiveCamera {{ center 0 0 9 direction 0.1 -0.2 -3 up 0.1 2 0 angle 40 }}
         Lights {{ numLights {count} {lights} }}
         Background {{ color 0 0 0 ambientLight 0 0 0 }}
         Materials {{ numMaterials 1 PhongMaterial {{ diffuseColor 1 1 1 }} }}
         Group {{ numObjects {} MaterialIndex 0 {} }}",
        objects.len(),
        objects.join(" ")
    )
}

/// Returns a scene of nodes. Each node has a transform and an object.
fn nodes(objects: &[&str]) -> String {
    let node = |object: &&str| format!("Node {{ Component<Material> {{ index 0 }} {object} }}\n");
    format!(
        "Camera {{ center 0 0 9 direction 0.1 -0.2 -3 up 0.1 2 0 fov 40 }}
         Background {{ color 0 0 0 ambient_light 1 1 1 }}
         Materials {{ Material {{ diffuse 1 1 1 }} }}
         Scene {{ {} }}",
        objects.iter().map(node).collect::<String>()
    )
}

const SUN: &str = "DirectionalLight { direction 0 -1 0 color 1 1 1 }";

#[test]
fn secondary_rays_of_2016_start_farther_along_and_those_of_2012_have_a_minimum_t() {
    // A light that is 0.005 in front of the right wall illuminates the left wall at a distance of
    // 1.995. The ray hits the right wall at t = 1.99, because its start is moved by 0.01 along its
    // direction.
    let light = "PointLight { position 0.995 1 0 color 1 1 1 falloff 0.25 }";
    let scene = classic(light, &["Plane { normal 1 0 0 offset -1 }", "Plane { normal -1 0 0 offset -1 }"]);
    let left = |world: &World| traced_color(world, [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]);
    assert_eq!(left(&world(&scene, Dialect::F16)), Color::ZERO);
    assert!(left(&world_in(Path::new("."), &scene, Dialect::F16, &[Quirk::MovedStarts]).0).x > 0.9);
    assert!(left(&world(&scene, Dialect::F12a5)).x > 0.4);
    let scene = nodes(&[
        "Component<Object> { type plane normal 1 0 0 offset -1 }",
        "Component<Object> { type plane normal -1 0 0 offset -1 }",
    ]);
    let light =
        "Node { Transform { translate 0.995 1 0 } Component<Light> { type point color 1 1 1 attenuation 0.25 } } }";
    let scene = scene.trim_end().trim_end_matches('}').to_string() + light;
    let scene = scene.replace("ambient_light 1 1 1", "ambient_light 0 0 0");
    assert_eq!(left(&world(&scene, Dialect::F23)), Color::ZERO);
}

#[test]
fn plane_is_hit_at_the_ray_origin_since_2016() {
    let plane = ["Plane { normal 0 1 0 offset 1 }"];
    let on =
        |world: &World| hit(world, [0.0, 1.0, 0.0], [0.6, 0.0, 0.8]).or(hit(world, [0.0, 1.0, 0.0], [0.0, -1.0, 0.0]));
    for (dialect, closed) in [(Dialect::F12a4, false), (Dialect::F12a5, false), (Dialect::F16, true)] {
        assert_eq!(on(&world(&classic(SUN, &plane), dialect)).map(|hit| hit.t), closed.then_some(0.0), "{dialect:?}");
    }
    let world = world(&nodes(&["Component<Object> { type plane normal 0 1 0 offset 1 }"]), Dialect::F23);
    assert_eq!(on(&world).map(|hit| hit.t), Some(0.0));
}

#[test]
fn object_space_rays_of_2020_are_differences_of_two_points() {
    let plane = "Component<Object> { type plane normal 0 3 0 offset -4.5 }";
    let ball = "Transform { translate 3 -2 1 } Component<Object> { type sphere radius 900 }";
    let world = world(&nodes(&[plane, ball]), Dialect::F23);
    let origin = Vec3::new(1234.5678, 3.3, -777.7);
    let mut differ = 0;
    for i in 1..200 {
        let dir = Vec3::new(0.6, -0.001 * i as f32, 0.79).normalize();
        let moved = (origin + dir) - origin;
        let t = (-4.5 - (0.0 * origin.x + 3.0 * origin.y + 0.0 * origin.z))
            / (0.0 * moved.x + 3.0 * moved.y + 0.0 * moved.z);
        let found = world.closest(Ray::new(origin, dir), &mut ()).unwrap();
        if found.object == 0 {
            assert_eq!(found.t.to_bits(), t.to_bits(), "{dir}");
        }
        let plain = (-4.5 - 3.0 * origin.y) / (3.0 * dir.y);
        differ += usize::from(plain.to_bits() != t.to_bits());
    }
    assert!(differ > 150, "{differ}");
}

/// Returns the ray through a point of the picture for the camera as it is written in the scene.
fn camera_ray(world: &World, point: Vec2) -> Vec3 {
    world.camera().ray(world.camera_frame(), &CameraSample::at(point)).unwrap().dir
}

#[test]
fn camera_rays_are_sums_of_the_axes_of_their_year() {
    let [d, up] = [Vec3::new(0.1, -0.2, -3.0), Vec3::new(0.1, 2.0, 0.0)];
    let unit = |v: Vec3| v / (v.x * v.x + v.y * v.y + v.z * v.z).sqrt();
    let by_reciprocal = |v: Vec3| v * (1.0 / (v.x * v.x + v.y * v.y + v.z * v.z).sqrt());
    let angle = (std::f64::consts::PI * 40.0 / 180.0) as f32;
    let right = unit(d.cross(up));
    let distance = (1.0 / (f64::from(angle) / 2.0).tan()) as f32;
    let single = 1.0 / ((f64::from(angle / 2.0)).tan() as f32);
    let of_2020 = 1.0 / ((f64::from(40.0_f32 / 180.0 * std::f32::consts::PI / 2.0)).tan() as f32);
    let [forward, glm_up] = [by_reciprocal(d), by_reciprocal(up)];
    let classic = classic(SUN, &["Sphere { center 0 0 0 radius 1 }"]);
    let nodes = nodes(&["Component<Object> { type sphere radius 1 }"]);
    for (x, y) in [(-1.0, -1.0), (0.3, 0.7), (0.0, 0.5), (1.0, -0.123)] {
        let sum = |distance: f32, w: Vec3, u: Vec3, v: Vec3| distance * w + x * u + y * v;
        let ray = |text: &str, dialect| camera_ray(&world(text, dialect), Vec2::new(x, y));
        let perpendicular = unit(sum(distance, unit(d), right, unit(right.cross(d))));
        assert_eq!(ray(&classic, Dialect::F12a4), perpendicular);
        assert_eq!(ray(&classic, Dialect::F12a5), perpendicular);
        assert_eq!(ray(&classic, Dialect::F16), unit(sum(single, unit(d), right, up)));
        let across = by_reciprocal(forward.cross(glm_up));
        assert_eq!(ray(&nodes, Dialect::F23), by_reciprocal(sum(of_2020, forward, across, glm_up)));
    }
}

#[test]
fn triangle_of_2012_wins_ties() {
    let triangle = "Triangle { vertex0 -1 0 1 vertex1 1 0 1 vertex2 0 0 -2 }";
    let plane = "Plane { normal 0 1 0 offset 0 }";
    for (dialect, tied) in [(Dialect::F12a4, true), (Dialect::F12a5, true), (Dialect::F16, false)] {
        let first = |objects: &[&str]| hit(&world(&classic(SUN, objects), dialect), [0.0, 1.0, 0.0], [0.0, -1.0, 0.0]);
        assert_eq!(first(&[plane, triangle]).unwrap().object, u32::from(tied), "{dialect:?}");
        assert_eq!(first(&[triangle, plane]).unwrap().object, 0, "{dialect:?}");
        assert_eq!(first(&[triangle, triangle]).unwrap().object, u32::from(tied), "{dialect:?}");
    }
}

/// Returns a closed mesh of 48 triangles, which is an octahedron with each face divided into six
/// triangles around its centre.
fn stone() -> String {
    let mut text = String::from("v 0 0 0\n");
    let mut count = 1;
    for i in 0..8 {
        let sign = |bit: i32| if i & bit != 0 { 1.0_f32 } else { -1.0 };
        let [a, b, c] = [[sign(1), 0.0, 0.0], [0.0, sign(2), 0.0], [0.0, 0.0, sign(4)]].map(Vec3::from);
        let ring = [a, (a + b) / 2.0, b, (b + c) / 2.0, c, (c + a) / 2.0];
        let middle = (a + b + c) / 3.0;
        for k in 0..6 {
            for p in [middle, ring[k], ring[(k + 1) % 6]] {
                text += &format!("v {} {} {}\n", p.x, p.y, p.z);
            }
            text += &format!("f {} {} {}\n", count + 1, count + 2, count + 3);
            count += 3;
        }
    }
    text
}

#[test]
fn axis_parallel_ray_misses_half_of_a_mesh() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("stone.obj"), stone()).unwrap();
    let classic = classic(SUN, &["TriangleMesh { obj_file stone.obj }"]);
    let nodes = nodes(&["Component<Object> { type mesh obj_file stone.obj }"]);
    for (text, dialect, holes) in [
        (&classic, Dialect::F12a4, false),
        (&classic, Dialect::F12a5, true),
        (&classic, Dialect::F16, true),
        (&nodes, Dialect::F23, true),
    ] {
        let (world, _) = world_in(folder.path(), text, dialect, &[]);
        let down = |x: f32, y: f32| hit(&world, [x, y, 5.0], [0.0, 0.0, -1.0]);
        assert_eq!(down(0.35, 0.3).is_none(), holes, "{dialect:?}");
        // On the near side, the ray visits only cells at the lowest corner of the mesh, and they
        // are empty.
        assert_eq!(down(-0.35, -0.3).is_none(), holes, "{dialect:?}");
        let inclined = hit(&world, [0.35, 0.3, 5.0], [1e-7, 1e-7, -1.0]).unwrap();
        assert!((inclined.t - 4.65).abs() < 1e-5, "{dialect:?} {inclined:?}");
        let (mended, _) = world_in(folder.path(), text, dialect, &[Quirk::OctreeHoles]);
        assert!(hit(&mended, [0.35, 0.3, 5.0], [0.0, 0.0, -1.0]).is_some(), "{dialect:?}");
    }
}

#[test]
fn octree_hits_equal_brute_force_hits() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("stone.obj"), stone()).unwrap();
    let mut random = durer::math::random::Random(5);
    let around = "Transform { Translate 0.1 -0.2 0.3 YRotate 30 Scale 1.5 0.7 1";
    let mesh = format!("{around} TriangleMesh {{ obj_file stone.obj }} }}");
    let text = stone();
    let points: Vec<Vec3> = text
        .lines()
        .filter_map(|line| line.strip_prefix("v "))
        .map(|line| {
            let v: Vec<f32> = line.split(' ').map(|x| x.parse().unwrap()).collect();
            Vec3::new(v[0], v[1], v[2])
        })
        .skip(1)
        .collect();
    let show = |p: Vec3| format!("{} {} {}", p.x, p.y, p.z);
    let triangles: Vec<String> = points
        .as_chunks::<3>()
        .0
        .iter()
        .map(|&[a, b, c]| {
            let corners = format!("vertex0 {} vertex1 {} vertex2 {}", show(a), show(b), show(c));
            format!("{around} Triangle {{ {corners} }} }}")
        })
        .collect();
    let parts: Vec<&str> = triangles.iter().map(String::as_str).collect();
    for dialect in [Dialect::F12a4, Dialect::F12a5, Dialect::F16] {
        let (whole, _) = world_in(folder.path(), &classic(SUN, &[&mesh]), dialect, &[]);
        let apart = world(&classic(SUN, &parts), dialect);
        let mut hits = 0;
        for _ in 0..2000 {
            let origin = 4.0 * random.direction();
            let ray = Ray::new(origin, (0.8 * random.direction() - origin).normalize());
            let [a, b] = [&whole, &apart].map(|world| world.closest(ray, &mut ()));
            assert_eq!(a.map(|hit| (hit.t, hit.uv, hit.part)), b.map(|hit| (hit.t, hit.uv, hit.object)), "{dialect:?}");
            hits += usize::from(a.is_some());
        }
        assert!(hits > 500, "{hits}");
    }
}

#[test]
fn glass_of_2012_uses_plane_normals_as_written() {
    let pane = |normal: &str, offset: f32| {
        format!(
            "PerspectiveCamera {{ center 0 5 0 direction 0 -1 0 up 0 0 1 angle 40 }}
             Background {{ color 0 0 0 ambientLight 1 1 1 }}
             Lights {{ numLights 1 DirectionalLight {{ direction 0 1 0 color 0 0 0 }} }}
             Materials {{ numMaterials 2
               PhongMaterial {{ diffuseColor 0 0 0 specularColor 1 1 1 shininess 1 refractionIndex 1.5 }}
               PhongMaterial {{ diffuseColor 1 1 1 }} }}
             Group {{ numObjects 2 MaterialIndex 0 Plane {{ normal {normal} offset {offset} }}
               MaterialIndex 1 Sphere {{ center 0 -2 0 radius 1 }} }}"
        )
    };
    // At normal incidence, the pane lets through a share of 1 - R of the ball's light.
    let share = |text: &str, off: &[Quirk]| {
        traced_color(&world_in(Path::new("."), text, Dialect::F12a5, off).0, [0.0, 5.0, 0.0], [0.0, -1.0, 0.0]).x
    };
    let unit = share(&pane("0 1 0", 0.0), &[]);
    assert!((unit - 0.96).abs() < 1e-5, "{unit}");
    // For a normal of length 2, c = |d·N| is 2 and R = R0 + (1 - R0) (1 - 2)^5 = 0.04 - 0.96.
    let long = share(&pane("0 2 0", 0.0), &[]);
    assert!((long - 1.92).abs() < 1e-5, "{long}");
    assert!((share(&pane("0 2 0", 0.0), &[Quirk::RawRefraction]) - 0.96).abs() < 1e-5);
}

#[test]
fn mirrors_of_2012_and_2016_keep_the_length_that_the_normal_of_a_plane_gives_a_ray() {
    let scene = |center: &str| {
        format!(
            "PerspectiveCamera {{ center 0 5 0 direction 0 -1 0 up 0 0 1 angle 40 }}
             Background {{ color 0 0 0 ambientLight 1 1 1 }}
             Lights {{ numLights 1 DirectionalLight {{ direction 0 1 0 color 0 0 0 }} }}
             Materials {{ numMaterials 2
               PhongMaterial {{ diffuseColor 0 0 0 specularColor 1 1 1 shininess 1 }}
               PhongMaterial {{ diffuseColor 1 1 1 }} }}
             Group {{ numObjects 2 MaterialIndex 0 Plane {{ normal 0 2 0 offset 0 }}
               MaterialIndex 1 Sphere {{ center {center} radius 0.3 }} }}"
        )
    };
    // The reflected direction is d - 2 (d·N) N. With this normal, (1, -1, 0) becomes (1, 7, 0), and
    // with a unit normal, it becomes (1, 1, 0).
    for dialect in [Dialect::F12a5, Dialect::F16] {
        let share = |center: &str| traced_color(&world(&scene(center), dialect), [-5.0, 5.0, 0.0], [1.0, -1.0, 0.0]).x;
        assert_eq!((share("1 7 0"), share("5 5 0")), (1.0, 0.0), "{dialect:?}");
    }
}

#[test]
fn weights_of_mirrored_rays_below_zero_count_in_2012() {
    let scene = "PerspectiveCamera { center 0 5 0 direction 0 -1 0 up 0 0 1 angle 40 }
        Background { color 0.5 0.5 0.5 ambientLight 1 1 1 }
        Lights { numLights 1 DirectionalLight { direction 0 1 0 color 0 0 0 } }
        Materials { numMaterials 2
          PhongMaterial { diffuseColor 0 0 0 specularColor 1 1 1 shininess 1 refractionIndex 1.5 }
          PhongMaterial { diffuseColor 1 1 1 } }
        Group { numObjects 2 MaterialIndex 0 Plane { normal 0 2 0 offset 0 }
          MaterialIndex 1 Sphere { center 0 -2 0 radius 1 } }";
    // The expected light is R times the background plus 1 - R times the ball, where R = 0.04 -
    // 0.96.
    let light = traced_color(&world(scene, Dialect::F12a5), [0.0, 5.0, 0.0], [0.0, -1.0, 0.0]).x;
    assert!((light - (1.92 - 0.92 * 0.5)).abs() < 1e-5, "{light}");
}

#[test]
fn highlights_beyond_all_numbers_spoil_black_ones_too() {
    let plane = |normal: &str| {
        let plane = format!("Plane {{ normal {normal} offset 0 }}");
        classic(SUN, &[&plane]).replace("diffuseColor 1 1 1", "diffuseColor 1 1 1 specularColor 0 0 0 shininess 200")
    };
    for dialect in [Dialect::F12a4, Dialect::F16] {
        let light = |normal| traced_color(&world(&plane(normal), dialect), [0.0, 5.0, 0.0], [0.0, -1.0, 0.0]).x;
        // The base of the power is 7 for a normal of length 2, and 1 for a unit normal.
        assert!(light("0 2 0").is_nan(), "{dialect:?}");
        assert_eq!(light("0 1 0"), 1.0, "{dialect:?}");
    }
}

#[test]
fn spheres_are_hit_at_10000_where_a_ray_leaves_them_until_2019() {
    let ball = "Sphere { center 0 0 0 radius 1 }";
    for dialect in [Dialect::F12a4, Dialect::F12a5, Dialect::F16] {
        let found = hit(&world(&classic(SUN, &[ball]), dialect), [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]);
        assert_eq!(found.map(|hit| hit.t), Some(10_000.0), "{dialect:?}");
    }
    // Since 2020, the sphere is hit at the start of the ray.
    let ball = "Component<Object> { type sphere radius 1 }";
    let found = hit(&world(&nodes(&[ball]), Dialect::F23), [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]);
    assert_eq!(found.map(|hit| hit.t), Some(0.0));
}

#[test]
fn triangles_of_2012_block_a_ray_that_ends_on_them() {
    let triangle = "Triangle { vertex0 -1 -1 0 vertex1 1 -1 0 vertex2 0 1 0 }";
    for (dialect, blocks) in [(Dialect::F12a5, true), (Dialect::F16, false)] {
        let world = world(&classic(SUN, &[triangle]), dialect);
        let ends = Ray { t_max: 5.0, ..Ray::new(Vec3::new(0.0, 0.0, 5.0), Vec3::NEG_Z) };
        assert_eq!(world.occluded(ends, &mut ()), blocks, "{dialect:?}");
    }
}

#[test]
fn normals_of_spheres_are_rounded_as_in_the_program_of_their_year() {
    // On a sphere of radius 1000, the rounding error of the hit point changes the normal.
    let ground = "Sphere { center 0 -1002 0 radius 1000 }";
    let (eye, dir) = (Vec3::new(1.5, 2.25, 9.0), Vec3::new(0.1, -0.2, -1.0).normalize());
    for dialect in [Dialect::F12a4, Dialect::F16] {
        let world = world(&classic(SUN, &[ground]), dialect);
        let found = world.closest(Ray::new(eye, dir), &mut ()).unwrap();
        let away = eye + found.t * dir - Vec3::new(0.0, -1002.0, 0.0);
        assert_eq!(world.interaction(Ray::new(eye, dir), found).surface.n_shade, away / away.length(), "{dialect:?}");
    }
    let node = "Transform { translate 0 -1002 0 } Component<Object> { type sphere radius 1000 }";
    let world = world(&nodes(&[node]), Dialect::F23);
    let found = world.closest(Ray::new(eye, dir), &mut ()).unwrap();
    let unit = |v: Vec3| v * (1.0 / v.dot(v).sqrt());
    let own = eye + Vec3::new(0.0, 1002.0, 0.0);
    let to = (eye + dir + Vec3::new(0.0, 1002.0, 0.0)) - own;
    assert_eq!(world.interaction(Ray::new(eye, dir), found).surface.n_shade, unit(unit(own + found.t * to)));
}
