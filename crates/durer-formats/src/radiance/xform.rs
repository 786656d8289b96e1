//! Transforms of `xform` commands and of instances, which can contain sequences, repetitions and
//! arrays.

use super::words::Word;
use crate::shared_report::SharedReport;
use durer_scene::math::fp;
use glam::{DAffine3, DMat3, DVec3};

/// Maximum number of copies that nested arrays can create.
const MAX_PLACES: usize = 1 << 20;

/// Number of times that a part of an `xform` transform is applied. It is the same for all copies,
/// or it increases from copy to copy in an array.
#[derive(Clone, Copy, PartialEq)]
enum Repetition {
    /// The part is applied a fixed number of times (`-i`).
    Fixed(i32),
    /// The part creates an array of copies (`-a`). The part is applied zero times to the first
    /// copy, once to the second, twice to the third, and so on.
    Array(usize),
}

/// Transform of an `xform` command. The transform is a sequence of parts, and it can create several
/// copies.
#[derive(Clone)]
pub(super) struct TransformSequence {
    parts: Vec<(Repetition, DAffine3)>,
}

impl Default for TransformSequence {
    fn default() -> Self {
        TransformSequence { parts: vec![(Repetition::Fixed(1), DAffine3::IDENTITY)] }
    }
}

/// Returns the rotation around an axis by an angle in degrees. The result is exact for multiples of
/// a right angle.
fn rotation(axis: usize, degrees: f64) -> DAffine3 {
    let (sin, cos) = fp::sin_cos_degrees(degrees);
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut columns = [DVec3::X, DVec3::Y, DVec3::Z];
    (columns[i][i], columns[i][j]) = (cos, sin);
    (columns[j][i], columns[j][j]) = (-sin, cos);
    DAffine3::from_mat3(DMat3::from_cols_array_2d(&columns.map(|column| column.to_array())))
}

impl TransformSequence {
    /// Parses an option and its arguments at the beginning of `words`. Returns false if the option
    /// is not a transform.
    pub fn option(&mut self, words: &mut &[Word], report: &SharedReport) -> bool {
        let Some((option, rest)) = words.split_first() else { return false };
        let numbers = |count: usize| -> Option<Vec<f64>> {
            if rest.len() < count {
                let message = format!("{} needs {count} number{}", option.quoted(), if count == 1 { "" } else { "s" });
                report.error(option.at, message);
                return None;
            }
            rest[..count].iter().map(|word| word.number(report)).collect()
        };
        let (count, map) = match option.text.as_str() {
            "-t" => (3, numbers(3).map(|v| DAffine3::from_translation(DVec3::new(v[0], v[1], v[2])))),
            "-rx" => (1, numbers(1).map(|v| rotation(0, v[0]))),
            "-ry" => (1, numbers(1).map(|v| rotation(1, v[0]))),
            "-rz" => (1, numbers(1).map(|v| rotation(2, v[0]))),
            "-s" => {
                let factor = numbers(1).map(|v| v[0]);
                if factor == Some(0.0) {
                    report.error(option.at, "the scale factor must not be 0");
                }
                (1, factor.filter(|s| *s != 0.0).map(|s| DAffine3::from_scale(DVec3::splat(s))))
            }
            "-mx" => (0, Some(DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0)))),
            "-my" => (0, Some(DAffine3::from_scale(DVec3::new(1.0, -1.0, 1.0)))),
            "-mz" => (0, Some(DAffine3::from_scale(DVec3::new(1.0, 1.0, -1.0)))),
            "-i" | "-a" => {
                let count = rest.first().and_then(|word| word.count(report)).unwrap_or(1).min(MAX_PLACES);
                if rest.is_empty() {
                    report.error(option.at, format!("{} needs a number", option.quoted()));
                }
                let times =
                    if option.text == "-i" { Repetition::Fixed(count as i32) } else { Repetition::Array(count) };
                self.parts.push((times, DAffine3::IDENTITY));
                (1, None)
            }
            _ => return false,
        };
        if let (Some(map), Some((_, part))) = (map, self.parts.last_mut()) {
            *part = map * *part;
        }
        *words = &rest[count.min(rest.len())..];
        true
    }

    /// Returns the transforms of all copies in order, or `None` if there are too many copies.
    pub fn copies(&self) -> Option<Vec<DAffine3>> {
        let mut places = vec![DAffine3::IDENTITY];
        for (times, map) in &self.parts {
            match *times {
                Repetition::Fixed(count) => {
                    let map = power(*map, count);
                    places.iter_mut().for_each(|place| *place = map * *place);
                }
                Repetition::Array(count) => {
                    if places.len().saturating_mul(count) > MAX_PLACES {
                        return None;
                    }
                    let maps: Vec<DAffine3> =
                        std::iter::successors(Some(DAffine3::IDENTITY), |so_far| Some(*map * *so_far))
                            .take(count)
                            .collect();
                    places = places.iter().flat_map(|place| maps.iter().map(move |map| *map * *place)).collect();
                }
            }
        }
        Some(places)
    }
}

/// Returns the result of applying a transform `count` times.
fn power(map: DAffine3, count: i32) -> DAffine3 {
    let (mut result, mut square, mut left) = (DAffine3::IDENTITY, map, count);
    while left > 0 {
        if left % 2 == 1 {
            result = square * result;
        }
        square = square * square;
        left /= 2;
    }
    result
}
