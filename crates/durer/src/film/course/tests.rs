use super::*;
use crate::sampler::{Sampler, random_2d};

const FILTERS: [Option<CourseFilter>; 5] = [
    None,
    Some(CourseFilter::Box { radius: 0.5 }),
    Some(CourseFilter::Box { radius: 1e-3 }),
    Some(CourseFilter::Tent { radius: 1.5 }),
    Some(CourseFilter::Gaussian { sigma: 0.6 }),
];

fn random_samples(n: u32, color: impl Fn(u32, u32, u32) -> Color + Sync) -> StoredSamples {
    StoredSamples::take(23, 17, n, |x, y, s| {
        let position = Sampler::Random.pixel_position(1, x, y, s, n);
        StoredSample { position, color: color(x, y, s) }
    })
}

#[test]
fn threads_change_no_bit() {
    let make = || {
        let samples = random_samples(4, |x, y, s| random_2d(2, x, y, s, 1).extend(0.5) * 1e3);
        FILTERS.map(|filter| {
            samples.reconstruct(filter).iter().map(|c| c.to_array().map(f32::to_bits)).collect::<Vec<_>>()
        })
    };
    let with_threads = |n| rayon::ThreadPoolBuilder::new().num_threads(n).build().unwrap().install(make);
    assert_eq!(with_threads(1), with_threads(5));
}

#[test]
fn one_colour_stays_that_colour() {
    let color = Vec3::new(0.1, 0.7, 12.3);
    let samples = random_samples(7, |_, _, _| color);
    for filter in FILTERS {
        assert!(samples.reconstruct(filter).iter().all(|&c| c == color), "{filter:?}");
    }
}

#[test]
fn supports_are_the_courses() {
    let boxed = |radius| CourseFilter::Box { radius }.support();
    assert_eq!([0.5, 0.6, 1.5, 1.7, 2.3, -3.0, f32::NAN].map(boxed), [0, 1, 1, 2, 2, 0, 0]);
    let gaussian = |sigma| CourseFilter::Gaussian { sigma }.support();
    assert_eq!([0.25, 0.6, 1.0, 1.7, 2.3].map(gaussian), [0, 1, 2, 3, 5]);
    // Further than the picture is wide.
    let samples = random_samples(1, |x, _, _| Vec3::splat(x as f32));
    let picture = samples.reconstruct(Some(CourseFilter::Box { radius: f32::INFINITY }));
    assert!(picture.iter().all(|c| (c.x - 11.0).abs() < 1e-5));
}
