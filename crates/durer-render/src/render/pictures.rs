//! Conversion of the sums and AOV values of a render to pictures.

use super::error::RenderError;
use super::part::{PartialRender, PartialState, PrimaryHit, Statistics, job_text};
use super::{BandsError, Blocks, PixelRect};
use crate::film::Film;
use crate::film::aov::{Aov, AovFunction, Display, PixelStatistics, fill_from_last_hit};
use crate::film::false_color::FalseColorScale;
use durer_image::{Display as ImageDisplay, Format, Image, Layer, RowLayout};
use durer_scene::math::{Aabb, Color, Vec3};
use rayon::prelude::*;
use std::io::Write;
use std::ops::Range;
use std::sync::Arc;

/// Number of rows of blocks that each thread converts at once when a picture is written in strips.
const ROWS_PER_THREAD: usize = 4;

/// Finished pictures of a render with statistics and file attributes.
#[derive(Debug)]
pub struct Rendered {
    /// Pictures with the values for floating-point files. The colour picture comes first, if it was
    /// requested, followed by the AOVs in the order of the job. See also [`Rendered::pictures`].
    pub layers: Vec<Layer>,
    /// Pictures of the same layers as display values from 0 to 1.
    pub pictures: Vec<Layer>,
    /// Numbers of samples and rays.
    pub statistics: Statistics,
    /// Names and values of attributes for picture files.
    pub attributes: Vec<(&'static str, String)>,
}

impl PartialRender {
    /// Returns the current pictures. Pixels without samples are black.
    ///
    /// # Errors
    /// Returns [`RenderError::Image`].
    pub fn pictures(&self) -> Result<Rendered, RenderError> {
        let statistics = self.statistics();
        let (job, window) = (&self.job, self.job.window());
        let mut rendered =
            Rendered { layers: Vec::new(), pictures: Vec::new(), attributes: self.attributes(&statistics), statistics };
        let state = self.state();
        if job.color {
            let (colors, coverage) = self.colors(&state);
            let image = Image::from_pixels(window.width, window.height, colors)?;
            let layer = Layer::color("color", image).with_coverage(coverage);
            rendered.layers.push(layer.clone());
            rendered.pictures.push(layer);
        }
        let mut rays = 0..;
        for aov in &job.aovs {
            let values = match aov.value {
                AovFunction::Ray(_) => self.traced(&state, rays.next().unwrap_or_default()),
                AovFunction::Sums(value) => self.summed(&state, value),
            };
            let (pictures, scale) = self.shown(aov, &values);
            let (values, hit): (Vec<Vec3>, Vec<PrimaryHit>) = values.into_iter().unzip();
            let coverage: Vec<f32> = hit.iter().map(|found| f32::from(u8::from(*found != PrimaryHit::NoRay))).collect();
            let from = if matches!(aov.value, AovFunction::Ray(_)) { job.ray_window() } else { window };
            let coverage = crop_pixels(coverage, from, window);
            let layer = |pixels| -> Result<Layer, RenderError> {
                let image = Image::from_pixels(window.width, window.height, crop_pixels(pixels, from, window))?;
                let layer = if aov.is_light { Layer::color(aov.name, image) } else { Layer::data(aov.name, image) };
                Ok(layer.with_coverage(coverage.clone()))
            };
            rendered.layers.push(layer(values)?);
            let mut shown = layer(pictures)?;
            if let Some(unit) = aov.unit {
                let width = window.width as usize;
                scale.draw_legend(&mut Arc::make_mut(&mut shown.image).pixels, width, unit);
            }
            rendered.pictures.push(shown);
        }
        Ok(rendered)
    }

    /// Returns attributes for picture files. The attributes do not depend on how the picture was
    /// rendered.
    fn attributes(&self, statistics: &Statistics) -> Vec<(&'static str, String)> {
        let Statistics { samples, rays, rejected, .. } = statistics;
        vec![
            ("software", format!("durer {}", env!("CARGO_PKG_VERSION"))),
            ("scene", self.scene.to_string()),
            ("job", job_text(&self.job)),
            ("statistics", format!("{{\"samples\":{samples},\"rays\":{rays},\"rejected\":{rejected}}}")),
        ]
    }

    /// Writes the current colour picture row by row in a format that supports this. The full
    /// picture is never in memory. Calls `visit` with a few rows at a time until all rows have been
    /// written.
    ///
    /// # Errors
    /// Returns errors from writing, and [`BandsError::Image`] for formats that need all rows at
    /// once.
    pub fn write_colors(
        &self,
        format: &Format,
        display: ImageDisplay,
        out: &mut dyn Write,
        mut visit: impl FnMut(&[Color]),
    ) -> Result<(), BandsError> {
        let (PixelRect { width, height, .. }, alpha) = (self.job.window(), !self.has_full_coverage(&self.state()));
        let strip = RowLayout { width, height, alpha, display };
        let bottom_up = format.rows.is_some_and(|rows| rows.bottom_up);
        format.write_rows(strip, out, |rows| {
            self.try_strips(bottom_up, |pixels, coverage| {
                visit(pixels);
                Ok(rows.rows(pixels, coverage)?)
            })
        })
    }

