use super::*;
use crate::film::PackedFilm;
use proptest::prelude::*;

#[derive(Clone, Copy, Debug)]
struct Sample(u32, u32, u32, Vec3, f32);

fn film(samples: &[Sample]) -> Film {
    let mut film = Film::new(3, 2);
    // Some samples are transparent.
    let seen = |s: u32, color| if s % 4 == 3 { None } else { Some(color) };
    samples.iter().for_each(|&Sample(x, y, s, color, weight)| film.add_optional(x, y, s, seen(s, color), weight));
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
    fn packing_preserves_films(samples in samples()) {
        // Films with all samples, with only the usual samples, and with one usual sample in each
        // pixel.
        let usual = samples.iter().copied().filter(|s| s.3.is_finite() && s.2 % 4 != 3);
        let usual: Vec<Sample> = usual.map(|s| Sample(s.0, s.1, s.2, s.3.clamp(Vec3::splat(-7.0), Vec3::splat(7.0)), 1.0)).collect();
        let single: Vec<Sample> = (0..6).zip(&usual).map(|(i, &Sample(_, _, s, color, weight))| Sample(i % 3, i / 3, s, color, weight)).collect();
        let negative: Vec<Sample> = usual.iter().map(|s| Sample(s.0, s.1, s.2, s.3, if s.2 % 2 == 0 { 1.25 } else { -1.25 })).collect();
        for (samples, count) in [(&samples, 50), (&usual, 120), (&negative, 121), (&single, 1)] {
            let film = film(samples);
            let packed = PackedFilm::new(film.clone(), count);
            prop_assert_eq!(&packed.film([0, 0, 3, 2]), &film);
            let (mut means, bits) = (Vec::new(), |color: Color, share: f32| (color.to_array().map(f32::to_bits), share.to_bits()));
            packed.for_each_mean(|color, share| means.push(bits(color, share)));
            let whole = (0..6).map(|i| (i % 3, i / 3)).map(|(x, y)| bits(film.resolve(x, y), film.coverage(x, y)));
            prop_assert_eq!(means, whole.collect::<Vec<_>>());
            match (samples.len(), count) {
                (6, 1) => prop_assert!(matches!(packed, PackedFilm::OneSample(..))),
                (_, 120) => prop_assert!(matches!(packed, PackedFilm::UnitWeights(..))),
                (1.., 121) => prop_assert!(matches!(packed, PackedFilm::Small(..))),
                _ => {}
            }
        }
    }

    #[test]
    fn order_and_grouping_do_not_matter(
        (given, shuffled) in samples().prop_flat_map(|s| (Just(s.clone()), Just(s).prop_shuffle())),
        cuts in prop::collection::vec(0.0..1.0_f64, 0..5),
    ) {
        let whole = film(&given);
        prop_assert_eq!(&whole, &film(&shuffled));
        // Merge the parts of the shuffled samples in reverse order.
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
            prop_assert_eq!(whole.coverage(x, y).to_bits(), merged.coverage(x, y).to_bits());
            prop_assert!((0.0..=1.0).contains(&whole.coverage(x, y)));
        }
    }

    #[test]
    fn constant_colour_is_preserved(c in [1e-3_f32..1e6, 1e-3_f32..1e6, 1e-3_f32..1e6], weights in prop::collection::vec(0.1_f32..4.0, 1..50)) {
        let mut film = Film::new(1, 1);
        weights.iter().zip(0..).for_each(|(&w, s)| film.add(0, 0, s, Vec3::from(c), w));
        prop_assert_eq!(film.resolve(0, 0), Vec3::from(c));
    }
}

