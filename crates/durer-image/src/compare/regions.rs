//! Regions where two pictures differ most.

use super::measure::over;
use super::picture::Pair;
use durer_bvh::math::Vec3;

/// Rectangle around connected pixels in which a picture differs from its reference by more than the
/// tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region {
    /// Leftmost column of the rectangle.
    pub x: u32,
    /// Top row of the rectangle.
    pub y: u32,
    /// Width of the rectangle in pixels.
    pub width: u32,
    /// Height of the rectangle in pixels.
    pub height: u32,
    /// Number of differing pixels in the region.
    pub pixels: usize,
    /// Mean of (picture - reference) over the differing pixels, for each channel; it is negative if
    /// the picture is darker.
    pub mean_difference: Vec3,
    /// Share of the total squared difference of the picture, from 0 to 1.
    pub share: f64,
    /// Column and row of the pixel that differs most, which can be passed to `durer explain`.
    pub worst: (u32, u32),
}

impl Region {
    /// Maximum number of regions that are reported.
    pub const LIMIT: usize = 10;
}

/// Number of cells along the longer side of a picture. Differing pixels belong to the same region
/// if their cells touch.
const CELLS: usize = 64;

/// Bounds and sums of the differing pixels in one cell, or in a region of cells that touch.
#[derive(Clone, Copy)]
struct RegionSums {
    low: (usize, usize),
    high: (usize, usize),
    pixels: usize,
    sum: Vec3,
    squared: f64,
    worst: (f32, usize),
}

impl RegionSums {
    const NONE: RegionSums = RegionSums {
        low: (usize::MAX, usize::MAX),
        high: (0, 0),
        pixels: 0,
        sum: Vec3::ZERO,
        squared: 0.0,
        worst: (-1.0, 0),
    };

    fn add(&mut self, other: &RegionSums) {
        self.low = (self.low.0.min(other.low.0), self.low.1.min(other.low.1));
        self.high = (self.high.0.max(other.high.0), self.high.1.max(other.high.1));
        self.pixels += other.pixels;
        self.sum += other.sum;
        self.squared += other.squared;
        if other.worst.0 > self.worst.0 {
            self.worst = other.worst;
        }
    }
}

/// Finds the regions with the largest squared differences, starting with the worst.
pub(super) fn worst(pair: &Pair, tolerance: f32) -> Vec<Region> {
    let side = pair.width.max(pair.height).div_ceil(CELLS).max(2);
    let (columns, rows) = (pair.width.div_ceil(side), pair.height.div_ceil(side));
    let mut cells = vec![RegionSums::NONE; columns * rows];
    let mut total = 0.0;
    for index in 0..pair.reference.len() {
        let (a, b) = (pair.reference[index], pair.test[index]);
        if a == b {
            continue;
        }
        let difference = b - a;
        let squared = f64::from(difference.length_squared());
        total += squared;
        if over(a, b, tolerance) {
            let place = (index % pair.width, index / pair.width);
            let one = RegionSums {
                low: place,
                high: place,
                pixels: 1,
                sum: difference,
                squared,
                worst: (difference.abs().max_element(), index),
            };
            cells[place.1 / side * columns + place.0 / side].add(&one);
        }
    }
    let mut regions = joined(&mut cells, columns, rows);
    regions.sort_by(|a, b| b.squared.total_cmp(&a.squared).then(a.worst.1.cmp(&b.worst.1)));
    regions.truncate(Region::LIMIT);
    let place = |index: usize| ((index % pair.width) as u32, (index / pair.width) as u32);
    let region = |found: RegionSums| Region {
        x: found.low.0 as u32,
        y: found.low.1 as u32,
        width: (found.high.0 - found.low.0 + 1) as u32,
        height: (found.high.1 - found.low.1 + 1) as u32,
        pixels: found.pixels,
        mean_difference: found.sum / found.pixels as f32,
        share: found.squared / total,
        worst: place(found.worst.1),
    };
    regions.into_iter().map(region).collect()
}

/// Joins cells that touch, even if only at corners, into regions. Afterwards, the cells are empty.
fn joined(cells: &mut [RegionSums], columns: usize, rows: usize) -> Vec<RegionSums> {
    let mut regions = Vec::new();
    for start in 0..cells.len() {
        let mut region = RegionSums::NONE;
        let mut stack = vec![start];
        while let Some(cell) = stack.pop() {
            let found = std::mem::replace(&mut cells[cell], RegionSums::NONE);
            if found.pixels == 0 {
                continue;
            }
            region.add(&found);
            let (x, y) = (cell % columns, cell / columns);
            for y in y.saturating_sub(1)..(y + 2).min(rows) {
                stack.extend((x.saturating_sub(1)..(x + 2).min(columns)).map(|x| y * columns + x));
            }
        }
        if region.pixels > 0 {
            regions.push(region);
        }
    }
    regions
}
