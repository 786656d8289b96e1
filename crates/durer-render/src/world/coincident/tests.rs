//! Tests that no surface is lost behind another one at the same place.

use crate::compile::testing::read;
use crate::integrator::{Integrate, Path, PathOptions, RenderSettings, Whitted};
use crate::render::Job;
use crate::world::World;
use durer_scene::math::{Ray, Vec3};
use durer_scene::sampler::SampleId;

/// Returns the mean radiance of paths along a ray, and its standard error.
fn light(world: &World, ray: Ray, samples: u32) -> (f64, f64) {
    let settings = RenderSettings { bounces: 6, ..Job::default().settings };
    let path = Path::new(world, settings, PathOptions::default());
    let values = (0..samples).map(|i| f64::from(path.radiance(&ray, SampleId::new(3, (1, 2), i), &mut ()).y));
    let (sum, squares) = values.fold((0.0, 0.0), |(sum, squares), x| (sum + x, squares + x * x));
    let n = f64::from(samples);
    (sum / n, ((squares / n - (sum / n) * (sum / n)).max(0.0) / n).sqrt())
}

fn scene(lights: &str, objects: &[&str]) -> World {
    read(&format!(
        "PerspectiveCamera {{ center 0 3 0 direction 0 -1 0 up 0 0 -1 angle 20 }}
        {lights}
        Materials {{
            PrincipledMaterial {{ baseColor 0.5 0.5 0.5 specularWeight 0 }}
            PrincipledMaterial {{ transmissionWeight 1 specularIor 1 transmissionDepth 1 transmissionColor 0.4 0.4 0.4 }}
            PrincipledMaterial {{ baseColor 1 1 1 specularWeight 0 opacity 0 }}
            PrincipledMaterial {{ baseColor 0 0 0 specularWeight 0 }}
            PrincipledMaterial {{ transmissionWeight 1 specularIor 1.5 specularRoughness 0 }}
        }}
        Group {{ {} }}",
        objects.join(" ")
    ))
}

const DOWN: Ray = Ray::new(Vec3::new(0.11, 3.0, 0.07), Vec3::NEG_Y);

/// Below each pair is a bright background. The floor hides it, whichever object comes first.
#[test]
fn floors_below_passed_surfaces_are_not_lost() {
    let floor = "MaterialIndex 3 Rectangle { corner -2 0 2 edge0 4 0 0 edge1 0 0 -4 }";
    for other in [
        "MaterialIndex 1 Box { min -0.5 0 -0.5 max 0.5 1 0.5 }",
        "MaterialIndex 1 Transform { Rotate { 0 1 0 30 } Box { min -0.5 0 -0.5 max 0.5 1 0.5 } }",
        "MaterialIndex 2 Rectangle { corner -0.5 0 0.5 edge0 1 0 0 edge1 0 0 -1 }",
        "MaterialIndex 2 Disc { center 0 0 0 normal 0 1 0 radius 0.5 }",
    ] {
        for objects in [[other, floor], [floor, other]] {
            let world = scene("Background { color 1 1 1 }", &objects);
            let (mean, _) = light(&world, DOWN, 16);
            assert!(mean == 0.0, "{objects:?}: {mean}");
        }
    }
}

/// A floor below glass is not lost either, although rays that leave the glass start a little behind
/// it. The picture shows at most the reflection of the background, of 4 % at each crossing.
#[test]
fn floors_below_glass_are_not_lost() {
    let floor = "MaterialIndex 3 Rectangle { corner -2 0 2 edge0 4 0 0 edge1 0 0 -4 }";
    let plane = "MaterialIndex 3 Plane { normal 0 1 0 offset 0 }";
    for glass in [
        "Box { min -0.5 0 -0.5 max 0.5 1 0.5 }",
        "Transform { Rotate { 0 1 0 30 } Box { min -0.5 0 -0.5 max 0.5 1 0.5 } }",
        "Transform { Translate 0 0.7 0 Rotate { 1 0 0 90 } Box { min -0.5 -0.5 -0.7 max 0.5 0.5 0.7 } }",
        "Cylinder { base 0 0 0 top 0 0.3 0 radius 0.5 }",
    ] {
        let glass = format!("MaterialIndex 4 {glass}");
        for below in [floor, plane] {
            for objects in [[glass.as_str(), below], [below, glass.as_str()]] {
                let world = scene("Background { color 1 1 1 }", &objects);
                let whitted = Whitted {
                    world: &world,
                    settings: RenderSettings { bounces: 6, ..Job::default().settings },
                    cancel: None,
                };
                let seen = f64::from(whitted.radiance(&DOWN, &mut ()).y);
                let (mean, error) = light(&world, DOWN, 1 << 10);
                assert!(seen < 0.09 && mean < 0.09 + 4.0 * error, "{objects:?}: {seen}, {mean} ± {error}");
            }
        }
    }
}

/// A point below a decal in a ceiling stays dark, because the ceiling blocks the shadow ray.
#[test]
fn shadow_rays_do_not_pass_walls_behind_decals() {
    let floor = "MaterialIndex 0 Rectangle { corner -9 0 9 edge0 18 0 0 edge1 0 0 -18 }";
    let ceiling = "MaterialIndex 3 Rectangle { corner -9 4 9 edge0 18 0 0 edge1 0 0 -18 }";
    let decal = "MaterialIndex 2 Rectangle { corner -2 4 2 edge0 4 0 0 edge1 0 0 -4 }";
    let lights = "Background { color 0 0 0 } Lights { PointLight { position 0 9 0 color 99 99 99 } }";
    for objects in [[floor, ceiling, decal], [floor, decal, ceiling]] {
        let (mean, _) = light(&scene(lights, &objects), DOWN, 16);
        assert!(mean == 0.0, "{objects:?}: {mean}");
    }
    let (mean, _) = light(&scene(lights, &[floor, decal]), DOWN, 16);
    assert!(mean > 1.0, "the decal itself lets light pass: {mean}");
}

/// Light that a floor reflects crosses the medium that stands on it again: twice the height of 1 at
/// 0.4 for each unit. The floor is lit by a background of 1, also through the medium.
#[test]
fn media_that_stand_on_a_floor_fill_the_space_above_it() {
    let floor = "MaterialIndex 0 Rectangle { corner -99 0 99 edge0 198 0 0 edge1 0 0 -198 }";
    let of = |lift: f32, first: bool| {
        let medium = format!("MaterialIndex 1 Box {{ min -9 {lift} -9 max 9 1 9 }}");
        let objects = if first { [medium.as_str(), floor] } else { [floor, medium.as_str()] };
        light(&scene("Background { color 1 1 1 }", &objects), DOWN, 1 << 13)
    };
    let (expected, error) = of(0.001, false);
    for (lift, first) in [(0.001, true), (0.0, true), (0.0, false)] {
        let (mean, own) = of(lift, first);
        assert!((mean - expected).abs() < 4.0 * (own + error), "{lift} {first}: {mean} and not {expected}");
    }
    // Without the medium above the floor, the light would cross it once.
    assert!(expected < 0.5 * 0.4 * 0.4 + 0.02, "{expected}");
}
