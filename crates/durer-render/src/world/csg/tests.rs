//! Tests of CSG solids against boolean operations on points, closed-form solutions and set
//! identities.

use super::*;
use crate::compile::{AccelKind, testing};
use crate::integrator::spawn::spawn_ray;
use crate::world::{Hit, SurfaceInteraction, World};
use durer_scene::math::random::Random;
use durer_scene::scene::{self, CsgOperation, Group, MatrixOp, MatrixRules, ObjectKind};
use durer_scene::shape::*;
use glam::{DAffine3, DVec3};
use std::path::Path;

const CUBE: &str = "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n\
    f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 4 8 7 3\nf 1 5 8 4\nf 2 3 7 6\n";

fn object(node: ObjectKind) -> scene::Object {
    scene::Object { node, material: None, span: Default::default() }
}

fn join(operation: CsgOperation, parts: &[&scene::Object]) -> scene::Object {
    object(ObjectKind::Solid(operation, parts.iter().map(|&part| part.clone()).collect()))
}

fn shape(shape: impl Into<Primitive>) -> scene::Object {
    object(ObjectKind::Primitive(shape.into()))
}

fn cuboid(min: [f32; 3], max: [f32; 3]) -> scene::Object {
    shape(Cuboid { min: min.into(), max: max.into() })
}

fn ball(center: [f32; 3], radius: f32) -> scene::Object {
    shape(Sphere { center: center.into(), radius })
}

fn moved(op: MatrixOp, inner: &scene::Object) -> scene::Object {
    object(ObjectKind::Transform(vec![op], Box::new(inner.clone())))
}

fn world(object: &scene::Object) -> World {
    testing::object(object.clone(), AccelKind::Bvh, Path::new("."))
}

/// Returns a closed shape of about size 1, near the origin.
fn closed_shape(random: &mut Random) -> scene::Object {
    let center = random.point();
    let mut length = || random.between(0.3, 1.0);
    let (a, b, c) = (length(), length(), length());
    let axis = random.direction();
    let mesh =
        TriangleMesh { obj_file: durer_scene::describe::FileName { path: "cube.obj".into(), ..Default::default() } };
    match random.below(9) {
        0 => shape(Sphere { center, radius: a }),
        1 => shape(Cuboid { min: center - Vec3::new(a, b, c), max: center + Vec3::new(c, b, a) }),
        2 => shape(Cylinder { base: center, top: center + 2.0 * a * axis, radius: b }),
        3 => shape(Cone { base: center, top: center + 2.0 * a * axis, base_radius: b, top_radius: c - 0.3 }),
        4 => shape(Torus { center, axis, major_radius: 1.0, minor_radius: 0.5 * a }),
        5 => shape(Ellipsoid { center, radii: Vec3::new(a, b, c) }),
        6 => shape(Plane { normal: axis, offset: center.x }),
        _ => object(ObjectKind::Mesh(mesh)),
    }
}

/// Returns a random tree of boolean operations on closed shapes, with groups and transforms.
fn tree(random: &mut Random, depth: usize) -> scene::Object {
    let inner = match random.below(if depth == 0 { 1 } else { 5 }) {
        0 => closed_shape(random),
        1 => object(ObjectKind::Group(Group { objects: (0..2).map(|_| tree(random, depth - 1)).collect() })),
        _ => {
            let operation = CsgOperation::ALL[random.below(5)].1;
            let count = 2 + random.below(3);
            object(ObjectKind::Solid(operation, (0..count).map(|_| tree(random, depth - 1)).collect()))
        }
    };
    if random.below(2) == 0 {
        return inner;
    }
    let rows = glam::DMat4::from(random.affine(1.5, 0.5)).transpose().to_cols_array().map(|x| x as f32);
    moved(MatrixOp::Matrix(rows), &inner)
}

/// Returns true if a solid contains a point according to the definition of its operations.
fn member(object: &scene::Object, p: DVec3) -> bool {
    let count = |parts: &[scene::Object]| parts.iter().filter(|part| member(part, p)).count();
    match &object.node {
        ObjectKind::Group(group) => count(&group.objects) > 0,
        ObjectKind::Transform(ops, inner) => {
            member(inner, MatrixOp::product(ops, MatrixRules::default()).inverse().transform_point3(p))
        }
        ObjectKind::Primitive(shape) => shape.inside(p).unwrap(),
        ObjectKind::Mesh(_) => p.abs().max_element() < 1.0,
        ObjectKind::HeightField(_) | ObjectKind::Voxels(..) => false,
        ObjectKind::Solid(operation, parts) => match operation {
            CsgOperation::Union | CsgOperation::Merge => count(parts) > 0,
            CsgOperation::Intersection => count(parts) == parts.len(),
            CsgOperation::Difference => member(&parts[0], p) && count(&parts[1..]) == 0,
            CsgOperation::Xor => count(parts) % 2 == 1,
        },
    }
}

