//! Tests that adaptive allocation gives the right numbers of samples and an unbiased result.

use super::*;
use crate::compile::testing;
use crate::film::Filter;
use crate::film::aov::Aov;
use crate::film::course::CourseFilter;
use crate::integrator::{DirectSampling, IntegratorKind, PathOptions};
use crate::render::verify::RenderVariant;
use crate::render::*;
use crate::world::World;
use durer_scene::source::Digest;
use std::sync::atomic::AtomicBool;

fn all(world: &World, job: &Job) -> PartialRender {
    RenderVariant::PLAIN.render_job(world, job, &AtomicBool::new(false)).unwrap()
}

/// A sphere in front of a uniform sky, lit by an area light that is out of view.
const UNEVEN: &str = "PerspectiveCamera { center 0 0 4 direction 0 0 -1 up 0 1 0 angle 60 }
Lights { numLights 0 }
Background { color 0.5 0.6 0.7 }
Materials { numMaterials 2 PrincipledMaterial { baseColor 0.8 0.8 0.8 specularWeight 0 }
  PrincipledMaterial { baseWeight 0 specularWeight 0 emissionLuminance 10 } }
Group { numObjects 2
  MaterialIndex 0 Sphere { center -0.8 0 0 radius 0.9 }
  MaterialIndex 1 Sphere { center -2.2 0.5 3 radius 0.4 } }";

/// Returns a job that only samples the BSDF and therefore rarely hits the light.
fn uneven(adaptive: bool, seed: u64) -> Job {
    let IntegratorKind::Path(paths) = IntegratorKind::PATH else { unreachable!("`PATH` is a path tracer") };
    let method = IntegratorKind::Path(PathOptions { direct: DirectSampling::Bsdf, ..paths });
    let sampling = Sampling::Filtered { samples: 32, filter: Filter::Box { radius: 0.5 } };
    Job { width: 40, height: 32, sampling, adaptive, seed, method, ..Job::default() }
}

#[test]
fn adaptive_sampling_keeps_the_count_and_reduces_the_error() {
    let world = testing::read(UNEVEN);
    let made = |adaptive, seed| {
        let aovs = vec![Aov::from_name("sample-count").unwrap()];
        all(&world, &Job { aovs, ..uneven(adaptive, seed) })
    };
    let part = made(true, 0);
    let (rendered, pixels) = (part.pictures().unwrap(), 40 * 32);
    assert_eq!(
        (part.is_finished(), part.statistics().samples, part.work()),
        (true, 32 * pixels, (32 * pixels, 32 * pixels))
    );
    let counts: Vec<f32> = rendered.layers[1].image.pixels.iter().map(|p| p.x).collect();
    let (least, most) = counts.iter().fold((f32::MAX, 0.0_f32), |(a, b), &n| (a.min(n), b.max(n)));
    assert!(least == 8.0 && most >= 64.0, "{least} {most}");
    // Half the squared difference between two independent pictures estimates the squared error of
    // one of them.
    let colors = |adaptive, seed| made(adaptive, seed).pictures().unwrap().layers[0].image.pixels.clone();
    let error = |adaptive: bool| -> f64 {
        let pair = |seed| {
            let (a, b) = (colors(adaptive, seed), colors(adaptive, seed + 1));
            a.iter().zip(&b).map(|(a, b)| f64::from((*a - *b).length_squared())).sum::<f64>()
        };
        [1, 3, 5, 7].map(pair).iter().sum()
    };
    let (even, divided) = (error(false), error(true));
    assert!(divided < 0.8 * even, "{divided} {even}");
}

/// Compares the means of many pictures. If samples influenced the number of samples of their own
/// pixel, the pixel would become darker.
#[test]
fn adaptive_sampling_has_no_bias() {
    let world = testing::read(UNEVEN);
    let mean = |adaptive, seed| {
        let image =
            &all(&world, &Job { width: 24, height: 20, ..uneven(adaptive, seed) }).pictures().unwrap().layers[0].image;
        image.pixels.iter().map(|&pixel| luminance_of(pixel)).sum::<f64>() / image.pixels.len() as f64
    };
    let of = |adaptive, first: u64| {
        let means: Vec<f64> = (first..first + 200).map(|seed| mean(adaptive, seed)).collect();
        let n = means.len() as f64;
        let middle = means.iter().sum::<f64>() / n;
        (middle, means.iter().map(|m| (m - middle) * (m - middle)).sum::<f64>() / (n * (n - 1.0)))
    };
    let (even, divided) = (of(false, 1000), of(true, 0));
    let z = (divided.0 - even.0) / (divided.1 + even.1).sqrt();
    assert!(z.abs() < 4.0, "{z}: {divided:?} {even:?}");
}

