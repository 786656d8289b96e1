//! Tests that rays starting at a surface do not hit it again at their origin.

use crate::compile::{AccelKind, testing};
use crate::integrator::spawn::spawn_ray;
use crate::world::{Hit, World};
use durer_scene::math::random::{Random, rounds};
use durer_scene::math::{Affine, Ray, Ray64, Vec3};
use durer_scene::shape::testing::{distance, near_edge, samples, surface_point, too_far};
use durer_scene::shape::{Primitive, Shape, SurfacePoint, Triangle};
use glam::{DAffine3, DVec3};

/// Shoots a ray from a random point in the neighbourhood of the only object of a world towards that
/// object.
fn hit(world: &World, shape: &Primitive, affine: &DAffine3, random: &mut Random) -> Option<(Ray, Hit)> {
    // Choose both end points in object space, so that thin objects are hit too.
    let (local, _) = surface_point(shape, random, 1.0, 1.0)?;
    let origin = affine.transform_point3(local.origin.as_dvec3()).as_vec3();
    let target = affine.transform_point3(local.at(1.0).as_dvec3()).as_vec3();
    let ray = Ray::new(origin, target - origin);
    world.closest(&ray, &mut ()).map(|hit| (ray, hit))
}

/// Returns true if a ray hits another side of the same closed shape, which is an exit if the ray
/// starts inside, or an entry if it starts outside a shape that is not convex.
fn is_other_side(shape: &Primitive, world: &World, start: &SurfacePoint, ray: &Ray64, hit: &Hit) -> bool {
    let bent = matches!(shape, Primitive::Torus(_) | Primitive::Quadric(_));
    let (from_inside, goes_out) = (ray.dir().dot(start.n_geo) < 0.0, world.interaction(ray, *hit).inside());
    shape.inside(DVec3::ZERO).is_some() && (from_inside || bent) && from_inside == goes_out
}

#[test]
fn rays_do_not_hit_the_surface_that_they_leave() {
    let mut random = Random(5);
    let mut counts = [0; 11];
    // Each pair consists of the transform's stretch factor and the object's distance.
    for (stretch, distance) in [(1.0, 0.0), (1.0, 100.0), (10.0, 0.0), (10.0, 1e4), (100.0, 1e3), (1.0, 1e4)] {
        for round in 0..rounds(600) {
            let mut affine = random.affine(stretch, distance);
            // Scale by factors from a millionth to a million.
            let scale = [1.0, 1e-6, 1e6, 1e-3, 1e3][round % 5];
            affine = DAffine3::from_scale(DVec3::splat(scale)) * affine;
            if round % 4 == 0 {
                // If a point lies on an axis, its other coordinates are small and therefore more
                // precise.
                affine.translation *= glam::DVec3::X;
            }
            for (kind, shape) in samples(&mut random, 1.0, 1.0).into_iter().enumerate() {
                let world = testing::shapes(&[(shape.clone(), affine)], AccelKind::None);
                for _ in 0..10 {
                    let Some((ray, first)) = hit(&world, &shape, &affine, &mut random) else { continue };
                    let surface = world.interaction(ray, first).surface;
                    // The tip of a stretched sphere can be too sharp for the precision of
                    // coordinates. An ellipsoid's smallest radius of curvature is the square of its
                    // smallest half axis divided by its largest half axis.
                    let off = surface.error.length() / scale as f32;
                    let tip = surface.curvature.recip() / (stretch * stretch * stretch);
                    if tip < 10.0 * off {
                        continue;
                    }
                    // If a point is closer to an edge than the error of its position, it may be on
                    // either side of the edge.
                    let at = affine.inverse().transform_point3(surface.point());
                    if near_edge(&shape, at, f64::from(10.0 * stretch * off)) {
                        continue;
                    }
                    for _ in 0..40 {
                        let dir = random.between(0.01, 100.0) * random.direction();
                        // A ray that is parallel to the surface, within the rounding error of its
                        // direction, is on neither side. A shear amplifies rounding errors by the
                        // ratio of its factors.
                        let in_it = 2.0 * f32::EPSILON * stretch * stretch;
                        if dir.normalize().dot(surface.n_geo).abs() < in_it {
                            continue;
                        }
                        let away = spawn_ray(&surface, dir, f32::INFINITY, None);
                        counts[kind] += 1;
                        let Some(again) = world.closest(&away, &mut ()) else { continue };
                        let other = is_other_side(&shape, &world, &surface, &away, &again);
                        assert!(other, "{shape:?}\n{affine:?}\n{surface:?}\n{away:?}\n{again:?}");
                    }
                }
            }
        }
    }
    println!("rays by shape, none of which hits its own surface: {counts:?}");
    assert!(counts.iter().all(|&n| n > 100_000), "{counts:?}");
}

