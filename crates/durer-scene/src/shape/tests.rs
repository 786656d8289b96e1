//! Tests all shapes, each against an independent definition in double precision.

mod inside;
mod mesh_rules;
mod tangents;
mod terrain;

use super::testing::{distance, near_edge, samples, surface_point, too_far};
use super::*;
use crate::describe::DescribedKind;
use crate::math::random::Random;

/// Returns every intersection of a line with the shape. The flag is `false` for intersections that
/// single precision cannot decide.
fn crossings(shape: &Primitive, o: DVec3, d: DVec3) -> Vec<(f64, bool)> {
    match shape {
        Primitive::Sphere(s) => {
            let (o, r) = (o - s.center.as_dvec3(), f64::from(s.radius));
            let middle = -o.dot(d) / d.dot(d);
            let beside = r * r - (o + middle * d).length_squared();
            if beside < -1e-9 * r * r {
                return Vec::new();
            }
            let half = beside.max(0.0).sqrt() / d.length();
            [middle - half, middle + half].map(|t| (t, beside > 1e-9 * r * r)).to_vec()
        }
        Primitive::Plane(s) => {
            let n = s.normal.as_dvec3();
            vec![((f64::from(s.offset) - n.dot(o)) / n.dot(d), true)]
        }
        Primitive::Triangle(s) => {
            let [a, b, c] = [s.vertex0, s.vertex1, s.vertex2].map(Vec3::as_dvec3);
            let n = (b - a).cross(c - a);
            let t = n.dot(a - o) / n.dot(d);
            let p = o + t * d;
            // Compute the height of the point above each of the three edges. The ray is sheared in
            // single precision. The shear causes 8 roundings of the distance, which have more
            // effect if the triangle is seen edge-on.
            let heights = [(a, b), (b, c), (c, a)].map(|(e, f)| n.cross(f - e).normalize().dot(p - e));
            let least = heights.into_iter().fold(f64::INFINITY, f64::min);
            let reach = [a, b, c].map(|x| (x - o).length()).into_iter().fold(0.0, f64::max);
            let slack = 8.0 * f64::from(f32::EPSILON) * reach * n.length() * d.length() / n.dot(d).abs();
            if least < -slack { Vec::new() } else { vec![(t, least > slack)] }
        }
        // The other shapes are flat, or their crossings are compared with `inside` in another test.
        _ => {
            let mut all = Vec::new();
            shape.crossings(&Line { origin: o, dir: d }, &mut |t, _| all.push((t, true)));
            all
        }
    }
}

#[test]
fn first_crossing_in_the_open_interval_is_returned() {
    let mut random = Random(1);
    let mut found = vec![0; Primitive::kinds().len()];
    for round in 0..40_000 {
        // Test sizes from 1e-6 to 1e6, a range that is far larger than that of real scenes.
        let size = match round % 16 {
            14 => 1e-16,
            15 => 1e16,
            power => libm::powf(10.0, power as f32 * 12.0 / 13.0 - 6.0),
        };
        for (kind, shape) in samples(&mut random, size, 2.0 * size).iter().enumerate() {
            let origin = 4.0 * size * random.point();
            let target = shape.bounds().map_or(size * random.point(), |b| b.center() + 0.7 * size * random.point());
            let ray = Ray::new(origin, random.between(0.01, 100.0) * (target - origin));
            let all = crossings(shape, origin.as_dvec3(), ray.dir.as_dvec3());
            // The intervals are a half-line, a full line, and pieces that begin or end between
            // crossings.
            let middle = all.iter().map(|c| c.0).sum::<f64>() as f32 / all.len().max(1) as f32;
            let (t_min, t_max) = [
                (0.0, f32::INFINITY),
                (f32::NEG_INFINITY, f32::INFINITY),
                (middle, f32::INFINITY),
                (f32::NEG_INFINITY, middle),
                (-middle.abs(), 0.5 * middle.abs()),
            ][random.below(5)];
            let ray = Ray { t_min, t_max, ..ray };
            let crossing = shape.intersect(&ray);
            // Each root is accurate to a rounding of the largest root. On curved shapes, a root is
            // accurate to a rounding of the size of the shape.
            let is_curved = !matches!(shape, Primitive::Plane(_) | Primitive::Triangle(_));
            let rounding = if is_curved { f64::from(size) / ray.dir.as_dvec3().length() } else { 0.0 };
            let near = |a: f64, b: f64| (a - b).abs() <= 2e-7 * (a.abs() + rounding);
            if let Some(crossing) = crossing {
                let t = f64::from(crossing.t);
                assert!(ray.contains(crossing.t), "{shape:?} {ray:?} {crossing:?}");
                let grazing = matches!(shape, Primitive::Triangle(_)) && all.iter().any(|c| !c.1);
                assert!(grazing || all.iter().any(|c| near(c.0, t)), "{shape:?} {ray:?} {crossing:?} {all:?}");
                found[kind] += 1;
            }
            // A crossing inside the interval must not be missed if it is certain.
            for &(t, _) in all.iter().filter(|c| c.1) {
                let clear = |end: f32| !near(t, f64::from(end));
                if clear(t_min) && clear(t_max) && ray.contains(t as f32) {
                    let first = crossing.unwrap_or_else(|| panic!("missed {t}: {shape:?} {ray:?}")).t;
                    assert!(f64::from(first) <= t || near(f64::from(first), t), "{first} {t} {shape:?} {ray:?}");
                }
            }
        }
    }
    assert!(found.iter().all(|&n| n > 2_000), "{found:?}");
}

