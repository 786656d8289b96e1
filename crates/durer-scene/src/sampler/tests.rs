use super::testing::{chi_squared, chi_squared_quantile};
use super::*;

/// Tests uniformity with a two-sided significance of 2e-4. Rejects uneven points, and also points
/// that are too even to be independent.
fn assert_uniform(what: &str, points: impl Iterator<Item = Vec2>) {
    let mut cells = [0_u32; 256];
    for p in points {
        assert!(p.min_element() >= 0.0 && p.max_element() < 1.0, "{what}: {p}");
        cells[(p.y * 16.0) as usize * 16 + (p.x * 16.0) as usize] += 1;
    }
    let n: u32 = cells.iter().sum();
    let statistic = chi_squared(&cells, &[f64::from(n) / 256.0; 256]);
    let (low, high) = (chi_squared_quantile(255, -3.719), chi_squared_quantile(255, 3.719));
    assert!((low..high).contains(&statistic), "{what}: {statistic} not in {low}..{high}");
}

const N: u32 = 1 << 16;

#[test]
fn positions_are_uniform() {
    // The numbers must be independent across samples, pixels and seeds.
    assert_uniform("samples", (0..N).map(|s| Sampler::Random.pixel_position(7, 3, 4, s, N)));
    for sampler in [Sampler::Random, Sampler::Sobol] {
        for sample in [0, 1, 5, 1023] {
            let over_x = (0..N).map(|x| sampler.pixel_position(7, x, 9, sample, 1024));
            assert_uniform(&format!("{sampler:?} {sample} over x"), over_x);
            let over_y = (0..N).map(|y| sampler.pixel_position(7, 9, y, sample, 1024));
            assert_uniform(&format!("{sampler:?} {sample} over y"), over_y);
            let over_seeds = (0..N).map(|seed| sampler.pixel_position(seed.into(), 9, 9, sample, 1024));
            assert_uniform(&format!("{sampler:?} {sample} over seeds"), over_seeds);
        }
    }
    assert_uniform("dimensions", (0..N).map(|d| sample_2d(1, 2, 3, 4, d)));
    // On a grid, positions must be uniform within each cell. The next test checks the cells
    // themselves.
    let cells = (0..N).map(|i| (Sampler::Jittered.pixel_position(1, i, 5, i % 9, 9) * 3.0).fract());
    assert_uniform("jittered", cells);
}

#[test]
fn pairs_are_independent_across_pixels_and_dimensions() {
    let first = |i| sample_2d(3, i, 0, 2, 0);
    assert_uniform("neighbours", (0..N).map(|i| Vec2::new(first(i).x, first(i + 1).x)));
    assert_uniform("dimensions", (0..N).map(|i| Vec2::new(first(i).y, sample_2d(3, i, 0, 2, 1).y)));
    // Shuffling decorrelates the dimensions within one pixel, so check the correlation as well as
    // uniformity.
    let n = 1024_u32;
    let mut sum = 0.0;
    for s in 0..n {
        sum += (sample_2d(5, 8, 8, s, 0).x - 0.5) * (sample_2d(5, 8, 8, s, 1).x - 0.5);
    }
    // For independent pairs, the standard deviation is 1 / (12 sqrt(n)).
    assert!((sum / n as f32).abs() < 4.0 / (12.0 * (n as f32).sqrt()), "{sum}");
}

#[test]
fn grid_samplers_fill_their_grid() {
    for sampler in [Sampler::Uniform, Sampler::Jittered] {
        for requested in 1..40 {
            let n = sampler.round_up(requested);
            let side = n.isqrt();
            assert!(n >= requested && side * side == n && (side - 1) * (side - 1) < requested);
            for s in 0..n {
                let p = sampler.pixel_position(1, 2, 3, s, requested) * side as f32;
                assert_eq!((p.x as u32, p.y as u32), (s % side, s / side));
            }
        }
        assert_eq!(sampler.round_up(0), 1);
        assert_eq!(sampler.round_up(u32::MAX), 65535 * 65535);
    }
    assert_eq!(Sampler::Uniform.pixel_position(1, 2, 3, 1, 4), Vec2::new(0.75, 0.25));
    assert_eq!((Sampler::Sobol.round_up(5), Sampler::Random.round_up(0)), (5, 1));
}

#[test]
fn power_of_two_prefixes_are_stratified_in_elementary_intervals() {
    for (x, dimension) in (0..20).flat_map(|x| [(x, 0), (x, 3)]) {
        for k in 0..=10_u32 {
            let n = 1_u32 << k;
            // Check the prefix and the third aligned block.
            for start in [0, 2 * n] {
                for columns_log in 0..=k {
                    let (columns, rows) = (1_u32 << columns_log, 1_u32 << (k - columns_log));
                    let mut is_taken = vec![false; n as usize];
                    for s in start..start + n {
                        let p = sample_2d(11, x, 1, s, dimension);
                        let cell = (p.y * rows as f32) as u32 * columns + (p.x * columns as f32) as u32;
                        assert!(!std::mem::replace(&mut is_taken[cell as usize], true), "{x} {n} {columns}");
                    }
                }
            }
        }
    }
}