/// Returns true if some point at the given distance is on the other side of the solid's surface.
fn near_surface(object: &scene::Object, p: DVec3, distance: f64) -> bool {
    let here = member(object, p);
    let around = DVec3::AXES.into_iter().chain(DVec3::AXES.map(|a| -a)).chain([DVec3::ONE, -DVec3::ONE]);
    around.into_iter().any(|step| member(object, p + distance * step) != here)
}

fn goes_out(world: &World, ray: impl Into<Ray64>, hit: &Hit) -> bool {
    world.interaction(ray, *hit).inside()
}

#[test]
fn solids_contain_the_points_of_their_operations() {
    // Distance from a surface within which single precision may give wrong results.
    const DISTANCE: f64 = 1e-4;
    let wanted = std::env::var("DURER_SOLID_POINTS").ok().and_then(|n| n.parse().ok()).unwrap_or(20_000);
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("cube.obj"), CUBE).unwrap();
    let mut random = Random(21);
    let (mut points, mut inside, mut near) = (0, 0, 0);
    while points < wanted {
        // The parts of a top-level union remain separate objects with inner surfaces, so wrap the
        // union in another operation.
        let solid = join(CsgOperation::Merge, &[&tree(&mut random, 3)]);
        let world = testing::object(solid.clone(), AccelKind::Bvh, folder.path());
        for _ in 0..40 {
            let ray = Ray::new(3.0 * random.point(), random.between(0.1, 3.0) * random.direction());
            let ray = Ray { t_min: f32::NEG_INFINITY, ..ray };
            let hits: Vec<Hit> = world.all_hits(&ray).collect();
            // Entries and exits alternate.
            for pair in hits.windows(2) {
                let [a, b] = [&pair[0], &pair[1]].map(|hit| goes_out(&world, &ray, hit));
                assert!(pair[0].t < pair[1].t);
                let gap = f64::from(pair[1].t - pair[0].t) * ray.dir.as_dvec3().length();
                assert!(a != b || gap < DISTANCE, "{solid:?} {ray:?} {hits:?}");
            }
            // A point is inside if the next hit is an exit or the previous one an entry.
            let Some(first) = hits.first() else { continue };
            for _ in 0..8 {
                let t = random.between(-3.0, 3.0) / ray.dir.length();
                let next = hits.partition_point(|hit| hit.t <= t);
                let expected = match next.checked_sub(1) {
                    Some(before) => !goes_out(&world, &ray, &hits[before]),
                    None => goes_out(&world, &ray, first),
                };
                let p = ray.line().at(f64::from(t));
                if near_surface(&solid, p, DISTANCE) {
                    near += 1;
                    continue;
                }
                assert_eq!(member(&solid, p), expected, "{p} {solid:?} {ray:?} {hits:?}");
                points += 1;
                inside += usize::from(expected);
            }
        }
    }
    println!("{points} points, {inside} inside, none wrong; skipped {near} closer than {DISTANCE} to a surface");
    assert!(inside > points / 10 && near < points / 10, "{points} {inside} {near}");
}

/// Returns the volume of the part of a solid inside the cube of half-width 2, estimated with rays
/// along x, and the standard error of the estimate.
fn volume(solid: &scene::Object, random: &mut Random, rays: usize) -> (f64, f64) {
    let world = world(solid);
    let (mut sum, mut squares) = (0.0, 0.0);
    for _ in 0..rays {
        let origin = Vec3::new(-3.0, random.between(-2.0, 2.0), random.between(-2.0, 2.0));
        let ray = Ray::new(origin, Vec3::X);
        let chord: f64 = world
            .all_hits(&ray)
            .map(|hit| if goes_out(&world, &ray, &hit) { f64::from(hit.t) } else { -f64::from(hit.t) })
            .sum();
        sum += 16.0 * chord;
        squares += 256.0 * chord * chord;
    }
    let n = rays as f64;
    let mean = sum / n;
    (mean, ((squares / n - mean * mean) / n).sqrt())
}

