use super::*;
use durer::LoadOptions;
use durer::load_text;
use durer_diag::{Diagnostics, Files};
use durer_render::integrator::{Integrate, Path as Paths, PathOptions, RenderSettings};
use durer_render::render::Job;
use durer_scene::camera::{CameraBasis, CameraRules, CameraSample, Projection};
use durer_scene::math::{Vec2, fp};
use durer_scene::sampler::SampleId;
use std::f64::consts::PI;

/// Estimates the irradiance divided by pi at a point with a normal, which is the radiance that a
/// white diffuse surface reflects.
fn shown(text: &str, point: Vec3, normal: Vec3) -> Vec3 {
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let options = LoadOptions::default();
    let loaded = load_text(Path::new("a.rad"), text.as_bytes().into(), &options, &mut files, &mut diagnostics);
    let world = loaded.and_then(|loaded| loaded.compile(&options, &mut files, &mut diagnostics));
    let world = world.unwrap_or_else(|| panic!("{:?}", diagnostics.iter().collect::<Vec<_>>()));
    let settings = RenderSettings { bounces: 0, ..Job::default().settings };
    let paths =
        Paths { world: &world, settings, options: PathOptions::default(), photons: None, cone: None, cancel: None };
    const SAMPLES: u32 = 256;
    let sum: glam::DVec3 = (0..SAMPLES)
        .map(|i| paths.irradiance(point.as_dvec3(), normal, SampleId::new(0, (0, 0), i), &mut ()).as_dvec3())
        .sum();
    (sum / f64::from(SAMPLES) / PI).as_vec3()
}

/// Compares the irradiance divided by pi with an analytic result. Scenes that contain emitters have
/// no default lighting, so all light comes from the text.
fn lit(text: &str, point: Vec3, normal: Vec3, expected: f64) {
    let found = f64::from(shown(text, point, normal).x);
    assert!((found / expected - 1.0).abs() < 0.02, "{text}: {found}, not {expected}");
}

#[test]
fn emitters_have_the_given_radiance() {
    let light = "void light l 0 0 3 8 8 8\n";
    // The expected value for a sphere is L (r / d)².
    lit(&format!("{light}l sphere s 0 0 4 0 0 5 1"), Vec3::ZERO, Vec3::Z, 8.0 / 25.0);
    // The expected value for a disc that faces down is L r² / (r² + d²). A disc that faces up
    // contributes nothing.
    lit(&format!("{light}l ring s 0 0 8 0 0 2 0 0 -1 0 1"), Vec3::ZERO, Vec3::Z, 8.0 / 5.0);
    assert_eq!(shown(&format!("{light}l ring s 0 0 8 0 0 2 0 0 1 0 1"), Vec3::ZERO, Vec3::Z), Vec3::ZERO);
    // A polygon emits light on the side from which its corners are in counter-clockwise order.
    let square = "l polygon s 0 0 12 -1 -1 1 -1 1 1 1 1 1 1 -1 1";
    let (a, b) = (1.0 / 2f64.sqrt(), 1.0 / 2f64.sqrt());
    let factor = 4.0 * 2.0 / (2.0 * PI) * a * fp::atan_f64(b);
    lit(&format!("{light}{square}"), Vec3::ZERO, Vec3::Z, 8.0 * factor);
    let turned = "l polygon s 0 0 9 0 0 1 1 0 1 0 1 1";
    assert_eq!(shown(&format!("{light}{turned}"), Vec3::ZERO, Vec3::Z), Vec3::ZERO);
    // The expected value for the sun is its radiance times its solid angle, divided by pi. The
    // expected value for a sky that covers the whole sphere is its radiance.
    lit("void light l 0 0 3 1e5 1e5 1e5\nl source s 0 0 4 0 0 1 .5", Vec3::ZERO, Vec3::Z, {
        let (sin, _) = fp::sin_cos_degrees(0.125);
        1e5 * 4.0 * sin * sin
    });
    lit("void glow l 0 0 4 2 2 2 0\nl source s 0 0 4 0 0 1 180\n", Vec3::ZERO, Vec3::Z, 2.0);
    // The expected value for an overcast sky is 7/9 of the radiance of its zenith.
    let overcast =
        "void brightfunc f 2 skybr skybright.cal 0 3 2 9 0\nf glow g 0 0 4 1 1 1 0\ng source s 0 0 4 0 0 1 180";
    let found = f64::from(shown(overcast, Vec3::ZERO, Vec3::Z).x);
    assert!((found / 7.0 - 1.0).abs() < 0.03, "{found}");
    // On its axis, the expected value for a spotlight is L A / d² divided by pi. The distance d is
    // measured from the focus of the spotlight, which is 2 units behind it. The expected value is
    // zero outside the cone.
    let spot = "void spotlight l 0 0 7 6 6 6 30 0 0 -2\nl ring r 0 0 8 0 0 3 0 0 -1 0 .1";
    lit(spot, Vec3::ZERO, Vec3::Z, 6.0 * 0.01 / 25.0);
    assert_eq!(shown(spot, Vec3::new(1.0, 0.0, 0.0), Vec3::Z), Vec3::ZERO);
}

