//! Tiles in parallel, each into a film of its own.

use super::job::{Control, Crop, Job, Sampling};
use crate::bvh::{Counts, Rays};
use crate::camera::{Lens, Raster};
use crate::film::aov::{Display, Seen};
use crate::film::course::{StoredSample, StoredSamples, average_3x3, blur, jittered_position};
use crate::film::{Film, Rejected};
use crate::image::{Image, ImageError, Layer};
use crate::integrator::Whitted;
use crate::math::{Aabb, Color, Ray, Vec2, Vec3};
use crate::sampler::Sampler;
use crate::world::World;
use rayon::prelude::*;
use std::sync::atomic::Ordering::Relaxed;

/// Pixels across and down a tile.
const TILE: u32 = 16;

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// The caller set [`Control::cancel`].
    #[error("cancelled")]
    Cancelled,
    /// The picture is too large, or the part lies outside of it.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// The part to be made does not lie in the picture.
    #[error("the crop does not lie in the picture of {0} x {1} pixels")]
    CropOutside(u32, u32),
    /// A diagram cannot be made as asked for.
    #[error("{0}")]
    Diagram(String),
    /// The threads could not be had.
    #[error("cannot start threads: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

/// Pictures and what was counted on the way.
#[derive(Debug)]
pub struct Rendered {
    /// Colour first, if wanted; then the others in the job's order.
    ///
    /// Values are as files of floating point have them; [`Rendered::pictures`] has those for eight bits.
    pub layers: Vec<Layer>,
    /// The same as pictures between 0 and 1.
    pub pictures: Vec<Layer>,
    /// Samples that were not finite, and left out of the mean.
    pub rejected: u64,
    /// The first of them.
    pub first_rejected: Vec<Rejected>,
}

/// Makes the job's pictures of a world.
pub fn render(world: &World, job: &Job, control: &Control) -> Result<Rendered, RenderError> {
    let window = job.window();
    let inside =
        |start: u32, length: u32, size: u32| length > 0 && start.checked_add(length).is_some_and(|end| end <= size);
    if !inside(window.left, window.width, job.width) || !inside(window.top, window.height, job.height) {
        return Err(RenderError::CropOutside(job.width, job.height));
    }
    // Refuses pictures too large before anything is computed.
    drop(Image::new(job.width, job.height, Vec3::ZERO)?);
    let pool =
        rayon::ThreadPoolBuilder::new().num_threads(control.threads.unwrap_or(0)).stack_size(16 << 20).build()?;
    pool.install(|| Renderer { world, job, control, whitted: Whitted { world, settings: job.settings } }.render())
}

/// The ray of a camera through a place in the picture, in pixels from the upper left corner.
pub fn camera_ray(world: &World, raster: &Raster, place: Vec2) -> Ray {
    world.camera.ray(&world.frame, raster.point(place))
}

/// Where the samples of a 2004 job lie, with their colours: for its diagram.
pub fn sample_diagram(world: &World, job: &Job, control: &Control) -> Result<StoredSamples, RenderError> {
    let renderer = Renderer { world, job, control, whitted: Whitted { world, settings: job.settings } };
    let (sampler, samples) = match job.sampling {
        Sampling::Course2004 { sampler, samples, .. } => (sampler, samples),
        Sampling::Filtered { samples, .. } => (Sampler::Sobol, samples),
        Sampling::Center | Sampling::Course2012 { .. } => (Sampler::Uniform, 1),
    };
    renderer.stored(sampler, samples)
}

struct Renderer<'a> {
    world: &'a World,
    job: &'a Job,
    control: &'a Control,
    whitted: Whitted<'a>,
}

