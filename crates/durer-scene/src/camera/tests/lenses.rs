//! Tests lenses, pinholes, stereo pairs and distorted photographs.

use super::super::aperture;
use super::super::pinhole::PinholeCamera;
use super::super::projective::ProjectiveCamera;
use super::super::stereo::{StereoCamera, StereoMethod};
use super::super::thin_lens::ThinLensCamera;
use super::family::ray;
use super::*;
use crate::math::random::Random;
use glam::DVec2;

#[test]
fn aperture_samples_are_uniform() {
    let mut random = Random(1);
    for blades in [0, 3, 4, 6, 9] {
        const COUNT: usize = 200_000;
        // Compute the mean square radius of a disc of radius 1, or of a regular polygon inscribed
        // in it, which is (2 + cos 2π/n) / 6. The mean of the points is 0.
        let expected = match blades {
            0 => 0.5,
            n => (2.0 + libm::cos(std::f64::consts::TAU / f64::from(n))) / 6.0,
        };
        let (mut sum, mut squares) = (DVec2::ZERO, 0.0);
        for _ in 0..COUNT {
            let point = aperture::sample(Vec2::new(random.unit(), random.unit()), blades, 20.0);
            assert!(point.length() <= 1.0 + 1e-12);
            sum += point;
            squares += point.length_squared();
        }
        let n = COUNT as f64;
        // Allow five standard errors, since no coordinate and no square exceeds 1.
        let error = 5.0 / n.sqrt();
        assert!((sum / n).length() < error && (squares / n - expected).abs() < error, "{blades}: {sum} {squares}");
        assert_eq!(aperture::sample(Vec2::splat(0.5), blades, 20.0), DVec2::ZERO);
    }
    assert!([0, 3, 64].iter().all(|&n| aperture::validate(n).is_ok()));
    assert!([1, 2, 65].iter().all(|&n| aperture::validate(n).is_err()));
}

#[test]
fn rays_of_a_picture_point_meet_only_in_the_focus_plane() {
    let camera = ThinLensCamera {
        center: Vec3::Y,
        angle: 90.0,
        aperture: 0.5,
        focus_distance: 4.0,
        blades: 5,
        shift_up: 0.25,
        ..ThinLensCamera::default()
    };
    let mut random = Random(2);
    let point = Vec2::new(0.5, -0.25);
    for _ in 0..1000 {
        let sample = CameraSample { lens: Vec2::new(random.unit(), random.unit()), ..CameraSample::at(point) };
        let ray = ray(&camera, sample).unwrap();
        let at_depth = |depth: f32| ray.at((depth - ray.origin.z) / ray.dir.z);
        assert!(at_depth(-4.0).distance(Vec3::new(2.0, 1.0, -4.0)) < 1e-5);
        // At twice the focus distance, the circle of confusion is as wide as the lens.
        let off = at_depth(-8.0) - Vec3::new(4.0, 1.0, -8.0);
        assert!(off.length() <= 0.25 + 1e-5 && off.distance(-(ray.origin - Vec3::Y)) < 1e-5);
        assert!(ray.origin.distance(Vec3::Y) <= 0.25);
    }
    // Without aperture and shift, the camera is equivalent to the perspective camera.
    let (plain, lens) = (PerspectiveCamera::default(), ThinLensCamera::default());
    let sample = CameraSample { lens: Vec2::new(0.1, 0.9), ..CameraSample::at(point) };
    close(ray(&plain, sample).unwrap().dir, ray(&lens, sample).unwrap().dir);
}

#[test]
fn pinhole_blurs_near_points_more_than_far_ones() {
    let camera = PinholeCamera { angle: 90.0, hole: 0.2, film_distance: 0.5, ..PinholeCamera::default() };
    let frame = CameraBasis::of(&camera, OURS);
    let (mut random, mut far, mut near) = (Random(3), 0f32, 0f32);
    for _ in 0..20_000 {
        let lens = Vec2::new(random.unit(), random.unit());
        camera.project(&frame, Vec3::NEG_Z * 1e6, lens, &mut |point| far = far.max(point.length()));
        camera.project(&frame, Vec3::NEG_Z * 0.5, lens, &mut |point| near = near.max(point.length()));
    }
    // The film is 1 wide and the picture is 2 wide. A hole of radius 0.1 therefore has a radius of
    // 0.2 in the picture, and twice that at the film's distance.
    assert!((far - 0.2).abs() < 1e-3 && (near - 0.4).abs() < 2e-3, "{far} {near}");
}

