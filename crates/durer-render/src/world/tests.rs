//! Tests that the acceleration structures return identical hits, bit for bit.

use super::*;
use crate::compile::{AccelKind, testing};
use durer_scene::dialect::Dialect;
use durer_scene::math::Ray;
use durer_scene::math::random::{Random, rounds};
use std::fmt::Write;
use std::path::Path;

/// Returns an OBJ file of a sphere with 12 * 4^n triangles, made from a subdivided cube whose
/// vertices are projected outwards.
fn ball_file(cuts: usize) -> String {
    let mut text = String::new();
    let n = 1usize << cuts;
    for face in 0..6 {
        for i in 0..=n {
            for j in 0..=n {
                let (u, v) = (2.0 * i as f32 / n as f32 - 1.0, 2.0 * j as f32 / n as f32 - 1.0);
                let p = [[1.0, u, v], [-1.0, v, u], [v, 1.0, u], [u, -1.0, v], [u, v, 1.0], [v, u, -1.0]][face];
                let p = Vec3::from(p).normalize();
                writeln!(text, "v {:?} {:?} {:?}", p.x, p.y, p.z).unwrap();
            }
        }
    }
    for face in 0..6 {
        for i in 0..n {
            for j in 0..n {
                let at = |i: usize, j: usize| 1 + face * (n + 1) * (n + 1) + i * (n + 1) + j;
                let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                writeln!(text, "f {a} {b} {c}\nf {a} {c} {d}").unwrap();
            }
        }
    }
    text
}

const CUBE: &str = "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n\
    f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 4 8 7 3\nf 1 5 8 4\nf 2 3 7 6\n";

/// Returns a scene of many shapes and meshes in nested groups and transforms. Some objects
/// coincide.
fn scene(random: &mut Random, size: f32) -> String {
    let mut text = String::from("PerspectiveCamera { center 0 0 9 direction 0 0 -1 up 0 1 0 angle 40 }\nGroup {\n");
    let words = |v: Vec3| format!("{:?} {:?} {:?}", v.x, v.y, v.z);
    let mut nested = 0;
    for _ in 0..random.below(60) + 5 {
        let object = match random.below(12) {
            0..4 => format!("Sphere {{ center {} radius {:?} }}", words(size * random.point()), size * 0.3),
            4 => format!("Plane {{ normal {} offset {:?} }}", words(random.direction()), size * random.unit()),
            5 => {
                let [a, b, c] = [0; 3].map(|_| words(size * random.point()));
                format!("Triangle {{ vertex0 {a} vertex1 {b} vertex2 {c} }}")
            }
            6 => "TriangleMesh { obj_file ball.obj }".into(),
            7 => "TriangleMesh { obj_file cube.obj }".into(),
            8 => format!("Box {{ min {} max {} }}", words(Vec3::splat(-0.3 * size)), words(Vec3::splat(0.2 * size))),
            9 => format!(
                "Difference {{ TriangleMesh {{ obj_file cube.obj }} Torus {{ center {} majorRadius 0.6 minorRadius 0.2 }} }}",
                words(random.point())
            ),
            10 => {
                let mut ball =
                    || format!("Sphere {{ center {} radius {:?} }}", words(size * random.point()), size * 0.2);
                format!("Merge {{ {} }}", (0..30).map(|_| ball()).collect::<String>())
            }
            // Use an axis-aligned triangle at integer coordinates, like a floor. Rays can lie in
            // the faces of the triangle's bounding box.
            _ => "Triangle { vertex0 -2 0 -2 vertex1 2 0 -2 vertex2 -2 0 2 }".into(),
        };
        let object = match random.below(3) {
            0 => object,
            1 => format!("Transform {{ {} {object} }}", testing::matrix_words(&random.affine(3.0, size))),
            _ => {
                let [a, b] = [0; 2].map(|_| testing::matrix_words(&random.affine(2.0, size)));
                format!("Transform {{ {a} Transform {{ Translate {} {b} {object} }} }}", words(random.point()))
            }
        };
        // Some objects are repeated once or twice.
        for _ in 0..[1, 1, 1, 2, 3][random.below(5)] {
            text += &object;
            text.push('\n');
        }
        if random.below(8) == 0 {
            text += "Group {\n";
            nested += 1;
        }
    }
    // Groups must not be empty.
    text + "Sphere { center 0 0 0 radius 1 }" + &"}\n".repeat(nested + 1)
}

