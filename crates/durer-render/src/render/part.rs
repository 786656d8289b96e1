//! Partial render, which stores exact sums and a record of the work that they contain.

use super::allocation::{self, count, half, pilot};
use super::blocks::{Blocks, Shard, ShardBy};
use super::error::RenderError;
use super::passes::{self, Passes};
use super::{Job, PixelRect, Sampling};
use crate::film::{Film, PackedFilm, Rejected};
use crate::world::{DisplayRules, World};
use durer_image::{can_allocate, checked_count};
use durer_scene::math::Vec3;
use durer_scene::source::Digest;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// A picture, or a shard of a picture, that is being rendered. It can be rendered in steps, saved,
/// loaded and merged with other parts.
///
/// The picture is locked internally, so one thread can render it while others read it.
#[derive(Debug)]
pub struct PartialRender {
    pub(super) job: Job,
    pub(super) shard: Shard,
    pub(super) scene: Digest,
    pub(super) display: DisplayRules,
    /// Blocks of the window that are rendered with colour samples.
    pub(super) blocks: Blocks,
    /// Blocks of the window in which centre rays are traced.
    pub(super) ray_blocks: Blocks,
    state: Mutex<PartialState>,
    /// Number of times that `state` has been locked.
    #[cfg(test)]
    pub(super) locked: std::sync::atomic::AtomicU64,
}

/// Current results of a [`PartialRender`], stored by block.
#[derive(Clone, Debug, Default)]
pub(super) struct PartialState {
    /// Colour samples of each block.
    pub(super) samples: Vec<BlockSamples>,
    /// Results of the centre rays of each block, or `None` if the rays have not been traced yet.
    pub(super) rays: Vec<Option<Box<BlockAovs>>>,
}

/// Colour samples of one block of 8 x 8 pixels in a [`PartialRender`].
#[derive(Clone, Debug, Default)]
pub(super) struct BlockSamples {
    /// Index of the first sample of each pixel in the film.
    pub(super) from: u32,
    /// End (exclusive) of the range of each pixel's samples in the film.
    pub(super) to: u32,
    /// Number of rays that were traced for the samples.
    pub(super) rays: u64,
    /// Sums of the samples, or `None` if there are no samples. The film is shared, so that readers
    /// hold the lock only while they clone the pointer.
    pub(super) film: Option<Arc<PackedFilm>>,
    /// Variances of the pixel means, which are known once the pilot samples are complete. They are
    /// used for adaptive sampling.
    pub(super) variances: Option<Arc<[f32]>>,
    /// Final number of samples of each pixel once it has been decided. It is used for adaptive
    /// sampling. `to` is then an average over the picture.
    pub(super) targets: Option<Arc<[u32]>>,
}

impl BlockSamples {
    /// Returns the number of samples of a pixel when the average over the picture is `end`.
    pub(super) fn count(&self, job: &Job, pixel: usize, end: u32) -> u32 {
        self.targets.as_ref().map_or(end, |targets| count(job.sampling.samples(), targets[pixel], end))
    }

    /// Returns the number of samples of all pixels in the block when the average over the picture
    /// is `end`. Samples before `from` are not counted.
    pub(super) fn total(&self, job: &Job, pixels: u64, end: u32) -> u64 {
        match &self.targets {
            None => pixels * u64::from(end - self.from),
            Some(targets) => (0..targets.len()).map(|pixel| u64::from(self.count(job, pixel, end))).sum(),
        }
    }

    /// Returns the unpacked film of the block, if there is one.
    pub(super) fn film(&self, PixelRect { left, top, width, height }: PixelRect) -> Option<Film> {
        self.film.as_ref().map(|film| film.film([left, top, width, height]))
    }
}

/// AOV values from the centre rays of one block of a [`PartialRender`].
#[derive(Clone, Debug, PartialEq)]
pub(super) struct BlockAovs {
    /// Result of tracing the ray of each pixel.
    pub(super) hits: Vec<PrimaryHit>,
    /// Values of all pixels for the first AOV, then for the second, and so on.
    pub(super) values: Vec<Vec3>,
    /// Number of rays that were traced for the values.
    pub(super) rays: u64,
}

/// Result of tracing the ray through the centre of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(super) enum PrimaryHit {
    /// The camera has no ray there.
    NoRay,
    /// The ray hits no surface.
    Nothing,
    /// The ray hits a surface.
    Hit,
}

