//! Partial render: exact sums, with a record of the work they contain.

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

/// Picture, or shard of one, while it is being rendered. It can be rendered in steps, saved, loaded
/// and merged with other parts.
///
/// It locks internally, so one thread can render while others read it.
#[derive(Debug)]
pub struct PartialRender {
    pub(super) job: Job,
    pub(super) shard: Shard,
    pub(super) scene: Digest,
    pub(super) display: DisplayRules,
    /// Blocks of the window for colour samples.
    pub(super) blocks: Blocks,
    /// Blocks of the window for centre rays.
    pub(super) ray_blocks: Blocks,
    state: Mutex<PartialState>,
    /// Number of times that `state` was locked.
    #[cfg(test)]
    pub(super) locked: std::sync::atomic::AtomicU64,
}

/// Results of a [`PartialRender`] so far, block by block.
#[derive(Clone, Debug, Default)]
pub(super) struct PartialState {
    /// Colour samples of each block.
    pub(super) samples: Vec<BlockSamples>,
    /// Results of the centre rays of each block; `None` if not yet traced.
    pub(super) rays: Vec<Option<Box<BlockAovs>>>,
}

/// Colour samples of one block of 8 x 8 pixels in a [`PartialRender`].
#[derive(Clone, Debug, Default)]
pub(super) struct BlockSamples {
    /// First sample of each pixel in the film.
    pub(super) from: u32,
    /// End (exclusive) of each pixel's samples in the film.
    pub(super) to: u32,
    /// Number of rays traced for the samples.
    pub(super) rays: u64,
    /// Sums of the samples; `None` if there are none. Shared, so that readers hold the lock only to
    /// clone the pointer.
    pub(super) film: Option<Arc<PackedFilm>>,
    /// Variances of the pixels' means, once the pilot is complete (adaptive sampling).
    pub(super) variances: Option<Arc<[f32]>>,
    /// Final number of samples of each pixel, once it is decided (adaptive sampling). `to` is then
    /// an average over the picture.
    pub(super) targets: Option<Arc<[u32]>>,
}

impl BlockSamples {
    /// Returns the number of samples of a pixel when the average is `end`.
    pub(super) fn count(&self, job: &Job, pixel: usize, end: u32) -> u32 {
        self.targets.as_ref().map_or(end, |targets| count(job.sampling.samples(), targets[pixel], end))
    }

    /// Returns the number of samples of all pixels in the block when the average is `end`, not
    /// counting those before `from`.
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

/// AOV values from the centre rays of one block in a [`PartialRender`].
#[derive(Clone, Debug, PartialEq)]
pub(super) struct BlockAovs {
    /// Outcome of the ray of each pixel.
    pub(super) hits: Vec<PrimaryHit>,
    /// Values of all pixels for the first AOV, then for the second, and so on.
    pub(super) values: Vec<Vec3>,
    /// Number of rays traced for the values.
    pub(super) rays: u64,
}

/// Outcome of the ray through a pixel's centre.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(super) enum PrimaryHit {
    /// The camera has no ray there.
    NoRay,
    /// The ray hits nothing.
    Nothing,
    /// The ray hits something.
    Hit,
}

/// Numbers of samples, rays and rejected samples of a picture, independent of how it was rendered.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Number of samples in the picture.
    pub samples: u64,
    /// Number of rays traced, including secondary rays.
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
    /// [`RenderError::Job`], [`RenderError::Image`], [`RenderError::CropOutside`] and
    /// [`RenderError::NoMemory`]; [`RenderError::Shard`] and [`RenderError::Adaptive`] if the job
    /// cannot be divided or sampled like this.
    pub fn new(world: &World, job: &Job, shard: Shard) -> Result<Self, RenderError> {
        PartialRender::empty(job.clone(), shard, world.digest(), world.display_rules())
    }

    /// Creates an empty part of a picture of the scene with this hash.
    pub(super) fn empty(job: Job, shard: Shard, scene: Digest, display: DisplayRules) -> Result<Self, RenderError> {
        job.validate()?;
        let window = job.window();
        let inside =
            |start: u32, length: u32, size: u32| length > 0 && start.checked_add(length).is_some_and(|end| end <= size);
        if !inside(window.left, window.width, job.width) || !inside(window.top, window.height, job.height) {
            return Err(RenderError::CropOutside(job.width, job.height));
        }
        // Reject oversized windows before any computation. The full picture may be larger.
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

    /// Returns the hash of the scene, including the files that it uses.
    pub fn scene(&self) -> Digest {
        self.scene
    }

    /// Returns a hash of everything that determines the picture: the scene, the job and the program
    /// version.
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

    /// Returns the amounts of total and finished work, in samples and centre rays. A noise
    /// threshold can end the work early.
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

    /// Returns the numbers of samples, rays and rejected samples so far.
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

    /// Returns the visible error so far, as a root mean square over the pixels. It is compared with
    /// [`Job::noise`]. `None` unless each pixel has at least two samples.
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

    /// Returns a hash of the film: all sums and AOV values except the cost. Equal pictures have
    /// equal hashes, however they were rendered.
    pub fn hash(&self) -> Digest {
        let mut hasher = blake3::Hasher::new();
        self.hash_into(&mut hasher);
        Digest(hasher.finalize().into())
    }

    /// Continues the hash of a picture with this part, which must consist of complete rows of
    /// blocks.
    pub(super) fn hash_into(&self, hasher: &mut blake3::Hasher) {
        let (state, mut bytes) = (self.state(), Vec::new());
        for (index, block) in state.samples.iter().enumerate() {
            let rect = self.blocks.rect(index);
            block.film(rect).unwrap_or_else(|| film_of(rect)).write(&mut bytes);
            hasher.update(&bytes);
            bytes.clear();
        }
        // Exclude the cost, which depends on the acceleration structure.
        let names: Vec<&str> = self.job.ray_aovs().map(|(aov, _)| aov.name).collect();
        for block in state.rays.iter().flatten() {
            let values = block.values.chunks(block.hits.len()).zip(&names).filter(|(_, name)| **name != "cost");
            for value in values.flat_map(|(values, _)| values).flat_map(|value| value.to_array()) {
                hasher.update(&value.to_bits().to_le_bytes());
            }
        }
    }

    /// Returns the final number of samples in the sums of a pixel. It is 1 if samples affect
    /// several pixels, because only finished pixels are stored.
    pub(super) fn packed_samples(&self) -> u32 {
        if self.job.sampling.is_local() { self.job.sampling.samples() } else { 1 }
    }

    /// Returns the peak memory in bytes, including that of the finished pictures.
    pub fn bytes_needed(job: &Job, shard: Shard) -> u64 {
        let share = if shard.by == ShardBy::Tiles { u64::from(shard.count) } else { 1 };
        let (pixels, rays) = (job.window().pixels(), job.ray_window().pixels());
        let sums = if job.wants_samples() { PackedFilm::pixel_bytes(job.sampling.samples()) } else { 0 };
        // Sample counts and variances of each pixel.
        let sums = if job.adaptive { sums + 24 } else { sums };
        let values = 12 * job.ray_aovs().count() as u64 + 1;
        // Colours with coverage, an eight-bit copy and the file. AOVs have both values and colours.
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

/// Returns an error if the job cannot be divided into shards like this.
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
            refuse("these samples affect several pixels: split the picture by tiles".into())
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

/// Returns the passes of a shard, given by the numbers of samples at which they end. With photon
/// mapping, each sample is a pass, because it needs its own photons.
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