#[test]
fn volumes_match_closed_forms() {
    use std::f64::consts::PI;
    let mut random = Random(22);
    let rod = |axis: Vec3, radius: f32| shape(Cylinder { base: -1.8 * axis, top: 1.8 * axis, radius });
    let (x, y, z) = (rod(Vec3::X, 1.0), rod(Vec3::Y, 1.0), rod(Vec3::Z, 1.0));
    let (cube, unit) = (cuboid([-1.0; 3], [1.0; 3]), ball([0.0; 3], 1.0));
    let cap = |h: f64| PI * h * h * (3.0 - h) / 3.0;
    let ring = shape(Torus { center: Vec3::ZERO, axis: Vec3::Z, major_radius: 1.2, minor_radius: 0.4 });
    let frustum = shape(Cone { base: -Vec3::Y, top: Vec3::Y, base_radius: 1.0, top_radius: 0.5 });
    let core = shape(Cylinder { base: -2.0 * Vec3::Y, top: 2.0 * Vec3::Y, radius: 0.25 });
    let half = shape(Plane { normal: Vec3::X, offset: 0.5 });
    use CsgOperation::*;
    for (name, solid, expected) in [
        ("two crossing rods (Archimedes, Steinmetz)", join(Intersection, &[&x, &y]), 16.0 / 3.0),
        ("three crossing rods", join(Intersection, &[&x, &y, &z]), 8.0 * (2.0 - 2f64.sqrt())),
        ("a cube without its ball", join(Difference, &[&cube, &unit]), 8.0 - 4.0 * PI / 3.0),
        ("a lens of two balls", join(Intersection, &[&unit, &ball([1.0, 0.0, 0.0], 1.0)]), 2.0 * cap(0.5)),
        ("two balls", join(Merge, &[&unit, &ball([1.0, 0.0, 0.0], 1.0)]), 8.0 * PI / 3.0 - 2.0 * cap(0.5)),
        ("in one of two balls", join(Xor, &[&unit, &ball([1.0, 0.0, 0.0], 1.0)]), 8.0 * PI / 3.0 - 4.0 * cap(0.5)),
        ("a ring", join(Merge, &[&ring]), 2.0 * PI * PI * 1.2 * 0.16),
        ("half a ring", join(Difference, &[&ring, &cuboid([-2.0, -2.0, 0.0], [2.0; 3])]), PI * PI * 1.2 * 0.16),
        ("a bored frustum", join(Difference, &[&frustum, &core]), 2.0 * PI * (1.75 / 3.0 - 0.0625)),
        ("a ball behind a plane", join(Intersection, &[&unit, &half]), 4.0 * PI / 3.0 - cap(0.5)),
        (
            "an ellipsoid, moved, without its other half",
            moved(
                MatrixOp::Scale(Vec3::new(0.5, 1.5, 1.0)),
                &join(Difference, &[&unit, &cuboid([-2.0, 0.0, -2.0], [2.0; 3])]),
            ),
            PI / 2.0,
        ),
    ] {
        let (found, error) = volume(&solid, &mut random, 40_000);
        assert!((found - expected).abs() < 3.0 * error, "{name}: {found} +- {error}, expected {expected}");
        assert!(error < 0.02 * expected, "{name}: {error}");
    }
}

/// Asserts that random rays have the same hits and normals on both solids. Returns the number of
/// hits.
fn assert_same(a: &scene::Object, b: &scene::Object, random: &mut Random) -> usize {
    let (first, second) = (world(a), world(b));
    let mut hits = 0;
    for _ in 0..300 {
        let origin = 3.0 * random.point();
        let ray = Ray::new(origin, 1.2 * random.point() - origin);
        let seen = |world: &World| -> Vec<(u32, Vec3)> {
            world.all_hits(&ray).map(|hit| (hit.t.to_bits(), world.interaction(&ray, hit).surface.n_geo)).collect()
        };
        let expected = seen(&first);
        assert_eq!(seen(&second), expected, "{a:?}\n{b:?}\n{ray:?}");
        hits += expected.len();
    }
    hits
}

