//! Path tracing on the device compared with that of the CPU.

#![cfg(feature = "device")]

mod common;

use common::{colors, gpu, path_job, render, scene, world_of};
use durer_gpu::GpuDevice;
use durer_render::integrator::{IntegratorKind, PathOptions};
use durer_render::render::Job;
use durer_render::world::World;
use durer_scene::math::{LUMINANCE, Vec3};
use std::sync::Arc;

const SIZE: (u32, u32) = (16, 12);
/// Number of independent pictures whose pixels are averaged.
const SEEDS: u64 = 16;

/// Mean and squared standard error of each pixel's luminance over independent seeds.
fn statistics(world: &World, job: &Job, gpu: Option<&Arc<GpuDevice>>) -> Vec<(f64, f64)> {
    let mut sums = vec![(0.0, 0.0); (job.width * job.height) as usize];
    for seed in 0..SEEDS {
        // Other seeds on the device, so that the two sets of pictures are independent.
        let seed = seed + if gpu.is_some() { 1000 } else { 0 };
        for (sum, color) in sums.iter_mut().zip(colors(&render(world, &Job { seed, ..job.clone() }, gpu))) {
            let y = f64::from(color.dot(LUMINANCE));
            (sum.0, sum.1) = (sum.0 + y, sum.1 + y * y);
        }
    }
    let n = SEEDS as f64;
    let of = |(sum, squares): (f64, f64)| {
        let mean = sum / n;
        (mean, ((squares / n - mean * mean).max(0.0) / (n - 1.0)).max(1e-14))
    };
    sums.into_iter().map(of).collect()
}

/// Compares the pixels by z-tests with Šidák's correction, and the means of the pictures.
#[track_caller]
fn check(name: &str, world: &World, job: &Job) {
    let Some(gpu) = gpu() else { return };
    let (expected, found) = (statistics(world, job, None), statistics(world, job, Some(&gpu)));
    // With 192 pixels and a significance of 0.001, Šidák's level is 5.2e-6 for each pixel. The
    // two-sided quantile of Student's distribution with 30 degrees of freedom is 5.5 there.
    let z = |(a, b): (&(f64, f64), &(f64, f64))| (a.0 - b.0).abs() / (a.1 + b.1).sqrt().max(1e-5 * a.0);
    let worst = expected.iter().zip(&found).map(z).fold(0.0, f64::max);
    let total = |pixels: &[(f64, f64)]| pixels.iter().fold((0.0, 0.0), |sum, p| (sum.0 + p.0, sum.1 + p.1));
    let (a, b) = (total(&expected), total(&found));
    let (ratio, whole) = (b.0 / a.0 - 1.0, (a.0 - b.0).abs() / (a.1 + b.1).sqrt());
    eprintln!("{name}: largest z {worst:.2}, means differ by {:.3} % (z {whole:.2})", 100.0 * ratio);
    assert!(worst < 5.5 && whole < 3.9 && ratio.abs() < 0.02, "{name}: z {worst}, mean z {whole}");
}

#[test]
fn diffuse_light_equals_that_of_the_cpu() {
    check("cornell-box", &scene("cornell-box"), &path_job(SIZE, 16, 5, 0));
}

/// A room with one kind of light.
fn room(lights: &str, lamp: &str) -> World {
    world_of(&format!(
        "PerspectiveCamera {{ center 0 1.5 5.5 direction 0 -0.15 -1 up 0 1 0 angle 45 }} Background {{ color 0.2 0.25 0.3 }}
        Lights {{ {lights} }} Materials {{
            PhongMaterial {{ diffuseColor 0.7 0.7 0.6 specularColor 0.2 0.2 0.2 exponent 20 }}
            PhongMaterial {{ diffuseColor 0.1 0.1 0.1 reflectiveColor 0.8 0.8 0.8 }}
            PhongMaterial {{ diffuseColor 0 0 0 specularColor 1 1 1 transparentColor 1 1 1 refractionIndex 1.5 }}
            PrincipledMaterial {{ baseColor 0 0 0 specularWeight 0 emissionLuminance 8 emissionColor 1 0.8 0.6 }}
            PrincipledMaterial {{ baseColor 0.6 0.3 0.2 specularWeight 0 baseDiffuseRoughness 0.8 }}
            Checkerboard {{ materialIndex 0 materialIndex 4 }}
        }} Group {{
            MaterialIndex 5 Plane {{ normal 0 1 0 offset -0.501 }} MaterialIndex 1 Sphere {{ center -1.2 0.3 0 radius 0.8 }}
            MaterialIndex 2 Sphere {{ center 1 0.3 0.6 radius 0.8 }}
            MaterialIndex 4 Transform {{ Translate 0 0 -1 YRotate 30 Box {{ min -0.5 -0.5 -0.5 max 0.5 1.5 0.5 }} }}
            MaterialIndex 3 {lamp}
        }}"
    ))
}

#[test]
fn every_kind_of_light_equals_that_of_the_cpu() {
    let job = path_job(SIZE, 16, 4, 0);
    for (name, lights, lamp) in [
        ("background", "", ""),
        ("point", "PointLight { position 2 4 3 color 20 18 16 attenuation 0 0 1 }", ""),
        ("spot", "SpotLight { position 1 5 2 direction -0.2 -1 -0.3 color 60 60 40 angle 40 innerAngle 20 }", ""),
        ("sun", "DirectionalLight { direction -0.3 -1 -0.4 color 0.8 0.8 0.7 spread 4 }", ""),
        ("sphere", "", "Sphere { center 0.5 3 0.5 radius 0.6 }"),
        ("disc", "", "Disc { center 0 3.5 0 normal 0 -1 0 radius 1 innerRadius 0.4 }"),
        ("rectangle", "", "Rectangle { corner -1 3.5 -1 edge0 2 0 0 edge1 0 0 2 }"),
        ("triangle", "", "Triangle { vertex0 -1 3.2 -1 vertex1 1.5 3 0 vertex2 0 3.6 1.5 }"),
        ("box", "", "Box { min -0.7 2.8 -0.7 max 0.7 3.2 0.7 }"),
        ("both", "PointLight { position 2 4 3 color 0.5 0.4 0.3 }", "Sphere { center -2 3 0.5 radius 0.4 }"),
    ] {
        check(name, &room(lights, lamp), &job);
    }
}