    /// Returns true if all pixels have full coverage.
    fn has_full_coverage(&self, state: &PartialState) -> bool {
        state.samples.iter().all(|block| block.film.as_ref().is_some_and(|film| film.has_full_coverage()))
    }

    /// Calls `strip` with the colours of some complete rows at a time and with the coverage of each
    /// pixel (empty if all pixels are fully covered). Starts with the bottom rows if `bottom_up` is
    /// true. Missing pixels are transparent.
    ///
    /// # Errors
    /// Returns the first error that `strip` returns.
    pub(super) fn try_strips<E>(
        &self,
        bottom_up: bool,
        mut strip: impl FnMut(&[Color], &[f32]) -> Result<(), E>,
    ) -> Result<(), E> {
        let (state, rows): (_, Vec<_>) = (self.state(), self.blocks.rows().collect());
        let is_seen = self.has_full_coverage(&state);
        let mut offer = |rows: &[Range<usize>]| {
            let (colors, coverage) = self.colors_of(&state, rows, is_seen);
            strip(&colors, &coverage)
        };
        let mut parts = rows.chunks(ROWS_PER_THREAD * rayon::current_num_threads());
        if bottom_up { parts.rev().try_for_each(&mut offer) } else { parts.try_for_each(&mut offer) }
    }

    /// Returns the colour and coverage of all pixels. Missing pixels are transparent. The list of
    /// coverages is empty if all pixels are fully covered.
    fn colors(&self, state: &PartialState) -> (Vec<Color>, Vec<f32>) {
        self.colors_of(state, &self.blocks.rows().collect::<Vec<_>>(), self.has_full_coverage(state))
    }

    /// Returns the colour and coverage of the pixels in some rows of blocks.
    fn colors_of(&self, state: &PartialState, rows: &[Range<usize>], is_seen: bool) -> (Vec<Color>, Vec<f32>) {
        let window = self.job.window();
        // A row of blocks consists of complete rows of pixels.
        let pixels = |blocks: &Range<usize>| (self.blocks.rect(blocks.start).height * window.width) as usize;
        let count = rows.iter().map(pixels).sum();
        let (mut colors, mut coverage) = (vec![Color::ZERO; count], vec![0.0; if is_seen { 0 } else { count }]);
        let (mut free_colors, mut free_coverage) = (&mut colors[..], &mut coverage[..]);
        let strips = rows.iter().filter_map(|blocks| {
            let pixels = pixels(blocks);
            let covered = if is_seen { 0 } else { pixels };
            Some((blocks, free_colors.split_off_mut(..pixels)?, free_coverage.split_off_mut(..covered)?))
        });
        strips.collect::<Vec<_>>().into_par_iter().for_each(|(blocks, colors, coverage)| {
            let strip = PixelRect { top: self.blocks.rect(blocks.start).top, ..window };
            for index in blocks.clone() {
                let Some(film) = &state.samples[index].film else { continue };
                let mut places = self.blocks.rect(index).pixel_positions();
                film.for_each_mean(|color, share| {
                    let Some(at) = places.next().map(|(x, y)| strip.index(x, y)) else { return };
                    colors[at] = color;
                    if let Some(own) = coverage.get_mut(at) {
                        *own = share;
                    }
                });
            }
        });
        (colors, coverage)
    }

    /// Returns the colour, coverage and luminance variance of each pixel.
    pub(super) fn colors_and_variance(&self) -> (Vec<Color>, Vec<f32>, Vec<f32>) {
        let state = self.state();
        let (colors, coverage) = self.colors(&state);
        let variance = self.summed(&state, |sums| Vec3::splat(sums.variance() as f32));
        // If there are too few samples for a variance, use the brightness of the pixel as its
        // error.
        let sure = |(value, color): (&(Vec3, PrimaryHit), &Color)| match value.0.x.is_finite() {
            true => value.0.x,
            false => color.max_element() * color.max_element(),
        };
        let variance = variance.iter().zip(&colors).map(sure).collect();
        (colors, coverage, variance)
    }

