//! Quirk of the official program of Fall 2012. On a textured surface, ambient light uses the texel
//! of the previous pixel with the same material. Pixels are processed row by row from the bottom
//! up.

use super::{Job, Sampling, center_ray};
use crate::world::{Material, World};
use durer_scene::camera::Raster;
use durer_scene::math::Color;

/// Returns true if the quirk applies, which requires that the dialect has it and that there is one
/// ray per pixel.
pub(super) fn applies(world: &World, job: &Job) -> bool {
    job.sampling == Sampling::Center && world.shading_rules().stale_texels
}

/// Material at the centre of a pixel, with the colour of its texture or noise there.
struct Texel {
    material: u32,
    color: Color,
    /// Colour of the material without its texture. It is used if there is no previous pixel.
    plain: Color,
}

/// Returns the texel at the centre of a pixel. Returns `None` if nothing is hit and for solid
/// patterns.
fn texel(world: &World, raster: &Raster, pixel: (u32, u32)) -> Option<Texel> {
    let ray = center_ray(world, raster, pixel)?;
    let at = world.intersect(&ray, &mut ())?;
    let Material::Phong(phong) = &world.materials()[at.material as usize] else { return None };
    let color = world.diffuse_color(phong, &at.surface);
    Some(Texel { material: at.material, color, plain: phong.diffuse })
}

/// Returns the colour that the quirk adds to each pixel of the full picture. Calls `stops` before
/// each pixel. Once `stops` returns true, the remaining pixels get 0.
pub(super) fn differences(world: &World, job: &Job, raster: &Raster, stops: impl Fn() -> bool) -> Vec<Color> {
    let mut last: Vec<Option<Color>> = vec![None; world.materials().len()];
    let mut differences = vec![Color::ZERO; job.whole().pixels() as usize];
    for (y, x) in (0..job.height).rev().flat_map(|y| (0..job.width).map(move |x| (y, x))) {
        if stops() {
            break;
        }
        let Some(Texel { material, color, plain }) = texel(world, raster, (x, y)) else { continue };
        let before = last[material as usize].replace(color).unwrap_or(plain);
        differences[y as usize * job.width as usize + x as usize] = world.ambient() * (before - color);
    }
    differences
}

/// Returns the colour that the quirk adds to one pixel.
pub(super) fn difference(world: &World, job: &Job, raster: &Raster, (x, y): (u32, u32)) -> Option<Color> {
    let own = texel(world, raster, (x, y))?;
    // Rows are processed from the bottom up, so search backwards, first to the left in this row and
    // then through the rows below.
    let row = |y: u32, end: u32| (0..end).rev().map(move |x| (x, y));
    let mut before = row(y, x).chain((y + 1..job.height).flat_map(|y| row(y, job.width)));
    let before = before.find_map(|pixel| texel(world, raster, pixel).filter(|found| found.material == own.material));
    Some(world.ambient() * (before.map_or(own.plain, |found| found.color) - own.color))
}
