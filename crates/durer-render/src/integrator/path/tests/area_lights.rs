//! Tests of emitters of all shapes, with light sampling and with BSDF sampling.

use super::*;
use durer_scene::describe::DescribedKind as _;
use durer_scene::shape::Primitive;

/// Shapes that can be sampled as lights; the first six are closed.
const SHAPES: [&str; 10] = [
    "Sphere { center 0 0 0 radius 0.5 }",
    "Ellipsoid { center 0 0 0 radii 0.6 0.3 0.5 }",
    "Box { min -0.5 -0.3 -0.4 max 0.5 0.3 0.4 }",
    "Cone { base 0 -0.4 0 top 0.1 0.5 0 baseRadius 0.5 }",
    "Cone { base 0 -0.4 0 top 0.1 0.5 0 baseRadius 0.2 topRadius 0.5 }",
    "Cylinder { base 0 -0.5 0 top 0.2 0.4 0 radius 0.4 }",
    "Torus { center 0 0 0 axis 0.2 1 0 majorRadius 0.4 minorRadius 0.15 }",
    "Disc { center 0 0 0 normal 0 -1 0.2 radius 0.6 innerRadius 0.2 }",
    "Rectangle { corner -0.5 0 -0.4 edge0 1 0 0 edge1 0.1 0.1 0.8 }",
    "Triangle { vertex0 -0.5 0 -0.4 vertex1 0.5 0 -0.4 vertex2 0 0.1 0.5 }",
];

#[test]
fn every_primitive_is_tested_as_a_light() {
    // Planes and quadrics are infinite or have no simple area, so only BSDF sampling finds them.
    let exempt = ["Plane", "Quadric"];
    for kind in Primitive::kinds() {
        let name = kind.keyword(Dialect::Durer);
        let tested = SHAPES.iter().any(|shape| shape.split(' ').next() == Some(name));
        assert!(tested != exempt.contains(&name), "{name}");
    }
}

/// Transforms of the shapes: a translation, a slight scaling, and one that stretches, rotates,
/// shears and mirrors.
const MAPS: [&str; 3] = [
    "Translate 0.4 1.5 0.2",
    "Translate 0.4 1.5 0.2 Scale 1.0001 1 1",
    "Translate 0.4 1.5 0.2 ZRotate 40 Scale -1.5 0.6 0.9 XRotate 30",
];

/// Asserts that two means with the given variances are equal, by a z-test that fails by chance once
/// in 15,000 times.
fn assert_alike(name: &str, a: (f64, f64), b: (f64, f64)) {
    assert!((a.0 - b.0).abs() <= 4.0 * (a.1 + b.1).sqrt() + 1e-5 * a.0, "{name}: {a:?} {b:?}");
}

#[test]
fn light_and_bsdf_sampling_agree_for_every_shape_and_transform() {
    let settings = RenderSettings { bounces: 0, ..Job::default().settings };
    for (shape, map) in SHAPES.iter().flat_map(|shape| MAPS.map(|map| (shape, map))) {
        let light = format!("Transform {{ {map} {shape} }}");
        let world = over_floor("", &light);
        let [both, points, directions] = by_ways(&world, to_origin(), settings, ColorMode::Rgb).map(|way| way[0]);
        assert!(directions.0 > 0.01, "{light}: {directions:?}");
        assert_alike(&light, both, directions);
        assert_alike(&light, points, directions);
        assert!(points.1 < directions.1, "{light}: light sampling must have less noise: {points:?} {directions:?}");
    }
}

#[test]
fn emissive_shapes_light_their_inside() {
    // In a closed furnace with radiance 1 and albedo 0.5 on both sides, the radiance of the walls
    // is their emission plus light scattered once, which is 1 + 0.5.
    let material = "PrincipledMaterial { baseColor 0.5 0.5 0.5 specularWeight 0 emissionLuminance 1 walls thin }";
    let settings = RenderSettings { bounces: 0, ..Job::default().settings };
    for shape in &SHAPES[..6] {
        for map in ["Scale 1 1 1", "ZRotate 40 Scale 1.5 0.6 0.9 XRotate 30"] {
            let world = scene(material, "", &format!("MaterialIndex 0 Transform {{ {map} {shape} }}"));
            let ray = Ray::new(Vec3::new(0.03, 0.02, 0.04), Vec3::new(0.3, 0.5, -0.7).normalize());
            for way in by_ways(&world, ray, settings, ColorMode::Rgb).map(|way| way[0]) {
                assert_alike(shape, way, (1.5, 0.0));
            }
        }
    }
}

