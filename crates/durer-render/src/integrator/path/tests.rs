//! Tests of path tracing against closed-form solutions, with their sources or derivations.

use super::*;
use crate::compile::AccelKind;
use crate::compile::testing::{self, read};
use crate::integrator::{DirectSampling, TraceNode};
use crate::render::Job;
use durer_scene::dialect::Dialect;
use durer_scene::math::fp;
use durer_scene::spectrum::ColorMode;

mod area_lights;
mod caustics;
mod media;
mod sheets;
mod sides;
mod terms;

/// Returns the mean of many samples along a ray, and the standard error of the mean.
fn light(world: &World, ray: Ray, bounces: u32, samples: u32) -> (f64, f64) {
    let settings = RenderSettings { bounces, ..Job::default().settings };
    let path = Path::new(world, settings, PathOptions::default());
    let (mut sum, mut squares) = (0.0, 0.0);
    for sample in 0..samples {
        let value = f64::from(path.radiance(&ray, SampleId::new(7, (3, 5), sample), &mut ()).x);
        sum += value;
        squares += value * value;
    }
    let n = f64::from(samples);
    (sum / n, ((squares / n - (sum / n) * (sum / n)).max(0.0) / n).sqrt())
}

/// Returns the mean and variance of each colour channel over many samples along a ray, for both
/// strategies combined, for light sampling, and for BSDF sampling.
fn by_ways(world: &World, ray: Ray, settings: RenderSettings, color: ColorMode) -> [[(f64, f64); 3]; 3] {
    [DirectSampling::Both, DirectSampling::Lights, DirectSampling::Bsdf].map(|direct| {
        let path = Path::new(world, settings, PathOptions { color, direct, ..PathOptions::default() });
        let n = 1 << 14;
        let (mut sum, mut squares) = (DVec3::ZERO, DVec3::ZERO);
        // Use different pixels, so that the estimates are independent.
        for sample in 0..n {
            let id = SampleId::new(7, (direct as u32, 5), sample);
            let value = path.radiance(&ray, id, &mut ()).as_dvec3();
            (sum, squares) = (sum + value, squares + value * value);
        }
        let n = f64::from(n);
        let mean = sum / n;
        std::array::from_fn(|c| (mean[c], (squares[c] / n - mean[c] * mean[c]) / n))
    })
}

/// Asserts that the radiance along a ray has the expected value to within three standard errors
/// plus one part in a thousand.
fn assert_light(name: &str, world: &World, ray: Ray, bounces: u32, expected: f64) {
    let (mean, error) = light(world, ray, bounces, 1 << 15);
    assert!((mean - expected).abs() <= 3.0 * error + 0.001 * expected, "{name}: {mean} ± {error}, expected {expected}");
}

fn scene(materials: &str, lights: &str, group: &str) -> World {
    read(&format!(
        "PerspectiveCamera {{ center 0 0 5 direction 0 0 -1 up 0 1 0 angle 30 }}\nBackground {{ color 0 0 0 }}\n\
         Lights {{ {lights} }}\nMaterials {{ {materials} }}\nGroup {{ {group} }}"
    ))
}

const MATTE: &str = "PrincipledMaterial { baseColor 0.5 0.5 0.5 specularWeight 0 }";

/// Builds a scene with an emitter and a matte floor at y = 0 with albedo 0.5.
fn over_floor(lights: &str, emissive: &str) -> World {
    let materials = format!("{MATTE} PrincipledMaterial {{ baseColor 0 0 0 specularWeight 0 emissionLuminance 3 }}");
    let floor = "MaterialIndex 0 Plane { normal 0 1 0 offset 0 } MaterialIndex 1";
    scene(&materials, lights, &format!("{floor} {emissive}"))
}

/// Returns a ray that hits the floor at the origin.
fn to_origin() -> Ray {
    Ray::new(Vec3::new(2.0, 2.0, 0.0), Vec3::new(-1.0, -1.0, 0.0).normalize())
}

/// Returns the radiance of a floor with albedo 0.5 and irradiance E, which is 0.5 E / pi.
fn shown(irradiance: f64) -> f64 {
    0.5 * irradiance / std::f64::consts::PI
}

