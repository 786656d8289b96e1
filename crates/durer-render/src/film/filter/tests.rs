use super::*;
use durer_scene::sampler::random_2d;
use durer_scene::sampler::testing::{chi_squared, chi_squared_quantile};

fn sizes() -> impl Iterator<Item = Filter> {
    Filter::NAMES.into_iter().flat_map(|(_, f)| [f, f.with_radius(0.7), f.with_radius(3.3)])
}

/// Returns the integral of the absolute filter over cell (i, j) of a grid on its support, computed
/// with the midpoint rule.
fn mass(filter: Filter, cells: usize, i: usize, j: usize) -> f64 {
    let at = |cell: usize, k: usize| {
        let u = (cell as f32 + (k as f32 + 0.5) / 16.0) / cells as f32;
        (2.0 * u - 1.0) * filter.radius()
    };
    let points = (0..256).map(|k| filter.weight(at(i, k % 16), at(j, k / 16)));
    points.map(|w| f64::from(w.abs())).sum()
}

#[test]
fn offsets_follow_the_filter() {
    const CELLS: usize = 20;
    for filter in sizes() {
        let sampler = filter.sampler();
        let mut observed = vec![0_u32; CELLS * CELLS];
        let n = 200_000;
        for s in 0..n {
            let (offset, _) = sampler.sample(random_2d(1, 0, 0, s, 0));
            let cell = |d: f32| (((d / filter.radius() + 1.0) * 0.5 * CELLS as f32) as usize).min(CELLS - 1);
            assert!(offset.abs().max_element() <= filter.radius());
            observed[cell(offset.y) * CELLS + cell(offset.x)] += 1;
        }
        let expected: Vec<f64> = (0..CELLS * CELLS).map(|c| mass(filter, CELLS, c % CELLS, c / CELLS)).collect();
        let scale = f64::from(n) / expected.iter().sum::<f64>();
        // Pool cells in which fewer than five samples are expected.
        let (mut o, mut e) = (vec![0], vec![0.0]);
        for (&count, mass) in observed.iter().zip(expected) {
            if mass * scale < 5.0 {
                o[0] += count;
                e[0] += mass * scale;
            } else {
                o.push(count);
                e.push(mass * scale);
            }
        }
        if e[0] < 5.0 {
            assert!(o[0] < 20, "{filter:?}: {} where {} are expected", o[0], e[0]);
            (o, e) = (o[1..].to_vec(), e[1..].to_vec());
        }
        // The quantile is for a significance level of 1e-4.
        let (statistic, limit) = (chi_squared(&o, &e), chi_squared_quantile(o.len() - 1, 3.719));
        assert!(statistic < limit, "{filter:?}: {statistic} exceeds {limit}");
    }
}

#[test]
fn offsets_are_accurate_to_a_thousandth_of_the_radius() {
    const STEPS: usize = 1 << 16;
    for filter in sizes() {
        let sampler = filter.sampler();
        let at = |step: usize| (step as f32 + 0.5) / STEPS as f32 * filter.radius();
        let total: f64 = (0..STEPS).map(|step| f64::from(filter.profile(at(step)).abs())).sum();
        let (mut integral, mut off, mut weight) = (0.0, 0.0, 0.0);
        for step in 0..STEPS {
            let here = f64::from(filter.profile(at(step)).abs());
            let share = (integral + 0.5 * here) / total;
            off += here * f64::from((sampler.warp((0.5 + 0.5 * share) as f32) - at(step)).abs());
            (integral, weight) = (integral + here, weight + here);
        }
        assert!(off / weight < 1e-3 * f64::from(filter.radius()), "{filter:?}: {}", off / weight);
    }
}

#[test]
fn weights_have_mean_one_and_the_sign_of_the_filter() {
    for filter in sizes() {
        let sampler = filter.sampler();
        let n = 256;
        let mut sum = 0.0;
        for i in 0..n * n {
            let u = (Vec2::new((i % n) as f32, (i / n) as f32) + 0.5) / n as f32;
            let (offset, weight) = sampler.sample(u);
            assert!(weight * filter.weight(offset.x, offset.y) >= 0.0, "{filter:?} {offset}");
            sum += f64::from(weight);
        }
        assert!((sum / f64::from(n * n) - 1.0).abs() < 0.02, "{filter:?}: {sum}");
    }
}

#[test]
fn profiles_match_known_values() {
    for filter in sizes() {
        let r = filter.radius();
        assert!(filter.weight(0.0, 0.0) > 0.7 && filter.weight(1.001 * r, 0.0) == 0.0);
        assert_eq!(filter.weight(0.3 * r, -0.2 * r), filter.weight(-0.2 * r, 0.3 * r));
        if !matches!(filter, Filter::Box { .. }) {
            assert!(filter.weight(0.999 * r, 0.0).abs() < 2e-3, "{filter:?}");
        }
    }
    // Mitchell's cubic is 8/9 at the centre, 1/18 at half the radius and zero at 8/7 of half the
    // radius. Beyond that point it is negative.
    let m = |d| Filter::Mitchell { radius: 2.0 }.profile(d);
    for (d, value) in [(0.0, 8.0 / 9.0), (1.0, 1.0 / 18.0), (8.0 / 7.0, 0.0), (2.0, 0.0), (0.99999, 1.0 / 18.0)] {
        assert!((m(d) - value).abs() < 1e-4, "{d}: {}", m(d));
    }
    assert!(m(1.5) < -0.02);
    assert!((Filter::BlackmanHarris { radius: 1.5 }.profile(0.0) - 1.0).abs() < 1e-6);
}

#[test]
fn warps_match_closed_forms() {
    let boxed = Filter::Box { radius: 0.5 }.sampler();
    let tent = Filter::Tent { radius: 1.0 }.sampler();
    for i in 0..1000 {
        let u = i as f32 / 1000.0;
        assert!((boxed.warp(u) - (u - 0.5)).abs() < 1e-7);
        let exact = if u < 0.5 { (2.0 * u).sqrt() - 1.0 } else { 1.0 - (2.0 - 2.0 * u).sqrt() };
        // Between two knots at a distance h, the chord deviates by h^2 / 8 times the second
        // derivative. In the last share, it deviates by less than a quarter of the share's width.
        let rest = 1.0 - (2.0 * f64::from(u) - 1.0).abs();
        let off = (7.5e-9 / (rest * rest.sqrt())).min(0.006) + 1e-6;
        assert!(f64::from((tent.warp(u) - exact).abs()) < off, "{u}");
        assert!(tent.warp(u) <= tent.warp(u + 1e-3));
    }
}

#[test]
fn batched_offsets_match_single_offsets() {
    for filter in sizes() {
        let sampler = filter.sampler();
        let positions: [Vec2; 8] = std::array::from_fn(|i| random_2d(1, 0, 0, i as u32, 0) * (i % 7) as f32 / 6.0);
        let (offsets, weights) = sampler.samples(&[positions.map(|p| p.x), positions.map(|p| p.y)]);
        let alone = positions.map(|position| sampler.sample(position));
        assert_eq!(
            std::array::from_fn::<_, 8, _>(|i| (Vec2::new(offsets[0][i], offsets[1][i]), weights[i])),
            alone,
            "{filter:?}"
        );
    }
}
