//! Tests of the Whitted integrator with scenes whose radiance is known in closed form.

mod nested;

use super::secondary::fresnel_share;
use super::*;
use crate::compile::{AccelKind, testing};
use crate::integrator::{TraceNode, TraceRecorder};
use durer_scene::dialect::Dialect;
use durer_scene::math::random::Random;
use durer_scene::math::{Vec3, reflect};
use std::path::Path;

const ALL: RenderSettings = RenderSettings {
    bounces: 8,
    shadows: true,
    shade_back: true,
    transparent_shadows: false,
    reflection: true,
    refraction: true,
    min_weight: 0.0,
};

const CAMERA: &str = "PerspectiveCamera { center 0 0 9 direction 0 0 -1 up 0 1 0 angle 40 }\n";

fn seen(text: &str, settings: RenderSettings, origin: [f32; 3], dir: [f32; 3]) -> Vec3 {
    let world = testing::read(&format!("{CAMERA}{text}"));
    let dir = Vec3::from(dir).normalize();
    Whitted { world: &world, settings, cancel: None }.radiance(&Ray::new(origin.into(), dir), &mut ())
}

#[test]
fn refraction_follows_snells_law_and_ends_at_the_critical_angle() {
    let mut random = Random(1);
    for _ in 0..20_000 {
        let (n, eta) = (random.direction(), random.between(0.4, 2.5));
        let d = random.direction();
        let n = if d.dot(n) > 0.0 { -n } else { n };
        let sine = d.as_dvec3().cross(n.as_dvec3()).length();
        let expected = sine * f64::from(eta);
        match refract(d, n, eta) {
            Some(t) => {
                // Near the critical angle, the square root loses half the digits.
                assert!(expected < 1.0 + 1e-6 && (t.length() - 1.0).abs() < 1e-3, "{expected} {t}");
                assert!((t.as_dvec3().cross(n.as_dvec3()).length() - expected).abs() < 2e-6);
                assert!(
                    t.dot(n) <= 0.0 && t.dot(d.cross(n)).abs() < 1e-6,
                    "the ray must stay in the plane of incidence"
                );
            }
            None => assert!(expected > 1.0 - 1e-6, "{expected}"),
        }
    }
    assert_eq!(refract(Vec3::NEG_Y, Vec3::Y, 0.7), Some(Vec3::NEG_Y));
    // If the indices are equal, the direction does not change.
    let d = Vec3::new(0.6, -0.8, 0.0);
    assert!((refract(d, Vec3::Y, 1.0).unwrap() - d).length() < 1e-6);
}

#[test]
fn mirrored_directions_keep_the_angle() {
    let mut random = Random(2);
    for _ in 0..1_000 {
        let (d, n) = (random.direction(), random.direction());
        let r = reflect(d, n);
        assert!((r.dot(n) + d.dot(n)).abs() < 1e-6 && (r.length() - 1.0).abs() < 1e-6);
        assert!((r - r.dot(n) * n - (d - d.dot(n) * n)).length() < 1e-6);
    }
}

#[test]
fn schlicks_reflectance_is_r0_at_normal_and_one_at_grazing_incidence() {
    let share = |zero: bool, cosine: f32, here: f32, there: f32| {
        let d = Vec3::new((1.0 - cosine * cosine).sqrt(), -cosine, 0.0);
        let before = if zero { 1.0 } else { here };
        refract(d, Vec3::Y, here / there).map(|t| fresnel_share(d, Vec3::Y, t, (here, there), before))
    };
    let close = |a: Option<f32>, b: f32| assert!((a.unwrap() - b).abs() < 1e-6, "{a:?} {b}");
    close(share(false, 1.0, 1.0, 1.5), 0.04);
    close(share(false, 1.0, 1.5, 1.0), 0.04);
    close(share(false, 0.5, 1.0, 1.5), 0.04 + 0.96 / 32.0);
    close(share(false, 0.0, 1.0, 1.5), 1.0);
    // For a ray that leaves the glass, the angle outside is used, with sin = 1.5 sin 30 degrees.
    let inside = 0.75f32.sqrt();
    let outside = 1.0 - (1.0f32 - 0.5625).sqrt();
    close(share(false, inside, 1.5, 1.0), 0.04 + 0.96 * outside * outside * outside * outside * outside);
    assert_eq!(share(false, 0.7, 1.5, 1.0), None);
    // An official program uses R0 = 0 for rays that leave the glass.
    close(share(true, 1.0, 1.5, 1.0), 0.0);
    close(share(true, 1.0, 1.33, 1.5), 0.04);
}

