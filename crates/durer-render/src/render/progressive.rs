//! Progressive rendering for callers that show intermediate pictures.

use super::control::RunLimit;
use super::part::passes_of;
use super::{Control, Job, PartError, PartialRender, RenderError, RenderOutcome, Shard};
use crate::world::World;
use std::sync::atomic::Ordering::Relaxed;

/// Progress of a [`ProgressiveRender`] after a pass over all pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Progress {
    /// Current number of samples per pixel. Blocks below the noise threshold have fewer samples.
    pub samples: u32,
    /// Maximum number of samples per pixel.
    pub all_samples: u32,
    /// Number of rays that have been traced so far.
    pub rays: u64,
}

/// Render of a picture in passes that the caller controls. The passes and all bits of the result
/// are the same as those of [`PartialRender::render`].
pub struct ProgressiveRender {
    part: PartialRender,
    ends: Box<dyn Iterator<Item = u32> + Send>,
    /// End of the pass that was cancelled, if there is one.
    stopped: Option<u32>,
    is_over: bool,
}

impl std::fmt::Debug for ProgressiveRender {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.debug_struct("ProgressiveRender").field("job", self.part.job()).finish_non_exhaustive()
    }
}

impl ProgressiveRender {
    /// Creates an empty picture.
    ///
    /// # Errors
    ///
    /// See [`PartialRender::new`].
    pub fn new(world: &World, job: &Job) -> Result<Self, RenderError> {
        Self::with_shard(world, job, Shard::WHOLE)
    }

    /// Creates an empty picture of which only one shard will be rendered here. The other shards
    /// come from [`ProgressiveRender::absorb`].
    ///
    /// # Errors
    ///
    /// See [`PartialRender::new`].
    pub fn with_shard(world: &World, job: &Job, shard: Shard) -> Result<Self, RenderError> {
        let part = PartialRender::new(world, job, shard)?;
        Ok(ProgressiveRender { part, ends: Box::new(passes_of(job, shard)), stopped: None, is_over: false })
    }

    /// Copies the blocks of another shard, which may be unfinished, into this picture. Blocks that
    /// were absorbed before are replaced if the new ones have more samples.
    ///
    /// # Errors
    ///
    /// Returns [`PartError`] if the other part belongs to a different picture or is not another
    /// shard by tiles of the same division.
    pub fn absorb(&mut self, other: &PartialRender) -> Result<(), PartError> {
        self.part.absorb(other)
    }

    /// Renders the next pass. Returns `None` if the picture is finished or if the previous pass
    /// exceeded [`Control::time_limit`].
    ///
    /// # Errors
    ///
    /// Returns [`RenderError::Cancelled`] after [`Control::cancel`] or [`Control::max_tiles`].
    /// Returns [`RenderError::OtherScene`], [`RenderError::Memory`] or [`RenderError::Panic`] for
    /// other errors. Finished work is kept, and the next call continues it.
    pub fn next_pass(&mut self, world: &World, control: &Control) -> Result<Option<Progress>, RenderError> {
        if self.is_over {
            return Ok(None);
        }
        let Some(samples) = self.stopped.take().or_else(|| self.ends.next()) else {
            self.is_over = true;
            return Ok(None);
        };
        let outcome = self.part.render_to(world, control, &mut |_, _| {}, RunLimit::Pass(samples));
        let failed = match outcome? {
            RenderOutcome::Finished => {
                let all_samples = self.part.job().sampling.samples();
                return Ok(Some(Progress { samples, all_samples, rays: control.rays.load(Relaxed) }));
            }
            RenderOutcome::OutOfTime => {
                self.is_over = true;
                return Ok(None);
            }
            RenderOutcome::Cancelled => RenderError::Cancelled,
            RenderOutcome::Panicked(panicked) => panicked.into(),
        };
        // The next call repeats the pass for the missing blocks.
        self.stopped = Some(samples);
        Err(failed)
    }

    /// Returns the current state of the picture.
    pub fn part(&self) -> &PartialRender {
        &self.part
    }
}
