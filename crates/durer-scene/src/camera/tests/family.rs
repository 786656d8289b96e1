//! Compares wide-angle cameras with closed forms of their directions and solid angles.

use super::super::cave::CaveCamera;
use super::super::cube_map::{CubeMapCamera, Layout};
use super::super::cylindrical::CylindricalCamera;
use super::super::equirectangular::EquirectangularCamera;
use super::super::fisheye::{FisheyeCamera, FisheyeProjection};
use super::super::multiple_center::MultipleCenterCamera;
use super::super::omnimax::OmnimaxCamera;
use super::super::parabolic::ParabolicCamera;
use super::super::push_broom::PushBroomCamera;
use super::*;
use std::f64::consts::PI;

/// Returns the ray of a camera in Dürer's own dialect.
pub fn ray(camera: &impl Projection, sample: CameraSample) -> Option<Ray> {
    camera.ray(&CameraBasis::of(camera, OURS), &sample)
}

/// Returns the direction that is seen at a point of the picture. By default, x is to the right, y
/// is upwards and -z is ahead.
fn dir(camera: &impl Projection, x: f32, y: f32) -> Vec3 {
    ray(camera, CameraSample::at(Vec2::new(x, y))).unwrap().dir
}

/// Returns the solid angle of a whole picture, computed by the midpoint rule with 480 x 480 cells.
fn solid_angle(camera: &impl Projection) -> f64 {
    const CELLS: u32 = 480;
    let frame = CameraBasis::of(camera, OURS);
    let side = 2.0 / f64::from(CELLS);
    let at = |i: u32| (-1.0 + side * (f64::from(i) + 0.5)) as f32;
    let cells = (0..CELLS * CELLS).map(|i| CameraSample::at(Vec2::new(at(i % CELLS), at(i / CELLS))));
    let visible = cells.filter(|sample| camera.ray(&frame, sample).is_some());
    visible.map(|sample| f64::from(camera.footprint(&frame, &sample, 1.0)) * side * side).sum()
}

#[test]
fn pictures_cover_the_solid_angles_of_their_fields_of_view() {
    let cap = |degrees: f64| 2.0 * PI * (1.0 - libm::cos((0.5 * degrees).to_radians()));
    let check = |camera: Camera, expected: f64| {
        let actual = solid_angle(&camera);
        // A cell on the rim counts either fully or not at all.
        assert!((actual / expected - 1.0).abs() < 0.004, "{actual} for {expected}: {camera:?}");
    };
    for (projection, angle) in [
        (FisheyeProjection::Equidistant, 180.0),
        (FisheyeProjection::Equidistant, 360.0),
        (FisheyeProjection::Equisolid, 360.0),
        (FisheyeProjection::Stereographic, 200.0),
        (FisheyeProjection::Orthographic, 120.0),
    ] {
        let camera = FisheyeCamera { angle, projection, ..FisheyeCamera::default() };
        check(camera.into(), cap(f64::from(angle)));
    }
    check(ParabolicCamera::default().into(), cap(210.0));
    let viewer = Vec3::new(0.2, -0.1, 0.3);
    // From the centre of a dome, a hemisphere is seen for any projector that illuminates the whole
    // dome.
    let dome = OmnimaxCamera { angle: 300.0, projector: viewer, ..OmnimaxCamera::default() };
    check(dome.into(), cap(180.0));
    check(EquirectangularCamera::default().into(), 4.0 * PI);
    // This panorama is four times as wide as it is high.
    let (half, vertical_angle) = (PI / 4.0, (2.0 * libm::atan(PI / 4.0)).to_degrees() as f32);
    let panorama = CylindricalCamera { vertical_angle, ..CylindricalCamera::default() };
    check(panorama.into(), 4.0 * PI * half / (1.0 + half * half).sqrt());
    for layout in [Layout::Cross, Layout::Strip] {
        check(CubeMapCamera { layout, ..CubeMapCamera::default() }.into(), 4.0 * PI);
    }
    // Six walls around an off-centre eye also cover the whole sphere.
    let walls = vec![
        [-1.0, -1.0, -1.0, 1.0, -1.0, -1.0, -1.0, 1.0, -1.0],
        [1.0, -1.0, -1.0, 1.0, -1.0, 1.0, 1.0, 1.0, -1.0],
        [1.0, -1.0, 1.0, -1.0, -1.0, 1.0, 1.0, 1.0, 1.0],
        [-1.0, -1.0, 1.0, -1.0, -1.0, -1.0, -1.0, 1.0, 1.0],
        [-1.0, -1.0, 1.0, 1.0, -1.0, 1.0, -1.0, -1.0, -1.0],
        [-1.0, 1.0, -1.0, 1.0, 1.0, -1.0, -1.0, 1.0, 1.0],
    ];
    check(CaveCamera { center: Vec3::new(0.4, -0.3, 0.2), walls, ..CaveCamera::default() }.into(), 4.0 * PI);
}