#[test]
fn set_identities_hold_bit_for_bit() {
    use CsgOperation::*;
    let mut random = Random(23);
    let mut part = || loop {
        let object = closed_shape(&mut random);
        if matches!(object.node, ObjectKind::Primitive(ref shape) if shape.bounds().is_some()) {
            return object;
        }
    };
    let all = cuboid([-4.0; 3], [4.0; 3]);
    let (mut rays, mut hits) = (Random(24), 0);
    for _ in 0..60 {
        let (a, b, c) = (part(), part(), part());
        let not = |x: &scene::Object| join(Difference, &[&all, x]);
        let both = join(Intersection, &[&a, &b]);
        let mut same = |x: &scene::Object, y: &scene::Object| hits += assert_same(x, y, &mut rays);
        // A - B is equal to the intersection of A and not B, and to A xor (A and B).
        same(&join(Difference, &[&a, &b]), &join(Intersection, &[&a, &not(&b)]));
        same(&join(Difference, &[&a, &b]), &join(Xor, &[&a, &both]));
        // De Morgan.
        same(&not(&join(Merge, &[&a, &b])), &join(Intersection, &[&not(&a), &not(&b)]));
        same(&not(&both), &join(Merge, &[&not(&a), &not(&b)]));
        // Test both distributive laws.
        let either = join(Merge, &[&b, &c]);
        same(&join(Intersection, &[&a, &either]), &join(Merge, &[&both, &join(Intersection, &[&a, &c])]));
        same(
            &join(Merge, &[&a, &join(Intersection, &[&b, &c])]),
            &join(Intersection, &[&join(Merge, &[&a, &b]), &join(Merge, &[&a, &c])]),
        );
        // Subtract two solids one after the other and both together.
        same(&join(Difference, &[&a, &b, &c]), &join(Difference, &[&a, &either]));
        same(&join(Difference, &[&join(Difference, &[&a, &b]), &c]), &join(Difference, &[&a, &either]));
        // Test idempotence and the difference of a solid and itself.
        same(&join(Merge, &[&a, &a]), &a);
        same(&join(Intersection, &[&a, &a]), &a);
        same(&join(Xor, &[&a, &a, &a]), &a);
        assert!(world(&join(Difference, &[&a, &a])).all_hits(&Ray::new(Vec3::splat(-3.0), Vec3::ONE)).next().is_none());
    }
    assert!(hits > 100_000, "{hits}");
}

#[test]
fn coincident_faces_leave_no_skin() {
    use CsgOperation::*;
    let mut random = Random(25);
    let long = cuboid([0.0; 3], [0.3, 0.1, 0.1]);
    // Compute the same position from different numbers: 0.1 + 0.2 is not 0.3 in single precision.
    let end = moved(MatrixOp::Translate(Vec3::new(0.1, 0.0, 0.0)), &cuboid([0.0; 3], [0.2, 0.1, 0.1]));
    let other = moved(
        MatrixOp::Translate(Vec3::new(0.1, 0.05, 0.05)),
        &moved(MatrixOp::YRotate(90.0), &cuboid([-0.05, -0.05, 0.0], [0.05, 0.05, 0.2])),
    );
    let start = cuboid([0.0; 3], [0.1; 3]);
    let pairs = [
        (join(Difference, &[&long, &end]), start.clone()),
        (join(Difference, &[&long, &other]), start.clone()),
        (join(Xor, &[&long, &end]), start.clone()),
        (join(Merge, &[&start, &end]), long.clone()),
        (join(Merge, &[&end, &long, &start]), long.clone()),
        (join(Intersection, &[&long, &start]), start.clone()),
    ];
    for _ in 0..40 {
        // Rotate, stretch and move all objects.
        let rows = glam::DMat4::from(random.affine(2.0, 3.0)).transpose().to_cols_array().map(|x| x as f32);
        let placed = MatrixOp::Matrix(rows);
        let map: DAffine3 = placed.matrix();
        for (solid, expected) in &pairs {
            let [found, wanted] = [solid, expected].map(|object| world(&moved(placed, object)));
            for _ in 0..200 {
                let inside = DVec3::new(0.31, 0.11, 0.11) * (random.point().as_dvec3() * 0.55 + 0.5);
                let target = map.transform_point3(inside).as_vec3();
                // Shoot rays from near and far origins.
                let origin = target + [0.5, 5.0, 50.0][random.below(3)] * random.direction();
                let ray = Ray::new(origin, target - origin);
                let (a, b): (Vec<Hit>, Vec<Hit>) = (found.all_hits(&ray).collect(), wanted.all_hits(&ray).collect());
                // At an edge, single precision cannot tell on which side a ray passes.
                let width = b.windows(2).map(|w| (w[1].t - w[0].t) * ray.dir.length()).fold(f32::INFINITY, f32::min);
                let cuts = a.windows(2).map(|w| (w[1].t - w[0].t) * ray.dir.length()).fold(f32::INFINITY, f32::min);
                if width < 1e-3 || b.is_empty() && cuts < 1e-3 {
                    continue;
                }
                assert_eq!(a.len(), b.len(), "{solid:?} {placed:?} {ray:?} {a:?} {b:?}");
                for (x, y) in a.iter().zip(&b) {
                    assert!((x.t - y.t).abs() * ray.dir.length() < 1e-4, "{solid:?} {ray:?} {a:?} {b:?}");
                    let [m, n] = [found.interaction(&ray, *x), wanted.interaction(&ray, *y)].map(|at| at.surface.n_geo);
                    assert!(m.dot(n) > 0.999 || width < 1e-2, "{solid:?} {ray:?} {a:?} {b:?}");
                }
            }
        }
    }
}

