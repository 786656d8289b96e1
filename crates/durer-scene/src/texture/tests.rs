//! Tests for lookups in small textures with known results.

use super::*;
use crate::math::Vec3;

/// Texture of two by two texels, with red and green above and blue and white below.
fn four() -> Texture {
    Texture::new(2, 2, vec![[255, 0, 0], [0, 255, 0], [0, 0, 255], [255; 3]]).unwrap()
}

#[test]
fn texels_are_exact_at_their_corners_and_interpolated_between() {
    let at = |u: f32, v: f32| four().at(Vec2::new(u, v));
    // The first row is at the top, where v = 1. Texel (i, j) is at (i / 2, 1 - j / 2), without a
    // half-texel shift.
    assert_eq!(at(0.0, 1.0), Vec3::X);
    assert_eq!(at(0.5, 1.0), Vec3::Y);
    assert_eq!(at(0.0, 0.5), Vec3::Z);
    assert_eq!(at(0.5, 0.5), Vec3::ONE);
    assert_eq!(at(0.25, 1.0), Vec3::new(0.5, 0.5, 0.0));
    assert_eq!(at(0.0, 0.75), Vec3::new(0.5, 0.0, 0.5));
    assert_eq!(at(0.25, 0.75), Vec3::splat(0.5));
    // Coordinates are clamped at the last texel.
    assert_eq!(at(0.75, 0.25), Vec3::ONE);
}

#[test]
fn lookups_clamp_at_the_border() {
    let at = |u: f32, v: f32| four().at(Vec2::new(u, v));
    assert_eq!(at(-0.25, 1.0), Vec3::X);
    assert_eq!(at(-7.0, 9.0), Vec3::X);
    assert_eq!(at(7.0, 9.0), Vec3::Y);
    assert_eq!(at(-7.0, -9.0), Vec3::Z);
    assert_eq!(at(1e38, -1e38), Vec3::ONE);
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN] {
        for uv in [Vec2::new(bad, 0.5), Vec2::new(0.5, bad), Vec2::splat(bad)] {
            assert!(four().at(uv).is_finite(), "{uv}");
        }
    }
}

#[test]
fn texture_needs_width_times_height_texels() {
    assert!(Texture::new(0, 0, Vec::new()).is_none());
    assert!(Texture::new(2, 2, vec![[0; 3]; 3]).is_none());
    assert!(Texture::new(u32::MAX, u32::MAX, vec![[0; 3]; 1]).is_none());
}

#[test]
fn cube_map_directions_select_their_face() {
    // Use one colour for each face, in the order of the face names.
    let face = |i: u8| Texture::new(1, 1, vec![[i * 10; 3]]).unwrap();
    let map = CubeMap { faces: std::array::from_fn(|i| face(i as u8)), mirrored_back: false };
    let faces = |d: Vec3| CubeMap::FACES[(map.at(d).x * 25.5).round() as usize];
    for (direction, name) in [
        (Vec3::NEG_X, "left"),
        (Vec3::X, "right"),
        (Vec3::Y, "up"),
        (Vec3::NEG_Y, "down"),
        (Vec3::Z, "front"),
        (Vec3::NEG_Z, "back"),
    ] {
        assert_eq!(faces(direction), name);
        assert_eq!(faces(3.0 * direction + Vec3::splat(0.9)), name);
    }
    assert_eq!(faces(Vec3::ONE), "right");
    assert_eq!(faces(Vec3::new(0.0, -1.0, 1.0)), "down");
    assert!(map.at(Vec3::ZERO).is_finite() && map.at(Vec3::NAN).is_finite());
}

/// Letter on each face, in the order of the face names. None of the letters is symmetric.
const LETTERS: [[&str; 5]; 6] = [
    ["###  ", "#  # ", "###  ", "# #  ", "#  ##"],
    ["#    ", "#    ", "#    ", "#    ", "#### "],
    [" ####", "#    ", "# ###", "#   #", " ### "],
    ["#####", "#    ", "###  ", "#    ", "#    "],
    ["#### ", "#   #", "#### ", "#    ", "#    "],
    ["  ###", "   # ", "   # ", "#  # ", " ##  "],
];

