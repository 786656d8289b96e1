//! Tiles in parallel, each into a film of its own.

use super::job::{Control, Crop, Job, Sampling};
use crate::bvh::{Counts, Rays};
use crate::camera::{CameraSample, Lens, Raster};
use crate::dialect::Compat;
use crate::film::aov::{Display, Seen, fill_from_last_hit};
use crate::film::course::{StoredSample, StoredSamples, average_3x3, blur, jittered_position};
use crate::film::{Film, Rejected};
use crate::image::{Image, ImageError, Layer, checked_count};
use crate::integrator::Whitted;
use crate::math::{Aabb, Color, Ray, Vec2, Vec3};
use crate::sampler::Sampler;
use crate::world::{Material, World};
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// Pixels across and down a tile.
const TILE: u32 = 16;

/// The most samples that are kept at once, in at most about 7 GiB with what is made of them: enough for 1920 x 1080 pixels
/// of 64.
const MOST_KEPT: u64 = 1 << 27;

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
    /// Samplings that keep their samples have not the memory for so many.
    #[error("this way of sampling keeps all samples, and {0} are too many: at most {MOST_KEPT}")]
    TooManySamples(u64),
    /// A pixel cannot be explained.
    #[error(
        "a pixel that is made of its neighbours' samples too cannot be explained; leave out the course's sampler, `--jitter` and `--blur`"
    )]
    Unexplained,
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
    checked_count(job.width, job.height)?;
    in_threads(control, || Renderer::new(world, job, control).render())?
}

/// Runs work in as many threads as wanted, whose stacks hold the most bounces.
pub(super) fn in_threads<T: Send>(control: &Control, work: impl FnOnce() -> T + Send) -> Result<T, RenderError> {
    let threads = rayon::ThreadPoolBuilder::new().num_threads(control.threads.unwrap_or(0)).stack_size(16 << 20);
    Ok(threads.build()?.install(work))
}

/// The picture's pixels on the square that a world's camera covers.
pub fn raster(world: &World, width: u32, height: u32) -> Raster {
    Raster::new(width, height, world.camera.proportions(), &world.rules)
}

/// The ray of a camera for a pixel, through a place in the picture in pixels from the upper left corner, and through a
/// point of the lens in [0,1)^2; `None` where the camera sees nothing.
pub fn camera_ray(world: &World, raster: &Raster, pixel: (u32, u32), place: Vec2, lens: Vec2) -> Option<Ray> {
    let pixel = raster.point(center(pixel.0, pixel.1));
    world.camera.ray(&world.frame, &CameraSample { point: raster.point(place), pixel, lens })
}

/// The ray through a pixel's centre and the middle of the lens.
pub fn center_ray(world: &World, raster: &Raster, (x, y): (u32, u32)) -> Option<Ray> {
    world.camera.ray(&world.frame, &CameraSample::at(raster.point(center(x, y))))
}

/// Where the samples of a 2004 job lie, with their colours: for its diagram.
pub fn sample_diagram(world: &World, job: &Job, control: &Control) -> Result<StoredSamples, RenderError> {
    let (sampler, samples) = match job.sampling {
        Sampling::Course2004 { sampler, samples, .. } => (sampler, samples),
        Sampling::Filtered { samples, .. } => (Sampler::Sobol, samples),
        Sampling::Center | Sampling::Course2012 { .. } => (Sampler::Uniform, 1),
    };
    in_threads(control, || Renderer::new(world, job, control).stored(&Pass::default(), sampler, samples))?
}

/// What the course's ways of sampling are made to show. They know colours only: where the camera sees nothing somewhere,
/// a second pass shows white where it does.
#[derive(Default)]
struct Pass {
    mask: bool,
    /// Whether the camera saw nothing at some sample.
    blind: AtomicBool,
}

struct Renderer<'a> {
    world: &'a World,
    job: &'a Job,
    control: &'a Control,
    whitted: Whitted<'a>,
}

impl<'a> Renderer<'a> {
    fn new(world: &'a World, job: &'a Job, control: &'a Control) -> Self {
        let whitted = Whitted { world, settings: job.settings, cancel: Some(&control.cancel) };
        Renderer { world, job, control, whitted }
    }

    fn render(&self) -> Result<Rendered, RenderError> {
        let mut rendered =
            Rendered { layers: Vec::new(), pictures: Vec::new(), rejected: 0, first_rejected: Vec::new() };
        if self.job.color {
            let layer = self.color(&mut rendered)?;
            rendered.layers.push(layer.clone());
            rendered.pictures.push(layer);
        }
        if !self.job.aovs.is_empty() {
            self.aovs(&mut rendered)?;
        }
        Ok(rendered)
    }