#[test]
fn closed_furnace_sums_a_geometric_series() {
    // The radiance is L = Le (1 - rho^n) / (1 - rho), where n counts the scattering events and the
    // emission itself.
    for form in ["Sphere { center 0 0 0 radius 2 }", "Box { min -2 -2 -2 max 2 2 2 }"] {
        let material = "PrincipledMaterial { baseColor 0.5 0.5 0.5 specularWeight 0 emissionLuminance 0.5 walls thin }";
        let world = scene(material, "", &format!("MaterialIndex 0 {form}"));
        let ray = Ray::new(Vec3::new(0.3, 0.2, 0.4), Vec3::new(0.3, 0.5, -0.7).normalize());
        for bounces in [0, 1, 4] {
            let power = (0..bounces + 2).fold(1.0, |power, _| 0.5 * power);
            assert_light(form, &world, ray, bounces, 0.5 * (1.0 - power) / 0.5);
        }
    }
}

/// Tests that distant objects keep their precision, both if only the area light is distant and if
/// the floor is distant too.
#[test]
fn distant_area_lights_are_as_accurate_as_near_ones() {
    let words = |p: Vec3| format!("{} {} {}", p.x, p.y, p.z);
    let seen = |at: Vec3| {
        let [p, low, high] = [2.0, 1.75, 2.25].map(|height| at + height * Vec3::Y);
        let corner = p - Vec3::new(0.5, 0.0, 0.5);
        [
            format!("Sphere {{ center {} radius 0.5 }}", words(p)),
            format!("Disc {{ center {} normal 0.6 -0.8 0 radius 0.5 }}", words(p)),
            format!("Rectangle {{ corner {} edge0 1 0.25 0 edge1 0 0 1 }}", words(corner)),
            format!("Cylinder {{ base {} top {} radius 0.375 }}", words(low), words(high)),
            format!(
                "Triangle {{ vertex0 {} vertex1 {} vertex2 {} }}",
                words(corner),
                words(corner + Vec3::X),
                words(corner + Vec3::Z)
            ),
        ]
        .map(|emitter| {
            let materials = format!("{MATTE} PrincipledMaterial {{ emissionLuminance 3 }}");
            let floor =
                format!("Rectangle {{ corner {} edge0 8 0 0 edge1 0 0 -8 }}", words(at + Vec3::new(-4.0, 0.0, 4.0)));
            let world = scene(&materials, "", &format!("MaterialIndex 0 {floor} MaterialIndex 1 {emitter}"));
            let ray = Ray { origin: at + to_origin().origin, ..to_origin() };
            (light(&world, ray, 0, 256).0, emitter)
        })
    };
    let near = seen(Vec3::ZERO);
    for distance in [1e2, 1e3, 1e4, 1e5] {
        for ((far, emitter), (near, _)) in seen(distance * Vec3::new(1.0, -0.75, 0.5)).into_iter().zip(&near) {
            assert!(*near > 0.05 && (far - near).abs() < 1e-3 * near, "{emitter}: {far}, expected {near}");
        }
    }
}

#[test]
fn suns_are_visible_directly_and_in_mirrors_and_light_the_floor() {
    // A disc of radiance L causes the irradiance pi c = 2 pi (1 - cos) L on a surface that faces
    // it.
    let half: f64 = 2.0;
    let radiance = 0.5 / (1.0 - durer_scene::math::fp::sin_cos_degrees(half).1);
    let mirror = "PrincipledMaterial { baseMetalness 1 baseColor 1 1 1 specularRoughness 0 }";
    let pane = "PrincipledMaterial { transmissionWeight 1 specularRoughness 0 walls thin }";
    let world = scene(
        &format!("{MATTE} {mirror} {pane}"),
        "DirectionalLight { direction 0 -1 0 color 1 1 1 spread 2 }",
        "MaterialIndex 0 Plane { normal 0 1 0 offset 0 } MaterialIndex 1 Rectangle { corner 9 1 -1 edge0 0 0 2 edge1 2 0 0 }
         MaterialIndex 2 Rectangle { corner 19 1 -1 edge0 2 0 0 edge1 0 0 2 }",
    );
    let ray = |x: f32, y: f32, degrees: f64, down: f32| {
        let (sin, cos) = durer_scene::math::fp::sin_cos_degrees(degrees);
        Ray::new(Vec3::new(x, y, 0.0), Vec3::new(sin as f32, down * cos as f32, 0.0))
    };
    for (name, ray, expected) in [
        ("middle", ray(0.0, 1.0, 0.0, 1.0), radiance),
        ("within", ray(0.0, 1.0, half - 0.002, 1.0), radiance),
        ("beside", ray(0.0, 1.0, half + 0.002, 1.0), 0.0),
        ("mirror", ray(10.0, 5.0, 1.0, -1.0), radiance),
        ("mirror, beside", ray(10.0, 5.0, 2.1, -1.0), 0.0),
        ("pane", ray(20.0, 0.5, 0.0, 1.0), radiance * 0.96 / 1.04),
        // A matte floor reflects half of the irradiance, which light samples and paths together
        // must count exactly once.
        ("floor", ray(0.0, 1.0, 10.0, -1.0), 0.5),
        ("floor below the pane", ray(20.0, 0.5, 0.0, -1.0), 0.5 * 0.96 / 1.04),
    ] {
        // Without bounces, light is not reflected back and forth between floor and pane.
        let bounces = if name.contains("below") { 0 } else { 3 };
        let (mean, error) = light(&world, ray, bounces, 4096);
        assert!(
            (mean - expected).abs() <= 4.0 * error + 2e-3 * expected,
            "{name}: {mean} ± {error}, expected {expected}"
        );
    }
}

