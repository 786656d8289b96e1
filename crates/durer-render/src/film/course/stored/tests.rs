use super::*;
use durer_scene::math::Vec3;
use durer_scene::sampler::{Sampler, random_2d};

const FILTERS: [CourseFilter; 4] = [
    CourseFilter::Box { radius: 0.5 },
    CourseFilter::Box { radius: 1e-3 },
    CourseFilter::Tent { radius: 1.5 },
    CourseFilter::Gaussian { sigma: 0.6 },
];

fn random_samples(n: u32, color: impl Fn(u32, u32, u32) -> Color) -> StoredSamples {
    StoredSamples::take(23, 17, n, |x, y, s| {
        let position = Sampler::Random.pixel_position(1, x, y, s, n);
        StoredSample { position, color: color(x, y, s) }
    })
}

#[test]
fn part_equals_that_of_the_whole_picture() {
    let color = |x, y, s| random_2d(2, x, y, s, 1).extend(0.5) * 1e3;
    let samples = random_samples(4, color);
    for filter in FILTERS {
        let whole = samples.reconstruct(filter);
        let (left, top, width, height) = (9, 7, 5, 4);
        // Take only the samples that this part of the picture needs.
        let reach = filter.support();
        let around = StoredSamples::take(width + 2 * reach, height + 2 * reach, 4, |x, y, s| {
            samples.pixel(x + left - reach, y + top - reach)[s as usize]
        });
        let part = around.try_reconstruct(filter, (reach, reach), (width, height), || Ok::<_, ()>(())).unwrap();
        for (i, pixel) in part.iter().enumerate() {
            let (x, y) = (left as usize + i % width as usize, top as usize + i / width as usize);
            assert_eq!(pixel.to_array().map(f32::to_bits), whole[y * 23 + x].to_array().map(f32::to_bits));
        }
    }
}

#[test]
fn constant_colour_is_preserved() {
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
    // This support is larger than the width of the picture.
    let samples = random_samples(1, |x, _, _| Vec3::splat(x as f32));
    let picture = samples.reconstruct(CourseFilter::Box { radius: f32::INFINITY });
    assert!(picture.iter().all(|c| (c.x - 11.0).abs() < 1e-5));
}