#[test]
fn directions_match_the_map_projections() {
    let fisheye = FisheyeCamera::default();
    close(dir(&fisheye, 0.0, 0.0), Vec3::NEG_Z);
    close(dir(&fisheye, 1.0, 0.0), Vec3::X);
    close(dir(&fisheye, 0.0, -0.5), Vec3::new(0.0, -1.0, -1.0).normalize());
    assert_eq!(ray(&fisheye, CameraSample::at(Vec2::new(0.8, 0.7))), None);
    // All horizontal directions lie on the circle r = h, and the upward direction is at the centre.
    let mirror = ParabolicCamera::default();
    let horizon = (libm::tan(PI / 4.0) / libm::tan(105f64.to_radians() / 2.0)) as f32;
    close(dir(&mirror, 0.0, 0.0), Vec3::Y);
    close(dir(&mirror, horizon, 0.0), Vec3::X);
    close(dir(&mirror, 0.0, horizon), Vec3::NEG_Z);
    let sphere = EquirectangularCamera::default();
    close(dir(&sphere, 0.5, 0.0), Vec3::X);
    close(dir(&sphere, -0.5, 0.25), Vec3::new(-1.0, 1.0, 0.0).normalize());
    close(dir(&sphere, 1.0, 0.0), Vec3::Z);
    // The pole of the dome is tilted forwards, and the front of its rim is at the bottom.
    let dome = OmnimaxCamera::default();
    let (sin, cos) = (0.5, libm::sqrt(0.75) as f32);
    close(dir(&dome, 0.0, 0.0), Vec3::new(0.0, cos, -sin));
    close(dir(&dome, 0.0, -1.0), Vec3::new(0.0, -sin, -cos));
    close(dir(&dome, 1.0, 0.0), Vec3::X);
    // The columns of the cross are left, front, right and back. The rows are down, middle and up.
    let cross = CubeMapCamera::default();
    for (x, y, expected) in [
        (-0.25, 0.0, Vec3::NEG_Z),
        (0.25, 0.0, Vec3::X),
        (0.75, 0.0, Vec3::Z),
        (-0.75, 0.0, Vec3::NEG_X),
        (-0.25, 0.5, Vec3::Y),
        (-0.25, -0.5, Vec3::NEG_Y),
    ] {
        close(dir(&cross, x, y), expected);
    }
    assert_eq!(ray(&cross, CameraSample::at(Vec2::splat(0.7))), None);
    let strip = CubeMapCamera { layout: Layout::Strip, ..cross };
    for (i, expected) in [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z].into_iter().enumerate() {
        close(dir(&strip, (2 * i) as f32 / 6.0 - 5.0 / 6.0, 0.0), expected);
    }
}

#[test]
fn filter_across_a_seam_continues_the_face() {
    let cross = CubeMapCamera::default();
    // This is a pixel at the right edge of the up face, where the picture continues with black or
    // with another face.
    let edge = Vec2::new(0.0, 0.5);
    let beyond = CameraSample { point: edge + Vec2::new(0.01, 0.0), ..CameraSample::at(edge - Vec2::new(0.01, 0.0)) };
    let on_face = ray(&cross, CameraSample { point: edge, ..beyond }).unwrap().dir;
    let further = ray(&cross, beyond).unwrap().dir;
    assert!(on_face.distance(further) < 0.04 && further.x > further.y, "{on_face} {further}");
    // Beyond the left border, the sphere continues at the right border. Beyond the pole, the sphere
    // continues downwards on the other side.
    let sphere = EquirectangularCamera::default();
    let left = CameraSample { point: Vec2::new(-1.01, 0.1), ..CameraSample::at(Vec2::new(-0.99, 0.1)) };
    close(ray(&sphere, left).unwrap().dir, dir(&sphere, 0.99, 0.1));
    let pole = CameraSample { point: Vec2::new(0.2, 0.51), ..CameraSample::at(Vec2::new(0.2, 0.49)) };
    close(ray(&sphere, pole).unwrap().dir, dir(&sphere, -0.8, 0.49));
}