    fn color(&self, rendered: &mut Rendered) -> Result<Layer, RenderError> {
        let (job, window) = (self.job, self.job.window());
        let raster = raster(self.world, job.width, job.height);
        let layer = |seen: Vec<(Color, f32)>| {
            let (pixels, coverage) = seen.into_iter().unzip();
            let image = Image::from_pixels(window.width, window.height, pixels)?;
            Ok(Layer::color("color", image).with_coverage(coverage))
        };
        match job.sampling {
            Sampling::Center => {
                let color = |pixel, rays: &mut Rays| match center_ray(self.world, &raster, pixel) {
                    Some(ray) => (self.whitted.radiance(&ray, rays), 1.0),
                    None => (Vec3::ZERO, 0.0),
                };
                let mut pixels = self.pixels(|x, y, rays| color((x, y), rays))?;
                if self.world.rules.has(Compat::StaleTexels) {
                    self.stale_texels(&raster, &mut pixels)?;
                }
                layer(pixels)
            }
            Sampling::Filtered { samples, filter } => {
                let warp = filter.sampler();
                let tiles = self.tiles(|tile, rays| {
                    let mut film = Film::window(tile.left, tile.top, tile.width, tile.height);
                    for (x, y) in places(tile) {
                        for sample in 0..samples {
                            self.check()?;
                            let position = Sampler::Sobol.pixel_position(job.seed, x, y, sample, samples);
                            let (offset, weight) = warp.sample(position);
                            let lens = self.lens(Sampler::Sobol, x, y, sample);
                            let ray = camera_ray(self.world, &raster, (x, y), center(x, y) + offset, lens);
                            let color = ray.map(|ray| self.whitted.radiance(&ray, rays));
                            film.add_if_seen(x, y, sample, color, weight);
                        }
                    }
                    // No sample counts for another tile, so the tile is finished, and its sums need no memory any more.
                    let pixels = places(tile).map(|(x, y)| (film.resolve(x, y), film.coverage(x, y))).collect();
                    Ok(Tile { pixels, rejected: film.rejected(), first_rejected: film.first_rejected().to_vec() })
                })?;
                rendered.rejected = tiles.iter().map(|(_, tile)| tile.rejected).sum();
                rendered.first_rejected = tiles.iter().flat_map(|(_, tile)| &tile.first_rejected).copied().collect();
                rendered.first_rejected.sort();
                rendered.first_rejected.truncate(16);
                layer(self.assemble(tiles.into_iter().map(|(part, tile)| (part, tile.pixels))))
            }
            Sampling::Course2004 { sampler, samples, filter } => self.course(|pass| {
                let pixels = self.stored(pass, sampler, samples)?.try_reconstruct(filter, || self.check())?;
                self.cropped(job.width, job.height, pixels)
            }),
            Sampling::Course2012 { jitter, blur } => self.course(|pass| self.course_2012(pass, jitter, blur)),
        }
    }

    /// A picture of the course's films, and where the camera is blind somewhere, a second one of what it sees.
    fn course(&self, picture: impl Fn(&Pass) -> Result<Image, RenderError>) -> Result<Layer, RenderError> {
        let pass = Pass::default();
        let layer = Layer::color("color", picture(&pass)?);
        if !pass.blind.into_inner() {
            return Ok(layer);
        }
        let mask = picture(&Pass { mask: true, ..Pass::default() })?;
        Ok(layer.with_coverage(mask.pixels.iter().map(|share| share.x.clamp(0.0, 1.0)).collect()))
    }

    /// Where in the lens a sample lies. A lens without extent needs no numbers.
    fn lens(&self, sampler: Sampler, x: u32, y: u32, sample: u32) -> Vec2 {
        match self.world.camera.has_aperture() {
            true => sampler.lens_position(self.job.seed, x, y, sample),
            false => Vec2::splat(0.5),
        }
    }

    /// Replaces the ambient light on textures by that of the pixel shaded before with the same material.
    fn stale_texels(&self, raster: &Raster, pixels: &mut [(Color, f32)]) -> Result<(), RenderError> {
        let (world, window) = (self.world, self.job.window());
        let mut last: Vec<Option<Color>> = vec![None; world.materials.len()];
        for y in (window.top..window.top + window.height).rev() {
            self.check()?;
            for x in window.left..window.left + window.width {
                let Some(ray) = center_ray(world, raster, (x, y)) else { continue };
                let Some(hit) = world.closest(&ray, &mut ()) else { continue };
                let material = world.material(&hit);
                let Material::Phong(phong) = &world.materials[material as usize] else { continue };
                let texel = self.whitted.diffuse_color(phong, &world.surface(&ray, &hit));
                let before = last[material as usize].replace(texel).unwrap_or(phong.diffuse);
                let pixel = (y - window.top) * window.width + (x - window.left);
                pixels[pixel as usize].0 += world.ambient * (before - texel);
            }
        }
        Ok(())
    }