#[test]
fn principled_materials_equal_those_of_the_cpu() {
    let job = path_job(SIZE, 16, 5, 0);
    for (name, material) in [
        ("plastic", "baseColor 0.8 0.3 0.2 specularRoughness 0.3"),
        ("smooth plastic", "baseColor 0.2 0.3 0.8 specularRoughness 0"),
        (
            "rough plastic",
            "baseColor 0.2 0.8 0.3 specularRoughness 0.9 baseDiffuseRoughness 0.7 specularColor 1 0.8 0.6",
        ),
        ("metal", "baseColor 0.9 0.7 0.3 baseMetalness 1 specularRoughness 0.4 specularColor 0.9 0.9 1"),
        ("mirror", "baseColor 0.9 0.7 0.3 baseMetalness 1 specularRoughness 0"),
        ("half metal", "baseColor 0.9 0.7 0.3 baseMetalness 0.5 specularRoughness 0.6 energyCompensation off"),
        ("glass", "transmissionWeight 1 transmissionColor 0.8 1 0.9 specularRoughness 0"),
        ("half glass", "baseColor 0.7 0.2 0.2 transmissionWeight 0.5 specularRoughness 0 specularIor 1.3"),
    ] {
        let world = world_of(&format!(
            "PerspectiveCamera {{ center 0 1.2 4.5 direction 0 -0.2 -1 up 0 1 0 angle 45 }} Background {{ color 0.3 0.35 0.5 }}
            Materials {{ PrincipledMaterial {{ baseColor 0.6 0.6 0.6 specularWeight 0 }} PrincipledMaterial {{ {material} }}
                PrincipledMaterial {{ baseColor 0 0 0 specularWeight 0 emissionLuminance 6 }} }}
            Group {{ MaterialIndex 0 Plane {{ normal 0 1 0 offset -0.7 }} MaterialIndex 1 Sphere {{ center -0.8 0.1 0 radius 0.8 }}
            Transform {{ Translate 1 0 0.3 YRotate 30 Box {{ min -0.5 -0.7 -0.5 max 0.5 0.5 0.5 }} }}
            MaterialIndex 2 Rectangle {{ corner -1 3 -1 edge0 2 0 0 edge1 0 0 2 }} }}"
        ));
        check(name, &world, &job);
    }
}

#[test]
fn clamped_light_equals_that_of_the_cpu() {
    let method = IntegratorKind::Path(PathOptions { clamp: Some(0.5), ..PathOptions::default() });
    let world = room("", "Sphere { center 0.5 3 0.5 radius 0.6 }");
    check("clamp", &world, &Job { method, ..path_job(SIZE, 16, 4, 0) });
}

#[test]
fn white_furnace_stays_white() {
    let Some(gpu) = gpu() else { return };
    // Surfaces that reflect all light, in front of a white background, are invisible.
    for material in [
        "PrincipledMaterial { baseColor 1 1 1 specularWeight 0 }",
        "PrincipledMaterial { baseColor 1 1 1 specularWeight 0 baseDiffuseRoughness 1 }",
        "PhongMaterial { diffuseColor 0 0 0 reflectiveColor 1 1 1 }",
        "PrincipledMaterial { baseColor 1 1 1 specularRoughness 0.3 }",
        "PrincipledMaterial { baseColor 1 1 1 baseMetalness 1 specularRoughness 0.5 }",
        "PrincipledMaterial { transmissionWeight 1 specularRoughness 0 }",
    ] {
        let world = world_of(&format!(
            "PerspectiveCamera {{ center 0 0 5 direction 0 0 -1 up 0 1 0 angle 40 }} Background {{ color 1 1 1 }}
            Materials {{ {material} }} Group {{ MaterialIndex 0 Sphere {{ center 0 0 0 radius 1 }}
            Transform {{ Translate 1 0.8 0.3 XRotate 20 Box {{ min -0.4 -0.4 -0.4 max 0.4 0.4 0.4 }} }}
            Cylinder {{ base -1.5 -1 0 top -1.2 0.5 0 radius 0.3 }} }}"
        ));
        let pixels = colors(&render(&world, &path_job((40, 30), 64, 100, 0), Some(&gpu)));
        let mean = pixels.iter().copied().sum::<Vec3>() / pixels.len() as f32;
        eprintln!("{material}: mean {mean}");
        // Facets return the radiance only on average.
        let is_exact = !material.contains("specularRoughness");
        let allowed = if is_exact { 0.003 } else { 0.01 };
        assert!((mean - 1.0).abs().max_element() < allowed, "{material}: {mean}");
    }
}

#[test]
fn same_seed_gives_the_same_film() {
    let Some(gpu) = gpu() else { return };
    let world = room("", "Sphere { center 0.5 3 0.5 radius 0.6 }");
    let job = path_job((40, 30), 8, 4, 3);
    let [first, second] = [0; 2].map(|_| render(&world, &job, Some(&gpu)));
    assert_eq!(first.hash(), second.hash());
    assert_ne!(first.hash(), render(&world, &Job { seed: 4, ..job }, Some(&gpu)).hash());
}
