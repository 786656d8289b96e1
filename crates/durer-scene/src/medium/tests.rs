use super::*;
use crate::math::Vec2;
use crate::math::random::Random;
use glam::{DAffine3, DMat3};
use std::f32::consts::TAU;

fn medium(albedo: Color, extinction: Color) -> Medium {
    Medium { extinction, albedo, phase: HenyeyGreenstein::default(), region: None }
}

fn way(to: f32) -> Segment {
    Segment { origin: DVec3::ZERO, dir: Vec3::X, from: 0.0, to }
}

#[test]
fn flight_agrees_with_beers_law_and_albedo() {
    let mut random = Random(5);
    let extinction = Color::new(0.3, 1.0, 2.5);
    let fog = medium(Color::new(0.9, 0.5, 0.2), extinction);
    let (mut passed, mut scattered) = (glam::DVec3::ZERO, glam::DVec3::ZERO);
    let n = 200_000;
    for _ in 0..n {
        let mut numbers = || random.between(0.0, 1.0).min(0.999_999_9);
        match fog.sample_distance(&way(1.5), Spectrum::ONE, &Lanes::Rgb, &mut numbers) {
            DistanceSample::Passed(left) => passed += left.truncate().as_dvec3(),
            DistanceSample::Scattered(distance, left) => {
                assert!((0.0..1.5).contains(&distance));
                scattered += left.truncate().as_dvec3();
            }
        }
    }
    let through = (-extinction * 1.5).map(fp::exp);
    let [passed, scattered] = [passed, scattered].map(|sum| (sum / f64::from(n)).as_vec3());
    assert!((passed - through).abs().max_element() < 5e-3, "{passed} {through}");
    let wanted = fog.albedo * (Color::ONE - through);
    assert!((scattered - wanted).abs().max_element() < 5e-3, "{scattered} {wanted}");
}

#[test]
fn grid_transmittance_agrees_with_the_integral() {
    // The two cells have the densities 1 and 3. Interpolated linearly between their centres, the
    // mean density along x is 2.
    let grid = DensityGrid::new([2, 1, 1], vec![1.0, 3.0]).unwrap();
    let bounds = Aabb { min: Vec3::new(1.0, -1.0, -1.0), max: Vec3::new(3.0, 1.0, 1.0) };
    let place = MediumRegion { bounds, to_world: None, density: Some(Arc::new(grid)) };
    // Describe that box by its opposite corner, with the axes of the unit cube along -x, z and y.
    let edges = DMat3::from_cols(-2.0 * DVec3::X, 2.0 * DVec3::Z, 2.0 * DVec3::Y);
    let to_world = Affine::new(DAffine3::from_mat3_translation(edges, DVec3::new(3.0, -1.0, -1.0)));
    let unit = Aabb { min: Vec3::ZERO, max: Vec3::ONE };
    for place in [place.clone(), MediumRegion { bounds: unit, to_world, ..place }] {
        lets_through(&Medium { region: Some(place), ..medium(Color::splat(0.5), Color::new(0.2, 0.4, 0.1)) });
    }
    assert!(DensityGrid::new([2, 2, 1], vec![0.0; 3]).is_none() && DensityGrid::new([1, 1, 1], vec![-1.0]).is_none());
}

/// Tests the transmittance through a box with a mean density of 2 over a length of 2.
fn lets_through(smoke: &Medium) {
    let mut random = Random(9);
    let (mut ratio, mut passed) = (Spectrum::ZERO, Spectrum::ZERO);
    let n = 100_000;
    for _ in 0..n {
        let mut numbers = || random.between(0.0, 1.0).min(0.999_999_9);
        ratio += smoke.transmittance(&way(10.0), &Lanes::Rgb, &mut numbers) / n as f32;
        if let DistanceSample::Passed(left) =
            smoke.sample_distance(&way(10.0), Spectrum::ONE, &Lanes::Rgb, &mut numbers)
        {
            passed += left / n as f32;
        }
    }
    let wanted = (-smoke.extinction * 4.0).map(fp::exp);
    assert!((ratio.truncate() - wanted).abs().max_element() < 6e-3, "{ratio} {wanted}");
    assert!((passed.truncate() - wanted).abs().max_element() < 8e-3, "{passed} {wanted}");
    // The space outside the box is clear.
    let beside = Segment { origin: DVec3::new(0.0, 5.0, 0.0), ..way(10.0) };
    assert_eq!(smoke.transmittance(&beside, &Lanes::Rgb, &mut || 0.5), Spectrum::ONE);
}

#[test]
fn phase_function_integrates_to_one_and_agrees_with_samples() {
    for g in [-0.6, 0.0, 0.3, 0.9] {
        let phase = HenyeyGreenstein { anisotropy: g };
        let n = 20_000;
        let value = |cosine: f32| phase.value(Vec3::Z, Vec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine));
        let step = 2.0 / n as f32;
        let cosines = (0..n).map(|i| -1.0 + step * (i as f32 + 0.5));
        let sums =
            cosines.fold([0.0; 2], |sum, c| [sum[0] + value(c) * step * TAU, sum[1] + c * value(c) * step * TAU]);
        assert!((sums[0] - 1.0).abs() < 2e-3 && (sums[1] - g).abs() < 2e-3, "{g}: {sums:?}");
        // Perform a chi-squared test over 20 bins of the cosine with equal probability.
        let (mut bins, samples) = ([0_u32; 20], 100_000);
        let mut random = Random(3);
        let before = Vec3::new(0.6, 0.0, 0.8);
        for _ in 0..samples {
            let after = phase.sample(before, Vec2::new(random.between(0.0, 1.0), random.between(0.0, 1.0)));
            assert!((after.length() - 1.0).abs() < 1e-5);
            // Compute the cumulative distribution function of the cosine.
            let c = before.dot(after).clamp(-1.0, 1.0);
            let root = (1.0 + g * g - 2.0 * g * c).sqrt();
            let below =
                if g == 0.0 { 0.5 * (c + 1.0) } else { (1.0 - g * g) / (2.0 * g) * (1.0 / root - 1.0 / (1.0 + g)) };
            bins[((below * 20.0) as usize).min(19)] += 1;
        }
        let wanted = f64::from(samples) / 20.0;
        let chi2: f64 = bins.iter().map(|&n| (f64::from(n) - wanted) * (f64::from(n) - wanted) / wanted).sum();
        // With 19 degrees of freedom, a value above 43.8 has a probability of 0.001.
        assert!(chi2 < 43.8, "{g}: {chi2}");
    }
}
