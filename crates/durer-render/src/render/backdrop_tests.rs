//! Tests of pictures whose background is transparent or a colour.

use super::explain::explain;
use super::*;
use crate::compile::testing;
use crate::film::Filter;
use crate::film::course::CourseFilter;
use crate::integrator::IntegratorKind;
use crate::world::World;
use durer_image::Layer;
use durer_scene::math::{Color, Vec3};
use durer_scene::sampler::Sampler;

const BACKGROUND: Vec3 = Vec3::new(0.2, 0.1, 0.5);

/// A mirror that reflects the background, and a ball of glass through which it is seen.
const TEXT: &str = "PerspectiveCamera { center 0 1 8 direction 0 -0.1 -1 up 0 1 0 angle 40 }
Lights { PointLight { position 3 6 4 color 0.9 0.9 0.8 } }
Background { color 0.2 0.1 0.5 ambientLight 0.2 0.2 0.2 }
Materials {
  Material { diffuseColor 0.8 0.3 0.2 reflectiveColor 0.5 0.5 0.5 }
  Material { transparentColor 0.9 0.9 0.9 refractionIndex 1.5 } }
Group {
  MaterialIndex 0 Sphere { center -0.9 0.5 0 radius 1 }
  MaterialIndex 1 Sphere { center 1.1 0.5 0 radius 0.9 } }";

fn jobs() -> Vec<Job> {
    let samplings = [
        Sampling::Center,
        Sampling::Filtered { samples: 5, filter: Filter::default() },
        Sampling::Course2004 { sampler: Sampler::Jittered, samples: 4, filter: None },
    ];
    let job = |(sampling, method)| Job { width: 37, height: 29, sampling, method, ..Job::default() };
    let both = |sampling| [IntegratorKind::WHITTED, IntegratorKind::PATH].map(|method| (sampling, method));
    samplings.into_iter().flat_map(both).map(job).collect()
}

fn layer(world: &World, job: &Job) -> Layer {
    render(world, job, &Control::default()).unwrap().layers.remove(0)
}

/// Returns the pixels of a layer over a colour.
fn over(layer: &Layer, background: Color) -> Vec<Color> {
    let coverage = layer.coverage.as_ref().expect("the corners are transparent");
    layer.image.pixels.iter().zip(coverage).map(|(&pixel, share)| pixel + (1.0 - share) * background).collect()
}

fn assert_near(a: &[Color], b: &[Color]) {
    for (a, b) in a.iter().zip(b) {
        assert!((*a - *b).abs().max_element() < 1e-6, "{a} {b}");
    }
}

#[test]
fn transparent_picture_over_the_background_is_the_picture() {
    let world = testing::read(TEXT);
    for job in jobs() {
        let whole = layer(&world, &job);
        let open = layer(&world, &Job { backdrop: Some(Backdrop::Transparent), ..job.clone() });
        assert_near(&over(&open, BACKGROUND), &whole.image.pixels);
        let coverage = open.coverage.as_ref().unwrap();
        assert_eq!((coverage[0], coverage[37 * 14 + 13]), (0.0, 1.0));
        assert_eq!(job.sampling == Sampling::Center, coverage.iter().all(|share| [0.0, 1.0].contains(share)));
        let white = layer(&world, &Job { backdrop: Some(Backdrop::Color(Vec3::ONE)), ..job });
        assert_eq!(white.coverage, None);
        assert_near(&over(&open, Vec3::ONE), &white.image.pixels);
    }
}

#[test]
fn filters_of_the_course_give_partial_coverage() {
    let (sampler, filter) = (Sampler::Jittered, Some(CourseFilter::Tent { radius: 1.5 }));
    let sampling = Sampling::Course2004 { sampler, samples: 4, filter };
    let (world, job) = (testing::read(TEXT), Job { width: 37, height: 29, sampling, ..Job::default() });
    let open = layer(&world, &Job { backdrop: Some(Backdrop::Transparent), ..job.clone() });
    assert_near(&over(&open, BACKGROUND), &layer(&world, &job).image.pixels);
    let colored = Job { backdrop: Some(Backdrop::Color(Vec3::ONE)), ..job };
    assert!(matches!(colored.validate(), Err(RenderError::Job(message)) if message.contains("filters of the course")));
}

#[test]
fn explanations_sum_to_the_pixel() {
    let world = testing::read(TEXT);
    for job in jobs() {
        for backdrop in [Backdrop::Transparent, Backdrop::Color(Vec3::new(0.9, 1.0, 2.0))] {
            let job = Job { backdrop: Some(backdrop), ..job.clone() };
            let picture = layer(&world, &job);
            for (x, y) in [(0, 0), (13, 14), (24, 14), (18, 9), (9, 7)] {
                let explanation = explain(&world, &job, x, y).unwrap();
                let at = (y * 37 + x) as usize;
                assert_eq!(explanation.color, picture.image.pixels[at], "{x} {y}");
                assert_eq!(explanation.coverage, picture.coverage.as_ref().map_or(1.0, |shares| shares[at]));
            }
        }
    }
}

#[test]
fn camera_sees_the_background_through_cutouts_and_unseen_surfaces() {
    let world = testing::read(
        "PerspectiveCamera { center 0 0 5 direction 0 0 -1 up 0 1 0 angle 30 }
         Background { color 0.2 0.3 0.4 }
         Materials {
             PrincipledMaterial { opacity 0.25 }
             PrincipledMaterial { emissionLuminance 1 seenByCamera off }
         }
         Group {
             MaterialIndex 0 Rectangle { corner -9 -9 0 edge0 18 0 0 edge1 0 18 0 }
             MaterialIndex 1 Sphere { center 0 0 2 radius 0.5 }
         }",
    );
    let background = Color::new(0.2, 0.3, 0.4);
    let sampling = Sampling::Filtered { samples: 256, filter: Filter::default() };
    let job = Job { width: 8, height: 8, sampling, method: IntegratorKind::PATH, ..Job::default() };
    let whole = layer(&world, &job);
    let open = layer(&world, &Job { backdrop: Some(Backdrop::Transparent), ..job.clone() });
    assert_near(&over(&open, background), &whole.image.pixels);
    let coverage = open.coverage.as_ref().unwrap();
    assert!(coverage.iter().all(|share| (share - 0.25).abs() < 0.1), "{coverage:?}");
    let mean = coverage.iter().sum::<f32>() / coverage.len() as f32;
    assert!((mean - 0.25).abs() < 0.01, "{mean}");
}

#[test]
fn fog_has_no_background() {
    let world = testing::read(&format!("{TEXT}\nFog {{ extinction 0.1 }}"));
    let job = Job { backdrop: Some(Backdrop::Transparent), ..Job::default() };
    let refused = |error| matches!(error, RenderError::Job(message) if message.contains("fog"));
    assert!(refused(render(&world, &job, &Control::default()).unwrap_err()));
    assert!(refused(explain(&world, &job, 0, 0).unwrap_err()));
}

#[test]
fn invalid_colors_are_refused() {
    for color in [Vec3::new(0.0, -0.1, 0.0), Vec3::splat(f32::NAN), Vec3::splat(f32::INFINITY)] {
        let job = Job { backdrop: Some(Backdrop::Color(color)), ..Job::default() };
        assert!(matches!(job.validate(), Err(RenderError::Job(message)) if message.contains("background")));
    }
}
