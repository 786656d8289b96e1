//! Comparisons with the official pictures in the folder that `DURER_CORPUS` names.

use super::*;
use crate::film::course::StoredSample;
use durer_scene::math::fp;
use durer_scene::sampler::Sampler;
use glam::{DVec2, DVec3};
use std::path::PathBuf;

/// Returns the size and the 8-bit pixels of an official picture, or `None` if the file is missing.
fn official(name: &str) -> Option<(u32, u32, Vec<[u8; 3]>)> {
    let root = std::env::var_os("DURER_CORPUS").map(PathBuf::from);
    let root = root.unwrap_or_else(|| PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared")));
    let path = root.join("course/reference/f04/f04-handout").join(name).with_extension("png");
    let Ok(picture) = image::open(&path) else {
        println!("skipped: no {}", path.display());
        return None;
    };
    let picture = picture.into_rgb8();
    Some((picture.width(), picture.height(), picture.pixels().map(|p| p.0).collect()))
}

/// Asserts the rule of the course for pictures that use no random numbers: at most one pixel in a
/// thousand may differ by more than 2/255.
fn assert_agrees(name: &str, width: u32, height: u32, pixels: &[Color]) {
    let Some((w, h, expected)) = official(name) else { return };
    assert_eq!((width, height), (w, h), "{name}");
    assert_few_differ(name, pixels, &expected);
}

fn assert_few_differ(name: &str, pixels: &[Color], expected: &[[u8; 3]]) {
    let byte = |c: f32| (c.clamp(0.0, 1.0) * 255.0) as u8;
    let differs = |(ours, theirs): (&Color, &[u8; 3])| {
        let worst = ours.to_array().iter().zip(theirs).map(|(&c, &t)| byte(c).abs_diff(t)).max();
        worst > Some(2)
    };
    let wrong = pixels.iter().zip(expected).filter(|&pair| differs(pair)).count();
    let inexact = pixels.iter().zip(expected).filter(|(c, t)| c.to_array().map(byte) != **t).count();
    println!("{name}: {wrong} of {} differ by more than 2/255, {inexact} at all", pixels.len());
    assert!(wrong * 1000 <= pixels.len(), "{name}: {wrong} of {}", pixels.len());
}

#[test]
fn filter_diagrams_match_the_official_ones() {
    use CourseFilter::{Box, Gaussian, Tent};
    for (name, size, zoom, kernel) in [
        ("filter7_01a_low_res", 12, 15, Box { radius: 0.5 }),
        ("filter7_01b", 9, 20, Tent { radius: 0.5 }),
        ("filter7_01c_low_res", 12, 15, Gaussian { sigma: 1.0 }),
        ("filter7_01d", 9, 20, Box { radius: 1.7 }),
        ("filter7_01e", 9, 20, Tent { radius: 1.7 }),
        ("filter7_01f", 9, 20, Gaussian { sigma: 1.7 }),
        ("filter7_01g", 9, 20, Box { radius: 2.3 }),
        ("filter7_01i", 9, 20, Gaussian { sigma: 2.3 }),
        ("filter7_02a", 9, 20, Box { radius: 0.5 }),
        ("filter7_02b", 9, 20, Tent { radius: 1.5 }),
        ("filter7_02c", 9, 20, Gaussian { sigma: 0.6 }),
    ] {
        let diagram = filter(size, size, zoom, kernel);
        assert_agrees(name, diagram.width, diagram.height, &diagram.pixels);
    }
}

/// Returns the colour at a point of the course's scene that shows a sphere in front of a triangle.
/// The scene is seen along -z, and the point is in world units.
fn sphere_and_triangle(p: Vec2) -> Color {
    // There is an ambient light of 0.5 and a light of 0.5 from above and in front.
    let shade = |n: Vec3| 0.5 + 0.5 * n.dot(Vec3::new(0.0, 1.0, 1.0).normalize()).max(0.0);
    let d = p - Vec2::ONE;
    if d.length_squared() < 1.0 {
        return Vec3::X * shade(d.extend((1.0 - d.length_squared()).sqrt()));
    }
    let corners = [Vec2::new(-2.0, -2.0), Vec2::new(1.8, -1.8), Vec2::new(-1.95, 1.95)];
    let inside = (0..3).all(|i| (corners[(i + 1) % 3] - corners[i]).perp_dot(p - corners[i]) >= 0.0);
    if inside { Vec3::Y * shade(Vec3::Z) } else { Vec3::Z }
}

/// Takes samples of that scene for a picture that is five units wide.
fn course_samples(size: u32, n: u32) -> StoredSamples {
    StoredSamples::take(size, size, n, |x, y, s| {
        let position = Sampler::Uniform.pixel_position(0, x, y, s, n);
        let in_picture = (Vec2::new(x as f32, y as f32) + position) / size as f32 - 0.5;
        StoredSample { position, color: sphere_and_triangle(5.0 * in_picture * Vec2::new(1.0, -1.0)) }
    })
}

#[test]
fn sample_diagrams_match_the_official_ones() {
    for (name, size, zoom, n) in
        [("samples7_01b", 9, 20, 4), ("samples7_01b_low_res", 12, 15, 9), ("samples7_01e", 9, 20, 9)]
    {
        let diagram = samples(&course_samples(size, n), zoom);
        assert_agrees(name, diagram.width, diagram.height, &diagram.pixels);
    }
}

#[test]
fn filtered_pictures_match_the_official_ones() {
    let samples = course_samples(12, 9);
    for (name, filter) in [
        ("output7_01d_low_res", CourseFilter::Box { radius: 0.5 }),
        ("output7_01e_low_res", CourseFilter::Tent { radius: 1.5 }),
        ("output7_01f_low_res", CourseFilter::Gaussian { sigma: 1.0 }),
    ] {
        assert_agrees(name, 12, 12, &samples.reconstruct(filter));
    }
}

/// Returns the colour of the course's scene that shows a checkerboard at height 0.01 with squares
/// of size 0.1. The coordinates of the point in the picture are from -1 to 1.
///
/// The colour is computed in double precision, because single precision hits different squares near
/// the horizon.
fn chessboard(p: DVec2) -> Color {
    let forward = DVec3::new(0.338670, -0.392536, -0.855113).normalize();
    let right = forward.cross(DVec3::Y).normalize();
    let dir = forward + fp::tan_f64(25_f64.to_radians()) * (p.x * right + p.y * right.cross(forward));
    let center = DVec3::new(-0.841950, 0.943160, 2.014966);
    let hit = center + (0.01 - center.y) / dir.y * dir;
    // The official triangles extend beyond their edges by 1e-5 of the length of their legs, which
    // is 501.
    let beyond = 0.00501;
    if dir.y >= 0.0 || hit.x < -0.99 - beyond || hit.z > 0.99 + beyond || hit.z < -500.0 || hit.x > 500.0 {
        return Vec3::Y;
    }
    let field = (10.0 * hit.x).floor() + (10.0 * hit.z).floor();
    (0.2 + 0.9) * if field.rem_euclid(2.0) == 0.0 { Vec3::X } else { Vec3::Z }
}

#[test]
fn filtered_chessboard_matches_the_official_one() {
    let samples = StoredSamples::take(180, 180, 16, |x, y, s| {
        let position = Sampler::Uniform.pixel_position(0, x, y, s, 16);
        let in_picture = (DVec2::new(x.into(), y.into()) + position.as_dvec2()) / 90.0 - 1.0;
        // Colours above 1 are clamped after filtering, when the picture is written.
        StoredSample { position, color: chessboard(in_picture * DVec2::new(1.0, -1.0)) }
    });
    let picture = samples.reconstruct(CourseFilter::Tent { radius: 1.5 });
    // Farther up in the picture, squares are smaller than a pixel, and the last bit of a hit
    // determines the colour.
    const NEAR: usize = 45;
    let Some((180, 180, expected)) = official("output7_02e") else { return };
    assert_few_differ("output7_02e", &picture[NEAR * 180..], &expected[NEAR * 180..]);
}

#[test]
fn degenerate_sizes_give_pictures() {
    assert_eq!(filter(0, 0, 0, CourseFilter::Tent { radius: 0.0 }).pixels.len(), 1);
    assert!(samples(&course_samples(0, 1), 5).pixels.is_empty());
    // Positions on the edge of a pixel must not leave the pixel.
    let corner = |p: f32| StoredSample { position: Vec2::splat(p), color: Vec3::ONE };
    for (p, place) in [(0.0, 0), (1.0 - f32::EPSILON * 0.5, 8)] {
        let diagram = samples(&StoredSamples::take(1, 1, 1, |_, _, _| corner(p)), 3);
        assert_eq!(diagram.pixels[place], Vec3::ONE);
    }
}
