//! Tests for the geometric solvers. They check that the solvers recover the true model and report
//! degenerate data.

use durer_photo::geometry::align::{Similarity, align_cameras, align_points};
use durer_photo::geometry::camera::{decompose, solve_dlt};
use durer_photo::geometry::essential::{five_point, pose_in_front};
use durer_photo::geometry::fundamental::{FundamentalProblem, eight_point, sampson, seven_point};
use durer_photo::geometry::p3p::p3p;
use durer_photo::geometry::ransac::{RansacOptions, ransac};
use durer_photo::model::{axis_angle_of, rotation_of};
use durer_photo::random::Random;
use durer_photo::resect::{Axis, LensPriors, PointPixelPair, VanishingLines, camera, from_vanishing_lines};
use durer_photo::{Lens, Pose, Reconstruction, View};
use nalgebra::{Matrix3, Vector2, Vector3};

fn vector(random: &mut Random, size: f64) -> Vector3<f64> {
    Vector3::from_fn(|_, _| size * (2.0 * random.unit() - 1.0))
}

/// Returns a random pose that sees the points around (0, 0, 5).
fn pose(random: &mut Random) -> Pose {
    Pose { rotation: rotation_of(&vector(random, 0.3)), translation: vector(random, 1.0) }
}

fn point(random: &mut Random) -> Vector3<f64> {
    vector(random, 1.5) + Vector3::new(0.0, 0.0, 6.0)
}

fn seen(pose: &Pose, point: &Vector3<f64>) -> Vector2<f64> {
    let p = pose.apply(point);
    Vector2::new(p.x / p.z, p.y / p.z)
}

/// Returns true if two matrices are equal up to a factor.
fn same(a: &Matrix3<f64>, b: &Matrix3<f64>) -> bool {
    let (a, b) = (a / a.norm(), b / b.norm());
    (a - b).norm().min((a + b).norm()) < 1e-6
}

#[test]
fn two_views_are_found_from_five_seven_and_eight_points() {
    let random = &mut Random::new(1);
    let mut missed = 0;
    for _ in 0..100 {
        let second = pose(random);
        let points: Vec<_> = (0..12).map(|_| point(random)).collect();
        let pairs: Vec<_> = points.iter().map(|p| (seen(&Pose::identity(), p), seen(&second, p))).collect();
        let truth = second.translation.cross_matrix() * second.rotation;
        let five: [_; 5] = pairs[..5].try_into().unwrap();
        missed += usize::from(!five_point(&five).iter().any(|e| same(e, &truth)));
        let seven: [_; 7] = pairs[..7].try_into().unwrap();
        assert!(seven_point(&seven).iter().any(|f| same(f, &truth)));
        let eight = eight_point(&pairs).unwrap();
        assert!(same(&eight, &truth));
        assert!(pairs.iter().all(|pair| sampson(&eight, pair) < 1e-18));
        let (found, count) = pose_in_front(&truth, &pairs).unwrap();
        assert_eq!(count, 12);
        assert!((found.rotation - second.rotation).norm() < 1e-9);
        assert!((found.translation - second.translation.normalize()).norm() < 1e-9);
    }
    // The polynomial of degree ten loses precision if the five points are close to a degenerate
    // configuration.
    assert!(missed <= 3, "{missed}");
}

#[test]
fn p3p_solutions_include_the_true_pose() {
    let random = &mut Random::new(2);
    for _ in 0..200 {
        let (truth, points) = (pose(random), [(); 3].map(|()| point(random)));
        let poses = p3p(&points, &points.map(|p| truth.apply(&p)));
        let near =
            |pose: &Pose| (pose.rotation - truth.rotation).norm() + (pose.translation - truth.translation).norm();
        assert!(poses.iter().any(|pose| near(pose) < 1e-5), "{:?}", poses.iter().map(near).collect::<Vec<_>>());
        assert!(poses.len() <= 4);
    }
    // The pose is not unique if the points are on a line.
    let line = [0.0, 1.0, 2.0].map(|x| Vector3::new(x, x, 5.0));
    assert!(p3p(&line, &line).is_empty());
}