/// Returns the view direction at a position in the picture, where coordinates range from -1 to 1
/// across the larger side.
fn sees(options: &str, x: f32, y: f32) -> Vec3 {
    let files = folder(&[("s.rad", b"void plastic w 0 0 5 1 1 1 0 0 w sphere s 0 0 4 0 0 0 1")]);
    let (scene, messages) = read_in(files.path(), "x.rif", &format!("scene = s.rad\nview = {options}\n"));
    let scene = scene.unwrap_or_else(|| panic!("{messages:?}"));
    let camera = scene.camera.as_ref().unwrap();
    let frame = CameraBasis::of(camera, CameraRules::default());
    let sample = CameraSample { lens: Vec2::splat(0.5), ..CameraSample::at(Vec2::new(x, y)) };
    camera.ray(&frame, &sample).unwrap().dir.normalize()
}

#[test]
fn views_match_radiance() {
    let close = |a: Vec3, b: Vec3| assert!((a - b).length() < 1e-5, "{a} is not {b}");
    // In the default view, x points to the right and z points upwards.
    close(sees("-vh 90 -vv 90", 1.0, 0.0), Vec3::new(1.0, 1.0, 0.0).normalize());
    close(sees("-vh 90 -vv 90", 0.0, 1.0), Vec3::new(0.0, 1.0, 1.0).normalize());
    // Parallel views show everything in front of the view point, or beyond the distance `-vo`.
    for (options, near) in [("-vtl -vp 1 2 3 -vh 4 -vv 4", 0.0), ("-vtl -vo -2.5 -vh 4 -vv 4", -2.5)] {
        let files = folder(&[("s.rad", b"void plastic w 0 0 5 1 1 1 0 0 w sphere s 0 0 4 0 0 0 1")]);
        let (scene, messages) = read_in(files.path(), "x.rif", &format!("scene = s.rad\nview = {options}\n"));
        let Some(durer_scene::camera::Camera::Orthographic(camera)) = scene.unwrap().camera else {
            panic!("{messages:?}")
        };
        assert_eq!(camera.near, Some(near));
        let frame = CameraBasis::of(&camera, CameraRules::default());
        assert_eq!(camera.ray(&frame, &CameraSample::at(Vec2::ZERO)).unwrap().t_min, near);
    }
    // If a picture is taller than it is wide, its height covers 90 degrees.
    close(sees("-vh 53.130102 -vv 90", 0.5, 0.0), Vec3::new(0.5, 1.0, 0.0).normalize());
    // The view is shifted to the right by half its width, so its centre is where its edge was.
    close(sees("-vh 90 -vv 90 -vs .5", 0.0, 0.0), Vec3::new(1.0, 1.0, 0.0).normalize());
    close(sees("-vta -vh 180 -vv 180", 0.5, 0.0), Vec3::new(1.0, 1.0, 0.0).normalize());
    close(sees("-vth -vh 180 -vv 180", 0.6, 0.0), Vec3::new(0.6, 0.8, 0.0));
    close(sees("-vts -vh 180 -vv 180", 0.5, 0.0), Vec3::new(0.8, 0.6, 0.0));
    close(sees("-vtc -vh 180 -vv 90", 0.5, 0.0), Vec3::new(1.0, 1.0, 0.0).normalize());
}

#[test]
fn tessellated_cone_has_uniform_irradiance() {
    // When a cone is lit from above, the irradiance of its side must not depend on its tessellation
    // into triangles with interpolated normals.
    let text = "void plastic w 0 0 5 .5 .5 .5 0 0\nvoid light l 0 0 3 9 9 9\nw cone c 0 0 8 0 0 0 0 0 .5 1 .1\n\
                l polygon p 0 0 12 -1 -1 2 -1 1 2 1 1 2 1 -1 2";
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let options = LoadOptions::default();
    let loaded = load_text(Path::new("a.rad"), text.as_bytes().into(), &options, &mut files, &mut diagnostics).unwrap();
    let world = loaded.compile(&options, &mut files, &mut diagnostics).unwrap();
    let settings = RenderSettings { bounces: 0, ..Job::default().settings };
    let paths =
        Paths { world: &world, settings, options: PathOptions::default(), photons: None, cone: None, cancel: None };
    let mut dark = 0;
    for i in 0..256 {
        let (sin, cos) = fp::sin_cos_degrees(f64::from(i) * 1.40625 + 0.3);
        let ray = durer_scene::math::Ray::new(Vec3::new(0.6 * cos as f32, 0.6 * sin as f32, 1.5), Vec3::NEG_Z);
        dark += u32::from(paths.radiance(&ray, SampleId::new(0, (0, 0), i), &mut ()).x == 0.0);
    }
    assert_eq!(dark, 0);
}