/// Numbers of samples, rays and rejected samples of a picture. They do not depend on how the
/// picture was rendered.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Number of samples in the picture.
    pub samples: u64,
    /// Number of rays that were traced, including secondary rays.
    pub rays: u64,
    /// Number of samples that were rejected because they were not finite.
    pub rejected: u64,
    /// The first sixteen rejected samples, in reading order.
    pub first_rejected: Vec<Rejected>,
}

impl Statistics {
    /// Adds the counters of another part of the same picture.
    pub(super) fn add(&mut self, other: Statistics) {
        self.samples += other.samples;
        self.rays += other.rays;
        self.rejected = self.rejected.saturating_add(other.rejected);
        self.first_rejected.extend(other.first_rejected);
        self.first_rejected.sort();
        self.first_rejected.truncate(16);
    }
}

impl PartialRender {
    /// Creates an empty part of a picture.
    ///
    /// # Errors
    /// Returns [`RenderError::Job`], [`RenderError::Image`], [`RenderError::CropOutside`] or
    /// [`RenderError::NoMemory`]. Returns [`RenderError::Shard`] or [`RenderError::Adaptive`] if
    /// the job cannot be divided or sampled in this way.
    pub fn new(world: &World, job: &Job, shard: Shard) -> Result<Self, RenderError> {
        job.check_world(world)?;
        PartialRender::empty(job.clone(), shard, world.digest(), world.display_rules())
    }

    /// Creates an empty part of a picture of the scene with the given hash.
    pub(super) fn empty(job: Job, shard: Shard, scene: Digest, display: DisplayRules) -> Result<Self, RenderError> {
        job.validate()?;
        let window = job.window();
        let inside =
            |start: u32, length: u32, size: u32| length > 0 && start.checked_add(length).is_some_and(|end| end <= size);
        if !inside(window.left, window.width, job.width) || !inside(window.top, window.height, job.height) {
            return Err(RenderError::CropOutside(job.width, job.height));
        }
        // Reject windows that are too large before computing anything. The full picture may be
        // larger.
        checked_count(window.width, window.height)?;
        let (blocks, ray_blocks) = (Blocks::new(window), Blocks::new(job.ray_window()));
        check_shard(&job, shard, blocks.count())?;
        if job.adaptive
            && let Some(why) = allocation::reason_against(&job, shard == Shard::WHOLE)
        {
            return Err(RenderError::Adaptive(why));
        }
        let from = shard.range(job.sampling.samples()).0;
        let count = if job.wants_samples() { blocks.count() } else { 0 };
        let needed = (count * size_of::<BlockSamples>() + ray_blocks.count() * size_of::<Option<BlockAovs>>()) as u64;
        if !can_allocate(needed) {
            return Err(RenderError::NoMemory(needed));
        }
        let sampled = BlockSamples { from, to: from, ..BlockSamples::default() };
        let rays = if job.ray_aovs().next().is_some() { vec![None; ray_blocks.count()] } else { Vec::new() };
        let state = Mutex::new(PartialState { samples: vec![sampled; count], rays });
        Ok(PartialRender {
            job,
            shard,
            scene,
            display,
            blocks,
            ray_blocks,
            state,
            #[cfg(test)]
            locked: Default::default(),
        })
    }

    /// Returns the render job.
    pub fn job(&self) -> &Job {
        &self.job
    }

    /// Returns the shard that this part renders.
    pub fn shard(&self) -> Shard {
        self.shard
    }

    /// Returns the hash of the scene and of the files that it uses.
    pub fn scene(&self) -> Digest {
        self.scene
    }

    /// Returns a hash of everything that determines the picture, which is the scene, the job and
    /// the version of the program.
    pub fn identity(&self) -> Digest {
        identity(self.scene, &job_text(&self.job))
    }

    pub(super) fn state(&self) -> MutexGuard<'_, PartialState> {
        #[cfg(test)]
        self.locked.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns true if a block has all its samples. `gain` is the magnitude of the sample weights.
    pub(super) fn is_done(&self, index: usize, block: &BlockSamples, gain: f32) -> bool {
        let end = self.shard.range(self.job.sampling.samples()).1;
        let rect = self.blocks.rect(index);
        let enough = |film: Film| self.job.is_done(&film, rect, block.to, gain);
        block.to >= end || self.job.noise.is_some() && block.film(rect).is_some_and(enough)
    }