#[test]
fn facing_mirrors_sum_a_geometric_series() {
    // Each wall has radiance 1 from ambient light and reflects one half of the light.
    let hall = "Background { color 0 0 0 ambientLight 1 1 1 }
        Lights { DirectionalLight { direction 0 -1 0 color 0.001 0.001 0.001 } }
        Materials { Material { diffuseColor 1 1 1 reflectiveColor 0.5 0.5 0.5 } }
        Group { MaterialIndex 0 Plane { normal 1 0 0 offset -1 } Plane { normal -1 0 0 offset -1 } }";
    let mut expected = 0.0;
    for bounces in 0..12 {
        expected += libm::ldexpf(1.0, -(bounces as i32));
        for dir in [[1.0, 0.0, 0.0], [1.0, 0.2, 0.1]] {
            let color = seen(hall, RenderSettings { bounces, ..ALL }, [0.0; 3], dir);
            assert!((color.x - expected).abs() < 1e-5, "{bounces} {color} {expected}");
        }
    }
    let off = RenderSettings { reflection: false, ..ALL };
    assert!((seen(hall, off, [0.0; 3], [1.0, 0.0, 0.0]).x - 1.0).abs() < 1e-5);
    // With Dürer's own rules, the weight is 1/2 after one bounce and 1/4 after two.
    let cut = RenderSettings { min_weight: 0.3, ..ALL };
    assert!((seen(hall, cut, [0.0; 3], [1.0, 0.0, 0.0]).x - 1.5).abs() < 1e-5);
    // The course uses the length of the colour, which is sqrt(3) / 2 after one bounce and 3/4 after
    // two.
    let mut world = testing::read(&format!("{CAMERA}{hall}"));
    let rules = Dialect::Durer.rules();
    world.edit().set_rules(durer_scene::dialect::DialectRules { epsilon: Some(1e-4), ..rules.clone() });
    let cut = RenderSettings { min_weight: 0.7, ..ALL };
    let old = Whitted { world: &world, settings: cut, cancel: None }.radiance(&Ray::new(Vec3::ZERO, Vec3::X), &mut ());
    assert!((old.x - 1.75).abs() < 1e-5, "{old}");
}

#[test]
fn deep_recursion_needs_no_deep_stack() {
    // Two perfect mirrors face each other, and each has radiance 1 from ambient light.
    let hall = "Background { color 0 0 0 ambientLight 1 1 1 }
        Lights { DirectionalLight { direction 0 -1 0 color 0.001 0.001 0.001 } }
        Materials { Material { diffuseColor 1 1 1 reflectiveColor 1 1 1 } }
        Group { MaterialIndex 0 Plane { normal 1 0 0 offset -1 } Plane { normal -1 0 0 offset -1 } }";
    let settings = RenderSettings { bounces: RenderSettings::MAX_BOUNCES, ..ALL };
    let world = &testing::read(&format!("{CAMERA}{hall}"));
    let light = || Whitted { world, settings, cancel: None }.radiance(&Ray::new(Vec3::ZERO, Vec3::X), &mut ());
    // If each level needed one kilobyte of stack, this stack would overflow.
    let thread = std::thread::Builder::new().stack_size(192 << 10);
    let light = std::thread::scope(|scope| thread.spawn_scoped(scope, light).unwrap().join().unwrap());
    assert_eq!(light, Vec3::splat(RenderSettings::MAX_BOUNCES as f32 + 1.0));
}