/// The faces are seen from the centre of the cube. The course's images of a church match at their
/// edges this way. Its programs mirror `back`, as shown by more than half of the pixels in their
/// renderings of the rabbit in the church.
#[test]
fn faces_are_upright_and_the_course_mirrors_two() {
    let face = |rows: &[&str; 5]| {
        let texels = rows.iter().flat_map(|row| row.bytes()).map(|b| [if b == b'#' { 255 } else { 0 }; 3]);
        Texture::new(5, 5, texels.collect()).unwrap()
    };
    let right = CubeMap { faces: std::array::from_fn(|i| face(&LETTERS[i])), mirrored_back: false };
    let old = CubeMap { mirrored_back: true, ..right.clone() };
    let flipped = |rows: [&str; 5]| -> Vec<String> { rows.iter().rev().map(|row| row.to_string()).collect() };
    let mirrored = |rows: [&str; 5]| -> Vec<String> { rows.iter().map(|row| row.chars().rev().collect()).collect() };
    let (x, y, z) = (Vec3::X, Vec3::Y, Vec3::Z);
    for (i, (forward, up)) in [(-x, y), (x, y), (y, z), (-y, -z), (z, y), (-z, y)].into_iter().enumerate() {
        let side = forward.cross(up);
        let faces = |map: &CubeMap, mirror: bool, flip: bool| -> Vec<String> {
            let cell = |i: usize| (2.0 * i as f32 + 1.0) / 5.0 - 1.0;
            // Texels are exact at their corners, so look up each texel just inside its corner.
            let shift = |turned: bool| if turned { 0.999 / 5.0 } else { -0.999 / 5.0 };
            let pixel = |row: usize, column: usize| {
                let (u, v) = (cell(column) + shift(mirror), -cell(row) - shift(flip));
                if map.at(forward + u * side + v * up).x > 0.5 { '#' } else { ' ' }
            };
            (0..5).map(|row| (0..5).map(|column| pixel(row, column)).collect()).collect()
        };
        let written: Vec<String> = LETTERS[i].iter().map(|row| row.to_string()).collect();
        assert_eq!(faces(&right, false, false), written, "{}", CubeMap::FACES[i]);
        let (is_down, is_back) = (CubeMap::FACES[i] == "down", CubeMap::FACES[i] == "back");
        let expected = if is_down { flipped(LETTERS[i]) } else { written };
        let expected = if is_back { mirrored(LETTERS[i]) } else { expected };
        assert_eq!(faces(&old, is_back, is_down), expected, "{} of the course", CubeMap::FACES[i]);
    }
}

#[test]
fn float_texels_keep_their_values() {
    let texels = vec![Vec3::new(2.0, 0.1, -1.0), Vec3::ZERO];
    let texture = Texture::from_floats(2, 1, texels.clone()).unwrap().with_opacity(vec![0.25, 1.0]);
    let mapping = Mapping { nearest: true, ..Mapping::default() };
    assert_eq!(texture.texel(&mapping, Vec2::new(0.25, 0.5), 0.0), [2.0, 0.1, -1.0, 0.25]);
    // Texels stored as floats have no decoding curve. With their opacity, they take 16 bytes each.
    assert_eq!(texture.clone().with_decoding(|_| 0.5), texture);
    assert!(texture.bytes() == 32 && texture.has_alpha() && !texture.is_flat());
    assert!(Texture::from_floats(1, 1, texels).is_none());
}

#[test]
fn exact_slopes_are_derivatives_of_the_interpolated_values() {
    let texel = |i: u32| [(i * 97 % 251) as u8, 0, 0];
    let texture = Texture::new(5, 4, (0..20).map(texel).collect()).unwrap();
    let mapping = Mapping { transform: [[1.5, 0.4, 0.1], [-0.3, 0.8, 0.2]], ..Mapping::default() };
    for i in 0..200 {
        let uv = Vec2::new((i as f32 * 0.37).fract(), (i as f32 * 0.61).fract());
        let value = |x: f32, y: f32| texture.texel(&mapping, uv + Vec2::new(x, y), 0.0)[0];
        let step = 1e-3;
        let expected =
            Vec2::new(value(step, 0.0) - value(-step, 0.0), value(0.0, step) - value(0.0, -step)) / (2.0 * step);
        // Skip steps that cross the centre of a texel, where the derivative jumps.
        let cell = |uv: Vec2| (mapping.texture_position(uv) * Vec2::new(5.0, 4.0) - 0.5).floor();
        let corners = [(step, step), (step, -step), (-step, step), (-step, -step)];
        if corners.iter().any(|&(x, y)| cell(uv + Vec2::new(x, y)) != cell(uv)) {
            continue;
        }
        let slope = texture.exact_slope(&mapping, uv);
        assert!((slope - expected).length() < 2e-3 * (1.0 + expected.length()), "{uv}: {slope} and not {expected}");
    }
    assert_eq!(texture.exact_slope(&Mapping { nearest: true, ..mapping }, Vec2::splat(0.3)), Vec2::ZERO);
}
