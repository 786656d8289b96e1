//! Rendering of pictures that do not fit into memory. They are rendered in bands of rows, and each
//! band is written and freed.

use super::{BLOCK, Control, Job, PartialRender, PixelRect, RenderError, RenderOutcome, Shard, Statistics};
use crate::world::World;
use durer_image::{Format, ImageError, RowLayout, WriteOptions};
use durer_scene::source::Digest;
use std::io::{self, Write};
use std::sync::atomic::Ordering::Relaxed;

/// Maximum size of a band in bytes. Larger bands would not render faster.
const MAX_BAND_BYTES: u64 = 256 << 20;

/// A render job whose colour picture is rendered in bands of rows to save memory.
#[derive(Debug)]
pub struct BandedRender {
    job: Job,
    /// Number of rows in a band, which is a multiple of [`BLOCK`].
    rows: u32,
}

/// Error while rendering a picture in bands and writing it.
#[derive(Debug, thiserror::Error)]
pub enum BandsError {
    /// The render failed.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// The format cannot store the picture.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// Writing failed.
    #[error(transparent)]
    Io(#[from] io::Error),
}

impl BandedRender {
    /// Divides the picture of a job into bands of at most `memory` bytes each.
    ///
    /// # Errors
    /// Returns [`RenderError::Bands`] if the job needs all pixels at once, and
    /// [`RenderError::Memory`] if the memory is too small for a single row of blocks.
    pub fn new(job: &Job, memory: u64) -> Result<Self, RenderError> {
        let refuse = |why: &str| Err(RenderError::Bands(why.into()));
        if !job.color || !job.aovs.is_empty() {
            return refuse("only the colour picture can be rendered in bands");
        }
        if !job.sampling.is_local() {
            return refuse("its samples affect several pixels");
        }
        if job.adaptive {
            return refuse("adaptive sampling needs the full picture");
        }
        let window = job.window();
        let bytes = |rows: u32| {
            let crop = PixelRect { height: rows.min(window.height), ..window };
            PartialRender::bytes_needed(&Job { crop: Some(crop), ..job.clone() }, Shard::WHOLE)
        };
        let fitting = memory.min(MAX_BAND_BYTES) / bytes(1).max(1) / u64::from(BLOCK) * u64::from(BLOCK);
        match u32::try_from(fitting).unwrap_or(u32::MAX / BLOCK * BLOCK) {
            0 => Err(RenderError::Memory { needed: bytes(BLOCK), allowed: memory }),
            rows => Ok(BandedRender { job: job.clone(), rows }),
        }
    }

    /// Returns the memory needed for a band, in bytes.
    pub fn bytes_needed(&self) -> u64 {
        self.crops().first().map_or(0, |crop| PartialRender::bytes_needed(&self.band(*crop), Shard::WHOLE))
    }

    /// Returns the bands from top to bottom. Their edges are block boundaries of the full picture.
    fn crops(&self) -> Vec<PixelRect> {
        let window = self.job.window();
        let (mut crops, mut top, end) = (Vec::new(), window.top, window.top + window.height);
        while top < end {
            let next = (top / BLOCK * BLOCK).saturating_add(self.rows).min(end);
            crops.push(PixelRect { top, height: next - top, ..window });
            top = next;
        }
        crops
    }

    /// Returns the job of one band.
    fn band(&self, crop: PixelRect) -> Job {
        Job { crop: Some(crop), ..self.job.clone() }
    }

    /// Renders the picture band by band and writes each band. Returns statistics and, for formats
    /// stored from top to bottom, the hash that [`PartialRender::hash`] would return for the full
    /// picture.
    ///
    /// # Errors
    /// Returns [`BandsError`]. The output is then incomplete.
    pub fn write(
        &self,
        world: &World,
        control: &Control,
        format: &Format,
        options: &WriteOptions,
        out: &mut dyn Write,
    ) -> Result<(Statistics, Option<Digest>), BandsError> {
        let window = self.job.window();
        let bottom_up = format.rows.is_some_and(|rows| rows.bottom_up);
        // Full coverage is known only after the last band. An alpha channel is therefore written
        // unless the camera is known to see something in every pixel.
        let (width, height, display) = (window.width, window.height, options.display);
        let strip = RowLayout { width, height, alpha: !has_all_rays(world, &self.job), display };
        let samples = u64::from(self.job.sampling.samples());
        control.total_work.store(window.pixels().saturating_mul(samples), Relaxed);
        let mut crops = self.crops();
        if bottom_up {
            crops.reverse();
        }
        format.write_rows(strip, out, |rows| {
            let (mut statistics, mut hasher) = (Statistics::default(), blake3::Hasher::new());
            for crop in crops {
                let part = PartialRender::new(world, &self.band(crop), Shard::WHOLE)?;
                match part.render(world, control, &mut |_, _| {})? {
                    RenderOutcome::Finished => {}
                    RenderOutcome::Cancelled | RenderOutcome::OutOfTime => return Err(RenderError::Cancelled.into()),
                    RenderOutcome::Panicked(panicked) => return Err(RenderError::from(panicked).into()),
                }
                part.hash_into(&mut hasher);
                statistics.add(part.statistics());
                part.try_strips(bottom_up, |pixels, coverage| rows.rows(pixels, coverage))?;
            }
            Ok((statistics, (!bottom_up).then(|| Digest(hasher.finalize().into()))))
        })
    }
}

/// Returns true if the camera has a ray at every point of a grid over the window, including its
/// corners.
fn has_all_rays(world: &World, job: &Job) -> bool {
    const ACROSS: u32 = 256;
    let (window, raster) = (job.window(), super::raster(world, job.width, job.height));
    let place =
        |i: u32, from: u32, length: u32| from + (u64::from(i) * u64::from(length - 1) / u64::from(ACROSS)) as u32;
    (0..=ACROSS).flat_map(|j| (0..=ACROSS).map(move |i| (i, j))).all(|(i, j)| {
        let pixel = (place(i, window.left, window.width), place(j, window.top, window.height));
        super::center_ray(world, &raster, pixel).is_some()
    })
}