#[test]
fn surfaces_have_the_material_of_their_part() {
    let text = "PerspectiveCamera { center 0 0 9 direction 0 0 -1 up 0 1 0 angle 40 }\n\
        Materials { Material { } Material { } Material { } } Group {
        Difference { MaterialIndex 1 Box { min -1 -1 -1 max 1 1 1 }
        MaterialIndex 2 Transform { Translate 0 0 1 Sphere { center 0 0 0 radius 0.5 } } Box { min 0.9 -2 -2 max 3 2 2 } }
        MaterialIndex 0 Xor { Sphere { center 9 0 0 radius 1 } MaterialIndex 1 Sphere { center 9 0 0 radius 0.5 } } }";
    let world = testing::read(text);
    let seen = |origin: [f32; 3], dir: [f32; 3]| {
        let ray = Ray::new(origin.into(), dir.into());
        let list = |at: SurfaceInteraction| (at.material, at.hit.t, at.surface.n_geo.to_array());
        world.all_hits(&ray).map(|hit| list(world.interaction(&ray, hit))).collect::<Vec<_>>()
    };
    // The ray enters the solid through the dent, whose surface is inverted, and leaves it at the
    // back.
    let through = seen([0.0, 0.0, 5.0], [0.0, 0.0, -1.0]);
    assert_eq!(through, [(2, 4.5, [0.0, 0.0, 1.0]), (1, 6.0, [0.0, 0.0, -1.0])]);
    // The right wall of the solid is the left wall of the second box.
    let across = seen([5.0, 0.9, 0.0], [-1.0, 0.0, 0.0]);
    assert_eq!((across[0].0, across[0].2, across[1].0, across[1].2), (2, [1.0, 0.0, 0.0], 1, [-1.0, 0.0, 0.0]));
    // Test a hollow sphere.
    let hollow: Vec<_> = seen([9.0, 0.0, 5.0], [0.0, 0.0, -1.0]).into_iter().map(|(m, t, n)| (m, t, n[2])).collect();
    assert_eq!(hollow, [(0, 4.0, 1.0), (1, 4.5, -1.0), (1, 5.5, 1.0), (0, 6.0, -1.0)]);
}

#[test]
fn lens_of_two_spheres_focuses_by_the_lensmakers_equation() {
    // Lensmaker's equation: 1/f = (n - 1) (2/R - (n - 1) d / (n R^2)); the focus is f (1 - (n - 1)
    // d / (n R)) behind the lens.
    let (n, radius, offset) = (1.5f64, 2.2f64, 1.9f64);
    let thickness = 2.0 * (radius - offset);
    let f = 1.0 / ((n - 1.0) * (2.0 / radius - (n - 1.0) * thickness / (n * radius * radius)));
    let focus = 0.5 * thickness + f * (1.0 - (n - 1.0) * thickness / (n * radius));
    let lens = join(CsgOperation::Intersection, &[&ball([-1.9, 0.0, 0.0], 2.2), &ball([1.9, 0.0, 0.0], 2.2)]);
    let world = world(&lens);
    let mut random = Random(28);
    for _ in 0..1000 {
        // For rays close to the axis, the error grows with the square of the height.
        let (y, z) = (random.between(-0.05, 0.05), random.between(-0.05, 0.05));
        let mut ray = Ray64::from(Ray::new(Vec3::new(-5.0, y, z), Vec3::X));
        for (eta, outwards) in [(1.0 / 1.5, false), (1.5, true)] {
            let at = world.intersect(ray, &mut ()).unwrap();
            assert_eq!(at.inside(), outwards);
            let surface = at.surface;
            let n = if outwards { -surface.n_geo } else { surface.n_geo };
            let dir = crate::integrator::whitted::refract(ray.dir(), n, eta).unwrap();
            ray = spawn_ray(&surface, dir, f32::INFINITY, None);
        }
        assert!(world.closest(&ray, &mut ()).is_none());
        let at = ray.line().at((focus - ray.origin().x) / f64::from(ray.dir().x));
        assert!(libm::hypot(at.y, at.z) < 2e-4, "{at}");
    }
}