#[test]
fn shadows_end_at_the_light() {
    let lit = |wall: f32| {
        let text = format!(
            "Lights {{ PointLight {{ position 0 2 0 color 1 1 1 }} }} Materials {{ Material {{ diffuseColor 1 1 1 }} }}
            Group {{ MaterialIndex 0 Plane {{ normal 0 1 0 offset 0 }} Plane {{ normal 0 -1 0 offset {:?} }} }}",
            -wall
        );
        seen(&text, ALL, [0.0, 1.0, 0.0], [0.0, -1.0, 0.0])
    };
    // Place the wall in front of the light, exactly at it, just behind it, and far behind it.
    assert_eq!(lit(1.99), Vec3::ZERO);
    for wall in [2.0, 2.0f32.next_up(), 2.001, 50.0] {
        assert_eq!(lit(wall), Vec3::ONE, "{wall}");
    }
    // A directional light is at infinity, so it is occluded by everything above.
    let text =
        "Lights { DirectionalLight { direction 0 -1 0 color 1 1 1 } } Materials { Material { diffuseColor 1 1 1 } }
        Group { MaterialIndex 0 Plane { normal 0 1 0 offset 0 } Sphere { center 0 1e6 0 radius 1 } }";
    assert_eq!(seen(text, ALL, [0.0, 1.0, 0.0], [0.0, -1.0, 0.0]), Vec3::ZERO);
    assert_eq!(seen(text, RenderSettings { shadows: false, ..ALL }, [0.0, 1.0, 0.0], [0.0, -1.0, 0.0]), Vec3::ONE);
}

#[test]
fn sphere_with_the_index_of_air_is_invisible() {
    let text = |glass: &str| {
        format!(
            "Background {{ color 0.2 0.4 0.8 }} Lights {{ DirectionalLight {{ direction 0 -1 0 color 1 1 1 }} }}
            Materials {{ Material {{ diffuseColor 0 0 0 {glass} }} }} Group {{ MaterialIndex 0 Sphere {{ center 0 0 0 radius 1 }} }}"
        )
    };
    for glass in
        ["transparentColor 1 1 1 indexOfRefraction 1", "specularColor 0 0 0 transparentColor 1 1 1 refractionIndex 1"]
    {
        let mut random = Random(3);
        let text = text(glass);
        for _ in 0..200 {
            let origin = 3.0 * random.direction();
            let dir = (0.7 * random.point() - origin).to_array();
            let color = seen(&text, ALL, origin.to_array(), dir);
            // If the indices are equal, Schlick's approximation gives (1 - c)^5, with the same c
            // for entering and leaving rays.
            let dir = Vec3::from(dir).normalize();
            let beside = origin - origin.dot(dir) * dir;
            let rest = 1.0 - (1.0 - beside.length_squared()).max(0.0).sqrt();
            let lost = if glass.contains("refractionIndex") { rest * rest * rest * rest * rest } else { 0.0 };
            // Rays within 1e-3 of grazing the sphere may miss it, because a cosine loses half its
            // digits there.
            let slack = if beside.length() > 0.99 { 0.1 } else { 1e-5 };
            let expected =
                Vec3::new(0.2, 0.4, 0.8) * if beside.length() < 1.0 { (1.0 - lost) * (1.0 - lost) } else { 1.0 };
            assert!((color - expected).abs().max_element() <= slack, "{glass} {color} {expected}");
        }
        let straight = seen(&text, ALL, [0.0, 0.0, 3.0], [0.0, 0.0, -1.0]);
        assert!((straight - Vec3::new(0.2, 0.4, 0.8)).length() < 1e-5, "{glass} {straight}");
    }
}