#[test]
fn rays_start_close_enough_to_hit_a_plane_a_thousandth_away() {
    let mut random = Random(6);
    for round in 0..20_000 {
        // One thousandth is 16 to 32 times the rounding error of numbers up to 500.
        let affine = random.affine(2.0, [0.0, 1.0, 100.0, 300.0][round % 4]);
        let shape = samples(&mut random, 1.0, 1.0).swap_remove(round % 11);
        let world = testing::shapes(&[(shape.clone(), affine)], AccelKind::None);
        let Some((ray, first)) = hit(&world, &shape, &affine, &mut random) else { continue };
        let surface = world.interaction(ray, first).surface;
        for side in [1.0, -1.0] {
            let normal = side * surface.n_geo;
            let away = spawn_ray(&surface, normal, f32::INFINITY, None);
            let lifted = (away.origin() - surface.point()).dot(normal.as_dvec3());
            // Points on an unbounded plane can be far away.
            let far = surface.position.abs().max_element() > 500.0;
            assert!(far || (0.0..1e-3).contains(&lifted), "{lifted} {shape:?} {affine:?} {surface:?}");
        }
    }
}

#[test]
fn normals_follow_mirrored_and_sheared_surfaces() {
    let mut random = Random(7);
    for _ in 0..5_000 {
        let affine = random.affine(5.0, 3.0);
        for shape in samples(&mut random, 1.0, 1.0) {
            let world = testing::shapes(&[(shape.clone(), affine)], AccelKind::Bvh);
            let Some((ray, first)) = hit(&world, &shape, &affine, &mut random) else { continue };
            let surface = world.interaction(ray, first).surface;
            // Returns the signed distance from the surface in world space, computed from the
            // distance between the inversely transformed point and the shape.
            let inverse = affine.inverse();
            let field = |p: DVec3| distance(&shape, inverse.transform_point3(p));
            let p = surface.point();
            let local = inverse.transform_point3(p);
            if near_edge(&shape, local, 1e-3) || too_far(&shape, local, 1.0) {
                continue;
            }
            let bound = surface.n_geo.abs().dot(surface.error);
            let step = 1e-5;
            let difference = |v: DVec3| (field(p + step * v) - field(p - step * v)) / (2.0 * step);
            let gradient = DVec3::new(difference(DVec3::X), difference(DVec3::Y), difference(DVec3::Z));
            assert!(field(p).abs() <= f64::from(bound) * gradient.length() * 1.01, "{shape:?} {affine:?}");
            // The matrix is rounded to single precision and stretches some axes up to 25 times more
            // than others. The position of a point on a small sphere is precise to 1e-6 of the
            // radius.
            let n = surface.n_geo.as_dvec3();
            assert!((gradient.normalize() - n).length() < 1e-4, "{shape:?} {affine:?} {surface:?} {gradient}");
            // A hit has the same `t` in both spaces.
            let far = (ray.at(first.t).as_dvec3() - p).length();
            assert!(far < 1e-4 * (ray.origin.length() + surface.position.length()) as f64, "{far}");
        }
    }
}

#[test]
fn invalid_transforms_are_rejected() {
    assert!(Affine::new(DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0))).is_none());
    assert!(Affine::new(DAffine3::from_scale(DVec3::splat(1e300))).is_none());
    assert!(Affine::new(DAffine3::from_translation(DVec3::splat(f64::NAN))).is_none());
    let mut random = Random(8);
    for power in -30..=30 {
        let scale = DAffine3::from_scale(DVec3::splat(libm::pow(10.0, f64::from(power))));
        let affine = Affine::new(random.affine(2.0, 0.0) * scale).unwrap();
        let n = random.direction();
        assert!((affine.normal(n).length() - 1.0).abs() < 1e-6);
    }
}

#[test]
fn rays_leave_a_floor_in_a_coordinate_plane() {
    let mut random = Random(9);
    for round in 0..20_000 {
        let size = [1.0, 1000.0][round % 2];
        let mut corner = |x, z| size * Vec3::new(x, 0.0, z) * random.between(0.5, 1.0);
        let floor = Triangle { vertex0: corner(-1.0, -1.0), vertex1: corner(1.0, -1.0), vertex2: corner(0.0, 1.0) };
        let ray = Ray::new(Vec3::Y, 0.1 * random.point() - Vec3::Y);
        let surface = floor.surface(DVec3::ZERO, &floor.intersect(&ray).unwrap());
        // The point lies exactly on the floor, so no offset is needed, even for rays at a flat
        // angle.
        let dir = random.direction() * Vec3::new(1.0, [1.0, 0.1, 1e-3][round % 3], 1.0);
        let away = spawn_ray(&surface, dir, f32::INFINITY, None);
        assert_eq!(floor.intersect(&away.rounded), None, "{floor:?} {away:?}");
    }
}
