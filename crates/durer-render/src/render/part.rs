//! A partial render: exact sums, and a record of the work in them.

use super::allocation::{self, count, half, pilot};
use super::blocks::{Blocks, Shard, ShardBy};
use super::error::RenderError;
use super::passes::{self, Passes};
use super::{Crop, Job, Sampling};
use crate::film::{Film, PackedFilm, Rejected};
use crate::world::{DisplayRules, World};
use durer_image::{can_allocate, checked_count};
use durer_scene::math::Vec3;
use durer_scene::source::Digest;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// A picture in progress, or a shard of one. It can be rendered step by step, saved, read again,
/// and merged with others.
///
/// Uses interior locking, so that one thread can render while another reads it.
#[derive(Debug)]
pub struct PartialRender {
    pub(super) job: Job,
    pub(super) shard: Shard,
    pub(super) scene: Digest,
    pub(super) display: DisplayRules,
    /// Blocks of the colour's window, and of the centre rays' window.
    pub(super) blocks: Blocks,
    pub(super) ray_blocks: Blocks,
    state: Mutex<State>,
    /// Number of times the state was locked.
    #[cfg(test)]
    pub(super) locked: std::sync::atomic::AtomicU64,
}

/// Results so far.
#[derive(Clone, Debug, Default)]
pub(super) struct State {
    /// Samples of each block of the colour's window.
    pub(super) samples: Vec<BlockSamples>,
    /// Results of the centre rays of each block, if they were traced.
    pub(super) rays: Vec<Option<Box<BlockAovs>>>,
}

/// Samples of a block.
#[derive(Clone, Debug, Default)]
pub(super) struct BlockSamples {
    /// Half-open range of each pixel's samples in the film.
    pub(super) from: u32,
    pub(super) to: u32,
    /// Number of rays traced for them.
    pub(super) rays: u64,
    /// Sums of the samples, if there are any. Shared, so that a reader holds the lock only to clone
    /// the pointer.
    pub(super) film: Option<Arc<PackedFilm>>,
    /// Variances of its pixels' means, once the pilot is complete.
    pub(super) variances: Option<Arc<[f32]>>,
    /// Final number of samples of each pixel, once decided; `to` and other counts are then averages
    /// over the picture.
    pub(super) targets: Option<Arc<[u32]>>,
}

impl BlockSamples {
    /// Returns the number of samples of a pixel when the average is `end`.
    pub(super) fn count(&self, job: &Job, pixel: usize, end: u32) -> u32 {
        self.targets.as_ref().map_or(end, |targets| count(job.sampling.samples(), targets[pixel], end))
    }

    /// Returns the number of samples of all its pixels when the average is `end`, without those
    /// before `from`.
    pub(super) fn total(&self, job: &Job, pixels: u64, end: u32) -> u64 {
        match &self.targets {
            None => pixels * u64::from(end - self.from),
            Some(targets) => (0..targets.len()).map(|pixel| u64::from(self.count(job, pixel, end))).sum(),
        }
    }

    /// Returns the sums of the block, if there are any.
    pub(super) fn film(&self, Crop { left, top, width, height }: Crop) -> Option<Film> {
        self.film.as_ref().map(|film| film.film([left, top, width, height]))
    }
}

/// Results of the centre rays of a block.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct BlockAovs {
    /// Outcome of each pixel's ray.
    pub(super) found: Vec<PrimaryHit>,
    /// Values of each AOV, one AOV after the other.
    pub(super) values: Vec<Vec3>,
    /// Number of rays traced for them.
    pub(super) rays: u64,
}

/// Outcome of a centre ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(super) enum PrimaryHit {
    /// The camera has no ray there.
    Blind,
    /// The ray misses.
    Nothing,
    /// The ray hits something.
    Hit,
}