    /// `-jitter` and `-filter` of 2012. Blur without jitter works on the picture as it is.
    fn course_2012(&self, pass: &Pass, jitter: bool, blurred: bool) -> Result<Image, RenderError> {
        let (job, scale) = (self.job, if jitter { 3 } else { 1 });
        let (width, height) = (job.width * scale, job.height * scale);
        let raster = raster(self.world, width, height);
        let sample = |x: u32, y: u32, _: u32| {
            let place = if jitter { jittered_position(job.seed, x, y) } else { Vec2::new(x as f32, y as f32) };
            let lens = self.lens(Sampler::Random, x, y, 0);
            let ray = camera_ray(self.world, &raster, (x, y), place + 0.5, lens);
            Ok(StoredSample { position: place, color: self.kept(pass, ray, true)? })
        };
        let mut pixels = self.keep(width, height, 1, sample)?.try_reconstruct(None, || self.check())?;
        if blurred {
            pixels = blur(&pixels, width, height);
        }
        self.check()?;
        if jitter {
            pixels = average_3x3(&pixels, width, height);
        }
        self.cropped(job.width, job.height, pixels)
    }

    fn stored(&self, pass: &Pass, sampler: Sampler, samples: u32) -> Result<StoredSamples, RenderError> {
        let (job, samples) = (self.job, sampler.round_up(samples));
        let raster = raster(self.world, job.width, job.height);
        self.keep(job.width, job.height, samples, |x, y, sample| {
            let position = sampler.pixel_position(job.seed, x, y, sample, samples);
            let (place, lens) = (Vec2::new(x as f32, y as f32) + position, self.lens(sampler, x, y, sample));
            let ray = camera_ray(self.world, &raster, (x, y), place, lens);
            Ok(StoredSample { position, color: self.kept(pass, ray, sample + 1 == samples)? })
        })
    }

    /// Takes samples that are kept, if there are not too many.
    fn keep(
        &self,
        width: u32,
        height: u32,
        samples: u32,
        sample: impl Fn(u32, u32, u32) -> Result<StoredSample, RenderError> + Sync,
    ) -> Result<StoredSamples, RenderError> {
        let count = u64::from(width).saturating_mul(u64::from(height)).saturating_mul(u64::from(samples));
        if count > MOST_KEPT {
            return Err(RenderError::TooManySamples(count));
        }
        StoredSamples::try_take(width, height, samples, sample)
    }

    /// The colour of a sample that is kept; the last one of a pixel counts it as done.
    fn kept(&self, pass: &Pass, ray: Option<Ray>, last: bool) -> Result<Color, RenderError> {
        self.check()?;
        if pass.mask {
            return Ok(if ray.is_some() { Vec3::ONE } else { Vec3::ZERO });
        }
        let mut rays = Rays::default();
        let color = ray.map(|ray| self.whitted.radiance(&ray, &mut rays));
        if color.is_none() {
            pass.blind.store(true, Relaxed);
        }
        self.control.done.fetch_add(u64::from(last), Relaxed);
        self.control.rays.fetch_add(rays.0, Relaxed);
        Ok(color.unwrap_or(Vec3::ZERO))
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
        let tiles = self.tiles(|tile, rays| {
            let value = |(x, y)| self.check().map(|()| value(x, y, rays));
            places(tile).map(value).collect::<Result<Vec<T>, _>>()
        })?;
        Ok(self.assemble(tiles))
    }

    /// Puts the pixels of tiles into those of the window.
    fn assemble<T: Copy + Default>(&self, tiles: impl IntoIterator<Item = (Crop, Vec<T>)>) -> Vec<T> {
        let window = self.job.window();
        let mut pixels = vec![T::default(); window.width as usize * window.height as usize];
        for (tile, values) in tiles {
            for ((x, y), value) in places(tile).zip(values) {
                pixels[((y - window.top) * window.width + (x - window.left)) as usize] = value;
            }
        }
        pixels
    }

