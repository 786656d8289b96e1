//! Tests the rays of cameras through known points of pictures.

use super::*;

mod family;
mod lenses;

const OURS: CameraRules =
    CameraRules { up: UpRule::Perpendicular, ray_arithmetic: RayArithmetic::Own, border_pixels: false, stretch: false };

fn close(a: Vec3, b: Vec3) {
    assert!((a - b).length() < 1e-6, "{a} {b}");
}

#[test]
fn pixel_centres_lie_inside_the_square_and_edges_on_its_border() {
    let raster = Raster::new(4, 4, None, OURS);
    assert_eq!(raster.point(Vec2::ZERO), Vec2::new(-1.0, 1.0));
    assert_eq!(raster.point(Vec2::splat(4.0)), Vec2::new(1.0, -1.0));
    assert_eq!(raster.point(Vec2::splat(2.0)), Vec2::ZERO);
    assert_eq!(raster.point(Vec2::splat(0.5)), Vec2::new(-0.75, 0.75));
}

#[test]
fn larger_side_spans_the_square_unless_stretched() {
    for (width, height, corner) in [(8, 4, Vec2::new(1.0, 0.5)), (4, 8, Vec2::new(0.5, 1.0)), (5, 5, Vec2::ONE)] {
        let end = Vec2::new(width as f32, height as f32);
        assert_eq!(Raster::new(width, height, None, OURS).point(end), corner * Vec2::new(1.0, -1.0));
        assert_eq!(
            Raster::new(width, height, None, CameraRules { stretch: true, ..OURS }).point(end),
            Vec2::new(1.0, -1.0)
        );
    }
}

#[test]
fn natural_picture_fits_undistorted_into_any_picture() {
    for (width, height, corner) in [(8, 4, [1.0, 0.5]), (8, 8, [1.0, 1.0]), (8, 2, [2.0, 0.5]), (2, 8, [1.0, 4.0])] {
        let end = Vec2::new(width as f32, 0.0);
        for stretch in [false, true] {
            let raster = Raster::new(width, height, Some(Vec2::new(6.0, 3.0)), CameraRules { stretch, ..OURS });
            assert_eq!(raster.point(end), Vec2::from(corner));
        }
    }
}

#[test]
fn sizes_follow_proportions_and_empty_pixels_are_counted() {
    let size = |w, h| Raster::natural_size(Some(Vec2::new(w, h)), (512, 512));
    assert_eq!(Raster::natural_size(None, (512, 512)), (512, 512));
    assert_eq!([size(4.0, 3.0), size(6.0, 1.0), size(360.0, 180.0)], [(592, 444), (1254, 209), (720, 360)]);
    assert_eq!([size(1.0, 1.0), size(4000.0, 1000.0), size(1e4, 1.0)], [(512, 512), (1024, 256), (50000, 5)]);
    // A picture of the proposed size has no empty columns or rows, for any number of pixels.
    for (pixels, w, h) in [(8, 360.0, 180.0), (40, 360.0, 180.0), (33, 6.25, 2.0), (51, 1.0, 7.3)] {
        let sides = Some(Vec2::new(w, h));
        let (width, height) = Raster::natural_size(sides, (pixels, pixels));
        assert_eq!(Raster::new(width, height, sides, OURS).empty(), (0, 0), "{width}x{height} for {w}:{h}");
    }
    let empty = |width, height| Raster::new(width, height, Some(Vec2::new(3.0, 1.0)), OURS).empty();
    assert_eq!([empty(300, 100), empty(301, 100), empty(300, 300)], [(0, 0), (1, 0), (0, 200)]);
    assert_eq!([empty(100, 33), empty(100, 34), Raster::new(9, 5, None, OURS).empty()], [(1, 0), (0, 0), (0, 0)]);
}

