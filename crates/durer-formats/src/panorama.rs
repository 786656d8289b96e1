//! Renders light that comes from infinitely far away into an equirectangular picture, which becomes
//! the scene's environment map.

use durer_diag::Span;
use durer_image::{self as image, Image, ImageError, Layer, WriteOptions};
use durer_scene::describe::FileName;
use durer_scene::math::{Color, Vec2, Vec3, fp};
use durer_scene::scene::{PictureBytes, Scene, TextureImage};
use durer_scene::texture::Mapping;
use glam::DVec3;
use rayon::prelude::*;
use std::f32::consts::{PI, TAU};

/// Number of samples along each side of a texel.
const SAMPLES_PER_SIDE: u32 = 3;

/// Number of bytes of memory needed per texel to compute the picture: for its colour, and for the
/// encoded file, whose buffer can grow to twice its size.
const BYTES_PER_TEXEL: u64 = 4 * size_of::<Color>() as u64;

/// Renders the light from each direction in world space into a picture, and uses this picture as
/// the scene's environment map.
///
/// # Errors
///
/// Returns [`ImageError::MemoryLimit`] if this needs more than `allowed` bytes of memory.
pub(super) fn set_environment(
    scene: &mut Scene,
    (name, span): (&str, Span),
    rows: u32,
    allowed: u64,
    light: impl Fn(DVec3) -> Color + Sync,
) -> Result<(), ImageError> {
    let (width, height) = (2 * u64::from(rows), u64::from(rows));
    let needed = width * height * BYTES_PER_TEXEL;
    if needed > allowed {
        return Err(ImageError::MemoryLimit { width, height, needed, allowed });
    }
    let whole = Image::from_pixels(2 * rows, rows, pixels(light, rows))?;
    let mut bytes = Vec::new();
    image::format_for("a.pfm")?.write(&[Layer::data("", whole)], &WriteOptions::default(), &mut bytes)?;
    let path = format!("{name}#environment.pfm");
    let bytes = PictureBytes::Memory(path.clone(), bytes.into());
    scene.assets.pictures.insert(path.clone(), TextureImage { bytes, mapping: Mapping::default() });
    scene.background.environment = Some(FileName { path, span });
    Ok(())
}

/// Returns how many of the `memory` bytes are left after these pictures are stored.
pub(super) fn remaining_memory<'a>(pictures: impl IntoIterator<Item = &'a Image>, memory: u64) -> u64 {
    pictures.into_iter().fold(memory, |left, picture| left.saturating_sub(size_of_val(&picture.pixels[..]) as u64))
}

/// Returns the texel of an equirectangular picture that is nearest to a direction, where y points
/// up.
pub(super) fn nearest(picture: &Image, dir: DVec3) -> Color {
    let dir = dir.as_vec3();
    let (u, v) = (fp::atan2(dir.x, -dir.z) / TAU + 0.5, fp::atan2((dir.x * dir.x + dir.z * dir.z).sqrt(), dir.y) / PI);
    let texel = |share: f32, count: u32| ((share * count as f32) as u32).min(count.saturating_sub(1));
    picture.get(texel(u, picture.width), texel(v, picture.height)).unwrap_or_default()
}

/// Looks up an equirectangular picture in a direction, where y points up. The first row and the
/// last row are at the poles. The lookup interpolates bilinearly between rows and between the
/// centres of columns.
///
/// Source: measured with Mitsuba 3.9, whose `envmap` has this layout.
pub(super) fn bilinear_between_poles(picture: &Image, dir: DVec3) -> Color {
    let dir = dir.as_vec3();
    let (u, v) = (fp::atan2(dir.x, -dir.z) / TAU + 0.5, fp::atan2((dir.x * dir.x + dir.z * dir.z).sqrt(), dir.y) / PI);
    let (width, last) = (i64::from(picture.width), picture.height.saturating_sub(1));
    let (x, y) = (u * width as f32 - 0.5, v * last as f32);
    let (left, above) = (x.floor(), (y.floor() as u32).min(last));
    let row = |y: u32| {
        let texel = |dx: i64| picture.get((left as i64 + dx).rem_euclid(width) as u32, y.min(last)).unwrap_or_default();
        texel(0).lerp(texel(1), x - left)
    };
    row(above).lerp(row(above + 1), y - above as f32)
}

/// Looks up a picture with bilinear interpolation. `place` gives the position as fractions of the
/// picture's width and height, measured from the upper left corner. The picture repeats beyond its
/// borders.
pub(super) fn bilinear(image: &Image, place: Vec2) -> Color {
    let (width, height) = (image.width as i64, image.height as i64);
    let (x, y) = (place.x * width as f32 - 0.5, place.y * height as f32 - 0.5);
    let (low_x, low_y) = (x.floor(), y.floor());
    let texel = |dx: i64, dy: i64| {
        let (i, j) = ((low_x as i64 + dx).rem_euclid(width), (low_y as i64 + dy).rem_euclid(height));
        let value = image.get(i as u32, j as u32).unwrap_or_default();
        if value.is_finite() { value } else { Color::ZERO }
    };
    let upper = texel(0, 0).lerp(texel(1, 0), x - low_x);
    upper.lerp(texel(0, 1).lerp(texel(1, 1), x - low_x), y - low_y)
}

/// Computes the texels of an environment map from the light in each direction, in the layout of
/// [`Environment`](durer_scene::texture::Environment).
pub(super) fn pixels(light: impl Fn(DVec3) -> Color + Sync, rows: u32) -> Vec<Color> {
    let columns = 2 * rows;
    let texel = |i: u32| {
        let (x, y) = (i % columns, i / columns);
        let mut sum = Color::ZERO;
        for place in 0..SAMPLES_PER_SIDE * SAMPLES_PER_SIDE {
            let offset = |k: u32| (k as f32 + 0.5) / SAMPLES_PER_SIDE as f32;
            let (u, v) = (x as f32 + offset(place % SAMPLES_PER_SIDE), y as f32 + offset(place / SAMPLES_PER_SIDE));
            let angle = TAU * (u / columns as f32 - 0.5);
            let (sin, cos) = (fp::sin(PI * v / rows as f32), fp::cos(PI * v / rows as f32));
            sum += light(Vec3::new(sin * fp::sin(angle), cos, -sin * fp::cos(angle)).as_dvec3());
        }
        sum / (SAMPLES_PER_SIDE * SAMPLES_PER_SIDE) as f32
    };
    (0..columns * rows).into_par_iter().map(texel).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lookup_returns_the_light_of_each_direction() {
        let light = |dir: DVec3| dir.as_vec3() + 1.5;
        let picture = Image::from_pixels(256, 128, pixels(light, 128)).unwrap();
        for dir in [DVec3::X, DVec3::NEG_X, DVec3::Z, DVec3::NEG_Z, DVec3::Y, DVec3::new(0.48, -0.6, 0.64)] {
            let found = nearest(&picture, dir);
            assert!((found - light(dir)).length() < 0.05, "{dir}: {found}");
        }
    }
}