/// Greatest difference, over all boxes with a corner at the origin, between the area of the box and
/// the fraction of points inside it.
fn star_discrepancy(points: &[Vec2]) -> f64 {
    let n = points.len() as f64;
    let ends = |axis: usize| points.iter().map(move |p| p[axis]).chain([1.0]);
    let mut worst = 0.0_f64;
    for a in ends(0) {
        for b in ends(1) {
            let open = points.iter().filter(|p| p.x < a && p.y < b).count() as f64 / n;
            let closed = points.iter().filter(|p| p.x <= a && p.y <= b).count() as f64 / n;
            let area = f64::from(a) * f64::from(b);
            worst = worst.max(area - open).max(closed - area);
        }
    }
    worst
}

#[test]
fn sobol_is_more_even_than_random() {
    for n in [16, 64, 100, 128] {
        let mean = |sampler: Sampler| {
            let points = |y| -> Vec<_> { (0..n).map(|s| sampler.pixel_position(1, 2, y, s, n)).collect() };
            (0..10).map(|y| star_discrepancy(&points(y))).sum::<f64>() / 10.0
        };
        let (sobol, random) = (mean(Sampler::Sobol), mean(Sampler::Random));
        assert!(sobol < 0.6 * random, "{n}: {sobol} {random}");
    }
}

#[test]
fn discrepancies_match_theory() {
    let mean = |sampler: Sampler, n: u32| {
        let points = |y| -> Vec<_> { (0..n).map(|s| sampler.pixel_position(1, 2, y, s, n)).collect() };
        (0..10).map(|y| star_discrepancy(&points(y))).sum::<f64>() / 10.0
    };
    for side in [4_u32, 8, 12] {
        let n = side * side;
        let of = |sampler| mean(sampler, n);
        // For the centres of n cells, a box that ends just before a row of centres misses half a
        // row.
        let regular = of(Sampler::Uniform);
        let step = 1.0 / f64::from(side);
        assert!((0.5 * step..1.01 * step).contains(&regular), "{n}: {regular}");
        // The discrepancy of one point per cell is between those of independent points and of a
        // (0,2)-sequence.
        let (random, jittered, sobol) = (of(Sampler::Random), of(Sampler::Jittered), of(Sampler::Sobol));
        assert!(sobol < jittered && jittered < random, "{n}: {sobol} {jittered} {random}");
        // The discrepancy of independent points is of the order of sqrt(1 / n). Source: Doerr,
        // Gnewuch, Wahlström, 2008.
        let root = f64::from(n).sqrt();
        assert!((0.5..2.0).contains(&(random * root)), "{n}: {random}");
    }
}

#[test]
fn fast_second_coordinate_matches_sobol() {
    // The direction numbers of the polynomial x + 1 are v[i] = v[i-1] ^ v[i-1] / 2.
    let slow = |index: u32| {
        let directions = std::iter::successors(Some(1_u32 << 31), |v| Some(v ^ v >> 1));
        directions.take(32).enumerate().fold(0, |sum, (i, v)| if index >> i & 1 == 1 { sum ^ v } else { sum })
    };
    assert!((0..5000).chain([u32::MAX, 1 << 31]).all(|i| sobol_second(i) == slow(i)));
}

#[test]
fn numbers_are_reproducible_bit_for_bit() {
    // These numbers are pinned, because changing them would change every picture.
    let bits = |p: Vec2| (p.x.to_bits(), p.y.to_bits());
    for (_, sampler) in Sampler::NAMES {
        let at = |seed| bits(sampler.pixel_position(seed, 5, 6, 7, 16));
        assert_eq!(at(1), at(1));
        assert_eq!(at(1) == at(2), sampler == Sampler::Uniform);
    }
    // The first number is the published output of SplitMix64 for the seed 0.
    assert_eq!((mix(0), hash(1, 2, 3, 4, 5)), (0xe220_a839_7b1d_cdaf, 0x7364_eb2c_5b1b_50d3));
    assert_eq!(unit(u32::MAX), BELOW_ONE);
    assert!(Sampler::NAMES.iter().all(|&(name, sampler)| Sampler::from_name(name) == Some(sampler)));
    assert_eq!(Sampler::from_name("halton"), None);
}

#[test]
fn batched_points_match_single_points() {
    for first in [0, 5, u32::MAX - 20] {
        let samples = std::array::from_fn::<u32, 8, _>(|i| first + 2 * i as u32);
        let sequences = std::array::from_fn::<_, 8, _>(|i| SampleId::new(3, (i as u32, 9), 0).sequence(i as u32 / 4));
        let [x, y] = Sequence::points(&sequences, &samples);
        for i in 0..8 {
            let alone = sample_2d(3, i as u32, 9, samples[i], i as u32 / 4);
            assert_eq!(Vec2::new(x[i], y[i]), alone, "{first} {i}");
        }
    }
}

#[test]
fn batched_pairs_match_single_pairs() {
    for sample in [0, 7, 1000, u32::MAX] {
        let id = SampleId::new(11, (3, sample), sample).with_first_dimension(12);
        assert_eq!(id.pairs(), [0, 1, 2, 3].map(|dimension| id.pair(dimension)), "{sample}");
    }
}
