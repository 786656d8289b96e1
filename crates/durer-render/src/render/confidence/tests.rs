//! Tests that compare estimated errors and their bounds with true errors.

use super::*;
use crate::compile::testing::read;
use crate::film::Filter;
use crate::integrator::{PhotonParameters, RenderSettings};
use crate::render::explain::explain;
use crate::render::{Sampling, Shard};

#[test]
fn students_quantiles_match_tables() {
    for (freedom, quantile) in [(2.0, 2.920), (3.0, 2.353), (5.0, 2.015), (10.0, 1.812), (30.0, 1.697), (1e9, 1.645)] {
        assert!((student(freedom) / quantile - 1.0).abs() < 0.003, "{freedom}: {}", student(freedom));
    }
    assert!(student(0.0).is_infinite());
}

/// Builds a dark floor under a pane of glass, with a point light at height 2. The camera sees the
/// point on the floor below the light.
fn pane() -> World {
    read(
        "PerspectiveCamera { center 2 0.4 0 direction -2 -0.4 0 up 0 1 0 angle 0.001 } Background { color 0 0 0 }
         Lights { PointLight { position 0 2 0 color 1000 1000 1000 attenuation 0 0 1 } }
         Materials { PrincipledMaterial { baseColor 0.001 0.001 0.001 specularWeight 0 }
           PrincipledMaterial { transmissionWeight 1 specularRoughness 0 } }
         Group { MaterialIndex 0 Plane { normal 0 1 0 offset 0 } MaterialIndex 1 Box { min -0.5 1 -0.5 max 0.5 1.001 0.5 } }",
    )
}

fn job(method: IntegratorKind, size: u32, samples: u32, seed: u64) -> Job {
    let sampling = Sampling::Filtered { samples, filter: Filter::default() };
    let settings = RenderSettings { bounces: 12, ..Job::default().settings };
    Job { width: size, height: size, method, sampling, settings, seed, ..Job::default() }
}

fn photons(count: u32, radius: f32) -> IntegratorKind {
    IntegratorKind::Photons(PhotonParameters { count, radius: Some(radius), ..PhotonParameters::default() })
}

#[test]
fn bounds_contain_the_truth_at_their_confidence() {
    // Below a light at height h, the irradiance of the floor is E (1 + x^2 / h^2)^(-3/2),
    // attenuated by (1 - F) / (1 + F). The sum of its second derivatives is -6 E / h^2. The second
    // moment of the Epanechnikov kernel is r^2 / 6 along each axis, so the bias is -E r^2 / (2
    // h^2).
    let (runs, samples, radius, height) = (200, 12, 0.6_f64, 2.0_f64);
    let truth = 0.001 * 1000.0 / (height * height) * 0.96 / 1.04;
    let squares = (0..samples).scan(radius * radius, |square, i| {
        let now = *square;
        *square *= (f64::from(i) + 1.0 + 2.0 / 3.0) / (f64::from(i) + 2.0);
        Some(now)
    });
    let bias = -truth * squares.sum::<f64>() / f64::from(samples) / (2.0 * height * height);
    let world = pane();
    let bounds: Vec<ErrorBound> = (0..runs)
        .map(|seed| explain(&world, &job(photons(600, 0.6), 1, samples, seed), 0, 0).unwrap().error.unwrap())
        .collect();
    let n = runs as f64;
    let mean = bounds.iter().map(|bound| bound.bias).sum::<f64>() / n;
    let squares = bounds.iter().map(|bound| (bound.bias - mean) * (bound.bias - mean)).sum::<f64>();
    let error = (squares / (n * (n - 1.0))).sqrt();
    // Here, the fourth-order term is 5 % of the bias.
    assert!((mean - bias).abs() < 3.0 * error + 0.05 * bias.abs(), "bias {mean} ± {error}, expected {bias}");
    let share = |holds: &dyn Fn(&ErrorBound) -> bool| bounds.iter().filter(|bound| holds(bound)).count() as f64 / n;
    let deviation = (CONFIDENCE * (1.0 - CONFIDENCE) / n).sqrt();
    let within = share(&|bound| bound.interval().0 <= truth && truth <= bound.interval().1);
    assert!((within - CONFIDENCE).abs() < 3.0 * deviation, "{within}");
    let bounded = share(&|bound| (bound.luminance - truth).abs() <= bound.bound);
    assert!(bounded > CONFIDENCE - 3.0 * deviation, "{bounded}");
}

#[test]
fn pictures_and_explanations_have_equal_errors_on_any_number_of_threads() {
    let world = read(
        "PerspectiveCamera { center 0 2 6 direction 0 -0.3 -1 up 0 1 0 angle 30 } Background { color 0.1 0.1 0.1 }
         Lights { PointLight { position 0.5 4 0 color 9 9 9 falloff 1 } }
         Materials { PrincipledMaterial { baseColor 0.5 0.4 0.3 specularWeight 0 } PrincipledMaterial { preset glass } }
         Group { MaterialIndex 0 Plane { normal 0 1 0 offset 0 } MaterialIndex 1 Sphere { center 0 1 0 radius 0.7 } }",
    );
    for method in [photons(3000, 0.2), IntegratorKind::PATH] {
        let job = job(method, 12, 4, 1);
        let of = |threads| {
            let part = PartialRender::new(&world, &job, Shard::WHOLE).unwrap();
            part.render(&world, &Control { threads: Some(threads), ..Control::default() }, &mut |_, _| ()).unwrap();
            let hash = part.hash();
            let [values, shown] = part.error(&world, Some(threads)).unwrap();
            assert_eq!(part.hash(), hash);
            (values, shown)
        };
        let (values, shown) = of(1);
        assert_eq!((&values, &shown), (&of(3).0, &of(3).1));
        let mut biased = 0;
        for (x, y) in [(0, 0), (6, 6), (5, 10), (11, 11)] {
            let error = explain(&world, &job, x, y).unwrap().error.unwrap();
            assert_eq!(values.image.get(x, y).unwrap().x, error.bound as f32, "{x},{y}");
            biased += u32::from(error.bias != 0.0);
        }
        assert_eq!(biased > 0, method != IntegratorKind::PATH);
        // Without a colour picture, the error estimate takes its own samples.
        let alone = PartialRender::new(&world, &Job { color: false, ..job.clone() }, Shard::WHOLE).unwrap();
        assert_eq!(alone.error(&world, None).unwrap()[0], values);
    }
    let noisy = Job { noise: Some(0.1), ..job(photons(300, 0.2), 12, 4, 1) };
    let part = PartialRender::new(&world, &noisy, Shard::WHOLE).unwrap();
    assert!(matches!(part.error(&world, None), Err(RenderError::Diagram(_))));
}