/// Returns a ray of one of several kinds: random, towards corners, along axes, in faces of boxes,
/// orthographic, or from far away.
fn ray(world: &World, random: &mut Random, size: f32) -> Ray {
    let object = &world.objects()[random.below(world.objects().len())];
    let bounds = object.bounds().unwrap_or(Aabb { min: Vec3::splat(-size), max: Vec3::splat(size) });
    let corner = bounds.corners()[random.below(8)];
    let vertex = match &object.geometry {
        Geometry::Mesh(tree) => tree.mesh.corners(random.below(tree.mesh.len()) as u32)[random.below(3)],
        _ => corner,
    };
    let vertex = object.world_point(vertex);
    let far = [1.0, 1.0, 3.0, 100.0, 1e4][random.below(5)];
    let origin = match random.below(5) {
        0 => corner,
        1 => Vec3::new(corner.x, size * random.point().y, size * random.point().z),
        _ => far * size * 2.0 * random.point(),
    };
    let target = [vertex, corner, bounds.center(), size * random.point()][random.below(4)];
    let dir = match random.below(5) {
        0 => Vec3::AXES[random.below(3)] * random.between(-1.0, 1.0),
        1 => Vec3::new(random.between(-1.0, 1.0), 0.0, random.between(-1.0, 1.0)),
        _ => target - origin,
    };
    let (t_min, t_max) = match random.below(4) {
        0 => (f32::NEG_INFINITY, f32::INFINITY),
        1 => (random.between(0.0, 0.5), random.between(0.5, 2.0)),
        _ => (0.0, f32::INFINITY),
    };
    Ray { origin, dir, t_min, t_max }
}

#[test]
fn all_structures_return_the_same_hit() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("ball.obj"), ball_file(2)).unwrap();
    std::fs::write(folder.path().join("cube.obj"), CUBE).unwrap();
    let mut random = Random(1);
    let (mut hits, mut ties, mut rays) = (0, 0, 0);
    let kinds = [AccelKind::None, AccelKind::Bvh, AccelKind::Grid(None), AccelKind::Grid(Some([7, 3, 5]))];
    for round in 0..60 {
        let size = [1.0, 4.0, 20.0][round % 3];
        let text = scene(&mut random, size);
        let worlds = kinds.map(|kind| {
            let (world, findings) = testing::try_read(&text, Dialect::Durer.rules(), kind, folder.path());
            world.unwrap_or_else(|| panic!("{findings:?}\n{text}"))
        });
        for _ in 0..300 {
            let ray = ray(&worlds[0], &mut random, size);
            rays += 1;
            let expected = worlds[0].closest(&ray, &mut ());
            for (world, kind) in worlds.iter().zip(kinds) {
                let bits = |hit: Option<Hit>| {
                    hit.map(|h| (h.t.to_bits(), h.uv.to_array().map(f32::to_bits), h.object, h.part))
                };
                let found = world.closest(&ray, &mut ());
                assert_eq!(bits(found), bits(expected), "{kind:?} {ray:?}\n{found:?}\n{expected:?}");
                assert_eq!(world.occluded(&ray, &mut ()), expected.is_some(), "{kind:?} {ray:?}");
            }
            hits += usize::from(expected.is_some());
            // Count ties, where another object is hit at the same `t`.
            ties += expected.map_or(0, |hit| {
                let other = |i: &usize| *i != hit.object as usize;
                let same = |i: usize| {
                    worlds[0].objects()[i].closest(0, &ray.into(), false, &mut ()).is_some_and(|c| c.0.t == hit.t)
                };
                usize::from((0..worlds[0].objects().len()).filter(other).any(same))
            });
        }
    }
    assert!(hits > rays / 3 && ties > 300, "{hits} {ties} of {rays}");
}