#[test]
fn area_lights_emit_by_their_view_factors() {
    use std::f64::consts::PI;
    // For a sphere of radiance L and radius r whose centre is at distance d above the point, E = pi
    // L (r/d)^2.
    let sphere = over_floor("", "Sphere { center 0 3 0 radius 0.5 }");
    assert_light("sphere", &sphere, to_origin(), 0, shown(PI * 3.0 * (0.5 / 3.0) * (0.5 / 3.0)));
    // For a disc that faces downwards and has its axis through the point, E = pi L r^2 / (r^2 +
    // d^2).
    let disc = over_floor("", "Disc { center 0 2 0 normal 0 -1 0 radius 1.5 }");
    assert_light("disc", &disc, to_origin(), 0, shown(PI * 3.0 * 2.25 / (2.25 + 4.0)));
    let ring = over_floor("", "Disc { center 0 2 0 normal 0 -1 0 radius 1.5 innerRadius 0.75 }");
    let hole = 0.5625 / (0.5625 + 4.0);
    assert_light("ring", &ring, to_origin(), 0, shown(PI * 3.0 * (2.25 / (2.25 + 4.0) - hole)));
    // For a parallel rectangle with one corner above the point, Howell's configuration C-11 with x
    // = a/d and y = b/d gives 2 pi F = x / sqrt(1 + x^2) atan(y / sqrt(1 + x^2)) + y / sqrt(1 +
    // y^2) atan(x / sqrt(1 + y^2)).
    let factor = |x: f64, y: f64| {
        let (p, q) = ((1.0 + x * x).sqrt(), (1.0 + y * y).sqrt());
        (x / p * libm::atan(y / p) + y / q * libm::atan(x / q)) / (2.0 * PI)
    };
    let rectangle = over_floor("", "Rectangle { corner 0 2 0 edge0 3 0 0 edge1 0 0 1 }");
    assert_light("rectangle", &rectangle, to_origin(), 0, shown(PI * 3.0 * factor(1.5, 0.5)));
    let triangles =
        "Triangle { vertex0 0 2 0 vertex1 3 2 0 vertex2 3 2 1 } Triangle { vertex0 0 2 0 vertex1 3 2 1 vertex2 0 2 1 }";
    assert_light("triangles", &over_floor("", triangles), to_origin(), 0, shown(PI * 3.0 * factor(1.5, 0.5)));
    // Build the same rectangle with a transform.
    let moved =
        "Transform { Translate 0 2 0 YRotate 90 Scale 1 1 3 Rectangle { corner 0 0 0 edge0 0 0 1 edge1 -1 0 0 } }";
    assert_light("moved rectangle", &over_floor("", moved), to_origin(), 0, shown(PI * 3.0 * factor(1.5, 0.5)));
    // The back of the rectangle emits nothing.
    let away = over_floor("", "Rectangle { corner 0 2 0 edge0 0 0 1 edge1 3 0 0 }");
    assert_light("from behind", &away, to_origin(), 0, 0.0);
}