    /// Returns the magnitude of the sample weights.
    pub(super) fn gain(&self) -> f32 {
        match self.job.sampling {
            Sampling::Filtered { filter, .. } => filter.sampler().gain(),
            _ => 1.0,
        }
    }

    /// Returns the amounts of total and finished work, in samples and centre rays. With a noise
    /// threshold, the render can finish before all of it is done.
    pub fn work(&self) -> (u64, u64) {
        let range = self.shard.range(self.job.sampling.samples());
        let (mut all, mut done) = (0, 0);
        let state = self.state();
        for (index, block) in state.samples.iter().enumerate().filter(|(index, _)| self.shard.has_block(*index)) {
            let pixels = self.blocks.rect(index).pixels();
            all += block.total(&self.job, pixels, range.1);
            done += block.total(&self.job, pixels, block.to);
        }
        for (index, block) in state.rays.iter().enumerate().filter(|(index, _)| self.shard.has_rays(*index)) {
            let pixels = self.ray_blocks.rect(index).pixels();
            all += pixels;
            done += if block.is_some() { pixels } else { 0 };
        }
        (all, done)
    }

    /// Returns true if every pixel of the picture has data.
    pub fn is_whole(&self) -> bool {
        let state = self.state();
        state.samples.iter().all(|block| block.film.is_some()) && state.rays.iter().all(Option::is_some)
    }

    /// Returns true if this part has no work left.
    pub fn is_finished(&self) -> bool {
        let (gain, state) = (self.gain(), self.state());
        let mut samples = state.samples.iter().enumerate().filter(|(index, _)| self.shard.has_block(*index));
        let mut rays = state.rays.iter().enumerate().filter(|(index, _)| self.shard.has_rays(*index));
        samples.all(|(index, block)| self.is_done(index, block, gain)) && rays.all(|(_, block)| block.is_some())
    }

    /// Returns the current numbers of samples, rays and rejected samples.
    pub fn statistics(&self) -> Statistics {
        let state = self.state();
        let mut statistics = Statistics::default();
        for (index, block) in state.samples.iter().enumerate() {
            let samples = block.total(&self.job, self.blocks.rect(index).pixels(), block.to);
            statistics.rays += block.rays;
            let Some(film) = &block.film else { continue };
            let Some(film) = film.unpacked() else {
                statistics.samples += samples;
                continue;
            };
            statistics.samples += samples.saturating_sub(film.rejected());
            statistics.rejected = statistics.rejected.saturating_add(film.rejected());
            statistics.first_rejected.extend(film.first_rejected());
        }
        statistics.rays += state.rays.iter().flatten().map(|block| block.rays).sum::<u64>();
        statistics.first_rejected.sort();
        statistics.first_rejected.truncate(16);
        statistics
    }

    /// Returns the current visible error as a root mean square over the pixels. The error is
    /// compared with [`Job::noise`]. Returns `None` unless each pixel has at least two samples.
    pub fn noise(&self) -> Option<f64> {
        let (gain, state) = (self.gain(), self.state());
        let (mut squares, mut pixels) = (0.0, 0);
        for (index, block) in state.samples.iter().enumerate() {
            let rect = self.blocks.rect(index);
            let film = block.film(rect).filter(|_| block.to >= 2)?;
            let error = passes::error(&film, rect, gain);
            squares += error * error * rect.pixels() as f64;
            pixels += rect.pixels();
        }
        (pixels > 0).then(|| (squares / pixels as f64).sqrt())
    }

    /// Returns a hash of all sums and all AOV values except the cost. Equal pictures have equal
    /// hashes, regardless of how they were rendered.
    pub fn hash(&self) -> Digest {
        let mut hasher = blake3::Hasher::new();
        self.hash_into(&mut hasher);
        Digest(hasher.finalize().into())
    }

    /// Adds this part to the hash of a picture. The part must consist of complete rows of blocks.
    pub(super) fn hash_into(&self, hasher: &mut blake3::Hasher) {
        let (state, mut bytes) = (self.state(), Vec::new());
        for (index, block) in state.samples.iter().enumerate() {
            let rect = self.blocks.rect(index);
            block.film(rect).unwrap_or_else(|| film_of(rect)).write(&mut bytes);
            hasher.update(&bytes);
            bytes.clear();
        }
        // Exclude the cost, because it depends on the acceleration structure.
        let names: Vec<&str> = self.job.ray_aovs().map(|(aov, _)| aov.name).collect();
        for block in state.rays.iter().flatten() {
            let values = block.values.chunks(block.hits.len()).zip(&names).filter(|(_, name)| **name != "cost");
            for value in values.flat_map(|(values, _)| values).flat_map(|value| value.to_array()) {
                hasher.update(&value.to_bits().to_le_bytes());
            }
        }
    }

