//! Why a pixel has its colour: every sample, and the tree of terms that it is the sum of.

mod text;

use super::samples::{Aim, Samples};
use super::{Job, RenderError, Sampling, center_ray, raster};
use crate::camera::Raster;
use crate::dialect::Compat;
use crate::film::Film;
use crate::integrator::{Account, Node, Whitted};
use crate::math::{Color, Ray, Vec2, Vec3};
use crate::world::{Material, World};
use serde::Serialize;
use std::sync::atomic::AtomicBool;
pub use text::{Line, Names, ray_text};

/// A pixel and all that made it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Explanation {
    /// Column from the left.
    pub x: u32,
    /// Row from the top.
    pub y: u32,
    /// The pixel's colour, as a file of floating point has it.
    pub color: Color,
    /// The share of it that the camera sees at all.
    pub coverage: f32,
    /// Its samples, in order. The colour is the film's mean of theirs by weight; see [`Explanation::sum`].
    pub samples: Vec<SampleAccount>,
    /// What an old program's habit `stale-texels` adds to the colour.
    pub stale_texels: Option<Color>,
}

/// One sample of a pixel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SampleAccount {
    /// Its number.
    pub sample: u32,
    /// Where in the picture it lies, in pixels from the upper left corner.
    pub place: Vec2,
    /// Where in the lens, from 0 to 1.
    pub lens: Vec2,
    /// Its weight in the pixel, not divided by the sum of all.
    pub weight: f32,
    /// The tree of its light; `null` in JSON where the camera sees nothing.
    pub light: Option<Node>,
}

impl Explanation {
    /// The pixel's colour and coverage, computed anew from the trees by the film's arithmetic.
    pub fn sum(&self) -> (Color, f32) {
        let mut film = Film::window(self.x, self.y, 1, 1);
        for s in &self.samples {
            let color = s.light.as_ref().map(|light| light.sum() + self.stale_texels.unwrap_or_default());
            film.add_if_seen(self.x, self.y, s.sample, color, s.weight);
        }
        (film.resolve(self.x, self.y), film.coverage(self.x, self.y))
    }
}

/// The tree of the light along any ray.
pub fn explain_ray(world: &World, job: &Job, ray: &Ray) -> Option<Node> {
    let mut account = Account::default();
    Whitted { world, settings: job.settings, cancel: None }.radiance(ray, &mut account);
    account.into_tree()
}

/// Why a pixel of the job's colour picture is as it is.
///
/// # Errors
///
/// The pixel does not lie in the picture, or its colour is made of its neighbours' samples too.
pub fn explain(world: &World, job: &Job, x: u32, y: u32) -> Result<Explanation, RenderError> {
    if x >= job.width || y >= job.height {
        return Err(RenderError::CropOutside(job.width, job.height));
    }
    if matches!(job.sampling, Sampling::Course2004 { .. } | Sampling::Course2012 { .. }) {
        return Err(RenderError::Unexplained);
    }
    let (stop, mut stale_texels) = (AtomicBool::new(false), None);
    let source = Samples::without_habits(world, job, &stop);
    let account = |sample| {
        let Aim { place, lens, weight, ray } = source.aim(x, y, sample);
        let light = ray.and_then(|ray| explain_ray(world, job, &ray));
        SampleAccount { sample, place, lens, weight, light }
    };
    let samples = (0..job.sampling.samples()).map(account).collect();
    if job.sampling == Sampling::Center && world.rules.has(Compat::StaleTexels) {
        stale_texels = stale_texel(world, job, &raster(world, job.width, job.height), (x, y));
    }
    let mut explanation = Explanation { x, y, color: Vec3::ZERO, coverage: 1.0, samples, stale_texels };
    (explanation.color, explanation.coverage) = explanation.sum();
    Ok(explanation)
}

/// The colour of a texture, noise or plain surface at a pixel's centre, and its material, if that has one.
fn texel(world: &World, job: &Job, raster: &Raster, pixel: (u32, u32)) -> Option<(u32, Color, Color)> {
    let ray = center_ray(world, raster, pixel)?;
    let hit = world.closest(&ray, &mut ())?;
    let material = world.material(&hit);
    let Material::Phong(phong) = &world.materials[material as usize] else { return None };
    let whitted = Whitted { world, settings: job.settings, cancel: None };
    Some((material, whitted.diffuse_color(phong, &world.surface(&ray, &hit)), phong.diffuse))
}

/// What [`Compat::StaleTexels`] adds: the ambient light of the pixel before with the same material, less its own.
fn stale_texel(world: &World, job: &Job, raster: &Raster, (x, y): (u32, u32)) -> Option<Color> {
    let (material, own, plain) = texel(world, job, raster, (x, y))?;
    // In rows from the bottom: first those of this row to the left, from right to left, then the rows below.
    let row = |y: u32, end: u32| (0..end).rev().map(move |x| (x, y));
    let mut before = row(y, x).chain((y + 1..job.height).flat_map(|y| row(y, job.width)));
    let before = before.find_map(|pixel| texel(world, job, raster, pixel).filter(|found| found.0 == material));
    Some(world.ambient * (before.map_or(plain, |found| found.1) - own))
}

#[cfg(test)]
mod tests;
