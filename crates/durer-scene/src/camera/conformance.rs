//! Tests properties that every [`Camera`] must have. For each kind of camera, the tests use the
//! default camera and random cameras that are generated from its description.

use super::*;
use crate::describe::{Constraint, DescribedKind, Field, FieldKind, Value};
use crate::math::random::Random;

/// Number of random cameras of each kind. With `POINTS` samples for each camera, there are 10^5
/// samples for each kind.
const CAMERAS: usize = 20;
const POINTS: usize = 5_000;

/// Returns a random value of a realistic size that satisfies the constraint of a field.
fn value(field: &Field, random: &mut Random) -> Value {
    let mut rows = |count: usize, width: usize| {
        Value::Rows((0..count).map(|_| (0..width).map(|_| random.between(-2.0, 2.0)).collect()).collect())
    };
    match (field.kind, field.constraint) {
        (FieldKind::Rows(9), _) => Value::Rows((0..1 + random.below(4)).map(|_| wall(random)).collect()),
        (FieldKind::Rows(width), Constraint::Rows(least, most)) => {
            rows(if most > least { least + 3 } else { least }, width)
        }
        (FieldKind::Word(words), _) => Value::Word(words[random.below(words.len())].into()),
        (FieldKind::Int, _) => Value::Int([0, 3, 5, 8][random.below(4)]),
        (FieldKind::Vec3, Constraint::NonZero) => Value::Vec3(random.direction() * random.between(0.5, 2.0)),
        (FieldKind::Vec3, _) => Value::Vec3(random.point() * 0.5),
        (_, Constraint::Between(low, high)) => Value::Float(low + (high - low) * random.between(0.1, 0.9)),
        (_, Constraint::UpTo(high)) => Value::Float(high * random.between(0.1, 1.0)),
        (_, Constraint::Positive) => Value::Float(random.between(0.3, 3.0)),
        (_, Constraint::NonNegative) => Value::Float(random.between(0.0, 0.3)),
        // These values are up to twice the distortion of bad lenses.
        _ if ["p1", "p2"].contains(&field.name) => Value::Float(random.between(-0.01, 0.01)),
        (kind, rule) => {
            assert_eq!((kind, rule), (FieldKind::Float, Constraint::Any), "{}", field.name);
            Value::Float(random.between(-0.2, 0.2))
        }
    }
}

/// Returns a random rectangle at some distance from the eye.
fn wall(random: &mut Random) -> Vec<f32> {
    let turn = random.rotation().as_mat3();
    let (w, h) = (random.between(0.5, 3.0), random.between(0.5, 3.0));
    let corners = [[-w, -h], [w, -h], [-w, h]].map(|[x, y]| turn * Vec3::new(x, y, -2.0));
    corners.iter().flat_map(|corner| corner.to_array()).collect()
}

fn random_camera(kind: &Camera, random: &mut Random) -> Camera {
    loop {
        let mut camera = kind.clone();
        for (i, field) in kind.fields().iter().enumerate() {
            let value = value(field, random);
            assert_eq!(field.constraint.validate(&value), Ok(()), "{}", field.name);
            camera.set(i, value);
        }
        // Reject cameras that see almost nothing, since they would pass every test.
        let ray_count = (0..200).filter(|_| random_ray(&camera, random).1.is_some()).count();
        if camera.validate().is_ok() && ray_count > 40 {
            return camera;
        }
    }
}

fn frame(camera: &Camera) -> CameraBasis {
    CameraBasis::of(camera, CameraRules::default())
}

/// Returns a random sample in the natural picture, and its ray.
fn random_ray(camera: &Camera, random: &mut Random) -> (CameraSample, Option<Ray>) {
    let half = camera.proportions().map_or(Vec2::ONE, |sides| sides / sides.max_element());
    // Stay away from the edge, so that rounding does not move the point out of the picture.
    let point = 0.98 * half * Vec2::new(random.between(-1.0, 1.0), random.between(-1.0, 1.0));
    let sample = CameraSample { lens: Vec2::new(random.unit(), random.unit()), ..CameraSample::at(point) };
    (sample, camera.ray(&frame(camera), &sample))
}