#[test]
fn outliers_are_separated_from_inliers() {
    let random = &mut Random::new(3);
    let second = pose(random);
    let pair = |random: &mut Random, truth: bool| {
        let p = point(random);
        let (a, b) = (seen(&Pose::identity(), &p), seen(&second, &p));
        (500.0 * a, if truth { 500.0 * b } else { 300.0 * vector(random, 1.0).xy() })
    };
    // More than half of the pairs are outliers.
    let pairs: Vec<_> = (0..300).map(|i| pair(random, i % 5 < 2)).collect();
    let search = RansacOptions { threshold: 0.5, samples: 20000, seed: 7 };
    let (f, inliers) = ransac(&FundamentalProblem(&pairs), &search).unwrap();
    assert!((0..300).filter(|i| i % 5 < 2).all(|i| inliers.contains(&i)));
    // Some outliers lie on their epipolar lines by chance.
    assert!(inliers.len() < 130, "{}", inliers.len());
    assert_eq!(ransac(&FundamentalProblem(&pairs), &search).unwrap(), (f, inliers));
}

#[test]
fn similarity_is_recovered() {
    let random = &mut Random::new(4);
    let points: Vec<_> = (0..5).map(|_| vector(random, 3.0)).collect();
    let rotation = rotation_of(&vector(random, 2.0));
    let moved: Vec<_> = points.iter().map(|p| 2.5 * (rotation * p) + Vector3::new(1.0, 2.0, 3.0)).collect();
    let found = align_points(&points, &moved).unwrap();
    assert!((found.scale - 2.5).abs() < 1e-12 && (found.rotation - rotation).norm() < 1e-12);
    let line: Vec<_> = (0..5).map(|i| Vector3::new(f64::from(i), 0.0, 0.0)).collect();
    assert_eq!(align_points(&line, &line), None);
    // If the cameras are on a line, only their rotations determine the rotation about that line.
    let mut turned = |center: &Vector3<f64>| Pose::at(center, rotation_of(&vector(random, 2.0)));
    let there: Vec<Pose> = line.iter().map(&mut turned).collect();
    let mut all = Reconstruction::default();
    all.views.extend(there.iter().map(|pose| View { name: String::new(), lens: 0, pose: Some(*pose) }));
    Similarity { scale: 0.4, rotation, translation: vector(random, 5.0) }.apply_to(&mut all);
    let moved: Vec<Pose> = all.views.iter().filter_map(|view| view.pose).collect();
    let found = align_cameras(&there, &moved).unwrap();
    assert!((found.scale - 0.4).abs() < 1e-12 && (found.rotation - rotation).norm() < 1e-12);
    assert!(there.iter().zip(&moved).all(|(a, b)| (found.apply(&a.center()) - b.center()).norm() < 1e-12));
    assert_eq!(align_cameras(&there[..1], &moved[..1]), None);
}

#[test]
fn rotations_survive_conversion_to_axis_and_angle() {
    let random = &mut Random::new(5);
    for size in [1e-12, 1e-5, 1e-3, 0.1, 1.7] {
        let axis = vector(random, size);
        assert!((axis_angle_of(&rotation_of(&axis)) - axis).norm() < 1e-12 * (1.0 + size));
    }
    let half = Vector3::new(0.0, std::f64::consts::PI, 0.0);
    assert!((axis_angle_of(&rotation_of(&half)).norm() - std::f64::consts::PI).abs() < 1e-12);
}

/// Returns a random camera, and random points with the pixels at which the camera sees them.
fn photographed(count: usize, flat: bool) -> (Lens, Pose, Vec<PointPixelPair>) {
    let random = &mut Random::new(6);
    let lens = Lens { distortion: [-0.1, 0.02], ..Lens::new([800, 600], 750.0) };
    let truth = pose(random);
    let pairs = (0..count).map(|_| {
        let p = point(random);
        let p = if flat { Vector3::new(p.x, p.y, 6.0 + 0.5 * p.x) } else { p };
        (p, lens.project(&truth.apply(&p)))
    });
    (lens, truth, pairs.collect())
}

fn known(focal: Option<f64>) -> LensPriors {
    LensPriors { size: [800, 600], focal, distortion: true, threshold: 4.0 }
}

