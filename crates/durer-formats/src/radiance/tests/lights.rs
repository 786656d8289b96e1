//! Tests of lights that have a directional distribution.

use super::*;
use crate::asset_export::export_assets;
use crate::folder::FolderSource;
use crate::photometry;
use durer_scene::light::{Illuminate, Light};
use durer_scene::math::fp;
use glam::DVec3;
use std::f64::consts::PI;

/// Returns the sum of the intensities (radiance times area) of all lights in a scene for a given
/// direction.
fn intensity(scene: &Scene, dir: DVec3) -> f64 {
    let lights = scene.lights.as_ref().unwrap().iter();
    let strong = lights.map(|light| {
        let Light::Photometric(emitter) = &light.value else { panic!("{light:?}") };
        let profile = &scene.assets.profiles[&emitter.file.path];
        f64::from(profile.at(emitter.to_profile(dir.as_vec3()))) * f64::from(emitter.color.x)
    });
    strong.sum()
}

/// Returns the direction for an angle from the downward direction and an angle around the vertical
/// axis.
fn direction(theta: f64, phi: f64) -> DVec3 {
    let [(sin, cos), (s, c)] = [theta, phi].map(fp::sin_cos_degrees);
    DVec3::new(sin * c, sin * s, -cos)
}

fn cos(degrees: f64) -> f64 {
    fp::sin_cos_degrees(degrees).1
}

fn sin(degrees: f64) -> f64 {
    fp::sin_cos_degrees(degrees).0
}

/// Data file that contains a table over two angles. One angle ranges from 0 to 180 degrees around
/// the axis, and the other one from 0 to 180 degrees measured from the downward direction.
fn by_two() -> String {
    let values =
        (0..=18).flat_map(|i| (0..=36).map(move |j| (1.0 + 0.1 * f64::from(i) + 0.2 * f64::from(j)).to_string()));
    format!("2 0 180 19 0 180 37 {}", values.collect::<Vec<_>>().join(" "))
}

/// Returns the value of that table, which is linear in both angles.
fn of_two(theta: f64, phi: f64) -> f64 {
    let folded = if phi > 180.0 { 360.0 - phi } else { phi };
    1.0 + 0.01 * folded + 0.04 * theta
}

type Expected = Box<dyn Fn(f64, f64) -> f64>;

