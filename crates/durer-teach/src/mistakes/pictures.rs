//! Renders selected pixels of a scene variant.

use super::bugs::{OutputBug, PixelOrder, RayCount};
use super::{BuggyTracer, Mistake, SceneVariant};
use durer_image::Transfer;
use durer_image::compare::{Scale, linear_to_srgb, srgb_to_linear};
use durer_render::render::{Job, sample_places};
use durer_render::world::World;
use durer_scene::math::{Color, LUMINANCE, Vec2, Vec3, fp};
use durer_scene::scene::Scene;
use rayon::prelude::*;

/// Way in which the compared pictures are rendered and encoded: their size, samples, transfer curve
/// and scale of values.
#[derive(Clone, Debug)]
pub(super) struct View<'j> {
    /// Size of the picture, and number of samples per pixel.
    pub job: &'j Job,
    /// Scale of the values, which is either display values or linear light.
    pub scale: Scale,
    /// Transfer curve for display values.
    pub transfer: Transfer,
    /// Maximum value of the correct picture.
    pub max_value: f32,
}

impl View<'_> {
    /// Renders pixels as linear light.
    pub fn light(&self, variant: &SceneVariant, pixels: &[(u32, u32)]) -> Vec<Color> {
        let raster = variant.raster(self.job.width, self.job.height);
        let tracer = BuggyTracer::new(&variant.world, variant.settings, &variant.bugs)
            .with_shadow_world(variant.shadow_world.as_deref());
        let samples = sample_places(&variant.world, self.job);
        let pixel = |&(x, y): &(u32, u32)| {
            let (mut sum, mut weights) = (Color::ZERO, 0.0);
            let mut add = |place: Vec2, lens: Vec2, weight: f32| {
                if let Some(ray) = variant.ray(&raster, (x, y), place, lens) {
                    sum += weight * tracer.radiance(&ray);
                }
                weights += weight;
            };
            let corner = Vec2::new(x as f32, y as f32);
            match variant.camera_bugs.rays {
                RayCount::Correct => samples(x, y, &mut add),
                RayCount::One => add(corner + 0.5, Vec2::splat(0.5), 1.0),
                RayCount::Sixteen => (0..16_u8).for_each(|i| {
                    let part = Vec2::new(f32::from(i % 4), f32::from(i / 4));
                    add(corner + (part + 0.5) / 4.0, Vec2::splat(0.5), 1.0);
                }),
            }
            sum / weights
        };
        pixels.par_iter().with_min_len(16).map(pixel).collect()
    }

    /// Converts linear light to file values, including mistakes in the output.
    pub fn values(&self, output: OutputBug, light: &[Color]) -> Vec<Vec3> {
        light.iter().map(|&light| self.value(output, light)).collect()
    }

    /// Renders pixels of a variant and returns their file values.
    pub fn picture(&self, variant: &SceneVariant, pixels: &[(u32, u32)]) -> Vec<Vec3> {
        let (width, height) = (self.job.width, self.job.height);
        let sources: Vec<(u32, u32)> =
            pixels.iter().map(|pixel| variant.pixel_order.source(width, height, *pixel)).collect();
        let mut values = self.values(variant.output, &self.light(variant, &sources));
        for (value, pixel) in values.iter_mut().zip(pixels) {
            if variant.pixel_order.is_empty(width, height, *pixel) {
                *value = Vec3::ZERO;
            }
        }
        let order = PixelOrder::ORDERS[usize::from(variant.pixel_order.channels).min(5)];
        values.iter_mut().for_each(|value| *value = order.map(|channel| value[channel]).into());
        values
    }

    fn value(&self, output: OutputBug, light: Color) -> Vec3 {
        // Show huge values as white, although they overflow in an old program.
        let light = if light.is_finite() { light.min(Color::splat(1e6)) } else { light };
        let light = if output == OutputBug::Toned { light.map(|v| v / (1.0 + v.max(0.0))) } else { light };
        let light = match output {
            OutputBug::Scaled => light / self.max_value,
            OutputBug::Times(factor) => light * factor,
            OutputBug::Negative => Color::ONE - light.clamp(Color::ZERO, Color::ONE),
            OutputBug::Grey(how) => Color::splat(grey(how, light.clamp(Color::ZERO, Color::ONE))),
            OutputBug::Steps(steps) => {
                let n = steps as f32;
                light.map(|v| (v.clamp(0.0, 1.0) * n).floor().min(n - 1.0) / (n - 1.0).max(1.0))
            }
            _ => light,
        };
        if self.scale == Scale::Linear {
            return light;
        }
        let transfer = match (output, self.transfer) {
            (OutputBug::OtherRounding, Transfer::Course) => Transfer::Linear,
            (OutputBug::OtherRounding, Transfer::Linear) => Transfer::Course,
            // Without the curve, the file contains linear values.
            (OutputBug::MissingCurve(0.0), Transfer::Srgb) => Transfer::Linear,
            (_, transfer) => transfer,
        };
        if let OutputBug::Wrapped(most) = output {
            let half = if transfer == Transfer::Course { 0.0 } else { 0.5 };
            let curved = |v: f32| if transfer == Transfer::Srgb { linear_to_srgb(v.max(0.0)) } else { v };
            let wrapped = |v: f32| ((curved(v) * f32::from(most) + half).floor() as i64).rem_euclid(256) as f32 / 255.0;
            return light.map(wrapped);
        }
        let eight = |transfer: Transfer, v: Vec3| Vec3::from(transfer.encode_pixel(v).map(f32::from)) / 255.0;
        // The second curve is applied before quantisation.
        let curved = |v: f32| if transfer == Transfer::Srgb { linear_to_srgb(v.clamp(0.0, 1.0)) } else { v.max(0.0) };
        let plain = if transfer == Transfer::Course { Transfer::Course } else { Transfer::Linear };
        match output {
            OutputBug::ExtraCurve(0.0) => eight(plain, light.map(|v| linear_to_srgb(curved(v)))),
            OutputBug::ExtraCurve(power) => eight(plain, light.map(|v| fp::pow(curved(v), 1.0 / power))),
            OutputBug::MissingCurve(power) if power > 0.0 => eight(plain, light.map(|v| fp::pow(curved(v), power))),
            OutputBug::MissingCurve(_) if self.transfer != Transfer::Srgb => {
                eight(plain, light.map(|v| srgb_to_linear(curved(v))))
            }
            _ => eight(transfer, light),
        }
    }
}