#[test]
fn one_photograph_of_known_points_gives_its_camera() {
    let (lens, truth, mut pairs) = photographed(20, false);
    // Two of the points are outliers.
    pairs[3].1.x += 90.0;
    pairs[11].1.y -= 60.0;
    let found = camera(&pairs, &known(None)).unwrap();
    assert!((found.lens.focal - lens.focal).abs() < 1e-3, "{:?}", found.lens);
    assert!((found.pose.center() - truth.center()).norm() < 1e-5);
    assert!(!found.inliers.contains(&3) && !found.inliers.contains(&11) && found.inliers.len() == 18);
    // The points are in a plane, and the focal length is known.
    let (lens, truth, pairs) = photographed(12, true);
    let found = camera(&pairs, &known(Some(lens.focal))).unwrap();
    assert!((found.pose.center() - truth.center()).norm() < 1e-4);
    // Without lens distortion, the direct linear transform alone is exact.
    let plain = Lens::new([800, 600], 750.0);
    let points: Vec<_> = photographed(8, false).2.into_iter().map(|pair| pair.0).collect();
    let pixels: Vec<_> = points.iter().map(|p| plain.project(&truth.apply(p))).collect();
    let (k, rotation, translation) = decompose(&solve_dlt(&points, &pixels).unwrap().matrix).unwrap();
    assert!((k - Matrix3::new(750.0, 0.0, 400.0, 0.0, 750.0, 300.0, 0.0, 0.0, 1.0)).norm() < 1e-5);
    assert!((rotation - truth.rotation).norm() + (translation - truth.translation).norm() < 1e-7);
}

#[test]
fn degenerate_points_are_reported() {
    let why = |pairs: &[_], focal| camera(pairs, &known(focal)).unwrap_err().message;
    assert!(why(&photographed(20, true).2, None).contains("lie in a plane, so DLT has no unique solution"));
    assert!(why(&photographed(5, false).2, None).contains("at least 6 points"));
    assert!(why(&photographed(3, false).2, Some(750.0)).contains("three points fit up to four cameras"));
    let line: Vec<_> = (0..9)
        .map(|i| (Vector3::new(f64::from(i), 0.0, 9.0), Vector2::new(400.0 + 50.0 * f64::from(i), 300.0)))
        .collect();
    assert!(why(&line, Some(750.0)).contains("lie on a line"));
    let random = &mut Random::new(8);
    let chance: Vec<_> = (0..40).map(|_| (point(random), 200.0 * vector(random, 1.0).xy())).collect();
    assert!(why(&chance, None).contains("no camera sees the points"));
}

#[test]
fn vanishing_lines_give_the_camera() {
    let lens = Lens::new([1000, 700], 900.0);
    let truth = Pose::look_at(&Vector3::new(4.0, 3.0, 5.0), &Vector3::zeros(), &Vector3::y());
    let pixel = |x: f64, y: f64, z: f64| lens.project(&truth.apply(&Vector3::new(x, y, z)));
    // The lines lead towards -x and -z, which are both in front of the camera.
    let lines = [
        vec![[pixel(1.0, 0.0, 0.0), pixel(-2.0, 0.0, 0.0)], [pixel(1.0, 0.0, 1.0), pixel(-2.0, 0.0, 1.0)]],
        vec![[pixel(0.0, 0.0, 1.0), pixel(0.0, 0.0, -2.0)], [pixel(1.0, 0.5, 1.0), pixel(1.0, 0.5, -2.0)]],
    ];
    let axes = ["-x", "zNegative"].map(|name| Axis::parse(name).unwrap());
    let known = VanishingLines {
        size: lens.size,
        center: lens.principal_point.into(),
        origin: pixel(0.0, 0.0, 0.0),
        axes,
        lines,
    };
    let (found, pose) = from_vanishing_lines(&known, truth.center().norm()).unwrap();
    assert!((found.focal - 900.0).abs() < 1e-6);
    assert!((pose.rotation - truth.rotation).norm() < 1e-9 && (pose.center() - truth.center()).norm() < 1e-8);
    let why = |change: &dyn Fn(&mut VanishingLines)| {
        let mut known = known.clone();
        change(&mut known);
        from_vanishing_lines(&known, 1.0).unwrap_err().message
    };
    let across = |y: f64| [Vector2::new(10.0, y), Vector2::new(700.0, y)];
    assert!(why(&|k| k.lines[0] = vec![across(10.0), across(400.0)]).contains("at infinity"));
    assert!(why(&|k| k.lines[0].truncate(1)).contains("at least two distinct lines"));
    assert!(why(&|k| k.axes[1] = k.axes[0]).contains("same axis"));
    assert!(why(&|k| k.lines[1] = k.lines[0].clone()).contains("more than 90 degrees"));
}