#[test]
fn walls_agree_along_their_common_edge() {
    // There are left, front and right walls, each of which is 2 wide and 1.5 high. The eyes are
    // off-centre and turned.
    let walls = vec![
        [-1.0, 0.0, 1.0, -1.0, 0.0, -1.0, -1.0, 1.5, 1.0],
        [-1.0, 0.0, -1.0, 1.0, 0.0, -1.0, -1.0, 1.5, -1.0],
        [1.0, 0.0, -1.0, 1.0, 0.0, 1.0, 1.0, 1.5, -1.0],
    ];
    let camera = CaveCamera {
        center: Vec3::new(0.3, 0.9, 0.4),
        direction: Vec3::new(0.5, 0.0, -1.0),
        walls,
        eyes: Eyes::TopBottom,
        separation: 0.2,
        ..CaveCamera::default()
    };
    assert_eq!(camera.proportions(), Some(Vec2::new(6.0, 3.0)));
    // The picture has 600 x 300 pixels. The border between the last column of one wall and the
    // first column of the next is sampled for both walls.
    let raster = Raster::new(600, 300, camera.proportions(), OURS);
    for (column, eye_row) in [(200.0, 0.0), (200.0, 150.0), (400.0, 0.0), (400.0, 150.0)] {
        for row in [0.5, 70.5, 149.5] {
            let at = |x: f32| raster.point(Vec2::new(x, eye_row + row));
            let visible =
                |pixel: f32| ray(&camera, CameraSample { pixel: at(pixel), ..CameraSample::at(at(column)) }).unwrap();
            let (before, after) = (visible(column - 0.5), visible(column + 0.5));
            assert_eq!(before.origin, after.origin);
            close(before.dir, after.dir);
            // This is also the ray to that edge in world space.
            let x = if column == 200.0 { -1.0 } else { 1.0 };
            let edge = Vec3::new(x, 1.5 * (1.0 - row / 150.0), -1.0);
            close(before.dir, (edge - before.origin).normalize());
        }
    }
    // The upper picture is that of the left eye.
    let origin = |y: f32| ray(&camera, CameraSample::at(Vec2::new(0.0, y))).unwrap().origin;
    let (left, right) = (origin(0.25), origin(-0.25));
    assert!((left.distance(right) - 0.2).abs() < 1e-6 && (right - left).dot(Vec3::new(1.0, 0.0, 0.5)) > 0.0);
    // Check that an eye in the plane of a wall is rejected, and so are walls without extent or
    // without a right angle.
    let refused = |camera: CaveCamera| assert!(camera.validate().is_err(), "{camera:?}");
    refused(CaveCamera { center: Vec3::new(5.0, 0.0, -1.0), eyes: Eyes::Middle, ..camera.clone() });
    refused(CaveCamera { walls: vec![[0.0; 9]], ..camera.clone() });
    refused(CaveCamera { walls: vec![[0.0, 0.0, -1.0, 1.0, 0.0, -1.0, 0.5, 1.0, -1.0]], ..camera });
}

#[test]
fn straight_path_equals_a_push_broom() {
    let way = Vec3::new(3.0, 0.5, -0.5);
    let push = PushBroomCamera { start: -way, end: way, angle: 50.0, aspect: 3.0, ..PushBroomCamera::default() };
    let row = |u: f32| {
        let eye = way * u;
        [eye.x, eye.y, eye.z, eye.x, eye.y, eye.z - 2.0]
    };
    let path = [-1.0, -0.5, 0.0, 0.5, 1.0].map(row).to_vec();
    let path = MultipleCenterCamera { path, up: Vec3::Y, angle: 50.0, aspect: 3.0 };
    for (x, y) in [(0.0, 0.0), (-0.9, 0.3), (0.33, -0.2), (0.77, 0.1)] {
        let [a, b] = [ray(&push, CameraSample::at(Vec2::new(x, y))), ray(&path, CameraSample::at(Vec2::new(x, y)))];
        close(a.unwrap().origin, b.unwrap().origin);
        close(a.unwrap().dir, b.unwrap().dir);
    }
}

#[test]
fn closed_path_is_smooth_and_sees_all_sides() {
    let row = |k: i32| {
        let angle = f64::from(k).to_radians() * 30.0;
        [4.0 * libm::sin(angle) as f32, 0.0, 4.0 * libm::cos(angle) as f32, 0.0, 0.0, 0.0]
    };
    let mut path: Vec<[f32; 6]> = (0..12).map(row).collect();
    path.push(path[0]);
    let camera = MultipleCenterCamera { path, aspect: 2.0, ..MultipleCenterCamera::default() };
    let frame = CameraBasis::of(&camera, OURS);
    let at = |x: f32| CameraSample::at(Vec2::new(x, 0.0));
    close(ray(&camera, at(1.0)).unwrap().origin, ray(&camera, at(-1.0)).unwrap().origin);
    // The footprint depends on the derivative of the path.
    let slope = |x: f32| camera.footprint(&frame, &at(x), 3.0);
    assert!((slope(1.0) - slope(-1.0)).abs() < 1e-4 * slope(1.0), "{} {}", slope(1.0), slope(-1.0));
    // An off-centre point is seen both from the front and from the back.
    let mut actual = Vec::new();
    camera.project(&frame, Vec3::new(0.5, 0.1, 0.0), Vec2::ZERO, &mut |point| actual.push(point));
    assert_eq!(actual.len(), 2, "{actual:?}");
}
