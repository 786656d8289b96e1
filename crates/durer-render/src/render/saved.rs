//! File format of partial renders, for checkpoints, shards and merged pictures.
//!
//! | bytes | content |
//! | --- | --- |
//! | 8 | `DURERPRT` |
//! | number | version of this format |
//! | text | version of Dürer |
//! | 32 | hash of the scene |
//! | text, text, text | job, shard and look, as JSON |
//! | per block with samples | index + 1; first sample, end, rays; variances (adaptive); sums |
//! | number | 0 |
//! | for each block with rays | index + 1; rays; one byte per pixel: kind of hit; values |
//! | number | 0 |
//! | 32 | BLAKE3 of everything before |
//!
//! Numbers are encoded as in [`crate::film::bytes`]. A text is its length followed by its bytes.

use super::allocation::{half, max_samples, pilot};
use super::part::{BlockAovs, BlockSamples, PartialRender, PrimaryHit, film_of, job_text};
use super::{Job, RenderError, Shard};
use crate::film::PackedFilm;
use crate::film::bytes::{ByteReader, write_unsigned};
use durer_image::Content;
use durer_scene::math::Vec3;
use durer_scene::source::Digest;
use std::cmp::Ordering;
use std::io::{self, Write};
use std::ops::Range;
use std::sync::Arc;

const FORMAT: u32 = 1;
const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Error while reading a saved part of a render or combining it with another part.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PartError {
    /// The bytes are not a saved part of a render.
    #[error("it is not a part file")]
    NotAPart,
    /// The data is truncated or damaged.
    #[error("it is truncated or damaged: its checksum is wrong")]
    Damaged,
    /// The part was written by another version of Dürer.
    #[error("it was written by Dürer {0}, but this is Dürer {VERSION}, so the pictures could differ")]
    OtherVersion(String),
    /// The checksum is correct, but the content is invalid.
    #[error("it is malformed ({0})")]
    Malformed(String),
    /// The job in the file is invalid.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// The part belongs to another scene.
    #[error("it belongs to a different scene, or a file of the scene has changed")]
    OtherScene,
    /// The part belongs to another job.
    #[error("it belongs to a different job ({0})")]
    OtherJob(String),
}

fn put_text(out: &mut Vec<u8>, text: &str) {
    write_unsigned(out, text.len() as u128);
    out.extend(text.as_bytes());
}

fn text<'a>(bytes: &mut ByteReader<'a>) -> Option<&'a str> {
    let length = bytes.read_unsigned()?;
    std::str::from_utf8(bytes.take(length)?).ok()
}

/// Number of blocks that are written at once. The number limits how long the lock is held.
const CHUNK: usize = 256;

impl Content for PartialRender {
    /// Writes the part in chunks, because a complete copy would double the memory.
    fn write_to(&self, out: &mut dyn Write) -> io::Result<()> {
        let (mut hasher, mut bytes) = (blake3::Hasher::new(), self.header());
        let mut flush = |bytes: &mut Vec<u8>| {
            hasher.update(bytes);
            out.write_all(bytes)?;
            bytes.clear();
            io::Result::Ok(())
        };
        // Lock twice, because taking both locks in one expression would cause a deadlock.
        let samples = self.state().samples.len();
        let rays = self.state().rays.len();
        let chunks = |count: usize| (0..count).step_by(CHUNK).map(move |start| start..count.min(start + CHUNK));
        for blocks in chunks(samples) {
            self.put_samples(blocks, &mut bytes);
            flush(&mut bytes)?;
        }
        write_unsigned(&mut bytes, 0);
        for blocks in chunks(rays) {
            self.put_rays(blocks, &mut bytes);
            flush(&mut bytes)?;
        }
        write_unsigned(&mut bytes, 0);
        flush(&mut bytes)?;
        out.write_all(hasher.finalize().as_bytes())
    }
}

impl Content for &PartialRender {
    fn write_to(&self, out: &mut dyn Write) -> io::Result<()> {
        PartialRender::write_to(self, out)
    }
}

impl PartialRender {
    /// The first bytes of a saved part.
    pub const MAGIC: &[u8; 8] = b"DURERPRT";