impl Renderer<'_> {
    fn render(&self) -> Result<Rendered, RenderError> {
        let mut rendered =
            Rendered { layers: Vec::new(), pictures: Vec::new(), rejected: 0, first_rejected: Vec::new() };
        if self.job.color {
            let image = self.color(&mut rendered)?;
            rendered.layers.push(Layer::color("color", image.clone()));
            rendered.pictures.push(Layer::color("color", image));
        }
        if !self.job.aovs.is_empty() {
            self.aovs(&mut rendered)?;
        }
        Ok(rendered)
    }

    fn color(&self, rendered: &mut Rendered) -> Result<Image, RenderError> {
        let (job, window) = (self.job, self.job.window());
        let raster = Raster::new(job.width, job.height, &self.world.rules);
        match job.sampling {
            Sampling::Center => {
                let pixels = self.pixels(|x, y, rays| self.radiance(&raster, center(x, y), rays))?;
                Ok(Image::from_pixels(window.width, window.height, pixels)?)
            }
            Sampling::Filtered { samples, filter } => {
                let warp = filter.sampler();
                let tiles = self.tiles(|tile, rays| {
                    let mut film = Film::window(tile.left, tile.top, tile.width, tile.height);
                    for (x, y) in places(tile) {
                        for sample in 0..samples {
                            let position = Sampler::Sobol.pixel_position(job.seed, x, y, sample, samples);
                            let (offset, weight) = warp.sample(position);
                            let color = self.radiance(&raster, center(x, y) + offset, rays);
                            film.add(x, y, sample, color, weight);
                        }
                    }
                    film
                })?;
                let mut film = Film::window(window.left, window.top, window.width, window.height);
                for (_, tile) in &tiles {
                    // Every tile lies in the window that was cut into tiles.
                    let _ = film.merge(tile);
                }
                rendered.rejected = film.rejected();
                rendered.first_rejected = film.first_rejected().to_vec();
                let pixels = places(window).map(|(x, y)| film.resolve(x, y)).collect();
                Ok(Image::from_pixels(window.width, window.height, pixels)?)
            }
            Sampling::Course2004 { sampler, samples, filter } => {
                let pixels = self.stored(sampler, samples)?.reconstruct(filter);
                self.cropped(job.width, job.height, pixels)
            }
            Sampling::Course2012 { jitter, blur } => self.course_2012(jitter, blur),
        }
    }

    /// `-jitter` and `-filter` of 2012. Blur without jitter works on the picture as it is.
    fn course_2012(&self, jitter: bool, blurred: bool) -> Result<Image, RenderError> {
        let (job, scale) = (self.job, if jitter { 3 } else { 1 });
        let (width, height) = (job.width * scale, job.height * scale);
        drop(Image::new(width, height, Vec3::ZERO)?);
        let raster = Raster::new(width, height, &self.world.rules);
        let sample = |x: u32, y: u32, _: u32| {
            let place = if jitter { jittered_position(job.seed, x, y) } else { Vec2::new(x as f32, y as f32) };
            StoredSample { position: place, color: self.counted(&raster, place + 0.5) }
        };
        let all = StoredSamples::take(width, height, 1, sample);
        self.check()?;
        let mut pixels = all.reconstruct(None);
        if blurred {
            pixels = blur(&pixels, width, height);
        }
        if jitter {
            pixels = average_3x3(&pixels, width, height);
        }
        self.cropped(job.width, job.height, pixels)
    }

    fn stored(&self, sampler: Sampler, samples: u32) -> Result<StoredSamples, RenderError> {
        let (job, samples) = (self.job, sampler.round_up(samples));
        let raster = Raster::new(job.width, job.height, &self.world.rules);
        let all = StoredSamples::take(job.width, job.height, samples, |x, y, sample| {
            let position = sampler.pixel_position(job.seed, x, y, sample, samples);
            let color = self.counted(&raster, Vec2::new(x as f32, y as f32) + position);
            if sample > 0 {
                // Progress counts pixels.
                self.control.done.fetch_sub(1, Relaxed);
            }
            StoredSample { position, color }
        });
        self.check()?;
        Ok(all)
    }

    /// One sample that counts as a pixel done; black after a cancel.
    fn counted(&self, raster: &Raster, place: Vec2) -> Color {
        if self.control.cancel.load(Relaxed) {
            return Color::ZERO;
        }
        let mut rays = Rays::default();
        let color = self.radiance(raster, place, &mut rays);
        self.control.done.fetch_add(1, Relaxed);
        self.control.rays.fetch_add(rays.0, Relaxed);
        color
    }

    fn radiance(&self, raster: &Raster, place: Vec2, rays: &mut Rays) -> Color {
        self.whitted.radiance(&camera_ray(self.world, raster, place), rays)
    }

    fn check(&self) -> Result<(), RenderError> {
        if self.control.cancel.load(Relaxed) { Err(RenderError::Cancelled) } else { Ok(()) }
    }

    /// The job's part of a whole picture.
    fn cropped(&self, width: u32, height: u32, pixels: Vec<Color>) -> Result<Image, RenderError> {
        let window = self.job.window();
        let whole = Image::from_pixels(width, height, pixels)?;
        let part = places(window).filter_map(|(x, y)| whole.get(x, y)).collect();
        Ok(Image::from_pixels(window.width, window.height, part)?)
    }

    /// A value for each pixel of the window, in reading order.
    fn pixels<T: Copy + Default + Send>(
        &self,
        value: impl Fn(u32, u32, &mut Rays) -> T + Sync,
    ) -> Result<Vec<T>, RenderError> {
        let window = self.job.window();
        let tiles = self.tiles(|tile, rays| places(tile).map(|(x, y)| value(x, y, rays)).collect::<Vec<T>>())?;
        let mut pixels = vec![T::default(); window.width as usize * window.height as usize];
        for (tile, values) in tiles {
            for ((x, y), value) in places(tile).zip(values) {
                pixels[((y - window.top) * window.width + (x - window.left)) as usize] = value;
            }
        }
        Ok(pixels)
    }

    /// Cuts the window into tiles and makes them in parallel. Between tiles a cancel is heard.
    fn tiles<T: Send>(&self, make: impl Fn(Crop, &mut Rays) -> T + Sync) -> Result<Vec<(Crop, T)>, RenderError> {
        let window = self.job.window();
        let columns = window.width.div_ceil(TILE);
        let count = columns * window.height.div_ceil(TILE);
        (0..count)
            .into_par_iter()
            .map(|i| {
                self.check()?;
                let (x, y) = (i % columns * TILE, i / columns * TILE);
                let (width, height) = (TILE.min(window.width - x), TILE.min(window.height - y));
                let tile = Crop { left: window.left + x, top: window.top + y, width, height };
                let mut rays = Rays::default();
                let made = make(tile, &mut rays);
                self.control.done.fetch_add(u64::from(width * height), Relaxed);
                self.control.rays.fetch_add(rays.0, Relaxed);
                Ok((tile, made))
            })
            .collect()
    }

    /// The other pictures: one ray through each pixel's centre.
    fn aovs(&self, rendered: &mut Rendered) -> Result<(), RenderError> {
        let (job, world, window) = (self.job, self.world, self.job.window());
        let raster = Raster::new(job.width, job.height, &world.rules);
        let cost_wanted = job.aovs.iter().any(|aov| aov.name == "cost");
        let seen = self.pixels(|x, y, rays| {
            let ray = camera_ray(world, &raster, center(x, y));
            let hit = world.closest(&ray, rays).map(|hit| (hit, world.surface(&ray, &hit)));
            let mut counts = Counts::default();
            if cost_wanted {
                self.whitted.radiance(&ray, &mut counts);
            }
            let material = hit.map_or(0, |(hit, _)| world.objects[hit.object as usize].material);
            Some(Seen { hit, material, counts })
        })?;
        let seen: Vec<Seen> = seen.into_iter().flatten().collect();
        let hits = || seen.iter().filter_map(|seen| seen.hit.as_ref());
        let least = hits().map(|(hit, _)| hit.t).fold(f32::INFINITY, f32::min);
        let greatest = hits().map(|(hit, _)| hit.t).fold(f32::NEG_INFINITY, f32::max);
        let display = Display {
            rules: &world.rules,
            depth_range: job.depth_range.unwrap_or((least, if greatest > least { greatest } else { least + 1.0 })),
            positions: Aabb::around(hits().map(|(_, surface)| surface.position)),
            greatest_cost: seen.iter().map(|s| (s.counts.nodes + s.counts.tests) as f32).fold(0.0, f32::max),
        };
        for aov in &job.aovs {
            let values: Vec<Vec3> = seen.iter().map(aov.value).collect();
            let picture = values.iter().zip(&seen).map(|(v, seen)| (aov.picture)(*v, seen.hit.is_some(), &display));
            let picture = Image::from_pixels(window.width, window.height, picture.collect())?;
            let values = Image::from_pixels(window.width, window.height, values)?;
            rendered.layers.push(Layer::data(aov.name, values));
            rendered.pictures.push(Layer::data(aov.name, picture));
        }
        Ok(())
    }
}

fn center(x: u32, y: u32) -> Vec2 {
    Vec2::new(x as f32 + 0.5, y as f32 + 0.5)
}

/// The pixels of a part, in reading order.
fn places(part: Crop) -> impl Iterator<Item = (u32, u32)> {
    (part.top..part.top + part.height).flat_map(move |y| (part.left..part.left + part.width).map(move |x| (x, y)))
}
