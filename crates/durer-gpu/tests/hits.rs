//! Hits on the device compared with those of the CPU.

#![cfg(feature = "device")]

mod common;

use common::{gpu, scene, scenes, world_of};
use durer_gpu::{HitRecord, SceneBuffers};
use durer_render::world::{Hit, World};
use durer_scene::math::random::Random;
use durer_scene::math::{Ray, Vec3};

/// Number of rays per scene.
const RAYS: usize = 30_000;

/// Returns rays through a scene: from points around it and from points near surfaces.
fn rays(world: &World, random: &mut Random, count: usize) -> Vec<Ray> {
    let bounds = world.bounds();
    let (center, reach) = (bounds.center(), bounds.size().length().clamp(1.0, 100.0));
    let inside = |random: &mut Random| bounds.min + 0.5 * (random.point() + 1.0) * bounds.size();
    let mut rays = Vec::with_capacity(count);
    while rays.len() < count {
        let far = center + reach * random.direction();
        let target = inside(random);
        rays.push(Ray::new(far, (target - far).normalize()));
        rays.push(Ray::new(inside(random), random.direction()));
        // An unbounded interval, as that of an orthographic camera.
        let both = Ray { t_min: f32::NEG_INFINITY, ..Ray::new(inside(random), random.direction()) };
        rays.push(both);
    }
    rays
}

/// Returns true if the surfaces that both hit coincide there.
fn coincide(world: &World, ray: &Ray, hit: &Hit, found: &HitRecord) -> bool {
    world.hit_of(found.object, &ray.into()).is_some_and(|own| {
        world.triangle(&own) == found.part
            && is_close(world, ray, &own, found, 16.0)
            && is_close(world, ray, hit, found, 16.0)
    })
}

/// Returns true if the CPU finds the device's hit after the ray is moved by rounding errors, or if
/// the surfaces that both hit coincide there.
fn is_near_tie(world: &World, ray: &Ray, found: Option<&HitRecord>, random: &mut Random) -> bool {
    if let (Some(hit), Some(found)) = (world.closest(ray, &mut ()), found)
        && coincide(world, ray, &hit, found)
    {
        return true;
    }
    let scale = ray.origin.abs().max_element().max(world.bounds().size().max_element());
    let is_found = |hit: Option<Hit>| match (hit, found) {
        (None, None) => true,
        (Some(hit), Some(found)) => {
            (hit.object, world.triangle(&hit)) == (found.object, found.part) && is_close(world, ray, &hit, found, 30.0)
        }
        _ => false,
    };
    (0..200).any(|i| {
        let by = 2e-7 * f32::from(1_u8 << (i % 5));
        let origin = ray.origin + by * scale * random.point();
        let dir = (ray.dir + by * random.point()).normalize();
        is_found(world.closest(&Ray { origin, dir, ..*ray }, &mut ()))
    })
}

/// Returns true if both distances agree to within the rounding errors of coordinates, which grow
/// with the inclination of the surface.
fn is_close(world: &World, ray: &Ray, hit: &Hit, found: &HitRecord, factor: f32) -> bool {
    let surface = world.interaction(ray, *hit).surface;
    let cosine = ray.dir.normalize().dot(surface.n_geo).abs().max(1e-4);
    let size = hit.t.abs() + ray.origin.abs().max_element() + surface.position.abs().max_element();
    (hit.t - found.t).abs() <= factor * f32::EPSILON * size / cosine
}

#[test]
fn hits_equal_those_of_the_cpu_except_near_edges() {
    let Some(gpu) = gpu() else { return };
    let mut random = Random(7);
    let shapes = "PerspectiveCamera { center 0 0 9 direction 0 0 -1 up 0 1 0 angle 40 } Group {
        Sphere { center 1 2 3 radius 0.7 } Ellipsoid { center -2 0.5 1 radii 1 0.3 0.6 }
        Box { min -1 -1 -1 max 0.5 0.25 0.75 } Disc { center 2 -1 0 normal 1 1 0 radius 1.5 innerRadius 0.4 }
        Rectangle { corner -3 -3 -2 edge0 5 0 1 edge1 0 5 1 } Cylinder { base 3 0 -2 top 3.5 2 -1 radius 0.6 }
        Cone { base -3 -2 2 top -2 1 2.5 baseRadius 1 } Cone { base 0 3 -2 top 1 4 -2 baseRadius 0.3 topRadius 0.9 }
        Triangle { vertex0 -4 -4 4 vertex1 4 -4 3 vertex2 0 4 4.5 } Plane { normal 0.1 1 0 offset -3.5 }
        Transform { Translate 0.5 -2 1 YRotate 33 Scale 1 2 0.5 Sphere { center 0 0 0 radius 0.8 } }
        Transform { Translate -1 2 -3 ZRotate 20 XRotate 70 Box { min -1 -0.5 -0.5 max 1 0.5 0.5 } }
        Transform { Translate 2 -3 -1 YRotate 50 Cylinder { base 0 0 0 top 0 1 0 radius 0.5 } } }";
    let worlds = [
        ("shapes", world_of(shapes)),
        ("whitted", scene("whitted")),
        ("mirrors", scene("mirrors")),
        ("knot", scene("knot")),
        ("smooth-mesh", scene("smooth-mesh")),
        ("landscape", scene("landscape")),
        ("transforms", scene("transforms")),
        ("cornell-box", scene("cornell-box")),
    ];
    let mut report = String::new();
    for (name, world) in &worlds {
        let rays = rays(world, &mut random, RAYS);
        let found = SceneBuffers::for_hits(&gpu, world).unwrap().hits(&rays).unwrap();
        let (mut hits, mut ties, mut shared, mut worst) = (0, 0, 0, 0.0_f32);
        for (ray, found) in rays.iter().zip(&found) {
            let hit = world.closest(ray, &mut ());
            hits += u32::from(hit.is_some());
            let same = match (&hit, found) {
                (None, None) => true,
                (Some(hit), Some(found)) => {
                    worst = worst.max((hit.t - found.t).abs() / (1.0 + hit.t.abs()));
                    (hit.object, world.triangle(hit)) == (found.object, found.part)
                        && is_close(world, ray, hit, found, 16.0)
                }
                _ => false,
            };
            if !same {
                // A block that stands on a floor has points that belong to both, and either may be
                // hit.
                let is_shared = matches!((&hit, found), (Some(hit), Some(found))
                    if hit.object != found.object && coincide(world, ray, hit, found));
                *(if is_shared { &mut shared } else { &mut ties }) += 1;
                assert!(
                    is_near_tie(world, ray, found.as_ref(), &mut random),
                    "{name}: {ray:?}: {hit:?} instead of {found:?}"
                );
            }
        }
        report += &format!(
            "{name}: {} rays, {hits} hits, {ties} near edges, {shared} on two objects, t within {worst:.1e}\n",
            rays.len()
        );
        assert!(hits as usize > RAYS / 10 && ties < RAYS / 1000 && shared < RAYS / 100, "{report}");
    }
    eprint!("{report}");
}