#[test]
fn stereo_views_agree_at_the_convergence_distance() {
    let camera = StereoCamera { angle: 60.0, separation: 0.3, convergence: 5.0, ..StereoCamera::default() };
    assert_eq!(camera.proportions(), Some(Vec2::new(2.0, 1.0)));
    let frame = CameraBasis::of(&camera, OURS);
    let pair = |camera: &StereoCamera, point: Vec3| {
        let mut projected = Vec::new();
        camera.project(&frame, point, Vec2::ZERO, &mut |p| projected.push(p));
        assert_eq!(projected.len(), 2, "{projected:?}");
        assert!(projected[0].x < 0.0 && projected[1].x > 0.0, "the left eye's picture is on the left");
        // Return the difference between the positions of the point in the two pictures.
        (projected[1] - projected[0] - Vec2::X) * 2.0
    };
    for point in [Vec3::new(1.0, 0.7, -5.0), Vec3::new(-1.5, 0.2, -5.0)] {
        assert!(pair(&camera, point).length() < 1e-6);
        // The views of toed-in cameras agree only at the centre, and the heights differ elsewhere.
        let turned = StereoCamera { method: StereoMethod::ToeIn, ..camera.clone() };
        assert!(pair(&turned, Vec3::NEG_Z * 5.0).length() < 1e-6);
        assert!(pair(&turned, point).y.abs() > 1e-4);
    }
    // For the right eye, nearer objects move to the left and farther ones to the right. Without
    // convergence, all objects move to the left.
    assert!(pair(&camera, Vec3::NEG_Z * 2.5).x < -0.05 && pair(&camera, Vec3::NEG_Z * 50.0).x > 0.05);
    let parallel = StereoCamera { method: StereoMethod::Parallel, ..camera };
    assert!(pair(&parallel, Vec3::NEG_Z * 50.0).x < -0.005);
}

/// Returns a camera at (1, 2, 3) that looks along -z, with a matrix for pictures of 200 x 100
/// pixels.
fn photograph() -> ProjectiveCamera {
    let (f, cx, cy) = (150.0, 99.5, 49.5);
    let rows = [[f, 0.0, -cx], [0.0, -f, -cy], [0.0, 0.0, -1.0]];
    let matrix = rows.map(|r| [r[0], r[1], r[2], -(r[0] + 2.0 * r[1] + 3.0 * r[2])]).to_vec();
    ProjectiveCamera { matrix, width: 200.0, height: 100.0, ..ProjectiveCamera::default() }
}

#[test]
fn projection_matrix_gives_the_camera_at_any_scale() {
    let angle = (2.0 * libm::atan(100.0 / 150.0)).to_degrees() as f32;
    let plain = PerspectiveCamera { center: Vec3::new(1.0, 2.0, 3.0), angle, ..PerspectiveCamera::default() };
    for scale in [1.0, -2.0, 1e-3] {
        let mut camera = photograph();
        camera.matrix.iter_mut().flatten().for_each(|x| *x *= scale);
        for (x, y) in [(0.0, 0.0), (0.9, 0.4), (-0.5, -0.5), (0.2, -0.3)] {
            let sample = CameraSample::at(Vec2::new(x, y));
            let [a, b] = [ray(&camera, sample).unwrap(), ray(&plain, sample).unwrap()];
            assert!(a.origin.distance(b.origin) < 1e-5 && a.dir.distance(b.dir) < 1e-6, "{a:?} {b:?}");
        }
    }
    assert!(ProjectiveCamera { matrix: vec![[1.0, 2.0, 3.0, 4.0]; 3], ..photograph() }.validate().is_err());
}

#[test]
fn distortion_matches_the_formula_and_ends_at_the_fold() {
    let frame = CameraBasis::of(&photograph(), OURS);
    let project = |camera: &ProjectiveCamera, x: f32, y: f32| {
        let mut projected = None;
        camera.project(&frame, Vec3::new(1.0 + x, 2.0 - y, 2.0), Vec2::ZERO, &mut |point| projected = Some(point));
        // Convert to pixel coordinates, with y downwards.
        projected.map(|point| Vec2::new(100.0 + 100.0 * point.x - 0.5, 50.0 - 100.0 * point.y - 0.5))
    };
    let camera = ProjectiveCamera { k1: -0.2, k2: 0.05, p1: 0.01, p2: -0.02, k3: 0.1, ..photograph() };
    let (x, y) = (0.4f32, 0.2f32);
    let s = x * x + y * y;
    let factor = 1.0 - 0.2 * s + 0.05 * s * s + 0.1 * s * s * s;
    let expected = Vec2::new(
        x * factor + 2.0 * 0.01 * x * y - 0.02 * (s + 2.0 * x * x),
        y * factor + 0.01 * (s + 2.0 * y * y) - 2.0 * 0.02 * x * y,
    );
    let projected = project(&camera, x, y).unwrap();
    assert!(projected.distance(150.0 * expected + Vec2::new(99.5, 49.5)) < 1e-3, "{projected} {expected}");
    // r - r³ grows only up to r = 1/sqrt 3, where it is 0.385. Beyond this value, neither `project`
    // nor `ray` finds a point.
    let folded = ProjectiveCamera { k1: -1.0, ..photograph() };
    assert!(project(&folded, 0.55, 0.0).is_some() && project(&folded, 0.6, 0.0).is_none());
    let at = |pixels: f32| ray(&folded, CameraSample::at(Vec2::new(pixels / 100.0, 0.0)));
    assert!(at(0.38 * 150.0).is_some() && at(0.39 * 150.0).is_none());
}
