//! Division of a picture into blocks, into tiles that threads render, and into shards.
//!
//! All decisions, such as which shard renders a pixel or where the noise is low enough, are made
//! for blocks of 8 x 8 pixels. The corners of the blocks are at multiples of 8 in the full picture.
//! The tile size therefore does not affect the result.

use super::PixelRect;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;
use std::str::FromStr;

/// Width and height of a block, in pixels.
pub const BLOCK: u32 = 8;

/// Division of a window of the picture into blocks of 8 x 8 pixels, in reading order. Blocks at the
/// edges of the window can be smaller.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Blocks {
    window: PixelRect,
    /// Column and row of the first block, in blocks from the corner of the full picture.
    first: (u32, u32),
    columns: u32,
    rows: u32,
}

impl Blocks {
    /// Returns the blocks of a non-empty window.
    pub fn new(window: PixelRect) -> Self {
        let first = (window.left / BLOCK, window.top / BLOCK);
        let columns = (window.left + window.width).div_ceil(BLOCK) - first.0;
        let rows = (window.top + window.height).div_ceil(BLOCK) - first.1;
        Blocks { window, first, columns, rows }
    }

    /// Returns the number of blocks.
    pub fn count(&self) -> usize {
        self.columns as usize * self.rows as usize
    }

    /// Returns the rectangle of pixels in a block.
    pub fn rect(&self, index: usize) -> PixelRect {
        let (column, row) = (index as u32 % self.columns + self.first.0, index as u32 / self.columns + self.first.1);
        let side = |block: u32, start: u32, length: u32| {
            let from = (block * BLOCK).max(start);
            (from, (block * BLOCK + BLOCK).min(start + length) - from)
        };
        let (left, width) = side(column, self.window.left, self.window.width);
        let (top, height) = side(row, self.window.top, self.window.height);
        PixelRect { left, top, width, height }
    }

    /// Iterates over the rows of blocks. Each item is the range of block indices in one row.
    pub fn rows(&self) -> impl Iterator<Item = Range<usize>> {
        let columns = self.columns as usize;
        (0..self.count() / columns.max(1)).map(move |row| row * columns..(row + 1) * columns)
    }

    /// Returns the index of the block that contains a pixel of the window.
    pub fn index_at(&self, x: u32, y: u32) -> usize {
        (y / BLOCK - self.first.1) as usize * self.columns as usize + (x / BLOCK - self.first.0) as usize
    }

    /// Groups the chosen blocks into tiles of `side` pixels. Both blocks and tiles are in reading
    /// order.
    pub fn tiles(&self, chosen: impl Iterator<Item = usize>, side: u32) -> Vec<Vec<usize>> {
        let blocks_a_side = side.div_ceil(BLOCK).max(1);
        let mut tiles: BTreeMap<(u32, u32), Vec<usize>> = BTreeMap::new();
        for index in chosen {
            let (column, row) =
                (index as u32 % self.columns + self.first.0, index as u32 / self.columns + self.first.1);
            tiles.entry((row / blocks_a_side, column / blocks_a_side)).or_default().push(index);
        }
        tiles.into_values().collect()
    }
}

/// The way in which a render is divided between machines: by pixels or by samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ShardBy {
    /// Each shard renders some of the blocks of pixels.
    #[default]
    Tiles,
    /// Each shard renders some of the samples of every pixel.
    Samples,
}

/// One of several parts of a render that different machines can render.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shard {
    /// Index of the shard, starting at 1.
    pub index: u32,
    /// Number of shards.
    pub count: u32,
    /// The way in which the work is divided.
    pub by: ShardBy,
}

impl Shard {
    /// The only shard of a render that is not divided.
    pub const WHOLE: Shard = Shard { index: 1, count: 1, by: ShardBy::Tiles };

    /// Returns true if the shard renders the pixels of a block. Neighbouring blocks belong to
    /// different shards to balance the work.
    pub fn has_block(self, index: usize) -> bool {
        self.by == ShardBy::Samples || self.has_rays(index)
    }

    /// Returns true if the shard traces the centre rays of a block. Centre rays are always divided
    /// by blocks.
    pub fn has_rays(self, index: usize) -> bool {
        index as u64 % u64::from(self.count) == u64::from(self.index - 1)
    }

    /// Returns the range of a pixel's samples that the shard renders, as the first index and the
    /// end (exclusive).
    pub fn range(self, samples: u32) -> (u32, u32) {
        let end = |index: u32| (u64::from(samples) * u64::from(index) / u64::from(self.count)) as u32;
        if self.by == ShardBy::Tiles { (0, samples) } else { (end(self.index - 1), end(self.index)) }
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.count)
    }
}

impl FromStr for Shard {
    type Err = String;

    /// Parses a shard such as `3/16`, which is the third of sixteen shards divided by tiles.
    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').and_then(|(i, n)| Some((i.trim().parse().ok()?, n.trim().parse().ok()?)));
        let (index, count) = numbers.ok_or("expected INDEX/COUNT, for example 3/16 for the third of sixteen shards")?;
        match (1..=count).contains(&index) {
            true => Ok(Shard { index, count, by: ShardBy::Tiles }),
            false => Err(format!("the index must be from 1 to {count}")),
        }
    }
}
