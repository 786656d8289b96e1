//! Exact sums: samples are added as integers, so the order of adding and merging changes nothing.

use crate::math::{Color, Vec3};

/// A window of a picture that adds up weighted samples, each pixel for itself.
///
/// A weight is rounded once to a multiple of 2^-24, the product of colour and weight once to a multiple of 2^-48 (ties to even).
/// From then on everything is integer addition. Finite samples up to 2^44 are kept: a pixel overflows after 2^29 of the
/// largest weight at the earliest.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Film {
    left: u32,
    top: u32,
    width: u32,
    height: u32,
    pixels: Vec<Pixel>,
    rejected: u64,
    first_rejected: Vec<Rejected>,
}

/// Sums of one pixel: 64 bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Pixel {
    /// Weighted colour, in units of 2^-48.
    color: [i128; 3],
    /// Weight, in units of 2^-24.
    weight: i64,
    samples: u64,
}

const COLOR_SCALE: f64 = (1_u64 << 48) as f64;
const WEIGHT_SCALE: f64 = (1_u64 << 24) as f64;
const GREATEST_COLOR: f64 = (1_u64 << 44) as f64;
const GREATEST_WEIGHT: f64 = (1_u64 << 10) as f64;

/// A sample that was left out because it is infinite, not a number or beyond the film's range. Ordered by row, column, sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Rejected {
    /// Row from the top.
    pub y: u32,
    /// Column from the left.
    pub x: u32,
    /// Number of the sample in its pixel.
    pub sample: u32,
}

/// How many rejected samples are remembered.
const REMEMBERED: usize = 16;

/// The window of the film to merge does not lie in that of the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a film of other pixels cannot be merged into this one")]
pub struct WrongWindow;

impl Film {
    /// A black film of a whole picture.
    pub fn new(width: u32, height: u32) -> Self {
        Film::window(0, 0, width, height)
    }

    /// A black film of a part of a picture. Pixels keep their places in the whole.
    pub fn window(left: u32, top: u32, width: u32, height: u32) -> Self {
        let pixels = vec![Pixel::default(); width as usize * height as usize];
        Film { left, top, width, height, pixels, rejected: 0, first_rejected: Vec::new() }
    }

    /// Columns and rows.
    pub fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// Adds a sample of some weight (up to 2^10 in size) to a pixel. Panics outside the window.
    pub fn add(&mut self, x: u32, y: u32, sample: u32, color: Color, weight: f32) {
        let index = self.index(x, y).expect("the pixel lies in the film's window");
        let weight = f64::from(weight) * WEIGHT_SCALE;
        // At most 24 significant bits are left of the weight, so each product below is exact before its rounding.
        let (whole, rgb) = (weight.round_ties_even(), color.to_array().map(f64::from));
        if !(whole.abs() <= GREATEST_WEIGHT * WEIGHT_SCALE && rgb.iter().all(|c| c.abs() <= GREATEST_COLOR)) {
            return self.reject(Rejected { y, x, sample });
        }
        let pixel = &mut self.pixels[index];
        for (sum, c) in pixel.color.iter_mut().zip(rgb) {
            *sum += (c * (whole / WEIGHT_SCALE) * COLOR_SCALE).round_ties_even() as i128;
        }
        pixel.weight += whole as i64;
        pixel.samples += 1;
    }

    /// Counts a sample as left out; the first few in reading order are remembered.
    fn reject(&mut self, what: Rejected) {
        self.rejected += 1;
        let place = self.first_rejected.partition_point(|old| *old <= what);
        if place < REMEMBERED {
            self.first_rejected.insert(place, what);
            self.first_rejected.truncate(REMEMBERED);
        }
    }

    /// Adds everything that a film of the same pixels or some of them holds.
    pub fn merge(&mut self, other: &Film) -> Result<(), WrongWindow> {
        if other.pixels.is_empty() {
            return Ok(());
        }
        // Where both corners lie inside, all between does.
        let (right, bottom) = (other.width - 1, other.height - 1);
        let far = other.left.checked_add(right).zip(other.top.checked_add(bottom));
        let far = far.and_then(|(x, y)| self.index(x, y));
        let first = self.index(other.left, other.top).zip(far).ok_or(WrongWindow)?.0;
        for (row, source) in other.pixels.chunks_exact(other.width as usize).enumerate() {
            let start = first + row * self.width as usize;
            for (to, from) in self.pixels[start..].iter_mut().zip(source) {
                to.color.iter_mut().zip(from.color).for_each(|(sum, c)| *sum += c);
                to.weight += from.weight;
                to.samples += from.samples;
            }
        }
        // Those not remembered come after sixteen others, and so they do in the union.
        other.first_rejected.iter().for_each(|&r| self.reject(r));
        self.rejected += other.rejected - other.first_rejected.len() as u64;
        Ok(())
    }

    /// Weighted mean of a pixel's samples; black where the weights sum to nothing. Panics outside the window.
    pub fn resolve(&self, x: u32, y: u32) -> Color {
        let pixel = self.pixel(x, y);
        if pixel.weight == 0 {
            return Vec3::ZERO;
        }
        // Each sum is rounded to double precision, then divided: two roundings, and one to single.
        let weight = pixel.weight as f64 / WEIGHT_SCALE;
        Vec3::from(pixel.color.map(|sum| (sum as f64 / COLOR_SCALE / weight) as f32))
    }

