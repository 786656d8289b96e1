//! Values of attributes that change over time.

use super::layer::{Property, Value};

/// Time at which attributes are read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum SampleTime {
    /// Time of the first sample.
    First,
    /// Time code, in the unit of the layer.
    At(f64),
}

impl SampleTime {
    /// Returns the indices of the samples before and after this time, and the position between
    /// them, from 0 to 1. `times` is sorted and not empty.
    pub fn between(self, times: &[f64]) -> (usize, usize, f64) {
        let SampleTime::At(time) = self else { return (0, 0, 0.0) };
        let after = times.partition_point(|sample| *sample <= time).min(times.len() - 1);
        let before = after.saturating_sub(usize::from(times[after] > time));
        let step = times[after] - times[before];
        let position = if step > 0.0 { ((time - times[before]) / step).clamp(0.0, 1.0) } else { 0.0 };
        (before, after, position)
    }
}

impl Property {
    /// Returns the value at a time. Numbers are interpolated linearly between samples. The samples
    /// are preferred to the default value.
    pub fn at(&self, time: SampleTime) -> Option<Value> {
        if self.samples.is_empty() {
            return self.value.clone();
        }
        let times: Vec<f64> = self.samples.iter().map(|sample| sample.0).collect();
        let (before, after, position) = time.between(&times);
        let (from, to) = (&self.samples[before].1, &self.samples[after].1);
        Some(if position == 0.0 { from.clone() } else { interpolated(from, to, position) })
    }
}

/// Interpolates between two values. Values other than numbers, and arrays of different lengths,
/// keep the earlier value.
fn interpolated(from: &Value, to: &Value, position: f64) -> Value {
    let mix = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a + position * (b - a)).collect();
    match (from, to) {
        (Value::Number(a), Value::Number(b)) => Value::Number(a + position * (b - a)),
        (Value::Tuple(a), Value::Tuple(b)) if a.len() == b.len() => Value::Tuple(mix(a, b)),
        (Value::Numbers { width, values: a }, Value::Numbers { values: b, .. }) if a.len() == b.len() => {
            Value::Numbers { width: *width, values: mix(a, b) }
        }
        _ => from.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_interpolated_and_held_at_the_ends() {
        let number = |x| Value::Number(x);
        let property = Property { samples: vec![(1.0, number(10.0)), (3.0, number(20.0))], ..Property::default() };
        let at = |time| property.at(time).and_then(|value| value.number()).unwrap();
        assert_eq!(at(SampleTime::First), 10.0);
        assert_eq!([0.0, 1.0, 2.5, 3.0, 9.0].map(|time| at(SampleTime::At(time))), [10.0, 10.0, 17.5, 20.0, 20.0]);
    }
}
