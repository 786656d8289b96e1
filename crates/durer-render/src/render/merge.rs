//! Merging of shards into a full picture.

use super::blocks::{Shard, ShardBy};
use super::part::{BlockSamples, PartialRender};
use super::saved::PartError;
use crate::film::PackedFilm;
use std::fmt::Write;
use std::sync::Arc;

/// Error while merging parts of a render. It identifies the parts by their names.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MergeError {
    /// No parts were given.
    #[error("give at least one part to merge")]
    NoParts,
    /// A part does not belong to the same picture as the first part.
    #[error("`{name}` cannot be merged with `{first}`: {error}")]
    Foreign {
        /// Name of the part.
        name: String,
        /// Name of the first part.
        first: String,
        /// Difference between the pictures.
        error: PartError,
    },
    /// Two parts contain the same work.
    #[error("`{first}` and `{second}` overlap: both have {what}")]
    Overlap {
        /// Name of one part.
        first: String,
        /// Name of the other part.
        second: String,
        /// Description of the work that both parts contain.
        what: String,
    },
    /// Some work is not contained in any part.
    #[error("parts of the picture are missing:\n{0}")]
    Missing(String),
    /// The merged picture would be too large.
    #[error(transparent)]
    PartialRender(#[from] PartError),
}

/// Maximum number of missing pieces of work that an error lists.
const LISTED: usize = 8;

/// Merges parts into the full picture. The result is bit-identical to a single render, regardless
/// of the order of the parts.
///
/// # Errors
/// Returns [`MergeError`] if the parts belong to different pictures, overlap, or do not contain all
/// the work.
pub fn merge(parts: &[(String, PartialRender)]) -> Result<PartialRender, MergeError> {
    let ((first, start), rest) = parts.split_first().ok_or(MergeError::NoParts)?;
    for (name, part) in rest {
        let foreign = |error| MergeError::Foreign { name: name.clone(), first: first.clone(), error };
        start.same_picture(part).map_err(foreign)?;
    }
    let whole =
        PartialRender::empty(start.job.clone(), Shard::WHOLE, start.scene, start.display).map_err(PartError::from)?;
    let mut missing = String::new();
    merge_samples(parts, &whole, &mut missing)?;
    merge_rays(parts, &whole, &mut missing)?;
    if missing.is_empty() {
        Ok(whole)
    } else {
        Err(MergeError::Missing((shards_missing(parts) + &missing).trim_end().into()))
    }
}

impl PartialRender {
    /// Copies the blocks of another shard by tiles into this part, which is a shard of the same
    /// division.
    pub(super) fn absorb(&mut self, other: &PartialRender) -> Result<(), PartError> {
        self.same_picture(other)?;
        let (own, foreign) = (self.shard, other.shard);
        if [own.by, foreign.by] != [ShardBy::Tiles; 2] || own.count != foreign.count || own.index == foreign.index {
            return Err(PartError::Malformed(format!("shard {foreign} does not complete shard {own}")));
        }
        let (mut state, other) = (self.state(), other.state());
        for (index, (block, new)) in state.samples.iter_mut().zip(&other.samples).enumerate() {
            if foreign.has_block(index) && new.to > block.to {
                *block = new.clone();
            }
        }
        for (block, new) in state.rays.iter_mut().zip(&other.rays) {
            if new.is_some() {
                block.clone_from(new);
            }
        }
        Ok(())
    }
}

