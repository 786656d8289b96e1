//! Rendering of a picture in many ways to verify that the result is always the same. The renders
//! differ in threads, tiles, shards, interruptions and acceleration structures.

use super::{Control, Job, MergeError, PartError, PartialRender, RenderError, RenderOutcome, Shard, ShardBy, merge};
use crate::world::World;
use durer_scene::sampler::hash;
use durer_scene::source::Digest;
use std::fmt;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// One way of rendering a picture, which must not affect the result. It determines the threads,
/// tiles, shards and interruptions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RenderVariant {
    /// Index of the world to render. All worlds contain the same scene but use different
    /// acceleration structures.
    pub world: usize,
    /// Number of threads.
    pub threads: usize,
    /// Width and height of a tile in pixels.
    pub tile: u32,
    /// Number of shards.
    pub shards: u32,
    /// The way in which the work is divided into shards.
    pub by: ShardBy,
    /// Number of times that the rendering of each shard is interrupted, saved and loaded again.
    pub interruptions: u32,
    /// Seed that determines when the render is interrupted and in which order parts are merged.
    pub seed: u64,
}

impl fmt::Display for RenderVariant {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let by = if self.by == ShardBy::Tiles { "tiles" } else { "samples" };
        write!(f, "{} threads, tiles of {}, ", self.threads, self.tile)?;
        write!(f, "{} shards by {by}, {} interruptions of each", self.shards, self.interruptions)
    }
}

/// Error while rendering a picture as a [`RenderVariant`] specifies.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum VariantError {
    /// The render failed.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// The saved part could not be read.
    #[error("cannot read the saved part: {0}")]
    PartialRender(#[from] PartError),
    /// The shards could not be merged.
    #[error("cannot merge the shards: {0}")]
    Merge(#[from] MergeError),
    /// The render was cancelled.
    #[error("cancelled")]
    Cancelled,
}

impl RenderVariant {
    /// Variant that renders everything at once on one thread.
    pub const PLAIN: RenderVariant =
        RenderVariant { world: 0, threads: 1, tile: 16, shards: 1, by: ShardBy::Tiles, interruptions: 0, seed: 0 };

    /// Returns the pseudo-random variant with the given number. The variant is suitable for the job
    /// and the number of worlds.
    pub fn numbered(number: u64, job: &Job, worlds: usize) -> RenderVariant {
        let pick = |dimension: u32, count: u64| hash(number, 0, 0, 0, dimension) % count.max(1);
        let samples = u64::from(job.sampling.samples());
        let blocks = (job.window().pixels() / 256).max(1);
        let by_samples = job.sampling.is_local() && job.noise.is_none() && !job.adaptive && pick(3, 2) == 1;
        let blocks = if job.adaptive { 1 } else { blocks };
        let (by, most) = if by_samples { (ShardBy::Samples, samples) } else { (ShardBy::Tiles, blocks) };
        RenderVariant {
            world: pick(0, worlds as u64) as usize,
            threads: [1, 2, 3, 4, 7][pick(1, 5) as usize],
            tile: [8, 16, 24, 32, 64, 200][pick(2, 6) as usize],
            // Half of the variants have a single shard.
            shards: if pick(4, 2) == 0 { 1 } else { 1 + pick(5, most.min(7)) as u32 },
            by,
            interruptions: [0, 0, 1, 3][pick(6, 4) as usize],
            seed: number,
        }
    }

    /// Renders the picture of a job as this variant specifies.
    ///
    /// # Errors
    /// Returns [`VariantError`].
    pub fn render_job(&self, world: &World, job: &Job, cancel: &AtomicBool) -> Result<PartialRender, VariantError> {
        let mut parts = Vec::new();
        for index in 1..=self.shards {
            let shard = Shard { index, count: self.shards, by: self.by };
            parts.push((shard.to_string(), self.shard(world, job, shard, cancel)?));
        }
        let first = hash(self.seed, 1, 0, 0, 0) as usize % parts.len();
        parts.rotate_left(first);
        Ok(if self.shards == 1 { parts.swap_remove(0).1 } else { merge(&parts)? })
    }

    /// Renders a shard. Interrupts the render several times after some tiles and continues from the
    /// saved part.
    fn shard(
        &self,
        world: &World,
        job: &Job,
        shard: Shard,
        cancel: &AtomicBool,
    ) -> Result<PartialRender, VariantError> {
        let mut part = PartialRender::new(world, job, shard)?;
        for round in (0..=self.interruptions).rev() {
            if cancel.load(Relaxed) {
                return Err(VariantError::Cancelled);
            }
            let some = hash(self.seed, 2, shard.index, round, 0) % 24;
            let control = Control {
                // Use a different number of threads after each interruption.
                threads: Some(1 + (self.threads + round as usize - 1) % 7),
                tile_size: Some(self.tile),
                max_tiles: (round > 0).then_some(some),
                ..Control::default()
            };
            if let RenderOutcome::Panicked(panicked) = part.render(world, &control, &mut |_, _| {})? {
                return Err(RenderError::Panic(panicked).into());
            }
            part = PartialRender::read(&part.write())?;
        }
        Ok(part)
    }
}

/// Difference between the expected film and the film of a [`RenderVariant`].
#[derive(Clone, Debug)]
pub struct FilmDifference {
    /// Hash of the expected film.
    pub expected: Digest,
    /// Hash of the film that the variant rendered.
    pub actual: Digest,
    /// Description of the first pixel that differs, if the difference is visible in a picture.
    pub place: String,
}

/// Compares two films of the same job. Returns `None` if they are equal.
pub fn compare(expected: &PartialRender, actual: &PartialRender) -> Option<FilmDifference> {
    let (one, other) = (expected.hash(), actual.hash());
    if one == other {
        return None;
    }
    let mut place = "no picture shows the difference".to_string();
    if let (Ok(a), Ok(b)) = (expected.pictures(), actual.pictures()) {
        let window = expected.job().window();
        for (a, b) in a.layers.iter().zip(&b.layers) {
            let pairs = a.image.pixels.iter().zip(&b.image.pixels).enumerate();
            let bits = |pixel: &durer_scene::math::Vec3| pixel.to_array().map(f32::to_bits);
            if let Some((i, (a_pixel, b_pixel))) = { pairs }.find(|(_, (a, b))| bits(a) != bits(b)) {
                let (x, y) = (window.left + i as u32 % window.width, window.top + i as u32 / window.width);
                place = format!("pixel {x},{y} of `{}`: {b_pixel:?} instead of {a_pixel:?}", a.name);
                break;
            }
        }
    }
    Some(FilmDifference { expected: one, actual: other, place })
}