#[test]
fn invalid_ray_hits_nothing() {
    let text = "PerspectiveCamera { center 0 0 9 direction 0 0 -1 up 0 1 0 angle 40 }\n\
        Group { Plane { normal 1 2 3 offset 0 } Sphere { center 0 0 0 radius 1 }
        Transform { Scale 1 2 3 Plane { normal 1 1 0 offset 1 } } }";
    for kind in [AccelKind::None, AccelKind::Bvh, AccelKind::Grid(None)] {
        let (world, _) = testing::try_read(text, Dialect::Durer.rules(), kind, Path::new("."));
        let world = world.unwrap();
        let good = Ray { t_min: f32::NEG_INFINITY, ..Ray::new(Vec3::ONE, Vec3::new(-1.0, -2.0, -1.5)) };
        assert!(world.occluded(&good, &mut ()));
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            for i in 0..6 {
                let mut ray = good;
                if i < 3 {
                    ray.dir[i] = bad
                } else {
                    ray.origin[i - 3] = bad
                }
                assert!(!world.occluded(&ray, &mut ()) && world.closest(&ray, &mut ()).is_none(), "{ray:?}");
            }
        }
        for ray in [
            Ray { dir: Vec3::ZERO, ..good },
            Ray { t_min: f32::NAN, ..good },
            Ray { t_max: f32::NAN, ..good },
            Ray { t_max: f32::NEG_INFINITY, ..good },
        ] {
            assert!(!world.occluded(&ray, &mut ()) && world.closest(&ray, &mut ()).is_none(), "{ray:?}");
        }
    }
}

#[test]
fn transforms_apply_last_to_first_and_preserve_t() {
    let text = "PerspectiveCamera { center 0 0 9 direction 0 0 -1 up 0 1 0 angle 40 }\n\
        Group { Transform { Translate 10 0 0 ZRotate 90 Scale 2 1 1
        Transform { Translate 1 0 0 Sphere { center 0 0 0 radius 1 } } } }";
    let world = testing::read(text);
    // The sphere at 1 is stretched to 2, rotated to +y, and moved to (10, 2, 0). The half axes of
    // the sphere are then 1, 2 and 1.
    let hit =
        |origin: [f32; 3], dir: [f32; 3]| world.closest(&Ray::new(origin.into(), dir.into()), &mut ()).map(|h| h.t);
    assert_eq!(hit([10.0, -5.0, 0.0], [0.0, 1.0, 0.0]), Some(5.0));
    assert_eq!(hit([10.0, -5.0, 0.0], [0.0, 0.5, 0.0]), Some(10.0));
    assert_eq!(hit([0.0, 2.0, 0.0], [1.0, 0.0, 0.0]), Some(9.0));
    assert_eq!(hit([10.0, 2.0, 5.0], [0.0, 0.0, -1.0]), Some(4.0));
    assert_eq!(hit([0.0, -0.5, 0.0], [1.0, 0.0, 0.0]), None);
}

#[test]
fn edited_world_has_the_digest_of_its_contents() {
    let world = testing::read(
        "OrthographicCamera { center 0 0 5 direction 0 0 -1 up 0 1 0 size 5 } Materials { PhongMaterial {} }
        Group { MaterialIndex 0 Sphere { center 0 0 0 radius 1 } }",
    );
    let changed = |change: fn(&mut Contents)| {
        let mut other = world.clone();
        change(other.edit());
        other.digest()
    };
    let nothing = changed(|_| {});
    let changes: [fn(&mut Contents); 4] = [
        |contents| contents.background = Color::ONE,
        |contents| contents.rules.epsilon = Some(0.5),
        |contents| contents.objects[0].center.x = 1.0,
        |contents| contents.objects.clear(),
    ];
    let mut all: Vec<String> = changes.iter().map(|change| changed(*change).to_string()).collect();
    assert_eq!(all[0], changed(changes[0]).to_string());
    all.extend([world.digest(), nothing].map(|digest| digest.to_string()));
    all.sort();
    all.dedup();
    assert_eq!(all.len(), 6);
}