#[test]
fn diffuse_light_and_highlight_follow_their_models() {
    let lit = |words: &str, dir: [f32; 3]| {
        let text = format!(
            "Background {{ color 0 0 0 ambientLight 0 0 0 }}
            Lights {{ DirectionalLight {{ direction -3 -4 0 color 1 1 1 }} }} Materials {{ Material {{ {words} }} }}
            Group {{ MaterialIndex 0 Plane {{ normal 0 1 0 offset 0 }} }}"
        );
        seen(&text, ALL, (-10.0 * Vec3::from(dir)).to_array(), dir).x
    };
    let close = |a: f32, b: f32| assert!((a - b).abs() < 1e-5, "{a} {b}");
    let down = [0.0, -1.0, 0.0];
    close(lit("diffuseColor 1 1 1", down), 0.8);
    // If the light is behind the surface, the surface receives no light.
    close(lit("diffuseColor 1 1 1", [0.0, 1.0, 0.0]), 0.0);
    // In Blinn's model, the half vector between (0.6, 0.8) and straight up has the cosine
    // sqrt(0.9).
    close(lit("diffuseColor 0 0 0 specularColor 1 1 1 exponent 4", down), 0.81);
    // In Phong's model, the view direction is reflected straight up.
    close(lit("diffuseColor 0 0 0 specularColor 1 1 1 shininess 2", down), 0.64);
    close(lit("diffuseColor 0 0 0 specularColor 1 1 1 shininess 7", [0.6, -0.8, 0.0]), 1.0);
}

#[test]
fn coloured_glass_casts_coloured_shadows_if_enabled() {
    let text = "Lights { PointLight { position 0 5 0 color 1 1 1 } }
        Materials { Material { diffuseColor 1 1 1 } Material { transparentColor 0.5 1 0 } }
        Group { MaterialIndex 0 Plane { normal 0 1 0 offset 0 } MaterialIndex 1 Sphere { center 0 3 0 radius 1 } }";
    let down = |settings| seen(text, settings, [0.0, 1.0, 0.0], [0.0, -1.0, 0.0]);
    assert_eq!(down(ALL), Vec3::ZERO);
    // The light passes through two walls of the sphere.
    assert_eq!(down(RenderSettings { transparent_shadows: true, ..ALL }), Vec3::new(0.25, 1.0, 0.0));
}

#[test]
fn coarse_smooth_sphere_casts_no_shadow_on_points_that_face_the_light() {
    let text = |file: &str, wall: &str| {
        format!(
            "{CAMERA} Lights {{ DirectionalLight {{ direction 0 -1 0.2 color 1 1 1 }} }} Group {{ {wall}
            Transform {{ Translate 3 0 0 Scale 2 1 1 TriangleMesh {{ obj_file {file} }} }} }}"
        )
    };
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/meshes");
    let read = |wall: &str, compat: bool| {
        let rules = Dialect::Durer.rules();
        let rules = durer_scene::dialect::DialectRules { epsilon: compat.then_some(1e-4), ..rules.clone() };
        testing::try_read(&text("ball80-smooth.obj", wall), &rules, AccelKind::Bvh, &folder).0.unwrap()
    };
    // Returns the number of dark points whose normals face the light, and the number of all points
    // whose normals face the light.
    let dark = |world: &World| {
        let (mut random, mut dark, mut all) = (Random(5), 0, 0);
        let whitted = Whitted { world, settings: ALL, cancel: None };
        for _ in 0..20_000 {
            let origin = Vec3::new(3.0, 0.0, 0.0) + 9.0 * random.direction();
            let ray = Ray::new(origin, (Vec3::new(3.0, 0.0, 0.0) + random.point() - origin).normalize());
            let Some(at) = world.intersect(&ray, &mut ()) else { continue };
            let surface = at.surface;
            let light_sample = world.illuminate(0, surface.point());
            // Skip points on the wall.
            if surface.position.y < 1.0 && surface.n_shade.dot(light_sample.to_light) > 1e-3 {
                all += 1;
                let mut share = [Color::ZERO];
                whitted.visible(&mut [whitted.shadow_ray(&surface, 0, &light_sample)], &mut share, &mut ());
                dark += i32::from(share == [Color::ZERO]);
            }
        }
        (dark, all)
    };
    let (lost, all) = dark(&read("", false));
    assert!(lost == 0 && all > 5_000, "{lost} of {all}");
    // If there are no shadow offsets, entire triangles are dark.
    let (lost, all) = dark(&read("", true));
    assert!(lost > all / 100, "{lost} of {all}");
    // Objects still cast shadows if they are farther away than the offset of the curved surface.
    let (lost, all) = dark(&read("Plane { normal 0 1 0 offset 1.05 }", false));
    assert!(lost == all, "{lost} of {all}");
}

