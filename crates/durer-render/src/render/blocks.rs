//! How a picture is cut: into blocks, which never change, tiles of blocks, which threads take, and
//! shards.
//!
//! All that decides anything (which shard makes a pixel, where noise is low enough) goes by blocks
//! of 8 x 8 pixels, whose corners lie at multiples of 8 in the whole picture. So the size of tiles
//! changes nothing.

use super::Crop;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;
use std::str::FromStr;

/// Pixels across and down a block.
pub const BLOCK: u32 = 8;

/// The blocks of a window, numbered in reading order. Those at the window's edges may be smaller.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Blocks {
    window: Crop,
    /// First column and row of blocks, counted in the whole picture.
    first: (u32, u32),
    columns: u32,
    rows: u32,
}

impl Blocks {
    /// The blocks of a window that is not empty.
    pub fn new(window: Crop) -> Self {
        let first = (window.left / BLOCK, window.top / BLOCK);
        let columns = (window.left + window.width).div_ceil(BLOCK) - first.0;
        let rows = (window.top + window.height).div_ceil(BLOCK) - first.1;
        Blocks { window, first, columns, rows }
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.columns as usize * self.rows as usize
    }

    /// The pixels of a block.
    pub fn rect(&self, index: usize) -> Crop {
        let (column, row) = (index as u32 % self.columns + self.first.0, index as u32 / self.columns + self.first.1);
        let side = |block: u32, start: u32, length: u32| {
            let from = (block * BLOCK).max(start);
            (from, (block * BLOCK + BLOCK).min(start + length) - from)
        };
        let (left, width) = side(column, self.window.left, self.window.width);
        let (top, height) = side(row, self.window.top, self.window.height);
        Crop { left, top, width, height }
    }

    /// The numbers of the blocks of each row of them.
    pub fn rows(&self) -> impl Iterator<Item = Range<usize>> {
        let columns = self.columns as usize;
        (0..self.count() / columns.max(1)).map(move |row| row * columns..(row + 1) * columns)
    }

    /// The number of the block that holds a pixel of the window.
    pub fn at(&self, x: u32, y: u32) -> usize {
        (y / BLOCK - self.first.1) as usize * self.columns as usize + (x / BLOCK - self.first.0) as usize
    }

    /// Some blocks, by the tiles in which they lie; tiles in reading order.
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

/// How work is split over machines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ShardBy {
    /// Each makes some of the pixels, wholly.
    #[default]
    Tiles,
    /// Each takes some of the samples of every pixel.
    Samples,
}

/// One of several parts of the work.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shard {
    /// Which one, from 1.
    pub index: u32,
    /// How many there are.
    pub count: u32,
    /// How the work is split.
    pub by: ShardBy,
}

impl Shard {
    /// All of it.
    pub const WHOLE: Shard = Shard { index: 1, count: 1, by: ShardBy::Tiles };

    /// Whether it has the pixels of a block. Neighbours go to different shards, which so have about
    /// as much work.
    pub fn has_block(self, index: usize) -> bool {
        self.by == ShardBy::Samples || self.has_rays(index)
    }

    /// Whether it has the rays through the centres of a block's pixels: these are split by blocks
    /// in any case.
    pub fn has_rays(self, index: usize) -> bool {
        index as u64 % u64::from(self.count) == u64::from(self.index - 1)
    }

    /// Its samples of those of a pixel: from the first to before the last.
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

    /// Reads `3/16`: the third of sixteen, by tiles.
    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').and_then(|(i, n)| Some((i.trim().parse().ok()?, n.trim().parse().ok()?)));
        let (index, count) = numbers.ok_or("expected INDEX/COUNT, as in 3/16: the third of sixteen")?;
        match (1..=count).contains(&index) {
            true => Ok(Shard { index, count, by: ShardBy::Tiles }),
            false => Err(format!("the first of {count} is 1/{count}, the last {count}/{count}")),
        }
    }
}