#[test]
fn partially_opaque_emitters_emit_in_part() {
    // A sphere of radius r at height h causes the irradiance pi L (r / h)^2.
    let whole = std::f64::consts::PI * 3.0 * 0.25 * 0.25;
    for (opacity, share) in [("1", 1.0), ("0.5", 0.5), ("0.25", 0.25)] {
        let light =
            format!("PrincipledMaterial {{ baseColor 0 0 0 specularWeight 0 emissionLuminance 3 opacity {opacity} }}");
        let group = "MaterialIndex 0 Plane { normal 0 1 0 offset 0 } MaterialIndex 1 Sphere { center 0 4 0 radius 1 }";
        assert_light(opacity, &scene(&format!("{MATTE} {light}"), "", group), to_origin(), 0, shown(share * whole));
    }
}

#[test]
fn bsdf_sampling_alone_agrees_with_light_sampling() {
    // A solid cannot be sampled as a light, so its light is found only by BSDF sampling. The solid
    // has the shape of a sphere, and a plain sphere can be sampled.
    let one = over_floor("", "Sphere { center -0.8 1.6 0 radius 0.8 }");
    let cut = "Intersection { Sphere { center -0.8 1.6 0 radius 0.8 } Sphere { center 0 1.6 0 radius 3 } }";
    let other = over_floor("", cut);
    let ((a, ea), (b, eb)) = (light(&one, to_origin(), 2, 1 << 15), light(&other, to_origin(), 2, 1 << 15));
    assert!((a - b).abs() < 4.0 * (ea * ea + eb * eb).sqrt(), "{a} ± {ea}, {b} ± {eb}");
    assert!(ea < 0.5 * eb, "light sampling must have less noise: {ea} {eb}");
    // A cylinder can be sampled, but a solid of the same shape cannot.
    let one = over_floor("", "Cylinder { base -0.4 1.2 0.3 top 0.3 2 0 radius 0.4 }");
    let cut =
        "Intersection { Cylinder { base -0.4 1.2 0.3 top 0.3 2 0 radius 0.4 } Sphere { center 0 1.6 0 radius 3 } }";
    let other = over_floor("", cut);
    let ((a, ea), (b, eb)) = (light(&one, to_origin(), 2, 1 << 15), light(&other, to_origin(), 2, 1 << 15));
    assert!((a - b).abs() < 4.0 * (ea * ea + eb * eb).sqrt(), "{a} ± {ea}, {b} ± {eb}");
    assert!(ea < 0.7 * eb, "light sampling must have less noise: {ea} {eb}");
}

#[test]
fn light_sampling_and_bsdf_sampling_alone_have_the_mean_of_both() {
    // The scene has a glossy floor under a sphere, a triangle and a uniform sky, with a point light
    // and a mirror nearby. The mean must not depend on the sampling strategy. There are 18 z-tests
    // of pairs of means; in one run out of 170, one of them exceeds 3.6 standard errors by chance.
    let materials = "PrincipledMaterial { baseColor 0.5 0.4 0.3 specularRoughness 0.35 }
        PrincipledMaterial { baseColor 0 0 0 specularWeight 0 emissionLuminance 3 }
        PrincipledMaterial { baseColor 1 1 1 baseMetalness 1 specularRoughness 0 }
        PrincipledMaterial { transmissionWeight 1 specularRoughness 0.5 }";
    let world = read(&format!(
        "PerspectiveCamera {{ center 0 0 5 direction 0 0 -1 up 0 1 0 angle 30 }} Background {{ color 0.2 0.2 0.2 }}
         Lights {{ PointLight {{ position 1 3 1 color 1 1 1 attenuation 0 0 1 }} }} Materials {{ {materials} }}
         Group {{ MaterialIndex 0 Plane {{ normal 0 1 0 offset 0 }} MaterialIndex 3 Sphere {{ center 1 0.5 -1 radius 0.5 }}
         MaterialIndex 1 Sphere {{ center -0.8 1.6 0 radius 0.8 }} Triangle {{ vertex0 1 2 0 vertex1 2 2 0 vertex2 2 2 1 }}
         MaterialIndex 2 Sphere {{ center -0.3 0.4 1 radius 0.4 }} }}"
    ));
    let settings = RenderSettings { bounces: 3, ..Job::default().settings };
    for (direction, color) in [(-1.0, ColorMode::Rgb), (-0.7, ColorMode::Rgb), (-1.0, ColorMode::Spectral)] {
        let ray = Ray::new(Vec3::new(2.0, 2.0, 0.0), Vec3::new(direction, -1.0, 0.0).normalize());
        let ways = by_ways(&world, ray, settings, color);
        for other in &ways[1..] {
            for ((a, va), (b, vb)) in ways[0].iter().zip(other) {
                assert!((a - b).abs() < 3.6 * (va + vb).sqrt(), "{ways:?}");
            }
        }
        // Each strategy alone must be noisier than both combined.
        assert!(ways[1..].iter().all(|half| half[1].1 > ways[0][1].1), "{ways:?}");
    }
}