#[test]
fn intensity_follows_the_table() {
    let cosines: Vec<String> = (0..=90).map(|i| cos(f64::from(i)).to_string()).collect();
    let files = folder(&[
        ("a.dat", format!("1 0 90 91 {}", cosines.join(" ")).as_bytes()),
        ("b.dat", by_two().as_bytes()),
        ("one.dat", b"1 0 180 2 1 1"),
        ("back.dat", b"1 180 0 3 0 1 4"),
    ]);
    let down = |theta: f64| if theta < 90.0 { cos(theta) } else { 0.0 };
    let cases: [(&str, Expected); 11] = [
        // The expected intensity is a radiance of 3, times 2, times the value of the table, divided
        // by the cosine, times an area of pi or 4.
        (
            "void brightdata d 4 flatcorr a.dat source.cal src_theta 0 1 2 d light l 0 0 3 3 3 3 l ring r 0 0 8 0 0 1 0 0 -1 0 1",
            Box::new(move |theta, _| 6.0 * PI * down(theta)),
        ),
        (
            "void brightdata d 4 corr a.dat source.cal src_theta 0 1 2 d light l 0 0 3 3 3 3 l ring r 0 0 8 0 0 1 0 0 -1 0 1",
            Box::new(move |theta, _| 6.0 * PI * down(theta) * down(theta)),
        ),
        (
            "void brightdata d 5 flatcorr b.dat source.cal src_phi2 src_theta 0 0 d glow l 0 0 4 1 1 1 0
             l polygon r 0 0 12 -1 -1 0 -1 1 0 1 1 0 1 -1 0",
            Box::new(|theta, phi| if theta < 90.0 { 4.0 * of_two(theta, phi) } else { 0.0 }),
        ),
        // The projected area of a sphere is that of a disc in every direction. The projected area
        // of a tube is that of its side.
        (
            "void brightdata d 5 corr b.dat source.cal src_phi2 src_theta 0 0 d light l 0 0 3 1 1 1 l sphere r 0 0 4 1 2 3 2",
            Box::new(|theta, phi| 4.0 * PI * of_two(theta, phi)),
        ),
        (
            "void brightdata d 5 corr b.dat source.cal src_phi2 src_theta 0 0 d light l 0 0 3 1 1 1 l cylinder r 0 0 7 0 0 1 0 0 4 .5",
            Box::new(|theta, phi| 3.0 * sin(theta) * of_two(theta, phi)),
        ),
        // The value in the table is the intensity of the whole box or cylinder.
        (
            "void brightdata d 5 boxcorr b.dat source.cal src_phi2 src_theta 0 4 1 2 4 1 d light l 0 0 3 1 1 1 !genbox l r 2 4 1",
            Box::new(of_two),
        ),
        (
            "void brightdata d 5 cylcorr b.dat source.cal src_phi2 src_theta 0 3 1 2 3 d light l 0 0 3 1 1 1
             l cylinder r 0 0 7 0 0 0 0 0 3 1 l ring t 0 0 8 0 0 3 0 0 1 0 1 l ring u 0 0 8 0 0 0 0 0 -1 0 1",
            Box::new(of_two),
        ),
        // The light is rotated by a right angle around z, and turned upside down. The rotation is
        // given by a command and by explicit options.
        (
            "!xform -rz 90 lamp.rad", // prose: keep
            Box::new(
                |theta, phi| if theta < 90.0 { 4.0 * of_two(theta, (phi + 270.0).rem_euclid(360.0)) } else { 0.0 },
            ),
        ),
        (
            "void brightdata d 6 corr back.dat source.cal src_theta -rx 180 0 0 d light l 0 0 3 1 1 1 l sphere r 0 0 4 1 2 3 1",
            // The values are 4 from below, 1 at the side and 0 from above, and the light is upside
            // down.
            Box::new(|theta, _| PI * if theta > 90.0 { 4.0 - 3.0 * (180.0 - theta) / 90.0 } else { theta / 90.0 }),
        ),
        // The table contains only ones. The coordinate of the table is one of the angles of a type
        // B photometer.
        (
            "void brightdata d 4 corr one.dat source.cal srcB_vert2 0 0 d light l 0 0 3 1 1 1 l sphere r 0 0 4 1 2 3 1",
            Box::new(|_, _| PI),
        ),
        // The cone of the spotlight has a total angle of 60 degrees, and the expected value follows
        // from its cosine.
        (
            "void spotlight s 0 0 7 2 2 2 60 0 0 -1 s ring r 0 0 8 0 0 1 0 0 -1 0 1",
            Box::new(|theta, _| if theta <= 30.0 { 2.0 * PI * cos(theta) } else { 0.0 }),
        ),
    ];
    let light = "void brightdata d 5 flatcorr b.dat source.cal src_phi2 src_theta 0 0 d glow l 0 0 4 1 1 1 0
        l polygon r 0 0 12 -1 -1 0 -1 1 0 1 1 0 1 -1 0";
    std::fs::write(files.path().join("lamp.rad"), light).unwrap(); // prose: keep
    for (text, expected) in cases {
        let (scene, messages) = read_in(files.path(), "scene.rad", text);
        let what = "an emitter with a directional distribution becomes point lights and is not visible";
        assert!(messages.len() == 1 && messages[0].ends_with(what), "{text}: {messages:?}"); // prose: keep
        let scene = scene.unwrap();
        for (theta, phi) in
            [(1.0, 0.0), (5.0, 40.0), (29.0, 211.0), (31.0, 80.0), (62.0, 133.0), (115.0, 301.0), (170.0, 3.0)]
        {
            let (found, wanted) = (intensity(&scene, direction(theta, phi)), expected(theta, phi));
            assert!((found - wanted).abs() < 2e-3 * wanted.max(1.0), "{text} at {theta} {phi}: {found}, not {wanted}");
        }
    }
}

#[test]
fn equal_distributions_share_a_profile_and_are_exported() {
    let files = folder(&[("b.dat", by_two().as_bytes())]);
    let light = "void brightdata d 5 flatcorr b.dat source.cal src_phi2 src_theta 0 0 d light l 0 0 3 1 1 1
        l polygon r 0 0 12 -1 -1 0 -1 1 0 1 1 0 1 -1 0";
    std::fs::write(files.path().join("lamp.rad"), light).unwrap(); // prose: keep
    let text = format!("{light} l polygon q 0 0 12 -1 -1 2 -1 1 2 1 1 2 1 -1 2 !xform -t 5 0 0 lamp.rad"); // prose: keep
    let (scene, _) = read_in(files.path(), "scene.rad", &text);
    let scene = scene.unwrap();
    // The last text is different from the others.
    assert_eq!((scene.assets.profiles.len(), scene.lights.as_ref().unwrap().len()), (2, 48));
    let (made, beside) = export_assets(&scene, "kept", &FolderSource::new(files.path()));
    let names: Vec<&str> = beside.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["kept/lamp-1.ies", "kept/lamp-2.ies"]);
    assert!(made.assets.is_empty());
    let Light::Photometric(first) = &made.lights.as_ref().unwrap()[0].value else { panic!("not a photometric light") };
    assert_eq!(first.file.path, "kept/lamp-1.ies");
    let read = photometry::read(&beside[0].1, 0, &mut durer_diag::Diagnostics::default());
    assert_eq!(read.as_ref(), Some(&*scene.assets.profiles["lamp-1.ies"]));
}