#[test]
fn adaptive_renders_resume_from_any_point() {
    let world = testing::read(UNEVEN);
    let job = uneven(true, 3);
    let plain = all(&world, &job);
    let mut part = PartialRender::new(&world, &job, Shard::WHOLE).unwrap();
    let (mut undecided, mut decided) = (0, 0);
    for round in 0.. {
        let threads = Some(1 + round % 3);
        let control = Control { max_tiles: Some(3), tile_size: Some(8), threads, ..Control::default() };
        let outcome = part.render(&world, &control, &mut |_, _| {}).unwrap();
        let bytes = part.write();
        part = PartialRender::read(&bytes).unwrap();
        let (all, done) = part.work();
        assert_eq!((part.write() == bytes, all), (true, 32 * 40 * 32));
        *if done <= all / 4 { &mut undecided } else { &mut decided } += 1;
        if outcome == RenderOutcome::Finished {
            break;
        }
    }
    assert!(undecided > 2 && decided > 2, "{undecided} {decided}");
    assert_eq!((part.hash(), part.statistics()), (plain.hash(), plain.statistics()));
    let alone = [("x".to_string(), PartialRender::read(&part.write()).unwrap())];
    let merged = merge(&alone).unwrap();
    assert_eq!((merged.hash(), merged.statistics(), merged.write()), (plain.hash(), plain.statistics(), part.write()));
    // The bytes may contain anything as long as the checksum is valid.
    let bytes = part.write();
    for at in (0..bytes.len() - 32).step_by(11) {
        let mut changed = bytes[..bytes.len() - 32].to_vec();
        changed[at] ^= 1 << (at % 8);
        changed.extend(Digest::of(&changed).0);
        if let Ok(read) = PartialRender::read(&changed) {
            let _ = (read.pictures().unwrap(), read.work(), read.is_finished());
            assert!(read.write() == changed, "{at}: written differently");
        }
    }
}

#[test]
fn unsuitable_jobs_for_adaptive_sampling_are_rejected() {
    let world = testing::read(UNEVEN);
    let filtered = |samples| Sampling::Filtered { samples, filter: Filter::default() };
    let job = Job { sampling: filtered(16), ..uneven(true, 0) };
    let new = |job: &Job, shard| PartialRender::new(&world, job, shard).map(|_| ()).map_err(|error| error.to_string());
    assert_eq!(new(&job, Shard::WHOLE), Ok(()));
    let kept = |sampler, filter| Sampling::Course2004 { sampler, samples: 64, filter };
    let refused = [
        (Job { sampling: filtered(15), ..job.clone() }, "at least 16"),
        (Job { sampling: Sampling::Center, ..job.clone() }, "at least 16"),
        (Job { noise: Some(0.1), ..job.clone() }, "either"),
        (Job { method: IntegratorKind::Photons(Default::default()), ..job.clone() }, "photons"),
        (Job { sampling: kept(Sampler::Jittered, None), ..job.clone() }, "cannot be adaptive"),
        (
            Job { sampling: kept(Sampler::Random, Some(CourseFilter::Tent { radius: 1.0 })), ..job.clone() },
            "cannot be adaptive",
        ),
        (Job { sampling: Sampling::Course2012 { jitter: true, blur: true }, ..job.clone() }, "cannot be adaptive"),
    ];
    for (job, why) in refused {
        assert!(new(&job, Shard::WHOLE).unwrap_err().contains(why), "{why}");
    }
    for by in [ShardBy::Tiles, ShardBy::Samples] {
        assert!(new(&job, Shard { index: 1, count: 2, by }).unwrap_err().contains("cannot be split"));
    }
    assert!(matches!(BandedRender::new(&job, u64::MAX), Err(RenderError::Bands(_))));
}

#[test]
fn samples_follow_the_weights() {
    // Each pixel gets its pilot samples. The other samples are distributed in proportion to the
    // weights.
    assert_eq!([0.0, 1.0, 27.0].map(weight), [0.0, 1.0, 3.0]);
    assert_eq!(distribute(&[0.0, 1.0, 3.0, 0.0], 64), [16, 56, 168, 16]);
    assert_eq!(distribute(&[1.0; 5], 100), [100; 5]);
    // Either no pixel needs more samples, or one pixel gets the maximum.
    assert_eq!(distribute(&[0.0; 3], 64), [16; 3]);
    let mut one = [0.0; 1000];
    one[7] = 1e30;
    assert_eq!(distribute(&one, 64).iter().sum::<u32>(), 999 * 16 + 64 * 64);
    let many: Vec<f32> = (0..1000_u16).map(|i| f32::from(i * 37 % 101)).collect();
    for samples in [16, 50, 63] {
        let counts = distribute(&many, samples);
        assert_eq!(counts.iter().sum::<u32>(), 1000 * samples);
        assert!(counts.iter().all(|&n| n >= pilot(samples)));
    }
}

#[test]
fn sample_count_grows_to_its_target() {
    for (samples, target) in [(64, 16), (64, 1000), (16, 8), (100, 77)] {
        let counts: Vec<u32> = (0..=samples).map(|end| count(samples, target, end)).collect();
        assert!(counts.is_sorted());
        assert_eq!((counts[pilot(samples) as usize], counts.last()), (pilot(samples), Some(&target)));
    }
    assert_eq!((pilot(16), pilot(100), max_samples(64), max_samples(1 << 16)), (8, 24, 4096, 1 << 20));
}

#[test]
fn pixels_of_the_other_colour_estimate_the_variance() {
    let (width, height) = (15, 17);
    let mut variances = vec![0.0; width * height];
    for at in 0..variances.len() {
        variances[at] = 1.0;
        let found = neighbor_variances(&variances, width);
        let away = |i: usize| [(i % width).abs_diff(at % width), (i / width).abs_diff(at / width)];
        let tells = |i: usize| away(i).iter().sum::<usize>() % 2 == 1 && away(i).iter().all(|&way| way <= 6);
        assert!((0..found.len()).all(|i| (found[i] > 0.0) == tells(i)), "{at}");
        variances[at] = 0.0;
    }
    // A uniform variance stays uniform, even at the borders.
    assert!(neighbor_variances(&[2.0; 15], 5).iter().all(|value| (value - 2.0).abs() < 1e-5));
    assert_eq!(neighbor_variances(&[2.0], 1), [0.0]);
}
