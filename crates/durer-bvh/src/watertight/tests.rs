//! Tests that a ray through an edge or a vertex crosses exactly one of the triangles that meet
//! there.

use super::*;
use crate::math::random::Random;

/// The triangles of a mesh, given by their corners.
type Triangles = Vec<[Vec3; 3]>;

/// Returns a surface with `columns` by `rows` squares. `point` maps grid points to corners, so
/// neighbouring triangles share corners with the same bits.
fn sheet(columns: usize, rows: usize, point: impl Fn(usize, usize) -> Vec3) -> Triangles {
    let mut triangles = Vec::new();
    for i in 0..columns {
        for j in 0..rows {
            let [a, b, c, d] = [point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    triangles.retain(|[a, b, c]| a != b && b != c && c != a);
    triangles
}

fn turn(i: usize, count: usize) -> (f32, f32) {
    let (sin, cos) = crate::math::fp::sin_cos_degrees(360.0 * (i % count) as f64 / count as f64);
    (sin as f32, cos as f32)
}

/// Closed meshes, each with a flag that is true if it is convex, and a point inside it.
fn meshes() -> Vec<(Triangles, bool, Vec3)> {
    let ball = sheet(16, 8, |i, j| {
        let ((s, c), (t, d)) = (turn(i, 16), turn(j, 16));
        if j % 8 == 0 { Vec3::new(0.0, d, 0.0) } else { Vec3::new(t * c, d, t * s) }
    });
    let torus = sheet(24, 12, |i, j| {
        let ((s, c), (t, d)) = (turn(i, 24), turn(j, 12));
        Vec3::new((0.7 + 0.3 * d) * c, 0.3 * t, (0.7 + 0.3 * d) * s)
    });
    let cube = (0..6).flat_map(|face| {
        sheet(3, 3, move |i, j| {
            let (u, v) = ([-1.0, -0.3, 0.3, 1.0][i], [-1.0, -0.3, 0.3, 1.0][j]);
            Vec3::from([[1.0, u, v], [-1.0, v, u], [v, 1.0, u], [u, -1.0, v], [u, v, 1.0], [v, u, -1.0]][face])
        })
    });
    vec![(ball, true, Vec3::ZERO), (cube.collect(), true, Vec3::ZERO), (torus, false, Vec3::new(0.7, 0.0, 0.0))]
}

/// Returns a vertex, the midpoint of an edge, a point on an edge, or the centre of a face.
fn target(mesh: &Triangles, random: &mut Random) -> Vec3 {
    let [a, b, c] = mesh[random.below(mesh.len())];
    match random.below(4) {
        0 => a,
        1 => 0.5 * (a + b),
        2 => a + random.unit() * (b - a),
        _ => (a + b + c) / 3.0,
    }
}

fn crossed(mesh: &Triangles, ray: &Ray) -> usize {
    let sheared = WatertightRay::new(ray);
    mesh.iter().filter(|corners| sheared.intersect(**corners, ray.t_min, ray.t_max).is_some()).count()
}

#[test]
fn closed_mesh_has_even_crossings_from_outside_and_odd_from_inside() {
    let mut random = Random(9);
    for (mesh, convex, inside) in meshes() {
        let mut through = 0;
        for distance in [0.0, 10.0, 1e3, 1e4, 1e5] {
            // The mesh stays closed because shared corners are rounded in the same way.
            let offset = (distance * random.direction()).round();
            // Far from the origin, a convex mesh is no longer convex once its corners have been
            // rounded.
            let convex = convex && distance <= 10.0;
            let moved: Triangles = mesh.iter().map(|corners| corners.map(|p| p + offset)).collect();
            for round in 0..1_500 {
                let goal = target(&moved, &mut random);
                let outside = offset + [3.0, 100.0, 1e4][round % 3] * random.direction();
                // Every other ray is parallel to an axis. Such rays may lie in the faces of the
                // cube.
                let mut dir = random.between(0.1, 10.0) * (goal - outside);
                let mut from = outside;
                if round % 2 == 0 {
                    dir = Vec3::AXES[random.below(3)] * random.between(0.5, 4.0);
                    from = goal - 16.0 * dir;
                }
                let count = crossed(&moved, &Ray::new(from, dir));
                assert!(count.is_multiple_of(2) && (!convex || count <= 2), "{count} {from} {dir} {offset}");
                through += count / 2;
                let start = inside + offset;
                for dir in [goal - start, Vec3::AXES[round % 3], -Vec3::AXES[round % 3]] {
                    let count = crossed(&moved, &Ray::new(start, dir));
                    assert!(count % 2 == 1 && (!convex || count == 1), "{count} {start} {dir} {offset}");
                }
            }
        }
        assert!(through > 2_000, "{through}");
    }
}

#[test]
fn exactly_one_triangle_of_a_fan_is_hit_at_its_center_and_spokes() {
    let mut random = Random(10);
    for round in 0..20_000 {
        let count = 3 + round % 9;
        let middle = 10.0 * random.point();
        let rim: Vec<Vec3> = (0..count)
            .map(|i| {
                let (sin, cos) = turn(i, count);
                middle + Vec3::new(cos, 0.3 * random.unit(), sin)
            })
            .collect();
        let fan: Triangles = (0..count).map(|i| [middle, rim[i], rim[(i + 1) % count]]).collect();
        let spoke = rim[random.below(count)];
        let goal = middle + [0.0, 0.5, random.between(0.01, 0.99)][round % 3] * (spoke - middle);
        // Start above the fan so that all its triangles face the ray with the same side.
        let from = goal + Vec3::new(random.between(-1.0, 1.0), 3.0, random.between(-1.0, 1.0));
        for ray in [Ray::new(from, goal - from), Ray::new(goal + 3.0 * Vec3::Y, Vec3::NEG_Y)] {
            assert_eq!(crossed(&fan, &ray), 1, "{fan:?} {ray:?}");
        }
    }
}

#[test]
fn triangles_of_all_sizes_are_hit() {
    let mut random = Random(11);
    for power in -36..=36 {
        let size = libm::pow(10.0, f64::from(power)) as f32;
        let corners =
            [Vec3::new(-1.0, -1.0, 0.1), Vec3::new(1.0, -1.0, -0.2), Vec3::new(0.0, 1.0, 0.3)].map(|p| size * p);
        for _ in 0..50 {
            let from = size * Vec3::new(random.between(-1.0, 1.0), random.between(-1.0, 1.0), 2.0);
            let goal = size * Vec3::new(0.1, random.between(-0.5, 0.2), 0.05);
            let crossing = WatertightRay::new(&Ray::new(from, goal - from)).intersect(corners, 0.0, f32::INFINITY);
            let crossing = crossing.unwrap_or_else(|| panic!("{power}"));
            assert!((0.8..1.2).contains(&crossing.t), "{power} {crossing:?}");
            assert!(crossing.uv.min_element() > 0.0 && crossing.uv.element_sum() < 1.0, "{power} {crossing:?}");
        }
    }
}

#[test]
fn ray_in_the_plane_of_a_triangle_misses_it() {
    let corners = [Vec3::ZERO, Vec3::X, Vec3::Z];
    for ray in [Ray::new(Vec3::NEG_X, Vec3::X), Ray::new(Vec3::NEG_X, Vec3::new(1.0, 0.0, 0.1))] {
        assert_eq!(WatertightRay::new(&ray).intersect(corners, f32::NEG_INFINITY, f32::INFINITY), None);
    }
}
