//! Compares all crossings of closed shapes with the result of `inside` at points sampled along
//! lines, in double precision.

use super::*;
use crate::math::random::Random;

/// Returns a line near a shape, in a random direction, along an axis, or in a coordinate plane.
fn line(shape: &Primitive, random: &mut Random, size: f32) -> Line {
    let middle = shape.bounds().map_or(Vec3::ZERO, |b| b.center());
    let dir = match random.below(4) {
        0 => Vec3::AXES[random.below(3)],
        1 => Vec3::new(random.between(-1.0, 1.0), 0.0, random.between(-1.0, 1.0)),
        _ => random.direction(),
    };
    let dir = dir * random.between(0.01, 100.0);
    // The lines pass through the middle or off to the side, and some start far away.
    let through = middle + size * [0.0, 0.8, 1.2][random.below(3)] * random.point();
    let away = [0.0, 3.0, 1000.0][random.below(3)] * size;
    Line { origin: (through - away / dir.length() * dir).as_dvec3(), dir: dir.as_dvec3() }
}

#[test]
fn crossings_are_exactly_entries_and_exits() {
    const STEPS: usize = 400;
    let mut random = Random(11);
    let mut found = [0; 11];
    for round in 0..4_000 {
        let size = libm::powf(10.0, (round % 13) as f32 - 6.0);
        for (kind, shape) in samples(&mut random, size, 2.0 * size).iter().enumerate() {
            if shape.inside(DVec3::ZERO).is_none() {
                continue;
            }
            let line = line(shape, &mut random, size);
            let mut all = Vec::new();
            shape.crossings(&line, &mut |t, uv| all.push((t, uv)));
            all.sort_by(|a, b| a.0.total_cmp(&b.0));
            let inside = |t: f64| shape.inside(line.at(t)).unwrap();
            let unit = f64::from(size) / line.dir.length();
            let middle = line.nearest(shape.bounds().map_or(DVec3::ZERO, |b| b.center().as_dvec3()));
            // The line changes sides at each crossing, so the points slightly before and behind it
            // differ, unless another crossing is near.
            let little = 1e-8 * unit;
            for (i, &(t, uv)) in all.iter().enumerate() {
                let near = |other: Option<&(f64, Vec2)>| other.is_some_and(|o| (o.0 - t).abs() < 1e-3 * unit);
                let alone = !near(i.checked_sub(1).and_then(|i| all.get(i))) && !near(all.get(i + 1));
                let far = (t - middle).abs() > 10.0 * unit;
                if far || !alone {
                    continue;
                }
                assert_ne!(inside(t - little), inside(t + little), "{shape:?} {line:?} {t} of {all:?}");
                let on = distance(shape, line.at(t)).abs();
                assert!(on < 1e-9 * f64::from(size), "{on} {shape:?} {line:?} {t}");
                // The crossing must be on the right face.
                let surface = shape.surface(line.at(t), &ShapeHit { t: t as f32, uv });
                let off = (surface.position.as_dvec3() - line.at(t)).length();
                assert!(off < 1e-6 * f64::from(size), "{shape:?} {line:?} {t} {surface:?}");
                found[kind] += 1;
            }
            // Nothing changes between crossings, so the parity of the number of crossings
            // determines whether a sampled point is inside.
            let start = shape.starts_inside(&line);
            let mut passed = 0;
            for step in 0..=STEPS {
                let t = middle + (step as f64 / STEPS as f64 * 8.0 - 4.0) * unit;
                while passed < all.len() && all[passed].0 < t {
                    passed += 1;
                }
                let near = all.iter().any(|c| (c.0 - t).abs() < 1e-6 * unit);
                let touching = distance(shape, line.at(t)).abs() < 1e-7 * f64::from(size);
                if !near && !touching {
                    let expected = start ^ (passed % 2 == 1);
                    assert_eq!(inside(t), expected, "{shape:?} {line:?} {t} {all:?}");
                }
            }
        }
    }
    assert!(found.iter().enumerate().all(|(kind, &n)| n > 1_500 || [2, 9, 10].contains(&kind)), "{found:?}");
}

#[test]
fn inside_is_behind_the_surface() {
    let mut random = Random(12);
    for _ in 0..20_000 {
        for shape in samples(&mut random, 1.0, 1.0) {
            let Some((ray, crossing)) = surface_point(&shape, &mut random, 1.0, 1.0) else { continue };
            let surface = shape.surface(ray.line().at(crossing.t.into()), &crossing);
            let (p, n) = (surface.position.as_dvec3(), surface.n_geo.as_dvec3());
            if near_edge(&shape, p, 1e-3) || too_far(&shape, p, 1.0) || shape.inside(p).is_none() {
                continue;
            }
            // Surfaces that are far away or sharp are less accurate than this.
            if surface.error.max_element() > 1e-6 || surface.curvature > 100.0 {
                continue;
            }
            assert_eq!(shape.inside(p - 1e-5 * n), Some(true), "{shape:?} {surface:?}");
            assert_eq!(shape.inside(p + 1e-5 * n), Some(false), "{shape:?} {surface:?}");
        }
    }
}

#[test]
fn torus_distinguishes_a_line_along_its_tube_from_a_tangent() {
    let torus = Torus { center: Vec3::ZERO, axis: Vec3::Y, major_radius: 2.0, minor_radius: 0.5 };
    let count = |origin: [f64; 3], dir: [f64; 3]| {
        let mut all = Vec::new();
        torus.crossings(&Line { origin: origin.into(), dir: dir.into() }, &mut |t, _| all.push(t));
        all.sort_by(f64::total_cmp);
        all
    };
    let near = |found: Vec<f64>, expected: &[f64]| {
        assert_eq!(found.len(), expected.len(), "{found:?}");
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?}");
    };
    near(count([-5.0, 0.0, 0.0], [1.0, 0.0, 0.0]), &[2.5, 3.5, 6.5, 7.5]);
    near(count([2.0, 5.0, 0.0], [0.0, -1.0, 0.0]), &[4.5, 5.5]);
    near(count([0.0, 5.0, 0.0], [0.0, -1.0, 0.0]), &[]);
    // These lines pass just outside the inner circle, and just above and below the top.
    near(count([0.0, 0.5 + 1e-9, -5.0], [0.0, 0.0, 1.0]), &[]);
    assert_eq!(count([0.0, 0.5 - 1e-9, -5.0], [0.0, 0.0, 1.0]).len(), 4);
    assert_eq!(count([1.5 - 1e-9, 0.0, -5.0], [0.0, 0.0, 1.0]).len(), 4);
    assert_eq!(count([2.5 - 1e-9, 0.0, -5.0], [0.0, 0.0, 1.0]).len(), 2);
    near(count([2.5 + 1e-9, 0.0, -5.0], [0.0, 0.0, 1.0]), &[]);
}