/// Traces batches of coherent, random and invalid rays through simple shapes, solids and meshes,
/// some of which are rotated or distant. The hits must equal those of single rays and of a
/// brute-force search.
#[test]
fn batches_of_rays_match_single_rays() {
    let folder = tempfile::tempdir().unwrap();
    let mut random = Random(31);
    let ball = include_str!("../../../../scenes/meshes/ball80-smooth.obj");
    std::fs::write(folder.path().join("ball.obj"), ball).unwrap();
    let mesh = "TriangleMesh { obj_file ball.obj }";
    let groups = [
        "Plane { normal 0 1 0 offset -1 } Sphere { center 0 0 0 radius 0.7 } Sphere { center 1 0 0 radius 0.5 }".into(),
        mesh.to_string(),
        format!("Plane {{ normal 0 1 0 offset -1 }} {mesh}"),
        format!(
            "Sphere {{ center 0.5 0 0 radius 1 }} Transform {{ Translate 1 0 0 Rotate {{ 1 2 3 40 }} Scale 1 2 1 {mesh} }}"
        ),
        format!("{mesh} Intersection {{ Box {{ min -1 -1 -1 max 1 1 1 }} Sphere {{ center 0 0 0 radius 1.2 }} }}"),
        format!("{mesh} Transform {{ Translate 0.5 0 0 {mesh} }}"),
        "Box { min -1 -1 -1 max 0.2 0.5 0 } Box { min 0 -1 -1 max 1 1 1 } Box { min -1 0 -1 max 1 0.1 1 } Plane { normal 0 1 0 offset -1 }".into(),
        format!(
            "Rectangle {{ corner -1 -1 0 edge0 2 0 0.5 edge1 0 2 0 }} Rectangle {{ corner -1 -1 0.2 edge0 2 0 0 edge1 1 2 0 }}
             Disc {{ center 0 0 0.5 normal 1 0 3 radius 0.7 }} Disc {{ center 0 0 -0.5 normal 1 2 3 radius 1 innerRadius 0.4 }}
             Box {{ min -0.5 -0.5 -0.5 max 0.3 0.3 0.3 }} Sphere {{ center 0.5 0 0 radius 0.4 }} {mesh}"
        ),
        "Plane { normal 0 1 0 offset -1 } Difference { Box { min -1 -1 -1 max 1 1 1 } Sphere { center 1 1 1 radius 1 } }".into(),
    ];
    let mut hits = 0;
    for group in groups {
        let text = format!(
            "PerspectiveCamera {{ center 0 0 5 direction 0 0 -1 up 0 1 0 angle 30 }}\n\
             Materials {{ PhongMaterial {{ diffuseColor 1 1 1 }} }}\nGroup {{ {group} }}"
        );
        let (world, found) = testing::try_read(&text, Dialect::Durer.rules(), AccelKind::Bvh, folder.path());
        let world = world.unwrap_or_else(|| panic!("{found:?}"));
        let (plain, _) = testing::try_read(&text, Dialect::Durer.rules(), AccelKind::None, folder.path());
        let plain = plain.unwrap();
        for round in 0..rounds(200) {
            let count = 1 + random.below(MAX_BATCH);
            let (eye, toward) = (3.0 * random.point(), random.point());
            let spread = [1e-3, 0.05, 1.0][round % 3];
            let rays: Vec<Ray64> = (0..count)
                .map(|_| {
                    let origin = if round % 2 == 0 { eye } else { eye + spread * random.point() };
                    let mut ray = Ray::new(origin, toward + spread * random.point() - origin);
                    (ray.t_min, ray.t_max) = ([0.0, 0.5][random.below(2)], [f32::INFINITY, 1.0][random.below(2)]);
                    if random.below(50) == 0 {
                        ray.dir = [Vec3::ZERO, Vec3::NAN][random.below(2)];
                    }
                    ray.into()
                })
                .collect();
            let (mut together, mut blocked) = (vec![None; count], vec![false; count]);
            world.closest_batch(&rays, &mut together);
            world.occluded_batch(&rays, &mut blocked);
            for ((ray, hit), blocked) in rays.iter().zip(together).zip(blocked) {
                assert_eq!(hit, world.closest(ray, &mut ()), "{group} {ray:?}");
                assert_eq!(blocked, world.occluded(ray, &mut ()), "{group} {ray:?}");
                assert_eq!(hit, plain.closest(ray, &mut ()), "{group} {ray:?}");
                hits += usize::from(blocked);
            }
        }
    }
    assert!(hits > 5000, "{hits}");
}
