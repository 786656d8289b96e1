//! Lookups in small pictures whose answers are known.

use super::*;
use crate::math::Vec3;

/// Two by two: red and green above, blue and white below.
fn four() -> Texture {
    Texture::new(2, 2, vec![[255, 0, 0], [0, 255, 0], [0, 0, 255], [255; 3]]).unwrap()
}

#[test]
fn texels_are_exact_at_their_corners_and_mixed_between() {
    let at = |u: f32, v: f32| four().at(Vec2::new(u, v));
    // The first row is on top: v = 1. No half-texel shift: texel (i, j) is at (i / 2, 1 - j / 2).
    assert_eq!(at(0.0, 1.0), Vec3::X);
    assert_eq!(at(0.5, 1.0), Vec3::Y);
    assert_eq!(at(0.0, 0.5), Vec3::Z);
    assert_eq!(at(0.5, 0.5), Vec3::ONE);
    assert_eq!(at(0.25, 1.0), Vec3::new(0.5, 0.5, 0.0));
    assert_eq!(at(0.0, 0.75), Vec3::new(0.5, 0.0, 0.5));
    assert_eq!(at(0.25, 0.75), Vec3::splat(0.5));
    // Past the last texel there is no other.
    assert_eq!(at(0.75, 0.25), Vec3::ONE);
}

#[test]
fn lookups_beyond_the_border_give_the_border() {
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
fn a_texture_has_as_many_texels_as_it_says() {
    assert!(Texture::new(0, 0, Vec::new()).is_none());
    assert!(Texture::new(2, 2, vec![[0; 3]; 3]).is_none());
    assert!(Texture::new(u32::MAX, u32::MAX, vec![[0; 3]; 1]).is_none());
}

#[test]
fn directions_see_the_face_that_they_point_to() {
    // One colour a face, from the order of the names.
    let face = |i: u8| Texture::new(1, 1, vec![[i * 10; 3]]).unwrap();
    let map = CubeMap { faces: std::array::from_fn(|i| face(i as u8)) };
    let seen = |d: Vec3| CubeMap::FACES[(map.at(d).x * 25.5).round() as usize];
    for (direction, name) in [
        (Vec3::NEG_X, "left"),
        (Vec3::X, "right"),
        (Vec3::Y, "up"),
        (Vec3::NEG_Y, "down"),
        (Vec3::Z, "front"),
        (Vec3::NEG_Z, "back"),
    ] {
        assert_eq!(seen(direction), name);
        assert_eq!(seen(3.0 * direction + Vec3::splat(0.9)), name);
    }
    assert_eq!(seen(Vec3::ONE), "right");
    assert_eq!(seen(Vec3::new(0.0, -1.0, 1.0)), "down");
    assert!(map.at(Vec3::ZERO).is_finite() && map.at(Vec3::NAN).is_finite());
}