    /// Serializes the part. Equal work produces equal bytes.
    pub fn write(&self) -> Vec<u8> {
        let mut out = Vec::new();
        self.write_to(&mut out).expect("writing to memory never fails");
        out
    }

    /// Returns all data that comes before the blocks.
    fn header(&self) -> Vec<u8> {
        let mut out = PartialRender::MAGIC.to_vec();
        write_unsigned(&mut out, FORMAT.into());
        put_text(&mut out, VERSION);
        out.extend(self.scene.0);
        put_text(&mut out, &job_text(&self.job));
        put_text(&mut out, &serde_json::to_string(&self.shard).unwrap_or_default());
        put_text(&mut out, &serde_json::to_string(&self.display).unwrap_or_default());
        out
    }

    /// Appends the samples of some blocks to the output.
    fn put_samples(&self, blocks: Range<usize>, out: &mut Vec<u8>) {
        let state = self.state();
        for index in blocks {
            let block = &state.samples[index];
            if let Some(film) = block.film(self.blocks.rect(index)) {
                write_unsigned(out, index as u128 + 1);
                [block.from.into(), block.to.into(), u128::from(block.rays)]
                    .iter()
                    .for_each(|&number| write_unsigned(out, number));
                let variances = block.variances.iter().flat_map(|variances| variances.iter());
                out.extend(variances.flat_map(|variance| variance.to_le_bytes()));
                film.write(out);
            }
        }
    }

    /// Appends the results of the centre rays of some blocks to the output.
    fn put_rays(&self, blocks: Range<usize>, out: &mut Vec<u8>) {
        let state = self.state();
        for index in blocks {
            if let Some(block) = &state.rays[index] {
                write_unsigned(out, index as u128 + 1);
                write_unsigned(out, block.rays.into());
                out.extend(block.hits.iter().map(|&found| found as u8));
                out.extend(block.values.iter().flat_map(|v| v.to_array()).flat_map(f32::to_le_bytes));
            }
        }
    }

    /// Reads a saved part.
    ///
    /// # Errors
    /// Returns [`PartError`] for data that was not written by [`PartialRender::write`] of this
    /// version.
    pub fn read(bytes: &[u8]) -> Result<PartialRender, PartError> {
        if !bytes.starts_with(PartialRender::MAGIC) {
            return Err(if PartialRender::MAGIC.starts_with(bytes) { PartError::Damaged } else { PartError::NotAPart });
        }
        let (content, digest) = bytes.split_last_chunk::<32>().ok_or(PartError::Damaged)?;
        if Digest::of(content).0 != *digest {
            return Err(PartError::Damaged);
        }
        let malformed = |what: &str| PartError::Malformed(what.into());
        let mut rest = ByteReader(&content[PartialRender::MAGIC.len().min(content.len())..]);
        let (format, version): (Option<u32>, _) = (rest.read_unsigned(), text(&mut rest));
        match (format, version) {
            (Some(FORMAT), Some(VERSION)) => {}
            (Some(_), Some(version)) => return Err(PartError::OtherVersion(version.into())),
            _ => return Err(malformed("its header is invalid")),
        }
        let scene = rest.take(32).and_then(|scene| scene.try_into().ok()).ok_or(malformed("its header is invalid"))?;
        let mut json = || text(&mut rest).ok_or(malformed("its header is invalid"));
        let (job, shard, display) = (json()?, json()?, json()?);
        let wrong = |error: serde_json::Error| PartError::Malformed(error.to_string());
        let job: Job = serde_json::from_str(job).map_err(wrong)?;
        let shard: Shard = serde_json::from_str(shard).map_err(wrong)?;
        let display = serde_json::from_str(display).map_err(wrong)?;
        // This rejects jobs that need far more memory than the size of the file justifies.
        let part = PartialRender::empty(job, shard, Digest(scene), display)?;
        part.read_blocks(rest).ok_or(malformed("its blocks are invalid"))?;
        if part.job.adaptive {
            part.allocate();
        }
        // Reject encodings that `write` would not produce.
        if part.write() != bytes {
            return Err(malformed("Dürer would encode the data differently"));
        }
        Ok(part)
    }