#[test]
fn misses_are_transparent_black_by_their_weight() {
    let mut film = Film::new(3, 1);
    film.add(0, 0, 0, Vec3::ONE, 0.5);
    film.add_optional(0, 0, 1, None, 1.5);
    assert_eq!((film.coverage(0, 0), film.resolve(0, 0), film.samples(0, 0)), (0.25, Vec3::splat(0.25), 2));
    film.add_optional(1, 0, 0, None, 1.0);
    assert_eq!((film.coverage(1, 0), film.resolve(1, 0)), (0.0, Vec3::ZERO));
    assert_eq!((film.coverage(2, 0), film.resolve(2, 0)), (1.0, Vec3::ZERO));
    // The sum of the weights is zero, and one of the samples is transparent.
    film.add(2, 0, 0, Vec3::ONE, 1.0);
    film.add_optional(2, 0, 1, None, -1.0);
    assert_eq!((film.coverage(2, 0), film.resolve(2, 0)), (1.0, Vec3::ZERO));
}

#[test]
fn films_merge_only_inside_the_window() {
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
fn rejected_samples_are_counted_and_the_first_are_listed() {
    let mut film = Film::new(2, 2);
    for s in (0..40).rev() {
        film.add(1, 0, s, Vec3::new(0.0, f32::NAN, 0.0), 1.0);
    }
    film.add(0, 0, 9, Vec3::ONE, f32::INFINITY);
    film.add(0, 1, 0, Vec3::splat(1e30), 1.0);
    film.add(1, 0, 77, Vec3::splat(0.25), 1.0);
    assert_eq!((film.rejected(), film.first_rejected().len()), (41, MAX_LISTED_REJECTED));
    // Colours that are too bright are clamped.
    assert_eq!(film.resolve(0, 1), Vec3::splat(GREATEST_COLOR as f32));
    assert_eq!(film.first_rejected()[..2], [Rejected { y: 0, x: 0, sample: 9 }, Rejected { y: 0, x: 1, sample: 0 }]);
    assert_eq!((film.resolve(1, 0), film.samples(1, 0)), (Vec3::splat(0.25), 1));
}

#[test]
fn variance_is_finite_for_finite_samples_and_zero_for_equal_ones() {
    for size in [0.0, 1.0, 1e3, 1e6, 1e12, 1e18, 1e30, f32::MAX] {
        let mut film = Film::new(2, 1);
        for s in 0..9 {
            film.add(0, 0, s, Vec3::splat(size), 1.0);
            film.add(1, 0, s, Vec3::splat(if s % 2 == 0 { size } else { -size }), 1.0);
        }
        let (equal, mixed) = (film.variance(0, 0, 1.0), film.variance(1, 0, 1.0));
        // Rounding the mean to single precision leaves a small residue.
        let most = f64::from(size).min(GREATEST_LUMINANCE);
        assert!(equal <= 1e-12 * most * most, "{size}: {equal}");
        assert!(mixed.is_finite() && mixed <= most * most, "{size}: {mixed}");
        assert_eq!(film.rejected(), 0);
        let mut bytes = Vec::new();
        film.write(&mut bytes);
        assert_eq!(Film::new(2, 1).read(&mut ByteReader(&bytes), 9), Some(film));
        assert_eq!(Film::new(2, 1).read(&mut ByteReader(&bytes), 8), None, "more samples than possible");
    }
}

proptest! {
    #[test]
    fn rounding_matches_the_standard_library(small in -1e7_f64..1e7, shift in 0..28_u32) {
        for x in [small, small.floor() + 0.5, (small * (1_u64 << shift) as f64).round() + 0.5, -0.5, 0.5, 1.5] {
            prop_assert_eq!(whole_number(x), x.round_ties_even() as i64, "{}", x);
        }
    }

    #[test]
    fn small_samples_give_equal_sums(r in -2.6_f32..2.6, g in -2.6_f32..2.6, b in -2.6_f32..2.6, weight in -1.0_f32..=1.0) {
        for scale in [1.0, 1e-3, 1e-6, 0.0] {
            let color = scale * Vec3::new(r, g, b);
            let (mut fast, mut slow, mut small) = (Pixel::default(), Pixel::default(), SmallSums::default());
            for weight in [weight, 1.0] {
                prop_assert!(SmallSums::fits(color, weight));
                small.add(color, weight);
                prop_assert!(slow.add(color.to_array().map(f64::from), weight.into(), 1.0));
            }
            fast.add_small(&small);
            prop_assert_eq!(fast, slow);
        }
    }
}