#[test]
fn points_of_an_emitter_are_centred() {
    let files = folder(&[("one.dat", b"1 0 180 2 1 1")]);
    let emitter = "void brightdata d 4 corr one.dat source.cal src_theta 0 0 d light l 0 0 3 1 1 1\n";
    for (surface, middle) in [
        ("l polygon r 0 0 12 -.6 -.3 2 -.6 .3 2 .6 .3 2 .6 -.3 2", DVec3::new(0.0, 0.0, 2.0)),
        ("l polygon r 0 0 9 0 0 0 3 0 0 0 6 0", DVec3::new(1.0, 2.0, 0.0)),
        ("l ring r 0 0 8 1 2 3 0 0 1 0 1", DVec3::new(1.0, 2.0, 3.0)),
        ("l cylinder r 0 0 7 1 2 3 1 2 5 .1", DVec3::new(1.0, 2.0, 4.0)),
    ] {
        let (scene, _) = read_in(files.path(), "scene.rad", &format!("{emitter}{surface}"));
        let lights = scene.unwrap().lights.unwrap();
        let places = lights.iter().map(|light| {
            let Light::Photometric(emitter) = &light.value else { panic!("{light:?}") };
            emitter.position.as_dvec3()
        });
        let mean = places.sum::<DVec3>() / lights.len() as f64;
        assert!(lights.len() == 16 && (mean - middle).length() < 1e-6, "{surface}: {mean}");
    }
}

#[test]
fn angles_may_have_an_offset() {
    // The angles range from 90 to 270 degrees, as in files that `ies2rad` writes.
    let files = folder(&[("b.dat", by_two().as_bytes())]);
    let text = "void brightdata d 7 flatcorr b.dat source.cal src_phi2+20 src_theta -rz -90 0 0 d light l 0 0 3 1 1 1
        l polygon r 0 0 12 -1 -1 0 -1 1 0 1 1 0 1 -1 0";
    let (scene, _) = read_in(files.path(), "scene.rad", text);
    let scene = scene.unwrap();
    for (theta, phi) in [(30.0, 0.0), (30.0, 200.0)] {
        // The rotation turns the light back by a right angle, so the angle in its table is larger
        // by a right angle.
        let around: f64 = (phi + 90.0_f64).rem_euclid(360.0);
        let folded = if around > 180.0 { 360.0 - around } else { around };
        let expected = 4.0 * (1.0 + 0.01 * (folded + 20.0) + 0.04 * theta);
        let found = intensity(&scene, direction(theta, phi));
        assert!((found / expected - 1.0).abs() < 2e-3, "{theta} {phi}: {found}, not {expected}");
    }
}

#[test]
fn number_of_profiles_is_limited() {
    let files = folder(&[("one.dat", b"1 0 180 2 1 1")]);
    let mut text = "void brightdata d 4 corr one.dat source.cal src_theta 0 0 d light l 0 0 3 1 1 1".to_string();
    for i in 0..300 {
        text += &format!(" l ring r{i} 0 0 8 0 0 0 1 {i} -5 0 1");
    }
    let (scene, messages) = read_in(files.path(), "scene.rad", &text);
    assert_eq!(scene.unwrap().assets.profiles.len(), 256);
    assert!(messages.iter().any(|line| line.contains("more than 256 directional distributions")), "{messages:?}");
}

#[test]
fn tables_of_other_functions_are_replaced_by_their_mean() {
    let files = folder(&[("one.dat", b"1 0 180 2 1 2")]);
    for (text, what) in [
        ("4 mine one.dat source.cal src_theta", "data patterns have no counterpart: the mean is used"),
        ("4 corr one.dat my.cal angle", "data patterns have no counterpart: the mean is used"),
        ("5 corr one.dat source.cal src_phi src_theta", "data patterns have no counterpart: the mean is used"),
    ] {
        let text = format!("void brightdata d {text} 0 0 d light l 0 0 3 3 3 3 l sphere r 0 0 4 1 2 3 1");
        let (scene, messages) = read_in(files.path(), "scene.rad", &text);
        assert!(messages.iter().any(|line| line.ends_with(what)), "{text}: {messages:?}"); // prose: keep
        assert_eq!(layers(&scene.unwrap(), 0).emission_luminance, 4.5);
    }
}