/// Calls `check` with the default camera of each kind, and then with random ones.
fn all(seed: u64, mut check: impl FnMut(&Camera, &mut Random)) {
    let mut random = Random(seed);
    for kind in Camera::kinds() {
        assert_eq!(kind.validate(), Ok(()), "{kind:?}");
        check(&kind, &mut random);
        for _ in 1..CAMERAS {
            check(&random_camera(&kind, &mut random), &mut random);
        }
    }
}

/// Returns the derivatives of X = ray.at(t) with respect to the x and y of the picture, without the
/// component along the ray. The derivatives are computed by fourth-order differences.
fn slopes(camera: &Camera, sample: &CameraSample, t: f32, step: f32) -> Option<[glam::DVec3; 2]> {
    let frame = frame(camera);
    let dir = camera.ray(&frame, sample)?.dir.as_dvec3();
    let at = |offset: Vec2| {
        let ray = camera.ray(&frame, &CameraSample { point: sample.point + offset, ..*sample })?;
        Some(ray.origin.as_dvec3() + f64::from(t) * ray.dir.as_dvec3())
    };
    let slope = |axis: Vec2| {
        let near = at(step * axis)? - at(-step * axis)?;
        let far = at(2.0 * step * axis)? - at(-2.0 * step * axis)?;
        let slope = (8.0 * near - far) / (12.0 * f64::from(step));
        Some(slope - slope.dot(dir) * dir)
    };
    Some([slope(Vec2::X)?, slope(Vec2::Y)?])
}

/// Returns the smallest and largest stretch from the picture to the world, which are the singular
/// values of the 3x2 matrix of slopes.
fn stretch([a, b]: [glam::DVec3; 2]) -> (f64, f64) {
    let (aa, bb, ab) = (a.dot(a), b.dot(b), a.dot(b));
    let (mean, apart) = (0.5 * (aa + bb), (0.25 * (aa - bb) * (aa - bb) + ab * ab).sqrt());
    ((mean - apart).max(0.0).sqrt(), (mean + apart).sqrt())
}

/// Returns the rounding error of a point in world space that is computed from an eye in single
/// precision.
fn rounding(ray: &Ray, t: f32) -> f64 {
    4.0 * f64::from(f32::EPSILON) * f64::from(ray.origin.length() + t.abs() + 1.0)
}

#[test]
fn projection_inverts_rays() {
    let (mut checked, mut skipped, mut hopeless) = (0, 0, 0);
    all(1, |camera, random| {
        let (enough, before) = (checked + POINTS, (checked, skipped));
        let mut tried = 0;
        while checked < enough {
            tried += 1;
            // Give up on cameras that are invertible almost nowhere, because their path is very
            // long or their field of view is so narrow that nothing moves in it.
            if skipped - before.1 > POINTS || tried > 100 * POINTS {
                (checked, skipped) = before;
                hopeless += 1;
                return;
            }
            let (sample, Some(ray)) = random_ray(camera, random) else { continue };
            assert!((ray.dir.length() - 1.0).abs() < 1e-6, "{camera:?}");
            let t = random.between(0.5, 20.0);
            // Nothing is visible if the far plane is in front of the near plane.
            if ray.t_min >= ray.t_max {
                (checked, skipped) = before;
                return;
            }
            let t = if t < ray.t_max { t } else { 0.5 * (ray.t_min.max(ray.t_max - 1.0) + ray.t_max) };
            // Compute the error of the point in world space, projected to the picture. If this
            // error is large, the projection is ill-conditioned.
            let Some((least, _)) = slopes(camera, &sample, t, 1.0 / 1024.0).map(stretch) else {
                skipped += 1;
                continue;
            };
            let tolerance = 1e-6 + rounding(&ray, t) / least;
            if tolerance > 1e-4 {
                skipped += 1;
                continue;
            }
            let mut nearest = f32::INFINITY;
            camera.project(&frame(camera), ray.at(t), sample.lens, &mut |found| {
                nearest = nearest.min(found.distance(sample.point));
            });
            assert!(f64::from(nearest) <= tolerance, "{nearest} > {tolerance}: {camera:?} {sample:?} {t}");
            checked += 1;
        }
    });
    assert!(skipped * 20 < checked, "{skipped} samples were skipped, {checked} were checked");
    assert!(hopeless * 50 <= Camera::kinds().len() * CAMERAS, "{hopeless} cameras were skipped");
}