#[test]
fn irradiance_of_a_distant_emitter_follows_its_area() {
    // The irradiance is E = L A / d^2 for the face of a box of 0.1 x 0.1 at a distance of 6, and
    // for the base of a cone.
    for (light, area) in [
        ("Box { min -0.05 6 -0.05 max 0.05 6.1 0.05 }", 0.01),
        ("Cone { base 0 6 0 top 0 6.1 0 baseRadius 0.05 }", 0.0025 * std::f64::consts::PI),
    ] {
        assert_light(light, &over_floor("", light), to_origin(), 0, shown(3.0 * area / 36.0));
    }
}

#[test]
fn convex_emitters_do_not_light_their_own_outside() {
    let material = "PrincipledMaterial { baseColor 0.5 0.5 0.5 specularWeight 0 emissionLuminance 0.5 }";
    let settings = RenderSettings { bounces: 0, ..Job::default().settings };
    for shape in &SHAPES[..6] {
        let world = scene(material, "", &format!("MaterialIndex 0 Transform {{ Scale 1.1 0.9 1 {shape} }}"));
        for y in [0.0, 0.11, 0.23] {
            let ray = Ray::new(Vec3::new(0.05, y, 5.0), Vec3::NEG_Z);
            // Only the emission of the object itself must be visible.
            for way in by_ways(&world, ray, settings, ColorMode::Rgb).map(|way| way[0]) {
                assert!((way.0 - 0.5).abs() < 1e-6, "{shape}: {way:?}");
            }
        }
    }
}

#[test]
fn without_a_background_only_lights_of_the_scene_emit() {
    let of = |background: &str| {
        read(&format!(
            "PerspectiveCamera {{ center 0 0 5 direction 0 0 -1 up 0 1 0 angle 30 }} {background}
             Lights {{ PointLight {{ position 0 2 0 color 1 1 1 candela 1000 }} }} Materials {{ {MATTE} }}
             Group {{ MaterialIndex 0 Sphere {{ center 9 -9 0 radius 1 }} }}"
        ))
    };
    let lux = |world: &World| {
        let path = Path::new(world, Job::default().settings, PathOptions::default());
        let one = |i| path.irradiance(DVec3::ZERO, Vec3::Y, SampleId::new(3, (0, 0), i), &mut ());
        let sum: Vec3 = (0..64).map(one).sum();
        sum.dot(durer_scene::math::LUMINANCE) / 64.0
    };
    // The irradiance is E = I / d^2, plus pi L if there is a uniform environment.
    assert!((lux(&of("")) - 250.0).abs() < 1e-3, "{}", lux(&of("")));
    let grey = lux(&of("Background { color 0.5 0.5 0.5 }")) - 250.0;
    assert!((grey - 0.5 * std::f32::consts::PI).abs() < 0.01, "{grey}");
    // With Whitted ray tracing, the background is grey.
    assert_eq!(of("").background_radiance(Vec3::Y), Vec3::splat(0.5));
}

#[test]
fn errors_account_for_emitters_that_only_bsdf_sampling_finds() {
    let most = |light: &str, direct| {
        let world = over_floor("", light);
        let transport = PathOptions { direct, ..PathOptions::default() };
        Path::new(&world, Job::default().settings, transport).max_rare_contribution(|color| color.x)
    };
    // The maximum is pi times the radiance, which is 3, if light sampling does not choose the
    // emitter.
    let solid = "Intersection { Box { min -1 1 -1 max 1 2 1 } Sphere { center 0 1.5 0 radius 0.6 } }";
    assert!((most(solid, DirectSampling::Both) - 3.0 * std::f32::consts::PI).abs() < 1e-5);
    assert_eq!(most("Box { min -1 1 -1 max 1 2 1 }", DirectSampling::Both), 0.0);
}