#[test]
fn several_directions_to_an_environment_have_the_mean_of_one() {
    // The scene has rough metal, glass and lacquer under a sky with a small bright patch, a point
    // light, an area light and a wall. All strategies must have the same mean, according to
    // z-tests. (There are 48; in one run out of 300, one of them exceeds 4 standard errors by
    // chance.)
    let folder = tempfile::tempdir().unwrap();
    let mut sky = b"PF\n32 16\n-1\n".to_vec();
    for texel in 0..32 * 16_usize {
        let bright = (11..13).contains(&(texel / 32)) && (20..23).contains(&(texel % 32));
        let color = if bright { [60.0_f32, 50.0, 30.0] } else { [0.3, 0.4, 0.6] };
        sky.extend(color.iter().flat_map(|value| value.to_le_bytes()));
    }
    std::fs::write(folder.path().join("sky.pfm"), sky).unwrap();
    let text = "PerspectiveCamera { center 0 0 5 direction 0 0 -1 up 0 1 0 angle 30 }
        Background { environment sky.pfm color 0 0 0 }
        Lights { PointLight { position 1 3 1 color 0.5 1 1 attenuation 0 0 1 } }
        Materials { PrincipledMaterial { baseColor 0.9 0.7 0.4 baseMetalness 1 specularRoughness 0.3 }
        PrincipledMaterial { transmissionWeight 1 specularRoughness 0.4 }
        PrincipledMaterial { baseColor 0.05 0.05 0.05 specularRoughness 0.25 coatWeight 0.5 coatRoughness 0.1 }
        PrincipledMaterial { baseColor 0 0 0 specularWeight 0 emissionLuminance 3 }
        PrincipledMaterial { baseColor 0.5 0.5 0.5 specularWeight 0 } }
        Group { MaterialIndex 0 Sphere { center -2 0 0 radius 1 } MaterialIndex 1 Sphere { center 0 0 0 radius 0.9 }
        MaterialIndex 2 Sphere { center 2 0 0 radius 1 } MaterialIndex 3 Sphere { center 0 3 0 radius 0.3 }
        MaterialIndex 4 Plane { normal 0 1 0 offset -1 } }";
    let (world, found) = testing::try_read(text, Dialect::Durer.rules(), AccelKind::Bvh, folder.path());
    let world = world.unwrap_or_else(|| panic!("{found:?}"));
    let settings = RenderSettings { bounces: 3, ..Job::default().settings };
    for (x, y) in
        [(-2.0, 0.5), (-1.6, 0.2), (-2.5, -0.1), (0.3, 0.4), (-0.2, -0.3), (2.0, 0.6), (2.5, 0.3), (1.0, -0.9)]
    {
        let ray = Ray::new(Vec3::new(0.0, 1.0, 5.0), Vec3::new(x, y - 1.0, -4.5).normalize());
        let ways = by_ways(&world, ray, settings, ColorMode::Rgb);
        for other in &ways[1..] {
            for ((a, va), (b, vb)) in ways[0].iter().zip(other) {
                assert!((a - b).abs() < 4.0 * (va + vb).sqrt(), "{x} {y}: {ways:?}");
            }
        }
        // The first glossy vertex follows two directions, and all other vertices follow one.
        fn follow(node: &TraceNode, directions: u32) -> usize {
            let below = node.terms.iter().map(|term| match &term.kind {
                TermKind::Ray { bounce: Some(bounce), .. } => {
                    assert_eq!(bounce.directions, directions);
                    1 + follow(term, 1)
                }
                _ => 0,
            });
            below.sum()
        }
        let path = Path::new(&world, settings, PathOptions::default());
        let directions = if (x, y) == (1.0, -0.9) { 1 } else { 2 };
        let rays: usize = (0..64).map(|sample| follow(&terms::tree(&path, &ray, sample).root, directions)).sum();
        assert!(rays > 48, "{x} {y}: {rays}");
    }
}