    /// Returns the values of an AOV that is computed from the colour samples.
    fn summed(&self, state: &PartialState, value: fn(&PixelStatistics) -> Vec3) -> Vec<(Vec3, PrimaryHit)> {
        let (gain, lumens) = (self.gain(), self.display.lumens);
        let none = value(&PixelStatistics { pixel: None, gain, lumens });
        let mut pixels = vec![(none, PrimaryHit::NoRay); self.job.window().pixels() as usize];
        self.each_sampled(state, |index, film, x, y| {
            let sums = PixelStatistics { pixel: Some((film, x, y)), gain, lumens };
            pixels[index] = (value(&sums), PrimaryHit::Hit);
        });
        pixels
    }

    /// Calls `visit` for each pixel that has samples.
    fn each_sampled(&self, state: &PartialState, mut visit: impl FnMut(usize, &Film, u32, u32)) {
        let window = self.job.window();
        for index in 0..state.samples.len() {
            self.each_of_block(state, index, |film, x, y| visit(window.index(x, y), film, x, y));
        }
    }

    /// Calls `visit` for each pixel of a block, if the block has samples.
    fn each_of_block(&self, state: &PartialState, index: usize, mut visit: impl FnMut(&Film, u32, u32)) {
        let rect = self.blocks.rect(index);
        if let Some(film) = state.samples[index].film(rect) {
            rect.pixel_positions().for_each(|(x, y)| visit(&film, x, y));
        }
    }

    /// Returns the values of an AOV that is computed from the centre rays.
    fn traced(&self, state: &PartialState, number: usize) -> Vec<(Vec3, PrimaryHit)> {
        let (window, blocks): (PixelRect, &Blocks) = (self.job.ray_window(), &self.ray_blocks);
        let mut pixels = vec![(Vec3::ZERO, PrimaryHit::NoRay); window.pixels() as usize];
        for (index, block) in state.rays.iter().enumerate() {
            let Some(block) = block else { continue };
            let values = &block.values[number * block.hits.len()..];
            for ((x, y), value) in blocks.rect(index).pixel_positions().zip(values.iter().zip(&block.hits)) {
                pixels[window.index(x, y)] = (*value.0, *value.1);
            }
        }
        pixels
    }

    /// Converts the values of an AOV to display colours. Also returns the scale of false colours.
    fn shown(&self, aov: &Aov, values: &[(Vec3, PrimaryHit)]) -> (Vec<Color>, FalseColorScale) {
        let light = aov.unit.map_or(&[][..], |_| values);
        let display = Display {
            rules: self.display,
            depth_range: self.job.depth_range,
            light_scale: self
                .job
                .light_scale
                .unwrap_or_else(|| FalseColorScale::from_values(light.iter().map(|value| value.0.x))),
            hit_bounds: if aov.name == "depth" { visible_depth_range(values) } else { Aabb::around(of_hits(values)) },
            all_bounds: Aabb::around(values.iter().map(|value| value.0)),
        };
        let color = |&(value, found): &(Vec3, PrimaryHit)| match found {
            PrimaryHit::NoRay => Vec3::ZERO,
            _ => (aov.picture)(value, found == PrimaryHit::Hit, &display),
        };
        let mut picture: Vec<Color> = values.iter().map(color).collect();
        if aov.name == "normals" && self.display.stale_normals {
            let hits: Vec<bool> = values.iter().map(|value| value.1 == PrimaryHit::Hit).collect();
            fill_from_last_hit(&mut picture, &hits, self.job.ray_window().width as usize);
        }
        (picture, display.light_scale)
    }
}

/// Depths are considered part of a horizon if their ratio to the 95th percentile is above this
/// value.
const HORIZON: f32 = 4.0;

/// Iterates over the values of pixels with a hit.
fn of_hits(values: &[(Vec3, PrimaryHit)]) -> impl Iterator<Item = Vec3> {
    values.iter().filter(|value| value.1 == PrimaryHit::Hit).map(|value| value.0)
}

/// Returns the range of the depths at hits, excluding the horizon of a plane. If the horizon were
/// included, everything else would have the same shade of grey.
fn visible_depth_range(values: &[(Vec3, PrimaryHit)]) -> Aabb {
    let mut bounds = Aabb::around(of_hits(values));
    let mut depths: Vec<f32> = of_hits(values).map(|value| value.x).collect();
    depths.sort_by(f32::total_cmp);
    if let Some(most) = depths.get(depths.len() * 95 / 100).map(|most| most - bounds.min.x)
        && bounds.max.x - bounds.min.x > HORIZON * most
        && most > 0.0
    {
        bounds.max.x = bounds.min.x + 1.5 * most;
    }
    bounds
}

/// Crops a picture of one rectangle to another rectangle.
fn crop_pixels<T: Copy>(pixels: Vec<T>, from: PixelRect, to: PixelRect) -> Vec<T> {
    if from == to { pixels } else { to.pixel_positions().map(|(x, y)| pixels[from.index(x, y)]).collect() }
}