#[test]
fn backs_are_black_only_with_the_quirk_black_backs() {
    let text = format!(
        "{CAMERA} Background {{ color 0 0 0 ambientLight 0.5 0.5 0.5 }}
        Lights {{ DirectionalLight {{ direction 0 1 0 color 1 1 1 }} }} Materials {{ Material {{ diffuseColor 1 1 1 }} }}
        Group {{ MaterialIndex 0 Plane {{ normal 0 1 0 offset 0 }} }}"
    );
    let below = |dialect: Dialect, shade_back: bool| {
        let (world, _) = testing::try_read(&text, dialect.rules(), AccelKind::Bvh, Path::new("."));
        let world = world.unwrap();
        let settings = RenderSettings { shade_back, ..ALL };
        Whitted { world: &world, settings, cancel: None }.radiance(&Ray::new(Vec3::NEG_Y, Vec3::Y), &mut ()).x
    };
    assert_eq!(below(Dialect::F04, false), 0.0);
    assert_eq!(below(Dialect::F04, true), 1.5);
    assert_eq!(below(Dialect::Durer, false), 0.5);
    assert_eq!(below(Dialect::Durer, true), 1.5);
}

/// Asserts that each node of a tree equals the sum of its terms, bit for bit.
#[track_caller]
fn adds_up(node: &TraceNode) {
    assert_eq!(node.sum(), node.value, "{node:?}");
    node.terms.iter().for_each(adds_up);
}

#[test]
fn traced_terms_sum_to_the_radiance_without_a_trace() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let mut random = Random(11);
    let mut kinds = std::collections::BTreeMap::new();
    for name in ["whitted", "glass", "mirrors", "solid-textures", "smooth-mesh", "globe", "highlights"] {
        let text = std::fs::read_to_string(folder.join(name).with_extension("txt")).unwrap();
        for dialect in [Dialect::Durer, Dialect::F04, Dialect::F12a5] {
            let (world, findings) = testing::try_read(&text, dialect.rules(), AccelKind::Bvh, &folder);
            let world = world.unwrap_or_else(|| panic!("{findings:?}"));
            let settings =
                RenderSettings { bounces: 5, transparent_shadows: random.below(2) == 0, min_weight: 0.01, ..ALL };
            let whitted = Whitted { world: &world, settings, cancel: None };
            for _ in 0..60 {
                let forward = world.camera_frame().forward + 0.3 * random.direction();
                let ray = Ray::new(world.camera_frame().eye, forward.normalize());
                let (mut account, mut counts) = (TraceRecorder::default(), durer_bvh::TraversalStats::default());
                let color = whitted.radiance(&ray, &mut account);
                assert_eq!(color, whitted.radiance(&ray, &mut counts));
                let tree = account.into_tree().unwrap();
                assert_eq!(tree.sum(), color);
                adds_up(&tree.root);
                count(&tree.root, &mut kinds);
            }
        }
    }
    let known = ["ambient", "cut", "diffuse", "highlight", "light", "ray", "secondary", "sky", "spent"];
    assert_eq!(kinds.keys().map(String::as_str).collect::<Vec<_>>(), known);
}

fn count(node: &TraceNode, kinds: &mut std::collections::BTreeMap<String, u32>) {
    let json = serde_json::to_value(&node.kind).unwrap();
    *kinds.entry(json["kind"].as_str().unwrap().into()).or_default() += 1;
    node.terms.iter().for_each(|node| count(node, kinds));
}