    /// Reads the samples and the results of the centre rays of all blocks. Returns `None` if the
    /// data is invalid.
    fn read_blocks(&self, mut rest: ByteReader) -> Option<()> {
        let (mut state, range) = (self.state(), self.shard.range(self.job.sampling.samples()));
        while let number @ 1.. = rest.read_unsigned::<usize>()? {
            let block = state.samples.get_mut(number - 1).filter(|block| block.film.is_none())?;
            let (from, to, rays): (u32, u32, u64) =
                (rest.read_unsigned()?, rest.read_unsigned()?, rest.read_unsigned()?);
            if from != range.0 || to <= from || to > range.1 || !self.shard.has_block(number - 1) {
                return None;
            }
            let (rect, samples) = (self.blocks.rect(number - 1), self.job.sampling.samples());
            let mut most_samples = to - from;
            let mut variances = None;
            if self.job.adaptive && to > half(samples) {
                let mut variance = || rest.float().filter(|variance| variance.is_finite() && *variance >= 0.0);
                variances = Some(rect.pixel_positions().map(|_| variance()).collect::<Option<_>>()?);
                most_samples = match to.cmp(&pilot(samples)) {
                    Ordering::Less => return None,
                    Ordering::Equal => to,
                    Ordering::Greater => max_samples(samples),
                };
            }
            let film = film_of(rect).read(&mut rest, most_samples)?;
            let film = Some(Arc::new(PackedFilm::new(film, self.packed_samples())));
            *block = BlockSamples { from, to, rays, variances, film, targets: None };
        }
        let pictures = self.job.ray_aovs().count();
        while let number @ 1.. = rest.read_unsigned::<usize>()? {
            let block = state.rays.get_mut(number - 1).filter(|block| block.is_none())?;
            let rays = rest.read_unsigned()?;
            let pixels = self.ray_blocks.rect(number - 1).pixels() as usize;
            let hit_of = |&byte: &u8| {
                [PrimaryHit::NoRay, PrimaryHit::Nothing, PrimaryHit::Hit].into_iter().find(|f| *f as u8 == byte)
            };
            let hits = rest.take(pixels)?.iter().map(hit_of).collect::<Option<_>>()?;
            let mut value = || Some(Vec3::new(rest.float()?, rest.float()?, rest.float()?));
            let values = (0..pixels * pictures).map(|_| value().filter(|v| v.is_finite())).collect::<Option<_>>()?;
            *block = Some(Box::new(BlockAovs { hits, values, rays }));
        }
        rest.0.is_empty().then_some(())
    }

    /// Checks that another part continues the work of this part, with the same scene, job and
    /// shard.
    ///
    /// # Errors
    /// Returns [`PartError::OtherScene`] or [`PartError::OtherJob`].
    pub fn same_work(&self, other: &PartialRender) -> Result<(), PartError> {
        self.same_picture(other)?;
        if self.shard != other.shard {
            return Err(PartError::OtherJob(format!("it is shard {} instead of {}", other.shard, self.shard)));
        }
        Ok(())
    }

    /// Checks that another part belongs to the same picture as this part.
    pub(super) fn same_picture(&self, other: &PartialRender) -> Result<(), PartError> {
        if self.scene != other.scene || self.display != other.display {
            return Err(PartError::OtherScene);
        }
        let (own, other) = (job_text(&self.job), job_text(&other.job));
        if own == other { Ok(()) } else { Err(PartError::OtherJob(first_difference(&own, &other))) }
    }
}

/// Describes the first parameter in which two jobs differ.
fn first_difference(own: &str, other: &str) -> String {
    let fields = |text: &str| serde_json::from_str::<serde_json::Map<_, _>>(text).unwrap_or_default();
    let (own, other) = (fields(own), fields(other));
    let differs = own.iter().find(|(name, value)| other.get(*name) != Some(value));
    let shown = |value: Option<&serde_json::Value>| value.map(ToString::to_string).unwrap_or_default();
    differs.map_or("it differs".into(), |(name, value)| {
        format!("its `{name}` is {} instead of {value}", shown(other.get(name)))
    })
}