    /// How many samples a pixel holds, without those left out. Panics outside the window.
    pub fn samples(&self, x: u32, y: u32) -> u64 {
        self.pixel(x, y).samples
    }

    /// How many samples were left out.
    pub fn rejected(&self) -> u64 {
        self.rejected
    }

    /// The first sixteen of the samples left out, whatever the order they came in.
    pub fn first_rejected(&self) -> &[Rejected] {
        &self.first_rejected
    }

    fn pixel(&self, x: u32, y: u32) -> &Pixel {
        &self.pixels[self.index(x, y).expect("the pixel lies in the film's window")]
    }

    fn index(&self, x: u32, y: u32) -> Option<usize> {
        let (column, row) = (x.checked_sub(self.left)?, y.checked_sub(self.top)?);
        (column < self.width && row < self.height).then(|| row as usize * self.width as usize + column as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[derive(Clone, Copy, Debug)]
    struct Sample(u32, u32, u32, Vec3, f32);

    fn film(samples: &[Sample]) -> Film {
        let mut film = Film::new(3, 2);
        samples.iter().for_each(|&Sample(x, y, s, color, weight)| film.add(x, y, s, color, weight));
        film
    }

    fn value() -> impl Strategy<Value = f32> {
        prop_oneof![
            4 => -10.0_f32..1000.0,
            2 => any::<f32>(),
            1 => prop::sample::select(vec![f32::NAN, f32::INFINITY, -0.0, 1e-12, 1e12]),
        ]
    }

    fn samples() -> impl Strategy<Value = Vec<Sample>> {
        let sample = (0..3_u32, 0..2_u32, 0..50_u32, [value(), value(), value()], -2.0_f32..2.0)
            .prop_map(|(x, y, s, c, w)| Sample(x, y, s, Vec3::from(c), w));
        prop::collection::vec(sample, 0..120)
    }

    proptest! {
        #[test]
        fn order_and_grouping_change_nothing(
            (given, shuffled) in samples().prop_flat_map(|s| (Just(s.clone()), Just(s).prop_shuffle())),
            cuts in prop::collection::vec(0.0..1.0_f64, 0..5),
        ) {
            let whole = film(&given);
            prop_assert_eq!(&whole, &film(&shuffled));
            // Parts of the shuffled samples, merged last first.
            let mut ends: Vec<usize> = cuts.iter().map(|c| (c * shuffled.len() as f64) as usize).collect();
            ends.extend([0, shuffled.len()]);
            ends.sort_unstable();
            let mut merged = Film::new(3, 2);
            for part in ends.windows(2).rev() {
                merged.merge(&film(&shuffled[part[0]..part[1]])).unwrap();
            }
            prop_assert_eq!(&whole, &merged);
            for (x, y) in (0..6).map(|i| (i % 3, i / 3)) {
                prop_assert_eq!(whole.resolve(x, y).to_array().map(f32::to_bits), merged.resolve(x, y).to_array().map(f32::to_bits));
                prop_assert!(whole.resolve(x, y).is_finite());
            }
        }

        #[test]
        fn one_colour_stays_that_colour(c in [1e-3_f32..1e6, 1e-3_f32..1e6, 1e-3_f32..1e6], weights in prop::collection::vec(0.1_f32..4.0, 1..50)) {
            let mut film = Film::new(1, 1);
            weights.iter().zip(0..).for_each(|(&w, s)| film.add(0, 0, s, Vec3::from(c), w));
            prop_assert_eq!(film.resolve(0, 0), Vec3::from(c));
        }
    }

    #[test]
    fn windows_merge_into_their_places_only() {
        let mut whole = Film::new(5, 4);
        let mut part = Film::window(2, 1, 3, 2);
        part.add(4, 2, 0, Vec3::ONE, 1.0);
        whole.merge(&part).unwrap();
        assert_eq!((whole.resolve(4, 2), whole.samples(4, 2), whole.resolve(0, 0)), (Vec3::ONE, 1, Vec3::ZERO));
        for (left, top, w, h) in [(3, 1, 3, 2), (2, 3, 3, 2), (u32::MAX, 0, 2, 1), (0, 0, 5, 5)] {
            assert_eq!(whole.clone().merge(&Film::window(left, top, w, h)), Err(WrongWindow));
        }
        assert_eq!(part.merge(&whole), Err(WrongWindow));
        assert_eq!(whole.merge(&Film::window(9, 9, 0, 0)), Ok(()));
    }

    #[test]
    fn rejected_samples_are_counted_and_the_first_ones_named() {
        let mut film = Film::new(2, 2);
        for s in (0..40).rev() {
            film.add(1, 0, s, Vec3::new(0.0, f32::NAN, 0.0), 1.0);
        }
        film.add(0, 0, 9, Vec3::ONE, f32::INFINITY);
        film.add(0, 1, 0, Vec3::splat(1e30), 1.0);
        film.add(1, 0, 77, Vec3::splat(0.25), 1.0);
        assert_eq!((film.rejected(), film.first_rejected().len()), (42, REMEMBERED));
        assert_eq!(
            film.first_rejected()[..2],
            [Rejected { y: 0, x: 0, sample: 9 }, Rejected { y: 0, x: 1, sample: 0 }]
        );
        assert_eq!((film.resolve(1, 0), film.samples(1, 0)), (Vec3::splat(0.25), 1));
    }
}
