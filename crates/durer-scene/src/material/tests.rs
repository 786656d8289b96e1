//! Tests that compare patterns in space with their formulas.

use super::*;
use crate::math::noise::{perlin, turbulence};
use crate::math::random::Random;

#[test]
fn checkerboard_cubes_alternate_across_every_face() {
    let board = PatternMaterial::from(checkerboard::Checkerboard { material1: 3, material2: 5 });
    assert_eq!(board.materials(), [3, 5]);
    for x in -3i32..3 {
        for y in -3..3 {
            for z in -3..3 {
                let middle = Vec3::new(x as f32, y as f32, z as f32) + 0.5;
                let expected = if (x + y + z).rem_euclid(2) == 0 { 1.0 } else { 0.0 };
                assert_eq!(board.weight(middle), expected, "{middle}");
            }
        }
    }
    // A point at a corner belongs to the cube above it.
    assert_eq!((board.weight(Vec3::ZERO), board.weight(Vec3::NEG_X)), (1.0, 0.0));
}

#[test]
fn marble_wood_and_noise_follow_their_formulas() {
    let mut random = Random(1);
    for _ in 0..2_000 {
        let q = 20.0 * random.point();
        let (octaves, frequency, amplitude) =
            (random.below(5) as u32, random.between(0.1, 4.0), random.between(0.0, 3.0));
        // Sum the octaves in double precision.
        let n: f64 = (0..octaves).map(|i| f64::from(perlin(q * (1 << i) as f32)) / f64::from(1 << i)).sum();
        assert!((f64::from(turbulence(q, octaves)) - n).abs() < 1e-6);
        let sine = |x: f64| 0.5 * (libm::sin(f64::from(frequency) * x + f64::from(amplitude) * n) + 1.0);
        let radius = libm::hypot(f64::from(q.x), f64::from(q.z));
        let marble = marble::Marble { octaves, frequency, amplitude, ..Default::default() };
        let wood = wood::Wood { octaves, frequency, amplitude, ..Default::default() };
        // For phases up to 100, two steps have rounding errors of up to 4e-6, which carry over to
        // the sine.
        assert!((f64::from(marble.weight(q)) - sine(f64::from(q.x))).abs() < 1e-5);
        assert!((f64::from(wood.weight(q)) - sine(radius)).abs() < 1e-5);
        let noise = solid_noise::SolidNoise { octaves, ..Default::default() };
        assert!((f64::from(noise.weight(q)) - (n + 0.5).clamp(0.0, 1.0)).abs() < 1e-6);
        let colors = ColorNoise { color1: Vec3::X, color2: Vec3::Y, octaves, frequency, amplitude };
        let w = sine(f64::from(q.x)) as f32;
        assert!((colors.color(q) - Vec3::new(w, 1.0 - w, 0.0)).length() < 2e-5);
    }
}

#[test]
fn conic_rings_agree_with_the_program_of_2004() {
    let wood = wood::Wood { octaves: 3, frequency: 6.0, amplitude: 2.0, ..Default::default() };
    let mut random = Random(3);
    for _ in 0..2_000 {
        let q = 20.0 * random.point();
        let n = f64::from(turbulence(Vec3::new(q.x, 0.2 * q.y, q.z), 3));
        let radius = libm::hypot(f64::from(q.x), f64::from(q.z));
        let share = (libm::sin(6.0 * radius + 0.3 * f64::from(q.y) + 2.0 * n) + 0.5).clamp(0.0, 1.0);
        let solid = PatternMaterial::from(wood.clone());
        assert!((f64::from(solid.share(q, true)) - share * share).abs() < 1e-4);
        assert_eq!(solid.share(q, false), wood.weight(q));
    }
}

#[test]
fn noise_stays_in_its_range_and_fills_it() {
    let mut random = Random(2);
    let values: Vec<f32> = (0..100_000).map(|_| perlin(100.0 * random.point())).collect();
    assert!(values.iter().all(|v| v.abs() <= 1.04), "noise exceeds the published bound of improved noise");
    assert!(values.iter().any(|v| *v > 0.7) && values.iter().any(|v| *v < -0.7));
    let mean = values.iter().sum::<f32>() / values.len() as f32;
    // The standard deviation is about 0.25. Allow 5 standard errors of the mean, as for independent
    // values.
    assert!(mean.abs() < 5.0 * 0.25 / 316.0, "{mean}");
}
