//! Tables of numbers over one or more coordinates.

use super::words::{Start, Words};
use crate::format::said::Said;
use crate::math::fp;
use std::f64::consts::PI;

/// A table, the last coordinate fastest.
pub(super) struct Table {
    /// The values of each coordinate.
    axes: Vec<Vec<f64>>,
    values: Vec<f64>,
}

impl Table {
    /// Reads a file of data.
    pub fn read(bytes: &[u8], file: u32, said: &Said) -> Option<Table> {
        let mut words = Words::new(bytes, file, 0..bytes.len());
        let end = words.end();
        let mut next = || {
            let word = match words.start() {
                Some(Start::Word(word)) => Some(word),
                _ => None,
            };
            if word.is_none() {
                said.bad(end, "this table ends before all its numbers are there");
            }
            word
        };
        let first = next()?;
        let dimensions = first.count(said)?;
        if !(1..=8).contains(&dimensions) {
            said.bad(first.at, "a table has 1 to 8 coordinates");
            return None;
        }
        let mut axes = Vec::new();
        let mut total: usize = 1;
        for _ in 0..dimensions {
            let (from, to, count) = (next()?.number(said)?, next()?.number(said)?, next()?);
            let places = count.count(said)?;
            total = total.saturating_mul(places);
            if places == 0 || total > bytes.len() {
                said.bad(
                    count.at,
                    format!("the file has not so many numbers as {places} values of this coordinate need"),
                );
                return None;
            }
            axes.push(match from == to {
                true => (0..places).map(|_| next()?.number(said)).collect::<Option<_>>()?,
                false => {
                    let step = (to - from) / (places.max(2) - 1) as f64;
                    (0..places).map(|i| from + step * i as f64).collect()
                }
            });
        }
        let values = (0..total).map(|_| next()?.number(said)).collect::<Option<_>>()?;
        Some(Table { axes, values })
    }

    /// The mean of all values.
    pub fn mean(&self) -> f32 {
        (self.values.iter().sum::<f64>() / self.values.len() as f64).max(0.0) as f32
    }

    /// The even radiance that has the flux of a lamp whose table goes by the angle from its axis,
    /// in degrees, last. A flat lamp's values are divided by the cosine, which makes an
    /// intensity of them.
    pub fn flux(&self, flat: bool) -> f32 {
        const STEPS: u32 = 720;
        let angles = &self.axes[self.axes.len() - 1];
        let columns = angles.len();
        let rows = self.values.len() / columns;
        // The mean over all other coordinates, at an angle.
        let mean = |i: usize| (0..rows).map(|row| self.values[row * columns + i]).sum::<f64>() / rows as f64;
        let means: Vec<f64> = (0..columns).map(mean).collect();
        let at = |degrees: f64| -> f64 {
            let after = angles.iter().position(|angle| *angle >= degrees);
            match after {
                Some(0) if degrees < angles[0] - 1e-9 => 0.0,
                Some(0) => means[0],
                Some(i) => {
                    let share = (degrees - angles[i - 1]) / (angles[i] - angles[i - 1]);
                    means[i - 1] + share * (means[i] - means[i - 1])
                }
                None => 0.0,
            }
        };
        let mut sum = 0.0;
        for step in 0..STEPS {
            let degrees = (f64::from(step) + 0.5) * 180.0 / f64::from(STEPS);
            let (sin, _) = fp::sin_cos_degrees(degrees);
            sum += at(degrees) * sin * (PI / f64::from(STEPS));
        }
        // Over all directions; an even radiance L sends pi L per area, a sphere 4 pi L per area of
        // its outline.
        let flux = 2.0 * PI * sum / if flat { PI } else { 4.0 * PI };
        flux.max(0.0) as f32
    }
}
