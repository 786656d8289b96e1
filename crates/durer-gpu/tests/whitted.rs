//! Pictures of the Whitted integrator on the device compared with those of the CPU.

#![cfg(feature = "device")]

mod common;

use common::{colors, gpu, job, render, scene, world_of};
use durer_render::integrator::{IntegratorKind, RenderSettings};
use durer_render::render::Job;
use durer_render::world::World;
use durer_scene::math::Vec3;

const SIZE: (u32, u32) = (64, 48);

/// Differences between two pictures.
#[derive(Debug)]
struct Difference {
    /// Share of the pixels that differ by more than rounding.
    outliers: f64,
    /// Difference of the mean brightness, relative to the mean.
    mean: f64,
}

/// Compares pixels. Single precision and other functions for powers change a colour by about 1e-4.
/// A pixel on an edge, or one that shows an edge in a mirror or in glass, can change completely.
fn difference(a: &[Vec3], b: &[Vec3]) -> Difference {
    let is_outlier = |(a, b): (&Vec3, &Vec3)| {
        assert!(b.is_finite());
        (*a - *b).abs().max_element() > 1e-3 * (1.0 + a.abs().max_element())
    };
    let count = a.iter().zip(b).filter(|pair| is_outlier(*pair)).count();
    let sum = |colors: &[Vec3]| colors.iter().map(|c| f64::from(c.element_sum())).sum::<f64>();
    Difference { outliers: count as f64 / a.len() as f64, mean: (sum(b) / sum(a) - 1.0).abs() }
}

#[track_caller]
fn check(name: &str, world: &World, job: &Job, outliers: f64) {
    let Some(gpu) = gpu() else { return };
    let expected = colors(&render(world, job, None));
    let part = render(world, job, Some(&gpu));
    let found = difference(&expected, &colors(&part));
    eprintln!("{name}: {:.3} % of the pixels differ, mean by {:.1e}", 100.0 * found.outliers, found.mean);
    assert!(found.outliers <= outliers && found.mean < 2e-3, "{name}: {found:?}");
    assert_eq!(part.statistics().rejected, 0);
}

#[test]
fn pictures_of_scenes_equal_those_of_the_cpu() {
    // Mirrors and glass show many edges.
    for (name, outliers) in [
        ("sphere", 0.001),
        ("whitted", 0.003),
        ("glass", 0.01),
        ("mirrors", 0.02),
        ("highlights", 0.002),
        ("orthographic", 0.002),
        ("perspective", 0.002),
        ("coloured-lights", 0.002),
        ("falloff", 0.002),
        ("knot", 0.005),
        ("smooth-mesh", 0.003),
        ("landscape", 0.01),
        ("fisheye", 0.005),
        ("equirectangular", 0.005),
        ("thin-lens", 0.005),
        ("solid-textures", 0.005),
        ("machine", 0.01),
    ] {
        check(name, &scene(name), &job(IntegratorKind::WHITTED, SIZE), outliers);
    }
}

#[test]
fn settings_have_the_same_effect_as_on_the_cpu() {
    let world = scene("whitted");
    let job = job(IntegratorKind::WHITTED, SIZE);
    let settings = job.settings;
    for (name, settings) in [
        ("no shadows", RenderSettings { shadows: false, ..settings }),
        ("coloured shadows", RenderSettings { transparent_shadows: true, ..settings }),
        ("no reflection", RenderSettings { reflection: false, ..settings }),
        ("no refraction", RenderSettings { refraction: false, ..settings }),
        ("backs", RenderSettings { shade_back: false, ..settings }),
        ("no bounces", RenderSettings { bounces: 0, ..settings }),
        ("large weights", RenderSettings { min_weight: 0.3, ..settings }),
    ] {
        check(name, &world, &Job { settings, ..job.clone() }, 0.005);
    }
}

#[test]
fn nested_glass_and_patterns_equal_those_of_the_cpu() {
    let text = "PerspectiveCamera { center 0 1 7 direction 0 -0.1 -1 up 0 1 0 angle 40 }
        Background { color 0.3 0.5 0.8 ambientLight 0.2 0.2 0.2 }
        Lights { PointLight { position 3 5 4 color 1 1 1 attenuation 0.5 0.1 0 } SpotLight { position -3 6 3
            direction 0.5 -1 -0.4 color 30 20 20 angle 25 innerAngle 10 fade smooth } }
        Materials {
            PhongMaterial { diffuseColor 0.1 0.1 0.1 transparentColor 0.9 0.9 0.9 refractionIndex 1.5 specularColor 1 1 1 }
            PhongMaterial { transparentColor 0.9 1 0.9 refractionIndex 1.33 specularColor 1 1 1 diffuseColor 0 0 0 }
            PhongMaterial { diffuseColor 0.8 0.2 0.2 } PhongMaterial { diffuseColor 0.9 0.9 0.8 reflectiveColor 0.2 0.2 0.2 }
            Checkerboard { Transform { Scale 0.7 0.7 0.7 } materialIndex 2 materialIndex 3 }
            Mix { materialIndex 2 materialIndex 3 share 0.3 } TwoSided { materialIndex 2 materialIndex 5 }
            PrincipledMaterial { baseColor 0.8 0.6 0.2 baseMetalness 1 specularRoughness 0.2 }
        }
        Group {
            MaterialIndex 0 Sphere { center 0 0.2 0 radius 1.3 } MaterialIndex 1 Sphere { center 0.4 0.2 0.3 radius 0.6 }
            MaterialIndex 1 Box { min -2.6 -1 0 max -1.6 0.4 1 } MaterialIndex 4 Plane { normal 0 1 0 offset -1.1 }
            MaterialIndex 5 Cone { base 2.2 -1.1 0 top 2.2 0.7 0 baseRadius 0.6 topRadius 0.2 }
            MaterialIndex 6 Rectangle { corner -2 0.6 -2 edge0 1 0 0.4 edge1 0 1.4 0 }
            MaterialIndex 7 Cylinder { base 1 1.5 -1 top 2 2 -1 radius 0.3 }
        }";
    check("nested", &world_of(text), &job(IntegratorKind::WHITTED, SIZE), 0.015);
}

#[test]
fn same_picture_has_the_same_film() {
    let Some(gpu) = gpu() else { return };
    let world = scene("whitted");
    let job = job(IntegratorKind::WHITTED, SIZE);
    let [first, second] = [0; 2].map(|_| render(&world, &job, Some(&gpu)));
    assert_eq!(first.hash(), second.hash());
    assert_eq!(first.write(), second.write());
    assert_ne!(first.identity(), render(&world, &job, None).identity());
}