#[test]
fn a_union_keeps_inner_surfaces_and_a_merge_does_not() {
    let (a, b) = (ball([0.0; 3], 1.0), ball([1.0, 0.0, 0.0], 1.0));
    let hits = |operation| {
        let world = world(&join(operation, &[&a, &b]));
        (world.objects().len(), world.all_hits(&Ray::new(Vec3::new(-5.0, 0.0, 0.0), Vec3::X)).count())
    };
    assert_eq!(hits(CsgOperation::Union), (2, 4));
    // Nested unions are split into objects as well.
    let nested = join(CsgOperation::Union, &[&join(CsgOperation::Union, &[&a, &b]), &ball([9.0, 0.0, 0.0], 1.0)]);
    assert_eq!(world(&nested).objects().len(), 3);
    assert_eq!(hits(CsgOperation::Merge), (1, 2));
    assert_eq!(hits(CsgOperation::Xor), (1, 4));
    assert_eq!(hits(CsgOperation::Intersection), (1, 2));
}

#[test]
fn disjoint_parts_become_separate_objects() {
    use CsgOperation::*;
    let balls: Vec<scene::Object> = (0..1000).map(|i| ball([3.0 * i as f32, 0.0, 0.0], 1.0)).collect();
    let list: Vec<&scene::Object> = balls.iter().collect();
    let merged = join(Merge, &list);
    assert_eq!(world(&merged).objects().len(), 1000);
    // Cutting one sphere affects only that sphere.
    let cut = join(Difference, &[&merged, &ball([3.0, 1.0, 0.0], 0.5)]);
    let compiled = world(&cut);
    assert_eq!(compiled.objects().len(), 1000);
    let solids = compiled.objects().iter().filter(|object| matches!(object.geometry, Geometry::Solid(_)));
    assert_eq!(solids.count(), 1);
    // An intersection with a box keeps only the spheres inside the box and tightens the bounds.
    let window = join(Intersection, &[&merged, &cuboid([2.5, -0.5, -2.0], [9.5, 0.5, 2.0])]);
    let bounds = world(&window).bounds();
    assert_eq!(world(&window).objects().len(), 3);
    assert!(
        (bounds.min.x - 2.5).abs() < 1e-4 && (bounds.max.x - 9.5).abs() < 1e-4 && bounds.max.y < 0.501,
        "{bounds:?}"
    );
    assert_eq!(world(&join(Intersection, &[&balls[0], &balls[1]])).objects().len(), 0);
}

#[test]
fn cluster_of_many_parts_matches_its_parts() {
    // All parts are in one cluster, which has its own BVH. The rays start both outside and inside.
    let mut random = Random(26);
    let balls: Vec<scene::Object> =
        (0..300).map(|i| ball([0.5 * (i % 20) as f32, 0.5 * (i / 20) as f32, random.unit()], 0.4)).collect();
    let list: Vec<&scene::Object> = balls.iter().collect();
    let solid = join(CsgOperation::Merge, &list);
    let world = world(&solid);
    assert_eq!(world.objects().len(), 1);
    let mut inner = 0;
    for _ in 0..4000 {
        let origin = Vec3::new(random.between(-1.0, 11.0), random.between(-1.0, 8.0), random.between(-2.0, 3.0));
        let ray = Ray::new(origin, random.direction());
        let from_inside = member(&solid, origin.as_dvec3());
        inner += usize::from(from_inside);
        let hit = world.closest(&ray, &mut ());
        assert_eq!(world.occluded(&ray, &mut ()), hit.is_some());
        // March along the ray up to the first surface.
        let step = 1e-3;
        let limit = hit.map_or(14.0, |hit| f64::from(hit.t));
        let mut t = step;
        while t < limit - step {
            let same = member(&solid, ray.line().at(t)) == from_inside;
            assert!(same || near_surface(&solid, ray.line().at(t), 2e-3), "{ray:?} {hit:?} {t}");
            t += 0.05;
        }
        if let Some(hit) = hit {
            assert_eq!(goes_out(&world, &ray, &hit), from_inside, "{ray:?} {hit:?}");
        }
    }
    assert!(inner > 400, "{inner}");
}

