//! Tests that packed simple shapes return the same hits as single shapes.

use durer_bvh::PrimitivePacks;
use durer_scene::math::random::{Random, rounds};
use durer_scene::math::{Ray, Vec3};
use durer_scene::shape::{Cuboid, Disc, Plane, Primitive, Rectangle, Shape, Sphere};

fn vector(random: &mut Random, size: f32) -> Vec3 {
    Vec3::new(random.between(-size, size), random.between(-size, size), random.between(-size, size))
}

/// Traces 10^5 rays through sets of up to 20 shapes of each kind, including duplicates, and
/// includes rays along faces and edges. Distances and indices must be bit-identical, including when
/// eight rays are traced at once.
#[test]
fn packs_return_the_hits_of_single_shapes() {
    let mut random = Random(8);
    let (mut hits, mut rays) = (0, 0);
    for _ in 0..rounds(100_000) / 100 {
        let mut packs = PrimitivePacks::default();
        let mut shapes: Vec<Primitive> = Vec::new();
        let size = [1.0, 1e-3, 1e6][random.below(3)];
        for _ in 0..random.below(21) {
            let number = shapes.len() as u32;
            let axes = [Vec3::X, -Vec3::Y, 2.0 * Vec3::Z, vector(&mut random, 1.0) + Vec3::splat(1e-6)];
            let plane =
                Plane { normal: axes[random.below(4)], offset: [0.0, random.between(-size, size)][random.below(2)] };
            packs.push_plane(number, plane.normal, plane.offset);
            shapes.push(plane.into());
        }
        for _ in 0..random.below(21) {
            let number = shapes.len() as u32;
            let center = [Vec3::ZERO, vector(&mut random, size)][random.below(2)];
            let sphere = Sphere { center, radius: [size, random.between(0.01, 1.0) * size][random.below(2)] };
            packs.push_sphere(number, sphere.center, sphere.radius);
            shapes.push(sphere.into());
        }
        for _ in 0..random.below(21) {
            let center = [Vec3::ZERO, vector(&mut random, size)][random.below(2)];
            let normal = [Vec3::X, -3.0 * Vec3::Z, vector(&mut random, 1.0) + Vec3::splat(1e-6)][random.below(3)];
            let radius = [size, random.between(0.01, 1.0) * size][random.below(2)];
            let inner_radius = [0.0, 0.5 * radius][random.below(2)];
            let disc = Disc { center, normal, radius, inner_radius };
            packs.push_disc(shapes.len() as u32, center, disc.unit_normal(), [inner_radius, radius]);
            shapes.push(disc.into());
        }
        for _ in 0..random.below(21) {
            let corner = [Vec3::ZERO, vector(&mut random, size)][random.below(2)];
            let edge0 = [size * Vec3::X, vector(&mut random, size) + Vec3::splat(1e-9)][random.below(2)];
            let edge1 = [size * Vec3::Y, vector(&mut random, size) + Vec3::splat(1e-9)][random.below(2)];
            let rectangle = Rectangle { corner, edge0, edge1 };
            if rectangle.validate().is_ok() {
                packs.push_rectangle(shapes.len() as u32, corner, [edge0, edge1]);
                shapes.push(rectangle.into());
            }
        }
        for _ in 0..random.below(21) {
            let min = [Vec3::ZERO, vector(&mut random, size)][random.below(2)];
            let max = min + [Vec3::splat(size), vector(&mut random, size).abs() + 1e-3 * size][random.below(2)];
            packs.push_box(shapes.len() as u32, min, max);
            shapes.push(Cuboid { min, max }.into());
        }
        assert_eq!(packs.len(), shapes.len());
        let mut requested = Vec::new();
        for _ in 0..100 {
            let dirs = [
                Vec3::X,
                -Vec3::Z,
                vector(&mut random, 1.0) + Vec3::splat(1e-6),
                1e-20 * Vec3::Y,
                Vec3::new(-0.0, random.between(-1.0, 1.0), 1.0),
            ];
            let mut origins = [Vec3::ZERO, size * Vec3::X, vector(&mut random, 2.0 * size), Vec3::ZERO];
            origins[3] = Vec3::new(0.0, origins[2].y, -size);
            let t_min = [0.0, f32::NEG_INFINITY, size][random.below(3)];
            let t_max = [f32::INFINITY, 1.5 * size][random.below(2)];
            let ray = Ray { t_min, t_max, ..Ray::new(origins[random.below(4)], dirs[random.below(5)]) };
            if !durer_bvh::internal::is_valid(&ray) {
                continue;
            }
            let each =
                shapes.iter().zip(0_u32..).filter_map(|(shape, number)| Some((shape.intersect(&ray)?.t, number)));
            let expected = each.min_by(|a, b| a.partial_cmp(b).unwrap());
            let found = packs.closest(&ray, &mut ()).map(|hit| (hit.t, hit.number));
            let bits = |hit: Option<(f32, u32)>| hit.map(|(t, number)| ((t + 0.0).to_bits(), number));
            assert_eq!(bits(found), bits(expected), "{ray:?}");
            assert_eq!(packs.occluded(&ray, &mut ()), expected.is_some(), "{ray:?}");
            hits += usize::from(expected.is_some());
            rays += 1;
            requested.push(ray);
        }
        for eight in requested.as_chunks::<8>().0 {
            let alone = eight.each_ref().map(|ray| packs.closest(ray, &mut ()));
            assert_eq!(packs.closest_of_eight(eight.each_ref()), alone, "{eight:?}");
            let unsound = [
                Ray::new(Vec3::NAN, Vec3::X),
                Ray::new(Vec3::ZERO, f32::INFINITY * Vec3::Y),
                Ray::new(Vec3::ZERO, Vec3::ZERO),
                Ray { t_min: 1.0, t_max: 1.0, ..eight[0] },
            ];
            let [a, b, c, d, ..] = eight;
            let mixed = [a, &unsound[0], b, &unsound[1], c, &unsound[2], d, &unsound[3]];
            let expected = [alone[0], None, alone[1], None, alone[2], None, alone[3], None];
            assert_eq!(packs.closest_of_eight(mixed), expected, "{mixed:?}");
        }
    }
    assert!(3 * hits > rays, "{hits} of {rays} rays hit");
}