/// Merges the samples of all parts into `whole`. Describes missing samples in `missing`.
fn merge_samples(
    parts: &[(String, PartialRender)],
    whole: &PartialRender,
    missing: &mut String,
) -> Result<(), MergeError> {
    let mut gaps = Vec::new();
    let (samples, gain) = (whole.job.sampling.samples(), whole.gain());
    let mut state = whole.state();
    for (index, merged) in state.samples.iter_mut().enumerate() {
        // Data of the block in each part, sorted by the range of samples.
        let mut pieces: Vec<(&str, BlockSamples)> = Vec::new();
        for (name, part) in parts {
            let piece = part.state().samples[index].clone();
            pieces.extend((piece.to > piece.from).then_some((name.as_str(), piece)));
        }
        pieces.sort_by_key(|(_, piece)| piece.from);
        let rect = whole.blocks.rect(index);
        if let Some(pair) = pieces.windows(2).find(|pair| pair[1].1.from < pair[0].1.to) {
            let what = format!("sample {} of pixel {},{}", pair[1].1.from, rect.left, rect.top);
            let [first, second] = [pair[0].0, pair[1].0].map(String::from);
            return Err(MergeError::Overlap { first, second, what });
        }
        let mut next = 0;
        for (_, piece) in pieces {
            if piece.from > next {
                gaps.push((rect, next, piece.from));
            }
            next = piece.to;
            merged.rays += piece.rays;
            merged.variances = merged.variances.take().or(piece.variances.clone());
            merged.targets = merged.targets.take().or(piece.targets.clone());
            match (merged.film(rect), piece.film(rect)) {
                (Some(mut film), Some(other)) => {
                    film.merge(&other).expect("a block of the same picture has the same pixels");
                    merged.film = Some(Arc::new(PackedFilm::new(film, whole.packed_samples())));
                }
                _ => merged.film = piece.film,
            }
            merged.to = next;
        }
        if next < samples && !whole.is_done(index, merged, gain) {
            gaps.push((rect, next, samples));
        }
    }
    for (rect, from, to) in gaps.iter().take(LISTED) {
        let (right, bottom) = (rect.left + rect.width - 1, rect.top + rect.height - 1);
        let _ =
            writeln!(missing, "  pixels {},{} to {right},{bottom}: samples {from} to {}", rect.left, rect.top, to - 1);
    }
    if gaps.len() > LISTED {
        let _ = writeln!(missing, "  and the samples of {} other blocks", gaps.len() - LISTED);
    }
    Ok(())
}

/// Merges the centre rays of all parts into `whole`. Describes missing rays in `missing`.
fn merge_rays(
    parts: &[(String, PartialRender)],
    whole: &PartialRender,
    missing: &mut String,
) -> Result<(), MergeError> {
    let mut gaps = 0;
    let mut state = whole.state();
    for (index, merged) in state.rays.iter_mut().enumerate() {
        let mut owner: Option<&str> = None;
        for (name, part) in parts {
            let Some(piece) = part.state().rays[index].clone() else { continue };
            if let Some(first) = owner.replace(name) {
                let rect = whole.ray_blocks.rect(index);
                let what = format!("the data of pixel {},{}", rect.left, rect.top);
                return Err(MergeError::Overlap { first: first.into(), second: name.clone(), what });
            }
            *merged = Some(piece);
        }
        gaps += usize::from(owner.is_none());
    }
    if gaps > 0 {
        let _ = writeln!(missing, "  the data of {gaps} blocks of 8 x 8 pixels");
    }
    Ok(())
}

/// Describes missing or unfinished shards if all parts come from the same division into shards.
fn shards_missing(parts: &[(String, PartialRender)]) -> String {
    let Shard { count, by, .. } = parts[0].1.shard;
    let mut text = String::new();
    if parts.iter().all(|(_, part)| part.shard.count == count && part.shard.by == by) {
        let there = |index: &u32| parts.iter().any(|(_, part)| part.shard.index == *index);
        let absent: Vec<String> = (1..=count).filter(|i| !there(i)).map(|index| format!("{index}/{count}")).collect();
        if !absent.is_empty() {
            let by = if by == ShardBy::Tiles { "tiles" } else { "samples" };
            let _ = writeln!(text, "  shards by {by}: {}", absent.join(", "));
        }
    }
    for (name, part) in parts.iter().filter(|(_, part)| !part.is_finished()) {
        let (all, done) = part.work();
        let _ = writeln!(text, "  `{name}` is not finished: {done} of {all} samples; `--resume` continues it");
    }
    text
}