    /// Cuts the window into tiles and makes them in parallel.
    fn tiles<T: Send>(
        &self,
        make: impl Fn(Crop, &mut Rays) -> Result<T, RenderError> + Sync,
    ) -> Result<Vec<(Crop, T)>, RenderError> {
        let window = self.job.window();
        let columns = window.width.div_ceil(TILE);
        let count = columns * window.height.div_ceil(TILE);
        (0..count)
            .into_par_iter()
            .map(|i| {
                let (x, y) = (i % columns * TILE, i / columns * TILE);
                let (width, height) = (TILE.min(window.width - x), TILE.min(window.height - y));
                let tile = Crop { left: window.left + x, top: window.top + y, width, height };
                let mut rays = Rays::default();
                let made = make(tile, &mut rays)?;
                // What was made after a cancel means nothing.
                self.check()?;
                self.control.done.fetch_add(u64::from(width * height), Relaxed);
                self.control.rays.fetch_add(rays.0, Relaxed);
                Ok((tile, made))
            })
            .collect()
    }

    /// The other pictures: one ray through each pixel's centre.
    fn aovs(&self, rendered: &mut Rendered) -> Result<(), RenderError> {
        let (job, world, window) = (self.job, self.world, self.job.window());
        let raster = raster(world, job.width, job.height);
        let cost_wanted = job.aovs.iter().any(|aov| aov.name == "cost");
        let seen = self.pixels(|x, y, rays| {
            let Some(ray) = center_ray(world, &raster, (x, y)) else {
                return Some(Seen { covered: false, hit: None, material: 0, counts: Counts::default() });
            };
            let hit = world.closest(&ray, rays).map(|hit| (hit, world.surface(&ray, &hit)));
            let mut counts = Counts::default();
            if cost_wanted {
                self.whitted.radiance(&ray, &mut counts);
            }
            let material = hit.map_or(0, |(hit, _)| world.material(&hit));
            Some(Seen { covered: true, hit, material, counts })
        })?;
        let seen: Vec<Seen> = seen.into_iter().flatten().collect();
        let hits = || seen.iter().filter_map(|seen| seen.hit.as_ref());
        let least = hits().map(|(hit, _)| hit.t).fold(f32::INFINITY, f32::min);
        let greatest = hits().map(|(hit, _)| hit.t).fold(f32::NEG_INFINITY, f32::max);
        // A range that whole numbers cannot tell apart is left as it is.
        let whole = |(min, max): (f32, f32)| match world.rules.has(Compat::WholeDepths) && min.trunc() != max.trunc() {
            true => (min.trunc(), max.trunc()),
            false => (min, max),
        };
        let display = Display {
            rules: &world.rules,
            depth_range: job
                .depth_range
                .map(whole)
                .unwrap_or((least, if greatest > least { greatest } else { least + 1.0 })),
            positions: Aabb::around(hits().map(|(_, surface)| surface.position)),
            greatest_cost: seen.iter().map(|s| (s.counts.nodes + s.counts.tests) as f32).fold(0.0, f32::max),
        };
        for aov in &job.aovs {
            let values: Vec<Vec3> = seen.iter().map(aov.value).collect();
            let color = |(v, seen): (&Vec3, &Seen)| match seen.covered {
                true => (aov.picture)(*v, seen.hit.is_some(), &display),
                false => Vec3::ZERO,
            };
            let mut picture: Vec<Color> = values.iter().zip(&seen).map(color).collect();
            if aov.name == "normals" && world.rules.has(Compat::StaleNormals) {
                let hits: Vec<bool> = seen.iter().map(|seen| seen.hit.is_some()).collect();
                fill_from_last_hit(&mut picture, &hits, window.width as usize);
            }
            let picture = Image::from_pixels(window.width, window.height, picture)?;
            let values = Image::from_pixels(window.width, window.height, values)?;
            let coverage: Vec<f32> = seen.iter().map(|seen| f32::from(seen.covered)).collect();
            rendered.layers.push(Layer::data(aov.name, values).with_coverage(coverage.clone()));
            rendered.pictures.push(Layer::data(aov.name, picture).with_coverage(coverage));
        }
        Ok(())
    }
}

/// A finished part of a picture.
struct Tile {
    /// Colour and coverage of each pixel.
    pixels: Vec<(Color, f32)>,
    rejected: u64,
    first_rejected: Vec<Rejected>,
}

fn center(x: u32, y: u32) -> Vec2 {
    Vec2::new(x as f32 + 0.5, y as f32 + 0.5)
}

/// The pixels of a part, in reading order.
fn places(part: Crop) -> impl Iterator<Item = (u32, u32)> {
    (part.top..part.top + part.height).flat_map(move |y| (part.left..part.left + part.width).map(move |x| (x, y)))
}