#[test]
fn integrating_sphere_has_uniform_indirect_light() {
    // For a point light of intensity I in a sphere of area S and albedo rho, the irradiance is E =
    // I cos / d^2 + 4 pi I / S rho / (1 - rho). A light of colour c causes an irradiance of pi c at
    // distance 1.
    let world = scene(
        MATTE,
        "PointLight { position 0.5 0.8 0 color 1 1 1 attenuation 0 0 1 }",
        "MaterialIndex 0 Sphere { center 0 0 0 radius 2 }",
    );
    for direction in [Vec3::new(0.0, 0.0, -1.0), Vec3::new(-0.6, 0.5, 0.2).normalize()] {
        let ray = Ray::new(Vec3::ZERO, direction);
        let hit = 2.0 * direction.as_dvec3();
        let to_light = DVec3::new(0.5, 0.8, 0.0) - hit;
        let direct = to_light.normalize().dot(-direction.as_dvec3()) / to_light.length_squared();
        let everywhere = 4.0 * std::f64::consts::PI / (16.0 * std::f64::consts::PI) * 0.5 / (1.0 - 0.5);
        assert_light("integrating sphere", &world, ray, 40, shown(std::f64::consts::PI * (direct + everywhere)));
    }
}

#[test]
fn objects_without_absorption_vanish_in_a_uniform_environment() {
    for material in [
        "PrincipledMaterial { transmissionWeight 1 specularRoughness 0 }",
        "PrincipledMaterial { transmissionWeight 1 specularRoughness 0.6 }",
        "PrincipledMaterial { transmissionWeight 1 specularRoughness 0 walls thin }",
        "PrincipledMaterial { baseColor 1 1 1 baseMetalness 1 specularRoughness 0.5 }",
        "PrincipledMaterial { baseColor 1 1 1 specularRoughness 0.2 coatWeight 1 }",
        "PrincipledMaterial { baseColor 0 0 0 opacity 0 }",
        "HairMaterial { absorption 0 0 0 }",
        "HairMaterial { color 1 1 1 longitudinalRoughness 0.8 azimuthalRoughness 0.7 }",
        "PhongMaterial { diffuseColor 0 0 0 transparentColor 1 1 1 indexOfRefraction 1.4 }",
    ] {
        let text = format!(
            "PerspectiveCamera {{ center 0 0 5 direction 0 0 -1 up 0 1 0 angle 30 }} Background {{ color 0.7 0.7 0.7 }} \
             Materials {{ {material} }} Group {{ MaterialIndex 0 Sphere {{ center 0 0 0 radius 1 }} }}",
        );
        let world = read(&text);
        for x in [0.0, 0.6, 0.95] {
            let ray = Ray::new(Vec3::new(x, 0.0, 5.0), Vec3::NEG_Z);
            let (mean, error) = light(&world, ray, 200, 1 << 13);
            // For two interfaces, the tables of rough glass have an error of less than half a
            // percent.
            assert!((mean - 0.7).abs() < 3.0 * error + 0.005, "{material} at {x}: {mean} ± {error}");
        }
    }
}

#[test]
fn absorbing_slab_follows_beer_and_fresnel() {
    // At normal incidence, the transmittance is T = (1 - F)^2 a / (1 - F^2 a^2) with a = exp(-sigma
    // s). The radiance behind the slab is 1.
    let (f, a) = (0.04_f64, 0.3_f64);
    let glass = "PrincipledMaterial { transmissionWeight 1 specularRoughness 0 transmissionColor 0.3 0.3 0.3 transmissionDepth 2 }";
    let light = "PrincipledMaterial { baseColor 0 0 0 specularWeight 0 emissionLuminance 1 }";
    let world = scene(
        &format!("{glass} {light}"),
        "",
        "MaterialIndex 0 Box { min -9 -9 -1 max 9 9 1 } MaterialIndex 1 Rectangle { corner -9 -9 -3 edge0 18 0 0 edge1 0 18 0 }",
    );
    let ray = Ray::new(Vec3::new(0.1, 0.2, 5.0), Vec3::NEG_Z);
    assert_light("slab", &world, ray, 60, (1.0 - f) * (1.0 - f) * a / (1.0 - f * f * a * a));
}