#[test]
fn rays_pass_through_projected_points() {
    let mut checked = 0;
    all(2, |camera, random| {
        let frame = frame(camera);
        for _ in 0..POINTS {
            let world = 6.0 * random.point();
            let lens = Vec2::new(random.unit(), random.unit());
            let mut found = Vec::new();
            camera.project(&frame, world, lens, &mut |point| found.push(point));
            for point in found {
                let sample = CameraSample { lens, ..CameraSample::at(point) };
                // At the very rim, rounding may move the point out of the picture.
                let inwards = CameraSample { pixel: point * (1.0 - 1e-5), point: point * (1.0 - 1e-6), ..sample };
                let sample = if camera.ray(&frame, &sample).is_some() { sample } else { inwards };
                let ray = camera.ray(&frame, &sample).unwrap_or_else(|| panic!("{camera:?} {sample:?}"));
                let t = (world - ray.origin).dot(ray.dir);
                let Some((_, most)) = slopes(camera, &sample, t, 1.0 / 1024.0).map(stretch) else { continue };
                let off = f64::from(ray.at(t).distance(world));
                let moved = 1e-6 + f64::from(point.distance(sample.point));
                assert!(off <= rounding(&ray, t) + moved * most, "{off}: {camera:?} {sample:?} {world}");
                assert!(t >= 0.0 || ray.t_min < 0.0, "{camera:?} sees {world}, which is behind it");
                checked += 1;
            }
        }
    });
    assert!(checked > 300_000, "{checked}");
}

#[test]
fn footprints_match_areas_by_differences() {
    let (mut checked, mut skipped) = (0, 0);
    all(3, |camera, random| {
        for _ in 0..POINTS / 10 {
            let (sample, Some(ray)) = random_ray(camera, random) else { continue };
            let t = random.between(0.5, 20.0);
            let rounded = rounding(&ray, t);
            // Compute the area and its rounding error.
            let area = |step: f32| {
                let [a, b] = slopes(camera, &sample, t, step)?;
                Some((a.cross(b).length(), rounded / f64::from(step) * (a.length() + b.length())))
            };
            let steps = [1.0 / 256.0, 1.0 / 128.0, 1.0 / 32.0].map(area);
            let [Some((fine, error)), Some((coarse, _)), Some((coarsest, _))] = steps else {
                skipped += 1;
                continue;
            };
            // If different step sizes disagree, for example at a joint of a path, differences do
            // not approximate the slope.
            let apart = (fine - coarse).abs().max((fine - coarsest).abs());
            let stated = f64::from(camera.footprint(&frame(camera), &sample, t));
            let tolerance = 0.001 * fine + error + apart;
            if tolerance > 0.03 * fine {
                skipped += 1;
                continue;
            }
            assert!((stated - fine).abs() < tolerance, "{stated} for {fine}: {camera:?} {sample:?} {t}");
            checked += 1;
        }
    });
    assert!(skipped * 5 < checked, "{skipped} samples were skipped, {checked} were checked");
}

#[test]
fn batched_rays_match_single_rays() {
    all(8, |camera, random| {
        for rules in [
            RayArithmetic::Own,
            RayArithmetic::ScreenPoint,
            RayArithmetic::Of2012,
            RayArithmetic::Of2016,
            RayArithmetic::Of2020,
        ]
        .map(|ray_arithmetic| CameraRules { ray_arithmetic, ..CameraRules::default() })
        {
            let frame = CameraBasis::of(camera, rules);
            let samples: [CameraSample; 8] = std::array::from_fn(|_| random_ray(camera, random).0);
            let alone = samples.each_ref().map(|sample| camera.ray(&frame, sample));
            let side_by_side = CameraSamples {
                points: [0, 1].map(|axis| samples.map(|sample| sample.point[axis])),
                pixels: samples.map(|sample| sample.pixel),
                lenses: [0, 1].map(|axis| samples.map(|sample| sample.lens[axis])),
            };
            let mut found = Vec::new();
            camera.rays(&frame, &side_by_side, |_, ray| found.push(ray));
            assert_eq!(found, alone, "{camera:?}");
        }
    });
}