#[test]
fn crossing_at_an_end_of_the_interval_does_not_count() {
    let mut random = Random(2);
    for _ in 0..3_000 {
        for shape in samples(&mut random, 1.0, 2.0) {
            let Some((ray, crossing)) = surface_point(&shape, &mut random, 1.0, 2.0) else { continue };
            let t = crossing.t;
            assert_ne!(shape.intersect(&Ray { t_min: t, ..ray }).map(|c| c.t), Some(t));
            assert_eq!(shape.intersect(&Ray { t_max: t, ..ray }), None);
            let around = Ray { t_min: t.next_down(), t_max: t.next_up(), ..ray };
            assert_eq!(shape.intersect(&around), Some(crossing), "{shape:?}");
        }
    }
}

#[test]
fn surface_is_on_the_shape_within_its_error_and_bounds() {
    let mut random = Random(3);
    for round in 0..30_000 {
        let size = libm::powf(10.0, (round % 13) as f32 - 6.0);
        let away = size * [0.0, 1.0, 100.0][round % 3];
        for shape in samples(&mut random, size, away) {
            let Some((ray, crossing)) = surface_point(&shape, &mut random, size, away) else { continue };
            let surface = shape.surface(ray.line().at(crossing.t.into()), &crossing);
            let p = surface.position.as_dvec3();
            let n = surface.n_geo.as_dvec3();
            if too_far(&shape, p, f64::from(size + away)) {
                continue;
            }
            let bound = n.abs().dot(surface.error.as_dvec3());
            let sag = 0.5 * f64::from(surface.curvature) * surface.error.as_dvec3().length_squared();
            let off = distance(&shape, p);
            assert!(off.abs() <= bound + sag + 1e-15 * p.length(), "{shape:?} {surface:?} {off}");
            // The error bound has the same order of magnitude as the rounding error.
            let reach = p.length() + f64::from(size + away);
            assert!(surface.error.as_dvec3().max_element() <= 1e-5 * reach, "{surface:?}");
            assert!((n.length() - 1.0).abs() < 2e-7 && (surface.n_shade.length() - 1.0).abs() < 2e-7);
            if let Some(b) = shape.bounds() {
                let inside =
                    (surface.position + surface.error).cmpge(b.min) & (surface.position - surface.error).cmple(b.max);
                assert!(inside.all(), "{shape:?} {surface:?} {b:?}");
            }
            // The normal is the gradient of the distance, which is computed by central differences.
            let step = 1e-5 * f64::from(size);
            if near_edge(&shape, p, 10.0 * step) {
                continue;
            }
            let difference =
                |v: DVec3| (distance(&shape, p + step * v) - distance(&shape, p - step * v)) / (2.0 * step);
            let gradient = DVec3::new(difference(DVec3::X), difference(DVec3::Y), difference(DVec3::Z));
            // With a step of 1e-5 times the size, the third-order terms are about the square of the
            // ratio of the step to the smallest radius of curvature. The rounding of the point adds
            // an error relative to the radius of curvature.
            let bend = f64::from(surface.curvature * size);
            let slack = 1e-6 + (1e-5 * bend) * (1e-5 * bend) + 2e-7 * (1.0 + bend) * f64::from(1.0 + away / size);
            assert!((gradient - n).length() < slack, "{shape:?} {surface:?} {gradient}");
            let uv = surface.uv.get().unwrap();
            // Only planes and triangles have texture coordinates outside [0,1].
            let range = matches!(shape, Primitive::Plane(_)) || (uv.cmpge(Vec2::ZERO) & uv.cmple(Vec2::ONE)).all();
            assert!(uv.is_finite() && range, "{shape:?} {uv}");
        }
    }
}

#[test]
fn invalid_ray_hits_nothing() {
    let mut random = Random(4);
    let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
    for _ in 0..300 {
        for shape in samples(&mut random, 1.0, 0.0) {
            let windows = [(0.0, f32::INFINITY), (f32::NEG_INFINITY, f32::INFINITY)];
            for (t_min, t_max) in windows {
                let ray = Ray { origin: random.point(), dir: -random.point(), t_min, t_max };
                assert_eq!(shape.intersect(&Ray { dir: Vec3::ZERO, ..ray }), None);
                assert_eq!(shape.intersect(&Ray { dir: -Vec3::ZERO, ..ray }), None);
                assert_eq!(shape.intersect(&Ray { t_min: f32::NAN, ..ray }), None);
                assert_eq!(shape.intersect(&Ray { t_max: f32::NAN, ..ray }), None);
                assert_eq!(shape.intersect(&Ray { t_min: 1.0, t_max: -1.0, ..ray }), None);
                for value in bad {
                    for axis in 0..3 {
                        let mut broken = ray;
                        broken.dir[axis] = value;
                        assert_eq!(shape.intersect(&broken), None, "{shape:?} {broken:?}");
                        // The ray must also miss if all other components are zero.
                        broken.dir = Vec3::AXES[axis] * value;
                        assert_eq!(shape.intersect(&broken), None, "{shape:?} {broken:?}");
                        broken = ray;
                        broken.origin[axis] = value;
                        assert_eq!(shape.intersect(&broken), None, "{shape:?} {broken:?}");
                    }
                }
            }
        }
    }
}
