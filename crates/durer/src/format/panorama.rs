//! Light from infinitely far away as one picture of longitude and latitude, which is the scene's environment.

use crate::describe::FileName;
use crate::diag::Span;
use crate::image::{self, Image, Layer, WriteOptions};
use crate::math::{Color, Vec3, fp};
use crate::scene::{Picture, PictureBytes, Scene};
use crate::texture::Mapping;
use glam::DVec3;
use rayon::prelude::*;
use std::f32::consts::{PI, TAU};

/// Places along each side of a texel that are looked up.
const PLACES: u32 = 3;

/// Makes the picture of what comes from each direction of the world, and puts it around the scene. Gives whether that could be done.
pub(super) fn surround(
    scene: &mut Scene,
    (name, span): (&str, Span),
    rows: u32,
    light: impl Fn(DVec3) -> Color + Sync,
) -> bool {
    let Ok(whole) = Image::from_pixels(2 * rows, rows, pixels(light, rows)) else { return false };
    let mut bytes = Vec::new();
    let written = image::format_for("a.pfm")
        .and_then(|format| format.write(&[Layer::data("", whole)], &WriteOptions::default(), &mut bytes));
    if written.is_err() {
        return false;
    }
    let path = format!("{name}#environment.pfm");
    let bytes = PictureBytes::Here(path.clone(), bytes.into());
    scene.assets.pictures.insert(path.clone(), Picture { bytes, mapping: Mapping::default() });
    scene.background.environment = Some(FileName { path, span });
    true
}

/// The light of all directions, as [`Environment`](crate::texture::Environment) has them.
fn pixels(light: impl Fn(DVec3) -> Color + Sync, rows: u32) -> Vec<Color> {
    let columns = 2 * rows;
    let texel = |i: u32| {
        let (x, y) = (i % columns, i / columns);
        let mut sum = Color::ZERO;
        for place in 0..PLACES * PLACES {
            let offset = |k: u32| (k as f32 + 0.5) / PLACES as f32;
            let (u, v) = (x as f32 + offset(place % PLACES), y as f32 + offset(place / PLACES));
            let angle = TAU * (u / columns as f32 - 0.5);
            let (sin, cos) = (fp::sin(PI * v / rows as f32), fp::cos(PI * v / rows as f32));
            sum += light(Vec3::new(sin * fp::sin(angle), cos, -sin * fp::cos(angle)).as_dvec3());
        }
        sum / (PLACES * PLACES) as f32
    };
    (0..columns * rows).into_par_iter().map(texel).collect()
}
