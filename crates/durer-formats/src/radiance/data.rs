//! Reads data files, which contain tables of numbers over one or more coordinates.

use super::words::{PrimitiveStart, Words};
use crate::shared_report::SharedReport;

/// Maximum number of coordinates that a table can have.
const MAX_DIMENSIONS: usize = 8;

/// Table of numbers over one or more coordinates, read from a Radiance data file. The last
/// coordinate varies fastest in the list of values.
#[derive(Debug, PartialEq)]
pub(super) struct Table {
    /// Positions of the samples along each coordinate.
    axes: Vec<Vec<f64>>,
    values: Vec<f64>,
}

impl Table {
    /// Reads a data file.
    pub fn read(bytes: &[u8], file: u32, report: &SharedReport) -> Option<Table> {
        let mut words = Words::new(bytes, file, 0..bytes.len());
        let end = words.end();
        let mut next = || {
            let word = match words.start() {
                Some(PrimitiveStart::Word(word)) => Some(word),
                _ => None,
            };
            if word.is_none() {
                report.error(end, "the table ends before its last number");
            }
            word
        };
        let first = next()?;
        let dimensions = first.count(report)?;
        if !(1..=MAX_DIMENSIONS).contains(&dimensions) {
            report.error(first.at, "a table must have from 1 to 8 coordinates");
            return None;
        }
        let mut axes = Vec::new();
        let mut total: usize = 1;
        for _ in 0..dimensions {
            let (from, to, count) = (next()?.number(report)?, next()?.number(report)?, next()?);
            let places = count.count(report)?;
            total = total.saturating_mul(places);
            if places == 0 || total > bytes.len() {
                report.error(count.at, format!("the file is too short for {places} values of this coordinate"));
                return None;
            }
            axes.push(match from == to {
                true => (0..places).map(|_| next()?.number(report)).collect::<Option<_>>()?,
                false => {
                    let step = (to - from) / (places.max(2) - 1) as f64;
                    (0..places).map(|i| from + step * i as f64).collect()
                }
            });
        }
        let values = (0..total).map(|_| next()?.number(report)).collect::<Option<_>>()?;
        Some(Table { axes, values })
    }

    /// Returns the mean of all values.
    pub fn mean(&self) -> f32 {
        (self.values.iter().sum::<f64>() / self.values.len() as f64).max(0.0) as f32
    }

    /// Returns the number of coordinates.
    pub fn dimensions(&self) -> usize {
        self.axes.len()
    }

    /// Interpolates linearly between samples in all coordinates. Returns 0 for positions outside
    /// the table.
    pub fn at(&self, coordinates: &[f64]) -> f64 {
        const SLACK: f64 = 1e-4;
        // Index of the sample before the position, and relative distance to the next sample, for
        // each coordinate.
        let mut cells = [(0, 0.0); MAX_DIMENSIONS];
        for ((axis, &x), cell) in self.axes.iter().zip(coordinates).zip(&mut cells) {
            let (first, last) = (axis[0].min(axis[axis.len() - 1]), axis[0].max(axis[axis.len() - 1]));
            if x < first - SLACK || x > last + SLACK {
                return 0.0;
            }
            if axis.len() > 1 {
                let rises = axis[0] <= axis[axis.len() - 1];
                let after = axis.partition_point(|&value| (value <= x) == rises);
                let i = after.clamp(1, axis.len() - 1) - 1;
                let share = (x - axis[i]) / (axis[i + 1] - axis[i]);
                *cell = (i, if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 });
            }
        }
        let corner = |bits: u32| {
            let (mut index, mut share) = (0, 1.0);
            for (dimension, axis) in self.axes.iter().enumerate() {
                let ((i, way), next) = (cells[dimension], (bits >> dimension & 1) as usize);
                index = index * axis.len() + (i + next).min(axis.len() - 1);
                share *= if next == 1 { way } else { 1.0 - way };
            }
            share * self.values[index]
        };
        (0..1 << self.axes.len()).map(corner).sum()
    }
}