/// Counters of a picture, independent of how it was rendered.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Number of samples in the picture.
    pub samples: u64,
    /// Number of rays traced, including secondary rays.
    pub rays: u64,
    /// Number of samples that were rejected because they were not finite.
    pub rejected: u64,
    /// The first rejected samples.
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
    /// [`RenderError::Job`], [`RenderError::Image`], [`RenderError::CropOutside`], and
    /// [`RenderError::Shard`] if the work cannot be divided this way.
    pub fn new(world: &World, job: &Job, shard: Shard) -> Result<Self, RenderError> {
        PartialRender::empty(job.clone(), shard, world.digest(), world.display_rules())
    }

    pub(super) fn empty(job: Job, shard: Shard, scene: Digest, display: DisplayRules) -> Result<Self, RenderError> {
        job.validate()?;
        let window = job.window();
        let inside =
            |start: u32, length: u32, size: u32| length > 0 && start.checked_add(length).is_some_and(|end| end <= size);
        if !inside(window.left, window.width, job.width) || !inside(window.top, window.height, job.height) {
            return Err(RenderError::CropOutside(job.width, job.height));
        }
        // Refuse oversized windows before computing anything; a part of a larger picture is fine.
        checked_count(window.width, window.height)?;
        let (blocks, ray_blocks) = (Blocks::new(window), Blocks::new(job.ray_window()));
        check_shard(&job, shard, blocks.count())?;
        if job.adaptive
            && let Some(why) = allocation::refusal(&job, shard == Shard::WHOLE)
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
        let state = Mutex::new(State { samples: vec![sampled; count], rays });
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

    /// Returns the job.
    pub fn job(&self) -> &Job {
        &self.job
    }

    /// Returns the shard.
    pub fn shard(&self) -> Shard {
        self.shard
    }

    /// Returns the hash of the scene.
    pub fn scene(&self) -> Digest {
        self.scene
    }

    /// Returns the hash of everything that determines the picture: scene, job and program version.
    pub fn identity(&self) -> Digest {
        identity(self.scene, &job_text(&self.job))
    }

    pub(super) fn state(&self) -> MutexGuard<'_, State> {
        #[cfg(test)]
        self.locked.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns true if a block has all its samples; `gain` is the magnitude of the sample weights.
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

    /// Returns the total work and the finished work: samples and centre rays. A noise threshold may
    /// end it early.
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

    /// Returns true if no work is left.
    pub fn is_finished(&self) -> bool {
        let (gain, state) = (self.gain(), self.state());
        let mut samples = state.samples.iter().enumerate().filter(|(index, _)| self.shard.has_block(*index));
        let mut rays = state.rays.iter().enumerate().filter(|(index, _)| self.shard.has_rays(*index));
        samples.all(|(index, block)| self.is_done(index, block, gain)) && rays.all(|(_, block)| block.is_some())
    }

    /// Returns the counters.
    pub fn statistics(&self) -> Statistics {
        let state = self.state();
        let mut statistics = Statistics::default();
        for (index, block) in state.samples.iter().enumerate() {
            let taken = block.total(&self.job, self.blocks.rect(index).pixels(), block.to);
            statistics.rays += block.rays;
            let Some(film) = &block.film else { continue };
            let Some(film) = film.with_rejected() else {
                statistics.samples += taken;
                continue;
            };
            statistics.samples += taken.saturating_sub(film.rejected());
            statistics.rejected = statistics.rejected.saturating_add(film.rejected());
            statistics.first_rejected.extend(film.first_rejected());
        }
        statistics.rays += state.rays.iter().flatten().map(|block| block.rays).sum::<u64>();
        statistics.first_rejected.sort();
        statistics.first_rejected.truncate(16);
        statistics
    }

    /// Returns the visible error so far, which [`Job::noise`] limits: a root mean square over the
    /// pixels. `None` unless every pixel has two samples.
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

    /// Returns the hash of the film: all sums and values of its window. Equal pictures have equal
    /// hashes, however they were rendered; the cost is excluded.
    pub fn hash(&self) -> Digest {
        let mut hasher = blake3::Hasher::new();
        self.hash_into(&mut hasher);
        Digest(hasher.finalize().into())
    }

    /// Continues the hash of a picture with this part, whole rows of blocks.
    pub(super) fn hash_into(&self, hasher: &mut blake3::Hasher) {
        let (state, mut bytes) = (self.state(), Vec::new());
        for (index, block) in state.samples.iter().enumerate() {
            let rect = self.blocks.rect(index);
            block.film(rect).unwrap_or_else(|| film_of(rect)).write(&mut bytes);
            hasher.update(&bytes);
            bytes.clear();
        }
        // The cost depends on the acceleration structure.
        let names: Vec<&str> = self.job.ray_aovs().map(|(aov, _)| aov.name).collect();
        for block in state.rays.iter().flatten() {
            let values = block.values.chunks(block.found.len()).zip(&names).filter(|(_, name)| **name != "cost");
            for value in values.flat_map(|(values, _)| values).flat_map(|value| value.to_array()) {
                hasher.update(&value.to_bits().to_le_bytes());
            }
        }
    }

    /// Returns the final number of samples in a pixel's sums; 1 if samples affect several pixels,
    /// because sums are stored finished.
    pub(super) fn packed_samples(&self) -> u32 {
        if self.job.sampling.is_local() { self.job.sampling.samples() } else { 1 }
    }

    /// Returns the peak memory in bytes, including the pictures made from it.
    pub fn bytes_needed(job: &Job, shard: Shard) -> u64 {
        let share = if shard.by == ShardBy::Tiles { u64::from(shard.count) } else { 1 };
        let (pixels, rays) = (job.window().pixels(), job.ray_window().pixels());
        let sums = if job.wants_samples() { PackedFilm::pixel_bytes(job.sampling.samples()) } else { 0 };
        // Sample counts and variances of the pixels.
        let sums = if job.adaptive { sums + 24 } else { sums };
        let values = 12 * job.ray_aovs().count() as u64 + 1;
        // Colours with coverage, eight-bit copy, and file; AOVs have both values and colours.
        let pictures = 24 * u64::from(job.color) + 40 * job.aovs.len() as u64;
        let kept = pixels.saturating_mul(sums).saturating_add(rays.saturating_mul(values));
        (kept / share).saturating_add(pixels.saturating_mul(pictures))
    }
}

/// Serialises the job, for hashing, saving and picture attributes.
pub(super) fn job_text(job: &Job) -> String {
    serde_json::to_string(job).unwrap_or_default()
}

pub(super) fn identity(scene: Digest, job: &str) -> Digest {
    Digest::of(format!("durer {} {scene} {job}", env!("CARGO_PKG_VERSION")).as_bytes())
}

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

/// Returns a black film of a part of a picture.
pub(super) fn film_of(part: Crop) -> Film {
    Film::window(part.left, part.top, part.width, part.height)
}

/// Returns the passes of a shard, by the ends of their samples. Photons are traced again for each
/// sample, so each sample is a pass.
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
    // A noise threshold is evaluated at the end of each pass.
    Passes::new(ends, from, !singly && job.noise.is_none(), decides.unwrap_or_default())
}