/// Returns the maximum value of a picture by which a program scales its values. It is never 0.
pub(super) fn brightest(light: &[Color]) -> f32 {
    light.iter().map(|light| light.max_element()).fold(0.0, f32::max).max(1e-6)
}

/// Renders a scene with Whitted's method as a program with a mistake would write it, row by row
/// from the top, encoded as sRGB. `mistake` is a row of the table and its value; `None` gives the
/// correct picture. The crop of the job is ignored.
pub fn mistaken_picture(scene: &Scene, world: &World, job: &Job, mistake: Option<(&Mistake, f32)>) -> Vec<[u8; 3]> {
    let right = SceneVariant::new(scene, world.clone(), job.settings);
    let pixels: Vec<(u32, u32)> = (0..job.height).flat_map(|y| (0..job.width).map(move |x| (x, y))).collect();
    let mut view = View { job, scale: Scale::Display, transfer: Transfer::Srgb, max_value: 1.0 };
    let mut wrong = right.clone();
    if let Some((mistake, value)) = mistake {
        (mistake.apply)(&mut wrong, value);
    }
    if wrong.output == OutputBug::Scaled {
        view.max_value = brightest(&view.light(&right, &pixels));
    }
    let eight = |value: &Vec3| value.to_array().map(|v| (255.0 * v + 0.5) as u8);
    view.picture(&wrong, &pixels).iter().map(eight).collect()
}

/// Converts a colour to grey with one of the formulas of [`OutputBug::Grey`].
fn grey(how: u32, color: Color) -> f32 {
    match how {
        0 => (color.x + color.y + color.z) / 3.0,
        1 => color.dot(Vec3::new(0.299, 0.587, 0.114)),
        2 => color.dot(LUMINANCE),
        3 => color.max_element(),
        channel => color[(channel as usize - 4).min(2)],
    }
}