    /// Returns the final number of samples in the sums of a pixel. If samples affect several
    /// pixels, the number is 1, because only finished pixels are stored.
    pub(super) fn packed_samples(&self) -> u32 {
        if self.job.sampling.is_local() { self.job.sampling.samples() } else { 1 }
    }

    /// Returns the maximum memory in bytes, including the memory for the finished pictures.
    pub fn bytes_needed(job: &Job, shard: Shard) -> u64 {
        let share = if shard.by == ShardBy::Tiles { u64::from(shard.count) } else { 1 };
        let (pixels, rays) = (job.window().pixels(), job.ray_window().pixels());
        let sums = if job.wants_samples() { PackedFilm::pixel_bytes(job.sampling.samples()) } else { 0 };
        // Add the number of samples and the variance of each pixel.
        let sums = if job.adaptive { sums + 24 } else { sums };
        let values = 12 * job.ray_aovs().count() as u64 + 1;
        // Count colours with coverage, an eight-bit copy and the file. Each AOV has both values and
        // colours.
        let pictures = 24 * u64::from(job.color) + 40 * job.aovs.len() as u64;
        let stored = pixels.saturating_mul(sums).saturating_add(rays.saturating_mul(values));
        (stored / share).saturating_add(pixels.saturating_mul(pictures))
    }
}

/// Serializes a job for hashes, saved parts and picture attributes.
pub(super) fn job_text(job: &Job) -> String {
    serde_json::to_string(job).unwrap_or_default()
}

/// Returns the hash of a scene, a serialized job and the program version.
pub(super) fn identity(scene: Digest, job: &str) -> Digest {
    Digest::of(format!("durer {} {scene} {job}", env!("CARGO_PKG_VERSION")).as_bytes())
}

/// Returns an error if the job cannot be divided into shards in this way.
fn check_shard(job: &Job, shard: Shard, blocks: usize) -> Result<(), RenderError> {
    let refuse = |why: String| Err(RenderError::Shard(why));
    let samples = job.sampling.samples();
    if !(1..=shard.count).contains(&shard.index) {
        return refuse(format!("shard {shard} does not exist"));
    }
    match shard.by {
        ShardBy::Tiles if shard.count as usize > blocks => {
            refuse(format!("the picture has only {blocks} blocks of 8 x 8 pixels, too few for {} shards", shard.count))
        }
        ShardBy::Tiles => Ok(()),
        ShardBy::Samples if !job.sampling.is_local() => {
            refuse("each sample affects several pixels: split the picture by tiles".into())
        }
        ShardBy::Samples if job.noise.is_some() => {
            refuse("a noise threshold needs all samples of a pixel: split the picture by tiles".into())
        }
        ShardBy::Samples if shard.count > samples => {
            refuse(format!("{samples} samples per pixel are too few for {} shards", shard.count))
        }
        ShardBy::Samples => Ok(()),
    }
}

/// Creates a black film for a rectangle of the picture.
pub(super) fn film_of(part: PixelRect) -> Film {
    Film::window(part.left, part.top, part.width, part.height)
}

/// Returns the passes of a shard as the numbers of samples at which they end. With photon mapping,
/// each sample is a separate pass, because it needs its own photons.
pub(super) fn passes_of(job: &Job, shard: Shard) -> Passes<impl Iterator<Item = u32> + Send + use<>> {
    let samples = job.sampling.samples();
    let (from, to) = shard.range(samples);
    let singly = job.method.prepares() && job.sampling.is_local();
    let decides = job.adaptive.then(|| [half(samples), pilot(samples)]);
    let ends: Box<dyn Iterator<Item = u32> + Send> = match decides {
        _ if singly => Box::new(1..=samples),
        Some([half, pilot]) => {
            let rest = passes::ends(samples).filter(move |&end| end > pilot);
            Box::new(passes::ends(half).chain([pilot]).chain(rest))
        }
        None => Box::new(passes::ends(samples)),
    };
    let ends = ends.filter(move |&end| end > from && end < to).chain((to > from).then_some(to));
    // The noise threshold is checked at the end of each pass.
    Passes::new(ends, from, !singly && job.noise.is_none(), decides.unwrap_or_default())
}