/// Compares a solid whose subtracted parts are in a BVH, clipped to the solid's bounds, with one
/// that tests all parts.
#[test]
fn parts_are_clipped_to_the_bounds_of_the_whole() {
    let (mut random, mut hits) = (Random(28), 0);
    let operand = |shape| CsgTree::Operand(Arc::new(world(&shape).objects()[0].clone()));
    for _ in 0..20 {
        let mut rod = || {
            let (base, along) = (random.point(), 5.0 * random.direction());
            operand(shape(Cylinder { base: base - along, top: base + along, radius: random.between(0.05, 0.3) }))
        };
        let cut: Vec<CsgTree> = (0..12).map(|_| rod()).collect();
        let parts = vec![operand(cuboid([-1.0, -0.2, -1.0], [1.0, 0.2, 1.0])), operand(ball([0.0; 3], 1.2))];
        let [solid, mut whole] = [0; 2].map(|_| Csg::new(CsgTree::intersection(parts.clone(), cut.clone())));
        assert!(whole.bvh.take().is_some());
        for _ in 0..1000 {
            let ray = Ray64::from(Ray::new(2.0 * random.point(), random.direction()));
            let hit = solid.closest(&ray, None, &mut ());
            assert_eq!(hit, whole.closest(&ray, None, &mut ()), "{ray:?}");
            hits += usize::from(hit.is_some());
        }
    }
    assert!(hits > 2000, "{hits}");
}

#[test]
fn rays_that_leave_a_solid_do_not_hit_it_at_their_start() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("cube.obj"), CUBE).unwrap();
    let mut random = Random(27);
    let mut count = 0;
    for _ in 0..150 {
        let solid = join(CsgOperation::Merge, &[&tree(&mut random, 2)]);
        let rows = glam::DMat4::from(random.affine(3.0, 100.0)).transpose().to_cols_array().map(|x| x as f32);
        let placed = MatrixOp::Matrix(rows);
        let world = testing::object(moved(placed, &solid), AccelKind::Bvh, folder.path());
        for _ in 0..40 {
            let map = placed.matrix();
            let [from, to] =
                [3.0, 1.0].map(|reach| map.transform_point3((reach * random.point()).as_dvec3()).as_vec3());
            let ray = Ray::new(from, to - from);
            let Some(SurfaceInteraction { surface, .. }) = world.intersect(&ray, &mut ()) else { continue };
            if surface.position.length() > 1e4 {
                continue;
            }
            for _ in 0..20 {
                let dir = random.direction();
                if dir.dot(surface.n_geo).abs() < 1e-3 {
                    continue;
                }
                let away = spawn_ray(&surface, dir, f32::INFINITY, None);
                let Some(next) = world.closest(&away, &mut ()) else { continue };
                // Entries and exits must alternate.
                count += 1;
                let turns = goes_out(&world, &away, &next) != (dir.dot(surface.n_geo) > 0.0);
                assert!(turns, "{solid:?} {ray:?} {surface:?} {away:?} {next:?}");
            }
        }
    }
    assert!(count > 10_000, "{count}");
}

/// There are as many coincident crossings as parts. Each crossing must be visited only a few times
/// rather than once for each of the others.
#[test]
fn coincident_parts_take_linear_time() {
    let count = 30_000;
    for (operation, there) in
        [(CsgOperation::Merge, true), (CsgOperation::Xor, false), (CsgOperation::Intersection, true)]
    {
        let parts = vec![ball([0.0; 3], 1.0); count];
        let world = world(&join(operation, &parts.iter().collect::<Vec<_>>()));
        let ray = Ray::new(Vec3::new(0.1, 0.2, 5.0), Vec3::NEG_Z);
        let hit = world.closest(&ray, &mut ());
        assert_eq!(hit.is_some(), there, "{operation:?}");
        // The visible surface is that of the first part in the file.
        assert!(hit.is_none_or(|hit| hit.part & !(INVERTED | ENTERS) == 0), "{operation:?}");
    }
}