#[test]
fn single_scattering_of_point_lights_off_matte_surfaces_is_whitteds() {
    let world = scene(
        "PhongMaterial { diffuseColor 0.8 0.5 0.3 }",
        "PointLight { position 3 4 5 color 1 1 1 attenuation 0 0 0.05 } DirectionalLight { direction -1 -2 -3 color 0.3 0.3 0.3 }",
        "MaterialIndex 0 Sphere { center 0 0 0 radius 1 } Plane { normal 0 1 0 offset -1 }",
    );
    let whitted = super::super::Whitted { world: &world, settings: Job::default().settings, cancel: None };
    for x in [-2.0, -0.5, 0.0, 0.4, 1.7] {
        let ray = Ray::new(Vec3::new(0.0, 1.0, 5.0), Vec3::new(0.2 * x, -0.25, -1.0).normalize());
        assert_light("Whitted's", &world, ray, 0, f64::from(whitted.radiance(&ray, &mut ()).x));
    }
}

#[test]
fn many_lights_equal_their_sum() {
    // Use 40 spheres on a spiral that do not occlude each other. If a sphere is entirely above the
    // horizon, E = pi L r^2 cos / d^2.
    let mut all = String::new();
    let mut irradiance = 0.0;
    for i in 0..40 {
        let (sin, cos) = fp::sin_cos_degrees(9.0 * f64::from(i));
        let (x, y, z, r) = (5.0 * cos, 1.5 + 0.3 * f64::from(i % 7), 5.0 * sin, 0.1);
        all += &format!("Sphere {{ center {x} {y} {z} radius {r} }} ");
        let d2 = x * x + y * y + z * z;
        irradiance += std::f64::consts::PI * 3.0 * r * r * y / (d2 * d2.sqrt());
    }
    assert_light("a ring of lights", &over_floor("", &all), to_origin(), 0, shown(irradiance));
}

#[test]
fn partially_opaque_screen_casts_a_partial_shadow() {
    let world = scene(
        &format!("{MATTE} PrincipledMaterial {{ baseColor 0 0 0 opacity 0.25 }}"),
        "PointLight { position 0 4 0 color 1 1 1 attenuation 0 0 1 }",
        "MaterialIndex 0 Plane { normal 0 1 0 offset 0 } MaterialIndex 1 Rectangle { corner -1 2 -1 edge0 2 0 0 edge1 0 0 2 }",
    );
    assert_light("screen", &world, to_origin(), 0, 0.75 * shown(std::f64::consts::PI / 16.0));
}

#[test]
fn cameras_and_delta_lights_see_through_hidden_backs() {
    let lit = shown(std::f64::consts::PI / 16.0);
    let (up, down) = ("edge0 0 0 1 edge1 1 0 0", "edge0 1 0 0 edge1 0 0 1");
    // The sheet is in front of the floor as seen either from the camera or from the light.
    for (corner, sides, expected) in
        [("0.5 1 -0.5", down, lit), ("0.5 1 -0.5", up, 0.0), ("-0.5 3 -0.5", down, lit), ("-0.5 3 -0.5", up, 0.0)]
    {
        let world = scene(
            &format!("{MATTE} PrincipledMaterial {{ baseColor 0 0 0 specularWeight 0 backs hidden }}"),
            "PointLight { position 0 4 0 color 1 1 1 attenuation 0 0 1 }",
            &format!(
                "MaterialIndex 0 Plane {{ normal 0 1 0 offset 0 }} MaterialIndex 1 Rectangle {{ corner {corner} {sides} }}"
            ),
        );
        assert_light(&format!("{corner} {sides}"), &world, to_origin(), 0, expected);
    }
}

#[test]
fn camera_looks_through_an_unseen_emitter_that_lights_the_floor() {
    let world = scene(
        &format!(
            "{MATTE} PrincipledMaterial {{ baseColor 0 0 0 specularWeight 0 emissionLuminance 1 seenByCamera off }}"
        ),
        "",
        "MaterialIndex 0 Plane { normal 0 1 0 offset 0 } MaterialIndex 1 Disc { center 0 0.5 0 normal 0 -1 0 radius 2 }",
    );
    // The disc is seen at an angle whose squared sine is the view factor.
    assert_light("disc", &world, to_origin(), 0, 0.5 * 4.0 / (4.0 + 0.25));
    assert!(world.first_seen(&to_origin(), None, &mut ()).is_some_and(|at| at.material == 0));
}