#[test]
fn border_pixels_have_centres_on_the_border() {
    let last = Vec2::new(6.5, 4.5);
    let square = Raster::new(7, 5, None, CameraRules { border_pixels: true, ..OURS });
    assert!((square.point(Vec2::splat(0.5)) - Vec2::new(-1.0, 4.0 / 6.0)).length() < 1e-6);
    assert!((square.point(last) - Vec2::new(1.0, -4.0 / 6.0)).length() < 1e-6);
    let stretched = Raster::new(7, 5, None, CameraRules { border_pixels: true, stretch: true, ..OURS });
    assert_eq!(stretched.point(Vec2::splat(0.5)), Vec2::new(-1.0, 1.0));
    assert_eq!(stretched.point(last), Vec2::new(1.0, -1.0));
    // A picture that consists of one pixel or one row has its centre at 0.
    assert_eq!(
        Raster::new(1, 1, None, CameraRules { border_pixels: true, ..OURS }).point(Vec2::splat(0.5)),
        Vec2::ZERO
    );
    assert_eq!(
        Raster::new(3, 1, None, CameraRules { border_pixels: true, ..OURS }).point(Vec2::splat(0.5)),
        Vec2::new(-1.0, 0.0)
    );
}

#[test]
fn basis_is_right_handed_unless_up_is_raw() {
    let pose = Pose { center: Vec3::X, direction: Vec3::NEG_Z * 3.0, up: Vec3::new(0.0, 2.0, -2.0) };
    let frame = CameraBasis::new(pose, OURS);
    assert_eq!((frame.eye, frame.forward), (Vec3::X, Vec3::NEG_Z));
    close(frame.right, Vec3::X);
    close(frame.up, Vec3::Y);
    assert_eq!(CameraBasis::new(pose, CameraRules { up: UpRule::Raw, ..OURS }).up, pose.up);
    close(CameraBasis::new(pose, CameraRules { up: UpRule::Skew, ..OURS }).up, pose.up.normalize());
    // If the view direction is parallel to `up`, the axes are arbitrary but perpendicular.
    let frame = CameraBasis::new(Pose { up: Vec3::Z, ..pose }, OURS);
    assert!(frame.right.is_normalized() && frame.up.is_normalized());
    assert!(frame.right.dot(frame.up).abs() + frame.right.dot(frame.forward).abs() < 1e-6);
}

#[test]
fn perspective_camera_sees_its_angle_across_the_square() {
    let camera = PerspectiveCamera { center: Vec3::Y, angle: 90.0, ..PerspectiveCamera::default() };
    let frame = CameraBasis::of(&camera, OURS);
    let ray = |x, y| camera.ray(&frame, &CameraSample::at(Vec2::new(x, y))).unwrap();
    close(ray(0.0, 0.0).dir, Vec3::NEG_Z);
    close(ray(1.0, 0.0).dir, Vec3::new(1.0, 0.0, -1.0).normalize());
    close(ray(-1.0, -1.0).dir, Vec3::new(-1.0, -1.0, -1.0).normalize());
    assert_eq!((ray(0.3, 0.4).origin, ray(0.3, 0.4).t_min), (Vec3::Y, 0.0));
    for angle in [1.0f32, 30.0, 120.0, 179.0] {
        let camera = PerspectiveCamera { angle, ..camera.clone() };
        let frame = CameraBasis::of(&camera, OURS);
        let dir = |x| camera.ray(&frame, &CameraSample::at(x)).unwrap().dir;
        let cosine = dir(Vec2::X).dot(dir(Vec2::NEG_X));
        assert!((f64::from(cosine) - libm::cos(f64::from(angle).to_radians())).abs() < 1e-6, "{angle}");
    }
}

#[test]
fn orthographic_rays_start_on_the_picture_and_extend_both_ways() {
    let camera = OrthographicCamera {
        center: Vec3::new(1.0, 2.0, 3.0),
        direction: Vec3::X * 2.0,
        up: Vec3::new(1.0, 1.0, 0.0),
        size: 5.0,
        ..OrthographicCamera::default()
    };
    let frame = CameraBasis::of(&camera, OURS);
    // The axes of the picture are right = x cross y = z, and up = y.
    let ray = camera.ray(&frame, &CameraSample::at(Vec2::new(1.0, -0.5))).unwrap();
    close(ray.origin, Vec3::new(1.0, 2.0 - 1.25, 3.0 + 2.5));
    close(ray.dir, Vec3::X);
    assert_eq!((ray.t_min, ray.t_max), (f32::NEG_INFINITY, f32::INFINITY));
}