#[test]
fn no_ray_passes_through_a_closed_mesh() {
    let Some(gpu) = gpu() else { return };
    let mut random = Random(11);
    for file in ["ball80-flat.obj", "knot.ply", "globe.obj"] {
        for transform in ["", "Translate 3 -1 2 YRotate 31 Scale 2 0.7 1.3"] {
            let world = world_of(&format!(
                "PerspectiveCamera {{ center 0 0 9 direction 0 0 -1 up 0 1 0 angle 40 }} Group {{
                Transform {{ {transform} TriangleMesh {{ obj_file meshes/{file} }} }} }}"
            ));
            assert!(scenes().join("meshes").join(file).exists());
            let durer_render::world::Geometry::Mesh(tree) = &world.objects()[0].geometry else { panic!("{file}") };
            assert!(tree.is_closed(), "{file}");
            // Rays from inside must hit, above all those through edges and vertices.
            let mut rays = Vec::new();
            while rays.len() < 20_000 {
                let part = random.below(tree.mesh.len()) as u32;
                let [a, b, c] = tree.mesh.corners(part);
                let share = random.unit();
                let targets = [a, a + share * (b - a), 0.5 * (b + c), (a + b + c) / 3.0];
                let bounds = world.bounds();
                let start = bounds.min + 0.5 * (random.point() + 1.0) * bounds.size();
                if !world.objects()[0].contains(start) {
                    continue;
                }
                for target in targets {
                    let target = world.objects()[0].world_point(target);
                    rays.push(Ray::new(start, target - start));
                    // Past the edge or vertex by a few rounding errors.
                    let near = target + 3e-7 * target.abs().max_element() * random.point();
                    rays.push(Ray::new(start, near - start));
                }
            }
            let found = SceneBuffers::for_hits(&gpu, &world).unwrap().hits(&rays).unwrap();
            let lost = found.iter().filter(|hit| hit.is_none()).count();
            eprintln!("{file} {transform:?}: {} rays from inside, {lost} lost", rays.len());
            assert_eq!(lost, 0, "{file} {transform:?}");
        }
    }
}

#[test]
fn a_ray_through_a_vertex_hits_one_of_its_triangles() {
    let Some(gpu) = gpu() else { return };
    // A flat fan of triangles around the origin, in the plane of exact coordinates.
    let mut text = String::from("PerspectiveCamera { center 0 0 9 direction 0 0 -1 up 0 1 0 angle 40 } Group {");
    let corners = [[2, 0], [2, 2], [0, 2], [-2, 2], [-2, 0], [-2, -2], [0, -2], [2, -2]];
    for i in 0..8 {
        let ([a, b], [c, d]) = (corners[i], corners[(i + 1) % 8]);
        text += &format!("Triangle {{ vertex0 0 0 0 vertex1 {a} {b} 0 vertex2 {c} {d} 0 }}");
    }
    let world = world_of(&(text + "}"));
    let mut rays = vec![Ray::new(Vec3::new(0.0, 0.0, 1.0), Vec3::NEG_Z)];
    for [x, y] in corners {
        rays.push(Ray::new(Vec3::new(0.5 * x as f32, 0.5 * y as f32, 1.0), Vec3::NEG_Z));
        rays.push(Ray::new(Vec3::new(0.5 * x as f32, 0.5 * y as f32, -1.0), Vec3::Z));
        rays.push(Ray::new(Vec3::new(0.0, 0.0, 1.0), Vec3::new(x as f32, y as f32, -4.0)));
    }
    let found = SceneBuffers::for_hits(&gpu, &world).unwrap().hits(&rays).unwrap();
    for (ray, found) in rays.iter().zip(found) {
        let hit = world.closest(ray, &mut ()).unwrap();
        let found = found.unwrap_or_else(|| panic!("{ray:?}"));
        assert_eq!((found.object, found.t), (hit.object, hit.t), "{ray:?}");
    }
}
